//! The quadratic model of all terms in the free unknowns, and its least value.

use glam::DVec3;

use super::pull::Blocks;
use super::terms::{Evaluation, Terms};
use crate::error::Result;
use crate::linalg::cholesky::{Analysis, Factor};
use crate::linalg::elimination::Elimination;
use crate::linalg::least_squares::LeastSquares;
use crate::linalg::symmetric::SymmetricMatrix;

/// `g·d + ½ dᵀ H d`.
#[derive(Clone, Debug)]
pub(super) struct Model {
    /// The lower triangle of `H`: row, column, value; by rows, columns ascending, each once.
    pub(super) entries: Vec<(u32, u32, f64)>,
    pub(super) gradient: Vec<f64>,
}

/// The gradient by all points.
pub(super) fn gradient(terms: &Terms<'_>, at: &Evaluation, points: &[DVec3]) -> Vec<DVec3> {
    let mut gradient = vec![DVec3::ZERO; points.len()];
    for pull in &at.pulls {
        pull.points.iter().zip(pull.weights).for_each(|(&i, weight)| gradient[i as usize] += weight * pull.slope);
    }
    terms.form.add_gradient(&terms.ways(points), &mut gradient);
    gradient
}

/// The coordinates of points, one after the other.
pub(super) fn flat(points: &[DVec3]) -> Vec<f64> {
    points.iter().flat_map(DVec3::to_array).collect()
}

/// The points of coordinates.
pub(super) fn points_of(coordinates: &[f64]) -> Vec<DVec3> {
    coordinates.chunks_exact(3).map(DVec3::from_slice).collect()
}

impl Model {
    pub(super) fn new(terms: &Terms<'_>, at: &Evaluation, points: &[DVec3], elimination: &Elimination) -> Self {
        let mut blocks = Blocks::new(points.len());
        at.pulls.iter().for_each(|pull| blocks.add_pull(pull));
        blocks.add_form(&terms.form);
        let mut found: Vec<(u32, u32, f64)> = Vec::new();
        for (i, row) in blocks.rows.iter().enumerate() {
            for &(j, block) in row {
                let j = j as usize;
                for (a, b) in (0..9).map(|k| (k / 3, k % 3)) {
                    let value = block.col(b)[a];
                    let (first, second) = (elimination.unknown(3 * i + a), elimination.unknown(3 * j + b));
                    for &(k, c) in &first.terms {
                        for &(l, d) in &second.terms {
                            let value = c * d * value;
                            // A block off the diagonal stands for its mirror image too; one on it has both orders of its pairs.
                            if i != j {
                                found.push((k.max(l), k.min(l), if k == l { 2.0 * value } else { value }));
                            } else if l <= k {
                                found.push((k, l, value));
                            }
                        }
                    }
                }
            }
        }
        // Stable: sums have one order.
        found.sort_by_key(|&(k, l, _)| (k, l));
        let mut entries: Vec<(u32, u32, f64)> = Vec::new();
        for (k, l, value) in found {
            match entries.last_mut() {
                Some(last) if (last.0, last.1) == (k, l) => last.2 += value,
                _ => entries.push((k, l, value)),
            }
        }
        let gradient = elimination.reduce(&flat(&gradient(terms, at, points)));
        // What no term draws has a place on the diagonal too.
        let count = gradient.len();
        let mut is_there = vec![false; count];
        entries.iter().filter(|(k, l, _)| k == l).for_each(|&(k, ..)| is_there[k as usize] = true);
        entries.extend((0..count as u32).filter(|&k| !is_there[k as usize]).map(|k| (k, k, 0.0)));
        entries.sort_by_key(|&(k, l, _)| (k, l));
        Self { entries, gradient }
    }

    /// The mean of the diagonal.
    pub(super) fn mean_diagonal(&self) -> f64 {
        let sum: f64 = self.entries.iter().filter(|(k, l, _)| k == l).map(|(_, _, value)| value).sum();
        sum / self.gradient.len().max(1) as f64
    }

    /// The model with `damping` times the mean of the diagonal added to it.
    pub(super) fn damped(&self, damping: f64) -> Self {
        let mean = self.mean_diagonal();
        let added = if mean > 0.0 { damping * mean } else { 1.0 };
        let damp = |&(k, l, value): &(u32, u32, f64)| (k, l, if k == l { value + added } else { value });
        Self { entries: self.entries.iter().map(damp).collect(), gradient: self.gradient.clone() }
    }

    /// The step to the least value of a damped model; none if it is lost in round-off.
    pub(super) fn step(&self) -> Result<Option<Vec<f64>>> {
        let count = self.gradient.len();
        if count == 0 {
            return Ok(Some(Vec::new()));
        }
        let mut matrix = SymmetricMatrix::with_pattern(count, |visit| {
            self.entries.iter().for_each(|&(k, l, _)| visit(k, l));
        })?;
        for &(k, l, value) in &self.entries {
            let added = matrix.add(k, l, value);
            debug_assert!(added, "the pattern has every entry");
        }
        let analysis = Analysis::new(matrix.pattern(), &[])?;
        let mut factor = Factor::new(&analysis, matrix.pattern())?;
        factor.factorise(&matrix, true)?;
        if factor.is_singular() {
            return Ok(None);
        }
        let mut right: Vec<DVec3> = self.gradient.iter().map(|g| DVec3::new(-g, 0.0, 0.0)).collect();
        factor.solve(&mut right, true);
        let step: Vec<f64> = right.into_iter().map(|x| x.x).collect();
        Ok(step.iter().all(|x| x.is_finite()).then_some(step))
    }
}

/// The free unknowns at which all are the nearest to `points`.
pub(super) fn nearest_free(elimination: &Elimination, points: &[DVec3]) -> Result<Vec<f64>> {
    let wanted = flat(points);
    if elimination.free().len() == wanted.len() {
        return Ok(wanted);
    }
    // About where the free unknowns are: what solving adds to be safe is relative to what is solved for.
    let near: Vec<f64> = elimination.free().iter().map(|&i| wanted[i as usize]).collect();
    let there = elimination.expand(&near);
    let mut system = LeastSquares::new(near.len());
    for (i, (wanted, there)) in wanted.iter().zip(&there).enumerate() {
        system.add(&elimination.unknown(i).terms, wanted - there);
    }
    Ok(system.solve()?.iter().zip(&near).map(|(change, near)| near + change).collect())
}
