//! Circles, spheres and arcs: through points, with tangents, and where they meet.
//!
//! Two circles that meet in one point and lie on one sphere (or in one plane) meet in a second one. The constructions here
//! know the first and so need no choice of a root.

use glam::DVec3;

pub use crate::mesh::fit::Circle;

/// Sine of the angle below which two directions count as parallel: their cross product has lost all but four digits.
pub(super) const PARALLEL: f64 = 1e-12;

/// The angle between an arc's start tangent and its chord, short of π, from which on the arc counts as running through
/// infinity: its radius is more than 1e8 chords.
const THROUGH_INFINITY: f64 = 1e-8;

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its center.
    pub center: DVec3,
    /// Its radius.
    pub radius: f64,
}

impl Circle {
    /// The circle through three points, in the direction `a`, `b`, `c` about its normal; `None` where they lie on a line
    /// within round-off.
    ///
    /// With `u = b − a`, `v = c − a`, `w = u × v` the center is `a + ((w × u) v² + (v × w) u²) / 2 w²`.
    pub fn through(a: DVec3, b: DVec3, c: DVec3) -> Option<Self> {
        let (u, v) = (b - a, c - a);
        // In units of the longer edge, so that fourth powers of huge or tiny coordinates stay in range.
        let scale = u.length().max(v.length());
        let (u, v) = (u / scale, v / scale);
        let w = u.cross(v);
        if !(w.length() > PARALLEL * u.length() * v.length()) {
            return None;
        }
        let offset = (w.cross(u) * v.length_squared() + v.cross(w) * u.length_squared()) / (2.0 * w.length_squared());
        Some(Self { center: a + scale * offset, normal: w.normalize(), radius: scale * offset.length() })
    }

    /// The point at an angle from the direction in which `reference` lies, counterclockwise about the normal.
    pub fn point_at(&self, reference: DVec3, angle_rad: f64) -> DVec3 {
        let x = (reference - self.center).reject_from_normalized(self.normal).normalize_or(DVec3::X);
        let x = if x.dot(self.normal).abs() < 0.5 { x } else { self.normal.any_orthonormal_vector() };
        let y = self.normal.cross(x);
        self.center + self.radius * (angle_rad.cos() * x + angle_rad.sin() * y)
    }

    /// The angle from `from` to `to` about the normal, 0 to 2π; both are taken as seen from the axis.
    pub fn angle_between(&self, from: DVec3, to: DVec3) -> f64 {
        let (u, v) = (from - self.center, to - self.center);
        let angle = self
            .normal
            .dot(u.cross(v))
            .atan2(u.reject_from_normalized(self.normal).dot(v.reject_from_normalized(self.normal)));
        if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }
    }

    /// The unit tangent at a point of the circle, counterclockwise about the normal.
    pub fn tangent_at(&self, point: DVec3) -> DVec3 {
        self.normal.cross(point - self.center).normalize_or_zero()
    }

    /// The second point in which the plane through `known`, a point of the circle, with the given normal meets the circle:
    /// `known` mirrored about the foot of the center on the line in which the two planes meet. `None` where the circle lies
    /// in that plane. Where the plane touches the circle the second point is `known` again.
    pub fn second_point(&self, known: DVec3, plane_normal: DVec3) -> Option<DVec3> {
        let line = self.normal.cross(plane_normal);
        if !(line.length() > PARALLEL * plane_normal.length()) {
            return None;
        }
        let line = line.normalize();
        Some(known + 2.0 * (self.center - known).dot(line) * line)
    }
}

impl Sphere {
    /// The sphere through a circle and a point off its plane; `None` where the point is in the circle's plane, of which the
    /// sphere then is a limit.
    ///
    /// The center is `c + s ν` with `s = ((q − c)² − r²) / (2 (q − c)·ν)`.
    pub fn through(circle: &Circle, point: DVec3) -> Option<Self> {
        let q = point - circle.center;
        let height = q.dot(circle.normal);
        if !(height.abs() > PARALLEL * q.length().max(circle.radius)) {
            return None;
        }
        let s = (q.length_squared() - circle.radius * circle.radius) / (2.0 * height);
        Some(Self { center: circle.center + s * circle.normal, radius: s.hypot(circle.radius) })
    }

    /// The distance of a point from the sphere, above 0 outside.
    pub fn distance(&self, point: DVec3) -> f64 {
        point.distance(self.center) - self.radius
    }

    /// The circle in which two spheres meet, its normal from this sphere's center to the other's; `None` where they do not
    /// meet in more than a point.
    ///
    /// With `D` the distance of the centers, the plane is at `x = (D² + R² − R'²) / 2D` from the first, and the radius is
    /// `√(R² − x²)`.
    pub fn meet(&self, other: &Self) -> Option<Circle> {
        let axis = other.center - self.center;
        let distance = axis.length();
        if !(distance > PARALLEL * self.radius.max(other.radius)) {
            return None;
        }
        let normal = axis / distance;
        let x = 0.5 * (distance + (self.radius - other.radius) * (self.radius + other.radius) / distance);
        let squared = (self.radius - x) * (self.radius + x);
        (squared > 0.0).then(|| Circle { center: self.center + x * normal, normal, radius: squared.sqrt() })
    }
}

/// An arc by its ends and the unit tangent at its start; straight where the tangent points to the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Where it starts.
    pub start: DVec3,
    /// The unit tangent there.
    pub tangent: DVec3,
    /// Where it ends.
    pub end: DVec3,
}

impl Arc {
    /// The angle between the start tangent and the chord, 0 to π: half of the angle that the arc spans.
    pub fn half_angle(&self) -> f64 {
        let chord = self.end - self.start;
        chord.cross(self.tangent).length().atan2(chord.dot(self.tangent))
    }

    /// Whether the arc cannot be told from one that runs through infinity.
    pub fn runs_through_infinity(&self) -> bool {
        self.half_angle() > std::f64::consts::PI - THROUGH_INFINITY
    }

    /// The point at a fraction of the arc's angle, 0 at the start and 1 at the end.
    ///
    /// Seen from the start, a point at the fraction `s` is in the direction that is turned from the tangent by `φ s`, `φ`
    /// the half angle, and its distance is the chord times `sin(φ s) / sin φ`.
    pub fn point(&self, fraction: f64) -> DVec3 {
        if fraction == 0.0 || fraction == 1.0 {
            return if fraction == 0.0 { self.start } else { self.end };
        }
        let chord = self.end - self.start;
        let side = chord - chord.dot(self.tangent) * self.tangent;
        let phi = self.half_angle();
        // Both quotients tend to `fraction` for a straight arc.
        let (sine, length) = (phi.sin(), chord.length());
        if sine < 1e-9 {
            return self.start + fraction * chord;
        }
        let (turned_sine, turned_cosine) = (phi * fraction).sin_cos();
        let along = turned_sine * turned_cosine / sine * length;
        // `side` has the length `chord sin φ`.
        self.start + along * self.tangent + (turned_sine / sine) * (turned_sine / sine) * side
    }

    /// The unit tangent at a point of the arc: that at the start, mirrored and turned round (an arc makes the same angle with
    /// a chord at both ends).
    pub fn tangent_at(&self, point: DVec3) -> DVec3 {
        -reflect(self.tangent, point - self.start)
    }

    /// The fraction of the arc's angle at which one of its points lies, 0 to below π over the half angle.
    pub fn fraction_of(&self, point: DVec3) -> f64 {
        let phi = self.half_angle();
        let chord = self.end - self.start;
        let part = Self { end: point, ..*self };
        if phi < 1e-9 { part.end.distance(self.start) / chord.length() } else { part.half_angle() / phi }
    }

    /// The curvature vector: towards the center, one over the radius long; zero where the arc is straight.
    pub fn curvature(&self) -> DVec3 {
        let chord = self.end - self.start;
        2.0 * (chord - chord.dot(self.tangent) * self.tangent) / chord.length_squared()
    }
}

/// `v` mirrored in the plane that is orthogonal to `direction`, of any length: `v − 2 (v·d) d / d²`. Zero has no plane; `v`
/// stays.
pub fn reflect(v: DVec3, direction: DVec3) -> DVec3 {
    let squared = direction.length_squared();
    if squared > 0.0 { v - (2.0 * v.dot(direction) / squared) * direction } else { v }
}

/// The second point in which two circles meet that meet in `known` and are on one sphere: one goes through `first` and
/// `second`, the other has the unit tangent `tangent` at `known` and goes through `third`.
///
/// An inversion at `known` makes straight lines of both: one through the images of `first` and `second`, the other through the
/// image of `third` along `tangent`. The image of what is sought is where they meet; we take the point of the other line, so
/// the result is on the second circle to rounding. Straight circles, and circles in one plane, are no exceptions.
pub fn second_point(known: DVec3, first: DVec3, second: DVec3, tangent: DVec3, third: DVec3) -> DVec3 {
    let scale = third - known;
    let squared = scale.length_squared();
    let image = |point: DVec3| {
        let q = point - known;
        (squared / q.length_squared()) * q
    };
    let (a, b, c) = (image(first), image(second), image(third));
    // Nearest point of the line c + s·tangent to the line a b: with m = (b − a) × (tangent × (b − a)), orthogonal to b − a in
    // the plane of both directions, s = (a − c)·m / tangent·m.
    let direction = b - a;
    let m = direction.cross(tangent.cross(direction));
    let s = (a - c).dot(m) / tangent.dot(m);
    let met = c + s * tangent;
    let back = squared / met.length_squared();
    // Parallel lines meet at infinity, whose image is `known`.
    if s.is_finite() && back.is_finite() { known + back * met } else { known }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::Random;

    #[test]
    fn a_circle_through_three_points_is_as_far_from_all() {
        let mut random = Random(1);
        for scale in [1e-60, 1e-6, 1.0, 1e6, 1e60] {
            let [a, b, c] = std::array::from_fn(|_| scale * random.vector());
            let circle = Circle::through(a, b, c).unwrap();
            for point in [a, b, c] {
                assert!((point.distance(circle.center) - circle.radius).abs() < 1e-13 * circle.radius);
                assert!((point - circle.center).dot(circle.normal).abs() < 1e-13 * circle.radius);
            }
            assert!(circle.angle_between(a, b) < circle.angle_between(a, c));
        }
        assert!(Circle::through(DVec3::ZERO, DVec3::X, 2.0 * DVec3::X).is_none());
        assert!(Circle::through(DVec3::X, DVec3::X, DVec3::Y).is_none());
    }

    #[test]
    fn spheres_meet_in_a_circle_on_both() {
        let (a, b) =
            (Sphere { center: DVec3::ZERO, radius: 2.0 }, Sphere { center: DVec3::new(1.0, 2.0, 0.5), radius: 1.5 });
        let circle = a.meet(&b).unwrap();
        for i in 0..7 {
            let point = circle.point_at(DVec3::new(5.0, 1.0, 0.0), f64::from(i));
            assert!(a.distance(point).abs() < 1e-14 && b.distance(point).abs() < 1e-14);
        }
        // Apart, one in the other, equal.
        for (center, radius) in [(4.0 * DVec3::X, 1.0), (0.5 * DVec3::X, 0.5), (DVec3::ZERO, 2.0)] {
            assert!(a.meet(&Sphere { center, radius }).is_none());
        }
        let through = Sphere::through(&circle, DVec3::new(0.0, 0.0, 6.0)).unwrap();
        assert!(through.distance(circle.point_at(DVec3::X, 1.0)).abs() < 1e-13);
        assert!(through.distance(DVec3::new(0.0, 0.0, 6.0)).abs() < 1e-13);
        assert!(Sphere::through(&circle, circle.center).is_none());
    }

    #[test]
    fn an_arc_is_on_the_circle_through_its_ends_with_its_tangent() {
        // A quarter and three quarters of the unit circle.
        for (end, fraction, expected) in
            [(DVec3::Y, 1.0 / 3.0, DVec3::new(0.75_f64.sqrt(), 0.5, 0.0)), (DVec3::NEG_Y, 1.0 / 3.0, DVec3::Y)]
        {
            let arc = Arc { start: DVec3::X, tangent: DVec3::Y, end };
            assert!(arc.point(fraction).distance(expected) < 1e-15);
            assert!((arc.fraction_of(expected) - fraction).abs() < 1e-15);
            assert!(arc.tangent_at(expected).distance(DVec3::Z.cross(expected)) < 1e-15);
            assert!(arc.curvature().distance(DVec3::NEG_X) < 1e-15);
        }
        let straight = Arc { start: DVec3::ZERO, tangent: DVec3::X, end: 2.0 * DVec3::X };
        assert_eq!((straight.point(0.25), straight.curvature()), (0.5 * DVec3::X, DVec3::ZERO));
        assert!(!straight.runs_through_infinity());
        assert!(Arc { tangent: DVec3::NEG_X, ..straight }.runs_through_infinity());
    }

    #[test]
    fn circles_that_meet_on_a_sphere_meet_twice() {
        // Two circles through one point of the unit sphere, in two planes through it: known second point.
        let mut random = Random(5);
        for _ in 0..200 {
            let [known, other, p, q] = std::array::from_fn(|_| random.vector().normalize());
            let first = Circle::through(known, other, p).unwrap();
            let second = Circle::through(known, other, q).unwrap();
            let (tangent, third) = (second.tangent_at(known), second.point_at(known, 2.0));
            let found = second_point(known, p, first.point_at(p, 1.0), tangent, third);
            assert!(found.distance(other) < 1e-9, "{}", found.distance(other));
            let plane_normal = (p - known).cross(other - known);
            assert!(second.second_point(known, plane_normal).unwrap().distance(other) < 1e-9);
        }
        // In a plane: the unit circle about (1, 0) and the line x = y both go through (0, 0) and (1, 1).
        let found = second_point(
            DVec3::ZERO,
            DVec3::new(2.0, 0.0, 0.0),
            DVec3::new(1.0, -1.0, 0.0),
            DVec3::new(0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0),
            DVec3::new(3.0, 3.0, 0.0),
        );
        assert!(found.distance(DVec3::new(1.0, 1.0, 0.0)) < 1e-14);
        let circle = Circle { center: DVec3::ZERO, normal: DVec3::Z, radius: 1.0 };
        assert!(circle.second_point(DVec3::X, DVec3::Z).is_none());
        assert!(circle.second_point(DVec3::X, DVec3::X).unwrap().distance(DVec3::X) < 1e-15);
    }
}
