"""What a solver answers, against numbers that can be derived by hand."""

from __future__ import annotations

import doctest
import gc
import math
from typing import Any

import pytest

import shapeop
from near import assert_near
from samples import SQUARE, saddle, sheet
from shapeop import Acceleration, Backend, ErrorCode, LinearSolver, Outcome, Solver, _abi, _library, backend
from shapeop import solver as solver_module


def test_plane_and_closeness_balance_at_a_fifth_of_the_height() -> None:
    # Along z each corner minimises w (z - h)^2 + z^2 with w = 1/4, so z = h / 5.
    with Solver(saddle(0.1)) as solver:
        assert solver.add("Plane", [0, 1, 2, 3]) == 0
        assert solver.add("Closeness", [[0], [1], [2], [3]], weight=0.25) == range(1, 5)
        solver.init()
        solver.solve(1)
        assert_near(solver.points, saddle(0.02))
        # Plane: the largest distance from the plane; Closeness: the distance from the target.
        assert_near(solver.violations, [0.02, 0.08, 0.08, 0.08, 0.08])
        # Half of 4 (0.02^2 + 0.08^2 / 4).
        assert_near(solver.energy, 2 * (0.02**2 + 0.08**2 / 4))


def test_two_targets_average_by_weight_and_follow_edits_and_removals() -> None:
    with Solver([[0, 0, 0]]) as solver:
        ids = solver.add("Closeness", [[0], [0]], weight=[1.0, 3.0], scalars=[[0, 0, 0], [4, 0, 8]])
        solver.init()
        solver.solve(1)
        assert_near(solver.points, [[3, 0, 6]])
        solver.set_weights(ids, 1.0)
        solver.solve(1)
        assert_near(solver.points, [[2, 0, 4]])
        solver.set_weights(ids[0], 3)
        solver.solve(1)
        assert_near(solver.points, [[1, 0, 2]])
        solver.edit("Closeness", ids, [4, 0, 0])
        solver.solve(1)
        assert_near(solver.points, [[4, 0, 0]])
        solver.edit(None, ids, [[0, 4, 0], [0, 8, 0]])
        solver.solve(1)
        assert_near(solver.points, [[0, 5, 0]])
        solver.remove(ids[0])
        solver.solve(1)
        assert_near(solver.points, [[0, 8, 0]])
        assert solver.constraint_count == 2
        assert (solver.is_constraint(0), solver.is_constraint(1)) == (False, True)
        assert_near(solver.violations, [0, 0])


def test_an_edge_is_drawn_to_its_length_about_its_middle() -> None:
    with Solver([[0, 0, 0], [1, 0, 0]]) as solver:
        edge = solver.add("EdgeStrain", [0, 1])
        solver.edit("EdgeStrain", edge, [2, 1, 1])
        solver.init()
        assert solver.solve_until().outcome is Outcome.CONVERGED
        assert_near(solver.points, [[-0.5, 0, 0], [1.5, 0, 0]], 1e-9)


def test_one_scalar_set_stands_for_all_and_defaults_are_the_places_at_creation() -> None:
    with Solver(SQUARE) as solver:
        solver.add("Closeness", [[0], [1]], scalars=[0, 0, 5])
        solver.add("Closeness", [[2], [3]])
        solver.init()
        solver.solve(1)
        assert_near(solver.points, [[0, 0, 5], [0, 0, 5], *SQUARE[2:]])


def test_a_shape_may_be_flat_or_a_list_of_points() -> None:
    shape = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]
    flat_shape = [number for point in shape for number in point]
    forms: list[Any] = [shape, flat_shape]
    for scalars in forms:
        with Solver(SQUARE) as solver:
            solver.add("Rigid", [0, 1, 2, 3], scalars=scalars)
            solver.init()
            solver.solve_until()
            # About its middle, twice as large.
            assert_near(solver.points, [[2 * x - 0.5, 2 * y - 0.5, 0] for x, y, _ in SQUARE], 1e-9)
    with Solver([*SQUARE, *SQUARE]) as solver:
        faces = [[0, 1, 2, 3], [4, 5, 6, 7]]
        solver.add("Rigid", faces, scalars=[shape, SQUARE])
        solver.init()
        solver.solve_until()
        assert_near(solver.points, [*([2 * x - 0.5, 2 * y - 0.5, 0] for x, y, _ in SQUARE), *SQUARE], 1e-9)


def test_faces_may_have_different_lengths() -> None:
    with Solver([*saddle(0.1), [2, 0, 0]]) as solver:
        assert solver.add("Plane", [[0, 1, 2, 3], (1, 4, 2), range(5)]) == range(0, 3)
        none: list[list[int]] = []
        assert solver.add("Plane", none) == range(0)
        assert solver.constraint_count == 3


def test_a_force_moves_a_held_point_by_force_over_weight() -> None:
    with Solver([[0, 0, 0], [5, 0, 0]]) as solver:
        solver.add("Closeness", [[0], [1]], weight=2)
        gravity = solver.add_gravity([0, 0, -4])
        push = solver.add_vertex_force((0, 2, 0), 1)
        assert (gravity, push) == (0, 1)
        solver.init()
        solver.solve(1)
        assert_near(solver.points, [[0, 0, -2], [5, 1, -2]])
        solver.edit_vertex_force(push, [0, 6, 0], 0)
        solver.remove_force(gravity)
        solver.solve(1)
        assert_near(solver.points, [[0, 3, 0], [5, 0, 0]])


def test_a_free_point_falls_by_the_implicit_euler_numbers() -> None:
    # y = x + step v + step^2 g, v = damping (y - x) / step: with step 1/2 and g = 4 the first move is 1, and with
    # damping 1/2 the second is 1/2 + 1.
    with Solver([[0, 0, 0]]) as solver:
        solver.add_gravity([0, 0, -4])
        solver.init_dynamic(masses=1, damping=0.5, timestep=0.5)
        solver.solve(1)
        assert_near(solver.points, [[0, 0, -1]])
        solver.solve(1)
        assert_near(solver.points, [[0, 0, -2.5]])
        solver.set_damping(0)
        solver.set_time_step(1)
        solver.solve(1)
        # The velocity is still 0.5 * 1.5 / 0.5 = 1.5; the step is 1.
        assert_near(solver.points, [[0, 0, -2.5 - 1.5 - 4]])


def test_the_report_says_what_the_callback_was_told() -> None:
    with Solver(saddle(0.3)) as solver:
        solver.add("Plane", [0, 1, 2, 3])
        solver.add("Rigid", [0, 1, 2, 3], scalars=SQUARE)
        solver.add("Closeness", [0], weight=0.5, scalars=[0, 0, 0.2])
        solver.init()
        before = solver.energy
        told: list[shapeop.Progress] = []
        report = solver.solve_until(progress=told.append)
        assert report.outcome is Outcome.CONVERGED
        assert [one.iteration for one in told] == list(range(1, report.iterations + 1))
        assert_near([report.energy_before, report.energy_after], [before, solver.energy])
        assert told[-1].energy == report.energy_after < report.energy_before
        assert told[-1].largest_move == report.largest_move < 1e-6 <= told[-2].largest_move
        assert report.linear_solver is LinearSolver.DIRECT
        assert (report.unconstrained_count, report.message) == (0, "")


def test_stopping_rules_are_obeyed() -> None:
    def solver() -> Solver:
        made = Solver(saddle(0.3))
        made.add("Plane", [0, 1, 2, 3])
        made.add("Rigid", [0, 1, 2, 3], weight=2, scalars=SQUARE)
        made.add("Closeness", [0], weight=0.5, scalars=[0, 0, 0.2])
        made.init()
        return made

    assert solver().solve_until(3, tolerance=0).iterations == 3
    assert solver().solve_until(3, tolerance=0).outcome is Outcome.ITERATION_LIMIT
    assert solver().solve_until(tolerance=0, time_budget_seconds=1e-9).outcome is Outcome.TIME_BUDGET
    for answer in (False, 0):
        answers = [None, answer, None]
        report = solver().solve_until(progress=lambda told, answers=answers: answers[told.iteration - 1])  # type: ignore[misc]
        assert (report.outcome, report.iterations) == (Outcome.CANCELLED, 2)
    assert solver().solve_until(progress=lambda _: True).outcome is Outcome.CONVERGED


def test_an_unbounded_force_is_an_outcome_and_names_the_point() -> None:
    with Solver([[0, 0, 0], [1, 0, 0]]) as solver:
        solver.add("Closeness", [0])
        solver.add_gravity([0, 0, -1])
        solver.init()
        assert solver.unconstrained_count == 1
        report = solver.solve_until()
        assert report.outcome is Outcome.UNBOUNDED
        assert "point 1" in report.message
        assert_near(solver.points, [[0, 0, 0], [1, 0, 0]])


def test_a_solver_can_be_read_and_not_written_from_its_callback() -> None:
    with Solver(saddle(0.1)) as solver:
        solver.add("Plane", [0, 1, 2, 3])
        solver.add("Closeness", [[0], [1], [2], [3]])
        solver.init()
        seen: list[float] = []

        def progress(told: shapeop.Progress) -> None:
            assert math.isclose(solver.energy, told.energy)
            seen.extend([float(solver.points[0][2]), float(solver.violations[0])])
            with pytest.raises(shapeop.BusyError, match="from inside its progress callback"):
                solver.add("Plane", [0, 1, 2])
            with pytest.raises(shapeop.BusyError):
                solver.points = SQUARE
            with pytest.raises(shapeop.BusyError):
                solver.close()

        solver.solve_until(1, progress=progress)
        assert seen == [pytest.approx(0.05), pytest.approx(0.05)]
        assert solver.constraint_count == 5


def test_points_are_replaced_and_may_become_more() -> None:
    with Solver() as solver:
        assert solver.point_count == 0
        assert_near(solver.points, [])
        solver.points = SQUARE
        solver.points = [(9, 8, 7), *SQUARE]
        assert solver.point_count == 5
        assert_near(solver.points, [[9, 8, 7], *SQUARE])


def test_a_flat_edge_is_degenerate() -> None:
    with Solver([[0, 0, 0], [0, 0, 0], [1, 0, 0]]) as solver:
        ids = solver.add("EdgeStrain", [[0, 1], [0, 2]])
        assert list(map(solver.is_degenerate, ids)) == [True, False]


def test_acceleration_linear_solver_and_threads_are_taken_by_name_and_by_member() -> None:
    def solve(kind: object, linear_solver: object, threads: int) -> shapeop.Report:
        with sheet(8) as solver:
            solver.set_acceleration(kind, memory=3)  # type: ignore[arg-type]
            solver.set_linear_solver(linear_solver)  # type: ignore[arg-type]
            solver.set_threads(threads)
            return solver.solve_until()

    plain = solve("none", LinearSolver.CONJUGATE_GRADIENTS, 1)
    assert plain.linear_solver is LinearSolver.CONJUGATE_GRADIENTS
    assert plain.evaluations == plain.iterations
    quick = solve(Acceleration.QUASI_NEWTON, "direct", 2)
    assert quick.linear_solver is LinearSolver.DIRECT
    assert quick.iterations < plain.iterations
    assert solve("quasi-newton", "direct", 1).iterations == quick.iterations


def test_the_backend_is_taken_by_name_and_by_member_and_the_report_says_what_ran() -> None:
    with sheet(8) as solver:
        assert solver.backend is Backend.CPU
        solver.backend = "automatic"
        assert solver.backend is Backend.AUTOMATIC
        solver.backend = Backend.CPU
        report = solver.solve_until()
        assert (report.backend, report.gpu_iterations, report.gpu_seconds) == (Backend.CPU, 0, 0.0)
        assert report.backend_reason == _library.text(_library.lib.shapeop_backendReason(solver._handle))
        solver.set_backend_options("a card", binding_bytes=4096, memory_bytes=10**9)
    shapeop.release_backend()


def test_a_library_without_the_feature_says_so() -> None:
    # That of these tests is built without it.
    with sheet(4) as solver:
        with pytest.raises(shapeop.BackendError) as caught:
            solver.backend_info()
        assert caught.value.code is ErrorCode.BACKEND_UNAVAILABLE
        assert str(caught.value) == 'this library was built without the feature "gpu"'
        with pytest.raises(shapeop.BackendError, match="feature"):
            solver.backend = "gpu"
        assert solver.backend is Backend.CPU


def test_a_description_of_a_card_is_read_as_it_is_told() -> None:
    struct = _abi.shapeop_backend_info(
        kind=_abi.SO_ADAPTER_INTEGRATED,
        group_count=65535,
        buffer_bytes=2.0**40,
        binding_bytes=2.0**31 - 4,
        adapter="Kärtchen".encode(),
        api=b"vulkan",
        driver=b"1.2",
    )
    info = backend.info_of(struct)
    assert info == (shapeop.AdapterKind.INTEGRATED, 65535, 2**40, 2**31 - 4, "Kärtchen", "vulkan", "1.2")


def test_a_solver_is_deleted_when_closed_and_when_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    deleted: list[int] = []

    class Library:
        def __getattr__(self, name: str) -> object:
            return getattr(_library.lib, name)

        def shapeop_delete(self, handle: int) -> None:
            deleted.append(handle)
            _library.lib.shapeop_delete(handle)

    monkeypatch.setattr(solver_module, "lib", Library())
    solver = Solver(SQUARE)
    handle = solver._handle
    solver.close()
    solver.close()
    assert solver.is_closed
    assert deleted == [handle]
    forgotten = Solver(SQUARE)
    handle = forgotten._handle
    forgotten.add("Closeness", [[0], [1], [2], [3]])
    forgotten.init()
    with pytest.raises(KeyError):
        forgotten.solve_until(progress=lambda _: dict[str, int]()["nothing"])
    del forgotten
    gc.collect()
    assert deleted[1:] == [handle]
    assert _library.lib.shapeop_pointCount(handle) == -1


def test_the_examples_in_the_docstrings_hold() -> None:
    found = doctest.testmod(solver_module, extraglobs={"Solver": Solver})
    assert found.attempted == 2
    assert found.failed == 0
