//! How snakes move.

use std::ffi::c_int;
use std::ptr;

use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

use super::*;

fn rail(
    call: unsafe extern "C" fn(*mut ShapeOpSnake, c_int, *const f64, c_int, c_int, f64) -> c_int,
    snake: &Snake,
    point: c_int,
    line: &[[f64; 3]],
    speed: f64,
) -> c_int {
    let flat = line.concat();
    // SAFETY: a live array of the stated length.
    unsafe { call(snake.0, point, flat.as_ptr(), line.len() as c_int, 0, speed) }
}

#[test]
fn a_snake_in_a_plane_moves_rigidly_in_it() {
    let snake = flat();
    set_surface(&snake, shapeop_snake_surface::SO_SNAKE_SURFACE_PLANE, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    sideways(&snake);
    let mut residual = -1.0;
    let (null, off) = (ptr::null(), &raw mut residual);
    // SAFETY: `all` gives room for the stated capacity; one double.
    let velocities =
        points(&all(0.0, 3, |out, room, count| unsafe { shapeop_snakeVelocity(snake.0, null, out, room, count, off) }));
    assert!((0.0..1e-12).contains(&residual) && velocities.iter().all(|v| v[2].abs() < 1e-9 && length(*v) > 0.1));
    let own = shapeop_snake_options { max_steps: 6, step: 0.02, ..options() };
    let found = evolve(&snake, &own);
    assert_eq!((found.stop, found.stop_rail, found.frame_count), (shapeop_snake_stop::SO_SNAKE_STOP_STEPS, -1, 7));
    assert!((found.time - 0.12).abs() < 1e-12 && found.residual < 1e-12 && found.deviation < 1e-12);
    let at = frames(&snake);
    assert_eq!((at.len(), &at[0]), (7, &control(&snake)));
    assert!(at.iter().flatten().all(|p| p[2].abs() < 1e-12) && distance(at[6][0], at[0][0]) > 0.05);
    // SAFETY: `all` gives room for the stated capacity; doubles, or null.
    unsafe {
        let rows = all(0.0, 7, |out, room, count| shapeop_snakeFrameRows(snake.0, out, room, count));
        assert!(rows.chunks_exact(7).enumerate().all(|(k, row)| (row[0] - 0.02 * k as f64).abs() < 1e-12));
        let (mut rms, mut apart) = (1.0, 1.0);
        assert_eq!(shapeop_snakeCongruence(snake.0, 0, 6, &mut rms, &mut apart), SO_SUCCESS);
        assert!(rms < 1e-12 && apart < 1e-12, "{rms} {apart}");
        let nothing = ptr::null_mut();
        assert_eq!(shapeop_snakeCongruence(snake.0, 2, 2, nothing, nothing), SO_SUCCESS);
        refused(shapeop_snakeCongruence(snake.0, 0, 7, &mut rms, nothing), SO_INDEX_OUT_OF_RANGE, "b");
        refused(shapeop_snakeCongruence(snake.0, -1, 0, &mut rms, nothing), SO_INDEX_OUT_OF_RANGE, "a");
        // A rigid motion keeps samples where they are on the snake.
        let sample = all(0.0, 3, |out, room, count| shapeop_snakeSample(snake.0, 6, 3, out, room, count));
        let center = [at[6][0], at[6][1]].map(|p| [p[0], p[1]]);
        assert!(sample.len() == 48 && center[0] != center[1]);
        let mut count = 0;
        let (room, none) = (ptr::null_mut(), 0);
        refused(shapeop_snakeSample(snake.0, 7, 3, room, none, &mut count), SO_INDEX_OUT_OF_RANGE, "frame");
        refused(shapeop_snakeSample(snake.0, 6, 0, room, none, &mut count), SO_INVALID_VALUE, "per_arc");
        refused(shapeop_snakeArcs(snake.0, -2, room, none, &mut count), SO_INDEX_OUT_OF_RANGE, "frame");
    }
    // From the last position it goes on.
    refused(shapeop_snakeTakeFrame(snake.0, 7), SO_INDEX_OUT_OF_RANGE, "frame");
    assert_eq!(shapeop_snakeTakeFrame(snake.0, 6), SO_SUCCESS);
    assert_eq!(control(&snake), at[6]);
    assert_eq!(shapeop_snakeFrameCount(snake.0), -1);
    assert_eq!(shapeop_lastErrorCode(ptr::null_mut()), SO_NOT_INITIALISED);
    // From the equator of a torus it does not stay on it.
    let snake = flat();
    let torus = [0.0, 2.0, 0.0, 0.0, 0.0, 1.0, 1.6, 0.4];
    set_surface(&snake, shapeop_snake_surface::SO_SNAKE_SURFACE_TORUS, &torus);
    sideways(&snake);
    let found = evolve(&snake, &shapeop_snake_options { max_steps: 1000, max_deviation: 0.002, ..own });
    assert_eq!(found.stop, shapeop_snake_stop::SO_SNAKE_STOP_DEVIATION);
    assert!(found.stop_distance > 0.002 && found.deviation <= 0.002 && found.frame_count > 1, "{found:?}");
}

#[test]
fn a_run_is_watched_and_cancelled() {
    let snake = twisted();
    let (along, up) = (shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int, Z);
    let (mut watching, mut found) = (watching(&snake, 3), sized!(shapeop_snake_evolution));
    // SAFETY: live vectors and structs; the callback gets what it expects.
    unsafe {
        assert_eq!(shapeop_snakeSetDirection(snake.0, along, up.as_ptr()), SO_SUCCESS);
        let user = (&raw mut watching).cast();
        assert_eq!(shapeop_snakeEvolve(snake.0, ptr::null(), Some(watch), user, &mut found), SO_SUCCESS);
    }
    assert_eq!((found.stop, found.frame_count), (shapeop_snake_stop::SO_SNAKE_STOP_CANCELLED, 4));
    assert!(watching.was_busy && watching.steps == [0, 1, 2, 3] && watching.times[3] == found.time);
    assert_eq!(message(), "");
}

#[test]
fn bad_options_are_named() {
    let snake = twisted();
    type Change = fn(&mut shapeop_snake_options);
    let changes: [(&str, Change); 16] = [
        ("options->step", |options| options.step = 0.0),
        ("options->step", |options| options.step = f64::NAN),
        ("options->least_step", |options| options.least_step = 2.0),
        ("options->max_deviation", |options| options.max_deviation = f64::NAN),
        ("options->tangential", |options| options.tangential = -1.0),
        ("options->offset", |options| options.offset = f64::INFINITY),
        ("options->rotation", |options| options.rotation = f64::NAN),
        ("options->orthogonal", |options| options.orthogonal = -0.1),
        ("options->alpha", |options| options.alpha = 0.0),
        ("options->mu", |options| options.mu = 0.0),
        ("options->surface_weight", |options| options.surface_weight = -1.0),
        ("options->is_second_order", |options| options.is_second_order = 2),
        ("options->keeps_torsions", |options| options.keeps_torsions = -1),
        ("options->stops_at_cycle", |options| options.stops_at_cycle = 7),
        ("options->is_exact", |options| options.is_exact = 3),
        ("options->struct_size", |options| options.struct_size = 11),
    ];
    let (mut out, mut count) = ([0.0; 15], 0);
    for (place, change) in changes {
        let mut own = options();
        change(&mut own);
        let null = ptr::null_mut();
        // SAFETY: a live struct; room for five points.
        unsafe {
            refused(shapeop_snakeEvolve(snake.0, &own, None, null, ptr::null_mut()), SO_INVALID_VALUE, place);
            let (to, count) = (out.as_mut_ptr(), &raw mut count);
            refused(shapeop_snakeVelocity(snake.0, &own, to, 5, count, ptr::null_mut()), SO_INVALID_VALUE, place);
        }
    }
    assert_eq!((out, count), ([0.0; 15], 0));
    // Sideways needs a surface; a closed snake of five arcs is rigid.
    sideways(&snake);
    // SAFETY: null for what is left out.
    unsafe {
        let (null, none) = (ptr::null(), ptr::null_mut());
        refused(shapeop_snakeEvolve(snake.0, null, None, none, ptr::null_mut()), SO_INVALID_VALUE, "direction");
        let rigid = Snake(create(&ring(5, 0.0), 1, 0.0));
        let code = shapeop_snakeEvolve(rigid.0, null, None, none, ptr::null_mut());
        refused(code, SO_INVALID_ARGUMENT_LENGTH, "snake");
        let code = shapeop_snakeDefaultOptions(ptr::null_mut());
        refused(code, SO_NULL_POINTER, "options");
    }
}

#[test]
fn wishes_move_the_points_that_they_are_for() {
    let snake = twisted();
    // SAFETY: live vectors and arrays, or null that is to be refused.
    unsafe {
        assert_eq!(shapeop_snakeSetFixed(snake.0, [0].as_ptr(), 1), SO_SUCCESS, "{}", message());
        assert_eq!(shapeop_snakeWishVelocity(snake.0, 4, Z.as_ptr(), 1.0), SO_SUCCESS, "{}", message());
        let velocities = || {
            let null = ptr::null();
            points(&all(0.0, 3, |out, room, count| {
                shapeop_snakeVelocity(snake.0, null, out, room, count, ptr::null_mut())
            }))
        };
        let found = velocities();
        assert!(length(found[0]) < 1e-9 && distance(found[4], Z) < 1e-6, "{found:?}");
        // In a plane, and of the wish what is left in it.
        assert_eq!(shapeop_snakeWishPlane(snake.0, 4, [0.0, 5.0, 5.0].as_ptr(), 1e6), SO_SUCCESS);
        let found = velocities();
        assert!((found[4][1] + found[4][2]).abs() < 1e-3 && (found[4][2] - 0.5).abs() < 0.2, "{:?}", found[4]);
        assert_eq!(shapeop_snakeClearWishes(snake.0), SO_SUCCESS);
        assert!(velocities().iter().all(|v| length(*v) < 1e-9));
        let (along, speeds) = (shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int, [2.0, 2.0, 2.0, 2.0, 2.0]);
        assert_eq!(shapeop_snakeSetFixed(snake.0, ptr::null(), 0), SO_SUCCESS);
        assert_eq!(shapeop_snakeSetDirection(snake.0, along, Y.as_ptr()), SO_SUCCESS);
        assert_eq!(shapeop_snakeSetSpeeds(snake.0, speeds.as_ptr(), 5), SO_SUCCESS);
        assert!(velocities().iter().all(|v| distance(*v, [0.0, 2.0, 0.0]) < 1e-6), "{:?}", velocities());

        refused(shapeop_snakeSetFixed(snake.0, [0, 5].as_ptr(), 2), SO_INDEX_OUT_OF_RANGE, "points[1]");
        refused(shapeop_snakeSetFixed(snake.0, [1, 1].as_ptr(), 2), SO_INVALID_VALUE, "points[1]");
        refused(shapeop_snakeSetFixed(snake.0, [-1].as_ptr(), 1), SO_INDEX_OUT_OF_RANGE, "points[0]");
        refused(shapeop_snakeSetFixed(snake.0, ptr::null(), 1), SO_NULL_POINTER, "points");
        refused(shapeop_snakeWishVelocity(snake.0, 5, Z.as_ptr(), 1.0), SO_INDEX_OUT_OF_RANGE, "point");
        refused(shapeop_snakeWishVelocity(snake.0, -1, Z.as_ptr(), 1.0), SO_INDEX_OUT_OF_RANGE, "point");
        refused(shapeop_snakeWishVelocity(snake.0, 0, NAN.as_ptr(), 1.0), SO_INVALID_VALUE, "velocity");
        refused(shapeop_snakeWishVelocity(snake.0, 0, ptr::null(), 1.0), SO_NULL_POINTER, "velocity");
        refused(shapeop_snakeWishVelocity(snake.0, 0, Z.as_ptr(), -1.0), SO_INVALID_VALUE, "weight");
        refused(shapeop_snakeWishPlane(snake.0, 0, ORIGIN.as_ptr(), 1.0), SO_INVALID_VALUE, "normal");
        refused(shapeop_snakeWishPlane(snake.0, 0, Z.as_ptr(), f64::NAN), SO_INVALID_VALUE, "weight");
        refused(shapeop_snakeSetDirection(snake.0, 3, Z.as_ptr()), SO_INVALID_VALUE, "kind");
        refused(shapeop_snakeSetDirection(snake.0, along, ptr::null()), SO_NULL_POINTER, "along");
        refused(shapeop_snakeSetDirection(snake.0, along, ORIGIN.as_ptr()), SO_INVALID_VALUE, "along");
        refused(shapeop_snakeSetSpeeds(snake.0, speeds.as_ptr(), 2), SO_INVALID_ARGUMENT_LENGTH, "nb_speeds");
        refused(shapeop_snakeSetSpeeds(snake.0, NAN.as_ptr().add(1), 1), SO_INVALID_VALUE, "speeds[0]");
    }
    // What was refused changed nothing.
    let found = evolve(&snake, &shapeop_snake_options { max_steps: 1, ..options() });
    assert!(distance(frames(&snake)[1][0], [0.0, 2.0 * found.time, 0.0]) < 1e-6);
}

#[test]
fn rails_lead_a_snake() {
    let snake = made(&[1.0, 2.0, 1.5], &[1.2, 1.5, 1.0], &[0.7, -0.4]);
    let moved: Vec<f64> = control(&snake).iter().flat_map(|p| [p[0] + 4.0, p[1], p[2]]).collect();
    // SAFETY: a live array of the stated length.
    unsafe { assert_eq!(shapeop_snakeSetControl(snake.0, moved.as_ptr(), 5), SO_SUCCESS) };
    let (at, middle) = (control(&snake), contacts(&snake)[1]);
    // Both ends and a contact point turn about the z axis: so does the snake, rigidly.
    let [first, last, inner] = [at[0], at[4], middle].map(|point| around(point, [-0.25, 0.75]));
    assert_eq!(rail(shapeop_snakeDriveRail, &snake, 0, &first, at[0][0]), 0, "{}", message());
    let (flat_last, flat_inner) = (last.concat(), inner.concat());
    // SAFETY: live arrays of the stated lengths.
    unsafe {
        assert_eq!(shapeop_snakeFollowRail(snake.0, 4, flat_last.as_ptr(), ON_RAIL + 1, 0, 0), 1, "{}", message());
        assert_eq!(shapeop_snakeGlideRail(snake.0, 1, flat_inner.as_ptr(), ON_RAIL + 1, 0), 2, "{}", message());
    }
    assert_eq!(shapeop_snakeRailCount(snake.0), 3);
    let own = shapeop_snake_options { keeps_torsions: 1, step: 0.05, max_steps: 100, ..options() };
    let found = evolve(&snake, &own);
    assert_eq!((found.stop, found.stop_rail), (shapeop_snake_stop::SO_SNAKE_STOP_RAIL_END, 0), "{found:?}");
    let last_frame = found.frame_count as c_int - 1;
    let (mut rms, mut apart) = (1.0, 1.0);
    // SAFETY: doubles.
    unsafe { assert_eq!(shapeop_snakeCongruence(snake.0, 0, last_frame, &mut rms, &mut apart), SO_SUCCESS) };
    assert!(rms < 1e-6 && last_frame > 5, "{rms} {found:?}");
    let frames = frames(&snake);
    let (end, from) = (frames[last_frame as usize][0], at[0]);
    let angle = (from[0] * end[1] - from[1] * end[0]).atan2(from[0] * end[0] + from[1] * end[1]);
    assert!(angle > 0.7 && frames.iter().all(|frame| (frame[0][0].hypot(frame[0][1]) - 4.0).abs() < 1e-6), "{angle}");

    let line = [at[0], [at[0][0], at[0][1] + 1.0, at[0][2]]];
    let drive = |point, line: &[[f64; 3]], speed, place: &str| {
        assert_eq!(rail(shapeop_snakeDriveRail, &snake, point, line, speed), -1);
        assert!(names(place));
    };
    drive(0, &line, 1.0, "point");
    drive(9, &line, 1.0, "point");
    drive(-1, &line, 1.0, "point");
    drive(1, &line, 1.0, "points");
    drive(1, &line, f64::NAN, "speed");
    drive(1, &line[..1], 1.0, "points");
    drive(1, &[at[1], NAN], 1.0, "points[1]");
    let at_vertex = [at[1], at[2]].concat();
    // SAFETY: live arrays of the stated lengths, or null.
    unsafe {
        assert_eq!(shapeop_snakeFollowRail(snake.0, 1, at_vertex.as_ptr(), 2, 0, 1), -1);
        assert!(names("leader"));
        assert_eq!(shapeop_snakeFollowRail(snake.0, 1, at_vertex.as_ptr(), 2, 0, -1), -1);
        assert!(names("leader"));
        assert_eq!(shapeop_snakeGlideRail(snake.0, 4, at_vertex.as_ptr(), 2, 0), -1);
        assert!(names("contact"));
        assert_eq!(shapeop_snakeGlideRail(snake.0, 0, ptr::null(), 2, 0), -1);
        assert!(names("points"));
        assert_eq!(shapeop_snakeGlideRail(snake.0, 0, at_vertex.as_ptr(), 2, 3), -1);
        assert!(names("is_closed"));
        let along = [at[0], at[1]].concat();
        assert_eq!(shapeop_snakeGlideRail(snake.0, 0, along.as_ptr(), 2, 0), -1);
        assert!(names("points") && shapeop_lastErrorCode(ptr::null_mut()) == SO_DEGENERATE);
    }
    assert_eq!(shapeop_snakeRailCount(snake.0), 3);
    assert_eq!(shapeop_snakeClearRails(snake.0), SO_SUCCESS);
    assert_eq!(shapeop_snakeRailCount(snake.0), 0);
}
