//! The field of asymptotic directions: what there is to say of it, and `ruled field`.

use std::collections::BTreeMap;
use std::fmt::Write;

use anyhow::Result;
use serde::Serialize;
use shapeop::geometry::ruled::asymptotic::PointStatus;
use shapeop::geometry::ruled::design::Design;
use shapeop::mesh::file::read_source;

use super::pictures::{self, View};
use super::places::Places;
use super::report::{FieldInReport, MeshInReport, VERSION};
use super::strips::{field_options, title};
use crate::Ending;
use crate::args::ruled::FieldCommandArgs;
use crate::commands::canal::in_json;
use crate::output::{Output, say};
use crate::table::{aligned, number};

#[derive(Serialize)]
struct Report {
    version: u32,
    program: &'static str,
    command: &'static str,
    input: String,
    mesh: MeshInReport,
    field: FieldInReport,
    warnings: Vec<String>,
    files: BTreeMap<String, String>,
}

pub fn in_report(design: &Design, family: usize) -> FieldInReport {
    let directions = design.directions();
    let count = |kind: PointStatus| directions.status().iter().filter(|status| **status == kind).count();
    let known = directions.curvatures().iter().zip(directions.status());
    let gaussian = known.filter(|(_, status)| **status == PointStatus::Good).map(|(curvature, _)| curvature.gaussian());
    let range = gaussian.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], k| [low.min(k), high.max(k)]);
    FieldInReport {
        family,
        masked_points: directions.masked_count(),
        not_negative: count(PointStatus::NotNegative),
        not_fitted: count(PointStatus::NotFitted),
        flipped_edges: design.flips().len(),
        gaussian_curvature: range,
    }
}

pub fn warnings(design: &Design) -> Vec<String> {
    let mut warnings = Vec::new();
    let (masked, all) = (design.directions().masked_count(), design.mesh().points().len());
    if masked > 0 {
        warnings.push(format!(
            "{masked} of {all} points have no directions, since the mesh is flat or bulges there: boundaries and strips are carried \
             over them, not made for them"
        ));
    }
    if !design.flips().is_empty() {
        warnings.push(format!(
            "the field changes its sign across {} edges: boundaries are the best that there are, and not continuous there",
            design.flips().len()
        ));
    }
    warnings
}

/// A line for each point: both directions, the principal curvatures, the status.
fn csv(design: &Design) -> Result<String> {
    let directions = design.directions();
    let (families, known) = ([directions.family(0)?, directions.family(1)?], directions.status());
    let mut text = String::from("point,x,y,z,x0,y0,z0,x1,y1,z1,curvature1,curvature2,status\n");
    for (i, point) in design.mesh().points().iter().enumerate() {
        let _ = write!(text, "{i}");
        let numbers = [*point, families[0][i], families[1][i]].map(|v| v.to_array()).concat();
        let principal = directions.curvatures()[i].principal;
        numbers.iter().chain(&principal).for_each(|number| _ = write!(text, ",{number}"));
        let status = match known[i] {
            PointStatus::Good => "good",
            PointStatus::NotNegative => "not negative",
            PointStatus::NotFitted => "not fitted",
        };
        let _ = writeln!(text, ",{status}");
    }
    Ok(text)
}

pub fn run(args: &FieldCommandArgs, is_quiet: bool) -> Result<Ending> {
    let source = read_source(&args.mesh)?;
    let places = Places { mesh: &args.mesh, face_lines: &source.face_lines, levels: "--levels", curves: &[] };
    let design = Design::new(&source.mesh, &field_options(&args.field)).map_err(|error| places.of(error))?;
    let mut output = Output::new(&args.place.out, &args.mesh, "field", args.place.picture)?;
    output.text("directions", ".csv", &csv(&design)?)?;
    if output.wants_pictures() {
        let view = View::new(&source.mesh, design.mesh(), title(&args.mesh));
        let curves = pictures::families(&design)?;
        output.picture("picture", &pictures::field(&view, &curves, args.field.family))?;
    }
    let mut report = Report {
        version: VERSION,
        program: concat!("shapeop ", env!("CARGO_PKG_VERSION")),
        command: "ruled field",
        input: args.mesh.display().to_string(),
        mesh: MeshInReport::of(design.mesh()),
        field: in_report(&design, args.field.family),
        warnings: warnings(&design),
        files: BTreeMap::new(),
    };
    output.report_with(|files| {
        report.files = files;
        in_json(&report)
    })?;
    if is_quiet {
        return Ok(Ending::Done);
    }
    if args.place.json {
        say(in_json(&report)?.trim_end())?;
        return Ok(Ending::Done);
    }
    let [low, high] = report.field.gaussian_curvature;
    let rows = [
        vec!["points with directions".to_owned(), (report.mesh.points - report.field.masked_points).to_string()],
        vec!["points without".to_owned(), report.field.masked_points.to_string()],
        vec!["Gaussian curvature".to_owned(), number(low), format!("to {}", number(high))],
        vec!["boundary loops".to_owned(), report.mesh.boundary_loops.to_string()],
    ];
    let warnings: String = report.warnings.iter().map(|warning| format!("\n  warning: {warning}")).collect();
    let start = format!("ruled field {}: family {} is drawn dark", report.input, args.field.family);
    say(&format!("{start}\n\n{}\n{warnings}\n{}", aligned(&rows), output.in_lines()))?;
    Ok(Ending::Done)
}
