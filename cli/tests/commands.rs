//! The program as a user meets it: every command, what it writes, what it says when something is wrong, and Ctrl-C.

mod program;

use std::process::Command;

use glam::DVec3;
use serde_json::Value;
use shapeop::mesh::measure::{self, Spread};
use shapeop::mesh::{Mesh, file};
use shapeop::solver::{BackendOptions, backend_info};

use program::{Folder, assert_close, example, json, mesh_path, png_size, refused, said, shapeop, shapeop_into};

fn planarity(mesh: &Mesh) -> Spread {
    Spread::of(&measure::of_faces(mesh, measure::planarity).unwrap())
}

type Measure = fn(&[DVec3]) -> f64;

/// Every figure of the report that can be taken from the files is taken from them.
#[track_caller]
fn assert_report_is_true(report: &Value, before: &Mesh, after: &Mesh) {
    for (when, mesh) in [("before", before), ("after", after)] {
        let quality = &report["quality"][when];
        let measures: [(&str, Measure); 4] = [
            ("planarity", measure::planarity),
            ("plane_distance", measure::plane_distance),
            ("circularity", measure::circularity),
            ("regularity", measure::regularity),
        ];
        for (name, measure) in measures {
            let spread = Spread::of(&measure::of_faces(mesh, measure).unwrap());
            assert_close(&quality[name]["mean"], spread.mean);
            assert_close(&quality[name]["max"], spread.max);
            assert_eq!(quality[name]["max_at"], spread.max_at);
        }
        let over = measure::of_faces(mesh, measure::planarity).unwrap().iter().filter(|p| **p > 0.003).count();
        assert_eq!(quality["faces_over_limit"], over);
    }
    let moved = Spread::of(&measure::displacements(&before.points, &after.points).unwrap());
    assert_close(&report["displacement"]["absolute"]["mean"], moved.mean);
    assert_close(&report["displacement"]["absolute"]["max"], moved.max);
    let edge = Spread::of(&measure::edge_lengths(before).unwrap()).mean;
    assert_close(&report["displacement"]["max_over_mean_edge"], moved.max / edge);
    let energies = report["history"]["energy"].as_array().unwrap();
    assert_eq!(report["iterations"], energies.len());
    assert_eq!(energies.last(), Some(&report["energy"]["after"]));
    assert_eq!(report["history"]["largest_move"].as_array().unwrap().len(), energies.len());
}

#[test]
fn the_demo_needs_nothing_and_makes_a_mesh_planar() {
    let folder = Folder::new("demo");
    let text = said(&shapeop_into(&folder, &["demo"]));
    for word in ["before", "after", "planarity, mean", "planarity, max", "moved, max", "iterations", "seconds"] {
        assert!(text.contains(word), "{word} is not in\n{text}");
    }
    let files = folder.files();
    let stem = "costa_mesh_free2.planarize";
    assert_eq!(files, [".convergence.png", ".json", ".obj", ".png"].map(|ending| format!("{stem}{ending}")));
    let before = file::read(mesh_path("costa_mesh_free2.obj")).unwrap();
    let after = file::read(folder.path(&format!("{stem}.obj"))).unwrap();
    assert!(planarity(&before).max > 0.03 && planarity(&after).max < 0.003, "{}", planarity(&after).max);
    assert_report_is_true(&json(&folder.path(&format!("{stem}.json"))), &before, &after);
    for picture in [".png", ".convergence.png"] {
        let (width, height) = png_size(&folder.path(&format!("{stem}{picture}")));
        assert!(width >= 1280 && height >= 500);
    }
}

#[test]
fn every_recipe_writes_a_mesh_pictures_and_a_true_report() {
    for (recipe, mesh) in [
        ("planarize", "hypar"),
        ("circularize", "tubemesh"),
        ("smooth", "hex_mesh_welded"),
        ("regularize", "hex_mesh_welded"),
        ("equalize", "tubemesh"),
    ] {
        let folder = Folder::new(recipe);
        let path = mesh_path(&format!("{mesh}.obj"));
        said(&shapeop_into(&folder, &[recipe, &path, "--iterations", "50", "--anchors", "corners"]));
        let stem = format!("{mesh}.{recipe}");
        assert_eq!(
            folder.files(),
            [".convergence.png", ".json", ".obj", ".png"].map(|ending| format!("{stem}{ending}"))
        );
        let before = file::read(&path).unwrap();
        let after = file::read(folder.path(&format!("{stem}.obj"))).unwrap();
        assert_eq!(after.faces, before.faces);
        let report = json(&folder.path(&format!("{stem}.json")));
        assert_report_is_true(&report, &before, &after);
        assert_eq!((&report["version"], &report["command"]), (&Value::from(1), &Value::from(recipe)));
        assert_eq!(report["options"]["anchors"]["corners"], true);
    }
}

#[test]
fn formats_are_as_asked_for_and_quiet_is_quiet() {
    let folder = Folder::new("formats");
    let path = mesh_path("hypar.obj");
    let output = shapeop_into(
        &folder,
        &["planarize", &path, "--format", "ply", "--picture", "svg", "--quiet", "--iterations", "5"],
    );
    assert!(said(&output).is_empty() && output.stderr.is_empty());
    let after = file::read(folder.path("hypar.planarize.ply")).unwrap();
    assert_eq!(after.points.len(), 81);
    for name in ["hypar.planarize.svg", "hypar.planarize.convergence.svg"] {
        let text = std::fs::read_to_string(folder.path(name)).unwrap();
        assert!(text.starts_with("<svg") && text.trim_end().ends_with("</svg>"), "{name}");
        assert!(text.contains("hypar.obj"));
    }
    assert!(std::fs::read_to_string(folder.path("hypar.planarize.svg")).unwrap().contains("tolerance 0.3 %"));
    let none = Folder::new("no-pictures");
    said(&shapeop_into(&none, &["planarize", &path, "--picture", "none", "--iterations", "5"]));
    assert_eq!(none.files(), ["hypar.planarize.json", "hypar.planarize.obj"]);
}

#[test]
fn json_on_standard_output_is_the_report() {
    let folder = Folder::new("json");
    let text = said(&shapeop_into(&folder, &["planarize", &mesh_path("hypar.obj"), "--json", "--iterations", "5"]));
    let printed: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(printed, json(&folder.path("hypar.planarize.json")));
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let folders = ["1", "2"].map(|threads| {
        let folder = Folder::new(&format!("threads-{threads}"));
        let path = mesh_path("costa2k_poly.obj");
        said(&shapeop_into(
            &folder,
            &["planarize", &path, "--threads", threads, "--iterations", "20", "--picture", "none"],
        ));
        folder
    });
    let [one, two] = folders.each_ref().map(|folder| std::fs::read(folder.path("costa2k_poly.planarize.obj")).unwrap());
    assert!(one == two);
}

#[test]
fn acceleration_is_as_asked_for_and_needs_fewer_evaluations() {
    let mesh = mesh_path("hypar.obj");
    let run = |asked: &[&str]| -> Value {
        let folder = Folder::new("acceleration");
        let arguments =
            [&["planarize", &mesh, "--json", "--picture", "none", "--tolerance", "1e-7"][..], asked].concat();
        serde_json::from_str(&said(&shapeop_into(&folder, &arguments))).unwrap()
    };
    let plain = run(&["--acceleration", "none"]);
    assert_eq!(plain["evaluations"], plain["iterations"]);
    assert_eq!(plain["settings"]["acceleration"], "none");
    assert_eq!(run(&[])["settings"]["acceleration"], "automatic");
    for asked in [&[][..], &["--acceleration", "quasi-newton"]] {
        let report = run(asked);
        assert!(report["evaluations"].as_u64() < plain["evaluations"].as_u64(), "{asked:?}: {}", report["evaluations"]);
        assert!(report["energy"]["after"].as_f64() < plain["energy"]["after"].as_f64(), "{asked:?}");
        let rejected = ["energy_rose", "not_finite"].map(|cause| report["rejections"][cause].as_u64().unwrap());
        let evaluations = report["iterations"].as_u64().unwrap() + rejected.iter().sum::<u64>();
        assert_eq!(report["evaluations"].as_u64(), Some(evaluations), "{asked:?}");
    }
}

#[test]
fn problem_files_are_solved_with_pictures() {
    for (name, faces) in [("circularize", 171), ("regularize", 199)] {
        let folder = Folder::new(&format!("solve-{name}"));
        let text = said(&shapeop_into(&folder, &["solve", &example(&format!("{name}.json"))]));
        assert!(text.contains("violation at the end"));
        let stem = format!("{name}.solve");
        assert_eq!(
            folder.files(),
            [".convergence.png", ".json", ".obj", ".png"].map(|ending| format!("{stem}{ending}"))
        );
        let report = json(&folder.path(&format!("{stem}.json")));
        assert_eq!(report["faces"], faces);
        let energy = |when: &str| report["energy"][when].as_f64().unwrap();
        assert!(energy("after") < energy("before"));
    }
}

#[test]
fn a_dynamic_problem_is_solved_step_by_step() {
    let folder = Folder::new("cloth");
    said(&shapeop_into(&folder, &["solve", &example("hanging_cloth.json"), "--picture", "svg"]));
    let report = json(&folder.path("hanging_cloth.solve.json"));
    assert_eq!((&report["mode"], &report["steps"]), (&Value::from("dynamic"), &Value::from(200)));
    let picture = std::fs::read_to_string(folder.path("hanging_cloth.solve.svg")).unwrap();
    for frame in ["start", "step 40", "step 80", "step 120", "step 160", "step 200", "tension", "compression"] {
        assert!(picture.contains(frame), "{frame}");
    }
    let plot = std::fs::read_to_string(folder.path("hanging_cloth.solve.convergence.svg")).unwrap();
    assert!(plot.contains("time step"));
    let short = Folder::new("cloth-short");
    said(&shapeop_into(&short, &["solve", &example("hanging_cloth.json"), "--steps", "3"]));
    assert_eq!(json(&short.path("hanging_cloth.solve.json"))["steps"], 3);
}

#[test]
fn a_problem_of_edges_or_points_only_has_a_picture() {
    let folder = Folder::new("bare");
    let points = r#""version": 1, "points": [[0,0,0],[1,0,0],[1,1,0.3]]"#;
    let constraint = r#""constraints": [{"type": "Closeness", "indices": [0]}]"#;
    let edges = folder.write("edges.json", &format!(r#"{{{points}, {constraint}, "edges": [[0,1],[1,2]]}}"#));
    let bare = folder.write("points.json", &format!("{{{points}, {constraint}}}"));
    for (path, name, element) in [(edges, "edges", "<line"), (bare, "points", "<circle")] {
        said(&shapeop_into(&folder, &["solve", &path, "--picture", "svg"]));
        let picture = std::fs::read_to_string(folder.path(&format!("{name}.solve.svg"))).unwrap();
        assert!(picture.contains(element), "{name}");
        assert_eq!(file::read(folder.path(&format!("{name}.solve.obj"))).unwrap().points.len(), 3);
        assert!(json(&folder.path(&format!("{name}.solve.json")))["quality"].is_null());
    }
}

#[test]
fn check_names_the_worst_faces_and_their_lines() {
    let path = mesh_path("tubemesh.obj");
    let mesh = file::read_source(&path).unwrap();
    let worst = planarity(&mesh.mesh);
    let text = said(&shapeop(&["check", &path]));
    let named = format!("face {}    line {}", worst.max_at, mesh.face_lines[worst.max_at]);
    for part in [&named, "200 points, 171 quads, 370 edges, 1 boundary", "145 of 171 faces are over 0.300 %", "####"] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let report: Value = serde_json::from_str(&said(&shapeop(&["check", &path, "--json", "--worst", "3"]))).unwrap();
    assert_close(&report["quality"]["planarity"]["max"], worst.max);
    assert_eq!(report["worst_faces"].as_array().unwrap().len(), 3);
    assert_eq!(report["worst_faces"][0]["face"], worst.max_at);
    assert_eq!(report["worst_faces"][0]["line"], mesh.face_lines[worst.max_at]);
}

#[test]
fn check_tells_what_is_not_manifold() {
    let folder = Folder::new("fins");
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 9 9 9\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    let text = said(&shapeop(&["check", &folder.write("fins.obj", text)]));
    assert!(text.contains("1 edges have more than two faces: 0-1") && text.contains("1 points belong to no face"));
    let empty = said(&shapeop(&["check", &folder.write("points.obj", "v 0 0 0\n")]));
    assert!(empty.contains("no faces"));
}

#[test]
fn types_are_those_of_the_registry() {
    let list: Value = serde_json::from_str(&said(&shapeop(&["types", "--json"]))).unwrap();
    let names: Vec<&str> = list.as_array().unwrap().iter().map(|info| info["name"].as_str().unwrap()).collect();
    let registry: Vec<&str> = shapeop::constraints::types().map(|info| info.name).collect();
    assert_eq!(names, registry);
    let table = said(&shapeop(&["types"]));
    assert!(registry.iter().all(|name| table.contains(name)));
    assert!(said(&shapeop(&["types", "EdgeStrain"])).contains("length (as created), range_min (1), range_max (1)"));
    assert!(refused(&shapeop(&["types", "Plain"]), 1).contains("\"Plain\" is not one of EdgeStrain"));
}

#[test]
fn help_teaches_with_examples() {
    let recipes = ["planarize", "circularize", "smooth", "regularize", "equalize", "rationalize", "circumscribe"];
    for command in [&recipes[..], &["solve", "explore", "check", "types"]].concat() {
        let text = said(&shapeop(&[command, "--help"]));
        assert!(text.contains(&format!("shapeop {command} ")) && text.contains("Examples:"), "{command}");
    }
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    let folder = Folder::new("wrong");
    let out = Folder::new("wrong-out");
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let bent = folder.write("bent.obj", "v 0 0 0\nv 1 0 zero\n");
    let twice = folder.write("twice.obj", &format!("{square}f 1 2 3 4\nf 1 2 3 2\n"));
    let points = folder.write("points.obj", square);
    let good = folder.write("good.obj", &format!("{square}f 1 2 3 4\n"));
    let problem = folder.write(
        "bad.json",
        r#"{"version": 1, "points": [[0,0,0]], "constraints": [{"type": "Plane", "indices": [0,1,2]}]}"#,
    );
    let free = folder.write(
        "free.json",
        r#"{"version": 1, "points": [[0,0,0]], "forces": [{"kind": "gravity", "force": [0,0,-1]}]}"#,
    );
    let taken = folder.write("taken", "");
    let cases: [(&[&str], &str); 12] = [
        (&["planarize", &bent], "bent.obj:2: expected a finite number, found \"zero\""),
        (&["check", &bent], "bent.obj:2: expected a finite number, found \"zero\""),
        (&["planarize", &twice], "twice.obj, line 6: faces[1][3]: point 1 is already corner 1 of this face"),
        (&["planarize", "none.obj"], "none.obj: cannot be read: "),
        (&["planarize", "model.3dm"], "model.3dm: expected the extension .obj, .off or .ply"),
        (&["planarize", &points], "points.obj: faces: expected at least one face, found none"),
        (&["planarize", &good, "--closeness", "-1"], "closeness: expected at least 0, found -1"),
        (&["planarize", &good, "--tolerance", "-1"], "tolerance: expected a finite number of at least 0, found -1"),
        (&["planarize", &good, "--anchors", "7"], "anchors[0]: 7 is out of range for 4 points"),
        (&["equalize", &good, "--length", "0"], "length: expected a finite number above 0, found 0"),
        (&["solve", &problem], "bad.json: constraints[0].indices[1]: 1 is out of range for 1 points"),
        (&["solve", &free], "free.json: unbounded, nothing was solved: "),
    ];
    for (arguments, expected) in cases {
        let out = ["-o", out.0.to_str().unwrap()];
        let options: &[&str] = if arguments[0] == "check" { &[] } else { &out };
        let arguments = [arguments, options].concat();
        let stderr = refused(&shapeop(&arguments), 1);
        assert!(stderr.starts_with("error: ") && stderr.contains(expected), "{arguments:?}: {stderr}");
        assert_eq!(stderr.trim_end().lines().count(), 1);
    }
    assert!(out.files().is_empty(), "{:?}", out.files());
    let stderr = refused(&shapeop(&["planarize", &good, "-o", &taken]), 1);
    assert!(stderr.contains("taken: the folder cannot be made"), "{stderr}");
    let usage = refused(&shapeop(&["planarize", &good, "--anchors", "corner"]), 2);
    assert!(
        usage.contains("expected \"corners\", \"boundary\", an index or a range such as 3-7, found \"corner\""),
        "{usage}"
    );
    assert!(refused(&shapeop(&["check", &good, "--limit", "nan"]), 2).contains("expected a number above 0"));
    refused(&shapeop(&["planarise", &good]), 2);
}

/// `shapeop types | head -1`: the pipe closes before everything is said.
#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_shapeop"))
        .args(["types", "--json"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_and_writes_what_was_reached() {
    use std::time::Duration;

    use program::interrupt;

    let folder = Folder::new("interrupt");
    let out = folder.path("out");
    let path = mesh_path("costa_mesh_free2.obj");
    let arguments = ["planarize", &path, "--iterations", "100000000", "--tolerance", "0", "--closeness", "1e-5"];
    let folder_out = out.display().to_string();
    // The folder is made right before the solve starts.
    let arguments = [&arguments[..], &["--picture", "none", "-o", &folder_out]].concat();
    let text = interrupt(&arguments, Some(&out), Duration::from_millis(700));
    let before = file::read(&path).unwrap();
    let after = file::read(out.join("costa_mesh_free2.planarize.obj")).unwrap();
    let report = json(&out.join("costa_mesh_free2.planarize.json"));
    assert_eq!(report["outcome"], "cancelled");
    assert!(report["iterations"].as_u64().unwrap() > 0);
    assert_report_is_true(&report, &before, &after);
    assert!(planarity(&after).max < planarity(&before).max);
    assert!(text.contains("stopped with Ctrl-C after"), "{text}");
}

#[test]
fn the_backend_is_chosen_and_the_report_says_what_ran() {
    let folder = Folder::new("backend");
    let problem = example("circularize.json");
    assert!(refused(&shapeop(&["solve", &problem, "--backend", "card"]), 2).contains("automatic"));
    let report = |backend: &str| {
        let output = shapeop_into(&folder, &["solve", &problem, "--backend", backend, "--picture", "none"]);
        (output.status.success(), json(&folder.path("circularize.solve.json"))["backend"].clone(), output)
    };
    for backend in ["cpu", "automatic"] {
        let (is_done, found, _) = report(backend);
        assert!(is_done && found["reason"].is_string() && found["fault"].is_null(), "{found}");
        assert_eq!(found["used"] == "gpu", found["gpu_iterations"] != 0);
        assert!(backend == "automatic" || found["used"] == "cpu");
        assert_eq!(found["used"] == "gpu", found["adapter"].is_string());
    }
    let (is_done, found, output) = report("gpu");
    match backend_info(&BackendOptions::default()) {
        // The library says why: there is no card, or it was built without the feature.
        Err(error) => assert!(refused(&output, 1).contains(&error.to_string())),
        Ok(info) => {
            assert!(is_done && found["used"] == "gpu" && found["gpu_iterations"] != 0, "{found}");
            assert!(found["adapter"].as_str().unwrap().starts_with(&info.adapter));
            assert!(said(&output).contains(&info.adapter));
        }
    }
}
