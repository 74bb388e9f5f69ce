//! Rectangle: four points, in order, that are the corners of a rectangle.
//!
//! Set: all rectangles. Rows: centred. Projection: onto the best-fit plane, then the rectangle whose four sides, two pairs of
//! parallel lines at right angles, are the least-squares fit to the corners at their ends; its corners are where they meet.
//!
//! With `n` the unit normal of the sides 01 and 23 and `m` that of the sides 12 and 30 (`n` turned by a right angle), the best
//! line of normal `n` through `x₀` and `x₁` leaves `½ (n·(x₁−x₀))²`. Summed over the sides that is `½ nᵀ M n` with
//! `M = d₀₁d₀₁ᵀ + d₂₃d₂₃ᵀ + turned(d₁₂d₁₂ᵀ + d₃₀d₃₀ᵀ)`: `n` is the eigenvector of its least eigenvalue.
//!
//! The distances of corners are not what is minimised, so the projection is feasible, not nearest, and plain iterations can
//! raise the energy slightly. Parity prescribes it. Violation: the largest distance of a point from its projection, in model
//! units. Nothing can degenerate: a rectangle may have sides of no length. Sources: Bouaziz et al. 2012, section 3;
//! Gander & von Matt 2004, "Some least squares problems".

use glam::{DVec2, DVec3};

use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::lanes::{self, F4, Mask, V4};
use crate::linalg::simd::Isa;
use crate::linalg::small::{scatter, symmetric_eigen};

/// How much better one direction of the sides must fit than the one at a half right angle to it, relative to the size squared.
const LEAST_PREFERENCE: f64 = 1e-3;

/// One Rectangle constraint; it has no rest state.
#[derive(Clone, Debug)]
pub struct Rectangle;

fn nearest_sides(x: Stencil<'_>) -> [DVec3; 4] {
    let (_, [_, v, u]) = symmetric_eigen(scatter(x.iter()));
    let corners: [DVec2; 4] = x.array().map(|point: DVec3| DVec2::new(point.dot(u), point.dot(v)));
    let side = |i: usize| corners[(i + 1) % 4] - corners[i];
    let (a, b, c, d) = (side(0), side(1).perp(), side(2), side(3).perp());
    // M = [[p, q], [q, r]]. Its greater eigenvalue belongs to the angle ½ atan2(2q, p − r), the least to that turned.
    let sum = |entry: fn(DVec2) -> f64| entry(a) + entry(b) + entry(c) + entry(d);
    let (difference, q) = (sum(|w| w.x * w.x - w.y * w.y), sum(|w| w.x * w.y));
    let n = DVec2::from_angle(0.5 * (2.0 * q).atan2(difference)).perp();
    let m = n.perp();
    let along_n = [0, 2].map(|i: usize| 0.5 * (corners[i] + corners[i + 1]).dot(n));
    let along_m = [1, 3].map(|i: usize| 0.5 * (corners[i] + corners[(i + 1) % 4]).dot(m));
    [(0, 1), (0, 0), (1, 0), (1, 1)].map(|(i, j)| {
        let corner = along_n[i] * n + along_m[j] * m;
        corner.x * u + corner.y * v
    })
}

impl Constraint for Rectangle {
    const INFO: TypeInfo = TypeInfo {
        name: "Rectangle",
        help: "keeps four points the corners of a rectangle",
        least_indices: 4,
        greatest_indices: Some(4),
        index_names: &["first", "second", "third", "fourth"],
        scalars: Scalars::None,
        rows: Rows::Centred,
        projection: Projection::Feasible,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(include_str!("../solver/gpu/shaders/rectangle.wgsl"), RowUnit::Length);

    fn at_rest(_x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        targets.copy_from_slice(&nearest_sides(x));
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let [zero, half, one] = [0.0, 0.5, 1.0].map(|value| four.splat(value));
        let (diagonal, off) = lanes::scatter(four.simd, x);
        let (normal, squared, is_accurate) = lanes::least_eigenvector(diagonal, off);
        let (u, v) = lanes::orthogonal_pair(normal * (one / squared.sqrt()));
        let corners: [[F4<S>; 2]; 4] = std::array::from_fn(|i| [x[i].dot(u), x[i].dot(v)]);
        // Those of the sides 12 and 30 are turned by a right angle.
        let side = |i: usize| {
            let [a, b] = [0, 1].map(|axis| corners[(i + 1) % 4][axis] - corners[i][axis]);
            if i.is_multiple_of(2) { [a, b] } else { [-b, a] }
        };
        let (mut difference, mut double) = (zero, zero);
        for [a, b] in [side(0), side(1), side(2), side(3)] {
            difference = difference + a.mul_add(a, -(b * b));
            double = double + (a + a) * b;
        }
        // The direction at half the angle of (difference, double), from whichever of its parts is the larger.
        let size = difference.mul_add(difference, double * double).sqrt();
        let cosine = difference / size;
        let large = (half + half * cosine.abs()).sqrt();
        let small = half * (double / size) / large;
        let (along_u, along_v) = (cosine.where_above(zero, large, small), cosine.where_above(zero, small, large));
        let (n, m) = ([-along_v, along_u], [-along_u, -along_v]);
        let middle = |direction: [F4<S>; 2], i: usize, j: usize| {
            let sum = [0, 1].map(|axis| corners[i][axis] + corners[j][axis]);
            half * sum[0].mul_add(direction[0], sum[1] * direction[1])
        };
        let along_n = [middle(n, 0, 1), middle(n, 2, 3)];
        let along_m = [middle(m, 1, 2), middle(m, 3, 0)];
        for (target, (i, j)) in targets.iter_mut().zip([(0, 1), (0, 0), (1, 0), (1, 1)]) {
            let [a, b] = [0, 1].map(|axis| along_n[i].mul_add(n[axis], along_m[j] * m[axis]));
            *target = u.mul_add(a, v * b);
        }
        // Where the sides fit one direction as well as another, round-off decides.
        let spread = diagonal.x + diagonal.y + diagonal.z;
        is_accurate & size.above(four.splat(LEAST_PREFERENCE) * spread)
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        x.iter().zip(nearest_sides(x)).map(|(point, corner)| point.distance(corner)).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trapezium_becomes_the_rectangle_of_its_mean_widths() {
        // Symmetric about the y axis: the sides stay parallel to the axes, each at the mean of its two corners.
        let points = [[-3.0, 0.0, 7.0], [3.0, 0.0, 7.0], [2.0, 2.0, 7.0], [-2.0, 2.0, 7.0]].map(DVec3::from);
        let stencil = Stencil::centred(&points, &[0, 1, 2, 3]);
        let mut targets = [DVec3::ZERO; 4];
        Rectangle.project(&[], stencil, &mut targets);
        let expected = [[-2.5, -1.0, 0.0], [2.5, -1.0, 0.0], [2.5, 1.0, 0.0], [-2.5, 1.0, 0.0]];
        for (target, expected) in targets.into_iter().zip(expected) {
            assert!((target - DVec3::from(expected)).length() < 1e-14, "{target}");
        }
        assert!((Rectangle.violation(&[], stencil) - 0.5).abs() < 1e-14);
    }
}
