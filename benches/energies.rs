//! How fast a method of acceleration lowers the energy: what is known after each iteration of one solve.

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use serde_json::{Value, json};
use shapeop::problem::Acceleration;
use shapeop::solver::SolveOptions;

use super::models::Model;

/// Moves this small, relative to the model, end a run: they no longer change the first dozen digits of the energy.
const LEAST_MOVE: f64 = 1e-11;

/// `plain`, `anderson` or `quasi-newton`, with the default memory or with another one, as in `anderson:12`.
fn method(text: &str) -> Result<(Acceleration, u32), Box<dyn Error>> {
    let (name, memory) = text.split_once(':').map_or((text, Ok(0)), |(name, memory)| (name, memory.parse()));
    let acceleration = match name {
        "plain" => Acceleration::None,
        "anderson" => Acceleration::Anderson,
        "quasi-newton" => Acceleration::QuasiNewton,
        _ => return Err(format!("expected plain, anderson or quasi-newton, found {name}").into()),
    };
    Ok((acceleration, memory?))
}

/// Energies, and evaluations and seconds since the start of the solve, after each iteration. In dynamic mode all are in
/// one time step.
pub fn curve(model: &Model, method_text: &str, max_iterations: u32, threads: usize) -> Result<Value, Box<dyn Error>> {
    let (acceleration, memory) = method(method_text)?;
    let mut solver = model.solver()?;
    solver.set_thread_count(threads);
    solver.set_acceleration(acceleration, memory)?;
    let started = Instant::now();
    model.init(&mut solver)?;
    let init_seconds = started.elapsed().as_secs_f64();
    let (mut energies, mut evaluations, mut seconds) = (Vec::new(), Vec::new(), Vec::new());
    let mut default_stop = None;
    let options = SolveOptions { max_iterations, tolerance: LEAST_MOVE, ..SolveOptions::default() };
    let default_tolerance = SolveOptions::default().tolerance;
    let started = Instant::now();
    let report = solver.solve_until(&options, &mut |progress| {
        if default_stop.is_none() && progress.largest_move < default_tolerance {
            default_stop = Some(energies.len());
        }
        energies.push(progress.energy);
        evaluations.push(progress.evaluations);
        seconds.push(started.elapsed().as_secs_f64());
        ControlFlow::Continue(())
    })?;
    Ok(json!({
        "vertices": model.points.len(),
        "threads": threads,
        "init_ms": 1e3 * init_seconds,
        "energies": energies,
        "evaluations": evaluations,
        "seconds": seconds,
        "default_stop": default_stop,
        "outcome": report.outcome.text(),
    }))
}
