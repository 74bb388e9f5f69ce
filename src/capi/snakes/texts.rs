//! Snakes and lists of their arcs as texts for files and other programs.

use std::ffi::{c_char, c_int};

use super::super::arguments::text;
use super::io;
use super::snake::{SHAPEOP_SNAKE_ALL, ShapeOpSnake};
use super::{created, shown};
use crate::error::{Error, Result, Status};
use crate::geometry::snakes::Arc;
use crate::geometry::snakes::arc_list::ArcList;
use crate::geometry::snakes::draft::Draft;
use crate::geometry::snakes::file;

/// Creates a snake from its JSON form (`docs/snake.schema.json`); null if it is refused.
///
/// # Safety
/// `json` is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCreateFromText(json: *const c_char) -> *mut ShapeOpSnake {
    created(|| {
        // SAFETY: the caller vouches for the text.
        let json = unsafe { text("json", json)? };
        Ok(Draft::new(file::from_json(&json)?))
    })
}

/// The JSON form of a snake as it is (`docs/snake.schema.json`); null if it is refused. The text is the calling thread's
/// own, valid until that thread's next call of a function of snakes that answers with a text.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeText(snake: *mut ShapeOpSnake) -> *const c_char {
    shown(snake, |draft| Ok(file::to_json(draft.snake())))
}

/// The arcs that `frame` names.
fn list(draft: &Draft, frame: c_int, tolerance: f64) -> Result<ArcList> {
    let found = if frame == SHAPEOP_SNAKE_ALL {
        draft.arc_list(tolerance)?
    } else {
        let at = draft.at(io::frame(frame)?)?;
        ArcList::new(&at, &[at.control().to_vec()], &[0.0], tolerance)?
    };
    let is_finite = |arc: &Arc| arc.circle.center.is_finite() && arc.circle.normal.is_finite() && arc.start.is_finite();
    if found.snakes().iter().all(|snake| snake.arcs().iter().all(is_finite)) {
        return Ok(found);
    }
    let reason = "coordinates are so large that the result is not finite";
    Err(Error::new(Status::InvalidValue, reason).at("snake"))
}

/// The arcs of the snake at a frame, as it is (`SHAPEOP_SNAKE_NOW`) or at all positions found last (`SHAPEOP_SNAKE_ALL`)
/// as JSON (`docs/snake-arcs.schema.json`); null if it is refused. Arcs are of one kind if radii and lengths are both
/// within `tolerance` of the first's, relative to its. The text is valid as long as that of `shapeop_snakeText`.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeArcsText(snake: *mut ShapeOpSnake, frame: c_int, tolerance: f64) -> *const c_char {
    shown(snake, |draft| Ok(list(draft, frame, tolerance)?.to_json()))
}

/// The same as a table, a line for each arc: frame, arc, kind, centre, radius, axis, start, angle in radians, length.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeArcsCsv(snake: *mut ShapeOpSnake, frame: c_int, tolerance: f64) -> *const c_char {
    shown(snake, |draft| Ok(list(draft, frame, tolerance)?.to_csv()))
}

/// The kinds of arcs of the same as a table, a line for each: kind, radius, length, count.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeKindsCsv(snake: *mut ShapeOpSnake, frame: c_int, tolerance: f64) -> *const c_char {
    shown(snake, |draft| Ok(list(draft, frame, tolerance)?.kinds_csv()))
}

/// The same arcs as a DXF drawing, a layer for each kind.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeArcsDxf(snake: *mut ShapeOpSnake, frame: c_int, tolerance: f64) -> *const c_char {
    shown(snake, |draft| Ok(list(draft, frame, tolerance)?.to_dxf()))
}
