//! Planks of conoidal strips (Flöry et al. 2012, figures 1, 13 and 14).
//!
//! The rulings of a *conoidal* strip are parallel to a plane; let `w` be the unit vector at right angles to it, the *axis*. Then
//! `w·x` is constant along each ruling, and the strip can be built from planks of constant thickness stacked along `w`, each a
//! prism over a flat outline: plank `k` has the rulings between the planes `w·x = c_k` and `w·x = c_k + thickness`.
//!
//! A strip is conoidal if and only if all `b_i1 − b_i0` are at right angles to `w`: its rulings are means of these, and the
//! functions of the basis are independent. So control points tell it exactly.
//!
//! The paper only shows planks. We decide: an outline is that of a board, the least quadrilateral with two parallel long sides along
//! the mean ruling and two straight cuts along the strip's boundaries that has all rulings of the slab, seen along `w`, within it;
//! its long sides are moved out by a given depth, which leaves material before and behind the rulings. A cut that would be more
//! than 75 degrees off square is made square.

mod outline;
pub mod sheet;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{Axis, Strip};
use crate::error::{Error, Result, Status};
use crate::mesh::curve::Curve;
use outline::outline;

/// Rulings that turn by less than this, in radians, leave the axis open.
const PARALLEL: f64 = 1e-6;

/// Where `w·x` rises by less than this part of its mean rise, planes do not meet the strip in one ruling each.
const NO_RISE: f64 = 1e-9;

/// Planks of a strip at most.
const MOST_PLANKS: f64 = 1e5;

/// The first cut is so many planks from the strip at most: farther ones have lost digits.
const FARTHEST_CUT: f64 = 1e6;

/// A slab thinner than this part of a plank is rounding.
const NO_SLAB: f64 = 1e-9;

/// The axis of a strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripAxis {
    /// The unit vector that is most nearly at right angles to all rulings, so that the strip rises along it from its first ruling
    /// to its last.
    pub direction: DVec3,
    /// The greatest angle between a control ruling and the plane across the axis, in degrees: 0 of a conoidal strip.
    pub deviation_deg: f64,
}

/// The axis of a strip: the direction along which the squares of its control rulings, as unit vectors, are least.
///
/// # Errors
/// Status `Degenerate`: all rulings are parallel, or have no length; the place is `strip`.
pub fn axis(strip: &Strip) -> Result<StripAxis> {
    let degenerate = |reason: &str| Error::new(Status::Degenerate, reason).at("strip");
    let directions: Vec<DVec3> =
        strip.control(0).iter().zip(strip.control(1)).filter_map(|(a, b)| (*b - *a).try_normalize()).collect();
    let found = if directions.len() < 3 { None } else { Axis::new(&directions) };
    let found = found.ok_or_else(|| degenerate("expected at least 3 rulings with a length"))?;
    if found.spread <= PARALLEL {
        return Err(degenerate("expected rulings of several directions, which have one axis, found all parallel"));
    }
    let direction = upward(strip, found.direction.normalize());
    Ok(StripAxis { direction, deviation_deg: deviation_deg(strip, direction).0 })
}

/// The greatest angle between a control ruling and the plane across `axis`, in degrees, and its number.
fn deviation_deg(strip: &Strip, axis: DVec3) -> (f64, usize) {
    let sides = strip.control(0).iter().zip(strip.control(1)).enumerate();
    let angle = |(i, (a, b)): (usize, (&DVec3, &DVec3))| {
        let ruling = *b - *a;
        (ruling.dot(axis).abs().atan2(ruling.reject_from_normalized(axis).length()).to_degrees(), i)
    };
    sides.map(angle).fold((0.0, 0), |most, found| if found.0 > most.0 { found } else { most })
}

fn upward(strip: &Strip, axis: DVec3) -> DVec3 {
    let rise = (strip.at(strip.length_u(), 0.5).point - strip.at(0.0, 0.5).point).dot(axis);
    if rise < 0.0 { -axis } else { axis }
}

/// How a strip is cut into planks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlankOptions {
    /// The thickness of the planks, in model units, above 0.
    pub thickness: f64,
    /// How far the long sides of a plank are beyond the rulings, in model units, at least 0. By default 0.
    pub depth: f64,
    /// The axis; by default that of the strip ([`axis()`]). Its length does not matter, nor which way along it points.
    pub axis: Option<DVec3>,
    /// `w·x` of one of the cuts; by default the first ruling's.
    pub first_cut: Option<f64>,
    /// The angle between rulings and planks that counts as none, in degrees, at least 0: 1e-4 by default, which over a ruling
    /// of 10 m is 0.02 mm.
    pub tolerance_deg: f64,
}

impl PlankOptions {
    /// Planks of this thickness, everything else by default.
    pub fn new(thickness: f64) -> Self {
        Self { thickness, depth: 0.0, axis: None, first_cut: None, tolerance_deg: 1e-4 }
    }

    fn check(&self) -> Result<()> {
        let refuse =
            |name: &str, reason: String| Err(Error::new(Status::InvalidValue, reason).at(format!("options.{name}")));
        if !(self.thickness > 0.0 && self.thickness.is_finite()) {
            return refuse("thickness", format!("expected a number above 0, found {}", self.thickness));
        }
        for (name, value) in [("depth", self.depth), ("tolerance_deg", self.tolerance_deg)] {
            if !(value >= 0.0 && value.is_finite()) {
                return refuse(name, format!("expected a number of at least 0, found {value}"));
            }
        }
        if self.first_cut.is_some_and(|cut| !cut.is_finite()) {
            return refuse("first_cut", "expected a finite number".to_owned());
        }
        match self.axis {
            Some(axis) if axis.try_normalize().is_none() => {
                refuse("axis", format!("expected a vector with a direction, found {axis}"))
            }
            _ => Ok(()),
        }
    }
}

/// A plank: a prism of the planks' thickness over a flat outline. Lengths are in model units.
///
/// Flat coordinates `[x, y]` are of the point `origin + x · along + y · across` of the lower face; the upper face is one thickness
/// further along the axis, which is `along × across`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Plank {
    /// `w·x` of the lower and the upper face.
    pub heights: [f64; 2],
    /// How much of its thickness has rulings: 1, but for the first and the last plank perhaps.
    pub filled: f64,
    /// The parameters `u` of the strip's rulings in the lower face and the upper face, or the strip's first and last.
    pub parameters: [f64; 2],
    /// A point of the lower face.
    pub origin: [f64; 3],
    /// The unit vector along the plank, from the strip's first boundary to its second.
    pub along: [f64; 3],
    /// The unit vector across it.
    pub across: [f64; 3],
    /// The corners of the outline, counterclockwise seen against the axis: first and second along one long side.
    pub outline: [[f64; 2]; 4],
    /// The length of the board that it is cut from.
    pub length: f64,
    /// The width of that board.
    pub width: f64,
    /// The angles between the cuts, at the strip's first and second boundary, and a square one; above 0 the cut runs along the
    /// plank while it runs across.
    pub end_angles_deg: [f64; 2],
    /// The part of the board that is cut off.
    pub offcut: f64,
    /// The rulings at both `parameters`, each from the first boundary to the second: their ends are where dowels go through
    /// neighbouring planks along the strip's boundaries.
    pub rulings: [[[f64; 2]; 2]; 2],
}

impl Plank {
    /// The corners of the lower and the upper face in space.
    pub fn corners(&self) -> [[DVec3; 4]; 2] {
        let [along, across] = [self.along, self.across].map(DVec3::from_array);
        let up = (self.heights[1] - self.heights[0]) * along.cross(across);
        let lower = self.outline.map(|[x, y]| DVec3::from_array(self.origin) + x * along + y * across);
        [lower, lower.map(|corner| corner + up)]
    }
}

/// A strip as planks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Planks {
    /// The axis `w`, a unit vector.
    pub axis: [f64; 3],
    /// The thickness of all planks.
    pub thickness: f64,
    /// The greatest angle between a control ruling and the planks, in degrees.
    pub deviation_deg: f64,
    /// The planks along the axis.
    pub planks: Vec<Plank>,
    /// The points of the strip's first and second boundary at the cuts, ends included: dowels lie along these.
    pub dowels: [Vec<[f64; 3]>; 2],
    /// The area of all boards.
    pub stock_area: f64,
    /// The part of it that is cut off.
    pub offcut: f64,
}

/// Cuts a conoidal strip into planks.
///
/// # Errors
/// An option out of range (`options.…`), or a thickness of which more than 100 000 planks would be needed. Status `NotPlanar`: a
/// ruling is not parallel to the planes across the axis within the tolerance; the place is `strip`, and the reason says by how
/// much. Status `Degenerate` (`strip`): the axis is not determined ([`axis()`]), or the strip folds back along the axis, so that
/// planes across it meet the strip in several rulings.
pub fn planks(strip: &Strip, options: &PlankOptions) -> Result<Planks> {
    options.check()?;
    let axis = match options.axis {
        Some(given) => upward(strip, given.normalize()),
        None => axis(strip)?.direction,
    };
    let (deviation_deg, worst) = deviation_deg(strip, axis);
    if deviation_deg > options.tolerance_deg {
        let reason = format!(
            "expected rulings parallel to a plane, within {} degrees, found the one of control points {worst} at {deviation_deg} \
             degrees to it",
            options.tolerance_deg
        );
        return Err(Error::new(Status::NotPlanar, reason).at("strip"));
    }
    check_rise(strip, axis)?;
    let height = |u: f64| strip.at(u, 0.5).point.dot(axis);
    let (low, high) = (height(0.0), height(strip.length_u()));
    let thickness = options.thickness;
    if (high - low) / thickness > MOST_PLANKS {
        let reason =
            format!("expected at least a {MOST_PLANKS}th of the strip's height {}, found {thickness}", high - low);
        return Err(Error::new(Status::InvalidValue, reason).at("options.thickness"));
    }
    let first_cut = options.first_cut.unwrap_or(low);
    if (low - first_cut).abs() / thickness > FARTHEST_CUT {
        let reason = format!("expected a cut within {FARTHEST_CUT} planks of the strip at {low}, found {first_cut}");
        return Err(Error::new(Status::InvalidValue, reason).at("options.first_cut"));
    }
    // Rounding must not leave a plank of no thickness before the first.
    let first = ((low - first_cut) / thickness + NO_SLAB).floor();
    let cut = |k: usize| first_cut + (first + k as f64) * thickness;
    let count = (0..).take_while(|&k| cut(k) < high - NO_SLAB * thickness).count();
    let mut parameters = vec![0.0];
    parameters.extend((1..count).map(|k| at_height(strip, &height, cut(k))));
    parameters.push(strip.length_u());
    let plank = |k: usize| {
        let filled = (cut(k + 1).min(high) - cut(k).max(low)) / thickness;
        outline(strip, axis, [cut(k), cut(k + 1)], filled, [parameters[k], parameters[k + 1]], options.depth)
    };
    let planks: Vec<Plank> = (0..count).map(plank).collect();
    let dowel = |side: usize| parameters.iter().map(|&u| strip.boundary(side).point(u).to_array()).collect();
    let stock_area: f64 = planks.iter().map(|plank| plank.length * plank.width).sum();
    let cut_off: f64 = planks.iter().map(|plank| plank.length * plank.width * plank.offcut).sum();
    Ok(Planks {
        axis: axis.to_array(),
        thickness,
        deviation_deg,
        planks,
        dowels: [dowel(0), dowel(1)],
        stock_area,
        offcut: if stock_area > 0.0 { cut_off / stock_area } else { 0.0 },
    })
}

/// Refuses a strip that does not rise along the axis throughout. In each span `w·S_u` is quadratic in `u`: three values tell its
/// least one.
fn check_rise(strip: &Strip, axis: DVec3) -> Result<()> {
    let slope = |u: f64| strip.at(u, 0.5).first[0].dot(axis);
    let spans = strip.basis().spans();
    let rise = (strip.at(strip.length_u(), 0.5).point - strip.at(0.0, 0.5).point).dot(axis);
    for span in 0..spans {
        let start = span as f64;
        let mut at = vec![0.0, 1.0];
        // The extreme of the quadratic c + b t + a t².
        let (a, b, _) = outline::quadratic([0.0, 0.5, 1.0].map(|t| slope(start + t)));
        at.extend(Some(-0.5 * b / a).filter(|t| (0.0..=1.0).contains(t)));
        if let Some(t) = at.into_iter().find(|t| !(slope(start + t) > NO_RISE * rise / spans as f64)) {
            let reason = format!(
                "expected a strip that rises along the axis throughout, found one that is folded: it does not rise at u = {}",
                start + t
            );
            return Err(Error::new(Status::Degenerate, reason).at("strip"));
        }
    }
    Ok(())
}

/// The parameter of the ruling at a height, by bisection.
fn at_height(strip: &Strip, height: &dyn Fn(f64) -> f64, wanted: f64) -> f64 {
    let (mut low, mut high) = (0.0, strip.length_u());
    while high - low > f64::EPSILON * strip.length_u() {
        let middle = 0.5 * (low + high);
        if height(middle) < wanted { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests;
