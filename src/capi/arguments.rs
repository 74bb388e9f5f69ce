//! From pointers and counts to slices, texts and ids: each checked for what can be checked, with the argument's name.

use std::borrow::Cow;
use std::ffi::{CStr, c_char, c_int, c_uint};
use std::{ptr, slice};

use glam::DVec3;

use super::c_count;
use crate::constraints::ConstraintId;
use crate::error::{Error, Result, Status};

/// `count` as a length.
pub(super) fn length(name: &str, count: c_int) -> Result<usize> {
    let reason = || format!("expected a count of at least 0, found {count}");
    usize::try_from(count).map_err(|_| Error::new(Status::InvalidArgumentLength, reason()).at(name))
}

/// The number of coordinates of `count` points.
pub(super) fn xyz_length(name: &str, count: c_int) -> Result<usize> {
    let reason = || Error::new(Status::TooLarge, format!("{count} points do not fit the memory")).at(name);
    length(name, count)?.checked_mul(3).ok_or_else(reason)
}

/// Refuses a pointer that cannot lead to `length` values of `T`; any pointer leads to none.
pub(super) fn check_pointer<T>(name: &str, data: *const T, length: usize) -> Result<()> {
    if length == 0 {
        return Ok(());
    }
    if data.is_null() {
        return Err(Error::new(Status::NullPointer, "expected a pointer, found null").at(name));
    }
    if !data.is_aligned() {
        let reason = format!("expected an address that is a multiple of {}, found {data:?}", align_of::<T>());
        return Err(Error::new(Status::InvalidValue, reason).at(name));
    }
    if length.checked_mul(size_of::<T>()).is_none_or(|size| isize::try_from(size).is_err()) {
        return Err(Error::new(Status::TooLarge, format!("{length} values do not fit the memory")).at(name));
    }
    Ok(())
}

/// `length` values at `data`.
///
/// # Safety
/// `data` is null or readable for `length` values, which nobody writes during `'a`.
pub(super) unsafe fn slice<'a, T>(name: &str, data: *const T, length: usize) -> Result<&'a [T]> {
    check_pointer(name, data, length)?;
    if length == 0 {
        return Ok(&[]);
    }
    // SAFETY: not null, aligned, of a size that fits, and the caller vouches for the rest.
    Ok(unsafe { slice::from_raw_parts(data, length) })
}

/// Copies `values` to `out`, which [`check_pointer`] passed for their number.
///
/// # Safety
/// `out` is null or writable for `values.len()` values.
pub(super) unsafe fn write<T: Copy>(out: *mut T, values: &[T]) {
    if !out.is_null() {
        // SAFETY: the caller vouches for `out`; `values` is memory of this library, so they do not overlap.
        unsafe { ptr::copy_nonoverlapping(values.as_ptr(), out, values.len()) };
    }
}

/// A text in UTF-8; what is not UTF-8 is replaced by U+FFFD, which occurs in no name.
///
/// # Safety
/// `text` is null or leads to bytes that end with a zero and that nobody writes during `'a`.
pub(super) unsafe fn text<'a>(name: &str, text: *const c_char) -> Result<Cow<'a, str>> {
    check_pointer(name, text, 1)?;
    // SAFETY: not null, and the caller vouches for the rest.
    Ok(unsafe { CStr::from_ptr(text) }.to_string_lossy())
}

/// Three components.
///
/// # Safety
/// `vector` is null or readable for 3 doubles.
pub(super) unsafe fn vector(name: &str, vector: *const f64) -> Result<DVec3> {
    // SAFETY: the caller vouches for 3 doubles, and they are copied before this returns.
    unsafe { slice(name, vector, 3) }.map(DVec3::from_slice)
}

/// A constraint's id, which only the solver can check further.
pub(super) fn constraint_id(id: c_int) -> Result<ConstraintId> {
    let reason = || format!("expected an id of at least 0, found {id}");
    usize::try_from(id).map_err(|_| Error::new(Status::UnmatchingConstraintId, reason()).at("constraint id"))
}

/// A force's id, which only the solver can check further.
pub(super) fn force_id(id: c_int) -> Result<usize> {
    let reason = || format!("expected an id of at least 0, found {id}");
    usize::try_from(id).map_err(|_| Error::new(Status::UnmatchingForceId, reason()).at("force id"))
}

/// A point's index, which only the solver can check further.
pub(super) fn point_index(name: &str, index: c_int, point_count: usize) -> Result<u32> {
    let reason = || format!("{index} is out of range for {point_count} points");
    u32::try_from(index).map_err(|_| Error::new(Status::IndexOutOfRange, reason()).at(name))
}

/// Faces as lists of corners: `indices` behind each other, whose number the argument `name` is, and the number of corners of
/// each in `counts`, or one for all.
pub(super) fn faces(name: &str, indices: &[c_int], counts: &[c_int], point_count: usize) -> Result<Vec<Vec<u32>>> {
    let misfit = |name: &str, reason: String| Err(Error::new(Status::InvalidArgumentLength, reason).at(name));
    let counts: Vec<usize> = match *counts {
        [count] if count > 0 && !indices.len().is_multiple_of(count as usize) => {
            let reason = format!("expected a multiple of {count}, the corners of each face; found {}", indices.len());
            return misfit(name, reason);
        }
        [count] if count > 0 => vec![count as usize; indices.len() / count as usize],
        _ => {
            let all = counts.iter().enumerate();
            all.map(|(i, &count)| length(&format!("counts[{i}]"), count)).collect::<Result<_>>()?
        }
    };
    let index_count = counts.iter().fold(0_usize, |sum, &count| sum.saturating_add(count));
    if index_count != indices.len() {
        return misfit(name, format!("expected {index_count}, the sum of counts; found {}", indices.len()));
    }
    let mut faces = Vec::with_capacity(counts.len());
    let mut rest = indices;
    for (i, &count) in counts.iter().enumerate() {
        let (face, behind) = rest.split_at(count);
        rest = behind;
        let index = |(j, &index): (usize, &c_int)| point_index(&format!("faces[{i}][{j}]"), index, point_count);
        faces.push(face.iter().enumerate().map(index).collect::<Result<Vec<u32>>>()?);
    }
    Ok(faces)
}

/// # Safety
/// `data` is null or readable for `3 * count` doubles.
pub(super) unsafe fn points(name: &str, data: *const f64, count_name: &str, count: c_int) -> Result<Vec<DVec3>> {
    // SAFETY: the caller vouches for the array.
    let coordinates = unsafe { slice(name, data, xyz_length(count_name, count)?)? };
    Ok(coordinates.chunks_exact(3).map(DVec3::from_slice).collect())
}

/// # Safety
/// `data` is null or readable for `count` doubles.
pub(super) unsafe fn numbers(name: &str, data: *const f64, count_name: &str, count: c_int) -> Result<Vec<f64>> {
    // SAFETY: the caller vouches for the array.
    Ok(unsafe { slice(name, data, length(count_name, count)?)? }.to_vec())
}

/// A finite vector.
///
/// # Safety
/// `data` is null or readable for 3 doubles.
pub(super) unsafe fn finite_vector(name: &str, data: *const f64) -> Result<DVec3> {
    // SAFETY: the caller vouches for 3 doubles.
    let vector = unsafe { vector(name, data)? };
    if vector.is_finite() {
        return Ok(vector);
    }
    Err(Error::new(Status::InvalidValue, format!("expected finite numbers, found {vector}")).at(name))
}

/// A finite vector, or none for null.
///
/// # Safety
/// `data` is null or readable for 3 doubles.
pub(super) unsafe fn optional_vector(name: &str, data: *const f64) -> Result<Option<DVec3>> {
    if data.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller vouches for 3 doubles.
    unsafe { finite_vector(name, data) }.map(Some)
}

/// 0 or 1.
pub(super) fn truth(name: &str, value: c_int) -> Result<bool> {
    match value {
        0 | 1 => Ok(value == 1),
        _ => Err(Error::new(Status::InvalidValue, format!("expected 0 or 1, found {value}")).at(name)),
    }
}

/// An index below `count`.
pub(super) fn index(name: &str, value: c_int, count: usize) -> Result<usize> {
    usize::try_from(value).ok().filter(|&index| index < count).ok_or_else(|| {
        Error::new(Status::IndexOutOfRange, format!("expected an index below {count}, found {value}")).at(name)
    })
}

/// `x0 y0 z0 x1 ...`
pub(super) fn coordinates(points: &[DVec3]) -> Vec<f64> {
    points.iter().flat_map(DVec3::to_array).collect()
}

/// The error with another argument's name in its place.
pub(super) fn renamed(error: Error, from: &str, to: &str) -> Error {
    let place = error.place().to_owned();
    match place.strip_prefix(from) {
        Some(rest) if rest.is_empty() || rest.starts_with('[') => error.with_place(format!("{to}{rest}")),
        _ => error,
    }
}

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

/// Indices as ints.
pub(super) fn ints(indices: impl IntoIterator<Item = usize>) -> Result<Vec<c_int>> {
    indices.into_iter().map(c_count).collect()
}

/// A count as a field of a struct.
pub(super) fn field(count: usize) -> c_uint {
    c_uint::try_from(count).unwrap_or(c_uint::MAX)
}
