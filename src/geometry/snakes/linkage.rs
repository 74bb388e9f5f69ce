//! A snake with its end arcs on hinges: a linkage (Bartoň et al. 2013, section 4.2).
//!
//! The first two control points and the last two are fixed, so that each end arc turns about the edge where it is held, and there
//! are `N + 5 − 10` freedoms: one for six arcs. Then all six arcs and the ground are links of a closed chain with seven hinges, the
//! edges. A velocity of the free points keeps all distances to first order where `(p_i − p_j)·(v_i − v_j) = 0` for each of them.

use glam::DVec3;

use super::functionals::Row;
use super::projection::meet;
use super::{Distance, Snake};
use crate::error::{Error, Result, Status};
use crate::linalg::dense::Svd;

/// Equations count as dependent where a singular value is below this multiple of the largest: they are good to round-off, and what
/// is nearly dependent is near a fork of the motion.
const DEPENDENT: f64 = 1e-9;

/// A snake whose end arcs are held by hinges.
#[derive(Clone, Debug, PartialEq)]
pub struct Linkage {
    snake: Snake,
    /// Those that a free point has to do with.
    distances: Vec<Distance>,
}

impl Linkage {
    /// The linkage of an open snake.
    ///
    /// # Errors
    /// The snake is closed, has fewer than 3 arcs, or does not keep its distances to 1e-9 of its size (`snake`).
    pub fn new(snake: Snake) -> Result<Self> {
        let refused = |reason: String| Err(Error::new(Status::InvalidValue, reason).at("snake"));
        if snake.is_closed() {
            return refused("expected an open snake, found a closed one".into());
        }
        if snake.shapes().len() < 3 {
            return refused(format!("expected at least 3 arcs, found {}", snake.shapes().len()));
        }
        if !(snake.residual() <= 1e-9 * snake.size()) {
            let reason =
                format!("expected control points at the distances of the arcs, found {} off", snake.residual());
            return refused(reason);
        }
        let last = snake.control().len() - 1;
        let is_free = |i: u32| (2..last as u32 - 1).contains(&i);
        let distances = snake.distances().into_iter().filter(|d| d.points.iter().any(|&i| is_free(i))).collect();
        Ok(Self { snake, distances })
    }

    /// The snake as it is at the start.
    pub fn snake(&self) -> &Snake {
        &self.snake
    }

    /// Whether a control point is free.
    fn is_free(&self, i: usize) -> bool {
        (2..self.snake.control().len() - 2).contains(&i)
    }

    /// In how many independent ways it can move at the start: 1 for six arcs, unless they are in a special position.
    pub fn freedoms(&self) -> usize {
        self.velocities(self.snake.control()).len()
    }

    /// An orthonormal basis of the velocities that keep distances, with one vector for each control point.
    pub(super) fn velocities(&self, control: &[DVec3]) -> Vec<Vec<DVec3>> {
        let count = control.len();
        let mut columns = vec![vec![0.0; self.distances.len()]; 3 * (count - 4)];
        for (row, Distance { points: [i, j], .. }) in self.distances.iter().enumerate() {
            let (i, j) = (*i as usize, *j as usize);
            let direction = (control[i] - control[j]).normalize_or_zero();
            for (point, direction) in [(i, direction), (j, -direction)] {
                if self.is_free(point) {
                    let first = 3 * (point - 2);
                    direction
                        .to_array()
                        .into_iter()
                        .enumerate()
                        .for_each(|(k, value)| columns[first + k][row] += value);
                }
            }
        }
        // What cannot be decomposed is not finite, and control points are.
        let Some(svd) = Svd::new(self.distances.len(), &columns) else { return Vec::new() };
        let spread = |vector: Vec<f64>| {
            let mut velocity = vec![DVec3::ZERO; count];
            vector.chunks_exact(3).enumerate().for_each(|(k, v)| velocity[k + 2] = DVec3::from_slice(v));
            velocity
        };
        svd.null_space(DEPENDENT).into_iter().map(spread).collect()
    }

    /// Moves free points so that distances and conditions hold; returns by how much they are off then.
    pub(super) fn polish(&self, control: &mut Vec<DVec3>, conditions: &[Row]) -> f64 {
        meet(control, false, &self.distances, &|i| !self.is_free(i), conditions)
    }

    /// The determinant of the Plücker coordinates of the first six hinges of a linkage of six arcs, `u_i` and `k_i × u_i` with
    /// `u_i` the unit vector from contact `k_i` to the vertex after it, moments in units of the snake's size. It is 0 in singular
    /// positions, in which the last arc cannot be held without stopping all; below 1e-6 or so one is near.
    ///
    /// # Errors
    /// Not six arcs (`snake`).
    pub fn determinant(&self) -> Result<f64> {
        let contacts = self.snake.contacts();
        if contacts.len() != 7 {
            let reason = format!("expected 6 arcs, found {}", contacts.len() - 1);
            return Err(Error::new(Status::InvalidValue, reason).at("snake"));
        }
        let directions = self.snake.edge_directions();
        // The determinant does not depend on the origin; one that is near keeps moments small.
        let (origin, size) = (contacts[3], self.snake.size());
        let axis = |i: usize| {
            let moment = (contacts[i] - origin).cross(directions[i]) / size;
            [directions[i].x, directions[i].y, directions[i].z, moment.x, moment.y, moment.z]
        };
        Ok(determinant(std::array::from_fn(axis)))
    }
}

/// By elimination with row exchanges.
fn determinant(mut a: [[f64; 6]; 6]) -> f64 {
    let mut product = 1.0;
    for k in 0..6 {
        let pivot = (k..6).fold(k, |best, i| if a[i][k].abs() > a[best][k].abs() { i } else { best });
        if a[pivot][k] == 0.0 {
            return 0.0;
        }
        if pivot != k {
            a.swap(pivot, k);
            product = -product;
        }
        product *= a[k][k];
        for i in k + 1..6 {
            let factor = a[i][k] / a[k][k];
            for j in k..6 {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    product
}

#[cfg(test)]
pub(super) mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

    use super::*;
    use crate::geometry::random::Random;
    use crate::geometry::snakes::{ArcShape, Pose};

    pub fn snake(angle: f64, torsions: &[f64]) -> Snake {
        let arcs = vec![ArcShape { radius: 1.0, length: angle }; torsions.len() + 1];
        let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
        Snake::from_arcs(&arcs, torsions, &pose).unwrap()
    }

    /// A linkage of six arcs that is known to move around.
    pub fn six_arcs() -> Linkage {
        Linkage::new(snake(FRAC_PI_3, &[1.0, -0.7, 0.9, -0.8, 0.6])).unwrap()
    }

    #[test]
    fn six_arcs_have_one_freedom_and_seven_have_two() {
        let linkage = six_arcs();
        let last = linkage.snake().control()[7];
        assert!(last.distance(DVec3::new(-0.356912243, -0.054958131, 0.607451979)) < 1e-9, "{last}");
        assert_eq!(linkage.freedoms(), 1);
        assert!(linkage.determinant().unwrap().abs() > 1e-3);
        let freedoms = |torsions: &[f64]| Linkage::new(snake(1.0, torsions)).unwrap().freedoms();
        assert_eq!(freedoms(&[1.0, -0.7, 0.9, -0.8, 0.6, 0.3]), 2);
        assert_eq!(freedoms(&[1.0, -0.7, 0.9, -0.8]), 0);
        // The velocity keeps distances to first order.
        let velocities = linkage.velocities(linkage.snake().control());
        for h in [1e-3, 1e-4] {
            let moved = linkage.snake().control().iter().zip(&velocities[0]).map(|(p, v)| *p + h * *v).collect();
            assert!(linkage.snake().moved(moved).unwrap().residual() < 2.0 * h * h);
        }
    }

    #[test]
    fn a_regular_linkage_is_singular() {
        let linkage = Linkage::new(snake(FRAC_PI_2, &[1.2; 5])).unwrap();
        assert!(linkage.determinant().unwrap().abs() < 1e-9, "{:?}", linkage.determinant());
        assert_eq!(linkage.freedoms(), 2);
    }

    #[test]
    fn determinants_are_those_of_known_matrices() {
        let mut random = Random(9);
        let mut a: [[f64; 6]; 6] = std::array::from_fn(|_| std::array::from_fn(|_| random.between(-1.0, 1.0)));
        // Triangular: the product of the diagonal; rows exchanged change the sign, rows added nothing.
        (0..6).for_each(|i| (0..i).for_each(|j| a[i][j] = 0.0));
        let expected: f64 = (0..6).map(|i| a[i][i]).product();
        for (i, j) in [(5, 0), (3, 1), (0, 4), (2, 5), (1, 2)] {
            (0..6).for_each(|k| a[i][k] += 0.7 * a[j][k]);
        }
        assert!((determinant(a) - expected).abs() < 1e-14);
        a.swap(1, 4);
        assert!((determinant(a) + expected).abs() < 1e-14);
        a[3] = a[0];
        assert!(determinant(a).abs() < 1e-16);
    }

    #[test]
    fn what_is_no_linkage_is_refused() {
        let place = |snake: Snake| Linkage::new(snake).unwrap_err().place().to_owned();
        assert_eq!(place(snake(1.0, &[0.5])), "snake");
        let other = snake(1.0, &[0.5, 0.4]);
        let disturbed = other.control().iter().map(|p| 1.01 * *p).collect();
        assert_eq!(place(other.moved(disturbed).unwrap()), "snake");
        assert_eq!(Linkage::new(other).unwrap().determinant().unwrap_err().place(), "snake");
    }
}
