//! The laws that every type keeps, checked over the whole registry.
//!
//! A law is a function of the type; `for_each_type!` calls it for each. Samples come from a fixed stream of numbers, so a
//! failure repeats; its message names the type and the sample.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::references::samples::{reference, with_references};
use super::{
    Constraint, ConstraintSet, Four, NewConstraints, Projection, Rows, Scalars, Stencil, TypeInfo, for_each_type,
};
use crate::error::Status;
use crate::linalg::lanes::V4;
use crate::linalg::simd::{Isa, LaneKernel, Portable, dispatch_lanes};

/// Samples per law and type.
const SAMPLES: u64 = 300;

/// Round-off of a projection of points about 1 in size; the worst found is about 1e-12.
const ROUND_OFF: f64 = 1e-10;

/// A fixed stream of numbers in `[0, 1)`.
pub(super) struct Stream(pub(super) u64);

impl Stream {
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn vector(&mut self) -> DVec3 {
        2.0 * DVec3::new(self.next(), self.next(), self.next()) - 1.0
    }

    pub(super) fn vectors(&mut self, count: usize) -> Vec<DVec3> {
        (0..count).map(|_| self.vector()).collect()
    }
}

/// One constraint on its own points, `0, 1, …`.
#[derive(Clone, Debug)]
pub(super) struct Sample<T> {
    pub(super) constraint: T,
    pub(super) scalars: Vec<f64>,
    indices: Vec<u32>,
}

impl<T: Constraint> Sample<T> {
    pub(super) fn at_rest(rest: &[DVec3]) -> Self {
        Self::at_rest_by(rest, |point| point)
    }

    /// As `at_rest`, with a reference that was moved by `place`.
    fn at_rest_by(rest: &[DVec3], place: impl Fn(DVec3) -> DVec3) -> Self {
        let indices: Vec<u32> = (0..rest.len() as u32).collect();
        let mut scalars = Vec::new();
        let mut constraint = T::at_rest(T::INFO.rows.stencil(rest, &indices), &mut scalars);
        if let Some(kind) = T::REFERENCE {
            constraint.refer_to(&Arc::new(reference(kind, 0, place)));
        }
        Self { constraint, scalars, indices }
    }

    /// At rest where `rest` is, with other scalars than the defaults.
    fn random(rest: &[DVec3], stream: &mut Stream) -> Self {
        let mut sample = Self::at_rest(rest);
        match T::INFO.scalars {
            Scalars::None => {}
            Scalars::Shapes => {
                let k = rest.len();
                // A regular polygon, which has fast ways of its own, or two shapes of any kind.
                let (u, v, center) = (stream.vector(), stream.vector(), stream.vector());
                let v = (v - v.dot(u) / u.length_squared() * u).normalize() * u.length();
                let corner = |j: usize| {
                    let (sin, cos) = (std::f64::consts::TAU * j as f64 / k as f64).sin_cos();
                    center + cos * u + sin * v
                };
                let shapes = if stream.next() < 0.7 { (0..k).map(corner).collect() } else { stream.vectors(2 * k) };
                sample.scalars = shapes.iter().flat_map(DVec3::to_array).collect();
            }
            Scalars::Named(_) if T::REFERENCE.is_some() => {
                sample.scalars[0] = (3.0 * stream.next()).floor();
            }
            Scalars::Named(_) => {
                let defaults = sample.scalars.clone();
                sample.scalars = (0..1000)
                    .map(|_| defaults.iter().map(|d| d * (0.5 + stream.next()) + 0.5 * stream.next()).collect())
                    .find(|scalars: &Vec<f64>| T::check_scalars(scalars).is_ok())
                    .unwrap_or(defaults);
            }
        }
        sample.constraint.scalars_changed(&sample.scalars);
        if let Some(kind) = T::REFERENCE {
            sample.constraint.refer_to(&Arc::new(reference(kind, sample.scalars[0] as u64, |point| point)));
        }
        sample
    }

    pub(super) fn project(&self, x: &[DVec3]) -> Vec<DVec3> {
        let mut targets = vec![DVec3::NAN; self.row_count()];
        self.constraint.project(&self.scalars, T::INFO.rows.stencil(x, &self.indices), &mut targets);
        targets
    }

    pub(super) fn violation(&self, x: &[DVec3]) -> f64 {
        self.constraint.violation(&self.scalars, T::INFO.rows.stencil(x, &self.indices))
    }

    fn row_count(&self) -> usize {
        T::INFO.rows.count(self.indices.len())
    }

    fn rows(&self) -> Vec<f64> {
        let mut rows = vec![0.0; self.row_count() * self.indices.len()];
        match T::INFO.rows {
            Rows::Centred => {
                let k = self.indices.len();
                for (i, entry) in rows.iter_mut().enumerate() {
                    *entry = f64::from(u8::from(i / k == i % k)) - 1.0 / k as f64;
                }
            }
            Rows::Linear(_) => self.constraint.rows(&self.scalars, &mut rows),
            Rows::Pairs => {
                for (r, row) in rows.chunks_exact_mut(self.indices.len()).enumerate() {
                    row[2 * r..2 * r + 2].copy_from_slice(&[-1.0, 1.0]);
                }
            }
        }
        rows
    }

    /// `A x`.
    pub(super) fn image(&self, x: &[DVec3]) -> Vec<DVec3> {
        self.rows().chunks_exact(x.len()).map(|row| row.iter().zip(x).map(|(&a, &point)| a * point).sum()).collect()
    }

    /// `Aᵀ(A x − P(x))`.
    fn pull(&self, x: &[DVec3]) -> Vec<DVec3> {
        let (rows, image, targets) = (self.rows(), self.image(x), self.project(x));
        let gaps = || image.iter().zip(&targets).map(|(image, target)| *image - *target);
        (0..x.len()).map(|i| gaps().enumerate().map(|(row, gap)| rows[row * x.len() + i] * gap).sum()).collect()
    }

    /// Points near `x` whose image is `targets`: `x + Aᵀ (A Aᵀ)⁻¹ (targets − A x)`.
    pub(super) fn lift(&self, x: &[DVec3], targets: &[DVec3]) -> Vec<DVec3> {
        if T::INFO.rows == Rows::Centred {
            return targets.to_vec();
        }
        let (rows, k, count) = (self.rows(), x.len(), targets.len());
        let dot = |a: usize, b: usize| (0..k).map(|i| rows[a * k + i] * rows[b * k + i]).sum::<f64>();
        let mut gram: Vec<Vec<f64>> = (0..count).map(|a| (0..count).map(|b| dot(a, b)).collect()).collect();
        let mut rest: Vec<DVec3> = targets.iter().zip(self.image(x)).map(|(&target, image)| target - image).collect();
        for pivot in 0..count {
            for row in (0..count).filter(|&row| row != pivot) {
                let factor = gram[row][pivot] / gram[pivot][pivot];
                for column in 0..count {
                    gram[row][column] -= factor * gram[pivot][column];
                }
                let step = factor * rest[pivot];
                rest[row] -= step;
            }
        }
        let along: Vec<DVec3> = (0..count).map(|row| rest[row] / gram[row][row]).collect();
        (0..k).map(|i| x[i] + (0..count).map(|row| rows[row * k + i] * along[row]).sum::<DVec3>()).collect()
    }
}

/// Rest points and points of sample `seed`, as many as the type takes.
pub(super) fn points(info: &TypeInfo, seed: u64) -> (Vec<DVec3>, Vec<DVec3>, Stream) {
    let mut stream = Stream(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    stream.next();
    let most = info.greatest_indices.unwrap_or(info.least_indices + 4);
    let count = info.least_indices + (stream.next() * (most - info.least_indices + 1) as f64) as usize;
    let count = if info.rows == Rows::Pairs { count & !1 } else { count };
    let (rest, x) = (stream.vectors(count), stream.vectors(count));
    (rest, x, stream)
}

pub(super) fn squared_distance(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum()
}

/// The size of targets, for relative bounds: rows of thin rest triangles magnify.
fn size(targets: &[DVec3]) -> f64 {
    1.0 + targets.iter().map(|target| target.length()).fold(0.0, f64::max)
}

#[test]
fn the_registry_says_what_the_types_do() {
    fn law<T: Constraint>() {
        let (rest, _, _) = points(&T::INFO, 1);
        let sample = Sample::<T>::at_rest(&rest);
        let name = T::INFO.name;
        T::INFO.check_index_count(rest.len()).unwrap();
        match T::INFO.scalars {
            Scalars::None => assert!(sample.scalars.is_empty(), "{name}"),
            Scalars::Named(scalars) => {
                assert_eq!(sample.scalars.len(), scalars.len(), "{name}");
                for (scalar, value) in scalars.iter().zip(&sample.scalars) {
                    assert_eq!(scalar.default.unwrap_or(*value), *value, "{name}: {}", scalar.name);
                }
                T::check_scalars(&sample.scalars).unwrap();
            }
            Scalars::Shapes => assert_eq!(sample.scalars.len(), 3 * rest.len(), "{name}"),
        }
        assert!(!sample.constraint.is_degenerate(&sample.scalars), "{name}");
        assert!(sample.constraint.measure(&sample.scalars) > 0.0, "{name}");
        assert!(!T::INFO.help.is_empty() && !T::INFO.violation_unit.is_empty() && !T::INFO.index_names.is_empty());
    }
    for_each_type!(law);
}

#[test]
fn what_is_projected_is_feasible_and_stays() {
    fn law<T: Constraint>() {
        for seed in 0..SAMPLES {
            let (rest, x, mut stream) = points(&T::INFO, seed);
            let sample = Sample::<T>::random(&rest, &mut stream);
            let targets = sample.project(&x);
            let feasible = sample.lift(&x, &targets);
            let (before, after) = (sample.violation(&x), sample.violation(&feasible));
            let bound = ROUND_OFF * (size(&sample.image(&x)) + size(&targets));
            let name = T::INFO.name;
            if T::INFO.projection == Projection::Approximate {
                assert!(after <= before + bound, "{name}, sample {seed}: violation {before} became {after}");
                continue;
            }
            assert!(after <= bound, "{name}, sample {seed}: violation {before} became {after}");
            let again = sample.project(&feasible);
            let moved = squared_distance(&again, &sample.image(&feasible)).sqrt();
            assert!(moved <= bound, "{name}, sample {seed}: moves by {moved} again");
        }
    }
    for_each_type!(law);
}

#[test]
fn no_feasible_configuration_is_nearer_than_the_nearest() {
    fn law<T: Constraint>() {
        if T::INFO.projection != Projection::Nearest {
            return;
        }
        for seed in 0..SAMPLES {
            let (rest, x, mut stream) = points(&T::INFO, seed);
            let sample = Sample::<T>::random(&rest, &mut stream);
            let (image, targets) = (sample.image(&x), sample.project(&x));
            let distance = squared_distance(&image, &targets).sqrt();
            for spread in [1.0, 0.3, 0.1, 0.01, 1e-4] {
                for _ in 0..10 {
                    // Feasible neighbours of the projection, some near and some far.
                    let moved: Vec<DVec3> =
                        targets.iter().map(|t| *t + spread * size(&targets) * stream.vector()).collect();
                    let other = sample.project(&sample.lift(&x, &moved));
                    let other_distance = squared_distance(&image, &other).sqrt();
                    assert!(
                        distance <= other_distance + ROUND_OFF * size(&targets),
                        "{}, sample {seed}: {other:?} at {other_distance} is nearer than {targets:?} at {distance}",
                        T::INFO.name
                    );
                }
            }
        }
    }
    for_each_type!(law);
}

#[test]
fn at_rest_without_violation_rows_and_projection_agree() {
    fn law<T: Constraint>() {
        let mut count = 0;
        for seed in 0..SAMPLES {
            let (rest, _, _) = points(&T::INFO, seed);
            // A rest state that has no violation may be any; types without one are taken to a feasible one.
            let sample = Sample::<T>::at_rest(&rest);
            let x = if sample.violation(&rest) < ROUND_OFF { rest } else { sample.lift(&rest, &sample.project(&rest)) };
            if sample.violation(&x) < ROUND_OFF {
                let (image, targets) = (sample.image(&x), sample.project(&x));
                let gap = squared_distance(&image, &targets).sqrt();
                assert!(
                    gap <= 10.0 * ROUND_OFF * size(&image),
                    "{}, sample {seed}: they differ by {gap}",
                    T::INFO.name
                );
                count += 1;
            }
        }
        assert!(count > SAMPLES / 2, "{}: only {count} samples without violation", T::INFO.name);
    }
    for_each_type!(law);
}

/// Turns the direction among the scalars, if there is one: its default may be fixed in space.
fn turn_directions(info: &TypeInfo, turn: DQuat, scalars: &[f64], turned: &mut [f64]) {
    let Scalars::Named(names) = info.scalars else { return };
    if let Some(at) = names.iter().position(|scalar| ["nx", "dx"].contains(&scalar.name)) {
        turned[at..at + 3].copy_from_slice(&(turn * DVec3::from_slice(&scalars[at..])).to_array());
    }
}

#[test]
fn projections_turn_and_scale_with_the_model() {
    fn law<T: Constraint>() {
        for seed in 0..SAMPLES {
            let (rest, x, mut stream) = points(&T::INFO, seed);
            let (turn, shift) = (DQuat::from_scaled_axis(3.0 * stream.vector()), stream.vector());
            let scale = 10_f64.powf(12.0 * stream.next() - 6.0);
            let sample = Sample::<T>::at_rest(&rest);
            let moved = |points: &[DVec3]| points.iter().map(|&p| scale * (turn * p + shift)).collect::<Vec<_>>();
            let mut other = Sample::<T>::at_rest_by(&moved(&rest), |point| moved(&[point])[0]);
            turn_directions(&T::INFO, turn, &sample.scalars, &mut other.scalars);
            other.constraint.scalars_changed(&other.scalars);
            let energy = |sample: &Sample<T>, x: &[DVec3]| {
                0.5 * sample.constraint.measure(&sample.scalars)
                    * squared_distance(&sample.image(x), &sample.project(x))
            };
            let name = T::INFO.name;
            let (found, expected) =
                (energy(&other, &moved(&x)), energy(&sample, &x) * scale.powi(T::INFO.energy_scale_power));
            let reference = sample.constraint.measure(&sample.scalars) * size(&sample.image(&x)).powi(2);
            let bound = ROUND_OFF * reference * scale.powi(T::INFO.energy_scale_power);
            assert!(
                (found - expected).abs() <= bound,
                "{name}, sample {seed}, scale {scale:e}: {found} is not {expected}"
            );
            // What a constraint pulls at its points, `Aᵀ(A x − P)`, turns with the model.
            let (here, there) = (sample.pull(&x), other.pull(&moved(&x)));
            let length = |pull: &[DVec3]| pull.iter().map(|p| p.length_squared()).sum::<f64>().sqrt();
            let factor = length(&there) / length(&here);
            if length(&here) > 1e-6 {
                for (h, t) in here.iter().zip(&there) {
                    let off = (turn * *h - *t / factor).length();
                    assert!(off <= 1e-7 * length(&here), "{name}, sample {seed}: turned otherwise by {off}");
                }
            }
        }
    }
    for_each_type!(law);
}

#[test]
fn whatever_is_finite_stays_finite() {
    fn law<T: Constraint>() {
        for seed in 0..20 {
            let (rest, _, mut stream) = points(&T::INFO, seed);
            let k = rest.len();
            let (a, b) = (stream.vector(), stream.vector());
            let kinds: [Vec<DVec3>; 6] = [
                vec![DVec3::ZERO; k],
                vec![a; k],
                (0..k).map(|i| a + i as f64 * b).collect(),
                (0..k).map(|i| a + (i % 2) as f64 * b).collect(),
                (0..k).map(|i| DVec3::new((i % 3) as f64, (i / 3) as f64, 0.0)).collect(),
                rest,
            ];
            let scales = [1.0, 1e9, 1e-9];
            let scaled: Vec<Vec<DVec3>> =
                kinds.iter().flat_map(|kind| scales.map(|s| kind.iter().map(|point| s * *point).collect())).collect();
            for rest in &scaled {
                let sample = Sample::<T>::at_rest(rest);
                let measure = sample.constraint.measure(&sample.scalars);
                assert!(measure.is_finite() && measure >= 0.0, "{}: measure {measure} of {rest:?}", T::INFO.name);
                assert!(sample.rows().iter().all(|a| a.is_finite()), "{}: rows of {rest:?}", T::INFO.name);
                for x in &scaled {
                    let (targets, violation) = (sample.project(x), sample.violation(x));
                    let is_finite = targets.iter().all(|target| target.is_finite()) && violation.is_finite();
                    assert!(is_finite && violation >= 0.0, "{}: rest {rest:?}, x {x:?}: {targets:?}", T::INFO.name);
                }
            }
        }
    }
    for_each_type!(law);
}

/// Projects four samples of as many points with [`Constraint::project_four`]; `None` where the plain way is to be taken.
fn project_four<T: Constraint>(
    samples: &[Sample<T>; 4],
    x: &[Vec<DVec3>; 4],
    is_portable: bool,
) -> [Option<Vec<DVec3>>; 4] {
    struct InLanes<'a, T>(&'a [Sample<T>; 4], &'a [Vec<DVec3>; 4]);
    impl<T: Constraint> LaneKernel for InLanes<'_, T> {
        type Output = [Option<Vec<DVec3>>; 4];

        fn run<S: Isa>(self, simd: S) -> Self::Output {
            let Self(samples, x) = self;
            let stencils: [Stencil<'_>; 4] = std::array::from_fn(|i| T::INFO.rows.stencil(&x[i], &samples[i].indices));
            let lanes: Vec<V4<S>> =
                (0..x[0].len()).map(|j| V4::gather(simd, stencils.map(|stencil| stencil.at(j)).each_ref())).collect();
            let mut targets = vec![V4::gather(simd, [&DVec3::NAN; 4]); samples[0].row_count()];
            let four = Four::new(
                simd,
                std::array::from_fn(|i| &samples[i].constraint),
                std::array::from_fn(|i| samples[i].scalars.as_slice()),
            );
            let is_done = T::project_four(four, &lanes, &mut targets);
            std::array::from_fn(|i| is_done.has(i).then(|| targets.iter().map(|target| target.to_array()[i]).collect()))
        }
    }
    if is_portable { InLanes(samples, x).run(Portable) } else { dispatch_lanes(InLanes(samples, x)) }
}

#[test]
fn four_at_once_are_projected_as_each_alone() {
    fn law<T: Constraint>() {
        let name = T::INFO.name;
        let (mut count, mut left, mut worst) = (0, 0, 0.0_f64);
        for seed in 0..SAMPLES {
            let (rest, _, mut stream) = points(&T::INFO, seed);
            let k = rest.len();
            if !T::takes_four(k) {
                continue;
            }
            let scale = 10_f64.powf(18.0 * stream.next() - 9.0);
            let mut configuration = |kind: usize| -> Vec<DVec3> {
                // Mostly generic points; some nearly flat or nearly collinear ones, some degenerate.
                let (a, b) = (stream.vector(), stream.vector());
                let flat = [DVec3::ONE, DVec3::new(1.0, 1.0, 1e-3), DVec3::new(1.0, 1e-5, 1e-5), DVec3::X, DVec3::ZERO];
                let turn = DQuat::from_scaled_axis(3.0 * a);
                (0..k).map(|_| scale * (turn * (flat[kind] * stream.vector()) + b)).collect()
            };
            let rests: [Vec<DVec3>; 4] = std::array::from_fn(|_| configuration(0));
            let kinds = [0, 1, 0, if seed % 4 == 0 { 2 + (seed / 4 % 3) as usize } else { 1 }];
            let x = kinds.map(&mut configuration);
            let samples: [Sample<T>; 4] =
                std::array::from_fn(|i| Sample::random(&rests[i], &mut Stream(seed + i as u64)));
            for (i, fast) in project_four(&samples, &x, seed % 2 == 0).into_iter().enumerate() {
                count += 1;
                let plain = samples[i].project(&x[i]);
                match fast {
                    None => left += 1,
                    Some(fast) => {
                        let difference = squared_distance(&fast, &plain).sqrt();
                        let image =
                            samples[i].image(&x[i]).iter().chain(&plain).map(|t| t.length()).fold(0.0, f64::max);
                        let relative = if image > 0.0 { difference / image } else { difference };
                        assert!(
                            relative <= 1e-11,
                            "{name}, sample {seed}, lane {i}: differs by {relative:e} of the size"
                        );
                        worst = worst.max(relative);
                    }
                }
            }
        }
        if count > 0 {
            println!(
                "{name:<22} {count} projections four at once, {left} left to the plain way, worst difference {worst:.1e}"
            );
            assert!(2 * left < count, "{name}: most are left to the plain way");
        }
    }
    for_each_type!(law);
}

#[test]
fn wrong_scalars_are_refused_and_change_nothing() {
    fn law<T: Constraint>() {
        let (rest, _, _) = points(&T::INFO, 3);
        let indices: Vec<u32> = (0..rest.len() as u32).collect();
        let mut set = with_references();
        let new = NewConstraints {
            type_name: T::INFO.name,
            indices: &indices,
            counts: &[indices.len()],
            weights: &[1.0],
            scalars: &[],
            scalar_counts: &[],
        };
        let id = set.add(&rest, new, |_| String::new()).unwrap();
        let before = set.get(id).unwrap().scalars.to_vec();
        let mut refused = |scalars: &[f64], status: Status| {
            let error = set.edit(T::INFO.name, id, scalars).unwrap_err();
            assert_eq!(error.status(), status, "{}: {scalars:?}: {error}", T::INFO.name);
            assert_eq!(set.get(id).unwrap().scalars, before, "{}", T::INFO.name);
        };
        if T::INFO.scalars == Scalars::None {
            refused(&[], Status::InvalidConstraintType);
            refused(&[1.0], Status::InvalidConstraintType);
            return;
        }
        refused(&[&before[..], &[1.0]].concat(), Status::InvalidArgumentLength);
        refused(&before[1..], Status::InvalidArgumentLength);
        for i in 0..before.len() {
            for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut scalars = before.clone();
                scalars[i] = wrong;
                refused(&scalars, Status::InvalidValue);
            }
        }
        let empty =
            if T::INFO.scalars == Scalars::Shapes { Status::InvalidValue } else { Status::InvalidArgumentLength };
        refused(&[], empty);
    }
    for_each_type!(law);
}

/// A set with constraints of two types, each on shapes of `k` points.
fn on_shapes(each: [(&str, &[DVec3], &[u32]); 2], k: usize) -> ConstraintSet {
    let mut set = ConstraintSet::default();
    for (type_name, rest, indices) in each {
        let (counts, scalars) = (vec![k; indices.len() / k], [0.9, 1.05]);
        let new = NewConstraints {
            type_name,
            indices,
            counts: &counts,
            weights: &[1.0],
            scalars: &scalars,
            scalar_counts: &[2],
        };
        set.add(rest, new, |i| i.to_string()).unwrap();
    }
    set
}

#[test]
fn types_on_the_same_shapes_are_projected_together_as_each_alone() {
    let mut stream = Stream(11);
    for (types, k) in [(["TriangleStrain", "Area"], 3), (["TetrahedronStrain", "Volume"], 4)] {
        // Two fours and three more; one shape is flat at rest, one collapses.
        let rest = {
            let mut rest = stream.vectors(11 * k);
            rest[2] = rest[1];
            rest
        };
        let indices: Vec<u32> = (0..rest.len() as u32).collect();
        let set = on_shapes(types.map(|name| (name, &rest[..], &indices[..])), k);
        let mut x: Vec<DVec3> = rest.iter().map(|point| *point + 0.3 * stream.vector()).collect();
        x[6 * k + 1] = x[6 * k];
        let pairs: Vec<_> = set.pairs().collect();
        let [(both, project)] = pairs.as_slice() else { panic!("{types:?}: {} pairs", pairs.len()) };
        let batches = both.map(|index| set.batch(index));
        assert_eq!(batches.map(|batch| batch.info().name), types);
        let alone = batches.map(|batch| {
            let mut targets = vec![DVec3::NAN; batch.target_offset(11)];
            batch.project(0..11, &x, &mut targets);
            targets
        });
        let [mut first, mut second] = alone.clone().map(|targets| vec![DVec3::NAN; targets.len()]);
        project(batches, 0..11, &x, [&mut first, &mut second]);
        assert!([first, second] == alone, "{types:?}");
        // Not where the points or the shapes are others.
        let others: Vec<u32> = indices.iter().rev().copied().collect();
        for (other_rest, other_indices) in [(&rest, &others), (&x, &indices)] {
            let set = on_shapes([(types[0], &rest, &indices), (types[1], other_rest, other_indices)], k);
            assert_eq!(set.pairs().count(), 0, "{types:?}");
        }
    }
}

/// What the solver sums while it looks at the energy is `s ‖A x − p‖²` as the rows say.
#[test]
fn squared_residuals_are_those_of_the_rows() {
    fn law<T: Constraint>() {
        let info = T::INFO;
        for seed in 0..20 {
            let (rest, x, mut stream) = points(&info, seed);
            let (k, count) = (rest.len(), 7);
            // Two more constraints than fours hold, each on points of its own near the same shape.
            let copies = |points: &[DVec3], stream: &mut Stream| -> Vec<DVec3> {
                (0..count * k).map(|i| points[i % k] + 0.1 * stream.vector()).collect()
            };
            let (rest, x) = (copies(&rest, &mut stream), copies(&x, &mut stream));
            let indices: Vec<u32> = (0..(count * k) as u32).collect();
            let mut set = with_references();
            let counts = vec![k; count];
            let new = NewConstraints {
                type_name: info.name,
                indices: &indices,
                counts: &counts,
                weights: &[1.0],
                scalars: &[],
                scalar_counts: &[],
            };
            set.add(&rest, new, |i| i.to_string()).unwrap();
            let Some((batch, _)) = set.batches().find(|(batch, _)| batch.len() > 0) else { panic!("{}", info.name) };
            let row_count = batch.target_offset(1);
            let (targets, stiffness) = (stream.vectors(count * row_count), [1.0, 2.0, 0.5, 3.0, 0.0, 1.5, 0.1]);
            let expected: f64 = (0..count)
                .map(|slot| {
                    let x = &x[slot * k..(slot + 1) * k];
                    let sample = Sample::<T>::at_rest(&rest[slot * k..(slot + 1) * k]);
                    stiffness[slot] * squared_distance(&sample.image(x), &targets[slot * row_count..][..row_count])
                })
                .sum();
            let found = batch.squared_residual(0..count, &x, &targets, &stiffness);
            assert!((found - expected).abs() <= 1e-12 * expected, "{}: {found} is not {expected}", info.name);
        }
    }
    for_each_type!(law);
}
