//! `snake fit`: arcs along a curve.

use std::time::Instant;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::file;

use super::figures::SnakeInReport;
use super::pictures;
use super::report::Report;
use super::start;
use crate::Ending;
use crate::args::snake::FitArgs;
use crate::curve_file::Curve;
use crate::output::{Output, say};
use crate::progress::{catch_interrupts, is_interrupted};

pub fn run(args: &FitArgs, is_quiet: bool) -> Result<Ending> {
    catch_interrupts();
    let clock = Instant::now();
    let start = start::along_file(&args.curve, args.arcs, &args.fit, is_quiet)?;
    let mut output = Output::new(&args.place.out, &args.curve, "fit", args.place.picture)?;
    let mut report = Report {
        command: "snake fit",
        input: args.curve.display().to_string(),
        snake: Some(SnakeInReport::of(&start.snake)),
        start: Some(start.told),
        warnings: start.warnings,
        was_interrupted: is_interrupted(),
        seconds: [("fit", clock.elapsed().as_secs_f64())].into_iter().collect(),
        ..Report::default()
    };
    output.text("snake", ".snake.json", &file::to_json(&start.snake))?;
    if output.wants_pictures() {
        let points: Vec<DVec3> = Curve::read(&args.curve)?.points;
        output.picture("picture", &pictures::fitted(&start.snake, &points, &report)?)?;
    }
    report.write(&mut output)?;
    if !is_quiet {
        say(&if args.place.json { report.in_json()? } else { report.in_words(&output) })?;
    }
    Ok(if report.was_interrupted { Ending::Interrupted } else { Ending::Done })
}
