//! Milliseconds per step.

use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::curvature_curve::{self, Course, Side};
use shapeop::geometry::snakes::evolution::{Evolution, Options, Weights, evolve};
use shapeop::geometry::snakes::fit::{self, fit};
use shapeop::geometry::snakes::mesh_curve::mesh_curve;
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Grid, ReferenceSurface, TriangleMesh, surfaces};

use crate::group::Group;
use crate::own::{largest, shape_error};
use crate::shapes::{on, torus};

const ARCS: usize = 50;

/// The paper's, which has a higher weight of speeds.
const PAPERS: f64 = 0.1;

/// The torus 2 / 0.7 as a closed mesh of 50 000 triangles.
fn mesh() -> Result<TriangleMesh> {
    let (rows, columns) = (125, 200);
    let ring = surfaces::torus(2.0, 0.7);
    let at = |k: usize| {
        let part = |i: usize, count: usize| std::f64::consts::TAU * i as f64 / count as f64;
        ring(part(k / columns, rows), part(k % columns, columns)).point
    };
    let points = (0..rows * columns).map(at).collect();
    Ok(TriangleMesh::new(&Grid::new(points, rows, columns, [true, true])?.mesh())?)
}

/// Fifty arcs along a curve of curvature 1.8.
fn snake(reference: &ReferenceMesh<'_>) -> Result<Snake> {
    let jet = surfaces::torus(2.0, 0.7)(0.1, 0.2);
    let tangent = jet.normal().cross(DVec3::new(0.3, 0.5, 1.0));
    let course = Course { curvature: &|_| 1.8, length: 7.5, side: Side::Left };
    let steps = curvature_curve::Options { steps: 1600, ..curvature_curve::Options::default() };
    let curve = mesh_curve(reference, jet.point, tangent, &course, &steps)?.curve;
    Ok(fit(&curve.points, ARCS, &fit::Options::default(), &mut |_| ControlFlow::Continue(()))?.snake)
}

/// An evolution with the milliseconds of each step.
fn timed(snake: &Snake, surface: &dyn ReferenceSurface, options: &Options) -> Result<(Evolution, f64)> {
    let mut stamps: Vec<Instant> = Vec::with_capacity(options.max_steps + 1);
    let found = evolve(&on(snake, surface), options, &mut |_| {
        stamps.push(Instant::now());
        ControlFlow::Continue(())
    })?;
    let all: Vec<f64> = stamps.windows(2).map(|pair| 1e3 * (pair[1] - pair[0]).as_secs_f64()).collect();
    anyhow::ensure!(!all.is_empty(), "no steps: {:?}", found.stop);
    Ok((found, median(all)))
}

fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

fn on_mesh() -> Result<Group> {
    let mut group = Group::new(
        "speed: a snake of 50 arcs on a closed mesh of 50 000 triangles",
        "The torus 2 / 0.7; 1000 steps of 0.02 of an arc's length, sideways.",
    );
    let mesh = mesh()?;
    let reference = ReferenceMesh::new(&mesh);
    let snake = snake(&reference)?;
    let h = 0.02 * snake.shapes()[0].length;
    let first = Options { step: h, max_steps: 1000, ..Options::default() };
    group.plain("triangles", mesh.triangles().len() as f64);
    group.plain("length of an arc", snake.shapes()[0].length);
    let second = Options { step: 3.0 * h, max_steps: 333, is_second_order: true, ..first };
    let mut before = [0.0; 2];
    for (name, options) in [("first order", first), ("second order, steps three times as large", second)] {
        let (found, took) = timed(&snake, &reference, &options)?;
        let steps = found.frames.len() - 1;
        group.between(&format!("{name}: steps"), steps as f64, [options.max_steps as f64; 2]);
        before[usize::from(options.is_second_order)] =
            median(found.frames[1..].iter().map(|frame| frame.predicted_residual).collect());
        let worst = largest(found.frames.iter().map(|frame| shape_error(&snake, &frame.snake)));
        group.at_most(&format!("{name}: radii and lengths"), worst, 1e-10);
        group.plain(&format!("{name}: time run through"), found.last().time);
        let off = |p: DVec3| (p.truncate().length() - 2.0).hypot(p.z) - 0.7;
        let from_torus = found.frames.iter().flat_map(|f| f.snake.sample(4)).map(|p| off(p).abs());
        group.plain(&format!("{name}: from the mesh, largest"), largest(found.frames.iter().map(|f| f.deviation)));
        group.plain(&format!("{name}: from the torus itself, largest"), largest(from_torus));
        let moved = found.last().snake.control()[25].distance(snake.control()[25]);
        group.plain(&format!("{name}: the middle has moved by"), moved);
        if options.is_second_order {
            group.plain(&format!("{name}: milliseconds a step, median"), took);
            group.plain(&format!("{name}: the same, for the time of a first order step"), took / 3.0);
        } else {
            group.at_most(&format!("{name}: milliseconds a step, median"), took, 10.0);
        }
    }
    let [one, three] = before;
    group.plain("distances off before the projection, first order, median", one);
    group.plain("the same, second order, steps three times as large", three);
    group.at_most("second order over first order", three / one, 1.0);
    let weights = Weights { offset: PAPERS, ..Weights::default() };
    let (found, took) = timed(&snake, &reference, &Options { weights, ..first })?;
    group.plain("the paper's weight of speeds, first order: steps", (found.frames.len() - 1) as f64);
    group.plain("the same: from the mesh, largest", largest(found.frames.iter().map(|f| f.deviation)));
    group.plain("the same: milliseconds a step, median", took);
    Ok(group)
}

fn on_formula() -> Result<Group> {
    let mut group = Group::new(
        "speed: a snake of 50 arcs on a surface given by a formula",
        "The torus 2 / 0.7; 200 steps of 0.02 of an arc's length, sideways.",
    );
    let mesh = mesh()?;
    let snake = snake(&ReferenceMesh::new(&mesh))?;
    let (ring, h) = (torus(2.0, 0.7)?, 0.02 * snake.shapes()[0].length);
    let (found, took) = timed(&snake, &ring, &Options { step: h, max_steps: 200, ..Options::default() })?;
    group.between("steps", (found.frames.len() - 1) as f64, [200.0; 2]);
    group.at_most("milliseconds a step, median", took, 2.0);
    group.plain("from the torus, largest", largest(found.frames.iter().map(|f| f.deviation)));
    Ok(group)
}

pub fn groups() -> Result<Vec<Group>> {
    Ok(vec![on_mesh()?, on_formula()?])
}
