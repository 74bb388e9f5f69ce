//! Curves of given curvature on surfaces.

use std::ffi::{c_int, c_uint};

use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::io::{self, Outputs, placed};
use super::surface::{meshed, named};
use crate::error::{Error, Result, Status};
use crate::geometry::snakes::curvature_curve::{self, Course, End, Method, Side};
use crate::geometry::snakes::draft::Surface;

/// How a curve of given curvature is found. Start from `shapeop_snakeDefaultCurveOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_curve_options {
    /// In: `sizeof(shapeop_snake_curve_options)`.
    pub struct_size: c_uint,
    /// 0: it turns left, seen from where the surface's normal points; 1: right. Default 0.
    pub turns_right: c_int,
    /// Into how many steps the length is divided, 1 to 1 000 000. Default 200.
    pub steps: c_uint,
    /// 0: the method of Runge and Kutta; 1: that of chords, of first order. Default 0.
    pub method: c_int,
}

/// Why a curve of given curvature ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_snake_curve_end {
    /// It is as long as asked for.
    SO_SNAKE_CURVE_LENGTH = 0,
    /// At the boundary of the surface.
    SO_SNAKE_CURVE_BOUNDARY = 1,
    /// The surface itself bends more along the curve than the curve may.
    SO_SNAKE_CURVE_BENDS_MORE = 2,
    /// The surface has no tangent plane there, or folds.
    SO_SNAKE_CURVE_FOLD = 3,
}

/// What was found of a curve.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_curve_report {
    /// In: `sizeof(shapeop_snake_curve_report)`.
    pub struct_size: c_uint,
    /// Why it ends.
    pub end: shapeop_snake_curve_end,
    /// Its length, in model units.
    pub length: f64,
    /// Where the surface bends more: the curvature asked for there, in 1/model units; otherwise 0.
    pub curvature: f64,
    /// Where the surface bends more: its normal curvature in the direction of the curve; otherwise 0.
    pub normal_curvature: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_curve_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_curve_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_curve_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_curve_report>()];
}

/// Steps of a curve at most.
const MOST_STEPS: usize = 1_000_000;

fn default_options() -> shapeop_snake_curve_options {
    let defaults = curvature_curve::Options::default();
    shapeop_snake_curve_options { struct_size: 0, turns_right: 0, steps: io::field(defaults.steps), method: 0 }
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeDefaultCurveOptions(options: *mut shapeop_snake_curve_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// What a caller asks for, and where it goes.
struct Asked {
    start: *const f64,
    tangent: *const f64,
    curvatures: *const f64,
    nb_curvatures: c_int,
    length: f64,
    options: *const shapeop_snake_curve_options,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    report: *mut shapeop_snake_curve_report,
}

/// The value at a part of the way through values that are evenly spaced.
fn between(values: &[f64], part: f64) -> f64 {
    let last = values.len() - 1;
    let at = part.clamp(0.0, 1.0) * last as f64;
    let i = (at.floor() as usize).min(last);
    let next = (i + 1).min(last);
    values[i] + (at - i as f64) * (values[next] - values[i])
}

/// # Safety
/// All of `asked` is as the functions say that take it.
unsafe fn trace(surface: impl FnOnce() -> Result<Surface>, asked: &Asked) -> Result<()> {
    // SAFETY: the caller vouches for the arrays and structs; numbers are valid for any bytes.
    let (start, tangent, curvatures, told, size) = unsafe {
        let start = io::vector("start", asked.start)?;
        let tangent = io::vector("tangent", asked.tangent)?;
        let curvatures = io::numbers("curvatures", asked.curvatures, "nb_curvatures", asked.nb_curvatures)?;
        let size = if asked.report.is_null() { 0 } else { structs::size("report", asked.report)? };
        (start, tangent, curvatures, io::told("options", asked.options, default_options())?, size)
    };
    if curvatures.is_empty() {
        let reason = "expected 1, or more along the curve, found none";
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("nb_curvatures"));
    }
    if let Some(k) = curvatures.iter().position(|value| !(*value >= 0.0 && value.is_finite())) {
        let reason = format!("expected a finite number of 0 or more, found {}", curvatures[k]);
        return Err(Error::new(Status::InvalidValue, reason).at(format!("curvatures[{k}]")));
    }
    let side = if io::truth("options->turns_right", told.turns_right)? { Side::Right } else { Side::Left };
    let steps = told.steps as usize;
    if !(1..=MOST_STEPS).contains(&steps) {
        let reason = format!("expected 1 to {MOST_STEPS}, found {steps}");
        return Err(Error::new(Status::InvalidValue, reason).at("options->steps"));
    }
    let method = if io::truth("options->method", told.method)? { Method::Chords } else { Method::RungeKutta };
    let length = asked.length;
    let course = Course { curvature: &|along| between(&curvatures, along / length), length, side };
    let options = curvature_curve::Options { steps, method };
    let names = [("course.curvature", "curvatures"), ("course.", ""), ("options.", "options->")];
    let found = surface()?.curve(start, tangent, &course, &options).map_err(|error| placed(error, &names))?;
    let (end, bends) = match found.end {
        End::Length => (shapeop_snake_curve_end::SO_SNAKE_CURVE_LENGTH, [0.0; 2]),
        End::Boundary => (shapeop_snake_curve_end::SO_SNAKE_CURVE_BOUNDARY, [0.0; 2]),
        End::NoSolution { curvature, normal_curvature } => {
            (shapeop_snake_curve_end::SO_SNAKE_CURVE_BENDS_MORE, [curvature, normal_curvature])
        }
        End::Fold => (shapeop_snake_curve_end::SO_SNAKE_CURVE_FOLD, [0.0; 2]),
    };
    let length = found.lengths.last().copied().unwrap_or(0.0);
    let told =
        shapeop_snake_curve_report { struct_size: 0, end, length, curvature: bends[0], normal_curvature: bends[1] };
    let (report, mut outputs) = (asked.report, Outputs::default());
    // SAFETY: the caller vouches for the outputs; `size` bytes of the report.
    unsafe {
        outputs.sized("points", asked.points, asked.capacity, asked.count, io::coordinates(&found.points), 3)?;
        if !report.is_null() {
            outputs.then(move || structs::write(report, size, &told));
        }
    }
    outputs.write()
}

/// Finds the curve of given curvature on a surface of a kind (a `shapeop_snake_surface`) that begins at the nearest point
/// to `start` in the direction of `tangent`. `curvatures`, `nb_curvatures` of 0 or more, in 1/model units, are those at
/// evenly spaced places along the length, linear in between; one is that of the whole curve. From a point there is one
/// curve that turns left and one that turns right as long as the surface itself bends less than the curve along it;
/// otherwise none (`SO_NO_SOLUTION` at the start; later the curve ends there).
///
/// Writes its points, one for each step and the start, at most 2 more than steps, if there is room for `capacity` of
/// them, and their number to `count`; to `report`, which is null or has its `struct_size` set, what was found. `options`
/// is null for the defaults.
///
/// # Safety
/// `numbers`, `curvatures` and the vectors are null or readable for `nb_numbers`, `nb_curvatures` and 3 doubles;
/// `points` is null or writable for `3 * capacity` doubles, `count` for one int. `options` and `report` are null, or
/// their `struct_size` is set and they are readable or writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCurve(
    kind: c_int,
    numbers: *const f64,
    nb_numbers: c_int,
    start: *const f64,
    tangent: *const f64,
    curvatures: *const f64,
    nb_curvatures: c_int,
    length: f64,
    options: *const shapeop_snake_curve_options,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    report: *mut shapeop_snake_curve_report,
) -> shapeop_err {
    code(guard_free(|| {
        let asked =
            Asked { start, tangent, curvatures, nb_curvatures, length, options, points, capacity, count, report };
        // SAFETY: the caller vouches for it all.
        unsafe { trace(|| named(kind, numbers, nb_numbers), &asked) }
    }))
}

/// As `shapeop_snakeCurve`, on a mesh as `shapeop_snakeSetMesh` takes it; `start` is nearer to it than its edges are
/// long.
///
/// # Safety
/// As of both.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeMeshCurve(
    mesh_points: *const f64,
    nb_mesh_points: c_int,
    face_indices: *const c_int,
    nb_face_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
    start: *const f64,
    tangent: *const f64,
    curvatures: *const f64,
    nb_curvatures: c_int,
    length: f64,
    options: *const shapeop_snake_curve_options,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    report: *mut shapeop_snake_curve_report,
) -> shapeop_err {
    code(guard_free(|| {
        let asked =
            Asked { start, tangent, curvatures, nb_curvatures, length, options, points, capacity, count, report };
        // SAFETY: the caller vouches for it all.
        unsafe {
            let surface = || {
                let names = [("points", "mesh_points"), ("nb_points", "nb_mesh_points")];
                meshed(mesh_points, nb_mesh_points, face_indices, nb_face_indices, counts, nb_counts)
                    .map_err(|error| placed(error, &names))
            };
            trace(surface, &asked)
        }
    }))
}
