//! Circular arc snakes: what `crate::geometry::snakes` can do, for C.

mod covering;
mod curve;
mod cycle;
mod evolve;
mod fit;
mod frames;
mod io;
mod linkage;
mod rails;
mod snake;
mod surface;
mod sweep;
mod texts;
mod wishes;

pub use covering::*;
pub use curve::*;
pub use cycle::*;
pub use evolve::*;
pub use fit::*;
pub use frames::*;
pub use linkage::*;
pub use rails::*;
pub use snake::*;
pub use surface::*;
pub use sweep::*;
pub use texts::*;
pub use wishes::*;

use std::ffi::c_char;

use super::handles::{self, Handle, Object};
use super::{Refused, guard_free, guard_object, messages};
use crate::error::Result;
use crate::geometry::snakes::draft::Draft;

/// Runs `call` on the snake that `snake` names; see [`super::guard`].
fn guard<T>(snake: *mut ShapeOpSnake, call: impl FnOnce(&mut Draft) -> Result<T>) -> Refused<T> {
    guard_object(Handle::new(snake.cast()), call)
}

/// The handle of the snake that `make` makes; null if it is refused.
fn created(make: impl FnOnce() -> Result<Draft>) -> *mut ShapeOpSnake {
    let made = guard_free(|| handles::create(Object::Snake(Box::new(make()?))));
    made.map_or(std::ptr::null_mut(), |handle| handle.as_op().cast())
}

/// The text that `make` makes of a snake; null if it is refused.
fn shown(snake: *mut ShapeOpSnake, make: impl FnOnce(&mut Draft) -> Result<String>) -> *const c_char {
    guard(snake, |draft| Ok(messages::show_snake(make(draft)?))).unwrap_or(std::ptr::null())
}
