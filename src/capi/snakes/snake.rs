//! Snakes: creating, deleting, what they are made of.

use std::ffi::{c_int, c_uint};

use super::super::handles::{self, Handle};
use super::super::structs::SizedStruct;
use super::super::{code, guard_named, shapeop_err};
use super::io::{self, Outputs, placed};
use super::{created, guard};
use crate::error::{Error, Result, Status};
use crate::geometry::snakes::draft::Draft;
use crate::geometry::snakes::{Arc, ArcShape, Pose, Snake};

/// For `frame`: the snake as it is.
pub const SHAPEOP_SNAKE_NOW: c_int = -1;

/// For `frame`, where that is said: all positions found last.
pub const SHAPEOP_SNAKE_ALL: c_int = -2;

/// A circular arc snake: a smooth chain of circular arcs that moves while each arc keeps its shape; with it the surface
/// that it moves on, the rails that guide it, the wishes for its velocities, and the positions that were found last. What
/// points to it is no address but a small integer, a handle. All functions named `shapeop_snake...` leave their messages
/// for `shapeop_lastError` of null.
///
/// A snake of N arcs has control points: of a closed one N, the vertices of the arcs in order; of an open one N + 2, its
/// first point, the vertices, its last point. An arc touches both edges at its vertex. Arcs meet in contact points: of an
/// open snake N + 1, its ends among them, of a closed one N.
#[derive(Debug)]
pub struct ShapeOpSnake {
    _private: [u8; 0],
}

/// What a snake is like.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_report {
    /// In: `sizeof(shapeop_snake_report)`.
    pub struct_size: c_uint,
    /// The number of arcs.
    pub arc_count: c_uint,
    /// The number of control points.
    pub control_count: c_uint,
    /// 1 if the last arc goes on with the first.
    pub is_closed: c_int,
    /// The sum of the arcs' lengths, in model units.
    pub length: f64,
    /// By how much a distance of control points that the arcs keep is off at most, in model units.
    pub residual: f64,
    /// The largest distance of a contact point or the middle of an arc from the surface, in model units; 0 without one.
    pub deviation: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_report>()];
}

/// Creates the snake with these control points, `nb_control` of them, open or, with `is_closed` 1, closed; null if it is
/// refused. The arcs follow from them: around a closed snake of an even number of arcs there are none or many, of which
/// `first_tangent` chooses, the distance from the first control point to both ends of its arc; otherwise it is 0. Delete
/// the snake with `shapeop_snakeDelete`.
///
/// # Safety
/// `control` is null or readable for `3 * nb_control` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCreate(
    control: *const f64,
    nb_control: c_int,
    is_closed: c_int,
    first_tangent: f64,
) -> *mut ShapeOpSnake {
    created(|| {
        // SAFETY: the caller vouches for the array.
        let control = unsafe { io::points("control", control, "nb_control", nb_control)? };
        let is_closed = io::truth("is_closed", is_closed)?;
        if !(first_tangent >= 0.0 && first_tangent.is_finite()) {
            let reason = format!("expected a length above 0, or 0 for none, found {first_tangent}");
            return Err(Error::new(Status::InvalidValue, reason).at("first_tangent"));
        }
        Ok(Draft::new(Snake::new(control, is_closed, (first_tangent > 0.0).then_some(first_tangent))?))
    })
}

/// Creates the open snake of arcs of these radii and lengths, `nb_arcs` of each, in model units; null if it is refused.
/// `torsions[j]` is by how much the plane turns from arc `j` to the next, in radians, counterclockwise about the tangent;
/// there is one fewer of them. The snake begins at `point` along `tangent`, and its first arc bends towards `normal`.
///
/// # Safety
/// `radii` and `lengths` are null or readable for `nb_arcs` doubles, `torsions` for `nb_torsions`, the vectors for 3.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCreateFromArcs(
    radii: *const f64,
    lengths: *const f64,
    nb_arcs: c_int,
    torsions: *const f64,
    nb_torsions: c_int,
    point: *const f64,
    tangent: *const f64,
    normal: *const f64,
) -> *mut ShapeOpSnake {
    created(|| {
        // SAFETY: the caller vouches for the arrays.
        let (radii, lengths, torsions, pose) = unsafe {
            let radii = io::numbers("radii", radii, "nb_arcs", nb_arcs)?;
            let lengths = io::numbers("lengths", lengths, "nb_arcs", nb_arcs)?;
            let torsions = io::numbers("torsions", torsions, "nb_torsions", nb_torsions)?;
            let point = io::vector("point", point)?;
            let tangent = io::vector("tangent", tangent)?;
            (radii, lengths, torsions, Pose { point, tangent, normal: io::vector("normal", normal)? })
        };
        let shapes: Vec<ArcShape> =
            radii.into_iter().zip(lengths).map(|(radius, length)| ArcShape { radius, length }).collect();
        let names = [("arcs[", "radii["), ("arcs", "nb_arcs"), ("pose.", "")];
        Ok(Draft::new(Snake::from_arcs(&shapes, &torsions, &pose).map_err(|error| placed(error, &names))?))
    })
}

/// Creates a copy of a snake, with all that belongs to it; null if it is refused.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeCopy(snake: *mut ShapeOpSnake) -> *mut ShapeOpSnake {
    match guard(snake, |draft| Ok(draft.clone())) {
        Ok(copy) => created(|| Ok(copy)),
        Err(_) => std::ptr::null_mut(),
    }
}

/// Deletes a snake. Null does nothing; a busy snake is left alone, as is whatever is no snake.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_snakeDelete(snake: *mut ShapeOpSnake) {
    if !snake.is_null() {
        let handle = Handle::new(snake.cast());
        let _ = guard_named(handle, || handles::delete::<Draft>(handle));
    }
}

/// Writes what a snake is like to `report`, whose `struct_size` must be set.
///
/// # Safety
/// `report` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeReport(
    snake: *mut ShapeOpSnake,
    report: *mut shapeop_snake_report,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let of = draft.snake();
        let told = shapeop_snake_report {
            struct_size: 0,
            arc_count: io::field(of.shapes().len()),
            control_count: io::field(of.control().len()),
            is_closed: c_int::from(of.is_closed()),
            length: of.length(),
            residual: of.residual(),
            deviation: if draft.surface().is_some() { draft.deviation()? } else { 0.0 },
        };
        // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
        unsafe { io::tell("report", report, &told, &[told.length, told.residual, told.deviation]) }
    }))
}

/// Writes the control points if there is room for `capacity` of them, and their number to `count`.
///
/// # Safety
/// `control` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeControl(
    snake: *mut ShapeOpSnake,
    control: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("control", control, capacity, count, io::coordinates(draft.snake().control()), 3)? };
        outputs.write()
    }))
}

/// Puts the control points elsewhere, as many as there are; they need not keep the distances, see `shapeop_snakeProject`.
/// What was found of the snake's motion is forgotten.
///
/// # Safety
/// `control` is null or readable for `3 * nb_control` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeSetControl(
    snake: *mut ShapeOpSnake,
    control: *const f64,
    nb_control: c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the array.
        draft.set_control(unsafe { io::points("control", control, "nb_control", nb_control)? })
    }))
}

/// Writes the contact points if there is room for `capacity` of them, and their number to `count`.
///
/// # Safety
/// `contacts` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeContacts(
    snake: *mut ShapeOpSnake,
    contacts: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("contacts", contacts, capacity, count, io::coordinates(&draft.snake().contacts()), 3)? };
        outputs.write()
    }))
}

/// Writes the radii and lengths of the arcs, in model units, if there is room for `capacity` of them, and their number to
/// `count`. Each output but `count` may be null.
///
/// # Safety
/// `radii` and `lengths` are null or writable for `capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeShapes(
    snake: *mut ShapeOpSnake,
    radii: *mut f64,
    lengths: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let shapes = draft.snake().shapes();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            if outputs.room(capacity, count, shapes.len())? {
                outputs.may("radii", radii, shapes.iter().map(|shape| shape.radius).collect())?;
                outputs.may("lengths", lengths, shapes.iter().map(|shape| shape.length).collect())?;
            }
        }
        outputs.write()
    }))
}

/// Writes the angles by which the plane turns from each arc to the next, in radians, counterclockwise about the tangent,
/// of a closed snake also from the last to the first, if there is room for `capacity` of them, and their number to
/// `count`.
///
/// # Safety
/// `torsions` is null or writable for `capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeTorsions(
    snake: *mut ShapeOpSnake,
    torsions: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("torsions", torsions, capacity, count, draft.snake().torsions(), 1)? };
        outputs.write()
    }))
}

/// Writes the arcs of the snake at a frame, or as it is (`SHAPEOP_SNAKE_NOW`), 11 numbers each, if there is room for
/// `capacity` of them, and their number to `count`: the centre, the radius, the unit vector along the axis, about which
/// the arc turns counterclockwise, the point where it starts, the angle in radians.
///
/// # Safety
/// `arcs` is null or writable for `11 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeArcs(
    snake: *mut ShapeOpSnake,
    frame: c_int,
    arcs: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let row = |Arc { circle, start, angle_rad }: Arc| {
            let ([x, y, z], [a, b, c]) = (circle.center.to_array(), circle.normal.to_array());
            [x, y, z, circle.radius, a, b, c, start.x, start.y, start.z, angle_rad]
        };
        let all: Vec<f64> = draft.at(io::frame(frame)?)?.arcs().into_iter().flat_map(row).collect();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("arcs", arcs, capacity, count, all, 11)? };
        outputs.write()
    }))
}

/// Writes points along the snake at a frame, or as it is (`SHAPEOP_SNAKE_NOW`), `per_arc` intervals in each arc, if there
/// is room for `capacity` of them, and their number to `count`; the first point of a closed snake is not repeated.
///
/// # Safety
/// `points` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeSample(
    snake: *mut ShapeOpSnake,
    frame: c_int,
    per_arc: c_int,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let all = draft.at(io::frame(frame)?)?.sample(io::per_arc(per_arc)?);
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("points", points, capacity, count, io::coordinates(&all), 3)? };
        outputs.write()
    }))
}

/// Writes to `free` in how many ways the snake can move to first order, rigid motions among them, in space or, with
/// `on_surface` 1, where its control points move along its surface; to `conditions` and `rank` how many conditions there
/// are, and how many of them are independent. Each output may be null.
///
/// # Safety
/// Each output is null or writable for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeFreedoms(
    snake: *mut ShapeOpSnake,
    on_surface: c_int,
    free: *mut c_int,
    conditions: *mut c_int,
    rank: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let found = draft.freedoms(io::truth("on_surface", on_surface)?)?;
        let one = |count: usize| -> Result<Vec<c_int>> { io::ints([count]) };
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.may("free", free, one(found.free)?)?;
            outputs.may("conditions", conditions, one(found.conditions)?)?;
            outputs.may("rank", rank, one(found.rank)?)?;
        }
        outputs.write()
    }))
}
