//! Figs. 2 and 5: a hull covered with pipes and lamellae, and a snake that climbs a tower.

use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::covering::lamella;
use shapeop::geometry::snakes::evolution::{Options, Stop, Weights};
use shapeop::geometry::snakes::fit::{self, fit, fit_closed};
use shapeop::geometry::snakes::projection;
use shapeop::mesh::patterns::parametric_surface;
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Grid, ReferenceSurface, TriangleMesh};
use shapeop_cli::scene::{BLUE, INK, RED, Scene, View};

use super::drawing::{
    ARCS, PER_ARC, SHEET, THIN, both_ways, every, framed, in_words, line, piped, quads, sheet, swept, told,
};
use crate::group::Group;
use crate::own::largest;
use crate::shapes::{on, run};

/// A hull: a barrel whose half width and height change along it.
fn hull(u: f64, v: f64) -> DVec3 {
    let (wide, high) = (1.0 + 0.07 * (1.1 * u).sin(), 0.85 + 0.06 * (1.3 * u + 0.4).cos());
    DVec3::new(u, wide * v.sin(), high * v.cos())
}

pub fn figure2(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 2: a hull covered with pipes and with lamellae",
        "Eight arcs fitted to a section of the hull move along it both ways; each position is a pipe, or a lamella that stands on\n\
         the hull.",
    );
    let mesh = parametric_surface(121, 81, [-1.6, 1.6], [-1.3, 1.3], hull)?;
    let triangles = TriangleMesh::new(&mesh)?;
    let reference = ReferenceMesh::new(&triangles);
    let section: Vec<DVec3> = (0..=400).map(|k| hull(0.1, 1.25 * (f64::from(k) / 200.0 - 1.0))).collect();
    let options = fit::Options { is_congruent: false, ..fit::Options::default() };
    let snake = fit(&section, 8, &options, &mut |_| ControlFlow::Continue(()))?.snake;
    let options = Options { step: 0.02, max_steps: 75, max_deviation: 0.06, ..Options::default() };
    let snakes = both_ways(&on(&snake, &reference), &options, 0.1)?;

    let told = told(&mut group, &snakes, &triangles)?;
    let view = |title: &str| View::new(title, 32.0, 28.0);
    let mut first = sheet(view("positions of one snake"), &mesh, SHEET);
    for positions in &snakes {
        first = line(first, positions, BLUE, 1.5);
    }
    first = line(first, &snake, RED, 3.0);
    let (mut pipes, mut lamellae) = (view("pipes"), view("lamellae"));
    for positions in &snakes {
        pipes = piped(pipes, positions, 0.03, ARCS)?;
        let up = |p: DVec3| {
            let normal = reference.nearest(p).normal;
            if normal.dot(p) < 0.0 { -normal } else { normal }
        };
        let band = lamella(positions, 0.13, PER_ARC, &up)?;
        lamellae = quads(lamellae, &band, &|_, j| ARCS[(j / PER_ARC) % 2]);
        lamellae = lamellae.line(band.row(0), THIN, 0.7).line(band.row(1), THIN, 0.7);
    }
    let all = || snakes.iter().flat_map(|s| s.sample(2));
    let scene = Scene {
        title: "Tubular and laminar covering of a hull by positions of one snake".to_owned(),
        subtitle: "Each pipe and each lamella follows the same eight arcs; yellow and white: arcs in turn".to_owned(),
        columns: 3,
        views: vec![
            first.caption(in_words(&told, triangles.diagonal())),
            framed(pipes, all()).caption(format!("{} pipes of eight arcs", snakes.len())),
            framed(lamellae, all()).caption(format!("{} lamellae that stand on the hull", snakes.len())),
        ],
    };
    group.picture = Some(scene.write(folder, "covering")?);
    Ok(group)
}

/// A tower with the section of a rounded triangle, which turns as it rises and closes towards the top.
fn tower(angle: f64, z: f64) -> DVec3 {
    let above = ((z - 1.9) / 1.7).max(0.0);
    let radius = (1.0 - 0.75 * above.powi(2)) * (1.0 + 0.06 * (3.0 * (angle - 0.35 * z)).cos());
    DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
}

pub fn figure5(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 5: a closed snake climbs a tower until it cannot",
        "Fifteen arcs fitted to the section near the foot; up to where the tower closes, the deviation stops it.",
    );
    let (rows, columns, high) = (145, 144, 3.5);
    let at =
        |k: usize| tower(TAU * (k % columns) as f64 / columns as f64, high * (k / columns) as f64 / (rows - 1) as f64);
    let mesh = Grid::new((0..rows * columns).map(at).collect(), rows, columns, [false, true])?.mesh();
    let triangles = TriangleMesh::new(&mesh)?;
    let reference = ReferenceMesh::new(&triangles);
    let section: Vec<DVec3> = (0..450).map(|k| tower(TAU * f64::from(k) / 450.0, 0.12)).collect();
    let fitted = fit_closed(&section, 15, &fit::Options::default(), &mut |_| ControlFlow::Continue(()))?;
    let (snake, limit) = (fitted.snake, 0.03);
    group.at_most("the closed fit: distances off by", fitted.residual, 1e-12);
    group.plain("the closed fit: largest distance of the section", fitted.deviation);
    let outward = reference.nearest(snake.contacts()[0]);
    let speeds = [outward.normal.dot(outward.point.with_z(0.0)).signum()];
    let weights = Weights { offset: 0.1, ..Weights::default() };
    let options = Options {
        step: 0.02,
        max_steps: 400,
        max_deviation: limit,
        weights,
        projection: projection::Options { surface_weight: 0.0, ..projection::Options::default() },
        ..Options::default()
    };
    let task = shapeop::geometry::snakes::evolution::Task { speeds: &speeds, ..on(&snake, &reference) };
    let found = run(&task, &options)?;
    group.at_least("the deviation stops it", f64::from(matches!(found.stop, Stop::Deviation(_))), 1.0);
    let snakes = every(&found, 0.1);
    group.at_most(
        "contacts and middles of arcs off the tower",
        largest(found.frames.iter().map(|f| f.deviation)),
        limit,
    );
    let height = |k: usize| snakes[k].contacts().iter().map(|c| c.z).sum::<f64>() / 15.0;
    let spacing: Vec<f64> = (1..snakes.len()).map(|k| height(k) - height(k - 1)).collect();
    group.plain("height reached, of 3.5", height(snakes.len() - 1));
    group.plain("spacing of positions drawn, least", spacing.iter().copied().fold(f64::INFINITY, f64::min));
    group.plain("spacing of positions drawn, largest", largest(spacing.iter().copied()));
    let told = told(&mut group, &snakes, &triangles)?;
    let view = |title: &str| View::new(title, 20.0, 24.0);
    let mut climb = sheet(view("positions of the snake"), &mesh, SHEET);
    for positions in &snakes {
        climb = line(climb, positions, BLUE, 1.4);
    }
    climb = line(line(climb, &snakes[0], INK, 3.2), &snakes[snakes.len() - 1], RED, 3.2);
    let surface = swept(view("the surface that it sweeps"), &snakes, 4, ARCS)?;
    let mut surface = framed(surface, mesh.points.iter().step_by(7).copied());
    for positions in snakes.iter().step_by(4) {
        surface = line(surface, positions, THIN, 0.8);
    }
    let mut pipes = view("the same as pipes");
    for positions in snakes.iter().step_by(2) {
        pipes = piped(pipes, positions, 0.022, ARCS)?;
    }
    let scene = Scene {
        title: "A closed snake of constant length climbs a tower until the tower is too narrow".to_owned(),
        subtitle: "Its section is a rounded triangle that turns with the height and closes towards the top; black: the first position, \
            red: the last"
            .to_owned(),
        columns: 3,
        views: vec![
            climb.caption(format!("it stops where it would be farther than {limit} off the tower")),
            surface.caption(in_words(&told, triangles.diagonal())),
            framed(pipes, mesh.points.iter().step_by(7).copied()).caption("arcs in turn yellow and white".to_owned()),
        ],
    };
    group.picture = Some(scene.write(folder, "tower")?);
    Ok(group)
}
