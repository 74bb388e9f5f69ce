//! Rails: curves that guide a snake.
//!
//! A control point is *driven* along a rail at a given speed; one that *follows* another stays at its distance from it, on a rail
//! of its own, and a snake whose ends run so can move rigidly. A snake *glides* on a rail that it meets in some point of an arc,
//! which needs no point of the snake to run along it. There the velocity of the arc's point is in the plane of the tangents of
//! snake and rail (Bartoň et al. 2013, example 4.1), so that they still meet: with the part `φ` of the arc and the rail's
//! parameter `τ`,
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
/// With unit vectors `u`, `w` from the vertex back and on, `t = −u` and `n = (w + cos θ u) / sin θ` are the tangent and the normal
/// at the start `p + d u`, and the point is `p + d u + r sin φ t + r (1 − cos φ) n`.
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
/// Indices that do not exist, a parameter or speed that is not finite, a leader that is no driven rail before it, or a rail that
/// does not start on the snake (`rails[k]`, `rails[k].FIELD`). Status `Degenerate`: a gliding rail along the snake (`rails[k]`).
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
        if let Rail::Driven { speed, .. } = rail
            && !speed.is_finite()
        {
            return error(Status::InvalidValue, ".speed", format!("expected a finite number, found {speed}"));
        }
        if let Rail::Following { leader, .. } = *rail
            && (leader >= k || !matches!(rails[leader], Rail::Driven { .. }))
        {
            let reason = format!("expected the index of a driven rail before it, found {leader}");
            return error(Status::IndexOutOfRange, ".leader", reason);
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
/// `‖γ' τ̇ − v‖² + a · (γ'' τ̇² − w) = 0`, a quadratic equation, with the leader's velocity `v` and acceleration `w`. For motions
/// that keep the distance all along, its roots are one.
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
mod tests;
