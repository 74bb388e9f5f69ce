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

/// Shapes for tests.
#[cfg(test)]
pub(super) mod samples {
    use super::super::ConstraintSet;
    use super::super::laws::Stream;
    use super::*;

    /// One of three shapes: a crumpled one, one of a single piece, and one with pieces that are points or segments.
    pub(in super::super) fn reference(
        kind: ReferenceKind,
        which: u64,
        place: impl Fn(DVec3) -> DVec3,
    ) -> ReferenceShape {
        let mut points = Stream(which).vectors(if which == 1 { 3 } else { 20 });
        if which == 2 {
            (points[1], points[6]) = (points[0], points[5].lerp(points[7], 0.3));
        }
        let points: Vec<DVec3> = points.into_iter().map(place).collect();
        match kind {
            ReferenceKind::Polyline => ReferenceShape::polyline(&points, which == 0),
            ReferenceKind::Mesh => {
                let triangles: Vec<[u32; 3]> = (0..points.len() as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
                ReferenceShape::mesh(&points, &triangles)
            }
        }
        .unwrap()
    }

    /// A set with a polyline, then a mesh, and no constraint.
    pub(in super::super) fn with_references() -> ConstraintSet {
        let mut set = ConstraintSet::default();
        for kind in [ReferenceKind::Polyline, ReferenceKind::Mesh] {
            set.add_reference(reference(kind, 0, |point| point));
        }
        set
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ConstraintSet, NewConstraints};
    use super::samples::with_references;
    use super::*;

    #[test]
    fn a_scalar_that_names_no_reference_of_the_kind_is_refused_and_changes_nothing() {
        for (type_name, kind) in [("OnCurve", ReferenceKind::Polyline), ("OnMesh", ReferenceKind::Mesh)] {
            let new = |scalars: &'static [f64]| NewConstraints {
                type_name,
                indices: &[0],
                counts: &[1],
                weights: &[1.0],
                scalars,
                scalar_counts: if scalars.is_empty() { &[] } else { &[1] },
            };
            let (rest, mut set) = ([DVec3::ZERO], ConstraintSet::default());
            let refused = |result: Result<usize>| result.unwrap_err().to_string();
            let nothing = refused(set.add(&rest, new(&[]), |id| format!("constraints[{id}]")));
            let words =
                format!("constraints[0].scalars[0]: expected the id of a {kind}, found none among 0 references");
            assert_eq!(nothing, words);
            let mut set = with_references();
            let id = set.add(&rest, new(&[]), |id| id.to_string()).unwrap();
            let own = if kind == ReferenceKind::Mesh { 1.0 } else { 0.0 };
            assert_eq!(set.get(id).unwrap().scalars, [own]);
            assert_eq!(set.add(&rest, new(if own == 1.0 { &[1.0] } else { &[0.0] }), |id| id.to_string()), Ok(1));
            let other = if own == 1.0 { "0, which is a polyline" } else { "1, which is a mesh" };
            for (wrong, found) in [
                (&[2.0][..], "2 is out of range for 2 references"),
                (&[1e300], "is out of range for 2 references"),
                (&[0.5], "found 0.5"),
                (&[-1.0], "found -1"),
                (if own == 1.0 { &[0.0] } else { &[1.0] }, other),
            ] {
                let added = refused(set.add(&rest, new(wrong), |id| format!("constraints[{id}]")));
                assert!(added.starts_with("constraints[2].scalars[0]: ") && added.contains(found), "{added}");
                let edited = set.edit(type_name, id, wrong).unwrap_err();
                assert!(edited.place() == "scalars[0]" && edited.to_string().contains(found), "{edited}");
                assert_eq!((set.get(id).unwrap().scalars, set.id_count()), (&[own][..], 2));
            }
        }
    }

    #[test]
    fn copies_of_a_set_share_references_and_an_edit_takes_another_one() {
        let mut set = with_references();
        let line = [DVec3::ZERO, DVec3::X];
        let far = set.add_reference(ReferenceShape::polyline(&line.map(|point| point + DVec3::Z), false).unwrap());
        let new = NewConstraints {
            type_name: "OnCurve",
            indices: &[0],
            counts: &[1],
            weights: &[1.0],
            scalars: &[],
            scalar_counts: &[],
        };
        let points = [DVec3::new(0.5, 0.0, 4.0)];
        let id = set.add(&points, new, |id| id.to_string()).unwrap();
        set.edit("OnCurve", id, &[far as f64]).unwrap();
        let copy = set.clone();
        assert_eq!((set.violations(&points), copy.violations(&points)), (vec![3.0], vec![3.0]));
        assert_eq!(copy.reference_count(), 3);
        set.edit("OnCurve", id, &[0.0]).unwrap();
        assert!(set.violations(&points) != copy.violations(&points));
    }
}
