//! Reference shapes: polylines and triangle meshes that constraints refer to by their ids.
//!
//! They belong to the [`ConstraintSet`](super::ConstraintSet). A type that says which kind it takes
//! ([`Constraint::REFERENCE`](super::Constraint::REFERENCE)) names one in its first scalar, and is handed the shape when a
//! constraint is added or its scalars are edited. Constraints share shapes, and so do copies of a set.

use std::fmt;
use std::sync::Arc;

use glam::DVec3;

use crate::error::{Error, Result, Status};
use crate::mesh::ClosestPoints;

/// The number of a reference: they count up from 0.
pub type ReferenceId = usize;

/// What a reference shape is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReferenceKind {
    /// Segments from point to point.
    Polyline,
    /// Triangles.
    Mesh,
}

impl fmt::Display for ReferenceKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Polyline => "polyline",
            Self::Mesh => "mesh",
        })
    }
}

/// A reference shape, ready to be asked for its nearest points.
#[derive(Clone, Debug)]
pub struct ReferenceShape {
    kind: ReferenceKind,
    points: ClosestPoints,
}

impl ReferenceShape {
    /// The polyline through `points`, closed or not.
    ///
    /// # Errors
    /// As [`ClosestPoints::of_polyline`].
    pub fn polyline(points: &[DVec3], is_closed: bool) -> Result<Self> {
        Ok(Self { kind: ReferenceKind::Polyline, points: ClosestPoints::of_polyline(points, is_closed)? })
    }

    /// The mesh of `triangles`, each three indices into `points`.
    ///
    /// # Errors
    /// As [`ClosestPoints::of_triangles`].
    pub fn mesh(points: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self> {
        Ok(Self { kind: ReferenceKind::Mesh, points: ClosestPoints::of_triangles(points, triangles)? })
    }

    /// What it is.
    pub fn kind(&self) -> ReferenceKind {
        self.kind
    }

    /// Its nearest point, as [`ClosestPoints::nearest`].
    pub fn nearest(&self, point: DVec3) -> DVec3 {
        self.points.nearest(point)
    }
}

/// All references of a set, by id.
#[derive(Clone, Debug, Default)]
pub(super) struct References(Vec<Arc<ReferenceShape>>);

impl References {
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    pub(super) fn push(&mut self, shape: ReferenceShape) -> ReferenceId {
        self.0.push(Arc::new(shape));
        self.0.len() - 1
    }

    /// The first of a kind.
    pub(super) fn first(&self, kind: ReferenceKind) -> Result<ReferenceId> {
        self.0.iter().position(|shape| shape.kind == kind).ok_or_else(|| {
            let reason = format!("expected the id of a {kind}, found none among {} references", self.0.len());
            Error::new(Status::InvalidValue, reason).at("scalars[0]")
        })
    }

    /// The one that a scalar names, which must be of a kind.
    pub(super) fn named(&self, kind: ReferenceKind, scalar: f64) -> Result<&Arc<ReferenceShape>> {
        let refuse = |status, reason: String| Err(Error::new(status, reason).at("scalars[0]"));
        if !(scalar >= 0.0 && scalar.fract() == 0.0) {
            return refuse(Status::InvalidValue, format!("expected the id of a {kind}, found {scalar}"));
        }
        // Beyond the range of usize the cast gives its end, which is out of range here too.
        match self.0.get(scalar as usize) {
            Some(shape) if shape.kind == kind => Ok(shape),
            Some(shape) => {
                let reason = format!("expected the id of a {kind}, found {scalar}, which is a {}", shape.kind);
                refuse(Status::InvalidValue, reason)
            }
            None => {
                let reason = format!("{scalar} is out of range for {} references", self.0.len());
                refuse(Status::IndexOutOfRange, reason)
            }
        }
    }
}
