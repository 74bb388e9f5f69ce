//! Boundary loops of a reference surface in the parameters of a strip.

use glam::DVec3;

use super::Contour;
use crate::error::{Error, Result, Status};
use crate::geometry::ruled::Strip;
use crate::geometry::ruled::coverage::NearestStrip;
use crate::mesh::TriangleMesh;

/// An edge is halved so often at most: where its nearest points jump, no halving helps;
const MOST_HALVINGS: usize = 32;

/// and into so many pieces: near the strip's centres of curvature nearest points are all jumps.
const MOST_PIECES: usize = 2000;

/// Where, beside its middle, the nearest points of a piece of an edge are compared with a straight line: not at a simple fraction,
/// where a piece that is bent at one point could look straight.
const PROBE: f64 = 0.293;

/// The loops as closed polygons of parameters `(u, v)`; their even-odd parity is that of the loops' nearest points.
pub(super) fn outlines(strip: &Strip, mesh: &TriangleMesh, tolerance: f64) -> Result<Vec<Contour>> {
    let none = || Error::new(Status::Degenerate, "expected a strip of a finite size above 0").at("strip");
    let search = NearestStrip::new(std::slice::from_ref(strip)).filter(|_| !strip.is_point()).ok_or_else(none)?;
    let projection = Projection { strip, locate: |point| search.nearest(point).parameters, tolerance };
    let points = |boundary: &Vec<u32>| boundary.iter().map(|&i| mesh.points()[i as usize]).collect::<Vec<_>>();
    Ok(mesh.boundary().iter().flat_map(|boundary| projection.outline(&points(boundary))).collect())
}

struct Projection<'a, F> {
    strip: &'a Strip,
    locate: F,
    tolerance: f64,
}

/// Parameters this near to an end of their range, over the range, are on it.
const ON_SIDE: f64 = 1e-12;

/// Corners are dropped within this part of the tolerance,
const SIMPLER: f64 = 0.1;

/// and so many in a row at most.
const MOST_DROPPED: usize = 64;

/// Two places of a strip are one if they are no farther apart than the tolerance, and their parameters than this, in the unit square:
/// a strip may come near itself.
const NEAR: f64 = 1e-3;

/// A point of the loop with its parameters.
#[derive(Clone, Copy)]
struct Located {
    point: DVec3,
    at: [f64; 2],
}

impl<F: Fn(DVec3) -> [f64; 2]> Projection<'_, F> {
    fn located(&self, point: DVec3) -> Located {
        let [u, v] = (self.locate)(point);
        // Newton's method comes to a side of the rectangle up to rounding.
        let put = |at: f64, last: f64| match at / last {
            part if part < ON_SIDE => 0.0,
            part if part > 1.0 - ON_SIDE => last,
            _ => at,
        };
        Located { point, at: [put(u, self.strip.length_u()), put(v, 1.0)] }
    }

    /// A loop as closed polygons: one, but of a closed strip a polygon for each part between two crossings of the seam.
    fn outline(&self, points: &[DVec3]) -> Vec<Contour> {
        let corners: Vec<Located> = points.iter().map(|&point| self.located(point)).collect();
        let mut curve = Vec::with_capacity(2 * corners.len());
        for (i, &corner) in corners.iter().enumerate() {
            let (next, mut budget) = (corners[(i + 1) % corners.len()], MOST_PIECES);
            self.extend(corner, next, MOST_HALVINGS, &mut budget, &mut curve);
        }
        let is_same = |a: [f64; 2], b: [f64; 2]| {
            let position = |at: [f64; 2]| self.strip.at(at[0], at[1]).point;
            let is_near = self.step(a[0], b[0]).abs() < NEAR * self.strip.length_u() && (a[1] - b[1]).abs() < NEAR;
            is_near && position(a).distance(position(b)) <= self.tolerance
        };
        let curve = self.simplified(without_spikes(self.without_runs(curve), is_same));
        if self.strip.basis().is_closed() { at_seam(&curve, self.strip.length_u()) } else { vec![curve] }
    }

    /// Adds the nearest points from `start`, which is added by the piece before, to `end`: as many as a polygon needs.
    ///
    /// Where a point of the boundary passes beyond the strip, its nearest point turns and runs along the strip's own boundary;
    /// halving meets such a bend up to the tolerance. Along that boundary it does not matter how a curve runs, as no face is
    /// beyond: there, where most of the reference's boundary has its nearest points, nothing is halved.
    fn extend(&self, start: Located, end: Located, halvings: usize, budget: &mut usize, curve: &mut Contour) {
        *budget = budget.saturating_sub(1);
        let apart = |fraction: f64| {
            let found = self.located(start.point.lerp(end.point, fraction));
            let straight = self.between(start.at, end.at, fraction);
            let found_point = self.strip.at(found.at[0], found.at[1]).point;
            (found, found_point.distance(self.strip.at(straight[0], straight[1]).point))
        };
        let (middle, bend) = apart(0.5);
        let is_straight =
            |other: Located, bend: f64| bend <= self.tolerance || self.are_on_one_side([start.at, other.at, end.at]);
        let is_probed = || {
            let (probe, bend) = apart(PROBE);
            is_straight(probe, bend)
        };
        if halvings == 0 || *budget == 0 || (is_straight(middle, bend) && is_probed()) {
            curve.push(end.at);
        } else {
            self.extend(start, middle, halvings - 1, budget, curve);
            self.extend(middle, end, halvings - 1, budget, curve);
        }
    }

    /// Whether parameters are on one side of the rectangle.
    fn are_on_one_side(&self, all: [[f64; 2]; 3]) -> bool {
        let on = |axis: usize, end: f64| all.iter().all(|at| at[axis] == end);
        let is_at_end = !self.strip.basis().is_closed() && (on(0, 0.0) || on(0, self.strip.length_u()));
        is_at_end || on(1, 0.0) || on(1, 1.0)
    }

    /// Without what lies between the first and the last of corners that follow each other on one side of the rectangle: how a curve
    /// runs there does not matter, and overlapping edges by the thousand are slow to clip.
    fn without_runs(&self, curve: Contour) -> Contour {
        let mut kept = Contour::with_capacity(curve.len());
        for at in curve {
            if let [.., before, last] = kept[..]
                && self.are_on_one_side([before, last, at])
            {
                kept.pop();
            }
            kept.push(at);
        }
        kept
    }

    /// Without the corners that a straight line from one corner to a later one passes within a part of the tolerance: the points of
    /// the reference along a straight side would only make slivers.
    fn simplified(&self, curve: Contour) -> Contour {
        let position = |at: [f64; 2]| self.strip.at(at[0], at[1]).point;
        let points: Vec<DVec3> = curve.iter().map(|&at| position(at)).collect();
        let is_passed = |from: usize, to: usize| {
            let step = |i: usize| [self.step(curve[from][0], curve[i][0]), curve[i][1] - curve[from][1]];
            let [along, end] = [step(from + 1), step(to)];
            // Parameters must not turn back, and points in between be on the straight line of parameters, measured in space.
            let ahead = along[0] * end[0] + along[1] * end[1];
            ahead > 0.0
                && (from + 1..to).all(|i| {
                    let part = step(i);
                    let fraction = (part[0] * end[0] + part[1] * end[1]) / (end[0] * end[0] + end[1] * end[1]);
                    (0.0..=1.0).contains(&fraction)
                        && position(self.between(curve[from], curve[to], fraction)).distance(points[i])
                            <= SIMPLER * self.tolerance
                })
        };
        let mut kept = vec![0];
        for i in 1..curve.len() {
            let from = kept[kept.len() - 1];
            let is_last = i + 1 == curve.len();
            if is_last || i + 1 - from > MOST_DROPPED || !is_passed(from, i + 1) {
                kept.push(i);
            }
        }
        kept.into_iter().map(|i| curve[i]).collect()
    }

    /// The step from one `u` to another, on a closed strip the shorter way around.
    fn step(&self, from: f64, to: f64) -> f64 {
        let (step, length) = (to - from, self.strip.length_u());
        if self.strip.basis().is_closed() { step - length * (step / length).round() } else { step }
    }

    /// The parameters a fraction of the way from one to another, on a closed strip the shorter way around.
    fn between(&self, start: [f64; 2], end: [f64; 2], fraction: f64) -> [f64; 2] {
        let u = start[0] + fraction * self.step(start[0], end[0]);
        let u = if self.strip.basis().is_closed() { u.rem_euclid(self.strip.length_u()) } else { u };
        [u, start[1] + fraction * (end[1] - start[1])]
    }
}

/// The curve without its ways to a point and straight back. Where two places of a strip are as near to a part of the boundary, the
/// nearest one jumps to and fro between them with every rounding. By the even-odd rule such ways count for nothing; hundreds of
/// them nearly on one another would take all memory to clip.
fn without_spikes(curve: Contour, is_same: impl Fn([f64; 2], [f64; 2]) -> bool) -> Contour {
    let mut kept = Contour::with_capacity(curve.len());
    for at in curve {
        match kept[..] {
            [.., before, _] if is_same(before, at) => _ = kept.pop(),
            _ => kept.push(at),
        }
    }
    kept
}

/// A closed curve on a strip that is closed in `u` over `length`, cut at the seam. Each part from one crossing of the seam to the
/// next is closed on a way outside the rectangle, which changes the parity of all faces inside or of none.
fn at_seam(curve: &Contour, length: f64) -> Vec<Contour> {
    let count = curve.len();
    let next = |i: usize| curve[(i + 1) % count];
    let crosses = |i: usize| (next(i)[0] - curve[i][0]).abs() > 0.5 * length;
    let Some(first) = (0..count).find(|&i| crosses(i)) else { return vec![curve.clone()] };
    // Where the curve leaves the rectangle and enters it on the other side.
    let crossing = |i: usize| {
        let (from, to) = (curve[i], next(i));
        let [leave, enter] = if from[0] > to[0] { [length, 0.0] } else { [0.0, length] };
        let (before, after) = ((leave - from[0]).abs(), (to[0] - enter).abs());
        let fraction = if before + after > 0.0 { before / (before + after) } else { 0.0 };
        let v = from[1] + fraction * (to[1] - from[1]);
        ([leave, v], [enter, v])
    };
    let (mut parts, mut part) = (Vec::new(), vec![crossing(first).1]);
    for i in (first + 1..=first + count).map(|i| i % count) {
        part.push(curve[i]);
        if crosses(i) {
            let (leave, enter) = crossing(i);
            part.push(leave);
            parts.push(closed_outside(std::mem::replace(&mut part, vec![enter]), length));
        }
    }
    parts
}

fn closed_outside(mut part: Contour, length: f64) -> Contour {
    let outside = |at: [f64; 2]| if at[0] <= 0.0 { -1.0 } else { length + 1.0 };
    let (start, end) = (part[0], part[part.len() - 1]);
    part.extend([[outside(end), end[1]], [outside(end), -1.0], [outside(start), -1.0], [outside(start), start[1]]]);
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_to_and_fro_are_left_out() {
        let is_same = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-6;
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.1], [1.0, 0.2], [0.0, 1.0]];
        let near_b = [1.0, 0.100_000_3];
        assert_eq!(without_spikes(vec![a, b, a, near_b, a, b, a, c, d], is_same), [a, c, d]);
        assert_eq!(without_spikes(vec![a, b, c, b, a, d], is_same), [a, d]);
        assert_eq!(without_spikes(vec![a, b, c, d], is_same), [a, b, c, d]);
    }
}
