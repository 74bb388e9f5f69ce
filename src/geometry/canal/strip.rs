//! Circular strips: one quad after the other, from points of a guide curve and one number for each quad.
//!
//! A strip has the guide's points `P_0 … P_n` on one side and `Q_0 … Q_n` on the other; all quads `P_k Q_k Q_{k+1} P_{k+1}`
//! have their corners on a circle. With `Q_0` given, the circle of each quad goes through `P_k`, `Q_k` and `P_{k+1}`, and one
//! number says where on it `Q_{k+1}` is. The paper offers two (section 3.2, Fig. 6): the length of the crossing edge
//! `P_{k+1}Q_{k+1}` ([`of_lengths`], with one length for each, or [`lengths_between`] one for the first and one for the last)
//! and the radius of the next circle ([`of_radii`]). A third is the length of the border's edge `Q_kQ_{k+1}`
//! ([`of_border_edges`]); with it a border of one given length is had by [`edges_of_border`].
//!
//! Each number is a quadratic equation on the circle, solved in `quad.rs`. Where one root has the corners in cyclic order, it is
//! taken. Where both have, which for lengths happens when `P_kQ_k` leans backwards, that one is whose border edge is nearer to
//! the guide's edge in length, by ratio: the other makes the strip jump. Where none has, the quad is crossed: the strip says so,
//! or refuses it where it is asked to be strict.
//!
//! **Lengths are over-determined.** With `α` the angle from the guide's tangent to the chord `PQ`, a smooth strip has
//! `L' = −(1 + λ) cos α`, where `λ > 0` is the border's speed over the guide's, and the angle follows from the strip's past: with
//! the chord at a right angle to the guide a strip of short edges cannot grow. Going on from a small error of the angle, the error
//! shrinks where lengths shrink and grows where lengths grow, like `exp(4 s / L L')` on a straight guide. Hence
//! [`Options::projects_lengths`] and [`Options::fits_start`].

use glam::DVec3;

use super::quad::{Choice, Quad, ROUND_OFF};
use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::{Circle, PARALLEL};
use crate::mesh::Grid;
use crate::mesh::grid::check_finite;

/// How far a first length may be from the distance of the first points, as a multiple of it.
const FIRST_LENGTH: f64 = 1e-9;

/// What to do where lengths cannot be met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Refuse crossed quads (status `NoSolution`).
    pub is_strict: bool,
    /// Replace a length that is not attainable by the nearest that is.
    pub projects_lengths: bool,
    /// Turn `start` about the first point, in its plane with the first edge, to where the lengths can go on (see [`of_lengths`]).
    pub fits_start: bool,
}

/// A circular strip of `n` quads.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// The guide's points, `n + 1`.
    pub guide: Vec<DVec3>,
    /// The points on the other side, `n + 1`.
    pub border: Vec<DVec3>,
    /// The lengths of the crossing edges, in model units, `n + 1`.
    pub lengths: Vec<f64>,
    /// For each quad `k` the largest length of crossing edge `k + 1` at which its corners are in cyclic order; every length
    /// from above 0 to below is attainable there.
    pub attainable: Vec<f64>,
    /// The quads whose corners are not in cyclic order: they cross themselves.
    pub flipped: Vec<usize>,
    /// The crossing edges whose length was replaced by the nearest attainable one.
    pub projected: Vec<usize>,
    /// The largest difference of a crossing edge's length from the one asked for; 0 where none was.
    pub deviation: f64,
}

impl Strip {
    /// The strip as a grid of `n + 1` rows and two columns, the guide first.
    ///
    /// # Errors
    /// None for a strip that this module made.
    pub fn grid(&self) -> Result<Grid> {
        let points = self.guide.iter().zip(&self.border).flat_map(|(&p, &q)| [p, q]).collect();
        Grid::new(points, self.guide.len(), 2, [false; 2])
    }

    /// The circle of each quad, `n`, its normal so that `P_{k+1}`, `Q_k`, `P_k` are counterclockwise.
    ///
    /// # Errors
    /// Status `Degenerate`: three corners are on a line, in a strip that this module did not make.
    pub fn circles(&self) -> Result<Vec<Circle>> {
        let quads = self.guide.windows(2).zip(&self.border).enumerate();
        let circle = |(k, (p, &q)): (usize, (&[DVec3], _))| Circle::through(p[1], q, p[0]).ok_or_else(|| on_a_line(k));
        quads.map(circle).collect()
    }
}

/// The strip whose crossing edges have given lengths, in model units; `lengths[0]` is that of `P_0Q_0`.
///
/// Where `fits_start` is set, `Q_0` is in the half plane from the line `P_0P_1` through `start`, as far from `P_0` as
/// `lengths[0]` says, in the direction that follows from `L'(0)`: the border's speed is `λ = 1 − L κ·u / sin²α`, with `κ` the
/// curvature vector of the circle through the first three points and `u` the direction of the chord, so that the angle `α` to
/// that circle at first does not change; and the first quad has the sides `h`, `L_1`, `λh`, `L_0`, whence its angle. If the
/// lengths cannot all be met from there, the angle is sought that misses them by least. Otherwise `Q_0` is `start`.
///
/// # Errors
/// Fewer than 2 points, another number of lengths than of points, a number that is not finite, a length that is not above 0, or
/// `lengths[0]` other than the distance of `start` from `points[0]` unless `fits_start` is set.
/// Status `Degenerate`: points coincide, or `P_k`, `Q_k` and `P_{k+1}` are on a line; the place is `start` or `points[k + 1]`.
/// `NoIntersection`: a length is larger than the diameter of its circle; `NoSolution`, where `is_strict`: no root is in cyclic
/// order. The place is `lengths[k]`, and the reason has the diameter, the attainable interval and the nearest attainable length.
/// With `projects_lengths` neither occurs, and the result has these numbers for every step.
pub fn of_lengths(points: &[DVec3], start: DVec3, lengths: &[f64], options: &Options) -> Result<Strip> {
    check_guide(points, start)?;
    check_positive("lengths", lengths, points.len())?;
    if options.fits_start {
        return of_lengths_from(points, fitted_start(points, start, lengths)?, lengths, options);
    }
    let distance = start.distance(points[0]);
    if !((lengths[0] - distance).abs() <= FIRST_LENGTH * distance) {
        let reason = format!("expected the distance {distance} of start from points[0], found {}", lengths[0]);
        return Err(Error::new(Status::InvalidValue, reason).at("lengths[0]"));
    }
    of_lengths_from(points, start, lengths, options)
}

/// The lengths of `points.len()` crossing edges that go from `first` to `last` evenly along the polyline, for a strip of which
/// only the lengths of its two ends are given.
///
/// # Errors
/// Fewer than 2 points, points that all coincide, or a number that is not finite.
pub fn lengths_between(points: &[DVec3], first: f64, last: f64) -> Result<Vec<f64>> {
    let along = fractions(points)?;
    let (first, last) = (finite("first", first)?, finite("last", last)?);
    Ok(along.iter().map(|fraction| (1.0 - fraction) * first + fraction * last).collect())
}

/// The strip whose quads have circles of given radii, in model units: one for each quad.
///
/// `Q_0` is where the ray from `P_0` through `start` meets the circle of radius `radii[0]` through `P_0` and `P_1` on the side
/// of `start`. The last quad, after which no circle follows, has crossing edges of equal length where that is attainable.
///
/// # Errors
/// As [`of_lengths`]: a radius is attainable in an interval, which the reason has; the place is `radii[k]`.
pub fn of_radii(points: &[DVec3], start: DVec3, radii: &[f64], is_strict: bool) -> Result<Strip> {
    check_guide(points, start)?;
    check_positive("radii", radii, points.len() - 1)?;
    let border = start_of_radius(points, start, radii[0])?;
    propagate(points, border, &mut |quad, k| {
        if k + 2 == points.len() {
            let length = quad.previous_length;
            let choice = Choice::of(quad, quad.at_length(length)).filter(|choice| !choice.is_flipped);
            return Ok(choice.unwrap_or(Choice { s: quad.at_largest_length(), is_flipped: false }));
        }
        let (image, distance) = (quad.image(points[k + 2]), quad.ratio / (2.0 * radii[k + 1]));
        let (roots, range) = quad.at_line_distance(image, distance);
        let choice = Choice::of(quad, roots);
        let refusal = |status| {
            let (low, high) = (quad.ratio / (2.0 * range.end()), quad.ratio / (2.0 * range.start()));
            let radius = radii[k + 1];
            let reason = format!(
                "no point of the quad before gives the radius {radius}: {low} to {high} are attainable, the nearest \
                 is {}",
                radius.max(low).min(high)
            );
            Err(Error::new(status, reason).at(format!("radii[{}]", k + 1)))
        };
        match choice {
            None => refusal(Status::NoIntersection),
            Some(choice) if choice.is_flipped && is_strict => refusal(Status::NoSolution),
            Some(choice) => Ok(choice),
        }
    })
}

/// The strip whose edges `Q_kQ_{k+1}` have given lengths, in model units: one for each quad.
///
/// Unlike lengths of crossing edges these are attainable from any angle, and errors do not grow.
///
/// # Errors
/// As [`of_lengths`]: a length is attainable up to the distance of `Q_k` from `P_{k+1}`, or up to the diameter of the quad's
/// circle where the arc between the two is more than half of it; status `NoIntersection`, the place is `edges[k]`.
pub fn of_border_edges(points: &[DVec3], start: DVec3, edges: &[f64]) -> Result<Strip> {
    check_guide(points, start)?;
    check_positive("edges", edges, points.len() - 1)?;
    propagate(points, start, &mut |quad, k| match quad.at_border_edge(edges[k]) {
        Some(s) => Ok(Choice { s, is_flipped: false }),
        None => {
            let (length, largest) = (edges[k], quad.largest_border_edge());
            let reason = format!(
                "a border edge of {length} is not attainable: lengths above 0 and below {largest} are, which is the \
                 nearest"
            );
            Err(Error::new(Status::NoIntersection, reason).at(format!("edges[{k}]")))
        }
    })
}

/// The lengths of the edges of a border that is `length` long in all, each in the proportion of the guide's edge.
///
/// # Errors
/// Fewer than 2 points, points that all coincide, or a number that is not finite.
pub fn edges_of_border(points: &[DVec3], length: f64) -> Result<Vec<f64>> {
    let along = fractions(points)?;
    finite("length", length)?;
    Ok(along.windows(2).map(|pair| (pair[1] - pair[0]) * length).collect())
}

fn of_lengths_from(points: &[DVec3], start: DVec3, lengths: &[f64], options: &Options) -> Result<Strip> {
    let mut projected = Vec::new();
    let mut strip = propagate(points, start, &mut |quad, k| {
        let length = lengths[k + 1];
        let largest = quad.largest_length();
        let choice = Choice::of(quad, quad.at_length(length));
        let refusal = |status| {
            let (diameter, nearest) = (quad.diameter(), length.min(largest));
            let reason = format!(
                "{length} is not attainable: lengths above 0 and below {largest} are, the nearest is {nearest}; the \
                 diameter 2R of the quad's circle is {diameter}"
            );
            Err(Error::new(status, reason).at(format!("lengths[{}]", k + 1)))
        };
        match choice {
            Some(choice) if !choice.is_flipped => Ok(choice),
            _ if options.projects_lengths => {
                projected.push(k + 1);
                Ok(Choice { s: quad.at_largest_length(), is_flipped: false })
            }
            None => refusal(Status::NoIntersection),
            Some(_) if options.is_strict => refusal(Status::NoSolution),
            Some(choice) => Ok(choice),
        }
    })?;
    let differences = strip.lengths.iter().zip(lengths).map(|(achieved, asked)| (achieved - asked).abs());
    strip.deviation = differences.fold(0.0, f64::max);
    strip.projected = projected;
    Ok(strip)
}

/// The strip of given points on both sides, which are those of a circular strip.
pub(super) fn of_borders(guide: Vec<DVec3>, border: Vec<DVec3>) -> Result<Strip> {
    let lengths = guide.iter().zip(&border).map(|(p, q)| p.distance(*q)).collect();
    let quad = |k: usize| Quad::new(guide[k], border[k], guide[k + 1]).ok_or_else(|| on_a_line(k));
    let largest = |k: usize| quad(k).map(|quad| quad.largest_length());
    let attainable = (0..guide.len() - 1).map(largest).collect::<Result<_>>()?;
    Ok(Strip { guide, border, lengths, attainable, flipped: Vec::new(), projected: Vec::new(), deviation: 0.0 })
}

/// Quad after quad; `choose` says where on the line of quad `k` the next point is.
fn propagate(points: &[DVec3], start: DVec3, choose: &mut dyn FnMut(&Quad, usize) -> Result<Choice>) -> Result<Strip> {
    let mut strip = Strip {
        guide: points.to_vec(),
        border: vec![start],
        lengths: vec![start.distance(points[0])],
        attainable: Vec::new(),
        flipped: Vec::new(),
        projected: Vec::new(),
        deviation: 0.0,
    };
    for k in 0..points.len() - 1 {
        let quad = Quad::new(points[k], strip.border[k], points[k + 1]).ok_or_else(|| on_a_line(k))?;
        strip.attainable.push(quad.largest_length());
        let choice = choose(&quad, k)?;
        let point = quad.point(choice.s);
        if choice.is_flipped {
            strip.flipped.push(k);
        }
        strip.lengths.push(point.distance(points[k + 1]));
        strip.border.push(point);
    }
    check_finite("border", &strip.border).map_err(|error| error.with_place("points"))?;
    Ok(strip)
}

/// The start turned to where lengths can go on.
fn fitted_start(points: &[DVec3], start: DVec3, lengths: &[f64]) -> Result<DVec3> {
    let edge = points[1] - points[0];
    let h = edge.length();
    let x = edge / h;
    let aside = (start - points[0]).reject_from_normalized(x);
    let y = aside.try_normalize().filter(|_| aside.length() > PARALLEL * start.distance(points[0]));
    let y = y.ok_or_else(|| on_a_line(0))?;
    let at = |angle: f64| points[0] + lengths[0] * (angle.cos() * x + angle.sin() * y);
    let curvature = points.get(2).and_then(|&third| Circle::through(points[0], points[1], third));
    let curvature = curvature.map_or(DVec3::ZERO, |circle| (circle.center - points[0]) / circle.radius.powi(2));
    let tangent = x - curvature.dot(x) / curvature.length_squared().max(f64::MIN_POSITIVE) * curvature;
    // The angle of the quad with the sides h, L₁, λh, L₀: both triangles on the diagonal Q₀P₁, whose other angles are
    // supplementary, give cos α = (h² + L₀² − L₁² − λ²h²) / 2h(L₀ + λL₁).
    let cosine = |lambda: f64| {
        let sides = h * h * (1.0 - lambda * lambda) + (lengths[0] - lengths[1]) * (lengths[0] + lengths[1]);
        (sides / (2.0 * h * (lengths[0] + lambda * lengths[1]))).clamp(-0.9, 0.9)
    };
    let mut angle = cosine(1.0).acos();
    for _ in 0..20 {
        let direction = angle.cos() * x + angle.sin() * y;
        let cosine_squared = direction.dot(tangent).powi(2) / tangent.length_squared();
        let lambda = 1.0 - lengths[0] * curvature.dot(direction) / (1.0 - cosine_squared);
        angle = cosine(lambda.clamp(0.1, 10.0)).acos();
    }
    // How far the lengths are missed from an angle.
    let options = Options { projects_lengths: true, ..Options::default() };
    let miss =
        |angle: f64| of_lengths_from(points, at(angle), lengths, &options).map_or(f64::INFINITY, |s| s.deviation);
    let (mut best, mut reach) = ((miss(angle), angle), 0.5);
    // Angles from which all lengths can be met form a short interval where lengths grow: look closer and closer.
    const SAMPLES: i32 = 32;
    while best.0 > ROUND_OFF * lengths.iter().copied().fold(0.0, f64::max) && reach > 1e-15 {
        let middle = best.1;
        for i in -SAMPLES..=SAMPLES {
            let angle = middle + reach * f64::from(i) / f64::from(SAMPLES);
            let found = if angle > 0.1 && angle < std::f64::consts::PI - 0.1 { miss(angle) } else { f64::INFINITY };
            if found < best.0 {
                best = (found, angle);
            }
        }
        reach *= 2.0 / f64::from(SAMPLES);
    }
    Ok(at(best.1))
}

/// On the ray from the first point through `start`, the far point of the circle of this radius through the first two points
/// whose center is on the side of `start`: with the ray at the angle `α` to the edge and the direction to the center at `γ`,
/// `cos γ = h/2R`, the distance is `2R cos(α − γ)`.
fn start_of_radius(points: &[DVec3], start: DVec3, radius: f64) -> Result<DVec3> {
    let edge = points[1] - points[0];
    let (offset, half) = (start - points[0], 0.5 * edge.length() / radius);
    if half > 1.0 + ROUND_OFF {
        let reason = format!("expected at least half of the guide's edge, {}, found {radius}", 0.5 * edge.length());
        return Err(Error::new(Status::NoIntersection, reason).at("radii[0]"));
    }
    let angle = offset.cross(edge).length().atan2(offset.dot(edge));
    let distance = 2.0 * radius * (angle - half.min(1.0).acos()).cos();
    if distance > PARALLEL * radius {
        return Ok(points[0] + distance * offset.normalize());
    }
    let reason = format!("the ray from points[0] through start meets no circle of radius {radius} on that side");
    Err(Error::new(Status::NoIntersection, reason).at("radii[0]"))
}

pub(super) fn on_a_line(k: usize) -> Error {
    let reason = format!("points {k} of guide and border and point {} of the guide are on a line, or coincide", k + 1);
    Error::new(Status::Degenerate, reason).at(if k == 0 { "start".to_string() } else { format!("points[{}]", k + 1) })
}

/// Refuses fewer than two points, what is not finite, and points that follow upon themselves.
pub(super) fn check_guide(points: &[DVec3], start: DVec3) -> Result<()> {
    if points.len() < 2 {
        let reason = format!("expected at least 2 points, found {}", points.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
    }
    check_finite("points", points)?;
    check_finite("start", &[start]).map_err(|error| error.with_place("start"))?;
    match points.windows(2).position(|pair| pair[0] == pair[1]) {
        None => Ok(()),
        Some(k) => {
            let reason = format!("it is the same point as points[{k}]");
            Err(Error::new(Status::Degenerate, reason).at(format!("points[{}]", k + 1)))
        }
    }
}

pub(super) fn check_positive(name: &str, values: &[f64], count: usize) -> Result<()> {
    super::combescure::check_count(name, values, count)?;
    match values.iter().position(|&value| !(value > 0.0)) {
        None => Ok(()),
        Some(k) => {
            let reason = format!("expected a number above 0, found {}", values[k]);
            Err(Error::new(Status::InvalidValue, reason).at(format!("{name}[{k}]")))
        }
    }
}

/// For each point of a polyline, the part of its length up to there, 0 to 1.
fn fractions(points: &[DVec3]) -> Result<Vec<f64>> {
    if points.len() < 2 {
        let reason = format!("expected at least 2 points, found {}", points.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
    }
    check_finite("points", points)?;
    let mut lengths = vec![0.0];
    lengths.extend(points.windows(2).map(|pair| pair[0].distance(pair[1])).scan(0.0, |sum, length| {
        *sum += length;
        Some(*sum)
    }));
    let total = lengths[lengths.len() - 1];
    if !(total > 0.0) {
        return Err(Error::new(Status::Degenerate, "all points coincide").at("points"));
    }
    Ok(lengths.into_iter().map(|length| length / total).collect())
}

#[cfg(test)]
pub(super) mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    /// The largest distance of a quad's fourth corner from the circle through three, and how many quads are not in cyclic
    /// order, by angles about the circle's center.
    pub(in super::super) fn misfit(strip: &Strip) -> (f64, usize) {
        let (mut worst, mut crossed) = (0.0_f64, 0);
        for k in 0..strip.guide.len() - 1 {
            let corners = [strip.guide[k], strip.border[k], strip.border[k + 1], strip.guide[k + 1]];
            let circle = Circle::through(corners[0], corners[1], corners[3]).unwrap();
            worst = worst.max(circle.distance(corners[2]) / corners[0].distance(corners[3]));
            let angles = corners.map(|corner| circle.angle_between(corners[0], corner));
            let is_in_order = (1..3).all(|i| angles[i] < angles[i + 1]) || (1..3).all(|i| angles[i] > angles[i + 1]);
            crossed += usize::from(!is_in_order);
        }
        (worst, crossed)
    }

    fn arc(radius: f64, angle: f64) -> DVec3 {
        radius * DVec3::new(angle.cos(), angle.sin(), 0.0)
    }

    fn ring(count: usize, from: f64, to: f64) -> Vec<DVec3> {
        (0..=count).map(|k| arc(3.0, from + (to - from) * k as f64 / count as f64)).collect()
    }

    pub(in super::super) fn helix(count: usize) -> Vec<DVec3> {
        let point = |s: f64| DVec3::new(3.0 * s.cos(), 3.0 * s.sin(), 0.8 * s);
        (0..=count).map(|k| point(2.0 * k as f64 / count as f64)).collect()
    }

    const STRICT: Options = Options { is_strict: true, projects_lengths: false, fits_start: false };

    #[test]
    fn constant_lengths_on_a_circle_give_a_concentric_one_inside_and_outside() {
        for radius in [2.0, 4.0] {
            for turn in [TAU, -TAU] {
                let points = ring(24, 0.0, turn);
                let strip = of_lengths(&points, arc(radius, 0.0), &[1.0; 25], &STRICT).unwrap();
                for (point, border) in points.iter().zip(&strip.border) {
                    assert!(border.distance(radius / 3.0 * *point) < 1e-12);
                    assert!((border.distance(*point) - 1.0).abs() < 1e-12);
                }
                assert!(strip.deviation < 1e-12 && strip.flipped.is_empty());
                let (off_circle, crossed) = misfit(&strip);
                assert!(off_circle < 1e-12 && crossed == 0);
            }
        }
    }

    #[test]
    fn at_a_right_angle_the_growth_that_is_possible_vanishes_under_refinement() {
        // The first circle is Thales' about the hypotenuse Q₀P₁: its diameter is √(1 + h²).
        for count in [16_i32, 32, 64] {
            let h = 4.0 / f64::from(count);
            let points: Vec<DVec3> = (0..=count).map(|k| f64::from(k) * h * DVec3::X).collect();
            let strip = of_lengths(&points, DVec3::Y, &vec![1.0; points.len()], &STRICT).unwrap();
            assert!(strip.attainable.iter().all(|largest| (largest - h.hypot(1.0)).abs() < 1e-12));
        }
    }

    #[test]
    fn a_length_that_cannot_be_is_refused_with_the_nearest_that_can() {
        // The second edge leans backwards, so that the arc from Q₁ to P₂ is more than half of the second circle.
        let points: Vec<DVec3> = (0..5).map(|k| f64::from(k) * DVec3::X).collect();
        let start = DVec3::new(-0.3, 1.0, 0.0);
        let free = of_border_edges(&points, start, &[1.0; 4]).unwrap();
        let diameter = 2.0 * free.circles().unwrap()[1].radius;
        let mut lengths = free.lengths.clone();
        lengths[2] = 1.05 * diameter;
        let error = of_lengths(&points, start, &lengths, &Options::default()).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::NoIntersection, "lengths[2]"));
        let message = error.to_string();
        let number = |after: &str| -> f64 {
            let rest = &message[message.find(after).unwrap() + after.len()..];
            rest.split([' ', ',', ';']).next().unwrap().parse().unwrap()
        };
        for after in ["below ", "the nearest is ", "circle is "] {
            assert!((number(after) - diameter).abs() < 1e-12, "{message}");
        }
        // The diameter itself, also with the last bits of a sum.
        for factor in [1.0, 1.0 + 1e-13] {
            lengths[2] = factor * diameter;
            let strip = of_lengths(&points[..3], start, &lengths[..3], &STRICT).unwrap();
            let center = free.circles().unwrap()[1].center;
            assert!(strip.border[2].distance(2.0 * center - points[2]) < 1e-6 && strip.flipped.is_empty());
        }
        // The nearest instead: what was achieved is told.
        lengths[2] = 1.05 * diameter;
        let project = Options { projects_lengths: true, ..STRICT };
        let strip = of_lengths(&points, start, &lengths, &project).unwrap();
        assert_eq!(strip.projected[0], 2);
        assert!((strip.lengths[2] - diameter).abs() < 1e-12);
        let largest = strip.lengths.iter().zip(&lengths).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(strip.deviation == largest && largest >= 0.05 * diameter - 1e-12);
        assert!(misfit(&strip) == (misfit(&strip).0, 0) && misfit(&strip).0 < 1e-10);
    }

    #[test]
    fn crossed_quads_are_listed_or_refused() {
        // From a right angle on, lengths cannot grow beyond the distance of Q₀ from P₁.
        let points: Vec<DVec3> = (0..3).map(|k| f64::from(k) * DVec3::X).collect();
        let (start, lengths) = (DVec3::new(0.4, 1.0, 0.0), [1.16_f64.sqrt(), 1.2, 1.0]);
        let strip = of_lengths(&points, start, &lengths, &Options::default()).unwrap();
        assert_eq!(strip.flipped, [0]);
        assert_eq!(misfit(&strip).1, strip.flipped.len());
        assert!(strip.deviation < 1e-12 && (strip.attainable[0] - 1.36_f64.sqrt()).abs() < 1e-12);
        let error = of_lengths(&points, start, &lengths, &STRICT).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::NoSolution, "lengths[1]"));
        let project = Options { projects_lengths: true, ..STRICT };
        let strip = of_lengths(&points, start, &lengths, &project).unwrap();
        assert!(strip.projected == [1] && strip.flipped.is_empty() && misfit(&strip).1 == 0);
        assert!((strip.lengths[1] / strip.attainable[0] - 1.0).abs() < 2e-3);
    }

    #[test]
    fn the_start_is_turned_to_where_lengths_can_go_on() {
        let fit = Options { fits_start: true, ..STRICT };
        // A right angle for constant lengths on a circle, whatever the first guess.
        for radius in [2.0, 4.0] {
            let guess = arc(radius, 0.1);
            let strip = of_lengths(&ring(24, 0.0, 3.0), guess, &[1.0; 25], &fit).unwrap();
            assert!(strip.border.iter().all(|border| (border.length() - radius).abs() < 1e-10));
        }
        // Isosceles trapezoids on a straight guide, whatever the growth: cos α = −L'/2.
        for growth in [-0.2, 0.2] {
            let points: Vec<DVec3> = (0..=16).map(|k| f64::from(k) / 4.0 * DVec3::X).collect();
            let lengths = lengths_between(&points, 1.0, 1.0 + 4.0 * growth).unwrap();
            let strip = of_lengths(&points[..6], DVec3::Y, &lengths[..6], &fit).unwrap();
            for (point, border) in points.iter().zip(&strip.border) {
                assert!(((*border - *point).normalize().x + 0.5 * growth).abs() < 1e-9);
            }
        }
        // In space, shrinking; growing a little, where errors grow.
        for (first, last, count) in [(1.0, 0.6, 16), (1.0, 0.6, 64), (1.0, 1.3, 12)] {
            let points = helix(count);
            let lengths = lengths_between(&points, first, last).unwrap();
            let strip = of_lengths(&points, 1.4 * points[0] + 0.2 * DVec3::Y, &lengths, &fit).unwrap();
            assert!(strip.deviation < 1e-12 && misfit(&strip).1 == 0, "{count}");
            assert!(misfit(&strip).0 < 1e-12, "{}", misfit(&strip).0);
        }
    }

    #[test]
    fn radii_and_border_edges_of_a_strip_give_it_back() {
        let points = helix(16);
        let start = 1.3 * points[0] + 0.1 * DVec3::Z;
        let wave: Vec<f64> = (0..16).map(|k| 0.1 * (3.0 * PI * f64::from(k) / 16.0).sin() + 0.17).collect();
        let strip = of_border_edges(&points, start, &wave).unwrap();
        for (pair, length) in strip.border.windows(2).zip(&wave) {
            assert!((pair[0].distance(pair[1]) - length).abs() < 1e-12);
        }
        assert!(misfit(&strip).0 < 1e-12 && misfit(&strip).1 == 0);
        let radii: Vec<f64> = strip.circles().unwrap().iter().map(|circle| circle.radius).collect();
        let again = of_radii(&points, start, &radii, true).unwrap();
        let found: Vec<f64> = again.circles().unwrap().iter().map(|circle| circle.radius).collect();
        assert!(found.iter().zip(&radii).all(|(found, radius)| (found - radius).abs() < 1e-10));
        assert!(misfit(&again).0 < 1e-10 && misfit(&again).1 == 0);
        assert!((again.lengths[15] - again.lengths[16]).abs() < 1e-12);
        let same = again.border[..16].iter().zip(&strip.border).filter(|(a, b)| a.distance(**b) < 1e-9).count();
        assert_eq!(same, 16);
        let edges = edges_of_border(&points, 4.0).unwrap();
        let strip = of_border_edges(&points, start, &edges).unwrap();
        let total: f64 = strip.border.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        assert!((total - 4.0).abs() < 1e-12);
    }

    #[test]
    fn radii_are_refused_with_what_is_attainable() {
        let points = ring(8, 0.0, 2.0);
        let start = arc(4.0, 0.0);
        let radii = of_lengths(&points, start, &[1.0; 9], &STRICT).unwrap();
        let mut radii: Vec<f64> = radii.circles().unwrap().iter().map(|circle| circle.radius).collect();
        // The circles are about points between both rings: of_radii finds the same strip.
        let strip = of_radii(&points, start, &radii, true).unwrap();
        assert!(strip.border.iter().all(|border| (border.length() - 4.0).abs() < 1e-9));
        radii[3] = 0.1;
        let error = of_radii(&points, start, &radii, false).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::NoIntersection, "radii[3]"));
        // What it says is attainable is: the lower end of the interval.
        let message = error.to_string();
        let nearest: f64 = message.rsplit(' ').next().unwrap().parse().unwrap();
        let half_edge = 0.5 * points[3].distance(points[4]);
        assert!(nearest >= half_edge, "{message}");
        radii[3] = nearest * (1.0 + 1e-9);
        assert!(of_radii(&points[..5], start, &radii[..4], true).is_ok());
        radii[3] = nearest * (1.0 - 1e-3);
        assert!(of_radii(&points[..5], start, &radii[..4], true).is_err());
        assert_eq!(of_radii(&points, start, &[0.1; 8], false).unwrap_err().place(), "radii[0]");
    }

    #[test]
    fn input_that_is_no_strip_is_named() {
        let points = helix(3);
        let start = 1.2 * points[0];
        let place = |points: &[DVec3], start: DVec3, lengths: &[f64]| {
            let error = of_lengths(points, start, lengths, &Options::default()).unwrap_err();
            (error.status(), error.place().to_string())
        };
        let length = start.distance(points[0]);
        let case = |status, place: &str| (status, place.to_string());
        assert_eq!(place(&points[..1], start, &[length]), case(Status::InvalidArgumentLength, "points"));
        assert_eq!(place(&points, start, &[length; 3]), case(Status::InvalidArgumentLength, "lengths"));
        assert_eq!(place(&points, start, &[length, 1.0, -1.0, 1.0]), case(Status::InvalidValue, "lengths[2]"));
        assert_eq!(place(&points, start, &[length, f64::NAN, 1.0, 1.0]), case(Status::InvalidValue, "lengths[1]"));
        assert_eq!(place(&points, start, &[1.1 * length; 4]), case(Status::InvalidValue, "lengths[0]"));
        assert_eq!(place(&points, DVec3::NAN, &[length; 4]), case(Status::InvalidValue, "start"));
        let on_line = points[0].lerp(points[1], 0.3);
        let lengths = [on_line.distance(points[0]), 1.0, 1.0, 1.0];
        assert_eq!(place(&points, on_line, &lengths), case(Status::Degenerate, "start"));
        let twice = [points[0], points[1], points[1], points[2]];
        assert_eq!(place(&twice, start, &[length; 4]), case(Status::Degenerate, "points[2]"));
        let error = of_border_edges(&points, start, &[0.5, 100.0, 0.5]).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::NoIntersection, "edges[1]"));
        assert!(lengths_between(&[DVec3::X; 3], 1.0, 2.0).is_err() && edges_of_border(&points, f64::NAN).is_err());
    }
}
