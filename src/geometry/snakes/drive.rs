//! Following the motion of a linkage with one freedom, as [`motion`](super::motion) tells.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Linkage;
use super::cycle::{End, Motion, Options, Progress};
use super::functionals::Row;
use crate::error::{Error, Result, Status};

/// The drive changes to the other end where that is faster by this part.
const HYSTERESIS: f64 = 0.05;

/// Near the start is within so many of the longest steps, and away from it beyond so many.
const NEAR: f64 = 6.0;
const AWAY: f64 = 10.0;

/// A crossing closes the motion if it is as near to the start as this, as a multiple of the snake's size.
const CLOSED: f64 = 1e-6;

/// Distances may be off by this after a step, as a multiple of the size.
const OFF: f64 = 1e-11;

/// A step is halved where meeting distances takes back more than this part of it, or where an end arc turns by more than this
/// multiple of the angle given: the way turns sharply there. At most so often.
const TAKEN_BACK: f64 = 0.3;
const MOST_TURNED: f64 = 1.5;
const HALVINGS: usize = 12;

/// The velocity at the start, if there is one way to move only.
pub(super) fn first_velocity(linkage: &Linkage, is_reversed: bool) -> Result<Vec<DVec3>> {
    let control = linkage.snake().control();
    let mut velocities = linkage.velocities(control);
    let found = velocities.len();
    let arcs = linkage.snake().shapes().len();
    let velocity = match velocities.pop() {
        Some(velocity) if found == 1 => velocity,
        _ => {
            let reason = format!("expected a linkage with one freedom, found {found}");
            let is_singular = arcs == 6 && found > 1;
            let status = if is_singular { Status::Singular } else { Status::InvalidValue };
            let reason = if is_singular { format!("{reason}: its position is singular") } else { reason };
            return Err(Error::new(status, reason).at("linkage"));
        }
    };
    let [first, last] = speeds(control, &velocity);
    let is_backward = (if first != 0.0 { first } else { last } < 0.0) != is_reversed;
    Ok(if is_backward { velocity.into_iter().map(|v| -v).collect() } else { velocity })
}

/// The hinge of an end arc: a point, a unit direction, and the first point that it turns.
fn hinges(control: &[DVec3]) -> [(DVec3, DVec3, usize); 2] {
    let last = control.len() - 1;
    let axis = |from: usize, to: usize| (control[to] - control[from]).normalize_or_zero();
    [(control[0], axis(0, 1), 2), (control[last], axis(last - 1, last), last - 2)]
}

/// The angular speeds of the end arcs.
fn speeds(control: &[DVec3], velocity: &[DVec3]) -> [f64; 2] {
    hinges(control).map(|(point, axis, turned)| {
        let arm = (control[turned] - point).reject_from_normalized(axis);
        axis.dot(arm.cross(velocity[turned])) / arm.length_squared()
    })
}

/// By how much the end arcs turn from one position to another that is not far.
pub(super) fn turned(before: &[DVec3], after: &[DVec3]) -> [f64; 2] {
    hinges(before).map(|(point, axis, turned)| {
        let [from, to] = [before, after].map(|control| (control[turned] - point).reject_from_normalized(axis));
        axis.dot(from.cross(to)).atan2(from.dot(to))
    })
}

pub(super) fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}

/// The distance in the space of all positions.
pub(super) fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt()
}

/// A motion being followed.
pub(super) struct Run<'a> {
    linkage: &'a Linkage,
    size: f64,
    frames: Vec<Vec<DVec3>>,
    angles: Vec<[f64; 2]>,
    first_velocity: Vec<DVec3>,
    velocity: Vec<DVec3>,
    drive: usize,
    switch_count: usize,
    longest: f64,
    was_away: bool,
    residual: f64,
    closing: Option<f64>,
}

impl<'a> Run<'a> {
    pub fn new(linkage: &'a Linkage, velocity: Vec<DVec3>) -> Self {
        let start = linkage.snake().control().to_vec();
        let [first, last] = speeds(&start, &velocity);
        Self {
            linkage,
            size: linkage.snake().size(),
            frames: vec![start],
            angles: vec![[0.0; 2]],
            first_velocity: velocity.clone(),
            velocity,
            drive: usize::from(last.abs() > first.abs()),
            switch_count: 0,
            longest: 0.0,
            was_away: false,
            residual: linkage.snake().residual(),
            closing: None,
        }
    }

    fn at(&self) -> &[DVec3] {
        &self.frames[self.frames.len() - 1]
    }

    pub fn run(&mut self, options: &Options, progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>) -> End {
        for step in 0..options.max_steps {
            if progress(&Progress { step, angles_rad: self.angles[step] }).is_break() {
                return End::Cancelled;
            }
            if step > 0 {
                let mut velocities = self.linkage.velocities(self.at());
                let Some(velocity) = velocities.pop().filter(|_| velocities.is_empty()) else {
                    return End::Freedoms(self.linkage.velocities(self.at()).len());
                };
                let sign = dot(&velocity, &self.velocity).signum();
                self.velocity = velocity.into_iter().map(|v| sign * v).collect();
            }
            let Some(next) = self.step(options.step_rad) else { return End::Stalled };
            if self.is_back(&next) {
                return End::Closed;
            }
            let turned = turned(self.at(), &next);
            self.angles.push([0, 1].map(|k| self.angles[step][k] + turned[k]));
            self.frames.push(next);
        }
        End::Steps
    }

    /// The next position; none if no step leads on.
    fn step(&mut self, step_rad: f64) -> Option<Vec<DVec3>> {
        let speeds = speeds(self.at(), &self.velocity).map(f64::abs);
        if speeds[1 - self.drive] > (1.0 + HYSTERESIS) * speeds[self.drive] {
            self.drive = 1 - self.drive;
            self.switch_count += 1;
        }
        // Where both end arcs stand still, others do not: none goes by more than its angle times the size.
        let fastest = self.velocity.iter().map(|v| v.length()).fold(0.0, f64::max);
        let mut time = step_rad / speeds[self.drive].max(fastest / self.size);
        for _ in 0..HALVINGS {
            let along: Vec<DVec3> = self.at().iter().zip(&self.velocity).map(|(p, v)| *p + time * *v).collect();
            let mut next = along.clone();
            let residual = self.linkage.polish(&mut next, &[]);
            let length = apart(&along, self.at());
            let turned = turned(self.at(), &next).iter().fold(0.0_f64, |most, angle| most.max(angle.abs()));
            let is_short = apart(&along, &next) <= TAKEN_BACK * length && turned <= MOST_TURNED * step_rad;
            if residual <= OFF * self.size && is_short {
                self.residual = self.residual.max(residual);
                self.longest = self.longest.max(apart(self.at(), &next));
                return Some(next);
            }
            time *= 0.5;
        }
        None
    }

    /// Whether the step to `next` leads over the start.
    fn is_back(&mut self, next: &[DVec3]) -> bool {
        let start = &self.frames[0];
        self.was_away |= apart(start, next) > AWAY * self.longest;
        let ahead = |x: &[DVec3]| dot(x, &self.first_velocity) - dot(start, &self.first_velocity);
        let (before, after) = (ahead(self.at()), ahead(next));
        if !(self.was_away && before < 0.0 && after >= 0.0 && apart(start, next) < NEAR * self.longest) {
            return false;
        }
        let t = before / (before - after);
        let mut crossing: Vec<DVec3> = self.at().iter().zip(next).map(|(a, b)| a.lerp(*b, t)).collect();
        let terms = (0..).zip(self.first_velocity.iter().copied()).collect();
        let level = Row { terms, right: dot(start, &self.first_velocity), weight: 1.0 };
        let residual = self.linkage.polish(&mut crossing, &[level]);
        let gap = crossing.iter().zip(start).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let is_back = residual <= OFF * self.size && gap <= CLOSED * self.size;
        self.closing = is_back.then_some(gap);
        is_back
    }

    pub fn motion(self, end: End) -> Motion {
        let last = self.frames.len() - 1;
        let turns = if end == End::Closed {
            let rest = turned(&self.frames[last], &self.frames[0]);
            [0, 1].map(|k| ((self.angles[last][k] + rest[k]) / std::f64::consts::TAU).round() as i32)
        } else {
            [0; 2]
        };
        Motion {
            linkage: self.linkage.clone(),
            frames: self.frames,
            angles_rad: self.angles,
            turns,
            closing: self.closing,
            switch_count: self.switch_count,
            residual: self.residual,
            end,
        }
    }
}
