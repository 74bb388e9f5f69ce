//! Linkages of six arcs.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};
use std::ops::ControlFlow;

use anyhow::{Context, Result};
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::snakes::cycle::{End, Motion, Options, cycle};
use shapeop::geometry::snakes::{Linkage, Snake};

use super::{exactly, holds, is_refused};
use crate::group::Group;
use crate::own::{basis, determinant, jacobian, largest, stretch};
use crate::shapes::{TORSIONS, linked};

/// How far apart the extreme positions of `p_2` about the axis from `p_0` to `p_1` are, or of `p_{N−1}` about the last edge: the
/// extreme of the parabola through the extreme frame and its neighbours.
fn range(frames: &[Vec<DVec3>], [from, to, moving]: [usize; 3]) -> f64 {
    let axis = (frames[0][to] - frames[0][from]).normalize();
    let out = |frame: &[DVec3]| (frame[moving] - frame[from]).reject_from_normalized(axis);
    let start = out(&frames[0]);
    let angle = |frame: &[DVec3]| axis.dot(start.cross(out(frame))).atan2(start.dot(out(frame)));
    let angles: Vec<f64> = frames.iter().map(|frame| angle(frame)).collect();
    let extreme = |sign: f64| {
        let count = angles.len();
        let best = (0..count).fold(0, |best, i| if sign * angles[i] > sign * angles[best] { i } else { best });
        let [a, b, c] = [best + count - 1, best, best + 1].map(|i| angles[i % count]);
        let bend = a - 2.0 * b + c;
        if bend == 0.0 { b } else { b - (c - a).powi(2) / (8.0 * bend) }
    };
    extreme(1.0) - extreme(-1.0)
}

/// In how many ways it moves with four points held, by Gram and Schmidt.
fn freedoms(snake: &Snake) -> usize {
    let count = snake.control().len();
    let is_free = |i: usize| (2..count - 2).contains(&(i / 3));
    let rows = jacobian(snake.control(), false, &[])
        .into_iter()
        .map(|row| row.into_iter().enumerate().filter(|(i, _)| is_free(*i)).map(|(_, value)| value).collect());
    3 * (count - 4) - basis(rows.collect()).len()
}

/// The determinant of the lines of the first six hinges, moments about the middle contact over the snake's size.
fn hinges(snake: &Snake) -> f64 {
    let (contacts, control) = (snake.contacts(), snake.control());
    let line = |i: usize| {
        let along = (control[i + 1] - contacts[i]).normalize();
        let moment = (contacts[i] - contacts[3]).cross(along) / snake.size();
        [along.to_array(), moment.to_array()].concat()
    };
    determinant((0..6).map(line).collect())
}

pub fn around(step_rad: f64) -> Result<Motion> {
    let linkage = Linkage::new(linked(FRAC_PI_3, &TORSIONS)?)?;
    Ok(cycle(&linkage, &Options { step_rad, ..Options::default() }, &mut |_| ControlFlow::Continue(()))?)
}

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: the linkage of six arcs (Bartoň et al. 2013, section 4.2)",
        "Radius 1, angle π/3, torsions 1, −0.7, 0.9, −0.8, 0.6, end arcs on hinges; ranges from points of the frames.",
    );
    let snake = linked(FRAC_PI_3, &TORSIONS)?;
    let last = snake.control()[7].distance(DVec3::new(-0.356912243, -0.054958131, 0.607451979));
    group.at_most("its last point, off the known one", last, 1e-8);
    exactly(&mut group, "ways to move", freedoms(&snake), 1);
    for h in [0.04, 0.02, 0.01] {
        let motion = around(h)?;
        holds(&mut group, &format!("step {h}: it comes back"), motion.end == End::Closed);
        let closing = motion.closing.context("no closing")?;
        if h == 0.02 {
            group.at_most("step 0.02: closes within", closing, 1e-8);
            group.between(
                "step 0.02: range of the first arc, radians",
                range(&motion.frames, [0, 1, 2]),
                [1.158, 1.162],
            );
            group.between(
                "step 0.02: range of the last arc, radians",
                range(&motion.frames, [6, 7, 5]),
                [1.822, 1.826],
            );
            let off = (0..motion.frames.len()).map(|i| Ok(stretch(&snake, &motion.snake(i)?)));
            group.at_most("step 0.02: distances off by", largest(off.collect::<Result<Vec<_>>>()?.into_iter()), 1e-12);
            let fixed = motion.frames.iter().flat_map(|f| [0, 1, 6, 7].map(|i| f[i].distance(snake.control()[i])));
            group.at_most("step 0.02: held points move by", largest(fixed), 0.0);
            group.plain("step 0.02: changes of the drive", motion.switch_count as f64);
            let ways = (0..motion.frames.len()).map(|i| Ok(freedoms(&motion.snake(i)?)));
            let ways = ways.collect::<Result<Vec<_>>>()?;
            exactly(
                &mut group,
                "step 0.02: positions with one way to move",
                ways.iter().filter(|n| **n == 1).count(),
                ways.len(),
            );
        } else {
            group.plain(&format!("step {h}: closes within"), closing);
        }
        group.plain(&format!("step {h}: steps"), motion.frames.len() as f64);
    }
    let other = Linkage::new(linked(1.2, &[2.0, -1.0, 1.5, -1.0, 2.0])?)?;
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    holds(
        &mut group,
        "angle 1.2, torsions 2, −1, 1.5, −1, 2: it comes back",
        cycle(&other, &Options::default(), go_on)?.end == End::Closed,
    );

    let singular = linked(FRAC_PI_2, &[1.2; 5])?;
    group.at_most("all torsions 1.2, angle π/2: determinant of hinges", hinges(&singular).abs(), 1e-9);
    let linkage = Linkage::new(singular)?;
    group.at_most("all torsions 1.2, angle π/2: the same, ours", linkage.determinant()?.abs(), 1e-9);
    let call = cycle(&linkage, &Options::default(), go_on);
    holds(&mut group, "all torsions 1.2, angle π/2: refused, singular", is_refused(call, Status::Singular, "linkage"));
    let regular = Linkage::new(snake)?;
    group.at_most(
        "determinants of the first, unequal by",
        (hinges(regular.snake()).abs() - regular.determinant()?.abs()).abs(),
        1e-12,
    );
    for (name, torsions, ways) in
        [("seven arcs", &[1.0, -0.7, 0.9, -0.8, 0.6, 0.3][..], 2), ("five arcs", &[1.0, -0.7, 0.9, -0.8], 0)]
    {
        let snake = linked(1.0, torsions)?;
        exactly(&mut group, &format!("{name}: ways to move"), freedoms(&snake), ways);
        let linkage = Linkage::new(snake)?;
        exactly(&mut group, &format!("{name}: the same, ours"), linkage.freedoms(), ways);
        let call = cycle(&linkage, &Options::default(), go_on);
        holds(
            &mut group,
            &format!("{name}: refused, an invalid value"),
            is_refused(call, Status::InvalidValue, "linkage"),
        );
    }
    Ok(group)
}
