//! Bytes that an iteration on the card moves at least: what is as fast as its memory can be no faster.

use std::collections::HashMap;

use shapeop::constraints::{TypeInfo, types};

use crate::Outcome;
use crate::models::Model;

/// Bytes of a number or an index on the card.
const WORD: f64 = 4.0;

/// Bytes of a point, a projection or a right-hand side on the card.
const VECTOR: f64 = 3.0 * WORD;

/// Vectors that an iteration of conjugate gradients reads or writes for each unknown, beside the product with the matrix:
/// direction and product are read for their dot product; solution and residual are read and written with both; the new
/// direction is written from residual and old one.
const VECTORS_OF_LINEAR_ITERATION: f64 = 11.0;

/// What moves in an iteration, in bytes.
#[derive(Clone, Copy, Debug)]
pub struct Traffic {
    /// Constraints, points and projections, and their sums.
    pub local: f64,
    /// The matrix and the vectors, for each iteration of the linear solver.
    pub linear_iteration: f64,
}

/// Indices and scalars are read once, points once, projections written and read once; of the matrix each entry of the
/// lower triangle and the diagonal is read once with its column. Levels of multigrid are not counted.
pub fn of(model: &Model) -> Outcome<Traffic> {
    let infos: HashMap<&str, &TypeInfo> = types().map(|info| (info.name, info)).collect();
    let points = model.points.len() as f64;
    let mut local = 2.0 * VECTOR * points;
    let mut pairs = Vec::new();
    for group in &model.groups {
        let info = infos.get(group.type_name).ok_or("a type is unknown")?;
        let rows: usize = group.counts.iter().map(|count| info.rows.count(*count)).sum();
        local += WORD * (group.indices.len() + group.scalars.len()) as f64 + 2.0 * VECTOR * rows as f64;
        let mut rest = group.indices.as_slice();
        for count in &group.counts {
            let (indices, behind) = rest.split_at(*count);
            rest = behind;
            couple(indices, &mut pairs);
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    let entries = pairs.len() as f64 + points;
    let linear_iteration = 2.0 * WORD * entries + VECTORS_OF_LINEAR_ITERATION * VECTOR * points;
    Ok(Traffic { local, linear_iteration })
}

/// Points of a constraint at most up to which each pair has an entry of the matrix: longer ones have an unknown of their
/// own, their mean.
const MOST_COUPLED: usize = 12;

fn couple(indices: &[u32], pairs: &mut Vec<u64>) {
    if indices.len() > MOST_COUPLED {
        return;
    }
    for (i, a) in indices.iter().enumerate() {
        for b in &indices[i + 1..] {
            pairs.push(u64::from(*a.min(b)) << 32 | u64::from(*a.max(b)));
        }
    }
}
