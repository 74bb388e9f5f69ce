//! Strips of surfaces that they can be exactly, and of some that they cannot.

use std::ops::ControlFlow;

use anyhow::Result;
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::ruled::conditions::Condition;
use shapeop::geometry::ruled::optimise::{Optimised, Options, Task, optimise};
use shapeop::geometry::ruled::report::{ReportOptions, report};
use shapeop::geometry::ruled::single::{SingleOptions, single};
use shapeop::geometry::ruled::start::{Rulings, StartOptions, start};
use shapeop::geometry::ruled::terms::{Weights, points_to_cover};
use shapeop::geometry::ruled::trim::{TrimOptions, trim};
use shapeop::geometry::ruled::{Joints, Strip};
use shapeop::mesh::curve::{CubicBasis, NearestOnCurve};
use shapeop::mesh::patterns::height_field;
use shapeop::mesh::reference::{ReferenceMesh, ReferenceSurface};
use shapeop::mesh::{TriangleMesh, surfaces};

use super::{about, bad_steps, is_refused, largest};
use crate::group::Group;
use crate::shapes::{Shape, Surface, conoid, free_form, noise, saddle, surface_of};

/// Nothing but nearness: no term holds strips where they start.
const BARE: Weights = Weights { proximity: 1.0, beyond: 1e-2, gap: 1.0, coverage: 1.0, thin_plate: 0.0, proximal: 0.0 };

/// Options that go on while anything falls.
fn to_the_end(weights: Weights) -> Options {
    Options { weights, tolerance: 1e-12, ..Options::default() }
}

/// Strips between rows of a surface over x from −1 to 1, with rulings over x = const; all control points but the corners are moved by
/// noise.
pub fn rows(surface: &Surface<'_>, ys: &[f64], count: usize, amount: f64) -> Result<Vec<Strip>> {
    let basis = CubicBasis::new(count, false)?;
    let (knots, spans) = (basis.knots().to_vec(), basis.spans() as f64);
    let x = |i: usize| 2.0 * (knots[i + 1] + knots[i + 2] + knots[i + 3]) / (3.0 * spans) - 1.0;
    let mut noise = noise(7);
    let mut row = |y: f64| -> Vec<DVec3> {
        let point = |i: usize| {
            let shift = DVec3::new(noise(), noise(), noise());
            let is_end = i == 0 || i == count - 1;
            surface.at(x(i), y).point + if is_end { DVec3::ZERO } else { amount * shift }
        };
        (0..count).map(point).collect()
    };
    ys.windows(2).map(|pair| Ok(Strip::new(basis.clone(), [row(pair[0]), row(pair[1])])?)).collect()
}

/// Distances of samples of strips from a surface, those beside it, and of points from the nearest strip.
pub fn distances(strips: &[Strip], surface: &dyn ReferenceSurface, points: &[DVec3]) -> Result<[Vec<f64>; 2]> {
    let mut there = Vec::new();
    for strip in strips {
        let feet = strip.mesh(61, 9)?.points.into_iter().map(|p| (p, surface.nearest(p)));
        there.extend(feet.filter(|(_, foot)| foot.overhang < 1e-9).map(|(p, foot)| p.distance(foot.point)));
    }
    let surfaces = strips.iter().map(surface_of).collect::<Result<Vec<_>>>()?;
    let nearest = |p: &DVec3| surfaces.iter().map(|s| s.nearest(*p).point.distance(*p)).fold(f64::INFINITY, f64::min);
    Ok([there, points.iter().map(nearest).collect()])
}

/// The largest distances both ways.
fn deviations(strips: &[Strip], surface: &dyn ReferenceSurface, points: &[DVec3]) -> Result<[f64; 2]> {
    Ok(distances(strips, surface, points)?.map(|distances| largest(distances.into_iter())))
}

pub fn quietly(task: Task<'_>, options: &Options) -> shapeop::error::Result<Optimised> {
    optimise(task, options, &mut |_| ControlFlow::Continue(()))
}

pub fn exact() -> Result<Group> {
    let mut group = Group::new(
        "truths: surfaces that strips can be",
        "Known surfaces as formulas; the saddle as a mesh too. Corners are fixed, all else starts moved by noise.",
    );
    let shape = saddle();
    let surface = shape.surface()?;
    let size = surface.diagonal();
    let cover = shape.mesh(21, 21)?.points;
    let mut bad = 0;
    for count in [4, 11] {
        let strips = rows(&surface, &[-1.0, 1.0], count, 0.05)?;
        let conditions = Condition::fixed_ends(&strips);
        let joints = Joints::default();
        let task =
            Task { strips: &strips, joints: &joints, reference: &surface, cover: &cover, conditions: &conditions };
        let found = quietly(task, &to_the_end(BARE))?;
        bad += bad_steps(&found);
        let name = format!("saddle as one strip, n = {}", count - 1);
        group.at_most(&format!("{name}: the proximity part of F"), found.last().parts.proximity, 1e-20);
        let [there, back] = deviations(&found.strips, &surface, &cover)?;
        group.at_most(&format!("{name}: strip to surface / diagonal"), there / size, 1e-10);
        group.at_most(&format!("{name}: surface to strip / diagonal"), back / size, 1e-10);
    }
    let mesh = TriangleMesh::new(&shape.mesh(41, 41)?)?;
    let reference = ReferenceMesh::new(&mesh);
    // The chord error of the mesh itself: how far the surface is from it.
    let chord = largest(shape.mesh(401, 401)?.points.into_iter().map(|p| reference.nearest(p).point.distance(p)));
    let strips = rows(&surface, &[-1.0, 1.0], 8, 0.03)?;
    let (conditions, joints, cover) = (Condition::fixed_ends(&strips), Joints::default(), points_to_cover(&mesh, 400));
    let task = Task { strips: &strips, joints: &joints, reference: &reference, cover: &cover, conditions: &conditions };
    let found = quietly(task, &Options::default())?;
    bad += bad_steps(&found);
    let there = deviations(&found.strips, &reference, &[])?[0];
    group.plain("saddle, mesh of 41 by 41: its chord error / diagonal", chord / size);
    group.at_most("saddle, that mesh: strip to mesh over the chord error", there / chord, 2.0);
    recovered_conoid(&mut group)?;
    bad += helicoid(&mut group)?;
    group.at_most("steps without the decrease that Armijo's rule asks", bad as f64, 0.0);
    Ok(group)
}

fn recovered_conoid(group: &mut Group) -> Result<()> {
    let shape = conoid();
    let surface = shape.surface()?;
    let curve = |s: f64| -> Vec<DVec3> { (0..=4000).map(|i| shape.point(f64::from(i) / 2000.0, s)).collect() };
    let (first, second, cover) = (curve(1.0), curve(2.0), shape.mesh(41, 9)?.points);
    let across = |_: usize, p: DVec3| Some(DVec3::new(2.0 * p.x, 2.0 * p.y, p.z));
    let options = SingleOptions { control_count: 13, is_conoidal: true, ..SingleOptions::default() };
    let rulings = Rulings::Traced(&across);
    let go_on = &mut |_: &_| ControlFlow::Continue(());
    let found = single([&first, &second], false, rulings, (&surface, &cover), &options, go_on)?;
    let strip = found.strip();
    let [there, back] = deviations(std::slice::from_ref(strip), &surface, &cover)?;
    group.at_most(
        "conoid as one conoidal strip, n = 12: largest distance / diagonal",
        there.max(back) / surface.diagonal(),
        1e-5,
    );
    let off = strip.control(0).iter().zip(strip.control(1)).map(|(a, b)| (*b - *a).dot(found.axis).abs());
    group.at_most("conoid as one conoidal strip: control rulings along w", largest(off), 1e-10);
    group.at_most(
        "conoid as one conoidal strip: sine of w to the exact axis",
        found.axis.cross(DVec3::Z).length(),
        1e-6,
    );
    Ok(())
}

fn helicoid(group: &mut Group) -> Result<usize> {
    let shape = Shape::new("helicoid", [[0.4, 1.6], [-0.2, 3.2]], surfaces::helicoid(0.8));
    let surface = shape.surface()?;
    let boundary = |u: f64| -> Vec<DVec3> { (0..=30_000).map(|i| shape.point(u, f64::from(i) / 10_000.0)).collect() };
    let boundaries = [boundary(0.5), boundary(1.5)];
    let trace = |_: usize, p: DVec3| Some(DVec3::new(3.0 * p.x, 3.0 * p.y, p.z));
    let cover: Vec<DVec3> =
        (0..300).map(|i| shape.point(0.6 + 0.2 * f64::from(i % 5), 0.05 * f64::from(i / 5))).collect();
    let (mut last, mut bad) = (None::<[f64; 2]>, 0);
    for spans in [6, 12, 24] {
        let options = StartOptions { control_count: spans + 3, is_shared: false };
        let started = start(&boundaries, &[false; 2], Rulings::Traced(&trace), options)?;
        let joints = Joints::default();
        let task =
            Task { strips: &started.strips, joints: &joints, reference: &surface, cover: &cover, conditions: &[] };
        let found = quietly(task, &Options::default())?;
        bad += bad_steps(&found);
        let errors = [&found.history[0], found.last()].map(|iteration| iteration.parts.proximity.sqrt());
        group.plain(&format!("helicoid strip of {spans} spans: root mean square / diagonal, started"), errors[0]);
        group.plain(&format!("helicoid strip of {spans} spans: the same, optimised"), errors[1]);
        if let Some(last) = last {
            group.at_least(
                &format!("helicoid, {} to {spans} spans: started, fell by", spans / 2),
                last[0] / errors[0],
                10.0,
            );
            group.at_least(
                &format!("helicoid, {} to {spans} spans: optimised, fell by", spans / 2),
                last[1] / errors[1],
                10.0,
            );
        }
        last = Some(errors);
    }
    Ok(bad)
}

/// Iterations until what is minimised falls by less than these parts of itself: 1e-2, 1e-3, 1e-6.
fn iterations_until_flat(found: &Optimised) -> [f64; 3] {
    let falls: Vec<f64> = found.history.windows(2).map(|pair| 1.0 - pair[1].value / pair[0].value).collect();
    [1e-2, 1e-3, 1e-6].map(|part| falls.iter().position(|fall| *fall < part).unwrap_or(falls.len()) as f64)
}

pub fn free_form_strips() -> Result<Group> {
    let mut group = Group::new(
        "truths: strips of z = xy + 0.1 (x³ − 3xy²)",
        "Over [−1, 1] × [−0.8, 0.8]: 11 control points, corners fixed, start moved by noise of 0.02.",
    );
    let shape = free_form(0.1, [1.0, 0.8]);
    let surface = shape.surface()?;
    let cover = shape.mesh(21, 21)?.points;
    let mut bad = 0;
    for (count, expected) in [(1_u32, 0.133), (2, 0.034), (4, 0.0085)] {
        let ys: Vec<f64> = (0..=count).map(|i| -0.8 + 1.6 * f64::from(i) / f64::from(count)).collect();
        let strips = rows(&surface, &ys, 11, 0.02)?;
        let (conditions, joints) = (Condition::fixed_ends(&strips), Joints::chain(strips.len()));
        let task =
            Task { strips: &strips, joints: &joints, reference: &surface, cover: &cover, conditions: &conditions };
        let found = quietly(task, &to_the_end(Weights::default()))?;
        bad += bad_steps(&found);
        about(
            &mut group,
            &format!("{count} strips: largest deviation"),
            deviations(&found.strips, &surface, &[])?[0],
            expected,
            0.2,
        );
        let usual = iterations_until_flat(&found);
        for (part, until) in [1e-2, 1e-3, 1e-6].into_iter().zip(usual) {
            let what = format!("{count} strips: iterations until F falls by less than {part:e}");
            if part == 1e-3 { group.at_most(&what, until, 15.0) } else { group.plain(&what, until) }
        }
        // Fixed corners keep strips from shrinking, so that nothing need be covered; the proximal term keeps them from sliding.
        let firm = Weights { coverage: 0.0, proximal: 1e-3, ..Weights::default() };
        let found = quietly(task, &to_the_end(firm))?;
        bad += bad_steps(&found);
        let [soon, _, last] = iterations_until_flat(&found);
        group.at_most(&format!("{count} strips, nothing to cover, proximal 1e-3: the same, 1e-2"), soon, 4.0);
        let most = if count == 1 { 7.0 } else { 20.0 };
        group.at_most(&format!("{count} strips, nothing to cover, proximal 1e-3: the same, 1e-6"), last, most);
    }
    let strips = rows(&surface, &[-0.8, 0.0, 0.8], 11, 0.02)?;
    let joints = Joints::chain(2);
    let bare = Task { strips: &strips, joints: &joints, reference: &surface, cover: &[], conditions: &[] };
    let refused = quietly(bare, &Options { weights: Weights { coverage: 0.0, ..BARE }, ..Options::default() });
    group.at_least("nothing that holds strips: refused", is_refused(refused, Status::InvalidValue, "strips[0]"), 1.0);
    for (name, cover) in [("points to cover", &cover[..]), ("the proximal term alone", &[])] {
        let found = quietly(Task { cover, ..bare }, &Options::default())?;
        bad += bad_steps(&found);
        let parts = found.strips.iter().zip(&strips).map(|(after, before)| after.area() / before.area());
        group.at_least(&format!("free ends, {name}: least area left"), parts.fold(f64::INFINITY, f64::min), 0.5);
    }
    gradient(&mut group)?;
    group.at_most("steps without the decrease that Armijo's rule asks", bad as f64, 0.0);
    Ok(group)
}

/// The first-order decrease that a step promises, against central differences of what is minimised along it. Of one strip all samples
/// have the same shares wherever it starts, so that a run of no iterations gives the value at any place.
fn gradient(group: &mut Group) -> Result<()> {
    let shape = free_form(0.1, [1.0, 0.8]);
    let surface = shape.surface()?;
    let cover = shape.mesh(11, 11)?.points;
    let strips = rows(&surface, &[-0.75, 0.7], 7, 0.05)?;
    let (conditions, joints) = (Condition::fixed_ends(&strips), Joints::default());
    let mut worst = 0.0_f64;
    for weights in [Weights { coverage: 0.0, ..BARE }, Weights { proximity: 0.0, ..BARE }, BARE] {
        let run = |strips: &[Strip], max_iterations| {
            let task = Task { strips, joints: &joints, reference: &surface, cover: &cover, conditions: &conditions };
            quietly(task, &Options { weights, max_iterations, ..Options::default() })
        };
        let found = run(&strips, 1)?;
        let (taken, promised) = (found.last().taken, found.last().promised);
        let value = |part: f64| -> Result<f64> {
            let moved = |side: usize| {
                let both = strips[0].control(side).iter().zip(found.strips[0].control(side));
                both.map(|(from, to)| *from + (part / taken) * (*to - *from)).collect()
            };
            let strip = Strip::new(strips[0].basis().clone(), [moved(0), moved(1)])?;
            Ok(run(&[strip], 0)?.history[0].value)
        };
        let h = 1e-4;
        let quotient = (value(-h)? - value(h)?) / (2.0 * h);
        worst = worst.max((quotient / promised - 1.0).abs());
    }
    group.at_most("slope along the first step off difference quotients, relative", worst, 1e-6);
    Ok(())
}

/// The strip whose boundaries are straight lines from `from[side]` to `to[side]`, run through evenly.
fn straight(count: usize, from: [DVec3; 2], to: [DVec3; 2]) -> Result<Strip> {
    let basis = CubicBasis::new(count, false)?;
    let (knots, spans) = (basis.knots().to_vec(), basis.spans() as f64);
    let t = |i: usize| (knots[i + 1] + knots[i + 2] + knots[i + 3]) / (3.0 * spans);
    let control = [0, 1].map(|side| (0..count).map(|i| from[side].lerp(to[side], t(i))).collect());
    Ok(Strip::new(basis, control)?)
}

pub fn joined() -> Result<Group> {
    let mut group = Group::new("truths: gaps, kinks and trimmed strips", "");
    let shape = free_form(0.05, [1.0, 1.0]);
    let surface = shape.surface()?;
    let cover = shape.mesh(21, 21)?.points;
    let mut strips = rows(&surface, &[-1.0, 0.0], 11, 0.0)?;
    strips.extend(rows(&surface, &[0.01, 1.0], 11, 0.0)?);
    let joints = Joints::chain(2);
    let options = Options { max_iterations: 10, ..Options::default() };
    let task = |joints| Task { strips: &strips, joints, reference: &surface, cover: &cover, conditions: &[] };
    let found = quietly(task(&joints), &options)?;
    let gap = |strips: &[Strip]| -> Result<f64> {
        let curve = NearestOnCurve::new(strips[1].boundary(0))?;
        Ok(largest(strips[0].rulings(200).iter().map(|[_, end]| curve.nearest(*end).distance)))
    };
    group.plain("two strips: gap at the start / diagonal", gap(&strips)? / surface.diagonal());
    group.at_most("two strips: gap after 10 iterations / diagonal", gap(&found.strips)? / surface.diagonal(), 1e-4);
    let shared = Joints { is_shared: true, ..joints.clone() };
    let one = quietly(task(&shared), &options)?;
    let apart = one.strips[0].control(1).iter().zip(one.strips[1].control(0)).map(|(a, b)| a.distance(*b));
    group.at_most("two strips, shared boundary: gap", largest(apart), 0.0);
    group.at_most(
        "steps without the decrease that Armijo's rule asks",
        (bad_steps(&found) + bad_steps(&one)) as f64,
        0.0,
    );

    let flat = TriangleMesh::new(&height_field(5, 5, [-1.0, 1.0], [-1.0, 1.0], |_, _| 0.0)?)?;
    let reference = ReferenceMesh::new(&flat);
    for degrees in [0.0, 10.0] {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let p = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let side = |x: f64, y: f64| DVec3::new(x, y * cos, y * sin);
        let first = straight(5, [p(-0.9, -0.8), p(-0.9, 0.0)], [p(0.9, -0.6), p(0.9, 0.0)])?;
        let second = straight(7, [p(-0.8, 0.0), side(-0.9, 0.6)], [p(0.8, 0.0), side(0.8, 0.7)])?;
        let found = report(&[first, second], &reference, &reference, &ReportOptions::default())?;
        let off = (found.max_kink_deg - degrees).abs().max((found.mean_kink_deg - degrees).abs());
        group.at_most(&format!("planes at {degrees} degrees: kink off that"), off, 1e-9);
    }
    let square = TriangleMesh::new(&height_field(9, 9, [0.0, 1.0], [0.0, 1.0], |_, _| 0.0)?)?;
    let p = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let over = straight(5, [p(-0.5, -0.2), p(-0.2, 1.4)], [p(1.6, -0.4), p(1.2, 1.1)])?;
    let trimmed = trim(&[over], &ReferenceMesh::new(&square), &TrimOptions::default())?;
    group.at_most("a strip over a unit square, trimmed: area off 1", (trimmed[0].area() - 1.0).abs(), 1e-6);
    Ok(group)
}
