//! What a surface is made from: a circular net with a frame, and inversions that map it.

use super::frame::Frame;
use super::inversion::Inversion;
use crate::error::Result;
use crate::mesh::Grid;

/// A circular base: its net and its frame at point `(0, 0)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Base {
    /// The net.
    pub grid: Grid,
    /// Tangents to both families of lines of curvature, and the normal, at point `(0, 0)`.
    pub frame: Frame,
}

impl Base {
    /// The same surface with rows for columns. The normal turns round, since the tangents change places.
    ///
    /// # Errors
    /// None for a base of this module.
    pub fn transposed(&self) -> Result<Self> {
        let grid = &self.grid;
        let points = (0..grid.columns()).flat_map(|j| grid.column(j)).collect();
        let [wraps_rows, wraps_columns] = grid.wraps();
        let Frame { t1, t2, normal } = self.frame;
        Ok(Self {
            grid: Grid::new(points, grid.columns(), grid.rows(), [wraps_columns, wraps_rows])?,
            frame: Frame { t1: t2, t2: t1, normal: -normal },
        })
    }
}

/// A base and the inversions that map it to a surface, the first one first. No inversion is the identity.
#[derive(Clone, Debug, PartialEq)]
pub struct InvertedBase {
    /// What is inverted.
    pub base: Base,
    /// Applied in this order.
    pub inversions: Vec<Inversion>,
}

impl InvertedBase {
    /// The net of the surface.
    ///
    /// # Errors
    /// Status `Degenerate`: a point of the base is at a center of inversion.
    pub fn grid(&self) -> Result<Grid> {
        let start = self.base.grid.points().to_vec();
        let points = self.inversions.iter().try_fold(start, |points, inversion| inversion.points(&points))?;
        self.base.grid.with_points(points)
    }

    /// The frame of the surface at point `(0, 0)`: the images of both tangents, and `t1 × t2`. An inversion of positive ratio
    /// turns orientation round, so the normal is the image of the base's normal or its opposite.
    pub fn frame(&self) -> Frame {
        let Frame { mut t1, mut t2, .. } = self.base.frame;
        let mut point = self.base.grid.at(0, 0);
        for inversion in &self.inversions {
            t1 = inversion.direction(point, t1).normalize_or_zero();
            t2 = inversion.direction(point, t2).normalize_or_zero();
            point = inversion.point(point);
        }
        Frame { t1, t2, normal: t1.cross(t2) }
    }
}

/// The largest distance of a quad's corner from the circle through the other three, over the mean edge. For tests: it shares no
/// code with the fits of [`crate::mesh::fit`].
#[cfg(test)]
pub(super) fn off_circle(grid: &Grid) -> f64 {
    let off = |quad: [usize; 4]| {
        let corners = quad.map(|corner| grid.points()[corner]);
        let mean = (0..4).map(|k| corners[k].distance(corners[(k + 1) % 4])).sum::<f64>() / 4.0;
        let circle = crate::geometry::circle::Circle::through(corners[0], corners[1], corners[2]);
        circle.map_or(f64::INFINITY, |circle| circle.distance(corners[3]) / mean)
    };
    grid.quads().map(off).fold(0.0, f64::max)
}
