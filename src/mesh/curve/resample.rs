//! Points spread over a curve, and its length.

use super::Curve;
use crate::error::{Error, Result, Status};

/// How points are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// The same step of the parameter from each to the next.
    Parameter,
    /// The same length of the curve.
    #[default]
    ArcLength,
}

/// Nodes and weights of Gauss's quadrature with five points on the interval from −1 to 1: exact for polynomials of degree 9.
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// A part is halved until its two halves together are as long as the whole within this multiple of the curve's length: lengths
/// then are good to some 1e-12, since halving gains a factor of 1000.
const LENGTH_TOLERANCE: f64 = 1e-10;

/// How often a part is halved at most: at a point where a curve stands still the speed has no derivative.
const MOST_HALVINGS: u32 = 12;

/// The length of a curve from its start to any parameter.
pub struct ArcLength<'a> {
    curve: &'a dyn Curve,
    /// Parameters and lengths up to them, both ascending.
    nodes: Vec<(f64, f64)>,
}

impl<'a> ArcLength<'a> {
    /// Measures `curve`.
    ///
    /// # Errors
    /// The curve has no length, or none that is finite; the place is `curve`.
    pub fn new(curve: &'a dyn Curve) -> Result<Self> {
        let parts = curve.parts();
        let rough: f64 = parts.windows(2).map(|ends| length(curve, ends[0], ends[1])).sum();
        if !(rough > 0.0 && rough.is_finite()) {
            let reason = format!("expected a curve with a length above 0, found {rough}");
            return Err(Error::new(Status::Degenerate, reason).at("curve"));
        }
        let mut nodes = vec![(parts[0], 0.0)];
        for ends in parts.windows(2) {
            let whole = length(curve, ends[0], ends[1]);
            measure(curve, [ends[0], ends[1]], whole, LENGTH_TOLERANCE * rough, MOST_HALVINGS, &mut nodes);
        }
        Ok(Self { curve, nodes })
    }

    /// The length of the whole curve, in model units.
    pub fn total(&self) -> f64 {
        self.nodes[self.nodes.len() - 1].1
    }

    /// The parameter up to which the curve has a length, which is taken to be within the curve: solved for by Newton's method,
    /// kept between two nodes by bisection.
    pub fn parameter_at(&self, along: f64) -> f64 {
        let i = self.nodes.partition_point(|node| node.1 <= along).clamp(1, self.nodes.len() - 1) - 1;
        let ((start, before), (end, up_to)) = (self.nodes[i], self.nodes[i + 1]);
        let wanted = (along - before).clamp(0.0, up_to - before);
        let (mut low, mut high) = (start, end);
        let mut t = start + (end - start) * (wanted / (up_to - before)).clamp(0.0, 1.0);
        for _ in 0..50 {
            let excess = length(self.curve, start, t) - wanted;
            if excess.abs() <= 4.0 * f64::EPSILON * self.total() {
                break;
            }
            if excess > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - excess / self.curve.at(t).first.length();
            t = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
        }
        t
    }
}

impl std::fmt::Debug for ArcLength<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ArcLength").field("nodes", &self.nodes).finish_non_exhaustive()
    }
}

/// The length between two parameters by one quadrature.
fn length(curve: &dyn Curve, start: f64, end: f64) -> f64 {
    let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
    half * GAUSS.iter().map(|(node, weight)| weight * curve.at(middle + half * node).first.length()).sum::<f64>()
}

/// Appends the nodes of a part after its start.
fn measure(
    curve: &dyn Curve,
    [start, end]: [f64; 2],
    whole: f64,
    tolerance: f64,
    halvings: u32,
    nodes: &mut Vec<(f64, f64)>,
) {
    let middle = 0.5 * (start + end);
    let [left, right] = [length(curve, start, middle), length(curve, middle, end)];
    if (left + right - whole).abs() <= tolerance || halvings == 0 {
        let before = nodes[nodes.len() - 1].1;
        nodes.push((middle, before + left));
        nodes.push((end, before + left + right));
    } else {
        measure(curve, [start, middle], left, tolerance, halvings - 1, nodes);
        measure(curve, [middle, end], right, tolerance, halvings - 1, nodes);
    }
}

/// The parameters of `count` points spread over a curve: of an open one from its start to its end, both included; of a closed
/// one from its start, which is not repeated.
///
/// # Errors
/// `count` below 2 (3 on a closed curve), or, by arc length, a curve without a finite length.
pub fn resample(curve: &dyn Curve, count: usize, spacing: Spacing) -> Result<Vec<f64>> {
    let least = if curve.is_closed() { 3 } else { 2 };
    if count < least {
        let reason = format!("expected at least {least} points, found {count}");
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("count"));
    }
    let steps = (if curve.is_closed() { count } else { count - 1 }) as f64;
    let [start, end] = curve.range();
    let mut parameters: Vec<f64> = match spacing {
        Spacing::Parameter => (0..count).map(|i| start + (end - start) * (i as f64 / steps)).collect(),
        Spacing::ArcLength => {
            let lengths = ArcLength::new(curve)?;
            (0..count).map(|i| lengths.parameter_at(lengths.total() * (i as f64 / steps))).collect()
        }
    };
    parameters[0] = start;
    if !curve.is_closed() {
        parameters[count - 1] = end;
    }
    Ok(parameters)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::mesh::curve::tests::{circle, wild};
    use crate::mesh::curve::{FnCurve, Spline};

    #[test]
    fn lengths_are_those_of_a_parabola_and_a_circle() {
        // y = x²: the length from 0 to x is (2x √(1 + 4x²) + asinh 2x)/4.
        let parabola = FnCurve::new([0.0, 3.0], false, |t| {
            [DVec3::new(t, t * t, 0.0), DVec3::new(1.0, 2.0 * t, 0.0), DVec3::new(0.0, 2.0, 0.0)]
        })
        .unwrap();
        let exact = |x: f64| 0.25 * (2.0 * x * (1.0 + 4.0 * x * x).sqrt() + (2.0 * x).asinh());
        let lengths = ArcLength::new(&parabola).unwrap();
        assert!((lengths.total() - exact(3.0)).abs() < 1e-12 * exact(3.0), "{}", lengths.total() - exact(3.0));
        let parameters = resample(&parabola, 12, Spacing::ArcLength).unwrap();
        for (i, &t) in parameters.iter().enumerate() {
            assert!((exact(t) - exact(3.0) * i as f64 / 11.0).abs() < 1e-11);
        }
        assert_eq!((parameters[0], parameters[11]), (0.0, 3.0));
        assert_eq!(resample(&parabola, 4, Spacing::Parameter).unwrap(), [0.0, 1.0, 2.0, 3.0]);
        let around = resample(&circle(), 8, Spacing::ArcLength).unwrap();
        for (i, t) in around.iter().enumerate() {
            assert!((t - std::f64::consts::TAU * i as f64 / 8.0).abs() < 1e-13);
        }
    }

    #[test]
    fn spread_points_of_a_spline_are_as_far_apart_along_it() {
        for is_closed in [false, true] {
            let spline = Spline::through(&wild(9), is_closed).unwrap();
            let parameters = resample(&spline, 30, Spacing::ArcLength).unwrap();
            // Oracle: chords of very many points.
            let fine = |from: f64, to: f64| {
                let at = |i: i32| spline.point(from + (to - from) * f64::from(i) / 4000.0);
                (0..4000).map(|i| at(i).distance(at(i + 1))).sum::<f64>()
            };
            let lengths: Vec<f64> = parameters.windows(2).map(|ends| fine(ends[0], ends[1])).collect();
            let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
            assert!(lengths.iter().all(|length| (length - mean).abs() < 1e-7 * mean));
            if is_closed {
                assert!((fine(parameters[29], spline.range()[1]) - mean).abs() < 1e-7 * mean);
            }
        }
    }

    #[test]
    fn what_cannot_be_spread_is_refused() {
        let still = FnCurve::new([0.0, 1.0], false, |_| [DVec3::X, DVec3::ZERO, DVec3::ZERO]).unwrap();
        assert_eq!(ArcLength::new(&still).unwrap_err().status(), Status::Degenerate);
        let hole = |t: f64| [DVec3::X * t, if t == 0.0 || t == 1.0 { DVec3::X } else { DVec3::NAN }, DVec3::ZERO];
        let hole = FnCurve::new([0.0, 1.0], false, hole).unwrap();
        assert!(resample(&hole, 3, Spacing::ArcLength).is_err());
        let refusal = |curve: &dyn Curve, count| resample(curve, count, Spacing::ArcLength).unwrap_err().to_string();
        assert_eq!(refusal(&hole, 1), "count: expected at least 2 points, found 1");
        assert_eq!(refusal(&circle(), 2), "count: expected at least 3 points, found 2");
        // A cusp: (t², t³) stands still at 0 and still has its length, (8 − 2·4^1.5 …)/27 each side.
        let cusp = FnCurve::new([-1.0, 1.0], false, |t| {
            [DVec3::new(t * t, t * t * t, 0.0), DVec3::new(2.0 * t, 3.0 * t * t, 0.0), DVec3::new(2.0, 6.0 * t, 0.0)]
        })
        .unwrap();
        let exact = 2.0 * (13.0_f64.powf(1.5) - 8.0) / 27.0;
        assert!((ArcLength::new(&cusp).unwrap().total() - exact).abs() < 1e-8);
        let parameters = resample(&cusp, 5, Spacing::ArcLength).unwrap();
        assert!(parameters.iter().all(|t| t.is_finite()) && parameters[2].abs() < 1e-3);
    }
}
