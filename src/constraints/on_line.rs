//! OnLine: a point on a given line.
//!
//! Set: `x = c + t d`. Row: `x`. Projection: `c + (d·(x − c)) d` with `d` a unit vector; nearest. Scalars: `x y z` of a
//! point `c` of the line in model units, by default where the point was at creation, and `dx dy dz` of its direction,
//! of any length but 0, by default (0, 0, 1): the plumb line through the point. Violation: the distance from the line
//! in model units. Nothing can degenerate. Source: elementary.

use glam::DVec3;

use super::{
    Constraint, Kernel, Projection, RowUnit, Rows, Scalar, Scalars, Stencil, TypeInfo, check_direction, unit_vector,
};
use crate::error::Result;

/// One OnLine constraint.
#[derive(Clone, Debug)]
pub struct OnLine {
    /// The unit direction.
    direction: DVec3,
}

impl OnLine {
    fn nearest(&self, scalars: &[f64], x: Stencil<'_>) -> DVec3 {
        let point = DVec3::from_slice(scalars);
        point + self.direction.dot(x.at(0) - point) * self.direction
    }
}

impl Constraint for OnLine {
    const INFO: TypeInfo = TypeInfo {
        name: "OnLine",
        help: "keeps a point on a line, by default the plumb line through where it was at creation",
        least_indices: 1,
        greatest_indices: Some(1),
        index_names: &["point"],
        scalars: Scalars::Named(&[
            Scalar { name: "x", default: None },
            Scalar { name: "y", default: None },
            Scalar { name: "z", default: None },
            Scalar { name: "dx", default: Some(0.0) },
            Scalar { name: "dy", default: Some(0.0) },
            Scalar { name: "dz", default: Some(1.0) },
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
            include_str!("../solver/gpu/shaders/on_line.wgsl")
        ),
        RowUnit::Length,
    );

    fn kernel_numbers(&self, _scalars: &[f64], _size: f64, numbers: &mut Vec<f64>) {
        numbers.extend(self.direction.to_array());
    }

    fn kernel_place(&self, scalars: &[f64]) -> Option<DVec3> {
        Some(DVec3::from_slice(scalars))
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.extend(x.at(0).to_array());
        scalars.extend(DVec3::Z.to_array());
        Self { direction: DVec3::Z }
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        check_direction("direction", &scalars[3..])
    }

    fn scalars_changed(&mut self, scalars: &[f64]) {
        self.direction = unit_vector(&scalars[3..]).unwrap_or(DVec3::Z);
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        coefficients[0] = 1.0;
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        targets[0] = self.nearest(scalars, x);
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        x.at(0).distance(self.nearest(scalars, x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_goes_to_its_foot_on_the_line() {
        // The line through (0, 0, 1) along (2, 2, 0): the foot of (4, 0, 1) is (2, 2, 1), at a distance of √8.
        let (points, mut targets) = ([DVec3::new(4.0, 0.0, 1.0)], [DVec3::ZERO]);
        let stencil = Stencil::absolute(&points, &[0]);
        let mut line = OnLine::at_rest(stencil, &mut Vec::new());
        let scalars = [0.0, 0.0, 1.0, 2.0, 2.0, 0.0];
        line.scalars_changed(&scalars);
        line.project(&scalars, stencil, &mut targets);
        assert!(targets[0].distance(DVec3::new(2.0, 2.0, 1.0)) < 1e-15);
        assert!((line.violation(&scalars, stencil) - 8.0_f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn a_direction_of_no_length_is_refused_by_name() {
        assert_eq!(OnLine::check_scalars(&[0.0; 6]).unwrap_err().place(), "direction");
    }
}
