//! Curves of given curvature on a surface: what snakes are fitted to (Bartoň et al. 2013, section 3.3).
//!
//! A curve `c(s)` of unit speed on a surface with the unit normal `n` has the curvature `κ(s) ≥ 0` where
//!
//! ```text
//! c'' = κ_n n + κ_g (n × c'),   κ_n = II(c', c'),   κ_g = ± √(κ² − κ_n²),
//! ```
//!
//! plus for a curve that turns left, seen from where `n` points. From a point and a direction there is one of either kind as long
//! as `κ` is above `|κ_n|`, and none where it is below.

use std::fmt;

use glam::DVec3;

use super::curve_step::{Refusal, State, advance, bend, curvature, directed, geodesic_curvature, is_regular, velocity};
use crate::error::{Error, Result, Status};
use crate::mesh::grid::check_finite_point;
use crate::mesh::reference::{ParametricSurface, SurfaceJet};

/// Steps of a curve at most: points that fit into memory with ease.
const MOST_STEPS: usize = 10_000_000;

/// How often the last step is halved to end at the boundary.
const HALVINGS: usize = 60;

/// Which way a curve turns, seen from where the surface's normal points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// To the left: counterclockwise.
    Left,
    /// To the right.
    Right,
}

/// How steps are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The classical method of Runge and Kutta, of fourth order.
    RungeKutta,
    /// The scheme of Bartoň et al., of first order.
    Chords,
}

/// How a curve is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Into how many steps the length is divided, 1 to ten millions.
    pub steps: usize,
    /// How they are taken.
    pub method: Method,
}

impl Default for Options {
    fn default() -> Self {
        Self { steps: 200, method: Method::RungeKutta }
    }
}

/// Which curve.
#[derive(Clone, Copy)]
pub struct Course<'a> {
    /// The curvature at a length from the start, 0 or more, in 1/model units.
    pub curvature: &'a dyn Fn(f64) -> f64,
    /// The length, above 0, in model units.
    pub length: f64,
    /// Which way it turns.
    pub side: Side,
}

impl fmt::Debug for Course<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { length, side, .. } = self;
        f.debug_struct("Course").field("length", length).field("side", side).finish_non_exhaustive()
    }
}

/// Why a curve ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// It is as long as asked for.
    Length,
    /// At the boundary of the surface, which it would leave.
    Boundary,
    /// The surface itself bends more along the curve than the curve may.
    NoSolution {
        /// The curvature asked for.
        curvature: f64,
        /// The normal curvature of the surface in the direction of the curve.
        normal_curvature: f64,
    },
    /// The surface has no tangent plane there, or folds.
    Fold,
}

/// A curve found.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvatureCurve {
    /// Its points, the start first; after it one for each step.
    pub points: Vec<DVec3>,
    /// The unit tangent at each point.
    pub tangents: Vec<DVec3>,
    /// The length from the start to each point, in model units.
    pub lengths: Vec<f64>,
    /// Why it ends.
    pub end: End,
}

/// The curve that begins at the point of the surface nearest to `start`, as [`mesh_curve`](super::mesh_curve::mesh_curve()) does on a
/// mesh: within the surface's ranges, and over the seam where it goes around.
///
/// # Errors
/// As [`curvature_curve`].
pub fn surface_curve<F: Fn(f64, f64) -> SurfaceJet + Sync>(
    surface: &ParametricSurface<F>,
    start: DVec3,
    tangent: DVec3,
    course: &Course<'_>,
    options: &Options,
) -> Result<CurvatureCurve> {
    check_finite_point("start", start)?;
    let everywhere = [f64::NEG_INFINITY, f64::INFINITY];
    let (ranges, around) = (surface.ranges(), surface.goes_around());
    let ranges = [0, 1].map(|k| if around[k] { everywhere } else { ranges[k] });
    curvature_curve(&|u, v| surface.at(u, v), ranges, surface.nearest_parameters(start), tangent, course, options)
}

/// The curve from the point with the parameters `start` in the direction of `tangent`, of which what is along the normal does not
/// count. `surface` gives the surface over the parameters `ranges[k][0]` to `ranges[k][1]`, which may be infinite: where it goes
/// around, a curve is to go on over the seam.
///
/// # Errors
/// Start or ranges that are not numbers, a start outside (`start`, `ranges`), a tangent without a direction on the surface
/// (`tangent`), a length that is not above 0 (`course.length`), a number of steps out of range (`options.steps`), a curvature that
/// is negative or not finite (`course.curvature`). Status `NoSolution`: the surface bends more than the curve may at the start
/// already (`course.curvature`); where it does later, the curve found ends there. Status `Degenerate`: no tangent plane at the
/// start (`start`).
pub fn curvature_curve(
    surface: &dyn Fn(f64, f64) -> SurfaceJet,
    ranges: [[f64; 2]; 2],
    start: [f64; 2],
    tangent: DVec3,
    course: &Course<'_>,
    options: &Options,
) -> Result<CurvatureCurve> {
    check(course, options)?;
    check_finite_point("tangent", tangent)?;
    for k in 0..2 {
        let ([low, high], at) = (ranges[k], start[k]);
        if !(low < high) {
            let reason = format!("expected the greater end second, found {low} and {high}");
            return Err(Error::new(Status::InvalidValue, reason).at(format!("ranges[{k}]")));
        }
        if !(at.is_finite() && (low..=high).contains(&at)) {
            let reason = format!("expected a number from {low} to {high}, found {at}");
            return Err(Error::new(Status::InvalidValue, reason).at(format!("start[{k}]")));
        }
    }
    let jet = surface(start[0], start[1]);
    if !is_regular(&jet) {
        let reason = "expected a point where the derivatives of the surface span a plane";
        return Err(Error::new(Status::Degenerate, reason).at("start"));
    }
    let rate = directed(&jet, tangent).ok_or_else(|| no_direction(tangent))?;
    let mut state = State { at: start, rate };
    check_start(&jet, &state, course)?;
    let mut curve = Recorder::new(jet.point, velocity(&jet, state.rate), course.length, options.steps);
    let is_inside = |state: &State| (0..2).all(|k| (ranges[k][0]..=ranges[k][1]).contains(&state.at[k]));
    while let Some((along, step)) = curve.next_step() {
        let take = |part: f64| advance(surface, &state, course, along, part * step, options.method);
        let found =
            take(1.0).and_then(|next| if is_inside(&next) { Ok(next) } else { Err(Refusal::End(End::Boundary)) });
        match found {
            Ok(next) => {
                state = next;
                let jet = surface(state.at[0], state.at[1]);
                curve.add(jet.point, velocity(&jet, state.rate), along + step);
            }
            Err(Refusal::Error(error)) => return Err(error),
            Err(Refusal::End(End::Boundary)) => {
                let last = last_inside(|part| take(part).ok().filter(is_inside));
                let last = last.map(|(part, state)| {
                    let jet = surface(state.at[0], state.at[1]);
                    (jet.point, velocity(&jet, state.rate), along + part * step)
                });
                return Ok(curve.ended(End::Boundary, last));
            }
            Err(Refusal::End(end)) => return Ok(curve.ended(end, None)),
        }
    }
    Ok(curve.ended(End::Length, None))
}

/// The longest part of a step, from 0 to 1, for which `take` finds something; none where that is no part.
pub(super) fn last_inside<T>(mut take: impl FnMut(f64) -> Option<T>) -> Option<(f64, T)> {
    let (mut low, mut high, mut best) = (0.0, 1.0, None);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        match take(middle) {
            Some(found) => {
                low = middle;
                best = Some((middle, found));
            }
            None => high = middle,
        }
    }
    best
}

/// Checks what does not depend on the surface.
pub(super) fn check(course: &Course<'_>, options: &Options) -> Result<()> {
    if !(course.length > 0.0 && course.length.is_finite()) {
        let reason = format!("expected a finite length above 0, found {}", course.length);
        return Err(Error::new(Status::InvalidValue, reason).at("course.length"));
    }
    if !(1..=MOST_STEPS).contains(&options.steps) {
        let reason = format!("expected 1 to {MOST_STEPS}, found {}", options.steps);
        return Err(Error::new(Status::InvalidValue, reason).at("options.steps"));
    }
    Ok(())
}

pub(super) fn no_direction(tangent: DVec3) -> Error {
    let reason = format!("expected a direction that is not along the normal of the surface, found {tangent}");
    Error::new(Status::InvalidValue, reason).at("tangent")
}

/// Refuses a curve that cannot even begin.
pub(super) fn check_start(jet: &SurfaceJet, state: &State, course: &Course<'_>) -> Result<()> {
    let curvature = curvature(course, 0.0)?;
    match geodesic_curvature(jet, velocity(jet, state.rate), bend(jet, state.rate), curvature, course.length) {
        Err(End::NoSolution { curvature, normal_curvature }) => {
            let reason = format!(
                "expected at least {}, which the surface bends by in this direction at the start, the length 0; found {curvature}",
                normal_curvature.abs()
            );
            Err(Error::new(Status::NoSolution, reason).at("course.curvature"))
        }
        _ => Ok(()),
    }
}

/// Collects a curve step by step.
pub(super) struct Recorder {
    curve: CurvatureCurve,
    length: f64,
    steps: usize,
}

impl Recorder {
    pub fn new(point: DVec3, tangent: DVec3, length: f64, steps: usize) -> Self {
        let curve =
            CurvatureCurve { points: vec![point], tangents: vec![tangent], lengths: vec![0.0], end: End::Length };
        Self { curve, length, steps }
    }

    /// From which length on the next step goes, and how far; none after the last.
    pub fn next_step(&self) -> Option<(f64, f64)> {
        let (taken, h) = (self.curve.points.len() - 1, self.length / self.steps as f64);
        (taken < self.steps).then_some((taken as f64 * h, h))
    }

    pub fn add(&mut self, point: DVec3, tangent: DVec3, length: f64) {
        self.curve.points.push(point);
        self.curve.tangents.push(tangent);
        self.curve.lengths.push(length);
    }

    /// The curve, with a last point if there is one.
    pub fn ended(mut self, end: End, last: Option<(DVec3, DVec3, f64)>) -> CurvatureCurve {
        if let Some((point, tangent, length)) = last {
            self.add(point, tangent, length);
        }
        CurvatureCurve { end, ..self.curve }
    }
}

#[cfg(test)]
mod tests;
