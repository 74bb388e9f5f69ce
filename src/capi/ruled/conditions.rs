//! Side conditions on strips, which the design keeps until they are cleared or there are other strips.

use std::ffi::c_int;

use glam::DVec3;

use super::super::arguments::slice;
use super::super::{c_count, code, number, shapeop_err};
use super::design::ShapeOpRuled;
use super::guard;
use super::io::{self, placed};
use super::strips::strip;
use crate::error::{Error, Result, Status};
use crate::geometry::ruled::conditions::Condition;
use crate::geometry::ruled::design::Draft;
use crate::geometry::ruled::planar_boundaries::Plane;
use crate::geometry::ruled::planks;
use crate::mesh::curve::End;

/// Adds the condition that a boundary is in a plane, of both strips beside it. `plane` has four numbers, the normal, of
/// any length above 0, and the offset of `normal . x = offset`; null for the plane that the boundary was cut by.
///
/// A condition of the same kind for the same place is replaced. Conditions hold exactly after `shapeop_ruledOptimise`,
/// which refuses those that contradict each other (`SO_INFEASIBLE`).
///
/// # Safety
/// `plane` is null or readable for 4 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledConstrainPlane(
    design: *mut ShapeOpRuled,
    boundary: c_int,
    plane: *const f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        let boundary = io::index("boundary", boundary, draft.design().boundaries().boundaries.len())?;
        let Plane { normal, offset } = if plane.is_null() {
            let reason = format!("boundary {boundary} was not cut by a plane: expected one, found null");
            let none = || Error::new(Status::NullPointer, reason).at("plane");
            draft.design().plane_of(boundary).ok_or_else(none)?
        } else {
            // SAFETY: the caller vouches for 4 doubles.
            let numbers = unsafe { slice("plane", plane, 4)? };
            Plane { normal: DVec3::from_slice(numbers), offset: numbers[3] }
        };
        let sides = draft.design().sides_of(boundary);
        if sides.is_empty() {
            let reason = format!("no strip is beside boundary {boundary}");
            return Err(Error::new(Status::NotInitialised, reason).at("boundary"));
        }
        let condition = |(strip, side)| Condition::PlanarBoundary { strip, side, normal, offset };
        let names = [("normal", "plane"), ("offset", "plane")];
        draft.constrain(sides.into_iter().map(condition)).map_err(|error| placed(error, &names))
    }))
}

/// Adds the conditions that all boundaries are in the planes that they were cut by; refused if none was
/// (`SO_NOT_INITIALISED`).
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledConstrainCutPlanes(design: *mut ShapeOpRuled) -> shapeop_err {
    code(guard(design, |draft| {
        let conditions = draft.design().planar_conditions();
        if conditions.is_empty() {
            let reason = "expected boundaries that were cut by planes: call shapeop_ruledSetPlanarBoundaries first";
            return Err(Error::new(Status::NotInitialised, reason).at("design"));
        }
        draft.constrain(conditions)
    }))
}

/// The number of a strip that has ends, and which side and end is meant.
fn place(draft: &Draft, strip_number: c_int, side: c_int, end: c_int) -> Result<(usize, usize, End)> {
    let index = io::index("strip", strip_number, draft.design().strips().len())?;
    Ok((index, io::count("side", side, 0, 1)?, io::end(end)?))
}

fn at_end<T: Copy>(all: &[T], end: End) -> T {
    if end == End::Start { all[0] } else { all[all.len() - 1] }
}

/// Adds the condition that an end of a boundary is at a point: of the first (`side` 0) or second (1) boundary of an
/// open strip its start (`end` 0) or finish (1). `point` is null for where it is now.
///
/// # Safety
/// `point` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledConstrainPoint(
    design: *mut ShapeOpRuled,
    strip: c_int,
    side: c_int,
    end: c_int,
    point: *const f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        let (index, side, end) = place(draft, strip, side, end)?;
        // SAFETY: the caller vouches for 3 doubles.
        let given = unsafe { io::optional_vector("point", point)? };
        let position = given.unwrap_or_else(|| at_end(draft.design().strips()[index].control(side), end));
        draft.constrain([Condition::FixedEnd { strip: index, side, end, position }])
    }))
}

/// Adds the conditions that all ends of the boundaries of open strips stay where they are.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledConstrainEnds(design: *mut ShapeOpRuled) -> shapeop_err {
    code(guard(design, |draft| draft.constrain(Condition::fixed_ends(draft.design().strips()))))
}

/// Adds the condition that the ruling at the start (`end` 0) or finish (1) of an open strip is parallel to `direction`,
/// of any length above 0; null for the one that it has now.
///
/// # Safety
/// `direction` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledConstrainEndDirection(
    design: *mut ShapeOpRuled,
    strip: c_int,
    end: c_int,
    direction: *const f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        let (index, _, end) = place(draft, strip, 0, end)?;
        // SAFETY: the caller vouches for 3 doubles.
        let given = unsafe { io::optional_vector("direction", direction)? };
        let of = &draft.design().strips()[index];
        let direction = given.unwrap_or_else(|| at_end(of.control(1), end) - at_end(of.control(0), end));
        draft.constrain([Condition::FixedEndRuling { strip: index, end, direction }])
    }))
}

/// Adds the condition that a strip is a conoid: that all its rulings are orthogonal to `axis`, of any length above 0;
/// null for the axis that its rulings are most nearly orthogonal to now.
///
/// # Safety
/// `axis` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledConstrainConoid(
    design: *mut ShapeOpRuled,
    strip: c_int,
    axis: *const f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for 3 doubles.
        let given = unsafe { io::optional_vector("axis", axis)? };
        let of = self::strip(draft, strip)?;
        let axis = given.map_or_else(|| Ok(planks::axis(of)?.direction), Ok)?;
        let index = io::index("strip", strip, draft.design().strips().len())?;
        draft.constrain([Condition::Conoidal { strip: index, axis }])
    }))
}

/// The number of conditions, or -1. A message about `conditions[k]` means the k-th that was added, from 0, of those
/// that are left.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledConditionCount(design: *mut ShapeOpRuled) -> c_int {
    number(guard(design, |draft| c_count(draft.conditions().len())))
}

/// Takes all conditions away.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledClearConditions(design: *mut ShapeOpRuled) -> shapeop_err {
    code(guard(design, |draft| {
        draft.clear_conditions();
        Ok(())
    }))
}
