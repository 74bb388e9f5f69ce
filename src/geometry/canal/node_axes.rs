//! Torsion-free beam layouts: node axes that give beams of constant height the smallest gaps at the nodes.
//!
//! Axes are handed on from one node by reflection (see `frame`), and at both ends of an edge they lean against it at the same angle
//! `α`. A beam of the constant height `h`, measured square to its edge in the plane of its axes, reaches the node `h / sin α` down
//! the axis. Beams that meet at a node lean differently, so their lower edges meet the axis at different heights: the *gap* is the
//! difference of the greatest and the least of these (section 4.3). Only the first axis is free, a unit vector: two parameters. (A
//! frame has three, but its turn about the axis never enters.) The sum of the squared gaps is searched for on a grid over the
//! hemisphere, then by BFGS.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::ControlFlow;

use glam::DVec3;

use super::frame::{self, Frame};
use super::panels::edges;
use crate::error::{Error, Result, Status, finite};
use crate::linalg::bfgs;
use crate::mesh::Grid;

/// An axis that leans closer to a beam than this, 5 degrees, is refused: the beam would grow without bound.
pub const LEAST_LEAN_RAD: f64 = 5.0 * TAU / 360.0;

/// Directions of the first search along the meridian of the hemisphere; about 8 degrees apart.
const RINGS: usize = 12;

/// Node axes and what they do.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeAxes {
    /// A unit vector at each point, row by row.
    pub axes: Vec<DVec3>,
    /// For each point, the difference of the greatest and the least depth along its axis that beams of height 1 need.
    pub gaps: Vec<f64>,
    /// Whether the search was cancelled: these are the best axes so far.
    pub is_cancelled: bool,
}

impl NodeAxes {
    /// The axes of a circular net that are handed on from `first` at point `(0, 0)`.
    ///
    /// # Errors
    /// `first` is zero or not finite. Status `Degenerate`: an axis is within [`LEAST_LEAN_RAD`] of a beam; the place is `points[i]`.
    pub fn handed_on(grid: &Grid, first: DVec3) -> Result<Self> {
        let axes = axes(grid, unit(first)?);
        Self::of(grid, &axes)
    }

    /// Given axes, one at each point, and the gaps that they make.
    ///
    /// # Errors
    /// Another number of axes than of points, or one that is zero or not finite. Status `Degenerate`: an axis is within
    /// [`LEAST_LEAN_RAD`] of a beam; the place is `points[i]`.
    pub fn of(grid: &Grid, axes: &[DVec3]) -> Result<Self> {
        super::panels::check_axes(grid, axes)?;
        let axes: Vec<DVec3> = axes.iter().map(|axis| axis.normalize()).collect();
        let depths = Depths::new(grid, &axes);
        if let Some(point) = (0..axes.len()).find(|&point| !(depths.greatest[point] < 1.0 / LEAST_LEAN_RAD.sin())) {
            let degrees = LEAST_LEAN_RAD.to_degrees();
            let reason = format!("its axis is within {degrees:.0} degrees of a beam: the node would be too deep");
            return Err(Error::new(Status::Degenerate, reason).at(format!("points[{point}]")));
        }
        Ok(Self { gaps: depths.gaps(), axes, is_cancelled: false })
    }

    /// The axes handed on by reflection whose gaps have the least sum of squares. `progress` is called with the part done, 0 to 1,
    /// and can cancel.
    ///
    /// # Errors
    /// Status `NoSolution`: every first axis that was tried leads to one within [`LEAST_LEAN_RAD`] of a beam; the place is `points`.
    pub fn of_least_gaps(grid: &Grid, progress: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<Self> {
        let mut best = ([0.0; 2], f64::INFINITY);
        let mut is_cancelled = false;
        for ring in 0..=RINGS {
            let theta = FRAC_PI_2 * ring as f64 / RINGS as f64;
            let count = (4.0 * RINGS as f64 * theta.sin()).ceil().max(1.0) as usize;
            for k in 0..count {
                let angles = [theta, TAU * k as f64 / count as f64];
                let value = cost(grid, direction(&angles));
                if value < best.1 {
                    best = (angles, value);
                }
            }
            if progress(0.5 * (ring + 1) as f64 / (RINGS + 1) as f64).is_break() {
                is_cancelled = true;
                break;
            }
        }
        if best.1 == f64::INFINITY {
            let reason = "every first axis leads to one that nearly lies along a beam";
            return Err(Error::new(Status::NoSolution, reason).at("points"));
        }
        // Spherical coordinates about the best direction itself, where they are regular.
        let center = direction(&best.0);
        let (x, y) = center.any_orthonormal_pair();
        let about = |t: &[f64]| (center + t[0] * x + t[1] * y).normalize();
        if !is_cancelled {
            let mut objective = |t: &[f64]| cost(grid, about(t));
            let options = bfgs::Options { relative_decrease: 1e-10, ..bfgs::Options::default() };
            let found = bfgs::minimise(&mut objective, &[0.0, 0.0], &options, &mut |state| {
                progress(0.5 + 0.5 * (state.iteration as f64 / options.max_iterations as f64).min(1.0))
            });
            is_cancelled = found.stop == bfgs::Stop::Cancelled;
            return Ok(Self { is_cancelled, ..Self::handed_on(grid, about(&found.x))? });
        }
        Ok(Self { is_cancelled, ..Self::handed_on(grid, center)? })
    }

    /// The largest gap of beams of the given height, in model units.
    pub fn largest_gap(&self, height: f64) -> f64 {
        height * self.gaps.iter().copied().fold(0.0, f64::max)
    }

    /// For each point, the depth along its axis down to which the deepest beam of the given height reaches.
    ///
    /// # Errors
    /// A height that is not finite, or of which a depth is not.
    pub fn depths(&self, grid: &Grid, height: f64) -> Result<Vec<f64>> {
        finite("height", height)?;
        let depths: Vec<f64> = Depths::new(grid, &self.axes).greatest.iter().map(|depth| height * depth).collect();
        if depths.iter().all(|depth| depth.is_finite()) {
            return Ok(depths);
        }
        let reason = format!("expected one of which the depths are finite, found {height}");
        Err(Error::new(Status::InvalidValue, reason).at("height"))
    }
}

/// The sum of squared gaps; infinite for axes that are refused.
fn cost(grid: &Grid, first: DVec3) -> f64 {
    NodeAxes::handed_on(grid, first).map_or(f64::INFINITY, |found| found.gaps.iter().map(|gap| gap * gap).sum())
}

fn unit(axis: DVec3) -> Result<DVec3> {
    axis.try_normalize().filter(|axis| axis.is_finite()).ok_or_else(|| {
        let reason = format!("expected a vector other than zero, found {axis}");
        Error::new(Status::InvalidValue, reason).at("first")
    })
}

fn direction(angles: &[f64]) -> DVec3 {
    let ((st, ct), (sl, cl)) = (angles[0].sin_cos(), angles[1].sin_cos());
    DVec3::new(st * cl, st * sl, ct)
}

/// Handed on along row 0 and down the columns. The sign of a tangent does not matter to a normal.
fn axes(grid: &Grid, first: DVec3) -> Vec<DVec3> {
    let (t1, t2) = first.any_orthonormal_pair();
    frame::handed_on(grid, Frame { t1, t2, normal: first }, &frame::Turns::none(grid))
        .into_iter()
        .map(|frame| frame.normal)
        .collect()
}

/// The least and the greatest depth along each axis that beams of height 1 need.
struct Depths {
    least: Vec<f64>,
    greatest: Vec<f64>,
}

impl Depths {
    fn new(grid: &Grid, axes: &[DVec3]) -> Self {
        let (mut least, mut greatest) = (vec![f64::INFINITY; axes.len()], vec![0.0_f64; axes.len()]);
        for ends in edges(grid) {
            let along = (grid.points()[ends[1]] - grid.points()[ends[0]]).normalize_or_zero();
            for end in ends {
                // 1 / sin of the angle between axis and beam.
                let depth = 1.0 / axes[end].cross(along).length();
                least[end] = least[end].min(depth);
                greatest[end] = greatest[end].max(depth);
            }
        }
        Self { least, greatest }
    }

    fn gaps(&self) -> Vec<f64> {
        self.least.iter().zip(&self.greatest).map(|(least, greatest)| greatest - least).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::canal::cyclide::Cyclide;
    use crate::geometry::canal::panels::beams;
    use crate::geometry::random::Random;

    fn go_on(_: f64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn sum(axes: &NodeAxes) -> f64 {
        axes.gaps.iter().map(|gap| gap * gap).sum()
    }

    #[test]
    fn gaps_are_the_differences_of_the_depths_that_beams_need() {
        // A node on the xy-plane between beams along x, its axis in the xz-plane at 60 degrees, and along y, at 90 degrees.
        let grid = Grid::new(vec![DVec3::ZERO, DVec3::Y, DVec3::X, DVec3::X + DVec3::Y], 2, 2, [false; 2]).unwrap();
        let lean = 60.0_f64.to_radians();
        let found = NodeAxes::handed_on(&grid, DVec3::new(lean.cos(), 0.0, lean.sin())).unwrap();
        let expected = 1.0 / lean.sin() - 1.0;
        assert!(found.gaps.iter().all(|gap| (gap - expected).abs() < 1e-14), "{:?}", found.gaps);
        assert!((found.largest_gap(0.3) - 0.3 * expected).abs() < 1e-14);
        // Upright axes need no more than the height.
        let upright = NodeAxes::of_least_gaps(&grid, &mut go_on).unwrap();
        assert!(upright.largest_gap(1.0) < 1e-9 && upright.axes.iter().all(|axis| axis.z.abs() > 1.0 - 1e-6));
    }

    #[test]
    fn no_direction_of_a_fine_search_has_smaller_gaps() {
        let grid = Cyclide::new().grid([0.2, 1.4], [-0.3, 1.0], 6, 5);
        let found = NodeAxes::of_least_gaps(&grid, &mut go_on).unwrap();
        let mut random = Random(13);
        for _ in 0..2000 {
            if let Ok(other) = NodeAxes::handed_on(&grid, random.vector()) {
                assert!(sum(&other) > sum(&found) * (1.0 - 1e-9), "{} {}", sum(&other), sum(&found));
            }
        }
        for beam in beams(&grid, &found.axes, 0.1).unwrap() {
            let [a, b, c, d] = beam.corners;
            assert!((b - a).cross(d - a).dot(c - a).abs() < 1e-13);
        }
    }

    #[test]
    fn axes_along_beams_are_refused_and_a_search_can_be_cancelled() {
        let grid = Cyclide::new().grid([0.2, 1.4], [-0.3, 1.0], 6, 5);
        let error = NodeAxes::handed_on(&grid, grid.at(1, 0) - grid.at(0, 0)).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::Degenerate, "points[0]"));
        assert_eq!(NodeAxes::handed_on(&grid, DVec3::ZERO).unwrap_err().place(), "first");
        assert_eq!(NodeAxes::of(&grid, &[DVec3::Z]).unwrap_err().place(), "axes");
        let mut calls = 0;
        let mut stop = |_| {
            calls += 1;
            if calls == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let found = NodeAxes::of_least_gaps(&grid, &mut stop).unwrap();
        assert!(found.is_cancelled && calls == 3);
    }
}
