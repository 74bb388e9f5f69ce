//! Curves and nets that are measured and drawn.

use std::f64::consts::{PI, TAU};

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::canal::circles::Section;
use shapeop::geometry::canal::fit::{FitOptions, fit};
use shapeop::geometry::canal::frame::Frame;
use shapeop::geometry::canal::inversion::Inversion;
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::normals::Orientation;
use shapeop::mesh::Grid;
use shapeop::mesh::curve::{Spacing, Spline};

/// Random numbers from a stated seed (SplitMix64).
pub struct Random(pub u64);

impl Random {
    /// Uniform from `low` to below `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in the cube from −1 to 1.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// So many numbers.
    pub fn list(&mut self, count: usize, low: f64, high: f64) -> Vec<f64> {
        (0..count).map(|_| self.between(low, high)).collect()
    }
}

/// A Dupin cyclide, the image of a torus under an inversion, with its lines of curvature in closed form.
pub struct Cyclide(pub Inversion);

/// The radii of the torus: of its center line and of its tube.
pub const RADII: [f64; 2] = [2.0, 0.7];

/// The point of the torus at the angles `u` about its axis and `v` around its tube.
pub fn torus(u: f64, v: f64) -> DVec3 {
    let ring = RADII[0] + RADII[1] * v.cos();
    DVec3::new(ring * u.cos(), ring * u.sin(), RADII[1] * v.sin())
}

impl Cyclide {
    pub fn new() -> Result<Self> {
        Ok(Self(Inversion::new(DVec3::new(0.3, -0.4, 1.9), 2.3)?))
    }

    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        self.0.point(torus(u, v))
    }

    pub fn frame(&self, u: f64, v: f64) -> Frame {
        let t1 = DVec3::new(-u.sin(), u.cos(), 0.0);
        let t2 = DVec3::new(-v.sin() * u.cos(), -v.sin() * u.sin(), v.cos());
        let [t1, t2] = [t1, t2].map(|t| self.0.direction(torus(u, v), t).normalize());
        Frame { t1, t2, normal: t1.cross(t2) }
    }

    /// How far `point`, inverted, is from the torus.
    pub fn distance(&self, point: DVec3) -> f64 {
        let q = self.0.point(point);
        (q.truncate().length() - RADII[0]).hypot(q.z) - RADII[1]
    }

    /// Rows at even `u`, columns at even `v`, ends included; a direction of a whole turn wraps.
    pub fn grid(&self, u: [f64; 2], v: [f64; 2], rows: usize, columns: usize) -> Result<Grid> {
        let wraps = [u, v].map(|[from, to]| (to - from - TAU).abs() < 1e-9);
        let at = |[from, to]: [f64; 2], k: usize, count: usize, wraps: bool| {
            from + (to - from) * k as f64 / (count - usize::from(!wraps)) as f64
        };
        let point = |k: usize| self.point(at(u, k / columns, rows, wraps[0]), at(v, k % columns, columns, wraps[1]));
        Ok(Grid::new((0..rows * columns).map(point).collect(), rows, columns, wraps)?)
    }

    /// The cyclidic net of [`Cyclide::grid`]: every patch lies on the cyclide.
    pub fn net(&self, u: [f64; 2], v: [f64; 2], rows: usize, columns: usize) -> Result<Net> {
        Ok(Net::new(self.grid(u, v, rows, columns)?, self.frame(u[0], v[0]))?)
    }
}

/// Two curves without symmetry: the second beside and above the first, whatever way it goes.
pub fn free_form() -> Result<[Spline; 2]> {
    let first = |s: f64| DVec3::new(4.0 * s, (3.0 * s).sin(), 0.5 * (4.0 * s).cos());
    let second = |s: f64| DVec3::new(4.3 * s - 0.2, (3.0 * s).sin() + 1.5 + 0.3 * (5.0 * s).cos(), 1.0 + 0.4 * s);
    let spline = |curve: &dyn Fn(f64) -> DVec3| {
        let points: Vec<DVec3> = (0..12).map(|i| curve(f64::from(i) / 11.0)).collect();
        Spline::through(&points, false)
    };
    Ok([spline(&first)?, spline(&second)?])
}

/// The largest distance of points from others.
pub fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// A curve in space that starts along +y, a little over 5 long; `count` edges.
pub fn c_guide(count: usize) -> Vec<DVec3> {
    let at = |s: f64| DVec3::new(0.8 * (s * s - 0.1 * s * s * s), 2.0 * s, 0.2 * s * s);
    (0..=count).map(|k| at(2.0 * k as f64 / count as f64)).collect()
}

/// Part of an ellipse in the xz-plane, from the origin; of height 1 it is part of a circle.
pub fn ellipse(count: usize, height: f64) -> Vec<DVec3> {
    let at = |angle: f64| DVec3::new(-1.0 + angle.cos(), 0.0, height * angle.sin());
    (0..=count).map(|j| at(0.8 * PI * j as f64 / count as f64)).collect()
}

/// The distance of a polyline's ends.
pub fn chord(polyline: &[DVec3]) -> f64 {
    polyline[0].distance(polyline[polyline.len() - 1])
}

/// A curve in the xy-plane outside of the unit circle, from its direction 200° to −20°, and two points of the circle.
pub fn planar_curve(count: i32) -> (Vec<DVec3>, DVec3, DVec3) {
    let at = |degrees: f64| DVec3::new(degrees.to_radians().cos(), degrees.to_radians().sin(), 0.0);
    let curve = (0..count).map(|i| {
        let s = f64::from(i) / f64::from(count - 1);
        (1.0 + s * (1.0 - s) * (1.5 + 0.8 * (5.0 * s).sin())) * at(200.0 - 220.0 * s)
    });
    (curve.collect(), at(225.0), at(300.0))
}

/// A canal surface over two curves on the ground.
pub fn shell(rows: usize, columns: usize) -> Result<Net> {
    let through = |at: &dyn Fn(f64) -> DVec3| {
        Spline::through(&(0..16).map(|k| at(f64::from(k) / 15.0)).collect::<Vec<_>>(), false)
    };
    let first = through(&|s| DVec3::new(6.0 * s, 0.8 * (4.6 * s).sin(), 0.0))?;
    let second = through(&|s| DVec3::new(6.2 * s - 0.1, 2.6 + 0.5 * (3.0 * s + 0.4).cos(), 0.0))?;
    let options = FitOptions {
        circle_count: rows,
        spacing: Spacing::ArcLength,
        column_count: columns,
        orientation: Orientation::Angle(1.05),
        section: Section::ToCurve { is_long_way: false },
    };
    let mut fitted = fit(&first, &second, &options)?;
    // The arch that rises.
    if fitted.grid.at(rows / 2, columns / 2).z < 0.0 {
        fitted = fit(&first, &second, &FitOptions { orientation: Orientation::Angle(-1.05), ..options })?;
    }
    Ok(Net::new(fitted.grid, fitted.frame)?)
}
