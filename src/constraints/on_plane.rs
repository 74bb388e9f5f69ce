//! OnPlane: a point on a given plane.
//!
//! Set: `n·(x − c) = 0`. Row: `x`. Projection: `x − (n·(x − c)) n` with `n` a unit vector; nearest. Scalars: `x y z` of
//! a point `c` of the plane in model units, by default where the point was at creation, and `nx ny nz` of its normal,
//! of any length but 0, whose sign does not matter, by default (0, 0, 1): the level of the point. Violation: the
//! distance from the plane in model units. Nothing can degenerate. Source: elementary.

use glam::DVec3;

use super::{
    Constraint, Kernel, Projection, RowUnit, Rows, Scalar, Scalars, Stencil, TypeInfo, check_direction, unit_vector,
};
use crate::error::Result;

/// One OnPlane constraint.
#[derive(Clone, Debug)]
pub struct OnPlane {
    /// The unit normal.
    normal: DVec3,
}

impl OnPlane {
    /// The signed distance of `x` from the plane.
    fn height(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        self.normal.dot(x.at(0) - DVec3::from_slice(scalars))
    }
}

impl Constraint for OnPlane {
    const INFO: TypeInfo = TypeInfo {
        name: "OnPlane",
        help: "keeps a point on a plane, by default the level where it was at creation",
        least_indices: 1,
        greatest_indices: Some(1),
        index_names: &["point"],
        scalars: Scalars::Named(&[
            Scalar { name: "x", default: None },
            Scalar { name: "y", default: None },
            Scalar { name: "z", default: None },
            Scalar { name: "nx", default: Some(0.0) },
            Scalar { name: "ny", default: Some(0.0) },
            Scalar { name: "nz", default: Some(1.0) },
        ]),
        rows: Rows::Linear(1),
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(
            include_str!("../solver/gpu/shaders/fixed_place.wgsl"),
            include_str!("../solver/gpu/shaders/on_plane.wgsl")
        ),
        RowUnit::Length,
    );

    fn kernel_numbers(&self, _scalars: &[f64], _size: f64, numbers: &mut Vec<f64>) {
        numbers.extend(self.normal.to_array());
    }

    fn kernel_place(&self, scalars: &[f64]) -> Option<DVec3> {
        Some(DVec3::from_slice(scalars))
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.extend(x.at(0).to_array());
        scalars.extend(DVec3::Z.to_array());
        Self { normal: DVec3::Z }
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        check_direction("normal", &scalars[3..])
    }

    fn scalars_changed(&mut self, scalars: &[f64]) {
        self.normal = unit_vector(&scalars[3..]).unwrap_or(DVec3::Z);
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        coefficients[0] = 1.0;
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        targets[0] = x.at(0) - self.height(scalars, x) * self.normal;
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        self.height(scalars, x).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_drops_onto_the_plane_along_its_normal() {
        // The plane x + y = 2, by a normal of length 5: (3, 3, 7) is at 4/√2, and drops to (1, 1, 7).
        let (points, mut targets) = ([DVec3::new(3.0, 3.0, 7.0)], [DVec3::ZERO]);
        let stencil = Stencil::absolute(&points, &[0]);
        let mut plane = OnPlane::at_rest(stencil, &mut Vec::new());
        let scalars = [2.0, 0.0, -1.0, 12.5_f64.sqrt(), 12.5_f64.sqrt(), 0.0];
        plane.scalars_changed(&scalars);
        plane.project(&scalars, stencil, &mut targets);
        assert!(targets[0].distance(DVec3::new(1.0, 1.0, 7.0)) < 1e-15);
        assert!((plane.violation(&scalars, stencil) - 8.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_normal_of_no_length_is_refused_by_name() {
        assert_eq!(OnPlane::check_scalars(&[1.0, 2.0, 3.0, 0.0, 0.0, 0.0]).unwrap_err().place(), "normal");
        for tiny_or_huge in [1e-300, 1e300] {
            assert!(OnPlane::check_scalars(&[1.0, 2.0, 3.0, tiny_or_huge, 0.0, 0.0]).is_ok());
        }
    }
}
