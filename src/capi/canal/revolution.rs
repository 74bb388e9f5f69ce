//! Base surfaces, and inversions of surfaces of revolution and of moulding surfaces.

use std::ffi::c_int;

use glam::DVec3;

use super::super::{c_count, code, guard_free, shapeop_err};
use super::io::{self, Outputs};
use super::surface::ShapeOpCanal;
use super::{created, created_with};
use crate::error::{Error, Result, Status};
use crate::geometry::canal::bases::{self, InvertedBase, Swept};
use crate::geometry::canal::chain::Transform;
use crate::geometry::canal::inversion::GeneralCircle;
use crate::geometry::canal::m_moulding::{MouldingCenter, m_moulding};
use crate::geometry::canal::m_revolution::{MRevolution, m_revolution};
use crate::geometry::canal::net::Net;
use crate::geometry::canal::revolution_centers::{Center, Corners};
use crate::geometry::canal::spherical_guide::{GuideSphere, spherical_m_revolution};
use crate::geometry::canal::surface::{BaseKind, SuperCanal};
use crate::geometry::circle::Sphere;
use crate::mesh::Grid;

/// Creates the surface of revolution of a profile about the axis through `axis_point` along `axis_direction`. Column 0
/// is the profile, row `i` runs along the circle of its point `i`, `columns` points from 0 to `angle` (0 to 2 pi,
/// right-handed); a full turn wraps. Null if it is refused, as a profile is that is not in a plane through the axis.
///
/// # Safety
/// `profile` is null or readable for `3 * nb_profile` doubles, the axis for 3 each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalRevolution(
    profile: *const f64,
    nb_profile: c_int,
    axis_point: *const f64,
    axis_direction: *const f64,
    angle: f64,
    columns: c_int,
) -> *mut ShapeOpCanal {
    created(|| {
        // SAFETY: the caller vouches for the arrays.
        let (profile, point, direction) = unsafe {
            let profile = io::points("profile", profile, "nb_profile", nb_profile)?;
            (profile, io::vector("axis_point", axis_point)?, io::vector("axis_direction", axis_direction)?)
        };
        let columns = io::size("columns", columns, profile.len())?;
        let base = bases::revolution(&profile, point, direction, angle, columns)?;
        Ok(SuperCanal::new(Net::new(base.grid, base.frame)?, BaseKind::Revolution))
    })
}

/// # Safety
/// Both arrays are null or readable for 3 times their number of points.
unsafe fn curves(rail: *const f64, nb_rail: c_int, profile: *const f64, nb_profile: c_int) -> Result<[Vec<DVec3>; 2]> {
    // SAFETY: the caller vouches for the arrays.
    let curves = unsafe {
        [io::points("rail", rail, "nb_rail", nb_rail)?, io::points("profile", profile, "nb_profile", nb_profile)?]
    };
    io::size("nb_profile", nb_profile, curves[0].len())?;
    Ok(curves)
}

/// # Safety
/// Each output is null or writable for one value.
unsafe fn swept(
    made: Swept,
    kind: BaseKind,
    obliquity: *mut f64,
    reversed_count: *mut c_int,
    closing_gap: *mut f64,
) -> Result<(SuperCanal, Outputs)> {
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for the outputs.
    unsafe {
        outputs.may("obliquity", obliquity, vec![made.obliquity_rad])?;
        outputs.may("reversed_count", reversed_count, vec![c_count(made.reversed_count)?])?;
        outputs.may("closing_gap", closing_gap, vec![made.closing_gap])?;
    }
    Ok((SuperCanal::new(Net::new(made.base.grid, made.base.frame)?, kind), outputs))
}

/// Creates the moulding surface of a planar rail and a profile in an orthogonal plane that starts on it. Column 0 is
/// the rail, row 0 the profile. Each output may be null: the angle, in radians, between the normal of the profile's
/// plane and the rail's start; how many edges point the other way than the rail's, where the profile reaches beyond the
/// rail's evolute; for a closed rail, how far the profile is from itself after one turn. Null if it is refused.
///
/// # Safety
/// `rail` and `profile` are null or readable for 3 times their number of points; each output is null or writable for
/// one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalMoulding(
    rail: *const f64,
    nb_rail: c_int,
    profile: *const f64,
    nb_profile: c_int,
    obliquity: *mut f64,
    reversed_count: *mut c_int,
    closing_gap: *mut f64,
) -> *mut ShapeOpCanal {
    // SAFETY: the caller vouches for the arrays.
    created_with(|| unsafe {
        let [rail, profile] = curves(rail, nb_rail, profile, nb_profile)?;
        let made = bases::moulding(&rail, &profile)?;
        swept(made, BaseKind::Moulding, obliquity, reversed_count, closing_gap)
    })
}

/// As `shapeop_canalMoulding`, for a rail in space and a planar profile that starts on it: the Monge surface, on which
/// the profile moves without twist.
///
/// # Safety
/// As `shapeop_canalMoulding`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalMonge(
    rail: *const f64,
    nb_rail: c_int,
    profile: *const f64,
    nb_profile: c_int,
    obliquity: *mut f64,
    reversed_count: *mut c_int,
    closing_gap: *mut f64,
) -> *mut ShapeOpCanal {
    // SAFETY: the caller vouches for the arrays.
    created_with(|| unsafe {
        let [rail, profile] = curves(rail, nb_rail, profile, nb_profile)?;
        let made = bases::monge(&rail, &profile)?;
        swept(made, BaseKind::Circular, obliquity, reversed_count, closing_gap)
    })
}

/// # Safety
/// `points` is null or writable for `3 * capacity` doubles, `count` for one int; the others are null or writable for
/// one int.
unsafe fn tell_grid(
    grid: &Grid,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    size: [*mut c_int; 3],
) -> Result<()> {
    let bits = c_int::from(grid.wraps()[0]) | c_int::from(grid.wraps()[1]) << 1;
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for the outputs.
    unsafe {
        outputs.sized("points", points, capacity, count, io::coordinates(grid.points()), 3)?;
        outputs.may("rows", size[0], vec![c_count(grid.rows())?])?;
        outputs.may("columns", size[1], vec![c_count(grid.columns())?])?;
        outputs.may("wraps", size[2], vec![bits])?;
    }
    outputs.write()
}

/// Writes the surface of translation, `rail[i] + profile[j] - profile[0]`, if there is room for `capacity` points, and
/// their number to `count`. Its quads are planar but not circular, so it is no surface with a handle. With `factors`,
/// one above 0 for each rail point, it is the surface of scale-translation, `rail[i] + factors[i] (profile[j] -
/// profile[0])`; null for none. A rail or a profile whose last point repeats the first closes the grid. `rows`,
/// `columns` and `wraps` may be null.
///
/// # Safety
/// `rail` and `profile` are null or readable for 3 times their number of points, `factors` for `nb_rail` doubles;
/// `points` is null or writable for `3 * capacity` doubles, the other outputs for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalTranslation(
    rail: *const f64,
    nb_rail: c_int,
    profile: *const f64,
    nb_profile: c_int,
    factors: *const f64,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    rows: *mut c_int,
    columns: *mut c_int,
    wraps: *mut c_int,
) -> shapeop_err {
    // SAFETY: the caller vouches for the arrays.
    code(guard_free(|| unsafe {
        let [rail, profile] = curves(rail, nb_rail, profile, nb_profile)?;
        let grid = if factors.is_null() {
            bases::translation(&rail, &profile)?
        } else {
            bases::scale_translation(&rail, &profile, &io::numbers("factors", factors, "nb_rail", nb_rail)?)?
        };
        tell_grid(&grid, points, capacity, count, [rows, columns, wraps])
    }))
}

/// Which center of inversion an M-revolution surface takes: a point of the circle of centers, see
/// `shapeop_canalCenters`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_canal_center {
    /// The middle of the outer arc of the circle of centers.
    SO_CANAL_CENTER_MIDDLE = 0,
    /// The point at the angle `center_value`, in radians, on the circle of centers: 0 is the middle of the inner arc,
    /// pi that of the outer one.
    SO_CANAL_CENTER_ANGLE = 1,
    /// The point inside the given circle for which the parallel sides have the ratio `center_value`.
    SO_CANAL_CENTER_RATIO_INSIDE = 2,
    /// The point outside the given circle for which the parallel sides have the ratio `center_value`.
    SO_CANAL_CENTER_RATIO_OUTSIDE = 3,
    /// The point `center_point`.
    SO_CANAL_CENTER_POINT = 4,
    /// On the chord from the rail's start to its end; for M-moulding surfaces.
    SO_CANAL_CENTER_CHORD = 5,
}

/// # Safety
/// `point` is null or readable for 3 doubles.
unsafe fn center_of(kind: c_int, value: f64, point: *const f64) -> Result<Center> {
    Ok(match kind {
        0 => Center::Middle,
        1 => Center::Angle(crate::error::finite("center_value", value)?),
        2 | 3 => Center::Ratio { ratio: crate::error::finite("center_value", value)?, is_inside: kind == 2 },
        // SAFETY: the caller vouches for 3 doubles.
        4 => Center::At(unsafe { io::vector("center_point", point)? }),
        _ => {
            let reason = format!("expected a shapeop_canal_center that is fit here, 0 to 4; found {kind}");
            return Err(Error::new(Status::InvalidValue, reason).at("center_kind"));
        }
    })
}

/// # Safety
/// `data` is null or readable for 12 doubles.
unsafe fn corners(data: *const f64) -> Result<Corners> {
    // SAFETY: the caller vouches for 12 doubles.
    let points = unsafe { io::points("corners", data, "corners", 4)? };
    Corners::new([points[0], points[1], points[2], points[3]])
}

/// Tells the centers of inversion that map four points of a circle, in order round it, to the corners of an isosceles
/// trapezoid with the parallel sides `P1 P2` and `P4 P3`. Each output may be null: the circle through them; the circle
/// of centers, 7 doubles as all circles, or if `is_line` is 1 the line: a point, a unit vector, and 0; and the two ends
/// of the open interval of ratios of the parallel sides for which there are solutions.
///
/// # Safety
/// `corners` is null or readable for 12 doubles; `circle` and `centers` are null or writable for 7, `is_line` for one
/// int, `ratio_limits` for 2 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCenters(
    corners: *const f64,
    circle: *mut f64,
    centers: *mut f64,
    is_line: *mut c_int,
    ratio_limits: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let corners = self::corners(corners)?;
            let (values, line) = match corners.circle_of_centers() {
                GeneralCircle::Circle(circle) => (io::circle_numbers(&[circle]), 0),
                GeneralCircle::Line(point, direction) => {
                    ([&point.to_array()[..], &direction.to_array(), &[0.0]].concat(), 1)
                }
            };
            outputs.may("circle", circle, io::circle_numbers(&[corners.circle()]))?;
            outputs.may("centers", centers, values)?;
            outputs.may("is_line", is_line, vec![line])?;
            outputs.may("ratio_limits", ratio_limits, corners.ratio_limits().to_vec())?;
        }
        outputs.write()
    }))
}

/// Writes a center of inversion, its angle on the circle of centers and the ratio of the parallel sides that it leads
/// to. Each output may be null. `center_kind` is a `shapeop_canal_center` but `SO_CANAL_CENTER_CHORD`; `center_value`
/// and `center_point` belong to it. `is_infinite` is 1 where the center is at infinity, as no inversion is needed;
/// `center` then is zero.
///
/// # Safety
/// `corners` is null or readable for 12 doubles, `center_point` for 3; `center` is null or writable for 3, the others
/// for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalCenter(
    corners: *const f64,
    center_kind: c_int,
    center_value: f64,
    center_point: *const f64,
    center: *mut f64,
    is_infinite: *mut c_int,
    omega: *mut f64,
    ratio: *mut f64,
) -> shapeop_err {
    code(guard_free(|| {
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the arrays.
        unsafe {
            let corners = self::corners(corners)?;
            let angle = corners.angle(center_of(center_kind, center_value, center_point)?)?;
            let found = corners.center_at(angle);
            outputs.may("center", center, found.unwrap_or_default().to_array().to_vec())?;
            outputs.may("is_infinite", is_infinite, vec![c_int::from(found.is_none())])?;
            outputs.may("omega", omega, vec![angle])?;
            outputs.may("ratio", ratio, vec![corners.ratio_at(angle)])?;
        }
        outputs.write()
    }))
}

/// The surface of a base and inversions.
fn inverted(image: &InvertedBase, kind: BaseKind) -> Result<SuperCanal> {
    let mut surface = SuperCanal::new(Net::new(image.base.grid.clone(), image.base.frame)?, kind);
    for &inversion in &image.inversions {
        surface.push(Transform::Inversion(inversion))?;
    }
    Ok(surface)
}

/// # Safety
/// `omega` is null or writable for one double, `axis` for 6.
unsafe fn told_m_revolution(made: &MRevolution, omega: *mut f64, axis: *mut f64) -> Result<(SuperCanal, Outputs)> {
    let mut outputs = Outputs::default();
    // SAFETY: the caller vouches for the outputs.
    unsafe {
        outputs.may("omega", omega, vec![made.omega])?;
        outputs.may("axis", axis, io::coordinates(&made.axis))?;
    }
    Ok((inverted(&made.image, BaseKind::Revolution)?, outputs))
}

/// Creates the M-revolution surface over a planar curve, of `columns` points along each arch. The curve runs from the
/// corner `P1` to `P4`; `p2` and `p3` are on one circle with its ends, and `up` is a direction off the plane, to whose
/// side the arches rise. The center is chosen as in `shapeop_canalCenter`. `omega`, its angle, and `axis`, a point and
/// a unit vector of the axis of revolution of the base, may be null. Null if it is refused.
///
/// # Safety
/// `curve` is null or readable for `3 * nb_curve` doubles, `p2`, `p3`, `center_point` and `up` for 3; `omega` is null
/// or writable for one, `axis` for 6.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalMRevolution(
    curve: *const f64,
    nb_curve: c_int,
    p2: *const f64,
    p3: *const f64,
    center_kind: c_int,
    center_value: f64,
    center_point: *const f64,
    up: *const f64,
    columns: c_int,
    omega: *mut f64,
    axis: *mut f64,
) -> *mut ShapeOpCanal {
    // SAFETY: the caller vouches for the arrays.
    created_with(|| unsafe {
        let curve = io::points("curve", curve, "nb_curve", nb_curve)?;
        let (p2, p3, up) = (io::vector("p2", p2)?, io::vector("p3", p3)?, io::vector("up", up)?);
        let center = center_of(center_kind, center_value, center_point)?;
        let columns = io::size("columns", columns, curve.len())?;
        told_m_revolution(&m_revolution(&curve, p2, p3, center, up, columns)?, omega, axis)
    })
}

/// As `shapeop_canalMRevolution`, over a curve on a sphere. `pole` is a point of the sphere off the curve, at which it
/// is flattened; null: one that is far from all points. Arches rise outside of the sphere if `is_outside` is 1, inside
/// if it is 0.
///
/// # Safety
/// As `shapeop_canalMRevolution`; `sphere_center` and `pole` are null or readable for 3 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalSphericalMRevolution(
    curve: *const f64,
    nb_curve: c_int,
    p2: *const f64,
    p3: *const f64,
    sphere_center: *const f64,
    radius: f64,
    pole: *const f64,
    is_outside: c_int,
    center_kind: c_int,
    center_value: f64,
    center_point: *const f64,
    columns: c_int,
    omega: *mut f64,
    axis: *mut f64,
) -> *mut ShapeOpCanal {
    // SAFETY: the caller vouches for the arrays.
    created_with(|| unsafe {
        let curve = io::points("curve", curve, "nb_curve", nb_curve)?;
        let (p2, p3) = (io::vector("p2", p2)?, io::vector("p3", p3)?);
        let sphere = Sphere { center: io::vector("sphere_center", sphere_center)?, radius };
        let pole = io::optional_vector("pole", pole)?;
        let guide = GuideSphere { sphere, pole, is_outside: io::truth("is_outside", is_outside)? };
        let center = center_of(center_kind, center_value, center_point)?;
        let columns = io::size("columns", columns, curve.len())?;
        told_m_revolution(&spherical_m_revolution(&curve, p2, p3, &guide, center, columns)?, omega, axis)
    })
}

/// Creates the M-moulding surface through a planar curve, from `P1` to `P4`, and a rail in space, from `P1`. Column 0
/// is the curve, row 0 the rail. The center of inversion is the point `center_point` of the curve's plane if `p3` is
/// null; else it is chosen as in `shapeop_canalCenter`, or by `SO_CANAL_CENTER_CHORD`, for the far corner `p3`, which
/// is on one circle with `P1`, `P4` and the rail's end. Each output may be null: `obliquity`, `reversed_count` and
/// `closing_gap` as in `shapeop_canalMoulding`, and the distance of the surface's last corner from `p3` (0 without
/// one). Null if it is refused.
///
/// # Safety
/// `curve` and `rail` are null or readable for 3 times their number of points, `p3` and `center_point` for 3 doubles;
/// each output is null or writable for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_canalMMoulding(
    curve: *const f64,
    nb_curve: c_int,
    rail: *const f64,
    nb_rail: c_int,
    p3: *const f64,
    center_kind: c_int,
    center_value: f64,
    center_point: *const f64,
    obliquity: *mut f64,
    reversed_count: *mut c_int,
    closing_gap: *mut f64,
    corner_gap: *mut f64,
) -> *mut ShapeOpCanal {
    // SAFETY: the caller vouches for the arrays.
    created_with(|| unsafe {
        let curve = io::points("curve", curve, "nb_curve", nb_curve)?;
        let rail = io::points("rail", rail, "nb_rail", nb_rail)?;
        io::size("nb_rail", nb_rail, curve.len())?;
        let choice = match io::optional_vector("p3", p3)? {
            None => MouldingCenter::At(io::vector("center_point", center_point)?),
            Some(p3) if center_kind == shapeop_canal_center::SO_CANAL_CENTER_CHORD as c_int => {
                MouldingCenter::Chord { p3 }
            }
            Some(p3) => MouldingCenter::Corner { p3, center: center_of(center_kind, center_value, center_point)? },
        };
        let made = m_moulding(&curve, &rail, choice)?;
        let mut outputs = Outputs::default();
        outputs.may("obliquity", obliquity, vec![made.obliquity_rad])?;
        outputs.may("reversed_count", reversed_count, vec![c_count(made.reversed_count)?])?;
        outputs.may("closing_gap", closing_gap, vec![made.closing_gap])?;
        outputs.may("corner_gap", corner_gap, vec![made.corner_gap.unwrap_or(0.0)])?;
        let kind = if made.is_moulding { BaseKind::Moulding } else { BaseKind::Circular };
        Ok((inverted(&made.image, kind)?, outputs))
    })
}
