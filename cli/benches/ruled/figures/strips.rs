//! Figs. 8 to 11: optimised strips, trimmed, on a tube, with geodesic and with planar boundaries, and where they are too wide.

use std::path::Path;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::ruled::Strip;
use shapeop::geometry::ruled::boundaries::Levels;
use shapeop::geometry::ruled::design::{Design, FieldOptions};
use shapeop::geometry::ruled::level_function::LevelWeights;
use shapeop::geometry::ruled::planar_boundaries::PlanarOptions;
use shapeop::mesh::curve::Curve;
use shapeop::mesh::reference::{ReferenceMesh, ReferenceSurface};
use shapeop::mesh::surfaces;
use shapeop_cli::scene::{ORANGE, RED, Scene, View};

use super::boundaries::{geodesic_curvature, planes};
use super::drawing::{
    REFERENCE, STRIPS, SURFACE, faces, in_words, judged, on_surface, outlines, overlay, rulings, strips, surface,
    whole_strips,
};
use super::{judge, make, set_levels, with_levels};
use crate::group::Group;
use crate::shapes::{Shape, roof, tube};

/// The colour of strips where a surface is laid over them.
const PALE: [f64; 3] = [0.97, 0.96, 0.93];

pub fn figure8(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 8: a tube",
        "An oblique elliptic tube; boundaries orthogonal to asymptotic curves, closed up around it.",
    );
    let waist = |angle: f64, part: f64| {
        let h = 2.1 * part - 0.9;
        let bulge = h.cosh();
        DVec3::new(1.25 * bulge * angle.cos() + 0.35 * h, 0.9 * bulge * angle.sin() - 0.1 * h, 1.15 * h)
    };
    let mesh = tube(120, 41, waist)?;
    let mut design = with_levels(&mesh, 0, LevelWeights::DIRECTION, &Levels::Count(18))?;
    let suggested = design.boundaries().boundaries.clone();
    let made = make(&mut design, 16, |_| Ok(Vec::new()))?;
    judged(&mut group, &design, &made.report);
    group.plain("iterations", made.iterations as f64);
    let view = |title: &str| View::new(title, 28.0, 20.0);
    let mut on_reference = surface(view("(a) suggested boundaries"), &mesh, SURFACE);
    for boundary in &suggested {
        on_reference = on_reference.line(&on_surface(boundary), ORANGE, 2.8);
    }
    let diagonal = design.mesh().diagonal();
    let views = vec![
        on_reference,
        whole_strips(view("(b) optimised strips"), design.strips(), 2),
        strips(view("(c) trimmed"), design.strips(), &made.trimmed, 2).caption(in_words(&made.report, diagonal)),
    ];
    let scene = Scene {
        title: "A tube of ruled strips".to_owned(),
        subtitle: format!(
            "{} strips follow each other around the tube and close up; no level is lost where they meet again",
            design.strips().len()
        ),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "tube")?);
    Ok(group)
}

/// Geodesic curvature of the strips' own boundaries where they are beside the surface, root mean square, times the surface's size.
fn bending_sideways(strips: &[Strip], reference: &ReferenceMesh<'_>) -> f64 {
    let mut all = Vec::new();
    for strip in strips.iter().skip(1) {
        let boundary = strip.boundary(0);
        for k in 0..=200 {
            let jet = boundary.at(strip.length_u() * f64::from(k) / 200.0);
            let foot = reference.nearest(jet.point);
            if foot.overhang == 0.0 {
                all.push(jet.first.cross(jet.second).dot(foot.normal) / jet.first.length().powi(3));
            }
        }
    }
    (all.iter().map(|k| k * k).sum::<f64>() / all.len().max(1) as f64).sqrt() * reference.diagonal()
}

pub fn figure9(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 9: geodesic boundaries on a minimal surface",
        "Part of Enneper's surface; boundaries that are shortest paths can be bent from straight boards.",
    );
    let shape = Shape::new("Enneper's surface", [[-0.72, 0.72], [-0.72, 0.72]], surfaces::enneper());
    let mesh = shape.mesh(121, 121)?;
    let mut plain = with_levels(&mesh, 0, LevelWeights::ORTHOGONAL, &Levels::Count(9))?;
    let straight = LevelWeights { orthogonal: 0.01, ..LevelWeights::GEODESIC };
    let mut design = with_levels(&mesh, 0, straight, &Levels::Count(9))?;
    let [before, after] = [&plain, &design].map(|design| geodesic_curvature(design, &design.boundaries().boundaries));
    let orthogonal = make(&mut plain, 14, |_| Ok(Vec::new()))?;
    let made = make(&mut design, 14, |_| Ok(Vec::new()))?;
    let reference = ReferenceMesh::new(design.mesh());
    let [sideways, bent] = [&plain, &design].map(|design| bending_sideways(design.strips(), &reference));
    judged(&mut group, &design, &made.report);
    group.plain("suggested boundaries, orthogonal: geodesic curvature × size", before);
    group.plain("suggested boundaries, geodesic: the same", after);
    group.plain("strips, orthogonal boundaries: geodesic curvature × size", sideways);
    group.at_most("strips, geodesic boundaries: the same, over that", bent / sideways, 0.5);
    group.plain(
        "strips, orthogonal boundaries: largest deviation / diagonal",
        orthogonal.report.strips_to_reference.max / plain.mesh().diagonal(),
    );
    let view = |title: &str| View::new(title, 15.0, 66.0);
    let mut suggested = surface(view("(a) suggested boundaries"), &mesh, SURFACE);
    for boundary in &design.boundaries().boundaries {
        suggested = suggested.line(&on_surface(boundary), ORANGE, 2.8);
    }
    let diagonal = design.mesh().diagonal();
    let words = format!(
        "geodesic curvature × size {after:.2} (orthogonal ones {before:.2}),\nof the optimised strips {bent:.2} ({sideways:.2})"
    );
    let views = vec![
        suggested.caption(words),
        strips(view("(b) trimmed"), design.strips(), &made.trimmed, 2).caption(in_words(&made.report, diagonal)),
        outlines(
            overlay(
                view("(c) strips (white) and surface (blue)"),
                design.strips(),
                &made.trimmed,
                &reference,
                [REFERENCE, PALE],
            ),
            design.strips(),
            &made.trimmed,
        ),
    ];
    let scene = Scene {
        title: "Strips with geodesic boundaries on a minimal surface".to_owned(),
        subtitle: "Part of Enneper's surface; boundaries are shortest paths, so that boards which are bent along \
            them were straight"
            .to_owned(),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "geodesic")?);
    Ok(group)
}

pub fn figure10(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 10: planar boundaries",
        "Strips between the sections of Fig. 6, optimised with each boundary in its plane.",
    );
    let mesh = roof().mesh(137, 91)?;
    let mut design = Design::new(&mesh, &FieldOptions { family: 0, ..FieldOptions::default() })?;
    design.set_planar_boundaries(&planes(), &PlanarOptions::default())?;
    let made = make(&mut design, 14, |design| Ok(design.planar_conditions()))?;
    judged(&mut group, &design, &made.report);
    group.plain("iterations", made.iterations as f64);
    let reference = ReferenceMesh::new(design.mesh());
    let mut off = 0.0_f64;
    for (k, plane) in planes().iter().enumerate() {
        let (before, after) = (&design.strips()[k], &design.strips()[k + 1]);
        for strip_side in [
            before.rulings(200).iter().map(|r| r[1]).collect::<Vec<_>>(),
            after.rulings(200).iter().map(|r| r[0]).collect(),
        ] {
            let distance = |p: &DVec3| (plane.normal.dot(*p) - plane.offset).abs() / plane.normal.length();
            off = off.max(strip_side.iter().map(distance).fold(0.0, f64::max));
        }
    }
    group.at_most("boundaries off their planes", off, 1e-10);
    let view = |title: &str| View::new(title, -32.0, 44.0);
    let diagonal = design.mesh().diagonal();
    let views = vec![
        whole_strips(view("(a) optimised strips"), design.strips(), 2)
            .caption(format!("boundaries off their planes by {off:.0e}")),
        strips(view("(b) trimmed"), design.strips(), &made.trimmed, 2).caption(in_words(&made.report, diagonal)),
        outlines(
            overlay(
                view("(c) strips (white) and surface (blue)"),
                design.strips(),
                &made.trimmed,
                &reference,
                [REFERENCE, PALE],
            ),
            design.strips(),
            &made.trimmed,
        ),
    ];
    let scene = Scene {
        title: "Strips with planar boundaries".to_owned(),
        subtitle: "Each boundary stays exactly in its plane while the strips come as near to the surface and to \
            each other as they can"
            .to_owned(),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "planar")?);
    Ok(group)
}

/// A saddle with ripples: the second derivatives of z by x and −y go from 0.08 to 1.92 and back over a length of 1.3.
fn rippled() -> Shape {
    let (k, a, b) = (5.0_f64, 1.0, 0.92 / 25.0);
    let one = move |t: f64| {
        [0.5 * a * t * t - b * (k * t).cos(), a * t + b * k * (k * t).sin(), a + b * k * k * (k * t).cos()]
    };
    Shape::new(
        "rippled saddle",
        [[-1.5, 1.5], [-1.0, 1.0]],
        surfaces::graph(move |x, y| {
            let ([p, p1, p2], [q, q1, q2]) = (one(x), one(y));
            [p - q, p1, -q1, p2, 0.0, -q2]
        }),
    )
}

pub fn figure11(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 11: strips that are too wide",
        "A saddle with ripples that are as small as the strips are wide; the warning must come, and what it costs \
            is told.",
    );
    let mesh = rippled().mesh(121, 81)?;
    let mut design = with_levels(&mesh, 0, LevelWeights::EQUIDISTANT, &Levels::Width(0.6))?;
    let mut told = Vec::new();
    let mut views = Vec::new();
    for (width, name) in [(0.6, "wide"), (0.15, "narrow")] {
        set_levels(&mut design, LevelWeights::EQUIDISTANT, &Levels::Width(width))?;
        design.start(shapeop::geometry::ruled::start::StartOptions { control_count: 20, ..Default::default() })?;
        let before = judge(&design)?;
        let made = make(&mut design, 20, |_| Ok(Vec::new()))?;
        let (report, diagonal) = (&made.report, design.mesh().diagonal());
        let worst = report.strips.iter().map(|strip| strip.width_over_feature).fold(0.0, f64::max);
        group.plain(&format!("{name} strips: width over the size of features, largest"), worst);
        group.plain(&format!("{name} strips: strips told to be too wide"), report.too_wide.len() as f64);
        group.plain(
            &format!("{name} strips: widths, standard deviation over mean, suggested"),
            before.report.width_variation,
        );
        group.plain(&format!("{name} strips: the same, optimised"), report.width_variation);
        group.plain(
            &format!("{name} strips: strips to surface, largest / diagonal"),
            report.strips_to_reference.max / diagonal,
        );
        group.plain(&format!("{name} strips: angle of tangent planes, largest, degrees"), report.max_kink_deg);
        group.at_least(&format!("{name} strips: coverage"), report.coverage, 0.995);
        let is_wide = |i: usize| report.too_wide.contains(&i);
        let view = View::new(&format!("{} strips of width {width}", design.strips().len()), -30.0, 42.0);
        let colour = |i: usize| {
            if is_wide(i) { [[0.98, 0.80, 0.74], [0.95, 0.70, 0.64]][i % 2] } else { STRIPS[i % 2] }
        };
        let view = faces(view, design.strips(), &made.trimmed, diagonal / 80.0, &colour);
        let mut view = outlines(rulings(view, design.strips(), &made.trimmed, 2), design.strips(), &made.trimmed);
        for (i, strip) in design.strips().iter().enumerate().filter(|(i, _)| width > 0.3 && is_wide(*i)) {
            // In the middle of what is left of the strip.
            let parts: Vec<(f64, [f64; 2])> = (0..=60)
                .map(|k| strip.length_u() * f64::from(k) / 60.0)
                .filter_map(|u| Some((u, *made.trimmed[i].ruling_parts(u).first()?)))
                .collect();
            if let Some((u, part)) = parts.get(parts.len() / 2).filter(|_| made.trimmed[i].area() > 0.15) {
                let at = strip.at(*u, 0.5 * (part[0] + part[1])).point;
                view = view.label(at, format!("{:.1} ×", report.strips[i].width_over_feature), RED);
            }
        }
        let verdict = match report.too_wide.len() {
            0 => "no strip is told to be too wide".to_owned(),
            count => {
                format!("warning: {count} strips are wider than half the size of features (numbers: width over size)")
            }
        };
        let caption = format!(
            "{verdict};\noff the surface by {:.1e} of its size, kinks up to {:.1}°;\nwidths vary by {:.0} % as \
                suggested, by {:.0} % when optimised",
            report.strips_to_reference.max / diagonal,
            report.max_kink_deg,
            100.0 * before.report.width_variation,
            100.0 * report.width_variation,
        );
        told.push((report.too_wide.len(), report.strips_to_reference.max, report.max_kink_deg));
        views.push(view.caption(caption));
    }
    group.at_least("wide strips are told of", told[0].0 as f64, 1.0);
    group.at_least("deviation of wide strips over that of narrow ones", told[0].1 / told[1].1, 4.0);
    let scene = Scene {
        title: "Strips that are wide compared with the features of the surface".to_owned(),
        subtitle: "A saddle with ripples: where strips are as wide as these are large they cannot follow it, and \
            the report warns; narrower ones do"
            .to_owned(),
        columns: 2,
        views,
    };
    group.picture = Some(scene.write(folder, "wide")?);
    Ok(group)
}
