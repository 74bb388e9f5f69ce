//! A surface that a command made, and the files of it: mesh, surface, picture, report.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Result, bail};
use glam::DVec3;
use serde::Serialize;
use serde_json::{Map, Value};
use shapeop::geometry::canal::folds::Folds;
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::quality::Quality;
use shapeop::geometry::canal::surface::{BaseKind, SuperCanal};
use shapeop::mesh::{ClosestPoints, Grid, Mesh};

use crate::args::canal::CanalOutputArgs;
use crate::commands::recipe::file_name;
use crate::curve_file::{Curve, CurveInReport};
use crate::output::{Output, say};
use crate::picture::{Overlay, Panel, Picture};
use crate::table::{aligned, number};

/// Residuals above this are told as a warning: round-off stays far below.
const NOT_CIRCULAR: f64 = 1e-8;

/// The version of the report's form.
const VERSION: u32 = 1;

/// Faces or rows that a warning names.
const MOST_NAMED: usize = 8;

/// A surface with what it was made from.
pub struct Made {
    pub surface: SuperCanal,
    /// What it was made from, and whether the mesh is meant to meet it.
    pub curves: Vec<(&'static str, Curve, bool)>,
    /// Curves that the picture shows and the report does not list.
    drawn: Vec<Vec<DVec3>>,
    /// What the command found, by name, for the report and the summary.
    pub found: Map<String, Value>,
    pub warnings: Vec<String>,
    /// Whether rows are sections orthogonal to column 0, so that its evolute limits them.
    pub has_evolute: bool,
    /// How each face is cut if nothing is asked for.
    pub refine: [usize; 2],
}

impl Made {
    pub fn new(surface: SuperCanal) -> Self {
        let has_evolute = has_evolute(&surface);
        Self {
            surface,
            curves: Vec::new(),
            drawn: Vec::new(),
            found: Map::new(),
            warnings: Vec::new(),
            has_evolute,
            refine: [1, 1],
        }
    }

    pub fn curve(mut self, what: &'static str, curve: &Curve, is_met: bool) -> Self {
        self.curves.push((what, curve.clone(), is_met));
        self
    }

    pub fn drawn(mut self, curve: Vec<DVec3>) -> Self {
        self.drawn.push(curve);
        self
    }

    pub fn find(&mut self, name: &str, value: impl Serialize) {
        self.found.insert(name.to_owned(), serde_json::to_value(value).unwrap_or_default());
    }

    pub fn warn(&mut self, warning: impl Into<String>) {
        self.warnings.push(warning.into());
    }
}

/// Whether the rows of a surface are sections orthogonal to its guide, as far as is known.
pub fn has_evolute(surface: &SuperCanal) -> bool {
    surface.kind() == BaseKind::Moulding && surface.chain().is_empty() || surface.base().grid().columns() == 2
}

#[derive(Serialize)]
pub struct Report {
    version: u32,
    program: &'static str,
    command: String,
    input: String,
    /// The name of the family, such as MC-canal.
    family: String,
    /// Rows and columns of points of the surface, and of the mesh.
    surface: [usize; 2],
    mesh: [usize; 2],
    wraps: [bool; 2],
    faces: usize,
    curves: Vec<CurveInReport>,
    /// What the command found.
    found: Map<String, Value>,
    pub measures: Measures,
    warnings: Vec<String>,
    files: BTreeMap<String, String>,
}

/// How planar and circular a grid of faces is, and where it folds.
#[derive(Clone, Debug, Serialize)]
pub struct Measures {
    pub planarity: Worst,
    pub concyclicity: Worst,
    pub crossed_faces: Vec<usize>,
    pub flipped_faces: Vec<usize>,
    pub shrunk_faces: Vec<usize>,
    /// Rows of the surface that reach at least 80 % of the way to the evolute of the guide; empty where that means nothing.
    pub rows_near_evolute: Vec<usize>,
}

/// The largest of some residuals, and the face.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Worst {
    pub max: f64,
    pub face: usize,
}

impl Worst {
    fn of(residuals: &[f64]) -> Self {
        let worst = (0..residuals.len()).fold(0, |a, b| if residuals[b] > residuals[a] { b } else { a });
        Self { max: residuals.get(worst).copied().unwrap_or(0.0), face: worst }
    }
}

impl Measures {
    pub fn of(grid: &Grid, has_evolute: bool) -> Self {
        let (quality, folds) = (Quality::of(grid), Folds::of(grid));
        let crossed = |(face, is_in_order): (usize, &bool)| (!is_in_order).then_some(face);
        Self {
            planarity: Worst::of(&quality.planarity),
            concyclicity: Worst::of(&quality.concyclicity),
            crossed_faces: quality.is_in_order.iter().enumerate().filter_map(crossed).collect(),
            flipped_faces: folds.flipped_faces,
            shrunk_faces: folds.shrunk_faces,
            rows_near_evolute: if has_evolute { folds.rows_near_evolute } else { Vec::new() },
        }
    }

    /// What is not as it should be, in words.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.planarity.max.max(self.concyclicity.max) > NOT_CIRCULAR {
            warnings.push("faces are not planar and circular".to_owned());
        }
        for (list, what) in [
            (&self.crossed_faces, "faces cross themselves"),
            (&self.flipped_faces, "faces are turned against their neighbours"),
            (&self.shrunk_faces, "faces have shrunk to slivers"),
            (&self.rows_near_evolute, "rows come near the evolute of the guide, where panels shrink and fold"),
        ] {
            if !list.is_empty() {
                warnings.push(format!("{what}: {}", named(list)));
            }
        }
        warnings
    }

    /// The faces to point at.
    fn marked(&self) -> Vec<usize> {
        [self.crossed_faces.as_slice(), &self.flipped_faces, &self.shrunk_faces].concat()
    }
}

/// The first of a list of places.
pub fn named(list: &[usize]) -> String {
    let names: Vec<String> = list.iter().take(MOST_NAMED).map(usize::to_string).collect();
    let rest = if list.len() > MOST_NAMED { format!(", ... ({} in all)", list.len()) } else { String::new() };
    format!("{}{rest}", names.join(", "))
}

/// How each face is cut.
pub fn pieces(args: &CanalOutputArgs, default: [usize; 2]) -> Result<[usize; 2]> {
    match args.refine.as_deref() {
        None => Ok(default),
        Some(&[one, two]) if one > 0 && two > 0 => Ok([one, two]),
        Some(found) => bail!("refine: expected two numbers above 0, found {found:?}"),
    }
}

/// The net of a surface whose faces are cut.
pub fn refined(surface: &SuperCanal, [one, two]: [usize; 2]) -> Result<Net> {
    if [one, two] == [1, 1] { Ok(surface.net().clone()) } else { Ok(surface.refined(one, two)?) }
}

/// Writes everything and tells about it.
pub fn write(command: &str, input: &Path, made: Made, args: &CanalOutputArgs, is_quiet: bool) -> Result<()> {
    let net = refined(&made.surface, pieces(args, made.refine)?)?;
    let grid = net.grid();
    let mesh = grid.mesh();
    let mut measures = Measures::of(grid, false);
    // The guide as it was given: pieces of its arcs say no more of its curvature.
    measures.rows_near_evolute = Measures::of(made.surface.net().grid(), made.has_evolute).rows_near_evolute;
    let Made { surface, curves, drawn, found, mut warnings, .. } = made;
    warnings.extend(measures.warnings());
    let mut output = Output::new(&args.out, &without_surface(input), command, args.picture)?;
    output.mesh(&mesh, args.format.into())?;
    output.text("surface", ".surface.json", &surface.to_json())?;
    let family = surface.family();
    if output.wants_pictures() {
        let curves_shown = curves.iter().map(|(_, curve, _)| curve.points.clone()).collect();
        let overlay =
            Overlay { curves: curves_shown, thin_curves: drawn, marked: measures.marked(), ..Overlay::default() };
        let title = format!("{}: {command}", file_name(input));
        output.picture("picture", &picture(title, &family, &mesh, overlay, &measures))?;
    }
    let in_report = |(what, curve, is_met): &(&'static str, Curve, bool)| CurveInReport {
        what,
        file: curve.name.clone(),
        points: curve.distinct().len(),
        closed: curve.is_closed,
        repeats_end: curve.repeats_end,
        distance: if *is_met { distance(&mesh, &curve.points) } else { None },
    };
    let of = |grid: &Grid| [grid.rows(), grid.columns()];
    let mut report = Report {
        version: VERSION,
        program: concat!("shapeop ", env!("CARGO_PKG_VERSION")),
        command: format!("canal {command}"),
        input: input.display().to_string(),
        family,
        surface: of(surface.net().grid()),
        mesh: of(grid),
        wraps: grid.wraps(),
        faces: mesh.faces.len(),
        curves: curves.iter().map(in_report).collect(),
        found,
        measures,
        warnings,
        files: BTreeMap::new(),
    };
    output.report_with(|files| {
        report.files = files;
        in_json(&report)
    })?;
    if is_quiet {
        return Ok(());
    }
    if args.json { say(in_json(&report)?.trim_end()) } else { say(&in_words(&report, &output)) }
}

pub fn in_json(value: &impl Serialize) -> Result<String> {
    let mut text = serde_json::to_string_pretty(value)?;
    text.push('\n');
    Ok(text)
}

/// The name of a file without the ending of a surface, so that names do not grow with every step.
pub fn without_surface(input: &Path) -> std::path::PathBuf {
    let name = file_name(input);
    name.strip_suffix(".surface.json")
        .map_or_else(|| input.to_owned(), |stem| input.with_file_name(format!("{stem}.json")))
}

/// The largest distance of points from a mesh.
fn distance(mesh: &Mesh, points: &[DVec3]) -> Option<f64> {
    let halves = |face: &Vec<u32>| match face[..] {
        [a, b, c, d] => [[a, b, c], [a, c, d]],
        _ => [[0; 3]; 2],
    };
    let triangles: Vec<[u32; 3]> = mesh.faces.iter().flat_map(halves).collect();
    let closest = ClosestPoints::of_triangles(&mesh.points, &triangles).ok()?;
    Some(points.iter().map(|&point| closest.nearest(point).distance(point)).fold(0.0, f64::max))
}

fn picture(title: String, family: &str, mesh: &Mesh, overlay: Overlay, measures: &Measures) -> String {
    let is_bad = measures.concyclicity.max > NOT_CIRCULAR;
    let caption = if overlay.marked.is_empty() {
        String::new()
    } else {
        format!("{} faces in orange fold, cross themselves or have shrunk", overlay.marked.len())
    };
    let panel = Panel {
        pointed_at: is_bad.then_some(measures.concyclicity.face),
        caption,
        overlay,
        ..Panel::new(mesh, format!("{family}, {} faces", mesh.faces.len()))
    };
    let subtitle = format!(
        "planarity at worst {}, concyclicity at worst {}",
        number(measures.planarity.max),
        number(measures.concyclicity.max)
    );
    Picture { title, subtitle, panels: vec![panel], scale: None, fits_each: false }.to_svg()
}

fn in_words(report: &Report, output: &Output) -> String {
    let Report { command, input, family, surface, mesh, faces, measures, .. } = report;
    let refined = if surface == mesh { String::new() } else { format!(" of {} x {}", surface[0], surface[1]) };
    let start = format!("{command} {input}: {family}{refined}, {} x {} points, {faces} faces", mesh[0], mesh[1]);
    let row = |cells: [String; 3]| cells.to_vec();
    let mut rows = vec![
        row([
            "planarity, worst".to_owned(),
            number(measures.planarity.max),
            format!("face {}", measures.planarity.face),
        ]),
        row([
            "concyclicity, worst".to_owned(),
            number(measures.concyclicity.max),
            format!("face {}", measures.concyclicity.face),
        ]),
    ];
    for curve in &report.curves {
        let closed = match (curve.closed, curve.repeats_end) {
            (true, true) => ", closed (its end is repeated)",
            (true, false) => ", closed",
            _ => "",
        };
        let met = curve.distance.map_or(String::new(), number);
        rows.push(row([format!("{}, distance", curve.what), met, format!("{} points{closed}", curve.points)]));
    }
    for (name, value) in &report.found {
        let shown = match value {
            Value::Number(found) if found.is_f64() => found.as_f64().map_or_else(String::new, number),
            Value::Number(count) => count.to_string(),
            Value::String(text) => text.clone(),
            Value::Bool(is_so) => (if *is_so { "yes" } else { "no" }).to_owned(),
            _ => continue,
        };
        rows.push(vec![name.replace('_', " "), shown]);
    }
    let warnings: Vec<String> = report.warnings.iter().map(|warning| format!("  warning: {warning}")).collect();
    let warnings = if warnings.is_empty() { String::new() } else { format!("\n\n{}", warnings.join("\n")) };
    format!("{start}\n\n{}{warnings}\n\n{}", aligned(&rows), output.in_lines())
}
