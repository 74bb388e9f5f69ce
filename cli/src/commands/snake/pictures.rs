//! Pictures of snakes: their positions, the surface swept, coverings, linkages, arrays; and the motion as an animation.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::covering::pipe;
use shapeop::geometry::snakes::sweep::swept_grid;
use shapeop::mesh::{Grid, Mesh, ReferenceSurface as _, TriangleMesh};

use super::coverings::joined;
use super::made::{MOST_ANIMATED, Made, every};
use super::report::Report;
use crate::animation::Animation;
use crate::colours::{Rgb, Scale};
use crate::commands::recipe::file_name;
use crate::picture::{Overlay, Panel, Picture, Stroke};
use crate::raster;
use crate::shown::round_up;
use crate::table::{number, percent};
use shapeop_cli::camera::Camera;

/// Of arcs, in turns along a snake: lines, strips of a swept surface, pipes.
const ARC_LINES: [&str; 2] = ["#b45309", "#1d4f8f"];
const STRIPS: [Rgb; 2] = [[0.975, 0.880, 0.640], [0.700, 0.795, 0.900]];
const PIPES: [Rgb; 2] = [[0.960, 0.720, 0.250], [0.965, 0.965, 0.950]];
/// Of coverings, in turns from position to position.
const WOODS: [Rgb; 2] = [[0.900, 0.770, 0.580], [0.820, 0.660, 0.450]];
const RAIL: &str = "#b3277d";
const FAINT_LINE: &str = "#8a94a3";

/// Positions drawn as lines, and rows of swept surfaces in pictures, at most.
const MOST_LINES: usize = 30;
const MOST_ROWS: usize = 90;
/// Positions in a picture of a linkage, and side by side.
const MOST_PIPES: usize = 5;
const SIDE_BY_SIDE: usize = 6;
/// Intervals of each arc.
const FINE: usize = 8;
/// Points around pipes that stand for arcs.
const AROUND: usize = 8;
/// The radius of such pipes over the size of what is seen, and at most over the least radius of an arc.
const PIPE_PART: f64 = 0.012;
const PIPE_MOST: f64 = 0.4;
/// Pixels of animations per unit of a picture.
const ANIMATION_SCALE: f32 = 0.6;
/// Hundredths of a second of each position, and of the last one of a motion that does not come back.
const DELAY: u16 = 8;
const LAST_DELAY: u16 = 150;

/// What all pictures of a run show, from one place.
pub struct View<'a> {
    made: &'a Made<'a>,
    snakes: &'a [Snake],
    name: String,
    camera: Camera,
    /// Points that all fit into the pictures of a motion.
    room: Vec<DVec3>,
    /// The surface swept, in no more rows than are seen, and which positions these are.
    swept: Option<Grid>,
}

/// So many numbers below `count` at most, evenly apart but for the last.
fn spread(count: usize, most: usize) -> Vec<usize> {
    let step = count.saturating_sub(1).div_ceil(most - 1).max(1);
    every(count, step)
}

/// The same of what goes around: the last is followed by the first.
fn spread_around(count: usize, most: usize) -> Vec<usize> {
    if count <= most { (0..count).collect() } else { (0..most).map(|k| k * count / most).collect() }
}

fn panel(mesh: &Mesh, title: String, overlay: Overlay) -> Panel<'_> {
    Panel { overlay, ..Panel::new(mesh, title) }
}

fn stroke(points: &[DVec3], colour: &'static str, width: f64) -> Stroke {
    Stroke { points: points.to_vec(), colour, width }
}

/// A line for each arc, in turns of two colours.
fn arc_strokes(snake: &Snake, width: f64) -> Vec<Stroke> {
    let line = |(j, arc): (usize, shapeop::geometry::snakes::Arc)| {
        let points: Vec<DVec3> = (0..=2 * FINE).map(|k| arc.point(k as f64 / (2 * FINE) as f64)).collect();
        stroke(&points, ARC_LINES[j % 2], width)
    };
    snake.arcs().into_iter().enumerate().map(line).collect()
}

/// Pipes that stand for the arcs of snakes, in turns of two colours.
fn arc_pipes(snakes: &[Snake], size: f64) -> (Mesh, Vec<Rgb>) {
    let (mut grids, mut colours) = (Vec::new(), Vec::new());
    for snake in snakes {
        let least = snake.shapes().iter().map(|shape| shape.radius).fold(f64::INFINITY, f64::min);
        // What cannot be a pipe is left out of a picture.
        let Ok(grid) = pipe(snake, (PIPE_PART * size).min(PIPE_MOST * least), FINE, AROUND) else { continue };
        let arc = |quad: usize| quad / AROUND / FINE;
        colours.extend((0..grid.quads().count()).map(|quad| PIPES[arc(quad) % 2]));
        grids.push(grid);
    }
    (joined(&grids), colours)
}

/// The colours of the faces of a swept surface, in turns from arc to arc.
fn strip_colours(grid: &Grid) -> Vec<Rgb> {
    let columns = grid.spans()[1];
    (0..grid.quads().count()).map(|quad| STRIPS[quad % columns / FINE % 2]).collect()
}

fn diagonal(points: &[DVec3]) -> f64 {
    Mesh { points: points.to_vec(), faces: Vec::new() }.diagonal()
}

fn normals(mesh: &Mesh) -> Vec<DVec3> {
    let normal = |face: &Vec<u32>| {
        let corners = mesh.corners(face);
        (1..corners.len().saturating_sub(1))
            .map(|k| (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]))
            .sum::<DVec3>()
    };
    mesh.faces.iter().map(normal).collect()
}

impl<'a> View<'a> {
    pub fn new(made: &'a Made<'a>, snakes: &'a [Snake], input: &Path) -> Result<Self> {
        let rows =
            if made.comes_back { spread_around(snakes.len(), MOST_ROWS) } else { spread(snakes.len(), MOST_ROWS) };
        let frames: Vec<Vec<DVec3>> = rows.iter().map(|&i| made.frames[i].clone()).collect();
        let swept = if frames.len() < 2 {
            None
        } else {
            Some(swept_grid(&made.snake, &frames, FINE, made.comes_back && frames.len() > 2)?)
        };
        let mut room: Vec<DVec3> = made.surface.map_or(Vec::new(), |(mesh, _)| mesh.points.clone());
        room.extend(snakes.iter().flat_map(|snake| snake.sample(2)));
        room.extend(made.lines.iter().flatten());
        let faces = match (made.surface, &swept) {
            (Some((mesh, _)), _) => normals(mesh),
            (None, Some(grid)) => normals(&grid.mesh()),
            _ => vec![DVec3::Z],
        };
        let camera = Camera::fitting(&room, &faces);
        Ok(Self { made, snakes, name: file_name(input), camera, room, swept })
    }

    fn drawn(&self, what: &str, subtitle: String, panels: Vec<Panel<'_>>, scale: Option<Scale>) -> String {
        let title = format!("{}: {what}", self.name);
        Picture { title, subtitle, panels, scale, fits_each: false }.to_svg_within(&self.camera, &self.room)
    }

    /// What lines lie on: the mesh given, or the surface swept.
    fn ground(&self) -> Mesh {
        match (self.made.surface, &self.swept) {
            (Some((mesh, _)), _) => mesh.clone(),
            (None, Some(grid)) => grid.mesh(),
            _ => arc_pipes(&self.snakes[..1], diagonal(&self.room)).0,
        }
    }

    fn guides(&self) -> impl Iterator<Item = Stroke> + '_ {
        self.made.lines.iter().map(|line| stroke(line, RAIL, 1.8))
    }

    /// The positions and the surface that they sweep.
    pub fn main(&self, report: &Report) -> Result<String> {
        let count = self.snakes.len();
        let arcs = self.made.snake.shapes().len();
        let kinds = report.measures.as_ref().map_or(1, |measures| measures.covering.kinds.len());
        let word = if kinds == 1 { "one kind" } else { "kinds" };
        let kinds = if kinds == 1 { String::new() } else { format!("{kinds} ") };
        let subtitle = format!("{count} positions of {arcs} arcs of {kinds}{word}");
        let swept = self.swept.as_ref().map(Grid::mesh);
        if self.made.is_linkage {
            let chosen: Vec<Snake> =
                spread_around(count, MOST_PIPES).into_iter().map(|i| self.snakes[i].clone()).collect();
            let (pipes, face_colours) = arc_pipes(&chosen, diagonal(&self.room));
            let overlay = Overlay { strokes: self.paths(), face_colours, is_smooth: true, ..Overlay::default() };
            let title = format!("{} positions, and the paths of contacts", chosen.len());
            let mut panels = vec![panel(&pipes, title, overlay)];
            if let (Some(mesh), Some(grid)) = (&swept, &self.swept) {
                let overlay = Overlay {
                    strokes: self.paths(),
                    face_colours: strip_colours(grid),
                    is_smooth: true,
                    ..Overlay::default()
                };
                panels.push(panel(mesh, "the surface that the arcs sweep".to_owned(), overlay));
            }
            return Ok(self.drawn("a linkage of arcs", subtitle, panels, None));
        }
        let ground = self.ground();
        let lines = || spread(count, MOST_LINES).into_iter();
        let mut strokes: Vec<Stroke> = self.guides().collect();
        strokes.extend(lines().flat_map(|i| arc_strokes(&self.snakes[i], if i == 0 { 3.0 } else { 1.5 })));
        let mut panels = Vec::new();
        if self.made.surface.is_some() || swept.is_none() {
            panels.push(panel(
                &ground,
                "positions of the snake, the start thick".to_owned(),
                Overlay::on_pale(&ground, strokes),
            ));
        }
        if let (Some(mesh), Some(grid)) = (&swept, &self.swept) {
            let mut strokes: Vec<Stroke> = lines().map(|i| stroke(&self.whole(i), FAINT_LINE, 0.9)).collect();
            strokes.extend(self.guides());
            let face_colours = strip_colours(grid);
            let overlay = Overlay { strokes, face_colours, is_smooth: true, ..Overlay::default() };
            panels.push(panel(mesh, "the surface swept, arc by arc".to_owned(), overlay));
        }
        Ok(self.drawn("a snake of circular arcs", subtitle, panels, None))
    }

    /// A position as one line.
    fn whole(&self, i: usize) -> Vec<DVec3> {
        let snake = &self.snakes[i];
        let mut points = snake.sample(FINE);
        points.extend(points.first().copied().filter(|_| snake.is_closed()));
        points
    }

    /// The paths of contacts; those that come back are closed.
    fn paths(&self) -> Vec<Stroke> {
        let path = |line: &Vec<DVec3>| {
            let mut points = line.clone();
            points.extend(line.first().copied().filter(|_| self.made.comes_back));
            stroke(&points, RAIL, 1.6)
        };
        // The first and the last contact stay.
        let inner = self.made.lines.len().saturating_sub(1);
        self.made.lines.iter().take(inner).skip(1).map(path).collect()
    }

    /// The surface swept, coloured by its distance from the mesh.
    pub fn deviation(&self, report: &Report) -> Option<String> {
        let ((_, reference), grid) = (self.made.surface?, self.swept.as_ref()?);
        let mesh = grid.mesh();
        let size = reference.mesh().diagonal();
        let apart = |face: &Vec<u32>| {
            let middle = mesh.corners(face).iter().sum::<DVec3>() / face.len() as f64;
            100.0 * reference.nearest(middle).point.distance(middle) / size
        };
        let values: Vec<f64> = mesh.faces.iter().map(apart).collect();
        let most = values.iter().copied().fold(0.0, f64::max);
        let worst = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b]));
        let mut panel = panel(&mesh, "distance of the swept surface from the mesh".to_owned(), Overlay::default());
        panel.overlay.is_smooth = true;
        panel.values = values;
        panel.pointed_at = worst;
        panel.caption = format!("at most {} ({} of the diagonal)", number(0.01 * most * size), percent(0.01 * most));
        let scale = Scale {
            title: "of the diagonal".to_owned(),
            unit: "%",
            range: [0.0, round_up(most)],
            is_diverging: false,
            mark: None,
            end_words: ["", ""],
        };
        let covered = report.measures.as_ref().and_then(|measures| measures.covering.reference.as_ref());
        let subtitle =
            covered.map_or(String::new(), |covering| format!("covers {} of the mesh", percent(covering.coverage)));
        Some(self.drawn("deviation", subtitle, vec![panel], Some(scale)))
    }

    /// Pipes or lamellae.
    pub fn covering(&self, what: &str, grids: &[Grid]) -> String {
        let mesh = joined(grids);
        let colours = grids.iter().enumerate().flat_map(|(i, grid)| vec![WOODS[i % 2]; grid.quads().count()]);
        let overlay = Overlay { face_colours: colours.collect(), is_smooth: true, ..Overlay::default() };
        let panels = vec![panel(&mesh, "along the positions of the snake".to_owned(), overlay)];
        let subtitle = "each piece stands for an arc that is made many times".to_owned();
        let title = format!("{}: {what}", self.name);
        Picture { title, subtitle, panels, scale: None, fits_each: false }.to_svg_from(&self.camera)
    }

    /// Copies of a linkage side by side.
    pub fn array(&self) -> Result<Option<String>> {
        let Some(copies) = self.made.arrays.first() else { return Ok(None) };
        let (mesh, overlay) = self.pipes_of(copies)?;
        let title = format!("{} copies, each at another instant of one motion", copies.len());
        let panels = vec![panel(&mesh, title, overlay)];
        let subtitle = "all flex together, driven by one".to_owned();
        let picture = Picture {
            title: format!("{}: an array of linkages", self.name),
            subtitle,
            panels,
            scale: None,
            fits_each: false,
        };
        Ok(Some(picture.to_svg()))
    }

    fn pipes_of(&self, copies: &[Vec<DVec3>]) -> Result<(Mesh, Overlay)> {
        let snakes =
            copies.iter().map(|control| Ok(self.made.snake.moved(control.clone())?)).collect::<Result<Vec<_>>>()?;
        let (mesh, face_colours) = arc_pipes(&snakes, diagonal(&self.room));
        Ok((mesh, Overlay { face_colours, is_smooth: true, ..Overlay::default() }))
    }

    /// Six positions side by side.
    pub fn strip(&self) -> Result<String> {
        let chosen = match self.made.comes_back {
            true => spread_around(self.snakes.len(), SIDE_BY_SIDE),
            false => spread(self.snakes.len(), SIDE_BY_SIDE),
        };
        let drawn: Vec<(Mesh, Overlay)> = chosen.iter().map(|&i| self.position(i, false)).collect();
        let title = |i: usize| format!("position {i} of {}", self.snakes.len() - 1);
        let panels = drawn.iter().zip(&chosen).map(|((mesh, overlay), &i)| panel(mesh, title(i), overlay.clone()));
        Ok(self.drawn("on its way", "the same arcs in each position".to_owned(), panels.collect(), None))
    }

    /// A position, and where the snake was before.
    fn position(&self, i: usize, with_trail: bool) -> (Mesh, Overlay) {
        if self.made.is_linkage {
            let (mesh, face_colours) = arc_pipes(&self.snakes[i..=i], diagonal(&self.room));
            return (mesh, Overlay { face_colours, is_smooth: true, strokes: self.paths(), ..Overlay::default() });
        }
        let ground = self.ground();
        let mut strokes: Vec<Stroke> = self.guides().collect();
        if with_trail {
            let before = spread(self.snakes.len(), MOST_LINES).into_iter().filter(|&k| k < i);
            strokes.extend(before.map(|k| stroke(&self.whole(k), FAINT_LINE, 1.2)));
        }
        strokes.extend(arc_strokes(&self.snakes[i], 4.0));
        let overlay = Overlay::on_pale(&ground, strokes);
        (ground, overlay)
    }
}

/// The motion as a GIF: from one place, all in one measure.
pub fn animation(view: &View<'_>) -> Result<Vec<u8>> {
    let mut animation = Animation::default();
    let mut add = |picture: &Picture<'_>, camera: &Camera, room: &[DVec3]| {
        animation.add(raster::rgb_at(&picture.to_svg_within(camera, room), ANIMATION_SCALE)?)
    };
    let of = |mesh: &Mesh, overlay: Overlay, add: &mut dyn FnMut(&Picture<'_>) -> Result<()>| {
        let panels = vec![panel(mesh, String::new(), overlay)];
        let (title, subtitle) = (view.name.clone(), "every arc keeps its radius and length".to_owned());
        add(&Picture { title, subtitle, panels, scale: None, fits_each: false })
    };
    if view.made.arrays.is_empty() {
        let chosen = match view.made.comes_back {
            true => spread_around(view.snakes.len(), MOST_ANIMATED),
            false => spread(view.snakes.len(), MOST_ANIMATED),
        };
        for i in chosen {
            let (mesh, overlay) = view.position(i, true);
            of(&mesh, overlay, &mut |picture| add(picture, &view.camera, &view.room))?;
        }
    } else {
        let room: Vec<DVec3> = view.made.arrays.iter().flatten().flatten().copied().collect();
        let camera = Camera::fitting(&room, &[]);
        for copies in &view.made.arrays {
            let (mesh, overlay) = view.pipes_of(copies)?;
            of(&mesh, overlay, &mut |picture| add(picture, &camera, &room))?;
        }
    }
    animation.encode(DELAY, if view.made.comes_back { DELAY } else { LAST_DELAY })
}

/// A snake beside the curve that it was fitted to.
pub fn fitted(snake: &Snake, curve: &[DVec3], report: &Report) -> Result<String> {
    let (mesh, face_colours) = arc_pipes(std::slice::from_ref(snake), diagonal(curve));
    let overlay = Overlay { face_colours, is_smooth: true, thin_curves: vec![curve.to_vec()], ..Overlay::default() };
    let off = report.start.as_ref().and_then(|start| start.fit_deviation).unwrap_or(0.0);
    let title = format!("{} arcs, in turns; blue: the curve", snake.shapes().len());
    let picture = Picture {
        title: format!("{}: arcs along a curve", file_name(Path::new(&report.input))),
        subtitle: format!("{} apart at most", number(off)),
        panels: vec![panel(&mesh, title, overlay)],
        scale: None,
        fits_each: false,
    };
    Ok(picture.to_svg())
}

/// Curves on a mesh.
pub fn curves(mesh: &Mesh, triangles: &TriangleMesh, lines: &[Vec<DVec3>], report: &Report) -> String {
    let strokes = lines.iter().enumerate().map(|(k, line)| stroke(line, ARC_LINES[k % 2], 2.4)).collect();
    let title = match lines.len() {
        1 => "a curve of constant curvature".to_owned(),
        count => format!("{count} curves of constant curvature"),
    };
    let camera = Camera::fitting(triangles.points(), triangles.point_normals());
    let picture = Picture {
        title: format!("{}: {title}", file_name(Path::new(&report.input))),
        subtitle: "from one point and in one direction".to_owned(),
        panels: vec![panel(mesh, String::new(), Overlay::on_pale(mesh, strokes))],
        scale: None,
        fits_each: false,
    };
    picture.to_svg_from(&camera)
}
