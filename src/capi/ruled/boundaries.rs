//! Strip boundaries as plane sections, along great circles, or as drawn; what boundaries there are.

use std::ffi::{c_int, c_uint};

use glam::DVec3;

use super::super::arguments::{check_pointer, length, slice};
use super::super::structs::{self, SizedStruct};
use super::super::{c_count, code, guard_free, number, shapeop_err};
use super::design::ShapeOpRuled;
use super::guard;
use super::io::{self, Outputs, placed};
use crate::error::{Error, Result, Status};
use crate::geometry::ruled::Axis;
use crate::geometry::ruled::boundaries::{BoundaryOptions, Drawn};
use crate::geometry::ruled::great_circles::great_circle;
use crate::geometry::ruled::planar_boundaries::{PlanarOptions, Plane};

/// What is done to strip boundaries. Start from `shapeop_ruledDefaultBoundaryOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_boundary_options {
    /// In: `sizeof(shapeop_ruled_boundary_options)`.
    pub struct_size: c_uint,
    /// 1: open ends are extended beyond the surface, so that strips cover it up to the rim. Default 1.
    pub extends: c_int,
    /// 1: there is a boundary beyond the surface before the first and after the last. Default 1; drawn boundaries have
    /// none.
    pub overshoots: c_int,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// Level curves shorter than so many strip widths are dropped, unless that leaves none. Default 2.
    pub least_length: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_boundary_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_boundary_options>()];
}

impl Default for shapeop_ruled_boundary_options {
    fn default() -> Self {
        let BoundaryOptions { extends, overshoots, least_length } = BoundaryOptions::default();
        let (extends, overshoots) = (c_int::from(extends), c_int::from(overshoots));
        Self { struct_size: 0, extends, overshoots, reserved: 0, least_length }
    }
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledDefaultBoundaryOptions(
    options: *mut shapeop_ruled_boundary_options,
) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &shapeop_ruled_boundary_options::default()) }))
}

/// The plane of four numbers.
fn plane(numbers: &[f64]) -> Plane {
    Plane { normal: DVec3::from_slice(numbers), offset: numbers[3] }
}

/// The error with the names of C's arguments.
fn named(error: Error) -> Error {
    let names = [
        ("options.least_length", "boundaries->least_length"),
        ("options.least_angle_rad", "least_angle"),
        ("field", "design"),
    ];
    placed(error, &names)
}

/// Takes plane sections as strip boundaries: for each plane the longest. `planes` has four numbers for each of
/// `nb_planes`, the normal and the offset of `normal . x = offset`; they follow each other along the field, or against
/// it. Sections should cross the field at `least_angle` or more, in radians (15 degrees are good): with
/// `refuses_oblique` 1 those that do not are refused (`SO_INFEASIBLE`). The least angle of each is written to `angles`,
/// which may be null. `boundaries` is null for the defaults. Takes back boundaries and strips.
///
/// # Safety
/// `planes` is null or readable for `4 * nb_planes` doubles, `angles` is null or writable for `nb_planes`. `boundaries`
/// is null, or its `struct_size` is set and it is readable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledSetPlanarBoundaries(
    design: *mut ShapeOpRuled,
    planes: *const f64,
    nb_planes: c_int,
    least_angle: f64,
    refuses_oblique: c_int,
    boundaries: *const shapeop_ruled_boundary_options,
    angles: *mut f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        let count = length("nb_planes", nb_planes)?;
        let too_large =
            || Error::new(Status::TooLarge, format!("{count} planes do not fit the memory")).at("nb_planes");
        // SAFETY: the caller vouches for the array and the struct; numbers are valid for any bytes.
        let (planes, boundaries) = unsafe {
            let numbers = slice("planes", planes, count.checked_mul(4).ok_or_else(too_large)?)?;
            (numbers.chunks_exact(4).map(plane).collect::<Vec<_>>(), io::boundary_options(boundaries)?)
        };
        if !angles.is_null() {
            check_pointer("angles", angles.cast_const(), count)?;
        }
        let refuses_oblique = io::truth("refuses_oblique", refuses_oblique)?;
        let options = PlanarOptions { boundaries, least_angle_rad: least_angle, refuses_oblique };
        let found = draft.step(|design| design.set_planar_boundaries(&planes, &options)).map_err(named)?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the output.
        unsafe { outputs.may("angles", angles, found)? };
        outputs.write()
    }))
}

/// Takes the curves as strip boundaries along which the field is orthogonal to one of `nb_axes` vectors each, of any
/// length above 0: rulings that begin there are parallel to a plane. They follow each other along the field, or against
/// it. `boundaries` is null for the defaults. Takes back boundaries and strips.
///
/// # Safety
/// `axes` is null or readable for `3 * nb_axes` doubles. `boundaries` is null, or its `struct_size` is set and it is
/// readable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledSetGreatCircleBoundaries(
    design: *mut ShapeOpRuled,
    axes: *const f64,
    nb_axes: c_int,
    boundaries: *const shapeop_ruled_boundary_options,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for the array and the struct; numbers are valid for any bytes.
        let (axes, options) =
            unsafe { (io::points("axes", axes, "nb_axes", nb_axes)?, io::boundary_options(boundaries)?) };
        let made = draft.step(|design| design.set_great_circle_boundaries(&axes, &options));
        // The axes are checked one by one.
        made.map_err(|error| named(placed(error, &[("axis", "axes")])))
    }))
}

/// Writes the curves on the mesh along which the field is orthogonal to `axis`, of any length above 0: the points of
/// all behind each other if there is room for `capacity` of them, and the number of points of each to `lengths` if
/// there is room for `curve_capacity` of them; a closed one has its first point again at its end. `count` and
/// `curve_count` tell how many there are.
///
/// # Safety
/// `axis` is null or readable for 3 doubles; `points` is null or writable for `3 * capacity` doubles, `lengths` for
/// `curve_capacity` ints, `count` and `curve_count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledGreatCircle(
    design: *mut ShapeOpRuled,
    axis: *const f64,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    lengths: *mut c_int,
    curve_capacity: c_int,
    curve_count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for 3 doubles.
        let axis = unsafe { io::vector("axis", axis)? };
        let curves = great_circle(draft.design().mesh(), draft.design().field(), axis).map_err(named)?;
        let positions = curves.iter().map(|curve| {
            let mut positions = curve.positions();
            positions.extend(positions.first().copied().filter(|_| curve.is_closed));
            positions
        });
        let positions: Vec<Vec<DVec3>> = positions.collect();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.sized("points", points, capacity, count, io::coordinates(&positions.concat()), 3)?;
            let own = io::ints(positions.iter().map(Vec::len))?;
            outputs.sized_as(
                ["lengths", "curve_capacity", "curve_count"],
                lengths,
                curve_capacity,
                curve_count,
                own,
                1,
            )?;
        }
        outputs.write()
    }))
}

/// Takes curves drawn by hand as strip boundaries, in their order along the field. Their points are moved to the
/// nearest of the mesh, and curves are turned around if need be.
///
/// - `points`: the points of all curves behind each other, `nb_points` in all.
/// - `counts`: the number of points of each curve, `nb_counts` in all.
/// - `is_closed`: 1 for each curve whose last point is followed by its first, else 0; null if none is.
/// - `boundaries`: null for the defaults.
///
/// Takes back boundaries and strips.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles, `counts` and `is_closed` for `nb_counts` ints.
/// `boundaries` is null, or its `struct_size` is set and it is readable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledSetDrawnBoundaries(
    design: *mut ShapeOpRuled,
    points: *const f64,
    nb_points: c_int,
    counts: *const c_int,
    nb_counts: c_int,
    is_closed: *const c_int,
    boundaries: *const shapeop_ruled_boundary_options,
) -> shapeop_err {
    code(guard(design, |draft| {
        let curve_count = length("nb_counts", nb_counts)?;
        // SAFETY: the caller vouches for the arrays and the struct; numbers are valid for any bytes.
        let (points, counts, closed, options) = unsafe {
            let closed = if is_closed.is_null() { &[] } else { slice("is_closed", is_closed, curve_count)? };
            let points = io::points("points", points, "nb_points", nb_points)?;
            (points, slice("counts", counts, curve_count)?, closed, io::boundary_options(boundaries)?)
        };
        let curves = curves(&points, counts, closed)?;
        draft.step(|design| design.set_drawn_boundaries(&curves, &options)).map_err(named)
    }))
}

fn curves(points: &[DVec3], counts: &[c_int], is_closed: &[c_int]) -> Result<Vec<Drawn>> {
    let mut rest = points;
    let mut curves = Vec::with_capacity(counts.len());
    for (k, &count) in counts.iter().enumerate() {
        let place = format!("counts[{k}]");
        let count = length(&place, count)?;
        let Some((own, behind)) = rest.split_at_checked(count) else {
            let reason = format!("expected at most the {} points that are left, found {count}", rest.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at(place));
        };
        rest = behind;
        let is_closed = is_closed.get(k).map_or(Ok(false), |&value| io::truth(&format!("is_closed[{k}]"), value))?;
        curves.push(Drawn { points: own.to_vec(), is_closed });
    }
    if rest.is_empty() {
        return Ok(curves);
    }
    let used = points.len() - rest.len();
    let reason = format!("expected {used}, to which the counts add up; found {}", points.len());
    Err(Error::new(Status::InvalidArgumentLength, reason).at("nb_points"))
}

/// The number of strip boundaries, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledBoundaryCount(design: *mut ShapeOpRuled) -> c_int {
    number(guard(design, |draft| c_count(draft.design().boundaries().boundaries.len())))
}

/// Writes the points of a boundary if there is room for `capacity` of them, and their number to `count`; to `is_closed`
/// 1 if the last point is followed by the first, and to `level` the value of the level function, or the number of the
/// plane, the axis or the curve. The last two may be null.
///
/// # Safety
/// `points` is null or writable for `3 * capacity` doubles, `count` and `is_closed` for one int, `level` for one
/// double.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledBoundary(
    design: *mut ShapeOpRuled,
    boundary: c_int,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    is_closed: *mut c_int,
    level: *mut f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = &draft.design().boundaries().boundaries;
        let found = &all[io::index("boundary", boundary, all.len())?];
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.sized("points", points, capacity, count, io::coordinates(&found.points), 3)?;
            outputs.may("is_closed", is_closed, vec![c_int::from(found.is_closed)])?;
            outputs.may("level", level, vec![found.level])?;
        }
        outputs.write()
    }))
}

/// Writes the unit vector that the field along a boundary is most nearly orthogonal to (`axis`), and the root mean
/// square of the sine by which it is off (`error`): 0 where rulings that begin on the boundary are parallel to a plane.
/// Either may be null.
///
/// # Safety
/// `axis` is null or writable for 3 doubles, `error` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledBoundaryAxis(
    design: *mut ShapeOpRuled,
    boundary: c_int,
    axis: *mut f64,
    error: *mut f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = &draft.design().boundaries().boundaries;
        let found = &all[io::index("boundary", boundary, all.len())?];
        let points: Vec<_> = found.on_surface.iter().flatten().copied().collect();
        let found = Axis::of_points(draft.design().mesh(), draft.design().field(), &points).ok_or_else(|| {
            Error::new(Status::Degenerate, "the field is not known along the boundary").at("boundary")
        })?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.may("axis", axis, io::coordinates(&[found.direction]))?;
            outputs.may("error", error, vec![found.error])?;
        }
        outputs.write()
    }))
}

/// Writes the two boundaries of each strip, before there are strips too, if there is room for `capacity` pairs, and
/// their number to `count`.
///
/// # Safety
/// `pairs` is null or writable for `2 * capacity` ints, `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledBoundaryPairs(
    design: *mut ShapeOpRuled,
    pairs: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = io::ints(draft.design().boundaries().strips.iter().flatten().copied())?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("pairs", pairs, capacity, count, all, 2)? };
        outputs.write()
    }))
}

/// Writes the levels between which and the next one curves split, join or end, so that no strip is there, if there is
/// room for `capacity` of them, and their number to `count`.
///
/// # Safety
/// `levels` is null or writable for `capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledUnmatchedLevels(
    design: *mut ShapeOpRuled,
    levels: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = draft.design().boundaries().unmatched.clone();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("levels", levels, capacity, count, all, 1)? };
        outputs.write()
    }))
}

/// Writes the curves that were too short to be boundaries if there is room for `capacity` of them, and their number to
/// `count`: the level of each and its length, in model units. Either may be null.
///
/// # Safety
/// `levels` and `lengths` are null or writable for `capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledDroppedCurves(
    design: *mut ShapeOpRuled,
    levels: *mut f64,
    lengths: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let dropped = &draft.design().boundaries().dropped;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            if outputs.room(capacity, count, dropped.len())? {
                outputs.may("levels", levels, dropped.iter().map(|curve| curve.level).collect())?;
                outputs.may("lengths", lengths, dropped.iter().map(|curve| curve.length).collect())?;
            }
        }
        outputs.write()
    }))
}
