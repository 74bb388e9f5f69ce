//! `shapeop snake` as a user meets it: truths on cylinders, spheres and linkages, its files measured anew with code of their own.

mod program;

use std::f64::consts::{PI, TAU};
use std::process::Command;

use glam::DVec3;
use serde_json::Value;
use shapeop::mesh::patterns::parametric_surface;
use shapeop::mesh::{ClosestPoints, Mesh, file};

use program::{
    Folder, commands_of, json as read_json, obj, png_size, repository, run_line, said, shapeop, shapeop_into, workplace,
};

fn example(name: &str) -> String {
    repository().join("examples/snakes").join(name).display().to_string()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn vector(value: &Value) -> DVec3 {
    DVec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

fn vectors(value: &Value) -> Vec<DVec3> {
    value.as_array().unwrap().iter().map(vector).collect()
}

fn run(folder: &Folder, arguments: &[&str]) -> String {
    said(&shapeop_into(folder, &[&["snake"], arguments, &["--picture", "none"]].concat()))
}

/// An arc as its file states it.
struct Arc {
    center: DVec3,
    radius: f64,
    axis: DVec3,
    start: DVec3,
    angle: f64,
}

impl Arc {
    /// The point after a part of the angle, and the unit tangent there, by Rodrigues' formula.
    fn at(&self, part: f64) -> (DVec3, DVec3) {
        let (sine, cosine) = (part * self.angle).sin_cos();
        let out = self.start - self.center;
        let turned = cosine * out + sine * self.axis.cross(out);
        (self.center + turned, self.axis.cross(turned) / self.radius)
    }
}

fn arcs(frame: &Value) -> Vec<Arc> {
    let arc = |arc: &Value| Arc {
        center: vector(&arc["center"]),
        radius: number(&arc["radius"]),
        axis: vector(&arc["axis"]),
        start: vector(&arc["start"]),
        angle: number(&arc["angle_rad"]),
    };
    frame["arcs"].as_array().unwrap().iter().map(arc).collect()
}

/// The arcs of each position.
fn positions(folder: &Folder, name: &str) -> Vec<Vec<Arc>> {
    let form = read_json(&folder.path(&format!("{name}.arcs.json")));
    form["frames"].as_array().unwrap().iter().map(arcs).collect()
}

/// By how much arcs that follow each other miss smoothness: gaps, and the sines of angles between tangents.
fn roughness(arcs: &[Arc], is_closed: bool) -> f64 {
    let pairs = if is_closed { arcs.len() } else { arcs.len() - 1 };
    let pair = |j: usize| {
        let ((p, t), (q, u)) = (arcs[j].at(1.0), arcs[(j + 1) % arcs.len()].at(0.0));
        p.distance(q).max(t.distance(u))
    };
    (0..pairs).map(pair).fold(0.0, f64::max)
}

/// A mesh of the cylinder of radius 2 about z, and all around.
fn cylinder(columns: usize, rows: usize) -> Mesh {
    let at = |i: usize, j: usize| {
        let (sine, cosine) = (TAU * i as f64 / columns as f64).sin_cos();
        DVec3::new(2.0 * cosine, 2.0 * sine, 6.0 * j as f64 / (rows - 1) as f64)
    };
    let points = (0..rows).flat_map(|j| (0..columns).map(move |i| at(i, j))).collect();
    let quad = |i: usize, j: usize| {
        let [a, b] = [j * columns + i, j * columns + (i + 1) % columns].map(|k| k as u32);
        let up = columns as u32;
        vec![a, b, b + up, a + up]
    };
    Mesh { points, faces: (0..rows - 1).flat_map(|j| (0..columns).map(move |i| quad(i, j))).collect() }
}

#[test]
fn a_snake_along_a_cylinder_moves_rigidly() {
    let folder = Folder::new("snakes-cylinder");
    let mesh = folder.write("cylinder.obj", &obj(&cylinder(90, 31)));
    // A helix of slope 1 has the curvature cos² 45° / 2 = 1/4: this one turns away from it.
    let start = ["--from", "2,0,1", "--toward", "0,1,1", "--curvature", "0.3", "--length", "3", "--arcs", "4"];
    let given = ["evolve", &mesh, "--along", "0,0,1", "--speed", "2", "--step", "0.05", "--steps", "12"];
    let text = run(&folder, &[&given[..], &start].concat());
    assert!(text.contains("all steps were taken"), "{text}");
    let found = positions(&folder, "cylinder.evolve");
    assert_eq!(found.len(), 13);
    for (i, arcs) in found.iter().enumerate() {
        assert!(roughness(arcs, false) < 1e-9, "{}", roughness(arcs, false));
        for (arc, first) in arcs.iter().zip(&found[0]) {
            assert!((arc.radius - 1.0 / 0.3).abs() < 1e-9 && (arc.radius * arc.angle - 0.75).abs() < 1e-2);
            for part in [0.0, 0.5, 1.0] {
                let way = arc.at(part).0 - first.at(part).0;
                assert!(way.distance(DVec3::new(0.0, 0.0, 0.1 * i as f64)) < 1e-6, "{i}: {way}");
                let (p, _) = arc.at(part);
                assert!((p.truncate().length() - 2.0).abs() < 1e-2, "{p}");
            }
        }
    }
    let report = read_json(&folder.path("cylinder.evolve.json"));
    assert_eq!((&report["stop"]["reason"], &report["evolution"]["motion"]["way"]), (&"steps".into(), &"along".into()));
    assert!(number(&report["measures"]["kept"]["congruence_rms"]) < 1e-6);
    // The mesh: 13 rows of 4 arcs with 8 intervals each.
    let swept = file::read(folder.path("cylinder.evolve.obj")).unwrap();
    assert_eq!((swept.points.len(), swept.faces.len()), (13 * 33, 12 * 32));
    for (i, arcs) in found.iter().enumerate() {
        for k in 0..32 {
            let expected = arcs[k / 8].at((k % 8) as f64 / 8.0).0;
            assert!(swept.points[33 * i + k].distance(expected) < 1e-9);
        }
    }
}

#[test]
fn a_closed_snake_climbs_a_cylinder() {
    let folder = Folder::new("snakes-climb");
    let mesh = folder.write("tube.obj", &obj(&cylinder(120, 13)));
    let given = ["evolve", &mesh, "--section", "0,0,1,1.25", "--arcs", "9", "--along", "0,0,1", "--steps", "10"];
    run(&folder, &[&given[..], &["--step", "0.1", "--speed", "1"]].concat());
    let found = positions(&folder, "tube.evolve");
    assert_eq!(found.len(), 11);
    let length: f64 = found[0].iter().map(|arc| arc.radius * arc.angle).sum();
    assert!((length / (2.0 * TAU) - 1.0).abs() < 1e-2, "{length}");
    for (i, arcs) in found.iter().enumerate() {
        assert!(roughness(arcs, true) < 1e-9);
        for arc in arcs {
            assert!((arc.radius - 2.0).abs() < 2e-2, "{}", arc.radius);
            let (p, _) = arc.at(0.5);
            assert!((p.z - 1.25 - 0.1 * i as f64).abs() < 1e-6 && (p.truncate().length() - 2.0).abs() < 5e-3, "{p}");
        }
    }
    // What is flat and convex turns around once, and stays so (Fenchel): through the narrower part of a cone it does not go.
    let cone = |u: f64, v: f64| DVec3::new((3.0 - v) * u.cos(), (3.0 - v) * u.sin(), v);
    let mut cone = parametric_surface(73, 11, [0.0, TAU], [0.0, 2.0], cone).unwrap();
    cone.faces.iter_mut().flatten().for_each(|i| *i = *i / 73 * 72 + *i % 73 % 72);
    let keep = |i: &usize| i % 73 != 72;
    cone.points = (0..cone.points.len()).filter(keep).map(|i| cone.points[i]).collect();
    let mesh = folder.write("cone.obj", &obj(&cone));
    let given = ["evolve", &mesh, "--section", "0,0,1,0.5", "--arcs", "9", "--along", "0,0,1"];
    let text = run(&folder, &[&given[..], &["--orthogonal-weight", "0.01"]].concat());
    for part in ["it moves no more", "warning: the snake is flat and convex", "warning: there is one position only"] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    assert_eq!(positions(&folder, "cone.evolve").len(), 1);
    assert!(!folder.path("cone.evolve.obj").exists() && folder.path("cone.evolve.start.json").exists());
}

#[test]
fn a_wavy_closed_snake_climbs_a_tower_of_changing_sections() {
    let folder = Folder::new("snakes-tower");
    let (tower, wave) = (example("tower.obj"), example("wave.json"));
    let given = ["evolve", &tower, "--curve", &wave, "--arcs", "16", "--along", "0,0,1", "--max-deviation", "0.06"];
    let text = run(&folder, &given);
    assert!(text.contains("--max-deviation allows more"), "{text}");
    let report = read_json(&folder.path("tower.evolve.json"));
    let covering = &report["measures"]["covering"];
    assert!(number(&covering["reference"]["coverage"]) > 0.5, "{text}");
    let frames = report["evolution"]["frames"].as_array().unwrap();
    assert!(frames.iter().all(|frame| number(&frame["deviation"]) <= 0.06));
    // Its arcs turn against each other a lot, and are what they were.
    assert!(number(&report["measures"]["kept"]["torsion_deg"]) > 30.0);
    let mesh = file::read(&tower).unwrap();
    let triangles: Vec<[u32; 3]> = mesh.faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    let closest = ClosestPoints::of_triangles(&mesh.points, &triangles).unwrap();
    let found = positions(&folder, "tower.evolve");
    for arcs in &found {
        assert!(roughness(arcs, true) < 1e-9);
        for (arc, first) in arcs.iter().zip(&found[0]) {
            assert!((arc.radius - first.radius).abs() < 1e-12 && (arc.angle - first.angle).abs() < 1e-12);
            let (p, _) = arc.at(0.5);
            assert!(closest.nearest(p).distance(p) < 0.06 + 2e-3, "{p}");
        }
    }
    let rise = found[found.len() - 1][0].start.z - found[0][0].start.z;
    assert!(rise > 2.0, "{rise}");
}

#[test]
fn a_snake_on_a_sphere_stays_on_it_and_files_agree() {
    let folder = Folder::new("snakes-sphere");
    let at = |u: f64, v: f64| 3.0 * DVec3::new(u.cos() * v.cos(), u.sin() * v.cos(), v.sin());
    let sphere = parametric_surface(61, 41, [0.0, 2.4], [-0.8, 0.8], at).unwrap();
    let mesh = folder.write("sphere.obj", &obj(&sphere));
    let start = ["--from", "2.5,1.2,-1", "--toward", "0,0,1", "--curvature", "0.5", "--length", "2", "--arcs", "5"];
    let more =
        ["--step", "0.04", "--steps", "20", "--max-deviation", "0.05", "--every", "3", "--frames", "--format", "ply"];
    let coverings = ["--pipes", "0.05", "--lamellae", "0.2", "--right"];
    let text = run(&folder, &[&["evolve", mesh.as_str()][..], &start, &more, &coverings].concat());
    let report = read_json(&folder.path("sphere.evolve.json"));
    let frames = report["evolution"]["frames"].as_array().unwrap();
    assert!(frames.len() > 10, "{text}");
    let steps = frames.len() - 1;
    let found = positions(&folder, "sphere.evolve");
    assert_eq!(found.len(), steps / 3 + 1 + usize::from(!steps.is_multiple_of(3)));
    let triangles: Vec<[u32; 3]> = sphere.faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    let closest = ClosestPoints::of_triangles(&sphere.points, &triangles).unwrap();
    for (k, arcs) in found.iter().enumerate() {
        let told = number(&frames[(3 * k).min(steps)]["deviation"]);
        let points = arcs.iter().flat_map(|arc| [0.0, 0.5, 1.0].map(|part| arc.at(part).0));
        let mut most = 0.0_f64;
        for p in points {
            assert!((p.length() - 3.0).abs() < 2e-2, "{p}");
            most = most.max(closest.nearest(p).distance(p));
        }
        // Quads are split along their shorter diagonals there, here along the first.
        assert!((most - told).abs() < 2e-3, "{most} {told}");
        assert!(arcs.iter().all(|arc| (arc.radius - 2.0).abs() < 1e-3) && roughness(arcs, false) < 1e-9);
    }
    // The tables and the drawing say the same.
    let table = std::fs::read_to_string(folder.path("sphere.evolve.arcs.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 5 * found.len());
    let parts = std::fs::read_to_string(folder.path("sphere.evolve.parts.csv")).unwrap();
    let rows: Vec<&str> = parts.lines().skip(1).collect();
    assert_eq!(rows.len(), 1, "{parts}");
    assert!(rows[0].ends_with(&format!(",{}", 5 * found.len())), "{parts}");
    let drawing = std::fs::read_to_string(folder.path("sphere.evolve.arcs.dxf")).unwrap().replace("\r\n", "\n");
    let drawn = drawing.lines().collect::<Vec<_>>().windows(2).filter(|w| w[0].trim() == "0" && w[1] == "ARC").count();
    assert_eq!(drawn, 5 * found.len());
    // Positions as polylines, pipes and lamellae at their distances.
    let names = folder.files();
    assert_eq!(names.iter().filter(|name| name.contains(".frame-")).count(), found.len());
    let first = std::fs::read_to_string(folder.path("sphere.evolve.frame-000.obj")).unwrap();
    assert_eq!((first.matches("v ").count(), first.matches("\nl ").count()), (41, 1));
    let pipes = file::read(folder.path("sphere.evolve.pipes.ply")).unwrap();
    assert_eq!(pipes.points.len(), found.len() * 41 * 12);
    let lamellae = file::read(folder.path("sphere.evolve.lamellae.ply")).unwrap();
    for k in 0..found.len() {
        let row = |side: usize, j: usize| lamellae.points[(2 * k + side) * 41 + j];
        for j in 0..41 {
            assert!((row(0, j).distance(row(1, j)) - 0.2).abs() < 1e-9 && row(1, j).length() > 3.15);
        }
    }
}

#[test]
fn a_fixed_end_stays_and_the_snake_turns_about_it() {
    let folder = Folder::new("snakes-fixed");
    let flat = parametric_surface(21, 21, [-5.0, 5.0], [-5.0, 5.0], |u, v| DVec3::new(u, v, 0.0)).unwrap();
    let mesh = folder.write("plane.obj", &obj(&flat));
    let start = ["--from", "0,0", "--toward", "1,0", "--curvature", "0.5", "--length", "2", "--arcs", "4"];
    run(
        &folder,
        &[&["evolve", mesh.as_str()][..], &start, &["--fix", "start", "--speed", "0,1", "--steps", "15"]].concat(),
    );
    let found = positions(&folder, "plane.evolve");
    let end = |arcs: &[Arc]| arcs[3].at(1.0).0;
    let chord = end(&found[0]).length();
    for arcs in &found {
        assert!(arcs[0].at(0.0).0.length() < 1e-9, "the fixed end moves");
        // In a plane all arcs turn as one.
        assert!((end(arcs).length() - chord).abs() < 1e-6);
    }
    assert!(end(&found[15]).distance(end(&found[0])) > 0.3);
    // The mirror image, by turning the other way.
    let text = run(
        &folder,
        &[&["evolve", mesh.as_str()][..], &start, &["--turn", "right", "--right", "--steps", "3"]].concat(),
    );
    assert!(text.contains("radius 2.000"), "{text}");
    assert!(end(&positions(&folder, "plane.evolve")[0]).distance(end(&found[0]) * DVec3::new(1.0, -1.0, 1.0)) < 1e-6);
}

#[test]
fn rails_with_one_between_give_a_kinematic_surface() {
    let folder = Folder::new("snakes-rails");
    let [a, b, c, rung] = ["rail_a.csv", "rail_b.csv", "rail_c.csv", "rung.csv"].map(example);
    let given = ["sweep", &a, &b, &c, "--curve", &rung, "--arcs", "6", "--snap"];
    let text = run(&folder, &given);
    assert!(text.contains("rail_a.csv: it ends") && text.contains("congruent to"), "{text}");
    let form = read_json(&folder.path("rail_a.sweep.arcs.json"));
    let frames: Vec<Vec<DVec3>> =
        form["frames"].as_array().unwrap().iter().map(|frame| vectors(&frame["control"])).collect();
    assert!(frames.len() > 20);
    let last = frames[0].len() - 1;
    for control in &frames {
        for i in 0..=last {
            for j in 0..i {
                let change = control[i].distance(control[j]) - frames[0][i].distance(frames[0][j]);
                assert!(change.abs() < 1e-9, "{i} {j}: {change}");
            }
        }
    }
    let report = read_json(&folder.path("rail_a.sweep.json"));
    assert_eq!(report["measures"]["kept"]["congruent_positions"], frames.len());
    // The third rail is met all along: the nearest point of the swept surface's rows.
    let swept = file::read(folder.path("rail_a.sweep.obj")).unwrap();
    let moved = number(&report["evolution"]["rails"][2]["moved"]);
    let rail = std::fs::read_to_string(&c).unwrap();
    let rail: Vec<DVec3> = rail
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| DVec3::from_slice(&line.split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()))
        .collect();
    let polyline = ClosestPoints::of_polyline(&rail, false).unwrap();
    for row in swept.points.chunks(49) {
        let apart = row.iter().map(|p| polyline.nearest(*p).distance(*p)).fold(f64::INFINITY, f64::min);
        assert!(apart <= moved + 0.1, "{apart}");
    }
    // Without the rail between, the ends still keep their distance; driven both, they do not.
    run(&folder, &["sweep", &a, &b, "--curve", &rung, "--arcs", "6", "--snap", "--flexible"]);
    let ends = |folder: &Folder| -> Vec<f64> {
        let form = read_json(&folder.path("rail_a.sweep.arcs.json"));
        let ends = |frame: &Value| {
            let control = vectors(&frame["control"]);
            control[0].distance(control[control.len() - 1])
        };
        form["frames"].as_array().unwrap().iter().map(ends).collect()
    };
    let kept = ends(&folder);
    assert!(kept.iter().all(|apart| (apart - kept[0]).abs() < 1e-8) && kept.len() > 20);
    run(&folder, &["sweep", &a, &b, "--curve", &rung, "--arcs", "6", "--snap", "--drive-both"]);
    let driven = ends(&folder);
    assert!(driven.iter().any(|apart| (apart - driven[0]).abs() > 1e-3));
}

#[test]
fn a_linkage_closes_and_rocks_as_is_known() {
    let folder = Folder::new("snakes-linkage");
    let arcs = example("six_arcs.json");
    let text = run(&folder, &["linkage", &arcs, "--copies", "3", "--offset", "0,2,0"]);
    assert!(text.contains("it came back to its start"), "{text}");
    let report = read_json(&folder.path("six_arcs.linkage.json"));
    let linkage = &report["linkage"];
    assert!(number(&linkage["closing"]) < 1e-8 && linkage["freedoms"] == 1);
    // 1.1605 and 1.8245 radians.
    let range = |k: usize| number(&linkage["ranges_deg"][k]).to_radians();
    assert!((range(0) - 1.1605).abs() < 2e-3 && (range(1) - 1.8245).abs() < 2e-3);
    assert_eq!(linkage["turns"], serde_json::json!([0, 0]));
    let start = read_json(&folder.path("six_arcs.linkage.start.json"));
    let last = vectors(&start["control"])[7];
    assert!(last.distance(DVec3::new(-0.356912243, -0.054958131, 0.607451979)) < 1e-8, "{last}");
    let found = positions(&folder, "six_arcs.linkage");
    for arcs in &found {
        assert!(roughness(arcs, false) < 1e-9);
        assert!(arcs.iter().all(|arc| (arc.radius - 1.0).abs() < 1e-12 && (arc.angle - PI / 3.0).abs() < 1e-12));
        assert!(arcs[5].at(1.0).0.distance(last) < 1e-9, "the last hinge moves");
    }
    // The surface closes: as many rows of quads as positions.
    let swept = file::read(folder.path("six_arcs.linkage.obj")).unwrap();
    assert_eq!((swept.points.len(), swept.faces.len()), (found.len() * 49, found.len() * 48));
    // Three copies a third of the motion apart, 2 from each other.
    let array = std::fs::read_to_string(folder.path("six_arcs.linkage.array.obj")).unwrap();
    let lines: Vec<DVec3> = array
        .lines()
        .filter_map(|line| line.strip_prefix("v "))
        .map(|line| DVec3::from_slice(&line.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()))
        .collect();
    assert_eq!((lines.len(), array.matches("\nl ").count()), (3 * 49, 3));
    let middles = [24, 49 + 24, 98 + 24].map(|i| lines[i]);
    assert!(
        lines[49].distance(lines[0] + 2.0 * DVec3::Y) < 1e-9 && lines[98].distance(lines[0] + 4.0 * DVec3::Y) < 1e-9
    );
    assert!((middles[1] - 2.0 * DVec3::Y).distance(middles[0]) > 0.05);
    // The same arcs by options, and the other way around.
    let torsions = [1.0_f64, -0.7, 0.9, -0.8, 0.6].map(|torsion| torsion.to_degrees().to_string()).join(",");
    run(&folder, &["linkage", "--radius", "1", "--angle", "60", "--torsions", &torsions, "--reverse", "--step", "2"]);
    let other = read_json(&folder.path("arcs.linkage.json"));
    for k in 0..2 {
        assert!((number(&other["linkage"]["ranges_deg"][k]).to_radians() - range(k)).abs() < 2e-3);
    }
}

#[test]
fn arcs_of_a_circle_are_found_again() {
    let folder = Folder::new("snakes-fit");
    let at = |t: f64| 2.5 * DVec3::new(t.cos(), 0.6 * t.sin(), 0.8 * t.sin()) + DVec3::ONE;
    let row = |p: DVec3| format!("{},{},{}\n", p.x, p.y, p.z);
    let curve: String = (0..=60).map(|k| row(at(f64::from(k) * 0.035))).collect();
    let curve = folder.write("part.csv", &curve);
    run(&folder, &["fit", &curve, "--arcs", "3"]);
    let report = read_json(&folder.path("part.fit.json"));
    for k in 0..3 {
        assert!((number(&report["snake"]["radii"][k]) - 2.5).abs() < 1e-9);
        assert!((number(&report["snake"]["lengths"][k]) - 2.5 * 0.7).abs() < 1e-9);
    }
    assert!(number(&report["start"]["fit_deviation"]) < 1e-9);
    // A snake file goes on: check says the same, and evolve takes it.
    let snake = folder.path("part.fit.snake.json").display().to_string();
    let told: Value = serde_json::from_str(&said(&shapeop(&["snake", "check", &snake, "--json"]))).unwrap();
    assert_eq!(told["snake"]["radii"], report["snake"]["radii"]);
    assert_eq!(told["snake"]["freedoms"], 8);
    let text = said(&shapeop(&["snake", "check", &example("six_arcs.json")]));
    for part in ["an open snake of 6 arcs", "1 freedom\n", "-0.02295", "60.00°", "57.30°"] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    // Closed, around an ellipse: a chain that closes smoothly.
    run(&folder, &["fit", &example("ring.json"), "--arcs", "12"]);
    let form = read_json(&folder.path("ring.fit.snake.json"));
    assert_eq!((&form["closed"], form["control"].as_array().unwrap().len()), (&true.into(), 12));
    let report = read_json(&folder.path("ring.fit.json"));
    assert!(number(&report["start"]["fit_deviation"]) < 0.01 && number(&report["snake"]["residual"]) < 1e-9);
}

#[test]
fn curves_on_a_sphere_are_circles() {
    let folder = Folder::new("snakes-curve");
    let at = |u: f64, v: f64| 2.0 * DVec3::new(u.cos() * v.cos(), u.sin() * v.cos(), v.sin());
    let sphere = obj(&parametric_surface(61, 41, [0.0, 2.4], [-0.8, 0.8], at).unwrap());
    let mesh = folder.write("sphere.obj", &sphere);
    let given = [
        "curve",
        &mesh,
        "--from",
        "1.6,1.2,0",
        "--toward",
        "0,0,1",
        "--curvature",
        "1,0.8",
        "--length",
        "1.5",
        "--turn",
        "both",
    ];
    run(&folder, &given);
    let table = std::fs::read_to_string(folder.path("sphere.curve.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 4 * 201);
    for k in 0..4 {
        let points: Vec<DVec3> = rows[201 * k..201 * (k + 1)]
            .iter()
            .map(|row| DVec3::from_slice(&row[4..].iter().map(|x| x.parse().unwrap()).collect::<Vec<f64>>()))
            .collect();
        // The circle of a chord c and a sagitta s has the radius (c² / 4 + s²) / 2 s.
        let (a, b) = (points[0].midpoint(points[200]), points[100]);
        let (chord, sagitta) = (points[0].distance(points[200]), a.distance(b));
        let radius = (0.25 * chord * chord + sagitta * sagitta) / (2.0 * sagitta);
        let expected = if k < 2 { 1.0 } else { 1.25 };
        assert!((radius / expected - 1.0).abs() < 5e-3, "{k}: {radius}");
        assert!(points.iter().all(|p| (p.length() - 2.0).abs() < 1e-3));
    }
    let lines = std::fs::read_to_string(folder.path("sphere.curve.obj")).unwrap();
    assert_eq!(lines.matches("\nl ").count(), 4);
}

#[test]
fn pictures_and_animations_are_written() {
    let folder = Folder::new("snakes-pictures");
    let start = ["--from", "3,-1.5", "--toward", "0.3,1", "--curvature", "0.35", "--length", "3.6", "--arcs", "6"];
    let more = ["--steps", "4", "--strip", "--animation", "--pipes", "0.05", "--lamellae", "-0.1", "--flat"];
    said(&shapeop_into(&folder, &[&["snake", "evolve", &example("roof.obj")][..], &start, &more].concat()));
    for ending in ["", ".deviation", ".strip", ".pipes", ".lamellae"] {
        assert!(png_size(&folder.path(&format!("roof.evolve{ending}.png"))).0 >= 1280, "{ending}");
    }
    let frames = |name: &str| {
        let bytes = std::fs::read(folder.path(name)).unwrap();
        let mut decoder = gif::DecodeOptions::new().read_info(bytes.as_slice()).unwrap();
        assert_eq!(decoder.width(), 768);
        let mut count = 0;
        while decoder.read_next_frame().unwrap().is_some() {
            count += 1;
        }
        count
    };
    assert_eq!(frames("roof.evolve.gif"), 5);
    let report = read_json(&folder.path("roof.evolve.json"));
    let listed: Vec<&str> = report["files"].as_object().unwrap().values().map(|file| file.as_str().unwrap()).collect();
    assert_eq!(listed.len(), folder.files().len());
    let given = ["snake", "linkage", &example("six_arcs.json"), "--step", "10", "--picture", "svg"];
    said(&shapeop_into(&folder, &given));
    assert!(std::fs::read_to_string(folder.path("six_arcs.linkage.svg")).unwrap().contains("<polygon"));
    assert_eq!(said(&shapeop_into(&folder, &[&given[..], &["--quiet"]].concat())), "");
}

/// Without pictures, which take the most time and are looked at elsewhere.
#[track_caller]
fn run_quickly(folder: &Folder, line: &str) {
    let line = line.replace("--animation", "").replace("--strip", "");
    let draws = !line.contains(" check ") && !line.contains("--picture");
    run_line(folder, &line, if draws { &["--picture", "none"] } else { &[] });
}

#[test]
fn the_examples_of_the_help_run() {
    let folder = workplace("snakes-help", "snakes");
    run_quickly(&folder, "shapeop snake fit examples/snakes/arch.csv --arcs 5");
    for command in ["", "evolve", "sweep", "linkage", "fit", "curve", "check"] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_shapeop"));
        let help = program.arg("snake").args((!command.is_empty()).then_some(command)).arg("--help");
        let text = said(&help.env("COLUMNS", "300").output().unwrap());
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
    let folder = workplace("snakes-docs", "snakes");
    let (shell, meshes) = ("botanic-garden-bubble-0.obj", folder.path("examples/meshes"));
    std::fs::create_dir_all(&meshes).unwrap();
    std::fs::copy(repository().join("examples/meshes").join(shell), meshes.join(shell)).unwrap();
    let lines = commands_of("docs/snakes.md");
    assert!(lines.len() >= 10, "{}", lines.len());
    for line in lines {
        run_quickly(&folder, &line);
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_stops_the_motion_and_writes_what_was_reached() {
    use std::time::Duration;

    use program::interrupt;

    let folder = Folder::new("snakes-interrupt");
    let out = folder.path("out");
    let way = ["--from", "3,-1.5", "--toward", "0.3,1", "--curvature", "0.35", "--length", "3.6", "--arcs", "6"];
    let steps = ["--step", "1e-7", "--steps", "100000000", "--every", "1000", "--picture", "none", "-o"];
    let (roof, folder_out) = (example("roof.obj"), out.display().to_string());
    let arguments = [&["snake", "evolve", &roof], &way[..], &steps, &[&folder_out]].concat();
    interrupt(&arguments, None, Duration::from_millis(2000));
    let report = read_json(&out.join("roof.evolve.json"));
    assert_eq!((&report["stop"]["reason"], &report["was_interrupted"]), (&"cancelled".into(), &true.into()));
    assert!(report["evolution"]["frames"].as_array().unwrap().len() > 2);
    assert!(out.join("roof.evolve.arcs.json").exists() && out.join("roof.evolve.end.json").exists());
}
