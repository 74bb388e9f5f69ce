//! Chains of Möbius and Combescure transformations, with exact inverses.
//!
//! A Möbius transformation is a composition of inversions and similarities; here each factor is a link of its own, and the inverse of
//! a chain is the list of the links' inverses in reverse order. Möbius and Combescure transformations do not commute.
//!
//! A Combescure transformation is told by the factor of each edge of column 0 and of row 0 (point `(0, 0)` stays). Its inverse
//! has the reciprocal factors. Told so, it does not depend on how fine the net is: the arc over an edge keeps its tangents, so it is
//! scaled with its chord, and all pieces of a refined edge have the factor of the whole.
//! Source: Mesnil et al. 2018, sections 2.3 to 2.6 and 5.3.

use glam::{DQuat, DVec3};

use super::combescure::{self, Lengths, check_count};
use super::frame::Frame;
use super::inversion::Inversion;
use super::net::Net;
use crate::error::{Error, Result, Status, finite};
use crate::mesh::Grid;
use crate::mesh::grid::check_finite;

/// One link of a chain.
#[derive(Clone, Debug, PartialEq)]
pub enum Transform {
    /// An inversion.
    Inversion(Inversion),
    /// Every point moves by this vector.
    Translation(DVec3),
    /// Every point's position vector is multiplied by this number, which is not 0.
    Scaling(f64),
    /// Every point turns about the origin by this unit quaternion.
    Rotation(DQuat),
    /// The parallel net whose edges along column 0 and row 0 are these multiples, none 0, of what they were.
    Combescure {
        /// Factors along column 0, one per edge from row to row.
        column: Vec<f64>,
        /// Factors along row 0, one per edge from column to column.
        row: Vec<f64>,
    },
}

impl Transform {
    /// Whether it is a Combescure transformation that is no similarity, an inversion, or a similarity.
    pub fn kind(&self) -> Kind {
        match self {
            Self::Inversion(_) => Kind::Moebius,
            Self::Translation(_) | Self::Scaling(_) | Self::Rotation(_) => Kind::Similarity,
            Self::Combescure { .. } => Kind::Combescure,
        }
    }

    /// Refuses numbers for which it has no inverse.
    ///
    /// # Errors
    /// A number that is not finite; a scale or a factor of 0; a rotation that is no unit quaternion.
    pub fn check(&self) -> Result<()> {
        let nonzero = |name: &str, value: f64| {
            if finite(name, value)? == 0.0 {
                return Err(Error::new(Status::InvalidValue, "expected a number other than 0, found 0").at(name));
            }
            Ok(())
        };
        match self {
            Self::Inversion(inversion) => Inversion::new(inversion.center(), inversion.ratio()).map(|_| ()),
            Self::Translation(step) => check_finite("translation", &[*step]),
            Self::Scaling(factor) => nonzero("scale", *factor),
            Self::Rotation(turn) if turn.is_finite() && (turn.length() - 1.0).abs() < 1e-9 => Ok(()),
            Self::Rotation(turn) => {
                let reason = format!("expected a unit quaternion, found {turn}");
                Err(Error::new(Status::InvalidValue, reason).at("rotation"))
            }
            Self::Combescure { column, row } => {
                column.iter().enumerate().try_for_each(|(k, &factor)| nonzero(&format!("column[{k}]"), factor))?;
                row.iter().enumerate().try_for_each(|(k, &factor)| nonzero(&format!("row[{k}]"), factor))
            }
        }
    }

    /// The transformation that undoes this one.
    pub fn inverse(&self) -> Self {
        match self {
            Self::Inversion(_) => self.clone(),
            Self::Translation(step) => Self::Translation(-*step),
            Self::Scaling(factor) => Self::Scaling(1.0 / factor),
            Self::Rotation(turn) => Self::Rotation(turn.conjugate()),
            Self::Combescure { column, row } => {
                let reciprocal = |factors: &[f64]| factors.iter().map(|factor| 1.0 / factor).collect();
                Self::Combescure { column: reciprocal(column), row: reciprocal(row) }
            }
        }
    }

    /// The image of a net, which may be a refinement of the one that the factors of a Combescure transformation were stated for,
    /// `pieces[0]` by `pieces[1]` for each of its faces.
    ///
    /// # Errors
    /// As [`Transform::check`], [`Inversion::points`] and [`combescure::combescure`].
    pub fn apply(&self, net: &Net, pieces: [usize; 2]) -> Result<Net> {
        self.check()?;
        let grid = net.grid();
        let moved = |points: Vec<DVec3>, turn: &dyn Fn(usize, DVec3) -> DVec3| {
            let frame = |(k, frame): (usize, &Frame)| {
                let (t1, t2) = (turn(k, frame.t1), turn(k, frame.t2));
                Frame { t1, t2, normal: t1.cross(t2) }
            };
            let frames = net.frames().iter().enumerate().map(frame).collect();
            Ok(net.with_image(grid.with_points(points)?, frames))
        };
        let points = |image: &dyn Fn(DVec3) -> DVec3| grid.points().iter().map(|&point| image(point)).collect();
        match self {
            Self::Inversion(inversion) => {
                let turn = |k: usize, t: DVec3| inversion.direction(grid.points()[k], t).normalize();
                moved(inversion.points(grid.points())?, &turn)
            }
            Self::Translation(step) => moved(points(&|point| point + *step), &|_, t| t),
            Self::Scaling(factor) => moved(points(&|point| *factor * point), &|_, t| factor.signum() * t),
            Self::Rotation(turn) => moved(points(&|point| *turn * point), &|_, t| *turn * t),
            Self::Combescure { column, row } => {
                let image = scaled_along(grid, column, row, pieces)?;
                Ok(net.with_image(image, net.frames().to_vec()))
            }
        }
    }
}

/// The Combescure transform of a grid by factors of the edges of a coarser one.
fn scaled_along(grid: &Grid, column: &[f64], row: &[f64], pieces: [usize; 2]) -> Result<Grid> {
    let [rows, columns] = grid.spans();
    check_count("column", column, rows / pieces[0])?;
    check_count("row", row, columns / pieces[1])?;
    let spread = |factors: &[f64], pieces: usize| -> Vec<f64> {
        factors.iter().flat_map(|&factor| std::iter::repeat_n(factor, pieces)).collect()
    };
    let lengths = Lengths::of(grid).scaled(&spread(column, pieces[0]), &spread(row, pieces[1]))?;
    Ok(combescure::combescure(grid, &lengths, grid.at(0, 0))?.grid)
}

/// What a transformation keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A similarity keeps the surface's family.
    Similarity,
    /// An inversion keeps circles and angles.
    Moebius,
    /// A Combescure transformation keeps the directions of edges, so planes too.
    Combescure,
}

/// The image of `net` under all links in their order; `pieces` as in [`Transform::apply`].
///
/// # Errors
/// The place is `chain[k]`.
pub fn apply(chain: &[Transform], net: &Net, pieces: [usize; 2]) -> Result<Net> {
    let mut image = net.clone();
    for (k, transform) in chain.iter().enumerate() {
        image = transform.apply(&image, pieces).map_err(|error| error.at(format!("chain[{k}]")))?;
    }
    Ok(image)
}

/// The chain that undoes `chain`: the inverses in reverse order.
pub fn inverse(chain: &[Transform]) -> Vec<Transform> {
    chain.iter().rev().map(Transform::inverse).collect()
}
