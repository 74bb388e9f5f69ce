"""Points, grids, frames: inversions, Combescure transformations, parallel meshes."""

from __future__ import annotations

import ctypes
from typing import Any, Optional

from .. import _arrays
from .._library import ArgumentError, check, lib
from ._arguments import _doubles, _frame, _Grid, _ints, _of_length, _optional, _truths, _vector
from ._kinds import Quality, Wraps


def invert_points(points: Any, center: Any, ratio: float) -> Any:
    """The images of points under an inversion."""
    block = _arrays.points(points)
    out = _doubles(3 * block.length)
    check(lib.shapeop_canalInvertPoints(*block, _vector(center, "center"), _arrays.real(ratio, "ratio"), out))
    return _arrays.shaped(out, block.length, 3)


def invert_circle(circle: Any, center: Any, ratio: float) -> tuple[Any, bool]:
    """The image of a circle, and whether it is a line: then a point of it, its direction, and 0."""
    out, is_line = _doubles(7), ctypes.c_int()
    source, middle = _of_length(circle, "circle", 7), _vector(center, "center")
    check(lib.shapeop_canalInvertCircle(source, middle, _arrays.real(ratio, "ratio"), out, ctypes.byref(is_line)))
    return _arrays.doubles(out), bool(is_line.value)


def check_circular(points: Any, quads: Any) -> Quality:
    """How circular quads are: ``quads`` has 4 point indices for each."""
    block, lists = _arrays.points(points), _arrays.face_lists(quads, "quads", 4)
    count = lists.list_count
    planarity, concyclicity, in_order = _doubles(count), _doubles(count), _ints(count)
    arguments = (*block, lists.indices.pointer, count)
    check(lib.shapeop_canalCheckCircular(*arguments, planarity, concyclicity, in_order))
    return Quality(_arrays.doubles(planarity), _arrays.doubles(concyclicity), _truths(in_order))


def grid_lengths(grid: Any, wraps: Wraps = (False, False)) -> tuple[Any, Any]:
    """The lengths of a grid's edges along column 0 and along row 0."""
    own = _Grid(grid, wraps)
    column, row = _doubles(own.spans[0]), _doubles(own.spans[1])
    check(lib.shapeop_canalGridLengths(*own.arguments, column, row))
    return _arrays.doubles(column), _arrays.doubles(row)


def polyline_lengths(grid: Any, column_points: Any, row_points: Any, wraps: Wraps = (False, False)) -> tuple[Any, Any]:
    """The lengths for :func:`combescure` of two polylines, parallel to column 0 and row 0, that replace them.

    They are below 0 where an edge points the other way. Along a direction that wraps a polyline ends where it starts.
    """
    own = _Grid(grid, wraps)
    columns, rows = _arrays.points(column_points, "column_points"), _arrays.points(row_points, "row_points")
    column, row = _doubles(own.spans[0]), _doubles(own.spans[1])
    check(lib.shapeop_canalPolylineLengths(*own.arguments, *columns, *rows, column, row))
    return _arrays.doubles(column), _arrays.doubles(row)


def close_lengths(grid: Any, column: Any, row: Any, wraps: Wraps) -> tuple[Any, Any]:
    """The lengths nearest to the given ones with which a grid that wraps closes."""
    own, columns, rows = _Grid(grid, wraps), _arrays.numbers(column, "column"), _arrays.numbers(row, "row")
    out_column, out_row = _doubles(columns.length), _doubles(rows.length)
    check(lib.shapeop_canalCloseLengths(*own.arguments, *columns, *rows, out_column, out_row))
    return _arrays.doubles(out_column), _arrays.doubles(out_row)


def combescure(
    grid: Any, column: Any, row: Any, origin: Optional[Any] = None, wraps: Wraps = (False, False)
) -> tuple[Any, int]:
    """The parallel grid with these lengths along column 0 and row 0, and how many edges point the other way."""
    own, columns, rows = _Grid(grid, wraps), _arrays.numbers(column, "column"), _arrays.numbers(row, "row")
    out, reversed_count = _doubles(3 * own.count), ctypes.c_int()
    first = _optional(origin, "origin")
    check(lib.shapeop_canalCombescure(*own.arguments, *columns, *rows, first, out, ctypes.byref(reversed_count)))
    return own.shaped(out), reversed_count.value


def parallel_space(points: Any, quads: Any) -> Any:
    """An orthonormal basis of all meshes parallel to a mesh of quads, at most 1000 points: (dimension, points, 3)."""
    block, lists = _arrays.points(points), _arrays.face_lists(quads, "quads", 4)
    arguments, dimension = (*block, lists.indices.pointer, lists.list_count), ctypes.c_int()
    check(lib.shapeop_canalParallelSpace(*arguments, None, 0, ctypes.byref(dimension)))
    basis = _doubles(3 * block.length * dimension.value)
    check(lib.shapeop_canalParallelSpace(*arguments, basis, dimension.value, ctypes.byref(dimension)))
    return _arrays.shaped(basis, dimension.value, block.length, 3)


def nearest_parallel(points: Any, quads: Any, handles: Any, targets: Any) -> Any:
    """The parallel mesh whose points ``handles`` are nearest to ``targets``.

    Of more than 1000 points all are targets of their own, a millionth as heavy as a handle: the more of them must move
    far, the less exactly handles are met.
    """
    block, lists = _arrays.points(points), _arrays.face_lists(quads, "quads", 4)
    indices, goals = _arrays.ids(handles, "handles"), _arrays.points(targets, "targets")
    if indices.length != goals.length:
        raise ArgumentError(f"targets: expected {indices.length}, one for each handle; found {goals.length}")
    out = _doubles(3 * block.length)
    mesh = (*block, lists.indices.pointer, lists.list_count)
    check(lib.shapeop_canalNearestParallel(*mesh, indices.pointer, goals.pointer, goals.length, out))
    return _arrays.shaped(out, block.length, 3)


def invert_complex(points: Any, center: complex, ratio: float) -> list[complex]:
    """The images of complex numbers under an inversion of the plane."""
    numbers = [complex(point) for point in points]
    block = _arrays.numbers([part for number in numbers for part in (number.real, number.imag)], "points")
    out, middle = _doubles(2 * len(numbers)), _arrays.numbers([center.real, center.imag], "center").pointer
    check(lib.shapeop_canalInvertComplex(block.pointer, len(numbers), middle, _arrays.real(ratio, "ratio"), out))
    return [complex(out[2 * k], out[2 * k + 1]) for k in range(len(numbers))]


def invert_sphere(sphere: Any, center: Any, ratio: float) -> tuple[Any, bool]:
    """The image of a sphere ``[x, y, z, radius]``, and whether it is a plane: see ``shapeop_canalInvertSphere``."""
    values = [float(number) for number in sphere]
    if len(values) != 4:
        raise ArgumentError(f"sphere: expected 4 numbers, found {_arrays.found(sphere)}")
    out, is_plane = _doubles(7), ctypes.c_int()
    middle, power = _vector(center, "center"), _arrays.real(ratio, "ratio")
    source = _vector(values[:3], "sphere")
    check(lib.shapeop_canalInvertSphere(source, values[3], middle, power, out, ctypes.byref(is_plane)))
    return _arrays.doubles(out), bool(is_plane.value)


def invert_plane(point: Any, normal: Any, center: Any, ratio: float) -> tuple[Any, bool]:
    """The image of a plane, and whether it is a plane again: see ``shapeop_canalInvertSphere``."""
    out, is_plane = _doubles(7), ctypes.c_int()
    plane = (_vector(point, "point"), _vector(normal, "normal"))
    middle, power = _vector(center, "center"), _arrays.real(ratio, "ratio")
    check(lib.shapeop_canalInvertPlane(*plane, middle, power, out, ctypes.byref(is_plane)))
    return _arrays.doubles(out), bool(is_plane.value)


def check_parallel(a: Any, b: Any, edges: Any) -> tuple[float, int]:
    """The largest sine between edges, pairs of point indices, of two meshes, and how many point the other way."""
    first, second, pairs = _arrays.points(a, "a"), _arrays.points(b, "b"), _arrays.face_lists(edges, "edges", 2)
    if first.length != second.length:
        raise ArgumentError(f"b: expected {first.length} points, found {second.length}")
    sine, reversed_count = ctypes.c_double(), ctypes.c_int()
    meshes = (first.pointer, second.pointer, first.length, pairs.indices.pointer, pairs.list_count)
    check(lib.shapeop_canalCheckParallel(*meshes, ctypes.byref(sine), ctypes.byref(reversed_count)))
    return sine.value, reversed_count.value


def translation(rail: Any, profile: Any, factors: Optional[Any] = None) -> Any:
    """The surface of translation, (rows, columns, 3), or of scale-translation with one factor for each rail point."""
    a, b = _arrays.points(rail, "rail"), _arrays.points(profile, "profile")
    own = None if factors is None else _of_length(factors, "factors", a.length)
    points, capacity = _doubles(3 * a.length * b.length), a.length * b.length
    count, rows, columns = (ctypes.c_int() for _ in range(3))
    outputs = (points, capacity, ctypes.byref(count), ctypes.byref(rows), ctypes.byref(columns), None)
    check(lib.shapeop_canalTranslation(*a, *b, own, *outputs))
    used = 3 * count.value
    return _arrays.shaped((ctypes.c_double * used)(*points[:used]), rows.value, columns.value, 3)


def grid_of_mesh(points: Any, quads: Any, component: int = 0) -> tuple[list[list[int]], Wraps, int]:
    """A component of a mesh of quads as a grid: point indices in rows, what wraps, and the number of components."""
    block, lists = _arrays.points(points), _arrays.face_lists(quads, "quads", 4)
    total, rows, columns, bits, count = (ctypes.c_int() for _ in range(5))
    indices = _ints(block.length)
    mesh = (*block, lists.indices.pointer, lists.list_count, _arrays.integer(component, "component"))
    sizes = tuple(ctypes.byref(each) for each in (total, rows, columns, bits))
    check(lib.shapeop_canalGridOfMesh(*mesh, *sizes, indices, block.length, ctypes.byref(count)))
    own = [list(indices[i * columns.value : (i + 1) * columns.value]) for i in range(rows.value)]
    return own, (bool(bits.value & 1), bool(bits.value & 2)), total.value


def frame_of_angles(polar: float, azimuth: float, turn: float = 0.0) -> Any:
    """The frame (t1, t2, normal) whose normal is at ``polar`` from z and ``azimuth`` from x, turned about it."""
    out = _doubles(9)
    angles = (_arrays.real(azimuth, "azimuth"), _arrays.real(polar, "polar"), _arrays.real(turn, "turn"))
    check(lib.shapeop_canalFrameOfAngles(*angles, out))
    return _arrays.shaped(out, 3, 3)


def frame_of_tangent(tangent: Any, normal: Any, direction: int = 1) -> Any:
    """The frame with a tangent in direction 1 or 2 and the normal as near as possible to ``normal``."""
    out = _doubles(9)
    vectors = (_vector(tangent, "tangent"), _vector(normal, "normal"))
    check(lib.shapeop_canalFrameOfTangent(*vectors, _arrays.integer(direction, "direction"), out))
    return _arrays.shaped(out, 3, 3)


def frame_across(frame: Any, edge: Any, direction: int = 1) -> Any:
    """The frame at the other end of an edge in direction 1 or 2 of a circular grid."""
    out = _doubles(9)
    arguments = (_frame(frame), _vector(edge, "edge"), _arrays.integer(direction, "direction"))
    check(lib.shapeop_canalFrameAcross(*arguments, out))
    return _arrays.shaped(out, 3, 3)


def grid_frames(grid: Any, frame: Any, wraps: Wraps = (False, False)) -> tuple[Any, float]:
    """The frames at all points of a circular grid, (rows, columns, 3, 3), and their gap across seams."""
    own, gap = _Grid(grid, wraps), ctypes.c_double()
    out = _doubles(9 * own.count)
    check(lib.shapeop_canalGridFrames(*own.arguments, _frame(frame), out, ctypes.byref(gap)))
    return _arrays.shaped(out, own.rows, own.columns, 3, 3), gap.value


def folds(grid: Any, wraps: Wraps = (False, False)) -> tuple[Any, Any, list[int]]:
    """Where a grid folds: per row how far it reaches towards the evolute of column 0 (1: up to it); per face the least
    ratio of opposite edges, and flags: 1 flipped, 2 shrunk."""
    own = _Grid(grid, wraps)
    count = max(own.spans[0], 0) * max(own.spans[1], 0)
    evolute, edges, flags = _doubles(own.rows), _doubles(count), _ints(count)
    check(lib.shapeop_canalFolds(*own.arguments, evolute, None, edges, flags))
    return _arrays.doubles(evolute), _arrays.doubles(edges), list(flags)
