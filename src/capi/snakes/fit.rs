//! Snakes that are fitted to polylines.

use std::ffi::{c_int, c_uint};
use std::ops::ControlFlow;

use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::created;
use super::io::{self, placed};
use super::snake::ShapeOpSnake;
use crate::error::{Error, Status};
use crate::geometry::snakes::draft::Draft;
use crate::geometry::snakes::fit::{self, fit, fit_closed};
use crate::linalg::gauss_newton::Stop;

/// Arcs of a fitted snake at most.
const MOST_ARCS: usize = 10_000;

/// How a snake is fitted. Start from `shapeop_snakeDefaultFitOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_fit_options {
    /// In: `sizeof(shapeop_snake_fit_options)`.
    pub struct_size: c_uint,
    /// 1: all arcs have one radius, not only one length. Default 1.
    pub is_congruent: c_int,
    /// Iterations at most, of each of three minimisations. Default 200.
    pub max_iterations: c_uint,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// The curvature of all arcs, if it is known, in 1/model units; 0: it is found. Default 0.
    pub curvature: f64,
    /// The weight of nearness beside that of distances, above 0. Default 0.005.
    pub nearness: f64,
}

/// What fitting found.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_fit_report {
    /// In: `sizeof(shapeop_snake_fit_report)`.
    pub struct_size: c_uint,
    /// Iterations of the minimisations.
    pub iterations: c_uint,
    /// 1 if steps or decreases became small; 0 if all iterations were used.
    pub is_converged: c_int,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// The largest distance of a point of the polyline from the nearest arc, in model units.
    pub deviation: f64,
    /// By how much a distance of control points is off at most, in model units.
    pub residual: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_fit_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_fit_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_fit_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_fit_report>()];
}

fn default_options() -> shapeop_snake_fit_options {
    let fit::Options { is_congruent, curvature, nearness, max_iterations } = fit::Options::default();
    shapeop_snake_fit_options {
        struct_size: 0,
        is_congruent: c_int::from(is_congruent),
        max_iterations: io::field(max_iterations),
        reserved: 0,
        curvature: curvature.unwrap_or(0.0),
        nearness,
    }
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeDefaultFitOptions(options: *mut shapeop_snake_fit_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// Creates the snake of `nb_arcs` arcs of equal length along a polyline of `nb_points` points, open or, with `is_closed`
/// 1, closed; null if it is refused. Lengths and curvatures are those of the circles through three points in a row. Arcs
/// around a closed one are about of equal length and as curved as it is; of the options `is_congruent` and `curvature` do
/// not count then.
/// `options` is null for the defaults; `report` is null, or its `struct_size` is set.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles; `options` and `report` are null, or their `struct_size` is
/// set and they are readable or writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeFit(
    points: *const f64,
    nb_points: c_int,
    is_closed: c_int,
    nb_arcs: c_int,
    options: *const shapeop_snake_fit_options,
    report: *mut shapeop_snake_fit_report,
) -> *mut ShapeOpSnake {
    let mut tell = None;
    let made = created(|| {
        // SAFETY: the caller vouches for the array and the structs; numbers are valid for any bytes.
        let (points, told, size) = unsafe {
            let points = io::points("points", points, "nb_points", nb_points)?;
            let size = if report.is_null() { 0 } else { structs::size("report", report)? };
            (points, io::told("options", options, default_options())?, size)
        };
        let is_closed = io::truth("is_closed", is_closed)?;
        let arc_count = io::count("nb_arcs", nb_arcs, 1, MOST_ARCS)?;
        if !(told.curvature >= 0.0 && told.curvature.is_finite()) {
            let reason = format!("expected a finite number above 0, or 0 for none, found {}", told.curvature);
            return Err(Error::new(Status::InvalidValue, reason).at("options->curvature"));
        }
        let options = fit::Options {
            is_congruent: io::truth("options->is_congruent", told.is_congruent)?,
            curvature: (told.curvature > 0.0).then_some(told.curvature),
            nearness: told.nearness,
            max_iterations: told.max_iterations as usize,
        };
        let mut quiet = |_: &_| ControlFlow::Continue(());
        let fitted = if is_closed {
            fit_closed(&points, arc_count, &options, &mut quiet)
        } else {
            fit(&points, arc_count, &options, &mut quiet)
        };
        let names = [("arc_count", "nb_arcs"), ("options.", "options->")];
        let found = fitted.map_err(|error| placed(error, &names))?;
        let is_converged = !matches!(found.stop, Stop::Iterations);
        let told = shapeop_snake_fit_report {
            struct_size: 0,
            iterations: io::field(found.iterations),
            is_converged: c_int::from(is_converged),
            reserved: 0,
            deviation: found.deviation,
            residual: found.residual,
        };
        if !(told.deviation.is_finite() && told.residual.is_finite()) {
            let reason = "coordinates are so large that the result is not finite";
            return Err(Error::new(Status::InvalidValue, reason).at("points"));
        }
        tell = Some((size, told));
        Ok(Draft::new(found.snake))
    });
    if let (false, false, Some((size, told))) = (made.is_null(), report.is_null(), tell) {
        // SAFETY: the caller vouches for so many bytes.
        unsafe { structs::write(report, size, &told) };
    }
    made
}
