//! Fits of two curves: Figs. 8 to 11, 24 and 25.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use anyhow::{Context, Result};
use glam::DVec3;
use shapeop::geometry::canal::circle_strip::CircleStrip;
use shapeop::geometry::canal::circles::Section;
use shapeop::geometry::canal::fit::{Fit, FitOptions, fit_guide};
use shapeop::geometry::canal::folds::Folds;
use shapeop::geometry::canal::normals::{Guide, Orientation, rotation_minimising};
use shapeop::geometry::canal::two_curves::spheres_at_points;
use shapeop::mesh::Grid;
use shapeop::mesh::curve::{Curve, NearestOnCurve, Spacing, Spline};

use super::{exact, met, sampled};
use crate::group::Group;
use crate::shapes::free_form;
use shapeop_cli::scene::{BLUE, BLUE_FACE, INK, ORANGE, RED, Scene, View, WHITE};

const ANGLE: f64 = -0.8;

fn options(circles: usize, columns: usize, angle: f64, section: Section) -> FitOptions {
    FitOptions {
        circle_count: circles,
        spacing: Spacing::ArcLength,
        column_count: columns,
        orientation: Orientation::Angle(angle),
        section,
    }
}

/// The surface of which every section goes from the guide a little beyond where the second curve passes it.
fn fit_beyond(guide: &Guide, curve: &NearestOnCurve<'_>, columns: usize, angle: f64) -> Result<Fit> {
    let strip = CircleStrip::new(guide, Orientation::Angle(angle), curve)?;
    // Around a circle, of the two ways the one nearer to another angle.
    let turn = |k: usize, to: DVec3, near: f64| {
        let turn = strip.circles[k].angle_between(guide.points()[k], to);
        turn + TAU * ((near - turn) / TAU).round()
    };
    let mut crossings: Vec<(usize, f64)> = Vec::new();
    for (k, crossing) in strip.crossings.iter().enumerate() {
        let last = crossings.last().map_or(0.0, |last| last.1);
        crossings.extend(crossing.map(|crossing| (k, turn(k, crossing.point, last))));
    }
    let mut to_rad = crossings.first().map_or(1.0, |first| first.1);
    let mut fitted = None;
    for _ in 0..4 {
        let section = Section::Angles { from_rad: 0.0, to_rad };
        let fit = fit_guide(guide, curve, &options(0, columns, angle, section))?;
        let short = crossings.iter().map(|&(k, turned)| turned / turn(k, fit.grid.at(k, columns - 1), to_rad));
        to_rad *= 1.02 * short.fold(0.0, f64::max);
        fitted = Some(fit);
    }
    fitted.context("no fit")
}

/// How near a fit is to its two curves: points of column 0 off the first, spheres off the second.
fn curves_met(group: &mut Group, fit: &Fit, first: &dyn Curve, second: &dyn Curve) -> Result<()> {
    let guide = NearestOnCurve::new(first)?;
    let off = fit.grid.column(0).into_iter().map(|point| guide.nearest(point).distance).fold(0.0, f64::max);
    met(group, "first curve", off, &fit.grid);
    let touch = fit.strip.spheres.touching.iter().map(|it| it.sphere.distance(second.point(it.foot.parameter)).abs());
    met(group, "second curve by the spheres", touch.fold(0.0, f64::max), &fit.grid);
    Ok(())
}

pub fn figures8_to_11(folder: &Path) -> Result<Group> {
    let [first, second] = free_form()?;
    let curve = NearestOnCurve::new(&second)?;
    let guide = Guide::along(&first, 41, Spacing::ArcLength)?;
    let normals = rotation_minimising(&guide, Orientation::Angle(ANGLE))?;
    let touching = spheres_at_points(guide.points(), &normals, &curve)?;
    let fit = fit_beyond(&guide, &curve, 15, ANGLE)?;
    let mut group = Group::new(
        "Figs. 8 to 11: a canal surface that fits two curves",
        "41 circles through points of the first curve; spheres touch the second; 15 points to each circle.",
    );
    exact(&mut group, &[&fit.grid]);
    curves_met(&mut group, &fit, &first, &second)?;
    group.at_most("F of equation 6", fit.strip.spheres.residual, 1e-20);
    group.at_most("mesh off the second curve / diagonal", fit.deviation / fit.grid.diagonal(), 1e-3);
    let coarse = fit_beyond(&Guide::along(&first, 21, Spacing::ArcLength)?, &curve, 15, ANGLE)?;
    group.at_least("that of half as many circles, times as far", coarse.deviation / fit.deviation, 3.0);

    let centers: Vec<DVec3> = touching.touching.iter().map(|it| it.sphere.center).collect();
    let longest = touching.touching.iter().map(|it| it.offset.abs()).fold(0.0, f64::max);
    let side = touching.touching[0].offset.signum();
    let ruled = |from: f64, to: f64, directions: &[DVec3]| -> Result<Grid> {
        // Short faces, so that what is before and behind them is drawn so.
        let point = |k: usize| guide.points()[k / 9] + (from + (to - from) * (k % 9) as f64 / 8.0) * directions[k / 9];
        Ok(Grid::new((0..41 * 9).map(point).collect(), 41, 9, [false; 2])?)
    };
    let developable = ruled(0.0, 1.25 * side * longest, &normals)?;
    let binormals: Vec<DVec3> = guide.tangents().iter().zip(&normals).map(|(t, n)| t.cross(*n)).collect();
    let tangential = ruled(-0.35 * longest, 0.35 * longest, &binormals)?;
    let curves = |view: View| view.line(&sampled(&first, 120), ORANGE, 3.6).line(&sampled(&second, 120), RED, 3.6);
    let view = |title: &str| View::new(title, -28.0, 48.0);
    let eight = curves(view("8: the two curves and the surface of centres").grid(&developable, WHITE));
    let nine = view("9: normals along the first, one angle; in blue the tangent developable")
        .grid(&developable, WHITE)
        .grid(&tangential, BLUE_FACE)
        .line(&sampled(&first, 120), ORANGE, 3.6);
    let mut ten = curves(view("10: the centres' locus, as far from both curves").grid(&developable, WHITE))
        .line(&centers, BLUE, 4.0);
    for (it, point) in touching.touching.iter().zip(guide.points()).step_by(4) {
        ten = ten.line(&[*point, it.sphere.center, second.point(it.foot.parameter)], INK, 1.0);
    }
    let mut eleven = curves(view("11: spheres that touch both, their circles, and the mesh").grid(&fit.grid, WHITE));
    for (sphere, circle) in fit.strip.spheres.spheres().iter().zip(&fit.strip.circles).skip(2).step_by(9) {
        eleven = eleven.sphere(sphere.center, sphere.radius, BLUE_FACE, 0.28).circle(circle, BLUE, 1.6);
    }
    let scene = Scene {
        title: "Figs. 8 to 11: a canal surface through one curve, touching another".to_owned(),
        subtitle:
            "Orange: the line of curvature given; red: the curve to fit; dark blue: the locus of the spheres' centres"
                .to_owned(),
        columns: 2,
        views: vec![eight, nine, ten, eleven],
    };
    group.picture = Some(scene.write(folder, "figures8_to_11")?);
    Ok(group)
}

/// Two planar curves, the first on the ground.
fn planar_pair(kind: usize) -> Result<[Spline; 2]> {
    let through = |at: &dyn Fn(f64) -> DVec3| {
        Spline::through(&(0..16).map(|k| at(f64::from(k) / 15.0)).collect::<Vec<_>>(), false)
    };
    Ok(match kind {
        0 => [
            through(&|s| DVec3::new(5.0 * s, 0.7 * (5.0 * s).sin(), 0.0))?,
            through(&|s| DVec3::new(5.2 * s - 0.1, 2.1 + 0.2 * (4.0 * s).cos(), 0.0))?,
        ],
        1 => [
            through(&|s| DVec3::new(5.0 * s, -0.5 * (PI * s).sin(), 0.0))?,
            through(&|s| DVec3::new(5.2 * s - 0.1, 1.8, 0.5 + 0.7 * (TAU * s).sin().powi(2)))?,
        ],
        _ => {
            let arc = |radius: f64, s: f64| radius * DVec3::new((2.2 * s).cos(), (2.2 * s).sin(), 0.0);
            [
                through(&|s| arc(3.2 + 0.25 * (7.0 * s).sin(), s))?,
                through(&|s| arc(1.7, 1.04 * s - 0.02) + 1.1 * DVec3::Z)?,
            ]
        }
    })
}

pub fn figure24(folder: &Path) -> Result<Group> {
    let mut group = Group::new("Fig. 24: canal surfaces that fit two planar curves", "Three pairs, 49 circles each.");
    let mut views = Vec::new();
    let mut grids = Vec::new();
    for (kind, angle, title, azimuth) in [
        (0, -0.55, "both on the ground", -20.0),
        (1, -0.75, "on the ground and in an upright plane", -20.0),
        (2, -0.5, "in parallel planes", 200.0),
    ] {
        let [first, second] = planar_pair(kind)?;
        let guide = Guide::along(&first, 49, Spacing::ArcLength)?;
        let fit = fit_beyond(&guide, &NearestOnCurve::new(&second)?, 15, angle)?;
        curves_met(&mut group, &fit, &first, &second)?;
        let view = View::new(title, azimuth, 34.0).grid(&fit.grid, WHITE);
        let caption = format!("mesh off the red curve: {:.1e} of the diagonal", fit.deviation / fit.grid.diagonal());
        views.push(
            view.line(&sampled(&first, 120), ORANGE, 3.4).line(&sampled(&second, 120), RED, 3.4).caption(caption),
        );
        group.at_most(
            &format!("{title}: mesh off the second curve / diagonal"),
            fit.deviation / fit.grid.diagonal(),
            2e-3,
        );
        grids.push(fit.grid);
    }
    exact(&mut group, &grids.iter().collect::<Vec<_>>());
    let scene = Scene {
        title: "Fig. 24: canal surfaces that fit two planar curves".to_owned(),
        subtitle: "Orange: a line of curvature of the surface; red: the curve to fit".to_owned(),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "figure24")?);
    Ok(group)
}

pub fn figure25(folder: &Path) -> Result<Group> {
    let through = |at: &dyn Fn(f64) -> DVec3| {
        Spline::through(&(0..24).map(|k| at(f64::from(k) / 23.0)).collect::<Vec<_>>(), false)
    };
    // A parabola, and a curve that comes near the centre of curvature at its vertex, (0, 0.8).
    let first = through(&|s| DVec3::new(4.0 * s - 2.0, 0.625 * (4.0 * s - 2.0).powi(2), 0.0))?;
    let second = through(&|s| DVec3::new(1.3 * (2.0 * s - 1.0), 0.72 + 2.0 * (2.0 * s - 1.0).powi(2), 0.55))?;
    let fit = fit_beyond(&Guide::along(&first, 61, Spacing::ArcLength)?, &NearestOnCurve::new(&second)?, 17, -0.5)?;
    let folds = Folds::of(&fit.grid);
    let mut group = Group::new(
        "Fig. 25: lines of curvature concentrate near the evolute of the guide",
        "A parabola, and a second curve near the centre of curvature at its vertex; 61 circles.",
    );
    exact(&mut group, &[&fit.grid]);
    curves_met(&mut group, &fit, &first, &second)?;
    let reach = folds.evolute_ratios.iter().copied().fold(0.0, f64::max);
    group.plain("reach of a section towards the evolute (1: there)", reach);
    group.at_least("rows near the evolute, warned of", folds.rows_near_evolute.len() as f64, 1.0);
    group.plain("panels that shrank", folds.shrunk_faces.len() as f64);
    group.plain("panels folded over", folds.flipped_faces.len() as f64);
    let columns = fit.grid.columns() - 1;
    let is_near = |face: usize| {
        let row = face / columns;
        folds.rows_near_evolute.contains(&row) || folds.rows_near_evolute.contains(&(row + 1))
    };
    let colour = |face: usize| if is_near(face) { [0.95, 0.60, 0.50] } else { WHITE };
    let evolute: Vec<DVec3> = (0..=60)
        .map(|k| f64::from(k) / 60.0 * 1.4 - 0.7)
        // Of y = a x²: (−4a²x³, 3a x² + 1/2a).
        .map(|x: f64| DVec3::new(-4.0 * 0.625 * 0.625 * x.powi(3), 3.0 * 0.625 * x * x + 0.8, 0.0))
        .collect();
    let view = |title: &str, height: f64| {
        let view = View::new(title, 0.0, height).grid_of(&fit.grid, 1.0, &colour);
        view.line(&sampled(&first, 120), ORANGE, 3.4).line(&sampled(&second, 120), RED, 3.4)
    };
    let plan = view("plan, with the evolute of the guide in blue", 90.0).line(
        &evolute.iter().map(|p| *p + 2.0 * DVec3::Z).collect::<Vec<_>>(),
        BLUE,
        2.4,
    );
    let words = format!("{} of {} rows near the evolute", folds.rows_near_evolute.len(), fit.grid.rows());
    let scene = Scene {
        title: "Fig. 25: lines of curvature concentrate near the evolute".to_owned(),
        subtitle: "Red panels: sections that reach beyond 80 % of the way to the evolute of the guide curve, \
            which is warned of"
            .to_owned(),
        columns: 2,
        views: vec![view("the surface", 32.0).caption(words), plan],
    };
    group.picture = Some(scene.write(folder, "figure25")?);
    Ok(group)
}
