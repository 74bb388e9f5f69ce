//! Conjugate gradients against the factor: the same iterates on every kind of problem, singular ones included.

use std::ops::ControlFlow;

use glam::DVec3;
use shapeop::error::Status;
use shapeop::problem::{Acceleration, Force};
use shapeop::solver::{LinearSolver, Outcome, Report, SolveOptions, Solver};

#[path = "../benches/models.rs"]
#[allow(dead_code, reason = "the benchmark uses the rest")]
mod models;

/// Differences of iterates, relative to the bounding box's diagonal, that ten iterations may gather.
const AGREEMENT: f64 = 1e-9;

fn solve_until(solver: &mut Solver, iterations: u32) -> Report {
    let options = SolveOptions { max_iterations: iterations, tolerance: 0.0, time_budget_seconds: 0.0 };
    solver.solve_until(&options, &mut |_| ControlFlow::Continue(())).unwrap()
}

fn difference(a: &[DVec3], b: &[DVec3]) -> f64 {
    let low = a.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = a.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max) / low.distance(high)
}

fn with(mut solver: Solver, linear_solver: LinearSolver) -> Solver {
    solver.set_linear_solver(linear_solver);
    // Plain iterates can be compared; accelerated ones multiply every difference.
    solver.set_acceleration(Acceleration::None, 0).unwrap();
    solver
}

#[test]
fn iterates_are_those_of_the_factor_on_every_model() {
    for (name, vertex_count) in [
        ("planar_quads", 2500),
        ("squares", 2500),
        ("quad_circles", 1600),
        ("circles", 900),
        ("cloth", 2500),
        ("shell", 1600),
        ("tets", 4096),
    ] {
        let model = models::model(name, vertex_count).unwrap();
        let run = |linear_solver| {
            let mut solver = with(model.solver().unwrap(), linear_solver);
            model.init(&mut solver).unwrap();
            // Two time steps in dynamic mode.
            let first = solve_until(&mut solver, 5);
            let second = solve_until(&mut solver, 5);
            (solver.points().to_vec(), first, second)
        };
        let (direct, report, _) = run(LinearSolver::Automatic);
        assert_eq!((report.linear_solver, report.linear_iterations), (LinearSolver::Direct, 0));
        assert!(report.linear_solver_reason.contains("MB"), "{}", report.linear_solver_reason);
        let (iterative, first, second) = run(LinearSolver::ConjugateGradients);
        assert_eq!(second.linear_solver, LinearSolver::ConjugateGradients);
        let found = difference(&direct, &iterative);
        let per_solve = f64::from(first.linear_iterations + second.linear_iterations) / 10.0;
        println!("{name}: {found:.1e} of the diagonal apart, {per_solve} iterations per solve");
        assert!(second.linear_iterations > 0);
        assert!(found < AGREEMENT, "{name}: {found:.1e} of the diagonal apart");
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let model = models::model("tets", 4096).unwrap();
    let run = |thread_count| {
        let mut solver = with(model.solver().unwrap(), LinearSolver::ConjugateGradients);
        solver.set_thread_count(thread_count);
        model.init(&mut solver).unwrap();
        let report = solve_until(&mut solver, 5);
        (solver.points().to_vec(), report.energy_after.to_bits(), report.linear_iterations)
    };
    let one = run(1);
    for thread_count in [2, 7] {
        assert!(run(thread_count) == one, "{thread_count} threads");
    }
}

/// A free sheet of planar quads beside a lone pair of points and one that nothing holds.
fn free_sheet() -> Solver {
    let n = 30_u32;
    let bump = |i: u32| f64::from(i * 7919 % 101) / 101.0 * 0.2;
    let mut points: Vec<DVec3> = (0..n * n).map(|i| DVec3::new(f64::from(i % n), f64::from(i / n), bump(i))).collect();
    points.extend([DVec3::new(40.0, 0.0, 0.0), DVec3::new(43.0, 0.0, 0.0), DVec3::splat(-7.3)]);
    let mut solver = Solver::new();
    solver.set_points(&points).unwrap();
    for i in (0..n * (n - 1)).filter(|i| i % n + 1 < n) {
        solver.add_constraint("Plane", &[i, i + 1, i + n + 1, i + n], 1.0).unwrap();
    }
    let edge = solver.add_constraint("EdgeStrain", &[n * n, n * n + 1], 1.0).unwrap();
    solver.edit_constraint("EdgeStrain", edge, &[1.0, 1.0, 1.0]).unwrap();
    solver
}

#[test]
fn free_components_and_free_points_move_as_with_a_factor() {
    let run = |linear_solver| {
        let mut solver = with(free_sheet(), linear_solver);
        solver.init().unwrap();
        solver.solve(10).unwrap();
        solver.points().to_vec()
    };
    let (direct, iterative) = (run(LinearSolver::Direct), run(LinearSolver::ConjugateGradients));
    let found = difference(&direct, &iterative);
    assert!(found < AGREEMENT, "{found:.1e} apart");
    assert_eq!(iterative[902], DVec3::splat(-7.3));
    let start = free_sheet();
    let mean = |points: &[DVec3]| points[..900].iter().sum::<DVec3>() / 900.0;
    assert!((mean(&iterative) - mean(start.points())).length() < 1e-12);
}

#[test]
fn rows_that_leave_more_than_translations_free_are_held_by_the_same_proximal_step() {
    // A sheet of hinges alone can turn and stretch; so can one of Laplacians of its inner points.
    let n = 30_u32;
    let run = |linear_solver, type_name: &str| {
        let mut solver = with(free_sheet(), linear_solver);
        (0..solver.constraint_count()).for_each(|id| solver.remove_constraint(id).unwrap());
        for i in (n..n * (n - 1)).filter(|i| i % n > 0 && i % n + 1 < n) {
            let stencil = [i, i - 1, i + 1, i - n, i + n];
            solver
                .add_constraint(type_name, if type_name == "Bending" { &stencil[..4] } else { &stencil }, 1.0)
                .unwrap();
        }
        solver.init().unwrap();
        solver.solve(10).unwrap();
        solver.points().to_vec()
    };
    for type_name in ["Laplacian", "Bending"] {
        let (direct, iterative) =
            (run(LinearSolver::Direct, type_name), run(LinearSolver::ConjugateGradients, type_name));
        let found = difference(&direct, &iterative);
        println!("{type_name}: {found:.1e} apart");
        // A factor loses 1e-10 along the free motions in each of ten iterations.
        assert!(found < 1e-8, "{type_name}: {found:.1e} apart");
    }
}

#[test]
fn forces_along_free_motions_are_refused_and_change_nothing() {
    let mut solver = with(free_sheet(), LinearSolver::ConjugateGradients);
    solver.init().unwrap();
    let before = solver.points().to_vec();
    for (point, word) in [(902, "point 902"), (17, "component of point 0"), (900, "component of point 900")] {
        let id = solver.add_force(Force::Vertex { force: DVec3::Z, point }).unwrap();
        let error = solver.solve(1).unwrap_err();
        assert_eq!(error.status(), Status::Unbounded);
        assert!(error.to_string().contains(word), "{error}");
        assert_eq!(solve_until(&mut solver, 1).outcome, Outcome::Unbounded);
        assert_eq!(solver.points(), before);
        solver.remove_force(id).unwrap();
    }
    // One that turns a Laplacian's neighbours about its centre, and one that it resists.
    let mut stencil = Solver::new();
    stencil.set_points(&[DVec3::Z, DVec3::NEG_X, DVec3::new(1.0, 0.5, 0.0)]).unwrap();
    stencil.add_constraint("Laplacian", &[0, 1, 2], 1.0).unwrap();
    stencil.set_linear_solver(LinearSolver::ConjugateGradients);
    stencil.init().unwrap();
    let push = |solver: &mut Solver, forces: [f64; 3]| {
        for (point, z) in (0..).zip(forces) {
            solver.add_force(Force::Vertex { force: DVec3::Z * z, point }).unwrap();
        }
    };
    push(&mut stencil, [-1.0, 0.5, 0.5]);
    stencil.solve(1).unwrap();
    push(&mut stencil, [0.0, 1.0, -1.0]);
    let error = stencil.solve(1).unwrap_err();
    assert_eq!(error.status(), Status::Unbounded);
    assert!(error.to_string().contains("point 1"), "{error}");
}

#[test]
fn stiff_hinges_held_at_their_corners_take_more_iterations_and_agree_too() {
    // Fourth differences: the worst that multigrid for constants meets. The rows of hinges are about the whole system.
    let cloth = models::model("cloth", 2500).unwrap();
    let run = |linear_solver| {
        let mut solver = with(cloth.solver().unwrap(), linear_solver);
        let edges =
            (0..solver.constraint_count()).filter(|id| solver.constraint(*id).unwrap().info.name == "EdgeStrain");
        edges.collect::<Vec<_>>().into_iter().for_each(|id| solver.set_weight(id, 1e-4).unwrap());
        solver.init().unwrap();
        let report = solve_until(&mut solver, 5);
        (solver.points().to_vec(), report.linear_iterations)
    };
    let ((direct, _), (iterative, count)) = (run(LinearSolver::Direct), run(LinearSolver::ConjugateGradients));
    let found = difference(&direct, &iterative);
    println!("hinges: {found:.1e} of the diagonal apart, {} iterations per solve", f64::from(count) / 5.0);
    // Where constants are not all that is nearly free, the preconditioned residual underestimates the error.
    assert!(found < 1e-8, "{found:.1e} apart");
}

#[test]
fn acceleration_reaches_the_same_energy() {
    let model = models::model("planar_quads", 1600).unwrap();
    for acceleration in [Acceleration::Anderson, Acceleration::QuasiNewton] {
        let [direct, iterative] = [LinearSolver::Direct, LinearSolver::ConjugateGradients].map(|linear_solver| {
            let mut solver = with(model.solver().unwrap(), linear_solver);
            solver.set_acceleration(acceleration, 0).unwrap();
            model.init(&mut solver).unwrap();
            solve_until(&mut solver, 60)
        });
        let relative = (iterative.energy_after / direct.energy_after - 1.0).abs();
        assert!(iterative.linear_iterations > 0 && relative < 1e-6, "{acceleration:?}: energies {relative:e} apart");
    }
}

#[test]
fn the_linear_solver_can_be_changed_between_solves_and_edits_take_effect() {
    let model = models::model("planar_quads", 1600).unwrap();
    let run = |choices: [LinearSolver; 3]| {
        let mut solver = with(model.solver().unwrap(), LinearSolver::Automatic);
        model.init(&mut solver).unwrap();
        for (i, choice) in choices.into_iter().enumerate() {
            solver.set_linear_solver(choice);
            solver.set_weight(i, 3.0).unwrap();
            let report = solve_until(&mut solver, 3);
            assert_eq!(report.linear_solver == LinearSolver::Direct, choice != LinearSolver::ConjugateGradients);
        }
        solver.points().to_vec()
    };
    let direct = run([LinearSolver::Direct; 3]);
    for choices in [
        [LinearSolver::ConjugateGradients, LinearSolver::Automatic, LinearSolver::ConjugateGradients],
        [LinearSolver::ConjugateGradients; 3],
    ] {
        let found = difference(&direct, &run(choices));
        assert!(found < AGREEMENT, "{choices:?}: {found:.1e} apart");
    }
}

#[test]
fn numbers_that_overflow_are_refused_and_leave_no_trace() {
    let model = models::model("planar_quads", 900).unwrap();
    let mut solver = with(model.solver().unwrap(), LinearSolver::ConjugateGradients);
    model.init(&mut solver).unwrap();
    let before = solver.points().to_vec();
    let force = solver.add_force(Force::Vertex { force: DVec3::splat(1e308), point: 3 }).unwrap();
    assert_eq!(solver.solve(3).unwrap_err().status(), Status::InvalidValue);
    assert_eq!(solver.points(), before);
    solver.remove_force(force).unwrap();
    solver.solve(3).unwrap();
    let mut fresh = with(model.solver().unwrap(), LinearSolver::ConjugateGradients);
    model.init(&mut fresh).unwrap();
    fresh.solve(3).unwrap();
    assert_eq!(solver.points(), fresh.points());
    // No system at all.
    let mut empty = with(Solver::new(), LinearSolver::ConjugateGradients);
    empty.init().unwrap();
    empty.solve(2).unwrap();
}
