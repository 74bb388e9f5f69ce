//! What a call hands out: all is checked before anything is written.

use std::ffi::c_int;

use super::arguments::{self, check_pointer, length};
use super::c_count;
use crate::error::{Error, Result, Status};

/// A value that an output can hold.
pub(super) trait Value: Copy + 'static {
    fn is_finite(&self) -> bool;
}

impl Value for f64 {
    fn is_finite(&self) -> bool {
        f64::is_finite(*self)
    }
}

impl Value for c_int {
    fn is_finite(&self) -> bool {
        true
    }
}

/// What a call is going to write: all is checked before anything is written.
#[derive(Default)]
pub(super) struct Outputs {
    writes: Vec<Box<dyn FnOnce()>>,
}

impl Outputs {
    /// Values for an output that must be there.
    ///
    /// # Safety
    /// `out` is null or writable for so many values.
    pub(super) unsafe fn must<T: Value>(&mut self, name: &str, out: *mut T, values: Vec<T>) -> Result<()> {
        check_pointer(name, out.cast_const(), values.len())?;
        if values.iter().any(|value| !value.is_finite()) {
            let reason = "coordinates are so large that the result is not finite";
            return Err(Error::new(Status::InvalidValue, reason).at(name));
        }
        // SAFETY: the pointer was checked, and the caller vouches for the rest.
        self.writes.push(Box::new(move || unsafe { arguments::write(out, &values) }));
        Ok(())
    }

    /// Values for an output that may be null.
    ///
    /// # Safety
    /// `out` is null or writable for so many values.
    pub(super) unsafe fn may<T: Value>(&mut self, name: &str, out: *mut T, values: Vec<T>) -> Result<()> {
        if out.is_null() {
            return Ok(());
        }
        // SAFETY: the caller vouches for it.
        unsafe { self.must(name, out, values) }
    }

    /// Values for an output of a stated capacity, in units of `unit` values, and their number for `count`. The values
    /// are written if they fit; the number always.
    ///
    /// # Safety
    /// `out` is null or writable for `unit * capacity` values, `count` for one int.
    pub(super) unsafe fn sized<T: Value>(
        &mut self,
        name: &str,
        out: *mut T,
        capacity: c_int,
        count: *mut c_int,
        values: Vec<T>,
        unit: usize,
    ) -> Result<()> {
        // SAFETY: the caller vouches for both.
        unsafe { self.sized_as([name, "capacity", "count"], out, capacity, count, values, unit) }
    }

    /// As [`Outputs::sized`], with the names of the output, of its capacity and of its number.
    ///
    /// # Safety
    /// As [`Outputs::sized`].
    pub(super) unsafe fn sized_as<T: Value>(
        &mut self,
        [name, capacity_name, count_name]: [&str; 3],
        out: *mut T,
        capacity: c_int,
        count: *mut c_int,
        values: Vec<T>,
        unit: usize,
    ) -> Result<()> {
        let capacity = length(capacity_name, capacity)?;
        check_pointer(name, out.cast_const(), capacity.saturating_mul(unit))?;
        check_pointer(count_name, count.cast_const(), 1)?;
        let needed = values.len() / unit;
        // SAFETY: the caller vouches for both.
        unsafe {
            self.must(count_name, count, vec![c_count(needed)?])?;
            if needed <= capacity { self.must(name, out, values) } else { Ok(()) }
        }
    }

    /// The number of results of a call for `count`, and whether there is room for them: for several outputs of one
    /// capacity, each of which may be null.
    ///
    /// # Safety
    /// `count` is null or writable for one int.
    pub(super) unsafe fn room(&mut self, capacity: c_int, count: *mut c_int, needed: usize) -> Result<bool> {
        let capacity = length("capacity", capacity)?;
        // SAFETY: the caller vouches for it.
        unsafe { self.must("count", count, vec![c_count(needed)?])? };
        Ok(needed <= capacity)
    }

    /// Anything else to be done when all is written.
    pub(super) fn then(&mut self, write: impl FnOnce() + 'static) {
        self.writes.push(Box::new(write));
    }

    /// Writes all.
    pub(super) fn write(self) -> Result<()> {
        self.writes.into_iter().for_each(|write| write());
        Ok(())
    }
}
