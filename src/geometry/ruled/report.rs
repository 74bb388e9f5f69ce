//! How good strips are: how near to their reference surface, how much of it they cover, how they meet, how wide they are.
//!
//! What is beyond the boundary of the reference is cut off when strips are trimmed, and counts for nothing here but where areas of
//! whole strips are asked for.

mod cover;
mod features;
mod joints;

pub use crate::mesh::deviation::Deviation;
pub use features::feature_sizes;
pub use joints::{JointReport, consecutive};

use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::coverage::NearestStrip;
use super::strip::Strip;
use super::trim::{TrimOptions, Trimmed, trim};
use crate::error::{Error, Result, Status};
use crate::mesh::reference::ReferenceMesh;
use crate::mesh::{ReferenceSurface, TriangleMesh};
use cover::{Counter, Cover, cover};

/// How strips are judged.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportOptions {
    /// Samples in each span along a strip, at least 1; 4 by default.
    pub samples_along: usize,
    /// Samples across a strip, its boundaries included, at least 2; 5 by default.
    pub samples_across: usize,
    /// Which strips meet: the second boundary of the first of a pair, the first boundary of the other. By default each strip meets
    /// the next ([`consecutive`]).
    pub joints: Option<Vec<[usize; 2]>>,
    /// The size of the reference's features at each point of its mesh, in model units, above 0: the least radius of curvature. By
    /// default [`feature_sizes`].
    pub feature_sizes: Option<Vec<f64>>,
    /// A strip is too wide where its width is above this multiple of the feature size, above 0; 0.5 by default. A strip of width
    /// `w` on a surface of radius `r` can be off by about `w² / 8r`, which then is 3 % of `r`.
    pub feature_ratio: f64,
    /// How strips are trimmed.
    pub trim: TrimOptions,
}

impl Default for ReportOptions {
    fn default() -> Self {
        Self {
            samples_along: 4,
            samples_across: 5,
            joints: None,
            feature_sizes: None,
            feature_ratio: 0.5,
            trim: TrimOptions::default(),
        }
    }
}

/// Widths of a strip: across its middle line, in model units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Widths {
    /// The least.
    pub min: f64,
    /// The mean over the length of the middle line.
    pub mean: f64,
    /// The greatest.
    pub max: f64,
    /// The standard deviation over the mean: 0 for a strip of constant width.
    pub variation: f64,
}

/// What there is to say of one strip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StripReport {
    /// How far the strip is from the reference.
    pub deviation: Deviation,
    /// The area of the whole strip, in square model units.
    pub area: f64,
    /// The area of what is left when it is trimmed.
    pub trimmed_area: f64,
    /// Its widths at the rulings of which something is left.
    pub widths: Widths,
    /// The greatest width over the size of the reference's features there,
    pub width_over_feature: f64,
    /// and that size, in model units ([`feature_sizes`]); 0 if nothing of the strip is left.
    pub feature_size: f64,
    /// Whether that is above [`ReportOptions::feature_ratio`]: the strip then cannot follow the reference (Flöry et al. 2012,
    /// figure 11).
    pub is_too_wide: bool,
}

/// What there is to say of strips.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Each strip.
    pub strips: Vec<StripReport>,
    /// Each pair of strips that meet.
    pub joints: Vec<JointReport>,
    /// How far the strips are from the reference, all together.
    pub strips_to_reference: Deviation,
    /// How far the points of the reference are from the nearest strip.
    pub reference_to_strips: Deviation,
    /// The area of the reference.
    pub reference_area: f64,
    /// The area of all trimmed strips.
    pub trimmed_area: f64,
    /// The part of the reference that some strip covers, from 0 to 1: measured on its triangles, each of its spots counted once. To
    /// about 1e-3.
    pub coverage: f64,
    /// The part of the reference that strips cover again: once for each strip but the first.
    pub overlap: f64,
    /// The greatest gap of all joints.
    pub max_gap: f64,
    /// The mean gap of all samples.
    pub mean_gap: f64,
    /// The greatest kink of all joints, in degrees.
    pub max_kink_deg: f64,
    /// The mean kink of all samples, in degrees.
    pub mean_kink_deg: f64,
    /// The standard deviation of all widths over their mean.
    pub width_variation: f64,
    /// The strips that are too wide for the features of the reference.
    pub too_wide: Vec<usize>,
}

/// Judges strips against a reference: `mesh` has its boundary, its area and points to be covered; distances are from `surface`,
/// which may be the mesh again or the surface that it is a mesh of.
///
/// # Errors
/// No strip (`strips`), an option out of range (`options.…`), a joint of strips that do not exist (`options.joints[k][side]`), not
/// one feature size for each point (`options.feature_sizes`), or a strip whose control points are all one (`strips[i]`).
pub fn report(
    strips: &[Strip],
    mesh: &ReferenceMesh<'_>,
    surface: &dyn ReferenceSurface,
    options: &ReportOptions,
) -> Result<Report> {
    check(strips, mesh.mesh(), options)?;
    let joints = options.joints.clone().unwrap_or_else(|| consecutive(strips.len(), false));
    let features = options.feature_sizes.clone().unwrap_or_else(|| feature_sizes(mesh.mesh()));
    let trimmed = trim(strips, mesh, &options.trim)?;
    let inside = Inside { mesh, tolerance: options.trim.tolerance * mesh.diagonal() };
    let sums: Vec<StripSums> = strips
        .par_iter()
        .zip(&trimmed)
        .map(|(strip, trimmed)| StripSums::new(strip, trimmed, &inside, surface, &features, options))
        .collect();
    let joints: Vec<(JointReport, [f64; 2])> = joints
        .par_iter()
        .map(|&joint| joints::joint(strips, joint, &inside, options.samples_along))
        .collect::<Result<_>>()?;
    let nearest = nearest_strip(strips)?;
    let counter = Counter { nearest: &nearest, tolerance: inside.tolerance, diagonal: mesh.diagonal() };
    let triangle_mesh = mesh.mesh();
    let (distances, counts): (Vec<(DVec3, f64, f64)>, Vec<u32>) = (0..triangle_mesh.points().len())
        .into_par_iter()
        .map(|i| {
            let point = triangle_mesh.points()[i];
            let area: f64 = triangle_mesh.fan(i).iter().map(|&t| triangle_mesh.area(t as usize)).sum();
            let (distance, count) = counter.at(point);
            ((point, distance, area / 3.0), count)
        })
        .unzip();
    let covered = cover(triangle_mesh, &counter, &counts);
    Ok(summed_up(strips, &trimmed, sums, joints, &distances, (triangle_mesh.total_area(), covered), options))
}

/// How far points are from the nearest of some strips, in model units.
///
/// # Errors
/// No strip, or one whose points are not finite (`strips`).
pub fn distances(points: &[DVec3], strips: &[Strip]) -> Result<Vec<f64>> {
    let nearest = nearest_strip(strips)?;
    Ok(points.par_iter().map(|&point| nearest.nearest(point).point.distance(point)).collect())
}

fn nearest_strip(strips: &[Strip]) -> Result<NearestStrip<'_>> {
    let unknown = || Error::new(Status::InvalidValue, "expected strips whose points are finite, found others or none");
    NearestStrip::new(strips).ok_or_else(|| unknown().at("strips"))
}

fn summed_up(
    strips: &[Strip],
    trimmed: &[Trimmed],
    sums: Vec<StripSums>,
    joints: Vec<(JointReport, [f64; 2])>,
    distances: &[(DVec3, f64, f64)],
    (reference_area, cover): (f64, Cover),
    options: &ReportOptions,
) -> Report {
    let strip_report = |(sums, (strip, trimmed)): (&StripSums, (&Strip, &Trimmed))| StripReport {
        deviation: Deviation::of(&sums.distances),
        area: strip.area(),
        trimmed_area: trimmed.area(),
        widths: widths(&sums.widths),
        width_over_feature: sums.width_over_feature,
        feature_size: sums.feature_size,
        is_too_wide: sums.width_over_feature > options.feature_ratio,
    };
    let strip_reports: Vec<StripReport> = sums.iter().zip(strips.iter().zip(trimmed)).map(strip_report).collect();
    let all = |part: fn(&StripSums) -> &Vec<(DVec3, f64, f64)>| sums.iter().flat_map(part).copied().collect::<Vec<_>>();
    let trimmed_area: f64 = trimmed.iter().map(Trimmed::area).sum();
    let greatest = |value: fn(&JointReport) -> f64| joints.iter().map(|(joint, _)| value(joint)).fold(0.0, f64::max);
    let mean = |value: usize, count: fn(&JointReport) -> usize| {
        let count: usize = joints.iter().map(|(joint, _)| count(joint)).sum();
        joints.iter().map(|(_, sums)| sums[value]).sum::<f64>() / count.max(1) as f64
    };
    let all_widths: Vec<(f64, f64)> = sums.iter().flat_map(|sums| sums.widths.iter().copied()).collect();
    Report {
        strips_to_reference: Deviation::of(&all(|sums| &sums.distances)),
        reference_to_strips: Deviation::of(distances),
        reference_area,
        trimmed_area,
        coverage: (cover.covered / reference_area).min(1.0),
        overlap: cover.overlap / reference_area,
        max_gap: greatest(|joint| joint.max_gap),
        mean_gap: mean(0, |joint| joint.gap_count),
        max_kink_deg: greatest(|joint| joint.max_kink_deg),
        mean_kink_deg: mean(1, |joint| joint.kink_count),
        width_variation: widths(&all_widths).variation,
        too_wide: (0..strips.len()).filter(|&i| strip_reports[i].is_too_wide).collect(),
        strips: strip_reports,
        joints: joints.into_iter().map(|(joint, _)| joint).collect(),
    }
}

fn check(strips: &[Strip], mesh: &TriangleMesh, options: &ReportOptions) -> Result<()> {
    let refuse = |place: &str, reason: String| Err(Error::new(Status::InvalidValue, reason).at(place));
    if strips.is_empty() {
        return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("strips"));
    }
    options.trim.check().map_err(|error| error.clone().with_place(error.place().replace("options", "options.trim")))?;
    if !(1..=1000).contains(&options.samples_along) {
        return refuse("options.samples_along", format!("expected 1 to 1000, found {}", options.samples_along));
    }
    if !(2..=1000).contains(&options.samples_across) {
        return refuse("options.samples_across", format!("expected 2 to 1000, found {}", options.samples_across));
    }
    if !(options.feature_ratio > 0.0 && options.feature_ratio.is_finite()) {
        return refuse("options.feature_ratio", format!("expected a number above 0, found {}", options.feature_ratio));
    }
    for (k, joint) in options.joints.iter().flatten().enumerate() {
        if let Some(side) = (0..2).find(|&side| joint[side] >= strips.len()) {
            let reason = format!("{} is out of range for {} strips", joint[side], strips.len());
            return Err(Error::new(Status::IndexOutOfRange, reason).at(format!("options.joints[{k}][{side}]")));
        }
    }
    if let Some(sizes) = &options.feature_sizes {
        let count = mesh.points().len();
        if sizes.len() != count {
            let reason = format!("expected one for each of {count} points, found {}", sizes.len());
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("options.feature_sizes"));
        }
        if let Some(i) = sizes.iter().position(|size| !(*size > 0.0)) {
            let reason = format!("expected a number above 0, found {}", sizes[i]);
            return refuse(&format!("options.feature_sizes[{i}]"), reason);
        }
    }
    Ok(())
}

/// The part of space that is beside the reference, not beyond its boundary.
struct Inside<'a> {
    mesh: &'a ReferenceMesh<'a>,
    tolerance: f64,
}

impl Inside<'_> {
    fn has(&self, point: DVec3) -> bool {
        self.mesh.nearest(point).overhang <= self.tolerance
    }
}

/// What is measured of a strip.
struct StripSums {
    /// A point, its distance, the area that it stands for.
    distances: Vec<(DVec3, f64, f64)>,
    /// A width, the length of middle line that it stands for.
    widths: Vec<(f64, f64)>,
    width_over_feature: f64,
    feature_size: f64,
}

impl StripSums {
    fn new(
        strip: &Strip,
        trimmed: &Trimmed,
        inside: &Inside<'_>,
        surface: &dyn ReferenceSurface,
        features: &[f64],
        options: &ReportOptions,
    ) -> Self {
        let (columns, rows) = (options.samples_along * strip.basis().spans(), options.samples_across - 1);
        // The trapezoid rule: half as much at the ends.
        let weight = |i: usize, last: usize| if i == 0 || i == last { 0.5 } else { 1.0 } / last as f64;
        let mut sums = Self { distances: Vec::new(), widths: Vec::new(), width_over_feature: 0.0, feature_size: 0.0 };
        for i in 0..=columns {
            let u = strip.length_u() * i as f64 / columns as f64;
            let along = strip.length_u() * weight(i, columns);
            for j in 0..=rows {
                let jet = strip.at(u, j as f64 / rows as f64);
                if inside.has(jet.point) {
                    let area = along * weight(j, rows) * jet.first[0].cross(jet.first[1]).length();
                    sums.distances.push((jet.point, surface.nearest(jet.point).point.distance(jet.point), area));
                }
            }
            let parts = trimmed.ruling_parts(u);
            let Some(longest) = parts.iter().max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0]))) else { continue };
            // Area over length of the middle line, both per step of u.
            let middle = strip.at(u, 0.5);
            let speed = middle.first[0].length();
            let width = middle.first[0].cross(middle.first[1]).length() / speed;
            if !width.is_finite() {
                continue;
            }
            sums.widths.push((width, along * speed));
            let at = inside.mesh.locate(strip.at(u, 0.5 * (longest[0] + longest[1])).point);
            let corners = inside.mesh.mesh().triangles()[at.triangle as usize];
            let feature = corners.iter().map(|&i| features[i as usize]).fold(f64::INFINITY, f64::min);
            if width / feature > sums.width_over_feature {
                (sums.width_over_feature, sums.feature_size) = (width / feature, feature);
            }
        }
        sums
    }
}

fn widths(widths: &[(f64, f64)]) -> Widths {
    let length: f64 = widths.iter().map(|(_, length)| length).sum();
    if !(length > 0.0) {
        return Widths::default();
    }
    let mean = widths.iter().map(|(width, length)| width * length).sum::<f64>() / length;
    let variance = widths.iter().map(|(width, length)| length * (width - mean).powi(2)).sum::<f64>() / length;
    let all = || widths.iter().map(|(width, _)| *width);
    let variation = if mean > 0.0 { variance.sqrt() / mean } else { 0.0 };
    Widths { min: all().fold(f64::INFINITY, f64::min), mean, max: all().fold(0.0, f64::max), variation }
}

#[cfg(test)]
mod tests;
