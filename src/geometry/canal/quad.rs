//! One quad of a circular strip: three corners are known, and one number says where the fourth is on their circle.
//!
//! The inversion at `P_{k+1}` with the ratio `h² = ‖P_kP_{k+1}‖²` makes a line of the circle. In coordinates from `P_{k+1}` the
//! image of `P_k` is `p = P_k` and that of `Q_k` is `q`; with `t` the unit vector from `p` to `q` the points beyond `q`, `q + s t`
//! with `s > 0`, are the images of the points between `Q_k` and `P_{k+1}`: those for which the corners `P_k, Q_k, Q_{k+1}, P_{k+1}`
//! are in cyclic order. So order is a sign, and each number is a quadratic equation for `s`:
//!
//! - length of the crossing edge: `‖q + s t‖ = h²/L`;
//! - length of the border's edge: `h² s / (‖q‖ ‖q + s t‖) = M`;
//! - radius of the next circle: the line through `q + s t` and the image of `P_{k+2}` is `h²/2R` away from the origin.

use std::ops::RangeInclusive;

use glam::DVec3;

use crate::geometry::circle::PARALLEL;

/// A length this close above the largest that a circle allows, as a multiple of it, is that length: it differs by round-off.
pub(super) const ROUND_OFF: f64 = 1e-12;

/// Part of the way from `Q_k` to `P_{k+1}` that a length which is too large to be in order is given back: at the limit itself
/// the border's edge would have no length.
const LEAST_STEP: f64 = 1e-3;

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
    pub ratio: f64,
    /// The image of `Q_k`, from the corner.
    q: DVec3,
    /// The direction in which the next point is.
    t: DVec3,
    /// The component of `q` along `t`.
    along: f64,
    /// `‖P_kQ_k‖`.
    pub previous_length: f64,
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

    pub fn image(&self, point: DVec3) -> DVec3 {
        let offset = point - self.corner;
        (self.ratio / offset.length_squared()) * offset
    }

    /// The distance of the image of `Q_k` from the center of inversion: a unit of `s`.
    pub fn unit(&self) -> f64 {
        self.q.length()
    }

    /// The point of the circle whose image is `q + s t`.
    pub fn point(&self, s: f64) -> DVec3 {
        let image = self.q + s * self.t;
        self.corner + (self.ratio / image.length_squared()) * image
    }

    /// Where the image of a point of the circle is.
    pub fn place(&self, point: DVec3) -> f64 {
        (self.image(point) - self.q).dot(self.t)
    }

    fn guide_edge(&self) -> f64 {
        self.ratio.sqrt()
    }

    fn border_edge(&self, s: f64) -> f64 {
        self.ratio * s.abs() / (self.q.length() * (self.q + s * self.t).length())
    }

    /// `2R`: the line is `h²/2R` away from the origin.
    pub fn diameter(&self) -> f64 {
        self.ratio / self.q.cross(self.t).length()
    }

    /// The least upper bound of the lengths at which the corners are in cyclic order: the diameter where the arc from `Q_k` to
    /// `P_{k+1}` is more than half of the circle, else the length at `Q_k` itself.
    pub fn largest_length(&self) -> f64 {
        if self.along < 0.0 { self.diameter() } else { self.ratio / self.q.length() }
    }

    /// Where that length is; where it is at `Q_k`, a little beyond.
    pub fn at_largest_length(&self) -> f64 {
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
    pub fn at_border_edge(&self, length: f64) -> Option<f64> {
        let norm = self.q.length();
        let m = (length * norm / self.ratio).powi(2);
        let roots = quadratic_roots(1.0 - m, -m * self.along, -m * norm * norm);
        roots.into_iter().filter(|&s| s > 0.0).min_by(f64::total_cmp)
    }

    pub fn largest_border_edge(&self) -> f64 {
        if self.along < 0.0 { self.diameter() } else { self.ratio / self.q.length() }
    }

    /// Where the line from `q + s t` through `b` is this distance from the origin, and between which values that distance is for
    /// points in order.
    ///
    /// Its square is `g = N/D` with `N = ‖b × (q + s t)‖²` and `D = ‖q + s t − b‖²`, quadratic polynomials
    /// `n₂ s² + 2 n₁ s + n₀` and `s² + 2 d₁ s + d₀`; its extremes are at the ends and where `N'D = ND'`, that is
    /// `(n₂d₁ − n₁) s² + (n₂d₀ − n₀) s + n₁d₀ − n₀d₁ = 0`.
    pub fn at_line_distance(&self, b: DVec3, distance: f64) -> (Roots, RangeInclusive<f64>) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::circle::Circle;
    use crate::geometry::random::Random;

    #[test]
    fn what_is_attainable_is_what_a_search_along_the_arc_attains() {
        let mut random = Random(21);
        let (mut flipped_count, mut double_count) = (0, 0);
        for _ in 0..2000 {
            let [a, b, q] = std::array::from_fn(|_| random.vector());
            let quad = Quad::new(a, q, b).unwrap();
            let circle = Circle::through(b, q, a).unwrap();
            let arc = circle.angle_between(b, q);
            let length = random.between(0.02, 2.3) * circle.radius;
            // Chords 2R sin(x/2) of the arc's parts: one sign change of the difference for each solution.
            let misfit = |i: i32| 2.0 * circle.radius * (0.5 * arc * f64::from(i) / 1000.0).sin() - length;
            let found = (0..1000).filter(|&i| (misfit(i) < 0.0) != (misfit(i + 1) < 0.0)).count();
            let largest = (0..=1000).map(|i| misfit(i) + length).fold(0.0, f64::max);
            assert!((largest / quad.largest_length() - 1.0).abs() < 1e-5);
            let choice = Choice::of(&quad, quad.at_length(length));
            let in_order = quad.at_length(length).iter().filter(|&&s| s > 0.0).count();
            // Two solutions between samples are not seen.
            assert!(in_order == found || (length / largest - 1.0).abs() < 1e-5);
            match choice {
                None => assert!(length >= 2.0 * circle.radius),
                Some(choice) => {
                    let point = quad.point(choice.s);
                    assert!(circle.distance(point) < 1e-11 * circle.radius);
                    assert!((point.distance(b) - length).abs() < 1e-11 * circle.radius);
                    assert_eq!(choice.is_flipped, found == 0);
                    assert_eq!(circle.angle_between(b, point) < arc, !choice.is_flipped);
                    flipped_count += usize::from(choice.is_flipped);
                    double_count += usize::from(found == 2);
                }
            }
        }
        assert!(flipped_count > 100 && double_count > 50, "{flipped_count} {double_count}");
    }
}
