//! The C functions of backends, in a library without the feature `gpu` and in one with it.

mod abi;
#[cfg(feature = "gpu")]
mod programs;

use std::ffi::{CString, c_char, c_int};
use std::ops::ControlFlow;
use std::ptr;

use abi::{Abi, WARPED, text, warped};
use glam::DVec3;
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;
use shapeop::solver::{Backend, Report, SolveOptions, Solver};

const CPU: c_int = shapeop_backend::SO_BACKEND_CPU as c_int;
const GPU: c_int = shapeop_backend::SO_BACKEND_GPU as c_int;
const AUTOMATIC: c_int = shapeop_backend::SO_BACKEND_AUTOMATIC as c_int;

/// What a library without the feature says.
#[cfg(not(feature = "gpu"))]
const WITHOUT: &str = "this library was built without the feature \"gpu\"";

/// An empty description of a card that states `size`.
fn empty_info(size: usize) -> shapeop_backend_info {
    shapeop_backend_info {
        struct_size: size as u32,
        kind: shapeop_adapter_kind::SO_ADAPTER_OTHER,
        group_count: 7,
        reserved: 7,
        buffer_bytes: -1.0,
        binding_bytes: -1.0,
        adapter: ptr::null(),
        api: ptr::null(),
        driver: ptr::null(),
    }
}

fn info(abi: &Abi) -> (shapeop_err, shapeop_backend_info) {
    let mut info = empty_info(size_of::<shapeop_backend_info>());
    // SAFETY: it states its size.
    (unsafe { shapeop_backendInfo(abi.0, &mut info) }, info)
}

fn set_options(abi: &Abi, adapter: Option<&str>, binding_bytes: f64, memory_bytes: f64) -> shapeop_err {
    let adapter = adapter.map(|adapter| CString::new(adapter).unwrap());
    let name = adapter.as_ref().map_or(ptr::null::<c_char>(), |adapter| adapter.as_ptr());
    // SAFETY: null or a live text.
    unsafe { shapeop_setBackendOptions(abi.0, name, binding_bytes, memory_bytes) }
}

fn reason(abi: &Abi) -> String {
    text(shapeop_backendReason(abi.0))
}

/// [`warped`] through the Rust API, solved with the default options on `backend`.
fn solved_in_rust(backend: Backend) -> (Vec<f64>, Report) {
    let mut solver = Solver::new();
    solver.set_points(&WARPED.chunks_exact(3).map(DVec3::from_slice).collect::<Vec<_>>()).unwrap();
    solver.add_constraint("Plane", &[0, 1, 2, 3], 1.0).unwrap();
    for point in 0..4 {
        solver.add_constraint("Closeness", &[point], 0.25).unwrap();
    }
    solver.set_backend(backend).unwrap();
    solver.init().unwrap();
    let report = solver.solve_until(&SolveOptions::default(), &mut |_| ControlFlow::Continue(())).unwrap();
    (solver.points().iter().flat_map(DVec3::to_array).collect(), report)
}

/// Solves [`warped`] on the backend of this number; the report, the points and the reason must be those of the Rust API.
fn solve_as_in_rust(number: c_int) -> shapeop_solve_report {
    let abi = warped();
    assert_eq!(reason(&abi), "");
    assert_eq!(shapeop_setBackend(abi.0, number), SO_SUCCESS, "{}", abi.message());
    assert_eq!((shapeop_getBackend(abi.0), abi.init()), (number, 0));
    let (code, found) = abi.solve_until(SolveOptions::default().max_iterations);
    assert_eq!(code, SO_SUCCESS);
    let (points, expected) = solved_in_rust(Backend::from_number(number).unwrap());
    assert_eq!(found.backend as c_int, expected.backend as c_int);
    assert_eq!(
        (found.gpu_iterations, found.read_back_iteration, found.reserved),
        (expected.gpu_iterations, expected.read_back_iteration, 0)
    );
    assert_eq!(reason(&abi), expected.backend_reason);
    assert_eq!(found.iterations, expected.iterations);
    let difference = abi.points().iter().zip(&points).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(difference < 1e-12, "{difference}");
    let seconds = [found.gpu_seconds, found.transfer_seconds];
    assert!(seconds.iter().all(|seconds| seconds.is_finite() && *seconds >= 0.0), "{seconds:?}");
    assert_eq!(found.gpu_iterations > 0, found.backend == shapeop_backend::SO_BACKEND_GPU);
    found
}

#[test]
fn a_new_solver_iterates_on_the_processor_and_says_so() {
    let abi = Abi::new();
    assert_eq!(shapeop_getBackend(abi.0), CPU);
    let found = solve_as_in_rust(CPU);
    assert_eq!(found.backend, shapeop_backend::SO_BACKEND_CPU);
    assert_eq!((found.gpu_iterations, found.gpu_seconds, found.transfer_seconds), (0, 0.0, 0.0));
}

#[test]
fn automatic_is_never_refused() {
    solve_as_in_rust(AUTOMATIC);
}

#[test]
fn numbers_that_are_no_backend_and_bytes_that_are_none_are_refused_and_change_nothing() {
    let abi = warped();
    assert_eq!(shapeop_setBackend(abi.0, AUTOMATIC), SO_SUCCESS);
    for bad in [-1, 3, c_int::MAX, c_int::MIN] {
        assert_eq!(shapeop_setBackend(abi.0, bad), SO_INVALID_VALUE);
        let expected = "backend: expected 0 (CPU), 1 (GPU) or 2 (automatic), found";
        assert!(abi.message().starts_with(expected), "{}", abi.message());
        assert_eq!(shapeop_getBackend(abi.0), AUTOMATIC);
    }
    for bad in [-1.0, 0.5, f64::NAN, f64::INFINITY, 1e30] {
        for (name, bytes) in [("binding_bytes", [bad, 0.0]), ("memory_bytes", [0.0, bad])] {
            assert_eq!(set_options(&abi, None, bytes[0], bytes[1]), SO_INVALID_VALUE);
            assert!(abi.message().starts_with(&format!("{name}: expected a whole number")), "{}", abi.message());
        }
    }
    for adapter in [None, Some(""), Some("a card")] {
        assert_eq!(set_options(&abi, adapter, 4096.0, 1e9), SO_SUCCESS, "{}", abi.message());
    }
}

#[test]
fn a_description_states_its_size() {
    let abi = Abi::new();
    for size in [0, 4, size_of::<shapeop_backend_info>() - 4, 4104] {
        let mut wrong = empty_info(size);
        // SAFETY: the size is refused.
        assert_eq!(unsafe { shapeop_backendInfo(abi.0, &mut wrong) }, SO_INVALID_VALUE, "size {size}");
        assert!(abi.message().starts_with("out->struct_size: expected"), "{}", abi.message());
        assert_eq!((wrong.group_count, wrong.buffer_bytes), (7, -1.0));
    }
    // SAFETY: null is allowed.
    assert_eq!(unsafe { shapeop_backendInfo(abi.0, ptr::null_mut()) }, SO_NULL_POINTER);
}

#[test]
#[cfg(not(feature = "gpu"))]
fn without_the_feature_every_function_exists_and_says_so() {
    let abi = warped();
    assert_eq!((shapeop_setBackend(abi.0, GPU), abi.message().as_str()), (SO_BACKEND_UNAVAILABLE, WITHOUT));
    assert_eq!(shapeop_lastErrorCode(abi.0), SO_BACKEND_UNAVAILABLE);
    assert_eq!(shapeop_getBackend(abi.0), CPU, "a refused call changes nothing");
    let (code, untouched) = info(&abi);
    assert_eq!((code, abi.message().as_str()), (SO_BACKEND_UNAVAILABLE, WITHOUT));
    assert_eq!((untouched.group_count, untouched.buffer_bytes), (7, -1.0));
    assert!(untouched.adapter.is_null());
    // There is nothing to give back.
    assert_eq!((shapeop_releaseBackend(), abi::last_error(ptr::null_mut())), (SO_SUCCESS, String::new()));
    assert_eq!(solve_as_in_rust(AUTOMATIC).backend, shapeop_backend::SO_BACKEND_CPU);
    let means = text(shapeop_errorText(SO_BACKEND_UNAVAILABLE as c_int));
    assert_eq!(means, "there is no graphics card to solve on, or not enough of it");
}

/// One test, as it gives the card back that others would run on.
#[test]
#[cfg(feature = "gpu")]
fn with_the_feature_a_card_is_described_solves_and_is_given_back() {
    use shapeop::solver::{BackendOptions, backend_info};

    let abi = warped();
    let expected = match backend_info(&BackendOptions::default()) {
        Ok(expected) => expected,
        Err(error) => {
            assert_eq!((shapeop_setBackend(abi.0, GPU), abi.message()), (SO_BACKEND_UNAVAILABLE, error.to_string()));
            return programs::leave_out(&format!("the C functions on a graphics card: {error}"));
        }
    };
    for round in 0..2 {
        let (code, found) = info(&abi);
        assert_eq!(code, SO_SUCCESS, "{}", abi.message());
        assert_eq!(
            [found.adapter, found.api, found.driver].map(text),
            [expected.adapter.clone(), expected.api.clone(), expected.driver.clone()]
        );
        assert_eq!((found.kind as i32, found.group_count), (expected.kind as i32, expected.group_count));
        assert_eq!(found.binding_bytes, expected.binding_bytes as f64);
        solve_as_in_rust(GPU);
        assert_eq!(shapeop_releaseBackend(), SO_SUCCESS, "round {round}");
    }
    // No card has this name; the message names those that there are.
    assert_eq!(set_options(&abi, Some("no such card"), 0.0, 0.0), SO_SUCCESS);
    assert_eq!(shapeop_setBackend(abi.0, GPU), SO_BACKEND_UNAVAILABLE);
    assert!(abi.message().contains(&expected.adapter), "{}", abi.message());
    // A part of the name in another case, and less of each binding than the card allows.
    let part: String = expected.adapter.to_uppercase().chars().take(4).collect();
    assert_eq!(set_options(&abi, Some(&part), 65_536.0, 0.0), SO_SUCCESS);
    let (code, found) = info(&abi);
    assert_eq!((code, found.binding_bytes), (SO_SUCCESS, 65_536.0), "{}", abi.message());
}
