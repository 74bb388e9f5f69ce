//! Fig. 8: the space of shapes is switched in mid-session, from soft regular faces to hard bounds of their angles.

use std::path::Path;

use anyhow::Result;
use shapeop::mesh::{Mesh, file};
use shapeop::problem::Objective;

use super::{EXACT, Kept, Words, picture, scale};
use crate::group::Group;
use crate::session::{Session, irregularity, largest, largest_plane_distance, outside_60_to_120};

/// The weight of regular polygons.
const REGULAR: f64 = 1.0;

/// How near the bounds of angles must be met, in degrees.
const EXACT_DEGREES: f64 = 1e-6;

pub fn group(folder: &Path) -> Result<Group> {
    let name = std::env::var("F8").unwrap_or("botanic-garden-bubble-0".into());
    let mesh = file::read(format!("examples/meshes/{name}.obj"))?;
    let initial = {
        let mut session = Session::new(&mesh, &Objective::default())?;
        session.add("Plane", &session.polygons(), &[], 1.0, true)?;
        session.hold_boundary()?;
        session.solver.init()?;
        session.solve()?;
        session.mesh()
    };
    let mut session = Session::new(&initial, &Objective::default())?;
    session.add("Plane", &session.polygons(), &[], 1.0, true)?;
    session.hold_boundary()?;
    session.solver.init()?;
    let edge = session.edge;
    let angle = |mesh: &Mesh| largest(mesh, outside_60_to_120);
    let caption = |mesh: &Mesh| {
        let count = mesh.faces.iter().filter(|face| outside_60_to_120(&mesh.corners(face)) > EXACT_DEGREES).count();
        format!("{count} faces outside, worst by {:.1}°; irregularity {:.2}", angle(mesh), irregularity(mesh))
    };
    let start = Kept::faces(&session, "start: planar", outside_60_to_120, &[]).caption(caption(&initial));
    let regular = session.add("RegularPolygon", &session.polygons(), &[], REGULAR, false)?;
    let r = session.solve()?;
    eprintln!("{:?} {:?}", r.outcome, session.solver.found());
    let with_regular = session.mesh();
    let second = Kept::faces(&session, "soft regular faces", outside_60_to_120, &[]).caption(caption(&with_regular));
    session.remove(&regular)?;
    let bounds = [60_f64.to_radians(), 120_f64.to_radians()];
    session.add("BoundedAngle", &session.corner_lists(), &bounds, 1.0, true)?;
    let r = session.solve()?;
    eprintln!("{:?} {:?}", r.outcome, session.solver.found().map(|f| (f.sweeps, f.newton_steps, f.largest_violation, f.capped, f.is_solution, f.residuals)));
    let with_bounds = session.mesh();
    let third = Kept::faces(&session, "hard angles, 60° to 120°", outside_60_to_120, &[]).caption(caption(&with_bounds));
    let mut group = Group::new(
        "Fig. 8: from soft regular faces to hard bounds of angles, in one session",
        "botanic-garden-bubble-0 made planar, 1076 quads; hard planes throughout, the boundary is held.",
    );
    let words = Words {
        title: "Fig. 8: another space of shapes in mid-session: regular faces give way to bounded angles",
        subtitle: "1076 quads, exactly planar in all three; the boundary is held",
        scale: scale("angles outside", "°", 10.0),
    };
    group.picture = Some(picture(folder, "figure8", words, &session.edges, &[start, second, third])?);
    let worst = [&with_regular, &with_bounds].map(|mesh| largest_plane_distance(mesh) / edge);
    group.at_most("planes / mean edge, both", worst[0].max(worst[1]), EXACT);
    group.plain("start: angles outside 60° to 120°, in degrees", angle(&initial));
    group.plain("regular: angles outside, in degrees", angle(&with_regular));
    group.at_most("bounded: angles outside, in degrees", angle(&with_bounds), EXACT_DEGREES);
    group.at_most("regular over start: irregularity", irregularity(&with_regular) / irregularity(&initial), 1.0);
    Ok(group)
}
