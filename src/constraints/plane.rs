//! Plane: points on a common plane.
//!
//! Set: all configurations on some plane. Rows: centred. Projection: onto the plane through the mean whose normal is
//! the eigenvector of the least eigenvalue of the scatter `Σ x xᵀ`; nearest. Points on a line are on a plane already:
//! whatever the eigenvector, they stay. Signatures may call it PlanarPolygon. Violation: the largest distance of a
//! point from the best-fit plane, in model units. Sources: Bouaziz et al. 2012, section 3; Deuss et al. 2015, Table 1.

use glam::DVec3;

use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::lanes::{self, Mask, V4};
use crate::linalg::simd::Isa;
use crate::linalg::small::{least_eigenvector, scatter};

/// One Plane constraint; it has no rest state.
///
/// For the corners of a face that is a planar polygon, of any number of them; "PlanarPolygon" is another name of the
/// type.
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

    const ALIAS: Option<&'static str> = Some("PlanarPolygon");

    const KERNEL: Kernel = Kernel::Wgsl(include_str!("../solver/gpu/shaders/plane.wgsl"), RowUnit::Length);

    fn at_rest(_x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let normal = least_eigenvector(scatter(x.iter()));
        for (target, point) in targets.iter_mut().zip(x.iter()) {
            *target = point - point.dot(normal) * normal;
        }
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        lanes::flatten(four.simd, x, targets)
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        let normal = least_eigenvector(scatter(x.iter()));
        x.iter().map(|point| point.dot(normal).abs()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_planar_polygon_is_another_name() {
        let found = super::super::TypeIndex::named("PlanarPolygon").unwrap();
        assert_eq!(found.info().name, "Plane");
    }

    #[test]
    fn a_warped_square_is_flattened_between_its_corners() {
        // Corners alternately h above and below z = 7: by symmetry the plane is z = 7.
        let points = [[0.0, 0.0, 7.1], [1.0, 0.0, 6.9], [1.0, 1.0, 7.1], [0.0, 1.0, 6.9]].map(DVec3::from);
        let stencil = Stencil::centred(&points, &[0, 1, 2, 3]);
        let mut targets = [DVec3::ZERO; 4];
        Plane.project(&[], stencil, &mut targets);
        for (target, point) in targets.into_iter().zip(points) {
            assert!((target - DVec3::new(point.x - 0.5, point.y - 0.5, 0.0)).length() < 1e-15);
        }
        assert!((Plane.violation(&[], stencil) - 0.1).abs() < 1e-15);
    }

    #[test]
    fn points_on_a_line_stay() {
        let points = [0.0, 1.0, 5.0].map(|x| DVec3::new(x, -x, 2.0 * x));
        assert!(Plane.violation(&[], Stencil::centred(&points, &[0, 1, 2])) < 1e-15);
    }
}
