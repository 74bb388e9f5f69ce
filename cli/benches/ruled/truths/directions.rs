//! Asymptotic directions of surfaces on which they are known, and which family they are of.

use anyhow::Result;
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::ruled::asymptotic::{AsymptoticDirections, Options};
use shapeop::geometry::ruled::orientation;
use shapeop::geometry::ruled::tracing::{self, Sense, Tracer};
use shapeop::mesh::patterns::height_field;
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Mesh, TriangleMesh, surfaces};

use super::{is_refused, largest};
use crate::group::Group;
use crate::shapes::{Shape, saddle, tube};

/// The directions of both families at a point.
type Exact = fn(DVec3) -> [DVec3; 2];

/// With the normal upward at the middle of z = xy, II(e1, n × e1) = II(e1, e2) = 1 and II(e2, n × e2) = −1: the lines along y are
/// of the family of negative torsion.
fn of_saddle(p: DVec3) -> [DVec3; 2] {
    [DVec3::new(0.0, 1.0, p.x), DVec3::new(1.0, 0.0, p.y)]
}

/// Rulings, and helices: these are right-handed screws themselves.
fn of_helicoid(p: DVec3) -> [DVec3; 2] {
    let (sine, cosine) = (p.z / 0.8).sin_cos();
    let u = p.x * cosine + p.y * sine;
    [DVec3::new(cosine, sine, 0.0), DVec3::new(-u * sine, u * cosine, 0.8)]
}

/// With the height v the first fundamental form is cosh²v (du² + dv²), the second du² − dv² up to its sign: x_v ± x_u.
fn of_catenoid(p: DVec3) -> [DVec3; 2] {
    let (sine, cosine) = (p.y / p.z.cosh(), p.x / p.z.cosh());
    let up = DVec3::new(p.z.sinh() * cosine, p.z.sinh() * sine, 1.0);
    let around = DVec3::new(-p.z.cosh() * sine, p.z.cosh() * cosine, 0.0);
    [up - around, up + around]
}

/// Lines (a, b, 1) with a² + b² = 1 and x a + y b = z: with x² + y² = 1 + z² these are (x z ∓ y, y z ± x)/(x² + y²).
fn of_hyperboloid(p: DVec3) -> [DVec3; 2] {
    [-1.0, 1.0].map(|sign| DVec3::new(p.x * p.z - sign * p.y, p.y * p.z + sign * p.x, p.x * p.x + p.y * p.y))
}

fn find(mesh: &Mesh) -> Result<(TriangleMesh, AsymptoticDirections)> {
    let mesh = TriangleMesh::new(mesh)?;
    let found = AsymptoticDirections::new(&mesh, &Options::default())?;
    Ok((mesh, found))
}

/// The largest sines between directions and the lines of their families: inside, and on the boundary.
fn sines(mesh: &Mesh, exact: Exact) -> Result<[f64; 2]> {
    let (mesh, found) = find(mesh)?;
    let families = [found.family(0)?, found.family(1)?];
    let mut worst = [0.0_f64; 2];
    for (i, &p) in mesh.points().iter().enumerate() {
        let rim = usize::from(mesh.is_on_boundary(i));
        for (family, line) in families.iter().zip(exact(p)) {
            worst[rim] = worst[rim].max(family[i].cross(line.normalize()).length());
        }
    }
    Ok(worst)
}

struct ClosedForm {
    shape: Shape,
    exact: Exact,
    /// Whether quads are split along one diagonal, not the shorter.
    is_split: bool,
    /// Which of the meshes has bounds, and these: inside and on the boundary.
    bounds: (usize, [f64; 2]),
}

impl ClosedForm {
    fn mesh(&self, n: usize) -> Result<Mesh> {
        if self.is_split { self.shape.split_mesh(n, n) } else { self.shape.mesh(n, n) }
    }
}

fn four() -> [ClosedForm; 4] {
    let helicoid = Shape::new("helicoid", [[-0.5, 0.5]; 2], surfaces::helicoid(0.8));
    let catenoid = Shape::new("catenoid", [[0.0, 0.8], [-0.4, 0.4]], surfaces::catenoid());
    let hyperboloid = Shape::new("hyperboloid", [[0.0, 1.6], [-0.8, 0.8]], surfaces::hyperboloid());
    [
        ClosedForm { shape: saddle(), exact: of_saddle, is_split: false, bounds: (41, [2e-3, 1e-2]) },
        ClosedForm { shape: helicoid, exact: of_helicoid, is_split: true, bounds: (21, [1e-3, 8e-2]) },
        ClosedForm { shape: catenoid, exact: of_catenoid, is_split: true, bounds: (41, [5e-4, 8e-2]) },
        ClosedForm { shape: hyperboloid, exact: of_hyperboloid, is_split: true, bounds: (41, [1e-3, 1e-2]) },
    ]
}

pub fn closed_forms() -> Result<Group> {
    let mut group = Group::new(
        "truths: asymptotic directions of four closed forms",
        "Sines of the angles to the exact lines, on meshes of 21 by 21, 41 by 41 and 81 by 81 points.",
    );
    for form in four() {
        let name = form.shape.name;
        let errors = [21, 41, 81].map(|n| form.mesh(n).and_then(|mesh| sines(&mesh, form.exact)));
        let [a, b, c] = errors;
        let errors = [(21, a?), (41, b?), (81, c?)];
        for (k, place) in ["inside", "at the rim"].into_iter().enumerate() {
            for (n, error) in &errors {
                let what = format!("{name}: {place}, {n} by {n}");
                if *n == form.bounds.0 {
                    group.at_most(&what, error[k], form.bounds.1[k]);
                } else {
                    group.plain(&what, error[k]);
                }
            }
            for pair in errors.windows(2) {
                let what = format!("{name}: {place}, {} over {}", pair[0].0, pair[1].0);
                group.at_least(&what, pair[0].1[k] / pair[1].1[k], 3.0);
            }
        }
    }
    let [_, _, catenoid, hyperboloid] = four();
    let (mesh, found) = find(&catenoid.mesh(41)?)?;
    let families = [found.family(0)?, found.family(1)?];
    let inner = (0..mesh.points().len()).filter(|&i| !mesh.is_on_boundary(i));
    let cosine = largest(inner.map(|i| families[0][i].dot(families[1][i]).abs()));
    group.at_most("catenoid, 41 by 41: cosine of both families, inside", cosine, 2e-3);
    let [bend, apart] = straightness(&hyperboloid.mesh(41)?)?;
    group.at_most("hyperboloid, 41 by 41: traced lines off straight / length", bend, 1e-3);
    group.plain("hyperboloid, 41 by 41: their sines to the exact rulings", apart);
    Ok(group)
}

/// How far traced curves of the hyperboloid are from the lines between their ends, over their lengths, and the sines of these lines to
/// the rulings through the seeds.
fn straightness(surface: &Mesh) -> Result<[f64; 2]> {
    let (mesh, found) = find(surface)?;
    let reference = ReferenceMesh::new(&mesh);
    let hyperboloid = surfaces::hyperboloid();
    let (mut worst, mut apart) = (0.0_f64, 0.0_f64);
    for family in 0..2 {
        let field = found.orient(&mesh, family, &orientation::Options::default())?.field;
        let tracer = Tracer::new(&mesh, &field, &tracing::Options::default())?;
        for k in 0..15 {
            let seed = hyperboloid(0.2 + 0.085 * f64::from(k), 0.7 * (2.1 * f64::from(k)).sin()).point;
            let start = reference.locate(seed);
            let back = tracer.trace(start, Sense::Backward, 10.0)?;
            let on = tracer.trace(start, Sense::Forward, 10.0)?;
            let line: Vec<DVec3> = back.positions.iter().rev().chain(&on.positions[1..]).copied().collect();
            let (first, last) = (line[0], line[line.len() - 1]);
            let length = first.distance(last);
            let along = (last - first) / length;
            let off = largest(line.iter().map(|p| (*p - first).reject_from_normalized(along).length()));
            worst = worst.max(off / length);
            apart = apart.max(along.cross(of_hyperboloid(seed)[family].normalize()).length());
        }
    }
    Ok([worst, apart])
}

pub fn families() -> Result<Group> {
    let mut group = Group::new(
        "truths: families of asymptotic directions",
        "A family is told by the sign of its torsion, −√−K or √−K (Beltrami and Enneper); nothing else is.",
    );
    let (mut wrong, mut turned_off) = (0.0_f64, 0.0_f64);
    let mut disagreeing = 0;
    for form in four() {
        let surface = form.mesh(21)?;
        let mut turned = surface.clone();
        turned.faces.iter_mut().for_each(|face| face.reverse());
        let ((mesh, here), (_, there)) = (find(&surface)?, find(&turned)?);
        for (family, sign) in [(0, -1.0), (1, 1.0)] {
            let [a, b] = [here.family(family)?, there.family(family)?];
            for i in 0..surface.points.len() {
                let curvature = here.curvatures()[i];
                wrong = wrong.max((curvature.torsion(a[i]) - sign * (-curvature.gaussian()).sqrt()).abs());
                turned_off = turned_off.max(a[i].cross(b[i]).length());
            }
            let field = here.orient(&mesh, family, &orientation::Options::default())?.field;
            let is_apart =
                |[i, j]: &[u32; 2]| field.directions()[*i as usize].dot(field.directions()[*j as usize]) <= 0.0;
            disagreeing += mesh.edges().iter().filter(|edge| is_apart(edge)).count();
        }
    }
    group.at_most("four surfaces: torsions off −√−K and √−K", wrong, 1e-12);
    group.at_most("sines of directions when all faces are turned over", turned_off, 1e-9);
    group.at_most("edges across which signs disagree", disagreeing as f64, 0.0);
    let sphere = Shape::new("sphere", [[0.0, 2.0], [-1.0, 1.0]], surfaces::sphere(1.0)).mesh(21, 15)?;
    let ellipsoid = Mesh {
        points: sphere.points.iter().map(|p| *p * DVec3::new(1.0, 2.0, 3.0)).collect(),
        faces: sphere.faces.clone(),
    };
    for (name, mesh) in [("sphere", sphere), ("ellipsoid", ellipsoid)] {
        let mesh = TriangleMesh::new(&mesh)?;
        let refused = is_refused(AsymptoticDirections::new(&mesh, &Options::default()), Status::CurvatureSign, "mesh");
        group.at_least(&format!("{name}: refused as not negatively curved"), refused, 1.0);
    }
    let monkey = |x: f64, y: f64| x * x * x - 3.0 * x * y * y;
    let around = tube(60, 15, |angle, part| {
        let (x, y) = ((0.3 + 0.7 * part) * angle.cos(), (0.3 + 0.7 * part) * angle.sin());
        DVec3::new(x, y, monkey(x, y))
    })?;
    for (name, mesh) in [
        ("ring of a monkey saddle", around),
        ("monkey saddle", height_field(21, 21, [-1.0, 1.0], [-1.0, 1.0], monkey)?),
    ] {
        let (mesh, found) = find(&mesh)?;
        let orient = |allow_cut| found.orient(&mesh, 0, &orientation::Options { allow_cut, ..Default::default() });
        group.at_least(
            &format!("{name}: refused as it has no signs"),
            is_refused(orient(false), Status::NotOrientable, "mesh"),
            1.0,
        );
        group.at_least(&format!("{name}: accepted with a cut, edges along it"), orient(true)?.flips.len() as f64, 1.0);
    }
    Ok(group)
}
