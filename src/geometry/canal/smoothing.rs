//! Smoother cyclidic strips by moving points along the guide curve and changing lengths and the frame (section 3.3, Fig. 7).
//!
//! A strip with a frame at `P_0` carries a cyclidic net, all of whose edges are arcs. What is minimised, by BFGS, is the sum of
//! their squared curvatures over all edges, along and across (equation 5),
//!
//! ```text
//! F(u, L, λ, θ) = Σ 1/R²,     1/R² = 4 (d² − (d·t)²) / d⁴    for an edge d with the arc's unit tangent t at its start
//! ```
//!
//! over the parameters `u` of the guide's inner points (both ends stay), the lengths `L` of the crossing edges and the angles of
//! the frame. The guide curve is met exactly whatever the parameters. The first crossing edge keeps its direction.
//!
//! **Bounds by construction.** Without bounds lengths and spacings drift away. The unknowns are numbers without bounds, mapped
//! into them: a length is `L⁰ (1 + c tanh(x/c))`, and a spacing is its first value times `exp(h tanh(x/h))`, `h = ½ ln r`, all
//! then scaled so that the ends stay. So the order along the curve is kept, two spacings change against each other by `r` at most,
//! and a length by the part `c`.
//!
//! **Angles.** Normals are found in spherical coordinates whose axis is the first tangent of the frame at the start: `λ` turns the
//! normal about it and `θ` tilts it along it, so that the frame at the start is as far as can be from the poles. The third angle
//! `ψ`, of the tangents about the normal, is free on request: the paper has two angles, a frame three.
//! With a cone the normal is at a constant angle to an axis; one angle `ω` about it replaces `λ` and `θ`.
//!
//! **Derivatives** are central differences in `u`, `L` and the angles; a change at `k` leaves everything before point `k − 1` as it
//! is, so each difference goes on from there. They are handed on to the unknowns exactly.
//!
//! Strips that do not exist or are crossed, and arcs of more than a stated angle, are infeasible. Where the least value is beside
//! them, the gradient does not vanish there: the run ends because `F` hardly falls.

use std::ops::ControlFlow;

use glam::DVec3;

use super::frame::Frame;
use super::quad::{Choice, Quad};
use super::strip::{self, Strip};
use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::reflect;
use crate::linalg::bfgs::{self, DIFFERENCE, Objective, Progress, Stop};
use crate::mesh::grid::diagonal;

/// What is smoothed.
#[derive(Clone, Copy)]
pub struct Input<'a> {
    /// The guide curve.
    pub curve: &'a dyn Fn(f64) -> DVec3,
    /// Where on it the guide's points are, `n + 1`, rising or falling.
    pub parameters: &'a [f64],
    /// The other end of the first crossing edge.
    pub start: DVec3,
    /// The lengths of the crossing edges, `n + 1`, as for [`strip::of_lengths`].
    pub lengths: &'a [f64],
    /// The frame at the first point of the guide; its first tangent near the guide's.
    pub frame: Frame,
}

impl std::fmt::Debug for Input<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { curve: _, parameters, start, lengths, frame } = self;
        f.debug_struct("Input")
            .field("parameters", parameters)
            .field("start", start)
            .field("lengths", lengths)
            .field("frame", frame)
            .finish_non_exhaustive()
    }
}

/// A cone on which the normal stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Its axis: a normal of the reference plane.
    pub axis: DVec3,
    /// The angle of the normal to it, 0 to π.
    pub angle_rad: f64,
}

/// Bounds, weights and stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The normal's angle to an axis, if it is given.
    pub cone: Option<Cone>,
    /// Whether the tangents turn about the normal (`ψ`).
    pub turns_tangents: bool,
    /// The most that two spacings of parameters change against each other, 1 (they stay) or more; may be infinite.
    pub spacing_ratio: f64,
    /// The most that a length changes, as a part of its first value, 0 (they stay) to below 1.
    pub length_change: f64,
    /// Weight of `Σ (L/L⁰ − 1)²` beside `D² F`, `D` the diagonal of the strip at the start.
    pub length_weight: f64,
    /// The largest angle from an arc's tangent to its chord, half of the angle that the arc spans; arcs that exceed it at the
    /// start may stay beyond.
    pub half_angle_rad: f64,
    /// The most iterations.
    pub max_iterations: usize,
    /// Stop where the largest entry of the gradient is at most this part of the value,
    pub relative_gradient: f64,
    /// or where the value fell by less than this part in five iterations.
    pub relative_decrease: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            cone: None,
            turns_tangents: false,
            spacing_ratio: 4.0,
            length_change: 0.25,
            length_weight: 0.0,
            half_angle_rad: 0.75 * std::f64::consts::PI,
            max_iterations: 200,
            relative_gradient: 1e-6,
            relative_decrease: 1e-4,
        }
    }
}

/// A smoothed strip.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// Where on the curve the guide's points are.
    pub parameters: Vec<f64>,
    /// The strip.
    pub strip: Strip,
    /// The frame at its first point.
    pub frame: Frame,
    /// `F` at the start.
    pub before: f64,
    /// `F` at the end.
    pub after: f64,
    /// `F`, with the weight on lengths if there is one, at the start and after every iteration: never rising.
    pub history: Vec<f64>,
    /// Why it stopped; cancelled runs have their best so far.
    pub stop: Stop,
}

/// Smooths a strip.
///
/// # Errors
/// As [`strip::of_lengths`] where it is strict. Parameters that do not rise or fall throughout, a curve that is not finite, a frame
/// that is none, an option outside its domain. Status `Degenerate`: the cone and the first tangent allow no frame.
pub fn smooth(
    input: &Input<'_>,
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Smoothed> {
    let mut net = Net::new(input, options)?;
    let limits = bfgs::Options {
        gradient: 0.0,
        relative_gradient: options.relative_gradient,
        relative_decrease: options.relative_decrease,
        decrease_iterations: 5,
        max_iterations: options.max_iterations,
        first_step: 0.1,
    };
    let before = net.energy_at_start;
    let squared = net.diagonal * net.diagonal;
    let mut shown =
        |at: &Progress| progress(&Progress { value: at.value / squared, gradient: at.gradient / squared, ..*at });
    let start = vec![0.0; net.unknown_count()];
    let found = bfgs::minimise(&mut net, &start, &limits, &mut shown);
    net.value(&found.x);
    let at = net.at.clone();
    let start = net.first_across(at.lengths[0]);
    let options = strip::Options { is_strict: true, ..Default::default() };
    let strip = strip::of_lengths(&at.points, start, &at.lengths, &options)?;
    let frame = net.orientation.frame(&at.angles).unwrap_or(input.frame);
    let after = at.states.last().map_or(before, |state| state.energy);
    let history = found.history.iter().map(|value| value / squared).collect();
    Ok(Smoothed { parameters: at.parameters, strip, frame, before, after, history, stop: found.stop })
}

/// `F` of a strip with a frame at its first point, in one over squared model units.
///
/// # Errors
/// The frame is none.
pub fn energy(strip: &Strip, frame: &Frame) -> Result<f64> {
    frame.check("frame")?;
    let mut state = State::first(strip.guide[0], strip.border[0], frame);
    for k in 1..strip.guide.len() {
        state = state.next(strip.guide[k], strip.border[k]).0;
    }
    Ok(state.energy)
}

/// One crossing edge of the net.
#[derive(Clone, Copy, Debug)]
struct State {
    guide: DVec3,
    border: DVec3,
    t1: DVec3,
    t2: DVec3,
    /// Up to and with this edge.
    energy: f64,
}

impl State {
    fn first(guide: DVec3, border: DVec3, frame: &Frame) -> Self {
        let energy = squared_curvature(border - guide, frame.t2).0;
        Self { guide, border, t1: frame.t1, t2: frame.t2, energy }
    }

    /// The next crossing edge, and the cosines of the half angles of the arcs along the guide, along the border and across. The
    /// frame is handed on as in `frame.rs`.
    fn next(&self, guide: DVec3, border: DVec3) -> (Self, [f64; 3]) {
        let step = guide - self.guide;
        let (t1, t2) = (-reflect(self.t1, step), reflect(self.t2, step));
        let across_t1 = reflect(self.t1, self.border - self.guide);
        let along = squared_curvature(step, self.t1);
        let beside = squared_curvature(border - self.border, across_t1);
        let across = squared_curvature(border - guide, t2);
        let energy = self.energy + along.0 + beside.0 + across.0;
        (Self { guide, border, t1, t2, energy }, [along.1, beside.1, across.1])
    }
}

/// `1/R²` of the arc with this chord and start tangent, and the cosine of the angle between them.
fn squared_curvature(chord: DVec3, tangent: DVec3) -> (f64, f64) {
    let (squared, along) = (chord.length_squared(), chord.dot(tangent));
    (4.0 * (squared - along * along).max(0.0) / (squared * squared), along / squared.sqrt())
}

/// Frames of given angles.
struct Orientation {
    first: Frame,
    cone: Option<Cone>,
    turns_tangents: bool,
}

impl Orientation {
    fn count(&self) -> usize {
        (if self.cone.is_some() { 1 } else { 2 }) + usize::from(self.turns_tangents)
    }

    /// `λ, θ` or `ω`, then `ψ` where it is free.
    fn frame(&self, angles: &[f64]) -> Option<Frame> {
        let psi = if self.turns_tangents { angles[angles.len() - 1] } else { 0.0 };
        let turned = |frame: Frame| {
            let (sine, cosine) = psi.sin_cos();
            let Frame { t1, t2, normal } = frame;
            Frame { t1: cosine * t1 + sine * t2, t2: cosine * t2 - sine * t1, normal }
        };
        let Frame { t1, t2, normal } = self.first;
        let Some(Cone { axis, angle_rad }) = self.cone else {
            let ((sl, cl), (st, ct)) = (angles[0].sin_cos(), angles[1].sin_cos());
            // About t1, then about the new t2.
            let (t2, up) = (cl * t2 + sl * normal, cl * normal - sl * t2);
            return Some(turned(Frame { t1: ct * t1 - st * up, t2, normal: ct * up + st * t1 }));
        };
        // From where the first normal is nearest.
        let aside = normal.reject_from_normalized(axis);
        let x =
            if aside.length() > 1e-9 { aside.normalize() } else { t2.reject_from_normalized(axis).try_normalize()? };
        let y = axis.cross(x);
        let ((sine, cosine), (so, co)) = (angle_rad.sin_cos(), angles[0].sin_cos());
        let normal = cosine * axis + sine * (co * x + so * y);
        let t1 = t1.reject_from_normalized(normal);
        let t1 = if t1.length() > 1e-6 { t1.normalize() } else { return None };
        Some(turned(Frame { t1, t2: normal.cross(t1), normal }))
    }
}

/// The net at given unknowns.
#[derive(Clone, Default)]
struct At {
    x: Vec<f64>,
    parameters: Vec<f64>,
    points: Vec<DVec3>,
    lengths: Vec<f64>,
    angles: Vec<f64>,
    states: Vec<State>,
}

/// The net as a function of the unknowns: one for each spacing, one for each length, the angles.
struct Net<'a> {
    curve: &'a dyn Fn(f64) -> DVec3,
    parameters: &'a [f64],
    lengths: &'a [f64],
    orientation: Orientation,
    first_point: DVec3,
    direction: DVec3,
    /// For each quad, the least cosines of its three arcs' half angles; first that of the first crossing edge.
    first_cosine: f64,
    cosines: Vec<[f64; 3]>,
    /// `½ ln r` and `c` of the module's documentation.
    log_spacing: f64,
    length_change: f64,
    length_weight: f64,
    diagonal: f64,
    energy_at_start: f64,
    at: At,
}

impl<'a> Net<'a> {
    fn new(input: &Input<'a>, options: &Options) -> Result<Self> {
        check(input, options)?;
        let points: Vec<DVec3> = input.parameters.iter().map(|&u| (input.curve)(u)).collect();
        if let Some(k) = points.iter().position(|point| !point.is_finite()) {
            let reason = format!("the curve is not finite at {}: {}", input.parameters[k], points[k]);
            return Err(Error::new(Status::InvalidValue, reason).at(format!("parameters[{k}]")));
        }
        let strict = strip::Options { is_strict: true, ..Default::default() };
        let strip = strip::of_lengths(&points, input.start, input.lengths, &strict)?;
        let cone = match options.cone {
            Some(cone) => {
                let axis = cone.axis.try_normalize().ok_or_else(|| {
                    Error::new(Status::InvalidValue, format!("expected a direction, found {}", cone.axis))
                        .at("cone.axis")
                })?;
                Some(Cone { axis, ..cone })
            }
            None => None,
        };
        let orientation = Orientation { first: input.frame, cone, turns_tangents: options.turns_tangents };
        let frame = orientation.frame(&vec![0.0; orientation.count()]).ok_or_else(|| {
            let reason = "the first tangent of the frame is in the direction of the normal that the cone demands";
            Error::new(Status::Degenerate, reason).at("cone")
        })?;
        let least = options.half_angle_rad.cos();
        let bound = |cosine: f64| if cosine < least { -1.0 } else { least };
        let first = State::first(points[0], strip.border[0], &frame);
        let first_cosine = bound(squared_curvature(first.border - first.guide, frame.t2).1);
        let (mut state, mut cosines) = (first, Vec::with_capacity(points.len() - 1));
        for k in 1..points.len() {
            let (next, found) = state.next(points[k], strip.border[k]);
            cosines.push(found.map(bound));
            state = next;
        }
        let ends = [strip.guide.as_slice(), &strip.border].concat();
        Ok(Self {
            curve: input.curve,
            parameters: input.parameters,
            lengths: input.lengths,
            orientation,
            first_point: points[0],
            direction: (input.start - points[0]).normalize(),
            first_cosine,
            cosines,
            log_spacing: 0.5 * options.spacing_ratio.ln(),
            length_change: options.length_change,
            length_weight: options.length_weight,
            diagonal: diagonal(&ends),
            energy_at_start: state.energy,
            at: At::default(),
        })
    }

    fn quad_count(&self) -> usize {
        self.parameters.len() - 1
    }

    fn unknown_count(&self) -> usize {
        2 * self.quad_count() + 1 + self.orientation.count()
    }

    fn first_across(&self, length: f64) -> DVec3 {
        self.first_point + length * self.direction
    }

    /// The spacings before they are scaled, and the derivative of each by its unknown over itself.
    fn spacings(&self, x: &[f64]) -> Vec<(f64, f64)> {
        let spacing = |k: usize| {
            let (log, slope) = bounded(x[k], self.log_spacing);
            ((self.parameters[k + 1] - self.parameters[k]) * log.exp(), slope)
        };
        (0..self.quad_count()).map(spacing).collect()
    }

    fn locate(&self, x: &[f64]) -> At {
        let n = self.quad_count();
        let spacings = self.spacings(x);
        let total: f64 = spacings.iter().map(|(spacing, _)| spacing).sum();
        let (first, last) = (self.parameters[0], self.parameters[n]);
        let mut parameters = vec![first];
        let mut sum = 0.0;
        for (spacing, _) in &spacings[..n - 1] {
            sum += spacing;
            parameters.push(first + (last - first) * (sum / total));
        }
        parameters.push(last);
        let points = parameters.iter().map(|&u| (self.curve)(u)).collect();
        let length = |k: usize| self.lengths[k] * (1.0 + bounded(x[n + k], self.length_change).0);
        let lengths = (0..=n).map(length).collect();
        At { x: x.to_vec(), parameters, points, lengths, angles: x[2 * n + 1..].to_vec(), states: Vec::new() }
    }

    fn first_state(&self, length: f64, angles: &[f64]) -> Option<State> {
        let frame = self.orientation.frame(angles)?;
        let state = State::first(self.first_point, self.first_across(length), &frame);
        let (_, cosine) = squared_curvature(state.border - state.guide, frame.t2);
        (cosine >= self.first_cosine).then_some(state)
    }

    /// The crossing edge after `state`, that of quad `k`; `None` where it is not feasible.
    fn next(&self, state: &State, k: usize, point: DVec3, length: f64) -> Option<State> {
        let quad = Quad::new(state.guide, state.border, point)?;
        let choice = Choice::of(&quad, quad.at_length(length)).filter(|choice| !choice.is_flipped)?;
        let (next, cosines) = state.next(point, quad.point(choice.s));
        let is_feasible = (0..3).all(|i| cosines[i] >= self.cosines[k][i]);
        (is_feasible && next.energy.is_finite()).then_some(next)
    }

    /// The energy of the whole net where only point or length `k` is another one.
    fn energy_with(&self, k: usize, point: DVec3, length: f64) -> f64 {
        let at = &self.at;
        let first = if k == 0 { self.first_state(length, &at.angles) } else { Some(at.states[k - 1]) };
        self.energy_from(first, k.max(1), |j| if j == k { (point, length) } else { (at.points[j], at.lengths[j]) })
    }

    /// The energy of the whole net of which the crossing edge before `from` is known.
    fn energy_from(&self, state: Option<State>, from: usize, edge: impl Fn(usize) -> (DVec3, f64)) -> f64 {
        let Some(mut state) = state else { return f64::INFINITY };
        for k in from..=self.quad_count() {
            let (point, length) = edge(k);
            let Some(next) = self.next(&state, k - 1, point, length) else { return f64::INFINITY };
            state = next;
        }
        state.energy
    }

    /// The length of `k` over the first one, less one.
    fn change(&self, x: &[f64], k: usize) -> (f64, f64) {
        bounded(x[self.quad_count() + k], self.length_change)
    }
}

impl Objective for Net<'_> {
    fn value(&mut self, x: &[f64]) -> f64 {
        self.at = self.locate(x);
        let mut state = self.first_state(self.at.lengths[0], &self.at.angles);
        for k in 0..=self.quad_count() {
            let Some(found) = state else { return f64::INFINITY };
            self.at.states.push(found);
            if k < self.quad_count() {
                state = self.next(&found, k, self.at.points[k + 1], self.at.lengths[k + 1]);
            }
        }
        let energy = self.at.states[self.quad_count()].energy;
        let penalty: f64 = (0..=self.quad_count()).map(|k| self.change(x, k).0.powi(2)).sum();
        self.diagonal * self.diagonal * energy + self.length_weight * penalty
    }

    fn gradient(&mut self, x: &[f64], _: f64, gradient: &mut [f64]) {
        let n = self.quad_count();
        if self.at.x != x {
            self.value(x);
        }
        let Some(value) = self.at.states.get(n).map(|state| state.energy) else { return gradient.fill(0.0) };
        let squared = self.diagonal * self.diagonal;
        let quotient = |h: f64, energy: &dyn Fn(f64) -> f64| {
            squared * bfgs::difference_quotient([(energy(-h), -h), (energy(h), h)], value)
        };
        let at = &self.at;
        // By the parameters of the inner points, then by spacings: u_k = u_0 + T (w_0 + … + w_{k−1}) / Σ w, whence
        // ∂u_k/∂w_i = T/Σw ([i < k] − (u_k − u_0)/T).
        let span = self.parameters[n] - self.parameters[0];
        let h = DIFFERENCE * span.abs() / n as f64;
        let by_parameter = |k: usize| {
            quotient(h, &|h| {
                let point = (self.curve)(at.parameters[k] + h);
                if point.is_finite() { self.energy_with(k, point, at.lengths[k]) } else { f64::INFINITY }
            })
        };
        let by_parameters: Vec<f64> = (1..n).map(by_parameter).collect();
        let part = |k: usize| (at.parameters[k] - at.parameters[0]) / span;
        let mean: f64 = (1..n).map(|k| part(k) * by_parameters[k - 1]).sum();
        let spacings = self.spacings(x);
        let total: f64 = spacings.iter().map(|(spacing, _)| spacing).sum();
        let mut later: f64 = by_parameters.iter().sum();
        for (i, (spacing, slope)) in spacings.into_iter().enumerate() {
            // `later` sums over the points beyond spacing i.
            gradient[i] = span / total * (later - mean) * spacing * slope;
            if i + 1 < n {
                later -= by_parameters[i];
            }
        }
        for k in 0..=n {
            let by_length =
                quotient(DIFFERENCE * self.lengths[k], &|h| self.energy_with(k, at.points[k], at.lengths[k] + h));
            let (change, slope) = self.change(x, k);
            gradient[n + k] = slope * (self.lengths[k] * by_length + 2.0 * self.length_weight * change);
        }
        for i in 0..at.angles.len() {
            gradient[2 * n + 1 + i] = quotient(DIFFERENCE, &|h| {
                let mut angles = at.angles.clone();
                angles[i] += h;
                self.energy_from(self.first_state(at.lengths[0], &angles), 1, |j| (at.points[j], at.lengths[j]))
            });
        }
    }
}

/// A number without bounds mapped to between `−bound` and `bound`, 0 to 0 with the slope 1; and the slope.
fn bounded(x: f64, bound: f64) -> (f64, f64) {
    if bound == f64::INFINITY {
        return (x, 1.0);
    }
    let tanh = if bound > 0.0 { (x / bound).tanh() } else { 0.0 };
    (bound * tanh, if bound > 0.0 { 1.0 - tanh * tanh } else { 0.0 })
}

fn check(input: &Input<'_>, options: &Options) -> Result<()> {
    let parameters = input.parameters;
    if parameters.len() < 2 {
        let reason = format!("expected at least 2, found {}", parameters.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("parameters"));
    }
    super::combescure::check_count("parameters", parameters, parameters.len())?;
    let is_rising = parameters[1] > parameters[0];
    let in_order = |pair: &[f64]| if is_rising { pair[1] > pair[0] } else { pair[1] < pair[0] };
    if let Some(k) = parameters.windows(2).position(|pair| !in_order(pair)) {
        let reason = format!("expected parameters that rise or fall throughout, found {}", parameters[k + 1]);
        return Err(Error::new(Status::InvalidValue, reason).at(format!("parameters[{}]", k + 1)));
    }
    input.frame.check("frame")?;
    let within = |name: &str, value: f64, is_fine: bool, expected: &str| {
        let reason = || format!("expected {expected}, found {value}");
        if is_fine { Ok(()) } else { Err(Error::new(Status::InvalidValue, reason()).at(name)) }
    };
    let Options { spacing_ratio, length_change, length_weight, half_angle_rad, .. } = *options;
    within("spacing_ratio", spacing_ratio, spacing_ratio >= 1.0, "1 or more")?;
    within("length_change", length_change, (0.0..1.0).contains(&length_change), "0 to below 1")?;
    let is_weight = length_weight >= 0.0 && length_weight < f64::INFINITY;
    within("length_weight", length_weight, is_weight, "0 or more")?;
    let is_angle = half_angle_rad > 0.0 && half_angle_rad <= std::f64::consts::PI;
    within("half_angle_rad", half_angle_rad, is_angle, "above 0 up to π")?;
    within("relative_gradient", options.relative_gradient, options.relative_gradient >= 0.0, "0 or more")?;
    within("relative_decrease", options.relative_decrease, options.relative_decrease >= 0.0, "0 or more")?;
    if let Some(cone) = options.cone {
        finite("cone.angle_rad", cone.angle_rad)?;
        crate::mesh::grid::check_finite("cone.axis", &[cone.axis]).map_err(|error| error.with_place("cone.axis"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::canal::frame;
    use crate::geometry::canal::strip::{of_border_edges, of_lengths};
    use crate::geometry::circle::Arc;
    use crate::geometry::random::Random;

    fn wave(u: f64) -> DVec3 {
        DVec3::new(4.0 * u, (2.5 * u).sin(), 0.3 * u * u)
    }

    /// A strip of sixteen circles with border edges that vary at random, and a frame whose crossing arcs rise from it.
    fn rough(curve: &dyn Fn(f64) -> DVec3) -> (Vec<f64>, Strip, Frame) {
        let mut random = Random(77);
        let parameters: Vec<f64> = (0..=16).map(|k| 2.0 * f64::from(k) / 16.0).collect();
        let points: Vec<DVec3> = parameters.iter().map(|&u| curve(u)).collect();
        let tangent = (curve(1e-6) - points[0]).normalize();
        let start = points[0] + 1.5 * tangent.cross(DVec3::Z).normalize();
        let even = strip::Options { fits_start: true, ..Default::default() };
        let even = of_lengths(&points, start, &[1.5; 17], &even).unwrap();
        let edges: Vec<f64> =
            even.border.windows(2).map(|pair| pair[0].distance(pair[1]) * random.between(0.7, 1.3)).collect();
        let start = even.border[0];
        let strip = of_border_edges(&points, start, &edges).unwrap();
        let frame = Frame::of_tangent_one(tangent, DVec3::Z + (points[0] - start).normalize()).unwrap();
        (parameters, strip, frame)
    }

    fn on(_: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn smoothed(options: &Options) -> (Smoothed, Strip, Frame) {
        let (parameters, strip, frame) = rough(&wave);
        let input =
            Input { curve: &wave, parameters: &parameters, start: strip.border[0], lengths: &strip.lengths, frame };
        (smooth(&input, options, &mut on).unwrap(), strip, frame)
    }

    /// The sum over all edges of the grid with frames at all points, by the arcs themselves.
    fn energy_of_arcs(strip: &Strip, first: Frame) -> f64 {
        let grid = strip.grid().unwrap();
        let frames = frame::frames(&grid, first).unwrap();
        let curvature = |from: (usize, usize), to: (usize, usize), along: bool| {
            let frame = frames[grid.index(from.0, from.1)];
            let tangent = if along { frame.t1 } else { frame.t2 };
            Arc { start: grid.at(from.0, from.1), tangent, end: grid.at(to.0, to.1) }.curvature().length_squared()
        };
        let n = grid.rows();
        let along = (0..n - 1).flat_map(|i| [0, 1].map(|j| curvature((i, j), (i + 1, j), true)));
        along.sum::<f64>() + (0..n).map(|i| curvature((i, 0), (i, 1), false)).sum::<f64>()
    }

    #[test]
    fn dbg() {
        let t = std::time::Instant::now();
        let (found, strip, frame) = smoothed(&Options::default());
        println!("{:?} {} {:?} {:?}", t.elapsed(), found.history.len(), found.stop, found.history);
        println!("{} {}", energy_of_arcs(&strip, frame), energy_of_arcs(&found.strip, found.frame));
        println!("{:?}\n{:?}\n{:?}", strip.lengths, found.strip.lengths, found.parameters);
        let (found, ..) = smoothed(&Options { relative_decrease: 0.0, turns_tangents: true, ..Default::default() });
        println!("{} {:?} {:?}", found.history.len(), found.stop, found.history.last());
    }
}
