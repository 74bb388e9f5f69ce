//! `canal panels`: what a workshop cuts.

use std::ops::ControlFlow;

use anyhow::{Result, bail};
use glam::DVec3;
use serde_json::json;
use shapeop::geometry::canal::file::PartsForm;
use shapeop::geometry::canal::frame::Frame;
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::node_axes::NodeAxes;
use shapeop::geometry::canal::panels::{beams, offset, panels};
use shapeop::mesh::measure::{Spread, edge_lengths};
use shapeop::mesh::{Grid, Mesh};

use super::made::{Measures, in_json, pieces, refined, without_surface};
use super::sheets::{Sheet, drawn};
use super::transform::Components;
use crate::Ending;
use crate::args::canal::{AxesKind, PanelsArgs, Unit};
use crate::commands::recipe::file_name;
use crate::output::{Output, say};
use crate::picture::{Overlay, Panel, Picture};
use crate::progress::{Progress, catch_interrupts, is_interrupted};
use crate::table::{aligned, number};

/// Beams over the mean edge, where no height is given.
const BEAM_HEIGHT: f64 = 0.05;

/// Steps of the progress bar of the search for axes.
const STEPS: u32 = 100;

pub fn run(args: &PanelsArgs, is_quiet: bool) -> Result<Ending> {
    for (name, value) in [("thickness", Some(args.thickness)), ("beam-height", args.beam_height)] {
        if let Some(value) = value.filter(|value| !(*value >= 0.0 && value.is_finite())) {
            bail!("{name}: expected a finite number of at least 0, found {value}");
        }
    }
    if args.axes == AxesKind::LeastGaps {
        catch_interrupts();
    }
    let pieces = pieces(&args.output, [1, 1])?;
    let mut ending = Ending::Done;
    for (name, surface) in Components::read(&args.input)?.surfaces {
        let net = refined(&surface, pieces)?;
        if component(args, &name, &surface.family(), &net, is_quiet)? == Ending::Interrupted {
            ending = Ending::Interrupted;
        }
    }
    Ok(ending)
}

fn component(args: &PanelsArgs, name: &std::path::Path, family: &str, net: &Net, is_quiet: bool) -> Result<Ending> {
    let grid = net.grid();
    let mesh = grid.mesh();
    // Before the search: a folder that cannot be made should cost nothing.
    let mut output = Output::new(&args.output.out, &without_surface(name), "panels", args.output.picture)?;
    let axes = axes(args, grid, net.frames(), is_quiet)?;
    let height = match args.beam_height {
        Some(height) => height,
        None => BEAM_HEIGHT * Spread::of(&edge_lengths(&mesh)?).mean,
    };
    let parts = PartsForm::new(grid, &axes, args.thickness, height)?;
    output.mesh(&mesh, args.output.format.into())?;
    output.text("parts", ".parts.json", &parts.to_json())?;
    let below = offset(grid, &axes.axes, -height)?.mesh();
    output.other_mesh("offset mesh", ".offset", &below, args.output.format.into())?;
    output.other_mesh("beams", ".beams", &mesh_of(&beams(grid, &axes.axes, height)?), args.output.format.into())?;
    let flat = panels(grid, &axes.axes)?;
    let [rows, columns] = grid.spans();
    for row in 0..rows {
        let row_panels = &flat[row * columns..(row + 1) * columns];
        let millimetres = match args.unit {
            Unit::Mm => 1.0,
            Unit::Cm => 10.0,
            Unit::M => 1000.0,
        };
        let sheet = Sheet { name: &file_name(name), row, panels: row_panels, thickness: args.thickness, millimetres };
        output.sheet(row, &drawn(&sheet)?)?;
    }
    let gap = axes.largest_gap(height);
    if output.wants_pictures() {
        let title = format!("{}: panels", file_name(name));
        let panel = Panel {
            caption: format!(
                "node axes: the depths of beams of height {} differ by at most {}",
                number(height),
                number(gap)
            ),
            overlay: Overlay { thin_curves: axes_drawn(grid, &axes, height), ..Overlay::default() },
            ..Panel::new(&mesh, format!("{family}, {} panels, {} beams", flat.len(), parts.beams.len()))
        };
        let picture = Picture {
            title,
            subtitle: format!("{rows} sheets in true scale, one for each row"),
            panels: vec![panel],
            scale: None,
            fits_each: false,
        };
        output.picture("picture", &picture.to_svg())?;
    }
    let measures = Measures::of(grid, false);
    let mitres: Vec<f64> = parts.panels.iter().flat_map(|panel| panel.mitres_deg).collect();
    let mitre = Spread::of(&mitres);
    let warnings = measures.warnings();
    let mut report = json!({
        "version": 1,
        "program": concat!("shapeop ", env!("CARGO_PKG_VERSION")),
        "command": "canal panels",
        "input": args.input.display().to_string(),
        "family": family,
        "panels": parts.panels.len(),
        "beams": parts.beams.len(),
        "sheets": rows,
        "thickness": args.thickness,
        "beam_height": height,
        "largest_gap": gap,
        "mitre_deg": { "min": mitre.min, "max": mitre.max },
        "panel_height": parts.panels.iter().map(|panel| panel.height).fold(0.0, f64::max),
        "is_cancelled": axes.is_cancelled,
        "measures": serde_json::to_value(&measures)?,
        "warnings": warnings,
    });
    output.report_with(|files| {
        report["files"] = json!(files);
        in_json(&report)
    })?;
    if !is_quiet {
        if args.output.json {
            say(in_json(&report)?.trim_end())?;
        } else {
            let row = |name: &str, value: String| vec![name.to_owned(), value];
            let table = [
                row("panels", parts.panels.len().to_string()),
                row("mitre angles, degrees", format!("{} to {}", number(mitre.min), number(mitre.max))),
                row("beams", parts.beams.len().to_string()),
                row("beam height", number(height)),
                row("gap at a node, largest", number(gap)),
                row("planarity, worst", number(measures.planarity.max)),
            ];
            let warnings: String = warnings.iter().map(|warning| format!("\n  warning: {warning}")).collect();
            let start = format!("canal panels {}: {family}, {rows} sheets", name.display());
            say(&format!("{start}\n\n{}\n{warnings}\n{}", aligned(&table), output.in_lines()))?;
        }
    }
    Ok(if axes.is_cancelled { Ending::Interrupted } else { Ending::Done })
}

fn axes(args: &PanelsArgs, grid: &Grid, frames: &[Frame], is_quiet: bool) -> Result<NodeAxes> {
    let sign = if args.flip { -1.0 } else { 1.0 };
    if args.axes == AxesKind::Normals {
        let normals: Vec<DVec3> = frames.iter().map(|frame| sign * frame.normal).collect();
        return Ok(NodeAxes::of(grid, &normals)?);
    }
    let progress = Progress::new(STEPS, is_quiet);
    let found = NodeAxes::of_least_gaps(grid, &mut |share| {
        progress.say((share * f64::from(STEPS)) as usize, "node axes");
        if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    progress.finish();
    let mut found = found?;
    // The search knows no sides: to that of the surface's normal.
    let is_along = found.axes.iter().zip(frames).map(|(axis, frame)| axis.dot(frame.normal)).sum::<f64>() > 0.0;
    if is_along == args.flip {
        found.axes.iter_mut().for_each(|axis| *axis = -*axis);
    }
    Ok(found)
}

/// Beams as quads, each with points of its own.
fn mesh_of(beams: &[shapeop::geometry::canal::panels::Beam]) -> Mesh {
    let points = beams.iter().flat_map(|beam| beam.corners).collect();
    let faces = (0..beams.len() as u32).map(|k| (4 * k..4 * k + 4).collect()).collect();
    Mesh { points, faces }
}

/// The axes as short lines from the points.
fn axes_drawn(grid: &Grid, axes: &NodeAxes, height: f64) -> Vec<Vec<DVec3>> {
    let line = |(&point, &axis): (&DVec3, &DVec3)| vec![point, point - height * axis];
    grid.points().iter().zip(&axes.axes).map(line).collect()
}
