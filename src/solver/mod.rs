//! The local/global solver.
//!
//! One iteration: the *local step* projects the points onto every constraint; the *global step* solves `N x = Aᵀp +
//! external` for new points. Static: `N = Σ s AᵀA`, `external` is the sum of forces. Dynamic: `N` gains the inertia `M
//! = (m/δ₀²) I` and `external` is `M y`, `y` being where momentum alone would take the points. Either way an iteration
//! with nearest projections never raises the energy. Forces on faces follow the points: `external` has them as they
//! were at the points that the iteration begins at, and that promise does not hold with them. Sources: Bouaziz et al.
//! 2012 and 2014; Deuss et al. 2015.

mod acceleration;
mod anderson;
mod assembly;
mod backend;
mod chunks;
mod exploration;
mod forces;
mod free_components;
#[cfg(feature = "gpu")]
mod gpu;
mod history;
mod linear_solver;
mod local_global;
#[cfg(feature = "gpu")]
mod on_card;
mod parallel;
mod quasi_newton;
mod report;
mod system;

pub use backend::{AdapterKind, Backend, BackendInfo, BackendOptions, backend_info, release_backend};
pub use exploration::{Found, ObjectiveTerms, Residuals, Sensitivities, WeightClass};
pub use linear_solver::LinearSolver;
pub use report::{IterationBytes, Outcome, Progress, Rejections, Report, SolveOptions};

use std::ops::ControlFlow;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use crate::constraints::{ConstraintId, ConstraintSet, ConstraintView, Edited, NewConstraints, ReferenceId};
use crate::error::{Error, Result, Status, finite};
use crate::problem::{Acceleration, ForceSet, Mode, Problem, Reference};
use acceleration::Accelerator;
use exploration::Explorer;
use system::{System, SystemCounts};

/// Iterations without a lower energy or a smaller largest move after which a solve is called stalled.
pub const STALL_ITERATIONS: u32 = 100;

/// Points from which on a system is made on more than one thread.
const PARALLEL_POINTS: usize = 4096;

/// What a caller's progress function answers.
pub type ProgressFn<'a> = dyn FnMut(&Progress<'_>) -> ControlFlow<()> + 'a;

/// Points, constraints and forces, and the state of solving for them.
#[derive(Default)]
pub struct Solver {
    points: Vec<DVec3>,
    constraints: ConstraintSet,
    forces: ForceSet,
    /// `None` before the first initialisation.
    dynamics: Option<Dynamics>,
    /// `None` where it must be made anew before the next solve.
    system: Option<System>,
    /// The last system if it may serve for the pattern of the next.
    outdated_system: Option<System>,
    workspace: Workspace,
    acceleration: Acceleration,
    /// Iterations that acceleration remembers; 0: the method's default.
    acceleration_memory: u32,
    /// Kept between accelerated solves for its memory alone.
    accelerator: Option<Accelerator>,
    /// Orderings and numeric factorisations made so far.
    counts: SystemCounts,
    linear_solver: LinearSolver,
    backend: Backend,
    backend_options: BackendOptions,
    #[cfg(feature = "gpu")]
    on_card: on_card::OnCard,
    thread_count: usize,
    pool: Option<Arc<rayon::ThreadPool>>,
    explorer: Explorer,
}

/// The state of the time integration; in static mode only mass and step of libShapeOp's defaults.
#[derive(Clone)]
struct Dynamics {
    mode: Mode,
    mass: f64,
    damping: f64,
    timestep: f64,
    /// The step at initialisation, which the inertia keeps.
    initial_timestep: f64,
    velocities: Vec<DVec3>,
}

impl Dynamics {
    /// `m/δ₀²`, the factor on `y`.
    fn inertia(&self) -> f64 {
        self.mass / (self.initial_timestep * self.initial_timestep)
    }
}

/// Memory that is kept between calls so that iterations allocate nothing.
#[derive(Default)]
struct Workspace {
    /// The sum of forces on each point.
    forces: Vec<DVec3>,
    /// `M y` or the forces, one entry per point; empty in static mode without forces.
    external: Vec<DVec3>,
    /// `external` without the forces on faces; empty where there are none.
    steady: Vec<DVec3>,
    /// Room for the normals of points; all zero.
    normals: Vec<DVec3>,
    /// Where momentum and the forces that are not on faces take the points (dynamic mode).
    momentum: Vec<DVec3>,
    /// `external` and `momentum` of the call before, for when this one is refused.
    kept: [Vec<DVec3>; 2],
    /// The points at the start of the call.
    start: Vec<DVec3>,
}

impl std::fmt::Debug for Solver {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Solver")
            .field("point_count", &self.points.len())
            .field("constraint_count", &self.constraint_count())
            .field("force_count", &self.force_count())
            .finish_non_exhaustive()
    }
}

impl Workspace {
    /// Exchanges `external` and `momentum` with what is kept: before they are computed anew, and again if that is
    /// refused.
    fn swap_external(&mut self) {
        let [external, momentum] = &mut self.kept;
        std::mem::swap(&mut self.external, external);
        std::mem::swap(&mut self.momentum, momentum);
    }
}

impl Solver {
    /// A solver without points.
    pub fn new() -> Self {
        Self::default()
    }

    /// A solver for `problem`, initialised in its mode.
    ///
    /// # Errors
    /// What [`Problem::check`] refuses, or what initialising refuses.
    pub fn from_problem(problem: &Problem) -> Result<Self> {
        let mut solver = Self::assembled(problem)?;
        solver.init_as(problem)?;
        Ok(solver)
    }

    /// Replaces everything by `problem`, initialised in its mode; thread count, linear solver and backend stay.
    ///
    /// # Errors
    /// As [`Solver::from_problem`]; nothing changes then.
    pub fn set_problem(&mut self, problem: &Problem) -> Result<()> {
        let mut new = Self::assembled(problem)?;
        (new.thread_count, new.linear_solver) = (self.thread_count, self.linear_solver);
        (new.backend, new.backend_options) = (self.backend, self.backend_options.clone());
        new.pool = self.pool.clone();
        new.init_as(problem)?;
        *self = new;
        Ok(())
    }

    /// The current points.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Replaces the positions; rest states, targets and velocities stay. Their number may change as long as no
    /// constraint or force refers beyond it; added points start at rest.
    ///
    /// # Errors
    /// A coordinate is not finite, or a constraint or force refers to a point that would be gone.
    pub fn set_points(&mut self, points: &[DVec3]) -> Result<()> {
        if let Some(i) = points.iter().position(|point| !point.is_finite()) {
            let reason = format!("expected finite coordinates, found {}", points[i]);
            return Err(Error::new(Status::InvalidValue, reason).at(format!("points[{i}]")));
        }
        if points.len() != self.points.len() {
            self.check_point_count(points.len())?;
            self.invalidate();
            self.outdated_system = None;
            if let Some(dynamics) = &mut self.dynamics {
                dynamics.velocities.resize(points.len(), DVec3::ZERO);
            }
        }
        self.points.clear();
        self.points.extend_from_slice(points);
        Ok(())
    }

    /// A solver for `problem` that is not initialised.
    fn assembled(problem: &Problem) -> Result<Self> {
        let (points, constraints, forces) = problem.assemble()?;
        let mut solver = Self { points, constraints, forces, ..Self::default() };
        solver.set_acceleration(problem.settings.acceleration, problem.settings.acceleration_memory)?;
        if solver.constraints.hard_count() > 0 || problem.objective.is_some() || !problem.handles.is_empty() {
            let rows = problem.fairness_rows()?;
            solver.set_objective(&problem.objective.clone().unwrap_or_default(), rows)?;
        }
        for handle in &problem.handles {
            solver.set_handle(handle.point, DVec3::from_array(handle.target))?;
        }
        Ok(solver)
    }

    fn init_as(&mut self, problem: &Problem) -> Result<()> {
        match problem.mode {
            Mode::Static => self.init(),
            Mode::Dynamic => self.init_dynamic(problem.masses, problem.damping, problem.timestep),
        }
    }

    /// The number of references.
    pub fn reference_count(&self) -> usize {
        self.constraints.reference_count()
    }

    /// Adds a shape that constraints refer to by the id returned, their first scalar.
    ///
    /// # Errors
    /// As [`Reference::shape`].
    pub fn add_reference(&mut self, reference: &Reference) -> Result<ReferenceId> {
        Ok(self.constraints.add_reference(reference.shape()?))
    }

    /// The number of constraint ids given out, removed ones included.
    pub fn constraint_count(&self) -> usize {
        self.constraints.id_count()
    }

    /// One constraint as it stands; `None` if `id` is none or was removed.
    pub fn constraint(&self, id: ConstraintId) -> Option<ConstraintView<'_>> {
        self.constraints.get(id)
    }

    /// Adds a constraint with the default scalars, at rest where the points are now.
    ///
    /// # Errors
    /// See [`Solver::add_constraints`].
    pub fn add_constraint(&mut self, type_name: &str, indices: &[u32], weight: f64) -> Result<ConstraintId> {
        let (counts, weights) = ([indices.len()], [weight]);
        let new =
            NewConstraints { type_name, indices, counts: &counts, weights: &weights, scalars: &[], scalar_counts: &[] };
        self.add_constraints(new)
    }

    /// Adds constraints of one type, all or none. Their ids follow each other from the one returned.
    ///
    /// # Errors
    /// The type is unknown, a count does not fit, an index is out of range, a weight is negative or not finite, or a
    /// scalar is outside its domain or names no reference of the kind that the type takes.
    pub fn add_constraints(&mut self, new: NewConstraints<'_>) -> Result<ConstraintId> {
        let name_of = |id| format!("constraint {id} (\"{}\")", new.type_name);
        let first = self.constraints.add(&self.points, new, name_of)?;
        if !new.counts.is_empty() {
            self.invalidate();
        }
        Ok(first)
    }

    /// Takes back the constraints of the last call of [`Solver::add_constraints`], which begin at `first`: their ids
    /// are free again.
    pub(crate) fn take_back_constraints(&mut self, first: ConstraintId) {
        self.constraints.take_back(first);
    }

    /// Refuses an edit by what `type_name` and `id` alone decide.
    ///
    /// # Errors
    /// See [`ConstraintSet::check_editable`].
    pub fn check_editable(&self, type_name: &str, id: ConstraintId) -> Result<()> {
        self.constraints.check_editable(type_name, id)
    }

    /// Replaces the scalars of a constraint. The next solve uses them; it factorises again only if rows changed.
    ///
    /// # Errors
    /// See [`ConstraintSet::edit`].
    pub fn edit_constraint(&mut self, type_name: &str, id: ConstraintId, scalars: &[f64]) -> Result<()> {
        match self.constraints.edit(type_name, id, scalars)? {
            Edited::Nothing => {}
            Edited::Targets => {
                self.explorer.scalars_changed();
                #[cfg(feature = "gpu")]
                self.on_card.scalars_changed();
            }
            Edited::Rows => self.invalidate(),
        }
        Ok(())
    }

    /// Replaces the scalars of several constraints of one type, all or none.
    ///
    /// # Errors
    /// See [`ConstraintSet::edit`]; the place is `edits[i]`.
    pub fn edit_constraints(&mut self, type_name: &str, edits: &[(ConstraintId, &[f64])]) -> Result<()> {
        for (i, (id, scalars)) in edits.iter().enumerate() {
            let check = self.constraints.check_edit(type_name, *id, scalars);
            check.map_err(|error| error.at(format!("edits[{i}]")))?;
        }
        edits.iter().try_for_each(|(id, scalars)| self.edit_constraint(type_name, *id, scalars))
    }

    /// Sets the weight of a constraint.
    ///
    /// # Errors
    /// `id` is no constraint, or the weight is negative or not finite.
    pub fn set_weight(&mut self, id: ConstraintId, weight: f64) -> Result<()> {
        if self.constraints.set_weight(id, weight)? {
            self.invalidate();
        }
        Ok(())
    }

    /// Sets the weights of several constraints, all or none.
    ///
    /// # Errors
    /// See [`Solver::set_weight`]; the place is `weights[i]`.
    pub fn set_weights(&mut self, weights: &[(ConstraintId, f64)]) -> Result<()> {
        for (i, &(id, weight)) in weights.iter().enumerate() {
            self.constraints.check_weight(id, weight).map_err(|error| error.at(format!("weights[{i}]")))?;
        }
        weights.iter().try_for_each(|&(id, weight)| self.set_weight(id, weight))
    }

    /// Removes a constraint; its id is never given out again.
    ///
    /// # Errors
    /// `id` is no constraint.
    pub fn remove_constraint(&mut self, id: ConstraintId) -> Result<()> {
        self.constraints.remove(id)?;
        self.invalidate();
        Ok(())
    }

    /// Prepares for static solving from the current points; velocities start at zero.
    ///
    /// # Errors
    /// Status `TooLarge` or `InvalidValue` if the system cannot be factorised.
    pub fn init(&mut self) -> Result<()> {
        self.init_with(Mode::Static, 1.0, 1.0, 1.0)
    }

    /// Prepares for dynamic solving from the current points with zero velocities. `mass` is that of every point,
    /// `damping` the factor on velocities after each step.
    ///
    /// # Errors
    /// `mass` or `timestep` is not finite and above 0, `damping` not finite and at least 0; there is a hard constraint,
    /// a handle or an objective, which static mode alone has; or as [`Solver::init`].
    pub fn init_dynamic(&mut self, mass: f64, damping: f64, timestep: f64) -> Result<()> {
        check_above_0("masses", mass)?;
        check_damping(damping)?;
        check_above_0("timestep", timestep)?;
        if self.explores() {
            let reason = "hard constraints, handles and objectives are for static mode: initialise with init";
            return Err(Error::new(Status::InvalidValue, reason));
        }
        self.init_with(Mode::Dynamic, mass, damping, timestep)
    }

    /// Changes the time step of the following steps, not the inertia. Before initialisation it has no effect.
    ///
    /// # Errors
    /// It is not finite and above 0.
    pub fn set_timestep(&mut self, timestep: f64) -> Result<()> {
        check_above_0("timestep", timestep)?;
        if let Some(dynamics) = &mut self.dynamics {
            dynamics.timestep = timestep;
        }
        Ok(())
    }

    /// Changes the damping of the following steps. Before initialisation it has no effect.
    ///
    /// # Errors
    /// It is not finite and at least 0.
    pub fn set_damping(&mut self, damping: f64) -> Result<()> {
        check_damping(damping)?;
        if let Some(dynamics) = &mut self.dynamics {
            dynamics.damping = damping;
        }
        Ok(())
    }

    /// Sets the number of threads for large problems; 0: as many as the machine has. The results are the same bits.
    pub fn set_thread_count(&mut self, thread_count: usize) {
        if thread_count != self.thread_count {
            self.thread_count = thread_count;
            self.pool = None;
        }
    }

    /// Sets how the following solves are accelerated, and how many iterations are remembered for that (at most 64; 0:
    /// the method's default). `Automatic`, which a new solver has, is `None` in [`Solver::solve`] and `QuasiNewton` in
    /// [`Solver::solve_until`]. Each call, and so each time step, begins with an empty history. With forces on faces,
    /// which not every energy has as its slope, all iterations are plain whatever is set.
    ///
    /// # Errors
    /// The memory is beyond its range.
    pub fn set_acceleration(&mut self, acceleration: Acceleration, memory: u32) -> Result<()> {
        acceleration::check_memory(memory)?;
        if (acceleration, memory) != (self.acceleration, self.acceleration_memory) {
            self.accelerator = None;
        }
        (self.acceleration, self.acceleration_memory) = (acceleration, memory);
        Ok(())
    }

    /// Sets how the linear system of the global step is solved; the next solve uses it. The iterates agree to about
    /// 1e-10 of the model's size. [`Report::linear_solver`] says what ran.
    pub fn set_linear_solver(&mut self, linear_solver: LinearSolver) {
        if linear_solver != self.linear_solver {
            self.linear_solver = linear_solver;
            self.invalidate();
        }
    }

    /// What a plain iteration goes through; `None` before initialisation, after an edit that the next solve has yet to
    /// take up, and with conjugate gradients.
    pub fn iteration_bytes(&self) -> Option<IterationBytes> {
        self.system.as_ref()?.iteration_bytes(&self.constraints)
    }

    /// The violation of every constraint id at the current points, each in its type's unit; 0 for removed ones.
    pub fn violations(&self) -> Vec<f64> {
        self.constraints.violations(&self.points)
    }

    /// The energy at the current points: `½ Σ s ‖A x − P(x)‖²`, in static mode minus the potential of the forces as
    /// they are now, in dynamic mode plus `½ (x−y)ᵀ M (x−y)` with the `y` of the last step.
    ///
    /// A pressure `p` counts as `−p V`, `V` being the volume that its faces enclose with the origin: its potential
    /// where they are closed. A normal force has no potential and counts for nothing.
    pub fn energy(&self) -> f64 {
        let is_dynamic = self.dynamics.as_ref().is_some_and(|dynamics| dynamics.mode == Mode::Dynamic);
        let external =
            if is_dynamic { self.external_energy() } else { -self.work_of_forces() - self.work_of_pressures() };
        System::constraint_energy(&self.constraints, &self.points) + external
    }

    /// What `external` has of a force of length 1.
    fn force_factor(&self) -> f64 {
        self.dynamics.as_ref().map_or(1.0, |dynamics| dynamics.inertia() * dynamics.timestep.powi(2))
    }

    /// Pressure times volume, as it enters the energy.
    fn work_of_pressures(&self) -> f64 {
        if self.forces.has_forces_on_faces() {
            self.force_factor() * self.forces.work_of_pressures(&self.points)
        } else {
            0.0
        }
    }

    /// `external · x` of static mode, from the forces as they are now that are not on faces.
    fn work_of_forces(&self) -> f64 {
        let factor = self.force_factor();
        let mut forces = vec![DVec3::ZERO; self.points.len()];
        self.forces.sum_into(&mut forces);
        factor * forces.iter().zip(&self.points).map(|(force, x)| force.dot(*x)).sum::<f64>()
    }

    /// The number of points that no constraint of a weight above 0 holds.
    pub fn unconstrained_count(&self) -> usize {
        let mut is_held = vec![false; self.points.len()];
        for (batch, weights) in self.constraints.batches() {
            for (slot, _) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
                batch.indices(slot).iter().for_each(|&point| is_held[point as usize] = true);
            }
        }
        is_held.iter().filter(|is_held| !**is_held).count()
    }

    fn init_with(&mut self, mode: Mode, mass: f64, damping: f64, timestep: f64) -> Result<()> {
        let velocities = vec![DVec3::ZERO; self.points.len()];
        let before = self.dynamics.take();
        let inertia_before = before.as_ref().filter(|old| old.mode == Mode::Dynamic).map_or(0.0, Dynamics::inertia);
        let new = Dynamics { mode, mass, damping, timestep, initial_timestep: timestep, velocities };
        let inertia = if mode == Mode::Dynamic { new.inertia() } else { 0.0 };
        if inertia != inertia_before {
            self.invalidate();
        }
        self.dynamics = Some(new);
        self.explorer.initial = self.points.clone();
        self.explorer.invalidate();
        let prepared = self.prepare();
        if prepared.is_err() {
            self.dynamics = before;
            self.invalidate();
        } else {
            self.workspace.external.clear();
            self.workspace.momentum.clear();
        }
        prepared
    }

    /// Marks the system as outdated.
    fn invalidate(&mut self) {
        self.explorer.invalidate();
        #[cfg(feature = "gpu")]
        {
            self.on_card = on_card::OnCard::default();
        }
        if let Some(system) = self.system.take() {
            self.outdated_system = Some(system);
        }
    }

    /// Makes the system if it is outdated.
    fn prepare(&mut self) -> Result<()> {
        let Some(dynamics) = &self.dynamics else {
            let reason = "the solver was not initialised: call init or initDynamic before solve";
            return Err(Error::new(Status::NotInitialised, reason));
        };
        if dynamics.mode == Mode::Static && self.explores() {
            return Ok(());
        }
        if self.system.is_none() {
            self.constraints.compact();
            let inertia = if dynamics.mode == Mode::Dynamic { dynamics.inertia() } else { 0.0 };
            let previous = self.outdated_system.take();
            let is_long = self.thread_count != 1 && self.points.len() >= PARALLEL_POINTS;
            let pool = if is_long { self.pool() } else { None };
            let (points, wish, counts) = (&self.points, self.linear_solver, &mut self.counts);
            let is_parallel = pool.is_some();
            let make = || System::new(&self.constraints, points, inertia, wish, previous, counts, is_parallel);
            self.system = Some(match pool {
                Some(pool) => pool.install(make)?,
                None => make()?,
            });
        }
        Ok(())
    }

    fn check_point_count(&self, count: usize) -> Result<()> {
        let found = self.constraints.first_beyond(count).map(|(id, point)| (format!("constraint {id}"), point));
        let found = found.or_else(|| self.forces.first_beyond(count).map(|(id, point)| (format!("force {id}"), point)));
        let found = found.or_else(|| self.explorer.first_beyond(count));
        match found {
            None => Ok(()),
            Some((what, point)) => {
                let reason = format!("expected more than {point}, as {what} refers to it; found {count}");
                Err(Error::new(Status::InvalidArgumentLength, reason).at("number of points"))
            }
        }
    }

    /// The pool, if more than one thread is allowed and the system is large enough to gain from it.
    fn pool_if_long(&mut self) -> Option<Arc<rayon::ThreadPool>> {
        let is_long = self.thread_count != 1 && self.system.as_ref().is_some_and(System::is_long);
        if is_long { self.pool() } else { None }
    }

    /// The pool for large problems: never the host's, and one for all solvers that leave the number to the machine.
    fn pool(&mut self) -> Option<Arc<rayon::ThreadPool>> {
        static AUTOMATIC: OnceLock<Option<Arc<rayon::ThreadPool>>> = OnceLock::new();
        let build = |count| {
            let name = |i| format!("shapeop-{i}");
            rayon::ThreadPoolBuilder::new().num_threads(count).thread_name(name).build().ok().map(Arc::new)
        };
        if self.thread_count == 0 {
            return AUTOMATIC.get_or_init(|| build(0)).clone();
        }
        if self.pool.is_none() {
            self.pool = build(self.thread_count);
        }
        self.pool.clone()
    }
}

fn check_above_0(name: &str, value: f64) -> Result<()> {
    if finite(name, value)? > 0.0 {
        return Ok(());
    }
    Err(Error::new(Status::InvalidValue, format!("expected a number above 0, found {value}")).at(name))
}

fn check_damping(damping: f64) -> Result<()> {
    if finite("damping", damping)? >= 0.0 {
        return Ok(());
    }
    Err(Error::new(Status::InvalidValue, format!("expected at least 0, found {damping}")).at("damping"))
}
