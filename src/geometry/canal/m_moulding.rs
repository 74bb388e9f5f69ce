//! M-moulding surfaces: inversions of moulding and Monge surfaces through two given curves (Mesnil et al. 2018, section 5.1 and
//! figure 23).
//!
//! Given are a planar curve from `P1` to `P4` and a second curve, the rail, that leaves its plane orthogonally at `P1`. An inversion
//! at a point of the plane keeps the plane; the images of both curves are a planar profile and a rail orthogonal to it, and
//! give a Monge surface (see [`monge`](super::bases::monge)). Inverted back it runs through both curves, exactly. With
//! an arc of a circle as rail this is an M-revolution surface; the rail replaces its arches. The paper does not say how the
//! center is chosen. We offer three ways:
//!
//! - any point of the plane off both curves;
//! - as for an M-revolution surface: the rail ends in `P2`, and with a point `P3` on the circle through `P1`, `P2` and `P4` the center
//!   is on the circle of centers of the four. `P2' P1'` and `P3' P4'` are then parallel sides of an isosceles trapezoid, and a rail
//!   that turns by half a revolution takes the profile to its other side: the last row ends in `P3`;
//! - of these, one on the line `P1 P2`. A rail in the plane through this line that is orthogonal to the curve's stays in it, and the
//!   base is a moulding surface: both of its families of curves are planar.

use glam::DVec3;

use super::bases::{InvertedBase, sweep};
use super::inversion::Inversion;
use super::m_revolution::{image, keeping_circle, named};
use super::polyline::{COINCIDE, direction_of_straight, plane_normal, polyline, start_tangent};
use super::revolution_centers::{Center, Corners};
use crate::error::{Error, Result, Status};
use crate::mesh::fit::Plane;
use crate::mesh::grid::{check_finite, diagonal};

/// Of the two centers on the line `P1 P2` the outer one is taken if it is at most this many radii away: farther off, the inversion
/// loses digits.
const FAR_CENTER: f64 = 1e3;

/// Where the inversion of an M-moulding surface has its center.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MouldingCenter {
    /// At this point of the planar curve's plane.
    At(DVec3),
    /// As for an M-revolution surface through the far corner `p3`.
    Corner {
        /// On the circle through the first point of both curves and their last points.
        p3: DVec3,
        /// Which point of the circle of centers.
        center: Center,
    },
    /// As for an M-revolution surface through the far corner, on the line from the rail's start to its end: outside of the circle
    /// or, where that is beyond 1e3 of its radii but not at infinity, inside.
    Chord {
        /// On the circle through the first point of both curves and their last points.
        p3: DVec3,
    },
}

/// An inversion of a moulding or Monge surface.
#[derive(Clone, Debug, PartialEq)]
pub struct MMoulding {
    /// The base and what maps it to the result. Column 0 is the planar curve, row 0 the rail: the layout of an M-revolution
    /// surface, whose rows run along circles.
    pub image: InvertedBase,
    /// Whether the base is a moulding surface: its rail is in a plane orthogonal to the profile's.
    pub is_moulding: bool,
    /// The angle between the rail's tangent at its start and the normal of the planar curve's plane; see
    /// [`Swept`](super::bases::Swept).
    pub obliquity_rad: f64,
    /// The number of edges of rows that point the other way than the rail's own, in the base; quads there cross themselves.
    pub reversed_count: usize,
    /// For a closed rail, how far the profile is from itself after one turn, in the base.
    pub closing_gap: f64,
    /// The distance of the surface's last corner from `P3`, where one was given.
    pub corner_gap: Option<f64>,
}

/// The M-moulding surface through a planar curve, from `P1` to `P4`, and a rail in space, from `P1`.
///
/// # Errors
/// As [`Corners::new`] and [`Corners::angle`] for `P1`, the rail's end, `P3` and `P4`; too few points, coordinates that are not finite,
/// a rail that does not start on the curve, a center off the plane. Status `NotPlanar`: the curve is not planar, or the corners
/// are off its plane; `Degenerate`: consecutive points coincide, a curve runs through the center, the rail's first edge is in the
/// curve's plane, or a quad of the base has a side without length. The place is `curve[i]`, `rail[i]`, `corners[i]` or
/// `center`.
pub fn m_moulding(curve: &[DVec3], rail: &[DVec3], center: MouldingCenter) -> Result<MMoulding> {
    polyline("curve", curve)?;
    polyline("rail", rail)?;
    let normal = match direction_of_straight(curve) {
        None => plane_normal("curve", curve)?,
        Some(direction) => start_tangent(rail).reject_from_normalized(direction).normalize_or_zero(),
    };
    let extent = diagonal(curve).max(diagonal(rail));
    if rail[0].distance(curve[0]) > COINCIDE * extent {
        let reason = format!("expected the curve's first point, found one {:e} from it", rail[0].distance(curve[0]));
        return Err(Error::new(Status::InvalidValue, reason).at("rail[0]"));
    }
    let height = |point: DVec3| (point - curve[0]).dot(normal);
    let corners = |p3: DVec3| {
        let corners = Corners::new([curve[0], rail[rail.len() - 1], p3, curve[curve.len() - 1]])?;
        match (0..4).find(|&i| height(corners.points()[i]).abs() > COINCIDE * extent) {
            None => Ok(corners),
            Some(i) => {
                let reason = "expected the four corners in the planar curve's plane, found one off it";
                Err(Error::new(Status::NotPlanar, reason).at(format!("corners[{i}]")))
            }
        }
    };
    let (inversion, corner) = match center {
        MouldingCenter::At(center) => {
            check_finite("center", &[center]).map_err(|error| error.with_place("center"))?;
            if height(center).abs() > COINCIDE * extent.max(center.distance(curve[0])) {
                let reason = format!("expected a point of the curve's plane, found one {:e} off it", height(center));
                return Err(Error::new(Status::InvalidValue, reason).at("center"));
            }
            // P1 is its own image.
            let squared = center.distance_squared(curve[0]);
            if !(squared > (COINCIDE * extent).powi(2)) {
                let reason = "it is at the center of inversion";
                return Err(Error::new(Status::Degenerate, reason).at("curve[0]"));
            }
            (Some(Inversion::new(center - height(center) * normal, squared)?), None)
        }
        MouldingCenter::Corner { p3, center } => {
            let corners = corners(p3)?;
            let center = corners.center_at(corners.angle(center)?);
            (center.map(|center| keeping_circle(center, &corners)).transpose()?, Some(p3))
        }
        MouldingCenter::Chord { p3 } => {
            let corners = corners(p3)?;
            let circle = corners.circle();
            let (inside, outside) = corners.chord_centers();
            let is_far = |center: &DVec3| center.distance(circle.center) > FAR_CENTER * circle.radius;
            let center = if outside.as_ref().is_some_and(is_far) { Some(inside) } else { outside };
            (center.map(|center| keeping_circle(center, &corners)).transpose()?, Some(p3))
        }
    };
    let inverted = |name: &str, points: &[DVec3]| match &inversion {
        None => Ok(points.to_vec()),
        Some(inversion) => inversion.points(points).map_err(|error| named(name, error)),
    };
    let (profile, swept_rail) = (inverted("curve", curve)?, inverted("rail", rail)?);
    let swept = sweep(&swept_rail, &profile, normal)
        .map_err(|error| if error.place().starts_with("profile") { named("curve", error) } else { error })?;
    let is_moulding = is_upright(&swept_rail, normal);
    let image = image(swept.base.transposed()?, inversion);
    let result = image.grid()?;
    let last = result.at(result.rows() - 1, result.columns() - 1);
    Ok(MMoulding {
        image,
        is_moulding,
        obliquity_rad: swept.obliquity_rad,
        reversed_count: swept.reversed_count,
        closing_gap: swept.closing_gap,
        corner_gap: corner.map(|p3| p3.distance(last)),
    })
}

/// Whether a rail is in a plane that is orthogonal to the profile's, of the given normal.
fn is_upright(rail: &[DVec3], normal: DVec3) -> bool {
    if direction_of_straight(rail).is_some() {
        return true;
    }
    let (plane, extent) = (Plane::fitting(rail), diagonal(rail));
    rail.iter().all(|&point| plane.height(point).abs() <= COINCIDE * extent)
        && plane.normal.dot(normal).abs() <= COINCIDE
}
