//! Steps of a fit to two curves: their points, normals along the first, spheres that touch both, the circles between.

use std::ffi::c_int;

use glam::DVec3;

use super::super::arguments::{length, slice};
use super::super::{code, guard_free, shapeop_err};
use super::io::{self, Outputs};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::normals::{Guide, Orientation, reflected_frames, rotation_minimising};
use crate::geometry::canal::two_curves::{TouchingSpheres, characteristic_circles, spheres_at_points};
use crate::geometry::circle::Sphere;
use crate::mesh::curve::{Curve, NearestOnCurve, Spacing, Spline, resample};

/// How points are spread over a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_canal_spacing {
    /// At equal lengths of the curve.
    SO_CANAL_SPACING_ARC_LENGTH = 0,
    /// At equal steps of its parameter, the length of chords along the given points.
    SO_CANAL_SPACING_PARAMETER = 1,
    /// The points that were given.
    SO_CANAL_SPACING_POINTS = 2,
}

/// A bit of the flags of spheres: the sphere passes through an end of the second curve and is not tangent to it.
pub const SHAPEOP_SPHERE_END: c_int = 1;

/// A bit of the flags of spheres: it touches the second curve on another branch than the sphere before.
pub const SHAPEOP_SPHERE_JUMP: c_int = 2;

/// A bit of the flags of spheres: its center is on the other side of the first curve than that of the sphere before.
pub const SHAPEOP_SPHERE_SIGN_CHANGE: c_int = 4;

/// A bit of the flags of spheres: another branch of the second curve is inside.
pub const SHAPEOP_SPHERE_PIERCED: c_int = 8;

/// How points are spread; `None` for the points themselves.
pub(super) fn spacing(name: &str, number: c_int) -> Result<Option<Spacing>> {
    match number {
        0 => Ok(Some(Spacing::ArcLength)),
        1 => Ok(Some(Spacing::Parameter)),
        2 => Ok(None),
        _ => {
            let reason = format!("expected a shapeop_canal_spacing, 0 to 2, found {number}");
            Err(Error::new(Status::InvalidValue, reason).at(name))
        }
    }
}

/// The guide at the points of a spline, with its tangents there.
pub(super) fn guide_of(curve: &Spline) -> Result<Guide> {
    let knots = if curve.is_closed() { &curve.knots()[..curve.knots().len() - 1] } else { curve.knots() };
    let points: Vec<DVec3> = knots.iter().map(|&knot| curve.point(knot)).collect();
    let tangents: Vec<DVec3> = knots.iter().map(|&knot| curve.tangent(knot)).collect();
    Guide::new(&points, &tangents, curve.is_closed())
}

/// Writes points spread over the cubic spline through given ones, and its unit tangents there, which may be null.
/// `spacing` is a `shapeop_canal_spacing`; for `SO_CANAL_SPACING_POINTS` `nb` is that of the points themselves (without
/// a last one that repeats the first of a closed curve). A closed curve's first point is not repeated.
///
/// # Safety
/// `points` is null or readable for `3 * nb_points` doubles; `out` and `tangents` are null or writable for `3 * nb`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCurvePoints(
    points: *const f64,
    nb_points: c_int,
    is_closed: c_int,
    spacing: c_int,
    out: *mut f64,
    tangents: *mut f64,
    nb: c_int,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let curve = io::spline("points", points, "nb_points", nb_points, io::truth("is_closed", is_closed)?)?;
            let guide = match self::spacing("spacing", spacing)? {
                Some(spacing) => {
                    let parameters = resample(&curve, io::size("nb", nb, 1)?, spacing)?;
                    let points: Vec<DVec3> = parameters.iter().map(|&at| curve.point(at)).collect();
                    let tangents: Vec<DVec3> = parameters.iter().map(|&at| curve.tangent(at)).collect();
                    Guide::new(&points, &tangents, curve.is_closed())?
                }
                None => guide_of(&curve)?,
            };
            if guide.points().len() != length("nb", nb)? {
                let reason = format!("expected {}, the number of points; found {nb}", guide.points().len());
                return Err(Error::new(Status::InvalidArgumentLength, reason).at("nb"));
            }
            outputs.must("out", out, io::coordinates(guide.points()))?;
            outputs.may("tangents", tangents, io::coordinates(guide.tangents()))?;
        }
        outputs.write()
    }))
}

/// Writes normals along a curve through given points, the first one at an angle (see
/// `shapeop_canal_fit_options.angle`), or as near as possible to `first` if that is not null. `tangents`, of any
/// length, are those of the curve; null: of the spline through the points. `normals` turn as little as the curve
/// allows; `frames` (9 doubles each) are mirrored from point to point, as those of a cyclidic net along its guide. Each
/// of the two may be null. The last point of a closed curve must not repeat the first.
///
/// # Safety
/// `points` and `tangents` are null or readable, `normals` is null or writable, for `3 * nb_points` doubles; `first` is
/// null or readable for 3; `frames` is null or writable for `9 * nb_points`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalNormals(
    points: *const f64,
    tangents: *const f64,
    nb_points: c_int,
    is_closed: c_int,
    angle: f64,
    first: *const f64,
    normals: *mut f64,
    frames: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let is_closed = io::truth("is_closed", is_closed)?;
            let guide = if tangents.is_null() {
                guide_of(&io::spline("points", points, "nb_points", nb_points, is_closed)?)?
            } else {
                let points = io::points("points", points, "nb_points", nb_points)?;
                Guide::new(&points, &io::points("tangents", tangents, "nb_points", nb_points)?, is_closed)?
            };
            if guide.points().len() != length("nb_points", nb_points)? {
                let reason = "expected a last point that does not repeat the first";
                return Err(Error::new(Status::InvalidArgumentLength, reason).at("nb_points"));
            }
            let orientation = match io::optional_vector("first", first)? {
                Some(normal) => Orientation::Normal(normal),
                None => Orientation::Angle(angle),
            };
            if !normals.is_null() {
                outputs.must("normals", normals, io::coordinates(&rotation_minimising(&guide, orientation)?))?;
            }
            if !frames.is_null() {
                outputs.must("frames", frames, io::frame_numbers(&reflected_frames(&guide, orientation)?))?;
            }
        }
        outputs.write()
    }))
}

pub(super) fn sphere_numbers(spheres: &[Sphere]) -> Vec<f64> {
    spheres.iter().flat_map(|sphere| [sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius]).collect()
}

pub(super) fn sphere_flags(found: &TouchingSpheres) -> Vec<c_int> {
    let findings = &found.findings;
    let of = |k: usize| {
        [
            (&findings.ends, SHAPEOP_SPHERE_END),
            (&findings.jumps, SHAPEOP_SPHERE_JUMP),
            (&findings.sign_changes, SHAPEOP_SPHERE_SIGN_CHANGE),
            (&findings.pierced, SHAPEOP_SPHERE_PIERCED),
        ]
        .iter()
        .map(|(list, bit)| if list.contains(&k) { *bit } else { 0 })
        .sum()
    };
    (0..found.touching.len()).map(of).collect()
}

/// Writes the spheres that touch a curve in given points, with their centers along `normals` (of any length), and a
/// second curve, the spline through `curve`: the center and the radius, 4 doubles each. Each other output may be null:
/// how far each center is along its normal, where each sphere touches the second curve, bits `SHAPEOP_SPHERE_...` for
/// each, and the sum of the squared differences of radius and distance.
///
/// # Safety
/// `points` and `normals` are null or readable for `3 * nb_points` doubles, `curve` for `3 * nb_curve`; for each point
/// `spheres` is null or writable for 4 doubles, `offsets` for one, `feet` for 3, `flags` for one int; `residual` for
/// one double.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalTouchingSpheres(
    points: *const f64,
    normals: *const f64,
    nb_points: c_int,
    curve: *const f64,
    nb_curve: c_int,
    is_curve_closed: c_int,
    spheres: *mut f64,
    offsets: *mut f64,
    feet: *mut f64,
    flags: *mut c_int,
    residual: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let points = io::points("points", points, "nb_points", nb_points)?;
            let normals = io::points("normals", normals, "nb_points", nb_points)?;
            let is_closed = io::truth("is_curve_closed", is_curve_closed)?;
            let curve = io::spline("curve", curve, "nb_curve", nb_curve, is_closed)?;
            let found = spheres_at_points(&points, &normals, &NearestOnCurve::new(&curve)?)?;
            let touching: Vec<DVec3> = found.touching.iter().map(|each| each.foot.point).collect();
            outputs.must("spheres", spheres, sphere_numbers(&found.spheres()))?;
            outputs.may("offsets", offsets, found.touching.iter().map(|each| each.offset).collect())?;
            outputs.may("feet", feet, io::coordinates(&touching))?;
            outputs.may("flags", flags, sphere_flags(&found))?;
            outputs.may("residual", residual, vec![found.residual])?;
        }
        outputs.write()
    }))
}

/// Writes the circles in which each sphere (its center and its radius, 4 doubles) meets the next: one fewer than
/// spheres.
///
/// # Safety
/// `spheres` is null or readable for `4 * nb_spheres` doubles, `out` is null or writable for `7 * (nb_spheres - 1)`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCharacteristicCircles(
    spheres: *const f64,
    nb_spheres: c_int,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let too_large =
            || Error::new(Status::TooLarge, format!("{nb_spheres} spheres do not fit the memory")).at("nb_spheres");
        let count = length("nb_spheres", nb_spheres)?.checked_mul(4).ok_or_else(too_large)?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let values = slice("spheres", spheres, count)?;
            let sphere = |values: &[f64]| Sphere { center: DVec3::from_slice(&values[..3]), radius: values[3] };
            let spheres: Vec<Sphere> = values.chunks_exact(4).map(sphere).collect();
            outputs.must("out", out, io::circle_numbers(&characteristic_circles(&spheres)?))?;
        }
        outputs.write()
    }))
}
