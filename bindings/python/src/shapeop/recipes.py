"""Recipes: from a mesh to a problem that makes its faces planar, its edges equal, or itself smooth; and measures.

The library knows the recipes and the measures. Each recipe is a function of this package under its own name, such as
``shapeop.planarize``; all of them are a :class:`Recipe`.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Generic, Optional, TypeVar, Union

from . import _abi, _arrays
from ._library import ArgumentError, check, check_message, lib, text
from .meshes import View, view
from .problem import Problem, solver_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ._arrays import Doubles
    from ._progress import ProgressFunction
    from .report import Report

M = TypeVar("M")


class FairnessKind(IntEnum):
    """What a fairness weight asks for."""

    KEEP_DETAIL = 0
    """That neighbours move alike: the folds and details of the design stay."""
    SMOOTH = 1
    """That the mesh is smooth: details of the design go."""


@dataclass(frozen=True)
class Result(Generic[M]):
    """What a recipe made of a mesh."""

    mesh: M
    """A mesh of the kind that was given, with the new points; the points themselves if points were given."""
    points: Doubles
    """The new points, (n, 3), in the order of the mesh."""
    report: Report
    """What the solver found."""
    violations: Doubles
    """The violation of every constraint at the new points, each in its type's unit."""


class Recipe:
    """A recipe of the library: call it with a mesh."""

    def __init__(self, name: str) -> None:
        self.__name__ = name
        self.__doc__ = f"The recipe {name!r}: see :meth:`Recipe.__call__`."

    def __repr__(self) -> str:
        return f"<shapeop recipe {self.__name__!r}>"

    def __call__(
        self,
        mesh: M,
        faces: Optional[Any] = None,
        *,
        weight: Optional[float] = None,
        closeness: Optional[float] = None,
        fairness: Optional[float] = None,
        fairness_kind: Union[FairnessKind, str] = FairnessKind.KEEP_DETAIL,
        anchors: Iterable[int] = (),
        anchor_boundary: bool = False,
        anchor_corners: bool = False,
        length: Optional[float] = None,
        max_iterations: Optional[int] = None,
        tolerance: Optional[float] = None,
        time_budget_seconds: Optional[float] = None,
        progress: Optional[ProgressFunction] = None,
    ) -> Result[M]:
        """Makes the mesh what the recipe asks for, as nearly as staying close to it allows.

        ``mesh``: a mesh of COMPAS, meshio or trimesh; or an (n, 3) array or list of points, with ``faces``: lists of
        point indices, or an (m, k) array. It stays as it is.
        ``weight``: of the recipe's own constraints; 1 by default.
        ``closeness``: the weight that draws each point to where it was; 0.05 by default, 0 for none.
        ``fairness``: a weight at every point; 0 by default, for none (``rationalize``: for ten times the closeness).
        ``fairness_kind``: "keep-detail" or "smooth".
        ``anchors``: points that keep their place: indices, or vertex keys of a COMPAS mesh. ``anchor_boundary``: all
        points of the boundary too. ``anchor_corners``: those where the boundary turns by more than 75 degrees.
        ``length``, in model units: for ``equalize`` the length that edges are drawn to, by default the mean; for
        ``rationalize`` the distance that the diagonals of a quad may have, by default none: quads are planar.
        ``max_iterations``, ``tolerance``, ``time_budget_seconds``, ``progress``: see :meth:`Solver.solve_until`.

        Raises :class:`Error` for what the library refuses, :class:`ArgumentError` or :class:`ArgumentTypeError` for
        wrong shapes and types.
        """
        seen = view(mesh, faces)
        json = _text(
            self.__name__,
            seen,
            weight=weight,
            closeness=closeness,
            fairness=fairness,
            fairness_kind=fairness_kind,
            anchors=anchors,
            anchor_boundary=anchor_boundary,
            anchor_corners=anchor_corners,
            length=length,
        )
        with solver_of(json) as solver:
            report = solver.solve_until(max_iterations, tolerance, time_budget_seconds, progress=progress)
            points, violations = solver.points, solver.violations
        return Result(seen.with_points(points), points, report, violations)


def recipe(
    name: str,
    mesh: Any,
    faces: Optional[Any] = None,
    *,
    weight: Optional[float] = None,
    closeness: Optional[float] = None,
    fairness: Optional[float] = None,
    fairness_kind: Union[FairnessKind, str] = FairnessKind.KEEP_DETAIL,
    anchors: Iterable[int] = (),
    anchor_boundary: bool = False,
    anchor_corners: bool = False,
    length: Optional[float] = None,
) -> Problem:
    """The problem that a recipe makes of a mesh, to be changed or saved before it is solved.

    ``name``: one of :func:`recipe_names`. The other arguments, and what is raised: see :meth:`Recipe.__call__`.
    """
    json = _text(
        name,
        view(mesh, faces),
        weight=weight,
        closeness=closeness,
        fairness=fairness,
        fairness_kind=fairness_kind,
        anchors=anchors,
        anchor_boundary=anchor_boundary,
        anchor_corners=anchor_corners,
        length=length,
    )
    return Problem.from_json(json)


def recipe_names() -> tuple[str, ...]:
    """The names of the recipes."""
    return tuple(text(lib.shapeop_recipeName(i)) for i in range(lib.shapeop_recipeCount()))


def measure_names() -> tuple[str, ...]:
    """The names of the measures of faces."""
    return tuple(text(lib.shapeop_measureName(i)) for i in range(lib.shapeop_measureCount()))


def measure_faces(measure: str, mesh: Any, faces: Optional[Any] = None) -> Doubles:
    """Measures every face: an (m,) float64 array, or a list without numpy.

    ``measure``: one of :func:`measure_names`. "planarity" is a ratio (0.01 is 1 %): the distance of a quad's diagonals
    over their mean length; of other polygons the greatest distance from the best-fit plane over the mean edge.
    ``mesh``, ``faces``, and what is raised: as for recipes.
    """
    seen = view(mesh, faces)
    points, lists = _blocks(seen)
    name = _arrays.name_bytes(measure, "measure")
    values = (ctypes.c_double * lists.list_count)()
    check(lib.shapeop_measureFaces(name, *points, *lists.indices, *lists.counts, values, lists.list_count))
    return _arrays.doubles(values)


def _blocks(seen: View) -> tuple[_arrays.Block, _arrays.IndexLists]:
    lists = _arrays.index_lists(seen.faces, "faces")
    if lists.is_one:
        raise ArgumentError(f"faces: expected a list of faces, found {_arrays.found(seen.faces)}")
    return _arrays.points(seen.points), lists


def _text(name: str, seen: View, *, fairness_kind: Any, anchors: Any, **values: Any) -> str:
    """The problem that a recipe makes of a mesh, in JSON; options that are `None` are the library's defaults."""
    points, lists = _blocks(seen)
    options = _abi.shapeop_recipe_options(struct_size=ctypes.sizeof(_abi.shapeop_recipe_options))
    check(lib.shapeop_defaultRecipeOptions(ctypes.byref(options)))
    for key in ("weight", "closeness", "fairness", "length"):
        if values[key] is not None:
            setattr(options, key, _arrays.real(values[key], key))
    for key in ("anchor_boundary", "anchor_corners"):
        setattr(options, key, int(bool(values[key])))
    options.fairness_kind = _arrays.member(FairnessKind, fairness_kind, "fairness_kind")
    names = anchors if _arrays.is_array(anchors) else list(anchors)
    block = _arrays.ids(seen.indices_of(names), "anchors")
    options.anchors = ctypes.cast(block.pointer, ctypes.POINTER(ctypes.c_int))
    options.nb_anchors = block.length
    recipe_name = _arrays.name_bytes(name, "name")
    answer = lib.shapeop_recipe(recipe_name, *points, *lists.indices, *lists.counts, ctypes.byref(options))
    if answer is None:
        check_message()
    return text(answer)
