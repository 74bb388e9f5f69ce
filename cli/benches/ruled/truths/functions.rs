//! Level functions and level curves of surfaces on which they are known.

use std::f64::consts::{SQRT_2, TAU};
use std::ops::ControlFlow;

use anyhow::Result;
use glam::{DVec2, DVec3};
use shapeop::geometry::ruled::Field;
use shapeop::geometry::ruled::boundaries::BoundaryOptions;
use shapeop::geometry::ruled::level_function::{LevelFunction, LevelOptions, LevelWeights, level_function};
use shapeop::geometry::ruled::periods::{Spacing, periodic_boundaries};
use shapeop::mesh::TriangleMesh;
use shapeop::mesh::level_curves::level_curves;
use shapeop::mesh::patterns::parametric_surface;

use super::{about, largest};
use crate::group::Group;
use crate::shapes::{free_form, tube};

/// `n` by `n` points of a surface, and the field of unit vectors along given ones.
pub fn surface(
    n: usize,
    [u, v]: [[f64; 2]; 2],
    point: impl Fn(f64, f64) -> DVec3,
    along: impl Fn(f64, f64) -> DVec3,
) -> Result<(TriangleMesh, Field)> {
    let mesh = TriangleMesh::new(&parametric_surface(n, n, u, v, point)?)?;
    let directions = parametric_surface(n, n, u, v, |u, v| along(u, v).normalize())?.points;
    let count = directions.len();
    let field = Field::new(&mesh, directions, vec![true; count])?;
    Ok((mesh, field))
}

pub fn solve((mesh, field): &(TriangleMesh, Field), weights: LevelWeights) -> Result<LevelFunction> {
    let options = LevelOptions { weights, ..LevelOptions::default() };
    Ok(level_function(mesh, field, &options, &mut |_| ControlFlow::Continue(()))?)
}

/// The points of nine level curves, each on its own.
fn nine(mesh: &TriangleMesh, values: &[f64]) -> Result<Vec<Vec<DVec3>>> {
    let top = largest(values.iter().copied());
    let mut curves = Vec::new();
    for k in 0..9 {
        curves.extend(
            level_curves(mesh, values, top * (f64::from(k) + 0.5) / 9.0)?.iter().map(|curve| curve.positions()),
        );
    }
    Ok(curves)
}

/// How far level curves, taken to a plane, are from the straight lines between their ends, each on its own.
fn bends(mesh: &TriangleMesh, values: &[f64], unrolled: impl Fn(DVec3) -> DVec2) -> Result<Vec<f64>> {
    let off = |curve: &Vec<DVec3>| {
        let points: Vec<DVec2> = curve.iter().map(|p| unrolled(*p)).collect();
        let (first, last) = (points[0], points[points.len() - 1]);
        let across = (last - first).normalize_or_zero().perp();
        largest(points.iter().map(|p| across.dot(*p - first).abs()))
    };
    Ok(nine(mesh, values)?.iter().map(off).collect())
}

/// The largest of [`bends`].
fn bend(mesh: &TriangleMesh, values: &[f64], unrolled: impl Fn(DVec3) -> DVec2) -> Result<f64> {
    Ok(largest(bends(mesh, values, unrolled)?.into_iter()))
}

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: level functions and level curves",
        "On surfaces where the function, or what its level curves are, is known; fields are exact.",
    );
    helicoid(&mut group)?;
    geodesics(&mut group)?;
    equidistant(&mut group)?;
    curves(&mut group)?;
    tubes(&mut group)?;
    Ok(group)
}

fn helicoid(group: &mut Group) -> Result<()> {
    let mut last = None;
    for (n, expected) in [(11, 2.3e-3), (21, 5.6e-4), (41, 1.4e-4)] {
        let point = |u: f64, v: f64| DVec3::new(u * v.cos(), u * v.sin(), 0.8 * v);
        let it = surface(n, [[0.5, 1.5], [0.0, 1.5]], point, |_, v| DVec3::new(v.cos(), v.sin(), 0.0))?;
        let found = solve(&it, LevelWeights::ORTHOGONAL)?;
        let apart: Vec<f64> = found.values.iter().zip(it.0.points()).map(|(f, p)| f - p.x.hypot(p.y)).collect();
        let mean = apart.iter().sum::<f64>() / apart.len() as f64;
        let error = largest(apart.iter().map(|apart| (apart - mean).abs()));
        about(group, &format!("helicoid, {n} by {n}: orthogonal f off u + constant"), error, expected, 0.3);
        if let Some(last) = last {
            about(group, &format!("helicoid, {n} by {n}: by how much it fell"), last / error, 4.0, 0.15);
        }
        last = Some(error);
    }
    Ok(())
}

fn geodesics(group: &mut Group) -> Result<()> {
    let slope = |_: f64, v: f64| DVec3::new(1.0, 0.6 * (v - 0.5), 0.0);
    let plane = surface(21, [[0.0, 1.0]; 2], |u, v| DVec3::new(u, v, 0.0), slope)?;
    let before = bend(&plane.0, &solve(&plane, LevelWeights::ORTHOGONAL)?.values, DVec3::truncate)?;
    group.plain("plane: level curves off lines, orthogonal", before);
    let usual = solve(&plane, LevelWeights::GEODESIC)?;
    group.plain("plane: the same, geodesic with its usual weights", bend(&plane.0, &usual.values, DVec3::truncate)?);
    // The orthogonal term draws towards a field that is not that of lines; what is off is in proportion to its weight.
    let anchored = LevelWeights { orthogonal: 1e-5, ..LevelWeights::GEODESIC };
    let found = bends(&plane.0, &solve(&plane, anchored)?.values, DVec3::truncate)?;
    // No divergence is asked for at the rim: curves within an edge of it are freer.
    group.plain("plane: the same, orthogonal weight 1e-5", largest(found.iter().copied()));
    group.at_most("plane: the same, curves more than an edge off the rim", largest(found[1..8].iter().copied()), 1e-6);
    let both = LevelWeights { orthogonal: 0.0, equidistant: 1.0, ..LevelWeights::GEODESIC };
    let lines = bend(&plane.0, &solve(&plane, both)?.values, DVec3::truncate)?;
    group.at_most("plane: the same, geodesic and equidistant", lines, 1e-6);
    for n in [21, 41, 81] {
        let point = |u: f64, v: f64| DVec3::new(u.cos(), u.sin(), v);
        let along = |u: f64, v: f64| DVec3::new(-u.sin(), u.cos(), 0.4 + 0.4 * (v - 0.5));
        let cylinder = surface(n, [[0.0, 1.0]; 2], point, along)?;
        let off = bend(&cylinder.0, &solve(&cylinder, anchored)?.values, |p| DVec2::new(p.y.atan2(p.x), p.z))?;
        let what = format!("cylinder, {n} by {n}: unrolled level curves off lines");
        if n == 81 {
            group.at_most(&what, off, 1e-3)
        } else {
            group.plain(&what, off)
        };
    }

    let point = |u: f64, v: f64| DVec3::new(v.cosh() * u.cos(), v.cosh() * u.sin(), v.sinh());
    let around = |u: f64, _: f64| DVec3::new(-u.sin(), u.cos(), 0.0);
    let hyperboloid = surface(41, [[0.0, 1.2], [-0.6, 0.6]], point, around)?;
    let off = |weights| -> Result<f64> {
        let off = |curve: &Vec<DVec3>| {
            let angles: Vec<f64> = curve.iter().map(|p| p.y.atan2(p.x)).collect();
            let mean = angles.iter().sum::<f64>() / angles.len() as f64;
            largest(angles.iter().map(|a| (a - mean).abs()))
        };
        Ok(largest(nine(&hyperboloid.0, &solve(&hyperboloid, weights)?.values)?.iter().map(off)))
    };
    group.plain("hyperboloid: level curves off meridians, orthogonal", off(LevelWeights::ORTHOGONAL)?);
    group.at_most("hyperboloid: the same, geodesic, radians", off(LevelWeights::GEODESIC)?, 1e-3);
    Ok(())
}

fn equidistant(group: &mut Group) -> Result<()> {
    let slope = |_: f64, v: f64| DVec3::new(1.0, 0.3 * (v - 0.5), 0.0);
    let plane = surface(21, [[0.0, 1.0]; 2], |u, v| DVec3::new(u, v, 0.0), slope)?;
    let found = solve(&plane, LevelWeights { orthogonal: 0.0, ..LevelWeights::EQUIDISTANT })?;
    let off = found.slope.map(|slope| (slope - 1.0).abs());
    group.at_most("plane: length of the gradient off 1, equidistant", off[0].max(off[1]), 1e-6);
    for n in [21, 41] {
        let radial = |_: f64, v: f64| DVec3::new(v.cos(), v.sin(), 0.0);
        let ring = surface(n, [[0.5, 1.5], [0.0, 1.0]], |u, v| u * radial(u, v), radial)?;
        let slope = solve(&ring, LevelWeights::EQUIDISTANT)?.slope;
        let what = format!("distance from a circle, {n} by {n}: length off 1");
        group.plain(&what, (slope[1] - 1.0).max(1.0 - slope[0]));
    }
    Ok(())
}

fn curves(group: &mut Group) -> Result<()> {
    let mesh = TriangleMesh::new(&free_form(0.1, [1.0, 0.8]).mesh(41, 33)?)?;
    let normal = DVec3::new(0.3, -0.5, 0.7).normalize();
    let heights: Vec<f64> = mesh.points().iter().map(|p| normal.dot(*p)).collect();
    let mut off = 0.0_f64;
    for k in -4..5 {
        let level = 0.1 * f64::from(k) + 0.013;
        let points = level_curves(&mesh, &heights, level)?.into_iter().flat_map(|curve| curve.positions());
        off = off.max(largest(points.map(|p| (normal.dot(p) - level).abs())));
    }
    group.at_most("free form: level curves of a linear function off planes", off, 1e-14);

    let (around, radius, count) = (96, 1.5, 9);
    let cylinder = tube(around, 25, |angle, part| DVec3::new(radius * angle.cos(), radius * angle.sin(), 2.0 * part))?;
    let mesh = TriangleMesh::new(&cylinder)?;
    let heights: Vec<f64> = mesh.points().iter().map(|p| p.z).collect();
    let edge = TAU * radius / around as f64;
    let (mut closed, mut off) = (0, 0.0_f64);
    for k in 0..count {
        let curves = level_curves(&mesh, &heights, 2.0 * (f64::from(k) + 0.5) / f64::from(count))?;
        closed += usize::from(curves.len() == 1 && curves[0].is_closed);
        off = off.max(largest(curves.iter().map(|curve| (curve.length() - TAU * radius).abs())));
    }
    group.between("cylinder: closed level curves, of 9", closed as f64, [9.0, 9.0]);
    group.at_most("cylinder: their lengths off 2πR, over the squared edge", off / (edge * edge), 1.0);
    Ok(())
}

/// A whole catenoid between two heights, with one family of its asymptotic directions, which cross its meridians at 45°.
fn catenoid(around: usize, rows: usize) -> Result<(TriangleMesh, Field)> {
    let at = |v: f64, part: f64| {
        let (u, radial) = (2.0 * part - 1.0, DVec3::new(v.cos(), v.sin(), 0.0));
        let along = (u.sinh() * radial + DVec3::Z) / u.cosh();
        (u.cosh() * radial + u * DVec3::Z, (along + DVec3::new(-v.sin(), v.cos(), 0.0)) / SQRT_2)
    };
    let mesh = TriangleMesh::new(&tube(around, rows, |v, part| at(v, part).0)?)?;
    let directions = tube(around, rows, |v, part| at(v, part).1)?.points;
    let count = directions.len();
    let field = Field::new(&mesh, directions, vec![true; count])?;
    Ok((mesh, field))
}

/// The unit chord that reaches so far to both sides of a point of a polyline, if that does: shorter ones are noise.
fn tangent(points: &[DVec3], k: usize, reach: f64) -> DVec3 {
    let is_far = |i: &usize| points[*i].distance(points[k]) >= reach;
    let before = (0..k).rev().find(is_far).unwrap_or(0);
    let after = (k..points.len()).find(is_far).unwrap_or(points.len() - 1);
    (points[after] - points[before]).normalize_or_zero()
}

fn tubes(group: &mut Group) -> Result<()> {
    let (mesh, field) = catenoid(192, 81)?;
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    let options = BoundaryOptions::default();
    let orthogonal = LevelOptions::default();
    let first = periodic_boundaries(&mesh, &field, &orthogonal, Spacing::Count(20), &options, go_on)?;
    // In the coordinates u, v the metric is cosh²u (du² + dv²) and a = cosh u (du + dv)/√2. With p the slope of f around,
    // ∫ (p − cosh u/√2)² du dv is least for p = sinh 1/√2.
    let expected = TAU * 1_f64.sinh() / SQRT_2;
    about(group, "catenoid tube: jump of f around it", first.cuts[0].found.abs(), expected, 2e-3);
    let direction = LevelOptions { weights: LevelWeights::DIRECTION, ..LevelOptions::default() };
    let jump = periodic_boundaries(&mesh, &field, &direction, Spacing::Count(20), &options, go_on)?.cuts[0].found.abs();
    for (name, spacing) in [("20 levels", Spacing::Count(20)), ("a jump of 20.4 levels", Spacing::Width(jump / 20.4))] {
        let found = periodic_boundaries(&mesh, &field, &direction, spacing, &options, go_on)?;
        let mut worst = 0.0_f64;
        for boundary in &found.boundaries.boundaries {
            for (k, at) in boundary.on_surface.iter().enumerate().filter_map(|(k, at)| Some((k, (*at)?))) {
                let Some(a) = field.at(&mesh, at.triangle as usize, at.weights) else { continue };
                worst =
                    worst.max(tangent(&boundary.points, k, 0.5 * mesh.mean_edge()).dot(a).abs().asin().to_degrees());
            }
        }
        let curves = &found.boundaries.boundaries;
        let count = curves.iter().filter(|it| found.is_cyclic && !it.is_closed).count();
        group.between(&format!("catenoid tube, {name}: boundaries, in a ring"), count as f64, [20.0, 20.0]);
        group.at_most(&format!("catenoid tube, {name}: degrees off right angles"), worst, 1.0);
    }
    let point = |p: &DVec3| DVec3::new(p.x, p.y, 0.0).normalize();
    let up: Vec<DVec3> = mesh.points().iter().map(|p| (p.z.sinh() * point(p) + DVec3::Z) / p.z.cosh()).collect();
    let upright = Field::new(&mesh, up, vec![true; mesh.points().len()])?;
    let found = periodic_boundaries(&mesh, &upright, &orthogonal, Spacing::Count(6), &options, go_on)?;
    let closed = found.boundaries.boundaries.iter().filter(|it| it.is_closed).count();
    group.between("catenoid tube, field along meridians: closed boundaries", closed as f64, [8.0, 8.0]);
    Ok(())
}
