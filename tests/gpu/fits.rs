//! Kernels of types that fit planes, lines, circles and shapes to their points.
//!
//! Where the nearest configuration is not unique, or points moved by round-off would have another, the two backends may
//! find different ones. The card's must then be feasible, by the processor's measure of violation, and as near to the
//! points as the processor's. Types whose projection is not the nearest have no nearness to hold to where round-off
//! matters (the circle through nearly straight points in zigzag is such a place): there the card's answer must be no
//! farther from the processor's than that moves when the points do. How many are judged so is printed, and bounded for
//! random points.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use shapeop::constraints::{Projection, types};
use shapeop::solver::{Backend, Solver};

use crate::has_adapter;
use crate::kernels::{
    AS_GOOD, COUNTS, Compared, ILL_CONDITIONED, NEAR, Random, Sample, account, compare, diameter, solver_of,
};

/// Most that random constraints, of points with no symmetry, may need the second judgement.
const MOST_UNSURE: f64 = 0.01;

/// Of the constraint's diameter: what points may be moved by round-off, a few units in the last place of single
/// precision.
const ROUND_OFF: f64 = 5e-7;

/// How well the card knows places: 14 digits of the model's size, some 6e3 here.
const KNOWN: f64 = 1e-10;

/// How often points are moved to see how far answers go.
const MOVES: usize = 32;

/// How much farther than with the worst of so many moves an answer may go: no move is the worst of all.
const WORSE: f64 = 2.0;

/// Kinds of points below this are random ones without any symmetry.
const GENERIC: usize = 4;

/// Kinds of points, of which [`shape`] makes one.
const KINDS: usize = 22;

/// The types that take four points and no scalars, or by default their shape at rest.
const FITS: [&str; 10] = [
    "Plane",
    "Line",
    "Circle",
    "Sphere",
    "Rectangle",
    "Parallelogram",
    "Similarity",
    "Rigid",
    "RegularPolygon",
    "Orientation",
];

/// `k` points of a kind, about 1 apart.
fn shape(random: &mut Random, k: usize, kind: usize) -> Vec<DVec3> {
    let tiny = 10_f64.powf(random.within(-9.0, -1.0));
    let (a, b) = (random.vector(), random.vector());
    let t: Vec<f64> = (0..k).map(|_| random.within(-1.0, 1.0)).collect();
    let jitter: Vec<DVec3> = (0..k).map(|_| random.vector()).collect();
    let radius = tiny.powf(-0.3);
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
        13 => all(&|j| jitter[j.max(1) % k]),
        14 => all(&|j| if j % 2 == 0 { a } else { b } + tiny * jitter[j]),
        15 => all(&|j| jitter[j] * DVec3::new(1.0, tiny, tiny * tiny)),
        16 => all(&|j| jitter[j] * DVec3::new(1.0, 0.03, 0.001)),
        // Arcs and caps, short ones too.
        17 => all(&|j| radius * (corner(t[j] / radius) - DVec3::X)),
        18 => all(&|j| radius * ((jitter[j].with_z(0.0) / radius + DVec3::Z).normalize() - DVec3::Z)),
        // Parallelograms and rectangles, where there are more than four points in several turns, and the ends of axes.
        19 => all(&|j| [DVec3::ZERO, a, a + b, b][j % 4]),
        20 => all(&|j| [DVec3::ZERO, DVec3::X, DVec3::X + t[0] * DVec3::Y, t[0] * DVec3::Y][j % 4]),
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

/// One whose answers differ.
struct Unsure {
    id: usize,
    size: f64,
    difference: f64,
    /// By how much farther from the points the card's answer is than the processor's.
    excess: f64,
    /// The sample, and one on the card's answer.
    sample: Sample,
    answer: Sample,
}

/// Compares the samples, whose kinds are their numbers modulo [`KINDS`]; `extent` is what else is as large as a
/// constraint.
fn judge(type_name: &str, samples: &[Sample], extent: impl Fn(&Compared<'_>) -> f64) {
    if !has_adapter() {
        return;
    }
    let (mut unsure, mut worst) = (Vec::new(), 0.0_f64);
    compare(type_name, samples, |id, found| {
        let size = diameter(&found.sample.points).max(extent(found)).max(KNOWN / NEAR);
        let difference = found.difference();
        if difference <= NEAR * size {
            worst = worst.max(difference / size.max(f64::MIN_POSITIVE));
            return;
        }
        let rows = centred(&found.sample.points);
        let excess = distance(&found.gpu, &rows) - distance(&found.cpu, &rows);
        let rest = Some(found.sample.rest.as_ref().unwrap_or(&found.sample.points).clone());
        let on = |points: &[DVec3]| Sample {
            points: points.to_vec(),
            scalars: found.sample.scalars.clone(),
            rest: rest.clone(),
        };
        let (sample, answer) = (on(&found.sample.points), on(&found.gpu));
        unsure.push(Unsure { id, size, difference, excess, sample, answer });
    });
    let generic = unsure.iter().filter(|one| one.id % KINDS < GENERIC).count();
    let (count, unsure_count) = (samples.len(), unsure.len());
    assert_feasible(type_name, &unsure);
    let far: Vec<Unsure> = unsure.into_iter().filter(|one| one.excess > NEAR * one.size).collect();
    account(type_name, count, worst, &[(unsure_count - far.len(), AS_GOOD), (far.len(), ILL_CONDITIONED)]);
    assert_within_round_off(type_name, &far);
    // Or three of few.
    let most = (MOST_UNSURE * (count * GENERIC / KINDS) as f64).max(3.0);
    assert!(generic as f64 <= most, "{type_name}: {generic} of {count}");
}

/// The card's answers are in the type's set.
fn assert_feasible(type_name: &str, unsure: &[Unsure]) {
    let answers: Vec<Sample> = unsure.iter().map(|one| one.answer.clone()).collect();
    for (one, violation) in unsure.iter().zip(solver_of(type_name, &answers).violations()) {
        let kind = one.id % KINDS;
        assert!(violation <= NEAR * one.size, "{type_name} {} of kind {kind}: {violation} of {}", one.id, one.size);
    }
}

/// The card's answers are no farther from the processor's than those move with the points. Only types of which the
/// nearest answer is not promised: of nearest answers the distance hardly changes.
fn assert_within_round_off(type_name: &str, far: &[Unsure]) {
    let promise = types().find(|info| info.name == type_name).unwrap().projection;
    assert!(far.is_empty() || promise == Projection::Feasible, "{type_name}: {} answers are too far", far.len());
    let mut random = Random::new(99);
    let mut project = |amount: f64| {
        let moved = far.iter().map(|one| {
            let mut sample = one.sample.clone();
            sample.points.iter_mut().for_each(|point| *point += amount * one.size * random.vector());
            sample
        });
        solver_of(type_name, &moved.collect::<Vec<_>>()).projections(Backend::Cpu).unwrap()
    };
    let still = project(0.0);
    let mut most = vec![0.0_f64; far.len()];
    for _ in 0..MOVES {
        for ((most, still), moved) in most.iter_mut().zip(&still).zip(project(ROUND_OFF)) {
            *most = most.max(distance(still, &moved));
        }
    }
    for (one, most) in far.iter().zip(most) {
        let Unsure { id, size, difference, .. } = one;
        assert!(
            *difference <= WORSE * most,
            "{type_name} {id} of kind {}: {difference} > {most} of {size}",
            id % KINDS
        );
    }
}

/// Constraints without scalars, on points of these numbers.
fn samples(random: &mut Random, count: usize, point_counts: &[usize]) -> Vec<Sample> {
    let sample = |id: usize| {
        let k = point_counts[(id / KINDS) % point_counts.len()];
        let rest = id.is_multiple_of(2).then(|| placed(random, k, id / 3 % KINDS));
        Sample { points: placed(random, k, id % KINDS), scalars: None, rest }
    };
    (0..count).map(sample).collect()
}

/// Compares the samples of a type whose nearest answer is unique, within [`NEAR`] of the size.
fn compare_closely(type_name: &str, samples: &[Sample], size: impl Fn(&Compared<'_>) -> f64) {
    let mut worst = 0.0_f64;
    compare(type_name, samples, |id, found| {
        let (difference, size) = (found.difference(), size(found));
        assert!(difference <= NEAR * size, "{type_name} {id}: {:?} {:?}", found.cpu, found.gpu);
        worst = worst.max(difference / size.max(f64::MIN_POSITIVE));
    });
    account(type_name, samples.len(), worst, &[]);
}

/// Judges a type without scalars.
fn judge_points(type_name: &str, seed: u64, point_counts: &[usize]) {
    let mut random = Random::new(seed);
    for count in COUNTS {
        judge(type_name, &samples(&mut random, count, point_counts), |_| 0.0);
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

#[test]
fn points_in_planes_of_given_normals() {
    let mut random = Random::new(18);
    for count in COUNTS {
        let sample = |id: usize| {
            let k = [3, 4, 5, 40][id / KINDS % 4];
            let scalars = (random.size() * random.vector()).to_array().to_vec();
            Sample {
                points: placed(&mut random, k, id % KINDS),
                scalars: (!id.is_multiple_of(4)).then_some(scalars),
                rest: None,
            }
        };
        compare_closely("Orientation", &(0..count).map(sample).collect::<Vec<_>>(), |found| {
            diameter(&found.sample.points)
        });
    }
}

#[test]
fn points_on_given_planes_and_lines() {
    let mut random = Random::new(19);
    for (count, name) in COUNTS.into_iter().flat_map(|count| [(count, "OnPlane"), (count, "OnLine")]) {
        let sample = |id: usize| {
            let point = 1e3 * random.vector();
            let place = if id.is_multiple_of(5) { point } else { point + random.size() * random.vector() };
            let axis = random.size() * random.vector();
            let scalars = [place.to_array(), axis.to_array()].concat();
            Sample {
                points: vec![point],
                scalars: (!id.is_multiple_of(7)).then_some(scalars),
                rest: id.is_multiple_of(7).then(|| vec![place]),
            }
        };
        compare_closely(name, &(0..count).map(sample).collect::<Vec<_>>(), |found| {
            DVec3::from_slice(&found.scalars).distance(found.sample.points[0]).max(KNOWN / NEAR)
        });
    }
}

/// Templates, and points that are anything, or one of the templates in another order, moved, turned, scaled and moved
/// about.
fn templates_and_points(random: &mut Random, id: usize, scaled: bool) -> Sample {
    let k = [4, 3, 5, 4, 6, 2, 7, 1, 8, 12][id / KINDS % 10];
    let kind = if id % KINDS < GENERIC { [0, 9, 12, 7][id % GENERIC] } else { (id / 5) % KINDS };
    let unit = random.size();
    let template_count = [1, 1, 2, 3][random.below(4)];
    let templates: Vec<Vec<DVec3>> = (0..template_count)
        .map(|_| {
            let (size, turn) = (unit * random.within(0.5, 2.0), turn(random));
            let place = [0.0, 1e3][random.below(2)] * random.vector();
            shape(random, k, kind).into_iter().map(|point| place + size * (turn * point)).collect()
        })
        .collect();
    let points = if (id / KINDS).is_multiple_of(2) {
        let scale = if scaled { random.size() / unit } else { 1.0 };
        let own = &templates[random.below(template_count)];
        // Of a template that is a point only noise has a size.
        let noise = if diameter(own) > 0.0 { [0.0, 1e-8, 0.3][id % 3] } else { 0.3 };
        let (place, turn, shift) = (1e3 * random.vector(), turn(random), random.below(k));
        let is_mirrored = random.below(2) == 0;
        let order = |j: usize| if is_mirrored { (shift + k - j) % k } else { (shift + j) % k };
        (0..k).map(|j| place + scale * (turn * (own[order(j)] - own[0]) + noise * unit * random.vector())).collect()
    } else {
        let size = if scaled { random.size() } else { unit * random.within(0.1, 3.0) };
        let (place, turn) = (1e3 * random.vector(), turn(random));
        shape(random, k, id % KINDS).into_iter().map(|point| place + size * (turn * point)).collect()
    };
    let scalars = templates.iter().flatten().flat_map(|point| point.to_array()).collect();
    if id.is_multiple_of(9) {
        return Sample { points, scalars: None, rest: Some(templates[0].clone()) };
    }
    Sample { points, scalars: Some(scalars), rest: None }
}

#[test]
fn similar_shapes() {
    let mut random = Random::new(20);
    for count in COUNTS {
        let samples: Vec<Sample> = (0..count).map(|id| templates_and_points(&mut random, id, true)).collect();
        judge("Similarity", &samples, |_| 0.0);
    }
}

#[test]
fn rigid_shapes() {
    let mut random = Random::new(21);
    for count in COUNTS {
        let samples: Vec<Sample> = (0..count).map(|id| templates_and_points(&mut random, id, false)).collect();
        judge("Rigid", &samples, |found| {
            let vertices: Vec<DVec3> = found.scalars.chunks_exact(3).map(DVec3::from_slice).collect();
            vertices.chunks_exact(found.sample.points.len()).map(diameter).fold(0.0, f64::max)
        });
    }
}

#[test]
fn points_that_are_named_twice() {
    if !has_adapter() {
        return;
    }
    let mut random = Random::new(22);
    let lists: [&[u32]; 5] = [&[0, 0, 1, 2], &[0, 1, 0, 2], &[3, 4, 5, 5], &[2, 2, 2, 2], &[1, 4, 1, 1]];
    for name in FITS {
        let mut solver = Solver::new();
        let rest: Vec<DVec3> = (0..6).map(|_| random.vector()).collect();
        solver.set_points(&rest).unwrap();
        for list in &lists {
            solver.add_constraint(name, list, 1.0).unwrap();
        }
        solver.set_points(&(0..6).map(|_| 3.0 * random.vector()).collect::<Vec<_>>()).unwrap();
        let (cpu, gpu) = (solver.projections(Backend::Cpu).unwrap(), solver.projections(Backend::Gpu).unwrap());
        for (list, (cpu, gpu)) in lists.iter().zip(cpu.iter().zip(&gpu)) {
            if distance(cpu, gpu) <= NEAR {
                continue;
            }
            // Regular polygons of which the corners lie on a line can be in any plane; of quadrilaterals with two
            // opposite corners at one place all directions of a rectangle's sides are as good.
            let rows = centred(&list.iter().map(|&index| solver.points()[index as usize]).collect::<Vec<_>>());
            let excess = distance(gpu, &rows) - distance(cpu, &rows);
            assert!(excess <= NEAR, "{name} {list:?}: {cpu:?} {gpu:?}");
            let answer = Sample { points: gpu.clone(), scalars: None, rest: None };
            assert!(solver_of(name, &[answer]).violations()[0] <= NEAR, "{name} {list:?}: {gpu:?}");
        }
    }
}

#[test]
fn a_thousand_points_at_once() {
    let mut random = Random::new(23);
    for name in ["Plane", "Line", "Circle", "Sphere", "Orientation", "RegularPolygon"] {
        judge(name, &samples(&mut random, 3 * KINDS, &[1000]), |_| 0.0);
    }
}

#[test]
fn tiny_constraints_are_projected_within_their_size() {
    let mut random = Random::new(24);
    for name in FITS {
        let mut sample = |id: usize| {
            let (size, place) = (10_f64.powf(random.within(-16.0, 3.0)), 1e3 * random.vector());
            let own = shape(&mut random, 4, id % KINDS);
            Sample { points: own.into_iter().map(|point| place + size * point).collect(), scalars: None, rest: None }
        };
        // Finite they are by `compare`.
        compare(name, &(0..50 * KINDS).map(&mut sample).collect::<Vec<_>>(), |id, found| {
            let most = 4.0 * diameter(&found.sample.points) + KNOWN;
            assert!(found.gpu.iter().all(|target| target.length() <= most), "{name} {id}: {:?} of {most}", found.gpu);
        });
    }
}
