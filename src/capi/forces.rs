//! Forces: adding, editing, removing. In dynamic mode a force acts as an acceleration.

use std::ffi::c_int;

use super::arguments::{force_id, point_index, vector};
use super::handles::ShapeOpSolver;
use super::{c_count, code, guard, guard_read, number, shapeop_err};
use crate::problem::Force;

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
