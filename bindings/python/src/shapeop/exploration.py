"""Exploration: hard constraints that are met exactly, handles that are dragged, and what a solve found of them."""

from __future__ import annotations

import contextlib
import ctypes
import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Optional, Union

from . import _abi, _arrays
from ._library import ArgumentTypeError, check, check_message, lib, refusal, text

if TYPE_CHECKING:
    from ._arrays import Ids

HARD = 1
"""``SHAPEOP_HARD`` of the C header, a flag of ``shapeop_addConstraints``."""


class Fairness(IntEnum):
    """What the fairness term measures the points' displacements with."""

    LAPLACIAN = _abi.SO_FAIRNESS_LAPLACIAN
    """The displacement of a point minus the mean of its neighbours'; on faces, or on edges as lists of two."""
    SECOND_DIFFERENCES = _abi.SO_FAIRNESS_SECOND_DIFFERENCES
    """Second differences along polylines; a closed one repeats its first point at its end."""
    THIRD_DIFFERENCES = _abi.SO_FAIRNESS_THIRD_DIFFERENCES
    """Third differences along polylines."""


@dataclasses.dataclass(frozen=True)
class Exploration:
    """What the last exploration found."""

    sweep_count: int
    """Sweeps of the splitting method."""
    newton_step_count: int
    """Newton steps."""
    is_solution: bool
    """Whether every hard constraint is met and the gradient vanishes, both within the tolerance."""
    largest_violation: float
    """The largest distance of a hard constraint from its set, in model units."""
    worst_constraint: Optional[int]
    """The hard constraint that it is of; ``None`` if there is none."""
    capped_count: int
    """Hard constraints whose multiplier is at its cap: the contradictions, as far as they are known."""
    primal_residual: float
    """The largest distance between what multipliers ask for and what the points are, in model units."""
    dual_residual: float
    """The largest gradient of the Lagrangian at a point, relative to the force that moves it by the model's size."""
    handle_term: float
    """The term of the objective that draws handles to their targets."""
    closeness_term: float
    """The term that draws the other points to where they were at initialisation."""
    fairness_term: float
    """The term that makes displacements fair."""
    soft_term: float
    """The term of the soft constraints."""
    penalty: float
    """The penalty of the sweeps."""


@dataclasses.dataclass(frozen=True)
class Sensitivities:
    """How a solution answers a change of each weight; c is the number of weight classes, n that of points."""

    classes: tuple[str, ...]
    """The classes: "handles", "closeness", "fairness", and the name of each type of soft constraints."""
    points: Any
    """(c, n, 3): how far each point moves per change of the logarithm of a weight, in model units: about 0.69 times
    that if the weight is doubled. Nested lists without numpy."""
    squares: Any
    """(c, c): a row per weight that is changed, a column per class whose sum of weighted squares answers, per change of
    the logarithm. Nested lists without numpy."""


class Exploring:
    """The part of :class:`Solver` that explores: hard constraints, handles, the objective."""

    @property
    def _handle(self) -> int:
        raise NotImplementedError

    def set_hard(self, ids: Ids, hard: bool) -> None:
        """Makes constraints hard, to be met exactly (static mode), or soft, all or none: an id or many.

        The weight of a hard constraint is its priority where not everything can be met. Solving goes on from where it
        is.
        """
        many = _arrays.ids(ids if hasattr(ids, "__len__") else [ids], "ids")
        is_hard = int(_arrays.truth(hard, "hard"))
        changed: list[int] = []
        for i, one in enumerate(many.pointer[: many.length]):
            was_hard = lib.shapeop_isHard(self._handle, one)
            code = lib.shapeop_setHard(self._handle, one, is_hard)
            if code != _abi.SO_SUCCESS:
                # The library was told of one id.
                message = text(lib.shapeop_lastError(self._handle)).replace("ids[0]", f"ids[{i}]", 1)
                for other in reversed(changed):
                    lib.shapeop_setHard(self._handle, other, 1 - is_hard)
                raise refusal(code, message)
            if was_hard != is_hard:
                changed.append(one)

    def is_hard(self, id: int) -> bool:
        """Whether ``id`` is a hard constraint: false if it is soft or none."""
        return self._truth(lib.shapeop_isHard(self._handle, _arrays.integer(id, "id")))

    def set_handle(self, point: int, target: Sequence[float]) -> None:
        """Makes a point a handle, drawn to ``target`` (x, y, z), or moves its target.

        Solving goes on from where it is.
        """
        number, pointer = _arrays.integer(point, "point"), _arrays.vector(target, "target").pointer
        check(lib.shapeop_setHandle(self._handle, number, pointer), self._handle)

    def release_handle(self, point: int) -> None:
        """Lets a handle go: the point is drawn to where it was at initialisation, as the others are."""
        check(lib.shapeop_releaseHandle(self._handle, _arrays.integer(point, "point")), self._handle)

    @contextlib.contextmanager
    def handles(self, targets: Mapping[int, Sequence[float]]) -> Iterator[None]:
        """Handles for the time of a ``with`` block: ``targets`` says where each point is drawn to.

        Inside it :meth:`set_handle` moves them. At its end they are released, those too that were handles before.
        """
        if not isinstance(targets, Mapping):
            expected = "a dict of targets by point"
            raise ArgumentTypeError(f"targets: expected {expected}, found {_arrays.found(targets)}")
        held: list[int] = []
        try:
            for point, target in targets.items():
                self.set_handle(point, target)
                held.append(point)
            yield
        finally:
            # One that was released inside the block is refused, which is as it should be.
            for point in held:
                lib.shapeop_releaseHandle(self._handle, point)

    def set_objective(
        self,
        *,
        handle_weight: Optional[float] = None,
        closeness_weight: Optional[float] = None,
        fairness_weight: Optional[float] = None,
        tolerance: Optional[float] = None,
    ) -> None:
        """Sets the weights of the objective; what is not given is the library's default. The fairness rows stay.

        ``handle_weight``: of the distances of handles from their targets, above 0; 100 by default.
        ``closeness_weight``: of the other points' distances from where they were at initialisation, above 0; 0.1.
        ``fairness_weight``: of what :meth:`set_fairness` says, at least 0; 1.
        ``tolerance``: how far a hard constraint may be from its set, relative to the bounding-box diagonal, at least
        1e-14; 1e-12.
        """
        objective = _abi.shapeop_objective(struct_size=ctypes.sizeof(_abi.shapeop_objective))
        check(lib.shapeop_defaultObjective(ctypes.byref(objective)))
        given = {
            "handle_weight": handle_weight,
            "closeness_weight": closeness_weight,
            "fairness_weight": fairness_weight,
            "tolerance": tolerance,
        }
        for name, value in given.items():
            if value is not None:
                setattr(objective, name, _arrays.real(value, name))
        check(lib.shapeop_setObjective(self._handle, ctypes.byref(objective)), self._handle)

    def set_fairness(self, kind: Union[Fairness, str], lists: Any) -> None:
        """Sets what the fairness term measures.

        ``kind``: a :class:`Fairness` or its name: "laplacian", "second-differences", "third-differences".
        ``lists``: for the Laplacian faces, or edges; for differences polylines. An (m, k) integer array or a list of
        index lists; an empty one for none.
        """
        number = _arrays.member(Fairness, kind, "kind")
        many = _arrays.face_lists(lists, "lists")
        # An array says its one number of columns once; here every list has its own.
        counts = many.counts
        if counts.length != many.list_count:
            each = counts.pointer[0]
            counts = _arrays.ids([each] * many.list_count, "lists")
        check(lib.shapeop_setFairness(self._handle, number, *many.indices, *counts), self._handle)

    @property
    def exploration(self) -> Exploration:
        """What the last exploration found. Raises :class:`NotInitialisedError` if there was none."""
        found = _abi.shapeop_exploration(struct_size=ctypes.sizeof(_abi.shapeop_exploration))
        check(lib.shapeop_getExploration(self._handle, ctypes.byref(found)), self._handle)
        values = {field.name: getattr(found, field.name) for field in dataclasses.fields(Exploration)}
        values["is_solution"] = found.is_solution != 0
        values["worst_constraint"] = None if found.worst_constraint < 0 else found.worst_constraint
        return Exploration(**values)

    def conflicts(self) -> list[int]:
        """The ids of the hard constraints in the contradiction that the last exploration found; empty if none.

        Without them the others can be met.
        """
        count = lib.shapeop_getConflicts(self._handle, None, 0)
        if count < 0:
            check_message(self._handle)
        ids = (ctypes.c_int * count)()
        if lib.shapeop_getConflicts(self._handle, ids, count) < 0:
            check_message(self._handle)
        return list(ids)

    def sensitivities(self) -> Sensitivities:
        """How the solution answers a change of each weight.

        Raises :class:`NotInitialisedError` unless the last solve ended in a solution.
        """
        count, point_count = lib.shapeop_weightClassCount(self._handle), lib.shapeop_pointCount(self._handle)
        if min(count, point_count) < 0:
            check_message(self._handle)
        points, squares = (ctypes.c_double * (3 * count * point_count))(), (ctypes.c_double * (count * count))()
        code = lib.shapeop_getSensitivities(self._handle, points, point_count, squares, count)
        check(code, self._handle)
        names = tuple(text(lib.shapeop_weightClassName(self._handle, i)) for i in range(count))
        return Sensitivities(
            names, _arrays.shaped(points, count, point_count, 3), _arrays.shaped(squares, count, count)
        )

    def _truth(self, answer: int) -> bool:
        if answer < 0:
            check_message(self._handle)
        return answer == 1
