//! `shapeop canal` as a user meets it: every command on the examples, its files measured anew; what is wrong with a file, by line.

mod program;

use std::process::Command;

use glam::{DVec2, DVec3};
use serde_json::{Value, json};
use shapeop::geometry::canal::file::PartsForm;
use shapeop::geometry::canal::surface::SuperCanal;
use shapeop::mesh::{Grid, Mesh, file, measure};

use program::{
    Folder, commands_of, json as read_json, png_size, refused, repository, run_line, said, shapeop, shapeop_into,
    workplace,
};

fn curve(name: &str) -> String {
    repository().join("examples/canal").join(name).display().to_string()
}

/// Planar and circular by best fits, which share no code with the measures of `geometry::canal`.
#[track_caller]
fn assert_circular(mesh: &Mesh) {
    assert!(mesh.faces.iter().all(|face| face.len() == 4));
    for measure in [measure::plane_distance, measure::circularity] {
        let worst = measure::of_faces(mesh, measure).unwrap().into_iter().fold(0.0, f64::max);
        assert!(worst < 1e-9, "{worst:e}");
    }
}

/// The sphere of the curve in `dome.csv`.
const DOME: &str = "0,0,-0.75,1.25";

fn surface_of(folder: &Folder, stem: &str) -> SuperCanal {
    let text = std::fs::read_to_string(folder.path(&format!("{stem}.surface.json"))).unwrap();
    SuperCanal::from_json(&text).unwrap()
}

fn mesh_of(folder: &Folder, stem: &str) -> Mesh {
    file::read(folder.path(&format!("{stem}.obj"))).unwrap()
}

/// Points of a curve file of the examples.
fn points_of(name: &str) -> Vec<DVec3> {
    let text = std::fs::read_to_string(curve(name)).unwrap();
    let numbers = |line: &str| line.split(',').map(|cell| cell.parse().ok()).collect::<Option<Vec<f64>>>();
    text.lines().filter_map(numbers).map(|row| DVec3::new(row[0], row[1], row.get(2).copied().unwrap_or(0.0))).collect()
}

#[test]
fn every_command_writes_a_circular_mesh_its_surface_a_picture_and_a_true_report() {
    let (p2, p3) = ("-0.6,-0.8", "0.6,-0.8");
    let cases: &[(&[&str], &str, [usize; 2])] = &[
        (&["revolution", "profile.csv", "--columns", "16"], "revolution", [17, 16]),
        (&["moulding", "rail.csv", "section.csv"], "moulding", [17, 10]),
        (&["monge", "helix.csv", "arch_on_helix.csv"], "circular net", [25, 13]),
        (&["m-revolution", "bean.obj", "--p2", p2, "--p3", p3, "--columns", "9"], "M-revolution", [23, 9]),
        (&["m-revolution", "dome.csv", "--p2", p2, "--p3", p3, "--sphere", DOME], "M-revolution", [23, 13]),
        (&["m-moulding", "bean.obj", "arch.csv", "--center", "0,-3"], "M-circular net", [23, 13]),
        (&["m-moulding", "bean.obj", "arch.csv", "--p3", p3], "M-moulding", [23, 13]),
        (&["strip", "arc.csv", "--start", "3.5,0", "--lengths", "1.5"], "canal", [13, 2]),
        (&["strip", "arc.csv", "--start", "3.5,0", "--radii", "0.9"], "canal", [13, 2]),
        (&["strip", "arc.csv", "--start", "3.5,0", "--border-length", "6", "--points", "9"], "canal", [9, 2]),
        (&["strip", "arc.csv", "--start", "3.5,0", "--border-edges", "0.6"], "canal", [13, 2]),
        (&["strip", "arc.csv", "--start", "3.5,0", "--lengths", "1.5", "--smooth"], "canal", [13, 2]),
        (&["circles", "circles.csv"], "canal", [9, 2]),
        (&["facade", "ring.json", "--start", "2.4,0", "--lengths", "0.9"], "canal", [15, 2]),
        (&["fit", "edge_a.csv", "edge_b.csv", "--phi", "30"], "canal", [19, 13]),
        (&["sections", "path.csv", "cross.csv", "--lengths", "2"], "C-canal", [17, 13]),
        (&["sections", "path.csv", "cross.csv", "--curve", "side.csv"], "C-canal", [17, 13]),
    ];
    for (i, &(arguments, family, size)) in cases.iter().enumerate() {
        let folder = Folder::new(&format!("canal-{i}"));
        let named = |&argument: &&str| {
            let is_file = [".csv", ".obj", ".json"].iter().any(|ending| argument.ends_with(ending));
            if is_file { curve(argument) } else { argument.to_owned() }
        };
        let whole: Vec<String> = ["canal"].iter().chain(arguments).map(named).collect();
        let whole: Vec<&str> = whole.iter().map(String::as_str).collect();
        let text = said(&shapeop_into(&folder, &whole));
        assert!(text.contains("planarity, worst") && !text.contains("warning"), "{arguments:?}\n{text}");
        let name = arguments[1].split('.').next().unwrap();
        let smooth = if arguments.contains(&"--smooth") { ".smooth" } else { "" };
        let stem = format!("{name}.{}{smooth}", arguments[0]);
        assert_eq!(folder.files(), [".json", ".obj", ".png", ".surface.json"].map(|ending| format!("{stem}{ending}")));
        assert!(png_size(&folder.path(&format!("{stem}.png"))).0 >= 1280);
        let (mesh, surface) = (mesh_of(&folder, &stem), surface_of(&folder, &stem));
        assert_circular(&mesh);
        let grid = surface.net().grid();
        assert_eq!((surface.family().as_str(), [grid.rows(), grid.columns()]), (family, size), "{arguments:?}");
        let report = read_json(&folder.path(&format!("{stem}.json")));
        assert_eq!((&report["family"], &report["surface"]), (&json!(family), &json!(size)));
        let fine: Vec<usize> =
            report["mesh"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap() as usize).collect();
        assert_eq!(
            (mesh.points.len(), report["faces"].as_u64().unwrap()),
            (fine[0] * fine[1], mesh.faces.len() as u64)
        );
        // The mesh is the surface, cut finer: the surface's points are in it.
        if fine == size {
            assert_eq!(mesh, grid.mesh());
        }
        let is_met = |point: &DVec3| mesh.points.iter().any(|other| other.distance(*point) < 1e-9);
        assert!(grid.points().iter().all(is_met), "{arguments:?}");
        let moves_along = arguments.contains(&"--points") || arguments.contains(&"--smooth");
        if arguments[1].ends_with(".csv") && arguments[0] != "circles" && !moves_along {
            assert!(points_of(arguments[1]).iter().all(is_met), "{arguments:?}");
            assert!(report["curves"][0]["distance"].as_f64().unwrap() < 1e-9);
        }
        assert!(report["measures"]["concyclicity"]["max"].as_f64().unwrap() < 1e-9);
        assert_eq!(report["files"].as_object().unwrap().len(), 4);
    }
}

#[test]
fn arches_over_a_sphere_leave_it_at_right_angles() {
    let folder = Folder::new("canal-dome");
    let (dome, center) = (curve("dome.csv"), DVec3::new(0.0, 0.0, -0.75));
    let points = [DVec3::new(-0.6, -0.8, 0.0), DVec3::new(0.6, -0.8, 0.0)];
    let roof = |more: &[&str]| {
        let given = ["m-revolution", &dome, "--p2", "-0.6,-0.8", "--p3", "0.6,-0.8", "--sphere", DOME];
        said(&shapeop_into(&folder, &[&["canal"], &given[..], more, &["--picture", "none"]].concat()));
        surface_of(&folder, "dome.m-revolution").net().grid().clone()
    };
    for (more, is_outside) in [(&[][..], true), (&["--inside"][..], false)] {
        let grid = roof(more);
        assert!(grid.at(0, 12).distance(points[0]) < 1e-12 && grid.at(22, 12).distance(points[1]) < 1e-12);
        for i in 0..23 {
            let (foot, middle, end) = (grid.at(i, 0), grid.at(i, 6), grid.at(i, 12));
            assert!((end.distance(center) - 1.25).abs() < 1e-12 && (middle.distance(center) > 1.25) == is_outside);
            // The arch's tangent, by its circle, is along the sphere's radius.
            let circle = shapeop::geometry::circle::Circle::through(foot, middle, end).unwrap();
            assert!(circle.tangent_at(foot).cross((foot - center).normalize()).length() < 1e-10, "{i}");
        }
        let again = roof(&[more, &["--pole", "0.75,0,-1.75", "--omega", "30"]].concat());
        let apart = grid.points().iter().zip(again.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(apart < 1e-9, "{apart}");
    }
}

#[test]
fn a_canal_mesh_is_gone_on_with_by_the_engine() {
    let folder = Folder::new("canal-circumscribe");
    said(&shapeop_into(&folder, &["canal", "fit", &curve("edge_a.csv"), &curve("edge_b.csv"), "--phi", "30"]));
    let made = folder.path("edge_a.fit.obj").display().to_string();
    said(&shapeop_into(&folder, &["circumscribe", &made, "--anchors", "boundary"]));
    let (before, after) = (mesh_of(&folder, "edge_a.fit"), mesh_of(&folder, "edge_a.fit.circumscribe"));
    assert_circular(&after);
    let moved = measure::displacements(&before.points, &after.points).unwrap().into_iter().fold(0.0, f64::max);
    assert!(moved < 1e-8 * before.diagonal(), "{moved:e}");
}

#[test]
fn strips_have_the_lengths_and_circles_asked_for() {
    let folder = Folder::new("canal-strip");
    let strip = |more: &[&str]| {
        let arc = curve("arc.csv");
        said(&shapeop_into(
            &folder,
            &[&["canal", "strip", &arc, "--start", "3.5,0", "--picture", "none"], more].concat(),
        ));
        surface_of(&folder, "arc.strip").net().grid().clone()
    };
    let grid = strip(&["--lengths", "1.5"]);
    assert!((0..13).all(|i| (grid.at(i, 0).distance(grid.at(i, 1)) - 1.5).abs() < 1e-12));
    let numbers = folder.write("lengths.csv", &format!("length\n{}", "1.5\n".repeat(13)));
    assert_eq!(strip(&["--lengths", &numbers]), grid);
    let grid = strip(&["--border-length", "6"]);
    let border = grid.column(1);
    let length: f64 = border.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    assert!((length - 6.0).abs() < 1e-12);
    let grid = strip(&["--radii", "0.9"]);
    let circle = |i: usize| shapeop::geometry::circle::Circle::through(grid.at(i, 0), grid.at(i, 1), grid.at(i + 1, 0));
    assert!((0..12).all(|i| (circle(i).unwrap().radius - 0.9).abs() < 1e-12));
    // Half circles over a plane: as high as half the crossing edge is long.
    strip(&["--lengths", "1.5", "--refine", "1", "2"]);
    let top = mesh_of(&folder, "arc.strip").points.iter().map(|point| point.z).fold(0.0, f64::max);
    assert!((top - 0.75).abs() < 1e-9, "{top}");
    let grid = strip(&["--border-edges", "0.6"]);
    assert!((0..12).all(|i| (grid.at(i, 1).distance(grid.at(i + 1, 1)) - 0.6).abs() < 1e-12));
    let edges: Vec<String> = (0..12).map(|k| format!("{}", 0.5 + 0.02 * f64::from(k))).collect();
    let grid = strip(&["--border-edges", &edges.join(",")]);
    assert!((grid.at(11, 1).distance(grid.at(12, 1)) - 0.72).abs() < 1e-12);
}

#[test]
fn smoothed_strips_keep_their_bounds_and_lie_beside_the_strip_as_it_was() {
    let folder = Folder::new("canal-smooth");
    let arc = curve("arc.csv");
    let strip = |more: &[&str]| {
        let given = ["strip", &arc, "--start", "3.5,0", "--lengths", "1.5", "--picture", "none"];
        said(&shapeop_into(&folder, &[&["canal"], &given[..], more].concat()))
    };
    strip(&[]);
    let before = (mesh_of(&folder, "arc.strip"), surface_of(&folder, "arc.strip"));
    let first = before.1.base().frames()[0];
    let smoothed = |more: &[&str]| {
        let text = strip(&[&["--smooth"], more].concat());
        assert!(text.contains("arc.strip.smooth.obj") && !text.contains("arc.strip.obj"), "{text}");
        let found = read_json(&folder.path("arc.strip.smooth.json"))["found"].clone();
        let value = |when: &str| found[format!("sum_of_squared_curvatures_{when}")].as_f64().unwrap();
        assert!(value("after") < value("before"), "{found}");
        let numbers = |name: &str| -> Vec<f64> {
            found[name].as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
        };
        let surface = surface_of(&folder, "arc.strip.smooth");
        (surface.base().frames()[0].normal, numbers("lengths"), numbers("parameters"))
    };
    let (_, lengths, free) = smoothed(&[]);
    assert!(lengths.iter().all(|length| (length / 1.5 - 1.0).abs() <= 0.25 + 1e-9));
    assert!(lengths.iter().any(|length| (length / 1.5 - 1.0).abs() > 0.05));
    let (_, lengths, parameters) = smoothed(&["--spacing-ratio", "1", "--length-change", "0.02"]);
    assert!(lengths.iter().all(|length| (length / 1.5 - 1.0).abs() <= 0.02 + 1e-9));
    // The knots of the curve, at which its points are: they stay, and without the bound they do not.
    let guide = before.1.net().grid().column(0);
    let chords: Vec<f64> = guide.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
    let moved = |parameters: &[f64]| {
        let steps = parameters.windows(2).map(|pair| pair[1] - pair[0]);
        steps.zip(&chords).map(|(step, chord)| (step / chord - 1.0).abs()).fold(0.0, f64::max)
    };
    assert!(moved(&parameters) < 1e-9 && moved(&free) > 1e-2, "{} {}", moved(&parameters), moved(&free));
    let (normal, ..) = smoothed(&["--cone", "0,0,2", "--cone-angle", "40"]);
    assert!((normal.angle_between(DVec3::Z).to_degrees() - 40.0).abs() < 1e-9);
    let (normal, ..) = smoothed(&["--cone", "1,2,3"]);
    let axis = DVec3::new(1.0, 2.0, 3.0);
    assert!((normal.angle_between(axis) - first.normal.angle_between(axis)).abs() < 1e-9);
    assert_eq!((mesh_of(&folder, "arc.strip"), surface_of(&folder, "arc.strip")), before);
    let surface = folder.path("arc.strip.smooth.surface.json").display().to_string();
    said(&shapeop_into(&folder, &["canal", "refine", &surface, "--picture", "none"]));
    assert!(folder.path("arc.strip.smooth.refine.obj").exists());
}

#[test]
fn curves_in_all_formats_are_one_curve_and_closed_ones_say_so() {
    let folder = Folder::new("canal-formats");
    let square = [[2, 0], [3, 0], [3, 1], [2, 1]];
    let lines = |separator: &str, prefix: &str, points: &[[i32; 2]]| -> String {
        points.iter().map(|[x, z]| format!("{prefix}{x}{separator}0{separator}{z}\n")).collect()
    };
    let repeated = [square.as_slice(), &square[..1]].concat();
    let files = [
        folder.write("a.csv", &format!("# a square\nx,y,z\n{}", lines(",", "", &repeated))),
        folder.write("b.json", r#"{"points": [[2,0,0],[3,0,0],[3,0,1],[2,0,1]], "closed": true}"#),
        folder.write("c.obj", &format!("{}l 1 2 3 4 1\n", lines(" ", "v ", &square))),
        folder.write("d.json", "[[2,0,0],[3,0,0],[3,0,1],[2,0,1],[2,0,0]]"),
    ];
    for (path, (name, repeats)) in files.iter().zip([("a", true), ("b", false), ("c", true), ("d", true)]) {
        let text = said(&shapeop_into(&folder, &["canal", "revolution", path, "--columns", "6", "--picture", "none"]));
        assert!(text.contains("4 points, closed") && text.contains("its end is repeated") == repeats, "{text}");
        let report = read_json(&folder.path(&format!("{name}.revolution.json")));
        assert_eq!((&report["wraps"], &report["surface"]), (&json!([true, true]), &json!([4, 6])));
        assert_eq!(mesh_of(&folder, &format!("{name}.revolution")), mesh_of(&folder, "a.revolution"));
    }
}

#[test]
fn chains_are_applied_in_their_order_and_undone_by_their_inverse() {
    let folder = Folder::new("canal-chain");
    let run =
        |arguments: &[&str]| said(&shapeop_into(&folder, &[&["canal"], arguments, &["--picture", "none"]].concat()));
    run(&["revolution", &curve("profile.csv"), "--angle", "150", "--columns", "9"]);
    let start = surface_of(&folder, "profile.revolution");
    let path = folder.path("profile.revolution.surface.json").display().to_string();
    let factors =
        json!({"column": (0..16).map(|i| 1.0 + 0.02 * f64::from(i)).collect::<Vec<_>>(), "row": vec![1.5; 8]});
    let inverse: Vec<f64> = (0..16).map(|i| 1.0 / (1.0 + 0.02 * f64::from(i))).collect();
    let factors = folder.write("factors.json", &factors.to_string());
    let links = [
        "--inversion",
        "4,1,0,2",
        "--combescure",
        &factors,
        "--scale",
        "3",
        "--rotate",
        "0,0,1,90",
        "--translate",
        "1,2,3",
    ];
    run(&[&["transform", &path], &links[..]].concat());
    let there = surface_of(&folder, "profile.revolution.transform");
    assert_eq!(there.family(), "CM-revolution");
    assert_circular(&mesh_of(&folder, "profile.revolution.transform"));
    let chain = json!([
        {"translation": [-1, -2, -3]}, {"rotation": [0, 0, -(0.5_f64.sqrt()), 0.5_f64.sqrt()]}, {"scaling": 1.0 / 3.0},
        {"combescure": {"column": inverse, "row": vec![1.0 / 1.5; 8]}}, {"inversion": {"center": [4, 1, 0], "ratio": 2}},
    ]);
    let chain = folder.write("chain.json", &chain.to_string());
    let path = folder.path("profile.revolution.transform.surface.json").display().to_string();
    run(&["transform", &path, "--chain", &chain]);
    let back = surface_of(&folder, "profile.revolution.transform.transform");
    let apart = |a: &Grid, b: &Grid| a.points().iter().zip(b.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart(back.net().grid(), start.net().grid()) < 1e-9);
    assert_eq!(back.base(), start.base());
    // The other way round the same links make another surface.
    run(&[
        "transform",
        &folder.path("profile.revolution.surface.json").display().to_string(),
        "--combescure",
        &factors,
        "--inversion",
        "4,1,0,2",
    ]);
    let other = surface_of(&folder, "profile.revolution.transform");
    assert_eq!(other.family(), "M-moulding");
}

#[test]
fn refining_keeps_points_and_circles() {
    let folder = Folder::new("canal-refine");
    let run =
        |arguments: &[&str]| said(&shapeop_into(&folder, &[&["canal"], arguments, &["--picture", "none"]].concat()));
    run(&["fit", &curve("edge_a.csv"), &curve("edge_b.csv"), "--phi", "30"]);
    let coarse = mesh_of(&folder, "edge_a.fit");
    run(&[
        "refine",
        &folder.path("edge_a.fit.surface.json").display().to_string(),
        "--refine",
        "3",
        "2",
        "--format",
        "ply",
    ]);
    let fine = file::read(folder.path("edge_a.fit.refine.ply")).unwrap();
    assert_eq!(fine.points.len(), (3 * 18 + 1) * (2 * 12 + 1));
    assert_circular(&fine);
    for (k, point) in coarse.points.iter().enumerate() {
        let (i, j) = (k / 13, k % 13);
        assert!(fine.points[3 * i * 25 + 2 * j].distance(*point) < 1e-9);
    }
    assert_eq!(surface_of(&folder, "edge_a.fit.refine"), surface_of(&folder, "edge_a.fit"));
}

/// Two pieces of cylinders, circular, apart.
fn two_components() -> String {
    let point = |i: usize, j: usize, shift: f64| {
        let angle = 0.3 * j as f64;
        format!("v {:?} {:?} {:?}\n", shift + angle.cos(), angle.sin(), 0.4 * i as f64)
    };
    let mut text = String::new();
    for (shift, first) in [(0.0, 1), (5.0, 13)] {
        (0..3).for_each(|i| (0..4).for_each(|j| text.push_str(&point(i, j, shift))));
        for k in (0..2).flat_map(|i| (0..3).map(move |j| first + 4 * i + j)) {
            text.push_str(&format!("f {} {} {} {}\n", k, k + 4, k + 5, k + 1));
        }
    }
    text
}

#[test]
fn components_of_a_mesh_are_transformed_and_written_alone() {
    let folder = Folder::new("canal-components");
    let mesh = folder.write("pair.obj", &two_components());
    let text =
        said(&shapeop_into(&folder, &["canal", "transform", &mesh, "--inversion", "2,2,-1,1.5", "--picture", "none"]));
    assert!(text.contains("pair-1.transform.obj") && text.contains("pair-2.transform.obj"), "{text}");
    for part in ["pair-1.transform", "pair-2.transform"] {
        let mesh = mesh_of(&folder, part);
        assert_eq!((mesh.points.len(), mesh.faces.len()), (12, 6));
        assert_circular(&mesh);
    }
    let center = DVec3::new(2.0, 2.0, -1.0);
    let image = |point: DVec3| center + 1.5 * (point - center) / (point - center).length_squared();
    let expected = image(DVec3::new(6.0, 0.0, 0.0));
    assert!(mesh_of(&folder, "pair-2.transform").points.iter().any(|point| point.distance(expected) < 1e-12));
    let text = said(&shapeop(&["canal", "check", &mesh]));
    assert!(text.contains("component 2 of 2: grid, 3 x 4 points, 6 faces"), "{text}");
}

#[test]
fn check_tells_worst_faces_folds_and_properties() {
    let folder = Folder::new("canal-check");
    // A flat grid with one point lifted: four faces are not planar.
    let mut text = String::new();
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        text.push_str(&format!("v {i} {j} {}\n", if (i, j) == (1, 2) { "0.1" } else { "0" }));
    }
    for k in (0..3).flat_map(|i| (0..3).map(move |j| 4 * i + j + 1)) {
        text.push_str(&format!("f {} {} {} {}\n", k, k + 4, k + 5, k + 1));
    }
    let mesh = folder.write("bump.obj", &text);
    let report: Value = serde_json::from_str(&said(&shapeop(&["canal", "check", &mesh, "--json"]))).unwrap();
    let part = &report["components"][0];
    let bad: Vec<u64> = (0..4).map(|k| part["worst_faces"][k]["face"].as_u64().unwrap()).collect();
    assert!([1, 2, 4, 5].iter().all(|face| bad.contains(face)), "{bad:?}");
    assert_eq!(part["worst_faces"][4]["planarity"], 0.0);
    assert!(said(&shapeop(&["canal", "check", &mesh])).contains("warning: faces are not planar and circular"));
    let run =
        |arguments: &[&str]| said(&shapeop_into(&folder, &[&["canal"], arguments, &["--picture", "none"]].concat()));
    run(&["revolution", &curve("profile.csv"), "--columns", "12"]);
    let surface = folder.path("profile.revolution.surface.json").display().to_string();
    let text = said(&shapeop(&["canal", "check", &surface, "--properties"]));
    for part in [
        "rows                 planar",
        "columns              planar",
        "yes, by construction",
        "stress lines         yes",
        "no folds",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    // A section that reaches beyond the evolute of its rail folds: at (0, 0), the sharpest point, the radius is 2.
    let beyond: String = (0..9)
        .map(|k| f64::from(k) / 8.0 * 3.0 * 0.5_f64.sqrt())
        .map(|s| format!("{:?},{:?},{:?}\n", s - 2.0, s + 1.0, 0.2 * s))
        .collect();
    let beyond = folder.write("beyond.csv", &beyond);
    let text = run(&["moulding", &curve("rail.csv"), &beyond]);
    assert!(text.contains("edges are reversed: the profile reaches beyond the evolute"), "{text}");
    let report = read_json(&folder.path("rail.moulding.json"));
    assert!(report["measures"]["rows_near_evolute"].as_array().unwrap().contains(&json!(8)), "{report}");
}

/// The corners of the polygons of a class, by `panel-R-C`.
fn polygons(svg: &str, class: &str) -> Vec<Vec<DVec2>> {
    let start = format!("<polygon class=\"{class}\"");
    let corners = |element: &str| {
        let points = element.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
        let corner = |pair: &str| {
            let (x, y) = pair.split_once(',').unwrap();
            DVec2::new(x.parse().unwrap(), y.parse().unwrap())
        };
        points.split(' ').map(corner).collect()
    };
    svg.split(&start).skip(1).map(corners).collect()
}

#[test]
fn panels_are_drawn_in_true_scale_and_beams_are_planar() {
    let folder = Folder::new("canal-panels");
    let run = |arguments: &[&str]| said(&shapeop_into(&folder, &[&["canal"], arguments].concat()));
    run(&["strip", &curve("arc.csv"), "--start", "3.5,0", "--lengths", "1.5", "--picture", "none"]);
    let surface = folder.path("arc.strip.surface.json").display().to_string();
    for (axes, flip) in [("normals", true), ("least-gaps", false)] {
        let mut arguments = vec![
            "panels",
            &surface,
            "--refine",
            "1",
            "4",
            "--thickness",
            "0.02",
            "--beam-height",
            "0.15",
            "--axes",
            axes,
        ];
        arguments.extend(flip.then_some("--flip"));
        let text = run(&arguments);
        assert!(text.contains("sheet-000.svg … arc.strip.panels.sheet-011.svg"), "{text}");
        let mesh = mesh_of(&folder, "arc.strip.panels");
        let text = std::fs::read_to_string(folder.path("arc.strip.panels.parts.json")).unwrap();
        let parts: PartsForm = serde_json::from_str(&text).unwrap();
        assert_eq!((parts.panels.len(), parts.beams.len()), (48, 12 * 5 + 13 * 4));
        for row in 0..12 {
            let svg = std::fs::read_to_string(folder.path(&format!("arc.strip.panels.sheet-{row:03}.svg"))).unwrap();
            let width = svg.split(" width=\"").skip(1).find_map(|rest| rest.split_once("mm\"")).unwrap().0.to_owned();
            assert!(svg.contains(&format!("viewBox=\"0 0 {width} ")), "a unit of the drawing is a millimetre");
            let (cut, lower) = (polygons(&svg, "cut"), polygons(&svg, "lower"));
            assert_eq!((cut.len(), lower.len()), (4, 4));
            for (column, outline) in cut.iter().enumerate() {
                let corners = mesh.corners(&mesh.faces[4 * row + column]);
                for (a, b) in [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3)] {
                    let drawn = outline[a].distance(outline[b]);
                    assert!((drawn - 1000.0 * corners[a].distance(corners[b])).abs() < 1e-3, "{row} {column} {a} {b}");
                }
                assert!(svg.contains(&format!("\n{row}-{column}\n")));
            }
        }
        let below = file::read(folder.path("arc.strip.panels.offset.obj")).unwrap();
        for (k, (point, below)) in mesh.points.iter().zip(&below.points).enumerate() {
            assert!((point.distance(*below) - 0.15).abs() < 1e-12);
            let axis = DVec3::from_array(parts.axes[k]);
            assert!(below.distance(*point - 0.15 * axis) < 1e-12);
        }
        let beams = file::read(folder.path("arc.strip.panels.beams.obj")).unwrap();
        assert_eq!(beams.faces.len(), parts.beams.len());
        let off = measure::of_faces(&beams, measure::plane_distance).unwrap().into_iter().fold(0.0, f64::max);
        assert!(off < 1e-9, "{off}");
        assert!(png_size(&folder.path("arc.strip.panels.png")).0 >= 1280);
    }
    let squares = || {
        let text = std::fs::read_to_string(folder.path("arc.strip.panels.parts.json")).unwrap();
        serde_json::from_str::<PartsForm>(&text).unwrap().gaps.iter().map(|gap| gap * gap).sum::<f64>()
    };
    let least = squares();
    run(&["panels", &surface, "--refine", "1", "4", "--beam-height", "0.15", "--picture", "none"]);
    assert!(least <= squares(), "{least}");
}

#[test]
fn what_is_wrong_is_named_with_its_file_and_line() {
    let folder = Folder::new("canal-wrong");
    let out = Folder::new("canal-wrong-out");
    let word = folder.write("word.csv", "x,y\n0,0\n1,one\n");
    let short = folder.write("short.csv", "0,0,0\n1,0\n");
    let wide = folder.write("wide.csv", "1,2,3,4\n");
    let single = folder.write("single.csv", "0,0\n");
    let point = folder.write("point.json", "[\n[0, 0],\n[1]\n]");
    let field = folder.write("field.json", "{\n\"point\": []}");
    let index = folder.write("index.obj", "v 0 0 0\nv 1 0 0\nl 1 3\n");
    let mesh = folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    let twice = folder.write("twice.csv", "1,0,0\n1,0,1\n1,0,1\n2,0,2\n");
    let crossing = folder.write("crossing.csv", "1,0,0\n-1,0,1\n");
    let circle = folder.write("circle.csv", "0,0,1\n1,0,-1\n");
    let apart = folder.write("apart.csv", "0,0,1\n5,0,1\n");
    let surface = folder.write("bad.json", "{\"version\": 1,\n\"base\": \"cone\"}");
    let skew = folder.write("skew.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.3\nv 0 1 0\nf 1 2 3 4\n");
    let (arc, dome) = (curve("arc.csv"), curve("dome.csv"));
    let rough = ["strip", &arc, "--start", "3.5,0", "--lengths", "1.5", "--smooth"];
    let ratio = [&rough[..], &["--spacing-ratio", "0.5"]].concat();
    let cone = [&rough[..], &["--cone", "0,0,0"]].concat();
    let roof = ["m-revolution", &dome, "--p2", "-0.6,-0.8", "--p3", "0.6,-0.8", "--sphere"];
    let (off, empty) = ([&roof[..], &["0,0,-0.75,1.2"]].concat(), [&roof[..], &["0,0,-0.75,0"]].concat());
    let pole = [&roof[..], &[DOME, "--pole", "0,0,1"]].concat();
    let chain = folder.write("chain.json", "[{\"scaling\": 2},\n{\"scaling\": \"x\"}]");
    let zero = folder.write("zero.json", "[{\"scaling\": 0}]");
    let good = folder.write("good.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    let cases: &[(&[&str], &str)] = &[
        (&["revolution", &word], "word.csv:3: expected a finite number, found \"one\""),
        (&["revolution", &short], "short.csv:2: expected 3 values as above, found 2"),
        (&["revolution", &wide], "wide.csv:1: expected x,y or x,y,z, found 4 values"),
        (&["revolution", &single], "single.csv: expected a curve of at least 2 points, found 1"),
        (&["revolution", &point], "point.json:3: [1]: invalid length 1, expected a point [x, y] or [x, y, z]"),
        (&["revolution", &field], "field.json:2: point: unknown field `point`"),
        (&["revolution", &index], "index.obj:3: vertex 3 is out of range for 2 vertices"),
        (&["revolution", &mesh], "mesh.obj:4: expected a polyline \"l 1 2 3\", found a face: is it a mesh?"),
        (&["revolution", "none.csv"], "none.csv: cannot be read: "),
        (&["revolution", "model.3dm"], "model.3dm: expected the extension .csv, .json or .obj"),
        (&["revolution", &twice], "twice.csv: profile[2]: expected a point apart from the one before it"),
        (&["revolution", &crossing], "crossing.csv: profile[1]: expected the profile on one side of the axis"),
        (&["circles", &circle], "circle.csv: circles[1]: expected a unit normal and a radius above 0"),
        (&["circles", &apart], "apart.csv: circles[1]: it and circles[0] do not meet in two points"),
        (&["strip", &arc, "--start", "3.5,0", "--lengths", "1,2,3"], "lengths: expected 13, found 3"),
        (&["strip", &arc, "--start", "3.5,0", "--lengths", "1.5,9"], "is not attainable: lengths above 0 and below"),
        (
            &["strip", &arc, "--start", "3.5,0", "--lengths", "lengths"],
            "lengths: expected numbers separated by commas, or a file",
        ),
        (&["strip", &arc, "--start", "3.5,0", "--border-edges", "0.5,9"], "border-edges: expected 12, found 2"),
        (&["strip", &arc, "--start", "3.5,0", "--border-edges", "9"], "border-edges[0]: a border edge of 9 is not"),
        (&ratio, "spacing-ratio: expected 1 or more, found 0.5"),
        (&cone, "cone: expected"),
        (&off, "dome.csv: curve[0]: expected a point of the sphere, found one"),
        (&empty, "sphere: expected a radius above 0, found 0"),
        (&pole, "pole: expected a point of the sphere, found one"),
        (&["facade", &arc, "--start", "3.5,0", "--lengths", "1"], "arc.csv: expected a closed curve"),
        (&["transform", &surface, "--scale", "2"], "bad.json: base: unknown variant `cone`"),
        (&["transform", &skew, "--scale", "2"], "skew.obj: "),
        (&["transform", &mesh, "--scale", "2"], "mesh.obj, line 4: faces[0]: expected a quad, found 3 corners"),
        (&["transform", &good, "--chain", &chain], "chain.json:2: [1].scaling: invalid type: string \"x\""),
        (&["transform", &good, "--chain", &zero], "zero.json: [0]: scale: expected a number other than 0"),
        (&["transform", &good, "--inversion", "0,0,0,1"], "--inversion: points[0]: "),
        (&["transform", &good], "expected at least one of --chain, --inversion"),
        (&["panels", &good, "--thickness", "-1"], "thickness: expected a finite number of at least 0, found -1"),
    ];
    for (arguments, expected) in cases {
        let whole = [&["canal"], *arguments, &["-o", out.0.to_str().unwrap()]].concat();
        let stderr = refused(&shapeop(&whole), 1);
        assert!(stderr.starts_with("error: ") && stderr.contains(expected), "{arguments:?}: {stderr}");
        assert_eq!(stderr.trim_end().lines().count(), 1);
    }
    assert!(out.files().is_empty(), "{:?}", out.files());
    for (arguments, expected) in [
        (vec!["strip", &arc, "--start", "3.5", "--lengths", "1"], "expected x,y or x,y,z, found 1 numbers"),
        (vec!["strip", &arc, "--start", "3.5,0"], "--lengths"),
        (vec!["strip", &arc, "--start", "3.5,0", "--lengths", "1", "--radii", "1"], "cannot be used with"),
        (vec!["strip", &arc, "--start", "3.5,0", "--lengths", "1", "--cone", "0,0,1"], "--smooth"),
        (vec!["m-revolution", &arc, "--p2", "0,0", "--p3", "1,0", "--inside"], "--sphere"),
        (vec!["m-revolution", &arc, "--p2", "0,0", "--p3", "1,0", "--sphere", "0,0,1"], "expected 4 numbers, found 3"),
        (vec!["transform", &good, "--rotate", "1,0,0"], "expected 4 numbers, found 3"),
    ] {
        let stderr = refused(&shapeop(&[&["canal"], &arguments[..]].concat()), 2);
        assert!(stderr.contains(expected), "{arguments:?}: {stderr}");
    }
}

/// A folder with the examples, and the files that examples of the help name.
fn canal_workplace(name: &str) -> Folder {
    let folder = workplace(name, "canal");
    folder.write("net.obj", &two_components());
    folder.write("chain.json", r#"[{"scaling": 2}, {"inversion": {"center": [9, 1, 0], "ratio": 4}}]"#);
    let factors = json!({"column": vec![1.2; 16], "row": vec![0.9; 23]});
    folder.write("factors.json", &factors.to_string());
    let circles: Vec<Value> = (0..4).map(|k| json!({"center": [k, 0, 0], "radius": 0.8})).collect();
    folder.write("circles.json", &json!(circles).to_string());
    folder
}

#[test]
fn the_examples_of_the_help_run() {
    let folder = canal_workplace("canal-help");
    let commands = [
        "revolution",
        "moulding",
        "monge",
        "m-revolution",
        "m-moulding",
        "strip",
        "circles",
        "facade",
        "fit",
        "sections",
        "transform",
        "refine",
        "check",
        "panels",
    ];
    for command in commands {
        let text = help(&["canal", command, "--help"]);
        let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("  shapeop ")).collect();
        assert!(text.contains("Examples:") && !lines.is_empty(), "{command}");
        for line in lines {
            run_line(&folder, line, &[]);
        }
    }
    // An example and, some spaces further, what it does.
    let text = help(&["canal", "--help"]);
    for line in text.lines().filter(|line| line.starts_with("  shapeop ")) {
        let line = line.trim().split("   ").next().unwrap();
        run_line(&folder, line.split("  ").next().unwrap(), &[]);
    }
}

/// What a wide terminal shows.
fn help(arguments: &[&str]) -> String {
    said(&Command::new(env!("CARGO_BIN_EXE_shapeop")).args(arguments).env("COLUMNS", "300").output().unwrap())
}

#[test]
fn the_commands_of_the_documentation_run() {
    let folder = canal_workplace("canal-docs");
    let lines = commands_of("docs/canal.md");
    assert!(lines.len() >= 10, "{}", lines.len());
    for line in lines {
        run_line(&folder, &line, &[]);
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_smoothing_and_writes_what_was_reached() {
    use std::time::Duration;

    use program::interrupt;

    let folder = Folder::new("canal-interrupt");
    let out = folder.path("out");
    let arc = curve("arc.csv");
    let strip =
        ["canal", "strip", &arc, "--start", "3.5,0", "--border-length", "6", "--points", "1500", "--refine", "1", "2"];
    let folder_out = out.display().to_string();
    let search = ["--smooth", "--iterations", "100000", "--picture", "none", "-o", &folder_out];
    // The folder is made right before the search starts; an iteration takes some tenths of a second.
    interrupt(&[&strip[..], &search].concat(), Some(&out), Duration::from_millis(400));
    let report = read_json(&out.join("arc.strip.smooth.json"));
    assert_eq!(report["found"]["smoothing_stopped"], "stopped with Ctrl-C");
    let mesh = file::read(out.join("arc.strip.smooth.obj")).unwrap();
    assert_eq!(mesh.points.len(), 1500 * 3);
    assert_circular(&mesh);
}
