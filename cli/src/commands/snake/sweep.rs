//! `snake sweep`: a snake moves along rails, without a surface.

use std::path::Path;
use std::time::Instant;

use anyhow::{Result, bail};
use shapeop::geometry::snakes::evolution::{Direction, Stop, Task, Weights};

use super::figures::FrameInReport;
use super::going;
use super::made::{self, Made};
use super::rails::{self, Asked, AskedKind, Kind};
use super::report::{EvolutionInReport, MotionInReport, Report};
use super::start::{self, Start};
use crate::Ending;
use crate::args::snake::{Point, SweepArgs};
use crate::progress::catch_interrupts;

/// A snake is flat where no torsion has a greater sine.
const FLAT: f64 = 1e-3;

/// A snake can move rigidly along so many rails.
const MOST_RIGID: usize = 3;

pub fn run(args: &SweepArgs, is_quiet: bool) -> Result<Ending> {
    made::check(&args.output.positions)?;
    catch_interrupts();
    let clock = Instant::now();
    let mut start = start_of(args, is_quiet)?;
    let start_seconds = clock.elapsed().as_secs_f64();
    let snake = &start.snake;
    if snake.is_closed() {
        bail!("RAIL: expected an open snake, whose ends run along rails, found a closed one");
    }
    let asked: Vec<Asked<'_>> =
        args.rails.iter().enumerate().map(|(k, file)| asked(k, file, args.drive_both)).collect();
    let speeds = going::speeds(&args.motion, snake);
    let mut guides = rails::guides(&asked, snake, &|point| speeds[point as usize], args.snap)?;
    if args.drive_both {
        // Both come to their ends at one time.
        let left = |guide: &rails::Guide, speed: f64| {
            let [low, high] = shapeop::mesh::curve::Curve::range(&guide.curve);
            if speed < 0.0 { guide.start - low } else { high - guide.start }
        };
        if let (Kind::Drive { speed: first, .. }, Kind::Drive { point, speed: second }) =
            (guides[0].kind, guides[1].kind)
        {
            let time = left(&guides[0], first) / first.abs();
            let speed = second.signum() * left(&guides[1], second) / time;
            guides[1].kind = Kind::Drive { point, speed: if speed.is_finite() { speed } else { second } };
        }
    }
    let along_rails: Vec<_> = guides.iter().map(rails::Guide::rail).collect();
    let is_rigid = !args.flexible && args.rails.len() <= MOST_RIGID;
    let weights = Weights { rotation: args.rotation_weight, offset: args.offset_weight, ..Weights::default() };
    let options = going::options(&args.motion, snake, weights, is_rigid, f64::INFINITY);
    if start.snake.torsions().iter().all(|torsion| torsion.sin().abs() < FLAT) && !args.drive_both {
        start.warnings.push(
            "the snake is flat: which way its arcs turn is not seen to first order, and ends that keep their distance may hold it"
                .to_owned(),
        );
    }
    let snake = &start.snake;
    let task = Task {
        direction: args.along.map_or(Direction::Free, Direction::Along),
        speeds: &speeds,
        rails: &along_rails,
        ..Task::new(snake)
    };
    let names = going::names(&guides, &[]).with("snake", "the snake");
    let clock = Instant::now();
    let found = going::go(&task, &options, &names, is_quiet)?;
    let evolution_seconds = clock.elapsed().as_secs_f64();

    let (frames, times) = going::positions(&found);
    let evolution = EvolutionInReport {
        motion: MotionInReport::of(if args.along.is_some() { "along" } else { "rails" }, &args.motion, &options),
        fixed: Vec::new(),
        rails: guides.iter().map(|guide| guide.told.clone()).collect(),
        frames: found.frames.iter().map(FrameInReport::of).collect(),
    };
    let made = Made {
        snake: start.snake.clone(),
        frames,
        times,
        comes_back: false,
        surface: None,
        lines: guides.iter().map(rails::Guide::line).collect(),
        is_linkage: false,
        arrays: Vec::new(),
    };
    let report = Report {
        command: "snake sweep",
        input: args.rails[0].display().to_string(),
        stop: Some(going::stop_in_words(found.stop, &options, &guides)),
        evolution: Some(evolution),
        warnings: std::mem::take(&mut start.warnings),
        start: Some(start.told),
        was_interrupted: found.stop == Stop::Cancelled,
        seconds: [("start", start_seconds), ("evolution", evolution_seconds)].into_iter().collect(),
        ..Report::default()
    };
    made::write(&made, report, &args.output, (&args.rails[0], "sweep"), is_quiet)
}

fn asked(k: usize, file: &Path, drives_both: bool) -> Asked<'_> {
    let (point, kind) = match k {
        0 => (Some(Point::Start), AskedKind::Drive),
        1 if drives_both => (Some(Point::End), AskedKind::Drive),
        1 => (Some(Point::End), AskedKind::Follow),
        _ => (None, AskedKind::Glide),
    };
    Asked { option: "RAIL", file, point, kind }
}

fn start_of(args: &SweepArgs, is_quiet: bool) -> Result<Start> {
    if let Some(path) = &args.snake {
        return start::from_file(path);
    }
    match (&args.curve, args.arcs) {
        (Some(path), Some(arcs)) => start::along_file(path, arcs, &args.fit, is_quiet),
        _ => bail!("--curve: expected a curve to fit the snake to, with --arcs"),
    }
}
