//! BoundedAngle: the angle at a point between the directions to two others stays within a range, for any correction.
//!
//! Set: edges `e₁ = x₁ − x₀`, `e₂ = x₂ − x₀` with `min ≤ ∠(e₁, e₂) ≤ max`. Rows: the two edges. Both edges turn in
//! their plane, towards each other or away, by `θ` and `η − θ`, `η` being the correction. As long as `η` is at most 75°
//! the projection is the nearest element: with `a = ‖e₁‖²`, `b = ‖e₂‖²`, `θ = ½ atan2(b sin 2η, a + b cos 2η)`, and
//! each edge becomes its foot on its new direction, `cos θ` and `cos(η − θ)` of its length. Towards a right angle the
//! nearest element collapses the shorter edge, which is of no use to a design. From 85° on edges keep their lengths,
//! and `θ = η b/(a + b)`: the correction is split by the inverse squared lengths. Between 75° and 85° the angle `θ` and
//! the factors on the lengths go over from one to the other smoothly, so the projection is continuous; the bound is met
//! exactly everywhere. It is feasible, and nearest up to 75°: beyond, plain iterations can raise the energy.
//!
//! Edges along one line span no plane: they turn in the one that they had at creation, tilted as little as needed to
//! contain the line, and to the sides that they had. That turns with the model if creation does. If they were along a
//! line then too, the plane is an arbitrary one through the line. An edge of no length has every angle. Scalars:
//! `min_rad`, `max_rad` (0, π), within `[0, π]`. Violation: the distance of the angle from the range in rad. Nothing
//! can degenerate.
//!
//! Angle projects as libShapeOp does, with the collapse and without a plane for edges along one line. Source: Deng et
//! al. 2015, section 3.3.2, up to 75°, with atan2 for the paper's arctan, which is wrong where `a + b cos 2η < 0`.

use glam::DVec3;

use super::angle::{Angle, angle_between, turned_four};
use super::{Constraint, Four, Kernel, Projection, RowUnit, Stencil, TypeInfo};
use crate::error::Result;
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;
use crate::linalg::small::any_orthogonal;

/// Sines up to which edges count as being along one line: their common normal would have lost half its digits.
const COLLINEAR: f64 = 1e-8;

/// The correction in rad up to which the nearest element is taken: 75°.
const NEAREST: f64 = 75.0 * RADIANS;

/// The correction in rad from which on edges keep their lengths: 85°, short of the right angle where the nearest
/// element jumps.
const KEEPING: f64 = 85.0 * RADIANS;

const RADIANS: f64 = std::f64::consts::PI / 180.0;

/// The cosine of [`NEAREST`], rounded up.
const LEAST_COSINE: f64 = 0.25882;

/// One BoundedAngle constraint.
#[derive(Clone, Debug)]
pub struct BoundedAngle {
    bounds: Angle,
    /// The unit vector along `e₁ × e₂` at creation; 0 if they were along one line.
    rest_normal: DVec3,
}

/// The unit vector along the cross product of two unit vectors, if they span a plane.
fn common_normal(e: DVec3, f: DVec3) -> Option<DVec3> {
    let normal = e.cross(f);
    let sine = normal.length();
    (sine > COLLINEAR).then(|| normal / sine)
}

impl BoundedAngle {
    /// The normal of the plane in which edges along the line of `direction` turn.
    fn normal_beside(&self, direction: DVec3) -> DVec3 {
        let rest = self.rest_normal - self.rest_normal.dot(direction) * direction;
        if rest.length() > COLLINEAR { rest.normalize() } else { any_orthogonal(direction) }
    }
}

/// The turn of the first of two edges of these squared lengths, and the factors on both lengths, for a correction
/// `eta`.
fn shares(a: f64, b: f64, eta: f64) -> (f64, [f64; 2]) {
    let kept = ((eta - NEAREST) / (KEEPING - NEAREST)).clamp(0.0, 1.0);
    let kept = kept * kept * (3.0 - 2.0 * kept);
    // The nearest element is of no interest, and not continuous, where nothing is left of it.
    let nearest_eta = eta.min(KEEPING);
    let nearest =
        (0.5 * (b * (2.0 * nearest_eta).sin()).atan2(a + b * (2.0 * nearest_eta).cos())).clamp(0.0, nearest_eta);
    let theta = nearest + kept * (eta * b / (a + b) - nearest);
    let factor = |turn: f64| turn.cos() + kept * (1.0 - turn.cos());
    (theta, [factor(nearest), factor(nearest_eta - nearest)])
}

impl Constraint for BoundedAngle {
    const INFO: TypeInfo = TypeInfo {
        name: "BoundedAngle",
        help: "keeps the angle at a point within a range, without collapsing edges, and unfolds edges along one line",
        projection: Projection::Feasible,
        ..Angle::INFO
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(
            include_str!("../solver/gpu/shaders/corner.wgsl"),
            include_str!("../solver/gpu/shaders/bounded_angle.wgsl")
        ),
        RowUnit::Length,
    );

    fn kernel_numbers(&self, scalars: &[f64], size: f64, numbers: &mut Vec<f64>) {
        self.bounds.kernel_numbers(scalars, size, numbers);
        numbers.extend(self.rest_normal.to_array());
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        let [apex, first, second] = x.array();
        let units = (first - apex).try_normalize().zip((second - apex).try_normalize());
        let rest_normal = units.and_then(|(e, f)| common_normal(e, f)).unwrap_or(DVec3::ZERO);
        Self { bounds: Angle::at_rest(x, scalars), rest_normal }
    }

    fn scalars_changed(&mut self, scalars: &[f64]) {
        self.bounds.scalars_changed(scalars);
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        Angle::check_scalars(scalars)
    }

    fn rows(&self, scalars: &[f64], coefficients: &mut [f64]) {
        self.bounds.rows(scalars, coefficients);
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let [apex, first, second] = x.array();
        let (e, f) = (first - apex, second - apex);
        targets.copy_from_slice(&[e, f]);
        let excess_of = |angle: f64| angle - angle.clamp(scalars[0], scalars[1]);
        let mut excess = excess_of(angle_between(e, f));
        let (Some(e_unit), Some(mut f_unit)) = (e.try_normalize(), f.try_normalize()) else { return };
        if excess == 0.0 {
            return;
        }
        let normal = common_normal(e_unit, f_unit).unwrap_or_else(|| {
            // As if they were exactly along one line, so that the angle is the same in any plane through it.
            let is_open = e_unit.dot(f_unit) < 0.0;
            (f_unit, excess) =
                if is_open { (-e_unit, excess_of(std::f64::consts::PI)) } else { (e_unit, excess_of(0.0)) };
            self.normal_beside(e_unit)
        });
        let (to_f, to_e) = (normal.cross(e_unit).normalize(), f_unit.cross(normal).normalize());
        // Relative lengths, so that their squares stay in range.
        let (e_length, f_length) = (e.length(), f.length());
        let longest = e_length.max(f_length);
        let (a, b) = ((e_length / longest).powi(2), (f_length / longest).powi(2));
        let (theta, [e_factor, f_factor]) = shares(a, b, excess.abs());
        let turned = |unit: DVec3, across: DVec3, turn: f64| turn.cos() * unit + turn.sin() * across;
        targets[0] = e_length * e_factor * turned(e_unit, to_f, theta.copysign(excess));
        targets[1] = f_length * f_factor * turned(f_unit, to_e, (excess.abs() - theta).copysign(excess));
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let min = [0, 1].map(|i| four.rest(|angle| angle.bounds.min[i]));
        let max = [0, 1].map(|i| four.rest(|angle| angle.bounds.max[i]));
        turned_four(four.simd, [min, max], LEAST_COSINE, x, targets)
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        self.bounds.violation(scalars, x)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use glam::DQuat;

    use super::*;

    /// The projection of edges of these lengths at `angle`, for a constraint at rest at `rest`.
    fn projected(rest: [DVec3; 2], edges: [DVec3; 2], range: [f64; 2]) -> [DVec3; 2] {
        let indices = [0, 1, 2];
        let rest = [DVec3::ONE, DVec3::ONE + rest[0], DVec3::ONE + rest[1]];
        let mut angle = BoundedAngle::at_rest(Stencil::absolute(&rest, &indices), &mut Vec::new());
        angle.scalars_changed(&range);
        let points = [DVec3::ZERO, edges[0], edges[1]];
        let mut targets = [DVec3::ZERO; 2];
        angle.project(&range, Stencil::absolute(&points, &indices), &mut targets);
        targets
    }

    fn at(length: f64, angle: f64) -> DVec3 {
        length * DVec3::new(angle.cos(), angle.sin(), 0.0)
    }

    #[test]
    fn below_75_degrees_it_projects_as_angle_does() {
        let edges = [at(3.0, 0.0), at(0.7, 1.9)];
        for range in [[0.0, 0.7], [2.2, 3.0], [0.0, 1.5]] {
            let points = [DVec3::ZERO, edges[0], edges[1]];
            let mut expected = [DVec3::ZERO; 2];
            let angle = Angle::at_rest(Stencil::absolute(&points, &[0, 1, 2]), &mut Vec::new());
            angle.project(&range, Stencil::absolute(&points, &[0, 1, 2]), &mut expected);
            let found = projected(edges, edges, range);
            assert!(found.iter().zip(expected).all(|(f, e)| f.distance(e) < 1e-15), "{found:?}, {expected:?}");
        }
    }

    #[test]
    fn beyond_85_degrees_lengths_stay_and_the_shorter_edge_turns_more() {
        // 170° that may be 50° at most: η = 120°, split 1 : 4 between lengths 2 and 1.
        let edges = [at(2.0, 0.0), at(1.0, 170.0 * RADIANS)];
        let [e, f] = projected(edges, edges, [0.0, 50.0 * RADIANS]);
        assert!(e.distance(at(2.0, 24.0 * RADIANS)) < 1e-15 && f.distance(at(1.0, 74.0 * RADIANS)) < 1e-15, "{e} {f}");
        // 20° that must be 140° at least: away from each other.
        let edges = [at(2.0, 0.0), at(1.0, 20.0 * RADIANS)];
        let [e, f] = projected(edges, edges, [140.0 * RADIANS, PI]);
        assert!(
            e.distance(at(2.0, -24.0 * RADIANS)) < 1e-15 && f.distance(at(1.0, 116.0 * RADIANS)) < 1e-15,
            "{e} {f}"
        );
    }

    /// Steps of the angle by 1e-4 rad through all corrections move the targets by about as much, across both switches
    /// too, and the bound is met on the way.
    #[test]
    fn the_projection_is_continuous_and_meets_the_bound_for_every_correction() {
        for (long, short) in [(1.0, 1.0), (2.0, 1.0), (1.0, 30.0)] {
            let bound = 0.2;
            let mut last: Option<[DVec3; 2]> = None;
            for step in 1..29_000 {
                let angle = bound + f64::from(step) * 1e-4;
                let edges = [at(long, 0.0), at(short, angle)];
                let found = projected(edges, edges, [0.0, bound]);
                assert!((angle_between(found[0], found[1]) - bound).abs() < 1e-13, "at {angle}");
                if let Some(last) = last {
                    let jump = found[0].distance(last[0]).max(found[1].distance(last[1]));
                    // A shorter edge is left at least cos 85° of its length, and turns within 10° by what is asked: some 15 times.
                    assert!(jump < 20.0 * 1e-4 * long.max(short), "at {angle}: jumps by {jump}");
                }
                last = Some(found);
            }
        }
    }

    #[test]
    fn it_turns_with_the_model_for_every_correction() {
        let turn = DQuat::from_scaled_axis(DVec3::new(0.7, -1.3, 2.0));
        for angle in [0.0, 0.3, 1.0, 1.6, 1.75, 1.85, 2.5, PI] {
            let rest = [at(1.0, 0.2), DVec3::new(0.3, 1.0, 0.5)];
            for range in [[0.0, 0.25], [2.0, 2.2], [FRAC_PI_2, FRAC_PI_2]] {
                // Exactly along one line, where they are.
                let second = if angle == PI { at(-0.6, 0.0) } else { at(0.6, angle) };
                let edges = [at(1.5, 0.0), second];
                let here = projected(rest, edges, range);
                let there = projected(rest.map(|e| turn * e), edges.map(|e| turn * e), range);
                for (here, there) in here.into_iter().zip(there) {
                    assert!((turn * here).distance(there) < 1e-14, "{angle}, {range:?}");
                }
            }
        }
    }

    #[test]
    fn a_folded_corner_opens_to_the_side_that_it_had() {
        // At creation the second edge lay on the +y side of the first; both are along x now.
        let rest = [at(1.0, 0.0), at(1.0, 1.0)];
        let [e, f] = projected(rest, [DVec3::X, DVec3::X], [1.0, 2.0]);
        assert!(e.y < 0.0 && f.y > 0.0 && (angle_between(e, f) - 1.0).abs() < 1e-15, "{e} {f}");
        // Open to 180°, it closes to the same side.
        let [e, f] = projected(rest, [DVec3::X, DVec3::NEG_X], [1.0, 2.0]);
        assert!(e.y > 0.0 && f.y > 0.0 && (angle_between(e, f) - 2.0).abs() < 1e-15, "{e} {f}");
        // Along a line at creation too: in some plane.
        let [e, f] = projected([DVec3::X, DVec3::X], [DVec3::X, DVec3::X], [1.0, 2.0]);
        assert!((angle_between(e, f) - 1.0).abs() < 1e-15);
    }
}
