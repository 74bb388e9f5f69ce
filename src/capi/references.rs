//! Reference shapes, which constraints of the types "OnCurve" and "OnMesh" name by their ids.

use std::ffi::c_int;

use super::arguments::{length, slice, xyz_length};
use super::handles::ShapeOpSolver;
use super::{c_count, guard, guard_read, number};
use crate::error::{Error, Result, Status};
use crate::problem::Reference;

/// Adds a polyline for "OnCurve" constraints to refer to: its id, which is returned, is their scalar. Its coordinates are copied.
/// -1 if it has fewer than 2 points, or a coordinate is not finite. References stay until `shapeop_setProblem`.
///
/// - `points`: `x0 y0 z0 x1 ...` in model units, `nb_points` points. They are no points of the solver.
/// - `is_closed`: 1: a segment leads from the last point back to the first; 0: not.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_addReferencePolyline(
    op: *mut ShapeOpSolver,
    points: *const f64,
    nb_points: c_int,
    is_closed: c_int,
) -> c_int {
    number(guard(op, |solver| {
        // SAFETY: the caller vouches for so many doubles.
        let points = unsafe { triples(points, nb_points)? };
        let closed = match is_closed {
            0 | 1 => is_closed == 1,
            _ => {
                let reason = format!("expected 0 or 1, found {is_closed}");
                return Err(Error::new(Status::InvalidValue, reason).at("is_closed"));
            }
        };
        c_count(solver.reference_count())?;
        c_count(solver.add_reference(&Reference::Polyline { points, closed })?)
    }))
}

/// Adds a triangle mesh for "OnMesh" constraints to refer to: its id, which is returned, is their scalar. Its numbers are copied.
/// -1 if it has no triangle, an index is out of range, or a coordinate is not finite. Else as `shapeop_addReferencePolyline`.
///
/// - `triangles`: `3 * nb_triangles` indices into `points`, which are no points of the solver.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles, `triangles` for `3 * nb_triangles` ints.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_addReferenceMesh(
    op: *mut ShapeOpSolver,
    points: *const f64,
    nb_points: c_int,
    triangles: *const c_int,
    nb_triangles: c_int,
) -> c_int {
    number(guard(op, |solver| {
        let index_count = length("nb_triangles", nb_triangles)?.checked_mul(3).ok_or_else(|| {
            Error::new(Status::TooLarge, format!("{nb_triangles} triangles do not fit the memory")).at("nb_triangles")
        })?;
        // SAFETY: the caller vouches for the number of values of each array.
        let (points, indices) = unsafe { (triples(points, nb_points)?, slice("triangles", triangles, index_count)?) };
        let mut triangles = vec![[0; 3]; indices.len() / 3];
        for (i, &index) in indices.iter().enumerate() {
            let reason = || format!("{index} is out of range for {} points", points.len());
            let place = || format!("triangles[{}][{}]", i / 3, i % 3);
            let refusal = |_| Error::new(Status::IndexOutOfRange, reason()).at(place());
            triangles[i / 3][i % 3] = u32::try_from(index).map_err(refusal)?;
        }
        c_count(solver.reference_count())?;
        c_count(solver.add_reference(&Reference::Mesh { points, triangles })?)
    }))
}

/// The number of references, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_referenceCount(op: *mut ShapeOpSolver) -> c_int {
    number(guard_read(op, |solver| c_count(solver.reference_count())))
}

/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles.
unsafe fn triples(points: *const f64, nb_points: c_int) -> Result<Vec<[f64; 3]>> {
    // SAFETY: the caller vouches for so many doubles.
    let coordinates = unsafe { slice("points", points, xyz_length("nb_points", nb_points)?)? };
    Ok(coordinates.chunks_exact(3).map(|point| [point[0], point[1], point[2]]).collect())
}
