//! Where the card's coordinates lie in the model's.

use glam::DVec3;

/// Four numbers of single precision: a point or a vector, and one to spare.
pub(super) type Four = [f32; 4];

/// The card's coordinates are the model's, less the middle of its bounding box, over half its longest side: single precision has
/// the same digits wherever the model lies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) middle: DVec3,
    /// Model units of one unit on the card.
    pub(super) size: f64,
}

impl Frame {
    pub(super) fn of(points: &[DVec3]) -> Self {
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let half = 0.5 * (high - low);
        let size = half.max_element();
        if size > 0.0 && size.is_finite() {
            return Self { middle: low + half, size };
        }
        Self { middle: points.first().copied().unwrap_or_default(), size: 1.0 }
    }

    /// A point as the sum of two numbers of single precision, which together keep some 14 digits.
    pub(super) fn split(&self, point: DVec3) -> [Four; 2] {
        let own = (point - self.middle) / self.size;
        let base = own.as_vec3();
        [four(base.as_dvec3()), four(own - base.as_dvec3())]
    }

    /// The point that a split one stands for.
    pub(super) fn joined(&self, base: Four, shift: Four) -> DVec3 {
        self.middle + self.size * (vector(base) + vector(shift))
    }
}

pub(super) fn four(v: DVec3) -> Four {
    [v.x as f32, v.y as f32, v.z as f32, 0.0]
}

pub(super) fn vector(four: Four) -> DVec3 {
    DVec3::new(f64::from(four[0]), f64::from(four[1]), f64::from(four[2]))
}
