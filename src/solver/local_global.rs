//! The iteration, static and dynamic.

use std::ops::ControlFlow;
use std::time::Instant;

use glam::DVec3;

use super::Workspace;
use super::system::System;
use super::{Dynamics, Outcome, Progress, ProgressFn, Report, STALL_ITERATIONS, SolveOptions, Solver};
use crate::error::{Error, Result, Status};
use crate::problem::Mode;

impl Solver {
    /// Static: so many iterations. Dynamic: one time step with so many iterations.
    ///
    /// # Errors
    /// The solver was not initialised (`NotInitialised`); a force acts along a free motion (`Unbounded`); coordinates or
    /// weights are so large that the result is not finite (`InvalidValue`). The points are then as before.
    pub fn solve(&mut self, iterations: u32) -> Result<()> {
        self.run(|solver| {
            let mut clock = Clock::default();
            for _ in 0..iterations {
                solver.local_step(false, &mut clock);
                solver.global_step(&mut clock);
            }
            true
        })
    }

    /// Iterates until `options` say to stop; in dynamic mode within one time step. `progress` is called after every
    /// iteration, on the caller's thread, and can stop the solve: what was reached is kept.
    ///
    /// # Errors
    /// As [`Solver::solve`], except that a force along a free motion is an outcome of the report; an option is not
    /// finite or below 0.
    pub fn solve_until(&mut self, options: &SolveOptions, progress: &mut ProgressFn<'_>) -> Result<Report> {
        for (name, value) in [("tolerance", options.tolerance), ("time_budget_seconds", options.time_budget_seconds)] {
            if !(value >= 0.0 && value.is_finite()) {
                let reason = format!("expected a finite number of at least 0, found {value}");
                return Err(Error::new(Status::InvalidValue, reason).at(name));
            }
        }
        let mut found = None;
        let result = self.run(|solver| found.insert(solver.iterate(options, progress)).is_finite());
        let mut report = match result {
            Ok(()) => found.unwrap_or_else(Report::empty),
            Err(error) if error.status() == Status::Unbounded => {
                let energy = self.energy();
                Report {
                    outcome: Outcome::Unbounded,
                    message: error.to_string(),
                    energy_before: energy,
                    energy_after: energy,
                    ..Report::empty()
                }
            }
            Err(error) => return Err(error),
        };
        if !report.is_finite() {
            return Err(overflow());
        }
        if let Some(system) = &self.system {
            report.analysis_seconds = system.analysis_seconds;
            report.factorisation_seconds = system.factorisation_seconds;
        }
        Ok(report)
    }

    /// Brings the system up to date, sets up the external terms, runs `iterations` and, in dynamic mode, ends the time
    /// step. `iterations` returns false where a number overflowed. If anything fails, points and energy are as before.
    fn run(&mut self, iterations: impl FnOnce(&mut Self) -> bool) -> Result<()> {
        self.prepare()?;
        self.workspace.swap_external();
        let result = self.begin().and_then(|()| {
            let is_finite = iterations(self) && self.points.iter().all(|point| point.is_finite());
            if is_finite && self.end_step() { Ok(()) } else { Err(overflow()) }
        });
        if result.is_err() {
            self.points.copy_from_slice(&self.workspace.start);
            self.workspace.swap_external();
        }
        result
    }

    /// Computes the external terms and, in dynamic mode, moves the points to `y`.
    fn begin(&mut self) -> Result<()> {
        let (Some(system), Some(dynamics)) = (&mut self.system, &self.dynamics) else { return Ok(()) };
        let Workspace { forces, external, momentum, kept, start } = &mut self.workspace;
        start.clear();
        start.extend_from_slice(&self.points);
        forces.resize(self.points.len(), DVec3::ZERO);
        let has_forces = self.forces.sum_into(forces);
        let (inertia, step) = (dynamics.inertia(), dynamics.timestep);
        external.clear();
        match dynamics.mode {
            Mode::Static if has_forces => {
                system.check_resistance(forces)?;
                external.extend(forces.iter().map(|force| inertia * step * step * *force));
            }
            Mode::Static => {}
            Mode::Dynamic => {
                momentum.clear();
                let moved = self.points.iter().zip(&dynamics.velocities).zip(&*forces);
                momentum.extend(moved.map(|((x, v), force)| *x + step * *v + step * step * *force));
                external.extend(momentum.iter().map(|y| inertia * *y));
                self.points.copy_from_slice(momentum);
            }
        }
        // The next call exchanges them, and should not allocate then.
        for (kept, current) in kept.iter_mut().zip([external, momentum]) {
            kept.reserve(current.len().saturating_sub(kept.len()));
        }
        Ok(())
    }

    /// In dynamic mode, computes the new velocities. False, with the old velocities, if they are not finite.
    fn end_step(&mut self) -> bool {
        let Some(Dynamics { mode: Mode::Dynamic, damping, timestep, velocities, .. }) = &mut self.dynamics else {
            return true;
        };
        let velocity = |(x, start): (&DVec3, &DVec3)| *damping * (*x - *start) / *timestep;
        let new = || self.points.iter().zip(&self.workspace.start).map(velocity);
        if !new().all(|v| v.is_finite()) {
            return false;
        }
        velocities.clear();
        velocities.extend(new());
        true
    }

    fn iterate(&mut self, options: &SolveOptions, progress: &mut ProgressFn<'_>) -> Report {
        let started = Instant::now();
        let mut clock = Clock::default();
        let diagonal = bounding_box_diagonal(&self.points);
        let energy = self.local_step(true, &mut clock);
        let mut report = Report { energy_before: energy, energy_after: energy, ..Report::empty() };
        let (mut least_energy, mut least_move, mut stalled_for) = (energy, f64::INFINITY, 0);
        for iteration in 1..=options.max_iterations {
            report.largest_move = self.global_step(&mut clock) / diagonal;
            report.energy_after = self.local_step(true, &mut clock);
            report.iterations = iteration;
            stalled_for += 1;
            if report.energy_after < least_energy || report.largest_move < least_move {
                stalled_for = 0;
            }
            least_energy = least_energy.min(report.energy_after);
            least_move = least_move.min(report.largest_move);
            let now =
                Progress { iteration, energy: report.energy_after, largest_move: report.largest_move, solver: self };
            let outcome = if !report.is_finite() {
                // The caller of this function refuses it and restores the points.
                Some(Outcome::Stalled)
            } else if progress(&now) == ControlFlow::Break(()) {
                Some(Outcome::Cancelled)
            } else if report.largest_move < options.tolerance {
                Some(Outcome::Converged)
            } else if options.time_budget_seconds > 0.0
                && started.elapsed().as_secs_f64() >= options.time_budget_seconds
            {
                Some(Outcome::TimeBudget)
            } else if stalled_for >= STALL_ITERATIONS {
                Some(Outcome::Stalled)
            } else {
                None
            };
            if let Some(outcome) = outcome {
                report.outcome = outcome;
                break;
            }
        }
        (report.local_seconds, report.global_seconds) = (clock.local_seconds, clock.global_seconds);
        report
    }

    /// Projects; returns the energy at the current points if it is wanted, else 0.
    fn local_step(&mut self, wants_energy: bool, clock: &mut Clock) -> f64 {
        let started = Instant::now();
        let pool = self.pool_if(System::is_local_step_long);
        let Some(system) = &mut self.system else { return 0.0 };
        let (constraints, points) = (&self.constraints, &self.points);
        let energy = match pool {
            Some(pool) => pool.install(|| system.local_step(constraints, points, wants_energy, true)),
            None => system.local_step(constraints, points, wants_energy, false),
        };
        clock.local_seconds += started.elapsed().as_secs_f64();
        if wants_energy { energy + self.external_energy() } else { 0.0 }
    }

    /// Solves for new points; returns the largest move.
    fn global_step(&mut self, clock: &mut Clock) -> f64 {
        let started = Instant::now();
        let pool = self.pool_if(System::is_global_step_long);
        let Some(system) = &mut self.system else { return 0.0 };
        let (points, external) = (&self.points, &self.workspace.external);
        let new = match pool {
            Some(pool) => pool.install(|| system.global_step(points, external, true)),
            None => system.global_step(points, external, false),
        };
        let mut largest_move = 0.0_f64;
        for (point, new) in self.points.iter_mut().zip(new) {
            largest_move = largest_move.max(point.distance_squared(*new));
            *point = *new;
        }
        clock.global_seconds += started.elapsed().as_secs_f64();
        largest_move.sqrt()
    }

    /// The part of the energy that is not the constraints'.
    pub(super) fn external_energy(&self) -> f64 {
        let Workspace { external, momentum, .. } = &self.workspace;
        match &self.dynamics {
            Some(dynamics) if dynamics.mode == Mode::Dynamic => {
                let squares = self.points.iter().zip(momentum).map(|(x, y)| x.distance_squared(*y));
                0.5 * dynamics.inertia() * squares.sum::<f64>()
            }
            _ => -external.iter().zip(&self.points).map(|(force, x)| force.dot(*x)).sum::<f64>(),
        }
    }
}

fn overflow() -> Error {
    let reason = "coordinates, forces or weights are so large that the result is not finite; nothing was changed";
    Error::new(Status::InvalidValue, reason)
}

impl Report {
    /// False if a number overflowed.
    fn is_finite(&self) -> bool {
        [self.energy_before, self.energy_after, self.largest_move].iter().all(|number| number.is_finite())
    }

    fn empty() -> Self {
        Self {
            iterations: 0,
            energy_before: 0.0,
            energy_after: 0.0,
            largest_move: 0.0,
            outcome: Outcome::IterationLimit,
            message: String::new(),
            analysis_seconds: 0.0,
            factorisation_seconds: 0.0,
            local_seconds: 0.0,
            global_seconds: 0.0,
        }
    }
}

/// Where the time of a call went.
#[derive(Default)]
struct Clock {
    local_seconds: f64,
    global_seconds: f64,
}

/// The diagonal of the bounding box; 1 where all points coincide, so that relative moves are then absolute ones.
fn bounding_box_diagonal(points: &[DVec3]) -> f64 {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let diagonal = low.distance(high);
    if diagonal > 0.0 && diagonal.is_finite() { diagonal } else { 1.0 }
}
