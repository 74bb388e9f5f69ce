//! Laws of the whole solver on random models: the energy falls, and the answer moves with the model.
//!
//! A model is a lattice with noise, held by a few Closeness constraints, with constraints of random types on its edges,
//! triangles, quads, tetrahedra and lines. Seeds are fixed by proptest's deterministic generator and printed on failure.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use glam::{DQuat, DVec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use shapeop::constraints::{Projection, TypeInfo, types};
use shapeop::problem::{Acceleration, Force, Reference};
use shapeop::solver::{SolveOptions, Solver};

/// The lattice's numbers of points.
const SIDES: [u32; 3] = [4, 3, 3];

/// A fixed stream of numbers in `[0, 1)`.
struct Stream(u64);

impl Stream {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next()) - 0.5
    }
}

#[derive(Clone)]
struct Stated {
    info: &'static TypeInfo,
    indices: Vec<u32>,
    weight: f64,
    scalars: Option<Vec<f64>>,
}

#[derive(Clone)]
struct Model {
    /// Points of the polyline and of the mesh that constraints may refer to.
    reference: Vec<DVec3>,
    rest: Vec<DVec3>,
    points: Vec<DVec3>,
    constraints: Vec<Stated>,
    force: DVec3,
}

fn index(at: [u32; 3]) -> u32 {
    (at[2] * SIDES[1] + at[1]) * SIDES[0] + at[0]
}

/// Some points of one lattice cell (or line) that suit a type.
fn indices_for(info: &TypeInfo, stream: &mut Stream) -> Vec<u32> {
    let cell: [u32; 3] = std::array::from_fn(|axis| stream.below(SIDES[axis] as usize - 1) as u32);
    let corner = |x: u32, y: u32, z: u32| index([cell[0] + x, cell[1] + y, cell[2] + z]);
    let solid = [corner(0, 0, 0), corner(1, 0, 0), corner(0, 1, 0), corner(0, 0, 1)];
    let quad = [corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0)];
    match info.name {
        "Bending" => vec![quad[0], quad[2], quad[1], quad[3]],
        "Sphere" => (0..8).map(|i| corner(i & 1, i >> 1 & 1, i >> 2)).collect(),
        "Line" => (0..SIDES[0]).map(|x| index([x, cell[1], cell[2]])).collect(),
        _ if info.name.starts_with("Tetrahedron") || info.name == "Volume" => solid.to_vec(),
        _ => quad[..info.greatest_indices.unwrap_or(4).min(4)].to_vec(),
    }
}

/// Scalars other than the defaults, for the types that have a range.
fn scalars_for(info: &TypeInfo, stream: &mut Stream) -> Option<Vec<f64>> {
    let (low, high) = (0.7 + 0.3 * stream.next(), 1.0 + 0.3 * stream.next());
    match info.name {
        "TriangleStrain" | "TetrahedronStrain" | "Area" | "Volume" => Some(vec![low, high]),
        "EdgeStrain" => Some(vec![0.9 + 0.3 * stream.next(), low, high]),
        "Angle" | "BoundedAngle" => Some(vec![low, 1.5 + 0.5 * high]),
        // A point of the lattice and a direction.
        "OnPlane" | "OnLine" => {
            let (point, direction) = (2.0 * DVec3::ONE + stream.vector(), stream.vector());
            Some([point, direction].iter().flat_map(DVec3::to_array).collect())
        }
        _ => None,
    }
}

/// A model whose points start up to about `spread` from where they are at rest.
fn model(seed: u64, spread: f64, is_chosen: impl Fn(&TypeInfo) -> bool) -> Model {
    let mut stream = Stream(seed);
    let mut rest = Vec::new();
    for z in 0..SIDES[2] {
        for y in 0..SIDES[1] {
            for x in 0..SIDES[0] {
                rest.push(DVec3::new(f64::from(x), f64::from(y), f64::from(z)) + 0.4 * stream.vector());
            }
        }
    }
    let points = rest.iter().map(|point| *point + spread * stream.vector()).collect();
    let chosen: Vec<_> = types().filter(|info| is_chosen(info)).collect();
    let mut constraints = Vec::new();
    for info in types().filter(|info| info.name == "Closeness") {
        for i in 0..rest.len() as u32 {
            constraints.push(Stated { info, indices: vec![i], weight: 0.02 + 0.2 * stream.next(), scalars: None });
        }
    }
    for _ in 0..40 {
        let info = chosen[stream.below(chosen.len())];
        let (indices, scalars) = (indices_for(info, &mut stream), scalars_for(info, &mut stream));
        constraints.push(Stated { info, indices, weight: 0.1 + stream.next(), scalars });
    }
    let force = 0.05 * stream.vector();
    let reference = (0..9).map(|i| DVec3::splat(f64::from(i) / 3.0) + stream.vector()).collect();
    Model { reference, rest, points, constraints, force }
}

impl Model {
    fn solver(&self, is_dynamic: bool) -> Solver {
        let mut solver = Solver::new();
        solver.set_points(&self.rest).unwrap();
        let points: Vec<[f64; 3]> = self.reference.iter().map(DVec3::to_array).collect();
        let triangles = (0..points.len() as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
        solver.add_reference(&Reference::Polyline { points: points.clone(), closed: true }).unwrap();
        solver.add_reference(&Reference::Mesh { points, triangles }).unwrap();
        for stated in &self.constraints {
            let id = solver.add_constraint(stated.info.name, &stated.indices, stated.weight).unwrap();
            if let Some(scalars) = &stated.scalars {
                solver.edit_constraint(stated.info.name, id, scalars).unwrap();
            }
        }
        solver.add_force(Force::Gravity(self.force)).unwrap();
        solver.set_points(&self.points).unwrap();
        match is_dynamic {
            true => solver.init_dynamic(1.0, 0.9, 0.5).unwrap(),
            false => solver.init().unwrap(),
        }
        solver
    }

    fn solved(&self, is_dynamic: bool) -> Vec<DVec3> {
        let mut solver = self.solver(is_dynamic);
        for _ in 0..3 {
            solver.solve(7).unwrap();
        }
        solver.points().to_vec()
    }

    fn moved(&self, rotation: DQuat, shift: DVec3) -> Self {
        let all = |points: &[DVec3]| points.iter().map(|point| rotation * *point + shift).collect();
        let (reference, rest, points) = (all(&self.reference), all(&self.rest), all(&self.points));
        let mut moved = Self { reference, rest, points, force: rotation * self.force, ..self.clone() };
        for stated in &mut moved.constraints {
            if let ("OnPlane" | "OnLine", Some(scalars)) = (stated.info.name, &mut stated.scalars) {
                let (point, direction) = (DVec3::from_slice(scalars), DVec3::from_slice(&scalars[3..]));
                let there = [rotation * point + shift, rotation * direction];
                *scalars = there.iter().flat_map(DVec3::to_array).collect();
            }
        }
        moved
    }

    /// The same model `s` times as large, with the weights that keep its balance.
    fn scaled(&self, s: f64) -> Self {
        let all = |points: &[DVec3]| points.iter().map(|point| s * *point).collect();
        let (reference, rest, points) = (all(&self.reference), all(&self.rest), all(&self.points));
        let mut scaled = Self { reference, rest, points, force: s * self.force, ..self.clone() };
        for stated in &mut scaled.constraints {
            stated.weight *= s.powi(2 - stated.info.energy_scale_power);
            match (stated.info.name, &mut stated.scalars) {
                ("EdgeStrain", Some(scalars)) => scalars[0] *= s,
                ("OnPlane" | "OnLine", Some(scalars)) => scalars[..3].iter_mut().for_each(|scalar| *scalar *= s),
                _ => {}
            }
        }
        scaled
    }
}

fn largest_difference(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// The lattice's diagonal, near enough.
const DIAGONAL: f64 = 4.1;

fn check(name: &str, cases: u32, law: impl Fn(u64) -> Result<(), TestCaseError>) {
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    runner.run(&any::<u64>(), law).unwrap_or_else(|error| panic!("{name}: {error}"));
}

/// The largest relative rise of the energy in one iteration, over the iterations of one static solve or one time step.
fn largest_rise(model: &Model, is_dynamic: bool, max_iterations: u32, acceleration: Acceleration) -> f64 {
    let mut solver = model.solver(is_dynamic);
    solver.set_acceleration(acceleration, 0).unwrap();
    let mut rise = 0.0_f64;
    let mut last = None;
    let options = SolveOptions { max_iterations, tolerance: 0.0, time_budget_seconds: 0.0 };
    let report = solver
        .solve_until(&options, &mut |progress| {
            // Relative to the size of the terms that the energy is the difference of.
            if let Some(last) = last {
                rise = rise.max(progress.energy - last);
            }
            last = Some(progress.energy);
            ControlFlow::Continue(())
        })
        .unwrap();
    rise / (report.energy_before.abs() + report.energy_after.abs())
}

#[test]
fn the_energy_never_rises_with_nearest_projections() {
    let accelerations = [Acceleration::None, Acceleration::Anderson, Acceleration::QuasiNewton];
    for (is_dynamic, acceleration) in [false, true].into_iter().flat_map(|d| accelerations.map(|a| (d, a))) {
        check("energy", 60, |seed| {
            let model = model(seed, 0.5, |info| info.projection == Projection::Nearest);
            let rise = largest_rise(&model, is_dynamic, 60, acceleration);
            prop_assert!(rise < 1e-13, "seed {seed}: rose by {rise:.1e}, dynamic: {is_dynamic}, {acceleration:?}");
            Ok(())
        });
    }
}

#[test]
fn with_other_projections_the_rise_is_known() {
    let mut rises = BTreeMap::new();
    for info in types().filter(|info| info.projection != Projection::Nearest) {
        let mut worst = 0.0_f64;
        for seed in 0..60 {
            // Without forces, whose fall would hide a rise, and until little else moves.
            let model = Model { force: DVec3::ZERO, ..model(seed, 1.0, |other| other.name == info.name) };
            worst = worst.max(largest_rise(&model, false, 400, Acceleration::None));
        }
        rises.insert(info.name, worst);
    }
    for (name, rise) in &rises {
        println!("energy: largest relative rise in one iteration with {name:<15} {rise:.1e}");
        assert!(*rise < 1e-6, "{name}: {rise}");
    }
}

#[test]
fn the_answer_turns_with_the_model() {
    for is_dynamic in [false, true] {
        check("rigid motion", 30, |seed| {
            let (model, mut stream) = (model(seed, 0.5, |_| true), Stream(seed ^ 0x5555));
            let rotation = DQuat::from_scaled_axis(6.0 * stream.vector());
            let shift = 20.0 * stream.vector();
            let turned: Vec<_> = model.solved(is_dynamic).iter().map(|point| rotation * *point + shift).collect();
            let difference = largest_difference(&model.moved(rotation, shift).solved(is_dynamic), &turned) / DIAGONAL;
            prop_assert!(difference < 1e-9, "seed {seed}: differs by {difference:.1e} of the diagonal");
            Ok(())
        });
    }
}

#[test]
fn the_answer_scales_with_the_model() {
    for s in [1e-6, 1e-3, 1e3, 1e6] {
        check("scale", 15, |seed| {
            let model = model(seed, 0.5, |_| true);
            let grown: Vec<_> = model.solved(false).iter().map(|point| s * *point).collect();
            let difference = largest_difference(&model.scaled(s).solved(false), &grown) / (s * DIAGONAL);
            prop_assert!(difference < 1e-9, "seed {seed}, scale {s}: differs by {difference:.1e} of the diagonal");
            Ok(())
        });
    }
}

#[test]
fn the_order_of_constraints_does_not_matter() {
    check("order", 30, |seed| {
        let model = model(seed, 0.5, |_| true);
        let mut shuffled = model.clone();
        let mut stream = Stream(!seed);
        for i in (1..shuffled.constraints.len()).rev() {
            shuffled.constraints.swap(i, stream.below(i + 1));
        }
        let difference = largest_difference(&model.solved(false), &shuffled.solved(false)) / DIAGONAL;
        prop_assert!(difference < 1e-9, "seed {seed}: differs by {difference:.1e} of the diagonal");
        Ok(())
    });
}
