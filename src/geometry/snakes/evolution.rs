//! How a snake moves: step by step along admissible velocities, each step projected back (Bartoň et al. 2013, sections 3.1, 3.2,
//! 3.4 and 4.1).
//!
//! Near a surface, control points keep their signed heights of the start: they are off the surface where arcs are on it. How far
//! the arcs are from the surface is measured at contact points and at the middles of arcs.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Snake;
use super::feet::Feet;
use super::functionals::Row;
use super::motion::{Failure, Motion, State};
use super::projection;
use super::rails::{self, OnRail, Rail};
use super::velocity::{Admissible, check_rows};
use crate::error::{Error, Result, Status};
use crate::mesh::ReferenceSurface;

mod run;

use run::Run;

/// Which way control points are to move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// None is given: rails or other wishes say it.
    Free,
    /// To the left of the snake within the surface, seen from the side that its normals point to.
    Sideways,
    /// All in one direction, of any length above 0.
    Along(DVec3),
}

/// What moves, and how.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The snake at the start. It keeps its distances to round-off.
    pub snake: &'a Snake,
    /// The surface that it is to stay near to.
    pub surface: Option<&'a dyn ReferenceSurface>,
    /// Which way it is to go.
    pub direction: Direction,
    /// How fast in that direction, in model units per time: one speed for all control points, or one for each.
    pub speeds: &'a [f64],
    /// Control points that stay.
    pub fixed: &'a [u32],
    /// Curves that guide it.
    pub rails: &'a [Rail<'a>],
    /// Further wishes for velocities; see [`super::functionals`].
    pub wishes: &'a [Row],
}

impl<'a> Task<'a> {
    /// Nothing but the snake.
    pub fn new(snake: &'a Snake) -> Self {
        Self { snake, surface: None, direction: Direction::Free, speeds: &[1.0], fixed: &[], rails: &[], wishes: &[] }
    }
}

impl std::fmt::Debug for Task<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Task").field("snake", &self.snake).field("rails", &self.rails).finish_non_exhaustive()
    }
}

/// What the squares of wishes are multiplied by, 0 or more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Velocities tangential to the surface.
    pub tangential: f64,
    /// Speeds in the direction asked for.
    pub offset: f64,
    /// Torsions that do not change.
    pub rotation: f64,
    /// Velocities at right angles to arcs.
    pub orthogonal: f64,
}

impl Default for Weights {
    /// 1, and 0.001 for speeds. The paper has 0.1, with which a snake of many short arcs rather bends off the surface than that its
    /// speeds differ from those asked for; the projection takes that back, most of the step. Below 0.001 nothing changes.
    fn default() -> Self {
        Self { tangential: 1.0, offset: 1e-3, rotation: 0.0, orthogonal: 0.0 }
    }
}

/// How to evolve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The time of a step, above 0. Steps are halved where they lead too far.
    pub step: f64,
    /// No step is shorter than this part of `step`; above 0, at most 1.
    pub least_step: f64,
    /// Stop after so many steps.
    pub max_steps: usize,
    /// Stop before a contact or the middle of an arc is farther from the surface, in model units; 0 or more, may be infinite.
    pub max_deviation: f64,
    /// The weights of wishes.
    pub weights: Weights,
    /// Whether steps follow accelerations too: several times longer steps leave the same errors before the projection.
    pub is_second_order: bool,
    /// What accelerations along the surface count against those across it; above 0.
    pub alpha: f64,
    /// Whether distances of control points three apart are kept, so that the snake moves rigidly. Where that contradicts rails,
    /// they are kept as well as they can be, and the frames say how well.
    pub keeps_torsions: bool,
    /// Whether to stop when the snake is back where it started.
    pub stops_at_cycle: bool,
    /// How steps are projected; to the nearest position only without a surface. Heights count 0.01 by default: an open snake meets
    /// them all the same, and a closed one, which few surfaces leave any way to go, leaves the surface by little as it goes.
    pub projection: projection::Options,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            step: 0.05,
            least_step: 1e-4,
            max_steps: 100,
            max_deviation: f64::INFINITY,
            weights: Weights::default(),
            is_second_order: false,
            alpha: 0.01,
            keeps_torsions: false,
            stops_at_cycle: true,
            projection: projection::Options { surface_weight: 0.01, ..projection::Options::default() },
        }
    }
}

impl Options {
    fn check(&self) -> Result<()> {
        let weights = &self.weights;
        let above = |name: &str, value: f64| (name.to_owned(), value, value > 0.0 && value.is_finite(), "above 0");
        let least =
            |name: &str, value: f64| (name.to_owned(), value, value >= 0.0 && value.is_finite(), "of 0 or more");
        let checks = [
            above("step", self.step),
            (
                "least_step".into(),
                self.least_step,
                self.least_step > 0.0 && self.least_step <= 1.0,
                "above 0, at most 1",
            ),
            ("max_deviation".into(), self.max_deviation, self.max_deviation >= 0.0, "of 0 or more"),
            above("alpha", self.alpha),
            least("weights.tangential", weights.tangential),
            least("weights.offset", weights.offset),
            least("weights.rotation", weights.rotation),
            least("weights.orthogonal", weights.orthogonal),
        ];
        for (name, value, is_good, expected) in checks {
            if !is_good {
                let reason = format!("expected a number {expected}, found {value}");
                return Err(Error::new(Status::InvalidValue, reason).at(format!("options.{name}")));
            }
        }
        self.projection.check().map_err(|error| {
            let place = error.place().replace("options.", "options.projection.");
            error.with_place(place)
        })
    }
}

/// A position of the snake.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// When.
    pub time: f64,
    /// The snake.
    pub snake: Snake,
    /// Where it is on each rail.
    pub rails: Vec<OnRail>,
    /// The largest distance of a contact point or the middle of an arc from the surface; 0 without one.
    pub deviation: f64,
    /// By how much a distance or a rail is missed at most, in model units.
    pub residual: f64,
    /// By how much the height of a control point differs from that at the start at most.
    pub height_residual: f64,
    /// By how much a distance three apart is off at most, where those are kept.
    pub incongruence: f64,
    /// By how much a distance was off at most where velocities, and accelerations, led to, before the projection. Of a step `h` it
    /// is of the second order, with accelerations of the third.
    pub predicted_residual: f64,
    /// By how much the velocities that led here miss a condition at most, in model units per time.
    pub velocity_residual: f64,
}

impl Frame {
    /// Its numbers, from `time` on.
    pub(crate) fn figures(&self) -> [f64; 7] {
        let Self {
            time,
            deviation,
            residual,
            height_residual,
            incongruence,
            predicted_residual,
            velocity_residual,
            ..
        } = *self;
        [time, deviation, residual, height_residual, incongruence, predicted_residual, velocity_residual]
    }
}

/// Why an evolution stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// All steps were taken.
    Steps,
    /// The next position would be farther from the surface than allowed: by so much in all.
    Deviation(f64),
    /// Velocities, or positions, are not determined.
    Singular,
    /// A rail ended, or the snake left it.
    RailEnd {
        /// Which.
        rail: usize,
        /// How far the snake would be from it; of a following rail, how far its distance from the leader would be off; 0 where a
        /// driven point came to the end.
        distance: f64,
    },
    /// A gliding rail became parallel to the snake.
    Parallel {
        /// Which.
        rail: usize,
    },
    /// The snake is back at its start.
    Cycle,
    /// It does not move any more: no velocity is left, the projection takes every step back, or 25 steps led nowhere.
    Stalled,
    /// The caller asked for it.
    Cancelled,
}

/// What an evolution found.
#[derive(Clone, Debug, PartialEq)]
pub struct Evolution {
    /// The start and the position after each step.
    pub frames: Vec<Frame>,
    /// Why it stopped.
    pub stop: Stop,
}

impl Evolution {
    /// The last position.
    pub fn last(&self) -> &Frame {
        // The start is always there.
        &self.frames[self.frames.len() - 1]
    }

    /// The control points of all positions, as [`swept_grid`](super::sweep::swept_grid) takes them.
    pub fn positions(&self) -> Vec<Vec<DVec3>> {
        self.frames.iter().map(|frame| frame.snake.control().to_vec()).collect()
    }

    /// The times of all positions.
    pub fn times(&self) -> Vec<f64> {
        self.frames.iter().map(|frame| frame.time).collect()
    }
}

/// Where an evolution is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress<'a> {
    /// Steps done.
    pub step: usize,
    /// The last position.
    pub last: &'a Frame,
}

/// Evolves a snake. `progress` is called before every step and can end the run, which then has the frames so far.
///
/// # Errors
/// Options out of range (`options.FIELD`); not one speed for all or for each control point, or one that is not finite (`speeds`,
/// `speeds[i]`); sideways without a surface, or no direction (`direction`); a point that does not exist or is given twice
/// (`fixed[k]`, `rails[k].point`); a rail that does not begin on the snake (`rails[k]`); wishes that are none (`wishes[k]`); a
/// closed snake of fewer than 6 arcs, which is rigid (`snake`); nothing that says how it is to move: weights that are all 0, without
/// wishes and rails (`options.weights`). Status `Degenerate`: a gliding rail along the snake (`rails[k]`).
pub fn evolve(
    task: &Task<'_>,
    options: &Options,
    progress: &mut dyn FnMut(&Progress<'_>) -> ControlFlow<()>,
) -> Result<Evolution> {
    check(task, options)?;
    let on_rails = rails::start(task.snake, task.rails)?;
    let feet = task.surface.map(Feet::new);
    let task = &Task { surface: feet.as_ref().map(|feet| feet as &dyn ReferenceSurface), ..*task };
    let motion = Motion::new(task, options, &on_rails);
    let mut run = Run::new(motion, on_rails);
    let stop = run.run(progress)?;
    Ok(Evolution { frames: run.into_frames(), stop })
}

/// The velocities with which [`evolve`] begins.
///
/// # Errors
/// As [`evolve`]; as [`super::velocity::velocity`].
pub fn velocity(task: &Task<'_>, options: &Options) -> Result<Admissible> {
    check(task, options)?;
    let on_rails = rails::start(task.snake, task.rails)?;
    let motion = Motion::new(task, options, &on_rails);
    match motion.velocity(&State { snake: task.snake.clone(), rails: on_rails }) {
        Ok(rates) => Ok(rates.velocity),
        Err(Failure::Refused(error)) => Err(error),
        Err(Failure::Rail(k, _)) => {
            let reason = "expected a gliding rail that crosses the snake, found one along it";
            Err(Error::new(Status::Degenerate, reason).at(format!("rails[{k}]")))
        }
    }
}

fn check(task: &Task<'_>, options: &Options) -> Result<()> {
    options.check()?;
    let Weights { tangential, offset, rotation, orthogonal } = options.weights;
    let is_wished = [tangential, offset, rotation, orthogonal].iter().any(|weight| *weight > 0.0);
    if !is_wished && task.wishes.is_empty() && task.rails.is_empty() {
        let reason = "expected a weight above 0, found 0 for all, and neither wishes nor rails";
        return Err(Error::new(Status::InvalidValue, reason).at("options.weights"));
    }
    let count = task.snake.control().len();
    if task.snake.is_closed() && count < 6 {
        let reason = format!("expected at least 6 arcs of a closed snake, which is rigid with fewer, found {count}");
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("snake"));
    }
    if task.speeds.len() != 1 && task.speeds.len() != count {
        let reason = format!("expected 1, or {count}, one for each control point, found {}", task.speeds.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("speeds"));
    }
    if let Some(i) = task.speeds.iter().position(|speed| !speed.is_finite()) {
        let reason = format!("expected a finite number, found {}", task.speeds[i]);
        return Err(Error::new(Status::InvalidValue, reason).at(format!("speeds[{i}]")));
    }
    let refused = |reason: &str| Err(Error::new(Status::InvalidValue, reason).at("direction"));
    match task.direction {
        Direction::Sideways if task.surface.is_none() => return refused("expected a surface to go sideways in"),
        Direction::Along(direction) if !(direction.is_finite() && direction.try_normalize().is_some()) => {
            return refused("expected a direction of finite length above 0");
        }
        _ => {}
    }
    let mut is_given = vec![false; count];
    let fixed = task.fixed.iter().enumerate().map(|(k, &i)| (i, format!("fixed[{k}]")));
    let rails = task.rails.iter().enumerate();
    let driven = rails.filter_map(|(k, rail)| rail.point().map(|i| (i, format!("rails[{k}].point"))));
    for (i, place) in fixed.chain(driven) {
        match is_given.get_mut(i as usize) {
            None => {
                let reason = format!("{i} is out of range for {count} control points");
                return Err(Error::new(Status::IndexOutOfRange, reason).at(place));
            }
            Some(given) if *given => {
                let reason = format!("expected a control point that nothing else fixes or drives, found {i}");
                return Err(Error::new(Status::InvalidValue, reason).at(place));
            }
            Some(given) => *given = true,
        }
    }
    check_rows(task.snake, task.wishes, "wishes")
}

#[cfg(test)]
mod tests;
