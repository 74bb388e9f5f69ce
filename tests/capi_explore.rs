//! The C functions of exploration: that they do what the Rust API does, and what they refuse.

mod abi;

use std::ffi::c_int;
use std::ptr;

use abi::{Abi, Many, text};
use glam::DVec3;
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;
use shapeop::mesh::Topology;
use shapeop::mesh::patterns::translation_surface;
use shapeop::problem::{FairnessRows, Objective};
use shapeop::solver::{SolveOptions, Solver};

const N: usize = 6;
const HANDLE: usize = 14;

fn exploration() -> shapeop_exploration {
    // SAFETY: all of its fields are valid as zeros.
    let zero: shapeop_exploration = unsafe { std::mem::zeroed() };
    shapeop_exploration { struct_size: size_of::<shapeop_exploration>() as u32, ..zero }
}

fn set_objective(abi: &Abi, weights: [f64; 4]) -> shapeop_err {
    let [handle_weight, closeness_weight, fairness_weight, tolerance] = weights;
    let struct_size = size_of::<shapeop_objective>() as u32;
    let objective =
        shapeop_objective { struct_size, reserved: 0, handle_weight, closeness_weight, fairness_weight, tolerance };
    // SAFETY: a live struct that states its size.
    unsafe { shapeop_setObjective(abi.0, &raw const objective) }
}

fn set_fairness(abi: &Abi, kind: c_int, indices: &[c_int], counts: &[c_int]) -> shapeop_err {
    // SAFETY: live slices of these lengths.
    unsafe {
        shapeop_setFairness(
            abi.0,
            kind,
            indices.as_ptr(),
            indices.len() as c_int,
            counts.as_ptr(),
            counts.len() as c_int,
        )
    }
}

fn solve_until(abi: &Abi) -> shapeop_solve_report {
    // SAFETY: all of its fields are valid as zeros.
    let zero: shapeop_solve_report = unsafe { std::mem::zeroed() };
    let mut report = shapeop_solve_report { struct_size: size_of::<shapeop_solve_report>() as u32, ..zero };
    // SAFETY: null or live structs that state their sizes.
    let code = unsafe { shapeop_solveUntil(abi.0, ptr::null(), None, ptr::null_mut(), &raw mut report) };
    assert_eq!(code, SO_SUCCESS, "{}", abi.message());
    report
}

#[test]
fn a_handle_under_hard_planes_leads_where_the_rust_api_leads() {
    let mesh = translation_surface(N).unwrap();
    let flat: Vec<f64> = mesh.points.iter().flat_map(DVec3::to_array).collect();
    let target = mesh.points[HANDLE] + DVec3::new(0.1, 0.2, 0.6);
    let edges = Topology::new(&mesh).unwrap().edges().to_vec();
    let corners: Vec<c_int> = mesh.faces.concat().iter().map(|&point| point as c_int).collect();

    let abi = Abi::with_points(&flat);
    let (code, ids) = abi.add_many(&Many { ids: &corners, counts: &[4], flags: SHAPEOP_HARD, ..Many::default() });
    assert_eq!((code, ids.len()), (SO_SUCCESS, mesh.faces.len()));
    assert_eq!(shapeop_isHard(abi.0, 0), 1);
    assert_eq!(set_objective(&abi, [50.0, 0.2, 0.5, 1e-12]), SO_SUCCESS);
    assert_eq!(set_fairness(&abi, 0, &corners, &vec![4; mesh.faces.len()]), SO_SUCCESS, "{}", abi.message());
    let soft = abi.add("EdgeLength", &[0, 1], 2.0);
    // SAFETY: three live numbers.
    assert_eq!(unsafe { shapeop_setHandle(abi.0, HANDLE as c_int, target.to_array().as_ptr()) }, SO_SUCCESS);
    assert_eq!(abi.init(), 0);
    let report = solve_until(&abi);
    assert_eq!(report.outcome, shapeop_outcome::SO_OUTCOME_CONVERGED);

    let mut solver = Solver::new();
    solver.set_points(&mesh.points).unwrap();
    let planes: Vec<usize> = mesh.faces.iter().map(|f| solver.add_constraint("Plane", f, 1.0).unwrap()).collect();
    solver.set_hard(&planes, true).unwrap();
    let (handle_weight, closeness_weight, fairness_weight, tolerance) = (50.0, 0.2, 0.5, 1e-12);
    let objective = Objective { handle_weight, closeness_weight, fairness_weight, tolerance, ..Objective::default() };
    solver.set_objective(&objective, FairnessRows::laplacian(mesh.points.len(), &edges)).unwrap();
    solver.add_constraint("EdgeLength", &[0, 1], 2.0).unwrap();
    solver.set_handle(HANDLE as u32, target).unwrap();
    solver.init().unwrap();
    solver.solve_until(&SolveOptions::default(), &mut |_| std::ops::ControlFlow::Continue(())).unwrap();
    let expected: Vec<f64> = solver.points().iter().flat_map(DVec3::to_array).collect();
    assert_eq!(abi.points(), expected);

    let mut told = exploration();
    // SAFETY: a live struct that states its size.
    assert_eq!(unsafe { shapeop_getExploration(abi.0, &raw mut told) }, SO_SUCCESS);
    let found = solver.found().unwrap();
    assert_eq!((told.is_solution, told.capped_count), (1, 0));
    assert_eq!((told.sweep_count, told.newton_step_count), (found.sweeps, found.newton_steps));
    assert_eq!(told.largest_violation, found.largest_violation);
    assert_eq!(told.fairness_term, found.terms.fairness);
    // SAFETY: nothing is written through null.
    assert_eq!(unsafe { shapeop_getConflicts(abi.0, ptr::null_mut(), 0) }, 0);

    let names: Vec<String> =
        (0..shapeop_weightClassCount(abi.0)).map(|class| text(shapeop_weightClassName(abi.0, class))).collect();
    assert_eq!(names, ["handles", "closeness", "fairness", "EdgeLength"]);
    let (mut moves, mut squares) = (vec![f64::NAN; 4 * flat.len()], vec![f64::NAN; 16]);
    // SAFETY: live slices of these lengths.
    let code =
        unsafe { shapeop_getSensitivities(abi.0, moves.as_mut_ptr(), (N * N) as c_int, squares.as_mut_ptr(), 4) };
    assert_eq!(code, SO_SUCCESS, "{}", abi.message());
    let known = solver.sensitivities().unwrap();
    assert_eq!(moves, known.points.iter().flatten().flat_map(|step| step.to_array()).collect::<Vec<_>>());
    assert_eq!(squares, known.squares.concat());
    assert_eq!(shapeop_setHard(abi.0, soft, 1), SO_SUCCESS);
    assert_eq!(shapeop_setHard(abi.0, 0, 0), SO_SUCCESS);
    assert_eq!((shapeop_isHard(abi.0, soft), shapeop_isHard(abi.0, 0)), (1, 0));
    assert_eq!(shapeop_releaseHandle(abi.0, HANDLE as c_int), SO_SUCCESS);
    assert_eq!(solve_until(&abi).outcome, shapeop_outcome::SO_OUTCOME_CONVERGED);
}

#[test]
fn contradictions_are_told_by_id() {
    let abi = Abi::with_points(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 1.0, 0.0]);
    let ids: Vec<c_int> = [[0, 1], [1, 2], [2, 0]].iter().map(|edge| abi.add("EdgeLength", edge, 1.0)).collect();
    let planted = abi.add("EdgeLength", &[1, 2], 0.5);
    assert_eq!(abi.edit("EdgeLength", planted, &[2.0, 2.1]), SO_SUCCESS);
    for id in ids.iter().chain([&planted]) {
        assert_eq!(shapeop_setHard(abi.0, *id, 1), SO_SUCCESS);
    }
    assert_eq!(abi.init(), 0);
    assert_eq!(solve_until(&abi).outcome, shapeop_outcome::SO_OUTCOME_INFEASIBLE);
    let mut found = [-1; 4];
    // SAFETY: room for four.
    assert_eq!(unsafe { shapeop_getConflicts(abi.0, found.as_mut_ptr(), 4) }, 1);
    assert_eq!(found, [planted, -1, -1, -1]);
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let abi = Abi::with_points(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 1.0, 0.0]);
    let refused = |code: shapeop_err, expected: shapeop_err, words: &str| {
        assert_eq!(code, expected, "{words}");
        assert!(abi.message().contains(words), "{} lacks {words}", abi.message());
    };
    let edge = abi.add("EdgeLength", &[0, 1], 1.0);
    refused(shapeop_setHard(abi.0, edge, 2), SO_INVALID_VALUE, "is_hard: expected 0 or 1, found 2");
    refused(shapeop_setHard(abi.0, 7, 1), SO_UNMATCHING_CONSTRAINT_ID, "ids[0]: 7 is none of the 1 ids given out");
    let flat = abi.add("EdgeStrain", &[2, 2], 1.0);
    refused(shapeop_setHard(abi.0, flat, 1), SO_INVALID_VALUE, "cannot be hard");
    // SAFETY: null, and live numbers.
    refused(unsafe { shapeop_setHandle(abi.0, 0, ptr::null()) }, SO_NULL_POINTER, "target");
    // SAFETY: three live numbers.
    refused(unsafe { shapeop_setHandle(abi.0, 3, [0.0; 3].as_ptr()) }, SO_INDEX_OUT_OF_RANGE, "3 is out of range");
    refused(shapeop_releaseHandle(abi.0, 1), SO_INVALID_VALUE, "point 1 is no handle");
    refused(set_objective(&abi, [0.0, 1.0, 1.0, 1e-9]), SO_INVALID_VALUE, "handle_weight: expected a number above 0");
    refused(set_objective(&abi, [1.0, 1.0, 1.0, 1e-17]), SO_INVALID_VALUE, "tolerance: expected at least 1e-14");
    refused(set_fairness(&abi, 9, &[], &[]), SO_INVALID_VALUE, "kind: expected 0, 1 or 2");
    refused(set_fairness(&abi, 1, &[0, 1, 9], &[3]), SO_INDEX_OUT_OF_RANGE, "indices[2]: 9");
    refused(set_fairness(&abi, 1, &[0, 1, 2], &[4]), SO_INVALID_ARGUMENT_LENGTH, "counts[0]");
    refused(set_fairness(&abi, 1, &[0, 1, 2], &[2]), SO_INVALID_ARGUMENT_LENGTH, "nb_indices");
    let mut told = exploration();
    // SAFETY: a live struct that states its size.
    refused(unsafe { shapeop_getExploration(abi.0, &raw mut told) }, SO_NOT_INITIALISED, "no exploration yet");
    // SAFETY: nothing is written through null.
    let code = unsafe { shapeop_getSensitivities(abi.0, ptr::null_mut(), 3, ptr::null_mut(), 5) };
    refused(code, SO_NOT_INITIALISED, "solve until it is converged");
    assert!(shapeop_weightClassName(abi.0, 99).is_null() && abi.message().contains("99 is out of range"));
    let hard =
        Many { type_name: "EdgeStrain", ids: &[0, 1, 2, 2], counts: &[2], flags: SHAPEOP_HARD, ..Many::default() };
    let before = shapeop_constraintCount(abi.0);
    refused(abi.add_many(&hard).0, SO_INVALID_VALUE, "cannot be hard");
    assert_eq!(shapeop_constraintCount(abi.0), before, "all or none");
    assert_eq!(abi.add("EdgeLength", &[1, 2], 1.0), before);
}
