//! Inversions: of points, of the complex plane, of circles and spheres.
//!
//! The inversion at `C` with the ratio `k` maps `M` to `M' = C + k (M − C) / ‖M − C‖²` (equation 1). It is its own inverse; a
//! composition of several is not (the paper says so of Möbius transformations in general; it holds for one inversion only).
//! A negative ratio adds a reflection through `C`. Source: Mesnil et al. 2018, section 2.3.

use glam::{DVec2, DVec3};

use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::{Circle, Sphere};

/// A point nearer to the center of inversion than this multiple of the points' extent is mapped to infinity: its image would
/// have lost all digits.
pub const AT_INFINITY: f64 = 1e-12;

/// Distance from the center of inversion, relative to the shape's own size, below which a circle or sphere runs through it.
const THROUGH_CENTER: f64 = 1e-12;

/// How many points are inverted side by side.
const LANES: usize = 4;

/// An inversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inversion {
    center: DVec3,
    ratio: f64,
}

/// A circle, or a straight line as the limit of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GeneralCircle {
    /// A circle.
    Circle(Circle),
    /// A line: its point nearest to the center of inversion, and a unit vector along it.
    Line(DVec3, DVec3),
}

/// A sphere, or a plane as the limit of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GeneralSphere {
    /// A sphere.
    Sphere(Sphere),
    /// A plane: its point nearest to the center of inversion, and a unit normal.
    Plane(DVec3, DVec3),
}

/// What is known of the squared distances of points from the center.
#[derive(Clone, Copy)]
struct Distances {
    nearest: f64,
    farthest: f64,
    /// NaN passes comparisons, but no sum.
    sum: f64,
}

impl Default for Distances {
    fn default() -> Self {
        Self { nearest: f64::INFINITY, farthest: 0.0, sum: 0.0 }
    }
}

impl Distances {
    #[inline]
    fn add(&mut self, squared: f64) {
        // Not `min` and `max`, which take longer to pass NaN over.
        self.nearest = if squared < self.nearest { squared } else { self.nearest };
        self.farthest = if squared > self.farthest { squared } else { self.farthest };
        self.sum += squared;
    }

    fn with(self, other: Self) -> Self {
        Self {
            nearest: self.nearest.min(other.nearest),
            farthest: self.farthest.max(other.farthest),
            sum: self.sum + other.sum,
        }
    }

    /// Whether all points are finite and none is at the center within the extent's round-off.
    fn are_good(self) -> bool {
        self.sum.is_finite() && self.farthest > 0.0 && self.nearest > AT_INFINITY * AT_INFINITY * self.farthest
    }
}

impl Inversion {
    /// The inversion at `center`, in model units, with a ratio in squared model units.
    ///
    /// # Errors
    /// A number that is not finite, or `ratio` 0.
    pub fn new(center: DVec3, ratio: f64) -> Result<Self> {
        if !center.is_finite() {
            let reason = format!("expected finite coordinates, found {center}");
            return Err(Error::new(Status::InvalidValue, reason).at("center"));
        }
        if finite("ratio", ratio)? == 0.0 {
            return Err(Error::new(Status::InvalidValue, "expected a ratio other than 0, found 0").at("ratio"));
        }
        Ok(Self { center, ratio })
    }

    /// The point that has no image.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The product of the distances of a point and of its image from the center.
    pub fn ratio(&self) -> f64 {
        self.ratio
    }

    /// The image of a point. The center itself has none: what comes back for it is not finite.
    #[inline]
    pub fn point(&self, point: DVec3) -> DVec3 {
        let q = point - self.center;
        self.center + (self.ratio / q.length_squared()) * q
    }

    /// The images of points, in their order.
    ///
    /// # Errors
    /// A coordinate that is not finite; status `Degenerate`: a point so near the center that its image is at infinity. The
    /// place is `points[i]`.
    pub fn points(&self, points: &[DVec3]) -> Result<Vec<DVec3>> {
        // One pass: what must be known of the distances is gathered beside the images, in lanes that do not wait for each other.
        let mut images = Vec::with_capacity(points.len());
        let mut distances = [Distances::default(); LANES];
        let (chunks, rest) = points.as_chunks::<LANES>();
        for chunk in chunks {
            let q = chunk.map(|point| point - self.center);
            let squared = q.map(DVec3::length_squared);
            let factor = squared.map(|squared| self.ratio / squared);
            images.extend_from_slice(&std::array::from_fn::<_, LANES, _>(|lane| self.center + factor[lane] * q[lane]));
            distances.iter_mut().zip(squared).for_each(|(lane, squared)| lane.add(squared));
        }
        for &point in rest {
            let q = point - self.center;
            images.push(self.center + (self.ratio / q.length_squared()) * q);
            distances[0].add(q.length_squared());
        }
        let all = distances.into_iter().fold(Distances::default(), Distances::with);
        if points.is_empty() || all.are_good() { Ok(images) } else { Err(self.refusal(points)) }
    }

    fn refusal(&self, points: &[DVec3]) -> Error {
        if let Err(error) = crate::mesh::grid::check_finite("points", points) {
            return error;
        }
        let squared = |point: &DVec3| point.distance_squared(self.center);
        let at = (0..points.len()).min_by(|&i, &j| squared(&points[i]).total_cmp(&squared(&points[j]))).unwrap_or(0);
        let distance = points.get(at).map_or(0.0, |point| point.distance(self.center));
        let reason = format!("its image is at infinity: it is {distance} from the center of inversion");
        Error::new(Status::Degenerate, reason).at(format!("points[{at}]"))
    }

    /// The image of a direction at `point`, not normalised: the derivative `k/q² (I − 2 q̂ q̂ᵀ)`. It keeps angles. With
    /// a positive ratio it turns orientation round: images of a right-handed frame are left-handed.
    pub fn direction(&self, point: DVec3, direction: DVec3) -> DVec3 {
        let q = point - self.center;
        let squared = q.length_squared();
        (self.ratio / squared) * (direction - (2.0 * direction.dot(q) / squared) * q)
    }

    /// The image of a sphere: with `s = ‖c − C‖² − r²` the sphere about `C + (k/s)(c − C)` of radius `|k| r/|s|`; for `s = 0`
    /// the plane orthogonal to `c − C` at the distance `k / 2‖c − C‖`.
    pub fn sphere(&self, sphere: &Sphere) -> GeneralSphere {
        let offset = sphere.center - self.center;
        let distance = offset.length();
        let s = (distance - sphere.radius) * (distance + sphere.radius);
        if (distance - sphere.radius).abs() <= THROUGH_CENTER * sphere.radius {
            let normal = offset / distance;
            return GeneralSphere::Plane(self.center + self.ratio / (2.0 * distance) * normal, normal);
        }
        let center = self.center + (self.ratio / s) * offset;
        GeneralSphere::Sphere(Sphere { center, radius: (self.ratio * sphere.radius / s).abs() })
    }

    /// The image of the plane through `point` with the unit vector `normal`: with `h` its signed distance from `C`, the sphere
    /// about `C + k n / 2h` of radius `|k / 2h|`; a plane through `C` is its own image.
    pub fn plane(&self, point: DVec3, normal: DVec3) -> GeneralSphere {
        let h = (point - self.center).dot(normal);
        if h.abs() <= THROUGH_CENTER * point.distance(self.center) {
            return GeneralSphere::Plane(self.center, normal);
        }
        let center = self.center + self.ratio / (2.0 * h) * normal;
        GeneralSphere::Sphere(Sphere { center, radius: (self.ratio / (2.0 * h)).abs() })
    }

    /// The image of a circle.
    ///
    /// In the plane through `C` and the circle's axis the circle has two points, `c ± r e`, that are nearest to and farthest
    /// from `C`; the image is symmetric to that plane too, so the images of the two are ends of a diameter.
    pub fn circle(&self, circle: &Circle) -> GeneralCircle {
        let q = circle.center - self.center;
        let height = q.dot(circle.normal);
        let across = q - height * circle.normal;
        let distance = across.length();
        let from_center = (distance - circle.radius).hypot(height);
        // Away from C in the circle's plane; any direction on the axis.
        let outward = if distance > THROUGH_CENTER * circle.radius {
            across / distance
        } else {
            circle.normal.any_orthonormal_vector()
        };
        let (near, far) = (circle.center - circle.radius * outward, circle.center + circle.radius * outward);
        if from_center <= THROUGH_CENTER * circle.radius {
            return GeneralCircle::Line(self.point(far), circle.normal.cross(outward));
        }
        let (a, b) = (self.point(near), self.point(far));
        // The tangent at both points, orthogonal to the plane of symmetry.
        let tangent = circle.normal.cross(outward);
        let center = 0.5 * (a + b);
        GeneralCircle::Circle(Circle { center, normal: tangent.cross(a - b).normalize(), radius: 0.5 * a.distance(b) })
    }
}

/// The same in the complex plane, where `z` is `(re z, im z)`: `z' = z_C + k / (conj z − conj z_C)` (equation 2), the inversion
/// of the plane as a part of space.
pub fn invert_complex(z: DVec2, center: DVec2, ratio: f64) -> DVec2 {
    let q = z - center;
    center + (ratio / q.length_squared()) * q
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::Random;

    #[test]
    fn an_inversion_undoes_itself() {
        let mut random = Random(11);
        for ratio in [2.3, -0.7] {
            let inversion = Inversion::new(DVec3::new(0.3, -0.4, 0.2), ratio).unwrap();
            let points: Vec<DVec3> = (0..1000).map(|_| random.vector()).collect();
            let diagonal = crate::mesh::grid::diagonal(&points);
            let far: Vec<DVec3> =
                points.into_iter().filter(|p| p.distance(inversion.center()) >= 1e-3 * diagonal).collect();
            let back = inversion.points(&inversion.points(&far).unwrap()).unwrap();
            let worst = far.iter().zip(&back).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(worst < 1e-13 * diagonal, "{worst}");
        }
    }

    #[test]
    fn circles_and_spheres_go_to_circles_and_spheres() {
        let mut random = Random(3);
        for _ in 0..200 {
            let inversion = Inversion::new(random.vector(), random.between(0.0, 2.0)).unwrap();
            let normal = random.vector().normalize();
            let circle = Circle { center: random.vector(), normal, radius: 0.2 + random.between(-1.0, 1.0).abs() };
            let GeneralCircle::Circle(image) = inversion.circle(&circle) else { panic!("a line") };
            for i in 0..50 {
                let point = inversion.point(circle.point_at(DVec3::X, f64::from(i)));
                let error = image.distance(point) / image.radius.max(point.distance(inversion.center()));
                assert!(error < 1e-11, "{error}");
            }
            let sphere = Sphere { center: circle.center, radius: circle.radius };
            let GeneralSphere::Sphere(image) = inversion.sphere(&sphere) else { panic!("a plane") };
            let point = inversion.point(sphere.center + sphere.radius * random.vector().normalize());
            assert!(image.distance(point).abs() < 1e-11 * image.radius.max(1.0));
        }
    }

    #[test]
    fn what_runs_through_the_center_becomes_straight_and_back() {
        let inversion = Inversion::new(DVec3::new(1.0, 2.0, 3.0), 1.5).unwrap();
        let sphere = Sphere { center: DVec3::new(1.0, 2.0, 5.0), radius: 2.0 };
        let GeneralSphere::Plane(point, normal) = inversion.sphere(&sphere) else { panic!("a sphere") };
        assert!(point.distance(DVec3::new(1.0, 2.0, 3.375)) < 1e-15 && normal == DVec3::Z);
        let GeneralSphere::Sphere(back) = inversion.plane(point, normal) else { panic!("a plane") };
        assert!(back.center.distance(sphere.center) < 1e-14 && (back.radius - 2.0).abs() < 1e-14);
        assert!(matches!(inversion.plane(inversion.center() + DVec3::X, DVec3::Z), GeneralSphere::Plane(_, DVec3::Z)));
        let circle = Circle { center: DVec3::new(1.0, 4.0, 3.0), normal: DVec3::Z, radius: 2.0 };
        let GeneralCircle::Line(point, direction) = inversion.circle(&circle) else { panic!("a circle") };
        let image = inversion.point(circle.point_at(DVec3::X, 0.3));
        assert!((image - point).cross(direction).length() < 1e-14);
    }

    #[test]
    fn angles_are_kept_and_orientation_is_turned_round() {
        let mut random = Random(7);
        for _ in 0..100 {
            let inversion = Inversion::new(random.vector(), random.between(-1.0, 1.0)).unwrap();
            let [point, a, b, c] = std::array::from_fn(|_| random.vector());
            let [x, y, z] = [a, b, c].map(|direction| inversion.direction(point, direction));
            assert!((a.angle_between(b) - x.angle_between(y)).abs() < 1e-9);
            assert!(a.dot(b.cross(c)) * x.dot(y.cross(z)) * inversion.ratio() < 0.0);
            // The derivative is what the difference quotient tends to.
            let h = 1e-6;
            let quotient = (inversion.point(point + h * a) - inversion.point(point - h * a)) / (2.0 * h);
            assert!(quotient.distance(x) < 1e-4 * x.length().max(1.0));
        }
    }

    #[test]
    fn the_plane_is_inverted_as_a_part_of_space() {
        let (z, center) = (DVec2::new(0.3, 1.2), DVec2::new(-0.4, 0.5));
        let spatial = Inversion::new(center.extend(0.0), -1.7).unwrap().point(z.extend(0.0));
        assert!(invert_complex(z, center, -1.7).extend(0.0).distance(spatial) < 1e-15);
    }

    #[test]
    fn points_without_an_image_are_named() {
        assert!(Inversion::new(DVec3::ZERO, 0.0).unwrap_err().to_string().starts_with("ratio: expected a ratio other"));
        assert!(Inversion::new(DVec3::NAN, 1.0).is_err() && Inversion::new(DVec3::ZERO, f64::INFINITY).is_err());
        let inversion = Inversion::new(DVec3::X, 1.0).unwrap();
        let error = inversion.points(&[DVec3::Y, DVec3::X, DVec3::Z]).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::Degenerate, "points[1]"));
        assert_eq!(inversion.points(&[DVec3::X]).unwrap_err().status(), Status::Degenerate);
        let error = inversion.points(&[DVec3::Y, DVec3::NAN]).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::InvalidValue, "points[1]"));
        assert_eq!(inversion.points(&[]).unwrap(), []);
    }
}
