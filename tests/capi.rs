//! The C functions: return codes, handles, messages, busy solvers, callbacks, ids, sizes of structs.

mod abi;

use std::collections::HashSet;
use std::ffi::{c_int, c_void};
use std::mem::offset_of;
use std::ptr;
use std::sync::mpsc;
use std::time::Duration;

use abi::{Abi, Many, WARPED, last_error, options, report, text, warped};
use shapeop::capi::shapeop_err::*;
use shapeop::capi::shapeop_outcome::*;
use shapeop::capi::*;

fn op(value: u64) -> *mut ShapeOpSolver {
    ptr::without_provenance_mut(value as usize)
}

#[test]
fn the_fourteen_functions_solve_what_can_be_derived_by_hand() {
    // Along z each corner minimises ¼ (z − z₀)² + z² once the plane is z = 0: z = z₀ / 5.
    let abi = warped();
    assert_eq!(abi.init(), 0);
    assert_eq!(abi.solve(1), 0);
    for (found, start) in abi.points().chunks_exact(3).zip(WARPED.chunks_exact(3)) {
        let expected = [start[0], start[1], start[2] / 5.0];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?} is not {expected:?}");
    }
    // A free fall of one point in steps of 0.1: z = −δ² g k (k + 1) / 2.
    let fall = Abi::with_points(&[0.0; 3]);
    assert_eq!(fall.gravity([0.0, 0.0, -10.0]), 0);
    assert_eq!(shapeop_initDynamic(fall.0, 3.0, 1.0, 0.1), 0);
    for k in 1..=10 {
        assert_eq!(fall.solve(2), 0);
        assert!((fall.points()[2] + 0.1 * f64::from(k * (k + 1)) / 2.0).abs() < 1e-12);
    }
    // Without damping of its velocity it goes on; with a damping of 0 it stays where it is.
    assert_eq!(fall.vertex_force([0.0, 0.0, 10.0], 0), 1);
    shapeop_setDamping(fall.0, 0.0);
    shapeop_setTimeStep(fall.0, 0.2);
    let before = fall.points()[2];
    assert_eq!(fall.solve(1), 0);
    // The forces cancel; the last velocity was 10 · 0.1 · 10 = 10 units per time, one step of 0.2.
    assert!((fall.points()[2] - (before - 2.0)).abs() < 1e-12);
    fall.edit_vertex_force(1, [0.0, 0.0, 35.0], 0);
    let before = fall.points()[2];
    assert_eq!(fall.solve(1), 0);
    // M keeps the step of initialisation and cancels without constraints: x + δ² Σ forces.
    assert!((fall.points()[2] - (before + 0.04 * 25.0)).abs() < 1e-12);
}

#[test]
fn handles_are_small_integers_and_different() {
    let solvers: Vec<Abi> = (0..100).map(|_| Abi::new()).collect();
    let values: HashSet<usize> = solvers.iter().map(|abi| abi.0.addr()).collect();
    assert_eq!(values.len(), 100);
    assert!(values.iter().all(|value| *value > 0 && *value < 1 << 31));
    for (i, abi) in solvers.iter().enumerate() {
        abi.set_points(&vec![i as f64; 3 * (i + 1)]);
    }
    for (i, abi) in solvers.iter().enumerate() {
        assert_eq!(shapeop_pointCount(abi.0), i as c_int + 1);
        assert_eq!(abi.points(), vec![i as f64; 3 * (i + 1)]);
    }
}

#[test]
fn bad_handles_are_refused_by_every_function() {
    let deleted = Abi::new().0;
    let local = 5;
    let foreign = ptr::from_ref(&local).cast_mut().cast();
    for bad in [ptr::null_mut(), deleted, foreign, op(1), op(0xffff_ffff), op(0x8000_0000), op(0x7fff_ffff)] {
        let abi = std::mem::ManuallyDrop::new(Abi(bad));
        assert_eq!(abi.init(), 1);
        assert!(abi.message().starts_with("op: expected a solver's handle, found "), "{}", abi.message());
        assert_eq!(shapeop_initDynamic(bad, 1.0, 1.0, 1.0), 1);
        assert_eq!(abi.solve(1), 1);
        for length in [0, 1] {
            let mut numbers = [7.0; 3];
            // SAFETY: as long as it says.
            unsafe { shapeop_getPoints(bad, numbers.as_mut_ptr(), length) };
            assert_eq!(numbers, [7.0; 3]);
            assert!(abi.message().contains("handle"));
        }
        abi.set_points(&[0.0; 3]);
        assert!(abi.message().contains("handle"));
        shapeop_setTimeStep(bad, 1.0);
        shapeop_setDamping(bad, 1.0);
        assert_eq!(abi.add("Plane", &[0, 1, 2], 1.0), -1);
        assert_eq!(abi.edit("Closeness", 0, &[0.0; 3]), SO_INVALID_HANDLE);
        assert_eq!(abi.gravity([0.0; 3]), -1);
        assert_eq!(abi.vertex_force([0.0; 3], 0), -1);
        abi.edit_vertex_force(0, [0.0; 3], 0);
        assert!(abi.message().contains("handle"));
        assert_eq!(abi.add_many(&Many::default()).0, SO_INVALID_HANDLE);
        assert_eq!(abi.solve_until(1).0, SO_INVALID_HANDLE);
        assert_eq!(abi.energy().0, SO_INVALID_HANDLE);
        assert_eq!(abi.violations(0).0, SO_INVALID_HANDLE);
        assert_eq!(shapeop_setWeight(bad, 0, 1.0), SO_INVALID_HANDLE);
        assert_eq!(shapeop_removeConstraint(bad, 0), SO_INVALID_HANDLE);
        assert_eq!(shapeop_removeForce(bad, 0), SO_INVALID_HANDLE);
        assert_eq!(shapeop_setThreadCount(bad, 1), SO_INVALID_HANDLE);
        assert_eq!(shapeop_setAcceleration(bad, 0, 0), SO_INVALID_HANDLE);
        assert_eq!(shapeop_setLinearSolver(bad, 1), SO_INVALID_HANDLE);
        assert_eq!(shapeop_setBackend(bad, 0), SO_INVALID_HANDLE);
        assert!(shapeop_backendReason(bad).is_null());
        // SAFETY: null is allowed.
        unsafe {
            assert_eq!(shapeop_setBackendOptions(bad, ptr::null(), 0.0, 0.0), SO_INVALID_HANDLE);
            assert_eq!(shapeop_backendInfo(bad, ptr::null_mut()), SO_INVALID_HANDLE);
        }
        for count in [
            shapeop_pointCount(bad),
            shapeop_constraintCount(bad),
            shapeop_forceCount(bad),
            shapeop_unconstrainedCount(bad),
            shapeop_getBackend(bad),
            shapeop_isConstraint(bad, 0),
            shapeop_isForce(bad, 0),
            shapeop_isDegenerate(bad, 0),
        ] {
            assert_eq!(count, -1);
        }
        shapeop_delete(bad);
    }
}

#[test]
fn deleting_twice_or_nothing_leaves_other_solvers_alone() {
    let abi = Abi::new();
    let deleted = Abi::new().0;
    let heir = Abi::new();
    assert_ne!(deleted, heir.0);
    shapeop_delete(deleted);
    assert!(last_error(deleted).contains("was deleted"));
    shapeop_delete(ptr::null_mut());
    // Null is no call: the message is still that of the call before.
    assert!(last_error(ptr::null_mut()).contains("was deleted"));
    assert_eq!((shapeop_pointCount(abi.0), shapeop_pointCount(heir.0)), (0, 0));
}

#[test]
#[cfg(target_pointer_width = "64")]
fn a_handle_survives_being_cut_to_an_int_and_back() {
    let abi = Abi::with_points(&[1.0, 2.0, 3.0]);
    let cut = abi.0.addr() as i32;
    assert_eq!(shapeop_pointCount(op(i64::from(cut) as u64)), 1);
    // A register whose upper half was never set.
    assert_eq!(shapeop_pointCount(op(abi.0.addr() as u64 | 0xdead_beef_0000_0000)), 1);
}

#[test]
fn edit_constraint_decides_in_the_order_of_libshapeop() {
    let abi = warped();
    let edge = abi.add("EdgeStrain", &[0, 1], 1.0);
    // Type, id, length and value wrong; then one right after the other.
    assert_eq!(abi.edit("Plane", 99, &[f64::NAN]), SO_INVALID_CONSTRAINT_TYPE);
    assert_eq!(abi.edit("NoSuchType", 99, &[f64::NAN]), SO_INVALID_CONSTRAINT_TYPE);
    assert_eq!(abi.edit("Plane", 0, &[]), SO_INVALID_CONSTRAINT_TYPE);
    for wrong in [99, -1, 0, 1, c_int::MAX, c_int::MIN] {
        assert_eq!(abi.edit("EdgeStrain", wrong, &[f64::NAN]), SO_UNMATCHING_CONSTRAINT_ID, "id {wrong}");
    }
    assert_eq!(abi.edit("EdgeStrain", edge, &[f64::NAN]), SO_INVALID_ARGUMENT_LENGTH);
    assert_eq!(abi.edit("EdgeStrain", edge, &[1.0, 1.0, f64::NAN]), SO_INVALID_VALUE);
    assert_eq!(abi.edit("EdgeStrain", edge, &[1.0, 1.0, 1.0]), SO_SUCCESS);
    // SAFETY: the count is refused before the pointer is looked at.
    let negative = unsafe { shapeop_editConstraint(abi.0, c"EdgeStrain".as_ptr(), edge, [1.0; 3].as_ptr(), -3) };
    assert_eq!(negative, SO_INVALID_ARGUMENT_LENGTH);
    // SAFETY: null is allowed.
    let null = unsafe { shapeop_editConstraint(abi.0, c"EdgeStrain".as_ptr(), edge, ptr::null(), 3) };
    assert_eq!(null, SO_NULL_POINTER);
    // SAFETY: null is allowed.
    let null = unsafe { shapeop_editConstraint(abi.0, ptr::null(), edge, [1.0; 3].as_ptr(), 3) };
    assert_eq!(null, SO_NULL_POINTER);
    assert!(abi.message().starts_with("constraint_type: "), "{}", abi.message());
    // A name in another encoding is no name.
    // SAFETY: the text ends with a zero.
    let latin = unsafe { shapeop_editConstraint(abi.0, c"Pl\xe4ne".as_ptr(), edge, [1.0; 3].as_ptr(), 3) };
    assert_eq!(latin, SO_INVALID_CONSTRAINT_TYPE);
}

#[test]
fn many_constraints_are_added_in_one_call_or_none() {
    let points: Vec<f64> = (0..30).map(|i| f64::from(i * i % 7)).collect();
    let abi = Abi::with_points(&points);
    let quads = [0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7];
    let (code, ids) = abi.add_many(&Many { ids: &quads, counts: &[4], ..Many::default() });
    assert_eq!((code, ids), (SO_SUCCESS, vec![0, 1, 2]));
    let mixed = Many { ids: &quads[..9], counts: &[4, 5], weights: &[1.0, 2.0], ..Many::default() };
    let (code, ids) = abi.add_many(&mixed);
    assert_eq!((code, ids), (SO_SUCCESS, vec![3, 4]));
    let targets = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    let one_each = Many { type_name: "Closeness", ids: &[8, 9], counts: &[1], ..Many::default() };
    let (code, ids) = abi.add_many(&Many { scalars: &targets, scalar_sets: 2, ..one_each });
    assert_eq!((code, ids), (SO_SUCCESS, vec![5, 6]));
    let one_set = Many { type_name: "Closeness", ids: &[8, 9], counts: &[1], ..Many::default() };
    let (code, ids) = abi.add_many(&Many { scalars: &targets[..3], scalar_sets: 1, ..one_set });
    assert_eq!((code, ids), (SO_SUCCESS, vec![7, 8]));
    let (code, violations) = abi.violations(9);
    assert_eq!(code, SO_SUCCESS);
    let distance = |point: usize, target: &[f64]| -> f64 {
        points[3 * point..].iter().zip(target).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    for (id, point, target) in [(5, 8, 0..3), (6, 9, 3..6), (7, 8, 0..3), (8, 9, 0..3)] {
        assert!((violations[id] - distance(point, &targets[target])).abs() < 1e-14);
    }
    let (code, ids) = abi.add_many(&Many::default());
    assert_eq!((code, ids), (SO_SUCCESS, vec![]), "no constraint at all");

    let base = || Many { ids: &quads, counts: &[4], ..Many::default() };
    let far = [0, 1, 2, 3, 2, 3, 4, 10];
    let negative = [0, 1, 2, 3, 2, -3, 4, 5];
    let wrong = [
        (Many { type_name: "Flat", ..base() }, SO_INVALID_CONSTRAINT_TYPE, "\"Flat\" is not one of"),
        (Many { flags: 4, ..base() }, SO_INVALID_VALUE, "flags: expected 0"),
        (Many { ids: &far, ..base() }, SO_INDEX_OUT_OF_RANGE, "constraint 10 (\"Plane\"): indices[3]: 10 is out of"),
        (Many { ids: &negative, ..base() }, SO_INDEX_OUT_OF_RANGE, "constraint 10 (\"Plane\"): indices[1]: -3 is out"),
        (Many { counts: &[2], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "counts[0]"),
        (
            Many { ids: &quads[..2], counts: &[2], ..base() },
            SO_INVALID_ARGUMENT_LENGTH,
            "constraint 9 (\"Plane\"): indices: expected at least",
        ),
        (Many { counts: &[0], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "counts[0]"),
        (Many { counts: &[-4], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "counts[0]"),
        (Many { counts: &[5], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "nb_ids: expected a multiple of 5"),
        (Many { counts: &[4, 4], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "add up to 8, found 12"),
        (Many { counts: &[4, -1, 9], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "counts[1]"),
        (Many { counts: &[], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "add up to 0, found 12"),
        (Many { weights: &[1.0, 1.0], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "weights"),
        (Many { weights: &[], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "weights"),
        (Many { weights: &[1.0, -1.0, 1.0], ..base() }, SO_INVALID_VALUE, "constraint 10 (\"Plane\"): weight"),
        (Many { weights: &[f64::NAN], ..base() }, SO_INVALID_VALUE, "weight"),
        (Many { scalars: &[1.0], scalar_sets: 1, ..base() }, SO_INVALID_CONSTRAINT_TYPE, "no scalars"),
        (Many { scalars: &[1.0], ..base() }, SO_INVALID_ARGUMENT_LENGTH, "scalars"),
        (Many { scalar_sets: -1, ..base() }, SO_INVALID_ARGUMENT_LENGTH, "nb_scalar_sets"),
        (Many { scalar_sets: c_int::MAX, ..base() }, SO_INVALID_ARGUMENT_LENGTH, "nb_scalar_sets: expected 0, 1 or 3"),
        (Many { scalars: &[1.0], scalar_sets: 3, ..base() }, SO_INVALID_ARGUMENT_LENGTH, "nb_scalars"),
        (
            Many {
                type_name: "Closeness",
                counts: &[1],
                ids: &[0, 1],
                scalars: &targets[..4],
                scalar_sets: 2,
                ..base()
            },
            SO_INVALID_ARGUMENT_LENGTH,
            "constraint 9 (\"Closeness\"): scalars: expected 3",
        ),
    ];
    for (many, expected, message) in wrong {
        let (code, ids) = abi.add_many(&many);
        assert_eq!(code, expected, "{many:?}: {}", abi.message());
        assert!(abi.message().contains(message), "{many:?}: {}", abi.message());
        assert!(ids.iter().all(|id| *id == -7), "ids were written");
        assert_eq!(shapeop_constraintCount(abi.0), 9);
    }
    // SAFETY: counts are refused before their pointers are looked at; null is allowed.
    unsafe {
        let plane = c"Plane".as_ptr();
        let (null, none) = (ptr::null(), ptr::null());
        let add = |nb_ids, nb_counts, nb_weights, nb_scalars| {
            let ids = ptr::null_mut();
            shapeop_addConstraints(
                abi.0, plane, null, nb_ids, null, nb_counts, none, nb_weights, none, nb_scalars, 0, 0, ids,
            )
        };
        assert_eq!(add(4, 0, 0, 0), SO_NULL_POINTER);
        assert_eq!(add(0, 1, 0, 0), SO_NULL_POINTER);
        assert_eq!(add(0, 0, 1, 0), SO_NULL_POINTER);
        assert_eq!(add(0, 0, 0, 1), SO_NULL_POINTER);
        assert_eq!(add(-1, 0, 0, 0), SO_INVALID_ARGUMENT_LENGTH);
        assert_eq!(add(0, c_int::MIN, 0, 0), SO_INVALID_ARGUMENT_LENGTH);
        assert_eq!(add(c_int::MAX, 0, 0, 0), SO_NULL_POINTER);
        assert_eq!(add(0, 0, 0, 0), SO_SUCCESS);
    }
}

#[test]
fn shapes_are_given_per_point_of_their_own_constraint() {
    // Two constraints of 3 and 4 points, 2 shapes each: sets of 18 and 24 numbers.
    let points: Vec<f64> = (0..21).map(|i| f64::from((i * i) % 11)).collect();
    let abi = Abi::with_points(&points);
    let shapes: Vec<f64> = [&points[..9], &points[..9], &points[9..], &points[9..]].concat();
    let many = Many { type_name: "Similarity", ids: &[0, 1, 2, 3, 4, 5, 6], counts: &[3, 4], ..Many::default() };
    let (code, ids) = abi.add_many(&Many { scalars: &shapes, scalar_sets: 2, ..many });
    assert_eq!((code, ids), (SO_SUCCESS, vec![0, 1]), "{}", abi.message());
    let (_, violations) = abi.violations(2);
    assert!(violations.iter().all(|violation| *violation < 1e-12), "the points are their own shapes: {violations:?}");
    let many = Many { type_name: "Similarity", ids: &[0, 1, 2, 3, 4, 5, 6], counts: &[3, 4], ..Many::default() };
    let (code, _) = abi.add_many(&Many { scalars: &shapes[1..], scalar_sets: 2, ..many });
    assert_eq!(code, SO_INVALID_ARGUMENT_LENGTH);
    assert!(abi.message().contains("a multiple of 7"), "{}", abi.message());
}

#[test]
fn ids_are_never_reused_and_arrays_keep_the_place_of_removed_ones() {
    let abi = warped();
    let force = abi.gravity([0.0, 0.0, -1.0]);
    let other = abi.vertex_force([0.0, 1.0, 0.0], 2);
    assert_eq!((abi.init(), abi.solve(1)), (0, 0));
    assert_eq!(shapeop_removeConstraint(abi.0, 2), SO_SUCCESS);
    assert_eq!(shapeop_removeForce(abi.0, force), SO_SUCCESS);
    assert_eq!((shapeop_constraintCount(abi.0), shapeop_forceCount(abi.0)), (5, 2));
    assert_eq!([0, 1, 2, 3, 4, 5, -1].map(|id| shapeop_isConstraint(abi.0, id)), [1, 1, 0, 1, 1, 0, 0]);
    assert_eq!([0, 1, 2, -1].map(|id| shapeop_isForce(abi.0, id)), [0, 1, 0, 0]);
    let (code, violations) = abi.violations(5);
    assert_eq!((code, violations[2]), (SO_SUCCESS, 0.0));
    assert!(violations[1] > 0.0);
    for id in [2, 5, -1] {
        assert_eq!(shapeop_removeConstraint(abi.0, id), SO_UNMATCHING_CONSTRAINT_ID);
        assert_eq!(shapeop_setWeight(abi.0, id, 1.0), SO_UNMATCHING_CONSTRAINT_ID);
        assert_eq!(abi.edit("Closeness", id, &[0.0; 3]), SO_UNMATCHING_CONSTRAINT_ID);
        assert_eq!(shapeop_isDegenerate(abi.0, id), -1);
    }
    for id in [force, 2, -1] {
        assert_eq!(shapeop_removeForce(abi.0, id), SO_UNMATCHING_FORCE_ID);
        abi.edit_vertex_force(id, [0.0; 3], 0);
        assert!(abi.message().contains("force"), "{}", abi.message());
    }
    abi.edit_vertex_force(other, [0.0, 2.0, 0.0], 4);
    assert_eq!(abi.message(), "id: 4 is out of range for 4 points");
    assert_eq!(abi.add("Closeness", &[1], 1.0), 5);
    assert_eq!(abi.gravity([0.0; 3]), 2);
    assert_eq!(abi.solve(1), 0);
    assert_eq!(shapeop_removeForce(abi.0, other), SO_SUCCESS);
}

#[test]
fn weights_can_be_set_and_degenerate_constraints_are_told() {
    let abi = Abi::with_points(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let edge = abi.add("EdgeStrain", &[0, 1], 1.0);
    let short = abi.add("EdgeStrain", &[1, 2], 1.0);
    assert_eq!((shapeop_isDegenerate(abi.0, edge), shapeop_isDegenerate(abi.0, short)), (0, 1));
    assert_eq!(abi.edit("EdgeStrain", short, &[1.0; 3]), SO_SUCCESS);
    assert_eq!(shapeop_isDegenerate(abi.0, short), 0);
    assert_eq!((abi.init(), shapeop_unconstrainedCount(abi.0)), (0, 0));
    assert_eq!(shapeop_setWeight(abi.0, edge, 0.0), SO_SUCCESS);
    assert_eq!(shapeop_unconstrainedCount(abi.0), 1);
    for weight in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(shapeop_setWeight(abi.0, edge, weight), SO_INVALID_VALUE);
    }
}

extern "C" fn read_everything(progress: *const shapeop_progress, user: *mut c_void) -> c_int {
    // SAFETY: the test passes these.
    let (progress, seen) = unsafe { (&*progress, &mut *user.cast::<Seen>()) };
    let abi = std::mem::ManuallyDrop::new(Abi(seen.op));
    assert_eq!(progress.struct_size as usize, size_of::<shapeop_progress>());
    assert!(progress.energy.is_finite() && progress.largest_move >= 0.0);
    seen.iterations.push(progress.iteration);
    seen.points.push(abi.points());
    let (code, energy) = abi.energy();
    assert_eq!(code, SO_SUCCESS);
    assert!((energy - progress.energy).abs() <= 1e-12 * progress.energy.abs());
    assert_eq!(abi.violations(5).0, SO_SUCCESS);
    assert_eq!(abi.violations(4).0, SO_INVALID_ARGUMENT_LENGTH);
    assert_eq!(abi.message(), "nb: expected 5, the number of constraint ids; found 4");
    assert_eq!((shapeop_pointCount(abi.0), shapeop_constraintCount(abi.0), shapeop_forceCount(abi.0)), (4, 5, 0));
    assert_eq!((shapeop_isConstraint(abi.0, 0), shapeop_isDegenerate(abi.0, 0), shapeop_isForce(abi.0, 0)), (1, 0, 0));
    assert_eq!(shapeop_unconstrainedCount(abi.0), 0);
    // All else is busy.
    assert_eq!(abi.init(), 1);
    assert_eq!(abi.message(), "op: the solver is busy: from inside its progress callback it can only be read");
    assert_eq!(shapeop_initDynamic(abi.0, 1.0, 1.0, 1.0), 1);
    assert_eq!(abi.solve(1), 1);
    assert_eq!(abi.solve_until(1).0, SO_BUSY);
    assert_eq!(abi.add("Plane", &[0, 1, 2], 1.0), -1);
    assert_eq!(abi.add_many(&Many::default()).0, SO_BUSY);
    assert_eq!(abi.edit("Closeness", 1, &[9.0; 3]), SO_BUSY);
    assert_eq!(abi.gravity([1.0; 3]), -1);
    assert_eq!(abi.vertex_force([1.0; 3], 0), -1);
    abi.edit_vertex_force(0, [1.0; 3], 0);
    assert!(abi.message().contains("busy"));
    abi.set_points(&[5.0; 12]);
    assert!(abi.message().contains("busy"));
    assert_eq!(shapeop_setWeight(abi.0, 0, 5.0), SO_BUSY);
    assert_eq!(shapeop_removeConstraint(abi.0, 0), SO_BUSY);
    assert_eq!(shapeop_removeForce(abi.0, 0), SO_BUSY);
    assert_eq!(shapeop_setThreadCount(abi.0, 2), SO_BUSY);
    assert_eq!(shapeop_setAcceleration(abi.0, 1, 0), SO_BUSY);
    assert_eq!(shapeop_setLinearSolver(abi.0, 1), SO_BUSY);
    assert_eq!(shapeop_setBackend(abi.0, 0), SO_BUSY);
    // SAFETY: null is allowed.
    assert_eq!(unsafe { shapeop_setBackendOptions(abi.0, ptr::null(), 0.0, 0.0) }, SO_BUSY);
    assert_eq!((shapeop_getBackend(abi.0), text(shapeop_backendReason(abi.0)).as_str()), (0, ""));
    shapeop_delete(abi.0);
    assert!(abi.message().contains("busy"));
    // Another solver is not, not even inside a callback of its own, from which the first can still be read.
    let inner = warped();
    assert_eq!(inner.init(), 0);
    extern "C" fn read_outer(_: *const shapeop_progress, user: *mut c_void) -> c_int {
        c_int::from(shapeop_pointCount(user.cast()) != 4)
    }
    let mut found = report();
    // SAFETY: the report carries its size.
    let code = unsafe { shapeop_solveUntil(inner.0, ptr::null(), Some(read_outer), abi.0.cast(), &mut found) };
    assert_eq!((code, found.outcome), (SO_SUCCESS, SO_OUTCOME_CONVERGED));
    c_int::from(progress.iteration == seen.stop_at)
}

struct Seen {
    op: *mut ShapeOpSolver,
    iterations: Vec<u32>,
    points: Vec<Vec<f64>>,
    stop_at: u32,
}

#[test]
fn the_callback_reads_the_current_iterate_and_can_cancel() {
    let abi = warped();
    abi.set_points(&WARPED.map(|c| 2.0 * c + c * c));
    assert_eq!(shapeop_setAcceleration(abi.0, 0, 0), SO_SUCCESS);
    assert_eq!(abi.init(), 0);
    let mut seen = Seen { op: abi.0, iterations: Vec::new(), points: Vec::new(), stop_at: 3 };
    let mut found = report();
    // SAFETY: the report carries its size, the callback's user pointer is what it expects.
    let code =
        unsafe { shapeop_solveUntil(abi.0, ptr::null(), Some(read_everything), (&raw mut seen).cast(), &mut found) };
    assert_eq!((code, found.outcome, found.iterations), (SO_SUCCESS, SO_OUTCOME_CANCELLED, 3));
    assert_eq!(abi.message(), "");
    assert_eq!(seen.iterations, [1, 2, 3]);
    assert_eq!(seen.points[2], abi.points(), "what was reached is kept");
    assert_ne!(seen.points[0], seen.points[1]);
    assert!(found.energy_after < found.energy_before);
    // The same as plain iterations: nothing of what the callback tried was carried out.
    let plain = warped();
    plain.set_points(&WARPED.map(|c| 2.0 * c + c * c));
    assert_eq!((plain.init(), plain.solve(3)), (0, 0));
    assert_eq!(plain.points(), abi.points());
    // Out of the callback all is open again.
    assert_eq!(abi.solve(1), 0);
}

#[test]
fn a_solver_that_another_thread_solves_is_busy_and_nobody_waits() {
    /// Tells that it is solving, and solves until it is told to stop.
    struct Pause {
        is_solving: mpsc::Sender<()>,
        go_on: mpsc::Receiver<()>,
    }
    extern "C" fn pause(_: *const shapeop_progress, user: *mut c_void) -> c_int {
        // SAFETY: the test passes this.
        let pause = unsafe { &*user.cast::<Pause>() };
        pause.is_solving.send(()).unwrap();
        pause.go_on.recv_timeout(Duration::from_secs(60)).unwrap();
        1
    }
    let abi = warped();
    assert_eq!(abi.init(), 0);
    let (is_solving, solving) = mpsc::channel();
    let (stop, go_on) = mpsc::channel();
    std::thread::scope(|scope| {
        let abi = &abi;
        let solve = scope.spawn(move || {
            let mut pause_state = Pause { is_solving, go_on };
            let user = (&raw mut pause_state).cast();
            // SAFETY: the callback's user pointer is what it expects.
            unsafe { shapeop_solveUntil(abi.0, ptr::null(), Some(pause), user, ptr::null_mut()) }
        });
        solving.recv().unwrap();
        let busy = "op: the solver is busy: another call is using it";
        let mut points = [7.0; 12];
        // SAFETY: as long as it says.
        unsafe { shapeop_getPoints(abi.0, points.as_mut_ptr(), 4) };
        assert_eq!((points, abi.message().as_str()), ([7.0; 12], busy));
        assert_eq!((abi.init(), abi.solve(1), shapeop_pointCount(abi.0)), (1, 1, -1));
        assert_eq!((abi.add("Closeness", &[0], 1.0), abi.gravity([0.0; 3])), (-1, -1));
        assert_eq!((abi.energy().0, abi.violations(5).0), (SO_BUSY, SO_BUSY));
        assert_eq!(abi.edit("Closeness", 1, &[0.0; 3]), SO_BUSY);
        shapeop_delete(abi.0);
        assert_eq!(abi.message(), busy);
        // The refusal stays with this thread, under any bad handle too; the solving thread does not see it.
        assert_eq!(last_error(ptr::null_mut()), busy);
        let elsewhere = scope.spawn(|| last_error(ptr::null_mut())).join().unwrap();
        assert_eq!(elsewhere, "");
        let other = warped();
        assert_eq!((other.init(), other.solve(5)), (0, 0));
        assert_eq!(abi.solve(1), 1);
        stop.send(()).unwrap();
        assert_eq!(solve.join().unwrap(), SO_SUCCESS);
        assert_eq!(abi.message(), busy, "the success of the solve does not hide this thread's refusal");
    });
    assert_eq!((shapeop_pointCount(abi.0), shapeop_constraintCount(abi.0), shapeop_forceCount(abi.0)), (4, 5, 0));
    assert_eq!(abi.message(), "");
}

#[test]
fn messages_belong_to_the_last_call_and_can_be_read_by_another_thread() {
    let abi = warped();
    assert_eq!(abi.message(), "");
    assert_eq!(abi.solve(1), 1);
    let not_initialised = abi.message();
    assert!(not_initialised.contains("not initialised"), "{not_initialised}");
    assert_eq!(abi.message(), not_initialised, "reading it does not clear it");
    std::thread::scope(|scope| {
        let abi = &abi;
        scope
            .spawn(move || {
                assert_eq!(last_error(abi.0), not_initialised);
                assert_eq!(last_error(ptr::null_mut()), "", "this thread made no call");
                assert_eq!(abi.add("Plain", &[], 1.0), -1);
            })
            .join()
            .unwrap();
    });
    assert!(abi.message().contains("\"Plain\" is not one of"), "the newest message of the solver: {}", abi.message());
    assert!(last_error(ptr::null_mut()).contains("not initialised"), "this thread's own");
    let other = Abi::new();
    assert_eq!(other.message(), "");
    assert_eq!(shapeop_pointCount(abi.0), 4);
    assert_eq!(abi.message(), "", "a call that succeeds clears it");
    // The text is a copy that lives until this thread's next call of lastError.
    assert_eq!(abi.add("Plain", &[], 1.0), -1);
    let kept = shapeop_lastError(abi.0);
    assert_eq!((abi.init(), abi.solve(1)), (0, 0));
    assert!(text(kept).contains("Plain"));
}

#[test]
fn setters_without_a_result_leave_a_message_and_its_code() {
    let abi = warped();
    assert_eq!(shapeop_initDynamic(abi.0, 1.0, 1.0, 0.5), 0);
    for (set, name) in [
        (shapeop_setTimeStep as extern "C" fn(*mut ShapeOpSolver, f64), "timestep"),
        (shapeop_setDamping as extern "C" fn(*mut ShapeOpSolver, f64), "damping"),
    ] {
        for value in [-1.0, f64::NAN, f64::INFINITY] {
            set(abi.0, value);
            assert!(abi.message().starts_with(name), "{}", abi.message());
            assert_eq!(shapeop_lastErrorCode(abi.0), SO_INVALID_VALUE);
        }
        set(abi.0, 0.25);
        assert_eq!((abi.message().as_str(), shapeop_lastErrorCode(abi.0)), ("", SO_SUCCESS));
    }
}

#[test]
fn solve_until_keeps_to_its_options() {
    let start = || {
        let abi = warped();
        abi.set_points(&WARPED.map(|c| 2.0 * c + c * c));
        assert_eq!(abi.init(), 0);
        abi
    };
    let (code, limited) = start().solve_until(2);
    assert_eq!((code, limited.outcome, limited.iterations), (SO_SUCCESS, SO_OUTCOME_ITERATION_LIMIT, 2));
    assert_eq!(limited.unconstrained_count, 0);
    let (code, converged) = start().solve_until(100_000);
    assert_eq!((code, converged.outcome), (SO_SUCCESS, SO_OUTCOME_CONVERGED));
    assert!(converged.largest_move < options().tolerance && converged.iterations > 2);
    assert!(converged.energy_after < limited.energy_after && limited.energy_after < limited.energy_before);
    for seconds in
        [converged.analysis_seconds, converged.factorisation_seconds, converged.local_seconds, converged.global_seconds]
    {
        assert!(seconds > 0.0 && seconds < 60.0);
    }
    // Null options and null report are allowed.
    let abi = start();
    // SAFETY: null is allowed.
    let code = unsafe { shapeop_solveUntil(abi.0, ptr::null(), None, ptr::null_mut(), ptr::null_mut()) };
    assert_eq!(code, SO_SUCCESS);
    let (_, again) = abi.solve_until(1);
    assert!(again.energy_before <= converged.energy_after * (1.0 + 1e-9), "{} iterations", converged.iterations);
    let mut found = report();
    for (bad, place) in [
        (shapeop_solve_options { tolerance: f64::NAN, ..options() }, "tolerance"),
        (shapeop_solve_options { tolerance: -1.0, ..options() }, "tolerance"),
        (shapeop_solve_options { time_budget_seconds: f64::INFINITY, ..options() }, "time_budget_seconds"),
    ] {
        // SAFETY: both carry their size.
        let code = unsafe { shapeop_solveUntil(abi.0, &bad, None, ptr::null_mut(), &mut found) };
        assert_eq!(code, SO_INVALID_VALUE);
        assert!(abi.message().starts_with(place), "{}", abi.message());
        assert_eq!(found.energy_before, -1.0, "the report is written on success only");
    }
    let hurried = shapeop_solve_options { time_budget_seconds: 1e-9, tolerance: 0.0, ..options() };
    // SAFETY: both carry their size.
    let code = unsafe { shapeop_solveUntil(abi.0, &hurried, None, ptr::null_mut(), &mut found) };
    assert_eq!((code, found.outcome, found.iterations), (SO_SUCCESS, SO_OUTCOME_TIME_BUDGET, 1));
}

#[test]
fn the_linear_solver_can_be_set_and_the_report_says_which_ran() {
    let abi = warped();
    assert_eq!(abi.init(), 0);
    for (number, expected) in [
        (shapeop_linear_solver::SO_LINEAR_SOLVER_CONJUGATE_GRADIENTS, "CONJUGATE_GRADIENTS"),
        (shapeop_linear_solver::SO_LINEAR_SOLVER_DIRECT, "DIRECT"),
        (shapeop_linear_solver::SO_LINEAR_SOLVER_AUTOMATIC, "DIRECT"),
    ] {
        abi.set_points(&WARPED);
        assert_eq!(shapeop_setLinearSolver(abi.0, number as c_int), SO_SUCCESS);
        // A refused number changes nothing.
        for bad in [-1, 3, c_int::MAX, c_int::MIN] {
            assert_eq!(shapeop_setLinearSolver(abi.0, bad), SO_INVALID_VALUE);
            let expected = "linear_solver: expected 0 (automatic), 1 (direct) or 2 (conjugate gradients), found";
            assert!(abi.message().starts_with(expected), "{}", abi.message());
        }
        let (code, report) = abi.solve_until(1);
        assert_eq!(code, SO_SUCCESS);
        assert!(format!("{:?}", report.linear_solver).ends_with(expected));
        assert_eq!(report.linear_iterations > 0, expected == "CONJUGATE_GRADIENTS");
        // As in the test by hand: z = z₀ / 5.
        for (found, start) in abi.points().chunks_exact(3).zip(WARPED.chunks_exact(3)) {
            assert!((found[2] - start[2] / 5.0).abs() < 1e-12);
        }
    }
}

#[test]
fn an_unbounded_solve_is_an_outcome_with_a_message() {
    let abi = warped();
    for id in 1..=4 {
        assert_eq!(shapeop_removeConstraint(abi.0, id), SO_SUCCESS);
    }
    abi.gravity([0.0, 0.0, -1.0]);
    assert_eq!(abi.init(), 0);
    let (code, found) = abi.solve_until(10);
    assert_eq!((code, found.outcome, found.iterations), (SO_SUCCESS, SO_OUTCOME_UNBOUNDED, 0));
    assert!(abi.message().contains("component of point 0"), "{}", abi.message());
    assert_eq!(abi.points(), WARPED);
}

/// Bytes that hold a struct at their beginning, aligned as it is.
#[repr(C, align(16))]
struct Room([u8; 8192]);

#[test]
fn shorter_structs_mean_defaults_and_longer_ones_must_ask_for_nothing_more() {
    let abi = warped();
    assert_eq!(abi.init(), 0);
    let run = |options: *const shapeop_solve_options, report: *mut shapeop_solve_report| {
        // SAFETY: the test passes rooms that are longer than the sizes they state.
        unsafe { shapeop_solveUntil(abi.0, options, None, ptr::null_mut(), report) }
    };
    let with_size = |size: usize| shapeop_solve_options { struct_size: size as u32, tolerance: 0.5, ..options() };
    let mut found = report();
    // An old caller has only `max_iterations`: what lies behind is not its tolerance. 0.5 would end after 1 iteration.
    abi.set_points(&WARPED.map(|c| 2.0 * c + c * c));
    let old = shapeop_solve_options { max_iterations: 2, ..with_size(offset_of!(shapeop_solve_options, tolerance)) };
    assert_eq!((run(&old, &mut found), found.outcome), (SO_SUCCESS, SO_OUTCOME_ITERATION_LIMIT));
    let full = with_size(size_of::<shapeop_solve_options>());
    assert_eq!((run(&full, &mut found), found.outcome, found.iterations), (SO_SUCCESS, SO_OUTCOME_CONVERGED, 1));
    let whole = size_of::<shapeop_solve_options>();
    for size in [0, 1, 4, 7, 9, 12, 20, whole - 1, 4097, u32::MAX as usize] {
        assert_eq!(run(&with_size(size), ptr::null_mut()), SO_INVALID_VALUE, "size {size}");
        assert!(abi.message().starts_with("options->struct_size: expected"), "{}", abi.message());
    }
    // A newer caller.
    let mut room = Room([0; 8192]);
    let newer = room.0.as_mut_ptr().cast::<shapeop_solve_options>();
    // SAFETY: the room is large enough.
    unsafe { newer.write(with_size(whole + 16)) };
    assert_eq!((run(newer, &mut found), found.iterations), (SO_SUCCESS, 1));
    room.0[whole + 15] = 1;
    let newer = room.0.as_mut_ptr().cast::<shapeop_solve_options>();
    assert_eq!(run(newer, &mut found), SO_INVALID_VALUE);
    assert!(abi.message().contains("does not know"), "{}", abi.message());

    // Reports: nothing is written beyond the caller's size, and its size stays.
    for (size, is_good) in [
        (offset_of!(shapeop_solve_report, energy_before), true),
        (offset_of!(shapeop_solve_report, analysis_seconds), true),
        (offset_of!(shapeop_solve_report, evaluations), true),
        (offset_of!(shapeop_solve_report, backend), true),
        (size_of::<shapeop_solve_report>(), true),
        (size_of::<shapeop_solve_report>() + 8, true),
        (4096, true),
        (0, false),
        (4, false),
        (8, false),
        (size_of::<shapeop_solve_report>() - 4, false),
        (4104, false),
    ] {
        let mut room = Room([0xa5; 8192]);
        room.0[..4].copy_from_slice(&(size as u32).to_ne_bytes());
        let code = run(ptr::null(), room.0.as_mut_ptr().cast());
        assert_eq!(code, if is_good { SO_SUCCESS } else { SO_INVALID_VALUE }, "size {size}");
        assert_eq!(room.0[..4], (size as u32).to_ne_bytes());
        let written = if is_good { size.min(size_of::<shapeop_solve_report>()) } else { 4 };
        assert!(room.0[written..].iter().all(|byte| *byte == 0xa5), "size {size}");
        assert!(!is_good || room.0[8..12] != [0xa5; 4], "iterations were written");
    }
    // SAFETY: null and sizes are allowed.
    unsafe {
        assert_eq!(shapeop_defaultSolveOptions(ptr::null_mut()), SO_NULL_POINTER);
        let mut unset = shapeop_solve_options { struct_size: 0, ..options() };
        assert_eq!(shapeop_defaultSolveOptions(&mut unset), SO_INVALID_VALUE);
    }
    let misaligned = room.0.as_mut_ptr().wrapping_add(1).cast();
    assert_eq!(run(misaligned, ptr::null_mut()), SO_INVALID_VALUE);
}

#[test]
fn energy_and_violations_are_those_of_the_current_points() {
    let abi = warped();
    // ½ · 4 · 0.1² for the plane, nothing for closeness.
    let (code, energy) = abi.energy();
    assert_eq!(code, SO_SUCCESS);
    assert!((energy - 0.02).abs() < 1e-15);
    for length in [0, 4, 6] {
        let (code, numbers) = abi.violations(length);
        assert_eq!(code, SO_INVALID_ARGUMENT_LENGTH);
        assert!(numbers.iter().all(|number| number.is_nan()), "written");
    }
    // SAFETY: null and negative counts are allowed.
    unsafe {
        assert_eq!(shapeop_getViolations(abi.0, ptr::null_mut(), 5), SO_NULL_POINTER);
        assert_eq!(shapeop_getViolations(abi.0, ptr::null_mut(), -5), SO_INVALID_ARGUMENT_LENGTH);
        assert_eq!(shapeop_energy(abi.0, ptr::null_mut()), SO_NULL_POINTER);
    }
    // What would not be finite is refused.
    abi.set_points(&WARPED.map(|c| c * 1e200));
    let (code, energy) = abi.energy();
    assert_eq!(code, SO_INVALID_VALUE, "{energy}");
    assert!(energy.is_nan(), "written");
}

#[test]
fn pointers_and_counts_are_checked() {
    let abi = warped();
    let mut room = Room([0; 8192]);
    let misaligned = room.0.as_mut_ptr().wrapping_add(1);
    // SAFETY: null, negative counts and misaligned addresses are allowed; nothing is read there.
    unsafe {
        for (points, count, word) in [
            (ptr::null_mut(), 4, "null"),
            (misaligned.cast(), 4, "multiple of 8"),
            (ptr::null_mut(), -1, "at least 0"),
            (ptr::null_mut(), c_int::MAX, "null"),
            (ptr::null_mut(), c_int::MIN, "at least 0"),
        ] {
            shapeop_setPoints(abi.0, points, count);
            assert!(abi.message().contains(word), "{}", abi.message());
        }
        for (points, count, word) in [(ptr::null_mut(), 4, "null"), (misaligned.cast(), 4, "multiple of 8")] {
            shapeop_getPoints(abi.0, points, count);
            assert!(abi.message().contains(word), "{}", abi.message());
        }
        assert_eq!(shapeop_addGravityForce(abi.0, ptr::null_mut()), -1);
        assert_eq!(abi.message(), "force: expected a pointer, found null");
        assert_eq!(shapeop_addVertexForce(abi.0, ptr::null_mut(), 0), -1);
        shapeop_editVertexForce(abi.0, 0, ptr::null_mut(), 0);
        assert_eq!(abi.message(), "force: expected a pointer, found null");
        assert_eq!(shapeop_addConstraint(abi.0, ptr::null(), ptr::null_mut(), 0, 1.0), -1);
        assert_eq!(abi.message(), "constraint_type: expected a pointer, found null");
        assert_eq!(shapeop_addConstraint(abi.0, c"Plane".as_ptr(), ptr::null_mut(), 3, 1.0), -1);
        assert_eq!(abi.message(), "ids: expected a pointer, found null");
        assert_eq!(shapeop_addConstraint(abi.0, c"Plane".as_ptr(), ptr::null_mut(), -3, 1.0), -1);
        assert_eq!(abi.message(), "nb_ids: expected a count of at least 0, found -3");
        // No points at all need no pointer.
        let empty = Abi::new();
        shapeop_setPoints(empty.0, ptr::null_mut(), 0);
        shapeop_getPoints(empty.0, ptr::null_mut(), 0);
        assert_eq!((empty.message().as_str(), empty.init(), empty.solve(3)), ("", 0, 0));
    }
    for threads in [-1, 1025, c_int::MAX] {
        assert_eq!(shapeop_setThreadCount(abi.0, threads) as c_int, if threads < 0 { 2 } else { 16 });
    }
    assert_eq!(shapeop_setThreadCount(abi.0, 2), SO_SUCCESS);
    assert_eq!((abi.points(), shapeop_constraintCount(abi.0)), (WARPED.to_vec(), 5));
}

/// A grid of `n × n` warped quads, each with a plane, every corner with a closeness of weight 0.05.
fn warped_grid(n: i32) -> Abi {
    let height = |i: i32| f64::from(i * 7919 % 101) / 101.0;
    let points: Vec<f64> =
        (0..n * n).flat_map(|i| [f64::from(i % n), f64::from(i / n), f64::from(i / n) * 0.2 + height(i)]).collect();
    let abi = Abi::with_points(&points);
    for corner in (0..n * (n - 1)).filter(|i| i % n + 1 < n) {
        abi.add("Plane", &[corner, corner + 1, corner + n + 1, corner + n], 1.0);
    }
    for i in 0..n * n {
        abi.add("Closeness", &[i], 0.05);
    }
    assert_eq!(abi.init(), 0);
    abi
}

#[test]
fn acceleration_is_set_by_number_and_what_is_none_is_refused() {
    let abi = warped_grid(8);
    let start = abi.points();
    for (kind, memory, message) in [
        (-1, 0, "kind: expected a shapeop_acceleration, 0 to 3, found -1"),
        (4, 0, "kind: expected a shapeop_acceleration, 0 to 3, found 4"),
        (c_int::MAX, 65, "kind: expected a shapeop_acceleration, 0 to 3, found 2147483647"),
        (1, 65, "memory: expected 1 to 64, or 0 for the default, found 65"),
        (0, u32::MAX, "memory: expected 1 to 64, or 0 for the default, found 4294967295"),
    ] {
        assert_eq!(shapeop_setAcceleration(abi.0, kind, memory), SO_INVALID_VALUE);
        assert_eq!(abi.message(), message);
    }
    // What was refused changed nothing: solve is plain, and the same as none.
    let solved = |kind: Option<shapeop_acceleration>| {
        abi.set_points(&start);
        if let Some(kind) = kind {
            assert_eq!(shapeop_setAcceleration(abi.0, kind as c_int, 0), SO_SUCCESS);
        }
        assert_eq!(abi.solve(20), 0);
        (abi.points(), abi.energy().1)
    };
    let plain = solved(None);
    assert!(solved(Some(shapeop_acceleration::SO_ACCELERATION_NONE)) == plain);
    assert!(solved(Some(shapeop_acceleration::SO_ACCELERATION_AUTOMATIC)) == plain);
    for kind in [shapeop_acceleration::SO_ACCELERATION_ANDERSON, shapeop_acceleration::SO_ACCELERATION_QUASI_NEWTON] {
        let (_, energy) = solved(Some(kind));
        assert!(energy < plain.1, "{kind:?}: {energy:e} is not below {:e}", plain.1);
    }
}

#[test]
fn the_report_counts_evaluations_rejections_and_factorisations() {
    let abi = warped_grid(8);
    let start = abi.points();
    let run = |kind: shapeop_acceleration| {
        abi.set_points(&start);
        assert_eq!(shapeop_setAcceleration(abi.0, kind as c_int, 6), SO_SUCCESS);
        let (code, report) = abi.solve_until(60);
        assert_eq!(code, SO_SUCCESS);
        report
    };
    let rejected = |report: &shapeop_solve_report| report.rejected_energy_rose + report.rejected_not_finite;
    let plain = run(shapeop_acceleration::SO_ACCELERATION_NONE);
    assert_eq!((plain.iterations, plain.evaluations, rejected(&plain)), (60, 60, 0));
    assert_eq!((plain.rejected_ill_conditioned, plain.rejected_not_descent, plain.rejected_line_search), (0, 0, 0));
    for kind in [shapeop_acceleration::SO_ACCELERATION_ANDERSON, shapeop_acceleration::SO_ACCELERATION_QUASI_NEWTON] {
        let report = run(kind);
        // Every iteration ends with an evaluation that is kept.
        assert_eq!(report.evaluations, report.iterations + rejected(&report), "{kind:?}");
        assert!(report.energy_after < plain.energy_after, "{kind:?}");
    }

    // Moving a target and points costs nothing, a weight one factorisation, a constraint within the pattern no ordering.
    let closeness = 7 * 7;
    let counts = || {
        let (code, report) = abi.solve_until(1);
        assert_eq!(code, SO_SUCCESS);
        (report.ordering_count, report.factorisation_count)
    };
    assert_eq!(counts(), (1, 1));
    abi.set_points(&start);
    assert_eq!((abi.edit("Closeness", closeness, &[0.0, 0.0, 1.0]), counts()), (SO_SUCCESS, (1, 1)));
    assert_eq!((shapeop_setWeight(abi.0, closeness, 2.0), counts()), (SO_SUCCESS, (1, 2)));
    assert_eq!((shapeop_removeConstraint(abi.0, 0), counts()), (SO_SUCCESS, (1, 3)));
    assert_eq!((abi.add("Plane", &[0, 1, 9, 8], 1.0) > 0, counts()), (true, (1, 4)));
    assert_eq!((abi.add("EdgeStrain", &[0, 63], 1.0) > 0, counts()), (true, (2, 5)));
}

#[test]
fn the_registry_by_index_says_what_the_library_knows() {
    let types: Vec<_> = shapeop::constraints::types().collect();
    assert_eq!(shapeop_constraintTypeCount(), types.len() as c_int);
    for (index, info) in types.iter().enumerate() {
        let index = index as c_int;
        let mut room = Room([0xa5; 8192]);
        let out = room.0.as_mut_ptr().cast::<shapeop_constraint_type>();
        // SAFETY: the room is larger than the struct, whose size is set.
        let told = unsafe {
            out.cast::<u32>().write(size_of::<shapeop_constraint_type>() as u32);
            assert_eq!(shapeop_constraintType(index, out), SO_SUCCESS);
            &*out
        };
        assert_eq!(text(told.name), info.name);
        assert_eq!(text(told.help), info.help);
        assert_eq!(text(told.violation_unit), info.violation_unit);
        assert_eq!(told.least_indices as usize, info.least_indices);
        assert_eq!(told.greatest_indices, info.greatest_indices.map_or(-1, |most| most as c_int));
        assert_eq!(told.edited_as.is_null(), info.edited_as.is_none());
        for position in 0..told.index_name_count {
            let name = text(shapeop_constraintIndexName(index, position));
            assert_eq!(name, info.index_names[position as usize]);
        }
        assert!(shapeop_constraintIndexName(index, told.index_name_count).is_null());
        for scalar in 0..told.scalar_count {
            let size = size_of::<shapeop_constraint_scalar>() as u32;
            let (name, none) = (ptr::null(), f64::NAN);
            let mut out = shapeop_constraint_scalar { struct_size: size, has_default: -1, default_value: none, name };
            // SAFETY: it carries its size.
            assert_eq!(unsafe { shapeop_constraintScalar(index, scalar, &mut out) }, SO_SUCCESS);
            assert!(!text(out.name).is_empty() && out.default_value.is_finite() && out.struct_size == size);
            assert!(out.has_default == 0 || out.has_default == 1);
        }
        // Every type can be added with its least number of indices, and edited as it says.
        let abi = Abi::with_points(&(0..60).map(|i| f64::from(i * i % 13)).collect::<Vec<_>>());
        abi.any_references();
        let ids: Vec<c_int> = (0..told.least_indices).collect();
        assert_eq!(abi.add(info.name, &ids, 1.0), 0, "{}", abi.message());
        assert_eq!(abi.edit(info.name, 0, &[]) == SO_INVALID_CONSTRAINT_TYPE, told.scalar_count == 0);
    }
    for index in [-1, types.len() as c_int, c_int::MAX, c_int::MIN] {
        let mut room = Room([0xa5; 8192]);
        let out = room.0.as_mut_ptr().cast::<shapeop_constraint_type>();
        // SAFETY: the room is larger than the struct, whose size is set.
        unsafe {
            out.cast::<u32>().write(size_of::<shapeop_constraint_type>() as u32);
            assert_eq!(shapeop_constraintType(index, out), SO_INVALID_VALUE);
            assert_eq!(shapeop_constraintScalar(index, 0, ptr::null_mut()), SO_NULL_POINTER);
        }
        assert!(room.0[4..].iter().all(|byte| *byte == 0xa5));
        assert!(shapeop_constraintIndexName(index, 0).is_null());
    }
    assert!(last_error(ptr::null_mut()).contains("out of range"));
}

#[test]
fn versions_and_error_texts_are_told() {
    assert_eq!(text(shapeop_version()), env!("CARGO_PKG_VERSION"));
    assert_eq!(shapeop_abiVersion(), SHAPEOP_ABI_VERSION);
    assert_eq!(text(shapeop_errorText(0)), "success");
    for &status in shapeop::error::Status::ALL {
        assert_eq!(text(shapeop_errorText(status as c_int)), status.text());
    }
    for none in [-1, 4, 15, 99, c_int::MAX, c_int::MIN] {
        assert_eq!(text(shapeop_errorText(none)), "not an error code of this library");
    }
}

#[test]
fn solvers_are_used_from_many_threads_at_once() {
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for _ in 0..200 {
                    let abi = warped();
                    assert_eq!((abi.init(), abi.solve(3)), (0, 0));
                    let gone = abi.0;
                    drop(abi);
                    assert_eq!(shapeop_pointCount(gone), -1);
                }
            });
        }
    });
    // One solver, torn at by many threads: each call is carried out or refused as busy, and none is lost.
    let abi = Abi::with_points(&WARPED);
    let added: i32 = std::thread::scope(|scope| {
        let add = || (0..500).filter(|_| abi.add("Closeness", &[0], 1.0) >= 0).count() as i32;
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(add)).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).sum()
    });
    assert_eq!(shapeop_constraintCount(abi.0), added);
}
