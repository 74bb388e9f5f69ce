//! Solves whose iterations the graphics card makes: when it does, what is read back, and what the processor goes on with.

use std::ops::ControlFlow;
use std::time::Instant;

use glam::DVec3;

use super::acceleration::Chooser;
use super::backend::Course;
use super::gpu::{Card, Engine, Now, Parts, ReadBack, constant_matrix};
use super::{AdapterKind, Backend, Outcome, Progress, Report, Solver};
use crate::error::{Error, Result, Status};
use crate::problem::{Acceleration, Mode};

/// Points from which on `Automatic` looks whether a card is faster: below, an iteration takes the processor less than the
/// hundreds of runs take the card to begin.
const LEAST_POINTS: usize = 20_000;

/// Iterations that each measures for `Automatic` before the choice is made; the first one of the card finds how many steps of
/// conjugate gradients suffice, and does not count.
const MEASURED: u32 = 2;

/// Read-backs without a lower energy or a smaller move after which single precision has given what it has.
const IDLE_READ_BACKS: u32 = 2;

/// What energies may err by, relative to themselves, and the part of a move that a smaller one is at most.
const ENERGY_NOISE: f64 = 1e-6;
const FALLEN: f64 = 0.7;

/// A move, relative to the bounding-box diagonal, below which single precision tells nothing.
const LEAST_MOVE: f64 = 1e-9;

/// The model on the card, and what is known of its speed. Anew for every linear system.
#[derive(Default)]
pub(super) struct OnCard {
    engine: Option<Box<Engine>>,
    cpu: Measured,
    gpu: Measured,
    /// Why the card is out of the question, and the processor does all.
    refusal: Option<String>,
    /// True once the call at hand has read points back.
    has_read_back: bool,
}

/// Iterations and the seconds that they took.
#[derive(Clone, Copy, Default)]
struct Measured {
    seconds: f64,
    iterations: u32,
}

impl Measured {
    fn per_iteration(self) -> Option<f64> {
        (self.iterations >= MEASURED).then(|| self.seconds / f64::from(self.iterations))
    }
}

impl OnCard {
    /// To be called when targets changed, but not the system.
    pub(super) fn scalars_changed(&mut self) {
        self.engine = None;
    }

    /// True if the card is to make the next iterations.
    pub(super) fn is_next(&self, backend: Backend) -> bool {
        match backend {
            Backend::Cpu => false,
            _ if self.refusal.is_some() => false,
            Backend::Gpu => true,
            Backend::Automatic => match (self.cpu.per_iteration(), self.gpu.per_iteration()) {
                (None, _) => false,
                (Some(_), None) => true,
                (Some(cpu), Some(gpu)) => gpu < cpu,
            },
        }
    }

    /// Why iterations run where they run.
    fn reason(&self, backend: Backend) -> String {
        let measured = || match (self.cpu.per_iteration(), self.gpu.per_iteration()) {
            (Some(cpu), Some(gpu)) => {
                format!("an iteration takes the processor {:.2} ms and the card {:.2} ms", 1e3 * cpu, 1e3 * gpu)
            }
            _ => "too few iterations to tell which is faster".to_owned(),
        };
        let why = match (backend, &self.refusal) {
            (_, Some(refusal)) => refusal.clone(),
            (Backend::Automatic, None) => measured(),
            _ => "as asked for".to_owned(),
        };
        match &self.engine {
            Some(engine) if !engine.host_types.is_empty() => {
                format!("{why}; the processor projects {}", engine.host_types.join(", "))
            }
            _ => why,
        }
    }
}

impl Solver {
    /// Brings the model to the card where it may run there. The system is up to date.
    ///
    /// # Errors
    /// For `Gpu` alone: status `BackendUnavailable` or `BackendFailed`.
    pub(super) fn prepare_card(&mut self) -> Result<()> {
        self.on_card.has_read_back = false;
        if self.backend == Backend::Cpu || self.on_card.engine.is_some() || self.on_card.refusal.is_some() {
            return Ok(());
        }
        if self.backend == Backend::Automatic {
            self.on_card.refusal = self.reason_against_card();
            if self.on_card.refusal.is_some() || !self.on_card.is_next(self.backend) {
                return Ok(());
            }
        }
        match self.new_engine() {
            Ok(engine) => self.on_card.engine = Some(Box::new(engine)),
            Err(error) if self.backend == Backend::Automatic => self.on_card.refusal = Some(error.to_string()),
            Err(error) => return Err(error),
        }
        Ok(())
    }

    /// True if the call at hand has read points back.
    pub(super) fn has_read_back(&self) -> bool {
        self.on_card.has_read_back
    }

    /// Why `Automatic` need not even try.
    fn reason_against_card(&self) -> Option<String> {
        let n = self.points.len();
        if n < LEAST_POINTS {
            return Some(format!("{n} points are fewer than the {LEAST_POINTS} from which on a card can be faster"));
        }
        match Card::shared(&self.backend_options) {
            Err(error) => Some(error.to_string()),
            Ok(card) if card.info().kind == AdapterKind::Software => {
                Some(format!("{} is a program on the processor", card.info().adapter))
            }
            Ok(_) => None,
        }
    }

    fn new_engine(&self) -> Result<Engine> {
        let Some(system) = &self.system else { return Err(super::gpu::internal("there is no system")) };
        let card = Card::shared(&self.backend_options)?;
        if system.is_proximal() {
            let reason = "nothing holds the model against more than translations: in single precision it would drift";
            return Err(Error::new(Status::BackendUnavailable, reason));
        }
        let (matrix, stiffness, free) = system.parts();
        let (n, inertia) = (self.points.len() as u32, self.inertia_in_force());
        let linear = constant_matrix(&self.constraints, stiffness, self.points.len(), &|visit| {
            (0..n).for_each(|i| visit(i, i, inertia));
        })?;
        let parts = Parts {
            constraints: &self.constraints,
            stiffness,
            matrix,
            linear,
            free,
            has_moving_forces: self.forces.has_forces_on_faces(),
            hard: None,
        };
        Card::within(self.backend_options.memory_bytes, || Engine::new(card, &parts, &self.points))
    }

    fn inertia_in_force(&self) -> f64 {
        match &self.dynamics {
            Some(dynamics) if dynamics.mode == Mode::Dynamic => dynamics.inertia(),
            _ => 0.0,
        }
    }

    /// One round on the card, of `most` iterations at most; the points are then those read back.
    fn round_on_card(
        &mut self,
        engine: &mut Engine,
        most: u32,
        is_first: bool,
        chooser: Option<&mut Chooser>,
        near: f64,
    ) -> Result<ReadBack> {
        if engine.has_host() {
            self.follow_points();
        }
        let Some(system) = &self.system else { return Err(super::gpu::internal("there is no system")) };
        let (external, momentum) = (&self.workspace.external, &self.workspace.momentum);
        let inertia = self.inertia_in_force();
        let constants = |x: &[DVec3]| {
            let force = |i: usize| external.get(i).copied().unwrap_or_default();
            let pulls = x.iter().enumerate().map(|(i, x)| force(i) - inertia * *x).collect();
            let energy = if inertia > 0.0 {
                0.5 * inertia * x.iter().zip(momentum).map(|(x, y)| x.distance_squared(*y)).sum::<f64>()
            } else {
                -x.iter().enumerate().map(|(i, x)| force(i).dot(*x)).sum::<f64>()
            };
            (pulls, energy)
        };
        let now = Now { constraints: &self.constraints, stiffness: system.stiffness(), constants: &constants };
        let seconds = engine.gpu_seconds + engine.transfer_seconds;
        if is_first {
            engine.begin(now, &self.points);
        }
        let is_known = engine.is_warm();
        let found = engine.iterate(most, now, chooser, near)?;
        self.points.copy_from_slice(&engine.current);
        self.on_card.has_read_back = true;
        if is_known {
            self.on_card.gpu.iterations += found.iterations;
            self.on_card.gpu.seconds += engine.gpu_seconds + engine.transfer_seconds - seconds;
        }
        Ok(found)
    }

    /// Says that the processor has made so many iterations since `started`.
    pub(super) fn cpu_iterated(&mut self, iterations: u32, started: Instant) {
        self.on_card.cpu.iterations += iterations;
        self.on_card.cpu.seconds += started.elapsed().as_secs_f64();
    }

    /// True if the card is to make the next iterations of a solve with this report.
    pub(super) fn turns_to_card(&self, report: &Report) -> bool {
        // What the card has handed over the processor finishes.
        report.gpu_iterations == 0 && self.on_card.is_next(self.backend)
    }

    /// What a call that wants so many iterations has the card make, and the processor for comparison; returns their number.
    ///
    /// # Errors
    /// For `Gpu` alone: status `BackendFailed`; the points are those of the last read-back.
    pub(super) fn iterate_on_backends(&mut self, iterations: u32) -> Result<u32> {
        let mut made = 0;
        let may_run = self.backend != Backend::Cpu && self.on_card.refusal.is_none();
        while may_run
            && made < iterations
            && self.on_card.cpu.per_iteration().is_none()
            && self.backend == Backend::Automatic
        {
            let started = Instant::now();
            self.on_pool(|solver, is_parallel| solver.iterate_blindly(1, is_parallel));
            self.cpu_iterated(1, started);
            made += 1;
        }
        if self.on_card.is_next(self.backend) {
            made += self.iterate_blindly_on_card(iterations - made)?;
        }
        Ok(made)
    }

    /// So many iterations, all on the card unless `Automatic` finds the processor faster; returns how many were made.
    ///
    /// # Errors
    /// For `Gpu` alone: status `BackendFailed`; the points are those of the last read-back.
    fn iterate_blindly_on_card(&mut self, iterations: u32) -> Result<u32> {
        self.prepare_card()?;
        let Some(mut engine) = self.on_card.engine.take() else { return Ok(0) };
        let mut chooser = self.card_chooser(&mut engine, Acceleration::None)?;
        let mut made = 0;
        while made < iterations && self.on_card.is_next(self.backend) {
            match self.round_on_card(&mut engine, iterations - made, made == 0, chooser.as_mut(), 0.0) {
                Ok(found) => made += found.iterations,
                Err(error) => return self.card_failed(error, made).map(|()| made),
            }
        }
        self.on_card.engine = Some(engine);
        Ok(made)
    }

    /// What `Automatic` goes on from, and what ends a solve that was to run on the card.
    fn card_failed(&mut self, error: Error, iteration: u32) -> Result<()> {
        let after = match iteration {
            0 => error.to_string(),
            _ => format!("{error}; the points are those after iteration {iteration}"),
        };
        if self.backend == Backend::Automatic {
            self.on_card.refusal = Some(after);
            return Ok(());
        }
        Err(Error::new(Status::BackendFailed, after))
    }

    /// Iterations on the card until `course` says to stop, or until the processor is to go on: `None`.
    pub(super) fn iterate_on_card(&mut self, report: &mut Report, course: &mut Course<'_, '_>) -> Option<Outcome> {
        if let Err(error) = self.prepare_card() {
            report.message = error.to_string();
            return Some(Outcome::BackendFailed);
        }
        let mut engine = self.on_card.engine.take()?;
        let mut chooser = match self.card_chooser(&mut engine, Acceleration::QuasiNewton) {
            Ok(chooser) => chooser,
            Err(error) => return self.card_ended(Err(error), report),
        };
        let (gpu_seconds, transfer_seconds) = (engine.gpu_seconds, engine.transfer_seconds);
        let linear_iterations = engine.linear_iterations;
        let mut rounds = Rounds::default();
        let mut outcome = Ok(None);
        let mut is_first = true;
        let near = course.options.tolerance.max(LEAST_MOVE);
        while self.on_card.is_next(self.backend) {
            let left = course.options.max_iterations - report.iterations;
            if left == 0 {
                outcome = Ok(Some(Outcome::IterationLimit));
                break;
            }
            let found = match self.round_on_card(&mut engine, left, is_first, chooser.as_mut(), near * course.diagonal)
            {
                Ok(found) => found,
                Err(error) => {
                    outcome = self.card_failed(error, report.iterations).map(|()| None);
                    break;
                }
            };
            is_first = false;
            report.iterations += found.iterations;
            report.evaluations = report.evaluations.saturating_add(found.evaluations);
            report.gpu_iterations += found.iterations;
            report.read_back_iteration = report.iterations;
            report.largest_move = found.largest_move / course.diagonal;
            report.energy_after = if engine.has_host() { self.energy() } else { found.energy };
            let now = Progress {
                iteration: report.iterations,
                evaluations: report.evaluations,
                energy: report.energy_after,
                largest_move: report.largest_move,
                solver: self,
            };
            if (course.progress)(&now) == ControlFlow::Break(()) {
                outcome = Ok(Some(Outcome::Cancelled));
                break;
            }
            let budget = course.options.time_budget_seconds;
            if budget > 0.0 && course.started.elapsed().as_secs_f64() >= budget {
                outcome = Ok(Some(Outcome::TimeBudget));
                break;
            }
            // The finish is the processor's, if there is anything to finish to.
            if course.options.tolerance > 0.0
                && found.is_turn
                && (report.largest_move < near || found.is_stuck || rounds.are_idle(report))
            {
                break;
            }
        }
        let linear_iterations = engine.linear_iterations - linear_iterations;
        report.linear_iterations = u32::try_from(linear_iterations).unwrap_or(u32::MAX);
        report.gpu_seconds += engine.gpu_seconds - gpu_seconds;
        report.transfer_seconds += engine.transfer_seconds - transfer_seconds;
        report.rejections += chooser.map(|chooser| chooser.rejections).unwrap_or_default();
        if outcome.is_ok() && self.on_card.refusal.is_none() {
            self.on_card.engine = Some(engine);
        }
        self.card_ended(outcome, report)
    }

    /// The outcome of a solve, with what it was that failed.
    fn card_ended(&self, outcome: Result<Option<Outcome>>, report: &mut Report) -> Option<Outcome> {
        outcome.unwrap_or_else(|error| {
            report.message = error.to_string();
            Some(Outcome::BackendFailed)
        })
    }

    /// What accelerates iterations on the card, with nothing to remember; `automatic` is what `Automatic` means.
    fn card_chooser(&self, engine: &mut Engine, automatic: Acceleration) -> Result<Option<Chooser>> {
        // What the processor has a share in costs a read-back for each trial.
        if engine.has_host() {
            return Ok(None);
        }
        let Some(mut chooser) = Chooser::new(self.acceleration_or(automatic)) else { return Ok(None) };
        let capacity = chooser.reset(self.acceleration_memory);
        Card::within(self.backend_options.memory_bytes, || engine.remember(capacity))?;
        Ok(Some(chooser))
    }

    /// Tells `report` what ran.
    pub(super) fn tell_backend(&self, report: &mut Report) {
        report.backend = if report.gpu_iterations > 0 { Backend::Gpu } else { Backend::Cpu };
        report.backend_reason = self.on_card.reason(self.backend);
    }
}

/// What is seen of a solve from one read-back to the next.
struct Rounds {
    least_energy: f64,
    least_move: f64,
    idle: u32,
}

impl Default for Rounds {
    fn default() -> Self {
        Self { least_energy: f64::INFINITY, least_move: f64::INFINITY, idle: 0 }
    }
}

impl Rounds {
    /// True if neither energy nor moves have fallen, by more than single precision may err, for some read-backs.
    fn are_idle(&mut self, report: &Report) -> bool {
        let noise = ENERGY_NOISE * self.least_energy.abs();
        let has_fallen =
            !(report.energy_after >= self.least_energy - noise) || report.largest_move < FALLEN * self.least_move;
        self.idle = if has_fallen { 0 } else { self.idle + 1 };
        self.least_energy = self.least_energy.min(report.energy_after);
        self.least_move = self.least_move.min(report.largest_move);
        self.idle >= IDLE_READ_BACKS
    }
}

#[cfg(test)]
mod tests {
    use super::super::SolveOptions;
    use super::*;

    #[test]
    fn automatic_measures_both_and_takes_the_faster() {
        let measured = |seconds: f64, iterations: u32| Measured { seconds, iterations };
        let next = |cpu, gpu, backend| OnCard { cpu, gpu, ..OnCard::default() }.is_next(backend);
        let nothing = Measured::default();
        // The processor first, then the card, each for two iterations at least.
        assert!(!next(nothing, nothing, Backend::Automatic));
        assert!(!next(measured(1.0, 1), nothing, Backend::Automatic));
        assert!(next(measured(2.0, 2), measured(9.0, 1), Backend::Automatic));
        assert!(next(measured(2.0, 2), measured(1.9, 2), Backend::Automatic));
        assert!(!next(measured(2.0, 2), measured(5.5, 5), Backend::Automatic));
        // What was asked for is not measured, and what is refused is not tried.
        assert!(next(nothing, measured(9.0, 3), Backend::Gpu) && !next(measured(9.0, 3), nothing, Backend::Cpu));
        let refused = OnCard { refusal: Some("no card".to_owned()), ..OnCard::default() };
        assert!(!refused.is_next(Backend::Automatic));
        assert_eq!(refused.reason(Backend::Automatic), "no card");
    }

    #[test]
    fn how_often_points_are_read_back_changes_no_bit() {
        if crate::solver::gpu::tests::card(0).is_none() {
            return;
        }
        let n = 12;
        let point = |k: u32| {
            let (i, j) = (k % n, k / n);
            DVec3::new(f64::from(i), f64::from(j), 0.3 * f64::from(k * 7 % 5))
        };
        let points: Vec<DVec3> = (0..n * n).map(point).collect();
        let solved = |seconds_per_read_back: f64, tolerance: f64| {
            let mut solver = Solver::new();
            solver.set_points(&points).unwrap();
            for k in (0..n * (n - 1)).filter(|k| k % n + 1 < n) {
                solver.add_constraint("Plane", &[k, k + 1, k + n + 1, k + n], 1.0).unwrap();
            }
            for k in 0..n * n {
                solver.add_constraint("Closeness", &[k], 0.05).unwrap();
            }
            solver.set_backend(Backend::Gpu).unwrap();
            solver.init().unwrap();
            solver.solve(1).unwrap();
            solver.on_card.engine.as_mut().unwrap().seconds_per_read_back = seconds_per_read_back;
            let options = SolveOptions { max_iterations: 500, tolerance, ..SolveOptions::default() };
            let mut read_backs = 0;
            let count = &mut |_: &Progress<'_>| {
                read_backs += 1;
                ControlFlow::Continue(())
            };
            let report = solver.solve_until(&options, count).unwrap();
            assert!(report.gpu_iterations > 2, "{report:?}");
            let of_card = report.gpu_iterations;
            ((report.iterations, of_card, report.energy_after.to_bits(), solver.points().to_vec()), read_backs)
        };
        for tolerance in [1e-4, 1e-6, 1e-9] {
            let ((often, many), (seldom, few)) = (solved(0.0, tolerance), solved(f64::INFINITY, tolerance));
            assert!(often == seldom, "{tolerance}: {:?} and {:?}", (often.0, often.1), (seldom.0, seldom.1));
            assert!(many > few, "{tolerance}: {many} and {few} read-backs");
        }
    }
}
