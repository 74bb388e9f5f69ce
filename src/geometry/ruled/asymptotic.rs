//! The two asymptotic directions at each point of a mesh, told apart.
//!
//! With principal curvatures `κ1 > 0 > κ2` and principal directions `p1`, `p2 = n × p1` the second fundamental form vanishes along
//!
//! ```text
//! d = (√−κ2 p1 ± √κ1 p2) / √(κ1 − κ2).
//! ```
//!
//! The geodesic torsion `II(d, n × d)` there is `∓√(κ1 (−κ2)) = ∓√−K` (Beltrami and Enneper: it is the torsion of the asymptotic
//! curve), and does not change under `d → −d` or `n → −n`. So its sign tells the two families apart at each point by itself: no
//! search over the mesh is needed where Flöry et al. 2012, section 2.1, compare neighbours, and a family is the same whichever way
//! faces are oriented. Along family 0 the torsion is negative: going along, the tangent plane turns like a left-handed screw; along
//! family 1 like a right-handed one.
//!
//! Where `K ≥ 0` the surface has no asymptotic direction, and none is made up: such points are masked.

use glam::DVec3;

use crate::error::{Error, Result, Status};
use crate::mesh::TriangleMesh;
use crate::mesh::curvature::{self, Curvature, Fit, curvatures};

/// Round-off of coordinates in heights over a tangent plane, as a multiple of the largest coordinate: a few units in the last place,
/// times what the fit makes of them.
const HEIGHT_NOISE: f64 = 1e-13;

/// What counts as negatively curved, and how much must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How curvatures are found.
    pub curvature: curvature::Options,
    /// Points where the Gaussian curvature is not below minus this times the square of the greatest principal curvature of the mesh
    /// are masked: their directions are all but one, and turn with the least noise. From 0 to 1.
    pub flatness: f64,
    /// The part of the points that may be masked, from 0 to 1. Never all.
    pub max_mask: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { curvature: curvature::Options::default(), flatness: 1e-6, max_mask: 0.05 }
    }
}

/// What was found at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointStatus {
    /// Two asymptotic directions.
    Good,
    /// The surface is flat or positively curved there: it has none.
    NotNegative,
    /// Its neighbours do not determine curvatures.
    NotFitted,
}

/// The asymptotic directions at the points of a mesh.
#[derive(Clone, Debug)]
pub struct AsymptoticDirections {
    families: [Vec<DVec3>; 2],
    curvatures: Vec<Curvature>,
    status: Vec<PointStatus>,
}

impl AsymptoticDirections {
    /// Finds them.
    ///
    /// # Errors
    /// An option out of its range (`flatness`, `max_mask`, `curvature.least_neighbours`). Status `CurvatureSign`: more points are
    /// masked than `max_mask` allows, or all (`mesh`).
    pub fn new(mesh: &TriangleMesh, options: &Options) -> Result<Self> {
        for (name, value) in [("flatness", options.flatness), ("max_mask", options.max_mask)] {
            if !(0.0..=1.0).contains(&value) {
                let reason = format!("expected a number from 0 to 1, found {value}");
                return Err(Error::new(Status::InvalidValue, reason).at(name));
            }
        }
        let curvatures = curvatures(mesh, &options.curvature).map_err(|error| error.at("curvature"))?;
        let status = statuses(mesh, &curvatures, options.flatness);
        check_mask(&status, options.max_mask)?;
        let families = [-1.0, 1.0].map(|torsion| {
            curvatures.iter().zip(&status).map(|(curvature, status)| direction(curvature, *status, torsion)).collect()
        });
        Ok(Self { families, curvatures, status })
    }

    /// The unit directions of a family at the points, each with any sign; 0 where masked.
    ///
    /// # Errors
    /// `family` is not 0 or 1.
    pub fn family(&self, family: usize) -> Result<&[DVec3]> {
        let reason = || format!("expected 0 or 1, found {family}");
        let found = self.families.get(family);
        found.map(Vec::as_slice).ok_or_else(|| Error::new(Status::IndexOutOfRange, reason()).at("family"))
    }

    /// Curvatures and the normals that go with the directions: of higher order in the edges than those of the mesh.
    pub fn curvatures(&self) -> &[Curvature] {
        &self.curvatures
    }

    /// What was found at each point.
    pub fn status(&self) -> &[PointStatus] {
        &self.status
    }

    /// How many points have no directions.
    pub fn masked_count(&self) -> usize {
        self.status.iter().filter(|status| **status != PointStatus::Good).count()
    }
}

fn statuses(mesh: &TriangleMesh, curvatures: &[Curvature], flatness: f64) -> Vec<PointStatus> {
    let greatest = curvatures.iter().flat_map(|c| c.principal).fold(0.0_f64, |most, k| most.max(k.abs()));
    // Of a plane the curvatures are round-off, and nothing compares to them.
    let coordinate = mesh.points().iter().fold(0.0_f64, |most, p| most.max(p.abs().max_element()));
    let noise = HEIGHT_NOISE * coordinate / mesh.mean_edge().powi(2);
    let least = (flatness * greatest * greatest).max(noise * noise);
    let status = |c: &Curvature| match c.fit {
        Fit::Degenerate => PointStatus::NotFitted,
        _ if c.gaussian() < -least => PointStatus::Good,
        _ => PointStatus::NotNegative,
    };
    curvatures.iter().map(status).collect()
}

fn check_mask(status: &[PointStatus], max_mask: f64) -> Result<()> {
    let count = |kind: PointStatus| status.iter().filter(|status| **status == kind).count();
    let (not_negative, not_fitted) = (count(PointStatus::NotNegative), count(PointStatus::NotFitted));
    let masked = not_negative + not_fitted;
    if masked < status.len() && masked as f64 <= max_mask * status.len() as f64 {
        return Ok(());
    }
    let reason = format!(
        "expected a negatively curved surface, found {not_negative} of {} points where it is not, and {not_fitted} without \
         neighbours enough to tell; at most {max_mask} of all may be so",
        status.len()
    );
    Err(Error::new(Status::CurvatureSign, reason).at("mesh"))
}

fn direction(curvature: &Curvature, status: PointStatus, torsion: f64) -> DVec3 {
    if status != PointStatus::Good {
        return DVec3::ZERO;
    }
    let ([first, second], [p1, p2]) = (curvature.principal, curvature.directions);
    ((-second).sqrt() * p1 - torsion * first.sqrt() * p2).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::mesh::patterns::{height_field, parametric_surface};

    fn find(mesh: &Mesh) -> Result<(TriangleMesh, AsymptoticDirections)> {
        let mesh = TriangleMesh::new(mesh)?;
        let found = AsymptoticDirections::new(&mesh, &Options::default())?;
        Ok((mesh, found))
    }

    /// The largest sine of an angle between a direction and the exact line of its family, over the points inside and over those on
    /// the boundary.
    fn worst(mesh: &Mesh, exact: impl Fn(usize, DVec3) -> [DVec3; 2]) -> [f64; 2] {
        let (mesh, found) = find(mesh).unwrap();
        assert_eq!(found.masked_count(), 0);
        let mut worst = [0.0_f64; 2];
        for (i, &p) in mesh.points().iter().enumerate() {
            let on_boundary = usize::from(mesh.is_on_boundary(i));
            for (family, exact) in exact(i, p).into_iter().enumerate() {
                let sine = found.family(family).unwrap()[i].cross(exact.normalize()).length();
                worst[on_boundary] = worst[on_boundary].max(sine);
            }
        }
        worst
    }

    fn saddle(n: usize) -> Mesh {
        height_field(n, n, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap()
    }

    fn helicoid(n: usize) -> Mesh {
        let point = |u: f64, v: f64| DVec3::new(u * v.cos(), u * v.sin(), 0.8 * v);
        parametric_surface(n, n, [-1.0, 1.0], [-1.0, 1.0], point).unwrap()
    }

    fn catenoid(n: usize) -> Mesh {
        let point = |u: f64, v: f64| DVec3::new(u.cosh() * v.cos(), u.cosh() * v.sin(), u);
        parametric_surface(n, n, [-0.8, 0.8], [0.0, 1.6], point).unwrap()
    }

    /// Part of `x² + y² − z² = 1`.
    fn hyperboloid(n: usize) -> Mesh {
        let point = |v: f64, z: f64| {
            let r = (1.0 + z * z).sqrt();
            DVec3::new(r * v.cos(), r * v.sin(), z)
        };
        parametric_surface(n, n, [0.0, 1.6], [-0.8, 0.8], point).unwrap()
    }

    fn orders(mesh: fn(usize) -> Mesh, exact: impl Fn(usize, usize, DVec3) -> [DVec3; 2]) -> [[f64; 2]; 3] {
        [11, 21, 41].map(|n| worst(&mesh(n), |i, p| exact(n, i, p)))
    }

    #[test]
    fn the_saddle_has_its_rulings() {
        // At the middle, with the normal upward, II(e1, n × e1) = II(e1, e2) = 1 and II(e2, n × e2) = −1.
        let errors = orders(saddle, |_, _, p| [DVec3::new(0.0, 1.0, p.x), DVec3::new(1.0, 0.0, p.y)]);
        println!("T-R1 {errors:?}");
    }

    #[test]
    fn the_helicoid_has_its_rulings_and_its_helices() {
        let errors = orders(helicoid, |_, _, p| {
            let (sine, cosine) = (p.z / 0.8).sin_cos();
            let u = p.x * cosine + p.y * sine;
            [DVec3::new(cosine, sine, 0.0), DVec3::new(-u * sine, u * cosine, 0.8)]
        });
        println!("T-R2 {errors:?}");
    }

    #[test]
    fn the_catenoid_has_its_diagonals() {
        // The first fundamental form is cosh²u (du² + dv²), the second −du² + dv²: x_u ± x_v.
        let errors = orders(catenoid, |_, _, p| {
            let u = p.z;
            let (sine, cosine) = (p.y / u.cosh(), p.x / u.cosh());
            let x_u = DVec3::new(u.sinh() * cosine, u.sinh() * sine, 1.0);
            let x_v = DVec3::new(-u.cosh() * sine, u.cosh() * cosine, 0.0);
            [x_u - x_v, x_u + x_v]
        });
        println!("T-R3 {errors:?}");
        let (_, found) = find(&catenoid(41)).unwrap();
        let dots = (0..found.status().len()).map(|i| found.families[0][i].dot(found.families[1][i]).abs());
        println!("T-R3 dot {}", dots.fold(0.0, f64::max));
    }

    #[test]
    fn the_hyperboloid_has_its_two_families_of_lines() {
        let errors = orders(hyperboloid, |_, _, p| {
            // (a, b, 1) with a² + b² = 1 and x a + y b = z: with r² = x² + y² = 1 + z² it is (x z ∓ y, y z ± x)/r².
            let line = |sign: f64| {
                let square = p.x * p.x + p.y * p.y;
                DVec3::new((p.x * p.z - sign * p.y) / square, (p.y * p.z + sign * p.x) / square, 1.0)
            };
            [line(-1.0), line(1.0)]
        });
        println!("T-R4 {errors:?}");
    }
}
