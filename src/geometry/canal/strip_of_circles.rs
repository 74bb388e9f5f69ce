//! Circular strips of circles that someone drew (section 3.2, Fig. 5).
//!
//! **Which circles.** A strip of circles can be meant in two ways: as the circles of the quads, or as the crossing circles of
//! the canal surface. Here they are those of the quads. The paper says so where it parametrises the same strip by "one point P
//! in space defining the first circle" (Fig. 6: the circle through `P`, `P_0` and `P_1`) and where it closes strips (Fig. 14:
//! the first and the last circle go through two points of the guide each). And only so does Fig. 5 work, where eight circles in
//! one plane give a canal surface of which the half above the plane is shown: consecutive circles meet in two points, the ends
//! of a crossing edge; with a frame whose second tangent is normal to the plane, the crossing arcs are half circles over these
//! edges. Canal surfaces through given crossing circles are made by meshing between circles of one sphere instead.
//!
//! **Where they meet.** Circles that meet in two points are on one sphere or in one plane. Drawn in a plane, overlapping
//! circles do; drawn in space they rarely do. Then the line in which the planes of two consecutive circles meet crosses either
//! circle in two points, and the means of these are the ends of a crossing edge; or where both would meet if drawn in the plane
//! halfway between theirs, if that is nearer to both circles. The guide goes through the means on its side as they are; on the
//! other side each point is the one on its quad's circle, and in cyclic order there, that is nearest to the mean. The strip is
//! circular, not quite the circles drawn; how far its points are from them is told.

use glam::DVec3;

use super::strip::Strip;
use crate::error::{Error, Result, Status};
use crate::geometry::circle::Circle;
use crate::mesh::grid::check_finite;

/// Distance of a point from two circles, over the larger radius, up to which they meet there: round-off.
const MEETING: f64 = 1e-12;

/// Distance over the smaller radius beyond which they do not even nearly meet.
const TOO_FAR: f64 = 0.2;

/// Part of the arc from `Q_k` to `P_{k+1}` that a point keeps away from both ends.
const LEAST_ARC: f64 = 1e-3;

/// A strip of circles.
#[derive(Clone, Debug, PartialEq)]
pub struct StripOfCircles {
    /// The strip: as many quads as circles.
    pub strip: Strip,
    /// The largest distance, in model units, of a strip's point from a circle of which its quads are to be; round-off where the
    /// circles drawn meet.
    pub distance: f64,
}

/// The strip whose quads have the given circles, two or more, of which consecutive ones meet in two points (or nearly, see above).
///
/// The first crossing edge is free on the first circle, and the last on the last: with `start` and `end` it goes through the point
/// of that circle nearest to the one given, without it through the point at a third of the free arc; its other end is the mirror
/// image, so that the quad is an isosceles trapezoid.
///
/// # Errors
/// Fewer than 2 circles, a number that is not finite, a radius or a normal that is not above 0 or a unit vector. Status
/// `NoIntersection`: a circle does not meet the next, not even nearly; `Degenerate`: `start` or `end` is in the
/// middle between both ends of the next edge, or crossing edges have a common end. The place is `circles[i]`, `start` or `end`.
pub fn from_circles(circles: &[Circle], start: Option<DVec3>, end: Option<DVec3>) -> Result<StripOfCircles> {
    if circles.len() < 2 {
        let reason = format!("expected at least 2 circles, found {}", circles.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("circles"));
    }
    for (i, circle) in circles.iter().enumerate() {
        check_circle(circle).map_err(|error| error.at(format!("circles[{i}]")))?;
    }
    for (name, point) in [("start", start), ("end", end)] {
        check_finite(name, point.as_slice()).map_err(|error| error.with_place(name))?;
    }
    let count = circles.len();
    let mut edges = Vec::with_capacity(count + 1);
    let mut gap = 0.0_f64;
    for i in 1..count {
        let Some((edge, apart)) = crossing(&circles[i - 1], &circles[i]) else {
            let reason = format!("it and circles[{}] do not meet in two points, nor nearly", i - 1);
            return Err(Error::new(Status::NoIntersection, reason).at(format!("circles[{i}]")));
        };
        edges.push(edge);
        gap = gap.max(apart / circles[i].radius.max(circles[i - 1].radius));
    }
    // From edge to edge, the ends on the guide's side first.
    let first = free_edge(&circles[0], edges[0], circles[1].center, start, "start")?;
    edges.insert(0, first);
    let mut flipped = Vec::new();
    for i in 0..count - 1 {
        let (edge, is_crossed) = oriented(&circles[i], edges[i], edges[i + 1]);
        edges[i + 1] = edge;
        if is_crossed {
            flipped.push(i);
        }
    }
    edges.push(free_edge(&circles[count - 1], edges[count - 1], circles[count - 2].center, end, "end")?);
    let guide: Vec<DVec3> = edges.iter().map(|edge| edge[0]).collect();
    let mut border: Vec<DVec3> = edges.iter().map(|edge| edge[1]).collect();
    let coincide = |k: usize| {
        let reason = "crossing edges on it have a common end, or three ends are on a line";
        Error::new(Status::Degenerate, reason).at(format!("circles[{k}]"))
    };
    let mut attainable = Vec::with_capacity(count);
    for k in 0..count {
        let quad = super::quad::Quad::new(guide[k], border[k], guide[k + 1]).ok_or_else(|| coincide(k))?;
        attainable.push(quad.largest_length());
        if gap > MEETING {
            border[k + 1] = nearest(guide[k], border[k], guide[k + 1], border[k + 1]).ok_or_else(|| coincide(k))?;
        }
    }
    if gap > MEETING {
        flipped.clear();
    }
    let lengths = guide.iter().zip(&border).map(|(p, q)| p.distance(*q)).collect();
    let distance_at = |k: usize| {
        let corners = [guide[k], border[k], border[k + 1], guide[k + 1]];
        corners.map(|corner| circles[k].distance(corner)).into_iter().fold(0.0, f64::max)
    };
    let distance = (0..count).map(distance_at).fold(0.0, f64::max);
    let strip = Strip { guide, border, lengths, attainable, flipped, projected: Vec::new(), deviation: 0.0 };
    Ok(StripOfCircles { strip, distance })
}

pub(super) fn check_circle(circle: &Circle) -> Result<()> {
    check_finite("center", &[circle.center])?;
    let is_unit = (circle.normal.length() - 1.0).abs() <= 1e-9;
    if is_unit && circle.radius > 0.0 && circle.radius < f64::INFINITY {
        return Ok(());
    }
    let reason = format!("expected a unit normal and a radius above 0, found {circle:?}");
    Err(Error::new(Status::InvalidValue, reason))
}

/// Where two circles meet, or nearly, in either order; and the largest distance of the two points from either circle.
fn crossing(a: &Circle, b: &Circle) -> Option<([DVec3; 2], f64)> {
    let gap = |points: &[DVec3; 2]| points.map(|p| a.distance(p).max(b.distance(p))).into_iter().fold(0.0, f64::max);
    let found =
        [crossing_on_line(a, b), crossing_in_plane(a, b)].into_iter().flatten().map(|points| (points, gap(&points)));
    let best = found.min_by(|(_, gap), (_, other)| gap.total_cmp(other));
    best.filter(|(_, gap)| *gap <= TOO_FAR * a.radius.min(b.radius))
}

/// The means of where both circles cross the line in which their planes meet.
fn crossing_on_line(a: &Circle, b: &Circle) -> Option<[DVec3; 2]> {
    let along = a.normal.cross(b.normal).try_normalize()?;
    // The foot of a center on the line: in its own plane, at a right angle to the line.
    let chord = |circle: &Circle, other: &Circle| {
        let aside = along.cross(circle.normal);
        let s = (other.center - circle.center).dot(other.normal) / aside.dot(other.normal);
        let squared = (circle.radius - s) * (circle.radius + s);
        let (foot, half) = (circle.center + s * aside, squared.max(0.0).sqrt() * along);
        (squared > 0.0).then_some([foot - half, foot + half])
    };
    let (on_a, on_b) = (chord(a, b)?, chord(b, a)?);
    Some([0, 1].map(|i| on_a[i].midpoint(on_b[i])))
}

/// Where the circles would meet if both were in the plane halfway between theirs: their chord is `x = (d² + R² − R'²) / 2d` from
/// the center of `a`.
fn crossing_in_plane(a: &Circle, b: &Circle) -> Option<[DVec3; 2]> {
    let normal = a.normal + a.normal.dot(b.normal).signum() * b.normal;
    let normal = normal.try_normalize()?;
    let offset = b.center - a.center;
    let height = offset.dot(normal);
    let across = offset - height * normal;
    let distance = across.length();
    let x = 0.5 * (distance + (a.radius - b.radius) * (a.radius + b.radius) / distance);
    let squared = (a.radius - x) * (a.radius + x);
    let half = normal.cross(across / distance) * squared.max(0.0).sqrt();
    let middle = a.center + 0.5 * height * normal + x / distance * across;
    (squared > 0.0).then_some([middle - half, middle + half])
}

/// The next edge with the end on the guide's side first: so that `P, Q, Q', P'` are in cyclic order on the circle; and whether no
/// order makes them so, because the edges cross.
fn oriented(circle: &Circle, [p, q]: [DVec3; 2], next: [DVec3; 2]) -> ([DVec3; 2], bool) {
    let [to_q, to_a, to_b] = [q, next[0], next[1]].map(|point| circle.angle_between(p, point));
    let swapped = [next[1], next[0]];
    if (to_a < to_q) != (to_b < to_q) {
        let [here, there] = [next, swapped].map(|edge| edge[0].distance(p) + edge[1].distance(q));
        return (if here <= there { next } else { swapped }, true);
    }
    // Both beyond Q: the nearer to it, counterclockwise, is Q'. Both before: the last before Q is.
    let a_is_across = if to_a < to_q { to_a > to_b } else { to_a < to_b };
    (if a_is_across { swapped } else { next }, false)
}

/// The edge at a free end of the strip: through the circle's point nearest to `wish`, or at the thirds of the circle's arc over
/// `edge` that is farther from the neighbouring circle's center.
fn free_edge(
    circle: &Circle,
    edge: [DVec3; 2],
    neighbour: DVec3,
    wish: Option<DVec3>,
    name: &str,
) -> Result<[DVec3; 2]> {
    let across = edge[0] - edge[1];
    let point = match wish {
        Some(wish) => {
            let aside = (wish - circle.center).reject_from_normalized(circle.normal);
            if !(aside.length() > 1e-12 * circle.radius) {
                let reason = "it is on the axis of its circle, as near to all its points";
                return Err(Error::new(Status::Degenerate, reason).at(name));
            }
            circle.center + circle.radius * aside.normalize()
        }
        None => {
            let angle = circle.angle_between(edge[0], edge[1]);
            let middle = circle.point_at(edge[0], 0.5 * angle);
            let other = circle.point_at(edge[0], 0.5 * angle - std::f64::consts::PI);
            let is_first = middle.distance(neighbour) >= other.distance(neighbour);
            circle.point_at(edge[0], if is_first { angle / 3.0 } else { (angle - std::f64::consts::TAU) / 3.0 })
        }
    };
    let aside = (point - 0.5 * (edge[0] + edge[1])).dot(across) / across.length_squared();
    if !(aside.abs() > 1e-9) {
        let reason = "it is in the middle between both ends of the next edge: the quad would be a triangle";
        return Err(Error::new(Status::Degenerate, reason).at(name));
    }
    let mirrored = point - 2.0 * aside * across;
    Ok(if aside > 0.0 { [point, mirrored] } else { [mirrored, point] })
}

/// The point of the quad's circle, in cyclic order, nearest to `wish`; `None` where three corners are on a line.
fn nearest(previous: DVec3, across: DVec3, corner: DVec3, wish: DVec3) -> Option<DVec3> {
    let circle = Circle::through(corner, across, previous)?;
    let arc = circle.angle_between(corner, across);
    let angle = circle.angle_between(corner, wish);
    let (low, high) = (LEAST_ARC * arc, (1.0 - LEAST_ARC) * arc);
    // Beyond the arc the nearer end of it, around the circle.
    let is_past = angle > 0.5 * (arc + std::f64::consts::TAU);
    Some(circle.point_at(corner, if is_past { low } else { angle.clamp(low, high) }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::canal::frame::{self, Frame};
    use crate::geometry::canal::strip::tests::{helix, misfit};
    use crate::geometry::canal::strip::{of_border_edges, of_lengths};
    use crate::geometry::random::Random;

    /// Eight circles in a plane, as in Fig. 5.
    fn eight() -> Vec<Circle> {
        let circle = |k: usize| {
            let s = k as f64;
            let center = DVec3::new(1.1 * s, 0.6 * (0.8 * s).sin(), 0.0);
            Circle {
                center,
                normal: if k.is_multiple_of(2) { DVec3::Z } else { -DVec3::Z },
                radius: 1.0 + 0.2 * (1.7 * s).cos(),
            }
        };
        (0..8).map(circle).collect()
    }

    #[test]
    fn eight_circles_in_a_plane_are_those_of_the_quads() {
        let circles = eight();
        let start = circles[0].center + circles[0].radius * DVec3::new(-0.6, -0.8, 0.0);
        let found = from_circles(&circles, Some(start), None).unwrap();
        let strip = &found.strip;
        assert_eq!((strip.guide.len(), strip.flipped.len()), (9, 0));
        assert!(found.distance < 1e-12 && misfit(strip).0 < 1e-12 && misfit(strip).1 == 0);
        for (circle, given) in strip.circles().unwrap().iter().zip(&circles) {
            assert!(circle.center.distance(given.center) < 1e-12 && (circle.radius - given.radius).abs() < 1e-12);
        }
        assert!(strip.guide[0].distance(start) < 1e-12 && strip.guide.iter().all(|p| p.y < 0.7));
        assert!(strip.guide.iter().zip(&strip.border).all(|(p, q)| q.y > p.y + 0.5));
        // The half above the plane: crossing arcs that rise at a right angle to it come down so, half circles.
        let frame = Frame::of_tangent_two(DVec3::Z, DVec3::Y).unwrap();
        let frames = frame::frames(&strip.grid().unwrap(), frame).unwrap();
        assert!(
            frames
                .chunks(2)
                .all(|pair| pair[0].t2.distance(DVec3::Z) < 1e-12 && pair[1].t2.distance(-DVec3::Z) < 1e-12)
        );
        // The thirds of the free arc.
        let (a, b, c) = (strip.guide[7], strip.guide[8], strip.border[8]);
        assert!((a.distance(b) - b.distance(c)).abs() < 1e-12 && b.x > circles[7].center.x);
    }

    #[test]
    fn circles_of_a_strip_in_space_give_it_back() {
        let points = helix(12);
        let strip = of_border_edges(&points, 1.3 * points[0] + 0.1 * DVec3::Z, &[0.22; 12]).unwrap();
        let circles = strip.circles().unwrap();
        let found = from_circles(&circles, Some(strip.guide[0]), Some(strip.border[12])).unwrap();
        assert!(found.distance < 1e-9, "{}", found.distance);
        // Which side is the guide's follows from `start`.
        for k in 1..12 {
            assert!(found.strip.guide[k].distance(strip.guide[k]) < 1e-9);
            assert!(found.strip.border[k].distance(strip.border[k]) < 1e-9);
        }
        assert!(found.strip.guide[0] == strip.guide[0] || found.strip.guide[0].distance(strip.guide[0]) < 1e-12);
        // Disturbed, they no longer meet: the strip is circular all the same, and near.
        let mut random = Random(4);
        for amount in [1e-5, 1e-4, 1e-3] {
            let disturb = |circle: &Circle| Circle {
                center: circle.center + amount * random.vector(),
                normal: (circle.normal + amount * random.vector()).normalize(),
                radius: circle.radius * (1.0 + amount * random.between(-1.0, 1.0)),
            };
            let drawn: Vec<Circle> = circles.iter().map(disturb).collect();
            let found = from_circles(&drawn, Some(strip.guide[0]), None).unwrap();
            assert!(misfit(&found.strip).0 < 1e-11 && misfit(&found.strip).1 == 0);
            assert!(found.distance > 0.1 * amount && found.distance < 100.0 * amount, "{} {amount}", found.distance);
        }
    }

    #[test]
    fn circles_that_make_no_strip_are_named() {
        let circles = eight();
        let refusal = |circles: &[Circle], start| {
            let error = from_circles(circles, start, None).unwrap_err();
            (error.status(), error.place().to_string())
        };
        assert_eq!(refusal(&circles[..1], None), (Status::InvalidArgumentLength, "circles".to_string()));
        let mut apart = circles.clone();
        apart[3].center.y += 5.0;
        assert_eq!(refusal(&apart, None), (Status::NoIntersection, "circles[3]".to_string()));
        apart[3] = Circle { center: circles[3].center + DVec3::Z, ..circles[3] };
        assert_eq!(refusal(&apart, None), (Status::NoIntersection, "circles[3]".to_string()));
        apart[3] = Circle { radius: f64::NAN, ..circles[3] };
        assert_eq!(refusal(&apart, None), (Status::InvalidValue, "circles[3]".to_string()));
        let middle = circles[0].center - (circles[1].center - circles[0].center);
        assert_eq!(refusal(&circles, Some(middle)), (Status::Degenerate, "start".to_string()));
        assert_eq!(refusal(&circles, Some(DVec3::NAN)), (Status::InvalidValue, "start".to_string()));
        // Three of which the outer two overlap: their crossing edges cross each other.
        let overlapping: Vec<Circle> = [(0.0, 0.0), (1.0, 0.0), (0.6, 0.7)]
            .map(|(x, y)| Circle { center: DVec3::new(x, y, 0.0), normal: DVec3::Z, radius: 1.0 })
            .to_vec();
        let found = from_circles(&overlapping, None, None).unwrap();
        assert_eq!((found.strip.flipped.clone(), misfit(&found.strip).1), (vec![1], 1));
        // And of_lengths makes the same strip of what was drawn.
        let found = from_circles(&circles, None, None).unwrap().strip;
        let again = of_lengths(&found.guide, found.border[0], &found.lengths, &Default::default()).unwrap();
        assert!(again.border[1].distance(found.border[1]) < 1e-9);
    }
}
