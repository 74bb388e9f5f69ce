//! M-revolution surfaces: inversions of surfaces of revolution, from a planar curve and two points (Mesnil et al. 2018, section
//! 5.1, figures 19 and 20).
//!
//! Given are a planar curve from `P1` to `P4` and points `P2`, `P3` of its plane on one circle with its ends. An inversion at a
//! point of the circle of centers (see [`Corners`]) maps the curve to a meridian and the four points to an isosceles trapezoid.
//! Half a revolution about the trapezoid's axis takes the meridian to the other side, from `P2'` to `P3'`. Inverted back, the
//! parallels are arcs of circles orthogonal to the plane that join every point of the curve to its mirror image in the circle of
//! centers: a roof over the region between the two curves, planar quads and planar vertical arches.
//!
//! *The surface does not depend on which center is taken.* All of them are on the circle of centers; the revolution, seen before
//! the inversion, is the Möbius rotation about that circle, which is one and the same. What the center changes is the base,
//! and so what further transformations make of it.

use glam::DVec3;

use super::bases::{Base, InvertedBase, revolution};
use super::inversion::Inversion;
use super::polyline::{COINCIDE, polyline};
use super::revolution_centers::{Center, Corners};
use crate::error::{Error, Result, Status};
use crate::mesh::grid::{check_finite, diagonal};

/// An inversion of a surface of revolution.
#[derive(Clone, Debug, PartialEq)]
pub struct MRevolution {
    /// The surface of revolution, and what maps it to the result. Row `i` runs along the parallel of curve point `i`, from the
    /// curve (column 0) to its mirror image, in equal angles.
    pub image: InvertedBase,
    /// The four points and the circle of centers; in the flattened plane for a spherical curve.
    pub corners: Corners,
    /// The angle `ω` of the center that was taken: [`Corners::center_at`], [`Corners::ratio_at`].
    pub omega: f64,
    /// A point of the axis of revolution and a unit vector along it, for the base.
    pub axis: [DVec3; 2],
}

/// The M-revolution surface over a planar curve, of `columns` points along each arch. `curve` runs from `P1` to `P4` in any plane
/// of space; `up` is a direction off that plane, to whose side the arches rise.
///
/// The ratio of the inversion is the power of its center with respect to the circle through the four points: the circle is
/// its own image, and the base about as large as the result.
///
/// # Errors
/// As [`Corners::new`] for `P1` to `P4` (`corners[i]`) and [`Corners::angle`] for the center; too few points or columns; `up` in the
/// plane. Status `NotPlanar`: a point of the curve is off the plane of the circle; `Degenerate`: consecutive points coincide, the
/// curve meets or crosses the circle of centers, whose image is the axis, or runs through the center of inversion. The place
/// is `curve[i]`.
pub fn m_revolution(
    curve: &[DVec3],
    p2: DVec3,
    p3: DVec3,
    center: Center,
    up: DVec3,
    columns: usize,
) -> Result<MRevolution> {
    polyline("curve", curve)?;
    let corners = Corners::new([curve[0], p2, p3, curve[curve.len() - 1]])?;
    let curve = on_plane("curve", curve, &corners)?;
    let side = side_of(up, &corners)?;
    let omega = corners.angle(center)?;
    let center = corners.center_at(omega);
    check_beside_axis(&curve, &corners, center)?;
    let inversion = center.map(|center| keeping_circle(center, &corners)).transpose()?;
    let meridian = match &inversion {
        None => curve,
        Some(inversion) => inversion.points(&curve).map_err(|error| named("curve", error))?,
    };
    // The inversion mirrors heights where its ratio is below 0.
    let rise = side * inversion.as_ref().map_or(1.0, |inversion| inversion.ratio().signum());
    let axis = axis(&corners, inversion.as_ref(), rise);
    let base = revolution(&meridian, axis[0], axis[1], std::f64::consts::PI, columns)
        .map_err(|error| named("curve", error))?;
    Ok(MRevolution { image: image(base, inversion), corners, omega, axis })
}

pub(super) fn image(base: Base, inversion: Option<Inversion>) -> InvertedBase {
    InvertedBase { base, inversions: inversion.into_iter().collect() }
}

/// The inversion at `center` that maps the corners' circle to itself.
pub(super) fn keeping_circle(center: DVec3, corners: &Corners) -> Result<Inversion> {
    let circle = corners.circle();
    let distance = center.distance(circle.center);
    Inversion::new(center, (distance - circle.radius) * (distance + circle.radius))
}

/// The points moved into the corners' plane, by at most 1e-9 of their extent.
pub(super) fn on_plane(name: &str, points: &[DVec3], corners: &Corners) -> Result<Vec<DVec3>> {
    let circle = corners.circle();
    let extent = diagonal(points).max(circle.radius);
    let height = |point: DVec3| (point - circle.center).dot(circle.normal);
    match points.iter().position(|&point| height(point).abs() > COINCIDE * extent) {
        None => Ok(points.iter().map(|&point| point - height(point) * circle.normal).collect()),
        Some(i) => {
            let reason =
                format!("expected a point in the plane of the four corners, found one {:e} off it", height(points[i]));
            Err(Error::new(Status::NotPlanar, reason).at(format!("{name}[{i}]")))
        }
    }
}

/// 1 where `up` is on the side of the normal of the corners' plane, −1 on the other.
fn side_of(up: DVec3, corners: &Corners) -> Result<f64> {
    check_finite("up", &[up]).map_err(|error| error.with_place("up"))?;
    let sine = up.normalize_or_zero().dot(corners.circle().normal);
    if sine.abs() > COINCIDE {
        return Ok(sine.signum());
    }
    Err(Error::new(Status::InvalidValue, "expected a direction off the curve's plane, found one in it").at("up"))
}

/// Refuses a curve that is not all on the side of the circle of centers on which its ends are.
fn check_beside_axis(curve: &[DVec3], corners: &Corners, center: Option<DVec3>) -> Result<()> {
    let Some(i) = curve.iter().position(|&point| !(corners.side(point) > COINCIDE)) else { return Ok(()) };
    let extent = corners.circle().radius;
    let reason = if center.is_some_and(|center| curve[i].distance(center) <= COINCIDE * extent) {
        "it is at the center of inversion"
    } else if corners.side(curve[i]) >= -COINCIDE {
        "it is on the circle of centers, whose image is the axis of revolution"
    } else {
        "the curve crosses the circle of centers, whose image is the axis of revolution"
    };
    Err(Error::new(Status::Degenerate, reason).at(format!("curve[{i}]")))
}

/// A point of the axis and its direction, such that a rotation about it takes the curve's side first to where `rise` times the
/// normal points.
///
/// It is orthogonal to both parallel sides of the trapezoid and bisects them.
fn axis(corners: &Corners, inversion: Option<&Inversion>, rise: f64) -> [DVec3; 2] {
    let image = |point: DVec3| inversion.map_or(point, |inversion| inversion.point(point));
    let [p1, p2, p3, p4] = corners.points().map(image);
    let (first, second) = (p1 - p2, p4 - p3);
    let point = if first.length() > second.length() { 0.5 * (p1 + p2) } else { 0.5 * (p4 + p3) };
    let outward = (first + second).normalize_or_zero();
    [point, outward.cross(rise * corners.circle().normal)]
}

/// The error of a step whose argument is an argument of ours, point by point, under our argument's name.
pub(super) fn named(name: &str, error: Error) -> Error {
    let place = error.place().to_owned();
    match place.find('[') {
        Some(at) => error.with_place(format!("{name}{}", &place[at..])),
        None => error,
    }
}
