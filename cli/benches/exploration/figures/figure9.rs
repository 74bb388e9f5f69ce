//! Fig. 9: two handles inside a surface dragged under bounded diagonals.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::patterns::translation_surface;
use shapeop::problem::Objective;
use shapeop_cli::colours::Scale;

use super::{EXACT, Kept, Words, picture, scale};
use crate::group::Group;
use crate::session::{Session, diagonal_distance, largest_diagonal_distance};

/// Points along a side, and where the handles are: rows and columns.
const SIDE: usize = 25;
const HANDLES: [[usize; 2]; 2] = [[8, 8], [16, 15]];

/// Where the two are drawn to, in mean edges from their places.
const POSITIONS: [(&str, [DVec3; 2]); 3] = [
    ("one up", [DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO]),
    ("one up, one down", [DVec3::new(0.0, 0.0, 3.0), DVec3::new(0.0, 0.0, -3.0)]),
    ("and aside", [DVec3::new(1.5, -1.0, 3.0), DVec3::new(-1.0, 1.5, -3.0)]),
];

/// The largest distance of a handle from its target over how far it is drawn.
const NEAR: f64 = 0.05;

pub fn group(folder: &Path) -> Result<Group> {
    let mesh = translation_surface(SIDE)?;
    let mut session = Session::new(&mesh, &Objective::default())?;
    let bound = 0.01 * session.edge;
    session.add("DiagonalDistance", &mesh.faces, &[bound], 1.0, true)?;
    session.hold_boundary()?;
    session.solver.init()?;
    let handles = HANDLES.map(|[row, column]| (row * SIDE + column) as u32);
    let share = 100.0 / session.edge;
    let diagonals = |corners: &[DVec3]| share * diagonal_distance(corners);
    let mut kept = vec![Kept::faces(&session, "start: planar", diagonals, &[])];
    let (mut worst, mut pull) = (0.0_f64, 0.0_f64);
    for (title, to) in POSITIONS {
        handles.iter().zip(to).try_for_each(|(&point, to)| session.pull(point, to))?;
        session.solve()?;
        let apart = largest_diagonal_distance(&session.mesh());
        worst = worst.max((apart - bound) / session.edge);
        let far = to.iter().map(|to| to.length()).fold(0.0, f64::max);
        pull = pull.max(session.largest_pull() / far);
        let caption = format!("diagonals at most {:.4} % of an edge apart", share * apart);
        kept.push(Kept::faces(&session, title, diagonals, &handles).caption(caption));
    }
    let mut group = Group::new(
        "Fig. 9: two handles dragged under bounded diagonals",
        "A translation surface of 25 × 25 points; the boundary is held; diagonals within 1 % of the mean edge.",
    );
    let words = Words {
        title: "Fig. 9: two handles dragged, diagonals within 1 % of an edge",
        subtitle: "A planar surface of 24 × 24 quads; the boundary is held; blue: the handles",
        scale: Scale { mark: Some((1.0, "bound".to_owned())), ..scale("diagonals / edge", "%", 2.0) },
    };
    group.picture = Some(picture(folder, "figure9", words, &session.edges, &kept)?);
    group.at_most("diagonals beyond the bound / mean edge, all positions", worst, EXACT);
    group.at_most("handles off their targets over how far they are drawn", pull, NEAR);
    Ok(group)
}
