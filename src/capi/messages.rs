//! What the last call said, for `shapeop_lastError`.
//!
//! Every call leaves its message, an empty one if it succeeded, with its thread, and with its solver if it got hold of
//! it. So a caller of a function without a return value learns from an empty text that it was carried out; a thread
//! reads what another thread's call on a solver left; and a refusal as busy stays with the thread that was refused.

use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::ptr;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::LocalKey;

use super::handles::{self, Handle};
use crate::error::{Error, Status};

/// The message of a call; empty if it succeeded.
#[derive(Clone, Default)]
pub(super) struct Message {
    /// Later calls have greater numbers.
    order: u64,
    /// Why it was refused, if it was.
    status: Option<Status>,
    text: String,
}

impl Message {
    fn new(error: Option<&Error>) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        let text = error.map(Error::to_string).unwrap_or_default();
        Self { order: NEXT.fetch_add(1, Ordering::Relaxed), status: error.map(Error::status), text }
    }
}

thread_local! {
    /// The last call of this thread: the handle that it named, and its message.
    static LAST: RefCell<(Handle, Message)> = RefCell::new((Handle::NONE, Message::default()));
    /// The text that `shapeop_lastError` handed out.
    static SHOWN: RefCell<CString> = RefCell::default();
    /// The reason for a backend that was handed out last.
    static SHOWN_BACKEND: RefCell<CString> = RefCell::default();
    /// The problem that was handed out last.
    static SHOWN_PROBLEM: RefCell<CString> = RefCell::default();
    /// The text about surfaces that was handed out last.
    static SHOWN_CANAL: RefCell<CString> = RefCell::default();
    /// The text about ruled strips that was handed out last.
    static SHOWN_RULED: RefCell<CString> = RefCell::default();
    /// The text about snakes that was handed out last.
    static SHOWN_SNAKE: RefCell<CString> = RefCell::default();
}

/// Keeps the message of a call with its solver.
pub(super) fn keep(of_solver: &Mutex<Message>, error: Option<&Error>) {
    *of_solver.lock().unwrap_or_else(PoisonError::into_inner) = Message::new(error);
}

/// Keeps the message of a call on `handle` with this thread.
pub(super) fn keep_for_thread(handle: Handle, error: Option<&Error>) {
    let message = Message::new(error);
    // A thread that is ending keeps nothing.
    let _ = LAST.try_with(|last| *last.borrow_mut() = (handle, message));
}

/// Replaces the empty message of a successful call on `handle` by what its caller should know.
pub(super) fn keep_note(handle: Handle, note: &Error) {
    if let Some(slot) = handles::find_any(handle) {
        keep(&slot.message, Some(note));
    }
    keep_for_thread(handle, Some(note));
}

/// Why the last call on `handle` was refused; this thread's last call if `handle` names no solver. Another thread's
/// success does not hide a refusal of this one.
fn last(handle: Handle) -> Message {
    let of_thread = LAST.try_with(|last| last.borrow().clone());
    let (own_handle, of_thread) = of_thread.unwrap_or((Handle::NONE, Message::default()));
    let Some(slot) = handles::find_any(handle) else { return of_thread };
    let of_solver = slot.message.lock().unwrap_or_else(PoisonError::into_inner);
    let is_own_newer = of_solver.text.is_empty() || of_thread.order > of_solver.order;
    if own_handle == handle && is_own_newer { of_thread } else { of_solver.clone() }
}

/// The status of [`last`]; `None` if that call succeeded.
pub(super) fn last_status(handle: Handle) -> Option<Status> {
    last(handle).status
}

/// [`last`] as C text that stays valid until this thread's next call.
pub(super) fn show_last(handle: Handle) -> *const c_char {
    show(&SHOWN, last(handle).text.replace('\0', " ")).unwrap_or(c"".as_ptr())
}

/// Keeps why a solve on `handle` ran where it did.
pub(super) fn keep_backend_reason(handle: Handle, reason: &str) {
    if let Some(slot) = handles::find_any(handle) {
        reason.clone_into(&mut slot.backend_reason.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

/// What [`keep_backend_reason`] kept last.
pub(super) fn backend_reason(handle: Handle) -> String {
    let copy = |text: &Mutex<String>| text.lock().unwrap_or_else(PoisonError::into_inner).clone();
    handles::find_any(handle).map(|slot| copy(&slot.backend_reason)).unwrap_or_default()
}

/// The reason for a backend as C text that stays valid until this thread's next call for one.
pub(super) fn show_backend(text: String) -> *const c_char {
    show(&SHOWN_BACKEND, text.replace('\0', " ")).unwrap_or(ptr::null())
}

/// The JSON form of a problem as C text that stays valid until this thread's next call; JSON holds no zero.
pub(super) fn show_problem(json: String) -> *const c_char {
    show(&SHOWN_PROBLEM, json).unwrap_or(ptr::null())
}

/// A text about surfaces as C text that stays valid until this thread's next call for one.
pub(super) fn show_canal(text: String) -> *const c_char {
    show(&SHOWN_CANAL, text).unwrap_or(ptr::null())
}

/// A text about ruled strips as C text that stays valid until this thread's next call for one.
pub(super) fn show_ruled(text: String) -> *const c_char {
    show(&SHOWN_RULED, text).unwrap_or(ptr::null())
}

/// A text about snakes as C text that stays valid until this thread's next call for one.
pub(super) fn show_snake(text: String) -> *const c_char {
    show(&SHOWN_SNAKE, text).unwrap_or(ptr::null())
}

/// Keeps `text` in a place of this thread; `None` if the thread is ending.
fn show(place: &'static LocalKey<RefCell<CString>>, text: String) -> Option<*const c_char> {
    let text = CString::new(text).unwrap_or_default();
    let show = |shown: &RefCell<CString>| {
        *shown.borrow_mut() = text;
        shown.borrow().as_ptr()
    };
    place.try_with(show).ok()
}
