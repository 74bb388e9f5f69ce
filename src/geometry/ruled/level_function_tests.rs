//! Level functions against surfaces on which they are known.

use std::ops::ControlFlow;

use glam::{DVec2, DVec3};

use super::asymptotic::{self, AsymptoticDirections};
use super::boundaries::BoundaryOptions;
use super::great_circles::{great_circle, great_circle_boundaries};
use super::level_function::{LevelFunction, LevelOptions, LevelWeights, level_function};
use super::level_terms::{Jumps, TermWeights, Terms};
use super::orientation;
use super::spherical_image::{ImageKind, SphericalImage};
use super::{Axis, Field};
use crate::error::Status;
use crate::linalg::gauss_newton::{self, Progress, Stop};
use crate::mesh::level_curves::level_curves;
use crate::mesh::operators::gradient_on;
use crate::mesh::patterns::parametric_surface;
use crate::mesh::{SurfacePoint, TriangleMesh};

fn on(_: &Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// `n × n` points of a surface and the field of unit vectors along given ones.
fn surface(
    n: usize,
    [u, v]: [[f64; 2]; 2],
    point: impl Fn(f64, f64) -> DVec3,
    along: impl Fn(f64, f64) -> DVec3,
) -> (TriangleMesh, Field) {
    let mesh = TriangleMesh::new(&parametric_surface(n, n, u, v, point).unwrap()).unwrap();
    let directions = parametric_surface(n, n, u, v, |u, v| along(u, v).normalize()).unwrap().points;
    let count = directions.len();
    let field = Field::new(&mesh, directions, vec![true; count]).unwrap();
    (mesh, field)
}

fn with(weights: LevelWeights) -> LevelOptions {
    LevelOptions { weights, ..LevelOptions::default() }
}

fn solve(mesh: &TriangleMesh, field: &Field, weights: LevelWeights) -> LevelFunction {
    let found = level_function(mesh, field, &with(weights), &mut on).unwrap();
    assert!(found.history.windows(2).all(|pair| pair[1].value < pair[0].value));
    found
}

/// How far the points of level curves, taken to a plane, are from the straight lines between their ends, at most.
fn bend(mesh: &TriangleMesh, values: &[f64], count: usize, unrolled: impl Fn(DVec3) -> DVec2) -> f64 {
    let top = values.iter().copied().fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    let mut curve_count = 0;
    for k in 0..count {
        for curve in level_curves(mesh, values, top * (k as f64 + 0.5) / count as f64).unwrap() {
            let points: Vec<DVec2> = curve.positions().into_iter().map(&unrolled).collect();
            if let ([first, .., last], false) = (&points[..], curve.is_closed) {
                let across = (*last - *first).normalize().perp();
                worst = points.iter().map(|p| across.dot(*p - *first).abs()).fold(worst, f64::max);
                curve_count += 1;
            }
        }
    }
    assert!(curve_count >= count);
    worst
}

fn helicoid(n: usize) -> (TriangleMesh, Field) {
    surface(
        n,
        [[0.5, 1.5], [0.0, 1.5]],
        |u, v| DVec3::new(u * v.cos(), u * v.sin(), 0.8 * v),
        |_, v| DVec3::new(v.cos(), v.sin(), 0.0),
    )
}

#[test]
fn orthogonal_trajectories_of_a_helicoids_lines_are_at_constant_radius() {
    let error = |n: usize| {
        let (mesh, field) = helicoid(n);
        let found = solve(&mesh, &field, LevelWeights::ORTHOGONAL);
        assert!(found.stop.is_none() && found.history.is_empty() && found.critical.is_empty());
        let apart: Vec<f64> = found.values.iter().zip(mesh.points()).map(|(f, p)| f - p.x.hypot(p.y)).collect();
        let mean = apart.iter().sum::<f64>() / apart.len() as f64;
        apart.iter().map(|apart| (apart - mean).abs()).fold(0.0, f64::max)
    };
    // By a factor of 4 for half the edges.
    for (found, expected) in [11, 21, 41].map(error).into_iter().zip([2.0e-3, 5.5e-4, 1.45e-4]) {
        assert!((found / expected - 1.0).abs() < 0.3, "{found} for {expected}");
    }
}

#[test]
fn geodesic_level_curves_of_a_plane_are_straight() {
    let slope = |_: f64, v: f64| DVec3::new(1.0, 0.6 * (v - 0.5), 0.0);
    let (mesh, field) = surface(21, [[0.0, 1.0]; 2], |u, v| DVec3::new(u, v, 0.0), slope);
    let before = bend(&mesh, &solve(&mesh, &field, LevelWeights::ORTHOGONAL).values, 9, DVec3::truncate);
    let found = solve(&mesh, &field, LevelWeights::GEODESIC);
    let after = bend(&mesh, &found.values, 9, DVec3::truncate);
    assert!(before > 0.07 && after < 1e-3, "{before} {after}");
    assert!(found.slope[0] > 0.8 && found.slope[1] < 1.2 && found.history.len() < 20);
}

#[test]
fn geodesic_level_curves_of_a_cylinder_unroll_to_lines() {
    let error = |n: usize| {
        let point = |u: f64, v: f64| DVec3::new(u.cos(), u.sin(), v);
        let along = |u: f64, v: f64| DVec3::new(-u.sin(), u.cos(), 0.4 + 0.4 * (v - 0.5));
        let (mesh, field) = surface(n, [[0.0, 1.0]; 2], point, along);
        let found = solve(&mesh, &field, LevelWeights::GEODESIC);
        bend(&mesh, &found.values, 9, |p| DVec2::new(p.y.atan2(p.x), p.z))
    };
    // These geodesics spread, so that f is not linear; what is left is the second order of its gradients: 2.7e-4 with 81 points.
    let (coarse, fine) = (error(21), error(41));
    assert!(fine < 1.5e-3 && coarse / fine > 3.0, "{coarse} {fine}");
}

#[test]
fn helices_of_a_cylinder_are_found_to_its_chords() {
    // A field of one slope is the gradient of a linear function on the unrolled cylinder: its level curves are straight there.
    let point = |u: f64, v: f64| DVec3::new(u.cos(), u.sin(), v);
    let (mesh, field) = surface(21, [[0.0, 1.0]; 2], point, |u, _| DVec3::new(-u.sin(), u.cos(), 0.4));
    let found = solve(&mesh, &field, LevelWeights::GEODESIC);
    assert!(bend(&mesh, &found.values, 9, |p| DVec2::new(p.y.atan2(p.x), p.z)) < 1e-5);
}

#[test]
fn bent_level_curves_of_a_plane_become_straight() {
    // From f = x + 0.3 (y − ½)², with the constant field as an anchor: f = x has neither term.
    let (mesh, _) = surface(21, [[0.0, 1.0]; 2], |u, v| DVec3::new(u, v, 0.0), |_, _| DVec3::X);
    let start: Vec<f64> = mesh.points().iter().map(|p| p.x + 0.3 * (p.y - 0.5).powi(2)).collect();
    let weights =
        TermWeights { orthogonal: 1e-2, direction: 0.0, equidistant: 0.0, geodesic: 1.0, conoidal: 0.0, laplace: 0.0 };
    let jumps = Jumps::default();
    let mut terms = Terms::new(&mesh, vec![Some(DVec3::X); mesh.triangles().len()], &jumps, weights, false);
    terms.prepare_bending(&start, None, &jumps);
    let options =
        gauss_newton::Options { relative_decrease: 1e-12, max_iterations: 30, value: 1e-20, ..Default::default() };
    let found = gauss_newton::minimise(&mut terms, &start, &options, &mut on).unwrap();
    let [before, after] = [&start, &found.x].map(|values| bend(&mesh, values, 9, DVec3::truncate));
    assert!(before > 0.07 && after < 1e-6 && found.history.len() <= 20, "{before} {after} {}", found.history.len());
}

#[test]
fn meridians_of_a_hyperboloid_are_geodesics() {
    let point = |u: f64, v: f64| DVec3::new(v.cosh() * u.cos(), v.cosh() * u.sin(), v.sinh());
    let around = |u: f64, _: f64| DVec3::new(-u.sin(), u.cos(), 0.0);
    let (mesh, field) = surface(41, [[0.0, 1.2], [-0.6, 0.6]], point, around);
    let error = |weights| {
        let found = solve(&mesh, &field, weights);
        let top = found.values.iter().copied().fold(0.0, f64::max);
        let mut worst: f64 = 0.0;
        for k in 0..9 {
            for curve in level_curves(&mesh, &found.values, top * (k as f64 + 0.5) / 9.0).unwrap() {
                let angles: Vec<f64> = curve.positions().iter().map(|p| p.y.atan2(p.x)).collect();
                let mean = angles.iter().sum::<f64>() / angles.len() as f64;
                worst = angles.iter().map(|a| (a - mean).abs()).fold(worst, f64::max);
            }
        }
        worst
    };
    let (before, after) = (error(LevelWeights::ORTHOGONAL), error(LevelWeights::GEODESIC));
    assert!(before > 0.01 && after < 1e-3, "{before} {after}");
}

#[test]
fn distances_from_a_seed_curve_have_gradients_of_length_one() {
    // Only linear functions have gradients of length 1 on all triangles of a flat mesh: that is what is found where nothing else is
    // asked for, although the field is another.
    let slope = |_: f64, v: f64| DVec3::new(1.0, 0.3 * (v - 0.5), 0.0);
    let (mesh, field) = surface(21, [[0.0, 1.0]; 2], |u, v| DVec3::new(u, v, 0.0), slope);
    let found = solve(&mesh, &field, LevelWeights { orthogonal: 0.0, ..LevelWeights::EQUIDISTANT });
    assert!(found.slope.iter().all(|slope| (slope - 1.0).abs() < 1e-6), "{:?}", found.slope);
    assert!(matches!(found.stop, Some(Stop::Value | Stop::Decrease | Stop::LineSearch)));
    // The distance from a circle has them up to what triangles are apart from it.
    let error = |n: usize| {
        let radial = |_: f64, v: f64| DVec3::new(v.cos(), v.sin(), 0.0);
        let (mesh, field) = surface(n, [[0.5, 1.5], [0.0, 1.0]], |u, v| u * radial(u, v), radial);
        let found = solve(&mesh, &field, LevelWeights::EQUIDISTANT);
        (found.slope[1] - 1.0).max(1.0 - found.slope[0])
    };
    let (coarse, fine) = (error(21), error(41));
    assert!(fine < 1e-3 && coarse / fine > 1.3, "{coarse} {fine}");
}

#[test]
fn a_field_that_changes_its_sign_has_level_curves_across_it() {
    // The field along x, turned around beyond a line: a ridge of f.
    let beyond = |u: f64, _: f64| u > 0.72;
    let along = |u: f64, v: f64| if beyond(u, v) { DVec3::NEG_X } else { DVec3::X };
    let (mesh, field) = surface(21, [[0.0, 1.0]; 2], |u, v| DVec3::new(u, v, 0.0), along);
    let is_beyond = |i: u32| field.directions()[i as usize].x < 0.0;
    let flips: Vec<[u32; 2]> = mesh.edges().into_iter().filter(|&[a, b]| is_beyond(a) != is_beyond(b)).collect();
    let options = LevelOptions { flips: flips.clone(), ..with(LevelWeights::EQUIDISTANT) };
    let found = level_function(&mesh, &field, &options, &mut on).unwrap();
    let is_cut = |t: usize| {
        mesh.triangles()[t].iter().any(|&i| is_beyond(i)) && mesh.triangles()[t].iter().any(|&i| !is_beyond(i))
    };
    for t in (0..mesh.triangles().len()).filter(|&t| !is_cut(t)) {
        let (g, middle) = (gradient_on(&mesh, &found.values, t), mesh.corners(t).iter().sum::<DVec3>() / 3.0);
        if (middle.x - 0.72).abs() > 0.15 {
            assert!(g.y.abs() < 0.1 && (g.length() - 1.0).abs() < 0.1, "{middle} {g}");
        }
    }
    let refused =
        |options: &LevelOptions| level_function(&mesh, &field, options, &mut on).unwrap_err().place().to_owned();
    assert_eq!(refused(&LevelOptions { flips: flips.clone(), ..Default::default() }), "options.weights.equidistant");
    assert_eq!(refused(&LevelOptions { flips: vec![[0, 440]], ..options }), "options.flips[0]");
}

#[test]
fn where_the_field_is_not_known_the_rest_takes_no_notice() {
    let (mesh, field) = helicoid(21);
    let mut directions = field.directions().to_vec();
    let is_known: Vec<bool> = mesh.points().iter().map(|p| p.distance(mesh.points()[210]) > 0.2).collect();
    directions.iter_mut().zip(&is_known).filter(|(_, is_known)| !**is_known).for_each(|(a, _)| *a = DVec3::NEG_Y);
    let field = Field::new(&mesh, directions, is_known).unwrap();
    for weights in [LevelWeights::ORTHOGONAL, LevelWeights::EQUIDISTANT] {
        let found = solve(&mesh, &field, weights);
        let apart: Vec<f64> = found.values.iter().zip(mesh.points()).map(|(f, p)| f - p.x.hypot(p.y)).collect();
        let spread = |apart: &[f64]| {
            apart.iter().copied().fold(f64::MIN, f64::max) - apart.iter().copied().fold(f64::MAX, f64::min)
        };
        let known: Vec<f64> = (0..441).filter(|&i| field.is_known()[i]).map(|i| apart[i]).collect();
        assert!(spread(&apart) < 0.03 && spread(&known) < 3e-3, "{} {}", spread(&apart), spread(&known));
    }
    let nowhere = Field::new(&mesh, vec![DVec3::ZERO; 441], vec![false; 441]).unwrap();
    let error = level_function(&mesh, &nowhere, &LevelOptions::default(), &mut on).unwrap_err();
    assert_eq!((error.status(), error.place()), (Status::CurvatureSign, "field"));
}

#[test]
fn size_does_not_matter_bad_weights_are_named_and_a_run_can_be_ended() {
    let scaled = |size: f64| {
        let (mesh, field) = catenoid(11, [0.2, 1.2], 1.0);
        let points = mesh.points().iter().map(|&p| size * p).collect();
        let faces = mesh.triangles().iter().map(|t| t.to_vec()).collect();
        (TriangleMesh::new(&crate::mesh::Mesh { points, faces }).unwrap(), field)
    };
    let weights = LevelWeights { equidistant: 0.1, geodesic: 0.5, ..LevelWeights::CONOIDAL };
    let (mesh, field) = scaled(1.0);
    let unit = solve(&mesh, &field, weights);
    for size in [1e-6, 1e6] {
        let (mesh, field) = scaled(size);
        let found = solve(&mesh, &field, weights);
        assert!(found.values.iter().zip(&unit.values).all(|(a, b)| (a / size - b).abs() < 1e-3), "{size}");
    }
    let refused = |weights| level_function(&mesh, &field, &with(weights), &mut on).unwrap_err().place().to_owned();
    let ok = LevelWeights::ORTHOGONAL;
    assert_eq!(refused(LevelWeights { orthogonal: 0.0, ..ok }), "options.weights");
    assert_eq!(refused(LevelWeights { orthogonal: 0.0, geodesic: 1.0, ..ok }), "options.weights");
    assert_eq!(refused(LevelWeights { geodesic: -1.0, ..ok }), "options.weights.geodesic");
    assert_eq!(refused(LevelWeights { laplace: f64::NAN, ..ok }), "options.weights.laplace");
    let ended = level_function(&mesh, &field, &with(weights), &mut |progress| {
        if progress.iteration == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let ended = ended.unwrap();
    assert_eq!((ended.stop, ended.history.len()), (Some(Stop::Cancelled), 3));
    assert!(ended.history[2].value < ended.history[0].value && ended.values.iter().all(|f| f.is_finite()));
}

fn catenoid(n: usize, u: [f64; 2], sign: f64) -> (TriangleMesh, Field) {
    let point = |u: f64, v: f64| DVec3::new(u.cosh() * v.cos(), u.cosh() * v.sin(), u);
    let along = move |u: f64, v: f64| {
        let first = DVec3::new(u.sinh() * v.cos(), u.sinh() * v.sin(), 1.0);
        first + sign * u.cosh() * DVec3::new(-v.sin(), v.cos(), 0.0)
    };
    surface(n, [u, [0.0, 1.5]], point, along)
}

#[test]
fn images_of_ruled_surfaces_collapse_and_others_may_fold() {
    let report = |(mesh, field): &(TriangleMesh, Field)| *SphericalImage::new(mesh, field).unwrap().report();
    for n in [21, 41] {
        let around = |t: f64| DVec3::new((0.5 + t).cos(), (0.5 + t).sin(), 0.0);
        let conoid =
            surface(n, [[0.5, 1.5], [0.0, 1.2]], |s, t| s * around(t) + (t + 0.1 * t * t) * DVec3::Z, |_, t| around(t));
        let found = report(&conoid);
        assert_eq!(found.kind, ImageKind::GreatCircle);
        assert!(found.extent < 1e-9 && found.axis.cross(DVec3::Z).length() < 1e-9 && found.flatness < 1e-9);
        // Its strips are conoidal anyway: the term is left out.
        let (mesh, field) = &conoid;
        let levels = solve(mesh, field, LevelWeights::CONOIDAL);
        assert!(levels.image.is_some_and(|image| image.kind == ImageKind::GreatCircle) && levels.stop.is_none());
        // With the directions that are found from the mesh.
        let found = AsymptoticDirections::new(mesh, &asymptotic::Options::default()).unwrap();
        let kinds = [0, 1].map(|family| {
            let oriented = found.orient(mesh, family, &orientation::Options::default()).unwrap();
            *SphericalImage::new(mesh, &oriented.field).unwrap().report()
        });
        let conoidal = kinds.iter().find(|image| image.kind == ImageKind::GreatCircle).unwrap();
        assert!(conoidal.axis.cross(DVec3::Z).length() < 1e-3);
        let saddle = surface(n, [[-1.0, 1.0]; 2], |x, y| DVec3::new(x, y, x * y), |_, y| DVec3::new(1.0, 0.0, y));
        assert_eq!(report(&saddle).kind, ImageKind::GreatCircle);
        assert!(report(&saddle).axis.cross(DVec3::Y).length() < 1e-9);
        let line = |u: f64, _: f64| DVec3::new(-u.sin(), u.cos(), 1.0);
        let hyperboloid =
            surface(n, [[0.0, 1.2], [-0.6, 0.6]], |u, v| DVec3::new(u.cos(), u.sin(), 0.0) + v * line(u, v), line);
        assert_eq!(report(&hyperboloid).kind, ImageKind::Curve);
        for sign in [1.0, -1.0] {
            let found = report(&catenoid(n, [0.2, 1.2], sign));
            assert!(found.kind == ImageKind::Regular && found.folded == 0.0 && found.extent > 0.3);
            let (mesh, field) = catenoid(n, [-1.0, 1.0], sign);
            let found = report(&(mesh.clone(), field.clone()));
            // Symmetric about the waist, where it is folded.
            assert!(found.kind == ImageKind::Folded && (found.folded - 0.5).abs() < 1e-3);
            let error = level_function(&mesh, &field, &with(LevelWeights::CONOIDAL), &mut on).unwrap_err();
            assert_eq!((error.status(), error.place()), (Status::NotOrientable, "field"));
            let forced = LevelOptions { allows_folds: true, max_iterations: 3, ..with(LevelWeights::CONOIDAL) };
            assert!(level_function(&mesh, &field, &forced, &mut on).is_ok());
        }
    }
}

#[test]
fn great_circles_are_where_the_field_is_orthogonal_to_their_axes() {
    let (mesh, field) = catenoid(41, [0.2, 1.2], 1.0);
    let axis = DVec3::new(0.3, -0.5, 0.7);
    let curves = great_circle(&mesh, &field, axis).unwrap();
    let points: Vec<SurfacePoint> = curves.iter().flat_map(|curve| curve.points.iter().map(|p| p.at)).collect();
    let found = Axis::of_points(&mesh, &field, &points).unwrap();
    assert!(points.len() > 20 && found.direction.cross(axis.normalize()).length() < 1e-12 && found.error < 1e-12);
    let refused = |axis| great_circle(&mesh, &field, axis).map(|_| ()).unwrap_err().status();
    assert_eq!(refused(DVec3::ZERO), Status::InvalidValue);
    // Half of the directions' range: nowhere orthogonal to one in their middle.
    let middle: DVec3 = field.directions().iter().sum();
    assert_eq!(refused(middle), Status::NoIntersection);
    // Axes of the level curves of a conoidal function, chosen by hand: boundaries near them, in either order.
    let levels = solve(&mesh, &field, LevelWeights::CONOIDAL).values;
    let top = levels.iter().copied().fold(0.0, f64::max);
    let axis = |k: usize| {
        let curves = level_curves(&mesh, &levels, top * k as f64 / 10.0).unwrap();
        let at: Vec<SurfacePoint> = curves[0].points.iter().map(|p| p.at).collect();
        Axis::of_points(&mesh, &field, &at).unwrap().direction
    };
    let axes = [4, 5, 6].map(axis);
    let options = BoundaryOptions::default();
    let found = great_circle_boundaries(&mesh, &field, &axes, &options).unwrap();
    assert_eq!((found.boundaries.len(), found.strips.len()), (5, 4));
    for (boundary, axis) in found.boundaries[1..4].iter().zip(axes) {
        let at: Vec<SurfacePoint> = boundary.on_surface.iter().copied().flatten().collect();
        assert!(Axis::of_points(&mesh, &field, &at).unwrap().direction.cross(axis).length() < 1e-9);
    }
    let back = great_circle_boundaries(&mesh, &field, &[axes[2], axes[1], axes[0]], &options).unwrap();
    assert_eq!(back.boundaries[2].points, found.boundaries[2].points);
    let error = great_circle_boundaries(&mesh, &field, &[axes[0], axes[2], axes[1]], &options).unwrap_err();
    assert_eq!((error.status(), error.place()), (Status::Infeasible, "axes[2]"));
    let error = great_circle_boundaries(&mesh, &field, &[axes[0], DVec3::NAN], &options).unwrap_err();
    assert_eq!((error.status(), error.place()), (Status::InvalidValue, "axes[1]"));
}

fn conoidality(mesh: &TriangleMesh, field: &Field, values: &[f64]) -> f64 {
    let top = values.iter().copied().fold(0.0, f64::max);
    let (mut sum, mut count) = (0.0, 0);
    for k in 1..10 {
        for curve in level_curves(mesh, values, top * k as f64 / 10.0).unwrap() {
            if curve.length() < 0.3 {
                continue;
            }
            let points: Vec<SurfacePoint> = curve.points.iter().map(|p| p.at).collect();
            sum += Axis::of_points(mesh, field, &points).unwrap().error.powi(2);
            count += 1;
        }
    }
    (sum / count as f64).sqrt()
}

#[test]
fn conoidal_level_curves_of_a_catenoid_have_axes() {
    for (n, least) in [(21, 30.0), (41, 60.0)] {
        let (mesh, field) = catenoid(n, [0.2, 1.2], 1.0);
        let before = conoidality(&mesh, &field, &solve(&mesh, &field, LevelWeights::ORTHOGONAL).values);
        let found = solve(&mesh, &field, LevelWeights::CONOIDAL);
        let after = conoidality(&mesh, &field, &found.values);
        assert!(before > 0.02 && before / after > least, "{before} {after}");
        assert!(found.critical.is_empty());
    }
}

#[test]
fn any_number_of_threads_finds_the_same_bits() {
    let (mesh, field) = catenoid(51, [0.2, 1.2], 1.0);
    let weights = LevelWeights { geodesic: 0.3, ..LevelWeights::EQUIDISTANT };
    let with_threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| solve(&mesh, &field, weights).values)
    };
    assert_eq!(with_threads(1), with_threads(3));
}
