//! Parallel meshes of quads: the test, and the linear space of all of them.
//!
//! Meshes of the same faces are parallel when corresponding edges are (equation 3): `e × e' = 0`, two equations for each edge in
//! directions orthogonal to `e`. Their solutions are a linear space, found by a singular value decomposition (section 2.4). It takes
//! any mesh of quads, closed ones too, but far longer than the propagation along a grid: it is here as its baseline, and for meshes that
//! are no grids. On a grid of `N` by `M` faces the space has `N + M + 3` dimensions: the lengths along a row and a column, and the
//! translations.

use glam::DVec3;

use crate::error::{Error, Result, Status, finite};
use crate::linalg::dense::{ROUND_OFF, Svd};
use crate::linalg::least_squares::LeastSquares;
use crate::mesh::grid::check_finite;
use crate::mesh::{Grid, Mesh};

/// In [`nearest_parallel`], the weight of staying where the mesh is against that of a handle: small, so that handles are met, yet
/// above the round-off of the equations.
const STAY: f64 = 1e-6;

/// The weight of parallel edges there. Multipliers make them exact whatever it is; this one needs few rounds.
const PARALLEL_WEIGHT: f64 = 1e3;

/// Rounds of multipliers at most, and the sine of an edge's angle at which they end.
const MOST_ROUNDS: usize = 100;
const PARALLEL_SINE: f64 = 1e-12;

/// Points up to which the space is computed: a dense decomposition of some thousand columns takes seconds.
pub const MOST_POINTS: usize = 1000;

/// How parallel two meshes are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallelism {
    /// The largest sine of the angle between corresponding edges; edges of no length are parallel to all.
    pub largest_sine: f64,
    /// The number of edges that point the other way.
    pub reversed_count: usize,
}

/// Compares the edges of two grids with the same rows and columns.
///
/// # Errors
/// They have not.
pub fn check_parallel(a: &Grid, b: &Grid) -> Result<Parallelism> {
    if (a.rows(), a.columns(), a.wraps()) != (b.rows(), b.columns(), b.wraps()) {
        let reason = format!("expected {} rows of {}, found {} of {}", a.rows(), a.columns(), b.rows(), b.columns());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("b"));
    }
    let [rows, columns] = a.spans();
    let down = (0..rows).flat_map(|i| (0..a.columns()).map(move |j| [a.index(i, j), a.index(i + 1, j)]));
    let along = (0..a.rows()).flat_map(|i| (0..columns).map(move |j| [a.index(i, j), a.index(i, j + 1)]));
    check_parallel_edges(a.points(), b.points(), down.chain(along))
}

/// Compares the given edges, pairs of indices into both lists of points.
///
/// # Errors
/// Lists of different lengths, a coordinate that is not finite, or an index out of range.
pub fn check_parallel_edges(a: &[DVec3], b: &[DVec3], edges: impl Iterator<Item = [usize; 2]>) -> Result<Parallelism> {
    if a.len() != b.len() {
        let reason = format!("expected {} points, found {}", a.len(), b.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("b"));
    }
    check_finite("a", a)?;
    check_finite("b", b)?;
    let mut result = Parallelism { largest_sine: 0.0, reversed_count: 0 };
    for (k, [from, to]) in edges.enumerate() {
        if let Some(&index) = [from, to].iter().find(|&&index| index >= a.len()) {
            let reason = format!("{index} is out of range for {} points", a.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at(format!("edges[{k}]")));
        }
        let [e, f] = [a, b].map(|points| (points[to] - points[from]).normalize_or_zero());
        result.largest_sine = result.largest_sine.max(e.cross(f).length());
        result.reversed_count += usize::from(e.dot(f) < 0.0);
    }
    Ok(result)
}

/// The faces of a mesh of quads.
pub(super) fn quads(mesh: &Mesh) -> Result<Vec<[usize; 4]>> {
    let quad = |(i, face): (usize, &Vec<u32>)| {
        let reason = || format!("expected a quad, found {} corners", face.len());
        let error = |_| Error::new(Status::NotGrid, reason()).at(format!("faces[{i}]"));
        <[u32; 4]>::try_from(face.as_slice()).map(|quad| quad.map(|corner| corner as usize)).map_err(error)
    };
    mesh.faces.iter().enumerate().map(quad).collect()
}

/// The linear space of all meshes parallel to one.
#[derive(Debug)]
pub struct ParallelMeshes {
    points: Vec<DVec3>,
    /// Orthonormal.
    basis: Vec<Vec<f64>>,
    singular_values: Vec<f64>,
}

impl ParallelMeshes {
    /// The meshes parallel to a mesh of quads, of at most [`MOST_POINTS`] points, each of them in a face.
    ///
    /// # Errors
    /// As [`Mesh::check_polygons`]; a face with other than four corners (`NotGrid`), an edge without a length (`Degenerate`), too many
    /// points.
    pub fn of(mesh: &Mesh) -> Result<Self> {
        mesh.check_polygons()?;
        quads(mesh)?;
        if mesh.points.len() > MOST_POINTS {
            let reason = format!("expected at most {MOST_POINTS} points, found {}", mesh.points.len());
            return Err(Error::new(Status::TooLarge, reason).at("points"));
        }
        let edges = edges_across(mesh)?;
        let mut columns = vec![vec![0.0; 2 * edges.len()]; 3 * mesh.points.len()];
        for (row, (edge, across)) in edges.iter().enumerate() {
            for (k, across) in across.iter().enumerate() {
                for (unknown, coefficient) in equation(*edge, *across) {
                    columns[unknown as usize][2 * row + k] = coefficient;
                }
            }
        }
        let svd = Svd::new(2 * edges.len(), &columns)
            .ok_or_else(|| Error::new(Status::Internal, "the equations of parallel edges were not decomposed"))?;
        let (basis, singular_values) = (svd.null_space(ROUND_OFF), svd.singular_values().to_vec());
        Ok(Self { points: mesh.points.clone(), basis, singular_values })
    }

    /// An orthonormal basis, each vector `x0 y0 z0 x1 …`.
    pub fn basis(&self) -> &[Vec<f64>] {
        &self.basis
    }

    /// The singular values of the equations, descending; the last ones, which count as zero, belong to the basis.
    pub fn singular_values(&self) -> &[f64] {
        &self.singular_values
    }

    /// Of all parallel meshes the one whose given points are nearest to their targets, by the sum of squares; among equally
    /// near ones the one nearest to the mesh itself.
    ///
    /// With the basis `B` it is `x + B c`, and `c` has the least norm among the minimisers of `‖(x + B c) − target‖` at the handles.
    ///
    /// # Errors
    /// A point out of range, or a target that is not finite.
    pub fn nearest(&self, handles: &[(usize, DVec3)]) -> Result<Vec<DVec3>> {
        check_handles(handles, self.points.len())?;
        if handles.is_empty() || self.basis.is_empty() {
            return Ok(self.points.clone());
        }
        let at_handles = |vector: &Vec<f64>| -> Vec<f64> {
            handles.iter().flat_map(|&(point, _)| vector[3 * point..3 * point + 3].iter().copied()).collect()
        };
        let columns: Vec<Vec<f64>> = self.basis.iter().map(at_handles).collect();
        let wanted: Vec<f64> =
            handles.iter().flat_map(|&(point, target)| (target - self.points[point]).to_array()).collect();
        let svd = Svd::new(wanted.len(), &columns)
            .ok_or_else(|| Error::new(Status::InvalidValue, "the targets are too large").at("handles"))?;
        let coordinates = svd.least_norm(&wanted, ROUND_OFF);
        let mut points = self.points.clone();
        for (vector, coordinate) in self.basis.iter().zip(coordinates) {
            for (point, part) in points.iter_mut().zip(vector.chunks_exact(3)) {
                *point += coordinate * DVec3::from_slice(part);
            }
        }
        check_finite("points", &points)?;
        Ok(points)
    }
}

fn check_handles(handles: &[(usize, DVec3)], point_count: usize) -> Result<()> {
    for (k, (point, target)) in handles.iter().enumerate() {
        if *point >= point_count {
            let reason = format!("{point} is out of range for {point_count} points");
            return Err(Error::new(Status::IndexOutOfRange, reason).at(format!("handles[{k}]")));
        }
        target.to_array().iter().try_for_each(|&x| finite(&format!("handles[{k}]"), x).map(|_| ()))?;
    }
    Ok(())
}

/// The edges of a mesh, each with two unit vectors that are orthogonal to it and to each other.
fn edges_across(mesh: &Mesh) -> Result<Vec<([u32; 2], [DVec3; 2])>> {
    let topology = crate::mesh::Topology::new(mesh)?;
    let across = |&[a, b]: &[u32; 2]| {
        let edge = mesh.points[b as usize] - mesh.points[a as usize];
        let (u, v) = edge.try_normalize().map(DVec3::any_orthonormal_pair).ok_or_else(|| {
            let reason = format!("the edge from point {a} to point {b} has no length");
            Error::new(Status::Degenerate, reason).at("points")
        })?;
        Ok(([a, b], [u, v]))
    };
    topology.edges().iter().map(across).collect()
}

/// `across · (x_b − x_a)`, with the coordinates `x0 y0 z0 x1 …` as unknowns.
fn equation([a, b]: [u32; 2], across: DVec3) -> [(u32, f64); 6] {
    let entry = |k: usize| {
        let (point, sign) = if k < 3 { (a, -1.0) } else { (b, 1.0) };
        (3 * point + k as u32 % 3, sign * across[k % 3])
    };
    std::array::from_fn(entry)
}

/// The parallel mesh whose given points are near their targets, for a mesh of quads of any size, closed or not:
/// `Σ ‖x'_h − target‖² + 10⁻⁶ ‖x' − x‖²` is least among all parallel meshes. Sparse least squares with multipliers for the
/// directions of edges, until these are parallel to 1e-12; 100 rounds at most, after which they are as parallel as they got.
///
/// # Errors
/// As [`ParallelMeshes::of`], but for the number of points, and [`ParallelMeshes::nearest`].
pub fn nearest_parallel(mesh: &Mesh, handles: &[(usize, DVec3)]) -> Result<Vec<DVec3>> {
    mesh.check_polygons()?;
    quads(mesh)?;
    check_handles(handles, mesh.points.len())?;
    let edges = edges_across(mesh)?;
    let diagonal = mesh.diagonal();
    let root = PARALLEL_WEIGHT.sqrt();
    let mut multipliers = vec![0.0; 2 * edges.len()];
    // Unknowns are moves, in units of the diagonal.
    let mut moves = vec![DVec3::ZERO; mesh.points.len()];
    for _ in 0..MOST_ROUNDS {
        let mut system = LeastSquares::new(3 * mesh.points.len());
        for unknown in 0..3 * mesh.points.len() as u32 {
            system.add(&[(unknown, STAY.sqrt())], 0.0);
        }
        for &(point, target) in handles {
            let wanted = (target - mesh.points[point]) / diagonal;
            (0..3).for_each(|axis| system.add(&[(3 * point as u32 + axis, 1.0)], wanted[axis as usize]));
        }
        // The source's own edges are parallel to themselves, so what must vanish is that of the moves.
        for (row, (edge, across)) in edges.iter().enumerate() {
            for (k, across) in across.iter().enumerate() {
                let entries = equation(*edge, *across).map(|(unknown, value)| (unknown, root * value));
                system.add(&entries, -multipliers[2 * row + k] / root);
            }
        }
        moves = system.solve()?.chunks_exact(3).map(DVec3::from_slice).collect();
        let mut worst = 0.0_f64;
        for (row, ([a, b], across)) in edges.iter().enumerate() {
            let moved = moves[*b as usize] - moves[*a as usize];
            let length = (mesh.points[*b as usize] - mesh.points[*a as usize]).length() / diagonal;
            for (k, across) in across.iter().enumerate() {
                let off = across.dot(moved);
                multipliers[2 * row + k] += PARALLEL_WEIGHT * off;
                worst = worst.max(off.abs() / length);
            }
        }
        if worst <= PARALLEL_SINE {
            break;
        }
    }
    let points: Vec<DVec3> = mesh.points.iter().zip(&moves).map(|(&point, &moved)| point + diagonal * moved).collect();
    check_finite("points", &points)?;
    Ok(points)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geometry::canal::combescure::{Lengths, combescure};
    use crate::geometry::canal::cyclide::Cyclide;

    #[test]
    fn a_grid_has_as_many_parallel_meshes_as_lengths_and_translations() {
        let cyclide = Cyclide::new();
        for (n, m) in [(2, 3), (4, 4), (5, 3), (9, 7)] {
            let space = ParallelMeshes::of(&cyclide.grid([0.2, 1.8], [-0.6, 1.2], n + 1, m + 1).mesh()).unwrap();
            assert_eq!(space.basis().len(), n + m + 3);
            // The rank is clear: values that count as zero are a million times below the others.
            let values = space.singular_values();
            let rank = 3 * (n + 1) * (m + 1) - (n + m + 3);
            let below = values.get(rank).copied().unwrap_or(0.0);
            assert!(values[rank - 1] > 1e6 * below, "{} {below}", values[rank - 1]);
        }
        // A closed tube too has at least translations and scaling.
        let tube = ParallelMeshes::of(&cyclide.grid([0.0, TAU], [-0.5, 1.0], 7, 4).mesh()).unwrap();
        assert!(tube.basis().len() >= 4);
    }

    #[test]
    fn handles_are_met_by_a_parallel_mesh_and_a_propagated_one_is_in_the_space() {
        let grid = Cyclide::new().grid([0.2, 1.8], [-0.6, 1.2], 4, 5);
        let space = ParallelMeshes::of(&grid.mesh()).unwrap();
        let lengths = Lengths::of(&grid).scaled(&[1.3, 0.8, 1.1], &[0.9, 1.2, 1.0, 0.7]).unwrap();
        let image = combescure(&grid, &lengths, grid.at(0, 0) + DVec3::X).unwrap().grid;
        let all: Vec<(usize, DVec3)> = image.points().iter().copied().enumerate().collect();
        let found = space.nearest(&all).unwrap();
        assert!(found.iter().zip(image.points()).all(|(a, b)| a.distance(*b) < 1e-12));
        let handles = [(0, grid.at(0, 0)), (19, grid.at(3, 4) + DVec3::new(0.1, 0.05, -0.1))];
        let found = space.nearest(&handles).unwrap();
        assert!(handles.iter().all(|&(point, target)| found[point].distance(target) < 1e-12));
        assert!(check_parallel(&grid, &grid.with_points(found).unwrap()).unwrap().largest_sine < 1e-9);
        assert_eq!(space.nearest(&[]).unwrap(), grid.points());
        assert_eq!(space.nearest(&[(20, DVec3::ZERO)]).unwrap_err().place(), "handles[0]");
    }

    #[test]
    fn large_and_closed_meshes_follow_handles_too() {
        let cyclide = Cyclide::new();
        // A small one: as the dense space says, up to the weight of staying.
        let grid = cyclide.grid([0.2, 1.8], [-0.6, 1.2], 4, 5);
        let handles = [(0, grid.at(0, 0)), (19, grid.at(3, 4) + DVec3::new(0.1, 0.05, -0.1)), (4, grid.at(0, 4))];
        let dense = ParallelMeshes::of(&grid.mesh()).unwrap().nearest(&handles).unwrap();
        let sparse = nearest_parallel(&grid.mesh(), &handles).unwrap();
        for (a, b) in dense.iter().zip(&sparse) {
            assert!(a.distance(*b) < 1e-4, "{}", a.distance(*b));
        }
        // A torus of 1600 points, a point of which is pulled.
        let grid = cyclide.grid([0.0, TAU], [0.0, TAU], 40, 40);
        let handles = [(0, grid.at(0, 0)), (820, grid.at(20, 20) + DVec3::new(0.05, 0.0, 0.1))];
        let found = grid.with_points(nearest_parallel(&grid.mesh(), &handles).unwrap()).unwrap();
        let parallel = check_parallel(&grid, &found).unwrap();
        assert!(parallel.largest_sine < 1e-9, "{}", parallel.largest_sine);
        assert!(handles.iter().all(|&(point, target)| found.points()[point].distance(target) < 1e-3));
        assert_eq!(nearest_parallel(&grid.mesh(), &[(1600, DVec3::ZERO)]).unwrap_err().place(), "handles[0]");
    }

    #[test]
    fn reversed_edges_are_counted_and_turned_ones_measured() {
        let grid = Cyclide::new().grid([0.2, 1.8], [-0.6, 1.2], 3, 3);
        let mirrored = grid.with_points(grid.points().iter().map(|point| -*point).collect()).unwrap();
        assert_eq!(check_parallel(&grid, &mirrored).unwrap().reversed_count, 12);
        let (sine, cosine) = 0.2_f64.sin_cos();
        let edges = || std::iter::once([0, 1]);
        let a = [DVec3::ZERO, DVec3::X];
        let turned = check_parallel_edges(&a, &[DVec3::ONE, DVec3::ONE + DVec3::new(cosine, sine, 0.0)], edges());
        assert!((turned.unwrap().largest_sine - sine).abs() < 1e-15);
        assert_eq!(check_parallel_edges(&a, &a[1..], edges()).unwrap_err().place(), "b");
        assert_eq!(check_parallel_edges(&a, &a, std::iter::once([0, 2])).unwrap_err().place(), "edges[0]");
    }
}
