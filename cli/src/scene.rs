//! Drawings of surfaces with curves, circles and spheres, several views side by side.
//!
//! Everything is drawn from the farthest to the nearest part (painter's algorithm); lines lie a little nearer than
//! they are, so that those on a surface are seen.

use std::path::Path;

use crate::colours::{Rgb, hex};
use crate::raster;
use anyhow::{Context, Result, bail};
use glam::{DVec2, DVec3};
use shapeop::geometry::circle::Circle;
use shapeop::mesh::{Grid, Mesh};
use svg::Document;
use svg::node::Blob;
use svg::node::element::{Group, Path as SvgPath, Polygon, Polyline, Rectangle, Text};

pub const WHITE: Rgb = [0.93, 0.945, 0.96];
pub const BLUE_FACE: Rgb = [0.70, 0.83, 0.97];
pub const WOOD: Rgb = [0.93, 0.83, 0.67];
pub const ORANGE: Rgb = [0.93, 0.46, 0.05];
pub const RED: Rgb = [0.80, 0.08, 0.12];
pub const BLUE: Rgb = [0.07, 0.30, 0.62];
pub const INK: Rgb = [0.12, 0.14, 0.19];

const WIDTH: f64 = 1280.0;
const MARGIN: f64 = 30.0;
const HEADER: f64 = 88.0;
const CAPTION: f64 = 52.0;
/// The height of each further line of a caption.
const CAPTION_LINE: f64 = 18.0;
/// The eye's distance over the radius of what is seen.
const DISTANCE: f64 = 7.0;
/// Shades from black to white.
const SHADES: f64 = 96.0;
/// How much nearer lines are than they are, over that radius.
const LIFT: f64 = 0.03;

/// A part of a drawing.
#[derive(Clone, Debug)]
enum Part {
    Face {
        corners: Vec<DVec3>,
        colour: Rgb,
        opacity: f64,
        edge: f64,
        is_lit: bool,
    },
    /// Polygons that are drawn as one, without seams.
    Patch {
        polygons: Vec<Vec<DVec3>>,
        colour: Rgb,
    },
    Line {
        ends: [DVec3; 2],
        colour: Rgb,
        width: f64,
    },
    Dot {
        at: DVec3,
        colour: Rgb,
        radius: f64,
    },
    Label {
        at: DVec3,
        words: String,
        colour: Rgb,
    },
}

/// One view.
#[derive(Clone, Debug)]
pub struct View {
    parts: Vec<Part>,
    /// A drawing in place of the parts, and how high it is over its width.
    sheet: Option<(String, f64)>,
    title: String,
    /// Lines.
    caption: String,
    azimuth_deg: f64,
    height_deg: f64,
}

impl View {
    /// A view from `height_deg` over the horizon, its screen turned by `azimuth_deg` about z.
    pub fn new(title: &str, azimuth_deg: f64, height_deg: f64) -> Self {
        Self {
            parts: Vec::new(),
            sheet: None,
            title: title.to_owned(),
            caption: String::new(),
            azimuth_deg,
            height_deg,
        }
    }

    /// A view of a drawing: an SVG file with a `viewBox`.
    ///
    /// # Errors
    /// It has none.
    pub fn of_sheet(title: &str, drawing: &str) -> Result<Self> {
        let numbers = drawing.split("viewBox=\"").nth(1).and_then(|rest| rest.split('"').next());
        let numbers: Vec<f64> = numbers.unwrap_or_default().split_whitespace().filter_map(|n| n.parse().ok()).collect();
        let [x, y, wide, high] = numbers[..] else { bail!("expected a drawing with a viewBox of four numbers") };
        let inner = drawing.split_once("<svg").and_then(|(_, rest)| rest.split_once('>')).map(|(_, inner)| inner);
        let inner = inner.and_then(|inner| inner.rsplit_once("</svg>")).context("expected an SVG element")?.0;
        // As if it were 1 wide and at the origin: its place is known when it is drawn.
        let transform = format!("translate({} {}) scale({})", -x / wide, -y / wide, 1.0 / wide);
        let scaled = format!("<g transform=\"{transform}\">{inner}</g>");
        Ok(Self { sheet: Some((scaled, high / wide)), ..Self::new(title, 0.0, 0.0) })
    }

    /// The unit vector from the eye to what is seen.
    pub fn sight(&self) -> DVec3 {
        -Eye::of(self).toward
    }

    pub fn caption(mut self, caption: String) -> Self {
        self.caption = caption;
        self
    }

    pub fn face(mut self, corners: &[DVec3], colour: Rgb, opacity: f64) -> Self {
        self.parts.push(Part::Face { corners: corners.to_vec(), colour, opacity, edge: 0.6, is_lit: true });
        self
    }

    /// A face without edges, as one of many that make a smooth surface.
    pub fn smooth_face(mut self, corners: &[DVec3], colour: Rgb) -> Self {
        self.parts.push(Part::Face { corners: corners.to_vec(), colour, opacity: 1.0, edge: 0.0, is_lit: true });
        self
    }

    /// A face that lets through what is behind it, without edges and in one colour wherever the light comes from.
    pub fn glass(mut self, corners: &[DVec3], colour: Rgb, opacity: f64) -> Self {
        self.parts.push(Part::Face { corners: corners.to_vec(), colour, opacity, edge: 0.0, is_lit: false });
        self
    }

    /// Polygons as one, without seams, over all faces: for a pattern on a surface of which nothing hides another part. They run
    /// around the same way.
    pub fn patch(mut self, polygons: Vec<Vec<DVec3>>, colour: Rgb) -> Self {
        self.parts.push(Part::Patch { polygons, colour });
        self
    }

    /// The faces of a grid with thin edges.
    pub fn grid(self, grid: &Grid, colour: Rgb) -> Self {
        self.grid_of(grid, 1.0, &|_| colour)
    }

    /// The faces of a grid, each in its colour.
    pub fn grid_of(mut self, grid: &Grid, opacity: f64, colour: &dyn Fn(usize) -> Rgb) -> Self {
        // Thin where faces are many.
        let edge = (12.0 / (grid.quads().count() as f64).sqrt()).clamp(0.25, 0.9);
        for (i, quad) in grid.quads().enumerate() {
            let corners = quad.map(|corner| grid.points()[corner]).to_vec();
            self.parts.push(Part::Face { corners, colour: colour(i), opacity, edge, is_lit: true });
        }
        self
    }

    /// The faces of a mesh, each in its colour, with edges of this width.
    pub fn mesh(mut self, mesh: &Mesh, opacity: f64, edge: f64, colour: &dyn Fn(usize) -> Rgb) -> Self {
        for (i, face) in mesh.faces.iter().enumerate() {
            self.parts.push(Part::Face { corners: mesh.corners(face), colour: colour(i), opacity, edge, is_lit: true });
        }
        self
    }

    /// Words at a point, over all else.
    pub fn label(mut self, at: DVec3, words: String, colour: Rgb) -> Self {
        self.parts.push(Part::Label { at, words, colour });
        self
    }

    pub fn line(mut self, points: &[DVec3], colour: Rgb, width: f64) -> Self {
        for ends in points.windows(2) {
            self.parts.push(Part::Line { ends: [ends[0], ends[1]], colour, width });
        }
        self
    }

    pub fn circle(self, circle: &Circle, colour: Rgb, width: f64) -> Self {
        let points: Vec<DVec3> = (0..=72)
            .map(|k| {
                circle.point_at(
                    circle.center + circle.radius * DVec3::new(0.3, 0.5, 0.8),
                    f64::from(k) * 5_f64.to_radians(),
                )
            })
            .collect();
        self.line(&points, colour, width)
    }

    pub fn dots(mut self, points: &[DVec3], colour: Rgb, radius: f64) -> Self {
        self.parts.extend(points.iter().map(|&at| Part::Dot { at, colour, radius }));
        self
    }

    /// A sphere as a mesh of faces.
    pub fn sphere(mut self, center: DVec3, radius: f64, colour: Rgb, opacity: f64) -> Self {
        let at = |i: u32, j: u32| {
            let (a, b) = (f64::from(i) * 10_f64.to_radians(), f64::from(j) * 10_f64.to_radians() - 90_f64.to_radians());
            center + radius * DVec3::new(b.cos() * a.cos(), b.cos() * a.sin(), b.sin())
        };
        for i in 0..36 {
            for j in 0..18 {
                let corners = vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                self.parts.push(Part::Face { corners, colour, opacity, edge: 0.0, is_lit: true });
            }
        }
        self
    }
}

/// Where the eye is.
struct Eye {
    middle: DVec3,
    radius: f64,
    right: DVec3,
    up: DVec3,
    toward: DVec3,
}

impl Eye {
    fn of(view: &View) -> Self {
        let points = || view.parts.iter().flat_map(Part::points);
        let low = points().fold(DVec3::INFINITY, DVec3::min);
        let high = points().fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle = low.midpoint(high);
        let radius = points().map(|point| point.distance(middle)).fold(1e-9, f64::max);
        let (sine, cosine) = view.azimuth_deg.to_radians().sin_cos();
        let right = DVec3::new(cosine, sine, 0.0);
        let height = view.height_deg.to_radians();
        let toward = height.sin() * DVec3::Z - height.cos() * DVec3::Z.cross(right);
        Self { middle, radius, right, up: toward.cross(right), toward }
    }

    fn project(&self, point: DVec3) -> DVec2 {
        let offset = (point - self.middle) / self.radius;
        let magnification = DISTANCE / (DISTANCE - offset.dot(self.toward));
        magnification * DVec2::new(offset.dot(self.right), -offset.dot(self.up))
    }

    fn nearness(&self, points: &[DVec3]) -> f64 {
        let mean = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        (mean - self.middle).dot(self.toward) / self.radius
    }

    /// From 0.7 to 1: lit from over the left shoulder, and a little from the right.
    fn light(&self, corners: &[DVec3]) -> f64 {
        let normal: DVec3 = (0..corners.len())
            .map(|k| (corners[k] - corners[0]).cross(corners[(k + 1) % corners.len()] - corners[0]))
            .sum();
        let Some(normal) = normal.try_normalize() else { return 1.0 };
        let normal = if normal.dot(self.toward) < 0.0 { -normal } else { normal };
        let lamp = (self.toward + 0.9 * self.up - 0.9 * self.right).normalize();
        (0.70 + 0.33 * normal.dot(lamp).max(0.0) + 0.06 * normal.dot(self.right).max(0.0)).min(1.0)
    }
}

impl Part {
    fn points(&self) -> Vec<DVec3> {
        match self {
            Self::Face { corners, .. } => corners.clone(),
            Self::Patch { polygons, .. } => polygons.concat(),
            Self::Line { ends, .. } => ends.to_vec(),
            Self::Dot { at, .. } | Self::Label { at, .. } => vec![*at],
        }
    }
}

/// Views side by side, in rows of `columns`.
pub struct Scene {
    pub title: String,
    pub subtitle: String,
    pub columns: usize,
    pub views: Vec<View>,
}

impl Scene {
    /// Writes `folder/NAME.png`; returns the file's name.
    pub fn write(&self, folder: &Path, name: &str) -> Result<String> {
        let file = folder.join(format!("{name}.png"));
        std::fs::write(&file, raster::small_png_at(&self.to_svg(), 1.0)?)?;
        Ok(file.display().to_string())
    }

    fn to_svg(&self) -> String {
        let width = (WIDTH - 2.0 * MARGIN) / self.columns as f64;
        let eyes: Vec<Eye> = self.views.iter().map(Eye::of).collect();
        let frames: Vec<[DVec2; 2]> = self.views.iter().zip(&eyes).map(|(view, eye)| frame(view, eye)).collect();
        let lines = |view: &View| view.caption.lines().count().saturating_sub(1);
        let mut document = Document::new().set("font-family", raster::FONT_FAMILY);
        let mut top = HEADER;
        let mut drawings: Vec<(usize, f64, f64)> = Vec::new();
        for row in 0..self.views.len().div_ceil(self.columns) {
            let range = row * self.columns..((row + 1) * self.columns).min(self.views.len());
            // As high as the highest needs when it fills its width, but no higher than wide.
            let aspect = |k: usize| (frames[k][1].y - frames[k][0].y) / (frames[k][1].x - frames[k][0].x);
            let height = (0.94 * width * range.clone().map(aspect).fold(0.3, f64::max).min(0.85)).min(620.0);
            let more = range.clone().map(|k| lines(&self.views[k])).max().unwrap_or(0);
            drawings.extend(range.map(|k| (k, top, height)));
            top += height + CAPTION + CAPTION_LINE * more as f64;
        }
        document = document
            .set("viewBox", (0, 0, WIDTH, (top + 8.0).ceil()))
            .set("width", WIDTH)
            .set("height", (top + 8.0).ceil())
            .add(Rectangle::new().set("width", "100%").set("height", "100%").set("fill", "#ffffff"))
            .add(text(&self.title, MARGIN, 44.0, 25.0, "#1f2430").set("font-weight", "bold"))
            .add(text(&self.subtitle, MARGIN, 70.0, 14.5, "#667085"));
        for (k, top, height) in drawings {
            let left = MARGIN + (k % self.columns) as f64 * width;
            document = draw(document, &self.views[k], &eyes[k], frames[k], [left, top, width, height]);
        }
        document.to_string()
    }
}

fn text(words: &str, x: f64, y: f64, size: f64, colour: &str) -> Text {
    Text::new(words).set("x", x).set("y", y).set("font-size", size).set("fill", colour)
}

fn frame(view: &View, eye: &Eye) -> [DVec2; 2] {
    if let Some((_, aspect)) = view.sheet {
        return [DVec2::ZERO, DVec2::new(1.0, aspect)];
    }
    let points = view.parts.iter().flat_map(Part::points).map(|point| eye.project(point));
    let empty = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    points.fold(empty, |[low, high], point| [low.min(point), high.max(point)])
}

fn draw(document: Document, view: &View, eye: &Eye, [low, high]: [DVec2; 2], room: [f64; 4]) -> Document {
    let [left, top, width, height] = room;
    let fit = (0.94 * width / (high.x - low.x)).min(height / (high.y - low.y));
    let center = DVec2::new(left + 0.5 * width, top + 0.5 * height);
    let place = |point: DVec3| center + fit * (eye.project(point) - 0.5 * (low + high));
    let listed = |points: &[DVec3]| {
        points.iter().map(|&point| place(point)).map(|p| format!("{:.1},{:.1}", p.x, p.y)).collect::<Vec<_>>().join(" ")
    };
    let nearness = |part: &Part| {
        let lift = match part {
            Part::Face { .. } => 0.0,
            // Over the faces that it is part of.
            Part::Patch { .. } => 1.0 + LIFT,
            Part::Line { .. } | Part::Dot { .. } => LIFT,
            Part::Label { .. } => f64::INFINITY,
        };
        eye.nearness(&part.points()) + lift
    };
    let mut order: Vec<(f64, &Part)> = view.parts.iter().map(|part| (nearness(part), part)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut document = document;
    if let Some((drawing, _)) = &view.sheet {
        let corner = center - 0.5 * fit * (high - low);
        let transform = format!("translate({:.2} {:.2}) scale({fit:.4})", corner.x, corner.y);
        document = document.add(Group::new().set("transform", transform).add(Blob::new(drawing)));
    }
    for (_, part) in order {
        document = match part {
            Part::Face { corners, colour, opacity, edge, is_lit } => {
                // In steps, so that pictures of many faces stay small.
                let light = if *is_lit { (SHADES * eye.light(corners)).round() / SHADES } else { 1.0 };
                let fill = hex(*colour, light);
                // The edge of a face without edges hides the seams between it and others.
                let is_seamless = *edge == 0.0 && *opacity == 1.0;
                let line = if *edge > 0.0 { "#39414f".to_owned() } else { fill.clone() };
                let width = match (*edge > 0.0, is_seamless, is_lit) {
                    (true, ..) => *edge,
                    (_, true, _) => 0.9,
                    (_, _, true) => 0.4,
                    _ => 0.0,
                };
                document.add(
                    Polygon::new()
                        .set("points", listed(corners))
                        .set("fill", fill)
                        .set("fill-opacity", *opacity)
                        .set("stroke", line)
                        .set("stroke-width", width)
                        .set("stroke-opacity", if is_seamless { 1.0 } else { 0.75 * *opacity })
                        .set("stroke-linejoin", "round"),
                )
            }
            Part::Patch { polygons, colour } => {
                let outline = |polygon: &Vec<DVec3>| format!("M{}Z", listed(polygon));
                let data: String = polygons.iter().map(outline).collect();
                document.add(SvgPath::new().set("d", data).set("fill", hex(*colour, 1.0)))
            }
            Part::Line { ends, colour, width } => document.add(
                Polyline::new()
                    .set("points", listed(ends))
                    .set("fill", "none")
                    .set("stroke", hex(*colour, 1.0))
                    .set("stroke-width", *width)
                    .set("stroke-linecap", "round"),
            ),
            Part::Dot { at, colour, radius } => {
                let at = place(*at);
                document.add(
                    svg::node::element::Circle::new()
                        .set("cx", format!("{:.1}", at.x))
                        .set("cy", format!("{:.1}", at.y))
                        .set("r", *radius)
                        .set("fill", hex(*colour, 1.0))
                        .set("stroke", "#ffffff")
                        .set("stroke-width", 0.9),
                )
            }
            Part::Label { at, words, colour } => {
                let at = place(*at);
                let written = text(words, at.x, at.y, 13.5, &hex(*colour, 1.0));
                let written = written.set("text-anchor", "middle").set("font-weight", "bold");
                let halo =
                    written.clone().set("stroke", "#ffffff").set("stroke-width", 4).set("stroke-linejoin", "round");
                document.add(halo).add(written)
            }
        };
    }
    let (x, y) = (left + 0.5 * width, top + height + 24.0);
    let title = text(&view.title, x, y, 15.0, "#1f2430").set("text-anchor", "middle").set("font-weight", "bold");
    let lines = (1..).zip(view.caption.lines());
    let line = |(k, words): (i32, &str)| text(words, x, y + 1.0 + CAPTION_LINE * f64::from(k), 13.0, "#1f2430");
    lines.map(line).fold(document.add(title), |document, line| document.add(line.set("text-anchor", "middle")))
}
