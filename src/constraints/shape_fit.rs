//! The nearest copy of a template shape, shared by the types that fit templates.
//!
//! A constraint of `k` points has `m` template shapes of `k` points each. The points `x` may match a shape in any cyclic
//! order and in any mirrored order (`x_j` to `q_{(i+j) mod k}` or `q_{(i−j) mod k}`), for a polygon has no first vertex and
//! no side. For each of the `2 k m` candidates the best proper rotation maximises `tr(Rᵀ H)`, `H = Σ x qᵀ` (Umeyama 1991); with
//! that maximum `t`, the squared distance is `Σ‖x‖² − t²/Σ‖q‖²` under rotation and scale `t/Σ‖q‖²`, and
//! `Σ‖x‖² − 2t + Σ‖q‖²` under rotation alone. Both are least-squares over all candidates, so the projection is nearest.

use glam::{DMat3, DVec3};

use super::Stencil;
use crate::linalg::small::nearest_rotation;

/// Whether the template may be scaled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// To any size.
    Free,
    /// Not at all.
    Fixed,
}

/// One template in one order of its vertices, turned and scaled to match.
struct Candidate {
    /// `‖projection − x‖²` without the part that all candidates share.
    squared_distance: f64,
    shape: usize,
    shift: usize,
    is_mirrored: bool,
    /// Rotation times scale.
    turn: DMat3,
}

/// Coordinates of template `shape`, which has `k` points, in the order of a candidate.
fn vertex(scalars: &[f64], k: usize, shape: usize, index: usize) -> DVec3 {
    DVec3::from_slice(&scalars[3 * (shape * k + index)..])
}

fn order(k: usize, shift: usize, is_mirrored: bool, j: usize) -> usize {
    if is_mirrored { (shift + k - j) % k } else { (shift + j) % k }
}

fn mean(scalars: &[f64], k: usize, shape: usize) -> DVec3 {
    let first = vertex(scalars, k, shape, 0);
    first + (0..k).map(|i| vertex(scalars, k, shape, i) - first).sum::<DVec3>() / k as f64
}

fn best(scalars: &[f64], x: Stencil<'_>, scale: Scale) -> Option<Candidate> {
    let k = x.len();
    let mut best: Option<Candidate> = None;
    for shape in 0..scalars.len() / (3 * k) {
        let mean = mean(scalars, k, shape);
        let squared: f64 = (0..k).map(|i| (vertex(scalars, k, shape, i) - mean).length_squared()).sum();
        for is_mirrored in [false, true] {
            for shift in 0..k {
                let mut covariance = DMat3::ZERO;
                for (j, point) in x.iter().enumerate() {
                    let q = vertex(scalars, k, shape, order(k, shift, is_mirrored, j)) - mean;
                    covariance += DMat3::from_cols(point * q.x, point * q.y, point * q.z);
                }
                let (rotation, trace) = nearest_rotation(covariance);
                let (squared_distance, factor) = match scale {
                    Scale::Free if squared > 0.0 => (-trace * (trace / squared), trace / squared),
                    Scale::Free => (0.0, 0.0),
                    Scale::Fixed => (squared - 2.0 * trace, 1.0),
                };
                if best.as_ref().is_none_or(|best| squared_distance < best.squared_distance) {
                    best = Some(Candidate { squared_distance, shape, shift, is_mirrored, turn: rotation * factor });
                }
            }
        }
    }
    best
}

/// Calls `visit(j, target)` with the nearest configuration, about the mean of the points.
pub fn project(scalars: &[f64], x: Stencil<'_>, scale: Scale, mut visit: impl FnMut(usize, DVec3)) {
    let k = x.len();
    let Some(best) = best(scalars, x, scale) else { return };
    let mean = mean(scalars, k, best.shape);
    for j in 0..k {
        let q = vertex(scalars, k, best.shape, order(k, best.shift, best.is_mirrored, j)) - mean;
        visit(j, best.turn * q);
    }
}

/// The largest distance of a point from the nearest configuration.
pub fn violation(scalars: &[f64], x: Stencil<'_>, scale: Scale) -> f64 {
    let mut worst = 0.0_f64;
    project(scalars, x, scale, |j, target| worst = worst.max(x.at(j).distance(target)));
    worst
}

/// True if every template has shrunk to a point.
pub fn is_degenerate(scalars: &[f64], point_count: usize) -> bool {
    let shapes = 0..scalars.len() / (3 * point_count);
    let is_point = |shape| {
        let first = vertex(scalars, point_count, shape, 0);
        (1..point_count).all(|i| vertex(scalars, point_count, shape, i) == first)
    };
    point_count > 1 && shapes.into_iter().all(is_point)
}
