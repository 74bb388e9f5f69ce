use super::super::tests::{open_snake, regular};
use super::*;
use crate::mesh::curve::{FnCurve, Spline};

#[test]
fn combinations_are_points_of_arcs() {
    for snake in [open_snake(5, 3), regular(7)] {
        for (j, arc) in snake.arcs().iter().enumerate() {
            for part in [0.0, 0.3, 1.0] {
                let [point, first, second] = arc_point(&snake, j, part * arc.angle_rad);
                let radius = arc.circle.radius;
                assert!(point.of(snake.control()).distance(arc.point(part)) < 1e-12);
                assert!(first.of(snake.control()).distance(radius * arc.tangent(part)) < 1e-12);
                let inward = arc.circle.center - arc.point(part);
                assert!(second.of(snake.control()).distance(inward) < 1e-12);
                let sum: f64 = point.0.iter().map(|entry| entry.1).sum();
                assert!((sum - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_snake_meets_a_rail_in_whichever_arc() {
    let snake = regular(9);
    // The unit circle and a line at the height 0.3: they meet at y = 0.3.
    let line = Spline::through(&[DVec3::new(-2.0, 0.3, 0.0), DVec3::new(2.0, 0.3, 0.0)], false).unwrap();
    let met = meet(&snake, &line, OnRail { parameter: 3.0, arc: 0, angle_rad: 0.3 }).unwrap();
    let [point, ..] = arc_point(&snake, met.arc as usize, met.angle_rad);
    let expected = DVec3::new(0.91_f64.sqrt(), 0.3, 0.0);
    assert!(
        point.of(snake.control()).distance(expected) < 1e-12 && line.point(met.parameter).distance(expected) < 1e-12
    );
    let short = Spline::through(&[DVec3::new(-2.0, 0.3, 0.0), DVec3::new(0.8, 0.3, 0.0)], false).unwrap();
    let end = meet(&snake, &short, OnRail { parameter: 2.7, arc: 0, angle_rad: 0.3 });
    assert!(matches!(end, Err(Halt::End(distance)) if distance > 0.05), "{end:?}");
    let touching = Spline::through(&[DVec3::new(1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)], false).unwrap();
    let j = (0..9).find(|&j| snake.contacts()[j].x > 0.9).unwrap() as u32;
    let at = OnRail { parameter: 1.0, arc: j, angle_rad: 0.35 };
    let along = meet(&snake, &touching, at);
    assert!(matches!(along, Err(Halt::Parallel | Halt::End(_))), "{along:?}");
}

#[test]
fn followers_keep_their_distance() {
    let circle = |radius: f64, z: f64| {
        FnCurve::new([0.0, 6.0], false, move |t: f64| {
            let out = DVec3::new(t.cos(), t.sin(), 0.0);
            let around = DVec3::new(-t.sin(), t.cos(), 0.0);
            [radius * out + z * DVec3::Z, radius * around, -radius * out]
        })
        .unwrap()
    };
    let (a, b) = (circle(1.0, 0.0), circle(1.5, 0.4));
    for shift in [0.0, 0.3] {
        let distance = a.point(1.0).distance(b.point(1.0 + shift));
        let (of_a, of_b) = (a.at(1.0), b.at(1.0 + shift));
        let rate = follower_rate(of_b.point - of_a.point, of_b.first, of_b.second, [of_a.first, of_a.second]);
        assert!((rate - 1.0).abs() < 1e-6, "{rate}");
        let found = at_distance(&b, a.point(1.2), distance, 1.21 + shift).unwrap();
        assert!((b.point(found).distance(a.point(1.2)) - distance).abs() < 1e-14);
        assert!((found - 1.2 - shift).abs() < 1e-6, "{found}");
    }
    let off = at_distance(&b, DVec3::ZERO, 1.0, 1.0);
    assert!(matches!(off, Err(Halt::End(distance)) if (distance - (1.5_f64.hypot(0.4) - 1.0)).abs() < 1e-9));
}

#[test]
fn rails_must_start_on_the_snake() {
    let snake = open_snake(3, 5);
    let start_point = snake.control()[0];
    let line = |from: DVec3| Spline::through(&[from, from + DVec3::new(0.2, 0.5, 1.0)], false).unwrap();
    let (on, off) = (line(start_point), line(start_point + 0.01 * DVec3::X));
    let driven = |point, curve, start| Rail::Driven { point, curve, start, speed: 1.0 };
    let refused = |rail| start(&snake, &[rail]).unwrap_err();
    assert!(start(&snake, &[driven(0, &on, 0.0)]).is_ok());
    let error = refused(driven(0, &off, 0.0));
    assert!((error.place(), error.to_string().contains("0.01")) == ("rails[0]", true), "{error}");
    assert_eq!(refused(driven(5, &on, 0.0)).place(), "rails[0].point");
    assert_eq!(refused(driven(0, &on, -1.0)).place(), "rails[0].start");
    assert_eq!(refused(Rail::Following { point: 0, curve: &on, start: 0.0, leader: 0 }).place(), "rails[0].leader");
    assert_eq!(refused(Rail::Gliding { contact: 4, curve: &on, start: 0.0 }).place(), "rails[0].contact");
    let tangent = snake.arcs()[0].tangent(0.0);
    let along = Spline::through(&[start_point, start_point + tangent], false).unwrap();
    let error = refused(Rail::Gliding { contact: 0, curve: &along, start: 0.0 });
    assert_eq!((error.status(), error.place()), (Status::Degenerate, "rails[0]"));
}
