//! Boundaries longer than the surface and beyond it, so that strips cover all of it.
//!
//! Where a strip ends at the rim of the surface, a ruling that begins on the rim between the strip's two boundaries leaves the
//! surface at once: it meets one of them only beyond its end. So each boundary is extended tangentially, as far as the lines along
//! the field at the points of the rim beside it ask for. And before the first and after the last boundary the surface is not covered
//! at all: there a boundary more is made, by moving the points of the first or last one along the field, by as much as it is to the
//! rim. What is too much is trimmed later.

use std::ops::ControlFlow;

use glam::DVec3;

use super::Field;
use super::boundary::{Boundary, MERGED};
use super::tracing::{End, Followed, Options, Sense, Tracer};
use crate::error::Result;
use crate::mesh::triangles::blend;
use crate::mesh::{SurfacePoint, TriangleMesh};

/// A line along the field that meets an extension at a smaller angle than this sine asks for nothing.
const LEAST_SINE: f64 = 0.1;

/// Extensions and overshoots are longer than what was asked for by this part of it.
pub(super) const MARGIN: f64 = 0.1;

/// The least extension of an end on the rim, in mean edges.
const LEAST_EXTENSION: f64 = 0.25;

/// Curves of the field are followed for so many diagonals of the mesh at most.
const FAR: f64 = 1e3;

/// No boundary is extended for a ruling farther than this part of the mesh's diagonal: rulings that spread ask the more the farther they
/// are from the surface.
const FARTHEST: f64 = 0.25;

/// The least distance of an overshoot, as a part of its largest, so that rulings have a length.
const LEAST_OVERSHOOT: f64 = 0.5;

/// A point is moved as far as any of so many to both sides: from the end of a curve on the rim the field may run along the rim, and
/// out at once.
const BESIDE: usize = 3;

/// The loops of the boundary of a mesh, as places to walk along.
#[derive(Clone, Debug)]
pub(super) struct Rim<'a> {
    mesh: &'a TriangleMesh,
    field: &'a Field,
    tracer: Tracer<'a>,
    /// For each point of the boundary its loop and place in it.
    places: Vec<(u32, u32)>,
    mean_edge: f64,
}

/// The part of the rim after a place, in one direction.
type Stretch = Vec<u32>;

impl<'a> Rim<'a> {
    /// # Errors
    /// A field of another mesh (`field`).
    pub fn new(mesh: &'a TriangleMesh, field: &'a Field) -> Result<Self> {
        // A curve that takes more steps than this goes in circles.
        let options = Options { most_steps: mesh.triangles().len() + 100, ..Options::default() };
        let tracer = Tracer::new(mesh, field, &options)?;
        let mut places = vec![(u32::MAX, 0); mesh.points().len()];
        for (l, points) in mesh.boundary().iter().enumerate() {
            points.iter().enumerate().for_each(|(k, &i)| places[i as usize] = (l as u32, k as u32));
        }
        Ok(Self { mesh, field, tracer, places, mean_edge: mesh.mean_edge() })
    }

    /// Where the field leads to from a point, until `step` says to stop; none if the point is none of the mesh.
    pub fn follow(
        &self,
        from: SurfacePoint,
        sense: Sense,
        mut step: impl FnMut(SurfacePoint) -> ControlFlow<()>,
    ) -> Option<Followed> {
        self.tracer.follow(from, sense, FAR * self.mesh.diagonal(), |_, followed| step(followed.at)).ok()
    }

    /// Where a point of the mesh is.
    pub fn position(&self, at: SurfacePoint) -> DVec3 {
        self.mesh.position(at)
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

    /// How far beyond an end the lines along the field from these points of the rim pass the tangent, at most, and how far that is
    /// from the rim.
    fn asked(&self, reach: (DVec3, DVec3), stretch: &[u32]) -> [f64; 2] {
        let known = stretch.iter().map(|&i| i as usize).filter(|&i| self.field.is_known()[i]);
        known.fold([0.0; 2], |most, i| {
            let passed = passed(reach, self.mesh.points()[i], self.field.directions()[i]);
            [most[0].max(passed[0]), most[1].max(passed[1])]
        })
    }

    /// The stretches of rim beside each end of an open boundary, start and end, towards the boundary before and after it. Along the
    /// rim the surface is to the left, so what follows a boundary lies backward from its start and forward from its end. Without
    /// one before or after, half of the way to its own other end if one beyond the surface is added there (`overshoots`).
    fn stretches(
        &self,
        own: &Boundary,
        neighbours: [Option<&Boundary>; 2],
        overshoots: [bool; 2],
    ) -> [[Stretch; 2]; 2] {
        let ends = |boundary: &Boundary| {
            [boundary.on_surface.first(), boundary.on_surface.last()].map(|at| at.copied().flatten())
        };
        [0, 1].map(|end| {
            [0, 1].map(|side| {
                let is_forward = (end == 1) == (side == 1);
                match neighbours[side] {
                    Some(other) => self.stretch(ends(own)[end], ends(other)[end], is_forward),
                    None if !overshoots[side] => Vec::new(),
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
            (0..count).map(|k| self.stretches(&chain[k], [0, 1].map(|side| neighbour(k, side)), overshoots)).collect();
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
            let beside = stretches[k].iter().flat_map(|end| end[side].iter().copied());
            let mut added = overshoots[side].then(|| self.overshoot(&extended[k], side, reaches, beside)).flatten();
            if let Some(added) = added.as_mut().filter(|_| extends) {
                self.extend(added, &stretches[k]);
            }
            added
        };
        let (before, after) = (over(0, 0), over(count - 1, 1));
        let mut completed: Vec<Boundary> = before.into_iter().chain(extended).chain(after).collect();
        if extends {
            // Each is extended to where the ruling from its neighbour's end leads, backward, then forward. A boundary that was
            // extended by what the one ahead asked for then asks as much of the one behind, and rulings of both end on each other.
            for k in (1..completed.len()).rev() {
                let (behind, own) = completed.split_at_mut(k);
                self.extend_to_ruling(&mut behind[k - 1], &own[0]);
            }
            for k in 1..completed.len() {
                let (own, ahead) = completed.split_at_mut(k);
                self.extend_to_ruling(&mut ahead[0], &own[k - 1]);
            }
        }
        completed
    }

    /// Extends the ends of an open boundary to where the straight rulings from those of its neighbour pass them.
    fn extend_to_ruling(&self, boundary: &mut Boundary, neighbour: &Boundary) {
        let directions = self.directions(neighbour);
        for end in [0, 1] {
            let last = if end == 1 { neighbour.points.len() - 1 } else { 0 };
            let is_asked = self.is_extended(boundary, end) && self.is_extended(neighbour, end);
            let Some(reach) = boundary.reach(end == 1, self.mean_edge).filter(|_| is_asked) else { continue };
            let [beyond, _] = directions[last].map_or([0.0; 2], |a| passed(reach, neighbour.points[last], a));
            if beyond > MERGED * self.mean_edge && beyond < FARTHEST * self.mesh.diagonal() {
                boundary.extend(end == 1, beyond, self.mean_edge);
            }
        }
    }

    /// Extends the ends of an open boundary that are on the rim, or beyond it, as the stretches of rim beside each ask for.
    fn extend(&self, boundary: &mut Boundary, beside: &[[Stretch; 2]; 2]) {
        for end in [0, 1] {
            let reach = boundary.reach(end == 1, self.mean_edge);
            let Some(reach) = reach.filter(|_| self.is_extended(boundary, end)) else { continue };
            let asked = beside[end].iter().map(|stretch| self.asked(reach, stretch)[0]).fold(0.0, f64::max);
            let by = (1.0 + MARGIN) * asked.min(self.mesh.diagonal()) + LEAST_EXTENSION * self.mean_edge;
            boundary.extend(end == 1, by, self.mean_edge);
        }
    }

    /// Whether an end of a boundary is on the rim or beyond it: a curve that ends within the surface was drawn so.
    fn is_extended(&self, boundary: &Boundary, end: usize) -> bool {
        let at = if end == 1 { boundary.on_surface.last() } else { boundary.on_surface.first() };
        !boundary.is_closed && at.is_some_and(|at| at.is_none() || self.place(*at).is_some())
    }

    /// The boundary moved against the field (side 0) or along it (side 1), by the way to the rim; none if that is nothing.
    /// `reaches`: how far the extensions of its start and end are from the rim. `beside`: the points of the rim that are to be passed.
    fn overshoot(
        &self,
        from: &Boundary,
        side: usize,
        reaches: [f64; 2],
        beside: impl Iterator<Item = u32>,
    ) -> Option<Boundary> {
        let sign = if side == 0 { -1.0 } else { 1.0 };
        let count = from.points.len();
        // In a straight line, and none where the field goes in circles.
        let sense = if side == 0 { Sense::Backward } else { Sense::Forward };
        let way = |at: SurfacePoint| {
            let followed = self.follow(at, sense, |_| ControlFlow::Continue(()))?;
            let is_out = matches!(followed.end, End::Boundary | End::Unknown);
            is_out.then(|| followed.position.distance(self.position(at)))
        };
        let mut ways: Vec<Option<f64>> = from.on_surface.iter().map(|at| way((*at)?)).collect();
        for (i, reach) in [(0, reaches[0]), (count - 1, reaches[1])] {
            ways[i] = Some(ways[i].unwrap_or(0.0).max(reach));
        }
        // Corners of the rim may be between the ways of two points.
        for i in beside.map(|i| i as usize).filter(|&i| self.field.is_known()[i]) {
            let (point, a) = (self.mesh.points()[i], self.field.directions()[i]);
            let Some((k, way)) = crossed(&from.points, point, a) else { continue };
            for end in [k, k + 1] {
                ways[end] = Some(ways[end].unwrap_or(0.0).max(way));
            }
        }
        let most = ways.iter().flatten().copied().fold(0.0, f64::max);
        if !(most > MERGED * self.mean_edge) {
            return None;
        }
        let way = |i: usize| ways[i].unwrap_or(0.0);
        let widened = |i: usize| {
            let near = i.saturating_sub(BESIDE)..=(i + BESIDE).min(count - 1);
            let largest = near.map(way).fold(LEAST_OVERSHOOT * most, f64::max);
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

/// How far beyond an end, given with the outward tangent, the line through `from` along `a` passes the tangent, and how far that is
/// from `from`; 0 if it does not.
///
/// On `P + e T` and `r + s a` the points nearest to each other have, with `d = r − P` and `c = T·a`,
/// `e = (d·T − c d·a)/(1 − c²)` and `s = (c d·T − d·a)/(1 − c²)`.
fn passed((end, outward): (DVec3, DVec3), from: DVec3, a: DVec3) -> [f64; 2] {
    let (apart, c) = (from - end, outward.dot(a));
    if 1.0 - c * c < LEAST_SINE * LEAST_SINE {
        return [0.0; 2];
    }
    let beyond = (apart.dot(outward) - c * apart.dot(a)) / (1.0 - c * c);
    let along = (c * apart.dot(outward) - apart.dot(a)) / (1.0 - c * c);
    // Lines that run nearly along the boundary must not take it far away.
    if beyond > 0.0 { [beyond, along.abs()].map(|way| way.min(2.0 * apart.length())) } else { [0.0; 2] }
}

/// The segment of a polyline that the line through a point along `a` passes most nearly, and how far along the line that is.
fn crossed(points: &[DVec3], from: DVec3, a: DVec3) -> Option<(usize, f64)> {
    let nearest = |pair: &[DVec3]| {
        // Both ends as seen along the line.
        let [p, q] = [pair[0] - from, pair[1] - from];
        let (across, chord) = (p - p.dot(a) * a, (q - p) - (q - p).dot(a) * a);
        let part = (-across.dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
        let part = if part.is_finite() { part } else { 0.0 };
        ((across + part * chord).length(), p.lerp(q, part).dot(a).abs())
    };
    let all = points.windows(2).map(nearest).enumerate();
    let best = all.min_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    Some((best.0, best.1.1))
}
