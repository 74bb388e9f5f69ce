//! A snake on its way: the evolution with a bar, and what it came to in words.

use std::ops::ControlFlow;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::evolution::{Evolution, Options, Stop, Task, Weights, evolve};

use super::names::Names;
use super::rails::Guide;
use super::report::StopInReport;
use crate::args::snake::{MotionArgs, Point};
use crate::progress::{Progress, is_interrupted};
use crate::table::number;

/// Steps in which a snake goes its own length, if nothing else is asked for.
const STEPS_PER_LENGTH: f64 = 40.0;

/// The speed of each control point: between those at the ends by the length along the control polygon. Of a closed snake all have
/// that at the start.
pub fn speeds(args: &MotionArgs, snake: &Snake) -> Vec<f64> {
    let [start, end] = args.speed.0;
    let control = snake.control();
    let mut along = vec![0.0];
    control.windows(2).for_each(|pair| along.push(along[along.len() - 1] + pair[0].distance(pair[1])));
    let whole = along[along.len() - 1];
    let speed = |along: f64| if snake.is_closed() { start } else { start + along / whole * (end - start) };
    along.into_iter().map(speed).collect()
}

/// The options of an evolution.
pub fn options(
    args: &MotionArgs,
    snake: &Snake,
    weights: Weights,
    keeps_torsions: bool,
    max_deviation: f64,
) -> Options {
    let fastest = args.speed.0.iter().fold(0.0_f64, |most, speed| most.max(speed.abs()));
    let own = snake.length() / STEPS_PER_LENGTH / if fastest > 0.0 { fastest } else { 1.0 };
    Options {
        step: args.step.unwrap_or(own),
        max_steps: args.steps,
        max_deviation,
        weights,
        is_second_order: args.second_order,
        alpha: args.alpha,
        keeps_torsions,
        stops_at_cycle: !args.no_cycle,
        ..Options::default()
    }
}

/// What the library's places are called where a snake evolves.
pub fn names(guides: &[Guide], fixed: &[Point]) -> Names {
    let mut names = Names::new(&[
        ("options.step", "--step"),
        ("options.max_deviation", "--max-deviation"),
        ("options.alpha", "--alpha"),
        ("options.weights.tangential", "--tangential-weight"),
        ("options.weights.offset", "--offset-weight"),
        ("options.weights.rotation", "--rotation-weight"),
        ("options.weights.orthogonal", "--orthogonal-weight"),
        ("options.weights", "--offset-weight and the other weights"),
        ("speeds", "--speed"),
        ("direction", "--along"),
        ("snake", "snake"),
    ]);
    for (k, guide) in guides.iter().enumerate() {
        if let (Some(rail), Some(point)) = (RAILS.get(k), RAIL_POINTS.get(k)) {
            names = names.with(rail, guide.name.clone()).with(point, guide.name.clone());
        }
    }
    for (k, point) in fixed.iter().enumerate().take(FIXED.len()) {
        let word = match point {
            Point::Start => "start".to_owned(),
            Point::End => "end".to_owned(),
            Point::Number(number) => number.to_string(),
        };
        names = names.with(FIXED[k], format!("--fix {word}"));
    }
    names
}

/// Places of the first rails and fixed points: hardly anyone has more.
const RAILS: [&str; 8] =
    ["rails[0]", "rails[1]", "rails[2]", "rails[3]", "rails[4]", "rails[5]", "rails[6]", "rails[7]"];
const RAIL_POINTS: [&str; 8] = [
    "rails[0].point",
    "rails[1].point",
    "rails[2].point",
    "rails[3].point",
    "rails[4].point",
    "rails[5].point",
    "rails[6].point",
    "rails[7].point",
];
const FIXED: [&str; 4] = ["fixed[0]", "fixed[1]", "fixed[2]", "fixed[3]"];

/// Evolves with a bar, which Ctrl-C stops.
pub fn go(task: &Task<'_>, options: &Options, names: &Names, is_quiet: bool) -> Result<Evolution> {
    let progress = Progress::new(u32::try_from(options.max_steps).unwrap_or(u32::MAX), is_quiet);
    let found = evolve(task, options, &mut |now| {
        let deviation =
            if task.surface.is_some() { format!("  deviation {}", number(now.last.deviation)) } else { String::new() };
        progress.say(now.step, &format!("time {}{deviation}", number(now.last.time)));
        if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    progress.finish();
    found.map_err(|error| names.of(error))
}

/// Why an evolution stopped, and what can be done about it.
pub fn stop_in_words(stop: Stop, options: &Options, guides: &[Guide]) -> StopInReport {
    let rail_name = |rail: usize| guides.get(rail).map_or(String::new(), |guide| guide.name.clone());
    let told = |reason, words: String, advice: &str| StopInReport {
        reason,
        words,
        advice: (!advice.is_empty()).then(|| advice.to_owned()),
        rail: None,
        distance: None,
    };
    match stop {
        Stop::Steps => told("steps", "all steps were taken".into(), "--steps allows more"),
        Stop::Deviation(distance) => StopInReport {
            distance: Some(distance),
            ..told(
                "deviation",
                format!(
                    "the next position would be {} from the mesh, more than {}",
                    number(distance),
                    number(options.max_deviation)
                ),
                "--max-deviation allows more; shorter arcs follow the mesh farther",
            )
        },
        Stop::Singular => told(
            "singular",
            "velocities are not determined: the snake is in a singular position".into(),
            "start elsewhere, or ask for another way to go",
        ),
        Stop::RailEnd { rail, distance } => {
            let words = if distance > 0.0 {
                format!(
                    "{}: it ends, or the snake leaves it; they would be {} apart",
                    rail_name(rail),
                    number(distance)
                )
            } else {
                format!("{}: it ends", rail_name(rail))
            };
            StopInReport {
                rail: Some(rail),
                distance: Some(distance),
                ..told("rail end", words, if distance > 0.0 { "a longer rail guides farther" } else { "" })
            }
        }
        Stop::Parallel { rail } => StopInReport {
            rail: Some(rail),
            ..told(
                "parallel",
                format!("{}: it is along the snake, and guides it no more", rail_name(rail)),
                "a rail that crosses the snake guides it",
            )
        },
        Stop::Cycle => told("cycle", "it is back at its start".into(), ""),
        Stop::Stalled => told(
            "stalled",
            "it moves no more: the surface, rails or fixed points hold it".into(),
            "weights or another direction may let it go on; smaller arcs are easier to move",
        ),
        Stop::Cancelled => told("cancelled", "stopped with Ctrl-C: these are the positions so far".into(), ""),
    }
}

/// The positions of an evolution.
pub fn positions(found: &Evolution) -> (Vec<Vec<DVec3>>, Vec<f64>) {
    found.frames.iter().map(|frame| (frame.snake.control().to_vec(), frame.time)).unzip()
}
