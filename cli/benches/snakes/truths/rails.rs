//! Rails.

use anyhow::Result;
use glam::{DMat3, DVec3};
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::evolution::{Direction, Options, Stop, Task, Weights};
use shapeop::geometry::snakes::rails::Rail;
use shapeop::mesh::curve::{Curve, FnCurve, Spline};

use super::holds;
use crate::group::Group;
use crate::own::{from_polyline, largest, procrustes, shape_error};
use crate::shapes::{circular, on, open_snake, plane, run};

/// The orbit of a point under rotations about the z axis with a rise for each radian.
pub fn orbit(point: DVec3, rise: f64, angle: f64) -> Result<FnCurve<impl Fn(f64) -> [DVec3; 3]>> {
    let (radius, start) = (point.x.hypot(point.y), point.y.atan2(point.x));
    Ok(FnCurve::new([0.0, angle], false, move |t: f64| {
        let (sine, cosine) = (start + t).sin_cos();
        let (out, around) = (DVec3::new(cosine, sine, 0.0), DVec3::new(-sine, cosine, 0.0));
        [radius * out + (point.z + rise * t) * DVec3::Z, radius * around + rise * DVec3::Z, -radius * out]
    })?)
}

fn arch() -> Result<Snake> {
    let snake = open_snake(6, 21)?;
    Ok(Snake::new(snake.control().iter().map(|p| *p + 6.0 * DVec3::X).collect(), false, None)?)
}

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: rails (Bartoň et al. 2013, examples 4.1 and 4.2)",
        "Ends on rails at a constant distance and one inner rail make a kinematic surface, all of whose snakes are congruent: that\n\
         of a rotation, and of a screw motion. A second inner rail that does not fit bends the snake. A snake glides on a line.",
    );
    let (snake, weights) = (arch()?, Weights { offset: 0.0, rotation: 10.0, ..Weights::default() });
    let kept = Options { max_steps: 60, keeps_torsions: true, weights, ..Options::default() };
    for (rise, name) in [(0.0, "rotation"), (0.7, "screw motion")] {
        let (first, last) = (orbit(snake.control()[0], rise, 1.5)?, orbit(snake.control()[7], rise, 1.5)?);
        let inner = orbit(snake.contacts()[3], rise, 2.0)?;
        let rails = [
            Rail::Driven { point: 0, curve: &first, start: 0.0, speed: 1.0 },
            Rail::Following { point: 7, curve: &last, start: 0.0, leader: 0 },
            Rail::Gliding { contact: 3, curve: &inner, start: 0.0 },
        ];
        let found = run(&Task { rails: &rails, ..Task::new(&snake) }, &kept)?;
        holds(
            &mut group,
            &format!("{name}: it goes to the rail's end"),
            matches!(found.stop, Stop::RailEnd { rail: 0, .. }),
        );
        let rms = largest(found.frames.iter().map(|f| procrustes(snake.control(), f.snake.control())));
        group.at_most(&format!("{name}: root mean square off congruence"), rms, 1e-6);
        // The motion itself.
        let off = found.frames.iter().flat_map(|frame| {
            let (turn, up) = (DMat3::from_rotation_z(frame.time), rise * frame.time * DVec3::Z);
            let pairs: Vec<f64> =
                snake.control().iter().zip(frame.snake.control()).map(|(p, q)| (turn * *p + up).distance(*q)).collect();
            pairs
        });
        group.at_most(&format!("{name}: off the motion itself"), largest(off), 1e-5);
    }
    let contacts = snake.contacts();
    let (first, last) = (orbit(snake.control()[0], 0.0, 1.5)?, orbit(snake.control()[7], 0.0, 1.5)?);
    let (inner, other) = (orbit(contacts[2], 0.0, 2.0)?, orbit(contacts[4], 0.4, 2.0)?);
    let rails = [
        Rail::Driven { point: 0, curve: &first, start: 0.0, speed: 1.0 },
        Rail::Following { point: 7, curve: &last, start: 0.0, leader: 0 },
        Rail::Gliding { contact: 2, curve: &inner, start: 0.0 },
        Rail::Gliding { contact: 4, curve: &other, start: 0.0 },
    ];
    let found = run(&Task { rails: &rails, ..Task::new(&snake) }, &Options { max_steps: 10, ..kept })?;
    let bent = procrustes(snake.control(), found.last().snake.control());
    group.at_least("a second inner rail: root mean square off congruence", bent, 1e-3);
    group.at_most("a second inner rail: radii and lengths", shape_error(&snake, &found.last().snake), 1e-10);

    let (snake, plane) = (circular(6, 0.2)?, plane()?);
    let contact = snake.contacts()[3];
    let line = Spline::through(&[contact, contact + DVec3::new(3.0, 0.4, 0.0)], false)?;
    let rails = [Rail::Gliding { contact: 3, curve: &line, start: 0.0 }];
    let task = Task { rails: &rails, direction: Direction::Along(DVec3::X), ..on(&snake, &plane) };
    let found = run(&task, &Options { max_steps: 50, ..Options::default() })?;
    let gap = |frame: &shapeop::geometry::snakes::evolution::Frame| {
        from_polyline(line.point(frame.rails[0].parameter), &frame.snake.sample(2000))
    };
    group.at_most(
        "gliding on a line: snake and rail apart by, in a polyline",
        largest(found.frames.iter().map(gap)),
        1e-6,
    );
    group.at_least("gliding on a line: positions", found.frames.len() as f64, 21.0);
    // How far the point of the arc that met the rail leaves the plane of both tangents in a step: by the square of it.
    let space =
        Spline::through(&[contact, contact + DVec3::new(0.5, 0.2, 0.7), contact + DVec3::new(0.6, 0.5, 1.6)], false)?;
    let out = |step: f64| -> Result<[f64; 2]> {
        let rails = [Rail::Gliding { contact: 3, curve: &space, start: 0.0 }];
        let task = Task { rails: &rails, direction: Direction::Along(DVec3::new(0.3, 0.1, 1.0)), ..Task::new(&snake) };
        let found = run(&task, &Options { step, max_steps: 1, ..Options::default() })?;
        let normal = snake.arcs()[3].tangent(0.0).cross(space.tangent(0.0)).normalize();
        let way = found.last().snake.contacts()[3] - contact;
        Ok([way.dot(normal).abs(), way.length()])
    };
    let [[coarse, way], [fine, _]] = [out(0.005)?, out(0.0025)?];
    group.plain("gliding in space: out of the plane over the way", coarse / way);
    group.between("gliding in space: order by which it leaves the plane", (coarse / fine).log2(), [1.8, 2.2]);
    Ok(group)
}
