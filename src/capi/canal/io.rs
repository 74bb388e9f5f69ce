//! From C arrays to what the geometry takes, and back: inputs are checked first, outputs are written last, all or none.

use std::ffi::{c_int, c_void};
use std::ops::ControlFlow;

use glam::DVec3;

use super::super::arguments::{self, length, slice};
pub(super) use super::super::arguments::{
    coordinates, finite_vector as vector, index, numbers, optional_vector, points, renamed, truth,
};
pub(super) use super::super::outputs::Outputs;
use super::smoothing::{shapeop_canal_progress, shapeop_canal_progress_callback};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::closing;
use crate::geometry::canal::frame::Frame;
use crate::geometry::canal::strip::Strip;
use crate::mesh::curve::Spline;
use crate::mesh::fit::Circle;
use crate::mesh::{Grid, Mesh};

/// The largest difference of a frame's tangents from unit vectors that are orthogonal.
pub(super) const SLACK: f64 = 1e-9;

/// The most points of a net that is made here: more would exhaust a machine.
const MOST_POINTS: usize = 1 << 22;

/// A number of points, rows or columns of a net that has `factor` times as many points.
pub(super) fn size(name: &str, value: c_int, factor: usize) -> Result<usize> {
    let count = length(name, value)?;
    if count.checked_mul(factor).is_some_and(|points| points <= MOST_POINTS) {
        return Ok(count);
    }
    let reason = format!("expected a net of at most {MOST_POINTS} points, found {value} times {factor}");
    Err(Error::new(Status::TooLarge, reason).at(name))
}

/// Which directions wrap, as bits.
pub(super) fn wraps(value: c_int) -> Result<[bool; 2]> {
    match value {
        0..=3 => Ok([value & 1 == 1, value & 2 == 2]),
        _ => {
            let reason = format!("expected SHAPEOP_WRAPS_ROWS, SHAPEOP_WRAPS_COLUMNS, both or 0; found {value}");
            Err(Error::new(Status::InvalidValue, reason).at("wraps"))
        }
    }
}

/// A grid as a C caller states it.
///
/// # Safety
/// `data` is null or readable for `3 * rows * columns` doubles.
pub(super) unsafe fn grid(data: *const f64, rows: c_int, columns: c_int, wrap_bits: c_int) -> Result<Grid> {
    let wraps = wraps(wrap_bits)?;
    let (row_count, column_count) = (length("rows", rows)?, length("columns", columns)?);
    let count = row_count.checked_mul(column_count).and_then(|count| c_int::try_from(count).ok());
    let too_large = || Error::new(Status::TooLarge, format!("{rows} by {columns} points do not fit an int")).at("rows");
    // SAFETY: the caller vouches for the array.
    let points = unsafe { points("points", data, "rows", count.ok_or_else(too_large)?)? };
    Grid::new(points, row_count, column_count, wraps)
}

/// A mesh of quads.
///
/// # Safety
/// Each array is null or readable for its number of values.
pub(super) unsafe fn quads(data: *const f64, nb_points: c_int, quads: *const c_int, nb_quads: c_int) -> Result<Mesh> {
    // SAFETY: the caller vouches for the arrays.
    let points = unsafe { points("points", data, "nb_points", nb_points)? };
    let too_large = || Error::new(Status::TooLarge, format!("{nb_quads} quads do not fit the memory")).at("nb_quads");
    let count = length("nb_quads", nb_quads)?.checked_mul(4).ok_or_else(too_large)?;
    // SAFETY: the caller vouches for the array.
    let indices = unsafe { slice("quads", quads, count)? };
    let faces = arguments::faces("nb_quads", indices, &[4], points.len())?;
    Ok(Mesh { points, faces })
}

/// The frame of two tangents.
///
/// # Safety
/// `data` is null or readable for 6 doubles.
pub(super) unsafe fn frame(name: &str, data: *const f64) -> Result<Frame> {
    // SAFETY: the caller vouches for 6 doubles.
    let values = unsafe { slice(name, data, 6)? };
    let (t1, t2) = (DVec3::from_slice(&values[..3]), DVec3::from_slice(&values[3..]));
    let error = (t1.length() - 1.0).abs().max((t2.length() - 1.0).abs()).max(t1.dot(t2).abs());
    // Not `error > SLACK`: what is not a number is refused too.
    if !(error <= SLACK) {
        let reason = format!("expected two unit vectors that are orthogonal, found {t1} and {t2}");
        return Err(Error::new(Status::InvalidValue, reason).at(name));
    }
    let t1 = t1.normalize();
    let t2 = t2.reject_from_normalized(t1).normalize();
    Ok(Frame { t1, t2, normal: t1.cross(t2) })
}

pub(super) fn frame_numbers(frames: &[Frame]) -> Vec<f64> {
    frames.iter().flat_map(|frame| [frame.t1, frame.t2, frame.normal]).flat_map(|vector| vector.to_array()).collect()
}

/// Circles, each its center, its normal and its radius.
///
/// # Safety
/// `data` is null or readable for `7 * count` doubles.
pub(super) unsafe fn circles(name: &str, data: *const f64, count: usize) -> Result<Vec<Circle>> {
    let too_large = || Error::new(Status::TooLarge, format!("{count} circles do not fit the memory")).at(name);
    // SAFETY: the caller vouches for the array.
    let values = unsafe { slice(name, data, count.checked_mul(7).ok_or_else(too_large)?)? };
    let one = |(i, values): (usize, &[f64])| {
        let (center, normal) = (DVec3::from_slice(&values[..3]), DVec3::from_slice(&values[3..6]));
        let is_circle = center.is_finite() && (normal.length() - 1.0).abs() <= SLACK && values[6] > 0.0;
        if is_circle && values[6].is_finite() {
            return Ok(Circle { center, normal, radius: values[6] });
        }
        let reason = "expected a center, a unit vector along the axis and a radius above 0";
        let place = if count == 1 { name.to_owned() } else { format!("{name}[{i}]") };
        Err(Error::new(Status::InvalidValue, format!("{reason}; found {values:?}")).at(place))
    };
    values.chunks_exact(7).enumerate().map(one).collect()
}

/// # Safety
/// `data` is null or readable for 7 doubles.
pub(super) unsafe fn circle(name: &str, data: *const f64) -> Result<Circle> {
    // SAFETY: the caller vouches for 7 doubles.
    Ok(unsafe { circles(name, data, 1)? }[0])
}

pub(super) fn circle_numbers(circles: &[Circle]) -> Vec<f64> {
    let one = |circle: &Circle| [&circle.center.to_array()[..], &circle.normal.to_array(), &[circle.radius]].concat();
    circles.iter().flat_map(one).collect()
}

/// The spline through points; the place of an error is in `name`.
///
/// # Safety
/// `data` is null or readable for `3 * count` doubles.
pub(super) unsafe fn spline(
    name: &str,
    data: *const f64,
    count_name: &str,
    count: c_int,
    is_closed: bool,
) -> Result<Spline> {
    // SAFETY: the caller vouches for the array.
    let points = unsafe { points(name, data, count_name, count)? };
    Spline::through(&points, is_closed).map_err(|error| renamed(error, "points", name))
}

/// A strip of points on both sides.
///
/// # Safety
/// Both arrays are null or readable for `3 * count` doubles.
pub(super) unsafe fn strip(guide: *const f64, border: *const f64, count: c_int) -> Result<Strip> {
    // SAFETY: the caller vouches for the arrays.
    let (guide, border) =
        unsafe { (points("guide", guide, "nb_points", count)?, points("border", border, "nb_points", count)?) };
    crate::mesh::grid::check_finite("guide", &guide)?;
    crate::mesh::grid::check_finite("border", &border)?;
    let lengths = guide.iter().zip(&border).map(|(p, q)| p.distance(*q)).collect();
    Ok(Strip {
        guide,
        border,
        lengths,
        attainable: Vec::new(),
        flipped: Vec::new(),
        projected: Vec::new(),
        deviation: 0.0,
    })
}

/// 1 for every listed index below `count`, else 0.
pub(super) fn marks(indices: &[usize], count: usize) -> Vec<c_int> {
    (0..count).map(|i| c_int::from(indices.contains(&i))).collect()
}

pub(super) fn case_number(case: closing::Case) -> c_int {
    match case {
        closing::Case::OneSphere => 1,
        closing::Case::TwoSpheres => 2,
    }
}

/// Calls a caller's progress function, if there is one.
pub(super) fn call_back(
    progress: shapeop_canal_progress_callback,
    user: *mut c_void,
    told: &shapeop_canal_progress,
) -> ControlFlow<()> {
    let Some(progress) = progress else { return ControlFlow::Continue(()) };
    // SAFETY: the caller of the C function vouches for the function; `told` lives until it returns.
    match unsafe { progress(told, user) } {
        0 => ControlFlow::Continue(()),
        _ => ControlFlow::Break(()),
    }
}
