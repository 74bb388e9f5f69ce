//! Constraints with points of their own, so that each can be projected at other points than the model's: shifted by
//! multipliers, or by differences for a derivative.
//!
//! The rows `A` of a constraint and its projection `P` are in the units of its type; `A⁺ = Aᵀ (A Aᵀ)⁻¹` takes rows back
//! to the least move of the points that makes them. As a projection depends on `A x` alone, `P` at any rows `y + u` is
//! that at the points `x + A⁺ u`.

use glam::DVec3;

use crate::constraints::{Batch, ConstraintId, ConstraintSet, Rows};
use crate::solver::assembly::Gather;
use crate::solver::chunks::{Chunk, cut_into_chunks};
use crate::solver::parallel::for_parts;

/// Where a constraint lies in the flat arrays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    pub(super) id: ConstraintId,
    pub(super) first_point: usize,
    pub(super) point_count: usize,
    pub(super) first_row: usize,
    pub(super) row_count: usize,
    /// Where its `A` and `A⁺` begin; `None` for centred types.
    coefficients: Option<[usize; 2]>,
    /// Rows times this are lengths in model units, or as near to that as the type allows: the largest coefficient is
    /// then 1.
    pub(super) scale: f64,
}

impl Item {
    pub(super) fn points(&self) -> std::ops::Range<usize> {
        self.first_point..self.first_point + self.point_count
    }

    pub(super) fn rows(&self) -> std::ops::Range<usize> {
        self.first_row..self.first_row + self.row_count
    }

    /// Shortens rows that are longer than `most` model units.
    pub(super) fn cut(&self, rows: &mut [DVec3], most: f64) {
        let length = self.scale * rows.iter().map(|row| row.length_squared()).sum::<f64>().sqrt();
        if length > most {
            rows.iter_mut().for_each(|row| *row *= most / length);
        }
    }
}

/// The hard constraints of a model, or the soft ones.
pub(super) struct Local {
    /// Numbered through: every constraint has points of its own.
    set: ConstraintSet,
    pub(super) items: Vec<Item>,
    /// The model's points behind the constraints' own.
    pub(super) indices: Vec<u32>,
    coefficients: Vec<f64>,
    chunks: Vec<Chunk>,
    /// Where rows, points and items of each chunk begin.
    pub(super) row_bounds: Vec<usize>,
    point_bounds: Vec<usize>,
    pub(super) item_bounds: Vec<usize>,
    /// `Aᵀ` times the stiffness, by the model's points.
    pub(super) gather: Gather,
    /// By item.
    pub(super) stiffness: Vec<f64>,
    /// The constraints' own points.
    pub(super) points: Vec<DVec3>,
    /// Rows as last projected, the means of centred ones taken off.
    pub(super) targets: Vec<DVec3>,
    nothing: Vec<()>,
}

impl Local {
    /// The constraints of `set`. `stiffness` says it of one from its weight, measure and scale.
    pub(super) fn new(set: &ConstraintSet, point_count: usize, stiffness_of: impl Fn(f64, f64, f64) -> f64) -> Self {
        let mut own = set.clone();
        let own_count = own.renumber();
        let (chunks, row_bounds) = cut_into_chunks(&own);
        let mut local = Self {
            items: Vec::new(),
            indices: Vec::with_capacity(own_count),
            coefficients: Vec::new(),
            point_bounds: vec![0],
            item_bounds: vec![0],
            gather: Gather::default(),
            stiffness: Vec::new(),
            points: vec![DVec3::ZERO; own_count],
            targets: vec![DVec3::ZERO; row_bounds[chunks.len()]],
            nothing: vec![(); chunks.len()],
            set: own,
            chunks,
            row_bounds,
        };
        let mut ids = set.ids_by_slot();
        let mut by_batch = Vec::new();
        let mut first_row = 0;
        for (batch, weights) in set.batches() {
            let mut of_batch = Vec::with_capacity(batch.len());
            for slot in 0..batch.len() {
                let item = local.push(ids.next().unwrap_or_default(), batch, slot, first_row);
                first_row += item.row_count;
                of_batch.push(stiffness_of(weights[slot], batch.measure(slot), item.scale));
            }
            local.stiffness.extend_from_slice(&of_batch);
            by_batch.push(of_batch);
        }
        let mut item = 0;
        for &bound in &local.row_bounds[1..] {
            while item < local.items.len() && local.items[item].first_row < bound {
                item += 1;
            }
            local.item_bounds.push(item);
            local.point_bounds.push(local.items.get(item).map_or(own_count, |item| item.first_point));
        }
        local.gather = Gather::new(set, &by_batch, &local.chunks, &local.row_bounds, point_count);
        local
    }

    fn push(&mut self, id: ConstraintId, batch: &dyn Batch, slot: usize, first_row: usize) -> Item {
        let (indices, rows) = (batch.indices(slot), batch.rows(slot));
        let k = indices.len();
        let (row_count, coefficients, scale) = match batch.info().rows {
            Rows::Centred => (k, None, 1.0),
            kind => {
                let differences = if kind == Rows::Pairs { pair_rows(k) } else { Vec::new() };
                let rows = if kind == Rows::Pairs { differences.as_slice() } else { rows };
                let row_count = rows.len() / k;
                let start = self.coefficients.len();
                self.coefficients.extend_from_slice(rows);
                self.coefficients.extend(pseudo_inverse(rows, row_count, k));
                let largest = rows.iter().fold(0.0_f64, |largest, a| largest.max(a.abs()));
                let scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
                (row_count, Some([start, start + rows.len()]), scale)
            }
        };
        let first_point = self.indices.len();
        let item = Item { id, first_point, point_count: k, first_row, row_count, coefficients, scale };
        self.indices.extend_from_slice(indices);
        self.items.push(item);
        item
    }

    /// The constraints, with points of their own.
    #[cfg(feature = "gpu")]
    pub(super) fn own_set(&self) -> &ConstraintSet {
        &self.set
    }

    /// Takes over scalars and rest states of `set`, which has the same constraints with the same rows.
    pub(super) fn take_scalars(&mut self, set: &ConstraintSet) {
        self.set = set.clone();
        self.set.renumber();
    }

    pub(super) fn row_count(&self) -> usize {
        self.targets.len()
    }

    /// The coefficients `A` of a constraint that is not centred, and those of `A⁺` (a row per point).
    pub(super) fn matrices(&self, item: &Item) -> Option<(&[f64], &[f64])> {
        let [rows, inverse] = item.coefficients?;
        let size = item.row_count * item.point_count;
        Some((&self.coefficients[rows..rows + size], &self.coefficients[inverse..inverse + size]))
    }

    /// `A x` of one constraint, `x` being the model's points or vectors at them.
    pub(super) fn rows_of(&self, item: &Item, x: &[DVec3], rows: &mut [DVec3]) {
        let indices = &self.indices[item.points()];
        let at = |i: &u32| x[*i as usize];
        match self.matrices(item) {
            None => {
                rows.iter_mut().zip(indices).for_each(|(row, i)| *row = at(i));
                let first = rows[0];
                let mean = first + rows.iter().map(|row| *row - first).sum::<DVec3>() / indices.len() as f64;
                rows.iter_mut().for_each(|row| *row -= mean);
            }
            Some((a, _)) => {
                for (row, a) in rows.iter_mut().zip(a.chunks_exact(indices.len())) {
                    *row = a.iter().zip(indices).map(|(a, i)| *a * at(i)).sum();
                }
            }
        }
    }

    /// `A⁺ u` of one constraint at its point `place`.
    pub(super) fn lifted(&self, item: &Item, place: usize, u: &[DVec3]) -> DVec3 {
        match self.matrices(item) {
            None => u[place],
            Some((_, inverse)) => {
                let row = &inverse[place * item.row_count..][..item.row_count];
                row.iter().zip(u).map(|(a, u)| *a * *u).sum()
            }
        }
    }

    /// `A⁺` of one constraint at its point `place` and `row`.
    pub(super) fn lifted_row(&self, item: &Item, place: usize, row: usize) -> f64 {
        match self.matrices(item) {
            None => f64::from(u8::from(place == row)),
            Some((_, inverse)) => inverse[place * item.row_count + row],
        }
    }

    /// `A A⁺` of one constraint: 1 on the diagonal and 0 beside it, but for rows that depend on each other.
    pub(super) fn image_of_row(&self, item: &Item, row: usize, lifted: usize) -> f64 {
        match self.matrices(item) {
            None => f64::from(u8::from(row == lifted)) - 1.0 / item.row_count as f64,
            Some((a, _)) => {
                let a = &a[row * item.point_count..][..item.point_count];
                a.iter().enumerate().map(|(place, a)| a * self.lifted_row(item, place, lifted)).sum()
            }
        }
    }

    /// Moves the constraints' own points to `x + A⁺ u`, with `u` written for each constraint by `shift(item, rows A x,
    /// u)`, and keeps `A x` in `rows`.
    pub(super) fn place(
        &mut self,
        x: &[DVec3],
        rows: &mut [DVec3],
        shift: impl Fn(&Item, &[DVec3], &mut [DVec3]) + Sync,
        is_parallel: bool,
    ) {
        let mut points = std::mem::take(&mut self.points);
        let mut nothing = std::mem::take(&mut self.nothing);
        let this = &*self;
        for_parts(&this.row_bounds, rows, &mut nothing, is_parallel, &|chunk, rows: &mut [DVec3], (): &mut ()| {
            for item in &this.items[this.item_bounds[chunk]..this.item_bounds[chunk + 1]] {
                this.rows_of(item, x, &mut rows[item.first_row - this.row_bounds[chunk]..][..item.row_count]);
            }
        });
        let rows = &*rows;
        let work = |chunk: usize, points: &mut [DVec3], (): &mut ()| {
            let mut shifts = Vec::new();
            for item in &this.items[this.item_bounds[chunk]..this.item_bounds[chunk + 1]] {
                shifts.clear();
                shifts.resize(item.row_count, DVec3::ZERO);
                shift(item, &rows[item.rows()], &mut shifts);
                let own = &mut points[item.first_point - this.point_bounds[chunk]..][..item.point_count];
                let own = own.iter_mut().zip(&this.indices[item.points()]);
                if item.coefficients.is_none() {
                    own.zip(&shifts).for_each(|((point, &index), shift)| *point = x[index as usize] + *shift);
                } else {
                    let lifted = |place| this.lifted(item, place, &shifts);
                    (0..).zip(own).for_each(|(place, (point, &i))| *point = x[i as usize] + lifted(place));
                }
            }
        };
        for_parts(&this.point_bounds, &mut points, &mut nothing, is_parallel, &work);
        (self.points, self.nothing) = (points, nothing);
    }

    /// Projects the constraints' own points: the targets are then what is nearest to their rows.
    pub(super) fn project(&mut self, is_parallel: bool) {
        let (set, chunks, points) = (&self.set, &self.chunks, &self.points);
        let work = |chunk: usize, targets: &mut [DVec3], (): &mut ()| {
            let chunk = &chunks[chunk];
            chunk.project(set, points, targets);
            let mut rest = targets;
            for (index, slots) in chunk.batches() {
                let batch = set.batch(index);
                let (own, later) = rest.split_at_mut(chunk.target_count(batch));
                batch.centre_targets(slots, own);
                rest = later;
            }
        };
        for_parts(&self.row_bounds, &mut self.targets, &mut self.nothing, is_parallel, &work);
    }
}

/// The rows of [`Rows::Pairs`]: the second point of each pair less the first.
fn pair_rows(k: usize) -> Vec<f64> {
    let mut rows = vec![0.0; k / 2 * k];
    for (pair, row) in rows.chunks_exact_mut(k).enumerate() {
        (row[2 * pair], row[2 * pair + 1]) = (-1.0, 1.0);
    }
    rows
}

/// `Aᵀ (A Aᵀ)⁻¹` of `row_count` rows of `k` coefficients, one row per point. Rows that depend on others get as little
/// as round-off allows.
fn pseudo_inverse(rows: &[f64], row_count: usize, k: usize) -> Vec<f64> {
    let row = |r: usize| &rows[r * k..(r + 1) * k];
    let product = |r: usize, s: usize| row(r).iter().zip(row(s)).map(|(a, b)| a * b).sum::<f64>();
    // Gauss-Jordan on [A Aᵀ | A]; A Aᵀ is small, symmetric and positive definite up to dependent rows.
    let mut square: Vec<f64> = (0..row_count * row_count).map(|i| product(i / row_count, i % row_count)).collect();
    let mut right = rows.to_vec();
    let largest = (0..row_count).map(|r| square[r * row_count + r]).fold(0.0, f64::max);
    for i in 0..row_count {
        let pivot = square[i * row_count + i];
        // A row that depends on those before is left out.
        let factor = if pivot > 1e-12 * largest { 1.0 / pivot } else { 0.0 };
        square[i * row_count..(i + 1) * row_count].iter_mut().for_each(|value| *value *= factor);
        right[i * k..(i + 1) * k].iter_mut().for_each(|value| *value *= factor);
        for r in (0..row_count).filter(|&r| r != i) {
            let multiple = square[r * row_count + i];
            for c in 0..row_count {
                square[r * row_count + c] -= multiple * square[i * row_count + c];
            }
            for c in 0..k {
                right[r * k + c] -= multiple * right[i * k + c];
            }
        }
    }
    (0..k * row_count).map(|i| right[(i % row_count) * k + i / row_count]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pseudo_inverse_undoes_the_rows() {
        let rows = [-1.0, 1.0, 0.0, -1.0, 0.0, 2.0];
        let inverse = pseudo_inverse(&rows, 2, 3);
        for r in 0..2 {
            for s in 0..2 {
                let found: f64 = (0..3).map(|j| rows[r * 3 + j] * inverse[j * 2 + s]).sum();
                assert!((found - f64::from(u8::from(r == s))).abs() < 1e-14);
            }
        }
    }
}
