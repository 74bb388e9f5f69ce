//! Transformations and their inverse problems: Figs. 3, 20 to 23.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::canal::c_canal::{CCanal, Target, c_canal};
use shapeop::geometry::canal::chain::Transform;
use shapeop::geometry::canal::inversion::{GeneralCircle, Inversion};
use shapeop::geometry::canal::m_moulding::{MouldingCenter, m_moulding};
use shapeop::geometry::canal::m_revolution::m_revolution;
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::parallel::check_parallel;
use shapeop::geometry::canal::revolution_centers::Center;
use shapeop::geometry::canal::surface::{BaseKind, SuperCanal};
use shapeop::mesh::Grid;
use shapeop::mesh::fit::Plane;

use super::{exact, met};
use crate::group::Group;
use crate::shapes::{Cyclide, c_guide, chord, ellipse, farthest, planar_curve};
use shapeop_cli::scene::{BLUE, INK, ORANGE, RED, Scene, View, WHITE};

pub fn figure3(folder: &Path) -> Result<Group> {
    let mut surface = SuperCanal::new(Cyclide::new()?.net([0.3, 2.0], [-0.7, 1.3], 9, 7)?, BaseKind::Canal);
    let column = (0..8).map(|k| 1.0 + 0.5 * (0.9 * f64::from(k)).sin()).collect();
    surface.push(Transform::Combescure { column, row: vec![0.7, 0.8, 1.0, 1.2, 1.5, 1.8] })?;
    let (before, after) = (surface.base().grid(), surface.net().grid());
    let mut group = Group::new(
        "Fig. 3: a Combescure transformation by propagation",
        "Column 0 and row 0 have lengths of their own; all others follow, face by face.",
    );
    exact(&mut group, &[before, after]);
    group.at_most("largest sine of corresponding edges", check_parallel(before, after)?.largest_sine, 1e-12);
    let back = farthest(surface.restored()?.grid().points(), before.points()) / before.diagonal();
    group.at_most("inverse, from the start / diagonal", back, 1e-9);
    let view = |title: &str, grid: &Grid| {
        View::new(title, 40.0, 40.0).grid(grid, WHITE).line(&grid.column(0), ORANGE, 3.6).line(grid.row(0), BLUE, 3.6)
    };
    let scene = Scene {
        title: "Fig. 3: parallel circular nets".to_owned(),
        subtitle: "Orange and blue: the edges whose lengths are given; all edges of both nets are parallel".to_owned(),
        columns: 2,
        views: vec![view("a net on a Dupin cyclide", before), view("its Combescure transform", after)],
    };
    group.picture = Some(scene.write(folder, "figure3")?);
    Ok(group)
}

pub fn figure20(folder: &Path) -> Result<Group> {
    let (curve, p2, p3) = planar_curve(41);
    let found = m_revolution(&curve, p2, p3, Center::Middle, DVec3::Z, 25)?;
    let (grid, base) = (found.image.grid()?, &found.image.base.grid);
    let mut group = Group::new(
        "Fig. 20: an M-revolution surface from a planar curve and two points",
        "41 points of the curve, 25 of each arch.",
    );
    exact(&mut group, &[&grid, base]);
    met(&mut group, "the curve", farthest(&grid.column(0), &curve), &grid);
    let ends = grid.at(0, 24).distance(p2).max(grid.at(40, 24).distance(p3));
    met(&mut group, "the two points", ends, &grid);
    let upright = (0..41).map(|i| Plane::fitting(grid.row(i))).map(|plane| plane.normal.z.abs());
    group.at_most("arches off vertical planes", upright.fold(0.0, f64::max), 1e-9);
    let corners = found.corners.points();
    let mut result = View::new("the surface", 12.0, 34.0).grid(&grid, WHITE).line(&curve, ORANGE, 3.6);
    result =
        result.line(&grid.column(24), RED, 2.4).dots(&[p2, p3], BLUE, 5.0).dots(&[corners[0], corners[3]], ORANGE, 5.0);
    if let GeneralCircle::Circle(circle) = found.corners.circle_of_centers() {
        group.plain("radius of the circle of centres", circle.radius);
    }
    result = result.circle(&found.corners.circle(), INK, 1.0);
    let start =
        View::new("its base, a surface of revolution", 12.0, 34.0).grid(base, WHITE).line(&base.column(0), ORANGE, 3.6);
    let scene = Scene {
        title: "Fig. 20: a surface from the inversion of a surface of revolution".to_owned(),
        subtitle: "Given: the planar curve (orange) and two points (blue) on a circle with its ends; the arches \
            are vertical circles"
            .to_owned(),
        columns: 2,
        views: vec![start, result],
    };
    group.picture = Some(scene.write(folder, "figure20")?);
    Ok(group)
}

fn c_canal_of(section: &[DVec3], factor: impl Fn(f64) -> f64) -> Result<(CCanal, Vec<f64>)> {
    let lengths: Vec<f64> = (0..=24).map(|k| chord(section) * factor(f64::from(k) / 24.0)).collect();
    let found = c_canal(&c_guide(24), section, Target::Lengths(&lengths), true, &mut |_| ControlFlow::Continue(()))?;
    Ok((found, lengths))
}

pub fn figure21(folder: &Path) -> Result<Group> {
    let section = ellipse(14, 0.62);
    let outputs = [c_canal_of(&section, |_| 1.0)?, c_canal_of(&section, |s| 1.0 - 0.45 * s * s)?];
    let mut group = Group::new(
        "Fig. 21: C-canal surfaces from a guide and a planar section",
        "Two sets of lengths across: constant, and shrinking; 24 sections of 14 edges.",
    );
    let fine: Vec<Net> = outputs.iter().map(|(found, _)| Ok(found.surface.refined(2, 1)?)).collect::<Result<_>>()?;
    exact(&mut group, &[fine[0].grid(), fine[1].grid()]);
    let mut views = Vec::new();
    let (mut off_plane, mut off_guide, mut off_section, mut off_length) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    for ((found, lengths), net) in outputs.iter().zip(&fine) {
        let grid = found.surface.net().grid();
        for (k, length) in lengths.iter().enumerate() {
            let plane = Plane::fitting(grid.row(k));
            off_plane = grid.row(k).iter().map(|&point| plane.height(point).abs()).fold(off_plane, f64::max);
            off_length = off_length.max((chord(grid.row(k)) - length).abs());
        }
        off_guide = off_guide.max(farthest(&grid.column(0), &c_guide(24)));
        off_section = off_section.max(farthest(grid.row(0), &section));
        let last = grid.columns() - 1;
        let title = if views.is_empty() { "lengths across constant" } else { "lengths across shrinking" };
        let view = View::new(title, 40.0, 36.0).grid(net.grid(), WHITE).line(&grid.column(0), ORANGE, 3.6);
        views.push(view.line(grid.row(0), BLUE, 3.6).line(&grid.column(last), RED, 2.4));
    }
    let grid = fine[0].grid();
    met(&mut group, "the guide", off_guide, grid);
    met(&mut group, "the section", off_section, grid);
    group.at_most("sections off their planes / diagonal", off_plane / grid.diagonal(), 1e-10);
    group.at_most("lengths off those asked for / diagonal", off_length / grid.diagonal(), 1e-9);
    let base = outputs[0].0.surface.base().grid();
    let start = View::new("the canal surface beneath the first", 40.0, 36.0).grid(base, WHITE).line(
        &base.column(0),
        ORANGE,
        3.6,
    );
    views.insert(0, start.line(base.row(0), BLUE, 3.6));
    let scene = Scene {
        title: "Fig. 21: C-canal surfaces".to_owned(),
        subtitle:
            "Orange: the guide curve; blue: the planar section; red: the far border, of which the distance is given"
                .to_owned(),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "figure21")?);
    Ok(group)
}

pub fn figure22(folder: &Path) -> Result<Group> {
    let mut surface = c_canal_of(&ellipse(6, 0.62), |_| 1.0)?.0.surface;
    let grid = surface.net().grid();
    let center = grid.at(12, 3) + 2.4 * grid.diagonal() * DVec3::new(-0.3, 0.2, 0.5);
    surface.push(Transform::Inversion(Inversion::new(center, grid.diagonal().powi(2))?))?;
    let mut group = Group::new(
        "Fig. 22: remeshing of a super-canal surface",
        &format!("A {} surface of 24 × 6 faces; refined at its base, sent through its chain.", surface.family()),
    );
    let coarse = surface.net().grid();
    let nets: Vec<Net> = [1, 2, 4].iter().map(|&pieces| Ok(surface.refined(pieces, pieces)?)).collect::<Result<_>>()?;
    exact(&mut group, &nets.iter().map(Net::grid).collect::<Vec<_>>());
    let mut kept = 0.0_f64;
    for (net, pieces) in nets.iter().zip([1, 2, 4]) {
        for i in 0..coarse.rows() {
            for j in 0..coarse.columns() {
                kept = kept.max(net.grid().at(pieces * i, pieces * j).distance(coarse.at(i, j)));
            }
        }
    }
    group.at_most("points of the coarse mesh, moved by / diagonal", kept / coarse.diagonal(), 1e-9);
    let mut views = Vec::new();
    for (net, title) in nets.iter().zip(["24 × 6", "48 × 12", "96 × 24"]) {
        let grid = net.grid();
        let view = View::new(title, 215.0, 40.0).grid(grid, WHITE);
        views.push(view.line(&grid.column(0), ORANGE, 3.0).line(grid.row(0), BLUE, 3.0));
    }
    let scene = Scene {
        title: "Fig. 22: remeshing at three densities".to_owned(),
        subtitle: "An MC-canal surface; all points of the coarse mesh stay where they are; orange: the guide, \
            blue: the section"
            .to_owned(),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "figure22")?);
    Ok(group)
}

pub fn figure23(folder: &Path) -> Result<Group> {
    let (curve, p2, p3) = planar_curve(41);
    // Half an ellipse in space that leaves the ground orthogonally at both ends.
    let (middle, half) = (0.5 * (curve[0] + p2), 0.5 * (curve[0] - p2));
    let side = half.cross(DVec3::Z);
    let rail: Vec<DVec3> = (0..=24)
        .map(|k| {
            let (sine, cosine) = (PI * f64::from(k) / 24.0).sin_cos();
            match k {
                0 => curve[0],
                24 => p2,
                _ => middle + cosine * half + 1.25 * half.length() * sine * DVec3::Z + 0.35 * sine * sine * side,
            }
        })
        .collect();
    let found = m_moulding(&curve, &rail, MouldingCenter::Corner { p3, center: Center::Angle(0.4) })?;
    let (grid, base) = (found.image.grid()?, &found.image.base.grid);
    let mut group = Group::new(
        "Fig. 23: an M-moulding surface through two curves",
        "A planar curve of 41 points, and one in space of 25.",
    );
    exact(&mut group, &[&grid, base]);
    met(&mut group, "the planar curve", farthest(&grid.column(0), &curve), &grid);
    met(&mut group, "the curve in space", farthest(grid.row(0), &rail), &grid);
    group.at_most("edges reversed in the base", found.reversed_count as f64, 0.0);
    let plane = Plane::fitting(&rail);
    let bend = rail.iter().map(|&point| plane.height(point).abs()).fold(0.0, f64::max) / grid.diagonal();
    group.at_least("the second curve off any plane / diagonal", bend, 1e-3);
    let view = |title: &str, grid: &Grid| {
        View::new(title, 12.0, 34.0).grid(grid, WHITE).line(&grid.column(0), ORANGE, 3.6).line(grid.row(0), BLUE, 3.6)
    };
    let scene = Scene {
        title: "Fig. 23: an M-moulding surface that passes through two prescribed curves".to_owned(),
        subtitle: "Only the orange curve is planar; it and the blue one are rows of points of the surface".to_owned(),
        columns: 2,
        views: vec![view("the base, swept along the image of the blue curve", base), view("the surface", &grid)],
    };
    group.picture = Some(scene.write(folder, "figure23")?);
    Ok(group)
}
