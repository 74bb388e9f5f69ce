//! How good strips are. Angles are in radians here, as everywhere in the C ABI.

use std::ffi::{c_char, c_int, c_uint};

use super::super::structs::{self, SizedStruct};
use super::super::{c_count, code, guard_free, shapeop_err};
use super::design::ShapeOpRuled;
use super::io::{self, Outputs, placed};
use super::{guard, shown};
use crate::error::Error;
use crate::geometry::ruled::report::{JointReport, Report, ReportOptions, StripReport};
use crate::geometry::ruled::trim::TrimOptions;

/// How strips are judged. Start from `shapeop_ruledDefaultReportOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_report_options {
    /// In: `sizeof(shapeop_ruled_report_options)`.
    pub struct_size: c_uint,
    /// Samples in each span along a strip, 1 to 1000. Default 4.
    pub samples_along: c_uint,
    /// Samples across a strip, its boundaries included, 2 to 1000. Default 5.
    pub samples_across: c_uint,
    /// Columns of triangles in each span of a trimmed strip, 1 to 1000. Default 4.
    pub columns_per_span: c_uint,
    /// A strip is too wide where its width is above this multiple of the least radius of curvature. Default 0.5.
    pub feature_ratio: f64,
    /// How far the line along which a strip is cut may be from the boundary of the mesh, over its diagonal; above 0, at
    /// most 0.01. Default 1e-7.
    pub trim_tolerance: f64,
}

/// What there is to say of all strips.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_report {
    /// In: `sizeof(shapeop_ruled_report)`.
    pub struct_size: c_uint,
    /// The number of strips.
    pub strip_count: c_uint,
    /// The number of pairs of neighbours.
    pub joint_count: c_uint,
    /// Strips that are too wide for the features of the mesh.
    pub too_wide_count: c_uint,
    /// The largest distance of the strips from the mesh, in model units; what is beyond its boundary does not count.
    pub largest_deviation: f64,
    /// The root mean square of it over the area.
    pub rms_deviation: f64,
    /// The largest distance of a point of the mesh from the nearest strip, in model units.
    pub largest_uncovered: f64,
    /// The root mean square of it over the area.
    pub rms_uncovered: f64,
    /// The area of the mesh.
    pub reference_area: f64,
    /// The area of all trimmed strips.
    pub trimmed_area: f64,
    /// The part of the mesh that some strip covers, 0 to 1, each of its spots counted once; known to about 0.001.
    pub coverage: f64,
    /// The largest gap between neighbours, in model units.
    pub largest_gap: f64,
    /// The mean gap.
    pub mean_gap: f64,
    /// The largest angle between tangent planes of neighbours along their boundary, in radians.
    pub largest_kink: f64,
    /// The mean angle.
    pub mean_kink: f64,
    /// The standard deviation of all widths over their mean.
    pub width_variation: f64,
    /// The part of the mesh that strips cover again: once for each strip but the first.
    pub overlap: f64,
}

/// What there is to say of one strip.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_strip_report {
    /// In: `sizeof(shapeop_ruled_strip_report)`.
    pub struct_size: c_uint,
    /// 1 if it is too wide for the features of the mesh.
    pub is_too_wide: c_int,
    /// The largest distance from the mesh, in model units.
    pub largest_deviation: f64,
    /// The sample that has it, x.
    pub at_x: f64,
    /// See `at_x`.
    pub at_y: f64,
    /// See `at_x`.
    pub at_z: f64,
    /// The root mean square over the area.
    pub rms_deviation: f64,
    /// The area of the whole strip.
    pub area: f64,
    /// The area of what is left when it is trimmed.
    pub trimmed_area: f64,
    /// The least width, in model units.
    pub least_width: f64,
    /// The mean width.
    pub mean_width: f64,
    /// The greatest width.
    pub greatest_width: f64,
    /// The standard deviation of its widths over their mean.
    pub width_variation: f64,
    /// The greatest width over the least radius of curvature there.
    pub width_over_feature: f64,
    /// That radius, in model units; 0 if nothing of the strip is left when it is trimmed.
    pub feature_size: f64,
}

/// What there is to say of two neighbours.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_joint_report {
    /// In: `sizeof(shapeop_ruled_joint_report)`.
    pub struct_size: c_uint,
    /// The strip whose second boundary it is.
    pub first: c_int,
    /// The strip whose first boundary it is.
    pub second: c_int,
    /// Samples of gaps; if 0, all gaps are 0 too.
    pub gap_count: c_uint,
    /// Samples of kinks.
    pub kink_count: c_uint,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// The largest gap, in model units.
    pub largest_gap: f64,
    /// The mean gap.
    pub mean_gap: f64,
    /// The sample with the largest gap, x.
    pub gap_x: f64,
    /// See `gap_x`.
    pub gap_y: f64,
    /// See `gap_x`.
    pub gap_z: f64,
    /// The largest angle between tangent planes, in radians: 0 where the strips go on smoothly.
    pub largest_kink: f64,
    /// The mean angle.
    pub mean_kink: f64,
    /// The sample with the largest angle, x.
    pub kink_x: f64,
    /// See `kink_x`.
    pub kink_y: f64,
    /// See `kink_x`.
    pub kink_z: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_report_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_report_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_report>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_strip_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_strip_report>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_joint_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_joint_report>()];
}

fn default_options() -> shapeop_ruled_report_options {
    let defaults = ReportOptions::default();
    shapeop_ruled_report_options {
        struct_size: 0,
        samples_along: io::field(defaults.samples_along),
        samples_across: io::field(defaults.samples_across),
        columns_per_span: io::field(defaults.trim.columns_per_span),
        feature_ratio: defaults.feature_ratio,
        trim_tolerance: defaults.trim.tolerance,
    }
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledDefaultReportOptions(options: *mut shapeop_ruled_report_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// The error with the names of C's arguments.
fn named(error: Error) -> Error {
    let names = [
        ("options.trim.tolerance", "options->trim_tolerance"),
        ("options.trim.", "options->"),
        ("options.", "options->"),
    ];
    placed(error, &names)
}

fn as_told(found: &Report) -> shapeop_ruled_report {
    shapeop_ruled_report {
        struct_size: 0,
        strip_count: io::field(found.strips.len()),
        joint_count: io::field(found.joints.len()),
        too_wide_count: io::field(found.too_wide.len()),
        largest_deviation: found.strips_to_reference.max,
        rms_deviation: found.strips_to_reference.rms,
        largest_uncovered: found.reference_to_strips.max,
        rms_uncovered: found.reference_to_strips.rms,
        reference_area: found.reference_area,
        trimmed_area: found.trimmed_area,
        coverage: found.coverage,
        largest_gap: found.max_gap,
        mean_gap: found.mean_gap,
        largest_kink: found.max_kink_deg.to_radians(),
        mean_kink: found.mean_kink_deg.to_radians(),
        width_variation: found.width_variation,
        overlap: found.overlap,
    }
}

/// Measures the strips against the mesh and each other: writes to `report`, whose `struct_size` must be set, what there
/// is to say of all, and keeps the rest for `shapeop_ruledStripReport`, `shapeop_ruledJointReport` and
/// `shapeop_ruledReportText`. `options` is null for the defaults.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is readable for so many bytes; `report` is null, or its
/// `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledReport(
    design: *mut ShapeOpRuled,
    options: *const shapeop_ruled_report_options,
    report: *mut shapeop_ruled_report,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for the structs; numbers are valid for any bytes.
        let told = unsafe {
            structs::size("report", report)?;
            io::told("options", options, default_options())?
        };
        let options = ReportOptions {
            samples_along: told.samples_along as usize,
            samples_across: told.samples_across as usize,
            feature_ratio: told.feature_ratio,
            trim: TrimOptions { tolerance: told.trim_tolerance, columns_per_span: told.columns_per_span as usize },
            ..ReportOptions::default()
        };
        let told = as_told(draft.judge(&options).map_err(named)?);
        let numbers = [told.largest_deviation, told.rms_deviation, told.largest_uncovered, told.rms_uncovered];
        let areas = [told.reference_area, told.trimmed_area, told.coverage, told.overlap, told.width_variation];
        let joints = [told.largest_gap, told.mean_gap, told.largest_kink, told.mean_kink];
        // SAFETY: the caller vouches for so many bytes.
        unsafe { io::tell("report", report, &told, &[&numbers[..], &areas, &joints].concat()) }
    }))
}

/// Writes what the last report says of a strip to `report`, whose `struct_size` must be set. Refused if strips changed
/// since (`SO_NOT_INITIALISED`).
///
/// # Safety
/// `report` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledStripReport(
    design: *mut ShapeOpRuled,
    strip: c_int,
    report: *mut shapeop_ruled_strip_report,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = &draft.report()?.strips;
        let StripReport { deviation, area, trimmed_area, widths, width_over_feature, feature_size, is_too_wide } =
            all[io::index("strip", strip, all.len())?];
        let told = shapeop_ruled_strip_report {
            struct_size: 0,
            is_too_wide: c_int::from(is_too_wide),
            largest_deviation: deviation.max,
            at_x: deviation.at[0],
            at_y: deviation.at[1],
            at_z: deviation.at[2],
            rms_deviation: deviation.rms,
            area,
            trimmed_area,
            least_width: widths.min,
            mean_width: widths.mean,
            greatest_width: widths.max,
            width_variation: widths.variation,
            width_over_feature,
            feature_size,
        };
        let lengths = [deviation.max, deviation.rms, widths.min, widths.mean, widths.max];
        let numbers =
            [&lengths[..], &[widths.variation, area, trimmed_area, width_over_feature, feature_size]].concat();
        // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
        unsafe { io::tell("report", report, &told, &numbers) }
    }))
}

/// Writes what the last report says of a pair of neighbours, numbered as by `shapeop_ruledJoints`, to `report`, whose
/// `struct_size` must be set. Refused if strips changed since (`SO_NOT_INITIALISED`).
///
/// # Safety
/// `report` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledJointReport(
    design: *mut ShapeOpRuled,
    joint: c_int,
    report: *mut shapeop_ruled_joint_report,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = &draft.report()?.joints;
        let found: JointReport = all[io::index("joint", joint, all.len())?];
        let told = shapeop_ruled_joint_report {
            struct_size: 0,
            first: c_count(found.strips[0])?,
            second: c_count(found.strips[1])?,
            gap_count: io::field(found.gap_count),
            kink_count: io::field(found.kink_count),
            reserved: 0,
            largest_gap: found.max_gap,
            mean_gap: found.mean_gap,
            gap_x: found.max_gap_at[0],
            gap_y: found.max_gap_at[1],
            gap_z: found.max_gap_at[2],
            largest_kink: found.max_kink_deg.to_radians(),
            mean_kink: found.mean_kink_deg.to_radians(),
            kink_x: found.max_kink_at[0],
            kink_y: found.max_kink_at[1],
            kink_z: found.max_kink_at[2],
        };
        let numbers = [found.max_gap, found.mean_gap, found.max_kink_deg, found.mean_kink_deg];
        // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
        unsafe { io::tell("report", report, &told, &numbers) }
    }))
}

/// Writes the strips that the last report calls too wide for the features of the mesh if there is room for `capacity`
/// of them, and their number to `count`.
///
/// # Safety
/// `strips` is null or writable for `capacity` ints, `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledTooWide(
    design: *mut ShapeOpRuled,
    strips: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = io::ints(draft.report()?.too_wide.iter().copied())?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("strips", strips, capacity, count, all, 1)? };
        outputs.write()
    }))
}

/// The JSON form of the last report (`docs/ruled-report.schema.json`), in which angles are in degrees; null if it is
/// refused. The text is valid as long
/// as that of `shapeop_ruledStripsText`.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledReportText(design: *mut ShapeOpRuled) -> *const c_char {
    shown(design, |draft| draft.report_json())
}
