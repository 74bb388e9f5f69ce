//! Strips: starting, reading, moving, evaluating.

use std::ffi::{c_char, c_int};

use super::super::arguments::text;
use super::super::{c_count, code, number, shapeop_err};
use super::design::ShapeOpRuled;
use super::io::{self, Outputs, placed};
use super::{guard, shown};
use crate::error::{Error, Result, Status};
use crate::geometry::ruled::design::Draft;
use crate::geometry::ruled::start::StartOptions;
use crate::geometry::ruled::{Strip, file};

/// Control points of a boundary at most: more are no design, and take hours.
const MOST_CONTROL: usize = 10_000;

/// Makes a strip between each pair of boundaries, with rulings along asymptotic curves. A strip has `control_count`
/// control points on each boundary, at least 4 (12 are good). With `is_shared` 1 neighbours have their common boundary
/// as one, so that nothing can gape. Takes back strips and conditions.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledStart(design: *mut ShapeOpRuled, control_count: c_int, is_shared: c_int) -> shapeop_err {
    code(guard(design, |draft| {
        let control_count = io::count("control_count", control_count, 4, MOST_CONTROL)?;
        let options = StartOptions { control_count, is_shared: io::truth("is_shared", is_shared)? };
        draft.step(|design| design.start(options)).map_err(|error| placed(error, &[("options.", "")]))
    }))
}

/// Writes, for each strip that was started, how many of its rulings did not meet the second boundary and went to its
/// nearest point (`missed`), and how many ended before those before them and were moved (`moved`), if there is room for
/// `capacity` strips, and their number to `count`. Each output but `count` may be null.
///
/// # Safety
/// `missed` and `moved` are null or writable for `capacity` ints, `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledStarted(
    design: *mut ShapeOpRuled,
    missed: *mut c_int,
    moved: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let reason = "expected strips that were started: call shapeop_ruledStart first";
        let none = || Error::new(Status::NotInitialised, reason).at("design");
        let started = draft.design().started().ok_or_else(none)?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            if outputs.room(capacity, count, started.missed.len())? {
                outputs.may("missed", missed, io::ints(started.missed.iter().copied())?)?;
                outputs.may("moved", moved, io::ints(started.moved.iter().copied())?)?;
            }
        }
        outputs.write()
    }))
}

/// The number of strips, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledStripCount(design: *mut ShapeOpRuled) -> c_int {
    number(guard(design, |draft| c_count(draft.design().strips().len())))
}

/// Writes the pairs of strips that are neighbours, the second boundary of one being the first of the other, if there is
/// room for `capacity` pairs, and their number to `count`; to `is_shared`, which may be null, 1 if neighbours have
/// their common boundary as one.
///
/// # Safety
/// `pairs` is null or writable for `2 * capacity` ints, `count` and `is_shared` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledJoints(
    design: *mut ShapeOpRuled,
    pairs: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
    is_shared: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let joints = draft.design().joints();
        let all = io::ints(joints.pairs.iter().flatten().copied())?;
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.sized("pairs", pairs, capacity, count, all, 2)?;
            outputs.may("is_shared", is_shared, vec![c_int::from(joints.is_shared)])?;
        }
        outputs.write()
    }))
}

/// The strip of a number.
pub(super) fn strip(draft: &Draft, number: c_int) -> Result<&Strip> {
    let strips = draft.design().strips();
    Ok(&strips[io::index("strip", number, strips.len())?])
}

/// Writes the control points of a strip, those of its first boundary, then those of its second, if there is room for
/// `capacity` of each, and the number of each to `count`; to `is_closed`, which may be null, 1 if its boundaries are
/// closed. The strip is the B-spline surface of degree 3 along its boundaries, with the knots of `shapeop_ruledKnots`,
/// and degree 1 along its rulings; of a closed one the first three control points of each boundary follow the last.
///
/// # Safety
/// `control` is null or writable for `6 * capacity` doubles, `count` and `is_closed` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledControl(
    design: *mut ShapeOpRuled,
    strip: c_int,
    control: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    is_closed: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let strip = self::strip(draft, strip)?;
        let all = [strip.control(0), strip.control(1)].concat();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.sized("control", control, capacity, count, io::coordinates(&all), 6)?;
            outputs.may("is_closed", is_closed, vec![c_int::from(strip.basis().is_closed())])?;
        }
        outputs.write()
    }))
}

/// Writes the knots along the boundaries of a strip if there is room for `capacity` of them, and their number to
/// `count`: all of distance 1, those at both ends of an open strip four times. The parameter `u` goes from the fourth,
/// 0, to the fourth from the end.
///
/// # Safety
/// `knots` is null or writable for `capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledKnots(
    design: *mut ShapeOpRuled,
    strip: c_int,
    knots: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let all = self::strip(draft, strip)?.basis().knots().to_vec();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("knots", knots, capacity, count, all, 1)? };
        outputs.write()
    }))
}

/// Moves the control points of a strip, given as by `shapeop_ruledControl`; `count` is the number of each boundary's,
/// which stays. Boundaries that neighbours share move with it. Conditions stay.
///
/// # Safety
/// `control` is null or readable for `6 * count` doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledSetControl(
    design: *mut ShapeOpRuled,
    strip: c_int,
    control: *const f64,
    count: c_int,
) -> shapeop_err {
    code(guard(design, |draft| {
        let index = io::index("strip", strip, draft.design().strips().len())?;
        let own = self::strip(draft, strip)?.basis().count();
        if usize::try_from(count) != Ok(own) {
            let reason = format!("expected {own}, as many as the strip has; found {count}");
            return Err(Error::new(Status::InvalidArgumentLength, reason).at("count"));
        }
        // SAFETY: the caller vouches for the array; `count` is small, since a strip has as many.
        let points = unsafe { io::points("control", control, "count", 2 * count)? };
        let control = [points[..own].to_vec(), points[own..].to_vec()];
        draft.set_control(index, control).map_err(|error| match error.place().strip_prefix("control[1][") {
            // Both boundaries are one array.
            Some(rest) => {
                let number = rest.trim_end_matches(']').parse::<usize>().unwrap_or(0);
                error.with_place(format!("control[{}]", own + number))
            }
            None => placed(error, &[("control[0][", "control[")]),
        })
    }))
}

/// Takes the strips that a text in JSON states (`shapeop_ruledStripsText`). Where they are as many as before, and open
/// or closed as those, neighbours and conditions stay; otherwise each joins the next.
///
/// # Safety
/// `json` is null or ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledSetStripsText(design: *mut ShapeOpRuled, json: *const c_char) -> shapeop_err {
    code(guard(design, |draft| {
        // SAFETY: the caller vouches for the text.
        let strips = file::from_json(&unsafe { text("json", json)? })?;
        draft.set_strips(strips)
    }))
}

/// The JSON form of the strips (`docs/ruled.schema.json`): degrees, knots and control points; null if it is refused.
/// The text is the calling thread's own, valid until that thread's next call of a `shapeop_ruled...` function that
/// answers with a text.
#[unsafe(no_mangle)]
pub extern "C" fn shapeop_ruledStripsText(design: *mut ShapeOpRuled) -> *const c_char {
    shown(design, |draft| Ok(draft.strips_json()))
}

/// Writes the point of a strip at `u`, from 0 to the last parameter of its boundaries, and `v`, 0 on its first boundary
/// to 1 on its second; the derivatives there by `u` and by `v`, 6 doubles; and the unit normal, their cross product
/// made 1 long, or 0 where they are parallel. Each output may be null.
///
/// # Safety
/// `point` and `normal` are null or writable for 3 doubles, `derivatives` for 6.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_ruledEvaluate(
    design: *mut ShapeOpRuled,
    strip: c_int,
    u: f64,
    v: f64,
    point: *mut f64,
    derivatives: *mut f64,
    normal: *mut f64,
) -> shapeop_err {
    code(guard(design, |draft| {
        let strip = self::strip(draft, strip)?;
        for (name, value, most) in [("u", u, strip.length_u()), ("v", v, 1.0)] {
            if !(0.0..=most).contains(&value) {
                let reason = format!("expected a number from 0 to {most}, found {value}");
                return Err(Error::new(Status::InvalidValue, reason).at(name));
            }
        }
        let jet = strip.at(u, v);
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for the outputs.
        unsafe {
            outputs.may("point", point, io::coordinates(&[jet.point]))?;
            outputs.may("derivatives", derivatives, io::coordinates(&jet.first))?;
            outputs.may("normal", normal, io::coordinates(&[jet.normal()]))?;
        }
        outputs.write()
    }))
}
