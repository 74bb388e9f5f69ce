//! Solving with stopping rules, and what there is to say of the current points: energy and violations.

use std::ffi::{c_int, c_uint, c_void};
use std::mem::offset_of;
use std::ops::ControlFlow;

use super::arguments::{check_pointer, write};
use super::backend::{shapeop_backend, told_backend};
use super::handles::{Handle, ShapeOpSolver};
use super::points::check_count;
use super::solver::shapeop_linear_solver;
use super::structs::{self, SizedStruct};
use super::{code, current, guard, guard_free, guard_read, messages, shapeop_err};
use crate::error::{Error, Result, Status};
use crate::solver::{LinearSolver, Outcome, Progress, Report, SolveOptions};

/// When to stop. Start from `shapeop_defaultSolveOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_solve_options {
    /// In: `sizeof(shapeop_solve_options)`.
    pub struct_size: c_uint,
    /// Iterations at most; in dynamic mode within the one time step that a call makes. Default 1000.
    pub max_iterations: c_uint,
    /// Stop when the largest move of a point in an iteration, relative to the bounding-box diagonal, is below this; 0
    /// never stops that way. Finite, at least 0. Default 1e-6.
    pub tolerance: f64,
    /// Stop after so many seconds, looked at once per iteration; 0, the default: no limit. Finite, at least 0.
    pub time_budget_seconds: f64,
}

/// Why a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_outcome {
    /// The largest move fell below the tolerance.
    SO_OUTCOME_CONVERGED = 0,
    /// The iterations were used up.
    SO_OUTCOME_ITERATION_LIMIT = 1,
    /// The time was used up.
    SO_OUTCOME_TIME_BUDGET = 2,
    /// The callback said so.
    SO_OUTCOME_CANCELLED = 3,
    /// Neither the energy nor the largest move fell any more.
    SO_OUTCOME_STALLED = 4,
    /// A force acts along a motion that no constraint resists, and the points did not move. `shapeop_lastError` says
    /// which.
    SO_OUTCOME_UNBOUNDED = 5,
    /// Hard constraints contradict each other; `shapeop_getConflicts` names a small set, and the points meet the others.
    SO_OUTCOME_INFEASIBLE = 6,
    /// The graphics card was lost or refused work; the points are those of the last read-back. `shapeop_lastError` says
    /// what happened.
    SO_OUTCOME_BACKEND_FAILED = 7,
}

/// What a solve found.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_solve_report {
    /// In: `sizeof(shapeop_solve_report)`.
    pub struct_size: c_uint,
    /// Why it ended.
    pub outcome: shapeop_outcome,
    /// Iterations made.
    pub iterations: c_uint,
    /// Points that no constraint of a weight above 0 holds.
    pub unconstrained_count: c_uint,
    /// The energy at the points that the iterations started from.
    pub energy_before: f64,
    /// The energy at the points that were reached.
    pub energy_after: f64,
    /// The largest move of a point in the last iteration, relative to the bounding-box diagonal.
    pub largest_move: f64,
    /// Seconds spent on ordering and symbolic analysis when the system in use was made.
    pub analysis_seconds: f64,
    /// Seconds spent on the factorisation when the system in use was made.
    pub factorisation_seconds: f64,
    /// Seconds spent on projections in this call.
    pub local_seconds: f64,
    /// Seconds spent on right-hand sides, linear solves and acceleration in this call.
    pub global_seconds: f64,
    /// Evaluations made: a local step at points that were tried, whether they were kept or not, and the global step from
    /// there where they were. Without acceleration one per iteration; the first local step is not counted.
    pub evaluations: c_uint,
    /// Evaluations of points whose energy was higher than before, or not as much lower as the line search asks for.
    pub rejected_energy_rose: c_uint,
    /// Evaluations of points whose energy was not finite.
    pub rejected_not_finite: c_uint,
    /// Iterations in which acceleration left out a part of its history as ill-conditioned.
    pub rejected_ill_conditioned: c_uint,
    /// Directions of acceleration that were not tried, as the energy would rise along them.
    pub rejected_not_descent: c_uint,
    /// Directions of acceleration that were given up, as no step along them was accepted: the line search failed.
    pub rejected_line_search: c_uint,
    /// Orderings (with the analysis of the matrix's pattern) made since the solver was created.
    pub ordering_count: c_uint,
    /// Numeric factorisations made since the solver was created.
    pub factorisation_count: c_uint,
    /// How linear systems were solved: `SO_LINEAR_SOLVER_DIRECT` or `SO_LINEAR_SOLVER_CONJUGATE_GRADIENTS`.
    pub linear_solver: shapeop_linear_solver,
    /// Iterations of conjugate gradients in all linear solves of this call; 0 with a factor.
    pub linear_iterations: c_uint,
    /// `SO_BACKEND_GPU` if the graphics card made any of the iterations, else `SO_BACKEND_CPU`. `shapeop_backendReason`
    /// says why.
    pub backend: shapeop_backend,
    /// Those of the iterations that the card made.
    pub gpu_iterations: c_uint,
    /// The iteration after which points were read back from the card last.
    pub read_back_iteration: c_uint,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// Seconds in which the card worked.
    pub gpu_seconds: f64,
    /// Seconds in which points went to the card and back.
    pub transfer_seconds: f64,
}

/// What a progress callback is told after every iteration.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_progress {
    /// `sizeof(shapeop_progress)` in the library; fields may be added at the end.
    pub struct_size: c_uint,
    /// Iterations made so far, from 1.
    pub iteration: c_uint,
    /// The energy at the current points.
    pub energy: f64,
    /// The largest move of a point in this iteration, relative to the bounding-box diagonal.
    pub largest_move: f64,
}

/// Called after every iteration, on the thread that called `shapeop_solveUntil`. Returns 0 to go on; anything else ends
/// the solve, and what was reached is kept. It must return: no exception, no `longjmp`.
pub type shapeop_progress_callback =
    Option<unsafe extern "C" fn(progress: *const shapeop_progress, user: *mut c_void) -> c_int>;

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_solve_options {
    const SIZES: &'static [usize] =
        &[offset_of!(Self, tolerance), offset_of!(Self, time_budget_seconds), size_of::<shapeop_solve_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_solve_report {
    const SIZES: &'static [usize] = &[
        offset_of!(Self, energy_before),
        offset_of!(Self, energy_after),
        offset_of!(Self, largest_move),
        offset_of!(Self, analysis_seconds),
        offset_of!(Self, factorisation_seconds),
        offset_of!(Self, local_seconds),
        offset_of!(Self, global_seconds),
        offset_of!(Self, evaluations),
        offset_of!(Self, linear_solver),
        offset_of!(Self, backend),
        size_of::<shapeop_solve_report>(),
    ];
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_defaultSolveOptions(options: *mut shapeop_solve_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// Iterates until `options` (null: the defaults) say to stop; in dynamic mode within one time step. Iterations are
/// accelerated unless `shapeop_setAcceleration` said otherwise. `progress` may be null; it is called with `user` after
/// every iteration. While it runs, reading calls on `op` from it answer with the current iterate, and all other calls
/// are refused as busy. `report` is null, or its `struct_size` is set; it is written on success.
///
/// A force along a motion that no constraint resists is the outcome `SO_OUTCOME_UNBOUNDED` of a successful call, a graphics
/// card that was lost or refused work the outcome `SO_OUTCOME_BACKEND_FAILED`; `shapeop_lastError` says more.
///
/// # Safety
/// `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so many bytes.
/// `progress` is null or a function of that signature. They do not overlap, and nobody changes them during the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_solveUntil(
    op: *mut ShapeOpSolver,
    options: *const shapeop_solve_options,
    progress: shapeop_progress_callback,
    user: *mut c_void,
    report: *mut shapeop_solve_report,
) -> shapeop_err {
    let handle = Handle::new(op);
    let mut note = None;
    let result = code(guard(op, |solver| {
        let options = if options.is_null() {
            default_options()
        } else {
            // SAFETY: the caller vouches for so many bytes as `struct_size` says; numbers are valid for any bytes.
            unsafe { structs::read("options", options, default_options())? }
        };
        // SAFETY: the caller vouches for `struct_size`.
        let report_size = if report.is_null() { 0 } else { unsafe { structs::size("report", report)? } };
        let options = SolveOptions {
            max_iterations: options.max_iterations,
            tolerance: options.tolerance,
            time_budget_seconds: options.time_budget_seconds,
        };
        let mut call_back = |now: &Progress<'_>| {
            let Some(progress) = progress else { return ControlFlow::Continue(()) };
            let told = shapeop_progress {
                struct_size: size_of::<shapeop_progress>() as c_uint,
                iteration: now.iteration,
                energy: now.energy,
                largest_move: now.largest_move,
            };
            // SAFETY: the caller vouches for the function; `told` lives until it returns.
            match current::lend(handle, now.solver, || unsafe { progress(&raw const told, user) }) {
                0 => ControlFlow::Continue(()),
                _ => ControlFlow::Break(()),
            }
        };
        let found = solver.solve_until(&options, &mut call_back)?;
        if !report.is_null() {
            let told = told(&found, solver.unconstrained_count());
            // SAFETY: the caller vouches for so many bytes.
            unsafe { structs::write(report, report_size, &told) };
        }
        messages::keep_backend_reason(handle, &found.backend_reason);
        let status = match found.outcome {
            Outcome::Unbounded => Some(Status::Unbounded),
            Outcome::BackendFailed => Some(Status::BackendFailed),
            _ => None,
        };
        note = status.map(|status| Error::new(status, found.message));
        Ok(())
    }));
    if let Some(note) = note {
        messages::keep_note(handle, &note);
    }
    result
}

/// Writes the energy at the current points to `out`: half the sum of the weighted squared distances to the projections,
/// in static mode minus the potential of the forces, in dynamic mode plus the inertia of the last step.
///
/// # Safety
/// `out` is null or writable for one double.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_energy(op: *mut ShapeOpSolver, out: *mut f64) -> shapeop_err {
    code(guard_read(op, |solver| {
        check_pointer("out", out, 1)?;
        let energy = finite_answer(solver.energy(), || "the energy".to_owned())?;
        // SAFETY: the pointer was checked, and the caller vouches for one double.
        unsafe { write(out, &[energy]) };
        Ok(())
    }))
}

/// Writes the violation of every constraint id at the current points to `out`, each in its type's unit; 0 for removed
/// ones. `nb` must be `shapeop_constraintCount`; otherwise nothing is written.
///
/// # Safety
/// `out` is null or writable for `nb` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_getViolations(op: *mut ShapeOpSolver, out: *mut f64, nb: c_int) -> shapeop_err {
    code(guard_read(op, |solver| {
        check_count("nb", nb, solver.constraint_count(), "constraint ids")?;
        check_pointer("out", out, solver.constraint_count())?;
        let violations = solver.violations();
        for (id, &violation) in violations.iter().enumerate() {
            finite_answer(violation, || format!("the violation of constraint {id}"))?;
        }
        // SAFETY: the pointer was checked, and the caller vouches for `nb` doubles, one per id.
        unsafe { write(out, &violations) };
        Ok(())
    }))
}

/// No number that is not finite leaves the library.
fn finite_answer(value: f64, name: impl Fn() -> String) -> Result<f64> {
    if value.is_finite() {
        return Ok(value);
    }
    let reason = format!("coordinates or weights are so large that {} is not finite", name());
    Err(Error::new(Status::InvalidValue, reason))
}

fn default_options() -> shapeop_solve_options {
    let SolveOptions { max_iterations, tolerance, time_budget_seconds } = SolveOptions::default();
    shapeop_solve_options { struct_size: 0, max_iterations, tolerance, time_budget_seconds }
}

fn told(report: &Report, unconstrained_count: usize) -> shapeop_solve_report {
    shapeop_solve_report {
        struct_size: 0,
        outcome: outcome(report.outcome),
        iterations: report.iterations,
        unconstrained_count: unconstrained_count as c_uint,
        energy_before: report.energy_before,
        energy_after: report.energy_after,
        largest_move: report.largest_move,
        analysis_seconds: report.analysis_seconds,
        factorisation_seconds: report.factorisation_seconds,
        local_seconds: report.local_seconds,
        global_seconds: report.global_seconds,
        evaluations: report.evaluations,
        rejected_energy_rose: report.rejections.energy_rose,
        rejected_not_finite: report.rejections.not_finite,
        rejected_ill_conditioned: report.rejections.ill_conditioned,
        rejected_not_descent: report.rejections.not_descent,
        rejected_line_search: report.rejections.line_search,
        ordering_count: report.ordering_count,
        factorisation_count: report.factorisation_count,
        linear_solver: linear_solver(report.linear_solver),
        linear_iterations: report.linear_iterations,
        backend: told_backend(report.backend),
        gpu_iterations: report.gpu_iterations,
        read_back_iteration: report.read_back_iteration,
        reserved: 0,
        gpu_seconds: report.gpu_seconds,
        transfer_seconds: report.transfer_seconds,
    }
}

fn linear_solver(used: LinearSolver) -> shapeop_linear_solver {
    match used {
        LinearSolver::Automatic => shapeop_linear_solver::SO_LINEAR_SOLVER_AUTOMATIC,
        LinearSolver::Direct => shapeop_linear_solver::SO_LINEAR_SOLVER_DIRECT,
        LinearSolver::ConjugateGradients => shapeop_linear_solver::SO_LINEAR_SOLVER_CONJUGATE_GRADIENTS,
    }
}

fn outcome(outcome: Outcome) -> shapeop_outcome {
    match outcome {
        Outcome::Converged => shapeop_outcome::SO_OUTCOME_CONVERGED,
        Outcome::IterationLimit => shapeop_outcome::SO_OUTCOME_ITERATION_LIMIT,
        Outcome::TimeBudget => shapeop_outcome::SO_OUTCOME_TIME_BUDGET,
        Outcome::Cancelled => shapeop_outcome::SO_OUTCOME_CANCELLED,
        Outcome::Stalled => shapeop_outcome::SO_OUTCOME_STALLED,
        Outcome::Unbounded => shapeop_outcome::SO_OUTCOME_UNBOUNDED,
        Outcome::Infeasible => shapeop_outcome::SO_OUTCOME_INFEASIBLE,
        Outcome::BackendFailed => shapeop_outcome::SO_OUTCOME_BACKEND_FAILED,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outcomes_have_the_numbers_of_the_rust_api() {
        for each in [
            Outcome::Converged,
            Outcome::IterationLimit,
            Outcome::TimeBudget,
            Outcome::Cancelled,
            Outcome::Stalled,
            Outcome::Unbounded,
            Outcome::Infeasible,
            Outcome::BackendFailed,
        ] {
            assert_eq!(outcome(each) as i32, each as i32);
        }
    }

    #[test]
    fn linear_solvers_have_the_numbers_of_the_rust_api() {
        for each in [LinearSolver::Automatic, LinearSolver::Direct, LinearSolver::ConjugateGradients] {
            assert_eq!(linear_solver(each) as i32, each as i32);
            assert_eq!(LinearSolver::from_number(each as i32).unwrap(), each);
        }
    }
}
