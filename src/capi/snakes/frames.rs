//! The positions of a snake that were found last, by evolution or as a linkage.

use std::ffi::c_int;

use super::super::{c_count, code, number, shapeop_err};
use super::guard;
use super::io::{self, Outputs};
use super::snake::ShapeOpSnake;
use crate::error::Error;
use crate::geometry::snakes::draft::Track;
use crate::geometry::snakes::evolution::Frame;

/// The number of positions that were found last, or -1: nothing was found since the snake was put where it is.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeFrameCount(snake: *mut ShapeOpSnake) -> c_int {
    number(guard(snake, |draft| match draft.track()? {
        Track::Evolution(found) => c_count(found.frames.len()),
        Track::Cycle(found) => c_count(found.frames.len()),
    }))
}

/// Writes the control points of all positions that were found last, one position after the other, if there is room for
/// `capacity` points, and their number to `count`.
///
/// # Safety
/// `control` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeFrames(
    snake: *mut ShapeOpSnake,
    control: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("control", control, capacity, count, io::coordinates(&draft.frames()?.concat()), 3)? };
        outputs.write()
    }))
}

/// Writes the frames of the last evolution, 7 numbers each, if there is room for `capacity` of them, and their number to
/// `count`: the time; the deviation from the surface; by how much a distance or a rail is missed at most; by how much a
/// height differs from that at the start at most; by how much a distance of control points three apart is off, where
/// those are kept; by how much a distance was off before the projection; by how much the velocities that led there miss a
/// condition. In model units and times.
///
/// # Safety
/// `rows` is null or writable for `7 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeFrameRows(
    snake: *mut ShapeOpSnake,
    rows: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let all: Vec<f64> = draft.evolution()?.frames.iter().flat_map(Frame::figures).collect();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("rows", rows, capacity, count, all, 7)? };
        outputs.write()
    }))
}

/// Puts the snake to a position that was found last, from which it can move on. What was found is forgotten.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeTakeFrame(snake: *mut ShapeOpSnake, frame: c_int) -> shapeop_err {
    code(guard(snake, |draft| draft.take_frame(io::number("frame", frame)? as usize)))
}

/// Tells how far two positions, `a` and `b`, of those found last are from being the same up to a rigid motion, in model
/// units: to `rms` the root of the mean squared distance of control points after the motion for which it is least; to
/// `distances` by how much the distance of any two control points differs at most. Each output may be null.
///
/// # Safety
/// Each output is null or writable for one double.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCongruence(
    snake: *mut ShapeOpSnake,
    a: c_int,
    b: c_int,
    rms: *mut f64,
    distances: *mut f64,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let at = |name: &str, frame: c_int| -> crate::error::Result<usize> {
            let frame = io::number(name, frame)? as usize;
            draft.at(Some(frame)).map_err(|error: Error| match error.place() {
                "frame" => error.with_place(name),
                _ => error,
            })?;
            Ok(frame)
        };
        let found = draft.congruence(at("a", a)?, at("b", b)?)?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.may("rms", rms, vec![found.rms])?;
            outputs.may("distances", distances, vec![found.distances])?;
        }
        outputs.write()
    }))
}
