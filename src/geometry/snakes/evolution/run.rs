//! The steps of an evolution, as long as they can be.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

use glam::DVec3;

use super::{Direction, Frame, Progress, Stop};
use crate::error::{Result, Status};
use crate::geometry::snakes::Snake;
use crate::geometry::snakes::motion::{Failure, Motion, Rates, State, Step};
use crate::geometry::snakes::rails::{Halt, OnRail, Rail};

/// A step is halved where the projection takes back more than this part of the way of the fastest point,
const TAKEN_BACK: f64 = 0.1;

/// unless halving it makes that no smaller than this part, as for velocities that do not lead along the surface,
const NO_GAIN: f64 = 0.75;

/// and it is not more than this part: more is no way to go.
const MOST_TAKEN_BACK: f64 = 0.9;

/// Of a way back that is as long for half the step, but for this part of it, the step is not the cause: the projection settles heights
/// that were left. It may be so many times as long as the step.
const OWN_WAY: f64 = 0.9;
const MOST_OWN_WAY: f64 = 2.0;

/// After a step that was not halved the next one may be longer by this factor, up to the step asked for.
const GROWTH: f64 = 1.5;

/// Velocities below this part of the speeds asked for, or of the snake's length per time, are none.
const NO_MOTION: f64 = 1e-12;

/// A snake that got no farther in so many steps than this part of what its velocities, and speeds asked for, led to moves no more.
const IDLE_STEPS: usize = 25;
const LEAST_PROGRESS: f64 = 0.01;

/// A snake has been away from its start where it was farther than so many steps, and is back within so many.
const CYCLE: [f64; 2] = [10.0, 6.0];

/// Where the snake started, how, and whether it has been away.
struct Start {
    control: Vec<DVec3>,
    velocity: Vec<DVec3>,
    is_away: bool,
    /// How far it was along the first velocity.
    along: f64,
}

pub(super) struct Run<'a> {
    motion: Motion<'a>,
    state: State,
    time: f64,
    step: f64,
    /// The part of the last steps that the projection took back however short they were.
    idle: f64,
    frames: Vec<Frame>,
    /// How far velocities, or speeds asked for, led from each of these to the next.
    ways: Vec<f64>,
    cycle: Option<Start>,
}

impl<'a> Run<'a> {
    /// At the start.
    pub fn new(motion: Motion<'a>, on_rails: Vec<OnRail>) -> Self {
        let snake = motion.task.snake;
        let start = Frame {
            time: 0.0,
            rails: on_rails.clone(),
            deviation: motion.deviation(snake),
            residual: snake.residual(),
            height_residual: 0.0,
            incongruence: 0.0,
            predicted_residual: 0.0,
            velocity_residual: 0.0,
            snake: snake.clone(),
        };
        let state = State { snake: snake.clone(), rails: on_rails };
        let step = motion.options.step;
        Self { motion, state, time: 0.0, step, idle: 0.0, frames: vec![start], ways: Vec::new(), cycle: None }
    }

    /// The positions so far.
    pub fn into_frames(self) -> Vec<Frame> {
        self.frames
    }

    /// Steps until something stops it.
    pub fn run(&mut self, progress: &mut dyn FnMut(&Progress<'_>) -> ControlFlow<()>) -> Result<Stop> {
        let options = self.motion.options;
        for step in 0.. {
            let last = &self.frames[self.frames.len() - 1];
            if progress(&Progress { step, last }).is_break() {
                return Ok(Stop::Cancelled);
            }
            if step == options.max_steps {
                return Ok(Stop::Steps);
            }
            let rates = match self.motion.velocity(&self.state) {
                Ok(rates) => rates,
                Err(failure) => return stopped(failure),
            };
            let fastest = rates.velocity.vectors.iter().map(|v| v.length()).fold(0.0, f64::max);
            let asked = self.motion.task.speeds.iter().fold(self.motion.length, |most, speed| most.max(speed.abs()));
            if !(fastest > NO_MOTION * asked) {
                return Ok(Stop::Stalled);
            }
            if let Some(rail) = self.ended(&rates) {
                return Ok(Stop::RailEnd { rail, distance: 0.0 });
            }
            let (next, h) = match self.adapted(&rates, fastest) {
                Ok(found) => found,
                Err(stop) => return stop,
            };
            let deviation = self.motion.deviation(&next.state.snake);
            if deviation > options.max_deviation {
                return Ok(Stop::Deviation(deviation));
            }
            self.time += h;
            self.state = next.state;
            self.frames.push(Frame {
                time: self.time,
                snake: self.state.snake.clone(),
                rails: self.state.rails.clone(),
                deviation,
                residual: next.projected.residual,
                height_residual: next.projected.height_residual,
                incongruence: next.incongruence,
                predicted_residual: next.predicted_residual,
                velocity_residual: rates.velocity.residual,
            });
            self.ways.push(h * fastest.max(self.speed_asked()));
            if self.is_idle() {
                return Ok(Stop::Stalled);
            }
            if options.stops_at_cycle && self.is_back(&rates, h) {
                return Ok(Stop::Cycle);
            }
        }
        Ok(Stop::Steps)
    }

    /// The time that is left on each driven rail that ends.
    fn time_left(&self, rates: &Rates) -> impl Iterator<Item = (usize, f64)> + '_ {
        let rates = rates.rails.clone();
        let rails = self.motion.task.rails.iter().enumerate();
        rails.filter(|(_, rail)| matches!(rail, Rail::Driven { .. }) && !rail.curve().is_closed()).filter_map(
            move |(k, rail)| {
                let [low, high] = rail.curve().range();
                let at = self.state.rails[k].parameter;
                match rates[k] {
                    rate if rate > 0.0 => Some((k, (high - at) / rate)),
                    rate if rate < 0.0 => Some((k, (low - at) / rate)),
                    _ => None,
                }
            },
        )
    }

    /// The driven rail that is at its end.
    fn ended(&self, rates: &Rates) -> Option<usize> {
        let least = 1e-9 * self.motion.options.step;
        self.time_left(rates).find(|(_, left)| *left <= least).map(|(k, _)| k)
    }

    /// The next position and how long it took, with a step that is short enough.
    fn adapted(&mut self, rates: &Rates, fastest: f64) -> std::result::Result<(Step, f64), Result<Stop>> {
        let options = self.motion.options;
        let left = self.time_left(rates).map(|(_, left)| left).fold(f64::INFINITY, f64::min);
        let mut h = self.step.min(left);
        let least = (options.least_step * options.step).min(h);
        let mut before: Option<(Step, f64)> = None;
        let mut failed = None;
        let mut is_halved = false;
        while h >= least {
            match self.motion.step(&self.state, rates, h) {
                Ok(next) if turns(&self.state.snake, &next.state.snake) < FRAC_PI_2 => {
                    let part = next.taken_back / (h * fastest);
                    if part <= TAKEN_BACK.max(NO_GAIN.recip() * self.idle) {
                        // A step cut by the end of a rail says nothing of the next.
                        self.step = if is_halved { h } else { (GROWTH * self.step).min(options.step) };
                        return Ok((next, h));
                    }
                    match before {
                        Some((longer, of_longer)) if part > NO_GAIN * of_longer && of_longer <= MOST_TAKEN_BACK => {
                            (self.idle, self.step) = (of_longer, 2.0 * h);
                            return Ok((longer, 2.0 * h));
                        }
                        Some((longer, of_longer)) if part > 2.0 * OWN_WAY * of_longer && of_longer <= MOST_OWN_WAY => {
                            self.step = 2.0 * h;
                            return Ok((longer, 2.0 * h));
                        }
                        _ => (before, failed) = (Some((next, part)), None),
                    }
                }
                Ok(_) => (before, failed) = (None, None),
                Err(failure) => (before, failed) = (None, Some(failure)),
            }
            h *= 0.5;
            is_halved = true;
        }
        // Where a step of the length asked for misses a rail, that is why ever shorter ones were needed.
        if let Err(failure @ Failure::Rail(..)) = self.motion.step(&self.state, rates, options.step.min(left)) {
            failed = Some(failure);
        }
        Err(failed.map_or(Ok(Stop::Stalled), stopped))
    }

    /// The greatest speed asked for, 0 without a direction.
    fn speed_asked(&self) -> f64 {
        let task = self.motion.task;
        match task.direction {
            Direction::Free => 0.0,
            Direction::Sideways | Direction::Along(_) => {
                task.speeds.iter().fold(0.0, |most, speed| most.max(speed.abs()))
            }
        }
    }

    /// Whether the last steps led nowhere.
    fn is_idle(&self) -> bool {
        let Some(from) = self.ways.len().checked_sub(IDLE_STEPS) else { return false };
        let [before, now] = [from, self.ways.len()].map(|k| self.frames[k].snake.control());
        let farthest = before.iter().zip(now).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        farthest < LEAST_PROGRESS * self.ways[from..].iter().sum::<f64>()
    }

    /// Whether the snake passed its start. Along the first velocity it comes from below.
    fn is_back(&mut self, rates: &Rates, h: f64) -> bool {
        let control = self.state.snake.control();
        let start = self.cycle.get_or_insert_with(|| Start {
            control: self.motion.task.snake.control().to_vec(),
            velocity: rates.velocity.vectors.clone(),
            is_away: false,
            along: 0.0,
        });
        let way = || control.iter().zip(&start.control).map(|(a, b)| *a - *b);
        let distance = way().map(|way| way.length_squared()).sum::<f64>().sqrt();
        let along: f64 = way().zip(&start.velocity).map(|(way, v)| way.dot(*v)).sum();
        let speed = start.velocity.iter().map(|v| v.length_squared()).sum::<f64>().sqrt();
        let was = std::mem::replace(&mut start.along, along);
        start.is_away |= distance > CYCLE[0] * h * speed;
        start.is_away && distance < CYCLE[1] * h * speed && was < 0.0 && along >= 0.0
    }
}

/// By how much a torsion changes at most, in radians.
fn turns(a: &Snake, b: &Snake) -> f64 {
    let change = |(a, b): (f64, f64)| (b - a + PI).rem_euclid(2.0 * PI) - PI;
    a.torsions().into_iter().zip(b.torsions()).map(|pair| change(pair).abs()).fold(0.0, f64::max)
}

fn stopped(failure: Failure) -> Result<Stop> {
    match failure {
        Failure::Rail(rail, Halt::End(distance)) => Ok(Stop::RailEnd { rail, distance }),
        Failure::Rail(rail, Halt::Parallel) => Ok(Stop::Parallel { rail }),
        Failure::Refused(error) => match error.status() {
            Status::Singular | Status::NoSolution | Status::Degenerate => Ok(Stop::Singular),
            _ => Err(error),
        },
    }
}
