//! Points along a curve, with its lengths and curvatures.

use glam::DVec3;

use crate::error::{Error, Result, Status};
use crate::mesh::grid::{check_finite, diagonal};

/// Neighbouring points count as one below this multiple of the points' extent.
const REPEATED: f64 = 1e-12;

/// A curve through points. Between two it is as long as an arc of the mean of the curvatures there; the curvature at a point is
/// that of the circle through it and its neighbours, and changes linearly from point to point.
pub(super) struct Samples {
    /// Of a closed curve the first comes again in the end.
    points: Vec<DVec3>,
    is_closed: bool,
    lengths: Vec<f64>,
    curvatures: Vec<f64>,
    /// The integral of the curvature up to each point.
    turned: Vec<f64>,
}

impl Samples {
    /// The curve through points in their order, or around them: then the first may come again in the end.
    pub fn new(points: &[DVec3], is_closed: bool) -> Result<Self> {
        check_finite("points", points)?;
        let extent = diagonal(points);
        if !extent.is_finite() {
            let reason = "expected coordinates whose squares are finite";
            return Err(Error::new(Status::InvalidValue, reason).at("points"));
        }
        let mut points = points.to_vec();
        let is_again = |points: &[DVec3]| points[0].distance(points[points.len() - 1]) <= REPEATED * extent;
        if is_closed && points.len() > 1 && is_again(&points) {
            points.pop();
        }
        if points.len() < 3 {
            let reason = format!("expected at least 3, found {}", points.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
        }
        if let Some(i) = (1..points.len()).find(|&i| points[i].distance(points[i - 1]) <= REPEATED * extent) {
            let reason = format!("expected another point than points[{}], found the same", i - 1);
            return Err(Error::new(Status::Degenerate, reason).at(format!("points[{i}]")));
        }
        if is_closed {
            points.push(points[0]);
        }
        let last = points.len() - 1;
        let curvature = |i: usize| circle_curvature(around(i, last, is_closed).map(|i| points[i]));
        let curvatures: Vec<f64> = (0..=last).map(curvature).collect();
        let (mut lengths, mut turned) = (vec![0.0], vec![0.0]);
        for i in 0..last {
            let (chord, mean) = (points[i].distance(points[i + 1]), 0.5 * (curvatures[i] + curvatures[i + 1]));
            lengths.push(lengths[i] + arc_length(chord, mean));
            turned.push(turned[i] + mean * (lengths[i + 1] - lengths[i]));
        }
        Ok(Self { points, is_closed, lengths, curvatures, turned })
    }

    pub fn length(&self) -> f64 {
        self.lengths[self.points.len() - 1]
    }

    pub fn ends(&self) -> [DVec3; 2] {
        [self.points[0], self.points[self.points.len() - 1]]
    }

    /// The part between two points in which a length is, and how far in it from 0 to 1.
    fn part(&self, along: f64) -> (usize, f64) {
        let i = self.lengths.partition_point(|&length| length <= along).clamp(1, self.points.len() - 1) - 1;
        let [from, to] = [self.lengths[i], self.lengths[i + 1]];
        (i, ((along - from) / (to - from)).clamp(0.0, 1.0))
    }

    pub fn point(&self, along: f64) -> DVec3 {
        let (i, t) = self.part(along);
        self.points[i].lerp(self.points[i + 1], t)
    }

    /// The unit tangent: at a point that of the parabola through it and its neighbours, blended in between.
    pub fn tangent(&self, along: f64) -> DVec3 {
        let (i, t) = self.part(along);
        let [a, b] = [i, i + 1].map(|i| self.tangent_at(i));
        a.lerp(b, t).try_normalize().unwrap_or(a)
    }

    fn tangent_at(&self, i: usize) -> DVec3 {
        let last = self.points.len() - 1;
        let [p, q, r] = around(i, last, self.is_closed);
        // Of a closed curve the part before the first point is the last one.
        let part = |i: usize| self.lengths[i + 1] - self.lengths[i];
        let [before, after] = [part(if q == 0 { last - 1 } else { q - 1 }), part(if q == last { 0 } else { q })];
        let [p, q, r] = [p, q, r].map(|i| self.points[i]);
        let [first, next] = [(q - p) / before, (r - q) / after];
        // The second divided difference, and the derivative of Newton's polynomial at the point.
        let second = (next - first) / (before + after);
        let along = match i {
            0 if !self.is_closed => -before,
            i if i == last && !self.is_closed => before + 2.0 * after,
            _ => before,
        };
        (first + along * second).try_normalize().unwrap_or(DVec3::X)
    }

    /// The mean curvature between two lengths.
    pub fn mean_curvature(&self, from: f64, to: f64) -> f64 {
        (self.turned(to) - self.turned(from)) / (to - from)
    }

    /// The integral of the curvature from the start to a length.
    fn turned(&self, along: f64) -> f64 {
        let (i, t) = self.part(along);
        let [a, b] = [self.curvatures[i], self.curvatures[i + 1]];
        self.turned[i] + (self.lengths[i + 1] - self.lengths[i]) * t * (a + 0.5 * t * (b - a))
    }

    /// The points from one length to another; those at the ends where there are fewer than three.
    pub fn between(&self, [from, to]: [f64; 2]) -> Vec<DVec3> {
        let round_off = 1e-9 * (to - from);
        let is_in = |length: f64| (from - round_off..=to + round_off).contains(&length);
        let first = self.lengths.partition_point(|&length| length < from - round_off);
        let inside = self.lengths[first..].iter().take_while(|length| is_in(**length)).count();
        let mut points = self.points[first..first + inside].to_vec();
        if points.len() < 3 {
            points = (0..3).map(|k| self.point(from + 0.5 * f64::from(k) * (to - from))).collect();
        }
        points
    }
}

/// A point and its neighbours, in the order of the curve; at the ends of an open one the three that are nearest.
fn around(i: usize, last: usize, is_closed: bool) -> [usize; 3] {
    if is_closed {
        [if i == 0 { last - 1 } else { i - 1 }, i, if i == last { 1 } else { i + 1 }]
    } else {
        let k = i.clamp(1, last - 1);
        [k - 1, k, k + 1]
    }
}

/// The curvature of the circle through three points, `2 |a × b| / (|a| |b| |a + b|)` for the sides `a` and `b` between them.
fn circle_curvature([p, q, r]: [DVec3; 3]) -> f64 {
    let (a, b) = (q - p, r - q);
    let product = a.length() * b.length() * (a + b).length();
    let curvature = 2.0 * a.cross(b).length() / product;
    // There and back again.
    if curvature.is_finite() { curvature } else { 0.0 }
}

/// The length of the arc over a chord.
fn arc_length(chord: f64, curvature: f64) -> f64 {
    let half = 0.5 * chord * curvature;
    if half < 1e-8 { chord } else { 2.0 / curvature * half.min(1.0).asin() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_circle_give_its_length_and_curvature() {
        let radius = 2.5;
        let points: Vec<DVec3> = (0..20)
            .map(|i| {
                let (sine, cosine) = (0.1 * f64::from(i) + 0.001 * f64::from(i * i)).sin_cos();
                radius * DVec3::new(cosine, 0.6 * sine, 0.8 * sine)
            })
            .collect();
        let samples = Samples::new(&points, false).unwrap();
        let angle = 0.1 * 19.0 + 0.001 * 361.0;
        assert!((samples.length() - radius * angle).abs() < 1e-13);
        assert!((samples.mean_curvature(0.3, 1.7) - 1.0 / radius).abs() < 1e-13);
        assert!(samples.point(samples.length()).distance(points[19]) < 1e-14);
        assert!(samples.tangent(0.0).distance(DVec3::new(0.0, 0.6, 0.8)) < 1e-2);
        assert_eq!(samples.between([0.0, samples.length()]).len(), 20);
        assert_eq!(samples.between([0.01, 0.02]).len(), 3);
    }

    #[test]
    fn a_closed_curve_has_neighbours_everywhere() {
        // An uneven circle: each three points are on it, also across the first.
        let at = |t: f64| 3.0 * DVec3::new(t.cos(), t.sin(), 0.0);
        let mut points: Vec<DVec3> =
            (0..30).map(|i| 0.2 * f64::from(i)).map(|t| at(t + 0.05 * (2.0 * t).sin())).collect();
        let samples = Samples::new(&points, true).unwrap();
        let around = 6.0 * std::f64::consts::PI;
        assert!((samples.length() - around).abs() < 1e-12 && (samples.turned[30] - around / 3.0).abs() < 1e-12);
        for i in [0, 1, 29, 30] {
            let (point, tangent) = (samples.points[i], samples.tangent_at(i));
            assert!(tangent.distance(DVec3::Z.cross(point / 3.0)) < 1e-2, "{i} {tangent}");
        }
        assert_eq!(samples.tangent_at(0), samples.tangent_at(30));
        points.push(points[0]);
        let again = Samples::new(&points, true).unwrap();
        assert_eq!((again.points, again.lengths), (samples.points, samples.lengths));
        assert_eq!(Samples::new(&points[..2], true).err().unwrap().place(), "points");
    }
}
