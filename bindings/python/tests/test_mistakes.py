"""Every mistake gets an exception that names the argument, what was expected and what was found; nothing changes."""

from __future__ import annotations

from typing import Any, Callable

import pytest

import shapeop
from near import assert_near, flat
from shapeop import ErrorCode, Solver

POINTS = [[0.0, 0.0, 0.1], [1.0, 0.0, -0.1], [1.0, 1.0, 0.1], [0.0, 1.0, -0.1]]
NAN = float("nan")

Case = tuple[str, Callable[[Solver], Any], type[Exception], "int | None", str]


def made() -> Solver:
    solver = Solver(POINTS)
    solver.add("Plane", [0, 1, 2, 3])
    solver.add("Closeness", [[0], [1]])
    solver.add_gravity([0, 0, 0])
    solver.init()
    return solver


def set_points(points: Any) -> Callable[[Solver], None]:
    return lambda solver: setattr(solver, "points", points)


TYPE, VALUE = shapeop.ArgumentTypeError, shapeop.ArgumentError
REFUSED: list[Any] = [
    ("index", lambda s: s.add("Plane", [0, 1, 99]), shapeop.IndexRangeError, 17, r"indices\[2\]: 99 .* 4 points"),
    ("negative", lambda s: s.add("Plane", [[0, 1, 2], [0, 1, -1]]), shapeop.IndexRangeError, 17, "constraint 4.*-1"),
    ("type name", lambda s: s.add("Flat", [0, 1, 2]), shapeop.InvalidValueError, 1, '"Flat" is not one of'),
    ("count", lambda s: s.add("Plane", [0, 1]), shapeop.InvalidValueError, 2, "expected at least 3.*Plane.*2"),
    ("scalar count", lambda s: s.add("Closeness", [0], scalars=[1, 2]), shapeop.InvalidValueError, 2, "3.*2"),
    ("scalars", lambda s: s.add("EdgeStrain", [0, 1], scalars=[1, 2, 1]), shapeop.InvalidValueError, 16, "EdgeStrain"),
    ("weight", lambda s: s.add("Plane", [0, 1, 2], weight=-1), shapeop.InvalidValueError, 16, "weight.*-1"),
    ("nan weight", lambda s: s.add("Plane", [0, 1, 2], weight=NAN), shapeop.InvalidValueError, 16, "weight.*NaN"),
    ("nan scalar", lambda s: s.add("Closeness", [0], scalars=[0, 0, NAN]), shapeop.InvalidValueError, 16, "NaN"),
    ("edit type", lambda s: s.edit("Plane", 0, [1]), shapeop.InvalidValueError, 1, "Plane"),
    ("edit other", lambda s: s.edit("Closeness", 0, [0, 0, 0]), shapeop.UnknownIdError, 3, "0"),
    ("edit unknown", lambda s: s.edit(None, 9, [0, 0, 0]), shapeop.UnknownIdError, 3, "9"),
    ("edit some", lambda s: s.edit("Closeness", [1, 0], [0, 0, 9]), shapeop.UnknownIdError, 3, r"constraint_ids\[1\]"),
    ("set weight", lambda s: s.set_weights([1, 7], 2), shapeop.UnknownIdError, 3, "7"),
    ("remove", lambda s: s.remove(7), shapeop.UnknownIdError, 3, "7"),
    ("remove some", lambda s: s.remove([1, 7, 2]), shapeop.UnknownIdError, 3, "7"),
    ("remove force", lambda s: s.remove_force(7), shapeop.UnknownIdError, 18, "7"),
    ("tolerance", lambda s: s.solve_until(tolerance=-1.0), shapeop.InvalidValueError, 16, "tolerance.*-1"),
    ("threads", lambda s: s.set_threads(5000), shapeop.InvalidValueError, 16, "5000"),
    ("memory", lambda s: s.set_acceleration("anderson", 999), shapeop.InvalidValueError, 16, "999"),
    ("backend", lambda s: setattr(s, "backend", 17), shapeop.InvalidValueError, 16, "17"),
    ("kind", lambda s: s.set_acceleration(17), shapeop.InvalidValueError, 16, "17"),
    ("nan point", set_points([[0, 0, 0], [0, NAN, 0], [0, 0, 0], [0, 0, 0]]), shapeop.InvalidValueError, 16, "NaN"),
    ("too few points", set_points(POINTS[:2]), shapeop.InvalidValueError, 2, "2"),
    ("force", lambda s: s.add_gravity([0, 0, NAN]), shapeop.InvalidValueError, 16, "force.*NaN"),
    ("force's point", lambda s: s.add_vertex_force([0, 0, 1], 4), shapeop.IndexRangeError, 17, "4"),
    ("force's id", lambda s: s.edit_vertex_force(0, [0, 0, 1], 0), shapeop.UnknownIdError, 18, "0"),
    ("masses", lambda s: s.init_dynamic(masses=0), shapeop.InvalidValueError, 16, "masses.*0"),
    ("timestep", lambda s: s.set_time_step(-1), shapeop.InvalidValueError, 16, "timestep.*-1"),
    ("damping", lambda s: s.set_damping(-1), shapeop.InvalidValueError, 16, "damping.*-1"),
]

SHAPES: list[Any] = [
    ("flat points", set_points([0.0, 1.0, 2.0]), TYPE, r"points: expected an \(n, 3\) array or a list of \[x, y, z\]"),
    ("planar points", set_points([[0, 0]]), VALUE, r"points\[0\]: expected 3 coordinates, found list \[0, 0\]"),
    ("ragged points", set_points([[0, 0, 0], [0, 0, 0, 0]]), VALUE, r"points\[1\]: expected 3 coordinates"),
    ("text points", set_points([["a", "b", "c"]]), TYPE, "points: expected"),
    ("no points", set_points(None), TYPE, "points: expected .* found NoneType"),
    ("iterator", set_points(iter(POINTS)), TYPE, "points: expected .* found list_iterator"),
    ("dict", set_points({0: (0, 0, 0)}), TYPE, "points: expected .* found dict"),
    ("huge number", set_points([[0, 0, 10**400]]), TYPE, "points: expected"),
    ("float index", lambda s: s.add("Plane", [0, 1.0, 2]), TYPE, "indices: expected integers"),
    ("float index of many", lambda s: s.add("Plane", [[0, 1, 2], [0, 1, 2.0]]), TYPE, "indices: expected integers"),
    ("index too large", lambda s: s.add("Plane", [0, 1, 2**31]), VALUE, "indices: expected integers of 32 bits"),
    ("indices are text", lambda s: s.add("Plane", "012"), TYPE, "indices: expected .* found str '012'"),
    ("faces mixed", lambda s: s.add("Plane", [[0, 1, 2], 3]), TYPE, "indices: expected lists of point indices"),
    ("an id for faces", lambda s: s.add("Plane", 3), TYPE, "indices: expected .* found int 3"),
    (
        "weights",
        lambda s: s.add("Plane", [[0, 1, 2]] * 3, weight=[1, 2]),
        VALUE,
        "weight: expected a number, or 3, .* 2",
    ),
    (
        "weight text",
        lambda s: s.add("Plane", [0, 1, 2], weight="1"),
        TYPE,
        "weight: expected a number or a list of numbers, found str '1'",
    ),
    ("weight none", lambda s: s.add("Plane", [0, 1, 2], weight=None), TYPE, "weight: expected a number"),
    (
        "sets",
        lambda s: s.add("Closeness", [[0]] * 3, scalars=[[0, 0, 0]] * 2),
        VALUE,
        "scalars: expected one set, or 3",
    ),
    ("scalar text", lambda s: s.add("Closeness", [0], scalars=["x", 0, 0]), TYPE, "scalars: expected"),
    ("one scalar", lambda s: s.add("Closeness", [0], scalars=3.0), TYPE, "scalars: expected a list"),
    ("weight dict", lambda s: s.add("Plane", [0, 1, 2], weight={1: 2}), TYPE, "weight: expected a number or a list"),
    ("set", lambda s: s.add("Plane", {0, 1, 2}), TYPE, "indices: expected .* found set"),
    ("type", lambda s: s.add(7, [0, 1, 2]), TYPE, "type_name: expected a str, found int 7"),
    ("zero in type", lambda s: s.add("Plane\0", [0, 1, 2]), VALUE, "type_name: expected a name without a zero"),
    ("edit mixed types", lambda s: s.edit(None, [0, 1], [0, 0, 0]), VALUE, "ids: .* found Closeness and Plane"),
    ("float id", lambda s: s.edit(None, 1.0, [0, 0, 0]), TYPE, "ids: expected an integer, found float 1.0"),
    ("negative id", lambda s: s.is_degenerate(-1), VALUE, "id: expected an integer from 0"),
    ("force of 2", lambda s: s.add_gravity([0, 1]), VALUE, r"force: expected 3 numbers, found list \[0, 1\]"),
    ("force of 4", lambda s: s.add_vertex_force([0, 1, 2, 3], 0), VALUE, "force: expected 3 numbers"),
    ("iterations", lambda s: s.solve(-1), VALUE, "iterations: expected an integer from 0"),
    ("float iterations", lambda s: s.solve(1.5), TYPE, "iterations: expected an integer, found float 1.5"),
    ("max_iterations", lambda s: s.solve_until(-1), VALUE, "max_iterations: expected an integer from 0"),
    ("progress", lambda s: s.solve_until(progress=3), TYPE, "progress: expected a function, found int 3"),
    ("acceleration", lambda s: s.set_acceleration("fast"), VALUE, "kind: expected one of none, anderson, quasi-newton"),
    ("backend", lambda s: setattr(s, "backend", "card"), VALUE, "backend: expected one of cpu, gpu, automatic"),
    ("backend none", lambda s: setattr(s, "backend", None), TYPE, "backend: expected an integer"),
    ("adapter", lambda s: s.set_backend_options(3), TYPE, "adapter: expected a str"),
    ("bytes", lambda s: s.set_backend_options(binding_bytes=-1), VALUE, "binding_bytes: expected an integer from 0"),
    ("linear solver", lambda s: s.set_linear_solver(None), TYPE, "linear_solver: expected an integer"),
    ("damping text", lambda s: s.set_damping("1"), TYPE, "damping: expected a number, found str '1'"),
    ("out", lambda s: s.get_points(out=[[0.0] * 3] * 4), TYPE, "out: expected a writable C-contiguous array"),
]


@pytest.mark.parametrize(("call", "kind", "code", "text"), [c[1:] for c in REFUSED], ids=[c[0] for c in REFUSED])
def test_what_the_library_refuses_raises_its_message_and_changes_nothing(
    call: Callable[[Solver], Any], kind: type[shapeop.Error], code: Any, text: str
) -> None:
    with made() as solver:
        with pytest.raises(kind, match=text) as caught:
            call(solver)
        assert type(caught.value) is kind
        assert caught.value.code == code
        assert isinstance(caught.value.code, ErrorCode)
        assert_unchanged(solver)


@pytest.mark.parametrize(("call", "kind", "text"), [c[1:] for c in SHAPES], ids=[c[0] for c in SHAPES])
def test_wrong_shapes_and_types_are_named_before_they_reach_the_library(
    call: Callable[[Solver], Any], kind: type[Exception], text: str
) -> None:
    with made() as solver:
        with pytest.raises(kind, match=text):
            call(solver)
        assert_unchanged(solver)
    assert issubclass(kind, (TypeError, ValueError))


def assert_unchanged(solver: Solver) -> None:
    """As `made` left it: a step moves the corners to where the plane and two of their places draw them."""
    assert_near(solver.points, POINTS, 0)
    assert solver.constraint_count == 3
    solver.solve(5)
    with made() as twin:
        twin.solve(5)
        assert flat(solver.points) == flat(twin.points)


def test_solving_before_initialisation_is_refused() -> None:
    with Solver(POINTS) as solver:
        solver.add("Plane", [0, 1, 2, 3])
        with pytest.raises(shapeop.NotInitialisedError, match="init"):
            solver.solve(1)
        with pytest.raises(shapeop.NotInitialisedError, match="init") as caught:
            solver.solve_until()
        assert caught.value.code is ErrorCode.NOT_INITIALISED


def test_an_unbounded_force_is_refused_by_a_plain_solve() -> None:
    with Solver(POINTS) as solver:
        solver.add("Plane", [0, 1, 2, 3])
        solver.add_gravity([0, 0, -1])
        solver.init()
        with pytest.raises(shapeop.Error, match="force"):
            solver.solve(10)
        assert_near(solver.points, POINTS, 0)


def test_editing_an_empty_solver_names_the_ids() -> None:
    with (
        Solver(POINTS) as solver,
        pytest.raises(shapeop.UnknownIdError, match="ids: expected constraint ids, found list"),
    ):
        solver.edit(None, 0, [0, 0, 0])


@pytest.mark.parametrize(
    "call",
    [
        lambda s: s.points,
        lambda s: s.add("Plane", [0, 1, 2]),
        lambda s: s.init(),
        lambda s: s.solve(1),
        lambda s: s.solve_until(),
        lambda s: s.violations,
        lambda s: s.__enter__(),
    ],
)
def test_a_closed_solver_says_so(call: Callable[[Solver], Any]) -> None:
    solver = made()
    solver.close()
    with pytest.raises(shapeop.ClosedError, match="the solver was closed") as caught:
        call(solver)
    assert caught.value.code is ErrorCode.INVALID_HANDLE
    assert repr(solver) == "<shapeop.Solver, closed>"


def test_a_handle_that_somebody_else_deleted_is_refused() -> None:
    solver = made()
    shapeop._library.lib.shapeop_delete(solver._handle)
    with pytest.raises(shapeop.ClosedError, match="deleted"):
        solver.solve_until()
