//! The surfaces that are measured.

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::patterns::parametric_surface;
use shapeop::mesh::reference::SurfaceJet;
use shapeop::mesh::{Mesh, surfaces};

/// A surface over a rectangle of parameters.
pub struct Shape {
    pub name: &'static str,
    point: Box<dyn Fn(f64, f64) -> DVec3>,
    ranges: [[f64; 2]; 2],
}

impl Shape {
    fn new(
        name: &'static str,
        ranges: [[f64; 2]; 2],
        surface: impl Fn(f64, f64) -> SurfaceJet + Sync + 'static,
    ) -> Self {
        Self { name, point: Box::new(move |u, v| surface(u, v).point), ranges }
    }

    /// A mesh of it of so many columns and rows.
    pub fn mesh(&self, columns: usize, rows: usize) -> Result<Mesh> {
        Ok(parametric_surface(columns, rows, self.ranges[0], self.ranges[1], &self.point)?)
    }
}

/// Five surfaces of negative curvature.
pub fn five() -> [Shape; 5] {
    [
        Shape::new("saddle z = xy", [[-1.0, 1.0], [-1.0, 1.0]], surfaces::saddle()),
        Shape::new("hyperboloid of one sheet", [[0.0, 1.6], [-0.8, 0.8]], surfaces::hyperboloid()),
        Shape::new("helicoid", [[0.3, 1.5], [0.0, 2.0]], surfaces::helicoid(0.8)),
        Shape::new("catenoid", [[0.0, 1.6], [-0.8, 0.8]], surfaces::catenoid()),
        Shape::new("free form", [[-1.0, 1.0], [-0.8, 0.8]], surfaces::bent_saddle(0.1)),
    ]
}
