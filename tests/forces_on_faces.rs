//! Forces on faces: balance, direction, time steps and refusals, with forces and tensions computed anew by the tests.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use glam::DVec3;
use shapeop::error::Status;
use shapeop::problem::{Acceleration, Faces, Force};
use shapeop::solver::{Outcome, Report, SolveOptions, Solver};

/// The octahedron of radius 1; its faces' normals point outwards.
fn octahedron() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let points = vec![DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let faces = vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    (points, faces)
}

/// The octahedron with every triangle cut into four, `level` times, on the unit sphere.
fn sphere(level: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut points, mut faces) = octahedron();
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in faces {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    points.push((points[a as usize] + points[b as usize]).normalize());
                    points.len() as u32 - 1
                })
            });
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = finer;
    }
    (points, faces)
}

fn edges(faces: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let all = faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    all.filter(|[a, b]| a < b).collect()
}

/// Closed triangles held together by `EdgeStrain` of weight 1, and nothing else.
fn balloon((points, faces): &(Vec<DVec3>, Vec<[u32; 3]>)) -> Solver {
    let mut solver = Solver::new();
    solver.set_points(points).unwrap();
    for edge in edges(faces) {
        solver.add_constraint("EdgeStrain", &edge, 1.0).unwrap();
    }
    solver
}

fn solve(solver: &mut Solver, max_iterations: u32) -> Report {
    let options = SolveOptions { max_iterations, tolerance: 1e-14, time_budget_seconds: 0.0 };
    solver.solve_until(&options, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// The sum of pressure and tension on each point: a third of `p` times the area of each triangle along its normal, and
/// `(‖e‖ − L)/L` along each edge, `L` being its rest length.
fn residual(points: &[DVec3], rest: &[DVec3], faces: &[[u32; 3]], pressure: f64) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; points.len()];
    for face in faces {
        let [a, b, c] = face.map(|i| points[i as usize]);
        let third = pressure / 6.0 * (b - a).cross(c - a);
        face.iter().for_each(|&i| sums[i as usize] += third);
    }
    for [a, b] in edges(faces).into_iter().map(|edge| edge.map(|i| i as usize)) {
        let (edge, length) = (points[b] - points[a], rest[a].distance(rest[b]));
        let tension = (edge.length() / length - 1.0) * edge.normalize();
        sums[a] += tension;
        sums[b] -= tension;
    }
    sums
}

fn largest(vectors: &[DVec3]) -> f64 {
    vectors.iter().map(|vector| vector.length()).fold(0.0, f64::max)
}

#[test]
fn an_octahedron_grows_until_tension_balances_pressure() {
    // On each corner pressure pushes outwards by ⅔ p r², and four edges pull by (r − 1) at 45°: 2√2 (r − 1) = ⅔ p r².
    let pressure = 0.5;
    let (a, b) = (2.0 / 3.0 * pressure, 8.0_f64.sqrt());
    let radius = (b - (b * b - 4.0 * a * b).sqrt()) / (2.0 * a);
    let model = octahedron();
    for acceleration in [Acceleration::None, Acceleration::QuasiNewton, Acceleration::Anderson] {
        let mut solver = balloon(&model);
        solver.set_acceleration(acceleration, 0).unwrap();
        let faces: Faces = model.1.iter().collect();
        let id = solver.add_force(Force::Pressure { pressure: 9.0, faces }).unwrap();
        solver.edit_force_magnitude(id, pressure).unwrap();
        solver.init().unwrap();
        let report = solve(&mut solver, 5000);
        assert_eq!(report.outcome, Outcome::Converged);
        for (point, axis) in solver.points().iter().zip(&model.0) {
            assert!(point.distance(radius * *axis) < 1e-11, "{point} is not at the radius {radius}");
        }
        // Plain iterations, whatever was asked for.
        assert_eq!((report.evaluations, report.rejections), (report.iterations, Default::default()));
        // 12 edges of length √2, and −p times the volume 4/3 r³.
        let energy = 0.5 * 12.0 * 2.0_f64.sqrt() * (radius - 1.0).powi(2) - pressure * 4.0 / 3.0 * radius.powi(3);
        assert!((report.energy_after - energy).abs() < 1e-12 && (solver.energy() - energy).abs() < 1e-12);
    }
}

#[test]
fn a_sphere_grows_until_tension_balances_pressure_everywhere() {
    let model = sphere(3);
    let mut solver = balloon(&model);
    let pressure = 0.4;
    solver.add_force(Force::Pressure { pressure, faces: model.1.iter().collect() }).unwrap();
    solver.init().unwrap();
    let before = largest(&residual(&model.0, &model.0, &model.1, pressure));
    let report = solve(&mut solver, 20_000);
    let (points, after) = (solver.points(), residual(solver.points(), &model.0, &model.1, pressure));
    let grown = points.iter().map(|point| point.length()).sum::<f64>() / points.len() as f64;
    println!(
        "sphere of {} points: {} iterations, mean radius {grown:.4}, residual {before:.1e} to {:.1e}",
        points.len(),
        report.iterations,
        largest(&after)
    );
    assert!(grown > 1.01 && largest(&after) < 1e-9 * before, "{} of {before}", largest(&after));
    // The forces on a closed surface add up to nothing: it stayed where it was.
    assert!(points.iter().sum::<DVec3>().length() < 1e-9);
    // Its energy is least there: moving any point along any axis changes it in the second order only.
    let found = solver.points().to_vec();
    for (i, axis) in [(0, DVec3::X), (7, DVec3::Y), (40, DVec3::ONE), (100, DVec3::Z)] {
        let mut energy_at = |h: f64| {
            let mut points = found.clone();
            points[i] += h * axis;
            solver.set_points(&points).unwrap();
            solver.energy()
        };
        let slope = (energy_at(1e-5) - energy_at(-1e-5)) / 2e-5;
        assert!(slope.abs() < 1e-8, "point {i}: {slope}");
    }
}

/// The moves of free points in a first time step of length 1 without iterations: the forces themselves.
fn forces_on(points: &[DVec3], force: Force) -> Vec<DVec3> {
    let mut solver = Solver::new();
    solver.set_points(points).unwrap();
    solver.add_force(force).unwrap();
    solver.init_dynamic(1.0, 1.0, 1.0).unwrap();
    solver.solve(0).unwrap();
    solver.points().iter().zip(points).map(|(x, start)| *x - *start).collect()
}

#[test]
fn on_a_sphere_forces_are_radial() {
    for level in [3, 4, 5] {
        let (points, triangles) = sphere(level);
        let faces: Faces = triangles.iter().collect();
        let pressures = forces_on(&points, Force::Pressure { pressure: 1.0, faces: faces.clone() });
        let normals = forces_on(&points, Force::Normal { magnitude: 0.25, faces });
        let worst = |forces: &[DVec3]| {
            let off = |(force, radius): (&DVec3, &DVec3)| force.normalize().cross(*radius).length();
            forces.iter().zip(&points).map(off).fold(0.0, f64::max)
        };
        // The arc between neighbours. Triangles around a point that are not alike leave an error of its first order.
        let arc = std::f64::consts::FRAC_PI_2 / 2_f64.powi(level as i32);
        let [pressure_off, normal_off] = [worst(&pressures), worst(&normals)];
        println!(
            "sphere of {} points, arc {arc:.3}: pressures off the radius by {pressure_off:.1e}, normals by {normal_off:.1e}",
            points.len()
        );
        assert!(pressure_off < 0.3 * arc && normal_off < 0.3 * arc);
        let radial = |(force, radius): (&DVec3, &DVec3)| force.dot(*radius);
        let outward: f64 = pressures.iter().zip(&points).map(radial).sum();
        // Moved along the radii they do work at three times the volume, which tends to that of the ball.
        let sixth = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|i| points[i as usize]);
            a.dot(b.cross(c)) / 6.0
        };
        let volume: f64 = triangles.iter().map(sixth).sum();
        assert!((outward - 3.0 * volume).abs() < 1e-12, "{outward} is not three times {volume}");
        assert!((outward / (4.0 * std::f64::consts::PI) - 1.0).abs() < arc * arc, "{outward}");
        assert!(normals.iter().all(|force| (force.length() - 0.25).abs() < 1e-14));
        for forces in [pressures, normals] {
            assert!(forces.iter().sum::<DVec3>().length() < 1e-12);
        }
    }
}

#[test]
fn a_time_step_ends_where_the_forces_are_those_at_its_end() {
    // Without constraints r' = 1 + δ² ⅔ p r'², solved for the lesser root.
    let (points, triangles) = octahedron();
    let (pressure, step) = (0.3, 0.5);
    let mut solver = Solver::new();
    solver.set_points(&points).unwrap();
    let id = solver.add_force(Force::Pressure { pressure, faces: triangles.iter().collect() }).unwrap();
    solver.init_dynamic(2.0, 1.0, step).unwrap();
    solver.solve(60).unwrap();
    let a = step * step * 2.0 / 3.0 * pressure;
    let radius = (1.0 - (1.0 - 4.0 * a).sqrt()) / (2.0 * a);
    for (point, axis) in solver.points().iter().zip(&points) {
        assert!(point.distance(radius * *axis) < 1e-14, "{point} is not at the radius {radius}");
    }
    // Then they fly on with the velocity that they have: (r' − 1)/δ.
    solver.remove_force(id).unwrap();
    solver.solve(3).unwrap();
    assert!(solver.points()[0].distance((2.0 * radius - 1.0) * DVec3::X) < 1e-14);
}

#[test]
fn a_balloon_under_gravity_rests_on_its_anchor() {
    // Steady forces and those on faces act together: the anchor carries the weight, which pressure does not change.
    let model = sphere(1);
    let mut solver = balloon(&model);
    let anchor = solver.add_constraint("Closeness", &[4], 10.0).unwrap();
    solver.add_force(Force::Gravity(-1e-3 * DVec3::Z)).unwrap();
    solver.add_force(Force::Pressure { pressure: 0.3, faces: model.1.iter().collect() }).unwrap();
    solver.init().unwrap();
    solve(&mut solver, 50_000);
    let weight = 1e-3 * model.0.len() as f64;
    let carried = 10.0 * solver.violations()[anchor];
    assert!((carried - weight).abs() < 1e-8 * weight, "{carried} of {weight}");
}

#[test]
fn what_no_constraint_resists_is_refused_and_nothing_moves() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let faces: Faces = [[0, 1, 2]].iter().collect();
    for force in [
        Force::Pressure { pressure: 1.0, faces: faces.clone() },
        Force::Normal { magnitude: 1.0, faces: faces.clone() },
    ] {
        let mut solver = Solver::new();
        solver.set_points(&points).unwrap();
        for edge in [[0, 1], [1, 2], [2, 0]] {
            solver.add_constraint("EdgeStrain", &edge, 1.0).unwrap();
        }
        solver.add_force(force).unwrap();
        solver.init().unwrap();
        assert_eq!(solver.solve(5).unwrap_err().status(), Status::Unbounded);
        assert_eq!(solve(&mut solver, 5).outcome, Outcome::Unbounded);
        assert_eq!(solver.points(), points);
    }
}

#[test]
fn a_pressure_beyond_what_tension_can_balance_stays_finite_or_is_refused() {
    let model = octahedron();
    let mut solver = balloon(&model);
    solver.add_force(Force::Pressure { pressure: 1e3, faces: model.1.iter().collect() }).unwrap();
    solver.init().unwrap();
    let mut last = solver.points().to_vec();
    for _ in 0..50 {
        match solver.solve(20) {
            Ok(()) => last = solver.points().to_vec(),
            Err(error) => assert_eq!((error.status(), solver.points()), (Status::InvalidValue, last.as_slice())),
        }
        assert!(solver.points().iter().all(|point| point.is_finite()));
    }
}

#[test]
fn edits_and_points_that_do_not_fit_are_refused_by_name() {
    let mut solver = Solver::new();
    solver.set_points(&octahedron().0).unwrap();
    let faces: Faces = octahedron().1.iter().collect();
    let gravity = solver.add_force(Force::Gravity(DVec3::Z)).unwrap();
    let pressure = solver.add_force(Force::Pressure { pressure: 1.0, faces: faces.clone() }).unwrap();
    let says = |error: shapeop::error::Error| error.to_string();
    let wrong = says(solver.edit_force_magnitude(gravity, 1.0).unwrap_err());
    assert_eq!(wrong, "force id: force 0 is gravity, not a pressure or a normal force");
    let wrong = says(solver.edit_vertex_force(pressure, DVec3::X, 0).unwrap_err());
    assert_eq!(wrong, "force id: force 1 is a pressure, not a vertex force");
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(solver.edit_force_magnitude(pressure, bad).unwrap_err().place(), "magnitude");
        assert_eq!(
            solver.add_force(Force::Normal { magnitude: bad, faces: faces.clone() }).unwrap_err().place(),
            "magnitude"
        );
    }
    let fewer = says(solver.set_points(&[DVec3::ZERO; 5]).unwrap_err());
    assert!(fewer.contains("expected more than 5, as force 1 refers to it"), "{fewer}");
    solver.remove_force(pressure).unwrap();
    assert!(says(solver.edit_force_magnitude(pressure, 1.0).unwrap_err()).contains("force 1 was removed"));
    solver.set_points(&[DVec3::ZERO; 5]).unwrap();
}
