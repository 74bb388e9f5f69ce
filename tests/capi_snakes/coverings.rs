//! What snakes sweep, and are made of.

use std::ffi::c_int;
use std::ptr;

use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

use super::abi::text;
use super::*;

#[test]
fn what_snakes_are_made_of() {
    let snake = flat();
    // SAFETY: ranges of live outputs, as `mesh` and `all` give them.
    unsafe {
        let handle = snake.0;
        let (at, quads) = mesh(|points, room, count, quads, quad_room, quad_count| {
            shapeop_snakePipe(handle, SHAPEOP_SNAKE_NOW, 0.5, 4, 12, points, room, count, quads, quad_room, quad_count)
        });
        assert_eq!((at.len(), quads.len()), (21 * 12, 4 * 20 * 12));
        // A piece of a torus about (0, 2, 0).
        assert!(at.iter().all(|p| ((p[0].hypot(p[1] - 2.0) - 2.0).hypot(p[2]) - 0.5).abs() < 1e-12));
        let lamellae = |kind: shapeop_snake_lamella, along: *const f64, depth| {
            mesh(|points, room, count, quads, quad_room, quad_count| {
                let now = SHAPEOP_SNAKE_NOW;
                let kind = kind as c_int;
                shapeop_snakeLamellae(
                    handle, now, kind, along, depth, 4, points, room, count, quads, quad_room, quad_count,
                )
            })
        };
        let (at, quads) = lamellae(shapeop_snake_lamella::SO_SNAKE_LAMELLA_FLAT, ptr::null(), 0.5);
        assert_eq!((at.len(), quads.len()), (5 * 2 * 5, 4 * 5 * 4));
        let radius = |p: &[f64; 3]| p[0].hypot(p[1] - 2.0);
        assert!(at.iter().all(|p| (radius(p) - 2.0).abs().min((radius(p) - 2.5).abs()) < 1e-12 && p[2] == 0.0));
        let (at, quads) = lamellae(shapeop_snake_lamella::SO_SNAKE_LAMELLA_ALONG, Z.as_ptr(), 0.5);
        assert_eq!((at.len(), quads.len()), (2 * 21, 4 * 20));
        assert!(at[21..].iter().all(|p| (radius(p) - 2.0).abs() < 1e-12 && (p[2] - 0.5).abs() < 1e-12));
        let (to, into, mut count, mut quad_count) = (ptr::null_mut(), ptr::null_mut(), -1, -1);
        let mut bad = |kind, along: *const f64, depth, per_arc, code, place: &str| {
            let counts = (&raw mut count, &raw mut quad_count);
            let now = SHAPEOP_SNAKE_NOW;
            let found =
                shapeop_snakeLamellae(handle, now, kind, along, depth, per_arc, to, 0, counts.0, into, 0, counts.1);
            refused(found, code, place);
        };
        bad(1, ptr::null(), 0.5, 4, SO_NOT_INITIALISED, "surface");
        bad(2, ptr::null(), 0.5, 4, SO_NULL_POINTER, "along");
        bad(2, ORIGIN.as_ptr(), 0.5, 4, SO_INVALID_VALUE, "along");
        bad(3, ptr::null(), 0.5, 4, SO_INVALID_VALUE, "kind");
        bad(0, ptr::null(), -2.0, 4, SO_INVALID_VALUE, "depth");
        bad(0, ptr::null(), 0.5, 0, SO_INVALID_VALUE, "per_arc");
        let mut pipe = |frame, radius, around, code, place: &str| {
            let found =
                shapeop_snakePipe(handle, frame, radius, 4, around, to, 0, &mut count, into, 0, &mut quad_count);
            refused(found, code, place);
        };
        pipe(SHAPEOP_SNAKE_NOW, 2.0, 12, SO_INVALID_VALUE, "radius");
        pipe(SHAPEOP_SNAKE_NOW, f64::NAN, 12, SO_INVALID_VALUE, "radius");
        pipe(SHAPEOP_SNAKE_NOW, 0.1, 2, SO_INVALID_VALUE, "around");
        pipe(-7, 0.1, 12, SO_INDEX_OUT_OF_RANGE, "frame");
        assert_eq!((count, quad_count), (-1, -1));
        // Kinds.
        let mixed = made(&[1.0, 2.0, 1.0 + 1e-7], &[1.0, 1.0, 1.0], &[0.1, 0.2]);
        let kinds = all(0.0, 3, |out, room, count| shapeop_snakeKinds(mixed.0, 1e-6, out, room, count));
        assert!(kinds.len() == 6 && kinds[2..] == [2.0, 2.0, 1.0, 1.0], "{kinds:?}");
        let of = all(-1, 1, |out, room, count| shapeop_snakeKindOf(mixed.0, 1e-6, out, room, count));
        assert_eq!(of, [0, 1, 0]);
        let mut kinds = 0;
        refused(shapeop_snakeKinds(mixed.0, -1.0, to, 0, &mut kinds), SO_INVALID_VALUE, "tolerance");
        refused(shapeop_snakeKindOf(mixed.0, f64::NAN, into, 0, &mut kinds), SO_INVALID_VALUE, "tolerance");
        refused(
            shapeop_snakeSweepMesh(handle, 4, 0, to, 0, &mut count, into, 0, &mut quad_count),
            SO_NOT_INITIALISED,
            "snake",
        );
    }
}

#[test]
fn a_circle_that_moves_along_its_axis_sweeps_a_cylinder() {
    let snake = Snake(create(&ring(7, 0.0), 1, 0.0));
    set_surface(&snake, shapeop_snake_surface::SO_SNAKE_SURFACE_CYLINDER, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
    let along = shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int;
    // SAFETY: a live vector.
    unsafe { assert_eq!(shapeop_snakeSetDirection(snake.0, along, Z.as_ptr()), SO_SUCCESS) };
    let own = shapeop_snake_options { max_steps: 4, step: 0.25, ..options() };
    assert_eq!(evolve(&snake, &own).frame_count, 5);
    let handle = snake.0;
    // SAFETY: live outputs, as `mesh` gives them.
    let (at, quads) = mesh(|points, room, count, quads, quad_room, quad_count| unsafe {
        shapeop_snakeSweepMesh(handle, 3, 0, points, room, count, quads, quad_room, quad_count)
    });
    assert_eq!((at.len(), quads.len()), (5 * 21, 4 * 4 * 21));
    assert!(at.iter().all(|p| (p[0].hypot(p[1]) - 1.0).abs() < 1e-9));
    assert!(at.iter().enumerate().all(|(k, p)| (p[2] - 0.25 * (k / 21) as f64).abs() < 1e-9));
    // The last frame's arcs are where they moved to.
    // SAFETY: `all` gives room for the stated capacity.
    let arcs = all(0.0, 11, |out, room, count| unsafe { shapeop_snakeArcs(handle, 4, out, room, count) });
    assert!(arcs.chunks_exact(11).all(|arc| (arc[2] - 1.0).abs() < 1e-9 && (arc[3] - 1.0).abs() < 1e-12));
    let (mut count, mut quad_count, null, none) = (0, 0, ptr::null_mut(), ptr::null_mut());
    // SAFETY: null with no capacity.
    unsafe {
        let mut sweep = |per_arc, back| {
            shapeop_snakeSweepMesh(handle, per_arc, back, null, 0, &mut count, none, 0, &mut quad_count)
        };
        refused(sweep(0, 0), SO_INVALID_VALUE, "per_arc");
        refused(sweep(3, 2), SO_INVALID_VALUE, "comes_back");
        assert_eq!(sweep(3, 1), SO_SUCCESS);
    }
    assert_eq!((count, quad_count), (5 * 21, 5 * 21));
}

#[test]
fn a_covering_is_judged() {
    // An arc that moves up sweeps a wall; the mesh is one twice as high, beside it.
    let snake = flat();
    let along = shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int;
    let mut told = sized!(shapeop_snake_covering);
    let mut own = defaults!(shapeop_snake_covering_options, shapeop_snakeDefaultCoveringOptions);
    let handle = snake.0;
    // SAFETY: live arrays of the stated lengths, live structs.
    unsafe {
        refused(shapeop_snakeCovering(handle, &own, &mut told), SO_NOT_INITIALISED, "snake");
        assert!(shapeop_snakeCoveringText(handle, &own).is_null());
        assert_eq!(shapeop_snakeSetDirection(handle, along, Z.as_ptr()), SO_SUCCESS);
        evolve(&snake, &shapeop_snake_options { max_steps: 4, step: 0.25, ..options() });
        assert_eq!(shapeop_snakeCovering(handle, ptr::null(), &mut told), SO_SUCCESS, "{}", message());
        assert_eq!((told.position_count, told.arc_count, told.kind_count, told.is_compared), (5, 25, 1, 0));
        assert!((told.length - 12.5).abs() < 1e-9 && (told.area - 2.5).abs() < 1e-2 && told.residual < 1e-12);
        // The wall of the arcs' cylinder, out by 0.01, twice as high.
        let at = |k: c_int| 1.25 * f64::from(k % 41) / 40.0;
        let wall: Vec<f64> =
            (0..41 * 2).flat_map(|k| [2.01 * at(k).sin(), 2.0 - 2.01 * at(k).cos(), 2.0 * f64::from(k / 41)]).collect();
        let quads: Vec<c_int> = (0..40).flat_map(|k| [k, k + 1, k + 42, k + 41]).collect();
        assert_eq!(shapeop_snakeSetMesh(handle, wall.as_ptr(), 82, quads.as_ptr(), 160, &4, 1), SO_SUCCESS);
        (own.distance, own.per_arc) = (0.05, 20);
        assert_eq!(shapeop_snakeCovering(handle, &own, &mut told), SO_SUCCESS, "{}", message());
        assert_eq!((told.is_compared, told.distance), (1, 0.05));
        assert!(
            (told.largest_deviation - 0.01).abs() < 1e-3 && told.rms_deviation <= told.largest_deviation,
            "{told:?}"
        );
        assert!((told.coverage - 0.52).abs() < 0.03 && (told.reference_area - 5.025).abs() < 0.01, "{told:?}");
        assert!(text(shapeop_snakeCoveringText(handle, &own)).contains("\"coverage\""));
        type Change = fn(&mut shapeop_snake_covering_options);
        let changes: [(&str, Change); 5] = [
            ("options->distance", |options| options.distance = -1.0),
            ("options->distance", |options| options.distance = f64::NAN),
            ("options->tolerance", |options| options.tolerance = -1.0),
            ("options->per_arc", |options| options.per_arc = 0),
            ("options->comes_back", |options| options.comes_back = 2),
        ];
        for (place, change) in changes {
            let mut own = own;
            change(&mut own);
            refused(shapeop_snakeCovering(handle, &own, &mut told), SO_INVALID_VALUE, place);
        }
        refused(shapeop_snakeCovering(handle, &own, ptr::null_mut()), SO_NULL_POINTER, "report");
    }
}
