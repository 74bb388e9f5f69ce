//! Forces: adding, editing, removing. In dynamic mode a force acts as an acceleration.

use std::ffi::c_int;

use super::arguments::{faces, force_id, length, point_index, slice, vector};
use super::handles::ShapeOpSolver;
use super::{c_count, code, guard, guard_read, number, shapeop_err};
use crate::error::Result;
use crate::problem::{Faces, Force};
use crate::solver::Solver;

/// Adds a force on every point; `force` is its 3 components. Returns the force's id, or -1 if it is not finite.
///
/// # Safety
/// `force` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_addGravityForce(op: *mut ShapeOpSolver, force: *mut f64) -> c_int {
    number(guard(op, |solver| {
        // SAFETY: the caller vouches for 3 doubles.
        let force = unsafe { vector("force", force)? };
        c_count(solver.force_count())?;
        c_count(solver.add_force(Force::Gravity(force))?)
    }))
}

/// Adds a force on the point `id`; `force` is its 3 components. Returns the force's id, or -1 if the point is out of
/// range or the force is not finite.
///
/// # Safety
/// `force` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_addVertexForce(op: *mut ShapeOpSolver, force: *mut f64, id: c_int) -> c_int {
    number(guard(op, |solver| {
        // SAFETY: the caller vouches for 3 doubles.
        let force = unsafe { vector("force", force)? };
        let point = point_index("id", id, solver.points().len())?;
        c_count(solver.force_count())?;
        c_count(solver.add_force(Force::Vertex { force, point })?)
    }))
}

/// Replaces the vertex force `force_id` by `force` on the point `id`. Refused, with nothing changed, if it is no vertex
/// force, the point is out of range or the force is not finite.
///
/// # Safety
/// `force` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_editVertexForce(op: *mut ShapeOpSolver, force_id: c_int, force: *mut f64, id: c_int) {
    let _ = guard(op, |solver| {
        // SAFETY: the caller vouches for 3 doubles.
        let force = unsafe { vector("force", force)? };
        let point = point_index("id", id, solver.points().len())?;
        solver.edit_vertex_force(self::force_id(force_id)?, force, point)
    });
}

/// Adds a pressure on faces: `pressure` times the vector area of each face (its area times its normal) is shared among its
/// corners. It follows the points: each iteration has it where they are then, and acceleration is off. Returns the force's id,
/// or -1 if it is refused.
///
/// - `indices`: the point indices of all faces behind each other, `nb_indices` in all. A normal points to where the corners
///   run counter-clockwise.
/// - `counts`: the number of corners of each face, at least 3. `nb_counts` 1: the same for all; otherwise one per face.
/// - `pressure`: force per area; negative: against the normals.
///
/// # Safety
/// Each array is null or readable for its number of values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_addPressure(
    op: *mut ShapeOpSolver,
    indices: *const c_int,
    nb_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
    pressure: f64,
) -> c_int {
    number(guard(op, |solver| {
        // SAFETY: the caller vouches for the arrays.
        let faces = unsafe { stated_faces(solver, indices, nb_indices, counts, nb_counts)? };
        c_count(solver.force_count())?;
        c_count(solver.add_force(Force::Pressure { pressure, faces })?)
    }))
}

/// Adds a force of length `magnitude` on every corner of faces, once per point, along the normal there: that of the sum of the
/// vector areas of the faces around the point. Else as `shapeop_addPressure`.
///
/// # Safety
/// Each array is null or readable for its number of values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_addNormalForce(
    op: *mut ShapeOpSolver,
    indices: *const c_int,
    nb_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
    magnitude: f64,
) -> c_int {
    number(guard(op, |solver| {
        // SAFETY: the caller vouches for the arrays.
        let faces = unsafe { stated_faces(solver, indices, nb_indices, counts, nb_counts)? };
        c_count(solver.force_count())?;
        c_count(solver.add_force(Force::Normal { magnitude, faces })?)
    }))
}

/// Replaces the pressure, or the length of the normal force, of the force `force_id`. The next solve uses it. Refused if it is
/// no such force, or `magnitude` is not finite.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_editForceMagnitude(op: *mut ShapeOpSolver, force_id: c_int, magnitude: f64) -> shapeop_err {
    code(guard(op, |solver| solver.edit_force_magnitude(self::force_id(force_id)?, magnitude)))
}

/// Removes a force. Its id is never given out again.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_removeForce(op: *mut ShapeOpSolver, force_id: c_int) -> shapeop_err {
    code(guard(op, |solver| solver.remove_force(self::force_id(force_id)?)))
}

/// The number of force ids given out, those of removed ones included, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_forceCount(op: *mut ShapeOpSolver) -> c_int {
    number(guard_read(op, |solver| c_count(solver.force_count())))
}

/// 1 if `force_id` is a force, 0 if it was removed or never given out, -1 if the call is refused.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_isForce(op: *mut ShapeOpSolver, force_id: c_int) -> c_int {
    let is_force = |id| usize::try_from(id).is_ok();
    number(guard_read(op, |solver| Ok(c_int::from(is_force(force_id) && solver.is_force(force_id as usize)))))
}

/// # Safety
/// Each array is null or readable for its number of values.
unsafe fn stated_faces(
    solver: &Solver,
    indices: *const c_int,
    nb_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
) -> Result<Faces> {
    // SAFETY: the caller vouches for the arrays.
    let (indices, counts) = unsafe {
        (
            slice("indices", indices, length("nb_indices", nb_indices)?)?,
            slice("counts", counts, length("nb_counts", nb_counts)?)?,
        )
    };
    Ok(faces("nb_indices", indices, counts, solver.points().len())?.into_iter().collect())
}
