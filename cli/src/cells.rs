//! Violations of hard constraints on faces or edges, for pictures.

use shapeop::constraints::ConstraintId;
use shapeop::mesh::Mesh;
use shapeop::mesh::measure::{Spread, edge_lengths};
use shapeop::problem::Problem;
use shapeop::solver::Solver;

use crate::colours::Scale;
use crate::picture::{On, Overlay, Panel};
use crate::shown::worst_of;

/// The end of the scale, in percent of the mean edge: a millimetre in a metre, which a hard constraint should be far below.
const HIGH_PERCENT: f64 = 0.1;

/// The hard constraints on each face (on each edge, where there are no faces) whose violations are lengths.
pub struct Cells {
    on: On,
    constraints: Vec<Vec<ConstraintId>>,
    mean_edge: f64,
}

impl Cells {
    /// A constraint belongs to every face that has all of its points. `None` if there is none on any.
    pub fn of(problem: &Problem, before: &Mesh, solver: &Solver) -> Option<Self> {
        let edges: Vec<Vec<u32>> = problem.edges.iter().map(|edge| edge.to_vec()).collect();
        let (on, cells) = if problem.faces.is_empty() { (On::Edges, &edges) } else { (On::Faces, &problem.faces) };
        let mut at_point = vec![Vec::new(); problem.points.len()];
        for (cell, points) in cells.iter().enumerate() {
            points.iter().for_each(|&point| at_point[point as usize].push(cell));
        }
        let mut constraints = vec![Vec::new(); cells.len()];
        for id in 0..solver.constraint_count() {
            let Some(view) = solver.constraint(id) else { continue };
            let (true, Some(&first)) =
                (view.is_hard && view.info.violation_unit == "model units", view.indices.first())
            else {
                continue;
            };
            for &cell in &at_point[first as usize] {
                if view.indices.iter().all(|point| cells[cell].contains(point)) {
                    constraints[cell].push(id);
                }
            }
        }
        let lengths = if problem.faces.is_empty() {
            problem.edges.iter().map(|[a, b]| before.points[*a as usize].distance(before.points[*b as usize])).collect()
        } else {
            edge_lengths(before).ok()?
        };
        let mean_edge = Spread::of(&lengths).mean;
        let has_any = mean_edge > 0.0 && constraints.iter().any(|list| !list.is_empty());
        has_any.then_some(Self { on, constraints, mean_edge })
    }

    /// A panel of `mesh` with the largest violation on each face, in percent of the mean edge.
    pub fn panel<'a>(&self, mesh: &'a Mesh, edges: &'a [[u32; 2]], title: String, violations: &[f64]) -> Panel<'a> {
        let largest = |ids: &Vec<ConstraintId>| {
            let all = ids.iter().filter_map(|id| violations.get(*id));
            all.fold(0.0, |most: f64, violation| most.max(100.0 * violation / self.mean_edge))
        };
        let values = self.constraints.iter().map(largest).collect();
        let (on, handles) = (self.on, Vec::new());
        let overlay = Overlay::default();
        let mut panel = Panel { edges, values, on, handles, overlay, ..Panel::new(mesh, title) };
        if let Some((index, words)) = worst_of(&panel) {
            (panel.pointed_at, panel.caption) = (Some(index), words);
        }
        panel
    }

    pub fn scale(&self) -> Scale {
        Scale {
            title: "violation / mean edge".to_owned(),
            unit: "%",
            range: [0.0, HIGH_PERCENT],
            is_diverging: false,
            mark: None,
            end_words: ["", ""],
        }
    }
}
