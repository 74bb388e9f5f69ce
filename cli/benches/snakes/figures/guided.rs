//! Figs. 10, 13, 14 and 15: snakes on rails.

use std::path::Path;

use anyhow::Result;
use glam::{DMat3, DVec3};
use shapeop::geometry::snakes::evolution::{Direction, Evolution, Frame, Options, Stop, Task, Weights};
use shapeop::geometry::snakes::rails::Rail;
use shapeop::geometry::snakes::{ArcShape, Pose, Snake};
use shapeop::mesh::curve::{Curve, FnCurve};
use shapeop_cli::scene::{BLUE, INK, ORANGE, RED, Scene, View};

use super::drawing::{ARCS, THIN, every, framed, kept, line, swept, upright};
use crate::group::Group;
use crate::own::{from_polyline, largest, procrustes};
use crate::shapes::run;

/// An arch of equal arcs with equal torsions, its ends along x, its middle above.
fn arch(count: usize, angle: f64, torsion: f64) -> Result<Snake> {
    let pose = Pose { point: DVec3::ZERO, tangent: DVec3::X, normal: DVec3::Y };
    let arcs = vec![ArcShape { radius: 1.0, length: angle }; count];
    upright(&Snake::from_arcs(&arcs, &vec![torsion; count - 1], &pose)?)
}

/// A snake leant forward, so that points of it can go up and down.
fn tilted(snake: Snake) -> Result<Snake> {
    let turn = DMat3::from_rotation_x(-0.6);
    Ok(snake.moved(snake.control().iter().map(|p| turn * *p).collect())?)
}

/// A curve from a point along an axis, which it leaves by two sines: `out` and `up` have sizes and angles per length.
fn wavy(
    from: DVec3,
    along: DVec3,
    [(out, w), (up, v)]: [(DVec3, f64); 2],
    length: f64,
) -> Result<FnCurve<impl Fn(f64) -> [DVec3; 3]>> {
    Ok(FnCurve::new([0.0, length], false, move |t: f64| {
        let ((a, b), (c, d)) = ((w * t).sin_cos(), (v * t).sin_cos());
        [from + t * along + a * out + c * up, along + w * b * out + v * d * up, -w * w * a * out - v * v * c * up]
    })?)
}

fn drawn(view: View, rail: &dyn Curve, end: f64, width: f64) -> View {
    let points: Vec<DVec3> = (0..=160).map(|k| rail.point(end * f64::from(k) / 160.0)).collect();
    view.line(&points, RED, width)
}

fn told(group: &mut Group, snake: &Snake, found: &Evolution) {
    let all: Vec<Snake> = found.frames.iter().map(|frame| frame.snake.clone()).collect();
    kept(group, &all);
    group.plain("positions", found.frames.len() as f64);
    group.plain("arcs in all, of one kind", (found.frames.len() * snake.shapes().len()) as f64);
}

/// By how much gliding snakes miss a rail at most.
fn missed(frames: &[Frame], rail: usize, curve: &dyn Curve) -> f64 {
    let of = |f: &Frame| from_polyline(curve.point(f.rails[rail].parameter), &f.snake.sample(500));
    largest(frames.iter().map(of))
}

fn surface(title: &str, snakes: &[Snake], view: [f64; 2]) -> Result<View> {
    let mut drawn = swept(View::new(title, view[0], view[1]), snakes, 3, ARCS)?;
    for positions in snakes.iter().step_by(3) {
        drawn = line(drawn, positions, THIN, 0.8);
    }
    Ok(drawn)
}

/// Ends driven, torsions changed as little as can be.
const ROTATION: Weights = Weights { tangential: 1.0, offset: 0.0, rotation: 10.0, orthogonal: 0.0 };

pub fn figure10(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 10: an evolution step by step",
        "The ends of a snake of eight arcs run along two rails; torsions change as little as they can.",
    );
    let snake = arch(8, 0.34, 0.25)?;
    let (first, last) = (snake.control()[0], snake.control()[9]);
    let a = wavy(first, DVec3::Y, [(-0.40 * DVec3::X, 0.6), (0.15 * DVec3::Z, 1.2)], 3.4)?;
    let b = wavy(last, DVec3::Y, [(-0.10 * DVec3::X, 0.5), (-0.10 * DVec3::Z, 1.5)], 3.4)?;
    let rails = [
        Rail::Driven { point: 0, curve: &a, start: 0.0, speed: 1.0 },
        Rail::Driven { point: 9, curve: &b, start: 0.0, speed: 1.0 },
    ];
    let options = Options { step: 0.05, max_steps: 200, weights: ROTATION, ..Options::default() };
    let found = run(&Task { rails: &rails, ..Task::new(&snake) }, &options)?;
    group.at_least("it goes to the rails' end", f64::from(matches!(found.stop, Stop::RailEnd { .. })), 1.0);
    let off =
        |f: &Frame| f.snake.control()[0].distance(a.point(f.time)).max(f.snake.control()[9].distance(b.point(f.time)));
    group.at_most("ends off their rails", largest(found.frames.iter().map(off)), 1e-12);
    told(&mut group, &snake, &found);
    let snakes = every(&found, 0.05);
    let mut views = Vec::new();
    for (shown, title) in
        [(snakes.len() / 4, "after a quarter"), (snakes.len() / 2, "after a half"), (snakes.len() - 2, "at the end")]
    {
        let mut view = View::new(title, 40.0, 30.0);
        for positions in snakes[..shown].iter().step_by(4) {
            view = line(view, positions, THIN, 1.0);
        }
        let (now, next) = (&snakes[shown], &snakes[shown + 1]);
        view = line(view, now, ORANGE, 3.6).dots(now.control(), INK, 3.2).line(now.control(), THIN, 0.7);
        for (p, q) in now.control().iter().zip(next.control()) {
            // A vector of velocity with a head.
            let way = 6.0 * (*q - *p);
            let (tip, aside) = (*p + way, 0.12 * way.cross(DVec3::Z).normalize_or_zero() * way.length());
            view = view.line(&[*p, *p + 0.5 * way, tip], BLUE, 1.8);
            view = view.line(&[tip - 0.25 * way + aside, tip, tip - 0.25 * way - aside], BLUE, 1.8);
        }
        view = drawn(drawn(view, &a, 3.4, 2.2), &b, 3.4, 2.2);
        views.push(framed(view, snakes.iter().step_by(4).flat_map(|s| s.sample(2))));
    }
    let scene = Scene {
        title: "A snake evolves: velocities, a step, a projection, and so on".to_owned(),
        subtitle: "Red: rails along which the ends run; blue: velocities of control points; grey: earlier positions"
            .to_owned(),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "driven")?);
    Ok(group)
}

pub fn figure13(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 13: a surface guided by four rails",
        "The ends of a snake of twelve arcs run along two rails; it glides on two more; torsions change as little as they can.",
    );
    let snake = tilted(arch(12, 0.24, 0.12)?)?;
    let contacts = snake.contacts();
    let along = DVec3::Y;
    let a = wavy(contacts[0], along, [(-0.35 * DVec3::X, 0.6), (0.05 * DVec3::Z, 1.4)], 3.6)?;
    let b = wavy(contacts[12], along, [(-0.12 * DVec3::X, 0.5), (0.08 * DVec3::Z, 0.8)], 3.6)?;
    let c = wavy(contacts[4], along, [(-0.26 * DVec3::X, 0.6), (-0.08 * DVec3::Z, 0.7)], 4.4)?;
    let d = wavy(contacts[8], along, [(-0.18 * DVec3::X, 0.55), (-0.10 * DVec3::Z, 0.6)], 4.4)?;
    let rails = [
        Rail::Driven { point: 0, curve: &a, start: 0.0, speed: 1.0 },
        Rail::Driven { point: 13, curve: &b, start: 0.0, speed: 1.0 },
        Rail::Gliding { contact: 4, curve: &c, start: 0.0 },
        Rail::Gliding { contact: 8, curve: &d, start: 0.0 },
    ];
    let options = Options { step: 0.05, max_steps: 200, weights: ROTATION, ..Options::default() };
    let found = run(&Task { rails: &rails, ..Task::new(&snake) }, &options)?;
    group.at_least(
        "it goes to the rails' end",
        f64::from(matches!(found.stop, Stop::RailEnd { distance: 0.0, .. })),
        1.0,
    );
    let gap = missed(&found.frames, 2, &c).max(missed(&found.frames, 3, &d));
    group.at_most("snake and gliding rails apart by, in a polyline", gap, 1e-6);
    told(&mut group, &snake, &found);
    let snakes = every(&found, 0.05);
    let bent = largest(snakes.iter().map(|s| procrustes(snake.control(), s.control())));
    group.plain("off congruence, root mean square, largest", bent);
    let end = found.last().time;
    let mut rails_only = View::new("rails and positions", 48.0, 28.0);
    for positions in snakes.iter().step_by(4) {
        rails_only = line(rails_only, positions, BLUE, 1.4);
    }
    let mut whole = surface("the surface", &snakes, [48.0, 28.0])?;
    for (rail, k) in [(&a as &dyn Curve, 0), (&b, 1), (&c, 2), (&d, 3)] {
        let to = found.last().rails[k].parameter.min(end.max(4.4));
        whole = drawn(whole, rail, to, 2.6);
        rails_only = drawn(rails_only, rail, to, 3.0);
    }
    rails_only = line(rails_only, &snake, INK, 3.0);
    let scene = Scene {
        title: "A surface between rails, made of many instances of one arc".to_owned(),
        subtitle: "The ends run along the outer rails, the snake glides on the inner ones; yellow and white: arcs, all alike".to_owned(),
        columns: 2,
        views: vec![
            rails_only.caption("red: rails; black: the first position".to_owned()),
            whole.caption(format!(
                "{} arcs of one kind; on the inner rails to {gap:.0e};\npositions differ by {bent:.1e} from congruent ones",
                snakes.len() * 12
            )),
        ],
    };
    group.picture = Some(scene.write(folder, "guided")?);
    Ok(group)
}

pub fn figure14(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 14: a kinematic surface",
        "The ends run along two rails at a constant distance, and the snake glides on one more: all positions are congruent.",
    );
    let level = tilted(arch(12, 0.24, 0.12)?)?;
    // Across the rails, so that the ends can go on by different lengths.
    let turn = DMat3::from_rotation_z(0.6);
    let snake = level.moved(level.control().iter().map(|p| turn * *p).collect())?;
    let contacts = snake.contacts();
    let a = wavy(contacts[0], DVec3::Y, [(-0.25 * DVec3::X, 0.9), (0.20 * DVec3::Z, 0.9)], 4.2)?;
    let b = wavy(contacts[12], DVec3::Y, [(-0.22 * DVec3::X, 0.9), (-0.15 * DVec3::Z, 0.8)], 6.0)?;
    let c = wavy(contacts[6], DVec3::Y, [(-0.20 * DVec3::X, 0.8), (0.06 * DVec3::Z, 1.3)], 6.0)?;
    let rails = [
        Rail::Driven { point: 0, curve: &a, start: 0.0, speed: 1.0 },
        Rail::Following { point: 13, curve: &b, start: 0.0, leader: 0 },
        Rail::Gliding { contact: 6, curve: &c, start: 0.0 },
    ];
    let options = Options { step: 0.05, max_steps: 200, keeps_torsions: true, weights: ROTATION, ..Options::default() };
    let found = run(&Task { rails: &rails, ..Task::new(&snake) }, &options)?;
    group.at_least(
        "it goes to the rail's end",
        f64::from(matches!(found.stop, Stop::RailEnd { distance: 0.0, .. })),
        1.0,
    );
    let snakes = every(&found, 0.05);
    let rms = largest(snakes.iter().map(|s| procrustes(snake.control(), s.control())));
    group.at_most("off congruence, root mean square, largest", rms, 1e-6);
    let gap = missed(&found.frames, 2, &c);
    group.at_most("snake and gliding rail apart by, in a polyline", gap, 1e-6);
    let on = |f: &Frame| f.snake.control()[13].distance(b.point(f.rails[1].parameter));
    group.at_most("the following end off its rail", largest(found.frames.iter().map(on)), 1e-12);
    told(&mut group, &snake, &found);
    let mut rails_only = View::new("rails and positions", 48.0, 28.0);
    for (k, positions) in snakes.iter().enumerate().step_by(4) {
        rails_only = line(rails_only, positions, BLUE, if k == 0 { 3.0 } else { 1.4 });
    }
    let mut whole = surface("the surface", &snakes, [48.0, 28.0])?;
    for (rail, k) in [(&a as &dyn Curve, 0), (&b, 1), (&c, 2)] {
        let to = found.last().rails[k].parameter;
        (rails_only, whole) = (drawn(rails_only, rail, to, 3.0), drawn(whole, rail, to, 2.6));
    }
    rails_only = line(rails_only, &snake, INK, 3.0);
    let scene = Scene {
        title: "A kinematic surface: one rigid snake moves along three rails".to_owned(),
        subtitle:
            "The ends keep their distance on the outer rails; the middle rail says how the snake is turned about them"
                .to_owned(),
        columns: 2,
        views: vec![
            rails_only.caption("red: rails; black: the first position".to_owned()),
            whole.caption(format!(
                "{} positions, congruent to {rms:.0e}, root mean square;\n{} arcs of one kind",
                snakes.len(),
                12 * snakes.len()
            )),
        ],
    };
    group.picture = Some(scene.write(folder, "kinematic")?);
    Ok(group)
}

pub fn figure15(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 15: equal spacing between two rails",
        "A snake of twelve arcs rises at one speed and meets two rails on its way: positions are equally far apart.",
    );
    let lying = arch(12, 0.24, 0.02)?;
    // On its side: what was up is forward.
    let snake = lying.moved(lying.control().iter().map(|p| DVec3::new(p.x, -p.z, 0.6 * p.y)).collect())?;
    let snake = if snake.residual() > 1e-12 {
        lying.moved(lying.control().iter().map(|p| DVec3::new(p.x, -p.z, p.y)).collect())?
    } else {
        snake
    };
    let contacts = snake.contacts();
    let a = wavy(contacts[3], DVec3::Z, [(-0.22 * DVec3::X, 1.1), (0.18 * DVec3::Y, 1.5)], 4.2)?;
    let b = wavy(contacts[9], DVec3::Z, [(0.25 * DVec3::X, 0.9), (-0.20 * DVec3::Y, 1.2)], 4.2)?;
    let rails =
        [Rail::Gliding { contact: 3, curve: &a, start: 0.0 }, Rail::Gliding { contact: 9, curve: &b, start: 0.0 }];
    let weights = Weights { tangential: 1.0, offset: 1.0, rotation: 1.0, orthogonal: 0.0 };
    let options = Options { step: 0.05, max_steps: 72, weights, ..Options::default() };
    let found = run(&Task { rails: &rails, direction: Direction::Along(DVec3::Z), ..Task::new(&snake) }, &options)?;
    let snakes = every(&found, 0.2);
    let rises: Vec<f64> = snakes
        .windows(2)
        .flat_map(|pair| {
            let (p, q) = (pair[0].contacts(), pair[1].contacts());
            p.iter().zip(&q).map(|(p, q)| (q.z - p.z) / 0.2).collect::<Vec<_>>()
        })
        .collect();
    let (least, most) = (rises.iter().copied().fold(f64::INFINITY, f64::min), largest(rises.iter().copied()));
    group.plain("rise of contacts over that asked for, least", least);
    group.plain("rise of contacts over that asked for, largest", most);
    let gap = missed(&found.frames, 0, &a).max(missed(&found.frames, 1, &b));
    group.at_most("snake and rails apart by, in a polyline", gap, 1e-6);
    told(&mut group, &snake, &found);
    group.at_least("it rises by", found.last().snake.contacts()[6].z - contacts[6].z, 3.0);
    let mut positions = View::new("positions, a fifth apart", 22.0, 18.0);
    for (k, snake) in snakes.iter().enumerate() {
        positions = line(positions, snake, if k == 0 { INK } else { BLUE }, if k == 0 { 3.0 } else { 1.6 });
    }
    let all = every(&found, 0.05);
    let mut whole = swept(View::new("the surface", 22.0, 18.0), &all, 4, ARCS)?;
    for snake in &snakes {
        whole = line(whole, snake, THIN, 0.8);
    }
    for (rail, k) in [(&a as &dyn Curve, 0), (&b, 1)] {
        let to = found.last().rails[k].parameter;
        (positions, whole) = (drawn(positions, rail, to, 3.0), drawn(whole, rail, to, 2.6));
    }
    let scene = Scene {
        title: "Equal spacing: a snake rises at one speed along two rails".to_owned(),
        subtitle: "It meets both rails on its way without running along them; yellow and white: arcs, all alike"
            .to_owned(),
        columns: 2,
        views: vec![
            positions.caption(format!("contacts rise by {least:.2} to {most:.2} of what is asked for")),
            whole.caption(format!("{} arcs of one kind; on the rails to {gap:.0e}", 12 * all.len())),
        ],
    };
    group.picture = Some(scene.write(folder, "spacing")?);
    Ok(group)
}
