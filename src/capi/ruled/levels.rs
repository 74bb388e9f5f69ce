//! Strip boundaries as level curves of a function.

use std::ffi::{c_int, c_uint, c_void};

use super::super::arguments::length;
use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::boundaries::shapeop_ruled_boundary_options;
use super::design::ShapeOpRuled;
use super::guard;
use super::io::{self, Outputs, placed};
use super::optimise::{shapeop_ruled_progress, shapeop_ruled_progress_callback, shapeop_ruled_stop};
use crate::error::{Error, Result, Status};
use crate::geometry::ruled::boundaries::Levels;
use crate::geometry::ruled::design::Draft;
use crate::geometry::ruled::level_function::{LevelFunction, LevelOptions, LevelWeights};
use crate::geometry::ruled::spherical_image::{ImageKind, ImageReport};
use crate::linalg::gauss_newton::{Progress, Stop};

/// What strip boundaries are to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_ruled_levels {
    /// Orthogonal to the rulings, at distances of one length where that is possible.
    SO_RULED_LEVELS_ORTHOGONAL = 0,
    /// Orthogonal to the rulings, at whatever distances.
    SO_RULED_LEVELS_DIRECTION = 1,
    /// At constant distances.
    SO_RULED_LEVELS_EQUIDISTANT = 2,
    /// Geodesic: the straightest on the surface.
    SO_RULED_LEVELS_GEODESIC = 3,
    /// Such that the rulings along each are parallel to a plane.
    SO_RULED_LEVELS_CONOIDAL = 4,
}

/// What is asked of a level function, by weights of 0 or more without units. Start from
/// `shapeop_ruledDefaultLevelOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_level_options {
    /// In: `sizeof(shapeop_ruled_level_options)`.
    pub struct_size: c_uint,
    /// The most iterations. Default 30.
    pub max_iterations: c_uint,
    /// 1: a folded spherical image is used nevertheless. Default 0.
    pub allow_folds: c_int,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// Boundaries orthogonal to the rulings, at a distance of one length.
    pub orthogonal: f64,
    /// Boundaries orthogonal to the rulings, at whatever distances.
    pub direction: f64,
    /// Boundaries at constant distances.
    pub equidistant: f64,
    /// Geodesic boundaries; one of the weights above must be positive too.
    pub geodesic: f64,
    /// Boundaries whose rulings are parallel to a plane; one of the first two weights must be positive too.
    pub conoidal: f64,
    /// Smoothness; keep it low.
    pub laplace: f64,
    /// Iterations end where the sum of the terms fell by less than this part of it. Default 1e-6.
    pub relative_decrease: f64,
}

/// What the spherical image of a field is like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_ruled_image {
    /// It was not asked for: the weight `conoidal` was 0.
    SO_RULED_IMAGE_NONE = 0,
    /// It covers a part of the sphere.
    SO_RULED_IMAGE_REGULAR = 1,
    /// It covers a part of the sphere twice.
    SO_RULED_IMAGE_FOLDED = 2,
    /// It collapsed to a great circle: every strip is conoidal, and the weight was not used.
    SO_RULED_IMAGE_GREAT_CIRCLE = 3,
    /// It collapsed to another curve: the surface is ruled, and the weight was not used.
    SO_RULED_IMAGE_CURVE = 4,
}

/// What was found of a level function.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_level_report {
    /// In: `sizeof(shapeop_ruled_level_report)`.
    pub struct_size: c_uint,
    /// Why iterations ended; `SO_RULED_STOP_NONE` if a linear problem was all there was.
    pub stop: shapeop_ruled_stop,
    /// Iterations made.
    pub iterations: c_uint,
    /// Points around which the function does not rise on one side and fall on the other.
    pub critical_count: c_uint,
    /// What the spherical image is like.
    pub image: shapeop_ruled_image,
    /// Triangles without an image, or one without area.
    pub image_unused_count: c_uint,
    /// The least length of the gradient: 1 where boundaries are at the distance of their levels.
    pub least_slope: f64,
    /// The greatest length of the gradient.
    pub greatest_slope: f64,
    /// How much of the image is area, 0 to 1; 0 of none.
    pub image_extent: f64,
    /// The part of its area that is folded over, 0 to 1/2.
    pub image_folded: f64,
    /// How far directions are from one plane: their least singular value over the largest.
    pub image_flatness: f64,
    /// The unit vector that directions are most nearly orthogonal to, x.
    pub image_axis_x: f64,
    /// See `image_axis_x`.
    pub image_axis_y: f64,
    /// See `image_axis_x`.
    pub image_axis_z: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_level_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_level_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_level_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_level_report>()];
}

fn as_told(weights: LevelWeights) -> shapeop_ruled_level_options {
    let defaults = LevelOptions::default();
    shapeop_ruled_level_options {
        struct_size: 0,
        max_iterations: io::field(defaults.max_iterations),
        allow_folds: c_int::from(defaults.allows_folds),
        reserved: 0,
        orthogonal: weights.orthogonal,
        direction: weights.direction,
        equidistant: weights.equidistant,
        geodesic: weights.geodesic,
        conoidal: weights.conoidal,
        laplace: weights.laplace,
        relative_decrease: defaults.relative_decrease,
    }
}

const KINDS: [(shapeop_ruled_levels, LevelWeights); 5] = [
    (shapeop_ruled_levels::SO_RULED_LEVELS_ORTHOGONAL, LevelWeights::ORTHOGONAL),
    (shapeop_ruled_levels::SO_RULED_LEVELS_DIRECTION, LevelWeights::DIRECTION),
    (shapeop_ruled_levels::SO_RULED_LEVELS_EQUIDISTANT, LevelWeights::EQUIDISTANT),
    (shapeop_ruled_levels::SO_RULED_LEVELS_GEODESIC, LevelWeights::GEODESIC),
    (shapeop_ruled_levels::SO_RULED_LEVELS_CONOIDAL, LevelWeights::CONOIDAL),
];

/// Writes the default options for boundaries of a kind (a `shapeop_ruled_levels`) to `options`, whose `struct_size`
/// must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledDefaultLevelOptions(
    kind: c_int,
    options: *mut shapeop_ruled_level_options,
) -> shapeop_err {
    code(guard_free(|| {
        let weights = KINDS.iter().find(|(own, _)| *own as c_int == kind).map(|(_, weights)| *weights);
        let reason = || format!("expected a shapeop_ruled_levels, 0 to {}, found {kind}", KINDS.len() - 1);
        let weights = weights.ok_or_else(|| Error::new(Status::InvalidValue, reason()).at("kind"))?;
        // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
        unsafe { structs::tell("options", options, &as_told(weights)) }
    }))
}

/// The one of `count`, `width` and `values` that is given.
///
/// # Safety
/// `values` is null or readable for `nb_values` doubles.
unsafe fn levels(count: c_int, width: f64, values: *const f64, nb_values: c_int) -> Result<Levels> {
    // SAFETY: the caller vouches for the array.
    let values = unsafe { io::numbers("values", values, "nb_values", nb_values)? };
    match (count != 0, width != 0.0, !values.is_empty()) {
        (true, false, false) => Ok(Levels::Count(length("count", count)?)),
        (false, true, false) => Ok(Levels::Width(width)),
        (false, false, true) => Ok(Levels::Values(values)),
        _ => {
            let reason = format!(
                "expected one of a count, a width and values, found a count of {count}, a width of {width} and \
                 {nb_values} values"
            );
            Err(Error::new(Status::InvalidValue, reason).at("count"))
        }
    }
}

/// The error with the names of C's arguments.
fn named(error: Error, levels: &Levels) -> Error {
    if error.place().starts_with("levels") && !matches!(levels, Levels::Values(_)) {
        return error.with_place(if matches!(levels, Levels::Count(_)) { "count" } else { "width" });
    }
    let names = [
        ("levels", "values"),
        ("options.weights.", "options->"),
        ("options.weights", "options"),
        ("options.least_length", "boundaries->least_length"),
        ("options.", "options->"),
        ("field", "design"),
    ];
    placed(error, &names)
}

/// Finds a function that rises along the field and takes level curves of it as strip boundaries, in the order along the
/// field. Which levels, exactly one of three says: `count`, so many, evenly spaced; `width`, as many as fit at this
/// distance, in model units; `values`, these, ascending, `nb_values` of them. The others are 0 or null. On a surface
/// with holes, around which the function jumps by a multiple of the levels' distance, values cannot be given.
///
/// `options` and `boundaries` are null for the defaults. `progress` may be null; it is called before every iteration,
/// and what ends the call leaves the best so far. Takes back boundaries and strips.
///
/// # Safety
/// `values` is null or readable for `nb_values` doubles. `options` and `boundaries` are null, or their `struct_size` is
/// set and they are readable for so many bytes. `progress` is null or a function of that signature.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledSetLevelBoundaries(
    design: *mut ShapeOpRuled,
    options: *const shapeop_ruled_level_options,
    count: c_int,
    width: f64,
    values: *const f64,
    nb_values: c_int,
    boundaries: *const shapeop_ruled_boundary_options,
    progress: shapeop_ruled_progress_callback,
    user: *mut c_void,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for the array and the structs; numbers are valid for any bytes.
        let (told, levels, boundaries) = unsafe {
            let told = io::told("options", options, as_told(LevelWeights::ORTHOGONAL))?;
            (told, levels(count, width, values, nb_values)?, io::boundary_options(boundaries)?)
        };
        let function = LevelOptions {
            weights: LevelWeights {
                orthogonal: told.orthogonal,
                direction: told.direction,
                equidistant: told.equidistant,
                geodesic: told.geodesic,
                conoidal: told.conoidal,
                laplace: told.laplace,
            },
            flips: Vec::new(),
            allows_folds: io::truth("options->allow_folds", told.allow_folds)?,
            max_iterations: told.max_iterations as usize,
            relative_decrease: told.relative_decrease,
        };
        let most = function.max_iterations.max(1) as f64;
        let mut watch = |now: &Progress| {
            let told = shapeop_ruled_progress {
                struct_size: size_of::<shapeop_ruled_progress>() as c_uint,
                iteration: io::field(now.iteration),
                fraction: (now.iteration as f64 / most).min(1.0),
                value: now.value,
                largest_deviation: 0.0,
                largest_gap: 0.0,
            };
            io::call_back(progress, user, &told)
        };
        let made = draft.step(|design| design.set_level_boundaries(&function, &levels, &boundaries, &mut watch));
        made.map_err(|error| named(error, &levels))
    }))
}

/// As `shapeop_ruledSetLevelBoundaries`, with other levels of the function that was found before; not on a surface with
/// holes.
///
/// # Safety
/// `values` is null or readable for `nb_values` doubles. `boundaries` is null, or its `struct_size` is set and it is
/// readable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledSetLevels(
    design: *mut ShapeOpRuled,
    count: c_int,
    width: f64,
    values: *const f64,
    nb_values: c_int,
    boundaries: *const shapeop_ruled_boundary_options,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for the array and the struct; numbers are valid for any bytes.
        let (levels, boundaries) =
            unsafe { (levels(count, width, values, nb_values)?, io::boundary_options(boundaries)?) };
        draft.step(|design| design.set_levels(&levels, &boundaries)).map_err(|error| named(error, &levels))
    }))
}

fn function(draft: &Draft) -> Result<&LevelFunction> {
    let reason = "expected level curves as boundaries: call shapeop_ruledSetLevelBoundaries first";
    draft.design().function().ok_or_else(|| Error::new(Status::NotInitialised, reason).at("design"))
}

/// Writes the values of the level function at the points of the mesh, in model units, the least 0, if there is room for
/// `capacity` of them, and their number to `count`.
///
/// # Safety
/// `values` is null or writable for `capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledLevelValues(
    design: *mut ShapeOpRuled,
    values: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("values", values, capacity, count, function(draft)?.values.clone(), 1)? };
        outputs.write()
    }))
}

/// Writes the sum of the terms of the level function at the start and after each iteration, if there is room for
/// `capacity` of them, and their number to `count`; none if a linear problem was all there was.
///
/// # Safety
/// `values` is null or writable for `capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledLevelHistory(
    design: *mut ShapeOpRuled,
    values: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = function(draft)?.history.iter().map(|now| now.value).collect();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("values", values, capacity, count, all, 1)? };
        outputs.write()
    }))
}

/// Writes the points around which the level function does not rise on one side and fall on the other, if there is room
/// for `capacity` of them, and their number to `count`.
///
/// # Safety
/// `points` is null or writable for `capacity` ints, `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledCriticalPoints(
    design: *mut ShapeOpRuled,
    points: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = io::ints(function(draft)?.critical.iter().map(|&i| i as usize))?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("points", points, capacity, count, all, 1)? };
        outputs.write()
    }))
}

pub(super) fn stop(stop: Option<Stop>) -> shapeop_ruled_stop {
    match stop {
        None => shapeop_ruled_stop::SO_RULED_STOP_NONE,
        Some(Stop::Gradient | Stop::Step | Stop::Decrease | Stop::Value) => shapeop_ruled_stop::SO_RULED_STOP_CONVERGED,
        Some(Stop::Iterations) => shapeop_ruled_stop::SO_RULED_STOP_ITERATIONS,
        // A start is never infeasible here: there are no conditions.
        Some(Stop::LineSearch | Stop::Infeasible) => shapeop_ruled_stop::SO_RULED_STOP_LINE_SEARCH,
        Some(Stop::Cancelled) => shapeop_ruled_stop::SO_RULED_STOP_CANCELLED,
    }
}

fn image(report: Option<&ImageReport>) -> shapeop_ruled_image {
    match report.map(|report| report.kind) {
        None => shapeop_ruled_image::SO_RULED_IMAGE_NONE,
        Some(ImageKind::Regular) => shapeop_ruled_image::SO_RULED_IMAGE_REGULAR,
        Some(ImageKind::Folded) => shapeop_ruled_image::SO_RULED_IMAGE_FOLDED,
        Some(ImageKind::GreatCircle) => shapeop_ruled_image::SO_RULED_IMAGE_GREAT_CIRCLE,
        Some(ImageKind::Curve) => shapeop_ruled_image::SO_RULED_IMAGE_CURVE,
    }
}

/// Writes what was found of the level function to `report`, whose `struct_size` must be set.
///
/// # Safety
/// `report` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledLevelReport(
    design: *mut ShapeOpRuled,
    report: *mut shapeop_ruled_level_report,
) -> shapeop_err {
    code(guard(design, |draft| {
        let found = function(draft)?;
        let of_image = |value: fn(&ImageReport) -> f64| found.image.as_ref().map_or(0.0, value);
        let told = shapeop_ruled_level_report {
            struct_size: 0,
            stop: stop(found.stop),
            iterations: io::field(found.history.len().saturating_sub(1)),
            critical_count: io::field(found.critical.len()),
            image: image(found.image.as_ref()),
            image_unused_count: io::field(found.image.map_or(0, |image| image.unused_count)),
            least_slope: found.slope[0],
            greatest_slope: found.slope[1],
            image_extent: of_image(|image| image.extent),
            image_folded: of_image(|image| image.folded),
            image_flatness: of_image(|image| image.flatness),
            image_axis_x: of_image(|image| image.axis.x),
            image_axis_y: of_image(|image| image.axis.y),
            image_axis_z: of_image(|image| image.axis.z),
        };
        let numbers =
            [told.least_slope, told.greatest_slope, told.image_extent, told.image_folded, told.image_flatness];
        // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
        unsafe { io::tell("report", report, &told, &numbers) }
    }))
}
