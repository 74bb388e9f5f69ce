//! What is minimised: how far strips are from the reference surface, from each other, and from where they started.
//!
//! All is a sum of weighted means of squared distances in units of the reference surface's diagonal:
//!
//! - *proximity*: from points of the strips to the reference surface, by area;
//! - *gap*: from points of each of two boundaries that are to be one to the other boundary;
//! - *coverage*: from points of the reference surface to the nearest strip;
//! - *thin plate* and *proximal*: of the control points' ways from the start.
//!
//! For a point `x` that is a sum of control points with weights, and the nearest point `q` of what it is to be near to, half the
//! gradient of `‖x − q‖²` by `x` is `x − q` however `q` moves, since `q` moves across it. Second derivatives are modelled by the
//! distance to the tangent plane (or line) at `q`, as Flöry et al. 2012, section 2.2 do; along a boundary that ends, by that to its
//! end point. Where strips meet, `q` too is a sum of control points: both sides move.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::Strip;
use super::coverage::NearestStrip;
use super::layout::{Joints, Layout};
use super::pull::{Form, Pull, across};
use super::thin_plate;
use crate::error::{Error, Result, Status, finite};
use crate::mesh::TriangleMesh;
use crate::mesh::curve::NearestOnCurve;
use crate::mesh::reference::{ReferenceSurface, SurfaceFoot};

/// Nearer than this multiple of the diagonal the direction to the foot is round-off, and the normal there is taken.
const NO_DIRECTION: f64 = 1e-10;

/// A sample is beyond the reference surface's boundary by more than this multiple of the diagonal: a point of a mesh's rim, which
/// is beyond the rim by its chords, counts as inside.
const BEYOND: f64 = 1e-6;

/// Nearer than this multiple of the diagonal a point of the reference surface is beside a strip: farther away the strip is beside
/// another part of the surface.
const BESIDE: f64 = 0.1;

/// The step of a difference quotient along the boundary, as a multiple of the diagonal.
const DIFFERENCE: f64 = 1e-6;

/// The cosine between a boundary and the way to an end of it above which that end is a corner.
const CORNER: f64 = 1e-9;

/// The weights of the terms, each 0 or more. All distances are in units of the reference surface's diagonal, each term is a mean, so
/// that weights depend neither on the model's size nor on how finely it is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Of the squared distance from strips to the reference surface.
    pub proximity: f64,
    /// That part of `proximity` that samples have which at the start are beyond the boundary of the reference surface: there it is
    /// continued by its tangent planes. They are not drawn back. 0 to 1.
    pub beyond: f64,
    /// Of the squared distance between boundaries that are to be one.
    pub gap: f64,
    /// Of the squared distance from points of the reference surface to the nearest strip. Without it, without `proximal` and
    /// without fixed ends, strips would slide together and shrink.
    pub coverage: f64,
    /// Of the thin plate energy of the way from the start, per span.
    pub thin_plate: f64,
    /// Of the squared way of the control points from the start. Along the surface little else holds them: on five surfaces of
    /// negative curvature 1e-6 took up to 50 iterations until the sum was flat, and folded a boundary; 1e-4 takes up to 7 and folds
    /// none. Deviations are 1.7 times as large at most on four of them, 4 times on the hyperboloid (7e-4 of the diagonal).
    pub proximal: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self { proximity: 1.0, beyond: 1e-2, gap: 1.0, coverage: 1.0, thin_plate: 1e-6, proximal: 1e-4 }
    }
}

impl Weights {
    /// # Errors
    /// A weight that is not finite or below 0, `beyond` above 1, or proximity, gap and coverage all 0; the place is `weights` or
    /// `weights.NAME`.
    pub fn check(&self) -> Result<()> {
        let named = [
            ("proximity", self.proximity),
            ("beyond", self.beyond),
            ("gap", self.gap),
            ("coverage", self.coverage),
            ("thin_plate", self.thin_plate),
            ("proximal", self.proximal),
        ];
        for (name, weight) in named {
            let place = format!("weights.{name}");
            if finite(&place, weight)? < 0.0 || (name == "beyond" && weight > 1.0) {
                let most = if name == "beyond" { " and at most 1" } else { "" };
                let reason = format!("expected at least 0{most}, found {weight}");
                return Err(Error::new(Status::InvalidValue, reason).at(place));
            }
        }
        if self.proximity + self.gap + self.coverage == 0.0 {
            return Err(Error::new(Status::InvalidValue, "expected one of them above 0").at("weights"));
        }
        Ok(())
    }
}

/// What is minimised, term by term, each with its weight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parts {
    /// From strips to the reference surface.
    pub proximity: f64,
    /// Between neighbours.
    pub gap: f64,
    /// From the reference surface to strips.
    pub coverage: f64,
    /// Thin plate and proximal.
    pub way: f64,
}

impl Parts {
    /// Their sum.
    pub fn total(&self) -> f64 {
        self.proximity + self.gap + self.coverage + self.way
    }
}

/// At most `most` points of a mesh, evenly chosen from their order: what strips are to cover.
pub fn points_to_cover(mesh: &TriangleMesh, most: usize) -> Vec<DVec3> {
    let (points, count) = (mesh.points(), mesh.points().len().min(most));
    (0..count).map(|k| points[k * points.len() / count]).collect()
}

/// Those of [`points_to_cover`] that are beside one of some strips: strips that are to cover a part of the surface only are not
/// drawn out of it by the rest.
pub fn points_beside(strips: &[Strip], mesh: &TriangleMesh, most: usize) -> Vec<DVec3> {
    let Some(search) = NearestStrip::new(strips) else { return Vec::new() };
    let size = mesh.diagonal();
    let is_beside = |point: &DVec3| {
        let foot = search.nearest(*point);
        foot.point.distance(*point) < BESIDE * size && foot.overhang(*point) <= BEYOND * size
    };
    points_to_cover(mesh, most).into_par_iter().filter(is_beside).collect()
}

/// What strips are to be near to.
#[derive(Clone, Copy)]
pub(super) struct Aim<'a> {
    pub(super) reference: &'a dyn ReferenceSurface,
    pub(super) cover: &'a [DVec3],
    pub(super) joints: &'a Joints,
}

/// A point of a strip at which its distance counts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) at: ([u32; 8], [f64; 8]),
    /// Its part in the term, with the weight.
    share: f64,
    /// Whether it started beyond the boundary of the reference surface.
    is_beyond: bool,
}

/// A boundary, the boundary that it is to be near to, and the parameters at which it is.
#[derive(Clone, Debug)]
struct Facing {
    own: (usize, usize),
    other: (usize, usize),
    parameters: Vec<f64>,
}

impl Facing {
    /// Both ways of all joints, where strips start beside each other: what starts beyond the end of the other boundary is beyond the
    /// surface, or is another strip's neighbour.
    fn all(joints: &Joints, strips: &[Strip], layout: &Layout, numbers: &[usize], beside: f64) -> Result<Vec<Self>> {
        let pairs = joints.pairs.iter().filter(|_| !joints.is_shared);
        let mut all = Vec::new();
        for &[first, second] in pairs.chain(&joints.partial) {
            for (own, other) in [((first, 1), (second, 0)), ((second, 0), (first, 1))] {
                let number = numbers[own.0];
                let search = NearestOnCurve::new(strips[other.0].boundary(other.1))?;
                let is_beside = |&u: &f64| {
                    let foot = search.nearest(strips[own.0].ruling(u)[own.1]);
                    foot.end.is_none() || foot.cosine.abs() <= CORNER || foot.distance <= beside
                };
                let all_parameters = (0..number).map(|k| parameter(layout.basis(own.0), number, k));
                let parameters = all_parameters.filter(is_beside).collect();
                all.push(Self { own, other, parameters });
            }
        }
        Ok(all)
    }
}

/// What is minimised, as a function of the unknown points.
pub(super) struct Terms<'a> {
    aim: Aim<'a>,
    pub(super) layout: Layout,
    weights: Weights,
    /// The diagonal of the reference surface.
    pub(super) size: f64,
    samples: Vec<Sample>,
    facing: Vec<Facing>,
    start: Vec<DVec3>,
    pub(super) form: Form,
}

/// Where a sample is.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleFoot {
    pub(super) at: ([u32; 8], [f64; 8]),
    /// The distance, of one beyond the boundary that to the tangent plane, with a sign.
    pub(super) height: f64,
    /// Its gradient by the sample's point.
    pub(super) direction: DVec3,
    pub(super) is_beyond: bool,
}

/// The terms at some points.
#[derive(Clone, Debug)]
pub(super) struct Evaluation {
    pub(super) pulls: Vec<Pull>,
    pub(super) feet: Vec<SampleFoot>,
    pub(super) parts: Parts,
    /// The largest distance of a sample to the reference surface, in model units; those beyond its boundary left out.
    pub(super) largest_deviation: f64,
    /// The largest distance of a boundary's sample to its neighbour, in model units.
    pub(super) largest_gap: f64,
}

impl<'a> Terms<'a> {
    /// `columns` samples along each boundary for each control point, `rows` along each ruling.
    pub(super) fn new(
        aim: Aim<'a>,
        (layout, start): (Layout, Vec<DVec3>),
        weights: Weights,
        [columns, rows]: [usize; 2],
    ) -> Result<Self> {
        let size = aim.reference.diagonal();
        let scale = 1.0 / (size * size);
        let strips = layout.strips(&start).ok_or_else(|| Error::new(Status::InvalidValue, "expected finite strips"))?;
        let areas: Vec<f64> = strips.iter().map(Strip::area).collect();
        let total: f64 = areas.iter().sum();
        let (mut samples, mut samples_per_boundary) = (Vec::new(), Vec::new());
        for (strip, area) in areas.iter().enumerate() {
            let basis = layout.basis(strip);
            let number = columns * (basis.count() - usize::from(!basis.is_closed()));
            samples_per_boundary.push(number);
            let share = weights.proximity * scale * area / (total * (number * rows) as f64);
            for k in 0..number * rows {
                let at =
                    layout.weights(strip, parameter(basis, number, k / rows), (k % rows) as f64 / (rows - 1) as f64);
                samples.push(Sample { at, share, is_beyond: false });
            }
        }
        let is_beyond: Vec<bool> = samples
            .par_iter()
            .map(|sample| aim.reference.nearest(position(sample.at, &start)).overhang > BEYOND * size)
            .collect();
        for (sample, is_beyond) in samples.iter_mut().zip(is_beyond) {
            sample.share *= if is_beyond { weights.beyond } else { 1.0 };
            sample.is_beyond = is_beyond;
        }
        let form = thin_plate::form(&layout, weights.thin_plate * scale, weights.proximal * scale);
        let facing = Facing::all(aim.joints, &strips, &layout, &samples_per_boundary, BEYOND * size)?;
        Ok(Self { aim, layout, weights, size, samples, facing, start, form })
    }

    /// The ways of the points from the start.
    pub(super) fn ways(&self, points: &[DVec3]) -> Vec<DVec3> {
        points.iter().zip(&self.start).map(|(point, start)| *point - *start).collect()
    }

    /// All terms at some points; none where those are not finite.
    pub(super) fn evaluate(&self, points: &[DVec3]) -> Option<Evaluation> {
        let strips = self.layout.strips(points)?;
        let feet: Vec<SampleFoot> = self.samples.par_iter().map(|sample| self.foot(sample, points)).collect();
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let inside = feet.iter().filter(|foot| !foot.is_beyond);
        let largest_deviation = largest(&mut inside.map(|foot| foot.height.abs()));
        let mut parts = Parts::default();
        let pull = |(foot, sample): (&SampleFoot, &Sample)| {
            Pull::of_height(foot.at, sample.share, foot.height, foot.direction)
        };
        let mut pulls: Vec<Pull> = feet.iter().zip(&self.samples).map(pull).collect();
        parts.proximity = pulls.iter().map(|pull| pull.value).sum();
        let gaps = self.gaps(&strips)?;
        let largest_gap = largest(&mut gaps.iter().map(|(_, gap)| *gap));
        parts.gap = gaps.iter().map(|(pull, _)| pull.value).sum();
        pulls.extend(gaps.into_iter().map(|(pull, _)| pull));
        let covers = self.covers(&strips)?;
        parts.coverage = covers.iter().map(|pull| pull.value).sum();
        pulls.extend(covers);
        parts.way = self.form.value(&self.ways(points));
        parts.total().is_finite().then_some(Evaluation { pulls, feet, parts, largest_deviation, largest_gap })
    }

    fn foot(&self, sample: &Sample, points: &[DVec3]) -> SampleFoot {
        let point = position(sample.at, points);
        let foot = self.aim.reference.nearest(point);
        let apart = point - foot.point;
        let is_beyond = foot.overhang > 0.0;
        if is_beyond {
            return self.foot_beyond(sample, point, &foot);
        }
        let is_direction = apart.length() > NO_DIRECTION * self.size;
        let direction = if is_direction { apart.normalize() } else { foot.normal };
        SampleFoot { at: sample.at, height: apart.dot(direction), direction, is_beyond: sample.is_beyond }
    }

    /// Beyond the boundary only the distance `e = n·(x − q)` to the tangent plane at the foot `q` counts: all of the distance would draw
    /// strips back. As `x` moves along the boundary, `q` and `n` go with it and `e` changes by how the normal turns; as it moves in the
    /// plane across both, they stay. So `∇e = n + (∂e/∂t) t`, the derivative along the boundary being a difference quotient.
    fn foot_beyond(&self, sample: &Sample, point: DVec3, foot: &SurfaceFoot) -> SampleFoot {
        let height = |point: DVec3| {
            let foot = self.aim.reference.nearest(point);
            foot.normal.dot(point - foot.point)
        };
        let apart = foot.normal.dot(point - foot.point);
        let along = foot.normal.cross(point - foot.point).normalize_or_zero();
        let h = DIFFERENCE * self.size;
        let turn = (height(point + h * along) - height(point - h * along)) / (2.0 * h);
        let gradient = foot.normal + turn * along;
        let is_beyond = sample.is_beyond || foot.overhang > BEYOND * self.size;
        SampleFoot { at: sample.at, height: apart, direction: gradient, is_beyond }
    }

    /// The pulls between neighbours, and the distances.
    fn gaps(&self, strips: &[Strip]) -> Option<Vec<(Pull, f64)>> {
        let total: usize = self.facing.iter().map(|facing| facing.parameters.len()).sum();
        let share = self.weights.gap / (self.size * self.size * total.max(1) as f64);
        let mut found = Vec::with_capacity(total);
        for Facing { own: (strip, side), other: (other, other_side), parameters } in &self.facing {
            let search = NearestOnCurve::new(strips[*other].boundary(*other_side)).ok()?;
            for &u in parameters {
                let here = self.layout.weights(*strip, u, *side as f64);
                let point = strips[*strip].ruling(u)[*side];
                let foot = search.nearest(point);
                let there = self.layout.weights(*other, foot.parameter, *other_side as f64);
                let is_corner = foot.end.is_some() && foot.cosine.abs() > CORNER;
                let directions = if is_corner { DMat3::IDENTITY } else { across(foot.tangent) };
                let pull = Pull::new(difference(here, there), share, point - foot.point, directions);
                found.push((pull, foot.distance));
            }
        }
        Some(found)
    }

    fn covers(&self, strips: &[Strip]) -> Option<Vec<Pull>> {
        if self.weights.coverage == 0.0 || self.aim.cover.is_empty() {
            return Some(Vec::new());
        }
        let search = NearestStrip::new(strips)?;
        let share = self.weights.coverage / (self.size * self.size * self.aim.cover.len() as f64);
        let pull = |&point: &DVec3| {
            let foot = search.nearest(point);
            let at = self.layout.weights(foot.strip, foot.parameters[0], foot.parameters[1]);
            Pull::new(at, share, foot.point - point, foot.directions)
        };
        Some(self.aim.cover.par_iter().map(pull).collect())
    }
}

/// Of so many parameters, evenly spread over the range, the ends of an open one included, that of this place.
fn parameter(basis: &crate::mesh::curve::CubicBasis, number: usize, k: usize) -> f64 {
    let parts = if basis.is_closed() { number } else { number - 1 };
    basis.spans() as f64 * k as f64 / parts as f64
}

fn position((points, weights): ([u32; 8], [f64; 8]), all: &[DVec3]) -> DVec3 {
    points.iter().zip(weights).map(|(&i, weight)| weight * all[i as usize]).sum()
}

/// One point of a boundary less one of another: each depends on four control points only.
fn difference(here: ([u32; 8], [f64; 8]), there: ([u32; 8], [f64; 8])) -> ([u32; 8], [f64; 8]) {
    let used = |(points, weights): ([u32; 8], [f64; 8]), sign: f64| {
        // A boundary's point has weights of one side, the other side's are 0.
        let from = if weights[..4].iter().any(|&weight| weight != 0.0) { 0 } else { 4 };
        (0..4).map(move |k| (points[from + k], sign * weights[from + k]))
    };
    let (mut points, mut weights) = ([0; 8], [0.0; 8]);
    for (k, (point, weight)) in used(here, 1.0).chain(used(there, -1.0)).enumerate() {
        (points[k], weights[k]) = (point, weight);
    }
    (points, weights)
}
