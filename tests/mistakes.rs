//! The ordinary mistakes of callers: each in a process of its own, so that a crash fails its own row and no other.

mod abi;

use std::ffi::{c_int, c_void};
use std::process::Command;
use std::ptr;

use abi::{Abi, Many, WARPED, report, warped};
use shapeop::capi::shapeop_err::*;
use shapeop::capi::shapeop_outcome::*;
use shapeop::capi::*;

/// Runs `mistake` in a process of its own, which runs only the test of this name.
fn in_a_process(name: &str, mistake: impl FnOnce()) {
    const MARK: &str = "SHAPEOP_MISTAKE";
    if std::env::var(MARK).as_deref() == Ok(name) {
        return mistake();
    }
    let mut command = Command::new(std::env::current_exe().unwrap());
    let output = command.args(["--exact", name, "--nocapture", "--test-threads=1"]).env(MARK, name).output().unwrap();
    let said = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "the process ended with {}: {said}", output.status);
    assert!(said.contains("1 passed"), "the process did not run the test: {said}");
}

/// Declares tests that each run in a process of their own.
macro_rules! mistakes {
    ($($(#[$doc:meta])* fn $name:ident() $body:block)*) => {
        $($(#[$doc])* #[test] fn $name() { in_a_process(stringify!($name), || $body); })*
    };
}

fn assert_says(abi: &Abi, words: &[&str]) {
    let message = abi.message();
    assert!(!words.is_empty() && words.iter().all(|word| message.contains(word)), "{message:?} lacks one of {words:?}");
}

fn assert_all_finite(abi: &Abi) {
    let points = abi.points();
    assert!(!points.is_empty() && points.iter().all(|c| c.is_finite()), "{points:?}");
    let (code, energy) = abi.energy();
    assert!(code == SO_SUCCESS && energy.is_finite(), "energy {energy}");
    let (code, violations) = abi.violations(shapeop_constraintCount(abi.0) as usize);
    assert!(code == SO_SUCCESS && violations.iter().all(|violation| violation.is_finite()), "{violations:?}");
}

mistakes! {
    fn an_index_out_of_range() {
        let abi = warped();
        for index in [4, 5000, c_int::MAX, -1, c_int::MIN] {
            assert_eq!(abi.add("Plane", &[0, 1, index], 1.0), -1);
            assert_says(&abi, &["constraint 5 (\"Plane\"): indices[2]", &index.to_string(), "4 points"]);
        }
        assert_eq!((abi.points(), shapeop_constraintCount(abi.0)), (WARPED.to_vec(), 5));
        assert_eq!((abi.init(), abi.solve(1)), (0, 0));
    }

    fn an_unknown_type_name() {
        let abi = warped();
        for name in ["", "plane", "Plane ", "Plan", "AngleConstraint2"] {
            assert_eq!(abi.add(name, &[0, 1, 2], 1.0), -1);
            assert_says(&abi, &["type", "is not one of", "EdgeStrain", "Closeness", "Plane", "LaplacianDisplacement"]);
        }
        assert_eq!(abi.points(), WARPED);
    }

    fn a_wrong_number_of_indices() {
        let abi = warped();
        for (name, ids, expected) in [
            ("EdgeStrain", &[0, 1, 2][..], "expected 2 for \"EdgeStrain\", found 3"),
            ("Plane", &[0, 1][..], "expected at least 3 for \"Plane\", found 2"),
            ("Closeness", &[][..], "expected 1 for \"Closeness\", found 0"),
            ("Bending", &[0, 1, 2][..], "expected 4 for \"Bending\", found 3"),
        ] {
            assert_eq!(abi.add(name, ids, 1.0), -1);
            assert_says(&abi, &["constraint 5", expected]);
        }
        assert_eq!((abi.points(), shapeop_constraintCount(abi.0)), (WARPED.to_vec(), 5));
    }

    fn an_edit_of_an_unknown_id() {
        let abi = warped();
        for id in [5, 77, c_int::MAX, -1, c_int::MIN] {
            assert_eq!(abi.edit("Closeness", id, &[0.0; 3]), SO_UNMATCHING_CONSTRAINT_ID);
            assert_says(&abi, &["constraint id", &id.to_string()]);
        }
        assert_eq!(abi.edit("Closeness", 0, &[0.0; 3]), SO_UNMATCHING_CONSTRAINT_ID);
        assert_says(&abi, &["constraint 0 is of type \"Plane\", not \"Closeness\""]);
        assert_eq!(abi.points(), WARPED);
    }

    fn an_edit_of_gravity_as_a_vertex_force() {
        let abi = warped();
        let gravity = abi.gravity([0.0, 0.0, -0.1]);
        abi.edit_vertex_force(gravity, [9.0, 9.0, 9.0], 1);
        assert_says(&abi, &["force 0 is gravity"]);
        for unknown in [1, -1, c_int::MAX] {
            abi.edit_vertex_force(unknown, [9.0, 9.0, 9.0], 1);
            assert_says(&abi, &["force id", &unknown.to_string()]);
        }
        let other = warped();
        other.gravity([0.0, 0.0, -0.1]);
        for each in [&abi, &other] {
            assert_eq!((each.init(), each.solve(3)), (0, 0));
        }
        assert_eq!(abi.points(), other.points(), "nothing changed");
    }

    fn solving_before_init() {
        let abi = warped();
        assert_eq!(abi.solve(1), 1);
        assert_says(&abi, &["not initialised", "init"]);
        assert_eq!(abi.solve_until(1).0, SO_NOT_INITIALISED);
        assert_eq!(abi.points(), WARPED);
    }

    fn solving_after_adding_without_init() {
        let abi = Abi::with_points(&WARPED);
        assert_eq!(abi.init(), 0);
        assert_eq!(abi.add("Plane", &[0, 1, 2, 3], 1.0), 0);
        assert_eq!(abi.solve(1), 0);
        // The lone plane flattens to its mean height, 0.
        assert!(abi.points().chunks_exact(3).all(|point| point[2].abs() < 1e-15));
    }

    fn points_in_no_constraint() {
        let abi = Abi::with_points(&[WARPED.as_slice(), &[7.0, 8.0, 9.0]].concat());
        assert_eq!(abi.add("Plane", &[0, 1, 2, 3], 1.0), 0);
        assert_eq!((abi.init(), abi.solve(10)), (0, 0));
        assert_eq!(abi.points()[12..], [7.0, 8.0, 9.0]);
        let (code, found) = abi.solve_until(3);
        assert_eq!((code, found.unconstrained_count, shapeop_unconstrainedCount(abi.0)), (SO_SUCCESS, 1, 1));
    }

    fn only_translation_free_constraints() {
        let shifted: Vec<f64> = WARPED.iter().map(|c| c + 100.0).collect();
        let abi = Abi::with_points(&shifted);
        assert_eq!(abi.add("Plane", &[0, 1, 2, 3], 1.0), 0);
        assert_eq!((abi.init(), abi.solve(20)), (0, 0));
        for (found, start) in abi.points().chunks_exact(3).zip(shifted.chunks_exact(3)) {
            assert!((found[0] - start[0]).abs() + (found[1] - start[1]).abs() + (found[2] - 100.0).abs() < 1e-11);
        }
    }

    fn a_force_along_a_free_motion() {
        // A point that nothing holds; then a lone plane under gravity.
        for (points, hold, word) in [
            ([WARPED.as_slice(), &[7.0; 3]].concat(), true, "point 4"),
            (WARPED.to_vec(), false, "component of point 0"),
        ] {
            let abi = Abi::with_points(&points);
            abi.add("Plane", &[0, 1, 2, 3], 1.0);
            if hold {
                (0..4).for_each(|i| assert!(abi.add("Closeness", &[i], 1.0) > 0));
            }
            abi.gravity([0.0, 0.0, -9.81]);
            assert_eq!(abi.init(), 0);
            assert_eq!(abi.solve(10), 1);
            assert_says(&abi, &["force", word]);
            assert_eq!(abi.points(), points);
            let (code, found) = abi.solve_until(10);
            assert_eq!((code, found.outcome), (SO_SUCCESS, SO_OUTCOME_UNBOUNDED));
            assert_says(&abi, &["force", word]);
            assert_eq!(abi.points(), points);
        }
    }

    fn no_constraint_at_all() {
        let abi = Abi::with_points(&WARPED);
        assert_eq!((abi.init(), abi.solve(10)), (0, 0));
        assert_eq!(abi.points(), WARPED);
        let force = abi.vertex_force([1.0, 0.0, 0.0], 2);
        assert_eq!(abi.solve(10), 1);
        assert_says(&abi, &["force", "point 2"]);
        assert_eq!(shapeop_removeForce(abi.0, force), SO_SUCCESS);
        assert_eq!(abi.solve(10), 0);
        assert_eq!(abi.points(), WARPED);
    }

    fn scalars_out_of_their_domain() {
        let points: Vec<f64> = (0..24).map(|i| f64::from(i * i % 11)).collect();
        let abi = Abi::with_points(&points);
        let ids = |count: c_int| (0..count).collect::<Vec<_>>();
        for (name, count, wrong) in [
            ("EdgeStrain", 2, &[&[0.0, 1.0, 1.0][..], &[-1.0, 1.0, 1.0], &[1.0, 2.0, 1.0], &[1.0, -1.0, 1.0]][..]),
            ("TriangleStrain", 3, &[&[2.0, 1.0][..], &[-0.1, 1.0]]),
            ("TetrahedronStrain", 4, &[&[2.0, 1.0][..], &[-0.1, 1.0]]),
            ("Area", 3, &[&[2.0, 1.0][..], &[-0.1, 1.0]]),
            ("Volume", 4, &[&[2.0, 1.0][..], &[-0.1, 1.0]]),
            ("Bending", 4, &[&[2.0, 1.0][..], &[-0.1, 1.0]]),
            ("Angle", 3, &[&[1.0, 0.5][..], &[-0.1, 1.0], &[0.0, 3.2]]),
            ("Similarity", 4, &[&[][..]]),
            ("Rigid", 4, &[&[][..]]),
        ] {
            let id = abi.add(name, &ids(count), 1.0);
            assert!(id >= 0, "{}", abi.message());
            for scalars in wrong {
                assert_eq!(abi.edit(name, id, scalars), SO_INVALID_VALUE, "{name} {scalars:?}: {}", abi.message());
                assert_says(&abi, &["scalars"]);
            }
        }
        let abi = warped();
        let id = abi.add("EdgeStrain", &[0, 1], 1.0);
        let (_, before) = abi.energy();
        assert_eq!(abi.edit("EdgeStrain", id, &[0.0, 1.0, 1.0]), SO_INVALID_VALUE);
        assert_eq!((abi.energy().1, abi.points()), (before, WARPED.to_vec()), "nothing changed");
    }

    fn masses_time_step_and_damping_out_of_their_domain() {
        let abi = warped();
        assert_eq!(shapeop_initDynamic(abi.0, 1.0, 0.9, 0.1), 0);
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(shapeop_initDynamic(abi.0, bad, 1.0, 1.0), 1);
            assert_says(&abi, &["masses"]);
            assert_eq!(shapeop_initDynamic(abi.0, 1.0, 1.0, bad), 1);
            assert_says(&abi, &["timestep"]);
            shapeop_setTimeStep(abi.0, bad);
            assert_says(&abi, &["timestep", "expected", "found"]);
            if bad != 0.0 {
                assert_eq!(shapeop_initDynamic(abi.0, 1.0, bad, 1.0), 1);
                assert_says(&abi, &["damping"]);
                shapeop_setDamping(abi.0, bad);
                assert_says(&abi, &["damping", "expected", "found"]);
            }
        }
        let other = warped();
        assert_eq!(shapeop_initDynamic(other.0, 1.0, 0.9, 0.1), 0);
        for each in [&abi, &other] {
            (0..3).for_each(|_| assert_eq!(each.solve(2), 0));
        }
        assert_eq!(abi.points(), other.points(), "nothing changed");
    }

    fn set_points_with_another_count() {
        let abi = warped();
        abi.set_points(&WARPED[..9]);
        assert_says(&abi, &["number of points", "constraint 0", "found 3"]);
        assert_eq!(abi.points(), WARPED);
        // More are welcome, and start at rest; fewer too, until something refers to them.
        abi.set_points(&[WARPED.as_slice(), &[5.0; 6]].concat());
        assert_eq!((abi.message().as_str(), shapeop_pointCount(abi.0)), ("", 6));
        assert!(abi.vertex_force([0.0, 0.0, 1.0], 5) == 0);
        abi.set_points(&[WARPED.as_slice(), &[5.0; 3]].concat());
        assert_says(&abi, &["force 0"]);
        assert_eq!(shapeop_removeForce(abi.0, 0), SO_SUCCESS);
        abi.set_points(&WARPED);
        assert_eq!((abi.message().as_str(), shapeop_pointCount(abi.0), abi.init(), abi.solve(1)), ("", 4, 0, 0));
    }

    fn a_call_from_inside_the_callback() {
        extern "C" fn meddle(_: *const shapeop_progress, user: *mut c_void) -> c_int {
            let abi = std::mem::ManuallyDrop::new(Abi(user.cast()));
            abi.set_points(&[0.0; 12]);
            shapeop_delete(abi.0);
            let is_busy = abi.init() == 1 && abi.solve(1) == 1 && abi.add("Plane", &[0, 1, 2], 1.0) == -1;
            let is_told = abi.message().contains("busy");
            let is_readable = abi.points().len() == 12 && (abi.energy().0, abi.violations(5).0) == (SO_SUCCESS, SO_SUCCESS);
            c_int::from(!(is_busy && is_told && is_readable))
        }
        let abi = warped();
        assert_eq!(abi.init(), 0);
        let mut found = report();
        // SAFETY: the report carries its size; the callback expects the handle.
        let code = unsafe { shapeop_solveUntil(abi.0, ptr::null(), Some(meddle), abi.0.cast(), &mut found) };
        assert_eq!((code, found.outcome), (SO_SUCCESS, SO_OUTCOME_CONVERGED));
        assert_eq!((shapeop_constraintCount(abi.0), abi.message().as_str()), (5, ""));
    }

    fn a_call_while_another_thread_solves() {
        let abi = warped();
        assert_eq!(abi.init(), 0);
        std::thread::scope(|scope| {
            let solve = scope.spawn(|| abi.solve(2_000_000));
            let mut busy_count = 0;
            while !solve.is_finished() {
                if shapeop_pointCount(abi.0) == -1 {
                    busy_count += 1;
                    assert_says(&abi, &["busy"]);
                    abi.set_points(&[0.0; 3]);
                }
                std::thread::yield_now();
            }
            assert_eq!(solve.join().unwrap(), 0);
            assert!(busy_count > 0);
        });
        assert_eq!((shapeop_pointCount(abi.0), shapeop_constraintCount(abi.0)), (4, 5));
    }

    fn degenerate_rest_states() {
        // All points coincide, or lie on a line, or in a plane.
        let coincident = [2.0; 12];
        let line = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0];
        for (points, degenerate) in [
            (coincident, &["EdgeStrain", "TriangleStrain", "TetrahedronStrain", "Area", "Volume", "Bending"][..]),
            (line, &["TriangleStrain", "TetrahedronStrain", "Area", "Volume", "Bending"]),
        ] {
            for (index, info) in shapeop::constraints::types().enumerate() {
                let abi = Abi::with_points(&points);
                abi.any_references();
                let ids: Vec<c_int> = (0..info.least_indices as c_int).collect();
                assert_eq!(abi.add(info.name, &ids, 1.0), 0, "type {index}: {}", abi.message());
                if degenerate.contains(&info.name) {
                    assert_eq!(shapeop_isDegenerate(abi.0, 0), 1, "{}", info.name);
                }
                for i in 0..4 {
                    abi.add("Closeness", &[i], 0.1);
                }
                assert_eq!((abi.init(), abi.solve(5)), (0, 0), "{}: {}", info.name, abi.message());
                assert_all_finite(&abi);
                assert_eq!(shapeop_initDynamic(abi.0, 1.0, 1.0, 0.1), 0);
                abi.gravity([0.0, 0.0, -1.0]);
                assert_eq!(abi.solve(5), 0);
                assert_all_finite(&abi);
            }
        }
    }

    fn numbers_that_are_not_finite() {
        let abi = warped();
        let edge = abi.add("EdgeStrain", &[0, 1], 1.0);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut points = WARPED;
            points[7] = bad;
            abi.set_points(&points);
            assert_says(&abi, &["points[2]", "finite"]);
            assert_eq!(abi.add("Plane", &[0, 1, 2], bad), -1);
            assert_says(&abi, &["constraint 6", "weight", "finite"]);
            assert_eq!(abi.edit("EdgeStrain", edge, &[1.0, bad, 1.0]), SO_INVALID_VALUE);
            assert_says(&abi, &["scalars[1]", "finite"]);
            assert_eq!(shapeop_setWeight(abi.0, edge, bad), SO_INVALID_VALUE);
            assert_eq!(abi.gravity([0.0, bad, 0.0]), -1);
            assert_says(&abi, &["force", "finite"]);
            assert_eq!(abi.vertex_force([0.0, bad, 0.0], 0), -1);
            let many = Many { ids: &[0, 1, 2], counts: &[3], weights: &[bad], ..Many::default() };
            assert_eq!(abi.add_many(&many).0, SO_INVALID_VALUE);
        }
        assert_eq!((abi.points(), shapeop_constraintCount(abi.0), shapeop_forceCount(abi.0)), (WARPED.to_vec(), 6, 0));
        assert_eq!((abi.init(), abi.solve(5)), (0, 0));
        assert_all_finite(&abi);
    }

    fn a_negative_weight_and_a_weight_of_zero() {
        let abi = warped();
        assert_eq!(abi.add("Closeness", &[0], -1.0), -1);
        assert_says(&abi, &["weight", "at least 0", "-1"]);
        assert_eq!(shapeop_setWeight(abi.0, 1, -1e-300), SO_INVALID_VALUE);
        let far = abi.add("Closeness", &[0], 0.0);
        assert_eq!(abi.edit("Closeness", far, &[1e6; 3]), SO_SUCCESS);
        let other = warped();
        for each in [&abi, &other] {
            assert_eq!((each.init(), each.solve(3)), (0, 0));
        }
        assert_eq!(abi.points(), other.points(), "a weight of zero does nothing");
    }

    fn get_points_with_another_count() {
        let abi = warped();
        for count in [0, 1, 3, 5, c_int::MAX, -1, c_int::MIN] {
            let mut points = [7.0; 30];
            // SAFETY: with any count but 4, nothing is written.
            unsafe { shapeop_getPoints(abi.0, points.as_mut_ptr(), count) };
            assert_eq!(points, [7.0; 30]);
            assert_says(&abi, &["nb_points: expected 4", &count.to_string()]);
        }
        assert_eq!(abi.points(), WARPED);
    }

    fn null_pointers() {
        let abi = warped();
        // SAFETY: null is allowed everywhere.
        unsafe {
            shapeop_setPoints(abi.0, ptr::null_mut(), 4);
            assert_says(&abi, &["points", "null"]);
            shapeop_getPoints(abi.0, ptr::null_mut(), 4);
            assert_says(&abi, &["points", "null"]);
            assert_eq!(shapeop_addConstraint(abi.0, ptr::null(), [0, 1, 2].as_mut_ptr(), 3, 1.0), -1);
            assert_says(&abi, &["constraint_type", "null"]);
            assert_eq!(shapeop_addConstraint(abi.0, c"Plane".as_ptr(), ptr::null_mut(), 3, 1.0), -1);
            assert_says(&abi, &["ids", "null"]);
            assert_eq!(shapeop_editConstraint(abi.0, c"Closeness".as_ptr(), 1, ptr::null(), 3), SO_NULL_POINTER);
            assert_says(&abi, &["scalars", "null"]);
            assert_eq!(shapeop_addGravityForce(abi.0, ptr::null_mut()), -1);
            assert_eq!(shapeop_addVertexForce(abi.0, ptr::null_mut(), 0), -1);
            shapeop_editVertexForce(abi.0, 0, ptr::null_mut(), 0);
            assert_says(&abi, &["force", "null"]);
            assert_eq!(shapeop_energy(abi.0, ptr::null_mut()), SO_NULL_POINTER);
            assert_eq!(shapeop_getViolations(abi.0, ptr::null_mut(), 5), SO_NULL_POINTER);
            assert_eq!(shapeop_constraintType(0, ptr::null_mut()), SO_NULL_POINTER);
            assert_eq!(shapeop_constraintScalar(0, 0, ptr::null_mut()), SO_NULL_POINTER);
        }
        assert_eq!((abi.points(), shapeop_constraintCount(abi.0), shapeop_forceCount(abi.0)), (WARPED.to_vec(), 5, 0));
    }
}
