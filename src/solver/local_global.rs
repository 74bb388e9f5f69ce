//! The iteration, static and dynamic.

use std::ops::ControlFlow;
use std::time::Instant;

use glam::DVec3;

use super::Workspace;
use super::acceleration::Accelerator;
use super::backend::Course;
use super::{
    Backend, Dynamics, LinearSolver, Outcome, Progress, ProgressFn, Rejections, Report, STALL_ITERATIONS, SolveOptions,
    Solver,
};
use crate::error::{Error, Result, Status};
use crate::problem::{Acceleration, Mode};

impl Solver {
    /// Static: so many iterations. Dynamic: one time step with so many iterations. They are the plain ones unless
    /// [`Solver::set_acceleration`] asked for others.
    ///
    /// # Errors
    /// The solver was not initialised (`NotInitialised`); a force acts along a free motion (`Unbounded`); coordinates or
    /// weights are so large that the result is not finite (`InvalidValue`); with the backend `Gpu` also what
    /// [`Solver::set_backend`] refuses, or that the card failed (`BackendFailed`). The points are then as before, but for a
    /// card that failed in the middle: those read back last, after the iteration that the error names.
    pub fn solve(&mut self, iterations: u32) -> Result<()> {
        if self.explores() {
            let options = SolveOptions { max_iterations: iterations, tolerance: 0.0, time_budget_seconds: 0.0 };
            let report = self.explore(&options, false, &mut |_| ControlFlow::Continue(()))?;
            return match report.outcome {
                Outcome::BackendFailed => Err(Error::new(Status::BackendFailed, report.message)),
                _ => Ok(()),
            };
        }
        self.run(|solver| {
            let made = solver.iterate_on_backends(iterations)?;
            solver.on_pool(|solver, is_parallel| solver.iterate_blindly(iterations - made, is_parallel));
            Ok(true)
        })
    }

    /// Iterates until `options` say to stop; in dynamic mode within one time step. `progress` is called after every
    /// iteration, on the caller's thread, and can stop the solve: what was reached is kept.
    ///
    /// # Errors
    /// As [`Solver::solve`], except that a force along a free motion is an outcome of the report, and so is a card that
    /// fails once points were read back; an option is not finite or below 0.
    pub fn solve_until(&mut self, options: &SolveOptions, progress: &mut ProgressFn<'_>) -> Result<Report> {
        for (name, value) in [("tolerance", options.tolerance), ("time_budget_seconds", options.time_budget_seconds)] {
            if !(value >= 0.0 && value.is_finite()) {
                let reason = format!("expected a finite number of at least 0, found {value}");
                return Err(Error::new(Status::InvalidValue, reason).at(name));
            }
        }
        if self.explores() {
            return self.explore(options, true, progress);
        }
        let mut found = None;
        let result = self.run(|solver| {
            let report = found.insert(solver.iterate(options, progress));
            if report.outcome == Outcome::BackendFailed && !solver.has_read_back() {
                return Err(Error::new(Status::BackendFailed, report.message.clone()));
            }
            Ok(report.is_finite())
        });
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
            report.linear_solver = system.linear.used();
            report.linear_solver_reason = system.linear.reason();
            let of_processor = u32::try_from(system.linear.iteration_count()).unwrap_or(u32::MAX);
            report.linear_iterations = report.linear_iterations.saturating_add(of_processor);
        }
        (report.ordering_count, report.factorisation_count) = (self.counts.orderings, self.counts.factorisations);
        Ok(report)
    }

    /// Brings the system up to date, sets up the external terms, runs `iterations` and, in dynamic mode, ends the time
    /// step. `iterations` returns false where a number overflowed. If anything fails, points and energy are as before, but for
    /// a card that failed: the points are then those that were read back last.
    fn run(&mut self, iterations: impl FnOnce(&mut Self) -> Result<bool>) -> Result<()> {
        self.prepare()?;
        self.prepare_card()?;
        self.workspace.swap_external();
        let result = self.begin().and_then(|()| {
            let made = iterations(self);
            if made.is_err() && !self.has_read_back() {
                return made.map(drop);
            }
            let is_finite = !matches!(made, Ok(false)) && self.points.iter().all(|point| point.is_finite());
            if is_finite && self.end_step() { made.map(drop) } else { Err(overflow()) }
        });
        let is_of_card = result.as_ref().is_err_and(|error| error.status() == Status::BackendFailed);
        let has_kept_points = is_of_card && self.has_read_back();
        if result.is_err() && !has_kept_points {
            self.points.copy_from_slice(&self.workspace.start);
            self.workspace.swap_external();
        }
        result
    }

    /// Computes the external terms and, in dynamic mode, moves the points to `y`.
    fn begin(&mut self) -> Result<()> {
        let (Some(system), Some(dynamics)) = (&mut self.system, &self.dynamics) else { return Ok(()) };
        system.linear.restart_count();
        let Workspace { forces, external, steady, normals, momentum, kept, start } = &mut self.workspace;
        start.clear();
        start.extend_from_slice(&self.points);
        forces.resize(self.points.len(), DVec3::ZERO);
        let follows = self.forces.has_forces_on_faces();
        let has_forces = self.forces.sum_into(forces) || follows;
        let (inertia, step) = (dynamics.inertia(), dynamics.timestep);
        external.clear();
        steady.clear();
        match dynamics.mode {
            Mode::Static if has_forces => {
                if follows {
                    steady.extend(forces.iter().map(|force| inertia * step * step * *force));
                    self.forces.add_forces_on_faces(&self.points, normals, forces);
                }
                system.check_resistance(forces)?;
                external.extend(forces.iter().map(|force| inertia * step * step * *force));
            }
            Mode::Static => {}
            Mode::Dynamic => {
                momentum.clear();
                let moved = self.points.iter().zip(&dynamics.velocities).zip(&*forces);
                momentum.extend(moved.map(|((x, v), force)| *x + step * *v + step * step * *force));
                external.extend(momentum.iter().map(|y| inertia * *y));
                if follows {
                    steady.extend_from_slice(external);
                    forces.fill(DVec3::ZERO);
                    self.forces.add_forces_on_faces(&self.points, normals, forces);
                }
                self.points.copy_from_slice(momentum);
                if follows {
                    self.points.iter_mut().zip(&*forces).for_each(|(x, force)| *x += step * step * *force);
                }
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

    /// So many iterations, whatever comes of them.
    pub(super) fn iterate_blindly(&mut self, iterations: u32, is_parallel: bool) {
        let mut clock = Clock::default();
        if let Some(mut accelerator) = self.begin_acceleration(Acceleration::None) {
            let mut energy = self.local_step(true, is_parallel, &mut clock);
            for _ in 0..iterations {
                energy = self.accelerated_step(&mut accelerator, energy, is_parallel, &mut clock).energy;
            }
            self.accelerator = Some(accelerator);
            return;
        }
        for _ in 0..iterations {
            self.local_step(false, is_parallel, &mut clock);
            self.solve_for_plain_step(is_parallel, &mut clock);
            if let Some(system) = &mut self.system {
                system.swap_solution(&mut self.points);
            }
        }
    }

    fn iterate(&mut self, options: &SolveOptions, progress: &mut ProgressFn<'_>) -> Report {
        let started = Instant::now();
        let mut clock = Clock::default();
        let diagonal = bounding_box_diagonal(&self.points);
        let mut accelerator = self.begin_acceleration(Acceleration::QuasiNewton);
        let energy = self.on_pool(|solver, is_parallel| solver.local_step(true, is_parallel, &mut clock));
        let mut report = Report { energy_before: energy, energy_after: energy, ..Report::empty() };
        let (mut least_energy, mut least_move, mut stalled_for) = (energy, f64::INFINITY, 0);
        while report.iterations < options.max_iterations {
            let mut course = Course { options, started, diagonal, progress: &mut *progress };
            if self.turns_to_card(&report) {
                let ended = self.iterate_on_card(&mut report, &mut course);
                // In double precision; the processor goes on from here, with nothing to remember.
                report.energy_after =
                    self.on_pool(|solver, is_parallel| solver.local_step(true, is_parallel, &mut clock));
                accelerator = self.begin_acceleration(Acceleration::QuasiNewton);
                if let Some(outcome) = ended {
                    report.outcome = outcome;
                    break;
                }
                continue;
            }
            let iterating = Instant::now();
            let iteration = report.iterations + 1;
            let step = self.on_pool(|solver, is_parallel| match &mut accelerator {
                Some(accelerator) => solver.accelerated_step(accelerator, report.energy_after, is_parallel, &mut clock),
                None => solver.plain_step(is_parallel, &mut clock),
            });
            self.cpu_iterated(1, iterating);
            report.largest_move = step.largest_move / diagonal;
            report.energy_after = step.energy;
            report.iterations = iteration;
            report.evaluations = report.evaluations.saturating_add(step.evaluations);
            stalled_for += 1;
            if report.energy_after < least_energy || report.largest_move < least_move {
                stalled_for = 0;
            }
            least_energy = least_energy.min(report.energy_after);
            least_move = least_move.min(report.largest_move);
            let (energy, largest_move) = (report.energy_after, report.largest_move);
            let now = Progress { iteration, evaluations: report.evaluations, energy, largest_move, solver: self };
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
        if let Some(accelerator) = &accelerator {
            report.rejections += accelerator.rejections();
        }
        self.accelerator = accelerator;
        self.tell_backend(&mut report);
        report
    }

    /// What accelerates the solve that begins, with an empty history; `automatic` is what `Automatic` means for it.
    fn begin_acceleration(&mut self, automatic: Acceleration) -> Option<Accelerator> {
        if self.forces.has_forces_on_faces() {
            return None;
        }
        let wanted = self.acceleration_or(automatic);
        let kept = self.accelerator.take().filter(|kept| kept.serves(wanted));
        let mut accelerator = kept.or_else(|| Accelerator::new(wanted))?;
        accelerator.reset(self.acceleration_memory, self.points.len());
        Some(accelerator)
    }

    /// The acceleration that was set; `automatic` is what `Automatic` means.
    pub(super) fn acceleration_or(&self, automatic: Acceleration) -> Acceleration {
        match self.acceleration {
            Acceleration::Automatic => automatic,
            stated => stated,
        }
    }

    /// Runs `work` on the pool, where it is told that it may use more than one thread, if the system is large enough for that;
    /// else here. Entering the pool costs some 10 µs.
    pub(super) fn on_pool<R: Send>(&mut self, work: impl FnOnce(&mut Self, bool) -> R + Send) -> R {
        match self.pool_if_long() {
            Some(pool) => pool.install(|| work(self, true)),
            None => work(self, false),
        }
    }

    /// One iteration: the plain step. The local step at the current points was made.
    fn plain_step(&mut self, is_parallel: bool, clock: &mut Clock) -> Step {
        self.solve_for_plain_step(is_parallel, clock);
        let largest_move = self.take_plain_step(is_parallel);
        Step { energy: self.local_step(true, is_parallel, clock), largest_move, evaluations: 1 }
    }

    /// One iteration from points of `energy`, where the local step was made: to the first point that `accelerator` proposes
    /// and accepts, else the plain step.
    fn accelerated_step(
        &mut self,
        accelerator: &mut Accelerator,
        energy: f64,
        is_parallel: bool,
        clock: &mut Clock,
    ) -> Step {
        self.solve_for_plain_step(is_parallel, clock);
        let started = Instant::now();
        let has_direction = self.system.as_mut().is_some_and(|system| {
            let (plain, image) = system.solution_and_image(&self.points);
            accelerator.propose(&self.points, energy, plain, image, is_parallel && accelerator.is_long())
        });
        clock.global_seconds += started.elapsed().as_secs_f64();
        let mut evaluations = 0;
        while has_direction && accelerator.place_trial(&mut self.points) {
            let found = self.local_step(true, is_parallel, clock);
            evaluations += 1;
            if accelerator.accepts(found) {
                return Step { energy: found, largest_move: accelerator.largest_move(&self.points), evaluations };
            }
        }
        let largest_move = self.take_plain_step(is_parallel);
        Step { energy: self.local_step(true, is_parallel, clock), largest_move, evaluations: evaluations + 1 }
    }

    /// Projects; returns the energy at the current points if it is wanted, else 0.
    fn local_step(&mut self, wants_energy: bool, is_parallel: bool, clock: &mut Clock) -> f64 {
        let started = Instant::now();
        let Some(system) = &mut self.system else { return 0.0 };
        let energy = system.local_step(&self.constraints, &self.points, wants_energy, is_parallel);
        clock.local_seconds += started.elapsed().as_secs_f64();
        if wants_energy { energy + self.external_energy() } else { 0.0 }
    }

    /// Solves for new points, which the system keeps in hand.
    fn solve_for_plain_step(&mut self, is_parallel: bool, clock: &mut Clock) {
        let started = Instant::now();
        self.follow_points();
        let Some(system) = &mut self.system else { return };
        system.global_step(&self.points, &self.workspace.external, is_parallel);
        clock.global_seconds += started.elapsed().as_secs_f64();
    }

    /// Brings the forces on faces in `external` to the current points.
    pub(super) fn follow_points(&mut self) {
        let factor = self.force_factor();
        let Workspace { forces, external, steady, normals, .. } = &mut self.workspace;
        if steady.is_empty() {
            return;
        }
        forces.fill(DVec3::ZERO);
        self.forces.add_forces_on_faces(&self.points, normals, forces);
        for ((external, steady), force) in external.iter_mut().zip(&*steady).zip(&*forces) {
            *external = *steady + factor * *force;
        }
    }

    /// Moves to the points in hand; returns the largest move.
    fn take_plain_step(&mut self, is_parallel: bool) -> f64 {
        self.system.as_mut().map_or(0.0, |system| system.take_solution(&mut self.points, is_parallel))
    }

    /// The part of the energy that is not the constraints'.
    pub(super) fn external_energy(&self) -> f64 {
        let Workspace { external, steady, momentum, .. } = &self.workspace;
        let external = if steady.is_empty() { external } else { steady };
        let others = match &self.dynamics {
            Some(dynamics) if dynamics.mode == Mode::Dynamic => {
                let squares = self.points.iter().zip(momentum).map(|(x, y)| x.distance_squared(*y));
                0.5 * dynamics.inertia() * squares.sum::<f64>()
            }
            _ => -external.iter().zip(&self.points).map(|(force, x)| force.dot(*x)).sum::<f64>(),
        };
        others - self.work_of_pressures()
    }
}

fn overflow() -> Error {
    let reason = "coordinates, forces or weights are so large that the result is not finite; nothing was changed";
    Error::new(Status::InvalidValue, reason)
}

impl Report {
    /// False if a number overflowed.
    pub(super) fn is_finite(&self) -> bool {
        [self.energy_before, self.energy_after, self.largest_move].iter().all(|number| number.is_finite())
    }

    pub(super) fn empty() -> Self {
        Self {
            iterations: 0,
            evaluations: 0,
            rejections: Rejections::default(),
            energy_before: 0.0,
            energy_after: 0.0,
            largest_move: 0.0,
            outcome: Outcome::IterationLimit,
            message: String::new(),
            ordering_count: 0,
            factorisation_count: 0,
            analysis_seconds: 0.0,
            factorisation_seconds: 0.0,
            local_seconds: 0.0,
            global_seconds: 0.0,
            linear_solver: LinearSolver::Direct,
            linear_solver_reason: String::new(),
            linear_iterations: 0,
            backend: Backend::Cpu,
            backend_reason: String::new(),
            gpu_iterations: 0,
            gpu_seconds: 0.0,
            transfer_seconds: 0.0,
            read_back_iteration: 0,
        }
    }
}

/// What one iteration did.
struct Step {
    /// The energy at the new points.
    energy: f64,
    /// The largest move of a point, in model units.
    largest_move: f64,
    evaluations: u32,
}

/// Where the time of a call went.
#[derive(Default)]
struct Clock {
    local_seconds: f64,
    global_seconds: f64,
}

/// The diagonal of the bounding box; 1 where all points coincide, so that relative moves are then absolute ones.
pub(super) fn bounding_box_diagonal(points: &[DVec3]) -> f64 {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let diagonal = low.distance(high);
    if diagonal > 0.0 && diagonal.is_finite() { diagonal } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Along the plain step `f` the energy falls with the slope `−fᵀ N f`, whatever makes the system definite: inertia,
    /// held components, proximal steps, unknown means, or points in no constraint.
    #[test]
    fn the_image_of_the_plain_step_is_minus_the_gradient() {
        let bend = |i: u32| 0.2 * DVec3::new(0.0, f64::from(i * 7 % 5), f64::from(i * 3 % 4));
        let rest: Vec<DVec3> =
            (0..24).map(|i| DVec3::new(f64::from(i), f64::from(2 * (i % 2)), 0.0) + bend(i)).collect();
        let cases: [(&str, &[(&str, u32)]); 4] = [
            ("held", &[("Plane", 4), ("Closeness", 1)]),
            ("free", &[("Plane", 4)]),
            ("weak", &[("Bending", 4)]),
            ("long", &[("Line", 17), ("EdgeStrain", 2), ("Closeness", 1)]),
        ];
        for ((name, types), is_dynamic) in cases.into_iter().flat_map(|case| [(case, false), (case, true)]) {
            let mut solver = Solver::new();
            solver.set_points(&rest).unwrap();
            for (type_name, k) in types {
                for i in 0..=20 - k {
                    let ids: Vec<u32> = (i..i + k).collect();
                    solver.add_constraint(type_name, &ids, 0.5 + f64::from(i % 3)).unwrap();
                }
            }
            let moved: Vec<DVec3> = rest.iter().zip(0..).map(|(point, i)| *point + bend(i + 3)).collect();
            solver.set_points(&moved).unwrap();
            match is_dynamic {
                true => solver.init_dynamic(1.0, 1.0, 0.7).unwrap(),
                false => solver.init().unwrap(),
            }
            solver.solve(0).unwrap();
            let mut clock = Clock::default();
            solver.local_step(true, false, &mut clock);
            solver.solve_for_plain_step(false, &mut clock);
            let start = solver.points.clone();
            let (plain, image) = solver.system.as_mut().unwrap().solution_and_image(&start);
            let step: Vec<DVec3> = plain.iter().zip(&start).map(|(plain, x)| *plain - *x).collect();
            let slope = -step.iter().zip(image).map(|(step, image)| step.dot(*image)).sum::<f64>();
            let mut energy_at = |h: f64| {
                for ((point, x), step) in solver.points.iter_mut().zip(&start).zip(&step) {
                    *point = *x + h * *step;
                }
                solver.energy()
            };
            let h = 1e-5;
            let found = (energy_at(h) - energy_at(-h)) / (2.0 * h);
            assert!(
                (found - slope).abs() < 1e-6 * slope.abs(),
                "{name}, dynamic: {is_dynamic}: {found} is not {slope}"
            );
        }
    }
}
