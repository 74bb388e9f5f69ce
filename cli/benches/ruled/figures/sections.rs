//! Fig. 4: how a surface meets its tangent planes.

use std::f64::consts::PI;
use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::ruled::asymptotic::{AsymptoticDirections, Options, PointStatus};
use shapeop::geometry::ruled::tangent_section::TangentSection;
use shapeop::mesh::TriangleMesh;
use shapeop::mesh::patterns::height_field;
use shapeop_cli::scene::{BLUE, INK, ORANGE, RED, Scene, View};

use crate::group::Group;

/// Columns and rows of the mesh.
const SIDE: usize = 97;

/// Points are shown where Gauss's curvature is at least this part of its largest.
const CURVED: f64 = 0.15;

/// Where the surface is negatively curved, and where it is not.
const NEGATIVE: [f64; 3] = [0.80, 0.88, 0.95];
const POSITIVE: [f64; 3] = [0.96, 0.92, 0.84];

pub fn figure4(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 4: a surface cut with its own tangent planes",
        "z = 0.9 sin x sin y: at saddles four branches leave a point along the two asymptotic directions, \
            elsewhere none.",
    );
    let mesh =
        height_field(SIDE, SIDE, [-0.3, 1.5 * PI + 0.3], [-0.3, 1.5 * PI + 0.3], |x, y| 0.9 * x.sin() * y.sin())?;
    let triangles = TriangleMesh::new(&mesh)?;
    let found = AsymptoticDirections::new(&triangles, &Options { max_mask: 1.0, ..Options::default() })?;
    let is_negative = |i: usize| found.status()[i] == PointStatus::Good;
    let colour = |face: usize| {
        if mesh.faces[face].iter().filter(|i| is_negative(**i as usize)).count() >= 2 { NEGATIVE } else { POSITIVE }
    };
    let curvature = |i: usize| found.curvatures()[i].gaussian();
    let most = (0..mesh.points.len()).map(|i| curvature(i).abs()).fold(0.0, f64::max);
    let mut whole = View::new("sections at many points", 24.0, 42.0).mesh(&mesh, 1.0, 0.0, &colour);
    let (mut degrees, mut negative, mut positive, mut crossed, mut bare) = (Vec::new(), 0, 0, 0, 0);
    for (i, j) in (6..SIDE).step_by(12).flat_map(|i| (6..SIDE).step_by(12).map(move |j| (i, j))) {
        let point = i * SIDE + j;
        // Where the surface is nearly flat one way there is nothing to be seen.
        if curvature(point).abs() < CURVED * most {
            continue;
        }
        let section = TangentSection::new(&triangles, point, found.curvatures()[point].normal, 5)?;
        let at = mesh.points[point];
        if is_negative(point) {
            (negative, crossed) = (negative + 1, crossed + usize::from(section.branches.len() == 4));
            for direction in section.directions() {
                let sine = |family: usize| found.family(family).map(|a| a[point].cross(direction).length());
                degrees.push(sine(0)?.min(sine(1)?).asin().to_degrees());
            }
            whole = section.branches.iter().fold(whole, |view, branch| view.line(branch, ORANGE, 2.8));
            whole = whole.dots(&[at], INK, 3.0);
        } else {
            (positive, bare) = (positive + 1, bare + usize::from(section.branches.is_empty()));
            whole = whole.dots(&[at], RED, 3.6);
        }
    }
    group.between("points on saddles with four branches, all of them", crossed as f64, [negative as f64; 2]);
    group.between("points on domes and bowls without a branch, all of them", bare as f64, [positive as f64; 2]);
    let mean = degrees.iter().sum::<f64>() / degrees.len() as f64;
    group.at_most("branches off asymptotic directions, mean, degrees", mean, 5.0);
    group.plain("branches off asymptotic directions, largest, degrees", degrees.iter().copied().fold(0.0, f64::max));

    // Near the middle of a saddle, off its symmetry.
    let point = 62 * SIDE + 58;
    let at = mesh.points[point];
    let normal = found.curvatures()[point].normal;
    let reach = 1.15;
    let shown = 1.45 * reach;
    let patch = height_field(61, 61, [at.x - shown, at.x + shown], [at.y - shown, at.y + shown], |x, y| {
        0.9 * x.sin() * y.sin()
    })?;
    let section = TangentSection::new(&triangles, point, normal, 24)?;
    let e1 = DVec3::X.reject_from_normalized(normal).normalize();
    let e2 = normal.cross(e1);
    let mut close = View::new("a point, its tangent plane and where the two meet", 24.0, 42.0);
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
    let is_within = |p: &DVec3| (*p - at).dot(e1).abs().max((*p - at).dot(e2).abs()) < reach;
    for family in 0..2 {
        let a = found.family(family)?[point];
        // Where the section itself is not.
        for side in [-1.0, 1.0] {
            let line: Vec<DVec3> = in_pieces(at, at + 1.55 * side * reach * a);
            close = close.line(&line.into_iter().filter(|p| !is_within(p)).collect::<Vec<_>>(), BLUE, 2.4);
        }
    }
    close = section.branches.iter().fold(close, |view, branch| {
        view.line(&branch.iter().copied().take_while(is_within).collect::<Vec<_>>(), ORANGE, 3.6)
    });
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let square: Vec<DVec3> = square.iter().map(|[s, t]| at + reach * (*s * e1 + *t * e2)).collect();
    for side in square.windows(2) {
        close = close.line(&in_pieces(side[0], side[1]), [0.70, 0.50, 0.25], 1.0);
    }
    close = close.dots(&[at], INK, 4.0);
    let words = format!(
        "orange: the section; blue: the asymptotic directions there;\nthe mean angle between them is {mean:.1}°"
    );
    let caption = format!(
        "{crossed} points where the surface is a saddle (blue) have crossing branches,\n{bare} points on domes \
            and bowls (red) have none"
    );
    let scene = Scene {
        title: "Asymptotic directions, found by cutting a surface with its own tangent planes".to_owned(),
        subtitle: format!(
            "z = 0.9 sin x sin y as a mesh of {SIDE} by {SIDE} points; only where it is negatively curved (blue) \
                rulings can follow it"
        ),
        columns: 2,
        views: vec![close.caption(words), whole.caption(caption)],
    };
    group.picture = Some(scene.write(folder, "sections")?);
    Ok(group)
}

/// A straight line in pieces, each of which is as near as it is.
fn in_pieces(from: DVec3, to: DVec3) -> Vec<DVec3> {
    (0..=24).map(|k| from.lerp(to, f64::from(k) / 24.0)).collect()
}
