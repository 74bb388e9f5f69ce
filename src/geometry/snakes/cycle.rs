//! The motion of a linkage with one freedom, around until it comes back (Bartoň et al. 2013, section 4.2).
//!
//! Velocities `v` that keep distances are the multiples of one. A step goes along it, the way that the step before went, and so far
//! that the faster one of the two end arcs turns by the angle given: which one that is changes on the way, as end arcs rock back
//! and forth. The angular speed of the first is `|v_2|` over the distance of `p_2` from the line of `p_0` and `p_1`. (The paper
//! compares `|v_2|` and `|v_{N−1}|` themselves, which are angular speeds only up to these distances.) After each step points are
//! moved onto the shape space to round-off, so that no error adds up: positions are a curve, and however many steps are taken, they
//! are on it.
//!
//! The cycle is complete where the curve crosses the hyperplane through the first position `x⁰` across the first velocity `v⁰` from
//! behind, near `x⁰` and after having been away. The crossing is found to round-off, and how far it is from `x⁰` tells whether the
//! motion has closed.

use std::ops::ControlFlow;

use glam::DVec3;

use super::drive::{Run, apart, first_velocity, turned};
use super::{Linkage, Snake};
use crate::error::{Error, Result, Status, finite};
use crate::mesh::grid::check_finite_point;

/// How often the interval around an extreme is cut by a third: to 1e-5 of a step, so that the angle is good to 1e-10 of it.
const THIRDS: usize = 30;

/// How a motion is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// By which angle the driving arc turns in a step, in radians, above 0 and at most 0.2.
    pub step_rad: f64,
    /// Whether the first arc begins by turning clockwise about its hinge, seen against the direction from `p_0` to `p_1`.
    pub is_reversed: bool,
    /// Steps at most; at least 1.
    pub max_steps: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { step_rad: 0.02, is_reversed: false, max_steps: 20_000 }
    }
}

/// Why a motion ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// It came back to the start.
    Closed,
    /// All steps were used.
    Steps,
    /// At the last position it can move in another number of ways than one: where motions fork, or stop.
    Freedoms(usize),
    /// No step, however small, leads on.
    Stalled,
    /// The caller asked for it.
    Cancelled,
}

/// Where a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Steps taken.
    pub step: usize,
    /// By how much the end arcs are turned from the start, in radians.
    pub angles_rad: [f64; 2],
}

/// A motion found.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// What moves.
    pub linkage: Linkage,
    /// The control points at each position, the start first; a closed motion does not repeat it.
    pub frames: Vec<Vec<DVec3>>,
    /// By how much the first and the last arc are turned at each position, in radians, counterclockwise about the directions from
    /// `p_0` to `p_1` and from `p_N` to `p_{N+1}`; whole turns count.
    pub angles_rad: Vec<[f64; 2]>,
    /// How far the end arcs have turned when a closed motion is at its start again: whole turns, 0 of one that rocks.
    pub turns: [i32; 2],
    /// How far the position found in the end is from the first, as the largest distance of two control points; of a closed motion.
    pub closing: Option<f64>,
    /// How often the drive changed ends.
    pub switch_count: usize,
    /// By how much a distance is off at most in any frame.
    pub residual: f64,
    /// Why it ends.
    pub end: End,
}

/// Moves a linkage until it is back where it began. `progress` is called before each step and can end the run.
///
/// # Errors
/// Options out of their ranges (`options.step_rad`, `options.max_steps`). A linkage that cannot move, or in several independent
/// ways as one of more than six arcs (`linkage`, status `InvalidValue`); one of six arcs that is in a singular position (`linkage`,
/// status `Singular`).
pub fn cycle(
    linkage: &Linkage,
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Motion> {
    check(options)?;
    let velocity = first_velocity(linkage, options.is_reversed)?;
    let mut run = Run::new(linkage, velocity);
    let end = run.run(options, progress);
    Ok(run.motion(end))
}

fn check(options: &Options) -> Result<()> {
    if !(options.step_rad > 0.0 && options.step_rad <= 0.2) {
        let reason = format!("expected above 0 and at most 0.2, found {}", options.step_rad);
        return Err(Error::new(Status::InvalidValue, reason).at("options.step_rad"));
    }
    if options.max_steps == 0 {
        return Err(Error::new(Status::InvalidValue, "expected at least 1, found 0").at("options.max_steps"));
    }
    Ok(())
}

impl Motion {
    /// How far apart the extreme positions of the first and the last arc are, in radians: also where they are between two frames.
    ///
    /// # Errors
    /// None but of control points that are not finite, which frames do not have.
    pub fn ranges_rad(&self) -> Result<[f64; 2]> {
        let extreme = |k: usize, sign: f64| {
            let value = |i: usize| sign * self.angles_rad[i][k];
            let best = (0..self.frames.len()).fold(0, |best, i| if value(i) > value(best) { i } else { best });
            let (count, is_closed) = (self.frames.len(), self.end == End::Closed);
            let mut most = value(best);
            // On both sides of the best frame, by thirds: the angle rises and falls once there.
            for other in [(best + count - 1) % count, (best + 1) % count] {
                if !is_closed && other.abs_diff(best) != 1 {
                    continue;
                }
                let angle = |t: f64| value(best) + sign * turned(&self.frames[best], &self.between(best, other, t))[k];
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..THIRDS {
                    let third = (high - low) / 3.0;
                    let [a, b] = [angle(low + third), angle(high - third)];
                    most = most.max(a).max(b);
                    if a < b {
                        low += third;
                    } else {
                        high -= third;
                    }
                }
            }
            sign * most
        };
        Ok([0, 1].map(|k| extreme(k, 1.0) - extreme(k, -1.0)))
    }

    /// A position on the way from one frame to a neighbour.
    fn between(&self, from: usize, to: usize, t: f64) -> Vec<DVec3> {
        let mut control: Vec<DVec3> =
            self.frames[from].iter().zip(&self.frames[to]).map(|(a, b)| a.lerp(*b, t)).collect();
        self.linkage.polish(&mut control, &[]);
        control
    }

    /// The snake at a position.
    ///
    /// # Errors
    /// There is no such frame (`frame`).
    pub fn snake(&self, frame: usize) -> Result<Snake> {
        let Some(control) = self.frames.get(frame) else {
            let reason = format!("{frame} is out of range for {} frames", self.frames.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at("frame"));
        };
        self.linkage.snake().moved(control.clone())
    }

    /// The path of each contact point, one position for each frame.
    ///
    /// # Errors
    /// None but of control points that are not finite, which frames do not have.
    pub fn contact_paths(&self) -> Result<Vec<Vec<DVec3>>> {
        let contacts = (0..self.frames.len()).map(|i| Ok(self.snake(i)?.contacts())).collect::<Result<Vec<_>>>()?;
        Ok((0..contacts[0].len()).map(|j| contacts.iter().map(|contacts| contacts[j]).collect()).collect())
    }

    /// The control points at each phase: 0 is the start, 1 the start again, or the last position of a motion that has not closed.
    /// Phases go with the length of the way in the space of all positions. Of a closed motion those beyond 0 to 1 are taken around
    /// it, of another the nearer end. Between two frames points are interpolated, and moved so that distances hold to round-off.
    ///
    /// # Errors
    /// A phase that is not finite (`phases[i]`).
    pub fn at_phases(&self, phases: &[f64]) -> Result<Vec<Vec<DVec3>>> {
        let count = self.frames.len();
        let is_closed = self.end == End::Closed;
        let mut lengths = vec![0.0];
        for i in 1..count + usize::from(is_closed) {
            lengths.push(lengths[i - 1] + apart(&self.frames[i - 1], &self.frames[i % count]));
        }
        let last = lengths.len() - 1;
        let at = |(k, &phase): (usize, &f64)| {
            finite(&format!("phases[{k}]"), phase)?;
            let phase = if is_closed { phase.rem_euclid(1.0) } else { phase.clamp(0.0, 1.0) };
            let along = phase * lengths[last];
            if last == 0 {
                return Ok(self.frames[0].clone());
            }
            let i = lengths.partition_point(|&length| length <= along).clamp(1, last) - 1;
            let t = ((along - lengths[i]) / (lengths[i + 1] - lengths[i])).clamp(0.0, 1.0);
            Ok(self.between(i, (i + 1) % count, t))
        };
        phases.iter().enumerate().map(at).collect()
    }

    /// An array of copies that move together: copy `k` is at `phase + k · shift`, and moved by `k` times `offset`.
    ///
    /// # Errors
    /// Numbers that are not finite (`phase`, `shift`, `offset`).
    pub fn copies(&self, count: usize, phase: f64, shift: f64, offset: DVec3) -> Result<Vec<Vec<DVec3>>> {
        finite("phase", phase)?;
        finite("shift", shift)?;
        check_finite_point("offset", offset)?;
        let phases: Vec<f64> = (0..count).map(|k| phase + k as f64 * shift).collect();
        let mut copies = self.at_phases(&phases)?;
        for (k, copy) in copies.iter_mut().enumerate() {
            copy.iter_mut().for_each(|point| *point += k as f64 * offset);
        }
        Ok(copies)
    }
}

#[cfg(test)]
mod tests;
