//! What holds of any sequence of calls on objects that handles name.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ptr;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};

use super::last_error;

/// How often each kind of call was carried out.
pub type Done = BTreeMap<String, usize>;

pub fn check(is_right: bool, what: &str) -> Result<(), TestCaseError> {
    if is_right { Ok(()) } else { Err(TestCaseError::fail(what.to_owned())) }
}

/// Makes the calls of a sequence, each on one of the handles. `make` says whether a call was carried out and what it wrote, zeros
/// where it wrote nothing; `picture` is an object as a caller sees it, and `is_finite` whether its numbers are.
pub fn carry_out<H: Copy, C: Debug, P: PartialEq>(
    handles: &[H],
    sequence: &[(usize, C)],
    make: impl Fn(H, &C) -> (bool, Vec<f64>),
    picture: impl Fn(H) -> P,
    is_finite: impl Fn(&P) -> bool,
    done: &mut Done,
) -> Result<(), TestCaseError> {
    for (which, call) in sequence {
        let handle = handles[which % handles.len()];
        if std::env::var_os("SHAPEOP_FUZZ_TRACE").is_some() {
            eprintln!("{call:?}");
        }
        let before = picture(handle);
        let (is_done, room) = make(handle, call);
        let message = last_error(ptr::null_mut());
        let after = picture(handle);
        let kind = format!("{call:?}").split('(').next().unwrap_or_default().to_owned();
        *done.entry(kind).or_default() += usize::from(is_done);
        check(is_done == message.is_empty(), &format!("{call:?}: {is_done}, but {message:?}"))?;
        check(!message.contains("inside the library"), &format!("{call:?}: {message}"))?;
        check(room.iter().all(|number| number.is_finite()), &format!("{call:?} handed out {room:?}"))?;
        check(is_finite(&after), &format!("{call:?} left numbers that are not finite"))?;
        if !is_done {
            check(before == after, &format!("{call:?} was refused and changed the object"))?;
            check(room.iter().all(|number| *number == 0.0), &format!("{call:?} was refused and wrote {room:?}"))?;
        }
    }
    Ok(())
}

/// Runs so many random sequences of up to 24 calls, each with the number of a handle.
pub fn run_sequences<C: Debug>(
    count: u32,
    seed: u8,
    call: impl Strategy<Value = C>,
    run: impl Fn(&[(usize, C)], &mut Done) -> Result<(), TestCaseError>,
) -> Done {
    let config = Config { cases: count, failure_persistence: None, max_shrink_iters: 200, ..Config::default() };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]);
    let sequences = proptest::collection::vec((0..16_usize, call), 1..25);
    let done = RefCell::new(Done::new());
    let run = |sequence: Vec<(usize, C)>| run(&sequence, &mut done.borrow_mut());
    TestRunner::new_with_rng(config, rng).run(&sequences, run).unwrap();
    done.into_inner()
}
