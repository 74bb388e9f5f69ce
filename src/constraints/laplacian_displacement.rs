//! LaplacianDisplacement: a point that keeps its place relative to the mean of its neighbours.
//!
//! Set: `{l}`, the uniform Laplacian at creation; it does not turn with the model. Row: `(mean of the neighbours) − x₀`.
//! Projection: `l`, whatever `x` is; nearest. No scalars. Violation: the distance of the Laplacian from `l`, in model units.
//! Nothing can degenerate. Source: Bouaziz et al. 2012, section 4.

use glam::DVec3;

use super::laplacian::{uniform_laplacian, uniform_row};
use super::{Constraint, Kernel, Projection, Rows, Scalars, Stencil, TypeInfo};

/// One LaplacianDisplacement constraint: the Laplacian at creation.
#[derive(Clone, Debug)]
pub struct LaplacianDisplacement(DVec3);

impl Constraint for LaplacianDisplacement {
    const INFO: TypeInfo = TypeInfo {
        name: "LaplacianDisplacement",
        help: "keeps the place of a point relative to the mean of its neighbours as at creation",
        least_indices: 2,
        greatest_indices: None,
        index_names: &["center", "neighbour"],
        scalars: Scalars::None,
        rows: Rows::Linear(1),
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Constant;

    fn at_rest(x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self(uniform_laplacian(x))
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        uniform_row(coefficients);
    }

    fn project(&self, _scalars: &[f64], _x: Stencil<'_>, targets: &mut [DVec3]) {
        targets[0] = self.0;
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        uniform_laplacian(x).distance(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shift_of_all_keeps_it_and_a_shift_of_the_center_does_not() {
        let points = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.5, 0.0]].map(DVec3::from);
        let all = &[0, 1, 2];
        let displacement = LaplacianDisplacement::at_rest(Stencil::absolute(&points, all), &mut Vec::new());
        assert_eq!(displacement.0, DVec3::new(0.0, 0.25, -1.0));
        let shifted = points.map(|point| point + 0.5);
        assert!(displacement.violation(&[], Stencil::absolute(&shifted, all)) < 1e-15);
        let raised = [points[0] + DVec3::Z, points[1], points[2]];
        assert_eq!(displacement.violation(&[], Stencil::absolute(&raised, all)), 1.0);
    }
}
