//! Optimising strips.

use std::ffi::{c_int, c_uint, c_void};

use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::design::ShapeOpRuled;
use super::guard;
use super::io::{self, Outputs, placed};
use crate::error::{Error, Result};
use crate::geometry::ruled::Bounds;
use crate::geometry::ruled::optimise::{Iteration, Optimised, Options, Progress, Stop};
use crate::geometry::ruled::terms::Weights;

/// Samples for each control point, or along a ruling, at most.
const MOST_SAMPLES: usize = 1000;

/// What the progress callback of a call on designs is told.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_progress {
    /// `sizeof(shapeop_ruled_progress)` in the library; fields may be added at the end.
    pub struct_size: c_uint,
    /// Iterations made so far.
    pub iteration: c_uint,
    /// The part done, 0 to 1, of what may be needed.
    pub fraction: f64,
    /// What is being minimised.
    pub value: f64,
    /// The largest distance of a sample of the strips to the mesh, in model units; 0 while a level function is found.
    pub largest_deviation: f64,
    /// The largest distance of neighbours' boundaries, in model units; 0 while a level function is found.
    pub largest_gap: f64,
}

/// Called before every iteration, on the thread that made the call. Returns 0 to go on; anything else ends the call,
/// which succeeds with its best so far. It must return: no exception, no `longjmp`.
pub type shapeop_ruled_progress_callback =
    Option<unsafe extern "C" fn(progress: *const shapeop_ruled_progress, user: *mut c_void) -> c_int>;

/// Why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_ruled_stop {
    /// There was nothing to iterate.
    SO_RULED_STOP_NONE = 0,
    /// Steps or decreases became small.
    SO_RULED_STOP_CONVERGED = 1,
    /// All iterations were used.
    SO_RULED_STOP_ITERATIONS = 2,
    /// No step lowers the value: it is as good as rounding allows.
    SO_RULED_STOP_LINE_SEARCH = 3,
    /// The callback said so.
    SO_RULED_STOP_CANCELLED = 4,
}

/// How strips are optimised. Start from `shapeop_ruledDefaultOptimiseOptions`. Weights are 0 or more; distances are in
/// units of the mesh's diagonal and terms are means, so that weights depend on neither size nor sampling.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_optimise_options {
    /// In: `sizeof(shapeop_ruled_optimise_options)`.
    pub struct_size: c_uint,
    /// The most iterations. Default 50.
    pub max_iterations: c_uint,
    /// Samples along a boundary for each control point, 1 to 1000. Default 4.
    pub samples_along: c_uint,
    /// Samples along a ruling, 2 to 1000. Default 5.
    pub samples_across: c_uint,
    /// The weight of the squared distance from strips to the mesh. Default 1.
    pub proximity: f64,
    /// The part of it for what is beyond the boundary of the mesh, 0 to 1. Default 0.01.
    pub beyond: f64,
    /// The weight of the squared distance between boundaries that are to be one. Default 1.
    pub gap: f64,
    /// The weight of the squared distance from the mesh to the nearest strip. Default 1.
    pub coverage: f64,
    /// The weight of the thin plate energy of the way from the start. Default 1e-6.
    pub thin_plate: f64,
    /// The weight of the squared way of the control points from the start. Default 1e-4.
    pub proximal: f64,
    /// The largest distance of samples of the strips to the mesh, in model units; 0: no bound. Default 0.
    pub largest_deviation: f64,
    /// The least length of a ruling, in model units; 0: no bound. Default 0.
    pub least_width: f64,
    /// Stop where no control point moves by more than this multiple of the mesh's diagonal, or the value falls by less
    /// than this part of it. Default 1e-6.
    pub tolerance: f64,
}

/// What optimising found.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_optimise_report {
    /// In: `sizeof(shapeop_ruled_optimise_report)`.
    pub struct_size: c_uint,
    /// Why it stopped.
    pub stop: shapeop_ruled_stop,
    /// Iterations made.
    pub iterations: c_uint,
    /// Numbers that the conditions left free.
    pub free_count: c_uint,
    /// What is minimised, at the start, where the conditions are met.
    pub before: f64,
    /// At the end: the sum of the four terms, and the excess over bounds in units of the mesh's diagonal.
    pub after: f64,
    /// Its term of distances from strips to the mesh.
    pub proximity: f64,
    /// Its term of distances between neighbours.
    pub gap: f64,
    /// Its term of distances from the mesh to strips.
    pub coverage: f64,
    /// Its terms of the way from the start.
    pub way: f64,
    /// By how much a bound is exceeded at most, in model units.
    pub excess: f64,
    /// The largest distance of a sample within the boundary of the mesh to it, in model units.
    pub largest_deviation: f64,
    /// The largest distance of a sample of a boundary to the neighbour's, in model units; 0 where they are shared.
    pub largest_gap: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_optimise_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_optimise_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_optimise_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_optimise_report>()];
}

fn default_options() -> shapeop_ruled_optimise_options {
    let Options { weights, bounds: _, samples, max_iterations, tolerance } = Options::default();
    shapeop_ruled_optimise_options {
        struct_size: 0,
        max_iterations: io::field(max_iterations),
        samples_along: io::field(samples[0]),
        samples_across: io::field(samples[1]),
        proximity: weights.proximity,
        beyond: weights.beyond,
        gap: weights.gap,
        coverage: weights.coverage,
        thin_plate: weights.thin_plate,
        proximal: weights.proximal,
        largest_deviation: 0.0,
        least_width: 0.0,
        tolerance,
    }
}

fn options(told: &shapeop_ruled_optimise_options) -> Result<Options> {
    // What is not a number is a bound, so that it is refused as one.
    let bound = |value: f64| (value != 0.0).then_some(value);
    Ok(Options {
        weights: Weights {
            proximity: told.proximity,
            beyond: told.beyond,
            gap: told.gap,
            coverage: told.coverage,
            thin_plate: told.thin_plate,
            proximal: told.proximal,
        },
        bounds: Bounds { largest_deviation: bound(told.largest_deviation), least_width: bound(told.least_width) },
        samples: [
            io::unsigned("options->samples_along", told.samples_along, 1, MOST_SAMPLES)?,
            io::unsigned("options->samples_across", told.samples_across, 2, MOST_SAMPLES)?,
        ],
        max_iterations: told.max_iterations as usize,
        tolerance: told.tolerance,
    })
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledDefaultOptimiseOptions(
    options: *mut shapeop_ruled_optimise_options,
) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

fn stop(stop: Stop) -> shapeop_ruled_stop {
    match stop {
        Stop::Converged => shapeop_ruled_stop::SO_RULED_STOP_CONVERGED,
        Stop::MostIterations => shapeop_ruled_stop::SO_RULED_STOP_ITERATIONS,
        Stop::LineSearch => shapeop_ruled_stop::SO_RULED_STOP_LINE_SEARCH,
        Stop::Cancelled => shapeop_ruled_stop::SO_RULED_STOP_CANCELLED,
    }
}

fn report(found: &Optimised) -> shapeop_ruled_optimise_report {
    let last = found.last();
    shapeop_ruled_optimise_report {
        struct_size: 0,
        stop: stop(found.stop),
        iterations: io::field(found.history.len() - 1),
        free_count: io::field(found.free_count),
        before: found.history[0].value,
        after: last.value,
        proximity: last.parts.proximity,
        gap: last.parts.gap,
        coverage: last.parts.coverage,
        way: last.parts.way,
        excess: last.excess,
        largest_deviation: last.largest_deviation,
        largest_gap: last.largest_gap,
    }
}

/// The error with the names of C's arguments.
fn named(error: Error) -> Error {
    let names = [
        ("options.weights.", "options->"),
        ("options.bounds.", "options->"),
        ("options.weights", "options"),
        ("options.", "options->"),
    ];
    placed(error, &names)
}

/// Brings the strips as near as they come to the mesh and to each other, under the conditions, which hold exactly
/// afterwards. Conditions that contradict each other are refused (`SO_INFEASIBLE`): `conditions[k]` is the first that
/// contradicts those before it.
///
/// `options` is null for the defaults. `progress` may be null; what ends the call leaves the best so far. `report` is
/// null, or its `struct_size` is set.
///
/// # Safety
/// `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so many bytes.
/// `progress` is null or a function of that signature.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledOptimise(
    design: *mut ShapeOpRuled,
    options: *const shapeop_ruled_optimise_options,
    progress: shapeop_ruled_progress_callback,
    user: *mut c_void,
    report: *mut shapeop_ruled_optimise_report,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for the structs; numbers are valid for any bytes.
        let (told, size) = unsafe {
            let size = if report.is_null() { 0 } else { structs::size("report", report)? };
            (io::told("options", options, default_options())?, size)
        };
        let options = self::options(&told)?;
        let most = options.max_iterations.max(1) as f64;
        let mut watch = |now: &Progress| {
            let told = shapeop_ruled_progress {
                struct_size: size_of::<shapeop_ruled_progress>() as c_uint,
                iteration: io::field(now.iteration),
                fraction: (now.iteration as f64 / most).min(1.0),
                value: now.last.value,
                largest_deviation: now.last.largest_deviation,
                largest_gap: now.last.largest_gap,
            };
            io::call_back(progress, user, &told)
        };
        let found = draft.optimise(&options, &mut watch).map_err(named)?;
        if !report.is_null() {
            // SAFETY: the caller vouches for so many bytes.
            unsafe { structs::write(report, size, &self::report(found)) };
        }
        Ok(())
    }))
}

/// Writes the start and each iteration of the last optimisation, 10 numbers each, if there is room for `capacity` of
/// them, and their number to `count`: the value; its terms of proximity, gap, coverage and way; the excess over bounds,
/// in model units; the part of the step that was taken; how far a control point moved at most; the largest deviation
/// and the largest gap, in model units. Refused if strips changed since (`SO_NOT_INITIALISED`).
///
/// # Safety
/// `rows` is null or writable for `10 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledHistory(
    design: *mut ShapeOpRuled,
    rows: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let row = |now: &Iteration| {
            let parts = [now.parts.proximity, now.parts.gap, now.parts.coverage, now.parts.way];
            let step = [now.excess, now.taken, now.moved, now.largest_deviation, now.largest_gap];
            [&[now.value][..], &parts, &step].concat()
        };
        let all: Vec<f64> = draft.optimised()?.history.iter().flat_map(row).collect();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("rows", rows, capacity, count, all, 10)? };
        outputs.write()
    }))
}
