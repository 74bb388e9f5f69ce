//! Which control points are unknowns: all of all strips, or common boundaries once.

use glam::DVec3;

use super::Strip;
use crate::error::{Error, Result, Status};
use crate::mesh::curve::CubicBasis;
use crate::mesh::grid::diagonal;

/// Which strips are neighbours.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Joints {
    /// Pairs of strips: the second boundary of one is to be the first boundary of the other.
    pub pairs: Vec<[usize; 2]>,
    /// Whether such boundaries are one, with one set of control points, rather than pulled together. The two strips then have the
    /// same count of control points; where theirs differ at the start the means are taken.
    pub is_shared: bool,
    /// Pairs of strips that meet along a part of their boundaries only, the second boundary of one and the first of the other: what
    /// starts beside the other boundary is pulled to it, also where others are shared. A boundary may be in several pairs.
    pub partial: Vec<[usize; 2]>,
}

impl Joints {
    /// Each strip joins the next.
    pub fn chain(strip_count: usize) -> Self {
        Self { pairs: (1..strip_count).map(|i| [i - 1, i]).collect(), ..Self::default() }
    }

    /// Each strip joins the next, the last one the first.
    pub fn ring(strip_count: usize) -> Self {
        Self { pairs: (0..strip_count).map(|i| [i, (i + 1) % strip_count]).collect(), ..Self::default() }
    }
}

/// Where the control points of each boundary lie among the unknown points.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    bases: Vec<CubicBasis>,
    offsets: Vec<[usize; 2]>,
    point_count: usize,
}

impl Layout {
    /// The layout, and the unknown points of these strips.
    pub(super) fn new(strips: &[Strip], joints: &Joints) -> Result<(Self, Vec<DVec3>)> {
        if strips.is_empty() {
            return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found 0").at("strips"));
        }
        check(strips, joints)?;
        // The strip whose second boundary is the first one of each.
        let mut before = vec![None; strips.len()];
        if joints.is_shared {
            joints.pairs.iter().for_each(|&[first, second]| before[second] = Some(first));
        }
        let (mut offsets, mut point_count) = (vec![[0; 2]; strips.len()], 0);
        // A first boundary that is the second one of another strip takes its points from there.
        for (i, strip) in strips.iter().enumerate() {
            for side in [0, 1] {
                if side == 1 || before[i].is_none() {
                    offsets[i][side] = point_count;
                    point_count += strip.basis().count();
                }
            }
        }
        for i in 0..strips.len() {
            if let Some(first) = before[i] {
                offsets[i][0] = offsets[first][1];
            }
        }
        let mut sums = vec![(DVec3::ZERO, 0.0); point_count];
        for (strip, offsets) in strips.iter().zip(&offsets) {
            for side in [0, 1] {
                for (sum, point) in sums[offsets[side]..].iter_mut().zip(strip.control(side)) {
                    *sum = (sum.0 + *point, sum.1 + 1.0);
                }
            }
        }
        let points = sums.into_iter().map(|(sum, count)| sum / count).collect();
        let bases = strips.iter().map(|strip| strip.basis().clone()).collect();
        Ok((Self { bases, offsets, point_count }, points))
    }

    pub(super) fn strip_count(&self) -> usize {
        self.bases.len()
    }

    pub(super) fn point_count(&self) -> usize {
        self.point_count
    }

    pub(super) fn basis(&self, strip: usize) -> &CubicBasis {
        &self.bases[strip]
    }

    /// Which unknown point control point `i` of a boundary is.
    pub(super) fn point(&self, strip: usize, side: usize, i: usize) -> usize {
        self.offsets[strip][side] + i
    }

    /// The strips with these points; none where a point is not finite.
    pub(super) fn strips(&self, points: &[DVec3]) -> Option<Vec<Strip>> {
        let control = |i: usize, side: usize| {
            let offset = self.offsets[i][side];
            points[offset..offset + self.bases[i].count()].to_vec()
        };
        let strip = |i: usize| Strip::new(self.bases[i].clone(), [control(i, 0), control(i, 1)]).ok();
        (0..self.bases.len()).map(strip).collect()
    }

    /// The unknown points on which the point `(u, v)` of a strip depends, and how much on each.
    pub(super) fn weights(&self, strip: usize, u: f64, v: f64) -> ([u32; 8], [f64; 8]) {
        let local = self.bases[strip].at(u);
        let at = |k: usize| (k / 4, k % 4);
        let point = |k: usize| self.point(strip, at(k).0, local.functions[at(k).1]) as u32;
        let weight = |k: usize| local.values[at(k).1] * if at(k).0 == 0 { 1.0 - v } else { v };
        (std::array::from_fn(point), std::array::from_fn(weight))
    }
}

fn check(strips: &[Strip], joints: &Joints) -> Result<()> {
    let mut is_taken = vec![[false; 2]; strips.len()];
    for (k, pair) in joints.pairs.iter().enumerate() {
        for (end, &strip) in pair.iter().enumerate() {
            let place = || format!("joints.pairs[{k}][{end}]");
            if strip >= strips.len() {
                let reason = format!("{strip} is out of range for {} strips", strips.len());
                return Err(Error::new(Status::IndexOutOfRange, reason).at(place()));
            }
            if std::mem::replace(&mut is_taken[strip][end], true) {
                let side = if end == 0 { "second" } else { "first" };
                let reason = format!("the {side} boundary of strip {strip} has a neighbour already");
                return Err(Error::new(Status::InvalidValue, reason).at(place()));
            }
        }
        if joints.is_shared && pair[0] == pair[1] {
            let reason = "the two boundaries of a strip cannot be one";
            return Err(Error::new(Status::InvalidValue, reason).at(format!("joints.pairs[{k}]")));
        }
        let [first, second] = pair.map(|strip| strips[strip].basis());
        if first.is_closed() != second.is_closed() || (joints.is_shared && first != second) {
            let reason = format!(
                "expected boundaries that are both open or both closed, of one count where shared; found {} control points and {}",
                first.count(),
                second.count()
            );
            return Err(Error::new(Status::InvalidValue, reason).at(format!("joints.pairs[{k}]")));
        }
    }
    for (k, pair) in joints.partial.iter().enumerate() {
        if let Some(end) = (0..2).find(|&end| pair[end] >= strips.len()) {
            let reason = format!("{} is out of range for {} strips", pair[end], strips.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at(format!("joints.partial[{k}][{end}]")));
        }
    }
    let all: Vec<DVec3> =
        strips.iter().flat_map(|strip| [0, 1].map(|side| strip.control(side))).flatten().copied().collect();
    if !(diagonal(&all).is_finite() && diagonal(&all) > 0.0) {
        return Err(Error::new(Status::Degenerate, "expected strips of a finite size above 0").at("strips"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strips(heights: [f64; 3]) -> Vec<Strip> {
        let basis = CubicBasis::new(5, false).unwrap();
        let row = |height: f64| (0..5).map(|i| DVec3::new(f64::from(i), height, 0.0)).collect::<Vec<_>>();
        vec![
            Strip::new(basis.clone(), [row(heights[0]), row(heights[1])]).unwrap(),
            Strip::new(basis, [row(heights[1] + 0.2), row(heights[2])]).unwrap(),
        ]
    }

    #[test]
    fn shared_boundaries_are_there_once() {
        let strips = strips([0.0, 1.0, 2.0]);
        let (layout, points) = Layout::new(&strips, &Joints::chain(2)).unwrap();
        assert_eq!((layout.point_count(), points.len(), layout.strips(&points).unwrap()), (20, 20, strips.clone()));
        let (points_of, weights) = layout.weights(1, 0.7, 0.25);
        let point: DVec3 = points_of.iter().zip(weights).map(|(&i, weight)| weight * points[i as usize]).sum();
        assert!(point.distance(strips[1].at(0.7, 0.25).point) < 1e-14);
        let shared = Joints { is_shared: true, ..Joints::chain(2) };
        let (layout, points) = Layout::new(&strips, &shared).unwrap();
        assert_eq!((layout.point_count(), layout.point(0, 1, 3), layout.strip_count()), (15, layout.point(1, 0, 3), 2));
        let mean = layout.strips(&points).unwrap();
        assert_eq!((mean[0].control(1), mean[0].control(0)), (mean[1].control(0), strips[0].control(0)));
        assert!((mean[0].control(1)[2].y - 1.1).abs() < 1e-15);
        // A ring of two has no first boundary of its own.
        let ring = Joints { is_shared: true, ..Joints::ring(2) };
        let (layout, points) = Layout::new(&strips, &ring).unwrap();
        let ring = layout.strips(&points).unwrap();
        assert_eq!(
            (points.len(), ring[1].control(1), ring[0].control(1)),
            (10, ring[0].control(0), ring[1].control(0))
        );
    }

    #[test]
    fn joints_that_cannot_be_are_named() {
        let strips = strips([0.0, 1.0, 2.0]);
        let place = |pairs: Vec<[usize; 2]>| {
            Layout::new(&strips, &Joints { pairs, ..Joints::default() }).unwrap_err().place().to_owned()
        };
        assert_eq!(place(vec![[0, 2]]), "joints.pairs[0][1]");
        assert_eq!(place(vec![[0, 1], [0, 0]]), "joints.pairs[1][0]");
        let shared = Joints { is_shared: true, ..Joints::ring(1) };
        assert_eq!(Layout::new(&strips[..1], &shared).unwrap_err().place(), "joints.pairs[0]");
        let partial = Joints { partial: vec![[0, 1], [2, 1]], ..Joints::default() };
        assert_eq!(Layout::new(&strips, &partial).unwrap_err().place(), "joints.partial[1][0]");
        assert_eq!(Layout::new(&[], &Joints::default()).unwrap_err().place(), "strips");
        let other = Strip::new(CubicBasis::new(5, true).unwrap(), [0, 1].map(|side| strips[0].control(side).to_vec()));
        let mixed = [strips[0].clone(), other.unwrap()];
        assert_eq!(Layout::new(&mixed, &Joints::chain(2)).unwrap_err().place(), "joints.pairs[0]");
        let point = Strip::new(CubicBasis::new(4, false).unwrap(), [vec![DVec3::X; 4], vec![DVec3::X; 4]]).unwrap();
        assert_eq!(Layout::new(&[point], &Joints::default()).unwrap_err().status(), Status::Degenerate);
    }
}
