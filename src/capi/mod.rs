//! The C ABI: `include/shapeop.h` is generated from the doc comments here (`cargo xtask header`).
//!
//! What the boundary promises:
//! - No argument crashes it that C lets it check: handles of any value, null pointers, negative counts, numbers that
//!   are not finite, ids and indices out of range. What it cannot check, each function lists under *Safety*.
//! - A refused call changes nothing, writes no output, and leaves a message for `shapeop_lastError`.
//! - A panic never crosses it: it becomes [`Status::Internal`], and the solver that it happened in is refused from then
//!   on, as nobody knows what state it is in. It can still be deleted.
//! - No call waits for another. A solver that is in use by another call is *busy*: see [`guard`].
//!
//! Every function calls [`guard`], [`guard_read`] or [`guard_free`] in its body, and holds no logic beyond turning
//! pointers into what the Rust API takes. This is the only room with unsafe code.

#![allow(non_snake_case, non_camel_case_types, reason = "the names of libShapeOp's ABI")]

mod arguments;
mod backend;
mod canal;
mod constraints;
mod current;
mod errors;
mod explore;
mod forces;
mod handles;
mod messages;
mod outputs;
mod points;
mod problem;
mod references;
mod registry;
mod report;
mod ruled;
mod snakes;
mod solver;
mod structs;

pub use backend::*;
pub use canal::*;
pub use constraints::*;
pub use errors::*;
pub use explore::*;
pub use forces::*;
pub use handles::ShapeOpSolver;
pub use points::*;
pub use problem::*;
pub use references::*;
pub use registry::*;
pub use report::*;
pub use ruled::*;
pub use snakes::*;
pub use solver::*;

use std::any::Any;
use std::ffi::c_int;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::error::{Error, Result, Status};
use crate::solver::Solver;
use handles::{Handle, Kind, State};

/// A call that was refused has left its message; this is the rest.
type Refused<T> = std::result::Result<T, Status>;

/// Runs `call` on the solver that `op` names. Refuses a bad handle; refuses, without waiting, a solver that another
/// call is using, which includes every call from inside its own progress callback. Catches panics and keeps the
/// message.
fn guard<T>(op: *mut ShapeOpSolver, call: impl FnOnce(&mut Solver) -> Result<T>) -> Refused<T> {
    guard_object(Handle::new(op), call)
}

/// As [`guard`], for an object of any kind.
fn guard_object<K: Kind, T>(handle: Handle, call: impl FnOnce(&mut K) -> Result<T>) -> Refused<T> {
    guard_named(handle, || {
        let slot = handles::find::<K>(handle)?;
        let mut state = slot.try_lock::<K>(handle)?;
        let result = state.run(handle, call);
        messages::keep(&slot.message, result.as_ref().err());
        result
    })
}

/// As [`guard`], for a call that only reads: from inside the solver's own progress callback it sees the current
/// iterate.
fn guard_read<T>(op: *mut ShapeOpSolver, call: impl FnOnce(&Solver) -> Result<T>) -> Refused<T> {
    let handle = Handle::new(op);
    match current::solver(handle) {
        Some(solver) => guard_named(handle, || call(&solver)),
        None => guard(op, |solver| call(solver)),
    }
}

/// Runs a call that needs no solver.
fn guard_free<T>(call: impl FnOnce() -> Result<T>) -> Refused<T> {
    guard_named(Handle::NONE, call)
}

/// Runs `call`, catches panics, and keeps the message with this thread as one about `handle`.
fn guard_named<T>(handle: Handle, call: impl FnOnce() -> Result<T>) -> Refused<T> {
    let result = catch(call);
    messages::keep_for_thread(handle, result.as_ref().err());
    result.map_err(|error| error.status())
}

/// A panic as an error of status `Internal`.
fn catch<T>(call: impl FnOnce() -> Result<T>) -> Result<T> {
    // Nothing that a panic may leave half-changed is used again: `State::run` drops the object that it happened in.
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| Err(internal(&*panic)))
}

fn internal(panic: &(dyn Any + Send)) -> Error {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    let reason = format!("an error inside the library, please report it: {}", text.unwrap_or("no message"));
    Error::new(Status::Internal, reason)
}

impl State {
    /// Runs `call` on the object, unless an earlier panic made it unusable; a panic does.
    fn run<K: Kind, T>(&mut self, handle: Handle, call: impl FnOnce(&mut K) -> Result<T>) -> Result<T> {
        let object = self.object(handle)?;
        let result = catch_unwind(AssertUnwindSafe(|| call(object)));
        result.unwrap_or_else(|panic| {
            *self = Self::Broken;
            Err(internal(&*panic))
        })
    }
}

/// The answer of a function that returns `shapeop_err`.
fn code(result: Refused<()>) -> shapeop_err {
    result.map_or_else(shapeop_err::from, |()| shapeop_err::SO_SUCCESS)
}

/// The answer of a function that returns 0 or 1.
fn flag(result: Refused<()>) -> c_int {
    c_int::from(result.is_err())
}

/// The answer of a function that returns a count, an id or a truth, or -1.
fn number(result: Refused<c_int>) -> c_int {
    result.unwrap_or(-1)
}

/// A count or id as C has it.
fn c_count(count: usize) -> Result<c_int> {
    let reason = || Error::new(Status::TooLarge, format!("{count} does not fit an int"));
    c_int::try_from(count).map_err(|_| reason())
}

#[cfg(test)]
mod tests {
    use std::ffi::CStr;

    use super::*;

    #[test]
    fn a_panic_becomes_an_error_and_its_solver_is_refused_from_then_on() {
        let op = shapeop_create();
        let other = shapeop_create();
        assert_eq!(guard(op, |_| -> Result<()> { panic!("sum of {}", 7) }), Err(Status::Internal));
        // SAFETY: the text is valid until this thread's next call of `shapeop_lastError`.
        let message = |op| unsafe { CStr::from_ptr(shapeop_lastError(op)) }.to_str().unwrap().to_owned();
        assert_eq!(message(op), "an error inside the library, please report it: sum of 7");
        assert_eq!(guard(op, |_| Ok(())), Err(Status::Internal));
        assert!(message(op).contains("earlier"), "{}", message(op));
        assert_eq!(guard(other, |_| Ok(())), Ok(()));
        shapeop_delete(op);
        assert_eq!(guard(op, |_| Ok(())), Err(Status::InvalidHandle));
        shapeop_delete(other);
    }

    #[test]
    fn a_panic_without_a_solver_becomes_an_error_too() {
        assert_eq!(guard_free(|| -> Result<()> { panic!("oh") }), Err(Status::Internal));
    }
}
