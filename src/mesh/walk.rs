//! Straight on over a triangle mesh.
//!
//! At an edge the direction is turned about it into the plane of the next triangle, as if both were unfolded into one plane, so
//! that a walk never leaves the mesh: it is a straightest geodesic (Polthier and Schmies 1998) but for points of the mesh. What
//! is walked in are the weights of a triangle's corners. Each changes at a constant rate, and the first to fall to 0 tells the
//! edge, of which the walk is then exactly a point.
//!
//! A straight line cannot leave a triangle by the edge that it came in by, so that edge is not asked: round-off does not send
//! the walk back and forth. At a point of the mesh it goes around in one sense, triangle by triangle, until one has its
//! direction inside.

use glam::DVec3;

use super::{SurfacePoint, TriangleMesh};

/// Triangles that a walk goes through, as a multiple of those of the mesh, at most: beyond it, the walk ends where it is. Steps
/// are short, and no such walk is known; the bound says that there is an end.
const MOST_ROUNDS: usize = 64;

/// A point of a mesh, and a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walker {
    /// The point.
    pub at: SurfacePoint,
    /// The unit vector to go along, in the plane of its triangle.
    pub heading: DVec3,
}

/// Why a walk ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Halt {
    /// It is as long as asked for.
    Arrived,
    /// At the boundary.
    Boundary,
    /// At the edge of a triangle that must not be entered.
    Blocked,
}

impl Walker {
    /// Goes straight on for `distance`, in model units, at most; tells how far. Triangles for which `is_blocked` are not entered.
    pub fn walk(&mut self, mesh: &TriangleMesh, distance: f64, is_blocked: impl Fn(usize) -> bool) -> (f64, Halt) {
        let (mut left, mut entered) = (distance, None);
        // Again and again a triangle is met around the tip of a sharp cone, or along a geodesic that winds around a thin tube.
        for _ in 0..MOST_ROUNDS * mesh.triangles().len() {
            let triangle = self.at.triangle as usize;
            let (corners, normal) = (mesh.corners(triangle), mesh.normal(triangle));
            let rates = rates(corners, normal, mesh.area(triangle), self.heading);
            let (k, time) = self.exit(corners, rates, entered);
            let weights = &mut self.at.weights;
            for l in 0..3 {
                weights[l] = (weights[l] + time.min(left) * rates[l]).max(0.0);
            }
            if time > left {
                normalise(weights);
                return (distance, Halt::Arrived);
            }
            weights[k] = 0.0;
            normalise(weights);
            left -= time;
            let edge = (k + 1) % 3;
            let Some((other, opposite)) = mesh.across(triangle, edge) else {
                return (distance - left, Halt::Boundary);
            };
            if is_blocked(other) {
                return (distance - left, Halt::Blocked);
            }
            // Outward from this triangle, then inward to the other, along e × n.
            let along = (corners[(k + 2) % 3] - corners[edge]).normalize();
            let (on, out) = (self.heading.dot(along), self.heading.dot(along.cross(normal)));
            self.heading = (on * along + out * along.cross(mesh.normal(other))).normalize();
            // The edge runs the other way there.
            let mut there = [0.0; 3];
            there[opposite] = weights[(k + 2) % 3];
            there[(opposite + 1) % 3] = weights[edge];
            self.at = SurfacePoint { triangle: other as u32, weights: there };
            entered = Some((opposite + 2) % 3);
        }
        (distance - left, Halt::Arrived)
    }

    /// The corner whose weight is the first to reach 0, and after how much of a way.
    fn exit(&self, corners: [DVec3; 3], rates: [f64; 3], entered: Option<usize>) -> (usize, f64) {
        let mut best = (0, f64::INFINITY);
        for k in (0..3).filter(|&k| rates[k] < 0.0 && entered != Some(k)) {
            let time = self.at.weights[k] / -rates[k];
            // Out of both edges at a corner: around it the shorter way. The edge opposite to k has the other one's corner.
            let is_shorter = || {
                let center = corners[3 - best.0 - k];
                let along = |k: usize| self.heading.dot((corners[k] - center).normalize());
                along(best.0) > along(k)
            };
            if time < best.1 || (time == 0.0 && best.1 == 0.0 && is_shorter()) {
                best = (k, time);
            }
        }
        best
    }
}

/// How the weights of corners change along a unit vector `v`: with `v = β (b − a) + γ (c − a)` by `−β − γ`, `β` and `γ`.
fn rates([a, b, c]: [DVec3; 3], normal: DVec3, area: f64, v: DVec3) -> [f64; 3] {
    let factor = 0.5 / area;
    let beta = factor * normal.dot(v.cross(c - a));
    let gamma = factor * normal.dot((b - a).cross(v));
    [-beta - gamma, beta, gamma]
}

fn normalise(weights: &mut [f64; 3]) {
    let sum: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= sum);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::mesh::patterns::{height_field, parametric_surface};

    fn walk(mesh: &TriangleMesh, at: SurfacePoint, heading: DVec3, distance: f64) -> (Walker, f64, Halt) {
        let heading = heading.reject_from_normalized(mesh.normal(at.triangle as usize)).normalize();
        let mut walker = Walker { at, heading };
        let (walked, halt) = walker.walk(mesh, distance, |_| false);
        assert!((walker.heading.length() - 1.0).abs() < 1e-14);
        assert!(walker.heading.dot(mesh.normal(walker.at.triangle as usize)).abs() < 1e-13);
        assert!(
            walker.at.weights.iter().all(|w| *w >= 0.0) && (walker.at.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14
        );
        (walker, walked, halt)
    }

    #[test]
    fn unrolled_walks_are_straight() {
        // A folded strip: facets of width 0.3 about a curved profile, unrolled along s.
        let columns = 21;
        let profile: Vec<[f64; 2]> = (0..columns)
            .scan([0.0, 0.0], |at, i| {
                let now = *at;
                let angle = (0.9 * f64::from(i)).sin();
                *at = [at[0] + 0.3 * angle.cos(), at[1] + 0.3 * angle.sin()];
                Some(now)
            })
            .collect();
        let at = |s: f64, y: f64| {
            let i = ((s / 0.3).floor() as usize).min(19);
            let t = s / 0.3 - i as f64;
            let [a, b] = [profile[i], profile[i + 1]];
            DVec3::new(a[0] + t * (b[0] - a[0]), y, a[1] + t * (b[1] - a[1]))
        };
        let node = |s: f64, y: f64| at((s / 0.3).round() * 0.3 + 1e-12, y);
        let mesh = TriangleMesh::new(&parametric_surface(21, 15, [0.0, 6.0], [-2.0, 2.0], node).unwrap()).unwrap();
        let seam = mesh.triangles().iter().position(|t| {
            t.iter().all(|&i| [6 * 21, 6 * 21 + 1, 7 * 21].contains(&(i as usize)) || i as usize == 7 * 21 + 1)
        });
        let triangle = seam.unwrap() as u32;
        let start = SurfacePoint { triangle, weights: [0.3, 0.3, 0.4] };
        let from = mesh.position(start);
        let s = from.x.hypot(from.z);
        for k in -9..=9 {
            let angle = 0.02 * f64::from(k);
            let heading = (at(0.2, 0.0) - at(0.0, 0.0)).normalize() * angle.cos() + DVec3::Y * angle.sin();
            for distance in [0.01, 1.0, 3.7, 5.5] {
                let (walker, walked, halt) = walk(&mesh, start, heading, distance);
                assert!(halt == Halt::Arrived && walked == distance);
                let expected = at(s + distance * angle.cos(), from.y + distance * angle.sin());
                assert!(mesh.position(walker.at).distance(expected) < 1e-10, "{k} {distance}");
            }
            let (walker, walked, halt) = walk(&mesh, start, heading, 9.0);
            assert!(halt == Halt::Boundary && (walked - (6.0 - s) / angle.cos()).abs() < 1e-10);
            assert!(mesh.position(walker.at).distance(at(6.0, from.y + (6.0 - s) * angle.tan())) < 1e-10);
        }
    }

    #[test]
    fn walks_from_and_through_points_of_a_plane_are_straight_whichever_triangle_they_begin_in() {
        let mesh = TriangleMesh::new(&height_field(9, 9, [-1.0, 1.0], [-1.0, 1.0], |_, _| 0.0).unwrap()).unwrap();
        for point in (0..81).filter(|&i| !mesh.is_on_boundary(i)) {
            for &triangle in mesh.fan(point) {
                let weights = mesh.triangles()[triangle as usize].map(|i| f64::from(u8::from(i as usize == point)));
                // Multiples of 45° run along edges, and over points.
                for k in 0..32 {
                    let angle = f64::from(k) * std::f64::consts::TAU / 32.0;
                    let heading = DVec3::new(angle.cos(), angle.sin(), 0.0);
                    let at = SurfacePoint { triangle, weights };
                    let (walker, walked, halt) = walk(&mesh, at, heading, 0.24);
                    assert!(halt == Halt::Arrived && walked == 0.24 && walker.heading.distance(heading) < 1e-14);
                    let expected = mesh.points()[point] + 0.24 * heading;
                    assert!(mesh.position(walker.at).distance(expected) < 1e-14);
                    let (walker, walked, halt) = walk(&mesh, at, heading, 9.0);
                    let end = mesh.position(walker.at);
                    assert!(halt == Halt::Boundary && (end.abs().max_element() - 1.0).abs() < 1e-14);
                    assert!(end.distance(mesh.points()[point] + walked * heading) < 1e-13);
                }
            }
        }
    }

    #[test]
    fn a_walk_that_begins_at_the_tip_of_a_cone_goes_down_it() {
        // Eight sides of a steep pyramid, and a fan of more than a full angle, folded up and down.
        for rise in [-3.0, 3.0, 0.0] {
            let rim = |i: u32| {
                let angle = f64::from(i) * std::f64::consts::TAU / 8.0;
                DVec3::new(angle.cos(), angle.sin(), if rise == 0.0 { 2.0 * f64::from(i % 2) - 1.0 } else { rise })
            };
            let points = [DVec3::ZERO].into_iter().chain((0..8).map(rim)).collect();
            let faces = (0..8).map(|i| vec![0, 1 + i, 1 + (i + 1) % 8]).collect();
            let mesh = TriangleMesh::new(&Mesh { points, faces }).unwrap();
            for triangle in 0..8 {
                for k in 0..24 {
                    let angle = f64::from(k) * std::f64::consts::TAU / 24.0;
                    let heading = DVec3::new(angle.cos(), angle.sin(), 0.1);
                    let at = SurfacePoint { triangle, weights: [1.0, 0.0, 0.0] };
                    let (walker, walked, halt) = walk(&mesh, at, heading, 0.5);
                    assert!(halt == Halt::Arrived && walked == 0.5);
                    assert!((mesh.position(walker.at).length() - 0.5).abs() < 1e-13);
                    assert_eq!(walk(&mesh, at, heading, 9.0).2, Halt::Boundary);
                }
            }
        }
    }

    #[test]
    fn blocked_triangles_are_not_entered() {
        let mesh = TriangleMesh::new(&height_field(9, 9, [-1.0, 1.0], [-1.0, 1.0], |_, _| 0.0).unwrap()).unwrap();
        let is_right = |triangle: usize| mesh.corners(triangle).iter().sum::<DVec3>().x > 0.0;
        let left = (0..128).find(|&t| !is_right(t)).unwrap();
        let mut walker =
            Walker { at: SurfacePoint { triangle: left as u32, weights: [0.2, 0.3, 0.5] }, heading: DVec3::X };
        let from = mesh.position(walker.at).x;
        let (walked, halt) = walker.walk(&mesh, 2.0, is_right);
        assert!(halt == Halt::Blocked && (walked + from).abs() < 1e-14 && mesh.position(walker.at).x.abs() < 1e-15);
    }
}
