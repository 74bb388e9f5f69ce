//! Solvers: creating, deleting, initialising, solving.

use std::ffi::{c_int, c_uint};

use super::handles::{self, Handle, Object, ShapeOpSolver};
use super::{arguments, flag, guard, guard_named};
use crate::error::{Error, Result, Status};
use crate::problem::Acceleration;
use crate::solver::{LinearSolver, Solver};

/// Threads at most: far above what any problem gains from, and far below what would exhaust a machine.
const MOST_THREADS: usize = 1024;

/// Creates a solver without points. Null if 65536 solvers exist. Delete it with `shapeop_delete`.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_create() -> *mut ShapeOpSolver {
    super::guard_free(|| handles::create(Object::Solver(Box::default()))).map_or(std::ptr::null_mut(), Handle::as_op)
}

/// Deletes a solver and all it holds. Null does nothing; a busy solver is left alone, as is whatever is no solver.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_delete(op: *mut ShapeOpSolver) {
    if !op.is_null() {
        let handle = Handle::new(op);
        let _ = guard_named(handle, || handles::delete::<Solver>(handle));
    }
}

/// Prepares for static solving from the current points: masses, damping and time step are 1, velocities start at zero.
/// May be called again at any time. Returns 0, or 1 if the system cannot be factorised (numbers too large).
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_init(op: *mut ShapeOpSolver) -> c_int {
    flag(guard(op, |solver| solver.init()))
}

/// Prepares for dynamic solving from the current points with zero velocities. `masses` is that of every point, above 0;
/// `damping` the factor on velocities after each step, at least 0; `timestep` is above 0. Returns 0, or 1 if one of
/// them is not so or the system cannot be factorised; the solver is then as before.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_initDynamic(op: *mut ShapeOpSolver, masses: f64, damping: f64, timestep: f64) -> c_int {
    flag(guard(op, |solver| solver.init_dynamic(masses, damping, timestep)))
}

/// Static: so many local/global iterations from the current points. Dynamic: one time step with so many iterations.
/// They are the plain ones unless `shapeop_setAcceleration` asked for others.
/// Changes since the last call, of constraints too, take effect. Returns 0, or 1 with the points as before if the
/// solver was not initialised, if a force acts along a motion that no constraint resists, or if the numbers became too
/// large.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_solve(op: *mut ShapeOpSolver, iteration: c_uint) -> c_int {
    flag(guard(op, |solver| solver.solve(iteration)))
}

/// Changes the time step of the following steps, but not the inertia, which keeps the step of `shapeop_initDynamic`.
/// Before initialisation it has no effect. A step that is not finite and above 0 changes nothing.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_setTimeStep(op: *mut ShapeOpSolver, timestep: f64) {
    let _ = guard(op, |solver| solver.set_timestep(timestep));
}

/// Changes the damping of the following steps. Before initialisation it has no effect. A damping that is not finite and
/// at least 0 changes nothing.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_setDamping(op: *mut ShapeOpSolver, damping: f64) {
    let _ = guard(op, |solver| solver.set_damping(damping));
}

/// Sets the number of threads for large problems, at most 1024; 0, the default: as many as the machine has. The results
/// are the same bits for any number.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_setThreadCount(op: *mut ShapeOpSolver, nb_threads: c_int) -> super::shapeop_err {
    super::code(guard(op, |solver| {
        solver.set_thread_count(thread_count(nb_threads)?);
        Ok(())
    }))
}

/// How iterations are accelerated: see `shapeop_setAcceleration`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_acceleration {
    /// Not at all: every iteration is one local and one global step.
    SO_ACCELERATION_NONE = 0,
    /// Safeguarded Anderson acceleration.
    SO_ACCELERATION_ANDERSON = 1,
    /// L-BFGS with the matrix of the global step as initial Hessian, and a line search.
    SO_ACCELERATION_QUASI_NEWTON = 2,
    /// The default: none in `shapeop_solve`, quasi-Newton in `shapeop_solveUntil`.
    SO_ACCELERATION_AUTOMATIC = 3,
}

/// Sets how the following solves are accelerated: `kind` is a `shapeop_acceleration`, `memory` the number of iterations
/// that are remembered for it, at most 64; 0: the method's default. Accelerated solves take far fewer iterations to the
/// same energy, and an accelerated step never raises it; the iterates are others than without. Every call, and so every
/// time step, begins anew: nothing is remembered from call to call. With a pressure or a normal force on faces all iterations
/// are plain, whatever is set. A refused call changes nothing.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_setAcceleration(op: *mut ShapeOpSolver, kind: c_int, memory: c_uint) -> super::shapeop_err {
    super::code(guard(op, |solver| solver.set_acceleration(acceleration(kind)?, memory)))
}

fn acceleration(kind: c_int) -> Result<Acceleration> {
    const ALL: [(shapeop_acceleration, Acceleration); 4] = [
        (shapeop_acceleration::SO_ACCELERATION_NONE, Acceleration::None),
        (shapeop_acceleration::SO_ACCELERATION_ANDERSON, Acceleration::Anderson),
        (shapeop_acceleration::SO_ACCELERATION_QUASI_NEWTON, Acceleration::QuasiNewton),
        (shapeop_acceleration::SO_ACCELERATION_AUTOMATIC, Acceleration::Automatic),
    ];
    let found = ALL.iter().find(|(number, _)| *number as c_int == kind);
    found.map(|(_, acceleration)| *acceleration).ok_or_else(|| {
        let reason = format!("expected a shapeop_acceleration, 0 to {}, found {kind}", ALL.len() - 1);
        Error::new(Status::InvalidValue, reason).at("kind")
    })
}

/// How the linear system of an iteration is solved: see `shapeop_setLinearSolver`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_linear_solver {
    /// The default: a factor if it is predicted to take at most 2 GB while it is computed, else conjugate gradients.
    SO_LINEAR_SOLVER_AUTOMATIC = 0,
    /// A Cholesky factor, computed once and used in every iteration.
    SO_LINEAR_SOLVER_DIRECT = 1,
    /// Conjugate gradients, preconditioned by multigrid, from the current points: far less memory, and no factor to compute.
    SO_LINEAR_SOLVER_CONJUGATE_GRADIENTS = 2,
}

/// Sets how the linear system of an iteration is solved, from the next solve on; `linear_solver` is a
/// `shapeop_linear_solver`, and any other number is refused. The iterates agree to about 1e-10 of the model's size.
/// `shapeop_solve_report` says what ran.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_setLinearSolver(op: *mut ShapeOpSolver, linear_solver: c_int) -> super::shapeop_err {
    super::code(guard(op, |solver| {
        solver.set_linear_solver(LinearSolver::from_number(linear_solver).map_err(|error| error.at("linear_solver"))?);
        Ok(())
    }))
}

fn thread_count(nb_threads: c_int) -> Result<usize> {
    let count = arguments::length("nb_threads", nb_threads)?;
    if count <= MOST_THREADS {
        return Ok(count);
    }
    let reason = format!("expected at most {MOST_THREADS}, found {nb_threads}");
    Err(Error::new(Status::InvalidValue, reason).at("nb_threads"))
}
