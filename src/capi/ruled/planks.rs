//! Planks of conoidal strips. Angles are in radians here, as everywhere in the C ABI.

use std::ffi::{c_char, c_int, c_uint};

use super::super::arguments::text;
use super::super::structs::{self, SizedStruct};
use super::super::{code, guard_free, shapeop_err};
use super::design::ShapeOpRuled;
use super::io::{self, Outputs, placed};
use super::strips::strip;
use super::{guard, shown};
use crate::geometry::ruled::planks::{self, PlankOptions, sheet::sheet};

/// How a strip is cut into planks. Start from `shapeop_ruledDefaultPlankOptions`.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_plank_options {
    /// In: `sizeof(shapeop_ruled_plank_options)`.
    pub struct_size: c_uint,
    /// 1: `first_cut` says where one of the cuts is. Default 0: at the first ruling.
    pub has_first_cut: c_int,
    /// The thickness of the planks, in model units, above 0. It has no default.
    pub thickness: f64,
    /// How far the long sides of a plank are beyond the rulings, in model units, 0 or more. Default 0.
    pub depth: f64,
    /// `axis . x` of one of the cuts.
    pub first_cut: f64,
    /// The angle between rulings and planks that counts as none, in radians, 0 or more. Default 1e-4 degrees.
    pub tolerance: f64,
}

/// What there is to say of all planks of a strip.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_planks {
    /// In: `sizeof(shapeop_ruled_planks)`.
    pub struct_size: c_uint,
    /// The number of planks.
    pub plank_count: c_uint,
    /// The axis, a unit vector across the planks, x.
    pub axis_x: f64,
    /// See `axis_x`.
    pub axis_y: f64,
    /// See `axis_x`.
    pub axis_z: f64,
    /// The thickness of all planks.
    pub thickness: f64,
    /// The greatest angle between a control ruling and the planks, in radians.
    pub deviation: f64,
    /// The area of all boards, in square model units.
    pub stock_area: f64,
    /// The part of it that is cut off.
    pub offcut: f64,
}

/// A plank: a prism of the planks' thickness over a flat outline. Lengths are in model units.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct shapeop_ruled_plank {
    /// In: `sizeof(shapeop_ruled_plank)`.
    pub struct_size: c_uint,
    /// 0; a gap that keeps the doubles aligned.
    pub reserved: c_uint,
    /// `axis . x` of the lower face.
    pub lower: f64,
    /// `axis . x` of the upper face.
    pub upper: f64,
    /// How much of its thickness has rulings: 1, but for the first and the last plank perhaps.
    pub filled: f64,
    /// The parameter of the strip's ruling in the lower face, or its first.
    pub first_u: f64,
    /// The parameter of the strip's ruling in the upper face, or its last.
    pub last_u: f64,
    /// The length of the board that it is cut from.
    pub length: f64,
    /// The width of that board.
    pub width: f64,
    /// The angle between the cut at the strip's first boundary and a square one, in radians.
    pub first_end_angle: f64,
    /// The angle between the cut at the strip's second boundary and a square one, in radians.
    pub second_end_angle: f64,
    /// The part of the board that is cut off.
    pub offcut: f64,
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_plank_options {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_plank_options>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_planks {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_planks>()];
}

// SAFETY: `repr(C)`, `struct_size` first.
unsafe impl SizedStruct for shapeop_ruled_plank {
    const SIZES: &'static [usize] = &[size_of::<shapeop_ruled_plank>()];
}

/// Writes the default options to `options`, whose `struct_size` must be set; the thickness is 0, and must be set too.
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledDefaultPlankOptions(options: *mut shapeop_ruled_plank_options) -> shapeop_err {
    // SAFETY: the caller vouches for `struct_size`, and then for so many bytes.
    code(guard_free(|| unsafe { structs::tell("options", options, &default_options()) }))
}

fn default_options() -> shapeop_ruled_plank_options {
    let PlankOptions { thickness, depth, axis: _, first_cut: _, tolerance_deg } = PlankOptions::new(0.0);
    let tolerance = tolerance_deg.to_radians();
    shapeop_ruled_plank_options { struct_size: 0, has_first_cut: 0, thickness, depth, first_cut: 0.0, tolerance }
}

/// Writes the unit vector that is most nearly orthogonal to all rulings of a strip, so that the strip rises along it,
/// and the greatest angle of a control ruling to the plane across it, in radians: 0 of a conoidal strip. Either may be
/// null.
///
/// # Safety
/// `axis` is null or writable for 3 doubles, `deviation` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledStripAxis(
    design: *mut ShapeOpRuled,
    strip: c_int,
    axis: *mut f64,
    deviation: *mut f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        let found = planks::axis(self::strip(draft, strip)?)?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.may("axis", axis, found.direction.to_array().to_vec())?;
            outputs.may("deviation", deviation, vec![found.deviation_deg.to_radians()])?;
        }
        outputs.write()
    }))
}

/// Cuts a conoidal strip into planks of constant thickness across `axis`, of any length above 0; null for its own.
/// Writes to `planks`, whose `struct_size` must be set, what there is to say of all, and keeps the rest for
/// `shapeop_ruledPlank`, `shapeop_ruledDowels`, `shapeop_ruledPlanksText` and `shapeop_ruledPlanksSvg`. A strip that is
/// not conoidal is refused (`SO_NOT_PLANAR`), as is one that folds back along the axis (`SO_DEGENERATE`).
///
/// # Safety
/// `options` is null, or its `struct_size` is set and it is readable for so many bytes; `axis` is null or readable for
/// 3 doubles; `planks` is null, or its `struct_size` is set and it is writable for so many bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledCutPlanks(
    design: *mut ShapeOpRuled,
    strip: c_int,
    options: *const shapeop_ruled_plank_options,
    axis: *const f64,
    planks: *mut shapeop_ruled_planks,
) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for the structs and the array; numbers are valid for any bytes.
        let (told, axis) = unsafe {
            structs::size("planks", planks)?;
            (structs::read("options", options, default_options())?, io::optional_vector("axis", axis)?)
        };
        let has_first_cut = io::truth("options->has_first_cut", told.has_first_cut)?;
        let options = PlankOptions {
            thickness: told.thickness,
            depth: told.depth,
            axis,
            first_cut: has_first_cut.then_some(told.first_cut),
            tolerance_deg: told.tolerance.to_degrees(),
        };
        let index = io::index("strip", strip, draft.design().strips().len())?;
        let names =
            [("options.axis", "axis"), ("options.tolerance_deg", "options->tolerance"), ("options.", "options->")];
        let found = draft.cut(index, &options).map_err(|error| placed(error, &names))?;
        let told = shapeop_ruled_planks {
            struct_size: 0,
            plank_count: io::field(found.planks.len()),
            axis_x: found.axis[0],
            axis_y: found.axis[1],
            axis_z: found.axis[2],
            thickness: found.thickness,
            deviation: found.deviation_deg.to_radians(),
            stock_area: found.stock_area,
            offcut: found.offcut,
        };
        // SAFETY: the caller vouches for so many bytes.
        unsafe { io::tell("planks", planks, &told, &[told.deviation, told.stock_area, told.offcut]) }
    }))
}

/// Writes one of the planks that were cut last to `plank`, whose `struct_size` must be set. Refused if strips changed
/// since (`SO_NOT_INITIALISED`). The other outputs may be null:
///
/// - `frame`: a point of its lower face, the unit vector along the plank, from the strip's first boundary to its
///   second, and the unit vector across it, 9 doubles. Flat coordinates are along these from the point.
/// - `outline`: the four corners in flat coordinates, counterclockwise seen against the axis, 8 doubles.
/// - `rulings`: the ends of the ruling in the lower face, then of that in the upper, in flat coordinates, 8 doubles.
///
/// # Safety
/// `plank` is null, or its `struct_size` is set and it is writable for so many bytes; `frame` is null or writable for 9
/// doubles, `outline` and `rulings` for 8.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledPlank(
    design: *mut ShapeOpRuled,
    index: c_int,
    plank: *mut shapeop_ruled_plank,
    frame: *mut f64,
    outline: *mut f64,
    rulings: *mut f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = &draft.planks()?.planks;
        let found = &all[io::index("index", index, all.len())?];
        let told = shapeop_ruled_plank {
            struct_size: 0,
            reserved: 0,
            lower: found.heights[0],
            upper: found.heights[1],
            filled: found.filled,
            first_u: found.parameters[0],
            last_u: found.parameters[1],
            length: found.length,
            width: found.width,
            first_end_angle: found.end_angles_deg[0].to_radians(),
            second_end_angle: found.end_angles_deg[1].to_radians(),
            offcut: found.offcut,
        };
        let numbers = [told.lower, told.upper, told.length, told.width, told.filled, told.offcut];
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.may("frame", frame, [found.origin, found.along, found.across].concat())?;
            outputs.may("outline", outline, found.outline.concat())?;
            outputs.may("rulings", rulings, found.rulings.concat().concat())?;
            io::tell("plank", plank, &told, &numbers)?;
        }
        outputs.write()
    }))
}

/// Writes the points of the strip's first (`side` 0) or second (1) boundary at the cuts between the planks that were
/// cut last, ends included, if there is room for `capacity` of them, and their number to `count`: dowels lie along
/// these.
///
/// # Safety
/// `points` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledDowels(
    design: *mut ShapeOpRuled,
    side: c_int,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = draft.planks()?.dowels[io::count("side", side, 0, 1)?].concat();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("points", points, capacity, count, all, 3)? };
        outputs.write()
    }))
}

/// The JSON form of the planks that were cut last (`docs/ruled-planks.schema.json`), in which angles are in degrees;
/// null if it is refused. The text is valid as long as that of `shapeop_ruledStripsText`.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledPlanksText(design: *mut ShapeOpRuled) -> *const c_char {
    shown(design, |draft| draft.planks_json())
}

/// The planks that were cut last, drawn in true scale as SVG, with their numbers, sizes and angles: `name` stands above
/// them, `millimetres` are in a model unit. Null if it is refused. The text is valid as long as that of
/// `shapeop_ruledStripsText`.
///
/// # Safety
/// `name` is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledPlanksSvg(
    design: *mut ShapeOpRuled,
    name: *const c_char,
    millimetres: f64,
) -> *const c_char {
    shown(design, |draft| {
        // SAFETY: the caller vouches for the text.
        let name = unsafe { text("name", name)? };
        sheet(draft.planks()?, &name, millimetres)
    })
}
