use std::f64::consts::PI;

use super::*;
use crate::geometry::snakes::mesh_curve::{MeshCurve, mesh_curve};
use crate::mesh::reference::{ParametricSurface, ReferenceMesh};
use crate::mesh::surfaces::{cylinder, sphere, torus};
use crate::mesh::{Mesh, TriangleMesh};

const EVERYWHERE: [[f64; 2]; 2] = [[f64::NEG_INFINITY, f64::INFINITY]; 2];

/// A plane in coordinates that are neither of one length nor at right angles.
fn plane(u: f64, v: f64) -> SurfaceJet {
    let first = [DVec3::new(1.3, 0.2, 0.0), DVec3::new(0.4, 0.9, 0.0)];
    SurfaceJet { point: u * first[0] + v * first[1], first, second: [DVec3::ZERO; 3] }
}

fn trace(
    surface: &dyn Fn(f64, f64) -> SurfaceJet,
    start: [f64; 2],
    tangent: DVec3,
    course: &Course<'_>,
    steps: usize,
    method: Method,
) -> CurvatureCurve {
    let curve = curvature_curve(surface, EVERYWHERE, start, tangent, course, &Options { steps, method }).unwrap();
    assert_eq!((curve.end, curve.points.len(), curve.tangents.len()), (End::Length, steps + 1, steps + 1));
    assert!((curve.lengths[steps] - course.length).abs() < 1e-12);
    assert!(curve.tangents.iter().all(|t| (t.length() - 1.0).abs() < 1e-12));
    curve
}

/// How far a curve is from the circle of curvature 1/`radius` that it begins along, with all points at their lengths.
fn from_circle(curve: &CurvatureCurve, inward: DVec3, radius: f64) -> f64 {
    let (start, tangent) = (curve.points[0], curve.tangents[0]);
    let apart = |(point, length): (&DVec3, &f64)| {
        let (sine, cosine) = (length / radius).sin_cos();
        point.distance(start + radius * (sine * tangent + (1.0 - cosine) * inward))
    };
    curve.points.iter().zip(&curve.lengths).map(apart).fold(0.0, f64::max)
}

fn slopes(error: impl Fn(usize, Method) -> f64) -> [f64; 2] {
    let slope = |method, steps| (error(steps, method) / error(2 * steps, method)).log2();
    [slope(Method::Chords, 200), slope(Method::RungeKutta, 40)]
}

#[test]
fn curves_are_circles_on_planes_and_spheres() {
    let kappa: f64 = 1.6;
    let curvature = move |_: f64| kappa;
    let course = |side| Course { curvature: &curvature, length: 3.0, side };
    for (side, sign) in [(Side::Left, 1.0), (Side::Right, -1.0)] {
        let on_plane = |steps, method| {
            let curve = trace(&plane, [0.2, 0.1], DVec3::new(1.0, 0.5, 7.0), &course(side), steps, method);
            from_circle(&curve, sign * DVec3::Z.cross(curve.tangents[0]), 1.0 / kappa)
        };
        // On a sphere of radius R the curvature vector is −p/R² + κ_g n × t: a small circle.
        let radius: f64 = 1.25;
        let on_sphere = |steps, method| {
            let curve = trace(&sphere(radius), [0.3, 0.2], DVec3::new(-0.4, 1.0, 0.7), &course(side), steps, method);
            let normal = curve.points[0] / radius;
            let geodesic = sign * (kappa * kappa - 1.0 / (radius * radius)).sqrt();
            let inward = (-normal / radius + geodesic * normal.cross(curve.tangents[0])) / kappa;
            from_circle(&curve, inward, 1.0 / kappa)
        };
        for slopes in [slopes(on_plane), slopes(on_sphere)] {
            assert!((slopes[0] - 1.0).abs() < 0.1 && slopes[1] > 3.5, "{slopes:?}");
        }
        assert!(on_plane(1000, Method::RungeKutta) < 1e-11 && on_sphere(1000, Method::RungeKutta) < 1e-10);
        assert!(on_plane(1000, Method::Chords) < 2e-2 && on_sphere(1000, Method::Chords) < 2e-2);
    }
}

#[test]
fn a_helix_is_found_on_its_cylinder() {
    // At the slope φ a helix of the cylinder is a geodesic of curvature cos²φ/R.
    let (radius, phi) = (0.8, 0.6_f64);
    let kappa = phi.cos().powi(2) / radius;
    let tangent = DVec3::new(0.0, phi.cos(), phi.sin());
    let course = Course { curvature: &|_| kappa, length: 4.0, side: Side::Left };
    for method in [Method::Chords, Method::RungeKutta] {
        let curve = trace(&cylinder(radius), [0.0, 0.0], tangent, &course, 400, method);
        for (point, length) in curve.points.iter().zip(&curve.lengths) {
            let (sine, cosine) = (length * phi.cos() / radius).sin_cos();
            let helix = DVec3::new(radius * cosine, radius * sine, length * phi.sin());
            assert!(point.distance(helix) < 1e-9, "{method:?} {}", point.distance(helix));
        }
    }
}

#[test]
fn curves_to_both_sides_are_mirror_images() {
    let curvature = |s: f64| 2.0 + (2.0 * s).sin();
    let course = |side| Course { curvature: &curvature, length: 3.0, side };
    let both = |surface: &dyn Fn(f64, f64) -> SurfaceJet, normal: fn(DVec3) -> DVec3, method| {
        let [left, right] = [Side::Left, Side::Right]
            .map(|side| trace(surface, [0.2, -0.3], DVec3::new(-0.2, 1.0, 0.6), &course(side), 3000, method));
        // In the plane of normal and tangent at the start.
        let across = normal(left.points[0]).cross(left.tangents[0]);
        let mirrored = |p: DVec3| p - 2.0 * (p - left.points[0]).dot(across) * across;
        let apart = left.points.iter().zip(&right.points).map(|(l, r)| l.distance(mirrored(*r))).fold(0.0, f64::max);
        // To the left at first.
        assert!((left.points[300] - left.points[0]).dot(across) > 0.0);
        apart
    };
    assert!(both(&plane, |_| DVec3::Z, Method::RungeKutta) < 1e-11);
    assert!(both(&plane, |_| DVec3::Z, Method::Chords) < 1e-9);
    assert!(both(&sphere(1.2), |p| p.normalize(), Method::RungeKutta) < 1e-9);
}

#[test]
fn straight_lines_and_great_circles_are_found() {
    let course = |kappa: &'static dyn Fn(f64) -> f64| Course { curvature: kappa, length: 5.0, side: Side::Left };
    for method in [Method::RungeKutta, Method::Chords] {
        let line = trace(&plane, [0.0, 0.0], DVec3::new(0.3, 0.4, 0.0), &course(&|_| 0.0), 100, method);
        for (point, length) in line.points.iter().zip(&line.lengths) {
            assert!(point.distance(length * DVec3::new(0.6, 0.8, 0.0)) < 1e-12);
        }
    }
    let circle =
        trace(&sphere(2.0), [0.3, 0.1], DVec3::new(0.0, 1.0, 1.0), &course(&|_| 0.5), 2000, Method::RungeKutta);
    assert!(from_circle(&circle, -circle.points[0] / 2.0, 2.0) < 1e-9);
}

#[test]
fn what_the_surface_bends_more_than_has_no_solution() {
    let course = Course { curvature: &|_| 0.5, length: 1.0, side: Side::Left };
    let refused = curvature_curve(&sphere(1.0), EVERYWHERE, [0.0, 0.0], DVec3::Y, &course, &Options::default());
    let refused = refused.unwrap_err();
    assert_eq!((refused.status(), refused.place()), (Status::NoSolution, "course.curvature"));
    // Falling from 2 below 1 at the length 1.
    let course = Course { curvature: &|s| 2.0 - s, length: 2.0, side: Side::Right };
    for method in [Method::RungeKutta, Method::Chords] {
        let options = Options { steps: 100, method };
        let found = curvature_curve(&sphere(1.0), EVERYWHERE, [0.0, 0.0], DVec3::Y, &course, &options).unwrap();
        let End::NoSolution { curvature, normal_curvature } = found.end else { panic!("{:?}", found.end) };
        assert!((curvature - 1.0).abs() < 0.05 && (normal_curvature + 1.0).abs() < 1e-9);
        let reached = found.lengths[found.lengths.len() - 1];
        assert!((reached - 1.0).abs() < 0.03, "{reached}");
    }
}

#[test]
fn curves_end_at_the_boundary() {
    let course = Course { curvature: &|_| 0.5, length: 10.0, side: Side::Left };
    let flat = |u: f64, v: f64| SurfaceJet { point: DVec3::new(u, v, 0.0), ..plane(u, v) };
    let flat = move |u: f64, v: f64| SurfaceJet { first: [DVec3::X, DVec3::Y], ..flat(u, v) };
    // From the middle of the left side, a circle of radius 2 meets the right side at the angle asin(½).
    let options = Options { steps: 300, ..Options::default() };
    let found = curvature_curve(&flat, [[0.0, 1.0], [-1.0, 1.0]], [0.0, 0.0], DVec3::X, &course, &options).unwrap();
    let last = found.points.len() - 1;
    assert_eq!(found.end, End::Boundary);
    assert!(found.points[last].distance(DVec3::new(1.0, 2.0 - 3.0_f64.sqrt(), 0.0)) < 1e-9);
    assert!((found.lengths[last] - PI / 3.0).abs() < 1e-9, "{}", found.lengths[last]);
}

#[test]
fn bad_courses_are_refused() {
    let place = |start, tangent, kappa: f64, length, steps| {
        let course = Course { curvature: &|_| kappa, length, side: Side::Left };
        let options = Options { steps, ..Options::default() };
        let refused = curvature_curve(&plane, [[-1.0, 1.0], [-1.0, 1.0]], start, tangent, &course, &options);
        refused.unwrap_err().place().to_owned()
    };
    assert_eq!(place([0.0, 1.1], DVec3::X, 1.0, 1.0, 10), "start[1]");
    assert_eq!(place([f64::NAN, 0.0], DVec3::X, 1.0, 1.0, 10), "start[0]");
    assert_eq!(place([0.0, 0.0], DVec3::Z, 1.0, 1.0, 10), "tangent");
    assert_eq!(place([0.0, 0.0], DVec3::ZERO, 1.0, 1.0, 10), "tangent");
    assert_eq!(place([0.0, 0.0], DVec3::X, -1.0, 1.0, 10), "course.curvature");
    assert_eq!(place([0.0, 0.0], DVec3::X, f64::NAN, 1.0, 10), "course.curvature");
    assert_eq!(place([0.0, 0.0], DVec3::X, 1.0, 0.0, 10), "course.length");
    assert_eq!(place([0.0, 0.0], DVec3::X, 1.0, 1.0, 0), "options.steps");
}

/// The curve on a mesh, and how far it is from the one on the surface at most, at the same lengths.
fn on_mesh<F: Fn(f64, f64) -> SurfaceJet + Sync>(
    surface: &ParametricSurface<F>,
    [columns, rows]: [usize; 2],
    start: [f64; 2],
    tangent: DVec3,
    course: &Course<'_>,
) -> (MeshCurve, f64, f64) {
    let mesh = TriangleMesh::new(&surface.mesh(columns, rows).unwrap()).unwrap();
    let at = surface.at(start[0], start[1]).point;
    let options = Options::default();
    let found = mesh_curve(&ReferenceMesh::new(&mesh), at, tangent, course, &options).unwrap();
    let exact = curvature_curve(&|u, v| surface.at(u, v), EVERYWHERE, start, tangent, course, &options).unwrap();
    assert_eq!((found.curve.end, found.triangles.len()), (End::Length, options.steps + 1));
    let apart = found.curve.points.iter().zip(&exact.points).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    (found, apart, mesh.mean_edge())
}

#[test]
fn curves_on_meshes_are_those_of_the_surfaces() {
    let patch = ParametricSurface::new([[-1.0, 1.0], [-0.8, 0.8]], [20, 20], sphere(1.0)).unwrap();
    let ring = ParametricSurface::new([[-1.5, 1.5], [-2.0, 2.0]], [20, 20], torus(2.0, 0.7)).unwrap();
    for side in [Side::Left, Side::Right] {
        let course = Course { curvature: &|_| 1.8, length: 2.0, side };
        let tight = Course { curvature: &|_| 3.0, ..course };
        let (found, apart, edge) = on_mesh(&patch, [40, 40], [0.0, 0.1], DVec3::new(0.0, 1.0, 0.4), &tight);
        assert!(found.crossing_count > 10 && apart < 5.0 * edge * edge, "{} {apart} {edge}", found.crossing_count);
        let errors = [1, 2].map(|n| {
            let (found, apart, edge) = on_mesh(&ring, [40 * n, 40 * n], [0.1, 0.2], DVec3::new(0.3, 0.5, 1.0), &course);
            assert!(found.crossing_count > 10 && apart < 5.0 * edge * edge, "{} {apart} {edge}", found.crossing_count);
            apart
        });
        assert!(errors[0] / errors[1] > 3.0, "{errors:?}");
    }
}

#[test]
fn curves_on_meshes_end_at_the_boundary_and_go_straight_on_planes() {
    let square = ParametricSurface::new([[0.0, 1.0], [0.0, 1.0]], [2, 2], |u, v| SurfaceJet {
        point: DVec3::new(u, v, 0.0),
        first: [DVec3::X, DVec3::Y],
        second: [DVec3::ZERO; 3],
    });
    let mesh = TriangleMesh::new(&square.unwrap().mesh(12, 9).unwrap()).unwrap();
    let reference = ReferenceMesh::new(&mesh);
    let course = Course { curvature: &|_| 0.0, length: 3.0, side: Side::Left };
    let start = DVec3::new(0.1, 0.2, 0.01);
    let found = mesh_curve(&reference, start, DVec3::new(3.0, 2.0, 1.0), &course, &Options::default()).unwrap();
    let curve = &found.curve;
    let last = curve.points.len() - 1;
    assert_eq!((curve.end, found.triangles.len()), (End::Boundary, last + 1));
    assert!(curve.points[last].distance(DVec3::new(1.0, 0.8, 0.0)) < 1e-9, "{}", curve.points[last]);
    assert!((curve.lengths[last] - 0.9_f64.hypot(0.6)).abs() < 1e-9);
    let far = mesh_curve(&reference, DVec3::new(0.5, 0.5, 1.0), DVec3::X, &course, &Options::default()).unwrap_err();
    assert_eq!((far.status(), far.place()), (Status::OutOfDomain, "start"));
}

#[test]
fn curves_on_meshes_do_not_depend_on_the_scale() {
    // Powers of two, so that quads are split along the same diagonals.
    let found = [1.0 / 1024.0, 1.0, 1024.0].map(|scale: f64| {
        let patch = ParametricSurface::new([[-1.0, 1.0], [-0.8, 0.8]], [20, 20], sphere(scale)).unwrap();
        let mesh = TriangleMesh::new(&patch.mesh(25, 25).unwrap()).unwrap();
        let curvature = move |_: f64| 3.0 / scale;
        let course = Course { curvature: &curvature, length: 2.0 * scale, side: Side::Right };
        let start = patch.at(0.1, 0.1).point;
        let found = mesh_curve(&ReferenceMesh::new(&mesh), start, DVec3::Y, &course, &Options::default()).unwrap();
        assert_eq!(found.curve.end, End::Length);
        found.curve.points[200] / scale
    });
    assert!(found[0].distance(found[1]) < 1e-9 && found[2].distance(found[1]) < 1e-9, "{found:?}");
}

#[test]
fn lines_go_along_edges_and_through_points_of_a_mesh() {
    let square = ParametricSurface::new([[0.0, 1.0], [0.0, 1.0]], [2, 2], |u, v| SurfaceJet {
        point: DVec3::new(u, v, 0.3 * u),
        first: [DVec3::X, DVec3::Y],
        second: [DVec3::ZERO; 3],
    });
    let mesh = TriangleMesh::new(&square.unwrap().mesh(9, 9).unwrap()).unwrap();
    let reference = ReferenceMesh::new(&mesh);
    let slope = DVec3::new(1.0, 0.0, 0.3);
    for direction in [slope, slope + DVec3::Y, 2.0 * slope + DVec3::Y] {
        let course = Course { curvature: &|_| 0.0, length: 0.7, side: Side::Left };
        let start = 0.125 * (slope + DVec3::Y);
        let found = mesh_curve(&reference, start, direction, &course, &Options::default()).unwrap();
        let end = start + 0.7 * direction.normalize();
        assert_eq!(found.curve.end, End::Length);
        assert!(found.curve.points[200].distance(end) < 1e-12, "{}", found.curve.points[200]);
    }
}

#[test]
fn a_cube_and_a_fold_come_to_an_end() {
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let cube = Mesh { points: (0..8).map(corner).collect(), faces: faces.map(|face| face.to_vec()).to_vec() };
    // Two sheets that nearly touch.
    let fold = |x: f64, y: f64| DVec3::new(x.abs(), y, 1e-3 * x);
    let fold = crate::mesh::patterns::parametric_surface(9, 9, [-1.0, 1.0], [0.0, 1.0], fold).unwrap();
    for (mesh, start) in [(cube, DVec3::new(0.4, 0.45, 1.0)), (fold, DVec3::new(0.7, 0.45, 7e-4))] {
        let mesh = TriangleMesh::new(&mesh).unwrap();
        for i in 0..24 {
            let (sine, cosine) = (0.26 * f64::from(i)).sin_cos();
            for kappa in [0.0, 2.0, 30.0] {
                let course = Course { curvature: &|_| kappa, length: 6.0, side: Side::Left };
                let tangent = DVec3::new(cosine, sine, 0.0);
                match mesh_curve(&ReferenceMesh::new(&mesh), start, tangent, &course, &Options::default()) {
                    Ok(found) => {
                        let curve = found.curve;
                        assert!(curve.points.iter().chain(&curve.tangents).all(|v| v.is_finite()));
                        assert_eq!(curve.points.len(), found.triangles.len());
                        assert!(curve.lengths.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", curve.end);
                    }
                    Err(error) => assert_eq!(error.status(), Status::NoSolution),
                }
            }
        }
    }
}

#[test]
fn a_curve_goes_over_a_seam_without_being_told() {
    let around = [-PI, PI];
    let surface = ParametricSurface::new([around; 2], [33, 33], torus(2.0, 0.7)).unwrap();
    let course = Course { curvature: &|_| 1.8, length: 12.0, side: Side::Left };
    let options = Options { steps: 600, ..Options::default() };
    let jet = surface.at(0.1, 0.2);
    let tangent = jet.normal().cross(DVec3::new(0.3, 0.5, 1.0));
    let found = surface_curve(&surface, jet.point, tangent, &course, &options).unwrap();
    let everywhere = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
    let told = curvature_curve(&torus(2.0, 0.7), everywhere, [0.1, 0.2], tangent, &course, &options).unwrap();
    assert_eq!((found.end, found.points.len()), (End::Length, 601));
    assert!(found.points.iter().zip(&told.points).all(|(a, b)| a.distance(*b) < 1e-9));
    // A cylinder ends at its rims.
    let tube = ParametricSurface::new([around, [0.0, 1.0]], [33, 3], cylinder(1.0)).unwrap();
    let course = Course { curvature: &|_| 1.0, ..course };
    let found = surface_curve(&tube, DVec3::new(1.0, 0.0, 0.5), DVec3::new(0.0, 1.0, 0.1), &course, &options).unwrap();
    assert_eq!(found.end, End::Boundary);
    let bad = surface_curve(&tube, DVec3::NAN, DVec3::Z, &course, &options);
    assert_eq!(bad.unwrap_err().place(), "start");
}
