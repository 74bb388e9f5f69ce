//! Sphere: points on a common sphere.
//!
//! Set: all configurations on some sphere; a plane counts as a sphere without end. Rows: centred. Projection: radially onto
//! the algebraic (Kåsa) sphere about the mean: with `S` the scatter and `b = ½ Σ ‖x‖² x`, the center is `c = S⁻¹ b` and
//! `r² = ‖c‖² + tr S / k`. That is the minimiser of `Σ (‖x − c‖² − r²)²`, not of the distances: an element of the set, not the
//! nearest, so plain iterations can raise the energy slightly. Parity prescribes it. Points in a plane, whose `S` is singular,
//! are left as they are. Violation: the largest distance of a point from its projection, in model units. Nothing can
//! degenerate. Sources: Bouaziz et al. 2012, section 3; Kåsa 1976.

use glam::DVec3;

use super::{Constraint, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::small::{scatter, symmetric_eigen};

/// Points whose scatter has a least eigenvalue at or below this multiple of the greatest are in a plane within round-off: the
/// center, at more than 1e5 times their extent, would have lost all its digits.
const FLAT: f64 = 1e-12;

/// One Sphere constraint; it has no rest state.
#[derive(Clone, Debug)]
pub struct Sphere;

/// Center, about the mean of the points, and radius; `None` for points in a plane.
fn fit(x: Stencil<'_>) -> Option<(DVec3, f64)> {
    let (values, axes) = symmetric_eigen(scatter(x.iter()));
    // Relative to the points' extent, so that cubes of tiny and huge coordinates stay in range.
    let size = x.extent();
    let values = values.map(|value| value / size / size);
    if !(values[0] > FLAT * values[2]) {
        return None;
    }
    let moment: DVec3 = x.iter().map(|point| point / size).map(|q| q * q.length_squared()).sum();
    let center: DVec3 = (0..3).map(|i| 0.5 * axes[i].dot(moment) / values[i] * axes[i]).sum();
    let radius = (center.length_squared() + values.iter().sum::<f64>() / x.len() as f64).sqrt();
    Some((center * size, radius * size))
}

impl Constraint for Sphere {
    const INFO: TypeInfo = TypeInfo {
        name: "Sphere",
        help: "keeps points on a common sphere",
        least_indices: 4,
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
            include_str!("../solver/gpu/shaders/sphere.wgsl")
        ),
        RowUnit::Length,
    );

    fn at_rest(_x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let sphere = fit(x);
        for (target, point) in targets.iter_mut().zip(x.iter()) {
            *target = match sphere {
                // Every direction is as near from the center itself.
                Some((center, radius)) => center + radius * (point - center).try_normalize().unwrap_or(DVec3::X),
                None => point,
            };
        }
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        let Some((center, radius)) = fit(x) else { return 0.0 };
        x.iter().map(|point| (point.distance(center) - radius).abs()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_sphere_stay_and_others_meet_on_the_root_mean_square_sphere() {
        // ±a, ±b, ±c along the axes: by symmetry the center is 0, and r² = tr S / k = 2 (1 + 4 + 9)/6.
        let octahedron = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]].map(DVec3::from);
        let points: Vec<DVec3> = octahedron.into_iter().flat_map(|axis| [axis, -axis]).collect();
        let stencil = Stencil::centred(&points, &[0, 1, 2, 3, 4, 5]);
        let radius = (14.0_f64 / 3.0).sqrt();
        let mut targets = [DVec3::ZERO; 6];
        Sphere.project(&[], stencil, &mut targets);
        for (target, point) in targets.iter().zip(&points) {
            assert!(target.distance(radius * point.normalize()) < 1e-14);
        }
        assert!((Sphere.violation(&[], stencil) - (radius - 1.0)).abs() < 1e-14);
        let on_sphere: Vec<DVec3> = targets.iter().map(|target| 1e6 * *target + 1e3).collect();
        let again = Stencil::centred(&on_sphere, &[0, 2, 4, 3, 5]);
        assert!(Sphere.violation(&[], again) < 1e-8);
    }

    #[test]
    fn points_in_a_plane_stay() {
        let points = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.5, 1.0]].map(DVec3::from);
        assert_eq!(Sphere.violation(&[], Stencil::centred(&points, &[0, 1, 2, 3])), 0.0);
    }
}
