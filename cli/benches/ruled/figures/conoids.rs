//! Figs. 7, 12, 13 and 14: conoidal strips, their spherical image, one against a general strip, planks.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result};
use glam::DVec3;
use shapeop::geometry::ruled::Axis;
use shapeop::geometry::ruled::boundaries::Levels;
use shapeop::geometry::ruled::design::Design;
use shapeop::geometry::ruled::level_function::LevelWeights;
use shapeop::geometry::ruled::planks::sheet::sheet;
use shapeop::geometry::ruled::planks::{Plank, PlankOptions, Planks, planks};
use shapeop::geometry::ruled::report::{Report, ReportOptions, report};
use shapeop::geometry::ruled::single::{Single, SingleOptions, single};
use shapeop::geometry::ruled::start::Rulings;
use shapeop::geometry::ruled::trim::trim;
use shapeop::mesh::patterns::parametric_surface;
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Mesh, SurfacePoint, TriangleMesh, surfaces};
use shapeop_cli::colours::Rgb;
use shapeop_cli::scene::{BLUE, ORANGE, Scene, View};

use super::boundaries::{THIN, curves};
use super::drawing::{
    REFERENCE, SURFACE, TRIM, in_words, judged, on_surface, outlines, overlay, rulings, strips, surface,
};
use super::{make, with_levels};
use crate::group::Group;
use crate::shapes::{Shape, bent_conoid, surface_of};

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
    let middle = on_surface(&design.boundaries().boundaries[design.boundaries().boundaries.len() / 2]);
    for curve in curves(&design, &middle, 17)? {
        on_shell = on_shell.line(&curve, THIN, 0.8);
    }
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
    sphere = surface(sphere, &globe(0.97)?, [0.95, 0.95, 0.96]);
    sphere = surface(sphere, &image, [0.72, 0.80, 0.88]);
    // Of the circles what is in front.
    let toward = -sphere.sight();
    for axis in &found {
        let (a, b) = axis.direction.any_orthonormal_pair();
        let at = |k: i32| f64::from(2 * k).to_radians().cos() * a + f64::from(2 * k).to_radians().sin() * b;
        for k in (0..180).filter(|k| at(*k).dot(toward) > 0.18) {
            sphere = sphere.line(&[at(k), at(k + 1)], BLUE, 1.0);
        }
    }
    for boundary in &design.boundaries().boundaries {
        let directions = boundary.on_surface.iter().filter_map(|at| {
            let at = (*at)?;
            let corners = design.mesh().triangles()[at.triangle as usize];
            // A little farther out, to be over the circles.
            Some(1.005 * (0..3).map(|k| at.weights[k] * field[corners[k] as usize]).sum::<DVec3>().normalize())
        });
        sphere = sphere.line(&directions.collect::<Vec<_>>(), ORANGE, 3.0);
    }
    let words = format!(
        "off great circles by {:.1e}, root mean square;\nboundaries that are only orthogonal to the rulings by \
            {before:.1e}",
        off(&found)
    );
    let scene = Scene {
        title: "Conoidal strips: boundaries whose ruling directions are on great circles".to_owned(),
        subtitle:
            "Left: a part of a catenoid with asymptotic curves; right: each point is where its ruling points to; \
                blue lines: great circles"
                .to_owned(),
        columns: 2,
        views: vec![on_shell, sphere.caption(words)],
    };
    group.picture = Some(scene.write(folder, "conoidal")?);
    Ok(group)
}

/// A sphere about the origin.
fn globe(radius: f64) -> Result<Mesh> {
    Ok(parametric_surface(97, 49, [0.0, TAU], [-FRAC_PI_2, FRAC_PI_2], |u, v| surfaces::sphere(radius)(u, v).point)?)
}

const GREEN: Rgb = [0.60, 0.80, 0.55];
const AMBER: Rgb = [0.97, 0.72, 0.38];

pub fn figure12(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Fig. 12: one conoidal strip against a general one",
        "A surface between two drawn curves that is no ruled surface, approximated once with rulings parallel to \
            a plane.",
    );
    let shape = bent_conoid(0.07, 0.08);
    let mesh = shape.mesh(121, 61)?;
    let triangles = TriangleMesh::new(&mesh)?;
    let reference = ReferenceMesh::new(&triangles);
    let curve =
        |s: f64| -> Vec<DVec3> { (0..=800).map(|i| shape.point(2.7 * f64::from(i) / 800.0 - 0.35, s)).collect() };
    let (first, second) = (curve(0.86), curve(2.12));
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
    let view = |title: &str| View::new(title, -16.0, 48.0);
    let mut views = vec![
        surface(view("reference surface"), &mesh, REFERENCE)
            .caption("tilted and bent rulings: no ruled surface".to_owned()),
    ];
    let cut = |found: &Single| trim(std::slice::from_ref(found.strip()), &reference, &TRIM);
    let mut overlaid = Vec::new();
    for (name, colour, found, of) in [
        ("one conoidal strip", GREEN, &conoidal, &of_conoidal),
        ("one general ruled strip", AMBER, &general, &of_general),
    ] {
        let (strip, trimmed) = (std::slice::from_ref(found.strip()), cut(found)?);
        let faces = super::drawing::faces(view(name), strip, &trimmed, diagonal / 60.0, &|_| colour);
        let tilt = found.tilt_rad[1].to_degrees();
        let words = if tilt < 1e-6 {
            "all rulings parallel to one plane".to_owned()
        } else {
            format!("rulings {tilt:.1}° off a plane, root mean square")
        };
        views.push(outlines(rulings(faces, strip, &trimmed, 4), strip, &trimmed).caption(words));
        let over = overlay(view(&format!("{name}, laid over")), strip, &trimmed, &reference, [REFERENCE, colour]);
        let words = format!(
            "off the surface by {:.1e} of its size at most,\n{:.1e} root mean square",
            of.strips_to_reference.max / diagonal,
            of.strips_to_reference.rms / diagonal
        );
        overlaid.push(outlines(over, strip, &trimmed).caption(words));
    }
    let (conoidal_strip, general_strip) = (std::slice::from_ref(conoidal.strip()), cut(&general)?);
    let other = surface_of(&conoidal_strip[0])?;
    let both = overlay(
        view("the two strips, laid over each other"),
        std::slice::from_ref(general.strip()),
        &general_strip,
        &other,
        [GREEN, AMBER],
    );
    let apart = general.strip().mesh(121, 21)?.points.into_iter().map(|p| {
        let foot = shapeop::mesh::ReferenceSurface::nearest(&other, p);
        if foot.overhang > 0.0 { 0.0 } else { foot.point.distance(p) }
    });
    let apart = apart.fold(0.0, f64::max) / diagonal;
    group.plain("one strip off the other, largest / diagonal", apart);
    views.push(
        outlines(both, std::slice::from_ref(general.strip()), &general_strip)
            .caption(format!("green where the conoidal one is in front;\napart by {apart:.1e} of the size at most")),
    );
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

/// The thickness of planks.
const THICKNESS: f64 = 0.07;

const WOODS: [Rgb; 3] = [[0.90, 0.76, 0.56], [0.83, 0.66, 0.45], [0.95, 0.84, 0.67]];

/// The faces of planks.
fn stacked(mut view: View, planks: &[Plank], tone: usize) -> View {
    for (k, plank) in planks.iter().enumerate() {
        let [low, high] = plank.corners();
        let colour = WOODS[(k + tone) % 3];
        view = view.face(&low, colour, 1.0).face(&high, colour, 1.0);
        for side in 0..4 {
            let next = (side + 1) % 4;
            view = view.face(&[low[side], low[next], high[next], high[side]], colour, 1.0);
        }
    }
    view
}

pub fn figures13_14(folder: &Path) -> Result<Group> {
    let mut group = Group::new(
        "Figs. 13 and 14: planks",
        "Conoidal strips of part of a catenoid, each built from planks of one thickness, and the sheet they are \
            cut from.",
    );
    let shape = Shape::new("catenoid", [[0.0, 0.8], [0.3, 1.3]], surfaces::catenoid());
    let mesh = shape.mesh(61, 61)?;
    let mut design = with_levels(&mesh, 1, LevelWeights::CONOIDAL, &Levels::Count(4))?;
    let made = make(&mut design, 12, |design| Ok(design.conoidal_conditions()?.0))?;
    judged(&mut group, &design, &made.report);
    let diagonal = design.mesh().diagonal();
    let turned = |title: &str| View::new(title, -67.0, 30.0);
    let shown = strips(turned("conoidal strips, trimmed"), design.strips(), &made.trimmed, 2);
    let mut built = turned("planks parallel to the rulings of each strip");
    let mut all = Vec::new();
    for (i, strip) in design.strips().iter().enumerate() {
        let found = planks(strip, &PlankOptions { depth: 0.02, ..PlankOptions::new(THICKNESS) })?;
        built = stacked(built, &found.planks, i);
        all.push((i, found));
    }
    group.plain("planks", all.iter().map(|(_, found)| found.planks.len()).sum::<usize>() as f64);
    let deviation = all.iter().map(|(_, found)| found.deviation_deg).fold(0.0, f64::max);
    group.at_most("rulings off planks, degrees", deviation, 1e-4);
    let count = all.iter().map(|(_, found)| found.planks.len()).sum::<usize>();
    let (number, largest) = all.iter().max_by_key(|(_, found)| found.planks.len()).context("no planks")?;
    group.plain("strip on the sheet: planks", largest.planks.len() as f64);
    group.plain("strip on the sheet: part that is cut off", largest.offcut);
    let axis = DVec3::from_array(largest.axis);
    let aside = stacked(View::new("one strip from another side", 20.0, 16.0), &largest.planks, *number);
    let first = Planks { planks: largest.planks[..6.min(largest.planks.len())].to_vec(), ..largest.clone() };
    let drawing = sheet(&first, &format!("strip {number}, the first"), 1000.0)?;
    let drawing = drawing.replace("stroke-width=\"0.1\"", "stroke-width=\"2.5\"");
    let scene = Scene {
        title: "Conoidal strips are built from planks of constant thickness".to_owned(),
        subtitle: "Rulings of a strip are parallel to a plane: planks parallel to it, with straight cuts, are \
            stacked along its axis"
            .to_owned(),
        columns: 2,
        views: vec![
            shown.caption(in_words(&made.report, diagonal)),
            built.caption(format!("{count} planks of thickness {THICKNESS}, of whole strips")),
            aside.caption(format!(
                "{} planks, axis ({:.2}, {:.2}, {:.2})",
                largest.planks.len(),
                axis.x,
                axis.y,
                axis.z
            )),
            View::of_sheet("the sheet they are cut from: its first planks", &drawing)?.caption(format!(
                "red: cuts; blue: rulings in the lower and (dashed) upper face; of all boards {:.0} % are cut off",
                100.0 * largest.offcut
            )),
        ],
    };
    group.picture = Some(scene.write(folder, "planks")?);
    Ok(group)
}
