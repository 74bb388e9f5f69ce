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

/// Triangles of parameters of what is left of a strip, with edges of about this length in space.
fn pieces(strip: &Strip, trimmed: &Trimmed, longest: f64) -> Vec<[[f64; 2]; 3]> {
    let at = |[u, v]: [f64; 2]| strip.at(u, v).point;
    let columns = TRIM.columns_per_span * strip.basis().spans();
    let u = |k: usize| strip.length_u() * k as f64 / columns as f64;
    let parts: Vec<Vec<[f64; 2]>> = (0..=columns).map(|k| trimmed.ruling_parts(u(k))).collect();
    let mut found = Vec::new();
    for k in 0..columns {
        if parts[k].len() != parts[k + 1].len() {
            // Where a piece begins or ends.
            let is_here = |corners: &[[f64; 2]; 3]| {
                let middle = corners.iter().map(|corner| corner[0]).sum::<f64>() / 3.0;
                middle > u(k) && middle < u(k + 1)
            };
            let triangles = trimmed.triangles().iter().map(|corners| corners.map(|i| trimmed.parameters()[i as usize]));
            found.extend(triangles.filter(is_here));
            continue;
        }
        for (before, after) in parts[k].iter().zip(&parts[k + 1]) {
            let corner = |s: f64, t: f64| {
                let [low, high] = [0, 1].map(|end| before[end] + s * (after[end] - before[end]));
                [u(k) + s * (u(k + 1) - u(k)), low + t * (high - low)]
            };
            let count = |from: [f64; 2], to: [f64; 2]| ((at(from).distance(at(to)) / longest).ceil() as usize).max(1);
            let wide = count(corner(0.0, 0.0), corner(1.0, 0.0)).max(count(corner(0.0, 1.0), corner(1.0, 1.0)));
            let high = count(corner(0.0, 0.0), corner(0.0, 1.0)).max(count(corner(1.0, 0.0), corner(1.0, 1.0)));
            for (i, j) in (0..wide).flat_map(|i| (0..high).map(move |j| (i, j))) {
                let at = |i: usize, j: usize| corner(i as f64 / wide as f64, j as f64 / high as f64);
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                found.extend([[a, b, c], [a, c, d]]);
            }
        }
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

/// The part of a triangle of parameters where a function, given at its corners, times a sign is not below 0.
fn clipped(piece: [[f64; 2]; 3], values: [f64; 3], sign: f64) -> Vec<[f64; 2]> {
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
    if corners.len() > 2 { corners } else { Vec::new() }
}

/// Trimmed strips in one colour where a function of strip and parameters is below 0, in the other where it is not.
pub fn two_tones(
    mut view: View,
    strips: &[Strip],
    trimmed: &[Trimmed],
    longest: f64,
    value: &dyn Fn(usize, f64, f64) -> f64,
    colours: [Rgb; 2],
) -> View {
    for (i, (strip, trimmed)) in strips.iter().zip(trimmed).enumerate() {
        for piece in pieces(strip, trimmed, longest) {
            let values = piece.map(|[u, v]| value(i, u, v));
            for (sign, colour) in [-1.0, 1.0].into_iter().zip(colours) {
                let corners = clipped(piece, values, sign);
                if !corners.is_empty() {
                    let points: Vec<DVec3> = corners.iter().map(|&[u, v]| strip.at(u, v).point).collect();
                    view = view.smooth_face(&points, colour);
                }
            }
        }
    }
    view
}

/// The same as patches over faces of the second colour: of sharp edges, where strips hide nothing of each other.
pub fn pattern(
    view: View,
    strips: &[Strip],
    trimmed: &[Trimmed],
    longest: f64,
    value: &dyn Fn(usize, f64, f64) -> f64,
    colours: [Rgb; 2],
) -> View {
    let mut view = faces(view, strips, trimmed, 2.0 * longest, &|_| colours[1]);
    for (i, (strip, trimmed)) in strips.iter().zip(trimmed).enumerate() {
        let clip = |piece: [[f64; 2]; 3]| clipped(piece, piece.map(|[u, v]| value(i, u, v)), -1.0);
        let polygons = pieces(strip, trimmed, longest).into_iter().map(clip).filter(|corners| !corners.is_empty());
        let in_space = |corners: Vec<[f64; 2]>| corners.iter().map(|&[u, v]| strip.at(u, v).point).collect();
        view = view.patch(polygons.map(in_space).collect(), colours[0]);
    }
    view
}

/// How strips are trimmed to be drawn.
pub const TRIM: TrimOptions = TrimOptions { tolerance: 1e-7, columns_per_span: 6 };

/// How long faces are at most, over the size of what is drawn.
const FINE: f64 = 1.0 / 60.0;

fn size(strips: &[Strip]) -> f64 {
    let points = || strips.iter().flat_map(|strip| strip.control(0).iter().chain(strip.control(1)));
    let low = points().fold(DVec3::INFINITY, |low, p| low.min(*p));
    low.distance(points().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p)))
}

/// Boundaries of trimmed strips in bold, the rim of the surface thinner.
pub fn outlines(mut view: View, strips: &[Strip], trimmed: &[Trimmed]) -> View {
    let is_side = |v: f64| !(1e-6..=1.0 - 1e-6).contains(&v);
    let shortest = size(strips) / 300.0;
    for (strip, trimmed) in strips.iter().zip(trimmed) {
        for contour in trimmed.pieces().iter().flatten() {
            let mut rim: Vec<DVec3> = Vec::new();
            // Not where all that is left of a ruling is its end.
            let is_beside = |u: f64, v: f64| {
                let parts = trimmed.ruling_parts(u);
                parts.iter().any(|[low, high]| high - low > 5e-3 && (low - v).abs().min((high - v).abs()) < 1e-3)
            };
            for (k, from) in contour.iter().enumerate() {
                let to = contour[(k + 1) % contour.len()];
                let parts = (((to[0] - from[0]).abs() / 0.12).ceil() as usize).max(1);
                let at = |i: usize| {
                    let part = i as f64 / parts as f64;
                    strip.at(from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1])).point
                };
                let points: Vec<DVec3> = (0..=parts).map(at).collect();
                if is_side(from[1]) && is_side(to[1]) && (from[1] - to[1]).abs() < 0.5 {
                    for i in 0..parts {
                        let u = from[0] + (i as f64 + 0.5) / parts as f64 * (to[0] - from[0]);
                        if is_beside(u, from[1]) {
                            view = view.line(&points[i..i + 2], INK, 2.6);
                        }
                    }
                    rim.push(points[0]);
                    rim.dedup();
                    view = view.line(&std::mem::take(&mut rim), RIM, 1.3);
                    rim.push(points[parts]);
                } else if rim.last().is_none_or(|last| last.distance(points[parts]) > shortest) {
                    // The rim has far more points than are seen.
                    rim.extend(points);
                }
            }
            rim.extend(contour.first().map(|[u, v]| strip.at(*u, *v).point));
            rim.dedup();
            view = view.line(&rim, RIM, 1.3);
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

/// Strips and a surface laid over each other: the first colour is of the surface, where it is in front, the second of strips.
pub fn overlay(
    view: View,
    strips: &[Strip],
    trimmed: &[Trimmed],
    surface: &dyn ReferenceSurface,
    colours: [Rgb; 2],
) -> View {
    let sight = faces(view.clone(), strips, trimmed, FINE * size(strips), &|_| colours[1]).sight();
    let front = |i: usize, u: f64, v: f64| {
        let point = strips[i].at(u, v).point;
        let foot = surface.nearest(point);
        let towards = if foot.normal.dot(sight) < 0.0 { foot.normal } else { -foot.normal };
        (point - foot.point).dot(towards)
    };
    two_tones(view, strips, trimmed, 0.5 * FINE * size(strips), &front, colours)
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
