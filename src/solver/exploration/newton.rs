//! The linear problem of a Newton step: its matrix, which is assembled into places found once, and its solution by the
//! method of multipliers.
//!
//! ```text
//! ∇F + ∇²F dp + m Aᵀ (u + du) = 0,        u + du = e + M (A dp + du)
//! ```
//!
//! `e = w − P(w)` is the excess in hand and `M = I − J`. One update of the multipliers takes one solve with the factor of
//! `∇²F + m Aᵀ M A`.

use glam::DVec3;

use super::derivatives::{Derivatives, Differences, add_transposed};
use super::finish::{Finish, State};
use super::local::{Item, Local};
use crate::error::{Error, Result, Status};
use crate::linalg::cholesky::{Analysis, Factor};
use crate::linalg::symmetric::SymmetricMatrix;
use crate::solver::anderson::Anderson;
use crate::solver::history::{Combination, History};

/// Multiplier updates of one linear problem at most, and to what part they are to lower its residual: for a step, for one
/// with an old factor, and for a derivative that is an answer.
const UPDATES: u32 = 60;
pub(super) const ENOUGH_STEP: f64 = 1e-2;
pub(super) const ENOUGH_ANSWER: f64 = 1e-8;
pub(super) const ENOUGH_CHORD: f64 = 0.1;

/// Updates that their acceleration remembers, and the growth of what is left at which they are given up.
const KRYLOV_MEMORY: usize = 12;
const DIVERGED: f64 = 10.0;

/// What is kept from one finish to the next, as the pattern does not change with the points.
#[derive(Default)]
pub(super) struct Kept {
    prepared: Option<Prepared>,
}

/// The matrix in its pattern, with its factor and the places of what is added to it.
pub(super) struct Prepared {
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
pub(super) struct System {
    soft: Derivatives,
    hard: Derivatives,
    pub(super) is_exact: bool,
}

impl Finish<'_> {
    /// Pattern, factor and places, made once.
    pub(super) fn prepare<'k>(&self, kept: &'k mut Kept) -> Result<&'k mut Prepared> {
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
    pub(super) fn system(
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
    pub(super) fn solve(
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
    direction: Vec<DVec3>,
}

impl Krylov {
    fn new(row_count: usize) -> Self {
        let (mut history, mut anderson, mut combination) =
            (History::default(), Anderson::default(), Combination::default());
        history.reset(KRYLOV_MEMORY, row_count);
        anderson.reset(KRYLOV_MEMORY);
        combination.reset(KRYLOV_MEMORY);
        Self { history, anderson, combination, direction: vec![DVec3::ZERO; row_count] }
    }

    /// Replaces `multipliers`, whose plain update is `next`.
    fn advance(&mut self, multipliers: &mut [DVec3], next: &[DVec3], is_parallel: bool) {
        self.history.push(multipliers, next, None, is_parallel);
        if self.history.products().len() == 0 {
            multipliers.copy_from_slice(next);
            return;
        }
        self.anderson.combine(self.history.products(), &mut self.combination);
        self.history.combine(&self.combination, &mut self.direction, is_parallel);
        multipliers.iter_mut().zip(&self.direction).for_each(|(multiplier, step)| *multiplier += *step);
    }
}

/// Steps of points and multipliers.
pub(super) struct Steps {
    pub(super) points: Vec<DVec3>,
    pub(super) multipliers: Vec<DVec3>,
    /// True if what was left of the linearised constraints fell as far as asked for.
    pub(super) is_solved: bool,
}
