//! The JSON form: what is written is read back, and what errs is refused with its place.

use proptest::prelude::*;
use shapeop::error::Status;
use shapeop::problem::{Edit, ForceKind, ForceSignature, Mode, Problem, Reference, Signature};

fn sample() -> Problem {
    Problem {
        mode: Mode::Dynamic,
        timestep: 0.1,
        points: vec![[0.0; 3], [1.0, 0.1 + 0.2, -1e-300], [0.0, 1.0, 0.0], [f64::MAX, 0.0, 5e-324]],
        constraints: vec![
            Signature { type_name: "Plane".into(), indices: vec![0, 1, 2], weight: 2.5, scalars: None, hard: false },
            Signature {
                type_name: "Closeness".into(),
                indices: vec![1],
                weight: 1.0,
                scalars: Some(vec![1.0, 2.0, 3.0]),
                hard: false,
            },
            Signature {
                type_name: "OnMesh".into(),
                indices: vec![2],
                weight: 1.0,
                scalars: Some(vec![1.0]),
                hard: false,
            },
        ],
        forces: vec![
            ForceSignature {
                kind: ForceKind::Gravity,
                force: Some([0.0, 0.0, -9.81]),
                id: None,
                magnitude: None,
                faces: Vec::new(),
            },
            ForceSignature {
                kind: ForceKind::Pressure,
                force: None,
                id: None,
                magnitude: Some(0.1 + 0.2),
                faces: vec![vec![0, 1, 2]],
            },
            ForceSignature {
                kind: ForceKind::Vertex,
                force: Some([1.0, 0.0, 0.0]),
                id: Some(2),
                magnitude: None,
                faces: Vec::new(),
            },
        ],
        references: vec![
            Reference::Polyline { points: vec![[0.0; 3], [0.1, 0.2, 0.3]], closed: true },
            Reference::Mesh { points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 5e-324, 0.1]], triangles: vec![[0, 1, 2]] },
        ],
        edits: vec![Edit { before_step: 2, constraint: 1, scalars: vec![0.0, 0.5, -1.0] }],
        faces: vec![vec![0, 1, 2]],
        edges: vec![[0, 1]],
        ..Problem::default()
    }
}

#[test]
fn what_is_written_is_read_back_to_the_last_bit() {
    let mut problem = sample();
    problem.extra.insert("author".into(), "anyone".into());
    let text = problem.to_json();
    assert_eq!(Problem::from_json(&text).unwrap(), problem);
    assert_eq!(Problem::from_json(&text).unwrap().to_json(), text);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_finite_number_is_read_back_to_the_last_bit(bits in prop::collection::vec(any::<u64>(), 3..60)) {
        let numbers: Vec<f64> = bits.into_iter().map(f64::from_bits).filter(|number| number.is_finite()).collect();
        let points: Vec<[f64; 3]> = numbers.chunks_exact(3).map(|chunk| [chunk[0], chunk[1], chunk[2]]).collect();
        let back = Problem::from_json(&Problem { points: points.clone(), ..Problem::default() }.to_json()).unwrap();
        let bits = |points: &[[f64; 3]]| points.iter().flatten().map(|number| number.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&back.points), bits(&points));
    }
}

#[test]
fn points_alone_are_a_problem() {
    let problem = Problem::from_json(r#"{"version": 1, "points": [[0, 0, 0]]}"#).unwrap();
    assert_eq!((problem.mode, problem.masses, problem.settings.max_iterations), (Mode::Static, 1.0, 1000));
}

#[test]
fn what_errs_is_refused_with_its_place() {
    let points = r#""version": 1, "points": [[0,0,0],[1,0,0],[0,1,0]]"#;
    let closeness = r#""constraints": [{"type": "Closeness", "indices": [0]}]"#;
    let cases = [
        (
            format!(r#"{{{points}, "constraints": [{{"type": "Plane", "indices": [0, 1, 5000]}}]}}"#),
            "constraints[0].indices[2]: 5000 is out of range for 3 points",
            Status::IndexOutOfRange,
        ),
        (
            format!(r#"{{{points}, "constraints": [{{"type": "Plain", "indices": [0, 1, 2]}}]}}"#),
            "constraints[0].type: \"Plain\" is not one of",
            Status::InvalidConstraintType,
        ),
        (
            format!(r#"{{{points}, "constraints": [{{"type": "Plane", "indices": [0, 1]}}]}}"#),
            "constraints[0].indices: expected at least 3",
            Status::InvalidArgumentLength,
        ),
        (
            format!(r#"{{{points}, "constraints": [{{"type": "Plane", "indices": [0, 1, -2]}}]}}"#),
            "constraints[0].indices[2]: invalid value: integer `-2`",
            Status::InvalidInput,
        ),
        (
            format!(r#"{{{points}, "constraints": [{{"type": "Plane", "indices": [0, 1, 2], "wieght": 2}}]}}"#),
            "constraints[0].wieght: unknown field `wieght`",
            Status::InvalidInput,
        ),
        (
            format!(r#"{{{points}, "constraints": [{{"type": "Plane", "indices": [0, 1, 2], "weight": -2}}]}}"#),
            "constraints[0].weight: expected at least 0, found -2",
            Status::InvalidValue,
        ),
        (
            format!(
                r#"{{{points}, "constraints": [{{"type": "EdgeStrain", "indices": [0, 1], "scalars": [0, 1, 1]}}]}}"#
            ),
            "constraints[0].scalars.length: expected a number above 0, found 0",
            Status::InvalidValue,
        ),
        (
            format!(r#"{{{points}, "constraints": [{{"type": "EdgeStrain", "indices": [0, 1], "scalars": [1, 1]}}]}}"#),
            "constraints[0].scalars: expected 3",
            Status::InvalidArgumentLength,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "vertex", "force": [0, 0, 1], "id": 9}}]}}"#),
            "forces[0].id: 9 is out of range for 3 points",
            Status::IndexOutOfRange,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "vertex", "force": [0, 0, 1]}}]}}"#),
            "forces[0].id: expected the index of the point",
            Status::InvalidValue,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "pressure", "magnitude": 2}}]}}"#),
            "forces[0].faces: expected at least one face, found none",
            Status::InvalidArgumentLength,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "normal", "faces": [[0, 1, 2]]}}]}}"#),
            "forces[0].magnitude: expected a number, found none",
            Status::InvalidValue,
        ),
        (
            format!(
                r#"{{{points}, "forces": [{{"kind": "pressure", "magnitude": 2, "faces": [[0, 1, 2], [0, 1, 3]]}}]}}"#
            ),
            "forces[0].faces[1][2]: 3 is out of range for 3 points",
            Status::IndexOutOfRange,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "normal", "magnitude": 2, "faces": [[0, 1]]}}]}}"#),
            "forces[0].faces[0]: expected a face of at least 3 corners, found 2",
            Status::InvalidArgumentLength,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "pressure", "force": [0, 0, 1], "faces": [[0, 1, 2]]}}]}}"#),
            "forces[0].force: expected none for a force of kind \"pressure\", which has a magnitude",
            Status::InvalidValue,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "normal", "magnitude": 2, "id": 1, "faces": [[0, 1, 2]]}}]}}"#),
            "forces[0].id: expected none for a force of kind \"normal\", found 1",
            Status::InvalidValue,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "gravity", "magnitude": 2}}]}}"#),
            "forces[0].magnitude: expected none for a force of kind \"gravity\", which has a force; found 2",
            Status::InvalidValue,
        ),
        (
            format!(
                r#"{{{points}, "forces": [{{"kind": "vertex", "force": [0, 0, 1], "id": 0, "faces": [[0, 1, 2]]}}]}}"#
            ),
            "forces[0].faces: expected none for a force of kind \"vertex\", found 1",
            Status::InvalidValue,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "gravity"}}]}}"#),
            "forces[0].force: expected its components [x, y, z], found none",
            Status::InvalidValue,
        ),
        (
            format!(r#"{{{points}, "references": [{{"polyline": {{"points": [[0, 0, 0]]}}}}]}}"#),
            "references[0].polyline.points: expected at least 2, found 1",
            Status::InvalidArgumentLength,
        ),
        (
            format!(
                r#"{{{points}, "references": [{{"mesh": {{"points": [[0, 0, 0]], "triangles": [[0, 0, 0], [0, 0, 1]]}}}}]}}"#
            ),
            "references[0].mesh.triangles[1][2]: 1 is out of range for 1 points",
            Status::IndexOutOfRange,
        ),
        (
            format!(r#"{{{points}, "references": [{{"polyline": {{"points": [[0, 0, 0]], "is_closed": true}}}}]}}"#),
            "references[0].polyline.is_closed: unknown field `is_closed`",
            Status::InvalidInput,
        ),
        (
            format!(r#"{{{points}, "constraints": [{{"type": "OnMesh", "indices": [0]}}]}}"#),
            "constraints[0].scalars[0]: expected the id of a mesh, found none among 0 references",
            Status::InvalidValue,
        ),
        (
            format!(r#"{{{points}, "forces": [{{"kind": "wind", "force": [0, 0, 1]}}]}}"#),
            "forces[0].kind: unknown variant `wind`",
            Status::InvalidInput,
        ),
        (
            format!(r#"{{{points}, "faces": [[0, 1, 2], [0, 1, 3]]}}"#),
            "faces[1][2]: 3 is out of range for 3 points",
            Status::IndexOutOfRange,
        ),
        (
            format!(
                r#"{{{points}, "mode": "dynamic", "edits": [{{"before_step": 1, "constraint": 0, "scalars": []}}]}}"#
            ),
            "edits[0].constraint: 0 is out of range for 0 constraints",
            Status::IndexOutOfRange,
        ),
        (
            format!(
                r#"{{{points}, {closeness}, "edits": [{{"before_step": 1, "constraint": 0, "scalars": [0,0,0]}}]}}"#
            ),
            "edits[0]: edits are made between time steps: expected mode \"dynamic\", found \"static\"",
            Status::InvalidValue,
        ),
        (
            format!(
                r#"{{{points}, "mode": "dynamic", {closeness}, "edits": [{{"before_step": 0, "constraint": 0, "scalars": [0,0,0]}}]}}"#
            ),
            "edits[0].before_step: steps count from 1, found 0",
            Status::InvalidValue,
        ),
        (
            format!(
                r#"{{{points}, "mode": "dynamic", {closeness}, "edits": [{{"before_step": 1, "constraint": 0, "scalars": [0,0]}}]}}"#
            ),
            "edits[0].scalars: expected 3 for \"Closeness\"",
            Status::InvalidArgumentLength,
        ),
        (format!(r#"{{{points}, "masses": 0}}"#), "masses: expected a number above 0, found 0", Status::InvalidValue),
        (
            format!(r#"{{{points}, "settings": {{"tolerance": -1}}}}"#),
            "settings.tolerance: expected at least 0",
            Status::InvalidValue,
        ),
        (r#"{"version": 2, "points": []}"#.into(), "version: expected 1, found 2", Status::InvalidValue),
        (r#"{"version": 1, "points": [[0,0]]}"#.into(), "points[0]: invalid length 2", Status::InvalidInput),
        (
            r#"{"version": 1, "points": [[0,0,1e999]]}"#.into(),
            "points[0][2]: number out of range",
            Status::InvalidInput,
        ),
        (r#"{"version": 1, "points": []} trailing"#.into(), "trailing characters at line 1", Status::InvalidInput),
        (r#"{"points": []}"#.into(), "missing field `version`", Status::InvalidInput),
    ];
    for (text, expected, status) in cases {
        let error = Problem::from_json(&text).unwrap_err();
        assert!(error.to_string().starts_with(expected), "{text}\n  gave     {error}\n  expected {expected}");
        assert_eq!(error.status(), status, "{text}");
    }
}
