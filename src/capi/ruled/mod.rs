//! Ruled strips: what `crate::geometry::ruled` can do, for C.

mod boundaries;
mod conditions;
mod design;
mod io;
mod levels;
mod optimise;
mod output;
mod planks;
mod report;
mod strips;

pub use boundaries::*;
pub use conditions::*;
pub use design::*;
pub use levels::*;
pub use optimise::*;
pub use output::*;
pub use planks::*;
pub use report::*;
pub use strips::*;

use std::ffi::c_char;

use super::handles::{self, Handle, Object};
use super::{Refused, guard_free, guard_object, messages};
use crate::error::Result;
use crate::geometry::ruled::design::Draft;

/// Runs `call` on the design that `design` names; see [`super::guard`].
fn guard<T>(design: *mut ShapeOpRuled, call: impl FnOnce(&mut Draft) -> Result<T>) -> Refused<T> {
    guard_object(Handle::new(design.cast()), call)
}

/// The handle of the design that `make` makes; null if it is refused.
fn created(make: impl FnOnce() -> Result<Draft>) -> *mut ShapeOpRuled {
    let made = guard_free(|| handles::create(Object::Ruled(Box::new(make()?))));
    made.map_or(std::ptr::null_mut(), |handle| handle.as_op().cast())
}

/// The text that `make` makes of a design; null if it is refused.
fn shown(design: *mut ShapeOpRuled, make: impl FnOnce(&mut Draft) -> Result<String>) -> *const c_char {
    guard(design, |draft| Ok(messages::show_ruled(make(draft)?))).unwrap_or(std::ptr::null())
}
