//! Spherical images, and boundaries of conoidal strips.

use std::ops::ControlFlow;

use anyhow::{Context, Result};
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::ruled::asymptotic::{AsymptoticDirections, Options};
use shapeop::geometry::ruled::level_function::{LevelOptions, LevelWeights, level_function};
use shapeop::geometry::ruled::orientation;
use shapeop::geometry::ruled::spherical_image::{ImageKind, SphericalImage};
use shapeop::geometry::ruled::{Axis, Field};
use shapeop::mesh::level_curves::level_curves;
use shapeop::mesh::{SurfacePoint, TriangleMesh};

use super::functions::{solve, surface};
use super::{is_refused, largest};
use crate::group::Group;
use crate::shapes::conoid;

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: spherical images and conoidal boundaries",
        "The directions of a conoid are on one great circle; those of a catenoid cover a part of the sphere.",
    );
    for n in [21, 41] {
        let mesh = TriangleMesh::new(&conoid().mesh(n, n)?)?;
        let found = AsymptoticDirections::new(&mesh, &Options::default())?;
        // The family that runs along the rulings.
        let tilt = |family: usize| -> Result<f64> { Ok(found.family(family)?.iter().map(|a| a.z * a.z).sum()) };
        let family = usize::from(tilt(1)? < tilt(0)?);
        let field = found.orient(&mesh, family, &orientation::Options::default())?.field;
        let image = *SphericalImage::new(&mesh, &field)?.report();
        let is_circle = f64::from(image.kind == ImageKind::GreatCircle);
        group.at_least(&format!("conoid, {n} by {n}: its image is a great circle"), is_circle, 1.0);
        let sine = image.axis.cross(DVec3::Z).length();
        let what = format!("conoid, {n} by {n}: sine of the axis to the exact one");
        if n == 41 {
            group.at_most(&what, sine, 1e-3)
        } else {
            group.plain(&what, sine)
        };
    }
    let around = |t: f64| DVec3::new((t + 0.3 * t.sin()).cos(), (t + 0.3 * t.sin()).sin(), 0.0);
    let (mesh, field) = surface(41, [[0.0, 2.0], [1.0, 2.0]], |t, s| s * around(t) + t * DVec3::Z, |t, _| around(t))?;
    let image = *SphericalImage::new(&mesh, &field)?.report();
    group.at_most("conoid, exact directions: sine of the axis", image.axis.cross(DVec3::Z).length(), 1e-9);

    let line = |u: f64, _: f64| DVec3::new(-u.sin(), u.cos(), 1.0);
    let hyperboloid =
        surface(41, [[0.0, 1.2], [-0.6, 0.6]], |u, v| DVec3::new(u.cos(), u.sin(), 0.0) + v * line(u, v), line)?;
    let kind = SphericalImage::new(&hyperboloid.0, &hyperboloid.1)?.report().kind;
    group.at_least("hyperboloid: its image is a curve, no great circle", f64::from(kind == ImageKind::Curve), 1.0);

    let (mesh, field) = catenoid([0.2, 1.2])?;
    let report = *SphericalImage::new(&mesh, &field)?.report();
    group.at_least(
        "catenoid beside its waist: its image does not fold",
        f64::from(report.kind == ImageKind::Regular),
        1.0,
    );
    group.at_least("catenoid beside its waist: part of the image that is area", report.extent, 0.03);
    let it = (mesh, field);
    let before = conoidality(&it, &solve(&it, LevelWeights::ORTHOGONAL)?.values)?;
    let after = conoidality(&it, &solve(&it, LevelWeights::CONOIDAL)?.values)?;
    group.plain("catenoid: root mean square of a·w, orthogonal boundaries", before);
    group.plain("catenoid: the same, conoidal boundaries", after);
    group.at_least("catenoid: by how much it fell", before / after, 10.0);
    let (mesh, field) = catenoid([-1.0, 1.0])?;
    let options = LevelOptions { weights: LevelWeights::CONOIDAL, ..LevelOptions::default() };
    let folded = level_function(&mesh, &field, &options, &mut |_| ControlFlow::Continue(()));
    group.at_least(
        "catenoid over its waist: refused as folded",
        is_refused(folded, Status::NotOrientable, "field"),
        1.0,
    );
    Ok(group)
}

fn catenoid(u: [f64; 2]) -> Result<(TriangleMesh, Field)> {
    let point = |u: f64, v: f64| DVec3::new(u.cosh() * v.cos(), u.cosh() * v.sin(), u);
    let along = move |u: f64, v: f64| {
        let first = DVec3::new(u.sinh() * v.cos(), u.sinh() * v.sin(), 1.0);
        first + u.cosh() * DVec3::new(-v.sin(), v.cos(), 0.0)
    };
    surface(41, [u, [0.0, 1.5]], point, along)
}

/// The root mean square over nine levels of how far the directions along a level curve are off a great circle.
fn conoidality((mesh, field): &(TriangleMesh, Field), values: &[f64]) -> Result<f64> {
    let top = largest(values.iter().copied());
    let mut errors = Vec::new();
    for k in 1..10 {
        for curve in level_curves(mesh, values, top * f64::from(k) / 10.0)? {
            // Short pieces at corners are on a great circle whatever they are.
            if curve.length() >= 0.3 {
                let on: Vec<SurfacePoint> = curve.points.iter().map(|point| point.at).collect();
                errors.push(Axis::of_points(mesh, field, &on).context("no axis")?.error);
            }
        }
    }
    Ok((errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt())
}
