//! Curves of given curvature, and snakes fitted to them.

use std::ops::ControlFlow;

use anyhow::Result;
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::snakes::curvature_curve::{Course, CurvatureCurve, Method, Options, Side, curvature_curve};
use shapeop::geometry::snakes::fit::{self, fit};
use shapeop::geometry::snakes::mesh_curve::mesh_curve;
use shapeop::mesh::TriangleMesh;
use shapeop::mesh::reference::{ReferenceMesh, SurfaceJet};
use shapeop::mesh::surfaces::{cylinder, graph, sphere, torus};

use super::{exactly, is_refused};
use crate::group::Group;
use crate::own::{from_polyline, largest, shapes};
use crate::shapes::surface;

const EVERYWHERE: [[f64; 2]; 2] = [[f64::NEG_INFINITY, f64::INFINITY]; 2];

/// How far a curve is off after so many steps.
type Errors<'a> = &'a dyn Fn(usize, Method) -> Result<f64>;

type Surface<'a> = &'a dyn Fn(f64, f64) -> SurfaceJet;

fn trace(
    surface: Surface<'_>,
    start: [f64; 2],
    tangent: DVec3,
    course: &Course<'_>,
    steps: usize,
    method: Method,
) -> Result<CurvatureCurve> {
    Ok(curvature_curve(surface, EVERYWHERE, start, tangent, course, &Options { steps, method })?)
}

/// How far a curve is from the circle of a radius that it begins along, with all points at their lengths.
fn from_circle(curve: &CurvatureCurve, inward: DVec3, radius: f64) -> f64 {
    let (start, tangent) = (curve.points[0], curve.tangents[0]);
    let apart = |(point, length): (&DVec3, &f64)| {
        let (sine, cosine) = (length / radius).sin_cos();
        point.distance(start + radius * (sine * tangent + (1.0 - cosine) * inward))
    };
    largest(curve.points.iter().zip(&curve.lengths).map(apart))
}

pub fn closed_forms() -> Result<Group> {
    let mut group = Group::new(
        "truths: curves of given curvature (Bartoň et al. 2013, proposition 2.1 and section 3.3)",
        "Circles in the plane and on spheres, helices of a cylinder, both sides, straight lines and great circles, and what has\n\
         no solution. The paper's scheme is of first order; ours is that of Runge and Kutta.",
    );
    let (plane, kappa, radius) = (graph(|_, _| [0.0; 6]), 1.6, 1.25);
    let on_sphere = sphere(radius);
    let constant = move |_: f64| kappa;
    let course = Course { curvature: &constant, length: 3.0, side: Side::Left };
    let of_plane = |steps, method| -> Result<f64> {
        let curve = trace(&plane, [0.2, 0.1], DVec3::new(1.0, 0.5, 7.0), &course, steps, method)?;
        Ok(from_circle(&curve, DVec3::Z.cross(curve.tangents[0]), 1.0 / kappa))
    };
    let of_sphere = |steps, method| -> Result<f64> {
        let curve = trace(&on_sphere, [0.3, 0.2], DVec3::new(-0.4, 1.0, 0.7), &course, steps, method)?;
        // The curvature vector is −p / R² + κ_g n × t.
        let normal = curve.points[0] / radius;
        let geodesic = (kappa * kappa - 1.0 / (radius * radius)).sqrt();
        Ok(from_circle(&curve, (-normal / radius + geodesic * normal.cross(curve.tangents[0])) / kappa, 1.0 / kappa))
    };
    for (name, error) in [("plane", &of_plane as Errors<'_>), ("sphere", &of_sphere)] {
        let slope = |method, steps| -> Result<f64> { Ok((error(steps, method)? / error(2 * steps, method)?).log2()) };
        group.between(&format!("{name}: order of the paper's scheme"), slope(Method::Chords, 200)?, [0.9, 1.1]);
        group.at_least(&format!("{name}: order of Runge and Kutta's"), slope(Method::RungeKutta, 40)?, 3.5);
        group.at_most(&format!("{name}: off the circle after 1000 steps"), error(1000, Method::RungeKutta)?, 1e-9);
        group.plain(&format!("{name}: the same by the paper's scheme"), error(1000, Method::Chords)?);
    }
    // At the slope φ a helix is a geodesic of curvature cos² φ / R.
    let (radius, phi) = (0.8, 0.6_f64);
    let (around, curvature) = (cylinder(radius), phi.cos().powi(2) / radius);
    for (method, name) in [(Method::RungeKutta, "Runge and Kutta"), (Method::Chords, "the paper's scheme")] {
        let course = Course { curvature: &|_| curvature, length: 4.0, side: Side::Left };
        let curve = trace(&around, [0.0, 0.0], DVec3::new(0.0, phi.cos(), phi.sin()), &course, 400, method)?;
        let off = |(point, length): (&DVec3, &f64)| {
            let (sine, cosine) = (length * phi.cos() / radius).sin_cos();
            point.distance(DVec3::new(radius * cosine, radius * sine, length * phi.sin()))
        };
        group.at_most(
            &format!("cylinder: off the helix, {name}"),
            largest(curve.points.iter().zip(&curve.lengths).map(off)),
            1e-9,
        );
    }
    let varying = |s: f64| 2.0 + (2.0 * s).sin();
    let mirrored = |surface: Surface<'_>, normal: &dyn Fn(DVec3) -> DVec3| -> Result<f64> {
        let of = |side| {
            let course = Course { curvature: &varying, length: 3.0, side };
            trace(surface, [0.2, -0.3], DVec3::new(-0.2, 1.0, 0.6), &course, 3000, Method::RungeKutta)
        };
        let (left, right) = (of(Side::Left)?, of(Side::Right)?);
        let across = normal(left.points[0]).cross(left.tangents[0]);
        let image = |p: DVec3| p - 2.0 * (p - left.points[0]).dot(across) * across;
        Ok(largest(left.points.iter().zip(&right.points).map(|(l, r)| l.distance(image(*r)))))
    };
    group.at_most("plane: left and right are mirror images, to", mirrored(&plane, &|_| DVec3::Z)?, 1e-9);
    group.at_most("sphere: left and right are mirror images, to", mirrored(&sphere(1.2), &|p| p.normalize())?, 1e-9);
    let straight = Course { curvature: &|_| 0.0, length: 5.0, side: Side::Left };
    let line = trace(&plane, [0.0, 0.0], DVec3::new(0.3, 0.4, 0.0), &straight, 100, Method::RungeKutta)?;
    let off = |(p, l): (&DVec3, &f64)| p.distance(*l * DVec3::new(0.6, 0.8, 0.0));
    group.at_most("plane, curvature 0: off the line", largest(line.points.iter().zip(&line.lengths).map(off)), 1e-9);
    let great = Course { curvature: &|_| 0.5, ..straight };
    let circle = trace(&sphere(2.0), [0.3, 0.1], DVec3::new(0.0, 1.0, 1.0), &great, 2000, Method::RungeKutta)?;
    group.at_most(
        "sphere of radius 2, ½: off the great circle",
        from_circle(&circle, -circle.points[0] / 2.0, 2.0),
        1e-9,
    );
    let refused = curvature_curve(&sphere(1.0), EVERYWHERE, [0.0, 0.0], DVec3::Y, &great, &Options::default());
    let is_so = is_refused(refused, Status::NoSolution, "course.curvature");
    super::holds(&mut group, "unit sphere, ½: no solution", is_so);
    Ok(group)
}

pub fn on_meshes() -> Result<Group> {
    let mut group = Group::new(
        "truths: curves of given curvature on meshes (Bartoň et al. 2013, section 3.3)",
        "Meshes of 40 by 40 points, beside the curves on the surfaces; h is the mean edge.",
    );
    let patch = surface([[-1.0, 1.0], [-0.8, 0.8]], sphere(1.0))?;
    let ring = surface([[-1.5, 1.5], [-2.0, 2.0]], torus(2.0, 0.7))?;
    for (name, surface, start, tangent, kappa) in [
        ("sphere", &patch, [0.0, 0.1], DVec3::new(0.0, 1.0, 0.4), 3.0),
        ("torus", &ring, [0.1, 0.2], DVec3::new(0.3, 0.5, 1.0), 1.8),
    ] {
        for (side, which) in [(Side::Left, "left"), (Side::Right, "right")] {
            let mesh = TriangleMesh::new(&surface.mesh(40, 40)?)?;
            let course = Course { curvature: &|_| kappa, length: 2.0, side };
            let (at, options) = (surface.at(start[0], start[1]).point, Options::default());
            let found = mesh_curve(&ReferenceMesh::new(&mesh), at, tangent, &course, &options)?;
            let exact = curvature_curve(&|u, v| surface.at(u, v), EVERYWHERE, start, tangent, &course, &options)?;
            let apart = largest(found.curve.points.iter().zip(&exact.points).map(|(a, b)| a.distance(*b)));
            group.at_most(&format!("{name}, {which}: apart / h²"), apart / mesh.mean_edge().powi(2), 5.0);
            group.at_least(&format!("{name}, {which}: edges crossed"), found.crossing_count as f64, 11.0);
        }
    }
    Ok(group)
}

pub fn fits() -> Result<Group> {
    let mut group = Group::new(
        "truths: snakes fitted to a curve (Bartoň et al. 2013, section 3.3)",
        "A curve of curvature 1.8 and length 3 on the torus 2 / 0.7; distances of its points from arcs drawn as fine polylines.\n\
         One arc for a part of a circle.",
    );
    let ring = torus(2.0, 0.7);
    let tangent = ring(0.1, 0.2).normal().cross(DVec3::new(0.3, 0.5, 1.0));
    let course = Course { curvature: &|_| 1.8, length: 3.0, side: Side::Left };
    let curve = trace(&ring, [0.1, 0.2], tangent, &course, 600, Method::RungeKutta)?;
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    let mut deviations = Vec::new();
    for count in [4, 12, 24] {
        let options = fit::Options { curvature: Some(1.8), ..fit::Options::default() };
        let found = fit(&curve.points, count, &options, go_on)?;
        // Radii and lengths from control points alone.
        let read = shapes(found.snake.control(), None);
        let off =
            largest(read.iter().map(|[radius, length]| (radius - 1.0 / 1.8).abs().max((length - read[0][1]).abs())));
        group.at_most(&format!("{count} arcs: distances off by"), found.snake.residual(), 1e-12);
        group.at_most(&format!("{count} arcs: radii off 1 / 1.8, lengths unequal by"), off, 1e-12);
        let fine = found.snake.sample(400);
        let deviation = largest(curve.points.iter().map(|p| from_polyline(*p, &fine)));
        group.plain(&format!("{count} arcs: largest distance"), deviation);
        deviations.push(deviation);
    }
    group.at_least("it falls from 4 to 12 arcs by a factor of", deviations[0] / deviations[1], 4.0);
    group.at_least("it falls from 12 to 24 arcs by a factor of", deviations[1] / deviations[2], 2.5);
    let (x, y) = (DVec3::new(1.0, 2.0, 2.0) / 3.0, DVec3::new(2.0, 1.0, -2.0) / 3.0);
    let at = |angle: f64| DVec3::new(5.0, -1.0, 2.0) + 1.7 * (angle.cos() * x + angle.sin() * y);
    let points: Vec<DVec3> = (0..=40).map(|i| at(2.0 * f64::from(i) / 40.0)).collect();
    let found = fit(&points, 1, &fit::Options::default(), go_on)?;
    let arc = &found.snake.arcs()[0];
    let off = (0..=200).map(|k| f64::from(k) / 200.0).map(|part| arc.point(part).distance(at(2.0 * part)));
    group.at_most("one arc: off its part of a circle", largest(off), 1e-10);
    let [radius, length] = shapes(found.snake.control(), None)[0];
    group.at_most("one arc: radius and length off by", (radius - 1.7).abs().max((length - 3.4).abs()), 1e-10);
    exactly(&mut group, "one arc: control points", found.snake.control().len(), 3);
    Ok(group)
}
