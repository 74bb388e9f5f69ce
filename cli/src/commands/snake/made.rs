//! A snake that moved, and all files of it.

use std::path::Path;
use std::time::Instant;

use anyhow::{Context as _, Result, bail};
use glam::DVec3;
use shapeop::geometry::snakes::arc_list::ArcList;
use shapeop::geometry::snakes::report::{Reference, ReportOptions, report as covering};
use shapeop::geometry::snakes::sweep::swept_grid;
use shapeop::geometry::snakes::{Snake, file};
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Grid, Mesh};

use super::coverings::{joined, lamellae, pipes, polylines_obj};
use super::figures::KeptInReport;
use super::names::Names;
use super::pictures::{self, View};
use super::report::{Measures, Report};
use crate::Ending;
use crate::args::snake::{PositionArgs, SnakeOutputArgs};
use crate::output::{Output, say};
use crate::progress::{Progress, is_interrupted};

/// Positions in an animation at most.
pub const MOST_ANIMATED: usize = 48;

/// Positions that moved, and what they moved over.
pub struct Made<'a> {
    /// The start.
    pub snake: Snake,
    /// Its control points at each time; the start first.
    pub frames: Vec<Vec<DVec3>>,
    pub times: Vec<f64>,
    /// Whether the last position is followed by the first.
    pub comes_back: bool,
    pub surface: Option<(&'a Mesh, &'a ReferenceMesh<'a>)>,
    /// Rails, or the paths of contacts.
    pub lines: Vec<Vec<DVec3>>,
    /// Whether it is a linkage, whose arcs are drawn as pipes.
    pub is_linkage: bool,
    /// Copies side by side at some instants, the first as it was asked for; empty without copies.
    pub arrays: Vec<Vec<Vec<DVec3>>>,
}

impl Made<'_> {
    fn moved(&self, control: &[DVec3]) -> Result<Snake> {
        Ok(self.snake.moved(control.to_vec())?)
    }
}

/// What can be refused before anything is read.
pub fn check(args: &PositionArgs) -> Result<()> {
    if args.every == 0 {
        bail!("--every: expected at least 1, found 0");
    }
    if !(1..=1_000).contains(&args.per_arc) {
        bail!("--per-arc: expected 1 to 1000, found {}", args.per_arc);
    }
    if !(args.same >= 0.0 && args.same.is_finite()) {
        bail!("--same: expected a finite number of at least 0, found {}", args.same);
    }
    if let Some(within) = args.within.filter(|within| !(*within > 0.0 && within.is_finite())) {
        bail!("--within: expected a finite number above 0, found {within}");
    }
    if let Some(radius) = args.pipes.filter(|radius| !(*radius > 0.0 && radius.is_finite())) {
        bail!("--pipes: expected a finite radius above 0, found {radius}");
    }
    if let Some(depth) = args.lamellae.filter(|depth| !(*depth != 0.0 && depth.is_finite())) {
        bail!("--lamellae: expected a finite depth other than 0, found {depth}");
    }
    Ok(())
}

/// Every so many numbers below `count`, and the last.
pub fn every(count: usize, step: usize) -> Vec<usize> {
    let mut chosen: Vec<usize> = (0..count).step_by(step).collect();
    if count > 0 && chosen.last() != Some(&(count - 1)) {
        chosen.push(count - 1);
    }
    chosen
}

/// Writes everything and tells about it.
pub fn write(
    made: &Made<'_>,
    mut report: Report,
    args: &SnakeOutputArgs,
    (input, command): (&Path, &str),
    is_quiet: bool,
) -> Result<Ending> {
    let clock = Instant::now();
    let positions = &args.positions;
    let progress = Progress::new(1, is_quiet);
    progress.say(0, "files");
    let snakes = made.frames.iter().map(|control| made.moved(control)).collect::<Result<Vec<_>>>()?;
    let chosen = every(snakes.len(), positions.every);
    let chosen_snakes: Vec<Snake> = chosen.iter().map(|&i| snakes[i].clone()).collect();
    let frames: Vec<Vec<DVec3>> = chosen.iter().map(|&i| made.frames[i].clone()).collect();
    let times: Vec<f64> = chosen.iter().map(|&i| made.times[i]).collect();

    // What can be refused comes before the first file.
    let names = Names::new(&[("per_arc", "--per-arc"), ("points", "--per-arc"), ("tolerance", "--same")]);
    let comes_back = made.comes_back && frames.len() >= 3;
    let swept: Option<Grid> = if frames.len() < 2 {
        None
    } else {
        let grid = swept_grid(&made.snake, &frames, positions.per_arc, comes_back);
        Some(grid.map_err(|error| names.of(error))?)
    };
    let list = ArcList::new(&made.snake, &frames, &times, positions.same).map_err(|error| names.of(error))?;
    let pipes = positions.pipes.map(|radius| pipes(&chosen_snakes, radius, positions.per_arc)).transpose()?;
    let standing = made.surface.filter(|_| !positions.flat).map(|(_, reference)| reference);
    let lamellae =
        positions.lamellae.map(|depth| lamellae(&chosen_snakes, depth, positions.per_arc, standing)).transpose()?;
    report.measures = Some(measures(made, &snakes, &frames, comes_back, positions)?);

    let mut output = Output::new(&args.place.out, input, command, args.place.picture)?;
    let format = args.place.format.into();
    if let Some(swept) = &swept {
        output.mesh(&swept.mesh(), format)?;
    } else {
        report.warnings.push("there is one position only, and no surface: nothing moved".to_owned());
    }
    output.text("arcs", ".arcs.json", &list.to_json())?;
    output.text("arc table", ".arcs.csv", &list.to_csv())?;
    output.text("drawing", ".arcs.dxf", &list.to_dxf())?;
    output.text("parts", ".parts.csv", &list.kinds_csv())?;
    output.text("start", ".start.json", &file::to_json(&made.snake))?;
    let last = snakes.last().context("the start is always there")?;
    if snakes.len() > 1 && !made.comes_back {
        output.text("end", ".end.json", &file::to_json(last))?;
    }
    if made.is_linkage {
        output.text("paths", ".paths.obj", &polylines_obj(&made.lines, made.comes_back))?;
    }
    let lines =
        |snakes: &[Snake]| -> Vec<Vec<DVec3>> { snakes.iter().map(|snake| snake.sample(positions.per_arc)).collect() };
    let array =
        made.arrays.first().map(|copies| copies.iter().map(|control| made.moved(control)).collect::<Result<Vec<_>>>());
    let array = array.transpose()?;
    if let Some(array) = &array {
        output.text("copies", ".array.obj", &polylines_obj(&lines(array), false))?;
    }
    if positions.frames {
        for (i, snake) in chosen.iter().zip(&chosen_snakes) {
            let line = lines(std::slice::from_ref(snake));
            output.text_frame(*i, "obj", &polylines_obj(&line, snake.is_closed()))?;
        }
    }
    if let Some(grids) = &pipes {
        output.other_mesh("pipe mesh", ".pipes", &joined(grids), format)?;
    }
    if let Some(grids) = &lamellae {
        output.other_mesh("lamella mesh", ".lamellae", &joined(grids), format)?;
    }
    if output.wants_pictures() || positions.animation {
        let view = View::new(made, &snakes, input)?;
        write_pictures(&view, &report, positions, [pipes.as_deref(), lamellae.as_deref()], &mut output)?;
    }
    progress.finish();
    report.seconds.insert("files", clock.elapsed().as_secs_f64());
    report.was_interrupted |= is_interrupted();
    report.write(&mut output)?;
    if !is_quiet {
        say(&if args.place.json { report.in_json()? } else { report.in_words(&output) })?;
    }
    Ok(if report.was_interrupted { Ending::Interrupted } else { Ending::Done })
}

fn measures(
    made: &Made<'_>,
    snakes: &[Snake],
    frames: &[Vec<DVec3>],
    comes_back: bool,
    args: &PositionArgs,
) -> Result<Measures> {
    let options = ReportOptions { tolerance: args.same, per_arc: args.per_arc, distance: args.within, comes_back };
    let reference = made.surface.map(|(_, reference)| Reference { mesh: reference.mesh(), surface: reference });
    let covering = covering(&made.snake, frames, reference, &options).map_err(|error| {
        Names::new(&[
            ("options.tolerance", "--same"),
            ("options.per_arc", "--per-arc"),
            ("options.distance", "--within"),
        ])
        .of(error)
    })?;
    let diagonal = made.surface.map(|(_, reference)| reference.mesh().diagonal());
    Ok(Measures { covering, kept: KeptInReport::of(&made.snake, snakes), diagonal })
}

fn write_pictures(
    view: &View<'_>,
    report: &Report,
    positions: &PositionArgs,
    [pipes, lamellae]: [Option<&[Grid]>; 2],
    output: &mut Output,
) -> Result<()> {
    if output.wants_pictures() {
        output.picture("picture", &view.main(report)?)?;
        if let Some(svg) = view.deviation(report) {
            output.picture("deviation", &svg)?;
        }
        if let Some(grids) = pipes {
            output.picture("pipes", &view.covering("tubular covering", grids))?;
        }
        if let Some(grids) = lamellae {
            output.picture("lamellae", &view.covering("laminar covering", grids))?;
        }
        if let Some(svg) = view.array()? {
            output.picture("array", &svg)?;
        }
        if positions.strip {
            output.picture("strip", &view.strip()?)?;
        }
    }
    if positions.animation {
        output.bytes("animation", ".gif", &pictures::animation(view)?)?;
    }
    Ok(())
}
