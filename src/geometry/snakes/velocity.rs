//! Velocities and accelerations that a snake's arcs allow.
//!
//! A motion keeps the [distances](Snake::distances) of control points where `(p_i − p_j) · (ṗ_i − ṗ_j) = 0` for them all (Bartoň
//! et al. 2013, equation 4). Differentiated once more, `(p_i − p_j) · (p̈_i − p̈_j) + ‖ṗ_i − ṗ_j‖² = 0`: the paper's equation (8)
//! has a velocity in place of the first factor, with which distances are kept one order less well. Of the velocities that meet
//! these conditions we take those for which a sum of squares is least ([`super::functionals`] has its rows), found with
//! multipliers.

use glam::DVec3;

use super::Snake;
use super::freedoms::directions;
use super::functionals::Row;
use super::snake::Distance;
use crate::error::{Error, Result, Status};
use crate::linalg::saddle::SaddlePoint;

/// Velocities or accelerations of the control points.
#[derive(Clone, Debug, PartialEq)]
pub struct Admissible {
    /// One vector for each control point.
    pub vectors: Vec<DVec3>,
    /// By how much a condition is missed at most, as a speed (or acceleration): round-off, unless conditions contradict each other.
    pub residual: f64,
    /// What had to be added to the terms, relative to their size, for a unique solution; 1e-10 does no harm.
    pub regularisation: f64,
}

/// The velocities that keep the distances, meet `conditions`, and of those the ones for which the sum of the squares of `wishes` is
/// least; where they leave some open, the slowest. Conditions may follow from others. Where they contradict each other, all are
/// met as well as possible, and the residual says so.
///
/// # Errors
/// A row of a control point that does not exist, numbers that are not finite, or a negative weight (`conditions[k]`, `wishes[k]`).
/// Status `Degenerate`: control points coincide (`snake`). Status `Singular`: round-off does not determine the velocities
/// (`wishes`).
pub fn velocity(snake: &Snake, conditions: &[Row], wishes: &[Row]) -> Result<Admissible> {
    let distances = snake.distances();
    let rights = vec![0.0; distances.len()];
    admissible(snake, Kept { distances: &distances, rights: &rights }, conditions, wishes)
}

/// The accelerations of a motion with these velocities, likewise.
///
/// # Errors
/// As [`velocity`]; velocities that are not one for each control point.
pub fn acceleration(snake: &Snake, velocities: &[DVec3], conditions: &[Row], wishes: &[Row]) -> Result<Admissible> {
    let distances = snake.distances();
    let rights = centripetal(snake, &distances, velocities)?;
    admissible(snake, Kept { distances: &distances, rights: &rights }, conditions, wishes)
}

/// Distances, and what their rows of unit vectors are to be.
pub(super) struct Kept<'a> {
    pub distances: &'a [Distance],
    pub rights: &'a [f64],
}

/// `−‖ṗ_i − ṗ_j‖² / |p_i − p_j|` for distances.
pub(super) fn centripetal(snake: &Snake, distances: &[Distance], velocities: &[DVec3]) -> Result<Vec<f64>> {
    let control = snake.control();
    if velocities.len() != control.len() {
        let reason = format!("expected {}, one for each control point, found {}", control.len(), velocities.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("velocities"));
    }
    let right = |distance: &Distance| {
        let [i, j] = distance.points.map(|i| i as usize);
        -velocities[i].distance_squared(velocities[j]) / control[i].distance(control[j])
    };
    Ok(distances.iter().map(right).collect())
}

/// Where unknowns are in the order of elimination, so that neighbours are near each other. Around a closed snake those are taken
/// from both sides in turn.
pub(super) fn positions(count: usize, is_closed: bool) -> Vec<u32> {
    let place = |i: usize| match (is_closed, 2 * i < count) {
        (false, _) => i,
        (true, true) => 2 * i,
        (true, false) => 2 * (count - 1 - i) + 1,
    };
    (0..3 * count).map(|unknown| (3 * place(unknown / 3) + unknown % 3) as u32).collect()
}

/// The coefficients of a row.
pub(super) fn entries(row: &Row) -> Vec<(u32, f64)> {
    let of = |&(i, vector): &(u32, DVec3)| (0_u32..).zip(vector.to_array()).map(move |(k, value)| (3 * i + k, value));
    row.terms.iter().flat_map(of).collect()
}

/// The row of a distance with this direction from its second point to its first.
pub(super) fn distance_entries(distance: &Distance, direction: DVec3) -> Vec<(u32, f64)> {
    let [i, j] = distance.points;
    entries(&Row { terms: vec![(i, direction), (j, -direction)], right: 0.0, weight: 1.0 })
}

pub(super) fn check_rows(snake: &Snake, rows: &[Row], argument: &str) -> Result<()> {
    let count = snake.control().len();
    for (k, row) in rows.iter().enumerate() {
        let at = |status, reason: String| Error::new(status, reason).at(format!("{argument}[{k}]"));
        if let Some((i, _)) = row.terms.iter().find(|(i, _)| *i as usize >= count) {
            return Err(at(Status::IndexOutOfRange, format!("{i} is out of range for {count} control points")));
        }
        let finite = row.terms.iter().all(|(_, vector)| vector.is_finite()) && row.right.is_finite();
        if !finite {
            return Err(at(Status::InvalidValue, "expected finite numbers".into()));
        }
        if !(row.weight >= 0.0 && row.weight.is_finite()) {
            return Err(at(Status::InvalidValue, format!("expected a weight of 0 or more, found {}", row.weight)));
        }
    }
    Ok(())
}

pub(super) fn admissible(snake: &Snake, kept: Kept<'_>, conditions: &[Row], wishes: &[Row]) -> Result<Admissible> {
    check_rows(snake, conditions, "conditions")?;
    check_rows(snake, wishes, "wishes")?;
    let directions = directions(snake.control(), kept.distances)?;
    let mut saddle = SaddlePoint::new(3 * snake.control().len());
    for ((distance, &direction), &right) in kept.distances.iter().zip(&directions).zip(kept.rights) {
        saddle.condition(&distance_entries(distance, direction), right);
    }
    conditions.iter().for_each(|row| saddle.condition(&entries(row), row.right));
    let weighted = wishes.iter().filter(|row| row.weight > 0.0);
    weighted.for_each(|row| saddle.add_square(&entries(row), row.right, row.weight));
    let found = saddle
        .solve(&positions(snake.control().len(), snake.is_closed()))
        .map_err(|error| error.with_place("wishes"))?;
    Ok(Admissible {
        vectors: found.x.chunks_exact(3).map(DVec3::from_slice).collect(),
        residual: found.residual,
        regularisation: found.regularisation,
    })
}

#[cfg(test)]
mod tests {
    use super::super::functionals::*;
    use super::super::tests::{circular, incongruence, open_snake, regular, shaken};
    use super::*;
    use crate::geometry::random::Random;

    fn rate(snake: &Snake, velocities: &[DVec3], i: usize, j: usize) -> f64 {
        let (p, v) = (snake.control(), velocities);
        (p[i] - p[j]).normalize().dot(v[i] - v[j])
    }

    /// The largest rate of a distance that is kept.
    fn stretch(snake: &Snake, velocities: &[DVec3]) -> f64 {
        let pairs = snake.distances().into_iter().map(|distance| distance.points.map(|i| i as usize));
        pairs.map(|[i, j]| rate(snake, velocities, i, j).abs()).fold(0.0, f64::max)
    }

    fn wishes(snake: &Snake, seed: u64) -> Vec<Row> {
        let mut random = Random(seed);
        let count = snake.control().len();
        let normals: Vec<DVec3> = (0..count).map(|_| random.vector().normalize()).collect();
        let speeds: Vec<f64> = (0..count).map(|_| random.between(0.5, 1.5)).collect();
        let mut rows = tangential(&normals, 1.0);
        rows.extend(offset(&sideways(snake, &normals).unwrap(), &speeds, 0.1));
        rows.extend(near_vector(1, random.vector(), 0.3));
        rows.push(near_plane(2, random.vector().normalize(), 0.7));
        rows.extend(orthogonal(snake, 0.2).unwrap());
        rows.extend(rotation_minimising(snake, 0.4));
        rows
    }

    #[test]
    fn no_admissible_velocity_is_better() {
        for snake in [open_snake(9, 2), regular(9), shaken(12, 0.1, 3)] {
            let rows = wishes(&snake, 7);
            let found = velocity(&snake, &[], &rows).unwrap();
            assert!(stretch(&snake, &found.vectors) < 1e-12, "{}", stretch(&snake, &found.vectors));
            // Any other is the difference of two.
            let least = value(&rows, &found.vectors);
            let mut random = Random(1);
            for seed in 0..20 {
                let other = velocity(&snake, &[], &wishes(&snake, 50 + seed)).unwrap().vectors;
                let part = random.between(-0.3, 0.3);
                let moved: Vec<DVec3> = found.vectors.iter().zip(&other).map(|(a, b)| a + part * b).collect();
                assert!(value(&rows, &moved) > least * (1.0 - 1e-12));
                // The derivative along it is 0.
                let at = |t: f64| {
                    let moved: Vec<DVec3> = found.vectors.iter().zip(&other).map(|(a, b)| a + t * b).collect();
                    value(&rows, &moved)
                };
                assert!((at(1e-3) - at(-1e-3)).abs() < 1e-9 * at(1.0), "{}", at(1e-3) - at(-1e-3));
            }
        }
    }

    #[test]
    fn rows_are_the_derivatives_of_what_they_stand_for() {
        let snake = open_snake(6, 4);
        let mut random = Random(9);
        let velocities: Vec<DVec3> = (0..8).map(|_| random.vector()).collect();
        let moved = |t: f64| {
            let points = snake.control().iter().zip(&velocities).map(|(p, v)| p + t * v).collect();
            snake.moved(points).unwrap()
        };
        let h = 1e-6;
        let [before, after] = [moved(-h), moved(h)];
        // Squared distances of points three apart.
        let mean = three_apart(&snake).iter().map(|pair| pair.length).sum::<f64>() / 5.0;
        for (row, pair) in rotation_minimising(&snake, 1.0).iter().zip(three_apart(&snake)) {
            let [i, j] = pair.points.map(|i| i as usize);
            let squared = |snake: &Snake| snake.control()[i].distance_squared(snake.control()[j]);
            let expected = 0.5 * (squared(&after) - squared(&before)) / (2.0 * h) / mean;
            assert!((row.residual(&velocities) - expected).abs() < 1e-6 * (1.0 + expected.abs()));
        }
        // What orthogonal rows measure together is the velocity within the plane of the arc.
        let rows = orthogonal(&snake, 1.0).unwrap();
        for i in 0..8 {
            let p = snake.control();
            let j = i.clamp(1, 6);
            let normal = (p[j] - p[j - 1]).cross(p[j + 1] - p[j]).normalize();
            let within = velocities[i].reject_from(normal).length_squared();
            assert!((value(&rows[2 * i..2 * i + 2], &velocities) - within).abs() < 1e-12);
        }
        // Left of the snake: the normal turns the tangent there.
        let flat = circular(5, 0.4);
        for (direction, point) in sideways(&flat, &[DVec3::Z; 7]).unwrap().iter().zip(flat.control()) {
            assert!(direction.dot(point.normalize()) < -0.9);
        }
    }

    #[test]
    fn a_rigid_motion_given_at_two_points_is_the_motion_of_all() {
        let snake = open_snake(10, 6);
        let (axis, speed) = (DVec3::new(0.3, -0.5, 0.8), DVec3::new(0.1, 0.2, -0.4));
        let rigid = |point: DVec3| speed + axis.cross(point);
        let p = snake.control();
        // Two points leave the rotation about the line through them, three nothing.
        for points in [&[0_usize, 11][..], &[0, 6, 11]] {
            let given: Vec<Row> = points.iter().flat_map(|&i| near_vector(i, rigid(p[i]), 1.0)).collect();
            let found = velocity(&snake, &given, &rotation_minimising(&snake, 1.0)).unwrap();
            assert!(found.residual < 1e-12, "{}", found.residual);
            for i in 0..12 {
                for j in 0..i {
                    assert!(rate(&snake, &found.vectors, i, j).abs() < 1e-8, "{}", rate(&snake, &found.vectors, i, j));
                }
            }
            if points.len() == 3 {
                let off = p.iter().zip(&found.vectors).map(|(&p, v)| v.distance(rigid(p))).fold(0.0, f64::max);
                assert!(off < 1e-7, "{off}");
            }
        }
    }

    #[test]
    fn a_snake_in_a_plane_moves_rigidly_in_it() {
        let mut snake = circular(7, 0.3);
        let normals = vec![DVec3::Z; 9];
        let speeds: Vec<f64> = (0..9).map(|i| 1.0 + 0.1 * f64::from(i)).collect();
        let mut rows = tangential(&normals, 1.0);
        rows.extend(offset(&sideways(&snake, &normals).unwrap(), &speeds, 0.1));
        let found = velocity(&snake, &[], &rows).unwrap();
        assert!(found.vectors.iter().all(|v| v.z.abs() < 1e-10));
        let all = (0..9).flat_map(|i| (0..i).map(move |j| (i, j)));
        assert!(all.map(|(i, j)| rate(&snake, &found.vectors, i, j).abs()).all(|rate| rate < 1e-10));
        // It does move, and to first order only.
        let points = snake.control().iter().zip(&found.vectors).map(|(p, v)| p + 1e-3 * v).collect::<Vec<_>>();
        assert!(points[3].distance(snake.control()[3]) > 3e-4 && incongruence(&points, snake.control()) < 1e-5);
        snake = snake.moved(points).unwrap();
        assert!(snake.residual() > 1e-9);
    }

    #[test]
    fn orthogonal_velocities_are_those_of_geodesics() {
        // In the plane a straight line moves at right angles to itself: a nearly straight snake nearly does, a curved one does not,
        // beyond the motion out of the plane that tangential rows forbid.
        let off = |angle: f64| {
            let snake = circular(6, angle);
            let normals = vec![DVec3::Z; 8];
            let mut rows = tangential(&normals, 1e3);
            rows.extend(offset(&sideways(&snake, &normals).unwrap(), &[1.0; 8], 1e3));
            // Only the speed along the snake counts: the arcs' planes are the surface here.
            let directions = sideways(&snake, &normals).unwrap();
            let along: Vec<DVec3> = directions.iter().map(|d| d.cross(DVec3::Z)).collect();
            rows.extend(offset(&along, &[0.0; 8], 1.0));
            let v = velocity(&snake, &[], &rows).unwrap().vectors;
            v.iter().zip(&along).map(|(v, a)| v.dot(*a).abs()).fold(0.0, f64::max)
        };
        let (straight, curved) = (off(1e-3), off(0.3));
        assert!(straight < 4e-3 && curved > 0.3, "{straight} {curved}");
    }

    #[test]
    fn fixed_points_and_contradictions() {
        let snake = open_snake(3, 8);
        let conditions: Vec<Row> = [0, 1].iter().flat_map(|&i| near_vector(i, DVec3::ZERO, 1.0)).collect();
        let pull = near_vector(4, DVec3::new(1.0, -2.0, 0.5), 1.0);
        // The distance of two fixed points follows from them.
        let found = velocity(&snake, &conditions, &pull).unwrap();
        assert!(found.residual < 1e-12 && stretch(&snake, &found.vectors) < 1e-11);
        assert!(found.vectors[0].length() < 1e-12 && found.vectors[4].length() > 0.1);
        let mut torn = conditions.clone();
        torn.extend(near_vector(1, DVec3::X, 1.0));
        let found = velocity(&snake, &torn, &pull).unwrap();
        assert!(found.residual > 0.1, "{}", found.residual);
    }

    #[test]
    fn rows_are_checked() {
        let snake = open_snake(2, 1);
        let far = near_plane(4, DVec3::X, 1.0);
        assert_eq!(velocity(&snake, &[], &[far]).unwrap_err().status(), Status::IndexOutOfRange);
        let negative = near_plane(0, DVec3::X, -1.0);
        assert_eq!(velocity(&snake, &[], &[negative]).unwrap_err().place(), "wishes[0]");
        let nan = near_plane(0, DVec3::NAN, 1.0);
        assert_eq!(velocity(&snake, &[nan], &[]).unwrap_err().place(), "conditions[0]");
        assert_eq!(acceleration(&snake, &[], &[], &[]).unwrap_err().place(), "velocities");
        // Nothing wished: at rest.
        assert!(velocity(&snake, &[], &[]).unwrap().vectors.iter().all(|v| v.length() < 1e-12));
    }
}
