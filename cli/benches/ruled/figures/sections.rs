//! Fig. 4: how a surface meets its tangent planes.

use std::f64::consts::PI;
use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::ruled::asymptotic::{AsymptoticDirections, Options, PointStatus};
use shapeop::geometry::ruled::tangent_section::TangentSection;
use shapeop::mesh::patterns::height_field;
use shapeop::mesh::{Mesh, TriangleMesh};
use shapeop_cli::scene::{BLUE, INK, ORANGE, RED, Scene, View};

use crate::group::Group;

/// Columns and rows of the mesh.
const SIDE: usize = 97;

/// Where the surface is negatively curved, and where it is not.
const NEGATIVE: [f64; 3] = [0.80, 0.88, 0.95];
const POSITIVE: [f64; 3] = [0.96, 0.92, 0.84];

pub fn figure4(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 4: a surface cut with its own tangent planes",
        "z = 0.9 sin x sin y: at saddles four branches leave a point along the two asymptotic directions, elsewhere none.",
    );
    let mesh =
        height_field(SIDE, SIDE, [-0.3, 1.5 * PI + 0.3], [-0.3, 1.5 * PI + 0.3], |x, y| 0.9 * x.sin() * y.sin())?;
    let triangles = TriangleMesh::new(&mesh)?;
    let found = AsymptoticDirections::new(&triangles, &Options { max_mask: 1.0, ..Options::default() })?;
    let is_negative = |i: usize| found.status()[i] == PointStatus::Good;
    let colour = |face: usize| {
        if mesh.faces[face].iter().filter(|i| is_negative(**i as usize)).count() >= 2 { NEGATIVE } else { POSITIVE }
    };
    let mut whole = View::new("sections at many points", 24.0, 42.0).mesh(&mesh, 1.0, 0.0, &colour);
    let (mut degrees, mut crossed, mut bare) = (Vec::new(), 0, 0);
    for (i, j) in (7..SIDE).step_by(14).flat_map(|i| (7..SIDE).step_by(14).map(move |j| (i, j))) {
        let point = i * SIDE + j;
        let section = TangentSection::new(&triangles, point, found.curvatures()[point].normal, 5)?;
        let at = mesh.points[point];
        if is_negative(point) {
            crossed += usize::from(section.branches.len() == 4);
            for direction in section.directions() {
                let sine = |family: usize| found.family(family).map(|a| a[point].cross(direction).length());
                degrees.push(sine(0)?.min(sine(1)?).asin().to_degrees());
            }
            whole = section.branches.iter().fold(whole, |view, branch| view.line(branch, ORANGE, 2.6));
            whole = whole.dots(&[at], INK, 3.0);
        } else {
            bare += usize::from(section.branches.is_empty());
            whole = whole.dots(&[at], RED, 3.6);
        }
    }
    let negative = degrees.len() / 4;
    let total = 49;
    group.between("points where K < 0 with four branches, all of them", crossed as f64, [negative as f64; 2]);
    group.between("points where K ≥ 0 without a branch, all of them", bare as f64, [(total - crossed) as f64; 2]);
    let mean = degrees.iter().sum::<f64>() / degrees.len() as f64;
    group.at_most("branches off asymptotic directions, mean, degrees", mean, 5.0);
    group.plain("branches off asymptotic directions, largest, degrees", degrees.iter().copied().fold(0.0, f64::max));

    // Near the middle of a saddle, off its symmetry.
    let (row, column) = (59, 57);
    let point = row * SIDE + column;
    let at = mesh.points[point];
    let normal = found.curvatures()[point].normal;
    let reach = 1.25;
    let near = |face: &&Vec<u32>| face.iter().all(|i| mesh.points[*i as usize].distance(at) < 1.3 * reach);
    let patch = Mesh { points: mesh.points.clone(), faces: mesh.faces.iter().filter(near).cloned().collect() };
    let section = TangentSection::new(&triangles, point, normal, 20)?;
    let (e1, e2) = {
        let [a, b] = [found.family(0)?[point], found.family(1)?[point]];
        let b = if a.dot(b) < 0.0 { -b } else { b };
        ((a + b).normalize(), normal.cross((a + b).normalize()))
    };
    let mut close = View::new("a point, its tangent plane and where the two meet", 24.0, 40.0);
    close = close.mesh(&patch, 1.0, 0.0, &|_| NEGATIVE);
    // Many small pieces of the plane, that each is in front of the surface or behind it.
    let parts = 48;
    for k in 0..parts * parts {
        let corner = |i: usize, j: usize| {
            let [s, t] = [i, j].map(|n| reach * (2.0 * n as f64 / parts as f64 - 1.0));
            at + s * e1 + t * e2
        };
        let (i, j) = (k / parts, k % parts);
        let corners = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        close = close.smooth_face(&corners, [0.99, 0.83, 0.60]);
    }
    close = section.branches.iter().fold(close, |view, branch| {
        let inside =
            branch.iter().copied().take_while(|p| (*p - at).dot(e1).abs().max((*p - at).dot(e2).abs()) < reach);
        view.line(&inside.collect::<Vec<_>>(), ORANGE, 3.4)
    });
    for family in 0..2 {
        let a = 0.75 * found.family(family)?[point];
        close = close.line(&dashes(at - a, at + a), BLUE, 2.2);
    }
    close = close.dots(&[at], INK, 4.0);
    let words = format!(
        "orange: the section; blue: the asymptotic directions there;\nthe mean angle between them is {mean:.1}°"
    );
    let caption = format!(
        "{crossed} points where the surface is a saddle (blue) have crossing branches,\n{bare} points on domes and bowls (red) have none"
    );
    let scene = Scene {
        title: "Asymptotic directions, found by cutting a surface with its own tangent planes".to_owned(),
        subtitle: format!(
            "z = 0.9 sin x sin y as a mesh of {SIDE} by {SIDE} points; only where it is negatively curved (blue) rulings can follow it"
        ),
        columns: 2,
        views: vec![close.caption(words), whole.caption(caption)],
    };
    group.picture = Some(scene.write(folder, "sections")?);
    Ok(group)
}

/// The pieces of a dashed line, one point after the other; for [`View::line`] in pairs.
fn dashes(from: DVec3, to: DVec3) -> Vec<DVec3> {
    (0..=24).map(|k| from.lerp(to, f64::from(k) / 24.0)).collect()
}
