//! From C arguments to what the geometry takes, and back.

use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

use super::boundaries::shapeop_ruled_boundary_options;
use super::optimise::{shapeop_ruled_progress, shapeop_ruled_progress_callback};
use crate::error::Result;
use crate::geometry::ruled::boundaries::BoundaryOptions;
use crate::mesh::curve::End;

pub(super) use super::super::arguments::{
    coordinates, count, field, finite_vector as vector, index, ints, numbers, optional_vector, placed, points, truth,
    unsigned,
};
pub(super) use super::super::outputs::Outputs;
pub(super) use super::super::structs::{tell_finite as tell, told};

/// The start or the finish.
pub(super) fn end(value: c_int) -> Result<End> {
    Ok(if count("end", value, 0, 1)? == 0 { End::Start } else { End::Finish })
}

/// # Safety
/// `options` is null, or its `struct_size` is set and it is readable for so many bytes.
pub(super) unsafe fn boundary_options(options: *const shapeop_ruled_boundary_options) -> Result<BoundaryOptions> {
    // SAFETY: the caller vouches for it; numbers are valid for any bytes.
    let told = unsafe { told("boundaries", options, shapeop_ruled_boundary_options::default())? };
    Ok(BoundaryOptions {
        extends: truth("boundaries->extends", told.extends)?,
        overshoots: truth("boundaries->overshoots", told.overshoots)?,
        least_length: told.least_length,
    })
}

/// Calls a caller's progress function, if there is one.
pub(super) fn call_back(
    progress: shapeop_ruled_progress_callback,
    user: *mut c_void,
    told: &shapeop_ruled_progress,
) -> ControlFlow<()> {
    let Some(progress) = progress else { return ControlFlow::Continue(()) };
    // SAFETY: the caller of the C function vouches for the function; `told` lives until it returns.
    match unsafe { progress(told, user) } {
        0 => ControlFlow::Continue(()),
        _ => ControlFlow::Break(()),
    }
}
