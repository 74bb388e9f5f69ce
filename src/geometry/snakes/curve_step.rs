//! A step along a curve of given curvature on a surface with two parameters.
//!
//! In parameters `c' = S_u u' + S_v v'` this is `A w' = κ_g (n × c') − q_t`, with `A = (S_u, S_v)`, `w = (u', v')` and `q_t` the
//! tangential part of `q = S_uu u'² + 2 S_uv u' v' + S_vv v'²`. Its solution by the classical Runge–Kutta method is of fourth order
//! in the step, as long as `κ` stays away from `|κ_n|`, where the root is not smooth. The paper's own scheme is of first order:
//!
//! Let `w` be the rates of a step and `w₁` those of the next, at the point between the two. With `w' ≈ (w₁ − w)/h` there, `t = A w`
//! and the unit vector `t₁ = A w₁`, the curvature's square `|A w' + q|² = κ²` is linear in `t₁`:
//!
//! ```text
//! a·t₁ = ½ (h² (κ² − q·q) − 1 − t·t) + h q·t,   a = h q_t − t,
//! ```
//!
//! a line in the tangent plane that meets the unit circle in two points: a turn to the left and one to the right. All derivatives
//! are to be taken at this one point. With those of the point before, where `t` has unit length, `w'` would lose its part along the
//! curve, and curves would not converge.

use glam::DVec3;

use super::curvature_curve::{Course, End, Method, Side};
use crate::error::{Error, Result, Status};
use crate::mesh::reference::SurfaceJet;

/// What a step leads to.
type Stepped<T> = std::result::Result<T, Refusal>;

/// `κ² − κ_n²` counts as 0 where it is below this multiple of `κ²`, as it comes out of round-off: its root would be a curvature of
/// 1e-7 where there is none.
const ROUND_OFF: f64 = 64.0 * f64::EPSILON;

/// Or below the square of this over the length of the curve, which bends less than that in all: a plane has no curvature but
/// round-off.
const FLAT: f64 = 1e-10;

/// A point in parameters, and the parameters' derivatives by the arc length.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub at: [f64; 2],
    pub rate: [f64; 2],
}

/// Why a step cannot be taken.
pub(super) enum Refusal {
    End(End),
    Error(Error),
}

/// Whether a jet is finite and its derivatives span a plane.
pub(super) fn is_regular(jet: &SurfaceJet) -> bool {
    let all = [jet.point, jet.first[0], jet.first[1], jet.second[0], jet.second[1], jet.second[2]];
    let area = jet.first[0].cross(jet.first[1]).length();
    all.iter().all(|v| v.is_finite()) && area > 1e-12 * jet.first[0].length() * jet.first[1].length()
}

/// The rates of unit speed in the direction of what of `vector` is tangential; none where nothing is.
pub(super) fn directed(jet: &SurfaceJet, vector: DVec3) -> Option<[f64; 2]> {
    let tangential = vector.try_normalize()?.reject_from_normalized(jet.normal());
    if tangential.length() < 1e-9 { None } else { Some(rates(jet, tangential.normalize())) }
}

/// The `w` for which `A w` is the tangent vector.
fn rates(jet: &SurfaceJet, tangent: DVec3) -> [f64; 2] {
    let [u, v] = jet.first;
    let normal = u.cross(v);
    let square = normal.length_squared();
    [tangent.cross(v).dot(normal) / square, u.cross(tangent).dot(normal) / square]
}

/// `A w`.
pub(super) fn velocity(jet: &SurfaceJet, [u, v]: [f64; 2]) -> DVec3 {
    u * jet.first[0] + v * jet.first[1]
}

/// `q = S_uu u'² + 2 S_uv u' v' + S_vv v'²`.
pub(super) fn bend(jet: &SurfaceJet, [u, v]: [f64; 2]) -> DVec3 {
    u * u * jet.second[0] + 2.0 * u * v * jet.second[1] + v * v * jet.second[2]
}

pub(super) fn curvature(course: &Course<'_>, along: f64) -> Result<f64> {
    let curvature = (course.curvature)(along);
    if curvature >= 0.0 && curvature.is_finite() {
        return Ok(curvature);
    }
    let reason = format!("expected a finite number of at least 0, found {curvature} at the length {along}");
    Err(Error::new(Status::InvalidValue, reason).at("course.curvature"))
}

/// `√(κ² − κ_n²)` for the direction with the unit velocity and the bend given, of a curve of a length.
pub(super) fn geodesic_curvature(
    jet: &SurfaceJet,
    velocity: DVec3,
    bend: DVec3,
    curvature: f64,
    length: f64,
) -> std::result::Result<f64, End> {
    let normal_curvature = jet.normal().dot(bend) / velocity.length_squared();
    let square = (curvature - normal_curvature) * (curvature + normal_curvature);
    let round_off = (ROUND_OFF * curvature.max(normal_curvature.abs()).powi(2)).max((FLAT / length).powi(2));
    if square < -round_off {
        return Err(End::NoSolution { curvature, normal_curvature });
    }
    Ok(if square <= round_off { 0.0 } else { square.sqrt() })
}

/// A step of the length `step` from the length `along`.
pub(super) fn advance(
    surface: &dyn Fn(f64, f64) -> SurfaceJet,
    state: &State,
    course: &Course<'_>,
    along: f64,
    step: f64,
    method: Method,
) -> Stepped<State> {
    let next = match method {
        Method::RungeKutta => runge_kutta(surface, state, course, along, step)?,
        Method::Chords => chord(surface, state, course, along, step)?,
    };
    let jet = surface(next.at[0], next.at[1]);
    if !is_regular(&jet) {
        return Err(Refusal::End(End::Fold));
    }
    let speed = velocity(&jet, next.rate).length();
    let rate = next.rate.map(|rate| rate / speed);
    if rate.iter().all(|rate| rate.is_finite()) { Ok(State { rate, ..next }) } else { Err(Refusal::End(End::Fold)) }
}

fn runge_kutta(
    surface: &dyn Fn(f64, f64) -> SurfaceJet,
    state: &State,
    course: &Course<'_>,
    along: f64,
    step: f64,
) -> Stepped<State> {
    // The derivatives of parameters and rates; rates count as those of unit speed in their direction.
    let slope = |state: &State, along: f64| {
        let jet = surface(state.at[0], state.at[1]);
        if !is_regular(&jet) {
            return Err(Refusal::End(End::Fold));
        }
        let speed = velocity(&jet, state.rate).length();
        let rate = state.rate.map(|rate| rate / speed);
        let (velocity, bend) = (velocity(&jet, rate), bend(&jet, rate));
        let kappa = curvature(course, along).map_err(Refusal::Error)?;
        let geodesic = geodesic_curvature(&jet, velocity, bend, kappa, course.length).map_err(Refusal::End)?;
        let turn = if course.side == Side::Left { geodesic } else { -geodesic };
        Ok(State { at: rate, rate: rates(&jet, turn * jet.normal().cross(velocity) - bend) })
    };
    let moved = |slope: &State, step: f64| State {
        at: [0, 1].map(|k| state.at[k] + step * slope.at[k]),
        rate: [0, 1].map(|k| state.rate[k] + step * slope.rate[k]),
    };
    let half = 0.5 * step;
    let first = slope(state, along)?;
    let second = slope(&moved(&first, half), along + half)?;
    let third = slope(&moved(&second, half), along + half)?;
    let fourth = slope(&moved(&third, step), along + step)?;
    let mean = |k: usize, of: fn(&State) -> [f64; 2]| {
        (of(&first)[k] + 2.0 * of(&second)[k] + 2.0 * of(&third)[k] + of(&fourth)[k]) / 6.0
    };
    let mean = State { at: [0, 1].map(|k| mean(k, |s| s.at)), rate: [0, 1].map(|k| mean(k, |s| s.rate)) };
    Ok(moved(&mean, step))
}

fn chord(
    surface: &dyn Fn(f64, f64) -> SurfaceJet,
    state: &State,
    course: &Course<'_>,
    along: f64,
    step: f64,
) -> Stepped<State> {
    let at = [0, 1].map(|k| state.at[k] + step * state.rate[k]);
    let jet = surface(at[0], at[1]);
    if !is_regular(&jet) {
        return Err(Refusal::End(End::Fold));
    }
    let normal = jet.normal();
    let (t, q) = (velocity(&jet, state.rate), bend(&jet, state.rate));
    let kappa = curvature(course, along + step).map_err(Refusal::Error)?;
    let a = step * q.reject_from_normalized(normal) - t;
    let right = 0.5 * (step * step * (kappa * kappa - q.length_squared()) - 1.0 - t.length_squared()) + step * t.dot(q);
    let (length, unit) = (a.length(), a.normalize_or_zero());
    let part = right / length;
    let square = (1.0 - part) * (1.0 + part);
    if !(square > -ROUND_OFF) {
        return Err(Refusal::End(End::NoSolution {
            curvature: kappa,
            normal_curvature: normal.dot(q) / t.length_squared(),
        }));
    }
    let across = if square <= ROUND_OFF { 0.0 } else { square.sqrt() } * normal.cross(unit);
    let turn = |next: DVec3| normal.dot(t.cross(next));
    let (one, other) = (part * unit + across, part * unit - across);
    let is_one = (turn(one) > turn(other)) == (course.side == Side::Left);
    let next = if is_one { one } else { other };
    Ok(State { at, rate: rates(&jet, next) })
}
