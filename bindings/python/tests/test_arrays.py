"""numpy arrays: shapes, dtypes, and what is passed without a copy."""

from __future__ import annotations

import ctypes
from typing import Any

import pytest

import shapeop
from near import assert_near
from samples import SQUARE, saddle
from shapeop import Solver, _arrays

np = pytest.importorskip("numpy")


def test_points_come_back_as_a_new_float64_array() -> None:
    with Solver(np.array(SQUARE)) as solver:
        points = solver.points
        assert (points.shape, points.dtype, points.flags.c_contiguous) == ((4, 3), np.float64, True)
        points[:] = 7
        assert_near(solver.points, SQUARE, 0)
        assert solver.violations.dtype == np.float64
        assert Solver().points.shape == (0, 3)


def test_a_c_contiguous_float64_array_reaches_the_library_without_a_copy() -> None:
    points = np.array(SQUARE)
    block = _arrays.points(points)
    assert ctypes.cast(block.pointer, ctypes.c_void_p).value == points.ctypes.data
    faces = np.array([[0, 1, 2, 3]], dtype=np.int32)
    lists = _arrays.index_lists(faces, "indices")
    assert ctypes.cast(lists.indices.pointer, ctypes.c_void_p).value == faces.ctypes.data
    assert np.array_equal(points, SQUARE)


def test_points_are_filled_into_the_array_that_is_given() -> None:
    with Solver(SQUARE) as solver:
        out = np.zeros((4, 3))
        assert solver.get_points(out=out) is out
        assert np.array_equal(out, SQUARE)
        part = np.zeros((6, 3))
        solver.get_points(out=part[1:5])
        assert np.array_equal(part, [[0, 0, 0], *SQUARE, [0, 0, 0]])


@pytest.mark.parametrize(
    ("out", "kind"),
    [
        (np.zeros((3, 3)), shapeop.ArgumentError),
        (np.zeros(12), shapeop.ArgumentError),
        (np.zeros((4, 3), dtype=np.float32), shapeop.ArgumentTypeError),
        (np.zeros((4, 3), dtype=">f8"), shapeop.ArgumentTypeError),
        (np.zeros((4, 3), order="F"), shapeop.ArgumentTypeError),
        (np.zeros((4, 6))[:, ::2], shapeop.ArgumentTypeError),
        (np.broadcast_to(np.zeros(3), (4, 3)), shapeop.ArgumentTypeError),
    ],
)
def test_an_array_that_cannot_be_filled_is_refused(out: Any, kind: type[Exception]) -> None:
    with Solver(SQUARE) as solver, pytest.raises(kind, match="out: expected"):
        solver.get_points(out=out)
    assert not out.any()


@pytest.mark.parametrize("dtype", ["f4", "f2", ">f8", "i4", "u2"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_points_of_other_real_dtypes_and_orders_are_converted(dtype: str, order: Any) -> None:
    points = np.array(SQUARE, dtype=dtype, order=order)
    with Solver(points) as solver:
        assert np.array_equal(solver.points, SQUARE)
        solver.points = np.repeat(points, 2, axis=0)[::2]
        assert np.array_equal(solver.points, SQUARE)


@pytest.mark.parametrize(
    ("points", "kind", "text"),
    [
        (np.zeros((4, 2)), shapeop.ArgumentError, r"shape \(n, 3\), found an array of float64 of shape \(4, 2\)"),
        (np.zeros(12), shapeop.ArgumentError, r"shape \(n, 3\), found an array of float64 of shape \(12,\)"),
        (np.zeros((4, 3, 1)), shapeop.ArgumentError, r"shape \(4, 3, 1\)"),
        (np.zeros((4, 3), dtype=complex), shapeop.ArgumentTypeError, "real numbers, found an array of complex128"),
        (np.zeros((4, 3), dtype=bool), shapeop.ArgumentTypeError, "real numbers, found an array of bool"),
        (np.full((4, 3), "a"), shapeop.ArgumentTypeError, "real numbers, found an array of <U1"),
        (np.full((4, 3), None), shapeop.ArgumentTypeError, "real numbers, found an array of object"),
    ],
)
def test_points_of_other_shapes_and_dtypes_are_refused(points: Any, kind: type[Exception], text: str) -> None:
    with Solver(SQUARE) as solver, pytest.raises(kind, match=f"points: expected .*{text}"):
        solver.points = points
    with pytest.raises(kind, match=text):
        Solver(points)


@pytest.mark.parametrize("dtype", ["i4", "i8", "u1", "u8", ">i8"])
def test_faces_of_any_integer_dtype_add_a_constraint_per_row(dtype: str) -> None:
    with Solver(saddle(0.1) + saddle(0.2)) as solver:
        faces = np.array([[0, 1, 2, 3], [4, 5, 6, 7]], dtype=dtype)
        assert solver.add("Plane", faces) == range(0, 2)
        assert solver.add("Plane", faces[1]) == 2
        assert solver.add("Plane", faces[:, 1:]) == range(3, 5)
        assert solver.add("Plane", faces[:0]) == range(0)
        assert solver.add("Plane", list(faces)) == range(5, 7)
        assert_near(solver.violations, [0.1, 0.2, 0.2, *solver.violations[3:5], 0.1, 0.2])


@pytest.mark.parametrize(
    ("faces", "kind", "text"),
    [
        (np.array([[0.0, 1, 2, 3]]), shapeop.ArgumentTypeError, "integers, found an array of float64"),
        (np.array([[True, False, True]]), shapeop.ArgumentTypeError, "integers, found an array of bool"),
        (np.array(3), shapeop.ArgumentError, r"shape \(k,\) or \(n, k\), found .* \(\)"),
        (np.zeros((1, 2, 2), dtype=int), shapeop.ArgumentError, r"shape \(1, 2, 2\)"),
        (np.array([[0, 1, 2**33]]), shapeop.ArgumentError, "from -2147483648 to 2147483647, found 8589934592"),
        ([np.array([0.0, 1, 2])], shapeop.ArgumentTypeError, "expected integers"),
    ],
)
def test_faces_of_other_dtypes_and_shapes_are_refused(faces: Any, kind: type[Exception], text: str) -> None:
    with Solver(SQUARE) as solver, pytest.raises(kind, match=f"indices: expected .*{text}|indices: {text}"):
        solver.add("Plane", faces)


def test_an_index_that_wraps_around_in_32_bits_is_not_taken_for_another() -> None:
    with Solver(SQUARE) as solver, pytest.raises(shapeop.ArgumentError):
        solver.add("Closeness", np.array([[2**32]]))


def test_weights_scalars_and_ids_may_be_arrays() -> None:
    with Solver(np.zeros((3, 3))) as solver:
        targets = np.arange(9.0).reshape(3, 3)
        ids = solver.add("Closeness", np.array([[0], [1], [2]]), weight=np.array([1, 2, 3]), scalars=targets)
        solver.add("Closeness", [[0], [1], [2]], weight=1)
        solver.init()
        solver.solve(1)
        assert_near(solver.points, targets * [[1 / 2], [2 / 3], [3 / 4]])
        solver.edit("Closeness", np.array(ids), -targets[::-1][::-1])
        solver.set_weights(np.array([0, 1]), np.float32(1))
        solver.solve(1)
        assert_near(solver.points, -targets * [[1 / 2], [1 / 2], [3 / 4]])
        solver.remove(np.array([0, 1, 2]))
        solver.solve(1)
        assert_near(solver.points, np.zeros((3, 3)))
        with pytest.raises(shapeop.ArgumentTypeError, match="ids: expected integers, found an array of float64"):
            solver.set_weights(np.array([1.0]), 1)


def test_a_shape_array_is_one_set_for_one_constraint_and_one_per_constraint_for_many() -> None:
    shape = 2 * np.array(SQUARE)
    with Solver(np.array([*SQUARE, *SQUARE])) as solver:
        solver.add("Rigid", [0, 1, 2, 3], scalars=shape)
        solver.add("Rigid", np.array([[4, 5, 6, 7]]), scalars=shape[np.newaxis])
        solver.init()
        solver.solve_until()
        expected = shape - 0.5 * np.array([1, 1, 0])
        assert_near(solver.points, [*expected, *expected], 1e-9)
