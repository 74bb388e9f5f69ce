//! The engine of an exploration: sweeps until a solution is near, the finish, and what is said of the end.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;

use super::conflicts;
use super::finish::{self, Finish, Finished, Kept, Residuals};
use super::local::{self, Local};
use super::quadratic::ObjectiveTerms;
use super::splitting::{Splitting, Sweep};
use super::{Explorer, Found};
use crate::constraints::ConstraintId;
use crate::error::Result;
use crate::solver::{Outcome, Progress, ProgressFn, Report, SolveOptions, Solver};

/// Sweeps before the first finish: so many in any case, and more, up to the second number, while constraints become active or
/// inactive in [`SETTLED`] sweeps. A step of the finish costs as much as some ten to thirty sweeps.
const FIRST: u32 = 20;
const SETTLED: u32 = 5;
const LATEST: u32 = 40;

/// Largest distance from a hard constraint, over the mean extent of hard constraints, at which a finish is tried.
const NEAR: f64 = 0.05;

/// Sweeps between looks at the balance of the penalty, and how often it may be changed by that.
const BALANCE: u32 = 10;
const MOST_CHANGES: u32 = 4;

/// What outlives a change of the constraints.
#[derive(Default)]
pub(super) struct Memory {
    pub(super) penalty: Option<f64>,
    /// Multipliers by constraint, in rows: `λ` over the square of its scale.
    pub(super) multipliers: HashMap<ConstraintId, Vec<DVec3>>,
}

/// The splitting with what belongs to it.
pub(super) struct Engine {
    pub(super) splitting: Splitting,
    pub(super) kept: Kept,
    /// The bounding-box diagonal of `p⁰`, and the force that moves a point of mean stiffness by it.
    pub(super) size: f64,
    pub(super) force: f64,
    /// The mean extent of hard constraints.
    pub(super) extent: f64,
    pub(super) tolerance: f64,
    pub(super) changes: u32,
    /// How often caps were raised.
    pub(super) raises: u32,
    /// Where more than one thread pays: the pool.
    pub(super) pool: Option<Arc<rayon::ThreadPool>>,
    /// Seconds that the last judgement of the points took: a time budget has to leave them.
    pub(super) judge_seconds: f64,
}

/// The largest distance of a constraint's points from its first.
pub(super) fn extent(local: &Local, item: &local::Item, points: &[DVec3]) -> f64 {
    let indices = &local.indices[item.points()];
    let first = points[indices[0] as usize];
    indices.iter().map(|&i| points[i as usize].distance(first)).fold(0.0, f64::max)
}

impl Memory {
    /// Takes what `engine` knows.
    pub(super) fn take(&mut self, engine: &Engine) {
        let splitting = &engine.splitting;
        self.penalty = Some(splitting.penalty);
        self.multipliers.clear();
        let all = splitting.multipliers();
        for item in &splitting.hard.items {
            let own = all[item.rows()].iter().map(|row| splitting.penalty * *row).collect();
            self.multipliers.insert(item.id, own);
        }
    }

    /// Gives a new splitting the multipliers of the constraints that were there before.
    pub(super) fn give(&self, splitting: &mut Splitting) {
        let mut all = vec![DVec3::ZERO; splitting.rows.len()];
        for item in &splitting.hard.items {
            if let Some(known) = self.multipliers.get(&item.id).filter(|known| known.len() == item.row_count) {
                all[item.rows()].copy_from_slice(known);
            }
        }
        splitting.resume(&all, 1.0);
    }
}

impl Engine {
    pub(super) fn run(
        &mut self,
        solver: &mut Solver,
        explorer: &Explorer,
        options: &SolveOptions,
        wants_finish: bool,
        started: Instant,
        progress: &mut ProgressFn<'_>,
    ) -> Result<(Report, Found)> {
        let mut found = Found::default();
        let mut report = Report { outcome: Outcome::IterationLimit, ..Report::empty() };
        let factorisations_before = self.splitting.factorisation_count;
        report.energy_before = self.objective_value();
        let has_budget = options.time_budget_seconds > 0.0;
        let sweeping_seconds = options.time_budget_seconds - self.judge_seconds;
        let is_over = |started: &Instant| has_budget && started.elapsed().as_secs_f64() >= sweeping_seconds;
        // While a handle moves, frames come before digits.
        let may_finish = wants_finish && !(has_budget && explorer.has_new_targets);
        let (mut settled, mut next_finish, mut least, mut idle) = (0, FIRST, f64::INFINITY, 0);
        let mut capped_for = 0;
        let follows = solver.forces.has_forces_on_faces();
        while found.sweeps < options.max_iterations {
            if follows {
                self.take_forces(solver, &solver.points);
            }
            let sweep = self.sweep();
            found.sweeps += 1;
            solver.points.copy_from_slice(&self.splitting.points);
            report.largest_move = sweep.largest_move / self.size;
            let are_finite = solver.points.iter().all(|point| point.is_finite());
            if !(are_finite && sweep.residual.is_finite() && sweep.largest_move.is_finite()) {
                // The caller of this function refuses it and restores the points.
                report.energy_after = f64::NAN;
                return Ok((report, found));
            }
            let now = Progress {
                iteration: found.sweeps,
                evaluations: found.sweeps,
                energy: sweep.residual,
                largest_move: report.largest_move,
                solver,
            };
            if progress(&now) == ControlFlow::Break(()) {
                report.outcome = Outcome::Cancelled;
                break;
            }
            settled = if sweep.switched == 0 { settled + 1 } else { 0 };
            if sweep.residual < 0.999 * least {
                (least, idle) = (sweep.residual, 0);
            } else {
                idle += 1;
            }
            let is_near = sweep.primal <= NEAR * self.extent || idle > 3 * BALANCE;
            if may_finish && is_near && found.sweeps >= next_finish && (settled >= SETTLED || found.sweeps >= LATEST) {
                let is_solution = self.finish(&mut found, options, started)?;
                solver.points.copy_from_slice(&self.splitting.points);
                // Forces on faces were held while the points moved.
                let has_followed = !follows || self.take_forces(solver, &solver.points) <= self.tolerance * self.force;
                if is_solution && has_followed {
                    report.outcome = Outcome::Converged;
                    break;
                }
                next_finish = if is_solution { 0 } else { found.sweeps + found.sweeps.max(2 * SETTLED) };
            }
            if is_over(&started) {
                report.outcome = Outcome::TimeBudget;
                break;
            }
            if self.is_at_rest(&sweep, options) {
                report.outcome = Outcome::Converged;
                break;
            }
            capped_for = if sweep.capped > 0 { capped_for + 1 } else { 0 };
            let is_stuck = capped_for >= conflicts::PATIENCE;
            if is_stuck {
                capped_for = 0;
            }
            // Sweeps at rest with multipliers at their caps leave no residual, but a violation.
            if is_stuck && self.is_violated() {
                if self.raise_caps() {
                    self.splitting.set_penalty(2.0 * self.splitting.penalty, &solver.constraints, false)?;
                } else if may_finish {
                    found.conflicts = self.find_conflicts();
                    solver.points.copy_from_slice(&self.splitting.points);
                    report.outcome = Outcome::Infeasible;
                    break;
                }
            }
            self.balance(&mut idle, found.sweeps, solver)?;
        }
        let judging = Instant::now();
        self.judge(&mut found);
        found.factorisations += self.splitting.factorisation_count - factorisations_before;
        report.iterations = found.sweeps;
        report.evaluations = found.sweeps + found.newton_steps;
        let ObjectiveTerms { handles, closeness, fairness, soft } = found.terms;
        let work = self.splitting.quadratic.work(&self.splitting.points);
        report.energy_after = handles + closeness + fairness + soft - work;
        report.factorisation_count = found.factorisations;
        self.judge_seconds = judging.elapsed().as_secs_f64();
        Ok((report, found))
    }

    /// Takes the forces as they are at `points`; returns the largest change of one.
    pub(super) fn take_forces(&mut self, solver: &Solver, points: &[DVec3]) -> f64 {
        let mut forces = vec![DVec3::ZERO; points.len()];
        solver.forces.sum_into(&mut forces);
        solver.forces.add_forces_on_faces(points, &mut Vec::new(), &mut forces);
        let changed = self.splitting.quadratic.set_forces(&forces);
        self.splitting.quadratic_changed();
        changed
    }

    /// One sweep, on the pool if there is one.
    pub(super) fn sweep(&mut self) -> Sweep {
        let splitting = &mut self.splitting;
        match &self.pool {
            Some(pool) if splitting.points.len() >= super::PARALLEL_POINTS => pool.install(|| splitting.sweep(true)),
            _ => splitting.sweep(false),
        }
    }

    /// True if a hard constraint is further from its set than the tolerance.
    fn is_violated(&mut self) -> bool {
        let bound = self.tolerance * self.size;
        distances(&mut self.splitting.hard, &self.splitting.points).into_iter().any(|distance| distance > bound)
    }

    /// True if sweeps alone came to rest.
    fn is_at_rest(&self, sweep: &Sweep, options: &SolveOptions) -> bool {
        let tolerance = options.tolerance.min(self.tolerance) * self.size;
        options.tolerance > 0.0 && sweep.primal <= tolerance && sweep.largest_move <= tolerance && sweep.capped == 0
    }

    /// Raises a penalty under which the sweeps go round in circles.
    fn balance(&mut self, idle: &mut u32, sweeps: u32, solver: &Solver) -> Result<()> {
        if *idle >= 5 * BALANCE && self.changes < MOST_CHANGES && sweeps.is_multiple_of(BALANCE) {
            self.splitting.set_penalty(4.0 * self.splitting.penalty, &solver.constraints, false)?;
            self.changes += 1;
            *idle = 0;
        }
        Ok(())
    }

    /// Newton steps from the points in hand. True if a solution was found; what is nearer is kept in any case.
    fn finish(&mut self, found: &mut Found, options: &SolveOptions, started: Instant) -> Result<bool> {
        let splitting = &self.splitting;
        let blocks =
            |local: &Local| local.items.iter().map(|item| 9 * item.point_count * item.point_count).sum::<usize>();
        if blocks(&splitting.soft) + blocks(&splitting.hard) > finish::MOST_ENTRIES {
            return Ok(false);
        }
        let (points, u) = (splitting.points.clone(), self.finish_multipliers());
        let mut goes_on =
            || options.time_budget_seconds == 0.0 || started.elapsed().as_secs_f64() < options.time_budget_seconds;
        let (tolerance, mut kept) = (self.tolerance, std::mem::take(&mut self.kept));
        let pool = self.pool.clone();
        let mut finish = self.finish_of();
        let before = finish.residuals(&points, &u);
        let mut run = || finish.run(&points, &u, tolerance, &mut kept, &mut goes_on);
        let finished = match pool {
            Some(pool) => pool.install(run),
            None => run(),
        };
        self.kept = kept;
        let Finished { points, u, penalty, residuals, steps, factorisations, capped } = finished?;
        found.newton_steps += steps;
        found.factorisations += factorisations;
        let merit = |residuals: &Residuals| (residuals.primal / self.size).max(residuals.dual);
        let is_solution = residuals.are_within(self.tolerance, self.size) && capped == 0;
        if is_solution || merit(&residuals) < merit(&before) {
            self.splitting.points = points;
            self.splitting.resume(&u, penalty);
        }
        Ok(is_solution)
    }

    /// The finish of the splitting in hand.
    pub(super) fn finish_of(&mut self) -> Finish<'_> {
        let splitting = &mut self.splitting;
        Finish {
            quadratic: &splitting.quadratic,
            soft: &mut splitting.soft,
            hard: &mut splitting.hard,
            caps: &splitting.caps,
            penalty: finish::penalty_behind(splitting.penalty),
            size: self.size,
            force: self.force,
            extent: self.extent,
            is_parallel: self.pool.is_some(),
        }
    }

    /// The splitting's multipliers in the finish's scale.
    pub(super) fn finish_multipliers(&self) -> Vec<DVec3> {
        let penalty = self.splitting.penalty;
        let factor = penalty / finish::penalty_behind(penalty);
        self.splitting.multipliers().iter().map(|u| factor * *u).collect()
    }

    /// Computes afresh what the points are worth.
    fn judge(&mut self, found: &mut Found) {
        let (points, u) = (self.splitting.points.clone(), self.finish_multipliers());
        let pool = self.pool.clone();
        let mut finish = self.finish_of();
        let mut residuals = || finish.residuals(&points, &u);
        let residuals = match pool {
            Some(pool) => pool.install(residuals),
            None => residuals(),
        };
        let finish = self.finish_of();
        found.capped = finish.capped(&u);
        found.is_solution = residuals.are_within(10.0 * self.tolerance, self.size) && found.capped == 0;
        found.residuals = Some(residuals);
        let splitting = &mut self.splitting;
        found.penalty = splitting.penalty;
        let distances = distances(&mut splitting.hard, &splitting.points);
        let worst = distances.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((item, distance)) = worst {
            found.largest_violation = distance;
            found.worst = Some(splitting.hard.items[item].id);
        }
        found.terms = self.terms();
    }

    fn terms(&mut self) -> ObjectiveTerms {
        let splitting = &mut self.splitting;
        let mut terms = splitting.quadratic.terms(&splitting.points);
        let squares = distances(&mut splitting.soft, &splitting.points);
        let all = squares.iter().zip(&splitting.soft.items).zip(&splitting.soft.stiffness);
        terms.soft = 0.5 * all.map(|((d, item), s)| s * (d / item.scale).powi(2)).sum::<f64>();
        terms
    }

    fn objective_value(&mut self) -> f64 {
        let ObjectiveTerms { handles, closeness, fairness, soft } = self.terms();
        handles + closeness + fairness + soft - self.splitting.quadratic.work(&self.splitting.points)
    }
}

/// The distance of each constraint's rows from their projection, in model units.
pub(super) fn distances(local: &mut Local, points: &[DVec3]) -> Vec<f64> {
    let mut images = vec![DVec3::ZERO; local.row_count()];
    local.place(points, &mut images, |_, _, _| {}, false);
    local.project(false);
    let squares = |item: &local::Item| {
        let rows = images[item.rows()].iter().zip(&local.targets[item.rows()]);
        rows.map(|(image, target)| image.distance_squared(*target)).sum::<f64>()
    };
    local.items.iter().map(|item| item.scale * squares(item).sqrt()).collect()
}
