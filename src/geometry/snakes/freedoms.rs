//! In how many ways a snake can move.

use glam::DVec3;

use super::Snake;
use crate::error::{Error, Result, Status};
use crate::linalg::dense::Svd;
use crate::mesh::grid::check_finite;

/// Singular values of the derivatives below this multiple of the largest are round-off: those of snakes in general position were
/// found above 1e-4 of it, those of closed snakes in a plane below 1e-15.
const NO_RANK: f64 = 1e-10;

/// Conditions on velocities, and what they leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Freedoms {
    /// The number of conditions.
    pub conditions: usize,
    /// How many of them are independent.
    pub rank: usize,
    /// The dimension of the velocities that they leave, the six of rigid motions included. It may be more than the dimension of the
    /// shape space: a closed snake in a plane has `N + 3` velocities, `N` of which belong to motions.
    pub free: usize,
}

/// The freedoms of a snake in space: in general position `N + 5`, or `N` if it is closed and has 6 arcs or more; 6 if it has 5, as
/// it then is rigid.
///
/// # Errors
/// Status `Degenerate`: two control points whose distance is kept coincide (`snake`).
pub fn freedoms(snake: &Snake) -> Result<Freedoms> {
    rank(snake, &[])
}

/// The freedoms of a snake whose control points may move only at right angles to `normals`, one of length above 0 for each: 3 for
/// an open snake, to first order (Bartoň et al. 2013, section 2).
///
/// # Errors
/// As [`freedoms`]; another number of normals, or one without a direction (`normals`, `normals[i]`).
pub fn freedoms_on_surface(snake: &Snake, normals: &[DVec3]) -> Result<Freedoms> {
    check_normals(snake, normals)?;
    rank(snake, normals)
}

/// Checks that there is a direction for each control point.
pub(super) fn check_normals(snake: &Snake, normals: &[DVec3]) -> Result<()> {
    let count = snake.control().len();
    if normals.len() != count {
        let reason = format!("expected {count}, one for each control point, found {}", normals.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("normals"));
    }
    check_finite("normals", normals)?;
    if let Some(i) = normals.iter().position(|normal| normal.try_normalize().is_none()) {
        let reason = format!("expected a direction, found {}", normals[i]);
        return Err(Error::new(Status::InvalidValue, reason).at(format!("normals[{i}]")));
    }
    Ok(())
}

/// The unit vectors from the second to the first point of each distance.
///
/// # Errors
/// Status `Degenerate`: they coincide (`snake`).
pub(super) fn directions(control: &[DVec3], distances: &[super::Distance]) -> Result<Vec<DVec3>> {
    let direction = |distance: &super::Distance| {
        let [i, j] = distance.points.map(|i| i as usize);
        (control[i] - control[j]).try_normalize().ok_or_else(|| {
            let reason = format!("expected control points {i} and {j} to be apart");
            Error::new(Status::Degenerate, reason).at("snake")
        })
    };
    distances.iter().map(direction).collect()
}

fn rank(snake: &Snake, normals: &[DVec3]) -> Result<Freedoms> {
    let distances = snake.distances();
    let directions = directions(snake.control(), &distances)?;
    let conditions = distances.len() + normals.len();
    let unknowns = 3 * snake.control().len();
    let mut columns = vec![vec![0.0; conditions]; unknowns];
    let mut put = |row: usize, point: usize, vector: DVec3| {
        vector.to_array().into_iter().enumerate().for_each(|(k, value)| columns[3 * point + k][row] += value);
    };
    for (row, (distance, &direction)) in distances.iter().zip(&directions).enumerate() {
        let [i, j] = distance.points;
        put(row, i as usize, direction);
        put(row, j as usize, -direction);
    }
    for (i, normal) in normals.iter().enumerate() {
        put(distances.len() + i, i, normal.normalize());
    }
    let svd = Svd::new(conditions, &columns)
        .ok_or_else(|| Error::new(Status::Degenerate, "expected finite distances").at("snake"))?;
    let rank = svd.rank(NO_RANK);
    Ok(Freedoms { conditions, rank, free: unknowns - rank })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{open_snake, regular, shaken};
    use super::*;
    use crate::geometry::random::Random;

    #[test]
    fn open_snakes_have_five_more_than_arcs() {
        for (count, free) in [(1, 6), (3, 8), (6, 11), (12, 17)] {
            let found = freedoms(&open_snake(count, 3)).unwrap();
            assert_eq!((found.conditions, found.rank, found.free), (2 * count + 1, 2 * count + 1, free));
        }
    }

    #[test]
    fn closed_snakes_have_as_many_as_arcs() {
        for (count, free) in [(5, 6), (6, 6), (7, 7), (10, 10)] {
            let found = freedoms(&shaken(count, 0.2, 8)).unwrap();
            assert_eq!((found.conditions, found.free), (2 * count, free));
        }
        // In a plane all can move out of it to first order, which is 3 more than they keep.
        for count in [6, 7, 10] {
            assert_eq!(freedoms(&regular(count)).unwrap().free, count + 3);
        }
    }

    #[test]
    fn a_surface_leaves_three() {
        let mut random = Random(5);
        for count in [1, 3, 6, 12] {
            let snake = open_snake(count, 9);
            let normals: Vec<DVec3> = (0..count + 2).map(|_| random.vector()).collect();
            assert_eq!(freedoms_on_surface(&snake, &normals).unwrap().free, 3);
            let flat: Vec<_> = regular(2 * count + 20).control()[..count + 2].to_vec();
            let flat = snake.moved(flat).unwrap();
            // In its plane, and on the unit sphere about a point above the middle of its circle.
            assert_eq!(freedoms_on_surface(&flat, &vec![DVec3::Z; count + 2]).unwrap().free, 3);
            let radial: Vec<DVec3> = flat.control().iter().map(|&point| point - 0.6 * DVec3::Z).collect();
            assert_eq!(freedoms_on_surface(&flat, &radial).unwrap().free, 3);
        }
    }

    #[test]
    fn normals_are_checked() {
        let snake = open_snake(2, 1);
        assert_eq!(freedoms_on_surface(&snake, &[]).unwrap_err().place(), "normals");
        let mut normals = vec![DVec3::X; 4];
        normals[2] = DVec3::ZERO;
        assert_eq!(freedoms_on_surface(&snake, &normals).unwrap_err().place(), "normals[2]");
        let same = snake.moved(vec![DVec3::ZERO; 4]).unwrap();
        assert_eq!(freedoms(&same).unwrap_err().status(), Status::Degenerate);
    }
}
