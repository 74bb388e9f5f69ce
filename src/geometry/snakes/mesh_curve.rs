//! Curves of given curvature on a triangle mesh (Bartoň et al. 2013, section 3.3).
//!
//! Over each triangle the mesh counts as the smooth surface fitted around it. Where a step has left the triangle,
//! seen along its normal, its point and its direction are taken over by the patch over the edge: the point by dropping its height
//! there, the direction by projection. Patches of neighbours differ by the fourth order of the edges only.

use std::collections::BTreeMap;
use std::rc::Rc;

use glam::DVec3;

use super::curvature_curve::{
    Course, CurvatureCurve, End, Options, Recorder, check, check_start, last_inside, no_direction,
};
use super::curve_step::{Refusal, State, advance, directed, is_regular, velocity};
use super::face_patch::FacePatch;
use crate::error::{Error, Result, Status};
use crate::mesh::grid::check_finite_point;
use crate::mesh::reference::ReferenceMesh;
use crate::mesh::{SurfacePoint, TriangleMesh};

/// A step is at most this part of the edge of a square as large as the triangle: patches are not used far from their triangle.
const LONGEST_STEP: f64 = 0.5;

/// Steps are not divided into more than so many because triangles are small.
const MOST_PARTS: f64 = 64.0;

/// Triangles that a step goes through at most.
const MOST_CROSSINGS: usize = 256;

/// Over a convex edge there is a wedge that is outside of both triangles. What has come over an edge goes back only where it is
/// further out than this, as a weight of the corner opposite.
const BACK: f64 = -0.05;

/// A curve found on a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshCurve {
    /// The curve; its points are on the smooth surfaces fitted, near the mesh.
    pub curve: CurvatureCurve,
    /// The triangle under each point.
    pub triangles: Vec<u32>,
    /// How often it crossed an edge.
    pub crossing_count: usize,
}

/// The curve that begins at the point of the mesh nearest to `start`, in the direction of `tangent`, of which what is along the
/// normal does not count. Where it would leave the mesh over the boundary it ends there.
///
/// # Errors
/// As [`curvature_curve`](super::curvature_curve::curvature_curve), but for the start: one that is farther from the mesh than the
/// longest edge of the nearest triangle (`start`, status `OutOfDomain`), or where the patch folds (`start`, status `Degenerate`).
pub fn mesh_curve(
    reference: &ReferenceMesh<'_>,
    start: DVec3,
    tangent: DVec3,
    course: &Course<'_>,
    options: &Options,
) -> Result<MeshCurve> {
    check(course, options)?;
    check_finite_point("start", start)?;
    check_finite_point("tangent", tangent)?;
    let at = near(reference, start)?;
    let mut tracer = Tracer { mesh: reference.mesh(), patches: BTreeMap::new() };
    let patch = tracer.patch(at.triangle as usize);
    let flat = patch.flat(reference.mesh().position(at));
    let jet = patch.at(flat[0], flat[1]);
    if !is_regular(&jet) {
        return Err(Error::new(Status::Degenerate, "expected a point where the mesh does not fold").at("start"));
    }
    let rate = directed(&jet, tangent).ok_or_else(|| no_direction(tangent))?;
    let mut place =
        Place { triangle: at.triangle as usize, entered: None, crossing_count: 0, state: State { at: flat, rate } };
    check_start(&jet, &place.state, course)?;
    let mut triangles = vec![at.triangle];
    let mut recorder = Recorder::new(jet.point, velocity(&jet, rate), course.length, options.steps);
    while let Some((along, step)) = recorder.next_step() {
        let mut done = 0.0;
        while done < step {
            let room = LONGEST_STEP * tracer.mesh.area(place.triangle).sqrt();
            let part = (step - done).min(room.max(step / MOST_PARTS));
            let mut take = |factor: f64| tracer.advance(place, course, along + done, factor * part, options);
            let end = match take(1.0) {
                Ok(next) => {
                    place = next;
                    // The last part ends a step to the last bit.
                    done = if part < step - done { done + part } else { step };
                    continue;
                }
                Err(Refusal::Error(error)) => return Err(error),
                Err(Refusal::End(end)) => end,
            };
            let last = if end == End::Boundary { last_inside(|factor| take(factor).ok()) } else { None };
            let last = last.map(|(factor, last)| {
                triangles.push(last.triangle as u32);
                place = last;
                let (point, tangent) = tracer.point(&last);
                (point, tangent, along + done + factor * part)
            });
            return Ok(MeshCurve { curve: recorder.ended(end, last), triangles, crossing_count: place.crossing_count });
        }
        let (point, tangent) = tracer.point(&place);
        recorder.add(point, tangent, along + step);
        triangles.push(place.triangle as u32);
    }
    Ok(MeshCurve { curve: recorder.ended(End::Length, None), triangles, crossing_count: place.crossing_count })
}

/// The nearest point of the mesh, if it is near.
fn near(reference: &ReferenceMesh<'_>, start: DVec3) -> Result<SurfacePoint> {
    let at = reference.locate(start);
    let [a, b, c] = reference.mesh().corners(at.triangle as usize);
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let distance = reference.mesh().position(at).distance(start);
    if distance <= longest {
        return Ok(at);
    }
    let reason =
        format!("expected a point that is nearer to the mesh than an edge is long there, {longest}; found {distance}");
    Err(Error::new(Status::OutOfDomain, reason).at("start"))
}

/// Where a curve is.
#[derive(Clone, Copy)]
struct Place {
    triangle: usize,
    /// The edge that it came in by, while it is not inside of it.
    entered: Option<usize>,
    /// How many edges it has crossed.
    crossing_count: usize,
    /// In the frame of the triangle's patch.
    state: State,
}

struct Tracer<'a> {
    mesh: &'a TriangleMesh,
    patches: BTreeMap<usize, Rc<FacePatch>>,
}

impl Tracer<'_> {
    fn patch(&mut self, triangle: usize) -> Rc<FacePatch> {
        let mesh = self.mesh;
        Rc::clone(self.patches.entry(triangle).or_insert_with(|| Rc::new(FacePatch::new(mesh, triangle))))
    }

    fn point(&mut self, place: &Place) -> (DVec3, DVec3) {
        let [x, y] = place.state.at;
        let jet = self.patch(place.triangle).at(x, y);
        (jet.point, velocity(&jet, place.state.rate))
    }

    /// A step, and from triangle to triangle until one is under where it led.
    fn advance(
        &mut self,
        mut place: Place,
        course: &Course<'_>,
        along: f64,
        step: f64,
        options: &Options,
    ) -> std::result::Result<Place, Refusal> {
        let patch = self.patch(place.triangle);
        place.state = advance(&|x, y| patch.at(x, y), &place.state, course, along, step, options.method)?;
        for _ in 0..MOST_CROSSINGS {
            let weights = self.patch(place.triangle).weights(place.state.at);
            // Over edge k the corner after its end has a negative weight.
            let weight = |edge: usize| weights[(edge + 2) % 3];
            place.entered = place.entered.filter(|&edge| weight(edge) < 0.0);
            let least = |edge: usize| if place.entered == Some(edge) { BACK } else { 0.0 };
            let out =
                (0..3).filter(|&edge| weight(edge) < least(edge)).min_by(|&a, &b| weight(a).total_cmp(&weight(b)));
            let Some(edge) = out else {
                return Ok(place);
            };
            let Some((other, opposite)) = self.mesh.across(place.triangle, edge) else {
                return Err(Refusal::End(End::Boundary));
            };
            place = self.carried(&place, other, opposite).ok_or(Refusal::End(End::Fold))?;
        }
        Err(Refusal::End(End::Fold))
    }

    /// The same place in the frame of another triangle; none where it has no direction there.
    fn carried(&mut self, place: &Place, triangle: usize, entered: usize) -> Option<Place> {
        let (point, tangent) = self.point(place);
        let patch = self.patch(triangle);
        let at = patch.flat(point);
        let jet = patch.at(at[0], at[1]);
        let rate = if is_regular(&jet) { directed(&jet, tangent)? } else { return None };
        let crossing_count = place.crossing_count + 1;
        Some(Place { triangle, entered: Some(entered), crossing_count, state: State { at, rate } })
    }
}
