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
//! **Coordinates.** Lengths are bad coordinates for strips: where they grow, a strip depends on them like `exp(4 s / L L')` (see
//! `strip.rs`), and most lengths belong to none. The same strips are had from numbers `v_k` without bounds: with the circle of quad
//! `k` made a line as in `quad.rs`, the next point of the border is at `s = ‖q‖ σ_k exp v_k`, `σ_k` its value at the start. All
//! `v` give strips whose corners are in cyclic order, and `exp v_k` is nearly the factor of the border's edge. Lengths follow.
//!
//! **Bounds.** Without bounds lengths and spacings drift away. A spacing is its first value times `exp(h tanh(x/h))`,
//! `h = ½ ln r`, all then scaled so that the ends stay: so the order along the curve is kept and two spacings change against each
//! other by `r` at most. A length that changes by the part `c` at most costs `−μ ln(1 − x²)` with `x` its change over `c`, a barrier: at
//! a bound without one the search would stop, since BFGS does not slide along.
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

/// Weight of the barrier at the bounds of lengths, in units of what is minimised at the start: on a rough strip of sixteen circles
/// weights from 1e-6 to 1e-3 end at values within 5 %, but without one a third higher.
const BARRIER: f64 = 1e-4;

/// How much an arc that is near or beyond the largest half angle at the start may exceed it, in radians: at a bound from the
/// beginning no step would be possible.
const ROOM: f64 = 0.2;

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
    /// The most that a length changes, as a part of its first value, above 0; may be infinite.
    pub length_change: f64,
    /// Weight of `Σ (L/L⁰ − 1)²` beside `D² F`, `D` the diagonal of the strip at the start.
    pub length_weight: f64,
    /// The largest angle from an arc's tangent to its chord, half of the angle that the arc spans; arcs that are near it
    /// or beyond at the start may exceed it by a little.
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
    /// What is minimised over `D²`, that is `F`, the barrier and the weight on lengths, at the start, where it is `F`, and after
    /// every iteration: never rising.
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
    if found.stop == Stop::Infeasible || at.states.len() < at.points.len() {
        let reason = "the strip at the start is at the border of what is feasible";
        return Err(Error::new(Status::NoSolution, reason).at("lengths"));
    }
    let strip = strip::of_borders(at.points, at.states.iter().map(|state| state.border).collect())?;
    let frame = net.orientation.frame(&at.angles).unwrap_or(input.frame);
    let after = at.states[at.states.len() - 1].energy;
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
    /// The same of the weight on lengths.
    length_cost: f64,
    /// What is minimised, up to and with this edge.
    cost: f64,
}

impl State {
    fn first(guide: DVec3, border: DVec3, frame: &Frame) -> Self {
        let energy = squared_curvature(border - guide, frame.t2).0;
        Self { guide, border, t1: frame.t1, t2: frame.t2, energy, length_cost: 0.0, cost: 0.0 }
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
        (Self { guide, border, t1, t2, energy, length_cost: 0.0, cost: 0.0 }, [along.1, beside.1, across.1])
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
    first_length: f64,
    /// `σ_k exp v_k`.
    steps: Vec<f64>,
    angles: Vec<f64>,
    states: Vec<State>,
}

/// The net as a function of the unknowns: one for each spacing, one for each length, the angles.
struct Net<'a> {
    curve: &'a dyn Fn(f64) -> DVec3,
    parameters: &'a [f64],
    lengths: &'a [f64],
    /// `σ_k`.
    steps: Vec<f64>,
    orientation: Orientation,
    first_point: DVec3,
    direction: DVec3,
    /// For each quad, the least cosines of its three arcs' half angles; first that of the first crossing edge.
    first_cosine: f64,
    cosines: Vec<[f64; 3]>,
    /// `½ ln r`, `c` and `μ` of the module's documentation.
    log_spacing: f64,
    length_change: f64,
    length_weight: f64,
    barrier: f64,
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
        let bound = |cosine: f64| least.min((cosine.clamp(-1.0, 1.0).acos() + ROOM).min(std::f64::consts::PI).cos());
        let first = State::first(points[0], strip.border[0], &frame);
        let first_cosine = bound(squared_curvature(first.border - first.guide, frame.t2).1);
        let (mut state, mut cosines) = (first, Vec::with_capacity(points.len() - 1));
        let mut steps = Vec::with_capacity(points.len() - 1);
        for k in 1..points.len() {
            let step = Quad::new(points[k - 1], strip.border[k - 1], points[k]).and_then(|quad| {
                Choice::of(&quad, quad.at_length(input.lengths[k])).map(|choice| choice.s / quad.unit())
            });
            steps.push(step.ok_or_else(|| strip::on_a_line(k - 1))?);
            let (next, found) = state.next(points[k], strip.border[k]);
            cosines.push(found.map(bound));
            state = next;
        }
        let extent = diagonal(&[strip.guide.as_slice(), &strip.border].concat());
        Ok(Self {
            curve: input.curve,
            parameters: input.parameters,
            lengths: input.lengths,
            steps,
            orientation,
            first_point: points[0],
            direction: (input.start - points[0]).normalize(),
            first_cosine,
            cosines,
            log_spacing: 0.5 * options.spacing_ratio.ln(),
            length_change: options.length_change,
            length_weight: options.length_weight,
            barrier: BARRIER * extent * extent * state.energy,
            diagonal: extent,
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
        let first_length = self.lengths[0] * x[n].exp();
        let steps = self.steps.iter().zip(&x[n + 1..]).map(|(step, v)| step * v.exp()).collect();
        At {
            x: x.to_vec(),
            parameters,
            points,
            first_length,
            steps,
            angles: x[2 * n + 1..].to_vec(),
            states: Vec::new(),
        }
    }

    fn first_state(&self, length: f64, angles: &[f64]) -> Option<State> {
        let frame = self.orientation.frame(angles)?;
        let state = State::first(self.first_point, self.first_point + length * self.direction, &frame);
        let (_, cosine) = squared_curvature(state.border - state.guide, frame.t2);
        if cosine < self.first_cosine { None } else { self.with_cost(state, 0, length, 0.0) }
    }

    /// The crossing edge after `state`, that of quad `k`; `None` where it is not feasible.
    fn next(&self, state: &State, k: usize, point: DVec3, step: f64) -> Option<State> {
        let quad = Quad::new(state.guide, state.border, point)?;
        let border = quad.point(step * quad.unit());
        let (next, cosines) = state.next(point, border);
        let is_feasible = (0..3).all(|i| cosines[i] >= self.cosines[k][i]);
        if is_feasible { self.with_cost(next, k + 1, border.distance(point), state.length_cost) } else { None }
    }

    /// `None` where the length is out of its bounds: the logarithm is infinite or not a number there.
    fn with_cost(&self, mut state: State, k: usize, length: f64, before: f64) -> Option<State> {
        let change = length / self.lengths[k] - 1.0;
        let part = change / self.length_change;
        let barrier = -((1.0 - part) * (1.0 + part)).ln();
        state.length_cost = before + self.length_weight * change * change + self.barrier * barrier;
        state.cost = self.diagonal * self.diagonal * state.energy + state.length_cost;
        state.cost.is_finite().then_some(state)
    }

    /// The cost of the whole net of which the crossing edge before `from` is known, where the point of `from` may be another and
    /// its step has a factor.
    fn cost_from(&self, state: Option<State>, from: usize, point: Option<DVec3>, factor: f64) -> f64 {
        let Some(mut state) = state else { return f64::INFINITY };
        let at = &self.at;
        for k in from..at.points.len() {
            let is_first = k == from;
            let point = point.filter(|_| is_first).unwrap_or(at.points[k]);
            let step = if is_first { factor * at.steps[k - 1] } else { at.steps[k - 1] };
            let Some(next) = self.next(&state, k - 1, point, step) else { return f64::INFINITY };
            state = next;
        }
        state.cost
    }
}

impl Objective for Net<'_> {
    fn value(&mut self, x: &[f64]) -> f64 {
        self.at = self.locate(x);
        let mut state = self.first_state(self.at.first_length, &self.at.angles);
        for k in 0..=self.quad_count() {
            let Some(found) = state else { return f64::INFINITY };
            self.at.states.push(found);
            if k < self.quad_count() {
                state = self.next(&found, k, self.at.points[k + 1], self.at.steps[k]);
            }
        }
        self.at.states[self.quad_count()].cost
    }

    fn gradient(&mut self, x: &[f64], _: f64, gradient: &mut [f64]) {
        let n = self.quad_count();
        if self.at.x != x {
            self.value(x);
        }
        let Some(value) = self.at.states.get(n).map(|state| state.cost) else { return gradient.fill(0.0) };
        let quotient =
            |h: f64, cost: &dyn Fn(f64) -> f64| bfgs::difference_quotient([(cost(-h), -h), (cost(h), h)], value);
        let at = &self.at;
        // By the parameters of the inner points, then by spacings: u_k = u_0 + T (w_0 + … + w_{k−1}) / Σ w, whence
        // ∂u_k/∂w_i = T/Σw ([i < k] − (u_k − u_0)/T).
        let span = self.parameters[n] - self.parameters[0];
        let h = DIFFERENCE * span.abs() / n as f64;
        let by_parameter = |k: usize| {
            quotient(h, &|h| {
                let point = (self.curve)(at.parameters[k] + h);
                if point.is_finite() {
                    self.cost_from(Some(at.states[k - 1]), k, Some(point), 1.0)
                } else {
                    f64::INFINITY
                }
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
        gradient[n] = quotient(DIFFERENCE, &|h| {
            self.cost_from(self.first_state(at.first_length * h.exp(), &at.angles), 1, None, 1.0)
        });
        for k in 0..n {
            gradient[n + 1 + k] = quotient(DIFFERENCE, &|h| self.cost_from(Some(at.states[k]), k + 1, None, h.exp()));
        }
        for i in 0..at.angles.len() {
            gradient[2 * n + 1 + i] = quotient(DIFFERENCE, &|h| {
                let mut angles = at.angles.clone();
                angles[i] += h;
                self.cost_from(self.first_state(at.first_length, &angles), 1, None, 1.0)
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
    within("length_change", length_change, length_change > 0.0, "a number above 0")?;
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
    use crate::geometry::canal::strip::tests::misfit;
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
        let start = points[0] + 1.5 * DVec3::Z.cross(tangent).normalize();
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
    fn a_rough_strip_becomes_smoother_and_stays_on_its_curve() {
        let options = Options::default();
        let (found, strip, frame) = smoothed(&options);
        assert!(found.history.windows(2).all(|pair| pair[1] <= pair[0]) && found.history.len() > 10);
        assert!((found.history[0] / found.before - 1.0).abs() < 1e-9);
        assert!(found.after < 0.15 * found.before && found.stop == Stop::Decrease, "{} {}", found.after, found.before);
        // By the arcs of the net, whose frames come back around every quad.
        assert!((energy_of_arcs(&strip, frame) / found.before - 1.0).abs() < 1e-9);
        assert!((energy_of_arcs(&found.strip, found.frame) / found.after - 1.0).abs() < 1e-9);
        assert!((energy(&found.strip, &found.frame).unwrap() / found.after - 1.0).abs() < 1e-12);
        for (point, &u) in found.strip.guide.iter().zip(&found.parameters) {
            assert!(point.distance(wave(u)) < 1e-12);
        }
        assert_eq!((found.strip.guide[0], found.strip.guide[16]), (strip.guide[0], strip.guide[16]));
        assert!(misfit(&found.strip).0 < 1e-11 && misfit(&found.strip).1 == 0);
        // The bounds.
        let spacings: Vec<f64> = found.parameters.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let (low, high) = spacings.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), &s| (l.min(s), h.max(s)));
        assert!(low > 0.0 && high / low <= 4.0 + 1e-9);
        let changes = found.strip.lengths.iter().zip(&strip.lengths).map(|(now, then)| (now / then - 1.0).abs());
        let largest = changes.fold(0.0, f64::max);
        assert!(largest > 0.1 && largest <= 0.25);
    }

    #[test]
    fn straight_edges_cost_nothing_and_are_found() {
        let line = |u: f64| 4.0 * u * DVec3::X;
        let (parameters, strip, _) = rough(&line);
        // Straight up to the crossing edges, then tilted.
        let flat = Frame::of_tangent_one(DVec3::X, DVec3::Z).unwrap();
        let bulging = Frame::of_tangent_one(DVec3::new(1.0, 0.1, 0.0), DVec3::new(0.0, -0.4, 1.0)).unwrap();
        assert!(energy(&strip, &flat).unwrap() < energy(&strip, &bulging).unwrap());
        let input = Input {
            curve: &line,
            parameters: &parameters,
            start: strip.border[0],
            lengths: &strip.lengths,
            frame: bulging,
        };
        let options = Options { turns_tangents: true, relative_decrease: 0.0, ..Options::default() };
        let found = smooth(&input, &options, &mut on).unwrap();
        assert!(found.after < 1e-3 * found.before, "{} {} {:?}", found.after, found.before, found.stop);
        assert!(found.frame.normal.cross(DVec3::Z).length() < 0.05);
    }

    #[test]
    fn the_gradient_that_goes_on_from_points_is_that_of_the_whole() {
        let (parameters, strip, frame) = rough(&wave);
        let input =
            Input { curve: &wave, parameters: &parameters, start: strip.border[0], lengths: &strip.lengths, frame };
        let cone = Cone { axis: 2.0 * DVec3::Z, angle_rad: 0.9 };
        for options in [
            Options { turns_tangents: true, length_weight: 3.0, ..Options::default() },
            Options { cone: Some(cone), ..Options::default() },
        ] {
            let mut net = Net::new(&input, &options).unwrap();
            let mut random = Random(5);
            let x: Vec<f64> = (0..net.unknown_count()).map(|_| random.between(-0.02, 0.02)).collect();
            let value = net.value(&x);
            assert!(value.is_finite());
            let (mut found, mut whole) = (vec![0.0; x.len()], vec![0.0; x.len()]);
            net.gradient(&x, value, &mut found);
            bfgs::central_differences(&mut |x| net.value(x), &x, value, &vec![1.0; x.len()], &mut whole);
            let scale = whole.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
            assert!(found.iter().zip(&whole).all(|(found, whole)| (found - whole).abs() < 1e-6 * scale));
        }
    }

    #[test]
    fn a_cone_a_weight_and_a_request_to_stop_are_kept() {
        let cone = Cone { axis: 2.0 * DVec3::Z, angle_rad: 0.7 };
        let (found, ..) = smoothed(&Options { cone: Some(cone), ..Options::default() });
        assert!((found.frame.normal.angle_between(DVec3::Z) - 0.7).abs() < 1e-12);
        assert!(found.after < found.before && found.history.windows(2).all(|pair| pair[1] <= pair[0]));
        let change = |found: &Smoothed, strip: &Strip| {
            let changes = found.strip.lengths.iter().zip(&strip.lengths).map(|(now, then)| (now / then - 1.0).powi(2));
            changes.sum::<f64>()
        };
        let (free, strip, _) = smoothed(&Options::default());
        let (held, ..) = smoothed(&Options { length_weight: 1e4, ..Options::default() });
        assert!(change(&held, &strip) < 0.1 * change(&free, &strip) && held.after < held.before);
        let (unbound, ..) =
            smoothed(&Options { length_change: f64::INFINITY, spacing_ratio: f64::INFINITY, ..Options::default() });
        assert!(unbound.after < free.after);
        let (parameters, strip, frame) = rough(&wave);
        let input =
            Input { curve: &wave, parameters: &parameters, start: strip.border[0], lengths: &strip.lengths, frame };
        let mut stop =
            |at: &Progress| if at.iteration == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        let found = smooth(&input, &Options::default(), &mut stop).unwrap();
        assert_eq!((found.stop, found.history.len()), (Stop::Cancelled, 4));
        assert!(found.after < found.before);
    }

    #[test]
    fn input_that_cannot_be_smoothed_is_named() {
        let (parameters, strip, frame) = rough(&wave);
        let input =
            Input { curve: &wave, parameters: &parameters, start: strip.border[0], lengths: &strip.lengths, frame };
        let refusal = |input: &Input<'_>, options: Options| {
            let error = smooth(input, &options, &mut on).unwrap_err();
            (error.status(), error.place().to_string())
        };
        let case = |status, place: &str| (status, place.to_string());
        let options = Options::default();
        let mut disordered = parameters.clone();
        disordered.swap(4, 5);
        let value = Status::InvalidValue;
        assert_eq!(refusal(&Input { parameters: &disordered, ..input }, options), case(value, "parameters[5]"));
        let short = case(Status::InvalidArgumentLength, "parameters");
        assert_eq!(refusal(&Input { parameters: &parameters[..1], ..input }, options), short);
        let broken = |u: f64| if u > 1.9 { DVec3::NAN } else { wave(u) };
        assert_eq!(refusal(&Input { curve: &broken, ..input }, options), case(value, "parameters[16]"));
        let mirrored = Frame { t1: -frame.t1, ..frame };
        assert_eq!(refusal(&Input { frame: mirrored, ..input }, options), case(value, "frame"));
        let mut longer = strip.lengths.clone();
        longer[8] += 3.0;
        assert_eq!(refusal(&Input { lengths: &longer, ..input }, options), case(Status::NoIntersection, "lengths[8]"));
        for (bad, place) in [
            (Options { spacing_ratio: 0.5, ..options }, "spacing_ratio"),
            (Options { length_change: 0.0, ..options }, "length_change"),
            (Options { length_weight: f64::NAN, ..options }, "length_weight"),
            (Options { half_angle_rad: 4.0, ..options }, "half_angle_rad"),
            (Options { cone: Some(Cone { axis: DVec3::ZERO, angle_rad: 1.0 }), ..options }, "cone.axis"),
            (Options { cone: Some(Cone { axis: DVec3::Z, angle_rad: f64::NAN }), ..options }, "cone.angle_rad"),
        ] {
            assert_eq!(refusal(&input, bad), case(value, place));
        }
        let along = Cone { axis: frame.t1, angle_rad: 0.0 };
        assert_eq!(refusal(&input, Options { cone: Some(along), ..options }), case(Status::Degenerate, "cone"));
    }

    #[test]
    #[ignore = "a measurement"]
    fn dbg() {
        let mut t = vec![];
        let mut it = 0;
        for _ in 0..50 {
            let s = std::time::Instant::now();
            let f = smoothed(&Options::default()).0;
            t.push(s.elapsed());
            it = f.history.len();
        }
        t.sort();
        println!("median {:?} min {:?} iterations {it} {:?}", t[25], t[0], smoothed(&Options::default()).0.after);
    }
}
