//! What `shapeop ruled` refuses, and how: the option or the file is named, and nothing is written.

mod program;

use std::f64::consts::PI;

use glam::DVec3;
use shapeop::mesh::patterns::parametric_surface;

use program::{Folder, obj, refused, repository, said, shapeop, shapeop_into};

fn example(name: &str) -> String {
    repository().join("examples/ruled").join(name).display().to_string()
}

fn sphere() -> String {
    let at = |u: f64, v: f64| 2.0 * DVec3::new(u.cos() * v.cos(), u.sin() * v.cos(), v.sin());
    obj(&parametric_surface(21, 15, [0.0, 2.0], [-0.7, 0.7], at).unwrap())
}

#[test]
fn what_is_wrong_is_named() {
    let folder = Folder::new("ruled-wrong");
    let out = Folder::new("ruled-wrong-out");
    let sphere = folder.write("sphere.obj", &sphere());
    let book = folder.write("book.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n");
    let flat = folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let catenoid = |u: f64, v: f64| DVec3::new(v.cosh() * u.cos(), v.cosh() * u.sin(), v);
    let waist = obj(&parametric_surface(21, 21, [0.0, 1.5], [-1.0, 1.0], catenoid).unwrap());
    let waist = folder.write("waist.obj", &waist);
    let polar = |u: f64, v: f64| {
        let (t, r) = (2.0 * PI * u, 0.3 + v);
        DVec3::new(r * t.cos(), r * t.sin(), r.powi(3) * (3.0 * t).cos())
    };
    let mut monkey = parametric_surface(49, 11, [0.0, 1.0], [0.0, 0.7], polar).unwrap();
    // Closed: the last column is the first.
    monkey.faces.iter_mut().flatten().for_each(|i| {
        if *i % 49 == 48 {
            *i -= 48
        }
    });
    let keep: Vec<usize> = (0..monkey.points.len()).filter(|i| i % 49 != 48).collect();
    monkey.faces.iter_mut().flatten().for_each(|i| *i -= *i / 49);
    monkey.points = keep.into_iter().map(|i| monkey.points[i]).collect();
    let monkey = folder.write("monkey.obj", &obj(&monkey));
    let along = folder.write("along.csv", "-1,0\n0,0\n1,0.001\n");
    let across = folder.write("across.csv", "0,-1,0\n0,1,0\n");
    let word = folder.write("word.csv", "0,0\n1,one\n");
    let version = folder.write("version.json", "{\"version\": 2, \"strips\": []}");
    let none = folder.write("none.json", "{\"version\": 1, \"strips\": []}");
    let (roof, saddle, tube, edges) =
        (example("roof.obj"), example("saddle.obj"), example("tube.obj"), example("saddle_edges.obj"));
    said(&shapeop_into(&folder, &["ruled", &roof, "--levels", "4", "--picture", "none"]));
    let strips = folder.path("roof.ruled.strips.json").display().to_string();
    let cases: &[(&[&str], &str)] = &[
        (&[&sphere], "sphere.obj: mesh: expected a negatively curved surface, found 315 of 315 points where it is not"),
        (&[&book], "book.obj: "),
        (&[&flat], "flat.obj: mesh: expected a negatively curved surface"),
        (&[&monkey], "monkey.obj: mesh: expected lines that can be given signs"),
        (
            &[&monkey, "--allow-cut"],
            "--weights.equidistant: expected a number above 0 for a field that changes its sign",
        ),
        (&[&waist, "--boundaries", "conoidal"], "field: the spherical image is folded"),
        (&["none.obj"], "none.obj: "),
        (&[&roof, "--family", "2"], "--family: expected 0 or 1, found 2"),
        (&[&roof, "--hint", "0,0,0"], "--hint: expected a finite vector"),
        (&[&roof, "--max-mask", "2"], "--max-mask: expected a number from 0 to 1, found 2"),
        (&[&roof, "--flatness", "-1"], "--flatness: expected a number from 0 to 1, found -1"),
        (&[&roof, "--levels", "0"], "--levels: expected 1 to 100000 levels, found 0"),
        (&[&roof, "--width", "-1"], "--width: expected a width above 0, found -1"),
        (&[&roof, "--values", "1,99"], "--values[1]: expected a level above 0 and up to"),
        (&[&roof, "--values", "2,1"], "--values[1]: expected levels that ascend"),
        (&[&tube, "--values", "1"], "--values: expected a count or a width, as values mean nothing around a hole"),
        (&[&roof, "--weights", "orthogonal=0"], "--weights: expected a weight of orthogonal or equidistant above 0"),
        (&[&roof, "--weights", "proximity=0,gap=0,coverage=0"], "--weights: expected one of them above 0"),
        (&[&roof, "--weights", "proximal=0,coverage=0"], "strips[0]: nothing keeps the strip from shrinking"),
        (&[&roof, "--planes", "1,0,0,99"], "--planes[0]: "),
        (&[&roof, "--planes", "0,0,0,1"], "--planes[0]: "),
        (
            &[&roof, "--planes", "1,0,0,1", "--planes", "1,0,0,1.5", "--planes", "1,0,0,-1"],
            "--planes[2]: expected planes that follow",
        ),
        (&[&roof, "--normal", "0,0,0"], "--normal: expected a vector of a length above 0"),
        (&[&roof, "--normal", "1,0,0", "--values", "0,7"], "--normal[1]: "),
        (
            &[&roof, "--normal", "1,0,0", "--levels", "4", "--least-angle", "80", "--refuse-oblique"],
            "--normal[0]: expected a section at 80",
        ),
        (&[&roof, "--normal", "1,0,0", "--least-angle", "100"], "--least-angle: expected an angle"),
        (&[&roof, "--axes", "1,0,0"], "--axes[0]: "),
        (&[&roof, "--axes", "0,0,0"], "--axes[0]: expected a direction"),
        (&[&saddle, "--curves", &edges, "--family", "1"], "--curves: "),
        (&[&saddle, "--curves", &along, "--single"], "--curves: expected two curves for a single strip, found 1"),
        (&[&saddle, "--curves", &word], "word.csv:2: expected a finite number, found \"one\""),
        (&[&saddle, "--curves", &across], "across.csv: curves[0]: expected a curve that the field crosses"),
        (&[&saddle, "--curves", &along], "boundaries: expected boundaries with a strip between two of them"),
        (&[&roof, "--control-points", "3"], "--control-points: "),
        (&[&roof, "--samples", "0", "5"], "--samples[0]: expected at least 1, found 0"),
        (&[&roof, "--largest-deviation", "0"], "--largest-deviation: expected a number above 0, found 0"),
        (&[&roof, "--least-width", "-1"], "--least-width: expected a number above 0, found -1"),
        (&[&roof, "--tolerance", "-1"], "--tolerance: expected at least 0, found -1"),
        (&[&roof, "--least-length", "-1"], "--least-length: expected a finite number of 0 or more, found -1"),
        (&[&roof, "--rulings", "1"], "--rulings: expected 2 to 100000, found 1"),
        (&[&roof, "--planks", "0"], "--planks: expected a finite number above 0, found 0"),
        (&[&roof, "--planks", "1", "--depth", "-1"], "--depth: expected a finite number of at least 0, found -1"),
        (&["check", &version, &roof], "version.json: version: expected 1, found 2"),
        (&["check", &none, &roof], "none.json: expected at least 1 strip, found none"),
        (&["check", &strips, &roof, "--feature-ratio", "0"], "--feature-ratio: expected a number above 0, found 0"),
        (
            &["planks", &strips, "--planks", "0.1"],
            "roof.ruled.strips.json: strips[0]: expected rulings parallel to a plane",
        ),
        (&["planks", &strips, "--planks", "-1"], "--planks: expected a number above 0, found -1"),
        (&["planks", "none.json", "--planks", "1"], "none.json: cannot be read"),
    ];
    for (arguments, expected) in cases {
        let whole: Vec<&str> = if arguments[0] == "check" {
            [&["ruled"], *arguments].concat()
        } else {
            [&["ruled"], *arguments, &["-o", out.0.to_str().unwrap(), "--picture", "none"]].concat()
        };
        let output = shapeop(&whole);
        assert!(!output.status.success(), "{arguments:?}");
        let stderr = refused(&output, 1);
        assert!(stderr.starts_with("error: ") && stderr.contains(expected), "{arguments:?}: {stderr}");
        assert_eq!(stderr.trim_end().lines().count(), 1, "{stderr}");
    }
    assert!(out.files().is_empty(), "{:?}", out.files());
    for (arguments, expected) in [
        (vec![], "Usage"),
        (vec![roof.as_str(), "--levels", "4", "--width", "1"], "cannot be used with"),
        (vec![&roof, "--boundaries", "planar"], "--boundaries planar needs --planes"),
        (vec![&roof, "--boundaries", "drawn"], "--boundaries drawn needs --curves"),
        (vec![&roof, "--boundaries", "geodesic", "--normal", "1,0,0"], "--normal is for --boundaries planar"),
        (vec![&roof, "--boundaries", "orthogonal", "--axes", "1,0,0"], "--axes is for --boundaries conoidal"),
        (vec![&roof, "--boundaries", "flat"], "invalid value 'flat'"),
        (vec![&roof, "--planes", "1,0,0"], "expected 4 numbers, found 3"),
        (vec![&roof, "--normal", "1,0,0", "--planes", "1,0,0,1"], "cannot be used with"),
        (
            vec![&roof, "--normal", "1,0,0", "--weights", "geodesic=1"],
            "weights of boundaries in --weights are for level curves",
        ),
        (vec![&roof, "--weights", "gaps=1"], "expected one of orthogonal"),
        (vec![&roof, "--single"], "--curves"),
        (vec![&roof, "--planar"], "--planar keeps boundaries in the planes"),
        (vec![&saddle, "--curves", &edges, "--single", "--shared"], "--shared is for strips with neighbours"),
        (vec![&roof, "--conoidal", "--no-conoidal"], "cannot be used with"),
        (vec![&roof, "--depth", "1"], "--planks"),
        (vec![&roof, "--hard-rulings"], "--problem"),
    ] {
        let stderr = String::from_utf8(shapeop(&[&["ruled"], &arguments[..]].concat()).stderr).unwrap();
        assert!(stderr.contains(expected), "{arguments:?}: {stderr}");
        refused(&shapeop(&[&["ruled"], &arguments[..]].concat()), 2);
    }
}
