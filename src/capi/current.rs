//! The solves that this thread is inside of, for the time of their progress callbacks.
//!
//! A callback may read its own solver although the solve holds its lock: the solve lends it a shared reference, which
//! is kept here while the callback runs.

use std::cell::RefCell;
use std::ops::Deref;
use std::ptr::NonNull;

use super::handles::Handle;
use crate::solver::Solver;

thread_local! {
    /// Innermost last: a callback may solve another solver.
    static CURRENT: RefCell<Vec<(Handle, NonNull<Solver>)>> = const { RefCell::new(Vec::new()) };
}

/// Lends `solver` to this thread's reading calls on `handle` while `callback` runs.
pub(super) fn lend<T>(handle: Handle, solver: &Solver, callback: impl FnOnce() -> T) -> T {
    struct Return;
    impl Drop for Return {
        fn drop(&mut self) {
            let _ = CURRENT.try_with(|current| current.borrow_mut().pop());
        }
    }
    if CURRENT.try_with(|current| current.borrow_mut().push((handle, NonNull::from(solver)))).is_err() {
        // The thread is ending: reading calls then find the solver busy.
        return callback();
    }
    let _return = Return;
    callback()
}

/// A solver lent to this thread; not sent elsewhere, as it holds a pointer.
pub(super) struct Lent(NonNull<Solver>);

impl Deref for Lent {
    type Target = Solver;

    fn deref(&self) -> &Solver {
        // SAFETY: `lend` put the pointer there from a reference that outlives the callback, and takes it away when the
        // callback ends. Whoever holds a `Lent` runs inside that callback, on its thread: `solver` is the only maker,
        // and its callers drop it before they return to the callback.
        unsafe { self.0.as_ref() }
    }
}

/// The solver of `handle`, if this thread is inside its progress callback.
pub(super) fn solver(handle: Handle) -> Option<Lent> {
    let find = |current: &RefCell<Vec<(Handle, NonNull<Solver>)>>| {
        current.borrow().iter().rev().find(|(own, _)| *own == handle).map(|(_, solver)| Lent(*solver))
    };
    CURRENT.try_with(find).ok().flatten()
}
