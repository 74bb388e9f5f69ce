//! `shapeop ruled` as a user meets it: its files measured anew with code of their own, and what it refuses.

mod program;

use std::process::Command;

use glam::DVec3;
use serde_json::Value;
use shapeop::mesh::patterns::parametric_surface;
use shapeop::mesh::{ClosestPoints, Mesh, file};

use program::{
    Folder, commands_of, json as read_json, obj, png_size, refused, repository, run_line, said, shapeop, shapeop_into,
    workplace,
};

fn example(name: &str) -> String {
    repository().join("examples/ruled").join(name).display().to_string()
}

/// A strip as its file states it, evaluated by de Boor's algorithm.
struct Surface {
    knots: Vec<f64>,
    control: [Vec<DVec3>; 2],
    is_closed: bool,
}

impl Surface {
    fn range(&self) -> [f64; 2] {
        [self.knots[3], self.knots[self.knots.len() - 4]]
    }

    fn boundary(&self, side: usize, u: f64) -> DVec3 {
        let knots = &self.knots;
        let count = knots.len() - 4;
        let span = (3..count).rev().find(|&k| knots[k] <= u).unwrap_or(3);
        let at = |k: usize| self.control[side][k % self.control[side].len()];
        let mut points: Vec<DVec3> = (span - 3..=span).map(at).collect();
        for level in 1..=3 {
            for k in (level..=3).rev() {
                let i = span - 3 + k;
                let part = (u - knots[i]) / (knots[i + 4 - level] - knots[i]);
                points[k] = points[k - 1].lerp(points[k], part);
            }
        }
        points[3]
    }

    /// The point at a part of the range and across.
    fn at(&self, part: f64, v: f64) -> DVec3 {
        let [first, last] = self.range();
        let u = first + part * (last - first);
        self.boundary(0, u).lerp(self.boundary(1, u), v)
    }
}

fn surfaces(folder: &Folder, name: &str) -> Vec<Surface> {
    let form = read_json(&folder.path(&format!("{name}.ruled.strips.json")));
    let numbers =
        |value: &Value| -> Vec<f64> { value.as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect() };
    let points = |value: &Value| value.as_array().unwrap().iter().map(|p| DVec3::from_slice(&numbers(p))).collect();
    let strip = |strip: &Value| {
        assert_eq!(strip["degrees"], serde_json::json!([3, 1]));
        Surface {
            knots: numbers(&strip["knots_u"]),
            control: [points(&strip["control"][0]), points(&strip["control"][1])],
            is_closed: strip["closed"].as_bool().unwrap(),
        }
    };
    form["strips"].as_array().unwrap().iter().map(strip).collect()
}

fn report(folder: &Folder, name: &str) -> Value {
    read_json(&folder.path(&format!("{name}.ruled.json")))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn run(folder: &Folder, arguments: &[&str]) -> String {
    said(&shapeop_into(folder, &[&["ruled"], arguments, &["--picture", "none"]].concat()))
}

/// Both ends of each piece of a ruling in the table, and the length beside them.
fn rulings(folder: &Folder, name: &str) -> Vec<(usize, DVec3, DVec3, f64)> {
    let text = std::fs::read_to_string(folder.path(&format!("{name}.ruled.rulings.csv"))).unwrap();
    assert!(text.starts_with("strip,ruling,piece,u,x0,y0,z0,x1,y1,z1,length\n"));
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        (cells[0] as usize, DVec3::from_slice(&cells[4..7]), DVec3::from_slice(&cells[7..10]), cells[10])
    };
    text.lines().skip(1).map(row).collect()
}

fn area(mesh: &Mesh) -> f64 {
    let fan = |face: &Vec<u32>| {
        let corners = mesh.corners(face);
        (1..corners.len() - 1)
            .map(|k| 0.5 * (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]).length())
            .sum::<f64>()
    };
    mesh.faces.iter().map(fan).sum()
}

/// Chords of the mesh of z = x y with edges 1/15 are off by a quarter of that squared.
const CHORD: f64 = 1.0 / 15.0 / 15.0 / 4.0;

#[test]
fn the_rulings_of_a_saddle_lie_on_it_and_the_report_is_true() {
    let folder = Folder::new("ruled-saddle");
    let text = said(&shapeop_into(&folder, &["ruled", &example("saddle.obj"), "--levels", "6", "--zebra"]));
    for part in ["6 orthogonal boundaries", "from strips to the mesh", "covered", "saddle.ruled.zebra.png"] {
        assert!(text.contains(part) || part.starts_with('6'), "{part} is not in\n{text}");
    }
    let endings = [
        ".boundaries.png",
        ".deviation.png",
        ".field.png",
        ".json",
        ".obj",
        ".png",
        ".rulings.csv",
        ".rulings.obj",
        ".strips.json",
        ".surfaces.obj",
        ".zebra.png",
    ];
    assert_eq!(folder.files(), endings.map(|ending| format!("saddle.ruled{ending}")));
    for picture in [".png", ".field.png", ".boundaries.png", ".deviation.png", ".zebra.png"] {
        assert!(png_size(&folder.path(&format!("saddle.ruled{picture}"))).0 >= 1280);
    }
    let rulings = rulings(&folder, "saddle");
    assert!(rulings.len() > 100);
    for &(_, a, b, length) in &rulings {
        assert!((a.distance(b) - length).abs() < 1e-12);
        for k in 0..=10 {
            let p = a.lerp(b, f64::from(k) / 10.0);
            assert!((p.z - p.x * p.y).abs() < 2.0 * CHORD, "{p}");
            assert!(p.x.abs() < 1.001 && p.y.abs() < 1.001, "{p}");
        }
        // Seen from above the lines of the saddle are along x or y.
        let along = (b - a).truncate().normalize_or_zero().abs();
        assert!(length < 0.05 || along.max_element() > 5_f64.to_radians().cos(), "{a} {b}");
    }
    let report = report(&folder, "saddle");
    let strips = surfaces(&folder, "saddle");
    let mesh = file::read(example("saddle.obj")).unwrap();
    assert_eq!(report["measures"]["strips"].as_array().unwrap().len(), strips.len());
    // From the mesh to strips, by triangles of them.
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for strip in &strips {
        let first = points.len() as u32;
        let (columns, rows) = (120, 12);
        for i in 0..=columns {
            points.extend((0..=rows).map(|j| strip.at(f64::from(i) / 120.0, f64::from(j) / 12.0)));
        }
        for k in (0..columns).flat_map(|i| (0..rows).map(move |j| first + i * (rows + 1) + j)) {
            triangles.extend([[k, k + rows + 1, k + 1], [k + 1, k + rows + 1, k + rows + 2]]);
        }
    }
    let closest = ClosestPoints::of_triangles(&points, &triangles).unwrap();
    let apart = mesh.points.iter().map(|&p| closest.nearest(p).distance(p)).fold(0.0, f64::max);
    let farthest = number(&report["measures"]["reference_to_strips"]["max"]);
    assert!((apart - farthest).abs() < 1e-4 && farthest < CHORD, "{apart} {farthest}");
    let trimmed = file::read(folder.path("saddle.ruled.obj")).unwrap();
    // Triangles between rulings that are twisted have a little more area.
    let (ratio, told) = (area(&trimmed) / area(&mesh), |name: &str| number(&report["measures"][name]));
    assert!((ratio - told("trimmed_area") / told("reference_area")).abs() < 5e-3, "{ratio}");
    assert!(told("coverage") > 0.995 && told("coverage") <= 1.0 && told("overlap") < 5e-3);
    let diagonal = number(&report["mesh"]["diagonal"]);
    assert!((diagonal - 12_f64.sqrt()).abs() < 1e-9);
    assert!((number(&report["relative"]["mesh_to_strips_max"]) - farthest / diagonal).abs() < 1e-15);
    // The surfaces are the strips: the same control points, in their order.
    let text = std::fs::read_to_string(folder.path("saddle.ruled.surfaces.obj")).unwrap();
    let vertices: Vec<DVec3> = text
        .lines()
        .filter_map(|line| line.strip_prefix("v "))
        .map(|line| DVec3::from_slice(&line.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()))
        .collect();
    let control: Vec<DVec3> = strips.iter().flat_map(|strip| strip.control.concat()).collect();
    assert_eq!((vertices, text.matches("\nsurf ").count()), (control, strips.len()));
    assert_eq!(report["files"].as_object().unwrap().len(), 11);
}

#[test]
fn boundaries_are_what_was_asked_for() {
    let folder = Folder::new("ruled-kinds");
    let roof = example("roof.obj");
    let variation = |report: &Value| {
        let strips = report["measures"]["strips"].as_array().unwrap();
        let inner = &strips[2..strips.len() - 2];
        inner.iter().map(|strip| number(&strip["widths"]["variation"])).fold(0.0, f64::max)
    };
    run(&folder, &[&roof]);
    let orthogonal = report(&folder, "roof");
    assert_eq!(
        (&orthogonal["boundaries"]["kind"], &orthogonal["field"]["masked_points"]),
        (&"orthogonal".into(), &0.into())
    );
    assert!(number(&orthogonal["measures"]["coverage"]) > 0.995);
    assert!(number(&orthogonal["relative"]["strips_to_mesh_max"]) < 1e-3);
    run(&folder, &[&roof, "--boundaries", "equidistant", "--width", "0.6"]);
    let equidistant = report(&folder, "roof");
    assert!(variation(&equidistant) < 0.8 * variation(&orthogonal));
    run(&folder, &[&roof, "--boundaries", "geodesic", "--levels", "8"]);
    let geodesic = report(&folder, "roof");
    assert_eq!(geodesic["boundaries"]["weights"]["geodesic"], 1.0);
    assert!(geodesic["boundaries"]["iterations"].as_u64().unwrap() > 0);

    // Planes hold exactly, but where a boundary beyond the mesh has none.
    run(&folder, &[&roof, "--normal", "2,0,0", "--levels", "8"]);
    let strips = surfaces(&folder, "roof");
    for strip in &strips[1..strips.len() - 1] {
        for side in &strip.control {
            let x = side[0].x;
            assert!(side.iter().all(|p| (p.x - x).abs() < 1e-9), "{x}");
            // Evenly between −4 and 4.
            assert!((x + 3.5 - (x + 3.5).round()).abs() < 1e-9, "{x}");
        }
    }
    assert_eq!(report(&folder, "roof")["boundaries"]["least_angles_deg"].as_array().unwrap().len(), 8);
    let planes = ["--planes", "1,0,0,-1.5", "--planes", "1,0,0,0", "--planes", "1,0.2,0,1.5"];
    run(&folder, &[&[roof.as_str()], &planes[..], &["--no-overshoot"]].concat());
    let strips = surfaces(&folder, "roof");
    assert_eq!(strips.len(), 2);
    assert!(strips[1].control[1].iter().all(|p| (p.x + 0.2 * p.y - 1.5).abs() < 1e-9));
    let text = run(&folder, &[&[roof.as_str()], &planes[..], &["--no-planar"]].concat());
    assert!(text.contains("about as wide as the features") && !text.contains("boundaries in planes"), "{text}");
    assert!(surfaces(&folder, "roof")[1].control[1].iter().any(|p| p.x.abs() > 1e-6));

    // All differences of a conoidal strip's control points are orthogonal to one vector.
    let text = run(&folder, &[&roof, "--boundaries", "conoidal", "--levels", "8", "--shared"]);
    assert!(text.contains("7 conoidal strips"), "{text}");
    let strips = surfaces(&folder, "roof");
    for strip in &strips {
        let rulings: Vec<DVec3> =
            strip.control[0].iter().zip(&strip.control[1]).map(|(a, b)| (*b - *a).normalize()).collect();
        let normals = rulings.iter().flat_map(|a| rulings.iter().map(move |b| a.cross(*b)));
        let axis = normals.max_by(|a, b| a.length().total_cmp(&b.length())).unwrap().normalize();
        assert!(rulings.iter().all(|r| r.dot(axis).abs() < 1e-7));
    }
    for pair in strips.windows(2) {
        assert_eq!(pair[0].control[1], pair[1].control[0]);
    }
    assert_eq!(report(&folder, "roof")["measures"]["max_gap"], 0.0);
    let axes = ["--axes", "1,0.3,0", "--axes", "1,0.8,0"];
    let found = shapeop_into(&folder, &[&["ruled", &roof], &axes[..], &["--picture", "none"]].concat());
    // Whether there are such curves is the surface's to say; what is told is where.
    assert!(found.status.success() || refused(&found, 1).contains("--axes["));
}

#[test]
fn side_conditions_and_bounds_hold() {
    let folder = Folder::new("ruled-conditions");
    let roof = example("roof.obj");
    let start = |more: &[&str]| {
        run(&folder, &[&[roof.as_str(), "--levels", "5"], more].concat());
        surfaces(&folder, "roof")
    };
    let (before, after) = (start(&["--iterations", "0"]), start(&["--fixed-ends", "--fixed-end-rulings"]));
    let mut moved = 0.0_f64;
    for (a, b) in before.iter().zip(&after) {
        for side in 0..2 {
            for i in [0, 11] {
                assert!(a.control[side][i].distance(b.control[side][i]) < 1e-9);
            }
            moved = moved.max(a.control[side][5].distance(b.control[side][5]));
        }
    }
    assert!(moved > 1e-4);
    let kept = start(&["--fixed-end-rulings"]);
    for (a, b) in before.iter().zip(&kept) {
        for i in [0, 11] {
            let [before, after] = [a, b].map(|strip| (strip.control[1][i] - strip.control[0][i]).normalize());
            assert!(before.cross(after).length() < 1e-9);
        }
    }
    // Of conoidal strips the part across the axis: no ruling vanishes.
    let conoids = start(&["--conoidal", "--fixed-end-rulings", "--fixed-ends"]);
    for (a, b) in before.iter().zip(&conoids) {
        for i in [0, 11] {
            let [before, after] = [a, b].map(|strip| strip.control[1][i] - strip.control[0][i]);
            assert!(after.length() > 0.5 * before.length() && before.angle_between(after) < 0.3);
        }
    }
    start(&[]);
    let free = number(
        &report(&folder, "roof")["optimisation"]["history"].as_array().unwrap().last().unwrap()["largest_deviation"],
    );
    let bound = 0.7 * free;
    start(&["--largest-deviation", &bound.to_string(), "--weights", "proximal=1e-6"]);
    let optimisation = report(&folder, "roof")["optimisation"].clone();
    let last = optimisation["history"].as_array().unwrap().last().unwrap().clone();
    assert!(number(&last["largest_deviation"]) < 1.01 * bound, "{last} {bound}");
    let values: Vec<f64> = optimisation["history"].as_array().unwrap().iter().map(|i| number(&i["value"])).collect();
    assert!(values.windows(2).all(|pair| pair[1] < pair[0]));
    // Twice as many control points, another sum, and the old one told.
    let fine = start(&["--control-points", "20", "--samples", "3", "4", "--weights", "gap=5,thin-plate=1e-5"]);
    assert!(fine.iter().all(|strip| strip.control[0].len() == 20 && !strip.is_closed));
    assert_eq!(report(&folder, "roof")["optimisation"]["weights"]["gap"], 5.0);
}

#[test]
fn a_tube_has_strips_all_around_which_check_judges_alike() {
    let folder = Folder::new("ruled-tube");
    let tube = example("tube.obj");
    run(&folder, &[&tube, "--levels", "16"]);
    let report = report(&folder, "tube");
    assert_eq!(report["mesh"]["boundary_loops"], 2);
    let joints = report["measures"]["joints"].as_array().unwrap();
    assert_eq!((joints.len(), &joints[15]["strips"]), (16, &serde_json::json!([15, 0])));
    assert!(number(&report["measures"]["coverage"]) > 0.995);
    let strips = folder.path("tube.ruled.strips.json").display().to_string();
    let judged: Value = serde_json::from_str(&said(&shapeop(&["ruled", "check", &strips, &tube, "--json"]))).unwrap();
    assert_eq!(judged["measures"], report["measures"]);
    let text = said(&shapeop(&["ruled", "check", &strips, &tube]));
    assert!(text.contains("16 strips, 0 of them conoidal") && text.contains("strip 15"), "{text}");
    // Each is too wide if a strip may not be as wide as a hundredth of the radius.
    let text = said(&shapeop(&["ruled", "check", &strips, &tube, "--feature-ratio", "0.01"]));
    assert!(text.contains("warning: strips 0, 1, 2, 3, 4, 5, 6, 7, ... (16 in all)"), "{text}");
}

#[test]
fn one_strip_is_made_between_two_drawn_curves() {
    let folder = Folder::new("ruled-single");
    let (saddle, edges) = (example("saddle.obj"), example("saddle_edges.obj"));
    let text = run(&folder, &[&saddle, "--curves", &edges, "--single"]);
    assert!(text.contains("1 strip between 2 drawn boundaries") && text.contains("4 fixed ends"), "{text}");
    let strips = surfaces(&folder, "saddle");
    for (part, v, corner) in
        [(0.0, 0.0, [-1.0, -0.8]), (1.0, 0.0, [1.0, -0.8]), (0.0, 1.0, [-1.0, 0.8]), (1.0, 1.0, [1.0, 0.8])]
    {
        let p = strips[0].at(part, v);
        assert!(p.distance(DVec3::new(corner[0], corner[1], corner[0] * corner[1])) < 1e-9, "{p}");
    }
    for k in 0..=100 {
        let p = strips[0].at(f64::from(k % 11) / 10.0, f64::from(k / 11) / 9.0 % 1.0);
        assert!((p.z - p.x * p.y).abs() < 2.0 * CHORD, "{p}");
    }
    assert!(report(&folder, "saddle")["field"].is_null());
    // A conoidal one on a sphere, which no field leads over.
    let sphere = folder.write("sphere.obj", &sphere());
    let curve = |z: f64| {
        let at = |i: i32| (0.6 + 0.1 * f64::from(i), (4.0 - z * z).sqrt());
        (0..9).map(at).map(|(t, r)| format!("{:?},{:?},{z:?}\n", r * t.cos(), r * t.sin())).collect::<String>()
    };
    let [low, high] = [("low.csv", -0.2), ("high.csv", 0.2)].map(|(name, z)| folder.write(name, &curve(z)));
    let text = run(&folder, &[&sphere, "--curves", &low, &high, "--single", "--conoidal", "--free-ends"]);
    assert!(text.contains("1 conoidal strip") && !text.contains("fixed ends"), "{text}");
    let strips = surfaces(&folder, "sphere");
    assert!((0..=20).all(|k| (strips[0].at(f64::from(k) / 20.0, 0.5).length() - 2.0).abs() < 0.05));
    // Drawn boundaries along a field, in either order.
    let reversed = std::fs::read_to_string(&edges).unwrap();
    let mut lines: Vec<&str> = reversed.lines().collect();
    let last = lines.len() - 1;
    lines.swap(last - 1, last);
    let reversed = folder.write("reversed.obj", &lines.join("\n"));
    let deviations = [&edges, &reversed].map(|edges| {
        run(&folder, &[&saddle, "--curves", edges]);
        // Strips stay between the curves, and are not drawn to where the mesh goes on.
        for p in surfaces(&folder, "saddle")[0].control.iter().flatten() {
            assert!((p.y.abs() - 0.8).abs() < 0.05, "{p}");
        }
        number(&report(&folder, "saddle")["relative"]["strips_to_mesh_max"])
    });
    assert!(deviations[0] < 1e-3 && (deviations[0] - deviations[1]).abs() < 1e-12, "{deviations:?}");
}

fn sphere() -> String {
    let at = |u: f64, v: f64| 2.0 * DVec3::new(u.cos() * v.cos(), u.sin() * v.cos(), v.sin());
    obj(&parametric_surface(21, 15, [0.0, 2.0], [-0.7, 0.7], at).unwrap())
}

#[test]
fn planks_are_boards_that_are_drawn_in_true_scale() {
    let folder = Folder::new("ruled-planks");
    let catenoid = example("catenoid.obj");
    let given = ["--family", "1", "--boundaries", "conoidal", "--levels", "5", "--planks", "0.03", "--depth", "0.01"];
    let text = run(&folder, &[&[catenoid.as_str()], &given[..]].concat());
    assert!(text.contains("conoidal strips") && !text.contains("no planks"), "{text}");
    let sets = read_json(&folder.path("catenoid.ruled.planks.json"));
    let sets = sets.as_array().unwrap();
    let solids = file::read(folder.path("catenoid.ruled.planks.obj")).unwrap();
    let count: usize = sets.iter().map(|set| set["planks"].as_array().unwrap().len()).sum();
    assert_eq!((solids.points.len(), solids.faces.len()), (8 * count, 6 * count));
    let mut next = 0;
    for (strip, set) in sets.iter().enumerate() {
        let axis: Vec<f64> = (0..3).map(|k| number(&set["axis"][k])).collect();
        let axis = DVec3::from_slice(&axis);
        let svg = std::fs::read_to_string(folder.path(&format!("catenoid.ruled.sheet-{strip:03}.svg"))).unwrap();
        assert_eq!(svg.matches("class=\"cut\"").count(), set["planks"].as_array().unwrap().len());
        let drawn = |k: usize| -> Vec<DVec3> {
            let group = svg.split(&format!("<g id=\"plank-{k}\">")).nth(1).unwrap();
            let points = group.split("points=\"").nth(1).unwrap().split('"').next().unwrap();
            let point = |pair: &str| {
                let (x, y) = pair.split_once(',').unwrap();
                DVec3::new(x.parse().unwrap(), y.parse().unwrap(), 0.0)
            };
            points.split(' ').map(point).collect()
        };
        for k in 0..set["planks"].as_array().unwrap().len() {
            let corners = &solids.points[8 * next..8 * next + 8];
            next += 1;
            let drawn = drawn(k);
            for i in 0..4 {
                assert!((corners[4 + i] - corners[i] - 0.03 * axis).length() < 1e-9);
                let there = 1000.0 * corners[i].distance(corners[(i + 1) % 4]);
                assert!((drawn[i].distance(drawn[(i + 1) % 4]) - there).abs() < 1e-2);
            }
        }
    }
    assert_eq!(next, count);
    // The same of the file of strips.
    let strips = folder.path("catenoid.ruled.strips.json").display().to_string();
    let again = Folder::new("ruled-planks-again");
    let given = ["ruled", "planks", &strips, "--planks", "0.03", "--depth", "0.01", "--within", &catenoid];
    said(&shapeop_into(&again, &given));
    let [a, b] = [&folder, &again].map(|folder| std::fs::read(folder.path("catenoid.ruled.planks.json")).unwrap());
    assert_eq!(a, b);
    assert!(png_size(&again.path("catenoid.ruled.planks.png")).0 >= 1280);
}

#[test]
fn strips_are_gone_on_with_by_the_engine() {
    let folder = Folder::new("ruled-problem");
    let roof = example("roof.obj");
    run(&folder, &[&roof, "--levels", "4", "--rulings", "9", "--problem"]);
    let problem = folder.path("roof.ruled.problem.json").display().to_string();
    said(&shapeop_into(&folder, &["solve", &problem, "--picture", "none"]));
    let solved = file::read(folder.path("roof.ruled.problem.solve.obj")).unwrap();
    let form = read_json(&folder.path("roof.ruled.problem.json"));
    let lines = |form: &Value| -> Vec<Vec<usize>> {
        let all = form["constraints"].as_array().unwrap().iter();
        let indices =
            |c: &Value| c["indices"].as_array().unwrap().iter().map(|i| i.as_u64().unwrap() as usize).collect();
        all.filter(|c| c["type"] == "Line").map(indices).collect()
    };
    let bend = |mesh: &Mesh, lines: &[Vec<usize>]| {
        let off = |line: &Vec<usize>| {
            let (a, b) = (mesh.points[line[0]], mesh.points[line[line.len() - 1]]);
            let along = (b - a).normalize();
            line.iter().map(|&i| (mesh.points[i] - a).reject_from_normalized(along).length()).fold(0.0, f64::max)
        };
        lines.iter().map(off).fold(0.0, f64::max)
    };
    let straight = lines(&form);
    assert!(straight.len() > 20 && bend(&solved, &straight) < 1e-2, "{} {}", straight.len(), bend(&solved, &straight));
    // Straight to the last digits while a corner is dragged.
    run(&folder, &[&roof, "--levels", "4", "--rulings", "9", "--problem", "--hard-rulings"]);
    let form = read_json(&folder.path("roof.ruled.problem.json"));
    let start: Vec<f64> = (0..3).map(|k| number(&form["points"][0][k])).collect();
    let moves = serde_json::json!({"version": 1, "frames": [{"handles": [{"point": 0, "target": [start[0], start[1], start[2] + 0.2]}]}]});
    let moves = folder.write("moves.json", &moves.to_string());
    said(&shapeop_into(&folder, &["explore", &problem, "--handles", &moves, "--picture", "none"]));
    let end = file::read(folder.path("roof.ruled.problem.explore.obj")).unwrap();
    let straight = lines(&form);
    assert!(bend(&end, &straight) < 1e-6, "{}", bend(&end, &straight));
    assert!(end.points[0].z > start[2] + 0.1);
}

#[test]
fn the_field_alone_is_written_for_other_programs() {
    let folder = Folder::new("ruled-field");
    let text = said(&shapeop_into(&folder, &["ruled", "field", &example("saddle.obj"), "--family", "1"]));
    assert!(text.contains("family 1 is drawn dark"), "{text}");
    assert_eq!(folder.files(), ["saddle.field.csv", "saddle.field.json", "saddle.field.png"]);
    let table = std::fs::read_to_string(folder.path("saddle.field.csv")).unwrap();
    // The lines of z = x y are along (1, 0, y) and (0, 1, x).
    let mut worst = 0.0_f64;
    for line in table.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let numbers: Vec<f64> = cells[1..12].iter().map(|cell| cell.parse().unwrap()).collect();
        let [p, a, b] = [0, 3, 6].map(|k| DVec3::from_slice(&numbers[k..k + 3]));
        assert_eq!(cells[12], "good");
        if p.x.abs().max(p.y.abs()) < 0.8 {
            let lines = [DVec3::new(1.0, 0.0, p.y), DVec3::new(0.0, 1.0, p.x)].map(DVec3::normalize);
            let off = |d: DVec3| lines.iter().map(|line| line.cross(d).length()).fold(1.0, f64::min);
            worst = worst.max(off(a)).max(off(b));
            assert!(a.cross(b).length() > 0.5);
        }
    }
    assert!(worst < 1e-2, "{worst}");
}

#[test]
fn formats_silence_and_json() {
    let folder = Folder::new("ruled-formats");
    let saddle = example("saddle.obj");
    let given =
        ["ruled", &saddle, "--levels", "3", "--format", "ply", "--picture", "svg", "--no-trim", "--rulings", "7"];
    assert_eq!(said(&shapeop_into(&folder, &[&given[..], &["--quiet"]].concat())), "");
    let mesh = file::read(folder.path("saddle.ruled.ply")).unwrap();
    let strips = surfaces(&folder, "saddle");
    assert!(mesh.faces.iter().all(|face| face.len() == 4));
    // Whole strips are beyond the mesh.
    assert!(mesh.points.iter().any(|p| p.x.abs().max(p.y.abs()) > 1.01));
    assert_eq!(rulings(&folder, "saddle").len(), 7 * strips.len());
    assert!(std::fs::read_to_string(folder.path("saddle.ruled.svg")).unwrap().contains("<polygon"));
    let text = said(&shapeop_into(&folder, &[&given[..], &["--json"]].concat()));
    let printed: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(printed["files"], report(&folder, "saddle")["files"]);
}

/// Without pictures, which take the most time and are looked at elsewhere.
#[track_caller]
fn run_quickly(folder: &Folder, line: &str) {
    let draws = !line.contains(" check ") && !line.contains("--picture");
    run_line(folder, line, if draws { &["--picture", "none"] } else { &[] });
}

#[test]
fn the_examples_of_the_help_run() {
    let folder = workplace("ruled-help", "ruled");
    for command in [
        &["ruled", "--help"][..],
        &["ruled", "field", "--help"],
        &["ruled", "check", "--help"],
        &["ruled", "planks", "--help"],
    ] {
        let help = Command::new(env!("CARGO_BIN_EXE_shapeop")).args(command).env("COLUMNS", "300").output().unwrap();
        let text = said(&help);
        let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("  shapeop ")).collect();
        assert!(text.contains("Examples:") && !lines.is_empty(), "{command:?}");
        for line in lines {
            // An example and, some spaces further, what it does.
            let line = line.trim().split("    ").next().unwrap();
            run_quickly(&folder, line);
        }
    }
}

#[test]
fn the_commands_of_the_documentation_run() {
    let folder = workplace("ruled-docs", "ruled");
    let lines = commands_of("docs/ruled.md");
    assert!(lines.len() >= 10, "{}", lines.len());
    for line in lines {
        run_quickly(&folder, &line);
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_the_optimisation_and_writes_what_was_reached() {
    use std::time::Duration;

    use program::interrupt;

    let folder = Folder::new("ruled-interrupt");
    let out = folder.path("out");
    let (roof, folder_out) = (example("roof.obj"), out.display().to_string());
    let arguments = ["ruled", &roof, "--levels", "40", "--control-points", "60", "--tolerance", "0"];
    let ends = ["--iterations", "100000", "--picture", "none", "-o", &folder_out];
    interrupt(&[&arguments[..], &ends].concat(), None, Duration::from_millis(2500));
    let report = read_json(&out.join("roof.ruled.json"));
    assert_eq!(
        (&report["optimisation"]["stop"], &report["was_interrupted"]),
        (&"stopped with Ctrl-C".into(), &true.into())
    );
    let warnings = report["warnings"].as_array().unwrap();
    assert!(warnings.iter().any(|warning| warning.as_str().unwrap().contains("best so far")), "{warnings:?}");
    assert!(out.join("roof.ruled.strips.json").exists());
}
