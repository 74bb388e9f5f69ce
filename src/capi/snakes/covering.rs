//! What the positions of a snake come to as the covering of a surface.

use std::ffi::{c_char, c_int, c_uint};

use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::io::{self, placed};
use super::snake::ShapeOpSnake;
use super::{guard, shown};
use crate::error::{Error, Result, Status};
use crate::geometry::snakes::draft::Draft;
use crate::geometry::snakes::report::{Report, ReportOptions};

/// How a covering is judged. Start from `shapeop_snakeDefaultCoveringOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_covering_options {
    /// In: `sizeof(shapeop_snake_covering_options)`.
    pub struct_size: c_uint,
    /// Intervals of each arc of the swept surface, 1 to 65 536. Default 8.
    pub per_arc: c_uint,
    /// 1: the last position is followed by the first. Default 0.
    pub comes_back: c_int,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// Arcs are of one kind if radii and lengths are both within this of the first's, relative to its, 0 or more. Default
    /// 1e-6.
    pub tolerance: f64,
    /// A spot of the mesh is covered if the swept surface is within this distance, in model units; 0: 0.01 of the mesh's
    /// diagonal. Default 0.
    pub distance: f64,
}

/// What a covering comes to.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_covering {
    /// In: `sizeof(shapeop_snake_covering)`.
    pub struct_size: c_uint,
    /// Positions of the snake.
    pub position_count: c_uint,
    /// Arcs of all positions.
    pub arc_count: c_uint,
    /// Kinds of arcs.
    pub kind_count: c_uint,
    /// 1 if there is a mesh to compare with, and positions enough to sweep a surface; else what follows `residual` is 0.
    pub is_compared: c_int,
    /// Samples of the swept surface that are beyond the boundary of the mesh.
    pub beyond_count: c_uint,
    /// The length of all arcs together, in model units.
    pub length: f64,
    /// The area of the swept surface; 0 with one position.
    pub area: f64,
    /// By how much a distance of control points is off in any position at most, in model units.
    pub residual: f64,
    /// The area of the mesh.
    pub reference_area: f64,
    /// The part of the mesh that the swept surface is near to, 0 to 1.
    pub coverage: f64,
    /// How near, in model units.
    pub distance: f64,
    /// The largest distance of a sample of the swept surface from the mesh, in model units; what is beyond its boundary
    /// does not count.
    pub largest_deviation: f64,
    /// The sample that has it, x.
    pub at_x: f64,
    /// See `at_x`.
    pub at_y: f64,
    /// See `at_x`.
    pub at_z: f64,
    /// The root mean square of it over the area.
    pub rms_deviation: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_covering_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_covering_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_covering {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_covering>()];
}

fn default_options() -> shapeop_snake_covering_options {
    let ReportOptions { tolerance, per_arc, distance, comes_back } = ReportOptions::default();
    shapeop_snake_covering_options {
        struct_size: 0,
        per_arc: io::field(per_arc),
        comes_back: c_int::from(comes_back),
        reserved: 0,
        tolerance,
        distance: distance.unwrap_or(0.0),
    }
}

/// # Safety
/// `options` is null, or its `struct_size` is set and it is readable for so many bytes.
unsafe fn options(options: *const shapeop_snake_covering_options) -> Result<ReportOptions> {
    // SAFETY: the caller vouches for it; numbers are valid for any bytes.
    let told = unsafe { io::told("options", options, default_options())? };
    Ok(ReportOptions {
        tolerance: told.tolerance,
        per_arc: told.per_arc as usize,
        // What is not a number is a distance, so that it is refused as one.
        distance: (told.distance != 0.0).then_some(told.distance),
        comes_back: io::truth("options->comes_back", told.comes_back)?,
    })
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeDefaultCoveringOptions(
    options: *mut shapeop_snake_covering_options,
) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// The error with the names of C's arguments.
fn named(error: Error) -> Error {
    placed(error, &[("options.", "options->"), ("points", "options->per_arc"), ("frames", "snake")])
}

fn as_told(found: &Report) -> shapeop_snake_covering {
    let of = found.reference.unwrap_or_default();
    shapeop_snake_covering {
        struct_size: 0,
        position_count: io::field(found.positions),
        arc_count: io::field(found.instances),
        kind_count: io::field(found.kinds.len()),
        is_compared: c_int::from(found.reference.is_some()),
        beyond_count: io::field(of.beyond),
        length: found.length,
        area: found.area,
        residual: found.residual,
        reference_area: of.area,
        coverage: of.coverage,
        distance: of.distance,
        largest_deviation: of.deviation.max,
        at_x: of.deviation.at[0],
        at_y: of.deviation.at[1],
        at_z: of.deviation.at[2],
        rms_deviation: of.deviation.rms,
    }
}

fn numbers(told: &shapeop_snake_covering) -> Vec<f64> {
    let swept = [told.length, told.area, told.residual, told.reference_area, told.coverage, told.distance];
    let off = [told.largest_deviation, told.rms_deviation, told.at_x, told.at_y, told.at_z];
    [&swept[..], &off].concat()
}

/// Judges the surface that the positions found last sweep, and how it covers the mesh that is the snake's surface: writes
/// to `report`, whose `struct_size` must be set. `options` is null for the defaults.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is readable for so many bytes; `report` is null, or its
/// `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCovering(
    snake: *mut ShapeOpSnake,
    options: *const shapeop_snake_covering_options,
    report: *mut shapeop_snake_covering,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the structs.
        let options = unsafe {
            structs::size("report", report)?;
            self::options(options)?
        };
        let told = as_told(&draft.report(&options).map_err(named)?);
        // SAFETY: the caller vouches for so many bytes.
        unsafe { io::tell("report", report, &told, &numbers(&told)) }
    }))
}

/// The same as JSON (`docs/snake-report.schema.json`), with the kinds of arcs; null if it is refused. The text is valid as
/// long as that of `shapeop_snakeText`.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is readable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCoveringText(
    snake: *mut ShapeOpSnake,
    options: *const shapeop_snake_covering_options,
) -> *const c_char {
    shown(snake, |draft| {
        // SAFETY: the caller vouches for the struct.
        let options = unsafe { self::options(options)? };
        let found = draft.report(&options).map_err(named)?;
        if numbers(&as_told(&found)).iter().any(|number| !number.is_finite()) {
            let reason = "coordinates are so large that the result is not finite";
            return Err(Error::new(Status::InvalidValue, reason).at("snake"));
        }
        Ok(Draft::report_json(&found))
    })
}
