//! Structs that begin with their size, so that they can grow at the end without breaking callers.
//!
//! `struct_size` is `sizeof` the struct as the caller was compiled. A caller that is older than this library has a
//! shorter one: the fields that it does not have mean their defaults and are not written. A newer one has a longer one:
//! what lies beyond the fields known here must be zero where the caller asks for something, and is left as it is where
//! it is told.

use std::ffi::c_uint;
use std::{ptr, slice};

use super::arguments::check_pointer;
use crate::error::{Error, Result, Status};

/// No version's struct is larger; a caller that passes more did not set the size.
const LARGEST_STRUCT: usize = 4096;

/// A struct of the C ABI that begins with its size.
///
/// # Safety
/// It is `repr(C)` and its first field is `struct_size: c_uint`.
pub(super) unsafe trait SizedStruct: Copy {
    /// The sizes of the versions of this struct that a caller may have, ascending; each ends where a field begins or
    /// where the struct ends.
    const SIZES: &'static [usize];
}

/// The size that the caller's struct at `data` states.
///
/// # Safety
/// `data` is null or leads to an initialised `struct_size`.
pub(super) unsafe fn size<T: SizedStruct>(name: &str, data: *const T) -> Result<usize> {
    check_pointer(name, data, 1)?;
    // SAFETY: not null and aligned; `struct_size` is the first field, and the caller vouches that it is there.
    let size = unsafe { data.cast::<c_uint>().read() } as usize;
    if T::SIZES.contains(&size) || (size_of::<T>() < size && size <= LARGEST_STRUCT) {
        return Ok(size);
    }
    let reason = format!("expected sizeof the struct, {} in this version; found {size}", size_of::<T>());
    Err(Error::new(Status::InvalidValue, reason).at(format!("{name}->struct_size")))
}

/// The caller's struct at `data`; fields beyond its size are those of `defaults`.
///
/// # Safety
/// `data` is null or readable for as many bytes as its `struct_size` says, and `T` is valid for any bytes.
pub(super) unsafe fn read<T: SizedStruct>(name: &str, data: *const T, defaults: T) -> Result<T> {
    // SAFETY: the caller vouches for it.
    let size = unsafe { size(name, data)? };
    let known = size.min(size_of::<T>());
    // SAFETY: the caller vouches for `size` bytes, of which these are the last.
    let unknown = unsafe { slice::from_raw_parts(data.cast::<u8>().add(known), size - known) };
    if unknown.iter().any(|byte| *byte != 0) {
        let reason = "fields that this version does not know ask for something; they must be zero";
        return Err(Error::new(Status::InvalidValue, reason).at(name));
    }
    let mut value = defaults;
    // SAFETY: both are at least `known` bytes long, and any bytes make a `T`.
    unsafe { ptr::copy_nonoverlapping(data.cast::<u8>(), (&raw mut value).cast::<u8>(), known) };
    Ok(value)
}

/// Writes `value` to the caller's struct at `out`, of which [`size`] found the size. `struct_size` stays.
///
/// # Safety
/// `out` is writable for `size` bytes.
pub(super) unsafe fn write<T: SizedStruct>(out: *mut T, size: usize, value: &T) {
    let first = size_of::<c_uint>();
    let length = size.min(size_of::<T>()) - first;
    // SAFETY: every size in `SIZES` is beyond `struct_size`; the caller vouches for `out`, and `value` is our own
    // memory.
    unsafe {
        let from = ptr::from_ref(value).cast::<u8>().add(first);
        ptr::copy_nonoverlapping(from, out.cast::<u8>().add(first), length);
    }
}

/// Writes `value` to the caller's struct at `out` as far as its size goes. `struct_size` stays.
///
/// # Safety
/// `out` is null, or its `struct_size` is set and it is writable for so many bytes.
pub(super) unsafe fn tell<T: SizedStruct>(name: &str, out: *mut T, value: &T) -> Result<()> {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    unsafe {
        let size = size(name, out)?;
        write(out, size, value);
    }
    Ok(())
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
    unsafe { read(name, data, defaults) }
}

/// Writes a struct with these numbers, which must be finite.
///
/// # Safety
/// `out` is null, or its `struct_size` is set and it is writable for so many bytes.
pub(super) unsafe fn tell_finite<T: SizedStruct>(name: &str, out: *mut T, value: &T, numbers: &[f64]) -> Result<()> {
    if numbers.iter().any(|number| !number.is_finite()) {
        let reason = "coordinates are so large that the result is not finite";
        return Err(Error::new(Status::InvalidValue, reason).at(name));
    }
    // SAFETY: the caller vouches for it.
    unsafe { tell(name, out, value) }
}
