use super::*;
use crate::mesh::curve::{Curve, FnCurve, Spline};

use super::super::super::tests::open_snake;

/// The orbit of a point under rotations about the z axis with a rise for each radian.
fn orbit(point: DVec3, rise: f64, angle: f64) -> FnCurve<impl Fn(f64) -> [DVec3; 3]> {
    let (radius, start) = (point.x.hypot(point.y), point.y.atan2(point.x));
    FnCurve::new([0.0, angle], false, move |t: f64| {
        let (sine, cosine) = (start + t).sin_cos();
        let (out, around) = (DVec3::new(cosine, sine, 0.0), DVec3::new(-sine, cosine, 0.0));
        [radius * out + (point.z + rise * t) * DVec3::Z, radius * around + rise * DVec3::Z, -radius * out]
    })
    .unwrap()
}

fn weights() -> Weights {
    Weights { offset: 0.0, rotation: 10.0, ..Weights::default() }
}

/// An arch away from the axis of rotation.
fn arch() -> Snake {
    let snake = open_snake(6, 21);
    Snake::new(snake.control().iter().map(|p| *p + DVec3::new(6.0, 0.0, 0.0)).collect(), false, None).unwrap()
}

/// The root mean square distance of control points after the best rigid motion, by rotations only.
fn procrustes(a: &Snake, b: &Snake) -> f64 {
    use crate::linalg::small::nearest_rotation;
    let mean = |s: &Snake| s.control().iter().sum::<DVec3>() / s.control().len() as f64;
    let (from, to) = (mean(a), mean(b));
    let pairs: Vec<(DVec3, DVec3)> = a.control().iter().zip(b.control()).map(|(p, q)| (*p - from, *q - to)).collect();
    let correlation =
        pairs.iter().fold(glam::DMat3::ZERO, |sum, (p, q)| sum + glam::DMat3::from_cols(q * p.x, q * p.y, q * p.z));
    let (rotation, _) = nearest_rotation(correlation);
    let sum: f64 = pairs.iter().map(|(p, q)| (rotation * *p).distance_squared(*q)).sum();
    (sum / pairs.len() as f64).sqrt()
}

#[test]
fn kinematic_surfaces_have_congruent_snakes() {
    let snake = arch();
    let contact = snake.contacts()[3];
    for rise in [0.0, 0.7] {
        let ends = [snake.control()[0], snake.control()[7]].map(|p| orbit(p, rise, 1.5));
        let interior = orbit(contact, rise, 2.0);
        let rails = [
            Rail::Driven { point: 0, curve: &ends[0], start: 0.0, speed: 1.0 },
            Rail::Following { point: 7, curve: &ends[1], start: 0.0, leader: 0 },
            Rail::Gliding { contact: 3, curve: &interior, start: 0.0 },
        ];
        let task = Task { rails: &rails, ..Task::new(&snake) };
        for is_second_order in [false, true] {
            let options = Options {
                step: 0.05,
                max_steps: 60,
                keeps_torsions: true,
                weights: weights(),
                is_second_order,
                ..Options::default()
            };
            let found = run(&task, &options);
            assert!(matches!(found.stop, Stop::RailEnd { rail: 0, distance: 0.0 }), "{:?}", found.stop);
            assert!((found.last().time - 1.5).abs() < 1e-9);
            for frame in &found.frames {
                let congruence = procrustes(&snake, &frame.snake);
                assert!(congruence < 1e-6 && frame.incongruence < 1e-9, "{congruence} {}", frame.incongruence);
                // The oracle: the rotation itself.
                let turned = |p: DVec3| orbit(p, rise, 2.0).point(frame.time);
                let off = snake.control().iter().zip(frame.snake.control()).map(|(&p, q)| turned(p).distance(*q));
                let off = off.fold(0.0, f64::max);
                assert!(off < 1e-5, "{off} at {}", frame.time);
            }
        }
    }
}

#[test]
fn a_second_interior_rail_bends_the_snake() {
    let snake = arch();
    let contacts = snake.contacts();
    let ends = [snake.control()[0], snake.control()[7]].map(|p| orbit(p, 0.0, 1.5));
    let interior = orbit(contacts[2], 0.0, 2.0);
    let other = orbit(contacts[4], 0.4, 2.0);
    let rails = [
        Rail::Driven { point: 0, curve: &ends[0], start: 0.0, speed: 1.0 },
        Rail::Following { point: 7, curve: &ends[1], start: 0.0, leader: 0 },
        Rail::Gliding { contact: 2, curve: &interior, start: 0.0 },
        Rail::Gliding { contact: 4, curve: &other, start: 0.0 },
    ];
    let options = Options { step: 0.05, max_steps: 10, keeps_torsions: true, weights: weights(), ..Options::default() };
    let found = run(&Task { rails: &rails, ..Task::new(&snake) }, &options);
    assert!(found.frames.len() > 4, "{:?}", found.stop);
    let last = found.last();
    assert!(procrustes(&snake, &last.snake) > 1e-3 && last.incongruence > 1e-3, "{}", last.incongruence);
    assert!(last.snake.residual() < 1e-12 && shape_error(&snake, &last.snake) < 1e-10);
}

#[test]
fn followers_leave_rails_whose_distance_changes() {
    let snake = arch();
    let [first, last] = [snake.control()[0], snake.control()[7]];
    let leading = orbit(first, 0.0, 1.5);
    // Bends away from the orbit: on it no point stays at the distance.
    let away = Spline::through(&[last, last + 0.5 * (last - first) + 3.0 * DVec3::Y], false).unwrap();
    let rails = [
        Rail::Driven { point: 0, curve: &leading, start: 0.0, speed: 1.0 },
        Rail::Following { point: 7, curve: &away, start: 0.0, leader: 0 },
    ];
    let options = Options { weights: weights(), max_steps: 100, ..Options::default() };
    let found = run(&Task { rails: &rails, ..Task::new(&snake) }, &options);
    assert!(matches!(found.stop, Stop::RailEnd { .. }), "{:?}", found.stop);
    let lead = first.distance(last);
    for frame in &found.frames {
        let p = frame.snake.control();
        assert!((p[0].distance(p[7]) - lead).abs() < 1e-9 * lead && frame.snake.residual() < 1e-12);
    }
}

#[test]
fn driven_points_run_along_their_rails() {
    // Splines through points of bent curves, of unequal length: the shorter one ends the run.
    let snake = arch();
    let [first, last] = [snake.control()[0], snake.control()[7]];
    let rail = |from: DVec3, length: usize| {
        let point = |i: usize| {
            let t = 0.3 * i as f64;
            from + DVec3::new(0.2 * t * t, t, 0.1 * (2.0 * t).sin())
        };
        Spline::through(&(0..length).map(point).collect::<Vec<_>>(), false).unwrap()
    };
    let (a, b) = (rail(first, 5), rail(last, 9));
    let rails = [
        Rail::Driven { point: 0, curve: &a, start: 0.0, speed: 1.0 },
        Rail::Driven { point: 7, curve: &b, start: 0.0, speed: 1.0 },
    ];
    for is_second_order in [false, true] {
        let options = Options { weights: weights(), is_second_order, ..Options::default() };
        let found = run(&Task { rails: &rails, ..Task::new(&snake) }, &options);
        assert!(matches!(found.stop, Stop::RailEnd { rail: 0, distance: 0.0 }), "{:?}", found.stop);
        assert!((found.last().time - a.range()[1]).abs() < 1e-9);
        for frame in &found.frames {
            assert!(frame.snake.control()[0].distance(a.point(frame.time)) < 1e-12);
            assert!(frame.snake.control()[7].distance(b.point(frame.time)) < 1e-12);
            assert!(frame.snake.residual() < 1e-12 && shape_error(&snake, &frame.snake) < 1e-10);
        }
    }
}

#[test]
fn a_gliding_rail_is_met_at_every_step() {
    // A circle part in the plane, pulled along y, on an inclined line that it meets in its middle.
    let snake = circular(6, 0.2);
    let contact = snake.contacts()[3];
    let line = Spline::through(&[contact, contact + DVec3::new(3.0, 0.4, 0.0)], false).unwrap();
    let plane = plane();
    let rails = [Rail::Gliding { contact: 3, curve: &line, start: 0.0 }];
    let task = Task { rails: &rails, direction: Direction::Along(DVec3::X), ..on(&snake, &plane) };
    for is_second_order in [false, true] {
        let options = Options { max_steps: 50, is_second_order, ..Options::default() };
        let found = run(&task, &options);
        for frame in &found.frames {
            // Recomputed: the nearest point of the arcs to the line.
            let arcs = frame.snake.arcs();
            let on = line.point(frame.rails[0].parameter);
            let gap = arcs.iter().map(|arc| arc.distance(on)).fold(f64::INFINITY, f64::min);
            assert!(gap < 1e-10, "{gap}");
            assert!(frame.snake.residual() < 1e-12);
        }
        assert!(found.frames.len() > 20 && found.last().rails[0].parameter > 0.5, "{:?}", found.stop);
    }
}

#[test]
fn a_rail_that_turns_along_the_snake_ends_the_run() {
    // Through the middle of an arch that moves up: the rail bends until it is along the snake.
    let snake = circular(6, 0.2);
    let contact = snake.contacts()[3];
    let tangent = snake.arcs()[3].tangent(0.0);
    let rail = FnCurve::new([0.0, 2.0], false, move |t: f64| {
        let (sine, cosine) = (1.5 * t).sin_cos();
        [
            contact + (1.0 - cosine) / 1.5 * tangent + sine / 1.5 * DVec3::Z,
            sine * tangent + cosine * DVec3::Z,
            1.5 * cosine * tangent - 1.5 * sine * DVec3::Z,
        ]
    })
    .unwrap();
    let rails = [Rail::Gliding { contact: 3, curve: &rail, start: 0.0 }];
    let task = Task { rails: &rails, direction: Direction::Along(DVec3::Z), ..Task::new(&snake) };
    let options = Options { max_steps: 200, weights: weights_with_offset(), ..Options::default() };
    let found = run(&task, &options);
    assert!(
        matches!(found.stop, Stop::Parallel { rail: 0 } | Stop::RailEnd { rail: 0, .. } | Stop::Stalled),
        "{:?}",
        found.stop
    );
    assert!(found.frames.len() > 5 && found.frames.len() < 200);
}

fn weights_with_offset() -> Weights {
    Weights { rotation: 10.0, ..Weights::default() }
}

#[test]
fn a_snake_pulled_straight_stops_and_keeps_its_frames() {
    // One end stays, the other runs away on a line that is longer than the snake can follow.
    let snake = open_snake(6, 4);
    let [first, last] = [snake.control()[0], snake.control()[7]];
    let line = Spline::through(&[last, last + 4.0 * (last - first)], false).unwrap();
    let rails = [Rail::Driven { point: 7, curve: &line, start: 0.0, speed: 0.1 }];
    let task = Task { fixed: &[0], rails: &rails, ..Task::new(&snake) };
    let found = run(&task, &Options { step: 0.2, max_steps: 500, weights: weights(), ..Options::default() });
    assert_eq!(found.stop, Stop::Stalled);
    let reach = found.last().snake.control()[7].distance(first);
    assert!(found.frames.len() > 3 && reach > 1.3 * first.distance(last));
    assert!(found.frames.iter().all(|frame| frame.snake.residual() < 1e-12 && frame.snake.control()[0] == first));
}
