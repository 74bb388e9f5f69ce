//! Level functions against surfaces on which they are known.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use glam::{DVec2, DVec3};

use super::Field;
use super::level_function::{LevelFunction, LevelOptions, LevelWeights, level_function};
use super::spherical_image::{Axis, ImageKind, SphericalImage, great_circle};
use crate::error::Status;
use crate::linalg::gauss_newton::{Progress, Stop};
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
    eprintln!("helicoid {:?}", [11, 21, 41].map(error));
}

#[test]
fn geodesic_level_curves_of_a_plane_are_straight() {
    let slope = |u: f64, v: f64| DVec3::new(1.0, 0.6 * (v - 0.5), 0.0 * u);
    let (mesh, field) = surface(21, [[0.0, 1.0]; 2], |u, v| DVec3::new(u, v, 0.0), slope);
    for o in [0.05, 1e-2, 1e-4, 1e-6, 1e-8] {
        let weights = LevelWeights { orthogonal: o, ..LevelWeights::GEODESIC };
        let found = solve(&mesh, &field, weights);
        eprintln!(
            "plane {o} {} {:?} {} {:?} {}",
            bend(&mesh, &found.values, 9, |p| p.truncate()),
            found.slope,
            found.history.len(),
            found.stop,
            found.history.last().unwrap().value
        );
        let weights = LevelWeights { laplace: 0.0, ..weights };
        let found = solve(&mesh, &field, weights);
        eprintln!(
            "   no laplace {o} {} {:?} {} {:?} {}",
            bend(&mesh, &found.values, 9, |p| p.truncate()),
            found.slope,
            found.history.len(),
            found.stop,
            found.history.last().unwrap().value
        );
    }
    let before = solve(&mesh, &field, LevelWeights::ORTHOGONAL);
    eprintln!("before {}", bend(&mesh, &before.values, 9, |p| p.truncate()));
}

#[test]
fn geodesic_level_curves_of_a_cylinder_unroll_to_lines() {
    for n in [21, 41] {
        let point = |u: f64, v: f64| DVec3::new(u.cos(), u.sin(), v);
        let along = |u: f64, v: f64| DVec3::new(-u.sin(), u.cos(), 0.4 + 0.4 * (v - 0.5));
        let (mesh, field) = surface(n, [[0.0, 1.0]; 2], point, along);
        for o in [0.05, 1e-2, 1e-4, 1e-6] {
            let weights = LevelWeights { orthogonal: o, ..LevelWeights::GEODESIC };
            let found = solve(&mesh, &field, weights);
            let u = |p: DVec3| DVec2::new(p.y.atan2(p.x), p.z);
            eprintln!(
                "cylinder {n} {o} {} {:?} {} {:?}",
                bend(&mesh, &found.values, 9, u),
                found.slope,
                found.history.len(),
                found.stop
            );
        }
    }
}

#[test]
fn meridians_of_a_hyperboloid_are_geodesics() {
    for n in [21, 41] {
        let point = |u: f64, v: f64| DVec3::new(v.cosh() * u.cos(), v.cosh() * u.sin(), v.sinh());
        let (mesh, field) = surface(n, [[0.0, 1.2], [-0.6, 0.6]], point, |u, _| DVec3::new(-u.sin(), u.cos(), 0.0));
        for w in [LevelWeights::ORTHOGONAL, LevelWeights::GEODESIC] {
            let found = solve(&mesh, &field, w);
            let top = found.values.iter().copied().fold(0.0, f64::max);
            let mut worst: f64 = 0.0;
            for k in 0..9 {
                for curve in level_curves(&mesh, &found.values, top * (k as f64 + 0.5) / 9.0).unwrap() {
                    let angles: Vec<f64> = curve.positions().iter().map(|p| p.y.atan2(p.x)).collect();
                    let mean = angles.iter().sum::<f64>() / angles.len() as f64;
                    worst = angles.iter().map(|a| (a - mean).abs()).fold(worst, f64::max);
                }
            }
            eprintln!(
                "hyperboloid {n} {worst} {:?} {:?}",
                found.slope,
                found.history.iter().map(|h| h.value).collect::<Vec<_>>()
            );
        }
    }
}

#[test]
fn distances_from_a_seed_curve_have_gradients_of_length_one() {
    for n in [11, 21, 41] {
        // From a straight seed, begun from a field that is not of constant length along its trajectories.
        for c in [0.0, 0.3] {
            let slope = |u: f64, v: f64| DVec3::new(1.0, c * (v - 0.5), 0.0 * u);
            let (mesh, field) = surface(n, [[0.0, 1.0]; 2], |u, v| DVec3::new(u, v, 0.0), slope);
            for (o, l) in [(0.1, 1e-3), (0.0, 1e-3), (0.0, 0.0), (1e-4, 1e-6)] {
                let found =
                    solve(&mesh, &field, LevelWeights { orthogonal: o, laplace: l, ..LevelWeights::EQUIDISTANT });
                eprintln!(
                    "seed {n} {c} {o} {l} {:?} {} {:?} {}",
                    found.slope,
                    found.history.len(),
                    found.stop,
                    found.history.last().unwrap().value
                );
            }
        }
        // circle
        let (mesh, field) = surface(
            n,
            [[0.5, 1.5], [0.0, 1.0]],
            |u, v| u * DVec3::new(v.cos(), v.sin(), 0.0),
            |_, v| DVec3::new(v.cos(), v.sin(), 0.0),
        );
        let found = solve(&mesh, &field, LevelWeights::EQUIDISTANT);
        eprintln!(
            "circle {n} {:?} {} {:?} {}",
            found.slope,
            found.history.len(),
            found.stop,
            found.history.last().unwrap().value
        );
    }
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
fn images_of_ruled_surfaces_collapse() {
    for n in [21, 41] {
        let (mesh, field) = surface(
            n,
            [[0.5, 1.5], [0.0, 1.2]],
            |s, t| DVec3::new(s * (0.5 + t).cos(), s * (0.5 + t).sin(), t + 0.1 * t * t),
            |_, t| DVec3::new((0.5 + t).cos(), (0.5 + t).sin(), 0.0),
        );
        eprintln!("conoid {n} {:?}", SphericalImage::new(&mesh, &field).unwrap().report());
        let (mesh, field) =
            surface(n, [[-1.0, 1.0]; 2], |x, y| DVec3::new(x, y, x * y), |_, y| DVec3::new(1.0, 0.0, y));
        eprintln!("saddle {n} {:?}", SphericalImage::new(&mesh, &field).unwrap().report());
        let (mesh, field) = surface(
            n,
            [[0.0, 1.2], [-0.6, 0.6]],
            |u, v| DVec3::new(u.cos() - v * u.sin(), u.sin() + v * u.cos(), v),
            |u, _| DVec3::new(-u.sin(), u.cos(), 1.0),
        );
        eprintln!("hyperboloid {n} {:?}", SphericalImage::new(&mesh, &field).unwrap().report());
        for u in [[0.2, 1.2], [-1.0, 1.0]] {
            for s in [1.0, -1.0] {
                let (mesh, field) = catenoid(n, u, s);
                eprintln!("catenoid {u:?} {s} {:?}", SphericalImage::new(&mesh, &field).unwrap().report());
            }
        }
    }
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
    for n in [21, 41] {
        let (mesh, field) = catenoid(n, [0.2, 1.2], 1.0);
        let before = solve(&mesh, &field, LevelWeights::ORTHOGONAL);
        let b = conoidality(&mesh, &field, &before.values);
        for o in [0.05, 1e-2, 1e-3, 1e-4, 1e-5] {
            for l in [1e-3, 1e-6, 0.0] {
                let after = solve(&mesh, &field, LevelWeights { orthogonal: o, laplace: l, ..LevelWeights::CONOIDAL });
                eprintln!(
                    "conoidal {n} {o} {l} {b} {} {:?} {:?} {} {:?}",
                    conoidality(&mesh, &field, &after.values),
                    after.slope,
                    after.stop,
                    after.history.len(),
                    after.critical.len()
                );
            }
        }
    }
}
