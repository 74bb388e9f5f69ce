//! Constraints: adding one or many, editing, weighing, removing.

use std::ffi::{c_char, c_int, c_uint};

use super::arguments::{check_pointer, constraint_id, length, slice, text, write};
use super::explore::SHAPEOP_HARD;
use super::handles::ShapeOpSolver;
use super::{c_count, code, guard, guard_read, number, shapeop_err};
use crate::constraints::{NewConstraints, Scalars, TypeIndex};
use crate::error::{Error, Result, Status};
use crate::solver::Solver;

/// Adds a constraint with its type's default scalars, at rest where the points are now. `ids` are point indices.
/// Returns its id (they count up from 0 and are never reused), or -1 if the type is unknown, their number does not fit
/// the type, one is out of range, or `weight` is negative or not finite.
///
/// # Safety
/// `constraint_type` is null or ends with a zero; `ids` is null or readable for `nb_ids` ints.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_addConstraint(
    op: *mut ShapeOpSolver,
    constraint_type: *const c_char,
    ids: *mut c_int,
    nb_ids: c_int,
    weight: f64,
) -> c_int {
    number(guard(op, |solver| {
        // SAFETY: the caller vouches for the text and for so many ints.
        let (type_name, indices) = unsafe {
            (text("constraint_type", constraint_type)?, slice("ids", ids.cast_const(), length("nb_ids", nb_ids)?)?)
        };
        let bulk = Bulk {
            type_name: &type_name,
            indices,
            counts: vec![indices.len()],
            weights: &[weight],
            scalars: &[],
            scalar_set_count: 0,
        };
        c_count(bulk.add_to(solver)?)
    }))
}

/// Adds many constraints of one type, all or none, at rest where the points are now.
///
/// - `ids`: the point indices of all constraints behind each other, `nb_ids` in all.
/// - `counts`: the number of indices of each. `nb_counts` 1: the same for all, so there are `nb_ids / counts[0]`
///   constraints; otherwise one per constraint.
/// - `weights`: `nb_weights` 1: the same for all; otherwise one per constraint.
/// - `scalars`: scalar sets behind each other, `nb_scalars` numbers in all. `nb_scalar_sets` 0: the defaults of the
///   type; 1: one set for all; otherwise one per constraint. For types that take shapes every set has the same number
///   of shapes, each of its own constraint's number of points.
/// - `flags`: 0, or `SHAPEOP_HARD`: they are to be met exactly, see `shapeop_setHard`. Unknown bits are refused.
/// - `constraint_ids`: null, or where the ids go, one int per constraint.
///
/// # Safety
/// `constraint_type` is null or ends with a zero; each array is null or readable for its number of values;
/// `constraint_ids` is null or writable for one int per constraint.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_addConstraints(
    op: *mut ShapeOpSolver,
    constraint_type: *const c_char,
    ids: *const c_int,
    nb_ids: c_int,
    counts: *const c_int,
    nb_counts: c_int,
    weights: *const f64,
    nb_weights: c_int,
    scalars: *const f64,
    nb_scalars: c_int,
    nb_scalar_sets: c_int,
    flags: c_uint,
    constraint_ids: *mut c_int,
) -> shapeop_err {
    code(guard(op, |solver| {
        if flags & !SHAPEOP_HARD != 0 {
            let reason = format!("expected 0 or {SHAPEOP_HARD} (SHAPEOP_HARD), found {flags:#x}");
            return Err(Error::new(Status::InvalidValue, reason).at("flags"));
        }
        // SAFETY: the caller vouches for the text and for the number of values of each array.
        let (type_name, indices, counts, weights, scalars) = unsafe {
            (
                text("constraint_type", constraint_type)?,
                slice("ids", ids, length("nb_ids", nb_ids)?)?,
                slice("counts", counts, length("nb_counts", nb_counts)?)?,
                slice("weights", weights, length("nb_weights", nb_weights)?)?,
                slice("scalars", scalars, length("nb_scalars", nb_scalars)?)?,
            )
        };
        let counts = index_counts(&type_name, indices.len(), counts)?;
        let constraint_count = counts.len();
        if !constraint_ids.is_null() {
            check_pointer("constraint_ids", constraint_ids.cast_const(), constraint_count)?;
        }
        let scalar_set_count = length("nb_scalar_sets", nb_scalar_sets)?;
        let bulk = Bulk { type_name: &type_name, indices, counts, weights, scalars, scalar_set_count };
        let is_hard = flags & SHAPEOP_HARD != 0;
        let first = if is_hard { bulk.add_hard_to(solver)? } else { bulk.add_to(solver)? };
        let new_ids: Vec<c_int> = (first..first + constraint_count).map(|id| id as c_int).collect();
        // SAFETY: the pointer was checked, and the caller vouches for one int per constraint.
        unsafe { write(constraint_ids, &new_ids) };
        Ok(())
    }))
}

/// Replaces the scalars of a constraint, of the type that it was added with; "Similarity" and "Rigid" may edit each
/// other's. The next solve uses them. Scalars already in force change nothing and cost nothing.
///
/// Decided in this order: the type cannot be edited (1); the id is no constraint of that type (3); the number of
/// scalars does not fit (2); a scalar is outside its domain or not finite (16).
///
/// # Safety
/// `constraint_type` is null or ends with a zero; `scalars` is null or readable for `nb_scl` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_editConstraint(
    op: *mut ShapeOpSolver,
    constraint_type: *const c_char,
    constraint_id: c_int,
    scalars: *const f64,
    nb_scl: c_int,
) -> shapeop_err {
    code(guard(op, |solver| {
        // SAFETY: the caller vouches for the text.
        let type_name = unsafe { text("constraint_type", constraint_type)? };
        TypeIndex::named(&type_name)?.info().check_editable()?;
        let id = self::constraint_id(constraint_id)?;
        solver.check_editable(&type_name, id)?;
        // SAFETY: the caller vouches for so many doubles.
        let scalars = unsafe { slice("scalars", scalars, length("nb_scl", nb_scl)?)? };
        solver.edit_constraint(&type_name, id, scalars)
    }))
}

/// Replaces the scalars of many constraints of one type, all or none; otherwise as `shapeop_editConstraint`.
///
/// - `scalars`: scalar sets behind each other, `nb_scalars` numbers in all. `nb_scalar_sets` 1: one set for all;
///   otherwise one per constraint, each of the same number of scalars, or of shapes.
///
/// # Safety
/// `constraint_type` is null or ends with a zero; each array is null or readable for its number of values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_editConstraints(
    op: *mut ShapeOpSolver,
    constraint_type: *const c_char,
    constraint_ids: *const c_int,
    nb_constraint_ids: c_int,
    scalars: *const f64,
    nb_scalars: c_int,
    nb_scalar_sets: c_int,
) -> shapeop_err {
    code(guard(op, |solver| {
        // SAFETY: the caller vouches for the text and for the number of values of each array.
        let (type_name, ids, scalars) = unsafe {
            (
                text("constraint_type", constraint_type)?,
                slice("constraint_ids", constraint_ids, length("nb_constraint_ids", nb_constraint_ids)?)?,
                slice("scalars", scalars, length("nb_scalars", nb_scalars)?)?,
            )
        };
        TypeIndex::named(&type_name)?.info().check_editable()?;
        let ids = self::constraint_ids(ids)?;
        let mut counts = Vec::with_capacity(ids.len());
        for (i, &id) in ids.iter().enumerate() {
            let check = solver.check_editable(&type_name, id);
            check.map_err(|error| error.at(format!("constraint_ids[{i}]")))?;
            counts.push(solver.constraint(id).map_or(0, |view| view.indices.len()));
        }
        let set_count = length("nb_scalar_sets", nb_scalar_sets)?;
        let scalar_counts = scalar_counts(&type_name, &counts, scalars.len(), set_count)?;
        let mut at = 0;
        let mut edits = Vec::with_capacity(ids.len());
        for (i, &id) in ids.iter().enumerate() {
            let set = match *scalar_counts.as_slice() {
                [] => &[],
                [_] => scalars,
                _ => &scalars[at..at + scalar_counts[i]],
            };
            at += set.len();
            edits.push((id, set));
        }
        solver.edit_constraints(&type_name, &edits)
    }))
}

/// Sets the weight of a constraint: finite, at least 0. The next solve uses it.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_setWeight(op: *mut ShapeOpSolver, constraint_id: c_int, weight: f64) -> shapeop_err {
    code(guard(op, |solver| solver.set_weight(self::constraint_id(constraint_id)?, weight)))
}

/// Sets the weights of many constraints, all or none: `nb_weights` 1: the same for all; otherwise one per constraint.
///
/// # Safety
/// Each array is null or readable for its number of values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_setWeights(
    op: *mut ShapeOpSolver,
    constraint_ids: *const c_int,
    nb_constraint_ids: c_int,
    weights: *const f64,
    nb_weights: c_int,
) -> shapeop_err {
    code(guard(op, |solver| {
        // SAFETY: the caller vouches for the number of values of each array.
        let (ids, weights) = unsafe {
            (
                slice("constraint_ids", constraint_ids, length("nb_constraint_ids", nb_constraint_ids)?)?,
                slice("weights", weights, length("nb_weights", nb_weights)?)?,
            )
        };
        let ids = self::constraint_ids(ids)?;
        if weights.len() != 1 && weights.len() != ids.len() {
            let reason = format!("expected 1 or {}, found {}", ids.len(), weights.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("nb_weights"));
        }
        let weights = ids.into_iter().zip(weights.iter().copied().cycle());
        solver.set_weights(&weights.collect::<Vec<_>>())
    }))
}

/// Removes a constraint. Its id is never given out again; arrays with one entry per constraint keep its place.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_removeConstraint(op: *mut ShapeOpSolver, constraint_id: c_int) -> shapeop_err {
    code(guard(op, |solver| solver.remove_constraint(self::constraint_id(constraint_id)?)))
}

/// The number of constraint ids given out, those of removed ones included, or -1. It is the length of every array with
/// one entry per constraint.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_constraintCount(op: *mut ShapeOpSolver) -> c_int {
    number(guard_read(op, |solver| c_count(solver.constraint_count())))
}

/// 1 if `constraint_id` is a constraint, 0 if it was removed or never given out, -1 if the call is refused.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_isConstraint(op: *mut ShapeOpSolver, constraint_id: c_int) -> c_int {
    number(guard_read(op, |solver| {
        Ok(c_int::from(usize::try_from(constraint_id).is_ok_and(|id| solver.constraint(id).is_some())))
    }))
}

/// 1 if the rest state of the constraint spans too little to say what it asks for (a zero-length edge, a flat
/// triangle); it then asks for less or for nothing, as its type's documentation says. 0 if not; -1 if the call is
/// refused.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_isDegenerate(op: *mut ShapeOpSolver, constraint_id: c_int) -> c_int {
    number(guard_read(op, |solver| {
        let view = solver.constraint(self::constraint_id(constraint_id)?).ok_or_else(|| {
            let reason = format!("{constraint_id} was removed or never given out");
            Error::new(Status::UnmatchingConstraintId, reason).at("constraint id")
        })?;
        Ok(c_int::from(view.is_degenerate))
    }))
}

/// New constraints as a C caller states them.
struct Bulk<'a> {
    type_name: &'a str,
    indices: &'a [c_int],
    counts: Vec<usize>,
    weights: &'a [f64],
    scalars: &'a [f64],
    scalar_set_count: usize,
}

impl Bulk<'_> {
    /// Adds them; returns the id of the first.
    fn add_to(self, solver: &mut Solver) -> Result<usize> {
        let first_id = solver.constraint_count();
        c_count(first_id.saturating_add(self.counts.len()))?;
        let indices: Vec<u32> = self.indices.iter().map_while(|&index| u32::try_from(index).ok()).collect();
        if let Some(index) = self.indices.get(indices.len()) {
            let (constraint, place) = self.place_of(indices.len());
            let reason = format!("{index} is out of range for {} points", solver.points().len());
            let error = Error::new(Status::IndexOutOfRange, reason).at(format!("indices[{place}]"));
            return Err(error.at(format!("constraint {} (\"{}\")", first_id + constraint, self.type_name)));
        }
        let scalar_counts = scalar_counts(self.type_name, &self.counts, self.scalars.len(), self.scalar_set_count)?;
        let Self { type_name, counts, weights, scalars, .. } = self;
        let counts = &counts;
        solver.add_constraints(NewConstraints {
            type_name,
            indices: &indices,
            counts,
            weights,
            scalars,
            scalar_counts: &scalar_counts,
        })
    }

    /// Adds them and makes them hard, all or none; returns the id of the first.
    fn add_hard_to(self, solver: &mut Solver) -> Result<usize> {
        let count = self.counts.len();
        let first = self.add_to(solver)?;
        let ids: Vec<usize> = (first..first + count).collect();
        if let Err(error) = solver.set_hard(&ids, true) {
            solver.take_back_constraints(first);
            return Err(error);
        }
        Ok(first)
    }

    /// The constraint that the index at `position` belongs to, and its place there.
    fn place_of(&self, position: usize) -> (usize, usize) {
        let mut place = position;
        for (constraint, &count) in self.counts.iter().enumerate() {
            if place < count {
                return (constraint, place);
            }
            place -= count;
        }
        (self.counts.len(), place)
    }
}

/// The number of scalars of each set; `index_counts` are the numbers of indices of the constraints.
fn scalar_counts(type_name: &str, index_counts: &[usize], scalar_count: usize, set_count: usize) -> Result<Vec<usize>> {
    if set_count <= 1 {
        return Ok(vec![scalar_count; set_count]);
    }
    let misfit = |name: &str, expected: String, found: usize| {
        Err(Error::new(Status::InvalidArgumentLength, format!("expected {expected}, found {found}")).at(name))
    };
    if set_count != index_counts.len() {
        return misfit("nb_scalar_sets", format!("0, 1 or {}", index_counts.len()), set_count);
    }
    // What one point (of types that take shapes) or one constraint has.
    let has_shapes = TypeIndex::named(type_name)?.info().scalars == Scalars::Shapes;
    let unit_count = if has_shapes { index_counts.iter().sum() } else { index_counts.len() };
    if !scalar_count.is_multiple_of(unit_count.max(1)) {
        let per = if has_shapes { "one point index" } else { "one constraint" };
        let expected = format!("a multiple of {unit_count}, as every set has as many numbers for {per}");
        return misfit("nb_scalars", expected, scalar_count);
    }
    let per_unit = scalar_count / unit_count.max(1);
    Ok(index_counts.iter().map(|count| per_unit * if has_shapes { *count } else { 1 }).collect())
}

/// Constraint ids, which only the solver can check further.
fn constraint_ids(ids: &[c_int]) -> Result<Vec<usize>> {
    let all = ids.iter().enumerate();
    all.map(|(i, &id)| constraint_id(id).map_err(|error| error.at(format!("constraint_ids[{i}]")))).collect()
}

/// The number of indices of each constraint.
fn index_counts(type_name: &str, index_count: usize, counts: &[c_int]) -> Result<Vec<usize>> {
    let info = TypeIndex::named(type_name)?.info();
    if let &[count] = counts {
        let count = length("counts[0]", count)?;
        // Of a single constraint it is the number of its indices that is wrong, as the solver says.
        if count == 0 || count != index_count {
            info.check_index_count(count).map_err(|error| error.at("counts[0]"))?;
        }
        if !index_count.is_multiple_of(count) {
            let reason = format!("expected a multiple of {count}, the indices of each; found {index_count}");
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("nb_ids"));
        }
        return Ok(vec![count; index_count / count]);
    }
    counts.iter().enumerate().map(|(i, &count)| length(&format!("counts[{i}]"), count)).collect()
}
