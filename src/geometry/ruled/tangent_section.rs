//! Short pieces of asymptotic curves, by intersecting a mesh with a tangent plane of its own (Flöry et al. 2012, figure 4).
//!
//! Where a surface is negatively curved, its tangent plane at a point cuts it in two curves that cross there, tangent to the
//! two asymptotic directions. Where it is positively curved the plane meets it in the point alone. On a mesh the section is
//! where the function `h`, the height over the plane, linear on triangles, is 0. From each edge on the rim of the triangles
//! around the point that `h` changes its sign along, a branch leads inward. Points on the plane count as above it, so that no
//! branch is lost or found twice. A mesh often does not cross as the surface does, and two branches lead into each other beside
//! the point: then each is taken to where they come nearest, and from there to the point.
//!
//! This shows how asymptotic curves come about; it is no way to find them well. How many neighbours there are around the point
//! does not grow as the mesh gets finer, and directions stay off by some degrees at any fineness.

use std::ops::Range;

use glam::DVec3;

use crate::error::{Error, Result, Status};
use crate::mesh::TriangleMesh;
use crate::mesh::grid::check_finite;

/// Heights below this multiple of the distance from the point are round-off: a mesh that has no others is flat.
const FLAT: f64 = 1e-12;

/// How many rings of triangles a section can go through.
const RINGS: Range<usize> = 1..65;

/// The section of a mesh with its tangent plane at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct TangentSection {
    /// Each branch as a polyline in the plane from the point outward, counterclockwise around it: four where the surface is
    /// negatively curved, none where it is flat or positively curved. At the boundary there are as many as the triangles there
    /// show.
    pub branches: Vec<Vec<DVec3>>,
}

impl TangentSection {
    /// The section with the plane through a point of the mesh, as far as the triangles that some `rings` (1 to 64) edges lead
    /// to. `normal` is that of the surface there: see [`Curvature::normal`](crate::mesh::curvature::Curvature::normal).
    ///
    /// # Errors
    /// `point` or `rings` is out of its range, or `normal` is no direction.
    pub fn new(mesh: &TriangleMesh, point: usize, normal: DVec3, rings: usize) -> Result<Self> {
        let count = mesh.points().len();
        if point >= count {
            let reason = format!("{point} is out of range for {count} points");
            return Err(Error::new(Status::IndexOutOfRange, reason).at("point"));
        }
        if !RINGS.contains(&rings) {
            let reason = format!("expected 1 to {}, found {rings}", RINGS.end - 1);
            return Err(Error::new(Status::InvalidValue, reason).at("rings"));
        }
        check_finite("normal", &[normal]).map_err(|error| error.with_place("normal"))?;
        let Some(normal) = normal.try_normalize() else {
            let reason = format!("expected a vector that is not 0, found {normal}");
            return Err(Error::new(Status::InvalidValue, reason).at("normal"));
        };
        let section = Section { mesh, point, normal, triangles: triangles_within(mesh, point, rings) };
        let mut branches = section.branches();
        let (e1, e2) = normal.any_orthonormal_pair();
        let angle = |branch: &[DVec3]| {
            let side = branch[branch.len() - 1] - branch[0];
            side.dot(e2).atan2(side.dot(e1))
        };
        branches.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        Ok(Self { branches })
    }

    /// The unit vectors in the plane from the point to the end of each branch.
    pub fn directions(&self) -> Vec<DVec3> {
        let along = |branch: &Vec<DVec3>| (branch[branch.len() - 1] - branch[0]).normalize_or_zero();
        self.branches.iter().map(along).collect()
    }
}

/// The triangles that have a corner within `rings − 1` edges of a point, ascending.
fn triangles_within(mesh: &TriangleMesh, point: usize, rings: usize) -> Vec<u32> {
    let (mut points, mut triangles) = (vec![point as u32], Vec::new());
    for _ in 0..rings {
        triangles = points.iter().flat_map(|&i| mesh.fan(i as usize)).copied().collect::<Vec<u32>>();
        triangles.sort_unstable();
        triangles.dedup();
        points = triangles.iter().flat_map(|&t| mesh.triangles()[t as usize]).collect();
        points.sort_unstable();
        points.dedup();
    }
    triangles
}

struct Section<'a> {
    mesh: &'a TriangleMesh,
    point: usize,
    normal: DVec3,
    triangles: Vec<u32>,
}

impl Section<'_> {
    fn height(&self, point: u32) -> f64 {
        self.normal.dot(self.mesh.points()[point as usize] - self.mesh.points()[self.point])
    }

    fn branches(&self) -> Vec<Vec<DVec3>> {
        let is_flat = |i: &u32| self.height(*i).abs() <= FLAT * self.distance(self.mesh.points()[*i as usize]);
        if self.triangles.iter().flat_map(|&t| &self.mesh.triangles()[t as usize]).all(is_flat) {
            return Vec::new();
        }
        let around = self.mesh.neighbours(self.point);
        let reach = around.iter().map(|&i| self.distance(self.mesh.points()[i as usize])).fold(0.0, f64::max);
        let sides = self.triangles.iter().flat_map(|&t| (0..3).map(move |k| (t as usize, k)));
        let rim = sides.filter(|&(t, k)| self.across(t, k).is_none() && !self.has_point(t, k));
        rim.filter_map(|(t, k)| self.branch(t, k, reach)).collect()
    }

    fn distance(&self, from: DVec3) -> f64 {
        from.distance(self.mesh.points()[self.point])
    }

    /// What is across an edge, if among the triangles.
    fn across(&self, triangle: usize, k: usize) -> Option<(usize, usize)> {
        self.mesh.across(triangle, k).filter(|(other, _)| self.triangles.binary_search(&(*other as u32)).is_ok())
    }

    /// Whether the point is an end of the edge.
    fn has_point(&self, triangle: usize, k: usize) -> bool {
        let corners = self.mesh.triangles()[triangle];
        [corners[k], corners[(k + 1) % 3]].contains(&(self.point as u32))
    }

    /// Where the plane crosses edge `k` of a triangle.
    fn crossing(&self, triangle: usize, k: usize) -> Option<DVec3> {
        let corners = self.mesh.triangles()[triangle];
        let ends = [corners[k], corners[(k + 1) % 3]];
        let [a, b] = ends.map(|i| self.height(i));
        let [from, to] = ends.map(|i| self.mesh.points()[i as usize]);
        ((a >= 0.0) != (b >= 0.0)).then(|| from.lerp(to, a / (a - b)))
    }

    /// The branch that ends on an edge of the rim, if the plane crosses it and the branch comes as near as `reach`.
    fn branch(&self, mut triangle: usize, mut k: usize, reach: f64) -> Option<Vec<DVec3>> {
        let mut inward = vec![self.crossing(triangle, k)?];
        while !self.mesh.triangles()[triangle].contains(&(self.point as u32)) {
            // The signs at the ends of the edge entered by differ: the third corner's differs from one of theirs.
            let exits = [(k + 1) % 3, (k + 2) % 3];
            let (exit, at) = exits.into_iter().find_map(|k| Some((k, self.crossing(triangle, k)?)))?;
            inward.push(at);
            match self.across(triangle, exit) {
                Some(next) => (triangle, k) = next,
                None => {
                    // Past the point, and out.
                    let kept = self.nearest(&inward, reach)?;
                    inward.truncate(kept);
                    break;
                }
            }
        }
        inward.push(self.mesh.points()[self.point]);
        inward.dedup();
        inward.reverse();
        Some(inward)
    }

    /// How many points of a polyline come before it is nearest to the point, or there; none if it stays farther than `reach`.
    fn nearest(&self, line: &[DVec3], reach: f64) -> Option<usize> {
        let center = self.mesh.points()[self.point];
        let (mut best, mut kept) = (reach, None);
        for (i, ends) in line.windows(2).enumerate() {
            let side = ends[1] - ends[0];
            let square = side.length_squared();
            let t = if square > 0.0 { ((center - ends[0]).dot(side) / square).clamp(0.0, 1.0) } else { 0.0 };
            let distance = self.distance(ends[0] + t * side);
            if distance < best {
                (best, kept) = (distance, Some(if t < 1.0 { i + 1 } else { i + 2 }));
            }
        }
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ruled::asymptotic::{AsymptoticDirections, Options};
    use crate::mesh::Mesh;
    use crate::mesh::curvature;
    use crate::mesh::patterns::{height_field, parametric_surface};

    fn triangles(mesh: &Mesh) -> TriangleMesh {
        TriangleMesh::new(mesh).unwrap()
    }

    #[test]
    fn sections_leave_a_point_along_its_asymptotic_directions() {
        let catenoid = |u: f64, v: f64| DVec3::new(u.cosh() * v.cos(), u.cosh() * v.sin(), u);
        let hyperboloid = |v: f64, z: f64| {
            let r = (1.0 + z * z).sqrt();
            DVec3::new(r * v.cos(), r * v.sin(), z)
        };
        let surfaces = [
            parametric_surface(61, 61, [-0.8, 0.8], [0.0, 1.6], catenoid).unwrap(),
            parametric_surface(61, 61, [0.0, 1.6], [-0.8, 0.8], hyperboloid).unwrap(),
            height_field(61, 61, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y + 0.1 * (x * x * x - y * y)).unwrap(),
        ];
        // The third has directions at all angles to the edges, and to each other.
        for (surface, most) in surfaces.into_iter().zip([0.6, 3.0, 12.0]) {
            let mesh = triangles(&surface);
            let found = AsymptoticDirections::new(&mesh, &Options::default()).unwrap();
            let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
            for i in 0..mesh.points().len() {
                let (row, column) = (i / 61, i % 61);
                if row.min(column) < 3 || row.max(column) > 57 {
                    continue;
                }
                let normal = found.curvatures()[i].normal;
                let section = TangentSection::new(&mesh, i, normal, 2).unwrap();
                assert_eq!(section.branches.len(), 4, "{i}");
                let lines = [0, 1].map(|family| found.family(family).unwrap()[i]);
                let mut met = [0, 0];
                for (direction, branch) in section.directions().into_iter().zip(&section.branches) {
                    assert!(branch.iter().all(|p| normal.dot(*p - mesh.points()[i]).abs() < 1e-15));
                    let sines = lines.map(|line| line.cross(direction).length());
                    let family = usize::from(sines[1] < sines[0]);
                    met[family] += 1;
                    let degrees = sines[family].asin().to_degrees();
                    (worst, sum, count) = (worst.max(degrees), sum + degrees, count + 1.0);
                }
                // Two branches each, one either way.
                assert_eq!(met, [2, 2]);
            }
            assert!(worst < most && sum / count < 0.4 * most, "{worst} {}", sum / count);
        }
    }

    #[test]
    fn rulings_of_the_saddle_along_edges_are_its_section() {
        let mesh = triangles(&height_field(9, 9, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap());
        let section = TangentSection::new(&mesh, 40, DVec3::Z, 2).unwrap();
        let mut ends: Vec<DVec3> = section.branches.iter().map(|branch| branch[branch.len() - 1]).collect();
        assert_eq!(ends.len(), 4);
        assert!(section.branches.iter().flatten().all(|p| p.z == 0.0 && p.x * p.y == 0.0));
        ends.sort_by(|a, b| (a.x, a.y).partial_cmp(&(b.x, b.y)).unwrap());
        let expected = [[-0.5, 0.0], [0.0, -0.5], [0.0, 0.5], [0.5, 0.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        assert!(ends.iter().zip(expected).all(|(end, expected)| end.distance(expected) < 1e-15), "{ends:?}");
    }

    #[test]
    fn positively_curved_and_flat_surfaces_have_no_sections() {
        let cap = |x: f64, y: f64| (4.0 - x * x - y * y).sqrt();
        for height in [cap as fn(f64, f64) -> f64, |x: f64, y: f64| 0.3 * x - 0.7 * y] {
            let mesh = triangles(&height_field(15, 15, [-1.0, 1.0], [-1.0, 1.0], height).unwrap());
            let normals = curvature::curvatures(&mesh, &curvature::Options::default()).unwrap();
            for (i, found) in normals.iter().enumerate() {
                assert!(TangentSection::new(&mesh, i, found.normal, 2).unwrap().branches.is_empty());
            }
        }
    }

    #[test]
    fn bad_input_is_named() {
        let mesh = triangles(&height_field(5, 5, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap());
        let place =
            |point, normal, rings| TangentSection::new(&mesh, point, normal, rings).unwrap_err().place().to_owned();
        assert_eq!(place(25, DVec3::Z, 2), "point");
        assert_eq!(place(3, DVec3::ZERO, 2), "normal");
        assert_eq!(place(3, DVec3::new(0.0, f64::NAN, 1.0), 2), "normal");
        assert_eq!(place(3, DVec3::Z, 0), "rings");
        assert_eq!(place(3, DVec3::Z, 65), "rings");
    }
}
