//! Figs. 5 and 6: both fields of asymptotic directions, and strip boundaries of four kinds.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::ruled::Boundary;
use shapeop::geometry::ruled::boundaries::Levels;
use shapeop::geometry::ruled::design::{Design, FieldOptions};
use shapeop::geometry::ruled::level_function::LevelWeights;
use shapeop::geometry::ruled::planar_boundaries::{PlanarOptions, Plane};
use shapeop::geometry::ruled::tracing::{Options, Sense, Tracer};
use shapeop::mesh::Mesh;
use shapeop::mesh::reference::ReferenceMesh;
use shapeop_cli::scene::{BLUE, ORANGE, RED, Scene, View};

use super::drawing::{SURFACE, on_surface, surface};
use super::{set_levels, with_levels};
use crate::group::Group;
use crate::shapes::roof;

/// The edges of planes.
const EDGE: [f64; 3] = [0.72, 0.50, 0.22];

pub const THIN: [f64; 3] = [0.45, 0.60, 0.80];

/// Asymptotic curves from points evenly spread over a curve across them.
pub fn curves(design: &Design, across: &[DVec3], count: usize) -> Result<Vec<Vec<DVec3>>> {
    let reference = ReferenceMesh::new(design.mesh());
    let tracer = Tracer::new(design.mesh(), design.field(), &Options::default())?;
    let curve = |k: usize| {
        let start = reference.locate(across[k * (across.len() - 1) / (count - 1)]);
        let back = tracer.trace(start, Sense::Backward, 20.0)?;
        let on = tracer.trace(start, Sense::Forward, 20.0)?;
        Ok(back.positions.iter().rev().chain(&on.positions[1..]).copied().collect())
    };
    (0..count).map(curve).collect()
}

/// The diagonal of the roof that the curves of a family cross.
fn diagonal(family: usize) -> Vec<DVec3> {
    let shape = roof();
    let sign = if family == 0 { 1.0 } else { -1.0 };
    (0..=400).map(|k| f64::from(k) / 400.0).map(|t| shape.point(-1.18 + 2.66 * t, sign * (0.98 - 1.96 * t))).collect()
}

/// Geodesic curvature of boundaries over the surface's size: its root mean square, from chords of two mean edges.
pub fn geodesic_curvature(design: &Design, boundaries: &[Boundary]) -> f64 {
    let mesh = design.mesh();
    let (mut sum, mut count) = (0.0, 0);
    for boundary in boundaries {
        let on: Vec<(DVec3, DVec3)> = boundary
            .points
            .iter()
            .zip(&boundary.on_surface)
            .filter_map(|(point, at)| Some((*point, mesh.normal_at((*at)?))))
            .collect();
        let reach = |k: usize, step: isize| {
            let mut i = k as isize;
            while (0..on.len() as isize).contains(&i) {
                if on[i as usize].0.distance(on[k].0) >= 2.0 * mesh.mean_edge() {
                    return Some(on[i as usize].0);
                }
                i += step;
            }
            None
        };
        for (k, (point, normal)) in on.iter().enumerate() {
            let (Some(before), Some(after)) = (reach(k, -1), reach(k, 1)) else { continue };
            let (a, b) = (*point - before, after - *point);
            let turn = a.normalize().cross(b.normalize()).dot(*normal).clamp(-1.0, 1.0).asin();
            sum += (2.0 * turn / (a.length() + b.length())).powi(2);
            count += 1;
        }
    }
    (sum / f64::from(count.max(1))).sqrt() * mesh.diagonal()
}

/// Angles between boundaries and the field off right angles, root mean square, in degrees.
fn off_right_angles(design: &Design, boundaries: &[Boundary]) -> f64 {
    let (mesh, field) = (design.mesh(), design.field());
    let mut all = Vec::new();
    for boundary in boundaries {
        let points: Vec<_> = boundary.points.iter().zip(&boundary.on_surface).collect();
        for ends in points.windows(3) {
            let (Some(at), true, true) = (ends[1].1, ends[0].1.is_some(), ends[2].1.is_some()) else { continue };
            let Some(a) = field.at(mesh, at.triangle as usize, at.weights) else { continue };
            all.push((*ends[2].0 - *ends[0].0).normalize_or_zero().dot(a).abs().asin().to_degrees());
        }
    }
    (all.iter().map(|angle| angle * angle).sum::<f64>() / all.len().max(1) as f64).sqrt()
}

/// Distances from points of boundaries to the next one: the standard deviation over the mean, of all together.
fn uneven(boundaries: &[Vec<DVec3>]) -> f64 {
    let mut all = Vec::new();
    for pair in boundaries.windows(2) {
        let inner = &pair[0][pair[0].len() / 8..7 * pair[0].len() / 8];
        for point in inner.iter().step_by(4) {
            all.push(pair[1].iter().map(|p| p.distance(*point)).fold(f64::INFINITY, f64::min));
        }
    }
    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
    (all.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / all.len().max(1) as f64).sqrt() / mean
}

fn base(title: &str, mesh: &Mesh) -> View {
    surface(View::new(title, -32.0, 44.0), mesh, SURFACE)
}

fn with_curves(view: View, curves: &[Vec<DVec3>], width: f64) -> View {
    curves.iter().fold(view, |view, curve| view.line(curve, if width > 1.0 { BLUE } else { THIN }, width))
}

fn with_boundaries(view: View, boundaries: &[Boundary]) -> View {
    boundaries.iter().fold(view, |view, boundary| view.line(&on_surface(boundary), ORANGE, 3.0))
}

/// Planes across the roof that turn a little from one to the next.
pub fn planes() -> Vec<Plane> {
    let plane = |k: i32| {
        let t = f64::from(k) / 6.0 - 0.5;
        let angle = (42.0 + 20.0 * t).to_radians();
        let normal = DVec3::new(angle.cos(), angle.sin(), 0.18 * t);
        Plane { normal, offset: normal.dot(DVec3::new(2.66 * t + 0.14, 1.5 * t, 0.0)) }
    };
    (0..7).map(plane).collect()
}

pub fn figure5(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 5: the two fields of asymptotic directions, and boundaries of four kinds",
        "A roof of 91 by 61 points; eight levels of each function, or seven planes.",
    );
    let mesh = roof().mesh(91, 61)?;
    let family = 0;
    let mut design = Design::new(&mesh, &FieldOptions { family, ..FieldOptions::default() })?;
    let other = Design::new(&mesh, &FieldOptions { family: 1 - family, ..FieldOptions::default() })?;
    let [own, others] =
        [(&design, family), (&other, 1 - family)].map(|(design, family)| curves(design, &diagonal(family), 19));
    let (own, others) = (own?, others?);
    let mut views = vec![
        with_curves(base("(a) one family of asymptotic curves", &mesh), &own, 1.5),
        with_curves(base("(b) the other family", &mesh), &others, 1.5),
    ];
    let kinds = [
        ("(c) orthogonal to the first family", LevelWeights::ORTHOGONAL),
        ("(d) at constant distances", LevelWeights::EQUIDISTANT),
        ("(e) geodesic", LevelWeights::GEODESIC),
    ];
    let mut measured = Vec::new();
    for (title, weights) in kinds {
        set_levels(&mut design, weights, &Levels::Count(8))?;
        let boundaries = &design.boundaries().boundaries;
        let lines: Vec<Vec<DVec3>> = boundaries.iter().map(on_surface).filter(|line| line.len() > 20).collect();
        let found =
            [off_right_angles(&design, boundaries), 100.0 * uneven(&lines), geodesic_curvature(&design, boundaries)];
        measured.push(found);
        let caption = format!(
            "{:.1}° off right angles, widths vary by {:.0} %,\ngeodesic curvature × size {:.2}",
            found[0], found[1], found[2]
        );
        let view = with_curves(base(title, &mesh), &own, 0.7);
        views.push(with_boundaries(view, boundaries).caption(caption));
    }
    let names = ["orthogonal", "equidistant", "geodesic"];
    for (name, found) in names.into_iter().zip(&measured) {
        group.plain(&format!("{name}: off right angles, root mean square, degrees"), found[0]);
        group.plain(&format!("{name}: distances, standard deviation over mean, %"), found[1]);
        group.plain(&format!("{name}: geodesic curvature, root mean square × size"), found[2]);
    }
    for (k, what) in ["off right angles", "unevenness of distances", "geodesic curvature"].into_iter().enumerate() {
        let least = measured.iter().map(|found| found[k]).fold(f64::INFINITY, f64::min);
        group.at_most(
            &format!("{what}: of those that are to have it, over the least of all"),
            measured[k][k] / least,
            1.0,
        );
    }
    let angles = design.set_planar_boundaries(&planes(), &PlanarOptions::default())?;
    let least = angles.iter().copied().fold(f64::INFINITY, f64::min).to_degrees();
    group.at_least("planar: least angle to the field, degrees", least, 15.0);
    let off = planes().into_iter().zip(&design.boundaries().boundaries[1..]).flat_map(|(plane, boundary)| {
        let on = on_surface(boundary);
        on.into_iter().map(move |p| (plane.normal.dot(p) - plane.offset).abs() / plane.normal.length())
    });
    group.at_most("planar: points off their planes", off.fold(0.0, f64::max), 1e-14);
    let caption = format!("cross the asymptotic curves\nat {least:.0}° or more");
    let view = with_curves(base("(f) planar", &mesh), &own, 0.7);
    views.push(with_boundaries(view, &design.boundaries().boundaries).caption(caption));
    let scene = Scene {
        title: "From asymptotic curves to strip boundaries".to_owned(),
        subtitle: "Blue: asymptotic curves, which rulings follow; orange: boundaries suggested across them, by \
            what is asked of them"
            .to_owned(),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "boundaries")?);
    Ok(group)
}

pub fn figure6(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 6: planar boundaries",
        "Seven planes across the roof, each checked against the field that it crosses.",
    );
    let mesh = roof().mesh(91, 61)?;
    let family = 0;
    let mut design = with_levels(&mesh, family, LevelWeights::ORTHOGONAL, &Levels::Count(2))?;
    let angles = design.set_planar_boundaries(&planes(), &PlanarOptions::default())?;
    for (k, angle) in angles.iter().enumerate() {
        group.at_least(&format!("plane {}: least angle to the field, degrees", k + 1), angle.to_degrees(), 15.0);
    }
    let boundaries = &design.boundaries().boundaries[1..=planes().len()];
    let mut cut = base("planes and their sections", &mesh);
    for (plane, boundary) in planes().iter().zip(boundaries) {
        let points = on_surface(boundary);
        let normal = plane.normal.normalize();
        let along = normal.cross(DVec3::Z).normalize();
        let up = along.cross(normal).normalize();
        let up = if up.z < 0.0 { -up } else { up };
        // The part of the plane above the surface, up to a level line.
        let top = points.iter().map(|p| p.dot(up)).fold(f64::NEG_INFINITY, f64::max) + 0.22;
        let lifted = |k: usize, part: f64| points[k] + part * (top - points[k].dot(up)) * up;
        let (columns, rows) = (30, 8);
        let column = |i: usize| i * (points.len() - 1) / columns;
        for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
            let [low, high] = [j, j + 1].map(|j| j as f64 / rows as f64);
            let [from, to] = [i, i + 1].map(column);
            let corners = [lifted(from, low), lifted(to, low), lifted(to, high), lifted(from, high)];
            cut = cut.glass(&corners, [0.98, 0.74, 0.38], 0.38);
        }
        for k in [0, points.len() - 1] {
            cut = cut.line(&(0..=8).map(|j| lifted(k, f64::from(j) / 8.0)).collect::<Vec<_>>(), EDGE, 0.9);
        }
        cut = cut.line(&(0..=columns).map(|i| lifted(column(i), 1.0)).collect::<Vec<_>>(), EDGE, 0.9);
        cut = cut.line(&points, RED, 3.0);
    }
    let curves = curves(&design, &diagonal(family), 19)?;
    let crossed =
        with_boundaries(with_curves(base("sections across asymptotic curves", &mesh), &curves, 1.2), boundaries);
    let listed = angles.iter().map(|angle| format!("{:.0}°", angle.to_degrees())).collect::<Vec<_>>().join(", ");
    let scene = Scene {
        title: "Planar boundaries: sections that cross the rulings".to_owned(),
        subtitle: "A section that runs along asymptotic curves would be no boundary: the angles between them must \
            not be small"
            .to_owned(),
        columns: 2,
        views: vec![cut, crossed.caption(format!("least angles from the first plane to the last: {listed}"))],
    };
    group.picture = Some(scene.write(folder, "planar_cuts")?);
    Ok(group)
}
