//! Strip boundaries: curves across a field.

use glam::DVec3;

use crate::mesh::SurfacePoint;

/// Points of a boundary nearer than this to the one before, in mean edges, are left out: directions between them are round-off.
pub(super) const MERGED: f64 = 1e-3;

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

    /// An end, and the direction outward there, over a chord of a length of `least` if it has one.
    pub(super) fn reach(&self, at_end: bool, least: f64) -> Option<(DVec3, DVec3)> {
        let ordered: Vec<DVec3> =
            if at_end { self.points.iter().rev().copied().collect() } else { self.points.clone() };
        let end = *ordered.first()?;
        // A chord of some length, as the last segment may be a corner of a triangle cut off.
        let inner = ordered.iter().copied().find(|p| p.distance(end) >= least).or(ordered.last().copied())?;
        Some((end, (end - inner).try_normalize()?))
    }

    /// Goes on straight for so far, by one more point, or by moving that which is there.
    pub(super) fn extend(&mut self, at_end: bool, by: f64, least: f64) {
        let Some((end, outward)) = self.reach(at_end, least) else { return };
        let last = if at_end { self.points.len() - 1 } else { 0 };
        if self.on_surface[last].is_none() {
            self.points[last] = end + by * outward;
        } else {
            let place = if at_end { self.points.len() } else { 0 };
            self.points.insert(place, end + by * outward);
            self.on_surface.insert(place, None);
        }
    }
}
