//! `canal check`: how planar and circular a surface or a mesh is, where it folds, and its worst faces.

use anyhow::{Result, anyhow};
use serde::Serialize;
use serde_json::json;
use shapeop::geometry::canal::quality::Quality;
use shapeop::mesh::Grid;

use super::made::{Measures, has_evolute, in_json};
use super::transform::{Components, grids};
use crate::Ending;
use crate::args::canal::CanalCheckArgs;
use crate::curve_file::extension;
use crate::output::say;
use crate::table::{aligned, number};

/// A component and what was measured of it.
#[derive(Serialize)]
struct Component {
    /// The name of its family; null for a mesh.
    family: Option<String>,
    rows: usize,
    columns: usize,
    wraps: [bool; 2],
    faces: usize,
    measures: Measures,
    worst_faces: Vec<Face>,
}

#[derive(Serialize)]
struct Face {
    face: usize,
    row: usize,
    column: usize,
    planarity: f64,
    concyclicity: f64,
}

impl Component {
    fn of(family: Option<String>, grid: &Grid, is_limited: bool, worst: usize) -> Self {
        let quality = Quality::of(grid);
        let badness = |face: usize| quality.planarity[face].max(quality.concyclicity[face]);
        let mut order: Vec<usize> = (0..quality.planarity.len()).collect();
        order.sort_by(|&a, &b| badness(b).total_cmp(&badness(a)));
        let columns = grid.spans()[1];
        let face = |&face: &usize| Face {
            face,
            row: face / columns,
            column: face % columns,
            planarity: quality.planarity[face],
            concyclicity: quality.concyclicity[face],
        };
        Self {
            family,
            rows: grid.rows(),
            columns: grid.columns(),
            wraps: grid.wraps(),
            faces: quality.planarity.len(),
            measures: Measures::of(grid, is_limited),
            worst_faces: order.iter().take(worst).map(face).collect(),
        }
    }

    fn in_words(&self, name: &str) -> String {
        let around = |wraps: bool| if wraps { " (closed)" } else { "" };
        let mut parts = vec![format!(
            "{name}: {}, {}{} x {}{} points, {} faces",
            self.family.as_deref().unwrap_or("grid"),
            self.rows,
            around(self.wraps[0]),
            self.columns,
            around(self.wraps[1]),
            self.faces
        )];
        parts.push(format!(
            "  planarity, worst     {}\n  concyclicity, worst  {}",
            number(self.measures.planarity.max),
            number(self.measures.concyclicity.max)
        ));
        let warnings = self.measures.warnings();
        parts.extend(warnings.iter().map(|warning| format!("  warning: {warning}")));
        if warnings.is_empty() {
            parts.push("  no folds".to_owned());
        }
        if !self.worst_faces.is_empty() {
            let mut rows =
                vec![["worst faces, from 0", "row", "column", "planarity", "concyclicity"].map(str::to_owned).to_vec()];
            rows.extend(self.worst_faces.iter().map(|face| {
                vec![
                    format!("face {}", face.face),
                    face.row.to_string(),
                    face.column.to_string(),
                    number(face.planarity),
                    number(face.concyclicity),
                ]
            }));
            parts.push(aligned(&rows));
        }
        parts.join("\n")
    }
}

pub fn run(args: &CanalCheckArgs, is_quiet: bool) -> Result<Ending> {
    let name = args.input.display().to_string();
    let components: Vec<Component> = if extension(&args.input) == "json" {
        let of = |(_, surface): &(std::path::PathBuf, shapeop::geometry::canal::surface::SuperCanal)| {
            Component::of(Some(surface.family()), surface.net().grid(), has_evolute(surface), args.worst)
        };
        Components::read(&args.input)?.surfaces.iter().map(of).collect()
    } else {
        // A mesh need not be circular to be measured.
        grids(&args.input)?.iter().map(|grid| Component::of(None, grid, false, args.worst)).collect()
    };
    if is_quiet {
        return Ok(Ending::Done);
    }
    if args.json {
        let report = json!({
            "version": 1,
            "program": concat!("shapeop ", env!("CARGO_PKG_VERSION")),
            "command": "canal check",
            "input": name,
            "components": serde_json::to_value(&components).map_err(|error| anyhow!("{error}"))?,
        });
        say(in_json(&report)?.trim_end())?;
    } else {
        let count = components.len();
        let title = |i: usize| if count > 1 { format!("{name}, component {} of {count}", i + 1) } else { name.clone() };
        let parts: Vec<String> = components.iter().enumerate().map(|(i, part)| part.in_words(&title(i))).collect();
        say(&parts.join("\n\n"))?;
    }
    Ok(Ending::Done)
}
