//! The C functions for reference shapes and for forces on faces: that they do what the Rust API does, and what they refuse.

mod abi;

use std::ffi::c_int;
use std::ptr;

use abi::Abi;
use glam::DVec3;
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;
use shapeop::problem::{Faces, Force, Reference};
use shapeop::solver::Solver;

const POINTS: [f64; 12] = [0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 1.0, 1.0, 0.5, 0.0, 1.0, 0.0];
const CURVE: [f64; 9] = [0.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 2.0, 1.0];

fn points(coordinates: &[f64]) -> Vec<DVec3> {
    coordinates.chunks(3).map(DVec3::from_slice).collect()
}

#[test]
fn references_are_copied_and_their_ids_are_scalars() {
    let abi = Abi::with_points(&POINTS);
    let mut own = CURVE;
    assert_eq!((abi.polyline(&own, 0), abi.polyline(&own, 1), abi.mesh(&own, &[0, 1, 2])), (0, 1, 2));
    own.fill(f64::NAN);
    assert_eq!(shapeop_referenceCount(abi.0), 3);
    let twin = CURVE.chunks(3).map(|point| [point[0], point[1], point[2]]).collect::<Vec<_>>();
    let mut solver = Solver::new();
    for closed in [false, true] {
        solver.add_reference(&Reference::Polyline { points: twin.clone(), closed }).unwrap();
    }
    solver.add_reference(&Reference::Mesh { points: twin, triangles: vec![[0, 1, 2]] }).unwrap();
    solver.set_points(&points(&POINTS)).unwrap();
    for (i, (type_name, reference)) in
        [("OnCurve", 0.0), ("OnCurve", 1.0), ("OnMesh", 2.0), ("OnMesh", 2.0)].iter().enumerate()
    {
        assert_eq!(abi.add(type_name, &[i as c_int], 1.0), i as c_int, "{}", abi.message());
        solver.add_constraint(type_name, &[i as u32], 1.0).unwrap();
        assert_eq!(abi.edit(type_name, i as c_int, &[*reference]), SO_SUCCESS);
        solver.edit_constraint(type_name, i, &[*reference]).unwrap();
    }
    assert_eq!((abi.init(), abi.solve(3)), (0, 0));
    solver.init().unwrap();
    solver.solve(3).unwrap();
    assert_eq!(points(&abi.points()), solver.points());
    assert_eq!(abi.violations(4).1, solver.violations());
    // The third point lies over the mesh, at the height 1.
    assert!(abi.points()[8] == 1.0 && abi.points()[6] == 1.0);
}

#[test]
fn shapes_that_are_none_are_refused_by_name() {
    let abi = Abi::with_points(&POINTS);
    let mut bad = CURVE;
    bad[4] = f64::INFINITY;
    let says = |id: c_int, words: &str| {
        assert_eq!(id, -1, "{words}");
        assert!(abi.message().contains(words), "{} lacks {words}", abi.message());
        assert_eq!(shapeop_referenceCount(abi.0), 0);
    };
    says(abi.polyline(&CURVE[..3], 1), "points: expected at least 2, found 1");
    says(abi.polyline(&bad, 1), "points[1]: expected finite coordinates");
    says(abi.polyline(&CURVE, 2), "is_closed: expected 0 or 1, found 2");
    says(abi.mesh(&CURVE, &[]), "triangles: expected at least 1, found 0");
    says(abi.mesh(&CURVE, &[0, 1, 2, 0, 1, 3]), "triangles[1][2]: 3 is out of range for 3 points");
    says(abi.mesh(&CURVE, &[0, -1, 2]), "triangles[0][1]: -1 is out of range for 3 points");
    says(abi.mesh(&bad, &[0, 1, 2]), "points[1]: expected finite coordinates");
    // SAFETY: null is allowed, and what counts below 0 is not read.
    unsafe {
        says(shapeop_addReferencePolyline(abi.0, ptr::null(), 2, 0), "points: expected a pointer, found null");
        says(shapeop_addReferencePolyline(abi.0, CURVE.as_ptr(), -1, 0), "nb_points: expected a count of at least 0");
        says(shapeop_addReferenceMesh(abi.0, CURVE.as_ptr(), 3, ptr::null(), 1), "triangles: expected a pointer");
        says(shapeop_addReferenceMesh(abi.0, CURVE.as_ptr(), 3, [0].as_ptr(), -1), "nb_triangles: expected a count");
        assert_eq!(shapeop_addReferencePolyline(ptr::null_mut(), CURVE.as_ptr(), 3, 0), -1);
    }
    assert_eq!(shapeop_referenceCount(ptr::null_mut()), -1);
    // Constraints without a reference of their kind.
    assert_eq!(abi.add("OnCurve", &[0], 1.0), -1);
    assert!(abi.message().contains("scalars[0]: expected the id of a polyline, found none among 0 references"));
    abi.any_references();
    assert_eq!(abi.add("OnMesh", &[0], 1.0), 0);
    for (wrong, words) in
        [(0.0, "which is a polyline"), (2.0, "2 is out of range for 2 references"), (0.5, "found 0.5")]
    {
        assert_ne!(abi.edit("OnMesh", 0, &[wrong]), SO_SUCCESS);
        assert!(abi.message().contains("scalars[0]") && abi.message().contains(words), "{}", abi.message());
    }
}

#[test]
fn forces_on_faces_are_those_of_the_rust_api() {
    let faces = [0, 1, 2, 3, 0, 1, 3];
    let abi = Abi::with_points(&POINTS);
    let mut solver = Solver::new();
    solver.set_points(&points(&POINTS)).unwrap();
    for i in 0..4 {
        abi.add("Closeness", &[i], 1.0);
        solver.add_constraint("Closeness", &[i as u32], 1.0).unwrap();
    }
    assert_eq!((abi.pressure(&faces, &[4, 3], 0.5), abi.normal_force(&faces[4..], &[3], 9.0)), (0, 1));
    assert_eq!(shapeop_editForceMagnitude(abi.0, 1, -0.25), SO_SUCCESS);
    let both: Faces = [&[0, 1, 2, 3][..], &[0, 1, 3]].into_iter().collect();
    solver.add_force(Force::Pressure { pressure: 0.5, faces: both }).unwrap();
    solver.add_force(Force::Normal { magnitude: -0.25, faces: [[0, 1, 3]].iter().collect() }).unwrap();
    assert_eq!((abi.init(), abi.solve(7)), (0, 0));
    solver.init().unwrap();
    solver.solve(7).unwrap();
    assert_eq!(points(&abi.points()), solver.points());
    assert_eq!(abi.energy(), (SO_SUCCESS, solver.energy()));
    assert_eq!(
        (shapeop_removeForce(abi.0, 0), shapeop_isForce(abi.0, 0), shapeop_forceCount(abi.0)),
        (SO_SUCCESS, 0, 2)
    );
}

#[test]
fn forces_on_faces_that_are_none_are_refused_by_name() {
    let abi = Abi::with_points(&POINTS);
    let says = |indices: &[c_int], counts: &[c_int], magnitude: f64, words: &str| {
        for id in [abi.pressure(indices, counts, magnitude), abi.normal_force(indices, counts, magnitude)] {
            assert_eq!(id, -1, "{words}");
            assert!(abi.message().contains(words), "{} lacks {words}", abi.message());
        }
        assert_eq!(shapeop_forceCount(abi.0), 0);
    };
    says(&[0, 1, 2], &[3], f64::NAN, "magnitude: expected a finite number");
    says(&[0, 1, 4], &[3], 1.0, "faces[0][2]: 4 is out of range for 4 points");
    says(&[0, 1, 2, 0, -1, 2], &[3], 1.0, "faces[1][1]: -1 is out of range for 4 points");
    says(&[0, 1], &[2], 1.0, "faces[0]: expected a face of at least 3 corners, found 2");
    says(&[0, 1, 2], &[4], 1.0, "nb_indices: expected a multiple of 4");
    says(&[0, 1, 2, 3], &[3, 2], 1.0, "nb_indices: expected 5, the sum of counts; found 4");
    says(&[], &[], 1.0, "faces: expected at least one face, found none");
    says(&[0, 1, 2], &[-3], 1.0, "counts[0]: expected a count of at least 0, found -3");
    // SAFETY: null is allowed.
    unsafe {
        assert_eq!(shapeop_addPressure(abi.0, ptr::null(), 3, [3].as_ptr(), 1, 1.0), -1);
        assert!(abi.message().contains("indices: expected a pointer, found null"));
        assert_eq!(shapeop_addNormalForce(abi.0, [0, 1, 2].as_ptr(), 3, ptr::null(), 1, 1.0), -1);
        assert!(abi.message().contains("counts: expected a pointer, found null"));
        assert_eq!(shapeop_addPressure(ptr::null_mut(), [0, 1, 2].as_ptr(), 3, [3].as_ptr(), 1, 1.0), -1);
    }
    let (gravity, pressure) = (abi.gravity([0.0; 3]), abi.pressure(&[0, 1, 2], &[3], 1.0));
    for (id, value, code) in [
        (gravity, 1.0, SO_UNMATCHING_FORCE_ID),
        (-1, 1.0, SO_UNMATCHING_FORCE_ID),
        (7, 1.0, SO_UNMATCHING_FORCE_ID),
        (pressure, f64::INFINITY, SO_INVALID_VALUE),
    ] {
        assert_eq!(shapeop_editForceMagnitude(abi.0, id, value), code);
        assert!(!abi.message().is_empty());
    }
}
