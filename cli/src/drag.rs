//! A drag: handles move frame by frame, the solver follows, and what is reached is looked at in between.

use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::{Context, Result};
use glam::DVec3;
use serde::Serialize;
use shapeop::problem::Problem;
use shapeop::solver::{Outcome, Progress, SolveOptions, Solver};

use crate::exploration::Exploration;
use crate::moves::Moves;
use crate::progress::{self, is_interrupted};

/// Shapes along the way that are kept for the plot at most, and numbers in them at most: 64 MB.
const MOST_INSTANTS: usize = 600;
const MOST_NUMBERS: usize = 8_000_000;

/// Solves at most to settle at the end.
const SETTLING: u32 = 3;

/// How a frame ended.
#[derive(Clone, Serialize)]
pub struct Solved {
    /// Seconds since the drag began, solving alone, and of them those of this frame.
    pub at_seconds: f64,
    pub seconds: f64,
    pub outcome: &'static str,
    pub handles: usize,
    #[serde(flatten)]
    pub found: Exploration,
    /// The file of its mesh.
    pub mesh: String,
}

/// A drag that was replayed.
pub struct Drag {
    pub solver: Solver,
    pub frames: Vec<Solved>,
    /// The end, solved without a limit of time; `None` if Ctrl-C came before.
    pub settled: Option<Solved>,
    /// Why the last solve ended.
    pub outcome: Outcome,
    pub track: Track,
}

/// How long each frame may take, and when a solve gives up.
pub struct Limits {
    /// Seconds for each frame; 0: as long as it takes.
    pub budget_seconds: f64,
    pub max_iterations: u32,
    pub tolerance: f64,
}

/// What a frame is shown with.
pub struct Seen<'a> {
    /// `None`: the shape that it settled to.
    pub frame: Option<usize>,
    pub solver: &'a Solver,
}

/// Replays `moves`. `look` sees each frame when it is solved, and the end, and returns the file that it wrote.
pub fn replay(
    problem: &Problem,
    moves: &Moves,
    limits: &Limits,
    threads: usize,
    is_quiet: bool,
    look: &mut dyn FnMut(&Seen<'_>) -> Result<String>,
) -> Result<Drag> {
    let mut solver = Solver::from_problem(problem)?;
    solver.set_thread_count(threads);
    let count = moves.frames.len();
    let bar = progress::Progress::new(count as u32 + 1, is_quiet);
    let mut clock = Clock::default();
    let mut track = Track::new(solver.points());
    let (mut frames, mut settled, mut outcome): (Vec<Solved>, _, _) = (Vec::new(), None, Outcome::Cancelled);
    for step in 0..=count {
        let frame = moves.frames.get(step);
        if let Some(frame) = frame {
            frame.releases.iter().try_for_each(|point| solver.release_handle(*point))?;
            frame.handles.iter().try_for_each(|handle| solver.set_handle(handle.point, handle.target.into()))?;
            track.begin_frame(clock.seconds);
        }
        let before = clock.seconds;
        let is_solution = |solver: &Solver| solver.found().is_some_and(|found| found.is_solution);
        let changes = frame.is_some_and(|frame| !frame.handles.is_empty() || !frame.releases.is_empty());
        for attempt in 0..if frame.is_some() { 1 } else { SETTLING } {
            // Where nothing changes, a contradiction stays one. Sweeps alone may come to rest a digit short of a solution: from there
            // the next solve finds it.
            let is_contradiction = !changes && outcome == Outcome::Infeasible;
            let is_settled = frame.is_none() && is_solution(&solver);
            if is_contradiction || is_settled || attempt > 0 && outcome != Outcome::Converged {
                break;
            }
            let options = SolveOptions {
                max_iterations: limits.max_iterations,
                tolerance: limits.tolerance,
                time_budget_seconds: if frame.is_some() { limits.budget_seconds } else { 0.0 },
            };
            clock.start();
            let report = solver.solve_until(&options, &mut |now: &Progress<'_>| {
                clock.stop();
                track.see(clock.seconds, now.solver.points());
                bar.show(step as u32 + 1, "residual", now.energy, now.largest_move);
                clock.start();
                if is_interrupted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })?;
            clock.stop();
            outcome = report.outcome;
            track.see_last(clock.seconds, solver.points());
        }
        let mesh = look(&Seen { frame: frame.map(|_| step), solver: &solver })?;
        let solved = Solved {
            at_seconds: clock.seconds,
            seconds: clock.seconds - before,
            outcome: outcome.text(),
            handles: solver.handles().count(),
            found: Exploration::of(&solver)
                .context("there is nothing to explore: no hard constraint, objective or handle")?,
            mesh,
        };
        match frame {
            Some(_) => frames.push(solved),
            None => settled = Some(solved),
        }
        if outcome == Outcome::Cancelled {
            settled = None;
            break;
        }
    }
    bar.finish();
    Ok(Drag { solver, frames, settled, outcome, track })
}

/// Counts the seconds of solving alone.
#[derive(Default)]
struct Clock {
    seconds: f64,
    since: Option<Instant>,
}

impl Clock {
    fn start(&mut self) {
        self.since = Some(Instant::now());
    }

    fn stop(&mut self) {
        self.seconds += self.since.take().map_or(0.0, |since| since.elapsed().as_secs_f64());
    }
}

/// Shapes along the way, evenly thinned where there are many.
pub struct Track {
    start: Vec<DVec3>,
    instants: Vec<(f64, Vec<DVec3>)>,
    /// When frames began, in seconds.
    pub begins: Vec<f64>,
    most: usize,
    stride: usize,
    seen: usize,
}

impl Track {
    fn new(start: &[DVec3]) -> Self {
        let most = (MOST_NUMBERS / (3 * start.len()).max(1)).clamp(2, MOST_INSTANTS);
        Self { start: start.to_vec(), instants: Vec::new(), begins: Vec::new(), most, stride: 1, seen: 0 }
    }

    fn begin_frame(&mut self, seconds: f64) {
        self.begins.push(seconds);
    }

    fn see(&mut self, seconds: f64, points: &[DVec3]) {
        if self.seen.is_multiple_of(self.stride) {
            self.instants.push((seconds, points.to_vec()));
            if self.instants.len() > self.most {
                let mut i = 0;
                self.instants.retain(|_| {
                    i += 1;
                    i % 2 == 1
                });
                self.stride *= 2;
            }
        }
        self.seen += 1;
    }

    /// The end of a frame, which is kept unless it was seen already.
    fn see_last(&mut self, seconds: f64, points: &[DVec3]) {
        if self.instants.last().is_none_or(|(_, last)| last != points) {
            self.seen = 0;
            self.see(seconds, points);
        }
    }

    /// Seconds, and the distance from `end` over that at the start; empty if nothing moved.
    pub fn distances(&self, end: &[DVec3]) -> Vec<(f64, f64)> {
        let distance = |points: &[DVec3]| {
            points.iter().zip(end).map(|(point, end)| point.distance_squared(*end)).sum::<f64>().sqrt()
        };
        let whole = distance(&self.start);
        if whole == 0.0 || !whole.is_finite() {
            return Vec::new();
        }
        let later = self.instants.iter().map(|(seconds, points)| (*seconds, distance(points) / whole));
        std::iter::once((0.0, 1.0)).chain(later).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_track_is_thinned_evenly_and_measured_from_its_end() {
        let at = |x: f64| vec![DVec3::new(x, 0.0, 0.0)];
        let mut track = Track::new(&at(0.0));
        (1..=1000).for_each(|i| track.see(f64::from(i), &at(f64::from(i) / 1000.0)));
        assert!(track.instants.len() <= MOST_INSTANTS && track.instants.len() > MOST_INSTANTS / 2 - 2);
        let distances = track.distances(&at(1.0));
        assert_eq!(distances[0], (0.0, 1.0));
        for (seconds, distance) in &distances {
            assert!((distance - (1.0 - seconds / 1000.0)).abs() < 1e-12);
        }
        assert!(track.distances(&at(0.0)).is_empty());
    }
}
