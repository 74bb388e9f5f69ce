//! `solve`: a problem file, static or dynamic.

use anyhow::{Context, Result};
use glam::DVec3;
use serde_json::Value;
use shapeop::mesh::file::Format;
use shapeop::mesh::{Mesh, Topology};
use shapeop::problem::{Mode, Problem};

use super::recipe::{ending, file_name, tell};
use crate::Ending;
use crate::args::{Colour, SolveArgs};
use crate::output::Output;
use crate::picture::Picture;
use crate::report::{Report, Subject};
use crate::run::{self, Run};
use crate::shown::{RestLength, Shown};
use crate::{plot, progress};

pub fn run(args: &SolveArgs, is_quiet: bool) -> Result<Ending> {
    let name = args.problem.display();
    let text = std::fs::read_to_string(&args.problem).with_context(|| format!("{name}: cannot be read"))?;
    let problem = Problem::from_json(&text).with_context(|| name.to_string())?;
    let mut settings = run::settings(&problem, &args.iterate);
    settings.steps = args.steps.unwrap_or(settings.steps);
    let mut output = Output::new(&args.output.out, &args.problem, "solve", args.output.picture)?;
    progress::catch_interrupts();
    let found = run::run(&problem, &settings, &args.iterate, is_quiet).with_context(|| name.to_string())?;

    let mesh_of = |points: &[DVec3]| Mesh { points: points.to_vec(), faces: problem.faces.clone() };
    let start: Vec<DVec3> = problem.points.iter().copied().map(DVec3::from_array).collect();
    let (before, after) = (mesh_of(&start), mesh_of(found.solver.points()));
    let subject = Subject {
        command: "solve",
        input: &name.to_string(),
        problem: &problem,
        settings,
        options: Value::Null,
        limit: args.output.limit / 100.0,
        before: &before,
        after: &after,
    };
    let mut report = Report::new(&subject, &found)?;
    output.mesh(&after, args.output.format.map_or(Format::Obj, Into::into))?;
    if output.wants_pictures() {
        output.picture("picture", &picture(args, &problem, &found, &before, &report)?)?;
        let title = format!("{}: {}", file_name(&args.problem), report.ending());
        if let Some(svg) =
            plot::convergence(&title, &found.history, problem.mode, report.measure(), settings.tolerance)?
        {
            output.picture("convergence", &svg)?;
        }
    }
    output.report(&mut report)?;
    tell(&report, &output, args.output.json, is_quiet)?;
    Ok(ending(&found))
}

/// What the constraints are about, as far as it can be shown.
fn what_to_show(problem: &Problem, rest: &[RestLength]) -> Colour {
    let count = |name: &str| problem.constraints.iter().filter(|constraint| constraint.type_name == name).count();
    let candidates = [
        (rest.len(), Colour::Strain),
        (if problem.faces.is_empty() { 0 } else { count("Plane") + count("DiagonalDistance") }, Colour::Planarity),
        (if problem.faces.is_empty() { 0 } else { count("Circle") }, Colour::Circularity),
        (if problem.faces.is_empty() { 0 } else { count("Similarity") }, Colour::Regularity),
    ];
    let most = candidates.into_iter().max_by_key(|(count, _)| *count).filter(|(count, _)| *count > 0);
    most.map_or(if problem.faces.is_empty() { Colour::None } else { Colour::Displacement }, |(_, colour)| colour)
}

fn picture(args: &SolveArgs, problem: &Problem, found: &Run, before: &Mesh, report: &Report) -> Result<String> {
    let rest = rest_lengths(found);
    let what = if args.output.colour == Colour::Auto { what_to_show(problem, &rest) } else { args.output.colour };
    let edges = match what {
        Colour::Strain => rest.iter().map(|rest| rest.edge).collect(),
        _ if !problem.edges.is_empty() => problem.edges.clone(),
        _ => Topology::new(before)?.edges().to_vec(),
    };
    let shown = Shown::new(what, args.output.limit, before, &edges, Some(&rest));
    let mut meshes: Vec<(String, Mesh)> = Vec::new();
    if problem.mode == Mode::Dynamic {
        for frame in &found.frames {
            let title = if frame.step == 0 { "start".to_owned() } else { format!("step {}", frame.step) };
            meshes.push((title, Mesh { points: frame.points.clone(), faces: problem.faces.clone() }));
        }
    } else {
        meshes.push(("before".to_owned(), before.clone()));
        meshes
            .push(("after".to_owned(), Mesh { points: found.solver.points().to_vec(), faces: problem.faces.clone() }));
    }
    let panels: Vec<_> = meshes.iter().map(|(title, mesh)| shown.panel(mesh, &edges, title.clone())).collect();
    let scale = shown.scale(&panels);
    let title = file_name(&args.problem);
    let fitted = if problem.mode == Mode::Dynamic { "; each frame fills its room" } else { "" };
    let count = problem.constraints.len();
    let subtitle = format!("{} points, {count} constraints, {}{fitted}", report.points, report.ending());
    Ok(Picture { title, subtitle, panels, scale, fits_each: problem.mode == Mode::Dynamic }.to_svg())
}

/// The edges that EdgeStrain constraints hold, with the lengths they ask for.
fn rest_lengths(found: &Run) -> Vec<RestLength> {
    let views = (0..found.solver.constraint_count()).filter_map(|id| found.solver.constraint(id));
    let strains = views.filter(|view| view.info.name == "EdgeStrain");
    strains
        .filter_map(|view| match (view.indices, view.scalars) {
            (&[a, b], &[length, ..]) => Some(RestLength { edge: [a, b], length }),
            _ => None,
        })
        .collect()
}
