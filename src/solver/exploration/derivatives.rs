//! Derivatives of projections by differences, and the second derivatives of the augmented Lagrangian that they
//! make.
//!
//! The derivative `J` of the projection onto a smooth set at the rows `w = z + ν`, `z` in the set and `ν` normal to it
//! there, is 0 along the normals and `(I − S_ν)⁻¹` along the tangents, `S_ν` being the curvature of the set in the
//! direction `ν`. So `M = I − J` holds normals and curvature: all that Newton's method needs of a constraint, and the
//! projection is all that a type has to know. `M` is symmetric, as a projection is the gradient of a function. Where a
//! set curves away from `ν` it has negative eigenvalues: without those, it is that of the nearest convex problem.

use glam::DVec3;

use super::local::{Item, Local};
use crate::linalg::positive_part::PositivePart;
use crate::solver::parallel::for_parts;

/// How derivatives are taken: by differences from the point in hand to one side, away from the set, so that they stay
/// on one side of the bound of a set of inequalities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Differences {
    /// To 1e-7 or so: enough for a step.
    Simple,
    /// To 1e-10 or so, at twice the projections: for an answer.
    Extrapolated,
}

impl Differences {
    /// The step relative to a constraint's extent: the square and the cube root of the precision, nearly.
    fn step(self) -> f64 {
        match self {
            Self::Simple => 1e-7,
            Self::Extrapolated => 1e-5,
        }
    }

    /// At which multiples of the step, and the weights of the differences there.
    fn multiples(self) -> &'static [(f64, f64)] {
        match self {
            Self::Simple => &[(1.0, 1.0)],
            Self::Extrapolated => &[(1.0, 2.0), (2.0, -0.5)],
        }
    }
}

/// Extent of a constraint of one point, relative to the model.
const SINGLE: f64 = 1e-2;

/// `M = I − ∂P/∂w` of every constraint: a square matrix of 3 rows per row of the constraint.
#[derive(Clone)]
pub(super) struct Derivatives {
    values: Vec<f64>,
    starts: Vec<usize>,
    /// Where the chunks of constraints begin among the values.
    bounds: Vec<usize>,
}

impl Derivatives {
    /// Those at the points where `local` last was placed. `elastic` takes targets to those of the elastic set, see
    /// [`super::splitting`]; it is given a constraint, its rows and its targets. `size` is the model's, in its units.
    pub(super) fn new(
        local: &mut Local,
        size: f64,
        differences: Differences,
        elastic: impl Fn(usize, &Item, &[DVec3], &mut [DVec3]) + Sync,
        is_parallel: bool,
    ) -> Self {
        let mut starts = vec![0];
        for item in &local.items {
            starts.push(starts[starts.len() - 1] + 9 * item.row_count * item.row_count);
        }
        let bounds: Vec<usize> = local.item_bounds.iter().map(|&item| starts[item]).collect();
        let mut values = vec![0.0; starts[starts.len() - 1]];
        let center = local.points.clone();
        local.project(is_parallel);
        let targets = local.targets.clone();
        // Rows and targets in hand, the targets those of the elastic set.
        let (mut rows, mut base) = (vec![DVec3::ZERO; targets.len()], targets.clone());
        for (i, item) in local.items.iter().enumerate() {
            apply_rows(local, item, &center[item.points()], &mut rows[item.rows()]);
            elastic(i, item, &rows[item.rows()], &mut base[item.rows()]);
        }
        let step = |item: &Item| differences.step() * extent(&center[item.points()], size) / item.scale;
        let steps: Vec<f64> = local.items.iter().map(step).collect();
        let outward = |i: usize, item: &Item, row: usize, axis: usize| {
            let row = item.first_row + row;
            if rows[row][axis] < targets[row][axis] { -steps[i] } else { steps[i] }
        };
        let most = local.items.iter().map(|item| item.row_count).max().unwrap_or(0);
        let mut nothing = vec![(); bounds.len() - 1];
        for (column, &(multiple, weight)) in
            (0..3 * most).flat_map(|column| differences.multiples().iter().map(move |multiple| (column, multiple)))
        {
            let (row, axis) = (column / 3, column % 3);
            for (i, item) in local.items.iter().enumerate().filter(|(_, item)| row < item.row_count) {
                let mut shift = DVec3::ZERO;
                shift[axis] = multiple * outward(i, item, row, axis);
                for place in 0..item.point_count {
                    local.points[item.first_point + place] =
                        center[item.first_point + place] + local.lifted_row(item, place, row) * shift;
                }
            }
            local.project(is_parallel);
            local.points.copy_from_slice(&center);
            let local = &*local;
            let work = |chunk: usize, values: &mut [f64], (): &mut ()| {
                let (mut moved, mut found) = (Vec::new(), Vec::new());
                for i in local.item_bounds[chunk]..local.item_bounds[chunk + 1] {
                    let item = &local.items[i];
                    if row >= item.row_count {
                        continue;
                    }
                    let step = outward(i, item, row, axis);
                    moved.clear();
                    moved.extend_from_slice(&rows[item.rows()]);
                    for (r, moved) in moved.iter_mut().enumerate() {
                        moved[axis] += multiple * step * local.image_of_row(item, r, row);
                    }
                    found.clear();
                    found.extend_from_slice(&local.targets[item.rows()]);
                    elastic(i, item, &moved, &mut found);
                    let columns = 3 * item.row_count;
                    let own = &mut values[starts[i] - bounds[chunk]..][..columns * columns];
                    for (r, (found, base)) in found.iter().zip(&base[item.rows()]).enumerate() {
                        let slope = weight / step * (*found - *base);
                        (0..3).for_each(|b| own[(3 * r + b) * columns + column] -= slope[b]);
                    }
                }
            };
            for_parts(&bounds, &mut values, &mut nothing, is_parallel, &work);
        }
        local.targets = targets;
        let work = |chunk: usize, values: &mut [f64], (): &mut ()| {
            for i in local.item_bounds[chunk]..local.item_bounds[chunk + 1] {
                let own = &mut values[starts[i] - bounds[chunk]..starts[i + 1] - bounds[chunk]];
                let item = &local.items[i];
                let columns = 3 * item.row_count;
                for k in 0..columns * item.row_count {
                    let (r, s, b) = (k / columns, k % columns / 3, k % 3);
                    own[(3 * r + b) * columns + 3 * s + b] += local.image_of_row(item, r, s);
                }
                make_symmetric(own, columns);
            }
        };
        for_parts(&bounds, &mut values, &mut nothing, is_parallel, &work);
        Self { values, starts, bounds }
    }

    /// The same without the negative eigenvalues.
    pub(super) fn positive(&self, local: &Local, is_parallel: bool) -> Self {
        let mut positive = self.clone();
        let work = |chunk: usize, values: &mut [f64], (): &mut ()| {
            let mut part: Option<PositivePart> = None;
            for i in local.item_bounds[chunk]..local.item_bounds[chunk + 1] {
                let own = &mut values[self.starts[i] - self.bounds[chunk]..self.starts[i + 1] - self.bounds[chunk]];
                // Inactive constraints have none.
                if own.iter().all(|value| *value == 0.0) {
                    continue;
                }
                let size = 3 * local.items[i].row_count;
                let known = part.take().filter(|part| part.size() == size);
                part.insert(known.unwrap_or_else(|| PositivePart::new(size))).replace(own);
            }
        };
        for_parts(&self.bounds, &mut positive.values, &mut vec![(); self.bounds.len() - 1], is_parallel, &work);
        positive
    }

    /// Adds `M x` of one constraint, `x` being rows.
    pub(super) fn add_product(&self, i: usize, x: &[DVec3], rows: &mut [DVec3]) {
        let columns = 3 * x.len();
        for (r, row) in rows.iter_mut().enumerate() {
            for b in 0..3 {
                let line = &self.values[self.starts[i] + (3 * r + b) * columns..][..columns];
                row[b] += line.chunks_exact(3).zip(x).map(|(line, x)| DVec3::from_slice(line).dot(*x)).sum::<f64>();
            }
        }
    }

    /// Calls `visit(value)` for the lower triangle of `Aᵀ M A`, row by row, of the coordinates of the constraint's
    /// points.
    pub(super) fn each_entry(&self, local: &Local, i: usize, block: &mut Vec<f64>, mut visit: impl FnMut(f64)) {
        let item = &local.items[i];
        let values = &self.values[self.starts[i]..self.starts[i + 1]];
        let Some((a, _)) = local.matrices(item) else {
            // M takes means off on both sides.
            let columns = 3 * item.row_count;
            (0..columns).for_each(|r| values[r * columns..=r * columns + r].iter().for_each(|value| visit(*value)));
            return;
        };
        let (k, rows) = (item.point_count, item.row_count);
        // M A, then Aᵀ of that.
        block.clear();
        block.resize(3 * rows * 3 * k, 0.0);
        for r in 0..3 * rows {
            for s in 0..rows {
                for (place, coefficient) in a[s * k..(s + 1) * k].iter().enumerate().filter(|(_, a)| **a != 0.0) {
                    for b in 0..3 {
                        block[r * 3 * k + 3 * place + b] += coefficient * values[r * 3 * rows + 3 * s + b];
                    }
                }
            }
        }
        for place in 0..k {
            for b in 0..3 {
                for c in 0..=3 * place + b {
                    visit((0..rows).map(|s| a[s * k + place] * block[(3 * s + b) * 3 * k + c]).sum());
                }
            }
        }
    }
}

fn make_symmetric(matrix: &mut [f64], size: usize) {
    for i in 0..size {
        for j in 0..i {
            let mean = 0.5 * (matrix[i * size + j] + matrix[j * size + i]);
            (matrix[i * size + j], matrix[j * size + i]) = (mean, mean);
        }
    }
}

/// The extent of a constraint at these points.
fn extent(points: &[DVec3], size: f64) -> f64 {
    let first = points[0];
    let extent = points.iter().map(|point| point.distance(first)).fold(0.0, f64::max);
    if extent > 0.0 { extent } else { SINGLE * size }
}

/// `A x`, `x` being vectors at the constraint's points.
pub(super) fn apply_rows(local: &Local, item: &Item, x: &[DVec3], rows: &mut [DVec3]) {
    match local.matrices(item) {
        None => {
            let mean = x[0] + x.iter().map(|x_j| *x_j - x[0]).sum::<DVec3>() / x.len() as f64;
            rows.iter_mut().zip(x).for_each(|(row, x)| *row = *x - mean);
        }
        Some((a, _)) => {
            for (row, a) in rows.iter_mut().zip(a.chunks_exact(x.len())) {
                *row = a.iter().zip(x).map(|(a, x)| *a * *x).sum();
            }
        }
    }
}

/// `Aᵀ y` of one constraint times `factor`, added at the model's points.
pub(super) fn add_transposed(local: &Local, item: &Item, factor: f64, y: &[DVec3], sums: &mut [DVec3]) {
    let indices = &local.indices[item.points()];
    match local.matrices(item) {
        // The rows of centred constraints have no mean.
        None => indices.iter().zip(y).for_each(|(i, y)| sums[*i as usize] += factor * *y),
        Some((a, _)) => {
            for (place, i) in indices.iter().enumerate() {
                let sum: DVec3 = y.iter().enumerate().map(|(r, y)| a[r * indices.len() + place] * *y).sum();
                sums[*i as usize] += factor * sum;
            }
        }
    }
}
