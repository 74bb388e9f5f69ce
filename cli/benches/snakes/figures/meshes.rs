//! Figs. 11 and 12: coverings of a mesh.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::curvature_curve::{self, Course, Side};
use shapeop::geometry::snakes::evolution::{Options, Weights};
use shapeop::geometry::snakes::fit::{self, fit};
use shapeop::geometry::snakes::mesh_curve::mesh_curve;
use shapeop::geometry::snakes::{Snake, projection};
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Mesh, ReferenceSurface, TriangleMesh, file};
use shapeop_cli::colours::Rgb;
use shapeop_cli::scene::{BLUE, INK, RED, Scene, View};

use super::drawing::{
    ARCS, PER_ARC, SHEET, THIN, both_ways, framed, glass, in_words, line, quads, swept, swept_by, told,
};
use crate::group::Group;
use crate::shapes::on;

/// A mesh with its points moved along their normals.
fn offset(mesh: &Mesh, distance: f64) -> Result<Mesh> {
    let triangles = TriangleMesh::new(mesh)?;
    let points = mesh.points.iter().zip(triangles.point_normals()).map(|(p, n)| *p + distance * *n).collect();
    Ok(Mesh { points, faces: mesh.faces.clone() })
}

/// A snake of twelve congruent arcs along a curve of constant curvature that has its middle at the nearest point to `middle`.
fn congruent(reference: &ReferenceMesh<'_>, middle: DVec3, tangent: DVec3, kappa: f64, length: f64) -> Result<Snake> {
    let options = curvature_curve::Options { steps: 300, ..curvature_curve::Options::default() };
    let start = reference.mesh().position(reference.locate(middle));
    let half = |tangent: DVec3, side| {
        let course = Course { curvature: &|_| kappa, length: 0.5 * length, side };
        mesh_curve(reference, start, tangent, &course, &options)
    };
    // Both halves turn to the same side of the curve as a whole.
    let (back, on) = (half(-tangent, Side::Right)?.curve, half(tangent, Side::Left)?.curve);
    let points: Vec<DVec3> = back.points.iter().rev().chain(on.points.iter().skip(1)).copied().collect();
    let options = fit::Options { curvature: Some(kappa), ..fit::Options::default() };
    Ok(fit(&points, 12, &options, &mut |_| ControlFlow::Continue(()))?.snake)
}

/// The root mean square change of torsions, in radians.
fn twist(snakes: &[Snake], start: &Snake) -> f64 {
    let of = |snake: &Snake| {
        let pairs = snake.torsions().into_iter().zip(start.torsions());
        pairs.map(|(a, b)| ((a - b + PI).rem_euclid(2.0 * PI) - PI).powi(2)).collect::<Vec<_>>()
    };
    let all: Vec<f64> = snakes.iter().flat_map(of).collect();
    (all.iter().sum::<f64>() / all.len() as f64).sqrt()
}

/// White on the surface, red where outside of it, blue where inside, at this distance in full.
fn tone(signed: f64, full: f64) -> Rgb {
    let (part, far) = ((signed.abs() / full).min(1.0), if signed > 0.0 { RED } else { BLUE });
    std::array::from_fn(|k| 0.96 + part * (far[k] - 0.96))
}

/// The distance that is shown in full colour.
const FULL: f64 = 0.3;

/// Where snakes begin on the gridshell: near a point, in a direction, with a curvature and a length.
struct Begin {
    middle: DVec3,
    tangent: DVec3,
    kappa: f64,
    length: f64,
    /// Steps at most to either side.
    steps: usize,
}

const FIRST: Begin = Begin {
    middle: DVec3::new(6.0, 4.0, 8.0),
    tangent: DVec3::new(0.3, 1.0, 0.0),
    kappa: 0.2,
    length: 16.0,
    steps: 90,
};
const SECOND: Begin =
    Begin { middle: DVec3::new(0.0, -7.0, 6.0), tangent: DVec3::X, kappa: 0.2, length: 16.0, steps: 90 };

pub fn figure11(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 11: congruent arcs along the offset of a mesh",
        "Gridshell of the botanic garden, offset outward by 0.4; twelve congruent arcs of constant curvature move with weights 1 and 10\n\
         of offset and rotation.",
    );
    let mesh = file::read("examples/meshes/botanic-garden-bubble-0.obj")?;
    let outer = offset(&mesh, 0.4)?;
    let triangles = TriangleMesh::new(&outer)?;
    let reference = ReferenceMesh::new(&triangles);
    let weights = Weights { tangential: 10.0, offset: 1.0, rotation: 10.0, orthogonal: 0.0 };
    let mut views = Vec::new();
    for begin in [&FIRST, &SECOND] {
        let snake = congruent(&reference, begin.middle, begin.tangent, begin.kappa, begin.length)?;
        let options = Options { step: 0.1, max_steps: begin.steps, max_deviation: 0.5, weights, ..Options::default() };
        let snakes = both_ways(&on(&snake, &reference), &options, 0.4)?;
        let told = told(&mut group, &snakes, &triangles)?;
        group.plain("root mean square change of torsions, radians", twist(&snakes, &snake));
        let mut view = View::new(&format!("curvature {}, length {}", begin.kappa, begin.length), 20.0, 50.0);
        view = view.mesh(&mesh, 1.0, 0.2, &|_| SHEET);
        view = swept(view, &snakes, 2, ARCS)?;
        for positions in snakes.iter().step_by(2) {
            view = line(view, positions, THIN, 0.7);
        }
        views.push(line(view, &snake, RED, 3.0).caption(in_words(&told, triangles.diagonal())));
    }
    let scene = Scene {
        title: "A mesh covered by positions of a snake of congruent arcs".to_owned(),
        subtitle: "Gridshell of the botanic garden and surfaces swept on its offset; yellow and white: arcs, all alike; red: the start"
            .to_owned(),
        columns: 2,
        views,
    };
    group.picture = Some(scene.write(folder, "offset")?);
    Ok(group)
}

pub fn figure12(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 12: as rigid as possible",
        "The same snake with heights kept, and moved as rigidly as possible: then it leaves what the mesh is curved too much for.",
    );
    let mesh = file::read("examples/meshes/botanic-garden-bubble-0.obj")?;
    let triangles = TriangleMesh::new(&mesh)?;
    let reference = ReferenceMesh::new(&triangles);
    let snake = congruent(&reference, FIRST.middle, FIRST.tangent, FIRST.kappa, FIRST.length)?;
    let mut views = Vec::new();
    let mut twists = Vec::new();
    let upward = reference.nearest(snake.contacts()[6]).normal.z.signum();
    for (title, rotation, surface_weight) in
        [("heights over the mesh kept", 0.0, 1.0), ("as rigid as possible", 10.0, 0.0)]
    {
        let weights = Weights { tangential: 1.0, offset: 1e-3, rotation, orthogonal: 0.0 };
        let projection = projection::Options { surface_weight, ..projection::Options::default() };
        let options =
            Options { step: 0.1, max_steps: 90, max_deviation: 2.0, weights, projection, ..Options::default() };
        let snakes = both_ways(&on(&snake, &reference), &options, 0.4)?;
        let told = told(&mut group, &snakes, &triangles)?;
        twists.push(twist(&snakes, &snake));
        group.plain(&format!("{title}: root mean square change of torsions, radians"), twists[twists.len() - 1]);
        let grid = swept_by(&snakes, PER_ARC)?;
        let signed = |i: usize, j: usize| {
            let middle = grid.corners(i, j).iter().sum::<DVec3>() / 4.0;
            let foot = reference.nearest(middle);
            (middle - foot.point).dot(foot.normal) * upward
        };
        let view = quads(View::new(title, 20.0, 50.0), &grid, &|i, j| tone(signed(i, j), FULL));
        let mut view = glass(view, &mesh, 0.12);
        for positions in snakes.iter().step_by(2) {
            view = line(view, positions, THIN, 0.9);
        }
        view = framed(line(view, &snake, INK, 3.0), mesh.points.iter().copied());
        let words = format!(
            "{};\ntorsions change by {:.2} rad, root mean square",
            in_words(&told, triangles.diagonal()),
            twists[twists.len() - 1]
        );
        views.push(view.caption(words));
    }
    group.at_least("change of torsions, heights kept over as rigid as possible", twists[0] / twists[1], 1.0);
    let scene = Scene {
        title: "As rigid as possible: a snake follows a mesh only so far".to_owned(),
        subtitle: "Swept surfaces: white on the reference mesh, red outside of it, blue inside, in full where 0.3 off; the mesh is 48 wide; black: the start".to_owned(),
        columns: 2,
        views,
    };
    group.picture = Some(scene.write(folder, "rigid")?);
    Ok(group)
}
