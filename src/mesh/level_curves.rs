//! Level curves of functions on triangle meshes.
//!
//! A function has a value at each point and is linear on triangles. A point counts as above the level `c` if its value is at least
//! `c`, so each edge is crossed or not, and a triangle is crossed by one segment or none (marching triangles). Segments are chained
//! from triangle to triangle over the edges they end on. Walking along a curve, what is above is to the left: in a triangle whose
//! corners run counterclockwise a segment begins on the edge that leads from above to below and ends on the one that leads back.
//! Both triangles at an edge compute the point on it the same way, to the bit.

use glam::DVec3;

use super::{SurfacePoint, TriangleMesh};
use crate::error::{Error, Result, Status, finite};

/// A point where a level curve crosses an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevelPoint {
    /// The ends of the edge, the lower first.
    pub edge: [u32; 2],
    /// How much of the edge is before the point, 0 to 1.
    pub fraction: f64,
    /// Where it is.
    pub position: DVec3,
    /// The same on the mesh: in the triangle that the curve enters here, or, at the end of an open curve, has left. The weight of
    /// the corner off the edge is exactly 0.
    pub at: SurfacePoint,
}

/// A piece of a level set, with what is above it to the left.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelCurve {
    /// Its points in order; of several at one place, where a point of the mesh is at the level, only one.
    pub points: Vec<LevelPoint>,
    /// Whether the last point is followed by the first; otherwise both ends are on the boundary.
    pub is_closed: bool,
}

impl LevelCurve {
    /// The positions of its points.
    pub fn positions(&self) -> Vec<DVec3> {
        self.points.iter().map(|point| point.position).collect()
    }

    /// The sum of its segments, the closing one included.
    pub fn length(&self) -> f64 {
        let count = self.points.len();
        let last = if self.is_closed { count } else { count.saturating_sub(1) };
        (0..last).map(|i| self.points[i].position.distance(self.points[(i + 1) % count].position)).sum()
    }
}

/// The curves where the function with these values at the points has the value `level`: first those that end on the boundary, then
/// the closed ones, each in the order of their first triangles. Empty if the level is above all values or not above the least.
///
/// # Errors
/// Not one value for each point, or a number that is not finite; the place is `values`, `values[i]` or `level`.
pub fn level_curves(mesh: &TriangleMesh, values: &[f64], level: f64) -> Result<Vec<LevelCurve>> {
    level_curves_within(mesh, values, level, |_| true)
}

/// As [`level_curves`], only on the triangles for which `is_used` is true: where others begin is a boundary.
///
/// # Errors
/// As [`level_curves`].
pub fn level_curves_within(
    mesh: &TriangleMesh,
    values: &[f64],
    level: f64,
    is_used: impl Fn(usize) -> bool,
) -> Result<Vec<LevelCurve>> {
    check_values(mesh, values)?;
    finite("level", level)?;
    let crossing = Crossing { mesh, values, level };
    let count = mesh.triangles().len();
    let mut is_open: Vec<bool> = (0..count).map(|t| crossing.edges(t).is_some() && is_used(t)).collect();
    let crossed: Vec<usize> = (0..count).filter(|&t| is_open[t]).collect();
    let mut curves = Vec::new();
    for wants_closed in [false, true] {
        for &first in &crossed {
            let Some([entry, _]) = crossing.edges(first) else { continue };
            let comes_from = mesh.across(first, entry).is_some_and(|(other, _)| crossed.binary_search(&other).is_ok());
            if is_open[first] && (wants_closed || !comes_from) {
                curves.push(crossing.chain(first, &mut is_open));
            }
        }
    }
    Ok(curves)
}

/// The points off the boundary around which the function does not rise on one side and fall on the other: peaks, pits and saddles.
/// Of equal values that of the higher index counts as greater.
///
/// # Errors
/// As [`level_curves`].
pub fn critical_points(mesh: &TriangleMesh, values: &[f64]) -> Result<Vec<u32>> {
    check_values(mesh, values)?;
    let is_above = |j: u32, i: u32| (values[j as usize], j) > (values[i as usize], i);
    let changes = |i: u32| {
        let around = mesh.neighbours(i as usize);
        let next = |k: usize| around[(k + 1) % around.len()];
        (0..around.len()).filter(|&k| is_above(around[k], i) != is_above(next(k), i)).count()
    };
    let inside = (0..values.len()).filter(|&i| !mesh.is_on_boundary(i)).map(|i| i as u32);
    Ok(inside.filter(|&i| changes(i) != 2).collect())
}

fn check_values(mesh: &TriangleMesh, values: &[f64]) -> Result<()> {
    let count = mesh.points().len();
    if values.len() != count {
        let reason = format!("expected one for each of {count} points, found {}", values.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("values"));
    }
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(i) => {
            let reason = format!("expected a finite number, found {}", values[i]);
            Err(Error::new(Status::InvalidValue, reason).at(format!("values[{i}]")))
        }
    }
}

struct Crossing<'a> {
    mesh: &'a TriangleMesh,
    values: &'a [f64],
    level: f64,
}

impl Crossing<'_> {
    /// The edges by which the curve enters a triangle and leaves it, if it does.
    fn edges(&self, triangle: usize) -> Option<[usize; 2]> {
        let is_above = self.mesh.triangles()[triangle].map(|i| self.values[i as usize] >= self.level);
        let entry = (0..3).find(|&k| is_above[k] && !is_above[(k + 1) % 3])?;
        let exit = (0..3).find(|&k| !is_above[k] && is_above[(k + 1) % 3])?;
        Some([entry, exit])
    }

    fn point(&self, triangle: usize, k: usize) -> LevelPoint {
        let corners = self.mesh.triangles()[triangle];
        let (mut a, mut b) = (k, (k + 1) % 3);
        if corners[a] > corners[b] {
            std::mem::swap(&mut a, &mut b);
        }
        let edge = [corners[a], corners[b]];
        let [low, high] = edge.map(|i| self.values[i as usize]);
        // Halves, as the difference of two huge values may overflow.
        let fraction = ((0.5 * self.level - 0.5 * low) / (0.5 * high - 0.5 * low)).clamp(0.0, 1.0);
        let [from, to] = edge.map(|i| self.mesh.points()[i as usize]);
        let mut weights = [0.0; 3];
        (weights[a], weights[b]) = (1.0 - fraction, fraction);
        let at = SurfacePoint { triangle: triangle as u32, weights };
        LevelPoint { edge, fraction, position: (1.0 - fraction) * from + fraction * to, at }
    }

    /// The curve from a triangle on, to the boundary or around.
    fn chain(&self, first: usize, is_open: &mut [bool]) -> LevelCurve {
        let (mut points, mut now) = (Vec::<LevelPoint>::new(), first);
        let is_closed = loop {
            is_open[now] = false;
            let Some([entry, exit]) = self.edges(now) else { break false };
            push(&mut points, self.point(now, entry), false);
            match self.mesh.across(now, exit) {
                Some((next, _)) if is_open[next] => now = next,
                Some((next, _)) if next == first => break true,
                _ => {
                    push(&mut points, self.point(now, exit), true);
                    break false;
                }
            }
        };
        while is_closed && points.len() > 1 && points[0].position == points[points.len() - 1].position {
            points.pop();
        }
        LevelCurve { points, is_closed }
    }
}

/// Of several points at one place the last is kept, but of those at the start the first, as ends are on the boundary.
fn push(points: &mut Vec<LevelPoint>, point: LevelPoint, is_end: bool) {
    if points.last().is_some_and(|last| last.position == point.position) {
        if points.len() == 1 && !is_end {
            return;
        }
        points.pop();
    }
    points.push(point);
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::mesh::Grid;
    use crate::mesh::operators::gradient_on;
    use crate::mesh::patterns::{height_field, parametric_surface};

    fn saddle(n: usize) -> TriangleMesh {
        TriangleMesh::new(&height_field(n, n, [-1.0, 1.0], [-1.0, 1.0], |x, y| x * y).unwrap()).unwrap()
    }

    /// A tube of radius 2 about z.
    fn tube(around: usize, rows: usize) -> TriangleMesh {
        let at = |i: usize, j: usize| {
            let (angle, z) = (TAU * i as f64 / around as f64, 3.0 * j as f64 / (rows - 1) as f64);
            DVec3::new(2.0 * angle.cos(), 2.0 * angle.sin(), z)
        };
        let points = (0..rows).flat_map(|j| (0..around).map(move |i| at(i, j))).collect();
        let grid = Grid::new(points, rows, around, [false, true]).unwrap();
        TriangleMesh::new(&grid.mesh()).unwrap()
    }

    fn check_laws(mesh: &TriangleMesh, values: &[f64], curves: &[LevelCurve]) {
        for curve in curves {
            let count = curve.points.len();
            for (i, point) in curve.points.iter().enumerate() {
                let triangle = mesh.triangles()[point.at.triangle as usize];
                let off = (0..3).find(|&k| !point.edge.contains(&triangle[k])).unwrap();
                assert_eq!(point.at.weights[off], 0.0);
                assert!(mesh.position(point.at).distance(point.position) < 1e-15);
                assert!((point.at.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
                if curve.is_closed || i + 1 < count {
                    let along = curve.points[(i + 1) % count].position - point.position;
                    let t = point.at.triangle as usize;
                    let slope = gradient_on(mesh, values, t);
                    assert!(mesh.normal(t).cross(along).dot(slope) > 0.0, "what is above is to the left");
                }
            }
            if !curve.is_closed {
                for end in [&curve.points[0], &curve.points[count - 1]] {
                    assert!(end.edge.iter().all(|&i| mesh.is_on_boundary(i as usize)));
                }
            }
        }
    }

    #[test]
    fn plane_sections_are_level_curves_of_a_linear_function() {
        let mesh = saddle(14);
        let (normal, offset) = (DVec3::new(0.6, -0.3, 0.4).normalize(), 0.123);
        let values: Vec<f64> = mesh.points().iter().map(|p| normal.dot(*p)).collect();
        let curves = level_curves(&mesh, &values, offset).unwrap();
        assert!(!curves.is_empty());
        check_laws(&mesh, &values, &curves);
        let apart = curves.iter().flat_map(LevelCurve::positions).map(|p| (normal.dot(p) - offset).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-14);
        // Every crossed edge has one point.
        let is_crossed = |&[a, b]: &[u32; 2]| (values[a as usize] >= offset) != (values[b as usize] >= offset);
        let crossed = mesh.edges().iter().filter(|edge| is_crossed(edge)).count();
        assert_eq!(curves.iter().map(|curve| curve.points.len()).sum::<usize>(), crossed);
        assert!(curves.iter().all(|curve| !curve.is_closed));
    }

    #[test]
    fn levels_of_height_on_a_tube_are_closed_and_as_long_as_its_circle() {
        let error = |n: usize| {
            let mesh = tube(n, n / 2);
            let values: Vec<f64> = mesh.points().iter().map(|p| p.z + 0.2 * p.x).collect();
            let mut worst: f64 = 0.0;
            for level in [1.0, 1.33, 1.7] {
                let curves = level_curves(&mesh, &values, level).unwrap();
                check_laws(&mesh, &values, &curves);
                assert!(curves.len() == 1 && curves[0].is_closed);
                // An ellipse of half axes 2 and 2 √1.04; its length by the midpoint rule.
                let (a, b) = (2.0, 2.0 * 1.04_f64.sqrt());
                let speed = |k: usize| {
                    let angle = TAU * (k as f64 + 0.5) / 400.0;
                    (a * angle.cos()).hypot(b * angle.sin()) * TAU / 400.0
                };
                worst = worst.max((curves[0].length() - (0..400).map(speed).sum::<f64>()).abs());
            }
            worst
        };
        let (coarse, fine) = (error(20), error(40));
        assert!(coarse < 0.06 && coarse / fine > 3.5, "{coarse} {fine}");
        let heights: Vec<f64> = tube(24, 9).points().iter().map(|p| p.z).collect();
        for k in 1..8 {
            let curves = level_curves(&tube(24, 9), &heights, 3.0 * k as f64 / 8.0).unwrap();
            let length = 2.0 * 24.0 * 2.0 * (PI / 24.0).sin();
            assert!(curves.len() == 1 && curves[0].is_closed && (curves[0].length() - length).abs() < 1e-12);
        }
    }

    #[test]
    fn a_level_through_points_has_each_place_once() {
        let mesh = saddle(9);
        let values: Vec<f64> = mesh.points().iter().map(|p| p.x).collect();
        let curves = level_curves(&mesh, &values, 0.0).unwrap();
        check_laws(&mesh, &values, &curves);
        assert_eq!((curves.len(), curves[0].points.len()), (1, 9));
        assert!(curves[0].points.iter().all(|p| p.position.x == 0.0));
        // The least value is no level, the greatest is the points that have it.
        assert!(level_curves(&mesh, &values, -1.0).unwrap().is_empty());
        assert!(level_curves(&mesh, &values, 1.1).unwrap().is_empty());
        let hill: Vec<f64> = mesh.points().iter().map(|p| -p.x * p.x - p.y * p.y).collect();
        let top = level_curves(&mesh, &hill, 0.0).unwrap();
        assert!(top.len() == 1 && top[0].is_closed && top[0].points.len() == 1);
    }

    #[test]
    fn parts_left_out_are_beyond_a_boundary() {
        let mesh = saddle(9);
        let values: Vec<f64> = mesh.points().iter().map(|p| p.x + 0.01).collect();
        let is_used = |t: usize| mesh.corners(t).iter().all(|p| p.y.abs() > 0.3 || p.y > 0.3);
        let curves = level_curves_within(&mesh, &values, 0.0, is_used).unwrap();
        assert_eq!(curves.len(), 2);
        assert!(curves.iter().all(|curve| !curve.is_closed && curve.points.iter().all(|p| p.position.y.abs() > 0.2)));
    }

    #[test]
    fn peaks_pits_and_saddles_are_counted() {
        let mesh = TriangleMesh::new(&height_field(41, 41, [-1.0, 1.0], [-1.0, 1.0], |_, _| 0.0).unwrap()).unwrap();
        let critical = |f: &dyn Fn(f64, f64) -> f64| {
            let values: Vec<f64> = mesh.points().iter().map(|p| f(p.x, p.y)).collect();
            critical_points(&mesh, &values).unwrap()
        };
        assert!(critical(&|x, y| x + 0.2 * y).is_empty() && critical(&|x, _| x).is_empty());
        assert_eq!(critical(&|x, y| x * x + y * y).len(), 1);
        let saddle = critical(&|x, y| x * x - 1.3 * y * y);
        assert_eq!((saddle.len(), mesh.points()[saddle[0] as usize]), (1, DVec3::ZERO));
        // sin πx sin πy inside has peaks at ±(½, ½), pits at ±(½, −½) and a saddle at the origin.
        assert_eq!(critical(&|x, y| (PI * x).sin() * (PI * y).sin()).len(), 5);
    }

    #[test]
    fn bad_values_are_named() {
        let mesh = saddle(3);
        let place = |values: &[f64], level| level_curves(&mesh, values, level).unwrap_err().place().to_owned();
        assert_eq!(place(&[0.0; 8], 0.0), "values");
        let mut values = [0.0; 9];
        assert_eq!(place(&values, f64::NAN), "level");
        values[4] = f64::INFINITY;
        assert_eq!(place(&values, 0.0), "values[4]");
        assert_eq!(critical_points(&mesh, &values).unwrap_err().place(), "values[4]");
        // Huge values do not overflow.
        let huge: Vec<f64> = mesh.points().iter().map(|p| 1.7e308 * p.x).collect();
        assert!(level_curves(&mesh, &huge, 0.0).unwrap()[0].points.iter().all(|p| p.position.is_finite()));
        let flat = parametric_surface(3, 3, [0.0, 1.0], [0.0, 1.0], |u, v| DVec3::new(u, v, 0.0)).unwrap();
        assert!(level_curves(&TriangleMesh::new(&flat).unwrap(), &[2.0; 9], 2.0).unwrap().is_empty());
    }
}
