//! The constraint types: one file each, and one line each in the registry at the end of this file.
//!
//! A constraint of `k` points has rows `A` (the same scalar coefficients for x, y and z) and a projection `P`. It adds
//! `½ w m ‖A x − P(x)‖²` to the energy, `w` being the user's weight and `m` the type's measure (a rest length, area or
//! volume; 1 for most). A type knows neither weights nor ids nor the solver: those belong to [`ConstraintSet`] and
//! `solver`. All constraints of one type lie in one [`Batch`] of flat arrays, so an iteration makes one dynamic call
//! per chunk of a type and the inner loop is plain code over contiguous data.
//!
//! To add a type: write its file, with one struct that implements [`Constraint`], and add its line to the registry.

mod batch;
mod deformation;
mod four;
#[cfg(test)]
mod laws;
mod lists;
#[cfg(test)]
mod oracle;
mod references;
mod set;
mod shape_fit;
mod stencil;

pub(crate) use batch::{Batch, ProjectPair};
pub use four::Four;
pub use references::{ReferenceId, ReferenceKind, ReferenceShape};
pub use set::{ConstraintId, ConstraintSet, ConstraintView, Edited, NewConstraints};
pub use stencil::Stencil;

use std::sync::Arc;

use crate::error::{Error, Result, Status};
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;
use batch::{Pair, TypedBatch, pair};

/// The rows `A` of a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// `k` rows `x_i − x̄`, `x̄` the mean of the constraint's points. Only named, never stored: the solver assembles them
    /// in O(k). [`Stencil`] then hands out points relative to their mean.
    Centred,
    /// So many rows with coefficients of their own, at most as many as points.
    Linear(usize),
    /// One row `x_{2r+1} − x_{2r}` for each pair of consecutive points: the edges of a list. Only named, never stored.
    Pairs,
}

impl Rows {
    /// The number of rows of a constraint of `k` points.
    pub const fn count(self, k: usize) -> usize {
        match self {
            Self::Centred => k,
            Self::Linear(count) => count,
            Self::Pairs => k / 2,
        }
    }

    /// The number of coefficients that are stored for a constraint of `k` points.
    const fn stored_count(self, k: usize) -> usize {
        match self {
            Self::Linear(count) => count * k,
            Self::Centred | Self::Pairs => 0,
        }
    }

    /// The points `indices` as a type with these rows takes them.
    fn stencil<'a>(self, points: &'a [glam::DVec3], indices: &'a [u32]) -> Stencil<'a> {
        match self {
            Self::Centred => Stencil::centred(points, indices),
            Self::Linear(_) | Self::Pairs => Stencil::absolute(points, indices),
        }
    }
}

/// What a type promises of its projection; the law suite holds it to that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// The nearest element of the set: idempotent, feasible, no feasible point is nearer. Plain iterations never raise
    /// the energy.
    Nearest,
    /// An element of the set, not always the nearest.
    Feasible,
    /// A step towards the set: the violation falls.
    Approximate,
}

/// The number of scalars that one constraint takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scalars {
    /// The constraint cannot be edited.
    None,
    /// One number per entry.
    Named(&'static [Scalar]),
    /// `m ≥ 1` shapes of the constraint's `k` points each, as `3 k m` coordinates.
    Shapes,
}

/// One scalar of a type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scalar {
    /// Its name, with the unit as suffix unless it is in model units or has none.
    pub name: &'static str,
    /// What it is before the first edit; `None` where the points at creation decide.
    pub default: Option<f64>,
}

/// What the world outside needs to know of a type. Everything that shows types to people reads it from here.
#[derive(Clone, Copy, Debug)]
pub struct TypeInfo {
    /// The name in signatures.
    pub name: &'static str,
    /// One line for people.
    pub help: &'static str,
    /// The least number of point indices.
    pub least_indices: usize,
    /// The greatest number of point indices; `None`: any number.
    pub greatest_indices: Option<usize>,
    /// What each index means, in order; the last entry stands for all that follow.
    pub index_names: &'static [&'static str],
    /// The scalars of an edit.
    pub scalars: Scalars,
    /// The rows.
    pub rows: Rows,
    /// What the projection promises.
    pub projection: Projection,
    /// The unit of the violation, such as "model units" or "rad".
    pub violation_unit: &'static str,
    /// `p` where scaling the model by `s` (rest state and length scalars included) scales the energy by `s^p`.
    pub energy_scale_power: i32,
    /// Another type whose name may be given when a constraint of this one is edited.
    pub edited_as: Option<&'static str>,
}

/// One constraint type: the rest state of one constraint, and what the solver asks of it.
///
/// `scalars` are always valid for [`Constraint::check_scalars`]. Everything finite that goes in must give finite results,
/// coincident and collinear points included.
pub trait Constraint: Clone + std::fmt::Debug + Send + Sync + 'static {
    /// What the world needs to know of this type.
    const INFO: TypeInfo;

    /// Another name that signatures may use for it.
    const ALIAS: Option<&'static str> = None;

    /// The kind of the reference shape whose id the first scalar is; `None`: the type has none.
    const REFERENCE: Option<ReferenceKind> = None;

    /// Captures the rest state of `x` and appends the default scalars.
    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self;

    /// Refuses scalars out of their domain. Their count and finiteness were checked against `INFO`.
    ///
    /// # Errors
    /// Status `InvalidValue`, with the scalar's name as place.
    fn check_scalars(_scalars: &[f64]) -> Result<()> {
        Ok(())
    }

    /// The factor on the user's weight.
    fn measure(&self, _scalars: &[f64]) -> f64 {
        1.0
    }

    /// Called when the scalars were edited, before anything else is asked.
    fn scalars_changed(&mut self, _scalars: &[f64]) {}

    /// Hands over the reference shape that the scalars name, after [`Self::at_rest`] and [`Self::scalars_changed`]. Not called
    /// where [`Self::REFERENCE`] is none.
    fn refer_to(&mut self, _shape: &Arc<ReferenceShape>) {}

    /// Writes the coefficients, row by row (`row_count * k`), into zeroed memory. Only called for [`Rows::Linear`].
    fn rows(&self, _scalars: &[f64], _coefficients: &mut [f64]) {}

    /// Writes the projection of `x`: one target per row.
    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [glam::DVec3]);

    /// True if [`Self::project_four`] takes constraints of `k` points.
    fn takes_four(_k: usize) -> bool {
        false
    }

    /// The fast twin of [`Self::project`], for four constraints of `k` points at once: writes the projections of the points
    /// `x` (`k` entries) into `targets` (one entry per row), and returns which of the four are done: where the fast way is
    /// not accurate, `project` must do it. The same results within round-off.
    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, _x: &[V4<S>], _targets: &mut [V4<S>]) -> Mask<S> {
        Mask::none(four.simd)
    }

    /// False where the targets of a centred type can have a mean other than 0.
    const TARGETS_ARE_CENTRED: bool = true;

    /// The twin of [`Self::project`] for graphics cards.
    const KERNEL: Kernel = Kernel::None;

    /// Appends the numbers that the kernel reads, as many for all constraints of as many points and scalars. The kernel's
    /// coordinates are the model's divided by `size`, a length: so are lengths here. Rows are there already.
    fn kernel_numbers(&self, _scalars: &[f64], _size: f64, _numbers: &mut Vec<f64>) {}

    /// A place in the model that the kernel reads after the numbers, as the sum of two like points: six numbers more.
    fn kernel_place(&self, _scalars: &[f64]) -> Option<glam::DVec3> {
        None
    }

    /// How far `x` is from the set, in `INFO.violation_unit`; 0 on the set.
    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64;

    /// True where the rest state spans too little to say what the constraint asks for; it then asks for nothing, or for
    /// less, as the type's docs say.
    fn is_degenerate(&self, _scalars: &[f64]) -> bool {
        false
    }
}

impl TypeInfo {
    /// Refuses a number of indices that the type does not take; types whose rows are pairs take even numbers only.
    ///
    /// # Errors
    /// Status `InvalidArgumentLength`.
    pub fn check_index_count(&self, count: usize) -> Result<()> {
        let is_even_enough = self.rows != Rows::Pairs || count.is_multiple_of(2);
        if is_even_enough && count >= self.least_indices && self.greatest_indices.is_none_or(|most| count <= most) {
            return Ok(());
        }
        let expected = match self.greatest_indices {
            _ if !is_even_enough => format!("an even number of at least {}", self.least_indices),
            Some(most) if most == self.least_indices => format!("{most}"),
            Some(most) => format!("{} to {most}", self.least_indices),
            None => format!("at least {}", self.least_indices),
        };
        let reason = format!("expected {expected} for \"{}\", found {count}", self.name);
        Err(Error::new(Status::InvalidArgumentLength, reason).at("indices"))
    }

    /// Refuses a type whose constraints have no scalars.
    ///
    /// # Errors
    /// Status `InvalidConstraintType`.
    pub fn check_editable(&self) -> Result<()> {
        if self.scalars != Scalars::None {
            return Ok(());
        }
        Err(Error::new(Status::InvalidConstraintType, format!("\"{}\" has no scalars to edit", self.name)))
    }

    /// Refuses a number of scalars that a constraint of `k` points does not take.
    ///
    /// # Errors
    /// Status `InvalidConstraintType` where the type has none, else `InvalidArgumentLength` or, for no shape at all,
    /// `InvalidValue`.
    pub fn check_scalar_count(&self, k: usize, count: usize) -> Result<()> {
        match self.scalars {
            Scalars::None => self.check_editable(),
            Scalars::Named(names) if count == names.len() => Ok(()),
            Scalars::Named(names) => {
                let list = names.iter().map(|scalar| scalar.name).collect::<Vec<_>>().join(", ");
                let reason = format!("expected {} for \"{}\" ({list}), found {count}", names.len(), self.name);
                Err(Error::new(Status::InvalidArgumentLength, reason).at("scalars"))
            }
            Scalars::Shapes if count == 0 => {
                let reason = format!("\"{}\" needs at least one shape, found none", self.name);
                Err(Error::new(Status::InvalidValue, reason).at("scalars"))
            }
            Scalars::Shapes if count.is_multiple_of(3 * k) => Ok(()),
            Scalars::Shapes => {
                let reason = format!("expected a multiple of {} (x y z per point and shape), found {count}", 3 * k);
                Err(Error::new(Status::InvalidArgumentLength, reason).at("scalars"))
            }
        }
    }
}

/// How graphics cards project constraints of a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// They do not: the processor does, whatever the backend.
    None,
    /// They need not: the targets do not depend on the points.
    Constant,
    /// By this text in WGSL, which follows `solver/gpu/shaders/constraint.wgsl` and has `fn project(i: u32)`.
    Wgsl(&'static str, RowUnit),
}

/// What the rows `A x` of a type are measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowUnit {
    /// Model units.
    Length,
    /// Nothing: a rest length is in the coefficients.
    Ratio,
}

/// The number of a type in [`types`]; stable, new types are appended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TypeIndex(u16);

impl TypeIndex {
    /// Finds a type by its name, or its alias, in signatures.
    ///
    /// # Errors
    /// Status `InvalidConstraintType`, with the list of names.
    pub fn named(name: &str) -> Result<Self> {
        match REGISTRY.iter().position(|entry| entry.info.name == name || entry.alias == Some(name)) {
            Some(index) => Ok(Self(index as u16)),
            None => {
                let names = types().map(|info| info.name).collect::<Vec<_>>().join(", ");
                let reason = format!("\"{name}\" is not one of {names}");
                Err(Error::new(Status::InvalidConstraintType, reason).at("type"))
            }
        }
    }

    /// What is known of the type.
    pub fn info(self) -> &'static TypeInfo {
        REGISTRY[self.0 as usize].info
    }
}

/// All types, in the order of their [`TypeIndex`].
pub fn types() -> impl ExactSizeIterator<Item = &'static TypeInfo> {
    REGISTRY.iter().map(|entry| entry.info)
}

struct Entry {
    info: &'static TypeInfo,
    alias: Option<&'static str>,
    new_batch: fn() -> Box<dyn Batch>,
    /// Refuses scalars outside the type's domain.
    check_scalars: fn(&[f64]) -> Result<()>,
    reference: Option<ReferenceKind>,
}

const fn entry<T: Constraint>() -> Entry {
    Entry {
        info: &T::INFO,
        alias: T::ALIAS,
        new_batch: TypedBatch::<T>::new_box,
        check_scalars: T::check_scalars,
        reference: T::REFERENCE,
    }
}

/// Declares the modules and the registry. `cargo fmt` does not see through it: format these files by name.
macro_rules! registry {
    ($($module:ident::$Type:ident,)*) => {
        $(pub mod $module;)*
        static REGISTRY: &[Entry] = &[$(entry::<$module::$Type>()),*];
        #[cfg(test)]
        macro_rules! for_each_type {
            ($law:ident) => { $($law::<$crate::constraints::$module::$Type>();)* };
        }
        #[cfg(test)]
        use for_each_type;
    };
}

registry! {
    edge_strain::EdgeStrain,
    triangle_strain::TriangleStrain,
    tetrahedron_strain::TetrahedronStrain,
    area::Area,
    volume::Volume,
    bending::Bending,
    closeness::Closeness,
    line::Line,
    plane::Plane,
    circle::Circle,
    sphere::Sphere,
    similarity::Similarity,
    rigid::Rigid,
    rectangle::Rectangle,
    parallelogram::Parallelogram,
    laplacian::Laplacian,
    laplacian_displacement::LaplacianDisplacement,
    angle::Angle,
    diagonal_distance::DiagonalDistance,
    edge_length::EdgeLength,
    regular_polygon::RegularPolygon,
    bounded_angle::BoundedAngle,
    on_plane::OnPlane,
    on_line::OnLine,
    equal_lengths::EqualLengths,
    orientation::Orientation,
    on_curve::OnCurve,
    on_mesh::OnMesh,
}

/// Types that are projected together where they are on the same points, in the order of the registry.
static PAIRS: [Pair; 2] = [
    pair::<2, 3, triangle_strain::TriangleStrain, area::Area>(),
    pair::<3, 4, tetrahedron_strain::TetrahedronStrain, volume::Volume>(),
];

/// The scalars of the types that bound a ratio to the rest state; [`check_range`] holds them to their domain.
const RANGE: [Scalar; 2] =
    [Scalar { name: "range_min", default: Some(1.0) }, Scalar { name: "range_max", default: Some(1.0) }];

/// Refuses a number that is not above 0; it was checked to be finite.
fn check_positive(name: &str, value: f64) -> Result<()> {
    if value > 0.0 {
        return Ok(());
    }
    Err(Error::new(Status::InvalidValue, format!("expected a number above 0, found {value}")).at(name))
}

/// Refuses a number below 0; it was checked to be finite.
fn check_not_negative(name: &str, value: f64) -> Result<()> {
    if value >= 0.0 {
        return Ok(());
    }
    Err(Error::new(Status::InvalidValue, format!("expected a number of at least 0, found {value}")).at(name))
}

/// The unit vector along three scalars, tiny and huge ones too; `None` if all are 0.
fn unit_vector(scalars: &[f64]) -> Option<glam::DVec3> {
    let vector = glam::DVec3::from_slice(scalars);
    (vector / vector.abs().max_element()).try_normalize()
}

/// Refuses three scalars that are no direction; they were checked to be finite.
fn check_direction(name: &str, scalars: &[f64]) -> Result<()> {
    if unit_vector(scalars).is_some() {
        return Ok(());
    }
    let reason = format!("expected a direction, three numbers not all 0, found {scalars:?}");
    Err(Error::new(Status::InvalidValue, reason).at(name))
}

/// Refuses a range `[min, max]` that is empty or begins below 0; both ends were checked to be finite.
fn check_range(name: &str, min: f64, max: f64) -> Result<()> {
    if 0.0 <= min && min <= max {
        return Ok(());
    }
    Err(Error::new(Status::InvalidValue, format!("expected 0 <= min <= max, found [{min}, {max}]")).at(name))
}
