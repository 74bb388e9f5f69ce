//! Super-canal surfaces: what `crate::geometry::canal` can do, for C.

mod families;
mod grids;
mod inversion;
mod io;
mod kinks;
mod parts;
mod revolution;
mod smoothing;
mod strips;
mod surface;
mod touching_spheres;
mod two_curves;

pub use families::*;
pub use grids::*;
pub use inversion::*;
pub use kinks::*;
pub use parts::*;
pub use revolution::*;
pub use smoothing::*;
pub use strips::*;
pub use surface::*;
pub use touching_spheres::*;
pub use two_curves::*;

use super::handles::{self, Handle, Object};
use super::{Refused, guard_free, guard_object};
use crate::error::Result;
use crate::geometry::canal::surface::SuperCanal;
use io::Outputs;

/// Runs `call` on the surface that `surface` names; see [`super::guard`].
fn guard<T>(surface: *mut ShapeOpCanal, call: impl FnOnce(&mut SuperCanal) -> Result<T>) -> Refused<T> {
    guard_object(Handle::new(surface.cast()), call)
}

/// The handle of the surface that `make` makes; null if it is refused.
fn created(make: impl FnOnce() -> Result<SuperCanal>) -> *mut ShapeOpCanal {
    created_with(|| Ok((make()?, Outputs::default())))
}

/// As [`created`], with outputs that are written if all else succeeds.
fn created_with(make: impl FnOnce() -> Result<(SuperCanal, Outputs)>) -> *mut ShapeOpCanal {
    let made = guard_free(|| {
        let (surface, outputs) = make()?;
        let handle = handles::create(Object::Canal(Box::new(surface)))?;
        outputs.write()?;
        Ok(handle)
    });
    made.map_or(std::ptr::null_mut(), |handle| handle.as_op().cast())
}
