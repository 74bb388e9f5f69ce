//! The nearest position that a snake can have.
//!
//! *First* (Bartoň et al. 2013, section 3.2) the damped Gauss–Newton method lowers `Σ (|p_i − p_j| − d_ij)² + µ ‖x − y‖²`, with
//! lengths in units of the snake's size; near a surface, squares of `height − target height` are added. What it finds keeps
//! distances to some 1e-4 only. *Then* Newton's method with the shortest steps, where `d` is the shortest vector with `J d =
//! −residual`, takes the residuals to round-off, without going far. On request the result is the nearest position, not only near
//! it: Newton's method on the function `½ ‖x − y‖² + Σ λ c` and its multipliers, with the second derivatives of the distances,
//! without which it does not converge for targets that are not very near.
//!
//! Points that are given (fixed, or on a rail) are substituted throughout and do not move. Near a surface, steps that keep
//! distances lower the squares of heights and of the way in between (else what the first phase leaves of distances would be paid
//! for in heights), and then heights count as residuals of the second phase too: an open snake has three freedoms more than it
//! then has conditions. Where they contradict the distances, as those of closed snakes do in general, or where a long way would be
//! needed for a small gain, as with many short arcs, they are left as they were.

use glam::DVec3;

use super::Snake;
use super::functionals::Row;
use super::snake::Distance;
use super::velocity::{check_rows, positions};
use crate::error::{Error, Result, Status};
use crate::mesh::ReferenceSurface;
use crate::mesh::grid::check_finite;

mod newton;
mod soft;

use newton::{MOST_DAMPED_STEPS, MOST_NEWTON_STEPS};

/// Residuals that are left, relative to the snake's size, of what is met: some hundred units in the last place.
pub(super) const MET: f64 = 1e-13;

/// How to project.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// `µ`, what the squared way counts against squared errors of distances; above 0. Higher values than the default leave errors
    /// that Newton's method has to take elsewhere.
    pub mu: f64,
    /// What squared errors of heights count against squared errors of distances, 0 or more. Above 0 heights are met to round-off
    /// where that is possible, whatever it is.
    pub surface_weight: f64,
    /// Whether the nearest position is found rather than one that is near. Not with a surface.
    pub is_exact: bool,
    /// Iterations of the first phase at most.
    pub max_iterations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { mu: 0.005, surface_weight: 1.0, is_exact: false, max_iterations: 60 }
    }
}

impl Options {
    pub(super) fn check(&self) -> Result<()> {
        let at = |place: &str, found: f64, expected: &str| {
            Err(Error::new(Status::InvalidValue, format!("expected a number {expected}, found {found}")).at(place))
        };
        match self {
            Self { mu, .. } if !(*mu > 0.0 && mu.is_finite()) => at("options.mu", *mu, "above 0"),
            Self { surface_weight: w, .. } if !(*w >= 0.0 && w.is_finite()) => {
                at("options.surface_weight", *w, "of 0 or more")
            }
            _ => Ok(()),
        }
    }
}

/// What a snake is to be near to besides the target.
#[derive(Clone, Copy)]
pub struct Surface<'a> {
    /// The surface.
    pub reference: &'a dyn ReferenceSurface,
    /// The signed distance of each control point along the normal.
    pub heights: &'a [f64],
    /// Heights are taken to round-off where that moves no point farther than this, in model units; above 0, may be infinite.
    pub reach: f64,
}

impl std::fmt::Debug for Surface<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Surface").field("heights", &self.heights).finish_non_exhaustive()
    }
}

/// The signed height of a point over the surface.
pub fn height(reference: &dyn ReferenceSurface, point: DVec3) -> f64 {
    let foot = reference.nearest(point);
    foot.normal.dot(point - foot.point)
}

/// What is projected.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The snake whose distances are to be kept; where its control points are does not count.
    pub snake: &'a Snake,
    /// Further distances to keep.
    pub distances: &'a [Distance],
    /// Where control points are to be near, one for each.
    pub target: &'a [DVec3],
    /// Control points that stay at their targets.
    pub fixed: &'a [u32],
    /// Conditions on positions: the sums are to be the right-hand sides; weights do not count.
    pub conditions: &'a [Row],
    /// Heights over a surface.
    pub surface: Option<Surface<'a>>,
}

impl<'a> Task<'a> {
    /// Only distances, and all control points free.
    pub fn new(snake: &'a Snake, target: &'a [DVec3]) -> Self {
        Self { snake, distances: &[], target, fixed: &[], conditions: &[], surface: None }
    }
}

/// A position found.
#[derive(Clone, Debug, PartialEq)]
pub struct Projected {
    /// The snake there.
    pub snake: Snake,
    /// By how much a distance or a condition is off at most, in model units.
    pub residual: f64,
    /// By how much a height is; 0 without a surface.
    pub height_residual: f64,
    /// By how much a control point is from its target at most.
    pub moved: f64,
    /// Iterations of the first phase.
    pub iterations: usize,
    /// Steps of the second.
    pub steps: usize,
    /// Whether the step lengths of Newton's method on the multipliers came to rest; true where it was not asked for.
    pub is_nearest: bool,
}

/// Projects a target.
///
/// # Errors
/// Options out of range (`options.FIELD`); a target or heights that are not one for each control point, or not finite (`target`,
/// `target[i]`, `surface.heights`, `surface.reach`); a fixed point, distance or condition of a control point that does not exist
/// (`fixed[k]`, `distances[k]`, `conditions[k]`). Status `Singular`: the derivatives lose rank and no step lowers the residuals.
/// Status `NoSolution`: they stay, as the target is too far away or conditions contradict the distances (`target`).
pub fn project(task: &Task<'_>, options: &Options) -> Result<Projected> {
    options.check()?;
    let residuals = Residuals::new(task, options)?;
    let (mut points, mut iterations, mut steps) = (task.target.to_vec(), 0, 0);
    let surface = task.surface.filter(|_| options.surface_weight > 0.0);
    // Along a smooth surface Newton's method does it all, for what is near enough.
    let at_heights = |from: &[DVec3]| surface.and_then(|surface| residuals.polish_heights(from, surface.reach));
    if let Some(polished) = at_heights(task.target) {
        (points, steps) = (polished.points, polished.steps);
    } else {
        (points, iterations) = soft::minimise(&residuals, &points, options)?;
        points = residuals.settle(points, options);
        if let Some(polished) = at_heights(&points) {
            (points, steps) = (polished.points, polished.steps);
        }
    }
    let most = MOST_NEWTON_STEPS + MOST_DAMPED_STEPS;
    let mut polished = residuals.polish(&points, most);
    steps += polished.steps;
    if !(polished.residual <= MET * residuals.size) {
        return Err(residuals.stalled(&polished));
    }
    let mut is_nearest = true;
    if options.is_exact {
        (points, is_nearest) = residuals.nearest(polished.points);
        polished = residuals.polish(&points, most);
        if !(polished.residual <= MET * residuals.size) {
            return Err(residuals.stalled(&polished));
        }
    }
    let moved = polished.points.iter().zip(task.target).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    Ok(Projected {
        height_residual: residuals.height_residual(&polished.points),
        residual: polished.residual,
        snake: task.snake.moved(polished.points)?,
        moved,
        iterations,
        steps,
        is_nearest,
    })
}

/// Moves the control points that are not fixed, by little, so that distances, of neighbours among them, and conditions hold. Returns
/// by how much they are off at most in the end, which is round-off unless they cannot be met from where the points were.
pub(super) fn meet(
    control: &mut Vec<DVec3>,
    is_closed: bool,
    distances: &[Distance],
    is_fixed: &dyn Fn(usize) -> bool,
    conditions: &[Row],
) -> f64 {
    let count = control.len();
    let residuals = Residuals {
        target: control,
        conditions,
        surface: None,
        distances: distances.to_vec(),
        is_fixed: (0..count).map(is_fixed).collect(),
        positions: positions(count, is_closed),
        size: around(distances, count),
    };
    let polished = residuals.polish(control, MOST_NEWTON_STEPS + MOST_DAMPED_STEPS);
    *control = polished.points;
    polished.residual
}

/// The length of a control polygon, of the distances that are edges.
fn around(distances: &[Distance], count: usize) -> f64 {
    let edges = distances.iter().filter(|distance| {
        let [i, j] = distance.points.map(|i| i as usize);
        (i + 1) % count == j
    });
    edges.map(|distance| distance.length).sum()
}

/// What is to be met.
struct Residuals<'a> {
    target: &'a [DVec3],
    conditions: &'a [Row],
    surface: Option<Surface<'a>>,
    distances: Vec<Distance>,
    is_fixed: Vec<bool>,
    positions: Vec<u32>,
    /// The length of the control polygon: the unit.
    size: f64,
}

struct Polished {
    points: Vec<DVec3>,
    residual: f64,
    steps: usize,
}

impl<'a> Residuals<'a> {
    fn new(task: &'a Task<'a>, options: &Options) -> Result<Self> {
        let count = task.snake.control().len();
        let expected = |found: usize, place: &str| {
            let reason = format!("expected {count}, one for each control point, found {found}");
            Error::new(Status::InvalidArgumentLength, reason).at(place)
        };
        if task.target.len() != count {
            return Err(expected(task.target.len(), "target"));
        }
        check_finite("target", task.target)?;
        let out = |i: u32, place: String| {
            let reason = format!("{i} is out of range for {count} control points");
            Error::new(Status::IndexOutOfRange, reason).at(place)
        };
        let mut is_fixed = vec![false; count];
        for (k, &i) in task.fixed.iter().enumerate() {
            *is_fixed.get_mut(i as usize).ok_or_else(|| out(i, format!("fixed[{k}]")))? = true;
        }
        for (k, distance) in task.distances.iter().enumerate() {
            if let Some(&i) = distance.points.iter().find(|i| **i as usize >= count) {
                return Err(out(i, format!("distances[{k}]")));
            }
            if !(distance.length >= 0.0 && distance.length.is_finite()) {
                let reason = format!("expected a length of 0 or more, found {}", distance.length);
                return Err(Error::new(Status::InvalidValue, reason).at(format!("distances[{k}]")));
            }
        }
        check_rows(task.snake, task.conditions, "conditions")?;
        if let Some(surface) = &task.surface {
            if surface.heights.len() != count {
                return Err(expected(surface.heights.len(), "surface.heights"));
            }
            if let Some(i) = surface.heights.iter().position(|height| !height.is_finite()) {
                let reason = format!("expected a finite number, found {}", surface.heights[i]);
                return Err(Error::new(Status::InvalidValue, reason).at(format!("surface.heights[{i}]")));
            }
            if !(surface.reach > 0.0) {
                let reason = format!("expected a number above 0, found {}", surface.reach);
                return Err(Error::new(Status::InvalidValue, reason).at("surface.reach"));
            }
            if options.is_exact {
                let reason = "expected no surface where the nearest position is asked for";
                return Err(Error::new(Status::InvalidValue, reason).at("surface"));
            }
        }
        let mut distances = task.snake.distances();
        let size = around(&distances, count);
        distances.extend_from_slice(task.distances);
        // A distance of two points that are given is none to meet: round-off of them is none of ours.
        distances.retain(|distance| {
            !distance.points.iter().all(|&i| is_fixed[i as usize]) || {
                let [i, j] = distance.points.map(|i| task.target[i as usize]);
                (i.distance(j) - distance.length).abs() > MET * size
            }
        });
        let positions = positions(count, task.snake.is_closed());
        let (target, conditions, surface) = (task.target, task.conditions, task.surface);
        Ok(Self { target, conditions, surface, distances, is_fixed, positions, size })
    }

    fn distance_residual(points: &[DVec3], distance: &Distance) -> f64 {
        let [i, j] = distance.points.map(|i| i as usize);
        points[i].distance(points[j]) - distance.length
    }

    /// Distances and conditions.
    fn residual(&self, points: &[DVec3]) -> f64 {
        let distances = self.distances.iter().map(|distance| Self::distance_residual(points, distance).abs());
        let norm = |row: &Row| row.terms.iter().map(|(_, a)| a.length_squared()).sum::<f64>().sqrt();
        let unit = |row: &Row| if norm(row) > 0.0 { 1.0 / norm(row) } else { 1.0 };
        let rows = self.conditions.iter().map(|row| (unit(row) * row.residual(points)).abs());
        distances.chain(rows).fold(0.0, f64::max)
    }

    fn height_residual(&self, points: &[DVec3]) -> f64 {
        let Some(surface) = &self.surface else { return 0.0 };
        let off = |(i, wanted): (usize, &f64)| {
            if self.is_fixed[i] { 0.0 } else { (height(surface.reference, points[i]) - wanted).abs() }
        };
        surface.heights.iter().enumerate().map(off).fold(0.0, f64::max)
    }

    /// The largest of all, heights included if `on_surface`.
    fn largest(&self, points: &[DVec3], on_surface: bool) -> f64 {
        let heights = if on_surface { self.height_residual(points) } else { 0.0 };
        self.residual(points).max(heights)
    }

    fn free(&self, mut row: Vec<(u32, f64)>) -> Vec<(u32, f64)> {
        row.retain(|&(i, _)| !self.is_fixed[i as usize / 3]);
        row
    }
}

#[cfg(test)]
mod tests;
