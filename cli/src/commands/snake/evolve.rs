//! `snake evolve`: a snake moves over a mesh.

use std::f64::consts::TAU;
use std::time::Instant;

use anyhow::{Result, bail};
use shapeop::geometry::snakes::ArcShape;
use shapeop::geometry::snakes::evolution::{Direction, Stop, Task, Weights};
use shapeop::mesh::file::read_source;
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Mesh, TriangleMesh};

use super::figures::FrameInReport;
use super::going;
use super::made::{self, Made};
use super::names::of_mesh;
use super::rails::{self, Asked, AskedKind};
use super::report::{EvolutionInReport, MotionInReport, Report};
use super::start;
use crate::Ending;
use crate::args::snake::{EvolveArgs, Point};
use crate::progress::catch_interrupts;
use crate::table::number;

/// A closed curve turns by a full turn at least, and by no more only where it is flat and convex (Fenchel 1929): as arcs keep their
/// angles, a snake that does so is rigid. Within this part of it.
const CONVEX: f64 = 1e-6;

/// The part of the mesh's diagonal that arcs may be away from it, if nothing else is asked for.
const MAX_DEVIATION: f64 = 0.01;

pub fn run(args: &EvolveArgs, is_quiet: bool) -> Result<Ending> {
    made::check(&args.output.positions)?;
    catch_interrupts();
    let source = read_source(&args.mesh)?;
    let refused = |error| of_mesh(error, &args.mesh, &source.face_lines);
    let triangles = TriangleMesh::new(&source.mesh).map_err(refused)?;
    let (mesh, triangles) = match args.offset_surface {
        Some(distance) => offset(&source.mesh, &triangles, distance)?,
        None => (source.mesh.clone(), triangles),
    };
    let reference = ReferenceMesh::new(&triangles);
    let clock = Instant::now();
    let mut start = start::on_mesh(&args.start, &reference, is_quiet)?;
    let start_seconds = clock.elapsed().as_secs_f64();

    let snake = &start.snake;
    let speeds = going::speeds(&args.motion, snake);
    let asked = [
        (&args.rails.drive, "--drive", AskedKind::Drive),
        (&args.rails.follow, "--follow", AskedKind::Follow),
        (&args.rails.glide, "--glide", AskedKind::Glide),
    ];
    let asked: Vec<Asked<'_>> = asked
        .iter()
        .flat_map(|(rails, option, kind)| rails.iter().map(|rail| Asked::of(option, rail, *kind)))
        .collect();
    let speed = |point: u32| speeds[point as usize];
    let guides = rails::guides(&asked, snake, &speed, args.rails.snap)?;
    let along_rails: Vec<_> = guides.iter().map(rails::Guide::rail).collect();
    let last = snake.control().len() as u32 - 1;
    let fixed: Vec<u32> = args
        .direction
        .fix
        .iter()
        .map(|point| match point {
            Point::Start => 0,
            Point::End => last,
            Point::Number(number) => *number,
        })
        .collect();
    let is_driven = !args.rails.drive.is_empty();
    let way = &args.direction;
    let (direction, sense, word) = match way.along {
        Some(direction) => (Direction::Along(direction), 1.0, "along"),
        None if way.right => (Direction::Sideways, -1.0, "right"),
        None if is_driven && !way.left => (Direction::Free, 1.0, "rails"),
        None => (Direction::Sideways, 1.0, "left"),
    };
    let sideways: Vec<f64> = speeds.iter().map(|speed| sense * speed).collect();
    let weights = Weights {
        tangential: args.weights.tangential_weight,
        offset: args.weights.offset_weight,
        rotation: args.weights.rotation_weight,
        orthogonal: args.weights.orthogonal_weight,
    };
    let max_deviation = args.motion.max_deviation.unwrap_or(MAX_DEVIATION * triangles.diagonal());
    let options = going::options(&args.motion, snake, weights, args.weights.keep_torsions, max_deviation);
    let task = Task {
        surface: Some(&reference),
        direction,
        speeds: &sideways,
        fixed: &fixed,
        rails: &along_rails,
        ..Task::new(snake)
    };
    let names = going::names(&guides, &args.direction.fix).with("snake", "the snake");
    let clock = Instant::now();
    let found = going::go(&task, &options, &names, is_quiet)?;
    let evolution_seconds = clock.elapsed().as_secs_f64();

    let (frames, times) = going::positions(&found);
    let stop = going::stop_in_words(found.stop, &options, &guides);
    let mut warnings = std::mem::take(&mut start.warnings);
    let turn: f64 = start.snake.shapes().iter().map(ArcShape::angle_rad).sum();
    if start.snake.is_closed() && turn < TAU * (1.0 + CONVEX) {
        warnings.push(
            "the snake is flat and convex, as it turns around once only: it stays so, and moves as it is or not at all"
                .to_owned(),
        );
    }
    if found.frames[0].deviation > max_deviation {
        warnings.push(format!(
            "the snake starts {} from the mesh, more than --max-deviation {}",
            number(found.frames[0].deviation),
            number(max_deviation)
        ));
    }
    let evolution = EvolutionInReport {
        motion: MotionInReport::of(word, &args.motion, &options),
        fixed,
        rails: guides.iter().map(|guide| guide.told.clone()).collect(),
        frames: found.frames.iter().map(FrameInReport::of).collect(),
    };
    let made = Made {
        snake: start.snake.clone(),
        frames,
        times,
        comes_back: false,
        surface: Some((&mesh, &reference)),
        lines: guides.iter().map(rails::Guide::line).collect(),
        is_linkage: false,
        arrays: Vec::new(),
    };
    let report = Report {
        command: "snake evolve",
        input: args.mesh.display().to_string(),
        start: Some(start.told),
        stop: Some(stop),
        evolution: Some(evolution),
        warnings,
        was_interrupted: found.stop == Stop::Cancelled,
        seconds: [("start", start_seconds), ("evolution", evolution_seconds)].into_iter().collect(),
        ..Report::default()
    };
    made::write(&made, report, &args.output, (&args.mesh, "evolve"), is_quiet)
}

/// The mesh with its points moved along their normals.
fn offset(mesh: &Mesh, triangles: &TriangleMesh, distance: f64) -> Result<(Mesh, TriangleMesh)> {
    if !distance.is_finite() {
        bail!("--offset-surface: expected a finite number, found {distance}");
    }
    let points = mesh.points.iter().zip(triangles.point_normals()).map(|(point, normal)| *point + distance * *normal);
    let moved = Mesh { points: points.collect(), faces: mesh.faces.clone() };
    let found = TriangleMesh::new(&moved).map_err(|error| error.with_place("--offset-surface"))?;
    // Where a quad is split the other way after the move nothing can be compared.
    let is_same = |t: &usize| found.triangles().get(*t) == Some(&triangles.triangles()[*t]);
    let turns_over = |t: &usize| found.normal(*t).dot(triangles.normal(*t)) <= 0.0;
    let folded = (0..triangles.triangles().len()).filter(is_same).filter(turns_over).count();
    if folded > 0 {
        bail!(
            "--offset-surface: expected a distance at which the mesh does not fold, found {distance}: {folded} triangles turn over"
        );
    }
    Ok((moved, found))
}
