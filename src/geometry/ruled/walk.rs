//! Walks along a field from triangle to triangle, to the boundary of the mesh.
//!
//! On each triangle the walk is straight, along the field at the middle. Where the fields of two triangles lead to their common edge
//! from both sides, or along it, the walk follows the edge.

use glam::DVec3;

use super::Field;
use crate::mesh::operators::gradients_of_corners;
use crate::mesh::{SurfacePoint, TriangleMesh};

/// Weights below this are those of points on an edge.
const ON_EDGE: f64 = 1e-12;

/// Directions that leave an edge by less than this part of a triangle's size for each of its length lead along it.
const ALONG: f64 = 1e-9;

/// Where a walk has got to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Walked {
    pub end: SurfacePoint,
    /// Whether it ended at the boundary, or where the field is not known; otherwise it was stopped.
    pub is_out: bool,
}

/// Walks from a point along the field, against it if `sign` is −1, until `stop` says so of a point on the way (where a triangle is
/// left), or out.
pub(super) fn walk(
    mesh: &TriangleMesh,
    field: &Field,
    from: SurfacePoint,
    sign: f64,
    stop: &mut dyn FnMut(SurfacePoint) -> bool,
) -> Walked {
    let mut walked = Walked { end: from, is_out: false };
    for _ in 0..mesh.triangles().len() + 100 {
        let Some(end) = from_point(mesh, field, walked.end, sign) else {
            return Walked { is_out: true, ..walked };
        };
        walked.end = end;
        if stop(walked.end) {
            return walked;
        }
    }
    walked
}

/// The end of the way from a point through one triangle.
fn from_point(mesh: &TriangleMesh, field: &Field, at: SurfacePoint, sign: f64) -> Option<SurfacePoint> {
    let t = at.triangle as usize;
    let zeros = (0..3).filter(|&k| at.weights[k] <= ON_EDGE).count();
    if zeros == 2 {
        return from_corner(mesh, field, at, sign);
    }
    if let Some(k) = (0..3).find(|&k| at.weights[k] <= ON_EDGE) {
        // On the edge opposite to corner k: into this triangle, into that across, or along.
        if let Some((rates, is_in)) = rates(mesh, field, t, sign, Some(k))
            && is_in
        {
            return through(at, rates);
        }
        let (other, l) = mesh.across(t, (k + 1) % 3)?;
        let mut weights = [0.0; 3];
        (weights[l], weights[(l + 1) % 3]) = (at.weights[(k + 2) % 3], at.weights[(k + 1) % 3]);
        let at = SurfacePoint { triangle: other as u32, weights };
        let (mut rates, is_in) = rates(mesh, field, other, sign, Some((l + 2) % 3))?;
        if !is_in {
            // Both lead to the edge: along it, without what leads off it.
            let mean = 0.5 * (rates[l] - rates[(l + 1) % 3]);
            rates = [0.0; 3];
            (rates[l], rates[(l + 1) % 3]) = (mean, -mean);
        }
        return through(at, rates);
    }
    let (rates, _) = rates(mesh, field, t, sign, None)?;
    through(at, rates)
}

/// From a corner into that triangle of its fan which the field leads into most.
fn from_corner(mesh: &TriangleMesh, field: &Field, at: SurfacePoint, sign: f64) -> Option<SurfacePoint> {
    let heaviest = (0..3).max_by(|&a, &b| at.weights[a].total_cmp(&at.weights[b]))?;
    let point = mesh.triangles()[at.triangle as usize][heaviest] as usize;
    let mut best: Option<(f64, SurfacePoint, [f64; 3])> = None;
    for &t in mesh.fan(point) {
        let corner = mesh.triangles()[t as usize].iter().position(|&i| i as usize == point)?;
        let Some((mut rates, _)) = rates(mesh, field, t as usize, sign, None) else { continue };
        let others = [(corner + 1) % 3, (corner + 2) % 3];
        let least = rates[others[0]].min(rates[others[1]]) / rates[corner].abs().max(f64::MIN_POSITIVE);
        if rates[corner] < 0.0 && best.is_none_or(|(value, ..)| least > value) {
            others.iter().for_each(|&k| rates[k] = rates[k].max(0.0));
            let mut weights = [0.0; 3];
            weights[corner] = 1.0;
            best = Some((least, SurfacePoint { triangle: t, weights }, rates));
        }
    }
    // Inside some triangle is always met, but for the angles that the field turns by; at the boundary none may be.
    let slack = if mesh.is_on_boundary(point) { ALONG } else { 1.0 };
    let (_, at, rates) = best.filter(|(least, ..)| *least >= -slack)?;
    through(at, rates)
}

/// Where a triangle is left at these rates.
fn through(at: SurfacePoint, rates: [f64; 3]) -> Option<SurfacePoint> {
    let leaving = (0..3).filter(|&k| rates[k] < 0.0 && at.weights[k] > ON_EDGE);
    let (time, k) = leaving.map(|k| (-at.weights[k] / rates[k], k)).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let mut weights = [0, 1, 2].map(|j| (at.weights[j] + time * rates[j]).max(0.0));
    weights[k] = 0.0;
    let sum: f64 = weights.iter().sum();
    let weights = weights.map(|weight| if weight <= ON_EDGE { 0.0 } else { weight / sum });
    Some(SurfacePoint { weights, ..at })
}

/// How fast the weights of a triangle's corners change along the field, and whether a point on the edge opposite to a corner is led
/// into the triangle, or along the edge; such rates are 0.
fn rates(mesh: &TriangleMesh, field: &Field, t: usize, sign: f64, on_edge: Option<usize>) -> Option<([f64; 3], bool)> {
    let direction = sign * field.on_triangle(mesh, t)?;
    let mut rates = gradients_of_corners(mesh, t).map(|hat: DVec3| hat.dot(direction));
    let scale = rates.iter().fold(0.0_f64, |scale, rate| scale.max(rate.abs()));
    rates.iter_mut().filter(|rate| rate.abs() <= ALONG * scale).for_each(|rate| *rate = 0.0);
    let is_in = on_edge.is_none_or(|k| rates[k] >= 0.0);
    Some((rates, is_in))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::patterns::parametric_surface;

    /// A plane over `[0, 1]²`, with a field given by its angle, and the triangles of a grid.
    fn plane(angle: impl Fn(f64, f64) -> f64) -> (TriangleMesh, Field) {
        let range = [[0.0, 1.0]; 2];
        let mesh = parametric_surface(11, 11, range[0], range[1], |u, v| DVec3::new(u, v, 0.0)).unwrap();
        let mesh = TriangleMesh::new(&mesh).unwrap();
        let along = |u: f64, v: f64| DVec3::new(angle(u, v).cos(), angle(u, v).sin(), 0.0);
        let directions = parametric_surface(11, 11, range[0], range[1], along).unwrap().points;
        let field = Field::new(&mesh, directions, vec![true; 121]).unwrap();
        (mesh, field)
    }

    fn corner(mesh: &TriangleMesh, point: usize) -> SurfacePoint {
        let t = mesh.fan(point)[0];
        let weights = mesh.triangles()[t as usize].map(|i| if i as usize == point { 1.0 } else { 0.0 });
        SurfacePoint { triangle: t, weights }
    }

    #[test]
    fn walks_along_a_constant_field_are_straight_from_points_edges_and_inside() {
        for angle in [0.0, 0.3, std::f64::consts::FRAC_PI_4, 1.0, std::f64::consts::FRAC_PI_2] {
            let (mesh, field) = plane(|_, _| angle);
            let along = DVec3::new(angle.cos(), angle.sin(), 0.0);
            let edge = SurfacePoint { triangle: 46, weights: [0.5, 0.5, 0.0] };
            let inside = SurfacePoint { triangle: 46, weights: [0.2, 0.5, 0.3] };
            for from in [corner(&mesh, 36), edge, inside] {
                for sign in [1.0, -1.0] {
                    let walked = walk(&mesh, &field, from, sign, &mut |_| false);
                    assert!(walked.is_out);
                    let (start, end) = (mesh.position(from), mesh.position(walked.end));
                    assert!(end.distance(start + sign * start.distance(end) * along) < 1e-12, "{angle} {sign} {end}");
                    let to_border = end.x.min(1.0 - end.x).min(end.y).min(1.0 - end.y);
                    assert!(to_border < 1e-12, "{angle} {sign} {start} {end}");
                }
            }
            let halfway = walk(&mesh, &field, corner(&mesh, 0), 1.0, &mut |at| mesh.position(at).length() > 0.5);
            let way = mesh.position(halfway.end).length();
            assert!(!halfway.is_out && way > 0.5 && way < 0.7);
        }
    }

    #[test]
    fn a_walk_between_fields_that_meet_follows_their_edge() {
        // Down to the line y = ½ from above, up to it from below, and along x.
        let (mesh, field) = plane(|_, v| {
            if v > 0.55 {
                -0.5
            } else if v < 0.45 {
                0.5
            } else {
                0.0
            }
        });
        for start in [22, 88] {
            let walked = walk(&mesh, &field, corner(&mesh, start), 1.0, &mut |_| false);
            let end = mesh.position(walked.end);
            assert!(walked.is_out && (end.x - 1.0).abs() < 1e-12 && (end.y - 0.5).abs() < 0.11, "{end}");
        }
    }
}
