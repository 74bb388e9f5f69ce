//! Side conditions hold exactly; those that contradict each other are told.

use anyhow::Result;
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::ruled::Joints;
use shapeop::geometry::ruled::conditions::Condition;
use shapeop::geometry::ruled::optimise::{Options, Task};
use shapeop::mesh::curve::End;

use super::strips::{quietly, rows};
use super::{bad_steps, is_refused, largest};
use crate::group::Group;
use crate::shapes::free_form;

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: side conditions",
        "Two strips of the free form: a planar boundary, a fixed end, a fixed direction of the last ruling, a conoid.",
    );
    let shape = free_form(0.1, [1.0, 0.8]);
    let surface = shape.surface()?;
    let cover = shape.mesh(15, 15)?.points;
    let strips = rows(&surface, &[-0.8, 0.0, 0.8], 9, 0.02)?;
    let normal = DVec3::new(0.0, 3.0, 0.1);
    let direction = DVec3::new(0.1, 2.0, -1.0);
    let axis = DVec3::new(1.0, 0.05, 0.1);
    let position = DVec3::new(-1.01, -0.82, 0.7);
    let conditions = vec![
        Condition::PlanarBoundary { strip: 0, side: 1, normal, offset: 0.02 },
        Condition::FixedEnd { strip: 0, side: 0, end: End::Start, position },
        Condition::FixedEndRuling { strip: 0, end: End::Finish, direction },
        Condition::Conoidal { strip: 1, axis },
        Condition::PlanarBoundary { strip: 1, side: 0, normal, offset: 0.02 },
    ];
    let run = |conditions: &[Condition], is_shared| {
        let joints = Joints { is_shared, ..Joints::chain(2) };
        let task = Task { strips: &strips, joints: &joints, reference: &surface, cover: &cover, conditions };
        quietly(task, &Options::default())
    };
    let mut bad = 0;
    for (is_shared, name) in [(false, "two boundaries"), (true, "one boundary")] {
        let found = run(&conditions, is_shared)?;
        bad += bad_steps(&found);
        let [first, second] = [&found.strips[0], &found.strips[1]];
        let off_plane = |points: &[DVec3]| largest(points.iter().map(|p| (p.dot(normal) - 0.02).abs()));
        let along = largest((0..9).map(|i| (second.control(1)[i] - second.control(0)[i]).dot(axis).abs()));
        let turn = (first.control(1)[8] - first.control(0)[8]).cross(direction).length();
        let planes = off_plane(first.control(1)).max(off_plane(second.control(0)));
        let off = planes.max(first.control(0)[0].distance(position)).max(along).max(turn);
        group.at_most(&format!("{name}: side conditions missed by"), off, 1e-10);
    }
    group.at_most("steps without the decrease that Armijo's rule asks", bad as f64, 0.0);
    let contradicting = vec![
        Condition::PlanarBoundary { strip: 0, side: 1, normal: DVec3::Y, offset: 0.0 },
        Condition::PlanarBoundary { strip: 1, side: 0, normal: DVec3::Y, offset: 0.1 },
    ];
    let refused = is_refused(run(&contradicting, true), Status::Infeasible, "conditions[1]");
    group.at_least("one boundary in two parallel planes: refused, by its condition", refused, 1.0);
    let ends = |position: DVec3| Condition::FixedEnd { strip: 0, side: 0, end: End::Start, position };
    let refused = is_refused(run(&[ends(position), ends(-position)], false), Status::Infeasible, "conditions[1]");
    group.at_least("one end at two places: refused, by its condition", refused, 1.0);
    Ok(group)
}
