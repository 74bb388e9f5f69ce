//! Parity with libShapeOp 0.1.0: every snapshot of every reference trajectory in `tests/fixtures`.
//!
//! The tolerance of a snapshot is `max(1e-9, 1e4 · sensitivity)` of the input's bounding-box diagonal, where the
//! sensitivity is how far libShapeOp's own answer moves when its input moves by 1e-15.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;
use serde::Deserialize;
use shapeop::problem::{Force, ForceSignature, Signature};
use shapeop::solver::Solver;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fixture {
    name: String,
    mode: String,
    masses: f64,
    damping: f64,
    timestep: f64,
    points: Vec<[f64; 3]>,
    constraints: Vec<Signature>,
    forces: Vec<ForceSignature>,
    events: Vec<Event>,
    iterations_per_solve: u32,
    solves: u32,
    return_codes: BTreeMap<String, i32>,
    expected: BTreeMap<String, Vec<[f64; 3]>>,
    sensitivity_to_1e_minus15_input_noise: BTreeMap<String, f64>,
}

#[derive(Deserialize)]
struct Event {
    before_solve: u32,
    #[serde(flatten)]
    change: Change,
}

#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "camelCase")]
enum Change {
    EditConstraint {
        #[serde(rename = "type")]
        type_name: String,
        id: usize,
        scalars: Vec<f64>,
    },
    EditVertexForce {
        force_id: usize,
        force: [f64; 3],
        id: u32,
    },
    SetDamping {
        value: f64,
    },
    SetTimeStep {
        value: f64,
    },
    Reinit,
}

impl Fixture {
    fn init(&self, solver: &mut Solver) {
        match self.mode.as_str() {
            "static" => solver.init(),
            _ => solver.init_dynamic(self.masses, self.damping, self.timestep),
        }
        .unwrap();
    }

    fn apply(&self, change: &Change, solver: &mut Solver) {
        match change {
            Change::EditConstraint { type_name, id, scalars } => solver.edit_constraint(type_name, *id, scalars),
            Change::EditVertexForce { force_id, force, id } => {
                solver.edit_vertex_force(*force_id, (*force).into(), *id)
            }
            Change::SetDamping { value } => solver.set_damping(*value),
            Change::SetTimeStep { value } => solver.set_timestep(*value),
            Change::Reinit => {
                self.init(solver);
                Ok(())
            }
        }
        .unwrap();
    }

    /// Plays the trajectory; returns the largest error of a snapshot over its tolerance, and over the diagonal.
    fn play(&self) -> (f64, f64) {
        let points: Vec<DVec3> = self.points.iter().copied().map(DVec3::from).collect();
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let mut solver = Solver::new();
        solver.set_points(&points).unwrap();
        for (id, signature) in self.constraints.iter().enumerate() {
            let added = solver.add_constraint(&signature.type_name, &signature.indices, signature.weight).unwrap();
            assert_eq!(added, id);
            if let Some(scalars) = &signature.scalars {
                solver.edit_constraint(&signature.type_name, id, scalars).unwrap();
            }
        }
        for signature in &self.forces {
            solver.add_force(Force::from_signature(signature).unwrap()).unwrap();
        }
        assert!(self.return_codes.values().all(|code| *code == 0), "every fixture was solved without an error");
        self.init(&mut solver);
        let (mut worst, mut worst_relative) = (0.0_f64, 0.0_f64);
        for solve in 1..=self.solves {
            for event in self.events.iter().filter(|event| event.before_solve == solve) {
                self.apply(&event.change, &mut solver);
            }
            solver.solve(self.iterations_per_solve).unwrap();
            let key = solve.to_string();
            if let Some(expected) = self.expected.get(&key) {
                let distance = |(a, b): (&DVec3, &[f64; 3])| (*a - DVec3::from(*b)).abs().max_element();
                let error = solver.points().iter().zip(expected).map(distance).fold(0.0, f64::max) / low.distance(high);
                let tolerance = (1e4 * self.sensitivity_to_1e_minus15_input_noise[&key]).max(1e-9);
                worst = worst.max(error / tolerance);
                worst_relative = worst_relative.max(error);
            }
        }
        (worst, worst_relative)
    }
}

#[test]
fn every_reference_trajectory_is_met() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    let (mut count, mut failed) = (0, Vec::new());
    for file in &files {
        let fixtures: Vec<Fixture> = serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap();
        let (mut worst, mut worst_relative) = (0.0_f64, 0.0_f64);
        for fixture in &fixtures {
            let (of_tolerance, relative) = fixture.play();
            if !(of_tolerance <= 1.0) {
                failed.push(format!("{} ({of_tolerance:.1e} of its tolerance)", fixture.name));
            }
            worst = worst.max(of_tolerance);
            worst_relative = worst_relative.max(relative);
        }
        count += fixtures.len();
        let name = file.file_stem().unwrap().to_string_lossy();
        println!(
            "parity {name:<22} {:>3} fixtures, worst {worst_relative:.1e} of the diagonal, {worst:.1e} of tolerance",
            fixtures.len()
        );
    }
    println!("parity: {count} fixtures");
    assert_eq!(count, 149);
    assert!(failed.is_empty(), "{} fixtures differ: {}", failed.len(), failed.join(", "));
}
