//! Fig. 1: triangles and hexagons, exactly planar and as regular as that allows, dragged in the middle.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::Mesh;
use shapeop::mesh::measure::{plane_distance, regularity};
use shapeop::mesh::patterns::tri_hex;
use shapeop::problem::Objective;

use super::{EXACT, Kept, Words, picture, scale};
use crate::group::Group;
use crate::session::{Session, irregularity, largest_plane_distance};

/// Less than usual, so that a drag makes a wide hill.
const CLOSENESS: f64 = 0.01;

/// The weight of regular polygons.
const REGULAR: f64 = 1.0;

/// Where the middle is drawn to, in mean edges from its place.
const POSITIONS: [(&str, DVec3); 3] = [
    ("at rest: planar", DVec3::ZERO),
    ("dragged up", DVec3::new(0.0, 0.0, 2.0)),
    ("dragged up and aside", DVec3::new(1.5, 0.5, 1.5)),
];

/// A dome with a wave over 9 × 9 hexagons: few of them are planar.
fn dome() -> Result<Mesh> {
    let mut mesh = tri_hex(9, 9, 1.0)?;
    let middle = mesh.points.iter().sum::<DVec3>() / mesh.points.len() as f64;
    let radius = mesh.points.iter().map(|point| point.distance(middle)).fold(0.0, f64::max);
    for point in &mut mesh.points {
        let away = (*point - middle) / radius;
        point.z = radius * (0.45 * (1.0 - away.length_squared()) + 0.04 * (5.0 * away.x).sin() * (4.0 * away.y).cos());
    }
    Ok(mesh)
}

/// The corners of the hexagon nearest to the middle.
fn middle_of(mesh: &Mesh) -> Vec<u32> {
    let middle = mesh.points.iter().sum::<DVec3>() / mesh.points.len() as f64;
    let away = |face: &Vec<u32>| {
        let corners = mesh.corners(face);
        (corners.iter().sum::<DVec3>() / corners.len() as f64 - middle).with_z(0.0).length()
    };
    let hexagons = mesh.faces.iter().filter(|face| face.len() == 6);
    hexagons.min_by(|a, b| away(a).total_cmp(&away(b))).cloned().unwrap_or_default()
}

fn session(mesh: &Mesh, is_regular: bool) -> Result<Session> {
    let mut session = Session::new(mesh, &Objective { closeness_weight: CLOSENESS, ..Objective::default() })?;
    session.add("Plane", &session.polygons(), &[], 1.0, true)?;
    if is_regular {
        session.add("RegularPolygon", &mesh.faces, &[], REGULAR, false)?;
    }
    session.hold_boundary()?;
    session.solver.init()?;
    Ok(session)
}

pub fn group(folder: &Path) -> Result<Group> {
    let mesh = dome()?;
    let middle = middle_of(&mesh);
    let mut with = session(&mesh, true)?;
    let mut without = session(&mesh, false)?;
    let share = 100.0 / with.edge;
    let plane = |corners: &[DVec3]| share * plane_distance(corners);
    let caption = |mesh: &Mesh| {
        let all = mesh.faces.iter().map(|face| regularity(&mesh.corners(face)));
        let mean = 100.0 * all.sum::<f64>() / mesh.faces.len() as f64;
        format!("planar to {:.1e} of an edge; irregularity {mean:.1} %", largest_plane_distance(mesh) * share / 100.0)
    };
    let mut kept = vec![Kept::faces(&with, "start", plane, &[]).caption(caption(&mesh))];
    let (mut worst, mut most, mut pull) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (title, to) in POSITIONS {
        for session in [&mut with, &mut without] {
            middle.iter().try_for_each(|&point| session.pull(point, to))?;
            session.solve()?;
        }
        worst = worst.max(largest_plane_distance(&with.mesh()) / with.edge);
        most = most.max(irregularity(&with.mesh()) / irregularity(&without.mesh()));
        pull = pull.max(with.largest_pull());
        let caption = caption(&with.mesh());
        kept.push(Kept::faces(&with, title, plane, &middle).caption(caption));
    }
    let mut group = Group::new(
        "Fig. 1: triangles and hexagons, hard planar faces, soft regular polygons",
        "The boundary is held, the six corners of the middle hexagon are dragged.",
    );
    let words = Words {
        title: "Fig. 1: planar faces, as regular as that allows, while the middle is dragged",
        subtitle: "9 × 9 hexagons with triangles; hard planar faces, soft regular polygons; the boundary is held, blue is dragged",
        scale: scale("from plane / edge", "%", 1.0),
    };
    group.picture = Some(picture(folder, "figure1", words, &with.edges, &kept)?);
    group.plain("start: planes / mean edge", largest_plane_distance(&mesh) / with.edge);
    group.at_most("planes / mean edge, all positions", worst, EXACT);
    group.at_most("irregularity with regular polygons over that without", most, 1.0);
    group.plain("handles off their targets / mean edge", pull);
    Ok(group)
}
