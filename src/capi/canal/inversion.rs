//! Inversions of points, circles, spheres and planes.

use std::ffi::c_int;

use glam::{DVec2, DVec3};

use super::super::arguments::{length, slice};
use super::super::{code, guard_free, shapeop_err};
use super::io::{self, Outputs};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::inversion::{GeneralCircle, GeneralSphere, Inversion, invert_complex};
use crate::geometry::circle::Sphere;

/// # Safety
/// `center` is null or readable for 3 doubles.
unsafe fn inversion(center: *const f64, ratio: f64) -> Result<Inversion> {
    // SAFETY: the caller vouches for 3 doubles.
    Inversion::new(unsafe { io::vector("center", center)? }, ratio)
}

/// Writes the images of points under the inversion at `center`: a point at the vector `q` from there goes to
/// `ratio * q / |q|^2`. `ratio` is in squared model units and not 0; below 0 it mirrors in the center too.
///
/// # Safety
/// `points` is null or readable, `out` null or writable, for `3 * nb_points` doubles; `center` is readable for 3.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalInvertPoints(
    points: *const f64,
    nb_points: c_int,
    center: *const f64,
    ratio: f64,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let points = io::points("points", points, "nb_points", nb_points)?;
            let images = inversion(center, ratio)?.points(&points)?;
            outputs.must("out", out, io::coordinates(&images))?;
        }
        outputs.write()
    }))
}

/// The same in the complex plane: `points` and `out` have 2 doubles for each point, its real and its imaginary part.
///
/// # Safety
/// `points` is null or readable, `out` null or writable, for `2 * nb_points` doubles; `center` is readable for 2.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalInvertComplex(
    points: *const f64,
    nb_points: c_int,
    center: *const f64,
    ratio: f64,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let too_large =
            || Error::new(Status::TooLarge, format!("{nb_points} points do not fit the memory")).at("nb_points");
        let count = length("nb_points", nb_points)?.checked_mul(2).ok_or_else(too_large)?;
        // SAFETY: the caller vouches for the arrays.
        let (values, center) = unsafe { (slice("points", points, count)?, slice("center", center, 2)?) };
        let center = DVec2::from_slice(center);
        // The checks of the inversion of space are those of the plane.
        let checked: Vec<DVec3> = values.chunks_exact(2).map(|z| DVec3::new(z[0], z[1], 0.0)).collect();
        Inversion::new(center.extend(0.0), ratio)?.points(&checked)?;
        let images =
            values.chunks_exact(2).flat_map(|z| invert_complex(DVec2::from_slice(z), center, ratio).to_array());
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the array.
        unsafe { outputs.must("out", out, images.collect())? };
        outputs.write()
    }))
}

/// Writes the image of a circle: its center, the unit vector along its axis and its radius, 7 doubles, as it is given.
/// A circle through the center of inversion goes to a line: `is_line` then is 1, and `out` a point of it, a unit vector
/// along it, and 0.
///
/// # Safety
/// `circle` is null or readable for 7 doubles, `center` for 3; `out` is null or writable for 7 doubles, `is_line` for
/// one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalInvertCircle(
    circle: *const f64,
    center: *const f64,
    ratio: f64,
    out: *mut f64,
    is_line: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        // SAFETY: the caller vouches for the arrays.
        let image = unsafe { inversion(center, ratio)?.circle(&io::circle("circle", circle)?) };
        let (values, line) = match image {
            GeneralCircle::Circle(circle) => (io::circle_numbers(&[circle]), 0),
            GeneralCircle::Line(point, direction) => (seven(point, direction), 1),
        };
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.must("out", out, values)?;
            outputs.must("is_line", is_line, vec![line])?;
        }
        outputs.write()
    }))
}

fn seven(point: DVec3, direction: DVec3) -> Vec<f64> {
    [&point.to_array()[..], &direction.to_array(), &[0.0]].concat()
}

/// # Safety
/// `out` is null or writable for 7 doubles, `is_plane` for one int.
unsafe fn tell_sphere(image: GeneralSphere, out: *mut f64, is_plane: *mut c_int) -> Result<()> {
    let (values, plane) = match image {
        GeneralSphere::Sphere(sphere) => {
            let mut values = seven(sphere.center, DVec3::ZERO);
            values[6] = sphere.radius;
            (values, 0)
        }
        GeneralSphere::Plane(point, normal) => (seven(point, normal), 1),
    };
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for the outputs.
    unsafe {
        outputs.must("out", out, values)?;
        outputs.must("is_plane", is_plane, vec![plane])?;
    }
    outputs.write()
}

/// Writes the image of a sphere. Either `is_plane` is 0 and `out` has a sphere: its center, three zeros, and its
/// radius. Or, for a sphere through the center of inversion, it is 1 and `out` has a plane: a point, the unit normal,
/// and 0.
///
/// # Safety
/// `sphere_center` and `center` are null or readable for 3 doubles; `out` is null or writable for 7, `is_plane` for one
/// int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalInvertSphere(
    sphere_center: *const f64,
    radius: f64,
    center: *const f64,
    ratio: f64,
    out: *mut f64,
    is_plane: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(
                Error::new(Status::InvalidValue, format!("expected a radius above 0, found {radius}")).at("radius")
            );
        }
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let sphere = Sphere { center: io::vector("sphere_center", sphere_center)?, radius };
            tell_sphere(inversion(center, ratio)?.sphere(&sphere), out, is_plane)
        }
    }))
}

/// As `shapeop_canalInvertSphere`, for the plane through a point with a normal of any length but 0.
///
/// # Safety
/// `point`, `normal` and `center` are null or readable for 3 doubles; `out` is null or writable for 7, `is_plane` for
/// one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalInvertPlane(
    point: *const f64,
    normal: *const f64,
    center: *const f64,
    ratio: f64,
    out: *mut f64,
    is_plane: *mut c_int,
) -> shapeop_err {
    code(guard_free(|| {
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let (point, normal) = (io::vector("point", point)?, io::vector("normal", normal)?);
            let Some(normal) = normal.try_normalize() else {
                let reason = format!("expected a vector other than 0, found {normal}");
                return Err(Error::new(Status::InvalidValue, reason).at("normal"));
            };
            tell_sphere(inversion(center, ratio)?.plane(point, normal), out, is_plane)
        }
    }))
}
