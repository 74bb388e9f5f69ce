use super::*;
use crate::geometry::snakes::{ArcShape, Pose};

/// Three arcs of a circle of radius 2 in the plane z = 0.
fn flat() -> Draft {
    let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
    Draft::new(Snake::from_arcs(&[ArcShape { radius: 2.0, length: 1.0 }; 3], &[0.0; 2], &pose).unwrap())
}

fn on_plane() -> Draft {
    let mut draft = flat();
    let plane = NamedSurface::new(SurfaceKind::Plane, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]).unwrap();
    draft.set_surface(Some(Surface::Named(plane)));
    draft
}

#[test]
fn what_was_found_is_forgotten_when_the_snake_is_put_elsewhere() {
    let mut draft = on_plane();
    assert_eq!(draft.frames().unwrap_err().status(), Status::NotInitialised);
    draft.set_direction(Direction::Sideways).unwrap();
    let options = evolution::Options { max_steps: 4, ..Default::default() };
    draft.evolve(&options, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(draft.frames().unwrap().len(), 5);
    assert!(draft.congruence(0, 4).unwrap().rms < 1e-12 && draft.motion().is_err());
    let last = draft.at(Some(4)).unwrap();
    assert_eq!(draft.at(Some(5)).unwrap_err().place(), "frame");
    draft.take_frame(4).unwrap();
    assert!(draft.snake() == &last && draft.evolution().is_err());
    let target: Vec<DVec3> = last.control().iter().map(|p| *p + 0.1 * DVec3::Z).collect();
    let found = draft.project(&target, &projection::Options::default()).unwrap();
    assert!(found.moved < 1e-9 && draft.snake() == &found.snake);
    assert_eq!((draft.freedoms(false).unwrap().free, draft.freedoms(true).unwrap().free), (8, 3));
    assert!(draft.deviation().unwrap() > 0.09);
    draft.set_surface(None);
    assert_eq!(draft.freedoms(true).unwrap_err().place(), "surface");
}

#[test]
fn rails_begin_at_their_nearest_points() {
    let mut draft = on_plane();
    let end = draft.snake().control()[4];
    let line = [end - 1.5 * DVec3::Y, end - 0.5 * DVec3::Y, end + DVec3::Y, end + 2.0 * DVec3::Y];
    let driven = Role::Driven { point: 4, speed: 1.0 };
    assert_eq!(draft.add_rail(&line, false, driven).unwrap(), 0);
    let options = evolution::Options { max_steps: 3, step: 0.1, ..Default::default() };
    let evolution = draft.evolve(&options, &mut |_| ControlFlow::Continue(())).unwrap();
    for frame in &evolution.frames {
        assert!(frame.snake.control()[4].distance(end + frame.time * DVec3::Y) < 1e-12);
    }
    let place =
        |draft: &mut Draft, line: &[DVec3], role| draft.add_rail(line, false, role).unwrap_err().place().to_owned();
    assert_eq!(place(&mut draft, &line, driven), "point");
    assert_eq!(place(&mut draft, &line, Role::Driven { point: 9, speed: 1.0 }), "point");
    assert_eq!(place(&mut draft, &line, Role::Driven { point: 0, speed: 1.0 }), "points");
    assert_eq!(place(&mut draft, &[DVec3::ZERO, DVec3::Y], Role::Driven { point: 0, speed: f64::NAN }), "speed");
    assert_eq!(place(&mut draft, &[DVec3::ZERO, DVec3::Y], Role::Following { point: 0, leader: 1 }), "leader");
    assert_eq!(place(&mut draft, &line[..1], driven), "points");
    assert_eq!(place(&mut draft, &line, Role::Gliding { contact: 4 }), "contact");
    assert_eq!(place(&mut draft, &[DVec3::ZERO, DVec3::X], Role::Gliding { contact: 0 }), "points");
    assert_eq!(draft.guides().len(), 1);
    // The snake is no longer on its rail.
    let moved = draft.snake().control().iter().map(|p| *p + DVec3::X).collect();
    draft.set_control(moved).unwrap();
    assert_eq!(draft.evolve(&options, &mut |_| ControlFlow::Continue(())).unwrap_err().place(), "rails[0]");
    draft.clear_rails();
    draft.evolve(&evolution::Options { max_steps: 0, ..options }, &mut |_| ControlFlow::Continue(())).unwrap();
}

#[test]
fn lamellae_stand_as_they_are_asked_to() {
    let draft = on_plane();
    let normal = draft.lamellae(None, 0.5, 4, Stand::Normal).unwrap();
    let along = draft.lamellae(None, 0.5, 4, Stand::Along(DVec3::Z)).unwrap();
    assert_eq!((normal.len(), draft.lamellae(None, 0.5, 4, Stand::Flat).unwrap().len()), (1, 3));
    assert!(normal[0].points().iter().zip(along[0].points()).all(|(a, b)| a.distance(*b) < 1e-15));
    assert_eq!(flat().lamellae(None, 0.5, 4, Stand::Normal).unwrap_err().place(), "surface");
    assert_eq!(draft.lamellae(Some(0), 0.5, 4, Stand::Flat).unwrap_err().status(), Status::NotInitialised);
}

#[test]
fn wishes_are_checked() {
    let mut draft = flat();
    let place = |result: Result<()>| result.unwrap_err().place().to_owned();
    assert_eq!(place(draft.wish_velocity(5, DVec3::X, 1.0)), "point");
    assert_eq!(place(draft.wish_velocity(4, DVec3::NAN, 1.0)), "velocity");
    assert_eq!(place(draft.wish_plane(4, DVec3::ZERO, 1.0)), "normal");
    assert_eq!(place(draft.wish_plane(4, DVec3::X, -1.0)), "weight");
    assert_eq!(place(draft.set_speeds(vec![1.0; 2])), "speeds");
    assert_eq!(place(draft.set_speeds(vec![f64::NAN])), "speeds[0]");
    assert_eq!(place(draft.set_fixed(vec![0, 5])), "fixed[1]");
    assert_eq!(place(draft.set_fixed(vec![0, 0])), "fixed[1]");
    assert_eq!(place(draft.set_direction(Direction::Along(DVec3::ZERO))), "direction");
    draft.wish_velocity(4, DVec3::Z, 1.0).unwrap();
    draft.set_fixed(vec![0]).unwrap();
    let found = draft.velocity(&evolution::Options::default()).unwrap();
    assert!(found.vectors[0].length() < 1e-12 && found.vectors[4].distance(DVec3::Z) < 1e-6, "{:?}", found.vectors);
}
