//! One mesh of each named family: its properties, and its chain undone.

use std::f64::consts::PI;
use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::canal::bases::{Base, moulding, revolution};
use shapeop::geometry::canal::chain::{Kind, Transform};
use shapeop::geometry::canal::families::Family;
use shapeop::geometry::canal::inversion::Inversion;
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::properties::Properties;
use shapeop::geometry::canal::surface::{BaseKind, SuperCanal};

use crate::group::Group;
use crate::shapes::{farthest, shell};
use shapeop_cli::scene::{BLUE, ORANGE, Scene, View, WHITE};

const ROWS: usize = 17;
const COLUMNS: usize = 13;

/// The net at the start of a chain; column 0 is a guide, row 0 a section.
fn base(kind: BaseKind) -> Result<Net> {
    let net = |base: Base| Net::new(base.grid, base.frame);
    Ok(match kind {
        BaseKind::Canal | BaseKind::Circular => shell(ROWS, COLUMNS)?,
        BaseKind::Revolution => {
            let profile: Vec<DVec3> = (0..ROWS)
                .map(|k| k as f64 / 16.0)
                .map(|s| DVec3::new(1.6 - 0.55 * (3.6 * s).sin() + 0.2 * s, 0.0, 2.6 * s))
                .collect();
            net(revolution(&profile, DVec3::ZERO, DVec3::Z, 0.9 * PI, COLUMNS)?)?
        }
        BaseKind::Moulding => {
            let rail: Vec<DVec3> =
                (0..ROWS).map(|k| 4.0 * k as f64 / 16.0).map(|x| DVec3::new(x, 0.32 * (1.3 * x).sin(), 0.0)).collect();
            let side = (rail[1] - rail[0]).cross(DVec3::NEG_Z).normalize();
            let profile: Vec<DVec3> = (0..COLUMNS)
                .map(|k| 0.5 * PI * k as f64 / 12.0)
                .map(|angle| rail[0] + (1.0 - angle.cos()) * 0.9 * side + 1.5 * angle.sin() * DVec3::Z)
                .collect();
            net(moulding(&rail, &profile)?.base)?
        }
    })
}

fn build(family: Family) -> Result<SuperCanal> {
    let start = base(family.base())?;
    let [rows, columns] = start.grid().spans();
    let mut surface = SuperCanal::new(start, family.base());
    for kind in family.kinds() {
        let grid = surface.net().grid();
        let transform = match kind {
            Kind::Combescure => Transform::Combescure {
                column: (0..rows).map(|k| 1.0 + 0.35 * (0.5 * k as f64).sin()).collect(),
                row: (0..columns).map(|k| 0.7 + 0.08 * k as f64).collect(),
            },
            // Beside and below the middle, on the concave side: it bends the surface without turning it inside out.
            _ => {
                let middle = grid.points().iter().sum::<DVec3>() / grid.points().len() as f64;
                let center = middle + grid.diagonal() * DVec3::new(0.25, 0.45, -0.75);
                Transform::Inversion(Inversion::new(center, (0.9 * grid.diagonal()).powi(2))?)
            }
        };
        surface.push(transform)?;
    }
    let chain = surface.chain().to_vec();
    Ok(family.build(surface.base().clone(), chain)?)
}

pub fn groups(folder: &Path) -> Result<Vec<Group>> {
    std::fs::create_dir_all(folder)?;
    let mut groups = Vec::new();
    let mut views = Vec::new();
    for family in Family::ALL {
        let surface = build(family)?;
        let report = Properties::of(&surface);
        let mut group = Group::new(&format!("family {}", family.name()), "");
        group.at_least("named so by its chain", f64::from(surface.family() == family.name()), 1.0);
        group.at_most("planarity", report.planarity, 1e-9);
        group.at_most("concyclicity", report.concyclicity, 1e-9);
        group.at_most("quads that cross themselves", report.crossed_count as f64, 0.0);
        let base = surface.base().grid();
        let back = farthest(surface.restored()?.grid().points(), base.points()) / base.diagonal();
        group.at_most("chain undone, from the start / diagonal", back, 1e-9);
        let [rows, columns] = report.off_plane;
        // A Möbius transformation at the end of a chain with a Combescure one leaves spherical curves.
        let is_planar = !matches!(family, Family::MCCanal | Family::MMoulding | Family::MCMRevolution);
        if is_planar {
            group.at_most("planar lines of curvature: the flatter family off planes", rows.min(columns), 1e-9);
        } else {
            group.plain("lines of curvature off planes: rows", rows);
            group.plain("columns", columns);
        }
        if report.is_isothermic_by_construction {
            group.at_most("isothermic by construction: cross-ratios off a product", report.cross_ratio_residual, 1e-9);
        } else {
            group.plain("cross-ratios off a product", report.cross_ratio_residual);
        }
        let mut words = vec![if is_planar { "planar lines of curvature" } else { "spherical lines of curvature" }];
        if report.is_isothermic_by_construction {
            words.push("isothermic");
        }
        match report.stress_lines {
            Ok(lines) => {
                group.plain("membrane under pressure, residual", lines.residuals[0]);
                // An M-revolution surface is a canal surface too.
                if matches!(family, Family::Canal | Family::Revolution | Family::MRevolution) {
                    group.at_most("twice as fine", lines.residuals[1], (0.6 * lines.residuals[0]).max(1e-6));
                    words.push("stress lines");
                } else {
                    group.plain("twice as fine", lines.residuals[1]);
                }
            }
            Err(error) => group.claim = error.to_string(),
        }
        group.plain("rows near the guide's evolute", report.folds.rows_near_evolute.len() as f64);
        group.plain("panels folded over", report.folds.flipped_faces.len() as f64);
        let grid = surface.net().grid();
        let view = View::new(family.name(), -25.0, 32.0).grid(grid, WHITE);
        let view = view.line(&grid.column(0), ORANGE, 3.0).line(grid.row(0), BLUE, 3.0);
        views.push(view.caption(words.join(", ")));
        groups.push(group);
    }
    let scene = Scene {
        title: "Fig. 4: named families of super-canal surfaces".to_owned(),
        subtitle: "C: a Combescure transformation, M: a Möbius transformation; orange: column 0, blue: row 0"
            .to_owned(),
        columns: 3,
        views,
    };
    if let Some(last) = groups.last_mut() {
        last.picture = Some(scene.write(folder, "figure4")?);
    }
    Ok(groups)
}
