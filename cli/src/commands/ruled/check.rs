//! `ruled check`: how good given strips are.

use anyhow::Result;
use serde_json::json;
use shapeop::geometry::ruled::Strip;
use shapeop::geometry::ruled::planks::axis;
use shapeop::geometry::ruled::report::{ReportOptions, consecutive, report};
use shapeop::mesh::TriangleMesh;
use shapeop::mesh::curve::NearestOnCurve;
use shapeop::mesh::file::read_source;
use shapeop::mesh::reference::ReferenceMesh;

use super::measures::{Relative, counted, rows, warnings};
use super::places::{Places, in_options};
use super::planks::read_strips;
use super::report::{MeshInReport, VERSION};
use crate::Ending;
use crate::args::ruled::RuledCheckArgs;
use crate::commands::canal::in_json;
use crate::output::say;
use crate::table::{aligned, number, percent};

/// The last strip meets the first where its second boundary is nearer to that one's first than this part of a ruling.
const RING: f64 = 0.1;

/// A strip is conoidal within this angle, in degrees.
const CONOIDAL_DEG: f64 = 1e-4;

pub fn run(args: &RuledCheckArgs, is_quiet: bool) -> Result<Ending> {
    let strips = read_strips(&args.strips)?;
    let source = read_source(&args.mesh)?;
    let places = Places { mesh: &args.mesh, face_lines: &source.face_lines, levels: "--levels", curves: &[] };
    let mesh = TriangleMesh::new(&source.mesh).map_err(|error| places.of(error))?;
    let reference = ReferenceMesh::new(&mesh);
    let options = ReportOptions {
        joints: Some(consecutive(strips.len(), is_ring(&strips)?)),
        feature_ratio: args.feature_ratio,
        ..ReportOptions::default()
    };
    let found = report(&strips, &reference, &reference, &options).map_err(in_options)?;
    if is_quiet {
        return Ok(Ending::Done);
    }
    let diagonal = mesh.diagonal();
    let off_axis: Vec<Option<f64>> =
        strips.iter().map(|strip| axis(strip).ok().map(|axis| axis.deviation_deg)).collect();
    let told = warnings(&found, diagonal);
    if args.json {
        let report = json!({
            "version": VERSION,
            "program": concat!("shapeop ", env!("CARGO_PKG_VERSION")),
            "command": "ruled check",
            "input": args.strips.display().to_string(),
            "reference": args.mesh.display().to_string(),
            "mesh": serde_json::to_value(MeshInReport::of(&mesh))?,
            "measures": serde_json::to_value(&found)?,
            "relative": serde_json::to_value(Relative::of(&found, diagonal))?,
            "off_axis_deg": off_axis,
            "warnings": told,
        });
        say(in_json(&report)?.trim_end())?;
        return Ok(Ending::Done);
    }
    let conoidal = off_axis.iter().flatten().filter(|off| **off <= CONOIDAL_DEG).count();
    let start = format!("{}: {}, {conoidal} of them conoidal", args.strips.display(), counted(strips.len(), "strip"));
    let names = ["", "deviation", "rms", "least width", "mean", "greatest", "over radius", "kept"];
    let mut table = vec![names.map(str::to_owned).to_vec()];
    for (k, strip) in found.strips.iter().enumerate() {
        table.push(vec![
            format!("strip {k}"),
            number(strip.deviation.max),
            number(strip.deviation.rms),
            number(strip.widths.min),
            number(strip.widths.mean),
            number(strip.widths.max),
            number(strip.width_over_feature),
            percent(strip.trimmed_area / strip.area),
        ]);
    }
    let told: String = told.iter().map(|warning| format!("\n  warning: {warning}")).collect();
    let (figures, strips) = (aligned(&rows(&found, diagonal)), aligned(&table));
    say(format!("{start}\n\n{figures}\n\n{strips}\n{told}").trim_end())?;
    Ok(Ending::Done)
}

/// Whether the last strip's second boundary is the first one's first.
fn is_ring(strips: &[Strip]) -> shapeop::error::Result<bool> {
    let (first, last) = (&strips[0], &strips[strips.len() - 1]);
    if strips.len() < 2 {
        return Ok(false);
    }
    let curve = NearestOnCurve::new(first.boundary(0))?;
    let is_near = |part: f64| {
        let [a, b] = last.ruling(part * last.length_u());
        curve.nearest(b).distance <= RING * a.distance(b)
    };
    Ok([0.3, 0.5, 0.7].into_iter().all(is_near))
}
