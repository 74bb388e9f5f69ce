//! Circular strips along a guide, and how they close.

use std::ffi::{c_int, c_uint};

use super::super::{c_count, code, guard_free, shapeop_err};
use super::io::{self, Outputs};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::closing;
use crate::geometry::canal::strip::{self, Strip};
use crate::geometry::canal::strip_of_circles;

/// A bit of the flags of `shapeop_canalStrip`: quads that cross themselves are refused.
pub const SHAPEOP_STRIP_STRICT: c_uint = 1;

/// A bit of the flags of `shapeop_canalStrip`: a length that is not attainable is replaced by the nearest that is.
pub const SHAPEOP_STRIP_PROJECT_LENGTHS: c_uint = 2;

/// A bit of the flags of `shapeop_canalStrip`: the first crossing edge is turned to where the lengths can go on.
pub const SHAPEOP_STRIP_FIT_START: c_uint = 4;

fn options(flags: c_uint) -> Result<strip::Options> {
    let all = SHAPEOP_STRIP_STRICT | SHAPEOP_STRIP_PROJECT_LENGTHS | SHAPEOP_STRIP_FIT_START;
    if flags & !all != 0 {
        let reason = format!("expected bits SHAPEOP_STRIP_..., {all} at most; found {flags}");
        return Err(Error::new(Status::InvalidValue, reason).at("flags"));
    }
    let has = |bit| flags & bit != 0;
    Ok(strip::Options {
        is_strict: has(SHAPEOP_STRIP_STRICT),
        projects_lengths: has(SHAPEOP_STRIP_PROJECT_LENGTHS),
        fits_start: has(SHAPEOP_STRIP_FIT_START),
    })
}

/// Where a strip goes; all but `border` may be null.
struct Told {
    border: *mut f64,
    lengths: *mut f64,
    attainable: *mut f64,
    is_flipped: *mut c_int,
    is_projected: *mut c_int,
    deviation: *mut f64,
}

/// # Safety
/// Each is null or writable for its number of values.
unsafe fn tell(strip: Strip, told: &Told) -> Result<()> {
    let count = strip.guide.len();
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for the outputs.
    unsafe {
        outputs.must("border", told.border, io::coordinates(&strip.border))?;
        outputs.may("out_lengths", told.lengths, strip.lengths)?;
        outputs.may("attainable", told.attainable, strip.attainable)?;
        outputs.may("is_flipped", told.is_flipped, io::marks(&strip.flipped, count.saturating_sub(1)))?;
        outputs.may("is_projected", told.is_projected, io::marks(&strip.projected, count))?;
        outputs.may("deviation", told.deviation, vec![strip.deviation])?;
    }
    outputs.write()
}

/// Writes the border of the strip of circular quads along `points` that begins at `start` and whose crossing edges have
/// the given lengths, in model units, one for each point. Not every sequence of lengths is attainable: `flags` has bits
/// `SHAPEOP_STRIP_...`; without them a refusal says what is attainable, and the message has the quad.
///
/// All outputs but `border` may be null: the lengths that were made, the largest attainable length at the end of each
/// quad, whether each quad crosses itself, whether each length was replaced, and the largest difference of a length
/// from that asked for.
///
/// # Safety
/// `points` is null or readable, `border` null or writable, for `3 * nb_points` doubles; `start` is readable for 3.
/// `lengths`, `out_lengths` and `is_projected` have `nb_points` values, `attainable` and `is_flipped` one fewer,
/// `deviation` one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalStrip(
    points: *const f64,
    nb_points: c_int,
    start: *const f64,
    lengths: *const f64,
    flags: c_uint,
    border: *mut f64,
    out_lengths: *mut f64,
    attainable: *mut f64,
    is_flipped: *mut c_int,
    is_projected: *mut c_int,
    deviation: *mut f64,
) -> shapeop_err {
    // SAFETY: the caller vouches for the arrays.
    code(guard_free(|| unsafe {
        let (options, start) = (options(flags)?, io::vector("start", start)?);
        let guide = io::points("points", points, "nb_points", nb_points)?;
        let lengths = io::numbers("lengths", lengths, "nb_points", nb_points)?;
        let made = strip::of_lengths(&guide, start, &lengths, &options)?;
        tell(made, &Told { border, lengths: out_lengths, attainable, is_flipped, is_projected, deviation })
    }))
}

/// As `shapeop_canalStrip`, from the radius of each quad's circle, one fewer than points. `start` says in which
/// direction the first crossing edge goes. With `flags` `SHAPEOP_STRIP_STRICT` quads that cross themselves are refused.
///
/// # Safety
/// As `shapeop_canalStrip`; `radii` is null or readable for `nb_points - 1` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalStripOfRadii(
    points: *const f64,
    nb_points: c_int,
    start: *const f64,
    radii: *const f64,
    flags: c_uint,
    border: *mut f64,
    out_lengths: *mut f64,
    is_flipped: *mut c_int,
) -> shapeop_err {
    // SAFETY: the caller vouches for the arrays.
    code(guard_free(|| unsafe {
        if flags & !SHAPEOP_STRIP_STRICT != 0 {
            let reason = format!("expected SHAPEOP_STRIP_STRICT or 0, found {flags}");
            return Err(Error::new(Status::InvalidValue, reason).at("flags"));
        }
        let guide = io::points("points", points, "nb_points", nb_points)?;
        let radii = io::numbers("radii", radii, "nb_points", (nb_points - 1).max(0))?;
        let made = strip::of_radii(&guide, io::vector("start", start)?, &radii, flags != 0)?;
        let none = std::ptr::null_mut();
        let is_projected = std::ptr::null_mut();
        tell(made, &Told { border, lengths: out_lengths, attainable: none, is_flipped, is_projected, deviation: none })
    }))
}

/// As `shapeop_canalStrip`, from the lengths of the border's edges, one fewer than points. They are attainable from any
/// angle.
///
/// # Safety
/// As `shapeop_canalStrip`; `edges` is null or readable for `nb_points - 1` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalStripOfBorderEdges(
    points: *const f64,
    nb_points: c_int,
    start: *const f64,
    edges: *const f64,
    border: *mut f64,
    out_lengths: *mut f64,
    is_flipped: *mut c_int,
) -> shapeop_err {
    // SAFETY: the caller vouches for the arrays.
    code(guard_free(|| unsafe {
        let guide = io::points("points", points, "nb_points", nb_points)?;
        let edges = io::numbers("edges", edges, "nb_points", (nb_points - 1).max(0))?;
        let made = strip::of_border_edges(&guide, io::vector("start", start)?, &edges)?;
        let none = std::ptr::null_mut();
        let is_projected = std::ptr::null_mut();
        tell(made, &Told { border, lengths: out_lengths, attainable: none, is_flipped, is_projected, deviation: none })
    }))
}

/// Writes lengths of crossing edges, one for each point, that go from `first` to `last` evenly along the polyline.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles, `out` is null or writable for `nb_points`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalLengthsBetween(
    points: *const f64,
    nb_points: c_int,
    first: f64,
    last: f64,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let points = io::points("points", points, "nb_points", nb_points)?;
            outputs.must("out", out, strip::lengths_between(&points, first, last)?)?;
        }
        outputs.write()
    }))
}

/// Writes the lengths of the edges of a border that is `length` long in all, one fewer than points, each in the
/// proportion of the guide's edge.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles, `out` is null or writable for `nb_points - 1`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalEdgesOfBorder(
    points: *const f64,
    nb_points: c_int,
    length: f64,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let points = io::points("points", points, "nb_points", nb_points)?;
            outputs.must("out", out, strip::edges_of_border(&points, length)?)?;
        }
        outputs.write()
    }))
}

/// Writes the circle of each quad of a strip: its center, the unit vector along its axis and its radius, 7 doubles; one
/// fewer than points on either side.
///
/// # Safety
/// `guide` and `border` are null or readable for `3 * nb_points` doubles, `out` is null or writable for `7 * (nb_points
/// - 1)`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalStripCircles(
    guide: *const f64,
    border: *const f64,
    nb_points: c_int,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let circles = io::strip(guide, border, nb_points)?.circles()?;
            outputs.must("out", out, io::circle_numbers(&circles))?;
        }
        outputs.write()
    }))
}

/// Writes the strip whose quads have the given circles, two or more, of which consecutive ones meet in two points:
/// `nb_circles + 1` points on either side. The first crossing edge goes through the point of the first circle nearest
/// to `start`, the last one through that of the last circle nearest to `end`; either may be null. `distance`, which may
/// be null, is the largest distance of a point from a circle that it should be on.
///
/// # Safety
/// `circles` is null or readable for `7 * nb_circles` doubles, `start` and `end` are null or readable for 3; `guide`
/// and `border` are null or writable for `3 * (nb_circles + 1)`, `distance` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalStripOfCircles(
    circles: *const f64,
    nb_circles: c_int,
    start: *const f64,
    end: *const f64,
    guide: *mut f64,
    border: *mut f64,
    distance: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let count = super::super::arguments::length("nb_circles", nb_circles)?;
            let circles = io::circles("circles", circles, count)?;
            let (start, end) = (io::optional_vector("start", start)?, io::optional_vector("end", end)?);
            let made = strip_of_circles::from_circles(&circles, start, end)?;
            outputs.must("guide", guide, io::coordinates(&made.strip.guide))?;
            outputs.must("border", border, io::coordinates(&made.strip.border))?;
            outputs.may("distance", distance, vec![made.distance])?;
        }
        outputs.write()
    }))
}

/// Tells how a frame comes back around a closed polygon, whose last point may repeat the first. Each output may be
/// null: the product of the reflections, 9 doubles column by column; how far it is from what a smooth surface needs;
/// whether that is round-off; for an odd number of edges the first tangent that the frame must have (zero for an even
/// number, where it is free).
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles; `matrix` is null or writable for 9 doubles, `tangent` for
/// 3, `residual` and `closes` for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalHolonomy(
    points: *const f64,
    nb_points: c_int,
    matrix: *mut f64,
    residual: *mut f64,
    closes: *mut c_int,
    tangent: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let found = closing::holonomy(&io::points("points", points, "nb_points", nb_points)?)?;
            outputs.may("matrix", matrix, found.matrix.to_cols_array().to_vec())?;
            outputs.may("residual", residual, vec![found.residual])?;
            outputs.may("closes", closes, vec![c_int::from(found.closes)])?;
            outputs.may("tangent", tangent, found.tangent.unwrap_or_default().to_array().to_vec())?;
        }
        outputs.write()
    }))
}

/// Writes the frame at the first point of a closed polygon with which the surface is smooth across the seam and that is
/// nearest to `wish`, the unit tangents `t1` and `t2`; 9 doubles. Refused with `SO_NOT_CLOSED` where there is none.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles, `wish` for 6; `out` is null or writable for 9.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalClosedFrame(
    points: *const f64,
    nb_points: c_int,
    wish: *const f64,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let points = io::points("points", points, "nb_points", nb_points)?;
            let frame = closing::closed_frame(&points, &io::frame("wish", wish)?)?;
            outputs.must("out", out, io::frame_numbers(&[frame]))?;
        }
        outputs.write()
    }))
}

/// Writes the closed polygon inscribed in a sphere about the origin whose edges are parallel to those of a closed
/// polygon and nearest to them in length, if there is room for `capacity` points, and their number to `count`: 0 if
/// there is none, as the polygon is not pseudo-spherical. `reversed_count`, which may be null, is the number of its
/// edges that point the other way.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles; `out` is null or writable for `3 * capacity` doubles,
/// `count` and `reversed_count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalParallelOnSphere(
    points: *const f64,
    nb_points: c_int,
    out: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    reversed_count: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let found = closing::parallel_on_sphere(&io::points("points", points, "nb_points", nb_points)?)?;
            let (ring, reversed) = found.map_or((Vec::new(), 0), |found| (found.points, found.reversed_count));
            outputs.sized("out", out, capacity, count, io::coordinates(&ring), 3)?;
            outputs.may("reversed_count", reversed_count, vec![c_count(reversed)?])?;
        }
        outputs.write()
    }))
}

/// Writes the circle that closes a strip: `first_circle` goes through `start` and the guide's first point
/// `guide_first`, `last_circle` through the guide's last point `guide_last`. `first` is where `start` must be, `last`
/// the point opposite to `guide_last`. Other outputs may be null: `which_case` is 1 if both circles are on one sphere,
/// so that `start` stays, or 2; `is_crossed` whether the closing quad crosses itself.
///
/// # Safety
/// Circles are null or readable for 7 doubles, points for 3; `circle` is null or writable for 7, `first` and `last` for
/// 3, the others for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCloseCircles(
    first_circle: *const f64,
    last_circle: *const f64,
    start: *const f64,
    guide_first: *const f64,
    guide_last: *const f64,
    circle: *mut f64,
    first: *mut f64,
    last: *mut f64,
    which_case: *mut c_int,
    is_crossed: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (c0, cf) = (io::circle("first_circle", first_circle)?, io::circle("last_circle", last_circle)?);
            let start = io::vector("start", start)?;
            let (p0, pf) = (io::vector("guide_first", guide_first)?, io::vector("guide_last", guide_last)?);
            let found = closing::close(&c0, &cf, start, p0, pf)?;
            outputs.must("circle", circle, io::circle_numbers(&[found.circle]))?;
            outputs.must("first", first, io::coordinates(&[found.first]))?;
            outputs.must("last", last, io::coordinates(&[found.last]))?;
            outputs.may("which_case", which_case, vec![io::case_number(found.case)])?;
            outputs.may("is_crossed", is_crossed, vec![c_int::from(found.is_crossed)])?;
        }
        outputs.write()
    }))
}

/// Closes a strip of `nb_points` points on either side with the guide's last point `last`: writes the border of
/// `nb_points + 1` points, of which the first moves where it must. `circle` (of the closing quad), `which_case` and
/// `is_flipped` (one for each quad, the closing one last) may be null.
///
/// # Safety
/// `guide` and `border` are null or readable for `3 * nb_points` doubles, `last` for 3; `out_border` is null or
/// writable for `3 * (nb_points + 1)` doubles, `circle` for 7, `is_flipped` for `nb_points + 1` ints, `which_case` for
/// one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCloseStrip(
    guide: *const f64,
    border: *const f64,
    nb_points: c_int,
    last: *const f64,
    out_border: *mut f64,
    circle: *mut f64,
    which_case: *mut c_int,
    is_flipped: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let open = io::strip(guide, border, nb_points)?;
            let closed = closing::closed_strip(&open, io::vector("last", last)?)?;
            outputs.must("out_border", out_border, io::coordinates(&closed.border))?;
            outputs.may("circle", circle, io::circle_numbers(&[closed.closing.circle]))?;
            outputs.may("which_case", which_case, vec![io::case_number(closed.closing.case)])?;
            outputs.may("is_flipped", is_flipped, io::marks(&closed.flipped, closed.border.len()))?;
        }
        outputs.write()
    }))
}
