//! Points: in, out, and how many.

use std::ffi::c_int;

use glam::DVec3;

use super::arguments::{check_pointer, slice, xyz_length};
use super::handles::ShapeOpSolver;
use super::{c_count, guard, guard_read, number};
use crate::error::{Error, Result, Status};

/// Replaces the positions: `points` holds `x0 y0 z0 x1 ...` in model units. Rest states, targets and velocities stay.
/// Their number may change as long as no constraint or force refers beyond it; added points start at rest. Refused,
/// with nothing changed, if it may not, or if a coordinate is not finite.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_setPoints(op: *mut ShapeOpSolver, points: *mut f64, nb_points: c_int) {
    let _ = guard(op, |solver| {
        // SAFETY: the caller vouches for so many doubles.
        let coordinates = unsafe { slice("points", points.cast_const(), xyz_length("nb_points", nb_points)?)? };
        let points: Vec<DVec3> = coordinates.chunks_exact(3).map(DVec3::from_slice).collect();
        solver.set_points(&points)
    });
}

/// Copies the positions to `points` as `x0 y0 z0 x1 ...` in model units. `nb_points` must be the solver's number of
/// points; otherwise nothing is written. From inside the progress callback: the current iterate.
///
/// # Safety
/// `points` is null or writable for `3 * nb_points` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_getPoints(op: *mut ShapeOpSolver, points: *mut f64, nb_points: c_int) {
    let _ = guard_read(op, |solver| {
        let from = solver.points();
        check_count("nb_points", nb_points, from.len(), "points")?;
        check_pointer("points", points, xyz_length("nb_points", nb_points)?)?;
        for (i, point) in from.iter().enumerate() {
            // SAFETY: there are `nb_points` points, and the caller vouches for 3 doubles for each.
            unsafe { points.add(3 * i).cast::<[f64; 3]>().write(point.to_array()) };
        }
        Ok(())
    });
}

/// The number of points, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_pointCount(op: *mut ShapeOpSolver) -> c_int {
    number(guard_read(op, |solver| c_count(solver.points().len())))
}

/// The number of points that no constraint of a weight above 0 holds, or -1. In static mode they keep their place.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_unconstrainedCount(op: *mut ShapeOpSolver) -> c_int {
    number(guard_read(op, |solver| c_count(solver.unconstrained_count())))
}

/// Refuses a length that is not the solver's number of `things`.
pub(super) fn check_count(name: &str, count: c_int, expected: usize, things: &str) -> Result<()> {
    if usize::try_from(count) == Ok(expected) {
        return Ok(());
    }
    let reason = format!("expected {expected}, the number of {things}; found {count}");
    Err(Error::new(Status::InvalidArgumentLength, reason).at(name))
}
