//! Curves of constant curvature, a snake that turns about an end, and how snakes are found on a mesh.

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::curvature_curve::{self, Course, End, Side, curvature_curve};
use shapeop::geometry::snakes::evolution::{Options, Stop, Task};
use shapeop::geometry::snakes::fit::{self, fit};
use shapeop::geometry::snakes::mesh_curve::mesh_curve;
use shapeop::mesh::file;
use shapeop::mesh::patterns::parametric_surface;
use shapeop::mesh::reference::{ParametricSurface, ReferenceMesh};
use shapeop::mesh::surfaces::graph;
use shapeop::mesh::{Mesh, ReferenceSurface, TriangleMesh};
use shapeop_cli::scene::{BLUE, INK, ORANGE, RED, Scene, View};

use super::drawing::{FAINT, SHEET, THIN, line, points, sheet};
use crate::group::Group;
use crate::own::{from_polyline, largest, shape_error};
use crate::shapes::{Jets, on, run, surface};

/// Hills: z = 0.4 sin(1.3 x) cos(1.2 y).
fn hills(half: f64) -> Result<ParametricSurface<Jets>> {
    let (a, p, q) = (0.4, 1.3, 1.2);
    surface(
        [[-half, half]; 2],
        graph(move |x: f64, y: f64| {
            let ((sx, cx), (sy, cy)) = ((p * x).sin_cos(), (q * y).sin_cos());
            [
                a * sx * cy,
                a * p * cx * cy,
                -a * q * sx * sy,
                -a * p * p * sx * cy,
                -a * p * q * cx * sy,
                -a * q * q * sx * cy,
            ]
        }),
    )
}

/// The length of all these curves.
const LENGTH: f64 = 2.3;

/// Where they begin.
const START: [f64; 2] = [0.35, 0.1];

fn curve(hills: &ParametricSurface<Jets>, kappa: f64, angle: f64) -> Result<curvature_curve::CurvatureCurve> {
    let jet = hills.at(START[0], START[1]);
    let across = jet.normal().cross(jet.first[0]).normalize();
    let tangent = angle.cos() * jet.first[0].normalize() + angle.sin() * across;
    let course = Course { curvature: &|_| kappa, length: LENGTH, side: Side::Left };
    let everywhere = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
    let options = curvature_curve::Options { steps: 400, ..curvature_curve::Options::default() };
    Ok(curvature_curve(&|u, v| hills.at(u, v), everywhere, START, tangent, &course, &options)?)
}

/// The part of the hills that is drawn.
fn ground(hills: &ParametricSurface<Jets>) -> Result<Mesh> {
    let [x, y] = START.map(|at| [at - 1.9, at + 1.9]);
    Ok(parametric_surface(97, 97, x, y, |u, v| hills.at(u, v).point)?)
}

/// It with thin lines.
fn hilly(title: &str, mesh: &Mesh) -> View {
    let mut view = sheet(View::new(title, 24.0, 40.0), mesh, SHEET);
    for k in (0..97).step_by(8) {
        let row: Vec<DVec3> = (0..97).map(|i| mesh.points[97 * k + i]).collect();
        let column: Vec<DVec3> = (0..97).map(|i| mesh.points[97 * i + k]).collect();
        view = view.line(&row, FAINT, 0.6).line(&column, FAINT, 0.6);
    }
    view
}

/// The curvature of the circle through three points.
fn curvature(p: DVec3, q: DVec3, r: DVec3) -> f64 {
    let (a, b, c) = (q - p, r - q, p - r);
    2.0 * a.cross(b).length() / (a.length() * b.length() * c.length())
}

pub fn figure7(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 7: curves of constant curvature from one point",
        "On z = 0.4 sin 1.3 x cos 1.2 y, from one point in all directions, to the left, all of one length.",
    );
    let hills = hills(3.5)?;
    let mesh = ground(&hills)?;
    let mut views = Vec::new();
    for kappa in [0.8, 1.3, 2.0] {
        let mut view = hilly(&format!("curvature {kappa}"), &mesh);
        let (count, mut whole, mut worst, mut off) = (36, 0, 0.0_f64, 0.0_f64);
        for k in 0..count {
            let found = curve(&hills, kappa, TAU * f64::from(k) / f64::from(count))?;
            whole += usize::from(found.end == End::Length);
            let three = |w: &[DVec3]| (curvature(w[0], w[3], w[6]) / kappa - 1.0).abs();
            worst = worst.max(largest(found.points.windows(7).map(three)));
            off = off.max(largest(found.points.iter().map(|p| hills.nearest(*p).point.distance(*p))));
            let colour = if k % 3 == 0 { ORANGE } else { BLUE };
            view = view.line(&found.points, colour, if k % 3 == 0 { 2.2 } else { 1.3 });
        }
        view = view.dots(&[hills.at(START[0], START[1]).point], INK, 5.0);
        group.between(&format!("curvature {kappa}: curves of the whole length"), whole as f64, [f64::from(count); 2]);
        group.at_most(&format!("curvature {kappa}: off it, from three points, in parts of it"), worst, 1e-3);
        group.at_most(&format!("curvature {kappa}: off the surface"), off, 1e-9);
        views.push(view.caption(format!("{count} directions; off the curvature by {worst:.0e} of it at most")));
    }
    let scene = Scene {
        title: "A point, a direction and a curvature determine a curve on a surface".to_owned(),
        subtitle: "Curves of one length that turn to the left, from one point in all directions; the curvature grows from left to right"
            .to_owned(),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "curvatures")?);
    Ok(group)
}

pub fn example2(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Example 3.2: a snake turns about its fixed end",
        "Ten arcs of curvature 1.6 on the hills of Fig. 7; one end stays, and the snake glides on the surface until it is back.",
    );
    let (kappa, hills) = (1.6, hills(3.5)?);
    let mesh = ground(&hills)?;
    let start = curve(&hills, kappa, 0.0)?;
    let options = fit::Options { curvature: Some(kappa), ..fit::Options::default() };
    let snake = fit(&start.points, 10, &options, &mut |_| ControlFlow::Continue(()))?.snake;
    let pivot = snake.control()[0];
    let speeds: Vec<f64> = snake.control().iter().map(|p| p.distance(pivot)).collect();
    let task = Task { fixed: &[0], speeds: &speeds, ..on(&snake, &hills) };
    let found = run(&task, &Options { step: 0.02, max_steps: 1000, ..Options::default() })?;
    group.at_least("it comes back", f64::from(found.stop == Stop::Cycle), 1.0);
    group.plain("positions", found.frames.len() as f64);
    let frames = &found.frames;
    group.at_most("the fixed end moves by", largest(frames.iter().map(|f| f.snake.control()[0].distance(pivot))), 0.0);
    group.at_most("radii and lengths", largest(frames.iter().map(|f| shape_error(&snake, &f.snake))), 1e-10);
    let deviation = largest(frames.iter().map(|f| f.deviation));
    group.plain("contacts and middles of arcs off the surface, largest", deviation);
    // Beside the curves of the same curvature that begin as the snake does.
    let jet = hills.at(START[0], START[1]);
    let across = jet.normal().cross(jet.first[0]).normalize();
    let mut apart = 0.0_f64;
    let view = |title: &str| hilly(title, &mesh);
    let (mut turning, mut curves) = (view("a snake of ten arcs, one end fixed"), view("curves of the same curvature"));
    let shown = found.frames.len().div_ceil(36).max(1);
    for (k, frame) in frames.iter().step_by(shown).enumerate() {
        let tangent = frame.snake.arcs()[0].tangent(0.0);
        let curve = curve(&hills, kappa, tangent.dot(across).atan2(tangent.dot(jet.first[0].normalize())))?;
        let fine = frame.snake.sample(60);
        apart = apart.max(largest(curve.points.iter().map(|p| from_polyline(*p, &fine))));
        let (colour, width) = if k % 3 == 0 { (ORANGE, 2.2) } else { (BLUE, 1.3) };
        turning = line(turning, &frame.snake, colour, width);
        curves = curves.line(&curve.points, colour, width);
    }
    group.plain("snakes and curves that begin alike are apart by, largest", apart);
    turning = turning.dots(&snake.contacts(), RED, 2.6).dots(&[pivot], INK, 5.0);
    curves = curves.dots(&[jet.point], INK, 5.0);
    let scene = Scene {
        title: "A snake on a surface keeps three freedoms: with an end fixed it turns".to_owned(),
        subtitle:
            "It looks like the curves of constant curvature through the point, as each position is near one of them"
                .to_owned(),
        columns: 2,
        views: vec![
            turning.caption(format!("positions of one motion all around; off the surface by {deviation:.0e} at most")),
            curves.caption(format!("apart from the snakes by {apart:.0e} at most")),
        ],
    };
    group.picture = Some(scene.write(folder, "rotation")?);
    Ok(group)
}

/// The control points that a fit begins with: halfway between where tangents at two contacts lead.
fn guess(points: &[DVec3], lengths: &[f64], count: usize, kappa: f64) -> Vec<DVec3> {
    let (last, length) = (points.len() - 1, lengths[lengths.len() - 1] / count as f64);
    let at = |j: usize| {
        let i = lengths.partition_point(|&l| l < j as f64 * length).clamp(1, last - 1);
        (points[i], (points[i + 1] - points[i - 1]).normalize())
    };
    let reach = (0.5 * length * kappa).tan() / kappa;
    let vertex = |j: usize| {
        let ((from, t), (to, u)) = (at(j), at(j + 1));
        0.5 * (from + reach * t + to - reach * u)
    };
    [vec![points[0]], (0..count).map(vertex).collect(), vec![points[last]]].concat()
}

pub fn figure9(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 9: how a snake is found on a mesh",
        "A curve of constant curvature on the gridshell, traced triangle by triangle; control points from its tangents; 4 and 12\n\
         congruent arcs fitted to it.",
    );
    let mesh = file::read("examples/meshes/botanic-garden-bubble-0.obj")?;
    let triangles = TriangleMesh::new(&mesh)?;
    let reference = ReferenceMesh::new(&triangles);
    let (kappa, length) = (0.3, 20.0);
    let course = Course { curvature: &|_| kappa, length, side: Side::Left };
    let steps = curvature_curve::Options { steps: 600, ..curvature_curve::Options::default() };
    let found = mesh_curve(&reference, triangles.points()[560], DVec3::new(1.0, -0.6, 0.0), &course, &steps)?;
    let curve = &found.curve;
    group.at_least("the curve has its length", f64::from(curve.end == End::Length), 1.0);
    group.plain("edges crossed", found.crossing_count as f64);
    let diagonal = triangles.diagonal();
    let drawn = |title: &str| drawn_mesh(View::new(title, 20.0, 50.0), &mesh);
    let along =
        drawn("the curve, triangle by triangle").line(&curve.points, ORANGE, 3.0).dots(&curve.points[..1], INK, 5.0);
    let mut views =
        vec![along.caption(format!("curvature {kappa}, length {length}; it crosses {} edges", found.crossing_count))];
    let first = guess(&curve.points, &curve.lengths, 4, kappa);
    views.push(
        drawn("control points to begin with, 4 arcs")
            .line(&curve.points, THIN, 1.6)
            .line(&in_pieces(&first), BLUE, 2.2)
            .dots(&first, BLUE, 4.5)
            .caption("halfway between where tangents lead".to_owned()),
    );
    let options = fit::Options { curvature: Some(kappa), ..fit::Options::default() };
    let mut deviations = Vec::new();
    for count in [4, 12] {
        let found = fit(&curve.points, count, &options, &mut |_| ControlFlow::Continue(()))?;
        group.at_most(&format!("{count} arcs: distances off by / diagonal"), found.residual / diagonal, 1e-13);
        let fine = found.snake.sample(400);
        let deviation = largest(curve.points.iter().map(|p| from_polyline(*p, &fine)));
        group.plain(&format!("{count} arcs: largest distance of the curve / diagonal"), deviation / diagonal);
        deviations.push(deviation);
        views.push(
            arcs(drawn(&format!("{count} congruent arcs")).line(&curve.points, THIN, 1.6), &found.snake)
                .caption(format!("apart from the curve by {:.1e} of the mesh's size at most", deviation / diagonal)),
        );
    }
    let [coarse, fine] = deviations[..] else { anyhow::bail!("two fits") };
    group.at_least("the distance falls from 4 to 12 arcs by a factor of", coarse / fine, 4.0);
    let scene = Scene {
        title: "From a curve of given curvature on a mesh to a snake".to_owned(),
        subtitle: "Gridshell of the botanic garden, 1076 quads; the curve turns to the left with curvature 0.3"
            .to_owned(),
        columns: 2,
        views,
    };
    group.picture = Some(scene.write(folder, "initialisation")?);
    Ok(group)
}

/// Straight lines in pieces, each of which is as near as it is.
fn in_pieces(points: &[DVec3]) -> Vec<DVec3> {
    points.windows(2).flat_map(|pair| (0..=24).map(|k| pair[0].lerp(pair[1], f64::from(k) / 24.0))).collect()
}

/// A mesh with thin edges.
fn drawn_mesh(view: View, mesh: &Mesh) -> View {
    view.mesh(mesh, 1.0, 0.25, &|_| SHEET)
}

/// Arcs in turn in two colours, contacts, and the control polygon.
fn arcs(mut view: View, snake: &Snake) -> View {
    let all = points(snake);
    for (j, arc) in all[..all.len() - 1].chunks(super::drawing::PER_ARC).enumerate() {
        let mut arc = arc.to_vec();
        arc.push(all[(j + 1) * super::drawing::PER_ARC]);
        view = view.line(&arc, if j % 2 == 0 { ORANGE } else { RED }, 3.6);
    }
    view.dots(&snake.contacts(), INK, 3.4)
}
