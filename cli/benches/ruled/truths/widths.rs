//! How the deviation of strips falls with their width.

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::ruled::conditions::Condition;
use shapeop::geometry::ruled::optimise::{Options, Task};
use shapeop::geometry::ruled::start::{Rulings, StartOptions, start};
use shapeop::geometry::ruled::{Joints, Strip};
use shapeop::mesh::reference::ReferenceSurface;

use super::strips::{distances, quietly, rows};
use super::{bad_steps, largest};
use crate::group::Group;
use crate::shapes::{free_form, noise};

/// The third power of half the width: what is off falls to an eighth; fixed rulings that are no asymptotic curves let it fall to a
/// quarter.
const FREE: f64 = 6.0;
const FIXED: f64 = 3.5;

const PART: f64 = 0.1;

/// Where the asymptotic curve of z = xy + c (x³ − 3xy²) that runs across the rows leads from a point to a row: the direction (p, 1)
/// in the parameters has p² z_xx + 2 p z_xy + z_yy = 0, of whose roots it is the one that is near 0.
fn asymptotic(from: DVec3, row: f64) -> DVec3 {
    let slope = |x: f64, y: f64| {
        let [a, b, c] = [6.0 * PART * x, 1.0 - 6.0 * PART * y, -6.0 * PART * x];
        -c / (b + (b * b - a * c).sqrt())
    };
    let steps = 40;
    let (mut x, mut y, h) = (from.x, from.y, (row - from.y) / f64::from(steps));
    for _ in 0..steps {
        let k1 = slope(x, y);
        let k2 = slope(x + 0.5 * h * k1, y + 0.5 * h);
        let k3 = slope(x + 0.5 * h * k2, y + 0.5 * h);
        let k4 = slope(x + h * k3, y + h);
        x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        y += h;
    }
    DVec3::new(x, y, x * y + PART * (x.powi(3) - 3.0 * x * y * y))
}

/// The largest and the root mean square of the distances both ways.
fn off(strips: &[Strip], surface: &dyn ReferenceSurface, points: &[DVec3]) -> Result<[f64; 2]> {
    let [there, back] = distances(strips, surface, points)?;
    let rms = |all: &[f64]| (all.iter().map(|d| d * d).sum::<f64>() / all.len() as f64).sqrt();
    Ok([largest(there.iter().chain(&back).copied()), rms(&there).max(rms(&back))])
}

fn levels(count: u32) -> Vec<f64> {
    (0..=count).map(|i| -0.8 + 1.6 * f64::from(i) / f64::from(count)).collect()
}

/// Prints how much numbers fall from each count to the next. Without a bound where `least` has none.
fn falls(group: &mut Group, name: &str, counts: &[u32], all: &[[f64; 2]], least: [Option<f64>; 2]) {
    for (k, kind) in ["largest", "root mean square"].into_iter().enumerate() {
        for (pair, count) in all.windows(2).zip(&counts[1..]) {
            let (what, value) =
                (format!("{name}, {} to {count} strips: {kind}, fell by", count / 2), pair[0][k] / pair[1][k]);
            match least[k] {
                Some(least) => group.at_least(&what, value, least),
                None => group.plain(&what, value),
            }
        }
    }
}

pub fn group() -> Result<Group> {
    let mut group = Group::new(
        "truths: deviation and width",
        "The free form as a formula, strips between its rows y = const; their number is doubled.",
    );
    let counts = [1, 2, 4, 8, 16];
    let shape = free_form(PART, [1.0, 0.8]);
    let surface = shape.surface()?;
    let cover = shape.mesh(21, 21)?.points;
    let (mut fixed, mut bad) = (Vec::new(), 0);
    for count in counts {
        let strips = rows(&surface, &levels(count), 11, if count > 4 { 0.0 } else { 0.02 })?;
        let (conditions, joints) = (Condition::fixed_ends(&strips), Joints::chain(strips.len()));
        let task =
            Task { strips: &strips, joints: &joints, reference: &surface, cover: &cover, conditions: &conditions };
        let found = quietly(task, &Options::default())?;
        bad += bad_steps(&found);
        fixed.push(off(&found.strips, &surface, &[DVec3::ZERO])?);
    }
    falls(&mut group, "fixed ends over x = const", &counts, &fixed, [Some(FIXED), None]);

    // Along these curves x grows with y: the first row is short, and all curves that start in it meet the others.
    let shape = free_form(PART, [1.5, 0.85]);
    let surface = shape.surface()?;
    let mut noise = noise(5);
    let cover: Vec<DVec3> = (0..600).map(|_| shape.point(0.5 * noise(), 0.8 * noise())).collect();
    let counts = [2, 4, 8, 16, 32];
    let (mut started, mut optimised) = (Vec::new(), Vec::new());
    for count in counts {
        let ys = levels(count);
        let row = |y: &f64| -> Vec<DVec3> {
            let half = if *y == -0.8 { 0.6 } else { 1.4 };
            (0..=4000).map(|i| shape.point(half * (f64::from(i) / 2000.0 - 1.0), *y)).collect()
        };
        let boundaries: Vec<Vec<DVec3>> = ys.iter().map(row).collect();
        let trace = |strip: usize, p: DVec3| Some(asymptotic(p, ys[strip + 1]));
        let options = StartOptions { control_count: 20, is_shared: true };
        let first = start(&boundaries, &vec![false; ys.len()], Rulings::Traced(&trace), options)?;
        let joints = Joints { is_shared: true, ..Joints::chain(first.strips.len()) };
        let task = Task { strips: &first.strips, joints: &joints, reference: &surface, cover: &cover, conditions: &[] };
        started.push(off(&first.strips, &surface, &cover)?);
        let found = quietly(task, &Options::default())?;
        bad += bad_steps(&found);
        optimised.push(off(&found.strips, &surface, &cover)?);
    }
    for (name, all) in [("rulings along asymptotic curves", &started), ("the same, optimised", &optimised)] {
        group.plain(&format!("{name}: largest at 2 strips"), all[0][0]);
        group.plain(&format!("{name}: largest at 32 strips"), all[counts.len() - 1][0]);
        falls(&mut group, name, &counts, all, [Some(FREE), None]);
    }
    group.at_most("steps without the decrease that Armijo's rule asks", bad as f64, 0.0);
    Ok(group)
}
