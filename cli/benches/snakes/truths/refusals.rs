//! What is refused and by which name, and why evolutions end.

use std::ops::ControlFlow;

use anyhow::Result;
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::snakes::curvature_curve::{self, Course, Side, curvature_curve};
use shapeop::geometry::snakes::evolution::{Options, Progress, Stop, Task, Weights, evolve};
use shapeop::geometry::snakes::mesh_curve::mesh_curve;
use shapeop::geometry::snakes::rails::Rail;
use shapeop::geometry::snakes::{ArcShape, Pose, Snake, projection};
use shapeop::mesh::TriangleMesh;
use shapeop::mesh::curve::{Curve, Spline};
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::surfaces::graph;

use super::{holds, is_refused};
use crate::group::Group;
use crate::shapes::{Ball, circular, on, open_snake, plane, regular, run};

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: what is refused, and why evolutions end",
        "1: refused, or ended, with the status and the place that say why.",
    );
    let mut is_so = |what: &str, is_true: bool| holds(&mut group, what, is_true);
    let new = |points: &[[f64; 3]], is_closed| {
        Snake::new(points.iter().map(|p| DVec3::from_array(*p)).collect(), is_closed, None)
    };
    let bent = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    is_so(
        "two control points: InvalidArgumentLength",
        is_refused(new(&bent, false), Status::InvalidArgumentLength, "control"),
    );
    let twice = [bent[0], bent[1], bent[1], [1.0, 1.0, 0.0]];
    is_so("a control point twice: InvalidValue", is_refused(new(&twice, false), Status::InvalidValue, "control[1]"));
    let short = [bent[0], bent[1], [1.0, 0.5, 0.0], [0.0, 0.5, 0.0]];
    is_so("no tangent length left: InvalidValue", is_refused(new(&short, false), Status::InvalidValue, "control[2]"));
    let unequal = [bent[0], bent[1], [1.0, 2.5, 0.0], [0.0, 2.5, 0.3]];
    is_so("ends that do not fit: InvalidValue", is_refused(new(&unequal, false), Status::InvalidValue, "control[3]"));
    let nan = [bent[0], bent[1], [f64::NAN, 1.0, 0.0]];
    is_so("not a number: InvalidValue", is_refused(new(&nan, false), Status::InvalidValue, "control[2]"));
    let straight = [bent[0], bent[1], [2.0, 0.0, 0.0]];
    is_so("a straight arc: Degenerate", is_refused(new(&straight, false), Status::Degenerate, "control[1]"));
    let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
    let half = Snake::from_arcs(&[ArcShape { radius: 1.0, length: 3.2 }], &[], &pose);
    is_so("an arc of more than half a circle: InvalidValue", is_refused(half, Status::InvalidValue, "arcs[0]"));

    let (snake, plain) = (circular(5, 0.3)?, Options::default());
    let plane = plane()?;
    let call = |task: &Task<'_>, options: &Options| evolve(task, options, &mut |_| ControlFlow::Continue(()));
    let rigid = regular(5)?;
    is_so(
        "five arcs, closed: InvalidArgumentLength",
        is_refused(call(&on(&rigid, &Ball), &plain), Status::InvalidArgumentLength, "snake"),
    );
    let negative = Options { weights: Weights { offset: -1.0, ..plain.weights }, ..plain };
    is_so(
        "a negative weight: InvalidValue",
        is_refused(call(&on(&snake, &plane), &negative), Status::InvalidValue, "options.weights.offset"),
    );
    let none = Weights { tangential: 0.0, offset: 0.0, rotation: 0.0, orthogonal: 0.0 };
    let none = call(&on(&snake, &plane), &Options { weights: none, ..plain });
    is_so("all weights 0: InvalidValue", is_refused(none, Status::InvalidValue, "options.weights"));
    let mu = projection::Options { mu: 0.0, ..plain.projection };
    let call_mu = call(&on(&snake, &plane), &Options { projection: mu, ..plain });
    is_so("µ of 0: InvalidValue", is_refused(call_mu, Status::InvalidValue, "options.projection.mu"));

    // A rail shorter than the motion; two of unequal length; one that does not begin on the snake; one along it.
    let arch = open_snake(6, 21)?;
    let (first, last) = (arch.control()[0], arch.control()[7]);
    let line = |from: DVec3, length: f64| Spline::through(&[from, from + length * DVec3::new(0.1, 0.9, 0.2)], false);
    let (short, long) = (line(first, 0.5)?, line(last, 1.4)?);
    let driven = |point, curve| Rail::Driven { point, curve, start: 0.0, speed: 1.0 };
    let rotation = Options { weights: Weights { offset: 0.0, rotation: 10.0, ..plain.weights }, ..plain };
    let rails = [driven(0, &short)];
    let found = run(&Task { rails: &rails, ..Task::new(&arch) }, &rotation)?;
    is_so(
        "a rail shorter than the motion: RailEnd",
        matches!(found.stop, Stop::RailEnd { rail: 0, distance } if distance == 0.0),
    );
    let rails = [driven(7, &long), driven(0, &short)];
    let found = run(&Task { rails: &rails, ..Task::new(&arch) }, &rotation)?;
    let is_first = matches!(found.stop, Stop::RailEnd { rail: 1, .. });
    is_so("two rails: it ends with the shorter one", is_first && (found.last().time - short.range()[1]).abs() < 1e-9);
    let off = line(first + 0.01 * DVec3::X, 1.0)?;
    let rails = [driven(0, &off)];
    let error = call(&Task { rails: &rails, ..Task::new(&arch) }, &plain).err();
    let tells = error.is_some_and(|e| {
        (e.status(), e.place()) == (Status::InvalidValue, "rails[0]") && e.to_string().contains("0.01")
    });
    is_so("a rail beside the snake: InvalidValue, with the distance", tells);
    let tangent = arch.arcs()[0].tangent(0.0);
    let along = Spline::through(&[first, first + tangent], false)?;
    let rails = [Rail::Gliding { contact: 0, curve: &along, start: 0.0 }];
    let call_along = call(&Task { rails: &rails, ..Task::new(&arch) }, &plain);
    is_so("a gliding rail along the snake: Degenerate", is_refused(call_along, Status::Degenerate, "rails[0]"));

    let cancel = &mut |progress: &Progress<'_>| {
        if progress.step == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let found = evolve(&on(&snake, &plane), &plain, cancel)?;
    is_so("cancelled: it has its positions so far", found.stop == Stop::Cancelled && found.frames.len() == 4);
    // Ends held as far apart as the snake is long: no step leads on.
    let target = arch.control()[7] + DVec3::new(50.0, 0.0, 0.0);
    let away = Spline::through(&[last, target], false)?;
    let rails = [driven(7, &away)];
    let found = run(
        &Task { rails: &rails, fixed: &[0], ..Task::new(&arch) },
        &Options { max_steps: 1000, step: 0.2, ..rotation },
    )?;
    is_so("pulled out straight: Stalled or Singular", matches!(found.stop, Stop::Stalled | Stop::Singular));

    let square = crate::shapes::surface([[0.0, 1.0]; 2], graph(|_, _| [0.0; 6]))?;
    let mesh = TriangleMesh::new(&square.mesh(12, 9)?)?;
    let course = |kappa: &'static dyn Fn(f64) -> f64| Course { curvature: kappa, length: 0.5, side: Side::Left };
    let options = curvature_curve::Options::default();
    let far = mesh_curve(&ReferenceMesh::new(&mesh), DVec3::new(0.5, 0.5, 1.0), DVec3::X, &course(&|_| 0.5), &options);
    is_so("a start off the mesh: OutOfDomain", is_refused(far, Status::OutOfDomain, "start"));
    let flat = graph(|_, _| [0.0; 6]);
    let negative = curvature_curve(&flat, [[-1.0, 1.0]; 2], [0.0; 2], DVec3::X, &course(&|_| -1.0), &options);
    is_so("a negative curvature: InvalidValue", is_refused(negative, Status::InvalidValue, "course.curvature"));
    let none = curvature_curve(&flat, [[-1.0, 1.0]; 2], [0.0; 2], DVec3::Z, &course(&|_| 1.0), &options);
    is_so("no tangent: InvalidValue", is_refused(none, Status::InvalidValue, "tangent"));
    Ok(group)
}
