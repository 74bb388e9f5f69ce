//! A field of asymptotic directions.

use glam::DVec3;

use crate::error::{Error, Result, Status};
use crate::mesh::TriangleMesh;
use crate::mesh::grid::check_finite;
use crate::mesh::triangles::blend;

/// Directions this far from unit length are not those of a field: files round to six digits.
const NOT_UNIT: f64 = 1e-5;

/// One family of asymptotic directions: a unit tangent vector at each point of a mesh, with signs that agree.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    directions: Vec<DVec3>,
    is_known: Vec<bool>,
}

impl Field {
    /// The field with these unit vectors at the points of a mesh; `is_known` is false where the surface has no asymptotic
    /// direction, and the vector is not used. Vectors are taken into the tangent plane of the point's normal only where a
    /// triangle asks for them ([`Field::on_triangle`]).
    ///
    /// # Errors
    /// Not one vector and one flag for each point, or a vector that is not finite or, where known, not of unit length; the
    /// place is `directions`, `is_known` or `directions[i]`.
    pub fn new(mesh: &TriangleMesh, directions: Vec<DVec3>, is_known: Vec<bool>) -> Result<Self> {
        let count = mesh.points().len();
        for (name, found) in [("directions", directions.len()), ("is_known", is_known.len())] {
            if found != count {
                let reason = format!("expected one for each of {count} points, found {found}");
                return Err(Error::new(Status::InvalidArgumentLength, reason).at(name));
            }
        }
        check_finite("directions", &directions)?;
        let is_wrong = |i: &usize| is_known[*i] && (directions[*i].length() - 1.0).abs() > NOT_UNIT;
        if let Some(i) = (0..count).find(is_wrong) {
            let reason = format!("expected a unit vector, found one of length {}", directions[i].length());
            return Err(Error::new(Status::InvalidValue, reason).at(format!("directions[{i}]")));
        }
        Ok(Self { directions, is_known })
    }

    /// Refuses a mesh of other points than the field was made for, as far as their count tells.
    pub(super) fn check(&self, mesh: &TriangleMesh) -> Result<()> {
        if self.directions.len() == mesh.points().len() {
            return Ok(());
        }
        let reason = format!("expected one of {} points, found {}", mesh.points().len(), self.directions.len());
        Err(Error::new(Status::InvalidArgumentLength, reason).at("field"))
    }

    /// The unit vectors at the points; what is not known has any.
    pub fn directions(&self) -> &[DVec3] {
        &self.directions
    }

    /// Whether the direction at each point is known.
    pub fn is_known(&self) -> &[bool] {
        &self.is_known
    }

    /// How many points have no direction.
    pub fn unknown_count(&self) -> usize {
        self.is_known.iter().filter(|is_known| !**is_known).count()
    }

    /// The unit vector in the plane of a triangle: the mean of its corners', or none if that of a corner is not known.
    pub fn on_triangle(&self, mesh: &TriangleMesh, triangle: usize) -> Option<DVec3> {
        self.at(mesh, triangle, [1.0 / 3.0; 3])
    }

    /// The unit vector in the plane of a triangle at the point with these weights of its corners; none if that of a corner is
    /// not known, or if they cancel. A corner's vector that points against the first corner's is turned: so the vector is one
    /// of the line even where signs cannot agree.
    pub fn at(&self, mesh: &TriangleMesh, triangle: usize, weights: [f64; 3]) -> Option<DVec3> {
        let corners = mesh.triangles()[triangle];
        if corners.iter().any(|&i| !self.is_known[i as usize]) {
            return None;
        }
        let vectors = corners.map(|i| self.directions[i as usize]);
        let blended = blend(vectors.map(|vector| vector * vector.dot(vectors[0]).signum()), weights);
        blended.reject_from_normalized(mesh.normal(triangle)).try_normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::patterns::height_field;

    #[test]
    fn a_triangle_has_the_direction_of_its_corners_in_its_plane() {
        let mesh = TriangleMesh::new(&height_field(6, 6, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap()).unwrap();
        let along_x = |p: &DVec3| DVec3::new(1.0, 0.0, p.y).normalize();
        let count = mesh.points().len();
        let directions: Vec<DVec3> = mesh.points().iter().map(along_x).collect();
        let mut is_known = vec![true; count];
        is_known[14] = false;
        let field = Field::new(&mesh, directions.clone(), is_known).unwrap();
        assert_eq!((field.unknown_count(), field.is_known().len(), field.directions().len()), (1, count, count));
        for t in 0..mesh.triangles().len() {
            match field.on_triangle(&mesh, t) {
                None => assert!(mesh.triangles()[t].contains(&14)),
                Some(a) => {
                    let middle = mesh.corners(t).iter().sum::<DVec3>() / 3.0;
                    assert!((a.length() - 1.0).abs() < 1e-15 && a.dot(mesh.normal(t)).abs() < 1e-15);
                    assert!(a.distance(along_x(&middle)) < 0.25, "{}", a.distance(along_x(&middle)));
                }
            }
        }
        let place = |directions: &[DVec3], is_known: &[bool]| {
            Field::new(&mesh, directions.to_vec(), is_known.to_vec()).unwrap_err().place().to_owned()
        };
        assert_eq!(place(&directions[1..], &vec![true; count]), "directions");
        assert_eq!(place(&directions, &[true; 3]), "is_known");
        let mut long = directions;
        long[3] *= 1.1;
        assert_eq!(place(&long, &vec![true; count]), "directions[3]");
        long[2].x = f64::NAN;
        assert_eq!(place(&long, &vec![true; count]), "directions[2]");
    }
}
