//! Polylines as curves: what is refused, whether they are closed or straight, their plane, and the tangent at their start.

use glam::{DMat3, DVec3};

use crate::error::{Error, Result, Status};
use crate::geometry::circle::reflect;
use crate::linalg::small::least_eigenvector;
use crate::mesh::fit::Plane;
use crate::mesh::grid::{check_finite, diagonal};

/// Points nearer to each other than this, over the extent, are one point; the same for a point on a plane or a line. Below it
/// differences of coordinates that come from files or other computations are noise.
pub(super) const COINCIDE: f64 = 1e-9;

/// Edges shorter than this, over the extent, have lost all but four digits of their direction.
pub(super) const NO_LENGTH: f64 = 1e-12;

/// Refuses polylines of fewer than two points, with coordinates that are not finite, or with consecutive points that coincide.
/// Returns the points without a repetition of the first at the end, and whether there was one.
pub(super) fn polyline<'a>(name: &str, points: &'a [DVec3]) -> Result<(&'a [DVec3], bool)> {
    if points.len() < 2 {
        let reason = format!("expected at least 2 points, found {}", points.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at(name));
    }
    check_finite(name, points)?;
    let extent = diagonal(points);
    if let Some(i) = (1..points.len()).find(|&i| !(points[i].distance(points[i - 1]) > NO_LENGTH * extent)) {
        let reason = "expected a point apart from the one before it, found the same";
        return Err(Error::new(Status::Degenerate, reason).at(format!("{name}[{i}]")));
    }
    let is_closed = points[0].distance(points[points.len() - 1]) <= COINCIDE * extent;
    if is_closed && points.len() < 4 {
        let reason = format!("expected at least 3 points and the first again, found {}", points.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at(name));
    }
    Ok((&points[..points.len() - usize::from(is_closed)], is_closed))
}

/// The direction of a straight polyline, none where it is not straight.
pub(super) fn direction_of_straight(points: &[DVec3]) -> Option<DVec3> {
    let offsets = points.iter().map(|&point| point - points[0]);
    let farthest = offsets.clone().fold(DVec3::ZERO, |a, b| if b.length() > a.length() { b } else { a });
    let direction = farthest.try_normalize()?;
    let is_near = |offset: DVec3| offset.cross(direction).length() <= COINCIDE * farthest.length();
    offsets.into_iter().all(is_near).then_some(direction)
}

/// The unit normal of the plane of points that are not on a line.
pub(super) fn plane_normal(name: &str, points: &[DVec3]) -> Result<DVec3> {
    let plane = Plane::fitting(points);
    let extent = diagonal(points);
    match points.iter().position(|&point| plane.height(point).abs() > COINCIDE * extent) {
        None => Ok(plane.normal),
        Some(i) => {
            let reason = format!("expected points on a plane, found one {:e} off it", plane.height(points[i]));
            Err(Error::new(Status::NotPlanar, reason).at(format!("{name}[{i}]")))
        }
    }
}

/// The unit tangent at the start of the smoothest curve of arcs through the points of a polyline whose tangents are handed on by
/// reflection; along the edge if there is one only.
///
/// The tangent at point `j` is `t_j = T_j t_0` with `T_{j+1} = −ρ_j T_j`, and `2 t_j × e_j / l_j` is the curvature of arc `j` along
/// its binormal (`e_j` the unit edge, `l_j` its length). Both are linear in `t_0`; so is every jump from arc to arc, and the unit
/// vector of the least sum of squared jumps is an eigenvector. On a circle, sampled evenly or not, there are no jumps. Without
/// this choice tangents that start wrong by ε are wrong by ±ε in turns all along.
pub(super) fn start_tangent(points: &[DVec3]) -> DVec3 {
    let Some(first) = points.get(1).and_then(|&second| (second - points[0]).try_normalize()) else {
        return DVec3::ZERO;
    };
    let columns = |f: &dyn Fn(DVec3) -> DVec3| DMat3::from_cols(f(DVec3::X), f(DVec3::Y), f(DVec3::Z));
    let scale = diagonal(points);
    let mut handed_on = DMat3::IDENTITY;
    let mut before: Option<DMat3> = None;
    let mut squares = DMat3::ZERO;
    for ends in points.windows(2) {
        let edge = ends[1] - ends[0];
        let along = edge.normalize_or_zero();
        let curvature = columns(&|v| (scale / edge.length()) * (handed_on * v).cross(along));
        if let Some(before) = before {
            let jump = curvature - before;
            squares += jump.transpose() * jump;
        }
        before = Some(curvature);
        handed_on = columns(&|v| -reflect(handed_on * v, along));
    }
    if points.len() < 3 || !squares.is_finite() {
        return first;
    }
    let tangent = least_eigenvector(squares);
    let along = tangent.dot(first);
    // A tangent across the first edge belongs to no curve that is sampled sensibly.
    if along.abs() < 1e-6 || !tangent.is_finite() { first } else { along.signum() * tangent }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::random::Random;

    #[test]
    fn the_start_tangent_is_exact_on_a_circle_however_it_is_sampled() {
        let mut random = Random(4);
        for count in [3, 4, 9, 40] {
            let normal = random.vector().normalize();
            let (x, y) = (normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector()));
            let mut angle: f64 = 0.0;
            let points: Vec<DVec3> = (0..count)
                .map(|_| {
                    let point = DVec3::ONE + 3.0 * (angle.cos() * x + angle.sin() * y);
                    angle += random.between(0.02, 2.0 / f64::from(count));
                    point
                })
                .collect();
            let error = start_tangent(&points).distance(y);
            assert!(error < 1e-11, "{count} {error}");
        }
        let line: Vec<DVec3> = [0.0, 1.0, 3.0, 3.5].map(|s| DVec3::ONE + s * DVec3::Y).to_vec();
        assert!(start_tangent(&line).distance(DVec3::Y) < 1e-15);
        assert_eq!(start_tangent(&line[..2]), DVec3::Y);
    }

    #[test]
    fn the_start_tangent_tends_to_that_of_a_curve_in_space() {
        // A helix; its tangent at the start is (0, 1, 0.5) normalised. Halving the steps divides the error by four or more.
        let helix = |count: i32| -> Vec<DVec3> {
            let at = |i: i32| 2.0 * f64::from(i) / f64::from(count);
            (0..=count).map(|i| DVec3::new(at(i).cos(), at(i).sin(), 0.5 * at(i))).collect()
        };
        let error = |count| start_tangent(&helix(count)).distance(DVec3::new(0.0, 1.0, 0.5).normalize());
        assert!(error(10) < 0.02 && error(20) < 0.25 * error(10) && error(40) < 0.25 * error(20));
    }

    #[test]
    fn polylines_are_checked() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y, DVec3::ZERO];
        assert_eq!(polyline("p", &square).unwrap(), (&square[..4], true));
        assert_eq!(polyline("p", &square[..4]).unwrap(), (&square[..4], false));
        assert_eq!(polyline("p", &[DVec3::X]).unwrap_err().status(), Status::InvalidArgumentLength);
        let error = polyline("p", &[DVec3::X, DVec3::Y, DVec3::Y]).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::Degenerate, "p[2]"));
        assert_eq!(polyline("p", &[DVec3::X, DVec3::NAN]).unwrap_err().place(), "p[1]");
        assert!(polyline("p", &[DVec3::X, DVec3::Y, DVec3::X]).is_err());
        assert_eq!(plane_normal("p", &square).unwrap_err().status(), Status::NotPlanar);
        assert!(direction_of_straight(&square).is_none());
    }
}
