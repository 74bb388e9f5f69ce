//! Which level curves follow which, and strips between them.
//!
//! Usually one curve follows one. Where a level leaves the surface in its middle, several short curves follow a long one (or a long
//! one several). What is between them goes up to the rim; it is covered by a strip whose other boundary is a *bridge*: the short
//! curves, joined beyond the rim by the points of the long one moved along the field. The short curves are then the boundaries of
//! strips of their own, which meet the bridge's. Around a saddle of the level function nothing like this is there, and no strip.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use glam::DVec3;

use super::boundaries::{Boundaries, BoundaryOptions};
use super::boundary::Boundary;
use super::rim::{MARGIN, Rim};
use super::tracing::{End, Sense};
use crate::mesh::SurfacePoint;

/// From so many places along a curve it is looked which curve of the next level, or of the one before, the field leads to.
const PROBES: usize = 5;

/// A curve is followed by one that is shorter than it by this factor at most, or a bridge is between: the extension of the shorter
/// one is a straight line, which soon is no boundary any more.
const MOST_SHORTER: f64 = 3.0;

/// Beside the first and the last of the short curves, as beside those of any strip, some of the long one leads to the rim, which
/// extensions are for; if it is more than this part of it a bridge goes on there.
const MOST_BESIDE: f64 = 0.25;

/// What is ahead of a curve, or behind it.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Next {
    /// This one of the next group.
    Curve(usize),
    /// A bridge over these.
    Bridge(Vec<usize>),
    /// The rim of the surface.
    Rim,
    /// A strip that has this curve as a part of its boundary; or none, as around a saddle.
    Other,
}

/// Level curves of several levels, each level a group.
pub(super) struct Matching<'a> {
    rim: &'a Rim<'a>,
    groups: Vec<Vec<Boundary>>,
    /// The level function.
    value: &'a dyn Fn(SurfacePoint) -> f64,
}

impl<'a> Matching<'a> {
    pub fn new(rim: &'a Rim<'a>, groups: Vec<Vec<Boundary>>, value: &'a dyn Fn(SurfacePoint) -> f64) -> Self {
        Self { rim, groups, value }
    }

    /// Puts curves that follow each other into chains, and completes each.
    pub fn chained(&self, options: &BoundaryOptions) -> Boundaries {
        let mut found = Boundaries::default();
        // What is ahead of each curve, and behind it.
        let of = |group: &Vec<Boundary>| vec![[Next::Rim, Next::Rim]; group.len()];
        let mut next: Vec<Vec<[Next; 2]>> = self.groups.iter().map(of).collect();
        for k in 1..self.groups.len() {
            let [ahead, behind] = self.between(k - 1);
            let is_lost = |next: &Next| *next == Next::Other;
            let mut is_unmatched = ahead.iter().all(is_lost) && behind.iter().all(is_lost);
            is_unmatched |= ahead.iter().zip(0..).any(|(next, i)| {
                is_lost(next) && !behind.iter().any(|back| matches!(back, Next::Bridge(of) if of.contains(&i)))
            });
            is_unmatched |= behind.iter().zip(0..).any(|(next, j)| {
                is_lost(next) && !ahead.iter().any(|front| matches!(front, Next::Bridge(of) if of.contains(&j)))
            });
            if is_unmatched {
                found.unmatched.push(self.groups[k - 1][0].level);
            }
            ahead.into_iter().zip(&mut next[k - 1]).for_each(|(ahead, next)| next[0] = ahead);
            behind.into_iter().zip(&mut next[k]).for_each(|(behind, next)| next[1] = behind);
        }
        let (mut numbers, mut bridges) = (BTreeMap::new(), Vec::new());
        for (first, group) in next.iter().enumerate() {
            for i in (0..group.len()).filter(|&i| !matches!(group[i][1], Next::Curve(_))) {
                let (mut members, mut at) = (Vec::new(), (first, i));
                loop {
                    members.push(at);
                    match next[at.0][at.1][0] {
                        Next::Curve(j) => at = (at.0 + 1, j),
                        _ => break,
                    }
                }
                let mut chain: Vec<Boundary> = members.iter().map(|&(k, i)| self.groups[k][i].clone()).collect();
                let (behind, ahead) = (&group[i][1], &next[at.0][at.1][0]);
                let overshoots = [behind, ahead].map(|end| *end == Next::Rim && options.overshoots);
                let before = self.bridge_at((first, i), behind, false);
                let after = self.bridge_at(at, ahead, true);
                let inserted = usize::from(before.is_some());
                chain.splice(0..0, before.clone().map(|(bridge, _)| bridge));
                chain.extend(after.clone().map(|(bridge, _)| bridge));
                let start = found.boundaries.len();
                let completed = self.rim.complete(chain, false, options.extends, overshoots);
                // Beyond the surface altogether are only boundaries that were added.
                let added = usize::from(completed[0].on_surface.iter().all(Option::is_none));
                let at_member = start + added + inserted;
                numbers.extend(members.iter().enumerate().map(|(k, &member)| (member, at_member + k)));
                bridges.extend(before.map(|(_, of)| (start + added, false, of)));
                bridges.extend(after.map(|(_, of)| (at_member + members.len(), true, of)));
                found.boundaries.extend(completed);
                found.strips.extend((start + 1..found.boundaries.len()).map(|k| [k - 1, k]));
            }
        }
        for (bridge, is_after, of) in bridges {
            let pairs = of.iter().filter_map(|member| numbers.get(member));
            found.meets.extend(pairs.map(|&other| if is_after { [bridge, other] } else { [other, bridge] }));
        }
        found
    }

    /// The bridge ahead of a curve or behind it, and which curves it is over.
    fn bridge_at(
        &self,
        (k, i): (usize, usize),
        next: &Next,
        is_ahead: bool,
    ) -> Option<(Boundary, Vec<(usize, usize)>)> {
        let Next::Bridge(of) = next else { return None };
        let other = if is_ahead { k + 1 } else { k.checked_sub(1)? };
        let bridge = self.bridge(&self.groups[k][i], other, of, is_ahead)?;
        Some((bridge, of.iter().map(|&j| (other, j)).collect()))
    }

    /// What is ahead of the curves of a group, and behind those of the next.
    fn between(&self, k: usize) -> [Vec<Next>; 2] {
        let [own, others] = [&self.groups[k], &self.groups[k + 1]];
        let mut is_hit = vec![vec![false; others.len()]; own.len()];
        for (i, curve) in own.iter().enumerate() {
            self.probes(curve, others, true).into_iter().for_each(|j| is_hit[i][j] = true);
        }
        for (j, curve) in others.iter().enumerate() {
            self.probes(curve, own, false).into_iter().for_each(|i| is_hit[i][j] = true);
        }
        let ahead: Vec<Vec<usize>> =
            is_hit.iter().map(|hits| (0..others.len()).filter(|&j| hits[j]).collect()).collect();
        let behind: Vec<Vec<usize>> =
            (0..others.len()).map(|j| (0..own.len()).filter(|&i| is_hit[i][j]).collect()).collect();
        let next = |i: usize, is_ahead: bool| {
            let [(one, hits), (other, back)] =
                if is_ahead { [(own, &ahead), (others, &behind)] } else { [(others, &behind), (own, &ahead)] };
            let lengths = |j: usize| (one[i].length(), other[j].length());
            match hits[i][..] {
                [] => Next::Rim,
                [j] if back[j].len() == 1 && lengths(j).0 <= MOST_SHORTER * lengths(j).1 => {
                    if lengths(j).1 <= MOST_SHORTER * lengths(j).0 { Next::Curve(j) } else { Next::Other }
                }
                _ if hits[i].iter().all(|&j| back[j].len() == 1) => {
                    let other = if is_ahead { k + 1 } else { k };
                    let bridge = self.bridge(&one[i], other, &hits[i], is_ahead);
                    bridge.map_or(Next::Other, |_| Next::Bridge(hits[i].clone()))
                }
                _ => Next::Other,
            }
        };
        [(0..own.len()).map(|i| next(i, true)).collect(), (0..others.len()).map(|j| next(j, false)).collect()]
    }

    /// Which of `others`, of one level, the field leads to from places along a curve.
    fn probes(&self, curve: &Boundary, others: &[Boundary], is_ahead: bool) -> Vec<usize> {
        let place = |probe: usize| (probe * 2 + 1) * curve.points.len() / (2 * PROBES);
        let hit = |probe: usize| self.reached((*curve.on_surface.get(place(probe))?)?, others, is_ahead)?.ok();
        (0..PROBES).filter_map(hit).map(|(j, _)| j).collect()
    }

    /// Which of some curves the field leads to from a point, and how far that is; an error if it is the rim, none if it is neither.
    fn reached(&self, from: SurfacePoint, others: &[Boundary], is_ahead: bool) -> Option<Result<(usize, f64), f64>> {
        let level = others[0].level;
        let sense = if is_ahead { Sense::Forward } else { Sense::Backward };
        let followed = self.rim.follow(from, sense, |at| {
            let is_there = ((self.value)(at) >= level) == is_ahead;
            if is_there { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        let way = followed.position.distance(self.rim.position(from));
        match followed.end {
            End::Caller => Some(Ok((nearest(others, followed.position), way))),
            End::Boundary | End::Unknown => Some(Err(way)),
            End::Length | End::Steps => None,
        }
    }

    /// Some curves of a group, joined by points of `along` moved along the field where it leads to the rim. None where the field
    /// goes in circles or leads from one curve to the other without the rim between, as it does around a saddle; or if a curve is
    /// closed.
    fn bridge(&self, along: &Boundary, group: usize, of: &[usize], is_ahead: bool) -> Option<Boundary> {
        let others = &self.groups[group];
        if along.is_closed || of.iter().any(|&j| others[j].is_closed) {
            return None;
        }
        let count = along.points.len();
        let reached: Vec<_> = along
            .on_surface
            .iter()
            .map(|at| at.map_or(Some(Err(0.0)), |at| self.reached(at, others, is_ahead)))
            .collect::<Option<_>>()?;
        let hits: Vec<(usize, usize, f64)> =
            (0..count).filter_map(|i| reached[i].ok().map(|(j, way)| (i, j, way))).collect();
        let places: Vec<f64> = std::iter::once(0.0)
            .chain(along.points.windows(2).scan(0.0, |at, pair| {
                *at += pair[0].distance(pair[1]);
                Some(*at)
            }))
            .collect();
        let length = places[count - 1];
        let (first, last) = (hits.first()?, hits.last()?);
        // Runs of points between hits of different curves, or beyond the first and the last if that is much.
        let mut joined = Joined { rim: self.rim, along, sign: if is_ahead { 1.0 } else { -1.0 }, points: Vec::new() };
        let mut used = Vec::new();
        if places[first.0] > MOST_BESIDE * length {
            joined.add_moved(0..first.0, &reached, |_| first.2);
        }
        joined.add_curve(&others[first.1]);
        used.push(first.1);
        for pair in hits.windows(2).filter(|pair| pair[0].1 != pair[1].1) {
            let [(from, _, a), (to, j, b)] = [pair[0], pair[1]];
            if to == from + 1 || used.contains(&j) {
                return None;
            }
            let part = |i: usize| (places[i] - places[from]) / (places[to] - places[from]);
            joined.add_moved(from + 1..to, &reached, |i| a + part(i) * (b - a));
            joined.add_curve(&others[j]);
            used.push(j);
        }
        if length - places[last.0] > MOST_BESIDE * length {
            joined.add_moved(last.0 + 1..count, &reached, |_| last.2);
        }
        let is_all = used.len() == of.len() && of.iter().all(|j| used.contains(j));
        let (points, on_surface) = joined.points.into_iter().unzip();
        let mut bridge = Boundary { points, on_surface, is_closed: false, level: others[of[0]].level };
        bridge.merge(self.rim.mean_edge());
        (is_all && bridge.points.len() > 2).then_some(bridge)
    }
}

/// A bridge that is being made.
struct Joined<'a> {
    rim: &'a Rim<'a>,
    along: &'a Boundary,
    sign: f64,
    points: Vec<(DVec3, Option<SurfacePoint>)>,
}

impl Joined<'_> {
    /// Adds points of the long curve moved by `way`, at least beyond the rim.
    fn add_moved(
        &mut self,
        range: std::ops::Range<usize>,
        reached: &[Result<(usize, f64), f64>],
        way: impl Fn(usize) -> f64,
    ) {
        let directions = self.rim.directions(self.along);
        for i in range {
            if let (Some(direction), Err(to_rim)) = (directions[i], reached[i]) {
                let by = self.sign * way(i).max((1.0 + MARGIN) * to_rim);
                self.add(self.along.points[i] + by * direction, None);
            }
        }
    }

    /// Adds a curve, without the moved points before it that are beside it.
    fn add_curve(&mut self, curve: &Boundary) {
        let (start, inward) = (curve.points[0], curve.points[1] - curve.points[0]);
        let is_beside = |(p, at): &(DVec3, Option<SurfacePoint>)| at.is_none() && (*p - start).dot(inward) >= 0.0;
        while self.points.last().is_some_and(is_beside) {
            self.points.pop();
        }
        self.points.extend(curve.points.iter().copied().zip(curve.on_surface.iter().copied()));
    }

    /// Adds a point unless it is beside the end of a curve rather than after it.
    fn add(&mut self, point: DVec3, at: Option<SurfacePoint>) {
        if let [.., (before, _), (last, Some(_))] = self.points[..]
            && (point - last).dot(last - before) <= 0.0
        {
            return;
        }
        self.points.push((point, at));
    }
}

fn nearest(curves: &[Boundary], point: DVec3) -> usize {
    let distance =
        |curve: &Boundary| curve.points.iter().map(|p| p.distance_squared(point)).fold(f64::INFINITY, f64::min);
    (0..curves.len()).min_by(|&a, &b| distance(&curves[a]).total_cmp(&distance(&curves[b]))).unwrap_or(0)
}
