//! From constraints to the entries of `N` and of `Aᵀ`.
//!
//! Short centred constraints enter `N` as the dense block `s (I − 11ᵀ/k)`. Long ones would fill it, so they get one more
//! unknown each, their mean `m`: minimising `½ s Σ ‖x_i − m − p_i‖²` over `x` and `m` has the same minimiser in `x`, and
//! costs `k + 1` entries. Their right-hand side is 0, as the targets have no mean.

use glam::DVec3;

use super::chunks::Chunk;
use crate::constraints::{ConstraintSet, Rows};
use crate::error::Result;
use crate::linalg::simd::{Kernel, add_scaled, dispatch, lanes, vector};
use crate::linalg::symmetric::{Pattern, SymmetricMatrix};

/// Centred constraints of more points than this get an unknown of their own. Up to here the block has fewer entries
/// than the fill that a further unknown would cause when it is eliminated.
const LONGEST_DENSE_STENCIL: usize = 12;

/// Points, or rows of the linear solver, in one chunk.
const CHUNK_POINTS: usize = 256;

/// `Aᵀ` by rows: the right-hand side of each point as a sum over targets, in a fixed order.
#[derive(Default)]
pub(super) struct Gather {
    starts: Vec<usize>,
    /// The target of each entry.
    targets: Vec<u32>,
    /// The coefficient of each entry.
    coefficients: Vec<f64>,
}

impl Gather {
    /// `bounds` says where the targets of each chunk begin.
    pub(super) fn new(
        constraints: &ConstraintSet,
        stiffness: &[Vec<f64>],
        chunks: &[Chunk],
        bounds: &[usize],
        point_count: usize,
    ) -> Self {
        let targets_of = (constraints, chunks, bounds);
        let mut starts = vec![0_usize; point_count + 1];
        each_target(targets_of, stiffness, |point, _, _| starts[point as usize + 1] += 1);
        for i in 0..point_count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut targets = vec![0_u32; starts[point_count]];
        let mut coefficients = vec![0.0; starts[point_count]];
        each_target(targets_of, stiffness, |point, target, coefficient| {
            let place = &mut next[point as usize];
            (targets[*place], coefficients[*place]) = (target, coefficient);
            *place += 1;
        });
        Self { starts, targets, coefficients }
    }

    /// The number of entries.
    pub(super) fn len(&self) -> usize {
        self.targets.len()
    }

    /// Bytes of all entries and of where the rows begin.
    pub(super) fn byte_count(&self) -> usize {
        size_of_val(&*self.starts) + size_of_val(&*self.targets) + size_of_val(&*self.coefficients)
    }

    /// Writes the sums of the points from `first` on.
    pub(super) fn sum(&self, first: usize, targets: &[DVec3], sums: &mut [DVec3]) {
        dispatch(Sum { gather: self, first, targets, sums });
    }
}

/// Chunks of [`CHUNK_POINTS`]: where they begin, and `count`.
pub(super) fn even_bounds(count: usize) -> Vec<usize> {
    let mut bounds: Vec<usize> = (0..count).step_by(CHUNK_POINTS).collect();
    bounds.push(count);
    bounds
}

struct Sum<'a> {
    gather: &'a Gather,
    first: usize,
    targets: &'a [DVec3],
    sums: &'a mut [DVec3],
}

impl Kernel for Sum<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let Self { gather, first, targets, sums } = self;
        for (i, result) in (first..).zip(sums) {
            let entries = gather.starts[i]..gather.starts[i + 1];
            let pairs = gather.targets[entries.clone()].iter().zip(&gather.coefficients[entries]);
            let sum = pairs.fold([0.0; 4], |sum, (&target, &coefficient)| {
                add_scaled::<FMA>(sum, coefficient, lanes(targets[target as usize]))
            });
            *result = vector(sum);
        }
    }
}

/// Calls `visit(point, target, coefficient)` for every nonzero entry of `Aᵀ`, stiffness included.
fn each_target(
    (constraints, chunks, bounds): (&ConstraintSet, &[Chunk], &[usize]),
    stiffness: &[Vec<f64>],
    mut visit: impl FnMut(u32, u32, f64),
) {
    for (chunk, &bound) in chunks.iter().zip(bounds) {
        let mut first = bound;
        for (index, slots) in chunk.batches() {
            let batch = constraints.batch(index);
            let start = batch.target_offset(slots.start);
            for slot in slots {
                let (s, indices) = (stiffness[index][slot], batch.indices(slot));
                let first = first + batch.target_offset(slot) - start;
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
                    Rows::Pairs if s > 0.0 => {
                        for (r, pair) in indices.chunks_exact(2).enumerate() {
                            visit(pair[0], (first + r) as u32, -s);
                            visit(pair[1], (first + r) as u32, s);
                        }
                    }
                    _ => {}
                }
            }
            first += chunk.target_count(batch);
        }
    }
}

/// Calls `visit(i, j, value)` for every contribution of the constraints to the lower triangle of `N`. Constraints of
/// weight 0 contribute zeros, so that they are in the pattern when their weight is raised.
pub(super) fn each_entry(
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
                Rows::Pairs => {
                    for pair in indices.chunks_exact(2) {
                        let (i, j) = (pair[0], pair[1]);
                        visit(i, i, s);
                        visit(j, j, s);
                        // A repeated index meets itself in both triangles.
                        visit(i, j, if i == j { -2.0 * s } else { -s });
                    }
                }
                kind => {
                    let value = |a: usize, b: usize| match kind {
                        Rows::Centred => s * (f64::from(u8::from(a == b)) - 1.0 / k as f64),
                        _ => s * rows.chunks_exact(k).map(|row| row[a] * row[b]).sum::<f64>(),
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
