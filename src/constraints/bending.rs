//! Bending: two triangles on a common edge whose bending stays within a range of that at rest.
//!
//! Row: the cotangent stencil `e = Σ cᵢ xᵢ` of the two rest triangles, the edge's share of the discrete Laplacian: with
//! `x₀ x₁` the common edge, `x₂` and `x₃` the opposite points, and `α_i, β_i` the angles at `x_i` in the triangles of `x₂` and
//! `x₃`, `c₀ = cot α₁ + cot β₁`, `c₁ = cot α₀ + cot β₀`, `c₂ = −cot α₀ − cot α₁`, `c₃ = −cot β₀ − cot β₁`. The
//! coefficients have no unit and vanish on flat configurations of the rest triangles; `e` is in model units.
//! Set: `rmin ≤ ‖e‖/n ≤ rmax` with `n` the norm at rest; `e = 0` if the pair is flat at rest. Projection:
//! `n clamp(‖e‖/n, rmin, rmax) e/‖e‖`; nearest, but that a pair flattened to `e = 0` has no side to bend to and stays flat.
//! Measure: `3/(A₀ + A₁)`, the rest areas. Scalars: `range_min`, `range_max`, ratios of norms (1, 1). Violation: the distance
//! of `‖e‖` from the range, in model units. Degenerate where a triangle at creation is flat: its row is then zero.
//! Sources: Bergou et al. 2006, "A quadratic bending model for inextensible surfaces"; Bouaziz et al. 2014, section 5.4.

use glam::DVec3;

use super::{Constraint, Four, Kernel, Projection, RANGE, RowUnit, Rows, Scalars, Stencil, TypeInfo, check_range};
use crate::error::Result;
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;

/// A norm of `e` below this multiple of the longest rest edge counts as flat: the threshold that libShapeOp takes in
/// absolute terms, made independent of the model's unit.
const FLAT: f64 = 1e-6;

/// A triangle whose area is below this multiple of its longest edge squared has no digits left in its cotangents.
const DEGENERATE: f64 = 1e-12;

/// One Bending constraint: its rest shape.
#[derive(Clone, Debug)]
pub struct Bending {
    coefficients: [f64; 4],
    /// `n`; 0 where the pair is flat at rest.
    rest_norm: f64,
    /// `‖e‖` up to here has no direction.
    flat_norm: f64,
    /// 0 where it is degenerate.
    measure: f64,
}

impl Bending {
    const DEGENERATE: Self = Self { coefficients: [0.0; 4], rest_norm: 0.0, flat_norm: 0.0, measure: 0.0 };

    fn bend(&self, x: Stencil<'_>) -> DVec3 {
        // The coefficients add up to 0: differences keep the digits that far-off coordinates lose.
        let apex = x.at(0);
        (1..4).map(|i| self.coefficients[i] * (x.at(i) - apex)).sum()
    }
}

/// The cotangents of the angles at `a` and `b` of the triangle `a b c`, and its area; `None` if it is flat. Lengths are
/// relative to `size`.
fn cotangents(a: DVec3, b: DVec3, c: DVec3, size: f64) -> Option<([f64; 2], f64)> {
    let [edge, left, right] = [b - a, c - a, c - b].map(|side| side / size);
    let double_area = edge.cross(left).length();
    let longest = edge.length_squared().max(left.length_squared()).max(right.length_squared());
    (double_area > 2.0 * DEGENERATE * longest)
        .then(|| ([edge.dot(left) / double_area, -edge.dot(right) / double_area], 0.5 * double_area))
}

impl Constraint for Bending {
    const INFO: TypeInfo = TypeInfo {
        name: "Bending",
        help: "keeps the bending between two triangles within a range of that at rest",
        least_indices: 4,
        greatest_indices: Some(4),
        index_names: &["edge start", "edge end", "opposite", "other opposite"],
        scalars: Scalars::Named(&RANGE),
        rows: Rows::Linear(1),
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 0,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(include_str!("../solver/gpu/shaders/bending.wgsl"), RowUnit::Length);

    fn kernel_numbers(&self, scalars: &[f64], size: f64, numbers: &mut Vec<f64>) {
        numbers.extend([scalars[0], scalars[1], self.rest_norm / size, self.flat_norm / size]);
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.extend([1.0, 1.0]);
        let [start, end, one, other] = x.array();
        let size = x.extent();
        let (Some(([a0, a1], area)), Some(([b0, b1], other_area))) =
            (cotangents(start, end, one, size), cotangents(start, end, other, size))
        else {
            return Self::DEGENERATE;
        };
        let measure = 3.0 / (area + other_area) / size / size;
        let mut bending = Self {
            coefficients: [a1 + b1, a0 + b0, -a0 - a1, -b0 - b1],
            rest_norm: 0.0,
            flat_norm: FLAT * size,
            measure,
        };
        if !(measure.is_finite() && measure > 0.0) {
            return Self::DEGENERATE;
        }
        let norm = bending.bend(x).length();
        bending.rest_norm = if norm > bending.flat_norm { norm } else { 0.0 };
        bending
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        check_range("range", scalars[0], scalars[1])
    }

    fn measure(&self, _scalars: &[f64]) -> f64 {
        self.measure
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        coefficients.copy_from_slice(&self.coefficients);
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let bend = self.bend(x);
        let norm = bend.length();
        targets[0] = if self.rest_norm == 0.0 {
            DVec3::ZERO
        } else if norm <= self.flat_norm {
            bend
        } else {
            self.rest_norm * (norm / self.rest_norm).clamp(scalars[0], scalars[1]) * (bend / norm)
        };
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let coefficient = |i: usize| four.rest(|bending| bending.coefficients[i]);
        let bend = (1..4).fold(V4::zero(four.simd), |bend, i| (x[i] - x[0]).mul_add(coefficient(i), bend));
        let norm = bend.dot(bend).sqrt();
        let (rest, flat) = (four.rest(|bending| bending.rest_norm), four.rest(|bending| bending.flat_norm));
        let [zero, one] = [0.0, 1.0].map(|value| four.splat(value));
        let moved = norm.max(four.scalar(0) * rest).min(four.scalar(1) * rest);
        let factor = norm.where_above(flat, moved / norm, one);
        targets[0] = bend * rest.where_above(zero, factor, zero);
        // Not degenerate pairs, nor norms whose squares are not normal numbers.
        (flat * flat).above(four.splat(f64::MIN_POSITIVE)) & four.splat(f64::MAX).above(norm)
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        let norm = self.bend(x).length();
        (norm - norm.clamp(scalars[0] * self.rest_norm, scalars[1] * self.rest_norm)).abs()
    }

    fn is_degenerate(&self, _scalars: &[f64]) -> bool {
        self.measure == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two right isosceles triangles on the edge (0,0,0)–(2,0,0), folded by `angle` about it.
    fn folded(angle: f64) -> [DVec3; 4] {
        let flap = DVec3::new(1.0, -angle.cos(), angle.sin());
        [DVec3::ZERO, 2.0 * DVec3::X, DVec3::new(1.0, 1.0, 0.0), flap]
    }

    #[test]
    fn the_stencil_of_right_isosceles_triangles_is_known() {
        // Every angle at the edge is 45°, cotangent 1: e = 2 x₀ + 2 x₁ − 2 x₂ − 2 x₃. The areas are 1 and 1.
        let rest = folded(0.0);
        let mut scalars = Vec::new();
        let bending = Bending::at_rest(Stencil::absolute(&rest, &[0, 1, 2, 3]), &mut scalars);
        let mut row = [0.0; 4];
        bending.rows(&scalars, &mut row);
        for (found, expected) in row.into_iter().zip([2.0, 2.0, -2.0, -2.0]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert!((bending.measure(&scalars) - 1.5).abs() < 1e-15);
        // Folded by t: 2 (2,0,0) − 2 (1,1,0) − 2 (1,−cos t, sin t) = (0, 2 cos t − 2, −2 sin t), norm 4 sin(t/2).
        let folded = folded(0.6);
        let violation = bending.violation(&scalars, Stencil::absolute(&folded, &[0, 1, 2, 3]));
        assert!((violation - 4.0 * 0.3_f64.sin()).abs() < 1e-15);
        let mut targets = [DVec3::ONE];
        bending.project(&scalars, Stencil::absolute(&folded, &[0, 1, 2, 3]), &mut targets);
        assert_eq!(targets[0], DVec3::ZERO, "flat at rest, flat again");
    }

    #[test]
    fn a_fold_opens_to_its_range() {
        let (rest, wide) = (folded(0.5), folded(2.0));
        let all = &[0, 1, 2, 3];
        let bending = Bending::at_rest(Stencil::absolute(&rest, all), &mut Vec::new());
        let mut targets = [DVec3::ZERO];
        bending.project(&[0.9, 1.1], Stencil::absolute(&wide, all), &mut targets);
        assert!((targets[0].length() - 1.1 * 4.0 * 0.25_f64.sin()).abs() < 1e-14);
        bending.project(&[0.9, 1.1], Stencil::absolute(&folded(0.0), all), &mut targets);
        assert!(targets[0].length() < 1e-15, "a flat pair has no side to bend to");
    }

    #[test]
    fn a_pair_with_a_flat_triangle_asks_for_nothing() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, 0.5 * DVec3::X];
        let bending = Bending::at_rest(Stencil::absolute(&points, &[0, 1, 2, 3]), &mut Vec::new());
        assert!(bending.is_degenerate(&[1.0, 1.0]));
        assert_eq!(bending.coefficients, [0.0; 4]);
    }
}
