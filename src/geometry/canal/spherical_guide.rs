//! M-revolution surfaces over a curve on a sphere: two inversions in succession (Mesnil et al. 2018, end of section 5.1).
//!
//! An inversion at a point of the sphere, the pole, flattens the sphere to a plane. Curve and points become planar, the surface
//! is made there as in [`m_revolution`], and the same inversion takes it back: the arches are
//! arcs of circles orthogonal to the sphere. As for the center, the result does not depend on the pole; the base does.

use glam::DVec3;

use super::inversion::Inversion;
use super::m_revolution::{MRevolution, m_revolution};
use super::polyline::{COINCIDE, polyline};
use super::revolution_centers::Center;
use crate::error::{Error, Result, Status, finite};
use crate::geometry::circle::{Circle, Sphere};
use crate::mesh::grid::check_finite;

/// The pole opposite to the curve's middle is taken if the points are at least this many radii away from it.
const FAR_POLE: f64 = 0.3;

/// The sphere of a curve, and how it is flattened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideSphere {
    /// The curve and the other points are on it.
    pub sphere: Sphere,
    /// A point of the sphere off the curve and off the circle through the four points. If none is given: the point opposite to
    /// the mean of all points, or, where that is near them, the farthest of 26 directions.
    pub pole: Option<DVec3>,
    /// Whether arches rise outside of the sphere, or inside.
    pub is_outside: bool,
}

/// The M-revolution surface over a curve on a sphere, of `columns` points along each arch. `curve` runs from `P1` to `P4`; `p2` and
/// `p3` are on the sphere too, on one circle with its ends. A center that is given as a point is a point of the sphere. The result
/// has the inversion that flattens the sphere last; `corners` and `axis` are those in the plane and in the base.
///
/// # Errors
/// As [`m_revolution`]. `InvalidValue`: the sphere has no radius, or a point is not on it within 1e-9 radii; status `Degenerate`:
/// a point is at the pole, at `curve[i]`, `p2` or `p3`. The place is `curve[i]`, `p2`, `p3`, `pole`, `center` or `sphere`.
pub fn spherical_m_revolution(
    curve: &[DVec3],
    p2: DVec3,
    p3: DVec3,
    guide: &GuideSphere,
    center: Center,
    columns: usize,
) -> Result<MRevolution> {
    let GuideSphere { sphere, pole, is_outside } = *guide;
    let sphere = &sphere;
    polyline("curve", curve)?;
    check_finite("sphere", &[sphere.center]).map_err(|error| error.with_place("sphere"))?;
    if !(finite("sphere", sphere.radius)? > 0.0) {
        let reason = format!("expected a radius above 0, found {}", sphere.radius);
        return Err(Error::new(Status::InvalidValue, reason).at("sphere"));
    }
    for (i, &point) in curve.iter().enumerate() {
        check_on(sphere, &format!("curve[{i}]"), point)?;
    }
    check_on(sphere, "p2", p2)?;
    check_on(sphere, "p3", p3)?;
    let mut kept_off = curve.to_vec();
    kept_off.extend([p2, p3]);
    let circle = Circle::through(curve[0], p2, p3);
    let pole = match pole {
        Some(pole) => {
            check_on(sphere, "pole", pole)?;
            pole
        }
        None => default_pole(sphere, &kept_off, circle.as_ref()),
    };
    // Of this ratio, the plane touches the sphere opposite to the pole.
    let flatten = Inversion::new(pole, 4.0 * sphere.radius * sphere.radius)?;
    let at_pole = |name: String| {
        let reason = "expected a point apart from the pole, at which the sphere is inverted";
        Error::new(Status::Degenerate, reason).at(name)
    };
    let is_near = |point: DVec3| !(point.distance(pole) > COINCIDE * sphere.radius);
    if let Some(i) = kept_off.iter().position(|&point| is_near(point)) {
        let names = ["p2", "p3"].map(str::to_owned);
        let name = i.checked_sub(curve.len()).map_or(format!("curve[{i}]"), |i| names[i].clone());
        return Err(at_pole(name));
    }
    let center = match center {
        Center::At(point) => {
            check_on(sphere, "center", point)?;
            if is_near(point) {
                return Err(at_pole("center".to_owned()));
            }
            Center::At(flatten.point(point))
        }
        other => other,
    };
    let outward = if is_outside { curve[0] - sphere.center } else { sphere.center - curve[0] };
    let up = flatten.direction(curve[0], outward).normalize_or_zero();
    let flat: Vec<DVec3> = curve.iter().map(|&point| flatten.point(point)).collect();
    let mut surface = m_revolution(&flat, flatten.point(p2), flatten.point(p3), center, up, columns)?;
    surface.image.inversions.push(flatten);
    Ok(surface)
}

fn check_on(sphere: &Sphere, name: &str, point: DVec3) -> Result<()> {
    check_finite(name, &[point]).map_err(|error| error.with_place(name))?;
    let distance = sphere.distance(point);
    if distance.abs() <= COINCIDE * sphere.radius {
        return Ok(());
    }
    let reason = format!("expected a point of the sphere, found one {distance:e} off it");
    Err(Error::new(Status::InvalidValue, reason).at(name))
}

fn default_pole(sphere: &Sphere, kept_off: &[DVec3], circle: Option<&Circle>) -> DVec3 {
    let room = |pole: DVec3| {
        let nearest = kept_off.iter().map(|&point| point.distance(pole)).fold(f64::INFINITY, f64::min);
        circle.map_or(nearest, |circle| nearest.min(circle.distance(pole)))
    };
    let at = |direction: DVec3| sphere.center + sphere.radius * direction;
    let sum: DVec3 = kept_off.iter().map(|&point| point - sphere.center).sum();
    let opposite = sum.try_normalize().map(|direction| at(-direction));
    if let Some(pole) = opposite.filter(|&pole| room(pole) >= FAR_POLE * sphere.radius) {
        return pole;
    }
    let signs = [-1.0, 0.0, 1.0];
    let directions = signs.iter().flat_map(|&x| signs.iter().flat_map(move |&y| signs.map(|z| DVec3::new(x, y, z))));
    let candidates = directions.filter_map(DVec3::try_normalize).map(at).chain(opposite);
    candidates.fold(at(DVec3::X), |best, pole| if room(pole) > room(best) { pole } else { best })
}

#[cfg(test)]
mod tests {
    use super::super::base::off_circle;
    use super::super::frame::frames;
    use super::super::m_revolution::tests::sample;
    use super::*;

    /// The sample of the planar surface, put on a sphere by stereographic projection, at a third of its size so that it
    /// covers about a hemisphere.
    fn on_sphere() -> (Vec<DVec3>, DVec3, DVec3, Sphere) {
        let (curve, p2, p3) = sample(15);
        let sphere = Sphere { center: DVec3::new(1.0, -2.0, 0.5), radius: 1.7 };
        let pole = sphere.center + 1.7 * DVec3::new(0.6, 0.0, 0.8);
        let project = Inversion::new(pole, 4.0 * 1.7 * 1.7).unwrap();
        // The plane that touches the sphere opposite to the pole.
        let (x, y) = (DVec3::Y, DVec3::new(-0.8, 0.0, 0.6));
        let foot = 2.0 * sphere.center - pole;
        let map = |point: DVec3| project.point(foot + 0.6 * (point.x * x + point.y * y));
        (curve.iter().map(|&point| map(point)).collect(), map(p2), map(p3), sphere)
    }

    #[test]
    fn arches_are_orthogonal_to_the_sphere_and_neither_pole_nor_center_matters() {
        let (curve, p2, p3, sphere) = on_sphere();
        assert!(curve.iter().all(|&point| sphere.distance(point).abs() < 1e-14));
        for is_outside in [true, false] {
            let guide = GuideSphere { sphere, pole: None, is_outside };
            let surface = spherical_m_revolution(&curve, p2, p3, &guide, Center::Middle, 7).unwrap();
            assert_eq!(surface.image.inversions.len(), 2);
            let grid = surface.image.grid().unwrap();
            assert!(off_circle(&grid) < 1e-10, "{}", off_circle(&grid));
            frames(&grid, surface.image.frame()).unwrap();
            assert!(grid.at(0, 6).distance(p2) < 1e-12 && grid.at(14, 6).distance(p3) < 1e-12);
            for (i, &point) in curve.iter().enumerate() {
                assert!(grid.at(i, 0).distance(point) < 1e-12);
                assert!(sphere.distance(grid.at(i, 6)).abs() < 1e-12);
                let circle = Circle::through(point, grid.at(i, 3), grid.at(i, 6)).unwrap();
                assert!(grid.row(i).iter().all(|&point| circle.distance(point) < 1e-11));
                // Its tangent at the sphere is radial.
                let radial = (point - sphere.center).normalize();
                assert!(circle.tangent_at(point).cross(radial).length() < 1e-10);
                assert!((1..6).all(|j| (sphere.distance(grid.at(i, j)) > 1e-3) == is_outside));
            }
            let sign = if is_outside { 1.0 } else { -1.0 };
            let radial = sign * (curve[0] - sphere.center).normalize();
            assert!(surface.image.frame().t2.distance(radial) < 1e-10);
            // Other poles and centers: the same surface.
            let pole = sphere.center + sphere.radius * DVec3::new(0.6, 0.64, 0.48);
            for center in [Center::Middle, Center::Angle(0.7)] {
                let guide = GuideSphere { pole: Some(pole), ..guide };
                let other = spherical_m_revolution(&curve, p2, p3, &guide, center, 7).unwrap();
                let other = other.image.grid().unwrap();
                for (a, b) in grid.points().iter().zip(other.points()) {
                    assert!(a.distance(*b) < 1e-9, "{}", a.distance(*b));
                }
            }
            // A center given as the point of the sphere that it was.
            let flatten = surface.image.inversions[1];
            let center = flatten.point(surface.corners.center_at(0.7).unwrap());
            let again = spherical_m_revolution(&curve, p2, p3, &guide, Center::At(center), 7).unwrap();
            assert!((again.omega - 0.7).abs() < 1e-9);
        }
    }

    #[test]
    fn points_off_the_sphere_and_at_the_pole_are_refused() {
        let (curve, p2, p3, sphere) = on_sphere();
        let good = GuideSphere { sphere, pole: None, is_outside: true };
        let refusal = |curve: &[DVec3], p2, guide: &GuideSphere, center| {
            let error = spherical_m_revolution(curve, p2, p3, guide, center, 7).unwrap_err();
            (error.status(), error.place().to_owned())
        };
        let named = |status, place: &str| (status, place.to_owned());
        let mut bad = curve.clone();
        bad[3] *= 1.001;
        assert_eq!(refusal(&bad, p2, &good, Center::Middle), named(Status::InvalidValue, "curve[3]"));
        assert_eq!(refusal(&curve, 1.001 * p2, &good, Center::Middle), named(Status::InvalidValue, "p2"));
        let at = |pole| GuideSphere { pole: Some(pole), ..good };
        assert_eq!(refusal(&curve, p2, &at(curve[3]), Center::Middle), named(Status::Degenerate, "curve[3]"));
        assert_eq!(refusal(&curve, p2, &at(p3), Center::Middle), named(Status::Degenerate, "p3"));
        assert_eq!(refusal(&curve, p2, &at(DVec3::ZERO), Center::Middle), named(Status::InvalidValue, "pole"));
        assert_eq!(refusal(&curve, p2, &good, Center::At(DVec3::ZERO)), named(Status::InvalidValue, "center"));
        let empty = GuideSphere { sphere: Sphere { radius: 0.0, ..sphere }, ..good };
        assert_eq!(refusal(&curve, p2, &empty, Center::Middle), named(Status::InvalidValue, "sphere"));
        let lost = GuideSphere { sphere: Sphere { center: DVec3::NAN, ..sphere }, ..good };
        assert_eq!(refusal(&curve, p2, &lost, Center::Middle), named(Status::InvalidValue, "sphere"));
        assert_eq!(refusal(&curve, p3, &good, Center::Middle).0, Status::Degenerate);
    }
}
