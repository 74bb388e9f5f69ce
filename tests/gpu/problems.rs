//! Whole solves on the card against the same on the processor.

use std::ops::ControlFlow;

use glam::DVec3;
use shapeop::problem::{Acceleration, Force, Objective, Reference};
use shapeop::solver::{Backend, BackendOptions, LinearSolver, Outcome, Report, SolveOptions, Solver};

use crate::has_adapter;
use crate::models::model;

/// The energies of the two after as many iterations, relative to the processor's.
pub const ENERGIES: f64 = 1e-5;

const SIX: [&str; 6] = ["planar_quads", "cloth", "squares", "shell", "tets", "circles"];

fn solver(name: &str, vertex_count: u32, backend: Backend) -> Solver {
    let model = model(name, vertex_count).unwrap();
    let mut solver = model.solver().unwrap();
    solver.set_backend(backend).unwrap();
    model.init(&mut solver).unwrap();
    solver
}

fn options(max_iterations: u32, tolerance: f64) -> SolveOptions {
    SolveOptions { max_iterations, tolerance, ..SolveOptions::default() }
}

fn solved(solver: &mut Solver, options: &SolveOptions) -> Report {
    solver.solve_until(options, &mut |_| ControlFlow::Continue(())).unwrap()
}

#[test]
fn energies_after_fifty_iterations_are_those_of_the_processor() {
    if !has_adapter() {
        return;
    }
    for name in SIX {
        let mut energies = Vec::new();
        for backend in [Backend::Cpu, Backend::Gpu] {
            let mut solver = solver(name, 900, backend);
            solver.solve(50).unwrap();
            energies.push(solver.energy());
        }
        let difference = (energies[1] - energies[0]).abs() / energies[0].abs();
        println!("{name}: energy {:.6e}, the card's {difference:.1e} off", energies[0]);
        assert!(difference <= ENERGIES, "{name}: {energies:?}");
    }
}

#[test]
fn the_processor_finishes_to_the_tolerance() {
    if !has_adapter() {
        return;
    }
    for name in SIX {
        let mut ends = Vec::new();
        for backend in [Backend::Cpu, Backend::Gpu] {
            let mut solver = solver(name, 900, backend);
            let report = solved(&mut solver, &options(3000, 1e-9));
            assert_eq!(report.outcome, Outcome::Converged, "{name}: {report:?}");
            assert!(report.largest_move < 1e-9);
            assert_eq!(report.backend, backend, "{}", report.backend_reason);
            assert_eq!(report.gpu_iterations > 0, backend == Backend::Gpu);
            assert!((report.energy_after - solver.energy()).abs() <= 1e-12 * solver.energy().abs().max(1e-12));
            println!("{name}: {} iterations, {} of the card", report.iterations, report.gpu_iterations);
            ends.push((solver.points().to_vec(), report.energy_after));
        }
        let apart = ends[0].0.iter().zip(&ends[1].0).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        println!("{name}: {apart:.1e} apart, energies {:.9e} and {:.9e}", ends[0].1, ends[1].1);
    }
}

#[test]
fn long_constraints_and_free_components_solve_alike() {
    if !has_adapter() {
        return;
    }
    let rest: Vec<DVec3> = (0..60)
        .map(|i| DVec3::new(f64::from(i), f64::from(i * 7 % 5), f64::from(i * i % 7)) + DVec3::splat(1000.0))
        .collect();
    let cases: [(&str, &[(&str, usize)]); 4] = [
        ("long", &[("Line", 17), ("EdgeStrain", 2), ("Closeness", 1)]),
        ("free", &[("Plane", 4)]),
        ("free, long", &[("Plane", 20)]),
        ("smoothed", &[("Laplacian", 5), ("Plane", 4), ("Closeness", 1)]),
    ];
    for (name, types) in cases {
        let mut ends = Vec::new();
        for backend in [Backend::Cpu, Backend::Gpu] {
            let mut solver = Solver::new();
            solver.set_points(&rest).unwrap();
            for (type_name, k) in types {
                for first in (0..60 - k).step_by(3) {
                    let ids: Vec<u32> = (first as u32..(first + k) as u32).collect();
                    solver.add_constraint(type_name, &ids, 0.5 + (first % 3) as f64).unwrap();
                }
            }
            let bend = |i: usize| 0.2 * DVec3::new(0.0, (i * 7 % 5) as f64, (i * 3 % 4) as f64);
            let moved: Vec<DVec3> = rest.iter().enumerate().map(|(i, point)| *point + bend(i + 3)).collect();
            solver.set_points(&moved).unwrap();
            solver.set_backend(backend).unwrap();
            solver.init().unwrap();
            solver.solve(10).unwrap();
            ends.push((solver.points().to_vec(), solver.energy()));
        }
        let apart = ends[0].0.iter().zip(&ends[1].0).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        println!("{name}: {apart:.1e} apart, energies {:e} and {:e}", ends[0].1, ends[1].1);
        assert!(apart <= 1e-4 * 60.0, "{name}: {apart}");
    }
}

#[test]
fn a_model_that_would_drift_is_left_to_the_processor() {
    if !has_adapter() {
        return;
    }
    let mut solver = Solver::new();
    let points: Vec<DVec3> = (0..20).map(|i| DVec3::new(f64::from(i), f64::from(i % 2), f64::from(i % 3))).collect();
    solver.set_points(&points).unwrap();
    for i in 0..17 {
        solver.add_constraint("Bending", &[i, i + 1, i + 2, i + 3], 1.0).unwrap();
    }
    solver.set_backend(Backend::Gpu).unwrap();
    solver.init().unwrap();
    let error = solver.solve(1).unwrap_err();
    assert_eq!(error.status(), shapeop::error::Status::BackendUnavailable);
    assert!(error.to_string().contains("drift"), "{error}");
}

#[test]
fn types_without_kernels_and_forces_on_faces_are_the_processors_share() {
    if !has_adapter() {
        return;
    }
    let mut ends = Vec::new();
    for backend in [Backend::Cpu, Backend::Gpu] {
        let model = model("planar_quads", 400).unwrap();
        let mut solver = model.solver().unwrap();
        let curve = Reference::Polyline { points: vec![[0.0; 3], [1.0, 1.0, 1.0], [2.0, 1.0, 0.0]], closed: false };
        solver.add_reference(&curve).unwrap();
        for point in [17, 133, 250] {
            solver.add_constraint("OnCurve", &[point], 1.0).unwrap();
        }
        solver
            .add_force(Force::Pressure { faces: [[0, 1, 21, 20], [21, 22, 42, 41]].iter().collect(), pressure: 0.5 })
            .unwrap();
        solver.set_backend(backend).unwrap();
        solver.init().unwrap();
        let report = solved(&mut solver, &options(20, 0.0));
        if backend == Backend::Gpu {
            assert_eq!(report.gpu_iterations, 20);
            assert!(report.backend_reason.contains("OnCurve"), "{}", report.backend_reason);
        }
        ends.push((solver.points().to_vec(), report.energy_after));
    }
    let apart = ends[0].0.iter().zip(&ends[1].0).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart <= 1e-5, "{apart}");
    assert!((ends[0].1 - ends[1].1).abs() <= ENERGIES * ends[0].1.abs());
}

#[test]
fn a_model_far_away_solves_like_one_at_the_origin() {
    if !has_adapter() {
        return;
    }
    let far = DVec3::new(1e6, -2e6, 3e6);
    let mut ends = Vec::new();
    for offset in [DVec3::ZERO, far] {
        let mut model = model("squares", 400).unwrap();
        model.points.iter_mut().for_each(|point| *point += offset);
        let mut solver = model.solver().unwrap();
        solver.set_backend(Backend::Gpu).unwrap();
        model.init(&mut solver).unwrap();
        solver.solve(20).unwrap();
        ends.push(solver.points().iter().map(|point| *point - offset).collect::<Vec<_>>());
    }
    let apart = ends[0].iter().zip(&ends[1]).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart < 1e-5, "{apart}");
}

#[test]
fn edits_between_calls_reach_the_card() {
    if !has_adapter() {
        return;
    }
    let mut ends = Vec::new();
    for backend in [Backend::Cpu, Backend::Gpu] {
        let mut solver = solver("tets", 343, backend);
        solver.solve(5).unwrap();
        let count = solver.constraint_count();
        // Other targets, another weight, a constraint less, other points, one call after the other.
        solver.edit_constraint("TetrahedronStrain", 3, &[0.5, 0.6]).unwrap();
        solver.solve(5).unwrap();
        solver.edit_constraint("Closeness", count - 1, &[2.0, 2.0, 2.0]).unwrap();
        solver.solve(5).unwrap();
        solver.set_weight(7, 3.0).unwrap();
        solver.solve(5).unwrap();
        solver.remove_constraint(8).unwrap();
        solver.solve(5).unwrap();
        let moved: Vec<DVec3> = solver.points().iter().map(|point| 1.1 * *point).collect();
        solver.set_points(&moved).unwrap();
        solver.solve(5).unwrap();
        ends.push((solver.points().to_vec(), solver.energy()));
    }
    let apart = ends[0].0.iter().zip(&ends[1].0).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart < 1e-4, "{apart}");
    assert!((ends[0].1 - ends[1].1).abs() <= ENERGIES * ends[0].1);
}

#[test]
fn the_same_solve_has_the_same_bits() {
    if !has_adapter() {
        return;
    }
    let run = |binding_bytes: u64| {
        let model = model("tets", 1000).unwrap();
        let mut solver = model.solver().unwrap();
        solver.set_backend_options(&BackendOptions { binding_bytes, ..BackendOptions::default() });
        solver.set_backend(Backend::Gpu).unwrap();
        model.init(&mut solver).unwrap();
        solver.solve(12).unwrap();
        solver.points().to_vec()
    };
    let once = run(0);
    assert!(once == run(0));
    // Cut into many small runs the sums have another order.
    let cut = run(64 * 1024);
    let apart = once.iter().zip(&cut).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart < 1e-5, "{apart}");
}

#[test]
fn automatic_leaves_small_models_and_software_adapters_to_the_processor() {
    if !has_adapter() {
        return;
    }
    for vertex_count in [400, 40_000] {
        let mut solver = solver("planar_quads", vertex_count, Backend::Automatic);
        solver.set_linear_solver(LinearSolver::ConjugateGradients);
        let report = solved(&mut solver, &options(4, 0.0));
        assert_eq!((report.backend, report.gpu_iterations), (Backend::Cpu, 0));
        let word = if vertex_count < 20_000 { "fewer than" } else { "program on the processor" };
        let is_software = solver.backend_info().unwrap().kind == shapeop::solver::AdapterKind::Software;
        if is_software {
            assert!(report.backend_reason.contains(word), "{}", report.backend_reason);
        }
    }
}

/// A parabola moved along another has planar quads; three corners are held, and the middle is dragged up by `lift`.
fn dragged(backend: Backend, lift: f64) -> Solver {
    let n = 15;
    let points: Vec<DVec3> = (0..n * n)
        .map(|i| {
            let (x, y) = (f64::from(i % n) / 14.0, f64::from(i / n) / 14.0);
            DVec3::new(x, y, x * (1.0 - x) + 0.7 * y * (1.0 - y))
        })
        .collect();
    let mut solver = Solver::new();
    solver.set_points(&points).unwrap();
    for corner in (0..n * (n - 1)).filter(|i| i % n + 1 < n) {
        let quad = [corner, corner + 1, corner + n + 1, corner + n];
        let id = solver.add_constraint("Plane", &quad, 1.0).unwrap();
        solver.set_hard(&[id], true).unwrap();
    }
    for corner in [0, n - 1, n * (n - 1)] {
        let id = solver.add_constraint("Closeness", &[corner], 1.0).unwrap();
        solver.set_hard(&[id], true).unwrap();
    }
    for i in 0..n - 1 {
        solver.add_constraint("EdgeStrain", &[i, i + 1], 0.1).unwrap();
    }
    solver.set_backend(backend).unwrap();
    solver.set_objective(&Objective::default(), Default::default()).unwrap();
    solver.init().unwrap();
    let middle = n * n / 2;
    solver.set_handle(middle, points[middle as usize] + DVec3::new(0.0, 0.0, lift)).unwrap();
    solver
}

#[test]
fn hard_constraints_are_met_with_sweeps_on_the_card() {
    if !has_adapter() {
        return;
    }
    for lift in [0.01, 0.1] {
        let mut ends = Vec::new();
        for backend in [Backend::Cpu, Backend::Gpu] {
            let mut solver = dragged(backend, lift);
            let report = solved(&mut solver, &options(2000, 1e-9));
            println!("{} sweeps, {} of the card: {:e}", report.iterations, report.gpu_iterations, report.energy_after);
            assert_eq!(report.outcome, Outcome::Converged, "{report:?}");
            assert_eq!((report.backend, report.gpu_iterations > 0), (backend, backend == Backend::Gpu));
            assert!(solver.found().unwrap().largest_violation < 1e-9);
            ends.push((solver.points().to_vec(), report.energy_after));
        }
        let apart = ends[0].0.iter().zip(&ends[1].0).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        println!("{apart:.1e} apart");
        assert!(apart < 1e-6, "{apart}");
    }
}

#[test]
fn hard_constraints_without_a_kernel_are_swept_by_the_processor() {
    if !has_adapter() {
        return;
    }
    let mut solver = dragged(Backend::Gpu, 0.01);
    let line = Reference::Polyline { points: vec![[0.0, 0.0, 0.0], [0.0, 1.0, 0.5]], closed: false };
    solver.add_reference(&line).unwrap();
    let id = solver.add_constraint("OnCurve", &[15], 1.0).unwrap();
    solver.set_hard(&[id], true).unwrap();
    let report = solved(&mut solver, &options(500, 1e-9));
    assert_eq!((report.outcome, report.gpu_iterations), (Outcome::Converged, 0));
    assert!(report.backend_reason.contains("OnCurve"), "{}", report.backend_reason);
}

#[test]
fn both_machines_accelerate() {
    if !has_adapter() {
        return;
    }
    let mut solver = solver("planar_quads", 400, Backend::Gpu);
    solver.set_acceleration(Acceleration::Anderson, 5).unwrap();
    let report = solved(&mut solver, &options(2000, 1e-10));
    assert_eq!(report.outcome, Outcome::Converged);
    assert!(report.gpu_iterations > 0 && report.gpu_iterations < report.iterations);
}
