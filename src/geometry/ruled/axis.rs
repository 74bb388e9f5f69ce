//! The direction that unit vectors, such as those of rulings, are most nearly orthogonal to.

use glam::DVec3;

use super::Field;
use crate::linalg::dense::Svd;
use crate::mesh::TriangleMesh;
use crate::mesh::triangles::{SurfacePoint, blend};

/// A direction that all of some unit vectors are nearly orthogonal to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// The direction, a unit vector up to its sign.
    pub direction: DVec3,
    /// The root mean square of `a·w`: the sine of the angle to the plane, about.
    pub error: f64,
    /// The least singular value over the largest: 0 if all are orthogonal to it.
    pub flatness: f64,
    /// The middle singular value over the largest: 0 if all are parallel, so that any direction across them is as good.
    pub spread: f64,
}

impl Axis {
    /// The axis of some unit vectors; none without any, or if they are not finite.
    pub fn new(directions: &[DVec3]) -> Option<Self> {
        let column = |k: usize| directions.iter().map(|a| a[k]).collect::<Vec<f64>>();
        let svd = Svd::new(directions.len(), &[column(0), column(1), column(2)])?;
        let s = svd.singular_values();
        let direction = DVec3::from_slice(&svd.least_vector());
        let first = *s.first()?;
        let part = |k: usize| s.get(k).filter(|_| first > 0.0).map_or(0.0, |value| value / first);
        let squares: f64 = directions.iter().map(|a| a.dot(direction).powi(2)).sum();
        let error = (squares / directions.len() as f64).sqrt();
        Some(Self { direction, error, flatness: part(2), spread: part(1) })
    }

    /// The axis of the field at some points of its mesh; points where it is not known are left out. For a strip, give the points of
    /// both boundaries.
    pub fn of_points(mesh: &TriangleMesh, field: &Field, points: &[SurfacePoint]) -> Option<Self> {
        field.check(mesh).ok()?;
        let direction = |at: &SurfacePoint| {
            let corners = mesh.triangles().get(at.triangle as usize)?.map(|i| i as usize);
            let is_known = (0..3).all(|k| at.weights[k] == 0.0 || field.is_known()[corners[k]]);
            let blended = blend(corners.map(|i| field.directions()[i]), at.weights);
            if is_known { blended.try_normalize() } else { None }
        };
        Self::new(&points.iter().filter_map(direction).collect::<Vec<_>>())
    }
}
