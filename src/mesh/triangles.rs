//! Oriented triangle meshes for calculus on surfaces: what lies across an edge and around a point, areas and normals.

use std::collections::HashMap;

use glam::DVec3;

use super::{Mesh, Topology};
use crate::error::{Error, Result, Status};

/// Areas below this multiple of the square of the longest edge leave no normal: round-off of the cross product is 1e-16 of it.
const NO_AREA: f64 = 1e-12;

/// What [`TriangleMesh::across`] holds at the boundary.
const NONE: u32 = u32::MAX;

/// A triangle mesh whose triangles agree on what is up: manifold, every point used, no triangle without area.
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The face of the mesh given that each triangle is of.
    faces: Vec<u32>,
    /// Over each edge, from a corner to the next, three times the triangle there and the number of the edge in it.
    across: Vec<[u32; 3]>,
    /// The triangles around point `i` are `fans[fan_starts[i]..fan_starts[i + 1]]`.
    fan_starts: Vec<u32>,
    fans: Vec<u32>,
    is_on_boundary: Vec<bool>,
    boundary: Vec<Vec<u32>>,
    areas: Vec<f64>,
    normals: Vec<DVec3>,
    point_normals: Vec<DVec3>,
}

/// A point of a triangle mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The triangle.
    pub triangle: u32,
    /// The weights of its corners, which add up to 1; none is negative.
    pub weights: [f64; 3],
}

impl TriangleMesh {
    /// Takes the triangles of `mesh`. Quads are split along their shorter diagonal, larger faces into a fan. Edge `k` of a
    /// triangle runs from its corner `k` to the next.
    ///
    /// # Errors
    /// As [`Mesh::check_polygons`], or no face (the place is `faces`). Status `NotManifold`: an edge has three faces, its two
    /// faces run along it the same way, or the faces around a point are several fans; the place is `faces` or `points[i]`.
    /// `InvalidValue`: no face uses a point (`points[i]`). `Degenerate`: a face without area, or one that no fan splits
    /// (`faces[i]`).
    pub fn new(mesh: &Mesh) -> Result<Self> {
        mesh.check_polygons()?;
        if mesh.faces.is_empty() {
            return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("faces"));
        }
        let topology = Topology::new(mesh)?;
        check_manifold(mesh, &topology)?;
        let (mut triangles, mut faces) = (Vec::with_capacity(mesh.faces.len()), Vec::with_capacity(mesh.faces.len()));
        for (i, face) in mesh.faces.iter().enumerate() {
            let split = split(&mesh.points, face).ok_or_else(|| {
                let reason = "expected a face with an area, which a fan of triangles covers";
                Error::new(Status::Degenerate, reason).at(format!("faces[{i}]"))
            })?;
            faces.extend(std::iter::repeat_n(i as u32, split.len()));
            triangles.extend(split);
        }
        if triangles.len() > (u32::MAX / 3) as usize {
            let reason = format!("{} triangles do not fit 32-bit indices", triangles.len());
            return Err(Error::new(Status::TooLarge, reason).at("faces"));
        }
        let across = across(&triangles);
        let (fan_starts, fans) = fans(mesh.points.len(), &triangles, &across);
        let crosses = triangles.iter().map(|triangle| cross(&mesh.points, triangle));
        let (areas, normals): (Vec<f64>, Vec<DVec3>) =
            crosses.map(|cross| (0.5 * cross.length(), cross.normalize())).unzip();
        let mut point_normals = vec![DVec3::ZERO; mesh.points.len()];
        for (t, triangle) in triangles.iter().enumerate() {
            for k in 0..3 {
                let side = |l: usize| mesh.points[triangle[l % 3] as usize] - mesh.points[triangle[k] as usize];
                let weight = areas[t] / (side(k + 1).length_squared() * side(k + 2).length_squared());
                point_normals[triangle[k] as usize] += weight * normals[t];
            }
        }
        for (i, normal) in point_normals.iter_mut().enumerate() {
            // Where the triangles around a point face all ways, any of theirs is as good.
            *normal = normal.try_normalize().unwrap_or(normals[fans[fan_starts[i] as usize] as usize]);
        }
        Ok(Self {
            points: mesh.points.clone(),
            triangles,
            faces,
            across,
            fan_starts,
            fans,
            is_on_boundary: topology.boundary_points(),
            boundary: topology.boundary().into_iter().map(|chain| chain.points).collect(),
            areas,
            normals,
            point_normals,
        })
    }

    /// The points, as in the mesh given.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The corners of each triangle, counterclockwise seen from where the normals point.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The face of the mesh given that a triangle is of.
    pub fn face_of(&self, triangle: usize) -> usize {
        self.faces[triangle] as usize
    }

    /// The triangle over edge `k` of a triangle, and the number of that edge there; none at the boundary.
    pub fn across(&self, triangle: usize, k: usize) -> Option<(usize, usize)> {
        let found = self.across[triangle][k];
        (found != NONE).then_some(((found / 3) as usize, (found % 3) as usize))
    }

    /// The triangles around a point, counterclockwise; at the boundary from its one end to the other.
    pub fn fan(&self, point: usize) -> &[u32] {
        &self.fans[self.fan_starts[point] as usize..self.fan_starts[point + 1] as usize]
    }

    /// The points that share an edge with a point, counterclockwise; at the boundary from its one end to the other.
    pub fn neighbours(&self, point: usize) -> Vec<u32> {
        let fan = self.fan(point);
        let corner = |t: u32, k: usize| {
            let triangle = self.triangles[t as usize];
            triangle[(triangle.iter().position(|&i| i as usize == point).unwrap_or(0) + k) % 3]
        };
        let mut around: Vec<u32> = fan.iter().map(|&t| corner(t, 1)).collect();
        if self.is_on_boundary[point] {
            around.extend(fan.last().map(|&t| corner(t, 2)));
        }
        around
    }

    /// Each edge once, the lower point first, in the order of the triangles.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let mut edges = Vec::with_capacity(3 * self.triangles.len() / 2 + 1);
        for (t, triangle) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
                if self.across(t, k).is_none_or(|(other, _)| other > t) {
                    edges.push([a.min(b), a.max(b)]);
                }
            }
        }
        edges
    }

    /// Whether a point is on the boundary.
    pub fn is_on_boundary(&self, point: usize) -> bool {
        self.is_on_boundary[point]
    }

    /// The loops of the boundary, each with the surface to its left; the first point is not repeated.
    pub fn boundary(&self) -> &[Vec<u32>] {
        &self.boundary
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|i| self.points[i as usize])
    }

    /// The area of a triangle, in square model units.
    pub fn area(&self, triangle: usize) -> f64 {
        self.areas[triangle]
    }

    /// The sum of all areas.
    pub fn total_area(&self) -> f64 {
        self.areas.iter().sum()
    }

    /// The unit normal of a triangle.
    pub fn normal(&self, triangle: usize) -> DVec3 {
        self.normals[triangle]
    }

    /// The unit normals at the points: of the triangles around each, weighted by area over the squares of the two edges at the
    /// point, which makes them exact for points on a sphere (Max 1999, "Weights for computing vertex normals from facet normals").
    /// Of first order in the edges, of second where the triangles around a point are symmetric.
    pub fn point_normals(&self) -> &[DVec3] {
        &self.point_normals
    }

    /// The mean length of the edges.
    pub fn mean_edge(&self) -> f64 {
        let edges = self.edges();
        let sum: f64 = edges.iter().map(|&[a, b]| self.points[a as usize].distance(self.points[b as usize])).sum();
        sum / edges.len() as f64
    }

    /// The diagonal of the box that holds all points, along the axes.
    pub fn diagonal(&self) -> f64 {
        super::grid::diagonal(&self.points)
    }

    /// The parts that no edge connects: for each triangle the number of its part, and how many there are.
    pub fn components(&self) -> (Vec<u32>, usize) {
        let mut component = vec![NONE; self.triangles.len()];
        let mut count = 0;
        for first in 0..self.triangles.len() {
            if component[first] != NONE {
                continue;
            }
            component[first] = count;
            let mut open = vec![first];
            while let Some(t) = open.pop() {
                for (other, _) in (0..3).filter_map(|k| self.across(t, k)) {
                    if component[other] == NONE {
                        component[other] = count;
                        open.push(other);
                    }
                }
            }
            count += 1;
        }
        (component, count as usize)
    }

    /// Where a point of the mesh lies.
    pub fn position(&self, at: SurfacePoint) -> DVec3 {
        blend(self.corners(at.triangle as usize), at.weights)
    }

    /// The unit normal at a point of the mesh, blended from those of the corners, so that it is continuous.
    pub fn normal_at(&self, at: SurfacePoint) -> DVec3 {
        let triangle = self.triangles[at.triangle as usize];
        let blended = blend(triangle.map(|i| self.point_normals[i as usize]), at.weights);
        blended.try_normalize().unwrap_or(self.normals[at.triangle as usize])
    }

    /// The point of a triangle that is in the direction of its normal from `point`, or nearest to that if outside: its weights
    /// are clamped to be none below 0.
    pub fn surface_point(&self, triangle: usize, point: DVec3) -> SurfacePoint {
        let ([a, b, c], normal) = (self.corners(triangle), self.normals[triangle]);
        let part = |from: DVec3, to: DVec3| normal.dot((to - from).cross(point - from)).max(0.0);
        let parts = [part(b, c), part(c, a), part(a, b)];
        let sum: f64 = parts.iter().sum();
        let weights = if sum > 0.0 { parts.map(|part| part / sum) } else { [1.0, 0.0, 0.0] };
        SurfacePoint { triangle: triangle as u32, weights }
    }
}

/// The sum of the corners, each by its weight.
pub fn blend([a, b, c]: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    weights[0] * a + weights[1] * b + weights[2] * c
}

fn check_manifold(mesh: &Mesh, topology: &Topology) -> Result<()> {
    let refusal = |[a, b]: [u32; 2], reason: &str| {
        Err(Error::new(Status::NotManifold, format!("{reason} the edge from point {a} to point {b}")).at("faces"))
    };
    if let Some(&edge) = topology.non_manifold_edges().first() {
        return refusal(edge, "expected one or two faces at each edge, found more at");
    }
    if let Some(&edge) = topology.misoriented_edges().first() {
        return refusal(edge, "expected faces of one orientation, found two that run the same way along");
    }
    let mut is_used = vec![false; mesh.points.len()];
    mesh.faces.iter().flatten().for_each(|&point| is_used[point as usize] = true);
    if let Some(i) = is_used.iter().position(|is_used| !is_used) {
        let reason = "expected a point that a face uses, found one that none does";
        return Err(Error::new(Status::InvalidValue, reason).at(format!("points[{i}]")));
    }
    match (0..mesh.points.len()).find(|&i| !topology.neighbours(i as u32).is_ordered) {
        None => Ok(()),
        Some(i) => {
            let reason = "expected one fan of faces around a point, found several that touch here only";
            Err(Error::new(Status::NotManifold, reason).at(format!("points[{i}]")))
        }
    }
}

fn cross(points: &[DVec3], triangle: &[u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|i| points[i as usize]);
    (b - a).cross(c - a)
}

/// Triangles that cover a face, all facing the same way; none where there are no such.
fn split(points: &[DVec3], face: &[u32]) -> Option<Vec<[u32; 3]>> {
    let n = face.len();
    let at = |i: usize| points[face[i % n] as usize];
    let fan = |first: usize| {
        let corner = |i: usize| face[(first + i) % n];
        (1..n - 1).map(|i| [corner(0), corner(i), corner(i + 1)]).collect::<Vec<_>>()
    };
    let longest = (0..n).map(|i| at(i).distance_squared(at(i + 1))).fold(0.0, f64::max);
    // Newell's normal: the sum of all corners' cross products about one of them.
    let normal: DVec3 = (1..n - 1).map(|i| (at(i) - at(0)).cross(at(i + 1) - at(0))).sum();
    let is_good = |fan: &Vec<[u32; 3]>| {
        fan.iter().map(|triangle| cross(points, triangle)).all(|cross| {
            let is_finite = cross.is_finite() && normal.is_finite();
            is_finite && cross.length() > NO_AREA * longest && cross.dot(normal) > 0.0
        })
    };
    let first = usize::from(n == 4 && at(1).distance_squared(at(3)) < at(0).distance_squared(at(2)));
    (first..first + n).map(fan).find(is_good)
}

/// Over each edge, three times the other triangle and the edge's number in it.
fn across(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut across = vec![[NONE; 3]; triangles.len()];
    let mut waiting = HashMap::with_capacity(3 * triangles.len() / 2 + 1);
    for (t, triangle) in triangles.iter().enumerate() {
        for k in 0..3 {
            let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
            match waiting.remove(&(b, a)) {
                None => drop(waiting.insert((a, b), (t, k))),
                Some((other, l)) => {
                    across[t][k] = (3 * other + l) as u32;
                    across[other][l] = (3 * t + k) as u32;
                }
            }
        }
    }
    across
}

/// The triangles around each point, in order.
fn fans(point_count: usize, triangles: &[[u32; 3]], across: &[[u32; 3]]) -> (Vec<u32>, Vec<u32>) {
    // Some corner of each point; at the boundary the one with no triangle before it.
    let mut first = vec![NONE; point_count];
    for (t, triangle) in triangles.iter().enumerate() {
        for (k, &point) in triangle.iter().enumerate() {
            if first[point as usize] == NONE || across[t][k] == NONE {
                first[point as usize] = (3 * t + k) as u32;
            }
        }
    }
    let (mut starts, mut fans) = (vec![0], Vec::with_capacity(3 * triangles.len()));
    for start in first {
        let mut now = start;
        while now != NONE {
            let (t, k) = (now / 3, now % 3);
            fans.push(t);
            // Counterclockwise over the edge that ends at the point; there it begins at it.
            now = across[t as usize][(k as usize + 2) % 3];
            if now == start {
                break;
            }
        }
        starts.push(fans.len() as u32);
    }
    (starts, fans)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::patterns::height_field;

    fn saddle() -> TriangleMesh {
        let mesh = height_field(6, 5, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap();
        TriangleMesh::new(&mesh).unwrap()
    }

    fn refusal(points: &[[f64; 3]], faces: &[&[u32]]) -> (Status, String) {
        let points = points.iter().map(|&point| DVec3::from_array(point)).collect();
        let faces = faces.iter().map(|face| face.to_vec()).collect();
        let error = TriangleMesh::new(&Mesh { points, faces }).unwrap_err();
        (error.status(), error.place().to_owned())
    }

    #[test]
    fn what_is_across_an_edge_has_the_edge_too() {
        let mesh = saddle();
        assert_eq!(mesh.triangles().len(), 40);
        let mut boundary_edges = 0;
        for t in 0..40 {
            for k in 0..3 {
                let ends = |(t, k): (usize, usize)| [mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]];
                match mesh.across(t, k) {
                    None => boundary_edges += 1,
                    Some(other) => {
                        let [a, b] = ends((t, k));
                        assert_eq!(ends(other), [b, a]);
                        assert_eq!(mesh.across(other.0, other.1), Some((t, k)));
                    }
                }
            }
        }
        assert_eq!((boundary_edges, mesh.boundary()[0].len()), (18, 18));
        // Euler: V − E + F = 1.
        assert_eq!(mesh.points().len() + 40 - mesh.edges().len(), 1);
        assert_eq!(mesh.components().1, 1);
    }

    #[test]
    fn fans_go_around_each_point_once_and_in_order() {
        let mesh = saddle();
        let mut count = 0;
        for i in 0..mesh.points().len() {
            let fan = mesh.fan(i);
            count += fan.len();
            assert!(fan.iter().all(|&t| mesh.triangles()[t as usize].contains(&(i as u32))));
            let is_next =
                |pair: &[u32]| (0..3).any(|k| mesh.across(pair[0] as usize, k).map(|x| x.0 as u32) == Some(pair[1]));
            assert!(fan.windows(2).all(is_next));
            let around = mesh.neighbours(i);
            assert_eq!(around.len(), fan.len() + usize::from(mesh.is_on_boundary(i)));
            let at = |j: usize| mesh.points()[around[j % around.len()] as usize] - mesh.points()[i];
            let turns = if mesh.is_on_boundary(i) { around.len() - 1 } else { around.len() };
            assert!((0..turns).all(|j| at(j).cross(at(j + 1)).dot(mesh.point_normals()[i]) > 0.0));
        }
        assert_eq!(count, 120);
    }

    #[test]
    fn areas_and_normals_are_those_of_the_saddle() {
        // The area of z = xy over a square by Simpson's rule in both directions, of the mesh to second order.
        let integrand = |x: f64, y: f64| (1.0 + x * x + y * y).sqrt();
        let (n, mut area) = (100, 0.0);
        for i in 0..=n {
            for j in 0..=n {
                let weight = |i: usize| if i == 0 || i == n { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
                let at = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
                area += weight(i) * weight(j) * integrand(at(i), at(j)) * (2.0 / n as f64 / 3.0_f64).powi(2);
            }
        }
        let error = |n: usize| {
            let mesh = height_field(n + 1, n + 1, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap();
            let mesh = TriangleMesh::new(&mesh).unwrap();
            let normal = |p: &DVec3| DVec3::new(-p.y, -p.x, 1.0).normalize();
            let normals = mesh.points().iter().zip(mesh.point_normals()).enumerate();
            let worst = normals.filter(|(i, _)| !mesh.is_on_boundary(*i)).map(|(_, (p, n))| n.distance(normal(p)));
            ((mesh.total_area() - area).abs(), worst.fold(0.0, f64::max))
        };
        let (coarse, fine) = (error(10), error(20));
        assert!(coarse.0 < 0.02 && coarse.0 / fine.0 > 3.7, "{coarse:?} {fine:?}");
        // Of first order only along the axes, where the shorter diagonals change their direction.
        assert!(coarse.1 < 0.06 && coarse.1 / fine.1 > 1.9, "{coarse:?} {fine:?}");
    }

    #[test]
    fn a_point_of_a_triangle_is_found_again() {
        let mesh = saddle();
        let at = SurfacePoint { triangle: 7, weights: [0.2, 0.5, 0.3] };
        let found = mesh.surface_point(7, mesh.position(at) + 0.3 * mesh.normal(7));
        assert!((0..3).all(|k| (found.weights[k] - at.weights[k]).abs() < 1e-14));
        let outside = mesh.surface_point(7, mesh.corners(7)[0] + 9.0 * (mesh.corners(7)[0] - mesh.corners(7)[1]));
        assert!(outside.weights.iter().all(|&w| (0.0..=1.0).contains(&w)));
    }

    #[test]
    fn a_dart_is_split_inside() {
        // The corner at (0.2, 0.2) is reflex: the other diagonal, though longer, is the one inside.
        let points = [[0.0, 0.0], [2.0, -2.0], [0.2, 0.0], [2.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let mesh = TriangleMesh::new(&Mesh { points: points.to_vec(), faces: vec![vec![0, 1, 2, 3]] }).unwrap();
        assert!((mesh.total_area() - 0.4).abs() < 1e-15);
        assert_eq!((mesh.triangles().len(), mesh.face_of(1)), (2, 0));
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.0, 1.0]];
        let expect = |status, place: &str| (status, place.to_owned());
        assert_eq!(refusal(&points[..3], &[]), expect(Status::InvalidArgumentLength, "faces"));
        assert_eq!(refusal(&points[..4], &[&[0, 1, 2]]), expect(Status::InvalidValue, "points[3]"));
        assert_eq!(refusal(&points[..4], &[&[0, 1, 2], &[1, 2, 3]]), expect(Status::NotManifold, "faces"));
        let fins: [&[u32]; 3] = [&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]];
        assert_eq!(refusal(&points, &fins), expect(Status::NotManifold, "faces"));
        let tip: [&[u32]; 2] = [&[0, 1, 2], &[2, 3, 4]];
        assert_eq!(refusal(&points, &tip), expect(Status::NotManifold, "points[2]"));
        let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
        assert_eq!(refusal(&flat, &[&[0, 1, 2]]), expect(Status::Degenerate, "faces[0]"));
        let huge = [[0.0, 0.0, 0.0], [1e200, 0.0, 0.0], [0.0, 1e200, 0.0]];
        assert_eq!(refusal(&huge, &[&[0, 1, 2]]), expect(Status::Degenerate, "faces[0]"));
    }
}
