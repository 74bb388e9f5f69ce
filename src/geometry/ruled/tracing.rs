//! Asymptotic curves: integral curves of a field on a triangle mesh (Flöry et al. 2012, figure 5).
//!
//! A step goes straight over the triangles ([`Walker`]), and is one of the midpoint rule. The direction halfway is compared
//! with the one that the half step arrives with, and the step goes off turned by the angle between them: no vector is ever
//! carried from one tangent plane to another but along the walk. The rule is of second order in the step, as the field is in
//! the edges.
//!
//! Signs of the field are only heeded at the start. From then on the vectors of corners count as lines and are taken the way that
//! the curve goes: curves cross the edges at which the signs of a field that has none flip.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Field;
use crate::error::{Error, Result, Status};
use crate::mesh::triangles::blend;
use crate::mesh::walk::{Halt, Walker};
use crate::mesh::{SurfacePoint, TriangleMesh};

/// The edge of an equilateral triangle of area 1.
const EQUILATERAL_EDGE: f64 = 1.519_671_371_303_185;

/// Weights of a start may add up to 1 within this.
const WEIGHTS: f64 = 1e-9;

/// What is left of the length after the last step may be this part of a step: round-off of a sum.
const NOTHING_LEFT: f64 = 1e-9;

/// How steps are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The length of a step, as a part of the edge of an equilateral triangle as large as that which the step begins in: above
    /// 0 and at most 0.5.
    pub step: f64,
    /// Steps at most; at least 1.
    pub most_steps: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { step: 0.5, most_steps: 100_000 }
    }
}

/// Which way a curve goes from its start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// As the field's vector points at the corner nearest to the start.
    Forward,
    /// Against it.
    Backward,
}

/// Why a curve ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// At the boundary.
    Boundary,
    /// The next triangle has a corner where the direction is not known, or one at which directions cancel; perhaps the first.
    Unknown,
    /// The length asked for is reached.
    Length,
    /// All steps were used.
    Steps,
    /// The caller asked for it.
    Caller,
}

/// Where a curve ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Followed {
    /// The last point, on the mesh.
    pub at: SurfacePoint,
    /// Where that is.
    pub position: DVec3,
    /// The length of the curve, in model units.
    pub length: f64,
    /// Why it ends there.
    pub end: End,
}

/// An asymptotic polyline.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// Its points, the start first; at least that.
    pub positions: Vec<DVec3>,
    /// The same, on the mesh.
    pub points: Vec<SurfacePoint>,
    /// The length of the curve from the start to each point, in model units, measured over the triangles.
    pub lengths: Vec<f64>,
    /// Why it ends.
    pub end: End,
}

/// Follows the curves of a field.
#[derive(Clone, Debug)]
pub struct Tracer<'a> {
    mesh: &'a TriangleMesh,
    field: &'a Field,
    options: Options,
    is_unknown: Vec<bool>,
}

impl<'a> Tracer<'a> {
    /// A tracer on the mesh of a field.
    ///
    /// # Errors
    /// The field has not one vector for each point (`field`), or an option is out of its range (`step`, `most_steps`).
    pub fn new(mesh: &'a TriangleMesh, field: &'a Field, options: &Options) -> Result<Self> {
        let (expected, found) = (mesh.points().len(), field.directions().len());
        if expected != found {
            let reason = format!("expected a vector for each of {expected} points, found {found}");
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("field"));
        }
        if !(options.step > 0.0 && options.step <= 0.5) {
            let reason = format!("expected above 0 and at most 0.5, found {}", options.step);
            return Err(Error::new(Status::InvalidValue, reason).at("step"));
        }
        if options.most_steps == 0 {
            return Err(Error::new(Status::InvalidValue, "expected at least 1, found 0").at("most_steps"));
        }
        let is_known = field.is_known();
        let is_unknown = mesh.triangles().iter().map(|corners| corners.iter().any(|&i| !is_known[i as usize]));
        Ok(Self { mesh, field, options: *options, is_unknown: is_unknown.collect() })
    }

    /// The curve from `start`, of `length` model units at most. For the point of the mesh nearest to a seed see
    /// [`ReferenceMesh::locate`](crate::mesh::reference::ReferenceMesh::locate).
    ///
    /// # Errors
    /// As [`Tracer::follow`].
    pub fn trace(&self, start: SurfacePoint, sense: Sense, length: f64) -> Result<Trace> {
        self.check(start, length)?;
        let (mut points, mut positions, mut lengths) = (vec![start], vec![self.mesh.position(start)], vec![0.0]);
        let end = self.steps(start, sense, length, |_, followed| {
            points.push(followed.at);
            positions.push(followed.position);
            lengths.push(followed.length);
            ControlFlow::Continue(())
        });
        Ok(Trace { positions, points, lengths, end: end.end })
    }

    /// Follows the curve from `start` for `length` model units at most. `step` is called with where a step began and with where
    /// the curve then is, after every step, and can end the curve there. Nothing is allocated.
    ///
    /// # Errors
    /// `start` is no point of the mesh, or `length` is not above 0 or not finite.
    pub fn follow(
        &self,
        start: SurfacePoint,
        sense: Sense,
        length: f64,
        mut step: impl FnMut(DVec3, &Followed) -> ControlFlow<()>,
    ) -> Result<Followed> {
        self.check(start, length)?;
        Ok(self.steps(start, sense, length, &mut step))
    }

    fn check(&self, start: SurfacePoint, length: f64) -> Result<()> {
        let count = self.mesh.triangles().len();
        if start.triangle as usize >= count {
            let reason = format!("triangle {} is out of range for {count} triangles", start.triangle);
            return Err(Error::new(Status::IndexOutOfRange, reason).at("start"));
        }
        let sum: f64 = start.weights.iter().sum();
        if !(start.weights.iter().all(|&weight| weight >= 0.0) && (sum - 1.0).abs() <= WEIGHTS) {
            let reason = format!("expected weights of at least 0 that add up to 1, found {:?}", start.weights);
            return Err(Error::new(Status::InvalidValue, reason).at("start"));
        }
        if !(length > 0.0 && length.is_finite()) {
            let reason = format!("expected a finite number above 0, found {length}");
            return Err(Error::new(Status::InvalidValue, reason).at("length"));
        }
        Ok(())
    }

    fn steps(
        &self,
        start: SurfacePoint,
        sense: Sense,
        length: f64,
        mut step: impl FnMut(DVec3, &Followed) -> ControlFlow<()>,
    ) -> Followed {
        let mut found = Followed { at: start, position: self.mesh.position(start), length: 0.0, end: End::Unknown };
        let mut walker = Walker { at: start, heading: self.first_heading(start, sense) };
        for _ in 0..self.options.most_steps {
            let triangle = walker.at.triangle as usize;
            let whole = self.options.step * EQUILATERAL_EDGE * self.mesh.area(triangle).sqrt();
            let is_last = length - found.length <= (1.0 + NOTHING_LEFT) * whole;
            let wanted = if is_last { length - found.length } else { whole };
            if self.is_unknown[triangle] || !self.aim(&mut walker, wanted) {
                return Followed { end: End::Unknown, ..found };
            }
            let (walked, halt) = self.walk(&mut walker, wanted);
            let from = found.position;
            if walked > 0.0 {
                found.at = walker.at;
                found.position = self.mesh.position(walker.at);
                found.length += walked;
                if step(from, &found).is_break() {
                    return Followed { end: End::Caller, ..found };
                }
            }
            match halt {
                Halt::Boundary => return Followed { end: End::Boundary, ..found },
                Halt::Blocked => return Followed { end: End::Unknown, ..found },
                Halt::Arrived if is_last => return Followed { end: End::Length, ..found },
                Halt::Arrived => {}
            }
        }
        Followed { end: End::Steps, ..found }
    }

    fn walk(&self, walker: &mut Walker, distance: f64) -> (f64, Halt) {
        walker.walk(self.mesh, distance, |triangle| self.is_unknown[triangle])
    }

    fn first_heading(&self, start: SurfacePoint, sense: Sense) -> DVec3 {
        let corners = self.mesh.triangles()[start.triangle as usize];
        let nearest = (1..3).fold(0, |best, k| if start.weights[k] > start.weights[best] { k } else { best });
        let vector = self.field.directions()[corners[nearest] as usize];
        if sense == Sense::Forward { vector } else { -vector }
    }

    /// Gives the walker the direction of a step of this length: false if there is none.
    fn aim(&self, walker: &mut Walker, length: f64) -> bool {
        let Some(first) = self.direction(walker) else { return false };
        walker.heading = first;
        let mut halfway = *walker;
        let (_, halt) = self.walk(&mut halfway, 0.5 * length);
        let Some(mut middle) = self.direction(&halfway) else { return true };
        if halt != Halt::Arrived {
            // The step ends about there: halfway it has turned by half.
            middle = (middle + halfway.heading).try_normalize().unwrap_or(middle);
        }
        let normal = self.mesh.normal(halfway.at.triangle as usize);
        let (cosine, sine) = (halfway.heading.dot(middle), normal.dot(halfway.heading.cross(middle)));
        let aside = self.mesh.normal(walker.at.triangle as usize).cross(first);
        walker.heading = (cosine * first + sine * aside).normalize();
        true
    }

    /// The line of the field where the walker is, the way that it goes, in the plane of its triangle.
    fn direction(&self, walker: &Walker) -> Option<DVec3> {
        let triangle = walker.at.triangle as usize;
        let vectors = self.mesh.triangles()[triangle].map(|i| self.field.directions()[i as usize]);
        let ahead = vectors.map(|vector| vector * vector.dot(walker.heading).signum());
        blend(ahead, walker.at.weights).reject_from_normalized(self.mesh.normal(triangle)).try_normalize()
    }
}

#[cfg(test)]
mod tests;
