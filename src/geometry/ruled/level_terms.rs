//! The terms of which level functions are minima, and their derivatives.
//!
//! With `g` the gradient of `f` on a triangle, `a` the field there, `n` the normal, `A` areas of triangles and `A_v` of points, and
//! `|Ψ|` the area of the surface, the residuals are (Flöry, Nagai, Isvoranu, Pottmann, Wallner 2012, section 2.1)
//!
//! | term        | residuals                                          | at                                            |
//! |-------------|----------------------------------------------------|-----------------------------------------------|
//! | orthogonal  | `√(A/\|Ψ\|) (g − a)`                               | triangles; its part across `a` if unoriented  |
//! | direction   | `√(A/\|Ψ\|) g·(n × a)`                             | triangles                                     |
//! | equidistant | `√(A/\|Ψ\|) (‖g‖ − 1)`                             | triangles                                     |
//! | geodesic    | `√A_v div(g/‖g‖)`                                  | points inside                                 |
//! | conoidal    | the same in the metric of the spherical image      | points inside                                 |
//! | laplace     | `h √(A_v/\|Ψ\|) div g`, `h` the mean edge          | points inside                                 |
//!
//! The paper sums over points and leaves the weights of the summands open. Here they are areas, so that a finer mesh means the same,
//! and squares of lengths where needed, so that a larger surface does. `‖g‖` is `√(g·g + ε²)` with `ε` a millionth of its median, so
//! that critical points have derivatives. The derivative of `g/‖g‖` by an unknown that adds `G` to `g` is `(I − ĝĝᵀ) G/‖g‖`.
//!
//! Divergences at the boundary miss what flows over it, of the order of `1/h`: those points have none.

use glam::DVec3;

use crate::linalg::gauss_newton::Residuals;
use crate::linalg::least_squares::LeastSquares;
use crate::mesh::TriangleMesh;
use crate::mesh::operators::{gradients_of_corners, mixed_areas};

/// The weight of `‖g‖²` on triangles where the field is not known: `f` is harmonic there, and the rest takes no notice.
const HARMONIC: f64 = 1e-6;

/// `ε` over the median of the lengths of the gradients.
const SMOOTHING: f64 = 1e-6;

/// By how much corners of triangles are above the value at their point: `f` jumps across cuts, by the same amount all along each.
#[derive(Clone, Debug, Default)]
pub(super) struct Jumps {
    /// Three times a triangle and the number of the corner, the cut, and how often its jump is added; sorted.
    pub corners: Vec<(u32, u32, f64)>,
    /// For each cut its jump, if it is known; otherwise it is an unknown.
    pub values: Vec<Option<f64>>,
}

/// Gradients of functions and weak divergences in some metric of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Metric {
    /// Of each triangle, 0 if it is not used.
    pub areas: Vec<f64>,
    /// The gradient of the function that is 1 at one corner and 0 at the others.
    pub hats: Vec<[DVec3; 3]>,
    /// The mixed Voronoi areas of the points.
    pub point_areas: Vec<f64>,
}

/// `g` on each triangle, as it depends on the unknowns.
#[derive(Clone, Debug)]
struct Gradients {
    starts: Vec<u32>,
    entries: Vec<(u32, DVec3)>,
    /// What jumps that are known add.
    constants: Vec<DVec3>,
}

impl Gradients {
    fn new(mesh: &TriangleMesh, metric: &Metric, jumps: &Jumps) -> Self {
        let (mut starts, mut entries) = (vec![0], Vec::with_capacity(3 * metric.hats.len()));
        let mut constants = vec![DVec3::ZERO; metric.hats.len()];
        let mut next = jumps.corners.iter().peekable();
        let place = jump_places(mesh.points().len(), jumps);
        for (t, (triangle, hats)) in mesh.triangles().iter().zip(&metric.hats).enumerate() {
            entries.extend(triangle.iter().copied().zip(hats.iter().copied()));
            let first = entries.len();
            while let Some(&(corner, cut, count)) = next.next_if(|(corner, ..)| *corner as usize / 3 == t) {
                let added = count * hats[corner as usize % 3];
                match jumps.values[cut as usize] {
                    Some(value) => constants[t] += value * added,
                    None => match entries[first..].iter_mut().find(|(i, _)| *i == place[cut as usize]) {
                        Some((_, sum)) => *sum += added,
                        None => entries.push((place[cut as usize], added)),
                    },
                }
            }
            starts.push(entries.len() as u32);
        }
        Self { starts, entries, constants }
    }

    fn of(&self, t: usize) -> &[(u32, DVec3)] {
        &self.entries[self.starts[t] as usize..self.starts[t + 1] as usize]
    }

    fn at(&self, x: &[f64]) -> Vec<DVec3> {
        let sum = |t: usize| self.of(t).iter().map(|&(i, part)| x[i as usize] * part).sum::<DVec3>();
        (0..self.constants.len()).map(|t| self.constants[t] + sum(t)).collect()
    }
}

/// The unknown of each cut's jump; those that are known have none and get any.
pub(super) fn jump_places(point_count: usize, jumps: &Jumps) -> Vec<u32> {
    let mut next = point_count as u32;
    let mut place = |value: &Option<f64>| {
        let place = next;
        next += u32::from(value.is_none());
        place
    };
    jumps.values.iter().map(&mut place).collect()
}

/// The bending of level curves in one metric.
#[derive(Clone, Debug)]
struct Bending {
    weight: f64,
    gradients: Gradients,
    metric: Metric,
    points: Vec<u32>,
    squared_epsilon: f64,
}

/// The weights of the terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TermWeights {
    pub orthogonal: f64,
    pub direction: f64,
    pub equidistant: f64,
    pub geodesic: f64,
    pub conoidal: f64,
    pub laplace: f64,
}

/// A sum of terms.
#[derive(Clone, Debug)]
pub(super) struct Terms<'a> {
    mesh: &'a TriangleMesh,
    metric: Metric,
    gradients: Gradients,
    /// The field on each triangle, if it is known.
    directions: Vec<Option<DVec3>>,
    pub weights: TermWeights,
    /// Whether `−a` is as good as `a`.
    pub is_unoriented: bool,
    inside: Vec<u32>,
    /// One point of each part of the mesh, where `f` is 0.
    pins: Vec<u32>,
    squared_epsilon: f64,
    bendings: Vec<Bending>,
    unknown_count: usize,
    total_area: f64,
    mean_edge: f64,
}

impl Metric {
    /// The metric of the mesh itself.
    pub fn of_mesh(mesh: &TriangleMesh) -> Self {
        let count = mesh.triangles().len();
        Self {
            areas: (0..count).map(|t| mesh.area(t)).collect(),
            hats: (0..count).map(|t| gradients_of_corners(mesh, t)).collect(),
            point_areas: mixed_areas(mesh),
        }
    }
}

impl<'a> Terms<'a> {
    pub fn new(
        mesh: &'a TriangleMesh,
        directions: Vec<Option<DVec3>>,
        jumps: &Jumps,
        weights: TermWeights,
        is_unoriented: bool,
    ) -> Self {
        let metric = Metric::of_mesh(mesh);
        let gradients = Gradients::new(mesh, &metric, jumps);
        let (parts, part_count) = mesh.components();
        let mut pins = vec![u32::MAX; part_count];
        for (triangle, &part) in mesh.triangles().iter().zip(&parts) {
            let least = triangle.iter().fold(pins[part as usize], |least, &i| least.min(i));
            pins[part as usize] = least;
        }
        let point_count = mesh.points().len();
        Self {
            gradients,
            directions,
            weights,
            is_unoriented,
            inside: (0..point_count as u32).filter(|&i| !mesh.is_on_boundary(i as usize)).collect(),
            pins,
            squared_epsilon: 0.0,
            bendings: Vec::new(),
            unknown_count: point_count + jumps.values.iter().filter(|value| value.is_none()).count(),
            total_area: mesh.total_area(),
            mean_edge: mesh.mean_edge(),
            metric,
            mesh,
        }
    }

    /// Smooths the lengths of gradients by what they are for the function `x`, and adds the terms of bending with weights above 0:
    /// in the mesh's own metric, and in that of the spherical image if it is given.
    pub fn prepare_bending(&mut self, x: &[f64], image: Option<&Metric>, jumps: &Jumps) {
        self.squared_epsilon = squared_epsilon(&self.gradients.at(x), &self.metric);
        let metrics = [(self.weights.geodesic, Some(&self.metric)), (self.weights.conoidal, image)];
        let bendings = metrics.into_iter().filter(|(weight, _)| *weight > 0.0);
        let bendings = bendings.filter_map(|(weight, metric)| {
            let metric = metric?;
            let gradients = Gradients::new(self.mesh, metric, jumps);
            let is_used = |t: &u32| self.directions[*t as usize].is_some() && metric.areas[*t as usize] > 0.0;
            let points =
                self.inside.iter().copied().filter(|&i| self.mesh.fan(i as usize).iter().all(is_used)).collect();
            let squared_epsilon = squared_epsilon(&gradients.at(x), metric);
            Some(Bending { weight, gradients, metric: metric.clone(), points, squared_epsilon })
        });
        self.bendings = bendings.collect();
    }

    /// The lengths of the gradients on triangles where the field is known.
    pub fn lengths(&self, x: &[f64]) -> Vec<f64> {
        let lengths = self.gradients.at(x).into_iter().zip(&self.directions);
        lengths.filter(|(_, a)| a.is_some()).map(|(g, _)| g.length()).collect()
    }

    /// The corner of a triangle of the fan around a point that is the point.
    fn corner(&self, t: usize, i: u32) -> usize {
        self.mesh.triangles()[t].iter().position(|&j| j == i).unwrap_or(0)
    }

    /// `√weight A ∇φ` of each triangle around a point, over the root of the point's area: what makes the divergence of a field
    /// times `√(weight A_v)`, up to its sign.
    fn flows<'b>(&'b self, metric: &'b Metric, weight: f64, i: u32) -> impl Iterator<Item = (usize, DVec3)> + 'b {
        let factor = (weight / metric.point_areas[i as usize]).sqrt();
        self.mesh.fan(i as usize).iter().map(move |&t| {
            let t = t as usize;
            (t, factor * metric.areas[t] * metric.hats[t][self.corner(t, i)])
        })
    }

    fn laplace_weight(&self) -> f64 {
        self.weights.laplace * self.mean_edge * self.mean_edge / self.total_area
    }

    /// The residuals on a triangle, each as the direction that the gradient is measured along and what is taken off it.
    fn linear_on(&self, t: usize) -> impl Iterator<Item = (DVec3, f64)> {
        let share = self.mesh.area(t) / self.total_area;
        let normal = self.mesh.normal(t);
        let (frame, target, along, across) = match self.directions[t] {
            Some(a) => (a, 1.0, self.weights.orthogonal, self.weights.orthogonal + self.weights.direction),
            None => (normal.any_orthonormal_vector(), 0.0, HARMONIC, HARMONIC),
        };
        let along = if self.is_unoriented && target > 0.0 { 0.0 } else { along };
        let [along, across] = [along, across].map(|weight| (weight * share).sqrt());
        let residuals = [(along * frame, along * target), (across * normal.cross(frame), 0.0)];
        residuals.into_iter().zip([along, across]).filter(|(_, root)| *root > 0.0).map(|(residual, _)| residual)
    }

    /// Where the lengths of gradients count, and the root of the weight.
    fn equidistant_on(&self, t: usize) -> Option<f64> {
        let is_used = self.directions[t].is_some() && self.weights.equidistant > 0.0;
        is_used.then(|| (self.weights.equidistant * self.mesh.area(t) / self.total_area).sqrt())
    }

    fn length(&self, g: DVec3) -> f64 {
        (g.length_squared() + self.squared_epsilon).sqrt()
    }
}

fn squared_epsilon(gradients: &[DVec3], metric: &Metric) -> f64 {
    let used = gradients.iter().zip(&metric.areas).filter(|(_, area)| **area > 0.0);
    let mut squares: Vec<f64> = used.map(|(g, _)| g.length_squared()).collect();
    squares.sort_unstable_by(f64::total_cmp);
    let median = squares.get(squares.len() / 2).copied().unwrap_or(0.0);
    (SMOOTHING * SMOOTHING * median).max(f64::MIN_POSITIVE)
}

/// Adds to the coefficient of an unknown, which has few beside it.
fn add(row: &mut Vec<(u32, f64)>, i: u32, value: f64) {
    match row.iter_mut().find(|(j, _)| *j == i) {
        Some((_, sum)) => *sum += value,
        None => row.push((i, value)),
    }
}

impl Residuals for Terms<'_> {
    fn unknown_count(&self) -> usize {
        self.unknown_count
    }

    fn value(&mut self, x: &[f64]) -> f64 {
        let g = self.gradients.at(x);
        let mut sum = 0.0;
        for t in 0..g.len() {
            sum += self.linear_on(t).map(|(along, target)| (along.dot(g[t]) - target).powi(2)).sum::<f64>();
            sum += self.equidistant_on(t).map_or(0.0, |root| (root * (self.length(g[t]) - 1.0)).powi(2));
        }
        let weight = self.laplace_weight();
        if weight > 0.0 {
            let divergence = |i: u32| self.flows(&self.metric, weight, i).map(|(t, flow)| flow.dot(g[t])).sum::<f64>();
            sum += self.inside.iter().map(|&i| divergence(i).powi(2)).sum::<f64>();
        }
        for bending in &self.bendings {
            let g = bending.gradients.at(x);
            let unit = |t: usize| g[t] / (g[t].length_squared() + bending.squared_epsilon).sqrt();
            let flows = |i: u32| self.flows(&bending.metric, bending.weight, i);
            let divergence = |i: u32| flows(i).map(|(t, flow)| flow.dot(unit(t))).sum::<f64>();
            sum += bending.points.iter().map(|&i| divergence(i).powi(2)).sum::<f64>();
        }
        let pin = self.total_area.sqrt().recip();
        sum + self.pins.iter().map(|&i| (pin * x[i as usize]).powi(2)).sum::<f64>()
    }

    fn linearise(&mut self, x: &[f64], equations: &mut LeastSquares) {
        let g = self.gradients.at(x);
        let mut row = Vec::new();
        for t in 0..g.len() {
            let parts = self.gradients.of(t);
            for (along, target) in self.linear_on(t) {
                row.clear();
                row.extend(parts.iter().map(|&(i, part)| (i, along.dot(part))));
                equations.add(&row, target - along.dot(g[t]));
            }
            if let Some(root) = self.equidistant_on(t) {
                let length = self.length(g[t]);
                row.clear();
                row.extend(parts.iter().map(|&(i, part)| (i, root * g[t].dot(part) / length)));
                equations.add(&row, root * (1.0 - length));
            }
        }
        let weight = self.laplace_weight();
        for &i in self.inside.iter().filter(|_| weight > 0.0) {
            row.clear();
            let mut divergence = 0.0;
            for (t, flow) in self.flows(&self.metric, weight, i) {
                divergence += flow.dot(g[t]);
                self.gradients.of(t).iter().for_each(|&(j, part)| add(&mut row, j, flow.dot(part)));
            }
            equations.add(&row, -divergence);
        }
        for bending in &self.bendings {
            let g = bending.gradients.at(x);
            for &i in &bending.points {
                row.clear();
                let mut divergence = 0.0;
                for (t, flow) in self.flows(&bending.metric, bending.weight, i) {
                    let length = (g[t].length_squared() + bending.squared_epsilon).sqrt();
                    divergence += flow.dot(g[t]) / length;
                    let across = (flow - flow.dot(g[t]) / (length * length) * g[t]) / length;
                    bending.gradients.of(t).iter().for_each(|&(j, part)| add(&mut row, j, across.dot(part)));
                }
                equations.add(&row, -divergence);
            }
        }
        let pin = self.total_area.sqrt().recip();
        self.pins.iter().for_each(|&i| equations.add(&[(i, pin)], -pin * x[i as usize]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::patterns::height_field;

    #[test]
    fn derivatives_are_those_of_differences_and_the_value_is_that_of_the_equations() {
        let mesh = height_field(7, 6, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y + 0.1 * x * x * x).unwrap();
        let mesh = TriangleMesh::new(&mesh).unwrap();
        let direction = |t: usize| DVec3::new(1.0, 0.2, 0.3).reject_from_normalized(mesh.normal(t)).normalize();
        let mut directions: Vec<_> = (0..mesh.triangles().len()).map(|t| Some(direction(t))).collect();
        directions[17] = None;
        // A cut with a jump that is known beside one that is not, wherever.
        let corners = vec![(3, 0, 1.0), (4, 0, 1.0), (7, 1, 1.0), (9, 0, -1.0)];
        let jumps = Jumps { corners, values: vec![None, Some(0.3)] };
        let weights = TermWeights {
            orthogonal: 0.3,
            direction: 0.2,
            equidistant: 0.7,
            geodesic: 0.9,
            conoidal: 0.0,
            laplace: 0.4,
        };
        for is_unoriented in [false, true] {
            let mut terms = Terms::new(&mesh, directions.clone(), &jumps, weights, is_unoriented);
            let count = terms.unknown_count();
            assert_eq!(count, mesh.points().len() + 1);
            let wave = |i: usize| 0.3 * (1.7 * i as f64).sin();
            let x: Vec<f64> = (0..count).map(|i| if i < 42 { mesh.points()[i].x + wave(i) } else { 0.4 }).collect();
            terms.prepare_bending(&x, None, &jumps);
            let mut equations = LeastSquares::new(count);
            terms.linearise(&x, &mut equations);
            assert!((equations.squared_right() - terms.value(&x)).abs() < 1e-12 * terms.value(&x));
            let gradient = equations.transposed_right();
            for i in 0..count {
                let mut at = |h: f64| {
                    let mut x = x.clone();
                    x[i] += h;
                    terms.value(&x)
                };
                let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!((slope + 2.0 * gradient[i]).abs() < 1e-6 * (1.0 + slope.abs()), "{i}: {slope} {}", gradient[i]);
            }
        }
    }
}
