//! Accelerated solves against plain ones.

use std::ops::ControlFlow;

use glam::DVec3;
use shapeop::error::Status;
use shapeop::problem::{Acceleration, Force, Problem};
use shapeop::solver::{Report, SolveOptions, Solver};

const BOTH: [Acceleration; 2] = [Acceleration::Anderson, Acceleration::QuasiNewton];

/// A wavy grid of `n × n` points with noise, a Plane per quad, a Closeness per point; not initialised.
fn grid(n: u32, closeness: f64) -> Solver {
    let noise = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24) - 0.5;
    let point = |i: u32| {
        let (x, y) = (f64::from(i % n), f64::from(i / n));
        DVec3::new(x, y, (0.5 * x).sin() + (0.3 * y).cos()) + 0.2 * DVec3::new(noise(i), noise(i + 7), noise(i + 31))
    };
    let mut solver = Solver::new();
    solver.set_points(&(0..n * n).map(point).collect::<Vec<_>>()).unwrap();
    for i in (0..n * (n - 1)).filter(|i| i % n + 1 < n) {
        solver.add_constraint("Plane", &[i, i + 1, i + n + 1, i + n], 1.0).unwrap();
    }
    for i in 0..n * n {
        solver.add_constraint("Closeness", &[i], closeness).unwrap();
    }
    solver
}

/// A cloth of `n × n` points, held at two corners, under gravity; in its first time steps.
fn cloth(n: u32) -> Solver {
    let mut solver = Solver::new();
    let point = |i: u32| DVec3::new(f64::from(i % n), f64::from(i / n), 0.1 * f64::from(i * i % 7));
    solver.set_points(&(0..n * n).map(point).collect::<Vec<_>>()).unwrap();
    for i in 0..n * n {
        if i % n + 1 < n {
            solver.add_constraint("EdgeStrain", &[i, i + 1], 50.0).unwrap();
        }
        if i / n + 1 < n {
            solver.add_constraint("EdgeStrain", &[i, i + n], 50.0).unwrap();
        }
    }
    for corner in [0, n - 1] {
        solver.add_constraint("Closeness", &[corner], 1000.0).unwrap();
    }
    solver.add_force(Force::Gravity(DVec3::new(0.0, 0.0, -1.0))).unwrap();
    solver.init_dynamic(1.0, 0.95, 1.0).unwrap();
    solver
}

fn until(solver: &mut Solver, max_iterations: u32, tolerance: f64) -> Report {
    let options = SolveOptions { max_iterations, tolerance, ..SolveOptions::default() };
    solver.solve_until(&options, &mut |_| ControlFlow::Continue(())).unwrap()
}

fn bits(points: &[DVec3]) -> Vec<[u64; 3]> {
    points.iter().map(|point| point.to_array().map(f64::to_bits)).collect()
}

#[test]
fn the_first_accelerated_step_is_the_plain_one() {
    for acceleration in BOTH {
        let [mut plain, mut accelerated] = [grid(9, 0.05), grid(9, 0.05)];
        accelerated.set_acceleration(acceleration, 0).unwrap();
        for solver in [&mut plain, &mut accelerated] {
            solver.init().unwrap();
            solver.solve(1).unwrap();
        }
        assert_eq!(bits(plain.points()), bits(accelerated.points()), "{acceleration:?}");
    }
}

#[test]
fn by_default_solve_is_plain_and_solve_until_is_quasi_newton() {
    let run = |acceleration: Option<Acceleration>, has_rules: bool| {
        let mut solver = grid(9, 0.05);
        if let Some(acceleration) = acceleration {
            solver.set_acceleration(acceleration, 0).unwrap();
        }
        solver.init().unwrap();
        if has_rules {
            until(&mut solver, 12, 0.0);
        } else {
            solver.solve(12).unwrap();
        }
        bits(solver.points())
    };
    assert!(run(None, false) == run(Some(Acceleration::None), false));
    assert!(run(None, true) == run(Some(Acceleration::QuasiNewton), true));
    assert!(run(None, true) != run(Some(Acceleration::None), true));
    // With an acceleration of their own both go the same way.
    for acceleration in BOTH {
        assert!(run(Some(acceleration), false) == run(Some(acceleration), true), "{acceleration:?}");
    }
}

#[test]
fn accelerated_solves_reach_the_energy_of_plain_ones_in_fewer_evaluations() {
    let solved = |acceleration: Acceleration, is_dynamic: bool| {
        let mut solver = if is_dynamic { cloth(12) } else { grid(12, 0.3) };
        solver.set_acceleration(acceleration, 0).unwrap();
        if !is_dynamic {
            solver.init().unwrap();
        }
        until(&mut solver, 5000, 1e-10)
    };
    for is_dynamic in [false, true] {
        let plain = solved(Acceleration::None, is_dynamic);
        for acceleration in BOTH {
            let report = solved(acceleration, is_dynamic);
            let difference = (report.energy_after - plain.energy_after) / plain.energy_after;
            assert!(difference.abs() < 1e-9, "{acceleration:?}, dynamic: {is_dynamic}: differs by {difference:.1e}");
            let (found, of_plain) = (report.evaluations, plain.evaluations);
            println!("{acceleration:?}, dynamic: {is_dynamic}: {found} evaluations, plain {of_plain}");
            assert!(2 * found < of_plain, "{acceleration:?}, dynamic: {is_dynamic}: {found} against {of_plain}");
        }
    }
}

#[test]
fn accelerated_time_steps_follow_the_trajectory_of_converged_plain_ones() {
    for acceleration in BOTH {
        let [mut plain, mut accelerated] = [cloth(12), cloth(12)];
        plain.set_acceleration(Acceleration::None, 0).unwrap();
        accelerated.set_acceleration(acceleration, 0).unwrap();
        for step in 1..=5 {
            let [of_plain, found] = [&mut plain, &mut accelerated].map(|solver| until(solver, 20_000, 1e-11));
            let both = plain.points().iter().zip(accelerated.points());
            let difference = both.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            println!(
                "step {step}, {acceleration:?}: {} of {}, {difference:.1e}",
                found.evaluations, of_plain.evaluations
            );
            // 11 is the cloth's side.
            assert!(difference < 1e-6 * 11.0, "step {step}, {acceleration:?}: {difference:.1e}");
            assert!(found.evaluations < of_plain.evaluations);
        }
    }
}

#[test]
fn free_long_and_weak_models_are_accelerated_as_well() {
    // Nothing holds the first model against translation; the second has an unknown mean, and points in no constraint;
    // the third has more free motions than translations.
    let bend = |i: u32| 0.2 * DVec3::new(0.0, f64::from(i * 7 % 5), f64::from(i * 3 % 4));
    let points: Vec<DVec3> = (0..20).map(|i| DVec3::new(f64::from(i), f64::from(2 * (i % 2)), 0.0) + bend(i)).collect();
    let stencils = |k: u32| (0..20 - k).step_by(2).map(move |i| (i..i + k).collect::<Vec<u32>>());
    type Build<'a> = &'a dyn Fn(&mut Solver);
    let free: Build<'_> = &|solver| {
        for ids in stencils(4) {
            solver.add_constraint("Plane", &ids, 1.0).unwrap();
        }
        for ids in stencils(3) {
            solver.add_constraint("Line", &ids, 0.4).unwrap();
        }
    };
    let long: Build<'_> = &|solver| {
        solver.add_constraint("Circle", &(0..16).collect::<Vec<_>>(), 1.0).unwrap();
        for ids in stencils(2).take(7) {
            solver.add_constraint("EdgeStrain", &ids, 2.0).unwrap();
        }
        for i in 0..16 {
            solver.add_constraint("Closeness", &[i], 0.1).unwrap();
        }
    };
    let weak: Build<'_> = &|solver| {
        for i in 0..17 {
            solver.add_constraint("Bending", &[i + 1, i + 2, i, i + 3], 1.0).unwrap();
        }
    };
    for (name, build) in [("free", free), ("long", long), ("weak", weak)] {
        for acceleration in BOTH {
            let run = |acceleration: Acceleration| {
                let mut solver = Solver::new();
                solver.set_points(&points).unwrap();
                build(&mut solver);
                let moved: Vec<DVec3> = points.iter().zip(0..).map(|(point, i)| *point + 0.5 * bend(i + 3)).collect();
                solver.set_points(&moved).unwrap();
                solver.set_acceleration(acceleration, 0).unwrap();
                solver.init().unwrap();
                let report = until(&mut solver, 40, 0.0);
                (report, solver.points().iter().sum::<DVec3>() - moved.iter().sum::<DVec3>())
            };
            let ((plain, _), (report, drift)) = (run(Acceleration::None), run(acceleration));
            println!("{name}, {acceleration:?}: {:.3e}, plain {:.3e}", report.energy_after, plain.energy_after);
            // At the round-off of both there is no lower one.
            let floor = 1e-12 * plain.energy_before;
            assert!(report.energy_after <= plain.energy_after.max(floor), "{name}, {acceleration:?}");
            assert!(name != "free" || drift.length() < 1e-9, "{acceleration:?}: the model drifted by {drift}");
        }
    }
}

#[test]
fn every_call_begins_with_an_empty_history() {
    for acceleration in BOTH {
        let mut used = grid(9, 0.05);
        used.set_acceleration(acceleration, 0).unwrap();
        used.init().unwrap();
        used.solve(10).unwrap();
        let id = used.constraint_count() - 1;
        used.edit_constraint("Closeness", id, &[8.0, 8.0, 3.0]).unwrap();
        used.set_weight(0, 2.0).unwrap();
        let mut fresh = grid(9, 0.05);
        fresh.edit_constraint("Closeness", id, &[8.0, 8.0, 3.0]).unwrap();
        fresh.set_weight(0, 2.0).unwrap();
        fresh.set_points(used.points()).unwrap();
        fresh.set_acceleration(acceleration, 0).unwrap();
        fresh.init().unwrap();
        for solver in [&mut used, &mut fresh] {
            solver.solve(10).unwrap();
        }
        assert_eq!(bits(used.points()), bits(fresh.points()), "{acceleration:?}");
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit_of_accelerated_solves() {
    for acceleration in BOTH {
        let run = |thread_count: usize| {
            // More points than are worked on serially.
            let mut solver = grid(70, 0.05);
            solver.set_thread_count(thread_count);
            solver.set_acceleration(acceleration, 4).unwrap();
            solver.init().unwrap();
            let report = until(&mut solver, 7, 0.0);
            (bits(solver.points()), report.energy_after.to_bits(), report.rejections)
        };
        let one = run(1);
        for thread_count in [2, 7] {
            assert!(run(thread_count) == one, "{acceleration:?}, {thread_count} threads");
        }
    }
}

#[test]
fn what_overflows_is_refused_by_accelerated_solves_too() {
    for acceleration in BOTH {
        let mut solver = Solver::new();
        solver.set_points(&[DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.3), DVec3::Y]).unwrap();
        solver.add_constraint("Plane", &[0, 1, 2, 3], 1.0).unwrap();
        for i in 0..4 {
            solver.add_constraint("Closeness", &[i], 1e300).unwrap();
        }
        solver.set_acceleration(acceleration, 0).unwrap();
        solver.init().unwrap();
        solver.set_points(&[1e250, -1e250, 1e200, 3e250].map(DVec3::splat)).unwrap();
        let before = bits(solver.points());
        let options = SolveOptions { max_iterations: 20, tolerance: 0.0, ..SolveOptions::default() };
        let result = solver.solve_until(&options, &mut |_| ControlFlow::Continue(()));
        assert_eq!(result.unwrap_err().status(), Status::InvalidValue, "{acceleration:?}");
        assert_eq!(bits(solver.points()), before);
        if solver.solve(20).is_ok() {
            assert!(solver.points().iter().all(|point| point.is_finite()));
        }
    }
}

#[test]
fn a_memory_out_of_range_is_refused_and_changes_nothing() {
    let mut solver = grid(5, 0.05);
    solver.set_acceleration(Acceleration::Anderson, 64).unwrap();
    let error = solver.set_acceleration(Acceleration::QuasiNewton, 65).unwrap_err();
    assert_eq!(error.status(), Status::InvalidValue);
    assert_eq!(error.to_string(), "memory: expected 1 to 64, or 0 for the default, found 65");
    let [mut anderson, mut same] = [grid(5, 0.05), solver];
    anderson.set_acceleration(Acceleration::Anderson, 64).unwrap();
    for solver in [&mut anderson, &mut same] {
        solver.init().unwrap();
        solver.solve(20).unwrap();
    }
    assert_eq!(bits(anderson.points()), bits(same.points()));
}

#[test]
fn a_problem_states_its_acceleration() {
    let text = |settings: &str| {
        format!(r#"{{"version": 1, "points": [[0,0,0],[1,0,0],[1,1,0.3],[0,1,0]], "settings": {{{settings}}}}}"#)
    };
    let read = |settings: &str| Problem::from_json(&text(settings)).map(|problem| problem.settings.acceleration);
    assert_eq!(read("").unwrap(), Acceleration::Automatic);
    for (name, expected) in [
        ("automatic", Acceleration::Automatic),
        ("none", Acceleration::None),
        ("anderson", Acceleration::Anderson),
        ("quasi-newton", Acceleration::QuasiNewton),
    ] {
        assert_eq!(read(&format!(r#""acceleration": "{name}", "acceleration_memory": 5"#)).unwrap(), expected);
    }
    let error = read(r#""acceleration": "newton""#).unwrap_err().to_string();
    assert!(error.starts_with("settings.acceleration: unknown variant `newton`, expected one of"), "{error}");
    let error = read(r#""acceleration_memory": 65"#).unwrap_err().to_string();
    assert_eq!(error, "settings.acceleration_memory: expected 1 to 64, or 0 for the default, found 65");
}
