//! A closed snake fitted to a closed curve.
//!
//! Arcs given beforehand do not close in general: around a flat curve they never turn by more than once around. So a closed snake
//! keeps of each arc only the tangent length, `d_j = r_j tan(θ_j / 2)` for the length that each has and the curvature that the curve
//! has there on average; how curved it is then follows from its vertices, and is about that. All closed polygons whose edges are
//! `d_j + d_{j+1}` long are snakes, of which the one nearest to the curve is found. With an even number of arcs, whose vertices
//! leave one tangent length open, these are that choice. With `u`, `w` the unit vectors from a vertex `v` to its neighbours and `c =
//! u · w` an arc has
//!
//! ```text
//! o = v + λ (u + w),   λ = d / (1 + c),   r = d √((1 − c) / (1 + c)),   n = u × w / |u × w|,
//! ```
//!
//! so that `dλ = −λ / (1 + c) dc` and `dr = −λ² / r dc`. As `o − v` is in the plane of the arc, `n · (x − o)` is `n · (x − v)`.

use std::ops::ControlFlow;

use glam::DVec3;

use super::{FittedSnake, LEAST_ANGLE, Options, ROUNDS, Terms, check, deviation, search, shapes};
use crate::error::{Error, Result, Status};
use crate::geometry::snakes::projection::meet;
use crate::geometry::snakes::samples::Samples;
use crate::geometry::snakes::{ArcShape, Distance, Snake};
use crate::linalg::gauss_newton::{Progress, Stop, minimise};

/// Arcs that are longer or shorter than the mean by this factor have left the parts of the curve that they stand for.
const UNEVEN: f64 = 3.0;

/// The closed snake of `arc_count` arcs around the curve through `points`, in their order; the first may come again in the end.
///
/// Arcs are about of equal length, and about as curved as the curve is where they are; the first begins at the first point.
/// `options.is_congruent` and `options.curvature` do not count. `progress` is called before each iteration and can end the
/// minimisation. To evolve it needs at least 6 arcs.
///
/// # Errors
/// Fewer than 3 points, coordinates that are not finite, points that repeat the one before (`points`, `points[i]`); fewer than 3
/// arcs or more than 10 000, or so few that one would have to turn by π or more or that they do not follow the curve (`arc_count`);
/// `options.nearness` out of its range. Status `Degenerate`: the curve is straight along an arc, which snakes have none of (`points`).
pub fn fit_closed(
    points: &[DVec3],
    arc_count: usize,
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<FittedSnake> {
    let options = Options { is_congruent: false, curvature: None, ..*options };
    check(arc_count, &options)?;
    if arc_count < 3 {
        let reason = format!("expected at least 3 around a closed curve, found {arc_count}");
        return Err(Error::new(Status::InvalidValue, reason).at("arc_count"));
    }
    let samples = Samples::new(points, true)?;
    let mut problem = Around::new(&samples, &shapes(&samples, arc_count, &options)?);
    let (mut x, mut iterations, mut stop) = (problem.start(&samples), 0, Stop::Iterations);
    for factor in ROUNDS {
        problem.nearness = (factor * options.nearness).sqrt();
        let found = minimise(&mut problem, &x, &search(&options), progress)?;
        (x, stop) = (found.x, found.stop);
        iterations += found.history.len().saturating_sub(1);
        if stop == Stop::Cancelled {
            break;
        }
    }
    let mut control: Vec<DVec3> = x.chunks_exact(3).map(DVec3::from_slice).collect();
    meet(&mut control, true, &problem.edges, &|_| false, &[]);
    let arcs = problem.arcs(&control)?;
    let mean = samples.length() / arc_count as f64;
    if let Some(j) = arcs.iter().position(|arc| !(arc.length < UNEVEN * mean && arc.length > mean / UNEVEN)) {
        let reason = format!(
            "expected more, as {arc_count} arcs about {mean} long do not follow the curve: arc {j} became {} long",
            arcs[j].length
        );
        return Err(Error::new(Status::InvalidValue, reason).at("arc_count"));
    }
    let snake = Snake::with_arcs(control, arcs, true)?;
    let deviation = deviation(points, &snake);
    Ok(FittedSnake { deviation, residual: snake.residual(), snake, iterations, stop })
}

/// What belongs to an arc.
struct Part {
    /// Its tangent length.
    tangent: f64,
    points: Vec<DVec3>,
}

struct Around {
    edges: Vec<Distance>,
    parts: Vec<Part>,
    /// The beginning of the curve and its direction there: along it arcs could glide around a circle.
    first: [DVec3; 2],
    /// `√ν`.
    nearness: f64,
}

impl Around {
    fn new(samples: &Samples, shapes: &[ArcShape]) -> Self {
        let count = shapes.len();
        let part = |(j, shape): (usize, &ArcShape)| {
            let range = [j as f64 * shape.length, (j + 1) as f64 * shape.length];
            Part { tangent: shape.tangent_length(), points: samples.between(range) }
        };
        let edge = |i: usize| Distance {
            points: [i as u32, ((i + 1) % count) as u32],
            length: shapes[i].tangent_length() + shapes[(i + 1) % count].tangent_length(),
        };
        Self {
            edges: (0..count).map(edge).collect(),
            parts: shapes.iter().enumerate().map(part).collect(),
            first: [samples.point(0.0), samples.tangent(0.0)],
            nearness: 1.0,
        }
    }

    /// Vertices halfway between where the tangents at their two contacts lead.
    fn start(&self, samples: &Samples) -> Vec<f64> {
        let length = samples.length() / self.parts.len() as f64;
        let vertex = |(j, part): (usize, &Part)| {
            let [from, to] = [j as f64 * length, (j + 1) as f64 * length];
            let [before, after] = [samples.tangent(from), samples.tangent(to)].map(|t| part.tangent * t);
            (0.5 * (samples.point(from) + before + samples.point(to) - after)).to_array()
        };
        self.parts.iter().enumerate().flat_map(vertex).collect()
    }

    /// The arcs of a polygon.
    fn arcs(&self, control: &[DVec3]) -> Result<Vec<ArcShape>> {
        let count = control.len();
        let arc = |(j, part): (usize, &Part)| {
            let (incoming, outgoing) =
                (control[j] - control[(j + count - 1) % count], control[(j + 1) % count] - control[j]);
            let angle = incoming.cross(outgoing).length().atan2(incoming.dot(outgoing));
            if !(angle > LEAST_ANGLE) {
                let reason = format!("expected a curve that is curved everywhere, found it straight at arc {j}");
                return Err(Error::new(Status::Degenerate, reason).at("points"));
            }
            if !(angle < std::f64::consts::PI - LEAST_ANGLE) {
                let reason = format!("expected more, so that no arc is half a circle as arc {j}; found {count}");
                return Err(Error::new(Status::InvalidValue, reason).at("arc_count"));
            }
            let radius = part.tangent / (0.5 * angle).tan();
            Ok(ArcShape { radius, length: radius * angle })
        };
        self.parts.iter().enumerate().map(arc).collect()
    }
}

impl Terms for Around {
    fn point_count(&self) -> usize {
        self.parts.len()
    }

    fn visit(&self, x: &[f64], mut add: impl FnMut(f64, &[(usize, DVec3)])) {
        let at = |i: usize| DVec3::from_slice(&x[3 * i..3 * i + 3]);
        for Distance { points: [i, j], length } in &self.edges {
            let (i, j) = (*i as usize, *j as usize);
            let side = at(i) - at(j);
            let direction = side.normalize_or_zero();
            add(side.length() - length, &[(i, direction), (j, -direction)]);
        }
        let count = self.parts.len();
        for (j, part) in self.parts.iter().enumerate() {
            let [before, after] = [(j + count - 1) % count, (j + 1) % count];
            let vertex = at(j);
            let [to_before, to_after] = [at(before) - vertex, at(after) - vertex];
            let (u, w) = (to_before.normalize_or_zero(), to_after.normalize_or_zero());
            // From how a residual changes with u, w and the vertex alone to how it does with the control points.
            let terms = |by_u: DVec3, by_w: DVec3, by_vertex: DVec3| {
                let turn = |by: DVec3, unit: DVec3, side: DVec3| (by - by.dot(unit) * unit) / side.length();
                let [a, b] = [turn(by_u, u, to_before), turn(by_w, w, to_after)];
                [(before, a), (j, by_vertex - a - b), (after, b)]
            };
            let (cosine, normal) = (u.dot(w), u.cross(w));
            let lambda = part.tangent / (1.0 + cosine);
            let radius = part.tangent * ((1.0 - cosine) / (1.0 + cosine)).sqrt();
            let center = vertex + lambda * (u + w);
            let (sine, unit) = (normal.length(), normal.normalize_or_zero());
            let weight = self.nearness / (part.points.len() as f64).sqrt();
            for point in &part.points {
                let from = center - *point;
                let out = from.normalize_or_zero();
                let by_cosine = lambda * lambda / radius - lambda / (1.0 + cosine) * out.dot(u + w);
                let found = terms(lambda * out + by_cosine * w, lambda * out + by_cosine * u, out);
                add(weight * (from.length() - radius), &found.map(|(i, v)| (i, weight * v)));
                let height = unit.dot(*point - vertex);
                let within = (*point - vertex - height * unit) / sine;
                let found = terms(w.cross(within), within.cross(u), -unit);
                add(weight * height, &found.map(|(i, v)| (i, weight * v)));
            }
            if j == 0 {
                let [start, along] = self.first;
                let found = terms(part.tangent * along, DVec3::ZERO, along);
                let contact = vertex + part.tangent * u;
                add(self.nearness * along.dot(contact - start), &found.map(|(i, v)| (i, self.nearness * v)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::random::Random;

    fn on(_: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn around(count: i32, at: impl Fn(f64) -> DVec3) -> Vec<DVec3> {
        (0..count).map(|i| at(TAU * f64::from(i) / f64::from(count))).collect()
    }

    /// An ellipse bent out of its plane.
    fn saddle(t: f64) -> DVec3 {
        DVec3::new(2.0 * t.cos(), t.sin(), 0.3 * (2.0 * t).cos())
    }

    #[test]
    fn a_circle_is_found_exactly() {
        for count in [3, 4, 6, 7, 20] {
            for scale in [1e-3, 1.0, 1e3] {
                let points = around(60, |t| scale * DVec3::new(1.0 + 2.0 * t.cos(), 1.6 * t.sin(), 1.2 * t.sin()));
                let found = fit_closed(&points, count, &Options::default(), &mut on).unwrap();
                assert!(found.deviation < 1e-10 * scale, "{count} {}", found.deviation);
                for arc in found.snake.shapes() {
                    assert!((arc.radius / scale - 2.0).abs() < 1e-9);
                    assert!((arc.length / scale - 2.0 * TAU / count as f64).abs() < 1e-9);
                }
                assert!(found.snake.contacts()[0].distance(points[0]) < 1e-9 * scale);
            }
        }
    }

    #[test]
    fn closed_curves_are_fitted_ever_better() {
        for (at, is_flat) in [(saddle as fn(f64) -> DVec3, false), (|t| DVec3::new(2.0 * t.cos(), t.sin(), 0.0), true)]
        {
            let points = around(400, at);
            let mut last = f64::INFINITY;
            for (count, most) in [(7, 0.2), (8, 0.2), (15, 0.03), (30, 0.006), (60, 0.0012)] {
                let found = fit_closed(&points, count, &Options::default(), &mut on).unwrap();
                let snake = &found.snake;
                assert!(snake.residual() < 1e-13 * snake.size() && found.residual == snake.residual());
                assert!(found.deviation < most && found.deviation < 1.2 * last, "{count} {}", found.deviation);
                last = found.deviation;
                // Control points alone give the same arcs.
                let first = (count % 2 == 0).then(|| snake.shapes()[0].tangent_length());
                let again = Snake::new(snake.control().to_vec(), true, first).unwrap();
                for (a, b) in snake.shapes().iter().zip(again.shapes()) {
                    assert!((a.radius / b.radius - 1.0).abs() < 1e-9);
                }
                let most_off = snake.sample(20).iter().map(|p| p.z.abs()).fold(0.0, f64::max);
                assert!(!is_flat || most_off < 1e-9, "{most_off}");
                if count == 60 {
                    // As curved as the curve: the mean over an arc.
                    let samples = Samples::new(&points, true).unwrap();
                    let length = samples.length() / 60.0;
                    for (j, arc) in snake.shapes().iter().enumerate() {
                        let curvature = samples.mean_curvature(j as f64 * length, (j + 1) as f64 * length);
                        assert!((arc.radius * curvature - 1.0).abs() < 0.05, "{j} {}", arc.radius * curvature);
                        assert!((arc.length / length - 1.0).abs() < 0.01, "{j} {}", arc.length / length);
                    }
                }
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_residuals() {
        let samples = Samples::new(&around(90, saddle), true).unwrap();
        let options = Options { is_congruent: false, ..Options::default() };
        let mut problem = Around::new(&samples, &shapes(&samples, 6, &options).unwrap());
        problem.nearness = 0.3;
        let mut random = Random(3);
        let x: Vec<f64> = problem.start(&samples).iter().map(|x| x + 0.1 * random.between(-1.0, 1.0)).collect();
        let direction: Vec<f64> = x.iter().map(|_| random.between(-1.0, 1.0)).collect();
        let values = |t: f64| {
            let moved: Vec<f64> = x.iter().zip(&direction).map(|(x, d)| x + t * d).collect();
            let mut values = Vec::new();
            problem.visit(&moved, |residual, _| values.push(residual));
            values
        };
        let mut slopes = Vec::new();
        problem.visit(&x, |_, terms| {
            let along = |&(i, v): &(usize, DVec3)| v.dot(DVec3::from_slice(&direction[3 * i..3 * i + 3]));
            slopes.push(terms.iter().map(along).sum::<f64>());
        });
        let (after, before) = (values(1e-6), values(-1e-6));
        assert!(slopes.len() > 180);
        for (slope, (after, before)) in slopes.iter().zip(after.iter().zip(&before)) {
            assert!((slope - (after - before) / 2e-6).abs() < 1e-7 * slope.abs().max(0.1), "{slope}");
        }
    }

    #[test]
    fn what_cannot_be_fitted_is_refused() {
        let circle = around(40, |t| DVec3::new(t.cos(), t.sin(), 0.0));
        let refused = |points: &[DVec3], count, options: &Options| {
            let error = fit_closed(points, count, options, &mut on).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        let default = Options::default();
        assert_eq!(refused(&circle, 2, &default), (Status::InvalidValue, "arc_count".into()));
        assert_eq!(refused(&circle[..2], 6, &default), (Status::InvalidArgumentLength, "points".into()));
        assert_eq!(refused(&circle, 6, &Options { nearness: -1.0, ..default }).1, "options.nearness");
        // A stadium has straight sides, and ends that three arcs cannot turn around.
        let side = |from: f64, to: f64, y: f64| {
            (0..40).map(move |i| DVec3::new(from + (to - from) * f64::from(i) / 40.0, y, 0.0))
        };
        let bend = |x: f64, from: f64| {
            (0..40)
                .map(move |i| (from + f64::from(i) / 40.0) * TAU / 2.0)
                .map(move |t| DVec3::new(x + t.cos(), t.sin(), 0.0))
        };
        let stadium: Vec<DVec3> =
            side(-9.0, 9.0, -1.0).chain(bend(9.0, -0.5)).chain(side(9.0, -9.0, 1.0)).chain(bend(-9.0, 0.5)).collect();
        assert_eq!(refused(&stadium, 20, &default), (Status::Degenerate, "points".into()));
        assert_eq!(refused(&stadium, 3, &default), (Status::InvalidValue, "arc_count".into()));
    }
}
