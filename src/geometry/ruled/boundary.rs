//! Strip boundaries: curves across a field, longer than the surface and beyond it, so that strips cover all of it.
//!
//! Where a strip ends at the rim of the surface, a ruling that begins on the rim between the strip's two boundaries leaves the
//! surface at once: it meets one of them only beyond its end. So each boundary is extended tangentially, as far as the lines along
//! the field at the points of the rim beside it ask for. And before the first and after the last boundary the surface is not covered
//! at all: there a boundary more is made, by moving the points of the first or last one along the field, by as much as it is to the
//! rim. What is too much is trimmed later.

use glam::DVec3;

use super::Field;
use super::walk::walk;
use crate::mesh::triangles::blend;
use crate::mesh::{SurfacePoint, TriangleMesh};

/// A line along the field that meets an extension at a smaller angle than this sine asks for nothing.
const LEAST_SINE: f64 = 0.1;

/// Extensions and overshoots are longer than what was asked for by this part of it.
const MARGIN: f64 = 0.1;

/// The least extension of an end that needs one, in mean edges.
const LEAST_EXTENSION: f64 = 0.25;

/// Points of a boundary nearer than this to the one before, in mean edges, are left out: directions between them are round-off.
const MERGED: f64 = 1e-3;

/// The least distance of an overshoot, as a part of its largest, so that rulings have a length.
const LEAST_OVERSHOOT: f64 = 0.5;

/// A strip boundary. What the field leads to is on its left, seen from where the normals point.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// Its points in order.
    pub points: Vec<DVec3>,
    /// Where on the mesh they are; none for points beyond it.
    pub on_surface: Vec<Option<SurfacePoint>>,
    /// Whether the last point is followed by the first.
    pub is_closed: bool,
    /// The value of the level function, or the number of the plane or polyline; of a boundary beyond the surface, that of the one
    /// that it was made from less or more the distance.
    pub level: f64,
}

impl Boundary {
    /// The sum of its segments, the closing one included.
    pub fn length(&self) -> f64 {
        let closing = if self.is_closed { self.points[0].distance(self.points[self.points.len() - 1]) } else { 0.0 };
        closing + self.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>()
    }

    /// Leaves out points that are hardly apart from those before; ends stay.
    pub(super) fn merge(&mut self, mean_edge: f64) {
        let count = self.points.len();
        let mut kept: Vec<usize> = Vec::with_capacity(count);
        for i in 0..count {
            let is_apart = |&k: &usize| self.points[i].distance(self.points[k]) > MERGED * mean_edge;
            if kept.last().is_none_or(is_apart) {
                kept.push(i);
            } else if i + 1 == count && !self.is_closed && kept.len() > 1 {
                kept.pop();
                kept.push(i);
            }
        }
        if self.is_closed
            && kept.len() > 1
            && self.points[0].distance(self.points[kept[kept.len() - 1]]) <= MERGED * mean_edge
        {
            kept.pop();
        }
        self.points = kept.iter().map(|&i| self.points[i]).collect();
        self.on_surface = kept.iter().map(|&i| self.on_surface[i]).collect();
    }

    fn reach(&self, at_end: bool, least: f64) -> Option<(DVec3, DVec3)> {
        let ordered: Vec<DVec3> =
            if at_end { self.points.iter().rev().copied().collect() } else { self.points.clone() };
        let end = *ordered.first()?;
        // A chord of some length, as the last segment may be a corner of a triangle cut off.
        let inner = ordered.iter().copied().find(|p| p.distance(end) >= least).or(ordered.last().copied())?;
        Some((end, (end - inner).try_normalize()?))
    }

    fn extend(&mut self, at_end: bool, by: f64, least: f64) {
        let Some((end, outward)) = self.reach(at_end, least) else { return };
        let place = if at_end { self.points.len() } else { 0 };
        self.points.insert(place, end + by * outward);
        self.on_surface.insert(place, None);
    }
}

/// The loops of the boundary of a mesh, as places to walk along.
#[derive(Clone, Debug)]
pub(super) struct Rim<'a> {
    mesh: &'a TriangleMesh,
    field: &'a Field,
    /// For each point of the boundary its loop and place in it.
    places: Vec<(u32, u32)>,
    mean_edge: f64,
}

/// The part of the rim after a place, in one direction.
type Stretch = Vec<u32>;

impl<'a> Rim<'a> {
    pub fn new(mesh: &'a TriangleMesh, field: &'a Field) -> Self {
        let mut places = vec![(u32::MAX, 0); mesh.points().len()];
        for (l, points) in mesh.boundary().iter().enumerate() {
            points.iter().enumerate().for_each(|(k, &i)| places[i as usize] = (l as u32, k as u32));
        }
        Self { mesh, field, places, mean_edge: mesh.mean_edge() }
    }

    pub fn mean_edge(&self) -> f64 {
        self.mean_edge
    }

    /// The loop and how far along it, in points, a point of the boundary is; none inside.
    fn place(&self, at: Option<SurfacePoint>) -> Option<(usize, f64)> {
        let at = at?;
        let (t, corners) = (at.triangle as usize, self.mesh.triangles()[at.triangle as usize]);
        let of = |k: usize| self.places[corners[k] as usize];
        if let Some(k) = (0..3).find(|&k| at.weights[k] == 1.0 && self.mesh.is_on_boundary(corners[k] as usize)) {
            return Some((of(k).0 as usize, f64::from(of(k).1)));
        }
        let k = (0..3).find(|&k| at.weights[(k + 2) % 3] == 0.0 && self.mesh.across(t, k).is_none())?;
        Some((of(k).0 as usize, f64::from(of(k).1) + at.weights[(k + 1) % 3]))
    }

    /// The points of the rim from one place to another on the same loop, forward or backward.
    fn stretch(&self, from: Option<SurfacePoint>, to: Option<SurfacePoint>, is_forward: bool) -> Stretch {
        let (Some((l, a)), Some((other, b))) = (self.place(from), self.place(to)) else { return Vec::new() };
        if l != other {
            return Vec::new();
        }
        let points = &self.mesh.boundary()[l];
        let count = points.len();
        let (low, high) = if is_forward { (a, b) } else { (b, a) };
        let high = if high < low { high + count as f64 } else { high };
        let span = (low.floor() as usize + 1)..=(high.ceil() as usize).saturating_sub(1);
        let mut stretch: Stretch = span.map(|k| points[k % count]).collect();
        if !is_forward {
            stretch.reverse();
        }
        stretch
    }

    /// How far beyond an end the lines along the field from these points of the rim meet the tangent, at most, and how far that is
    /// from the rim.
    ///
    /// On `P + e T` and `r + s a` the points nearest to each other have, with `d = r − P` and `c = T·a`,
    /// `e = (d·T − c d·a)/(1 − c²)` and `s = (c d·T − d·a)/(1 − c²)`.
    fn asked(&self, (end, outward): (DVec3, DVec3), stretch: &[u32]) -> [f64; 2] {
        let mut most = [0.0_f64; 2];
        for &i in stretch.iter().filter(|&&i| self.field.is_known()[i as usize]) {
            let (a, apart) = (self.field.directions()[i as usize], self.mesh.points()[i as usize] - end);
            let c = outward.dot(a);
            if 1.0 - c * c >= LEAST_SINE * LEAST_SINE {
                let beyond = (apart.dot(outward) - c * apart.dot(a)) / (1.0 - c * c);
                let along = (c * apart.dot(outward) - apart.dot(a)) / (1.0 - c * c);
                // Lines that run nearly along the boundary must not take it far away.
                if beyond > 0.0 {
                    most[0] = most[0].max(beyond.min(2.0 * apart.length()));
                    most[1] = most[1].max(along.abs().min(2.0 * apart.length()));
                }
            }
        }
        most
    }

    /// The stretches of rim beside each end of an open boundary, start and end, towards the boundary before and after it. Along the
    /// rim the surface is to the left, so what follows a boundary lies backward from its start and forward from its end. Without
    /// one before or after, half of the way to its own other end.
    fn stretches(&self, own: &Boundary, neighbours: [Option<&Boundary>; 2]) -> [[Stretch; 2]; 2] {
        let ends = |boundary: &Boundary| {
            [boundary.on_surface.first(), boundary.on_surface.last()].map(|at| at.copied().flatten())
        };
        [0, 1].map(|end| {
            [0, 1].map(|side| {
                let is_forward = (end == 1) == (side == 1);
                match neighbours[side] {
                    Some(other) => self.stretch(ends(own)[end], ends(other)[end], is_forward),
                    None => {
                        let mut stretch = self.stretch(ends(own)[end], ends(own)[1 - end], is_forward);
                        stretch.truncate(stretch.len().div_ceil(2));
                        stretch
                    }
                }
            })
        })
    }

    /// Extends boundaries that follow each other, and adds one before and one after them. `is_cyclic`: the first follows the last.
    pub fn complete(
        &self,
        chain: Vec<Boundary>,
        is_cyclic: bool,
        extends: bool,
        overshoots: [bool; 2],
    ) -> Vec<Boundary> {
        let count = chain.len();
        let neighbour = |k: usize, side: usize| {
            let other = if side == 0 { (k + count - 1) % count } else { (k + 1) % count };
            let is_there = if side == 0 { k > 0 } else { k + 1 < count };
            ((is_there || is_cyclic) && count > 1).then(|| &chain[other])
        };
        let stretches: Vec<_> =
            (0..count).map(|k| self.stretches(&chain[k], [0, 1].map(|side| neighbour(k, side)))).collect();
        let mut extended = chain.clone();
        for (boundary, beside) in extended.iter_mut().zip(&stretches).filter(|_| extends) {
            self.extend(boundary, beside);
        }
        if count == 0 || is_cyclic {
            return extended;
        }
        let over = |k: usize, side: usize| {
            let reaches = [0, 1].map(|end| {
                let reach = chain[k].reach(end == 1, self.mean_edge);
                reach.map_or(0.0, |reach| self.asked(reach, &stretches[k][end][side])[1])
            });
            let mut added = overshoots[side].then(|| self.overshoot(&extended[k], side, reaches)).flatten();
            if let Some(added) = added.as_mut().filter(|_| extends) {
                self.extend(added, &stretches[k]);
            }
            added
        };
        let (before, after) = (over(0, 0), over(count - 1, 1));
        before.into_iter().chain(extended).chain(after).collect()
    }

    /// Extends the ends of an open boundary as the stretches of rim beside each ask for.
    fn extend(&self, boundary: &mut Boundary, beside: &[[Stretch; 2]; 2]) {
        if boundary.is_closed {
            return;
        }
        for end in [0, 1] {
            let Some(reach) = boundary.reach(end == 1, self.mean_edge) else { continue };
            let asked = beside[end].iter().map(|stretch| self.asked(reach, stretch)[0]).fold(0.0, f64::max);
            if asked > 0.0 {
                let by = (1.0 + MARGIN) * asked + LEAST_EXTENSION * self.mean_edge;
                boundary.extend(end == 1, by, self.mean_edge);
            }
        }
    }

    /// The boundary moved against the field (side 0) or along it (side 1), by the way to the rim; none if that is nothing.
    /// `reaches`: how far the extensions of its start and end are from the rim.
    fn overshoot(&self, from: &Boundary, side: usize, reaches: [f64; 2]) -> Option<Boundary> {
        let sign = if side == 0 { -1.0 } else { 1.0 };
        let count = from.points.len();
        // In a straight line, and none where the field goes in circles.
        let way = |at: SurfacePoint| {
            let walked = walk(self.mesh, self.field, at, sign, &mut |_| false);
            walked.is_out.then(|| self.mesh.position(walked.end).distance(self.mesh.position(at)))
        };
        let mut ways: Vec<Option<f64>> = from.on_surface.iter().map(|at| way((*at)?)).collect();
        for (i, reach) in [(0, reaches[0]), (count - 1, reaches[1])] {
            ways[i] = Some(ways[i].unwrap_or(0.0).max(reach));
        }
        let most = ways.iter().flatten().copied().fold(0.0, f64::max);
        if !(most > MERGED * self.mean_edge) {
            return None;
        }
        let way = |i: usize| ways[i].unwrap_or(0.0);
        let widened = |i: usize| {
            let near = [i.checked_sub(1), Some(i), Some(i + 1).filter(|&k| k < count)];
            let largest = near.into_iter().flatten().map(way).fold(LEAST_OVERSHOOT * most, f64::max);
            (1.0 + MARGIN) * largest
        };
        let directions = self.directions(from);
        let points = (0..count).map(|i| Some(from.points[i] + sign * widened(i) * directions[i]?));
        let level = from.level + sign * most;
        Some(Boundary { points: points.collect::<Option<_>>()?, on_surface: vec![None; count], level, ..*from })
    }

    /// The field at the points of a boundary; where it is not known, or beyond the surface, that of the nearest point along the
    /// boundary where it is.
    pub fn directions(&self, boundary: &Boundary) -> Vec<Option<DVec3>> {
        let at = |at: &Option<SurfacePoint>| self.at((*at)?);
        let mut directions: Vec<Option<DVec3>> = boundary.on_surface.iter().map(at).collect();
        for i in 1..directions.len() {
            directions[i] = directions[i].or(directions[i - 1]);
        }
        for i in (1..directions.len()).rev() {
            directions[i - 1] = directions[i - 1].or(directions[i]);
        }
        directions
    }

    /// Whether a boundary is ahead of another along the field: seen from its middle, at the nearest point of the other.
    pub fn is_ahead(&self, boundary: &Boundary, of: &Boundary) -> bool {
        let middle = boundary.points[boundary.points.len() / 2];
        let distance = |i: &usize| of.points[*i].distance_squared(middle);
        let nearest = (0..of.points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let ahead = nearest.and_then(|i| Some((middle - of.points[i]).dot(self.directions(of)[i]?)));
        ahead.is_some_and(|ahead| ahead > 0.0)
    }

    /// Turns a boundary around if the field leads to its right, and says how small the angle between them gets, in radians: 0 if the
    /// field crosses from both sides; none where the field is not known anywhere along it.
    pub fn turn(&self, boundary: &mut Boundary) -> Option<f64> {
        let sines: Vec<f64> = self.crossings(boundary).into_iter().flatten().collect();
        let sign = if sines.iter().sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
        if sign < 0.0 {
            boundary.points.reverse();
            boundary.on_surface.reverse();
        }
        let least = sines.into_iter().map(|sine| sign * sine).min_by(f64::total_cmp)?;
        Some(least.clamp(0.0, 1.0).asin())
    }

    /// The field at a point of the mesh, in the tangent plane of the blended normal.
    pub fn at(&self, at: SurfacePoint) -> Option<DVec3> {
        let corners = self.mesh.triangles()[at.triangle as usize].map(|i| i as usize);
        let is_known = (0..3).all(|k| at.weights[k] == 0.0 || self.field.is_known()[corners[k]]);
        let blended = blend(corners.map(|i| self.field.directions()[i]), at.weights);
        if is_known { blended.reject_from_normalized(self.mesh.normal_at(at)).try_normalize() } else { None }
    }

    /// The sine of the angle between a boundary and the field at each of its points on the surface, signed: above 0 if the field
    /// leads to the left; none where the field is not known. Tangents are chords that reach half of a mean edge to both sides if the
    /// boundary does, as shorter ones are noise.
    pub fn crossings(&self, boundary: &Boundary) -> Vec<Option<f64>> {
        let count = boundary.points.len();
        let reach = |i: usize, step: usize| {
            let (from, mut k) = (boundary.points[i], i);
            for _ in 1..count {
                let next = (k + step) % count;
                let is_over = !boundary.is_closed && (if step == 1 { next == 0 } else { k == 0 });
                if is_over || boundary.points[k].distance(from) >= 0.5 * self.mean_edge {
                    break;
                }
                k = next;
            }
            boundary.points[k]
        };
        let crossing = |i: usize| {
            let at = boundary.on_surface[i]?;
            let normal = self.mesh.normal_at(at);
            let along = reach(i, 1) - reach(i, count - 1);
            let left = normal.cross(along.reject_from_normalized(normal)).try_normalize()?;
            Some(left.dot(self.at(at)?))
        };
        (0..count).map(crossing).collect()
    }
}
