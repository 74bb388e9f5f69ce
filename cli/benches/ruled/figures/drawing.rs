//! How strips, surfaces and curves are drawn, and what is told of every set of strips.

use glam::DVec3;
use shapeop::geometry::ruled::design::Design;
use shapeop::geometry::ruled::report::Report;
use shapeop::geometry::ruled::trim::{TrimOptions, Trimmed};
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

/// Triangles of parameters of what is left of a strip, with no edge longer than this in space.
fn pieces(strip: &Strip, trimmed: &Trimmed, longest: f64) -> Vec<[[f64; 2]; 3]> {
    let at = |[u, v]: [f64; 2]| strip.at(u, v).point;
    let mut waiting: Vec<[[f64; 2]; 3]> =
        trimmed.triangles().iter().map(|corners| corners.map(|i| trimmed.parameters()[i as usize])).collect();
    let mut found = Vec::new();
    while let Some(triangle) = waiting.pop() {
        let length = |k: &usize| at(triangle[*k]).distance(at(triangle[(k + 1) % 3]));
        let k = (0..3).max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or(0);
        if length(&k) <= longest {
            found.push(triangle);
            continue;
        }
        let [a, b, c] = [0, 1, 2].map(|i| triangle[(k + i) % 3]);
        let middle = [0, 1].map(|i| 0.5 * (a[i] + b[i]));
        waiting.extend([[a, middle, c], [middle, b, c]]);
    }
    found
}

/// Trimmed strips as faces no longer than this, each strip in its colour.
pub fn faces(
    mut view: View,
    strips: &[Strip],
    trimmed: &[Trimmed],
    longest: f64,
    colour: &dyn Fn(usize) -> Rgb,
) -> View {
    for (i, (strip, trimmed)) in strips.iter().zip(trimmed).enumerate() {
        for piece in pieces(strip, trimmed, longest) {
            view = view.smooth_face(&piece.map(|[u, v]| strip.at(u, v).point), colour(i));
        }
    }
    view
}

/// Trimmed strips in one colour where a function of strip and parameters is below 0, in the other where it is not, shaded or flat.
pub fn two_tones(
    mut view: View,
    strips: &[Strip],
    trimmed: &[Trimmed],
    longest: f64,
    value: &dyn Fn(usize, f64, f64) -> f64,
    colours: [Rgb; 2],
    is_lit: bool,
) -> View {
    for (i, (strip, trimmed)) in strips.iter().zip(trimmed).enumerate() {
        for piece in pieces(strip, trimmed, longest) {
            let values = piece.map(|[u, v]| value(i, u, v));
            for (sign, colour) in [-1.0, 1.0].into_iter().zip(colours) {
                let mut corners = Vec::new();
                for k in 0..3 {
                    let next = (k + 1) % 3;
                    let [from, to] = [k, next].map(|k| sign * values[k]);
                    if from >= 0.0 {
                        corners.push(piece[k]);
                    }
                    if (from >= 0.0) != (to >= 0.0) {
                        let part = from / (from - to);
                        corners.push([0, 1].map(|c| piece[k][c] + part * (piece[next][c] - piece[k][c])));
                    }
                }
                if corners.len() > 2 {
                    let points: Vec<DVec3> = corners.iter().map(|&[u, v]| strip.at(u, v).point).collect();
                    view = if is_lit { view.smooth_face(&points, colour) } else { view.flat_face(&points, colour) };
                }
            }
        }
    }
    view
}

/// How strips are trimmed to be drawn: as finely as is seen.
pub const TRIM: TrimOptions = TrimOptions { tolerance: 2e-4, columns_per_span: 6 };

/// How long faces are at most, over the size of what is drawn.
const FINE: f64 = 1.0 / 60.0;

fn size(strips: &[Strip]) -> f64 {
    let points = || strips.iter().flat_map(|strip| strip.control(0).iter().chain(strip.control(1)));
    let low = points().fold(DVec3::INFINITY, |low, p| low.min(*p));
    low.distance(points().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p)))
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
    let view = faces(view, strips, trimmed, FINE * size(strips), &|i| STRIPS[i % 2]);
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

/// Strips and a surface laid over each other: in this colour where the strip is in front, blue where the surface is.
pub fn overlay(view: View, strips: &[Strip], trimmed: &[Trimmed], surface: &dyn ReferenceSurface, colour: Rgb) -> View {
    let sight = faces(view.clone(), strips, trimmed, FINE * size(strips), &|_| colour).sight();
    let front = |i: usize, u: f64, v: f64| {
        let point = strips[i].at(u, v).point;
        let foot = surface.nearest(point);
        let towards = if foot.normal.dot(sight) < 0.0 { foot.normal } else { -foot.normal };
        (point - foot.point).dot(towards)
    };
    two_tones(view, strips, trimmed, 0.5 * FINE * size(strips), &front, [REFERENCE, colour], true)
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
