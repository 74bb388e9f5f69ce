//! Strips cut along the boundary of their reference surface (Flöry et al. 2012, figures 8c, 9 and 13).
//!
//! Strips are made longer than their reference surface, so that they cover it. What is beyond its boundary is cut off in the
//! parameters `(u, v)` of each strip:
//!
//! 1. Each boundary loop of the reference is taken to the strip's nearest points ([`outline`]): a closed curve of parameters.
//! 2. These curves divide the rectangle of the parameters into faces. Over the curves together, taken by the even-odd rule, neighbouring
//!    faces are in turn inside and outside; so the connected pieces of both are the faces.
//! 3. A face is kept if the reference is beside it: if the nearest points of the reference to points within the face are not beyond
//!    its boundary.
//!
//! That a face is judged by the reference itself, not by how curves wind around it, is our choice: a part of the boundary that is
//! far from the strip may have its nearest points anywhere, and then only divides a face in two that are judged alike.
//!
//! Polygons are clipped and triangulated by the crates i_overlay and i_triangle, whose integer arithmetic leaves no special cases.

mod outline;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::overlay::FloatOverlay;
use i_overlay::float::single::SingleFloatOverlay;
use i_overlay::float::slice::FloatSlice;
use i_triangle::float::triangulatable::Triangulatable;
use i_triangle::float::triangulation::Triangulation;
use rayon::prelude::*;

use glam::{DVec2, DVec3};

use super::strip::{GAUSS, Strip};
use crate::error::{Error, Result, Status};
use crate::mesh::reference::ReferenceMesh;
use crate::mesh::{Mesh, ReferenceSurface};

/// Faces of less area than this, over that of all parameters, are what rounding leaves between two curves that are one.
const NO_FACE: f64 = 1e-8;

/// Coordinates of the unit square this near to a side are on it: the grid is a few times 1e-9 wide.
const OFF_END: f64 = 1e-8;

/// Corners this near to a ruling between two columns, in the unit square, are on it.
const ON_COLUMN: f64 = 1e-8;

/// The longest outline of a boundary loop, in units of the unit square: of a strip that lies beside the reference it is a few long.
/// Longer ones jump to and fro, and cross themselves about as often as the square of their length.
const LONGEST_OUTLINE: f64 = 200.0;

/// Needles of what is kept, cut off where they are no wider than this many tolerances.
const NEEDLE: f64 = 2.0;

/// Rulings by which the size of a strip is told.
const UNROLLED: usize = 33;

/// Each face is judged at so many points.
const JUDGES: usize = 9;

/// A closed polygon of parameters `(u, v)`.
pub type Contour = Vec<[f64; 2]>;

/// How strips are trimmed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrimOptions {
    /// How far the polygon along which a strip is cut may be from the boundary's nearest points, over the diagonal of the
    /// reference: above 0, at most 0.01. 1e-7 by default.
    pub tolerance: f64,
    /// Columns of triangles in each span of a strip, at least 1: all their edges across are rulings. 4 by default.
    pub columns_per_span: usize,
}

impl Default for TrimOptions {
    fn default() -> Self {
        Self { tolerance: 1e-7, columns_per_span: 4 }
    }
}

impl TrimOptions {
    pub(super) fn check(&self) -> Result<()> {
        if !(self.tolerance > 0.0 && self.tolerance <= 0.01) {
            let reason = format!("expected a number above 0 and at most 0.01, found {}", self.tolerance);
            return Err(Error::new(Status::InvalidValue, reason).at("options.tolerance"));
        }
        if !(1..=1000).contains(&self.columns_per_span) {
            let reason = format!("expected 1 to 1000, found {}", self.columns_per_span);
            return Err(Error::new(Status::InvalidValue, reason).at("options.columns_per_span"));
        }
        Ok(())
    }
}

/// What is left of a strip within the boundary of the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Trimmed {
    pieces: Vec<Vec<Contour>>,
    parameters: Vec<[f64; 2]>,
    triangles: Vec<[u32; 3]>,
    area: f64,
}

/// What is left of a ruling: several pieces where the reference has a hole or a bay.
#[derive(Clone, Debug, PartialEq)]
pub struct TrimmedRuling {
    /// Its parameter.
    pub u: f64,
    /// The pieces from the first boundary to the second, each with its ends.
    pub pieces: Vec<[DVec3; 2]>,
}

impl Trimmed {
    /// The pieces: each its outer contour, counterclockwise in `(u, v)`, then its holes, clockwise. None where the strip is beyond
    /// the reference altogether.
    pub fn pieces(&self) -> &[Vec<Contour>] {
        &self.pieces
    }

    /// The area in square model units: of the curved surface, not of its triangles.
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The parameters `(u, v)` of the triangles' corners.
    pub fn parameters(&self) -> &[[f64; 2]] {
        &self.parameters
    }

    /// The triangles, counterclockwise in `(u, v)`; no edge crosses the rulings between the columns of [`TrimOptions`].
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The triangles on the strip that was trimmed.
    pub fn mesh(&self, strip: &Strip) -> Mesh {
        Mesh {
            points: self.parameters.iter().map(|&[u, v]| strip.at(u, v).point).collect(),
            faces: self.triangles.iter().map(|triangle| triangle.to_vec()).collect(),
        }
    }

    /// The unit normals of the strip at the corners, for zebra stripes; zero where it has none.
    pub fn normals(&self, strip: &Strip) -> Vec<DVec3> {
        self.parameters.iter().map(|&[u, v]| strip.at(u, v).normal()).collect()
    }

    /// The parts of the ruling at `u` that are kept, ascending, each from one `v` to another.
    pub fn ruling_parts(&self, u: f64) -> Vec<[f64; 2]> {
        let mut crossings = Vec::new();
        // Each edge has its lower end but not its upper one, so that a corner on the ruling counts once; at the last ruling it is
        // the other way round, as nothing is beyond.
        let last = self.pieces.iter().flatten().flatten().fold(f64::NEG_INFINITY, |last, at| last.max(at[0]));
        let is_before = |at: f64| if u >= last { at < u } else { at <= u };
        for contour in self.pieces.iter().flatten() {
            for (i, &[u0, v0]) in contour.iter().enumerate() {
                let [u1, v1] = contour[(i + 1) % contour.len()];
                if is_before(u0) != is_before(u1) {
                    crossings.push(v0 + (v1 - v0) * ((u - u0) / (u1 - u0)));
                }
            }
        }
        crossings.sort_unstable_by(f64::total_cmp);
        crossings.chunks_exact(2).filter(|ends| ends[1] > ends[0]).map(|ends| [ends[0], ends[1]]).collect()
    }

    /// What is left of rulings that are evenly spread over `u`, as of [`Strip::rulings`]: what a workshop cuts. Rulings of which
    /// nothing is left are there too.
    pub fn rulings(&self, strip: &Strip, count: usize) -> Vec<TrimmedRuling> {
        let ruling = |u: f64| {
            let [a, b] = strip.ruling(u);
            let piece = |part: [f64; 2]| part.map(|v| a.lerp(b, v));
            TrimmedRuling { u, pieces: self.ruling_parts(u).into_iter().map(piece).collect() }
        };
        strip.ruling_parameters(count).into_iter().map(ruling).collect()
    }
}

/// Trims each strip along the boundary of `reference`.
///
/// # Errors
/// An option out of range (`options.tolerance`, `options.columns_per_span`), or a strip whose control points are all one
/// (`strips[i]`). Status `Degenerate`: a strip so far from the reference, or so folded, that the nearest points of its boundary jump
/// to and fro on it (`strips[i]`).
pub fn trim(strips: &[Strip], reference: &ReferenceMesh<'_>, options: &TrimOptions) -> Result<Vec<Trimmed>> {
    options.check()?;
    let one = |(i, strip): (usize, &Strip)| {
        trim_one(strip, reference, options).map_err(|error| error.with_place(format!("strips[{i}]")))
    };
    strips.par_iter().enumerate().map(one).collect()
}

fn trim_one(strip: &Strip, reference: &ReferenceMesh<'_>, options: &TrimOptions) -> Result<Trimmed> {
    let tolerance = options.tolerance * reference.diagonal();
    let mut outlines = outline::outlines(strip, reference.mesh(), tolerance)?;
    // The rectangle as a square: on the grid of 32 bits that polygons are clipped on, both parameters are as fine.
    let last = strip.length_u();
    outlines.iter_mut().flatten().for_each(|at| at[0] /= last);
    if !outlines.iter().all(|outline| length(outline) <= LONGEST_OUTLINE) {
        let reason = "expected a strip beside the reference, found one on which the nearest points of its boundary jump to and fro";
        return Err(Error::new(Status::Degenerate, reason));
    }
    let square: Contour = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut kept: Vec<Vec<Contour>> = Vec::new();
    for rule in [OverlayRule::Intersect, OverlayRule::Difference] {
        for face in square.overlay_as::<i32>(&outlines, rule, FillRule::EvenOdd) {
            if is_inside(&face, strip, reference, tolerance) {
                kept.push(face);
            }
        }
    }
    let mut pieces = match kept.len() {
        0 => Vec::new(),
        _ => FloatOverlay::<[f64; 2], i32>::from_subj(&kept).overlay(OverlayRule::Subject, FillRule::NonZero),
    };
    pieces.iter_mut().flatten().flatten().for_each(|at| *at = at.map(snapped));
    let size = unrolled(strip);
    for piece in &mut pieces {
        piece.iter_mut().for_each(|contour| *contour = without_needles(contour, size, NEEDLE * tolerance));
        piece.retain(|contour| contour.len() >= 3);
    }
    pieces.retain(|piece| !piece.is_empty());
    let (mut parameters, triangles) = triangulate(&pieces, options.columns_per_span * strip.basis().spans());
    let to_spans = |at: &mut [f64; 2]| at[0] *= last;
    pieces.iter_mut().flatten().flatten().for_each(to_spans);
    parameters.iter_mut().for_each(to_spans);
    let area = triangles.iter().map(|corners| area(strip, corners.map(|i| parameters[i as usize]))).sum();
    Ok(Trimmed { pieces, parameters, triangles, area })
}

/// The sides of a rectangle about as large as a strip: its length along the middle, and its mean width.
fn unrolled(strip: &Strip) -> DVec2 {
    let rulings = strip.rulings(UNROLLED);
    let width = rulings.iter().map(|[a, b]| a.distance(*b)).sum::<f64>() / rulings.len() as f64;
    let middles: Vec<DVec3> = rulings.iter().map(|[a, b]| a.midpoint(*b)).collect();
    DVec2::new(middles.windows(2).map(|pair| pair[0].distance(pair[1])).sum(), width)
}

/// A closed polygon of the unit square without its needles, ways out and back that are nowhere wider than this where the square is a
/// rectangle of this size: where a boundary of the strip leaves the reference, what is cut off and what is kept are the same within
/// the tolerance for a while.
fn without_needles(contour: &Contour, size: DVec2, width: f64) -> Contour {
    let position = |at: [f64; 2]| size * DVec2::from(at);
    let is_needle = |a: [f64; 2], tip: [f64; 2], b: [f64; 2]| {
        let tip = position(tip);
        let [a, b] = [position(a) - tip, position(b) - tip];
        let [short, long] = if a.length_squared() < b.length_squared() { [a, b] } else { [b, a] };
        short.dot(long) >= 0.0
            && long.try_normalize().is_none_or(|along| short.reject_from_normalized(along).length() <= width)
    };
    let mut all = contour.clone();
    // Once from the first corner on, and once from the middle on, as a needle may be where the polygon begins.
    for _ in 0..2 {
        let mut kept = Contour::with_capacity(all.len());
        for &at in &all {
            while let [.., before, tip] = kept[..]
                && is_needle(before, tip, at)
            {
                kept.pop();
            }
            kept.push(at);
        }
        let middle = kept.len() / 2;
        kept.rotate_left(middle);
        all = kept;
    }
    all
}

/// The length of a closed polygon.
fn length(contour: &Contour) -> f64 {
    let step = |(i, a): (usize, &[f64; 2])| {
        let b = contour[(i + 1) % contour.len()];
        (b[0] - a[0]).hypot(b[1] - a[1])
    };
    contour.iter().enumerate().map(step).sum()
}

/// A coordinate of the unit square, put on a side where rounding to the grid took it off.
fn snapped(coordinate: f64) -> f64 {
    if coordinate <= OFF_END {
        0.0
    } else if coordinate >= 1.0 - OFF_END {
        1.0
    } else {
        coordinate
    }
}

/// Whether the reference is beside a face: whether it is beside most of the points in its largest triangles.
fn is_inside(face: &Vec<Contour>, strip: &Strip, reference: &ReferenceMesh<'_>, tolerance: f64) -> bool {
    let Triangulation { points, indices } = face.as_slice().triangulate_as::<i32>().to_triangulation::<u32>();
    let size = |[a, b, c]: [[f64; 2]; 3]| 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
    let triangle = |corners: &[u32]| [0, 1, 2].map(|k| points[corners[k] as usize]);
    let mut triangles: Vec<_> = indices.chunks_exact(3).map(triangle).collect();
    if triangles.iter().copied().map(size).sum::<f64>() < NO_FACE {
        return false;
    }
    triangles.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
    let is_beside = |[a, b, c]: &[[f64; 2]; 3]| {
        let middle = [0, 1].map(|k| (a[k] + b[k] + c[k]) / 3.0);
        reference.nearest(strip.at(strip.length_u() * middle[0], middle[1]).point).overhang <= tolerance
    };
    let judges = &triangles[..triangles.len().min(JUDGES)];
    let votes = judges.iter().filter(|triangle| is_beside(triangle)).count();
    2 * votes > judges.len()
}

/// The pieces, in the unit square, cut into columns between rulings, and these into triangles; equal corners are one.
fn triangulate(pieces: &[Vec<Contour>], columns: usize) -> (Vec<[f64; 2]>, Vec<[u32; 3]>) {
    if pieces.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let line = |i: usize| [-1.0, 2.0].map(|v| [i as f64 / columns as f64, v]).to_vec();
    let lines: Vec<Contour> = (1..columns).map(line).collect();
    // A side of a piece that is a ruling between two columns up to rounding is put on it, or a sliver would be left.
    let mut pieces = pieces.to_vec();
    for at in pieces.iter_mut().flatten().flatten() {
        let nearest = (at[0] * columns as f64).round() / columns as f64;
        at[0] = if (at[0] - nearest).abs() < ON_COLUMN { nearest } else { at[0] };
    }
    let cut = pieces.slice_by_as::<i32>(&lines, FillRule::NonZero);
    let Triangulation { points, indices } = cut.as_slice().triangulate_as::<i32>().to_triangulation::<u32>();
    let mut order: Vec<usize> = (0..points.len()).collect();
    let compare = |a: &[f64; 2], b: &[f64; 2]| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]));
    order.sort_unstable_by(|&i, &j| compare(&points[i], &points[j]).then(i.cmp(&j)));
    let (mut unique, mut number) = (Vec::with_capacity(points.len()), vec![0_u32; points.len()]);
    for i in order {
        if unique.last() != Some(&points[i]) {
            unique.push(points[i]);
        }
        number[i] = unique.len() as u32 - 1;
    }
    let parameters: Vec<[f64; 2]> = unique.into_iter().map(|at: [f64; 2]| at.map(snapped)).collect();
    let turn = |[a, b, c]: [[f64; 2]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let oriented = |corners: &[u32]| {
        let corners = [0, 1, 2].map(|k| number[corners[k] as usize]);
        let turn = turn(corners.map(|i| parameters[i as usize]));
        if turn < 0.0 { [corners[0], corners[2], corners[1]] } else { corners }
    };
    let is_triangle = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let triangles = indices.chunks_exact(3).map(oriented).filter(is_triangle).collect();
    (parameters, triangles)
}

/// The area of a strip over a triangle of parameters: Gauss's rule over the unit square, one side of which is shrunk into a corner.
fn area(strip: &Strip, [a, b, c]: [[f64; 2]; 3]) -> f64 {
    let double = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
    let at = |(s, ds): (f64, f64), (t, dt): (f64, f64)| {
        let [u, v] = [0, 1].map(|k| a[k] + s * ((b[k] - a[k]) + t * (c[k] - b[k])));
        let jet = strip.at(u, v);
        ds * dt * s * jet.first[0].cross(jet.first[1]).length()
    };
    double * GAUSS.iter().flat_map(|&s| GAUSS.map(|t| at(s, t))).sum::<f64>()
}

#[cfg(test)]
pub(super) mod tests;
