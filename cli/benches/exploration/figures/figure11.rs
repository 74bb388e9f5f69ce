//! Fig. 11: a planar mesh under bounds of its edges, and then drawn to regular faces too, in one session.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::mesh::patterns::translation_surface;
use shapeop::problem::Objective;
use shapeop_cli::colours::Scale;

use super::{EXACT, Kept, Words, picture};
use crate::group::Group;
use crate::session::{Session, irregularity, largest_plane_distance};

/// Points along a side.
const SIDE: usize = 17;

/// How far an edge may be from the mean of the start, as a share of it.
const RANGE: f64 = 0.05;

/// How far the middle is lifted, in mean edges.
const LIFT: f64 = 2.0;

/// The weight of regular polygons.
const REGULAR: f64 = 10.0;

pub fn group(folder: &Path) -> Result<Group> {
    let mesh = translation_surface(SIDE)?;
    let mut session = Session::new(&mesh, &Objective::default())?;
    session.add("Plane", &mesh.faces, &[], 1.0, true)?;
    let middle = (SIDE * SIDE / 2) as u32;
    let corners = [0, SIDE - 1, SIDE * (SIDE - 1), SIDE * SIDE - 1].map(|corner| corner as u32);
    let shown = [&corners[..], &[middle]].concat();
    corners.iter().try_for_each(|&corner| session.pull(corner, DVec3::ZERO))?;
    session.pull(middle, LIFT * DVec3::Z)?;
    session.solver.init()?;
    let edge = session.edge;
    let percent = |length: f64| 100.0 * (length / edge - 1.0);
    let range = |session: &Session| {
        let all = session.lengths();
        let ends = |low: f64, high: f64| [low / edge, high / edge];
        ends(all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(0.0, f64::max))
    };
    let caption = |session: &Session| {
        let [low, high] = range(session);
        format!("edges {low:.3} to {high:.3}; irregularity {:.2}", irregularity(&session.mesh()))
    };
    let first =
        Kept::edges(&session, "start: planar, and where it is drawn to", percent, &shown).caption(caption(&session));
    let edges = session.edge_lists();
    session.add("EdgeLength", &edges, &[edge * (1.0 - RANGE), edge * (1.0 + RANGE)], 1.0, true)?;
    let (mut panels, mut excess, mut worst, mut irregular) = (vec![first], 0.0_f64, 0.0_f64, Vec::new());
    for title in ["hard edge lengths", "and soft regular faces"] {
        if panels.len() == 2 {
            session.add("RegularPolygon", &mesh.faces, &[], REGULAR, false)?;
        }
        session.solve()?;
        let [low, high] = range(&session);
        excess = excess.max(1.0 - RANGE - low).max(high - 1.0 - RANGE);
        worst = worst.max(largest_plane_distance(&session.mesh()) / edge);
        irregular.push(irregularity(&session.mesh()));
        panels.push(Kept::edges(&session, title, percent, &shown).caption(caption(&session)));
    }
    let mut group = Group::new(
        "Fig. 11: bounds of edge lengths, then regular faces too, in one session",
        "A planar translation surface of 17 × 17 points, hard planes throughout; its corners are held, its middle is lifted.",
    );
    let words = Words {
        title: "Fig. 11: a planar mesh with edges within 5 % of one length, then with regular faces too",
        subtitle: "16 × 16 quads, exactly planar in all three; blue: the handles, rings: where they are drawn to",
        scale: Scale {
            title: "length / mean − 1".to_owned(),
            unit: "%",
            range: [-10.0, 10.0],
            is_diverging: true,
            mark: None,
            end_words: ["longer", "shorter"],
        },
    };
    group.picture = Some(picture(folder, "figure11", words, &session.edges, &panels)?);
    group.at_most("planes / mean edge, both", worst, EXACT);
    group.at_most("lengths beyond their bounds / mean edge, both", excess, EXACT);
    group.plain("lengths alone: irregularity", irregular[0]);
    group.plain("with regular faces: irregularity", irregular[1]);
    group.at_most("with regular faces over without", irregular[1] / irregular[0], 1.0);
    Ok(group)
}
