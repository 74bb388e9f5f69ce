//! `planarize` and its sisters: from a mesh file to a better one beside a report and pictures.

use std::path::Path;

use anyhow::Result;
use serde_json::{Value, json};
use shapeop::mesh::file::{Format, read_source};
use shapeop::mesh::measure::{Spread, edge_lengths};
use shapeop::mesh::{Mesh, Topology};
use shapeop::problem::Problem;
use shapeop::problem::recipes::{self, RecipeOptions};
use shapeop::solver::Outcome;

use crate::Ending;
use crate::args::{Colour, OutputArgs, RecipeArgs};
use crate::exploration::explained;
use crate::output::{Output, say};
use crate::picture::{Panel, Picture};
use crate::report::{Report, Subject};
use crate::run::{self, Run};
use crate::shown::Shown;
use crate::{plot, progress, table};

#[derive(Clone, Copy, Debug)]
pub enum Recipe {
    Planarize,
    Circularize,
    Smooth,
    Regularize,
    Equalize {
        length: Option<f64>,
    },
    /// The distance of diagonals in percent of the mean edge; `None`: planar.
    Rationalize {
        diagonals: Option<f64>,
    },
    Circumscribe,
}

impl Recipe {
    pub fn name(self) -> &'static str {
        match self {
            Self::Planarize => "planarize",
            Self::Circularize => "circularize",
            Self::Smooth => "smooth",
            Self::Regularize => "regularize",
            Self::Equalize { .. } => "equalize",
            Self::Rationalize { .. } => "rationalize",
            Self::Circumscribe => "circumscribe",
        }
    }

    fn problem(self, mesh: &Mesh, options: &RecipeOptions) -> shapeop::error::Result<Problem> {
        match self {
            Self::Planarize => recipes::planarize(mesh, options),
            Self::Circularize => recipes::circularize(mesh, options),
            Self::Smooth => recipes::smooth(mesh, options),
            Self::Regularize => recipes::regularize(mesh, options),
            Self::Equalize { length } => recipes::equalize(mesh, length, options),
            Self::Rationalize { diagonals } => recipes::rationalize(mesh, diagonal_distance(mesh, diagonals)?, options),
            Self::Circumscribe => recipes::circumscribe(mesh, options),
        }
    }

    /// What its picture shows.
    fn colour(self) -> Colour {
        match self {
            Self::Planarize | Self::Rationalize { .. } => Colour::Planarity,
            Self::Circularize | Self::Circumscribe => Colour::Circularity,
            Self::Smooth => Colour::Displacement,
            Self::Regularize => Colour::Regularity,
            Self::Equalize { .. } => Colour::Lengths,
        }
    }

    /// What it was asked for, for the report.
    fn options_in_report(self, options: &RecipeOptions, mesh: &Mesh) -> shapeop::error::Result<Value> {
        let mut value = json!({
            "weight": options.weight,
            "closeness": options.closeness,
            "fairness": options.fairness,
            "fairness_kind": format!("{:?}", options.fairness_kind),
            "anchors": {
                "points": options.anchors.points,
                "boundary": options.anchors.boundary,
                "corners": options.anchors.corners,
            },
        });
        if let Self::Equalize { length } = self {
            value["length"] = json!(length);
        }
        if let Self::Rationalize { diagonals } = self {
            value["diagonals"] = json!(diagonals.map(|percent| percent / 100.0));
            value["length"] = json!(diagonal_distance(mesh, diagonals)?);
        }
        Ok(value)
    }
}

/// Percent of the mean edge as a length.
fn diagonal_distance(mesh: &Mesh, percent: Option<f64>) -> shapeop::error::Result<Option<f64>> {
    percent.map(|percent| Ok(percent / 100.0 * Spread::of(&edge_lengths(mesh)?).mean)).transpose()
}

pub fn run(recipe: Recipe, args: &RecipeArgs, is_quiet: bool) -> Result<Ending> {
    let source = read_source(&args.mesh)?;
    let name_lines = |face: usize| source.face_lines.get(face).map(|line| format!("line {line}"));
    let format = args.output.format.map_or_else(|| Format::of(&args.mesh), |format| Ok(format.into()))?;
    let job = Job { recipe, mesh: &source.mesh, input: &args.mesh, options: args.goal.options(), format };
    let problem =
        job.recipe.problem(job.mesh, &job.options).map_err(|error| place_in_file(error, args, &name_lines))?;
    carry_out(&job, &problem, &args.iterate, &args.output, is_quiet)
}

/// Puts the file, and the line of a face, before a refusal that names a face.
fn place_in_file(
    error: shapeop::error::Error,
    args: &RecipeArgs,
    line_of: &dyn Fn(usize) -> Option<String>,
) -> anyhow::Error {
    let face = error.place().strip_prefix("faces[").and_then(|rest| rest.split(']').next()?.parse().ok());
    match face.map(line_of) {
        Some(Some(line)) => anyhow::anyhow!("{}, {line}: {error}", args.mesh.display()),
        Some(None) => anyhow::anyhow!("{}: {error}", args.mesh.display()),
        None if error.place() == "faces" => anyhow::anyhow!("{}: {error}", args.mesh.display()),
        None => error.into(),
    }
}

/// A recipe with what it is made from.
pub struct Job<'a> {
    pub recipe: Recipe,
    pub mesh: &'a Mesh,
    pub input: &'a Path,
    pub options: RecipeOptions,
    pub format: Format,
}

impl Job<'_> {
    pub fn problem(&self) -> shapeop::error::Result<Problem> {
        self.recipe.problem(self.mesh, &self.options)
    }
}

/// Solves, writes everything, tells about it.
pub fn carry_out(
    job: &Job<'_>,
    problem: &Problem,
    iterate: &crate::args::IterateArgs,
    output_args: &OutputArgs,
    is_quiet: bool,
) -> Result<Ending> {
    let name = job.recipe.name();
    let settings = run::settings(problem, iterate);
    // Before anything takes long: a folder that cannot be made should not cost an hour.
    let mut output = Output::new(&output_args.out, job.input, name, output_args.picture)?;
    progress::catch_interrupts();
    let found = run::run(problem, &settings, iterate, is_quiet)?;
    let after = Mesh { points: found.solver.points().to_vec(), faces: job.mesh.faces.clone() };
    let subject = Subject {
        command: name,
        input: &job.input.display().to_string(),
        problem,
        settings,
        options: job.recipe.options_in_report(&job.options, job.mesh)?,
        limit: output_args.limit / 100.0,
        before: job.mesh,
        after: &after,
    };
    let mut report = Report::new(&subject, &found)?;
    output.mesh(&after, job.format)?;
    if output.wants_pictures() {
        output.picture("picture", &picture(job, output_args, &after, &report)?)?;
        let title = format!("{} of {}: {}", name, file_name(job.input), report.ending());
        if let Some(svg) =
            plot::convergence(&title, &found.history, problem.mode, report.measure(), settings.tolerance)?
        {
            output.picture("convergence", &svg)?;
        }
    }
    output.report(&mut report)?;
    tell(&report, &output, output_args.json, is_quiet)?;
    Ok(ending(&found))
}

/// Prints the table, or the report.
pub fn tell(report: &Report, output: &Output, as_json: bool, is_quiet: bool) -> Result<()> {
    if is_quiet {
        return Ok(());
    }
    if as_json {
        return say(report.to_json()?.trim_end());
    }
    let hard = |name: &String| match report.hard_constraints.get(name) {
        None => String::new(),
        Some(hard) if *hard == report.constraints[name] => " (hard)".to_owned(),
        Some(hard) => format!(" ({hard} hard)"),
    };
    let counted = |(name, count): (&String, &usize)| format!("{count} {name}{}", hard(name));
    let constraints: Vec<String> = report.constraints.iter().map(counted).collect();
    let Report { command, input, points, faces, .. } = report;
    let start = format!("{command} {input}: {points} points, {faces} faces; {}", constraints.join(", "));
    let (ending, table, files) = (report.ending(), table::of_report(report), output.in_lines());
    let conflicts = match &report.exploration {
        Some(exploration) if report.is_infeasible() => format!("\n\n{}", explained(&exploration.conflicts)),
        _ => String::new(),
    };
    say(&format!("{start}\n{ending}{conflicts}\n\n{table}\n\n{files}"))
}

pub fn ending(found: &Run) -> Ending {
    match found.report.outcome {
        _ if found.was_interrupted => Ending::Interrupted,
        Outcome::Infeasible => Ending::Infeasible,
        Outcome::BackendFailed => Ending::BackendFailed,
        _ => Ending::Done,
    }
}

pub fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn picture(job: &Job<'_>, args: &OutputArgs, after: &Mesh, report: &Report) -> Result<String> {
    let what = if args.colour == Colour::Auto { job.recipe.colour() } else { args.colour };
    let edges = Topology::new(job.mesh)?.edges().to_vec();
    let shown = Shown::new(what, args.limit, job.mesh, &edges, None);
    let panels: Vec<Panel<'_>> = [("before", job.mesh), ("after", after)]
        .into_iter()
        .map(|(title, mesh)| shown.panel(mesh, &edges, title.to_owned()))
        .collect();
    let scale = shown.scale(&panels);
    let picture = Picture {
        title: format!("{}: {}", file_name(job.input), job.recipe.name()),
        subtitle: subtitle(report),
        panels,
        scale,
        fits_each: false,
    };
    Ok(picture.to_svg())
}

fn subtitle(report: &Report) -> String {
    let moved = report
        .displacement
        .max_over_mean_edge
        .map(|share| format!(", moved at most {} of the mean edge", table::percent(share)));
    format!("{} points, {} faces, {}{}", report.points, report.faces, report.ending(), moved.unwrap_or_default())
}
