//! What solutions do when weights change: derivatives against central differences of solutions, on three problems.

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::Mesh;
use shapeop::mesh::patterns::{translation_surface, tri_hex};
use shapeop::problem::Objective;

use crate::group::Group;
use crate::session::Session;

/// How far derivatives may be from differences, relative.
const ERROR: f64 = 1e-5;

/// A problem of hard and soft constraints, with handles.
struct Case {
    name: &'static str,
    mesh: Mesh,
    /// On all polygons, or all edges where it is about edges, with its bounds in mean edges.
    hard: (&'static str, &'static [f64]),
    /// On all polygons, with its weight.
    soft: (&'static str, f64),
    /// Points that are held; empty: the boundary.
    held: &'static [u32],
    /// The point that is drawn away, and by how many mean edges.
    pull: (u32, DVec3),
    /// Of the logarithm of weights: so long that what solutions leave undecided does not count, so short that no bound comes or goes.
    step: f64,
}

fn cases() -> Result<[Case; 3]> {
    let mut dome = tri_hex(4, 4, 1.0)?;
    for point in &mut dome.points {
        point.z = 0.2 * point.x * (0.5 * point.y).sin();
    }
    Ok([
        Case {
            name: "hard planes, soft regular polygons",
            mesh: translation_surface(7)?,
            hard: ("Plane", &[]),
            soft: ("RegularPolygon", 0.3),
            held: &[0, 6, 42, 48],
            pull: (24, DVec3::new(0.1, 0.0, 0.5)),
            step: 0.04,
        },
        Case {
            name: "hard diagonals, soft regular polygons",
            mesh: translation_surface(9)?,
            hard: ("DiagonalDistance", &[0.01]),
            soft: ("RegularPolygon", 0.3),
            held: &[],
            pull: (40, DVec3::new(0.0, 0.1, 0.6)),
            step: 4e-3,
        },
        Case {
            name: "hard edge lengths, soft planes",
            mesh: dome,
            hard: ("EdgeLength", &[0.97, 1.03]),
            soft: ("Plane", 2.0),
            held: &[],
            pull: (20, DVec3::new(0.2, 0.0, 0.8)),
            step: 1e-3,
        },
    ])
}

impl Case {
    /// The solution with weights times these: of handles, closeness, fairness and the soft constraints.
    fn solution(&self, factors: [f64; 4]) -> Result<Session> {
        let weights = Objective::default();
        let objective = Objective {
            // Heavy handles hardly answer to their weight.
            handle_weight: factors[0] * 5.0,
            closeness_weight: factors[1] * weights.closeness_weight,
            fairness_weight: factors[2] * weights.fairness_weight,
            tolerance: 1e-14,
            ..weights
        };
        let mut session = Session::new(&self.mesh, &objective)?;
        let (hard, bounds) = self.hard;
        let on = if hard == "EdgeLength" { session.edge_lists() } else { session.polygons() };
        let bounds: Vec<f64> = bounds.iter().map(|bound| bound * session.edge).collect();
        session.add(hard, &on, &bounds, 1.0, true)?;
        let (soft, weight) = self.soft;
        session.add(soft, &session.polygons(), &[], factors[3] * weight, false)?;
        match self.held {
            [] => session.hold_boundary()?,
            held => held.iter().try_for_each(|&point| session.pull(point, DVec3::ZERO))?,
        }
        session.pull(self.pull.0, self.pull.1)?;
        session.solver.init()?;
        session.solve()?;
        Ok(session)
    }
}

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "sensitivities against central differences of solutions",
        "d points / d ln weight over all points, relative, the worst class of weights; handles weigh 5. Surfaces of 7 × 7 and 9 × 9 points, a\n\
         tri-hex mesh of 4 × 4 hexagons.",
    );
    for case in cases()? {
        let mut session = case.solution([1.0; 4])?;
        let found = session.solver.sensitivities()?;
        let mut worst = 0.0_f64;
        for (class, moved) in found.points.iter().enumerate() {
            let at = |step: f64| -> Result<Vec<DVec3>> {
                let mut factors = [1.0; 4];
                factors[class] = step.exp();
                Ok(case.solution(factors)?.solver.points().to_vec())
            };
            let step = case.step;
            let [plus, minus, plus_2, minus_2] = [at(step)?, at(-step)?, at(2.0 * step)?, at(-2.0 * step)?];
            let slope = |i: usize| (8.0 * (plus[i] - minus[i]) - (plus_2[i] - minus_2[i])) / (12.0 * step);
            let size = moved.iter().map(|d| d.length_squared()).sum::<f64>().sqrt();
            let error = (0..moved.len()).map(|i| slope(i).distance_squared(moved[i])).sum::<f64>().sqrt();
            worst = worst.max(error / size);
        }
        group.at_most(&format!("{}, {} classes", case.name, found.classes.len()), worst, ERROR);
    }
    Ok(group)
}
