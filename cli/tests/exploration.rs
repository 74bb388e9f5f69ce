//! Hard constraints, handles and drags as a user meets them: what is written is measured again from its coordinates.

mod program;

use glam::DVec3;
use serde_json::{Value, json as value};
use shapeop::mesh::measure::{self, Spread};
use shapeop::mesh::{Mesh, file};

use program::{Folder, example, json, mesh_path, png_size, refused, said, shapeop, shapeop_into};

const FRAMES: usize = 12;

fn plane_distance(mesh: &Mesh) -> f64 {
    Spread::of(&measure::of_faces(mesh, measure::plane_distance).unwrap()).max
}

fn mean_edge(mesh: &Mesh) -> f64 {
    Spread::of(&measure::edge_lengths(mesh).unwrap()).mean
}

fn largest_move(a: &Mesh, b: &Mesh) -> f64 {
    Spread::of(&measure::displacements(&a.points, &b.points).unwrap()).max
}

/// Replays the drag of the example on a problem; returns the folder.
fn explored(name: &str, problem: &Value, more: &[&str]) -> (Folder, String) {
    let folder = Folder::new(name);
    let path = folder.write("roof.json", &problem.to_string());
    let moves = example("explore_moves.json");
    let text = said(&shapeop_into(&folder, &[&["explore", &path, "--handles", &moves], more].concat()));
    (folder, text)
}

fn example_problem() -> Value {
    json(example("explore.json").as_ref())
}

#[test]
fn a_drag_is_replayed_and_every_frame_is_planar() {
    let (folder, text) = explored("explore", &example_problem(), &[]);
    let frames: Vec<String> = (0..FRAMES).map(|i| format!("roof.explore.frame-{i:03}.obj")).collect();
    let others = [".distance.png", ".json", ".obj", ".png"].map(|ending| format!("roof.explore{ending}"));
    let mut expected = [vec!["roof.json".to_owned()], frames.clone(), others.to_vec()].concat();
    expected.sort();
    assert_eq!(folder.files(), expected);
    let start = Mesh {
        points: serde_json::from_value(example_problem()["points"].clone()).map(points).unwrap(),
        faces: serde_json::from_value(example_problem()["faces"].clone()).unwrap(),
    };
    let report = json(&folder.path("roof.explore.json"));
    let end = file::read(folder.path("roof.explore.obj")).unwrap();
    let solved = report["frames"].as_array().unwrap();
    assert_eq!(solved.len(), FRAMES);
    let whole = distance(&start, &end);
    for (name, told) in frames.iter().zip(solved) {
        let mesh = file::read(folder.path(name)).unwrap();
        assert_eq!(mesh.faces, start.faces);
        assert!(plane_distance(&mesh) < 1e-7, "{name}: {:e}", plane_distance(&mesh));
        assert_eq!((&told["outcome"], &told["is_solution"]), (&value!("converged"), &value!(true)), "{name}");
        assert!(told["mesh"].as_str().unwrap().ends_with(name));
        // The plot has the distance that the mesh has.
        let at = told["at_seconds"].as_f64().unwrap();
        let plotted = report["distance"].as_array().unwrap().iter().find(|pair| pair[0].as_f64() == Some(at));
        if let Some(pair) = plotted {
            assert!((pair[1].as_f64().unwrap() - distance(&mesh, &end) / whole).abs() < 1e-9, "{name}");
        }
    }
    assert!(solved[FRAMES - 2]["handles"] == 5 && solved[FRAMES - 1]["handles"] == 4, "one is released");
    assert_eq!(report["outcome"], "converged");
    assert_eq!(
        report["constraints"],
        value!({
            "Plane": {"hard": 144, "soft": 0}, "RegularPolygon": {"hard": 0, "soft": 144}
        })
    );
    let distances = report["distance"].as_array().unwrap();
    assert!(distances[0] == value!([0.0, 1.0]) && distances[distances.len() - 1][1] == 0.0);
    for picture in [".png", ".distance.png"] {
        let (width, height) = png_size(&folder.path(&format!("roof.explore{picture}")));
        assert!(width >= 1280 && height >= 480);
    }
    for part in ["144 Plane (hard)", "12 frames", "twice the weight of", "RegularPolygon", "frame-000.obj … "] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
}

fn points(list: Vec<[f64; 3]>) -> Vec<DVec3> {
    list.into_iter().map(DVec3::from).collect()
}

fn distance(a: &Mesh, b: &Mesh) -> f64 {
    a.points.iter().zip(&b.points).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt()
}

/// What the table says of twice a weight is what twice the weight does, as far as a straight line can tell.
#[test]
fn the_table_of_weights_predicts_what_they_do() {
    let run = |name: &str, problem: &Value| {
        let (folder, _) = explored(name, problem, &["--picture", "none"]);
        (json(&folder.path("roof.explore.json")), file::read(folder.path("roof.explore.obj")).unwrap())
    };
    let problem = example_problem();
    let (report, mesh) = run("weights", &problem);
    let told = |class: usize| &report["sensitivities"]["doubled"][class];
    assert_eq!(report["sensitivities"]["classes"], value!(["handles", "closeness", "fairness", "RegularPolygon"]));
    let predicted = |class: usize| told(class)["largest_move"].as_f64().unwrap();

    let mut heavier = problem.clone();
    for constraint in heavier["constraints"].as_array_mut().unwrap() {
        if constraint["type"] == "RegularPolygon" {
            constraint["weight"] = value!(2.0 * constraint["weight"].as_f64().unwrap());
        }
    }
    let (_, moved) = run("weights-soft", &heavier);
    // A weak wish moves points in proportion to its weight: twice it by as much again, of which a straight line in the logarithm
    // makes ln 2.
    let share = largest_move(&mesh, &moved) / predicted(3);
    assert!((share - 1.0 / std::f64::consts::LN_2).abs() < 0.15, "soft: {share}");

    heavier = problem.clone();
    heavier["objective"]["handle_weight"] = value!(2.0 * problem["objective"]["handle_weight"].as_f64().unwrap());
    let (_, moved) = run("weights-handles", &heavier);
    // Handles of great weight w are about 1/w off: twice it moves them by a half, of which a straight line makes ln 2.
    let share = largest_move(&mesh, &moved) / predicted(0);
    assert!((share - 0.5 / std::f64::consts::LN_2).abs() < 0.1, "handles: {share}");
    let moves = json(example("explore_moves.json").as_ref());
    let last = &moves["frames"][FRAMES - 2]["handles"][0];
    let held = problem["handles"].as_array().unwrap().iter().filter(|handle| handle["point"] != 0).chain([last]);
    let off = |mesh: &Mesh| {
        let of = |handle: &Value| {
            let target: [f64; 3] = serde_json::from_value(handle["target"].clone()).unwrap();
            mesh.points[handle["point"].as_u64().unwrap() as usize].distance_squared(target.into())
        };
        held.clone().map(of).sum::<f64>()
    };
    let change = off(&moved) / off(&mesh) - 1.0;
    assert!((told(0)["changes"][0].as_f64().unwrap() - change).abs() < 0.02, "{} {change}", told(0)["changes"][0]);
}

#[test]
fn a_drag_faster_than_the_solver_ends_at_a_solution_too() {
    let (folder, text) = explored("explore-budget", &example_problem(), &["--budget-ms", "0.001", "--picture", "svg"]);
    let report = json(&folder.path("roof.explore.json"));
    for frame in report["frames"].as_array().unwrap() {
        assert!(frame["outcome"] == "time budget" && frame["sweeps"] == 1, "{frame}");
    }
    assert_eq!(report["settled"]["is_solution"], true);
    assert!(plane_distance(&file::read(folder.path("roof.explore.obj")).unwrap()) < 1e-7);
    assert!(text.contains("end") && text.contains("time budget"));
    let picture = std::fs::read_to_string(folder.path("roof.explore.svg")).unwrap();
    for part in ["start", "frame 2", "end", "violation / mean edge", "#0b6fb8"] {
        assert!(picture.contains(part), "{part}");
    }
    let plot = std::fs::read_to_string(folder.path("roof.explore.distance.svg")).unwrap();
    assert!(plot.contains("seconds of solving"));
}

/// A planar grid with every edge within 3 % of its length, and one more edge constraint that asks for half as much again.
fn contradiction() -> Value {
    let n = 5;
    let points: Vec<[f64; 3]> = (0..n * n).map(|i| [f64::from(i % n), f64::from(i / n), 0.0]).collect();
    let at = |x: i32, y: i32| y * n + x;
    let cells = (0..n - 1).flat_map(|y| (0..n - 1).map(move |x| (x, y)));
    let faces: Vec<[i32; 4]> = cells.map(|(x, y)| [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]).collect();
    let all = (0..n).flat_map(|y| (0..n).map(move |x| (x, y)));
    let edges = all.flat_map(|(x, y)| {
        [(x + 1 < n).then(|| [at(x, y), at(x + 1, y)]), (y + 1 < n).then(|| [at(x, y), at(x, y + 1)])]
    });
    let mut constraints: Vec<Value> = edges
        .flatten()
        .map(|edge| value!({"type": "EdgeLength", "indices": edge, "weight": 2, "scalars": [0.97, 1.03], "hard": true}))
        .collect();
    constraints.push(value!({"type": "EdgeLength", "indices": [11, 12], "scalars": [1.5, 1.6], "hard": true}));
    value!({"version": 1, "points": points, "faces": faces, "constraints": constraints})
}

#[test]
fn constraints_that_contradict_each_other_are_named_and_the_exit_code_tells() {
    let folder = Folder::new("contradiction");
    let path = folder.write("net.json", &contradiction().to_string());
    let moves = folder.write("still.json", r#"{"version": 1, "frames": [{}]}"#);
    for (command, more) in [("solve", &[][..]), ("explore", &["--handles", &moves])] {
        let output = shapeop_into(&folder, &[&[command, &path], more].concat());
        assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8(output.stdout).unwrap();
        for part in ["One of them stands against the others", "EdgeLength", "11 12", "\"hard\": false"] {
            assert!(text.contains(part), "{part} is not in\n{text}");
        }
        let report = json(&folder.path(&format!("net.{command}.json")));
        assert_eq!(report["outcome"], "infeasible");
        let found = if command == "solve" { &report["exploration"] } else { &report };
        let conflicts = found["conflicts"].as_array().unwrap();
        assert_eq!(
            (conflicts.len(), &conflicts[0]["constraint"], &conflicts[0]["type"]),
            (1, &value!(40), &value!("EdgeLength"))
        );
        // All other edges of what was written are as long as they should be.
        let mesh = file::read(folder.path(&format!("net.{command}.obj"))).unwrap();
        let lengths = measure::edge_lengths(&mesh).unwrap();
        assert_eq!(lengths.len(), 40);
        assert!(lengths.iter().all(|length| (0.969..1.031).contains(length)), "{lengths:?}");
    }
}

#[test]
fn what_solve_found_with_hard_constraints_is_in_its_report() {
    let folder = Folder::new("solve-hard");
    let text = said(&shapeop_into(&folder, &["solve", &example("explore.json"), "--picture", "svg"]));
    assert!(text.contains("144 Plane (hard)") && text.contains("objective"), "{text}");
    let report = json(&folder.path("explore.solve.json"));
    assert_eq!(report["hard_constraints"], value!({"Plane": 144}));
    let found = &report["exploration"];
    assert!(found["is_solution"] == true && found["conflicts"] == value!([]));
    let mesh = file::read(folder.path("explore.solve.obj")).unwrap();
    assert!(plane_distance(&mesh) <= found["largest_violation"].as_f64().unwrap() + 1e-14);
    let objective: f64 = found["objective"].as_object().unwrap().values().map(|term| term.as_f64().unwrap()).sum();
    assert!((report["energy"]["after"].as_f64().unwrap() - objective).abs() < 1e-12);
    let plain = Folder::new("solve-soft");
    said(&shapeop_into(&plain, &["solve", &example("circularize.json"), "--picture", "none"]));
    assert!(json(&plain.path("circularize.solve.json"))["exploration"].is_null());
}

#[test]
fn a_mesh_is_rationalised_exactly() {
    let path = mesh_path("tubemesh.obj");
    let before = file::read(&path).unwrap();
    let folder = Folder::new("rationalize");
    let text = said(&shapeop_into(&folder, &["rationalize", &path, "--anchors", "corners"]));
    assert!(text.contains("171 Plane (hard)"));
    let stem = "tubemesh.rationalize";
    assert_eq!(folder.files(), [".convergence.png", ".json", ".obj", ".png"].map(|ending| format!("{stem}{ending}")));
    let after = file::read(folder.path(&format!("{stem}.obj"))).unwrap();
    assert!(plane_distance(&after) < 2e-9 * before.diagonal(), "{:e}", plane_distance(&after));
    let report = json(&folder.path(&format!("{stem}.json")));
    assert!(report["exploration"]["is_solution"] == true && report["options"]["diagonals"].is_null());

    said(&shapeop_into(&folder, &["rationalize", &path, "--diagonals", "1", "--picture", "none"]));
    let after = file::read(folder.path(&format!("{stem}.obj"))).unwrap();
    let apart = after.faces.iter().map(|face| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| after.points[face[i] as usize]);
        (c - a).cross(d - b).normalize().dot(b - a).abs()
    });
    let bound = 0.01 * mean_edge(&before);
    let largest = apart.fold(0.0, f64::max);
    assert!((largest - bound).abs() < 2e-9 * before.diagonal(), "{largest} against {bound}");
    let length = json(&folder.path(&format!("{stem}.json")))["options"]["length"].as_f64().unwrap();
    assert!((length - bound).abs() < 1e-12);
}

#[test]
fn what_is_wrong_with_a_drag_is_named_by_frame_and_field() {
    let folder = Folder::new("wrong-drag");
    let out = Folder::new("wrong-drag-out");
    let problem = example("explore.json");
    let frames = |name: &str, text: &str| folder.write(name, &format!(r#"{{"version": 1, "frames": [{text}]}}"#));
    let far = frames("far.json", r#"{}, {"handles": [{"point": 169, "target": [0, 0, 0]}]}"#);
    let free = frames("free.json", r#"{"releases": [84]}"#);
    let word = frames("word.json", r#"{"handles": [{"point": 1, "target": [0, 0, "up"]}]}"#);
    let none = folder.write("none.json", r#"{"version": 1, "frames": []}"#);
    let good = frames("good.json", "{}");
    let idle = folder.write("idle.json", r#"{"version": 1, "points": [[0, 0, 0]]}"#);
    let cloth = example("hanging_cloth.json");
    let cases = [
        (&problem, &far, "far.json: frames[1].handles[0].point: 169 is out of range for 169 points"),
        (&problem, &free, "free.json: frames[0].releases[0]: point 84 is no handle at this frame"),
        (&problem, &word, "word.json: frames[0].handles[0].target[2]: invalid type: string \"up\""),
        (&problem, &none, "none.json: frames: expected at least one frame, found none"),
        (&idle, &good, "idle.json: expected a hard constraint, a handle or an objective"),
        (&cloth, &good, "hanging_cloth.json: mode: expected \"static\", found \"dynamic\""),
    ];
    for (problem, moves, expected) in cases {
        let stderr = refused(&shapeop_into(&out, &["explore", problem, "--handles", moves]), 1);
        assert!(stderr.starts_with("error: ") && stderr.contains(expected), "{stderr}");
    }
    assert!(out.files().is_empty(), "{:?}", out.files());
    let huge = frames("huge.json", r#"{}, {"handles": [{"point": 84, "target": [0, 0, 1e308]}]}"#);
    let stderr = refused(&shapeop_into(&folder, &["explore", &problem, "--handles", &huge]), 1);
    assert!(stderr.contains("explore.json: frames[1]: coordinates, forces or weights are so large"), "{stderr}");
    assert!(refused(&shapeop(&["explore", &problem, "--handles", "no.json"]), 1).contains("no.json: cannot be read"));
    let usage = refused(&shapeop(&["explore", &problem, "--handles", &good, "--budget-ms", "-1"]), 2);
    assert!(usage.contains("expected a number of at least 0"), "{usage}");
    let mesh = mesh_path("tubemesh.obj");
    let stderr = refused(&shapeop_into(&out, &["rationalize", &mesh, "--closeness", "0"]), 1);
    assert!(stderr.contains("closeness: expected a number above 0"), "{stderr}");
    refused(&shapeop(&["rationalize", &mesh, "--diagonals", "0"]), 2);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_drag_with_the_frames_that_are_there() {
    use std::time::Duration;

    use program::interrupt;

    const MANY: usize = 20_000;
    let folder = Folder::new("interrupt-drag");
    let out = folder.path("out");
    let moves: Vec<Value> = (0..MANY)
        .map(|i| value!({"handles": [{"point": 84, "target": [0.0, 0.0, 5.0 + 0.3 * (0.1 * i as f64).sin()]}]}))
        .collect();
    let moves = folder.write("long.json", &value!({"version": 1, "frames": moves}).to_string());
    let (problem, folder_out) = (example("explore.json"), out.display().to_string());
    let arguments = ["explore", &problem, "--handles", &moves, "--picture", "none", "--quiet", "-o", &folder_out];
    interrupt(&arguments, Some(&out.join("explore.explore.frame-001.obj")), Duration::ZERO);
    let report = json(&out.join("explore.explore.json"));
    let frames = report["frames"].as_array().unwrap();
    assert!(frames.len() >= 2 && frames.len() < MANY && report["settled"].is_null());
    assert_eq!(
        (&report["outcome"], &frames[frames.len() - 1]["outcome"]),
        (&value!("cancelled"), &value!("cancelled"))
    );
    let last = file::read(out.join(format!("explore.explore.frame-{:03}.obj", frames.len() - 1))).unwrap();
    assert_eq!(file::read(out.join("explore.explore.obj")).unwrap().points, last.points);
}
