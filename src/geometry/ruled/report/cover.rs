//! How much of the reference surface strips cover: measured from its side, so that what two strips cover counts once.

use glam::DVec3;
use rayon::prelude::*;

use crate::geometry::ruled::coverage::NearestStrip;
use crate::mesh::TriangleMesh;

/// Triangles are divided until there are so many parts at least,
const LEAST_PARTS: usize = 8_000;

/// and so often more where an end of a strip passes through one: its area then is known to 1/256 of itself.
const FINER: usize = 4;

/// A strip covers a spot if it is nearer than this part of the reference's diagonal: farther away it is beside another part of the
/// surface.
const NEAR: f64 = 0.02;

/// Strips overlap where both are within this part of the diagonal beyond the nearer one's distance.
const OVER: f64 = 0.002;

/// What strips cover, in square model units.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cover {
    /// The area that some strip covers,
    pub covered: f64,
    /// and what others cover again, once for each.
    pub overlap: f64,
}

/// How often each spot of a mesh is covered. `tolerance`: how far beside a strip a spot may be, in model units. `at_points`: for each
/// point of the mesh, [`count`].
pub(super) fn cover(mesh: &TriangleMesh, counter: &Counter<'_>, at_points: &[u32]) -> Cover {
    let size = mesh.triangles().len().max(1);
    let divided = (0..).find(|&k| size << (2 * k) >= LEAST_PARTS).unwrap_or(0);
    let of = |t: usize| {
        let (corners, at) = (mesh.corners(t), mesh.triangles()[t].map(|i| at_points[i as usize]));
        counter.mean([0, 1, 2].map(|k| (corners[k], at[k])), divided, divided + FINER)
    };
    let parts: Vec<[f64; 2]> = (0..size).into_par_iter().map(of).collect();
    let sum = |k: usize| parts.iter().enumerate().map(|(t, part)| mesh.area(t) * part[k]).sum();
    Cover { covered: sum(0), overlap: sum(1) }
}

/// Counts strips.
pub(super) struct Counter<'a> {
    pub nearest: &'a NearestStrip<'a>,
    /// How far beside a strip a spot may be, in model units.
    pub tolerance: f64,
    /// The reference's diagonal.
    pub diagonal: f64,
}

impl Counter<'_> {
    /// How far the nearest strip is from a point, and how many strips cover it: those whose nearest point is not at an end that the
    /// point is beyond.
    pub fn at(&self, point: DVec3) -> (f64, u32) {
        let first = self.nearest.nearest(point);
        let distance = first.point.distance(point);
        let mut count = u32::from(distance <= NEAR * self.diagonal && first.overhang(point) <= self.tolerance);
        let reach = if count == 0 { NEAR * self.diagonal } else { distance + OVER * self.diagonal };
        for (strip, piece) in self.nearest.within(point, reach) {
            if strip != first.strip {
                let other = self.nearest.nearest_on_piece(point, piece);
                let is_near = other.point.distance(point) <= reach;
                count += u32::from(is_near && other.overhang(point) <= self.tolerance);
            }
        }
        (distance, count)
    }

    /// The parts of a triangle that are covered, and covered again.
    fn mean(&self, corners: [(DVec3, u32); 3], divided: usize, finest: usize) -> [f64; 2] {
        let [a, b, c] = corners;
        let all = |middle: u32| [a.1, b.1, c.1, middle];
        if divided == 0 {
            let middle = self.at((a.0 + b.0 + c.0) / 3.0).1;
            if finest == 0 || all(middle).iter().all(|&count| count == middle) {
                let mean = |of: fn(u32) -> u32| f64::from(all(middle).into_iter().map(of).sum::<u32>()) / 4.0;
                return [mean(|count| count.min(1)), mean(|count| count.saturating_sub(1))];
            }
        }
        let half = |p: (DVec3, u32), q: (DVec3, u32)| {
            let middle = 0.5 * (p.0 + q.0);
            (middle, self.at(middle).1)
        };
        let (ab, bc, ca) = (half(a, b), half(b, c), half(c, a));
        let (divided, finest) = (divided.saturating_sub(1), finest - 1);
        let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]].map(|part| self.mean(part, divided, finest));
        [0, 1].map(|k| 0.25 * parts.iter().map(|part| part[k]).sum::<f64>())
    }
}
