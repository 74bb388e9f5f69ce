//! Random sequences of calls on designs of ruled strips: valid, stale, foreign and null handles, steps in any order, numbers that are
//! not finite, counts that do not fit. None crashes, none hands out a number that is not finite, and a refused one changes nothing and
//! says why.

use std::ffi::{c_int, c_uint};
use std::ptr;

use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

use super::canal::number;
use super::last_error;
use super::objects::{Done, carry_out, check, run_sequences};

/// Sequences of the ordinary run.
const SEQUENCES: u32 = 400;

/// Points along a side of the mesh.
const SIDE: c_int = 8;

/// Numbers that a call may write.
const ROOM: usize = 4096;

#[derive(Clone, Debug)]
enum Call {
    Create(Vec<f64>, c_int),
    Family(c_int, Option<[f64; 3]>, c_int),
    LevelBoundaries(c_int, f64, Vec<f64>, [f64; 6]),
    Levels(c_int, f64, Vec<f64>, f64),
    Planes(Vec<f64>, f64, c_int),
    Axes(Vec<f64>),
    GreatCircle([f64; 3]),
    Drawn(Vec<f64>, c_int, bool),
    Trace([f64; 3], c_int, f64, f64),
    Start(c_int, c_int),
    Control(c_int, f64, Vec<f64>),
    Again,
    Evaluate(c_int, f64, f64),
    Constrain(u32, c_int, c_int, c_int, Option<[f64; 4]>),
    Optimise([f64; 6], f64, f64, c_uint),
    Report(f64, c_uint),
    Trim(c_int, c_int, f64),
    Rulings(c_int, c_int, c_int),
    Planks(c_int, f64, f64, Option<[f64; 3]>),
    Told(u32, c_int),
    Text(u32, c_int),
    Zebra(Vec<f64>, [f64; 3], c_int, f64),
}

fn integer() -> impl Strategy<Value = c_int> {
    prop_oneof![12 => 0..6_i32, 1 => any::<c_int>(), 1 => Just(-1)]
}

/// Mostly a number that is good for a weight or a length.
fn positive() -> impl Strategy<Value = f64> {
    prop_oneof![8 => 0.0..2.0_f64, 1 => number()]
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    [number(), number(), number()]
}

fn numbers(most: usize) -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(number(), 0..most)
}

fn weights() -> impl Strategy<Value = [f64; 6]> {
    [(); 6].map(|()| positive())
}

/// Two lines across one of the families, one of their points anywhere.
fn drawn((a, b, any, turns): (f64, f64, f64, bool)) -> Call {
    let line = |at: f64| [-0.6, 0.0, 0.6].map(|t| if turns { [t, at, at * t] } else { [at, t, at * t] });
    let mut points = [line(a), line(b)].concat().concat();
    points[4] += 0.1 * any;
    Call::Drawn(points, 3, false)
}

fn call() -> impl Strategy<Value = Call> {
    let making = prop_oneof![
        1 => (proptest::collection::vec(number(), 27), integer()).prop_map(|(p, n)| Call::Create(p, n)),
        2 => (0..3_i32, proptest::option::of(vector()), 0..3_i32).prop_map(|(f, h, c)| Call::Family(f, h, c)),
        4 => (1..6_i32, weights()).prop_map(|(count, weights)| Call::LevelBoundaries(count, 0.0, vec![], weights)),
        2 => (integer(), number(), numbers(3), weights()).prop_map(|(n, w, v, f)| Call::LevelBoundaries(n, w, v, f)),
        2 => (1..6_i32, positive()).prop_map(|(count, least)| Call::Levels(count, 0.0, vec![], least)),
        2 => (integer(), number(), numbers(4), number()).prop_map(|(n, w, v, l)| Call::Levels(n % 1000, w, v, l)),
        2 => (numbers(13), number(), 0..3_i32).prop_map(|(p, a, r)| Call::Planes(p, a, r)),
        2 => numbers(7).prop_map(Call::Axes),
        2 => (numbers(24), integer(), any::<bool>()).prop_map(|(p, n, closed)| Call::Drawn(p, n, closed)),
        2 => (-0.9..-0.1_f64, -0.1..0.9_f64, number(), any::<bool>()).prop_map(drawn),
        8 => (4..8_i32, 0..2_i32).prop_map(|(count, shared)| Call::Start(count, shared)),
        1 => (integer(), integer()).prop_map(|(count, shared)| Call::Start(count, shared)),
        2 => (0..4_i32, number(), numbers(20)).prop_map(|(s, by, p)| Call::Control(s, by, p)),
        1 => Just(Call::Again),
        6 => (0..8_u32, 0..4_i32, integer(), 0..3_i32, proptest::option::of([(); 4].map(|()| number())))
            .prop_map(|(which, strip, side, end, numbers)| Call::Constrain(which, strip, side, end, numbers)),
        4 => (weights(), positive(), positive(), 0..4_u32).prop_map(|(w, d, l, n)| Call::Optimise(w, d, l, n)),
    ];
    let telling = prop_oneof![
        vector().prop_map(Call::GreatCircle),
        (vector(), 0..3_i32, positive(), positive()).prop_map(|(seed, b, step, l)| Call::Trace(seed, b, step, l)),
        (integer(), 0.0..4.0_f64, positive()).prop_map(|(strip, u, v)| Call::Evaluate(strip, u, v)),
        (positive(), 0..4_u32).prop_map(|(ratio, samples)| Call::Report(ratio, samples)),
        (-1..4_i32, integer(), prop_oneof![Just(1e-4), number()]).prop_map(|(s, n, t)| Call::Trim(s, n % 9, t)),
        (-1..4_i32, integer(), 0..3_i32).prop_map(|(strip, n, trimmed)| Call::Rulings(strip, n % 99, trimmed)),
        (0..4_i32, prop_oneof![0.1..1.0_f64, number()], positive(), proptest::option::of(vector()))
            .prop_map(|(strip, t, d, axis)| Call::Planks(strip, t, d, axis)),
        (0..14_u32, integer()).prop_map(|(which, index)| Call::Told(which, index)),
        (0..7_u32, integer()).prop_map(|(which, n)| Call::Text(which, n % 99)),
        (numbers(12), vector(), integer(), number()).prop_map(|(p, eye, n, turn)| Call::Zebra(p, eye, n, turn)),
    ];
    prop_oneof![3 => making, 2 => telling]
}

/// What a refused call must leave as it is: boundaries, strips, conditions.
fn picture(design: *mut ShapeOpRuled) -> (c_int, c_int, String) {
    let text = shapeop_ruledStripsText(design);
    // SAFETY: the library's texts end with a zero and are valid until this thread's next call.
    let text = if text.is_null() { "" } else { unsafe { std::ffi::CStr::from_ptr(text) }.to_str().unwrap() };
    (shapeop_ruledBoundaryCount(design), shapeop_ruledConditionCount(design), text.to_owned())
}

fn or_null(numbers: Option<&[f64]>) -> *const f64 {
    numbers.map_or(ptr::null(), <[f64]>::as_ptr)
}

fn saddle() -> *mut ShapeOpRuled {
    let at = |k: c_int| 2.0 * f64::from(k) / f64::from(SIDE - 1) - 1.0;
    let point = |k: c_int| [at(k % SIDE), at(k / SIDE), at(k % SIDE) * at(k / SIDE) + 0.05 * at(k % SIDE).powi(3)];
    let points: Vec<f64> = (0..SIDE * SIDE).flat_map(point).collect();
    let corners = |k: c_int| [k, k + 1, k + 1 + SIDE, k + SIDE];
    let quads: Vec<c_int> = (0..SIDE * (SIDE - 1)).filter(|k| (k + 1) % SIDE != 0).flat_map(corners).collect();
    let (nb_points, nb_indices) = (SIDE * SIDE, quads.len() as c_int);
    // SAFETY: live arrays of the stated lengths.
    unsafe { shapeop_ruledCreate(points.as_ptr(), nb_points, quads.as_ptr(), nb_indices, &4, 1, ptr::null()) }
}

/// Makes the call; whether it was carried out, and the numbers that it handed out.
fn make(design: *mut ShapeOpRuled, call: &Call) -> (bool, Vec<f64>) {
    let (mut room, mut ints) = (vec![0.0; ROOM], vec![0; ROOM]);
    let (mut count, mut other) = (0, 0);
    let (out, to) = (room.as_mut_ptr(), ints.as_mut_ptr());
    let (none, null, user) = (ptr::null_mut::<f64>(), ptr::null(), ptr::null_mut());
    let nothing = ptr::null_mut::<c_int>();
    // SAFETY: arrays of the stated lengths, structs with their sizes; no capacity is above what there is room for.
    let is_done = unsafe {
        match call {
            Call::Create(points, faces) => {
                let indices = [0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, *faces];
                let made = shapeop_ruledCreate(points.as_ptr(), 9, indices.as_ptr(), 16, &4, 1, null);
                shapeop_ruledDelete(made);
                return (!made.is_null(), room);
            }
            Call::Family(family, hint, cut) => {
                let hint = or_null(hint.as_ref().map(|hint| &hint[..]));
                shapeop_ruledSelectFamily(design, *family, hint, *cut) == SO_SUCCESS
            }
            Call::LevelBoundaries(count, width, values, weights) => {
                let mut options: shapeop_ruled_level_options = std::mem::zeroed();
                options.struct_size = size_of_val(&options) as c_uint;
                shapeop_ruledDefaultLevelOptions(0, &mut options);
                [options.orthogonal, options.direction, options.equidistant] = [weights[0], weights[1], weights[2]];
                // The spherical image of this mesh is folded: mostly refused.
                let conoidal = if weights[4] <= 1.0 { 0.0 } else { weights[4] };
                [options.geodesic, options.conoidal, options.laplace] = [weights[3], conoidal, weights[5]];
                (options.max_iterations, options.allow_folds) = (3, c_int::from(weights[5] > 1.0));
                let (data, nb) = (values.as_ptr(), values.len() as c_int);
                let (boundaries, count) = (ptr::null(), *count % 1000);
                shapeop_ruledSetLevelBoundaries(design, &options, count, *width, data, nb, boundaries, None, user)
                    == SO_SUCCESS
            }
            Call::Levels(count, width, values, least) => {
                let mut options: shapeop_ruled_boundary_options = std::mem::zeroed();
                options.struct_size = size_of_val(&options) as c_uint;
                shapeop_ruledDefaultBoundaryOptions(&mut options);
                options.least_length = *least;
                let (data, nb) = (values.as_ptr(), values.len() as c_int);
                shapeop_ruledSetLevels(design, *count, *width, data, nb, &options) == SO_SUCCESS
            }
            Call::Planes(planes, angle, refuses) => {
                let nb = planes.len() as c_int / 4;
                let code =
                    shapeop_ruledSetPlanarBoundaries(design, planes.as_ptr(), nb, *angle, *refuses, ptr::null(), out);
                code == SO_SUCCESS
            }
            Call::Axes(axes) => {
                let nb = axes.len() as c_int / 3;
                shapeop_ruledSetGreatCircleBoundaries(design, axes.as_ptr(), nb, ptr::null()) == SO_SUCCESS
            }
            Call::GreatCircle(axis) => {
                let code = shapeop_ruledGreatCircle(design, axis.as_ptr(), out, 1000, &mut count, to, 1000, &mut other);
                code == SO_SUCCESS
            }
            Call::Drawn(points, first, closed) => {
                let nb = points.len() as c_int / 3;
                let (counts, closed) = ([*first, nb.saturating_sub(*first)], [c_int::from(*closed); 2]);
                let (counts, closed) = (counts.as_ptr(), closed.as_ptr());
                shapeop_ruledSetDrawnBoundaries(design, points.as_ptr(), nb, counts, 2, closed, ptr::null())
                    == SO_SUCCESS
            }
            Call::Trace(seed, backward, step, length) => {
                let (seed, capacity) = (seed.as_ptr(), 1000);
                let code =
                    shapeop_ruledTrace(design, seed, *backward, *step, *length, out, capacity, &mut count, nothing);
                code == SO_SUCCESS
            }
            Call::Start(count, shared) => shapeop_ruledStart(design, *count, *shared) == SO_SUCCESS,
            Call::Control(strip, by, moves) => {
                // The strip moved, some of its points by numbers that may not be finite.
                let mut own = vec![0.0; 6 * 8];
                let code = shapeop_ruledControl(design, *strip, own.as_mut_ptr(), 8, &mut count, nothing);
                if code != SO_SUCCESS {
                    return (false, room);
                }
                own.iter_mut().zip(moves).for_each(|(number, by)| *number += 0.1 * by);
                own.iter_mut().for_each(|number| *number += 0.1 * by);
                shapeop_ruledSetControl(design, *strip, own.as_ptr(), count.min(8)) == SO_SUCCESS
            }
            Call::Again => {
                let json = shapeop_ruledStripsText(design);
                if json.is_null() {
                    return (false, room);
                }
                let own = std::ffi::CStr::from_ptr(json).to_owned();
                shapeop_ruledSetStripsText(design, own.as_ptr()) == SO_SUCCESS
            }
            Call::Evaluate(strip, u, v) => {
                shapeop_ruledEvaluate(design, *strip, *u, *v, out, out.add(3), out.add(9)) == SO_SUCCESS
            }
            Call::Constrain(which, strip, side, end, numbers) => {
                let numbers = or_null(numbers.as_ref().map(|numbers| &numbers[..]));
                let code = match which {
                    0 => shapeop_ruledConstrainPlane(design, *side, numbers),
                    1 => shapeop_ruledConstrainCutPlanes(design),
                    2 | 3 => shapeop_ruledConstrainPoint(design, *strip, *side % 3, *end, numbers),
                    4 => shapeop_ruledConstrainEnds(design),
                    5 => shapeop_ruledConstrainEndDirection(design, *strip, *end, numbers),
                    6 => shapeop_ruledConstrainConoid(design, *strip, numbers),
                    _ => shapeop_ruledClearConditions(design),
                };
                code == SO_SUCCESS
            }
            Call::Optimise(weights, deviation, width, iterations) => {
                let mut options: shapeop_ruled_optimise_options = std::mem::zeroed();
                options.struct_size = size_of_val(&options) as c_uint;
                shapeop_ruledDefaultOptimiseOptions(&mut options);
                [options.proximity, options.beyond, options.gap] = [weights[0], weights[1] / 2.0, weights[2]];
                [options.coverage, options.thin_plate, options.proximal] = [weights[3], weights[4], weights[5]];
                (options.samples_along, options.max_iterations) = (2, *iterations);
                // Bounds make quadratic programs: seldom.
                options.largest_deviation = if *deviation > 1.5 { *deviation } else { 0.0 };
                options.least_width = if *width > 1.0 { *width / 10.0 } else { 0.0 };
                let mut report: shapeop_ruled_optimise_report = std::mem::zeroed();
                report.struct_size = size_of_val(&report) as c_uint;
                let code = shapeop_ruledOptimise(design, &options, None, user, &mut report);
                room[..4].copy_from_slice(&[report.before, report.after, report.excess, report.largest_gap]);
                code == SO_SUCCESS
            }
            Call::Report(ratio, samples) => {
                let mut options: shapeop_ruled_report_options = std::mem::zeroed();
                options.struct_size = size_of_val(&options) as c_uint;
                shapeop_ruledDefaultReportOptions(&mut options);
                (options.feature_ratio, options.samples_along) = (*ratio, *samples);
                options.trim_tolerance = 1e-4;
                let mut report: shapeop_ruled_report = std::mem::zeroed();
                report.struct_size = size_of_val(&report) as c_uint;
                let code = shapeop_ruledReport(design, &options, &mut report);
                room[..3].copy_from_slice(&[report.coverage, report.largest_kink, report.rms_uncovered]);
                code == SO_SUCCESS
            }
            Call::Trim(strip, columns, tolerance) => {
                let (points, faces) = (&mut count, &mut other);
                shapeop_ruledTrimmedMesh(
                    design, *strip, *columns, *tolerance, out, none, 1000, points, to, nothing, 1000, faces,
                ) == SO_SUCCESS
            }
            Call::Rulings(strip, rulings, trimmed) => {
                let code = shapeop_ruledRulings(design, *strip, *rulings, *trimmed, out, none, to, 600, &mut count);
                code == SO_SUCCESS
            }
            Call::Planks(strip, thickness, depth, axis) => {
                let mut options: shapeop_ruled_plank_options = std::mem::zeroed();
                options.struct_size = size_of_val(&options) as c_uint;
                shapeop_ruledDefaultPlankOptions(&mut options);
                (options.thickness, options.depth, options.tolerance) = (*thickness, *depth, 0.5);
                let mut planks: shapeop_ruled_planks = std::mem::zeroed();
                planks.struct_size = size_of_val(&planks) as c_uint;
                let axis = or_null(axis.as_ref().map(|axis| &axis[..]));
                let code = shapeop_ruledCutPlanks(design, *strip, &options, axis, &mut planks);
                room[..3].copy_from_slice(&[planks.deviation, planks.offcut, planks.stock_area]);
                code == SO_SUCCESS
            }
            Call::Told(which, index) => told(design, *which, *index, out, to) == SO_SUCCESS,
            Call::Text(which, rulings) => !match which {
                0 => shapeop_ruledStripsText(design),
                1 => shapeop_ruledSurfacesObj(design),
                2 => shapeop_ruledRulingsObj(design, *rulings),
                3 => shapeop_ruledRulingsCsv(design, *rulings),
                4 => shapeop_ruledReportText(design),
                5 => shapeop_ruledPlanksText(design),
                _ => shapeop_ruledPlanksSvg(design, c"strip".as_ptr(), f64::from(*rulings)),
            }
            .is_null(),
            Call::Zebra(points, eye, stripes, turn) => {
                let (at, nb, up) = (points.as_ptr(), points.len() as c_int / 3, [0.0, 0.0, 1.0].repeat(4));
                let (eye, along) = (eye.as_ptr(), [1.0, 0.0, 0.0]);
                shapeop_ruledZebra(at, up.as_ptr(), nb, eye, 0, along.as_ptr(), *stripes, *turn, out) == SO_SUCCESS
            }
        }
    };
    (is_done, room)
}

/// # Safety
/// `out` and `to` have room for [`ROOM`] values.
unsafe fn told(design: *mut ShapeOpRuled, which: u32, index: c_int, out: *mut f64, to: *mut c_int) -> shapeop_err {
    let (none, nothing, mut number) = (ptr::null_mut(), ptr::null_mut(), 0);
    let count = &raw mut number;
    // SAFETY: the caller vouches for the room; no capacity is above it.
    unsafe {
        match which {
            0 => shapeop_ruledTriangles(design, to, 500, count),
            1 => shapeop_ruledCurvatures(design, out, out.add(500), out.add(1500), 100, count),
            2 => shapeop_ruledDirections(design, index, out, to, 500, count),
            3 => shapeop_ruledField(design, out, to, 500, count),
            4 => shapeop_ruledFlips(design, to, 500, count),
            5 => shapeop_ruledLevelValues(design, out, 500, count),
            6 => shapeop_ruledLevelHistory(design, out, 500, count),
            7 => shapeop_ruledBoundary(design, index, out, 500, count, nothing, out.add(3000)),
            8 => shapeop_ruledBoundaryAxis(design, index, out, out.add(3)),
            9 => shapeop_ruledDroppedCurves(design, out, out.add(2000), 500, count),
            10 => shapeop_ruledHistory(design, out, 100, count),
            11 => shapeop_ruledKnots(design, index, out, 500, count),
            12 => shapeop_ruledStripAxis(design, index, out, out.add(3)),
            _ => shapeop_ruledDowels(design, index, out, 500, if index == 3 { none } else { count }),
        }
    }
}

fn run(sequence: &[(usize, Call)], done: &mut Done) -> Result<(), TestCaseError> {
    let design = saddle();
    check(!design.is_null(), &last_error(ptr::null_mut()))?;
    // Every other sequence begins with strips.
    if sequence.len().is_multiple_of(2) {
        make(design, &Call::LevelBoundaries(2, 0.0, vec![], [1.0, 0.0, 0.0, 0.0, 0.0, 1e-3]));
        make(design, &Call::Start(5, c_int::from(sequence.len().is_multiple_of(4))));
    }
    let stale = shapeop_ruledCopy(design);
    shapeop_ruledDelete(stale);
    let solver = shapeop_create();
    let mut handles = vec![design; 12];
    handles.extend([stale, solver.cast(), ptr::null_mut(), ptr::without_provenance_mut(0x7fff_1234)]);
    carry_out(&handles, sequence, make, picture, |picture| !picture.2.contains("null"), done)?;
    shapeop_ruledDelete(design);
    shapeop_delete(solver);
    Ok(())
}

#[test]
fn no_sequence_of_calls_on_designs_crashes() {
    let done = run_sequences(SEQUENCES, 23, call(), run);
    // A call that is always refused tests nothing; points at random are no saddle.
    assert!(done.len() == 22 && done.iter().all(|(kind, count)| *count > 0 || kind == "Create"), "{done:?}");
}
