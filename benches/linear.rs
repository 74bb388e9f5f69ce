//! A chosen linear solver on a model: what it costs, and how many iterations it takes.

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use serde_json::{Value, json};
use shapeop::problem::Acceleration;
use shapeop::solver::{LinearSolver, SolveOptions};

use super::models::Model;

/// Initialises with the linear solver called `choice` and makes plain iterations.
pub fn time(model: &Model, choice: &str, iterations: u32, threads: usize) -> Result<Value, Box<dyn Error>> {
    let mut solver = model.solver()?;
    solver.set_thread_count(threads);
    solver.set_linear_solver(match choice {
        "automatic" => LinearSolver::Automatic,
        "direct" => LinearSolver::Direct,
        "conjugate-gradients" => LinearSolver::ConjugateGradients,
        other => return Err(format!("no linear solver is called {other}").into()),
    });
    solver.set_acceleration(Acceleration::None, 0)?;
    let started = Instant::now();
    model.init(&mut solver)?;
    let init_seconds = started.elapsed().as_secs_f64();
    let options = |max_iterations| SolveOptions { max_iterations, tolerance: 0.0, time_budget_seconds: 0.0 };
    // Threads start and caches warm in the first iterations.
    solver.solve_until(&options(3), &mut |_| ControlFlow::Continue(()))?;
    let report = solver.solve_until(&options(iterations), &mut |_| ControlFlow::Continue(()))?;
    let count = f64::from(report.iterations);
    Ok(json!({
        "vertices": solver.points().len(),
        "threads": threads,
        "linear_solver": format!("{:?}", report.linear_solver),
        "reason": report.linear_solver_reason,
        "init_ms": 1e3 * init_seconds,
        "local_ms": 1e3 * report.local_seconds / count,
        "global_ms": 1e3 * report.global_seconds / count,
        "linear_iterations_per_solve": f64::from(report.linear_iterations) / count,
        "peak_mib": super::peak_memory_mib(),
    }))
}
