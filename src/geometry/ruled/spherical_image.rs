//! The spherical image of a field: its unit vectors as points of the unit sphere, with the triangles of the mesh.
//!
//! The rulings of a strip are parallel to a plane with unit normal `w` (the strip is *conoidal*) exactly if their directions are on
//! the great circle `a·w = 0`. Great circles are the geodesics of the sphere: so a level function whose level curves are mapped to
//! geodesics of the image suggests conoidal strips (Flöry, Nagai, Isvoranu, Pottmann, Wallner 2012, section 2.1). Two things are in
//! the way of that.
//!
//! *Collapse.* Where the surface itself consists of straight lines of the family, as hyperbolic paraboloids, helicoids and
//! hyperboloids do, the directions depend on one parameter and the image is a curve without area, on which there are no gradients.
//! With `s₁ ≥ s₂` the singular values of the map from a triangle to its image, the image is said to have collapsed if
//! `ρ = Σ A s₁ s₂ / Σ A s₁²` is below 0.03: collapsed ones were found below 0.018 for meshes of 21 × 21 points and below 0.007 for
//! 41 × 41, others above 0.09. If the curve is a great circle every strip is conoidal, whatever its boundaries.
//!
//! *Folds.* Where the image covers parts of the sphere twice, in opposite orientations, level curves that are geodesics on one sheet
//! turn back at the fold. The paper leaves such cases out; they are found by the orientation of the triangles of the image. An image
//! that is folded, but all of it near one great circle, is taken for that circle with noise: coarse meshes of conoids have such.

use glam::DVec3;

use super::level_terms::Metric;
use super::{Axis, Field};
use crate::error::{Error, Result, Status};
use crate::mesh::TriangleMesh;
use crate::mesh::operators::{gradients_of_corners, mixed_parts};
use crate::mesh::triangles::blend;

/// An image with `ρ` below this has collapsed.
const COLLAPSED: f64 = 0.03;

/// Directions are on a great circle if the least of their singular values is below this part of the largest.
const FLAT: f64 = 0.01;

/// An image of which more than this part has the other orientation is folded.
const FOLDED: f64 = 0.01;

/// Triangles of the image with less than this part of the median area are not used.
const NO_AREA: f64 = 1e-6;

/// If more triangles than this part of all are not used, the image has collapsed.
const MOST_UNUSED: f64 = 0.9;

/// What a spherical image is like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageKind {
    /// It covers a part of the sphere.
    Regular,
    /// It covers a part of the sphere twice.
    Folded,
    /// It is a great circle: every strip is conoidal.
    GreatCircle,
    /// It is another curve: the surface is ruled, but only strips along its lines are conoidal, and those are planar.
    Curve,
}

/// The measures of a spherical image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageReport {
    /// What they tell.
    pub kind: ImageKind,
    /// `ρ`, 0 to 1: how much of the image is area.
    pub extent: f64,
    /// The part of its area that has the orientation of less of it, 0 to ½.
    pub folded: f64,
    /// The unit vector that the directions are most nearly orthogonal to, up to its sign.
    pub axis: DVec3,
    /// The least singular value of the directions over the largest: 0 if all are orthogonal to the axis.
    pub flatness: f64,
    /// How many triangles have no image, or one without area.
    pub unused_count: usize,
}

/// A spherical image.
#[derive(Clone, Debug)]
pub struct SphericalImage {
    report: ImageReport,
    pub(super) metric: Metric,
}

impl SphericalImage {
    /// The image of a field. Triangles with a corner where the field is not known have none.
    ///
    /// # Errors
    /// The field is of another mesh, or, status `CurvatureSign`, known on no triangle; the place is `field`.
    pub fn new(mesh: &TriangleMesh, field: &Field) -> Result<Self> {
        field.check(mesh)?;
        let count = mesh.triangles().len();
        let corners = |t: usize| mesh.triangles()[t].map(|i| field.directions()[i as usize]);
        let is_known = |t: usize| mesh.triangles()[t].iter().all(|&i| field.is_known()[i as usize]);
        let cross = |t: usize| {
            let [a, b, c] = corners(t);
            (b - a).cross(c - a)
        };
        let area = |t: usize| if is_known(t) { 0.5 * cross(t).length() } else { 0.0 };
        let mut areas: Vec<f64> = (0..count).map(area).collect();
        let known: Vec<usize> = (0..count).filter(|&t| is_known(t)).collect();
        let directions = (0..mesh.points().len()).filter(|&i| field.is_known()[i]).map(|i| field.directions()[i]);
        let axis = match Axis::new(&directions.collect::<Vec<_>>()) {
            Some(axis) if !known.is_empty() => axis,
            _ => {
                let reason = "expected a field that is known somewhere";
                return Err(Error::new(Status::CurvatureSign, reason).at("field"));
            }
        };
        let mut sorted: Vec<f64> = known.iter().map(|&t| areas[t]).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let least = NO_AREA * sorted[sorted.len() / 2];
        let total: f64 = sorted.iter().sum();
        areas.iter_mut().filter(|area| !(**area > least)).for_each(|area| *area = 0.0);
        let unused_count = areas.iter().filter(|area| **area == 0.0).count();
        let extent = extent(mesh, &known, corners);
        let sides = known.iter().map(|&t| (areas[t], cross(t).dot(corners(t).iter().sum())));
        let outward: f64 = sides.filter(|(_, side)| *side > 0.0).map(|(area, _)| area).sum();
        let used: f64 = areas.iter().sum();
        let folded = if used > 0.0 { (outward.min(used - outward) / used).max(0.0) } else { 0.0 };
        let is_collapsed = extent < COLLAPSED
            || total < NO_AREA * 4.0 * std::f64::consts::PI
            || unused_count as f64 > MOST_UNUSED * count as f64;
        // Of a band as thin as that around a great circle a fold is noise.
        let kind = match (is_collapsed, folded > FOLDED) {
            (true, _) | (_, true) if axis.flatness < FLAT => ImageKind::GreatCircle,
            (true, _) => ImageKind::Curve,
            (false, true) => ImageKind::Folded,
            (false, false) => ImageKind::Regular,
        };
        let (axis, flatness) = (axis.direction, axis.flatness);
        let report = ImageReport { kind, extent, folded, axis, flatness, unused_count };
        let mut point_areas = vec![0.0; mesh.points().len()];
        let mut hats = vec![[DVec3::ZERO; 3]; count];
        for t in (0..count).filter(|&t| areas[t] > 0.0) {
            let [a, b, c] = corners(t);
            // Corner by corner the gradient is the normal's cross product with the opposite edge, over twice the area.
            let normal = cross(t) / (4.0 * areas[t] * areas[t]);
            hats[t] = [c - b, a - c, b - a].map(|edge| normal.cross(edge));
            let parts = mixed_parts([a, b, c], areas[t]);
            (0..3).for_each(|k| point_areas[mesh.triangles()[t][k] as usize] += parts[k]);
        }
        Ok(Self { report, metric: Metric { areas, hats, point_areas } })
    }

    /// What it is like.
    pub fn report(&self) -> &ImageReport {
        &self.report
    }
}

/// `Σ A s₁ s₂ / Σ A s₁²`.
///
/// With `G_k` the gradients of the corners' functions the map is `J = Σ a_k G_kᵀ`, and in an orthonormal frame `x, y` of the triangle
/// `s₁² + s₂² = ‖J x‖² + ‖J y‖²`, `s₁ s₂ = ‖J x × J y‖`.
fn extent(mesh: &TriangleMesh, known: &[usize], corners: impl Fn(usize) -> [DVec3; 3]) -> f64 {
    let (mut areas, mut squares) = (0.0, 0.0);
    for &t in known {
        let hats = gradients_of_corners(mesh, t);
        let x = mesh.normal(t).any_orthonormal_vector();
        let frame = [x, mesh.normal(t).cross(x)];
        let image = frame.map(|axis| blend(corners(t), hats.map(|hat| hat.dot(axis))));
        let (sum, product) = (image[0].length_squared() + image[1].length_squared(), image[0].cross(image[1]).length());
        areas += mesh.area(t) * product;
        squares += mesh.area(t) * 0.5 * (sum + (sum * sum - 4.0 * product * product).max(0.0).sqrt());
    }
    if squares > 0.0 { areas / squares } else { 0.0 }
}
