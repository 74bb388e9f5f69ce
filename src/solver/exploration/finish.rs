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
//! the curvature of the sets come from the projections alone. The matrix `∇²F + m Aᵀ (I − J) A` is positive definite
//! near a minimum; the multipliers of the linear problem are found by the method of multipliers, at one solve with its
//! factor each. A step counts if it lowers the larger of the two residuals; otherwise the first solve is a descent
//! direction of the augmented Lagrangian, which is searched. Source: Bertsekas 1996, "Constrained optimization and
//! Lagrange multiplier methods", sections 2.3 and 4.

use glam::DVec3;

use super::derivatives::{Derivatives, add_transposed};
use super::local::{Item, Local};
use super::quadratic::Quadratic;
use crate::error::{Error, Result, Status};
use crate::linalg::cholesky::{Analysis, Factor};
use crate::linalg::symmetric::SymmetricMatrix;
use crate::solver::anderson::Anderson;
use crate::solver::history::{Combination, History};

/// Newton steps at most.
const STEPS: u32 = 30;

/// Multiplier updates of one linear problem at most, and by how much they are to lower its residual: for a Newton step,
/// and for a derivative that is an answer.
#[derive(Clone, Copy)]
struct Updates {
    most: u32,
    enough: f64,
}

const OF_A_STEP: Updates = Updates { most: 12, enough: 1e-4 };
const OF_AN_ANSWER: Updates = Updates { most: 60, enough: 1e-10 };

/// Updates that their acceleration remembers, and the growth of what is left at which they are given up.
const KRYLOV_MEMORY: usize = 12;
const DIVERGED: f64 = 10.0;

/// The penalty of the finish over that of the sweeps. Of 1, 5, 20, 100 and 1000, 5 needs the fewest Newton steps on the
/// surfaces of Fig. 12 and succeeds earliest: stiffer, the steps follow the curved sets in small pieces.
const STIFFER: f64 = 5.0;

/// Where a step leaves more than this part of the distance from the constraints, and the gradient is the smaller
/// residual, multipliers come too slowly, and the penalty is raised: constraints that nearly depend on each other need
/// that.
const SLOW: f64 = 0.1;
const STIFFENING: f64 = 5.0;
const STIFFEST: f64 = 100.0;

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
    pub(super) is_parallel: bool,
}

/// What is kept from one finish to the next: the pattern does not change with the points.
#[derive(Default)]
pub(super) struct Kept {
    matrix: Option<(SymmetricMatrix, Analysis)>,
}

/// The system of a Newton step, ready for any number of right-hand sides.
pub(super) struct System {
    factor: Factor,
    soft: Derivatives,
    hard: Derivatives,
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

/// The penalty that a finish behind sweeps with `penalty` takes.
pub(super) fn penalty_behind(penalty: f64) -> f64 {
    STIFFER * penalty
}

impl Finish<'_> {
    /// Newton steps from `points` with the multipliers `m u` until both residuals are below their tolerance, or until
    /// no step helps. `goes_on` is asked before each step.
    pub(super) fn run(
        &mut self,
        points: &[DVec3],
        u: &[DVec3],
        tolerance: f64,
        kept: &mut Kept,
        goes_on: &mut (dyn FnMut() -> bool + Send),
    ) -> Result<Finished> {
        let mut state = self.state(points.to_vec(), u.to_vec());
        let (mut steps, mut factorisations) = (0, 0);
        let stiffest = STIFFEST * self.penalty;
        while steps < STEPS && !state.residuals.are_within(tolerance, self.size) && goes_on() {
            let Some(system) = self.system(&state, kept, &mut factorisations)? else { break };
            steps += 1;
            let Some(next) = self.step(&state, system) else { break };
            let before = std::mem::replace(&mut state, next).residuals.primal;
            let is_slow =
                state.residuals.primal > SLOW * before && state.residuals.dual < state.residuals.primal / self.size;
            if is_slow && self.penalty < stiffest {
                state = self.stiffened(state);
            }
        }
        let capped = self.capped(&state.u);
        let penalty = self.penalty;
        Ok(Finished {
            points: state.points,
            u: state.u,
            penalty,
            residuals: state.residuals,
            steps,
            factorisations,
            capped,
        })
    }

    /// The same points and multipliers under a stiffer penalty.
    fn stiffened(&mut self, state: State) -> State {
        self.penalty *= STIFFENING;
        let u = state.u.iter().map(|u| *u / STIFFENING).collect();
        self.state(state.points, u)
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
        let state = self.state(points.to_vec(), u.to_vec());
        let Some(mut system) = self.system(&state, kept, &mut 0)? else {
            let reason = "the solution is no strict minimum: it does not say how it answers";
            return Err(Error::new(Status::InvalidValue, reason));
        };
        let none = vec![DVec3::ZERO; u.len()];
        let answer = |gradient: &Vec<DVec3>| self.solve(&mut system, gradient, &none, &none, OF_AN_ANSWER).1.points;
        Ok(gradients.iter().map(answer).collect())
    }

    /// One step: a state that is nearer, or none.
    fn step(&mut self, state: &State, mut system: System) -> Option<State> {
        let (first, whole) = self.solve(&mut system, &state.gradient, &state.excess, &state.u, OF_A_STEP);
        let moved = |direction: &[DVec3], length: f64| -> Vec<DVec3> {
            state.points.iter().zip(direction).map(|(p, step)| *p + length * *step).collect()
        };
        let u = state.u.iter().zip(&whole.multipliers).map(|(u, step)| *u + *step).collect();
        let next = self.state(moved(&whole.points, 1.0), u);
        if self.merit(&next) < 0.5 * self.merit(state) {
            return Some(next);
        }
        // The slope of the augmented Lagrangian along the first solve.
        let gradient = self.lagrangian_gradient(&state.gradient, &state.excess);
        let slope: f64 = gradient.iter().zip(&first).map(|(g, step)| g.dot(*step)).sum();
        let mut length = 1.0;
        while slope < 0.0 && length > 1e-3 {
            let trial = self.state(moved(&first, length), state.u.clone());
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
        (self.merit(&next) < self.merit(state)).then_some(next)
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

    /// The system at `state`; `None` if its matrix is not positive definite, whatever is added to the diagonal.
    fn system(&mut self, state: &State, kept: &mut Kept, factorisations: &mut u32) -> Result<Option<System>> {
        // Where the state placed the constraints' points; another state may have been looked at since.
        let u = &state.u;
        let mut images = vec![DVec3::ZERO; self.soft.row_count()];
        self.soft.place(&state.points, &mut images, |_, _, _| {}, self.is_parallel);
        let mut images = vec![DVec3::ZERO; self.hard.row_count()];
        let shift = |item: &Item, _: &[DVec3], shift: &mut [DVec3]| shift.copy_from_slice(&u[item.rows()]);
        self.hard.place(&state.points, &mut images, shift, self.is_parallel);
        let soft = Derivatives::new(self.soft, self.size, |_, _, _, _| {}, self.is_parallel);
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
        let hard = Derivatives::new(self.hard, self.size, elastic, self.is_parallel);
        let n = state.points.len();
        if kept.matrix.is_none() {
            let matrix = SymmetricMatrix::with_pattern(3 * n, |report| {
                self.quadratic.each_entry(&mut |i, j, _| (0..3).for_each(|b| report(3 * i + b, 3 * j + b)));
                for local in [&*self.soft, &*self.hard] {
                    for item in &local.items {
                        let indices = &local.indices[item.points()];
                        let unknowns = || indices.iter().flat_map(|&i| (0..3).map(move |b| 3 * i + b));
                        unknowns().for_each(|i| unknowns().filter(|j| *j <= i).for_each(|j| report(i, j)));
                    }
                }
            })?;
            let analysis = Analysis::new(matrix.pattern(), &[])?;
            kept.matrix = Some((matrix, analysis));
        }
        let Some((matrix, analysis)) = &mut kept.matrix else { return Ok(None) };
        let mut factor = Factor::new(analysis, matrix.pattern())?;
        let mut shift = 0.0;
        for _ in 0..8 {
            self.assemble(matrix, &soft, &hard, shift);
            let is_positive = (0..3 * n).all(|i| matrix.diagonal(i) > 0.0);
            if is_positive {
                factor.factorise(matrix, self.is_parallel)?;
                *factorisations += 1;
                if !factor.is_singular() {
                    return Ok(Some(System { factor, soft, hard }));
                }
            }
            shift = if shift == 0.0 { 1e-3 * self.penalty } else { 10.0 * shift };
        }
        Ok(None)
    }

    fn assemble(&self, matrix: &mut SymmetricMatrix, soft: &Derivatives, hard: &Derivatives, shift: f64) {
        let n = matrix.dimension() / 3;
        let (pattern, values) = matrix.split();
        values.fill(0.0);
        self.quadratic.each_entry(&mut |i, j, value| {
            for b in 0..3 {
                let _ = pattern.add(values, 3 * i + b, 3 * j + b, value);
            }
        });
        let mut block = Vec::new();
        for (local, derivatives, factor) in [(&*self.soft, soft, None), (&*self.hard, hard, Some(self.penalty))] {
            for (i, item) in local.items.iter().enumerate() {
                let factor = factor.map_or(local.stiffness[i], |penalty| penalty * item.scale * item.scale);
                let indices = &local.indices[item.points()];
                derivatives.each_entry(local, i, &mut block, |a, b, value| {
                    let unknown = |c: usize| 3 * indices[c / 3] + (c % 3) as u32;
                    let (row, column) = (unknown(a), unknown(b));
                    // A repeated point meets itself in both triangles.
                    let times = if row == column && a != b { 2.0 } else { 1.0 };
                    let _ = pattern.add(values, row, column, times * factor * value);
                });
            }
        }
        for i in 0..3 * n as u32 {
            let _ = pattern.add(values, i, i, shift);
        }
    }

    /// Solves the linearised conditions for steps of points and multipliers: `gradient` is that of the objective,
    /// `excess` and `u` are the state's. Returns the points' step of the first solve, and the whole.
    fn solve(
        &self,
        system: &mut System,
        gradient: &[DVec3],
        excess: &[DVec3],
        u: &[DVec3],
        updates: Updates,
    ) -> (Vec<DVec3>, Steps) {
        let n = gradient.len();
        let mut steps = Steps { points: vec![DVec3::ZERO; n], multipliers: vec![DVec3::ZERO; u.len()] };
        let mut first = Vec::new();
        let mut total = excess.to_vec();
        let (mut smallest, mut enough) = (f64::INFINITY, None);
        let mut next = vec![DVec3::ZERO; u.len()];
        let mut accelerated = Krylov::new(u.len());
        for update in 1..=updates.most {
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
            system.factor.solve(&mut unknowns, self.is_parallel);
            for (step, new) in steps.points.iter_mut().zip(unknowns.chunks_exact(3)) {
                *step += DVec3::new(new[0].x, new[1].x, new[2].x);
            }
            if first.is_empty() {
                first = steps.points.clone();
            }
            let residual = self.next_multipliers(system, excess, u, &steps, &mut next);
            let enough = *enough.get_or_insert(updates.enough * residual);
            smallest = smallest.min(residual);
            // True for NaN too.
            if update == updates.most || !(residual > enough && residual < DIVERGED * smallest) {
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
        let (mut own, mut rows) = (Vec::new(), Vec::new());
        for (i, item) in self.soft.items.iter().enumerate() {
            own.clear();
            own.extend(self.soft.indices[item.points()].iter().map(|&index| step[index as usize]));
            rows.clear();
            rows.resize(item.row_count, DVec3::ZERO);
            system.soft.residual(self.soft, i, &own, &mut rows);
            add_transposed(self.soft, item, self.soft.stiffness[i], &rows, sums);
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

    /// Calls `visit` with every constraint and its linearised excess behind `steps`: `e + (A − J) dp + (I − J) du`.
    fn each_excess(&self, system: &System, excess: &[DVec3], steps: &Steps, mut visit: impl FnMut(&Item, &[DVec3])) {
        let (mut own, mut rows) = (Vec::new(), Vec::new());
        for (i, item) in self.hard.items.iter().enumerate() {
            let lift = &steps.multipliers[item.rows()];
            own.clear();
            own.extend(
                self.hard.indices[item.points()]
                    .iter()
                    .enumerate()
                    .map(|(place, &index)| steps.points[index as usize] + self.hard.lifted(item, place, lift)),
            );
            rows.clear();
            rows.resize(item.row_count, DVec3::ZERO);
            system.hard.residual(self.hard, i, &own, &mut rows);
            rows.iter_mut().zip(&excess[item.rows()]).for_each(|(row, e)| *row += *e);
            visit(item, &rows);
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
        history.reset(KRYLOV_MEMORY, row_count);
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
}

impl Residuals {
    /// True if both are within `tolerance`, which is relative to the model's `size` and to the force that belongs to
    /// it.
    pub(super) fn are_within(&self, tolerance: f64, size: f64) -> bool {
        self.primal <= tolerance * size && self.dual <= tolerance
    }
}
