//! Strips for other programs: meshes, rulings, texts, zebra stripes.

use std::ffi::{c_char, c_int};
use std::ops::Range;

use glam::DVec3;

use super::super::arguments::length;
use super::super::{code, guard_free, shapeop_err};
use super::design::ShapeOpRuled;
use super::io::{self, Outputs, placed};
use super::{guard, shown};
use crate::error::{Error, Result, Status};
use crate::geometry::ruled::design::Draft;
use crate::geometry::ruled::export;
use crate::geometry::ruled::trim::{TrimOptions, TrimmedRuling};
use crate::geometry::ruled::zebra::{Eye, Stripes, zebra};
use crate::mesh::Mesh;

/// For `strip`: all strips.
pub const SHAPEOP_RULED_ALL: c_int = -1;

/// Columns in each span, or rows, at most.
const MOST_COLUMNS: usize = 1000;

/// Rulings of a strip at most.
const MOST_RULINGS: usize = 100_000;

/// The strips that `strip` names.
fn range(draft: &Draft, strip: c_int) -> Result<Range<usize>> {
    let strips = draft.design().strips();
    if strips.is_empty() {
        return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("strips"));
    }
    if strip == SHAPEOP_RULED_ALL {
        return Ok(0..strips.len());
    }
    let index = io::index("strip", strip, strips.len())?;
    Ok(index..index + 1)
}

/// Where a mesh goes.
struct Told {
    points: *mut f64,
    normals: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    faces: *mut c_int,
    strip_of: *mut c_int,
    face_capacity: c_int,
    face_count: *mut c_int,
}

/// # Safety
/// Each is null or writable for its number of values.
unsafe fn tell(mesh: &Mesh, up: &[DVec3], strip_of: &[u32], first: usize, corners: usize, told: &Told) -> Result<()> {
    let capacity = length("face_capacity", told.face_capacity)?;
    let has_room = mesh.faces.len() <= capacity;
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for the outputs.
    unsafe {
        outputs.sized("points", told.points, told.capacity, told.count, io::coordinates(&mesh.points), 3)?;
        if mesh.points.len() <= length("capacity", told.capacity)? {
            outputs.may("normals", told.normals, io::coordinates(up))?;
        }
        let faces = io::ints(mesh.faces.iter().flatten().map(|&i| i as usize))?;
        let names = ["faces", "face_capacity", "face_count"];
        outputs.sized_as(names, told.faces, told.face_capacity, told.face_count, faces, corners)?;
        if has_room {
            outputs.may("strip_of", told.strip_of, io::ints(strip_of.iter().map(|&strip| strip as usize + first))?)?;
        }
    }
    outputs.write()
}

/// Writes strips as a mesh of quads whose edges across are rulings: the strip `strip`, or all (`SHAPEOP_RULED_ALL`),
/// with `columns_per_span` columns in each span and `rows` rows of points, 2 or more. Points are written if there is
/// room for `capacity` of them, and their number to `count`; faces, four points each, if there is room for
/// `face_capacity` of them, and their number to `face_count`. `normals`, the unit normals at the points, and
/// `strip_of`, the strip of each face, may be null. Strips share no points.
///
/// # Safety
/// `points` and `normals` are null or writable for `3 * capacity` doubles, `faces` for `4 * face_capacity` ints,
/// `strip_of` for `face_capacity`, `count` and `face_count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledMesh(
    design: *mut ShapeOpRuled,
    strip: c_int,
    columns_per_span: c_int,
    rows: c_int,
    points: *mut f64,
    normals: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    faces: *mut c_int,
    strip_of: *mut c_int,
    face_capacity: c_int,
    face_count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let range = range(draft, strip)?;
        let columns = io::count("columns_per_span", columns_per_span, 1, MOST_COLUMNS)?;
        let rows = io::count("rows", rows, 2, MOST_COLUMNS)?;
        let strips = &draft.design().strips()[range.clone()];
        let (mesh, of) = export::mesh(strips, columns, rows)?;
        let up = export::mesh_normals(strips, columns, rows)?;
        let told = Told { points, normals, capacity, count, faces, strip_of, face_capacity, face_count };
        // SAFETY: the caller vouches for the outputs.
        unsafe { tell(&mesh, &up, &of, range.start, 4, &told) }
    }))
}

/// As `shapeop_ruledMesh`, for what is left of strips within the boundary of the design's mesh, as triangles:
/// `columns_per_span` columns in each span, whose edges across are rulings; `faces` has three points each. The line
/// along which strips are cut is at most `tolerance` times the mesh's diagonal, above 0 and at most 0.01, from its
/// boundary. What was trimmed is kept until strips change, so that asking for the numbers first costs little.
///
/// # Safety
/// `points` and `normals` are null or writable for `3 * capacity` doubles, `faces` for `3 * face_capacity` ints,
/// `strip_of` for `face_capacity`, `count` and `face_count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledTrimmedMesh(
    design: *mut ShapeOpRuled,
    strip: c_int,
    columns_per_span: c_int,
    tolerance: f64,
    points: *mut f64,
    normals: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    faces: *mut c_int,
    strip_of: *mut c_int,
    face_capacity: c_int,
    face_count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let range = range(draft, strip)?;
        let columns_per_span = io::count("columns_per_span", columns_per_span, 1, MOST_COLUMNS)?;
        let options = TrimOptions { tolerance, columns_per_span };
        let found = draft.trimmed(&options).map_err(|error| placed(error, &[("options.", "")]))?;
        let (strips, trimmed) = (&found.0[range.clone()], &found.1[range.clone()]);
        let (mesh, of) = export::trimmed_mesh(strips, trimmed)?;
        let up: Vec<DVec3> = strips.iter().zip(trimmed).flat_map(|(strip, trimmed)| trimmed.normals(strip)).collect();
        let told = Told { points, normals, capacity, count, faces, strip_of, face_capacity, face_count };
        // SAFETY: the caller vouches for the outputs.
        unsafe { tell(&mesh, &up, &of, range.start, 3, &told) }
    }))
}

/// `rulings` of each strip of a range, whole ones or what is left of them.
fn rulings(draft: &mut Draft, strip: c_int, rulings: c_int, is_trimmed: bool) -> Result<Vec<Vec<TrimmedRuling>>> {
    let range = range(draft, strip)?;
    let count = io::count("rulings", rulings, 2, MOST_RULINGS)?;
    if is_trimmed {
        let (strips, trimmed) = draft.trimmed(&TrimOptions::default())?;
        return Ok(range.map(|i| trimmed[i].rulings(&strips[i], count)).collect());
    }
    let whole = |strip: &crate::geometry::ruled::Strip| {
        let ruling = |u| TrimmedRuling { u, pieces: vec![strip.ruling(u)] };
        strip.ruling_parameters(count).into_iter().map(ruling).collect()
    };
    Ok(draft.design().strips()[range].iter().map(whole).collect())
}

/// Writes rulings of a strip or of all (`SHAPEOP_RULED_ALL`), `rulings` of each, evenly spread over its parameter; with
/// `is_trimmed` 1 what is left of them within the boundary of the design's mesh: several pieces of one ruling, or none.
/// For each piece `ends` has its two points, from the first boundary to the second, `parameters` its parameter `u` and
/// `strip_of` its strip, if there is room for `capacity` pieces; `count` is their number. Each output but `count` may
/// be null.
///
/// # Safety
/// `ends` is null or writable for `6 * capacity` doubles, `parameters` for `capacity`, `strip_of` for `capacity` ints,
/// `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledRulings(
    design: *mut ShapeOpRuled,
    strip: c_int,
    rulings: c_int,
    is_trimmed: c_int,
    ends: *mut f64,
    parameters: *mut f64,
    strip_of: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let first = range(draft, strip)?.start;
        let found = self::rulings(draft, strip, rulings, io::truth("is_trimmed", is_trimmed)?)?;
        let (mut points, mut us, mut of) = (Vec::new(), Vec::new(), Vec::new());
        for (i, rulings) in found.iter().enumerate() {
            for ruling in rulings {
                points.extend(ruling.pieces.iter().flatten());
                us.extend(ruling.pieces.iter().map(|_| ruling.u));
                of.extend(ruling.pieces.iter().map(|_| first + i));
            }
        }
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            if outputs.room(capacity, count, us.len())? {
                outputs.may("ends", ends, io::coordinates(&points))?;
                outputs.may("parameters", parameters, us)?;
                outputs.may("strip_of", strip_of, io::ints(of)?)?;
            }
        }
        outputs.write()
    }))
}

/// The strips as B-spline surfaces of a Wavefront OBJ file, which CAD programs read; null if it is refused. The text is
/// valid as long as that of `shapeop_ruledStripsText`.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledSurfacesObj(design: *mut ShapeOpRuled) -> *const c_char {
    shown(design, |draft| Ok(export::surfaces_obj(&draft.design().strips()[range(draft, SHAPEOP_RULED_ALL)?])))
}

/// Trimmed rulings, `rulings` of each strip, as lines of a Wavefront OBJ file; null if it is refused. The text is valid
/// as long as that of `shapeop_ruledStripsText`.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledRulingsObj(design: *mut ShapeOpRuled, rulings: c_int) -> *const c_char {
    shown(design, |draft| Ok(export::rulings_obj(&self::rulings(draft, SHAPEOP_RULED_ALL, rulings, true)?)))
}

/// Trimmed rulings, `rulings` of each strip, as a table of comma-separated values, with their ends and lengths; null if
/// it is refused. The text is valid as long as that of `shapeop_ruledStripsText`.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledRulingsCsv(design: *mut ShapeOpRuled, rulings: c_int) -> *const c_char {
    shown(design, |draft| Ok(export::rulings_csv(&self::rulings(draft, SHAPEOP_RULED_ALL, rulings, true)?)))
}

/// Writes what zebra stripes show at points of any surface, from -1, the middle of a dark stripe, to 1, the middle of a
/// light one: reflections of light tubes along `direction`, `nb_stripes` of them around a full turn, turned about it by
/// `turn` radians. `eye` is a point, or, with `is_parallel` 1, the direction in which all eyes look. Where normals are
/// continuous, so are stripes; where a surface has a kink they break off.
///
/// # Safety
/// `points` and `normals` are null or readable for `3 * nb_points` doubles, `eye` and `direction` for 3; `out` is null
/// or writable for `nb_points` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledZebra(
    points: *const f64,
    normals: *const f64,
    nb_points: c_int,
    eye: *const f64,
    is_parallel: c_int,
    direction: *const f64,
    nb_stripes: c_int,
    turn: f64,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        // SAFETY: the caller vouches for the arrays.
        let (points, normals, eye, direction) = unsafe {
            let points = io::points("points", points, "nb_points", nb_points)?;
            let normals = io::points("normals", normals, "nb_points", nb_points)?;
            (points, normals, io::vector("eye", eye)?, io::vector("direction", direction)?)
        };
        let eye = if io::truth("is_parallel", is_parallel)? { Eye::Along(eye) } else { Eye::At(eye) };
        let count = io::count("nb_stripes", nb_stripes, 1, MOST_RULINGS)? as u32;
        let stripes = Stripes { direction, count, turn_rad: turn };
        let names = [("stripes.direction", "direction"), ("stripes.turn_rad", "turn")];
        let values = zebra(&points, &normals, eye, &stripes).map_err(|error| placed(error, &names))?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the output.
        unsafe { outputs.must("out", out, values)? };
        outputs.write()
    }))
}
