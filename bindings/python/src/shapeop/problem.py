"""A problem as plain data, and its JSON form."""

from __future__ import annotations

import dataclasses
import json
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from ._arrays import found
from ._library import ArgumentTypeError, check_message, lib
from .solver import Solver

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ._arrays import PointsLike


@dataclass
class Constraint:
    """One constraint; its id in the solver is its place in ``Problem.constraints``."""

    type: str
    """The name of its type."""
    indices: Sequence[int]
    """Point indices; their number and meaning depend on the type."""
    weight: float = 1.0
    """How much it counts against the others; at least 0."""
    scalars: Optional[Sequence[float]] = None
    """Its scalars, as its type states them; ``None`` for the defaults."""
    hard: bool = False
    """Whether it must be met exactly (static mode); its weight is then its priority where not everything can be."""


@dataclass
class Force:
    """One force; its id in the solver is its place in ``Problem.forces``."""

    kind: str
    """"gravity", on every point; "vertex", on the point ``id``; "pressure" or "normal", on ``faces``."""
    force: Optional[Sequence[float]] = None
    """x, y, z of gravity or a vertex force; in dynamic mode an acceleration."""
    id: Optional[int] = None
    """The point that a vertex force acts on."""
    magnitude: Optional[float] = None
    """A pressure, or the length of a normal force on every corner; below 0 against the normals."""
    faces: Sequence[Sequence[int]] = field(default_factory=list)
    """The faces that a pressure or a normal force acts on; a normal points to where they run counter-clockwise."""


@dataclass
class Edit:
    """New scalars of a constraint from a time step on (dynamic mode)."""

    before_step: int
    """The time step, from 1, before which it is made."""
    constraint: int
    """The constraint, by its place in ``Problem.constraints``."""
    scalars: Sequence[float]
    """Its scalars, as its type states them."""


@dataclass
class ReferencePolyline:
    """A polyline that ``OnCurve`` constraints refer to; its id is its place in ``Problem.references``."""

    points: PointsLike
    """At least 2, each ``[x, y, z]`` in model units."""
    closed: bool = False
    """Whether a segment leads from the last point back to the first."""


@dataclass
class ReferenceMesh:
    """Triangles that ``OnMesh`` constraints refer to; its id is its place in ``Problem.references``."""

    points: PointsLike
    """Each ``[x, y, z]`` in model units."""
    triangles: Sequence[Sequence[int]]
    """At least one, each three indices into ``points``."""


@dataclass
class Handle:
    """A point that is drawn to a target (static mode)."""

    point: int
    """The point."""
    target: Sequence[float]
    """x, y, z in model units."""


@dataclass
class Objective:
    """What is minimised while hard constraints are met (static mode)."""

    handle_weight: float = 100.0
    """Of the distances of handles from their targets, above 0."""
    closeness_weight: float = 0.1
    """Of the distances of the other points from where they were, above 0."""
    fairness_weight: float = 1.0
    """Of the fairness of displacements, at least 0; it needs faces, edges or polylines."""
    fairness: str = "laplacian"
    """What measures it: ``"laplacian"``, ``"second-differences"`` or ``"third-differences"``."""
    polylines: Sequence[Sequence[int]] = field(default_factory=list)
    """The polylines of differences; empty: they are found on the faces."""
    tolerance: float = 1e-12
    """How far a hard constraint may be from its set, relative to the bounding-box diagonal; at least 1e-14."""


@dataclass
class Settings:
    """When to stop, and how to get there."""

    max_iterations: int = 1000
    """Iterations at most, in dynamic mode within each time step."""
    tolerance: float = 1e-6
    """Stop when the largest move in an iteration, relative to the bounding-box diagonal, falls below this."""
    time_budget_seconds: float = 0.0
    """Stop after so many seconds; 0: no limit."""
    steps: int = 1
    """The number of time steps in dynamic mode."""
    acceleration: str = "automatic"
    """How iterations are accelerated."""
    acceleration_memory: int = 0
    """Iterations that acceleration remembers, at most 64; 0: the method's default."""


@dataclass
class Problem:
    """Points, constraints, forces and settings, as plain data.

    The library checks it and writes its text: ``Problem.from_json(text).to_json()`` is the library's own form of the
    text, with the defaults filled in.
    """

    points: PointsLike
    """Coordinates ``[x, y, z]`` in model units."""
    constraints: list[Constraint] = field(default_factory=list)
    """The constraints, in the order of their ids."""
    forces: list[Force] = field(default_factory=list)
    """The forces, in the order of their ids."""
    edits: list[Edit] = field(default_factory=list)
    """Edits of constraints between time steps (dynamic mode), for whoever makes the steps."""
    references: list[Union[ReferencePolyline, ReferenceMesh]] = field(default_factory=list)
    """Shapes that constraints refer to, in the order of their ids."""
    objective: Optional[Objective] = None
    """What is minimised while hard constraints are met; ``None``: the defaults, if there is anything to explore."""
    handles: list[Handle] = field(default_factory=list)
    """Points that are drawn to targets (static mode)."""
    faces: Sequence[Sequence[int]] = field(default_factory=list)
    """Faces as lists of point indices: for files, pictures, and the fairness of an objective."""
    edges: Sequence[Sequence[int]] = field(default_factory=list)
    """Edges as pairs of point indices: for files, pictures, and the fairness of an objective."""
    mode: str = "static"
    """``"static"`` or ``"dynamic"``."""
    masses: float = 1.0
    """The mass of every point (dynamic mode), above 0."""
    damping: float = 1.0
    """The factor on the velocities after each step (dynamic mode), at least 0."""
    timestep: float = 1.0
    """The time step in seconds (dynamic mode), above 0."""
    settings: Settings = field(default_factory=Settings)
    """When to stop."""
    extra: dict[str, Any] = field(default_factory=dict)
    """Anything else that its author wants to keep; never read."""
    version: int = 1
    """The version of the JSON form."""

    @classmethod
    def from_json(cls, text: str) -> Problem:
        """Reads a problem. Raises :class:`Error` with the place in the text that errs."""
        values = json.loads(_checked(text))
        for name, kind in _PARTS.items():
            values[name] = [kind(**value) for value in values.get(name, ())]
        values["references"] = [
            _REFERENCES[name](**value) for each in values.get("references", ()) for name, value in each.items()
        ]
        if values.get("objective") is not None:
            values["objective"] = Objective(**values["objective"])
        values["settings"] = Settings(**values["settings"])
        return cls(**values)

    def to_json(self) -> str:
        """The JSON form, checked. Raises :class:`Error` with the place that errs: ``constraints[17].weight``."""
        return _checked(self._text())

    @classmethod
    def load(cls, path: Union[str, os.PathLike[str]]) -> Problem:
        """Reads a problem from a JSON file. Raises as :meth:`from_json`, and OSError."""
        return cls.from_json(Path(path).read_text(encoding="utf-8"))

    def save(self, path: Union[str, os.PathLike[str]]) -> None:
        """Writes the JSON form to a file. Raises as :meth:`to_json`, and OSError."""
        Path(path).write_text(self.to_json(), encoding="utf-8")

    def solver(self) -> Solver:
        """A solver of this problem, initialised in its mode, whose :meth:`Solver.solve_until` has its settings.

        Raises as :meth:`to_json`.
        """
        return solver_of(self._text(), [constraint.type for constraint in self.constraints])

    def edits_before(self, step: int) -> list[Edit]:
        """The edits to make before a time step, counted from 1."""
        return [edit for edit in self.edits if edit.before_step == step]

    def _text(self) -> str:
        """The JSON form, unchecked; what is empty is left out."""
        parts = (*_PARTS, "references", "faces", "edges", "extra")
        values = {name: value for name, value in vars(self).items() if name not in parts or len(value) > 0}
        return json.dumps(values, default=_plain)


_PARTS: dict[str, Any] = {"constraints": Constraint, "forces": Force, "edits": Edit, "handles": Handle}
_REFERENCES: dict[str, Any] = {"polyline": ReferencePolyline, "mesh": ReferenceMesh}


def solver_of(text: str, types: Sequence[str] = ()) -> Solver:
    """The solver of a problem in JSON; `types` are those of its constraints, for edits without a type."""
    solver = Solver()
    solver._set_problem(text.encode(), types)
    return solver


def _plain(value: Any) -> Any:
    """What the json module cannot write by itself."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        parts = {name: part for name, part in vars(value).items() if part is not None}
        name = next((name for name, kind in _REFERENCES.items() if isinstance(value, kind)), None)
        return {name: parts} if name else parts
    if hasattr(value, "tolist"):  # an array, or a number out of one
        return value.tolist()
    if hasattr(value, "__len__") and hasattr(value, "__getitem__"):
        return list(value)
    raise ArgumentTypeError(f"problem: expected plain data, found {found(value)}")


def _checked(text: str) -> str:
    """The library's form of a problem in JSON."""
    if not isinstance(text, str):
        raise ArgumentTypeError(f"text: expected a str, found {found(text)}")
    answer = lib.shapeop_problemText(text.encode())
    if answer is None:
        check_message()
    checked: bytes = answer
    return checked.decode()
