//! Side conditions that hold exactly.
//!
//! All are linear in the control points. A boundary with its control points in a plane is in the plane, and no other is: the plane's
//! equation of the boundary is a spline whose coefficients are those of the control points. In the same way all rulings
//! `Σ N_i (b_i1 − b_i0)` are parallel to the plane `w·x = 0` if and only if all `b_i1 − b_i0` are (Flöry et al. 2012, section 2.2).

use glam::DVec3;

use super::Strip;
use super::layout::Layout;
use crate::error::{Error, Result, Status, finite};
use crate::linalg::elimination::{Added, Elimination, Equations};
use crate::linalg::small::any_orthogonal;
use crate::mesh::curve::End;

/// A side condition of a strip. Sides are 0 and 1, the first and the second boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// A boundary lies in the plane `normal · x = offset`; the normal need not be of unit length.
    PlanarBoundary {
        /// Which strip.
        strip: usize,
        /// Which boundary.
        side: usize,
        /// Across the plane.
        normal: DVec3,
        /// The plane's place, in the unit of `normal` times that of the model.
        offset: f64,
    },
    /// An end of a boundary is at a position.
    FixedEnd {
        /// Which strip, an open one.
        strip: usize,
        /// Which boundary.
        side: usize,
        /// Which end.
        end: End,
        /// Where it is.
        position: DVec3,
    },
    /// The ruling at an end is parallel to a direction, or has no length.
    FixedEndRuling {
        /// Which strip, an open one.
        strip: usize,
        /// Which end.
        end: End,
        /// The direction, of any length above 0.
        direction: DVec3,
    },
    /// All rulings are orthogonal to an axis: the strip is a conoid.
    Conoidal {
        /// Which strip.
        strip: usize,
        /// The axis, of any length above 0.
        axis: DVec3,
    },
}

impl Condition {
    /// The conditions that hold all ends of the boundaries of open strips where they are.
    pub fn fixed_ends(strips: &[Strip]) -> Vec<Self> {
        let ends = |(strip, of): (usize, &Strip)| {
            let at = move |(side, end): (usize, End), control: &[DVec3]| {
                let position = if end == End::Start { control[0] } else { control[control.len() - 1] };
                Self::FixedEnd { strip, side, end, position }
            };
            let places = [(0, End::Start), (0, End::Finish), (1, End::Start), (1, End::Finish)];
            if of.basis().is_closed() {
                Vec::new()
            } else {
                places.map(|place| at(place, of.control(place.0))).to_vec()
            }
        };
        strips.iter().enumerate().flat_map(ends).collect()
    }

    /// Whether it is about the same part of the same strip as another, in the same way, so that the two agree or contradict.
    pub(super) fn is_of_the_place_of(&self, other: &Self) -> bool {
        let place = |condition: &Self| match *condition {
            Self::PlanarBoundary { strip, side, .. } => (0, strip, side, None),
            Self::FixedEnd { strip, side, end, .. } => (1, strip, side, Some(end)),
            Self::FixedEndRuling { strip, end, .. } => (2, strip, 0, Some(end)),
            Self::Conoidal { strip, .. } => (3, strip, 0, None),
        };
        place(self) == place(other)
    }

    /// In words.
    fn name(&self) -> String {
        let side = |side: usize| if side == 0 { "first" } else { "second" };
        let at = |end: End| if end == End::Start { "start" } else { "finish" };
        match *self {
            Self::PlanarBoundary { strip, side: s, .. } => {
                format!("the plane of the {} boundary of strip {strip}", side(s))
            }
            Self::FixedEnd { strip, side: s, end, .. } => {
                format!("the fixed {} of the {} boundary of strip {strip}", at(end), side(s))
            }
            Self::FixedEndRuling { strip, end, .. } => {
                format!("the direction of the ruling at the {} of strip {strip}", at(end))
            }
            Self::Conoidal { strip, .. } => format!("the axis of strip {strip}"),
        }
    }

    /// Refuses what is no condition of these strips; the place is the field.
    pub(super) fn check(&self, layout: &Layout) -> Result<()> {
        let wrong = |reason: String| Err(Error::new(Status::InvalidValue, reason).at(self.field()));
        let (strip, side, vector) = match *self {
            Self::PlanarBoundary { strip, side, normal, offset } => {
                finite("offset", offset)?;
                (strip, side, normal)
            }
            Self::FixedEnd { strip, side, position, .. } => {
                if !position.is_finite() {
                    return wrong(format!("expected finite coordinates, found {position}"));
                }
                (strip, side, DVec3::X)
            }
            Self::FixedEndRuling { strip, direction, .. } => (strip, 0, direction),
            Self::Conoidal { strip, axis } => (strip, 0, axis),
        };
        if strip >= layout.strip_count() {
            let reason = format!("{strip} is out of range for {} strips", layout.strip_count());
            return Err(Error::new(Status::IndexOutOfRange, reason).at("strip"));
        }
        if side > 1 {
            return Err(Error::new(Status::IndexOutOfRange, format!("expected 0 or 1, found {side}")).at("side"));
        }
        if !vector.is_finite() || vector.try_normalize().is_none() {
            return wrong(format!("expected a finite vector of a length above 0, found {vector}"));
        }
        let is_end = matches!(self, Self::FixedEnd { .. } | Self::FixedEndRuling { .. });
        if is_end && layout.basis(strip).is_closed() {
            let reason = format!("strip {strip} is closed and has no ends");
            return Err(Error::new(Status::InvalidValue, reason).at("strip"));
        }
        Ok(())
    }

    fn field(&self) -> &'static str {
        match self {
            Self::PlanarBoundary { .. } => "normal",
            Self::FixedEnd { .. } => "position",
            Self::FixedEndRuling { .. } => "direction",
            Self::Conoidal { .. } => "axis",
        }
    }

    /// Its equations `Σ vector · point = right`, each with points and their vectors.
    fn rows(&self, layout: &Layout) -> Vec<(Vec<(usize, DVec3)>, f64)> {
        let place = |strip: usize, end: End| if end == End::Start { 0 } else { layout.basis(strip).count() - 1 };
        let apart = |strip: usize, i: usize, w: DVec3| {
            (vec![(layout.point(strip, 1, i), w), (layout.point(strip, 0, i), -w)], 0.0)
        };
        match *self {
            Self::PlanarBoundary { strip, side, normal, offset } => {
                let (unit, length) = (normal.normalize(), normal.length());
                let row = |i: usize| (vec![(layout.point(strip, side, i), unit)], offset / length);
                (0..layout.basis(strip).count()).map(row).collect()
            }
            Self::FixedEnd { strip, side, end, position } => {
                let point = layout.point(strip, side, place(strip, end));
                DVec3::AXES.map(|axis| (vec![(point, axis)], axis.dot(position))).to_vec()
            }
            Self::FixedEndRuling { strip, end, direction } => {
                let direction = direction.normalize();
                let across = any_orthogonal(direction).normalize();
                [across, direction.cross(across)].map(|w| apart(strip, place(strip, end), w)).to_vec()
            }
            Self::Conoidal { strip, axis } => {
                (0..layout.basis(strip).count()).map(|i| apart(strip, i, axis.normalize())).collect()
            }
        }
    }
}

/// Whether conditions fix all four ends of a strip.
pub(super) fn fixes_all_ends(conditions: &[Condition], strip: usize) -> bool {
    [(0, End::Start), (0, End::Finish), (1, End::Start), (1, End::Finish)].iter().all(|wanted| {
        let is_it = |condition: &Condition| match *condition {
            Condition::FixedEnd { strip: of, side, end, .. } => of == strip && (side, end) == *wanted,
            _ => false,
        };
        conditions.iter().any(is_it)
    })
}

/// The unknowns that conditions leave free; unknown `3 i + k` is coordinate `k` of point `i`.
///
/// # Errors
/// Status `Infeasible`: a condition contradicts those before it; the place is `conditions[k]`. Besides, what is no condition.
pub(super) fn eliminate(layout: &Layout, conditions: &[Condition], size: f64) -> Result<Elimination> {
    let mut equations = Equations::new(3 * layout.point_count(), size);
    for (k, condition) in conditions.iter().enumerate() {
        condition.check(layout).map_err(|error| {
            let place = format!("conditions[{k}].{}", error.place());
            error.with_place(place)
        })?;
        for (row, right) in condition.rows(layout) {
            let terms: Vec<(u32, f64)> =
                row.iter().flat_map(|&(i, w)| [0, 1, 2].map(|axis| ((3 * i + axis) as u32, w[axis]))).collect();
            if equations.add(&terms, right) == Added::Contradicting {
                let reason = format!("{} contradicts the conditions before it", condition.name());
                return Err(Error::new(Status::Infeasible, reason).at(format!("conditions[{k}]")));
            }
        }
    }
    Ok(equations.solve())
}
