//! From C arguments to what the geometry takes, and back.

use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

use super::super::arguments::length;
use super::evolve::{shapeop_snake_progress, shapeop_snake_progress_callback};
use super::snake::SHAPEOP_SNAKE_NOW;
use crate::error::{Error, Result, Status};
use crate::mesh::grid::Grid;

pub(super) use super::super::arguments::{
    coordinates, count, field, finite_vector as vector, index, ints, numbers, placed, points, slice, truth,
};
pub(super) use super::super::outputs::Outputs;
pub(super) use super::super::structs::{tell_finite as tell, told};

/// Points along an arc, or around a pipe, at most.
pub(super) const MOST_INTERVALS: usize = 1 << 16;

/// An index that the geometry checks against what there is.
pub(super) fn number(name: &str, value: c_int) -> Result<u32> {
    let reason = || format!("expected an index of at least 0, found {value}");
    u32::try_from(value).map_err(|_| Error::new(Status::IndexOutOfRange, reason()).at(name))
}

/// A frame, or none for the snake as it is.
pub(super) fn frame(value: c_int) -> Result<Option<usize>> {
    if value == SHAPEOP_SNAKE_NOW { Ok(None) } else { Ok(Some(number("frame", value)? as usize)) }
}

/// The number of intervals of an arc.
pub(super) fn per_arc(value: c_int) -> Result<usize> {
    count("per_arc", value, 1, MOST_INTERVALS)
}

/// Refuses a number that is not finite.
pub(super) fn finite(name: &str, value: f64) -> Result<f64> {
    crate::error::finite(name, value)
}

/// Where a mesh of quads goes.
pub(super) struct Told {
    pub points: *mut f64,
    pub capacity: c_int,
    pub count: *mut c_int,
    pub quads: *mut c_int,
    pub quad_capacity: c_int,
    pub quad_count: *mut c_int,
}

/// Writes grids as one mesh.
///
/// # Safety
/// Each is null or writable for its number of values.
pub(super) unsafe fn tell_grids(grids: &[Grid], told: &Told) -> Result<()> {
    let (mut all, mut quads) = (Vec::new(), Vec::new());
    for grid in grids {
        let first = all.len() / 3;
        all.extend(coordinates(grid.points()));
        quads.extend(ints(grid.quads().flatten().map(|i| i + first))?);
    }
    length("quad_capacity", told.quad_capacity)?;
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for the outputs.
    unsafe {
        outputs.sized("points", told.points, told.capacity, told.count, all, 3)?;
        let names = ["quads", "quad_capacity", "quad_count"];
        outputs.sized_as(names, told.quads, told.quad_capacity, told.quad_count, quads, 4)?;
    }
    outputs.write()
}

/// Calls a caller's progress function, if there is one.
pub(super) fn call_back(
    progress: shapeop_snake_progress_callback,
    user: *mut c_void,
    told: &shapeop_snake_progress,
) -> ControlFlow<()> {
    let Some(progress) = progress else { return ControlFlow::Continue(()) };
    // SAFETY: the caller of the C function vouches for the function; `told` lives until it returns.
    match unsafe { progress(told, user) } {
        0 => ControlFlow::Continue(()),
        _ => ControlFlow::Break(()),
    }
}
