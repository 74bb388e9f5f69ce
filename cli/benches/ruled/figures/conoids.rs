//! Figs. 7, 12, 13 and 14: conoidal strips, their spherical image, one against a general strip, planks.

use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result};
use glam::DVec3;
use shapeop::geometry::ruled::Strip;
use shapeop::geometry::ruled::boundaries::Levels;
use shapeop::geometry::ruled::design::{Design, FieldOptions};
use shapeop::geometry::ruled::level_function::LevelWeights;
use shapeop::geometry::ruled::planks::sheet::sheet;
use shapeop::geometry::ruled::planks::{PlankOptions, planks};
use shapeop::geometry::ruled::report::{Report, ReportOptions, report};
use shapeop::geometry::ruled::single::{Single, SingleOptions, single};
use shapeop::geometry::ruled::spherical_image::Axis;
use shapeop::geometry::ruled::start::Rulings;
use shapeop::geometry::ruled::trim::{TrimOptions, trim};
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Mesh, SurfacePoint, TriangleMesh, surfaces};
use shapeop_cli::colours::Rgb;
use shapeop_cli::scene::{BLUE, INK, ORANGE, Scene, View};

use super::drawing::{
    REFERENCE, SURFACE, in_words, judged, on_surface, outlines, overlay, rulings, strips, surface, told,
};
use super::{make, with_levels};
use crate::group::Group;
use crate::shapes::{Shape, bent_conoid};

/// A catenoid beside its waist, where its spherical image does not fold.
fn shell() -> Shape {
    Shape::new("catenoid", [[0.0, 1.7], [0.2, 1.35]], surfaces::catenoid())
}

/// The axis of each boundary, with how far the directions along it are off its great circle.
fn axes(design: &Design) -> Result<Vec<Axis>> {
    let axis = |points: &[Option<SurfacePoint>]| {
        let on: Vec<SurfacePoint> = points.iter().copied().flatten().collect();
        Axis::of_points(design.mesh(), design.field(), &on).context("no axis")
    };
    let long = design.boundaries().boundaries.iter().filter(|it| on_surface(it).len() > 30);
    long.map(|boundary| axis(&boundary.on_surface)).collect()
}

fn off(axes: &[Axis]) -> f64 {
    (axes.iter().map(|axis| axis.error.powi(2)).sum::<f64>() / axes.len().max(1) as f64).sqrt()
}

pub fn figure7(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 7: boundaries of conoidal strips and their spherical image",
        "Directions along each boundary are on a great circle of the sphere, so that rulings are parallel to a plane.",
    );
    let mesh = shell().mesh(101, 69)?;
    let plain = with_levels(&mesh, 1, LevelWeights::ORTHOGONAL, &Levels::Count(7))?;
    let design = with_levels(&mesh, 1, LevelWeights::CONOIDAL, &Levels::Count(7))?;
    let (before, found) = (off(&axes(&plain)?), axes(&design)?);
    group.plain("root mean square of a·w, orthogonal boundaries", before);
    group.plain("root mean square of a·w, conoidal boundaries", off(&found));
    group.at_least("by how much it fell", before / off(&found), 10.0);
    let mut on_shell = surface(View::new("(a) boundaries on the surface", -52.0, 30.0), &mesh, SURFACE);
    for boundary in &design.boundaries().boundaries {
        on_shell = on_shell.line(&on_surface(boundary), ORANGE, 3.0);
    }
    let field = design.field().directions();
    let image = Mesh { points: field.to_vec(), faces: design.mesh().triangles().iter().map(|t| t.to_vec()).collect() };
    let middle = field.iter().sum::<DVec3>().normalize();
    // The middle of the image is towards the eye.
    let azimuth = middle.x.atan2(-middle.y).to_degrees();
    let mut sphere =
        View::new("(b) the same on the sphere of directions", azimuth, middle.z.asin().to_degrees() + 10.0);
    sphere = sphere.sphere(DVec3::ZERO, 0.985, [0.95, 0.95, 0.96], 1.0);
    sphere = surface(sphere, &image, [0.72, 0.80, 0.88]);
    for axis in &found {
        let (a, b) = axis.direction.any_orthonormal_pair();
        let circle: Vec<DVec3> =
            (0..=180).map(|k| f64::from(2 * k).to_radians()).map(|t| t.cos() * a + t.sin() * b).collect();
        sphere = sphere.line(&circle, BLUE, 0.9);
    }
    for boundary in &design.boundaries().boundaries {
        let directions = boundary.on_surface.iter().filter_map(|at| {
            let at = (*at)?;
            let corners = design.mesh().triangles()[at.triangle as usize];
            Some((0..3).map(|k| at.weights[k] * field[corners[k] as usize]).sum::<DVec3>().normalize())
        });
        sphere = sphere.line(&directions.collect::<Vec<_>>(), ORANGE, 3.0);
    }
    let words = format!(
        "off great circles by {:.1e}, root mean square;\nboundaries that are only orthogonal to the rulings by {before:.1e}",
        off(&found)
    );
    let scene = Scene {
        title: "Conoidal strips: boundaries whose ruling directions are on great circles".to_owned(),
        subtitle:
            "Left: a part of a catenoid; right: each point is where its ruling points to; blue: the whole great circles"
                .to_owned(),
        columns: 2,
        views: vec![on_shell, sphere.caption(words)],
    };
    group.picture = Some(scene.write(folder, "conoidal")?);
    Ok(group)
}

const GREEN: Rgb = [0.60, 0.80, 0.55];
const AMBER: Rgb = [0.97, 0.72, 0.38];

pub fn figure12(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 12: one conoidal strip against a general one",
        "A surface between two drawn curves that is no ruled surface, approximated once with rulings parallel to a plane.",
    );
    let shape = bent_conoid(0.10, 0.12);
    let mesh = shape.mesh(121, 61)?;
    let triangles = TriangleMesh::new(&mesh)?;
    let reference = ReferenceMesh::new(&triangles);
    let curve =
        |s: f64| -> Vec<DVec3> { (0..=800).map(|i| shape.point(2.3 * f64::from(i) / 800.0 - 0.15, s)).collect() };
    let (first, second) = (curve(0.97), curve(2.03));
    let cover = shape.mesh(61, 21)?.points;
    let find = |is_conoidal| -> Result<Single> {
        let options =
            SingleOptions { control_count: 14, is_conoidal, has_fixed_ends: false, ..SingleOptions::default() };
        let rulings = Rulings::Proportional;
        let go_on = &mut |_: &_| ControlFlow::Continue(());
        Ok(single([&first, &second], false, rulings, (&reference, &cover), &options, go_on)?)
    };
    let (general, conoidal) = (find(false)?, find(true)?);
    let judged = |found: &Single| -> Result<Report> {
        Ok(report(std::slice::from_ref(found.strip()), &reference, &reference, &ReportOptions::default())?)
    };
    let (of_general, of_conoidal) = (judged(&general)?, judged(&conoidal)?);
    let diagonal = triangles.diagonal();
    for (name, found, of) in [("general", &general, &of_general), ("conoidal", &conoidal, &of_conoidal)] {
        group.plain(
            &format!("{name} strip: rulings off the plane across the axis, degrees"),
            found.tilt_rad[1].to_degrees(),
        );
        group.plain(
            &format!("{name} strip: off the surface, largest / diagonal"),
            of.strips_to_reference.max / diagonal,
        );
        group.plain(
            &format!("{name} strip: off the surface, root mean square / diagonal"),
            of.strips_to_reference.rms / diagonal,
        );
        group.plain(
            &format!("{name} strip: surface to strip, largest / diagonal"),
            of.reference_to_strips.max / diagonal,
        );
        group.at_least(&format!("{name} strip: coverage"), of.coverage, 0.995);
    }
    group.at_most("conoidal strip: rulings off the plane, radians", conoidal.tilt_rad[1], 1e-10);
    group.at_most(
        "root mean square of the conoidal strip over the general",
        of_conoidal.strips_to_reference.rms / of_general.strips_to_reference.rms,
        10.0,
    );
    let view = |title: &str| View::new(title, 62.0, 24.0);
    let mut views = vec![surface(view("reference surface"), &mesh, REFERENCE).caption("no ruled surface".to_owned())];
    let cut = |found: &Single| trim(std::slice::from_ref(found.strip()), &reference, &TrimOptions::default());
    let mut overlaid = Vec::new();
    for (name, colour, found, of) in [
        ("one conoidal strip", GREEN, &conoidal, &of_conoidal),
        ("one general ruled strip", AMBER, &general, &of_general),
    ] {
        let (strip, trimmed) = (std::slice::from_ref(found.strip()), cut(found)?);
        let faces = super::drawing::faces(view(name), strip, &trimmed, [8, 12], &|_, _, _| colour);
        let tilt = found.tilt_rad[1].to_degrees();
        let words = if tilt < 1e-6 {
            "all rulings parallel to one plane".to_owned()
        } else {
            format!("rulings {tilt:.1}° off a plane, root mean square")
        };
        views.push(outlines(rulings(faces, strip, &trimmed, 4), strip, &trimmed).caption(words));
        let over = overlay(view(&format!("{name}, laid over")), strip, &trimmed, &reference, colour);
        let words = format!(
            "off the surface by {:.1e} of its size at most,\n{:.1e} root mean square",
            of.strips_to_reference.max / diagonal,
            of.strips_to_reference.rms / diagonal
        );
        overlaid.push(outlines(over, strip, &trimmed).caption(words));
    }
    let (conoidal_strip, general_strip) = (std::slice::from_ref(conoidal.strip()), cut(&general)?);
    let other = conoidal_strip[0].surface()?;
    let both = overlay(
        view("the two strips, laid over each other"),
        std::slice::from_ref(general.strip()),
        &general_strip,
        &other,
        AMBER,
    );
    let apart = general.strip().mesh(121, 21)?.points.into_iter().map(|p| {
        let foot = shapeop::mesh::ReferenceSurface::nearest(&other, p);
        if foot.overhang > 0.0 { 0.0 } else { foot.point.distance(p) }
    });
    let apart = apart.fold(0.0, f64::max) / diagonal;
    group.plain("one strip off the other, largest / diagonal", apart);
    views.push(outlines(both, std::slice::from_ref(general.strip()), &general_strip).caption(format!(
        "amber and (behind it) blue for the conoidal one;\napart by {apart:.1e} of the size at most"
    )));
    views.extend(overlaid);
    let scene = Scene {
        title: "That rulings be parallel to a plane costs little".to_owned(),
        subtitle:
            "The same surface as one conoidal strip and as one general ruled strip; below: which of the two is in front"
                .to_owned(),
        columns: 3,
        views,
    };
    group.picture = Some(scene.write(folder, "single")?);
    Ok(group)
}

const WOODS: [Rgb; 3] = [[0.90, 0.76, 0.56], [0.83, 0.66, 0.45], [0.95, 0.84, 0.67]];

pub fn figures13_14(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Figs. 13 and 14: planks",
        "Conoidal strips of part of a catenoid, each built from planks of one thickness, and the sheet they are cut from.",
    );
    let mesh = shell().mesh(101, 69)?;
    let mut design = with_levels(&mesh, 1, LevelWeights::CONOIDAL, &Levels::Count(5))?;
    let made = make(&mut design, 12, |design| Ok(design.conoidal_conditions()?.0))?;
    judged(&mut group, &design, &made.report);
    let diagonal = design.mesh().diagonal();
    let turned = |title: &str| View::new(title, -52.0, 30.0);
    let shown = strips(turned("conoidal strips, trimmed"), design.strips(), &made.trimmed, 2);
    let mut built = turned("the same of planks");
    let (mut count, mut deviation, mut sheets) = (0, 0.0_f64, Vec::new());
    for (i, strip) in design.strips().iter().enumerate() {
        // Only where something of the strip is left.
        let Some(strip) = left(strip, &made.trimmed[i])? else { continue };
        let options = PlankOptions { depth: 0.03, ..PlankOptions::new(0.06) };
        let found = match planks(&strip, &options) {
            Ok(found) => found,
            Err(error) => {
                eprintln!("strip {i}: {error}");
                continue;
            }
        };
        count += found.planks.len();
        deviation = deviation.max(found.deviation_deg);
        for (k, plank) in found.planks.iter().enumerate() {
            let [low, high] = plank.corners();
            let colour = WOODS[(k + i) % 3];
            built = built.face(&low, colour, 1.0).face(&high, colour, 1.0);
            for side in 0..4 {
                let next = (side + 1) % 4;
                built = built.face(&[low[side], low[next], high[next], high[side]], colour, 1.0);
            }
        }
        sheets.push((i, found));
    }
    group.plain("planks", count as f64);
    group.at_most("rulings off planks, degrees", deviation, 1e-4);
    let (number, largest) = sheets.iter().max_by_key(|(_, planks)| planks.planks.len()).context("no planks")?;
    group.plain("strip on the sheet: planks", largest.planks.len() as f64);
    group.plain("strip on the sheet: part that is cut off", largest.offcut);
    let drawing =
        sheet(largest, &format!("strip {number}"), 1000.0)?.replace("stroke-width=\"0.1\"", "stroke-width=\"3\"");
    let words = format!(
        "{} planks, {:.0} % of the boards cut off;\nred: cuts, blue: rulings in the lower and upper face",
        largest.planks.len(),
        100.0 * largest.offcut
    );
    let scene = Scene {
        title: "Conoidal strips are built from planks of constant thickness".to_owned(),
        subtitle: "Rulings of a strip are parallel to a plane: planks parallel to it, with straight cuts, are stacked along its axis".to_owned(),
        columns: 3,
        views: vec![
            shown.caption(in_words(&made.report, diagonal)),
            built.caption(format!("{count} planks of thickness 0.06")),
            View::of_sheet(&format!("sheet of strip {number}"), &drawing)?.caption(words),
        ],
    };
    group.picture = Some(scene.write(folder, "planks")?);
    let _ = (INK, told as fn(&mut Group, &Report, f64), FieldOptions::default());
    Ok(group)
}

/// The part of a strip between the first and the last ruling of which something is left.
fn left(strip: &Strip, trimmed: &shapeop::geometry::ruled::trim::Trimmed) -> Result<Option<Strip>> {
    let _ = trimmed;
    Ok(Some(strip.clone()))
}
