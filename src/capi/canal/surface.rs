//! Surfaces: creating, deleting, transforming, reading.

use std::ffi::{c_char, c_int};

use glam::DQuat;

use super::super::arguments::{length, slice, text};
use super::super::handles::{self, Handle};
use super::super::{c_count, code, guard_named, messages, number, shapeop_err};
use super::io::{self, Outputs};
use super::{created, guard};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::chain::Transform;
use crate::geometry::canal::frame;
use crate::geometry::canal::inversion::Inversion;
use crate::geometry::canal::membrane;
use crate::geometry::canal::net::Net;
use crate::geometry::canal::surface::{BaseKind, SuperCanal};

/// A super-canal surface: a circular net with a frame at each point, and the transformations that made it of its base.
/// What points to it is no address but a small integer, a handle. All functions named `shapeop_canal...` leave their
/// messages for `shapeop_lastError` of null.
#[derive(Debug)]
pub struct ShapeOpCanal {
    _private: [u8; 0],
}

/// A bit of `wraps`: row 0 of a grid follows the last row.
pub const SHAPEOP_WRAPS_ROWS: c_int = 1;

/// A bit of `wraps`: column 0 of a grid follows the last column.
pub const SHAPEOP_WRAPS_COLUMNS: c_int = 2;

/// What the base of a surface is; it decides on the name of its family only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_canal_kind {
    /// A canal surface: its sections are circles.
    SO_CANAL_KIND_CANAL = 0,
    /// A surface of revolution.
    SO_CANAL_KIND_REVOLUTION = 1,
    /// A moulding surface.
    SO_CANAL_KIND_MOULDING = 2,
    /// Any circular net.
    SO_CANAL_KIND_CIRCULAR = 3,
}

const KINDS: [(shapeop_canal_kind, BaseKind); 4] = [
    (shapeop_canal_kind::SO_CANAL_KIND_CANAL, BaseKind::Canal),
    (shapeop_canal_kind::SO_CANAL_KIND_REVOLUTION, BaseKind::Revolution),
    (shapeop_canal_kind::SO_CANAL_KIND_MOULDING, BaseKind::Moulding),
    (shapeop_canal_kind::SO_CANAL_KIND_CIRCULAR, BaseKind::Circular),
];

pub(super) fn kind(number: c_int) -> Result<BaseKind> {
    let found = KINDS.iter().find(|(own, _)| *own as c_int == number);
    found.map(|(_, kind)| *kind).ok_or_else(|| {
        let reason = format!("expected a shapeop_canal_kind, 0 to {}, found {number}", KINDS.len() - 1);
        Error::new(Status::InvalidValue, reason).at("kind")
    })
}

pub(super) fn kind_number(kind: BaseKind) -> c_int {
    let found = KINDS.iter().find(|(_, own)| *own == kind);
    found.map_or(-1, |(number, _)| *number as c_int)
}

/// Creates a surface of a circular net: `rows` times `columns` points, row by row; `wraps` says which directions close.
/// `frame` is that at point (0, 0): the unit tangents `t1`, from row to row, and `t2`, from column to column,
/// orthogonal; the normal is their cross product. `kind` is a `shapeop_canal_kind`. Null if it is refused, as a net is
/// whose quads have no circles. Delete it with `shapeop_canalDelete`.
///
/// # Safety
/// `points` is null or readable for `3 * rows * columns` doubles, `frame` for 6.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCreate(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    frame: *const f64,
    kind: c_int,
) -> *mut ShapeOpCanal {
    created(|| {
        // SAFETY: the caller vouches for the arrays.
        let (grid, frame) = unsafe { (io::grid(points, rows, columns, wraps)?, io::frame("frame", frame)?) };
        Ok(SuperCanal::new(Net::new(grid, frame)?, self::kind(kind)?))
    })
}

/// Creates the surface that a text in JSON states (`docs/canal.schema.json`). Null if it is refused; the message names
/// the place in the text.
///
/// # Safety
/// `json` is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalFromJson(json: *const c_char) -> *mut ShapeOpCanal {
    // SAFETY: the caller vouches for the text.
    created(|| SuperCanal::from_json(&unsafe { text("json", json)? }))
}

/// Creates a copy of a surface; null if it is refused.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalCopy(surface: *mut ShapeOpCanal) -> *mut ShapeOpCanal {
    match guard(surface, |surface| Ok(surface.clone())) {
        Ok(copy) => created(|| Ok(copy)),
        Err(_) => std::ptr::null_mut(),
    }
}

/// Deletes a surface. Null does nothing; a busy surface is left alone, as is whatever is no surface.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalDelete(surface: *mut ShapeOpCanal) {
    if !surface.is_null() {
        let handle = Handle::new(surface.cast());
        let _ = guard_named(handle, || handles::delete::<SuperCanal>(handle));
    }
}

/// The JSON form of a surface, its base and its chain of transformations; null if it is refused. The text is the
/// calling thread's own, valid until that thread's next call of a `shapeop_canal...` function that answers with a text.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalText(surface: *mut ShapeOpCanal) -> *const c_char {
    guard(surface, |surface| Ok(messages::show_canal(surface.to_json()))).unwrap_or(std::ptr::null())
}

/// The name of a surface's family, such as `MC-canal`: `M` for an inversion, `C` for a Combescure transformation, the
/// last one first; null if it is refused. It is valid as long as that of `shapeop_canalText`.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalFamily(surface: *mut ShapeOpCanal) -> *const c_char {
    guard(surface, |surface| Ok(messages::show_canal(surface.family()))).unwrap_or(std::ptr::null())
}

/// The kind of a surface's base, a `shapeop_canal_kind`, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalKind(surface: *mut ShapeOpCanal) -> c_int {
    number(guard(surface, |surface| Ok(kind_number(surface.kind()))))
}

/// The number of transformations in a surface's chain, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalChainCount(surface: *mut ShapeOpCanal) -> c_int {
    number(guard(surface, |surface| c_count(surface.chain().len())))
}

/// Writes the size of a surface's net: `rows`, `columns` and `wraps`, bits as in `shapeop_canalCreate`. Each may be
/// null.
///
/// # Safety
/// Each is null or writable for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalSize(
    surface: *mut ShapeOpCanal,
    rows: *mut c_int,
    columns: *mut c_int,
    wraps: *mut c_int,
) -> shapeop_err {
    code(guard(surface, |surface| {
        let grid = surface.net().grid();
        let bits = c_int::from(grid.wraps()[0]) | c_int::from(grid.wraps()[1]) << 1;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for one int each.
        unsafe {
            outputs.may("rows", rows, vec![c_count(grid.rows())?])?;
            outputs.may("columns", columns, vec![c_count(grid.columns())?])?;
            outputs.may("wraps", wraps, vec![bits])?;
        }
        outputs.write()
    }))
}

/// # Safety
/// As `shapeop_canalPoints`.
unsafe fn tell_points(net: &Net, points: *mut f64, capacity: c_int, count: *mut c_int) -> Result<()> {
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for both.
    unsafe { outputs.sized("points", points, capacity, count, io::coordinates(net.grid().points()), 3)? };
    outputs.write()
}

/// # Safety
/// As `shapeop_canalFrames`.
unsafe fn tell_frames(net: &Net, frames: *mut f64, capacity: c_int, count: *mut c_int) -> Result<()> {
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for both.
    unsafe { outputs.sized("frames", frames, capacity, count, io::frame_numbers(net.frames()), 9)? };
    outputs.write()
}

/// Writes the points of a surface's net, row by row, if there is room for `capacity` points, and their number to
/// `count`. With null and 0 it only tells the number.
///
/// # Safety
/// `points` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalPoints(
    surface: *mut ShapeOpCanal,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    // SAFETY: the caller vouches for both.
    code(guard(surface, |surface| unsafe { tell_points(surface.net(), points, capacity, count) }))
}

/// As `shapeop_canalPoints`, for the frames at the points: each the unit vectors `t1`, `t2` and the normal, 9 doubles.
///
/// # Safety
/// `frames` is null or writable for `9 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalFrames(
    surface: *mut ShapeOpCanal,
    frames: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    // SAFETY: the caller vouches for both.
    code(guard(surface, |surface| unsafe { tell_frames(surface.net(), frames, capacity, count) }))
}

/// As `shapeop_canalPoints`, for the net of the base.
///
/// # Safety
/// `points` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalBasePoints(
    surface: *mut ShapeOpCanal,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    // SAFETY: the caller vouches for both.
    code(guard(surface, |surface| unsafe { tell_points(surface.base(), points, capacity, count) }))
}

/// As `shapeop_canalPoints`, for the base that the inverse chain makes of the net: what differs from
/// `shapeop_canalBasePoints` is round-off.
///
/// # Safety
/// `points` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalRestoredPoints(
    surface: *mut ShapeOpCanal,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    // SAFETY: the caller vouches for both.
    code(guard(surface, |surface| unsafe { tell_points(&surface.restored()?, points, capacity, count) }))
}

fn push(surface: *mut ShapeOpCanal, transform: impl FnOnce() -> Result<Transform>) -> shapeop_err {
    code(guard(surface, |surface| surface.push(transform()?)))
}

/// Inverts a surface: a point at the vector `q` from `center` goes to `ratio * q / |q|^2`; `ratio` is in squared model
/// units and not 0. The surface becomes M of what it was.
///
/// # Safety
/// `center` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalInvert(
    surface: *mut ShapeOpCanal,
    center: *const f64,
    ratio: f64,
) -> shapeop_err {
    push(surface, || {
        // SAFETY: the caller vouches for 3 doubles.
        Ok(Transform::Inversion(Inversion::new(unsafe { io::vector("center", center)? }, ratio)?))
    })
}

/// Moves a surface by a vector.
///
/// # Safety
/// `vector` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalTranslate(surface: *mut ShapeOpCanal, vector: *const f64) -> shapeop_err {
    // SAFETY: the caller vouches for 3 doubles.
    push(surface, || Ok(Transform::Translation(unsafe { io::vector("vector", vector)? })))
}

/// Scales a surface about the origin by a factor that is not 0.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalScale(surface: *mut ShapeOpCanal, factor: f64) -> shapeop_err {
    push(surface, || Ok(Transform::Scaling(factor)))
}

/// Turns a surface about the axis through the origin along `axis`, of any length but 0, by `angle` radians,
/// right-handed.
///
/// # Safety
/// `axis` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalRotate(surface: *mut ShapeOpCanal, axis: *const f64, angle: f64) -> shapeop_err {
    push(surface, || {
        // SAFETY: the caller vouches for 3 doubles.
        let axis = unsafe { io::vector("axis", axis)? };
        let Some(axis) = axis.try_normalize() else {
            return Err(
                Error::new(Status::InvalidValue, format!("expected a vector other than 0, found {axis}")).at("axis")
            );
        };
        if !angle.is_finite() {
            return Err(Error::new(Status::InvalidValue, format!("expected a finite angle, found {angle}")).at("angle"));
        }
        Ok(Transform::Rotation(DQuat::from_axis_angle(axis, angle)))
    })
}

/// The Combescure transformation of a surface: the parallel net whose edges along column 0 (from row to row) and along
/// row 0 are these multiples, none 0, of what they were. One factor for each edge. Lengths of a direction that wraps
/// must close it (`shapeop_canalCloseLengths`).
///
/// # Safety
/// Each array is null or readable for its number of doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCombescureFactors(
    surface: *mut ShapeOpCanal,
    column: *const f64,
    nb_column: c_int,
    row: *const f64,
    nb_row: c_int,
) -> shapeop_err {
    push(surface, || {
        // SAFETY: the caller vouches for the arrays.
        let (column, row) = unsafe {
            (io::numbers("column", column, "nb_column", nb_column)?, io::numbers("row", row, "nb_row", nb_row)?)
        };
        Ok(Transform::Combescure { column, row })
    })
}

/// Takes the last transformation off: 1, 0 if there is none, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalUndo(surface: *mut ShapeOpCanal) -> c_int {
    number(guard(surface, |surface| Ok(c_int::from(surface.pop()?.is_some()))))
}

/// Creates the surface that `surface` is when every face is cut into `one` by `two` pieces along lines of curvature,
/// without a chain: the base is refined and transformed, so that old points stay. Null if it is refused.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalRefined(surface: *mut ShapeOpCanal, one: c_int, two: c_int) -> *mut ShapeOpCanal {
    let refined = guard(surface, |surface| {
        let one = io::size("one", one, surface.net().grid().points().len())?;
        let two = io::size("two", two, one.max(1) * surface.net().grid().points().len())?;
        let net = surface.refined(one, two)?;
        let kind = if surface.chain().is_empty() { surface.kind() } else { BaseKind::Circular };
        Ok(SuperCanal::new(net, kind))
    });
    match refined {
        Ok(refined) => created(|| Ok(refined)),
        Err(_) => std::ptr::null_mut(),
    }
}

/// As `shapeop_canalRefined`, with every face cut at the given fractions of the arcs of column 0 (`one`) and row 0
/// (`two`), ascending between 0 and 1; the net itself is cut, not its base.
///
/// # Safety
/// Each array is null or readable for its number of doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalRefinedAt(
    surface: *mut ShapeOpCanal,
    one: *const f64,
    nb_one: c_int,
    two: *const f64,
    nb_two: c_int,
) -> *mut ShapeOpCanal {
    let refined = guard(surface, |surface| {
        // SAFETY: the caller vouches for the arrays.
        let (one, two) =
            unsafe { (io::numbers("one", one, "nb_one", nb_one)?, io::numbers("two", two, "nb_two", nb_two)?) };
        let points = surface.net().grid().points().len();
        io::size("nb_one", nb_one, points)?;
        io::size("nb_two", nb_two, (one.len() + 1) * points)?;
        let kind = if surface.chain().is_empty() { surface.kind() } else { BaseKind::Circular };
        Ok(SuperCanal::new(surface.net().refined_at(&one, &two)?, kind))
    });
    match refined {
        Ok(refined) => created(|| Ok(refined)),
        Err(_) => std::ptr::null_mut(),
    }
}

/// Writes the point and the frame (9 doubles; each output may be null) of the patch over face `(i, j)` at the fractions
/// `u` and `v`, 0 to 1, of its arcs from row to row and from column to column.
///
/// # Safety
/// `point` is null or writable for 3 doubles, `frame` for 9.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalEvaluate(
    surface: *mut ShapeOpCanal,
    i: c_int,
    j: c_int,
    u: f64,
    v: f64,
    point: *mut f64,
    frame: *mut f64,
) -> shapeop_err {
    code(guard(surface, |surface| {
        let [rows, columns] = surface.net().grid().spans();
        let patch = surface.net().patch(io::index("i", i, rows)?, io::index("j", j, columns)?)?;
        for (name, fraction) in [("u", u), ("v", v)] {
            if !(0.0..=1.0).contains(&fraction) {
                let reason = format!("expected a fraction from 0 to 1, found {fraction}");
                return Err(Error::new(Status::InvalidValue, reason).at(name));
            }
        }
        if patch.runs_through_infinity() {
            return Err(Error::new(Status::Degenerate, "an arc of the face runs through infinity").at("i"));
        }
        let (at, frame_there) = patch.at(u, v);
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.may("point", point, io::coordinates(&[at]))?;
            outputs.may("frame", frame, io::frame_numbers(&[frame_there]))?;
        }
        outputs.write()
    }))
}

/// Writes how far the frames come back from themselves across the seams of a surface that wraps, as a difference of
/// unit vectors: 0 where the surface is smooth there, or does not wrap.
///
/// # Safety
/// `gap` is null or writable for one double.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalClosingGap(surface: *mut ShapeOpCanal, gap: *mut f64) -> shapeop_err {
    code(guard(surface, |surface| {
        let net = surface.net();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for one double.
        unsafe { outputs.must("gap", gap, vec![frame::closing_gap(net.grid(), net.frames())])? };
        outputs.write()
    }))
}

/// Writes how near any forces along the lines of curvature come to equilibrium under a pressure along the normals: 0,
/// the lines can be lines of principal stress; 1, no force carries anything.
///
/// # Safety
/// `residual` is null or writable for one double.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalMembraneResidual(surface: *mut ShapeOpCanal, residual: *mut f64) -> shapeop_err {
    code(guard(surface, |surface| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for one double.
        unsafe { outputs.must("residual", residual, vec![membrane::least_residual(surface.net())?])? };
        outputs.write()
    }))
}

/// As `shapeop_canalMembraneResidual`, for given forces per length in both directions, one per face, above 0 for
/// tension under `pressure` along the normal, which is not 0.
///
/// # Safety
/// The forces are null or readable for `nb_faces` doubles, `residual` is null or writable for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalMembraneResidualOf(
    surface: *mut ShapeOpCanal,
    pressure: f64,
    forces_one: *const f64,
    forces_two: *const f64,
    nb_faces: c_int,
    residual: *mut f64,
) -> shapeop_err {
    code(guard(surface, |surface| {
        let count = length("nb_faces", nb_faces)?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (one, two) = (slice("forces_one", forces_one, count)?, slice("forces_two", forces_two, count)?);
            outputs.must("residual", residual, vec![membrane::residual_of(surface.net(), pressure, one, two)?])?;
        }
        outputs.write()
    }))
}
