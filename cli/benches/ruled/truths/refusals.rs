//! What is refused, and by which name.

use std::ops::ControlFlow;

use anyhow::Result;
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::ruled::boundaries::{BoundaryOptions, Drawn, Levels, drawn_boundaries};
use shapeop::geometry::ruled::design::{Design, FieldOptions};
use shapeop::geometry::ruled::level_function::{LevelOptions, LevelWeights};
use shapeop::geometry::ruled::optimise::Options;
use shapeop::geometry::ruled::planar_boundaries::{PlanarOptions, Plane};
use shapeop::geometry::ruled::start::{Rulings, StartOptions, start};
use shapeop::geometry::ruled::terms::Weights;
use shapeop::mesh::reference::ReferenceMesh;

use super::is_refused;
use crate::group::Group;
use crate::shapes::saddle;

pub fn group() -> Result<Group> {
    let mut group = Group::new("truths: what is refused", "1: refused, with the status and the place that say why.");
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    let mesh = saddle().mesh(21, 21)?;
    let field = FieldOptions::default();
    let mut refused = |what: &str, value: f64| group.at_least(what, value, 1.0);

    let mut three = mesh.clone();
    three.points.push(DVec3::new(0.0, 0.0, 1.0));
    three.faces.push(vec![0, 1, 441]);
    three.faces.push(vec![1, 0, 441]);
    refused("mesh: an edge of three faces", is_refused(Design::new(&three, &field), Status::NotManifold, "faces"));
    let mut isolated = mesh.clone();
    isolated.points.push(DVec3::ONE);
    refused(
        "mesh: an isolated vertex",
        is_refused(Design::new(&isolated, &field), Status::InvalidValue, "points[441]"),
    );
    let mut nan = mesh.clone();
    nan.points[7].y = f64::NAN;
    refused("mesh: not a number", is_refused(Design::new(&nan, &field), Status::InvalidValue, "points[7]"));

    let mut design = Design::new(&mesh, &field)?;
    let (function, options) = (LevelOptions::default(), BoundaryOptions::default());
    let levels = |design: &mut Design, levels: Levels| {
        design.set_level_boundaries(&function, &levels, &options, &mut |_| ControlFlow::Continue(()))
    };
    let beyond = levels(&mut design, Levels::Values(vec![0.5, 99.0]));
    refused("levels: one beyond the values", is_refused(beyond, Status::OutOfDomain, "levels[1]"));
    levels(&mut design, Levels::Count(3))?;
    let few = design.start(StartOptions { control_count: 3, ..StartOptions::default() });
    refused(
        "strips: three control points (n < 3)",
        is_refused(few, Status::InvalidArgumentLength, "options.control_count"),
    );
    design.start(StartOptions::default())?;
    let weights = Weights { proximity: 0.0, gap: 0.0, coverage: 0.0, ..Weights::default() };
    let none =
        design.optimise(None, &[], &Options { weights, ..Options::default() }, &mut |_| ControlFlow::Continue(()));
    refused("optimisation: all weights 0", is_refused(none, Status::InvalidValue, "options.weights"));
    let weights = LevelWeights { orthogonal: 0.0, laplace: 0.0, ..LevelWeights::ORTHOGONAL };
    let none =
        design.set_level_boundaries(&LevelOptions { weights, ..function.clone() }, &Levels::Count(3), &options, go_on);
    refused("level function: all weights 0", is_refused(none, Status::InvalidValue, "options.weights"));

    let plane = Plane { normal: DVec3::Y, offset: 3.0 };
    let missed =
        design.set_planar_boundaries(&[Plane { normal: DVec3::Y, offset: 0.1 }, plane], &PlanarOptions::default());
    refused("planes: one that misses the mesh", is_refused(missed, Status::NoIntersection, "planes[1]"));
    let along = Plane { normal: DVec3::Y, offset: 0.0 };
    let strict = PlanarOptions { refuses_oblique: true, ..PlanarOptions::default() };
    let (x, y) = (Plane { normal: DVec3::X, offset: 0.0 }, along);
    let both = [x, y].map(|plane| design.set_planar_boundaries(&[plane], &strict).err().map(|error| error.status()));
    let along = both.iter().filter(|status| **status == Some(Status::Infeasible)).count();
    refused("planes: one along the field", f64::from(along == 1));

    let line: Vec<DVec3> = (-10..=10).map(|k| DVec3::new(0.1 * f64::from(k), -0.2, -0.02 * f64::from(k))).collect();
    let point = vec![DVec3::Y];
    let one = start(&[line.clone(), point.clone()], &[false; 2], Rulings::Proportional, StartOptions::default());
    refused("strips: a boundary of one point", is_refused(one, Status::InvalidArgumentLength, "boundaries[1]"));
    let drawn = [line, point].map(|points| Drawn { points, is_closed: false });
    let one = drawn_boundaries(&ReferenceMesh::new(design.mesh()), design.field(), &drawn, &options);
    refused("drawn boundaries: one of one point", is_refused(one, Status::InvalidArgumentLength, "curves[1].points"));
    Ok(group)
}
