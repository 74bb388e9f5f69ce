"""Truths about the experiment of Fig. 12, about the solutions kept of it, and about the programs that find them.

Needs pytest, numpy and scipy; the test of IPOPT also casadi, without which it is skipped.
"""

import json
import pathlib

import numpy
import pytest
import scipy.optimize

import figure12
import newton

KEPT = pathlib.Path(__file__).parents[2] / "tests" / "exploration"
OBJECTIVES = {21: 0.62286509, 61: 0.560629196729}


def kept(n):
    with open(KEPT / f"fig12_{n}.json", encoding="utf-8") as file:
        return json.load(file)


def bent(problem, size):
    """The start, moved by up to about `size`: its quads are not planar."""
    return problem.start + size * numpy.random.default_rng(12).normal(size=problem.start.shape)


def test_the_start_is_planar_and_costs_what_the_lift_does():
    # Only the centre is off its target, by one mean edge: F = w_h/2 · edge².
    for n in (5, 21):
        problem = figure12.problem(n)
        assert numpy.abs(problem.distances(problem.start)).max() < 1e-14 * n
        assert problem.energy(problem.start) == pytest.approx(50.0 * problem.mean_edge**2, rel=1e-14)
        assert problem.handles.sum() == 4 * (n - 1) + 1


@pytest.mark.parametrize("n", [0, 3, 20])
def test_a_grid_without_a_centre_is_refused(n):
    with pytest.raises(ValueError, match=f"n: expected an odd number of at least 5, found {n}"):
        figure12.problem(n)


def test_distances_are_those_of_the_nearest_points_of_two_lines():
    # ‖a + s d1 − b − t d2‖ at the best s and t, by least squares.
    problem = figure12.problem(5)
    points = bent(problem, 0.1)
    for corners, distance in zip(points[problem.quads], problem.distances(points)):
        lines = numpy.stack([corners[2] - corners[0], corners[1] - corners[3]], axis=1)
        gap = corners[1] - corners[0]
        along = numpy.linalg.lstsq(lines, gap, rcond=None)[0]
        assert abs(distance) == pytest.approx(numpy.linalg.norm(gap - lines @ along), abs=1e-14)


def test_derivatives_are_the_limits_of_differences():
    problem = figure12.problem(5)
    points, quads, step = bent(problem, 0.1), numpy.arange(16), 1e-6
    _, gradients, hessians = problem.distance_derivatives(points, quads)
    slope = problem.energy_gradient(points)
    for vertex, axis in [(vertex, axis) for vertex in range(25) for axis in range(3)]:
        change = numpy.zeros_like(points)
        change[vertex, axis] = step
        both = [points + change, points - change]
        energy = [problem.energy(moved) for moved in both]
        assert slope[vertex, axis] == pytest.approx((energy[0] - energy[1]) / (2 * step), abs=1e-6)
        (above, gradient_above, _), (below, gradient_below, _) = (
            problem.distance_derivatives(at, quads) for at in both
        )
        for quad, corner in numpy.argwhere(problem.quads == vertex):
            k = 3 * corner + axis
            assert gradients[quad, k] == pytest.approx((above - below)[quad] / (2 * step), abs=1e-8)
            assert hessians[quad, k] == pytest.approx((gradient_above - gradient_below)[quad] / (2 * step), abs=1e-8)


def test_newtons_end_is_that_of_sequential_quadratic_programming():
    # An independent solver and differences of its own on a small case: SLSQP, from p0.
    problem = figure12.problem(5)
    slack = {"type": "ineq", "fun": lambda x: problem.bound**2 - problem.distances(x.reshape(-1, 3)) ** 2}
    found = scipy.optimize.minimize(
        lambda x: problem.energy(x.reshape(-1, 3)),
        problem.start.ravel(),
        jac=lambda x: problem.energy_gradient(x.reshape(-1, 3)).ravel(),
        constraints=[slack],
        method="SLSQP",
        options={"maxiter": 300, "ftol": 1e-14},
    )
    assert found.success, found.message
    near = found.x.reshape(-1, 3)
    polished, _ = newton.polish(problem, near)
    optimality = problem.optimality(polished)
    assert len(optimality.active) > 0 and optimality.residual() < 1e-11 and problem.violation(polished) < 1e-13
    assert problem.energy(polished) == pytest.approx(found.fun, rel=1e-7)
    assert numpy.abs(polished - near).max() < 1e-4 * problem.mean_edge


def test_newton_puts_a_wrong_active_set_right():
    # Without the first quad at its bound, and with the nearest of those that are not.
    problem, solution = figure12.problem(21), kept(21)
    points = numpy.array(solution["points"])
    nearest = numpy.argsort(numpy.abs(problem.distances(points)))[-len(solution["active"]) - 1]
    wrong = numpy.union1d(solution["active"][1:], [nearest])
    moved = points + bent(problem, 1e-5) - problem.start
    assert numpy.abs(newton.polish(problem, moved, wrong)[0] - points).max() < 1e-11


@pytest.mark.parametrize("n", [21, 61])
def test_kept_solutions_satisfy_the_first_order_conditions(n):
    problem, solution = figure12.problem(n), kept(n)
    points = numpy.array(solution["points"])
    optimality = problem.optimality(points)
    assert optimality.residual() < 1e-10
    assert problem.violation(points) < 1e-13
    assert problem.energy(points) == pytest.approx(OBJECTIVES[n], abs=5e-9 if n == 21 else 1e-12)
    assert problem.energy(points) == pytest.approx(solution["objective"], rel=1e-14)
    assert optimality.active.tolist() == solution["active"] and len(solution["active"]) == 192
    assert optimality.multipliers == pytest.approx(numpy.array(solution["multipliers"]), rel=1e-9)
    # The conditions fail where they ought to: a quarter of a micrometre away on a model of metres.
    assert problem.optimality(bent(problem, 2.5e-7) - problem.start + points).residual() > 1e-9


def test_the_kept_solution_is_a_strict_minimum():
    # Second order: the Lagrangian's Hessian is positive on the directions that the active quads leave free.
    problem, solution = figure12.problem(21), kept(21)
    points, active = numpy.array(solution["points"]), numpy.array(solution["active"])
    hessian = numpy.kron(problem.energy_hessian().toarray(), numpy.eye(3))
    values, _, hessians = problem.distance_derivatives(points, active)
    signed = numpy.sign(values) * numpy.array(solution["multipliers"])
    for places, multiplier, matrix in zip(problem.corner_places(active), signed, hessians):
        hessian[numpy.ix_(places, places)] += multiplier * matrix
    # H + ρ JᵀJ is positive definite for some ρ if and only if H is on the null space of J (Debreu 1952).
    jacobian = problem.bound_jacobian(points, active).toarray()
    assert numpy.linalg.eigvalsh(hessian + 1e3 * jacobian.T @ jacobian).min() > 1e-2


@pytest.mark.parametrize("form", ["plain", "squared", "ratio"])
def test_ipopt_finds_the_kept_solution_in_every_form(form):
    pytest.importorskip("casadi")
    import ipopt

    problem = figure12.problem(21)
    course, points, times = ipopt.solve(problem, form)
    solution = numpy.array(kept(21)["points"])
    assert problem.delta(points, solution) < 1e-8 and problem.violation(points) < 1e-12
    seconds = [at for at, _ in course]
    assert seconds == sorted(seconds) and seconds[0] > times["setup_seconds"]
    assert numpy.array_equal(course[0][1], problem.start) and numpy.allclose(course[-1][1], points, atol=1e-12)
