//! A snake as a linkage: its freedoms, and what was found of its motion.

use std::ffi::c_int;

use super::super::arguments::length;
use super::super::{c_count, code, number, shapeop_err};
use super::guard;
use super::io::{self, Outputs};
use super::snake::ShapeOpSnake;
use crate::error::{Error, Status};

/// Copies of a linkage at most.
const MOST_COPIES: usize = 100_000;

/// In how many independent ways an open snake can move whose first two control points and last two are fixed, or -1: one
/// of six arcs in one way, unless it is in a special position.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeLinkageFreedoms(snake: *mut ShapeOpSnake) -> c_int {
    number(guard(snake, |draft| c_count(draft.linkage()?.freedoms())))
}

/// Writes the determinant of the Plücker coordinates of the first six hinges of a linkage of six arcs to `determinant`,
/// moments in units of its size. It is 0 in singular positions; below 1e-6 or so one is near.
///
/// # Safety
/// `determinant` is null or writable for one double.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeDeterminant(snake: *mut ShapeOpSnake, determinant: *mut f64) -> shapeop_err {
    code(guard(snake, |draft| {
        let found = draft.linkage()?.determinant()?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for it.
        unsafe { outputs.must("determinant", determinant, vec![found])? };
        outputs.write()
    }))
}

/// Writes by how much the first and the last arc of the linkage are turned at each frame, 2 angles in radians each, if
/// there is room for `capacity` frames, and their number to `count`: counterclockwise about the first edge and the last.
///
/// # Safety
/// `angles` is null or writable for `2 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCycleAngles(
    snake: *mut ShapeOpSnake,
    angles: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let all = draft.motion()?.angles_rad.concat();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("angles", angles, capacity, count, all, 2)? };
        outputs.write()
    }))
}

/// Writes the path of a contact point of the linkage, one point for each frame, if there is room for `capacity` of them,
/// and their number to `count`.
///
/// # Safety
/// `points` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeContactPath(
    snake: *mut ShapeOpSnake,
    contact: c_int,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let paths = draft.motion()?.contact_paths()?;
        let path = &paths[io::index("contact", contact, paths.len())?];
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("points", points, capacity, count, io::coordinates(path), 3)? };
        outputs.write()
    }))
}

/// Writes the control points of the linkage at phases of its motion, one position after the other, if there is room for
/// `capacity` points, and their number to `count`. A phase of 0 is the start, 1 the start again, or the last position of a
/// motion that is not closed; phases go with the length of the way. Arcs keep their shapes to round-off.
///
/// # Safety
/// `phases` is null or readable for `nb_phases` doubles; `control` is null or writable for `3 * capacity` doubles, `count`
/// for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeAtPhases(
    snake: *mut ShapeOpSnake,
    phases: *const f64,
    nb_phases: c_int,
    control: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the array.
        let phases = unsafe { io::numbers("phases", phases, "nb_phases", nb_phases)? };
        let all = draft.motion()?.at_phases(&phases)?.concat();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("control", control, capacity, count, io::coordinates(&all), 3)? };
        outputs.write()
    }))
}

/// Writes the control points of `nb_copies` copies of the linkage that move together, one copy after the other, if there
/// is room for `capacity` points, and their number to `count`: copy `k` is at the phase `phase + k * shift`, and moved by
/// `k` times `offset`.
///
/// # Safety
/// `offset` is null or readable for 3 doubles; `control` is null or writable for `3 * capacity` doubles, `count` for one
/// int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCopies(
    snake: *mut ShapeOpSnake,
    nb_copies: c_int,
    phase: f64,
    shift: f64,
    offset: *const f64,
    control: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for 3 doubles.
        let offset = unsafe { io::vector("offset", offset)? };
        let copies = length("nb_copies", nb_copies)?;
        if copies > MOST_COPIES {
            let reason = format!("expected at most {MOST_COPIES}, found {copies}");
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("nb_copies"));
        }
        let (phase, shift) = (io::finite("phase", phase)?, io::finite("shift", shift)?);
        let all = draft.motion()?.copies(copies, phase, shift, offset)?.concat();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("control", control, capacity, count, io::coordinates(&all), 3)? };
        outputs.write()
    }))
}
