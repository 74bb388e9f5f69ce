//! What a solve was asked for and what it found.

use super::{Backend, LinearSolver, Solver};
use crate::problem::Settings;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveOptions {
    /// Iterations at most; in dynamic mode within the one time step that a call makes.
    pub max_iterations: u32,
    /// Stop when `max_i ‖x_i' − x_i‖ < tolerance · d`: `x` and `x'` the points before and after an iteration, `d` the
    /// bounding-box diagonal at the start of the call. 0 never stops that way.
    pub tolerance: f64,
    /// Stop after so many seconds, looked at once per iteration; 0: no limit.
    pub time_budget_seconds: f64,
}

impl Default for SolveOptions {
    fn default() -> Self {
        Self::from(&Settings::default())
    }
}

impl From<&Settings> for SolveOptions {
    fn from(settings: &Settings) -> Self {
        Self {
            max_iterations: settings.max_iterations,
            tolerance: settings.tolerance,
            time_budget_seconds: settings.time_budget_seconds,
        }
    }
}

/// Bytes of what a plain iteration goes through at least: the factor twice, the rest once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IterationBytes {
    /// The factor as it is stored: values, row indices, and where they lie.
    pub factor: usize,
    /// The right-hand sides of the linear system.
    pub right_hand_sides: usize,
    /// The points.
    pub points: usize,
    /// The projections.
    pub projections: usize,
    /// Indices, scalars and rest states of the constraints, and the entries of `Aᵀ`.
    pub constraints: usize,
}

/// Why a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Outcome {
    /// The largest move fell below the tolerance.
    Converged = 0,
    /// The iterations were used up.
    IterationLimit = 1,
    /// The time was used up.
    TimeBudget = 2,
    /// The caller's progress function said so.
    Cancelled = 3,
    /// For [`super::STALL_ITERATIONS`] iterations neither the energy nor the largest move fell.
    Stalled = 4,
    /// A force acts along a motion that no constraint resists; the points did not move.
    Unbounded = 5,
    /// Hard constraints contradict each other; [`super::Found::conflicts`] names a small set of them, and the points
    /// meet the others.
    Infeasible = 6,
    /// The graphics card was lost or refused work; the points are those of [`Report::read_back_iteration`], and the
    /// processor can go on from there.
    BackendFailed = 7,
}

impl Outcome {
    /// The outcome in words.
    pub fn text(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::IterationLimit => "iteration limit",
            Self::TimeBudget => "time budget",
            Self::Cancelled => "cancelled",
            Self::Stalled => "stalled",
            Self::Unbounded => "unbounded",
            Self::Infeasible => "infeasible",
            Self::BackendFailed => "backend failed",
        }
    }
}

/// What a solve found.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Iterations made: steps to new points.
    pub iterations: u32,
    /// Evaluations made: a local step at points that were tried, whether they were kept or not, and the global step
    /// from there where they were. Without acceleration one per iteration. The local step at the points of the start is
    /// not counted.
    pub evaluations: u32,
    /// What acceleration tried in vain.
    pub rejections: Rejections,
    /// The energy at the points that the iterations started from.
    pub energy_before: f64,
    /// The energy at the points that were reached.
    pub energy_after: f64,
    /// The largest move of a point in the last iteration, relative to the bounding-box diagonal.
    pub largest_move: f64,
    /// Why it ended.
    pub outcome: Outcome,
    /// More about an outcome of [`Outcome::Unbounded`], the point or component that is free to move, or of
    /// [`Outcome::BackendFailed`], what happened to the card. Else empty.
    pub message: String,
    /// Orderings (with the analysis of the pattern) made since the solver was created.
    pub ordering_count: u32,
    /// Numeric factorisations made since the solver was created, those of singular matrices that a remedy followed
    /// included.
    pub factorisation_count: u32,
    /// Seconds spent on the ordering and the pattern of the factor, when the system in use was made.
    pub analysis_seconds: f64,
    /// Seconds spent on the factor's numbers, when the system in use was made.
    pub factorisation_seconds: f64,
    /// Seconds spent on projections in this call.
    pub local_seconds: f64,
    /// Seconds spent on right-hand sides and linear solves in this call.
    pub global_seconds: f64,
    /// How linear systems were solved: `Direct` or `ConjugateGradients`.
    pub linear_solver: LinearSolver,
    /// Why that way, in words.
    pub linear_solver_reason: String,
    /// Iterations of conjugate gradients in all linear solves of this call, those on the card included; 0 with a factor alone.
    pub linear_iterations: u32,
    /// `Gpu` if the card made any of the iterations, else `Cpu`.
    pub backend: Backend,
    /// Why that one, in words.
    pub backend_reason: String,
    /// Those of the iterations that the card made.
    pub gpu_iterations: u32,
    /// Seconds in which the card worked.
    pub gpu_seconds: f64,
    /// Seconds in which points went to the card and back.
    pub transfer_seconds: f64,
    /// The iteration after which points were read back from the card last.
    pub read_back_iteration: u32,
}

/// How often acceleration was held back, by cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rejections {
    /// Evaluations of points whose energy was higher than before, or not as much lower as the line search asks for.
    pub energy_rose: u32,
    /// Evaluations of points whose energy was not finite.
    pub not_finite: u32,
    /// Iterations that left out a part of the history: changes that others span (Anderson), or a move along which the
    /// energy bends down (quasi-Newton).
    pub ill_conditioned: u32,
    /// Directions that were not tried, as the energy would rise along them; all of the history was forgotten then.
    pub not_descent: u32,
    /// Directions that were given up, as no length tried along them was accepted.
    pub line_search: u32,
}

impl std::ops::AddAssign for Rejections {
    fn add_assign(&mut self, other: Self) {
        self.energy_rose += other.energy_rose;
        self.not_finite += other.not_finite;
        self.ill_conditioned += other.ill_conditioned;
        self.not_descent += other.not_descent;
        self.line_search += other.line_search;
    }
}

/// What a progress function sees after every iteration.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Iterations made so far, from 1.
    pub iteration: u32,
    /// Evaluations made so far.
    pub evaluations: u32,
    /// The energy at the current points.
    pub energy: f64,
    /// The largest move of a point in this iteration, relative to the bounding-box diagonal.
    pub largest_move: f64,
    /// The solver with the current points.
    pub solver: &'a Solver,
}
