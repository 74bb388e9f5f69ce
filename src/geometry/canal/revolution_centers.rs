//! Centers of inversion that map four points of a circle to an isosceles trapezoid (Mesnil et al. 2018, section 5.1).
//!
//! `P1 P2 P3 P4` are on a circle, in this order; an inversion at a point `C` of their plane maps them to corners of an isosceles
//! trapezoid whose parallel sides are `P1' P2'` and `P4' P3'`.
//!
//! *Where `C` is.* An isosceles trapezoid has an axis that swaps `P1'` with `P2'` and `P4'` with `P3'`. Mirroring in it is, seen
//! before the inversion, the inversion in a circle `K` through `C` that swaps `P1` with `P2` and `P4` with `P3`. There is one such
//! circle: its center `O` is where the lines `P1 P2` and `P4 P3` meet, its squared radius `(P1 − O)·(P2 − O)` the power of `O`, so
//! that `K` is orthogonal to the given circle. Conversely every point of `K` will do, but the two on the given circle, for which
//! the images are on a line. So the solutions are two arcs of `K`, one inside the given circle, one outside. The paper finds
//! them one by one, by a quadratic equation for each ratio `t` of the parallel sides; and where it says that there are two for
//! each `t`, both are on the given circle unless `t` is in one interval.
//!
//! *Coordinates.* The given circle is the unit circle about 0, `P1` to `P4` counterclockwise. Lines in homogeneous coordinates, the
//! cross product of the two lines is `(X, W)` with `O = X / W`. Let `u` be the unit vector along `X`, its sign such that it
//! points from `P1`, `P4` to `P2`, `P3`, and `q` the inverse of the signed distance of `O` along `u`, −1 to 1. Then
//!
//! ```text
//! K:  q |z|² − 2 u·z + q = 0
//! ```
//!
//! which for `q = 0` is the line of symmetry of corners that are an isosceles trapezoid already. With `g = q / (1 + √(1 − q²))` the
//! point of `K` inside is `g u`, and the opposite one, outside, `u / g`. With `v` the vector `u` turned by a right angle,
//!
//! ```text
//! C(ω) = (g u + (1 − g²) s c v) / (c² + g² s²),    c = cos ω/2,  s = sin ω/2
//! ```
//!
//! runs once through `K` while `ω` runs from −π to π, smoothly for `g = 0` too, when it passes through infinity at π. The
//! points on the given circle are those for `ω = ±π/2`; `ω` and `π − ω` are mirror images in it, and give the same `t`.

use glam::{DVec2, DVec3};

use super::inversion::GeneralCircle;
use super::polyline::{COINCIDE, NO_LENGTH};
use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::Circle;
use crate::mesh::grid::{check_finite, diagonal};

/// Centers nearer to the given circle than this, over its radius, count as on it. Where `t` comes near an end of its interval by
/// a relative ε, both roots of the quadratic equation come to the circle as √ε: this is round-off of `t`.
const ON_CIRCLE: f64 = 1e-7;

/// Centers farther away than this, in radii, count as at infinity: an inversion so far off loses as many digits as the given
/// points miss an isosceles trapezoid by.
const AT_INFINITY: f64 = 1e8;

/// The default center is at most this many radii away from the given circle's: farther off, the inversion loses digits.
const DEFAULT_DISTANCE: f64 = 100.0;

/// Which center of inversion to take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Center {
    /// The middle of the outer arc of the circle of centers, or the point of that arc at 100 radii where it is farther away;
    /// no inversion where the points are corners of an isosceles trapezoid already.
    Middle,
    /// The point of the circle of centers at this angle `ω`, in radians: 0 is the middle of the inner arc, π that of the outer
    /// one, ±π/2 are the ends of both, which are no solutions.
    Angle(f64),
    /// The point for which the parallel sides have this ratio `t = |P1' P2'| / |P4' P3'|`, inside the given circle or outside.
    Ratio {
        /// In the interval [`Corners::ratio_limits`].
        ratio: f64,
        /// Which of the two solutions.
        is_inside: bool,
    },
    /// This point of the circle of centers.
    At(DVec3),
}

/// Four points of a circle, in order round it, and the circle of centers of inversion that map them to isosceles trapezoids.
#[derive(Clone, Debug, PartialEq)]
pub struct Corners {
    circle: Circle,
    /// Unit vectors in the plane; with the normal they are right-handed.
    axes: [DVec3; 2],
    z: [DVec2; 4],
    u: DVec2,
    q: f64,
    g: f64,
}

impl Corners {
    /// The corners `P1` to `P4`, in model units.
    ///
    /// # Errors
    /// A coordinate that is not finite. Status `Degenerate`: two corners coincide or all are on a line; `NotCircular`: they are not
    /// on a circle within 1e-9 of their extent; `InvalidValue`: they are not in order round it. The place is `corners` or
    /// `corners[i]`, `i` from 0.
    pub fn new(corners: [DVec3; 4]) -> Result<Self> {
        check_finite("corners", &corners)?;
        let extent = diagonal(&corners);
        for i in 0..4 {
            if (0..i).any(|k| !(corners[i].distance(corners[k]) > COINCIDE * extent)) {
                let reason = "expected four different points, found one twice";
                return Err(Error::new(Status::Degenerate, reason).at(format!("corners[{i}]")));
            }
        }
        let Some(mut circle) = Circle::fitting(&corners) else {
            return Err(
                Error::new(Status::Degenerate, "expected points on a circle, found them on a line").at("corners")
            );
        };
        let distances = corners.map(|corner| circle.distance(corner));
        let worst = (0..4).fold(0, |a, b| if distances[b] > distances[a] { b } else { a });
        if !(distances[worst] <= COINCIDE * extent) {
            let reason = format!("expected points on a circle, found one {:e} off the nearest", distances[worst]);
            return Err(Error::new(Status::NotCircular, reason).at(format!("corners[{worst}]")));
        }
        let turns = |circle: &Circle| [1, 2, 3].map(|k| circle.angle_between(corners[0], corners[k]));
        let is_ascending = |turns: [f64; 3]| turns[0] < turns[1] && turns[1] < turns[2];
        if !is_ascending(turns(&circle)) {
            circle.normal = -circle.normal;
            if !is_ascending(turns(&circle)) {
                let reason = "expected P1, P2, P3, P4 in order round their circle, found another order";
                return Err(Error::new(Status::InvalidValue, reason).at("corners"));
            }
        }
        let x = (corners[0] - circle.center).reject_from_normalized(circle.normal).normalize_or_zero();
        let axes = [x, circle.normal.cross(x)];
        let z = corners.map(|corner| in_plane(&circle, axes, corner).normalize_or_zero());
        // Lines through two points, with unit normals: n·z = h.
        let line = |a: DVec2, b: DVec2| {
            let normal = (b - a).perp().normalize_or_zero();
            DVec3::new(normal.x, normal.y, -0.5 * normal.dot(a + b))
        };
        let met = line(z[0], z[1]).cross(line(z[3], z[2]));
        let direction = DVec2::new(met.x, met.y);
        let (length, towards) = (direction.length(), (z[1] - z[0]) + (z[2] - z[3]));
        let sign = if direction.dot(towards) < 0.0 { -1.0 } else { 1.0 };
        let (u, q) = (sign / length * direction, sign * met.z / length);
        if !(length > NO_LENGTH && q.abs() < 1.0) {
            let reason = "expected four points well apart on their circle, found some too near each other";
            return Err(Error::new(Status::Degenerate, reason).at("corners"));
        }
        let g = q / (1.0 + ((1.0 - q) * (1.0 + q)).sqrt());
        Ok(Self { circle, axes, z, u, q, g })
    }

    /// The circle through the corners, which run counterclockwise about its normal.
    pub fn circle(&self) -> Circle {
        self.circle
    }

    /// `P1` to `P4`, moved onto their circle.
    pub fn points(&self) -> [DVec3; 4] {
        self.z.map(|z| self.in_space(z))
    }

    /// The circle of centers `K`: the line of symmetry where the corners are those of an isosceles trapezoid within round-off.
    /// Inversions at its points map it to the trapezoid's axis.
    pub fn circle_of_centers(&self) -> GeneralCircle {
        if self.q.abs() <= 1.0 / AT_INFINITY {
            let along = self.in_space(self.u.perp()) - self.circle.center;
            return GeneralCircle::Line(self.in_space(self.g * self.u), along.normalize_or_zero());
        }
        let radius = ((1.0 - self.q) * (1.0 + self.q)).sqrt() / self.q.abs();
        GeneralCircle::Circle(Circle {
            center: self.in_space(self.u / self.q),
            normal: self.circle.normal,
            radius: radius * self.circle.radius,
        })
    }

    /// The point of the circle of centers at the angle `omega` (see [`Center::Angle`]); `None` for infinity.
    pub fn center_at(&self, omega: f64) -> Option<DVec3> {
        let (x, w) = self.homogeneous(omega);
        (w * AT_INFINITY > x.length()).then(|| self.in_space(x / w))
    }

    /// The ratio `t(ω) = |P1' P2'| / |P4' P3'|` that the inversion at [`Corners::center_at`] leads to: the real number
    /// `(z2 − z1)(z3 − C)(z4 − C) / (z3 − z4)(z1 − C)(z2 − C)`.
    ///
    /// The quotient (8) of the paper is this one; the quotient (7) of the images is its complex conjugate, which is the same
    /// only where it is real, that is, for these centers.
    pub fn ratio_at(&self, omega: f64) -> f64 {
        let (x, w) = self.homogeneous(omega);
        let [z1, z2, z3, z4] = self.z;
        let to = |z: DVec2| w * z - x;
        let above = (z2 - z1).rotate(to(z3)).rotate(to(z4));
        let below = (z3 - z4).rotate(to(z1)).rotate(to(z2));
        divide(above, below).x
    }

    /// The ends `t₋ < t₊` of the open interval of ratios for which there are solutions: the ratios at the two points in which the
    /// circle of centers meets the given circle.
    pub fn ratio_limits(&self) -> [f64; 2] {
        let quarter = std::f64::consts::FRAC_PI_2;
        let [a, b] = [self.ratio_at(-quarter), self.ratio_at(quarter)];
        [a.min(b), a.max(b)]
    }

    /// The angles `ω` of the two centers, inside and outside the given circle, that lead to a ratio `t` of the parallel sides.
    ///
    /// By the quadratic equation (9), `A z² + B z + D = 0`, with
    ///
    /// ```text
    /// A = z2 − z1 + t (z4 − z3)
    /// B = (1 + t) z1 z3 + (1 − t) z1 z4 − (1 + t) z2 z4 + (t − 1) z2 z3
    /// D = z3 z4 (z2 − z1) + t z1 z2 (z4 − z3)
    /// ```
    ///
    /// The paper prints `B` with the opposite sign, which turns the roots round: they would be `−C`. For `A = 0` one solution
    /// is at infinity, and the other is the given circle's center: that is where `ω` is π and 0. Roots on the given circle map
    /// the corners to a line and are no solutions.
    ///
    /// # Errors
    /// A ratio that is not finite. Status `NoSolution`: both roots are on the given circle, which is so for ratios outside
    /// [`Corners::ratio_limits`]. The place is `ratio`.
    pub fn angles_of_ratio(&self, ratio: f64) -> Result<[f64; 2]> {
        let t = finite("ratio", ratio)?;
        let [z1, z2, z3, z4] = self.z;
        let a = z2 - z1 + t * (z4 - z3);
        let b = (1.0 + t) * (z1.rotate(z3) - z2.rotate(z4)) + (1.0 - t) * (z1.rotate(z4) - z2.rotate(z3));
        let d = z3.rotate(z4).rotate(z2 - z1) + t * z1.rotate(z2).rotate(z4 - z3);
        let root = square_root(b.rotate(b) - 4.0 * a.rotate(d));
        // −(B ± root) / 2 with the sign for which nothing cancels; the roots are this over A, and D over this.
        let half = -0.5 * (b + if b.dot(root) < 0.0 { -root } else { root });
        let scale = z1.distance(z2) + t.abs() * z3.distance(z4);
        let far = if a.length() <= NO_LENGTH * scale { None } else { Some(divide(half, a)) };
        let (near, far) = (divide(d, half), far.filter(|far| far.length() < AT_INFINITY));
        // Solutions are mirror images in the unit circle: one is inside. On the circle they are none.
        let is_solution = |z: DVec2| (z.length() - 1.0).abs() > ON_CIRCLE;
        let inside = [Some(near), far].into_iter().flatten().find(|&z| is_solution(z) && z.length() < 1.0);
        let Some(inside) = inside.filter(|_| far.is_none_or(is_solution)) else {
            let [low, high] = self.ratio_limits();
            let reason =
                format!("expected a ratio between {low} and {high}, found {t}: all corners would be on a line");
            return Err(Error::new(Status::NoSolution, reason).at("ratio"));
        };
        let omega = self.angle_of(inside);
        Ok([omega, std::f64::consts::PI - omega])
    }

    /// The angle `ω` of a choice of center.
    ///
    /// # Errors
    /// A number that is not finite; as [`Corners::angles_of_ratio`]; `InvalidValue`: the point is not on the circle of
    /// centers within 1e-9 of its distance; `NoSolution`: it is on the given circle. The place is `center`, or `ratio`.
    pub fn angle(&self, center: Center) -> Result<f64> {
        let omega = match center {
            Center::Middle => self.default_angle(),
            Center::Angle(omega) => finite("center", omega)?,
            Center::Ratio { ratio, is_inside } => self.angles_of_ratio(ratio)?[usize::from(!is_inside)],
            Center::At(point) => {
                check_finite("center", &[point]).map_err(|error| error.with_place("center"))?;
                let z = in_plane(&self.circle, self.axes, point);
                let height = (point - self.circle.center).dot(self.circle.normal) / self.circle.radius;
                // The first-order distance: the gradient is 2 √(1 − q²) long on K.
                let value = self.q * (z.length_squared() + 1.0) - 2.0 * self.u.dot(z);
                let off = (0.5 * value / ((1.0 - self.q) * (1.0 + self.q)).sqrt()).hypot(height);
                if !(off <= COINCIDE * z.length().max(1.0)) {
                    let off = off * self.circle.radius;
                    let reason = format!("expected a point of the circle of centers, found one about {off:e} from it");
                    return Err(Error::new(Status::InvalidValue, reason).at("center"));
                }
                self.angle_of(z)
            }
        };
        let (x, w) = self.homogeneous(omega);
        if !((x.length() - w).abs() > ON_CIRCLE * w) {
            let reason = "expected a center off the given circle: it maps all corners to a line";
            return Err(Error::new(Status::NoSolution, reason).at("center"));
        }
        Ok(omega)
    }

    /// The two centers on the line `P1 P2`, inside the given circle and outside; `None` for infinity. Inversions there map the
    /// plane through this line that is orthogonal to the corners' plane to itself.
    ///
    /// With coordinates along the line, `P1` at 0, `P2` at `L` and `O` at `1/ε`, they are `L / (1 + √(1 − L ε))` and
    /// `(1 + √(1 − L ε)) / ε`.
    pub fn chord_centers(&self) -> (DVec3, Option<DVec3>) {
        let [z1, z2, ..] = self.z;
        let length = z1.distance(z2);
        let along = (z2 - z1) / length;
        let inverse = self.q / (self.u - self.q * z1).dot(along);
        let root = 1.0 + (1.0 - length * inverse).max(0.0).sqrt();
        let inside = self.in_space(z1 + length / root * along);
        let outside = (inverse.abs() * AT_INFINITY > root).then(|| self.in_space(z1 + root / inverse * along));
        (inside, outside)
    }

    /// The side of the circle of centers on which a point of the plane is, as a number from −2 to 2: 0 on it, above 0 on the
    /// side of `P1` and `P4`, below on that of `P2` and `P3`.
    pub(super) fn side(&self, point: DVec3) -> f64 {
        let z = in_plane(&self.circle, self.axes, point);
        let squared = z.length_squared() + 1.0;
        self.q - 2.0 * self.u.dot(z) / squared
    }

    fn default_angle(&self) -> f64 {
        // |C|² = (s² + g² c²) / (c² + g² s²).
        let g = self.g.abs();
        if g <= NO_LENGTH || g * DEFAULT_DISTANCE >= 1.0 {
            return std::f64::consts::PI;
        }
        // tan² ω/2 = (d² − g²) / (1 − d² g²).
        let d = DEFAULT_DISTANCE;
        2.0 * ((d - g) * (d + g) / ((1.0 - d * g) * (1.0 + d * g))).sqrt().atan()
    }

    /// `C(ω)` as `x / w`.
    fn homogeneous(&self, omega: f64) -> (DVec2, f64) {
        let (s, c) = (0.5 * omega).sin_cos();
        let (g, u, v) = (self.g, self.u, self.u.perp());
        let w = c.hypot(g * s);
        // At infinity, for g = 0, the direction does not matter.
        if w > 0.0 { ((g / w) * u + (1.0 - g) * (1.0 + g) * s * (c / w) * v, w) } else { (v, w) }
    }

    /// The inverse of `C(ω)`: `|C − g u|` is to `|g C − u|` as `|sin ω/2|` to `cos ω/2`, and `sin ω` has the sign of `C·v`.
    fn angle_of(&self, z: DVec2) -> f64 {
        let half = (z - self.g * self.u).length().atan2((self.g * z - self.u).length());
        if z.dot(self.u.perp()) < 0.0 { -2.0 * half } else { 2.0 * half }
    }

    fn in_space(&self, z: DVec2) -> DVec3 {
        self.circle.center + self.circle.radius * (z.x * self.axes[0] + z.y * self.axes[1])
    }
}

/// Coordinates in which the circle is the unit circle.
fn in_plane(circle: &Circle, axes: [DVec3; 2], point: DVec3) -> DVec2 {
    let offset = point - circle.center;
    DVec2::new(offset.dot(axes[0]), offset.dot(axes[1])) / circle.radius
}

/// The quotient of complex numbers; their product is [`DVec2::rotate`].
fn divide(a: DVec2, b: DVec2) -> DVec2 {
    DVec2::new(b.x, -b.y).rotate(a) / b.length_squared()
}

/// The square root of a complex number in the right half-plane.
fn square_root(z: DVec2) -> DVec2 {
    let length = z.length();
    // The part that does not cancel first.
    let root = (0.5 * (length + z.x.abs())).sqrt();
    match (root > 0.0, z.x >= 0.0) {
        (false, _) => DVec2::ZERO,
        (true, true) => DVec2::new(root, 0.5 * z.y / root),
        (true, false) => DVec2::new(0.5 * z.y.abs() / root, if z.y < 0.0 { -root } else { root }),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    use super::*;
    use crate::geometry::canal::inversion::Inversion;
    use crate::geometry::random::Random;

    /// Four points of a circle anywhere in space, at least `apart` radians from each other.
    fn on_circle(random: &mut Random, apart: f64) -> [DVec3; 4] {
        let normal = random.vector().normalize();
        let circle = Circle { center: random.vector(), normal, radius: random.between(0.2, 3.0) };
        loop {
            let mut angles: [f64; 4] = std::array::from_fn(|_| random.between(0.0, TAU));
            angles.sort_by(f64::total_cmp);
            let gaps = (0..4).map(|k| if k < 3 { angles[k + 1] - angles[k] } else { angles[0] + TAU - angles[3] });
            if gaps.fold(TAU, f64::min) > apart {
                return angles.map(|angle| circle.point_at(circle.center + DVec3::X, angle));
            }
        }
    }

    /// How far four points are from an isosceles trapezoid with parallel sides `P1 P2` and `P4 P3`, not counting what those on
    /// a line would lack; the ratio of the sides; and the height over the longer of them.
    fn trapezoid([p1, p2, p3, p4]: [DVec3; 4]) -> (f64, f64, f64) {
        let (first, second) = (p2 - p1, p3 - p4);
        let size = first.length().max(second.length());
        let parallel = first.normalize().distance(second.normalize());
        let legs = (p1.distance(p4) - p2.distance(p3)).abs() / size;
        let diagonals = (p1.distance(p3) - p2.distance(p4)).abs() / size;
        let height = (p4 - p1).reject_from_normalized(first.normalize()).length() / size;
        (parallel.max(legs).max(diagonals), first.length() / second.length(), height)
    }

    fn images(corners: [DVec3; 4], center: Option<DVec3>) -> [DVec3; 4] {
        center.map_or(corners, |center| {
            // P1 stays: from a far center, images with another ratio would be small and far away.
            let inversion = Inversion::new(center, center.distance_squared(corners[0])).unwrap();
            corners.map(|corner| inversion.point(corner))
        })
    }

    #[test]
    fn centers_for_a_ratio_map_to_isosceles_trapezoids_of_that_ratio() {
        let mut random = Random(21);
        let mut worst = [0.0_f64; 3];
        for _ in 0..500 {
            let points = on_circle(&mut random, 0.1);
            let corners = Corners::new(points).unwrap();
            let [low, high] = corners.ratio_limits();
            assert!(0.0 < low && low < high);
            let ratio = low * (high / low).powf(random.between(0.02, 0.98));
            let circle = corners.circle();
            let angles = corners.angles_of_ratio(ratio).unwrap();
            let [inside, outside] = angles.map(|omega| corners.center_at(omega).unwrap());
            assert!(inside.distance(circle.center) < circle.radius && outside.distance(circle.center) > circle.radius);
            for (omega, center) in angles.into_iter().zip([inside, outside]) {
                let (error, found, height) = trapezoid(images(points, Some(center)));
                worst[0] = worst[0].max(error);
                worst[1] = worst[1].max((found / ratio - 1.0).abs());
                worst[2] = worst[2].max((corners.ratio_at(omega) / ratio - 1.0).abs());
                assert!(height > 1e-4, "{height}");
            }
            // Mirror images in the given circle.
            let mirrored = Inversion::new(circle.center, circle.radius * circle.radius).unwrap().point(inside);
            assert!(mirrored.distance(outside) < 1e-9 * outside.distance(circle.center));
        }
        assert!(worst.iter().all(|&error| error < 1e-9), "{worst:?}");
    }

    #[test]
    fn the_printed_coefficient_has_the_other_sign() {
        // With B as printed, the roots of the equation are −C: the corrected equation holds for C, the printed one for −C.
        let mut random = Random(2);
        for _ in 0..50 {
            let corners = Corners::new(on_circle(&mut random, 0.2)).unwrap();
            let omega = random.between(-1.0, 1.0);
            let (x, w) = corners.homogeneous(omega);
            let (z, t) = (x / w, corners.ratio_at(omega));
            let [z1, z2, z3, z4] = corners.z;
            let a = z2 - z1 + t * (z4 - z3);
            let printed = -(1.0 + t) * z1.rotate(z3)
                + (t - 1.0) * z1.rotate(z4)
                + (1.0 + t) * z2.rotate(z4)
                + (1.0 - t) * z2.rotate(z3);
            let d = z3.rotate(z4).rotate(z2 - z1) + t * z1.rotate(z2).rotate(z4 - z3);
            let value = |z: DVec2| (a.rotate(z).rotate(z) + printed.rotate(z) + d).length();
            assert!(value(-z) < 1e-12 * (1.0 + t) && value(z) > 1e-3, "{} {}", value(-z), value(z));
        }
    }

    #[test]
    fn ratios_outside_the_interval_have_no_solution() {
        let mut random = Random(22);
        for _ in 0..200 {
            let corners = Corners::new(on_circle(&mut random, 0.1)).unwrap();
            let [low, high] = corners.ratio_limits();
            for ratio in [low * random.between(0.01, 0.999), high / random.between(0.01, 0.999), 0.0, -1.0, -high, 1e9]
            {
                let error = corners.angles_of_ratio(ratio).unwrap_err();
                assert_eq!((error.status(), error.place()), (Status::NoSolution, "ratio"), "{ratio} {low} {high}");
            }
            for ratio in [low, high] {
                assert_eq!(corners.angles_of_ratio(ratio).unwrap_err().status(), Status::NoSolution);
            }
            assert!(corners.angles_of_ratio(low * (1.0 + 1e-6)).is_ok());
            assert!(corners.angles_of_ratio(high / (1.0 + 1e-6)).is_ok());
        }
    }

    #[test]
    fn every_angle_is_a_point_of_the_circle_of_centers() {
        let mut random = Random(23);
        for _ in 0..200 {
            let points = on_circle(&mut random, 0.1);
            let corners = Corners::new(points).unwrap();
            let GeneralCircle::Circle(k) = corners.circle_of_centers() else { panic!("a line") };
            // By its definition: the inversion in it swaps P1 with P2, and P4 with P3.
            let swap = Inversion::new(k.center, k.radius * k.radius).unwrap();
            let scale = k.radius.max(1.0);
            assert!(swap.point(points[0]).distance(points[1]) < 1e-10 * scale);
            assert!(swap.point(points[3]).distance(points[2]) < 1e-10 * scale);
            let circle = corners.circle();
            for _ in 0..10 {
                let omega = random.between(-PI, PI);
                let center = corners.center_at(omega).unwrap();
                assert!(k.distance(center) < 1e-10 * scale);
                let is_inside = center.distance(circle.center) < circle.radius;
                assert_eq!(is_inside, omega.abs() < FRAC_PI_2);
                assert!((corners.angle(Center::At(center)).unwrap() - omega).abs() < 1e-9);
                let (ratio, twin) = (corners.ratio_at(omega), corners.ratio_at(PI - omega));
                assert!((ratio / twin - 1.0).abs() < 1e-12);
                if (omega.abs() - FRAC_PI_2).abs() > 0.05 {
                    let [inside, outside] = corners.angles_of_ratio(ratio).unwrap();
                    let found = if is_inside { inside } else { outside };
                    let turned = (found - omega + PI).rem_euclid(TAU) - PI;
                    assert!(turned.abs() < 1e-9, "{turned} {omega}");
                    let error = trapezoid(images(points, Some(center))).0;
                    assert!(error < 1e-9, "{error}");
                }
            }
            for omega in [FRAC_PI_2, -FRAC_PI_2] {
                let center = corners.center_at(omega).unwrap();
                assert!((center.distance(circle.center) - circle.radius).abs() < 1e-13 * circle.radius);
                assert_eq!(corners.angle(Center::Angle(omega)).unwrap_err().status(), Status::NoSolution);
                assert_eq!(corners.angle(Center::At(center)).unwrap_err().status(), Status::NoSolution);
            }
            let (inside, outside) = corners.chord_centers();
            for center in [inside, outside.unwrap()] {
                assert!(k.distance(center) < 1e-9 * scale);
                assert!((center - points[0]).cross(points[1] - points[0]).length() < 1e-10 * scale * scale);
            }
            assert!((inside - points[0]).dot(points[1] - inside) > 0.0);
            let middle = corners.angle(Center::Middle).unwrap();
            assert!(corners.center_at(middle).unwrap().distance(circle.center) < 100.1 * circle.radius);
        }
    }

    #[test]
    fn an_isosceles_trapezoid_has_a_line_of_centers() {
        // Sides of length 4 and 2: t = 2.
        let points = [(-2.0, 0.0), (2.0, 0.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 5.0));
        let corners = Corners::new(points).unwrap();
        let GeneralCircle::Line(point, direction) = corners.circle_of_centers() else { panic!("a circle") };
        assert!(point.x.abs() < 1e-15 && direction.cross(DVec3::Y).length() < 1e-15);
        let [inside, outside] = corners.angles_of_ratio(2.0).unwrap();
        assert!(inside.abs() < 1e-14 && (outside - PI).abs() < 1e-14);
        let circle = corners.circle();
        assert!(corners.center_at(inside).unwrap().distance(circle.center) < 1e-14);
        assert_eq!(corners.center_at(outside), None);
        assert_eq!(corners.angle(Center::Middle).unwrap(), PI);
        assert!((corners.ratio_at(PI) - 2.0).abs() < 1e-14);
        for omega in [-3.0, -2.0, -0.5, 0.3, 1.0, 2.5] {
            let center = corners.center_at(omega).unwrap();
            assert!(center.x.abs() < 1e-13 * center.length());
            let (error, ratio, _) = trapezoid(images(points, Some(center)));
            assert!(error < 1e-12 && (ratio / corners.ratio_at(omega) - 1.0).abs() < 1e-12);
        }
        let (inside, outside) = corners.chord_centers();
        assert!(inside.distance(DVec3::new(0.0, 0.0, 5.0)) < 1e-14 && outside.is_none());
        // Almost one: the middle would be 1e6 radii away; the default is not.
        let bent = circle.point_at(points[2], 4e-6);
        let corners = Corners::new([points[0], points[1], bent, points[3]]).unwrap();
        let far = corners.center_at(PI).unwrap().distance(circle.center) / circle.radius;
        let middle = corners.center_at(corners.angle(Center::Middle).unwrap()).unwrap();
        let near = middle.distance(circle.center) / circle.radius;
        assert!(far > 1e5 && (near - 100.0).abs() < 1e-3, "{far} {near}");
        assert!(trapezoid(images([points[0], points[1], bent, points[3]], Some(middle))).0 < 1e-11);
    }

    #[test]
    fn the_center_that_made_the_points_is_found_again() {
        // Trapezoids inverted at a known center: it is on the circle of centers, and a root for the trapezoid's ratio.
        let mut random = Random(24);
        let mut worst = 0.0_f64;
        for _ in 0..500 {
            let (bottom, top, height) = (random.between(0.5, 2.0), random.between(0.5, 2.0), random.between(0.4, 2.0));
            let trapezoid = [(-bottom, 0.0), (bottom, 0.0), (top, height), (-top, height)];
            let center = DVec3::new(0.0, random.between(-3.0, 3.0), 0.0);
            let inversion = Inversion::new(center, random.between(0.5, 4.0)).unwrap();
            let points = trapezoid.map(|(x, y)| inversion.point(DVec3::new(x, y, 0.0)));
            let Ok(corners) = Corners::new(points) else { continue };
            let circle = corners.circle();
            let distance = center.distance(circle.center) / circle.radius;
            if (distance - 1.0).abs() < 0.05 || distance > 50.0 {
                continue;
            }
            let angles = corners.angles_of_ratio(bottom / top).unwrap();
            let found = angles.map(|omega| corners.center_at(omega).map_or(f64::INFINITY, |c| c.distance(center)));
            worst = worst.max(found[0].min(found[1]) / circle.radius);
            assert!(
                (corners.angle(Center::At(center)).unwrap() - angles[usize::from(distance > 1.0)]).sin().abs() < 1e-8
            );
        }
        assert!(worst < 1e-9, "{worst}");
    }

    #[test]
    fn corners_and_choices_that_cannot_be_are_refused() {
        let good = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
        let refusal = |corners: [DVec3; 4]| {
            let error = Corners::new(corners).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        let named = |status, place: &str| (status, place.to_owned());
        let [a, b, c, d] = good;
        assert!(Corners::new(good).is_ok() && Corners::new([d, c, b, a]).is_ok());
        assert_eq!(refusal([a, c, b, d]), named(Status::InvalidValue, "corners"));
        assert_eq!(refusal([a, b, d, c]), named(Status::InvalidValue, "corners"));
        assert_eq!(refusal([a, b, b, d]), named(Status::Degenerate, "corners[2]"));
        assert_eq!(refusal([a, b, 1.001 * c, d]).0, Status::NotCircular);
        assert_eq!(refusal([a, b, c + 1e-3 * DVec3::Z, d]).0, Status::NotCircular);
        assert_eq!(refusal([0.0, 1.0, 2.0, 3.0].map(|x| x * DVec3::ONE)), named(Status::Degenerate, "corners"));
        assert_eq!(refusal([a, DVec3::NAN, c, d]), named(Status::InvalidValue, "corners[1]"));
        let corners = Corners::new([a, b, DVec3::new(-0.6, 0.8, 0.0), d]).unwrap();
        let refusal = |center| {
            let error = corners.angle(center).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        assert_eq!(refusal(Center::At(DVec3::new(0.3, 0.1, 0.0))), named(Status::InvalidValue, "center"));
        let lifted = corners.center_at(0.5).unwrap() + 1e-3 * DVec3::Z;
        assert_eq!(refusal(Center::At(lifted)), named(Status::InvalidValue, "center"));
        assert_eq!(refusal(Center::Angle(f64::NAN)), named(Status::InvalidValue, "center"));
        assert_eq!(refusal(Center::At(DVec3::NAN)), named(Status::InvalidValue, "center"));
        let ratio = Center::Ratio { ratio: f64::INFINITY, is_inside: true };
        assert_eq!(refusal(ratio), named(Status::InvalidValue, "ratio"));
    }
}
