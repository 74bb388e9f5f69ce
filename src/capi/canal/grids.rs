//! Grids and meshes of quads: how circular and how parallel they are, parallel ones, frames, folds.

use std::ffi::c_int;

use super::super::arguments::{length, slice};
use super::super::{c_count, code, guard_free, shapeop_err};
use super::io::{self, Outputs};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::combescure::{self, Lengths};
use crate::geometry::canal::folds::Folds;
use crate::geometry::canal::frame::{self, Direction, Frame};
use crate::geometry::canal::parallel::{self, ParallelMeshes, check_parallel_edges, nearest_parallel};
use crate::geometry::canal::quality::Quality;
use crate::mesh::Grid;

/// Measures how circular quads are; `quads` has 4 point indices for each. Each output may be null: `planarity` is the
/// distance of a quad's diagonals over its mean edge, `concyclicity` that of a corner from the circle through the other
/// three over its radius, `is_in_order` whether the corners follow each other around it, so that the quad does not
/// cross itself.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles, `quads` for `4 * nb_quads` ints; each output is null or
/// writable for `nb_quads` values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCheckCircular(
    points: *const f64,
    nb_points: c_int,
    quads: *const c_int,
    nb_quads: c_int,
    planarity: *mut f64,
    concyclicity: *mut f64,
    is_in_order: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let quality = Quality::of_mesh(&io::quads(points, nb_points, quads, nb_quads)?)?;
            outputs.may("planarity", planarity, quality.planarity)?;
            outputs.may("concyclicity", concyclicity, quality.concyclicity)?;
            let in_order = quality.is_in_order.iter().map(|&is| c_int::from(is)).collect();
            outputs.may("is_in_order", is_in_order, in_order)?;
        }
        outputs.write()
    }))
}

/// Compares the edges of two meshes with the same points, pairs of point indices: writes the largest sine of the angle
/// between an edge and its counterpart, and how many point the other way. Each output may be null.
///
/// # Safety
/// `a` and `b` are null or readable for `3 * nb_points` doubles, `edges` for `2 * nb_edges` ints; each output is null
/// or writable for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCheckParallel(
    a: *const f64,
    b: *const f64,
    nb_points: c_int,
    edges: *const c_int,
    nb_edges: c_int,
    largest_sine: *mut f64,
    reversed_count: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let too_large =
            || Error::new(Status::TooLarge, format!("{nb_edges} edges do not fit the memory")).at("nb_edges");
        let index_count = length("nb_edges", nb_edges)?.checked_mul(2).ok_or_else(too_large)?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (a, b) = (io::points("a", a, "nb_points", nb_points)?, io::points("b", b, "nb_points", nb_points)?);
            let indices = slice("edges", edges, index_count)?;
            let index = |(i, &index): (usize, &c_int)| io::index(&format!("edges[{i}]"), index, a.len());
            let indices = indices.iter().enumerate().map(index).collect::<Result<Vec<_>>>()?;
            let found = check_parallel_edges(&a, &b, indices.chunks_exact(2).map(|edge| [edge[0], edge[1]]))?;
            outputs.may("largest_sine", largest_sine, vec![found.largest_sine])?;
            outputs.may("reversed_count", reversed_count, vec![c_count(found.reversed_count)?])?;
        }
        outputs.write()
    }))
}

/// # Safety
/// Both are null or readable for their numbers of doubles.
unsafe fn lengths(column: *const f64, nb_column: c_int, row: *const f64, nb_row: c_int) -> Result<Lengths> {
    // SAFETY: the caller vouches for the arrays.
    unsafe {
        let column = io::numbers("column", column, "nb_column", nb_column)?;
        Ok(Lengths { column, row: io::numbers("row", row, "nb_row", nb_row)? })
    }
}

/// # Safety
/// Both are null or writable for as many doubles as there are lengths.
unsafe fn tell_lengths(lengths: Lengths, column: *mut f64, row: *mut f64) -> Result<()> {
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for the outputs.
    unsafe {
        outputs.must("column", column, lengths.column)?;
        outputs.must("row", row, lengths.row)?;
    }
    outputs.write()
}

/// Writes the lengths of a grid's edges along column 0, from row to row, and along row 0: one fewer than points there,
/// as many where the direction wraps. `rows` times `columns` points, row by row; `wraps`: `SHAPEOP_WRAPS_ROWS`,
/// `SHAPEOP_WRAPS_COLUMNS`.
///
/// # Safety
/// `points` is null or readable for `3 * rows * columns` doubles; `column` and `row` are null or writable for the
/// lengths.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalGridLengths(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    column: *mut f64,
    row: *mut f64,
) -> shapeop_err {
    // SAFETY: the caller vouches for the arrays.
    code(guard_free(|| unsafe { tell_lengths(Lengths::of(&io::grid(points, rows, columns, wraps)?), column, row) }))
}

/// Writes the lengths for `shapeop_canalCombescure` along two polylines that replace column 0 and row 0 and whose edges
/// are parallel to theirs; below 0 where they point the other way. A polyline has one point more than edges.
///
/// # Safety
/// `points` is null or readable for `3 * rows * columns` doubles, each polyline for 3 times its number of points;
/// `column` and `row` are null or writable for one double per edge.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalPolylineLengths(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    column_points: *const f64,
    nb_column_points: c_int,
    row_points: *const f64,
    nb_row_points: c_int,
    column: *mut f64,
    row: *mut f64,
) -> shapeop_err {
    // SAFETY: the caller vouches for the arrays.
    code(guard_free(|| unsafe {
        let grid = io::grid(points, rows, columns, wraps)?;
        let column_points = io::points("column_points", column_points, "nb_column_points", nb_column_points)?;
        let row_points = io::points("row_points", row_points, "nb_row_points", nb_row_points)?;
        tell_lengths(Lengths::of_polylines(&grid, &column_points, &row_points)?, column, row)
    }))
}

/// Writes the lengths nearest to the given ones, by least squares, with which a grid that wraps closes.
///
/// # Safety
/// `points` is null or readable for `3 * rows * columns` doubles; `column` and `out_column` are null or readable and
/// writable for `nb_column` doubles, `row` and `out_row` for `nb_row`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCloseLengths(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    column: *const f64,
    nb_column: c_int,
    row: *const f64,
    nb_row: c_int,
    out_column: *mut f64,
    out_row: *mut f64,
) -> shapeop_err {
    // SAFETY: the caller vouches for the arrays.
    code(guard_free(|| unsafe {
        let grid = io::grid(points, rows, columns, wraps)?;
        let given = lengths(column, nb_column, row, nb_row)?;
        tell_lengths(combescure::close(&grid, &given)?, out_column, out_row)
    }))
}

/// Writes the grid parallel to a circular one whose edges along column 0 and row 0 have given lengths, in model units,
/// below 0 where they point the other way; it is circular again. `origin` is its point (0, 0), that of the grid itself
/// if null; `reversed_count`, which may be null, the number of edges that point the other way.
///
/// # Safety
/// `points` is null or readable, `out` null or writable, for `3 * rows * columns` doubles; `column` and `row` are null
/// or readable for their numbers of doubles, `origin` for 3; `reversed_count` is null or writable for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCombescure(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    column: *const f64,
    nb_column: c_int,
    row: *const f64,
    nb_row: c_int,
    origin: *const f64,
    out: *mut f64,
    reversed_count: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let grid = io::grid(points, rows, columns, wraps)?;
            let lengths = lengths(column, nb_column, row, nb_row)?;
            let origin = io::optional_vector("origin", origin)?.unwrap_or(grid.at(0, 0));
            let found = combescure::combescure(&grid, &lengths, origin)?;
            outputs.must("out", out, io::coordinates(found.grid.points()))?;
            outputs.may("reversed_count", reversed_count, vec![c_count(found.reversed_count)?])?;
        }
        outputs.write()
    }))
}

/// Computes an orthonormal basis of the space of all meshes parallel to a mesh of quads, at most 1000 points, each of
/// them in a face: `dimension` vectors, each `x0 y0 z0 x1 ...`. They are written behind each other if `capacity`,
/// counted in vectors, suffices; with null and 0 only the dimension is told.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles, `quads` for `4 * nb_quads` ints; `basis` is null or
/// writable for `3 * nb_points * capacity` doubles, `dimension` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalParallelSpace(
    points: *const f64,
    nb_points: c_int,
    quads: *const c_int,
    nb_quads: c_int,
    basis: *mut f64,
    capacity: c_int,
    dimension: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let mesh = io::quads(points, nb_points, quads, nb_quads)?;
            let space = ParallelMeshes::of(&mesh)?;
            let unit = (3 * mesh.points.len()).max(1);
            outputs.sized("basis", basis, capacity, dimension, space.basis().concat(), unit)?;
        }
        outputs.write()
    }))
}

/// Writes, of all meshes parallel to a mesh of quads, the one whose points `handles` are nearest to `targets` by the
/// sum of squares; among equally near ones that nearest to the mesh itself. Every point is in a face. Of a mesh of more
/// than 1000 points all points are targets of their own, a millionth as heavy as the handles, and edges are parallel to
/// 1e-12 or as near as 100 rounds bring them: `shapeop_canalCheckParallel` tells.
///
/// # Safety
/// `points` is null or readable, `out` null or writable, for `3 * nb_points` doubles; `quads` is null or readable for
/// `4 * nb_quads` ints, `handles` for `nb_handles` ints, `targets` for `3 * nb_handles` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalNearestParallel(
    points: *const f64,
    nb_points: c_int,
    quads: *const c_int,
    nb_quads: c_int,
    handles: *const c_int,
    targets: *const f64,
    nb_handles: c_int,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let mesh = io::quads(points, nb_points, quads, nb_quads)?;
            let indices = slice("handles", handles, length("nb_handles", nb_handles)?)?;
            let targets = io::points("targets", targets, "nb_handles", nb_handles)?;
            let index = |(i, &index): (usize, &c_int)| io::index(&format!("handles[{i}]"), index, mesh.points.len());
            let indices = indices.iter().enumerate().map(index).collect::<Result<Vec<_>>>()?;
            let handles: Vec<_> = indices.into_iter().zip(targets).collect();
            // The space of all parallel meshes takes too long to compute for large ones.
            let nearest = if mesh.points.len() <= parallel::MOST_POINTS {
                ParallelMeshes::of(&mesh)?.nearest(&handles)?
            } else {
                nearest_parallel(&mesh, &handles)?
            };
            outputs.must("out", out, io::coordinates(&nearest))?;
        }
        outputs.write()
    }))
}

/// Sorts a mesh of quads into grids: `grid_count` is the number of its components, and `rows`, `columns` and `wraps`
/// are those of component `component`. Its point (i, j) is point `indices[i * columns + j]` of the mesh; they are
/// written if there is room for `capacity` of them, and `count` is their number. The other outputs may be null.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles, `quads` for `4 * nb_quads` ints; `indices` is null or
/// writable for `capacity` ints, all other outputs for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalGridOfMesh(
    points: *const f64,
    nb_points: c_int,
    quads: *const c_int,
    nb_quads: c_int,
    component: c_int,
    grid_count: *mut c_int,
    rows: *mut c_int,
    columns: *mut c_int,
    wraps: *mut c_int,
    indices: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let grids = Grid::of_mesh(&io::quads(points, nb_points, quads, nb_quads)?)?;
            let (grid, own) = &grids[io::index("component", component, grids.len())?];
            let bits = c_int::from(grid.wraps()[0]) | c_int::from(grid.wraps()[1]) << 1;
            let own = own.iter().map(|&index| c_count(index as usize)).collect::<Result<Vec<_>>>()?;
            outputs.may("grid_count", grid_count, vec![c_count(grids.len())?])?;
            outputs.may("rows", rows, vec![c_count(grid.rows())?])?;
            outputs.may("columns", columns, vec![c_count(grid.columns())?])?;
            outputs.may("wraps", wraps, vec![bits])?;
            outputs.sized("indices", indices, capacity, count, own, 1)?;
        }
        outputs.write()
    }))
}

/// Writes the frame (9 doubles: the unit vectors `t1`, `t2` and the normal `t1 x t2`) whose normal has the spherical
/// coordinates `theta`, from +z, and `lambda`, from +x about +z, turned about it by `psi`, all in radians.
///
/// # Safety
/// `out` is null or writable for 9 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalFrameOfAngles(lambda: f64, theta: f64, psi: f64, out: *mut f64) -> shapeop_err {
    code(guard_free(|| {
        for (name, angle) in [("lambda", lambda), ("theta", theta), ("psi", psi)] {
            crate::error::finite(name, angle)?;
        }
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for 9 doubles.
        unsafe { outputs.must("out", out, io::frame_numbers(&[Frame::of_angles(lambda, theta, psi)]))? };
        outputs.write()
    }))
}

pub(super) fn direction(number: c_int) -> Result<Direction> {
    match number {
        1 => Ok(Direction::One),
        2 => Ok(Direction::Two),
        _ => Err(Error::new(Status::InvalidValue, format!("expected 1 or 2, found {number}")).at("direction")),
    }
}

/// Writes the frame that has the tangent `tangent`, of any length but 0, in `direction` 1 (from row to row) or 2 (from
/// column to column), and whose normal is as near as possible to `normal`.
///
/// # Safety
/// `tangent` and `normal` are null or readable for 3 doubles; `out` is null or writable for 9.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalFrameOfTangent(
    tangent: *const f64,
    normal: *const f64,
    direction: c_int,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (tangent, normal) = (io::vector("tangent", tangent)?, io::vector("normal", normal)?);
            let unit = tangent.try_normalize();
            let frame = unit.and_then(|tangent| match self::direction(direction) {
                Ok(Direction::One) => Frame::of_tangent_one(tangent, normal),
                _ => Frame::of_tangent_two(tangent, normal),
            });
            self::direction(direction)?;
            let parallel = || {
                let reason = format!("expected a vector that is not parallel to {tangent}, found {normal}");
                Error::new(Status::Degenerate, reason).at("normal")
            };
            outputs.must("out", out, io::frame_numbers(&[frame.ok_or_else(parallel)?]))?;
        }
        outputs.write()
    }))
}

/// Writes the frame at the other end of an edge in `direction` 1 or 2: the mirror image in the plane that bisects it,
/// with the tangent of that direction turned round. `frame` has the unit vectors `t1` and `t2`, 6 doubles; `out` has 9.
///
/// # Safety
/// `frame` is null or readable for 6 doubles, `edge` for 3; `out` is null or writable for 9.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalFrameAcross(
    frame: *const f64,
    edge: *const f64,
    direction: c_int,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (frame, edge) = (io::frame("frame", frame)?, io::vector("edge", edge)?);
            outputs.must("out", out, io::frame_numbers(&[frame.across(edge, self::direction(direction)?)]))?;
        }
        outputs.write()
    }))
}

/// Writes the frames at all points of a circular grid, 9 doubles each, from that at point (0, 0): `frame`, the unit
/// vectors `t1` and `t2`. `closing_gap`, which may be null, is that of `shapeop_canalClosingGap`.
///
/// # Safety
/// `points` is null or readable for `3 * rows * columns` doubles, `frame` for 6; `out` is null or writable for
/// `9 * rows * columns` doubles, `closing_gap` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalGridFrames(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    frame: *const f64,
    out: *mut f64,
    closing_gap: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let grid = io::grid(points, rows, columns, wraps)?;
            let frames = frame::frames(&grid, io::frame("frame", frame)?)?;
            outputs.must("out", out, io::frame_numbers(&frames))?;
            outputs.may("closing_gap", closing_gap, vec![frame::closing_gap(&grid, &frames)])?;
        }
        outputs.write()
    }))
}

/// A bit of the flags of `shapeop_canalFolds`: the face is turned against most of its neighbours.
pub const SHAPEOP_FACE_FLIPPED: c_int = 1;

/// A bit of the flags of `shapeop_canalFolds`: an edge of the face is shorter than a twentieth of the one opposite.
pub const SHAPEOP_FACE_SHRUNK: c_int = 2;

/// Looks for folds of a grid whose column 0 is the guide. Each output may be null: per row `evolute_ratios`, how far
/// its section reaches towards the evolute of the guide (1: up to it; 0 where the guide is straight) and
/// `is_near_evolute` (from 0.8 on); per face `edge_ratios`, the least ratio of opposite edges, and `face_flags`, bits
/// `SHAPEOP_FACE_...`.
///
/// # Safety
/// `points` is null or readable for `3 * rows * columns` doubles; each output is null or writable for one value per row
/// or face.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalFolds(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    evolute_ratios: *mut f64,
    is_near_evolute: *mut c_int,
    edge_ratios: *mut f64,
    face_flags: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let grid = io::grid(points, rows, columns, wraps)?;
            let folds = Folds::of(&grid);
            let mut flags = vec![0; folds.edge_ratios.len()];
            folds.flipped_faces.iter().for_each(|&face| flags[face] |= SHAPEOP_FACE_FLIPPED);
            folds.shrunk_faces.iter().for_each(|&face| flags[face] |= SHAPEOP_FACE_SHRUNK);
            let near = io::marks(&folds.rows_near_evolute, grid.rows());
            outputs.may("evolute_ratios", evolute_ratios, folds.evolute_ratios)?;
            outputs.may("is_near_evolute", is_near_evolute, near)?;
            outputs.may("edge_ratios", edge_ratios, folds.edge_ratios)?;
            outputs.may("face_flags", face_flags, flags)?;
        }
        outputs.write()
    }))
}
