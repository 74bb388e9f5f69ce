//! Planarises a grid of a million vertices: `cargo run --release --example million_vertices [VERTICES_PER_SIDE]`.
//!
//! Prints what initialising and ten iterations cost in seconds, and the peak memory of the process.

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use glam::DVec3;
use shapeop::constraints::NewConstraints;
use shapeop::problem::Acceleration;
use shapeop::solver::{SolveOptions, Solver};

fn main() -> Result<(), Box<dyn Error>> {
    let n: u32 = std::env::args().nth(1).map_or(Ok(1000), |text| text.parse())?;
    let started = Instant::now();
    let mut solver = planar_quads(n)?;
    println!("{} vertices, {} constraints", solver.points().len(), solver.constraint_count());
    println!("made in         {:8.2} s", started.elapsed().as_secs_f64());
    let started = Instant::now();
    solver.set_acceleration(Acceleration::None, 0)?;
    solver.init()?;
    println!("initialised in  {:8.2} s", started.elapsed().as_secs_f64());
    let started = Instant::now();
    let options = SolveOptions { max_iterations: 10, tolerance: 0.0, ..SolveOptions::default() };
    let report = solver.solve_until(&options, &mut |progress| {
        println!("  iteration {:2}: energy {:.6e}", progress.iteration, progress.energy);
        ControlFlow::Continue(())
    })?;
    println!("10 iterations in{:8.2} s", started.elapsed().as_secs_f64());
    println!(
        "  analysis {:.2} s, factorisation {:.2} s, local steps {:.2} s, global steps {:.2} s",
        report.analysis_seconds, report.factorisation_seconds, report.local_seconds, report.global_seconds
    );
    match peak_memory_gib() {
        Some(gib) => println!("peak memory     {gib:8.2} GiB"),
        None => println!("peak memory is not measured on this platform"),
    }
    Ok(())
}

/// A wavy grid of `n × n` vertices: a Plane per quad, a Closeness of weight 0.05 per vertex.
fn planar_quads(n: u32) -> Result<Solver, shapeop::error::Error> {
    let wave = |i: u32| {
        let (u, v) = (f64::from(i % n) / f64::from(n), f64::from(i / n) / f64::from(n));
        // A hash instead of a random number: the same model on every run.
        let noise = f64::from(i.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24) - 0.5;
        DVec3::new(u, v, 0.15 * (3.0 * u).sin() * (2.0 * v).cos() + 0.3 * noise / f64::from(n))
    };
    let mut solver = Solver::new();
    solver.set_points(&(0..n * n).map(wave).collect::<Vec<_>>())?;
    let corners = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| row * n + column));
    let quads: Vec<u32> = corners.flat_map(|corner| [corner, corner + 1, corner + n + 1, corner + n]).collect();
    let vertices: Vec<u32> = (0..n * n).collect();
    for (type_name, indices, arity, weight) in [("Plane", &quads, 4, 1.0), ("Closeness", &vertices, 1, 0.05)] {
        let counts = vec![arity; indices.len() / arity];
        solver.add_constraints(NewConstraints {
            type_name,
            indices,
            counts: &counts,
            weights: &[weight],
            scalars: &[],
            scalar_counts: &[],
        })?;
    }
    Ok(solver)
}

/// The peak resident memory of this process, where the system tells.
fn peak_memory_gib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / (1024.0 * 1024.0))
}
