//! Measures of a mesh: how planar, circular and regular its faces are, edge lengths, angles, displacements.
//!
//! Ratios are plain numbers: 0.01 is one percent. Where a face has no size to compare with, its ratio is 0.

use glam::DVec3;
use serde::Serialize;

use super::fit::{Circle, Plane, fitting_regular_polygon};
use super::{Mesh, Topology};
use crate::error::{Error, Result, Status};

/// Least sine of the angle between the diagonals of a quad at which their cross product has a direction. The diagonals of
/// a quad below it are parallel but for round-off; the distance of one from the other's end then stands in.
const MIN_SINE: f64 = 1e-9;

/// A measure of a face, given its corners.
pub type FaceMeasure = fn(&[DVec3]) -> f64;

/// Every measure of faces with its name, for programs that let people choose.
pub const FACE_MEASURES: [(&str, FaceMeasure); 5] = [
    ("planarity", planarity),
    ("plane_distance", plane_distance),
    ("circularity", circularity),
    ("regularity", regularity),
    ("mean_edge", mean_edge),
];

/// The extremes and the mean of a list of values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// The number of values.
    pub count: usize,
    /// The least; 0 without values.
    pub min: f64,
    /// The mean; 0 without values.
    pub mean: f64,
    /// The greatest; 0 without values.
    pub max: f64,
    /// The place of the first least value.
    pub min_at: usize,
    /// The place of the first greatest value.
    pub max_at: usize,
}

impl Spread {
    /// The spread of `values`.
    pub fn of(values: &[f64]) -> Self {
        let Some(&first) = values.first() else { return Self::default() };
        let mut spread = Self { count: values.len(), min: first, max: first, ..Self::default() };
        for (i, &value) in values.iter().enumerate() {
            if value < spread.min {
                (spread.min, spread.min_at) = (value, i);
            }
            if value > spread.max {
                (spread.max, spread.max_at) = (value, i);
            }
        }
        spread.mean = values.iter().sum::<f64>() / values.len() as f64;
        spread
    }
}

/// How far a polygon is from planar. Quad: the distance between the lines of its diagonals over their mean length. Other
/// polygons: the distance of the farthest corner from the best-fit plane over the mean edge. Triangles: 0.
pub fn planarity(corners: &[DVec3]) -> f64 {
    match corners {
        [] | [_] | [_, _] | [_, _, _] => 0.0,
        [a, b, c, d] => {
            let (first, second) = (*c - *a, *d - *b);
            over(distance_of_lines(*a, first, *b, second), 0.5 * (first.length() + second.length()))
        }
        _ => over(plane_distance(corners), mean_edge(corners)),
    }
}

/// The distance of the farthest corner from the best-fit plane, in model units.
pub fn plane_distance(corners: &[DVec3]) -> f64 {
    if corners.len() <= 3 {
        return 0.0;
    }
    let plane = Plane::fitting(corners);
    corners.iter().map(|&corner| plane.height(corner).abs()).fold(0.0, f64::max)
}

/// How far a polygon is from one with a circumscribed circle: the distance of the farthest corner from the best-fit
/// circle over the mean edge. Triangles: 0. Corners on a line have no circle: the spread along it counts as nothing.
pub fn circularity(corners: &[DVec3]) -> f64 {
    if corners.len() <= 3 {
        return 0.0;
    }
    let Some(circle) = Circle::fitting(corners) else { return 0.0 };
    let farthest = corners.iter().map(|&corner| circle.distance(corner)).fold(0.0, f64::max);
    over(farthest, mean_edge(corners))
}

/// How far a polygon is from a regular one: the distance of the farthest corner from that of the best-fit regular polygon
/// over the mean edge.
pub fn regularity(corners: &[DVec3]) -> f64 {
    let fitted = fitting_regular_polygon(corners);
    let farthest = corners.iter().zip(&fitted).map(|(corner, fitted)| corner.distance(*fitted)).fold(0.0, f64::max);
    over(farthest, mean_edge(corners))
}

/// The mean length of a polygon's edges, in model units.
pub fn mean_edge(corners: &[DVec3]) -> f64 {
    over(edges_of(corners).map(|(a, b)| a.distance(b)).sum::<f64>(), corners.len() as f64)
}

/// The angle at each corner between the two edges that meet there, in radians, 0 to π. 0 beside an edge of no length.
pub fn corner_angles_rad(corners: &[DVec3]) -> Vec<f64> {
    let k = corners.len();
    let angle = |i: usize| {
        let (to_next, to_last) = (corners[(i + 1) % k] - corners[i], corners[(i + k - 1) % k] - corners[i]);
        // The arc tangent keeps its digits at 0 and π, where the arc cosine loses half of them.
        to_next.cross(to_last).length().atan2(to_next.dot(to_last))
    };
    let is_point = |i: usize| corners[i] == corners[(i + 1) % k] || corners[i] == corners[(i + k - 1) % k];
    (0..k).map(|i| if is_point(i) { 0.0 } else { angle(i) }).collect()
}

/// One of the measures above for each face.
///
/// # Errors
/// As [`Mesh::check`].
pub fn of_faces(mesh: &Mesh, measure: impl Fn(&[DVec3]) -> f64) -> Result<Vec<f64>> {
    mesh.check()?;
    Ok(mesh.faces.iter().map(|face| measure(&mesh.corners(face))).collect())
}

/// The length of each edge of [`Topology::edges`], in model units.
///
/// # Errors
/// As [`Mesh::check`].
pub fn edge_lengths(mesh: &Mesh) -> Result<Vec<f64>> {
    let topology = Topology::new(mesh)?;
    let length = |[a, b]: [u32; 2]| mesh.points[a as usize].distance(mesh.points[b as usize]);
    Ok(topology.edges().iter().map(|&edge| length(edge)).collect())
}

/// How far each point of `before` is from the same point of `after`, in model units.
///
/// # Errors
/// Status `InvalidArgumentLength` if they have different numbers of points.
pub fn displacements(before: &[DVec3], after: &[DVec3]) -> Result<Vec<f64>> {
    if before.len() != after.len() {
        let reason = format!("expected {} as before, found {}", before.len(), after.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("number of points"));
    }
    Ok(before.iter().zip(after).map(|(before, after)| before.distance(*after)).collect())
}

fn edges_of(corners: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
}

fn distance_of_lines(a: DVec3, along_a: DVec3, b: DVec3, along_b: DVec3) -> f64 {
    // Unit directions, so that neither tiny nor huge models lose the cross product.
    let (Some(unit_a), Some(unit_b)) = (along_a.try_normalize(), along_b.try_normalize()) else {
        // A diagonal of no length is a point: its distance from the other's line.
        return match along_a
            .try_normalize()
            .map(|unit| (unit, a, b))
            .or(along_b.try_normalize().map(|unit| (unit, b, a)))
        {
            Some((unit, on_line, point)) => (point - on_line).reject_from_normalized(unit).length(),
            None => a.distance(b),
        };
    };
    let normal = unit_a.cross(unit_b);
    if normal.length() <= MIN_SINE {
        return (b - a).reject_from_normalized(unit_a).length();
    }
    (b - a).dot(normal.normalize()).abs()
}

fn over(length: f64, reference: f64) -> f64 {
    if reference > 0.0 { length / reference } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

    use super::super::fit::regular_polygon;
    use super::*;

    fn points<const N: usize>(coordinates: [[f64; 3]; N]) -> Vec<DVec3> {
        coordinates.map(DVec3::from_array).to_vec()
    }

    #[test]
    fn a_lifted_corner_sets_the_diagonals_apart() {
        // Unit square with one corner at height h: diagonals (1, 1, h) and (-1, 1, 0), whose common normal is
        // (-h, -h, 2)/√(4 + 2h²); from (0, 0, 0) to (1, 0, 0) that is h/√(4 + 2h²). Lengths √(2 + h²) and √2.
        let h: f64 = 0.1;
        for scale in [1e-6, 1.0, 1e6] {
            let quad: Vec<DVec3> = points([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, h], [0.0, 1.0, 0.0]])
                .iter()
                .map(|corner| scale * *corner)
                .collect();
            let expected = h / (4.0 + 2.0 * h * h).sqrt() / (0.5 * ((2.0 + h * h).sqrt() + 2.0_f64.sqrt()));
            assert!((planarity(&quad) - expected).abs() < 1e-14);
            // The best-fit plane leaves the four corners about h/4 off, alternately.
            assert!((plane_distance(&quad) / scale - h / 4.0).abs() < 1e-3 * h);
        }
    }

    #[test]
    fn a_hexagon_with_alternating_heights_is_as_far_from_planar_as_they_are() {
        // Regular, heights ±h alternately: the plane is z = 0 by symmetry, edges √(1 + 4h²).
        let h = 0.02;
        let hexagon: Vec<DVec3> =
            regular_polygon(6).iter().zip([h, -h].iter().cycle()).map(|(corner, h)| *corner + *h * DVec3::Z).collect();
        assert!((plane_distance(&hexagon) - h).abs() < 1e-15);
        assert!((planarity(&hexagon) - h / (1.0 + 4.0 * h * h).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn triangles_are_planar_and_circular_but_seldom_regular() {
        let triangle = points([[0.0, 0.0, 0.0], [3.0, 0.0, 1.0], [0.0, 1.0, 2.0]]);
        assert_eq!((planarity(&triangle), circularity(&triangle)), (0.0, 0.0));
        assert!(regularity(&triangle) > 0.1);
        assert!(regularity(&regular_polygon(3)) < 1e-15);
    }

    #[test]
    fn a_kite_is_off_its_circle_and_a_rectangle_is_not() {
        let rectangle = points([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [5.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
        assert!(circularity(&rectangle) < 1e-15);
        // Corners at distances 1, b, 1, b along the axes: c = 0, r² = (1 + b²)/2, the corners at b are b − r off.
        let b: f64 = 1.2;
        let rhombus = points([[1.0, 0.0, 0.0], [0.0, b, 0.0], [-1.0, 0.0, 0.0], [0.0, -b, 0.0]]);
        let (radius, edge) = (((1.0 + b * b) / 2.0).sqrt(), (1.0 + b * b).sqrt());
        assert!((circularity(&rhombus) - (radius - 1.0).max(b - radius) / edge).abs() < 1e-14);
    }

    #[test]
    fn angles_are_those_between_the_edges() {
        let quad = points([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
        assert!(corner_angles_rad(&quad).iter().all(|angle| (angle - FRAC_PI_2).abs() < 1e-15));
        assert!(corner_angles_rad(&regular_polygon(3)).iter().all(|angle| (angle - FRAC_PI_3).abs() < 1e-15));
        let straight = points([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 1.0, 0.0]]);
        assert!((corner_angles_rad(&straight)[1] - PI).abs() < 1e-15);
    }

    #[test]
    fn a_spread_names_the_first_extremes() {
        let spread = Spread::of(&[2.0, 5.0, 1.0, 5.0, 1.0]);
        assert_eq!((spread.count, spread.min, spread.mean, spread.max), (5, 1.0, 2.8, 5.0));
        assert_eq!((spread.min_at, spread.max_at), (2, 1));
        assert_eq!(Spread::of(&[]), Spread::default());
    }

    #[test]
    fn edges_are_measured_once_and_displacements_point_by_point() {
        let corners = points([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0], [0.0, 4.0, 0.0]]);
        let mesh = Mesh { points: corners.clone(), faces: vec![vec![0, 1, 2], vec![0, 2, 3]] };
        assert_eq!(edge_lengths(&mesh).unwrap(), [3.0, 4.0, 5.0, 3.0, 4.0]);
        let moved: Vec<DVec3> = corners.iter().map(|corner| *corner + DVec3::new(0.0, 3.0, 4.0)).collect();
        assert_eq!(displacements(&corners, &moved).unwrap(), [5.0; 4]);
        assert!(displacements(&corners, &moved[1..]).is_err());
    }

    #[test]
    fn collapsed_faces_give_numbers() {
        let shapes = [
            vec![DVec3::ONE; 4],
            points([[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]),
            points([[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]),
            points([[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0]]),
            vec![DVec3::ONE; 6],
            Vec::new(),
        ];
        for corners in &shapes {
            for measure in [planarity, plane_distance, circularity, regularity, mean_edge] {
                assert!(measure(corners).is_finite(), "{corners:?}");
            }
            assert!(corner_angles_rad(corners).iter().all(|angle| angle.is_finite()));
        }
    }
}
