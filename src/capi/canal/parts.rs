//! What a workshop makes: node axes, offsets, panels, beams.

use std::ffi::{c_char, c_int, c_uint, c_void};

use glam::{DVec2, DVec3};

use super::super::{c_count, code, guard_free, messages, shapeop_err};
use super::io::{self, Outputs};
use super::smoothing::{shapeop_canal_progress, shapeop_canal_progress_callback};
use crate::error::Result;
use crate::geometry::canal::file::PartsForm;
use crate::geometry::canal::node_axes::NodeAxes;
use crate::geometry::canal::panels;
use crate::mesh::Grid;

/// # Safety
/// `axes` and `gaps` are null or writable for 3 doubles and one for each point.
unsafe fn tell_axes(found: NodeAxes, axes: *mut f64, gaps: *mut f64) -> Result<Outputs> {
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for the outputs.
    unsafe {
        outputs.must("axes", axes, io::coordinates(&found.axes))?;
        outputs.may("gaps", gaps, found.gaps)?;
    }
    Ok(outputs)
}

/// Writes the node axes of a circular grid, a unit vector for each point, that are handed on by reflection from `first`
/// at point (0, 0): beams between them are planar and meet in the axes without torsion. `gaps`, which may be null, are
/// the differences between the depths along each axis down to which beams of height 1 reach.
///
/// # Safety
/// `points` is null or readable, `axes` null or writable, for `3 * rows * columns` doubles; `first` is readable for 3,
/// `gaps` null or writable for `rows * columns`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalNodeAxes(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    first: *const f64,
    axes: *mut f64,
    gaps: *mut f64,
) -> shapeop_err {
    // SAFETY: the caller vouches for the arrays.
    code(guard_free(|| unsafe {
        let grid = io::grid(points, rows, columns, wraps)?;
        tell_axes(NodeAxes::handed_on(&grid, io::vector("first", first)?)?, axes, gaps)?.write()
    }))
}

/// As `shapeop_canalNodeAxes`, with the first axis for which the sum of the squared gaps is least. `progress` may be
/// null; a cancelled search gives the best so far, and `is_cancelled`, which may be null, is 1.
///
/// # Safety
/// As `shapeop_canalNodeAxes`; `is_cancelled` is null or writable for one int, `progress` null or a function of that
/// signature.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalNodeAxesOfLeastGaps(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    progress: shapeop_canal_progress_callback,
    user: *mut c_void,
    axes: *mut f64,
    gaps: *mut f64,
    is_cancelled: *mut c_int,
) -> shapeop_err {
    // SAFETY: the caller vouches for the arrays.
    code(guard_free(|| unsafe {
        let grid = io::grid(points, rows, columns, wraps)?;
        let mut iteration = 0;
        let found = NodeAxes::of_least_gaps(&grid, &mut |fraction| {
            iteration += 1;
            let struct_size = size_of::<shapeop_canal_progress>() as c_uint;
            io::call_back(progress, user, &shapeop_canal_progress { struct_size, iteration, fraction, value: 0.0 })
        })?;
        let cancelled = c_int::from(found.is_cancelled);
        let mut outputs = tell_axes(found, axes, gaps)?;
        outputs.may("is_cancelled", is_cancelled, vec![cancelled])?;
        outputs.write()
    }))
}

/// # Safety
/// Both are null or readable for `3 * rows * columns` doubles.
unsafe fn grid_and_axes(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    axes: *const f64,
) -> Result<(Grid, Vec<DVec3>)> {
    // SAFETY: the caller vouches for the arrays.
    unsafe {
        let grid = io::grid(points, rows, columns, wraps)?;
        let count = c_count(grid.points().len())?;
        Ok((grid, io::points("axes", axes, "rows", count)?))
    }
}

/// Writes, for given axes, the gap at each point for beams of height 1, and the depth along each axis down to which the
/// deepest beam of `height` reaches. Each output may be null.
///
/// # Safety
/// `points` and `axes` are null or readable for `3 * rows * columns` doubles; `gaps` and `depths` are null or writable
/// for `rows * columns`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalNodeGaps(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    axes: *const f64,
    height: f64,
    gaps: *mut f64,
    depths: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (grid, axes) = grid_and_axes(points, rows, columns, wraps, axes)?;
            let found = NodeAxes::of(&grid, &axes)?;
            outputs.may("depths", depths, found.depths(&grid, height)?)?;
            outputs.may("gaps", gaps, found.gaps)?;
        }
        outputs.write()
    }))
}

/// Writes a grid moved by `distance` along its axes. Along the normals of the frames of a circular grid all edges stay
/// parallel.
///
/// # Safety
/// `points` and `axes` are null or readable, `out` is null or writable, for `3 * rows * columns` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalOffset(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    axes: *const f64,
    distance: f64,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (grid, axes) = grid_and_axes(points, rows, columns, wraps, axes)?;
            outputs.must("out", out, io::coordinates(panels::offset(&grid, &axes, distance)?.points()))?;
        }
        outputs.write()
    }))
}

/// Writes a planar beam along every edge, `height` measured along each axis, against it: first the edges from row to
/// row, then those from column to column. `nodes` has 2 point indices for each, `corners` its 4 corners. They are
/// written if there is room for `capacity` beams; `count` is their number. `nodes` may be null.
///
/// # Safety
/// `points` and `axes` are null or readable for `3 * rows * columns` doubles; `nodes` is null or writable for `2 *
/// capacity` ints, `corners` for `12 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalBeams(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    axes: *const f64,
    height: f64,
    nodes: *mut c_int,
    corners: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (grid, axes) = grid_and_axes(points, rows, columns, wraps, axes)?;
            let beams = panels::beams(&grid, &axes, height)?;
            let ends = beams.iter().flat_map(|beam| beam.nodes).map(c_count).collect::<Result<Vec<_>>>()?;
            let all: Vec<DVec3> = beams.iter().flat_map(|beam| beam.corners).collect();
            if !nodes.is_null() {
                outputs.sized("nodes", nodes, capacity, count, ends, 2)?;
            }
            outputs.sized("corners", corners, capacity, count, io::coordinates(&all), 12)?;
        }
        outputs.write()
    }))
}

/// Lays every face of a grid into a plane, with the axes at its corners. One entry for each face; each output may be
/// null: `outlines`, 4 corners with x and y, the first the origin, the second on +x; `lower_outlines`, those of the
/// lower side at `thickness` below, cut along the mitres; `mitres`, per edge the angle in radians between its cut,
/// which contains the axes, and the panel's normal; `circles` through the corners, 7 doubles, zeros where three corners
/// are on a line; `heights`, how far a corner is from the panel's plane.
///
/// # Safety
/// `points` and `axes` are null or readable for `3 * rows * columns` doubles; for each face `outlines` and
/// `lower_outlines` are null or writable for 8 doubles, `mitres` for 4, `circles` for 7, `heights` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalPanels(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    axes: *const f64,
    thickness: f64,
    outlines: *mut f64,
    lower_outlines: *mut f64,
    mitres: *mut f64,
    circles: *mut f64,
    heights: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let plane = |outline: &[DVec2; 4]| outline.iter().flat_map(|corner| corner.to_array()).collect::<Vec<f64>>();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (grid, axes) = grid_and_axes(points, rows, columns, wraps, axes)?;
            let panels = panels::panels(&grid, &axes)?;
            let lower = panels.iter().map(|panel| panel.lower_outline(thickness)).collect::<Result<Vec<_>>>()?;
            let circle = |panel: &panels::Panel| panel.circle.map_or(vec![0.0; 7], |own| io::circle_numbers(&[own]));
            outputs.may("outlines", outlines, panels.iter().flat_map(|panel| plane(&panel.outline)).collect())?;
            outputs.may("lower_outlines", lower_outlines, lower.iter().flat_map(plane).collect())?;
            outputs.may("mitres", mitres, panels.iter().flat_map(|panel| panel.mitres_rad).collect())?;
            outputs.may("circles", circles, panels.iter().flat_map(circle).collect())?;
            outputs.may("heights", heights, panels.iter().map(|panel| panel.height).collect())?;
        }
        outputs.write()
    }))
}

/// The JSON form (`docs/canal-parts.schema.json`) of the panels and beams of a grid with given axes: panels with a
/// lower outline where `thickness` is above 0, beams of `height`. Null if it is refused. Valid as long as the text of
/// `shapeop_canalText`.
///
/// # Safety
/// `points` and `axes` are null or readable for `3 * rows * columns` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalPartsText(
    points: *const f64,
    rows: c_int,
    columns: c_int,
    wraps: c_int,
    axes: *const f64,
    thickness: f64,
    height: f64,
) -> *const c_char {
    // SAFETY: the caller vouches for the arrays.
    let text = guard_free(|| unsafe {
        let (grid, axes) = grid_and_axes(points, rows, columns, wraps, axes)?;
        let axes = NodeAxes::of(&grid, &axes)?;
        Ok(messages::show_canal(PartsForm::new(&grid, &axes, thickness, height)?.to_json()))
    });
    text.unwrap_or(std::ptr::null())
}
