//! Shapes that fit a set of points best: plane, circle, regular polygon.

use glam::{DMat3, DVec3};

use crate::linalg::small::{nearest_rotation, scatter, symmetric_eigen};

/// Least ratio of the smaller to the larger spread within the plane at which points are trusted to span one: below it,
/// the curvature that a circle is fitted to is round-off.
const MIN_SPREAD: f64 = 1e-10;

/// A plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The mean of the points, which is on it.
    pub center: DVec3,
    /// A unit vector.
    pub normal: DVec3,
    /// Unit vectors in the plane, the direction of largest spread second.
    axes: [DVec3; 2],
    /// The largest coordinate of a point relative to `center`; 1 if all coincide.
    scale: f64,
    /// The sums of squares along `axes`, in units of `scale²`.
    spreads: [f64; 2],
}

impl Plane {
    /// The plane of the least sum of squared distances from `points`; any plane through them where they do not span one,
    /// through the origin where there are none.
    pub fn fitting(points: &[DVec3]) -> Self {
        let center = mean(points);
        let offsets = points.iter().map(|&point| point - center);
        let largest = offsets.clone().map(|offset| offset.abs().max_element()).fold(0.0, f64::max);
        // Squares of huge coordinates would overflow, of tiny ones vanish.
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let (values, [normal, minor, major]) = symmetric_eigen(scatter(offsets.map(|offset| offset / scale)));
        Self { center, normal, axes: [minor, major], scale, spreads: [values[1], values[2]] }
    }

    /// The distance of `point` from the plane, above 0 on the side that the normal points to.
    pub fn height(&self, point: DVec3) -> f64 {
        (point - self.center).dot(self.normal)
    }
}

/// A circle in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Its center.
    pub center: DVec3,
    /// A unit vector along its axis.
    pub normal: DVec3,
    /// Its radius.
    pub radius: f64,
}

impl Circle {
    /// The circle in the best-fit plane of `points` whose algebraic residual `Σ (‖pᵢ − c‖² − r²)²` is least (Kåsa 1976);
    /// `None` where they lie on a line.
    ///
    /// With coordinates `u`, `v` about the mean, the normal equations are `S c = ½ (Σu³ + Σuv², Σv³ + Σvu²)` and
    /// `r² = ‖c‖² + tr(S)/k`; along the principal axes `S` is diagonal.
    pub fn fitting(points: &[DVec3]) -> Option<Self> {
        let plane = Plane::fitting(points);
        let [minor, major] = plane.axes;
        let spans_a_plane = plane.spreads[0] > MIN_SPREAD * plane.spreads[1];
        if !spans_a_plane {
            return None;
        }
        let (mut cubes, mut squares) = ([0.0; 2], 0.0);
        for offset in points.iter().map(|&point| (point - plane.center) / plane.scale) {
            let (u, v) = (offset.dot(minor), offset.dot(major));
            let square = u * u + v * v;
            cubes = [cubes[0] + u * square, cubes[1] + v * square];
            squares += square;
        }
        let [u, v] = [0, 1].map(|i| 0.5 * cubes[i] / plane.spreads[i]);
        let radius = plane.scale * (u * u + v * v + squares / points.len() as f64).sqrt();
        let center = plane.center + plane.scale * (u * minor + v * major);
        (center.is_finite() && radius.is_finite()).then_some(Self { center, normal: plane.normal, radius })
    }

    /// The distance of `point` from the circle's line.
    pub fn distance(&self, point: DVec3) -> f64 {
        let offset = point - self.center;
        let height = offset.dot(self.normal);
        ((offset - height * self.normal).length() - self.radius).hypot(height)
    }
}

/// The corners of the regular polygon of `count` corners and circumradius 1, counterclockwise in the xy-plane from +x.
pub fn regular_polygon(count: usize) -> Vec<DVec3> {
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / count as f64;
    (0..count).map(|i| DVec3::new(angle(i).cos(), angle(i).sin(), 0.0)).collect()
}

/// The corners of the regular polygon that fits the polygon of `corners` best, in the same order: of all turned, moved
/// and scaled ones, that of the least sum of squared distances (Umeyama 1991).
///
/// The turns of a regular polygon into itself are rotations in space, its reflections too; so no start and no sense of
/// the order is better than another.
pub fn fitting_regular_polygon(corners: &[DVec3]) -> Vec<DVec3> {
    let center = mean(corners);
    let shape = regular_polygon(corners.len());
    let products = corners.iter().zip(&shape).map(|(&corner, &at)| {
        let offset = corner - center;
        DMat3::from_cols(offset * at.x, offset * at.y, offset * at.z)
    });
    let (rotation, trace) = nearest_rotation(products.fold(DMat3::ZERO, |sum, product| sum + product));
    // The shape's sum of squares is the number of its corners. A shrunken trace means a collapsed polygon, not a mirror.
    let scale = (trace / corners.len().max(1) as f64).max(0.0);
    shape.iter().map(|&at| center + scale * (rotation * at)).collect()
}

fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::DQuat;

    use super::*;

    fn turned(points: &[DVec3]) -> Vec<DVec3> {
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.8);
        points.iter().map(|&point| turn * point + DVec3::new(10.0, -3.0, 7.0)).collect()
    }

    #[test]
    fn a_tent_of_four_lies_evenly_about_its_plane() {
        // Corners at heights ±h over the unit square: by symmetry the plane is z = 0.
        let h = 0.01;
        let square = [(0.0, 0.0, h), (1.0, 0.0, -h), (1.0, 1.0, h), (0.0, 1.0, -h)];
        let points = turned(&square.map(|(x, y, z)| DVec3::new(x, y, z)));
        let plane = Plane::fitting(&points);
        assert!(points.iter().all(|&point| (plane.height(point).abs() - h).abs() < 1e-15));
    }

    #[test]
    fn points_of_a_circle_give_it_back() {
        let at = |turn: f64| 3.0 * DVec3::new((TAU * turn).cos(), (TAU * turn).sin(), 0.0);
        let points = turned(&[0.0, 0.1, 0.15, 0.3].map(at));
        let circle = Circle::fitting(&points).unwrap();
        assert!((circle.radius - 3.0).abs() < 1e-12);
        assert!(circle.center.distance(DVec3::new(10.0, -3.0, 7.0)) < 1e-12);
        // One unit above the plane and one outside the circle.
        let beside = turned(&[DVec3::new(4.0, 0.0, 1.0)])[0];
        assert!((circle.distance(beside) - 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(Circle::fitting(&[DVec3::ZERO, DVec3::X, 2.0 * DVec3::X]), None);
        assert_eq!(Circle::fitting(&[DVec3::ONE; 4]), None);
    }

    #[test]
    fn a_regular_polygon_fits_itself_from_any_start_and_either_way_round() {
        let mut points = turned(&regular_polygon(5).iter().map(|&corner| 2.0 * corner).collect::<Vec<_>>());
        points.rotate_left(2);
        for _ in 0..2 {
            let fitted = fitting_regular_polygon(&points);
            assert!(points.iter().zip(&fitted).all(|(point, fitted)| point.distance(*fitted) < 1e-13));
            points.reverse();
        }
    }

    #[test]
    fn a_rectangle_is_a_quarter_of_its_excess_from_a_square() {
        // Sides 1 + e and 1: the square of side 1 + e/2 fits best, each corner e/4 off in x and in y: e √2/4.
        let e = 0.2;
        let rectangle = [(0.0, 0.0), (1.0 + e, 0.0), (1.0 + e, 1.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        for (corner, fitted) in rectangle.iter().zip(fitting_regular_polygon(&rectangle)) {
            assert!((corner.distance(fitted) - e * 2.0_f64.sqrt() / 4.0).abs() < 1e-14);
        }
    }

    #[test]
    fn nothing_is_not_a_number() {
        assert!(Plane::fitting(&[]).normal.is_finite());
        let huge = regular_polygon(5).into_iter().map(|corner| 1e200 * corner).collect::<Vec<_>>();
        assert!((Circle::fitting(&huge).unwrap().radius / 1e200 - 1.0).abs() < 1e-14);
        for points in [vec![DVec3::ONE; 5], vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], vec![1e200 * DVec3::X; 3]] {
            assert!(fitting_regular_polygon(&points).iter().all(|corner| corner.is_finite()));
        }
    }
}
