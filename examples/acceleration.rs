//! Evaluations and seconds to given relative errors of the energy, plain and accelerated, as tables for
//! docs/acceleration.md: `cargo run --release --example acceleration [VERTICES [THREADS [MODEL…]]]`.
//!
//! The relative error is `(E − E*)/E*`, `E*` being the lowest energy seen in any run of the model. Evaluations count
//! rejected ones, from the start of the solve. The last column is the relative error that is left where the largest move
//! falls below the default tolerance, after so many evaluations. A run ends where its iterations are used up: an accelerated one after
//! `ACCELERATED_ITERATIONS`, a plain one after `PLAIN_ITERATIONS`. Seconds are those of the iterations, initialisation
//! excluded, on one thread unless THREADS says otherwise.

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use shapeop::problem::Acceleration;
use shapeop::solver::{SolveOptions, Solver};

#[allow(dead_code, reason = "shared with the benchmarks")]
#[path = "../benches/models.rs"]
mod models;

const NAMES: [&str; 6] = ["planar_quads", "cloth", "squares", "shell", "tets", "quad_circles"];
const ERRORS: [f64; 3] = [1e-3, 1e-6, 1e-9];
const PLAIN_ITERATIONS: u32 = 2000;
const ACCELERATED_ITERATIONS: u32 = 2000;

/// What was known after each iteration: the energy, and all evaluations and seconds so far.
#[derive(Default)]
struct Run {
    label: String,
    energies: Vec<f64>,
    evaluations: Vec<u32>,
    seconds: Vec<f64>,
    moves: Vec<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let vertex_count: u32 = arguments.first().map_or(Ok(10_000), |text| text.parse())?;
    let thread_count: usize = arguments.get(1).map_or(Ok(1), |text| text.parse())?;
    let named: Vec<&str> = arguments.iter().skip(2).map(String::as_str).collect();
    let methods = [
        ("plain", Acceleration::None, 0),
        ("Anderson 5", Acceleration::Anderson, 5),
        ("Anderson 8", Acceleration::Anderson, 8),
        ("Anderson 12", Acceleration::Anderson, 12),
        ("Anderson 20", Acceleration::Anderson, 20),
        ("quasi-Newton 5", Acceleration::QuasiNewton, 5),
        ("quasi-Newton 8", Acceleration::QuasiNewton, 8),
        ("quasi-Newton 12", Acceleration::QuasiNewton, 12),
        ("quasi-Newton 20", Acceleration::QuasiNewton, 20),
    ];
    for name in if named.is_empty() { &NAMES[..] } else { &named } {
        let model = models::model(name, vertex_count).ok_or_else(|| format!("there is no model {name}"))?;
        let mut runs = Vec::new();
        for (label, acceleration, memory) in methods {
            let mut solver = model.solver()?;
            solver.set_thread_count(thread_count);
            solver.set_acceleration(acceleration, memory)?;
            model.init(&mut solver)?;
            runs.push(run(label, &mut solver, acceleration == Acceleration::None)?);
        }
        print_table(name, model.points.len(), &runs);
    }
    Ok(())
}

fn run(label: &str, solver: &mut Solver, is_plain: bool) -> Result<Run, Box<dyn Error>> {
    let max_iterations = if is_plain { PLAIN_ITERATIONS } else { ACCELERATED_ITERATIONS };
    let mut run = Run { label: label.to_owned(), ..Run::default() };
    let options = SolveOptions { max_iterations, tolerance: 0.0, ..SolveOptions::default() };
    let started = Instant::now();
    let report = solver.solve_until(&options, &mut |progress| {
        run.energies.push(progress.energy);
        run.evaluations.push(progress.evaluations);
        run.moves.push(progress.largest_move);
        run.seconds.push(started.elapsed().as_secs_f64());
        ControlFlow::Continue(())
    })?;
    let rejections = report.rejections;
    let per_evaluation = 1e3 * started.elapsed().as_secs_f64() / f64::from(report.evaluations);
    eprintln!("{label:16} {per_evaluation:7.2} ms per evaluation, {} evaluations, {rejections:?}", report.evaluations);
    Ok(run)
}

fn print_table(name: &str, vertex_count: usize, runs: &[Run]) {
    let lowest = runs.iter().flat_map(|run| &run.energies).copied().fold(f64::INFINITY, f64::min);
    let plains_last = runs[0].energies.last().copied().unwrap_or(f64::INFINITY);
    println!(
        "\n{name}, {vertex_count} vertices, E* = {lowest:.9e}; plain's last = iteration {}\n",
        runs[0].energies.len()
    );
    println!("| method | to 1e-3 | to 1e-6 | to 1e-9 | to plain's last | left where moves end |");
    println!("|---|---|---|---|---|---|");
    for run in runs {
        let reached = |energy: f64| match run.energies.iter().position(|found| *found <= energy) {
            Some(i) => format!("{} / {:.3} s", run.evaluations[i], run.seconds[i]),
            None => "–".to_owned(),
        };
        let cells = ERRORS.map(|error| reached(lowest + error * lowest.abs())).join(" | ");
        // Where the default tolerance would have stopped.
        let tolerance = SolveOptions::default().tolerance;
        let left = match run.moves.iter().position(|largest_move| *largest_move < tolerance) {
            Some(i) => format!("{:.0e} after {}", (run.energies[i] - lowest) / lowest.abs(), run.evaluations[i]),
            None => "–".to_owned(),
        };
        println!("| {} | {cells} | {} | {left} |", run.label, reached(plains_last));
    }
}
