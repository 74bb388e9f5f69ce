//! Strips that were made, and all files of them.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::ruled::Strip;
use shapeop::geometry::ruled::report::{Report as Measures, ReportOptions, report as measure};
use shapeop::geometry::ruled::rulings_problem::{RulingsOptions, rulings_problem};
use shapeop::geometry::ruled::trim::{TrimOptions, Trimmed, TrimmedRuling, trim};
use shapeop::geometry::ruled::{export, file};
use shapeop::mesh::TriangleMesh;
use shapeop::mesh::reference::ReferenceMesh;

use super::measures::{Relative, counted, rows, warnings};
use super::mesh::trimmed_mesh;
use super::pictures::{self, Families, View};
use super::planks;
use super::report::{
    BoundariesInReport, FieldInReport, MeshInReport, OptimisationInReport, Report, Seconds, StartInReport, VERSION,
};
use super::strips::{Job, title};
use crate::Ending;
use crate::commands::canal::in_json;
use crate::output::{Output, say};
use crate::progress::is_interrupted;
use crate::table::{aligned, number};

/// Columns of quads in each span, and rows, of the mesh of strips that are not trimmed.
const COLUMNS_AND_ROWS: [usize; 2] = [8, 5];

/// How far the polygon along which the mesh of strips is cut may be off, over the diagonal: 0.1 mm in 10 m.
const MESH_TOLERANCE: f64 = 1e-5;

/// Strips and how they came about.
pub struct Made {
    pub mesh: TriangleMesh,
    pub field: Option<FieldInReport>,
    /// Asymptotic curves, for pictures.
    pub curves: Families,
    /// The boundaries as suggested, on the mesh and beyond it.
    pub boundary_lines: [Vec<Vec<DVec3>>; 2],
    pub boundaries: BoundariesInReport,
    pub start: StartInReport,
    pub optimisation: OptimisationInReport,
    pub strips: Vec<Strip>,
    /// Strips that meet.
    pub joints: Vec<[usize; 2]>,
    pub warnings: Vec<String>,
    pub seconds: Seconds,
}

/// Writes everything and tells about it.
pub fn write(job: &Job<'_>, made: Made, path: &Path, mut output: Output) -> Result<Ending> {
    let args = job.args;
    let mut seconds = made.seconds;
    let clock = Instant::now();
    let progress = job.phase("report", 1);
    let reference = ReferenceMesh::new(&made.mesh);
    let options = ReportOptions { joints: Some(made.joints.clone()), ..ReportOptions::default() };
    let measured = measure(&made.strips, &reference, &reference, &options);
    let trimmed = trim(&made.strips, &reference, &TrimOptions::default());
    progress.finish();
    let (measured, trimmed) = (measured?, trimmed?);
    seconds.report = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    let progress = job.phase("files", 1);
    let format = args.output.place.format.into();
    let cut = trim(&made.strips, &reference, &TrimOptions { tolerance: MESH_TOLERANCE, ..TrimOptions::default() })?;
    let mesh = if args.output.no_trim {
        export::mesh(&made.strips, COLUMNS_AND_ROWS[0], COLUMNS_AND_ROWS[1])?.0
    } else {
        trimmed_mesh(&made.strips, &cut)
    };
    output.mesh(&mesh, format)?;
    output.text("strips", ".strips.json", &file::to_json(&made.strips))?;
    output.text("surfaces", ".surfaces.obj", &export::surfaces_obj(&made.strips))?;
    let rulings = rulings(&made.strips, &trimmed, args.output.rulings, args.output.no_trim);
    output.text("rulings", ".rulings.obj", &export::rulings_obj(&rulings))?;
    output.text("ruling table", ".rulings.csv", &export::rulings_csv(&rulings))?;
    let planks = match args.output.planks {
        Some(thickness) => {
            let asked = planks::Asked { thickness, depth: args.output.depth, unit: args.output.unit, format };
            planks::write(&made.strips, &planks::beside(&made.strips, &trimmed), &asked, &title(path), &mut output)?
        }
        None => Vec::new(),
    };
    // What was asked for besides must not take the rest with it.
    let problem = if args.output.problem { write_problem(job, &made, &mut output) } else { Ok(()) };
    if output.wants_pictures() {
        write_pictures(job, &made, &cut, &rulings, &measured, path, &mut output)?;
    }
    progress.finish();
    seconds.files = clock.elapsed().as_secs_f64();

    let diagonal = made.mesh.diagonal();
    let mut told = made.warnings;
    told.extend(warnings(&measured, diagonal));
    let refused =
        planks.iter().filter_map(|of| Some(format!("no planks of strip {}: {}", of.strip, of.refusal.as_ref()?)));
    told.extend(refused);
    let mut report = Report {
        version: VERSION,
        program: concat!("shapeop ", env!("CARGO_PKG_VERSION")),
        command: "ruled",
        input: path.display().to_string(),
        mesh: MeshInReport::of(&made.mesh),
        field: made.field,
        boundaries: made.boundaries,
        start: made.start,
        optimisation: made.optimisation,
        relative: Relative::of(&measured, diagonal),
        measures: measured,
        planks,
        warnings: told,
        was_interrupted: is_interrupted(),
        seconds,
        files: BTreeMap::new(),
    };
    output.report_with(|files| {
        report.files = files;
        in_json(&report)
    })?;
    if !job.is_quiet {
        if args.output.place.json { say(in_json(&report)?.trim_end())? } else { say(&in_words(&report, &output))? }
    }
    problem?;
    Ok(if report.was_interrupted { Ending::Interrupted } else { Ending::Done })
}

/// Rulings of each strip, trimmed or whole.
fn rulings(strips: &[Strip], trimmed: &[Trimmed], count: usize, are_whole: bool) -> Vec<Vec<TrimmedRuling>> {
    let whole = |strip: &Strip| {
        let ruling = |u: f64| TrimmedRuling { u, pieces: vec![strip.ruling(u)] };
        strip.ruling_parameters(count).into_iter().map(ruling).collect()
    };
    let of =
        |(strip, trimmed): (&Strip, &Trimmed)| if are_whole { whole(strip) } else { trimmed.rulings(strip, count) };
    strips.iter().zip(trimmed).map(of).collect()
}

/// Strips as a problem for the solver.
fn write_problem(job: &Job<'_>, made: &Made, output: &mut Output) -> Result<()> {
    let output_args = &job.args.output;
    let options = RulingsOptions {
        rulings: output_args.rulings,
        is_straight_hard: output_args.hard_rulings,
        ..RulingsOptions::default()
    };
    let found = rulings_problem(&made.strips, &made.mesh, &options).map_err(|error| {
        let place = error.place().replace("options.rulings", "--rulings");
        error.with_place(format!("--problem: {place}"))
    })?;
    output.text("problem", ".problem.json", &found.problem.to_json())
}

fn write_pictures(
    job: &Job<'_>,
    made: &Made,
    trimmed: &[Trimmed],
    rulings: &[Vec<TrimmedRuling>],
    measured: &Measures,
    path: &Path,
    output: &mut Output,
) -> Result<()> {
    let view = View::new(job.mesh, &made.mesh, title(path));
    let parts = pictures::parts(&made.strips, if job.args.output.no_trim { None } else { Some(trimmed) });
    if let Some(field) = &made.field {
        output.picture("field", &pictures::field(&view, &made.curves, field.family))?;
    }
    let curves = made.curves[0].as_slice();
    output.picture("boundaries", &pictures::boundaries(&view, curves, &made.boundary_lines, &made.boundaries))?;
    output.picture("picture", &pictures::strips(&view, &made.strips, &parts, rulings, measured))?;
    output.picture("deviation", &pictures::deviation(&view, &made.strips, measured, made.mesh.diagonal())?)?;
    if job.args.output.zebra {
        output.picture("zebra", &pictures::zebra(&view, &made.strips, &parts, measured)?)?;
    }
    Ok(())
}

fn in_words(report: &Report, output: &Output) -> String {
    let boundaries = &report.boundaries;
    let family = report.field.as_ref().map_or(String::new(), |field| format!(", rulings of family {}", field.family));
    let closed = match boundaries.closed {
        0 => String::new(),
        closed => format!(" ({closed} closed)"),
    };
    let start = format!(
        "ruled {}: {} between {} {} boundaries{closed}{family}",
        report.input,
        counted(report.measures.strips.len(), "strip"),
        boundaries.count,
        boundaries.kind
    );
    let mut table = rows(&report.measures, report.mesh.diagonal);
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    if let Some(angles) = &boundaries.least_angles_deg {
        let least = angles.iter().copied().fold(f64::INFINITY, f64::min);
        table.push(row("planes to rulings, least", format!("{}°", number(least))));
    }
    let optimisation = &report.optimisation;
    table.push(row("optimisation", format!("{} iterations, {}", optimisation.iterations, optimisation.stop)));
    let conditions = optimisation.conditions;
    let exact = [
        (conditions.planar_boundaries, "boundaries in planes"),
        (conditions.conoidal_strips, "conoidal strips"),
        (conditions.fixed_ends, "fixed ends"),
        (conditions.fixed_end_rulings, "fixed end rulings"),
    ];
    let exact: Vec<String> =
        exact.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
    if !exact.is_empty() {
        table.push(row("exact", exact.join(", ")));
    }
    let boards: Vec<_> = report.planks.iter().filter(|of| of.refusal.is_none()).collect();
    if !boards.is_empty() {
        let count: usize = boards.iter().map(|of| of.planks).sum();
        let longest = boards.iter().map(|of| of.longest).fold(0.0, f64::max);
        let stock: f64 = boards.iter().map(|of| of.stock_area).sum();
        let offcut: f64 = boards.iter().map(|of| of.stock_area * of.offcut).sum::<f64>() / stock;
        let cells = format!("{count}, longest {}, offcut {}", number(longest), crate::table::percent(offcut));
        table.push(row("planks", cells));
    }
    let seconds = report.seconds;
    table.push(row(
        "seconds",
        format!(
            "field {:.2}, boundaries {:.2}, strips {:.2}, optimisation {:.2}, report {:.2}, files {:.2}",
            seconds.field, seconds.boundaries, seconds.strips, seconds.optimisation, seconds.report, seconds.files
        ),
    ));
    let warnings: String = report.warnings.iter().map(|warning| format!("\n  warning: {warning}")).collect();
    let warnings = if warnings.is_empty() { warnings } else { format!("\n{warnings}") };
    format!("{start}\n\n{}{warnings}\n\n{}", table_in_words(&table), output.in_lines())
}

/// Numbers in columns; lines of words as they are.
fn table_in_words(rows: &[Vec<String>]) -> String {
    let (columns, words): (Vec<_>, Vec<_>) = rows.iter().cloned().partition(|row| row.len() > 2);
    let width = columns.iter().chain(&words).map(|row| row[0].chars().count()).max().unwrap_or(0);
    let padded = |row: &Vec<String>| {
        let mut row = row.clone();
        row[0] = format!("{:<width$}", row[0]);
        row
    };
    let head = aligned(&columns.iter().map(padded).collect::<Vec<_>>());
    let tail: Vec<String> = words.iter().map(|row| format!("  {:<width$}   {}", row[0], row[1])).collect();
    format!("{head}\n{}", tail.join("\n"))
}
