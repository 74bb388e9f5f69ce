//! Surfaces on circular strips: Figs. 5, 7 and 15.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result, bail};
use glam::DVec3;
use shapeop::geometry::canal::closing::{ClosedStrip, closed_frame, closed_strip};
use shapeop::geometry::canal::frame::{Frame, closing_gap};
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::normals::{Guide, fitting_tangent};
use shapeop::geometry::canal::smoothing::{Input, Options, smooth};
use shapeop::geometry::canal::strip::{Strip, of_border_edges};
use shapeop::geometry::canal::strip_of_circles::from_circles;
use shapeop::geometry::circle::Circle;
use shapeop::mesh::curve::{Curve, Spline};

use super::{exact, met};
use crate::group::Group;
use crate::shapes::farthest;
use crate::speed::{rough_strip, wave};
use shapeop_cli::scene::{BLUE, ORANGE, RED, Scene, View, WHITE};

pub fn figure5(folder: &Path) -> Result<Group> {
    let circle = |k: i32| {
        let s = f64::from(k);
        let center = DVec3::new(1.1 * s, 1.1 * (0.62 * s).sin(), 0.0);
        Circle { center, normal: DVec3::Z, radius: 1.15 + 0.3 * (0.9 * s).cos() }
    };
    let circles: Vec<Circle> = (0..8).map(circle).collect();
    let found = from_circles(&circles, None, None)?;
    let strip = &found.strip;
    // Sections rise upright from the plane; the tangent along the guide is the one that alternates least.
    let curve = Spline::through(&strip.guide, false)?;
    let tangents: Vec<DVec3> = curve.knots().iter().map(|&knot| curve.tangent(knot)).collect();
    let along = fitting_tangent(&Guide::new(&strip.guide, &tangents, false)?)?;
    let frame = Frame::of_tangent_two(DVec3::Z, along.cross(DVec3::Z)).context("no frame")?;
    let fine = Net::new(strip.grid()?, frame)?.refined(4, 16)?;
    let grid = fine.grid();
    let mut group = Group::new(
        "Fig. 5: a canal surface from eight circles in a plane",
        "The half above the plane; 4 × 16 quads to each patch.",
    );
    exact(&mut group, &[grid]);
    let again = strip.circles()?;
    let off = circles.iter().zip(&again).map(|(a, b)| a.center.distance(b.center) + (a.radius - b.radius).abs());
    met(&mut group, "the circles drawn", off.fold(0.0, f64::max), grid);
    group.at_least(
        "lowest point / diagonal",
        grid.points().iter().map(|p| p.z).fold(0.0, f64::min) / grid.diagonal(),
        -1e-12,
    );
    let half = (0..grid.rows()).map(|i| {
        let (first, middle, last) = (grid.at(i, 0), grid.at(i, 8), grid.at(i, 16));
        Circle::through(first, middle, last)
            .map_or(f64::INFINITY, |c| c.center.distance(0.5 * (first + last)) / c.radius)
    });
    group.at_most("sections off half circles / radius", half.fold(0.0, f64::max), 1e-9);
    let view = |title: &str| {
        let view = View::new(title, -18.0, 38.0).line(&strip.guide, ORANGE, 3.0).line(&strip.border, RED, 3.0);
        circles.iter().fold(view, |view, circle| view.circle(circle, BLUE, 1.6))
    };
    let crossing =
        |view: View| strip.guide.iter().zip(&strip.border).fold(view, |view, (a, b)| view.line(&[*a, *b], BLUE, 0.9));
    let surface = View::new("the half above the plane", -18.0, 38.0).grid(grid, WHITE);
    let coarse = fine.grid();
    let surface = surface.line(&coarse.column(0), ORANGE, 3.0).line(&coarse.column(16), RED, 3.0);
    let scene = Scene {
        title: "Fig. 5: a canal surface from a strip of eight circles".to_owned(),
        subtitle: "Circles in one plane; their intersections are the strip's points; sections are half circles \
            upright to the plane"
            .to_owned(),
        columns: 2,
        views: vec![
            crossing(view("eight circles and their strip")).dots(&strip.guide, ORANGE, 3.6).dots(
                &strip.border,
                RED,
                3.6,
            ),
            surface,
        ],
    };
    group.picture = Some(scene.write(folder, "figure5")?);
    Ok(group)
}

pub fn figure7(folder: &Path) -> Result<Group> {
    let (parameters, strip, frame) = rough_strip(16)?;
    let input = Input { curve: &wave, parameters: &parameters, strip: &strip, frame };
    // Wider bounds lower F a little more, and crowd points together where the guide is straight.
    let options = Options { max_iterations: 2000, spacing_ratio: 2.0, ..Options::default() };
    let found = smooth(&input, &options, &mut |_| ControlFlow::Continue(()))?;
    let fine = |strip: &Strip, frame: Frame| Ok::<_, anyhow::Error>(Net::new(strip.grid()?, frame)?.refined(4, 12)?);
    let (before, after) = (fine(&strip, frame)?, fine(&found.strip, found.frame)?);
    let mut group = Group::new(
        "Fig. 7: smoothing of a strip of sixteen circles",
        "Sum of the squared curvatures of all edges' arcs, before and after; the guide stays on its curve.",
    );
    exact(&mut group, &[before.grid(), after.grid()]);
    let on_curve: Vec<DVec3> = found.parameters.iter().map(|&u| wave(u)).collect();
    met(&mut group, "the guide curve", farthest(&found.strip.guide, &on_curve), after.grid());
    group.plain("F before", found.before);
    group.at_most("F after over before", found.after / found.before, 0.5);
    group.plain("iterations", (found.history.len() - 1) as f64);
    let spacings = |parameters: &[f64]| parameters.windows(2).map(|ends| ends[1] - ends[0]).collect::<Vec<f64>>();
    let (now, then) = (spacings(&found.parameters), spacings(&parameters));
    let factors: Vec<f64> = now.iter().zip(&then).map(|(now, then)| now / then).collect();
    let [least, most] = [f64::min, f64::max].map(|of| factors.iter().copied().reduce(of).unwrap_or(f64::NAN));
    group.at_most("spacings, changed against each other", most / least, options.spacing_ratio + 1e-9);
    let view = |title: &str, net: &Net, strip: &Strip, value: f64| {
        let view = View::new(title, -25.0, 42.0).grid(net.grid(), WHITE).line(&net.grid().column(0), ORANGE, 3.4);
        let view = view.line(&net.grid().column(net.grid().columns() - 1), BLUE, 2.0);
        view.dots(&strip.guide, ORANGE, 3.2).caption(format!("F = {value:.3}"))
    };
    let scene = Scene {
        title: "Fig. 7: smoothing a canal surface".to_owned(),
        subtitle: "Orange: the guide curve, kept exactly; its points, the lengths across and the frame are free"
            .to_owned(),
        columns: 2,
        views: vec![view("before", &before, &strip, found.before), view("after", &after, &found.strip, found.after)],
    };
    group.picture = Some(scene.write(folder, "figure7")?);
    Ok(group)
}

/// A strip around a circle whose other border winds on a sphere. One half is scaled so that it ends opposite to its
/// start, where its
/// mirror image goes on; the last quad is left to [`closed_strip`].
fn ring() -> Result<ClosedStrip> {
    let at = |k: usize| TAU * k as f64 / 48.0;
    let guide: Vec<DVec3> = (0..48).map(|k| 3.0 * DVec3::new(at(k).cos(), at(k).sin(), 0.0)).collect();
    let start = DVec3::new(2.9, 0.0, 3.0);
    let half = |scale: f64| -> Result<(Strip, f64)> {
        let factor = |k: usize| 1.0 + 0.16 * (3.0 * (at(k) + 0.5 * at(1))).sin();
        let edges: Vec<f64> = (0..24).map(|k| scale * factor(k) * guide[0].distance(guide[1])).collect();
        let strip = of_border_edges(&guide[..25], start, &edges)?;
        let turns = strip.border.windows(2).map(|ends| ends[0].truncate().angle_to(ends[1].truncate()));
        let turn = turns.sum();
        Ok((strip, turn))
    };
    let (mut low, mut high) = (0.6, 1.3);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let turn = half(middle).map_or(f64::INFINITY, |(_, turn)| turn);
        if turn < PI { low = middle } else { high = middle }
    }
    let border = half(low)?.0.border;
    let mirrored = border[2..24].iter().rev().map(|point| DVec3::new(point.x, -point.y, point.z));
    let border: Vec<DVec3> = border.iter().copied().chain(mirrored).collect();
    let edges: Vec<f64> = border.windows(2).map(|ends| ends[0].distance(ends[1])).collect();
    let closed = closed_strip(&of_border_edges(&guide[..47], start, &edges)?, guide[47])?;
    if closed.flipped.is_empty() { Ok(closed) } else { bail!("the ring is crossed at {:?}", closed.flipped) }
}

pub fn figure15(folder: &Path) -> Result<Group> {
    let closed = ring()?;
    let across = closed.border[0] - closed.guide[0];
    let tangent = DVec3::Y;
    // Sections that lean outwards at the ring.
    let wish =
        Frame::of_tangent_one(tangent, tangent.cross(across).normalize() - 0.35 * DVec3::Z).context("no frame")?;
    let frame = closed_frame(&closed.guide, &wish)?;
    let net = Net::new(closed.grid()?, frame)?;
    let fine = net.refined(2, 14)?;
    let grid = fine.grid();
    let mut group = Group::new(
        "Fig. 15: a closed façade as a canal surface",
        "A closed strip of 48 quads over a ring, each patch 2 × 14; the mesh wraps.",
    );
    exact(&mut group, &[grid]);
    let guide: Vec<DVec3> = (0..48).map(|k| grid.at(2 * k, 0)).collect();
    met(&mut group, "the ring's points", farthest(&guide, &closed.guide), grid);
    group.at_most("frames across the seam, from themselves", closing_gap(grid, fine.frames()), 1e-9);
    group.at_most("rows that do not wrap", f64::from(!grid.wraps()[0]), 0.0);
    let view = |title: &str, azimuth: f64, height: f64| {
        let ring = |j: usize| [grid.column(j), vec![grid.at(0, j)]].concat();
        View::new(title, azimuth, height).grid(grid, WHITE).line(&ring(0), ORANGE, 3.4).line(&ring(14), RED, 3.0)
    };
    let scene = Scene {
        title: "Fig. 15: a closed façade, covered with a circular mesh".to_owned(),
        subtitle: "Orange: the ring it stands on; red: the upper border of the closed strip, on a sphere with the ring"
            .to_owned(),
        columns: 2,
        views: vec![view("from the ground", 20.0, 16.0), view("from above", 20.0, 48.0)],
    };
    group.picture = Some(scene.write(folder, "figure15")?);
    Ok(group)
}
