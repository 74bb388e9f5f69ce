//! The motion of a snake as a linkage, around until it comes back.

use std::ffi::{c_int, c_uint, c_void};

use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::evolve::{shapeop_snake_progress, shapeop_snake_progress_callback};
use super::guard;
use super::io::{self, placed};
use super::snake::ShapeOpSnake;
use crate::error::{Error, Result};
use crate::geometry::snakes::cycle::{self, End, Motion, Progress};

/// How a linkage's motion is followed. Start from `shapeop_snakeDefaultCycleOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_cycle_options {
    /// In: `sizeof(shapeop_snake_cycle_options)`.
    pub struct_size: c_uint,
    /// Steps at most, at least 1. Default 20 000.
    pub max_steps: c_uint,
    /// 1: the first arc begins by turning clockwise about its hinge, seen against the direction from the first control
    /// point to the second. Default 0.
    pub is_reversed: c_int,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// By which angle the driving arc turns in a step, in radians, above 0 and at most 0.2. Default 0.02.
    pub step: f64,
}

/// Why a linkage's motion ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_snake_cycle_end {
    /// It came back to the start.
    SO_SNAKE_CYCLE_CLOSED = 0,
    /// All steps were used.
    SO_SNAKE_CYCLE_STEPS = 1,
    /// At the last position it can move in another number of ways than one: see `free`.
    SO_SNAKE_CYCLE_FREEDOMS = 2,
    /// No step leads on.
    SO_SNAKE_CYCLE_STALLED = 3,
    /// The callback said so.
    SO_SNAKE_CYCLE_CANCELLED = 4,
}

/// What was found of a linkage's motion.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_snake_cycle {
    /// In: `sizeof(shapeop_snake_cycle)`.
    pub struct_size: c_uint,
    /// Why it ends.
    pub end: shapeop_snake_cycle_end,
    /// In how many ways it can move at the last position, where the motion ends for that; otherwise 1.
    pub free: c_uint,
    /// The number of frames; a closed motion does not repeat the start.
    pub frame_count: c_uint,
    /// How far the first arc has turned when a closed motion is at its start again, in whole turns.
    pub first_turns: c_int,
    /// The same of the last arc.
    pub last_turns: c_int,
    /// How often the drive changed ends.
    pub switch_count: c_uint,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// How far the position found in the end is from the first, as the largest distance of two control points, in model
    /// units; -1 of a motion that is not closed.
    pub closing: f64,
    /// How far apart the extreme positions of the first arc are, in radians.
    pub first_range: f64,
    /// The same of the last arc.
    pub last_range: f64,
    /// By how much a distance is off at most in any frame, in model units.
    pub residual: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_cycle_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_cycle_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_snake_cycle {
    const SIZES: &'static [usize] = &[size_of::<shapeop_snake_cycle>()];
}

fn default_options() -> shapeop_snake_cycle_options {
    let cycle::Options { step_rad, is_reversed, max_steps } = cycle::Options::default();
    shapeop_snake_cycle_options {
        struct_size: 0,
        max_steps: io::field(max_steps),
        is_reversed: c_int::from(is_reversed),
        reserved: 0,
        step: step_rad,
    }
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeDefaultCycleOptions(options: *mut shapeop_snake_cycle_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

fn named(error: Error) -> Error {
    placed(error, &[("options.step_rad", "options->step"), ("options.", "options->"), ("linkage", "snake")])
}

fn report(found: &Motion) -> Result<shapeop_snake_cycle> {
    let (end, free) = match found.end {
        End::Closed => (shapeop_snake_cycle_end::SO_SNAKE_CYCLE_CLOSED, 1),
        End::Steps => (shapeop_snake_cycle_end::SO_SNAKE_CYCLE_STEPS, 1),
        End::Freedoms(free) => (shapeop_snake_cycle_end::SO_SNAKE_CYCLE_FREEDOMS, free),
        End::Stalled => (shapeop_snake_cycle_end::SO_SNAKE_CYCLE_STALLED, 1),
        End::Cancelled => (shapeop_snake_cycle_end::SO_SNAKE_CYCLE_CANCELLED, 1),
    };
    let ranges = found.ranges_rad()?;
    Ok(shapeop_snake_cycle {
        struct_size: 0,
        end,
        free: io::field(free),
        frame_count: io::field(found.frames.len()),
        first_turns: found.turns[0],
        last_turns: found.turns[1],
        switch_count: io::field(found.switch_count),
        reserved: 0,
        closing: found.closing.unwrap_or(-1.0),
        first_range: ranges[0],
        last_range: ranges[1],
        residual: found.residual,
    })
}

/// Moves an open snake whose first two control points and last two are fixed, so that its end arcs turn about hinges,
/// until it is back where it began; one of six arcs can move in one way. The snake itself stays at its start; the
/// positions are told by `shapeop_snakeFrames` and others.
///
/// `options` is null for the defaults. `progress` may be null; what ends the call leaves the positions so far. `report`
/// is null, or its `struct_size` is set.
///
/// # Safety
/// `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so many bytes.
/// `progress` is null or a function of that signature.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeCycle(
    snake: *mut ShapeOpSnake,
    options: *const shapeop_snake_cycle_options,
    progress: shapeop_snake_progress_callback,
    user: *mut c_void,
    report: *mut shapeop_snake_cycle,
) -> shapeop_err {
    code(guard(snake, |draft| {
        // SAFETY: the caller vouches for the structs; numbers are valid for any bytes.
        let (told, size) = unsafe {
            let size = if report.is_null() { 0 } else { structs::size("report", report)? };
            (io::told("options", options, default_options())?, size)
        };
        let options = cycle::Options {
            step_rad: told.step,
            is_reversed: io::truth("options->is_reversed", told.is_reversed)?,
            max_steps: told.max_steps as usize,
        };
        let most = options.max_steps.max(1) as f64;
        let mut watch = |now: &Progress| {
            let told = shapeop_snake_progress {
                struct_size: size_of::<shapeop_snake_progress>() as c_uint,
                step: io::field(now.step),
                fraction: (now.step as f64 / most).min(1.0),
                time: 0.0,
                deviation: 0.0,
                residual: 0.0,
                first_angle: now.angles_rad[0],
                last_angle: now.angles_rad[1],
            };
            io::call_back(progress, user, &told)
        };
        let found = draft.cycle(&options, &mut watch).map_err(named)?;
        if !report.is_null() {
            let told = self::report(found)?;
            // SAFETY: the caller vouches for so many bytes.
            unsafe { structs::write(report, size, &told) };
        }
        Ok(())
    }))
}
