//! Plane: points on a common plane.
//!
//! Set: all configurations on some plane. Rows: centred. Projection: onto the plane through the mean whose normal is the
//! eigenvector of the least eigenvalue of the scatter `Σ x xᵀ`; nearest. Points on a line are on a plane already: whatever
//! the eigenvector, they stay. Violation: the largest distance of a point from the best-fit plane, in model units.
//! Sources: Bouaziz et al. 2012, section 3; Deuss et al. 2015, Table 1.

use glam::DVec3;

use super::{Constraint, Projection, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::small::{least_eigenvector, scatter};

/// One Plane constraint; it has no rest state.
#[derive(Clone, Debug)]
pub struct Plane;

impl Constraint for Plane {
    const INFO: TypeInfo = TypeInfo {
        name: "Plane",
        help: "keeps points on a common plane",
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

    fn at_rest(_x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let normal = least_eigenvector(scatter(x.iter()));
        for (target, point) in targets.iter_mut().zip(x.iter()) {
            *target = point - point.dot(normal) * normal;
        }
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        let normal = least_eigenvector(scatter(x.iter()));
        x.iter().map(|point| point.dot(normal).abs()).fold(0.0, f64::max)
    }
}
