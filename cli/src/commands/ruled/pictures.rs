//! Pictures of each step: the field, boundaries, strips with their rulings, deviation, zebra stripes, planks.

use std::collections::HashMap;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::ruled::design::Design;
use shapeop::geometry::ruled::orientation;
use shapeop::geometry::ruled::report::{Report, distances};
use shapeop::geometry::ruled::tracing::{Options, Sense, Tracer};
use shapeop::geometry::ruled::trim::{Trimmed, TrimmedRuling};
use shapeop::geometry::ruled::zebra::{Eye, Stripes, zebra as stripes};
use shapeop::geometry::ruled::{Field, Strip};
use shapeop::mesh::{Mesh, SurfacePoint, TriangleMesh};

use super::measures::counted;
use super::report::BoundariesInReport;
use crate::colours::{Rgb, Scale};
use crate::picture::{Overlay, Panel, Picture, Stroke};
use crate::shown::round_up;
use crate::table::{number, percent};
use shapeop_cli::camera::Camera;

const INK: &str = "#1f2430";
const FAINT_LINE: &str = "#a9b2bd";
const OTHER_FAMILY: &str = "#e39a56";
const BOUNDARY: &str = "#b3277d";
const BEYOND: &str = "#dfa9cb";
const RULING: &str = "#5b6472";
/// Of strips, in turns.
const SHADES: [Rgb; 2] = [[0.955, 0.905, 0.800], [0.690, 0.790, 0.850]];
/// Of planks, in turns.
const WOODS: [Rgb; 2] = [[0.900, 0.770, 0.580], [0.820, 0.660, 0.450]];
/// Of stripes: dark, light.
const STRIPES: [Rgb; 2] = [[0.13, 0.14, 0.18], [0.97, 0.97, 0.95]];

/// Asymptotic curves are about so many diagonals apart.
const SPACING: f64 = 1.0 / 22.0;
/// Triangles of strips in pictures are this part of the diagonal large; those of zebra stripes this.
const FINE: f64 = 1.0 / 50.0;
const FINEST: f64 = 1.0 / 120.0;
/// Light tubes around a full turn.
const TUBES: u32 = 20;
/// A triangle is halved so often at most.
const MOST_CUTS: u32 = 14;

/// Asymptotic curves of the family of rulings, and of the other one.
pub type Families = [Vec<Vec<DVec3>>; 2];

/// The mesh that all pictures of a run show, from one place.
pub struct View<'a> {
    mesh: &'a Mesh,
    name: String,
    camera: Camera,
}

impl<'a> View<'a> {
    pub fn new(mesh: &'a Mesh, triangles: &TriangleMesh, name: String) -> Self {
        Self { mesh, name, camera: Camera::fitting(triangles.points(), triangles.point_normals()) }
    }

    fn drawn(&self, what: &str, subtitle: String, panel: Panel<'_>, scale: Option<Scale>) -> String {
        let title = format!("{}: {what}", self.name);
        Picture { title, subtitle, panels: vec![panel], scale, fits_each: false }.to_svg_from(&self.camera)
    }
}

fn panel(mesh: &Mesh, title: String, overlay: Overlay) -> Panel<'_> {
    Panel { overlay, ..Panel::new(mesh, title) }
}

fn strokes<'a>(
    lines: impl IntoIterator<Item = &'a Vec<DVec3>>,
    colour: &'static str,
    width: f64,
) -> impl Iterator<Item = Stroke> {
    lines.into_iter().map(move |points| Stroke { points: points.clone(), colour, width })
}

/// Asymptotic curves of both families, evenly apart.
pub fn families(design: &Design) -> Result<Families> {
    let mesh = design.mesh();
    let chosen = design.directions().family(0)?;
    let is_first =
        design.field().directions().iter().zip(chosen).any(|(a, b)| a.cross(*b).length() < 1e-9 && a.length() > 0.5);
    let options = orientation::Options { hint: None, allow_cut: true };
    let other = design.directions().orient(mesh, usize::from(is_first), &options)?.field;
    Ok([curves(mesh, design.field())?, curves(mesh, &other)?])
}

/// Curves of a field that are about evenly apart: from points that no curve comes near, each ends where it comes near another.
fn curves(mesh: &TriangleMesh, field: &Field) -> Result<Vec<Vec<DVec3>>> {
    let tracer = Tracer::new(mesh, field, &Options::default())?;
    let spacing = SPACING * mesh.diagonal();
    let mut taken = Taken { cells: HashMap::new(), size: spacing };
    let mut found = Vec::new();
    let count = mesh.points().len();
    // A step without common divisors spreads seeds over the mesh.
    let step = (0.618 * count as f64) as usize;
    let step = (step.max(1)..).find(|step| gcd(*step, count) == 1).unwrap_or(1);
    for seed in (0..count).map(|i| i * step % count).filter(|&i| field.is_known()[i]) {
        let position = mesh.points()[seed];
        if taken.distance(position) < spacing {
            continue;
        }
        let triangle = mesh.fan(seed)[0];
        let weights = mesh.triangles()[triangle as usize].map(|corner| f64::from(u8::from(corner as usize == seed)));
        let start = SurfacePoint { triangle, weights };
        let side = |sense: Sense| -> Result<Vec<DVec3>> {
            let positions = tracer.trace(start, sense, 3.0 * mesh.diagonal())?.positions;
            let is_free = |point: &&DVec3| taken.distance(**point) > 0.5 * spacing;
            Ok(positions.iter().take_while(is_free).copied().collect())
        };
        let (mut line, ahead) = (side(Sense::Backward)?, side(Sense::Forward)?);
        line.reverse();
        line.extend(ahead.into_iter().skip(1));
        let length: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        if length > spacing {
            line.iter().for_each(|point| taken.insert(*point));
            found.push(line);
        }
    }
    Ok(found)
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Points in cells as large as the distance that is asked for.
struct Taken {
    cells: HashMap<[i64; 3], Vec<DVec3>>,
    size: f64,
}

impl Taken {
    fn cell(&self, point: DVec3) -> [i64; 3] {
        (point / self.size).to_array().map(|x| x.floor() as i64)
    }

    fn insert(&mut self, point: DVec3) {
        let cell = self.cell(point);
        self.cells.entry(cell).or_default().push(point);
    }

    /// The distance to the nearest point in the cells around; infinite if there is none.
    fn distance(&self, point: DVec3) -> f64 {
        let [x, y, z] = self.cell(point);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        near.map(|other| other.distance(point)).fold(f64::INFINITY, f64::min)
    }
}

/// The asymptotic curves on the mesh, those that rulings follow dark.
pub fn field(view: &View<'_>, curves: &Families, family: usize) -> String {
    let lines = strokes(&curves[1], OTHER_FAMILY, 1.1).chain(strokes(&curves[0], INK, 1.7)).collect();
    let overlay = Overlay::on_pale(view.mesh, lines);
    let title = format!("family {family} dark: rulings follow it; family {} orange", 1 - family.min(1));
    let subtitle = "asymptotic curves: along them the surface bends to neither side".to_owned();
    view.drawn("the field of asymptotic directions", subtitle, panel(view.mesh, title, overlay), None)
}

/// Boundaries on the mesh, and beyond it.
pub fn boundaries(
    view: &View<'_>,
    curves: &[Vec<DVec3>],
    [on, beyond]: &[Vec<Vec<DVec3>>; 2],
    found: &BoundariesInReport,
) -> String {
    let lines = strokes(curves, FAINT_LINE, 1.0)
        .chain(strokes(beyond, BEYOND, 1.6))
        .chain(strokes(on, BOUNDARY, 2.6))
        .collect();
    let overlay = Overlay::on_pale(view.mesh, lines);
    let title = if curves.is_empty() {
        "boundaries as drawn"
    } else {
        "boundaries across asymptotic curves; pale: beyond the mesh"
    };
    let subtitle = format!("{} boundaries, {}", found.count, found.kind);
    view.drawn("strip boundaries", subtitle, panel(view.mesh, title.to_owned(), overlay), None)
}

/// Triangles of a strip in its parameters.
pub struct Part {
    parameters: Vec<[f64; 2]>,
    triangles: Vec<[u32; 3]>,
    outlines: Vec<Vec<[f64; 2]>>,
}

/// The strips in their parameters: what is left of each, or all.
pub fn parts(strips: &[Strip], trimmed: Option<&[Trimmed]>) -> Vec<Part> {
    let left = |trimmed: &Trimmed| Part {
        parameters: trimmed.parameters().to_vec(),
        triangles: trimmed.triangles().to_vec(),
        outlines: trimmed.pieces().iter().flatten().cloned().collect(),
    };
    let whole = |strip: &Strip| {
        let columns = 4 * strip.basis().spans() as u32;
        let at = |i: u32| strip.length_u() * f64::from(i) / f64::from(columns);
        let last = strip.length_u();
        Part {
            parameters: (0..=columns).flat_map(|i| [[at(i), 0.0], [at(i), 1.0]]).collect(),
            triangles: (0..columns)
                .flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]])
                .collect(),
            outlines: vec![vec![[0.0, 0.0], [last, 0.0], [last, 1.0], [0.0, 1.0]]],
        }
    };
    match trimmed {
        Some(trimmed) => trimmed.iter().map(left).collect(),
        None => strips.iter().map(whole).collect(),
    }
}

/// A triangle of a strip.
struct Place {
    strip: usize,
    /// The parameters of its corners.
    corners: [[f64; 2]; 3],
}

/// Small triangles of strips, by halving their longest edges, each with points of its own.
fn fine(strips: &[Strip], parts: &[Part], size: f64) -> (Mesh, Vec<Place>) {
    let (mut mesh, mut places) = (Mesh { points: Vec::new(), faces: Vec::new() }, Vec::new());
    for (k, (strip, part)) in strips.iter().zip(parts).enumerate() {
        let point = |[u, v]: [f64; 2]| strip.at(u, v).point;
        let corners = part.triangles.iter().map(|triangle| triangle.map(|i| part.parameters[i as usize]));
        let mut left: Vec<([[f64; 2]; 3], u32)> = corners.map(|corners| (corners, 0)).collect();
        while let Some((corners, cuts)) = left.pop() {
            let points = corners.map(point);
            let length = |i: usize| points[i].distance(points[(i + 1) % 3]);
            let longest = (0..3).fold(0, |a, b| if length(b) > length(a) { b } else { a });
            if length(longest) > size && cuts < MOST_CUTS {
                let [a, b, c] = [0, 1, 2].map(|i| corners[(longest + i) % 3]);
                let middle = [0, 1].map(|axis| 0.5 * (a[axis] + b[axis]));
                left.extend([([a, middle, c], cuts + 1), ([middle, b, c], cuts + 1)]);
                continue;
            }
            let first = mesh.points.len() as u32;
            mesh.points.extend(points);
            mesh.faces.push(vec![first, first + 1, first + 2]);
            places.push(Place { strip: k, corners });
        }
    }
    (mesh, places)
}

/// The outlines of strips in space.
fn outlines(strips: &[Strip], parts: &[Part]) -> Vec<Vec<DVec3>> {
    let along = |strip: &Strip, a: [f64; 2], b: [f64; 2]| {
        let count = ((b[0] - a[0]).abs() * 8.0).ceil().max(1.0) as u32;
        let at = |k: u32| {
            let t = f64::from(k) / f64::from(count);
            strip.at(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])).point
        };
        (0..=count).map(at).collect::<Vec<_>>()
    };
    let mut lines = Vec::new();
    for (strip, part) in strips.iter().zip(parts) {
        for outline in &part.outlines {
            let last = strip.length_u();
            for (i, &a) in outline.iter().enumerate() {
                let b = outline[(i + 1) % outline.len()];
                // The seam of a closed strip is no edge.
                let is_seam = strip.basis().is_closed() && a[0] == b[0] && (a[0] == 0.0 || a[0] == last);
                if !is_seam {
                    lines.push(along(strip, a, b));
                }
            }
        }
    }
    lines
}

/// Strips in alternating shades, with their rulings.
pub fn strips(
    view: &View<'_>,
    strips: &[Strip],
    parts: &[Part],
    rulings: &[Vec<TrimmedRuling>],
    measured: &Report,
) -> String {
    let size = Mesh { points: view.mesh.points.clone(), faces: Vec::new() }.diagonal();
    let (mesh, places) = fine(strips, parts, FINE * size);
    let pieces: Vec<Vec<DVec3>> =
        rulings.iter().flatten().flat_map(|ruling| &ruling.pieces).map(|ends| ends.to_vec()).collect();
    let edges = outlines(strips, parts);
    let overlay = Overlay {
        strokes: strokes(&pieces, RULING, 0.7).chain(strokes(&edges, INK, 1.8)).collect(),
        face_colours: places.iter().map(|of| SHADES[of.strip % 2]).collect(),
        is_smooth: true,
        ..Overlay::default()
    };
    let title = format!("{}, each with its rulings", counted(strips.len(), "strip"));
    let subtitle = format!(
        "from strips to the mesh {} at most ({} of the diagonal), gaps {}, kinks {}°",
        number(measured.strips_to_reference.max),
        percent(measured.strips_to_reference.max / size),
        number(measured.max_gap),
        number(measured.max_kink_deg)
    );
    view.drawn("ruled strips", subtitle, panel(&mesh, title, overlay), None)
}

/// The mesh coloured by its distance from strips.
pub fn deviation(view: &View<'_>, strips: &[Strip], measured: &Report, diagonal: f64) -> Result<String> {
    let middle = |face: &Vec<u32>| view.mesh.corners(face).iter().sum::<DVec3>() / face.len().max(1) as f64;
    let middles: Vec<DVec3> = view.mesh.faces.iter().map(middle).collect();
    let apart = distances(&middles, strips)?;
    let values: Vec<f64> = apart.iter().map(|distance| 100.0 * distance / diagonal).collect();
    let most = values.iter().copied().fold(0.0, f64::max);
    let worst = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b]));
    let (max, rms) = (measured.reference_to_strips.max, measured.reference_to_strips.rms);
    let mut panel = panel(view.mesh, "distance from the mesh to the nearest strip".to_owned(), Overlay::default());
    panel.overlay.is_smooth = true;
    panel.values = values;
    panel.pointed_at = worst;
    panel.caption =
        format!("at most {} ({} of the diagonal), rms {}", number(max), percent(max / diagonal), number(rms));
    let scale = Scale {
        title: "of the diagonal".to_owned(),
        unit: "%",
        range: [0.0, round_up(most)],
        is_diverging: false,
        mark: None,
        end_words: ["", ""],
    };
    let subtitle = format!("of the mesh from {}", counted(strips.len(), "strip"));
    Ok(view.drawn("deviation", subtitle, panel, Some(scale)))
}

/// Reflected stripes on the strips: they break where strips meet at an angle.
pub fn zebra(view: &View<'_>, strips: &[Strip], parts: &[Part], measured: &Report) -> Result<String> {
    let size = Mesh { points: view.mesh.points.clone(), faces: Vec::new() }.diagonal();
    let (mesh, places) = fine(strips, parts, FINEST * size);
    let corners = places.iter().flat_map(|of| of.corners.map(|[u, v]| strips[of.strip].at(u, v)));
    let (points, normals): (Vec<DVec3>, Vec<DVec3>) = corners.map(|jet| (jet.point, jet.normal())).unzip();
    let tubes = Stripes { count: TUBES, ..Stripes::default() };
    let values = stripes(&points, &normals, Eye::Along(view.camera.sight()), &tubes)?;
    // Triangles are cut where stripes end.
    let (mut drawn, mut face_colours) = (Mesh { points: Vec::new(), faces: Vec::new() }, Vec::new());
    for face in &mesh.faces {
        let corners = [0, 1, 2].map(|k| (points[face[k] as usize], values[face[k] as usize]));
        for (sign, colour) in [(-1.0, STRIPES[0]), (1.0, STRIPES[1])] {
            let part = side(corners, sign);
            if part.len() > 2 {
                let first = drawn.points.len() as u32;
                drawn.faces.push((first..first + part.len() as u32).collect());
                drawn.points.extend(part);
                face_colours.push(colour);
            }
        }
    }
    let overlay = Overlay { face_colours, is_smooth: true, ..Overlay::default() };
    let subtitle = format!(
        "kinks between strips: {}° at most, {}° in the mean",
        number(measured.max_kink_deg),
        number(measured.mean_kink_deg)
    );
    let title = "reflected stripes: they break where strips meet at an angle".to_owned();
    Ok(view.drawn("zebra stripes", subtitle, panel(&drawn, title, overlay), None))
}

/// The part of a triangle where values, linear over it, have a sign.
fn side(corners: [(DVec3, f64); 3], sign: f64) -> Vec<DVec3> {
    let mut part = Vec::with_capacity(4);
    for k in 0..3 {
        let ((a, at_a), (b, at_b)) = (corners[k], corners[(k + 1) % 3]);
        let is_in = |value: f64| if sign > 0.0 { value >= 0.0 } else { value < 0.0 };
        if is_in(at_a) {
            part.push(a);
        }
        if is_in(at_a) != is_in(at_b) {
            part.push(a.lerp(b, at_a / (at_a - at_b)));
        }
    }
    part
}

/// Planks as boxes; `plank_of` is the number of each face's plank in its strip.
pub fn planks(mesh: &Mesh, plank_of: &[usize], name: String, thickness: f64) -> String {
    let overlay = Overlay { face_colours: plank_of.iter().map(|k| WOODS[k % 2]).collect(), ..Overlay::default() };
    let title = format!("{} planks of thickness {}", mesh.faces.len() / 6, number(thickness));
    let panel = panel(mesh, title, overlay);
    let subtitle = "each a straight board with two cuts; those of a strip are stacked along its axis".to_owned();
    Picture { title: format!("{name}: planks"), subtitle, panels: vec![panel], scale: None, fits_each: false }.to_svg()
}
