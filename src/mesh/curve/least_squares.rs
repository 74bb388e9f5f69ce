//! Cubic B-splines that fit polylines.

use glam::DVec3;

use super::{BSpline, CubicBasis};
use crate::error::{Error, Result, Status};
use crate::linalg::least_squares::LeastSquares;
use crate::mesh::ClosestPoints;
use crate::mesh::grid::{check_finite, diagonal};

/// Points of a polyline in each span of the spline that is fitted to it, at least.
const POINTS_PER_SPAN: usize = 8;

/// The last point of a closed polyline repeats the first below this multiple of its extent: files round coordinates.
const SEAM: f64 = 1e-9;

/// A polyline by its length.
#[derive(Clone, Debug)]
pub struct Polyline {
    /// The first again at the end of a closed one.
    points: Vec<DVec3>,
    /// The length up to each point.
    lengths: Vec<f64>,
    is_closed: bool,
    closest: ClosestPoints,
}

impl Polyline {
    /// The polyline through `points` in their order; if `is_closed`, from the last back to the first, which the last may repeat.
    ///
    /// # Errors
    /// Fewer than 2 points, 3 of a closed one, a coordinate that is not finite, or no length; the place is `points` or `points[i]`.
    pub fn new(points: &[DVec3], is_closed: bool) -> Result<Self> {
        check_finite("points", points)?;
        let extent = diagonal(points);
        let repeats = is_closed && points.len() > 1 && points[0].distance(points[points.len() - 1]) <= SEAM * extent;
        let mut points = points[..points.len() - usize::from(repeats)].to_vec();
        let least = if is_closed { 3 } else { 2 };
        if points.len() < least {
            let reason = format!("expected at least {least} points, found {}", points.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
        }
        if is_closed {
            points.push(points[0]);
        }
        let mut lengths = vec![0.0];
        points.windows(2).for_each(|ends| lengths.push(lengths[lengths.len() - 1] + ends[0].distance(ends[1])));
        let total = lengths[lengths.len() - 1];
        if !(total > 0.0 && total.is_finite()) {
            let reason = format!("expected a polyline with a length above 0, found {total}");
            return Err(Error::new(Status::Degenerate, reason).at("points"));
        }
        let closest = ClosestPoints::of_polyline(&points, false)?;
        Ok(Self { points, lengths, is_closed, closest })
    }

    /// Whether its end is its start.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Its length, in model units.
    pub fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// The point up to which it is so long: around a closed one, the nearer end of an open one.
    pub fn at(&self, along: f64) -> DVec3 {
        let total = self.length();
        let along = if self.is_closed { along.rem_euclid(total) } else { along.clamp(0.0, total) };
        let i = self.lengths.partition_point(|&length| length <= along).clamp(1, self.lengths.len() - 1);
        let (before, after) = (self.lengths[i - 1], self.lengths[i]);
        // A segment without length is passed by, but for the last.
        let part = if after > before { ((along - before) / (after - before)).min(1.0) } else { 0.0 };
        self.points[i - 1].lerp(self.points[i], part)
    }

    /// The length up to the nearest point to a finite point.
    pub fn nearest(&self, point: DVec3) -> f64 {
        let (foot, piece) = self.closest.nearest_on_piece(point);
        (self.lengths[piece] + self.points[piece].distance(foot)).min(self.lengths[piece + 1])
    }
}

/// The cubic B-spline of `count` control points that fits a polyline best, its parameter being in proportion to the length. An
/// open one starts and ends where the polyline does; a closed one is periodic.
///
/// Control points put onto the curve would give a spline that shrinks by the second power of their distance; a fit is good to the
/// fourth.
///
/// # Errors
/// Fewer than 4 control points; the place is `count`.
pub fn fit_polyline(polyline: &Polyline, count: usize) -> Result<BSpline> {
    let basis = CubicBasis::new(count, polyline.is_closed)?;
    let parts = (POINTS_PER_SPAN * basis.spans()).max(2 * polyline.points.len());
    let number = if polyline.is_closed { parts } else { parts + 1 };
    let part = |i: usize| i as f64 / parts as f64;
    let parameters: Vec<f64> = (0..number).map(|i| basis.spans() as f64 * part(i)).collect();
    let points: Vec<DVec3> = (0..number).map(|i| polyline.at(polyline.length() * part(i))).collect();
    fit(basis, &parameters, &points)
}

/// The spline nearest to `points` at `parameters` in the sum of squares. An open one goes through the first and the last point,
/// whose parameters are the ends of the range. Each span needs some of the parameters.
pub(crate) fn fit(basis: CubicBasis, parameters: &[f64], points: &[DVec3]) -> Result<BSpline> {
    let count = basis.count();
    let last = points.len() - 1;
    // About the middle: round-off then is that of the curve's size, not of its place.
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let (inner, ends) = if basis.is_closed() {
        (0..count, [DVec3::ZERO; 2])
    } else {
        (1..count - 1, [points[0] - middle, points[last] - middle])
    };
    let mut control = vec![DVec3::ZERO; count];
    if !basis.is_closed() {
        [control[0], control[count - 1]] = ends;
    }
    for axis in 0..3 {
        let mut system = LeastSquares::new(inner.len());
        for (&parameter, point) in parameters.iter().zip(points) {
            let local = basis.at(parameter);
            let mut right = (*point - middle)[axis];
            let mut entries = Vec::with_capacity(4);
            for (&i, &value) in local.functions.iter().zip(&local.values) {
                if inner.contains(&i) {
                    entries.push(((i - inner.start) as u32, value));
                } else {
                    right -= value * control[i][axis];
                }
            }
            system.add(&entries, right);
        }
        let found = system.solve()?;
        inner.clone().zip(found).for_each(|(i, value)| control[i][axis] = value);
    }
    control.iter_mut().for_each(|point| *point += middle);
    if !basis.is_closed() {
        [control[0], control[count - 1]] = [points[0], points[last]];
    }
    BSpline::new(basis, control)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::mesh::curve::Curve;

    #[test]
    fn a_polyline_is_walked_by_its_length() {
        let corners = [DVec3::ZERO, 3.0 * DVec3::X, 3.0 * DVec3::X, DVec3::new(3.0, 4.0, 0.0)];
        let open = Polyline::new(&corners, false).unwrap();
        assert_eq!((open.length(), open.at(5.0), open.at(-1.0)), (7.0, DVec3::new(3.0, 2.0, 0.0), DVec3::ZERO));
        assert_eq!((open.at(9.0), open.nearest(DVec3::new(5.0, 1.0, 2.0))), (corners[3], 4.0));
        let closed = Polyline::new(&corners, true).unwrap();
        assert_eq!((closed.length(), closed.at(-2.5), closed.at(12.0)), (12.0, DVec3::new(1.5, 2.0, 0.0), DVec3::ZERO));
        let again = [corners[0], corners[1], corners[3], corners[0]];
        assert_eq!(Polyline::new(&again, true).unwrap().length(), 12.0);
        let refusal = |points: &[DVec3], is_closed| Polyline::new(points, is_closed).unwrap_err();
        assert_eq!(refusal(&[], true).place(), "points");
        assert_eq!(refusal(&again[2..], true).status(), Status::InvalidArgumentLength);
        assert_eq!(refusal(&[DVec3::X; 4], false).status(), Status::Degenerate);
        assert_eq!(refusal(&[DVec3::X, DVec3::NAN], false).place(), "points[1]");
    }

    /// The largest distance of the fit from a helix, or from a circle if closed, and what it is fitted to.
    fn helix_error(count: usize, is_closed: bool) -> f64 {
        let point = |t: f64| DVec3::new(t.cos(), t.sin(), if is_closed { 7.0 } else { 0.3 * t + 100.0 });
        let turn = if is_closed { TAU } else { 4.0 };
        let points: Vec<DVec3> = (0..=20_000).map(|i| point(turn * f64::from(i) / 20_000.0)).collect();
        let spline = fit_polyline(&Polyline::new(&points, is_closed).unwrap(), count).unwrap();
        if !is_closed {
            assert_eq!([spline.point(0.0), spline.point(spline.range()[1])], [points[0], points[20_000]]);
        }
        let at = |i: u32| (turn * f64::from(i) / 500.0, spline.range()[1] * f64::from(i) / 500.0);
        (0..=500).map(at).map(|(t, u)| spline.point(u).distance(point(t))).fold(0.0, f64::max)
    }

    #[test]
    fn a_fit_is_good_to_the_fourth_power_of_the_distance_of_knots() {
        for (is_closed, counts) in [(false, [11, 19]), (true, [8, 16])] {
            let [coarse, fine] = counts.map(|count| helix_error(count, is_closed));
            assert!(coarse < 2e-3 && (11.0..22.0).contains(&(coarse / fine)), "{is_closed}: {coarse} {fine}");
        }
    }

    #[test]
    fn a_cubic_is_found_again_and_too_few_control_points_are_refused() {
        let basis = CubicBasis::new(7, false).unwrap();
        let control: Vec<DVec3> = (0..7).map(f64::from).map(|i| DVec3::new(i, (3.0 * i).sin(), i * i * 0.1)).collect();
        let truth = BSpline::new(basis.clone(), control).unwrap();
        let parameters: Vec<f64> = (0..=30).map(|i| 4.0 * f64::from(i) / 30.0).collect();
        let points: Vec<DVec3> = parameters.iter().map(|&t| truth.point(t)).collect();
        let found = fit(basis, &parameters, &points).unwrap();
        assert!(found.control().iter().zip(truth.control()).all(|(a, b)| a.distance(*b) < 1e-10));
        let polyline = Polyline::new(&points, false).unwrap();
        assert_eq!(fit_polyline(&polyline, 3).unwrap_err().place(), "count");
    }
}
