//! How long things take, on one core: medians of repeated runs.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::canal::circles::Section;
use shapeop::geometry::canal::combescure::{Lengths, combescure};
use shapeop::geometry::canal::fit::{FitOptions, fit};
use shapeop::geometry::canal::frame::Frame;
use shapeop::geometry::canal::inversion::Inversion;
use shapeop::geometry::canal::normals::Orientation;
use shapeop::geometry::canal::parallel::ParallelMeshes;
use shapeop::geometry::canal::smoothing::{Input, Options, smooth};
use shapeop::geometry::canal::strip::{self, Strip, of_border_edges, of_lengths};
use shapeop::linalg::bfgs::Stop;
use shapeop::mesh::Grid;
use shapeop::mesh::curve::Spacing;

use crate::group::Group;
use crate::shapes::{Cyclide, Random, free_form};

const RUNS: usize = 50;

/// The median of the seconds that `RUNS` runs take, after one that does not count.
fn seconds<T>(mut run: impl FnMut() -> Result<T>) -> Result<f64> {
    black_box(run()?);
    let mut all = Vec::with_capacity(RUNS);
    for _ in 0..RUNS {
        let start = Instant::now();
        black_box(run()?);
        all.push(start.elapsed().as_secs_f64());
    }
    all.sort_by(f64::total_cmp);
    Ok(all[RUNS / 2])
}

/// The quotient of the times of two things that are done by turns, so that a machine that slows down does so for both.
fn quotient(mut one: impl FnMut() -> Result<()>, mut other: impl FnMut() -> Result<()>) -> Result<f64> {
    let mut all = Vec::with_capacity(RUNS);
    for _ in 0..RUNS {
        let start = Instant::now();
        one()?;
        let middle = Instant::now();
        other()?;
        all.push((middle - start).as_secs_f64() / middle.elapsed().as_secs_f64());
    }
    all.sort_by(f64::total_cmp);
    Ok(all[RUNS / 2])
}

/// A part of a cyclide of so many by so many faces, and random lengths for its transform.
fn case(faces: usize) -> Result<(Grid, Lengths)> {
    let grid = Cyclide::new()?.grid([0.2, 2.2], [-0.9, 1.4], faces + 1, faces + 1)?;
    let mut random = Random(17);
    let lengths = Lengths::of(&grid).scaled(&random.list(faces, 0.5, 2.0), &random.list(faces, 0.5, 2.0))?;
    Ok((grid, lengths))
}

fn combescure_transform() -> Result<Group> {
    let mut group = Group::new(
        "speed: Combescure transformations, one core, medians of 50 runs",
        "The paper states 20 ms for 10 000 faces. Propagation, without a factorisation. Baseline: the null space of all parallel\n\
         meshes by a singular value decomposition, at 20 × 20 faces.",
    );
    let (small, large) = (case(100)?, case(200)?);
    let run = |(grid, lengths): &(Grid, Lengths)| -> Result<()> {
        black_box(combescure(grid, lengths, DVec3::ZERO)?);
        Ok(())
    };
    group.at_most("10 000 faces, milliseconds", 1e3 * seconds(|| run(&small))?, 1.0);
    let ratio = quotient(|| run(&large), || run(&small))?;
    group.at_least("40 000 faces over 10 000", ratio, 3.0);
    group.at_most("40 000 faces over 10 000", ratio, 6.0);
    let coarse = case(20)?;
    let mesh = coarse.0.mesh();
    let start = Instant::now();
    black_box(ParallelMeshes::of(&mesh)?);
    let baseline = start.elapsed().as_secs_f64();
    let own = seconds(|| run(&coarse))?;
    group.plain("20 × 20 faces: null space, milliseconds (one run)", 1e3 * baseline);
    group.plain("20 × 20 faces: propagation, milliseconds", 1e3 * own);
    group.at_least("times sooner than the null space", baseline / own, 1.0);
    Ok(group)
}

fn inversion() -> Result<Group> {
    let mut group = Group::new(
        "speed: inversion of the mesh of 10 000 faces, beside a translation and scaling of the same points",
        "",
    );
    let (grid, _) = case(100)?;
    let inversion = Inversion::new(DVec3::new(0.1, 2.0, 0.3), 1.5)?;
    let inverted = || -> Result<()> {
        black_box(inversion.points(black_box(grid.points()))?);
        Ok(())
    };
    let (factor, step) = (black_box(1.3), black_box(DVec3::new(0.4, 0.1, -0.2)));
    let moved = || -> Result<()> {
        black_box(black_box(grid.points()).iter().map(|&point| factor * point + step).collect::<Vec<DVec3>>());
        Ok(())
    };
    group.plain("inversion, microseconds", 1e6 * seconds(inverted)?);
    group.plain("translation and scaling, microseconds", 1e6 * seconds(moved)?);
    group.at_most("inversion over translation and scaling", quotient(inverted, moved)?, 5.0);
    Ok(group)
}

fn two_curve_fit() -> Result<Group> {
    let mut group = Group::new("speed: fit of two curves, 64 circles of 17 points", "");
    let [first, second] = free_form()?;
    let options = FitOptions {
        circle_count: 64,
        spacing: Spacing::ArcLength,
        column_count: 17,
        orientation: Orientation::Angle(-0.8),
        section: Section::ToCurve { is_long_way: false },
    };
    group.at_most("circles and mesh, milliseconds", 1e3 * seconds(|| Ok(fit(&first, &second, &options)?))?, 5.0);
    Ok(group)
}

/// A curve in space whose strips are smoothed.
pub fn wave(u: f64) -> DVec3 {
    DVec3::new(4.0 * u, (2.5 * u).sin(), 0.3 * u * u)
}

/// A strip of `count` circles whose border edges vary at random, and a frame whose crossing arcs rise from it.
pub fn rough_strip(count: usize) -> Result<(Vec<f64>, Strip, Frame)> {
    let mut random = Random(77);
    let parameters: Vec<f64> = (0..=count).map(|k| 2.0 * k as f64 / count as f64).collect();
    let points: Vec<DVec3> = parameters.iter().map(|&u| wave(u)).collect();
    let tangent = (wave(1e-6) - points[0]).normalize();
    let start = points[0] + 1.5 * DVec3::Z.cross(tangent).normalize();
    let fits = strip::Options { fits_start: true, ..strip::Options::default() };
    let even = of_lengths(&points, start, &vec![1.5; count + 1], &fits)?;
    let edges: Vec<f64> =
        even.border.windows(2).map(|pair| pair[0].distance(pair[1]) * random.between(0.7, 1.3)).collect();
    let start = even.border[0];
    let strip = of_border_edges(&points, start, &edges)?;
    let normal = DVec3::Z + (points[0] - start).normalize();
    let frame = Frame::of_tangent_one(tangent, normal).ok_or_else(|| anyhow::anyhow!("no frame"))?;
    Ok((parameters, strip, frame))
}

fn strip_smoothing() -> Result<Group> {
    let mut group = Group::new(
        "speed: smoothing of a strip to its stop",
        "By BFGS over parameters, lengths and the frame, to the decrease below 1e-4 in five iterations; a rough strip.",
    );
    for count in [8, 16] {
        let (parameters, strip, frame) = rough_strip(count)?;
        let input = Input { curve: &wave, parameters: &parameters, strip: &strip, frame };
        let options = Options { max_iterations: 2000, ..Options::default() };
        let run = || Ok(smooth(&input, &options, &mut |_| ControlFlow::Continue(()))?);
        let found = run()?;
        let name = format!("{count} circles, {} iterations, milliseconds", found.history.len() - 1);
        group.at_most(&name, 1e3 * seconds(run)?, 33.0);
        let is_stopped = !matches!(found.stop, Stop::Cancelled | Stop::Iterations);
        group.at_least(&format!("{count} circles: it ended by its own stop"), f64::from(is_stopped), 1.0);
        group.plain(&format!("{count} circles: F after over before"), found.after / found.before);
    }
    Ok(group)
}

fn strip_propagation() -> Result<Group> {
    let mut group = Group::new("speed: propagation of circular strips, linear in their length", "");
    let points = |n: usize| -> Vec<DVec3> {
        (0..=n).map(|k| 3.0 * k as f64 / n as f64).map(|a| DVec3::new(3.0 * a.cos(), 3.0 * a.sin(), 0.0)).collect()
    };
    let strip = |points: &[DVec3]| -> Result<()> {
        black_box(of_lengths(points, DVec3::new(4.0, 0.0, 0.0), &vec![1.0; points.len()], &strip::Options::default())?);
        Ok(())
    };
    let (short, long) = (points(2000), points(8000));
    group.plain("2 000 quads, microseconds", 1e6 * seconds(|| strip(&short))?);
    let ratio = quotient(|| strip(&long), || strip(&short))?;
    group.at_least("8 000 quads over 2 000", ratio, 3.0);
    group.at_most("8 000 quads over 2 000", ratio, 5.0);
    Ok(group)
}

pub fn groups() -> Result<Vec<Group>> {
    [combescure_transform, inversion, two_curve_fit, strip_smoothing, strip_propagation]
        .iter()
        .map(|group| group())
        .collect()
}
