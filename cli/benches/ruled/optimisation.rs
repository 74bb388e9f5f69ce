//! Strips of five surfaces: how soon they are optimal, how near they are, how much they cover.

use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::Result;
use shapeop::geometry::ruled::boundaries::{BoundaryOptions, Levels};
use shapeop::geometry::ruled::design::{Design, FieldOptions};
use shapeop::geometry::ruled::level_function::LevelOptions;
use shapeop::geometry::ruled::optimise::Options;
use shapeop::geometry::ruled::report::ReportOptions;
use shapeop::geometry::ruled::start::StartOptions;

use crate::group::Group;
use crate::shapes::{Shape, five};

/// Levels of boundaries; those that only cut off corners are too short and left out, and there is one beyond the rim on either side.
const LEVELS: usize = 5;

/// From where on what is minimised falls by less than this part of itself, strips count as optimal.
const FLAT: f64 = 1e-3;

fn group(shape: &Shape, family: usize) -> Result<Group> {
    let title = format!("{}, family {family}: {LEVELS} levels on a mesh of 61 by 61 points", shape.name);
    let mut group = Group::new(&title, "Boundaries orthogonal to asymptotic curves, 12 control points, free ends.");
    let mesh = shape.mesh(61, 61)?;
    let start = Instant::now();
    let mut design = Design::new(&mesh, &FieldOptions { family, ..FieldOptions::default() })?;
    let (levels, function) = (Levels::Count(LEVELS), LevelOptions::default());
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    design.set_level_boundaries(&function, &levels, &BoundaryOptions::default(), go_on)?;
    design.start(StartOptions::default())?;
    let before = design.report(None, &ReportOptions::default())?;
    let found = design.optimise(None, &[], &Options::default(), &mut |_| ControlFlow::Continue(()))?;
    let seconds = start.elapsed().as_secs_f64();
    let report = design.report(None, &ReportOptions::default())?;
    let diagonal = design.mesh().diagonal();
    let values = found.history.windows(2);
    let falls = values.map(|pair| 1.0 - pair[1].value / pair[0].value).collect::<Vec<_>>();
    let flat = falls.iter().position(|fall| *fall < FLAT).unwrap_or(falls.len());
    group.plain("strips", design.strips().len() as f64);
    group.at_most("iterations until it falls by less than a thousandth", flat as f64, 15.0);
    group.plain("iterations until it stopped", falls.len() as f64);
    group.plain("strips to surface at the start, largest / diagonal", before.strips_to_reference.max / diagonal);
    group.plain("strips to surface, largest / diagonal", report.strips_to_reference.max / diagonal);
    group.plain("strips to surface, root mean square / diagonal", report.strips_to_reference.rms / diagonal);
    group.plain("surface to strips, largest / diagonal", report.reference_to_strips.max / diagonal);
    group.plain("largest gap / diagonal", report.max_gap / diagonal);
    group.plain("angle of tangent planes along boundaries, largest, degrees", report.max_kink_deg);
    group.at_least("coverage", report.coverage, 0.995);
    group.plain("seconds", seconds);
    Ok(group)
}

pub fn groups() -> Result<Vec<Group>> {
    let mut groups = Vec::new();
    for shape in five() {
        for family in [0, 1] {
            groups.push(group(&shape, family)?);
        }
    }
    Ok(groups)
}
