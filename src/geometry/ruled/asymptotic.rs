//! The two asymptotic directions at each point of a mesh, told apart.
//!
//! With principal curvatures `κ1 > 0 > κ2` and principal directions `p1`, `p2 = n × p1` the second fundamental form vanishes
//! along
//!
//! ```text
//! d = (√−κ2 p1 ± √κ1 p2) / √(κ1 − κ2).
//! ```
//!
//! The geodesic torsion `II(d, n × d)` there is `∓√(κ1 (−κ2)) = ∓√−K` (Beltrami and Enneper: it is the torsion of the
//! asymptotic curve), and does not change under `d → −d` or `n → −n`. So its sign tells the two families apart at each point by
//! itself: no search over the mesh is needed where Flöry et al. 2012, section 2.1, compare neighbours, and a family is the same
//! whichever way faces are oriented. Along family 0 the torsion is negative: going along, the tangent plane turns like a
//! left-handed screw; along family 1 like a right-handed one.
//!
//! Where `K ≥ 0` the surface has no asymptotic direction, and none is made up: such points are masked.

use glam::DVec3;

use crate::error::{Error, Result, Status};
use crate::mesh::TriangleMesh;
use crate::mesh::curvature::{self, Curvature, Fit, curvatures};

/// Round-off of coordinates in heights over a tangent plane, as a multiple of the largest coordinate: a few units in the last
/// place, times what the fit makes of them.
const HEIGHT_NOISE: f64 = 1e-13;

/// What counts as negatively curved, and how much must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How curvatures are found.
    pub curvature: curvature::Options,
    /// Points where the Gaussian curvature is not below minus this times the square of the greatest principal curvature of the
    /// mesh are masked: their directions are all but one, and turn with the least noise. From 0 to 1. Curvatures that were
    /// fitted err by the square of an edge times that of the curvature: on a mesh of edges `h` and curvatures up to `κ`, a
    /// cylinder can come out slightly negative. Who must tell it apart asks for about `(h κ)²`.
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

    /// The largest sine of an angle between a direction and the exact line of its family, over the points inside and over those
    /// on the boundary.
    fn worst(mesh: &Mesh, exact: &impl Fn(DVec3) -> [DVec3; 2]) -> [f64; 2] {
        let (mesh, found) = find(mesh).unwrap();
        assert_eq!(found.masked_count(), 0);
        let mut worst = [0.0_f64; 2];
        for (i, &p) in mesh.points().iter().enumerate() {
            let on_boundary = usize::from(mesh.is_on_boundary(i));
            for (family, exact) in exact(p).into_iter().enumerate() {
                let sine = found.family(family).unwrap()[i].cross(exact.normalize()).length();
                worst[on_boundary] = worst[on_boundary].max(sine);
            }
        }
        worst
    }

    /// All quads along the same diagonal: on surfaces of revolution both are equally long but for round-off.
    fn split(mesh: &Mesh) -> Mesh {
        let halves = mesh.faces.iter().flat_map(|f| [vec![f[0], f[1], f[2]], vec![f[0], f[2], f[3]]]);
        Mesh { points: mesh.points.clone(), faces: halves.collect() }
    }

    /// With quads, split along their shorter diagonals: points have four to eight neighbours.
    fn saddle(n: usize) -> Mesh {
        height_field(n, n, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap()
    }

    fn helicoid(n: usize) -> Mesh {
        let point = |u: f64, v: f64| DVec3::new(u * v.cos(), u * v.sin(), 0.8 * v);
        split(&parametric_surface(n, n, [-0.5, 0.5], [-0.5, 0.5], point).unwrap())
    }

    fn catenoid(n: usize) -> Mesh {
        let point = |u: f64, v: f64| DVec3::new(u.cosh() * v.cos(), u.cosh() * v.sin(), u);
        split(&parametric_surface(n, n, [-0.4, 0.4], [0.0, 0.8], point).unwrap())
    }

    /// Part of `x² + y² − z² = 1`.
    fn hyperboloid(n: usize) -> Mesh {
        let point = |v: f64, z: f64| {
            let r = (1.0 + z * z).sqrt();
            DVec3::new(r * v.cos(), r * v.sin(), z)
        };
        split(&parametric_surface(n, n, [0.0, 1.6], [-0.8, 0.8], point).unwrap())
    }

    /// The largest sines on meshes of 11², 21² and 41² points, each less than a third of the one before.
    fn halved(mesh: fn(usize) -> Mesh, exact: impl Fn(DVec3) -> [DVec3; 2]) -> [[f64; 2]; 3] {
        let errors = [11, 21, 41].map(|n| worst(&mesh(n), &exact));
        for fine in 1..3 {
            assert!((0..2).all(|k| errors[fine - 1][k] > 3.0 * errors[fine][k]), "{errors:?}");
        }
        errors
    }

    fn of_saddle(p: DVec3) -> [DVec3; 2] {
        // At the middle, with the normal upward, II(e1, n × e1) = II(e1, e2) = 1 and II(e2, n × e2) = −1.
        [DVec3::new(0.0, 1.0, p.x), DVec3::new(1.0, 0.0, p.y)]
    }

    /// Rulings, and helices: these are right-handed screws themselves.
    fn of_helicoid(p: DVec3) -> [DVec3; 2] {
        let (sine, cosine) = (p.z / 0.8).sin_cos();
        let u = p.x * cosine + p.y * sine;
        [DVec3::new(cosine, sine, 0.0), DVec3::new(-u * sine, u * cosine, 0.8)]
    }

    /// The first fundamental form is cosh²u (du² + dv²), the second −du² + dv²: x_u ± x_v.
    fn of_catenoid(p: DVec3) -> [DVec3; 2] {
        let u = p.z;
        let (sine, cosine) = (p.y / u.cosh(), p.x / u.cosh());
        let x_u = DVec3::new(u.sinh() * cosine, u.sinh() * sine, 1.0);
        let x_v = DVec3::new(-u.cosh() * sine, u.cosh() * cosine, 0.0);
        [x_u - x_v, x_u + x_v]
    }

    /// Lines (a, b, 1) with a² + b² = 1 and x a + y b = z: with x² + y² = 1 + z² these are (x z ∓ y, y z ± x)/(x² + y²).
    fn of_hyperboloid(p: DVec3) -> [DVec3; 2] {
        [-1.0, 1.0].map(|sign| DVec3::new(p.x * p.z - sign * p.y, p.y * p.z + sign * p.x, p.x * p.x + p.y * p.y))
    }

    #[test]
    fn the_saddle_has_its_rulings() {
        let [_, _, [inside, rim]] = halved(saddle, of_saddle);
        assert!(inside < 5e-4 && rim < 3e-3, "{inside} {rim}");
    }

    #[test]
    fn the_helicoid_has_its_rulings_and_its_helices() {
        let [_, [inside, rim], _] = halved(helicoid, of_helicoid);
        assert!(inside < 3e-3 && rim < 1e-2, "{inside} {rim}");
    }

    #[test]
    fn the_catenoid_has_its_diagonals_which_are_orthogonal() {
        let [_, _, [inside, rim]] = halved(catenoid, of_catenoid);
        assert!(inside < 5e-4 && rim < 2e-3, "{inside} {rim}");
        let (mesh, found) = find(&catenoid(41)).unwrap();
        let inner = (0..mesh.points().len()).filter(|&i| !mesh.is_on_boundary(i));
        assert!(inner.map(|i| found.families[0][i].dot(found.families[1][i]).abs()).fold(0.0, f64::max) < 2e-3);
    }

    #[test]
    fn the_hyperboloid_has_its_two_families_of_lines() {
        let [_, _, [inside, rim]] = halved(hyperboloid, of_hyperboloid);
        assert!(inside < 1e-3 && rim < 5e-3, "{inside} {rim}");
    }

    #[test]
    fn families_know_nothing_of_the_orientation_of_faces() {
        for surface in [saddle(21), helicoid(21), catenoid(21), hyperboloid(21)] {
            let (_, found) = find(&surface).unwrap();
            let mut turned = surface.clone();
            turned.faces.iter_mut().for_each(|face| face.reverse());
            let (_, other) = find(&turned).unwrap();
            for i in 0..surface.points.len() {
                let (here, there) = (found.curvatures()[i], other.curvatures()[i]);
                assert!(here.normal.dot(there.normal) < -0.999);
                for (family, sign) in [(0, -1.0), (1, 1.0)] {
                    let [a, b] = [&found, &other].map(|found| found.family(family).unwrap()[i]);
                    assert!(a.cross(b).length() < 1e-9, "{i}: {a} {b}");
                    // One sign, and of the size that Beltrami and Enneper say.
                    for (curvature, direction) in [(here, a), (there, b)] {
                        let expected = sign * (-curvature.gaussian()).sqrt();
                        assert!((curvature.torsion(direction) - expected).abs() < 1e-12);
                        assert!(curvature.second_form(direction, direction).abs() < 1e-12);
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_not_negatively_curved_is_refused_with_its_count() {
        let ellipsoid = |a: f64, b: f64, c: f64| {
            let point = move |u: f64, v: f64| DVec3::new(a * u.cos() * v.cos(), b * u.sin() * v.cos(), c * v.sin());
            parametric_surface(21, 15, [0.0, 2.0], [-1.0, 1.0], point).unwrap()
        };
        let plane = |tilt: f64| height_field(15, 15, [3.0, 4.0], [-1.0, 0.0], |x, y| tilt * (x + 0.3 * y)).unwrap();
        for mesh in [ellipsoid(1.0, 1.0, 1.0), ellipsoid(1e-3, 2e-3, 3e-3), plane(0.0), plane(0.7)] {
            let refusal = find(&mesh).unwrap_err();
            assert_eq!((refusal.status(), refusal.place()), (Status::CurvatureSign, "mesh"));
            let count = mesh.points.len();
            assert!(refusal.to_string().contains(&format!("found {count} of {count} points")), "{refusal}");
        }
        let single = height_field(2, 2, [0.0, 1.0], [0.0, 1.0], |x, y| x * y).unwrap();
        assert!(find(&single).unwrap_err().to_string().contains("found 0 of 4 points where it is not, and 4 without"));
    }

    #[test]
    fn of_a_torus_the_inner_side_has_directions_if_so_much_may_be_masked() {
        let point = |u: f64, v: f64| DVec3::new((3.0 + v.cos()) * u.cos(), (3.0 + v.cos()) * u.sin(), v.sin());
        let mesh = TriangleMesh::new(&parametric_surface(41, 41, [0.0, 2.0], [0.8, 3.9], point).unwrap()).unwrap();
        let options = |max_mask: f64| Options { max_mask, ..Options::default() };
        assert_eq!(AsymptoticDirections::new(&mesh, &options(0.05)).unwrap_err().status(), Status::CurvatureSign);
        let found = AsymptoticDirections::new(&mesh, &options(0.3)).unwrap();
        assert!((0.2..0.3).contains(&(found.masked_count() as f64 / 1681.0)));
        for (i, p) in mesh.points().iter().enumerate() {
            let inward = 3.0 - p.x.hypot(p.y);
            match found.status()[i] {
                PointStatus::Good => assert!(inward > -0.03 && found.family(0).unwrap()[i].is_normalized()),
                PointStatus::NotNegative => assert!(inward < 0.03 && found.family(1).unwrap()[i] == DVec3::ZERO),
                PointStatus::NotFitted => panic!("{p}"),
            }
        }
    }

    #[test]
    fn directions_do_not_depend_on_the_unit_of_length() {
        let (_, found) = find(&helicoid(15)).unwrap();
        for scale in [1e-6, 1e6] {
            let mut scaled = helicoid(15);
            scaled.points.iter_mut().for_each(|p| *p *= scale);
            let (_, other) = find(&scaled).unwrap();
            for family in 0..2 {
                let pairs = found.family(family).unwrap().iter().zip(other.family(family).unwrap());
                assert!(pairs.into_iter().all(|(a, b)| a.cross(*b).length() < 1e-9));
            }
        }
    }

    #[test]
    fn bad_input_is_named() {
        let mesh = TriangleMesh::new(&saddle(5)).unwrap();
        let place = |options| AsymptoticDirections::new(&mesh, &options).unwrap_err().place().to_owned();
        assert_eq!(place(Options { flatness: -1.0, ..Options::default() }), "flatness");
        assert_eq!(place(Options { max_mask: f64::NAN, ..Options::default() }), "max_mask");
        let curvature = curvature::Options { least_neighbours: 3 };
        assert_eq!(place(Options { curvature, ..Options::default() }), "curvature.least_neighbours");
        let found = AsymptoticDirections::new(&mesh, &Options::default()).unwrap();
        assert_eq!(found.family(2).unwrap_err().place(), "family");
    }

    #[test]
    fn irregular_points_do_little_harm() {
        // Points of the saddle moved on it by up to 0.3 of an edge in x and y.
        let error = |n: usize| {
            let (mut mesh, edge) = (saddle(n), 2.0 / (n - 1) as f64);
            for (i, p) in mesh.points.iter_mut().enumerate() {
                let t = i as f64;
                let (x, y) = (p.x + 0.3 * edge * (7.3 * t).sin(), p.y + 0.3 * edge * (3.9 * t).cos());
                *p = DVec3::new(x, y, x * y);
            }
            worst(&mesh, &of_saddle)
        };
        let [coarse, fine] = [21, 81].map(error);
        // Two halvings.
        assert!((0..2).all(|k| coarse[k] > 9.0 * fine[k]), "{coarse:?} {fine:?}");
        assert!(fine[0] < 2e-3 && fine[1] < 5e-3, "{fine:?}");
    }
}
