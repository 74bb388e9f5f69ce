//! The finish: Newton's method on the augmented Lagrangian with its multipliers, once the sweeps are near.
//!
//! With `w = A p + u`, `v = P(w)` (that of the elastic set) and a penalty `m`, the multiplier is `λ = m u`, and a
//! solution is where
//!
//! ```text
//! ∇F(p) + m Aᵀ u = 0,        A p − v = 0
//! ```
//!
//! Both are linearised with the derivative `J` of the projection, soft constraints included, so that the active set and
//! the curvature of the sets come from the projections alone. The multipliers of the linear problem are found by the
//! method of multipliers, at one solve with the factor of `∇²F + m Aᵀ (I − J) A` each.
//!
//! Far from a solution that matrix need not be positive definite. Steps then are those of the nearest convex problem:
//! negative eigenvalues of every `I − J` are left out, which costs some steps more but leads there. Once steps are
//! short the exact matrix is tried, and with it convergence is quadratic. A step counts if it lowers the larger of the
//! two residuals below what it was a few steps ago; otherwise it is shortened, and where that does not help either, the
//! first solve is a descent direction of the augmented Lagrangian, which is searched. Sources: Bertsekas 1996,
//! "Constrained optimization and Lagrange multiplier methods", sections 2.3 and 4; Grippo, Lampariello and Lucidi 1986,
//! "A nonmonotone line search technique for Newton's method".

use glam::DVec3;

use super::derivatives::{Differences, add_transposed};
use super::local::{Item, Local};
use super::newton::{ENOUGH_ANSWER, ENOUGH_CHORD, ENOUGH_STEP, Kept, Prepared, Steps, System};
use super::quadratic::Quadratic;
use crate::error::{Error, Result, Status};

/// Newton steps at most.
const STEPS: u32 = 30;

/// Steps with an old factor at most, and to what part they have to lower the larger residual to count: they cost a fifth
/// of a step, or less.
const CHORDS: u32 = 4;
const CHORD_EXACT: f64 = 0.25;
const CHORD_CONVEX: f64 = 0.8;

/// The penalty of the first finish over that of the sweeps: so stiff that few updates of the multipliers solve the linear
/// problem. Where constraints follow from others, softer ones are nearer to a minimum: that of the second finish, and so on
/// in turn.
pub(super) const STIFFER: [f64; 2] = [30.0, 3.0];

/// The penalty of answers over that of the finish: where curved constraints press hard, the matrix is positive definite
/// under a stiff penalty only.
const STIFFER_ANSWER: f64 = 10.0;

/// Steps that look back for a residual which the next has to be below, and how often a step is halved for that.
const LOOKS_BACK: usize = 3;
const HALVINGS: u32 = 3;

/// The largest move of a point, over the mean extent of hard constraints, behind which the exact matrix is tried; and by
/// how much moves must have become shorter before it is tried again where it was not positive definite.
const SHORT: f64 = 0.05;
const SHORTER: f64 = 0.25;

/// The gradient of the augmented Lagrangian over the distance from the constraints, both relative, below which
/// multipliers are updated.
const MINIMISED: f64 = 0.3;

/// Entries of the constraints' blocks from which on no Newton step is made: the factor would be out of proportion.
pub(super) const MOST_ENTRIES: usize = 60_000_000;

/// How far a solution is from being one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    /// The largest distance of a hard constraint's rows from its set, in model units.
    pub primal: f64,
    /// The largest gradient of the Lagrangian at a point, over the force that moves a point of mean stiffness by the
    /// model's size.
    pub dual: f64,
}

/// Points and multipliers with what was found there.
#[derive(Clone)]
pub(super) struct State {
    pub(super) points: Vec<DVec3>,
    /// `u`, in rows.
    pub(super) u: Vec<DVec3>,
    /// `w − v`: the next multipliers.
    excess: Vec<DVec3>,
    /// `∇F`.
    gradient: Vec<DVec3>,
    /// The augmented Lagrangian.
    value: f64,
    residuals: Residuals,
}

/// What the method works with.
pub(super) struct Finish<'a> {
    pub(super) quadratic: &'a Quadratic,
    pub(super) soft: &'a mut Local,
    pub(super) hard: &'a mut Local,
    /// The largest multipliers.
    pub(super) caps: &'a [f64],
    /// `m`.
    pub(super) penalty: f64,
    /// The model's size, and the force that moves a point of mean stiffness by it.
    pub(super) size: f64,
    pub(super) force: f64,
    /// The mean extent of hard constraints.
    pub(super) extent: f64,
    pub(super) is_parallel: bool,
}

/// What a finish led to.
pub(super) struct Finished {
    pub(super) points: Vec<DVec3>,
    /// `u` by rows; the multiplier is `penalty` times it.
    pub(super) u: Vec<DVec3>,
    pub(super) penalty: f64,
    pub(super) residuals: Residuals,
    pub(super) steps: u32,
    pub(super) factorisations: u32,
    pub(super) capped: usize,
}

/// How far a run has come.
struct Course {
    state: State,
    /// The state with the least merit so far, and the merits so far.
    best: State,
    recent: Vec<f64>,
    /// True if the exact matrix is to be tried: at first, and where the last step was as short as that.
    wants_exact: bool,
    short: f64,
    steps: u32,
    factorisations: u32,
}

/// The work on the pool, if there is one.
pub(super) fn on<T: Send>(pool: Option<&rayon::ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

impl Finish<'_> {
    /// Newton steps from `points` with the multipliers `m u` until both residuals are below their tolerance, or until
    /// no step helps. `goes_on` is asked before each step, with the best points so far and the number of steps.
    pub(super) fn run(
        &mut self,
        points: &[DVec3],
        u: &[DVec3],
        tolerance: f64,
        kept: &mut Kept,
        pool: Option<&rayon::ThreadPool>,
        goes_on: &mut dyn FnMut(&[DVec3], u32) -> bool,
    ) -> Result<Finished> {
        let state = on(pool, || self.state(points.to_vec(), u.to_vec()));
        let prepared = on(pool, || self.prepare(kept))?;
        let mut course = Course {
            best: state.clone(),
            recent: vec![self.merit(&state)],
            state,
            wants_exact: true,
            short: SHORT * self.extent,
            steps: 0,
            factorisations: 0,
        };
        while course.steps < STEPS
            && !course.state.residuals.are_within(tolerance, self.size)
            && goes_on(&course.best.points, course.steps)
            && on(pool, || self.advance(&mut course, points, tolerance, prepared))?
        {}
        let Course { best, steps, factorisations, .. } = course;
        let State { points, u, residuals, .. } = best;
        let capped = self.capped(&u);
        Ok(Finished { points, u, penalty: self.penalty, residuals, steps, factorisations, capped })
    }

    /// One step, and those with the same factor that follow. False if none helps. `points` are those at the beginning of the
    /// run.
    fn advance(
        &mut self,
        course: &mut Course,
        points: &[DVec3],
        tolerance: f64,
        prepared: &mut Prepared,
    ) -> Result<bool> {
        let wants_exact = course.wants_exact;
        let system =
            self.system(&course.state, wants_exact, Differences::Simple, prepared, &mut course.factorisations)?;
        let Some(system) = system else { return Ok(false) };
        course.steps += 1;
        let limit = course.recent.iter().rev().take(LOOKS_BACK).copied().fold(0.0, f64::max);
        let Some(next) = self.step(&course.state, &system, prepared, limit) else { return Ok(false) };
        let moves = next.points.iter().zip(&course.state.points).map(|(new, old)| new.distance(*old));
        let moved = moves.fold(0.0, f64::max);
        if wants_exact && !system.is_exact {
            course.short = SHORTER * moved;
        }
        course.wants_exact = moved <= course.short;
        let mut state = next;
        let part = if system.is_exact { CHORD_EXACT } else { CHORD_CONVEX };
        for _ in 0..CHORDS {
            if state.residuals.are_within(tolerance, self.size) {
                break;
            }
            let (_, whole) = self.solve(&system, prepared, &state.gradient, &state.excess, &state.u, ENOUGH_CHORD);
            let next = self.moved(&state, &whole, 1.0);
            // True for NaN.
            if !(self.merit(&next) < part * self.merit(&state)) {
                break;
            }
            state = next;
        }
        course.recent.push(self.merit(&state));
        // What is no solution must not lead out of the model.
        let farthest = state.points.iter().zip(points).map(|(new, old)| new.distance(*old)).fold(0.0, f64::max);
        let is_inside = farthest <= self.size || state.residuals.are_within(tolerance, self.size);
        if is_inside && self.merit(&state) < self.merit(&course.best) {
            course.best = state.clone();
        }
        course.state = state;
        Ok(true)
    }

    /// The number of constraints whose multiplier is at its cap.
    pub(super) fn capped(&self, u: &[DVec3]) -> usize {
        let at_cap = |(item, cap): &(&Item, &f64)| {
            let squares: f64 = u[item.rows()].iter().map(|u| u.length_squared()).sum();
            self.penalty * item.scale * squares.sqrt() >= (1.0 - 1e-9) * **cap
        };
        self.hard.items.iter().zip(self.caps).filter(at_cap).count()
    }

    /// The residuals at `points` with the multipliers `m u`, computed afresh.
    pub(super) fn residuals(&mut self, points: &[DVec3], u: &[DVec3]) -> Residuals {
        self.state(points.to_vec(), u.to_vec()).residuals
    }

    /// How the solution with the multipliers `m u` moves per gradient that is added to that of the objective, each
    /// times 1.
    pub(super) fn answers(
        &mut self,
        points: &[DVec3],
        u: &[DVec3],
        gradients: &[Vec<DVec3>],
        kept: &mut Kept,
    ) -> Result<Vec<Vec<DVec3>>> {
        self.penalty *= STIFFER_ANSWER;
        let u = u.iter().map(|u| *u / STIFFER_ANSWER).collect();
        let state = self.state(points.to_vec(), u);
        let prepared = self.prepare(kept)?;
        let indefinite = || {
            let reason = "the solution is no strict minimum: it does not say how it answers";
            Error::new(Status::InvalidValue, reason)
        };
        let system = self.system(&state, true, Differences::Extrapolated, prepared, &mut 0)?;
        let system = system.filter(|system| system.is_exact).ok_or_else(indefinite)?;
        let none = vec![DVec3::ZERO; state.u.len()];
        let answer = |gradient: &Vec<DVec3>| {
            let (_, steps) = self.solve(&system, prepared, gradient, &none, &none, ENOUGH_ANSWER);
            if steps.is_solved { Ok(steps.points) } else { Err(indefinite()) }
        };
        gradients.iter().map(answer).collect()
    }

    /// The state behind steps of this length.
    fn moved(&mut self, state: &State, steps: &Steps, length: f64) -> State {
        let along = |from: &[DVec3], steps: &[DVec3]| -> Vec<DVec3> {
            from.iter().zip(steps).map(|(start, step)| *start + length * *step).collect()
        };
        self.state(along(&state.points, &steps.points), along(&state.u, &steps.multipliers))
    }

    /// One step: a state whose larger residual is below `limit`, or one further down the augmented Lagrangian, or none.
    fn step(&mut self, state: &State, system: &System, prepared: &mut Prepared, limit: f64) -> Option<State> {
        let (first, whole) = self.solve(system, prepared, &state.gradient, &state.excess, &state.u, ENOUGH_STEP);
        let moved = |from: &[DVec3], direction: &[DVec3], length: f64| -> Vec<DVec3> {
            from.iter().zip(direction).map(|(start, step)| *start + length * *step).collect()
        };
        for halving in 0..=HALVINGS {
            let length = 0.5_f64.powi(halving as i32);
            let next = self.moved(state, &whole, length);
            if self.merit(&next) < limit {
                return Some(next);
            }
        }
        // The slope of the augmented Lagrangian along the first solve.
        let gradient = self.lagrangian_gradient(&state.gradient, &state.excess);
        let slope: f64 = gradient.iter().zip(&first).map(|(g, step)| g.dot(*step)).sum();
        let mut length = 1.0;
        while slope < 0.0 && length > 1e-3 {
            let trial = self.state(moved(&state.points, &first, length), state.u.clone());
            if trial.value < state.value + 1e-4 * length * slope {
                // Multipliers follow once the points have nearly found the minimum for those in hand.
                let left = self.lagrangian_gradient(&trial.gradient, &trial.excess);
                let left = left.iter().map(|g| g.length()).fold(0.0, f64::max) / self.force;
                if left > MINIMISED * trial.residuals.primal / self.size {
                    return Some(trial);
                }
                let excess = trial.excess.clone();
                return Some(self.state(trial.points, excess));
            }
            length *= 0.5;
        }
        None
    }

    fn merit(&self, state: &State) -> f64 {
        let Residuals { primal, dual } = state.residuals;
        let merit = (primal / self.size).max(dual);
        // NaN is not near.
        if merit.is_finite() { merit } else { f64::INFINITY }
    }

    /// What is to be known at `points` with `u`.
    fn state(&mut self, points: Vec<DVec3>, u: Vec<DVec3>) -> State {
        let mut gradient = vec![DVec3::ZERO; points.len()];
        self.quadratic.gradient(&points, &mut gradient);
        let terms = self.quadratic.terms(&points);
        let mut value = terms.handles + terms.closeness + terms.fairness - self.quadratic.work(&points);
        let mut images = vec![DVec3::ZERO; self.soft.row_count()];
        self.soft.place(&points, &mut images, |_, _, _| {}, self.is_parallel);
        self.soft.project(self.is_parallel);
        for (item, stiffness) in self.soft.items.iter().zip(&self.soft.stiffness) {
            let rows = images[item.rows()].iter().zip(&self.soft.targets[item.rows()]);
            let rest: Vec<DVec3> = rows.map(|(image, target)| *image - *target).collect();
            value += 0.5 * stiffness * rest.iter().map(|row| row.length_squared()).sum::<f64>();
            add_transposed(self.soft, item, *stiffness, &rest, &mut gradient);
        }
        let mut images = vec![DVec3::ZERO; self.hard.row_count()];
        let shift = |item: &Item, _: &[DVec3], shift: &mut [DVec3]| shift.copy_from_slice(&u[item.rows()]);
        self.hard.place(&points, &mut images, shift, self.is_parallel);
        self.hard.project(self.is_parallel);
        let mut excess = vec![DVec3::ZERO; images.len()];
        let mut primal = 0.0_f64;
        for (i, item) in self.hard.items.iter().enumerate() {
            let reach = self.caps[i] / self.penalty;
            let own = item.rows();
            let rest = |r: usize| images[r] + u[r] - self.hard.targets[r];
            let distance = item.scale * own.clone().map(|r| rest(r).length_squared()).sum::<f64>().sqrt();
            let part = if distance > reach { reach / distance } else { 1.0 };
            for r in own.clone() {
                excess[r] = part * rest(r);
            }
            value += self.penalty
                * if distance > reach { reach * (distance - 0.5 * reach) } else { 0.5 * distance * distance };
            let gap: f64 = own.map(|r| (excess[r] - u[r]).length_squared()).sum();
            primal = primal.max(item.scale * gap.sqrt());
        }
        let dual = self.lagrangian_gradient(&gradient, &u);
        let dual = dual.iter().map(|g| g.length()).fold(0.0, f64::max) / self.force;
        State { points, u, excess, gradient, value, residuals: Residuals { primal, dual } }
    }

    /// `∇F + m Aᵀ u`.
    fn lagrangian_gradient(&self, gradient: &[DVec3], u: &[DVec3]) -> Vec<DVec3> {
        let mut sums = gradient.to_vec();
        for item in &self.hard.items {
            let factor = self.penalty * item.scale * item.scale;
            add_transposed(self.hard, item, factor, &u[item.rows()], &mut sums);
        }
        sums
    }
}

impl Residuals {
    /// True if both are within `tolerance`, which is relative to the model's `size` and to the force that belongs to
    /// it.
    pub(super) fn are_within(&self, tolerance: f64, size: f64) -> bool {
        self.primal <= tolerance * size && self.dual <= tolerance
    }
}
