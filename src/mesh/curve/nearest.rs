//! The nearest point of a curve.

use glam::DVec3;

use super::Curve;
use crate::error::{Error, Result};
use crate::mesh::ClosestPoints;
use crate::mesh::grid::check_finite;

/// Samples between two neighbouring parts of a curve: a spline through 16 points of a circle is within 3e-4 of the radius of
/// its chords.
const SAMPLES_PER_PART: usize = 8;

/// How much farther than its middle a curve may be from the chord between two samples, for a curve that is no parabola there.
const SAG_MARGIN: f64 = 1.5;

/// Steps of Newton's method at most, besides one for each sample that is passed from a distant seed: it takes 3 or 4.
const MOST_STEPS: usize = 50;

/// How often a step that leads nowhere nearer is halved: a step of 1e-9 of the first is no progress.
const MOST_HALVINGS: usize = 30;

/// An end of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Where its parameter starts.
    Start,
    /// Where its parameter ends.
    Finish,
}

/// The nearest point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Its parameter, within the curve's range.
    pub parameter: f64,
    /// The point itself.
    pub point: DVec3,
    /// The unit tangent there, towards greater parameters; zero where the curve stands still.
    pub tangent: DVec3,
    /// The distance.
    pub distance: f64,
    /// The end at which it is, of an open curve.
    pub end: Option<End>,
    /// The cosine of the angle between the tangent and the direction from the foot to the point asked for: 0 to rounding but at
    /// an end, beyond which the point may be; 0 too for a point on the curve.
    pub cosine: f64,
}

/// A curve ready to be asked for its nearest point.
pub struct NearestOnCurve<'a> {
    curve: &'a dyn Curve,
    /// The parameters of the samples, and the samples.
    parameters: Vec<f64>,
    samples: Vec<DVec3>,
    polyline: ClosestPoints,
    /// How far the curve may be from each chord between two samples, and the largest of it.
    sags: Vec<f64>,
    largest_sag: f64,
    /// No step is longer, so that none leaps from one branch of the curve to another.
    longest_step: f64,
}

impl<'a> NearestOnCurve<'a> {
    /// Samples `curve`.
    ///
    /// # Errors
    /// The curve is not finite somewhere; the place is `curve`.
    pub fn new(curve: &'a dyn Curve) -> Result<Self> {
        let parts = curve.parts();
        let mut parameters = vec![parts[0]];
        for ends in parts.windows(2) {
            let at = |i: usize| ends[0] + (ends[1] - ends[0]) * i as f64 / SAMPLES_PER_PART as f64;
            parameters.extend((1..=SAMPLES_PER_PART).map(|i| if i == SAMPLES_PER_PART { ends[1] } else { at(i) }));
        }
        let samples: Vec<DVec3> = parameters.iter().map(|&t| curve.point(t)).collect();
        check_finite("curve", &samples).map_err(|error| Error::new(error.status(), error.to_string()).at("curve"))?;
        let polyline = ClosestPoints::of_polyline(&samples, false).map_err(|error| error.with_place("curve"))?;
        let longest_step = parameters.windows(2).map(|ends| ends[1] - ends[0]).fold(0.0, f64::max);
        let sag = |i: usize| {
            let middle = curve.point(0.5 * (parameters[i] + parameters[i + 1]));
            let (chord, along) = (samples[i + 1] - samples[i], middle - samples[i]);
            let t = (along.dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
            let apart = if t.is_finite() { along.distance(t * chord) } else { along.length() };
            if apart.is_finite() { SAG_MARGIN * apart } else { 0.0 }
        };
        let sags: Vec<f64> = (0..samples.len() - 1).map(sag).collect();
        let largest_sag = sags.iter().copied().fold(0.0, f64::max);
        Ok(Self { curve, parameters, samples, polyline, sags, largest_sag, longest_step })
    }

    /// The curve itself.
    pub fn curve(&self) -> &'a dyn Curve {
        self.curve
    }

    /// Samples of the curve in the order of their parameters.
    pub fn samples(&self) -> &[DVec3] {
        &self.samples
    }

    /// The nearest point of the whole curve to a finite point.
    ///
    /// From the nearest point of the samples' polyline a foot is found on the curve. Only pieces of the curve whose chord is
    /// nearer than that foot, but for how far the curve can be from its chord, may have a nearer one; each run of such pieces is
    /// searched from its nearest chord.
    pub fn nearest(&self, point: DVec3) -> Foot {
        let piece = self.polyline.nearest_on_piece(point).1;
        let mut best = self.nearest_from(point, self.seed(piece, point));
        let mut previous = usize::MAX - 1;
        let mut runs: Vec<(usize, f64, bool)> = Vec::new();
        for (index, apart) in self.polyline.within(point, best.distance + self.largest_sag) {
            if apart - self.sags[index] >= best.distance {
                continue;
            }
            match runs.last_mut().filter(|_| index == previous + 1) {
                Some(run) => {
                    let (lowest, least, is_done) = *run;
                    let (lowest, least) = if apart < least { (index, apart) } else { (lowest, least) };
                    *run = (lowest, least, is_done || index == piece);
                }
                None => runs.push((index, apart, index == piece)),
            }
            previous = index;
        }
        for (index, _, is_done) in runs {
            if !is_done {
                let foot = self.nearest_from(point, self.seed(index, point));
                best = if foot.distance < best.distance { foot } else { best };
            }
        }
        best
    }

    /// The parameter at which the chord of a piece is nearest to a point.
    fn seed(&self, piece: usize, point: DVec3) -> f64 {
        let (low, high) = (self.parameters[piece], self.parameters[piece + 1]);
        let chord = self.samples[piece + 1] - self.samples[piece];
        let fraction = ((point - self.samples[piece]).dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
        // A piece without length, where the curve stands still.
        if fraction.is_finite() { low + fraction * (high - low) } else { low }
    }

    /// The nearest point that is reached from the parameter `seed` by going only nearer: it stays on the branch of the curve that
    /// the seed is on, though another one may be nearer.
    ///
    /// Half the squared distance has the derivative `f = (p − x)·p'` by the parameter; its own is `p'² + (p − x)·p''`. Newton's
    /// step is `−f/f'` where `f' > 0`, else `−f/p'²` leads downhill. Steps are halved until they lead nearer. The squared
    /// distance no longer tells points nearer than the square root of round-off from each other; there, a smaller `|f|`
    /// without more distance counts as well.
    pub fn nearest_from(&self, point: DVec3, seed: f64) -> Foot {
        let [start, end] = self.curve.range();
        let is_closed = self.curve.is_closed();
        let seed = if seed.is_finite() { seed } else { start };
        let mut at = Near::new(self.curve, point, self.curve.inside(seed));
        let resolution = 2.0 * f64::EPSILON * (start.abs().max(end.abs()));
        for _ in 0..MOST_STEPS + self.samples.len() {
            let is_still = at.slope.abs() <= at.slope_error;
            let is_pushed_out =
                !is_closed && ((at.parameter <= start && at.slope >= 0.0) || (at.parameter >= end && at.slope <= 0.0));
            if is_still || is_pushed_out {
                break;
            }
            let curvature = if at.curvature > 0.0 { at.curvature } else { at.squared_speed };
            let mut step = (-at.slope / curvature).clamp(-self.longest_step, self.longest_step);
            if !step.is_finite() {
                step = -self.longest_step.copysign(at.slope);
            }
            let next = (0..MOST_HALVINGS).find_map(|_| {
                let next = Near::new(self.curve, point, self.curve.inside(at.parameter + step));
                let is_nearer = next.squared_distance < at.squared_distance;
                let is_flatter = next.slope.abs() < at.slope.abs() && next.curvature > 0.0;
                let is_as_near = next.squared_distance <= (1.0 + 1e-9) * at.squared_distance;
                step *= 0.5;
                (is_nearer || (is_flatter && is_as_near)).then_some(next)
            });
            let Some(next) = next else { break };
            at = next;
            if 2.0 * step.abs() <= resolution {
                break;
            }
        }
        at.foot(if is_closed { None } else { Some([start, end]) }, point)
    }
}

impl std::fmt::Debug for NearestOnCurve<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("NearestOnCurve").field("samples", &self.samples).finish_non_exhaustive()
    }
}

/// A point of the curve as seen from the point asked for.
struct Near {
    parameter: f64,
    point: DVec3,
    first: DVec3,
    squared_distance: f64,
    /// The derivative of half the squared distance by the parameter.
    slope: f64,
    /// What round-off makes of it.
    slope_error: f64,
    /// The derivative of the slope.
    curvature: f64,
    squared_speed: f64,
}

impl Near {
    fn new(curve: &dyn Curve, point: DVec3, parameter: f64) -> Self {
        let jet = curve.at(parameter);
        let from = jet.point - point;
        let squared_speed = jet.first.length_squared();
        let size = jet.point.abs().max_element() + point.abs().max_element();
        Self {
            parameter,
            point: jet.point,
            first: jet.first,
            squared_distance: from.length_squared(),
            slope: from.dot(jet.first),
            slope_error: f64::EPSILON * size * squared_speed.sqrt(),
            curvature: squared_speed + from.dot(jet.second),
            squared_speed,
        }
    }

    fn foot(&self, ends: Option<[f64; 2]>, point: DVec3) -> Foot {
        let end = ends.and_then(|[start, end]| {
            if self.parameter <= start { Some(End::Start) } else { (self.parameter >= end).then_some(End::Finish) }
        });
        let (tangent, distance) = (self.first.normalize_or_zero(), point.distance(self.point));
        let cosine = (point - self.point).normalize_or_zero().dot(tangent);
        let cosine = if self.slope.abs() <= 4.0 * self.slope_error { 0.0 } else { cosine };
        Foot { parameter: self.parameter, point: self.point, tangent, distance, end, cosine }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::mesh::curve::tests::{circle, wild};
    use crate::mesh::curve::{FnCurve, Spline};

    /// A point with coordinates that repeat late.
    fn scattered(i: u32) -> DVec3 {
        let at = |k: f64| (f64::from(i) * k).fract() * 4.0 - 2.0;
        DVec3::new(at(0.618_034), at(0.754_877), at(0.569_84))
    }

    #[test]
    fn the_foot_on_a_circle_is_in_the_direction_of_the_point() {
        let circle = circle();
        let nearest = NearestOnCurve::new(&circle).unwrap();
        for i in 0..200 {
            let point = scattered(i);
            let expected = DVec3::new(point.x, point.y, 0.0).normalize();
            let foot = nearest.nearest(point);
            assert!(foot.point.distance(expected) < 1e-14, "{point}: {}", foot.point.distance(expected));
            assert!(foot.tangent.distance(DVec3::Z.cross(expected)) < 1e-14);
            assert!((foot.distance - point.distance(expected)).abs() < 1e-15 && foot.end.is_none());
            assert!(foot.cosine.abs() < 1e-12);
        }
        // As near to all of it; on it; not finite.
        assert!((nearest.nearest(DVec3::Z).distance - 2.0_f64.sqrt()).abs() < 1e-15);
        assert!(nearest.nearest(DVec3::X).distance < 1e-15);
        for point in [DVec3::NAN, DVec3::INFINITY, 1e200 * DVec3::X, 1e-200 * DVec3::X] {
            let foot = nearest.nearest(point);
            assert!(foot.parameter.is_finite() && foot.point.is_finite() && foot.tangent.is_finite());
        }
    }

    #[test]
    fn no_point_of_a_spline_is_nearer() {
        for is_closed in [false, true] {
            let spline = Spline::through(&wild(9), is_closed).unwrap();
            let nearest = NearestOnCurve::new(&spline).unwrap();
            let [start, end] = spline.range();
            let all: Vec<DVec3> =
                (0..20_000).map(|i| spline.point(start + (end - start) * f64::from(i) / 2e4)).collect();
            let mut ends = 0;
            for i in 0..200 {
                let point = 2.0 * scattered(i) + DVec3::new(4.0, 0.0, 0.0);
                let foot = nearest.nearest(point);
                let brute = all.iter().map(|other| other.distance(point)).fold(f64::INFINITY, f64::min);
                assert!(foot.distance < brute + 1e-12, "{i}: {} {brute}", foot.distance);
                assert!(spline.point(foot.parameter).distance(foot.point) < 1e-14);
                if foot.end.is_none() {
                    assert!(foot.tangent.dot(point - foot.point).abs() < 1e-13 * (1.0 + foot.distance));
                } else {
                    ends += 1;
                    let outward = if foot.end == Some(End::Start) { -1.0 } else { 1.0 };
                    assert!(outward * foot.cosine >= 0.0 && !is_closed);
                }
            }
            assert!(is_closed || ends > 5);
        }
    }

    #[test]
    fn a_seed_stays_on_its_branch() {
        // The distance from (0.3, 0, 50) to y = sin x has one minimum, since (x − 0.3) + ½ sin 2x rises throughout: all seeds
        // lead there, however far.
        let wave = FnCurve::new([0.0, 4.0 * TAU], false, |t| {
            [DVec3::new(t, t.sin(), 0.0), DVec3::new(1.0, t.cos(), 0.0), DVec3::new(0.0, -t.sin(), 0.0)]
        })
        .unwrap();
        let nearest = NearestOnCurve::new(&wave).unwrap();
        let far = DVec3::new(0.3, 0.0, 50.0);
        for seed in [0.0, 1.0, 7.0, 3.0 * TAU, 4.0 * TAU] {
            let x = nearest.nearest_from(far, seed).parameter;
            assert!((x - 0.3 + 0.5 * (2.0 * x).sin()).abs() < 1e-13, "{seed}: {x}");
        }
        // A helix of many narrow turns about z, seen from the x axis beside it: one foot in each turn.
        let helix = FnCurve::new([0.0, 10.0 * TAU], false, |t| {
            let (s, c) = t.sin_cos();
            [DVec3::new(c, s, 0.1 * t), DVec3::new(-s, c, 0.1), DVec3::new(-c, -s, 0.0)]
        })
        .unwrap();
        let nearest = NearestOnCurve::new(&helix).unwrap();
        let point = DVec3::new(3.0, 0.0, 0.1 * TAU * 5.0);
        for turn in 3..8 {
            let foot = nearest.nearest_from(point, TAU * f64::from(turn) + 0.3);
            assert!((foot.parameter - TAU * f64::from(turn)).abs() < 0.3, "{turn}: {}", foot.parameter);
            assert!(foot.tangent.dot(point - foot.point).abs() < 1e-13);
        }
        assert!((nearest.nearest(point).parameter - 5.0 * TAU).abs() < 1e-12);
    }

    #[test]
    fn ends_and_cusps_are_feet_too() {
        let segment = Spline::through(&[DVec3::ZERO, DVec3::X], false).unwrap();
        let nearest = NearestOnCurve::new(&segment).unwrap();
        let foot = nearest.nearest(DVec3::new(-1.0, 1.0, 0.0));
        assert_eq!((foot.end, foot.point), (Some(End::Start), DVec3::ZERO));
        assert!((foot.cosine + 0.5_f64.sqrt()).abs() < 1e-15);
        let foot = nearest.nearest_from(DVec3::new(1.0, 1.0, 0.0), 0.2);
        assert_eq!((foot.end, foot.point, foot.cosine), (Some(End::Finish), DVec3::X, 0.0));
        let cusp = FnCurve::new([-1.0, 1.0], false, |t| {
            [DVec3::new(t * t, t * t * t, 0.0), DVec3::new(2.0 * t, 3.0 * t * t, 0.0), DVec3::new(2.0, 6.0 * t, 0.0)]
        })
        .unwrap();
        let foot = NearestOnCurve::new(&cusp).unwrap().nearest(DVec3::new(-1.0, 0.3, 0.0));
        assert!(foot.point.length() < 1e-6 && foot.tangent.is_finite());
        let hole = |t: f64| [if t == 0.5 { DVec3::NAN } else { DVec3::X * t }, DVec3::X, DVec3::ZERO];
        let hole = FnCurve::new([0.0, 1.0], false, hole).unwrap();
        let error = NearestOnCurve::new(&hole).unwrap_err().to_string();
        assert!(error.starts_with("curve: curve[128]: expected finite coordinates"), "{error}");
    }
}
