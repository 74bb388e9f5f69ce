//! Where panels fold over or shrink: near the evolute of the guide curve.
//!
//! The planes of the sections are orthogonal to the guide curve, so neighbouring ones meet in lines over its evolute, the locus of its
//! centers of curvature. A surface that reaches that far from the guide shrinks there to nothing, and beyond it folds over
//! (section 6.3, Fig. 25). With `k` the curvature vector of the guide at `P`, a point `X` of the section reaches the evolute where
//! `(X − P)·k = 1`.

use glam::DVec3;

use crate::geometry::circle::Circle;
use crate::mesh::Grid;

/// Part of the way to the evolute from which on a section is said to be near it: panels there have a fifth of their length.
pub const NEAR_EVOLUTE: f64 = 0.8;

/// Ratio of the shorter to the longer of two opposite edges below which a panel is said to have shrunk.
pub const SHRUNK: f64 = 0.05;

/// What was found, all by index.
#[derive(Clone, Debug, PartialEq)]
pub struct Folds {
    /// For each row, how far its section reaches towards the evolute of column 0: 1 at the evolute, above it beyond. 0 at the
    /// ends of an open guide and where it is straight.
    pub evolute_ratios: Vec<f64>,
    /// For each face, the least ratio of opposite edges, 0 to 1.
    pub edge_ratios: Vec<f64>,
    /// Faces whose normal points against that of most of their neighbours.
    pub flipped_faces: Vec<usize>,
    /// Faces whose edges are shorter than [`SHRUNK`] of those opposite.
    pub shrunk_faces: Vec<usize>,
    /// Rows whose section comes nearer than [`NEAR_EVOLUTE`] to the evolute.
    pub rows_near_evolute: Vec<usize>,
}

impl Folds {
    /// Of a grid whose column 0 is the guide.
    pub fn of(grid: &Grid) -> Self {
        let evolute_ratios: Vec<f64> = (0..grid.rows()).map(|i| evolute_ratio(grid, i)).collect();
        let quads: Vec<[DVec3; 4]> = grid.quads().map(|quad| quad.map(|corner| grid.points()[corner])).collect();
        let edge_ratios: Vec<f64> = quads.iter().map(|quad| edge_ratio(*quad)).collect();
        let chosen = |values: &[f64], is_chosen: &dyn Fn(f64) -> bool| {
            values.iter().enumerate().filter(|(_, value)| is_chosen(**value)).map(|(k, _)| k).collect()
        };
        Self {
            flipped_faces: flipped(grid, &quads),
            shrunk_faces: chosen(&edge_ratios, &|ratio| ratio < SHRUNK),
            rows_near_evolute: chosen(&evolute_ratios, &|ratio| ratio >= NEAR_EVOLUTE),
            evolute_ratios,
            edge_ratios,
        }
    }

    /// Whether nothing was found.
    pub fn is_clear(&self) -> bool {
        self.flipped_faces.is_empty() && self.shrunk_faces.is_empty() && self.rows_near_evolute.is_empty()
    }
}

fn evolute_ratio(grid: &Grid, i: usize) -> f64 {
    let rows = grid.rows();
    if !grid.wraps()[0] && (i == 0 || i + 1 == rows) {
        return 0.0;
    }
    let [before, here, after] = [(i + rows - 1) % rows, i, (i + 1) % rows].map(|row| grid.at(row, 0));
    let Some(circle) = Circle::through(before, here, after) else { return 0.0 };
    let curvature = (circle.center - here) / (circle.radius * circle.radius);
    grid.row(i).iter().map(|&point| (point - here).dot(curvature)).fold(0.0, f64::max)
}

fn edge_ratio([a, b, c, d]: [DVec3; 4]) -> f64 {
    let ratio = |x: f64, y: f64| if x.max(y) > 0.0 { x.min(y) / x.max(y) } else { 1.0 };
    ratio(a.distance(b), c.distance(d)).min(ratio(b.distance(c), d.distance(a)))
}

/// Faces against whose normal more than half of the neighbours' normals point.
fn flipped(grid: &Grid, quads: &[[DVec3; 4]]) -> Vec<usize> {
    let [rows, columns] = grid.spans();
    let normals: Vec<DVec3> = quads.iter().map(|[a, b, c, d]| (*c - *a).cross(*d - *b)).collect();
    let [wraps_rows, wraps_columns] = grid.wraps();
    let step = |at: usize, back: bool, count: usize, wraps: bool| match (back, at) {
        (true, 0) => wraps.then(|| count - 1),
        (true, _) => Some(at - 1),
        (false, _) if at + 1 < count => Some(at + 1),
        (false, _) => wraps.then_some(0),
    };
    let is_flipped = |&k: &usize| {
        let (i, j) = (k / columns, k % columns);
        let around = [true, false].into_iter().flat_map(|back| {
            let row = step(i, back, rows, wraps_rows).map(|i| i * columns + j);
            let column = step(j, back, columns, wraps_columns).map(|j| i * columns + j);
            [row, column].into_iter().flatten()
        });
        let (mut count, mut against) = (0, 0);
        for other in around {
            count += 1;
            against += usize::from(normals[k].dot(normals[other]) < 0.0);
        }
        2 * against > count
    };
    (0..quads.len()).filter(is_flipped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows along rays from the unit circle to the radius `1 − reach`.
    fn disk(reach: f64) -> Grid {
        let point = |k: usize| {
            let (angle, radius) = (0.1 * (k / 5) as f64, 1.0 - reach * (k % 5) as f64 / 4.0);
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0)
        };
        Grid::new((0..8 * 5).map(point).collect(), 8, 5, [false; 2]).unwrap()
    }

    #[test]
    fn a_disk_reaches_the_evolute_of_its_boundary_at_its_center() {
        for reach in [0.5, 0.85, 0.99, 1.3] {
            let folds = Folds::of(&disk(reach));
            assert!((1..7).all(|i| (folds.evolute_ratios[i] - reach).abs() < 1e-12));
            assert_eq!((folds.evolute_ratios[0], folds.evolute_ratios[7]), (0.0, 0.0));
            let expected: Vec<usize> = if reach < NEAR_EVOLUTE { vec![] } else { (1..7).collect() };
            assert_eq!(folds.rows_near_evolute, expected);
            assert_eq!(folds.is_clear(), reach == 0.5);
        }
        // At 0.99 the innermost edges are 0.01 of the guide's, the ones before them 0.2575.
        let folds = Folds::of(&disk(0.99));
        assert!((folds.edge_ratios[3] - 0.01 / 0.2575).abs() < 1e-12);
        assert_eq!(folds.shrunk_faces, (0..7).map(|i| 4 * i + 3).collect::<Vec<_>>());
    }

    #[test]
    fn a_face_that_is_folded_over_is_named() {
        let grid = disk(0.5);
        assert!(Folds::of(&grid).flipped_faces.is_empty());
        // The corner of face 0 beyond its opposite corner.
        let mut points = grid.points().to_vec();
        points[0] = grid.at(1, 1) + 2.0 * (grid.at(1, 1) - grid.at(0, 0));
        assert_eq!(Folds::of(&grid.with_points(points).unwrap()).flipped_faces, [0]);
    }
}
