//! Snakes of many arcs on meshes, and closed ones.

use super::super::super::curvature_curve::{self, Course, Side, curvature_curve};
use super::super::super::fit;
use super::*;
use crate::mesh::Grid;

fn go(_: &crate::linalg::gauss_newton::Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// A torus all around.
fn closed_torus() -> TriangleMesh {
    let (rows, columns) = (120, 60);
    let surface = torus(2.0, 0.7);
    let angle = |i: usize, count: usize| TAU * i as f64 / count as f64;
    let at = |k: usize| surface(angle(k / columns, rows), angle(k % columns, columns)).point;
    let points = (0..rows * columns).map(at).collect();
    TriangleMesh::new(&Grid::new(points, rows, columns, [true, true]).unwrap().mesh()).unwrap()
}

/// Fifty arcs along a curve of constant curvature on the torus, each 0.12 long.
fn long_snake() -> Snake {
    let surface = torus(2.0, 0.7);
    let tangent = surface(0.1, 0.2).normal().cross(DVec3::new(0.3, 0.5, 1.0));
    let course = Course { curvature: &|_| 1.8, length: 6.0, side: Side::Left };
    let options = curvature_curve::Options { steps: 800, ..Default::default() };
    let everywhere = [[f64::NEG_INFINITY, f64::INFINITY]; 2];
    let curve = curvature_curve(&surface, everywhere, [0.1, 0.2], tangent, &course, &options).unwrap().points;
    fit::fit(&curve, 50, &fit::Options::default(), &mut go).unwrap().snake
}

#[test]
fn long_snakes_keep_to_a_mesh() {
    let (mesh, snake) = (closed_torus(), long_snake());
    let mesh = ReferenceMesh::new(&mesh);
    let step = 0.02 * 0.12;
    for (is_second_order, offset, most) in [(false, 1e-3, 5e-3), (true, 1e-3, 5e-3), (false, 0.1, 0.05)] {
        let weights = Weights { offset, ..Weights::default() };
        let options = Options { step, max_steps: 50, is_second_order, weights, ..Options::default() };
        let found = run(&on(&snake, &mesh), &options);
        assert_eq!((found.stop, found.frames.len()), (Stop::Steps, 51), "{offset}");
        assert!(found.last().snake.control()[20].distance(snake.control()[20]) > 0.02, "{offset}");
        for frame in &found.frames {
            assert!(frame.deviation < most, "{offset} {}", frame.deviation);
            assert!(frame.residual < 1e-12 && shape_error(&snake, &frame.snake) < 1e-9);
        }
    }
}

#[test]
fn steps_of_the_second_order_may_be_three_times_as_long() {
    let (mesh, snake) = (closed_torus(), long_snake());
    let (mesh, exact) = (ReferenceMesh::new(&mesh), surface([[-PI, PI]; 2], torus(2.0, 0.7)));
    for (surface, most) in [(&exact as &dyn ReferenceSurface, 0.5), (&mesh, 1.0)] {
        let task = on(&snake, surface);
        let before = |h: f64, is_second_order: bool| {
            let options = Options { is_second_order, ..Options::default() };
            let motion = Motion::new(&task, &options, &[]);
            let state = State { snake: snake.clone(), rails: Vec::new() };
            let rates = motion.velocity(&state).unwrap();
            snake.moved(motion.predict(&state, &rates, h).unwrap()).unwrap().residual()
        };
        for part in [0.005, 0.01, 0.02, 0.05, 0.1] {
            let h = part * 0.12;
            let (first, second) = (before(h, false), before(3.0 * h, true));
            println!("{part}: {first:.2e} {second:.2e} {most}");
            assert!(second < most * first, "{part}: {first} {second}");
        }
    }
}

#[test]
fn closed_snakes_move_though_no_surface_leaves_them_free() {
    let (mesh, surface) = (closed_torus(), torus(2.0, 0.7));
    let mesh = ReferenceMesh::new(&mesh);
    // An oval on the outer side, and a meridian that is not quite one.
    let oval = |t: f64| surface(0.5 * t.cos(), t.sin() + 0.2 * (2.0 * t).cos()).point;
    let meridian = |t: f64| surface(0.3 + 0.05 * t.sin(), t).point;
    for (at, count, way) in [(&oval as &dyn Fn(f64) -> DVec3, 24, 0.005), (&oval, 25, 0.005), (&meridian, 30, 0.2)] {
        let curve: Vec<DVec3> = (0..600).map(|i| at(TAU * f64::from(i) / 600.0)).collect();
        let snake = fit::fit_closed(&curve, count, &fit::Options::default(), &mut go).unwrap().snake;
        let step = 0.02 * snake.length() / count as f64;
        let found = run(&on(&snake, &mesh), &Options { step, max_steps: 60, ..Options::default() });
        assert_eq!(found.stop, Stop::Steps, "{count}");
        let moved = |(a, b): (&DVec3, &DVec3)| a.distance(*b);
        let most = found.last().snake.control().iter().zip(snake.control()).map(moved).fold(0.0, f64::max);
        assert!(most > way, "{count} {most}");
        for frame in &found.frames {
            assert!(frame.deviation < found.frames[0].deviation + 3e-3 && frame.residual < 1e-12);
        }
    }
}
