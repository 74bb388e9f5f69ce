//! The surface that a snake moves on: a mesh, or one of those that a few numbers tell.

use std::f64::consts::FRAC_PI_2;

use glam::{DMat3, DVec3};

use crate::error::{Error, Result, Status, finite};
use crate::geometry::snakes::curvature_curve::{Course, CurvatureCurve, Options, Side, curvature_curve};
use crate::geometry::snakes::mesh_curve::mesh_curve;
use crate::linalg::small::any_orthogonal;
use crate::mesh::reference::{ReferenceMesh, SurfaceFoot, SurfaceJet};
use crate::mesh::surfaces::{cylinder, torus};
use crate::mesh::{ReferenceSurface, TriangleMesh};

/// A curve of a smaller circle on a sphere, as an angle from the sphere's centre, does not come near the pole of an equator along it.
const SMALL_CIRCLE: f64 = 0.6;

/// A surface with a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceKind {
    /// A point and the normal: 6 numbers.
    Plane,
    /// The centre and the radius: 4 numbers.
    Sphere,
    /// A point of the axis, its direction, the radius: 7 numbers.
    Cylinder,
    /// The centre, the direction of the axis, the distance of the tube's middle from it, the radius of the tube, which is smaller: 8
    /// numbers.
    Torus,
}

impl SurfaceKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Plane, Self::Sphere, Self::Cylinder, Self::Torus];

    fn number_count(self) -> usize {
        match self {
            Self::Plane => 6,
            Self::Sphere => 4,
            Self::Cylinder => 7,
            Self::Torus => 8,
        }
    }
}

/// A plane, sphere, cylinder or torus. Normals point outward, that of a plane as given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedSurface {
    kind: SurfaceKind,
    origin: DVec3,
    /// Its own axes as columns, the last one along the normal or the axis.
    axes: DMat3,
    /// The radius; of a torus the distance of the tube's middle from the axis.
    radius: f64,
    /// The radius of the tube.
    tube: f64,
}

impl NamedSurface {
    /// The surface of a kind that numbers tell, see [`SurfaceKind`].
    ///
    /// # Errors
    /// Another count of numbers, numbers that are not finite, a direction of no length, radii that are not above 0, a tube that
    /// reaches the axis (`numbers`, `numbers[k]`).
    pub fn new(kind: SurfaceKind, numbers: &[f64]) -> Result<Self> {
        let expected = kind.number_count();
        if numbers.len() != expected {
            let reason = format!("expected {expected} of a {kind:?}, found {}", numbers.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("numbers"));
        }
        for (k, &number) in numbers.iter().enumerate() {
            finite(&format!("numbers[{k}]"), number)?;
        }
        let refused =
            |k: usize, reason: String| Err(Error::new(Status::InvalidValue, reason).at(format!("numbers[{k}]")));
        let mut axis = DVec3::Z;
        if kind != SurfaceKind::Sphere {
            match DVec3::from_slice(&numbers[3..]).try_normalize() {
                Some(found) => axis = found,
                None => return refused(3, "expected a direction of finite length above 0".into()),
            }
        }
        let radii = if kind == SurfaceKind::Sphere { 3.. } else { 6.. };
        for k in radii.take_while(|&k| k < expected).filter(|_| kind != SurfaceKind::Plane) {
            if !(numbers[k] > 0.0) {
                return refused(k, format!("expected a radius above 0, found {}", numbers[k]));
            }
        }
        let (radius, tube) = match kind {
            SurfaceKind::Plane => (0.0, 0.0),
            SurfaceKind::Sphere => (numbers[3], 0.0),
            SurfaceKind::Cylinder => (numbers[6], 0.0),
            SurfaceKind::Torus => (numbers[6], numbers[7]),
        };
        if kind == SurfaceKind::Torus && tube >= radius {
            return refused(7, format!("expected a radius below {radius}, found {tube}"));
        }
        Ok(Self { kind, origin: DVec3::from_slice(numbers), axes: with_last(axis), radius, tube })
    }

    fn local(&self, point: DVec3) -> DVec3 {
        self.axes.transpose() * (point - self.origin)
    }

    /// The foot of a point and the normal there, in the surface's own axes.
    fn foot(&self, at: DVec3) -> (DVec3, DVec3) {
        // Where all directions are as near as each other, one of them.
        let out = DVec3::new(at.x, at.y, 0.0).try_normalize().unwrap_or(DVec3::X);
        match self.kind {
            SurfaceKind::Plane => (DVec3::new(at.x, at.y, 0.0), DVec3::Z),
            SurfaceKind::Sphere => {
                let out = at.try_normalize().unwrap_or(DVec3::Z);
                (self.radius * out, out)
            }
            SurfaceKind::Cylinder => (self.radius * out + at.z * DVec3::Z, out),
            SurfaceKind::Torus => {
                let middle = self.radius * out;
                let normal = (at - middle).try_normalize().unwrap_or(out);
                (middle + self.tube * normal, normal)
            }
        }
    }

    fn parameters(&self, point: DVec3) -> [f64; 2] {
        let at = self.local(point);
        let (angle, out) = (at.y.atan2(at.x), at.x.hypot(at.y));
        match self.kind {
            SurfaceKind::Plane => [at.x, at.y],
            SurfaceKind::Sphere => [angle, at.z.atan2(out)],
            SurfaceKind::Cylinder => [angle, at.z],
            SurfaceKind::Torus => [angle, at.z.atan2(out - self.radius)],
        }
    }

    fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        let jet = match self.kind {
            SurfaceKind::Plane => {
                SurfaceJet { point: DVec3::new(u, v, 0.0), first: [DVec3::X, DVec3::Y], second: [DVec3::ZERO; 3] }
            }
            SurfaceKind::Sphere => torus(0.0, self.radius)(u, v),
            SurfaceKind::Cylinder => cylinder(self.radius)(u, v),
            SurfaceKind::Torus => torus(self.radius, self.tube)(u, v),
        };
        SurfaceJet {
            point: self.origin + self.axes * jet.point,
            first: jet.first.map(|first| self.axes * first),
            second: jet.second.map(|second| self.axes * second),
        }
    }

    /// The same surface with axes for a curve. Longitude and latitude are none at the poles of a sphere: they are put where a curve of
    /// the curvature at the start would not come, in the middle of its circle or, if that is small, in that of an equator.
    fn for_curve(&self, start: DVec3, tangent: DVec3, course: &Course<'_>) -> Self {
        let out = self.foot(self.local(start)).1;
        let out = self.axes * out;
        let along = tangent.reject_from_normalized(out).try_normalize();
        let (SurfaceKind::Sphere, Some(along)) = (self.kind, along) else { return *self };
        let angle = (1.0 / ((course.curvature)(0.0) * self.radius)).min(1.0).asin();
        let angle = if angle > SMALL_CIRCLE { angle } else { FRAC_PI_2 };
        let left = out.cross(along);
        let side = if course.side == Side::Left { left } else { -left };
        Self { axes: with_last(angle.cos() * out + angle.sin() * side), ..*self }
    }
}

/// Right-handed axes with this unit vector last.
fn with_last(axis: DVec3) -> DMat3 {
    let first = any_orthogonal(axis).normalize();
    DMat3::from_cols(first, axis.cross(first), axis)
}

impl ReferenceSurface for NamedSurface {
    fn nearest(&self, point: DVec3) -> SurfaceFoot {
        let (foot, normal) = self.foot(self.local(point));
        SurfaceFoot { point: self.origin + self.axes * foot, normal: self.axes * normal, overhang: 0.0 }
    }

    fn diagonal(&self) -> f64 {
        match self.kind {
            SurfaceKind::Plane | SurfaceKind::Cylinder => f64::INFINITY,
            SurfaceKind::Sphere => 12.0_f64.sqrt() * self.radius,
            SurfaceKind::Torus => (8.0 * (self.radius + self.tube).powi(2) + 4.0 * self.tube.powi(2)).sqrt(),
        }
    }
}

/// What a snake moves on.
#[derive(Clone, Debug)]
pub enum Surface {
    /// A mesh.
    Mesh(TriangleMesh),
    /// One with a name.
    Named(NamedSurface),
}

impl Surface {
    /// Calls `call` with the surface ready to be asked.
    pub fn with<T>(&self, call: impl FnOnce(&dyn ReferenceSurface) -> T) -> T {
        match self {
            Self::Mesh(mesh) => call(&ReferenceMesh::new(mesh)),
            Self::Named(surface) => call(surface),
        }
    }

    /// The curve of given curvature that begins at the nearest point to `start`, in the direction of `tangent`.
    ///
    /// # Errors
    /// As [`mesh_curve`] or [`curvature_curve`].
    pub fn curve(
        &self,
        start: DVec3,
        tangent: DVec3,
        course: &Course<'_>,
        options: &Options,
    ) -> Result<CurvatureCurve> {
        match self {
            Self::Mesh(mesh) => Ok(mesh_curve(&ReferenceMesh::new(mesh), start, tangent, course, options)?.curve),
            Self::Named(surface) => {
                if !start.is_finite() {
                    let reason = format!("expected finite numbers, found {start}");
                    return Err(Error::new(Status::InvalidValue, reason).at("start"));
                }
                let surface = surface.for_curve(start, tangent, course);
                let everywhere = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
                let (function, at) = (|u: f64, v: f64| surface.jet(u, v), surface.parameters(start));
                curvature_curve(&function, everywhere, at, tangent, course, options)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::Random;

    fn all() -> Vec<NamedSurface> {
        let (at, axis) = ([0.3, -0.2, 0.7], [0.4, 1.0, -0.5]);
        let numbers = |radii: &[f64]| [&at[..], &axis, radii].concat();
        let made = |kind, numbers: &[f64]| NamedSurface::new(kind, numbers).unwrap();
        vec![
            made(SurfaceKind::Plane, &numbers(&[])),
            made(SurfaceKind::Sphere, &[0.3, -0.2, 0.7, 1.4]),
            made(SurfaceKind::Cylinder, &numbers(&[1.2])),
            made(SurfaceKind::Torus, &numbers(&[2.0, 0.7])),
        ]
    }

    #[test]
    fn nearest_points_are_those_of_parameters_and_at_right_angles() {
        let mut random = Random(3);
        for surface in all() {
            for _ in 0..50 {
                let point = 3.0 * random.vector();
                let foot = surface.nearest(point);
                let [u, v] = surface.parameters(point);
                let jet = surface.jet(u, v);
                assert!(jet.point.distance(foot.point) < 1e-13 && jet.normal().distance(foot.normal) < 1e-12);
                assert!((point - foot.point).cross(foot.normal).length() < 1e-13);
                // No other point is nearer.
                let [a, b] = [random.between(-3.0, 3.0), random.between(-3.0, 3.0)];
                assert!(surface.jet(u + a, v + b).point.distance(point) >= foot.point.distance(point) - 1e-13);
            }
        }
        // The normal points outward.
        let sphere = all()[1];
        assert!(sphere.nearest(sphere.origin + DVec3::X).normal.distance(DVec3::X) < 1e-15);
    }

    #[test]
    fn curves_of_constant_curvature_on_a_sphere_are_circles() {
        let sphere = NamedSurface::new(SurfaceKind::Sphere, &[1.0, 0.0, 0.0, 2.0]).unwrap();
        let (start, tangent) = (DVec3::new(1.0, 0.0, 2.0), DVec3::new(0.3, 0.8, 0.1));
        for curvature in [0.5, 0.7, 0.5 * 2.0_f64.sqrt(), 0.9, 3.0] {
            for side in [Side::Left, Side::Right] {
                let length = std::f64::consts::TAU / curvature;
                let course = Course { curvature: &|_| curvature, length, side };
                let options = Options { steps: 400, ..Options::default() };
                let found = Surface::Named(sphere).curve(start, tangent, &course, &options).unwrap();
                assert_eq!(found.points.len(), 401);
                // Closed, on the sphere, and as far across as a circle of that curvature.
                assert!(found.points[400].distance(start) < 1e-6, "{}", found.points[400].distance(start));
                assert!(found.points.iter().all(|p| (p.distance(DVec3::X) - 2.0).abs() < 1e-12));
                assert!((found.points[200].distance(start) - 2.0 / curvature).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn surfaces_that_are_none_are_refused() {
        let refused = |kind, numbers: &[f64]| NamedSurface::new(kind, numbers).unwrap_err().place().to_owned();
        assert_eq!(refused(SurfaceKind::Plane, &[0.0; 5]), "numbers");
        assert_eq!(refused(SurfaceKind::Plane, &[0.0; 6]), "numbers[3]");
        assert_eq!(refused(SurfaceKind::Sphere, &[0.0, f64::NAN, 0.0, 1.0]), "numbers[1]");
        assert_eq!(refused(SurfaceKind::Sphere, &[0.0, 0.0, 0.0, -1.0]), "numbers[3]");
        assert_eq!(refused(SurfaceKind::Cylinder, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]), "numbers[6]");
        assert_eq!(refused(SurfaceKind::Torus, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]), "numbers[7]");
    }
}
