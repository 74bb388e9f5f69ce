//! A snake: control points, and the arcs that they are to keep.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use super::Arc;
use crate::error::{Error, Result, Status, finite};
use crate::mesh::fit::Circle;
use crate::mesh::grid::{check_finite, check_finite_point};

/// By how much the two tangents of an arc may differ in length, as a multiple of the size of the control polygon.
const UNEQUAL: f64 = 1e-9;

/// An arc turns by more than this, in radians, and by less than π less it: a straight one has no plane, and half a circle has no vertex.
const LEAST_ANGLE: f64 = 1e-6;

/// What an arc keeps: its radius and length.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ArcShape {
    /// The radius, above 0.
    pub radius: f64,
    /// The arc length, above 0 and below π times the radius.
    pub length: f64,
}

impl ArcShape {
    /// The angle that it turns by, in radians.
    pub fn angle_rad(&self) -> f64 {
        self.length / self.radius
    }

    /// The distance from its vertex to both ends, `r tan(θ/2)`.
    pub fn tangent_length(&self) -> f64 {
        self.radius * (0.5 * self.angle_rad()).tan()
    }

    fn check(&self) -> std::result::Result<(), String> {
        let angle = self.angle_rad();
        if !(self.radius > 0.0 && self.radius.is_finite()) {
            return Err(format!("expected a radius above 0, found {}", self.radius));
        }
        if !(angle > LEAST_ANGLE && angle < PI - LEAST_ANGLE) {
            let reason = format!("expected an angle, length / radius, above 0 and below π, found {angle}");
            return Err(format!("{reason}; an arc of half a circle or more can be split into two"));
        }
        Ok(())
    }
}

/// Where a snake begins, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The first point of its first arc.
    pub point: DVec3,
    /// The tangent there, of any length.
    pub tangent: DVec3,
    /// The direction in which the first arc bends; what is along the tangent does not count.
    pub normal: DVec3,
}

/// A distance of two control points that a snake keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// The control points.
    pub points: [u32; 2],
    /// Their distance.
    pub length: f64,
}

/// A smooth chain of circular arcs; see the [notation](super).
#[derive(Clone, Debug, PartialEq)]
pub struct Snake {
    control: Vec<DVec3>,
    shapes: Vec<ArcShape>,
    is_closed: bool,
}

impl Snake {
    /// The snake with these control points. The arcs' tangent lengths follow from them: at the end of an open snake they must come
    /// out as the last edge, around a closed one with an odd number of arcs they are unique. With an even number there are none or a
    /// family of them, of which `first_tangent`, that of arc 0, chooses; it is used nowhere else.
    ///
    /// # Errors
    /// Fewer than 3 control points, or a coordinate that is not finite (`control`, `control[i]`); edges that no arcs have
    /// (`control[i]`, `first_tangent`). Status `Degenerate`: an arc that is straight or half a circle (`control[i]`).
    pub fn new(control: Vec<DVec3>, is_closed: bool, first_tangent: Option<f64>) -> Result<Self> {
        let count = control.len();
        if count < 3 {
            let reason = format!("expected at least 3 points, found {count}");
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("control"));
        }
        check_finite("control", &control)?;
        let size = size(&control);
        let edges = if is_closed { count } else { count - 1 };
        let edge = |i: usize| control[i].distance(control[(i + 1) % count]);
        if let Some(i) = (0..edges).find(|&i| !(edge(i) > UNEQUAL * size)) {
            let reason = format!("expected a point apart from control[{}], found the same", (i + 1) % count);
            return Err(Error::new(Status::InvalidValue, reason).at(format!("control[{i}]")));
        }
        let lengths: Vec<f64> = (0..edges).map(edge).collect();
        let tangents =
            if is_closed { closed_tangents(&lengths, first_tangent, size)? } else { open_tangents(&lengths, size)? };
        let first = usize::from(!is_closed);
        let shape = |(j, tangent): (usize, &f64)| {
            let i = j + first;
            let incoming = control[i] - control[(i + count - 1) % count];
            let outgoing = control[(i + 1) % count] - control[i];
            let angle = incoming.cross(outgoing).length().atan2(incoming.dot(outgoing));
            if !(angle > LEAST_ANGLE && angle < PI - LEAST_ANGLE) {
                let reason = format!("expected edges that turn by more than 0 and less than π, found {angle}");
                return Err(Error::new(Status::Degenerate, reason).at(format!("control[{i}]")));
            }
            let radius = tangent / (0.5 * angle).tan();
            Ok(ArcShape { radius, length: radius * angle })
        };
        let shapes = tangents.iter().enumerate().map(shape).collect::<Result<Vec<_>>>()?;
        Ok(Self { control, shapes, is_closed })
    }

    /// The open snake of these arcs, one after the other; `torsions[j]` is by how much the plane turns between arcs `j` and `j + 1`,
    /// in radians, counterclockwise about the tangent.
    ///
    /// # Errors
    /// No arcs, one that is none (`arcs`, `arcs[j]`), not one torsion fewer (`torsions`, `torsions[j]`), a tangent without length or
    /// along the normal (`pose.tangent`, `pose.normal`).
    pub fn from_arcs(arcs: &[ArcShape], torsions: &[f64], pose: &Pose) -> Result<Self> {
        if arcs.is_empty() {
            return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("arcs"));
        }
        check_arcs(arcs)?;
        if torsions.len() + 1 != arcs.len() {
            let reason = format!("expected {}, one between two arcs, found {}", arcs.len() - 1, torsions.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("torsions"));
        }
        for (j, &torsion) in torsions.iter().enumerate() {
            finite(&format!("torsions[{j}]"), torsion)?;
        }
        check_finite_point("pose.point", pose.point)?;
        let none = |reason: &str, place: &str| Error::new(Status::InvalidValue, reason).at(place);
        let mut tangent = pose.tangent.try_normalize();
        let mut normal = tangent.and_then(|tangent| pose.normal.reject_from_normalized(tangent).try_normalize());
        let mut control = vec![pose.point];
        let mut at = pose.point;
        for (j, arc) in arcs.iter().enumerate() {
            let t = tangent.ok_or_else(|| none("expected a direction", "pose.tangent"))?;
            let n = normal.ok_or_else(|| none("expected a direction that is not along the tangent", "pose.normal"))?;
            control.push(at + arc.tangent_length() * t);
            let (sine, cosine) = arc.angle_rad().sin_cos();
            at += arc.radius * (sine * t + (1.0 - cosine) * n);
            let next = cosine * t + sine * n;
            let inward = cosine * n - sine * t;
            let turn = DMat3::from_axis_angle(next, torsions.get(j).copied().unwrap_or(0.0));
            (tangent, normal) = (Some(next), Some(turn * inward));
        }
        control.push(at);
        check_finite("arcs", &control)?;
        Ok(Self { control, shapes: arcs.to_vec(), is_closed: false })
    }

    /// The snake of these arcs with these control points: one for each arc of a closed snake, of an open one two more. It is what
    /// [`Snake::new`] finds, but the arcs are those given to the last bit, and an even number around a closed snake is no question.
    ///
    /// # Errors
    /// Too few arcs, or one that is none (`arcs`, `arcs[j]`); another number of control points, or a coordinate that is not finite
    /// (`control`, `control[i]`); control points that do not keep the distances of the arcs to 1e-9 of their extent (`control`).
    pub fn with_arcs(control: Vec<DVec3>, arcs: Vec<ArcShape>, is_closed: bool) -> Result<Self> {
        let least = if is_closed { 3 } else { 1 };
        if arcs.len() < least {
            let reason = format!("expected at least {least}, found {}", arcs.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("arcs"));
        }
        check_arcs(&arcs)?;
        let expected = if is_closed { arcs.len() } else { arcs.len() + 2 };
        if control.len() != expected {
            let reason = format!("expected {expected} for {} arcs, found {}", arcs.len(), control.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("control"));
        }
        check_finite("control", &control)?;
        let snake = Self { control, shapes: arcs, is_closed };
        let residual = snake.residual();
        if !(residual <= UNEQUAL * snake.size()) {
            let reason =
                format!("expected points at the distances that the arcs have, found one that is off by {residual}");
            return Err(Error::new(Status::InvalidValue, reason).at("control"));
        }
        Ok(snake)
    }

    /// The same arcs with other control points; they need not keep the distances.
    ///
    /// # Errors
    /// Another number of points, or a coordinate that is not finite (`control`, `control[i]`).
    pub fn moved(&self, control: Vec<DVec3>) -> Result<Self> {
        if control.len() != self.control.len() {
            let reason = format!("expected {}, found {}", self.control.len(), control.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("control"));
        }
        check_finite("control", &control)?;
        Ok(Self { control, ..self.clone() })
    }

    /// Whether the last arc goes on with the first.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// The control points.
    pub fn control(&self) -> &[DVec3] {
        &self.control
    }

    /// The arcs' shapes, which stay as they are however the snake moves.
    pub fn shapes(&self) -> &[ArcShape] {
        &self.shapes
    }

    /// The sum of the arcs' lengths.
    pub fn length(&self) -> f64 {
        self.shapes.iter().map(|shape| shape.length).sum()
    }

    /// The diagonal of the box around the control points.
    pub fn size(&self) -> f64 {
        size(&self.control)
    }

    /// The control point at which arc `j` has its vertex; `j` of a closed snake counts on around it.
    pub fn vertex(&self, j: usize) -> usize {
        if self.is_closed { j % self.control.len() } else { j + 1 }
    }

    /// The distances that are kept, those of neighbours first.
    pub fn distances(&self) -> Vec<Distance> {
        let count = self.control.len();
        let tangents: Vec<f64> = self.shapes.iter().map(ArcShape::tangent_length).collect();
        // The tangent length at a control point; an end of an open snake has none.
        let at = |i: usize| {
            if self.is_closed {
                tangents[i % count]
            } else {
                i.checked_sub(1).and_then(|j| tangents.get(j)).copied().unwrap_or(0.0)
            }
        };
        let edge = |i: usize| at(i) + at(i + 1);
        let edges = if self.is_closed { count } else { count - 1 };
        let points = |i: usize, step: usize| [i as u32, ((i + step) % count) as u32];
        let mut distances: Vec<Distance> =
            (0..edges).map(|i| Distance { points: points(i, 1), length: edge(i) }).collect();
        // Around a triangle there is no third point, around a quadrangle each diagonal would come twice.
        let diagonals = match (self.is_closed, count) {
            (true, 3) => 0,
            (true, 4) => 2,
            (true, _) => count,
            (false, _) => count - 2,
        };
        let diagonal = |i: usize| {
            let j = if self.is_closed { (i + 1) % count } else { i };
            let (a, b, cosine) = (edge(i), edge(i + 1), self.shapes[j].angle_rad().cos());
            Distance { points: points(i, 2), length: (a * a + b * b + 2.0 * a * b * cosine).sqrt() }
        };
        distances.extend((0..diagonals).map(diagonal));
        distances
    }

    /// By how much a distance is off at most.
    pub fn residual(&self) -> f64 {
        let off = |Distance { points: [i, j], length }: Distance| {
            (self.control[i as usize].distance(self.control[j as usize]) - length).abs()
        };
        self.distances().into_iter().map(off).fold(0.0, f64::max)
    }

    /// The unit vectors along the edges, each from a control point to the next; those of coinciding points are 0.
    pub fn edge_directions(&self) -> Vec<DVec3> {
        let count = self.control.len();
        let edges = if self.is_closed { count } else { count - 1 };
        (0..edges).map(|i| (self.control[(i + 1) % count] - self.control[i]).normalize_or_zero()).collect()
    }

    /// The directions in which arc `j` begins and ends.
    fn tangents(&self, directions: &[DVec3], j: usize) -> [DVec3; 2] {
        if self.is_closed {
            [directions[(j + directions.len() - 1) % directions.len()], directions[j]]
        } else {
            [directions[j], directions[j + 1]]
        }
    }

    /// The contact points: where arc `j` begins, and of an open snake where the last one ends.
    pub fn contacts(&self) -> Vec<DVec3> {
        let directions = self.edge_directions();
        let begin = |j: usize| {
            self.control[self.vertex(j)] - self.shapes[j].tangent_length() * self.tangents(&directions, j)[0]
        };
        let mut contacts: Vec<DVec3> = (0..self.shapes.len()).map(begin).collect();
        if !self.is_closed {
            contacts[0] = self.control[0];
            contacts.push(self.control[self.control.len() - 1]);
        }
        contacts
    }

    /// The torsion angles in radians, above −π and at most π, counterclockwise about the tangent: between arcs `j` and `j + 1`, of a
    /// closed snake also between the last and the first.
    pub fn torsions(&self) -> Vec<f64> {
        let directions = self.edge_directions();
        let count = self.shapes.len();
        let binormal = |j: usize| {
            let [a, b] = self.tangents(&directions, j % count);
            a.cross(b)
        };
        let torsion = |j: usize| {
            let [from, to] = [binormal(j), binormal(j + 1)];
            let along = self.tangents(&directions, j)[1];
            along.dot(from.cross(to)).atan2(from.dot(to))
        };
        let inner = if self.is_closed { count } else { count - 1 };
        (0..inner).map(torsion).collect()
    }

    /// The arcs. They are those of the shapes where the control points keep their distances.
    pub fn arcs(&self) -> Vec<Arc> {
        let (directions, contacts) = (self.edge_directions(), self.contacts());
        let arc = |(j, shape): (usize, &ArcShape)| {
            let [from, to] = self.tangents(&directions, j);
            let inward = to.reject_from_normalized(from).normalize_or_zero();
            let start = contacts[j];
            let circle =
                Circle { center: start + shape.radius * inward, normal: from.cross(inward), radius: shape.radius };
            Arc { circle, start, angle_rad: shape.angle_rad() }
        };
        self.shapes.iter().enumerate().map(arc).collect()
    }

    /// Points along the snake, `per_arc` intervals (1 or more) in each arc; of a closed snake the first is not repeated.
    pub fn sample(&self, per_arc: usize) -> Vec<DVec3> {
        let per_arc = per_arc.max(1);
        let arcs = self.arcs();
        let mut points: Vec<DVec3> =
            arcs.iter().flat_map(|arc| (0..per_arc).map(|k| arc.point(k as f64 / per_arc as f64))).collect();
        points.extend(arcs.last().filter(|_| !self.is_closed).map(|arc| arc.point(1.0)));
        points
    }
}

fn check_arcs(arcs: &[ArcShape]) -> Result<()> {
    for (j, arc) in arcs.iter().enumerate() {
        arc.check().map_err(|reason| Error::new(Status::InvalidValue, reason).at(format!("arcs[{j}]")))?;
    }
    Ok(())
}

/// The diagonal of the box around points.
fn size(points: &[DVec3]) -> f64 {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    low.distance(high)
}

/// From `d_0 = |p_0 p_1|` on, `d_{j+1} = |p_{j+1} p_{j+2}| − d_j`.
fn open_tangents(edges: &[f64], size: f64) -> Result<Vec<f64>> {
    let mut tangents = vec![edges[0]];
    for (i, edge) in edges.iter().enumerate().take(edges.len() - 1).skip(1) {
        tangents.push(positive(edge - tangents[i - 1], i + 1, size)?);
    }
    let (last, edge) = (tangents[tangents.len() - 1], edges[edges.len() - 1]);
    if (last - edge).abs() > UNEQUAL * size {
        let reason =
            format!("expected the last edge to be {last} long, the tangent length of the last arc; found {edge}");
        return Err(Error::new(Status::InvalidValue, reason).at(format!("control[{}]", edges.len())));
    }
    Ok(tangents)
}

/// `d_j + d_{j+1} = |p_j p_{j+1}|` all around. Going around once, `d_0` comes back as `s ± d_0`, plus for an even number of arcs.
fn closed_tangents(edges: &[f64], first: Option<f64>, size: f64) -> Result<Vec<f64>> {
    let sum = edges.iter().fold(0.0, |sum, edge| edge - sum);
    let first = if edges.len() % 2 == 1 {
        0.5 * sum
    } else if sum.abs() > UNEQUAL * size {
        let reason = format!("expected edges whose alternating sum is 0, as their number is even; found {sum}");
        return Err(Error::new(Status::InvalidValue, reason).at("control"));
    } else {
        let reason =
            "expected the tangent length of arc 0, which the control points of an even number of arcs leave open";
        first.ok_or_else(|| Error::new(Status::InvalidValue, reason).at("first_tangent"))?
    };
    if !(first > UNEQUAL * size && first.is_finite()) {
        let reason = format!("expected a tangent length above 0, found {first}");
        let place = if edges.len() % 2 == 1 { "control[0]" } else { "first_tangent" };
        return Err(Error::new(Status::InvalidValue, reason).at(place));
    }
    let mut tangents = vec![first];
    for j in 1..edges.len() {
        tangents.push(positive(edges[j - 1] - tangents[j - 1], j, size)?);
    }
    Ok(tangents)
}

fn positive(tangent: f64, i: usize, size: f64) -> Result<f64> {
    if tangent > UNEQUAL * size {
        return Ok(tangent);
    }
    let reason = format!(
        "expected an edge before it that is longer than the tangent length of the arc before: {tangent} is left"
    );
    Err(Error::new(Status::InvalidValue, reason).at(format!("control[{i}]")))
}

#[cfg(test)]
pub(super) mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::random::Random;

    pub fn random_snake(count: usize, seed: u64) -> (Vec<ArcShape>, Vec<f64>, Pose, Snake) {
        let mut random = Random(seed);
        let arc = |random: &mut Random| {
            let radius = random.between(0.5, 2.0);
            ArcShape { radius, length: radius * random.between(0.3, 2.5) }
        };
        let arcs: Vec<ArcShape> = (0..count).map(|_| arc(&mut random)).collect();
        let torsions: Vec<f64> = (1..count).map(|_| random.between(-3.0, 3.0)).collect();
        let pose = Pose { point: random.vector(), tangent: random.vector(), normal: random.vector() };
        let snake = Snake::from_arcs(&arcs, &torsions, &pose).unwrap();
        (arcs, torsions, pose, snake)
    }

    #[test]
    fn arcs_come_back_from_control_points() {
        for count in [1, 2, 3, 6, 12] {
            let (arcs, torsions, _, snake) = random_snake(count, count as u64);
            assert_eq!(snake.control().len(), count + 2);
            assert!(snake.residual() < 1e-13, "{}", snake.residual());
            let again = Snake::new(snake.control().to_vec(), false, None).unwrap();
            for (found, arc) in again.shapes().iter().zip(&arcs) {
                assert!((found.radius - arc.radius).abs() < 1e-11 && (found.length - arc.length).abs() < 1e-11);
            }
            for (found, torsion) in again.torsions().iter().zip(&torsions) {
                assert!((found - torsion).abs() < 1e-11, "{found} {torsion}");
            }
            // Contacts divide edges: both tangents of an arc are of one length.
            let contacts = again.contacts();
            for (j, arc) in arcs.iter().enumerate() {
                let vertex = snake.control()[snake.vertex(j)];
                for contact in [contacts[j], contacts[j + 1]] {
                    assert!((vertex.distance(contact) - arc.tangent_length()).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn arcs_join_smoothly() {
        let (arcs, _, pose, snake) = random_snake(9, 4);
        let found = snake.arcs();
        assert!(found[0].point(0.0).distance(pose.point) < 1e-14);
        assert!(found[0].tangent(0.0).distance(pose.tangent.normalize()) < 1e-13);
        for (pair, contact) in found.windows(2).zip(&snake.contacts()[1..]) {
            assert!(pair[0].point(1.0).distance(pair[1].point(0.0)) < 1e-12);
            assert!(pair[0].tangent(1.0).distance(pair[1].tangent(0.0)) < 1e-12);
            assert!(pair[0].point(1.0).distance(*contact) < 1e-12);
        }
        let total: f64 = arcs.iter().map(|arc| arc.length).sum();
        assert!((snake.length() - total).abs() < 1e-13);
        let points = snake.sample(200);
        let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        assert_eq!(points.len(), 9 * 200 + 1);
        assert!((length / total - 1.0).abs() < 1e-4);
    }

    #[test]
    fn closed_snakes() {
        // A circle of radius 1 from arcs of one angle; an even number leaves the contacts open.
        for count in [5, 6, 7, 10] {
            let half = TAU / (2.0 * f64::from(count));
            let at = |i: i32| {
                let (sine, cosine) = (2.0 * half * f64::from(i)).sin_cos();
                DVec3::new(cosine, sine, 0.0) / half.cos()
            };
            let control: Vec<DVec3> = (0..count).map(at).collect();
            let first = (count % 2 == 0).then_some(half.tan());
            let snake = Snake::new(control.clone(), true, first).unwrap();
            assert_eq!((snake.distances().len(), snake.contacts().len()), (2 * count as usize, count as usize));
            assert!(snake.residual() < 1e-14 && snake.torsions().iter().all(|torsion| torsion.abs() < 1e-12));
            assert!(snake.shapes().iter().all(|shape| (shape.radius - 1.0).abs() < 1e-12));
            assert!(snake.sample(5).iter().all(|point| (point.length() - 1.0).abs() < 1e-13));
            assert!((snake.length() - TAU).abs() < 1e-12);
            if count % 2 == 0 {
                assert_eq!(Snake::new(control.clone(), true, None).unwrap_err().place(), "first_tangent");
                let other = Snake::new(control.clone(), true, Some(0.9 * half.tan())).unwrap();
                assert!(
                    (other.shapes()[0].radius - 0.9).abs() < 1e-12 && (other.shapes()[1].radius - 1.1).abs() < 1e-12
                );
            }
        }
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let refused = Snake::new(square.to_vec(), true, Some(0.4)).map(|snake| snake.distances().len());
        assert_eq!(refused.unwrap_err().place(), "control");
    }

    #[test]
    fn what_is_no_snake_is_refused() {
        let points = |all: &[[f64; 3]]| all.iter().map(|point| DVec3::from_array(*point)).collect::<Vec<_>>();
        let refused = |control, is_closed| Snake::new(control, is_closed, None).unwrap_err();
        assert_eq!(refused(points(&[[0.0; 3], [1.0, 0.0, 0.0]]), false).place(), "control");
        assert_eq!(refused(points(&[[0.0; 3], [f64::NAN, 0.0, 0.0], [1.0; 3]]), false).place(), "control[1]");
        assert_eq!(refused(points(&[[0.0; 3], [0.0; 3], [1.0; 3]]), false).place(), "control[0]");
        let unequal = refused(points(&[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0]]), false);
        assert_eq!((unequal.place(), unequal.status()), ("control[2]", Status::InvalidValue));
        let short = refused(points(&[[0.0; 3], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]]), false);
        assert_eq!(short.place(), "control[2]");
        let straight = refused(points(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), false);
        assert_eq!((straight.place(), straight.status()), ("control[1]", Status::Degenerate));
        // There and back again is half a turn, which no arc with a vertex makes.
        let folded = refused(points(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1e-9, 0.0]]), false);
        assert_eq!((folded.place(), folded.status()), ("control[1]", Status::Degenerate));
        let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
        let arc = ArcShape { radius: 1.0, length: 1.0 };
        let built = |arcs: &[ArcShape], torsions: &[f64], pose: &Pose| {
            Snake::from_arcs(arcs, torsions, pose).unwrap_err().place().to_owned()
        };
        assert_eq!(built(&[], &[], &pose), "arcs");
        assert_eq!(built(&[arc, ArcShape { radius: 1.0, length: 3.2 }], &[0.0], &pose), "arcs[1]");
        assert_eq!(built(&[arc, ArcShape { radius: -1.0, length: 1.0 }], &[0.0], &pose), "arcs[1]");
        assert_eq!(built(&[arc, arc], &[], &pose), "torsions");
        assert_eq!(built(&[arc, arc], &[f64::INFINITY], &pose), "torsions[0]");
        assert_eq!(built(&[arc], &[], &Pose { tangent: DVec3::ZERO, ..pose }), "pose.tangent");
        assert_eq!(built(&[arc], &[], &Pose { point: DVec3::NAN, ..pose }), "pose.point");
        assert_eq!(built(&[arc], &[], &Pose { normal: DVec3::X, ..pose }), "pose.normal");
    }
}
