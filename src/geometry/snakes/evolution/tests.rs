use std::f64::consts::{PI, TAU};

use super::super::motion::{Motion, State};
use super::super::tests::{circular, incongruence, regular};
use super::super::{ArcShape, Pose};
use super::*;
use crate::mesh::TriangleMesh;
use crate::mesh::reference::{ParametricSurface, ReferenceMesh, SurfaceFoot, SurfaceJet};
use crate::mesh::surfaces::{cylinder, graph, revolution, torus};

type Formula = Box<dyn Fn(f64, f64) -> SurfaceJet + Sync>;

pub fn surface(
    ranges: [[f64; 2]; 2],
    function: impl Fn(f64, f64) -> SurfaceJet + Sync + 'static,
) -> ParametricSurface<Formula> {
    ParametricSurface::new(ranges, [65, 65], Box::new(function) as Formula).unwrap()
}

fn plane() -> ParametricSurface<Formula> {
    surface([[-50.0, 50.0]; 2], graph(|_, _| [0.0; 6]))
}

/// The unit sphere about the origin, poles and all.
struct Ball;

impl ReferenceSurface for Ball {
    fn nearest(&self, point: DVec3) -> SurfaceFoot {
        let normal = point.normalize();
        SurfaceFoot { point: normal, normal, overhang: 0.0 }
    }

    fn diagonal(&self) -> f64 {
        12.0_f64.sqrt()
    }
}

pub fn run(task: &Task<'_>, options: &Options) -> Evolution {
    evolve(task, options, &mut |_| ControlFlow::Continue(())).unwrap()
}

fn on<'a>(snake: &'a Snake, surface: &'a dyn ReferenceSurface) -> Task<'a> {
    Task { surface: Some(surface), direction: Direction::Sideways, ..Task::new(snake) }
}

/// By how much radii and arc lengths read from the control points differ from those of the start.
pub fn shape_error(start: &Snake, now: &Snake) -> f64 {
    let first = start
        .is_closed()
        .then(|| start.shapes()[0].tangent_length())
        .filter(|_| start.shapes().len().is_multiple_of(2));
    let read = Snake::new(now.control().to_vec(), now.is_closed(), first).unwrap();
    let pairs = read.shapes().iter().zip(start.shapes());
    pairs.map(|(a, b)| (a.radius - b.radius).abs().max((a.length - b.length).abs())).fold(0.0, f64::max)
}

/// Part of the small circle of the unit sphere at the height 0.6, of arcs of 0.25 radians.
fn small_circle(count: usize) -> Snake {
    let flat = circular(count, 0.25);
    Snake::new(flat.control().iter().map(|p| 0.8 * p + 0.6 * DVec3::Z).collect(), false, None).unwrap()
}

fn screw(count: usize, slope: f64) -> Snake {
    // Control points on a helix of radius 1, equally spaced; the ends in the middles of edges, so that all arcs are congruent.
    let at = |i: f64| DVec3::new((0.3 * i).cos(), (0.3 * i).sin(), 0.3 * slope * i);
    let mut control: Vec<DVec3> = (0..count + 2).map(|i| at(i as f64)).collect();
    control[0] = 0.5 * (at(0.0) + at(1.0));
    control[count + 1] = 0.5 * (at(count as f64) + at(count as f64 + 1.0));
    Snake::new(control, false, None).unwrap()
}

#[test]
fn arcs_keep_their_shape_over_many_steps() {
    let torus = surface([[-PI, PI], [-PI, PI]], torus(2.0, 0.7));
    let arcs = [ArcShape { radius: 0.9, length: 0.3 }; 6];
    let jet = torus.at(0.3, 1.0);
    let (x, normal) = (jet.first[0].normalize(), jet.normal());
    let bend = (0.5 * normal.cross(x) - 0.8 * normal).normalize();
    let pose = Pose { point: jet.point, tangent: x, normal: bend };
    let snake = Snake::from_arcs(&arcs, &[0.05; 5], &pose).unwrap();
    for is_second_order in [false, true] {
        let options = Options { step: 0.01, max_steps: 200, is_second_order, ..Options::default() };
        let found = run(&on(&snake, &torus), &options);
        assert_eq!((found.frames.len(), found.stop), (201, Stop::Steps));
        assert!(found.last().snake.control()[3].distance(snake.control()[3]) > 0.5);
        for frame in &found.frames {
            assert!(frame.snake.residual() < 1e-12 && shape_error(&snake, &frame.snake) < 1e-10);
        }
    }
}

#[test]
fn in_a_plane_motions_are_rigid() {
    let plane = plane();
    let snake = circular(7, 0.3);
    let speeds: Vec<f64> = (0..9).map(|i| 1.0 + 0.1 * f64::from(i)).collect();
    for is_second_order in [false, true] {
        let options = Options { max_steps: 60, is_second_order, ..Options::default() };
        let found = run(&Task { speeds: &speeds, ..on(&snake, &plane) }, &options);
        assert_eq!(found.stop, Stop::Steps);
        for frame in &found.frames {
            assert!(frame.snake.control().iter().all(|p| p.z.abs() < 1e-10));
            assert!(incongruence(frame.snake.control(), snake.control()) < 1e-10);
        }
        assert!(found.last().snake.control()[0].distance(snake.control()[0]) > 1.0);
    }
}

#[test]
fn on_a_cylinder_a_screw_moves_into_itself() {
    let cylinder = surface([[-PI, PI], [-20.0, 20.0]], cylinder(1.0));
    let snake = screw(8, 0.6);
    let found = run(&on(&snake, &cylinder), &Options { step: 0.02, max_steps: 200, ..Options::default() });
    assert_eq!(found.frames.len(), 201);
    let cylindrical = |p: DVec3| (p.x.hypot(p.y), p.y.atan2(p.x), p.z);
    for frame in &found.frames {
        let pairs: Vec<_> = frame
            .snake
            .control()
            .iter()
            .zip(snake.control())
            .map(|(a, b)| (cylindrical(*a), cylindrical(*b)))
            .collect();
        let turn = |pair: &((f64, f64, f64), (f64, f64, f64))| (pair.0.1 - pair.1.1).rem_euclid(TAU);
        let rise = |pair: &((f64, f64, f64), (f64, f64, f64))| pair.0.2 - pair.1.2;
        for pair in &pairs {
            let turned = (turn(pair) - turn(&pairs[0]) + PI).rem_euclid(TAU) - PI;
            assert!((pair.0.0 - pair.1.0).abs() < 1e-10, "radius");
            assert!(turned.abs() < 1e-6 && (rise(pair) - rise(&pairs[0])).abs() < 1e-6, "{turned}");
        }
        assert!((frame.deviation - found.frames[0].deviation).abs() < 1e-6);
    }
    let apart = found.last().snake.control()[3].distance(snake.control()[3]);
    assert!(apart > 1.0, "{apart}");
}

#[test]
fn on_a_sphere_a_small_circle_turns_rigidly() {
    let sphere = Ball;
    let snake = small_circle(8);
    for is_second_order in [false, true] {
        let options = Options { step: 0.02, max_steps: 40, is_second_order, ..Options::default() };
        let found = run(&on(&snake, &sphere), &options);
        assert_eq!(found.stop, Stop::Steps);
        for frame in &found.frames {
            let off = frame.snake.contacts().iter().map(|c| (c.length() - 1.0).abs()).fold(0.0, f64::max);
            assert!(off < 1e-8 && frame.deviation < 1e-8, "{off}");
            assert!(incongruence(frame.snake.control(), snake.control()) < 1e-8);
        }
        assert!(found.last().snake.control()[4].distance(snake.control()[4]) > 0.3);
    }
    // Where heights do not count, contacts leave the sphere by a multiple of the step, unless offsets hardly count.
    let drift = |step: f64| {
        let weights = Weights { offset: 1e-3, ..Weights::default() };
        let projection = projection::Options { surface_weight: 0.0, ..projection::Options::default() };
        let max_steps = (0.4 / step) as usize;
        let found = run(&on(&snake, &sphere), &Options { step, max_steps, weights, projection, ..Options::default() });
        found.last().deviation
    };
    let (coarse, fine) = (drift(0.04), drift(0.02));
    assert!((coarse / fine).log2() > 0.9, "{coarse} {fine}");
}

/// The largest error of a distance before the projection, after a step of this time on the torus.
fn error_before(h: f64, is_second_order: bool) -> f64 {
    let torus = surface([[-PI, PI], [-PI, PI]], torus(2.0, 0.7));
    let snake = screw(6, 0.4);
    let snake = Snake::new(snake.control().iter().map(|p| 0.9 * *p + 1.9 * DVec3::X).collect(), false, None).unwrap();
    let task = on(&snake, &torus);
    let options = Options { is_second_order, ..Options::default() };
    let motion = Motion::new(&task, &options, &[]);
    let state = State { snake: snake.clone(), rails: Vec::new() };
    let rates = motion.velocity(&state).unwrap();
    snake.moved(motion.predict(&state, &rates, h).unwrap()).unwrap().residual()
}

#[test]
fn orders_are_two_and_three() {
    for (is_second_order, order) in [(false, 2.0), (true, 3.0)] {
        let slope = (error_before(0.02, is_second_order) / error_before(0.01, is_second_order)).log2();
        assert!((slope - order).abs() < 0.2, "{slope}");
    }
    // Steps of three times the length leave no more errors.
    assert!(error_before(0.06, true) < error_before(0.02, false));
}

#[test]
fn accelerations_do_not_grow_as_steps_shrink() {
    let (sphere, snake) = (Ball, small_circle(8));
    let task = on(&snake, &sphere);
    let options = Options { is_second_order: true, ..Options::default() };
    let motion = Motion::new(&task, &options, &[]);
    let state = State { snake: snake.clone(), rails: Vec::new() };
    let rates = motion.velocity(&state).unwrap();
    let size = |h: f64| {
        let accelerations = motion.acceleration(&state, &rates, h).unwrap();
        accelerations.iter().map(|a| a.length_squared()).sum::<f64>().sqrt()
    };
    let ratio = size(0.01) / size(0.001);
    assert!((ratio - 1.0).abs() < 0.05 && size(0.001) > 0.01, "{ratio}");
}

#[test]
fn a_ring_climbs_a_cylinder_and_cannot_climb_a_cone() {
    let ring = regular(10);
    let cylinder = surface([[-PI, PI], [-20.0, 20.0]], cylinder(1.0));
    let found = run(&on(&ring, &cylinder), &Options { max_steps: 50, ..Options::default() });
    assert_eq!(found.stop, Stop::Steps);
    for (k, frame) in found.frames.iter().enumerate() {
        assert!(incongruence(frame.snake.control(), ring.control()) < 1e-10);
        let heights: Vec<f64> = frame.snake.contacts().iter().map(|c| c.z.abs()).collect();
        assert!(heights.iter().all(|z| (z - 0.05 * k as f64).abs() < 1e-9 && (z - heights[0]).abs() < 1e-10));
    }
    let cone = surface([[-PI, PI], [-0.9, 5.0]], revolution(|v| [1.0 + 0.4 * v, 0.4, 0.0]));
    // With heights kept the projection takes all back; without, the ring leaves the cone.
    let speeds = [-1.0];
    for speeds in [&speeds[..], &[1.0]] {
        let go = |surface_weight: f64| {
            let projection = projection::Options { surface_weight, ..projection::Options::default() };
            // The paper's weight, with which it goes as fast as it is told to.
            let weights = Weights { offset: 0.1, ..Weights::default() };
            let options = Options { max_deviation: 0.05, projection, weights, ..Options::default() };
            run(&Task { speeds, ..on(&ring, &cone) }, &options)
        };
        let (kept, left) = (go(1.0), go(0.0));
        assert!(matches!(kept.stop, Stop::Stalled | Stop::Deviation(_)), "{:?}", kept.stop);
        assert!(matches!(left.stop, Stop::Deviation(by) if by > 0.05) && left.frames.len() < 20, "{:?}", left.stop);
        assert!(left.frames.iter().all(|frame| frame.deviation <= 0.05 && frame.snake.residual() < 1e-12));
        // As fast as it can on the cone is a creep.
        let options = Options { max_steps: 1000, ..Options::default() };
        let crept = run(&Task { speeds, ..on(&ring, &cone) }, &options);
        assert!(crept.stop == Stop::Stalled && crept.frames.len() < 60, "{:?} {}", crept.stop, crept.frames.len());
        assert!(crept.last().deviation < 0.06, "{}", crept.last().deviation);
    }
}

#[test]
fn a_snake_turns_about_a_fixed_end_and_comes_back() {
    let plane = plane();
    let snake = circular(5, 0.3);
    let pivot = snake.control()[0];
    // Speeds of a rotation.
    let speeds: Vec<f64> = snake.control().iter().map(|p| p.distance(pivot)).collect();
    let task = Task { fixed: &[0], speeds: &speeds, ..on(&snake, &plane) };
    let found = run(&task, &Options { max_steps: 400, ..Options::default() });
    assert_eq!(found.stop, Stop::Cycle);
    for frame in &found.frames {
        assert!(frame.snake.control()[0] == pivot && incongruence(frame.snake.control(), snake.control()) < 1e-10);
    }
    let farthest = found.frames.iter().map(|f| f.snake.control()[6].distance(snake.control()[6])).fold(0.0, f64::max);
    assert!((farthest - 2.0 * speeds[6]).abs() < 0.01);
    let apart = found.last().snake.control()[6].distance(snake.control()[6]);
    assert!(apart < 0.2, "{apart}");
}

#[test]
fn runs_can_be_cancelled_and_stall() {
    let plane = plane();
    let snake = circular(5, 0.3);
    let mut calls = 0;
    let mut cancel = |progress: &Progress<'_>| {
        calls += 1;
        if progress.step == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let found = evolve(&on(&snake, &plane), &Options::default(), &mut cancel).unwrap();
    assert_eq!((found.stop, found.frames.len(), calls), (Stop::Cancelled, 4, 4));
    let still = run(&Task { speeds: &[0.0], ..on(&snake, &plane) }, &Options::default());
    assert_eq!((still.stop, still.frames.len()), (Stop::Stalled, 1));
}

#[test]
fn what_cannot_move_is_refused() {
    let snake = circular(3, 0.3);
    let refused = |task: &Task<'_>, options: &Options| {
        evolve(task, options, &mut |_| ControlFlow::Continue(())).unwrap_err().place().to_owned()
    };
    let (plain, task) = (Options::default(), Task::new(&snake));
    assert_eq!(refused(&Task { direction: Direction::Sideways, ..task }, &plain), "direction");
    assert_eq!(refused(&Task { direction: Direction::Along(DVec3::ZERO), ..task }, &plain), "direction");
    assert_eq!(refused(&Task { speeds: &[1.0, 2.0], ..task }, &plain), "speeds");
    assert_eq!(refused(&Task { speeds: &[f64::NAN], ..task }, &plain), "speeds[0]");
    assert_eq!(refused(&Task { fixed: &[1, 1], ..task }, &plain), "fixed[1]");
    assert_eq!(refused(&Task { fixed: &[9], ..task }, &plain), "fixed[0]");
    assert_eq!(refused(&task, &Options { step: 0.0, ..plain }), "options.step");
    assert_eq!(
        refused(&task, &Options { weights: Weights { offset: -1.0, ..plain.weights }, ..plain }),
        "options.weights.offset"
    );
    let none = Weights { tangential: 0.0, offset: 0.0, ..plain.weights };
    assert_eq!(refused(&task, &Options { weights: none, ..plain }), "options.weights");
    let mu = projection::Options { mu: 0.0, ..plain.projection };
    assert_eq!(refused(&task, &Options { projection: mu, ..plain }), "options.projection.mu");
    let ring = regular(5);
    assert_eq!(refused(&Task::new(&ring), &plain), "snake");
}

#[test]
fn sizes_do_not_matter() {
    let of = |scale: f64| {
        let torus = surface([[-PI, PI], [-PI, PI]], torus(2.0 * scale, 0.7 * scale));
        let snake = screw(6, 0.4);
        let control = snake.control().iter().map(|p| scale * (0.9 * *p + 1.9 * DVec3::X)).collect();
        let snake = Snake::new(control, false, None).unwrap();
        let options = Options { step: 0.01, max_steps: 10, ..Options::default() };
        run(&Task { speeds: &[scale], ..on(&snake, &torus) }, &options)
    };
    let unit = of(1.0);
    assert_eq!(unit.frames.len(), 11);
    for scale in [1e-3, 1e3] {
        let found = of(scale);
        assert_eq!((found.frames.len(), found.stop), (11, Stop::Steps));
        for (a, b) in found.last().snake.control().iter().zip(unit.last().snake.control()) {
            assert!((a / scale).distance(*b) < 1e-7, "{}", (a / scale).distance(*b));
        }
    }
}

#[test]
fn meshes_guide_as_the_surfaces_that_they_are_of() {
    let cylinder = surface([[-PI, PI], [-2.0, 5.0]], cylinder(1.0));
    let mesh = TriangleMesh::new(&cylinder.mesh(181, 61).unwrap()).unwrap();
    let mesh = ReferenceMesh::new(&mesh);
    // Its chords are within 1.6e-4 of the cylinder.
    let ring = regular(10);
    let found = run(&on(&ring, &mesh), &Options { max_steps: 30, ..Options::default() });
    assert_eq!(found.stop, Stop::Steps);
    for frame in &found.frames {
        let off = frame.snake.sample(4).iter().map(|p| (p.x.hypot(p.y) - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 2e-3 && frame.snake.residual() < 1e-12 && frame.deviation < 2e-3, "{off} {}", frame.deviation);
    }
    let risen = found.last().snake.contacts().iter().map(|c| c.z.abs()).fold(f64::INFINITY, f64::min);
    assert!(risen > 1.3, "{risen}");
}

mod long_tests;
mod rail_tests;
