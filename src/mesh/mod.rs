//! Meshes: points and polygons of any size, their files, their topology and their measures.
//!
//! The order of points and faces, and every bit of a coordinate, survive reading and writing: point `i` of a file is
//! point `i` of the [`Mesh`], of a problem made from it, and of the file written back.

mod closest;
pub mod curvature;
pub mod curve;
pub mod deviation;
pub mod file;
pub mod fit;
pub mod grid;
pub mod level_curves;
pub mod measure;
mod obj;
mod off;
pub mod operators;
pub mod patterns;
mod ply;
mod polylines;
pub mod reference;
pub mod surfaces;
mod topology;
pub mod triangles;
pub mod walk;

pub use closest::ClosestPoints;
pub use file::Format;
pub use grid::Grid;
pub use polylines::polylines;
pub use reference::ReferenceSurface;
pub use topology::{BoundaryChain, Neighbours, Topology};
pub use triangles::{SurfacePoint, TriangleMesh};

use glam::DVec3;

use crate::error::{Error, Result, Status};

/// Points and polygons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Coordinates in model units.
    pub points: Vec<DVec3>,
    /// Each face as the indices of its corners, in order around it; at least 3.
    pub faces: Vec<Vec<u32>>,
}

impl Mesh {
    /// Refuses what no measure can be taken of.
    ///
    /// # Errors
    /// A coordinate is not finite, a face has fewer than 3 corners, or a corner is out of range. The place is
    /// `points[i]`, `faces[i]` or `faces[i][j]`.
    pub fn check(&self) -> Result<()> {
        if let Some(i) = self.points.iter().position(|point| !point.is_finite()) {
            let reason = format!("expected finite coordinates, found {}", self.points[i]);
            return Err(Error::new(Status::InvalidValue, reason).at(format!("points[{i}]")));
        }
        for (i, face) in self.faces.iter().enumerate() {
            check_face(face, self.points.len()).map_err(|error| error.at(format!("faces[{i}]")))?;
        }
        Ok(())
    }

    /// Refuses what [`Mesh::check`] does, and faces that use a point twice: they are no polygons, and a constraint on
    /// them would not mean what it says.
    ///
    /// # Errors
    /// The place of the first that errs.
    pub fn check_polygons(&self) -> Result<()> {
        self.check()?;
        for (i, face) in self.faces.iter().enumerate() {
            if let Some((j, earlier)) = first_repeated(face) {
                let reason = format!("point {} is already corner {earlier} of this face", face[j]);
                return Err(Error::new(Status::InvalidValue, reason).at(format!("faces[{i}][{j}]")));
            }
        }
        Ok(())
    }

    /// The corners of a face in order. Corners out of range are left out: [`Mesh::check`] finds them.
    pub fn corners(&self, face: &[u32]) -> Vec<DVec3> {
        face.iter().filter_map(|&point| self.points.get(point as usize).copied()).collect()
    }

    /// The diagonal of the box that holds all points, along the axes; 0 without points.
    pub fn diagonal(&self) -> f64 {
        grid::diagonal(&self.points)
    }
}

/// Refuses a face with fewer than 3 corners or with one that is out of range.
fn check_face(face: &[u32], point_count: usize) -> Result<()> {
    if face.len() < 3 {
        let reason = format!("expected a face of at least 3 corners, found {}", face.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason));
    }
    match face.iter().position(|&point| point as usize >= point_count) {
        None => Ok(()),
        Some(j) => {
            let reason = format!("{} is out of range for {point_count} points", face[j]);
            Err(Error::new(Status::IndexOutOfRange, reason).at(format!("[{j}]")))
        }
    }
}

/// The first corner whose point an earlier corner has, with that earlier corner.
fn first_repeated(face: &[u32]) -> Option<(usize, usize)> {
    // Few faces are so large that a set would pay.
    if face.len() <= 32 {
        return (1..face.len()).find_map(|j| Some((j, face[..j].iter().position(|&point| point == face[j])?)));
    }
    let mut seen = std::collections::HashMap::new();
    face.iter().enumerate().find_map(|(j, &point)| seen.insert(point, j).map(|earlier| (j, earlier)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_errs_is_named_by_face_and_corner() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let mesh =
            |faces: &[&[u32]]| Mesh { points: points.clone(), faces: faces.iter().map(|face| face.to_vec()).collect() };
        let refusal = |faces: &[&[u32]]| mesh(faces).check_polygons().unwrap_err().to_string();
        assert_eq!(refusal(&[&[0, 1, 2], &[0, 1, 3]]), "faces[1][2]: 3 is out of range for 3 points");
        assert_eq!(refusal(&[&[0, 1]]), "faces[0]: expected a face of at least 3 corners, found 2");
        assert_eq!(refusal(&[&[0, 1, 2, 1]]), "faces[0][3]: point 1 is already corner 1 of this face");
        let long: Vec<u32> = (0..40).map(|i| i % 39).collect();
        assert_eq!(first_repeated(&long), Some((39, 0)));
        let mut bad = mesh(&[&[0, 1, 2]]);
        bad.points[1].y = f64::NAN;
        assert!(bad.check().unwrap_err().to_string().starts_with("points[1]: expected finite coordinates"));
    }
}
