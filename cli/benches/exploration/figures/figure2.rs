//! Fig. 2: a mesh of hexagons made planar with soft and with hard constraints.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::measure::plane_distance;
use shapeop::mesh::{Mesh, file};
use shapeop::problem::Objective;

use super::{EXACT, Kept, Words, picture, scale};
use crate::group::Group;
use crate::session::{Session, largest_plane_distance};

/// The weight of soft planes: as that of handles.
const SOFT: f64 = 100.0;

/// How much better hard planes must be than soft ones.
const BETTER: f64 = 1e3;

fn planarised(mesh: &Mesh, is_hard: bool) -> Result<Session> {
    let mut session = Session::new(mesh, &Objective::default())?;
    session.add("Plane", &session.polygons(), &[], if is_hard { 1.0 } else { SOFT }, is_hard)?;
    session.hold_boundary()?;
    session.solver.init()?;
    session.solve()?;
    Ok(session)
}

pub fn group(folder: &Path) -> Result<Group> {
    let mesh = file::read("examples/meshes/hex_mesh_welded.obj")?;
    let start = Session::new(&mesh, &Objective::default())?;
    let [soft, hard] = [planarised(&mesh, false)?, planarised(&mesh, true)?];
    let plane = |corners: &[DVec3]| 100.0 * plane_distance(corners) / start.edge;
    let worst = |session: &Session| largest_plane_distance(&session.mesh()) / start.edge;
    let mut group = Group::new(
        "Fig. 2: hexagons planarised with soft and with hard planes",
        "hex_mesh_welded, 199 hexagons; the boundary is held; soft planes have weight 100, as the handles.",
    );
    let panels = [("start", &start), ("soft planes", &soft), ("hard planes", &hard)];
    let kept = panels.map(|(title, session)| {
        Kept::faces(session, title, plane, &[]).caption(format!("worst {:.1e} of an edge", worst(session)))
    });
    let words = Words {
        title: "Fig. 2: soft constraints nearly planarise, hard ones do",
        subtitle: "199 hexagons; the boundary is held; soft planes have the weight of the handles",
        scale: scale("from plane / edge", "%", 1.0),
    };
    group.picture = Some(picture(folder, "figure2", words, &start.edges, &kept)?);
    group.plain("start: planes / mean edge", worst(&start));
    group.plain("soft: planes / mean edge", worst(&soft));
    group.at_most("hard: planes / mean edge", worst(&hard), EXACT);
    group.at_least("soft over hard", worst(&soft) / worst(&hard), BETTER);
    Ok(group)
}
