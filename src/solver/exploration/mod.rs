//! Exploration: hard constraints met exactly, an objective as small as that allows, while handles are dragged.
//!
//! ```text
//! min F(p) = ½ w_h Σ ‖p_i − t_i‖² + ½ w_c Σ ‖p_i − p⁰_i‖² + ½ w_f ‖L (p − p⁰)‖² + ½ Σ_soft w m ‖A p − P(p)‖²
//! s.t. A p ∈ C for every hard constraint
//! ```
//!
//! Sweeps of a splitting method ([`splitting`]) find the neighbourhood of a solution in a few milliseconds; Newton
//! steps ([`finish`]) then find it to the last digits. Both know a constraint by its projection alone. Multipliers have
//! a cap, so that constraints which contradict each other do no harm until they are found ([`conflicts`], [`search`]);
//! points, rows and multipliers are kept from one call to the next, whatever was changed in between. Source: Deng et
//! al. 2015, "Interactive design exploration for constrained meshes".

mod conflicts;
mod derivatives;
mod engine;
mod finish;
mod local;
mod newton;
mod on_card;
mod quadratic;
mod search;
mod sensitivity;
mod splitting;

use std::collections::BTreeMap;
use std::time::Instant;

use glam::DVec3;

use self::conflicts::Priorities;
use self::engine::{Course, Engine, Memory, distances, extent};
use self::newton::Kept;
use self::on_card::CardState;
use self::quadratic::Quadratic;
use self::splitting::Splitting;
use super::{Backend, ProgressFn, Report, SolveOptions, Solver};
use crate::constraints::ConstraintId;
use crate::error::{Error, Result, Status, finite};
use crate::problem::{FairnessRows, Mode, Objective};

pub use self::finish::Residuals;
pub use self::quadratic::ObjectiveTerms;
pub use self::sensitivity::{Sensitivities, WeightClass};

/// Points from which on the finish uses the pool; sweeps do from [`super::PARALLEL_POINTS`] on.
const PARALLEL_FINISH: usize = 1000;

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

/// What an exploration found besides the points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// Sweeps of the splitting method.
    pub sweeps: u32,
    /// Those among them that searched for contradictions.
    pub search_sweeps: u32,
    /// Newton steps.
    pub newton_steps: u32,
    /// Distance from the hard constraints and gradient of the Lagrangian, computed afresh at the end.
    pub residuals: Option<Residuals>,
    /// The largest distance of a hard constraint from its set at the points, in model units, and which constraint it
    /// is.
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

    /// Makes constraints hard, to be met exactly, or soft again, all or none. Their weights then are priorities where
    /// not all can be met.
    ///
    /// # Errors
    /// An id is no constraint, or its rest state is degenerate; the place is `ids[i]`. In dynamic mode hard constraints
    /// are refused.
    pub fn set_hard(&mut self, ids: &[ConstraintId], is_hard: bool) -> Result<()> {
        if is_hard && self.dynamics.as_ref().is_some_and(|dynamics| dynamics.mode == Mode::Dynamic) {
            let reason = "hard constraints are for static mode, and the solver was initialised as dynamic";
            return Err(Error::new(Status::InvalidValue, reason));
        }
        for (i, &id) in ids.iter().enumerate() {
            self.constraints.check_hard(id, is_hard).map_err(|error| error.with_place(format!("ids[{i}]")))?;
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
            let is_long = self.thread_count != 1 && self.points.len() >= PARALLEL_FINISH;
            engine.pool = if is_long { self.pool() } else { None };
            let result = engine.run(self, &explorer, options, wants_finish, started, progress);
            explorer.memory.take(&engine);
            explorer.engine = Some(engine);
            result
        });
        explorer.has_new_targets = false;
        let result = result.and_then(|(mut report, found)| {
            report.backend = if report.gpu_iterations > 0 { Backend::Gpu } else { Backend::Cpu };
            let refusal = explorer.engine.as_ref().and_then(|engine| engine.card.refusal());
            report.backend_reason = self.reason_of_exploration(refusal);
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
            engine.card = CardState::default();
        }
        let have_moved = engine.splitting.points != solver.points;
        // Forces on faces are other ones at every sweep.
        let have_other_forces =
            engine.take_forces(solver, &solver.points) > 0.0 && !solver.forces.has_forces_on_faces();
        if self.has_new_scalars || self.has_new_targets || have_moved || have_other_forces {
            engine.start_over(&solver.constraints)?;
        }
        if have_moved {
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
        let priorities = Priorities::new(&splitting, &solver.constraints, stiffness * extent);
        splitting.caps = priorities.caps(0);
        self.memory.give(&mut splitting);
        Ok(Engine {
            first_penalty: splitting.penalty,
            splitting,
            kept: Kept::default(),
            size,
            force,
            extent,
            tolerance: objective.tolerance,
            changes: 0,
            priorities,
            raises: 0,
            course: Course::default(),
            card: CardState::default(),
            pool: None,
            judge_seconds: 0.0,
            step_seconds: 0.0,
        })
    }
}
