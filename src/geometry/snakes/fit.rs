//! A snake fitted to a curve (Bartoň et al. 2013, section 3.3).
//!
//! Each of `N` arcs of equal length stands for a part of the curve, and is as curved as the curve is there on average. Contacts
//! begin evenly spaced on the curve, and a vertex halfway between where the tangents at its two contacts lead. Then
//!
//! ```text
//! Σ (|p_i − p_j| − d_ij)² + ν F_prox,
//! F_prox = Σ_j mean_k [ (|o_j − c_jk| − r_j)² + (n_j · (c_jk − o_j))² ] + |p_0 − c_first|² + |p_{N+1} − c_last|²
//! ```
//!
//! is minimised, `c_jk` being the points of the curve that belong to arc `j`, `o_j` its centre and `n_j` its unit normal. The paper
//! has the first term of `F_prox` alone, which measures the distance to a sphere: the second makes it that to the circle, to first
//! order. The last two keep arcs from gliding along a curve of constant curvature, which changes nothing else. Then `ν` is lowered,
//! so that distances are met ever better, and in the end to round-off. With the lengths `a`, `b` that the edges at `p_j` are to
//! have, `o` and `n` are polynomials in the control points:
//!
//! ```text
//! o = p + (r / sin θ) ((p₋ − p)/a + (p₊ − p)/b),   n = (p − p₋) × (p₊ − p) / (a b sin θ).
//! ```

mod closed;

pub use closed::fit_closed;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use glam::DVec3;

use super::projection::meet;
use super::samples::Samples;
use super::{ArcShape, Distance, Pose, Snake};
use crate::error::{Error, Result, Status};
use crate::linalg::gauss_newton::{self, Progress, Residuals, Stop, minimise};
use crate::linalg::least_squares::LeastSquares;
use crate::mesh::curve::{Curve, Spacing, resample};

/// Arcs of a snake at most: the deviation is looked for in all of them.
const MOST_ARCS: usize = 10_000;

/// What the weight of nearness is multiplied by, one minimisation after the other. With the paper's, which the first has, distances
/// are off so much that meeting them would move arcs by more than they are off the curve.
const ROUNDS: [f64; 3] = [1.0, 1e-2, 1e-4];

/// Into how many parts of a curve an arc's is divided.
const PER_ARC: usize = 32;

/// Arcs turn by more than this and by less than π less it, in radians, as those of snakes do.
const LEAST_ANGLE: f64 = 1e-6;

/// How a snake is fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Around a closed curve this and the curvature do not count. Whether all arcs have one radius, not only one length.
    pub is_congruent: bool,
    /// The curvature of all arcs, if it is known, above 0, in 1/model units.
    pub curvature: Option<f64>,
    /// The weight `ν` of nearness beside that of distances, above 0.
    pub nearness: f64,
    /// Iterations at most, of each of three minimisations.
    pub max_iterations: usize,
}

impl Default for Options {
    /// The paper's `ν` of 0.005.
    fn default() -> Self {
        Self { is_congruent: true, curvature: None, nearness: 0.005, max_iterations: 200 }
    }
}

/// A snake fitted.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedSnake {
    /// The snake.
    pub snake: Snake,
    /// The largest distance of a point of the curve from the nearest arc.
    pub deviation: f64,
    /// By how much a distance of control points is off at most.
    pub residual: f64,
    /// Iterations of the minimisations.
    pub iterations: usize,
    /// Why the last one stopped.
    pub stop: Stop,
}

/// The open snake of `arc_count` arcs of equal length along the curve through `points`, in their order.
///
/// Lengths and curvatures of the curve are those of the circles through three points in a row, so that points of a circle give the
/// circle. `progress` is called before each iteration and can end the minimisation.
///
/// # Errors
/// Fewer than 3 points, coordinates that are not finite, points that repeat the one before (`points`, `points[i]`); no arcs or more
/// than 10 000, or so few that one would have to turn by π or more (`arc_count`); options out of their ranges (`options.nearness`,
/// `options.curvature`). Status `Degenerate`: the curve is straight along an arc, which snakes have none of (`points`).
pub fn fit(
    points: &[DVec3],
    arc_count: usize,
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<FittedSnake> {
    check(arc_count, options)?;
    let samples = Samples::new(points, false)?;
    let shapes = shapes(&samples, arc_count, options)?;
    let snake = start(&samples, &shapes)?;
    let mut problem = Fit::new(&snake, &samples, options.nearness);
    let flat: Vec<f64> = snake.control().iter().flat_map(|point| point.to_array()).collect();
    let (mut x, mut iterations, mut stop) = (flat, 0, Stop::Iterations);
    for factor in ROUNDS {
        problem.nearness = (factor * options.nearness).sqrt();
        let found = minimise(&mut problem, &x, &search(options), progress)?;
        (x, stop) = (found.x, found.stop);
        iterations += found.history.len().saturating_sub(1);
        if stop == Stop::Cancelled {
            break;
        }
    }
    let mut control: Vec<DVec3> = x.chunks_exact(3).map(DVec3::from_slice).collect();
    let residual = meet(&mut control, false, &snake.distances(), &|_| false, &[]);
    let snake = snake.moved(control)?;
    let deviation = deviation(points, &snake);
    Ok(FittedSnake { snake, deviation, residual, iterations, stop })
}

/// The snake of `arc_count` arcs along a curve, as [`fit`] or [`fit_closed`] to points evenly spaced on it, 32 to an arc.
///
/// # Errors
/// As [`fit`] or [`fit_closed`]; a curve without a length (`curve`).
pub fn fit_curve(
    curve: &dyn Curve,
    arc_count: usize,
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<FittedSnake> {
    check(arc_count, options)?;
    let count = PER_ARC * arc_count + usize::from(!curve.is_closed());
    let parameters = resample(curve, count, Spacing::ArcLength).map_err(|error| error.at("curve"))?;
    let points: Vec<DVec3> = parameters.into_iter().map(|parameter| curve.point(parameter)).collect();
    if curve.is_closed() {
        fit_closed(&points, arc_count, options, progress)
    } else {
        fit(&points, arc_count, options, progress)
    }
}

/// The largest distance of the points from the nearest arc of a snake.
pub fn deviation(points: &[DVec3], snake: &Snake) -> f64 {
    let arcs = snake.arcs();
    let nearest = |point: &DVec3| arcs.iter().map(|arc| arc.distance(*point)).fold(f64::INFINITY, f64::min);
    points.iter().map(nearest).fold(0.0, f64::max)
}

fn check(arc_count: usize, options: &Options) -> Result<()> {
    if !(1..=MOST_ARCS).contains(&arc_count) {
        let reason = format!("expected 1 to {MOST_ARCS}, found {arc_count}");
        return Err(Error::new(Status::InvalidValue, reason).at("arc_count"));
    }
    for (name, value) in [("nearness", Some(options.nearness)), ("curvature", options.curvature)] {
        if let Some(value) = value.filter(|value| !(*value > 0.0 && value.is_finite())) {
            let reason = format!("expected a finite number above 0, found {value}");
            return Err(Error::new(Status::InvalidValue, reason).at(format!("options.{name}")));
        }
    }
    Ok(())
}

fn search(options: &Options) -> gauss_newton::Options {
    gauss_newton::Options { relative_decrease: 1e-9, max_iterations: options.max_iterations, ..Default::default() }
}

fn shapes(samples: &Samples, arc_count: usize, options: &Options) -> Result<Vec<ArcShape>> {
    let length = samples.length() / arc_count as f64;
    let whole = samples.mean_curvature(0.0, samples.length());
    let shape = |j: usize| {
        let here = || samples.mean_curvature(j as f64 * length, (j + 1) as f64 * length);
        let curvature = options.curvature.unwrap_or_else(|| if options.is_congruent { whole } else { here() });
        let angle = curvature * length;
        if angle >= PI - LEAST_ANGLE {
            let least = (curvature * samples.length() / PI).floor() + 1.0;
            let reason = format!("expected at least {least}, so that no arc is half a circle; found {arc_count}");
            return Err(Error::new(Status::InvalidValue, reason).at("arc_count"));
        }
        if angle <= LEAST_ANGLE {
            let reason =
                format!("expected a curve that is curved everywhere, found the curvature {curvature} at arc {j}");
            return Err(Error::new(Status::Degenerate, reason).at("points"));
        }
        Ok(ArcShape { radius: 1.0 / curvature, length })
    };
    (0..arc_count).map(shape).collect()
}

/// A snake near the curve that does not keep its distances yet.
fn start(samples: &Samples, shapes: &[ArcShape]) -> Result<Snake> {
    let length = shapes[0].length;
    let contact = |j: usize| samples.point(j as f64 * length);
    let tangent = |j: usize| samples.tangent(j as f64 * length);
    let vertex = |(j, shape): (usize, &ArcShape)| {
        let d = shape.tangent_length();
        0.5 * (contact(j) + d * tangent(j) + contact(j + 1) - d * tangent(j + 1))
    };
    let mut control = vec![contact(0)];
    control.extend(shapes.iter().enumerate().map(vertex));
    control.push(contact(shapes.len()));
    // Some snake with these arcs, to be given other control points.
    let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
    Snake::from_arcs(shapes, &vec![0.0; shapes.len() - 1], &pose)?.moved(control)
}

/// An arc's constants: centre and normal of a vertex and its neighbours.
struct ArcTerms {
    radius: f64,
    /// The centre is this combination of the vertex before, the vertex, the one after.
    center: [f64; 3],
    /// `1 / (a b sin θ)`.
    normal: f64,
    points: Vec<DVec3>,
}

struct Fit {
    distances: Vec<Distance>,
    arcs: Vec<ArcTerms>,
    ends: [DVec3; 2],
    /// `√ν`.
    nearness: f64,
}

impl Fit {
    fn new(snake: &Snake, samples: &Samples, nearness: f64) -> Self {
        let distances = snake.distances();
        let arc = |(j, shape): (usize, &ArcShape)| {
            // Edges come first among the distances.
            let (a, b, sine) = (distances[j].length, distances[j + 1].length, shape.angle_rad().sin());
            let [before, after] = [shape.radius / (sine * a), shape.radius / (sine * b)];
            let range = [j as f64 * shape.length, (j + 1) as f64 * shape.length];
            ArcTerms {
                radius: shape.radius,
                center: [before, 1.0 - before - after, after],
                normal: 1.0 / (a * b * sine),
                points: samples.between(range),
            }
        };
        let arcs = snake.shapes().iter().enumerate().map(arc).collect();
        Self { distances, arcs, ends: samples.ends(), nearness: nearness.sqrt() }
    }
}

impl Terms for Fit {
    fn point_count(&self) -> usize {
        self.arcs.len() + 2
    }

    fn visit(&self, x: &[f64], mut add: impl FnMut(f64, &[(usize, DVec3)])) {
        let at = |i: usize| DVec3::from_slice(&x[3 * i..3 * i + 3]);
        for Distance { points: [i, j], length } in &self.distances {
            let (i, j) = (*i as usize, *j as usize);
            let side = at(i) - at(j);
            let direction = side.normalize_or_zero();
            add(side.length() - length, &[(i, direction), (j, -direction)]);
        }
        for (j, arc) in self.arcs.iter().enumerate() {
            let weight = self.nearness / (arc.points.len() as f64).sqrt();
            let [before, vertex, after] = [at(j), at(j + 1), at(j + 2)];
            let center = arc.center[0] * before + arc.center[1] * vertex + arc.center[2] * after;
            let (e, f) = (vertex - before, after - vertex);
            for point in &arc.points {
                let from = *point - center;
                let out = -weight * from.normalize_or_zero();
                let terms = [0, 1, 2].map(|k| (j + k, arc.center[k] * out));
                add(weight * (from.length() - arc.radius), &terms);
                let scale = weight * arc.normal;
                let [by_e, by_f, by_from] = [f.cross(from), from.cross(e), e.cross(f)].map(|v| scale * v);
                let sides = [-by_e, by_e - by_f, by_f];
                let terms = [0, 1, 2].map(|k| (j + k, sides[k] - arc.center[k] * by_from));
                add(from.dot(by_from), &terms);
            }
        }
        let last = x.len() / 3 - 1;
        for (i, end) in [(0, self.ends[0]), (last, self.ends[1])] {
            for (axis, apart) in DVec3::AXES.into_iter().zip((at(i) - end).to_array()) {
                add(self.nearness * apart, &[(i, self.nearness * axis)]);
            }
        }
    }
}

/// A sum of squares in control points, of which each depends on three at most.
trait Terms {
    fn point_count(&self) -> usize;

    /// Calls `add` with each residual, and the control points that it depends on with its derivatives.
    fn visit(&self, x: &[f64], add: impl FnMut(f64, &[(usize, DVec3)]));
}

impl<T: Terms> Residuals for T {
    fn unknown_count(&self) -> usize {
        3 * self.point_count()
    }

    fn value(&mut self, x: &[f64]) -> f64 {
        let mut sum = 0.0;
        self.visit(x, |residual, _| sum += residual * residual);
        sum
    }

    fn linearise(&mut self, x: &[f64], equations: &mut LeastSquares) {
        let mut row = Vec::with_capacity(9);
        self.visit(x, |residual, terms| {
            row.clear();
            row.extend(terms.iter().flat_map(|&(i, v)| (3 * i as u32..).zip(v.to_array())));
            equations.add(&row, -residual);
        });
    }
}

#[cfg(test)]
mod tests;
