//! Fig. 8: the space of shapes is switched in mid-session, from soft regular faces to hard bounds of their angles.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::Mesh;
use shapeop::problem::Objective;

use super::{EXACT, Kept, Words, picture, scale};
use crate::group::Group;
use crate::session::{Session, irregularity, largest, largest_plane_distance, outside_60_to_120};

/// The weight of regular polygons.
const REGULAR: f64 = 1.0;

/// How near the bounds of angles must be met, in degrees.
const EXACT_DEGREES: f64 = 1e-6;

/// Angles at the middle, where five patches of `SIDE` × `SIDE` quads meet: one is too sharp.
const SECTORS_DEGREES: [f64; 5] = [50.0, 77.5, 77.5, 77.5, 77.5];
const SIDE: usize = 7;

/// The angle between the boundary and a spoke, and the height of the dome over the length of a spoke.
const AT_SPOKES_DEGREES: f64 = 105.0;
const HEIGHT: f64 = 0.3;

/// Five patches around a point, lifted to a dome: quads that are not planar.
fn dome() -> Mesh {
    let spoke = |i: usize| {
        let turn: f64 = SECTORS_DEGREES[..i].iter().sum();
        DVec3::new(turn.to_radians().cos(), turn.to_radians().sin(), 0.0)
    };
    // Middle; along the spokes; inside the patches.
    let count = SECTORS_DEGREES.len();
    let index = |i: usize, u: usize, v: usize| match (u, v) {
        (0, 0) => 0,
        (u, 0) => 1 + i * SIDE + u - 1,
        (0, v) => 1 + (i + 1) % count * SIDE + v - 1,
        (u, v) => 1 + count * SIDE + (i * SIDE + u - 1) * SIDE + v - 1,
    };
    let mut mesh = Mesh { points: vec![DVec3::ZERO; 1 + count * SIDE * (SIDE + 1)], faces: Vec::new() };
    for (i, sector) in SECTORS_DEGREES.iter().enumerate() {
        let [first, last] = [spoke(i), spoke(i + 1)];
        // The outer corner, by the sine rule in the half of the patch.
        let half = 0.5 * sector.to_radians();
        let at_spoke = AT_SPOKES_DEGREES.to_radians();
        let corner = (first + last).normalize() * at_spoke.sin() / (half + at_spoke).sin();
        for (u, v) in (0..=SIDE).flat_map(|u| (0..=SIDE).map(move |v| (u, v))) {
            let [a, b] = [u, v].map(|step| step as f64 / SIDE as f64);
            let flat = a * (1.0 - b) * first + b * (1.0 - a) * last + a * b * corner;
            let point = flat.with_z(-HEIGHT * flat.length_squared());
            mesh.points[index(i, u, v)] = SIDE as f64 * point;
            if u < SIDE && v < SIDE {
                let face = [(u, v), (u + 1, v), (u + 1, v + 1), (u, v + 1)];
                mesh.faces.push(face.map(|(u, v)| index(i, u, v) as u32).to_vec());
            }
        }
    }
    mesh
}

/// The dome made planar.
fn initial() -> Result<Mesh> {
    let mut session = Session::new(&dome(), &Objective::default())?;
    session.add("Plane", &session.polygons(), &[], 1.0, true)?;
    session.solver.init()?;
    session.solve()?;
    Ok(session.mesh())
}

pub fn group(folder: &Path) -> Result<Group> {
    let initial = initial()?;
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
    session.solve()?;
    let with_regular = session.mesh();
    let second = Kept::faces(&session, "soft regular faces", outside_60_to_120, &[]).caption(caption(&with_regular));
    session.remove(&regular)?;
    let bounds = [60_f64.to_radians(), 120_f64.to_radians()];
    session.add("BoundedAngle", &session.corner_lists(), &bounds, 1.0, true)?;
    session.solve()?;
    let with_bounds = session.mesh();
    let third =
        Kept::faces(&session, "hard angles, 60° to 120°", outside_60_to_120, &[]).caption(caption(&with_bounds));
    let mut group = Group::new(
        "Fig. 8: from soft regular faces to hard bounds of angles, in one session",
        "A dome of five patches, 245 quads, made planar first; hard planes throughout, the boundary is held.",
    );
    let words = Words {
        title: "Fig. 8: another space of shapes in mid-session: regular faces give way to bounded angles",
        subtitle: "245 quads, exactly planar in all three; the boundary is held",
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
