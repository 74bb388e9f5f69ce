//! Snakes for tests.

use std::f64::consts::PI;

use glam::DVec3;

use super::{ArcShape, Pose, Snake};
use crate::geometry::random::Random;

/// An open snake of arcs and torsions that follow no rule.
pub fn open_snake(count: usize, seed: u64) -> Snake {
    let mut random = Random(seed);
    let arc = |random: &mut Random| {
        let radius = random.between(0.8, 1.5);
        ArcShape { radius, length: radius * random.between(0.4, 1.2) }
    };
    let arcs: Vec<ArcShape> = (0..count).map(|_| arc(&mut random)).collect();
    let torsions: Vec<f64> = (1..count).map(|_| random.between(-1.5, 1.5)).collect();
    let pose = Pose { point: random.vector(), tangent: random.vector(), normal: random.vector() };
    Snake::from_arcs(&arcs, &torsions, &pose).unwrap()
}

/// The unit circle about the origin in the plane `z = 0`, as a closed snake of equal arcs.
pub fn regular(count: usize) -> Snake {
    let half = PI / count as f64;
    let at = |i: usize| {
        let (sine, cosine) = (2.0 * half * i as f64).sin_cos();
        DVec3::new(cosine, sine, 0.0) / half.cos()
    };
    Snake::new((0..count).map(at).collect(), true, count.is_multiple_of(2).then_some(half.tan())).unwrap()
}

/// The arcs of [`regular`] with control points moved by up to `amount` in each coordinate, so that they do not keep their
/// distances.
pub fn shaken(count: usize, amount: f64, seed: u64) -> Snake {
    let mut random = Random(seed);
    let snake = regular(count);
    snake.moved(snake.control().iter().map(|&point| point + amount * random.vector()).collect()).unwrap()
}

/// A part of the unit circle of the plane `z = 0`: `count` arcs that turn by `angle` each, from `(1, 0)` on.
pub fn circular(count: usize, angle: f64) -> Snake {
    let pose = Pose { point: DVec3::X, tangent: DVec3::Y, normal: DVec3::NEG_X };
    Snake::from_arcs(&vec![ArcShape { radius: 1.0, length: angle }; count], &vec![0.0; count - 1], &pose).unwrap()
}

/// By how much a distance of two control points differs between two positions at most: 0 if they are congruent or mirrored.
pub fn incongruence(a: &[DVec3], b: &[DVec3]) -> f64 {
    let pairs = (0..a.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs.map(|(i, j)| (a[i].distance(a[j]) - b[i].distance(b[j])).abs()).fold(0.0, f64::max)
}
