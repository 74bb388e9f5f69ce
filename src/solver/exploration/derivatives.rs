//! Derivatives of projections, by central differences, and the second derivatives of the augmented Lagrangian that they
//! make.
//!
//! The derivative `J` of the projection onto a smooth set at `w = z + ν`, `z` in the set and `ν` normal to it there, is
//! 0 along the normals and `(I − S_ν)⁻¹` along the tangents, `S_ν` being the curvature of the set in the direction `ν`.
//! So `I − J` holds normals and curvature: all that Newton's method needs of a constraint, and the projection is all
//! that a type has to know.

use glam::DVec3;

use super::local::{Item, Local};

/// Steps of differences relative to a constraint's extent: the cube root of the precision, nearly.
const STEP: f64 = 1e-5;

/// Extent of a constraint of one point, relative to the model.
const SINGLE: f64 = 1e-2;

/// `∂P/∂x` of every constraint, row by row: `3` numbers per row of the constraint times `3` per point.
pub(super) struct Derivatives {
    values: Vec<f64>,
    starts: Vec<usize>,
}

impl Derivatives {
    /// Those at the points where `local` last was placed. `elastic` takes the targets to those of the elastic set, see
    /// [`super::splitting`]; it is given a constraint, its rows and its targets.
    pub(super) fn new(
        local: &mut Local,
        size: f64,
        elastic: impl Fn(usize, &Item, &[DVec3], &mut [DVec3]),
        is_parallel: bool,
    ) -> Self {
        let mut starts = vec![0];
        for item in &local.items {
            starts.push(starts[starts.len() - 1] + 9 * item.row_count * item.point_count);
        }
        let mut values = vec![0.0; starts[starts.len() - 1]];
        let center = local.points.clone();
        let targets = local.targets.clone();
        let steps: Vec<f64> = local.items.iter().map(|item| step(&center[item.points()], size)).collect();
        let most = local.items.iter().map(|item| item.point_count).max().unwrap_or(0);
        let mut rows = Vec::new();
        let mut plus = vec![DVec3::ZERO; local.targets.len()];
        for column in 0..3 * most {
            let (place, axis) = (column / 3, column % 3);
            for sign in [1.0, -1.0] {
                for (item, step) in local.items.iter().zip(&steps).filter(|(item, _)| place < item.point_count) {
                    local.points[item.first_point + place][axis] = center[item.first_point + place][axis] + sign * step;
                }
                local.project(is_parallel);
                for (i, item) in local.items.iter().enumerate().filter(|(_, item)| place < item.point_count) {
                    rows.clear();
                    rows.resize(item.row_count, DVec3::ZERO);
                    own_rows(local, item, &mut rows);
                    let (own, step) = (item.rows(), steps[i]);
                    if sign > 0.0 {
                        plus[own.clone()].copy_from_slice(&local.targets[own.clone()]);
                        elastic(i, item, &rows, &mut plus[own]);
                        continue;
                    }
                    elastic(i, item, &rows, &mut local.targets[own.clone()]);
                    for (r, (after, before)) in plus[own.clone()].iter().zip(&local.targets[own]).enumerate() {
                        let slope = (*after - *before) / (2.0 * step);
                        for (b, slope) in slope.to_array().into_iter().enumerate() {
                            values[starts[i] + (3 * r + b) * 3 * item.point_count + column] = slope;
                        }
                    }
                }
            }
            local.points.copy_from_slice(&center);
        }
        local.targets = targets;
        Self { values, starts }
    }

    /// `(A − J) x` of one constraint, `x` being vectors at its points.
    pub(super) fn residual(&self, local: &Local, i: usize, x: &[DVec3], rows: &mut [DVec3]) {
        let item = &local.items[i];
        apply_rows(local, item, x, rows);
        let columns = 3 * item.point_count;
        for (r, row) in rows.iter_mut().enumerate() {
            for b in 0..3 {
                let line = &self.values[self.starts[i] + (3 * r + b) * columns..][..columns];
                let sum = line.chunks_exact(3).zip(x).map(|(line, x)| DVec3::from_slice(line).dot(*x)).sum::<f64>();
                row[b] -= sum;
            }
        }
    }

    /// Calls `visit(a, b, value)` for the lower triangle of `Aᵀ (A − J)`, made symmetric; `a` and `b` count the
    /// coordinates of the constraint's points.
    pub(super) fn each_entry(
        &self,
        local: &Local,
        i: usize,
        block: &mut Vec<f64>,
        mut visit: impl FnMut(usize, usize, f64),
    ) {
        let item = &local.items[i];
        let (k, rows) = (item.point_count, item.row_count);
        let columns = 3 * k;
        let values = &self.values[self.starts[i]..self.starts[i + 1]];
        // Aᵀ J, then Aᵀ A.
        block.clear();
        block.resize(columns * columns, 0.0);
        match local.matrices(item) {
            // For centred rows A is symmetric, and J has neither mean nor, but for round-off, a response to one.
            None => block.iter_mut().zip(values).for_each(|(value, j)| *value = -j),
            Some((a, _)) => {
                for r in 0..rows {
                    for (place, coefficient) in a[r * k..(r + 1) * k].iter().enumerate().filter(|(_, a)| **a != 0.0) {
                        for b in 0..3 {
                            let line = &values[(3 * r + b) * columns..][..columns];
                            let own = &mut block[(3 * place + b) * columns..][..columns];
                            own.iter_mut().zip(line).for_each(|(own, j)| *own -= coefficient * j);
                        }
                    }
                }
            }
        }
        for p in 0..k {
            for q in 0..k {
                let product = match local.matrices(item) {
                    None => f64::from(u8::from(p == q)) - 1.0 / k as f64,
                    Some((a, _)) => (0..rows).map(|r| a[r * k + p] * a[r * k + q]).sum(),
                };
                for b in 0..3 {
                    block[(3 * p + b) * columns + 3 * q + b] += product;
                }
            }
        }
        for a in 0..columns {
            for b in 0..=a {
                visit(a, b, 0.5 * (block[a * columns + b] + block[b * columns + a]));
            }
        }
    }
}

/// The step of a constraint at these points.
fn step(points: &[DVec3], size: f64) -> f64 {
    let first = points[0];
    let extent = points.iter().map(|point| point.distance(first)).fold(0.0, f64::max);
    STEP * if extent > 0.0 { extent } else { SINGLE * size }
}

/// `A x` of the constraint's own points.
fn own_rows(local: &Local, item: &Item, rows: &mut [DVec3]) {
    apply_rows(local, item, &local.points[item.points()], rows);
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
