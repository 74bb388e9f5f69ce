"""Circular strips: from numbers, from circles, smoothed, closed."""

from __future__ import annotations

import ctypes
from typing import Any, Optional

from .. import _abi, _arrays
from .._library import ArgumentError, check, lib
from ._arguments import _circles, _doubles, _frame, _ints, _of_length, _optional, _truths, _vector, _Watch
from ._kinds import Closed, ClosingCircle, Holonomy, ProgressFunction, Smoothed, Stop, Strip


def _strip(function: Any, points: Any, start: Any, *arguments: Any, is_full: bool = False) -> Strip:
    count = points.length
    border, lengths, attainable, deviation = (
        _doubles(3 * count),
        _doubles(count),
        _doubles(count - 1),
        ctypes.c_double(),
    )
    flipped, projected = _ints(count - 1), _ints(count)
    rest = (attainable, flipped, projected, ctypes.byref(deviation)) if is_full else (flipped,)
    check(function(*points, _vector(start, "start"), *arguments, border, lengths, *rest))
    return Strip(
        _arrays.shaped(border, count, 3),
        _arrays.doubles(lengths),
        _arrays.doubles(attainable) if is_full else None,
        _truths(flipped),
        _truths(projected),
        deviation.value,
    )


def strip(
    points: Any,
    start: Any,
    lengths: Any,
    *,
    strict: bool = False,
    project_lengths: bool = False,
    fit_start: bool = False,
) -> Strip:
    """The strip of circular quads along ``points`` from ``start`` whose crossing edges have the given lengths.

    ``strict``: quads that cross themselves are refused. ``project_lengths``: a length that is not attainable is
    replaced by the nearest that is. ``fit_start``: the first crossing edge is turned to where the lengths can go on.
    """
    flags = int(strict) | int(project_lengths) << 1 | int(fit_start) << 2
    guide = _arrays.points(points)
    own = _of_length(lengths, "lengths", guide.length)
    return _strip(lib.shapeop_canalStrip, guide, start, own, flags, is_full=True)


def strip_of_radii(points: Any, start: Any, radii: Any, *, strict: bool = False) -> Strip:
    """The strip from the radius of each quad's circle."""
    guide = _arrays.points(points)
    own = _of_length(radii, "radii", max(guide.length - 1, 0))
    return _strip(lib.shapeop_canalStripOfRadii, guide, start, own, int(strict))


def strip_of_border_edges(points: Any, start: Any, edges: Any) -> Strip:
    """The strip from the lengths of the border's edges."""
    guide = _arrays.points(points)
    return _strip(
        lib.shapeop_canalStripOfBorderEdges, guide, start, _of_length(edges, "edges", max(guide.length - 1, 0))
    )


def strip_circles(guide: Any, border: Any) -> Any:
    """The circle of each quad of a strip, (n - 1, 7)."""
    a, b = _arrays.points(guide, "guide"), _arrays.points(border, "border")
    if a.length != b.length:
        raise ArgumentError(f"border: expected {a.length} points, found {b.length}")
    out = _doubles(7 * (a.length - 1))
    check(lib.shapeop_canalStripCircles(a.pointer, b.pointer, a.length, out))
    return _arrays.shaped(out, max(a.length - 1, 0), 7)


def strip_of_circles(circles: Any, start: Optional[Any] = None, end: Optional[Any] = None) -> tuple[Any, Any, float]:
    """The guide and the border of the strip whose quads have these circles, and how far points are off them."""
    block = _circles(circles, "circles")
    guide, border, distance = _doubles(3 * block.length + 3), _doubles(3 * block.length + 3), ctypes.c_double()
    ends = (_optional(start, "start"), _optional(end, "end"))
    check(lib.shapeop_canalStripOfCircles(*block, *ends, guide, border, ctypes.byref(distance)))
    count = block.length + 1
    return _arrays.shaped(guide, count, 3), _arrays.shaped(border, count, 3), distance.value


def smooth(
    guide: Any, border: Any, frame: Any, progress: Optional[ProgressFunction] = None, **options: float
) -> Smoothed:
    """Smooths a strip: less curvature of all arcs, with the guide's points on their curve.

    ``options``: the fields of ``shapeop_canal_smooth_options`` in the C header, such as ``max_iterations``.
    """
    a, b = _arrays.points(guide, "guide"), _arrays.points(border, "border")
    if a.length != b.length:
        raise ArgumentError(f"border: expected {a.length} points, found {b.length}")
    asked = _abi.shapeop_canal_smooth_options(struct_size=ctypes.sizeof(_abi.shapeop_canal_smooth_options))
    check(lib.shapeop_canalDefaultSmoothOptions(ctypes.byref(asked)))
    _set(asked, options)
    told = _abi.shapeop_canal_smooth_report(struct_size=ctypes.sizeof(_abi.shapeop_canal_smooth_report))
    out_guide, out_border, out_frame = _doubles(3 * a.length), _doubles(3 * a.length), _doubles(9)
    strip = (a.pointer, b.pointer, a.length, _frame(frame))
    outputs = (out_guide, out_border, None, out_frame, None, 0, None, ctypes.byref(told))
    with _Watch(progress) as watch:
        check(lib.shapeop_canalSmooth(*strip, ctypes.byref(asked), watch.callback, None, *outputs))
    return Smoothed(
        _arrays.shaped(out_guide, a.length, 3),
        _arrays.shaped(out_border, a.length, 3),
        _arrays.shaped(out_frame, 3, 3),
        told.before,
        told.after,
        told.iterations,
        Stop(told.stop),
    )


def _set(struct: Any, options: dict[str, Any]) -> None:
    """Sets the fields of an options struct."""
    types = {field[0]: field[1] for field in struct._fields_}
    for name, value in options.items():
        if name not in types or name in ("struct_size", "reserved"):
            names = ", ".join(key for key in types if key not in ("struct_size", "reserved"))
            raise ArgumentError(f"{name}: expected one of the options {names}")
        is_real = types[name] is ctypes.c_double
        setattr(struct, name, _arrays.real(value, name) if is_real else _arrays.integer(int(value), name))


def holonomy(points: Any) -> Holonomy:
    """How a frame comes back around a closed polygon."""
    block = _arrays.points(points)
    matrix, tangent, residual, closes = _doubles(9), _doubles(3), ctypes.c_double(), ctypes.c_int()
    check(lib.shapeop_canalHolonomy(*block, matrix, ctypes.byref(residual), ctypes.byref(closes), tangent))
    columns = list(matrix)
    rows = (ctypes.c_double * 9)(*(columns[3 * j + i] for i in range(3) for j in range(3)))
    return Holonomy(_arrays.shaped(rows, 3, 3), residual.value, bool(closes.value), _arrays.doubles(tangent))


def close_circles(first_circle: Any, last_circle: Any, start: Any, guide_first: Any, guide_last: Any) -> ClosingCircle:
    """The circle that closes a strip of circles.

    ``first_circle`` goes through ``start`` and the guide's first point, ``last_circle`` through its last point. Where
    both are on one sphere ``which_case`` is 1 and the strip starts at ``start``; else it is 2.
    """
    circle, first, last, case, crossed = _doubles(7), _doubles(3), _doubles(3), ctypes.c_int(), ctypes.c_int()
    circles = (_of_length(first_circle, "first_circle", 7), _of_length(last_circle, "last_circle", 7))
    points = (_vector(start, "start"), _vector(guide_first, "guide_first"), _vector(guide_last, "guide_last"))
    outputs = (circle, first, last, ctypes.byref(case), ctypes.byref(crossed))
    check(lib.shapeop_canalCloseCircles(*circles, *points, *outputs))
    places = (_arrays.doubles(first), _arrays.doubles(last))
    return ClosingCircle(_arrays.doubles(circle), *places, case.value, bool(crossed.value))


def close_strip(guide: Any, border: Any, last: Any) -> Closed:
    """Closes a strip with the guide's last point: the border then has one point more, and its first may move."""
    a, b = _arrays.points(guide, "guide"), _arrays.points(border, "border")
    if a.length != b.length:
        raise ArgumentError(f"border: expected {a.length} points, found {b.length}")
    out, circle, case, flipped = _doubles(3 * a.length + 3), _doubles(7), ctypes.c_int(), _ints(a.length + 1)
    strip = (a.pointer, b.pointer, a.length, _vector(last, "last"))
    check(lib.shapeop_canalCloseStrip(*strip, out, circle, ctypes.byref(case), flipped))
    return Closed(_arrays.shaped(out, a.length + 1, 3), _arrays.doubles(circle), case.value, _truths(flipped))


def lengths_between(points: Any, first: float, last: float) -> Any:
    """Lengths of crossing edges that go from ``first`` to ``last`` evenly along a polyline."""
    block = _arrays.points(points)
    out = _doubles(block.length)
    check(lib.shapeop_canalLengthsBetween(*block, _arrays.real(first, "first"), _arrays.real(last, "last"), out))
    return _arrays.doubles(out)


def edges_of_border(points: Any, length: float) -> Any:
    """The lengths of the edges of a border that is ``length`` long in all, in the proportions of the guide's."""
    block = _arrays.points(points)
    out = _doubles(block.length - 1)
    check(lib.shapeop_canalEdgesOfBorder(*block, _arrays.real(length, "length"), out))
    return _arrays.doubles(out)


def closed_frame(points: Any, wish: Any) -> Any:
    """The frame nearest to ``wish`` with which a surface along a closed polygon is smooth across the seam."""
    out = _doubles(9)
    check(lib.shapeop_canalClosedFrame(*_arrays.points(points), _frame(wish, "wish"), out))
    return _arrays.shaped(out, 3, 3)


def parallel_on_sphere(points: Any) -> Optional[Any]:
    """The closed polygon on a sphere with edges parallel to those of a closed polygon; ``None`` if there is none."""
    block, count = _arrays.points(points), ctypes.c_int()
    out = _doubles(3 * block.length)
    check(lib.shapeop_canalParallelOnSphere(*block, out, block.length, ctypes.byref(count), None))
    used = 3 * count.value
    return _arrays.shaped((ctypes.c_double * used)(*out[:used]), count.value, 3) if used else None


def strip_energy(guide: Any, border: Any, frame: Any) -> float:
    """What :func:`smooth` lowers: the sum of the squared curvatures of all arcs of a strip."""
    a, b, out = _arrays.points(guide, "guide"), _arrays.points(border, "border"), ctypes.c_double()
    if a.length != b.length:
        raise ArgumentError(f"border: expected {a.length} points, found {b.length}")
    check(lib.shapeop_canalStripEnergy(a.pointer, b.pointer, a.length, _frame(frame), ctypes.byref(out)))
    return out.value
