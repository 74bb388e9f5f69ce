//! Where two strips meet: gaps, and kinks between their tangent planes.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Inside;
use crate::error::Result;
use crate::geometry::ruled::Strip;
use crate::mesh::curve::{Curve, NearestOnCurve};

/// A nearest point at an end of a boundary counts as beside it, not beyond, while the cosine of the angle is below this.
const BESIDE: f64 = 1e-6;

/// How two strips meet.
///
/// Along their common boundary, each strip has a tangent plane: through the tangent of its boundary and its ruling. The kink is the
/// angle between the two, 0 where the strips go on smoothly, 180 degrees where one lies on the other (Flöry et al. 2012, section
/// 1: smooth if and only if the planes of a ruling, the boundary and the next ruling agree). It is measured, not optimised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct JointReport {
    /// The strip whose second boundary it is, and the one whose first.
    pub strips: [usize; 2],
    /// The number of samples of gaps: those on either boundary that are beside the other, not beyond its end, and beside the
    /// reference. If 0, all gaps are 0 too.
    pub gap_count: usize,
    /// The greatest distance of a sample from the other boundary, in model units.
    pub max_gap: f64,
    /// The sample that has it.
    pub max_gap_at: [f64; 3],
    /// The mean distance.
    pub mean_gap: f64,
    /// The number of samples of kinks: fewer than those of gaps where a strip has no tangent plane.
    pub kink_count: usize,
    /// The greatest kink, in degrees.
    pub max_kink_deg: f64,
    /// The sample that has it.
    pub max_kink_at: [f64; 3],
    /// The mean kink, in degrees.
    pub mean_kink_deg: f64,
}

/// The joints of strips that each meet the next; of a ring the last meets the first.
pub fn consecutive(count: usize, is_ring: bool) -> Vec<[usize; 2]> {
    let pairs = if is_ring { count } else { count.saturating_sub(1) };
    (0..pairs).map(|i| [i, (i + 1) % count]).collect()
}

/// A joint, and the sums of its gaps and kinks.
pub(super) fn joint(
    strips: &[Strip],
    joint: [usize; 2],
    inside: &Inside<'_>,
    samples_along: usize,
) -> Result<(JointReport, [f64; 2])> {
    let sides = [(&strips[joint[0]], 1), (&strips[joint[1]], 0)];
    let mut found = JointReport { strips: joint, ..JointReport::default() };
    let mut sums = [0.0; 2];
    for (from, to) in [(sides[0], sides[1]), (sides[1], sides[0])] {
        let curve = NearestOnCurve::new(to.0.boundary(to.1))?;
        let samples = samples_along * from.0.basis().spans();
        for i in 0..=samples {
            let u = from.0.length_u() * i as f64 / samples as f64;
            let point = from.0.boundary(from.1).point(u);
            let foot = curve.nearest(point);
            let is_beyond = foot.end.is_some() && foot.cosine.abs() > BESIDE && foot.distance > inside.tolerance;
            if is_beyond || !inside.has(point) {
                continue;
            }
            if found.gap_count == 0 || foot.distance > found.max_gap {
                (found.max_gap, found.max_gap_at) = (foot.distance, point.to_array());
            }
            found.gap_count += 1;
            sums[0] += foot.distance;
            let Some(kink) = kink_deg((from.0, from.1, u), (to.0, to.1, foot.parameter)) else { continue };
            if found.kink_count == 0 || kink > found.max_kink_deg {
                (found.max_kink_deg, found.max_kink_at) = (kink, point.to_array());
            }
            found.kink_count += 1;
            sums[1] += kink;
        }
    }
    found.mean_gap = sums[0] / found.gap_count.max(1) as f64;
    found.mean_kink_deg = sums[1] / found.kink_count.max(1) as f64;
    Ok((found, sums))
}

/// The kink between two strips, each with the side and the parameter of the boundary where they meet.
///
/// With `t` the tangent and `r` the ruling inward, the half-planes of both strips go on into each other where `t × (−r)` of one is
/// along `t × r` of the other. The second strip's own tangent is taken, turned to the same way.
fn kink_deg(first: (&Strip, usize, f64), second: (&Strip, usize, f64)) -> Option<f64> {
    let plane = |(strip, side, u): (&Strip, usize, f64)| -> (DVec3, DVec3) {
        let ends = strip.ruling(u);
        (strip.boundary(side).tangent(u), ends[1 - side] - ends[side])
    };
    let ((t, r), (other_t, other_r)) = (plane(first), plane(second));
    let other_t = if t.dot(other_t) < 0.0 { -other_t } else { other_t };
    let (before, after) = (t.cross(-r).try_normalize()?, other_t.cross(other_r).try_normalize()?);
    Some(before.cross(after).length().atan2(before.dot(after)).to_degrees())
}
