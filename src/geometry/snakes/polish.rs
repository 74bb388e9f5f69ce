//! Control points onto the shape space to round-off.
//!
//! The paper's functional leaves distances off by 1e-4 to 1e-3 of them. Newton's method on the distances alone ends that: with `r`
//! by how much they are off and `J` their derivatives, each step is the shortest `d` with `J d = −r`, so that points hardly move.
//! It is found by damping: `(JᵀJ + ε I) d = −Jᵀ r`, which leads to the shortest as `ε` goes to 0, also where rows of `J` depend on
//! each other. What the damping leaves of `r` goes with the next step. (To damp by the diagonal of `JᵀJ` would let points go far
//! along axes that edges are nearly at right angles to.)

use glam::DVec3;

use super::Distance;
use crate::error::Result;
use crate::linalg::least_squares::{LeastSquares, Solver};
use crate::mesh::grid::diagonal;

/// `√ε`: with entries of `J` up to 1, `ε` is far enough above round-off that directions that `J` does not see stay at rest.
const DAMPING: f64 = 3e-5;

/// Steps at most: with derivatives of full rank some 4 are taken.
const MOST_STEPS: usize = 200;

/// Distances off by less than this multiple of the size are at round-off.
const ROUND_OFF: f64 = 2.0 * f64::EPSILON;

/// Steps in a row after which the best does not get better are the last.
const MOST_IDLE: usize = 3;

/// An equation `Σ normal_i · point_i = value` that is to hold too.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub normals: Vec<DVec3>,
    pub value: f64,
}

/// Moves the control points that are free so that all distances hold, and the level if there is one. Returns by how much they are
/// off at most in the end, which is round-off unless they cannot be met from where the points were.
pub(super) fn polish(
    control: &mut Vec<DVec3>,
    distances: &[Distance],
    is_free: &dyn Fn(usize) -> bool,
    level: Option<&Level>,
) -> Result<f64> {
    let count = control.len();
    let mut number = vec![None; count];
    let mut free = Vec::new();
    for i in (0..count).filter(|&i| is_free(i)) {
        number[i] = Some(3 * free.len() as u32);
        free.push(i);
    }
    let size = diagonal(control);
    let (mut equations, mut solver) = (LeastSquares::new(3 * free.len()), Solver::default());
    let (mut best, mut least, mut idle) = (control.clone(), f64::INFINITY, 0);
    for _ in 0..=MOST_STEPS {
        let residual = linearise(control, distances, &number, level, &mut equations);
        if residual < least {
            idle = if residual < 0.9 * least { 0 } else { idle + 1 };
            (least, best) = (residual, control.clone());
        } else {
            idle += 1;
        }
        if least <= ROUND_OFF * size || idle > MOST_IDLE || free.is_empty() {
            break;
        }
        let step = solver.solve(&equations, 0.0)?;
        for (k, &i) in free.iter().enumerate() {
            control[i] += DVec3::from_slice(&step[3 * k..3 * k + 3]);
        }
    }
    *control = best;
    Ok(least)
}

/// The equations of a step; returns by how much what they are to meet is off at most.
fn linearise(
    control: &[DVec3],
    distances: &[Distance],
    number: &[Option<u32>],
    level: Option<&Level>,
    equations: &mut LeastSquares,
) -> f64 {
    equations.clear();
    let mut most: f64 = 0.0;
    let mut terms: Vec<(u32, f64)> = Vec::with_capacity(6);
    let add = |terms: &mut Vec<(u32, f64)>, i: usize, v: DVec3| {
        if let Some(first) = number[i] {
            terms.extend((first..).zip(v.to_array()));
        }
    };
    for Distance { points: [i, j], length } in distances {
        let (i, j) = (*i as usize, *j as usize);
        let side = control[i] - control[j];
        let (found, direction) = (side.length(), side.normalize_or_zero());
        terms.clear();
        add(&mut terms, i, direction);
        add(&mut terms, j, -direction);
        // Where no end is free nothing can be done, and nothing is to be counted.
        if !terms.is_empty() {
            most = most.max((found - length).abs());
            equations.add(&terms, length - found);
        }
    }
    if let Some(level) = level {
        terms.clear();
        level.normals.iter().enumerate().for_each(|(i, &normal)| add(&mut terms, i, normal));
        let found: f64 = level.normals.iter().zip(control).map(|(normal, point)| normal.dot(*point)).sum();
        most = most.max((found - level.value).abs());
        equations.add(&terms, level.value - found);
    }
    let unknowns = 3 * number.iter().flatten().count() as u32;
    (0..unknowns).for_each(|k| equations.add(&[(k, DAMPING)], 0.0));
    if most.is_nan() { f64::INFINITY } else { most }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::Random;
    use crate::geometry::snakes::{ArcShape, Pose, Snake};

    #[test]
    fn distances_are_met_to_round_off_and_points_hardly_move() {
        let mut random = Random(5);
        for count in [1, 4, 12] {
            let arcs: Vec<ArcShape> = (0..count)
                .map(|_| {
                    let radius = random.between(0.5, 2.0);
                    ArcShape { radius, length: radius * random.between(0.5, 1.5) }
                })
                .collect();
            let torsions: Vec<f64> = (1..count).map(|_| random.between(-1.0, 1.0)).collect();
            let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
            let snake = Snake::from_arcs(&arcs, &torsions, &pose).unwrap();
            for noise in [0.0, 0.005, 0.05] {
                let disturbed: Vec<DVec3> = snake.control().iter().map(|p| *p + noise * random.vector()).collect();
                let mut control = disturbed.clone();
                let residual = polish(&mut control, &snake.distances(), &|_| true, None).unwrap();
                let found = snake.moved(control.clone()).unwrap();
                assert_eq!(residual, found.residual());
                assert!(residual < 4e-15 * snake.size(), "{residual}");
                let moved = control.iter().zip(&disturbed).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
                assert!(moved <= 4.0 * noise + 1e-14, "{moved} of {noise}");
            }
            // Ends that are held stay, and what cannot be met says so.
            let mut control = snake.control().to_vec();
            control[0] += DVec3::new(0.0, 0.0, 0.01);
            let (first, before) = (control[0], control[count]);
            let residual = polish(&mut control, &snake.distances(), &|i| i > 0, None).unwrap();
            assert!(residual < 4e-15 * snake.size() && control[0] == first && control[count] != before);
            let residual = polish(&mut control, &snake.distances(), &|i| i == 1, None).unwrap();
            assert!(residual < 4e-15 * snake.size());
            control[0] += DVec3::new(30.0, 0.0, 0.0);
            assert!(polish(&mut control, &snake.distances(), &|i| i == 1, None).unwrap() > 1.0);
            assert!(control.iter().all(|point| point.is_finite()));
        }
    }
}
