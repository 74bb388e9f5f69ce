//! Faces that forces act on: their vector areas and normals at any points.
//!
//! The *vector area* of a face with corners `p₀ … p_{k−1}` is `½ Σ p_i × p_{i+1}`: its area times its normal, on the side from
//! which the corners run counter-clockwise. It is that of every surface with the same boundary, so those of a closed mesh add
//! up to nothing.

use glam::DVec3;

use crate::error::{Error, Result, Status};

/// Polygons as lists of point indices; they need not be planar.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faces {
    /// The corners of all faces behind each other.
    corners: Vec<u32>,
    /// Where each face ends.
    ends: Vec<usize>,
}

impl<F: AsRef<[u32]>> FromIterator<F> for Faces {
    fn from_iter<I: IntoIterator<Item = F>>(faces: I) -> Self {
        let mut all = Self::default();
        for face in faces {
            all.corners.extend_from_slice(face.as_ref());
            all.ends.push(all.corners.len());
        }
        all
    }
}

impl Faces {
    /// The corners of each face.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.corners[start..end])
    }

    /// The greatest index.
    pub(super) fn last_point(&self) -> Option<u32> {
        self.corners.iter().copied().max()
    }

    /// Refuses no face, a face of fewer than 3 corners, and indices out of range. The place is `faces`, `faces[i]` or
    /// `faces[i][j]`.
    pub(super) fn check(&self, point_count: usize) -> Result<()> {
        if self.ends.is_empty() {
            return Err(Error::new(Status::InvalidArgumentLength, "expected at least one face, found none").at("faces"));
        }
        for (i, face) in self.iter().enumerate() {
            if face.len() < 3 {
                let reason = format!("expected a face of at least 3 corners, found {}", face.len());
                return Err(Error::new(Status::InvalidArgumentLength, reason).at(format!("faces[{i}]")));
            }
            if let Some(j) = face.iter().position(|&index| index as usize >= point_count) {
                let reason = format!("{} is out of range for {point_count} points", face[j]);
                return Err(Error::new(Status::IndexOutOfRange, reason).at(format!("faces[{i}][{j}]")));
            }
        }
        Ok(())
    }

    /// Adds `pressure` times the vector area of each face to the `sums` of its corners.
    ///
    /// The face counts as the triangles `(c, p_i, p_{i+1})` about the mean `c` of its corners. Each triangle gives a third of
    /// its vector area to each corner, and what `c` gets is shared evenly among the corners of the face; those of a triangle
    /// get a third each. So the force is `pressure` times the gradient of the volume that a closed mesh encloses.
    pub(super) fn add_pressure(&self, pressure: f64, points: &[DVec3], sums: &mut [DVec3]) {
        for face in self.iter() {
            let (mean, area) = mean_and_area(face, points);
            let even = pressure / (3.0 * face.len() as f64) * area;
            let mut last = face[face.len() - 1];
            for &next in face {
                let [from, to] = [last, next].map(|corner| points[corner as usize] - mean);
                let third = pressure / 6.0 * from.cross(to);
                sums[last as usize] += third;
                sums[next as usize] += third + even;
                last = next;
            }
        }
    }

    /// The volume between the faces and the origin, `Σ ⅓ c·a` with `c` the mean of the corners and `a` the vector area: that of
    /// a closed mesh, whose normals point outwards.
    pub(super) fn volume(&self, points: &[DVec3]) -> f64 {
        let cone = |face| {
            let (mean, area) = mean_and_area(face, points);
            mean.dot(area) / 3.0
        };
        self.iter().map(cone).sum()
    }

    /// Adds `magnitude` along the normal of each corner, once per point, to the `sums`. The normal is that of the sum of the
    /// vector areas of the faces around the point; where it vanishes nothing is added. `normals` are zero before and after.
    pub(super) fn add_along_normals(
        &self,
        magnitude: f64,
        points: &[DVec3],
        normals: &mut [DVec3],
        sums: &mut [DVec3],
    ) {
        for face in self.iter() {
            let (_, area) = mean_and_area(face, points);
            face.iter().for_each(|&corner| normals[corner as usize] += area);
        }
        for &corner in &self.corners {
            let normal = std::mem::take(&mut normals[corner as usize]);
            // Relative to its largest component, so that no square overflows or vanishes.
            let direction = normal / normal.abs().max_element();
            sums[corner as usize] += magnitude * direction.normalize_or_zero();
        }
    }
}

/// The mean of the corners and the vector area of a face.
fn mean_and_area(face: &[u32], points: &[DVec3]) -> (DVec3, DVec3) {
    let at = |corner: &u32| points[*corner as usize];
    // Relative to the first corner: far from the origin differences keep their digits.
    let first = at(&face[0]);
    let mean = first + face.iter().map(|corner| at(corner) - first).sum::<DVec3>() / face.len() as f64;
    let twice = face.windows(2).map(|side| (at(&side[0]) - first).cross(at(&side[1]) - first)).sum::<DVec3>();
    (mean, 0.5 * twice)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The octahedron of radius `r` about `center`.
    fn octahedron(r: f64, center: DVec3) -> (Vec<DVec3>, Faces) {
        let axes = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
        let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        (axes.map(|axis| center + r * axis).to_vec(), faces.iter().collect())
    }

    fn pressure(faces: &Faces, points: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; points.len()];
        faces.add_pressure(1.0, points, &mut sums);
        sums
    }

    #[test]
    fn an_octahedron_is_pushed_outwards_by_two_thirds_of_its_squared_radius() {
        // Four faces of vector area ½ r² (1,1,1) each give a third: the other components cancel, 4/6 r² is left.
        let (points, faces) = octahedron(1.5, DVec3::new(3.0, -1.0, 2.0));
        for (force, axis) in pressure(&faces, &points).into_iter().zip(octahedron(1.0, DVec3::ZERO).0) {
            assert!(force.distance(2.0 / 3.0 * 2.25 * axis) < 1e-15, "{force}");
        }
        // 4/3 r³
        assert!((faces.volume(&points) - 4.5).abs() < 1e-14);
    }

    /// A cube whose corners are moved at random, so that its quads are not planar.
    fn bent_cube() -> (Vec<DVec3>, Faces) {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        let points = (0..8).map(|i| corner(i) + 0.3 * DVec3::new(next(), next(), next())).collect();
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        (points, faces.iter().collect())
    }

    #[test]
    fn pressure_is_the_gradient_of_the_volume_of_a_closed_mesh() {
        let (points, faces) = bent_cube();
        let forces = pressure(&faces, &points);
        let h = 1e-6;
        for i in 0..8 {
            let moved = |axis: DVec3| {
                let mut points = points.clone();
                points[i] += axis;
                faces.volume(&points)
            };
            let slope = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| (moved(h * axis) - moved(-h * axis)) / (2.0 * h));
            assert!(forces[i].distance(DVec3::from(slope)) < 1e-9, "point {i}: {} is not {slope:?}", forces[i]);
        }
        // So neither the sum of the forces nor that of their moments can be anything.
        assert!(forces.iter().sum::<DVec3>().length() < 1e-15);
        assert!(points.iter().zip(&forces).map(|(x, f)| x.cross(*f)).sum::<DVec3>().length() < 1e-14);
    }

    #[test]
    fn normals_have_length_one_and_are_taken_once_per_point() {
        let (points, faces) = octahedron(1e-9, DVec3::X);
        let (mut normals, mut sums) = (vec![DVec3::ZERO; 6], vec![DVec3::ZERO; 6]);
        faces.add_along_normals(2.5, &points, &mut normals, &mut sums);
        for (sum, axis) in sums.iter().zip(octahedron(2.5, DVec3::ZERO).0) {
            // The digits of 1 + 1e-9 leave 1e-7 of the differences.
            assert!(sum.distance(axis) < 1e-6, "{sum}");
        }
        assert!(normals.iter().all(|normal| *normal == DVec3::ZERO));
    }

    #[test]
    fn whatever_is_finite_stays_finite() {
        for points in [
            [DVec3::ZERO; 4],
            [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X, 3.0 * DVec3::X],
            [1e9, -1e9, 3e9, 2e9].map(|s| DVec3::new(s, -s * 0.3, 0.1 * s * s / 1e9)),
            [1e-120, 3e-120, -1e-120, 2e-120].map(|s| DVec3::new(s, -0.3 * s, 1e-120)),
        ] {
            let faces: Faces = [&[0, 1, 2][..], &[0, 1, 2, 3], &[1, 1, 1], &[3, 0, 3, 0]].into_iter().collect();
            let (mut normals, mut sums) = (vec![DVec3::ZERO; 4], pressure(&faces, &points));
            faces.add_along_normals(1.0, &points, &mut normals, &mut sums);
            assert!(
                sums.iter().all(|sum| sum.is_finite()) && faces.volume(&points).is_finite(),
                "{points:?}: {sums:?}"
            );
        }
    }
}
