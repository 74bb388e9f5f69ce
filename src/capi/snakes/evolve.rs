//! How a snake moves.

use std::ffi::{c_int, c_uint, c_void};

use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::guard;
use super::io::{self, Outputs, placed};
use super::snake::ShapeOpSnake;
use crate::error::{Error, Result, Status};
use crate::geometry::snakes::evolution::{Evolution, Options, Progress, Stop, Weights};
use crate::geometry::snakes::projection;

/// What the progress callback of a call on snakes is told.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_progress {
    /// `sizeof(shapeop_snake_progress)` in the library; fields may be added at the end.
    pub struct_size: c_uint,
    /// Steps made so far.
    pub step: c_uint,
    /// The part done, 0 to 1, of what may be needed.
    pub fraction: f64,
    /// The time; of a linkage's motion 0.
    pub time: f64,
    /// The largest distance of a contact point or the middle of an arc from the surface, in model units; 0 without one.
    pub deviation: f64,
    /// By how much a distance or a rail is missed at most, in model units; of a linkage's motion 0.
    pub residual: f64,
    /// By how much the first arc of a linkage is turned from its start, in radians; of an evolution 0.
    pub first_angle: f64,
    /// By how much the last arc of a linkage is turned from its start, in radians; of an evolution 0.
    pub last_angle: f64,
}

/// Called before every step, on the thread that made the call. Returns 0 to go on; anything else ends the call, which
/// succeeds with the positions so far. It must return: no exception, no `longjmp`.
pub type shapeop_snake_progress_callback =
    Option<unsafe extern "C" fn(progress: *const shapeop_snake_progress, user: *mut c_void) -> c_int>;

/// Why an evolution stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_snake_stop {
    /// All steps were made.
    SO_SNAKE_STOP_STEPS = 0,
    /// The next position would be farther from the surface than allowed: see `stop_distance`.
    SO_SNAKE_STOP_DEVIATION = 1,
    /// Velocities, or positions, are not determined.
    SO_SNAKE_STOP_SINGULAR = 2,
    /// A rail ended, or the snake left it: see `stop_rail` and `stop_distance`.
    SO_SNAKE_STOP_RAIL_END = 3,
    /// A rail that the snake glides on became parallel to it: see `stop_rail`.
    SO_SNAKE_STOP_PARALLEL = 4,
    /// The snake is back at its start.
    SO_SNAKE_STOP_CYCLE = 5,
    /// It does not move any more.
    SO_SNAKE_STOP_STALLED = 6,
    /// The callback said so.
    SO_SNAKE_STOP_CANCELLED = 7,
}

/// How a snake moves. Start from `shapeop_snakeDefaultOptions`. Weights are 0 or more: what squared differences of
/// velocities from what they are to be are multiplied by.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_options {
    /// In: `sizeof(shapeop_snake_options)`.
    pub struct_size: c_uint,
    /// Stop after so many steps. Default 100.
    pub max_steps: c_uint,
    /// 1: steps follow accelerations too, and can be longer. Default 0.
    pub is_second_order: c_int,
    /// 1: distances of control points three apart stay, so that the snake moves rigidly; where that contradicts rails, as
    /// well as possible. Default 0.
    pub keeps_torsions: c_int,
    /// 1: stop when the snake is back where it started. Default 1.
    pub stops_at_cycle: c_int,
    /// 1: steps are projected to the nearest position; only without a surface. Default 0.
    pub is_exact: c_int,
    /// Iterations of a projection at most. Default 60.
    pub projection_iterations: c_uint,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// The time of a step, above 0. Steps are halved where they lead too far. Default 0.05.
    pub step: f64,
    /// No step is shorter than this part of `step`; above 0, at most 1. Default 1e-4.
    pub least_step: f64,
    /// Stop before a contact point or the middle of an arc is farther from the surface than this, in model units; below 0:
    /// anywhere. Default -1.
    pub max_deviation: f64,
    /// The weight of velocities tangential to the surface. Default 1.
    pub tangential: f64,
    /// The weight of speeds in the direction of `shapeop_snakeSetDirection`. Default 0.001.
    pub offset: f64,
    /// The weight of torsions that do not change. Default 0.
    pub rotation: f64,
    /// The weight of velocities at right angles to arcs. Default 0.
    pub orthogonal: f64,
    /// What accelerations along the surface count against those across it, above 0. Default 0.01.
    pub alpha: f64,
    /// What the squared way of a projection counts against squared errors of distances, above 0. Default 0.005.
    pub mu: f64,
    /// What squared errors of heights over the surface count against them, 0 or more: above 0 they are met to round-off
    /// where that is possible. Default 0.01.
    pub surface_weight: f64,
}

/// What an evolution found.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_evolution {
    /// In: `sizeof(shapeop_snake_evolution)`.
    pub struct_size: c_uint,
    /// Why it stopped.
    pub stop: shapeop_snake_stop,
    /// The rail that stopped it, or -1.
    pub stop_rail: c_int,
    /// The number of frames, the start among them.
    pub frame_count: c_uint,
    /// How far the snake would be from the surface, or from the rail, in model units; 0 where a driven point came to the
    /// end of its rail, and for all other reasons.
    pub stop_distance: f64,
    /// The time of the last frame.
    pub time: f64,
    /// The largest deviation of all frames from the surface, in model units; 0 without one.
    pub deviation: f64,
    /// By how much a distance or a rail is missed at most in any frame, in model units.
    pub residual: f64,
    /// By how much the height of a control point over the surface differs from that at the start at most.
    pub height_residual: f64,
    /// By how much a distance of control points three apart is off at most, where those are kept.
    pub incongruence: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_evolution {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_evolution>()];
}

fn default_options() -> shapeop_snake_options {
    let defaults = Options::default();
    let (weights, projection) = (defaults.weights, defaults.projection);
    shapeop_snake_options {
        struct_size: 0,
        max_steps: io::field(defaults.max_steps),
        is_second_order: c_int::from(defaults.is_second_order),
        keeps_torsions: c_int::from(defaults.keeps_torsions),
        stops_at_cycle: c_int::from(defaults.stops_at_cycle),
        is_exact: c_int::from(projection.is_exact),
        projection_iterations: io::field(projection.max_iterations),
        reserved: 0,
        step: defaults.step,
        least_step: defaults.least_step,
        max_deviation: if defaults.max_deviation.is_finite() { defaults.max_deviation } else { -1.0 },
        tangential: weights.tangential,
        offset: weights.offset,
        rotation: weights.rotation,
        orthogonal: weights.orthogonal,
        alpha: defaults.alpha,
        mu: projection.mu,
        surface_weight: projection.surface_weight,
    }
}

/// # Safety
/// `options` is null, or its `struct_size` is set and it is readable for so many bytes.
unsafe fn options(options: *const shapeop_snake_options) -> Result<Options> {
    // SAFETY: the caller vouches for it; numbers are valid for any bytes.
    let told = unsafe { io::told("options", options, default_options())? };
    Ok(Options {
        step: told.step,
        least_step: told.least_step,
        max_steps: told.max_steps as usize,
        // What is not a number is refused as a deviation.
        max_deviation: if told.max_deviation < 0.0 { f64::INFINITY } else { told.max_deviation },
        weights: Weights {
            tangential: told.tangential,
            offset: told.offset,
            rotation: told.rotation,
            orthogonal: told.orthogonal,
        },
        is_second_order: io::truth("options->is_second_order", told.is_second_order)?,
        alpha: told.alpha,
        keeps_torsions: io::truth("options->keeps_torsions", told.keeps_torsions)?,
        stops_at_cycle: io::truth("options->stops_at_cycle", told.stops_at_cycle)?,
        projection: projection::Options {
            mu: told.mu,
            surface_weight: told.surface_weight,
            is_exact: io::truth("options->is_exact", told.is_exact)?,
            max_iterations: told.projection_iterations as usize,
        },
    })
}

/// The error with the names of C's arguments.
fn named(error: Error) -> Error {
    let names = [
        ("options.projection.max_iterations", "options->projection_iterations"),
        ("options.max_iterations", "options->projection_iterations"),
        ("options.weights.", "options->"),
        ("options.weights", "options"),
        ("options.projection.", "options->"),
        ("options.", "options->"),
    ];
    placed(error, &names)
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeDefaultOptions(options: *mut shapeop_snake_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// Writes the velocities with which the snake would begin to move, in model units per time, if there is room for
/// `capacity` control points, and their number to `count`; to `residual`, which may be null, by how much they miss a
/// condition at most: round-off, unless conditions contradict each other. `options` is null for the defaults.
///
/// # Safety
/// `velocities` is null or writable for `3 * capacity` doubles, `count` for one int, `residual` for one double. `options`
/// is null, or its `struct_size` is set and it is readable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeVelocity(
    snake: *mut ShapeOpSnake,
    options: *const shapeop_snake_options,
    velocities: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    residual: *mut f64,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the struct.
        let options = unsafe { self::options(options)? };
        let found = draft.velocity(&options).map_err(named)?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.sized("velocities", velocities, capacity, count, io::coordinates(&found.vectors), 3)?;
            outputs.may("residual", residual, vec![found.residual])?;
        }
        outputs.write()
    }))
}

/// What a projection found.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_projection {
    /// In: `sizeof(shapeop_snake_projection)`.
    pub struct_size: c_uint,
    /// Iterations of the first phase.
    pub iterations: c_uint,
    /// Steps of the second.
    pub steps: c_uint,
    /// 1 if it is the nearest position to round-off, where that was asked for.
    pub is_nearest: c_int,
    /// By how much a distance is off at most, in model units.
    pub residual: f64,
    /// By how much a control point is from its target at most, in model units.
    pub moved: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_projection {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_projection>()];
}

/// Puts the snake to a position near the target, one point for each control point, that its arcs can have; with `is_exact`
/// 1 to the nearest one. Fixed points stay at their targets; the surface and rails do not count. Of `options`, which is
/// null for the defaults, `mu`, `is_exact` and `projection_iterations` count. `report` is null, or its `struct_size` is
/// set. What was found of the snake's motion is forgotten.
///
/// # Safety
/// `target` is null or readable for `3 * nb_target` doubles; `options` and `report` are null, or their `struct_size` is
/// set and they are readable or writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeProject(
    snake: *mut ShapeOpSnake,
    target: *const f64,
    nb_target: c_int,
    options: *const shapeop_snake_options,
    report: *mut shapeop_snake_projection,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the array and the structs.
        let (target, options, size) = unsafe {
            let size = if report.is_null() { 0 } else { structs::size("report", report)? };
            (io::points("target", target, "nb_target", nb_target)?, self::options(options)?, size)
        };
        let found = draft.project(&target, &options.projection).map_err(|error| match error.place() {
            "target" if error.status() == Status::InvalidArgumentLength => error.with_place("nb_target"),
            _ => named(error),
        })?;
        let told = shapeop_snake_projection {
            struct_size: 0,
            iterations: io::field(found.iterations),
            steps: io::field(found.steps),
            is_nearest: c_int::from(options.projection.is_exact && found.is_nearest),
            residual: found.residual,
            moved: found.moved,
        };
        if !report.is_null() {
            // SAFETY: the caller vouches for so many bytes.
            unsafe { structs::write(report, size, &told) };
        }
        Ok(())
    }))
}

fn report(found: &Evolution) -> shapeop_snake_evolution {
    let (stop, rail, distance) = match found.stop {
        Stop::Steps => (shapeop_snake_stop::SO_SNAKE_STOP_STEPS, None, 0.0),
        Stop::Deviation(by) => (shapeop_snake_stop::SO_SNAKE_STOP_DEVIATION, None, by),
        Stop::Singular => (shapeop_snake_stop::SO_SNAKE_STOP_SINGULAR, None, 0.0),
        Stop::RailEnd { rail, distance } => (shapeop_snake_stop::SO_SNAKE_STOP_RAIL_END, Some(rail), distance),
        Stop::Parallel { rail } => (shapeop_snake_stop::SO_SNAKE_STOP_PARALLEL, Some(rail), 0.0),
        Stop::Cycle => (shapeop_snake_stop::SO_SNAKE_STOP_CYCLE, None, 0.0),
        Stop::Stalled => (shapeop_snake_stop::SO_SNAKE_STOP_STALLED, None, 0.0),
        Stop::Cancelled => (shapeop_snake_stop::SO_SNAKE_STOP_CANCELLED, None, 0.0),
    };
    let largest =
        |of: fn(&crate::geometry::snakes::evolution::Frame) -> f64| found.frames.iter().map(of).fold(0.0, f64::max);
    shapeop_snake_evolution {
        struct_size: 0,
        stop,
        stop_rail: rail.and_then(|rail| c_int::try_from(rail).ok()).unwrap_or(-1),
        frame_count: io::field(found.frames.len()),
        stop_distance: distance,
        time: found.last().time,
        deviation: largest(|frame| frame.deviation),
        residual: largest(|frame| frame.residual),
        height_residual: largest(|frame| frame.height_residual),
        incongruence: largest(|frame| frame.incongruence),
    }
}

/// Moves a snake step by step. The snake itself stays at its start; the positions are told by `shapeop_snakeFrames` and
/// others, and `shapeop_snakeTakeFrame` puts the snake to one of them.
///
/// `options` is null for the defaults. `progress` may be null; what ends the call leaves the positions so far. `report`
/// is null, or its `struct_size` is set.
///
/// # Safety
/// `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so many bytes.
/// `progress` is null or a function of that signature.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeEvolve(
    snake: *mut ShapeOpSnake,
    options: *const shapeop_snake_options,
    progress: shapeop_snake_progress_callback,
    user: *mut c_void,
    report: *mut shapeop_snake_evolution,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the structs.
        let (options, size) = unsafe {
            let size = if report.is_null() { 0 } else { structs::size("report", report)? };
            (self::options(options)?, size)
        };
        let most = options.max_steps.max(1) as f64;
        let mut watch = |now: &Progress<'_>| {
            let told = shapeop_snake_progress {
                struct_size: size_of::<shapeop_snake_progress>() as c_uint,
                step: io::field(now.step),
                fraction: (now.step as f64 / most).min(1.0),
                time: now.last.time,
                deviation: now.last.deviation,
                residual: now.last.residual,
                first_angle: 0.0,
                last_angle: 0.0,
            };
            io::call_back(progress, user, &told)
        };
        let found = draft.evolve(&options, &mut watch).map_err(named)?;
        if !report.is_null() {
            // SAFETY: the caller vouches for so many bytes.
            unsafe { structs::write(report, size, &self::report(found)) };
        }
        Ok(())
    }))
}
