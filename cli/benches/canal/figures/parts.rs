//! What is built of a surface: beams of a pavilion (Fig. 16), panels with mitre cuts (Figs. 17 and 18).

use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result};
use glam::DVec3;
use shapeop::geometry::canal::node_axes::NodeAxes;
use shapeop::geometry::canal::panels::{Panel, beams, offset, panels};
use shapeop::geometry::canal::parallel::check_parallel;
use shapeop::geometry::canal::quality::largest;
use shapeop::mesh::Grid;

use super::exact;
use crate::group::Group;
use crate::shapes::shell;
use shapeop_cli::scene::{INK, Scene, View, WOOD};

fn upward(axes: &[DVec3]) -> Vec<DVec3> {
    let is_down = axes.iter().map(|axis| axis.z).sum::<f64>() < 0.0;
    axes.iter().map(|axis| if is_down { -*axis } else { *axis }).collect()
}

pub fn figure16(folder: &Path) -> Result<Group> {
    let net = shell(16, 9)?;
    let grid = net.grid();
    let normals: Vec<DVec3> = net.frames().iter().map(|frame| frame.normal).collect();
    let before = NodeAxes::of(grid, &normals)?;
    let after = NodeAxes::of_least_gaps(grid, &mut |_| ControlFlow::Continue(()))?;
    let height = 0.22;
    let mut group = Group::new(
        "Fig. 16: a pavilion of planar beams without torsion",
        "Node axes handed on by reflection; beams of constant height 0.22 on a surface 6 long.",
    );
    exact(&mut group, &[grid]);
    let moved = offset(grid, &upward(&normals), height)?;
    group.at_most("offset along the normals: largest sine of edges", check_parallel(grid, &moved)?.largest_sine, 1e-10);
    let far = grid.points().iter().zip(moved.points()).map(|(a, b)| (a.distance(*b) - height).abs());
    group.at_most("its distance, from constant / height", far.fold(0.0, f64::max) / height, 1e-12);
    let mut torsion = 0.0_f64;
    for axes in [&before, &after] {
        for beam in beams(grid, &axes.axes, height)? {
            let [a, b, c, d] = beam.corners;
            torsion = torsion.max((b - a).normalize().cross((d - a).normalize()).dot((c - a).normalize()).abs());
        }
    }
    group.at_most("beams off their planes / length", torsion, 1e-10);
    let (worst_before, worst_after) = (before.largest_gap(height), after.largest_gap(height));
    let mean =
        |axes: &NodeAxes| (axes.gaps.iter().map(|gap| gap * gap).sum::<f64>() / axes.gaps.len() as f64).sqrt() * height;
    group.plain("gaps at nodes / height, axes along normals: mean", mean(&before) / height);
    group.plain("largest", worst_before / height);
    group.plain("after optimisation: mean", mean(&after) / height);
    group.plain("largest after", worst_after / height);
    group.at_most("sum of squares, after over before", (mean(&after) / mean(&before)).powi(2), 1.0);
    let largest_gap = largest(&before.gaps).max(largest(&after.gaps));
    let view = |title: &str, axes: &NodeAxes| -> Result<View> {
        let mut view = View::new(title, -22.0, 30.0);
        let directions = upward(&axes.axes);
        for beam in beams(grid, &directions, height)? {
            let [a, b, c, d] = beam.corners;
            view = view.face(&[a, b, c, d], WOOD, 1.0);
        }
        let words = format!(
            "gaps at nodes: mean {:.2} %, largest {:.2} % of the height",
            100.0 * mean(axes) / height,
            100.0 * axes.largest_gap(height) / height
        );
        for (point, gap) in grid.points().iter().zip(&axes.gaps) {
            view = view.dots(&[*point], INK, 1.0 + 5.0 * gap / largest_gap);
        }
        Ok(view.caption(words))
    };
    let scene = Scene {
        title: "Fig. 16: a pavilion of beams with torsion-free nodes".to_owned(),
        subtitle:
            "All beams are planar and of one height; a dot is as large as the gap of the beams' lower edges at its node"
                .to_owned(),
        columns: 2,
        views: vec![view("node axes along the normals", &before)?, view("axes of least gaps", &after)?],
    };
    group.picture = Some(scene.write(folder, "figure16")?);
    Ok(group)
}

/// A plate in space: its outline, and the lower one, moved away from `middle` by `apart`.
fn plate(view: View, panel: &Panel, thickness: f64, apart: DVec3) -> Result<View> {
    let normal = panel.circle.context("three corners on a line")?.normal;
    let x = (panel.corners[1] - panel.corners[0]).normalize();
    let y = normal.cross(x);
    let lower = panel
        .lower_outline(thickness)?
        .map(|flat| panel.corners[0] + flat.x * x + flat.y * y - thickness * normal + apart);
    let upper = panel.corners.map(|corner| corner + apart);
    let view = (0..4).fold(view, |view, k| {
        let next = (k + 1) % 4;
        view.face(&[upper[k], upper[next], lower[next], lower[k]], [0.72, 0.56, 0.36], 1.0)
    });
    Ok(view.face(&lower, WOOD, 1.0).face(&upper, WOOD, 1.0))
}

pub fn figure17(folder: &Path) -> Result<Group> {
    let net = shell(13, 8)?;
    let grid = net.grid();
    let normals = upward(&net.frames().iter().map(|frame| frame.normal).collect::<Vec<_>>());
    let all = panels(grid, &normals)?;
    let thickness = 0.12;
    let mut group = Group::new(
        "Figs. 17 and 18: plates with mitre cuts",
        "12 × 7 plates of thickness 0.12; every cut contains the node axes at its ends.",
    );
    exact(&mut group, &[grid]);
    group.at_most(
        "corners off their panel's plane / diagonal",
        all.iter().map(|panel| panel.height).fold(0.0, f64::max) / grid.diagonal(),
        1e-10,
    );
    // Neighbours share the cut: their lower outlines end on one plane through the edge.
    group.at_most(
        "plates off the cut they share / thickness",
        shared_cuts(grid, &normals, &all, thickness)? / thickness,
        1e-9,
    );
    let angles = || all.iter().flat_map(|panel| panel.mitres_rad).map(f64::to_degrees);
    group.plain("least mitre, degrees", angles().fold(f64::INFINITY, f64::min));
    group.plain("greatest", angles().fold(f64::NEG_INFINITY, f64::max));
    let middle = grid.points().iter().sum::<DVec3>() / grid.points().len() as f64;
    let (mut built, mut exploded) = (View::new("built", -22.0, 34.0), View::new("exploded", -22.0, 34.0));
    for panel in &all {
        built = plate(built, panel, thickness, DVec3::ZERO)?;
        let center = panel.corners.iter().sum::<DVec3>() / 4.0;
        exploded = plate(exploded, panel, thickness, 0.45 * (center - middle))?;
    }
    let scene = Scene {
        title: "Figs. 17 and 18: a plated shell with planar mitre cuts".to_owned(),
        subtitle: "Each plate is one flat quad; the cut along an edge contains the axes at both of its nodes"
            .to_owned(),
        columns: 2,
        views: vec![built, exploded],
    };
    group.picture = Some(scene.write(folder, "figures17_18")?);
    Ok(group)
}

fn shared_cuts(grid: &Grid, axes: &[DVec3], all: &[Panel], thickness: f64) -> Result<f64> {
    let mut off = 0.0_f64;
    for (quad, panel) in grid.quads().zip(all) {
        let normal = panel.circle.context("three corners on a line")?.normal;
        let x = (panel.corners[1] - panel.corners[0]).normalize();
        let y = normal.cross(x);
        let lower = panel.lower_outline(thickness)?;
        for k in 0..4 {
            let next = (k + 1) % 4;
            let edge = (grid.points()[quad[next]] - grid.points()[quad[k]]).normalize();
            let cut = edge.cross(axes[quad[k]]).normalize();
            for flat in [lower[k], lower[next]] {
                let point = panel.corners[0] + flat.x * x + flat.y * y - thickness * normal;
                off = off.max((point - panel.corners[k]).dot(cut).abs());
            }
        }
    }
    Ok(off)
}
