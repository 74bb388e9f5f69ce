//! Exploration: hard constraints met exactly, the objective as small as that allows.

use std::ops::ControlFlow;

use glam::DVec3;
use shapeop::constraints::NewConstraints;
use shapeop::problem::{FairnessRows, Objective};
use shapeop::solver::{Outcome, SolveOptions, Solver};

/// The translation surface of n x n points whose edges are about 1 long, with its quads and edges.
fn translation_surface(n: u32) -> (Vec<DVec3>, Vec<u32>, Vec<[u32; 2]>) {
    let at = |i: u32| 2.0 * f64::from(i) / f64::from(n - 1) - 1.0;
    let half = 0.5 * f64::from(n);
    let point = |i: u32, j: u32| {
        let (u, v) = (at(i), at(j));
        half * DVec3::new(u, v, 0.35 * ((1.2 * u).cos() + (1.5 * v).cos()))
    };
    let points = (0..n).flat_map(|j| (0..n).map(move |i| point(i, j))).collect();
    let index = |i: u32, j: u32| j * n + i;
    let quads = (0..n - 1).flat_map(|j| {
        (0..n - 1).flat_map(move |i| [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)])
    });
    let across = (0..n).flat_map(|j| (0..n - 1).map(move |i| [index(i, j), index(i + 1, j)]));
    let along = (0..n - 1).flat_map(|j| (0..n).map(move |i| [index(i, j), index(i, j + 1)]));
    (points, quads.collect(), across.chain(along).collect())
}

fn fig12(n: u32) -> Solver {
    let (points, quads, edges) = translation_surface(n);
    let mean = edges.iter().map(|[a, b]| points[*a as usize].distance(points[*b as usize])).sum::<f64>() / edges.len() as f64;
    let mut solver = Solver::new();
    solver.set_points(&points).unwrap();
    let counts = vec![4; quads.len() / 4];
    let first = solver
        .add_constraints(NewConstraints {
            type_name: "DiagonalDistance",
            indices: &quads,
            counts: &counts,
            weights: &[1.0],
            scalars: &[0.01 * mean],
            scalar_counts: &[1],
        })
        .unwrap();
    solver.set_hard(&(first..first + counts.len()).collect::<Vec<_>>(), true).unwrap();
    solver.set_objective(&Objective::default(), FairnessRows::laplacian(points.len(), &edges)).unwrap();
    let centre = (n * n) / 2;
    for j in 0..n {
        for i in 0..n {
            if i == 0 || j == 0 || i == n - 1 || j == n - 1 {
                solver.set_handle(j * n + i, points[(j * n + i) as usize]).unwrap();
            }
        }
    }
    solver.set_handle(centre, points[centre as usize] + mean * DVec3::Z).unwrap();
    solver.init().unwrap();
    solver
}

#[test]
fn scratch_fig12() {
    let n: u32 = std::env::var("N").ok().and_then(|v| v.parse().ok()).unwrap_or(21);
    let sweeps: u32 = std::env::var("SW").ok().and_then(|v| v.parse().ok()).unwrap_or(300);
    let mut solver = fig12(n);
    let start = solver.points().to_vec();
    let started = std::time::Instant::now();
    let report = solver.solve_until(&SolveOptions { max_iterations: 2000, ..SolveOptions::default() }, &mut |_| ControlFlow::Continue(())).unwrap();
    println!("reference {:?} {:.12} {:.1} ms {} sweeps", report.outcome, report.energy_after, 1e3*started.elapsed().as_secs_f64(), report.iterations);
    let end = solver.points().to_vec();
    let dist = |p: &[DVec3]| p.iter().zip(&end).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt();
    let whole = dist(&start);
    let mut solver = fig12(n);
    let mut first = vec![(f64::NAN, 0, 0.0); 6];
    let mut lines = Vec::new();
    let started = std::time::Instant::now();
    for k in 1..=sweeps {
        solver.solve(1).unwrap();
        let d = dist(solver.points()) / whole;
        lines.push(d);
        for (slot, bound) in first.iter_mut().zip([0.5, 0.2, 0.1, 0.01, 1e-3, 1e-6]) {
            if d < bound && slot.1 == 0 { *slot = (bound, k, started.elapsed().as_secs_f64()*1e3); }
        }
    }
    println!("{first:?} last {:e}", lines[lines.len()-1]);
    println!("ms per sweep {:.3}", 1e3*started.elapsed().as_secs_f64()/f64::from(sweeps));
    let _ = Outcome::Converged;
}
