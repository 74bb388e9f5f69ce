//! `snake linkage`: arcs whose ends are on hinges, around their motion.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use glam::DVec3;
use shapeop::geometry::snakes::cycle::{End, Motion, Options, cycle};
use shapeop::geometry::snakes::{ArcShape, Linkage, Pose, Snake};

use super::made::{self, Made};
use super::names::Names;
use super::report::{ArrayInReport, LinkageInReport, Report, StopInReport};
use super::start;
use crate::Ending;
use crate::args::snake::LinkageArgs;
use crate::progress::{Progress, catch_interrupts, is_interrupted};
use crate::table::number;

/// The offset of copies, if nothing else is asked for, over the size of the snake.
const APART: f64 = 0.2;

/// Determinants below this are near a singular position.
const NEARLY_SINGULAR: f64 = 1e-6;

/// Copies at most: a slip of the keyboard beyond.
const MOST_COPIES: usize = 10_000;

pub fn run(args: &LinkageArgs, is_quiet: bool) -> Result<Ending> {
    made::check(&args.output.positions)?;
    if !(1..=MOST_COPIES).contains(&args.copies) {
        bail!("--copies: expected 1 to {MOST_COPIES}, found {}", args.copies);
    }
    catch_interrupts();
    let snake = snake(args)?;
    let name = args.arcs.as_ref().map_or("the arcs".to_owned(), |path| path.display().to_string());
    let names = Names::new(&[
        ("options.step_rad", "--step in radians"),
        ("options.max_steps", "--steps"),
        ("phase", "--phase"),
        ("shift", "--shift"),
        ("offset", "--offset"),
    ])
    .with("snake", name.clone())
    .with("linkage", name);
    let linkage = Linkage::new(snake.clone()).map_err(|error| names.of(error))?;
    let freedoms = linkage.freedoms();
    let determinant = linkage.determinant().ok();
    let options = Options { step_rad: args.step.to_radians(), is_reversed: args.reverse, max_steps: args.steps };
    let clock = Instant::now();
    let progress = Progress::new(u32::try_from(args.steps).unwrap_or(u32::MAX), is_quiet);
    let motion = cycle(&linkage, &options, &mut |now| {
        let [first, last] = now.angles_rad.map(|angle| number(angle.to_degrees()));
        progress.say(now.step, &format!("first arc at {first}°, last at {last}°"));
        if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    progress.finish();
    let motion = motion.map_err(|error| names.of(error))?;
    let motion_seconds = clock.elapsed().as_secs_f64();

    let ranges = motion.ranges_rad()?.map(f64::to_degrees);
    let mut warnings = Vec::new();
    if determinant.is_some_and(|determinant| determinant.abs() < NEARLY_SINGULAR) {
        warnings.push("the linkage starts near a singular position: other torsions may move better".to_owned());
    }
    let is_closed = motion.end == End::Closed;
    if motion.frames.len() < 3 {
        warnings.push("the linkage hardly moves: there is no surface to write".to_owned());
    }
    let offset = args.offset.unwrap_or_else(|| APART * snake.size() * across(&snake));
    let shift = args.shift.unwrap_or(1.0 / args.copies as f64);
    let copies = motion.copies(args.copies, args.phase, shift, offset).map_err(|error| names.of(error))?;
    let told = LinkageInReport {
        freedoms,
        determinant,
        positions: motion.frames.len(),
        closing: motion.closing,
        residual: motion.residual,
        ranges_deg: ranges,
        turns: is_closed.then_some(motion.turns),
        drive_switches: motion.switch_count,
        array: ArrayInReport { copies: args.copies, phase: args.phase, shift, offset: offset.to_array() },
    };
    let paths = motion.contact_paths()?;
    let times: Vec<f64> = (0..motion.frames.len()).map(|i| i as f64 / motion.frames.len() as f64).collect();
    let made = Made {
        snake: snake.clone(),
        frames: motion.frames.clone(),
        times,
        comes_back: is_closed && motion.frames.len() >= 3,
        surface: None,
        lines: paths,
        is_linkage: true,
        arrays: if args.copies > 1 { arrays(&motion, args, shift, offset, copies)? } else { Vec::new() },
    };
    let input = args.arcs.clone().unwrap_or_else(|| PathBuf::from("arcs"));
    let report = Report {
        command: "snake linkage",
        input: input.display().to_string(),
        stop: Some(stop_in_words(&motion)),
        linkage: Some(told),
        warnings,
        was_interrupted: motion.end == End::Cancelled,
        seconds: [("motion", motion_seconds)].into_iter().collect(),
        ..Report::default()
    };
    made::write(&made, report, &args.output, (&input, "linkage"), is_quiet)
}

/// The array at so many instants of the motion; the first is the one asked for.
fn arrays(
    motion: &Motion,
    args: &LinkageArgs,
    shift: f64,
    offset: DVec3,
    first: Vec<Vec<DVec3>>,
) -> Result<Vec<Vec<Vec<DVec3>>>> {
    let instants = if args.output.positions.animation { made::MOST_ANIMATED } else { 1 };
    let mut arrays = vec![first];
    for k in 1..instants {
        let phase = args.phase + k as f64 / instants as f64;
        arrays.push(motion.copies(args.copies, phase, shift, offset)?);
    }
    Ok(arrays)
}

/// A direction across the first hinge and the chord of the snake.
fn across(snake: &Snake) -> DVec3 {
    let control = snake.control();
    let hinge = control[1] - control[0];
    let chord = control[control.len() - 1] - control[0];
    hinge.cross(chord).try_normalize().unwrap_or_else(|| hinge.any_orthonormal_vector())
}

fn snake(args: &LinkageArgs) -> Result<Snake> {
    if let Some(path) = &args.arcs {
        return start::read(Path::new(path));
    }
    let (radius, angle) =
        (args.radius.context("--radius: expected a number")?, args.angle.context("--angle: expected a number")?);
    let turn = angle.to_radians();
    if !(turn > 0.0 && turn < PI) {
        bail!("--angle: expected above 0 and below 180, found {angle}");
    }
    let arcs = vec![ArcShape { radius, length: radius * turn }; args.torsions.len() + 1];
    let torsions: Vec<f64> = args.torsions.iter().map(|torsion| torsion.to_radians()).collect();
    let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
    let names = Names::new(&[("torsions", "--torsions"), ("arcs", "--radius")]).with("arcs[0]", "--radius");
    Snake::from_arcs(&arcs, &torsions, &pose).map_err(|error| names.of(error))
}

fn stop_in_words(motion: &Motion) -> StopInReport {
    let (reason, words, advice) = match motion.end {
        End::Closed => ("closed", "it came back to its start".to_owned(), None),
        End::Steps => ("steps", "all steps were taken before it closed".to_owned(), Some("--steps allows more")),
        End::Freedoms(count) => (
            "freedoms",
            format!("at the last position it can move in {count} ways: motions fork there, or end"),
            Some("other torsions avoid such positions"),
        ),
        End::Stalled => ("stalled", "no step, however small, leads on".to_owned(), Some("a smaller --step may")),
        End::Cancelled => ("cancelled", "stopped with Ctrl-C: these are the positions so far".to_owned(), None),
    };
    StopInReport { reason, words, advice: advice.map(str::to_owned), rail: None, distance: None }
}
