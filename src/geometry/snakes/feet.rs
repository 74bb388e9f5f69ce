//! Feet on a surface that are asked for again and again: by conditions, residuals and deviations of the same position.

use std::sync::{Mutex, PoisonError};

use glam::DVec3;

use crate::mesh::ReferenceSurface;
use crate::mesh::reference::SurfaceFoot;

/// So many of the last feet are remembered, a power of two: those of a position and of some trials.
const REMEMBERED: usize = 4096;

/// A surface that remembers feet. What it answers is what the surface does.
pub(super) struct Feet<'a> {
    surface: &'a dyn ReferenceSurface,
    found: Mutex<Vec<Option<(DVec3, SurfaceFoot)>>>,
}

impl<'a> Feet<'a> {
    pub fn new(surface: &'a dyn ReferenceSurface) -> Self {
        Self { surface, found: Mutex::new(vec![None; REMEMBERED]) }
    }
}

/// Where the foot of a point is kept.
fn place(point: DVec3) -> usize {
    let mix = |sum: u64, value: f64| (sum ^ value.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29);
    point.to_array().into_iter().fold(0, mix) as usize % REMEMBERED
}

impl ReferenceSurface for Feet<'_> {
    fn nearest(&self, point: DVec3) -> SurfaceFoot {
        let place = place(point);
        let known = self.found.lock().unwrap_or_else(PoisonError::into_inner)[place];
        match known {
            Some((asked, foot)) if asked == point => foot,
            _ => {
                let foot = self.surface.nearest(point);
                self.found.lock().unwrap_or_else(PoisonError::into_inner)[place] = Some((point, foot));
                foot
            }
        }
    }

    fn diagonal(&self) -> f64 {
        self.surface.diagonal()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    struct Counting(AtomicUsize);

    impl ReferenceSurface for Counting {
        fn nearest(&self, point: DVec3) -> SurfaceFoot {
            self.0.fetch_add(1, Ordering::Relaxed);
            SurfaceFoot { point: point.with_z(0.0), normal: DVec3::Z, overhang: 0.0 }
        }

        fn diagonal(&self) -> f64 {
            1.0
        }
    }

    #[test]
    fn a_foot_is_found_once() {
        let surface = Counting(AtomicUsize::new(0));
        let feet = Feet::new(&surface);
        let points: Vec<DVec3> = (0..100).map(|i| DVec3::new((f64::from(i)).sin(), 0.3 * f64::from(i), 1.0)).collect();
        for _ in 0..3 {
            assert!(points.iter().all(|point| feet.nearest(*point).point == point.with_z(0.0)));
        }
        // But for points that share a place.
        assert!(surface.0.load(Ordering::Relaxed) < 115, "{:?}", surface.0);
        // Zeros of both signs are one point; what is no number is asked for each time.
        assert_eq!(feet.nearest(DVec3::new(-0.0, 0.0, 0.0)).point, DVec3::ZERO);
    }
}
