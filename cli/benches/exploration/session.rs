//! A mesh that is explored, and what is said of it from its coordinates alone.

use std::ops::ControlFlow;

use anyhow::Result;
use glam::DVec3;
use shapeop::constraints::{ConstraintId, NewConstraints};
use shapeop::mesh::fit::fitting_regular_polygon;
use shapeop::mesh::measure::{corner_angles_rad, plane_distance};
use shapeop::mesh::{Mesh, Topology};
use shapeop::problem::{Fairness, FairnessRows, Objective};
use shapeop::solver::{Report, SolveOptions, Solver};

/// Sweeps at most: where they end a solve, the figures show it.
const MOST_SWEEPS: u32 = 5000;

/// A solver with the mesh that it began with.
pub struct Session {
    pub solver: Solver,
    pub start: Mesh,
    pub edges: Vec<[u32; 2]>,
    boundary: Vec<u32>,
    /// The mean edge of the start.
    pub edge: f64,
}

/// The terms of the objective, each with its weight and its ½.
#[derive(Clone, Copy, Debug, Default)]
pub struct Terms {
    pub handles: f64,
    pub closeness: f64,
    pub fairness: f64,
}

impl Terms {
    pub fn sum(&self) -> f64 {
        self.handles + self.closeness + self.fairness
    }
}

impl Session {
    /// A session without constraints or handles. Differences are taken along the polylines of the faces.
    pub fn new(start: &Mesh, objective: &Objective) -> Result<Self> {
        let mut solver = Solver::new();
        solver.set_points(&start.points)?;
        let topology = Topology::new(start)?;
        let edges = topology.edges().to_vec();
        let boundary = (0..).zip(topology.boundary_points()).filter_map(|(i, is_on)| is_on.then_some(i)).collect();
        let rows = match objective.fairness {
            Fairness::Laplacian => FairnessRows::laplacian(start.points.len(), &edges),
            kind => FairnessRows::differences(&shapeop::mesh::polylines(start)?, kind),
        };
        solver.set_objective(objective, rows)?;
        let mut session = Self { solver, start: start.clone(), edges, boundary, edge: 1.0 };
        session.edge = session.lengths().iter().sum::<f64>() / session.edges.len() as f64;
        Ok(session)
    }

    /// The lengths of the edges as they stand.
    pub fn lengths(&self) -> Vec<f64> {
        let points = self.solver.points();
        self.edges.iter().map(|[a, b]| points[*a as usize].distance(points[*b as usize])).collect()
    }

    /// Constraints of one type on the points listed, all with the same scalars and weight.
    pub fn add(
        &mut self,
        type_name: &str,
        on: &[Vec<u32>],
        scalars: &[f64],
        weight: f64,
        is_hard: bool,
    ) -> Result<Vec<ConstraintId>> {
        let counts: Vec<usize> = on.iter().map(Vec::len).collect();
        let scalar_counts: &[usize] = if scalars.is_empty() { &[] } else { &[scalars.len()] };
        let (indices, weights) = (&on.concat(), &[weight]);
        let new = NewConstraints { type_name, indices, counts: &counts, weights, scalars, scalar_counts };
        let first = self.solver.add_constraints(new)?;
        let ids: Vec<ConstraintId> = (first..first + on.len()).collect();
        self.solver.set_hard(&ids, is_hard)?;
        Ok(ids)
    }

    pub fn remove(&mut self, ids: &[ConstraintId]) -> Result<()> {
        Ok(ids.iter().try_for_each(|id| self.solver.remove_constraint(*id))?)
    }

    /// The faces of more than three corners.
    pub fn polygons(&self) -> Vec<Vec<u32>> {
        self.start.faces.iter().filter(|face| face.len() > 3).cloned().collect()
    }

    /// The edges as lists of their ends.
    pub fn edge_lists(&self) -> Vec<Vec<u32>> {
        self.edges.iter().map(|edge| edge.to_vec()).collect()
    }

    /// Every corner of every face with its two neighbours, as the types that bound angles take them.
    pub fn corner_lists(&self) -> Vec<Vec<u32>> {
        let of_face = |face: &Vec<u32>| {
            let k = face.len();
            (0..k).map(|i| vec![face[i], face[(i + 1) % k], face[(i + k - 1) % k]]).collect::<Vec<_>>()
        };
        self.start.faces.iter().flat_map(of_face).collect()
    }

    /// Makes the boundary points handles where they are.
    pub fn hold_boundary(&mut self) -> Result<()> {
        Ok(self.boundary.iter().try_for_each(|i| self.solver.set_handle(*i, self.start.points[*i as usize]))?)
    }

    /// Draws a point to where it was at the start plus so many mean edges.
    pub fn pull(&mut self, point: u32, edges: DVec3) -> Result<()> {
        Ok(self.solver.set_handle(point, self.start.points[point as usize] + self.edge * edges)?)
    }

    /// Solves to the end.
    pub fn solve(&mut self) -> Result<Report> {
        let options = SolveOptions { max_iterations: MOST_SWEEPS, ..SolveOptions::default() };
        Ok(self.solver.solve_until(&options, &mut |_| ControlFlow::Continue(()))?)
    }

    /// The mesh as it stands.
    pub fn mesh(&self) -> Mesh {
        Mesh { points: self.solver.points().to_vec(), faces: self.start.faces.clone() }
    }

    /// The objective without soft constraints, from coordinates and rows alone.
    pub fn terms(&self) -> Terms {
        let (points, weights, start) = (self.solver.points(), self.solver.objective(), &self.start.points);
        let mut terms = Terms::default();
        let mut is_free = vec![true; points.len()];
        for (point, target) in self.solver.handles() {
            is_free[point as usize] = false;
            terms.handles += 0.5 * weights.handle_weight * points[point as usize].distance_squared(target);
        }
        for i in (0..points.len()).filter(|i| is_free[*i]) {
            terms.closeness += 0.5 * weights.closeness_weight * points[i].distance_squared(start[i]);
        }
        for row in self.solver.fairness_rows().iter() {
            let bent: DVec3 = row.iter().map(|&(i, a)| a * (points[i as usize] - start[i as usize])).sum();
            terms.fairness += 0.5 * weights.fairness_weight * bent.length_squared();
        }
        terms
    }

    /// How far points are from the targets of their handles at most, over the mean edge.
    pub fn largest_pull(&self) -> f64 {
        let points = self.solver.points();
        let pulls = self.solver.handles().map(|(point, target)| points[point as usize].distance(target));
        pulls.fold(0.0, f64::max) / self.edge
    }
}

/// The largest of a measure of faces.
pub fn largest(mesh: &Mesh, measure: impl Fn(&[DVec3]) -> f64) -> f64 {
    mesh.faces.iter().map(|face| measure(&mesh.corners(face))).fold(0.0, f64::max)
}

/// The largest distance of a corner from the best-fit plane of its face, in model units.
pub fn largest_plane_distance(mesh: &Mesh) -> f64 {
    largest(mesh, plane_distance)
}

/// The largest distance of the lines of a quad's diagonals, in model units.
pub fn largest_diagonal_distance(mesh: &Mesh) -> f64 {
    largest(mesh, diagonal_distance)
}

/// The distance of the lines of a quad's diagonals; 0 for other polygons.
pub fn diagonal_distance(corners: &[DVec3]) -> f64 {
    let &[a, b, c, d] = corners else { return 0.0 };
    (c - a).cross(d - b).try_normalize().map_or(0.0, |normal| normal.dot(b - a).abs())
}

/// The squares of the distances of all corners from the best-fit regular polygons of their faces.
pub fn irregularity(mesh: &Mesh) -> f64 {
    let of_face = |face: &Vec<u32>| {
        let corners = mesh.corners(face);
        let fitted = fitting_regular_polygon(&corners);
        corners.iter().zip(&fitted).map(|(corner, fitted)| corner.distance_squared(*fitted)).sum::<f64>()
    };
    mesh.faces.iter().map(of_face).sum()
}

/// How far the angles of a polygon are outside 60 to 120 degrees at most, in degrees.
pub fn outside_60_to_120(corners: &[DVec3]) -> f64 {
    let beyond = |angle: f64| (60.0 - angle).max(angle - 120.0).max(0.0);
    corner_angles_rad(corners).into_iter().map(|angle| beyond(angle.to_degrees())).fold(0.0, f64::max)
}
