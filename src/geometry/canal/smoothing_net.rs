//! The cyclidic net of a strip as a function of numbers without bounds, for its smoothing.
//!
//! **Coordinates.** Lengths are bad coordinates for strips: where they grow, a strip depends on them like `exp(4 s / L L')` (see
//! `strip.rs`), and most lengths belong to none. The same strips are had from numbers `v_k` without bounds: with the circle of quad
//! `k` made a line as in `quad.rs`, the next point of the border is at `s = ‖q‖ σ_k exp v_k`, `σ_k` its value at the start. All
//! `v` give strips whose corners are in cyclic order, and `exp v_k` is nearly the factor of the border's edge. Lengths follow.
//!
//! **Bounds.** Without bounds lengths and spacings drift away. A spacing is its first value times `exp(h tanh(x/h))`, `h = ½ ln
//! r`, all then scaled so that the ends stay: so the order along the curve is kept and two spacings change against each other
//! by `r` at most. A length that changes by the part `c` at most costs `−μ ln(1 − x²)` with `x` its change over `c`, a barrier:
//! at a bound without one the search would stop, since BFGS does not slide along.
//!
//! **Angles.** Normals are found in spherical coordinates whose axis is the first tangent of the frame at the start: `λ` turns the
//! normal about it and `θ` tilts it along it, so that the frame at the start is as far as can be from the poles. The third angle
//! `ψ`, of the tangents about the normal, is free on request: the paper has two angles, a frame three.
//! With a cone the normal is at a constant angle to an axis; one angle `ω` about it replaces `λ` and `θ`.
//!
//! **Derivatives** are central differences in `u`, `v`, the first length and the angles; a change at `k` leaves everything before
//! point `k − 1` as it is, so each difference goes on from there. Those in `u` are handed on to the spacings exactly.

use glam::DVec3;

use super::frame::Frame;
use super::quad::Quad;
use super::smoothing::{Cone, Input, Options, check};
use super::strip::on_a_line;
use crate::error::{Error, Result, Status};
use crate::geometry::circle::reflect;
use crate::linalg::bfgs::{self, DIFFERENCE, Objective};
use crate::mesh::grid::diagonal;

/// Weight of the barrier at the bounds of lengths, in units of what is minimised at the start: on a rough strip of sixteen circles
/// weights from 1e-6 to 1e-3 end at values within 5 %, but without one a third higher.
const BARRIER: f64 = 1e-4;

/// Distance over the extent up to which the guide's points are on the curve and corners on their circles.
const ON: f64 = 1e-9;

/// How much an arc that is near or beyond the largest half angle at the start may exceed it, in radians: at a bound from the
/// beginning no step would be possible.
const ROOM: f64 = 0.2;

/// One crossing edge of the net.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub guide: DVec3,
    pub border: DVec3,
    t1: DVec3,
    t2: DVec3,
    /// Up to and with this edge.
    pub energy: f64,
    /// The same of the weight on lengths.
    length_cost: f64,
    /// What is minimised, up to and with this edge.
    cost: f64,
}

impl State {
    pub fn first(guide: DVec3, border: DVec3, frame: &Frame) -> Self {
        let energy = squared_curvature(border - guide, frame.t2).0;
        Self { guide, border, t1: frame.t1, t2: frame.t2, energy, length_cost: 0.0, cost: 0.0 }
    }

    /// The next crossing edge, and the cosines of the half angles of the arcs along the guide, along the border and across. The
    /// frame is handed on as in `frame.rs`.
    pub fn next(&self, guide: DVec3, border: DVec3) -> (Self, [f64; 3]) {
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
pub(super) struct Orientation {
    first: Frame,
    cone: Option<Cone>,
    turns_tangents: bool,
}

impl Orientation {
    fn count(&self) -> usize {
        (if self.cone.is_some() { 1 } else { 2 }) + usize::from(self.turns_tangents)
    }

    /// `λ, θ` or `ω`, then `ψ` where it is free.
    pub fn frame(&self, angles: &[f64]) -> Option<Frame> {
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
pub(super) struct At {
    x: Vec<f64>,
    pub parameters: Vec<f64>,
    pub points: Vec<DVec3>,
    first_length: f64,
    /// `σ_k exp v_k`.
    steps: Vec<f64>,
    pub angles: Vec<f64>,
    pub states: Vec<State>,
}

/// The net as a function of the unknowns: one for each spacing, one for each length, the angles.
pub(super) struct Net<'a> {
    curve: &'a dyn Fn(f64) -> DVec3,
    parameters: &'a [f64],
    lengths: Vec<f64>,
    /// `σ_k`.
    steps: Vec<f64>,
    pub orientation: Orientation,
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
    pub diagonal: f64,
    pub energy_at_start: f64,
    pub at: At,
}

impl<'a> Net<'a> {
    pub fn new(input: &Input<'a>, options: &Options) -> Result<Self> {
        check(input, options)?;
        let points: Vec<DVec3> = input.parameters.iter().map(|&u| (input.curve)(u)).collect();
        if let Some(k) = points.iter().position(|point| !point.is_finite()) {
            let reason = format!("the curve is not finite at {}: {}", input.parameters[k], points[k]);
            return Err(Error::new(Status::InvalidValue, reason).at(format!("parameters[{k}]")));
        }
        let border = &input.strip.border;
        let extent = diagonal(&[points.as_slice(), border].concat());
        if let Some(k) = (0..points.len()).find(|&k| !(points[k].distance(input.strip.guide[k]) <= ON * extent)) {
            let (found, expected) = (points[k], input.strip.guide[k]);
            let reason = format!("the curve is at {found} there, the strip's guide at {expected}");
            return Err(Error::new(Status::InvalidValue, reason).at(format!("parameters[{k}]")));
        }
        let lengths: Vec<f64> = points.iter().zip(border).map(|(p, q)| p.distance(*q)).collect();
        let steps = steps(&points, border, extent)?;
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
        let first = State::first(points[0], border[0], &frame);
        let first_cosine = bound(squared_curvature(first.border - first.guide, frame.t2).1);
        let (mut state, mut cosines) = (first, Vec::with_capacity(points.len() - 1));
        for k in 1..points.len() {
            let (next, found) = state.next(points[k], border[k]);
            cosines.push(found.map(bound));
            state = next;
        }
        Ok(Self {
            curve: input.curve,
            parameters: input.parameters,
            direction: (border[0] - points[0]).normalize(),
            lengths,
            steps,
            orientation,
            first_point: points[0],
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

    pub fn quad_count(&self) -> usize {
        self.parameters.len() - 1
    }

    pub fn unknown_count(&self) -> usize {
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

/// `σ_k` of a strip.
fn steps(points: &[DVec3], border: &[DVec3], extent: f64) -> Result<Vec<f64>> {
    let step = |k: usize| {
        let place = || format!("strip: quad {k}");
        let quad = Quad::new(points[k], border[k], points[k + 1]).ok_or_else(|| on_a_line(k).with_place(place()))?;
        let s = quad.place(border[k + 1]);
        let refusal = |status, reason: String| Err(Error::new(status, reason).at(place()));
        let distance = quad.point(s).distance(border[k + 1]);
        if !(distance <= ON * extent) {
            return refusal(Status::NotCircular, format!("its corners are {distance:e} off a circle"));
        }
        if !(s > 0.0) {
            return refusal(Status::NoSolution, "its corners are not in cyclic order".to_string());
        }
        Ok(s / quad.unit())
    };
    (0..points.len() - 1).map(step).collect()
}

/// A number without bounds mapped to between `−bound` and `bound`, 0 to 0 with the slope 1; and the slope.
fn bounded(x: f64, bound: f64) -> (f64, f64) {
    if bound == f64::INFINITY {
        return (x, 1.0);
    }
    let tanh = if bound > 0.0 { (x / bound).tanh() } else { 0.0 };
    (bound * tanh, if bound > 0.0 { 1.0 - tanh * tanh } else { 0.0 })
}
