//! Fig. 10: growing weights of regular faces draw the corners of cubes out of a flat pattern.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::Mesh;
use shapeop::mesh::measure::regularity;
use shapeop::mesh::patterns::rhombille;
use shapeop::problem::Objective;

use super::{EXACT, Kept, Words, picture, scale};
use crate::group::Group;
use crate::session::{Session, irregularity, largest_diagonal_distance};

/// The weights of regular polygons, those of the paper.
const WEIGHTS: [f64; 5] = [0.0, 16.0, 100.0, 400.0, 1600.0];

/// The other weights, so great that those of regular polygons win bit by bit.
const CLOSENESS: f64 = 10.0;
const FAIRNESS: f64 = 30.0;

/// Rhombi with a trace of cubes, over a shallow dome.
fn dome() -> Result<Mesh> {
    let mut mesh = rhombille(7, 6, 1.0, 0.1)?;
    let middle = mesh.points.iter().sum::<DVec3>() / mesh.points.len() as f64;
    let radius = mesh.points.iter().map(|point| point.distance(middle)).fold(0.0, f64::max);
    for point in &mut mesh.points {
        point.z += 0.3 * radius * (1.0 - ((*point - middle) / radius).with_z(0.0).length_squared());
    }
    Ok(mesh)
}

pub fn group(folder: &Path) -> Result<Group> {
    let mesh = dome()?;
    let mut session = Session::new(
        &mesh,
        &Objective { closeness_weight: CLOSENESS, fairness_weight: FAIRNESS, ..Objective::default() },
    )?;
    let bound = 0.01 * session.edge;
    session.add("DiagonalDistance", &mesh.faces, &[bound], 1.0, true)?;
    let regular = session.add("RegularPolygon", &mesh.faces, &[], 1.0, false)?;
    session.solver.init()?;
    let percent = |corners: &[DVec3]| 100.0 * regularity(corners);
    let start = format!("irregularity {:.3}", irregularity(&mesh));
    let mut kept = vec![Kept::faces(&session, "start", percent, &[]).caption(start)];
    let (mut residuals, mut worst) = (Vec::new(), 0.0_f64);
    for weight in WEIGHTS {
        let weights: Vec<_> = regular.iter().map(|&id| (id, weight)).collect();
        session.solver.set_weights(&weights)?;
        session.solve()?;
        let after = session.mesh();
        worst = worst.max((largest_diagonal_distance(&after) - bound) / session.edge);
        residuals.push(irregularity(&after));
        let caption = format!("irregularity {:.4}", residuals[residuals.len() - 1]);
        kept.push(Kept::faces(&session, &format!("weight {weight}"), percent, &[]).caption(caption));
    }
    let rise = residuals.windows(2).map(|pair| pair[1] / pair[0]).fold(0.0, f64::max);
    let mut group = Group::new(
        "Fig. 10: weights of regular faces from 0 to 1600, each from the shape before",
        "A rhombille pattern on a dome; diagonals within 1 % of the mean edge; irregularity: squares of distances from squares.",
    );
    let words = Words {
        title: "Fig. 10: the more weight on regular faces, the more the surface turns into cubes",
        subtitle: "126 rhombi, diagonals within 1 % of an edge; each shape starts from the one before",
        scale: scale("irregularity", "%", 20.0),
    };
    group.picture = Some(picture(folder, "figure10", words, &session.edges, &kept)?);
    group.at_most("diagonals beyond the bound / mean edge, all weights", worst, EXACT);
    for (weight, residual) in WEIGHTS.iter().zip(&residuals) {
        group.plain(&format!("weight {weight}: irregularity"), *residual);
    }
    group.at_most("irregularity over that of the weight before, most", rise, 1.0);
    Ok(group)
}
