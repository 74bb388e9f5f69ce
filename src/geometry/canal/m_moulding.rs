//! M-moulding surfaces: inversions of moulding and Monge surfaces through two given curves (Mesnil et al. 2018, section 5.1 and
//! figure 23).
//!
//! Given are a planar curve from `P1` to `P4` and a second curve, the rail, that leaves its plane orthogonally at `P1`. An
//! inversion at a point of the plane keeps the plane; the images of both curves are a planar profile and a rail orthogonal to
//! it, and give a Monge surface (see [`monge`](super::bases::monge)). Inverted back it runs through both curves, exactly. With
//! an arc of a circle as rail this is an M-revolution surface; the rail replaces its arches. The paper does not say how the
//! center is chosen. We offer three ways:
//!
//! - any point of the plane off both curves;
//! - as for an M-revolution surface: the rail ends in `P2`, and with a point `P3` on the circle through `P1`, `P2` and `P4` the
//!   center is on the circle of centers of the four. `P2' P1'` and `P3' P4'` are then parallel sides of an isosceles trapezoid,
//!   and a rail that turns by half a revolution takes the profile to its other side: the last row ends in `P3`;
//! - of these, one on the line `P1 P2`. A rail in the plane through this line that is orthogonal to the curve's stays in it,
//!   and the base is a moulding surface: both of its families of curves are planar.

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
/// As [`Corners::new`] and [`Corners::angle`] for `P1`, the rail's end, `P3` and `P4`; too few points, coordinates
/// that are not finite, a rail that does not start on the curve, a center off the plane. Status `NotPlanar`: the curve is not
/// planar, or the corners are off its plane; `Degenerate`: consecutive points coincide, a curve runs through the center, the
/// rail's first edge is in the curve's plane, or a quad of the base has a side without length. The place is `curve[i]`,
/// `rail[i]`, `corners[i]` or `center`.
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

#[cfg(test)]
mod tests {
    use super::super::base::off_circle;
    use super::super::frame::frames;
    use super::super::m_revolution::m_revolution;
    use super::super::m_revolution::tests::{placed, sample};
    use super::*;
    use crate::geometry::random::Random;

    /// A rail in the upright plane through the ends of a chord: a half ellipse of the given height, which leaves the ground
    /// orthogonally at both, leaning by `skew`, in space if `bend` is not 0.
    fn arch(from: DVec3, to: DVec3, height: f64, skew: f64, bend: f64, count: i32) -> Vec<DVec3> {
        let (middle, half) = (0.5 * (from + to), 0.5 * (from - to));
        let side = half.cross(DVec3::Z);
        let at = |i: i32| std::f64::consts::PI * f64::from(i) / f64::from(count);
        let point = |i: i32| {
            let (sine, cosine) = at(i).sin_cos();
            let lean = skew * sine * sine;
            match i {
                0 => from,
                i if i == count => to,
                _ => middle + (cosine + lean) * half + height * sine * DVec3::Z + bend * sine * sine * side,
            }
        };
        (0..=count).map(point).collect()
    }

    fn check(surface: &MMoulding, curve: &[DVec3], rail: &[DVec3]) {
        let grid = surface.image.grid().unwrap();
        assert!(off_circle(&grid) < 1e-10, "{}", off_circle(&grid));
        assert!(off_circle(&surface.image.base.grid) < 1e-10);
        frames(&grid, surface.image.frame()).unwrap();
        frames(&surface.image.base.grid, surface.image.base.frame).unwrap();
        let distance = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert_eq!((grid.rows(), grid.columns()), (curve.len(), rail.len()));
        assert!(distance(&grid.column(0), curve) < 1e-12);
        assert!(distance(grid.row(0), rail) < 1e-12);
    }

    #[test]
    fn with_an_arch_of_a_circle_it_is_the_surface_of_revolution() {
        let (curve, p2, p3) = sample(11);
        let mut random = Random(41);
        for center in [Center::Middle, Center::Angle(0.4), Center::Angle(-2.0)] {
            let place = placed(&mut random);
            let curve: Vec<DVec3> = curve.iter().map(|&point| place(point)).collect();
            let (p2, p3, up) = (place(p2), place(p3), place(DVec3::Z) - place(DVec3::ZERO));
            let revolved = m_revolution(&curve, p2, p3, center, up, 8).unwrap();
            let expected = revolved.image.grid().unwrap();
            let surface = m_moulding(&curve, expected.row(0), MouldingCenter::Corner { p3, center }).unwrap();
            check(&surface, &curve, expected.row(0));
            let grid = surface.image.grid().unwrap();
            for (a, b) in grid.points().iter().zip(expected.points()) {
                assert!(a.distance(*b) < 1e-10, "{}", a.distance(*b));
            }
            assert!(surface.image.frame().distance(&revolved.image.frame()) < 1e-9);
            assert!(surface.is_moulding && surface.corner_gap.unwrap() < 1e-10 && surface.obliquity_rad < 1e-6);
        }
    }

    #[test]
    fn a_rail_over_the_chord_gives_a_moulding_surface_that_ends_in_the_far_corner() {
        let (curve, p2, p3) = sample(11);
        let build = |count: i32| {
            let rail = arch(curve[0], p2, 0.7, 0.3, 0.0, count);
            let surface = m_moulding(&curve, &rail, MouldingCenter::Chord { p3 }).unwrap();
            check(&surface, &curve, &rail);
            assert!(surface.is_moulding && surface.reversed_count == 0);
            // Both families of the base are planar: rows parallel to the rail's plane, columns upright to it.
            let base = &surface.image.base.grid;
            let normal = plane_normal("row", base.row(0)).unwrap();
            for i in 0..base.rows() {
                let heights = base.row(i).iter().map(|&point| (point - base.at(i, 0)).dot(normal).abs());
                assert!(heights.fold(0.0, f64::max) < 1e-11);
            }
            for j in 0..base.columns() {
                let column_normal = plane_normal("column", &base.column(j)).unwrap();
                assert!(column_normal.dot(normal).abs() < 1e-11);
            }
            surface.corner_gap.unwrap()
        };
        // The curve's tangent turns by half a revolution, the polyline's only in the limit: second order.
        let gaps = [10, 20, 40].map(build);
        assert!(gaps[0] < 0.2 && gaps[1] < 0.4 * gaps[0] && gaps[2] < 0.4 * gaps[1], "{gaps:?}");
    }

    #[test]
    fn a_rail_in_space_and_any_center_give_a_monge_surface() {
        let (curve, p2, p3) = sample(11);
        let rail = arch(curve[0], p2, 0.7, 0.3, 0.4, 16);
        for center in [
            MouldingCenter::At(DVec3::new(0.1, -2.0, 0.0)),
            MouldingCenter::At(DVec3::new(-0.2, -0.4, 0.0)),
            MouldingCenter::Corner { p3, center: Center::Angle(-0.6) },
            MouldingCenter::Chord { p3 },
        ] {
            let surface = m_moulding(&curve, &rail, center).unwrap();
            check(&surface, &curve, &rail);
            assert!(!surface.is_moulding);
            assert_eq!(surface.corner_gap.is_none(), matches!(center, MouldingCenter::At(_)));
        }
        // Unlike an M-revolution surface, this one depends on the center.
        let far = |y: f64| {
            let surface = m_moulding(&curve, &rail, MouldingCenter::At(DVec3::new(0.1, y, 0.0))).unwrap();
            surface.image.grid().unwrap().at(10, 8)
        };
        assert!(far(-2.0).distance(far(-3.0)) > 1e-3);
    }

    #[test]
    fn an_isosceles_trapezoid_takes_the_curves_as_they_are() {
        let curve: Vec<DVec3> =
            [(-2.0, 0.0), (-3.0, 0.5), (-2.5, 1.2), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let (p2, p3) = (2.0 * DVec3::X, DVec3::new(1.0, 1.0, 0.0));
        let rail = arch(curve[0], p2, 1.5, 0.0, 0.0, 13);
        let surface = m_moulding(&curve, &rail, MouldingCenter::Chord { p3 }).unwrap();
        assert!(surface.image.inversions.is_empty() && surface.is_moulding);
        // A symmetric rail of an odd number of edges: the middle mirror is the trapezoid's, the others cancel in pairs.
        assert!(surface.corner_gap.unwrap() < 1e-12);
        let expected = super::super::bases::moulding(&rail, &curve).unwrap().base.transposed().unwrap();
        assert!(surface.image.base == expected);
    }

    #[test]
    fn curves_that_do_not_fit_are_refused_by_name() {
        let (curve, p2, p3) = sample(11);
        let rail = arch(curve[0], p2, 0.7, 0.3, 0.0, 8);
        let refusal = |curve: &[DVec3], rail: &[DVec3], center| {
            let error = m_moulding(curve, rail, center).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        let named = |status, place: &str| (status, place.to_owned());
        let chord = MouldingCenter::Chord { p3 };
        let mut bent = curve.clone();
        bent[5].z = 1e-3;
        assert_eq!(refusal(&bent, &rail, chord).0, Status::NotPlanar);
        let away: Vec<DVec3> = rail.iter().map(|&point| point + 0.1 * DVec3::X).collect();
        assert_eq!(refusal(&curve, &away, chord), named(Status::InvalidValue, "rail[0]"));
        assert_eq!(refusal(&curve, &rail[..5], chord).0, Status::NotCircular);
        assert_eq!(refusal(&curve, &rail[..1], chord), named(Status::InvalidArgumentLength, "rail"));
        let at = MouldingCenter::At;
        assert_eq!(refusal(&curve, &rail, at(DVec3::Z)), named(Status::InvalidValue, "center"));
        assert_eq!(refusal(&curve, &rail, at(DVec3::NAN)), named(Status::InvalidValue, "center"));
        assert_eq!(refusal(&curve, &rail, at(curve[4])), named(Status::Degenerate, "curve[4]"));
        assert_eq!(refusal(&curve, &rail, at(curve[0])), named(Status::Degenerate, "curve[0]"));
        assert_eq!(refusal(&curve, &rail, at(rail[8])), named(Status::Degenerate, "rail[8]"));
        let flat = [curve[0], curve[0] + DVec3::Y, p2];
        assert_eq!(refusal(&curve, &flat, chord), named(Status::Degenerate, "rail[1]"));
        // A whole circle upright to the curve's plane: its end P2 is P1 again.
        let ring: Vec<DVec3> = crate::mesh::fit::regular_polygon(9)
            .iter()
            .map(|&point| curve[0] + DVec3::new(point.x - 1.0, 0.0, point.y))
            .chain([curve[0]])
            .collect();
        assert_eq!(refusal(&curve, &ring, chord).0, Status::Degenerate);
    }
}
