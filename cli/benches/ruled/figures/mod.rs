//! Figures of Flöry et al. 2012 on surfaces of our own: what each shows, measured, and a picture.

mod boundaries;
mod conoids;
mod drawing;
mod sections;
mod strips;
mod zebra;

use std::ops::ControlFlow;
use std::path::Path;

use anyhow::Result;
use shapeop::geometry::ruled::boundaries::{BoundaryOptions, Levels};
use shapeop::geometry::ruled::conditions::Condition;
use shapeop::geometry::ruled::design::{Design, FieldOptions};
use shapeop::geometry::ruled::level_function::{LevelOptions, LevelWeights};
use shapeop::geometry::ruled::optimise::Options;
use shapeop::geometry::ruled::report::{Report, ReportOptions};
use shapeop::geometry::ruled::start::StartOptions;
use shapeop::geometry::ruled::trim::{Trimmed, trim};
use shapeop::mesh::Mesh;
use shapeop::mesh::reference::ReferenceMesh;

use crate::group::Group;
use drawing::TRIM;

type Figure = fn(&Path) -> Result<Group>;

/// Each with the name of its picture.
const FIGURES: [(&str, Figure); 11] = [
    ("zebra", zebra::figure2),
    ("sections", sections::figure4),
    ("boundaries", boundaries::figure5),
    ("planar_cuts", boundaries::figure6),
    ("conoidal", conoids::figure7),
    ("tube", strips::figure8),
    ("geodesic", strips::figure9),
    ("planar", strips::figure10),
    ("wide", strips::figure11),
    ("single", conoids::figure12),
    ("planks", conoids::figures13_14),
];

/// Draws all figures, or the one of this name, and prints a line for each.
pub fn draw(folder: &Path, name: Option<&str>) -> Result<()> {
    std::fs::create_dir_all(folder)?;
    for (_, figure) in FIGURES.iter().filter(|(own, _)| name.is_none_or(|name| name == *own)) {
        println!("{}", figure(folder)?);
    }
    Ok(())
}

/// The design of a mesh with level curves as boundaries.
fn with_levels(mesh: &Mesh, family: usize, weights: LevelWeights, levels: &Levels) -> Result<Design> {
    let mut design = Design::new(mesh, &FieldOptions { family, ..FieldOptions::default() })?;
    set_levels(&mut design, weights, levels)?;
    Ok(design)
}

fn set_levels(design: &mut Design, weights: LevelWeights, levels: &Levels) -> Result<()> {
    let function = LevelOptions { weights, ..LevelOptions::default() };
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    Ok(design.set_level_boundaries(&function, levels, &BoundaryOptions::default(), go_on)?)
}

/// Strips of a design between its boundaries, optimised.
struct Made {
    report: Report,
    trimmed: Vec<Trimmed>,
    iterations: usize,
}

fn make(
    design: &mut Design,
    control_count: usize,
    conditions: impl Fn(&Design) -> Result<Vec<Condition>>,
) -> Result<Made> {
    design.start(StartOptions { control_count, ..StartOptions::default() })?;
    let conditions = conditions(design)?;
    let found = design.optimise(None, &conditions, &Options::default(), &mut |_| ControlFlow::Continue(()))?;
    Ok(Made { iterations: found.history.len() - 1, ..judge(design)? })
}

fn judge(design: &Design) -> Result<Made> {
    let report = design.report(None, &ReportOptions::default())?;
    let trimmed = trim(design.strips(), &ReferenceMesh::new(design.mesh()), &TRIM)?;
    Ok(Made { report, trimmed, iterations: 0 })
}
