//! Fig. 5: planar faces against bounded diagonals, from the same start: the larger space holds the fairer shape.

use std::path::Path;

use anyhow::Result;
use shapeop::mesh::file;
use shapeop::mesh::measure::displacements;
use shapeop::problem::Objective;

use super::{EXACT, Kept, Words, picture, scale};
use crate::group::Group;
use crate::session::{Session, largest_diagonal_distance, largest_plane_distance};

pub fn group(folder: &Path) -> Result<Group> {
    let mesh = file::read("examples/meshes/tubemesh.obj")?;
    let mut session = Session::new(&mesh, &Objective::default())?;
    let planes = session.add("Plane", &session.polygons(), &[], 1.0, true)?;
    session.hold_boundary()?;
    session.solver.init()?;
    let panel = |session: &Session, title: &str, caption: String| -> Result<Kept> {
        let moved = displacements(&mesh.points, session.solver.points())?;
        let mut kept = Kept::faces(session, title, |_| 0.0, &[]).caption(caption);
        let of_face =
            |face: &Vec<u32>| face.iter().map(|&point| moved[point as usize]).sum::<f64>() / face.len() as f64;
        kept.values = mesh.faces.iter().map(|face| 100.0 * of_face(face) / session.edge).collect();
        Ok(kept)
    };
    let start = panel(
        &session,
        "start",
        format!("diagonals {:.3} of an edge apart", largest_diagonal_distance(&mesh) / session.edge),
    )?;
    session.solve()?;
    let planar = session.terms();
    let worst_plane = largest_plane_distance(&session.mesh()) / session.edge;
    let with_planes =
        panel(&session, "hard planes", format!("objective {:.4}, fairness {:.4}", planar.sum(), planar.fairness))?;
    // From the planar shape, in the same session.
    session.remove(&planes)?;
    let bound = 0.01 * session.edge;
    session.add("DiagonalDistance", &session.polygons(), &[bound], 1.0, true)?;
    session.solve()?;
    let bounded = session.terms();
    let excess = (largest_diagonal_distance(&session.mesh()) - bound).max(0.0) / session.edge;
    let with_bounds = panel(
        &session,
        "diagonals within 1 % of an edge",
        format!("objective {:.4}, fairness {:.4}", bounded.sum(), bounded.fairness),
    )?;
    let mut group = Group::new(
        "Fig. 5: planar faces against bounded diagonals",
        "tubemesh, 171 quads; the boundary is held; the second solve starts from the planar shape, in the same session.",
    );
    let words = Words {
        title: "Fig. 5: a little freedom in planarity buys a fairer shape",
        subtitle: "171 quads; the boundary is held; colours: how far the shape moved from the start",
        scale: scale("moved / edge", "%", 50.0),
    };
    group.picture = Some(picture(folder, "figure5", words, &session.edges, &[start, with_planes, with_bounds])?);
    group.at_most("planes: planes / mean edge", worst_plane, EXACT);
    group.at_most("bounded: diagonals beyond the bound / mean edge", excess, EXACT);
    group.plain("planes: objective", planar.sum());
    group.plain("planes: its fairness term", planar.fairness);
    group.plain("bounded: objective", bounded.sum());
    group.plain("bounded: its fairness term", bounded.fairness);
    group.at_most("bounded over planes: objective", bounded.sum() / planar.sum(), 1.0);
    Ok(group)
}
