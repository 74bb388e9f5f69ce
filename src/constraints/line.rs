//! Line: points on a common line.
//!
//! Set: all configurations on some line. Rows: centred. Projection: onto the line through the mean along the eigenvector of
//! the greatest eigenvalue of the scatter `Σ x xᵀ`; nearest. Where two eigenvalues tie, as for coincident points, several lines
//! are equally near and one of them is taken. Violation: the largest distance of a point from the best-fit line, in model
//! units. Nothing can degenerate. Source: Bouaziz et al. 2012, section 3.

use glam::DVec3;

use super::{Constraint, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::small::{scatter, symmetric_eigen};

/// One Line constraint; it has no rest state.
#[derive(Clone, Debug)]
pub struct Line;

fn direction(x: Stencil<'_>) -> DVec3 {
    symmetric_eigen(scatter(x.iter())).1[2]
}

impl Constraint for Line {
    const INFO: TypeInfo = TypeInfo {
        name: "Line",
        help: "keeps points on a common line",
        least_indices: 2,
        greatest_indices: None,
        index_names: &["point"],
        scalars: Scalars::None,
        rows: Rows::Centred,
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(include_str!("../solver/gpu/shaders/line.wgsl"), RowUnit::Length);

    fn at_rest(_x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let direction = direction(x);
        for (target, point) in targets.iter_mut().zip(x.iter()) {
            *target = point.dot(direction) * direction;
        }
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        let direction = direction(x);
        x.iter().map(|point| (point - point.dot(direction) * direction).length()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_zigzag_fall_on_the_line_between_them() {
        // Mean 0 and scatter diag(20, 4 h²): the line is the x axis.
        let zigzag = [[-3.0, 0.1, 0.0], [-1.0, -0.1, 0.0], [1.0, -0.1, 0.0], [3.0, 0.1, 0.0]].map(DVec3::from);
        let stencil = Stencil::centred(&zigzag, &[0, 1, 2, 3]);
        let mut targets = [DVec3::ZERO; 4];
        Line.project(&[], stencil, &mut targets);
        for (target, point) in targets.into_iter().zip(zigzag) {
            assert!((target - DVec3::new(point.x, 0.0, 0.0)).length() < 1e-15);
        }
        assert!((Line.violation(&[], stencil) - 0.1).abs() < 1e-15);
    }
}
