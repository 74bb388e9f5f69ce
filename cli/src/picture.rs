//! Pictures of meshes, side by side in one view, coloured by a number per face or per edge, as SVG.
//!
//! Faces are drawn from the farthest to the nearest (painter's algorithm by the mean of the corners): exact enough for
//! faces that are small against the model, and it stays a drawing of lines and areas that any program can edit.

use std::collections::HashMap;

use glam::{DVec2, DVec3};
use shapeop::mesh::Mesh;
use svg::Document;
use svg::node::element::{Circle, Group, Line, Path, Polygon, Polyline, Rectangle, Text};

use crate::camera::Camera;
use crate::colours::{PLAIN, Rgb, Scale, hex};
use crate::raster::FONT_FAMILY;

const WIDTH: f64 = 1280.0;
const MARGIN: f64 = 36.0;
const HEADER: f64 = 104.0;
const FOOTER: f64 = 44.0;
/// The room for the legend at the right.
const LEGEND: f64 = 210.0;
const LEGEND_TOP: f64 = HEADER + 40.0;
const LEGEND_HEIGHT: f64 = 260.0;
/// Height over width of the room for one mesh, at most.
const MAX_ASPECT: f64 = 1.1;
/// The share of a scale from which on a colour differs from that of 0.
const SEEN: f64 = 0.02;
/// A segment of a stroke is cut in so many pieces at most.
const MOST_PIECES: f64 = 200.0;
const INK: &str = "#1f2430";
const FAINT: &str = "#667085";
const HANDLE: &str = "#0b6fb8";
/// Of curves over a mesh, in turns.
const CURVES: [&str; 3] = ["#0b6fb8", "#b3277d", "#2e7d32"];
/// A face that stands out.
const MARKED: Rgb = [0.94, 0.45, 0.25];

/// One mesh in a picture.
pub struct Panel<'a> {
    pub mesh: &'a Mesh,
    /// Drawn as lines; without colours of their own only where there are no faces.
    pub edges: &'a [[u32; 2]],
    pub title: String,
    /// A number per face or per edge, in the unit of the scale; empty: no colours.
    pub values: Vec<f64>,
    pub on: On,
    /// The face or edge to point at.
    pub pointed_at: Option<usize>,
    /// A line under the title.
    pub caption: String,
    /// Points that are drawn to targets, each as where it is and its target.
    pub handles: Vec<[DVec3; 2]>,
    /// What is drawn besides the mesh.
    pub overlay: Overlay,
}

impl<'a> Panel<'a> {
    /// A mesh without colours.
    pub fn new(mesh: &'a Mesh, title: String) -> Self {
        Self {
            mesh,
            edges: &[],
            title,
            values: Vec::new(),
            on: On::Faces,
            pointed_at: None,
            caption: String::new(),
            handles: Vec::new(),
            overlay: Overlay::default(),
        }
    }
}

/// Curves over a mesh, and faces that stand out.
#[derive(Clone, Debug, Default)]
pub struct Overlay {
    /// Polylines, drawn thick over everything, each in a colour of its own.
    pub curves: Vec<Vec<DVec3>>,
    /// Polylines drawn thin over the mesh, all in one colour.
    pub thin_curves: Vec<Vec<DVec3>>,
    /// Faces in a colour that warns.
    pub marked: Vec<usize>,
    /// Lines on the mesh, hidden where it hides them.
    pub strokes: Vec<Stroke>,
    /// A colour for each face, where there are no values.
    pub face_colours: Vec<Rgb>,
    /// Draws no edges of faces: for meshes whose faces mean nothing.
    pub is_smooth: bool,
}

/// Of meshes to draw on.
const PALE: Rgb = [0.93, 0.935, 0.94];

impl Overlay {
    /// Lines on a mesh that is pale and without edges.
    pub fn on_pale(mesh: &Mesh, strokes: Vec<Stroke>) -> Self {
        Self { strokes, face_colours: vec![PALE; mesh.faces.len()], is_smooth: true, ..Self::default() }
    }
}

/// A line on a mesh.
#[derive(Clone, Debug)]
pub struct Stroke {
    pub points: Vec<DVec3>,
    pub colour: &'static str,
    /// In units of the picture.
    pub width: f64,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum On {
    Faces,
    Edges,
}

/// A picture of meshes that share points one to one, seen from one place.
pub struct Picture<'a> {
    pub title: String,
    pub subtitle: String,
    pub panels: Vec<Panel<'a>>,
    pub scale: Option<Scale>,
    /// Each mesh fills its room, instead of all being drawn to one measure.
    pub fits_each: bool,
}

/// What of the screen a mesh takes, in the camera's units.
#[derive(Clone, Copy)]
struct Frame {
    middle: DVec2,
    size: DVec2,
}

impl Frame {
    fn of(points: &[DVec3], camera: &Camera) -> Self {
        let on_screen = points.iter().map(|&point| camera.project(point).0);
        let low = on_screen.clone().fold(DVec2::INFINITY, DVec2::min);
        let high = on_screen.fold(DVec2::NEG_INFINITY, DVec2::max);
        if points.is_empty() {
            return Self { middle: DVec2::ZERO, size: DVec2::ONE };
        }
        Self { middle: low.midpoint(high), size: (high - low).max(DVec2::splat(f64::MIN_POSITIVE)) }
    }
}

struct Room {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Picture<'_> {
    pub fn to_svg(&self) -> String {
        self.seen_by(None, None)
    }

    /// The same from a given place: for pictures that are to be compared.
    pub fn to_svg_from(&self, camera: &Camera) -> String {
        self.seen_by(Some(camera), None)
    }

    /// The same, with room for these points: for pictures of a motion, which is to be seen in one measure.
    pub fn to_svg_within(&self, camera: &Camera, points: &[DVec3]) -> String {
        self.seen_by(Some(camera), Some(points))
    }

    fn seen_by(&self, camera: Option<&Camera>, room: Option<&[DVec3]>) -> String {
        let targets = |panel: &Panel<'_>| panel.handles.iter().map(|[_, target]| *target).collect::<Vec<_>>();
        let curves = |panel: &Panel<'_>| [panel.overlay.curves.concat(), panel.overlay.thin_curves.concat()].concat();
        let strokes =
            |panel: &Panel<'_>| panel.overlay.strokes.iter().flat_map(|s| s.points.clone()).collect::<Vec<_>>();
        let points =
            |panel: &Panel<'_>| [panel.mesh.points.clone(), targets(panel), curves(panel), strokes(panel)].concat();
        let all_points: Vec<DVec3> = self.panels.iter().flat_map(points).collect();
        let fitting = || {
            // The last: a cloth shows itself when it hangs, not while it lies.
            let normals: Vec<DVec3> = self.panels.last().into_iter().flat_map(|panel| normals_of(panel.mesh)).collect();
            Camera::fitting(&all_points, &normals)
        };
        let camera = &camera.cloned().unwrap_or_else(fitting);
        let common = Frame::of(room.unwrap_or(&all_points), camera);
        let size = common.size;

        let columns = match self.panels.len() {
            0 | 1 => 1,
            // Two wide models lie better one over the other.
            2 if size.x > 2.6 * size.y => 1,
            2 | 4 => 2,
            _ => 3,
        };
        let rows = self.panels.len().div_ceil(columns).max(1);
        let legend = if self.scale.is_some() { LEGEND } else { 0.0 };
        let panel_width = (WIDTH - 2.0 * MARGIN - legend) / columns as f64;
        let panel_height = (panel_width * (size.y / size.x).clamp(0.45, MAX_ASPECT) + 70.0).min(820.0);
        let needed_by_legend = if self.scale.is_some() { LEGEND_TOP + LEGEND_HEIGHT + FOOTER } else { 0.0 };
        let height = (HEADER + rows as f64 * panel_height + FOOTER).max(needed_by_legend);

        let mut document = Document::new()
            .set("viewBox", (0, 0, WIDTH, height.ceil()))
            .set("width", WIDTH)
            .set("height", height.ceil())
            .set("font-family", FONT_FAMILY)
            .add(Rectangle::new().set("width", "100%").set("height", "100%").set("fill", "#ffffff"))
            .add(words(&self.title, MARGIN, 50.0, 26.0, INK).set("font-weight", "bold"))
            .add(words(&self.subtitle, MARGIN, 78.0, 15.0, FAINT));
        for (i, panel) in self.panels.iter().enumerate() {
            let room = Room {
                left: MARGIN + (i % columns) as f64 * panel_width,
                top: HEADER + (i / columns) as f64 * panel_height,
                width: panel_width,
                height: panel_height,
            };
            let frame = if self.fits_each { Frame::of(&panel.mesh.points, camera) } else { common };
            document = document.add(self.draw(panel, &room, camera, frame));
        }
        if let Some(scale) = &self.scale {
            document = document.add(legend_of(scale, WIDTH - MARGIN - 92.0, LEGEND_TOP));
        }
        document.to_string()
    }

    fn draw(&self, panel: &Panel<'_>, room: &Room, camera: &Camera, frame: Frame) -> Group {
        let Frame { middle, size } = frame;
        let inset = 14.0;
        let caption = 58.0;
        let fit = ((room.width - 2.0 * inset) / size.x).min((room.height - inset - caption) / size.y);
        let fit = if fit.is_finite() { fit } else { 1.0 };
        let center = DVec2::new(room.left + 0.5 * room.width, room.top + 0.5 * (room.height - caption) + 0.5 * inset);
        let place = |point: DVec3| {
            let offset = (camera.project(point).0 - middle) * fit;
            center + DVec2::new(offset.x, -offset.y)
        };
        let mut group = Group::new();
        group = match panel.on {
            On::Faces if !panel.mesh.faces.is_empty() => self.draw_faces(group, panel, camera, &place),
            _ if !panel.edges.is_empty() => self.draw_edges(group, panel, camera, &place),
            _ => draw_points(group, panel, &place),
        };
        let Overlay { curves, thin_curves, .. } = &panel.overlay;
        let thin = thin_curves.iter().map(|curve| (curve, HANDLE, 1.4));
        let thick = curves.iter().zip(CURVES.iter().cycle()).map(|(curve, colour)| (curve, *colour, 3.2));
        for (curve, colour, width) in thin.chain(thick) {
            let points = coordinates(curve.iter().map(|&point| place(point)));
            let line = Polyline::new().set("points", points).set("fill", "none").set("stroke-linejoin", "round");
            group = group.add(line.set("stroke", colour).set("stroke-width", width).set("stroke-linecap", "round"));
        }
        for [at, target] in panel.handles.iter().map(|pair| pair.map(place)) {
            group = group.add(handle(at, target));
        }
        let (x, y) = (room.left + 0.5 * room.width, room.top + room.height - 28.0);
        let title = words(&panel.title, x, y, 15.0, INK).set("text-anchor", "middle").set("font-weight", "bold");
        group = group.add(title);
        if let Some(index) = panel.pointed_at.filter(|index| self.is_seen(panel, *index)) {
            group = group.add(pointer(self.places_of(panel, index).iter().map(|&point| place(point))));
        }
        if !panel.caption.is_empty() {
            group = group.add(words(&panel.caption, x, y + 20.0, 13.5, INK).set("text-anchor", "middle"));
        }
        group
    }

    /// True if the colour of a face or an edge differs from that of 0: what cannot be seen is no place to point at.
    fn is_seen(&self, panel: &Panel<'_>, index: usize) -> bool {
        let (Some(scale), Some(value)) = (&self.scale, panel.values.get(index)) else { return true };
        value.abs() > SEEN * scale.range[1]
    }

    /// The points of a face or of an edge.
    fn places_of(&self, panel: &Panel<'_>, index: usize) -> Vec<DVec3> {
        match panel.on {
            On::Faces => panel.mesh.faces.get(index).map(|face| panel.mesh.corners(face)).unwrap_or_default(),
            On::Edges => panel.edges.get(index).map(|edge| panel.mesh.corners(edge)).unwrap_or_default(),
        }
    }

    fn colour(&self, panel: &Panel<'_>, index: usize) -> Rgb {
        match (&self.scale, panel.values.get(index)) {
            _ if panel.on == On::Faces && panel.overlay.marked.contains(&index) => MARKED,
            (Some(scale), Some(&value)) => scale.colour(value),
            _ => panel.overlay.face_colours.get(index).copied().unwrap_or(PLAIN),
        }
    }

    fn draw_faces(&self, group: Group, panel: &Panel<'_>, camera: &Camera, place: &dyn Fn(DVec3) -> DVec2) -> Group {
        let mesh = panel.mesh;
        let mut order: Vec<(f64, Item)> =
            mesh.faces.iter().enumerate().map(|(i, face)| (nearness(mesh, face, camera), Item::Face(i))).collect();
        order.extend(pieces(panel, camera));
        // Stable: of equals the faces first.
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let edge = typical_edge(mesh, place);
        // Thin against the faces; in a dense mesh so thin that the colours are seen.
        let stroke = if panel.overlay.is_smooth { 0.8 } else { (0.03 * edge).clamp(0.12, 0.9) };
        let mut faces = group;
        for (_, item) in order {
            let i = match item {
                Item::Face(i) => i,
                Item::Piece { of, ends } => {
                    let stroke = &panel.overlay.strokes[of];
                    let [a, b] = ends.map(place);
                    faces = faces.add(line(a, b, stroke.colour, stroke.width));
                    continue;
                }
            };
            let corners = mesh.corners(&mesh.faces[i]);
            let fill = hex(self.colour(panel, i), camera.light(newell_normal(&corners)));
            let polygon = Polygon::new()
                .set("points", coordinates(corners.iter().map(|&corner| place(corner))))
                .set("fill", fill.clone());
            // A stroke in its own colour closes the seams between faces that are too small for lines.
            let is_dense = edge < 3.0 || panel.overlay.is_smooth;
            let line = match () {
                () if is_dense => fill,
                // A dark line is lost on a dark face.
                () if is_dark(self.colour(panel, i)) => "#b9a9c4".to_owned(),
                () => INK.to_owned(),
            };
            faces = faces.add(
                polygon
                    .set("stroke", line)
                    .set("stroke-width", rounded(stroke))
                    .set("stroke-linejoin", "round")
                    .set("stroke-opacity", if is_dense { 1.0 } else { 0.75 }),
            );
        }
        faces
    }

    /// Coloured lines; faces, where there are any, hide what is behind them.
    fn draw_edges(&self, group: Group, panel: &Panel<'_>, camera: &Camera, place: &dyn Fn(DVec3) -> DVec2) -> Group {
        let mesh = panel.mesh;
        let numbers: HashMap<[u32; 2], usize> =
            panel.edges.iter().zip(0..).map(|(edge, i)| (sorted(*edge), i)).collect();
        let mut is_beside_a_face = vec![false; panel.edges.len()];
        // Each face with its edges, then the edges without faces, all from the farthest to the nearest.
        let mut parts: Vec<Part<'_>> = Vec::new();
        for face in &mesh.faces {
            let pairs = face.iter().zip(face.iter().cycle().skip(1)).map(|(&a, &b)| sorted([a, b]));
            let edges: Vec<usize> = pairs.filter_map(|pair| numbers.get(&pair).copied()).collect();
            edges.iter().for_each(|&edge| is_beside_a_face[edge] = true);
            parts.push(Part { nearness: nearness(mesh, face, camera), face: Some(face), edges });
        }
        for (i, edge) in panel.edges.iter().enumerate().filter(|(i, _)| !is_beside_a_face[*i]) {
            parts.push(Part { nearness: nearness(mesh, edge, camera), face: None, edges: vec![i] });
        }
        parts.sort_by(|a, b| a.nearness.total_cmp(&b.nearness));
        // Thin in a dense mesh, so that there is something between the lines.
        let edge = typical_edge(mesh, place);
        let width = rounded(if mesh.faces.is_empty() { 1.4 } else { (0.09 * edge).clamp(0.6, 2.0) });
        let mut drawing = group;
        for Part { face, edges, .. } in parts {
            if let Some(face) = face {
                let corners = mesh.corners(face);
                let fill = hex([1.0; 3], 0.5 + 0.5 * camera.light(newell_normal(&corners)));
                let points = coordinates(corners.iter().map(|&corner| place(corner)));
                drawing = drawing.add(Polygon::new().set("points", points).set("fill", fill));
            }
            for i in edges {
                let [a, b] = panel.edges[i].map(|point| mesh.points.get(point as usize).map(|&point| place(point)));
                let (Some(a), Some(b)) = (a, b) else { continue };
                let is_coloured = panel.values.get(i).is_some();
                let colour = if is_coloured { hex(self.colour(panel, i), 1.0) } else { INK.to_owned() };
                drawing = drawing.add(line(a, b, &colour, width));
            }
        }
        drawing
    }
}

/// A face, or a piece of a stroke.
enum Item {
    Face(usize),
    Piece { of: usize, ends: [DVec3; 2] },
}

/// The strokes of a panel in pieces no longer than faces, each as near as it is, and nearer by what a face beside it can be nearer.
fn pieces(panel: &Panel<'_>, camera: &Camera) -> Vec<(f64, Item)> {
    let mesh = panel.mesh;
    if panel.overlay.strokes.is_empty() {
        return Vec::new();
    }
    let extent = |face: &Vec<u32>| {
        let corners = mesh.corners(face);
        let nearest = corners.iter().map(|&corner| camera.project(corner).1).fold(f64::NEG_INFINITY, f64::max);
        nearest - nearness(mesh, face, camera)
    };
    let lift = 2.0 * mesh.faces.iter().map(extent).fold(0.0, f64::max);
    let first_edge = |face: &Vec<u32>| mesh.corners(face).first_chunk::<2>().map_or(0.0, |[a, b]| a.distance(*b));
    let longest = mesh.faces.iter().map(first_edge).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let mut found = Vec::new();
    for (of, stroke) in panel.overlay.strokes.iter().enumerate() {
        for pair in stroke.points.windows(2) {
            let count = (pair[0].distance(pair[1]) / longest).ceil().clamp(1.0, MOST_PIECES) as usize;
            for k in 0..count {
                let at = |k: usize| pair[0].lerp(pair[1], k as f64 / count as f64);
                let ends = [at(k), at(k + 1)];
                found.push((camera.project(ends[0].midpoint(ends[1])).1 + lift, Item::Piece { of, ends }));
            }
        }
    }
    found
}

/// A face with its coloured edges, or an edge alone.
struct Part<'a> {
    nearness: f64,
    face: Option<&'a [u32]>,
    edges: Vec<usize>,
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn is_dark(colour: Rgb) -> bool {
    colour.iter().sum::<f64>() < 1.2
}

fn draw_points(mut group: Group, panel: &Panel<'_>, place: &dyn Fn(DVec3) -> DVec2) -> Group {
    for at in panel.mesh.points.iter().map(|&point| place(point)) {
        group = group.add(Circle::new().set("cx", rounded(at.x)).set("cy", rounded(at.y)).set("r", 2).set("fill", INK));
    }
    group
}

/// A dot where a handle is, a ring where it is drawn to, and a line between.
fn handle(at: DVec2, target: DVec2) -> Group {
    let circle = |place: DVec2, radius: f64| {
        Circle::new().set("cx", rounded(place.x)).set("cy", rounded(place.y)).set("r", radius)
    };
    let dot = circle(at, 3.4).set("fill", HANDLE).set("stroke", "#ffffff").set("stroke-width", 1.2);
    if at.distance(target) < 2.0 {
        return Group::new().add(dot);
    }
    let ring = circle(target, 5.0).set("fill", "none").set("stroke", HANDLE).set("stroke-width", 1.8);
    Group::new().add(line(at, target, HANDLE, 1.4).set("stroke-dasharray", "4 3")).add(ring).add(dot)
}

/// A ring around points on the screen.
fn pointer(points: impl Iterator<Item = DVec2>) -> Group {
    let points: Vec<DVec2> = points.collect();
    let middle = points.iter().sum::<DVec2>() / points.len().max(1) as f64;
    let radius = points.iter().map(|point| point.distance(middle)).fold(0.0, f64::max).max(4.0) + 5.0;
    let ring = |colour: &str, width: f64| {
        Circle::new()
            .set("cx", rounded(middle.x))
            .set("cy", rounded(middle.y))
            .set("r", rounded(radius))
            .set("fill", "none")
            .set("stroke", colour)
            .set("stroke-width", width)
    };
    Group::new().add(ring("#ffffff", 5.0)).add(ring(INK, 2.0))
}

fn legend_of(scale: &Scale, left: f64, top: f64) -> Group {
    let (width, height) = (20.0, LEGEND_HEIGHT);
    let title = words(&scale.title, WIDTH - MARGIN, top - 24.0, 14.0, INK).set("font-weight", "bold");
    let mut group = Group::new().add(title.set("text-anchor", "end"));
    let strips = 130;
    for i in 0..strips {
        let share = (f64::from(i) + 0.5) / f64::from(strips);
        let y = top + height * (1.0 - f64::from(i + 1) / f64::from(strips));
        let strip = Rectangle::new().set("x", left).set("y", rounded(y)).set("width", width).set("height", 2.6);
        group = group.add(strip.set("fill", hex(scale.at(share), 1.0)));
    }
    let frame = Rectangle::new().set("x", left).set("y", top).set("width", width).set("height", height);
    group = group.add(frame.set("fill", "none").set("stroke", INK).set("stroke-width", 0.8));
    let [low, high] = scale.range;
    let y_of = |value: f64| top + height * (1.0 - ((value - low) / (high - low)).clamp(0.0, 1.0));
    for i in 0..=4 {
        let value = low + (high - low) * f64::from(i) / 4.0;
        let y = y_of(value);
        let is_open_end = i == 4 || i == 0 && scale.is_diverging;
        let sign = if !is_open_end {
            ""
        } else if i == 4 {
            "≥ "
        } else {
            "≤ "
        };
        let label = format!("{sign}{} {}", short(value), scale.unit);
        group = group.add(line(DVec2::new(left + width, y), DVec2::new(left + width + 5.0, y), INK, 0.8));
        group = group.add(words(label.trim(), left + width + 9.0, y + 4.5, 13.0, INK));
    }
    for (word, y) in scale.end_words.iter().zip([top - 6.0, top + height + 17.0]) {
        group = group.add(words(word, left - 4.0, y, 12.0, FAINT));
    }
    if let Some((value, name)) = &scale.mark {
        let y = y_of(*value);
        let tip = Path::new().set("d", format!("M {:.1} {y:.1} l -9 -5.5 v 11 z", left - 1.0)).set("fill", INK);
        group = group.add(line(DVec2::new(left, y), DVec2::new(left + width, y), INK, 1.6)).add(tip);
        let text = words(name, left - 13.0, y + 4.5, 13.0, INK).set("text-anchor", "end");
        group = group.add(text.set("stroke", "#ffffff").set("stroke-width", 3).set("paint-order", "stroke"));
    }
    group
}

fn words(text: &str, x: f64, y: f64, size: f64, colour: &str) -> Text {
    Text::new(text).set("x", rounded(x)).set("y", rounded(y)).set("font-size", size).set("fill", colour)
}

fn line(a: DVec2, b: DVec2, colour: &str, width: f64) -> Line {
    Line::new()
        .set("x1", rounded(a.x))
        .set("y1", rounded(a.y))
        .set("x2", rounded(b.x))
        .set("y2", rounded(b.y))
        .set("stroke", colour)
        .set("stroke-width", width)
        .set("stroke-linecap", "round")
}

fn coordinates(points: impl Iterator<Item = DVec2>) -> String {
    points.map(|point| format!("{:.2},{:.2}", point.x, point.y)).collect::<Vec<_>>().join(" ")
}

/// Two decimals are finer than any screen.
fn rounded(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// A number in as many digits as a tick needs.
fn short(value: f64) -> String {
    let text = if value != 0.0 && value.abs() < 0.01 { format!("{value:.1e}") } else { format!("{value:.3}") };
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

fn nearness(mesh: &Mesh, indices: &[u32], camera: &Camera) -> f64 {
    let corners = mesh.corners(indices);
    corners.iter().map(|&corner| camera.project(corner).1).sum::<f64>() / corners.len().max(1) as f64
}

/// The median length of a face's first edge on the screen.
fn typical_edge(mesh: &Mesh, place: &dyn Fn(DVec3) -> DVec2) -> f64 {
    let mut lengths: Vec<f64> = mesh
        .faces
        .iter()
        .filter_map(|face| mesh.corners(face).first_chunk::<2>().map(|[a, b]| place(*a).distance(place(*b))))
        .collect();
    lengths.sort_by(f64::total_cmp);
    lengths.get(lengths.len() / 2).copied().unwrap_or(1.0)
}

fn normals_of(mesh: &Mesh) -> Vec<DVec3> {
    mesh.faces.iter().map(|face| newell_normal(&mesh.corners(face))).collect()
}

/// Twice the area vector of a polygon (Newell).
fn newell_normal(corners: &[DVec3]) -> DVec3 {
    let Some(&first) = corners.first() else { return DVec3::ZERO };
    corners.windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_legend_ends_above_the_lower_edge_however_flat_the_meshes_are() {
        let points = [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [9.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from).to_vec();
        let mesh = Mesh { points, faces: vec![vec![0, 1, 2, 3]] };
        let panel = || Panel { values: vec![0.5], ..Panel::new(&mesh, String::new()) };
        let (title, range, mark, end_words) = (String::new(), [0.0, 1.0], None, ["", ""]);
        let scale = Some(Scale { title, unit: "%", range, is_diverging: false, mark, end_words });
        let panels = (0..3).map(|_| panel()).collect();
        let picture = Picture { title: String::new(), subtitle: String::new(), panels, scale, fits_each: false };
        let svg = picture.to_svg();
        let height = svg.split_once("viewBox=\"0 0 1280 ").and_then(|(_, rest)| rest.split_once('"')).unwrap().0;
        assert!(height.parse::<f64>().unwrap() >= LEGEND_TOP + LEGEND_HEIGHT + 20.0, "{height}");
    }
}
