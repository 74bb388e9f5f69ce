//! Solving a problem, static or step by step, with progress, history and frames.

use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::{Result, bail};
use glam::DVec3;
use serde::Serialize;
use shapeop::mesh::Mesh;
use shapeop::problem::{Acceleration, Mode, Problem, Settings};
use shapeop::solver::{Backend, Outcome, Rejections, Report, SolveOptions, Solver};

use crate::args::IterateArgs;
use crate::progress::{Progress, is_interrupted};

/// Frames of a dynamic problem that are kept for its picture, the start and the end included.
const FRAME_COUNT: u32 = 6;

/// What a run found.
pub struct Run {
    /// The solver at the end.
    pub solver: Solver,
    /// Iterations of all steps together; energy before the first and after the last.
    pub report: Report,
    /// Time steps made; 1 for a static problem.
    pub steps: u32,
    pub seconds: f64,
    pub was_interrupted: bool,
    pub history: History,
    pub frames: Vec<Frame>,
}

/// One entry per iteration; those of all steps follow each other.
#[derive(Clone, Default, Serialize)]
pub struct History {
    /// The energy; of an exploration the residual of its sweeps.
    pub energy: Vec<f64>,
    pub largest_move: Vec<f64>,
    /// One entry per time step: the energy at its end, and the largest move over the step relative to the diagonal of the
    /// problem's points.
    pub steps: Vec<(f64, f64)>,
}

pub struct Frame {
    /// Time steps before it.
    pub step: u32,
    pub points: Vec<DVec3>,
}

/// The settings of a problem with what the options override.
pub fn settings(problem: &Problem, args: &IterateArgs) -> Settings {
    let file = problem.settings;
    Settings {
        max_iterations: args.iterations.unwrap_or(file.max_iterations),
        tolerance: args.tolerance.unwrap_or(file.tolerance),
        time_budget_seconds: args.seconds.unwrap_or(file.time_budget_seconds),
        acceleration: args.acceleration.map_or(file.acceleration, Acceleration::from),
        ..file
    }
}

/// True if a problem has anything to explore: hard constraints, handles or an objective.
pub fn explores(problem: &Problem) -> bool {
    let has_hard = problem.constraints.iter().any(|constraint| constraint.hard);
    has_hard || !problem.handles.is_empty() || problem.objective.is_some()
}

/// Solves `problem` with `settings`, on the threads and the backend of `iterate`; `problem.settings` is not looked at.
pub fn run(problem: &Problem, settings: &Settings, iterate: &IterateArgs, is_quiet: bool) -> Result<Run> {
    let started = Instant::now();
    let mut solver = Solver::from_problem(problem)?;
    solver.set_thread_count(iterate.threads);
    solver.set_backend(iterate.backend.into())?;
    solver.set_acceleration(settings.acceleration, settings.acceleration_memory)?;
    let is_dynamic = problem.mode == Mode::Dynamic;
    let step_count = if is_dynamic { settings.steps } else { 1 };
    let progress = Progress::new(if is_dynamic { step_count } else { settings.max_iterations }, is_quiet);
    // What an exploration shows while it runs is how far its sweeps are from agreeing.
    let measure = if explores(problem) { "residual" } else { "energy" };
    let mut history = History::default();
    let mut frames = vec![Frame { step: 0, points: solver.points().to_vec() }];
    let mut total: Option<Report> = None;
    let mut steps = 0;
    let diagonal = Mesh { points: solver.points().to_vec(), faces: Vec::new() }.diagonal();
    let mut last = solver.points().to_vec();
    for step in 1..=step_count {
        for (type_name, id, scalars) in problem.edits_before(step) {
            solver.edit_constraint(type_name, id, scalars)?;
        }
        let left = match settings.time_budget_seconds {
            0.0 => 0.0,
            // Never 0, which would mean no limit.
            budget => (budget - started.elapsed().as_secs_f64()).max(f64::MIN_POSITIVE),
        };
        let options = SolveOptions {
            max_iterations: settings.max_iterations,
            tolerance: settings.tolerance,
            time_budget_seconds: left,
        };
        let report = solver.solve_until(&options, &mut |now| {
            history.energy.push(now.energy);
            history.largest_move.push(now.largest_move);
            progress.show(if is_dynamic { step } else { now.iteration }, measure, now.energy, now.largest_move);
            if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        if report.outcome == Outcome::Unbounded {
            progress.finish();
            bail!("unbounded, nothing was solved: {}", report.message);
        }
        steps = step;
        let moved = last.iter().zip(solver.points()).map(|(last, now)| last.distance(*now)).fold(0.0, f64::max);
        history.steps.push((report.energy_after, if diagonal > 0.0 { moved / diagonal } else { moved }));
        last.copy_from_slice(solver.points());
        let is_over = is_interrupted() || matches!(report.outcome, Outcome::TimeBudget | Outcome::BackendFailed);
        total = Some(match total {
            None => report,
            Some(before) => joined(before, report),
        });
        // Evenly spaced, the last always.
        let is_frame = step == step_count || (step * (FRAME_COUNT - 1)) % step_count < FRAME_COUNT - 1;
        if is_dynamic && (is_frame || is_over) {
            frames.push(Frame { step, points: solver.points().to_vec() });
        }
        if is_over {
            break;
        }
    }
    progress.finish();
    let Some(report) = total else { bail!("settings.steps: expected at least 1 time step, found 0") };
    let seconds = started.elapsed().as_secs_f64();
    Ok(Run { solver, report, steps, seconds, was_interrupted: is_interrupted(), history, frames })
}

/// The report of two time steps that follow each other. That the card made some of the iterations tells more than that it
/// made none of the last.
fn joined(before: Report, after: Report) -> Report {
    let (old, new) = (before.rejections, after.rejections);
    Report {
        iterations: before.iterations.saturating_add(after.iterations),
        evaluations: before.evaluations.saturating_add(after.evaluations),
        rejections: Rejections {
            energy_rose: old.energy_rose.saturating_add(new.energy_rose),
            not_finite: old.not_finite.saturating_add(new.not_finite),
            ill_conditioned: old.ill_conditioned.saturating_add(new.ill_conditioned),
            not_descent: old.not_descent.saturating_add(new.not_descent),
            line_search: old.line_search.saturating_add(new.line_search),
        },
        energy_before: before.energy_before,
        local_seconds: before.local_seconds + after.local_seconds,
        global_seconds: before.global_seconds + after.global_seconds,
        backend: if before.backend == Backend::Gpu { before.backend } else { after.backend },
        gpu_iterations: before.gpu_iterations.saturating_add(after.gpu_iterations),
        gpu_seconds: before.gpu_seconds + after.gpu_seconds,
        transfer_seconds: before.transfer_seconds + after.transfer_seconds,
        ..after
    }
}
