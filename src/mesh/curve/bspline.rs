//! Cubic B-splines over uniform knots.

use glam::DVec3;

use super::{Curve, Jet};
use crate::error::{Error, Result, Status};
use crate::mesh::grid::check_finite;

/// The cubic B-spline functions over uniform knots of distance 1: non-negative, of sum 1, twice continuously differentiable, each of
/// them non-zero over four spans at most.
///
/// Open: of `n` functions over the parameters from 0 to `n − 3`, with the knots at both ends repeated four times, so that a curve
/// starts in its first control point and ends in its last. Closed: periodic, over the parameters from 0 to `n`.
#[derive(Clone, Debug, PartialEq)]
pub struct CubicBasis {
    count: usize,
    is_closed: bool,
    knots: Vec<f64>,
}

/// The four functions that are not zero at a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalBasis {
    /// Which functions these are.
    pub functions: [usize; 4],
    /// Their values.
    pub values: [f64; 4],
    /// Their first derivatives.
    pub firsts: [f64; 4],
    /// Their second derivatives.
    pub seconds: [f64; 4],
}

impl CubicBasis {
    /// The basis of `count` functions, one for each control point.
    ///
    /// # Errors
    /// Fewer than 4; the place is `count`.
    pub fn new(count: usize, is_closed: bool) -> Result<Self> {
        if count < 4 {
            let reason = format!("expected at least 4 control points of a cubic spline, found {count}");
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("count"));
        }
        let spans = if is_closed { count } else { count - 3 };
        let knot = |i: usize| {
            let knot = i as f64 - 3.0;
            if is_closed { knot } else { knot.clamp(0.0, spans as f64) }
        };
        Ok(Self { count, is_closed, knots: (0..spans + 7).map(knot).collect() })
    }

    /// How many functions there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether it is periodic.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// All knots, ascending: 4 more than functions; of a closed basis 7 more, function `count + i` being function `i` again.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// How many spans the parameters have, each of length 1: the last parameter.
    pub fn spans(&self) -> usize {
        self.knots.len() - 7
    }

    /// The functions at a parameter within the range; others are taken as the nearer end.
    ///
    /// By the recursion of Cox and de Boor: a function of degree `d` is the mean of two of degree `d − 1`, weighted linearly over
    /// their knots; its derivative is `d` times their difference, each over the length of its support.
    pub fn at(&self, parameter: f64) -> LocalBasis {
        let last = self.spans();
        let t = parameter.clamp(0.0, last as f64);
        let span = (t as usize).min(last - 1);
        // Knot `k` of the span is the first that may differ from t at its left side.
        let knot = |i: usize| self.knots[span + i];
        // `ways[d][i]`: the functions of degree d that are not zero in the span, of which the last starts in it.
        let mut ways = [[0.0; 4]; 4];
        ways[0][0] = 1.0;
        for degree in 1..=3 {
            for i in 0..=degree {
                // This function starts at knot 3 − degree + i, counted from the first of the span's.
                let start = 3 - degree + i;
                let rising = if i > 0 { ways[degree - 1][i - 1] / (knot(start + degree) - knot(start)) } else { 0.0 };
                let falling =
                    if i < degree { ways[degree - 1][i] / (knot(start + degree + 1) - knot(start + 1)) } else { 0.0 };
                ways[degree][i] = rising * (t - knot(start)) + falling * (knot(start + degree + 1) - t);
            }
        }
        // The difference of two neighbours, each over its support.
        let slope = |lower: &[f64], degree: usize, i: usize| {
            let start = 3 - degree + i;
            let rising = if i > 0 { lower[i - 1] / (knot(start + degree) - knot(start)) } else { 0.0 };
            let falling = if i < degree { lower[i] / (knot(start + degree + 1) - knot(start + 1)) } else { 0.0 };
            degree as f64 * (rising - falling)
        };
        let firsts = [0, 1, 2, 3].map(|i| slope(&ways[2], 3, i));
        let quadratic_firsts = [0, 1, 2].map(|i| slope(&ways[1], 2, i));
        let seconds = [0, 1, 2, 3].map(|i| slope(&quadratic_firsts, 3, i));
        let functions = [0, 1, 2, 3].map(|i| (span + i) % self.count);
        LocalBasis { functions, values: ways[3], firsts, seconds }
    }
}

impl LocalBasis {
    /// The point and the derivatives of the curve with these control points, one for each function of the basis.
    pub fn jet(&self, control: &[DVec3]) -> Jet {
        let sum = |weights: [f64; 4]| (0..4).map(|i| weights[i] * control[self.functions[i]]).sum();
        Jet { point: sum(self.values), first: sum(self.firsts), second: sum(self.seconds) }
    }
}

/// A cubic B-spline curve.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline {
    basis: CubicBasis,
    control: Vec<DVec3>,
}

impl BSpline {
    /// The curve with these control points.
    ///
    /// # Errors
    /// Not one point for each function, or a coordinate that is not finite; the place is `control` or `control[i]`.
    pub fn new(basis: CubicBasis, control: Vec<DVec3>) -> Result<Self> {
        if control.len() != basis.count() {
            let reason = format!("expected {} control points, found {}", basis.count(), control.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("control"));
        }
        check_finite("control", &control)?;
        Ok(Self { basis, control })
    }

    /// Its basis.
    pub fn basis(&self) -> &CubicBasis {
        &self.basis
    }

    /// Its control points.
    pub fn control(&self) -> &[DVec3] {
        &self.control
    }
}

impl Curve for BSpline {
    fn range(&self) -> [f64; 2] {
        [0.0, self.basis.spans() as f64]
    }

    fn is_closed(&self) -> bool {
        self.basis.is_closed()
    }

    fn at(&self, parameter: f64) -> Jet {
        self.basis.at(self.inside(parameter)).jet(&self.control)
    }

    fn parts(&self) -> Vec<f64> {
        (0..=self.basis.spans()).map(|i| i as f64).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_span_is_bernsteins_and_inner_spans_are_the_uniform_splines() {
        let bernstein = CubicBasis::new(4, false).unwrap();
        assert_eq!((bernstein.spans(), bernstein.knots().len()), (1, 8));
        for t in [0.0, 0.3, 0.5, 1.0] {
            let s: f64 = 1.0 - t;
            let expected = [s.powi(3), 3.0 * s * s * t, 3.0 * s * t * t, t.powi(3)];
            let found = bernstein.at(t);
            assert!((0..4).all(|i| (found.values[i] - expected[i]).abs() < 1e-15), "{found:?}");
        }
        // At a knot far from the ends: 1/6, 4/6, 1/6.
        let long = CubicBasis::new(12, false).unwrap().at(4.0);
        let closed = CubicBasis::new(5, true).unwrap().at(0.0);
        for (local, functions) in [(long, [4, 5, 6, 7]), (closed, [0, 1, 2, 3])] {
            assert_eq!(local.functions, functions);
            let expected = [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0, 0.0];
            assert!((0..4).all(|i| (local.values[i] - expected[i]).abs() < 1e-15), "{local:?}");
        }
    }

    #[test]
    fn values_add_up_and_derivatives_are_those_of_the_values() {
        for (count, is_closed) in [(4, false), (5, false), (6, false), (9, false), (4, true), (7, true)] {
            let basis = CubicBasis::new(count, is_closed).unwrap();
            let full = |t: f64, which: fn(&LocalBasis) -> [f64; 4]| {
                let local = basis.at(t);
                let mut all = vec![0.0; count];
                (0..4).for_each(|i| all[local.functions[i]] += which(&local)[i]);
                all
            };
            for i in 0..40 {
                let t = 0.013 + (basis.spans() as f64 - 0.026) * f64::from(i) / 39.0;
                let (values, firsts, seconds) = (full(t, |l| l.values), full(t, |l| l.firsts), full(t, |l| l.seconds));
                assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-14 && values.iter().all(|v| *v >= 0.0));
                let h = 1e-5;
                let (ahead, back) = (full(t + h, |l| l.values), full(t - h, |l| l.values));
                let (first_ahead, first_back) = (full(t + h, |l| l.firsts), full(t - h, |l| l.firsts));
                for j in 0..count {
                    assert!((firsts[j] - (ahead[j] - back[j]) / (2.0 * h)).abs() < 1e-8);
                    assert!((seconds[j] - (first_ahead[j] - first_back[j]) / (2.0 * h)).abs() < 1e-4);
                }
            }
        }
    }

    #[test]
    fn control_points_on_the_greville_abscissae_make_a_straight_curve() {
        let basis = CubicBasis::new(8, false).unwrap();
        let knots = basis.knots().to_vec();
        let control = (0..8).map(|i| DVec3::X * (knots[i + 1] + knots[i + 2] + knots[i + 3]) / 3.0).collect();
        let line = BSpline::new(basis, control).unwrap();
        for t in [0.0, 0.7, 2.5, 4.999, 5.0] {
            let jet = line.at(t);
            assert!((jet.point.x - t).abs() < 1e-14 && jet.first.distance(DVec3::X) < 1e-14);
            assert!(jet.second.length() < 1e-13);
        }
        assert_eq!((line.range(), line.parts().len(), line.control().len()), ([0.0, 5.0], 6, 8));
    }

    #[test]
    fn a_closed_curve_goes_on_with_both_derivatives() {
        let corner = |i: i32| DVec3::new((2.0 * f64::from(i)).sin(), f64::from(i * i % 5), f64::from(i));
        let curve = BSpline::new(CubicBasis::new(6, true).unwrap(), (0..6).map(corner).collect()).unwrap();
        let (start, end) = (curve.basis().at(0.0).jet(curve.control()), curve.basis().at(6.0).jet(curve.control()));
        assert!(start.point.distance(end.point) < 1e-14 && start.first.distance(end.first) < 1e-14);
        assert!(start.second.distance(end.second) < 1e-13);
        assert!(curve.at(7.5).point.distance(curve.at(1.5).point) < 1e-14);
    }

    #[test]
    fn bad_splines_are_refused() {
        assert_eq!(CubicBasis::new(3, true).unwrap_err().place(), "count");
        let basis = CubicBasis::new(4, false).unwrap();
        assert_eq!(BSpline::new(basis.clone(), vec![DVec3::ZERO; 5]).unwrap_err().place(), "control");
        let bad = vec![DVec3::ZERO, DVec3::X, DVec3::NAN, DVec3::Y];
        assert_eq!(BSpline::new(basis, bad).unwrap_err().place(), "control[2]");
    }
}
