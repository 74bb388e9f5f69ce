//! Strips, circles of two curves, closed strips.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use glam::DVec3;
use shapeop::error::Status;
use shapeop::geometry::canal::circle_strip::CircleStrip;
use shapeop::geometry::canal::circles::Section;
use shapeop::geometry::canal::closing::{Case, ClosedStrip, closed_strip, holonomy};
use shapeop::geometry::canal::fit::{FitOptions, fit_guide};
use shapeop::geometry::canal::inversion::{GeneralSphere, Inversion};
use shapeop::geometry::canal::normals::{Guide, Orientation};
use shapeop::geometry::canal::quality::Quality;
use shapeop::geometry::canal::strip::{Options, of_border_edges, of_lengths};
use shapeop::geometry::canal::two_curves::spheres_at_points;
use shapeop::geometry::circle::{Circle, Sphere};
use shapeop::mesh::curve::{Curve, FnCurve, NearestOnCurve, Spacing, Spline};

use super::{off_circle, refused};
use crate::group::Group;
use crate::shapes::{RADII, Random, farthest, free_form};

pub fn group() -> Result<Group> {
    let mut group = Group::new("truths: strips, fits of two curves, closed strips", "");
    lengths(&mut group)?;
    spheres(&mut group)?;
    fits(&mut group)?;
    closed(&mut group)?;
    Ok(group)
}

fn lengths(group: &mut Group) -> Result<()> {
    let at = |radius: f64, angle: f64| radius * DVec3::new(angle.cos(), angle.sin(), 0.0);
    let points: Vec<DVec3> = (0..=24).map(|k| at(3.0, TAU * f64::from(k) / 24.0)).collect();
    let strict = Options { is_strict: true, ..Options::default() };
    let (mut off, mut crossed) = (0.0_f64, 0);
    for radius in [2.0, 4.0] {
        let strip = of_lengths(&points, at(radius, 0.0), &[1.0; 25], &strict)?;
        for (point, border) in points.iter().zip(&strip.border) {
            off = off.max(border.distance(radius / 3.0 * *point)).max((border.distance(*point) - 1.0).abs());
        }
        crossed += strip.flipped.len() + Quality::of(&strip.grid()?).crossed_count();
    }
    group.at_most("T-C13 constant lengths on a circle: off the concentric one", off, 1e-12);
    group.at_most("T-C13 quads out of cyclic order, inside and outside", crossed as f64, 0.0);

    let points: Vec<DVec3> = (0..5).map(|k| f64::from(k) * DVec3::X).collect();
    let start = DVec3::new(-0.3, 1.0, 0.0);
    let free = of_border_edges(&points, start, &[1.0; 4])?;
    let diameter = 2.0 * free.circles()?[1].radius;
    let mut asked = free.lengths.clone();
    asked[2] = 1.05 * diameter;
    let error = refused(of_lengths(&points, start, &asked, &Options::default()))?;
    let is_named = error.status() == Status::NoIntersection && error.place() == "lengths[2]";
    group.at_least("T-C14 a length above the diameter: refused at its index", f64::from(is_named), 1.0);
    let project = Options { projects_lengths: true, ..Options::default() };
    let strip = of_lengths(&points, start, &asked, &project)?;
    group.at_most("T-C14 projected: length less the diameter", (strip.lengths[2] - diameter).abs(), 1e-12);
    let achieved = strip.lengths.iter().zip(&asked).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    group.at_most("T-C14 deviation told less that found", (strip.deviation - achieved).abs(), 0.0);
    Ok(())
}

/// Point and two derivatives at `u` of the curve on the torus with `[v, v', v'']`.
pub fn on_torus(u: f64, [v, v1, v2]: [f64; 3]) -> [DVec3; 3] {
    let [axis, tube] = RADII;
    let ((su, cu), (sv, cv)) = (u.sin_cos(), v.sin_cos());
    let (rho, rho1) = (axis + tube * cv, -tube * sv * v1);
    let rho2 = -tube * (cv * v1 * v1 + sv * v2);
    let second = DVec3::new(rho2 * cu - 2.0 * rho1 * su - rho * cu, rho2 * su + 2.0 * rho1 * cu - rho * su, 0.0);
    [
        DVec3::new(rho * cu, rho * su, tube * sv),
        DVec3::new(rho1 * cu - rho * su, rho1 * su + rho * cu, tube * cv * v1),
        second + tube * (cv * v2 - sv * v1 * v1) * DVec3::Z,
    ]
}

fn wave(u: f64) -> [f64; 3] {
    [2.0 + 0.3 * (2.0 * u).sin(), 0.6 * (2.0 * u).cos(), -1.2 * (2.0 * u).sin()]
}

/// The image of a jet by an inversion.
fn inverted(inversion: Inversion, [point, q1, q2]: [DVec3; 3]) -> [DVec3; 3] {
    let q = point - inversion.center();
    let (s, s1, s2) = (q.dot(q), 2.0 * q.dot(q1), 2.0 * (q1.dot(q1) + q.dot(q2)));
    let first = q1 / s - q * (s1 / (s * s));
    let second = q2 / s - q1 * (2.0 * s1 / (s * s)) + q * (2.0 * s1 * s1 / (s * s * s) - s2 / (s * s));
    let k = inversion.ratio();
    [inversion.center() + k * q / s, k * first, k * second]
}

fn spheres(group: &mut Group) -> Result<()> {
    let first = |u: f64| on_torus(u, [0.5, 0.0, 0.0])[0];
    let inward = |u: f64| -DVec3::new(0.5_f64.cos() * u.cos(), 0.5_f64.cos() * u.sin(), 0.5_f64.sin());
    let center = |u: f64| RADII[0] * DVec3::new(u.cos(), u.sin(), 0.0);
    let us: Vec<f64> = (0..24).map(|k| 2.5 * f64::from(k) / 23.0).collect();
    let points: Vec<DVec3> = us.iter().map(|&u| first(u)).collect();
    let normals: Vec<DVec3> = us.iter().map(|&u| inward(u)).collect();
    let second = FnCurve::new([-0.5, 3.0], false, |u| on_torus(u, wave(u)))?;
    let found = spheres_at_points(&points, &normals, &NearestOnCurve::new(&second)?)?;
    let off = found.touching.iter().zip(&us).map(|(it, &u)| {
        (it.offset - RADII[1]).abs().max(it.sphere.center.distance(center(u))).max((it.sphere.radius - RADII[1]).abs())
    });
    group.at_most("T-C15 two curves of a torus: spheres off its tube", off.fold(0.0, f64::max), 1e-10);
    let steps = found.touching.iter().map(|it| it.step_count).max().unwrap_or(usize::MAX);
    group.at_most("T-C15 Newton steps", steps as f64, 5.0);

    let inversion = Inversion::new(DVec3::new(0.3, -0.4, 1.9), 2.3)?;
    let second = FnCurve::new([-0.5, 3.0], false, |u| inverted(inversion, on_torus(u, wave(u))))?;
    let points = inversion.points(&points)?;
    let normals: Vec<DVec3> = us.iter().map(|&u| inversion.direction(first(u), inward(u)).normalize()).collect();
    let found = spheres_at_points(&points, &normals, &NearestOnCurve::new(&second)?)?;
    let off = found.touching.iter().zip(&us).map(|(it, &u)| {
        let GeneralSphere::Sphere(exact) = inversion.sphere(&Sphere { center: center(u), radius: RADII[1] }) else {
            return f64::INFINITY;
        };
        (it.sphere.center.distance(exact.center) + (it.sphere.radius - exact.radius).abs()) / exact.radius
    });
    group.at_most("T-C16 of a Dupin cyclide: off its spheres / radius", off.fold(0.0, f64::max), 1e-9);

    let line = |y: f64| Spline::through(&[DVec3::new(-2.0, y, 0.0), DVec3::new(6.0, y, 0.0)], false);
    let (width, second) = (1.0, line(1.0)?);
    let curve = NearestOnCurve::new(&second)?;
    let points: Vec<DVec3> = (0..9).map(|k| 0.5 * f64::from(k) * DVec3::X).collect();
    let mut off = 0.0_f64;
    for beta in [0.0, 0.4, -0.9, 1.4_f64] {
        let normal = DVec3::new(0.0, beta.cos(), beta.sin());
        let found = spheres_at_points(&points, &[normal; 9], &curve)?;
        let exact = width / (2.0 * beta.cos());
        off = off.max(found.touching.iter().map(|it| (it.offset / exact - 1.0).abs()).fold(0.0, f64::max));
    }
    group.at_most("T-C17 parallel lines: c off w / (2 cos β), relative", off, 1e-12);
    let upright = super::is_refused(spheres_at_points(&points, &[DVec3::Z; 9], &curve), Status::Degenerate);
    group.at_least("T-C17 a right angle is refused", upright, 1.0);
    Ok(())
}

fn fits(group: &mut Group) -> Result<()> {
    let [first, second] = free_form()?;
    let curve = NearestOnCurve::new(&second)?;
    let (mut off, mut grid_off) = (0.0_f64, 0.0_f64);
    for count in [5, 17, 64] {
        let guide = Guide::along(&first, count, Spacing::ArcLength)?;
        let strip = CircleStrip::new(&guide, Orientation::Angle(-0.8), &curve)?;
        for (circle, point) in strip.circles.iter().zip(guide.points()) {
            off = off.max(circle.distance(*point) / (1.0 + circle.radius));
        }
        let options = FitOptions {
            circle_count: count,
            spacing: Spacing::ArcLength,
            column_count: 17,
            orientation: Orientation::Angle(-0.8),
            section: Section::ToCurve { is_long_way: false },
        };
        let fit = fit_guide(&guide, &curve, &options)?;
        off = off.max(farthest(&fit.grid.column(0), guide.points()));
        grid_off = grid_off.max(off_circle(&fit.grid));
        if count == 64 {
            let touch = strip.spheres.touching.iter().map(|it| {
                let nearest = second.point(it.foot.parameter);
                it.sphere.distance(nearest).abs() / it.sphere.radius
            });
            group.at_most("T-C18 spheres off the second curve / radius", touch.fold(0.0, f64::max), 1e-12);
        }
    }
    group.at_most("T-C18 circles and strip's border off the guide's points", off, 1e-12);
    group.at_most("T-C18 quads of the mesh off their circles / edge", grid_off, 1e-12);
    Ok(())
}

fn closed(group: &mut Group) -> Result<()> {
    let mut random = Random(12);
    let polygon = |count: usize| -> Vec<DVec3> {
        let angle = |k: usize| TAU * k as f64 / count as f64;
        (0..count).map(|k| DVec3::new(angle(k).cos(), angle(k).sin(), 0.0)).collect()
    };
    let mut spherical =
        |count: usize| -> Vec<DVec3> { (0..count).map(|_| 1.7 * random.vector().normalize()).collect() };
    let cases = [
        ("hexagon", polygon(6), true),
        ("heptagon", polygon(7), true),
        ("spherical heptagon", spherical(7), true),
        ("spherical hexagon", spherical(6), false),
    ];
    let space: Vec<DVec3> = (0..7).map(|_| random.vector()).collect();
    for (name, points, closes) in cases.into_iter().chain([("heptagon in space", space, false)]) {
        let found = holonomy(&points)?;
        if closes {
            group.at_most(&format!("T-C19 {name} closes: residual"), found.residual, 1e-10);
        } else {
            group.at_least(&format!("T-C19 {name} does not: residual"), found.residual, 1e-3);
        }
        group.at_least(&format!("T-C19 {name}: told so"), f64::from(found.closes == closes), 1.0);
    }

    let torus = |count: usize, v: f64| -> Vec<DVec3> {
        let angle = |k: usize| TAU * (k as f64 + 0.2 * (k as f64).sin()) / count as f64;
        (0..count).map(|k| on_torus(angle(k), [v, 0.0, 0.0])[0]).collect()
    };
    let (guide, across) = (torus(12, 0.5), torus(12, 1.2));
    let lengths = vec![guide[0].distance(across[0]); 11];
    let strip = of_lengths(&guide[..11], across[0], &lengths, &Options::default())?;
    let one = closed_strip(&strip, guide[11])?;
    group.at_most("T-C20 strip of a torus closes: off its circles", off_circles(&one)?, 1e-10);
    let is_kept = one.closing.case == Case::OneSphere && one.border[0] == across[0];
    group.at_least("T-C20 case of one sphere, P stays", f64::from(is_kept), 1.0);
    let guide: Vec<DVec3> = guide.iter().map(|point| *point + 0.02 * random.vector()).collect();
    let ratio = across[0].length() / guide[0].length();
    let edges: Vec<f64> = guide[..11].windows(2).map(|pair| ratio * pair[0].distance(pair[1])).collect();
    let strip = of_border_edges(&guide[..11], across[0], &edges)?;
    let two = closed_strip(&strip, guide[11])?;
    group.at_most("T-C20 disturbed strip closes: off its circles", off_circles(&two)?, 1e-10);
    let is_moved = two.closing.case == Case::TwoSpheres && two.border[0].distance(across[0]) > 1e-6;
    group.at_least("T-C20 case of two spheres, P moves", f64::from(is_moved), 1.0);
    let first = Circle::through(guide[1], across[0], guide[0]).context("no circle")?;
    group.at_most("T-C20 P moves along its circle: off it", first.distance(two.border[0]), 1e-10);
    Ok(())
}

fn off_circles(closed: &ClosedStrip) -> Result<f64> {
    let n = closed.guide.len();
    let mut off = 0.0_f64;
    for k in 0..n {
        let next = (k + 1) % n;
        let circle = Circle::through(closed.guide[k], closed.border[k], closed.guide[next]).context("no circle")?;
        off = off.max(circle.distance(closed.border[next]));
    }
    Ok(off)
}
