//! The constraint types by index: what every program that shows types to people reads them from.

use std::ffi::{CStr, CString, c_char, c_int, c_uint};
use std::mem::offset_of;
use std::ptr;
use std::sync::OnceLock;

use super::structs::{self, SizedStruct};
use super::{c_count, code, guard_free, number, shapeop_err};
use crate::constraints::{Projection, Rows, Scalar, Scalars, TypeInfo, types};
use crate::error::{Error, Result, Status};

/// What a type promises of its projection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_projection {
    /// The nearest feasible configuration: plain iterations never raise the energy.
    SO_PROJECTION_NEAREST = 0,
    /// A feasible configuration, not always the nearest.
    SO_PROJECTION_FEASIBLE = 1,
    /// A step towards a feasible configuration.
    SO_PROJECTION_APPROXIMATE = 2,
}

/// A constraint type. The texts are valid as long as the library is loaded.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_constraint_type {
    /// In: `sizeof(shapeop_constraint_type)`.
    pub struct_size: c_uint,
    /// The least number of point indices.
    pub least_indices: c_int,
    /// The greatest number of point indices; -1: any number.
    pub greatest_indices: c_int,
    /// The number of scalars of an edit; 0: it cannot be edited; -1: shapes, any positive multiple of 3 times the
    /// number of indices (x y z of each point of each shape).
    pub scalar_count: c_int,
    /// The number of names for indices; the last name stands for all indices that follow.
    pub index_name_count: c_int,
    /// What the projection promises.
    pub projection: shapeop_projection,
    /// 1 if it sees its points only relative to their mean, so that alone it leaves translations free; else 0.
    pub is_centred: c_int,
    /// The power of the model's scale with which its energy grows: scaling a model changes the balance of its weights.
    pub energy_scale_power: c_int,
    /// The name in `shapeop_addConstraint`.
    pub name: *const c_char,
    /// One line for people.
    pub help: *const c_char,
    /// The unit of its violation, such as "model units" or "rad".
    pub violation_unit: *const c_char,
    /// Another type's name that `shapeop_editConstraint` takes for it too, or null.
    pub edited_as: *const c_char,
}

/// One scalar of a constraint type. The text is valid as long as the library is loaded.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_constraint_scalar {
    /// In: `sizeof(shapeop_constraint_scalar)`.
    pub struct_size: c_uint,
    /// 1 if there is a default; 0 where the points at creation decide.
    pub has_default: c_int,
    /// The default, or 0.
    pub default_value: f64,
    /// Its name, ending in its unit unless it is in model units or has none.
    pub name: *const c_char,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_constraint_type {
    const SIZES: &'static [usize] = &[
        offset_of!(Self, help),
        offset_of!(Self, violation_unit),
        offset_of!(Self, edited_as),
        size_of::<shapeop_constraint_type>(),
    ];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_constraint_scalar {
    const SIZES: &'static [usize] = &[size_of::<shapeop_constraint_scalar>()];
}

/// The number of constraint types, or -1. Their indices count from 0 and stay: new types are added behind them.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_constraintTypeCount() -> c_int {
    number(guard_free(|| c_count(types().len())))
}

/// Describes the constraint type `index` in `out`, whose `struct_size` must be set.
///
/// # Safety
/// `out` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_constraintType(index: c_int, out: *mut shapeop_constraint_type) -> shapeop_err {
    code(guard_free(|| {
        // SAFETY: the caller vouches for `struct_size`.
        let size = unsafe { structs::size("out", out)? };
        let (info, texts) = of_type(index)?;
        let type_ = describe(info, texts)?;
        // SAFETY: the caller vouches for `size` bytes.
        unsafe { structs::write(out, size, &type_) };
        Ok(())
    }))
}

/// Describes the scalar `scalar_index` of the constraint type `index` in `out`, whose `struct_size` must be set. Types
/// that take shapes have no scalars to describe.
///
/// # Safety
/// `out` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_constraintScalar(
    index: c_int,
    scalar_index: c_int,
    out: *mut shapeop_constraint_scalar,
) -> shapeop_err {
    code(guard_free(|| {
        // SAFETY: the caller vouches for `struct_size`.
        let size = unsafe { structs::size("out", out)? };
        let (info, texts) = of_type(index)?;
        let at = position("scalar_index", scalar_index, texts.scalars.len(), "scalars")?;
        let default = scalars(info)[at].default;
        let scalar = shapeop_constraint_scalar {
            struct_size: 0,
            has_default: c_int::from(default.is_some()),
            default_value: default.unwrap_or(0.0),
            name: texts.scalars[at].as_ptr(),
        };
        // SAFETY: the caller vouches for `size` bytes.
        unsafe { structs::write(out, size, &scalar) };
        Ok(())
    }))
}

/// What the point index `index_position` of a constraint of the type `index` means, such as "apex"; null if there is no
/// such type or its `index_name_count` is not above `index_position`. Valid as long as the library is loaded.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_constraintIndexName(index: c_int, index_position: c_int) -> *const c_char {
    let name = guard_free(|| {
        let (_, texts) = of_type(index)?;
        let at = position("index_position", index_position, texts.index_names.len(), "index names")?;
        Ok(texts.index_names[at].as_c_str())
    });
    name.map_or(ptr::null(), CStr::as_ptr)
}

/// The texts of a type as C has them.
struct Texts {
    name: CString,
    help: CString,
    violation_unit: CString,
    edited_as: Option<CString>,
    index_names: Vec<CString>,
    scalars: Vec<CString>,
}

/// The name of a type as C has it; null for what is none.
pub(super) fn name_of_type(name: &str) -> *const c_char {
    let index = types().position(|info| info.name == name).and_then(|index| c_int::try_from(index).ok());
    index.and_then(|index| of_type(index).ok()).map_or(ptr::null(), |(_, texts)| texts.name.as_ptr())
}

fn scalars(info: &'static TypeInfo) -> &'static [Scalar] {
    match info.scalars {
        Scalars::Named(scalars) => scalars,
        Scalars::None | Scalars::Shapes => &[],
    }
}

fn of_type(index: c_int) -> Result<(&'static TypeInfo, &'static Texts)> {
    static TEXTS: OnceLock<Vec<Texts>> = OnceLock::new();
    // Names and help hold no zero bytes; a text that did would be empty.
    let c_text = |text: &str| CString::new(text).unwrap_or_default();
    let texts = TEXTS.get_or_init(|| {
        let of = |info: &'static TypeInfo| Texts {
            name: c_text(info.name),
            help: c_text(info.help),
            violation_unit: c_text(info.violation_unit),
            edited_as: info.edited_as.map(c_text),
            index_names: info.index_names.iter().map(|name| c_text(name)).collect(),
            scalars: scalars(info).iter().map(|scalar| c_text(scalar.name)).collect(),
        };
        types().map(of).collect()
    });
    let at = position("index", index, texts.len(), "constraint types")?;
    types().nth(at).zip(texts.get(at)).ok_or_else(|| out_of_range("index", index, texts.len(), "constraint types"))
}

pub(super) fn position(name: &str, index: c_int, count: usize, things: &str) -> Result<usize> {
    let found = usize::try_from(index).ok().filter(|index| *index < count);
    found.ok_or_else(|| out_of_range(name, index, count, things))
}

fn out_of_range(name: &str, index: c_int, count: usize, things: &str) -> Error {
    Error::new(Status::InvalidValue, format!("{index} is out of range for {count} {things}")).at(name)
}

fn describe(info: &'static TypeInfo, texts: &'static Texts) -> Result<shapeop_constraint_type> {
    Ok(shapeop_constraint_type {
        struct_size: 0,
        least_indices: c_count(info.least_indices)?,
        greatest_indices: info.greatest_indices.map_or(Ok(-1), c_count)?,
        scalar_count: match info.scalars {
            Scalars::None => 0,
            Scalars::Named(scalars) => c_count(scalars.len())?,
            Scalars::Shapes => -1,
        },
        index_name_count: c_count(texts.index_names.len())?,
        projection: match info.projection {
            Projection::Nearest => shapeop_projection::SO_PROJECTION_NEAREST,
            Projection::Feasible => shapeop_projection::SO_PROJECTION_FEASIBLE,
            Projection::Approximate => shapeop_projection::SO_PROJECTION_APPROXIMATE,
        },
        is_centred: c_int::from(info.rows == Rows::Centred),
        energy_scale_power: info.energy_scale_power,
        name: texts.name.as_ptr(),
        help: texts.help.as_ptr(),
        violation_unit: texts.violation_unit.as_ptr(),
        edited_as: texts.edited_as.as_ref().map_or(ptr::null(), |text| text.as_ptr()),
    })
}
