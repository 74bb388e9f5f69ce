//! RegularPolygon: points, in order, that are the corners of a regular polygon of any size.
//!
//! Set: `c + cos(2πj/k) a + sin(2πj/k) b` for `j = 0 … k−1`, with `‖a‖ = ‖b‖`, `a ⊥ b`: one turn about a center, in any
//! plane, from any direction, of any radius down to 0. Rows: centred. Projection: nearest, in closed form. With the
//! points relative to their mean, `p = Σ cos(2πj/k) x_j` and `q = Σ sin(2πj/k) x_j`, the cost is
//! `Σ x_j² − 2 (p·a + q·b) + k ‖a‖²`. For a plane of normal `n`, `b = n × a` and the cost is least at
//! `a = (p + q × n)/k`, where it has fallen by `‖p + q × n‖²/k`; of `‖p + q × n‖² = p² + q² + 2 n·(p × q)` the most is
//! reached by the `n` along `p × q`. Where `p` and `q` are on one line (as for all collinear points) each `n`
//! orthogonal to it is as near: the one nearest to that at creation is taken, or any where that was on a line too.
//! Violation: the largest distance of a point from the nearest regular polygon, in model units. Nothing can degenerate:
//! a regular polygon may shrink to a point. Source: the derivation above; it is the orthogonal Procrustes problem
//! (Umeyama 1991) for a template whose scatter is that of a circle.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;
use crate::linalg::small::any_orthogonal;

/// `‖p × q‖` up to which, relative to `p² + q²`, the points span no plane: its direction would have lost all its
/// digits.
const COLLINEAR: f64 = 1e-14;

/// As [`COLLINEAR`], from which on four at once lose less than four digits.
const LEAST_AREA: f64 = 1e-4;

/// One RegularPolygon constraint.
#[derive(Clone, Debug)]
pub struct RegularPolygon {
    /// `p × q` at creation, a unit vector; 0 where the points were on a line.
    rest_normal: DVec3,
    /// Cosine and sine of `2π/k`.
    step: [f64; 2],
}

/// The directions of the corners, one after the other: cosines and sines of the multiples of an angle.
struct Corners {
    step: [f64; 2],
    next: [f64; 2],
}

impl Corners {
    fn new(step: [f64; 2]) -> Self {
        Self { step, next: [1.0, 0.0] }
    }
}

impl Iterator for Corners {
    type Item = [f64; 2];

    #[inline(always)]
    fn next(&mut self) -> Option<[f64; 2]> {
        let ([cos, sin], [step_cos, step_sin]) = (self.next, self.step);
        self.next = [cos * step_cos - sin * step_sin, sin * step_cos + cos * step_sin];
        Some([cos, sin])
    }
}

/// `p` and `q`.
fn moments(step: [f64; 2], x: Stencil<'_>) -> (DVec3, DVec3) {
    let corners = x.iter().zip(Corners::new(step));
    corners.fold((DVec3::ZERO, DVec3::ZERO), |(p, q), (point, [cos, sin])| (p + cos * point, q + sin * point))
}

/// The unit vector along `p × q`, if they are not on a line.
fn normal_of(p: DVec3, q: DVec3) -> Option<DVec3> {
    // Relative, so that products of tiny and huge coordinates stay in range.
    let size = p.abs().max(q.abs()).max_element();
    let (p, q) = (p / size, q / size);
    let normal = p.cross(q);
    let is_plane = normal.length() > COLLINEAR * (p.length_squared() + q.length_squared());
    normal.try_normalize().filter(|_| is_plane)
}

impl RegularPolygon {
    /// `a` and `b` of the nearest regular polygon.
    fn axes(&self, x: Stencil<'_>) -> (DVec3, DVec3) {
        let (p, q) = moments(self.step, x);
        let normal = normal_of(p, q).unwrap_or_else(|| {
            let along = if p.length() > q.length() { p } else { q }.try_normalize().unwrap_or(DVec3::X);
            let rest = self.rest_normal - self.rest_normal.dot(along) * along;
            if rest.length() > COLLINEAR.sqrt() { rest.normalize() } else { any_orthogonal(along) }
        });
        let a = (p + q.cross(normal)) / x.len() as f64;
        (a, normal.cross(a))
    }
}

impl Constraint for RegularPolygon {
    const INFO: TypeInfo = TypeInfo {
        name: "RegularPolygon",
        help: "keeps points, in order, the corners of a regular polygon of any size",
        least_indices: 3,
        greatest_indices: None,
        index_names: &["point"],
        scalars: Scalars::None,
        rows: Rows::Centred,
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(
            include_str!("../solver/gpu/shaders/polygon.wgsl"),
            include_str!("../solver/gpu/shaders/regular_polygon.wgsl")
        ),
        RowUnit::Length,
    );

    fn kernel_numbers(&self, _scalars: &[f64], _size: f64, numbers: &mut Vec<f64>) {
        numbers.extend(self.rest_normal.to_array());
    }

    fn at_rest(x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        let (sin, cos) = (TAU / x.len() as f64).sin_cos();
        let (p, q) = moments([cos, sin], x);
        Self { rest_normal: normal_of(p, q).unwrap_or(DVec3::ZERO), step: [cos, sin] }
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let (a, b) = self.axes(x);
        for (target, [cos, sin]) in targets.iter_mut().zip(Corners::new(self.step)) {
            *target = cos * a + sin * b;
        }
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let one = four.splat(1.0);
        // All four have as many points.
        let step = [0, 1].map(|i| four.rest(|polygon| polygon.step[i]).to_array()[0]);
        let (mut p, mut q) = (V4::zero(four.simd), V4::zero(four.simd));
        for (point, [cos, sin]) in x.iter().zip(Corners::new(step)) {
            (p, q) = (point.mul_add(four.splat(cos), p), point.mul_add(four.splat(sin), q));
        }
        let normal = p.cross(q);
        let squared = normal.dot(normal);
        let a = (p + q.cross(normal * (one / squared.sqrt()))) * four.splat(1.0 / x.len() as f64);
        let b = (normal * (one / squared.sqrt())).cross(a);
        for (target, [cos, sin]) in targets.iter_mut().zip(Corners::new(step)) {
            *target = a.mul_add(four.splat(cos), b * four.splat(sin));
        }
        let area = four.splat(LEAST_AREA) * (p.dot(p) + q.dot(q));
        squared.above((area * area).max(four.splat(f64::MIN_POSITIVE))) & four.splat(f64::MAX).above(squared)
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        let (a, b) = self.axes(x);
        let distances =
            x.iter().zip(Corners::new(self.step)).map(|(point, [cos, sin])| point.distance(cos * a + sin * b));
        distances.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn projected(points: &[DVec3]) -> (Vec<DVec3>, f64) {
        let indices: Vec<u32> = (0..points.len() as u32).collect();
        let x = Stencil::centred(points, &indices);
        let polygon = RegularPolygon::at_rest(x, &mut Vec::new());
        let mut targets = vec![DVec3::ZERO; points.len()];
        polygon.project(&[], x, &mut targets);
        (targets, polygon.violation(&[], x))
    }

    #[test]
    fn regular_polygons_of_any_number_of_corners_stay() {
        for k in [3, 4, 5, 12, 1000] {
            let (u, v) = (DVec3::new(0.6, 0.0, 0.8), DVec3::Y);
            let corner = |j: usize| {
                let (sin, cos) = (0.3 - TAU * j as f64 / k as f64).sin_cos();
                5.0 * (cos * u + sin * v)
            };
            let points: Vec<_> = (0..k).map(|j| DVec3::splat(7.0) + corner(j)).collect();
            let (targets, violation) = projected(&points);
            // A thousand turns add up their round-off.
            assert!(violation < 1e-12, "{k}: {violation}");
            for (j, target) in targets.into_iter().enumerate() {
                assert!((target - corner(j)).length() < 1e-12, "{k}");
            }
        }
    }

    #[test]
    fn a_rhombus_becomes_the_square_of_its_mean_diagonal() {
        // Corners at 3 and 1 from the middle, at right angles: p = 6 x, q = 2 y, a = (6 + 2)/4 x.
        let (targets, violation) = projected(&[3.0 * DVec3::X, DVec3::Y, -3.0 * DVec3::X, -DVec3::Y]);
        for (target, expected) in targets.into_iter().zip([DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y]) {
            assert!((target - 2.0 * expected).length() < 1e-15);
        }
        assert!((violation - 1.0).abs() < 1e-15);
    }

    #[test]
    fn collinear_points_open_in_the_plane_they_had() {
        let rest = [DVec3::X, DVec3::Z, -DVec3::X, -DVec3::Z];
        let polygon = RegularPolygon::at_rest(Stencil::centred(&rest, &[0, 1, 2, 3]), &mut Vec::new());
        let line = [-1.0, 0.0, 2.0, -1.0].map(|t| t * DVec3::X);
        let mut targets = [DVec3::ZERO; 4];
        polygon.project(&[], Stencil::centred(&line, &[0, 1, 2, 3]), &mut targets);
        // p = −3 x, q = x: ‖a‖² = (9 + 1)/16, in the plane y = 0.
        for target in targets {
            assert!(target.y.abs() < 1e-15 && (target.length_squared() - 10.0 / 16.0).abs() < 1e-15);
        }
        // On a line at rest too: some plane, and the same size.
        for target in projected(&line).0 {
            assert!((target.length_squared() - 10.0 / 16.0).abs() < 1e-15);
        }
    }
}
