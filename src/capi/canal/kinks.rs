//! Surfaces that are creased along some of their rows or columns.

use std::ffi::c_int;

use super::super::arguments::{length, slice};
use super::super::{c_count, code, shapeop_err};
use super::grids::direction;
use super::io::{self, Outputs};
use super::surface::{ShapeOpCanal, kind};
use super::{created, guard};
use crate::error::{Error, Result, Status, finite};
use crate::geometry::canal::frame::{Direction, Kink};
use crate::geometry::canal::net::Net;
use crate::geometry::canal::surface::SuperCanal;
use crate::mesh::Grid;

/// # Safety
/// Each array is null or readable for `nb_kinks` values.
unsafe fn kinks(
    grid: &Grid,
    across: Direction,
    lines: *const c_int,
    angles: *const f64,
    nb_kinks: c_int,
) -> Result<Vec<Kink>> {
    let count = length("nb_kinks", nb_kinks)?;
    // SAFETY: the caller vouches for the arrays.
    let (lines, angles) = unsafe { (slice("lines", lines, count)?, slice("angles", angles, count)?) };
    let line_count = if across == Direction::One { grid.rows() } else { grid.columns() };
    let kink = |(k, (&line, &angle)): (usize, (&c_int, &f64))| {
        let place = format!("lines[{k}]");
        let line = io::index(&place, line, line_count)?;
        if line == 0 {
            let reason = format!("expected a line from 1 to {}, found 0", line_count - 1);
            return Err(Error::new(Status::InvalidValue, reason).at(place));
        }
        Ok(Kink { across, line, angle_rad: finite(&format!("angles[{k}]"), angle)? })
    };
    lines.iter().zip(angles).enumerate().map(kink).collect()
}

/// As `shapeop_canalCreate`, for a surface that is creased along some of its rows (`direction` is 1, in which they are
/// crossed) or columns (2): continuous there, but not smooth. `lines` has their indices, neither 0 nor beyond the last;
/// `angles`, in radians, by how much the frames from there on are turned about the line's tangent. The angles of a line
/// that is named twice are added.
///
/// # Safety
/// `points` is null or readable for `3 * rows * columns` doubles, `frame` for 6; `lines` and `angles` are null or
/// readable for `nb_kinks` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCreateWithKinks(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    frame: *const f64,
    kind: c_int,
    direction: c_int,
    lines: *const c_int,
    angles: *const f64,
    nb_kinks: c_int,
) -> *mut ShapeOpCanal {
    // SAFETY: the caller vouches for the arrays.
    created(|| unsafe {
        let (grid, frame) = (io::grid(points, rows, columns, wraps)?, io::frame("frame", frame)?);
        let kinks = kinks(&grid, self::direction(direction)?, lines, angles, nb_kinks)?;
        Ok(SuperCanal::new(Net::with_kinks(grid, frame, &kinks)?, self::kind(kind)?))
    })
}

/// Writes the kinks of a surface's base, as in `shapeop_canalCreateWithKinks`, if there is room for `capacity` of them,
/// and their number to `count`. `direction` is 0 without any. `lines`, `angles` and `direction` may be null.
///
/// # Safety
/// `direction` and `count` are null or writable for one int, `lines` and `angles` for `capacity` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalKinks(
    surface: *mut ShapeOpCanal,
    direction: *mut c_int,
    lines: *mut c_int,
    angles: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(surface, |surface| {
        let found = surface.base().kinks();
        let across = found.first().map_or(0, |kink| if kink.across == Direction::One { 1 } else { 2 });
        let own = found.iter().map(|kink| c_count(kink.line)).collect::<Result<Vec<_>>>()?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.may("direction", direction, vec![across])?;
            outputs.must("count", count, vec![c_count(own.len())?])?;
            if own.len() <= length("capacity", capacity)? {
                outputs.may("lines", lines, own)?;
                outputs.may("angles", angles, found.iter().map(|kink| kink.angle_rad).collect())?;
            }
        }
        outputs.write()
    }))
}
