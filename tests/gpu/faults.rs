//! What goes wrong on a card ends as a clear error, at the points of the last read-back, from where the processor can go on.

use std::ops::ControlFlow;

use shapeop::error::Status;
use shapeop::solver::{Backend, BackendOptions, Outcome, SolveOptions, Solver};

use crate::has_adapter;
use crate::models::model;

fn solver() -> Solver {
    let model = model("planar_quads", 400).unwrap();
    let mut solver = model.solver().unwrap();
    solver.set_backend(Backend::Gpu).unwrap();
    model.init(&mut solver).unwrap();
    solver
}

#[test]
fn an_adapter_that_is_not_there_is_refused_by_name() {
    if !has_adapter() {
        return;
    }
    let mut solver = Solver::new();
    solver.set_backend_options(&BackendOptions { adapter: "no such card".into(), ..BackendOptions::default() });
    let error = solver.set_backend(Backend::Gpu).unwrap_err();
    assert_eq!(error.status(), Status::BackendUnavailable);
    assert!(error.to_string().contains("no such card"), "{error}");
    assert_eq!(solver.backend(), Backend::Cpu);
    // Nothing is refused where the choice is the library's, and the report says why it was made.
    let model = model("planar_quads", 22_500).unwrap();
    let mut solver = model.solver().unwrap();
    solver.set_backend_options(&BackendOptions { adapter: "no such card".into(), ..BackendOptions::default() });
    solver.set_backend(Backend::Automatic).unwrap();
    model.init(&mut solver).unwrap();
    let options = SolveOptions { max_iterations: 2, ..SolveOptions::default() };
    let report = solver.solve_until(&options, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(report.backend, Backend::Cpu);
    assert!(report.backend_reason.contains("no such card"), "{}", report.backend_reason);
}

#[test]
fn limits_of_bindings_and_of_memory_are_told_before_anything_changes() {
    if !has_adapter() {
        return;
    }
    for (options, words) in [
        (BackendOptions { binding_bytes: 1024, ..BackendOptions::default() }, ["the points", "1024"]),
        (BackendOptions { memory_bytes: 20_000, ..BackendOptions::default() }, ["would make it more", "20000"]),
    ] {
        let mut solver = solver();
        let before = solver.points().to_vec();
        solver.set_backend_options(&options);
        let error = solver.solve(3).unwrap_err();
        assert_eq!(error.status(), Status::BackendUnavailable, "{error}");
        assert!(words.iter().all(|word| error.to_string().contains(word)), "{error}");
        assert_eq!(solver.points(), before);
        solver.set_backend(Backend::Cpu).unwrap();
        solver.solve(3).unwrap();
        assert!(solver.points() != before);
    }
}

#[test]
fn a_card_lost_in_mid_solve_leaves_the_points_of_the_last_read_back() {
    if !has_adapter() {
        return;
    }
    let mut solver = solver();
    // A card of its own, so that the other tests keep theirs.
    solver.set_backend_options(&BackendOptions { binding_bytes: 1 << 26, ..BackendOptions::default() });
    let mut seen = (0, Vec::new());
    let options = SolveOptions { max_iterations: 200, tolerance: 0.0, ..SolveOptions::default() };
    let report = solver
        .solve_until(&options, &mut |now| {
            seen = (now.iteration, now.solver.points().to_vec());
            if now.iteration > 1 {
                now.solver.release_backend();
            }
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(report.outcome, Outcome::BackendFailed);
    assert_eq!((report.iterations, report.read_back_iteration), (seen.0, seen.0));
    assert!(report.message.contains(&format!("after iteration {}", seen.0)), "{}", report.message);
    assert_eq!(solver.points(), seen.1);
    // The processor can go on from there, and so can the card, which is opened anew.
    for backend in [Backend::Gpu, Backend::Cpu] {
        solver.set_backend(backend).unwrap();
        let energy = solver.energy();
        solver.solve(5).unwrap();
        assert!(solver.energy() < energy);
    }
}

#[test]
fn numbers_beyond_single_precision_are_a_failure_and_not_nan() {
    if !has_adapter() {
        return;
    }
    let mut solver = Solver::new();
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.3], [0.0, 1.0, 0.0]].map(glam::DVec3::from);
    solver.set_points(&points).unwrap();
    solver.add_constraint("Plane", &[0, 1, 2, 3], 1e-300).unwrap();
    solver.add_constraint("Closeness", &[0], 1e60).unwrap();
    solver.set_backend(Backend::Gpu).unwrap();
    solver.init().unwrap();
    let _ = solver.solve(3);
    assert!(solver.points().iter().all(|point| point.is_finite()));
}
