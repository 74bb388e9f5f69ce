//! Problems as JSON, and what makes them or judges them from a mesh: recipes and measures by name.

use std::ffi::{CString, c_char, c_int, c_uint};
use std::mem::offset_of;
use std::ptr;
use std::sync::OnceLock;

use glam::DVec3;

use super::arguments::{check_pointer, faces, length, slice, text, write, xyz_length};
use super::handles::ShapeOpSolver;
use super::points::check_count;
use super::registry::position;
use super::report::shapeop_solve_options;
use super::structs::{self, SizedStruct};
use super::{c_count, code, guard, guard_free, messages, number, shapeop_err};
use crate::error::{Error, Result, Status};
use crate::mesh::Mesh;
use crate::mesh::measure::{FACE_MEASURES, of_faces};
use crate::problem::Problem;
use crate::problem::recipes::{Anchors, Fairness, RECIPES, RecipeOptions, TAKE_LENGTH};
use crate::solver::SolveOptions;

/// Makes `op` the solver of a problem, whose JSON form `docs/problem.schema.json` states: everything in it is replaced,
/// and it is initialised in the problem's mode. Thread count and linear solver stay. `options` may be null; else its
/// `struct_size` is set, and it receives the problem's stopping rules for `shapeop_solveUntil`.
///
/// A refusal names the place in the text, such as `constraints[17].indices[2]`, and leaves the solver as it was.
///
/// # Safety
/// `json` is null or ends with a zero. `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_setProblem(
    op: *mut ShapeOpSolver,
    json: *const c_char,
    options: *mut shapeop_solve_options,
) -> shapeop_err {
    code(guard(op, |solver| {
        // SAFETY: the caller vouches for the text and for `struct_size`.
        let (json, size) =
            unsafe { (text("json", json)?, if options.is_null() { 0 } else { structs::size("options", options)? }) };
        let problem = Problem::from_json(&json)?;
        solver.set_problem(&problem)?;
        if !options.is_null() {
            let SolveOptions { max_iterations, tolerance, time_budget_seconds } = SolveOptions::from(&problem.settings);
            let told = shapeop_solve_options { struct_size: 0, max_iterations, tolerance, time_budget_seconds };
            // SAFETY: the caller vouches for so many bytes.
            unsafe { structs::write(options, size, &told) };
        }
        Ok(())
    }))
}

/// The JSON form of a problem, checked, with every default written out and a line per point, constraint, force and face;
/// null if the text is refused. It is the calling thread's own, valid until that thread's next call of this function or
/// of `shapeop_recipe`.
///
/// # Safety
/// `json` is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_problemText(json: *const c_char) -> *const c_char {
    let result = guard_free(|| {
        // SAFETY: the caller vouches for the text.
        let json = unsafe { text("json", json)? };
        Ok(messages::show_problem(Problem::from_json(&json)?.to_json()))
    });
    result.unwrap_or(ptr::null())
}

/// What recipes take. Start from `shapeop_defaultRecipeOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_recipe_options {
    /// In: `sizeof(shapeop_recipe_options)`.
    pub struct_size: c_uint,
    /// 0, the default: fairness keeps the details of the design; 1: it smooths.
    pub fairness_kind: c_int,
    /// The weight of the recipe's own constraints. Default 1.
    pub weight: f64,
    /// The weight that draws each point to where it was; 0 for none. Default 0.05.
    pub closeness: f64,
    /// The weight of fairness; 0, the default, for none ("rationalize": for ten times the closeness).
    pub fairness: f64,
    /// In model units: the length that "equalize" draws edges to; 0, the default: their mean. The distance that "rationalize"
    /// allows the diagonals of a quad; 0: planar quads. Other recipes refuse it.
    pub length: f64,
    /// The points that keep their place, `nb_anchors` indices. Default null.
    pub anchors: *const c_int,
    /// The number of anchors.
    pub nb_anchors: c_int,
    /// 1: all points of the boundary keep their place too. Default 0.
    pub anchor_boundary: c_int,
    /// 1: the corners of the boundary keep their place too, where it turns by more than 75 degrees. Default 0.
    pub anchor_corners: c_int,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_recipe_options {
    const SIZES: &'static [usize] = &[offset_of!(Self, anchors), size_of::<shapeop_recipe_options>()];
}

fn default_options() -> shapeop_recipe_options {
    let RecipeOptions { weight, closeness, fairness, .. } = RecipeOptions::default();
    shapeop_recipe_options {
        struct_size: 0,
        fairness_kind: 0,
        weight,
        closeness,
        fairness,
        length: 0.0,
        anchors: ptr::null(),
        nb_anchors: 0,
        anchor_boundary: 0,
        anchor_corners: 0,
    }
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_defaultRecipeOptions(options: *mut shapeop_recipe_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// The problem that a recipe makes of a mesh, as JSON for `shapeop_setProblem`: "planarize", "circularize", "smooth",
/// "regularize", "equalize" or "rationalize" (`shapeop_recipeName`); null if it is refused. Its points are those of the mesh
/// in their order. The text is the calling thread's own, valid until that thread's next call of this function or of
/// `shapeop_problemText`.
///
/// - `points`: `x0 y0 z0 x1 ...` in model units, `nb_points` points.
/// - `face_indices`: the point indices of all faces behind each other, `nb_face_indices` in all.
/// - `counts`: the number of corners of each face. `nb_counts` 1: the same for all; otherwise one per face.
/// - `options`: null for the defaults.
///
/// # Safety
/// `name` is null or ends with a zero; each array is null or readable for its number of values. `options` is null, or its
/// `struct_size` is set and it is readable for so many bytes, and its `anchors` for `nb_anchors` ints.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_recipe(
    name: *const c_char,
    points: *const f64,
    nb_points: c_int,
    face_indices: *const c_int,
    nb_face_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
    options: *const shapeop_recipe_options,
) -> *const c_char {
    let result = guard_free(|| {
        // SAFETY: the caller vouches for the text, the arrays and the struct; numbers are valid for any bytes.
        let (name, mesh, options) = unsafe {
            let name = text("name", name)?;
            let mesh = mesh(points, nb_points, face_indices, nb_face_indices, counts, nb_counts)?;
            let options = match options.is_null() {
                true => default_options(),
                false => structs::read("options", options, default_options())?,
            };
            (name, mesh, options)
        };
        let recipe = named("name", &RECIPES, &name, "recipes")?;
        // SAFETY: the caller vouches for the anchors.
        let recipe_options = unsafe { recipe_options(&options)? };
        if options.length != 0.0 && !TAKE_LENGTH.contains(&&*name) {
            let takers = TAKE_LENGTH.map(|name| format!("\"{name}\"")).join(" and ");
            let reason = format!("expected 0, as only {takers} take a length; found {}", options.length);
            return Err(Error::new(Status::InvalidValue, reason).at("options->length"));
        }
        let length = (options.length != 0.0).then_some(options.length);
        Ok(messages::show_problem(recipe(&mesh, length, &recipe_options)?.to_json()))
    });
    result.unwrap_or(ptr::null())
}

/// The number of recipes, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_recipeCount() -> c_int {
    number(guard_free(|| c_count(RECIPES.len())))
}

/// The name of the recipe `index`; null if there is none. Valid as long as the library is loaded.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_recipeName(index: c_int) -> *const c_char {
    static TEXTS: OnceLock<Vec<CString>> = OnceLock::new();
    name_of(&TEXTS, &RECIPES, index, "recipes")
}

/// Measures every face: "planarity" (the distance of the diagonals of a quad over their mean length, of other polygons the
/// greatest distance from the best-fit plane over the mean edge; 0.01 is one percent), "plane_distance" (model units),
/// "circularity" and "regularity" (over the mean edge), "mean_edge" (model units). `shapeop_measureName` lists the names.
/// Faces are as in `shapeop_recipe`; `out` has one number per face, and `nb` is the number of faces.
///
/// # Safety
/// `measure` is null or ends with a zero; each array is null or readable, `out` writable, for its number of values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_measureFaces(
    measure: *const c_char,
    points: *const f64,
    nb_points: c_int,
    face_indices: *const c_int,
    nb_face_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
    out: *mut f64,
    nb: c_int,
) -> shapeop_err {
    code(guard_free(|| {
        // SAFETY: the caller vouches for the text and the arrays.
        let (name, mesh) = unsafe {
            let mesh = mesh(points, nb_points, face_indices, nb_face_indices, counts, nb_counts)?;
            (text("measure", measure)?, mesh)
        };
        let measure = named("measure", &FACE_MEASURES, &name, "measures")?;
        check_count("nb", nb, mesh.faces.len(), "faces")?;
        check_pointer("out", out, mesh.faces.len())?;
        let values = of_faces(&mesh, measure)?;
        if let Some(face) = values.iter().position(|value| !value.is_finite()) {
            let reason = format!("coordinates are so large that the {name} is not finite");
            return Err(Error::new(Status::InvalidValue, reason).at(format!("faces[{face}]")));
        }
        // SAFETY: the pointer was checked, and the caller vouches for one double per face.
        unsafe { write(out, &values) };
        Ok(())
    }))
}

/// The number of measures of faces, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_measureCount() -> c_int {
    number(guard_free(|| c_count(FACE_MEASURES.len())))
}

/// The name of the measure `index`; null if there is none. Valid as long as the library is loaded.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_measureName(index: c_int) -> *const c_char {
    static TEXTS: OnceLock<Vec<CString>> = OnceLock::new();
    name_of(&TEXTS, &FACE_MEASURES, index, "measures")
}

/// The name of an entry of a list as C text, which `texts` keeps.
fn name_of<T>(texts: &'static OnceLock<Vec<CString>>, list: &[(&str, T)], index: c_int, things: &str) -> *const c_char {
    let name = guard_free(|| {
        let at = position("index", index, list.len(), things)?;
        let all = || list.iter().map(|(name, _)| CString::new(*name).unwrap_or_default()).collect();
        Ok(texts.get_or_init(all)[at].as_ptr())
    });
    name.unwrap_or(ptr::null())
}

/// The entry of a list that has the name.
fn named<T: Copy>(argument: &str, list: &[(&str, T)], name: &str, things: &str) -> Result<T> {
    list.iter().find(|(own, _)| *own == name).map(|(_, value)| *value).ok_or_else(|| {
        let names: Vec<&str> = list.iter().map(|(own, _)| *own).collect();
        let reason = format!("expected one of the {things} {}; found \"{name}\"", names.join(", "));
        Error::new(Status::InvalidValue, reason).at(argument)
    })
}

/// A mesh as a C caller states it.
///
/// # Safety
/// Each array is null or readable for its number of values.
pub(super) unsafe fn mesh(
    points: *const f64,
    nb_points: c_int,
    face_indices: *const c_int,
    nb_face_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
) -> Result<Mesh> {
    // SAFETY: the caller vouches for the arrays.
    let (coordinates, indices, counts) = unsafe {
        (
            slice("points", points, xyz_length("nb_points", nb_points)?)?,
            slice("face_indices", face_indices, length("nb_face_indices", nb_face_indices)?)?,
            slice("counts", counts, length("nb_counts", nb_counts)?)?,
        )
    };
    let faces = faces("nb_face_indices", indices, counts, coordinates.len() / 3)?;
    Ok(Mesh { points: coordinates.chunks_exact(3).map(DVec3::from_slice).collect(), faces })
}

/// # Safety
/// `options.anchors` is null or readable for `nb_anchors` ints.
unsafe fn recipe_options(options: &shapeop_recipe_options) -> Result<RecipeOptions> {
    let truth = |name: &str, value: c_int| match value {
        0 | 1 => Ok(value == 1),
        _ => Err(Error::new(Status::InvalidValue, format!("expected 0 or 1, found {value}")).at(name)),
    };
    let smooths = truth("options->fairness_kind", options.fairness_kind)?;
    let anchor_count = length("options->nb_anchors", options.nb_anchors)?;
    // SAFETY: the caller vouches for the anchors.
    let anchors = unsafe { slice("options->anchors", options.anchors, anchor_count)? };
    let point = |(i, &index): (usize, &c_int)| {
        let reason = || format!("expected an index of at least 0, found {index}");
        let error = || Error::new(Status::IndexOutOfRange, reason()).at(format!("options->anchors[{i}]"));
        u32::try_from(index).map_err(|_| error())
    };
    Ok(RecipeOptions {
        weight: options.weight,
        closeness: options.closeness,
        fairness: options.fairness,
        fairness_kind: if smooths { Fairness::Smooth } else { Fairness::KeepDetail },
        anchors: Anchors {
            points: anchors.iter().enumerate().map(point).collect::<Result<_>>()?,
            boundary: truth("options->anchor_boundary", options.anchor_boundary)?,
            corners: truth("options->anchor_corners", options.anchor_corners)?,
        },
    })
}
