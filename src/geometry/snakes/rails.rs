//! Rails: curves that guide a snake.
//!
//! A control point is *driven* along a rail at a given speed; one that *follows* another stays at its distance from it, on a rail of
//! its own, and a snake whose ends run so can move rigidly. A snake *glides* on a rail that it meets in some point of an arc, which
//! needs no point of the snake to run along it. There the velocity of the arc's point is in the plane of the tangents of snake and
//! rail (Bartoň et al. 2013, example 4.1), so that they still meet: with the part `φ` of the arc and the rail's parameter `τ`,
//!
//! ```text
//! m(φ, t) = γ(τ):   ṁ + m' φ̇ = γ' τ̇,   and once more   m̈ + 2 ṁ' φ̇ + m'' φ̇² + m' φ̈ = γ'' τ̇² + γ' τ̈
//! ```
//!
//! of which the parts along `m' × γ'` are conditions on `ṁ` and `m̈`. A point of an arc is a combination of three control points
//! with coefficients that stay, since arcs are rigid.

use glam::DVec3;

use super::Snake;
use super::functionals::Row;
use crate::error::{Error, Result, Status};
use crate::mesh::curve::Curve;

/// A rail that starts farther from its point than this part of the snake's length does not start on it.
const ON_SNAKE: f64 = 1e-6;

/// Tangents of snake and rail with a smaller sine of their angle are parallel: they span no plane.
const PARALLEL: f64 = 1e-4;

/// Steps at most to the point where a snake meets a rail, or a follower its distance.
const MOST_STEPS: usize = 60;

/// A follower's distance is met where it is off by this part of it.
const FOLLOWS: f64 = 1e-9;

/// How a curve guides a snake. Parameters of curves are theirs.
#[derive(Clone, Copy)]
pub enum Rail<'a> {
    /// A control point runs along it.
    Driven {
        /// The control point.
        point: u32,
        /// The curve.
        curve: &'a dyn Curve,
        /// The parameter at which the point is at the start.
        start: f64,
        /// By how much the parameter grows per time; below 0 it falls.
        speed: f64,
    },
    /// A control point runs along it as its distance from a driven one tells.
    Following {
        /// The control point.
        point: u32,
        /// The curve.
        curve: &'a dyn Curve,
        /// The parameter at which the point is at the start.
        start: f64,
        /// The rail, by its index, that drives the other point; it comes before.
        leader: usize,
    },
    /// The snake meets it.
    Gliding {
        /// The contact point where they meet at the start; an end of an open snake is one.
        contact: u32,
        /// The curve.
        curve: &'a dyn Curve,
        /// The parameter there.
        start: f64,
    },
}

impl Rail<'_> {
    /// Its curve.
    pub fn curve(&self) -> &dyn Curve {
        match self {
            Self::Driven { curve, .. } | Self::Following { curve, .. } | Self::Gliding { curve, .. } => *curve,
        }
    }

    fn start(&self) -> f64 {
        match self {
            Self::Driven { start, .. } | Self::Following { start, .. } | Self::Gliding { start, .. } => *start,
        }
    }

    /// The control point that runs along it.
    pub(super) fn point(&self) -> Option<u32> {
        match self {
            Self::Driven { point, .. } | Self::Following { point, .. } => Some(*point),
            Self::Gliding { .. } => None,
        }
    }
}

impl std::fmt::Debug for Rail<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = match self {
            Self::Driven { .. } => "Driven",
            Self::Following { .. } => "Following",
            Self::Gliding { .. } => "Gliding",
        };
        f.debug_struct(name).field("start", &self.start()).field("point", &self.point()).finish_non_exhaustive()
    }
}

/// Where a snake is on a rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnRail {
    /// The rail's parameter.
    pub parameter: f64,
    /// Where a gliding snake meets it: the arc, and the angle in radians from the arc's start. Zeros of other rails.
    pub arc: u32,
    /// See `arc`.
    pub angle_rad: f64,
}

/// Why a rail guides no more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Halt {
    /// Rail or snake end; by so much they miss each other, or the distance that is to stay.
    End(f64),
    /// Tangents are parallel.
    Parallel,
}

/// Three control points and coefficients: a point of an arc, or a derivative of it by the angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Combination([(u32, f64); 3]);

impl Combination {
    pub fn of(&self, vectors: &[DVec3]) -> DVec3 {
        self.0.iter().map(|&(i, a)| a * vectors[i as usize]).sum()
    }

    /// The row of its part along `direction`.
    pub fn row(&self, direction: DVec3, right: f64) -> Row {
        Row { terms: self.0.iter().map(|&(i, a)| (i, a * direction)).collect(), right, weight: 1.0 }
    }
}

/// The point of arc `j` at an angle from its start, and its first two derivatives by the angle.
///
/// With unit vectors `u`, `w` from the vertex back and on, `t = −u` and `n = (w + cos θ u) / sin θ` are the tangent and the normal at
/// the start `p + d u`, and the point is `p + d u + r sin φ t + r (1 − cos φ) n`.
pub(super) fn arc_point(snake: &Snake, j: usize, angle: f64) -> [Combination; 3] {
    let (shapes, count) = (snake.shapes(), snake.control().len());
    let tangent = |j: usize| shapes.get(j).map_or(0.0, super::ArcShape::tangent_length);
    let arcs = shapes.len();
    let (points, before, after) = if snake.is_closed() {
        ([(j + count - 1) % count, j, (j + 1) % count], tangent((j + arcs - 1) % arcs), tangent((j + 1) % arcs))
    } else {
        ([j, j + 1, j + 2], j.checked_sub(1).map_or(0.0, tangent), tangent(j + 1))
    };
    let (r, d, turn) = (shapes[j].radius, tangent(j), shapes[j].angle_rad());
    let ((sine, cosine), (of_turn, cosine_of_turn)) = (angle.sin_cos(), turn.sin_cos());
    let cotangent = cosine_of_turn / of_turn;
    let combination = |back: f64, on: f64, whole: f64| {
        let (back, on) = (back / (d + before), on / (d + after));
        Combination([(points[0] as u32, back), (points[1] as u32, whole - back - on), (points[2] as u32, on)])
    };
    let versine = 1.0 - cosine;
    [
        combination(d - r * sine + r * versine * cotangent, r * versine / of_turn, 1.0),
        combination(-r * cosine + r * sine * cotangent, r * sine / of_turn, 0.0),
        combination(r * sine + r * cosine * cotangent, r * cosine / of_turn, 0.0),
    ]
}

/// Where a snake is on its rails at the start.
///
/// # Errors
/// Indices that do not exist, a parameter or speed that is not finite, a leader that is no driven rail before it, or a rail that does
/// not start on the snake (`rails[k]`, `rails[k].FIELD`). Status `Degenerate`: a gliding rail along the snake (`rails[k]`).
pub(super) fn start(snake: &Snake, rails: &[Rail<'_>]) -> Result<Vec<OnRail>> {
    let size = snake.length();
    let contacts = snake.contacts();
    let mut found = Vec::with_capacity(rails.len());
    for (k, rail) in rails.iter().enumerate() {
        let error =
            |status, field: &str, reason: String| Err(Error::new(status, reason).at(format!("rails[{k}]{field}")));
        let [low, high] = rail.curve().range();
        let parameter = rail.start();
        if !(parameter.is_finite() && (rail.curve().is_closed() || (low..=high).contains(&parameter))) {
            let reason = format!("expected a parameter from {low} to {high}, found {parameter}");
            return error(Status::InvalidValue, ".start", reason);
        }
        let (on, mut at) = match *rail {
            Rail::Driven { point, .. } | Rail::Following { point, .. } => match snake.control().get(point as usize) {
                Some(&on) => (on, OnRail { parameter, arc: 0, angle_rad: 0.0 }),
                None => {
                    let reason = format!("{point} is out of range for {} control points", snake.control().len());
                    return error(Status::IndexOutOfRange, ".point", reason);
                }
            },
            Rail::Gliding { contact, .. } => match contacts.get(contact as usize) {
                Some(&on) => {
                    let arc = contact.min(snake.shapes().len() as u32 - 1);
                    let angle_rad = if arc == contact { 0.0 } else { snake.shapes()[arc as usize].angle_rad() };
                    (on, OnRail { parameter, arc, angle_rad })
                }
                None => {
                    let reason = format!("{contact} is out of range for {} contact points", contacts.len());
                    return error(Status::IndexOutOfRange, ".contact", reason);
                }
            },
        };
        if let Rail::Driven { speed, .. } = rail {
            if !speed.is_finite() {
                return error(Status::InvalidValue, ".speed", format!("expected a finite number, found {speed}"));
            }
        }
        if let Rail::Following { leader, .. } = *rail {
            if leader >= k || !matches!(rails[leader], Rail::Driven { .. }) {
                let reason = format!("expected the index of a driven rail before it, found {leader}");
                return error(Status::IndexOutOfRange, ".leader", reason);
            }
        }
        let distance = rail.curve().point(parameter).distance(on);
        if !(distance <= ON_SNAKE * size) {
            let reason = format!("expected a rail that starts on the snake, found one {distance} from it");
            return error(Status::InvalidValue, "", reason);
        }
        if let Rail::Gliding { curve, .. } = *rail {
            match meet(snake, curve, at) {
                Ok(meeting) => at = meeting,
                Err(Halt::Parallel) => {
                    let reason = "expected a gliding rail that crosses the snake, found one along it";
                    return error(Status::Degenerate, "", reason.into());
                }
                Err(Halt::End(distance)) => {
                    let reason = format!("expected a rail that starts on the snake, found one {distance} from it");
                    return error(Status::InvalidValue, "", reason);
                }
            }
        }
        found.push(at);
    }
    Ok(found)
}

/// The unit vector across snake and rail where they meet.
pub(super) fn across(snake: &Snake, curve: &dyn Curve, at: OnRail) -> std::result::Result<DVec3, Halt> {
    let [_, along, _] = arc_point(snake, at.arc as usize, at.angle_rad);
    let along = along.of(snake.control()).normalize_or_zero();
    let cross = along.cross(curve.tangent(at.parameter));
    if cross.length() < PARALLEL { Err(Halt::Parallel) } else { Ok(cross.normalize()) }
}

/// Where snake and rail are nearest to each other, near `at`: the Gauss–Newton method for both parameters.
pub(super) fn meet(snake: &Snake, curve: &dyn Curve, mut at: OnRail) -> std::result::Result<OnRail, Halt> {
    let size = snake.length();
    let mut is_at_end = false;
    for _ in 0..MOST_STEPS {
        across(snake, curve, at)?;
        let [point, along, _] = arc_point(snake, at.arc as usize, at.angle_rad);
        let (p, a, jet) = (point.of(snake.control()), along.of(snake.control()), curve.at(at.parameter));
        let (b, gap) = (jet.first, jet.point - p);
        // |gap + b τ − a φ|² least.
        let determinant = a.length_squared() * b.length_squared() - a.dot(b).powi(2);
        let angle = (a.dot(gap) * b.length_squared() - b.dot(gap) * a.dot(b)) / determinant;
        let parameter = (a.dot(gap) * a.dot(b) - b.dot(gap) * a.length_squared()) / determinant;
        let next = curve.inside(at.parameter + parameter);
        let is_beyond_rail = !curve.is_closed() && (next - at.parameter - parameter).abs() > 1e-12 * size / b.length();
        at.parameter = next;
        at.angle_rad += angle;
        let is_beyond_snake = !advance_arc(snake, &mut at);
        // Once may be overshoot.
        if (is_beyond_rail || is_beyond_snake) && is_at_end {
            let [point, ..] = arc_point(snake, at.arc as usize, at.angle_rad);
            let distance = point.of(snake.control()).distance(curve.point(at.parameter));
            return if distance <= FOLLOWS * size { Ok(at) } else { Err(Halt::End(distance)) };
        }
        is_at_end = is_beyond_rail || is_beyond_snake;
        if (angle * a.length()).abs().max((parameter * b.length()).abs()) <= 1e-14 * size {
            break;
        }
    }
    Ok(at)
}

/// Goes over to the neighbouring arc where the angle is beyond this one. False at an end of the snake, where it stays.
fn advance_arc(snake: &Snake, at: &mut OnRail) -> bool {
    let (shapes, count) = (snake.shapes(), snake.shapes().len());
    for _ in 0..count {
        let j = at.arc as usize;
        let turn = shapes[j].angle_rad();
        if at.angle_rad < 0.0 {
            if j == 0 && !snake.is_closed() {
                at.angle_rad = 0.0;
                return false;
            }
            let before = (j + count - 1) % count;
            // By length, not by angle.
            let length = at.angle_rad * shapes[j].radius;
            (at.arc, at.angle_rad) = (before as u32, shapes[before].angle_rad() + length / shapes[before].radius);
        } else if at.angle_rad > turn {
            if j + 1 == count && !snake.is_closed() {
                at.angle_rad = turn;
                return false;
            }
            let after = (j + 1) % count;
            let length = (at.angle_rad - turn) * shapes[j].radius;
            (at.arc, at.angle_rad) = (after as u32, length / shapes[after].radius);
        } else {
            break;
        }
    }
    let turn = shapes[at.arc as usize].angle_rad();
    at.angle_rad = at.angle_rad.clamp(0.0, turn);
    true
}

/// The parameter near `parameter` at which a curve is at a distance from a point.
pub(super) fn at_distance(
    curve: &dyn Curve,
    from: DVec3,
    distance: f64,
    parameter: f64,
) -> std::result::Result<f64, Halt> {
    let mut best = (f64::INFINITY, parameter);
    let mut t = curve.inside(parameter);
    for _ in 0..MOST_STEPS {
        let jet = curve.at(t);
        let apart = jet.point - from;
        let off = apart.length() - distance;
        if off.abs() < best.0 {
            best = (off.abs(), t);
        }
        let rate = apart.normalize_or_zero().dot(jet.first);
        // Where the distance is at its least or greatest, no step is longer than the distance.
        let limit = 0.1 * distance / jet.first.length();
        let step = (-off / rate).clamp(-limit, limit);
        let next = if step.is_finite() { curve.inside(t + step) } else { t };
        if next == t {
            break;
        }
        t = next;
    }
    if best.0 <= FOLLOWS * distance { Ok(best.1) } else { Err(Halt::End(best.0)) }
}

/// How fast the follower's parameter grows: with `a` from leader to follower, `a · (γ' τ̇ − v) = 0`.
///
/// Where the rail is at right angles to `a` this says nothing, and the distance stays to second order where
/// `‖γ' τ̇ − v‖² + a · (γ'' τ̇² − w) = 0`, a quadratic equation, with the leader's velocity `v` and acceleration `w`. For motions that
/// keep the distance all along, its roots are one.
pub(super) fn follower_rate(apart: DVec3, first: DVec3, second: DVec3, leader: [DVec3; 2]) -> f64 {
    let [v, w] = leader;
    let cosine = apart.normalize_or_zero().dot(first.normalize_or_zero());
    if cosine.abs() > PARALLEL {
        return apart.dot(v) / apart.dot(first);
    }
    let a = first.length_squared() + apart.dot(second);
    let b = first.dot(v);
    let c = v.length_squared() - apart.dot(w);
    let root = (b * b - a * c).max(0.0).sqrt();
    // Of two roots the one nearer to the leader's own speed along the rail.
    let wanted = b / first.length_squared();
    let roots = [(b + root) / a, (b - root) / a];
    let nearer = if (roots[0] - wanted).abs() < (roots[1] - wanted).abs() { roots[0] } else { roots[1] };
    if nearer.is_finite() { nearer } else { wanted }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{open_snake, regular};
    use super::*;
    use crate::mesh::curve::{FnCurve, Spline};

    #[test]
    fn combinations_are_points_of_arcs() {
        for snake in [open_snake(5, 3), regular(7)] {
            for (j, arc) in snake.arcs().iter().enumerate() {
                for part in [0.0, 0.3, 1.0] {
                    let [point, first, second] = arc_point(&snake, j, part * arc.angle_rad);
                    let radius = arc.circle.radius;
                    assert!(point.of(snake.control()).distance(arc.point(part)) < 1e-12);
                    assert!(first.of(snake.control()).distance(radius * arc.tangent(part)) < 1e-12);
                    let inward = arc.circle.center - arc.point(part);
                    assert!(second.of(snake.control()).distance(inward) < 1e-12);
                    let sum: f64 = point.0.iter().map(|entry| entry.1).sum();
                    assert!((sum - 1.0).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn a_snake_meets_a_rail_in_whichever_arc() {
        let snake = regular(9);
        // The unit circle and a line at the height 0.3: they meet at y = 0.3.
        let line = Spline::through(&[DVec3::new(-2.0, 0.3, 0.0), DVec3::new(2.0, 0.3, 0.0)], false).unwrap();
        let met = meet(&snake, &line, OnRail { parameter: 3.0, arc: 0, angle_rad: 0.3 }).unwrap();
        let [point, ..] = arc_point(&snake, met.arc as usize, met.angle_rad);
        let expected = DVec3::new(0.91_f64.sqrt(), 0.3, 0.0);
        assert!(
            point.of(snake.control()).distance(expected) < 1e-12
                && line.point(met.parameter).distance(expected) < 1e-12
        );
        let short = Spline::through(&[DVec3::new(-2.0, 0.3, 0.0), DVec3::new(0.8, 0.3, 0.0)], false).unwrap();
        let end = meet(&snake, &short, OnRail { parameter: 2.7, arc: 0, angle_rad: 0.3 });
        assert!(matches!(end, Err(Halt::End(distance)) if distance > 0.05), "{end:?}");
        let touching = Spline::through(&[DVec3::new(1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)], false).unwrap();
        let j = (0..9).find(|&j| snake.contacts()[j].x > 0.9).unwrap() as u32;
        let at = OnRail { parameter: 1.0, arc: j, angle_rad: 0.35 };
        let along = meet(&snake, &touching, at);
        assert!(matches!(along, Err(Halt::Parallel | Halt::End(_))), "{along:?}");
    }

    #[test]
    fn followers_keep_their_distance() {
        let circle = |radius: f64, z: f64| {
            FnCurve::new([0.0, 6.0], false, move |t: f64| {
                let out = DVec3::new(t.cos(), t.sin(), 0.0);
                let around = DVec3::new(-t.sin(), t.cos(), 0.0);
                [radius * out + z * DVec3::Z, radius * around, -radius * out]
            })
            .unwrap()
        };
        let (a, b) = (circle(1.0, 0.0), circle(1.5, 0.4));
        for shift in [0.0, 0.3] {
            let distance = a.point(1.0).distance(b.point(1.0 + shift));
            let (of_a, of_b) = (a.at(1.0), b.at(1.0 + shift));
            let rate = follower_rate(of_b.point - of_a.point, of_b.first, of_b.second, [of_a.first, of_a.second]);
            assert!((rate - 1.0).abs() < 1e-6, "{rate}");
            let found = at_distance(&b, a.point(1.2), distance, 1.21 + shift).unwrap();
            assert!((b.point(found).distance(a.point(1.2)) - distance).abs() < 1e-14);
            assert!((found - 1.2 - shift).abs() < 1e-6, "{found}");
        }
        let off = at_distance(&b, DVec3::ZERO, 1.0, 1.0);
        assert!(matches!(off, Err(Halt::End(distance)) if (distance - (1.5_f64.hypot(0.4) - 1.0)).abs() < 1e-9));
    }

    #[test]
    fn rails_must_start_on_the_snake() {
        let snake = open_snake(3, 5);
        let start_point = snake.control()[0];
        let line = |from: DVec3| Spline::through(&[from, from + DVec3::new(0.2, 0.5, 1.0)], false).unwrap();
        let (on, off) = (line(start_point), line(start_point + 0.01 * DVec3::X));
        let driven = |point, curve, start| Rail::Driven { point, curve, start, speed: 1.0 };
        let refused = |rail| start(&snake, &[rail]).unwrap_err();
        assert!(start(&snake, &[driven(0, &on, 0.0)]).is_ok());
        let error = refused(driven(0, &off, 0.0));
        assert!((error.place(), error.to_string().contains("0.01")) == ("rails[0]", true), "{error}");
        assert_eq!(refused(driven(5, &on, 0.0)).place(), "rails[0].point");
        assert_eq!(refused(driven(0, &on, -1.0)).place(), "rails[0].start");
        assert_eq!(refused(Rail::Following { point: 0, curve: &on, start: 0.0, leader: 0 }).place(), "rails[0].leader");
        assert_eq!(refused(Rail::Gliding { contact: 4, curve: &on, start: 0.0 }).place(), "rails[0].contact");
        let tangent = snake.arcs()[0].tangent(0.0);
        let along = Spline::through(&[start_point, start_point + tangent], false).unwrap();
        let error = refused(Rail::Gliding { contact: 0, curve: &along, start: 0.0 });
        assert_eq!((error.status(), error.place()), (Status::Degenerate, "rails[0]"));
    }
}
