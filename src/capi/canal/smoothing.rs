//! Smoothing of strips.

use std::ffi::{c_int, c_uint, c_void};
use std::ops::ControlFlow;

use glam::DVec3;

use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::io::{self, Outputs};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::smoothing::{self, Cone, Input, Options};
use crate::linalg::bfgs::Stop;
use crate::mesh::curve::Curve;

/// What the progress callback of a call on surfaces is told.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_canal_progress {
    /// `sizeof(shapeop_canal_progress)` in the library; fields may be added at the end.
    pub struct_size: c_uint,
    /// Iterations or steps made so far.
    pub iteration: c_uint,
    /// The part done, 0 to 1, of what may be needed.
    pub fraction: f64,
    /// What is being minimised, at the best so far; 0 where that is not known.
    pub value: f64,
}

/// Called after every iteration, on the thread that made the call. Returns 0 to go on; anything else ends the call,
/// which succeeds with its best so far. It must return: no exception, no `longjmp`.
pub type shapeop_canal_progress_callback =
    Option<unsafe extern "C" fn(progress: *const shapeop_canal_progress, user: *mut c_void) -> c_int>;

/// What `shapeop_canalSmooth` takes. Start from `shapeop_canalDefaultSmoothOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_canal_smooth_options {
    /// In: `sizeof(shapeop_canal_smooth_options)`.
    pub struct_size: c_uint,
    /// The most iterations. Default 200.
    pub max_iterations: c_uint,
    /// 1: the normal stays on the cone of `cone_axis` and `cone_angle`. Default 0.
    pub has_cone: c_int,
    /// 1: the tangents turn about the normal too. Default 0.
    pub turns_tangents: c_int,
    /// The axis of the cone, x.
    pub cone_axis_x: f64,
    /// The axis of the cone, y.
    pub cone_axis_y: f64,
    /// The axis of the cone, z. Default 1.
    pub cone_axis_z: f64,
    /// The angle of the normal to the axis, in radians, 0 to pi. Default 0.
    pub cone_angle: f64,
    /// The most that two spacings of points change against each other, 1 (they stay) or more; may be infinite. Default
    /// 4.
    pub spacing_ratio: f64,
    /// The most that a length changes, as a part of its first value, above 0; may be infinite. Default 0.25.
    pub length_change: f64,
    /// The weight that keeps lengths as they are. Default 0.
    pub length_weight: f64,
    /// The largest angle, in radians, from an arc's tangent to its chord. Default three quarters of pi.
    pub half_angle: f64,
    /// Stop where the largest entry of the gradient is at most this part of the value. Default 1e-6.
    pub relative_gradient: f64,
    /// Stop where the value fell by less than this part in five iterations. Default 1e-4.
    pub relative_decrease: f64,
}

/// Why smoothing stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_canal_stop {
    /// The gradient is as small as asked for.
    SO_CANAL_STOP_GRADIENT = 0,
    /// The value hardly falls any more.
    SO_CANAL_STOP_DECREASE = 1,
    /// All iterations were used.
    SO_CANAL_STOP_ITERATIONS = 2,
    /// No step lowers the value: it is as good as rounding allows, or at the border of what is feasible.
    SO_CANAL_STOP_LINE_SEARCH = 3,
    /// The callback said so.
    SO_CANAL_STOP_CANCELLED = 4,
    /// The start is not feasible.
    SO_CANAL_STOP_INFEASIBLE = 5,
}

/// What smoothing found.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_canal_smooth_report {
    /// In: `sizeof(shapeop_canal_smooth_report)`.
    pub struct_size: c_uint,
    /// Why it stopped.
    pub stop: shapeop_canal_stop,
    /// The functional at the start, the sum of squared curvatures, in one over squared model units.
    pub before: f64,
    /// At the end.
    pub after: f64,
    /// Iterations made.
    pub iterations: c_uint,
    /// 0; a gap that keeps the size a multiple of 8.
    pub reserved: c_uint,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_canal_smooth_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_canal_smooth_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_canal_smooth_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_canal_smooth_report>()];
}

fn default_options() -> shapeop_canal_smooth_options {
    let defaults = Options::default();
    shapeop_canal_smooth_options {
        struct_size: 0,
        max_iterations: defaults.max_iterations as c_uint,
        has_cone: 0,
        turns_tangents: 0,
        cone_axis_x: 0.0,
        cone_axis_y: 0.0,
        cone_axis_z: 1.0,
        cone_angle: 0.0,
        spacing_ratio: defaults.spacing_ratio,
        length_change: defaults.length_change,
        length_weight: defaults.length_weight,
        half_angle: defaults.half_angle_rad,
        relative_gradient: defaults.relative_gradient,
        relative_decrease: defaults.relative_decrease,
    }
}

fn options(told: &shapeop_canal_smooth_options) -> Result<Options> {
    let axis = DVec3::new(told.cone_axis_x, told.cone_axis_y, told.cone_axis_z);
    let has_cone = io::truth("options->has_cone", told.has_cone)?;
    Ok(Options {
        cone: has_cone.then_some(Cone { axis, angle_rad: told.cone_angle }),
        turns_tangents: io::truth("options->turns_tangents", told.turns_tangents)?,
        spacing_ratio: told.spacing_ratio,
        length_change: told.length_change,
        length_weight: told.length_weight,
        half_angle_rad: told.half_angle,
        max_iterations: told.max_iterations as usize,
        relative_gradient: told.relative_gradient,
        relative_decrease: told.relative_decrease,
    })
}

fn stop(stop: Stop) -> shapeop_canal_stop {
    match stop {
        Stop::Gradient => shapeop_canal_stop::SO_CANAL_STOP_GRADIENT,
        Stop::Decrease => shapeop_canal_stop::SO_CANAL_STOP_DECREASE,
        Stop::Iterations => shapeop_canal_stop::SO_CANAL_STOP_ITERATIONS,
        Stop::LineSearch => shapeop_canal_stop::SO_CANAL_STOP_LINE_SEARCH,
        Stop::Cancelled => shapeop_canal_stop::SO_CANAL_STOP_CANCELLED,
        Stop::Infeasible => shapeop_canal_stop::SO_CANAL_STOP_INFEASIBLE,
    }
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalDefaultSmoothOptions(options: *mut shapeop_canal_smooth_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// Smooths a strip with a frame at its first point (`frame`: the unit tangents `t1`, near the guide's, and `t2`):
/// lowers the sum of the squared curvatures of the arcs over all edges by moving the guide's points along their curve,
/// the cubic spline through them, and by changing lengths and frame. The guide's ends and the direction of the first
/// crossing edge stay.
///
/// `options` is null for the defaults. `progress` may be null. Outputs: the guide and the border, `nb_points` points
/// each, where each guide point is on the curve (`parameters`, in lengths of chords along the given points) and the
/// frame, 9 doubles; the last two may be null. `report` is null, or its `struct_size` is set. Of `history`, the
/// functional at the start and after every iteration, as many entries are written as there are if there is room for
/// `capacity`; `count` is their number. All three are null, 0 and null to leave it out.
///
/// # Safety
/// `guide` and `border` are null or readable, `out_guide` and `out_border` null or writable, for `3 * nb_points`
/// doubles; `frame` is readable for 6. `parameters` is null or writable for `nb_points` doubles, `out_frame` for 9,
/// `history` for `capacity`, `count` for one int. `options` and `report` are null, or their `struct_size` is set and
/// they are readable or writable for so many bytes. `progress` is null or a function of that signature.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalSmooth(
    guide: *const f64,
    border: *const f64,
    nb_points: c_int,
    frame: *const f64,
    options: *const shapeop_canal_smooth_options,
    progress: shapeop_canal_progress_callback,
    user: *mut c_void,
    out_guide: *mut f64,
    out_border: *mut f64,
    parameters: *mut f64,
    out_frame: *mut f64,
    history: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    report: *mut shapeop_canal_smooth_report,
) -> shapeop_err {
    code(guard_free(|| {
        // SAFETY: the caller vouches for the arrays and the structs; numbers are valid for any bytes.
        let (strip, first_frame, told, report_size, curve) = unsafe {
            let told = match options.is_null() {
                true => default_options(),
                false => structs::read("options", options, default_options())?,
            };
            let size = if report.is_null() { 0 } else { structs::size("report", report)? };
            let curve = io::spline("guide", guide, "nb_points", nb_points, false)?;
            (io::strip(guide, border, nb_points)?, io::frame("frame", frame)?, told, size, curve)
        };
        let options = self::options(&told)?;
        let input = Input { curve: &|t| curve.point(t), parameters: curve.knots(), strip: &strip, frame: first_frame };
        let most = options.max_iterations.max(1) as f64;
        let found = smoothing::smooth(&input, &options, &mut |now| -> ControlFlow<()> {
            let told = shapeop_canal_progress {
                struct_size: size_of::<shapeop_canal_progress>() as c_uint,
                iteration: now.iteration as c_uint,
                fraction: (now.iteration as f64 / most).min(1.0),
                value: now.value,
            };
            io::call_back(progress, user, &told)
        })?;
        if ![found.before, found.after].iter().all(|value| value.is_finite()) {
            let reason = "coordinates are so large that the functional is not finite";
            return Err(Error::new(Status::InvalidValue, reason).at("guide"));
        }
        let told = shapeop_canal_smooth_report {
            struct_size: 0,
            stop: stop(found.stop),
            before: found.before,
            after: found.after,
            iterations: found.history.len().saturating_sub(1) as c_uint,
            reserved: 0,
        };
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.must("out_guide", out_guide, io::coordinates(&found.strip.guide))?;
            outputs.must("out_border", out_border, io::coordinates(&found.strip.border))?;
            outputs.may("parameters", parameters, found.parameters)?;
            outputs.may("out_frame", out_frame, io::frame_numbers(&[found.frame]))?;
            if !(history.is_null() && count.is_null()) {
                outputs.sized("history", history, capacity, count, found.history, 1)?;
            }
            outputs.write()?;
            if !report.is_null() {
                structs::write(report, report_size, &told);
            }
        }
        Ok(())
    }))
}

/// Writes what `shapeop_canalSmooth` minimises, for a strip with a frame at its first point.
///
/// # Safety
/// `guide` and `border` are null or readable for `3 * nb_points` doubles, `frame` for 6; `out` is null or writable for
/// one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalStripEnergy(
    guide: *const f64,
    border: *const f64,
    nb_points: c_int,
    frame: *const f64,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let strip = io::strip(guide, border, nb_points)?;
            outputs.must("out", out, vec![smoothing::energy(&strip, &io::frame("frame", frame)?)?])?;
        }
        outputs.write()
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_have_the_numbers_of_their_order() {
        let all =
            [Stop::Gradient, Stop::Decrease, Stop::Iterations, Stop::LineSearch, Stop::Cancelled, Stop::Infeasible];
        for (number, each) in all.into_iter().enumerate() {
            assert_eq!(stop(each) as usize, number);
        }
    }
}
