//! Which machine iterates: the processor, or the graphics card.

use std::borrow::Cow;
use std::ffi::{CString, c_char, c_int, c_uint};
use std::ptr;
use std::sync::{Mutex, PoisonError};

use super::arguments::text;
use super::handles::{self, Handle, ShapeOpSolver};
use super::structs::{self, SizedStruct};
use super::{code, guard, guard_free, guard_named, guard_read, messages, number, shapeop_err};
use crate::error::{Error, Result, Status};
use crate::solver::{AdapterKind, Backend, BackendInfo, BackendOptions, Solver, release_backend};

/// What carries out the iterations of a solve: see `shapeop_setBackend`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_backend {
    /// The default: the processor, in double precision.
    SO_BACKEND_CPU = 0,
    /// The graphics card, in single precision; what a tolerance asks for beyond that the processor finishes.
    SO_BACKEND_GPU = 1,
    /// The card where there is one that is faster on the model at hand, which the first iterations measure; else, and
    /// where anything is missing, the processor.
    SO_BACKEND_AUTOMATIC = 2,
}

/// What kind of adapter it is, the fastest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_adapter_kind {
    /// A card with memory of its own.
    SO_ADAPTER_DISCRETE = 0,
    /// A part of the processor that shares its memory.
    SO_ADAPTER_INTEGRATED = 1,
    /// A card that a virtual machine lends.
    SO_ADAPTER_VIRTUAL = 2,
    /// Not known.
    SO_ADAPTER_OTHER = 3,
    /// A program that behaves like a card: for tests.
    SO_ADAPTER_SOFTWARE = 4,
}

/// The graphics card that iterates, and its limits. The texts are valid as long as the library is loaded.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_backend_info {
    /// In: `sizeof(shapeop_backend_info)`.
    pub struct_size: c_uint,
    /// Its kind.
    pub kind: shapeop_adapter_kind,
    /// Workgroups at most, in one dimension of a run.
    pub group_count: c_uint,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// Bytes of one buffer at most: a whole number.
    pub buffer_bytes: f64,
    /// Bytes of what one binding reaches at most, a whole number; what is larger is split.
    pub binding_bytes: f64,
    /// Its name.
    pub adapter: *const c_char,
    /// The interface it is driven by, such as "vulkan".
    pub api: *const c_char,
    /// The driver, and its version.
    pub driver: *const c_char,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_backend_info {
    const SIZES: &'static [usize] = &[size_of::<shapeop_backend_info>()];
}

/// Bytes from which on doubles skip whole numbers, and far above any card's.
const MOST_BYTES: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;

/// Sets what carries out the iterations of the following solves; `backend` is a `shapeop_backend`, and any other number
/// is refused. `SO_BACKEND_GPU` is refused as `SO_BACKEND_UNAVAILABLE` if there is no graphics card, or if the library
/// was built without the feature `gpu`; `shapeop_lastError` says which. `SO_BACKEND_AUTOMATIC` is never refused.
/// `shapeop_solve_report` says what ran, and `shapeop_backendReason` why. A refused call changes nothing.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_setBackend(op: *mut ShapeOpSolver, backend: c_int) -> shapeop_err {
    code(guard(op, |solver| solver.set_backend(Backend::from_number(backend).map_err(|error| error.at("backend"))?)))
}

/// The `shapeop_backend` that was set, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_getBackend(op: *mut ShapeOpSolver) -> c_int {
    number(guard_read(op, |solver| Ok(told_backend(solver.backend()) as c_int)))
}

/// Chooses the graphics card of the following solves, and how much of it they may use. Without the feature `gpu` it has
/// no effect.
///
/// - `adapter`: a part of its name, of any case; null or empty: any, the fastest kind first.
/// - `binding_bytes`: bytes of one binding at most; 0: what the card allows. Less makes more and smaller runs of a large
///   model.
/// - `memory_bytes`: bytes of the card that the solver may take; 0: no limit.
///
/// Both are whole numbers of at least 0.
///
/// # Safety
/// `adapter` is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_setBackendOptions(
    op: *mut ShapeOpSolver,
    adapter: *const c_char,
    binding_bytes: f64,
    memory_bytes: f64,
) -> shapeop_err {
    code(guard(op, |solver| {
        // SAFETY: the caller vouches for the text.
        let adapter = if adapter.is_null() { Cow::default() } else { unsafe { text("adapter", adapter)? } };
        solver.set_backend_options(&BackendOptions {
            adapter: adapter.into_owned(),
            binding_bytes: bytes("binding_bytes", binding_bytes)?,
            memory_bytes: bytes("memory_bytes", memory_bytes)?,
        });
        Ok(())
    }))
}

/// Describes the graphics card of the solver in `out`, whose `struct_size` must be set. Refused as
/// `SO_BACKEND_UNAVAILABLE` if there is none, or if the library was built without the feature `gpu`. The first call takes
/// a while: it opens the card.
///
/// # Safety
/// `out` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_backendInfo(op: *mut ShapeOpSolver, out: *mut shapeop_backend_info) -> shapeop_err {
    code(guard_read(op, |solver| {
        // SAFETY: the caller vouches for `struct_size`.
        let size = unsafe { structs::size("out", out)? };
        let info = told(&solver.backend_info()?);
        // SAFETY: the caller vouches for `size` bytes.
        unsafe { structs::write(out, size, &info) };
        Ok(())
    }))
}

/// Why the last `shapeop_solveUntil` of the solver ran on the backend that its report names, in words; empty if there was
/// none yet, null if `op` is no solver. The text is the calling thread's own copy, valid until that thread's next call of
/// this function.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_backendReason(op: *mut ShapeOpSolver) -> *const c_char {
    let handle = Handle::new(op);
    // It lies beside the solver, not in it: there is nothing to wait for.
    let reason = guard_named(handle, || {
        handles::find::<Solver>(handle)?;
        Ok(messages::backend_reason(handle))
    });
    reason.map_or(ptr::null(), messages::show_backend)
}

/// Gives the graphics card back, with all memory that solvers have on it: for a host that needs it for something else.
/// Solves that run on it end with `SO_OUTCOME_BACKEND_FAILED`, at the points of their last read-back; later ones open it
/// again. Where there is nothing to give back, it succeeds and does nothing.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_releaseBackend() -> shapeop_err {
    code(guard_free(|| {
        release_backend();
        Ok(())
    }))
}

/// A number of bytes from C.
fn bytes(name: &str, value: f64) -> Result<u64> {
    if (0.0..=MOST_BYTES).contains(&value) && value.fract() == 0.0 {
        return Ok(value as u64);
    }
    let reason = format!("expected a whole number of bytes, at least 0 and at most 2^53, found {value}");
    Err(Error::new(Status::InvalidValue, reason).at(name))
}

fn told(info: &BackendInfo) -> shapeop_backend_info {
    shapeop_backend_info {
        struct_size: 0,
        kind: told_kind(info.kind),
        group_count: info.group_count,
        reserved: 0,
        buffer_bytes: (info.buffer_bytes as f64).min(MOST_BYTES),
        binding_bytes: (info.binding_bytes as f64).min(MOST_BYTES),
        adapter: kept(&info.adapter),
        api: kept(&info.api),
        driver: kept(&info.driver),
    }
}

/// `text` as C text that stays. A machine has few adapters and drivers, so that this keeps little.
fn kept(text: &str) -> *const c_char {
    static TEXTS: Mutex<Vec<CString>> = Mutex::new(Vec::new());
    let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
    let mut texts = TEXTS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = texts.iter().find(|known| **known == text) {
        return known.as_ptr();
    }
    // Where the text lies does not change when the list grows.
    let pointer = text.as_ptr();
    texts.push(text);
    pointer
}

/// A backend as C has it.
pub(super) fn told_backend(backend: Backend) -> shapeop_backend {
    match backend {
        Backend::Cpu => shapeop_backend::SO_BACKEND_CPU,
        Backend::Gpu => shapeop_backend::SO_BACKEND_GPU,
        Backend::Automatic => shapeop_backend::SO_BACKEND_AUTOMATIC,
    }
}

fn told_kind(kind: AdapterKind) -> shapeop_adapter_kind {
    match kind {
        AdapterKind::Discrete => shapeop_adapter_kind::SO_ADAPTER_DISCRETE,
        AdapterKind::Integrated => shapeop_adapter_kind::SO_ADAPTER_INTEGRATED,
        AdapterKind::Virtual => shapeop_adapter_kind::SO_ADAPTER_VIRTUAL,
        AdapterKind::Other => shapeop_adapter_kind::SO_ADAPTER_OTHER,
        AdapterKind::Software => shapeop_adapter_kind::SO_ADAPTER_SOFTWARE,
    }
}

#[cfg(test)]
mod tests {
    use std::ffi::CStr;

    use super::*;

    #[test]
    fn backends_and_kinds_have_the_numbers_of_the_rust_api() {
        for each in [Backend::Cpu, Backend::Gpu, Backend::Automatic] {
            assert_eq!(told_backend(each) as i32, each as i32);
            assert_eq!(Backend::from_number(each as i32).unwrap(), each);
        }
        for each in [
            AdapterKind::Discrete,
            AdapterKind::Integrated,
            AdapterKind::Virtual,
            AdapterKind::Other,
            AdapterKind::Software,
        ] {
            assert_eq!(told_kind(each) as i32, each as i32);
        }
    }

    #[test]
    fn what_is_told_of_a_card_stays_where_it_is() {
        let info = |name: &str| BackendInfo {
            adapter: name.to_owned(),
            kind: AdapterKind::Software,
            api: "vulkan".to_owned(),
            driver: "a\0b".to_owned(),
            buffer_bytes: 1 << 40,
            binding_bytes: u64::MAX,
            group_count: 65_535,
        };
        let first = told(&info("first"));
        let others: Vec<_> = (0..100).map(|i| told(&info(&i.to_string()))).collect();
        // SAFETY: the texts stay.
        let text = |text| unsafe { CStr::from_ptr(text) }.to_str().unwrap();
        assert_eq!([first.adapter, first.api, first.driver].map(text), ["first", "vulkan", "a b"]);
        assert_eq!((first.adapter, first.api), (told(&info("first")).adapter, others[99].api));
        assert_eq!(text(others[99].adapter), "99");
        assert_eq!([first.buffer_bytes, first.binding_bytes], [f64::from(1 << 20) * f64::from(1 << 20), MOST_BYTES]);
    }

    #[test]
    fn bytes_are_whole_numbers() {
        for right in [0.0, 1.0, MOST_BYTES] {
            assert_eq!(bytes("memory_bytes", right).unwrap() as f64, right);
        }
        for wrong in [-1.0, 0.5, f64::NAN, f64::INFINITY, 2.0 * MOST_BYTES] {
            let error = bytes("memory_bytes", wrong).unwrap_err();
            assert!(error.to_string().starts_with("memory_bytes: expected a whole number"), "{error}");
        }
    }
}
