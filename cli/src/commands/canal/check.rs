//! `canal check`: how planar and circular a surface or a mesh is, where it folds, and its worst faces.

use std::path::PathBuf;

use anyhow::{Result, anyhow};
use serde::Serialize;
use serde_json::json;
use shapeop::geometry::canal::properties::{PLANAR, Properties, StressLines};
use shapeop::geometry::canal::quality::Quality;
use shapeop::geometry::canal::surface::SuperCanal;
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
    /// Null unless asked for, and for meshes.
    properties: Option<PropertiesInReport>,
}

/// Table 2 of the paper for one surface: what is measured, and what is known from how it was made.
#[derive(Serialize)]
struct PropertiesInReport {
    /// The largest distance of a row's point from the row's plane over its extent; the same of a column's.
    rows_off_plane: f64,
    columns_off_plane: f64,
    isothermic_by_construction: bool,
    /// 0 on an isothermic net: how far logarithms of cross-ratios are from sums of a number of the row and of the column.
    cross_ratio_residual: f64,
    /// Whether lines of curvature can be lines of principal stress under pressure; null where that could not be measured.
    stress_lines: Option<bool>,
    /// The residuals of the membrane on the net refined twice.
    membrane_residuals: Option<[f64; 2]>,
    /// Why stress lines could not be measured.
    reason: Option<String>,
}

impl PropertiesInReport {
    fn of(surface: &SuperCanal) -> Self {
        let found = Properties::of(surface);
        let stress = found.stress_lines.as_ref();
        Self {
            rows_off_plane: found.off_plane[0],
            columns_off_plane: found.off_plane[1],
            isothermic_by_construction: found.is_isothermic_by_construction,
            cross_ratio_residual: found.cross_ratio_residual,
            stress_lines: stress.ok().map(StressLines::holds),
            membrane_residuals: stress.ok().map(|stress| stress.residuals),
            reason: stress.err().map(ToString::to_string),
        }
    }

    fn in_words(&self) -> String {
        let planar =
            |off: f64| if off <= PLANAR { "planar".to_owned() } else { format!("{} off their planes", number(off)) };
        let isothermic = if self.isothermic_by_construction { "yes, by construction" } else { "not by construction" };
        let stress = match (self.stress_lines, self.membrane_residuals, &self.reason) {
            (Some(holds), Some([coarse, fine]), _) => {
                let answer = if holds { "yes" } else { "no" };
                format!("{answer}: the residual goes from {} to {}", number(coarse), number(fine))
            }
            (.., reason) => format!("not measured: {}", reason.as_deref().unwrap_or_default()),
        };
        format!(
            "  rows                 {}\n  columns              {}\n  isothermic           {isothermic}; cross-ratios {} off\n  \
             stress lines         {stress}",
            planar(self.rows_off_plane),
            planar(self.columns_off_plane),
            number(self.cross_ratio_residual)
        )
    }
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
            properties: None,
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
        if let Some(properties) = &self.properties {
            parts.push(properties.in_words());
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
        let of = |(_, surface): &(PathBuf, SuperCanal)| {
            let measured =
                Component::of(Some(surface.family()), surface.net().grid(), has_evolute(surface), args.worst);
            let properties = args.properties.then(|| PropertiesInReport::of(surface));
            Component { properties, ..measured }
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
