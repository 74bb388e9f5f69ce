//! The engine of an exploration: sweeps until a solution is near, the finish, and what is said of the end.

use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;

use super::conflicts::{Priorities, Suspicion};
use super::finish::{self, Finish, Finished, Residuals};
use super::local::{self, Local};
use super::newton::Kept;
use super::on_card::{Ahead, CardState};
use super::quadratic::ObjectiveTerms;
use super::search::Search;
use super::splitting::{Splitting, Sweep};
use super::{Explorer, Found};
use crate::constraints::{ConstraintId, ConstraintSet};
use crate::error::Result;
use crate::solver::{Outcome, PARALLEL_POINTS, Progress, ProgressFn, Report, SolveOptions, Solver};

/// Sweeps before the first finish, and more, up to [`LATEST`], while constraints become active or inactive within
/// [`SETTLED`] sweeps: a step of the finish costs as much as ten to sixty of them.
const FIRST: u32 = 20;
const SETTLED: u32 = 10;
const LATEST: u32 = 40;

/// Largest distance from a hard constraint, over the mean extent of hard constraints, at which a finish is tried.
const NEAR: f64 = 0.05;

/// Sweeps between looks at the balance of the penalty, and how often it may be changed by that.
const BALANCE: u32 = 10;
const MOST_CHANGES: u32 = 4;

/// Residuals of a solution over the tolerance: those of Newton steps are computed with another penalty.
const JUDGED: f64 = 10.0;

/// Residuals over those before at which Newton steps that ended short go on soon.
const MUCH_NEARER: f64 = 0.1;

/// The part of a residual that is left after sweeps of the card where more of them are worth it.
const GAIN: f64 = 0.5;

/// Sweeps between looks whether sweeps at rest are at a solution.
const REST: u32 = 10;

/// Sweeps at most in which the others are to be met to the last digits once a contradiction has been named.
const SETTLING: u32 = 300;

/// Sweeps between finishes at most then: nothing else is left to do.
const AGAIN: u32 = 40;

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
    /// The penalty of the first sweep, and how often it was balanced.
    pub(super) first_penalty: f64,
    pub(super) changes: u32,
    pub(super) priorities: Priorities,
    /// How often caps were raised.
    pub(super) raises: u32,
    pub(super) course: Course,
    pub(super) card: CardState,
    /// Where more than one thread pays: the pool.
    pub(super) pool: Option<Arc<rayon::ThreadPool>>,
    /// Seconds that the last judgement of the points took: a time budget has to leave them.
    pub(super) judge_seconds: f64,
    /// Seconds that the last Newton step took, for the same reason.
    pub(super) step_seconds: f64,
}

/// What is counted from sweep to sweep, over any number of calls, until something changes that it depends on.
pub(super) struct Course {
    sweeps: u32,
    /// Sweeps in which no constraint became active or inactive.
    settled: u32,
    /// The number of sweeps from which on a finish is tried again.
    next_finish: u32,
    /// Finishes since the last that succeeded.
    finishes: usize,
    /// The least residual, and sweeps since it fell.
    least: f64,
    idle: u32,
    pub(super) suspicion: Suspicion,
    search: Option<Search>,
    named: Option<Named>,
}

/// A contradiction that was found.
struct Named {
    /// The constraints that are given up, by item and by id.
    items: Vec<usize>,
    ids: Vec<ConstraintId>,
    /// Points that meet the others as far as the search asks for it.
    points: Vec<DVec3>,
    /// The number of sweeps at which the points are taken as they are.
    until: u32,
    /// True once the others are met to the last digits, as far as that could be had.
    is_settled: bool,
}

impl Default for Course {
    fn default() -> Self {
        Self {
            sweeps: 0,
            settled: 0,
            next_finish: FIRST,
            finishes: 0,
            least: f64::INFINITY,
            idle: 0,
            suspicion: Suspicion::default(),
            search: None,
            named: None,
        }
    }
}

impl Course {
    fn see(&mut self, sweep: &Sweep) {
        self.sweeps += 1;
        self.settled = if sweep.switched == 0 { self.settled + 1 } else { 0 };
        if sweep.residual < 0.999 * self.least {
            (self.least, self.idle) = (sweep.residual, 0);
        } else {
            self.idle += 1;
        }
    }

    /// The number of constraints that are given up.
    fn given_up(&self) -> usize {
        self.named.as_ref().map_or(0, |named| named.items.len())
    }

    fn is_settled(&self) -> bool {
        self.named.as_ref().is_some_and(|named| named.is_settled)
    }
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
        // A penalty that was raised for a contradiction is none for what comes after.
        let is_raised = engine.raises > 0 || engine.course.search.is_some();
        self.penalty = Some(if is_raised { engine.first_penalty } else { splitting.penalty });
        self.multipliers.clear();
        let all = splitting.multipliers();
        for item in &splitting.hard.items {
            let own = all[item.rows()].iter().map(|row| splitting.penalty * *row).collect();
            self.multipliers.insert(item.id, own);
        }
    }

    /// Gives a new splitting the multipliers of the constraints that were there before, none beyond its cap: what they
    /// were balanced with may be gone.
    pub(super) fn give(&self, splitting: &mut Splitting) {
        if self.multipliers.is_empty() {
            return;
        }
        let mut all = vec![DVec3::ZERO; splitting.rows.len()];
        for (item, cap) in splitting.hard.items.iter().zip(&splitting.caps) {
            if let Some(known) = self.multipliers.get(&item.id).filter(|known| known.len() == item.row_count) {
                all[item.rows()].copy_from_slice(known);
                item.cut(&mut all[item.rows()], *cap);
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
        // While a handle moves, frames come before digits.
        let is_dragged = has_budget && explorer.has_new_targets;
        let follows = solver.forces.has_forces_on_faces();
        let (mut last_residual, mut card_gains) = (None, true);
        // A contradiction stays one where nothing has changed.
        while found.sweeps < options.max_iterations && !self.course.is_settled() {
            if follows {
                self.take_forces(solver, &solver.points);
            }
            let ahead = match last_residual {
                // Where the search counts sweeps, and before anything is known, the processor makes them.
                Some(residual) if card_gains && self.course.search.is_none() => {
                    let most = options.max_iterations - found.sweeps - 1;
                    report.iterations = found.sweeps;
                    match self.sweep_ahead(solver, most, residual, &mut report, progress) {
                        Ahead::Swept(count) => count,
                        Ahead::Cancelled(count) => {
                            found.sweeps += count;
                            report.gpu_iterations += count;
                            report.outcome = Outcome::Cancelled;
                            break;
                        }
                        Ahead::Refused(error) => return Err(error),
                        Ahead::Failed(count, why) => {
                            found.sweeps += count;
                            report.gpu_iterations += count;
                            report.outcome = Outcome::BackendFailed;
                            report.message = format!("{why}; the points are those after sweep {}", found.sweeps);
                            break;
                        }
                    }
                }
                _ => 0,
            };
            report.gpu_iterations += ahead;
            self.course.sweeps += ahead;
            let sweep = self.sweep();
            // Where plain sweeps come nearer slowly, or not at all, the processor's acceleration is what is left.
            let has_gained = last_residual.is_none_or(|last| sweep.residual < GAIN * last);
            card_gains &= ahead == 0 || has_gained || !wants_finish;
            last_residual = Some(sweep.residual);
            found.sweeps += ahead + 1;
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
                evaluations: found.sweeps + found.newton_steps,
                energy: sweep.residual,
                largest_move: report.largest_move,
                solver,
            };
            if progress(&now) == ControlFlow::Break(()) {
                report.outcome = Outcome::Cancelled;
                break;
            }
            if self.course.search.is_some() {
                found.search_sweeps += 1;
                self.search(sweep.capped, &solver.constraints)?;
                solver.points.copy_from_slice(&self.splitting.points);
            } else {
                self.course.see(&sweep);
                if wants_finish && !is_dragged && self.is_time_to_finish(&sweep) {
                    let (sweeps, steps_before) = (found.sweeps, found.newton_steps);
                    let mut is_cancelled = false;
                    let largest_move = report.largest_move;
                    let (mut step_seconds, mut last) = (self.step_seconds, Instant::now());
                    let mut goes_on = |points: &[DVec3], steps: u32| {
                        if steps > 0 {
                            step_seconds = last.elapsed().as_secs_f64();
                        }
                        last = Instant::now();
                        solver.points.copy_from_slice(points);
                        let now = Progress {
                            iteration: sweeps,
                            evaluations: sweeps + steps_before + steps,
                            energy: sweep.residual,
                            largest_move,
                            solver,
                        };
                        is_cancelled = steps > 0 && progress(&now) == ControlFlow::Break(());
                        // A step that would not end in time is not begun.
                        let end = started.elapsed().as_secs_f64() + step_seconds;
                        !(is_cancelled || has_budget && end >= sweeping_seconds)
                    };
                    self.finish(&mut found, &mut goes_on)?;
                    self.step_seconds = step_seconds;
                    solver.points.copy_from_slice(&self.splitting.points);
                    // Forces on faces were held while the points moved.
                    let has_followed =
                        !follows || self.take_forces(solver, &solver.points) <= self.tolerance * self.force;
                    if self.is_solved(&mut found) {
                        if has_followed {
                            report.outcome = Outcome::Converged;
                            break;
                        }
                        self.course.next_finish = 0;
                    }
                    if is_cancelled {
                        report.outcome = Outcome::Cancelled;
                        break;
                    }
                }
                if self.is_at_rest(&sweep, options) && self.is_solved(&mut found) {
                    report.outcome = Outcome::Converged;
                    break;
                }
                if self.course.named.is_none() {
                    let capped = sweep.capped;
                    if self.suspects(capped, &solver.constraints)? && !is_dragged {
                        self.course.search = Some(Search::begin(self, &solver.constraints)?);
                        solver.points.copy_from_slice(&self.splitting.points);
                    } else {
                        self.balance(solver)?;
                    }
                } else {
                    self.balance(solver)?;
                    self.settle();
                    solver.points.copy_from_slice(&self.splitting.points);
                }
            }
            if has_budget && started.elapsed().as_secs_f64() >= sweeping_seconds {
                report.outcome = Outcome::TimeBudget;
                break;
            }
        }
        if let Some(named) = &mut self.course.named {
            found.conflicts.clone_from(&named.ids);
            let has_ended = matches!(report.outcome, Outcome::Converged | Outcome::IterationLimit);
            named.is_settled |= report.outcome == Outcome::Converged;
            if has_ended || named.is_settled {
                report.outcome = Outcome::Infeasible;
            }
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

    /// To be called when something changed that contradictions depend on, other than what a new engine is made for.
    pub(super) fn start_over(&mut self, constraints: &ConstraintSet) -> Result<()> {
        let course = std::mem::take(&mut self.course);
        if let Some(search) = &course.search {
            self.splitting.set_penalty(search.penalty, constraints, false)?;
            self.splitting.restart();
        }
        self.splitting.caps = self.priorities.caps(self.raises);
        self.splitting.forget();
        Ok(())
    }

    /// Goes on with the search, and takes up what it ends with.
    fn search(&mut self, capped: usize, constraints: &ConstraintSet) -> Result<()> {
        let Some(mut search) = self.course.search.take() else { return Ok(()) };
        let Some(items) = search.after_sweep(capped, self) else {
            self.course.search = Some(search);
            return Ok(());
        };
        let mut penalty = search.penalty;
        if !items.is_empty() {
            // It was the contradiction that these were raised for.
            (self.raises, self.changes, penalty) = (0, 0, self.first_penalty);
        }
        self.splitting.set_penalty(penalty, constraints, false)?;
        self.splitting.caps = self.priorities.caps(self.raises);
        items.iter().for_each(|&i| self.splitting.caps[i] = 0.0);
        self.splitting.restart();
        self.course = Course { suspicion: self.course.suspicion.dispelled(), ..Course::default() };
        if !items.is_empty() {
            let mut ids: Vec<ConstraintId> = items.iter().map(|&i| self.splitting.hard.items[i].id).collect();
            ids.sort_unstable();
            self.course.named =
                Some(Named { items, ids, points: self.splitting.points.clone(), until: SETTLING, is_settled: false });
        }
        Ok(())
    }

    /// Takes the points as they are if meeting the others to the last digits takes too long, or those of the search where
    /// they are nearer.
    fn settle(&mut self) {
        let Some(named) = self.course.named.as_mut().filter(|named| self.course.sweeps >= named.until) else { return };
        named.is_settled = true;
        let hard = &mut self.splitting.hard;
        let mut largest = |points: &[DVec3]| {
            let all = distances(hard, points).into_iter().enumerate();
            all.filter(|(i, _)| !named.items.contains(i)).map(|(_, distance)| distance).fold(0.0, f64::max)
        };
        if largest(&named.points) < largest(&self.splitting.points) {
            self.splitting.points.clone_from(&named.points);
            self.splitting.restart();
        }
    }

    /// True if sweeps seem to be near enough for Newton steps.
    fn is_time_to_finish(&self, sweep: &Sweep) -> bool {
        let course = &self.course;
        let is_near = sweep.primal <= NEAR * self.extent || course.idle > 3 * BALANCE;
        is_near && course.sweeps >= course.next_finish && (course.settled >= SETTLED || course.sweeps >= LATEST)
    }

    /// True if the points are a solution of all that is not given up; `found` has the residuals then.
    fn is_solved(&mut self, found: &mut Found) -> bool {
        self.judge(found);
        let are_within = |residuals: Residuals| residuals.are_within(JUDGED * self.tolerance, self.size);
        found.residuals.is_some_and(are_within) && found.capped == self.course.given_up()
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
            Some(pool) if splitting.points.len() >= PARALLEL_POINTS => pool.install(|| splitting.sweep(true)),
            _ => splitting.sweep(false),
        }
    }

    /// True if sweeps alone came to rest, which is looked at now and then.
    fn is_at_rest(&self, sweep: &Sweep, options: &SolveOptions) -> bool {
        let tolerance = options.tolerance.min(self.tolerance) * self.size;
        options.tolerance > 0.0
            && sweep.primal <= tolerance
            && sweep.largest_move <= tolerance
            && sweep.capped == self.course.given_up()
            && self.course.sweeps.is_multiple_of(REST)
    }

    /// Raises a penalty under which the sweeps go round in circles.
    fn balance(&mut self, solver: &Solver) -> Result<()> {
        let course = &mut self.course;
        if course.idle >= 5 * BALANCE && self.changes < MOST_CHANGES && course.sweeps.is_multiple_of(BALANCE) {
            self.splitting.set_penalty(4.0 * self.splitting.penalty, &solver.constraints, false)?;
            self.changes += 1;
            self.course.idle = 0;
        }
        Ok(())
    }

    /// Newton steps from the points in hand; what is nearer is kept.
    /// `goes_on` is asked before each, with the best points so far and the number of steps.
    fn finish(&mut self, found: &mut Found, goes_on: &mut dyn FnMut(&[DVec3], u32) -> bool) -> Result<()> {
        let sweeps = self.course.sweeps;
        let most = if self.course.named.is_some() { AGAIN } else { u32::MAX };
        self.course.next_finish = sweeps + sweeps.clamp(2 * SETTLED, most);
        let splitting = &self.splitting;
        let blocks =
            |local: &Local| local.items.iter().map(|item| 9 * item.point_count * item.point_count).sum::<usize>();
        if blocks(&splitting.soft) + blocks(&splitting.hard) > finish::MOST_ENTRIES {
            return Ok(());
        }
        // What does not succeed under one penalty may under the other.
        let stiffer = finish::STIFFER[self.course.finishes % finish::STIFFER.len()];
        self.course.finishes += 1;
        let (points, u) = (splitting.points.clone(), self.finish_multipliers(stiffer));
        let (tolerance, mut kept) = (self.tolerance, std::mem::take(&mut self.kept));
        let pool = self.pool.clone();
        let mut finish = self.finish_of(stiffer);
        let pool = pool.as_deref();
        let before = finish::on(pool, || finish.residuals(&points, &u));
        let finished = finish.run(&points, &u, tolerance, &mut kept, pool, goes_on);
        self.kept = kept;
        let Finished { points, u, penalty, residuals, steps, factorisations, capped } = finished?;
        found.newton_steps += steps;
        found.factorisations += factorisations;
        let size = self.size;
        let merit = |residuals: &Residuals| (residuals.primal / size).max(residuals.dual);
        let (is_solution, now) = (residuals.are_within(self.tolerance, size), merit(&residuals));
        // With other constraints at their caps than those that are given up, residuals say little.
        if capped != self.course.given_up() || !(is_solution || now < merit(&before)) {
            return Ok(());
        }
        if now < MUCH_NEARER * merit(&before) {
            self.course.next_finish = sweeps + SETTLED;
        }
        self.splitting.points = points;
        self.splitting.resume(&u, penalty);
        if is_solution {
            self.course.finishes = 0;
        } else {
            // Multipliers beyond the model's size under the penalty of the sweeps would.
            let most = size;
            let mut u = self.splitting.multipliers();
            self.splitting.hard.items.iter().for_each(|item| item.cut(&mut u[item.rows()], most));
            let penalty = self.splitting.penalty;
            self.splitting.resume(&u, penalty);
        }
        Ok(())
    }

    /// The finish of the splitting in hand, its penalty so many times as stiff.
    pub(super) fn finish_of(&mut self, stiffer: f64) -> Finish<'_> {
        let splitting = &mut self.splitting;
        Finish {
            quadratic: &splitting.quadratic,
            soft: &mut splitting.soft,
            hard: &mut splitting.hard,
            caps: &splitting.caps,
            penalty: stiffer * splitting.penalty,
            size: self.size,
            force: self.force,
            extent: self.extent,
            is_parallel: self.pool.is_some(),
        }
    }

    /// The splitting's multipliers in that finish's scale.
    pub(super) fn finish_multipliers(&self, stiffer: f64) -> Vec<DVec3> {
        self.splitting.multipliers().iter().map(|u| *u / stiffer).collect()
    }

    /// Computes afresh what the points are worth.
    fn judge(&mut self, found: &mut Found) {
        let (points, u) = (self.splitting.points.clone(), self.finish_multipliers(finish::STIFFER[0]));
        let pool = self.pool.clone();
        let mut finish = self.finish_of(finish::STIFFER[0]);
        let residuals = finish::on(pool.as_deref(), || finish.residuals(&points, &u));
        let finish = self.finish_of(finish::STIFFER[0]);
        found.capped = finish.capped(&u);
        found.is_solution = residuals.are_within(JUDGED * self.tolerance, self.size) && found.capped == 0;
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
