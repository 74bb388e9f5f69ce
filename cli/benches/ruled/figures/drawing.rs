//! How strips, surfaces and curves are drawn, and what is told of every set of strips.

use glam::DVec3;
use shapeop::geometry::ruled::design::Design;
use shapeop::geometry::ruled::report::Report;
use shapeop::geometry::ruled::trim::Trimmed;
use shapeop::geometry::ruled::{Boundary, Strip};
use shapeop::mesh::{Mesh, ReferenceSurface};
use shapeop_cli::colours::Rgb;
use shapeop_cli::scene::{INK, View};

use crate::group::Group;

/// Strips in turn.
pub const STRIPS: [Rgb; 2] = [[0.965, 0.93, 0.86], [0.76, 0.85, 0.93]];
pub const SURFACE: Rgb = [0.90, 0.92, 0.94];
pub const REFERENCE: Rgb = [0.36, 0.60, 0.86];
pub const RULING: Rgb = [0.38, 0.42, 0.50];
const RIM: Rgb = [0.30, 0.33, 0.40];

/// Rulings are drawn in so many pieces, so that each is as near as it is.
const PIECES: usize = 10;

/// Cells of what is left of a strip: so many columns in each span, so many rows.
pub fn cells(strip: &Strip, trimmed: &Trimmed, columns_per_span: usize, rows: usize) -> Vec<[[f64; 2]; 4]> {
    let columns = columns_per_span * strip.basis().spans();
    let u = |k: usize| strip.length_u() * k as f64 / columns as f64;
    let parts: Vec<Vec<[f64; 2]>> = (0..=columns).map(|k| trimmed.ruling_parts(u(k))).collect();
    let mut found = Vec::new();
    for k in 0..columns {
        // Where a piece begins or ends within a column it is left out: a sliver.
        let both = parts[k].iter().zip(&parts[k + 1]).filter(|_| parts[k].len() == parts[k + 1].len());
        for (before, after) in both {
            let v = |part: &[f64; 2], row: usize| part[0] + (part[1] - part[0]) * row as f64 / rows as f64;
            for row in 0..rows {
                let [low, high] = [row, row + 1];
                found.push([
                    [u(k), v(before, low)],
                    [u(k + 1), v(after, low)],
                    [u(k + 1), v(after, high)],
                    [u(k), v(before, high)],
                ]);
            }
        }
    }
    found
}

/// Trimmed strips as faces, with a colour for each cell by its strip and the parameters of its middle.
pub fn faces(
    mut view: View,
    strips: &[Strip],
    trimmed: &[Trimmed],
    [columns_per_span, rows]: [usize; 2],
    colour: &dyn Fn(usize, f64, f64) -> Rgb,
) -> View {
    for (i, (strip, trimmed)) in strips.iter().zip(trimmed).enumerate() {
        for cell in cells(strip, trimmed, columns_per_span, rows) {
            let [u, v] = [0, 1].map(|k| cell.iter().map(|at| at[k]).sum::<f64>() / 4.0);
            let corners = cell.map(|[u, v]| strip.at(u, v).point);
            view = view.smooth_face(&corners, colour(i, u, v));
        }
    }
    view
}

/// Boundaries of trimmed strips in bold, the rim of the surface thinner.
pub fn outlines(mut view: View, strips: &[Strip], trimmed: &[Trimmed]) -> View {
    let is_side = |v: f64| v < 1e-6 || v > 1.0 - 1e-6;
    for (strip, trimmed) in strips.iter().zip(trimmed) {
        for contour in trimmed.pieces().iter().flatten() {
            for (k, from) in contour.iter().enumerate() {
                let to = contour[(k + 1) % contour.len()];
                let parts = (((to[0] - from[0]).abs() / 0.12).ceil() as usize).max(1);
                let at = |i: usize| {
                    let part = i as f64 / parts as f64;
                    strip.at(from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])).point
                };
                let points: Vec<DVec3> = (0..=parts).map(at).collect();
                let is_boundary = is_side(from[1]) && is_side(to[1]) && (from[1] - to[1]).abs() < 0.5;
                view = if is_boundary { view.line(&points, INK, 2.6) } else { view.line(&points, RIM, 1.3) };
            }
        }
    }
    view
}

/// Rulings of trimmed strips.
pub fn rulings(mut view: View, strips: &[Strip], trimmed: &[Trimmed], per_span: usize) -> View {
    for (strip, trimmed) in strips.iter().zip(trimmed) {
        for ruling in trimmed.rulings(strip, per_span * strip.basis().spans() + 1) {
            for [from, to] in ruling.pieces {
                let points: Vec<DVec3> = (0..=PIECES).map(|k| from.lerp(to, k as f64 / PIECES as f64)).collect();
                view = view.line(&points, RULING, 0.75);
            }
        }
    }
    view
}

/// Trimmed strips in turn in two colours, with rulings and bold boundaries.
pub fn strips(view: View, strips: &[Strip], trimmed: &[Trimmed], rulings_per_span: usize) -> View {
    let view = faces(view, strips, trimmed, [8, 8], &|i, _, _| STRIPS[i % 2]);
    outlines(rulings(view, strips, trimmed, rulings_per_span), strips, trimmed)
}

/// Strips that are not trimmed.
pub fn whole_strips(mut view: View, strips: &[Strip], rulings_per_span: usize) -> View {
    for (i, strip) in strips.iter().enumerate() {
        let columns = 8 * strip.basis().spans();
        let u = |k: usize| strip.length_u() * k as f64 / columns as f64;
        for (k, row) in (0..columns).flat_map(|k| (0..8).map(move |row| (k, f64::from(row) / 8.0))) {
            let at = |k: usize, v: f64| strip.at(u(k), v).point;
            let corners = [at(k, row), at(k + 1, row), at(k + 1, row + 0.125), at(k, row + 0.125)];
            view = view.smooth_face(&corners, STRIPS[i % 2]);
        }
        for [from, to] in strip.rulings(rulings_per_span * strip.basis().spans() + 1) {
            let points: Vec<DVec3> = (0..=PIECES).map(|k| from.lerp(to, k as f64 / PIECES as f64)).collect();
            view = view.line(&points, RULING, 0.75);
        }
        for side in [0, 1] {
            let points: Vec<DVec3> = (0..=columns).map(|k| strip.ruling(u(k))[side]).collect();
            view = view.line(&points, INK, 2.6);
        }
    }
    view
}

/// Strips and the surface laid over each other: white where the strip is in front, blue where the surface is.
pub fn overlay(view: View, strips: &[Strip], trimmed: &[Trimmed], surface: &dyn ReferenceSurface, colour: Rgb) -> View {
    let sight = view.sight();
    let shown = |i: usize, u: f64, v: f64| {
        let point = strips[i].at(u, v).point;
        let foot = surface.nearest(point);
        let towards = if foot.normal.dot(sight) < 0.0 { foot.normal } else { -foot.normal };
        if (point - foot.point).dot(towards) > 0.0 { colour } else { REFERENCE }
    };
    faces(view, strips, trimmed, [12, 16], &shown)
}

/// A surface without edges.
pub fn surface(mut view: View, mesh: &Mesh, colour: Rgb) -> View {
    for face in &mesh.faces {
        view = view.smooth_face(&mesh.corners(face), colour);
    }
    view
}

/// The part of a boundary that is on the surface.
pub fn on_surface(boundary: &Boundary) -> Vec<DVec3> {
    let on = boundary.points.iter().zip(&boundary.on_surface);
    let mut points: Vec<DVec3> = on.filter(|(_, at)| at.is_some()).map(|(point, _)| *point).collect();
    if boundary.is_closed {
        points.extend(points.first().copied());
    }
    points
}

/// What is told of every set of strips.
pub fn judged(group: &mut Group, design: &Design, report: &Report) {
    let diagonal = design.mesh().diagonal();
    group.plain("strips", design.strips().len() as f64);
    told(group, report, diagonal);
}

pub fn told(group: &mut Group, report: &Report, diagonal: f64) {
    group.plain("strips to surface, largest / diagonal", report.strips_to_reference.max / diagonal);
    group.plain("strips to surface, root mean square / diagonal", report.strips_to_reference.rms / diagonal);
    group.plain("surface to strips, largest / diagonal", report.reference_to_strips.max / diagonal);
    group.plain("largest gap / diagonal", report.max_gap / diagonal);
    group.plain("angle of tangent planes along boundaries, largest, degrees", report.max_kink_deg);
    group.plain("the same, mean", report.mean_kink_deg);
    group.at_least("coverage", report.coverage, 0.995);
}

/// The same in words, for a caption.
pub fn in_words(report: &Report, diagonal: f64) -> String {
    format!(
        "off the surface by {:.1e} of its size at most, gap {:.0e},\nkink {:.2}° at most, coverage {:.2} %",
        report.strips_to_reference.max / diagonal,
        report.max_gap / diagonal,
        report.max_kink_deg,
        100.0 * report.coverage
    )
}
