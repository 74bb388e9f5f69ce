//! Seconds per step for a large mesh.

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
use crate::shapes::five;

pub fn group() -> Result<Group> {
    let [.., free_form] = five();
    let mesh = free_form.mesh(159, 159)?;
    let claim = "Free form, 159 by 159 points; boundaries orthogonal to asymptotic curves, 20 control points.";
    let mut group = Group::new("speed: a mesh of 50 000 triangles, 30 strips", claim);
    let start = Instant::now();
    let mut last = 0.0;
    let mut step = |group: &mut Group, name: &str| {
        let now = start.elapsed().as_secs_f64();
        group.plain(&format!("{name}, seconds"), now - last);
        last = now;
    };
    let mut design = Design::new(&mesh, &FieldOptions::default())?;
    step(&mut group, "field");
    let function = LevelOptions::default();
    let (levels, options) = (Levels::Count(29), BoundaryOptions::default());
    design.set_level_boundaries(&function, &levels, &options, &mut |_| ControlFlow::Continue(()))?;
    step(&mut group, "boundaries");
    design.start(StartOptions { control_count: 20, ..StartOptions::default() })?;
    step(&mut group, "strips to start from");
    let found = design.optimise(None, &[], &Options::default(), &mut |_| ControlFlow::Continue(()))?;
    step(&mut group, "optimisation");
    let report = design.report(None, &ReportOptions::default())?;
    step(&mut group, "report");
    group.at_most("all, seconds", start.elapsed().as_secs_f64(), 20.0);
    group.plain("triangles", design.mesh().triangles().len() as f64);
    group.at_least("strips", design.strips().len() as f64, 30.0);
    group.plain("iterations", (found.history.len() - 1) as f64);
    group.at_least("coverage", report.coverage, 0.995);
    Ok(group)
}
