//! Curves in space: cubic splines through given points or with given control points, curves given as functions, points spread over them, and the nearest
//! point of a curve.

mod bspline;
mod least_squares;
mod nearest;
mod resample;

pub use bspline::{BSpline, CubicBasis, LocalBasis};
pub(crate) use least_squares::fit;
pub use least_squares::{Polyline, fit_polyline};
pub use nearest::{End, Foot, NearestOnCurve};
pub use resample::{ArcLength, Spacing, resample};

use std::fmt;

use glam::DVec3;

use super::grid::{check_finite, diagonal};
use crate::error::{Error, Result, Status, finite};

/// Neighbouring points count as one below this multiple of the points' extent: the direction from one to the other would
/// keep under four digits.
const REPEATED: f64 = 1e-12;

/// The last point of a closed curve repeats the first below this multiple of the points' extent: files round coordinates.
const SEAM: f64 = 1e-9;

/// Into how many parts a smooth curve counts as divided where nothing is known of it.
const SMOOTH_PARTS: usize = 32;

/// A curve with two derivatives.
pub trait Curve {
    /// The first and the last parameter.
    fn range(&self) -> [f64; 2];

    /// Whether the curve goes on from its last parameter at the first, with both derivatives.
    fn is_closed(&self) -> bool;

    /// The point at a parameter and the derivatives there, in model units per unit of the parameter. Parameters outside the
    /// range are taken as [`Curve::inside`] says.
    fn at(&self, parameter: f64) -> Jet;

    /// Parameters from first to last between which the curve is smooth and turns by a moderate angle only: what is sampled
    /// of it is sampled between any two of them.
    fn parts(&self) -> Vec<f64> {
        let [start, end] = self.range();
        (0..=SMOOTH_PARTS).map(|i| start + (end - start) * i as f64 / SMOOTH_PARTS as f64).collect()
    }

    /// The point at a parameter.
    fn point(&self, parameter: f64) -> DVec3 {
        self.at(parameter).point
    }

    /// The unit tangent at a parameter, towards greater ones; zero where the curve stands still.
    fn tangent(&self, parameter: f64) -> DVec3 {
        self.at(parameter).first.normalize_or_zero()
    }

    /// The parameter within the range for which another one stands: around a closed curve; the nearer end of an open one.
    fn inside(&self, parameter: f64) -> f64 {
        let [start, end] = self.range();
        if (start..=end).contains(&parameter) {
            parameter
        } else if self.is_closed() {
            // A parameter just below the start can round up to the end.
            (start + (parameter - start).rem_euclid(end - start)).clamp(start, end)
        } else {
            parameter.clamp(start, end)
        }
    }
}

/// What a curve does at a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// Its point.
    pub point: DVec3,
    /// The first derivative of the point by the parameter.
    pub first: DVec3,
    /// The second derivative.
    pub second: DVec3,
}

/// The cubic spline through given points: twice continuously differentiable, its parameter the length of the chords up to a
/// point. The ends of an open one have no curvature (a natural spline); a closed one is periodic.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// Ascending; one for each point.
    knots: Vec<f64>,
    /// The first again at the end of a closed spline.
    points: Vec<DVec3>,
    /// The second derivative at each knot.
    seconds: Vec<DVec3>,
    is_closed: bool,
    is_merged: bool,
}

impl Spline {
    /// The spline through `points` in their order, in model units. Of two points it is the segment. If `is_closed`, it goes on
    /// from the last point to the first; where the last repeats the first (within 1e-9 of the extent) it is left out, and
    /// [`Spline::is_merged`] says so.
    ///
    /// # Errors
    /// Fewer than 2 different points, 3 of a closed spline, or a coordinate that is not finite or too large for lengths; the
    /// place is `points` or `points[i]`. Status `Degenerate`: a point repeats the one before it; the place is `points[i]`.
    pub fn through(points: &[DVec3], is_closed: bool) -> Result<Self> {
        check_finite("points", points)?;
        let extent = diagonal(points);
        if !extent.is_finite() {
            let reason = "expected coordinates whose squares are finite";
            return Err(Error::new(Status::InvalidValue, reason).at("points"));
        }
        let is_merged = is_closed && points.len() > 1 && points[0].distance(points[points.len() - 1]) <= SEAM * extent;
        let points = if is_merged { &points[..points.len() - 1] } else { points };
        let least = if is_closed { 3 } else { 2 };
        if points.len() < least {
            let (kind, found) = (if is_closed { " different points of a closed curve" } else { "" }, points.len());
            let reason = format!("expected at least {least}{kind}, found {found}");
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
        }
        if let Some(i) = (1..points.len()).find(|&i| points[i].distance(points[i - 1]) <= REPEATED * extent) {
            let reason = format!("expected another point than points[{}], found {} again", i - 1, points[i]);
            return Err(Error::new(Status::Degenerate, reason).at(format!("points[{i}]")));
        }
        let mut points = points.to_vec();
        if is_closed {
            points.push(points[0]);
        }
        let mut knots = vec![0.0];
        points.windows(2).for_each(|ends| knots.push(knots[knots.len() - 1] + ends[0].distance(ends[1])));
        let seconds = if is_closed { periodic(&knots, &points) } else { natural(&knots, &points) };
        Ok(Self { knots, points, seconds, is_closed, is_merged })
    }

    /// The parameters of the points given; that of the first point again, as the last parameter, of a closed spline.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Whether the last point given repeated the first of a closed curve, and was left out.
    pub fn is_merged(&self) -> bool {
        self.is_merged
    }
}

/// The second derivatives of a natural spline at its knots.
///
/// On a span of length `h` from `p` to `q` with second derivatives `M`, `N` at its ends, a cubic starts with the derivative
/// `(q − p)/h − h (2M + N)/6` and ends with `(q − p)/h + h (M + 2N)/6`. The derivatives of two spans agree in their common knot
/// where `h₋ M₋ + 2 (h₋ + h₊) M + h₊ M₊ = 6 ((p₊ − p)/h₊ − (p − p₋)/h₋)`.
fn natural(knots: &[f64], points: &[DVec3]) -> Vec<DVec3> {
    let inner: Vec<DVec3> = (1..knots.len() - 1).map(|i| turn(knots, points, i)).collect();
    let solved = tridiagonal(knots, &inner);
    std::iter::once(DVec3::ZERO).chain(solved).chain(std::iter::once(DVec3::ZERO)).collect()
}

/// The second derivatives of a periodic spline at its knots; the last is the first.
///
/// The rows of all knots but the first give their second derivatives as `a + b M₀`, where `b` solves the system for the terms
/// that the first knot's `M₀` adds to the rows of its two neighbours. The row of the first knot then is an equation for `M₀`.
fn periodic(knots: &[f64], points: &[DVec3]) -> Vec<DVec3> {
    let last = knots.len() - 1;
    let (first_span, last_span) = (knots[1] - knots[0], knots[last] - knots[last - 1]);
    let inner: Vec<DVec3> = (1..last).map(|i| turn(knots, points, i)).collect();
    let a = tridiagonal(knots, &inner);
    let mut ends = vec![DVec3::ZERO; last - 1];
    ends[0].x -= first_span;
    ends[last - 2].x -= last_span;
    let b: Vec<f64> = tridiagonal(knots, &ends).iter().map(|value| value.x).collect();
    let around = 6.0 * ((points[1] - points[0]) / first_span - (points[last] - points[last - 1]) / last_span);
    let at_first = around - first_span * a[0] - last_span * a[last - 2];
    let second = at_first / (2.0 * (first_span + last_span) + first_span * b[0] + last_span * b[last - 2]);
    let inner = a.iter().zip(&b).map(|(&a, &b)| a + b * second);
    std::iter::once(second).chain(inner).chain(std::iter::once(second)).collect()
}

/// The right-hand side of the row of knot `i`.
fn turn(knots: &[f64], points: &[DVec3], i: usize) -> DVec3 {
    let slope = |i: usize| (points[i + 1] - points[i]) / (knots[i + 1] - knots[i]);
    6.0 * (slope(i) - slope(i - 1))
}

/// Solves the rows of the inner knots, without the terms of the outer ones. The matrix is diagonally dominant, so that
/// elimination in order is stable.
fn tridiagonal(knots: &[f64], right: &[DVec3]) -> Vec<DVec3> {
    let span = |i: usize| knots[i + 1] - knots[i];
    let mut pivots: Vec<f64> = Vec::with_capacity(right.len());
    let mut solution = right.to_vec();
    for i in 0..right.len() {
        let diagonal = 2.0 * (span(i) + span(i + 1));
        if i == 0 {
            pivots.push(diagonal);
        } else {
            let factor = span(i) / pivots[i - 1];
            pivots.push(diagonal - factor * span(i));
            let above = solution[i - 1];
            solution[i] -= factor * above;
        }
    }
    for i in (0..right.len()).rev() {
        let below = if i + 1 < right.len() { span(i + 1) * solution[i + 1] } else { DVec3::ZERO };
        solution[i] = (solution[i] - below) / pivots[i];
    }
    solution
}

impl Curve for Spline {
    fn range(&self) -> [f64; 2] {
        [0.0, self.knots[self.knots.len() - 1]]
    }

    fn is_closed(&self) -> bool {
        self.is_closed
    }

    fn at(&self, parameter: f64) -> Jet {
        let t = self.inside(parameter);
        let i = self.knots.partition_point(|&knot| knot <= t).clamp(1, self.knots.len() - 1) - 1;
        let h = self.knots[i + 1] - self.knots[i];
        let (p, q, m, n) = (self.points[i], self.points[i + 1], self.seconds[i], self.seconds[i + 1]);
        let b = (t - self.knots[i]) / h;
        let a = 1.0 - b;
        Jet {
            point: a * p + b * q + (h * h / 6.0) * ((a * a - 1.0) * a * m + (b * b - 1.0) * b * n),
            first: (q - p) / h + (h / 6.0) * ((1.0 - 3.0 * a * a) * m + (3.0 * b * b - 1.0) * n),
            second: a * m + b * n,
        }
    }

    fn parts(&self) -> Vec<f64> {
        self.knots.clone()
    }
}

/// A curve given as a function of its parameter.
pub struct FnCurve<F> {
    range: [f64; 2],
    is_closed: bool,
    function: F,
}

impl<F: Fn(f64) -> [DVec3; 3]> FnCurve<F> {
    /// The curve of a function that maps a parameter of `range` to the point and its first and second derivative.
    ///
    /// # Errors
    /// `range` is not finite and ascending, the function is not finite at its ends, or, if `is_closed`, its ends do not meet.
    pub fn new(range: [f64; 2], is_closed: bool, function: F) -> Result<Self> {
        let [start, end] = [finite("range[0]", range[0])?, finite("range[1]", range[1])?];
        if !(start < end) {
            let reason = format!("expected an ascending range, found {start} to {end}");
            return Err(Error::new(Status::InvalidValue, reason).at("range"));
        }
        let ends = [function(start), function(end)];
        check_finite("function", &ends.concat())?;
        let [first, last] = [ends[0][0], ends[1][0]];
        let scale = first.length().max(last.length()).max((end - start) * ends[0][1].length());
        if is_closed && first.distance(last) > SEAM * scale {
            let reason = format!("expected the ends of a closed curve to meet, found {first} and {last}");
            return Err(Error::new(Status::InvalidValue, reason).at("function"));
        }
        Ok(Self { range, is_closed, function })
    }
}

impl<F: Fn(f64) -> [DVec3; 3]> Curve for FnCurve<F> {
    fn range(&self) -> [f64; 2] {
        self.range
    }

    fn is_closed(&self) -> bool {
        self.is_closed
    }

    fn at(&self, parameter: f64) -> Jet {
        let [point, first, second] = (self.function)(self.inside(parameter));
        Jet { point, first, second }
    }
}

impl<F> fmt::Debug for FnCurve<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FnCurve")
            .field("range", &self.range)
            .field("is_closed", &self.is_closed)
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// The unit circle, exact.
    pub(super) fn circle() -> FnCurve<impl Fn(f64) -> [DVec3; 3]> {
        let point = |t: f64| DVec3::new(t.cos(), t.sin(), 0.0);
        FnCurve::new([0.0, TAU], true, move |t| [point(t), point(t + TAU / 4.0), -point(t)]).unwrap()
    }

    pub(super) fn wild(count: usize) -> Vec<DVec3> {
        (0..count).map(|i| i as f64).map(|i| DVec3::new(i + (3.0 * i).sin(), (2.0 * i).cos(), (i * i).sin())).collect()
    }

    #[test]
    fn a_spline_goes_through_its_points_with_two_continuous_derivatives() {
        for is_closed in [false, true] {
            let points = wild(9);
            let spline = Spline::through(&points, is_closed).unwrap();
            for (&knot, &point) in spline.knots().iter().zip(points.iter().chain(is_closed.then_some(&points[0]))) {
                assert!(spline.point(knot).distance(point) < 1e-14);
            }
            let [start, end] = spline.range();
            assert_eq!(
                (spline.knots().len(), end),
                (points.len() + usize::from(is_closed), *spline.knots().last().unwrap())
            );
            // From both sides of a knot; across the seam of a closed one.
            for &knot in &spline.knots()[usize::from(!is_closed)..spline.knots().len() - usize::from(!is_closed)] {
                let (before, after) = (spline.at(knot - 1e-9), spline.at(knot + 1e-9));
                assert!(before.point.distance(after.point) < 1e-7);
                assert!(before.first.distance(after.first) < 1e-7);
                assert!(before.second.distance(after.second) < 1e-6, "{knot}: {before:?} {after:?}");
            }
            if !is_closed {
                assert_eq!([spline.at(start).second, spline.at(end).second], [DVec3::ZERO; 2]);
                assert_eq!([spline.at(start - 5.0), spline.at(end + 5.0)], [spline.at(start), spline.at(end)]);
            }
            // Derivatives are those of the point.
            for i in 0..40 {
                let t = start + (end - start) * (f64::from(i) + 0.5) / 40.0;
                let h = 1e-5;
                let (before, after) = (spline.at(t - h), spline.at(t + h));
                assert!(((after.point - before.point) / (2.0 * h)).distance(spline.at(t).first) < 1e-8);
                assert!(((after.first - before.first) / (2.0 * h)).distance(spline.at(t).second) < 1e-6);
            }
        }
    }

    #[test]
    fn points_of_a_line_give_the_line_however_uneven() {
        let points = [0.0, 0.1, 3.0, 3.5, 7.0].map(|s| DVec3::new(1.0, 2.0, 3.0) * s);
        let spline = Spline::through(&points, false).unwrap();
        for i in 0..=20 {
            let jet = spline.at(spline.range()[1] * f64::from(i) / 20.0);
            assert!(jet.second.length() < 1e-13 && jet.first.distance(DVec3::new(1.0, 2.0, 3.0).normalize()) < 1e-14);
        }
        let segment = Spline::through(&points[..2], false).unwrap();
        assert!(segment.point(0.5 * segment.range()[1]).distance(0.5 * points[1]) < 1e-15);
    }

    #[test]
    fn a_closed_spline_tends_to_the_circle_with_the_fourth_power_of_the_spacing() {
        let error = |count: usize| {
            let points: Vec<DVec3> = (0..count).map(|i| circle().point(TAU * i as f64 / count as f64)).collect();
            let spline = Spline::through(&points, true).unwrap();
            let at = |i: usize| spline.range()[1] * i as f64 / 1000.0;
            (0..1000).map(|i| (spline.point(at(i)).length() - 1.0).abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(16), error(32));
        assert!(coarse < 1e-4 && (14.0..18.0).contains(&(coarse / fine)), "{coarse} {fine}");
    }

    #[test]
    fn a_repeated_end_is_merged_and_what_is_no_curve_is_refused() {
        let points = wild(6);
        let mut repeated = points.clone();
        repeated.push(points[0] + 1e-12 * DVec3::X);
        let (merged, plain) = (Spline::through(&repeated, true).unwrap(), Spline::through(&points, true).unwrap());
        assert!(merged.is_merged() && !plain.is_merged());
        assert_eq!(Spline { is_merged: false, ..merged }, plain);
        assert!(!Spline::through(&repeated, false).unwrap().is_merged());
        let refusal = |points: &[DVec3], is_closed| Spline::through(points, is_closed).unwrap_err().to_string();
        assert_eq!(refusal(&[], false), "points: expected at least 2, found 0");
        assert_eq!(refusal(&points[..1], false), "points: expected at least 2, found 1");
        let two = "points: expected at least 3 different points of a closed curve, found 2";
        assert_eq!(refusal(&[points[0], points[1], points[0]], true), two);
        let mut bad = points.clone();
        bad[3] = bad[2];
        let error = Spline::through(&bad, false).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::Degenerate, "points[3]"));
        assert!(error.to_string().starts_with("points[3]: expected another point than points[2], found"));
        bad[3] = DVec3::new(0.0, f64::NAN, 0.0);
        assert!(refusal(&bad, false).starts_with("points[3]: expected finite coordinates"));
        assert!(
            refusal(&[DVec3::ZERO, 1e200 * DVec3::X], false).starts_with("points: expected coordinates whose squares")
        );
        let new =
            |range, is_closed, end| FnCurve::new(range, is_closed, move |t| [t * end, end, DVec3::ZERO]).map(|_| ());
        assert!(new([0.0, 1.0], false, DVec3::X).is_ok());
        assert!(new([1.0, 1.0], false, DVec3::X).unwrap_err().to_string().starts_with("range: expected an ascending"));
        assert_eq!(new([0.0, f64::NAN], false, DVec3::X).unwrap_err().place(), "range[1]");
        assert_eq!(new([0.0, 1.0], false, DVec3::NAN).unwrap_err().status(), Status::InvalidValue);
        assert!(new([0.0, 1.0], true, DVec3::X).unwrap_err().to_string().starts_with("function: expected the ends"));
    }

    #[test]
    fn parameters_go_around_a_closed_curve() {
        let circle = circle();
        for t in [-1e-20, -0.3, 7.0, TAU, 1e3] {
            assert!(circle.point(t).distance(DVec3::new(t.cos(), t.sin(), 0.0)) < 1e-12);
            assert!((0.0..=TAU).contains(&circle.inside(t)));
        }
        assert!(circle.tangent(0.0).distance(DVec3::Y) < 1e-15);
    }
}
