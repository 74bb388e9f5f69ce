//! Canal surfaces that fit two curves, and meshes of circles.

use std::ffi::{c_int, c_uint};

use glam::DVec3;

use super::super::arguments::length;
use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::created_with;
use super::io::{self, Outputs};
use super::surface::ShapeOpCanal;
use super::touching_spheres::{guide_of, spacing, sphere_flags, sphere_numbers};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::circles::{self, Section};
use crate::geometry::canal::fit::{self, FitOptions};
use crate::geometry::canal::net::Net;
use crate::geometry::canal::normals::Orientation;
use crate::geometry::canal::surface::{BaseKind, SuperCanal};
use crate::mesh::curve::NearestOnCurve;

/// Which part of a circle is meshed, from a point of it on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_canal_section {
    /// All of it; the mesh closes around it.
    SO_CANAL_SECTION_WHOLE = 0,
    /// From the angle `from_angle` to `to_angle`, less than a full turn.
    SO_CANAL_SECTION_ANGLES = 1,
    /// From the point to the one nearest to where the second curve passes.
    SO_CANAL_SECTION_TO_CURVE = 2,
    /// What is above a plane.
    SO_CANAL_SECTION_ABOVE = 3,
}

/// What `shapeop_canalFit` and `shapeop_canalSectionPoints` take. Start from `shapeop_canalDefaultFitOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_canal_fit_options {
    /// In: `sizeof(shapeop_canal_fit_options)`.
    pub struct_size: c_uint,
    /// How many circles, one through each of as many points of the first curve; at least 2, 3 on a closed curve.
    /// Default 16.
    pub circle_count: c_int,
    /// How many points of each circle; at least 2, 3 of whole circles. Default 12.
    pub column_count: c_int,
    /// A `shapeop_canal_spacing`. Default 0; with `SO_CANAL_SPACING_POINTS` the number of circles is that of the
    /// points.
    pub spacing: c_int,
    /// A `shapeop_canal_section`. Default 0.
    pub section: c_int,
    /// For `SO_CANAL_SECTION_TO_CURVE`, 1: around the far side of the circle. Default 0.
    pub is_long_way: c_int,
    /// 1: the first normal is as near as possible to `normal_x`, `normal_y`, `normal_z`; 0, the default: it is at the
    /// angle `angle`.
    pub has_normal: c_int,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_int,
    /// The angle, in radians, about the first tangent from the direction of z orthogonal to it (of x where it is along
    /// z). Default 0.
    pub angle: f64,
    /// The first normal, x.
    pub normal_x: f64,
    /// The first normal, y.
    pub normal_y: f64,
    /// The first normal, z.
    pub normal_z: f64,
    /// Where `SO_CANAL_SECTION_ANGLES` starts, in radians from the point of the first curve. Default 0.
    pub from_angle: f64,
    /// Where it ends, on either side of the start. Default pi.
    pub to_angle: f64,
    /// A point of the plane of `SO_CANAL_SECTION_ABOVE`, x.
    pub plane_x: f64,
    /// A point of the plane, y.
    pub plane_y: f64,
    /// A point of the plane, z.
    pub plane_z: f64,
    /// The plane's normal, of any length, x.
    pub up_x: f64,
    /// The plane's normal, y.
    pub up_y: f64,
    /// The plane's normal, z. Default 1.
    pub up_z: f64,
}

/// What `shapeop_canalFit` found.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_canal_fit_report {
    /// In: `sizeof(shapeop_canal_fit_report)`.
    pub struct_size: c_uint,
    /// Whether the normal points away from the centers of the spheres.
    pub is_outward: c_int,
    /// The largest distance of the second curve from a circle where it crosses the circle's plane.
    pub deviation: f64,
    /// The sum of the squared differences of the radii of spheres and their distances to the second curve.
    pub residual: f64,
    /// The largest difference of the surface's tangents from the first curve's.
    pub tangent_gap: f64,
    /// Of a closed first curve, how far the last frame is from the first after one turn; 0 of an open one.
    pub closing_gap: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_canal_fit_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_canal_fit_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_canal_fit_report {
    const SIZES: &'static [usize] = &[size_of::<shapeop_canal_fit_report>()];
}

fn default_options() -> shapeop_canal_fit_options {
    shapeop_canal_fit_options {
        struct_size: 0,
        circle_count: 16,
        column_count: 12,
        spacing: 0,
        section: 0,
        is_long_way: 0,
        has_normal: 0,
        reserved: 0,
        angle: 0.0,
        normal_x: 0.0,
        normal_y: 0.0,
        normal_z: 0.0,
        from_angle: 0.0,
        to_angle: std::f64::consts::PI,
        plane_x: 0.0,
        plane_y: 0.0,
        plane_z: 0.0,
        up_x: 0.0,
        up_y: 0.0,
        up_z: 1.0,
    }
}

/// Writes the default options to `options`, whose `struct_size` must be set.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalDefaultFitOptions(options: *mut shapeop_canal_fit_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

/// # Safety
/// `options` is null, or its `struct_size` is set and it is readable for so many bytes.
unsafe fn read_options(options: *const shapeop_canal_fit_options) -> Result<shapeop_canal_fit_options> {
    if options.is_null() {
        return Ok(default_options());
    }
    // SAFETY: the caller vouches for it; numbers are valid for any bytes.
    unsafe { structs::read("options", options, default_options()) }
}

fn section(options: &shapeop_canal_fit_options) -> Result<Section> {
    Ok(match options.section {
        0 => Section::Whole,
        1 => Section::Angles { from_rad: options.from_angle, to_rad: options.to_angle },
        2 => Section::ToCurve { is_long_way: io::truth("options->is_long_way", options.is_long_way)? },
        3 => Section::Above {
            point: DVec3::new(options.plane_x, options.plane_y, options.plane_z),
            normal: DVec3::new(options.up_x, options.up_y, options.up_z),
        },
        found => {
            let reason = format!("expected a shapeop_canal_section, 0 to 3, found {found}");
            return Err(Error::new(Status::InvalidValue, reason).at("options->section"));
        }
    })
}

/// Creates the canal surface through the points of a first curve that touches a second one: the splines through `guide`
/// and `curve`. Row `i` is on circle `i`, from its point of the first curve on unless the section starts elsewhere.
/// Rows do not wrap; columns do around whole circles. `options` is null for the defaults. Null if it is refused.
///
/// The outputs may be null (a count with them): the circles, 7 doubles each, and the spheres between them, 4 doubles
/// each, with bits `SHAPEOP_SPHERE_...`, are written if there is room for so many. `report` is null, or its
/// `struct_size` is set.
///
/// # Safety
/// `guide` and `curve` are null or readable for 3 times their number of points; `circles` is null or writable for `7 *
/// circle_capacity` doubles, `spheres` for `4 * sphere_capacity`, `sphere_flags` for `sphere_capacity` ints, the counts
/// for one. `options` and `report` are null, or their `struct_size` is set and they are readable or writable for so
/// many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalFit(
    guide: *const f64,
    nb_guide: c_int,
    is_guide_closed: c_int,
    curve: *const f64,
    nb_curve: c_int,
    is_curve_closed: c_int,
    options: *const shapeop_canal_fit_options,
    circles: *mut f64,
    circle_capacity: c_int,
    circle_count: *mut c_int,
    spheres: *mut f64,
    sphere_flags: *mut c_int,
    sphere_capacity: c_int,
    sphere_count: *mut c_int,
    report: *mut shapeop_canal_fit_report,
) -> *mut ShapeOpCanal {
    // SAFETY: the caller vouches for the arrays and the structs.
    created_with(|| unsafe {
        let told = read_options(options)?;
        let report_size = if report.is_null() { 0 } else { structs::size("report", report)? };
        let guide = io::spline("guide", guide, "nb_guide", nb_guide, io::truth("is_guide_closed", is_guide_closed)?)?;
        let curve = io::spline("curve", curve, "nb_curve", nb_curve, io::truth("is_curve_closed", is_curve_closed)?)?;
        let has_normal = io::truth("options->has_normal", told.has_normal)?;
        let normal = DVec3::new(told.normal_x, told.normal_y, told.normal_z);
        let spread = spacing("options->spacing", told.spacing)?;
        let column_count = io::size("options->column_count", told.column_count, 1)?;
        let row_count = if spread.is_none() { guide.knots().len() } else { 1 };
        let circle_total = io::size("options->circle_count", told.circle_count, column_count.max(1) * row_count)?;
        let options = FitOptions {
            circle_count: circle_total,
            spacing: spread.unwrap_or_default(),
            column_count,
            orientation: if has_normal { Orientation::Normal(normal) } else { Orientation::Angle(told.angle) },
            section: section(&told)?,
        };
        let found = match spread {
            Some(_) => fit::fit(&guide, &curve, &options)?,
            None => fit::fit_guide(&guide_of(&guide)?, &NearestOnCurve::new(&curve)?, &options)?,
        };
        let strip = &found.strip;
        let mut outputs = Outputs::default();
        if !(circles.is_null() && circle_count.is_null()) {
            let values = io::circle_numbers(&strip.circles);
            outputs.sized("circles", circles, circle_capacity, circle_count, values, 7)?;
        }
        if !(spheres.is_null() && sphere_count.is_null()) {
            let values = sphere_numbers(&strip.spheres.spheres());
            outputs.sized("spheres", spheres, sphere_capacity, sphere_count, values, 4)?;
            if !sphere_flags.is_null() {
                let flags = self::sphere_flags(&strip.spheres);
                outputs.sized("sphere_flags", sphere_flags, sphere_capacity, sphere_count, flags, 1)?;
            }
        }
        let told = shapeop_canal_fit_report {
            struct_size: 0,
            is_outward: c_int::from(found.is_outward),
            deviation: found.deviation,
            residual: strip.spheres.residual,
            tangent_gap: strip.tangent_gap,
            closing_gap: strip.closing_gap.unwrap_or(0.0),
        };
        if ![told.deviation, told.residual, told.tangent_gap, told.closing_gap].iter().all(|value| value.is_finite()) {
            let reason = "coordinates are so large that the report is not finite";
            return Err(Error::new(Status::InvalidValue, reason).at("report"));
        }
        if !report.is_null() {
            outputs.then(move || structs::write(report, report_size, &told));
        }
        Ok((SuperCanal::new(Net::new(found.grid, found.frame)?, BaseKind::Canal), outputs))
    })
}

/// Writes points of a section of a circle at equal angles, from its point `start` on: as many as
/// `options->column_count` says. `target` is where the second curve passes, for `SO_CANAL_SECTION_TO_CURVE`; else null.
/// Of `options` those on the section count.
///
/// # Safety
/// `circle` is null or readable for 7 doubles, `start` and `target` for 3; `options` is null, or its `struct_size` is
/// set and it is readable for so many bytes; `out` is null or writable for 3 times the number of points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalSectionPoints(
    circle: *const f64,
    start: *const f64,
    target: *const f64,
    options: *const shapeop_canal_fit_options,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let told = read_options(options)?;
            let count = io::size("options->column_count", told.column_count, 1)?;
            let (circle, start) = (io::circle("circle", circle)?, io::vector("start", start)?);
            let target = io::optional_vector("target", target)?;
            outputs.must(
                "out",
                out,
                io::coordinates(&section(&told)?.samples(&circle, start, count, target)?.points),
            )?;
        }
        outputs.write()
    }))
}

/// Writes the grid of which row `i` is on circle `i` and row 0 is given; `guide` has a point of each circle, along
/// which the rows lead from circle to circle. Consecutive circles are on one sphere. If `wraps` is 1 the rows close
/// around the circles.
///
/// # Safety
/// `circles` is null or readable for `7 * nb_circles` doubles, `guide` for `3 * nb_circles`, `row` for `3 * nb_row`;
/// `out` is null or writable for `3 * nb_circles * nb_row`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalMeshCircles(
    circles: *const f64,
    guide: *const f64,
    nb_circles: c_int,
    row: *const f64,
    nb_row: c_int,
    wraps: c_int,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let circles = io::circles("circles", circles, length("nb_circles", nb_circles)?)?;
            let guide = io::points("guide", guide, "nb_circles", nb_circles)?;
            let row = io::points("row", row, "nb_row", nb_row)?;
            io::size("nb_row", nb_row, circles.len())?;
            let grid = circles::mesh(&circles, &guide, &row, io::truth("wraps", wraps)?)?;
            outputs.must("out", out, io::coordinates(grid.points()))?;
        }
        outputs.write()
    }))
}

/// Writes a point of each circle from `start`, a point of the first, on. With `guide`, a point of each circle, they
/// make circular quads with it; with null they are a column along which a mesh closes around whole circles: the
/// circles' tangents there are mirror images of each other.
///
/// # Safety
/// `circles` is null or readable for `7 * nb_circles` doubles, `start` for 3; `guide` is null or readable, `out` null
/// or writable, for `3 * nb_circles`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalColumn(
    circles: *const f64,
    nb_circles: c_int,
    start: *const f64,
    guide: *const f64,
    out: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let all = io::circles("circles", circles, length("nb_circles", nb_circles)?)?;
            let start = io::vector("start", start)?;
            let column = if guide.is_null() {
                circles::column(&all, start)?
            } else {
                circles::strip(&all, &io::points("guide", guide, "nb_circles", nb_circles)?, start)?
            };
            outputs.must("out", out, io::coordinates(&column))?;
        }
        outputs.write()
    }))
}
