//! Angle: the angle at a point between the directions to two others stays within a range.
//!
//! Set: edges `e₁ = x₁ − x₀`, `e₂ = x₂ − x₀` with `min ≤ ∠(e₁, e₂) ≤ max`. Rows: the two edges. Projection: if the angle is too
//! large by `η`, both edges turn towards each other in their plane, by `θ` and `η − θ`; if too small, away from each other. Each
//! becomes its foot on its new direction, so the cost is `a sin²θ + b sin²(η − θ)` with `a = ‖e₁‖²`, `b = ‖e₂‖²`, least at
//! `θ = ½ atan2(b sin 2η, a + b cos 2η)`, kept within `[0, η]`. Nearest for corrections below a right angle; beyond, the nearest
//! element collapses the shorter edge, parity prescribes the formula, and an edge turned by more than a right angle has its
//! foot on the far side. The type therefore calls itself approximate, and plain iterations can raise the energy slightly.
//! Collinear edges span no plane: they are left. Scalars: `min_rad`, `max_rad` (0, π), within `[0, π]`. Violation: the distance of
//! the angle from the range in rad; an edge of no length has every angle. Nothing can degenerate.
//! Source: Deng et al. 2015, section 3.3.2, with atan2 for the paper's arctan.

use std::f64::consts::PI;

use glam::DVec3;

use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalar, Scalars, Stencil, TypeInfo};
use crate::error::{Error, Result, Status};
use crate::linalg::lanes::{F4, Mask, V4};
use crate::linalg::simd::Isa;

/// Edges are collinear where `1 − |cos|` is at or below this, as libShapeOp has it.
const COLLINEAR: f64 = 1e-14;

/// `1 − cos²` from which on the plane of the edges is known to many digits.
const LEAST_SQUARED_SINE: f64 = 1e-6;

/// The cosine of the largest correction that four at once make, short of a right angle.
const LEAST_COSINE: f64 = 0.05;

/// One Angle constraint; it has no rest state.
#[derive(Clone, Debug)]
pub struct Angle {
    /// Cosine and sine of the least angle.
    pub(super) min: [f64; 2],
    /// Cosine and sine of the greatest angle.
    pub(super) max: [f64; 2],
}

/// The foot of `edge` on the direction that lies by `turn` from it towards the unit vector `across`, which is orthogonal to it.
fn turned(edge: DVec3, across: DVec3, turn: f64) -> DVec3 {
    let length = edge.length();
    length * turn.cos() * (turn.cos() * (edge / length) + turn.sin() * across)
}

/// The angle between two vectors in rad, accurate also near 0 and π; 0 if one has no length.
pub(super) fn angle_between(e: DVec3, f: DVec3) -> f64 {
    e.cross(f).length().atan2(e.dot(f))
}

/// As [`Angle::project`], by cosines and sines alone, those of the least and the greatest angles in `bounds`: those of the
/// correction `η` from those of the angle and of its bound, those of `θ` by halving the angle whose tangent is given. Corrections
/// whose cosine is below `least_cosine` are not done.
#[inline(always)]
pub(super) fn turned_four<S: Isa>(
    simd: S,
    bounds: [[F4<S>; 2]; 2],
    least_cosine: f64,
    x: &[V4<S>],
    targets: &mut [V4<S>],
) -> Mask<S> {
    let [min, max] = bounds;
    let [zero, half, one] = [0.0, 0.5, 1.0].map(|value| F4::splat(simd, value));
    let (e, f) = (x[1] - x[0], x[2] - x[0]);
    let (ee, ff) = (e.dot(e), f.dot(f));
    let normal = e.cross(f);
    let product = (ee * ff).sqrt();
    let per_product = one / product;
    let cos = e.dot(f) * per_product;
    let sin = normal.dot(normal).sqrt() * per_product;
    let bound = |i: usize, large: F4<S>| large.where_above(zero, max[i], min[i]);
    // Positive where the angle is too large, or where it is too small; the bounds are in [0, π], where the cosine falls.
    let large = max[0] - cos;
    let small = cos - min[0];
    let (bound_cos, bound_sin) = (bound(0, large), bound(1, large));
    let eta_cos = cos.mul_add(bound_cos, sin * bound_sin);
    // Signed: below 0 where the edges turn away from each other.
    let eta_sin = sin.mul_add(bound_cos, -(cos * bound_sin));
    let ratio = ff / ee;
    let double_sin = (eta_sin + eta_sin) * eta_cos;
    let double_cos = one - (eta_sin + eta_sin) * eta_sin;
    let (opposite, adjacent) = (ratio * double_sin, ratio.mul_add(double_cos, one));
    let hypotenuse = opposite.mul_add(opposite, adjacent * adjacent).sqrt();
    let half_per_hypotenuse = half / hypotenuse;
    let theta_cos = (half + adjacent * half_per_hypotenuse).sqrt();
    let theta_sin = opposite * half_per_hypotenuse / theta_cos;
    let phi_cos = eta_cos.mul_add(theta_cos, eta_sin * theta_sin);
    let phi_sin = eta_sin.mul_add(theta_cos, -(eta_cos * theta_sin));
    let is_off = large.max(small);
    // The foot of an edge `l u` on its new direction: l cos (cos u + sin across), `across` = (other's unit − cos u)/sin.
    let per_sin = one / sin;
    let turns = [(e, f, ee, theta_cos, theta_sin), (f, e, ff, phi_cos, phi_sin)];
    for (target, (edge, other, squared, turn_cos, turn_sin)) in targets.iter_mut().zip(turns) {
        let along = turn_cos * (turn_cos - turn_sin * (cos * per_sin));
        let moved = edge.mul_add(along, other * (turn_cos * turn_sin * (squared * per_product) * per_sin));
        *target = V4::where_above(is_off, zero, moved, edge);
    }
    let is_safe = eta_cos.above(F4::splat(simd, least_cosine)) & (sin * sin).above(F4::splat(simd, LEAST_SQUARED_SINE));
    is_safe & product.above(F4::splat(simd, f64::MIN_POSITIVE)) & F4::splat(simd, f64::MAX).above(product)
}

impl Constraint for Angle {
    const INFO: TypeInfo = TypeInfo {
        name: "Angle",
        help: "keeps the angle at a point between two others within a range",
        least_indices: 3,
        greatest_indices: Some(3),
        index_names: &["apex", "first", "second"],
        scalars: Scalars::Named(&[
            Scalar { name: "min_rad", default: Some(0.0) },
            Scalar { name: "max_rad", default: Some(PI) },
        ]),
        rows: Rows::Linear(2),
        projection: Projection::Approximate,
        violation_unit: "rad",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(include_str!("../solver/gpu/shaders/corner.wgsl"), include_str!("../solver/gpu/shaders/angle.wgsl")),
        RowUnit::Length,
    );

    fn kernel_numbers(&self, _scalars: &[f64], _size: f64, numbers: &mut Vec<f64>) {
        numbers.extend([self.min, self.max].as_flattened());
    }

    // The published Grasshopper client's help calls it so.
    const ALIAS: Option<&'static str> = Some("AngleConstraint");

    fn at_rest(_x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.extend([0.0, PI]);
        Self { min: [1.0, 0.0], max: [-1.0, 0.0] }
    }

    fn scalars_changed(&mut self, scalars: &[f64]) {
        [self.min, self.max] = [scalars[0], scalars[1]].map(|angle_rad| {
            let (sin, cos) = angle_rad.sin_cos();
            [cos, sin]
        });
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        let [min, max] = [scalars[0], scalars[1]];
        if 0.0 <= min && min <= max && max <= PI {
            return Ok(());
        }
        let reason = format!("expected 0 <= min_rad <= max_rad <= pi, found [{min}, {max}]");
        Err(Error::new(Status::InvalidValue, reason).at("range"))
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        coefficients.copy_from_slice(&[-1.0, 1.0, 0.0, -1.0, 0.0, 1.0]);
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let [apex, first, second] = x.array();
        let (e, f) = (first - apex, second - apex);
        targets.copy_from_slice(&[e, f]);
        let angle = angle_between(e, f);
        let excess = angle - angle.clamp(scalars[0], scalars[1]);
        let (Some(e_unit), Some(f_unit)) = (e.try_normalize(), f.try_normalize()) else { return };
        let cosine = e_unit.dot(f_unit);
        if excess == 0.0 || 1.0 - cosine.abs() <= COLLINEAR {
            return;
        }
        let (Some(to_f), Some(to_e)) =
            ((f_unit - cosine * e_unit).try_normalize(), (e_unit - cosine * f_unit).try_normalize())
        else {
            return;
        };
        // Relative lengths, so that their squares stay in range.
        let ratio = (f.length() / e.length()).powi(2);
        let correction = excess.abs();
        let best = 0.5 * (ratio * (2.0 * correction).sin()).atan2(1.0 + ratio * (2.0 * correction).cos());
        let turn = best.clamp(0.0, correction).copysign(excess);
        targets[0] = turned(e, to_f, turn);
        targets[1] = turned(f, to_e, excess - turn);
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let min = [0, 1].map(|i| four.rest(|angle| angle.min[i]));
        let max = [0, 1].map(|i| four.rest(|angle| angle.max[i]));
        turned_four(four.simd, [min, max], LEAST_COSINE, x, targets)
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        let [apex, first, second] = x.array();
        let (e, f) = (first - apex, second - apex);
        if e == DVec3::ZERO || f == DVec3::ZERO {
            return 0.0;
        }
        let angle = angle_between(e, f);
        (angle - angle.clamp(scalars[0], scalars[1])).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angle() -> Angle {
        Angle::at_rest(Stencil::absolute(&[DVec3::ZERO], &[0, 0, 0]), &mut Vec::new())
    }

    #[test]
    fn equal_edges_share_the_correction() {
        // A right angle that may be 60° at most: each edge turns by 15° and keeps cos 15° of its length.
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let stencil = Stencil::absolute(&points, &[0, 1, 2]);
        let mut targets = [DVec3::ZERO; 2];
        let range = [0.0, 60_f64.to_radians()];
        angle().project(&range, stencil, &mut targets);
        let (sin, cos) = 15_f64.to_radians().sin_cos();
        assert!((targets[0] - cos * DVec3::new(cos, sin, 0.0)).length() < 1e-15);
        assert!((targets[1] - cos * DVec3::new(sin, cos, 0.0)).length() < 1e-15);
        assert!((angle().violation(&range, stencil) - 30_f64.to_radians()).abs() < 1e-15);
        // At least 120°: away from each other.
        angle().project(&[120_f64.to_radians(), PI], stencil, &mut targets);
        assert!((targets[0] - cos * DVec3::new(cos, -sin, 0.0)).length() < 1e-15);
    }

    /// The cost over all splits of the correction, by brute force.
    #[test]
    fn below_a_right_angle_no_split_costs_less() {
        let points = [DVec3::ZERO, 3.0 * DVec3::X, DVec3::new(0.2, 0.7, 0.0)];
        let stencil = Stencil::absolute(&points, &[0, 1, 2]);
        for bound in [0.1, 0.5, 1.0, 1.2] {
            let mut targets = [DVec3::ZERO; 2];
            angle().project(&[0.0, bound], stencil, &mut targets);
            assert!((angle_between(targets[0], targets[1]) - bound).abs() < 1e-14);
            let cost = targets[0].distance_squared(points[1]) + targets[1].distance_squared(points[2]);
            let correction = angle_between(points[1], points[2]) - bound;
            for i in 0..=1000 {
                let turn = correction * f64::from(i) / 1000.0;
                let other = 9.0 * turn.sin().powi(2) + points[2].length_squared() * (correction - turn).sin().powi(2);
                assert!(cost <= other + 1e-15, "bound {bound}: a split at {turn} costs less");
            }
        }
    }

    #[test]
    fn the_name_in_the_published_clients_help_is_accepted() {
        let found = super::super::TypeIndex::named("AngleConstraint").unwrap();
        assert_eq!(found.info().name, "Angle");
    }

    #[test]
    fn collinear_edges_are_left() {
        let points = [DVec3::ZERO, DVec3::X, -2.0 * DVec3::X];
        let stencil = Stencil::absolute(&points, &[0, 1, 2]);
        let mut targets = [DVec3::ZERO; 2];
        angle().project(&[0.5, 1.0], stencil, &mut targets);
        assert_eq!(targets, [points[1], points[2]]);
        assert!((angle().violation(&[0.5, 1.0], stencil) - (PI - 1.0)).abs() < 1e-15);
    }
}
