//! A Dupin cyclide for tests: the image of a torus under an inversion, with its lines of curvature and frames in closed form.

use glam::DVec3;

use super::frame::Frame;
use super::inversion::Inversion;
use super::net::Net;
use crate::mesh::Grid;

pub struct Cyclide {
    pub inversion: Inversion,
}

/// The radii of the torus: of its center line and of its tube.
pub const RADII: [f64; 2] = [2.0, 0.7];

impl Cyclide {
    pub fn new() -> Self {
        Self { inversion: Inversion::new(DVec3::new(0.3, -0.4, 1.9), 2.3).unwrap() }
    }

    /// The image of the torus's point at the angles `u` about its axis and `v` around its tube.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let ring = RADII[0] + RADII[1] * v.cos();
        self.inversion.point(DVec3::new(ring * u.cos(), ring * u.sin(), RADII[1] * v.sin()))
    }

    pub fn frame(&self, u: f64, v: f64) -> Frame {
        let on_torus = self.inversion.point(self.point(u, v));
        let t1 = DVec3::new(-u.sin(), u.cos(), 0.0);
        let t2 = DVec3::new(-v.sin() * u.cos(), -v.sin() * u.sin(), v.cos());
        let [t1, t2] = [t1, t2].map(|t| self.inversion.direction(on_torus, t).normalize());
        Frame { t1, t2, normal: t1.cross(t2) }
    }

    /// How far `point`, inverted, is from the torus.
    pub fn distance(&self, point: DVec3) -> f64 {
        let q = self.inversion.point(point);
        (q.truncate().length() - RADII[0]).hypot(q.z) - RADII[1]
    }

    /// Rows at even `u`, columns at even `v`, ends included; a direction of a whole turn wraps.
    pub fn grid(&self, u: [f64; 2], v: [f64; 2], rows: usize, columns: usize) -> Grid {
        let wraps = [u, v].map(|[from, to]| (to - from - std::f64::consts::TAU).abs() < 1e-9);
        let at = |[from, to]: [f64; 2], k: usize, count: usize, wraps: bool| {
            from + (to - from) * k as f64 / (count - usize::from(!wraps)) as f64
        };
        let point = |k: usize| {
            let (i, j) = (k / columns, k % columns);
            self.point(at(u, i, rows, wraps[0]), at(v, j, columns, wraps[1]))
        };
        Grid::new((0..rows * columns).map(point).collect(), rows, columns, wraps).unwrap()
    }

    /// The cyclidic net of [`Cyclide::grid`]: every patch lies on the cyclide.
    pub fn net(&self, u: [f64; 2], v: [f64; 2], rows: usize, columns: usize) -> Net {
        Net::new(self.grid(u, v, rows, columns), self.frame(u[0], v[0])).unwrap()
    }
}
