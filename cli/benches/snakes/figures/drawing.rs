//! How snakes, surfaces and coverings are drawn, and what is told of every covering.

use anyhow::Result;
use glam::{DMat3, DVec3};
use shapeop::geometry::snakes::covering::pipe;
use shapeop::geometry::snakes::evolution::{Evolution, Options, Stop, Task};
use shapeop::geometry::snakes::sweep::{arc_kinds, swept_grid};
use shapeop::geometry::snakes::{ArcShape, Snake};
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Grid, Mesh, ReferenceSurface, TriangleMesh};
use shapeop_cli::colours::Rgb;
use shapeop_cli::scene::View;

use crate::group::Group;
use crate::own::{largest, shape_error};
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

/// A surface that lets through what is behind it.
pub fn glass(mut view: View, mesh: &Mesh, opacity: f64) -> View {
    for face in &mesh.faces {
        view = view.glass(&mesh.corners(face), [0.55, 0.66, 0.80], opacity);
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

/// Positions so many apart along an evolution, the last one included.
pub fn every(found: &Evolution, step: usize) -> Vec<Snake> {
    found.frames.iter().step_by(step).map(|frame| frame.snake.clone()).collect()
}

/// Positions on both sides of the start: those with the speeds turned around, the start, and those with the speeds as they are.
pub fn both_ways(task: &Task<'_>, options: &Options, step: usize) -> Result<(Vec<Snake>, [Stop; 2])> {
    let back: Vec<f64> = task.speeds.iter().map(|speed| -speed).collect();
    let [there, back] = [run(task, options)?, run(&Task { speeds: &back, ..*task }, options)?];
    let stops = [there.stop, back.stop];
    let mut snakes = every(&back, step);
    snakes.reverse();
    snakes.extend(every(&there, step).into_iter().skip(1));
    Ok((snakes, stops))
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

/// What a covering comes to.
pub struct Told {
    pub kinds: usize,
    pub instances: usize,
    pub deviation: f64,
    pub coverage: f64,
}

/// Tells of a covering: its different arcs, how many there are, how far the swept surface is from the reference, in parts of that
/// one's diagonal, and which part of the reference is within `near` of it, in the same.
pub fn told(group: &mut Group, snakes: &[Snake], reference: &TriangleMesh, near: f64) -> Result<Told> {
    let arcs: Vec<ArcShape> = snakes.iter().flat_map(|snake| snake.shapes().to_vec()).collect();
    let kinds = arc_kinds(&arcs, 1e-9)?.len();
    let grid = swept_by(snakes, PER_ARC)?;
    let surface = ReferenceMesh::new(reference);
    let diagonal = reference.diagonal();
    let off = |p: &DVec3| surface.nearest(*p).point.distance(*p);
    let deviation = largest(grid.points().iter().map(off)) / diagonal;
    let cover = TriangleMesh::new(&grid.mesh())?;
    let cover = ReferenceMesh::new(&cover);
    let (mut covered, mut all) = (0.0, 0.0);
    for t in 0..reference.triangles().len() {
        let middle = reference.corners(t).iter().sum::<DVec3>() / 3.0;
        let foot = cover.nearest(middle);
        all += reference.area(t);
        if foot.overhang == 0.0 && foot.point.distance(middle) <= near * diagonal {
            covered += reference.area(t);
        }
    }
    let told = Told { kinds, instances: arcs.len(), deviation, coverage: covered / all };
    group.plain("positions", snakes.len() as f64);
    group.plain("different arcs", kinds as f64);
    group.plain("arcs in all", arcs.len() as f64);
    group.plain("swept surface off the reference, largest / diagonal", deviation);
    group.plain(&format!("part of the reference within {near} of the diagonal"), told.coverage);
    group.at_most("radii and lengths", largest(snakes.iter().map(|s| shape_error(&snakes[0], s))), 1e-10);
    Ok(told)
}

/// The same in words, for a caption.
pub fn in_words(told: &Told) -> String {
    let kinds = if told.kinds == 1 { "1 kind of arc".to_owned() } else { format!("{} kinds of arcs", told.kinds) };
    format!(
        "{} arcs, {kinds}; off the surface by {:.1e} of its size at most,\n{:.1} % of it covered",
        told.instances,
        told.deviation,
        100.0 * told.coverage
    )
}
