//! Where the asymptotic curve from a point of a boundary meets the next boundary.

use std::ops::ControlFlow;

use glam::DVec3;

use super::tracing::{Options, Sense, Tracer};
use super::{Boundary, Field};
use crate::error::Result;
use crate::mesh::ClosestPoints;
use crate::mesh::reference::ReferenceMesh;

/// Points farther from the mesh than this multiple of its diagonal are on extensions of boundaries beyond it.
const OFF_SURFACE: f64 = 1e-6;

/// A curve is followed for so many times the distance to the next boundary at most.
const LONGEST: f64 = 4.0;

/// Beyond its ends a boundary goes on straight for this part of its length.
const BEYOND: f64 = 0.25;

/// How often the straight continuation of a curve is corrected: each time the distance left falls by the sine of the angle between
/// the curve and the boundary's normal.
const CORRECTIONS: usize = 8;

/// Boundaries that follow each other along a field.
pub(super) struct RulingEnds<'a> {
    reference: &'a ReferenceMesh<'a>,
    field: &'a Field,
    tracer: Tracer<'a>,
    boundaries: Vec<(ClosestPoints, Vec<DVec3>)>,
    diagonal: f64,
}

impl<'a> RulingEnds<'a> {
    /// # Errors
    /// A boundary that is no polyline.
    pub fn new(reference: &'a ReferenceMesh<'a>, field: &'a Field, boundaries: &[&Boundary]) -> Result<Self> {
        let polyline = |boundary: &&Boundary| {
            let mut points = boundary.points.clone();
            match points[..] {
                [a, b, .., y, z] if !boundary.is_closed => {
                    let far = BEYOND * boundary.length();
                    points.insert(0, a + far * (a - b).normalize_or_zero());
                    points.push(z + far * (z - y).normalize_or_zero());
                }
                _ => points.extend(boundary.is_closed.then(|| boundary.points[0])),
            }
            Ok((ClosestPoints::of_polyline(&points, false)?, points))
        };
        let mesh = reference.mesh();
        Ok(Self {
            reference,
            field,
            tracer: Tracer::new(mesh, field, &Options::default())?,
            boundaries: boundaries.iter().map(polyline).collect::<Result<_>>()?,
            diagonal: mesh.diagonal(),
        })
    }

    /// Where the curve from a point of boundary `strip` meets the next one. From a point beyond the mesh, and once the curve has left
    /// it, the curve is a straight line. None where the field is not known.
    pub fn end(&self, strip: usize, point: DVec3) -> Option<DVec3> {
        let (next, corners) = self.boundaries.get(strip + 1)?;
        let at = self.reference.locate(point);
        let mesh = self.reference.mesh();
        let on_mesh = mesh.position(at);
        let direction = self.field.at(mesh, at.triangle as usize, at.weights)?;
        let distance = next.nearest(point).distance(point);
        if on_mesh.distance(point) > OFF_SURFACE * self.diagonal || !(distance > 0.0) {
            return Some(straight(next, point, direction));
        }
        // The field leads to the left of a boundary: a point is before it where it is on the right.
        let side = |x: DVec3| {
            let (nearest, piece) = next.nearest_on_piece(x);
            let along = (corners[piece + 1] - corners[piece]).normalize_or_zero();
            let normal = mesh.normal_at(self.reference.locate(nearest));
            ((x - nearest).dot(normal.cross(along)), nearest)
        };
        let (mut last, mut direction, mut met) = (on_mesh, direction, None);
        let mut before = side(on_mesh).0;
        let follow = self.tracer.follow(at, Sense::Forward, LONGEST * distance, |from, followed| {
            let to = followed.position;
            let (now, _) = side(to);
            if before < 0.0 && now >= 0.0 {
                met = Some(from.lerp(to, before / (before - now)));
                return ControlFlow::Break(());
            }
            (before, last) = (now, to);
            direction = (to - from).try_normalize().unwrap_or(direction);
            ControlFlow::Continue(())
        });
        follow.ok()?;
        Some(met.unwrap_or_else(|| straight(next, last, direction)))
    }
}

/// The point of the straight line from `from` that is nearest to a boundary.
fn straight(next: &ClosestPoints, from: DVec3, direction: DVec3) -> DVec3 {
    let mut at = from;
    for _ in 0..CORRECTIONS {
        at += (next.nearest(at) - at).dot(direction) * direction;
    }
    at
}
