//! Evolutions on surfaces where they are known.

use std::f64::consts::{PI, TAU};

use anyhow::Result;
use shapeop::geometry::snakes::evolution::{Evolution, Options, Stop, Task, Weights};
use shapeop::geometry::snakes::{ArcShape, Pose, Snake, projection};
use shapeop::mesh::ReferenceSurface;
use shapeop::mesh::surfaces::revolution;

use super::{exactly, holds};
use crate::group::Group;
use crate::own::{incongruence, largest, shape_error, stretch};
use crate::shapes::{Ball, circular, cylinder, on, plane, regular, run, screw, small_circle, surface, torus};

/// A snake of six equal arcs that begins on a torus.
pub fn on_torus() -> Result<Snake> {
    let jet = torus(2.0, 0.7)?.at(0.3, 1.0);
    let (x, normal) = (jet.first[0].normalize(), jet.normal());
    let bend = (0.5 * normal.cross(x) - 0.8 * normal).normalize();
    let pose = Pose { point: jet.point, tangent: x, normal: bend };
    Ok(Snake::from_arcs(&[ArcShape { radius: 0.9, length: 0.3 }; 6], &[0.05; 5], &pose)?)
}

fn worst(found: &Evolution, of: impl Fn(&Snake) -> f64) -> f64 {
    largest(found.frames.iter().map(|frame| of(&frame.snake)))
}

fn name(is_second_order: bool) -> &'static str {
    if is_second_order { "second order" } else { "first order" }
}

pub fn shapes_stay() -> Result<Group> {
    let mut group = Group::new(
        "truths: arcs keep their shape over 200 steps (Bartoň et al. 2013, equation 3)",
        "Read from control points at every step; six arcs on the torus 2 / 0.7, and in the plane, where a motion is rigid.",
    );
    let (torus, snake) = (torus(2.0, 0.7)?, on_torus()?);
    for is_second_order in [false, true] {
        let options = Options { step: 0.01, max_steps: 200, is_second_order, ..Options::default() };
        let found = run(&on(&snake, &torus), &options)?;
        let name = name(is_second_order);
        exactly(&mut group, &format!("torus, {name}: positions"), found.frames.len(), 201);
        group.at_most(&format!("torus, {name}: edges and diagonals"), worst(&found, |s| stretch(&snake, s)), 1e-10);
        group.at_most(&format!("torus, {name}: radii and lengths"), worst(&found, |s| shape_error(&snake, s)), 1e-10);
        let moved = found.last().snake.control()[3].distance(snake.control()[3]);
        group.at_least(&format!("torus, {name}: it moves by"), moved, 0.5);
    }
    let (plane, snake) = (plane()?, circular(7, 0.3)?);
    let speeds: Vec<f64> = (0..9).map(|i| 1.0 + 0.1 * f64::from(i)).collect();
    for is_second_order in [false, true] {
        let options = Options { max_steps: 200, is_second_order, ..Options::default() };
        let found = run(&Task { speeds: &speeds, ..on(&snake, &plane) }, &options)?;
        let name = name(is_second_order);
        let height = |s: &Snake| largest(s.control().iter().map(|p| p.z.abs()));
        group.at_most(&format!("plane, {name}: heights"), worst(&found, height), 1e-10);
        let all = worst(&found, |s| incongruence(snake.control(), s.control()));
        group.at_most(&format!("plane, {name}: distances of all points"), all, 1e-10);
        exactly(&mut group, &format!("plane, {name}: positions"), found.frames.len(), 201);
        group.plain(
            &format!("plane, {name}: it moves by"),
            found.last().snake.control()[0].distance(snake.control()[0]),
        );
    }
    Ok(group)
}

pub fn surfaces() -> Result<Group> {
    let mut group = Group::new(
        "truths: a screw on a cylinder, a small circle on a sphere",
        "Motions of a surface into itself: the helical snake moves by a screw motion, the small circle turns.",
    );
    let (cylinder, snake) = (cylinder()?, screw(8, 0.6)?);
    let found = run(&on(&snake, &cylinder), &Options { step: 0.02, max_steps: 200, ..Options::default() })?;
    // By how much points differ from the screw motion that the first one makes: radius, angle, height.
    let off = |now: &Snake| {
        let turn = |k: usize| {
            let (a, b) = (now.control()[k], snake.control()[k]);
            (a.y.atan2(a.x) - b.y.atan2(b.x)).rem_euclid(TAU)
        };
        let rise = |k: usize| now.control()[k].z - snake.control()[k].z;
        let of = |k: usize| {
            let radii = now.control()[k].truncate().length() - snake.control()[k].truncate().length();
            let turned = (turn(k) - turn(0) + PI).rem_euclid(TAU) - PI;
            radii.abs().max(turned.abs()).max((rise(k) - rise(0)).abs())
        };
        largest((0..10).map(of))
    };
    exactly(&mut group, "cylinder: positions", found.frames.len(), 201);
    group.at_most("cylinder: off its own screw motion", worst(&found, off), 1e-6);
    // Arcs of a helix stay within their sagitta of the cylinder.
    let shape = snake.shapes()[0];
    let sagitta = shape.radius * (1.0 - (0.5 * shape.angle_rad()).cos());
    let from_cylinder = |s: &Snake| largest(s.sample(16).iter().map(|p| (p.truncate().length() - 1.0).abs()));
    group.at_most("cylinder: off it, over the sagitta of an arc", worst(&found, from_cylinder) / sagitta, 1.0);
    group.at_least("cylinder: it moves by", found.last().snake.control()[3].distance(snake.control()[3]), 1.0);

    let snake = small_circle(8, 0.6)?;
    for is_second_order in [false, true] {
        let options = Options { step: 0.02, max_steps: 200, is_second_order, ..Options::default() };
        let found = run(&on(&snake, &Ball), &options)?;
        let name = name(is_second_order);
        exactly(&mut group, &format!("sphere, {name}: positions"), found.frames.len(), 201);
        let contacts = |s: &Snake| largest(s.contacts().iter().map(|c| (c.length() - 1.0).abs()));
        group.at_most(&format!("sphere, {name}: contacts off it"), worst(&found, contacts), 1e-8);
        let all = worst(&found, |s| incongruence(snake.control(), s.control()));
        group.at_most(&format!("sphere, {name}: distances of all points"), all, 1e-8);
    }
    // Without heights, contacts leave the sphere by a multiple of the step, where offsets count for little.
    let drift = |step: f64| -> Result<f64> {
        let weights = Weights { offset: 1e-3, ..Weights::default() };
        let projection = projection::Options { surface_weight: 0.0, ..projection::Options::default() };
        let max_steps = (0.4 / step).round() as usize;
        let found = run(&on(&snake, &Ball), &Options { step, max_steps, weights, projection, ..Options::default() })?;
        Ok(largest(found.last().snake.contacts().iter().map(|c| (c.length() - 1.0).abs())))
    };
    group.at_least(
        "sphere, heights left out: order of what contacts are off",
        (drift(0.02)? / drift(0.01)?).log2(),
        1.0,
    );
    Ok(group)
}

pub fn rings() -> Result<Group> {
    let mut group = Group::new(
        "truths: a ring climbs a cylinder and cannot climb a cone",
        "A closed snake of ten arcs; on the cone its length does not fit any other height.",
    );
    let (ring, cylinder) = (regular(10)?, cylinder()?);
    let found = run(&on(&ring, &cylinder), &Options { max_steps: 50, ..Options::default() })?;
    exactly(&mut group, "cylinder: positions", found.frames.len(), 51);
    let all = worst(&found, |s| incongruence(ring.control(), s.control()));
    group.at_most("cylinder: distances of all points", all, 1e-10);
    let heights: Vec<f64> = found.frames.iter().map(|f| f.snake.contacts()[0].z).collect();
    let spacing = heights.windows(2).map(|pair| ((pair[1] - pair[0]).abs() - 0.05).abs());
    group.at_most("cylinder: spacing of positions, off 0.05", largest(spacing), 1e-10);
    let level = |f: &shapeop::geometry::snakes::evolution::Frame| {
        let z: Vec<f64> = f.snake.contacts().iter().map(|c| c.z).collect();
        largest(z.iter().map(|height| (height - z[0]).abs()))
    };
    group.at_most("cylinder: the ring is level to", largest(found.frames.iter().map(level)), 1e-10);

    let cone = surface([[-PI, PI], [-0.9, 5.0]], revolution(|v| [1.0 + 0.4 * v, 0.4, 0.0]))?;
    // The paper's weight of offsets, with which it goes as fast as it is told to.
    let weights = Weights { offset: 0.1, ..Weights::default() };
    let weighted = |surface_weight: f64| {
        let projection = projection::Options { surface_weight, ..projection::Options::default() };
        Options { max_deviation: 0.05, projection, weights, ..Options::default() }
    };
    for (speeds, which) in [([1.0], "one way"), ([-1.0], "the other way")] {
        let task = Task { speeds: &speeds, ..on(&ring, &cone) };
        let kept = run(&task, &weighted(1.0))?;
        let is_held = matches!(kept.stop, Stop::Stalled | Stop::Deviation(_));
        holds(&mut group, &format!("cone, {which}, heights kept: it stops by itself"), is_held);
        let left = run(&task, &weighted(0.0))?;
        holds(&mut group, &format!("cone, {which}: the deviation stops it"), matches!(left.stop, Stop::Deviation(_)));
        group.at_most(&format!("cone, {which}: positions until then"), left.frames.len() as f64, 20.0);
        let off = |s: &Snake| largest(s.contacts().iter().map(|c| cone.nearest(*c).point.distance(*c)));
        group.at_most(&format!("cone, {which}: contacts off it"), worst(&left, off), 0.05);
    }
    Ok(group)
}
