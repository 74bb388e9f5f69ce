//! DiagonalDistance: a quad whose diagonals, taken as lines, are at most a distance apart.
//!
//! Set: quads `x₀ x₁ x₂ x₃` between two parallel planes at most `ε` apart, `x₀` and `x₂` on one, `x₁` and `x₃` on the
//! other: with `u = x₂ − x₀`, `v = x₃ − x₁`, `w = ½ (x₁ + x₃ − x₀ − x₂)` there is a unit vector `n ⊥ u, v` with
//! `|n·w| ≤ ε`. Where the diagonals are not parallel that is the distance of the lines, `D = |w·(u × v)|/‖u × v‖ ≤ ε`.
//! Where they are parallel, or one has no length, the points lie in a plane, and lines however near to them meet: the
//! closed set contains them, and they have no violation, whatever the distance from a point of one line to the other.
//!
//! Rows: centred. Projection: onto the two planes at distance `ε`, `y_k = x_k + (s_k ε/2 − x_k·n) n` with
//! `s = (−1, 1, −1, 1)`. The cost is `‖X n − b‖²` with the rows `x_k` and `b = ε/2 s`, over unit vectors `n`; nearest.
//! With the singular value decomposition of `[u/√2  v/√2  w]` (orthonormal combinations of the rows),
//! `d_i = σ_i² − σ_min²` and `g_i = ε (w·n_i)`, the global minimiser is `n = Σ g_i/(d_i + t) n_i` with the `t > 0` that
//! makes it a unit vector: the multiplier `t − σ_min²` lies in `(−σ_min², 0)`. The least-squares solution over the
//! ball, to which the paper refers, has a norm below 1 for every quad that is out of tolerance. `1/‖n(t)‖` is concave
//! and increases, so that Newton's method rises to the root from `max(|g_i| − d_i)`. If `g` has no part along the
//! singular vector of `σ_min` and the root is 0 (the hard case), that vector is added to fill up the unit length, on
//! the side of `u × v`; for `ε = 0` this is the projection onto the best-fit plane.
//!
//! Scalar: `distance_max` = `ε` in model units, at least 0; by default the distance at creation. Violation: `D − ε` in
//! model units, where that is above 0. Nothing can degenerate. Sources: Deng et al. 2015, section 3.3.1, for the
//! planes; Golub & von Matt 1991, "Quadratically constrained least squares and quadratic problems", for the equality
//! constraint.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec3;

use super::{
    Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalar, Scalars, Stencil, TypeInfo, check_not_negative,
};
use crate::error::Result;
use crate::linalg::lanes::{self, F4, Mask, V4};
use crate::linalg::simd::Isa;
use crate::linalg::small::svd;

/// Sines of the angle between the diagonals up to which they count as parallel: their common normal would have lost
/// half its digits.
const PARALLEL: f64 = 1e-8;

/// Steps of Newton's method, a bound that is not reached: on a million random quads, down to a thousandth of their size
/// flat, at most three were needed for 98 %, and ten for the worst.
const MAX_STEPS: usize = 40;

/// How far `‖n‖²` may be from 1: a few units in the last place, for three squares and their sum.
const UNIT: f64 = 4.0 * f64::EPSILON;

/// How far below 1 `‖n‖²` ends in the hard case only: else it is met from above, within round-off.
const HARD: f64 = 1e-10;

/// As [`MAX_STEPS`] and [`UNIT`], for four at once.
const FOUR_STEPS: usize = 10;
const FOUR_UNIT: f64 = 1e-13;

/// Sines squared from which on four at once know the common normal to twelve digits.
const LEAST_SQUARED_SINE: f64 = 1e-6;

/// Singular values, relative to the greatest, that four at once divide by.
const LEAST_VALUE: f64 = 1e-4;

/// One DiagonalDistance constraint. The distance is its scalar, so it has no rest state.
#[derive(Clone, Debug)]
pub struct DiagonalDistance;

/// The diagonals `u` and `v`, and the vector `w` from the middle of the first to that of the second.
fn diagonals(x: Stencil<'_>) -> [DVec3; 3] {
    let [a, b, c, d] = x.array();
    [c - a, d - b, 0.5 * ((b - a) + (d - c))]
}

/// The distance of the diagonal lines; 0 where they are parallel.
fn distance([u, v, w]: [DVec3; 3]) -> f64 {
    let (Some(u), Some(v)) = (u.try_normalize(), v.try_normalize()) else { return 0.0 };
    let normal = u.cross(v);
    let sine = normal.length();
    if sine > PARALLEL { w.dot(normal / sine).abs() } else { 0.0 }
}

/// The unit vector `n` that minimises `‖X n − b‖`.
fn common_normal([u, v, w]: [DVec3; 3], epsilon: f64) -> DVec3 {
    // In ascending order, so that the first belongs to σ_min.
    let decomposed = svd([FRAC_1_SQRT_2 * u, FRAC_1_SQRT_2 * v, w]);
    let ([n2, n1, n0], [s2, s1, s0]) = (decomposed.u, decomposed.s);
    // Relative to the greatest singular value, above 0 as the distance is: squares of tiny and huge coordinates stay in range.
    let (s, factor) = ([s0 / s2, s1 / s2, 1.0], epsilon / s2);
    let d = s.map(|s_i| (s_i - s[0]) * (s_i + s[0]));
    let g = [n0, n1, n2].map(|n| factor * (w.dot(n) / s2));
    // Parts of g that are 0 have no part in n, whatever d.
    let part = |i: usize, t: f64| if g[i] == 0.0 { 0.0 } else { g[i] / (d[i] + t) };
    let mut t = (0..3).map(|i| g[i].abs() - d[i]).fold(0.0, f64::max);
    let mut n = [0, 1, 2].map(|i| part(i, t));
    for _ in 0..MAX_STEPS {
        let squared: f64 = n.iter().map(|part| part * part).sum();
        // Only ever upwards: below 1 the root is passed, by round-off or as it is 0.
        if squared <= 1.0 + UNIT {
            break;
        }
        // The slope of 1/√φ is −½ φ'/φ^1.5 with −½ φ' = Σ n_i²/(d_i + t).
        let half_slope: f64 = (0..3).map(|i| if n[i] == 0.0 { 0.0 } else { n[i] * n[i] / (d[i] + t) }).sum();
        t += squared * (squared.sqrt() - 1.0) / half_slope;
        n = [0, 1, 2].map(|i| part(i, t));
    }
    let squared: f64 = n.iter().map(|part| part * part).sum();
    if squared < 1.0 - HARD {
        n[0] = (n[0] * n[0] + 1.0 - squared).sqrt().copysign(u.cross(v).dot(n0));
    }
    (n[0] * n0 + n[1] * n1 + n[2] * n2).normalize()
}

impl Constraint for DiagonalDistance {
    const INFO: TypeInfo = TypeInfo {
        name: "DiagonalDistance",
        help: "keeps the lines along the diagonals of a quad within a distance of each other",
        least_indices: 4,
        greatest_indices: Some(4),
        index_names: &["first", "second", "third", "fourth"],
        scalars: Scalars::Named(&[Scalar { name: "distance_max", default: None }]),
        rows: Rows::Centred,
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(
            include_str!("../solver/gpu/shaders/strain.wgsl"),
            include_str!("../solver/gpu/shaders/diagonal_distance.wgsl")
        ),
        RowUnit::Length,
    );

    fn kernel_numbers(&self, scalars: &[f64], size: f64, numbers: &mut Vec<f64>) {
        numbers.push(scalars[0] / size);
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.push(distance(diagonals(x)));
        Self
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        check_not_negative("distance_max", scalars[0])
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let (quad, epsilon): ([DVec3; 4], f64) = (x.array(), scalars[0]);
        targets.copy_from_slice(&quad);
        let diagonals = diagonals(x);
        if distance(diagonals) <= epsilon {
            return;
        }
        let n = common_normal(diagonals, epsilon);
        for (k, target) in targets.iter_mut().enumerate() {
            let level = if k % 2 == 0 { -0.5 * epsilon } else { 0.5 * epsilon };
            *target += (level - target.dot(n)) * n;
        }
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(|value| four.splat(value));
        let epsilon = four.scalar(0);
        let (u, v, w) = (x[2] - x[0], x[3] - x[1], ((x[1] - x[0]) + (x[3] - x[2])) * half);
        let normal = u.cross(v);
        let squared = normal.dot(normal);
        let lengths = u.dot(u) * v.dot(v);
        let is_crossing = squared.above(four.splat(LEAST_SQUARED_SINE) * lengths) & four.splat(f64::MAX).above(lengths);
        let excess = w.dot(normal).abs() / squared.sqrt() - epsilon;
        targets.copy_from_slice(x);
        if !excess.above(zero).any() {
            return is_crossing;
        }
        let root = four.splat(FRAC_1_SQRT_2);
        let decomposed = lanes::svd(four.simd, [u * root, v * root, w]);
        let [a, b, c] = decomposed.s;
        let (least, greatest) = (a.min(b).min(c), a.max(b).max(c));
        let per_greatest = one / greatest;
        let least_relative = least * per_greatest;
        let (mut d, mut g, mut t) = ([zero; 3], [zero; 3], zero);
        for i in 0..3 {
            let s = decomposed.s[i] * per_greatest;
            d[i] = (s - least_relative) * (s + least_relative);
            // g_i = ε w·n_i with n_i = a_i/s_i, over the square of the greatest value.
            g[i] = epsilon * per_greatest * (w.dot(decomposed.a[i]) * per_greatest / decomposed.s[i]);
            t = t.max(g[i].abs() - d[i]);
        }
        // Where t is 0, NaN may follow, and no bound below holds.
        let mut part = [zero; 3];
        let mut off = zero;
        for _ in 0..FOUR_STEPS {
            let (mut sum, mut half_slope) = (zero, zero);
            for i in 0..3 {
                let per = one / (d[i] + t);
                part[i] = g[i] * per;
                sum = part[i].mul_add(part[i], sum);
                half_slope = (part[i] * part[i]).mul_add(per, half_slope);
            }
            off = (sum - one).abs();
            if !(off.above(four.splat(FOUR_UNIT)) & excess.above(zero)).any() {
                break;
            }
            t = t + sum * (sum.sqrt() - one) / half_slope;
        }
        let mut n = V4::zero(four.simd);
        for i in 0..3 {
            n = decomposed.a[i].mul_add(part[i] / decomposed.s[i], n);
        }
        let n = n * (one / n.dot(n).sqrt());
        let level = half * epsilon;
        for (k, target) in targets.iter_mut().enumerate() {
            let own: F4<S> = if k.is_multiple_of(2) { -level } else { level };
            let moved = n.mul_add(own - target.dot(n), *target);
            *target = V4::where_above(excess, zero, moved, *target);
        }
        let is_root = four.splat(FOUR_UNIT).above(off) & least_relative.above(four.splat(LEAST_VALUE));
        let is_accurate = is_root & t.above(zero) & four.splat(f64::MAX).above(greatest);
        is_crossing & ((-excess).above(zero) | is_accurate)
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        (distance(diagonals(x)) - scalars[0]).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn projected(points: &[DVec3; 4], epsilon: f64) -> [DVec3; 4] {
        let mut targets = [DVec3::ZERO; 4];
        DiagonalDistance.project(&[epsilon], Stencil::centred(points, &[0, 1, 2, 3]), &mut targets);
        targets
    }

    #[test]
    fn a_symmetric_quad_keeps_its_plan_and_shares_the_excess() {
        // Diagonals of length 2 at right angles, at heights ±0.3: the planes stay level, 0.6 becomes 0.4.
        let points = [[-1.0, 0.0, -0.3], [0.0, -1.0, 0.3], [1.0, 0.0, -0.3], [0.0, 1.0, 0.3]].map(DVec3::from);
        for (k, target) in projected(&points, 0.4).into_iter().enumerate() {
            let expected = DVec3::new(points[k].x, points[k].y, 0.2_f64.copysign(points[k].z));
            assert!((target - expected).length() < 1e-15, "{target}");
        }
        let stencil = Stencil::centred(&points, &[0, 1, 2, 3]);
        assert!((DiagonalDistance.violation(&[0.4], stencil) - 0.2).abs() < 1e-15);
        assert_eq!(DiagonalDistance.violation(&[0.7], stencil), 0.0);
        let mut scalars = Vec::new();
        DiagonalDistance::at_rest(stencil, &mut scalars);
        assert!((scalars[0] - 0.6).abs() < 1e-15);
    }

    #[test]
    fn a_distance_of_zero_is_the_projection_onto_the_best_fit_plane() {
        let points = [[0.0, 0.1, 0.3], [1.0, 0.0, -0.2], [1.2, 1.1, 0.4], [-0.1, 0.9, 0.0]].map(DVec3::from);
        let mut plane = [DVec3::ZERO; 4];
        super::super::plane::Plane.project(&[], Stencil::centred(&points, &[0, 1, 2, 3]), &mut plane);
        for (ours, plane) in projected(&points, 0.0).into_iter().zip(plane) {
            assert!((ours - plane).length() < 1e-14);
        }
    }

    /// The best of many normals around the sphere, by brute force: the planes are all that is assumed.
    #[test]
    fn in_the_hard_case_no_normal_costs_less() {
        // The diagonals cross at right angles when seen along z and are long along x and y, but w is along z with the middle
        // singular value: g has no part along y, whose singular value is the least.
        let points = [[-3.0, 0.0, -1.0], [0.0, -0.5, 1.0], [3.0, 0.0, -1.0], [0.0, 0.5, 1.0]].map(DVec3::from);
        for epsilon in [0.5, 1.0, 1.5] {
            let targets = projected(&points, epsilon);
            let cost: f64 = targets.iter().zip(&points).map(|(target, point)| target.distance_squared(*point)).sum();
            let stencil = Stencil::absolute(&targets, &[0, 1, 2, 3]);
            assert!(DiagonalDistance.violation(&[epsilon], stencil) < 1e-14);
            let mut best = f64::INFINITY;
            for (i, j) in (0..400).flat_map(|i| (0..400).map(move |j| (i, j))) {
                let (z, angle) = (f64::from(i) / 399.0, std::f64::consts::TAU * f64::from(j) / 400.0);
                let across = (1.0 - z * z).sqrt();
                let n = DVec3::new(across * angle.cos(), across * angle.sin(), z);
                let levels = [-0.5, 0.5, -0.5, 0.5].map(|s: f64| s * epsilon);
                best = points.iter().zip(levels).map(|(x, level)| (x.dot(n) - level).powi(2)).sum::<f64>().min(best);
            }
            assert!(cost <= best + 1e-12 && best <= 1.01 * cost, "epsilon {epsilon}: {cost}, by brute force {best}");
        }
    }

    #[test]
    fn parallel_diagonals_lie_in_a_plane_and_stay() {
        let points = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [2.0, 1.0, 0.0]].map(DVec3::from);
        let stencil = Stencil::centred(&points, &[0, 1, 2, 3]);
        assert_eq!(DiagonalDistance.violation(&[0.0], stencil), 0.0);
        assert_eq!(projected(&points, 0.0), [0, 1, 2, 3].map(|i| stencil.at(i)));
    }

    #[test]
    fn a_negative_distance_is_refused_by_name() {
        let error = DiagonalDistance::check_scalars(&[-0.1]).unwrap_err();
        assert_eq!(error.place(), "distance_max");
        assert!(error.to_string().contains("-0.1"), "{error}");
    }
}
