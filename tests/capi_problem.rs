//! The C functions that take problems as JSON, make them from meshes, and measure faces; and edits of many constraints.

mod abi;

use std::ffi::{CString, c_char, c_int};
use std::ptr;

use abi::{Abi, Many, WARPED, last_error, options, text, warped};
use glam::DVec3;
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;
use shapeop::mesh::{Mesh, measure};
use shapeop::problem::recipes::{self, Anchors, RecipeOptions};
use shapeop::problem::{Problem, Settings, Signature};

fn c_text(text: &str) -> CString {
    CString::new(text).unwrap()
}

fn set_problem(abi: &Abi, json: &str) -> shapeop_err {
    // SAFETY: a live text.
    unsafe { shapeop_setProblem(abi.0, c_text(json).as_ptr(), ptr::null_mut()) }
}

/// A copy of what a function handed out; the message if it refused.
fn answer(answer: *const c_char) -> Result<String, String> {
    if answer.is_null() { Err(last_error(ptr::null_mut())) } else { Ok(text(answer)) }
}

fn problem_text(json: &str) -> Result<String, String> {
    // SAFETY: a live text.
    answer(unsafe { shapeop_problemText(c_text(json).as_ptr()) })
}

/// Two warped squares and a triangle beside them.
fn mesh() -> Mesh {
    let points =
        [0.0, 0.0, 0.1, 1.0, 0.0, -0.1, 1.0, 1.0, 0.1, 0.0, 1.0, -0.1, 2.0, 0.0, 0.3, 2.0, 1.0, 0.0, 1.5, 2.0, 0.0];
    Mesh {
        points: points.chunks(3).map(DVec3::from_slice).collect(),
        faces: vec![vec![0, 1, 2, 3], vec![1, 4, 5, 2], vec![2, 5, 6]],
    }
}

struct Flat {
    points: Vec<f64>,
    indices: Vec<c_int>,
    counts: Vec<c_int>,
}

fn flat(mesh: &Mesh) -> Flat {
    Flat {
        points: mesh.points.iter().flat_map(DVec3::to_array).collect(),
        indices: mesh.faces.iter().flatten().map(|&index| index as c_int).collect(),
        counts: mesh.faces.iter().map(|face| face.len() as c_int).collect(),
    }
}

fn recipe_options() -> shapeop_recipe_options {
    // SAFETY: all of its fields are valid as zeros.
    let mut options: shapeop_recipe_options = unsafe { std::mem::zeroed() };
    options.struct_size = size_of::<shapeop_recipe_options>() as u32;
    // SAFETY: it carries its size.
    assert_eq!(unsafe { shapeop_defaultRecipeOptions(&mut options) }, SO_SUCCESS);
    options
}

fn recipe(name: &str, mesh: &Flat, options: Option<&shapeop_recipe_options>) -> Result<String, String> {
    let Flat { points, indices, counts } = mesh;
    // SAFETY: live values of the stated lengths.
    answer(unsafe {
        shapeop_recipe(
            c_text(name).as_ptr(),
            points.as_ptr(),
            points.len() as c_int / 3,
            indices.as_ptr(),
            indices.len() as c_int,
            counts.as_ptr(),
            counts.len() as c_int,
            options.map_or(ptr::null(), ptr::from_ref),
        )
    })
}

fn measured(name: &str, mesh: &Flat, room: &mut [f64]) -> shapeop_err {
    let Flat { points, indices, counts } = mesh;
    // SAFETY: live values of the stated lengths.
    unsafe {
        shapeop_measureFaces(
            c_text(name).as_ptr(),
            points.as_ptr(),
            points.len() as c_int / 3,
            indices.as_ptr(),
            indices.len() as c_int,
            counts.as_ptr(),
            counts.len() as c_int,
            room.as_mut_ptr(),
            room.len() as c_int,
        )
    }
}

#[test]
fn a_problem_replaces_all_that_a_solver_holds() {
    let plane =
        Signature { type_name: "Plane".into(), indices: vec![0, 1, 2, 3], weight: 1.0, scalars: None, hard: false };
    let near =
        |i| Signature { type_name: "Closeness".into(), indices: vec![i], weight: 0.25, scalars: None, hard: false };
    let problem = Problem {
        points: WARPED.chunks(3).map(|point| [point[0], point[1], point[2]]).collect(),
        constraints: [vec![plane], (0..4).map(near).collect()].concat(),
        settings: Settings { max_iterations: 77, tolerance: 1e-3, time_budget_seconds: 9.0, ..Settings::default() },
        ..Problem::default()
    };
    let json = problem.to_json();
    let abi = Abi::with_points(&[9.0; 30]);
    abi.add("Closeness", &[9], 1.0);
    abi.gravity([0.0, 0.0, 1.0]);
    let mut told = options();
    // SAFETY: a live text; the options carry their size.
    assert_eq!(unsafe { shapeop_setProblem(abi.0, c_text(&json).as_ptr(), &mut told) }, SO_SUCCESS);
    assert_eq!((told.max_iterations, told.tolerance, told.time_budget_seconds), (77, 1e-3, 9.0));
    assert_eq!((abi.points(), shapeop_constraintCount(abi.0), shapeop_forceCount(abi.0)), (WARPED.to_vec(), 5, 0));
    // It is initialised, and solves as one that was told the same by calls.
    let twin = warped();
    assert_eq!((abi.solve(5), twin.init(), twin.solve(5)), (0, 0, 0));
    assert_eq!(abi.points(), twin.points());
    assert_eq!(problem_text(&json), Ok(json));
}

#[test]
fn a_refused_problem_names_its_place_and_changes_nothing() {
    let abi = warped();
    assert_eq!((abi.init(), abi.solve(2)), (0, 0));
    let before = (abi.points(), abi.energy());
    let plane = |indices: &str| {
        format!(
            "{{\"version\": 1, \"points\": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], \"constraints\": [{{\"type\": \"Plane\", \
             \"indices\": {indices}}}]}}"
        )
    };
    for (json, words) in [
        (plane("[0, 1, 7]"), "constraints[0].indices[2]: 7 is out of range for 3 points"),
        (plane("[0, 1]"), "constraints[0]"),
        (plane("[0, 1, 2.5]"), "constraints[0].indices[2]"),
        ("{\"version\": 2, \"points\": []}".to_owned(), "version: expected 1, found 2"),
        ("nonsense".to_owned(), "line 1"),
    ] {
        assert!(
            [SO_INVALID_VALUE, SO_INVALID_INPUT, SO_INDEX_OUT_OF_RANGE, SO_INVALID_ARGUMENT_LENGTH]
                .contains(&set_problem(&abi, &json))
        );
        assert!(abi.message().contains(words), "{}", abi.message());
        let refusal = problem_text(&json).unwrap_err();
        assert_eq!(refusal, abi.message());
    }
    // SAFETY: null is allowed.
    assert_eq!(unsafe { shapeop_setProblem(abi.0, ptr::null(), ptr::null_mut()) }, SO_NULL_POINTER);
    assert_eq!((abi.points(), abi.energy()), before);
    assert_eq!(abi.solve(1), 0);
}

#[test]
fn recipes_make_the_problems_of_the_rust_api() {
    let (mesh, flat) = (mesh(), flat(&mesh()));
    let names: Vec<String> = (0..shapeop_recipeCount()).map(|i| text(shapeop_recipeName(i))).collect();
    assert_eq!(names, recipes::RECIPES.map(|(name, _)| name));
    assert!(shapeop_recipeName(-1).is_null() && shapeop_recipeName(names.len() as c_int).is_null());
    for (name, make) in recipes::RECIPES {
        let expected = make(&mesh, None, &RecipeOptions::default()).unwrap().to_json();
        assert_eq!(recipe(name, &flat, None), Ok(expected.clone()));
        assert_eq!(recipe(name, &flat, Some(&recipe_options())), Ok(expected));
    }
    let anchors = [6, 0];
    let chosen = shapeop_recipe_options {
        fairness_kind: 1,
        weight: 2.0,
        closeness: 0.25,
        fairness: 0.5,
        length: 1.25,
        anchors: anchors.as_ptr(),
        nb_anchors: 2,
        anchor_boundary: 0,
        anchor_corners: 1,
        ..recipe_options()
    };
    let same = RecipeOptions {
        weight: 2.0,
        closeness: 0.25,
        fairness: 0.5,
        fairness_kind: recipes::Fairness::Smooth,
        anchors: Anchors { points: vec![6, 0], boundary: false, corners: true },
    };
    let expected = recipes::equalize(&mesh, Some(1.25), &same).unwrap().to_json();
    assert_eq!(recipe("equalize", &flat, Some(&chosen)), Ok(expected));
    let expected = recipes::rationalize(&mesh, Some(1.25), &same).unwrap().to_json();
    assert_eq!(recipe("rationalize", &flat, Some(&chosen)), Ok(expected));
    let of = |change: fn(&mut shapeop_recipe_options)| {
        let mut options = recipe_options();
        change(&mut options);
        recipe("planarize", &flat, Some(&options)).unwrap_err()
    };
    assert!(of(|options| options.weight = -1.0).contains("weight: expected at least 0, found -1"));
    assert!(of(|options| options.closeness = f64::NAN).contains("closeness"));
    assert!(of(|options| options.fairness_kind = 7).contains("options->fairness_kind: expected 0 or 1, found 7"));
    assert!(of(|options| options.length = 2.0).contains("options->length"));
    assert!(of(|options| options.nb_anchors = 1).contains("options->anchors: expected a pointer, found null"));
    assert!(recipe("planarise", &flat, None).unwrap_err().contains("planarize, circularize"));
}

#[test]
fn faces_are_checked_before_anything_is_made_of_them() {
    let refusal = |change: fn(&mut Flat)| {
        let mut flat = flat(&mesh());
        change(&mut flat);
        let mut room = [7.0; 3];
        assert_ne!(measured("planarity", &flat, &mut room), SO_SUCCESS);
        assert_eq!(room, [7.0; 3]);
        let message = last_error(ptr::null_mut());
        assert_eq!(recipe("planarize", &flat, None).unwrap_err(), message);
        message
    };
    assert!(refusal(|flat| flat.indices[5] = 7).contains("faces[1][1]: 7 is out of range for 7 points"));
    assert!(refusal(|flat| flat.indices[5] = -1).contains("faces[1][1]: -1 is out of range for 7 points"));
    assert!(refusal(|flat| flat.counts[1] = 3).contains("nb_face_indices: expected 10, the sum of counts; found 11"));
    assert!(refusal(|flat| flat.counts[1] = -4).contains("counts[1]: expected a count of at least 0, found -4"));
    assert!(refusal(|flat| flat.counts = vec![4]).contains("nb_face_indices: expected a multiple of 4"));
    assert!(refusal(|flat| flat.counts = vec![4, 5, 2]).contains("faces[2]: expected a face of at least 3 corners"));
    assert!(refusal(|flat| flat.points[4] = f64::INFINITY).contains("points[1]: expected finite coordinates"));
}

#[test]
fn measures_are_those_of_the_rust_api() {
    let (mesh, flat) = (mesh(), flat(&mesh()));
    let names: Vec<String> = (0..shapeop_measureCount()).map(|i| text(shapeop_measureName(i))).collect();
    assert_eq!(names, measure::FACE_MEASURES.map(|(name, _)| name));
    for (name, function) in measure::FACE_MEASURES {
        let mut room = [f64::NAN; 3];
        assert_eq!(measured(name, &flat, &mut room), SO_SUCCESS);
        assert_eq!(room.to_vec(), measure::of_faces(&mesh, function).unwrap());
    }
    // The diagonals of the first square are √2 long and 0.2 apart.
    let mut room = [0.0; 3];
    measured("planarity", &flat, &mut room);
    assert!((room[0] - 0.2 / 2.0_f64.sqrt()).abs() < 1e-15 && room[2] == 0.0);
    assert_eq!(measured("flatness", &flat, &mut room), SO_INVALID_VALUE);
    assert!(last_error(ptr::null_mut()).contains("measure: expected one of the measures planarity"));
    assert_eq!(measured("planarity", &flat, &mut room[..2]), SO_INVALID_ARGUMENT_LENGTH);
    let all_quads = Flat { counts: vec![4], indices: flat.indices[..8].to_vec(), points: flat.points };
    assert_eq!(measured("planarity", &all_quads, &mut room[..2]), SO_SUCCESS);
}

fn edit_many(abi: &Abi, type_name: &str, ids: &[c_int], scalars: &[f64], sets: c_int) -> shapeop_err {
    let name = c_text(type_name);
    // SAFETY: live values of the stated lengths.
    unsafe {
        shapeop_editConstraints(
            abi.0,
            name.as_ptr(),
            ids.as_ptr(),
            ids.len() as c_int,
            scalars.as_ptr(),
            scalars.len() as c_int,
            sets,
        )
    }
}

fn set_weights(abi: &Abi, ids: &[c_int], weights: &[f64]) -> shapeop_err {
    // SAFETY: live values of the stated lengths.
    unsafe { shapeop_setWeights(abi.0, ids.as_ptr(), ids.len() as c_int, weights.as_ptr(), weights.len() as c_int) }
}

#[test]
fn edits_of_many_do_what_single_edits_do_or_nothing() {
    let (many, single) = (warped(), warped());
    let targets = [0.0, 0.0, 0.5, 1.0, 0.0, 0.25, 1.0, 1.5, 0.0];
    assert_eq!(edit_many(&many, "Closeness", &[1, 4, 2], &targets, 3), SO_SUCCESS);
    for (id, target) in [1, 4, 2].into_iter().zip(targets.chunks(3)) {
        assert_eq!(single.edit("Closeness", id, target), SO_SUCCESS);
    }
    assert_eq!((many.init(), single.init(), many.solve(3), single.solve(3)), (0, 0, 0, 0));
    assert_eq!(many.points(), single.points());
    assert_eq!(edit_many(&many, "Closeness", &[1, 2, 3, 4], &[0.0; 3], 1), SO_SUCCESS);
    assert_eq!(many.solve(200), 0);
    assert!(many.points().iter().all(|c| c.abs() < 1e-9), "{:?}", many.points());

    let before = many.energy();
    for (ids, scalars, sets, code, words) in [
        (&[1, 9][..], &[1.0; 6][..], 2, SO_UNMATCHING_CONSTRAINT_ID, "constraint_ids[1]"),
        (&[1, 0], &[1.0; 6], 2, SO_UNMATCHING_CONSTRAINT_ID, "constraint_ids[1]"),
        (&[1, -1], &[1.0; 6], 2, SO_UNMATCHING_CONSTRAINT_ID, "constraint_ids[1]"),
        (&[1, 2], &[1.0; 6], 3, SO_INVALID_ARGUMENT_LENGTH, "nb_scalar_sets: expected 0, 1 or 2, found 3"),
        (&[1, 2], &[1.0; 5], 2, SO_INVALID_ARGUMENT_LENGTH, "nb_scalars: expected a multiple of 2"),
        (&[1, 2], &[1.0; 4], 2, SO_INVALID_ARGUMENT_LENGTH, "edits[0]"),
        (&[1, 2], &[1.0, 1.0, 1.0, 1.0, f64::NAN, 1.0], 2, SO_INVALID_VALUE, "edits[1]"),
        (&[1], &[], 0, SO_INVALID_ARGUMENT_LENGTH, "edits[0]"),
    ] {
        assert_eq!(edit_many(&many, "Closeness", ids, scalars, sets), code, "{}", many.message());
        assert!(many.message().contains(words), "{}", many.message());
        assert_eq!(many.energy(), before);
    }
    assert_eq!(edit_many(&many, "Plane", &[0], &[1.0], 1), SO_INVALID_CONSTRAINT_TYPE);
    assert_eq!(edit_many(&many, "Closeness", &[], &[], 0), SO_SUCCESS);
}

#[test]
fn shapes_of_polygons_of_different_size_are_edited_together() {
    let abi = Abi::with_points(&flat(&mesh()).points);
    let (ids, counts, shape) =
        ([0, 1, 2, 3, 2, 5, 6], [4, 3], [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let triangle = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let new = Many { type_name: "Rigid", ids: &ids, counts: &counts, ..Many::default() };
    assert_eq!(abi.add_many(&new).0, SO_SUCCESS);
    assert_eq!(edit_many(&abi, "Rigid", &[0, 1], &[&shape[..], &triangle[..]].concat(), 2), SO_SUCCESS);
    assert_eq!((abi.init(), abi.solve(500)), (0, 0));
    let points = abi.points();
    let distance =
        |a: usize, b: usize| DVec3::from_slice(&points[3 * a..]).distance(DVec3::from_slice(&points[3 * b..]));
    assert!((distance(0, 1) - 1.0).abs() < 1e-9 && (distance(0, 2) - 2.0_f64.sqrt()).abs() < 1e-9);
    let mut sides = [distance(2, 5), distance(5, 6), distance(6, 2)];
    sides.sort_by(f64::total_cmp);
    assert!((sides[0] - 1.0).abs() < 1e-9 && (sides[2] - 2.0_f64.sqrt()).abs() < 1e-9, "{sides:?}");
}

#[test]
fn weights_of_many_are_set_or_none() {
    let (many, single) = (warped(), warped());
    assert_eq!(set_weights(&many, &[1, 3], &[2.0, 0.5]), SO_SUCCESS);
    assert_eq!(set_weights(&many, &[2, 4], &[0.75]), SO_SUCCESS);
    for (id, weight) in [(1, 2.0), (3, 0.5), (2, 0.75), (4, 0.75)] {
        assert_eq!(shapeop_setWeight(single.0, id, weight), SO_SUCCESS);
    }
    assert_eq!((many.init(), single.init(), many.solve(3), single.solve(3)), (0, 0, 0, 0));
    assert_eq!(many.points(), single.points());
    let before = many.energy();
    for (ids, weights, code, words) in [
        (&[1, 2][..], &[1.0, -1.0][..], SO_INVALID_VALUE, "weights[1]"),
        (&[1, 99], &[1.0, 1.0], SO_UNMATCHING_CONSTRAINT_ID, "weights[1]"),
        (&[1, -2], &[1.0, 1.0], SO_UNMATCHING_CONSTRAINT_ID, "constraint_ids[1]"),
        (&[1, 2], &[1.0, 1.0, 1.0], SO_INVALID_ARGUMENT_LENGTH, "nb_weights: expected 1 or 2, found 3"),
    ] {
        assert_eq!(set_weights(&many, ids, weights), code);
        assert!(many.message().contains(words), "{}", many.message());
        assert_eq!(many.energy(), before);
    }
}
