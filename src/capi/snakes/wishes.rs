//! What a snake is to do: directions, speeds, fixed points, wishes for velocities.

use std::ffi::c_int;

use super::super::arguments::length;
use super::super::{code, shapeop_err};
use super::guard;
use super::io;
use super::snake::ShapeOpSnake;
use crate::error::Result;
use crate::geometry::snakes::evolution::Direction;

/// Which way control points are to move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_snake_direction {
    /// None is given: rails or other wishes say it. So it is at first.
    SO_SNAKE_DIRECTION_FREE = 0,
    /// To the left of the snake within its surface, seen from the side that the surface's normals point to.
    SO_SNAKE_DIRECTION_SIDEWAYS = 1,
    /// All along one vector.
    SO_SNAKE_DIRECTION_ALONG = 2,
}

/// Takes the direction (a `shapeop_snake_direction`) in which control points are to move. `along` is a vector of any
/// length above 0, or null for the other two.
///
/// # Safety
/// `along` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeSetDirection(
    snake: *mut ShapeOpSnake,
    kind: c_int,
    along: *const f64,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let direction = match io::count("kind", kind, 0, 2)? {
            0 => Direction::Free,
            1 => Direction::Sideways,
            // SAFETY: the caller vouches for 3 doubles.
            _ => Direction::Along(unsafe { io::vector("along", along)? }),
        };
        draft.set_direction(direction).map_err(|error| error.with_place("along"))
    }))
}

/// Takes speeds in that direction, in model units per time: one for all control points, or one for each. At first they
/// are 1.
///
/// # Safety
/// `speeds` is null or readable for `nb_speeds` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeSetSpeeds(
    snake: *mut ShapeOpSnake,
    speeds: *const f64,
    nb_speeds: c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the array.
        let speeds = unsafe { io::numbers("speeds", speeds, "nb_speeds", nb_speeds)? };
        draft.set_speeds(speeds).map_err(|error| match error.place() {
            "speeds" => error.with_place("nb_speeds"),
            _ => error,
        })
    }))
}

/// Takes the control points that stay where they are, `nb_points` of them, in place of those before.
///
/// # Safety
/// `points` is null or readable for `nb_points` ints.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeSetFixed(
    snake: *mut ShapeOpSnake,
    points: *const c_int,
    nb_points: c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the array.
        let points = unsafe { io::slice("points", points, length("nb_points", nb_points)?)? };
        let all = points.iter().enumerate().map(|(k, &i)| io::number(&format!("points[{k}]"), i));
        draft.set_fixed(all.collect::<Result<_>>()?).map_err(|error| io::placed(error, &[("fixed", "points")]))
    }))
}

/// Wishes that a control point moves with this velocity, in model units per time. What it differs by is squared and
/// multiplied by `weight`, 0 or more. Wishes add up until `shapeop_snakeClearWishes`.
///
/// # Safety
/// `velocity` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeWishVelocity(
    snake: *mut ShapeOpSnake,
    point: c_int,
    velocity: *const f64,
    weight: f64,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for 3 doubles.
        let velocity = unsafe { io::vector("velocity", velocity)? };
        draft.wish_velocity(io::number("point", point)?, velocity, weight)
    }))
}

/// Wishes that a control point moves in the plane with this normal, of any length above 0, with a weight.
///
/// # Safety
/// `normal` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeWishPlane(
    snake: *mut ShapeOpSnake,
    point: c_int,
    normal: *const f64,
    weight: f64,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for 3 doubles.
        let normal = unsafe { io::vector("normal", normal)? };
        draft.wish_plane(io::number("point", point)?, normal, weight)
    }))
}

/// Takes all wishes away.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeClearWishes(snake: *mut ShapeOpSnake) -> shapeop_err {
    code(guard(snake, |draft| {
        draft.clear_wishes();
        Ok(())
    }))
}
