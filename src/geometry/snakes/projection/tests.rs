use std::f64::consts::{FRAC_PI_2, PI};

use super::super::functionals::near_vector;
use super::super::tests::{circular, open_snake, regular, shaken};
use super::*;
use crate::geometry::random::Random;
use crate::mesh::reference::ParametricSurface;
use crate::mesh::surfaces::sphere;

fn noisy(snake: &Snake, noise: f64, seed: u64) -> Vec<DVec3> {
    let mut random = Random(seed);
    snake.control().iter().map(|&point| point + noise * random.vector()).collect()
}

fn norm(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt()
}

#[test]
fn what_keeps_its_distances_stays() {
    for snake in [open_snake(1, 4), open_snake(12, 5), regular(8)] {
        let found = project(&Task::new(&snake, snake.control()), &Options::default()).unwrap();
        assert!(found.snake.control().iter().zip(snake.control()).all(|(a, b)| a.distance(*b) <= 1e-14));
        let exact = Options { is_exact: true, ..Options::default() };
        let found = project(&Task::new(&snake, snake.control()), &exact).unwrap();
        assert!(found.snake.control().iter().zip(snake.control()).all(|(a, b)| a.distance(*b) <= 1e-13));
    }
}

#[test]
fn noisy_targets_come_back_near_the_nearest_position() {
    for (noise, seed) in [(0.005, 1), (0.02, 2), (0.05, 3)] {
        let snake = open_snake(8, 11);
        let target = noisy(&snake, noise, seed);
        let task = Task::new(&snake, &target);
        let near = project(&task, &Options::default()).unwrap();
        let nearest = project(&task, &Options { is_exact: true, ..Options::default() }).unwrap();
        let size = 8.0;
        for found in [&near, &nearest] {
            assert!(found.snake.residual() <= 1e-13 * size, "{}", found.snake.residual());
        }
        let (a, b) = (norm(near.snake.control(), &target), norm(nearest.snake.control(), &target));
        assert!(nearest.is_nearest && b <= a && a <= 1.001 * b, "{noise}: {a} {b}");
        // The way to the nearest position is at right angles to all admissible velocities.
        let way: Vec<DVec3> = target.iter().zip(nearest.snake.control()).map(|(a, b)| a - b).collect();
        for i in 0..way.len() {
            let pull = near_vector(i, DVec3::new(0.3, -0.7, 0.5), 1.0);
            let v = super::super::velocity::velocity(&nearest.snake, &[], &pull).unwrap().vectors;
            let along: f64 = way.iter().zip(&v).map(|(w, v)| w.dot(*v)).sum();
            assert!(along.abs() < 1e-9 * b, "{along}");
        }
    }
}

#[test]
fn sizes_do_not_matter() {
    let snake = open_snake(6, 2);
    let target = noisy(&snake, 0.02, 9);
    let found = project(&Task::new(&snake, &target), &Options::default()).unwrap();
    for scale in [1e-3, 1e3] {
        let big = Snake::new(snake.control().iter().map(|p| scale * p).collect(), false, None).unwrap();
        let target: Vec<DVec3> = target.iter().map(|p| scale * p).collect();
        let scaled = project(&Task::new(&big, &target), &Options::default()).unwrap();
        let pairs = scaled.snake.control().iter().zip(found.snake.control());
        assert!(pairs.map(|(a, b)| (a / scale).distance(*b)).all(|apart| apart < 1e-9));
    }
}

#[test]
fn given_points_stay_and_conditions_hold() {
    let snake = open_snake(7, 3);
    let mut target = noisy(&snake, 0.02, 4);
    target[0] = snake.control()[0];
    target[8] = snake.control()[8] + DVec3::new(0.01, 0.02, -0.01);
    // A contact in the plane z = its height: a condition on two control points.
    let height = snake.control()[4].z;
    let row = Row { terms: vec![(3, 0.4 * DVec3::Z), (4, 0.6 * DVec3::Z)], right: height, weight: 1.0 };
    for is_exact in [false, true] {
        let task = Task { fixed: &[0, 8], conditions: std::slice::from_ref(&row), ..Task::new(&snake, &target) };
        let found = project(&task, &Options { is_exact, ..Options::default() }).unwrap();
        let p = found.snake.control();
        assert_eq!((p[0], p[8]), (target[0], target[8]));
        assert!(found.snake.residual() < 1e-12 && (0.4 * p[3].z + 0.6 * p[4].z - height).abs() < 1e-12);
        assert!(found.moved < 0.5 && found.is_nearest);
    }
}

#[test]
fn heights_are_kept_to_round_off() {
    let surface =
        ParametricSurface::new([[-PI, PI], [-FRAC_PI_2 + 0.1, FRAC_PI_2 - 0.1]], [65, 33], sphere(1.0)).unwrap();
    // On the sphere: every second angle of a small circle, lifted.
    let flat = circular(8, 0.25);
    let points: Vec<DVec3> = flat.control().iter().map(|p| 0.8 * p + 0.6 * DVec3::Z).collect();
    let snake = Snake::new(points, false, None).unwrap();
    let heights: Vec<f64> = snake.control().iter().map(|p| p.length() - 1.0).collect();
    let target = noisy(&snake, 0.02, 6);
    let task = Task {
        surface: Some(Surface { reference: &surface, heights: &heights, reach: f64::INFINITY }),
        ..Task::new(&snake, &target)
    };
    let found = project(&task, &Options::default()).unwrap();
    assert!(found.snake.residual() < 1e-12 && found.height_residual < 1e-12, "{found:?}");
    assert!(found.snake.control().iter().zip(&heights).all(|(p, h)| (p.length() - 1.0 - h).abs() < 1e-12));
    assert!(found.snake.contacts().iter().all(|contact| (contact.length() - 1.0).abs() < 1e-10));
    let exact = Options { is_exact: true, ..Options::default() };
    assert_eq!(project(&task, &exact).unwrap_err().place(), "surface");
}

#[test]
fn lost_rank_is_no_error() {
    // A closed snake in a plane: one condition fewer to first order than further away.
    for count in [6, 7, 10] {
        let snake = regular(count);
        let target = shaken(count, 0.02, 5).control().to_vec();
        let found = project(&Task::new(&snake, &target), &Options::default()).unwrap();
        assert!(found.snake.residual() < 1e-12, "{count}: {found:?}");
        // Out of its plane only: distances change with the square of that.
        let target: Vec<DVec3> =
            (0..count).map(|i| snake.control()[i] + 0.02 * ((3 * i) as f64).sin() * DVec3::Z).collect();
        let found = project(&Task::new(&snake, &target), &Options::default()).unwrap();
        assert!(found.snake.residual() < 1e-12, "{count}: {found:?}");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let snake = open_snake(3, 7);
    let project = |task: &Task<'_>| project(task, &Options::default());
    assert_eq!(project(&Task::new(&snake, &[])).unwrap_err().place(), "target");
    let p = snake.control();
    assert_eq!(project(&Task { fixed: &[0, 5], ..Task::new(&snake, p) }).unwrap_err().place(), "fixed[1]");
    // Both ends fixed farther apart than the snake is long.
    let mut target = p.to_vec();
    (target[0], target[4]) = (DVec3::ZERO, 100.0 * DVec3::X);
    let error = project(&Task { fixed: &[0, 4], ..Task::new(&snake, &target) }).unwrap_err();
    assert!([Status::NoSolution, Status::Singular].contains(&error.status()), "{error}");
    let bad = Options { mu: 0.0, ..Options::default() };
    assert_eq!(super::project(&Task::new(&snake, p), &bad).unwrap_err().place(), "options.mu");
}

#[test]
fn distances_are_met_and_points_hardly_move() {
    let mut random = Random(5);
    for count in [1, 4, 12] {
        let snake = open_snake(count, count as u64);
        let distances = snake.distances();
        for noise in [0.0, 0.005, 0.05] {
            let disturbed: Vec<DVec3> = snake.control().iter().map(|p| *p + noise * random.vector()).collect();
            let mut control = disturbed.clone();
            let residual = meet(&mut control, false, &distances, &|_| false, &[]);
            assert_eq!(residual, snake.moved(control.clone()).unwrap().residual());
            assert!(residual < 1e-13 * snake.length(), "{residual}");
            let moved = control.iter().zip(&disturbed).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(moved <= 4.0 * noise + 1e-14, "{moved} of {noise}");
        }
        // Ends that are held stay, and what cannot be met says so.
        let mut control = snake.control().to_vec();
        control[0] += DVec3::new(0.0, 0.0, 0.01);
        let first = control[0];
        assert!(meet(&mut control, false, &distances, &|i| i == 0, &[]) < 1e-13 * snake.length());
        assert_eq!(control[0], first);
        control[0] += DVec3::new(30.0, 0.0, 0.0);
        let held = control.clone();
        assert!(meet(&mut control, false, &distances, &|i| i != 1, &[]) > 1.0);
        assert!(control.iter().all(|point| point.is_finite()));
        assert!((0..control.len()).all(|i| i == 1 || control[i] == held[i]));
    }
}
