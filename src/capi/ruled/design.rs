//! Designs: creating, deleting, the asymptotic directions of their meshes.

use std::ffi::{c_int, c_uint};

use glam::DVec3;

use super::super::handles::{self, Handle};
use super::super::problem::mesh;
use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, guard_named, shapeop_err};
use super::io::{self, Outputs, placed};
use super::{created, guard};
use crate::error::{Error, Result, Status};
use crate::geometry::ruled::asymptotic::{self, PointStatus};
use crate::geometry::ruled::design::{Draft, FieldOptions};
use crate::geometry::ruled::orientation;
use crate::geometry::ruled::tracing::{self, End, Sense, Tracer};
use crate::mesh::curvature;
use crate::mesh::reference::ReferenceMesh;

/// A design of ruled strips: a negatively curved mesh, its asymptotic directions, strip boundaries across them, strips
/// between these, conditions on strips. Each step needs those before it and takes back those after it. What points to
/// it is no address but a small integer, a handle. All functions named `shapeop_ruled...` leave their messages for
/// `shapeop_lastError` of null.
#[derive(Debug)]
pub struct ShapeOpRuled {
    _private: [u8; 0],
}

/// How the asymptotic directions of a mesh are found. Start from `shapeop_ruledDefaultOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_options {
    /// In: `sizeof(shapeop_ruled_options)`.
    pub struct_size: c_uint,
    /// Which of the two families rulings follow: 0, that of negative torsion, or 1. Default 0.
    pub family: c_int,
    /// 1: signs of directions may disagree across some edges if they must. Default 0.
    pub allow_cut: c_int,
    /// Rings of neighbours are added to a point until there are so many, 5 to 96. Default 18.
    pub least_neighbours: c_uint,
    /// Points whose Gaussian curvature is not below minus this times the square of the greatest curvature are masked, 0
    /// to 1. Default 1e-6.
    pub flatness: f64,
    /// The part of the points that may be masked, 0 to 1; never all. Default 0.05.
    pub max_mask: f64,
    /// Directions point along this vector on the whole, x; all three 0: along x. Default 0.
    pub hint_x: f64,
    /// See `hint_x`.
    pub hint_y: f64,
    /// See `hint_x`.
    pub hint_z: f64,
}

/// What was found at a point of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_ruled_point {
    /// Two asymptotic directions.
    SO_RULED_POINT_GOOD = 0,
    /// The surface is flat or positively curved there: it has none.
    SO_RULED_POINT_NOT_NEGATIVE = 1,
    /// Its neighbours do not determine curvatures.
    SO_RULED_POINT_NOT_FITTED = 2,
}

/// Why an asymptotic curve ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_ruled_end {
    /// At the boundary of the mesh.
    SO_RULED_END_BOUNDARY = 0,
    /// Where the direction is not known.
    SO_RULED_END_UNKNOWN = 1,
    /// At the length asked for.
    SO_RULED_END_LENGTH = 2,
    /// After the most steps.
    SO_RULED_END_STEPS = 3,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_options>()];
}

fn default_options() -> shapeop_ruled_options {
    let FieldOptions { directions, family, orientation } = FieldOptions::default();
    shapeop_ruled_options {
        struct_size: 0,
        family: family as c_int,
        allow_cut: c_int::from(orientation.allow_cut),
        least_neighbours: io::field(directions.curvature.least_neighbours),
        flatness: directions.flatness,
        max_mask: directions.max_mask,
        hint_x: 0.0,
        hint_y: 0.0,
        hint_z: 0.0,
    }
}

fn options(told: &shapeop_ruled_options) -> Result<FieldOptions> {
    let hint = DVec3::new(told.hint_x, told.hint_y, told.hint_z);
    Ok(FieldOptions {
        directions: asymptotic::Options {
            curvature: curvature::Options { least_neighbours: told.least_neighbours as usize },
            flatness: told.flatness,
            max_mask: told.max_mask,
        },
        family: io::count("options->family", told.family, 0, 1)?,
        orientation: orientation::Options {
            hint: (hint != DVec3::ZERO).then_some(hint),
            allow_cut: io::truth("options->allow_cut", told.allow_cut)?,
        },
    })
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledDefaultOptions(options: *mut shapeop_ruled_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// Creates the design of a mesh, and finds its asymptotic directions. Null if it is refused, as a mesh is that is not
/// negatively curved (`SO_CURVATURE_SIGN`) or no oriented surface. Delete it with `shapeop_ruledDelete`.
///
/// - `points`: `x0 y0 z0 x1 ...` in model units, `nb_points` points, all of which faces use.
/// - `face_indices`: the point indices of all faces behind each other, `nb_face_indices` in all; quads are split along
///   their shorter diagonal, larger faces into a fan.
/// - `counts`: the number of corners of each face. `nb_counts` 1: the same for all; otherwise one per face.
/// - `options`: null for the defaults.
///
/// # Safety
/// Each array is null or readable for its number of values; `options` is null, or its `struct_size` is set and it is
/// readable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledCreate(
    points: *const f64,
    nb_points: c_int,
    face_indices: *const c_int,
    nb_face_indices: c_int,
    counts: *const c_int,
    nb_counts: c_int,
    options: *const shapeop_ruled_options,
) -> *mut ShapeOpRuled {
    created(|| {
        // SAFETY: the caller vouches for the arrays and the struct; numbers are valid for any bytes.
        let (mesh, told) = unsafe {
            let mesh = mesh(points, nb_points, face_indices, nb_face_indices, counts, nb_counts)?;
            (mesh, io::told("options", options, default_options())?)
        };
        Draft::new(&mesh, &self::options(&told)?).map_err(|error| {
            let names = [
                ("flatness", "options->flatness"),
                ("max_mask", "options->max_mask"),
                ("curvature.", "options->"),
                ("hint", "options->hint_x"),
                ("mesh", "points"),
            ];
            placed(error, &names)
        })
    })
}

/// Creates a copy of a design, with all that was made of it; null if it is refused.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledCopy(design: *mut ShapeOpRuled) -> *mut ShapeOpRuled {
    match guard(design, |draft| Ok(draft.clone())) {
        Ok(copy) => created(|| Ok(copy)),
        Err(_) => std::ptr::null_mut(),
    }
}

/// Deletes a design. Null does nothing; a busy design is left alone, as is whatever is no design.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledDelete(design: *mut ShapeOpRuled) {
    if !design.is_null() {
        let handle = Handle::new(design.cast());
        let _ = guard_named(handle, || handles::delete::<Draft>(handle));
    }
}

/// Takes the directions of a family, 0 or 1, that point along `hint` on the whole (null: along x). With `allow_cut` 1
/// their signs may disagree across some edges if they must (`shapeop_ruledFlips`); otherwise a mesh around which no
/// signs agree is refused (`SO_NOT_ORIENTABLE`). Takes back boundaries and strips.
///
/// # Safety
/// `hint` is null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledSelectFamily(
    design: *mut ShapeOpRuled,
    family: c_int,
    hint: *const f64,
    allow_cut: c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for 3 doubles.
        let hint = unsafe { io::optional_vector("hint", hint)? };
        let options = orientation::Options { hint, allow_cut: io::truth("allow_cut", allow_cut)? };
        let family = io::count("family", family, 0, 1)?;
        draft.step(|design| design.orient(family, &options)).map_err(|error| placed(error, &[("mesh", "allow_cut")]))
    }))
}

/// Writes the triangles of a design's mesh, three points each, if there is room for `capacity` of them, and their
/// number to `count`.
///
/// # Safety
/// `triangles` is null or writable for `3 * capacity` ints, `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledTriangles(
    design: *mut ShapeOpRuled,
    triangles: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = io::ints(draft.design().mesh().triangles().iter().flatten().map(|&i| i as usize))?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("triangles", triangles, capacity, count, all, 3)? };
        outputs.write()
    }))
}

/// Writes the curvature at each point of a design's mesh if there is room for `capacity` points, and their number to
/// `count`: `principal`, two curvatures in 1/model units, the greater first, positive where the surface bends towards
/// the normal; `directions`, their unit directions; `normals`, of higher order than those of triangles. Each output but
/// `count` may be null.
///
/// # Safety
/// `principal` is null or writable for `2 * capacity` doubles, `directions` for `6 * capacity`, `normals` for
/// `3 * capacity`, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledCurvatures(
    design: *mut ShapeOpRuled,
    principal: *mut f64,
    directions: *mut f64,
    normals: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let found = draft.design().directions().curvatures();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            if outputs.room(capacity, count, found.len())? {
                outputs.may("principal", principal, found.iter().flat_map(|at| at.principal).collect())?;
                let axes: Vec<DVec3> = found.iter().flat_map(|at| at.directions).collect();
                outputs.may("directions", directions, io::coordinates(&axes))?;
                let up: Vec<DVec3> = found.iter().map(|at| at.normal).collect();
                outputs.may("normals", normals, io::coordinates(&up))?;
            }
        }
        outputs.write()
    }))
}

/// Writes the asymptotic directions of a family, 0 or 1, at the points of a design's mesh if there is room for
/// `capacity` points, and their number to `count`: `directions`, unit vectors with any sign, 0 where there are none;
/// `status`, a `shapeop_ruled_point` each. Each output but `count` may be null.
///
/// # Safety
/// `directions` is null or writable for `3 * capacity` doubles, `status` for `capacity` ints, `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledDirections(
    design: *mut ShapeOpRuled,
    family: c_int,
    directions: *mut f64,
    status: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let found = draft.design().directions();
        let vectors = found.family(io::count("family", family, 0, 1)?)?;
        let number = |status: &PointStatus| match status {
            PointStatus::Good => shapeop_ruled_point::SO_RULED_POINT_GOOD as c_int,
            PointStatus::NotNegative => shapeop_ruled_point::SO_RULED_POINT_NOT_NEGATIVE as c_int,
            PointStatus::NotFitted => shapeop_ruled_point::SO_RULED_POINT_NOT_FITTED as c_int,
        };
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            if outputs.room(capacity, count, vectors.len())? {
                outputs.may("directions", directions, io::coordinates(vectors))?;
                outputs.may("status", status, found.status().iter().map(number).collect())?;
            }
        }
        outputs.write()
    }))
}

/// Writes the field that rulings follow, the directions of the family selected with signs that agree, as
/// `shapeop_ruledDirections` does; `is_known` is 0 where there is no direction.
///
/// # Safety
/// `directions` is null or writable for `3 * capacity` doubles, `is_known` for `capacity` ints, `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledField(
    design: *mut ShapeOpRuled,
    directions: *mut f64,
    is_known: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let field = draft.design().field();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            if outputs.room(capacity, count, field.directions().len())? {
                outputs.may("directions", directions, io::coordinates(field.directions()))?;
                outputs.may(
                    "is_known",
                    is_known,
                    field.is_known().iter().map(|&known| c_int::from(known)).collect(),
                )?;
            }
        }
        outputs.write()
    }))
}

/// Writes the edges, two points each, across which the field changes its sign, if there is room for `capacity` of them,
/// and their number to `count`.
///
/// # Safety
/// `edges` is null or writable for `2 * capacity` ints, `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledFlips(
    design: *mut ShapeOpRuled,
    edges: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = io::ints(draft.design().flips().iter().flatten().map(|&i| i as usize))?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("edges", edges, capacity, count, all, 2)? };
        outputs.write()
    }))
}

/// Follows the asymptotic curve of the field from the point of the mesh nearest to `seed`, along the field or, with
/// `is_backward` 1, against it, for `length` model units at most. A step is `step` edges long, above 0 and at most 0.5.
/// Writes its points, the start first, if there is room for `capacity` of them, their number to `count`, and to `end`,
/// which may be null, why it ends there (a `shapeop_ruled_end`).
///
/// # Safety
/// `seed` is null or readable for 3 doubles; `points` is null or writable for `3 * capacity` doubles, `count` and `end`
/// for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledTrace(
    design: *mut ShapeOpRuled,
    seed: *const f64,
    is_backward: c_int,
    step: f64,
    length: f64,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    end: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for 3 doubles.
        let seed = unsafe { io::vector("seed", seed)? };
        let sense = if io::truth("is_backward", is_backward)? { Sense::Backward } else { Sense::Forward };
        let (mesh, field) = (draft.design().mesh(), draft.design().field());
        let tracer = Tracer::new(mesh, field, &tracing::Options { step, ..tracing::Options::default() })?;
        let trace = tracer.trace(ReferenceMesh::new(mesh).locate(seed), sense, length)?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.sized("points", points, capacity, count, io::coordinates(&trace.positions), 3)?;
            outputs.may("end", end, vec![end_number(trace.end)?])?;
        }
        outputs.write()
    }))
}

fn end_number(end: End) -> Result<c_int> {
    Ok(match end {
        End::Boundary => shapeop_ruled_end::SO_RULED_END_BOUNDARY,
        End::Unknown => shapeop_ruled_end::SO_RULED_END_UNKNOWN,
        End::Length => shapeop_ruled_end::SO_RULED_END_LENGTH,
        End::Steps => shapeop_ruled_end::SO_RULED_END_STEPS,
        End::Caller => return Err(Error::new(Status::Internal, "nobody asked for the end of a trace")),
    } as c_int)
}
