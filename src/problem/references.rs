//! Reference shapes as plain data.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::constraints::ReferenceShape;
use crate::error::Result;

/// A shape that constraints refer to: `OnCurve` to a polyline, `OnMesh` to a mesh. Its id is its place among the references,
/// and the first scalar of the constraint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Reference {
    /// Segments from point to point.
    Polyline {
        /// At least 2, each `[x, y, z]` in model units.
        points: Vec<[f64; 3]>,
        /// True if a segment leads from the last point back to the first.
        #[serde(default)]
        closed: bool,
    },
    /// Triangles.
    Mesh {
        /// Each `[x, y, z]` in model units.
        points: Vec<[f64; 3]>,
        /// At least one, each three indices into `points`.
        triangles: Vec<[u32; 3]>,
    },
}

impl Reference {
    /// The name of its kind in the JSON form.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Polyline { .. } => "polyline",
            Self::Mesh { .. } => "mesh",
        }
    }

    /// The shape as constraints ask it for nearest points.
    ///
    /// # Errors
    /// A coordinate is not finite, a polyline has fewer than 2 points, a mesh no triangle, or an index is out of range. The
    /// place is `points`, `points[i]`, `triangles` or `triangles[i][j]`.
    pub fn shape(&self) -> Result<ReferenceShape> {
        let vectors = |points: &[[f64; 3]]| points.iter().copied().map(DVec3::from_array).collect::<Vec<_>>();
        match self {
            Self::Polyline { points, closed } => ReferenceShape::polyline(&vectors(points), *closed),
            Self::Mesh { points, triangles } => ReferenceShape::mesh(&vectors(points), triangles),
        }
    }
}
