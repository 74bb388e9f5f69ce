//! Asymptotic curves: integral curves of a field on a triangle mesh (Flöry et al. 2012, figure 5).
//!
//! A step goes straight over the triangles: at an edge the direction is turned about it into the plane of the next triangle, as if
//! both were unfolded, so that the walk never leaves the mesh. Weights of corners are what is walked in: a corner's weight falls at a
//! constant rate in a triangle, and the first to reach 0 tells the edge, exactly. The edge that a triangle was entered by is none
//! that a straight line can leave by, and is not asked: round-off cannot send the walk back and forth, and at a point of the mesh it
//! goes around in one sense until the direction is inside a triangle.
//!
//! A step of length `h` is one of the midpoint rule. The direction halfway is compared with the one that the half step arrives with,
//! and the step goes off turned by the angle between them: no vector is ever carried from one tangent plane to another but along the
//! walk. The rule is of second order in `h`, as the field is in the edges.
//!
//! Signs of the field are only heeded at the start. From then on the vectors of corners count as lines and are taken the way that
//! the curve goes: curves cross the edges at which the signs of a field that has none flip.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Field;
use crate::error::{Error, Result, Status};
use crate::mesh::triangles::blend;
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
    /// The length of a step, as a part of the edge of an equilateral triangle as large as that which the step begins in: above 0 and at
    /// most 0.5.
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

    /// Follows the curve from `start` for `length` model units at most. `step` is called with both ends of every step, and can end
    /// the curve there. Nothing is allocated.
    ///
    /// # Errors
    /// `start` is no point of the mesh, or `length` is not above 0 or not finite.
    pub fn follow(
        &self,
        start: SurfacePoint,
        sense: Sense,
        length: f64,
        mut step: impl FnMut(DVec3, DVec3) -> ControlFlow<()>,
    ) -> Result<Followed> {
        self.check(start, length)?;
        Ok(self.steps(start, sense, length, |from, followed| step(from, followed.position)))
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
                Halt::Unknown => return Followed { end: End::Unknown, ..found },
                Halt::Arrived if is_last => return Followed { end: End::Length, ..found },
                Halt::Arrived => {}
            }
        }
        Followed { end: End::Steps, ..found }
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

    /// Goes straight on, and how far if less than `distance`.
    fn walk(&self, walker: &mut Walker, distance: f64) -> (f64, Halt) {
        let (mut left, mut entered) = (distance, None);
        // A straight line can meet a triangle again, but not without going some way: the count is there for round-off.
        for _ in 0..=self.mesh.triangles().len() {
            let triangle = walker.at.triangle as usize;
            let (corners, normal) = (self.mesh.corners(triangle), self.mesh.normal(triangle));
            let rates = rates(corners, normal, self.mesh.area(triangle), walker.heading);
            let weights = &mut walker.at.weights;
            let exit = (0..3).filter(|&k| rates[k] < 0.0 && entered != Some(k)).map(|k| (k, weights[k] / -rates[k]));
            let exit = exit.fold((0, f64::INFINITY), |best, exit| {
                let is_first = exit.1 < best.1
                    || (exit.1 == 0.0 && best.1 == 0.0 && {
                        // Out of both edges at a corner: around it the shorter way. The edge opposite to k has the other corner.
                        let center = corners[3 - best.0 - exit.0];
                        let along = |k: usize| walker.heading.dot((corners[k] - center).normalize());
                        along(best.0) > along(exit.0)
                    });
                if is_first { exit } else { best }
            });
            let (k, time) = (exit.0, exit.1.min(left));
            for l in 0..3 {
                weights[l] = (weights[l] + time * rates[l]).max(0.0);
            }
            if exit.1 > left {
                normalise(weights);
                return (distance, Halt::Arrived);
            }
            weights[k] = 0.0;
            normalise(weights);
            left -= time;
            let edge = (k + 1) % 3;
            let Some((other, opposite)) = self.mesh.across(triangle, edge) else {
                return (distance - left, Halt::Boundary);
            };
            if self.is_unknown[other] {
                return (distance - left, Halt::Unknown);
            }
            // Outward from this triangle, then inward to the other, along e × n.
            let along = (corners[(k + 2) % 3] - corners[edge]).normalize();
            let (on, out) = (walker.heading.dot(along), walker.heading.dot(along.cross(normal)));
            walker.heading = (on * along + out * along.cross(self.mesh.normal(other))).normalize();
            // The edge runs the other way there.
            let mut there = [0.0; 3];
            there[opposite] = weights[(k + 2) % 3];
            there[(opposite + 1) % 3] = weights[edge];
            walker.at = SurfacePoint { triangle: other as u32, weights: there };
            entered = Some((opposite + 2) % 3);
        }
        (distance - left, Halt::Arrived)
    }
}

/// A point, and the unit vector in the plane of its triangle that it goes along.
#[derive(Clone, Copy)]
struct Walker {
    at: SurfacePoint,
    heading: DVec3,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Halt {
    Arrived,
    Boundary,
    Unknown,
}

/// How the weights of corners change along a unit vector `v`: with `v = β (b − a) + γ (c − a)` by `−β − γ`, `β` and `γ`.
fn rates([a, b, c]: [DVec3; 3], normal: DVec3, area: f64, v: DVec3) -> [f64; 3] {
    let factor = 0.5 / area;
    let beta = factor * normal.dot(v.cross(c - a));
    let gamma = factor * normal.dot((b - a).cross(v));
    [-beta - gamma, beta, gamma]
}

fn normalise(weights: &mut [f64; 3]) {
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ruled::{asymptotic, orientation};
    use crate::mesh::Mesh;
    use crate::mesh::grid::Grid;
    use crate::mesh::patterns::{height_field, parametric_surface};
    use crate::mesh::reference::ReferenceMesh;

    fn field(mesh: &Mesh, family: usize, options: &orientation::Options) -> (TriangleMesh, Field) {
        let mesh = TriangleMesh::new(mesh).unwrap();
        let found = asymptotic::AsymptoticDirections::new(&mesh, &asymptotic::Options::default()).unwrap();
        let oriented = found.orient(&mesh, family, options).unwrap();
        (mesh, oriented.field)
    }

    fn exact(mesh: &Mesh, direction: impl Fn(DVec3) -> DVec3) -> (TriangleMesh, Field) {
        let mesh = TriangleMesh::new(mesh).unwrap();
        let directions = mesh.points().iter().map(|&p| direction(p).normalize()).collect();
        let field = Field::new(&mesh, directions, vec![true; mesh.points().len()]).unwrap();
        (mesh, field)
    }

    /// Points are where they say, steps no longer than half an edge, and lengths those of the polyline or, over edges, a bit more.
    fn assert_sound(mesh: &TriangleMesh, trace: &Trace, most: f64) {
        assert!(trace.points.len() == trace.positions.len() && trace.lengths.len() == trace.positions.len());
        for (at, position) in trace.points.iter().zip(&trace.positions) {
            assert!(at.weights.iter().all(|w| (0.0..=1.0 + 1e-15).contains(w)));
            assert!((at.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14 && mesh.position(*at) == *position);
        }
        for i in 1..trace.positions.len() {
            let (chord, walked) =
                (trace.positions[i].distance(trace.positions[i - 1]), trace.lengths[i] - trace.lengths[i - 1]);
            assert!(walked > 0.0 && walked < most && chord < walked * (1.0 + 1e-9) && chord > 0.9 * walked);
        }
    }

    #[test]
    fn asymptotic_lines_of_the_hyperboloid_are_straight() {
        let n = 41;
        let point = |v: f64, z: f64| {
            let r = (1.0 + z * z).sqrt();
            DVec3::new(r * v.cos(), r * v.sin(), z)
        };
        let surface = parametric_surface(n, n, [0.0, 1.6], [-0.8, 0.8], point).unwrap();
        let (mut worst, mut apart) = (0.0_f64, 0.0_f64);
        for family in 0..2 {
            let (mesh, field) = field(&surface, family, &orientation::Options::default());
            let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
            let reference = ReferenceMesh::new(&mesh);
            for k in 0..15 {
                let seed = point(0.2 + 0.085 * f64::from(k), 0.7 * (2.1 * f64::from(k)).sin());
                let start = reference.locate(seed);
                let back = tracer.trace(start, Sense::Backward, 10.0).unwrap();
                let on = tracer.trace(start, Sense::Forward, 10.0).unwrap();
                assert!(back.end == End::Boundary && on.end == End::Boundary);
                assert_sound(&mesh, &on, 0.05);
                let line: Vec<DVec3> = back.positions.iter().rev().chain(&on.positions[1..]).copied().collect();
                let (first, last) = (line[0], line[line.len() - 1]);
                let length = first.distance(last);
                let along = (last - first) / length;
                let off = line.iter().map(|p| (*p - first).reject_from_normalized(along).length());
                worst = worst.max(off.fold(0.0, f64::max) / length);
                // And the line is the one through the seed: (x z ∓ y, y z ± x, x² + y²).
                let sign = if family == 0 { -1.0 } else { 1.0 };
                let ruling =
                    DVec3::new(seed.x * seed.z - sign * seed.y, seed.y * seed.z + sign * seed.x, 1.0 + seed.z * seed.z);
                apart = apart.max(along.cross(ruling.normalize()).length());
            }
        }
        assert!(worst < 1e-3 && apart < 3e-3, "{worst} {apart}");
    }

    #[test]
    fn a_curve_along_edges_goes_through_points() {
        // Rulings of z = xy from points of a grid follow its edges.
        let surface = height_field(11, 11, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap();
        let (mesh, field) = exact(&surface, |p| DVec3::new(1.0, 0.0, p.y));
        let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
        for point in 0..mesh.points().len() {
            let p = mesh.points()[point];
            for (sense, end) in [(Sense::Forward, 1.0), (Sense::Backward, -1.0)] {
                // From whichever triangle around the point. Those at the boundary may be left by it at once.
                if p.y.abs() > 0.99 || (p.x - end).abs() < 0.01 {
                    continue;
                }
                for &triangle in mesh.fan(point) {
                    let weights = mesh.triangles()[triangle as usize].map(|i| f64::from(u8::from(i as usize == point)));
                    let trace = tracer.trace(SurfacePoint { triangle, weights }, sense, 10.0).unwrap();
                    assert_sound(&mesh, &trace, 0.2);
                    assert_eq!(trace.end, End::Boundary);
                    let last = trace.positions[trace.positions.len() - 1];
                    // The first direction is that in the plane of the triangle it began in.
                    assert!((last.x - end).abs() < 1e-14 && (last.y - p.y).abs() < 3e-2, "{p} {last}");
                }
            }
        }
    }

    #[test]
    fn helices_of_the_helicoid_to_second_order() {
        let c = 0.8;
        let helix = |u: f64, v: f64| DVec3::new(u * v.cos(), u * v.sin(), c * v);
        let error = |n: usize| {
            let surface = parametric_surface(n, n, [0.2, 1.2], [0.0, 1.5], helix).unwrap();
            let (mesh, field) = exact(&surface, |p| {
                let (sine, cosine) = (p.z / c).sin_cos();
                let u = p.x * cosine + p.y * sine;
                DVec3::new(-u * sine, u * cosine, c)
            });
            let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
            let reference = ReferenceMesh::new(&mesh);
            let mut worst = 0.0_f64;
            for k in 0..9 {
                let u = 0.4 + 0.07 * f64::from(k);
                let length = 1.2 * u.hypot(c);
                let start = reference.locate(helix(u, 0.1));
                let followed = tracer.follow(start, Sense::Forward, length, |_, _| ControlFlow::Continue(())).unwrap();
                assert!(followed.end == End::Length && (followed.length - length).abs() < 1e-12);
                worst = worst.max(followed.position.distance(helix(u, 1.3)));
            }
            worst
        };
        let errors = [11, 21, 41].map(error);
        assert!(errors[0] / errors[1] > 3.0 && errors[1] / errors[2] > 3.0 && errors[2] < 1e-3, "{errors:?}");
    }

    #[test]
    fn a_curve_goes_around_a_tube_as_long_as_asked() {
        let at = |i: usize| {
            let angle = std::f64::consts::TAU * (i % 40) as f64 / 40.0;
            DVec3::new(angle.cos(), angle.sin(), 0.1 * (i / 40) as f64)
        };
        let tube = Grid::new((0..440).map(at).collect(), 11, 40, [false, true]).unwrap().mesh();
        let (mesh, field) = exact(&tube, |p| DVec3::new(-p.y, p.x, 0.0));
        let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
        let start = ReferenceMesh::new(&mesh).locate(DVec3::new(0.9, 0.3, 0.53));
        // Ten times around the polygon.
        let length = 10.0 * 80.0 * (std::f64::consts::PI / 40.0).sin();
        let trace = tracer.trace(start, Sense::Backward, length).unwrap();
        assert_sound(&mesh, &trace, 0.1);
        assert_eq!(trace.end, End::Length);
        assert!(trace.positions[trace.positions.len() - 1].distance(trace.positions[0]) < 1e-9);
        assert!(trace.positions.iter().all(|p| (p.z - trace.positions[0].z).abs() < 1e-12));
        let few = Tracer::new(&mesh, &field, &Options { most_steps: 7, ..Options::default() }).unwrap();
        let trace = few.trace(start, Sense::Forward, length).unwrap();
        assert!(trace.end == End::Steps && trace.positions.len() == 8);
        let mut last = mesh.position(start);
        let mut count = 0;
        let stopped = tracer.follow(start, Sense::Forward, length, |from, to| {
            assert_eq!(from, last);
            (last, count) = (to, count + 1);
            if count == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let stopped = stopped.unwrap();
        assert!(stopped.end == End::Caller && stopped.position == last && count == 5);
    }

    #[test]
    fn on_rough_meshes_curves_go_on_to_the_boundary() {
        // Hills as steep as 2, points moved about, a spike, and a start at each corner and each middle of an edge.
        let mut surface =
            height_field(13, 13, [-1.0, 1.0], [-1.0, 1.0], |x, y| 0.4 * (5.0 * x).sin() * (4.0 * y).cos());
        for (i, p) in surface.iter_mut().flat_map(|mesh| mesh.points.iter_mut()).enumerate() {
            let t = i as f64;
            *p += 0.04 * DVec3::new((7.3 * t).sin(), (3.9 * t).cos(), (5.1 * t).sin());
            p.z += if i == 84 { 0.1 } else { 0.0 };
        }
        let surface = surface.unwrap();
        for k in 0..5 {
            let (sine, cosine) = (1.3 * f64::from(k)).sin_cos();
            let (mesh, field) = exact(&surface, |_| DVec3::new(cosine, sine, 0.0));
            let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
            let reference = ReferenceMesh::new(&mesh);
            let halves = [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]];
            for weights in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().chain(halves) {
                for triangle in 0..mesh.triangles().len() as u32 {
                    let start = SurfacePoint { triangle, weights };
                    let trace = tracer.trace(start, Sense::Forward, 40.0).unwrap();
                    let last = trace.points[trace.points.len() - 1];
                    assert!(trace.end == End::Boundary && reference.is_on_boundary(last), "{start:?} {:?}", trace.end);
                    assert!(trace.points.len() > 1 || reference.is_on_boundary(start));
                    // Steps may go over a ridge, but not beyond what they say.
                    let steps = trace.positions.windows(2).map(|ends| ends[0].distance(ends[1]));
                    assert!(
                        steps.zip(trace.lengths.windows(2)).all(|(chord, l)| chord <= (l[1] - l[0]) * (1.0 + 1e-9))
                    );
                }
            }
        }
    }

    #[test]
    fn a_curve_ends_before_what_is_not_known_and_passes_where_signs_flip() {
        let monkey = |x: f64, y: f64| x * x * x - 3.0 * x * y * y;
        let surface = height_field(41, 41, [-1.0, 1.0], [-1.0, 1.0], monkey).unwrap();
        let cut = orientation::Options { allow_cut: true, ..orientation::Options::default() };
        for family in 0..2 {
            let (mesh, field) = field(&surface, family, &cut);
            let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
            let masked = mesh.points().iter().position(|p| p.length() < 1e-12).unwrap();
            let triangle = mesh.fan(masked)[0];
            let trace = tracer.trace(SurfacePoint { triangle, weights: [0.5, 0.5, 0.0] }, Sense::Forward, 1.0).unwrap();
            assert!(trace.end == End::Unknown && trace.positions.len() == 1);
            let mut sharpest = 1.0_f64;
            for triangle in (0..mesh.triangles().len() as u32).step_by(7) {
                let start = SurfacePoint { triangle, weights: [0.2, 0.3, 0.5] };
                if mesh.position(start).length() < 0.3 {
                    continue;
                }
                let trace = tracer.trace(start, Sense::Forward, 5.0).unwrap();
                assert!(trace.end == End::Boundary || trace.end == End::Unknown, "{:?}", trace.end);
                for three in trace.positions.windows(3) {
                    let (a, b) = (three[1] - three[0], three[2] - three[1]);
                    // Around the flat point curves do turn.
                    if three[1].length() > 0.3 && b.length() > 1e-6 {
                        sharpest = sharpest.min(a.normalize().dot(b.normalize()));
                    }
                }
            }
            assert!(sharpest > 0.98, "{sharpest}");
        }
    }

    #[test]
    fn bad_input_is_named() {
        let surface = height_field(5, 5, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap();
        let (mesh, field) = exact(&surface, |p| DVec3::new(1.0, 0.0, p.y));
        let place = |options| Tracer::new(&mesh, &field, &options).unwrap_err().place().to_owned();
        assert_eq!(place(Options { step: 0.6, ..Options::default() }), "step");
        assert_eq!(place(Options { step: f64::NAN, ..Options::default() }), "step");
        assert_eq!(place(Options { most_steps: 0, ..Options::default() }), "most_steps");
        let tracer = Tracer::new(&mesh, &field, &Options::default()).unwrap();
        let place = |triangle, weights, length| {
            let start = SurfacePoint { triangle, weights };
            tracer.trace(start, Sense::Forward, length).unwrap_err().place().to_owned()
        };
        assert_eq!(place(32, [1.0, 0.0, 0.0], 1.0), "start");
        assert_eq!(place(3, [1.1, -0.1, 0.0], 1.0), "start");
        assert_eq!(place(3, [f64::NAN, 0.0, 1.0], 1.0), "start");
        assert_eq!(place(3, [1.0, 0.0, 0.0], f64::INFINITY), "length");
        assert_eq!(place(3, [1.0, 0.0, 0.0], 0.0), "length");
        let other = TriangleMesh::new(&height_field(4, 5, [0.0, 1.0], [0.0, 1.0], |x, y| x * y).unwrap()).unwrap();
        assert_eq!(Tracer::new(&other, &field, &Options::default()).unwrap_err().place(), "field");
    }
}
