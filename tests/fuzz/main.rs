//! Random sequences of C calls with random arguments: valid, stale, null, huge, negative, not finite. None crashes, no
//! call hands out a number that is not finite, and a refused one changes nothing and says why.
//!
//! `SHAPEOP_FUZZ_SEQUENCES` sets the number of sequences, `SHAPEOP_FUZZ_SEED` the seed. A sequence that ends the
//! process is found by running the printed seed again with `SHAPEOP_FUZZ_TRACE=1`, which prints every call before it is
//! made.

mod calls;
mod canal;
mod canal_shapes;
mod objects;
mod ruled;
mod snakes;

use std::ffi::{CString, c_int, c_void};
use std::ptr;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

use calls::{Array, Call, MOST_POINTS, Op, Options, call};

/// Sequences of the ordinary run.
const SEQUENCES: u32 = 6_000;

/// Calls of a sequence at most.
const LONGEST_SEQUENCE: usize = 60;

/// Bytes for a struct of any size, aligned as it is, that states this size.
#[repr(C, align(16))]
struct Room([u8; 8192]);

impl Room {
    fn stating(size: u32) -> Box<Self> {
        let mut room = Box::new(Self([0; 8192]));
        room.0[..4].copy_from_slice(&size.to_ne_bytes());
        room
    }
}

/// What a refused call must leave as it is.
#[derive(Clone, Debug, PartialEq)]
struct Picture {
    points: Vec<u64>,
    counts: [c_int; 6],
    energy: Result<u64, c_int>,
}

fn last_error(op: *mut ShapeOpSolver) -> String {
    // SAFETY: the library's texts end with a zero and are valid until this thread's next call.
    unsafe { std::ffi::CStr::from_ptr(shapeop_lastError(op)) }.to_str().unwrap().to_owned()
}

/// The points of a live solver; `None` if there is none.
fn points_of(op: *mut ShapeOpSolver) -> Option<Vec<f64>> {
    let count = usize::try_from(shapeop_pointCount(op)).ok()?;
    let mut points = vec![f64::NAN; 3 * count];
    // SAFETY: as long as it says.
    unsafe { shapeop_getPoints(op, points.as_mut_ptr(), count as c_int) };
    Some(points)
}

fn picture(op: *mut ShapeOpSolver) -> Option<Picture> {
    let points = points_of(op)?.iter().map(|c| c.to_bits()).collect();
    let counts = [
        shapeop_constraintCount(op),
        shapeop_forceCount(op),
        shapeop_referenceCount(op),
        shapeop_unconstrainedCount(op),
        shapeop_getBackend(op),
        (0..40).filter(|id| shapeop_isConstraint(op, *id) == 1).count() as c_int,
    ];
    let mut energy = 0.0;
    // SAFETY: one double.
    let energy = match unsafe { shapeop_energy(op, &mut energy) } {
        SO_SUCCESS => Ok(energy.to_bits()),
        code => Err(code as c_int),
    };
    Some(Picture { points, counts, energy })
}

struct Watch {
    op: *mut ShapeOpSolver,
    stop_at: u32,
    is_wrong: bool,
}

extern "C" fn watch(progress: *const shapeop_progress, user: *mut c_void) -> c_int {
    // SAFETY: `make` passes these.
    let (progress, watch) = unsafe { (&*progress, &mut *user.cast::<Watch>()) };
    let is_finite = points_of(watch.op).is_some_and(|points| points.iter().all(|c| c.is_finite()));
    let is_busy = shapeop_solve(watch.op, 1) == 1 && shapeop_init(watch.op) == 1;
    watch.is_wrong |= !is_finite || !is_busy || !progress.energy.is_finite() || !progress.largest_move.is_finite();
    c_int::from(progress.iteration >= watch.stop_at)
}

/// The solvers of a sequence, and the constraints that each was given: id, type, number of indices.
struct Own {
    ops: [*mut ShapeOpSolver; 4],
    constraints: Vec<(*mut ShapeOpSolver, c_int, CString, usize)>,
}

impl Own {
    /// Three solvers with points in general position, and one without.
    fn new() -> Self {
        let ops = [(); 4].map(|()| shapeop_create());
        let points: Vec<f64> = (0..3 * MOST_POINTS).map(|i| (i * i % 17) as f64 / 8.0 - 1.0).collect();
        for op in &ops[..3] {
            // SAFETY: as long as it says, only read.
            unsafe { shapeop_setPoints(*op, points.as_ptr().cast_mut(), MOST_POINTS as c_int) };
        }
        // SAFETY: as long as they say.
        unsafe {
            shapeop_addReferencePolyline(ops[0], points.as_ptr(), 5, 1);
            shapeop_addReferenceMesh(ops[0], points.as_ptr(), 5, [0, 1, 2, 2, 3, 4].as_ptr(), 2);
        }
        Self { ops, constraints: Vec::new() }
    }

    fn named(&self, op: &Op) -> *mut ShapeOpSolver {
        match op {
            Op::Own(i) => self.ops[*i],
            Op::Value(value) => ptr::without_provenance_mut(*value as usize),
        }
    }
}

/// The number of triples of an array whose values are whole triples, or what is stated in its place.
fn triples<T>(array: &Array<T>) -> c_int {
    if let Array::Right(values) = array { values.len() as c_int / 3 } else { array.count() }
}

/// Makes a call. Returns true if it was refused.
fn make(call: &Call, own: &mut Own) -> Result<bool, String> {
    let ops = Own { ops: own.ops, constraints: Vec::new() };
    let at = |op: &Op| ops.named(op);
    let name = |name: &Option<CString>| name.as_ref().map_or(ptr::null(), |name| name.as_ptr());
    let refused = |code: shapeop_err| match code {
        SO_INTERNAL => Err("SO_INTERNAL".to_owned()),
        code => Ok(code != SO_SUCCESS),
    };
    let vector = |vector: &Option<[f64; 3]>| vector.as_ref().map_or(ptr::null_mut(), |v| v.as_ptr().cast_mut());
    // Functions without a result: their message tells.
    let says = |op: *mut ShapeOpSolver| Ok(!last_error(op).is_empty());
    let check = |is_right: bool, what: &str| if is_right { Ok(()) } else { Err(what.to_owned()) };
    // SAFETY: every pointer is null or leads to as many values as are stated with it, wherever the count is one that
    // the call could accept; structs state a size within their room, or one that is refused.
    unsafe {
        match call {
            Call::Create => {
                let new = shapeop_create();
                check(!new.is_null(), "create failed")?;
                shapeop_delete(own.ops[0]);
                own.ops.rotate_left(1);
                own.ops[3] = new;
                Ok(false)
            }
            Call::Delete(op) => {
                shapeop_delete(at(op));
                Ok(false)
            }
            Call::Init(op) => Ok(shapeop_init(at(op)) != 0),
            Call::InitDynamic(op, masses, damping, step) => {
                Ok(shapeop_initDynamic(at(op), *masses, *damping, *step) != 0)
            }
            Call::Solve(op, iterations) => Ok(shapeop_solve(at(op), *iterations) != 0),
            Call::SetPoints(op, points) => {
                let count = if let Array::Right(values) = points { values.len() as c_int / 3 } else { points.count() };
                shapeop_setPoints(at(op), points.data().cast_mut(), count);
                says(at(op))
            }
            Call::GetPoints(op, is_null, count) => {
                let mut room = [7.0; 3 * MOST_POINTS];
                let out = if *is_null { ptr::null_mut() } else { room.as_mut_ptr() };
                shapeop_getPoints(at(op), out, *count);
                check(room.iter().all(|c| c.is_finite()), "a point is not finite")?;
                says(at(op))
            }
            Call::SetTimeStep(op, step) => {
                shapeop_setTimeStep(at(op), *step);
                says(at(op))
            }
            Call::SetDamping(op, damping) => {
                shapeop_setDamping(at(op), *damping);
                says(at(op))
            }
            Call::SetThreadCount(op, count) => refused(shapeop_setThreadCount(at(op), *count)),
            Call::SetAcceleration(op, kind, memory) => refused(shapeop_setAcceleration(at(op), *kind, *memory)),
            Call::SetLinearSolver(op, kind) => refused(shapeop_setLinearSolver(at(op), *kind)),
            Call::SetBackend(op, kind) => refused(shapeop_setBackend(at(op), *kind)),
            Call::SetBackendOptions(op, adapter, binding_bytes, memory_bytes) => {
                refused(shapeop_setBackendOptions(at(op), name(adapter), *binding_bytes, *memory_bytes))
            }
            Call::BackendInfo(op, size) => {
                let mut room = Room::stating(size.unwrap_or(0));
                let out = if size.is_some() { room.0.as_mut_ptr().cast() } else { ptr::null_mut() };
                shapeop_backendReason(at(op));
                refused(shapeop_backendInfo(at(op), out))
            }
            Call::ReleaseBackend => refused(shapeop_releaseBackend()),
            Call::AddConstraint(op, type_name, ids, weight) => {
                let ids_data = ids.data().cast_mut();
                let id = shapeop_addConstraint(at(op), name(type_name), ids_data, ids.count(), *weight);
                if let (0.., Some(type_name)) = (id, type_name) {
                    own.constraints.push((at(op), id, type_name.clone(), ids.count() as usize));
                }
                Ok(id < 0)
            }
            Call::AddConstraints(op, type_name, ids, counts, weights, scalars, sets, flags, wants_ids) => {
                let mut out = [-7; 16];
                let out_data = if *wants_ids { out.as_mut_ptr() } else { ptr::null_mut() };
                let is_refused = refused(shapeop_addConstraints(
                    at(op),
                    name(type_name),
                    ids.data(),
                    ids.count(),
                    counts.data(),
                    counts.count(),
                    weights.data(),
                    weights.count(),
                    scalars.data(),
                    scalars.count(),
                    *sets,
                    *flags,
                    out_data,
                ))?;
                check(!is_refused || out == [-7; 16], "ids of a refused call")?;
                Ok(is_refused)
            }
            Call::EditConstraint(op, type_name, id, scalars) => {
                refused(shapeop_editConstraint(at(op), name(type_name), *id, scalars.data(), scalars.count()))
            }
            Call::EditOwn(op, pick, scalars) => {
                let of_op: Vec<_> = own.constraints.iter().filter(|(solver, ..)| *solver == at(op)).collect();
                let Some((_, id, type_name, index_count)) = of_op.get(pick % of_op.len().max(1)) else {
                    return Ok(false);
                };
                let info = shapeop::constraints::types().find(|info| info.name.as_bytes() == type_name.to_bytes());
                let count = match info.map(|info| info.scalars) {
                    Some(shapeop::constraints::Scalars::Named(names)) => names.len(),
                    Some(shapeop::constraints::Scalars::Shapes) => 3 * index_count,
                    _ => 0,
                };
                let scalars = &scalars[..count.min(scalars.len())];
                refused(shapeop_editConstraint(
                    at(op),
                    type_name.as_ptr(),
                    *id,
                    scalars.as_ptr(),
                    scalars.len() as c_int,
                ))
            }
            Call::EditConstraints(op, type_name, ids, scalars, sets) => refused(shapeop_editConstraints(
                at(op),
                name(type_name),
                ids.data(),
                ids.count(),
                scalars.data(),
                scalars.count(),
                *sets,
            )),
            Call::SetWeights(op, ids, weights) => {
                refused(shapeop_setWeights(at(op), ids.data(), ids.count(), weights.data(), weights.count()))
            }
            Call::SetProblem(op, json, wants_options) => {
                let mut room = Room::stating(size_of::<shapeop_solve_options>() as u32);
                let options = room.0.as_mut_ptr().cast::<shapeop_solve_options>();
                let out = if *wants_options { options } else { ptr::null_mut() };
                let is_refused = refused(shapeop_setProblem(at(op), name(json), out))?;
                check((*options).tolerance.is_finite(), "a tolerance is not finite")?;
                let text = shapeop_problemText(name(json));
                check(is_refused || !text.is_null(), "what was set has no text")?;
                if is_refused {
                    // Leaves the message as it was made for the refused call.
                    refused(shapeop_setProblem(at(op), name(json), out))
                } else {
                    own.constraints.retain(|(solver, ..)| *solver != at(op));
                    Ok(false)
                }
            }
            Call::SetWeight(op, id, weight) => refused(shapeop_setWeight(at(op), *id, *weight)),
            Call::RemoveConstraint(op, id) => refused(shapeop_removeConstraint(at(op), *id)),
            Call::IsConstraint(op, id) => Ok(shapeop_isConstraint(at(op), *id) < 0),
            Call::IsDegenerate(op, id) => Ok(shapeop_isDegenerate(at(op), *id) < 0),
            Call::AddGravity(op, force) => Ok(shapeop_addGravityForce(at(op), vector(force)) < 0),
            Call::AddVertexForce(op, force, id) => Ok(shapeop_addVertexForce(at(op), vector(force), *id) < 0),
            Call::EditVertexForce(op, force_id, force, id) => {
                shapeop_editVertexForce(at(op), *force_id, vector(force), *id);
                says(at(op))
            }
            Call::AddPressure(op, indices, counts, pressure) => {
                let (data, count) = (indices.data(), indices.count());
                Ok(shapeop_addPressure(at(op), data, count, counts.data(), counts.count(), *pressure) < 0)
            }
            Call::AddNormalForce(op, indices, counts, magnitude) => {
                let (data, count) = (indices.data(), indices.count());
                Ok(shapeop_addNormalForce(at(op), data, count, counts.data(), counts.count(), *magnitude) < 0)
            }
            Call::EditForceMagnitude(op, id, magnitude) => refused(shapeop_editForceMagnitude(at(op), *id, *magnitude)),
            Call::RemoveForce(op, id) => refused(shapeop_removeForce(at(op), *id)),
            Call::AddPolyline(op, points, is_closed) => {
                Ok(shapeop_addReferencePolyline(at(op), points.data(), triples(points), *is_closed) < 0)
            }
            Call::AddMesh(op, points, indices) => {
                let (data, count) = (points.data(), triples(points));
                Ok(shapeop_addReferenceMesh(at(op), data, count, indices.data(), triples(indices)) < 0)
            }
            Call::SetHard(op, id, is_hard) => refused(shapeop_setHard(at(op), *id, *is_hard)),
            Call::SetHandle(op, point, target) => refused(shapeop_setHandle(at(op), *point, vector(target))),
            Call::ReleaseHandle(op, point) => refused(shapeop_releaseHandle(at(op), *point)),
            Call::SetObjective(op, [handle_weight, closeness_weight, fairness_weight, tolerance]) => {
                let objective = shapeop_objective {
                    struct_size: size_of::<shapeop_objective>() as u32,
                    reserved: 0,
                    handle_weight: *handle_weight,
                    closeness_weight: *closeness_weight,
                    fairness_weight: *fairness_weight,
                    tolerance: *tolerance,
                };
                refused(shapeop_setObjective(at(op), &raw const objective))
            }
            Call::SetFairness(op, kind, indices, counts) => {
                let (data, count) = (indices.data(), indices.count());
                refused(shapeop_setFairness(at(op), *kind, data, count, counts.data(), counts.count()))
            }
            Call::Sensitivities(op, is_null) => {
                let mut room = [0.0; 3 * MOST_POINTS * 64];
                let out = if *is_null { ptr::null_mut() } else { room.as_mut_ptr() };
                let (points, classes) = (shapeop_pointCount(at(op)), shapeop_weightClassCount(at(op)));
                let is_refused = refused(shapeop_getSensitivities(at(op), out, points, ptr::null_mut(), classes))?;
                check(room.iter().all(|number| number.is_finite()), "a sensitivity is not finite")?;
                Ok(is_refused)
            }
            Call::Exploration(op, size) => {
                let mut room = Room::stating(size.unwrap_or(0));
                let out = if size.is_some() { room.0.as_mut_ptr().cast() } else { ptr::null_mut() };
                let mut ids = [-1; 16 * LONGEST_SEQUENCE];
                check(shapeop_getConflicts(at(op), ids.as_mut_ptr(), ids.len() as c_int) >= -1, "a count is none")?;
                refused(shapeop_getExploration(at(op), out))
            }
            Call::SolveUntil(op, options, stop_at, report_size) => {
                let mut options_room = Room::stating(options.as_ref().map_or(0, |options| options.struct_size));
                if let Some(Options { max_iterations, tolerance, time_budget_seconds, .. }) = options {
                    let out = options_room.0.as_mut_ptr().cast::<shapeop_solve_options>();
                    (*out).max_iterations = *max_iterations;
                    (*out).tolerance = *tolerance;
                    (*out).time_budget_seconds = *time_budget_seconds;
                }
                let options_data = if options.is_some() { options_room.0.as_ptr().cast() } else { ptr::null() };
                let mut report_room = Room::stating(report_size.unwrap_or(0));
                let report = report_room.0.as_mut_ptr().cast::<shapeop_solve_report>();
                let report_data = if report_size.is_some() { report } else { ptr::null_mut() };
                let mut watched = Watch { op: at(op), stop_at: stop_at.unwrap_or(0), is_wrong: false };
                let user = (&raw mut watched).cast();
                let progress: shapeop_progress_callback = if stop_at.is_some() { Some(watch) } else { None };
                let code = shapeop_solveUntil(at(op), options_data, progress, user, report_data);
                check(!watched.is_wrong, "the callback saw what it should not")?;
                let told = &*report;
                let numbers = [told.energy_before, told.energy_after, told.largest_move];
                check(numbers.iter().all(|number| number.is_finite()), "the report is not finite")?;
                refused(code)
            }
            Call::Energy(op, is_null) => {
                let mut energy = 0.0;
                let out = if *is_null { ptr::null_mut() } else { &raw mut energy };
                let is_refused = refused(shapeop_energy(at(op), out))?;
                check(energy.is_finite(), "the energy is not finite")?;
                Ok(is_refused)
            }
            Call::Violations(op, is_null, count) => {
                // As long as there can be constraints in a sequence.
                let mut room = [0.0; 16 * LONGEST_SEQUENCE];
                let right = shapeop_constraintCount(at(op));
                let count = if *count % 2 == 0 { right } else { *count };
                let out = if *is_null { ptr::null_mut() } else { room.as_mut_ptr() };
                let is_refused = refused(shapeop_getViolations(at(op), out, count))?;
                check(room.iter().all(|violation| violation.is_finite() && *violation >= 0.0), "a violation is none")?;
                Ok(is_refused)
            }
            Call::ConstraintType(index, size) => {
                let mut room = Room::stating(size.unwrap_or(0));
                let out = if size.is_some() { room.0.as_mut_ptr().cast() } else { ptr::null_mut() };
                refused(shapeop_constraintType(*index, out))
            }
            Call::ConstraintScalar(index, scalar, size) => {
                let mut room = Room::stating(size.unwrap_or(0));
                let out = if size.is_some() { room.0.as_mut_ptr().cast() } else { ptr::null_mut() };
                shapeop_constraintIndexName(*index, *scalar);
                refused(shapeop_constraintScalar(*index, *scalar, out))
            }
            Call::ErrorText(code) => {
                check(!shapeop_errorText(*code).is_null(), "no text")?;
                Ok(false)
            }
        }
    }
}

/// The handle that a call names, if it names one.
fn named(call: &Call, own: &Own) -> *mut ShapeOpSolver {
    let op = match call {
        Call::Create | Call::ConstraintType(..) | Call::ConstraintScalar(..) | Call::ErrorText(_) => None,
        Call::ReleaseBackend => None,
        Call::SetBackend(op, _) | Call::SetBackendOptions(op, ..) | Call::BackendInfo(op, _) => Some(op),
        Call::Delete(op) | Call::Init(op) | Call::InitDynamic(op, ..) | Call::Solve(op, _) => Some(op),
        Call::SetPoints(op, _) | Call::GetPoints(op, ..) | Call::SetTimeStep(op, _) | Call::SetDamping(op, _) => {
            Some(op)
        }
        Call::SetThreadCount(op, _) | Call::SetAcceleration(op, ..) | Call::SetLinearSolver(op, _) => Some(op),
        Call::AddConstraint(op, ..) | Call::AddConstraints(op, ..) => Some(op),
        Call::EditConstraint(op, ..)
        | Call::EditOwn(op, ..)
        | Call::EditConstraints(op, ..)
        | Call::SetWeight(op, ..)
        | Call::SetWeights(op, ..)
        | Call::SetProblem(op, ..)
        | Call::RemoveConstraint(op, _) => Some(op),
        Call::IsConstraint(op, _) | Call::IsDegenerate(op, _) | Call::AddGravity(op, _) => Some(op),
        Call::AddVertexForce(op, ..) | Call::EditVertexForce(op, ..) | Call::RemoveForce(op, _) => Some(op),
        Call::AddPressure(op, ..) | Call::AddNormalForce(op, ..) | Call::EditForceMagnitude(op, ..) => Some(op),
        Call::AddPolyline(op, ..) | Call::AddMesh(op, ..) => Some(op),
        Call::SetHard(op, ..) | Call::SetHandle(op, ..) | Call::ReleaseHandle(op, _) => Some(op),
        Call::SetObjective(op, _) | Call::SetFairness(op, ..) => Some(op),
        Call::Sensitivities(op, _) | Call::Exploration(op, _) => Some(op),
        Call::SolveUntil(op, ..) | Call::Energy(op, _) | Call::Violations(op, ..) => Some(op),
    };
    op.map_or(ptr::null_mut(), |op| own.named(op))
}

fn play(calls: &[Call], counts: &mut Counts) -> Result<(), TestCaseError> {
    let trace = std::env::var_os("SHAPEOP_FUZZ_TRACE").is_some();
    let mut own = Own::new();
    let result = calls.iter().try_for_each(|call| {
        if trace {
            println!("{call:?}");
        }
        let op = named(call, &own);
        let before = picture(op);
        let is_refused = make(call, &mut own).map_err(|what| TestCaseError::fail(format!("{call:?}: {what}")))?;
        counts.calls += 1;
        if matches!(call, Call::Solve(..) | Call::SolveUntil(..)) && !is_refused {
            counts.solves += 1;
        }
        let message = last_error(if op.is_null() { ptr::null_mut() } else { op });
        prop_assert!(!message.contains("inside the library"), "{call:?}: {message}");
        if is_refused {
            counts.refused += 1;
            prop_assert!(!message.is_empty(), "{call:?} was refused without a message");
            // A card that fails in the middle leaves what it had reached, and says so.
            if !message.contains("the points are those after") {
                prop_assert_eq!(before, picture(op), "{:?} was refused and changed something", call);
            }
        }
        if let Some(points) = points_of(op) {
            prop_assert!(points.iter().all(|c| c.is_finite()), "{call:?} left {points:?}");
        }
        Ok(())
    });
    own.ops.into_iter().for_each(|op| shapeop_delete(op));
    result
}

#[derive(Default)]
struct Counts {
    sequences: u64,
    calls: u64,
    refused: u64,
    /// Solves that were carried out.
    solves: u64,
}

fn from_environment<T: std::str::FromStr>(name: &str, default: T) -> T {
    std::env::var(name).ok().map_or(default, |text| text.parse().ok().unwrap_or_else(|| panic!("{name}={text}")))
}

#[test]
fn random_calls_neither_crash_nor_hand_out_what_is_not_finite() {
    let sequences = from_environment("SHAPEOP_FUZZ_SEQUENCES", SEQUENCES);
    let seed: u64 = from_environment("SHAPEOP_FUZZ_SEED", 2026);
    println!("fuzz: {sequences} sequences of C calls, seed {seed}");
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let config =
        Config { cases: sequences, failure_persistence: None, max_global_rejects: 1 << 20, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &bytes));
    let counts = std::cell::RefCell::new(Counts::default());
    let result = runner.run(&prop::collection::vec(call(), 1..LONGEST_SEQUENCE), |calls| {
        let mut counts = counts.borrow_mut();
        counts.sequences += 1;
        play(&calls, &mut counts)
    });
    let Counts { sequences, calls, refused, solves } = counts.into_inner();
    println!(
        "fuzz: {sequences} sequences, {calls} calls ({refused} refused), {solves} solves carried out, seed {seed}"
    );
    if let Err(error) = result {
        panic!("{error}");
    }
    assert!(
        calls - refused > calls / 3 && solves > u64::from(SEQUENCES.min(sequences as u32)) / 10,
        "too little is done"
    );
}
