"""Strip boundaries of a design."""

from __future__ import annotations

import ctypes
from math import radians
from typing import Any, Optional, Union

from .. import _abi, _arrays
from .._calls import CallWatch, doubles, set_options, struct, vector
from .._library import ArgumentError, check, lib
from ._field import _Fields
from ._kinds import Axis, Boundary, Dropped, Image, LevelReport, Levels, Progress, ProgressFunction, Stop


def watch(progress: Optional[ProgressFunction]) -> CallWatch:
    """What calls ``progress``."""

    def told(now: Any) -> Progress:
        return Progress(now.iteration, now.fraction, now.value, now.largest_deviation, now.largest_gap)

    return CallWatch(_abi.shapeop_ruled_progress_callback, progress, told)


def _levels(count: Optional[int], width: Optional[float], values: Optional[Any]) -> tuple[Any, ...]:
    if [count, width, values].count(None) != 2:
        raise ArgumentError("levels: expected one of count, width and values")
    block = _arrays.Block(None, 0) if values is None else _arrays.numbers(values, "values")
    number = 0 if count is None else _arrays.integer(count, "count", 1)
    distance = 0.0 if width is None else _arrays.real(width, "width")
    if width is not None and distance == 0:
        raise ArgumentError("width: expected a number above 0, found 0")
    if values is not None and block.length == 0:
        raise ArgumentError("values: expected at least 1, found none")
    return (number, distance, *block)


def _plane(value: Any, name: str) -> list[float]:
    """The normal and the offset: four numbers, or a pair."""
    parts = list(value)
    if len(parts) == 2 and hasattr(parts[0], "__len__"):
        parts = [*parts[0], parts[1]]
    if len(parts) != 4:
        raise ArgumentError(f"{name}: expected a normal and an offset, found {_arrays.found(value)}")
    return [_arrays.real(number, name) for number in parts]


class _Boundaries(_Fields):
    """Level curves, plane sections, curves along great circles, and drawn ones."""

    def _ends(self, extends: bool, overshoots: bool, least_length: Optional[float] = None) -> Any:
        options = struct(_abi.shapeop_ruled_boundary_options)
        check(lib.shapeop_ruledDefaultBoundaryOptions(ctypes.byref(options)))
        truths = {"extends": _arrays.truth(extends, "extends"), "overshoots": _arrays.truth(overshoots, "overshoots")}
        return ctypes.byref(set_options(options, {**truths, "least_length": least_length}))

    def level_boundaries(
        self,
        count: Optional[int] = None,
        *,
        width: Optional[float] = None,
        values: Optional[Any] = None,
        kind: Union[Levels, str] = Levels.ORTHOGONAL,
        orthogonal: Optional[float] = None,
        direction: Optional[float] = None,
        equidistant: Optional[float] = None,
        geodesic: Optional[float] = None,
        conoidal: Optional[float] = None,
        laplace: Optional[float] = None,
        allow_folds: bool = False,
        max_iterations: Optional[int] = None,
        relative_decrease: Optional[float] = None,
        extends: bool = True,
        overshoots: bool = True,
        least_length: Optional[float] = None,
        progress: Optional[ProgressFunction] = None,
    ) -> None:
        """Finds a function that rises along the field and takes level curves of it as boundaries.

        One of ``count`` (so many, evenly spaced), ``width`` (as many as fit at this distance) and ``values`` (these) is
        given. ``kind`` says what boundaries are to be; weights that are given replace its own. ``extends``: open ends
        go on beyond the mesh; ``overshoots``: there is a boundary beyond it on both sides; curves shorter than
        ``least_length`` strip widths, 2 by default, are dropped. Takes back boundaries and strips.
        """
        options = struct(_abi.shapeop_ruled_level_options)
        check(lib.shapeop_ruledDefaultLevelOptions(_arrays.member(Levels, kind, "kind"), ctypes.byref(options)))
        weights = {
            "orthogonal": orthogonal,
            "direction": direction,
            "equidistant": equidistant,
            "geodesic": geodesic,
            "conoidal": conoidal,
            "laplace": laplace,
            "relative_decrease": relative_decrease,
            "max_iterations": max_iterations,
        }
        set_options(options, {**weights, "allow_folds": _arrays.truth(allow_folds, "allow_folds")})
        levels, ends = _levels(count, width, values), self._ends(extends, overshoots, least_length)
        with watch(progress) as watching:
            answer = lib.shapeop_ruledSetLevelBoundaries(
                self._handle, ctypes.byref(options), *levels, ends, watching.callback, None
            )
        check(answer)

    def set_levels(
        self,
        count: Optional[int] = None,
        *,
        width: Optional[float] = None,
        values: Optional[Any] = None,
        extends: bool = True,
        overshoots: bool = True,
        least_length: Optional[float] = None,
    ) -> None:
        """Takes other levels of the function that :meth:`level_boundaries` found; not on a mesh with holes."""
        ends = self._ends(extends, overshoots, least_length)
        check(lib.shapeop_ruledSetLevels(self._handle, *_levels(count, width, values), ends))

    def planar_boundaries(
        self,
        planes: Any,
        *,
        least_angle: float = radians(15),
        refuses_oblique: bool = False,
        extends: bool = True,
        overshoots: bool = True,
    ) -> Any:
        """Takes plane sections as boundaries; gives the least angle at which each crosses the field.

        Each plane is a pair ``(normal, offset)`` of ``normal . x = offset``, or its four numbers; they follow each
        other along the field, or against it. With ``refuses_oblique`` sections at less than ``least_angle`` to the
        field are refused.
        """
        rows = [_plane(plane, f"planes[{k}]") for k, plane in enumerate(planes)]
        block = _arrays.numbers([number for row in rows for number in row], "planes")
        angles, oblique = doubles(len(rows)), int(_arrays.truth(refuses_oblique, "refuses_oblique"))
        how = (_arrays.real(least_angle, "least_angle"), oblique, self._ends(extends, overshoots), angles)
        check(lib.shapeop_ruledSetPlanarBoundaries(self._handle, block.pointer, len(rows), *how))
        return _arrays.doubles(angles)

    def great_circle_boundaries(self, axes: Any, *, extends: bool = True, overshoots: bool = True) -> None:
        """Takes the curves as boundaries along which the field is orthogonal to one of ``axes``, (k, 3), each."""
        ends = self._ends(extends, overshoots)
        check(lib.shapeop_ruledSetGreatCircleBoundaries(self._handle, *_arrays.points(axes, "axes"), ends))

    def great_circle(self, axis: Any) -> list[Any]:
        """The curves on the mesh along which the field is orthogonal to ``axis``; closed ones end where they start."""
        direction, count, curve_count = vector(axis, "axis"), ctypes.c_int(), ctypes.c_int()
        counts = (ctypes.byref(count), ctypes.byref(curve_count))
        check(lib.shapeop_ruledGreatCircle(self._handle, direction, None, 0, counts[0], None, 0, counts[1]))
        points, lengths = doubles(3 * count.value), (ctypes.c_int * curve_count.value)()
        room = (points, count.value, counts[0], lengths, curve_count.value, counts[1])
        check(lib.shapeop_ruledGreatCircle(self._handle, direction, *room))
        rows, curves, first = _arrays.shaped(points, count.value, 3), [], 0
        for length in lengths:
            curves.append(rows[first : first + length])
            first += length
        return curves

    def drawn_boundaries(self, curves: Any, closed: Any = False, *, extends: bool = True) -> None:
        """Takes curves drawn by hand as boundaries: lists of points near the mesh, in their order along the field.

        ``closed``: whether the last point is followed by the first, for all or for each.
        """
        blocks = [_arrays.points(curve, f"curves[{k}]") for k, curve in enumerate(curves)]
        numbers = [number for block in blocks for number in block.pointer[: 3 * block.length]]
        counts = (ctypes.c_int * len(blocks))(*(block.length for block in blocks))
        truths = [closed] * len(blocks) if isinstance(closed, bool) else list(closed)
        if len(truths) != len(blocks):
            raise ArgumentError(f"closed: expected {len(blocks)}, one for each curve; found {len(truths)}")
        closings = (ctypes.c_int * len(blocks))(*(int(_arrays.truth(one, "closed")) for one in truths))
        points = (_arrays.numbers(numbers, "curves").pointer, sum(block.length for block in blocks))
        ends = self._ends(extends, False)
        check(lib.shapeop_ruledSetDrawnBoundaries(self._handle, *points, counts, len(blocks), closings, ends))

    # What was found.

    @property
    def level_values(self) -> Any:
        """The values of the level function at the points of the mesh, the least 0."""
        return _arrays.doubles(self._doubles(lib.shapeop_ruledLevelValues, 1))

    @property
    def level_history(self) -> Any:
        """The sum of the terms of the level function at the start and after each iteration."""
        return _arrays.doubles(self._doubles(lib.shapeop_ruledLevelHistory, 1))

    @property
    def critical_points(self) -> list[int]:
        """Points around which the level function does not rise on one side and fall on the other."""
        return list(self._ints(lib.shapeop_ruledCriticalPoints, 1))

    @property
    def level_report(self) -> LevelReport:
        """What was found of the level function."""
        told = struct(_abi.shapeop_ruled_level_report)
        check(lib.shapeop_ruledLevelReport(self._handle, ctypes.byref(told)))
        return LevelReport(
            stop=Stop(told.stop),
            iterations=told.iterations,
            critical_count=told.critical_count,
            least_slope=told.least_slope,
            greatest_slope=told.greatest_slope,
            image=Image(told.image),
            image_extent=told.image_extent,
            image_folded=told.image_folded,
            image_flatness=told.image_flatness,
            image_axis=(told.image_axis_x, told.image_axis_y, told.image_axis_z),
            image_unused_count=told.image_unused_count,
        )

    def _boundary(self, index: int) -> Boundary:
        closed, level = ctypes.c_int(), ctypes.c_double()
        more = (ctypes.byref(closed), ctypes.byref(level))
        values = self._doubles(lambda *a: lib.shapeop_ruledBoundary(*a, *more), 3, index)
        return Boundary(_arrays.shaped(values, len(values) // 3, 3), bool(closed.value), level.value)

    @property
    def boundaries(self) -> list[Boundary]:
        """The boundaries, in their order along the field."""
        return [self._boundary(i) for i in range(self._count(lib.shapeop_ruledBoundaryCount(self._handle)))]

    @property
    def boundary_pairs(self) -> list[tuple[int, int]]:
        """The two boundaries of each strip, before there are strips too."""
        values = self._ints(lib.shapeop_ruledBoundaryPairs, 2)
        return list(zip(values[0::2], values[1::2]))

    def boundary_axis(self, boundary: int) -> Axis:
        """The axis of the rulings that begin on a boundary, and the sine by which they are off (root mean square)."""
        direction, error = doubles(3), ctypes.c_double()
        number = _arrays.integer(boundary, "boundary")
        check(lib.shapeop_ruledBoundaryAxis(self._handle, number, direction, ctypes.byref(error)))
        return Axis(_arrays.doubles(direction), error.value)

    @property
    def unmatched_levels(self) -> Any:
        """The levels between which and the next one curves split, join or end, so that no strip is there."""
        return _arrays.doubles(self._doubles(lib.shapeop_ruledUnmatchedLevels, 1))

    @property
    def dropped_curves(self) -> list[Dropped]:
        """The curves that were too short to be boundaries."""
        levels = self._doubles(lambda *a: lib.shapeop_ruledDroppedCurves(a[0], a[1], None, *a[2:]), 1)
        lengths = self._doubles(lambda *a: lib.shapeop_ruledDroppedCurves(a[0], None, *a[1:]), 1)
        return [Dropped(*curve) for curve in zip(levels, lengths)]
