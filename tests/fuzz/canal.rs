//! Random sequences of calls on super-canal surfaces: valid, stale, foreign and null handles, numbers that are not finite, counts that
//! do not fit. None crashes, none hands out a number that is not finite, and a refused one changes nothing and says why.

use std::ffi::c_int;
use std::ptr;

use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

use super::objects::{Done, carry_out, run_sequences};

/// Sequences of the ordinary run.
const SEQUENCES: u32 = 2_000;

#[derive(Clone, Debug)]
enum Call {
    Invert([f64; 3], f64),
    Translate([f64; 3]),
    Scale(f64),
    Rotate([f64; 3], f64),
    Combescure(Vec<f64>, Vec<f64>),
    Undo,
    Refined(c_int, c_int),
    Evaluate(c_int, c_int, f64, f64),
    Points(c_int, bool),
    Gap,
    Residual,
    Text,
    Create(Vec<f64>, c_int, c_int, c_int, [f64; 6]),
    Revolution(Vec<f64>, [f64; 3], f64, c_int),
    Strip(Vec<f64>, [f64; 3], f64, u32),
    Holonomy(Vec<f64>),
    Folds(Vec<f64>, c_int, c_int),
    InvertPoints(Vec<f64>, [f64; 3], f64),
    Fit(Vec<f64>, Vec<f64>, f64, c_int),
    CCanal(Vec<f64>, Vec<f64>, f64, c_int),
    Smooth(Vec<f64>, Vec<f64>, [f64; 6]),
    Parts(u32, Vec<f64>, Vec<f64>, f64, c_int),
}

pub(super) fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        12 => -2.0..2.0_f64,
        2 => prop_oneof![Just(0.0), Just(1.0), Just(-1.0)],
        1 => prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(1e308), Just(-1e200), Just(5e-324)],
    ]
}

fn integer() -> impl Strategy<Value = c_int> {
    prop_oneof![8 => 0..6_i32, 1 => any::<c_int>(), 1 => Just(-1)]
}

fn vector() -> impl Strategy<Value = [f64; 3]> {
    [number(), number(), number()]
}

fn numbers(most: usize) -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(number(), 0..most)
}

fn call() -> impl Strategy<Value = Call> {
    prop_oneof![
        (vector(), number()).prop_map(|(center, ratio)| Call::Invert(center, ratio)),
        vector().prop_map(Call::Translate),
        number().prop_map(Call::Scale),
        (vector(), number()).prop_map(|(axis, angle)| Call::Rotate(axis, angle)),
        (proptest::collection::vec(number(), 2..5), proptest::collection::vec(number(), 3..6))
            .prop_map(|(column, row)| Call::Combescure(column, row)),
        Just(Call::Undo),
        (integer(), integer()).prop_map(|(one, two)| Call::Refined(one, two)),
        (integer(), integer(), 0.0..1.0_f64, number()).prop_map(|(i, j, u, v)| Call::Evaluate(i, j, u, v)),
        (integer(), any::<bool>()).prop_map(|(capacity, is_null)| Call::Points(capacity, is_null)),
        Just(Call::Gap),
        Just(Call::Residual),
        Just(Call::Text),
        (proptest::collection::vec(number(), 48), integer(), integer(), 0..5_i32, [(); 6].map(|()| number()))
            .prop_map(|(points, rows, columns, wraps, frame)| Call::Create(points, rows, columns, wraps, frame)),
        (numbers(12), vector(), number(), integer())
            .prop_map(|(p, axis, angle, n)| Call::Revolution(p, axis, angle, n)),
        (numbers(24), vector(), number(), 0..9_u32).prop_map(|(p, start, length, f)| Call::Strip(p, start, length, f)),
        numbers(24).prop_map(Call::Holonomy),
        (proptest::collection::vec(number(), 48), 0..5_i32, 0..5_i32).prop_map(|(p, r, c)| Call::Folds(p, r, c)),
        (numbers(12), vector(), number()).prop_map(|(p, center, ratio)| Call::InvertPoints(p, center, ratio)),
        (numbers(15), numbers(15), number(), integer()).prop_map(|(a, b, angle, n)| Call::Fit(a, b, angle, n)),
        (numbers(12), numbers(12), number(), 0..3_i32).prop_map(|(a, b, l, flag)| Call::CCanal(a, b, l, flag)),
        (numbers(12), numbers(12), [(); 6].map(|()| number())).prop_map(|(a, b, frame)| Call::Smooth(a, b, frame)),
        (0..4_u32, [(); 2].map(|()| proptest::collection::vec(number(), 12)), number(), 0..4_i32)
            .prop_map(|(which, [points, axes], height, wraps)| Call::Parts(which, points, axes, height, wraps)),
    ]
}

/// The points of a live surface; `None` if there is none.
fn points_of(surface: *mut ShapeOpCanal) -> Option<Vec<f64>> {
    let mut count = 0;
    // SAFETY: a size query, then an array of that many points.
    unsafe {
        if shapeop_canalPoints(surface, ptr::null_mut(), 0, &mut count) != SO_SUCCESS {
            return None;
        }
        let mut points = vec![f64::NAN; 3 * count as usize];
        shapeop_canalPoints(surface, points.as_mut_ptr(), count, &mut count);
        Some(points)
    }
}

fn bits(points: &Option<Vec<f64>>) -> Option<Vec<u64>> {
    points.as_ref().map(|points| points.iter().map(|number| number.to_bits()).collect())
}

/// Whether a new surface was made; it is deleted.
fn made(surface: *mut ShapeOpCanal) -> bool {
    shapeop_canalDelete(surface);
    !surface.is_null()
}

/// Makes the call; whether it was carried out, and the numbers that it handed out.
fn make(surface: *mut ShapeOpCanal, call: &Call) -> (bool, Vec<f64>) {
    let mut room = vec![0.0; 64];
    let mut count = 0;
    let out = room.as_mut_ptr();
    let none = ptr::null_mut::<f64>();
    // SAFETY: arrays of the stated lengths; `room` is as large as any of these writes.
    let is_done = unsafe {
        match call {
            Call::Invert(center, ratio) => shapeop_canalInvert(surface, center.as_ptr(), *ratio) == SO_SUCCESS,
            Call::Translate(vector) => shapeop_canalTranslate(surface, vector.as_ptr()) == SO_SUCCESS,
            Call::Scale(factor) => shapeop_canalScale(surface, *factor) == SO_SUCCESS,
            Call::Rotate(axis, angle) => shapeop_canalRotate(surface, axis.as_ptr(), *angle) == SO_SUCCESS,
            Call::Combescure(column, row) => {
                let (a, b) = (column.len() as c_int, row.len() as c_int);
                shapeop_canalCombescureFactors(surface, column.as_ptr(), a, row.as_ptr(), b) == SO_SUCCESS
            }
            Call::Undo => shapeop_canalUndo(surface) >= 0,
            Call::Refined(one, two) => made(shapeop_canalRefined(surface, *one % 1000, *two % 1000)),
            Call::Evaluate(i, j, u, v) => shapeop_canalEvaluate(surface, *i, *j, *u, *v, out, out.add(3)) == SO_SUCCESS,
            Call::Points(capacity, is_null) => {
                // Never more room stated than there is.
                let capacity = (*capacity).min(20);
                let to = if *is_null { none } else { out };
                shapeop_canalPoints(surface, to, capacity, &mut count) == SO_SUCCESS
            }
            Call::Gap => shapeop_canalClosingGap(surface, out) == SO_SUCCESS,
            Call::Residual => shapeop_canalMembraneResidual(surface, out) == SO_SUCCESS,
            Call::Text => !shapeop_canalText(surface).is_null(),
            Call::Create(points, rows, columns, wraps, frame) => {
                let fits = i64::from(*rows) * i64::from(*columns) <= 16;
                let data = if fits { points.as_ptr() } else { ptr::null() };
                made(shapeop_canalCreate(data, *rows, *columns, *wraps, frame.as_ptr(), 3))
            }
            Call::Revolution(points, axis, angle, columns) => {
                let (origin, count) = ([0.0; 3], points.len() as c_int / 3);
                let (profile, axis) = (points.as_ptr(), axis.as_ptr());
                made(shapeop_canalRevolution(profile, count, origin.as_ptr(), axis, *angle, *columns % 1000))
            }
            Call::Strip(points, start, length, flags) => {
                let (count, lengths) = (points.len() as c_int / 3, vec![*length; points.len()]);
                let (guide, start, lengths) = (points.as_ptr(), start.as_ptr(), lengths.as_ptr());
                let flag = ptr::null_mut();
                let code = shapeop_canalStrip(guide, count, start, lengths, *flags, out, none, none, flag, flag, none);
                code == SO_SUCCESS
            }
            Call::Holonomy(points) => {
                let count = points.len() as c_int / 3;
                shapeop_canalHolonomy(points.as_ptr(), count, out, out.add(9), &mut count.clone(), out.add(10))
                    == SO_SUCCESS
            }
            Call::Folds(points, rows, columns) => {
                let flags = ptr::null_mut();
                let code = shapeop_canalFolds(points.as_ptr(), *rows, *columns, 0, out, flags, out.add(8), flags);
                code == SO_SUCCESS
            }
            Call::Fit(guide, curve, angle, columns) => {
                let mut options: shapeop_canal_fit_options = std::mem::zeroed();
                options.struct_size = size_of::<shapeop_canal_fit_options>() as u32;
                shapeop_canalDefaultFitOptions(&mut options);
                (options.angle, options.column_count, options.circle_count) = (*angle, *columns % 1000, 3);
                let (a, b) = (guide.len() as c_int / 3, curve.len() as c_int / 3);
                let (guide, curve, flag) = (guide.as_ptr(), curve.as_ptr(), ptr::null_mut());
                let report = ptr::null_mut();
                let options = &raw const options;
                made(shapeop_canalFit(
                    guide, a, 0, curve, b, 0, options, out, 3, &mut count, none, flag, 0, flag, report,
                ))
            }
            Call::CCanal(guide, section, length, projects) => {
                let (a, b) = (guide.len() as c_int / 3, section.len() as c_int / 3);
                let (lengths, flag) = (vec![*length; guide.len()], ptr::null_mut());
                let (guide, section, lengths) = (guide.as_ptr(), section.as_ptr(), lengths.as_ptr());
                let user = ptr::null_mut();
                let surface = shapeop_canalCCanal(
                    guide, a, section, b, lengths, none, 0, 0, *projects, None, user, out, none, none, flag, flag,
                );
                made(surface)
            }
            Call::Smooth(guide, border, frame) => {
                let count = guide.len().min(border.len()) as c_int / 3;
                // Nearly every other one is refused.
                let frame = if frame[0] > 0.0 { [1.0, 0.0, 0.0, 0.0, 1.0, 0.0] } else { *frame };
                let (guide, border, frame, user) = (guide.as_ptr(), border.as_ptr(), frame.as_ptr(), ptr::null_mut());
                let (options, history, report) = (ptr::null(), ptr::null_mut(), ptr::null_mut());
                let (to_guide, to_border) = (out, out.add(12));
                let code = shapeop_canalSmooth(
                    guide,
                    border,
                    count,
                    frame,
                    options,
                    None,
                    user,
                    to_guide,
                    to_border,
                    none,
                    none,
                    history,
                    0,
                    user.cast(),
                    report,
                );
                code == SO_SUCCESS
            }
            Call::Parts(which, points, axes, height, wraps) => {
                let (points, axes, nodes) = (points.as_ptr(), axes.as_ptr(), ptr::null_mut());
                match which {
                    0 => {
                        shapeop_canalBeams(points, 2, 2, *wraps, axes, *height, nodes, out, 4, &mut count) == SO_SUCCESS
                    }
                    1 => {
                        shapeop_canalPanels(points, 2, 2, *wraps, axes, *height, out, out.add(32), none, none, none)
                            == SO_SUCCESS
                    }
                    2 => shapeop_canalNodeAxes(points, 2, 2, *wraps, axes, out, out.add(12)) == SO_SUCCESS,
                    _ => !shapeop_canalPartsText(points, 2, 2, *wraps, axes, *height, *height).is_null(),
                }
            }
            Call::InvertPoints(points, center, ratio) => {
                let count = points.len() as c_int / 3;
                shapeop_canalInvertPoints(points.as_ptr(), count, center.as_ptr(), *ratio, out) == SO_SUCCESS
            }
        }
    };
    (is_done, room)
}

fn run(sequence: &[(usize, Call)], done: &mut Done) -> Result<(), TestCaseError> {
    let profile = [2.7, 0.0, 0.0, 2.5, 0.0, 0.5, 2.0, 0.0, 0.7, 1.5, 0.0, 0.5];
    // SAFETY: 4 points and two vectors.
    let torus =
        unsafe { shapeop_canalRevolution(profile.as_ptr(), 4, [0.0; 3].as_ptr(), [0.0, 0.0, 1.0].as_ptr(), 1.5, 5) };
    let stale = shapeop_canalCopy(torus);
    shapeop_canalDelete(stale);
    let solver = shapeop_create();
    let handles =
        [torus, torus, torus, stale, solver.cast(), ptr::null_mut(), ptr::without_provenance_mut(0x7fff_1234)];
    let picture = |surface| bits(&points_of(surface));
    let is_finite = |points: &Option<Vec<u64>>| points.iter().flatten().all(|bits| f64::from_bits(*bits).is_finite());
    carry_out(&handles, sequence, make, picture, is_finite, done)?;
    shapeop_canalDelete(torus);
    shapeop_delete(solver);
    Ok(())
}

#[test]
fn no_sequence_of_calls_on_surfaces_crashes() {
    run_sequences(SEQUENCES, 17, call(), run);
}
