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
/// As [`Corners::new`] for `P1` to `P4` (`corners[i]`) and [`Corners::angle`] for the center; too few points or
/// columns; `up` in the plane. Status `NotPlanar`: a point of the curve is off the plane of the circle; `Degenerate`:
/// consecutive points coincide, the curve meets or crosses the circle of centers, whose image is the axis, or runs through the
/// center of inversion. The place is `curve[i]`.
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

#[cfg(test)]
pub(super) mod tests {
    use std::f64::consts::{PI, TAU};

    use glam::{DMat3, DVec2};

    use super::*;
    use crate::geometry::canal::base::off_circle;
    use crate::geometry::canal::frame::frames;
    use crate::geometry::canal::inversion::GeneralCircle;
    use crate::geometry::circle::Circle;
    use crate::geometry::random::Random;

    /// A curve in the xy-plane from the direction −20° to 200° on the unit circle, outside of it, and two points between.
    pub fn sample(count: i32) -> (Vec<DVec3>, DVec3, DVec3) {
        let at = |degrees: f64| DVec2::from_angle(degrees.to_radians());
        let curve = (0..count).map(|i| {
            let s = f64::from(i) / f64::from(count - 1);
            let bump = 1.0 + s * (1.0 - s) * (1.5 + 0.8 * (5.0 * s).sin());
            (bump * at(200.0 - 220.0 * s)).extend(0.0)
        });
        (curve.collect(), at(225.0).extend(0.0), at(300.0).extend(0.0))
    }

    /// Any rotation, and a shift.
    pub fn placed(random: &mut Random) -> impl Fn(DVec3) -> DVec3 + Copy + use<> {
        let x = random.vector().normalize();
        let y = random.vector().reject_from_normalized(x).normalize();
        let (turn, shift) = (DMat3::from_cols(x, y, x.cross(y)), random.vector());
        move |point| turn * point + shift
    }

    fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }

    #[test]
    fn the_surface_is_circular_and_has_upright_arches_between_the_given_points() {
        let (curve, p2, p3) = sample(23);
        for center in
            [Center::Middle, Center::Angle(0.4), Center::Angle(-2.5), Center::Ratio { ratio: 1.5, is_inside: true }]
        {
            let surface = m_revolution(&curve, p2, p3, center, DVec3::Z, 9).unwrap();
            let grid = surface.image.grid().unwrap();
            assert_eq!((grid.rows(), grid.columns(), grid.wraps()), (23, 9, [false; 2]));
            assert!(off_circle(&grid) < 1e-10, "{}", off_circle(&grid));
            assert!(off_circle(&surface.image.base.grid) < 1e-10);
            frames(&grid, surface.image.frame()).unwrap();
            frames(&surface.image.base.grid, surface.image.base.frame).unwrap();
            assert!(farthest(&grid.column(0), &curve) < 1e-12);
            assert!(grid.at(0, 8).distance(p2) < 1e-12 && grid.at(22, 8).distance(p3) < 1e-12);
            for i in 0..23 {
                // A circle in a vertical plane whose diameter joins the ends, above the ground.
                let (first, last) = (grid.at(i, 0), grid.at(i, 8));
                let circle = Circle::through(first, grid.at(i, 4), last).unwrap();
                assert!(circle.normal.z.abs() < 1e-10, "{}", circle.normal.z);
                assert!(circle.center.distance(0.5 * (first + last)) < 1e-10);
                for point in grid.row(i) {
                    assert!(circle.distance(*point) < 1e-10 && point.z > -1e-12);
                }
                assert!(grid.at(i, 4).z > 0.1);
            }
            // The tangent of the first arch is upright.
            assert!(surface.image.frame().t2.distance(DVec3::Z) < 1e-10);
        }
    }

    #[test]
    fn every_center_gives_the_same_surface() {
        let (curve, p2, p3) = sample(9);
        let mut random = Random(31);
        let reference = m_revolution(&curve, p2, p3, Center::Middle, DVec3::Z, 8).unwrap();
        let expected = reference.image.grid().unwrap();
        // And that surface is the Möbius rotation about the circle of centers: mirroring in it turns an arch round.
        let GeneralCircle::Circle(k) = reference.corners.circle_of_centers() else { panic!("a line") };
        let swap = Inversion::new(k.center, k.radius * k.radius).unwrap();
        for i in 0..9 {
            let mirrored = swap.points(expected.row(i)).unwrap();
            let turned: Vec<DVec3> = expected.row(i).iter().rev().copied().collect();
            assert!(farthest(&mirrored, &turned) < 1e-12);
        }
        for _ in 0..40 {
            let omega = random.between(-PI, PI);
            if (omega.abs() - 0.5 * PI).abs() < 0.1 {
                continue;
            }
            let surface = m_revolution(&curve, p2, p3, Center::Angle(omega), DVec3::Z, 8).unwrap();
            assert!(farthest(surface.image.grid().unwrap().points(), expected.points()) < 1e-10);
            // Their bases differ by more than a motion and a scale: here by the trapezoid's ratio.
            let base = &surface.image.base.grid;
            let ratio = base.at(0, 0).distance(base.at(0, 7)) / base.at(8, 0).distance(base.at(8, 7));
            assert!((ratio / surface.corners.ratio_at(surface.omega) - 1.0).abs() < 1e-9);
            // The base is one of revolution about the axis.
            let [point, direction] = surface.axis;
            for i in 0..9 {
                let radius = |j: usize| (base.at(i, j) - point).cross(direction).length();
                assert!((0..8).all(|j| (radius(j) / radius(0) - 1.0).abs() < 1e-9));
            }
        }
    }

    #[test]
    fn a_surface_of_revolution_inverted_is_found_again() {
        // Revolve a meridian about the y-axis, invert at a point of the axis, and take curve and corners from the image.
        let meridian: Vec<DVec3> = (0..12)
            .map(|i| f64::from(i) / 11.0)
            .map(|s| DVec3::new(1.0 + 0.8 * (4.0 * s).sin() * s, 2.0 * s, 0.0))
            .collect();
        let base = revolution(&meridian, DVec3::ZERO, DVec3::NEG_Y, PI, 7).unwrap();
        for (y, ratio) in [(3.5, 1.0), (-1.0, 2.0), (0.7, -1.3)] {
            let center = DVec3::new(0.0, y, 0.0);
            let inversion = Inversion::new(center, ratio).unwrap();
            let expected = inversion.points(base.grid.points()).unwrap();
            let at = |i: usize, j: usize| expected[7 * i + j];
            let curve: Vec<DVec3> = (0..12).map(|i| at(i, 0)).collect();
            let up = at(3, 3) - at(3, 0);
            let surface = m_revolution(&curve, at(0, 6), at(11, 6), Center::At(center), up, 7).unwrap();
            assert!(farthest(surface.image.grid().unwrap().points(), &expected) < 1e-10);
            assert_eq!(surface.image.inversions.len(), 1);
            assert!(surface.image.inversions[0].center().distance(center) < 1e-9);
            let ends = (meridian[0].x, meridian[11].x);
            let found = surface.corners.ratio_at(surface.omega);
            assert!((found - ends.0 / ends.1).abs() < 1e-9, "{found}");
            let other = surface.corners.angles_of_ratio(ends.0 / ends.1).unwrap();
            assert!(other.iter().any(|&omega| (omega - surface.omega).sin().abs() < 1e-8));
        }
    }

    #[test]
    fn an_isosceles_trapezoid_needs_no_inversion() {
        let curve: Vec<DVec3> =
            [(-2.0, 0.0), (-3.0, 0.5), (-2.5, 1.2), (-1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let (p2, p3) = (DVec3::X * 2.0, DVec3::new(1.0, 1.0, 0.0));
        let surface = m_revolution(&curve, p2, p3, Center::Middle, DVec3::NEG_Z, 5).unwrap();
        assert!(surface.image.inversions.is_empty() && surface.image.grid().unwrap() == surface.image.base.grid);
        let grid = surface.image.grid().unwrap();
        for (i, point) in curve.iter().enumerate() {
            assert!(grid.at(i, 2).distance(DVec3::new(0.0, point.y, point.x)) < 1e-14);
        }
        // A center on the line of symmetry gives the same.
        let other = m_revolution(&curve, p2, p3, Center::At(DVec3::new(0.0, -1.0, 0.0)), DVec3::NEG_Z, 5).unwrap();
        assert!(farthest(other.image.grid().unwrap().points(), grid.points()) < 1e-13);
        assert_eq!(other.image.inversions.len(), 1);
    }

    #[test]
    fn the_plane_may_be_any_and_scales_do_not_matter() {
        let mut random = Random(33);
        let (curve, p2, p3) = sample(9);
        let expected = m_revolution(&curve, p2, p3, Center::Angle(0.3), DVec3::Z, 6).unwrap().image.grid().unwrap();
        for scale in [1e-6, 1.0, 1e6] {
            let place = placed(&mut random);
            let map = |point: DVec3| scale * place(point);
            let moved: Vec<DVec3> = curve.iter().map(|&point| map(point)).collect();
            let up = map(DVec3::new(0.4, 0.3, 1.0)) - map(DVec3::ZERO);
            let surface = m_revolution(&moved, map(p2), map(p3), Center::Angle(0.3), up, 6).unwrap();
            let points: Vec<DVec3> = expected.points().iter().map(|&point| map(point)).collect();
            assert!(farthest(surface.image.grid().unwrap().points(), &points) < 1e-12 * scale);
        }
    }

    #[test]
    fn what_is_not_refused_is_finite() {
        let mut random = Random(35);
        let sizes = [1e-300, 1e-160, 1e-9, 1.0, 1.0, 1.0, 1e9, 1e160, 1e300];
        let (curve, p2, p3) = sample(5);
        let mut built = 0;
        for _ in 0..2000 {
            let (place, size) = (placed(&mut random), sizes[random.between(0.0, 9.0) as usize]);
            let noise = [0.0, 1e-12, 1e-3, 1.0][random.between(0.0, 4.0) as usize];
            let mut map = |point: DVec3| size * (place(point) + noise * random.vector());
            let curve: Vec<DVec3> = curve.iter().map(|&point| map(point)).collect();
            let (p2, p3, up) = (map(p2), map(p3), map(DVec3::Z));
            let center = [Center::Middle, Center::Angle(random.between(-9.0, 9.0)), Center::At(up)];
            let Ok(surface) = m_revolution(&curve, p2, p3, center[random.between(0.0, 3.0) as usize], up, 4) else {
                continue;
            };
            built += 1;
            assert!(surface.image.grid().unwrap().points().iter().all(|point| point.is_finite()));
            surface.image.frame().check("frame").unwrap();
            assert!(surface.corners.ratio_at(surface.omega).is_finite());
        }
        assert!(built > 100, "{built}");
    }

    #[test]
    fn what_cannot_be_built_is_refused_by_name() {
        let (curve, p2, p3) = sample(9);
        let refusal = |curve: &[DVec3], p2, p3, center, up, columns| {
            let error = m_revolution(curve, p2, p3, center, up, columns).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        let of_curve = |curve: &[DVec3]| refusal(curve, p2, p3, Center::Middle, DVec3::Z, 5);
        let replaced = |point: DVec3| {
            let mut bad = curve.clone();
            bad[4] = point;
            bad
        };
        let at = |status| (status, "curve[4]".to_owned());
        assert_eq!(of_curve(&replaced(curve[4] + 1e-3 * DVec3::Z)), at(Status::NotPlanar));
        assert_eq!(of_curve(&replaced(DVec3::NAN)), at(Status::InvalidValue));
        assert_eq!(of_curve(&replaced(curve[3])), at(Status::Degenerate));
        assert_eq!(of_curve(&curve[..1]), (Status::InvalidArgumentLength, "curve".to_owned()));
        // On the other side of the circle of centers; on it; at the center itself.
        let corners = Corners::new([curve[0], p2, p3, curve[8]]).unwrap();
        let GeneralCircle::Circle(k) = corners.circle_of_centers() else { panic!("a line") };
        assert_eq!(of_curve(&replaced(p2)), at(Status::Degenerate));
        assert_eq!(of_curve(&replaced(k.point_at(DVec3::X, 1.0))), at(Status::Degenerate));
        let center = corners.center_at(0.2).unwrap();
        let error = m_revolution(&replaced(center), p2, p3, Center::Angle(0.2), DVec3::Z, 5).unwrap_err();
        assert!(error.to_string().contains("at the center of inversion"), "{error}");
        // Unordered, not concyclic, a ratio without a solution, no arch, a flat up.
        assert_eq!(refusal(&curve, p3, p2, Center::Middle, DVec3::Z, 5), (Status::InvalidValue, "corners".to_owned()));
        assert_eq!(refusal(&curve, 1.1 * p2, p3, Center::Middle, DVec3::Z, 5).0, Status::NotCircular);
        let far = Center::Ratio { ratio: 1e4, is_inside: false };
        assert_eq!(refusal(&curve, p2, p3, far, DVec3::Z, 5), (Status::NoSolution, "ratio".to_owned()));
        let on_circle = Center::Angle(0.25 * TAU);
        assert_eq!(refusal(&curve, p2, p3, on_circle, DVec3::Z, 5), (Status::NoSolution, "center".to_owned()));
        assert_eq!(
            refusal(&curve, p2, p3, Center::Middle, DVec3::Z, 1),
            (Status::InvalidArgumentLength, "columns".to_owned())
        );
        assert_eq!(refusal(&curve, p2, p3, Center::Middle, DVec3::X, 5), (Status::InvalidValue, "up".to_owned()));
        assert_eq!(refusal(&curve, p2, p3, Center::Middle, DVec3::NAN, 5), (Status::InvalidValue, "up".to_owned()));
    }
}
