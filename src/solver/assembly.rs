//! From constraints to the entries of `N` and of `Aᵀ`.
//!
//! Short centred constraints enter `N` as the dense block `s (I − 11ᵀ/k)`. Long ones would fill it, so they get one more
//! unknown each, their mean `m`: minimising `½ s Σ ‖x_i − m − p_i‖²` over `x` and `m` has the same minimiser in `x`, and
//! costs `k + 1` entries. Their right-hand side is 0, as the targets have no mean.

use crate::constraints::{ConstraintSet, Rows};
use crate::error::Result;
use crate::linalg::cholesky::{Pattern, SymmetricMatrix};

/// Centred constraints of more points than this get an unknown of their own. Up to here the block has fewer entries
/// than the fill that a further unknown would cause when it is eliminated.
const LONGEST_DENSE_STENCIL: usize = 12;

/// Points whose right-hand sides one chunk gathers.
const CHUNK_POINTS: usize = 1024;

/// `Aᵀ` by rows: the right-hand side of each point as a sum over targets, in a fixed order.
pub(super) struct Gather {
    pub(super) starts: Vec<usize>,
    /// The target of each entry.
    pub(super) targets: Vec<u32>,
    /// The coefficient of each entry.
    pub(super) coefficients: Vec<f64>,
    /// Where the chunks of points begin, and the number of points.
    pub(super) bounds: Vec<usize>,
}

impl Gather {
    pub(super) fn new(constraints: &ConstraintSet, stiffness: &[Vec<f64>], point_count: usize) -> Self {
        let mut starts = vec![0_usize; point_count + 1];
        each_target(constraints, stiffness, |point, _, _| starts[point as usize + 1] += 1);
        for i in 0..point_count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut targets = vec![0_u32; starts[point_count]];
        let mut coefficients = vec![0.0; starts[point_count]];
        each_target(constraints, stiffness, |point, target, coefficient| {
            let place = &mut next[point as usize];
            (targets[*place], coefficients[*place]) = (target, coefficient);
            *place += 1;
        });
        let mut bounds: Vec<usize> = (0..point_count).step_by(CHUNK_POINTS).collect();
        bounds.push(point_count);
        Self { starts, targets, coefficients, bounds }
    }
}

/// Calls `visit(point, target, coefficient)` for every nonzero entry of `Aᵀ`, stiffness included.
fn each_target(constraints: &ConstraintSet, stiffness: &[Vec<f64>], mut visit: impl FnMut(u32, u32, f64)) {
    let mut base = 0;
    for ((batch, _), stiffness) in constraints.batches().zip(stiffness) {
        for (slot, &s) in stiffness.iter().enumerate() {
            let (indices, first) = (batch.indices(slot), base + batch.target_offset(slot));
            match batch.info().rows {
                Rows::Centred if s > 0.0 => {
                    indices.iter().enumerate().for_each(|(i, &point)| visit(point, (first + i) as u32, s));
                }
                Rows::Linear(_) if s > 0.0 => {
                    for (r, row) in batch.rows(slot).chunks_exact(indices.len()).enumerate() {
                        for (&point, &a) in indices.iter().zip(row).filter(|(_, a)| **a != 0.0) {
                            visit(point, (first + r) as u32, s * a);
                        }
                    }
                }
                _ => {}
            }
        }
        base += batch.target_offset(batch.len());
    }
}

/// Calls `visit(i, j, value)` for every contribution of the constraints to the lower triangle of `N`. Constraints of
/// weight 0 contribute zeros, so that they are in the pattern when their weight is raised.
fn each_entry(
    constraints: &ConstraintSet,
    stiffness: Option<&[Vec<f64>]>,
    point_count: usize,
    mut visit: impl FnMut(u32, u32, f64),
) {
    let mut mean = point_count as u32;
    for (index, (batch, _)) in constraints.batches().enumerate() {
        for slot in 0..batch.len() {
            let s = stiffness.map_or(0.0, |stiffness| stiffness[index][slot]);
            let (indices, rows) = (batch.indices(slot), batch.rows(slot));
            let k = indices.len();
            match batch.info().rows {
                Rows::Centred if k > LONGEST_DENSE_STENCIL => {
                    for &i in indices {
                        visit(i, i, s);
                        visit(mean, i, -s);
                    }
                    visit(mean, mean, s * k as f64);
                    mean += 1;
                }
                kind => {
                    let value = |a: usize, b: usize| match kind {
                        Rows::Centred => s * (f64::from(u8::from(a == b)) - 1.0 / k as f64),
                        Rows::Linear(_) => s * rows.chunks_exact(k).map(|row| row[a] * row[b]).sum::<f64>(),
                    };
                    for a in 0..k {
                        visit(indices[a], indices[a], value(a, a));
                        for b in 0..a {
                            // A repeated index meets itself in both triangles.
                            let times = if indices[a] == indices[b] { 2.0 } else { 1.0 };
                            visit(indices[a], indices[b], times * value(a, b));
                        }
                    }
                }
            }
        }
    }
}

/// The number of unknowns beyond the points: the means of long centred constraints.
pub(super) fn long_constraint_count(constraints: &ConstraintSet) -> usize {
    let centred = constraints.batches().filter(|(batch, _)| batch.info().rows == Rows::Centred);
    centred.map(|(batch, _)| (0..batch.len()).filter(|&i| batch.indices(i).len() > LONGEST_DENSE_STENCIL).count()).sum()
}

/// The zero matrix with the pattern of `N`.
///
/// # Errors
/// Status `TooLarge` where 32-bit indices do not suffice.
pub(super) fn new_pattern(
    constraints: &ConstraintSet,
    point_count: usize,
    unknown_count: usize,
) -> Result<SymmetricMatrix> {
    SymmetricMatrix::with_pattern(unknown_count, |report| {
        each_entry(constraints, None, point_count, |i, j, _| report(i, j));
    })
}

/// Assembles the constraints' part of `N` into `values`. False if the pattern does not cover it.
pub(super) fn fill(
    (pattern, values): (&Pattern, &mut [f64]),
    constraints: &ConstraintSet,
    stiffness: &[Vec<f64>],
    point_count: usize,
) -> bool {
    values.fill(0.0);
    let mut is_covered = true;
    each_entry(constraints, Some(stiffness), point_count, |i, j, value| is_covered &= pattern.add(values, i, j, value));
    is_covered
}
