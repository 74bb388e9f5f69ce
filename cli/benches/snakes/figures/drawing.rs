//! How snakes, surfaces and coverings are drawn, and what is told of every covering.

use anyhow::{Context, Result};
use glam::{DMat3, DVec3};
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::covering::pipe;
use shapeop::geometry::snakes::evolution::{Evolution, Options, Task};
use shapeop::geometry::snakes::report::{Reference, Report, ReportOptions, report};
use shapeop::geometry::snakes::sweep::swept_grid;
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Grid, Mesh, TriangleMesh};
use shapeop_cli::colours::Rgb;
use shapeop_cli::scene::View;

use crate::group::Group;
use crate::own::{largest, shape_error, stretch};
use crate::shapes::run;

/// Arcs in turn.
pub const ARCS: [Rgb; 2] = [[0.98, 0.79, 0.30], [0.97, 0.96, 0.93]];
pub const BLUES: [Rgb; 2] = [[0.55, 0.72, 0.90], [0.93, 0.95, 0.98]];
pub const SHEET: Rgb = [0.90, 0.92, 0.94];
pub const THIN: Rgb = [0.38, 0.42, 0.50];
pub const FAINT: Rgb = [0.66, 0.70, 0.76];
pub const YELLOW: Rgb = [0.93, 0.62, 0.02];

/// Intervals of an arc that is drawn.
pub const PER_ARC: usize = 8;

/// A surface without edges.
pub fn sheet(mut view: View, mesh: &Mesh, colour: Rgb) -> View {
    for face in &mesh.faces {
        view = view.smooth_face(&mesh.corners(face), colour);
    }
    view
}

/// A surface that lets through what is behind it, with thin edges.
pub fn glass(mut view: View, mesh: &Mesh, opacity: f64) -> View {
    for face in &mesh.faces {
        let corners = mesh.corners(face);
        view = view.glass(&corners, [0.55, 0.66, 0.80], opacity);
        view = view.line(&[corners.clone(), vec![corners[0]]].concat(), FAINT, 0.35);
    }
    view
}

/// The arcs of a snake as a line.
pub fn line(view: View, snake: &Snake, colour: Rgb, width: f64) -> View {
    view.line(&points(snake), colour, width)
}

/// Points along a snake; the first again of a closed one.
pub fn points(snake: &Snake) -> Vec<DVec3> {
    let mut points = snake.sample(PER_ARC);
    points.extend(points.first().copied().filter(|_| snake.is_closed()));
    points
}

/// Quads of a grid without edges, each in the colour of its row and column.
pub fn quads(mut view: View, grid: &Grid, colour: &dyn Fn(usize, usize) -> Rgb) -> View {
    let [rows, columns] = grid.spans();
    for (i, j) in (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))) {
        view = view.smooth_face(&grid.corners(i, j), colour(i, j));
    }
    view
}

/// The surface that positions sweep, arcs in turn in two colours; `band` positions make a band, whose colours change places.
pub fn swept(view: View, snakes: &[Snake], band: usize, colours: [Rgb; 2]) -> Result<View> {
    let grid = swept_by(snakes, PER_ARC)?;
    Ok(quads(view, &grid, &|i, j| colours[(j / PER_ARC + i / band) % 2]))
}

pub fn swept_by(snakes: &[Snake], per_arc: usize) -> Result<Grid> {
    let frames: Vec<Vec<DVec3>> = snakes.iter().map(|snake| snake.control().to_vec()).collect();
    Ok(swept_grid(&snakes[0], &frames, per_arc, false)?)
}

/// Makes a view show points whatever else is in it, so that several show the same at one scale.
pub fn framed(view: View, points: impl Iterator<Item = DVec3>) -> View {
    points.fold(view, |view, p| view.line(&[p, p], [1.0; 3], 0.0))
}

/// Positions at about equal times, so far apart; the start is one.
pub fn every(found: &Evolution, time: f64) -> Vec<Snake> {
    let mut next = 0.0;
    let mut snakes = Vec::new();
    for frame in &found.frames {
        if frame.time >= next - 1e-9 {
            snakes.push(frame.snake.clone());
            next += time;
        }
    }
    snakes
}

/// Positions on both sides of the start, at equal times: those with the speeds turned around, the start, and those with the speeds
/// as they are.
pub fn both_ways(task: &Task<'_>, options: &Options, time: f64) -> Result<Vec<Snake>> {
    let turned: Vec<f64> = task.speeds.iter().map(|speed| -speed).collect();
    let [there, back] = [run(task, options)?, run(&Task { speeds: &turned, ..*task }, options)?];
    let mut snakes = every(&back, time);
    snakes.reverse();
    snakes.extend(every(&there, time).into_iter().skip(1));
    Ok(snakes)
}

/// A snake turned so that its ends are as high as each other, along the x axis, and its middle above them.
pub fn upright(snake: &Snake) -> Result<Snake> {
    let contacts = snake.contacts();
    let (first, last) = (contacts[0], contacts[contacts.len() - 1]);
    let along = (last - first).normalize();
    let middle = contacts.iter().sum::<DVec3>() / contacts.len() as f64;
    let up = (middle - first).reject_from_normalized(along).normalize();
    let turn = DMat3::from_cols(along, up.cross(along), up).transpose();
    Ok(snake.moved(snake.control().iter().map(|p| turn * (*p - first.midpoint(last))).collect())?)
}

/// The arcs of a snake as a pipe, in turn in two colours.
pub fn piped(view: View, snake: &Snake, radius: f64, colours: [Rgb; 2]) -> Result<View> {
    let grid = pipe(snake, radius, PER_ARC, 10)?;
    Ok(quads(view, &grid, &|i, _| colours[(i / PER_ARC) % 2]))
}

/// Tells of a covering: how many positions and arcs it has and of how many kinds, how far the swept surface is from the reference, in
/// parts of that one's diagonal, and which part of the reference it is near to, within 0.01 of that.
pub fn told(group: &mut Group, snakes: &[Snake], reference: &TriangleMesh) -> Result<Report> {
    let frames: Vec<Vec<DVec3>> = snakes.iter().map(|snake| snake.control().to_vec()).collect();
    let surface = ReferenceMesh::new(reference);
    let judged = Some(Reference { mesh: reference, surface: &surface });
    let found = report(&snakes[0], &frames, judged, &ReportOptions::default())?;
    let covering = found.reference.context("no surface is swept")?;
    group.plain("positions", found.positions as f64);
    group.plain("different arcs", found.kinds.len() as f64);
    group.plain("arcs in all", found.instances as f64);
    group.plain("swept surface off the reference, largest / diagonal", covering.deviation.max / reference.diagonal());
    group.plain("part of the reference that is covered", covering.coverage);
    kept(group, snakes);
    Ok(found)
}

/// Tells of edges and diagonals, which keep arcs' shapes, in parts of the snake's length.
pub fn kept(group: &mut Group, snakes: &[Snake]) {
    let off = largest(snakes.iter().map(|snake| stretch(&snakes[0], snake)));
    group.at_most("edges and diagonals / length of the snake", off / snakes[0].length(), 1e-12);
    group.plain("radii and lengths, largest change", largest(snakes.iter().map(|s| shape_error(&snakes[0], s))));
}

/// The same in words, for a caption.
pub fn in_words(found: &Report, diagonal: f64) -> String {
    let kinds = if found.kinds.len() == 1 { "1 kind".to_owned() } else { format!("{} kinds", found.kinds.len()) };
    let covering = found.reference.unwrap_or_default();
    format!(
        "{} arcs of {kinds}; off the surface by {:.1e} of its size at most,\n{:.0} % of it covered",
        found.instances,
        covering.deviation.max / diagonal,
        100.0 * covering.coverage
    )
}
