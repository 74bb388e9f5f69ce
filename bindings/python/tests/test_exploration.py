"""Hard constraints, handles, the objective, forces on faces and references, against numbers derived by hand."""

from __future__ import annotations

import contextlib
import math
from typing import Any, Callable

import pytest

import shapeop
from near import assert_near, flat
from samples import SQUARE, saddle
from shapeop import Fairness, Outcome, Solver, _arrays


def planar(height: float = 0.1) -> Solver:
    """A saddle that is to be planar exactly, with closeness alone: its best-fit plane is z = 0."""
    solver = Solver(saddle(height))
    solver.add("Plane", [0, 1, 2, 3], hard=True)
    solver.set_objective(fairness_weight=0)
    solver.init()
    return solver


def tug() -> Solver:
    """Two points that a hard length holds apart by 1, on the x axis."""
    solver = Solver([[0, 0, 0], [1, 0, 0]])
    solver.add("EdgeLength", [0, 1], scalars=[1, 1], hard=True)
    solver.set_objective(handle_weight=3, closeness_weight=1, fairness_weight=0)
    solver.init()
    return solver


def test_with_closeness_alone_a_hard_plane_is_the_best_fit_plane() -> None:
    with planar() as solver:
        assert solver.is_hard(0)
        assert not solver.is_hard(1)
        report = solver.solve_until()
        assert report.outcome is Outcome.CONVERGED
        assert_near(solver.points, SQUARE, 1e-11)
        found = solver.exploration
        assert found.is_solution
        assert found.largest_violation < 1e-11
        assert found.worst_constraint == 0
        assert found.capped_count == 0
        # Half of 0.1 times 4 · 0.1².
        assert_near(found.closeness_term, 0.002, 1e-12)
        assert_near([found.handle_term, found.fairness_term, found.soft_term], [0, 0, 0], 0)
        assert_near(report.energy_after, 0.002, 1e-12)
        assert solver.conflicts() == []


def test_a_handle_takes_its_edge_along_as_the_weights_say() -> None:
    # Along x both points move by t: 3 (t - 1)² + t² is least at t = 3/4.
    with tug() as solver:
        solver.set_handle(1, [2, 0, 0])
        assert solver.solve_until().outcome is Outcome.CONVERGED
        assert_near(solver.points, [[0.75, 0, 0], [1.75, 0, 0]], 1e-9)
        # Half of 3 · 1/16, and half of 9/16.
        assert_near([solver.exploration.handle_term, solver.exploration.closeness_term], [3 / 32, 9 / 32], 1e-9)
        solver.set_handle(1, [3, 0, 0])
        solver.solve_until()
        assert_near(solver.points, [[1.5, 0, 0], [2.5, 0, 0]], 1e-9)
        solver.set_objective(handle_weight=1, closeness_weight=1, fairness_weight=0)
        solver.solve_until()
        assert_near(solver.points, [[1, 0, 0], [2, 0, 0]], 1e-9)
        solver.release_handle(1)
        solver.solve_until()
        assert_near(solver.points, [[0, 0, 0], [1, 0, 0]], 1e-9)


def test_handles_of_a_block_are_released_at_its_end_whatever_happens_in_it() -> None:
    with tug() as solver:
        with solver.handles({1: [2, 0, 0]}):
            solver.solve_until()
            assert_near(solver.points, [[0.75, 0, 0], [1.75, 0, 0]], 1e-9)
        with pytest.raises(shapeop.InvalidValueError, match="point 1 is no handle"):
            solver.release_handle(1)
        with contextlib.suppress(ZeroDivisionError), solver.handles({0: [0, 0, 0], 1: [2, 0, 0]}):
            solver.release_handle(0)
            raise ZeroDivisionError
        with pytest.raises(shapeop.IndexRangeError, match="7"), solver.handles({1: [2, 0, 0], 7: [0, 0, 0]}):
            pass
        for point in (0, 1):
            with pytest.raises(shapeop.InvalidValueError, match="is no handle"):
                solver.release_handle(point)
        with pytest.raises(shapeop.ArgumentTypeError, match=r"targets: expected a dict .* found list"):
            solver.handles([1]).__enter__()  # type: ignore[arg-type]


def test_hard_and_soft_can_be_exchanged_and_a_soft_plane_is_a_compromise() -> None:
    with planar() as solver:
        solver.set_hard(0, False)
        assert not solver.is_hard(0)
        solver.set_objective(closeness_weight=0.25, fairness_weight=0)
        solver.solve_until(1000, 0)
        # Along z each corner minimises (z - 0)² + 1/4 (z - h)².
        assert_near(solver.points, saddle(0.02), 1e-6)
        solver.set_hard([0], True)
        assert solver.solve_until().outcome is Outcome.CONVERGED
        assert_near(solver.points, SQUARE, 1e-9)


def test_set_hard_is_all_or_none() -> None:
    with Solver(SQUARE) as solver:
        solver.add("EdgeLength", [[0, 1], [1, 2], [2, 3]])
        solver.set_hard([1], True)
        with pytest.raises(shapeop.UnknownIdError, match=r"ids\[2\].*77"):
            solver.set_hard([0, 1, 77], True)
        assert [solver.is_hard(i) for i in range(3)] == [False, True, False]
        solver.set_hard(range(3), True)
        assert [solver.is_hard(i) for i in range(3)] == [True, True, True]
        with pytest.raises(shapeop.UnknownIdError, match=r"ids\[1\].*9"):
            solver.set_hard([0, 9], False)
        assert solver.is_hard(0)


def test_a_contradiction_is_named_and_the_rest_is_met() -> None:
    with Solver(SQUARE) as solver:
        edges = [[0, 1], [1, 2], [2, 3], [3, 0]]
        solver.add("EdgeLength", edges, scalars=[1, 1], weight=2, hard=True)
        planted = solver.add("EdgeLength", [0, 1], scalars=[3, 3], hard=True)
        solver.set_fairness("laplacian", [[0, 1, 2, 3]])
        solver.init()
        report = solver.solve_until()
        assert report.outcome is Outcome.INFEASIBLE
        assert solver.conflicts() == [planted]
        assert not solver.exploration.is_solution
        points = flat(solver.points)
        for a, b in edges:
            assert abs(math.dist(points[3 * a : 3 * a + 3], points[3 * b : 3 * b + 3]) - 1) < 1e-3


def test_sensitivities_are_the_derivatives_of_the_closed_form() -> None:
    # t = h / (h + c) · 1: dt/d ln h = h c / (h + c)² = 3/16, and the opposite for c.
    with tug() as solver:
        solver.set_handle(1, [2, 0, 0])
        solver.solve_until()
        found = solver.sensitivities()
        assert found.classes == ("handles", "closeness", "fairness")
        step = 3 / 16
        assert_near(found.points[0], [[step, 0, 0], [step, 0, 0]], 1e-8)
        assert_near(found.points[1], [[-step, 0, 0], [-step, 0, 0]], 1e-8)
        assert_near(found.points[2], [[0, 0, 0], [0, 0, 0]], 1e-12)
        # The squares are h (1 - t)² and c t²; the weight in front is held.
        assert_near(found.squares[0], [-2 * 3 * 0.25 * step, 2 * 0.75 * step, 0], 1e-8)
        assert_near(found.squares[1], [2 * 3 * 0.25 * step, -2 * 0.75 * step, 0], 1e-8)
        if _arrays.numpy is not None:
            assert (found.points.shape, found.squares.shape) == ((3, 2, 3), (3, 3))
        solver.set_handle(1, [5, 0, 0])
        with pytest.raises(shapeop.NotInitialisedError, match="solve"):
            solver.sensitivities()


ROWS: dict[Fairness, list[list[float]]] = {
    Fairness.LAPLACIAN: [[1, -1, 0], [-0.5, 1, -0.5], [0, -1, 1]],
    Fairness.SECOND_DIFFERENCES: [[1, -2, 1]],
    Fairness.THIRD_DIFFERENCES: [[-1, 3, -3, 1]],
}


@pytest.mark.parametrize("kind", ["laplacian", Fairness.SECOND_DIFFERENCES, "third-differences"])
def test_a_fair_displacement_solves_the_normal_equations(kind: Any) -> None:
    rows = ROWS[Fairness(_arrays.member(Fairness, kind, "kind"))]
    count = len(rows[0])
    last = count - 1
    handle, closeness, fairness, height = 4.0, 0.5, 2.0, 1.0
    with Solver([[i, 0, 0] for i in range(count)]) as solver:
        solver.set_objective(handle_weight=handle, closeness_weight=closeness, fairness_weight=fairness)
        solver.set_fairness(kind, [[0, 1], [1, 2]] if kind == "laplacian" else [range(count)])
        solver.set_handle(last, [last, 0, height])
        solver.init()
        solver.solve_until()
        z = [flat(point)[2] for point in solver.points]
        told = solver.exploration.fairness_term
    # The gradient vanishes: weight (z - target) + fairness Lᵀ L z.
    differences = [sum(a * b for a, b in zip(row, z)) for row in rows]
    for i in range(count):
        own = handle * (z[i] - height) if i == last else closeness * z[i]
        fair = fairness * sum(row[i] * difference for row, difference in zip(rows, differences))
        assert abs(own + fair) < 1e-9
    assert_near(told, 0.5 * fairness * sum(one**2 for one in differences), 1e-9)
    assert told > 1e-5


def test_a_point_slides_along_a_reference_to_where_it_is_nearest() -> None:
    for closed, expected in ((False, [0, 0, 0]), (True, [0, 0.25, 0])):
        with Solver([[-1, 0.25, 0]]) as solver:
            # From the last corner back to the first: the segment x = 0.
            curve = solver.add_reference_polyline(SQUARE, closed=closed)
            assert (curve, solver.reference_count) == (0, 1)
            solver.add("OnCurve", [0], scalars=[curve])
            solver.init()
            solver.solve(1)
            assert_near(solver.points, [expected])
    with Solver([[0.75, 0.25, 3]]) as solver:
        mesh = solver.add_reference_mesh(SQUARE, [[0, 1, 2], [0, 2, 3]])
        solver.add("OnMesh", [0], scalars=[mesh])
        solver.init()
        solver.solve(1)
        assert_near(solver.points, [[0.75, 0.25, 0]])


def test_pressure_and_normal_forces_move_held_points_by_force_over_weight() -> None:
    with Solver(SQUARE) as solver:
        solver.add("Closeness", [[0], [1], [2], [3]], weight=2)
        pressure = solver.add_pressure([[0, 1, 2, 3]], 8)
        solver.init()
        solver.solve(1)
        # A quarter of the pressure on the area 1, over the weight.
        assert_near(solver.points, [[x, y, 1] for x, y, _ in SQUARE])
        solver.edit_force_magnitude(pressure, -4)
        solver.points = SQUARE
        solver.solve(1)
        assert_near(solver.points, [[x, y, -0.5] for x, y, _ in SQUARE])
        solver.remove_force(pressure)
        normal = solver.add_normal_force([[0, 1, 2], [0, 2, 3]], 3)
        solver.points = SQUARE
        solver.solve(1)
        # Once per point, whatever its number of faces.
        assert_near(solver.points, [[x, y, 1.5] for x, y, _ in SQUARE])
        assert normal == 1


def test_arrays_are_taken_as_lists_are() -> None:
    np = pytest.importorskip("numpy")
    answers = []
    for form in (list, np.array):
        with Solver(saddle(0.2)) as solver:
            faces = form([[0, 1, 2, 3]])
            solver.add("Plane", faces, hard=np.bool_(True))
            solver.set_hard(form([0]), True)
            solver.set_fairness("laplacian", form([[0, 1, 2], [0, 2, 3]]))
            solver.set_handle(np.int32(0), form([0, 0, 1]))
            assert solver.add_reference_mesh(form(SQUARE), form([[0, 1, 2], [0, 2, 3]])) == 0
            assert solver.add_pressure(form([[0, 1, 2], [0, 2, 3]]), 0) == 0
            solver.remove_force(0)
            solver.init()
            solver.solve_until()
            answers.append(flat(solver.points))
    assert answers[0] == answers[1]


NAN = float("nan")
TYPE, VALUE = shapeop.ArgumentTypeError, shapeop.ArgumentError
IN, RANGE, UNKNOWN = shapeop.InvalidValueError, shapeop.IndexRangeError, shapeop.UnknownIdError
MISTAKES: list[Any] = [
    ("hard", lambda s: s.add("Plane", [0, 1, 2], hard=1), TYPE, "hard: expected True or False, found int 1"),
    ("hard none", lambda s: s.set_hard(0, None), TYPE, "hard: expected True or False, found NoneType"),
    ("hard degenerate", lambda s: s.add("EdgeStrain", [0, 0], hard=True), IN, "EdgeStrain.*cannot be hard"),
    ("hard id", lambda s: s.set_hard(1.5, True), TYPE, "ids: expected integers"),
    ("handle's point", lambda s: s.set_handle(4, [0, 0, 0]), RANGE, "4 is out of range for 4 points"),
    ("handle's sign", lambda s: s.set_handle(-1, [0, 0, 0]), VALUE, "point: expected an integer from 0"),
    ("target", lambda s: s.set_handle(0, [0, NAN, 0]), IN, "target: expected a finite number, found NaN"),
    ("short target", lambda s: s.set_handle(0, [0, 0]), VALUE, r"target: expected 3 numbers, found list \[0, 0\]"),
    ("release", lambda s: s.release_handle(2), IN, "point 2 is no handle"),
    ("handle weight", lambda s: s.set_objective(handle_weight=0), IN, "handle_weight: .* above 0, found 0"),
    ("closeness", lambda s: s.set_objective(closeness_weight=-1), IN, "closeness_weight: .* above 0, found -1"),
    ("fairness", lambda s: s.set_objective(fairness_weight=NAN), IN, "fairness_weight: .* finite"),
    ("tolerance", lambda s: s.set_objective(tolerance=0.0), IN, "tolerance: expected at least 1e-14"),
    ("text", lambda s: s.set_objective(handle_weight="1"), TYPE, "handle_weight: expected a number, found str"),
    ("kind", lambda s: s.set_fairness("fair", []), VALUE, "kind: expected one of laplacian, second-differences"),
    ("kind's number", lambda s: s.set_fairness(3, []), IN, "kind: expected 0, 1 or 2"),
    ("lists", lambda s: s.set_fairness("laplacian", [[0, 1, 4]]), RANGE, r"indices\[2\]: 4 is out of range"),
    ("one list", lambda s: s.set_fairness("laplacian", [0, 1]), VALUE, "lists: expected a list of lists"),
    ("no exploration", lambda s: s.exploration, shapeop.NotInitialisedError, "no exploration yet"),
    ("no solution", lambda s: s.sensitivities(), shapeop.NotInitialisedError, "solve until it is converged"),
    ("one point", lambda s: s.add_reference_polyline([[0, 0, 0]]), IN, "points: expected at least 2, found 1"),
    ("closed", lambda s: s.add_reference_polyline(SQUARE, closed=1), TYPE, "closed: expected True or False"),
    ("no triangle", lambda s: s.add_reference_mesh(SQUARE, []), IN, "triangles: expected at least 1, found 0"),
    ("quad", lambda s: s.add_reference_mesh(SQUARE, [[0, 1, 2], [0, 1, 2, 3]]), VALUE, r"triangles\[1\]: .* 3 .* 4"),
    ("triangle", lambda s: s.add_reference_mesh(SQUARE, [[0, 1, 4]]), RANGE, r"triangles\[0\]\[2\]: 4"),
    ("curve", lambda s: s.add("OnCurve", [0], scalars=[3]), RANGE, "3 is out of range for 0 references"),
    ("pressure", lambda s: s.add_pressure([[0, 1, 2]], NAN), IN, "finite number, found NaN"),
    ("pressure's face", lambda s: s.add_pressure([[0, 1, 2], [0, 1]], 1), IN, r"faces\[1\]: .* at least 3 .* 2"),
    ("one face", lambda s: s.add_pressure([0, 1, 2], 1), VALUE, "faces: expected a list of lists"),
    ("normal's corner", lambda s: s.add_normal_force([[0, 1, 4]], 1), RANGE, r"faces\[0\]\[2\]: 4"),
    ("magnitude", lambda s: s.edit_force_magnitude(0, 1), UNKNOWN, "0"),
]


@pytest.mark.parametrize(("call", "kind", "message"), [m[1:] for m in MISTAKES], ids=[m[0] for m in MISTAKES])
def test_mistakes_are_named_and_change_nothing(
    call: Callable[[Solver], Any], kind: type[Exception], message: str
) -> None:
    with Solver(saddle(0.1)) as solver:
        solver.add("Plane", [0, 1, 2, 3])
        solver.add("Closeness", [[0], [1], [2], [3]], weight=0.25)
        solver.add_gravity([0, 0, 0])
        solver.init()
        with pytest.raises(kind, match=message) as caught:
            call(solver)
        assert type(caught.value) is kind
        assert (solver.constraint_count, solver.is_hard(0), solver.reference_count) == (5, False, 0)
        # As no call came through, this is no exploration: along z a fifth of the height is left.
        solver.solve(1)
        assert_near(solver.points, saddle(0.02))


def test_hard_constraints_are_refused_in_dynamic_mode() -> None:
    with Solver(SQUARE) as solver:
        plane = solver.add("Plane", [0, 1, 2, 3])
        solver.init_dynamic()
        with pytest.raises(shapeop.InvalidValueError, match="static mode"):
            solver.set_hard(plane, True)


def test_a_closed_solver_refuses_to_explore() -> None:
    solver = planar()
    solver.close()
    calls: list[Callable[[], Any]] = [
        lambda: solver.set_hard(0, True),
        lambda: solver.is_hard(0),
        lambda: solver.set_handle(0, [0, 0, 0]),
        lambda: solver.set_objective(),
        lambda: solver.exploration,
        solver.conflicts,
        solver.sensitivities,
        lambda: solver.add_pressure([[0, 1, 2]], 1),
        lambda: solver.add_reference_polyline(SQUARE),
    ]
    for call in calls:
        with pytest.raises(shapeop.ClosedError, match="the solver was closed"):
            call()
