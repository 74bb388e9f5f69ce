//! How planar and how circular the faces of a net are.

use glam::DVec3;

use crate::error::Result;
use crate::geometry::circle::Circle;
use crate::mesh::{Grid, Mesh};

/// Residuals of all faces, in their order; all relative, 0 for a circular net.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quality {
    /// The distance of the lines of the diagonals over the mean edge.
    pub planarity: Vec<f64>,
    /// How far the fourth corner is from the circle through the other three, in its plane and out of it, over the radius. Where
    /// three corners are on a line, the distance of the fourth from it over the mean edge.
    pub concyclicity: Vec<f64>,
    /// Whether the corners follow each other around the circle in their order: the quad does not cross itself.
    pub is_in_order: Vec<bool>,
}

impl Quality {
    /// Of the faces of a grid.
    pub fn of(grid: &Grid) -> Self {
        Self::of_quads(grid.quads().map(|quad| quad.map(|corner| grid.points()[corner])))
    }

    /// Of the faces of a mesh of quads.
    ///
    /// # Errors
    /// As [`Mesh::check`]. Status `NotGrid`: a face that has not four corners; the place is `faces[i]`.
    pub fn of_mesh(mesh: &Mesh) -> Result<Self> {
        mesh.check()?;
        let quads = super::parallel::quads(mesh)?;
        Ok(Self::of_quads(quads.into_iter().map(|quad| quad.map(|corner| mesh.points[corner]))))
    }

    fn of_quads(quads: impl Iterator<Item = [DVec3; 4]>) -> Self {
        let mut quality = Self::default();
        for quad in quads {
            quality.planarity.push(planarity(quad));
            quality.concyclicity.push(concyclicity(quad));
            quality.is_in_order.push(is_in_order(quad));
        }
        quality
    }

    /// The number of faces that cross themselves.
    pub fn crossed_count(&self) -> usize {
        self.is_in_order.iter().filter(|&&is_in_order| !is_in_order).count()
    }
}

/// The largest of some residuals; 0 of none.
pub fn largest(residuals: &[f64]) -> f64 {
    residuals.iter().copied().fold(0.0, f64::max)
}

fn mean_edge([a, b, c, d]: [DVec3; 4]) -> f64 {
    0.25 * (a.distance(b) + b.distance(c) + c.distance(d) + d.distance(a))
}

/// `|(b − a)·n̂| / mean edge` with `n = (c − a) × (d − b)`, the normal to both diagonals.
pub fn planarity(quad: [DVec3; 4]) -> f64 {
    let [a, b, c, d] = quad;
    let edge = mean_edge(quad);
    let height = ((c - a) / edge).cross((d - b) / edge).try_normalize().map_or(0.0, |normal| (b - a).dot(normal));
    if edge > 0.0 { (height / edge).abs() } else { 0.0 }
}

/// See [`Quality::concyclicity`].
pub fn concyclicity(quad: [DVec3; 4]) -> f64 {
    let [a, b, c, d] = quad;
    let edge = mean_edge(quad);
    if !(edge > 0.0) {
        return 0.0;
    }
    match Circle::through(a, b, c) {
        Some(circle) => {
            let q = d - circle.center;
            ((q.length() - circle.radius).abs() + q.dot(circle.normal).abs()) / circle.radius
        }
        None => {
            let along = [b - a, c - a, c - b].into_iter().max_by(|x, y| x.length().total_cmp(&y.length()));
            let along = along.unwrap_or(DVec3::ZERO).normalize_or_zero();
            (d - a).reject_from(along).length() / edge
        }
    }
}

/// Whether the corners of a circular quad follow each other around its circle. Three on a line: whether the quad's two ways of
/// being cut into triangles turn alike.
fn is_in_order([a, b, c, d]: [DVec3; 4]) -> bool {
    match Circle::through(a, b, c) {
        Some(circle) => circle.angle_between(a, d) > circle.angle_between(a, c),
        None => {
            let normal = (c - a).cross(d - b);
            (b - a).cross(d - a).dot(normal) >= 0.0 && (d - c).cross(b - c).dot(normal) >= 0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quality(corners: [[f64; 3]; 4]) -> (f64, f64, bool) {
        let quality = Quality::of_quads(std::iter::once(corners.map(DVec3::from)));
        (quality.planarity[0], quality.concyclicity[0], quality.is_in_order[0])
    }

    #[test]
    fn a_lifted_corner_counts_as_it_should() {
        // The unit square with one corner at height h: a and c on the diagonal (1, 1, h), b and d at z = 0.
        // n = (1, 1, h) × (−1, 1, 0) = (−h, −h, 2); |(b − a)·n̂| = h / √(4 + 2h²); edges 1, √(1 + h²) twice each.
        let h: f64 = 0.1;
        let (planarity, concyclicity, is_in_order) =
            quality([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, h], [0.0, 1.0, 0.0]]);
        assert!((planarity - h / (4.0 + 2.0 * h * h).sqrt() / (0.5 + 0.5 * (1.0 + h * h).sqrt())).abs() < 1e-15);
        assert!(concyclicity > 0.01 && is_in_order);
        // A kite: circle of (±1, 0), (0, b) has the center (0, (b² − 1)/2b) and radius (b² + 1)/2b; (0, −b) is 2b − (b²+1)/b off.
        let b: f64 = 1.2;
        let radius = (b * b + 1.0) / (2.0 * b);
        let (planarity, concyclicity, _) = quality([[1.0, 0.0, 0.0], [0.0, b, 0.0], [-1.0, 0.0, 0.0], [0.0, -b, 0.0]]);
        assert!(planarity < 1e-15 && (concyclicity - (2.0 * b - 2.0 * radius) / radius).abs() < 1e-14);
    }

    #[test]
    fn crossed_quads_are_circular_but_not_in_order() {
        let at = |angle: f64| [angle.cos(), angle.sin(), 0.0];
        let (planarity, concyclicity, is_in_order) = quality([0.1, 1.0, 2.5, 4.0].map(at));
        assert!(planarity < 1e-15 && concyclicity < 1e-14 && is_in_order);
        let (_, concyclicity, is_in_order) = quality([0.1, 1.0, 4.0, 2.5].map(at));
        assert!(concyclicity < 1e-14 && !is_in_order);
        assert!(quality([4.0, 2.5, 1.0, 0.1].map(at)).2);
    }

    #[test]
    fn points_on_a_line_have_a_line_for_a_circle() {
        let line = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
        assert_eq!((quality(line).0, quality(line).1), (0.0, 0.0));
        let (_, concyclicity, is_in_order) = quality([[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
        assert!((concyclicity - 1.0 / (0.25 * (2.0 + 2.0 * 2.0_f64.sqrt()))).abs() < 1e-14 && is_in_order);
        let point = quality([[1.0; 3]; 4]);
        assert_eq!((point.0, point.1), (0.0, 0.0));
    }
}
