//! Kernels of types that fit planes, lines, circles and shapes to their points.
//!
//! Where the nearest configuration is not unique, or points moved by round-off would have another, the two backends may find
//! different ones. The card's must then be feasible, by the processor's measure of violation, and as near to the points as the
//! processor's. How many are judged so is printed, and bounded for random points.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use crate::has_adapter;
use crate::kernels::{COUNTS, Compared, NEAR, Random, Sample, compare, diameter, solver_of};

/// Most that random constraints, of points with no symmetry, may need the second judgement.
const MOST_UNSURE: f64 = 0.05;

/// Kinds of points below this are random ones without any symmetry.
const GENERIC: usize = 4;

/// Kinds of points, of which [`shape`] makes one.
const KINDS: usize = 21;

/// `k` points of a kind, about 1 apart.
fn shape(random: &mut Random, k: usize, kind: usize) -> Vec<DVec3> {
    let tiny = 10_f64.powf(random.within(-9.0, -1.0));
    let (a, b) = (random.vector(), random.vector());
    let t: Vec<f64> = (0..k).map(|_| random.within(-1.0, 1.0)).collect();
    let jitter: Vec<DVec3> = (0..k).map(|_| random.vector()).collect();
    let corner = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
    let regular: Vec<DVec3> = (0..k).map(|j| corner(TAU * j as f64 / k as f64)).collect();
    let all = |place: &dyn Fn(usize) -> DVec3| (0..k).map(place).collect();
    match kind {
        0..GENERIC => jitter,
        // Coincident, on a line, and nearly.
        4 => vec![a; k],
        5 => all(&|j| a + t[j] * b),
        6 => all(&|j| a + t[j] * b + tiny * jitter[j]),
        // In a plane, and nearly.
        7 => all(&|j| DVec3::new(jitter[j].x, jitter[j].y, 0.3)),
        8 => all(&|j| DVec3::new(jitter[j].x, jitter[j].y, tiny * jitter[j].z)),
        // Regular, in the other sense, nearly, and too flat.
        9 => regular,
        10 => regular.into_iter().rev().collect(),
        11 => all(&|j| regular[j] + tiny * jitter[j]),
        12 => all(&|j| DVec3::new(regular[j].x, 0.3 * regular[j].y, 0.0)),
        // Two at one place, two clusters, thin boxes.
        13 => all(&|j| jitter[j.max(1)]),
        14 => all(&|j| if j % 2 == 0 { a } else { b } + tiny * jitter[j]),
        15 => all(&|j| jitter[j] * DVec3::new(1.0, tiny, tiny * tiny)),
        16 => all(&|j| jitter[j] * DVec3::new(1.0, 0.03, 0.001)),
        // Arcs and caps, short ones too.
        17 => all(&|j| corner(t[j] * tiny.powf(0.3)) / tiny.powf(0.3)),
        18 => all(&|j| (DVec3::new(jitter[j].x, jitter[j].y, 1.0 / tiny.powf(0.3))).normalize() / tiny.powf(0.3)),
        // Parallelograms, and rectangles where all but two sides are of no length.
        19 => all(&|j| [DVec3::ZERO, a, a + b, b][j % 4]),
        _ => all(&|j| [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y, DVec3::Z, -DVec3::Z][j % 6]),
    }
}

/// Points of any kind, turned, of any size, anywhere within the model.
fn placed(random: &mut Random, k: usize, kind: usize) -> Vec<DVec3> {
    let (size, place, turn) = (random.size(), 1e3 * random.vector(), turn(random));
    shape(random, k, kind).into_iter().map(|point| place + size * (turn * point)).collect()
}

fn turn(random: &mut Random) -> DQuat {
    DQuat::from_scaled_axis(3.0 * random.vector())
}

/// The points about their mean, which are the rows of centred types.
fn centred(points: &[DVec3]) -> Vec<DVec3> {
    let mean = points.iter().map(|point| *point - points[0]).sum::<DVec3>() / points.len() as f64;
    points.iter().map(|point| *point - points[0] - mean).collect()
}

fn distance(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt()
}

/// One that needs the second judgement.
struct Unsure {
    id: usize,
    size: f64,
    excess: f64,
    difference: f64,
    sample: Sample,
}

/// Compares the samples, whose kinds are their numbers modulo [`KINDS`]; `extent` is what else is as large as a constraint.
fn judge(type_name: &str, samples: &[Sample], extent: impl Fn(&Compared<'_>) -> f64) {
    if !has_adapter() {
        return;
    }
    let (mut unsure, mut worst) = (Vec::new(), 0.0_f64);
    compare(type_name, samples, |id, found| {
        let size = diameter(&found.sample.points).max(extent(found));
        let difference = found.difference();
        if difference <= NEAR * size {
            if difference > 0.0 {
                worst = worst.max(difference / size);
            }
            return;
        }
        let rows = centred(&found.sample.points);
        let excess = distance(&found.gpu, &rows) - distance(&found.cpu, &rows);
        let sample = Sample {
            points: found.gpu.clone(),
            scalars: found.sample.scalars.clone(),
            rest: Some(found.sample.rest.as_ref().unwrap_or(&found.sample.points).clone()),
        };
        unsure.push(Unsure { id, size, excess, difference, sample });
    });
    let generic = unsure.iter().filter(|one| one.id % KINDS < GENERIC).count();
    let count = samples.len();
    println!(
        "{type_name}: {count}; largest difference {worst:.1e}; {} judged by nearness, {generic} of random ones",
        unsure.len()
    );
    let (unsure, of_card): (Vec<_>, Vec<_>) =
        unsure.into_iter().map(|u| ((u.id, u.size, u.excess, u.difference), u.sample)).unzip();
    let violations = solver_of(type_name, &of_card).violations();
    let mut bad = 0;
    for ((id, size, excess, difference), violation) in unsure.into_iter().zip(violations) {
        if !(violation <= NEAR * size) || !(excess <= NEAR * size) {
            bad += 1;
            let k = samples[id].points.len();
            println!(
                "{type_name} {id} kind {} k {k}: violation {:.1e} excess {:.1e} difference {:.1e}",
                id % KINDS,
                violation / size,
                excess / size,
                difference / size
            );
        }
    }
    assert_eq!(bad, 0);
    assert!(
        generic as f64 <= MOST_UNSURE * (count * GENERIC / KINDS).max(20) as f64,
        "{type_name}: {generic} of {count}"
    );
}

/// Judges a type without scalars on points of these numbers.
fn judge_points(type_name: &str, seed: u64, point_counts: &[usize]) {
    let mut random = Random::new(seed);
    for count in COUNTS {
        let sample = |id: usize| {
            let k = point_counts[(id / KINDS) % point_counts.len()];
            let rest = (id % 2 == 0).then(|| placed(&mut random, k, id / 3 % KINDS));
            Sample { points: placed(&mut random, k, id % KINDS), scalars: None, rest }
        };
        judge(type_name, &(0..count).map(sample).collect::<Vec<_>>(), |_| 0.0);
    }
}

#[test]
fn planes() {
    judge_points("Plane", 11, &[4, 3, 5, 4, 6, 9, 40]);
}

#[test]
fn lines() {
    judge_points("Line", 12, &[2, 3, 4, 7, 40]);
}

#[test]
fn circles() {
    judge_points("Circle", 13, &[4, 3, 5, 6, 9, 40]);
}

#[test]
fn spheres() {
    judge_points("Sphere", 14, &[4, 5, 6, 9, 40]);
}

#[test]
fn rectangles() {
    judge_points("Rectangle", 15, &[4]);
}

#[test]
fn parallelograms() {
    judge_points("Parallelogram", 16, &[4]);
}

#[test]
fn regular_polygons() {
    judge_points("RegularPolygon", 17, &[3, 4, 5, 6, 8, 13, 40]);
}
