//! From C arguments to what the geometry takes, and back.

use std::ffi::{c_int, c_uint, c_void};
use std::ops::ControlFlow;

use super::super::c_count;
use super::super::structs::{self, SizedStruct};
use super::boundaries::shapeop_ruled_boundary_options;
use super::optimise::{shapeop_ruled_progress, shapeop_ruled_progress_callback};
use crate::error::{Error, Result, Status};
use crate::geometry::ruled::boundaries::BoundaryOptions;
use crate::mesh::curve::End;

pub(super) use super::super::arguments::{
    coordinates, finite_vector as vector, index, numbers, optional_vector, points, truth,
};
pub(super) use super::super::outputs::Outputs;

/// The error with the names of C's arguments in its place: the first pair whose first name begins it counts.
pub(super) fn placed(error: Error, names: &[(&str, &str)]) -> Error {
    let found = names.iter().find_map(|(from, to)| Some(format!("{to}{}", error.place().strip_prefix(from)?)));
    match found {
        Some(place) => error.with_place(place),
        None => error,
    }
}

/// A number from `least` to `most`.
pub(super) fn count(name: &str, value: c_int, least: usize, most: usize) -> Result<usize> {
    usize::try_from(value)
        .ok()
        .filter(|count| (least..=most).contains(count))
        .ok_or_else(|| Error::new(Status::InvalidValue, format!("expected {least} to {most}, found {value}")).at(name))
}

/// As [`count`], of a field of a struct.
pub(super) fn unsigned(name: &str, value: c_uint, least: usize, most: usize) -> Result<usize> {
    count(name, c_int::try_from(value).unwrap_or(c_int::MAX), least, most)
}

/// The start or the finish.
pub(super) fn end(value: c_int) -> Result<End> {
    Ok(if count("end", value, 0, 1)? == 0 { End::Start } else { End::Finish })
}

/// Indices as ints.
pub(super) fn ints(indices: impl IntoIterator<Item = usize>) -> Result<Vec<c_int>> {
    indices.into_iter().map(c_count).collect()
}

/// A count as a field of a struct.
pub(super) fn field(count: usize) -> c_uint {
    c_uint::try_from(count).unwrap_or(c_uint::MAX)
}

/// The caller's struct, or the defaults for null.
///
/// # Safety
/// `data` is null or readable for as many bytes as its `struct_size` says, and `T` is valid for any bytes.
pub(super) unsafe fn told<T: SizedStruct>(name: &str, data: *const T, defaults: T) -> Result<T> {
    if data.is_null() {
        return Ok(defaults);
    }
    // SAFETY: the caller vouches for it.
    unsafe { structs::read(name, data, defaults) }
}

/// Writes a struct with these numbers, which must be finite.
///
/// # Safety
/// `out` is null, or its `struct_size` is set and it is writable for so many bytes.
pub(super) unsafe fn tell<T: SizedStruct>(name: &str, out: *mut T, value: &T, numbers: &[f64]) -> Result<()> {
    if numbers.iter().any(|number| !number.is_finite()) {
        let reason = "coordinates are so large that the result is not finite";
        return Err(Error::new(Status::InvalidValue, reason).at(name));
    }
    // SAFETY: the caller vouches for it.
    unsafe { structs::tell(name, out, value) }
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
