//! Exploration: hard constraints met exactly, an objective as small as that allows, while handles are dragged.
//!
//! ```text
//! min F(p) = ½ w_h Σ ‖p_i − t_i‖² + ½ w_c Σ ‖p_i − p⁰_i‖² + ½ w_f ‖L (p − p⁰)‖² + ½ Σ_soft w m ‖A p − P(p)‖²
//! s.t. A p ∈ C for every hard constraint
//! ```
//!
//! Sweeps of a splitting method ([`splitting`]) find the neighbourhood of a solution in a few milliseconds; Newton steps ([`finish`])
//! then find it to the last digits. Both know a constraint by its projection alone. Multipliers have a cap, so that constraints which
//! contradict each other are seen by theirs ([`conflicts`]); points, rows and multipliers are kept from one call to the next, whatever
//! was changed in between. Source: Deng et al. 2015, "Interactive design exploration for constrained meshes".

mod conflicts;
mod derivatives;
mod finish;
mod local;
mod quadratic;
mod sensitivity;
mod splitting;

use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;
use std::time::Instant;

use glam::DVec3;

use self::finish::{Finish, Finished, Kept};
use self::local::Local;
use self::quadratic::Quadratic;
use self::splitting::{Splitting, Sweep};
use super::{Outcome, Progress, ProgressFn, Report, SolveOptions, Solver};
use crate::constraints::ConstraintId;
use crate::error::{Error, Result, Status, finite};
use crate::problem::{FairnessRows, Mode, Objective};

pub use self::finish::Residuals;
pub use self::quadratic::ObjectiveTerms;
pub use self::sensitivity::{Sensitivities, WeightClass};

/// Sweeps before the first finish, and sweeps in which no constraint may have become active or inactive.
const SETTLED: u32 = 5;

/// Largest distance from a hard constraint, over the mean extent of hard constraints, at which a finish is tried.
const NEAR: f64 = 1e-2;

/// Sweeps between looks at the balance of the penalty, and how often it may be changed by that.
const BALANCE: u32 = 10;
const MOST_CHANGES: u32 = 4;

/// What an exploration was asked for and what it holds.
#[derive(Default)]
pub(super) struct Explorer {
    objective: Option<Objective>,
    rows: FairnessRows,
    handles: BTreeMap<u32, DVec3>,
    /// `p⁰`: the points at initialisation.
    pub(super) initial: Vec<DVec3>,
    engine: Option<Engine>,
    /// What the last engine knew, for the next.
    memory: Memory,
    is_outdated: bool,
    has_new_scalars: bool,
    has_new_targets: bool,
    found: Option<Found>,
}

/// What outlives a change of the constraints.
#[derive(Default)]
struct Memory {
    penalty: Option<f64>,
    /// Multipliers by constraint, in rows: `λ` over the square of its scale.
    multipliers: HashMap<ConstraintId, Vec<DVec3>>,
}

/// The splitting with what belongs to it.
struct Engine {
    splitting: Splitting,
    kept: Kept,
    /// The bounding-box diagonal of `p⁰`, and the force that moves a point of mean stiffness by it.
    size: f64,
    force: f64,
    /// The mean extent of hard constraints.
    extent: f64,
    tolerance: f64,
    changes: u32,
    /// How often caps were raised.
    raises: u32,
}

/// What an exploration found besides the points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// Sweeps of the splitting method.
    pub sweeps: u32,
    /// Newton steps.
    pub newton_steps: u32,
    /// Distance from the hard constraints and gradient of the Lagrangian, computed afresh at the end.
    pub residuals: Option<Residuals>,
    /// The largest distance of a hard constraint from its set at the points, in model units, and which constraint it is.
    pub largest_violation: f64,
    /// That constraint; `None` if there are no hard ones.
    pub worst: Option<ConstraintId>,
    /// Constraints whose multiplier is at its cap.
    pub capped: usize,
    /// The penalty of the sweeps.
    pub penalty: f64,
    /// Numeric factorisations.
    pub factorisations: u32,
    /// True if the points are a solution: both residuals within the tolerance, no multiplier at its cap.
    pub is_solution: bool,
    /// The terms of the objective.
    pub terms: ObjectiveTerms,
    /// A small set of hard constraints without which the others can be met; empty where all can.
    pub conflicts: Vec<ConstraintId>,
}

impl Found {
    /// False if a number overflowed.
    fn is_finite(&self) -> bool {
        let ObjectiveTerms { handles, closeness, fairness, soft } = self.terms;
        let [primal, dual] = self.residuals.map_or([0.0; 2], |residuals| [residuals.primal, residuals.dual]);
        let numbers = [handles, closeness, fairness, soft, primal, dual, self.largest_violation, self.penalty];
        numbers.iter().all(|number| number.is_finite())
    }
}

impl Solver {
    /// True if there is anything to explore: a hard constraint, a handle or an objective.
    pub(super) fn explores(&self) -> bool {
        let explorer = &self.explorer;
        explorer.objective.is_some() || !explorer.handles.is_empty() || self.constraints.hard_count() > 0
    }

    /// Makes constraints hard, to be met exactly, or soft again, all or none. Their weights then are priorities where not all can be met.
    ///
    /// # Errors
    /// An id is no constraint, or its rest state is degenerate; the place is `ids[i]`. In dynamic mode hard constraints are refused.
    pub fn set_hard(&mut self, ids: &[ConstraintId], is_hard: bool) -> Result<()> {
        if is_hard && self.dynamics.as_ref().is_some_and(|dynamics| dynamics.mode == Mode::Dynamic) {
            let reason = "hard constraints are for static mode, and the solver was initialised as dynamic";
            return Err(Error::new(Status::InvalidValue, reason));
        }
        for (i, &id) in ids.iter().enumerate() {
            self.constraints.check_hard(id, is_hard).map_err(|error| error.at(format!("ids[{i}]")))?;
        }
        for &id in ids {
            if self.constraints.set_hard(id, is_hard)? {
                self.invalidate();
            }
        }
        Ok(())
    }

    /// Sets the objective and the rows of its fairness term; weights that are the same cost nothing.
    ///
    /// # Errors
    /// A weight or the tolerance is outside its domain, or a row refers beyond the points.
    pub fn set_objective(&mut self, objective: &Objective, rows: FairnessRows) -> Result<()> {
        objective.check()?;
        if let Some(point) = rows.greatest_point().filter(|point| *point as usize >= self.points.len()) {
            let reason = format!("{point} is out of range for {} points", self.points.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at("fairness"));
        }
        let explorer = &mut self.explorer;
        if explorer.objective.as_ref() != Some(objective) || explorer.rows != rows {
            (explorer.objective, explorer.rows) = (Some(objective.clone()), rows);
            explorer.is_outdated = true;
        }
        Ok(())
    }

    /// The rows of the fairness term.
    pub fn fairness_rows(&self) -> &FairnessRows {
        &self.explorer.rows
    }

    /// The objective in force.
    pub fn objective(&self) -> Objective {
        self.explorer.objective.clone().unwrap_or_default()
    }

    /// Makes a point a handle, drawn to `target`, or moves its target. Moving one costs nothing but the next solve.
    ///
    /// # Errors
    /// The point is out of range, or the target is not finite.
    pub fn set_handle(&mut self, point: u32, target: DVec3) -> Result<()> {
        if point as usize >= self.points.len() {
            let reason = format!("{point} is out of range for {} points", self.points.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at("handle"));
        }
        target.to_array().into_iter().try_for_each(|value| finite("target", value).map(drop))?;
        let explorer = &mut self.explorer;
        match explorer.handles.insert(point, target) {
            None => explorer.is_outdated = true,
            Some(old) if old != target => {
                explorer.has_new_targets = true;
                if let Some(engine) = &mut explorer.engine {
                    engine.splitting.quadratic.set_target(point, target);
                }
            }
            Some(_) => {}
        }
        Ok(())
    }

    /// Lets a handle go: the point is drawn to where it was at initialisation again, as all others are.
    ///
    /// # Errors
    /// The point is no handle.
    pub fn release_handle(&mut self, point: u32) -> Result<()> {
        if self.explorer.handles.remove(&point).is_none() {
            return Err(Error::new(Status::InvalidValue, format!("point {point} is no handle")).at("handle"));
        }
        self.explorer.is_outdated = true;
        Ok(())
    }

    /// The handles with their targets.
    pub fn handles(&self) -> impl Iterator<Item = (u32, DVec3)> + '_ {
        self.explorer.handles.iter().map(|(point, target)| (*point, *target))
    }

    /// What the last exploration found; `None` if there was none.
    pub fn found(&self) -> Option<&Found> {
        self.explorer.found.as_ref()
    }

    /// Sweeps, and a finish where that is wanted, until `options` say to stop.
    pub(super) fn explore(
        &mut self,
        options: &SolveOptions,
        wants_finish: bool,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Report> {
        if self.dynamics.is_none() {
            let reason = "the solver was not initialised: call init before solve";
            return Err(Error::new(Status::NotInitialised, reason));
        }
        if self.dynamics.as_ref().is_some_and(|dynamics| dynamics.mode == Mode::Dynamic) {
            let reason = "hard constraints, handles and objectives are for static mode: initialise with init";
            return Err(Error::new(Status::InvalidValue, reason));
        }
        let started = Instant::now();
        self.constraints.compact();
        let mut explorer = std::mem::take(&mut self.explorer);
        let start = self.points.clone();
        let result = explorer.prepare(self).and_then(|mut engine| {
            let result = engine.run(self, &explorer, options, wants_finish, started, progress);
            explorer.memory.take(&engine);
            explorer.engine = Some(engine);
            result
        });
        explorer.has_new_targets = false;
        let result = result.and_then(|(report, found)| {
            let are_finite = self.points.iter().all(|point| point.is_finite());
            if are_finite && report.is_finite() && found.is_finite() {
                explorer.found = Some(found);
                return Ok(report);
            }
            explorer.engine = None;
            explorer.memory = Memory::default();
            let reason =
                "coordinates, forces or weights are so large that the result is not finite; nothing was changed";
            Err(Error::new(Status::InvalidValue, reason))
        });
        if result.is_err() {
            self.points = start;
        }
        self.explorer = explorer;
        result
    }
}

impl Explorer {
    /// A handle or a row of the fairness term that refers to a point at or beyond `point_count`, with that point.
    pub(super) fn first_beyond(&self, point_count: usize) -> Option<(String, u32)> {
        let handle = self.handles.keys().next_back().map(|&point| ("a handle".to_owned(), point));
        let row = self.rows.greatest_point().map(|point| ("the fairness".to_owned(), point));
        handle.into_iter().chain(row).find(|(_, point)| *point as usize >= point_count)
    }

    /// To be called when constraints, weights or points came or went.
    pub(super) fn invalidate(&mut self) {
        self.is_outdated = true;
    }

    /// True if nothing changed since the last exploration.
    fn is_current(&self) -> bool {
        !(self.is_outdated || self.has_new_scalars || self.has_new_targets)
    }

    /// To be called when scalars changed that rows do not depend on.
    pub(super) fn scalars_changed(&mut self) {
        self.has_new_scalars = true;
    }

    /// The engine, brought up to date.
    fn prepare(&mut self, solver: &mut Solver) -> Result<Engine> {
        if self.initial.len() != solver.points.len() {
            // Points came since initialisation: where they are now is where they were.
            self.initial = solver.points.clone();
        }
        let kept = self.engine.take().filter(|_| !self.is_outdated);
        let mut engine = match kept {
            Some(engine) => engine,
            None => self.new_engine(solver)?,
        };
        if self.has_new_scalars {
            engine.splitting.soft.take_scalars(&solver.constraints.part(false));
            engine.splitting.hard.take_scalars(&solver.constraints.part(true));
            engine.splitting.forget();
        }
        engine.take_forces(solver, &solver.points);
        if self.has_new_targets {
            engine.splitting.forget();
        }
        if engine.splitting.points != solver.points {
            engine.splitting.points.copy_from_slice(&solver.points);
            let (multipliers, penalty) = (engine.splitting.multipliers(), engine.splitting.penalty);
            engine.splitting.resume(&multipliers, penalty);
        }
        (self.is_outdated, self.has_new_scalars) = (false, false);
        Ok(engine)
    }

    fn new_engine(&self, solver: &Solver) -> Result<Engine> {
        let objective = self.objective.clone().unwrap_or_default();
        let handles = self.handles.iter().map(|(point, target)| (*point, *target));
        let quadratic = Quadratic::new(&objective, &self.rows, &self.initial, handles);
        let size = super::local_global::bounding_box_diagonal(&self.initial);
        let (trace, count) = quadratic.free_trace();
        let stiffness = if count > 0 { trace / count as f64 } else { objective.handle_weight };
        let mut splitting =
            Splitting::new(quadratic, &solver.constraints, &solver.points, size, self.memory.penalty, false)?;
        let extents = splitting.hard.items.iter().map(|item| extent(&splitting.hard, item, &self.initial));
        let (sum, count) =
            extents.filter(|extent| *extent > 0.0).fold((0.0, 0), |(sum, count), e| (sum + e, count + 1));
        let extent = if count > 0 { sum / f64::from(count) } else { size };
        let force = stiffness * size;
        splitting.caps = conflicts::caps(&splitting, &solver.constraints, stiffness * extent);
        self.memory.give(&mut splitting);
        Ok(Engine {
            splitting,
            kept: Kept::default(),
            size,
            force,
            extent,
            tolerance: objective.tolerance,
            changes: 0,
            raises: 0,
        })
    }
}

/// The largest distance of a constraint's points from its first.
fn extent(local: &Local, item: &local::Item, points: &[DVec3]) -> f64 {
    let indices = &local.indices[item.points()];
    let first = points[indices[0] as usize];
    indices.iter().map(|&i| points[i as usize].distance(first)).fold(0.0, f64::max)
}

impl Memory {
    /// Takes what `engine` knows.
    fn take(&mut self, engine: &Engine) {
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
    fn give(&self, splitting: &mut Splitting) {
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
    fn run(
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
        let is_over = |started: &Instant| has_budget && started.elapsed().as_secs_f64() >= options.time_budget_seconds;
        // While a handle moves, frames come before digits.
        let may_finish = wants_finish && !(has_budget && explorer.has_new_targets);
        let (mut settled, mut next_finish, mut least, mut idle) = (0, SETTLED, f64::INFINITY, 0);
        let mut capped_for = 0;
        let follows = solver.forces.has_forces_on_faces();
        while found.sweeps < options.max_iterations {
            if follows {
                self.take_forces(solver, &solver.points);
            }
            let sweep = self.splitting.sweep(false);
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
            if may_finish
                && is_near
                && found.sweeps >= next_finish
                && (settled >= SETTLED || found.sweeps >= 4 * SETTLED)
            {
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
            if capped_for >= conflicts::PATIENCE && sweep.primal > self.tolerance * self.size {
                capped_for = 0;
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
        self.judge(&mut found);
        found.factorisations += self.splitting.factorisation_count - factorisations_before;
        report.iterations = found.sweeps;
        report.evaluations = found.sweeps + found.newton_steps;
        report.energy_after = self.objective_value();
        report.factorisation_count = found.factorisations;
        Ok((report, found))
    }

    /// Takes the forces as they are at `points`; returns the largest change of one.
    fn take_forces(&mut self, solver: &Solver, points: &[DVec3]) -> f64 {
        let mut forces = vec![DVec3::ZERO; points.len()];
        solver.forces.sum_into(&mut forces);
        solver.forces.add_forces_on_faces(points, &mut Vec::new(), &mut forces);
        let changed = self.splitting.quadratic.set_forces(&forces);
        self.splitting.quadratic_changed();
        changed
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
        let mut finish = self.finish_of();
        let before = finish.residuals(&points, &u);
        let finished = finish.run(&points, &u, tolerance, &mut kept, &mut goes_on);
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
    fn finish_of(&mut self) -> Finish<'_> {
        let splitting = &mut self.splitting;
        Finish {
            quadratic: &splitting.quadratic,
            soft: &mut splitting.soft,
            hard: &mut splitting.hard,
            caps: &splitting.caps,
            penalty: finish::penalty_behind(splitting.penalty),
            size: self.size,
            force: self.force,
            is_parallel: false,
        }
    }

    /// The splitting's multipliers in the finish's scale.
    fn finish_multipliers(&self) -> Vec<DVec3> {
        let penalty = self.splitting.penalty;
        let factor = penalty / finish::penalty_behind(penalty);
        self.splitting.multipliers().iter().map(|u| factor * *u).collect()
    }

    /// Computes afresh what the points are worth.
    fn judge(&mut self, found: &mut Found) {
        let (points, u) = (self.splitting.points.clone(), self.finish_multipliers());
        let mut finish = self.finish_of();
        let residuals = finish.residuals(&points, &u);
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
fn distances(local: &mut Local, points: &[DVec3]) -> Vec<f64> {
    let mut images = vec![DVec3::ZERO; local.row_count()];
    local.place(points, &mut images, |_, _, _| {}, false);
    local.project(false);
    let squares = |item: &local::Item| {
        let rows = images[item.rows()].iter().zip(&local.targets[item.rows()]);
        rows.map(|(image, target)| image.distance_squared(*target)).sum::<f64>()
    };
    local.items.iter().map(|item| item.scale * squares(item).sqrt()).collect()
}
