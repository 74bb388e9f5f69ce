//! Planks of conoidal strips: sheets, boards as solids, a table; and `ruled planks`.

use std::ops::Range;

use anyhow::{Result, anyhow, bail};
use serde_json::json;
use shapeop::geometry::ruled::planks::{PlankOptions, Planks, planks, sheet};
use shapeop::geometry::ruled::trim::{TrimOptions, Trimmed, trim};
use shapeop::geometry::ruled::{Strip, file};
use shapeop::mesh::file::{Format, read_source};
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Mesh, TriangleMesh};

use super::pictures;
use super::places::{Places, in_options};
use super::report::{PlanksInReport, VERSION};
use super::strips::title;
use crate::Ending;
use crate::args::canal::Unit;
use crate::args::ruled::PlanksArgs;
use crate::commands::canal::in_json;
use crate::curve_file::text_of;
use crate::output::{Output, say};
use crate::table::{aligned, number, percent};

/// How planks are cut and drawn.
pub struct Asked {
    pub thickness: f64,
    pub depth: f64,
    pub unit: Unit,
    pub format: Format,
}

impl Asked {
    fn millimetres(&self) -> f64 {
        match self.unit {
            Unit::Mm => 1.0,
            Unit::Cm => 10.0,
            Unit::M => 1000.0,
        }
    }
}

/// The spans of each strip that are beside the mesh; none of a closed strip, or where nothing of it is.
pub fn beside(strips: &[Strip], trimmed: &[Trimmed]) -> Vec<Option<Range<usize>>> {
    let spans = |(strip, trimmed): (&Strip, &Trimmed)| {
        let corners = || trimmed.pieces().iter().flatten().flatten().map(|at| at[0]);
        let low = corners().fold(f64::INFINITY, f64::min).floor();
        let high = corners().fold(f64::NEG_INFINITY, f64::max).ceil();
        (high > low && !strip.basis().is_closed())
            .then_some(low.max(0.0) as usize..strip.basis().spans().min(high as usize))
    };
    strips.iter().zip(trimmed).map(spans).collect()
}

/// Cuts each strip, over its spans if some are given, and writes sheets, planks and solids. A strip that cannot be cut is told of,
/// unless it is for an option.
pub fn write(
    strips: &[Strip],
    spans: &[Option<Range<usize>>],
    asked: &Asked,
    name: &str,
    output: &mut Output,
) -> Result<Vec<PlanksInReport>> {
    let options = PlankOptions { depth: asked.depth, ..PlankOptions::new(asked.thickness) };
    let (mut cut, mut told) = (Vec::new(), Vec::new());
    for (strip, of) in strips.iter().enumerate() {
        let spans = spans.get(strip).cloned().flatten();
        let part = spans.clone().map(|spans| of.part(spans)).transpose()?;
        let spans = spans.map(|spans| [spans.start, spans.end]);
        match planks(part.as_ref().unwrap_or(of), &options) {
            Ok(found) => {
                let heading = format!("{name}, strip {strip}");
                output.sheet(strip, &sheet::sheet(&found, &heading, asked.millimetres())?)?;
                told.push(in_report(strip, spans, &found));
                cut.push(found);
            }
            Err(error) if error.place().starts_with("options") => return Err(in_options(error)),
            Err(error) => told.push(PlanksInReport {
                strip,
                spans,
                refusal: Some(error.to_string().trim_start_matches("strip: ").to_owned()),
                planks: 0,
                deviation_deg: 0.0,
                longest: 0.0,
                widest: 0.0,
                stock_area: 0.0,
                offcut: 0.0,
            }),
        }
    }
    if cut.is_empty() {
        return Ok(told);
    }
    let solids = solids(&cut);
    output.text("planks", ".planks.json", &in_json(&cut)?)?;
    output.other_mesh("plank solids", ".planks", &solids.0, asked.format)?;
    if output.wants_pictures() {
        output.picture("planks", &pictures::planks(&solids.0, &solids.1, name.to_owned(), asked.thickness))?;
    }
    Ok(told)
}

fn in_report(strip: usize, spans: Option<[usize; 2]>, found: &Planks) -> PlanksInReport {
    let most =
        |value: fn(&shapeop::geometry::ruled::planks::Plank) -> f64| found.planks.iter().map(value).fold(0.0, f64::max);
    PlanksInReport {
        strip,
        spans,
        refusal: None,
        planks: found.planks.len(),
        deviation_deg: found.deviation_deg,
        longest: most(|plank| plank.length),
        widest: most(|plank| plank.width),
        stock_area: found.stock_area,
        offcut: found.offcut,
    }
}

/// The planks as boxes, each with points of its own, and for each face the number of its plank.
fn solids(all: &[Planks]) -> (Mesh, Vec<usize>) {
    let (mut mesh, mut plank_of) = (Mesh { points: Vec::new(), faces: Vec::new() }, Vec::new());
    for (k, plank) in all.iter().flat_map(|of| of.planks.iter().enumerate()) {
        let first = mesh.points.len() as u32;
        let [lower, upper] = plank.corners();
        mesh.points.extend(lower.iter().chain(&upper));
        let side = |i: u32| vec![first + i, first + (i + 1) % 4, first + 4 + (i + 1) % 4, first + 4 + i];
        mesh.faces.push((0..4).rev().map(|i| first + i).collect());
        mesh.faces.push((4..8).map(|i| first + i).collect());
        mesh.faces.extend((0..4).map(side));
        plank_of.extend([k; 6]);
    }
    (mesh, plank_of)
}

/// The strips of a file.
pub fn read_strips(path: &std::path::Path) -> Result<Vec<Strip>> {
    let strips = file::from_json(&text_of(path)?).map_err(|error| anyhow!("{}: {error}", path.display()))?;
    if strips.is_empty() {
        bail!("{}: expected at least 1 strip, found none", path.display());
    }
    Ok(strips)
}

pub fn run(args: &PlanksArgs, is_quiet: bool) -> Result<Ending> {
    let strips = read_strips(&args.strips)?;
    // Options are refused before there is a folder.
    let options = PlankOptions { depth: args.depth, ..PlankOptions::new(args.planks) };
    if let Err(error) = planks(&strips[0], &options)
        && error.place().starts_with("options")
    {
        return Err(in_options(error));
    }
    let spans = match &args.within {
        None => Vec::new(),
        Some(path) => {
            let source = read_source(path)?;
            let places = Places { mesh: path, face_lines: &source.face_lines, levels: "--levels", curves: &[] };
            let mesh = TriangleMesh::new(&source.mesh).map_err(|error| places.of(error))?;
            beside(&strips, &trim(&strips, &ReferenceMesh::new(&mesh), &TrimOptions::default())?)
        }
    };
    let name = title(&args.strips);
    let stem = name.strip_suffix(".strips.json").or_else(|| name.strip_suffix(".json")).unwrap_or(&name);
    let stem = stem.strip_suffix(".ruled").unwrap_or(stem);
    let input = args.strips.with_file_name(format!("{stem}.json"));
    let mut output = Output::new(&args.place.out, &input, "ruled", args.place.picture)?;
    let asked = Asked { thickness: args.planks, depth: args.depth, unit: args.unit, format: args.place.format.into() };
    let found = write(&strips, &spans, &asked, stem, &mut output)?;
    let refused: Vec<&PlanksInReport> = found.iter().filter(|of| of.refusal.is_some()).collect();
    if let (Some(first), true) = (refused.first(), refused.len() == found.len()) {
        bail!("{}: strips[{}]: {}", args.strips.display(), first.strip, first.refusal.as_deref().unwrap_or_default());
    }
    let warnings: Vec<String> = refused
        .iter()
        .map(|of| format!("no planks of strip {}: {}", of.strip, of.refusal.as_deref().unwrap_or_default()))
        .collect();
    if is_quiet {
        return Ok(Ending::Done);
    }
    if args.place.json {
        let report = json!({
            "version": VERSION,
            "program": concat!("shapeop ", env!("CARGO_PKG_VERSION")),
            "command": "ruled planks",
            "input": args.strips.display().to_string(),
            "planks": serde_json::to_value(&found)?,
            "warnings": warnings,
        });
        say(in_json(&report)?.trim_end())?;
        return Ok(Ending::Done);
    }
    let mut rows = vec![["", "planks", "longest", "widest", "stock area", "offcut"].map(str::to_owned).to_vec()];
    rows.extend(found.iter().filter(|of| of.refusal.is_none()).map(|of| {
        vec![
            format!("strip {}", of.strip),
            of.planks.to_string(),
            number(of.longest),
            number(of.widest),
            number(of.stock_area),
            percent(of.offcut),
        ]
    }));
    let warnings: String = warnings.iter().map(|warning| format!("\n  warning: {warning}")).collect();
    let start = format!("ruled planks {}: thickness {}", args.strips.display(), number(args.planks));
    say(&format!("{start}\n\n{}\n{warnings}\n{}", aligned(&rows), output.in_lines()))?;
    Ok(Ending::Done)
}
