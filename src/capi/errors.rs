//! Error codes, their texts, and the versions.

use std::ffi::{CStr, CString, c_char, c_int};
use std::sync::OnceLock;

use super::handles::{Handle, ShapeOpSolver};
use super::messages;
use crate::error::Status;

/// The version of the ABI that `shapeop_abiVersion` answers: raised when a caller must know of a change. Functions,
/// error codes and fields at the end of structs may be added without that.
pub const SHAPEOP_ABI_VERSION: c_int = 1;

/// Why a call was refused. The numbers are frozen: 0 to 3 are those of libShapeOp 0.1.0, new ones are added from 16 up.
#[cfg(not(shapeop_compat_header))]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_err {
    /// The call did what it says.
    SO_SUCCESS = 0,
    /// The constraint type does not exist, or cannot be edited.
    SO_INVALID_CONSTRAINT_TYPE = 1,
    /// A count (of indices, scalars, points) does not fit.
    SO_INVALID_ARGUMENT_LENGTH = 2,
    /// The id is no constraint of that type.
    SO_UNMATCHING_CONSTRAINT_ID = 3,
    /// A number is outside its domain, or not finite.
    SO_INVALID_VALUE = 16,
    /// An index is out of range.
    SO_INDEX_OUT_OF_RANGE = 17,
    /// The id is no force of that kind.
    SO_UNMATCHING_FORCE_ID = 18,
    /// Another call must come first: a solver is not initialised, or nothing was found yet that could be told.
    SO_NOT_INITIALISED = 19,
    /// A force acts along a motion that no constraint resists.
    SO_UNBOUNDED = 20,
    /// Another call is using the solver, surface, design or snake.
    SO_BUSY = 21,
    /// The handle is null, was deleted, or never was one of such an object.
    SO_INVALID_HANDLE = 22,
    /// A required pointer is null.
    SO_NULL_POINTER = 23,
    /// A file or text could not be read as what it claims to be.
    SO_INVALID_INPUT = 24,
    /// The problem is too large for this machine or for the numbers of this ABI.
    SO_TOO_LARGE = 25,
    /// An error inside the library: please report it.
    SO_INTERNAL = 26,
    /// The mesh is no grid of quads.
    SO_NOT_GRID = 27,
    /// Points that must be on one plane are not.
    SO_NOT_PLANAR = 28,
    /// Points that must be on one circle are not.
    SO_NOT_CIRCULAR = 29,
    /// The input is in a special position where no answer is defined.
    SO_DEGENERATE = 30,
    /// Two shapes that must meet do not.
    SO_NO_INTERSECTION = 31,
    /// No solution exists for this input.
    SO_NO_SOLUTION = 32,
    /// Equations do not determine an answer: edges of a quad that are to meet are parallel, or derivatives lose rank.
    SO_SINGULAR = 33,
    /// A ring does not close.
    SO_NOT_CLOSED = 34,
    /// The mesh is no oriented surface: an edge has more than two faces, or faces disagree about what is up.
    SO_NOT_MANIFOLD = 35,
    /// The surface is not negatively curved where it must be.
    SO_CURVATURE_SIGN = 36,
    /// No consistent choice of directions exists over the whole surface.
    SO_NOT_ORIENTABLE = 37,
    /// Side conditions contradict each other.
    SO_INFEASIBLE = 38,
    /// What is asked for lies outside the surface, or outside the values of a function.
    SO_OUT_OF_DOMAIN = 39,
    /// There is no graphics card to solve on, or not enough of it; or the library was built without the feature `gpu`.
    SO_BACKEND_UNAVAILABLE = 40,
    /// The graphics card was lost or refused work; the points are those of the last read-back.
    SO_BACKEND_FAILED = 41,
}

impl From<Status> for shapeop_err {
    fn from(status: Status) -> Self {
        match status {
            Status::InvalidConstraintType => Self::SO_INVALID_CONSTRAINT_TYPE,
            Status::InvalidArgumentLength => Self::SO_INVALID_ARGUMENT_LENGTH,
            Status::UnmatchingConstraintId => Self::SO_UNMATCHING_CONSTRAINT_ID,
            Status::InvalidValue => Self::SO_INVALID_VALUE,
            Status::IndexOutOfRange => Self::SO_INDEX_OUT_OF_RANGE,
            Status::UnmatchingForceId => Self::SO_UNMATCHING_FORCE_ID,
            Status::NotInitialised => Self::SO_NOT_INITIALISED,
            Status::Unbounded => Self::SO_UNBOUNDED,
            Status::Busy => Self::SO_BUSY,
            Status::InvalidHandle => Self::SO_INVALID_HANDLE,
            Status::NullPointer => Self::SO_NULL_POINTER,
            Status::InvalidInput => Self::SO_INVALID_INPUT,
            Status::TooLarge => Self::SO_TOO_LARGE,
            Status::Internal => Self::SO_INTERNAL,
            Status::NotGrid => Self::SO_NOT_GRID,
            Status::NotPlanar => Self::SO_NOT_PLANAR,
            Status::NotCircular => Self::SO_NOT_CIRCULAR,
            Status::Degenerate => Self::SO_DEGENERATE,
            Status::NoIntersection => Self::SO_NO_INTERSECTION,
            Status::NoSolution => Self::SO_NO_SOLUTION,
            Status::Singular => Self::SO_SINGULAR,
            Status::NotClosed => Self::SO_NOT_CLOSED,
            Status::NotManifold => Self::SO_NOT_MANIFOLD,
            Status::CurvatureSign => Self::SO_CURVATURE_SIGN,
            Status::NotOrientable => Self::SO_NOT_ORIENTABLE,
            Status::Infeasible => Self::SO_INFEASIBLE,
            Status::OutOfDomain => Self::SO_OUT_OF_DOMAIN,
            Status::BackendUnavailable => Self::SO_BACKEND_UNAVAILABLE,
            Status::BackendFailed => Self::SO_BACKEND_FAILED,
        }
    }
}

/// The version of the library, such as `0.1.0`. Valid as long as the library is loaded.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => c"",
    };
    VERSION.as_ptr()
}

/// `SHAPEOP_ABI_VERSION` of the library, to be compared with the header's by a program that loads it.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_abiVersion() -> c_int {
    SHAPEOP_ABI_VERSION
}

/// Why the last call on `op` was refused, in words: the argument, what was expected, what was found. Empty if it
/// succeeded: every call but this, `shapeop_lastErrorCode`, `shapeop_version`, `shapeop_abiVersion`, `shapeop_errorText`
/// and `shapeop_delete` of null replaces the message. A call that was refused because `op` was busy leaves its message with its own thread
/// only, and the success of another thread's call does not hide it. If `op` is no solver, the text is about the calling
/// thread's last call of all.
///
/// The text is the calling thread's own copy, valid until that thread's next call of this function.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_lastError(op: *mut ShapeOpSolver) -> *const c_char {
    std::panic::catch_unwind(|| messages::show_last(Handle::new(op))).unwrap_or(c"".as_ptr())
}

/// The error code of the call that `shapeop_lastError` tells of, for the functions that do not answer with one;
/// `SO_SUCCESS` if that call succeeded. Like `shapeop_lastError` it replaces no message.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_lastErrorCode(op: *mut ShapeOpSolver) -> shapeop_err {
    let status = std::panic::catch_unwind(|| messages::last_status(Handle::new(op)));
    status.unwrap_or(Some(Status::Internal)).map_or(shapeop_err::SO_SUCCESS, shapeop_err::from)
}

/// What an error code means, in words; for a number that is none, it says so. Valid as long as the library is loaded.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_errorText(error: c_int) -> *const c_char {
    static TEXTS: OnceLock<Vec<(c_int, CString)>> = OnceLock::new();
    if error == shapeop_err::SO_SUCCESS as c_int {
        return c"success".as_ptr();
    }
    let texts = TEXTS.get_or_init(|| {
        let text = |status: &Status| (*status as c_int, CString::new(status.text()).unwrap_or_default());
        Status::ALL.iter().map(text).collect()
    });
    let found = texts.iter().find(|(number, _)| *number == error);
    found.map_or(c"not an error code of this library".as_ptr(), |(_, text)| text.as_ptr())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_codes_are_the_numbers_of_the_statuses() {
        for &status in Status::ALL {
            assert_eq!(shapeop_err::from(status) as i32, status as i32);
        }
    }
}
