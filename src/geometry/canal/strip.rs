//! Circular strips: one quad after the other, from points of a guide curve and one number for each quad.
//!
//! A strip has the guide's points `P_0 … P_n` on one side and `Q_0 … Q_n` on the other; all quads `P_k Q_k Q_{k+1} P_{k+1}` have
//! their corners on a circle. With `Q_0` given, the circle of each quad goes through `P_k`, `Q_k` and `P_{k+1}`, and one number
//! says where on it `Q_{k+1}` is. The paper offers two (section 3.2, Fig. 6): the length of the crossing edge `P_{k+1}Q_{k+1}`
//! ([`of_lengths`], with one length for each, or [`lengths_between`] one for the first and one for the last) and the radius of the
//! next circle ([`of_radii`]). A third is the length of the border's edge `Q_kQ_{k+1}` ([`of_border_edges`]); with it a border of one
//! given length is had by [`edges_of_border`].
//!
//! **On one line.** The inversion at `P_{k+1}` with the ratio `h² = ‖P_kP_{k+1}‖²` makes a line of the circle. In coordinates from
//! `P_{k+1}` the image of `P_k` is `p = P_k` and that of `Q_k` is `q`; with `t` the unit vector from `p` to `q` the points
//! beyond `q`, `q + s t` with `s > 0`, are the images of the points between `Q_k` and `P_{k+1}`: those for which the corners
//! `P_k, Q_k, Q_{k+1}, P_{k+1}` are in cyclic order. So order is a sign, and each number is a quadratic equation for `s`:
//!
//! - length: `‖q + s t‖ = h²/L`;
//! - border's edge: `h² s / (‖q‖ ‖q + s t‖) = M`;
//! - radius of the next circle: the line through `q + s t` and the image of `P_{k+2}` is `h²/2R` away from the origin.
//!
//! **Which root.** Where one root is in order, it is taken. Where both are, which for lengths happens when `P_kQ_k` leans
//! backwards, that one is whose border edge is nearer to the guide's edge in length, by ratio: the other makes the strip jump.
//! Where none is, the quad is crossed: the strip says so, or refuses it where it is asked to be strict.
//!
//! **Lengths are over-determined.** With `α` the angle from the guide's tangent to the chord `PQ`, a smooth strip has
//! `L' = −(1 + λ) cos α`, where `λ > 0` is the border's speed over the guide's, and the angle follows from the strip's past: with
//! the chord at a right angle to the guide a strip of short edges cannot grow. Going on from a small error of the angle, the error
//! shrinks where lengths shrink and grows where lengths grow, like `exp(4 s / L L')` on a straight guide. Hence
//! [`Options::projects_lengths`] and [`Options::fits_start`].

use std::ops::RangeInclusive;

use glam::DVec3;

use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::{Circle, PARALLEL};
use crate::mesh::Grid;
use crate::mesh::grid::check_finite;

/// A length this close above the largest that a circle allows, as a multiple of it, is that length: it differs by round-off.
const ROUND_OFF: f64 = 1e-12;

/// Part of the way from `Q_k` to `P_{k+1}`, on the line that the circle becomes and in units of its distance from `Q_k`'s image,
/// that a length which is too large to be in order is given back: at the limit itself the border's edge would have no length.
const LEAST_STEP: f64 = 1e-3;

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
        let circle = |k: usize| Circle::through(self.guide[k + 1], self.border[k], self.guide[k]);
        (0..self.guide.len() - 1).map(|k| circle(k).ok_or_else(|| on_a_line(k))).collect()
    }
}

/// The strip whose crossing edges have given lengths, in model units; `lengths[0]` is that of `P_0Q_0`.
///
/// Where `fits_start` is set, `Q_0` is in the half plane from the line `P_0P_1` through `start`, as far from `P_0` as `lengths[0]`
/// says, in the direction that follows from `L'(0)`: the border's speed is `λ = 1 − L κ·u / sin²α`, with `κ` the curvature vector
/// of the circle through the first three points and `u` the direction of the chord, so that the angle at first does not
/// change; and the first quad has the sides `h`, `L_1`, `λh`, `L_0`, whence its angle. If the lengths cannot all be met from there,
/// the angle is sought that misses them by least. Otherwise `Q_0` is `start`.
///
/// # Errors
/// Fewer than 2 points, another number of lengths than of points, a number that is not finite, a length that is not above 0, or
/// `lengths[0]` other than the distance of `start` from `points[0]` unless `fits_start` is set.
/// Status `Degenerate`: points coincide, or `P_k`, `Q_k` and `P_{k+1}` are on a line; the place is `start` or `points[k + 1]`.
/// `NoIntersection`: a length is larger than the diameter of its circle; `NoSolution`, where `is_strict`: no root is in cyclic
/// order. The place is `lengths[k]`, and the reason has the diameter, the attainable interval and the nearest attainable length.
/// With `projects_lengths` neither occurs.
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
                "no point of the quad before gives the radius {radius}: {low} to {high} are attainable, the nearest is {}",
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
                "a border edge of {length} is not attainable: lengths above 0 and below {largest} are, which is the nearest"
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

/// The solutions of an equation, not a number where there are fewer than two.
type Roots = [f64; 2];

/// A place on a quad's line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    pub s: f64,
    pub is_flipped: bool,
}

impl Choice {
    /// Among the roots: in order and nearest to the guide's edge; if none is in order, the nearest to `Q_k`.
    pub fn of(quad: &Quad, roots: Roots) -> Option<Self> {
        let misfit = |s: f64| (quad.border_edge(s) / quad.guide_edge()).ln().abs();
        match roots {
            [s, r] if s > 0.0 && r > 0.0 => {
                Some(Self { s: if misfit(r) < misfit(s) { r } else { s }, is_flipped: false })
            }
            // `max` prefers a number to none.
            [s, r] => Some(s.max(r)).filter(|s| s.is_finite()).map(|s| Self { s, is_flipped: !(s > 0.0) }),
        }
    }
}

/// A quad of which the next point is sought: its circle as the line of the module's documentation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quad {
    /// `P_{k+1}`, the center of inversion.
    corner: DVec3,
    /// The ratio of inversion, the squared length of the guide's edge.
    ratio: f64,
    /// The image of `Q_k`, from the corner.
    q: DVec3,
    /// The direction in which the next point is.
    t: DVec3,
    /// The component of `q` along `t`.
    along: f64,
    /// `‖P_kQ_k‖`.
    previous_length: f64,
}

impl Quad {
    /// `None` where the three points are on a line.
    pub fn new(previous: DVec3, across: DVec3, corner: DVec3) -> Option<Self> {
        let p = previous - corner;
        let ratio = p.length_squared();
        let offset = across - corner;
        let q = (ratio / offset.length_squared()) * offset;
        let step = q - p;
        let length = step.length();
        // Also false where one is not finite.
        if !(p.cross(step).length() > PARALLEL * p.length() * length && length < f64::INFINITY) {
            return None;
        }
        let t = step / length;
        Some(Self { corner, ratio, q, t, along: q.dot(t), previous_length: previous.distance(across) })
    }

    fn image(&self, point: DVec3) -> DVec3 {
        let offset = point - self.corner;
        (self.ratio / offset.length_squared()) * offset
    }

    /// The point of the circle whose image is `q + s t`.
    pub fn point(&self, s: f64) -> DVec3 {
        let image = self.q + s * self.t;
        self.corner + (self.ratio / image.length_squared()) * image
    }

    fn guide_edge(&self) -> f64 {
        self.ratio.sqrt()
    }

    fn border_edge(&self, s: f64) -> f64 {
        self.ratio * s.abs() / (self.q.length() * (self.q + s * self.t).length())
    }

    /// `2R`: the line is `h²/2R` away from the origin.
    fn diameter(&self) -> f64 {
        self.ratio / self.q.cross(self.t).length()
    }

    /// The least upper bound of the lengths at which the corners are in cyclic order: the diameter where the arc from `Q_k` to
    /// `P_{k+1}` is more than half of the circle, else the length at `Q_k` itself.
    pub fn largest_length(&self) -> f64 {
        if self.along < 0.0 { self.diameter() } else { self.ratio / self.q.length() }
    }

    /// Where that length is; where it is at `Q_k`, a little beyond.
    fn at_largest_length(&self) -> f64 {
        if self.along < 0.0 { -self.along } else { LEAST_STEP * self.q.length() }
    }

    /// Where the crossing edge has this length: `s² + 2 (q·t) s + q² − (h²/L)² = 0`.
    pub fn at_length(&self, length: f64) -> Roots {
        let distance = self.ratio / length;
        let apart = self.q.cross(self.t).length();
        if distance < apart {
            let is_the_diameter = distance * (1.0 + ROUND_OFF) >= apart;
            return [if is_the_diameter { -self.along } else { f64::NAN }, f64::NAN];
        }
        let norm = self.q.length();
        quadratic_roots(1.0, self.along, (norm - distance) * (norm + distance))
    }

    /// The first place beyond `q` where the border's edge has this length: with `m = (M ‖q‖/h²)²` it is where
    /// `(1 − m) s² − 2 m (q·t) s − m q² = 0`.
    fn at_border_edge(&self, length: f64) -> Option<f64> {
        let norm = self.q.length();
        let m = (length * norm / self.ratio).powi(2);
        let roots = quadratic_roots(1.0 - m, -m * self.along, -m * norm * norm);
        roots.into_iter().filter(|&s| s > 0.0).min_by(f64::total_cmp)
    }

    fn largest_border_edge(&self) -> f64 {
        if self.along < 0.0 { self.diameter() } else { self.ratio / self.q.length() }
    }

    /// Where the line from `q + s t` through `b` is this distance from the origin, and between which values that distance is for
    /// points in order.
    ///
    /// Its square is `g = N/D` with `N = ‖b × (q + s t)‖²` and `D = ‖q + s t − b‖²`, quadratic polynomials
    /// `n₂ s² + 2 n₁ s + n₀` and `s² + 2 d₁ s + d₀`; its extremes are at the ends and where `N'D = ND'`, that is
    /// `(n₂d₁ − n₁) s² + (n₂d₀ − n₀) s + n₁d₀ − n₀d₁ = 0`.
    fn at_line_distance(&self, b: DVec3, distance: f64) -> (Roots, RangeInclusive<f64>) {
        let (u, v) = (b.cross(self.t), b.cross(self.q));
        let offset = self.q - b;
        let [n0, n1, n2] = [v.length_squared(), u.dot(v), u.length_squared()];
        let (d0, d1) = (offset.length_squared(), offset.dot(self.t));
        let squared = distance * distance;
        let roots = quadratic_roots(n2 - squared, n1 - squared * d1, n0 - squared * d0);
        let g = |s: f64| (n0 + s * (2.0 * n1 + s * n2)) / (d0 + s * (2.0 * d1 + s));
        let turning = quadratic_roots(n2 * d1 - n1, 0.5 * (n2 * d0 - n0), n1 * d0 - n0 * d1);
        let extremes = turning.into_iter().filter(|&s| s > 0.0).map(g);
        let (low, high) = extremes.fold((n2.min(g(0.0)), n2.max(g(0.0))), |(l, h), g| (l.min(g), h.max(g)));
        (roots, low.max(0.0).sqrt()..=high.max(0.0).sqrt())
    }
}

/// The real solutions of `a x² + 2 b x + c = 0`, without cancellation.
fn quadratic_roots(a: f64, b: f64, c: f64) -> Roots {
    let discriminant = b * b - a * c;
    if !(discriminant >= 0.0) {
        return [f64::NAN; 2];
    }
    let sum = -(b + discriminant.sqrt().copysign(b));
    // One is sum / a, their product c / a.
    [sum / a, c / sum].map(|root| if root.is_finite() { root } else { f64::NAN })
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
    // The angle of the quad with the sides h, L₁, λh, L₀: both triangles on the diagonal Q₀P₁, whose other angles are
    // supplementary, give cos α = (h² + L₀² − L₁² − λ²h²) / 2h(L₀ + λL₁).
    let cosine = |lambda: f64| {
        let sides = h * h * (1.0 - lambda * lambda) + (lengths[0] - lengths[1]) * (lengths[0] + lengths[1]);
        (sides / (2.0 * h * (lengths[0] + lambda * lengths[1]))).clamp(-0.9, 0.9)
    };
    let mut angle = cosine(1.0).acos();
    for _ in 0..20 {
        let direction = angle.cos() * x + angle.sin() * y;
        let lambda = 1.0 - lengths[0] * curvature.dot(direction) / angle.sin().powi(2);
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

fn on_a_line(k: usize) -> Error {
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

fn check_positive(name: &str, values: &[f64], count: usize) -> Result<()> {
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
