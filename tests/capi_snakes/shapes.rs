//! Snakes as they are: arcs, handles, freedoms, surfaces, texts.

use std::f64::consts::{PI, TAU};
use std::ffi::{CString, c_int};
use std::ptr;

use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

use super::abi::{Abi, text};
use super::*;

#[test]
fn a_snake_is_what_its_arcs_say() {
    let (radii, lengths, torsions) = ([1.0, 2.0, 1.5], [1.2, 1.5, 1.0], [0.7, -0.4]);
    let built = made(&radii, &lengths, &torsions);
    // From its control points it is the same again.
    let again = Snake(create(&control(&built), 0, 0.0));
    for snake in [&built, &again] {
        let (mut found_radii, mut found_lengths, mut count) = ([0.0; 3], [0.0; 3], 0);
        let (to, into) = (found_radii.as_mut_ptr(), found_lengths.as_mut_ptr());
        // SAFETY: room for three each; `all` gives room for the stated capacity.
        let found_torsions = unsafe {
            assert_eq!(shapeop_snakeShapes(snake.0, to, into, 2, &mut count), SO_SUCCESS);
            assert_eq!((count, found_radii), (3, [0.0; 3]));
            assert_eq!(shapeop_snakeShapes(snake.0, to, into, 3, &mut count), SO_SUCCESS);
            refused(shapeop_snakeShapes(snake.0, to, into, -3, &mut count), SO_INVALID_ARGUMENT_LENGTH, "capacity");
            all(0.0, 1, |out, room, count| shapeop_snakeTorsions(snake.0, out, room, count))
        };
        let off = |found: &[f64], expected: &[f64]| {
            assert_eq!(found.len(), expected.len());
            found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        assert!(off(&found_radii, &radii) < 1e-12 && off(&found_lengths, &lengths) < 1e-12);
        assert!(off(&found_torsions, &torsions) < 1e-12);
        let report = report(snake);
        assert_eq!((report.arc_count, report.control_count, report.is_closed), (3, 5, 0));
        assert!((report.length - 3.7).abs() < 1e-12 && report.residual < 1e-14 && report.deviation == 0.0);
        // Arcs, contact points and samples tell of the same curve.
        // SAFETY: `all` gives room for the stated capacity.
        let (arcs, samples) = unsafe {
            let now = SHAPEOP_SNAKE_NOW;
            let arcs = all(0.0, 11, |out, room, count| shapeop_snakeArcs(snake.0, now, out, room, count));
            (arcs, all(0.0, 3, |out, room, count| shapeop_snakeSample(snake.0, now, 4, out, room, count)))
        };
        let (samples, contacts) = (points(&samples), contacts(snake));
        assert_eq!((arcs.len(), samples.len(), contacts.len()), (33, 13, 4));
        for (j, arc) in arcs.chunks_exact(11).enumerate() {
            assert!((arc[3] - radii[j]).abs() < 1e-12 && (arc[3] * arc[10] - lengths[j]).abs() < 1e-12);
            assert!(distance([arc[7], arc[8], arc[9]], contacts[j]) < 1e-12);
            assert!(samples[4 * j..=4 * j + 4].iter().all(|p| off_circle(arc, *p) < 1e-12));
            assert!(distance(samples[4 * j + 4], contacts[j + 1]) < 1e-12);
        }
    }
    let point = [1.0, 2.0, 3.0];
    // SAFETY: live arrays; null for what is to be refused.
    unsafe {
        let built = |point: *const f64, tangent: *const f64, normal: *const f64| {
            let (radii, lengths, torsions) = (radii.as_ptr(), lengths.as_ptr(), torsions.as_ptr());
            shapeop_snakeCreateFromArcs(radii, lengths, 3, torsions, 2, point, tangent, normal)
        };
        let moved = Snake(built(point.as_ptr(), Y.as_ptr(), Z.as_ptr()));
        assert_eq!(control(&moved)[0], point);
        none(built(ptr::null(), X.as_ptr(), Y.as_ptr()), "point");
        none(built(NAN.as_ptr(), X.as_ptr(), Y.as_ptr()), "point");
        none(built(point.as_ptr(), ORIGIN.as_ptr(), Y.as_ptr()), "tangent");
        none(built(point.as_ptr(), X.as_ptr(), X.as_ptr()), "normal");
        let nothing = ptr::null();
        let at = point.as_ptr();
        none(shapeop_snakeCreateFromArcs(nothing, lengths.as_ptr(), 3, nothing, 0, at, at, at), "radii");
        none(shapeop_snakeCreateFromArcs(radii.as_ptr(), nothing, 3, nothing, 0, at, at, at), "lengths");
        none(shapeop_snakeCreateFromArcs(radii.as_ptr(), nothing, -1, nothing, 0, at, at, at), "nb_arcs");
    }
    none(from_arcs(&[], &[], &[]), "nb_arcs");
    none(from_arcs(&[1.0, -1.0], &[1.0; 2], &[0.0]), "radii[1]");
    none(from_arcs(&[1.0, 1.0], &[1.0, 3.2], &[0.0]), "radii[1]");
    none(from_arcs(&[1.0, 1.0], &[1.0; 2], &[]), "torsions");
    none(from_arcs(&[1.0, 1.0], &[1.0; 2], &[f64::INFINITY]), "torsions[0]");
}

#[test]
fn closed_snakes_and_what_is_no_snake() {
    let seven = Snake(create(&ring(7, 1.0), 1, 0.0));
    assert_eq!((control(&seven).len(), contacts(&seven).len(), report(&seven).is_closed), (7, 7, 1));
    assert!(contacts(&seven).iter().all(|p| (p[0].hypot(p[1]) - 1.0).abs() < 1e-12 && p[2] == 1.0));
    assert!((report(&seven).length - TAU).abs() < 1e-12);
    // Of an even number the first tangent says which.
    none(create(&ring(8, 0.0), 1, 0.0), "first_tangent");
    let eight = Snake(create(&ring(8, 0.0), 1, (PI / 8.0).tan()));
    assert!((report(&eight).length - TAU).abs() < 1e-12);
    none(create(&ring(8, 0.0), 1, f64::NAN), "first_tangent");
    none(create(&ring(8, 0.0), 1, -0.1), "first_tangent");
    none(create(&ring(7, 0.0), 2, 0.0), "is_closed");
    none(create(&ring(2, 0.0), 0, 0.0), "control");
    none(create(&[ORIGIN, NAN, X], 0, 0.0), "control[1]");
    none(create(&[ORIGIN, X, [2.0, 0.0, 0.0]], 0, 0.0), "control[1]");
    assert_eq!(shapeop_lastErrorCode(ptr::null_mut()), SO_DEGENERATE);
    // SAFETY: null is to be refused.
    unsafe {
        none(shapeop_snakeCreate(ptr::null(), 3, 0, 0.0), "control");
        none(shapeop_snakeCreate(ORIGIN.as_ptr(), -1, 0, 0.0), "nb_control");
    }
}

#[test]
fn handles_are_told_apart() {
    let snake = twisted();
    let copy = Snake(shapeop_snakeCopy(snake.0));
    let before = control(&snake);
    let moved: Vec<f64> = before.iter().flat_map(|p| [p[0], p[1], p[2] + 1.0]).collect();
    // SAFETY: a live array of the stated length, and less of it; null is to be refused.
    unsafe {
        assert_eq!(shapeop_snakeSetControl(snake.0, moved.as_ptr(), 5), SO_SUCCESS, "{}", message());
        refused(shapeop_snakeSetControl(snake.0, moved.as_ptr(), 4), SO_INVALID_ARGUMENT_LENGTH, "control");
        refused(shapeop_snakeSetControl(snake.0, ptr::null(), 5), SO_NULL_POINTER, "control");
        let mut nan = moved.clone();
        nan[7] = f64::NAN;
        refused(shapeop_snakeSetControl(snake.0, nan.as_ptr(), 5), SO_INVALID_VALUE, "control[2]");
    }
    assert_eq!(control(&snake).concat(), moved);
    assert_eq!(control(&copy), before);
    let solver = Abi::new();
    let mut count = 0;
    let stale = shapeop_snakeCopy(snake.0);
    shapeop_snakeDelete(stale);
    shapeop_snakeDelete(ptr::null_mut());
    shapeop_snakeDelete(solver.0.cast());
    for handle in [ptr::null_mut(), stale, solver.0.cast(), ptr::without_provenance_mut(0x7fff_1234)] {
        // SAFETY: one int.
        unsafe {
            refused(shapeop_snakeControl(handle, ptr::null_mut(), 0, &mut count), SO_INVALID_HANDLE, "snake");
        }
        assert!(shapeop_snakeCopy(handle).is_null() && names("snake"));
        assert_eq!(shapeop_snakeRailCount(handle), -1);
        assert!(shapeop_snakeText(handle).is_null());
    }
    assert_eq!(solver.message(), "");
    assert_eq!(shapeop_pointCount(snake.0.cast()), -1, "a snake is no solver");
    assert!(text(shapeop_errorText(SO_NOT_INITIALISED as c_int)).contains("first"));
    let mut report = sized!(shapeop_snake_report);
    report.struct_size = 3;
    // SAFETY: the size is refused.
    unsafe {
        refused(shapeop_snakeReport(snake.0, &mut report), SO_INVALID_VALUE, "report->struct_size");
        refused(shapeop_snakeReport(snake.0, ptr::null_mut()), SO_NULL_POINTER, "report");
    }
}

#[test]
fn freedoms_in_space_and_on_a_surface() {
    let snake = twisted();
    let (mut free, mut conditions, mut rank) = (0, 0, 0);
    // SAFETY: ints, or null.
    unsafe {
        let code = shapeop_snakeFreedoms(snake.0, 0, &mut free, &mut conditions, &mut rank);
        assert_eq!((code, free, conditions, rank), (SO_SUCCESS, 8, 7, 7));
        let null = ptr::null_mut();
        refused(shapeop_snakeFreedoms(snake.0, 1, &mut free, null, null), SO_NOT_INITIALISED, "surface");
        refused(shapeop_snakeFreedoms(snake.0, 2, &mut free, null, null), SO_INVALID_VALUE, "on_surface");
        set_surface(&snake, shapeop_snake_surface::SO_SNAKE_SURFACE_SPHERE, &[0.3, 0.1, 0.2, 1.0]);
        assert_eq!(shapeop_snakeFreedoms(snake.0, 1, &mut free, null, null), SO_SUCCESS);
        assert_eq!(free, 3);
    }
}

#[test]
fn surfaces_are_named_or_meshes() {
    let snake = flat();
    let kinds = [
        (shapeop_snake_surface::SO_SNAKE_SURFACE_PLANE, vec![0.0, 0.0, 0.25, 0.0, 0.0, 2.0], 0.25),
        (shapeop_snake_surface::SO_SNAKE_SURFACE_SPHERE, vec![0.0, 2.0, 0.0, 2.5], 0.5),
        (shapeop_snake_surface::SO_SNAKE_SURFACE_CYLINDER, vec![0.0, 2.0, 9.0, 0.0, 0.0, 1.0, 1.9], 0.1),
        (shapeop_snake_surface::SO_SNAKE_SURFACE_TORUS, vec![0.0, 2.0, 0.0, 0.0, 0.0, -1.0, 2.0, 0.3], 0.3),
    ];
    for (kind, numbers, expected) in kinds {
        set_surface(&snake, kind, &numbers);
        let found = report(&snake).deviation;
        assert!((found - expected).abs() < 1e-12, "{kind:?}: {found}");
        let count = numbers.len() as c_int;
        let bad: Vec<f64> = numbers.iter().map(|_| f64::NAN).collect();
        // SAFETY: live arrays of the stated lengths.
        unsafe {
            let set = |numbers: *const f64, count| shapeop_snakeSetSurface(snake.0, kind as c_int, numbers, count);
            refused(set(numbers.as_ptr(), count - 1), SO_INVALID_ARGUMENT_LENGTH, "nb_numbers");
            refused(set(bad.as_ptr(), count), SO_INVALID_VALUE, "numbers[0]");
            refused(set(ptr::null(), count), SO_NULL_POINTER, "numbers");
        }
    }
    // SAFETY: live arrays of the stated lengths.
    unsafe {
        refused(shapeop_snakeSetSurface(snake.0, 4, ORIGIN.as_ptr(), 3), SO_INVALID_VALUE, "kind");
        let (square, quad) = ([-9.0, -9.0, 0.5, 9.0, -9.0, 0.5, 9.0, 9.0, 0.5, -9.0, 9.0, 0.5], [0, 1, 2, 3]);
        let mesh = |indices: &[c_int; 4], count| {
            shapeop_snakeSetMesh(snake.0, square.as_ptr(), 4, indices.as_ptr(), 4, &count, 1)
        };
        assert_eq!(mesh(&quad, 4), SO_SUCCESS, "{}", message());
        assert!((report(&snake).deviation - 0.5).abs() < 1e-12);
        refused(mesh(&[0, 1, 2, 4], 4), SO_INDEX_OUT_OF_RANGE, "faces[0][3]");
        assert_eq!(mesh(&quad, 3), SO_INVALID_ARGUMENT_LENGTH);
        assert!((report(&snake).deviation - 0.5).abs() < 1e-12);
    }
    assert_eq!(shapeop_snakeClearSurface(snake.0), SO_SUCCESS);
    assert_eq!(report(&snake).deviation, 0.0);
}

#[test]
fn projections_keep_distances_and_are_near() {
    let snake = twisted();
    let before = control(&snake);
    let noise = |i: usize, k: usize| 0.02 * ((7 * i + 3 * k) as f64).sin();
    let target: Vec<f64> = before.iter().enumerate().flat_map(|(i, p)| [0, 1, 2].map(|k| p[k] + noise(i, k))).collect();
    let own = shapeop_snake_options { is_exact: 1, ..options() };
    let mut told = sized!(shapeop_snake_projection);
    // SAFETY: live arrays and structs.
    unsafe {
        assert_eq!(shapeop_snakeProject(snake.0, target.as_ptr(), 5, &own, &mut told), SO_SUCCESS, "{}", message());
        assert!(told.residual < 1e-12 && told.is_nearest == 1 && told.moved > 1e-3 && told.moved < 0.05, "{told:?}");
        assert!(report(&snake).residual < 1e-12);
        let off = |at: &[[f64; 3]]| at.iter().zip(points(&target)).map(|(a, b)| distance(*a, b).powi(2)).sum::<f64>();
        let nearest = off(&control(&snake));
        assert!(nearest < off(&before));
        // The paper's is near it, and no nearer.
        let other = twisted();
        let null = ptr::null();
        assert_eq!(shapeop_snakeProject(other.0, target.as_ptr(), 5, null, ptr::null_mut()), SO_SUCCESS);
        assert!(off(&control(&other)) >= nearest * (1.0 - 1e-9) && off(&control(&other)) < 1.01 * nearest);
        let after = control(&snake);
        refused(
            shapeop_snakeProject(snake.0, target.as_ptr(), 4, &own, &mut told),
            SO_INVALID_ARGUMENT_LENGTH,
            "nb_target",
        );
        refused(shapeop_snakeProject(snake.0, ptr::null(), 5, &own, &mut told), SO_NULL_POINTER, "target");
        let mut nan = target.clone();
        nan[4] = f64::NAN;
        refused(shapeop_snakeProject(snake.0, nan.as_ptr(), 5, &own, &mut told), SO_INVALID_VALUE, "target[1]");
        let bad = shapeop_snake_options { mu: -1.0, ..own };
        refused(shapeop_snakeProject(snake.0, target.as_ptr(), 5, &bad, &mut told), SO_INVALID_VALUE, "options->mu");
        assert_eq!(control(&snake), after);
    }
}

#[test]
fn snakes_and_their_arcs_as_texts() {
    let snake = Snake(create(&ring(8, 0.0), 1, (PI / 8.0).tan()));
    let json = CString::new(text(shapeop_snakeText(snake.0))).unwrap();
    // SAFETY: live texts, or null.
    unsafe {
        let again = Snake(shapeop_snakeCreateFromText(json.as_ptr()));
        assert!(!again.0.is_null(), "{}", message());
        assert_eq!((control(&again), report(&again).is_closed), (control(&snake), 1));
        none(shapeop_snakeCreateFromText(ptr::null()), "json");
        assert!(shapeop_snakeCreateFromText(c"{}".as_ptr()).is_null());
        assert_eq!(shapeop_lastErrorCode(ptr::null_mut()), SO_INVALID_INPUT);
        none(shapeop_snakeCreateFromText(c"{\"version\": 2}".as_ptr()), "version");
    }
    let (now, everything) = (SHAPEOP_SNAKE_NOW, SHAPEOP_SNAKE_ALL);
    let lines = |table: *const std::ffi::c_char| text(table).lines().count();
    assert_eq!(lines(shapeop_snakeArcsCsv(snake.0, now, 1e-6)), 9);
    assert_eq!(
        text(shapeop_snakeKindsCsv(snake.0, now, 1e-6)).lines().nth(1).unwrap().split(',').next_back(),
        Some("8")
    );
    assert!(text(shapeop_snakeArcsText(snake.0, now, 1e-6)).contains("angle_rad"));
    assert_eq!(text(shapeop_snakeArcsDxf(snake.0, now, 1e-6)).lines().filter(|line| line.trim() == "ARC").count(), 8);
    assert!(shapeop_snakeArcsText(snake.0, everything, 1e-6).is_null());
    assert_eq!(shapeop_lastErrorCode(ptr::null_mut()), SO_NOT_INITIALISED);
    assert!(shapeop_snakeArcsCsv(snake.0, now, -1.0).is_null() && names("tolerance"));
    assert!(shapeop_snakeArcsCsv(snake.0, 3, 1e-6).is_null());
    let along = shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int;
    // SAFETY: a live vector.
    unsafe { assert_eq!(shapeop_snakeSetDirection(snake.0, along, Z.as_ptr()), SO_SUCCESS) };
    evolve(&snake, &shapeop_snake_options { max_steps: 2, ..options() });
    assert_eq!(lines(shapeop_snakeArcsCsv(snake.0, everything, 1e-6)), 1 + 3 * 8);
    assert_eq!(
        text(shapeop_snakeKindsCsv(snake.0, everything, 1e-6)).lines().nth(1).unwrap().split(',').next_back(),
        Some("24")
    );
    assert_eq!(lines(shapeop_snakeArcsCsv(snake.0, 2, 1e-6)), 9);
}
