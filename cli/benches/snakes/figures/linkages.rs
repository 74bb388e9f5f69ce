//! Figs. 16 to 18: linkages of six arcs.

use std::f64::consts::FRAC_PI_3;
use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result, bail};
use glam::DVec3;
use shapeop::geometry::snakes::cycle::{End, Motion, Options, cycle};
use shapeop::geometry::snakes::sweep::swept_grid;
use shapeop::geometry::snakes::{Linkage, Snake};
use shapeop_cli::colours::Rgb;
use shapeop_cli::scene::{BLUE, INK, RED, Scene, View};

use super::drawing::{ARCS, BLUES, PER_ARC, SHEET, THIN, YELLOW, framed, line, piped, quads, upright};
use crate::group::Group;
use crate::own::{largest, shape_error, stretch};
use crate::shapes::{TORSIONS, linked};

const GREEN: Rgb = [0.16, 0.52, 0.30];
const PURPLE: Rgb = [0.48, 0.26, 0.62];
const GREENS: [Rgb; 2] = [[0.55, 0.78, 0.56], [0.93, 0.97, 0.93]];

fn moved(snake: Snake, step_rad: f64) -> Result<Motion> {
    let options = Options { step_rad, ..Options::default() };
    let motion = cycle(&Linkage::new(snake)?, &options, &mut |_| ControlFlow::Continue(()))?;
    if motion.end != End::Closed {
        bail!("the linkage does not come back: {:?}", motion.end);
    }
    Ok(motion)
}

/// The axes that the ends of a linkage are held by.
fn hinges(view: View, snake: &Snake) -> View {
    let p = snake.control();
    let n = p.len();
    let axis = |view: View, a: DVec3, b: DVec3| {
        let side = 0.35 * (b - a).normalize();
        let points: Vec<DVec3> = (-8..=8).map(|k| a + f64::from(k) / 8.0 * side).collect();
        view.line(&points, INK, 2.2)
    };
    axis(axis(view, p[0], p[1]), p[n - 1], p[n - 2])
}

pub fn figure16(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 16: the cycle of a linkage of six arcs",
        "Six arcs of radius 1 and angle π/3, the end arcs on hinges: it moves in one way and comes back.",
    );
    let motion = moved(upright(&linked(FRAC_PI_3, &TORSIONS)?)?, 0.02)?;
    let snakes = (0..motion.frames.len()).map(|i| Ok(motion.snake(i)?)).collect::<Result<Vec<_>>>()?;
    let ranges = motion.ranges_rad()?;
    group.at_most("closes within", motion.closing.context("no closing")?, 1e-8);
    group.between("range of the first arc, radians", ranges[0], [1.158, 1.162]);
    group.between("range of the last arc, radians", ranges[1], [1.822, 1.826]);
    group.at_most("distances off by", largest(snakes.iter().map(|s| stretch(&snakes[0], s))), 1e-12);
    let paths = motion.contact_paths()?;
    let length = |path: &[DVec3]| path.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
    for (k, path) in paths.iter().enumerate().skip(1).take(5) {
        group.plain(&format!("path of contact {k}, length"), length(path));
    }
    let everything = || snakes.iter().step_by(6).flat_map(|snake| snake.sample(4));
    let view = |title: &str| framed(View::new(title, 115.0, 22.0), everything());
    let at = motion.at_phases(&[0.0, 0.34, 0.67])?;
    let mut three = hinges(view("three positions"), &snakes[0]);
    for (control, colours) in at.iter().zip([ARCS, BLUES, GREENS]) {
        three = piped(three, &snakes[0].moved(control.clone())?, 0.035, colours)?;
    }
    let mut whole = hinges(view("the whole cycle"), &snakes[0]);
    let count = 64;
    for control in motion.at_phases(&(0..count).map(|k| f64::from(k) / f64::from(count)).collect::<Vec<_>>())? {
        whole = line(whole, &snakes[0].moved(control)?, THIN, 0.8);
    }
    whole = piped(whole, &snakes[0].moved(at[0].clone())?, 0.035, ARCS)?;
    let mut joints = hinges(view("paths of contacts"), &snakes[0]);
    joints = piped(joints, &snakes[0].moved(at[0].clone())?, 0.018, [SHEET, SHEET])?;
    for (k, colour) in (1..6).zip([RED, BLUE, GREEN, PURPLE, RED]) {
        let mut path = paths[k].clone();
        path.push(path[0]);
        joints = joints.line(&path, colour, 2.6).dots(&[path[0]], colour, 4.5);
        joints = joints.label(path[0] + DVec3::new(0.0, 0.0, 0.13), format!("k{k}"), colour);
    }
    let [first, last] = ranges.map(f64::to_degrees);
    let scene = Scene {
        title: "Six congruent arcs between two hinges: one way to move, and back to the start".to_owned(),
        subtitle: "Radius 1, angle 60°, torsions 1, −0.7, 0.9, −0.8, 0.6; black: the axes that hold the end arcs"
            .to_owned(),
        columns: 3,
        views: vec![
            three.caption("a third of the way apart".to_owned()),
            whole.caption(format!(
                "{} steps; closes within {:.0e}",
                motion.frames.len(),
                motion.closing.unwrap_or(f64::NAN)
            )),
            joints.caption(format!(
                "k1 and k5 (red) rock by {first:.1}° and {last:.1}°;\nk2, k3 and k4 travel around loops"
            )),
        ],
    };
    group.picture = Some(scene.write(folder, "cycle")?);
    Ok(group)
}

/// Torsions of a linkage with the angle 0.8 whose feet are wide apart.
const ROOF: [f64; 5] = [0.7, 1.5, 0.6, -0.1, -1.1];

pub fn figure17(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 17: an array of copies of the linkage, each further on",
        "Thirty-six copies side by side, each an eighteenth of the cycle on; two moments. All arcs are congruent.",
    );
    let motion = moved(upright(&linked(0.8, &ROOF)?)?, 0.02)?;
    let start = motion.snake(0)?;
    let (count, offset) = (36, 0.16 * DVec3::Y);
    let moments: Vec<Vec<Snake>> = [0.0, 0.5]
        .iter()
        .map(|phase| {
            let copies = motion.copies(count, *phase, 1.0 / 18.0, offset)?;
            copies.into_iter().map(|copy| Ok(start.moved(copy)?)).collect()
        })
        .collect::<Result<_>>()?;
    let all = || moments.iter().flatten();
    group.at_most("radii and lengths", largest(all().map(|s| shape_error(&start, s))), 1e-10);
    group.at_most("distances off by", largest(all().map(|s| stretch(&start, s))), 1e-12);
    let held = moments.iter().flat_map(|snakes| {
        snakes.iter().enumerate().map(|(k, s)| s.control()[0].distance(start.control()[0] + k as f64 * offset))
    });
    group.at_most("feet off their places", largest(held), 1e-12);
    group.plain("different arcs", 1.0);
    group.plain("arcs in all", (6 * count) as f64);
    let mut views = Vec::new();
    for (snakes, title) in moments.iter().zip(["a moment", "half a cycle later"]) {
        let mut view = framed(View::new(title, 30.0, 22.0), all().flat_map(|s| s.sample(2)));
        for snake in snakes {
            view = piped(view, snake, 0.032, ARCS)?;
        }
        for end in [0, 6] {
            let feet: Vec<DVec3> = snakes.iter().map(|s| s.contacts()[end]).collect();
            view = view.line(&feet, INK, 2.4);
        }
        views.push(view);
    }
    let scene = Scene {
        title: "A roof that moves: copies of one linkage, each at another phase of its cycle".to_owned(),
        subtitle: format!(
            "{count} copies of six congruent arcs, each an eighteenth of the cycle further on: a wave runs along"
        ),
        columns: 2,
        views,
    };
    group.picture = Some(scene.write(folder, "array")?);
    Ok(group)
}

/// Torsions of a linkage with the angle 0.9 that comes near singular positions.
const NEARLY: [f64; 5] = [0.2, -1.6, -1.5, -1.6, 0.1];

pub fn figure18(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 18: a linkage that comes near a singular position",
        "Six arcs of angle 0.9, torsions 0.2, −1.6, −1.5, −1.6, 0.1: where its hinges come near to being dependent, the ends turn at\n\
         very different speeds.",
    );
    let motion = moved(upright(&linked(0.9, &NEARLY)?)?, 0.02)?;
    let start = motion.snake(0)?;
    let snakes = (0..motion.frames.len()).map(|i| Ok(motion.snake(i)?)).collect::<Result<Vec<_>>>()?;
    let determinants = snakes.iter().map(|s| Ok(Linkage::new(s.clone())?.determinant()?.abs()));
    let determinants = determinants.collect::<Result<Vec<_>>>()?;
    group.at_most("closes within", motion.closing.context("no closing")?, 1e-8);
    group.at_most("distances off by", largest(snakes.iter().map(|s| stretch(&start, s))), 1e-12);
    group.plain(
        "determinant of hinges, least over the cycle",
        determinants.iter().copied().fold(f64::INFINITY, f64::min),
    );
    group.plain("determinant of hinges, largest", largest(determinants.iter().copied()));
    let rate = |pair: &[[f64; 2]]| [0, 1].map(|k| (pair[1][k] - pair[0][k]).abs());
    let ratios: Vec<f64> = motion.angles_rad.windows(2).map(rate).map(|[a, b]| a.max(b) / a.min(b)).collect();
    group.plain("speed of one end arc over the other's, largest", largest(ratios.iter().copied()));
    let grid = swept_grid(&start, &motion.frames, PER_ARC, true)?;
    let faces =
        |i: usize, j: usize| if (j / PER_ARC + i / 24).is_multiple_of(2) { BLUES[0] } else { [0.80, 0.88, 0.96] };
    let paths = motion.contact_paths()?;
    let mut path = paths[3].clone();
    path.push(path[0]);
    let mut views = Vec::new();
    for (phase, title) in [(0.8, "a position, and the surface of the whole cycle"), (0.55, "another position")] {
        let control = motion.at_phases(&[phase])?.swap_remove(0);
        let mut view = quads(View::new(title, -18.0, 30.0), &grid, &faces);
        view = piped(view, &start.moved(control)?, 0.05, ARCS)?;
        view = view.line(&path, YELLOW, 3.0);
        views.push(hinges(view, &start));
    }
    let words = format!("one end arc is up to {:.0} times as fast as the other", largest(ratios.iter().copied()));
    let scene = Scene {
        title: "Near a singular position motions are surprising".to_owned(),
        subtitle: "Six congruent arcs of 0.9 radians; the surface of the whole cycle; yellow: the path of the middle joint; black: the hinges"
            .to_owned(),
        columns: 2,
        views: views
            .into_iter()
            .zip([words, format!("closes within {:.0e}", motion.closing.unwrap_or(f64::NAN))])
            .map(|(v, w)| v.caption(w))
            .collect(),
    };
    group.picture = Some(scene.write(folder, "singular")?);
    Ok(group)
}
