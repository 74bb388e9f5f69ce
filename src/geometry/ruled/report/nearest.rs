//! The nearest point of several strips.

use glam::DVec3;
use rayon::prelude::*;

use crate::error::Result;
use crate::geometry::ruled::Strip;
use crate::mesh::ClosestPoints;
use crate::mesh::reference::{ParametricSurface, ReferenceSurface, SurfaceJet};

/// Columns of samples in each span, and rows: as of [`Strip::surface`].
const SAMPLES: [usize; 2] = [4, 3];

/// How far points are from the nearest of some strips, in model units: as [`report`](super::report) measures it.
///
/// # Errors
/// A strip whose control points are all one; the place is `strips[i]`.
pub fn distances(points: &[DVec3], strips: &[Strip]) -> Result<Vec<f64>> {
    let nearest = nearest_strip(strips)?;
    Ok(points.par_iter().map(|&point| nearest.distance(point)).collect())
}

/// All strips, ready to be asked. Triangles of all tell which strips may be nearest; Newton's method on these finds out.
pub(super) struct NearestStrip<F> {
    surfaces: Vec<ParametricSurface<F>>,
    samples: ClosestPoints,
    strip_of: Vec<u32>,
}

/// Prepares the search.
///
/// # Errors
/// A strip whose control points are all one; the place is `strips[i]`.
pub(super) fn nearest_strip(strips: &[Strip]) -> Result<NearestStrip<impl Fn(f64, f64) -> SurfaceJet + Sync + '_>> {
    let (mut surfaces, mut points, mut triangles, mut strip_of) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (i, strip) in strips.iter().enumerate() {
        surfaces.push(strip.surface().map_err(|error| error.with_place(format!("strips[{i}]")))?);
        let mesh = strip.mesh(SAMPLES[0] * strip.basis().spans() + 1, SAMPLES[1])?;
        let first = points.len() as u32;
        for face in &mesh.faces {
            let corner = |k: usize| first + face[k];
            triangles.extend([[corner(0), corner(1), corner(2)], [corner(0), corner(2), corner(3)]]);
            strip_of.extend([i as u32; 2]);
        }
        points.extend(mesh.points);
    }
    let samples = ClosestPoints::of_triangles(&points, &triangles)?;
    Ok(NearestStrip { surfaces, samples, strip_of })
}

impl<F: Fn(f64, f64) -> SurfaceJet + Sync> NearestStrip<F> {
    /// How far a point is from the nearest strip: exact, but where two strips are equally near up to how far their triangles are
    /// from them.
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        let apart = |strip: u32| self.surfaces[strip as usize].nearest(point).point.distance(point);
        let first = self.strip_of[self.samples.nearest_on_piece(point).1];
        let mut best = apart(first);
        let mut last = first;
        for (piece, _) in self.samples.within(point, best) {
            let strip = self.strip_of[piece];
            if strip != first && strip != last {
                best = best.min(apart(strip));
                last = strip;
            }
        }
        best
    }
}
