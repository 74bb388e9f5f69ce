//! Strip boundaries as level curves, or as drawn.

use glam::DVec3;

use super::Field;
use super::boundary::Boundary;
use super::matching::Matching;
use super::rim::Rim;
use crate::error::{Error, Result, Status, finite};
use crate::mesh::grid::check_finite;
use crate::mesh::level_curves::{LevelCurve, level_curves};
use crate::mesh::operators::gradient_on;
use crate::mesh::reference::ReferenceMesh;
use crate::mesh::{SurfacePoint, TriangleMesh};

/// Boundaries at most.
const MOST_LEVELS: usize = 100_000;

/// Which levels are boundaries.
#[derive(Clone, Debug, PartialEq)]
pub enum Levels {
    /// So many, evenly spaced between the least and the greatest value, half a spacing from each.
    Count(usize),
    /// These, ascending.
    Values(Vec<f64>),
    /// As many as fit at this distance, in model units where the gradient is 1 long, centred between the least and the greatest
    /// value.
    Width(f64),
}

impl Levels {
    /// The levels between a least and a greatest value, and the distance between two of them (0 for a single given value).
    pub(super) fn between(&self, [low, high]: [f64; 2]) -> Result<(Vec<f64>, f64)> {
        let count_checked = |count: usize| match count {
            1..=MOST_LEVELS => Ok(count),
            _ => {
                let reason = format!("expected 1 to {MOST_LEVELS} levels, found {count}");
                Err(Error::new(Status::InvalidArgumentLength, reason).at("levels"))
            }
        };
        match self {
            Self::Count(count) => {
                let spacing = (high - low) / count_checked(*count)? as f64;
                Ok(((0..*count).map(|k| low + (k as f64 + 0.5) * spacing).collect(), spacing))
            }
            Self::Width(width) => {
                if !(*width > 0.0 && finite("levels", *width).is_ok()) {
                    let reason = format!("expected a width above 0, found {width}");
                    return Err(Error::new(Status::InvalidValue, reason).at("levels"));
                }
                let count = count_checked(((high - low) / width).round().clamp(1.0, 1e9) as usize)?;
                let first = 0.5 * (low + high) - 0.5 * (count - 1) as f64 * width;
                Ok(((0..count).map(|k| first + k as f64 * width).collect(), *width))
            }
            Self::Values(values) => {
                count_checked(values.len())?;
                for (k, &value) in values.iter().enumerate() {
                    let place = format!("levels[{k}]");
                    finite(&place, value)?;
                    if k > 0 && value <= values[k - 1] {
                        let reason = format!("expected levels that ascend, found {value} after {}", values[k - 1]);
                        return Err(Error::new(Status::InvalidValue, reason).at(place));
                    }
                    if !(value > low && value <= high) {
                        let reason = format!("expected a level above {low} and up to {high}, found {value}");
                        return Err(Error::new(Status::OutOfDomain, reason).at(place));
                    }
                }
                let spacing = values.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
                Ok((values.clone(), if spacing.is_finite() { spacing } else { 0.0 }))
            }
        }
    }
}

/// What is done to boundaries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryOptions {
    /// Whether open ends are extended beyond the surface, so that strips cover it up to the rim.
    pub extends: bool,
    /// Whether there is a boundary beyond the surface before the first and after the last.
    pub overshoots: bool,
    /// Curves shorter than so many strip widths, 0 or more, are dropped, unless that leaves none.
    pub least_length: f64,
}

impl Default for BoundaryOptions {
    fn default() -> Self {
        Self { extends: true, overshoots: true, least_length: 2.0 }
    }
}

impl BoundaryOptions {
    pub(super) fn check(&self) -> Result<()> {
        if self.least_length >= 0.0 && self.least_length.is_finite() {
            return Ok(());
        }
        let reason = format!("expected a finite number of 0 or more, found {}", self.least_length);
        Err(Error::new(Status::InvalidValue, reason).at("options.least_length"))
    }
}

/// A curve that was left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dropped {
    /// Its level, or the number of its plane.
    pub level: f64,
    /// How many points it has,
    pub point_count: usize,
    /// and how long it is.
    pub length: f64,
}

/// Strip boundaries.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boundaries {
    /// The boundaries, along the field; where levels consist of several curves, those that follow each other stand together.
    pub boundaries: Vec<Boundary>,
    /// The strips, each as the numbers of its two boundaries.
    pub strips: Vec<[usize; 2]>,
    /// Curves too short to be boundaries.
    pub dropped: Vec<Dropped>,
    /// Levels between which and the next one curves split, join or end, so that no strip is there.
    pub unmatched: Vec<f64>,
    /// Pairs of boundaries of which a part of one is the other: where a level leaves the surface in its middle, a strip ends at a
    /// boundary that joins the curves of the next level beyond the surface, and other strips begin at these curves. First of a pair
    /// is the one that a strip ends at.
    pub meets: Vec<[usize; 2]>,
}

impl Boundaries {
    /// Refuses boundaries between which strips are missing.
    ///
    /// # Errors
    /// Status `NoSolution`: between two levels curves split or join. The reason names the level.
    pub fn check(&self) -> Result<()> {
        match self.unmatched.first() {
            None => Ok(()),
            Some(level) => {
                let reason = format!("curves split or join between level {level} and the next: no strip fits between");
                Err(Error::new(Status::NoSolution, reason).at("levels"))
            }
        }
    }
}

/// The level curves of a function with these values at the points as strip boundaries.
///
/// Curves of fewer than 3 points or too short are dropped, and listed. If several curves have a level, each is followed by that of
/// the next level to which the field leads, if each of both has one such. Where one curve leads to several with the rim between them,
/// or several to one, these are joined beyond the rim ([`Boundaries::meets`]); otherwise the level is listed as unmatched.
///
/// # Errors
/// Not one value for each point or one that is not finite (`values`, `values[i]`); a field of another mesh (`field`); levels or options out of range (`levels`,
/// `levels[k]`, `options.least_length`). Status `OutOfDomain`: a level beyond the values, or whose curves are points (`levels[k]`),
/// or no curve is long enough (`levels`).
pub fn level_boundaries(
    mesh: &TriangleMesh,
    field: &Field,
    values: &[f64],
    levels: &Levels,
    options: &BoundaryOptions,
) -> Result<Boundaries> {
    options.check()?;
    field.check(mesh)?;
    level_curves(mesh, values, 0.0)?;
    let range = [
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ];
    let (levels, spacing) = levels.between(range)?;
    let rim = Rim::new(mesh, field)?;
    let mut found: Vec<Vec<(Boundary, f64)>> = Vec::new();
    for (k, &level) in levels.iter().enumerate() {
        let curves = level_curves(mesh, values, level)?;
        if curves.iter().all(|curve| curve.length() == 0.0) {
            let reason = format!("expected a level with curves, found {level}");
            return Err(Error::new(Status::OutOfDomain, reason).at(format!("levels[{k}]")));
        }
        let width = |curve: &LevelCurve| {
            let slopes = curve.points.iter().map(|p| gradient_on(mesh, values, p.at.triangle as usize).length());
            spacing * curve.points.len() as f64 / slopes.sum::<f64>().max(f64::MIN_POSITIVE)
        };
        let with_least = |curve: LevelCurve| {
            let least = options.least_length * width(&curve);
            (of_curve(curve, level, rim.mean_edge()), least)
        };
        found.push(curves.into_iter().map(with_least).collect());
    }
    let (groups, dropped) = sorted_out(found);
    if groups.is_empty() {
        let reason = "expected a level with a curve of 3 points, found none";
        return Err(Error::new(Status::OutOfDomain, reason).at("levels"));
    }
    let value = |at: SurfacePoint| {
        let corners = mesh.triangles()[at.triangle as usize];
        (0..3).map(|k| at.weights[k] * values[corners[k] as usize]).sum::<f64>()
    };
    Ok(Boundaries { dropped, ..Matching::new(&rim, groups, &value).chained(options) })
}

/// The curves of each level that has any, without those of fewer than 3 points or below the length that stands beside each, and what
/// was dropped. If all are that short, as where few levels are asked for, length does not count.
fn sorted_out(found: Vec<Vec<(Boundary, f64)>>) -> (Vec<Vec<Boundary>>, Vec<Dropped>) {
    let is_long = |(boundary, least): &(Boundary, f64)| boundary.points.len() >= 3 && boundary.length() >= *least;
    let is_any_long = found.iter().flatten().any(is_long);
    let (mut groups, mut dropped) = (Vec::new(), Vec::new());
    for curves in found {
        let is_kept = |curve: &(Boundary, f64)| is_long(curve) || (!is_any_long && curve.0.points.len() >= 3);
        let (kept, short): (Vec<_>, Vec<_>) = curves.into_iter().partition(is_kept);
        let drop =
            |(b, _): &(Boundary, f64)| Dropped { level: b.level, point_count: b.points.len(), length: b.length() };
        dropped.extend(short.iter().map(drop));
        groups.extend((!kept.is_empty()).then(|| kept.into_iter().map(|(boundary, _)| boundary).collect()));
    }
    (groups, dropped)
}

/// The points of a level curve, without those that are hardly apart.
pub(super) fn of_curve(curve: LevelCurve, level: f64, mean_edge: f64) -> Boundary {
    let (points, at) = curve.points.iter().map(|point| (point.position, Some(point.at))).unzip();
    let mut boundary = Boundary { points, on_surface: at, is_closed: curve.is_closed, level };
    boundary.merge(mean_edge);
    boundary
}

/// The longest of some curves, the first of several; the others are added to those dropped. None without one of two points.
pub(super) fn longest(
    curves: Vec<LevelCurve>,
    number: usize,
    mean_edge: f64,
    dropped: &mut Vec<Dropped>,
) -> Option<Boundary> {
    let mut boundaries: Vec<Boundary> =
        curves.into_iter().map(|curve| of_curve(curve, number as f64, mean_edge)).collect();
    let length = |i: &usize| boundaries[*i].length();
    let longest = (0..boundaries.len()).rev().max_by(|a, b| length(a).total_cmp(&length(b)));
    let found = boundaries.remove(longest.filter(|&i| boundaries[i].points.len() > 1)?);
    let drop = |b: &Boundary| Dropped { level: b.level, point_count: b.points.len(), length: b.length() };
    dropped.extend(boundaries.iter().map(drop));
    Some(found)
}

/// Boundaries given along the field or against it, along it; otherwise the number (`level`) of the first that is out of order.
pub(super) fn ordered(rim: &Rim<'_>, mut chain: Vec<Boundary>) -> std::result::Result<Vec<Boundary>, usize> {
    let is_against = chain.len() > 1 && !rim.is_ahead(&chain[1], &chain[0]);
    if is_against {
        chain.reverse();
    }
    match (1..chain.len()).find(|&i| !rim.is_ahead(&chain[i], &chain[i - 1])) {
        Some(i) => Err(chain[if is_against { i - 1 } else { i }].level as usize),
        None => Ok(chain),
    }
}

/// Curves drawn by hand as strip boundaries, in the order along the field.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The points, near the surface.
    pub points: Vec<DVec3>,
    /// Whether the last point is followed by the first.
    pub is_closed: bool,
}

/// Strip boundaries along curves that were drawn: their points are moved to the nearest of the surface, and they are turned around
/// if need be, so that the field leads to their left. Those that end on the rim are extended; there is no other beyond the surface,
/// since where a curve ends was decided by who drew it.
///
/// # Errors
/// No curve (`curves`); a field of another mesh (`field`); fewer than 2 points, or 3 of a closed one, points that are not finite, coincide with the one before, or
/// whose nearest ones do (`curves[k]`, `curves[k].points[i]`). Status `Infeasible`: the field is not known along a curve or crosses
/// it from both sides (`curves[k]`), or a curve is behind the one before it (`curves[k]`).
pub fn drawn_boundaries(
    surface: &ReferenceMesh<'_>,
    field: &Field,
    curves: &[Drawn],
    options: &BoundaryOptions,
) -> Result<Boundaries> {
    options.check()?;
    if curves.is_empty() {
        return Err(Error::new(Status::InvalidArgumentLength, "expected at least 1, found none").at("curves"));
    }
    let mesh = surface.mesh();
    field.check(mesh)?;
    let rim = Rim::new(mesh, field)?;
    let mut chain: Vec<Boundary> = Vec::with_capacity(curves.len());
    for (k, curve) in curves.iter().enumerate() {
        let boundary = drawn(surface, &rim, curve, k).map_err(|error| error.at(format!("curves[{k}]")))?;
        if chain.last().is_some_and(|last| !rim.is_ahead(&boundary, last)) {
            let reason = "expected a curve ahead of the one before, along the field";
            return Err(Error::new(Status::Infeasible, reason).at(format!("curves[{k}]")));
        }
        chain.push(boundary);
    }
    let boundaries = rim.complete(chain, false, options.extends, [false; 2]);
    let strips = (1..boundaries.len()).map(|k| [k - 1, k]).collect();
    Ok(Boundaries { boundaries, strips, ..Boundaries::default() })
}

fn drawn(surface: &ReferenceMesh<'_>, rim: &Rim<'_>, curve: &Drawn, k: usize) -> Result<Boundary> {
    let (count, least) = (curve.points.len(), if curve.is_closed { 3 } else { 2 });
    if count < least {
        let reason = format!("expected at least {least} points, found {count}");
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("points"));
    }
    check_finite("points", &curve.points)?;
    let on_surface: Vec<SurfacePoint> = curve.points.iter().map(|&point| surface.locate(point)).collect();
    let points: Vec<DVec3> = on_surface.iter().map(|&at| surface.mesh().position(at)).collect();
    if let Some(i) = (1..count).find(|&i| points[i] == points[i - 1]) {
        let reason = "expected a point apart from the one before, also on the surface";
        return Err(Error::new(Status::Degenerate, reason).at(format!("points[{i}]")));
    }
    let on_surface = on_surface.into_iter().map(Some).collect();
    let mut boundary = Boundary { points, on_surface, is_closed: curve.is_closed, level: k as f64 };
    if !rim.turn(&mut boundary).is_some_and(|least| least > 0.0) {
        let reason = "expected a curve that the field crosses from one side";
        return Err(Error::new(Status::Infeasible, reason));
    }
    Ok(boundary)
}
