//! The surfaces that are measured and drawn.

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::ruled::Strip;
use shapeop::mesh::patterns::parametric_surface;
use shapeop::mesh::reference::{ParametricSurface, SurfaceJet};
use shapeop::mesh::{Grid, Mesh, surfaces};

/// A surface as a function of two parameters.
pub type Jets = Box<dyn Fn(f64, f64) -> SurfaceJet + Sync>;

/// A surface over a rectangle of parameters.
pub struct Shape {
    pub name: &'static str,
    pub jet: Jets,
    pub ranges: [[f64; 2]; 2],
}

impl Shape {
    pub fn new(
        name: &'static str,
        ranges: [[f64; 2]; 2],
        surface: impl Fn(f64, f64) -> SurfaceJet + Sync + 'static,
    ) -> Self {
        Self { name, jet: Box::new(surface), ranges }
    }

    /// A mesh of it of so many columns and rows.
    pub fn mesh(&self, columns: usize, rows: usize) -> Result<Mesh> {
        Ok(parametric_surface(columns, rows, self.ranges[0], self.ranges[1], |u, v| self.point(u, v))?)
    }

    /// The same of triangles ([`split`]).
    pub fn split_mesh(&self, columns: usize, rows: usize) -> Result<Mesh> {
        Ok(split(self.mesh(columns, rows)?))
    }

    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        (self.jet)(u, v).point
    }

    /// The surface itself, to be near to.
    pub fn surface(&self) -> Result<Surface<'_>> {
        Ok(ParametricSurface::new(self.ranges, [41, 41], &*self.jet)?)
    }
}

/// A surface to be near to.
pub type Surface<'a> = ParametricSurface<&'a (dyn Fn(f64, f64) -> SurfaceJet + Sync)>;

/// Five surfaces of negative curvature.
pub fn five() -> [Shape; 5] {
    [
        saddle(),
        Shape::new("hyperboloid of one sheet", [[0.0, 1.6], [-0.8, 0.8]], surfaces::hyperboloid()),
        Shape::new("helicoid", [[0.3, 1.5], [0.0, 2.0]], surfaces::helicoid(0.8)),
        Shape::new("catenoid", [[0.0, 1.6], [-0.8, 0.8]], surfaces::catenoid()),
        free_form(0.1, [1.0, 0.8]),
    ]
}

/// z = xy over the square from −1 to 1.
pub fn saddle() -> Shape {
    Shape::new("saddle z = xy", [[-1.0, 1.0], [-1.0, 1.0]], surfaces::saddle())
}

/// z = xy + part · (x³ − 3xy²) over a rectangle of these half sides.
pub fn free_form(part: f64, halves: [f64; 2]) -> Shape {
    Shape::new("free form", halves.map(|half| [-half, half]), surfaces::bent_saddle(part))
}

/// The conoid (s cos φ, s sin φ, t) with φ = t + 0.3 sin t, for t from 0 to 2 and s from 1 to 2; its rulings are parallel to the
/// xy plane.
pub fn conoid() -> Shape {
    bent_conoid(0.0, 0.0)
}

/// The conoid with rulings that are tilted and bent: to z is added `tilt` · (s − 1) sin 2t + `lift` · s (s − 1) (s − 2).
pub fn bent_conoid(tilt: f64, lift: f64) -> Shape {
    Shape::new("conoid", [[0.0, 2.0], [1.0, 2.0]], move |t, s| {
        let (phi, d, dd) = (t + 0.3 * t.sin(), 1.0 + 0.3 * t.cos(), -0.3 * t.sin());
        let (out, around) = (DVec3::new(phi.cos(), phi.sin(), 0.0), DVec3::new(-phi.sin(), phi.cos(), 0.0));
        let (sin, cos) = (2.0 * t).sin_cos();
        let z = tilt * (s - 1.0) * sin + lift * s * (s - 1.0) * (s - 2.0);
        let by_s = tilt * sin + lift * (3.0 * s * s - 6.0 * s + 2.0);
        let [tt, ts, ss] = [-4.0 * tilt * (s - 1.0) * sin, 2.0 * tilt * cos, lift * (6.0 * s - 6.0)];
        SurfaceJet {
            point: s * out + (t + z) * DVec3::Z,
            first: [s * d * around + (1.0 + 2.0 * tilt * (s - 1.0) * cos) * DVec3::Z, out + by_s * DVec3::Z],
            second: [s * (dd * around - d * d * out) + tt * DVec3::Z, d * around + ts * DVec3::Z, ss * DVec3::Z],
        }
    })
}

/// A roof: z = 0.3 (x² − y²) + 0.045 (x³ − 3xy²), steeper at one end; its asymptotic curves run along both diagonals.
pub fn roof() -> Shape {
    let height = |x: f64, y: f64| {
        let (a, b) = (0.3, 0.045);
        [
            a * (x * x - y * y) + b * (x.powi(3) - 3.0 * x * y * y),
            2.0 * a * x + 3.0 * b * (x * x - y * y),
            -2.0 * a * y - 6.0 * b * x * y,
            2.0 * a + 6.0 * b * x,
            -6.0 * b * y,
            -2.0 * a - 6.0 * b * x,
        ]
    };
    Shape::new("roof", [[-1.2, 1.5], [-1.0, 1.0]], surfaces::graph(height))
}

/// A mesh with all its quads split along one diagonal: where both are as long but for round-off, the shorter one is any.
pub fn split(mesh: Mesh) -> Mesh {
    let halves = mesh.faces.iter().flat_map(|f| [vec![f[0], f[1], f[2]], vec![f[0], f[2], f[3]]]);
    Mesh { faces: halves.collect(), points: mesh.points }
}

/// A mesh that closes around: `point` gets the angle and the part of the height, 0 to 1.
pub fn tube(around: usize, rows: usize, point: impl Fn(f64, f64) -> DVec3) -> Result<Mesh> {
    let at = |k: usize| {
        let angle = std::f64::consts::TAU * (k % around) as f64 / around as f64;
        point(angle, (k / around) as f64 / (rows - 1) as f64)
    };
    Ok(Grid::new((0..around * rows).map(at).collect(), rows, around, [false, true])?.mesh())
}

/// Numbers between −1 and 1 that look random (a linear congruential generator).
pub fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A strip as any surface with two parameters, so that distances from it are found without the search that strips have.
pub fn surface_of(strip: &Strip) -> Result<ParametricSurface<impl Fn(f64, f64) -> SurfaceJet + Sync + '_>> {
    let samples = [4 * strip.basis().spans() + 1, 3];
    Ok(ParametricSurface::new([[0.0, strip.length_u()], [0.0, 1.0]], samples, |u, v| strip.at(u, v))?)
}
