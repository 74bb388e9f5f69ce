//! `snake check`: what a snake is like.

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::file::read_source;
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{ReferenceSurface as _, TriangleMesh};

use super::figures::{OnSurface, SnakeInReport, lowest_and_greatest};
use super::names::of_mesh;
use super::report::Report;
use super::start;
use crate::Ending;
use crate::args::snake::SnakeCheckArgs;
use crate::commands::ruled::counted;
use crate::output::say;
use crate::table::{aligned, number};
use shapeop::geometry::snakes::freedoms::freedoms_on_surface;

pub fn run(args: &SnakeCheckArgs, is_quiet: bool) -> Result<Ending> {
    let snake = start::read(&args.snake)?;
    let mut told = SnakeInReport::of(&snake);
    if let Some(path) = &args.mesh {
        let source = read_source(path)?;
        let mesh = TriangleMesh::new(&source.mesh).map_err(|error| of_mesh(error, path, &source.face_lines))?;
        let reference = ReferenceMesh::new(&mesh);
        let normals: Vec<DVec3> = snake.control().iter().map(|point| reference.nearest(*point).normal).collect();
        let middles = snake.arcs().into_iter().map(|arc| arc.point(0.5));
        let apart = snake.contacts().into_iter().chain(middles).map(|at| reference.nearest(at).point.distance(at));
        told.on_surface = Some(OnSurface {
            mesh: path.display().to_string(),
            deviation: apart.fold(0.0, f64::max),
            freedoms: freedoms_on_surface(&snake, &normals)?.free,
        });
    }
    if is_quiet {
        return Ok(Ending::Done);
    }
    if args.json {
        let report = Report {
            command: "snake check",
            input: args.snake.display().to_string(),
            snake: Some(told),
            ..Report::default()
        };
        say(&report.in_json()?)?;
        return Ok(Ending::Done);
    }
    let closed = if told.closed { "a closed" } else { "an open" };
    let start = format!("{}: {closed} snake of {} arcs, {} long", args.snake.display(), told.arcs, number(told.length));
    let torsions: Vec<f64> = told.torsions_deg.clone();
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let mut rows = vec![
        row("radii", lowest_and_greatest(&told.radii)),
        row("lengths", lowest_and_greatest(&told.lengths)),
        row("angles", format!("{}°", lowest_and_greatest(&told.angles_deg))),
        row("distances off", number(told.residual)),
        row("freedoms", format!("{}, with the 6 of rigid motions", told.freedoms)),
    ];
    if !torsions.is_empty() {
        rows.insert(3, row("torsions", format!("{}°", lowest_and_greatest(&torsions))));
    }
    if let Some(freedoms) = told.linkage_freedoms {
        rows.push(row("as a linkage", counted(freedoms, "freedom")));
    }
    if let Some(determinant) = told.determinant {
        let words = if determinant.abs() < 1e-6 { ": singular, or nearly" } else { "" };
        rows.push(row("determinant", format!("{}{words}", number(determinant))));
    }
    if let Some(on) = &told.on_surface {
        rows.push(row("from the mesh", number(on.deviation)));
        rows.push(row("freedoms on it", on.freedoms.to_string()));
    }
    let mut table = vec![["arc", "radius", "length", "angle", "torsion after it"].map(str::to_owned).to_vec()];
    for (j, radius) in told.radii.iter().enumerate() {
        let torsion = torsions.get(j).map_or(String::new(), |torsion| format!("{}°", number(*torsion)));
        let angle = format!("{}°", number(told.angles_deg[j]));
        table.push(vec![j.to_string(), number(*radius), number(told.lengths[j]), angle, torsion]);
    }
    let width = rows.iter().map(|row| row[0].chars().count()).max().unwrap_or(0);
    let lines: Vec<String> = rows.iter().map(|row| format!("  {:<width$}   {}", row[0], row[1])).collect();
    say(&format!("{start}\n\n{}\n\n{}", lines.join("\n"), aligned(&table)))?;
    Ok(Ending::Done)
}
