//! Exploration: hard constraints, handles, the objective, and what a solve found of them.

use std::ffi::{c_char, c_int, c_uint};
use std::mem::offset_of;
use std::ptr;

use super::arguments::{check_pointer, constraint_id, length, point_index, slice, vector, write};
use super::handles::ShapeOpSolver;
use super::points::check_count;
use super::registry::name_of_type;
use super::structs::{self, SizedStruct};
use super::{c_count, code, guard, guard_free, guard_read, number, shapeop_err};
use crate::error::{Error, Result, Status};
use crate::problem::{Fairness, FairnessRows, Objective};
use crate::solver::WeightClass;

/// A bit of the flags of `shapeop_addConstraints`: the constraints are hard.
pub const SHAPEOP_HARD: c_uint = 1;

/// What the fairness term measures displacements with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_fairness {
    /// The displacement of a point minus the mean of its neighbours'. The lists are faces, or edges as lists of two.
    SO_FAIRNESS_LAPLACIAN = 0,
    /// Second differences along polylines, which the lists are; a closed one repeats its first point at its end.
    SO_FAIRNESS_SECOND_DIFFERENCES = 1,
    /// Third differences along polylines.
    SO_FAIRNESS_THIRD_DIFFERENCES = 2,
}

/// The weights of the objective `1/2 handle sum |p - t|^2 + 1/2 closeness sum |p - p0|^2 + 1/2 fairness |L (p - p0)|^2`
/// plus the soft constraints, `p0` being the points at initialisation. Start from `shapeop_defaultObjective`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_objective {
    /// In: `sizeof(shapeop_objective)`.
    pub struct_size: c_uint,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// Above 0. Default 100.
    pub handle_weight: f64,
    /// Above 0. Default 0.1.
    pub closeness_weight: f64,
    /// At least 0; without `shapeop_setFairness` it has nothing to weigh. Default 1.
    pub fairness_weight: f64,
    /// How far a hard constraint may be from its set, relative to the bounding-box diagonal; at least 1e-14. Default
    /// 1e-12.
    pub tolerance: f64,
}

/// What the last exploration found.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_exploration {
    /// In: `sizeof(shapeop_exploration)`.
    pub struct_size: c_uint,
    /// Sweeps of the splitting method.
    pub sweep_count: c_uint,
    /// Newton steps.
    pub newton_step_count: c_uint,
    /// 1 if the points are a solution: every hard constraint is met and the gradient vanishes, both within the
    /// tolerance.
    pub is_solution: c_int,
    /// The largest distance of a hard constraint from its set, in model units.
    pub largest_violation: f64,
    /// The hard constraint that it is of; -1 if there is none.
    pub worst_constraint: c_int,
    /// Hard constraints whose multiplier is at its cap: the contradictions, as far as they are known.
    pub capped_count: c_int,
    /// The largest distance between what multipliers ask for and what the points are, in model units.
    pub primal_residual: f64,
    /// The largest gradient of the Lagrangian at a point, relative to the force that moves it by the model's size.
    pub dual_residual: f64,
    /// The terms of the objective.
    pub handle_term: f64,
    /// See `handle_term`.
    pub closeness_term: f64,
    /// See `handle_term`.
    pub fairness_term: f64,
    /// See `handle_term`.
    pub soft_term: f64,
    /// The penalty of the sweeps.
    pub penalty: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_objective {
    const SIZES: &'static [usize] = &[size_of::<shapeop_objective>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_exploration {
    const SIZES: &'static [usize] = &[offset_of!(Self, handle_term), size_of::<shapeop_exploration>()];
}

fn as_told(objective: &Objective) -> shapeop_objective {
    shapeop_objective {
        struct_size: 0,
        reserved: 0,
        handle_weight: objective.handle_weight,
        closeness_weight: objective.closeness_weight,
        fairness_weight: objective.fairness_weight,
        tolerance: objective.tolerance,
    }
}

/// Makes a constraint hard (`is_hard` 1), to be met exactly, or soft (0). The weight of a hard constraint is its
/// priority where not everything can be met. Solving goes on from where it is.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_setHard(op: *mut ShapeOpSolver, constraint_id: c_int, is_hard: c_int) -> shapeop_err {
    code(guard(op, |solver| {
        if !(0..=1).contains(&is_hard) {
            let reason = format!("expected 0 or 1, found {is_hard}");
            return Err(Error::new(Status::InvalidValue, reason).at("is_hard"));
        }
        solver.set_hard(&[self::constraint_id(constraint_id)?], is_hard == 1)
    }))
}

/// 1 if `constraint_id` is a hard constraint, 0 if it is soft or none, -1 if the call is refused.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_isHard(op: *mut ShapeOpSolver, constraint_id: c_int) -> c_int {
    number(guard_read(op, |solver| {
        let id = usize::try_from(constraint_id).ok();
        Ok(c_int::from(id.and_then(|id| solver.constraint(id)).is_some_and(|view| view.is_hard)))
    }))
}

/// Makes a point a handle, drawn to `target` (3 coordinates), or moves its target. Solving goes on from where it is.
///
/// # Safety
/// `target` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_setHandle(op: *mut ShapeOpSolver, point: c_int, target: *const f64) -> shapeop_err {
    code(guard(op, |solver| {
        // SAFETY: the caller vouches for 3 doubles.
        let target = unsafe { vector("target", target)? };
        solver.set_handle(point_index("point", point, solver.points().len())?, target)
    }))
}

/// Lets a handle go: the point is drawn to where it was at initialisation, as the others are. Refused if it is none.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_releaseHandle(op: *mut ShapeOpSolver, point: c_int) -> shapeop_err {
    code(guard(op, |solver| solver.release_handle(point_index("point", point, solver.points().len())?)))
}

/// Writes the default weights to `objective`, whose `struct_size` must be set.
///
/// # Safety
/// `objective` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_defaultObjective(objective: *mut shapeop_objective) -> shapeop_err {
    code(guard_free(|| {
        // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
        unsafe {
            let size = structs::size("objective", objective)?;
            structs::write(objective, size, &as_told(&Objective::default()));
        }
        Ok(())
    }))
}

/// Sets the weights of the objective; the rows of fairness stay.
///
/// # Safety
/// `objective` is null, or its `struct_size` is set and it is readable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_setObjective(
    op: *mut ShapeOpSolver,
    objective: *const shapeop_objective,
) -> shapeop_err {
    code(guard(op, |solver| {
        // SAFETY: the caller vouches for so many bytes as `struct_size` says; numbers are valid for any bytes.
        let told = unsafe { structs::read("objective", objective, as_told(&Objective::default()))? };
        let new = Objective {
            handle_weight: told.handle_weight,
            closeness_weight: told.closeness_weight,
            fairness_weight: told.fairness_weight,
            tolerance: told.tolerance,
            ..solver.objective()
        };
        let rows = solver.fairness_rows().clone();
        solver.set_objective(&new, rows)
    }))
}

/// Sets what the fairness term measures: `kind` (a `shapeop_fairness`), with faces or polylines as lists of points.
///
/// - `indices`: all lists behind each other, `nb_indices` in all.
/// - `counts`: the number of indices of each list, `nb_counts` in all.
///
/// # Safety
/// Each array is null or readable for its number of values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_setFairness(
    op: *mut ShapeOpSolver,
    kind: c_int,
    indices: *const c_int,
    nb_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
) -> shapeop_err {
    code(guard(op, |solver| {
        let fairness = match kind {
            0 => Fairness::Laplacian,
            1 => Fairness::SecondDifferences,
            2 => Fairness::ThirdDifferences,
            _ => {
                let reason = format!("expected 0, 1 or 2 (a shapeop_fairness), found {kind}");
                return Err(Error::new(Status::InvalidValue, reason).at("kind"));
            }
        };
        // SAFETY: the caller vouches for the number of values of each array.
        let (indices, counts) = unsafe {
            (
                slice("indices", indices, length("nb_indices", nb_indices)?)?,
                slice("counts", counts, length("nb_counts", nb_counts)?)?,
            )
        };
        let lists = lists(indices, counts, solver.points().len())?;
        let rows = match fairness {
            Fairness::Laplacian => FairnessRows::laplacian(solver.points().len(), &edges(&lists)),
            _ => FairnessRows::differences(&lists, fairness),
        };
        let objective = Objective { fairness, ..solver.objective() };
        solver.set_objective(&objective, rows)
    }))
}

/// `indices` cut into lists; each index is one of a point.
fn lists(indices: &[c_int], counts: &[c_int], point_count: usize) -> Result<Vec<Vec<u32>>> {
    let mut rest = indices;
    let mut lists = Vec::with_capacity(counts.len());
    for (i, &count) in counts.iter().enumerate() {
        let count = length(&format!("counts[{i}]"), count)?;
        if count > rest.len() {
            let reason = format!("expected at most the {} indices that are left, found {count}", rest.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at(format!("counts[{i}]")));
        }
        let (own, later) = rest.split_at(count);
        let first = indices.len() - rest.len();
        let index = |(j, &index): (usize, &c_int)| match u32::try_from(index) {
            Ok(index) if (index as usize) < point_count => Ok(index),
            _ => {
                let reason = format!("{index} is out of range for {point_count} points");
                Err(Error::new(Status::IndexOutOfRange, reason).at(format!("indices[{}]", first + j)))
            }
        };
        lists.push(own.iter().enumerate().map(index).collect::<Result<_>>()?);
        rest = later;
    }
    if rest.is_empty() {
        return Ok(lists);
    }
    let reason =
        format!("expected {}, to which the counts add up; found {}", indices.len() - rest.len(), indices.len());
    Err(Error::new(Status::InvalidArgumentLength, reason).at("nb_indices"))
}

/// The edges of faces, and lists of two as they are.
fn edges(faces: &[Vec<u32>]) -> Vec<[u32; 2]> {
    let of_face = |face: &Vec<u32>| {
        let count = if face.len() > 2 { face.len() } else { face.len().saturating_sub(1) };
        (0..count).map(|i| [face[i], face[(i + 1) % face.len()]]).collect::<Vec<_>>()
    };
    faces.iter().flat_map(of_face).filter(|[a, b]| a != b).collect()
}

/// Writes what the last exploration found to `out`, whose `struct_size` must be set. Refused if there was none.
///
/// # Safety
/// `out` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_getExploration(op: *mut ShapeOpSolver, out: *mut shapeop_exploration) -> shapeop_err {
    code(guard_read(op, |solver| {
        // SAFETY: the caller vouches for `struct_size`.
        let size = unsafe { structs::size("out", out)? };
        let found = solver.found().ok_or_else(nothing_found)?;
        let residual = |of: fn(&crate::solver::Residuals) -> f64| found.residuals.as_ref().map_or(0.0, of);
        let told = shapeop_exploration {
            struct_size: 0,
            sweep_count: found.sweeps,
            newton_step_count: found.newton_steps,
            is_solution: c_int::from(found.is_solution),
            largest_violation: found.largest_violation,
            worst_constraint: found.worst.map_or(Ok(-1), c_count)?,
            capped_count: c_count(found.capped)?,
            primal_residual: residual(|residuals| residuals.primal),
            dual_residual: residual(|residuals| residuals.dual),
            handle_term: found.terms.handles,
            closeness_term: found.terms.closeness,
            fairness_term: found.terms.fairness,
            soft_term: found.terms.soft,
            penalty: found.penalty,
        };
        // SAFETY: the caller vouches for so many bytes.
        unsafe { structs::write(out, size, &told) };
        Ok(())
    }))
}

fn nothing_found() -> Error {
    let reason = "there was no exploration yet: set a hard constraint, a handle or an objective, then solve";
    Error::new(Status::NotInitialised, reason)
}

/// The number of hard constraints in the contradiction that the last exploration found; 0: none. Writes their ids to
/// `ids`, which is null or has room for `nb`; a smaller `nb` than that number writes nothing. Without them the others
/// can be met.
///
/// # Safety
/// `ids` is null or writable for `nb` ints.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_getConflicts(op: *mut ShapeOpSolver, ids: *mut c_int, nb: c_int) -> c_int {
    number(guard_read(op, |solver| {
        let conflicts = solver.found().map_or(&[][..], |found| &found.conflicts);
        if !ids.is_null() && length("nb", nb)? >= conflicts.len() {
            check_pointer("ids", ids.cast_const(), conflicts.len())?;
            let told = conflicts.iter().map(|&id| c_count(id)).collect::<Result<Vec<_>>>()?;
            // SAFETY: the pointer was checked, and the caller vouches for `nb` ints.
            unsafe { write(ids, &told) };
        }
        c_count(conflicts.len())
    }))
}

/// The number of weight classes of the solution in hand, or -1 if it is none: handles, closeness, fairness, and one per
/// type of soft constraints.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_weightClassCount(op: *mut ShapeOpSolver) -> c_int {
    number(guard_read(op, |solver| c_count(solver.weight_classes().len())))
}

/// The name of a weight class: "handles", "closeness", "fairness", or the name of a type. Null if there is no such
/// class. Valid until the library is unloaded.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_weightClassName(op: *mut ShapeOpSolver, index: c_int) -> *const c_char {
    let mut name = ptr::null();
    let _ = guard_read(op, |solver| {
        let classes = solver.weight_classes();
        let class = usize::try_from(index).ok().and_then(|index| classes.get(index)).ok_or_else(|| {
            let reason = format!("{index} is out of range for {} weight classes", classes.len());
            Error::new(Status::IndexOutOfRange, reason).at("index")
        })?;
        name = match class {
            WeightClass::Handles => c"handles".as_ptr(),
            WeightClass::Closeness => c"closeness".as_ptr(),
            WeightClass::Fairness => c"fairness".as_ptr(),
            WeightClass::Soft(type_name) => name_of_type(type_name),
        };
        Ok(())
    });
    name
}

/// How the solution in hand answers a change of each weight: refused unless the last solve ended in one.
///
/// - `points`: null, or where `dp/d ln w` goes, in model units: 3 coordinates of every point for the first class, then
///   for the next, `nb_points` points per class.
/// - `squares`: null, or where the change of every class's squares `w sum |.|^2` per change of the logarithm of a
///   weight goes: a row per weight, a column per class.
/// - `nb_classes`: what `shapeop_weightClassCount` says.
///
/// # Safety
/// Each array is null or writable for its number of values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_getSensitivities(
    op: *mut ShapeOpSolver,
    points: *mut f64,
    nb_points: c_int,
    squares: *mut f64,
    nb_classes: c_int,
) -> shapeop_err {
    code(guard(op, |solver| {
        check_count("nb_classes", nb_classes, solver.weight_classes().len(), "weight classes")?;
        check_count("nb_points", nb_points, solver.points().len(), "points")?;
        let found = solver.sensitivities()?;
        let coordinates: Vec<f64> = found.points.iter().flatten().flat_map(|step| step.to_array()).collect();
        let all: Vec<f64> = found.squares.into_iter().flatten().collect();
        if coordinates.iter().chain(&all).any(|value| !value.is_finite()) {
            let reason = "the solution is so nearly undecided that its sensitivities are not finite";
            return Err(Error::new(Status::InvalidValue, reason));
        }
        if !points.is_null() {
            check_pointer("points", points.cast_const(), coordinates.len())?;
        }
        if !squares.is_null() {
            check_pointer("squares", squares.cast_const(), all.len())?;
        }
        // SAFETY: the pointers were checked, and the caller vouches for so many doubles.
        unsafe {
            write(points, &coordinates);
            write(squares, &all);
        }
        Ok(())
    }))
}
