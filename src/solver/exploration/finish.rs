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

use super::derivatives::{Derivatives, Differences, add_transposed};
use super::local::{Item, Local};
use super::quadratic::Quadratic;
use crate::error::{Error, Result, Status};
use crate::linalg::cholesky::{Analysis, Factor};
use crate::linalg::symmetric::SymmetricMatrix;
use crate::solver::anderson::Anderson;
use crate::solver::history::{Combination, History};

/// Newton steps at most.
const STEPS: u32 = 30;

/// Multiplier updates of one linear problem at most, and to what part they are to lower its residual: for a step, for one
/// with an old factor, and for a derivative that is an answer.
const UPDATES: u32 = 60;
const ENOUGH_STEP: f64 = 1e-2;
const ENOUGH_ANSWER: f64 = 1e-8;
const ENOUGH_CHORD: f64 = 0.1;

/// Steps with an old factor at most, and to what part they have to lower the larger residual to count: they cost a fifth
/// of a step, or less.
const CHORDS: u32 = 4;
const CHORD_EXACT: f64 = 0.25;
const CHORD_CONVEX: f64 = 0.8;

/// Updates that their acceleration remembers, and the growth of what is left at which they are given up.
const KRYLOV_MEMORY: usize = 12;
const DIVERGED: f64 = 10.0;

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
struct State {
    points: Vec<DVec3>,
    /// `u`, in rows.
    u: Vec<DVec3>,
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

/// What is kept from one finish to the next, as the pattern does not change with the points.
#[derive(Default)]
pub(super) struct Kept {
    prepared: Option<Prepared>,
}

struct Prepared {
    matrix: SymmetricMatrix,
    factor: Factor,
    /// The values of the quadratic part.
    quadratic: Vec<f64>,
    /// Where each entry of the blocks of soft and hard constraints belongs among the values; [`TWICE`] where it stands
    /// for both triangles, as that of a point with itself does where a constraint has it twice.
    places: Vec<u32>,
}

const TWICE: u32 = 1 << 31;

/// The derivatives of a Newton step, whose factor is with [`Prepared`].
struct System {
    soft: Derivatives,
    hard: Derivatives,
    is_exact: bool,
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

    /// Pattern, factor and places, made once.
    fn prepare<'k>(&self, kept: &'k mut Kept) -> Result<&'k mut Prepared> {
        if kept.prepared.is_none() {
            kept.prepared = Some(self.prepared()?);
        }
        let missing = || Error::new(Status::Internal, "the system of the finish is missing");
        kept.prepared.as_mut().ok_or_else(missing)
    }

    fn prepared(&self) -> Result<Prepared> {
        let n = self.quadratic.initial().len();
        let unknowns = |local: &Local, item: &Item| -> Vec<u32> {
            local.indices[item.points()].iter().flat_map(|&i| (0..3).map(move |b| 3 * i + b)).collect()
        };
        let locals = [&*self.soft, &*self.hard];
        let mut matrix = SymmetricMatrix::with_pattern(3 * n, |report| {
            self.quadratic.each_entry(&mut |i, j, _| (0..3).for_each(|b| report(3 * i + b, 3 * j + b)));
            for local in locals {
                for item in &local.items {
                    let own = unknowns(local, item);
                    (0..own.len()).for_each(|a| own[..=a].iter().for_each(|&b| report(own[a], b)));
                }
            }
        })?;
        let analysis = Analysis::new(matrix.pattern(), &[])?;
        let factor = Factor::new(&analysis, matrix.pattern())?;
        let (pattern, values) = matrix.split();
        self.quadratic.each_entry(&mut |i, j, value| {
            for b in 0..3 {
                let _ = pattern.add(values, 3 * i + b, 3 * j + b, value);
            }
        });
        let quadratic = values.to_vec();
        let mut places = Vec::new();
        for local in locals {
            for item in &local.items {
                let own = unknowns(local, item);
                for a in 0..own.len() {
                    for b in 0..=a {
                        let place = pattern.place(own[a], own[b]).unwrap_or_default() as u32;
                        places.push(if a != b && own[a] == own[b] { place | TWICE } else { place });
                    }
                }
            }
        }
        Ok(Prepared { matrix, factor, quadratic, places })
    }

    /// The system at `state`, factorised: the exact one if that is wanted and positive definite, or else the nearest
    /// convex one. `None` if that is singular within round-off.
    fn system(
        &mut self,
        state: &State,
        wants_exact: bool,
        differences: Differences,
        prepared: &mut Prepared,
        factorisations: &mut u32,
    ) -> Result<Option<System>> {
        // Where the state placed the constraints' points; another state may have been looked at since.
        let u = &state.u;
        let mut images = vec![DVec3::ZERO; self.soft.row_count()];
        self.soft.place(&state.points, &mut images, |_, _, _| {}, self.is_parallel);
        let mut images = vec![DVec3::ZERO; self.hard.row_count()];
        let shift = |item: &Item, _: &[DVec3], shift: &mut [DVec3]| shift.copy_from_slice(&u[item.rows()]);
        self.hard.place(&state.points, &mut images, shift, self.is_parallel);
        let soft = Derivatives::new(self.soft, self.size, differences, |_, _, _, _| {}, self.is_parallel);
        let (caps, penalty) = (self.caps, self.penalty);
        let elastic = |i: usize, item: &Item, rows: &[DVec3], targets: &mut [DVec3]| {
            let reach = caps[i] / penalty;
            let squares: f64 = rows.iter().zip(&*targets).map(|(row, target)| row.distance_squared(*target)).sum();
            let distance = item.scale * squares.sqrt();
            if distance > reach {
                targets
                    .iter_mut()
                    .zip(rows)
                    .for_each(|(target, row)| *target = *row + reach / distance * (*target - *row));
            }
        };
        let hard = Derivatives::new(self.hard, self.size, differences, elastic, self.is_parallel);
        let mut system = System { soft, hard, is_exact: wants_exact };
        if wants_exact && self.factorise(&system, prepared, factorisations)? {
            return Ok(Some(system));
        }
        system = System {
            soft: system.soft.positive(self.soft, self.is_parallel),
            hard: system.hard.positive(self.hard, self.is_parallel),
            is_exact: false,
        };
        Ok(self.factorise(&system, prepared, factorisations)?.then_some(system))
    }

    /// Assembles and factorises the system's matrix; false if it is not positive definite.
    fn factorise(&self, system: &System, prepared: &mut Prepared, factorisations: &mut u32) -> Result<bool> {
        let Prepared { matrix, factor, quadratic, places } = prepared;
        let (pattern, values) = matrix.split();
        values.copy_from_slice(quadratic);
        let (mut block, mut places) = (Vec::new(), places.iter());
        let both = [(&*self.soft, &system.soft, None), (&*self.hard, &system.hard, Some(self.penalty))];
        for (local, derivatives, penalty) in both {
            for (i, item) in local.items.iter().enumerate() {
                let factor = penalty.map_or(local.stiffness[i], |penalty| penalty * item.scale * item.scale);
                derivatives.each_entry(local, i, &mut block, |value| {
                    let Some(&place) = places.next() else { return };
                    let times = if place & TWICE == 0 { 1.0 } else { 2.0 };
                    values[(place & !TWICE) as usize] += times * factor * value;
                });
            }
        }
        if !(0..pattern.dimension()).all(|i| pattern.diagonal(values, i) > 0.0) {
            return Ok(false);
        }
        factor.factorise(matrix, self.is_parallel)?;
        *factorisations += 1;
        Ok(!factor.is_singular())
    }

    /// Solves the linearised conditions for steps of points and multipliers: `gradient` is that of the objective,
    /// `excess` and `u` are the state's. Returns the points' step of the first solve, and the whole.
    fn solve(
        &self,
        system: &System,
        prepared: &mut Prepared,
        gradient: &[DVec3],
        excess: &[DVec3],
        u: &[DVec3],
        enough: f64,
    ) -> (Vec<DVec3>, Steps) {
        let n = gradient.len();
        let (points, multipliers) = (vec![DVec3::ZERO; n], vec![DVec3::ZERO; u.len()]);
        let mut steps = Steps { points, multipliers, is_solved: false };
        let mut first = Vec::new();
        let mut total = excess.to_vec();
        let (mut smallest, mut wanted) = (f64::INFINITY, None);
        let mut next = vec![DVec3::ZERO; u.len()];
        let mut accelerated = Krylov::new(u.len());
        for update in 1..=UPDATES {
            let mut sums = gradient.to_vec();
            let mut curved = vec![DVec3::ZERO; n];
            self.quadratic.apply(&steps.points, &mut curved);
            sums.iter_mut().zip(&curved).for_each(|(sum, curved)| *sum += *curved);
            self.add_soft_curvature(system, &steps.points, &mut sums);
            for item in &self.hard.items {
                let factor = self.penalty * item.scale * item.scale;
                add_transposed(self.hard, item, factor, &total[item.rows()], &mut sums);
            }
            // Three unknowns per point: x, y and z of the right-hand side one after the other.
            let mut unknowns: Vec<DVec3> =
                sums.iter().flat_map(|sum| sum.to_array()).map(|value| DVec3::new(-value, 0.0, 0.0)).collect();
            prepared.factor.solve(&mut unknowns, self.is_parallel);
            for (step, new) in steps.points.iter_mut().zip(unknowns.chunks_exact(3)) {
                *step += DVec3::new(new[0].x, new[1].x, new[2].x);
            }
            if first.is_empty() {
                first = steps.points.clone();
            }
            let residual = self.next_multipliers(system, excess, u, &steps, &mut next);
            let wanted = *wanted.get_or_insert(enough * residual);
            smallest = smallest.min(residual);
            steps.is_solved = residual <= wanted;
            // True for NaN too.
            if steps.is_solved || update == UPDATES || !(residual < DIVERGED * smallest) {
                break;
            }
            accelerated.advance(&mut steps.multipliers, &next, self.is_parallel);
            self.balance(system, excess, &steps, &mut total);
        }
        steps.multipliers = next;
        (first, steps)
    }

    /// Adds the soft constraints' second derivatives times `step`.
    fn add_soft_curvature(&self, system: &System, step: &[DVec3], sums: &mut [DVec3]) {
        let (mut rows, mut bent) = (Vec::new(), Vec::new());
        for (i, item) in self.soft.items.iter().enumerate() {
            rows.clear();
            rows.resize(item.row_count, DVec3::ZERO);
            self.soft.rows_of(item, step, &mut rows);
            bent.clear();
            bent.resize(item.row_count, DVec3::ZERO);
            system.soft.add_product(i, &rows, &mut bent);
            add_transposed(self.soft, item, self.soft.stiffness[i], &bent, sums);
        }
    }

    /// Writes the steps of multipliers that the steps of the points ask for; returns what is left of the linearised
    /// constraints, in model units.
    fn next_multipliers(
        &self,
        system: &System,
        excess: &[DVec3],
        u: &[DVec3],
        steps: &Steps,
        next: &mut [DVec3],
    ) -> f64 {
        let mut largest = 0.0_f64;
        self.each_excess(system, excess, steps, |item, e| {
            let mut gap = 0.0;
            for (r, e) in item.rows().zip(e) {
                next[r] = *e - u[r];
                gap += (next[r] - steps.multipliers[r]).length_squared();
            }
            largest = largest.max(item.scale * gap.sqrt());
        });
        largest
    }

    /// Writes what the next solve has to balance: the excess behind `steps`.
    fn balance(&self, system: &System, excess: &[DVec3], steps: &Steps, total: &mut [DVec3]) {
        self.each_excess(system, excess, steps, |item, e| total[item.rows()].copy_from_slice(e));
    }

    /// Calls `visit` with every constraint and its linearised excess behind `steps`: `e + M (A dp + du)`.
    fn each_excess(&self, system: &System, excess: &[DVec3], steps: &Steps, mut visit: impl FnMut(&Item, &[DVec3])) {
        let (mut rows, mut sums) = (Vec::new(), Vec::new());
        for (i, item) in self.hard.items.iter().enumerate() {
            rows.clear();
            rows.resize(item.row_count, DVec3::ZERO);
            self.hard.rows_of(item, &steps.points, &mut rows);
            rows.iter_mut().zip(&steps.multipliers[item.rows()]).for_each(|(row, lift)| *row += *lift);
            sums.clear();
            sums.extend_from_slice(&excess[item.rows()]);
            system.hard.add_product(i, &rows, &mut sums);
            visit(item, &sums);
        }
    }
}

/// Anderson acceleration of the multipliers of a linear problem, where it is a Krylov method.
struct Krylov {
    history: History,
    anderson: Anderson,
    combination: Combination,
    step: Vec<DVec3>,
    direction: Vec<DVec3>,
}

impl Krylov {
    fn new(row_count: usize) -> Self {
        let (mut history, mut anderson, mut combination) =
            (History::default(), Anderson::default(), Combination::default());
        history.reset(KRYLOV_MEMORY, row_count, false);
        anderson.reset(KRYLOV_MEMORY);
        combination.reset(KRYLOV_MEMORY);
        let vector = || vec![DVec3::ZERO; row_count];
        Self { history, anderson, combination, step: vector(), direction: vector() }
    }

    /// Replaces `multipliers`, whose plain update is `next`.
    fn advance(&mut self, multipliers: &mut [DVec3], next: &[DVec3], is_parallel: bool) {
        for ((step, next), old) in self.step.iter_mut().zip(next).zip(&*multipliers) {
            *step = *next - *old;
        }
        self.history.push(multipliers, next, &self.step, is_parallel);
        if self.history.len() == 0 {
            multipliers.copy_from_slice(next);
            return;
        }
        self.anderson.combine(&self.history, &mut self.combination);
        self.history.combine(&self.combination, &mut self.direction, is_parallel);
        multipliers.iter_mut().zip(&self.direction).for_each(|(multiplier, step)| *multiplier += *step);
    }
}

/// Steps of points and multipliers.
pub(super) struct Steps {
    pub(super) points: Vec<DVec3>,
    pub(super) multipliers: Vec<DVec3>,
    /// True if what was left of the linearised constraints fell as far as asked for.
    is_solved: bool,
}

impl Residuals {
    /// True if both are within `tolerance`, which is relative to the model's `size` and to the force that belongs to
    /// it.
    pub(super) fn are_within(&self, tolerance: f64, size: f64) -> bool {
        self.primal <= tolerance * size && self.dual <= tolerance
    }
}
