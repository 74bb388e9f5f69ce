//! The points of one constraint.

use glam::DVec3;

/// The points of one constraint, gathered on demand from the model's points: relative to their mean if the type's rows
/// are centred, else as they are.
#[derive(Clone, Copy, Debug)]
pub struct Stencil<'a> {
    points: &'a [DVec3],
    indices: &'a [u32],
    origin: DVec3,
}

impl<'a> Stencil<'a> {
    /// The points `indices` as they are.
    pub fn absolute(points: &'a [DVec3], indices: &'a [u32]) -> Self {
        Self { points, indices, origin: DVec3::ZERO }
    }

    /// The points `indices` relative to their mean.
    pub fn centred(points: &'a [DVec3], indices: &'a [u32]) -> Self {
        // Summed relative to the first point: far from the origin the mean keeps the digits that the differences have.
        let first = points[indices[0] as usize];
        let sum: DVec3 = indices.iter().map(|&index| points[index as usize] - first).sum();
        Self { points, indices, origin: first + sum / indices.len() as f64 }
    }

    /// The number of points, at least 1; a repeated index counts each time.
    #[allow(clippy::len_without_is_empty, reason = "a constraint always has points")]
    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Point `i` of the constraint.
    pub fn at(&self, i: usize) -> DVec3 {
        self.points[self.indices[i] as usize] - self.origin
    }

    /// The points in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = DVec3> + '_ {
        self.indices.iter().map(|&index| self.points[index as usize] - self.origin)
    }

    /// The points of a type with exactly `N` indices.
    pub fn array<const N: usize>(&self) -> [DVec3; N] {
        std::array::from_fn(|i| self.at(i))
    }

    /// The largest distance of a point from the first one: the size against which degeneracy is judged.
    pub fn extent(&self) -> f64 {
        let first = self.at(0);
        self.iter().map(|point| point.distance_squared(first)).fold(0.0, f64::max).sqrt()
    }
}
