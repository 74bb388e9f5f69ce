//! Circle: points on a common circle.
//!
//! Set: all planar configurations on some circle; a straight line counts as a circle without end. Rows: centred.
//! Projection: onto the best-fit plane, then radially onto the algebraic (Kåsa) circle of the flattened points: with `(u, v)`
//! their coordinates about the mean, `S` their 2×2 scatter and `b = ½ (Σ u³ + Σ u v², Σ v³ + Σ v u²)`, the center is `c = S⁻¹ b`
//! and `r² = ‖c‖² + tr S / k`. That is the minimiser of `Σ (‖q − c‖² − r²)²`, not of the distances: an element of the set,
//! not the nearest, so plain iterations can raise the energy slightly. Parity prescribes it. Points on a line, whose `S` is
//! singular, are left planar. Violation: the largest distance of a point from its projection, in model units. Nothing can
//! degenerate. Sources: Bouaziz et al. 2012, section 3; Kåsa 1976, "A circle fitting procedure and its error analysis".

use glam::{DVec2, DVec3};

use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::lanes::{self, Mask, V4};
use crate::linalg::simd::Isa;
use crate::linalg::small::{scatter, symmetric_eigen};

/// Points whose scatter has `det S` at or below this multiple of `(tr S)²` are on a line within round-off: the center, at more
/// than 1e5 times their extent, would have lost all its digits.
const STRAIGHT: f64 = 1e-12;

/// As [`STRAIGHT`], from which on four fits at once lose less than four digits.
const FLAT_ARC: f64 = 1e-3;

/// Distances from the center, as a part of the radius, from which on a direction has lost less than four digits.
const NEAR_CENTER: f64 = 1e-4;

/// One Circle constraint; it has no rest state.
#[derive(Clone, Debug)]
pub struct Circle;

/// The best-fit plane through the mean, and the circle in it.
struct Fit {
    u: DVec3,
    v: DVec3,
    /// Center and radius; none for points on a line.
    circle: Option<(DVec2, f64)>,
}

impl Fit {
    fn new(x: Stencil<'_>) -> Self {
        let (values, [_, v, u]) = symmetric_eigen(scatter(x.iter()));
        // Relative to the points' extent, so that cubes of tiny and huge coordinates stay in range. The eigenvectors are
        // the principal axes of the flattened points too: S = diag(greatest, least).
        let size = x.extent();
        let (least, greatest) = (values[1] / size / size, values[2] / size / size);
        if !(least * greatest > STRAIGHT * (least + greatest) * (least + greatest)) {
            return Self { u, v, circle: None };
        }
        let flattened = x.iter().map(|point| DVec2::new(point.dot(u), point.dot(v)) / size);
        let moment: DVec2 = flattened.map(|q| q * q.length_squared()).sum();
        let center = 0.5 * moment / DVec2::new(greatest, least);
        let radius = (center.length_squared() + (greatest + least) / x.len() as f64).sqrt();
        Self { u, v, circle: Some((center * size, radius * size)) }
    }

    fn nearest(&self, point: DVec3) -> DVec3 {
        let mut q = DVec2::new(point.dot(self.u), point.dot(self.v));
        if let Some((center, radius)) = self.circle {
            // Every direction is as near from the center itself.
            q = center + radius * (q - center).try_normalize().unwrap_or(DVec2::X);
        }
        q.x * self.u + q.y * self.v
    }
}

impl Constraint for Circle {
    const INFO: TypeInfo = TypeInfo {
        name: "Circle",
        help: "keeps points on a common circle",
        least_indices: 3,
        greatest_indices: None,
        index_names: &["point"],
        scalars: Scalars::None,
        rows: Rows::Centred,
        projection: Projection::Feasible,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    // The points of an arc, say, have another mean than before they were moved radially.
    const TARGETS_ARE_CENTRED: bool = false;

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(
            include_str!("../solver/gpu/shaders/radial_fit.wgsl"),
            include_str!("../solver/gpu/shaders/circle.wgsl")
        ),
        RowUnit::Length,
    );

    fn at_rest(_x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let fit = Fit::new(x);
        for (target, point) in targets.iter_mut().zip(x.iter()) {
            *target = fit.nearest(point);
        }
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
        // The flattened points, then their moments of second and third order.
        let size = (diagonal.x + diagonal.y + diagonal.z).sqrt();
        let per_size = one / size;
        let (mut uu, mut uv, mut vv, mut bu, mut bv) = (zero, zero, zero, zero, zero);
        for (target, &point) in targets.iter_mut().zip(x) {
            let (a, b) = (point.dot(u) * per_size, point.dot(v) * per_size);
            let square = a.mul_add(a, b * b);
            (uu, uv, vv) = (a.mul_add(a, uu), a.mul_add(b, uv), b.mul_add(b, vv));
            (bu, bv) = (a.mul_add(square, bu), b.mul_add(square, bv));
            *target = V4 { x: a, y: b, z: zero };
        }
        let determinant = uu.mul_add(vv, -(uv * uv));
        let factor = half / determinant;
        let center_u = factor * vv.mul_add(bu, -(uv * bv));
        let center_v = factor * uu.mul_add(bv, -(uv * bu));
        let squared = center_u.mul_add(center_u, center_v.mul_add(center_v, uu + vv));
        let spread = (uu + vv) * four.splat(1.0 - 1.0 / x.len() as f64);
        let radius = (squared - spread).sqrt();
        let mut least_distance = radius;
        for target in &mut *targets {
            let (a, b) = (target.x - center_u, target.y - center_v);
            let distance = a.mul_add(a, b * b).sqrt();
            least_distance = least_distance.min(distance);
            let factor = radius / distance;
            let (a, b) = (a.mul_add(factor, center_u) * size, b.mul_add(factor, center_v) * size);
            *target = u.mul_add(a, v * b);
        }
        // Points at the center have no direction; on flat arcs the center is far away.
        let [flat_arc, near_center] = [FLAT_ARC, NEAR_CENTER].map(|value| four.splat(value));
        is_accurate & determinant.above(flat_arc) & least_distance.above(near_center * radius)
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        let fit = Fit::new(x);
        x.iter().map(|point| point.distance(fit.nearest(point))).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on a circle of radius 5 about (1, 2, 3) in a tilted plane, at these angles.
    fn circle(angles: &[f64]) -> Vec<DVec3> {
        let (u, v) = (DVec3::new(0.6, 0.0, 0.8), DVec3::Y);
        angles.iter().map(|t| DVec3::new(1.0, 2.0, 3.0) + 5.0 * (t.cos() * u + t.sin() * v)).collect()
    }

    fn projected(points: &[DVec3]) -> Vec<DVec3> {
        let indices: Vec<u32> = (0..points.len() as u32).collect();
        let mut targets = vec![DVec3::ZERO; points.len()];
        Circle.project(&[], Stencil::centred(points, &indices), &mut targets);
        let mean = points.iter().sum::<DVec3>() / points.len() as f64;
        targets.into_iter().map(|target| target + mean).collect()
    }

    #[test]
    fn points_on_a_circle_stay_on_arcs_however_short() {
        // The arc's sagitta over its chord is about a tenth of its angle: at 1e-4 the center is some 1e4 chords away.
        for arc in [6.0, 1.0, 1e-2, 1e-4] {
            let points = circle(&[0.0, 0.2 * arc, 0.7 * arc, 0.9 * arc, arc]);
            for (target, point) in projected(&points).into_iter().zip(&points) {
                assert!(target.distance(*point) < 1e-13 * 5.0, "arc {arc}: moved by {}", target.distance(*point));
            }
        }
    }

    #[test]
    fn four_points_at_two_distances_meet_on_the_root_mean_square_circle() {
        // By symmetry the center is 0, and r² = tr S / k = (2·1 + 2·4)/4.
        let points = [DVec3::X, 2.0 * DVec3::Y, -DVec3::X, -2.0 * DVec3::Y];
        for (target, point) in projected(&points).into_iter().zip(points) {
            assert!(target.distance(2.5_f64.sqrt() * point.normalize()) < 1e-14);
        }
    }

    #[test]
    fn points_on_a_line_stay() {
        let points = [0.0, 1.0, 2.5, 4.0].map(|x| DVec3::new(x, 2.0 * x, -x));
        for (target, point) in projected(&points).into_iter().zip(points) {
            assert!(target.distance(point) < 1e-14);
        }
    }
}
