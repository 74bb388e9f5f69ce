"""Strips of a design: starting, conditions, optimising, judging."""

from __future__ import annotations

import ctypes
from typing import Any, Optional, Union

from .. import _abi, _arrays
from .._calls import doubles, optional_vector, set_options, sized, struct, told_text
from .._library import ArgumentError, check, lib
from ._boundaries import _Boundaries, _plane, watch
from ._kinds import (
    End,
    Evaluated,
    JointReport,
    Optimised,
    ProgressFunction,
    Report,
    Started,
    Stop,
    Strip,
    StripReport,
)


class _Strips(_Boundaries):
    """Strips between boundaries."""

    def start(self, control_count: int = 12, shared: bool = False) -> Started:
        """Makes a strip between each pair of boundaries, with rulings along asymptotic curves.

        A strip has ``control_count`` control points on each boundary. With ``shared`` neighbours have their common
        boundary as one, so that nothing can gape.
        """
        number, is_shared = _arrays.integer(control_count, "control_count"), int(_arrays.truth(shared, "shared"))
        check(lib.shapeop_ruledStart(self._handle, number, is_shared))
        missed = self._ints(lambda *a: lib.shapeop_ruledStarted(a[0], a[1], None, *a[2:]), 1)
        moved = self._ints(lambda *a: lib.shapeop_ruledStarted(a[0], None, *a[1:]), 1)
        return Started(list(missed), list(moved))

    @property
    def strip_count(self) -> int:
        """The number of strips."""
        return self._count(lib.shapeop_ruledStripCount(self._handle))

    def strip(self, index: int) -> Strip:
        """A strip."""
        number, closed = _arrays.integer(index, "strip"), ctypes.c_int()
        control = self._doubles(lambda *a: lib.shapeop_ruledControl(*a, ctypes.byref(closed)), 6, number)
        knots = self._doubles(lib.shapeop_ruledKnots, 1, number)
        shaped = _arrays.shaped(control, 2, len(control) // 6, 3)
        return Strip(shaped, _arrays.doubles(knots), bool(closed.value))

    @property
    def strips(self) -> list[Strip]:
        """All strips."""
        return [self.strip(i) for i in range(self.strip_count)]

    @property
    def joints(self) -> list[tuple[int, int]]:
        """The pairs of neighbours: the second boundary of one is the first of the other."""
        values = self._ints(lambda *a: lib.shapeop_ruledJoints(*a, None), 2)
        return list(zip(values[0::2], values[1::2]))

    @property
    def is_shared(self) -> bool:
        """Whether neighbours have their common boundary as one."""
        count, shared = ctypes.c_int(), ctypes.c_int()
        check(lib.shapeop_ruledJoints(self._handle, None, 0, ctypes.byref(count), ctypes.byref(shared)))
        return bool(shared.value)

    def set_control(self, strip: int, control: Any) -> None:
        """Moves the control points of a strip, (2, n, 3) as those of :meth:`strip`; shared boundaries go along."""
        sides = [_arrays.points(side, f"control[{k}]") for k, side in enumerate(control)]
        if len(sides) != 2 or sides[0].length != sides[1].length:
            raise ArgumentError(f"control: expected as many points of two boundaries, found {_arrays.found(control)}")
        count = sides[0].length
        numbers = _arrays.numbers([number for side in sides for number in side.pointer[: 3 * count]], "control")
        check(lib.shapeop_ruledSetControl(self._handle, _arrays.integer(strip, "strip"), numbers.pointer, count))

    def evaluate(self, strip: int, u: float, v: float) -> Evaluated:
        """A strip at ``u``, from 0 to the last knot, and ``v``, 0 on its first boundary to 1 on its second."""
        point, derivatives, normal = doubles(3), doubles(6), doubles(3)
        place = (_arrays.integer(strip, "strip"), _arrays.real(u, "u"), _arrays.real(v, "v"))
        check(lib.shapeop_ruledEvaluate(self._handle, *place, point, derivatives, normal))
        slopes = _arrays.shaped(derivatives, 2, 3)
        return Evaluated(_arrays.doubles(point), slopes[0], slopes[1], _arrays.doubles(normal))

    def to_json(self) -> str:
        """The JSON form of the strips (``docs/ruled.schema.json``)."""
        return told_text(lib.shapeop_ruledStripsText(self._handle))

    def set_strips(self, json: str) -> None:
        """Takes the strips that a text states, as :meth:`to_json` writes it."""
        check(lib.shapeop_ruledSetStripsText(self._handle, _arrays.name_bytes(json, "json")))

    # Conditions, which hold exactly after `optimise`. One of the same kind for the same place is replaced.

    def constrain_plane(self, boundary: int, plane: Optional[Any] = None) -> None:
        """A boundary is in a plane ``(normal, offset)``; by default in the one that it was cut by."""
        numbers = None if plane is None else _arrays.numbers(_plane(plane, "plane"), "plane").pointer
        check(lib.shapeop_ruledConstrainPlane(self._handle, _arrays.integer(boundary, "boundary"), numbers))

    def constrain_cut_planes(self) -> None:
        """All boundaries are in the planes that they were cut by."""
        check(lib.shapeop_ruledConstrainCutPlanes(self._handle))

    def constrain_point(self, strip: int, side: int, end: Union[End, str], point: Optional[Any] = None) -> None:
        """An end of a boundary, ``side`` 0 or 1, is at a point; by default where it is."""
        place = (_arrays.integer(strip, "strip"), _arrays.integer(side, "side"), _arrays.member(End, end, "end"))
        check(lib.shapeop_ruledConstrainPoint(self._handle, *place, optional_vector(point, "point")))

    def constrain_ends(self) -> None:
        """All ends of boundaries stay where they are."""
        check(lib.shapeop_ruledConstrainEnds(self._handle))

    def constrain_end_direction(self, strip: int, end: Union[End, str], direction: Optional[Any] = None) -> None:
        """The ruling at an end is parallel to a vector; by default to itself as it is."""
        place = (_arrays.integer(strip, "strip"), _arrays.member(End, end, "end"))
        check(lib.shapeop_ruledConstrainEndDirection(self._handle, *place, optional_vector(direction, "direction")))

    def constrain_conoid(self, strip: int, axis: Optional[Any] = None) -> None:
        """All rulings of a strip are orthogonal to an axis; by default to the one that they are nearest to."""
        number = _arrays.integer(strip, "strip")
        check(lib.shapeop_ruledConstrainConoid(self._handle, number, optional_vector(axis, "axis")))

    @property
    def condition_count(self) -> int:
        """The number of conditions."""
        return self._count(lib.shapeop_ruledConditionCount(self._handle))

    def clear_conditions(self) -> None:
        """Takes all conditions away."""
        check(lib.shapeop_ruledClearConditions(self._handle))

    def optimise(
        self,
        *,
        max_iterations: Optional[int] = None,
        tolerance: Optional[float] = None,
        proximity: Optional[float] = None,
        beyond: Optional[float] = None,
        gap: Optional[float] = None,
        coverage: Optional[float] = None,
        thin_plate: Optional[float] = None,
        proximal: Optional[float] = None,
        largest_deviation: Optional[float] = None,
        least_width: Optional[float] = None,
        samples_along: Optional[int] = None,
        samples_across: Optional[int] = None,
        progress: Optional[ProgressFunction] = None,
    ) -> Optimised:
        """Brings the strips as near as they come to the mesh and to each other, under the conditions.

        What is not given is the library's: weights of the distance to the mesh (``proximity`` 1, of which ``beyond``
        0.01 outside of it), between neighbours (``gap`` 1), from the mesh to strips (``coverage`` 1), and of the way
        from the start (``thin_plate`` 1e-6, ``proximal`` 1e-4). ``largest_deviation`` and ``least_width`` are bounds.
        """
        options = struct(_abi.shapeop_ruled_optimise_options)
        check(lib.shapeop_ruledDefaultOptimiseOptions(ctypes.byref(options)))
        weights = {"proximity": proximity, "beyond": beyond, "gap": gap, "coverage": coverage}
        way = {"thin_plate": thin_plate, "proximal": proximal, "tolerance": tolerance}
        counts = {"max_iterations": max_iterations, "samples_along": samples_along, "samples_across": samples_across}
        bounds = {"largest_deviation": largest_deviation, "least_width": least_width}
        for name, bound in bounds.items():
            if bound is not None and bound == 0:
                raise ArgumentError(f"{name}: expected a number above 0, found 0")
        set_options(options, {**weights, **way, **counts, **bounds})
        told = struct(_abi.shapeop_ruled_optimise_report)
        with watch(progress) as watching:
            answer = lib.shapeop_ruledOptimise(
                self._handle, ctypes.byref(options), watching.callback, None, ctypes.byref(told)
            )
        check(answer)
        names = [name for name, _ in told._fields_ if name not in ("struct_size", "stop")]
        return Optimised(stop=Stop(told.stop), **{name: getattr(told, name) for name in names})

    @property
    def history(self) -> Any:
        """The start and each iteration of the last optimisation, (k, 10).

        The value, its terms of proximity, gap, coverage and way, the excess over bounds, the part of the step that was
        taken, how far a control point moved at most, the largest deviation, the largest gap.
        """
        values = self._doubles(lib.shapeop_ruledHistory, 10)
        return _arrays.shaped(values, len(values) // 10, 10)

    def report(
        self,
        *,
        samples_along: Optional[int] = None,
        samples_across: Optional[int] = None,
        feature_ratio: Optional[float] = None,
        columns_per_span: Optional[int] = None,
        trim_tolerance: Optional[float] = None,
    ) -> Report:
        """Measures the strips against the mesh and each other.

        A strip is too wide where its width is above ``feature_ratio``, 0.5 by default, of the least radius of
        curvature.
        """
        options, told = struct(_abi.shapeop_ruled_report_options), struct(_abi.shapeop_ruled_report)
        check(lib.shapeop_ruledDefaultReportOptions(ctypes.byref(options)))
        counts = {"samples_along": samples_along, "samples_across": samples_across}
        trim = {"columns_per_span": columns_per_span, "trim_tolerance": trim_tolerance}
        set_options(options, {**counts, **trim, "feature_ratio": feature_ratio})
        check(lib.shapeop_ruledReport(self._handle, ctypes.byref(options), ctypes.byref(told)))
        skipped = ("struct_size", "strip_count", "joint_count", "too_wide_count")
        numbers = {name: getattr(told, name) for name, _ in told._fields_ if name not in skipped}
        wide = sized(lambda n: (ctypes.c_int * n)(), 1, lambda *a: int(lib.shapeop_ruledTooWide(self._handle, *a)))
        return Report(
            strips=tuple(self._strip_report(i) for i in range(told.strip_count)),
            joints=tuple(self._joint_report(i) for i in range(told.joint_count)),
            too_wide=tuple(wide),
            json=told_text(lib.shapeop_ruledReportText(self._handle)),
            **numbers,
        )

    def _strip_report(self, index: int) -> StripReport:
        told = struct(_abi.shapeop_ruled_strip_report)
        check(lib.shapeop_ruledStripReport(self._handle, index, ctypes.byref(told)))
        skipped = ("struct_size", "is_too_wide", "at_x", "at_y", "at_z")
        numbers = {name: getattr(told, name) for name, _ in told._fields_ if name not in skipped}
        return StripReport(is_too_wide=bool(told.is_too_wide), at=(told.at_x, told.at_y, told.at_z), **numbers)

    def _joint_report(self, index: int) -> JointReport:
        told = struct(_abi.shapeop_ruled_joint_report)
        check(lib.shapeop_ruledJointReport(self._handle, index, ctypes.byref(told)))
        return JointReport(
            strips=(told.first, told.second),
            gap_count=told.gap_count,
            kink_count=told.kink_count,
            largest_gap=told.largest_gap,
            mean_gap=told.mean_gap,
            gap_at=(told.gap_x, told.gap_y, told.gap_z),
            largest_kink=told.largest_kink,
            mean_kink=told.mean_kink,
            kink_at=(told.kink_x, told.kink_y, told.kink_z),
        )
