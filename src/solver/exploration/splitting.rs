//! Sweeps of the splitting method: every hard constraint has rows `y = A p` of its own, held to those of the points by
//! a penalty.
//!
//! One sweep of the Douglas-Rachford form of ADMM, from the rows `s`, with over-relaxation `α`:
//!
//! ```text
//! p = argmin F(p) + μ/2 Σ ‖A p − s‖²      one solve with the prefactored matrix; soft constraints at their projections
//! w = 2 A p − s,   π = P(w)                every constraint for itself, in parallel
//! v = w + min(1, (ρ/μ)/‖w − π‖) (π − w)    the elastic set: a multiplier never exceeds its cap ρ
//! s ← s + α (v − A p)                      or an Anderson step from the last sweeps, where the residual falls
//! ```
//!
//! The multiplier of a constraint is `λ = μ (A p − s)`. Lengths of rows are in model units, see
//! [`super::local::Item::scale`]. Sources: Deng et al. 2015, section 3; Ouyang et al. 2020, "Anderson acceleration for
//! nonconvex ADMM based on Douglas-Rachford splitting", for the choice of `s` as the variable.

use glam::DVec3;

use super::local::{Item, Local};
use super::quadratic::Quadratic;
use crate::constraints::ConstraintSet;
use crate::error::Result;
use crate::linalg::cholesky::{Analysis, Factor};
use crate::linalg::symmetric::SymmetricMatrix;
use crate::solver::anderson::Anderson;
use crate::solver::assembly::{each_entry, even_bounds, long_constraint_count};
use crate::solver::history::{Combination, History};
use crate::solver::parallel::for_parts;

/// Over-relaxation: fewer sweeps than 1 on every problem measured, and never refused.
pub(super) const RELAXATION: f64 = 1.6;

/// Sweeps that Anderson acceleration remembers.
const MEMORY: usize = 6;

/// The longest accelerated step over the plain one. Longer ones lead out of the model, along what no constraint holds.
const FARTHEST: f64 = 100.0;

/// The penalty over that at which it and the objective have the same trace. Sweeps to a tenth of the distance on the
/// surfaces of Fig. 12 with 21 and 61 points a side: 28 and 14 at 4, 17 and 26 at 8, 16 and 27 at 8.25, 16 and 30 at 9,
/// 19 and 32 at 12. Up to 8.75 the Newton steps on the former are exact; up to 8.25 those on costa2k are four, then five.
const SHARE: f64 = 8.25;

/// A constraint counts as active from this part of the model's size on.
const ACTIVE: f64 = 1e-12;

/// What a sweep found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sweep {
    /// `(Σ ‖v − A p‖²)^½`: how far the sweep is from a fixed point, in model units.
    pub(super) residual: f64,
    /// The largest distance of a constraint's rows from where its set wants them, in model units.
    pub(super) primal: f64,
    /// The largest move of a point, in model units.
    pub(super) largest_move: f64,
    /// Constraints that became active or inactive.
    pub(super) switched: usize,
    /// Constraints whose multiplier is at its cap.
    pub(super) capped: usize,
}

/// What a chunk of constraints adds to [`Sweep`].
#[derive(Clone, Default)]
struct Share {
    squares: f64,
    primal: f64,
    switched: usize,
    capped: usize,
    is_active: Vec<bool>,
}

/// Points, rows and factor of the sweeps.
pub(super) struct Splitting {
    pub(super) quadratic: Quadratic,
    pub(super) soft: Local,
    pub(super) hard: Local,
    /// The largest multiplier of each hard constraint, in model units times weight.
    pub(super) caps: Vec<f64>,
    pub(super) penalty: f64,
    pub(super) points: Vec<DVec3>,
    /// `s`, and `A p` as of the last sweep.
    pub(super) rows: Vec<DVec3>,
    pub(super) images: Vec<DVec3>,
    next: Vec<DVec3>,
    soft_images: Vec<DVec3>,
    shares: Vec<Share>,
    size: f64,
    matrix: SymmetricMatrix,
    factor: Factor,
    /// Everything of the right-hand side that projections do not change; one entry per unknown.
    constant: Vec<DVec3>,
    right_hand_side: Vec<DVec3>,
    sums: Vec<DVec3>,
    /// Where the chunks of points begin, and their number.
    point_bounds: Vec<usize>,
    accelerated: Accelerated,
    pub(super) factorisation_count: u32,
}

/// The state of Anderson acceleration.
#[derive(Default)]
struct Accelerated {
    history: History,
    anderson: Anderson,
    combination: Combination,
    /// The plain step from the last sweep that was accepted, and the residual there.
    plain: Vec<DVec3>,
    residual: f64,
    is_trial: bool,
}

impl Splitting {
    /// A splitting of the constraints of `set` over `points`, with `penalty`, or with that which the traces of the
    /// matrix suggest.
    pub(super) fn new(
        quadratic: Quadratic,
        set: &ConstraintSet,
        points: &[DVec3],
        size: f64,
        penalty: Option<f64>,
        is_parallel: bool,
    ) -> Result<Self> {
        let n = points.len();
        let (soft_set, hard_set) = (set.part(false), set.part(true));
        let soft = Local::new(&soft_set, n, |weight, measure, _| weight * measure);
        let hard = Local::new(&hard_set, n, |_, _, scale| scale * scale);
        let unknown_count = (n + long_constraint_count(&soft_set) + long_constraint_count(&hard_set)).max(1);
        let parts = Parts { quadratic: &quadratic, soft: &soft_set, hard: &hard_set, point_count: n };
        let penalty = penalty.unwrap_or_else(|| parts.suggested_penalty(&soft, &hard));
        let mut matrix = SymmetricMatrix::with_pattern(unknown_count, |report| {
            parts.each_entry(&soft, &hard, 1.0, &mut |i, j, _| report(i, j));
        })?;
        let analysis = Analysis::new(matrix.pattern(), points)?;
        let mut factor = Factor::new(&analysis, matrix.pattern())?;
        parts.fill(&mut matrix, &soft, &hard, penalty);
        factor.factorise(&matrix, is_parallel)?;
        let (hard_rows, soft_rows) = (hard.row_count(), soft.row_count());
        let mut splitting = Self {
            caps: vec![f64::INFINITY; hard.items.len()],
            penalty,
            points: points.to_vec(),
            rows: vec![DVec3::ZERO; hard_rows],
            images: vec![DVec3::ZERO; hard_rows],
            next: vec![DVec3::ZERO; hard_rows],
            soft_images: vec![DVec3::ZERO; soft_rows],
            shares: hard.item_bounds.windows(2).map(|ends| Share::of(ends[1] - ends[0])).collect(),
            size,
            matrix,
            factor,
            constant: vec![DVec3::ZERO; unknown_count],
            right_hand_side: vec![DVec3::ZERO; unknown_count],
            sums: vec![DVec3::ZERO; n],
            point_bounds: even_bounds(n),
            accelerated: Accelerated::default(),
            factorisation_count: 1,
            quadratic,
            soft,
            hard,
        };
        splitting.quadratic_changed();
        splitting.restart();
        Ok(splitting)
    }

    /// The matrix of the global step.
    #[cfg(feature = "gpu")]
    pub(super) fn matrix(&self) -> &SymmetricMatrix {
        &self.matrix
    }

    /// To be called when targets or forces changed.
    pub(super) fn quadratic_changed(&mut self) {
        let n = self.points.len();
        self.quadratic.right_hand_side(&mut self.constant[..n]);
    }

    /// Rows where the points as they are have them: multipliers zero.
    pub(super) fn restart(&mut self) {
        self.hard.place(&self.points, &mut self.images, |_, _, _| {}, false);
        self.rows.copy_from_slice(&self.images);
        self.forget();
    }

    /// Rows for multipliers `μ u` at the current points, `u` in rows.
    pub(super) fn resume(&mut self, multipliers: &[DVec3], per: f64) {
        let (hard, points) = (&mut self.hard, &self.points);
        hard.place(points, &mut self.images, |_, _, _| {}, false);
        for ((row, image), u) in self.rows.iter_mut().zip(&self.images).zip(multipliers) {
            *row = *image - per / self.penalty * *u;
        }
        self.forget();
    }

    /// Forgets what acceleration remembers: what it is about has changed.
    pub(super) fn forget(&mut self) {
        self.accelerated.reset(self.rows.len());
    }

    /// Another penalty; multipliers stay. Factorises again.
    pub(super) fn set_penalty(&mut self, penalty: f64, set: &ConstraintSet, is_parallel: bool) -> Result<()> {
        let ratio = self.penalty / penalty;
        for (row, image) in self.rows.iter_mut().zip(&self.images) {
            *row = *image + ratio * (*row - *image);
        }
        self.penalty = penalty;
        self.refactorise(set, is_parallel)?;
        self.forget();
        Ok(())
    }

    fn refactorise(&mut self, set: &ConstraintSet, is_parallel: bool) -> Result<()> {
        let (soft, hard) = (set.part(false), set.part(true));
        let parts = Parts { quadratic: &self.quadratic, soft: &soft, hard: &hard, point_count: self.points.len() };
        parts.fill(&mut self.matrix, &self.soft, &self.hard, self.penalty);
        self.factor.factorise(&self.matrix, is_parallel)?;
        self.factorisation_count += 1;
        Ok(())
    }

    /// One sweep from the rows in hand, accelerated unless that is off.
    pub(super) fn sweep(&mut self, is_parallel: bool) -> Sweep {
        let largest_move = self.solve(is_parallel);
        let mut sweep = self.project(is_parallel);
        sweep.largest_move = largest_move;
        self.accelerated.advance(&mut self.rows, &mut self.next, sweep.residual, is_parallel);
        sweep
    }

    /// One sweep without acceleration.
    #[cfg(all(test, feature = "gpu"))]
    pub(super) fn plain_sweep(&mut self) {
        self.solve(false);
        self.project(false);
        self.rows.copy_from_slice(&self.next);
    }

    /// The points for the rows in hand; returns the largest move.
    fn solve(&mut self, is_parallel: bool) -> f64 {
        let n = self.points.len();
        if !self.soft.items.is_empty() {
            self.soft.place(&self.points, &mut self.soft_images, |_, _, _| {}, is_parallel);
            self.soft.project(is_parallel);
        }
        self.right_hand_side.copy_from_slice(&self.constant);
        let parts = [(&self.soft.targets, &self.soft, 1.0), (&self.rows, &self.hard, self.penalty)];
        for (targets, local, factor) in parts.into_iter().filter(|(_, local, _)| !local.items.is_empty()) {
            let bounds = &self.point_bounds;
            let sum = |chunk: usize, sums: &mut [DVec3], (): &mut ()| local.gather.sum(bounds[chunk], targets, sums);
            for_parts(bounds, &mut self.sums, &mut vec![(); bounds.len() - 1], is_parallel, &sum);
            let sums = self.right_hand_side[..n].iter_mut().zip(&self.sums);
            sums.for_each(|(total, sum)| *total += factor * *sum);
        }
        self.factor.solve(&mut self.right_hand_side, is_parallel);
        let mut largest = 0.0_f64;
        for (point, new) in self.points.iter_mut().zip(&self.right_hand_side) {
            largest = largest.max(point.distance_squared(*new));
            *point = *new;
        }
        largest.sqrt()
    }

    /// Projects `2 A p − s`; writes the plain step's rows.
    fn project(&mut self, is_parallel: bool) -> Sweep {
        let (rows, caps, penalty) = (&self.rows, &self.caps, self.penalty);
        let reflect = |item: &Item, image: &[DVec3], shift: &mut [DVec3]| {
            for ((shift, image), row) in shift.iter_mut().zip(image).zip(&rows[item.rows()]) {
                *shift = *image - *row;
            }
        };
        self.hard.place(&self.points, &mut self.images, reflect, is_parallel);
        self.hard.project(is_parallel);
        let (hard, images, active) = (&self.hard, &self.images, ACTIVE * self.size);
        let work = |chunk: usize, next: &mut [DVec3], share: &mut Share| {
            (share.squares, share.primal, share.switched, share.capped) = (0.0, 0.0, 0, 0);
            let items = &hard.items[hard.item_bounds[chunk]..hard.item_bounds[chunk + 1]];
            for ((i, item), was_active) in (hard.item_bounds[chunk]..).zip(items).zip(&mut share.is_active) {
                let (images, rows, targets) = (&images[item.rows()], &rows[item.rows()], &hard.targets[item.rows()]);
                let reflected = |image: &DVec3, row: &DVec3| 2.0 * *image - *row;
                let both = images.iter().zip(rows);
                let squared: f64 = both.zip(targets).map(|((a, s), t)| reflected(a, s).distance_squared(*t)).sum();
                let distance = item.scale * squared.sqrt();
                let reach = caps[i] / penalty;
                let part = if distance > reach { reach / distance } else { 1.0 };
                share.capped += usize::from(part < 1.0);
                let is_active = distance > active;
                share.switched += usize::from(is_active != *was_active);
                *was_active = is_active;
                let mut gap = 0.0;
                let next = &mut next[item.first_row - hard.row_bounds[chunk]..][..item.row_count];
                for (((next, image), row), target) in next.iter_mut().zip(images).zip(rows).zip(targets) {
                    let w = reflected(image, row);
                    let step = w + part * (*target - w) - *image;
                    gap += step.length_squared();
                    *next = *row + RELAXATION * step;
                }
                let gap = item.scale * item.scale * gap;
                share.squares += gap;
                share.primal = share.primal.max(gap);
            }
        };
        for_parts(&hard.row_bounds, &mut self.next, &mut self.shares, is_parallel, &work);
        let mut sweep = Sweep::default();
        for share in &self.shares {
            sweep.residual += share.squares;
            sweep.primal = sweep.primal.max(share.primal);
            sweep.switched += share.switched;
            sweep.capped += share.capped;
        }
        (sweep.residual, sweep.primal) = (sweep.residual.sqrt(), sweep.primal.sqrt());
        sweep
    }

    /// `λ/μ` of all hard constraints, in rows, none beyond its cap.
    pub(super) fn multipliers(&self) -> Vec<DVec3> {
        let mut all: Vec<DVec3> = self.images.iter().zip(&self.rows).map(|(image, row)| *image - *row).collect();
        for (item, cap) in self.hard.items.iter().zip(&self.caps) {
            item.cut(&mut all[item.rows()], cap / self.penalty);
        }
        all
    }
}

impl Share {
    fn of(item_count: usize) -> Self {
        Self { is_active: vec![false; item_count], ..Self::default() }
    }
}

impl Accelerated {
    fn reset(&mut self, row_count: usize) {
        self.history.reset(MEMORY, row_count);
        self.anderson.reset(MEMORY);
        self.combination.reset(MEMORY);
        self.plain.resize(row_count, DVec3::ZERO);
        (self.residual, self.is_trial) = (f64::INFINITY, false);
    }

    /// Replaces `rows`, whose plain step leads to `next` and leaves `residual`: by an accelerated step, or by the plain
    /// one. A trial that raised the residual is taken back to the plain step from where it began. `next` is of no meaning
    /// afterwards.
    fn advance(&mut self, rows: &mut [DVec3], next: &mut Vec<DVec3>, residual: f64, is_parallel: bool) {
        // False for NaN.
        if self.is_trial && !(residual < self.residual) {
            rows.copy_from_slice(&self.plain);
            self.reset(rows.len());
            return;
        }
        self.residual = residual;
        self.history.push(rows, next, None, is_parallel);
        std::mem::swap(&mut self.plain, next);
        self.is_trial = self.history.products().len() > 0;
        if !self.is_trial {
            rows.copy_from_slice(&self.plain);
            return;
        }
        self.anderson.combine(self.history.products(), &mut self.combination);
        // What was the plain step before is no longer needed.
        let direction = next;
        self.history.combine(&self.combination, direction, is_parallel);
        // False for NaN.
        if !(squared_length(direction) <= FARTHEST * FARTHEST * self.history.products().plain_squared()) {
            rows.copy_from_slice(&self.plain);
            return;
        }
        rows.iter_mut().zip(&*direction).for_each(|(row, step)| *row += *step);
    }
}

/// `Σ ‖v‖²`, in four sums that do not wait for each other.
fn squared_length(vectors: &[DVec3]) -> f64 {
    let mut sums = [0.0; 4];
    for four in vectors.chunks(4) {
        sums.iter_mut().zip(four).for_each(|(sum, vector)| *sum += vector.length_squared());
    }
    sums.iter().sum()
}

/// What the matrix is made of.
struct Parts<'a> {
    quadratic: &'a Quadratic,
    soft: &'a ConstraintSet,
    hard: &'a ConstraintSet,
    point_count: usize,
}

impl Parts<'_> {
    fn each_entry(&self, soft: &Local, hard: &Local, penalty: f64, visit: &mut dyn FnMut(u32, u32, f64)) {
        self.quadratic.each_entry(visit);
        let first_mean = self.point_count;
        let later_mean = first_mean + long_constraint_count(self.soft);
        for (set, local, factor, mean) in [(self.soft, soft, 1.0, first_mean), (self.hard, hard, penalty, later_mean)] {
            let mut stiffness = Vec::new();
            let mut rest = local.stiffness.as_slice();
            for (batch, _) in set.batches() {
                let (own, later) = rest.split_at(batch.len());
                stiffness.push(own.to_vec());
                rest = later;
            }
            each_entry(set, Some(&stiffness), mean, |i, j, value| visit(i, j, factor * value));
        }
    }

    fn fill(&self, matrix: &mut SymmetricMatrix, soft: &Local, hard: &Local, penalty: f64) {
        let (pattern, values) = matrix.split();
        values.fill(0.0);
        self.each_entry(soft, hard, penalty, &mut |i, j, value| {
            let _ = pattern.add(values, i, j, value);
        });
    }

    /// Where the penalty's share of the diagonal is [`SHARE`] times that of the objective.
    fn suggested_penalty(&self, soft: &Local, hard: &Local) -> f64 {
        let (mut objective, _) = self.quadratic.free_trace();
        let trace = |local: &Local| {
            let of_item = |(item, s): (&Item, &f64)| match local.matrices(item) {
                None => s * (item.point_count as f64 - 1.0),
                Some((rows, _)) => s * rows.iter().map(|a| a * a).sum::<f64>(),
            };
            local.items.iter().zip(&local.stiffness).map(of_item).sum::<f64>()
        };
        objective += trace(soft);
        let hard = trace(hard);
        if hard > 0.0 { SHARE * objective / hard } else { 1.0 }
    }
}
