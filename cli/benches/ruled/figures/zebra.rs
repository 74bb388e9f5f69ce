//! Fig. 2: whether strips join smoothly is seen by what they reflect.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::ruled::Strip;
use shapeop::geometry::ruled::boundaries::Levels;
use shapeop::geometry::ruled::level_function::LevelWeights;
use shapeop::geometry::ruled::report::{ReportOptions, report};
use shapeop::geometry::ruled::start::{Rulings, StartOptions, start};
use shapeop::geometry::ruled::trim::{Trimmed, trim};
use shapeop::geometry::ruled::zebra::{Eye, Stripes, zebra};
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::surfaces;
use shapeop_cli::colours::Rgb;
use shapeop_cli::scene::{Scene, View};

use super::drawing::{TRIM, pattern, strips, told};
use super::{make, with_levels};
use crate::group::Group;
use crate::shapes::Shape;

const DARK: Rgb = [0.16, 0.20, 0.28];
const LIGHT: Rgb = [0.97, 0.97, 0.96];

pub fn figure2(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 2: zebra stripes across ruled strips",
        "A catenoid as strips along asymptotic curves, and as many along its meridians, which are no asymptotic \
            curves.",
    );
    let shape = Shape::new("catenoid", [[0.2, 1.3], [-0.7, 0.7]], surfaces::catenoid());
    let mut design = with_levels(&shape.mesh(81, 81)?, 1, LevelWeights::ORTHOGONAL, &Levels::Count(9))?;
    let made = make(&mut design, 14, |_| Ok(Vec::new()))?;
    let diagonal = design.mesh().diagonal();
    told(&mut group, &made.report, diagonal);

    // Between parallel circles, rulings over meridians: each strip is part of a cone.
    let count = design.strips().len() as u32;
    let height = |k: u32| -0.73 + 1.46 * f64::from(k) / f64::from(count);
    let row = |k: u32| (0..=600).map(|i| shape.point(0.18 + 1.14 * f64::from(i) / 600.0, height(k))).collect();
    let boundaries: Vec<Vec<DVec3>> = (0..=count).map(row).collect();
    let options = StartOptions { control_count: 14, is_shared: true };
    let cones = start(&boundaries, &vec![false; boundaries.len()], Rulings::Proportional, options)?.strips;
    let reference = ReferenceMesh::new(design.mesh());
    let of_cones = report(&cones, &reference, &reference, &ReportOptions::default())?;
    let trimmed = trim(&cones, &reference, &TRIM)?;
    group.plain("along meridians: strips to surface, largest / diagonal", of_cones.strips_to_reference.max / diagonal);
    group.plain("along meridians: angle of tangent planes, largest, degrees", of_cones.max_kink_deg);
    group.plain("along meridians: the same, mean", of_cones.mean_kink_deg);
    group.at_least(
        "mean along meridians over mean along asymptotic curves",
        of_cones.mean_kink_deg / made.report.mean_kink_deg,
        10.0,
    );

    let (azimuth, tilt) = (133.0_f64, 14.0);
    let view = |title: &str| View::new(title, azimuth, tilt);
    let sums = |report: &shapeop::geometry::ruled::report::Report| {
        format!(
            "tangent planes of neighbours differ by {:.2}° on average,\n{:.1}° at most; off the surface by {:.1e} \
                of its size",
            report.mean_kink_deg,
            report.max_kink_deg,
            report.strips_to_reference.max / diagonal
        )
    };
    let mirrored = |title: &str, of: &[Strip], trimmed: &[Trimmed]| -> Result<View> {
        let shown = strips(view(""), of, trimmed, 1);
        let sight = shown.sight();
        let right = DVec3::new(azimuth.to_radians().cos(), azimuth.to_radians().sin(), 0.0);
        let stripes = Stripes { direction: right + 0.45 * DVec3::Z, count: 14, ..Stripes::default() };
        let value = |i: usize, u: f64, v: f64| {
            let jet = of[i].at(u, v);
            zebra(&[jet.point], &[jet.normal()], Eye::Along(sight), &stripes).map_or(0.0, |found| found[0])
        };
        Ok(pattern(view(title), of, trimmed, diagonal / 90.0, &value, [DARK, LIGHT]))
    };
    let views = vec![
        strips(view("rulings along asymptotic curves"), design.strips(), &made.trimmed, 3).caption(sums(&made.report)),
        mirrored("the same strips mirror stripes", design.strips(), &made.trimmed)?
            .caption("stripes go on from strip to strip".to_owned()),
        mirrored("rulings along meridians instead", &cones, &trimmed)?.caption(sums(&of_cones)),
    ];
    let scene = Scene {
        title: "Ruled strips join smoothly where their rulings follow asymptotic curves".to_owned(),
        subtitle: format!(
            "Part of a catenoid as {count} ruled strips; rulings need not meet at boundaries. Along meridians \
                each strip is part of a cone, and stripes break"
        ),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "zebra")?);
    Ok(group)
}
