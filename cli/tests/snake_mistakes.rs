//! What `shapeop snake` refuses, and how: the option or the file is named, and nothing is written.

mod program;

use glam::DVec3;
use shapeop::mesh::patterns::parametric_surface;

use program::{Folder, obj, refused, repository, said, shapeop, shapeop_into};

fn example(name: &str) -> String {
    repository().join("examples/snakes").join(name).display().to_string()
}

#[test]
fn what_is_wrong_is_named() {
    let folder = Folder::new("snake-wrong");
    let out = Folder::new("snake-wrong-out");
    let at = |u: f64, v: f64| 2.0 * DVec3::new(u.cos() * v.cos(), u.sin() * v.cos(), v.sin());
    let sphere = folder.write("sphere.obj", &obj(&parametric_surface(21, 15, [0.0, 2.0], [-0.7, 0.7], at).unwrap()));
    let book = folder.write("book.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
    let line = folder.write("line.csv", "0,0\n1,0\n2,0\n3,0\n");
    let word = folder.write("word.csv", "0,0\n1,one\n2,0\n");
    let version = folder.write("version.json", "{\"version\": 2, \"arcs\": []}");
    let typing = folder.write("typing.json", "{\"version\": 1, \"arcs\": [{\"radios\": 1, \"length\": 1}]}");
    let straight = folder.write("straight.json", "{\"version\": 1, \"control\": [[0, 0, 0], [1, 0, 0], [2, 0, 0]]}");
    let arc = r#"{"radius": 1, "length": 1}"#;
    let seven = format!(
        "{{\"version\": 1, \"arcs\": [{}], \"torsions_rad\": [1, 0.7, 0.9, -0.8, 0.6, 1]}}",
        [arc; 7].join(",")
    );
    let seven = folder.write("seven.json", &seven);
    let [roof, tower, arch, ring, six] =
        ["roof.obj", "tower.obj", "arch.csv", "ring.json", "six_arcs.json"].map(example);
    let [a, b, c, rung] = ["rail_a.csv", "rail_b.csv", "rail_c.csv", "rung.csv"].map(example);
    said(&shapeop_into(&folder, &["snake", "fit", &arch, "--arcs", "5", "--picture", "none"]));
    said(&shapeop_into(&folder, &["snake", "fit", &ring, "--arcs", "8", "--picture", "none"]));
    let snake = folder.path("arch.fit.snake.json").display().to_string();
    let closed = folder.path("ring.fit.snake.json").display().to_string();
    // Straight ahead of the middle of the snake.
    let along = folder.write("along.csv", "-9,9,0\n-9,9,1\n-9,9,2\n");
    let evolve = |mesh: &str, given: &str| -> Vec<String> {
        let words = [&["evolve", mesh][..], &given.split_whitespace().collect::<Vec<_>>()].concat();
        words.into_iter().map(str::to_owned).collect()
    };
    let from = |rest: &str| evolve(&sphere, &format!("--from 1.2,1.6,0 --toward 0,0,1 {rest}"));
    let with_snake = |rest: &str| {
        let mut words = evolve(&roof, "--snake");
        words.push(snake.clone());
        words.extend(rest.split_whitespace().map(str::to_owned));
        words
    };
    let list = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Vec<String>>();
    let cases: Vec<(Vec<String>, &str)> = vec![
        (evolve("none.obj", "--section 0,0,1,0 --arcs 6"), "none.obj: "),
        (evolve(&book, "--section 0,0,1,0.5 --arcs 6"), "book.obj"),
        (
            evolve(&roof, "--from 99,0 --toward 1,0 --curvature 1 --length 1 --arcs 2"),
            "--from: expected x,y under or over the mesh",
        ),
        (
            evolve(&roof, "--from 0,0,99 --toward 1,0 --curvature 1 --length 1 --arcs 2"),
            "--from: expected a point that is nearer",
        ),
        (from("--curvature 0.1 --length 1 --arcs 2"), "--curvature: expected at least 0."),
        (from("--curvature -1 --length 1 --arcs 2"), "--curvature"),
        (from("--curvature 1 --length 0 --arcs 2"), "--length: expected a finite length above 0, found 0"),
        (from("--curvature 1 --length 1 --arcs 0"), "--arcs: expected 1 to 10000, found 0"),
        (from("--curvature 4 --length 2 --arcs 2"), "--arcs: expected at least 3"),
        (
            evolve(&sphere, "--from 1.2,1.6,0 --toward 0,0,0 --curvature 1 --length 1 --arcs 2"),
            "--toward: expected a direction",
        ),
        (
            from("--curvature 1 --length 1 --arcs 2 --nearness 0"),
            "--nearness: expected a finite number above 0, found 0",
        ),
        (evolve(&roof, &format!("--curve {word} --arcs 2")), "word.csv:2: expected a finite number, found \"one\""),
        (evolve(&roof, &format!("--curve {line} --arcs 2")), "line.csv: points: expected a curve that is curved"),
        (evolve(&tower, "--section 0,0,1,9 --arcs 8"), "--section: expected D from 0 to 6"),
        (evolve(&tower, "--section 0,0,0,1 --arcs 8"), "--section: expected a normal other than 0,0,0"),
        (evolve(&tower, "--section 0,0,1,1 --arcs 5"), "the snake: expected at least 6 arcs of a closed snake"),
        (evolve(&roof, &format!("--snake {version}")), "version.json: version: expected 1, found 2"),
        (evolve(&roof, &format!("--snake {typing}")), "typing.json: arcs[0].radios"),
        (evolve(&roof, &format!("--snake {straight}")), "straight.json: control[1]: expected edges that turn"),
        (with_snake("--step 0"), "--step: expected a number above 0, found 0"),
        (with_snake("--max-deviation -1"), "--max-deviation: expected a number of 0 or more, found -1"),
        (with_snake("--offset-weight -1"), "--offset-weight: expected a number of 0 or more, found -1"),
        (
            with_snake("--offset-weight 0 --tangential-weight 0"),
            "--offset-weight and the other weights: expected a weight above 0",
        ),
        (with_snake("--second-order --alpha 0"), "--alpha: expected a number above 0, found 0"),
        (with_snake("--along 0,0,0"), "--along: expected a direction"),
        (with_snake("--fix 99"), "--fix 99: 99 is out of range for 7 control points"),
        (with_snake(&format!("--drive {a} --fix start")), "--snap moves it there"),
        (
            with_snake(&format!("--drive {a}@start --fix start --snap")),
            "rail_a.csv: expected a control point that nothing else",
        ),
        (with_snake(&format!("--drive {a}@99")), "rail_a.csv: point 99 is out of range for 7 control points"),
        (with_snake(&format!("--glide {along}")), "along.csv: expected a rail through contact"),
        (with_snake("--offset-surface -30"), "--offset-surface: "),
        (with_snake("--every 0"), "--every: expected at least 1, found 0"),
        (with_snake("--per-arc 0"), "--per-arc: expected 1 to 1000, found 0"),
        (with_snake("--same -1"), "--same: expected a finite number of at least 0, found -1"),
        (with_snake("--within 0"), "--within: expected a finite number above 0, found 0"),
        (with_snake("--pipes -1"), "--pipes: expected a finite radius above 0, found -1"),
        (with_snake("--pipes 99"), "--pipes: expected above 0 and below"),
        (with_snake("--lamellae 0"), "--lamellae: expected a finite depth other than 0, found 0"),
        (with_snake("--lamellae -99 --flat"), "--lamellae: expected"),
        (list(&["sweep", &a, &b, "--snake", &closed]), "RAIL: expected an open snake"),
        (list(&["sweep", &a, &b, "--curve", &rung, "--arcs", "6"]), "--snap moves it there"),
        (list(&["sweep", &a, &word, "--curve", &rung, "--arcs", "6", "--snap"]), "word.csv:2: "),
        (list(&["sweep", &a, &c, "--curve", &line, "--arcs", "2"]), "line.csv: points: "),
        (list(&["linkage", &seven]), "seven.json: expected a linkage with one freedom, found 2"),
        (list(&["linkage", &closed]), "ring.fit.snake.json: expected an open snake, found a closed one"),
        (
            list(&[
                "linkage",
                "--radius",
                "1",
                "--angle",
                "90",
                "--torsions",
                "68.75493541569878,68.75493541569878,68.75493541569878,68.75493541569878,68.75493541569878",
            ]),
            "the arcs: expected a linkage with one freedom, found 2: its position is singular",
        ),
        (
            list(&["linkage", "--radius", "1", "--angle", "180", "--torsions", "1,1,1,1,1"]),
            "--angle: expected above 0 and below 180",
        ),
        (
            list(&["linkage", "--radius", "-1", "--angle", "60", "--torsions", "1,1,1,1,1"]),
            "--radius: expected a radius above 0",
        ),
        (list(&["linkage", &six, "--step", "20"]), "--step in radians: expected above 0 and at most 0.2"),
        (list(&["linkage", &six, "--steps", "0"]), "--steps: expected at least 1, found 0"),
        (list(&["linkage", &six, "--copies", "0"]), "--copies: expected 1 to 10000, found 0"),
        (list(&["fit", "none.csv", "--arcs", "3"]), "none.csv: cannot be read"),
        (list(&["fit", &arch, "--arcs", "0"]), "--arcs: expected 1 to 10000, found 0"),
        (
            list(&["curve", &roof, "--from", "0,0", "--toward", "1,0", "--curvature", "0", "--length", "1"]),
            "--curvature: expected at least",
        ),
        (
            list(&[
                "curve",
                &roof,
                "--from",
                "0,0",
                "--toward",
                "1,0",
                "--curvature",
                "1",
                "--length",
                "1",
                "--points",
                "0",
            ]),
            "--points: expected 1 to 10000000, found 0",
        ),
        (list(&["check", &version]), "version.json: version: expected 1, found 2"),
        (list(&["check", &snake, "--mesh", "none.obj"]), "none.obj"),
    ];
    for (arguments, expected) in &cases {
        let mut whole = vec!["snake"];
        whole.extend(arguments.iter().map(String::as_str));
        if arguments[0] != "check" {
            whole.extend(["-o", out.0.to_str().unwrap(), "--picture", "none"]);
        }
        let output = shapeop(&whole);
        assert!(!output.status.success(), "{arguments:?}");
        let stderr = refused(&output, 1);
        assert!(stderr.starts_with("error: ") && stderr.contains(expected), "{arguments:?}: {stderr}");
        assert_eq!(stderr.trim_end().lines().count(), 1, "{stderr}");
    }
    assert!(out.files().is_empty(), "{:?}", out.files());
    for (given, expected) in [
        ("evolve", "Usage"),
        ("evolve a.obj", "--from"),
        ("evolve a.obj --from 0,0 --arcs 3", "--toward"),
        ("evolve a.obj --snake s.json --left --along 0,0,1", "cannot be used with"),
        ("evolve a.obj --snake s.json --speed 1,2,3", "expected one number or two, found 3"),
        ("evolve a.obj --snake s.json --fix middle", "expected \"start\", \"end\" or a number from 0"),
        ("evolve a.obj --section 0,0,1 --arcs 6", "expected 4 numbers, found 3"),
        ("evolve a.obj --snake s.json --follow r.csv", "--drive"),
        ("evolve a.obj --snake s.json --flat", "--lamellae"),
        ("evolve a.obj --snake s.json --alpha 1", "--second-order"),
        ("sweep a.csv", "RAIL"),
        ("sweep a.csv b.csv", "--curve"),
        ("linkage", "ARCS"),
        ("linkage --radius 1", "--angle"),
        ("fit a.csv", "--arcs"),
    ] {
        let words: Vec<&str> = ["snake"].into_iter().chain(given.split(' ')).collect();
        let stderr = refused(&shapeop(&words), 2);
        assert!(stderr.contains(expected), "{given}: {stderr}");
    }
}
