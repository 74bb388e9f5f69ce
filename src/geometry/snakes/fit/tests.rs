use super::*;
use crate::geometry::random::Random;
use crate::geometry::snakes::curvature_curve::{Course, Side, curvature_curve};
use crate::geometry::snakes::mesh_curve::mesh_curve;
use crate::mesh::TriangleMesh;
use crate::mesh::reference::{ParametricSurface, ReferenceMesh, ReferenceSurface};
use crate::mesh::surfaces::torus;

fn on(_: &Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// The curve of curvature 1.8 and length 3 on a torus.
fn curve() -> Vec<DVec3> {
    let surface = torus(2.0, 0.7);
    let everywhere = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
    let tangent = surface(0.1, 0.2).normal().cross(DVec3::new(0.3, 0.5, 1.0));
    let course = Course { curvature: &|_| 1.8, length: 3.0, side: Side::Left };
    let options = crate::geometry::snakes::curvature_curve::Options { steps: 600, ..Default::default() };
    curvature_curve(&surface, everywhere, [0.1, 0.2], tangent, &course, &options).unwrap().points
}

/// The largest distance of points from densely sampled arcs, to the sampling.
fn sampled_deviation(points: &[DVec3], snake: &Snake) -> f64 {
    let samples = snake.sample(2000);
    let nearest = |p: &DVec3| samples.iter().map(|s| s.distance(*p)).fold(f64::INFINITY, f64::min);
    points.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn more_arcs_are_nearer_to_a_curve_of_constant_curvature() {
    let points = curve();
    let mut deviations = Vec::new();
    for count in [4, 12, 24] {
        let found = fit(&points, count, &Options { curvature: Some(1.8), ..Options::default() }, &mut on).unwrap();
        assert!(found.snake.residual() <= 1e-12 && found.residual == found.snake.residual(), "{}", found.residual);
        let first = &found.snake.shapes()[0];
        assert!(found.snake.shapes().iter().all(|shape| shape == first) && (first.radius - 1.0 / 1.8).abs() < 1e-14);
        assert!((found.snake.length() - 3.0).abs() < 1e-6);
        let sampled = sampled_deviation(&points, &found.snake);
        assert!((found.deviation - sampled).abs() < 1e-4 * found.deviation + 1e-5, "{} {sampled}", found.deviation);
        deviations.push(found.deviation);
        // Without the curvature given, much the same comes out.
        let free = fit(&points, count, &Options { is_congruent: false, ..Options::default() }, &mut on).unwrap();
        assert!(
            (free.deviation - found.deviation).abs() < 2e-2 * found.deviation,
            "{} {}",
            free.deviation,
            found.deviation
        );
    }
    let ratios = [deviations[0] / deviations[1], deviations[1] / deviations[2]];
    assert!(ratios[0] >= 4.0 && ratios[1] >= 2.5, "{deviations:?} {ratios:?}");
}

#[test]
fn a_curve_on_a_mesh_is_fitted() {
    let surface = ParametricSurface::new([[-1.5, 1.5], [-2.0, 2.0]], [20, 20], torus(2.0, 0.7)).unwrap();
    let mesh = TriangleMesh::new(&surface.mesh(60, 60).unwrap()).unwrap();
    let course = Course { curvature: &|_| 1.8, length: 2.5, side: Side::Left };
    let jet = surface.at(0.1, 0.2);
    let tangent = jet.normal().cross(DVec3::new(0.3, 0.5, 1.0));
    let curve = mesh_curve(&ReferenceMesh::new(&mesh), jet.point, tangent, &course, &Default::default()).unwrap().curve;
    for options in [Options { curvature: Some(1.8), ..Options::default() }, Options::default()] {
        let found = fit(&curve.points, 12, &options, &mut on).unwrap();
        let shape = found.snake.shapes()[0];
        assert!((1.8 * shape.radius - 1.0).abs() < 0.01, "{}", shape.radius);
        assert!(found.residual <= 1e-12 && found.deviation < 5e-3, "{}", found.deviation);
        // The control points alone give the same arcs.
        let again = Snake::new(found.snake.control().to_vec(), false, None).unwrap();
        let apart = |a: &ArcShape| (a.radius - shape.radius).abs().max((a.length - shape.length).abs());
        assert!(again.shapes().iter().all(|a| apart(a) < 1e-10));
        // Contacts are near the surface.
        let reference = surface.nearest(found.snake.contacts()[6]);
        assert!(reference.point.distance(found.snake.contacts()[6]) < 5e-3);
    }
}

#[test]
fn one_arc_fits_its_circle_exactly() {
    let (x, y) = (DVec3::new(1.0, 2.0, 2.0) / 3.0, DVec3::new(2.0, 1.0, -2.0) / 3.0);
    for (scale, angle) in [(1.0, 2.0), (1e-3, 0.3), (1e3, 3.0)] {
        let at = |i: i32| {
            let (sine, cosine) = (angle * f64::from(i) / 40.0).sin_cos();
            scale * (DVec3::new(5.0, -1.0, 2.0) + 1.7 * (cosine * x + sine * y))
        };
        let points: Vec<DVec3> = (0..=40).map(at).collect();
        for count in [1, 3] {
            let found = fit(&points, count, &Options::default(), &mut on).unwrap();
            assert!(found.deviation < 1e-10 * scale && found.residual < 1e-12 * scale, "{} {count}", found.deviation);
            assert!((found.snake.shapes()[0].radius / scale - 1.7).abs() < 1e-11);
            assert!((found.snake.length() / scale - 1.7 * angle).abs() < 1e-11);
        }
    }
}

#[test]
fn a_spline_is_fitted_like_its_points() {
    use crate::mesh::curve::{Jet, Spline};
    // A helix of radius 1 and slope ½: the curvature is 1/(1 + ¼).
    struct Helix;
    impl Curve for Helix {
        fn range(&self) -> [f64; 2] {
            [0.0, 3.0]
        }
        fn is_closed(&self) -> bool {
            false
        }
        fn at(&self, t: f64) -> Jet {
            let (sine, cosine) = t.sin_cos();
            let [point, first, second] = [(cosine, sine, 0.5 * t), (-sine, cosine, 0.5), (-cosine, -sine, 0.0)];
            Jet { point: point.into(), first: first.into(), second: second.into() }
        }
    }
    let found = fit_curve(&Helix, 6, &Options::default(), &mut on).unwrap();
    assert!((found.snake.shapes()[0].radius - 1.25).abs() < 1e-4 && found.residual < 1e-13);
    assert!((found.snake.length() - 3.0 * 1.25_f64.sqrt()).abs() < 1e-5);
    // Arcs of 0.56 with the torsion of 0.4 between their middles are off by about κ τ L³ / 50.
    assert!(found.deviation < 5e-3, "{}", found.deviation);
    let closed = Spline::through(&[DVec3::X, DVec3::Y, DVec3::NEG_X], true).unwrap();
    let around = fit_curve(&closed, 7, &Options::default(), &mut on).unwrap();
    assert!(around.snake.is_closed() && around.residual < 1e-13 && around.deviation < 0.1, "{}", around.deviation);
}

#[test]
fn derivatives_are_those_of_the_residuals() {
    let points = curve();
    let samples = Samples::new(&points, false).unwrap();
    let shapes = shapes(&samples, 4, &Options::default()).unwrap();
    let snake = start(&samples, &shapes).unwrap();
    let problem = Fit::new(&snake, &samples, 0.3);
    let mut random = Random(3);
    let x: Vec<f64> = snake.control().iter().flat_map(|p| (*p + 0.1 * random.vector()).to_array()).collect();
    let direction: Vec<f64> = x.iter().map(|_| random.between(-1.0, 1.0)).collect();
    let values = |t: f64| {
        let moved: Vec<f64> = x.iter().zip(&direction).map(|(x, d)| x + t * d).collect();
        let mut values = Vec::new();
        problem.visit(&moved, |residual, _| values.push(residual));
        values
    };
    let mut slopes = Vec::new();
    problem.visit(&x, |_, terms| {
        slopes.push(terms.iter().map(|(i, v)| v.dot(DVec3::from_slice(&direction[3 * i..3 * i + 3]))).sum::<f64>());
    });
    let (after, before) = (values(1e-6), values(-1e-6));
    assert!(slopes.len() > 600);
    for (slope, (after, before)) in slopes.iter().zip(after.iter().zip(&before)) {
        assert!((slope - (after - before) / 2e-6).abs() < 1e-7 * slope.abs().max(0.1), "{slope}");
    }
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let circle = |count: i32, angle: f64| -> Vec<DVec3> {
        let at = |i: i32| DVec3::new((angle * f64::from(i)).cos(), (angle * f64::from(i)).sin(), 0.0);
        (0..count).map(at).collect()
    };
    let refused = |points: &[DVec3], count, options: &Options| {
        let error = fit(points, count, options, &mut on).unwrap_err();
        (error.status(), error.place().to_owned())
    };
    let default = Options::default();
    let around = circle(41, PI / 20.0);
    assert_eq!(refused(&around, 2, &default), (Status::InvalidValue, "arc_count".into()));
    assert!(fit(&around, 3, &default, &mut on).is_ok());
    assert_eq!(refused(&around, 0, &default).1, "arc_count");
    assert_eq!(refused(&around[..2], 3, &default), (Status::InvalidArgumentLength, "points".into()));
    assert_eq!(refused(&[DVec3::ZERO, DVec3::X, DVec3::X], 3, &default), (Status::Degenerate, "points[2]".into()));
    assert_eq!(refused(&[DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], 3, &default), (Status::Degenerate, "points".into()));
    assert_eq!(refused(&[DVec3::ZERO, DVec3::NAN, DVec3::X], 3, &default).1, "points[1]");
    assert_eq!(refused(&around, 3, &Options { nearness: 0.0, ..default }).1, "options.nearness");
    assert_eq!(refused(&around, 3, &Options { curvature: Some(-1.0), ..default }).1, "options.curvature");
}
