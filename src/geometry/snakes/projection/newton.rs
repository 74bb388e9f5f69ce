//! The second phase: Newton's method for residuals, for heights and for the nearest position.

use glam::DVec3;

use super::{MET, Options, Polished, Residuals, height};
use crate::error::{Error, Status};
use crate::geometry::snakes::Distance;
use crate::geometry::snakes::freedoms::directions;
use crate::geometry::snakes::functionals::Row;
use crate::geometry::snakes::velocity::{distance_entries, entries};
use crate::linalg::dense::Svd;
use crate::linalg::saddle::SaddlePoint;

/// Newton steps at most where the derivatives have full rank; 3 or 4 do.
pub(super) const MOST_NEWTON_STEPS: usize = 10;

/// Residuals that no step lowers, relative to the size.
const ROUND_OFF: f64 = 1e-15;

/// Damped steps at most where they have not: residuals then fall by a factor, not with squares.
pub(super) const MOST_DAMPED_STEPS: usize = 200;

/// The first damping of these and the last, relative to the residual.
const FIRST_DAMPING: f64 = 1.0;
const MOST_DAMPING: f64 = 1e12;

/// Steps at most that lower heights and keep distances, and the part of the size below which a step is the last.
const MOST_SETTLING_STEPS: usize = 6;
const LAST_SETTLING_STEP: f64 = 1e-9;

/// Newton's method converges where each step lowers the sum of squares at least by this factor.
const CONVERGING: f64 = 1.0 / 16.0;

/// How often a step of Newton's method is halved where it does not lower the sum of the squared residuals.
const MOST_HALVINGS: usize = 6;

/// A residual above this part of the size is no round-off of a vanishing derivative but a target too far away.
const FAR: f64 = 1e-6;

/// Steps at most of Newton's method on the function with multipliers.
const MOST_EXACT_STEPS: usize = 30;

/// A step of it below this part of the size is the last.
const LAST_EXACT_STEP: f64 = 1e-12;

/// A singular value below this part of the largest is lost rank.
const LOST_RANK: f64 = 1e-7;

impl Residuals<'_> {
    /// The function `½ ‖d‖²` of steps, and conditions that take the residuals to 0 to first order. `None` where points coincide.
    fn linearised(&self, points: &[DVec3], on_surface: bool) -> Option<SaddlePoint> {
        let directions = directions(points, &self.distances).ok()?;
        let mut saddle = SaddlePoint::new(3 * points.len());
        (0..3 * points.len() as u32).for_each(|i| saddle.add_second(i, i, 1.0));
        for (distance, &direction) in self.distances.iter().zip(&directions) {
            let row = self.free(distance_entries(distance, direction));
            saddle.condition(&row, -Self::distance_residual(points, distance));
        }
        for row in self.conditions {
            saddle.condition(&self.free(entries(row)), -row.residual(points));
        }
        if let Some(surface) = self.surface.as_ref().filter(|_| on_surface) {
            for (i, wanted) in surface.heights.iter().enumerate().filter(|(i, _)| !self.is_fixed[*i]) {
                let foot = surface.reference.nearest(points[i]);
                let row = Row { terms: vec![(i as u32, foot.normal)], right: 0.0, weight: 1.0 };
                saddle.condition(&entries(&row), wanted - foot.normal.dot(points[i] - foot.point));
            }
        }
        Some(saddle)
    }

    /// The sum of the squares of all residuals.
    fn squares(&self, points: &[DVec3], on_surface: bool) -> f64 {
        let distances = self.distances.iter().map(|distance| Self::distance_residual(points, distance).powi(2));
        let rows = self.conditions.iter().map(|row| row.residual(points).powi(2));
        let heights = self.surface.iter().filter(|_| on_surface).flat_map(|surface| {
            let off = |(i, wanted): (usize, &f64)| (height(surface.reference, points[i]) - wanted).powi(2);
            surface.heights.iter().enumerate().filter(|(i, _)| !self.is_fixed[*i]).map(off)
        });
        distances.chain(rows).sum::<f64>() + heights.sum::<f64>()
    }

    /// Newton's steps, shortest each, or parts of them, until residuals are at most [`MET`] of the size, and one more, as radii of arcs
    /// that turn by little are less exact than distances; where none lowers the squares of the residuals, damped ones.
    pub(super) fn polish(&self, start: &[DVec3], most: usize) -> Polished {
        let mut at = Polished { points: start.to_vec(), residual: self.residual(start), steps: 0 };
        let mut squares = self.squares(start, false);
        let mut damping: Option<f64> = None;
        let mut is_last = false;
        while at.steps < most {
            if at.residual <= MET * self.size {
                if is_last || at.residual <= ROUND_OFF * self.size {
                    break;
                }
                is_last = true;
            }
            let Some(saddle) = self.linearised(&at.points, false) else { break };
            let found = match damping {
                None => saddle.solve(&self.positions),
                Some(damping) => {
                    let relaxation = damping * squares.sqrt() / self.size;
                    saddle.solve_relaxed(&self.positions, relaxation.max(f64::MIN_POSITIVE))
                }
            };
            let Ok(found) = found else { break };
            at.steps += 1;
            let moved = |part: f64| -> Vec<DVec3> {
                let step = found.x.chunks_exact(3).map(DVec3::from_slice);
                at.points.iter().zip(step).map(|(p, d)| p + part * d).collect()
            };
            let halvings = if damping.is_some() { 0 } else { MOST_HALVINGS };
            let lower = (0..=halvings).map(|k| moved(0.5_f64.powi(k as i32))).find_map(|points| {
                let next = self.squares(&points, false);
                (next < squares).then_some((points, next))
            });
            match lower {
                Some((points, next)) => {
                    let is_slow = next > 0.9 * squares;
                    (at.residual, squares) = (self.residual(&points), next);
                    at.points = points;
                    damping = match damping {
                        None => is_slow.then_some(FIRST_DAMPING),
                        Some(damping) => Some(0.2 * damping),
                    };
                }
                None if is_last || damping.is_some_and(|damping| damping > MOST_DAMPING) => break,
                None => damping = Some(damping.map_or(FIRST_DAMPING, |damping| 10.0 * damping)),
            }
        }
        at
    }

    /// Newton's method for heights and all, likewise, where it converges as it should, without going far.
    pub(super) fn polish_heights(&self, start: &[DVec3], reach: f64) -> Option<Polished> {
        let (mut points, mut squares) = (start.to_vec(), self.squares(start, true));
        let mut is_last = false;
        for steps in 0..=MOST_NEWTON_STEPS {
            let residual = self.largest(&points, true);
            if residual <= MET * self.size {
                if is_last || residual <= ROUND_OFF * self.size {
                    return Some(Polished { points, residual, steps });
                }
                is_last = true;
            }
            let found = self.linearised(&points, true)?.solve(&self.positions).ok()?;
            points.iter_mut().zip(found.x.chunks_exact(3)).for_each(|(p, d)| *p += DVec3::from_slice(d));
            let next = self.squares(&points, true);
            let is_near = points.iter().zip(start).all(|(a, b)| a.distance(*b) <= reach);
            let is_round_off = next.sqrt() <= MET * self.size;
            if !(is_near && (next <= CONVERGING * squares || is_round_off)) {
                return None;
            }
            squares = next;
        }
        None
    }

    /// Steps `d` that keep distances and conditions and lower `w Σ (height − target height)² + µ ‖x − y‖²`, as long as the
    /// distances allow it.
    pub(super) fn settle(&self, mut points: Vec<DVec3>, options: &Options) -> Vec<DVec3> {
        let Some(surface) = self.surface.filter(|_| options.surface_weight > 0.0) else { return points };
        for _ in 0..MOST_SETTLING_STEPS {
            let Some(mut saddle) = self.linearised(&points, false) else { break };
            // The squares of `linearised` have the weight 1 already: of what is added that is the part of µ.
            let scale = 1.0 / options.mu;
            for (i, wanted) in surface.heights.iter().enumerate().filter(|(i, _)| !self.is_fixed[*i]) {
                let pull = self.target[i] - points[i];
                (0..3).for_each(|k| saddle.add_first((3 * i + k) as u32, pull[k]));
                let foot = surface.reference.nearest(points[i]);
                let row = Row { terms: vec![(i as u32, foot.normal)], right: 0.0, weight: 1.0 };
                let right = wanted - foot.normal.dot(points[i] - foot.point);
                saddle.add_square(&entries(&row), right, options.surface_weight * scale);
            }
            let Ok(found) = saddle.solve(&self.positions) else { break };
            let steps = || found.x.chunks_exact(3).map(DVec3::from_slice);
            let next: Vec<DVec3> = points.iter().zip(steps()).map(|(p, d)| p + d).collect();
            // Too long a step leaves the linear range.
            if self.residual(&next) > FAR * self.size && self.residual(&next) > self.residual(&points) {
                break;
            }
            points = next;
            if steps().map(|d| d.length()).fold(0.0, f64::max) <= LAST_SETTLING_STEP * self.size {
                break;
            }
        }
        points
    }

    /// Why the residuals stay.
    pub(super) fn stalled(&self, polished: &Polished) -> Error {
        let full = || {
            let directions = directions(&polished.points, &self.distances).ok()?;
            let mut columns = vec![vec![0.0; self.distances.len()]; 3 * polished.points.len()];
            for (k, (distance, &direction)) in self.distances.iter().zip(&directions).enumerate() {
                for (i, value) in self.free(distance_entries(distance, direction)) {
                    columns[i as usize][k] += value;
                }
            }
            Some(Svd::new(self.distances.len(), &columns)?.rank(LOST_RANK) == self.distances.len())
        };
        let (residual, size) = (polished.residual, self.size);
        let is_far = residual > FAR * size && full().unwrap_or(false);
        let (status, why) = if is_far {
            (Status::NoSolution, "the target is too far away, or conditions contradict the distances")
        } else {
            (Status::Singular, "the distances' derivatives depend on each other there")
        };
        let reason = format!("distances stay off by {residual} of a length of {size}: {why}");
        Error::new(status, reason).at("target")
    }

    /// Newton's method for the nearest point: with `u` the unit vector along a distance of length `r`, its second derivative is
    /// `(I − u uᵀ) / r` in the difference of its points.
    pub(super) fn nearest(&self, mut points: Vec<DVec3>) -> (Vec<DVec3>, bool) {
        let mut multipliers: Option<Vec<f64>> = None;
        for _ in 0..MOST_EXACT_STEPS {
            let Some(mut saddle) = self.linearised(&points, false) else { break };
            for (i, (p, y)) in points.iter().zip(self.target).enumerate() {
                let pull = if self.is_fixed[i] { DVec3::ZERO } else { *y - *p };
                (0..3).for_each(|k| saddle.add_first((3 * i + k) as u32, pull[k]));
            }
            if let Some(multipliers) = &multipliers {
                for (distance, &lambda) in self.distances.iter().zip(multipliers) {
                    self.add_curvature(&mut saddle, &points, distance, lambda);
                }
            }
            let Ok(found) = saddle.solve(&self.positions) else { break };
            // The first solution is for the multipliers only.
            if multipliers.is_some() {
                let step: Vec<DVec3> = found.x.chunks_exact(3).map(DVec3::from_slice).collect();
                points.iter_mut().zip(&step).for_each(|(p, d)| *p += *d);
                let longest = step.iter().map(|d| d.length()).fold(0.0, f64::max);
                if longest <= LAST_EXACT_STEP * self.size {
                    return (points, true);
                }
            }
            multipliers = Some(found.multipliers);
        }
        (points, false)
    }

    fn add_curvature(&self, saddle: &mut SaddlePoint, points: &[DVec3], distance: &Distance, lambda: f64) {
        let [i, j] = distance.points;
        let apart = points[i as usize] - points[j as usize];
        let length = apart.length();
        let unit = apart / length;
        for k in 0..3 {
            for l in 0..3 {
                let delta = if k == l { 1.0 } else { 0.0 };
                let value = lambda / length * (delta - unit[k] * unit[l]);
                for (a, b, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0)] {
                    let is_free = !self.is_fixed[a as usize] && !self.is_fixed[b as usize];
                    let (row, column) = (3 * a + k as u32, 3 * b + l as u32);
                    // Of the diagonal blocks one triangle, as the other comes with it.
                    if is_free && (a != b || row <= column) {
                        saddle.add_second(row, column, sign * value);
                    }
                }
            }
        }
    }
}
