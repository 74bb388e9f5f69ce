//! The nearest copy of a template shape, shared by the types that fit templates.
//!
//! A constraint of `k` points has `m` template shapes of `k` points each. The points `x` may match a shape in any cyclic
//! order and in any mirrored order (`x_j` to `q_{(i+j) mod k}` or `q_{(i−j) mod k}`), for a polygon has no first vertex and
//! no side. For each of the `2 k m` candidates the best proper rotation maximises `tr(Rᵀ H)`, `H = Σ x qᵀ` (Umeyama 1991); with
//! that maximum `t`, the squared distance is `Σ‖x‖² − t²/Σ‖q‖²` under rotation and scale `t/Σ‖q‖²`, and
//! `Σ‖x‖² − 2t + Σ‖q‖²` under rotation alone. Both are least-squares over all candidates, so the projection is nearest.

use glam::{DMat3, DVec3};

use super::Stencil;
use crate::linalg::lanes::{F4, Mask, V4};
use crate::linalg::simd::Isa;
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

/// How far the bound on a trace may be exceeded by round-off, relative to the bound.
const BOUND_SLACK: f64 = 1e-12;

/// A bound on the trace that the best rotation reaches: the sum of the singular values of `h`. With `F² = Σσᵢ²` and
/// `C² = σ₀²σ₁² + σ₁²σ₂² + σ₂²σ₀²` (the squared norm of the cofactors), `(Σσᵢ)² = F² + 2 Σσᵢσⱼ ≤ F² + 2 √3 C`.
fn trace_bound(h: DMat3) -> f64 {
    let squared = |a: DVec3, b: DVec3, c: DVec3| a.length_squared() + b.length_squared() + c.length_squared();
    let (a, b, c) = (h.x_axis, h.y_axis, h.z_axis);
    let cofactors = squared(a.cross(b), b.cross(c), c.cross(a)).sqrt();
    (squared(a, b, c) + 2.0 * 3_f64.sqrt() * cofactors).sqrt() * (1.0 + BOUND_SLACK)
}

fn best(scalars: &[f64], x: Stencil<'_>, scale: Scale) -> Option<Candidate> {
    let k = x.len();
    let mut best: Option<Candidate> = None;
    for shape in 0..scalars.len() / (3 * k) {
        let mean = mean(scalars, k, shape);
        let squared: f64 = (0..k).map(|i| (vertex(scalars, k, shape, i) - mean).length_squared()).sum();
        let outcome = |trace: f64| match scale {
            Scale::Free if squared > 0.0 => (-trace * (trace / squared), trace / squared),
            Scale::Free => (0.0, 0.0),
            Scale::Fixed => (squared - 2.0 * trace, 1.0),
        };
        for is_mirrored in [false, true] {
            for shift in 0..k {
                let mut covariance = DMat3::ZERO;
                for (j, point) in x.iter().enumerate() {
                    let q = vertex(scalars, k, shape, order(k, shift, is_mirrored, j)) - mean;
                    covariance += DMat3::from_cols(point * q.x, point * q.y, point * q.z);
                }
                // Most orders are far worse than the best so far: no rotation needs to be fitted to know.
                if best.as_ref().is_some_and(|best| outcome(trace_bound(covariance)).0 > best.squared_distance) {
                    continue;
                }
                let (rotation, trace) = nearest_rotation(covariance);
                let (squared_distance, factor) = outcome(trace);
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

/// Appends what `shape_fit.wgsl` reads of a constraint; `known` are its number of points and what [`polygon_radius`] gave. They
/// are: that radius and the number of templates; then of each template its size, the root of the sum of its vertices' squared
/// distances from their mean, and the vertices about the mean, over the size. Sizes are in units of `unit` where the scale is
/// fixed, else 1; a template that is a point has size and vertices 0.
pub fn kernel_numbers(scalars: &[f64], known: (usize, f64), scale: Scale, unit: f64, numbers: &mut Vec<f64>) {
    let (k, polygon_radius) = known;
    let in_units = |length: f64| match scale {
        Scale::Fixed => length / unit,
        Scale::Free if length > 0.0 => 1.0,
        Scale::Free => 0.0,
    };
    let shape_count = scalars.len() / (3 * k);
    numbers.extend([in_units(polygon_radius), shape_count as f64]);
    for shape in 0..shape_count {
        let mean = mean(scalars, k, shape);
        let own = |j: usize| vertex(scalars, k, shape, j) - mean;
        // Relative, so that squares of tiny and huge coordinates stay in range.
        let greatest = (0..k).map(|j| own(j).abs().max_element()).fold(0.0, f64::max);
        let norm = (0..k).map(|j| (own(j) / greatest).length_squared()).sum::<f64>().sqrt();
        let is_point = greatest == 0.0;
        numbers.push(if is_point { 0.0 } else { in_units(greatest * norm) });
        numbers.extend((0..k).flat_map(|j| if is_point { [0.0; 3] } else { (own(j) / greatest / norm).to_array() }));
    }
}

/// The largest distance of a point from the nearest configuration.
pub fn violation(scalars: &[f64], x: Stencil<'_>, scale: Scale) -> f64 {
    let mut worst = 0.0_f64;
    project(scalars, x, scale, |j, target| worst = worst.max(x.at(j).distance(target)));
    worst
}

/// How far a template may be from a regular polygon, relative to its radius, to be taken for one: what is left when its
/// coordinates were written in decimal.
const REGULAR: f64 = 1e-12;

/// The circumradius of the template if there is one, and it is a regular polygon: then the `2 k` orders are turns of each
/// other. Else 0.
pub fn polygon_radius(scalars: &[f64], k: usize) -> f64 {
    if k < 3 || scalars.len() != 3 * k {
        return 0.0;
    }
    let mean = mean(scalars, k, 0);
    let corner = |j: usize| vertex(scalars, k, 0, j) - mean;
    let radius = corner(0).length();
    // The axes of the plane: to corner 0, and at a right angle to it towards corner 1.
    let Some(u) = corner(0).try_normalize() else { return 0.0 };
    let Some(v) = (corner(1) - corner(1).dot(u) * u).try_normalize() else { return 0.0 };
    let is_regular = (0..k).all(|j| {
        let (sin, cos) = (std::f64::consts::TAU * j as f64 / k as f64).sin_cos();
        corner(j).distance(radius * (cos * u + sin * v)) <= REGULAR * radius
    });
    if is_regular { radius } else { 0.0 }
}

/// The cosine and sine of a corner's turn in a regular polygon of `k` corners.
#[inline(always)]
fn corner_turn(k: usize) -> (f64, f64) {
    match k {
        3 => (-0.5, 0.866_025_403_784_438_6),
        4 => (0.0, 1.0),
        5 => (0.309_016_994_374_947_45, 0.951_056_516_295_153_5),
        6 => (0.5, 0.866_025_403_784_438_6),
        7 => (0.623_489_801_858_733_5, 0.781_831_482_468_029_8),
        _ => (std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2),
    }
}

/// How round points must be for the closed form: the area that they span over the square of their size.
const LEAST_ROUNDNESS: f64 = 1e-3;

/// Four regular polygons of `x.len()` corners (3 to 8), of any size if `radius` is none, nearest to the points `x` about their
/// means; and for which of the four the closed form is accurate.
///
/// With `p = Σ x_j cos(2πj/k)`, `q = Σ x_j sin(2πj/k)` and `M = [p q]`, the best orthonormal pair of axes is the polar factor
/// `M (MᵀM)^(−½)`. The root of the 2×2 matrix `G = MᵀM` is `(G + s I)/t` with `s = √det G` and `t = √(tr G + 2s)`. As `t` is the sum
/// of the singular values of `M`, and a unit polygon's squared norm is `k`, the best radius is `t/k`.
#[inline(always)]
pub fn project_regular_four<S: Isa>(simd: S, x: &[V4<S>], radius: Option<F4<S>>, targets: &mut [V4<S>]) -> Mask<S> {
    let number = |value| F4::splat(simd, value);
    let k = x.len();
    let (step_cos, step_sin) = corner_turn(k);
    let next = |(cos, sin): (f64, f64)| (cos * step_cos - sin * step_sin, sin * step_cos + cos * step_sin);
    let (mut p, mut q, mut turn) = (V4::zero(simd), V4::zero(simd), (1.0, 0.0));
    for &point in x {
        p = point.mul_add(number(turn.0), p);
        q = point.mul_add(number(turn.1), q);
        turn = next(turn);
    }
    let (pp, pq, qq) = (p.dot(p), p.dot(q), q.dot(q));
    let determinant = pp.mul_add(qq, -(pq * pq));
    let s = determinant.max(number(0.0)).sqrt();
    let t = (pp + qq + s + s).sqrt();
    // (G + s I)⁻¹ t, its own determinant being s t².
    let factor = number(1.0) / (s * t);
    let (a, b, d) = ((qq + s) * factor, -(pq * factor), (pp + s) * factor);
    let u = p.mul_add(a, q * b);
    let v = p.mul_add(b, q * d);
    let radius = radius.unwrap_or(t * number(1.0 / k as f64));
    let (u, v) = (u * radius, v * radius);
    turn = (1.0, 0.0);
    for target in targets {
        *target = u.mul_add(number(turn.0), v * number(turn.1));
        turn = next(turn);
    }
    s.above(number(LEAST_ROUNDNESS) * (pp + qq))
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
