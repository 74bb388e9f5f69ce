//! Rails: curves that guide a snake.

use std::ffi::c_int;

use super::super::{c_count, code, number, shapeop_err};
use super::guard;
use super::io;
use super::snake::ShapeOpSnake;
use crate::error::Result;
use crate::geometry::snakes::draft::{Draft, Role};

/// The points of a rail, and whether it is closed.
struct Curve {
    points: *const f64,
    nb_points: c_int,
    is_closed: c_int,
}

/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles.
unsafe fn add(draft: &mut Draft, curve: &Curve, role: Role) -> Result<c_int> {
    // SAFETY: the caller vouches for the array.
    let points = unsafe { io::points("points", curve.points, "nb_points", curve.nb_points)? };
    c_count(draft.add_rail(&points, io::truth("is_closed", curve.is_closed)?, role)?)
}

/// Adds a rail along which a control point runs: the cubic spline through `nb_points` points, open or, with `is_closed`
/// 1, closed. The run begins at the rail's point nearest to the control point, which is on it. `speed` is in lengths of
/// the points' polygon per time; below 0 it runs against their order. The rail's number, from 0 on, or -1.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeDriveRail(
    snake: *mut ShapeOpSnake,
    point: c_int,
    points: *const f64,
    nb_points: c_int,
    is_closed: c_int,
    speed: f64,
) -> c_int {
    number(guard(snake, |draft| {
        let role = Role::Driven { point: io::number("point", point)?, speed: io::finite("speed", speed)? };
        // SAFETY: the caller vouches for the array.
        unsafe { add(draft, &Curve { points, nb_points, is_closed }, role) }
    }))
}

/// As `shapeop_snakeDriveRail`, for a control point that runs so that its distance from the point of the rail `leader`,
/// which is driven, stays.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeFollowRail(
    snake: *mut ShapeOpSnake,
    point: c_int,
    points: *const f64,
    nb_points: c_int,
    is_closed: c_int,
    leader: c_int,
) -> c_int {
    number(guard(snake, |draft| {
        let leader = io::number("leader", leader)? as usize;
        let role = Role::Following { point: io::number("point", point)?, leader };
        // SAFETY: the caller vouches for the array.
        unsafe { add(draft, &Curve { points, nb_points, is_closed }, role) }
    }))
}

/// Adds a rail that the snake stays in touch with, at whatever place of either: it begins at a contact point of the
/// snake, and crosses it there.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeGlideRail(
    snake: *mut ShapeOpSnake,
    contact: c_int,
    points: *const f64,
    nb_points: c_int,
    is_closed: c_int,
) -> c_int {
    number(guard(snake, |draft| {
        let role = Role::Gliding { contact: io::number("contact", contact)? };
        // SAFETY: the caller vouches for the array.
        unsafe { add(draft, &Curve { points, nb_points, is_closed }, role) }
    }))
}

/// The number of rails, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeRailCount(snake: *mut ShapeOpSnake) -> c_int {
    number(guard(snake, |draft| c_count(draft.guides().len())))
}

/// Takes all rails away.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeClearRails(snake: *mut ShapeOpSnake) -> shapeop_err {
    code(guard(snake, |draft| {
        draft.clear_rails();
        Ok(())
    }))
}
