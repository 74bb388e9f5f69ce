//! Around a triangle of a mesh, a smooth surface: a cubic height over its plane, fitted to the points around.
//!
//! In the frame of a triangle (its centroid, a side, its normal) the surface is `z = Σ c_ij x^i y^j` with `i + j ≤ 3`, by least
//! squares with weights `exp(−r²/R²)`, where `R` is the distance of the farthest point and coordinates are in units of it. With
//! edges of length `h` its height is then of fourth order and its curvature of second. Patches of neighbours differ by as much.

use std::collections::BTreeSet;

use glam::DVec3;

use crate::linalg::householder::{solve, triangularise};
use crate::mesh::TriangleMesh;
use crate::mesh::reference::SurfaceJet;

/// Points that a patch is fitted to at least; rings around the triangle are added until there are so many.
const LEAST_POINTS: usize = 18;

/// Rings added at most to tell all terms apart.
const MORE_RINGS: usize = 2;

/// A term counts as told apart by the points where, of its column, more than this is left beside the columns before it.
const INDEPENDENT: f64 = 1e-5;

/// Terms of degree 1, 2 and 3 at most.
const TERMS: [usize; 3] = [3, 6, 10];

/// A fitted surface.
#[derive(Clone, Debug)]
pub(super) struct FacePatch {
    origin: DVec3,
    axes: [DVec3; 3],
    /// What coordinates are in units of.
    unit: f64,
    /// Of 1, x, y, x², xy, y², x³, x²y, xy², y³.
    coefficients: [f64; 10],
    /// The corners in the plane of the first two axes, in model units.
    corners: [[f64; 2]; 3],
}

impl FacePatch {
    /// The patch of a triangle. Where the points around do not tell cubic terms apart it has none; likewise quadratic ones.
    pub fn new(mesh: &TriangleMesh, triangle: usize) -> Self {
        let corners = mesh.corners(triangle);
        let origin = (corners[0] + corners[1] + corners[2]) / 3.0;
        let normal = mesh.normal(triangle);
        let along = (corners[1] - corners[0]).reject_from_normalized(normal).normalize();
        let axes = [along, normal.cross(along), normal];
        let mut around = Rings::new(mesh, triangle);
        while around.points.len() < LEAST_POINTS && around.grow(mesh) {}
        let mut fitted = fit(mesh, &around.points, origin, axes);
        for _ in 0..MORE_RINGS {
            if fitted.0 == TERMS[2] || !around.grow(mesh) {
                break;
            }
            fitted = fit(mesh, &around.points, origin, axes);
        }
        let (_, unit, coefficients) = fitted;
        let flat = |point: DVec3| [(point - origin).dot(axes[0]), (point - origin).dot(axes[1])];
        Self { origin, axes, unit, coefficients, corners: corners.map(flat) }
    }

    /// The surface over a point of the triangle's plane, whose coordinates are lengths.
    pub fn at(&self, x: f64, y: f64) -> SurfaceJet {
        let (x, y, c) = (x / self.unit, y / self.unit, &self.coefficients);
        let height = c[0]
            + x * (c[1] + x * (c[3] + x * c[6]))
            + y * (c[2] + y * (c[5] + y * c[9]))
            + x * y * (c[4] + x * c[7] + y * c[8]);
        let by_x = c[1] + 2.0 * c[3] * x + c[4] * y + 3.0 * c[6] * x * x + 2.0 * c[7] * x * y + c[8] * y * y;
        let by_y = c[2] + c[4] * x + 2.0 * c[5] * y + c[7] * x * x + 2.0 * c[8] * x * y + 3.0 * c[9] * y * y;
        let second = [
            2.0 * c[3] + 6.0 * c[6] * x + 2.0 * c[7] * y,
            c[4] + 2.0 * c[7] * x + 2.0 * c[8] * y,
            2.0 * c[5] + 2.0 * c[8] * x + 6.0 * c[9] * y,
        ];
        let [e1, e2, n] = self.axes;
        SurfaceJet {
            point: self.origin + self.unit * (x * e1 + y * e2 + height * n),
            first: [e1 + by_x * n, e2 + by_y * n],
            second: second.map(|second| second / self.unit * n),
        }
    }

    /// The coordinates of a point, without its height.
    pub fn flat(&self, point: DVec3) -> [f64; 2] {
        [0, 1].map(|k| (point - self.origin).dot(self.axes[k]))
    }

    /// The weights of the corners at a point of the plane, which add up to 1; negative ones outside.
    pub fn weights(&self, [x, y]: [f64; 2]) -> [f64; 3] {
        let part = |a: [f64; 2], b: [f64; 2]| (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x);
        let [a, b, c] = self.corners;
        let parts = [part(b, c), part(c, a), part(a, b)];
        let sum: f64 = parts.iter().sum();
        parts.map(|part| part / sum)
    }
}

/// The points around a triangle, ring by ring, in an order that the mesh alone determines.
struct Rings {
    points: Vec<u32>,
    is_in: BTreeSet<u32>,
    last: usize,
}

impl Rings {
    fn new(mesh: &TriangleMesh, triangle: usize) -> Self {
        let points = mesh.triangles()[triangle].to_vec();
        Self { is_in: points.iter().copied().collect(), points, last: 0 }
    }

    /// Adds a ring; tells whether there was one.
    fn grow(&mut self, mesh: &TriangleMesh) -> bool {
        let ring = self.last..self.points.len();
        self.last = ring.end;
        for k in ring {
            for &i in mesh.fan(self.points[k] as usize).iter().flat_map(|&t| &mesh.triangles()[t as usize]) {
                if self.is_in.insert(i) {
                    self.points.push(i);
                }
            }
        }
        self.points.len() > self.last
    }
}

/// How many terms were found, the unit, and the coefficients.
fn fit(mesh: &TriangleMesh, points: &[u32], origin: DVec3, axes: [DVec3; 3]) -> (usize, f64, [f64; 10]) {
    let sides: Vec<DVec3> = points.iter().map(|&i| mesh.points()[i as usize] - origin).collect();
    let unit = sides.iter().map(|side| side.length()).fold(0.0, f64::max);
    let row = |side: &DVec3| {
        let side = *side / unit;
        let weight = (-0.5 * side.length_squared()).exp();
        let [x, y, z] = axes.map(|axis| side.dot(axis));
        [1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y, z].map(|term| weight * term)
    };
    let mut rows: Vec<[f64; 11]> = sides.iter().map(row).collect();
    let rank = triangularise(&mut rows, INDEPENDENT);
    let terms = TERMS.into_iter().rev().find(|&terms| rank >= terms).unwrap_or(0);
    let solution = solve(&rows, terms);
    (terms, unit, std::array::from_fn(|k| solution[k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::patterns::height_field;

    fn cubic(x: f64, y: f64) -> f64 {
        0.2 + 0.1 * x - 0.3 * y + 0.5 * x * x - 0.4 * x * y + 0.2 * y * y + 0.1 * x * x * x - 0.2 * x * y * y
    }

    #[test]
    fn points_are_of_fourth_order_and_second_derivatives_of_second() {
        let error = |scale: f64, n: usize| {
            let at = |x: f64, y: f64| scale * cubic(x / scale, y / scale);
            let range = [-scale, scale];
            let mesh = TriangleMesh::new(&height_field(n, n, range, range, at).unwrap()).unwrap();
            let mut worst = [0.0_f64; 2];
            for t in 0..mesh.triangles().len() {
                let patch = FacePatch::new(&mesh, t);
                let jet = patch.at(0.01 * scale / n as f64, -0.02 * scale / n as f64);
                let [x, y, z] = (jet.point / scale).to_array();
                worst[0] = worst[0].max((z - cubic(x, y)).abs());
                // The Gaussian curvature is that of the graph.
                let [fx, fy] = [0.1 + x - 0.4 * y + 0.3 * x * x - 0.2 * y * y, -0.3 - 0.4 * x + 0.4 * y - 0.4 * x * y];
                let [a, b, c] = [1.0 + 0.6 * x, -0.4 - 0.4 * y, 0.4 - 0.4 * x];
                let expected = (a * c - b * b) / (1.0 + fx * fx + fy * fy).powi(2);
                let (n, [u, v]) = (jet.normal(), jet.first);
                let [l, m, k] = jet.second.map(|second| second.dot(n));
                let found = (l * k - m * m) / (u.dot(u) * v.dot(v) - u.dot(v).powi(2)) * scale * scale;
                worst[1] = worst[1].max((found - expected).abs());
            }
            worst
        };
        for scale in [1e-3, 1.0, 1e3] {
            let (coarse, fine) = (error(scale, 17), error(scale, 33));
            assert!(coarse[0] / fine[0] > 10.0 && coarse[1] / fine[1] > 3.0, "{scale}: {coarse:?} {fine:?}");
            assert!(fine[0] < 1e-4 && fine[1] < 3e-2, "{scale}: {fine:?}");
        }
    }

    #[test]
    fn a_mesh_of_two_triangles_is_its_plane() {
        let mesh = TriangleMesh::new(&height_field(2, 2, [0.0, 1.0], [0.0, 1.0], |x, _| x).unwrap()).unwrap();
        let patch = FacePatch::new(&mesh, 1);
        let jet = patch.at(0.1, 0.2);
        assert!((jet.point.z - jet.point.x).abs() < 1e-15 && jet.second.iter().all(|v| v.length() < 1e-14));
        let weights = patch.weights(patch.flat(mesh.corners(1)[2]));
        assert!(weights.iter().zip([0.0, 0.0, 1.0]).all(|(found, expected)| (found - expected).abs() < 1e-15));
    }
}
