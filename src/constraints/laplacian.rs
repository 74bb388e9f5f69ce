//! Laplacian: a point at the mean of its neighbours.
//!
//! Set: `{0}` for the uniform Laplacian. Row: `(mean of the neighbours) − x₀`. Projection: 0, whatever `x` is; nearest. No
//! scalars. Violation: the distance of the point from the mean of its neighbours, in model units. Nothing can degenerate.
//! Source: Bouaziz et al. 2012, section 4.

use glam::DVec3;

use super::{Constraint, Kernel, Projection, Rows, Scalars, Stencil, TypeInfo};

/// One Laplacian constraint; it has no rest state.
#[derive(Clone, Debug)]
pub struct Laplacian;

/// The coefficients of the uniform Laplacian, for a center first and then its neighbours.
pub(super) fn uniform_row(coefficients: &mut [f64]) {
    let share = 1.0 / (coefficients.len() - 1) as f64;
    coefficients.fill(share);
    coefficients[0] = -1.0;
}

/// The uniform Laplacian of `x`.
pub(super) fn uniform_laplacian(x: Stencil<'_>) -> DVec3 {
    let center = x.at(0);
    x.iter().skip(1).map(|neighbour| neighbour - center).sum::<DVec3>() / (x.len() - 1) as f64
}

impl Constraint for Laplacian {
    const INFO: TypeInfo = TypeInfo {
        name: "Laplacian",
        help: "draws a point to the mean of its neighbours",
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

    fn at_rest(_x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        uniform_row(coefficients);
    }

    fn project(&self, _scalars: &[f64], _x: Stencil<'_>, targets: &mut [DVec3]) {
        targets[0] = DVec3::ZERO;
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        uniform_laplacian(x).length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_violation_is_the_distance_from_the_mean_of_the_neighbours() {
        let points = [[1.0, 1.0, 5.0], [0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 3.0, 3.0]].map(DVec3::from);
        // The mean is (1, 1, 1).
        assert!((Laplacian.violation(&[], Stencil::absolute(&points, &[0, 1, 2, 3])) - 4.0).abs() < 1e-15);
    }
}
