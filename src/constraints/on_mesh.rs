//! OnMesh: a point on a reference mesh.
//!
//! Set: the points of the triangles. Row: `x`. Projection: the nearest point of all triangles; nearest. Of several that
//! are as near, the one of the first of them. Scalar: `reference`, the id of a mesh among the problem's references,
//! by default the first mesh. Violation: the distance to the mesh in model units. Triangles of no area are
//! points or segments like any other, so nothing can degenerate. Sources: Bouaziz et al. 2012, section 3 (shape
//! constraints by closest points); how it is found: `mesh/closest.rs`.

use std::sync::Arc;

use glam::DVec3;

use super::{Constraint, Projection, ReferenceKind, ReferenceShape, Rows, Scalar, Scalars, Stencil, TypeInfo};

/// One OnMesh constraint.
#[derive(Clone, Debug)]
pub struct OnMesh {
    /// `None` only until the constraint was handed its reference.
    shape: Option<Arc<ReferenceShape>>,
}

impl OnMesh {
    fn nearest(&self, point: DVec3) -> DVec3 {
        self.shape.as_ref().map_or(point, |shape| shape.nearest(point))
    }
}

impl Constraint for OnMesh {
    const INFO: TypeInfo = TypeInfo {
        name: "OnMesh",
        help: "keeps a point on a reference mesh",
        least_indices: 1,
        greatest_indices: Some(1),
        index_names: &["point"],
        scalars: Scalars::Named(&[Scalar { name: "reference", default: None }]),
        rows: Rows::Linear(1),
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const REFERENCE: Option<ReferenceKind> = Some(ReferenceKind::Mesh);

    fn at_rest(_x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.push(0.0);
        Self { shape: None }
    }

    fn refer_to(&mut self, shape: &Arc<ReferenceShape>) {
        self.shape = Some(Arc::clone(shape));
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        coefficients[0] = 1.0;
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        targets[0] = self.nearest(x.at(0));
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        x.at(0).distance(self.nearest(x.at(0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_beside_an_edge_goes_to_its_foot() {
        // (1, 3, 4) lies at the distance 5 from the edge on the x axis, beyond which there is no triangle.
        let corners = [DVec3::ZERO, 2.0 * DVec3::X, DVec3::new(1.0, -2.0, -1.0)];
        let shape = ReferenceShape::mesh(&corners, &[[0, 1, 2]]).unwrap();
        let (mut scalars, points) = (Vec::new(), [DVec3::new(1.0, 3.0, 4.0)]);
        let stencil = Stencil::absolute(&points, &[0]);
        let mut constraint = OnMesh::at_rest(stencil, &mut scalars);
        constraint.refer_to(&Arc::new(shape));
        let mut targets = [DVec3::ZERO];
        constraint.project(&scalars, stencil, &mut targets);
        assert!(targets[0].distance(DVec3::X) < 1e-15, "{}", targets[0]);
        assert!((constraint.violation(&scalars, stencil) - 5.0).abs() < 1e-15);
    }
}
