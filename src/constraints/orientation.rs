//! Orientation: points in a plane of a given normal.
//!
//! Set: all configurations with `n·(x_i − x_j) = 0`. Rows: centred. Projection: `x − (n·x) n` with `n` a unit vector,
//! onto the plane through the mean; nearest. Scalars: `nx ny nz`, of any length but 0, whose sign does not matter; by
//! default the normal of the best-fit plane at creation, some normal of the line where the points were on one.
//! Violation: the largest distance of a point from the plane through the mean, in model units. Nothing can degenerate.
//! Source: elementary.

use glam::DVec3;

use super::{
    Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalar, Scalars, Stencil, TypeInfo, check_direction,
    unit_vector,
};
use crate::error::Result;
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;
use crate::linalg::small::{least_eigenvector, scatter};

/// One Orientation constraint.
#[derive(Clone, Debug)]
pub struct Orientation {
    /// The unit normal.
    normal: DVec3,
}

impl Constraint for Orientation {
    const INFO: TypeInfo = TypeInfo {
        name: "Orientation",
        help: "keeps points in a plane of a given normal, by default that of the best-fit plane at creation",
        least_indices: 3,
        greatest_indices: None,
        index_names: &["point"],
        scalars: Scalars::Named(&[
            Scalar { name: "nx", default: None },
            Scalar { name: "ny", default: None },
            Scalar { name: "nz", default: None },
        ]),
        rows: Rows::Centred,
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(include_str!("../solver/gpu/shaders/orientation.wgsl"), RowUnit::Length);

    fn kernel_numbers(&self, _scalars: &[f64], _size: f64, numbers: &mut Vec<f64>) {
        numbers.extend(self.normal.to_array());
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        let normal = least_eigenvector(scatter(x.iter()));
        scalars.extend(normal.to_array());
        Self { normal }
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        check_direction("normal", scalars)
    }

    fn scalars_changed(&mut self, scalars: &[f64]) {
        self.normal = unit_vector(scalars).unwrap_or(DVec3::Z);
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        for (target, point) in targets.iter_mut().zip(x.iter()) {
            *target = point - point.dot(self.normal) * self.normal;
        }
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let normal = V4::gather(four.simd, four.rests().map(|rest| &rest.normal));
        for (target, &point) in targets.iter_mut().zip(x) {
            *target = point - normal * point.dot(normal);
        }
        // Every lane.
        four.splat(1.0).above(four.splat(0.0))
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        x.iter().map(|point| point.dot(self.normal).abs()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_triangle_is_levelled_about_its_mean() {
        let points = [[0.0, 0.0, 1.0], [1.0, 0.0, 2.0], [0.0, 1.0, 6.0]].map(DVec3::from);
        let stencil = Stencil::centred(&points, &[0, 1, 2]);
        let mut orientation = Orientation::at_rest(stencil, &mut Vec::new());
        let mut targets = [DVec3::ZERO; 3];
        for sign in [1.0, -1.0] {
            // Heights relative to the mean, 3: −2, −1 and 3.
            orientation.scalars_changed(&[0.0, 0.0, 7.0 * sign]);
            orientation.project(&[], stencil, &mut targets);
            for (target, point) in targets.iter().zip(stencil.iter()) {
                assert!(target.distance(DVec3::new(point.x, point.y, 0.0)) < 1e-15);
            }
            assert!((orientation.violation(&[], stencil) - 3.0).abs() < 1e-15);
        }
    }

    #[test]
    fn by_default_it_keeps_the_plane_that_points_have() {
        let (u, v) = (DVec3::new(0.6, 0.0, 0.8), DVec3::Y);
        let points = [DVec3::ONE, DVec3::ONE + u, DVec3::ONE + u + 2.0 * v, DVec3::ONE + v];
        let (stencil, mut scalars) = (Stencil::centred(&points, &[0, 1, 2, 3]), Vec::new());
        let orientation = Orientation::at_rest(stencil, &mut scalars);
        assert!((DVec3::from_slice(&scalars).dot(u.cross(v)).abs() - 1.0).abs() < 1e-14);
        assert!(orientation.violation(&scalars, stencil) < 1e-15);
        assert_eq!(Orientation::check_scalars(&[0.0; 3]).unwrap_err().place(), "normal");
    }
}
