//! C-canal surfaces, named families, and what is true of a surface.

use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::sync::OnceLock;

use super::super::arguments::text;
use super::super::registry::position;
use super::super::structs::{self, SizedStruct};
use super::super::{c_count, code, guard_free, number, shapeop_err};
use super::io::{self, Outputs};
use super::smoothing::{shapeop_canal_progress, shapeop_canal_progress_callback};
use super::surface::{ShapeOpCanal, kind_number};
use super::{created_with, guard};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::c_canal::{Target, c_canal};
use crate::geometry::canal::chain::Kind;
use crate::geometry::canal::families::Family;
use crate::geometry::canal::properties::Properties;
use crate::mesh::curve::NearestOnCurve;

/// Creates the C-canal surface along `guide` whose row 0 is the convex planar polyline `section`, which starts at the
/// guide's first point. The far ends of the sections are at the distances `lengths` from the guide, one for each of its
/// points, the first that of the section; or, if `lengths` is null, on a second curve, the spline through `curve`. If
/// `projects_lengths` is 1 a length that is not attainable is replaced by the nearest that is. `progress`, which may be
/// null, can cancel: the surface then ends where it was.
///
/// Each output may be null; all have one entry for each row of the surface, of which there are at most `nb_guide`: the
/// distances made, how far each is off, the least and the greatest attainable ones, and whether a length was replaced.
/// Null if it is refused.
///
/// # Safety
/// `guide`, `section` and `curve` are null or readable for 3 times their number of points, `lengths` for `nb_guide`
/// doubles; `out_lengths`, `deviations` and `is_projected` are null or writable for `nb_guide` values, `attainable` for
/// twice as many, `is_cancelled` for one. `progress` is null or a function of that signature.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCCanal(
    guide: *const f64,
    nb_guide: c_int,
    section: *const f64,
    nb_section: c_int,
    lengths: *const f64,
    curve: *const f64,
    nb_curve: c_int,
    is_curve_closed: c_int,
    projects_lengths: c_int,
    progress: shapeop_canal_progress_callback,
    user: *mut c_void,
    out_lengths: *mut f64,
    deviations: *mut f64,
    attainable: *mut f64,
    is_projected: *mut c_int,
    is_cancelled: *mut c_int,
) -> *mut ShapeOpCanal {
    // SAFETY: the caller vouches for the arrays.
    created_with(|| unsafe {
        let guide = io::points("guide", guide, "nb_guide", nb_guide)?;
        let section = io::points("section", section, "nb_section", nb_section)?;
        io::size("nb_section", nb_section, guide.len())?;
        let is_strict = !io::truth("projects_lengths", projects_lengths)?;
        let mut iteration = 0;
        let mut call_back = |fraction: f64| {
            iteration += 1;
            let struct_size = size_of::<shapeop_canal_progress>() as c_uint;
            io::call_back(progress, user, &shapeop_canal_progress { struct_size, iteration, fraction, value: 0.0 })
        };
        let made = if lengths.is_null() {
            let is_closed = io::truth("is_curve_closed", is_curve_closed)?;
            let curve = io::spline("curve", curve, "nb_curve", nb_curve, is_closed)?;
            let nearest = NearestOnCurve::new(&curve)?;
            c_canal(&guide, &section, Target::Curve(&nearest), !is_strict, &mut call_back)?
        } else {
            let lengths = io::numbers("lengths", lengths, "nb_guide", nb_guide)?;
            c_canal(&guide, &section, Target::Lengths(&lengths), !is_strict, &mut call_back)?
        };
        let mut outputs = Outputs::default();
        let marks = io::marks(&made.projected, made.lengths.len());
        outputs.may("is_projected", is_projected, marks)?;
        outputs.may("out_lengths", out_lengths, made.lengths)?;
        outputs.may("deviations", deviations, made.deviations)?;
        outputs.may("attainable", attainable, made.attainable.concat())?;
        outputs.may("is_cancelled", is_cancelled, vec![c_int::from(made.is_cancelled)])?;
        Ok((made.surface, outputs))
    })
}

/// What a transformation keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_canal_step {
    /// A similarity: the family.
    SO_CANAL_STEP_SIMILARITY = 0,
    /// An inversion: circles and angles.
    SO_CANAL_STEP_MOEBIUS = 1,
    /// A Combescure transformation: the directions of edges.
    SO_CANAL_STEP_COMBESCURE = 2,
}

fn step(kind: Kind) -> c_int {
    (match kind {
        Kind::Similarity => shapeop_canal_step::SO_CANAL_STEP_SIMILARITY,
        Kind::Moebius => shapeop_canal_step::SO_CANAL_STEP_MOEBIUS,
        Kind::Combescure => shapeop_canal_step::SO_CANAL_STEP_COMBESCURE,
    }) as c_int
}

/// # Safety
/// `name` is null or ends with a zero.
unsafe fn family(name: *const c_char) -> Result<Family> {
    // SAFETY: the caller vouches for the text.
    let name = unsafe { text("name", name)? };
    Family::named(&name).ok_or_else(|| {
        let names = Family::ALL.map(Family::name).join(", ");
        Error::new(Status::InvalidValue, format!("expected one of {names}; found \"{name}\"")).at("name")
    })
}

/// The number of named families of super-canal surfaces, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalFamilyCount() -> c_int {
    number(guard_free(|| c_count(Family::ALL.len())))
}

/// The name of the family `index`, such as `MC-canal`; null if there is none. Valid as long as the library is loaded.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_canalFamilyName(index: c_int) -> *const c_char {
    static TEXTS: OnceLock<Vec<CString>> = OnceLock::new();
    let name = guard_free(|| {
        let at = position("index", index, Family::ALL.len(), "families")?;
        let all = || Family::ALL.iter().map(|family| CString::new(family.name()).unwrap_or_default()).collect();
        Ok(TEXTS.get_or_init(all)[at].as_ptr())
    });
    name.unwrap_or(std::ptr::null())
}

/// Writes how surfaces of a family are made: the `shapeop_canal_kind` of the base to `kind`, which may be null, and, if
/// there is room for `capacity` of them, the `shapeop_canal_step` of each transformation after it; `count` is their
/// number.
///
/// # Safety
/// `name` is null or ends with a zero; `steps` is null or writable for `capacity` ints, `kind` and `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalFamilySteps(
    name: *const c_char,
    kind: *mut c_int,
    steps: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the text and the outputs.
        unsafe {
            let family = family(name)?;
            outputs.may("kind", kind, vec![kind_number(family.base())])?;
            let all = family.kinds().iter().map(|&kind| step(kind)).collect();
            outputs.sized("steps", steps, capacity, count, all, 1)?;
        }
        outputs.write()
    }))
}

/// What is true of a surface's net, see `shapeop_canalProperties`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_canal_properties {
    /// In: `sizeof(shapeop_canal_properties)`.
    pub struct_size: c_uint,
    /// The number of faces.
    pub face_count: c_uint,
    /// The number of faces that cross themselves.
    pub crossed_count: c_uint,
    /// Faces turned against most of their neighbours.
    pub flipped_count: c_uint,
    /// Faces of which an edge is shorter than a twentieth of the one opposite.
    pub shrunk_count: c_uint,
    /// 1 if one family of lines of curvature is planar.
    pub has_planar_curves: c_int,
    /// 1 if the surface is isothermic by construction: one of revolution, or an inversion of one.
    pub is_isothermic_by_construction: c_int,
    /// Whether lines of curvature can be lines of principal stress: 1, 0, or -1 where that could not be measured.
    pub has_stress_lines: c_int,
    /// The largest planarity residual of a face.
    pub planarity: f64,
    /// The largest concyclicity residual of a face.
    pub concyclicity: f64,
    /// The largest distance of a row's point from its best-fit plane, over the row's extent.
    pub rows_off_plane: f64,
    /// The same of columns.
    pub columns_off_plane: f64,
    /// How far cross-ratios are from those of an isothermic net; 0 there.
    pub cross_ratio_residual: f64,
    /// The residual of the membrane under pressure on a refined net, 0 to 1; 0 where it could not be measured.
    pub stress_residual_coarse: f64,
    /// The same on a net refined more.
    pub stress_residual_fine: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_canal_properties {
    const SIZES: &'static [usize] = &[size_of::<shapeop_canal_properties>()];
}

/// Measures a surface and writes what was found to `out`, whose `struct_size` must be set. It may take seconds for
/// large nets.
///
/// # Safety
/// `out` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalProperties(
    surface: *mut ShapeOpCanal,
    out: *mut shapeop_canal_properties,
) -> shapeop_err {
    code(guard(surface, |surface| {
        // SAFETY: the caller vouches for `struct_size`.
        let size = unsafe { structs::size("out", out)? };
        let found = Properties::of(surface);
        let [coarse, fine] = found.stress_lines.as_ref().map_or([0.0; 2], |lines| lines.residuals);
        let told = shapeop_canal_properties {
            struct_size: 0,
            face_count: found.face_count as c_uint,
            crossed_count: found.crossed_count as c_uint,
            flipped_count: found.folds.flipped_faces.len() as c_uint,
            shrunk_count: found.folds.shrunk_faces.len() as c_uint,
            has_planar_curves: c_int::from(found.has_planar_curves()),
            is_isothermic_by_construction: c_int::from(found.is_isothermic_by_construction),
            has_stress_lines: found.stress_lines.as_ref().map_or(-1, |lines| c_int::from(lines.holds())),
            planarity: found.planarity,
            concyclicity: found.concyclicity,
            rows_off_plane: found.off_plane[0],
            columns_off_plane: found.off_plane[1],
            cross_ratio_residual: found.cross_ratio_residual,
            stress_residual_coarse: coarse,
            stress_residual_fine: fine,
        };
        let numbers = [told.planarity, told.concyclicity, told.rows_off_plane, told.columns_off_plane];
        let more = [told.cross_ratio_residual, coarse, fine];
        if !numbers.iter().chain(&more).all(|value| value.is_finite()) {
            let reason = "coordinates are so large that a property is not finite";
            return Err(Error::new(Status::InvalidValue, reason).at("surface"));
        }
        // SAFETY: the caller vouches for so many bytes.
        unsafe { structs::write(out, size, &told) };
        Ok(())
    }))
}
