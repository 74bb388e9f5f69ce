//! The part of the right-hand side that is linear in the points: constraints whose targets never change, forces and inertia.
//!
//! With the points at the last upload `x₀`, the moves `u` since then and the matrix `Q` of these terms alone, their pull is
//! `C − Q u`: no kernel, one sparse product.

use glam::DVec3;

use super::local_step::images;
use crate::constraints::{ConstraintSet, Kernel, Rows};
use crate::error::Result;
use crate::linalg::rows::SparseRows;
use crate::linalg::symmetric::SymmetricMatrix;

/// What is told row, column and value of an entry.
type Visit<'a> = dyn FnMut(u32, u32, f64) + 'a;

/// `Q`, both triangles: what constraints contribute whose targets never change, and what `others` visit of the lower triangle.
pub(in crate::solver) fn matrix(
    constraints: &ConstraintSet,
    stiffness: &[Vec<f64>],
    point_count: usize,
    others: &dyn Fn(&mut Visit<'_>),
) -> Result<SparseRows> {
    // A matrix has at least one row.
    let n = point_count.max(1);
    let mut matrix = SymmetricMatrix::with_pattern(n, |report| {
        each_entry(constraints, stiffness, &mut |i, j, _| report(i, j));
        others(&mut |i, j, _| report(i, j));
    })?;
    let (pattern, values) = matrix.split();
    let mut add = |i, j, value| {
        // The pattern was made of the same entries.
        let _ = pattern.add(values, i, j, value);
    };
    each_entry(constraints, stiffness, &mut add);
    others(&mut add);
    Ok(SparseRows::scaled(&matrix, &vec![1.0; n]))
}

/// Calls `visit(i, j, value)` for every contribution to the lower triangle of `Q`.
fn each_entry(constraints: &ConstraintSet, stiffness: &[Vec<f64>], visit: &mut Visit<'_>) {
    for (index, (batch, _)) in constraints.batches().enumerate() {
        if batch.kernel() != Kernel::Constant {
            continue;
        }
        for slot in 0..batch.len() {
            let (s, indices, rows) = (stiffness[index][slot], batch.indices(slot), batch.rows(slot));
            let k = indices.len();
            for a in 0..k {
                for b in 0..=a {
                    let value = s * rows.chunks_exact(k).map(|row| row[a] * row[b]).sum::<f64>();
                    // A repeated index meets itself in both triangles.
                    let times = if a != b && indices[a] == indices[b] { 2.0 } else { 1.0 };
                    visit(indices[a], indices[b], times * value);
                }
            }
        }
    }
}

/// Adds what the constraints whose kernel is `wanted` pull at each point `x` with; returns their energy. In double precision, on
/// the processor.
pub(in crate::solver) fn add_pulls(
    constraints: &ConstraintSet,
    stiffness: &[Vec<f64>],
    x: &[DVec3],
    wanted: impl Fn(Kernel) -> bool,
    pulls: &mut [DVec3],
) -> f64 {
    let mut energy = 0.0;
    let mut targets = Vec::new();
    for (index, (batch, _)) in constraints.batches().enumerate().filter(|(_, (batch, _))| wanted(batch.kernel())) {
        for slot in (0..batch.len()).filter(|&slot| stiffness[index][slot] > 0.0) {
            let s = stiffness[index][slot];
            targets.clear();
            targets.resize(batch.target_offset(slot + 1) - batch.target_offset(slot), DVec3::ZERO);
            batch.project(slot..slot + 1, x, &mut targets);
            energy += 0.5 * batch.squared_residual(slot..slot + 1, x, &targets, &[s]);
            batch.centre_targets(slot..slot + 1, &mut targets);
            let indices = batch.indices(slot);
            let residuals = images(batch, slot, x).into_iter().zip(&targets).map(|(image, target)| *target - image);
            match batch.info().rows {
                Rows::Centred => residuals.zip(indices).for_each(|(e, point)| pulls[*point as usize] += s * e),
                Rows::Linear(_) => {
                    for (e, row) in residuals.zip(batch.rows(slot).chunks_exact(indices.len())) {
                        row.iter().zip(indices).for_each(|(a, point)| pulls[*point as usize] += s * *a * e);
                    }
                }
                Rows::Pairs => {
                    for (e, pair) in residuals.zip(indices.chunks_exact(2)) {
                        pulls[pair[0] as usize] -= s * e;
                        pulls[pair[1] as usize] += s * e;
                    }
                }
            }
        }
    }
    energy
}
