//! Snakes on hinges.

use std::f64::consts::{FRAC_PI_3, PI};
use std::ffi::c_int;
use std::ptr;

use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

use super::*;

#[test]
fn a_linkage_moves_around() {
    let snake = six_arcs();
    assert_eq!(shapeop_snakeLinkageFreedoms(snake.0), 1);
    let mut determinant = 0.0;
    let mut own = defaults!(shapeop_snake_cycle_options, shapeop_snakeDefaultCycleOptions);
    let mut found = sized!(shapeop_snake_cycle);
    let (null, none) = (ptr::null_mut(), ptr::null_mut());
    // SAFETY: live outputs and structs; `all` gives room for the stated capacity.
    unsafe {
        assert_eq!(shapeop_snakeDeterminant(snake.0, &mut determinant), SO_SUCCESS);
        assert!(determinant.abs() > 1e-3, "{determinant}");
        refused(shapeop_snakeDeterminant(snake.0, null), SO_NULL_POINTER, "determinant");
        let mut count = 0;
        refused(shapeop_snakeCycleAngles(snake.0, null, 0, &mut count), SO_NOT_INITIALISED, "snake");
        assert_eq!(shapeop_snakeCycle(snake.0, &own, None, none, &mut found), SO_SUCCESS, "{}", message());
        assert_eq!((found.end, found.free), (shapeop_snake_cycle_end::SO_SNAKE_CYCLE_CLOSED, 1));
        assert!((0.0..1e-8).contains(&found.closing) && found.residual < 1e-11, "{found:?}");
        assert!((found.first_range - 1.1605).abs() < 2e-3 && (found.last_range - 1.8245).abs() < 2e-3, "{found:?}");
        assert_eq!((found.first_turns, found.last_turns), (0, 0));
        assert_eq!(shapeop_snakeFrameCount(snake.0), found.frame_count as c_int);
        let angles = all(0.0, 2, |out, room, count| shapeop_snakeCycleAngles(snake.0, out, room, count));
        assert_eq!(angles.len(), 2 * found.frame_count as usize);
        let range = |k: usize| {
            let of = || angles.iter().skip(k).step_by(2).copied();
            of().fold(f64::NEG_INFINITY, f64::max) - of().fold(f64::INFINITY, f64::min)
        };
        assert!((range(0) - found.first_range).abs() < 1e-3 && (range(1) - found.last_range).abs() < 1e-3);
        let frames = frames(&snake);
        assert!(frames.iter().all(|frame| distance(frame[0], frames[0][0]) + distance(frame[7], frames[0][7]) == 0.0));
        // A contact point of the first arc goes around its hinge.
        let path = |contact| {
            points(&all(0.0, 3, |out, room, count| shapeop_snakeContactPath(snake.0, contact, out, room, count)))
        };
        let hinge = frames[0][1];
        let apart: Vec<f64> = path(1).iter().map(|p| distance(*p, hinge)).collect();
        assert!(apart.iter().all(|d| (d - apart[0]).abs() < 1e-10) && path(0).iter().all(|p| length(*p) < 1e-12));
        refused(shapeop_snakeContactPath(snake.0, 7, null, 0, &mut count), SO_INDEX_OUT_OF_RANGE, "contact");
        // Phases: whole ones are the start; copies are phases with an offset.
        let phases = [0.0, 1.0, 0.3];
        let at = points(&all(0.0, 3, |out, room, count| {
            shapeop_snakeAtPhases(snake.0, phases.as_ptr(), 3, out, room, count)
        }));
        assert_eq!(at.len(), 24);
        assert!((0..8).all(|i| distance(at[i], frames[0][i]) < 1e-12 && distance(at[i + 8], frames[0][i]) < 1e-9));
        let copies = points(&all(0.0, 3, |out, room, count| {
            shapeop_snakeCopies(snake.0, 2, 0.1, 0.2, Z.as_ptr(), out, room, count)
        }));
        let lifted = (0..8).map(|i| distance(minus(copies[i + 8], Z), at[i + 16])).fold(0.0, f64::max);
        assert!(copies.len() == 16 && lifted < 1e-9, "{lifted}");
        let bad = [f64::NAN];
        refused(shapeop_snakeAtPhases(snake.0, bad.as_ptr(), 1, null, 0, &mut count), SO_INVALID_VALUE, "phases[0]");
        let copies = |copies, phase, shift, offset: *const f64| {
            let mut count = 0;
            shapeop_snakeCopies(snake.0, copies, phase, shift, offset, null, 0, &mut count)
        };
        refused(copies(-1, 0.0, 0.0, Z.as_ptr()), SO_INVALID_ARGUMENT_LENGTH, "nb_copies");
        refused(copies(i32::MAX, 0.0, 0.0, Z.as_ptr()), SO_INVALID_ARGUMENT_LENGTH, "nb_copies");
        refused(copies(1, f64::NAN, 0.0, Z.as_ptr()), SO_INVALID_VALUE, "phase");
        refused(copies(1, 0.0, f64::INFINITY, Z.as_ptr()), SO_INVALID_VALUE, "shift");
        refused(copies(1, 0.0, 0.0, NAN.as_ptr()), SO_INVALID_VALUE, "offset");
        refused(copies(1, 0.0, 0.0, ptr::null()), SO_NULL_POINTER, "offset");
        // An evolution has no angles, a cycle no times.
        refused(shapeop_snakeFrameRows(snake.0, null, 0, &mut count), SO_NOT_INITIALISED, "snake");
        // Watched, and stopped.
        let mut watching = watching(&snake, 5);
        let user = (&raw mut watching).cast();
        assert_eq!(shapeop_snakeCycle(snake.0, ptr::null(), Some(watch), user, &mut found), SO_SUCCESS);
        assert_eq!((found.end, found.closing), (shapeop_snake_cycle_end::SO_SNAKE_CYCLE_CANCELLED, -1.0));
        assert!(watching.was_busy && watching.angles.last().is_some_and(|angle| angle.abs() > 0.01));
        own.step = 0.3;
        refused(shapeop_snakeCycle(snake.0, &own, None, none, &mut found), SO_INVALID_VALUE, "options->step");
        (own.step, own.max_steps) = (0.02, 0);
        refused(shapeop_snakeCycle(snake.0, &own, None, none, &mut found), SO_INVALID_VALUE, "options->max_steps");
        (own.max_steps, own.is_reversed) = (9, 2);
        refused(shapeop_snakeCycle(snake.0, &own, None, none, &mut found), SO_INVALID_VALUE, "options->is_reversed");
        // Seven arcs move in two ways; two are no linkage; a closed one neither.
        let seven = made(&[1.0; 7], &[FRAC_PI_3; 7], &[1.0, -0.7, 0.9, -0.8, 0.6, 0.4]);
        assert_eq!(shapeop_snakeLinkageFreedoms(seven.0), 2);
        refused(shapeop_snakeCycle(seven.0, ptr::null(), None, none, &mut found), SO_INVALID_VALUE, "snake");
        refused(shapeop_snakeDeterminant(seven.0, &mut determinant), SO_INVALID_VALUE, "snake");
        let two = made(&[1.0; 2], &[1.0; 2], &[0.3]);
        assert_eq!(shapeop_snakeLinkageFreedoms(two.0), -1);
        assert!(names("snake"));
        let singular = made(&[1.0; 6], &[0.5 * PI; 6], &[1.2; 5]);
        assert_eq!(shapeop_snakeDeterminant(singular.0, &mut determinant), SO_SUCCESS);
        assert!(determinant.abs() < 1e-9);
        refused(shapeop_snakeCycle(singular.0, ptr::null(), None, none, &mut found), SO_SINGULAR, "snake");
    }
}
