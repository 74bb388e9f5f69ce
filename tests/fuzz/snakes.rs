//! Random sequences of calls on snakes: valid, stale, foreign and null handles, steps in any order, numbers that are not finite, counts
//! that do not fit. None crashes, none hands out a number that is not finite, and a refused one changes nothing and says why.

use std::ffi::{CStr, CString, c_int, c_uint};
use std::ptr;

use proptest::prelude::*;
use proptest::test_runner::TestCaseError;
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

use super::canal::number;
use super::last_error;
use super::objects::{Done, carry_out, check, run_sequences};

/// Sequences of the ordinary run.
const SEQUENCES: u32 = 1_500;

/// Numbers that a call may write.
const ROOM: usize = 4096;

#[derive(Clone, Debug)]
enum Call {
    Create(Vec<f64>, c_int, f64),
    Arcs(Vec<f64>, Vec<f64>, [f64; 3]),
    Text(String),
    Fit(Vec<f64>, c_int, c_int, f64),
    Curve(c_int, Vec<f64>, [f64; 3], [f64; 3], Vec<f64>, f64),
    MeshCurve([f64; 3], [f64; 3], f64, f64),
    Control(f64, Vec<f64>),
    Project(f64, Vec<f64>, c_int),
    Surface(c_int, Vec<f64>),
    Mesh(Vec<f64>, c_int),
    NoSurface,
    Direction(c_int, Option<[f64; 3]>),
    Speeds(Vec<f64>),
    Fixed(Vec<c_int>),
    Wish(bool, c_int, [f64; 3], f64),
    NoWishes,
    Rail(u32, c_int, Vec<f64>, f64, c_int),
    NoRails,
    Evolve(Settings, c_uint),
    Velocity(Settings),
    Cycle(f64, c_uint, c_int),
    Take(c_int),
    Told(u32, c_int, c_int),
    Mesher(u32, c_int, f64, c_int, [f64; 3]),
    Copies(c_int, f64, f64, [f64; 3]),
    Kinds(f64),
    Covering(f64, c_uint),
    Texts(u32, c_int, f64),
    Again,
}

/// Some of the options.
#[derive(Clone, Debug)]
struct Settings {
    step: f64,
    deviation: f64,
    weights: [f64; 4],
    flags: [c_int; 4],
    mu: f64,
}

fn integer() -> BoxedStrategy<c_int> {
    prop_oneof![12 => 0..7_i32, 1 => any::<c_int>(), 1 => Just(-1)].boxed()
}

/// Mostly a number that is good for a weight or a length.
fn positive() -> BoxedStrategy<f64> {
    prop_oneof![12 => 0.01..2.0_f64, 1 => number()].boxed()
}

fn vector() -> BoxedStrategy<[f64; 3]> {
    prop_oneof![4 => [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64], 1 => [number(), number(), number()]].boxed()
}

fn numbers(most: usize) -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(number(), 0..most)
}

fn small(count: usize) -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-1.0..1.0_f64, count)
}

fn settings() -> BoxedStrategy<Settings> {
    let weights = [positive(), positive(), positive(), positive()];
    let flags = [0..2_i32, 0..2_i32, 0..2_i32, 0..12_i32];
    (positive(), prop_oneof![Just(-1.0), positive()], weights, flags, positive())
        .prop_map(|(step, deviation, weights, flags, mu)| Settings { step: 0.1 * step, deviation, weights, flags, mu })
        .boxed()
}

fn call() -> BoxedStrategy<Call> {
    let arcs = || proptest::collection::vec(positive(), 0..6);
    let making = prop_oneof![
        1 => (numbers(16), 0..3_i32, number()).prop_map(|(p, c, t)| Call::Create(p, c, t)),
        1 => (arcs(), numbers(6), vector()).prop_map(|(r, t, p)| Call::Arcs(r, t, p)),
        1 => "\\PC{0,20}".prop_map(Call::Text),
        1 => (prop_oneof![small(30), numbers(30)], 0..3_i32, integer(), positive())
            .prop_map(|(p, c, n, w)| Call::Fit(p, c, n % 9, w)),
        1 => (0..5_i32, prop_oneof![small(7), numbers(9)], vector(), vector(), numbers(3), positive())
            .prop_map(|(k, n, s, t, c, l)| Call::Curve(k, n, s, t, c, l)),
        1 => (Just([1.0, 0.2, -0.3, 2.0]), vector(), vector(), positive(), positive())
            .prop_map(|(n, s, t, c, l)| Call::Curve(1, n.to_vec(), s, t, vec![c], l)),
        1 => (vector(), vector(), positive(), positive()).prop_map(|(s, t, c, l)| Call::MeshCurve(s, t, c, l)),
    ]
    .boxed();
    let setting = prop_oneof![
        1 => (number(), numbers(20)).prop_map(|(by, p)| Call::Control(by, p)),
        2 => (0.0..0.1_f64, small(20), 0..3_i32).prop_map(|(by, p, exact)| Call::Project(by, p, exact)),
        1 => (number(), numbers(20), 0..3_i32).prop_map(|(by, p, exact)| Call::Project(by, p, exact)),
        2 => (0..4_i32, small(6)).prop_map(|(kind, n)| Call::Surface(kind, [n, vec![2.0, 0.5]].concat())),
        1 => (integer(), numbers(9)).prop_map(|(kind, n)| Call::Surface(kind, n)),
        1 => (prop_oneof![small(27), proptest::collection::vec(number(), 27)], prop_oneof![Just(7), integer()]).prop_map(|(p, n)| Call::Mesh(p, n)),
        1 => Just(Call::NoSurface),
        3 => (0..4_i32, proptest::option::of(vector())).prop_map(|(kind, v)| Call::Direction(kind, v)),
        1 => prop_oneof![small(1), small(8), numbers(9)].prop_map(Call::Speeds),
        1 => proptest::collection::vec(integer(), 0..3).prop_map(Call::Fixed),
        2 => (any::<bool>(), integer(), vector(), positive()).prop_map(|(p, i, v, w)| Call::Wish(p, i, v, w)),
        1 => Just(Call::NoWishes),
        4 => (0..3_u32, integer(), prop_oneof![small(9), numbers(12)], number(), integer())
            .prop_map(|(which, i, p, s, l)| Call::Rail(which, i, p, s, l)),
        1 => Just(Call::NoRails),
    ]
    .boxed();
    let moving = prop_oneof![
        4 => (settings(), 0..6_u32).prop_map(|(s, n)| Call::Evolve(s, n)),
        2 => settings().prop_map(Call::Velocity),
        2 => (prop_oneof![Just(0.1), number()], 0..12_u32, 0..2_i32).prop_map(|(s, n, r)| Call::Cycle(s, n, r)),
        1 => integer().prop_map(Call::Take),
        1 => Just(Call::Again),
    ]
    .boxed();
    let telling = prop_oneof![
        6 => (0..13_u32, integer(), integer()).prop_map(|(which, i, j)| Call::Told(which, i, j)),
        3 => (0..5_u32, -1..4_i32, number(), integer(), vector()).prop_map(|(w, f, r, n, v)| Call::Mesher(w, f, r, n % 40, v)),
        1 => (0..4_i32, number(), number(), vector()).prop_map(|(n, p, s, v)| Call::Copies(n, p, s, v)),
        1 => positive().prop_map(Call::Kinds),
        1 => (positive(), any::<u32>()).prop_map(|(d, n)| Call::Covering(d, n)),
        2 => (0..5_u32, -2..4_i32, positive()).prop_map(|(which, f, t)| Call::Texts(which, f, t)),
    ]
    .boxed();
    prop_oneof![1 => making, 3 => setting, 3 => moving, 2 => telling].boxed()
}

fn text_of(text: *const std::ffi::c_char) -> String {
    // SAFETY: the library's texts end with a zero and are valid until this thread's next call.
    if text.is_null() { String::new() } else { unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned() }
}

/// What a refused call must leave as it is: the snake, its rails, what was found, how it would move.
fn picture(snake: *mut ShapeOpSnake) -> (String, c_int, c_int, Vec<u64>) {
    let (mut count, mut velocities) = (0, [0.0; 3 * 16]);
    // SAFETY: room for 16 points.
    unsafe {
        shapeop_snakeVelocity(snake, ptr::null(), velocities.as_mut_ptr(), 16, &mut count, ptr::null_mut());
    }
    let velocities = velocities.map(f64::to_bits).to_vec();
    (text_of(shapeop_snakeText(snake)), shapeop_snakeRailCount(snake), shapeop_snakeFrameCount(snake), velocities)
}

/// Six arcs that can move as a linkage.
fn six_arcs() -> *mut ShapeOpSnake {
    let (one, length, torsions) = ([1.0; 6], [std::f64::consts::FRAC_PI_3; 6], [1.0, -0.7, 0.9, -0.8, 0.6]);
    let (at, along, up) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    // SAFETY: live arrays of the stated lengths.
    unsafe {
        let (one, length, torsions) = (one.as_ptr(), length.as_ptr(), torsions.as_ptr());
        shapeop_snakeCreateFromArcs(one, length, 6, torsions, 5, at.as_ptr(), along.as_ptr(), up.as_ptr())
    }
}

fn options(settings: &Settings, max_steps: c_uint) -> shapeop_snake_options {
    // SAFETY: a struct of numbers.
    let mut options: shapeop_snake_options = unsafe { std::mem::zeroed() };
    options.struct_size = size_of_val(&options) as c_uint;
    // SAFETY: it states its size.
    unsafe { shapeop_snakeDefaultOptions(&mut options) };
    (options.max_steps, options.step, options.max_deviation) = (max_steps, settings.step, settings.deviation);
    [options.tangential, options.offset, options.rotation, options.orthogonal] = settings.weights;
    [options.is_second_order, options.keeps_torsions, options.is_exact, _] = settings.flags;
    options.stops_at_cycle = if settings.flags[3] == 11 { 2 } else { settings.flags[3] % 2 };
    options.mu = 0.01 * settings.mu;
    options
}

/// The snake's control points, each moved by something.
fn moved(snake: *mut ShapeOpSnake, by: f64, numbers: &[f64]) -> Vec<f64> {
    let (mut own, mut count) = (vec![0.0; 3 * 16], 0);
    // SAFETY: room for 16 points.
    unsafe { shapeop_snakeControl(snake, own.as_mut_ptr(), 16, &mut count) };
    own.truncate(3 * count.min(16) as usize);
    own.iter_mut().zip(numbers).for_each(|(number, part)| *number += by * part);
    own
}

/// Makes the call; whether it was carried out, and the numbers that it handed out.
fn make(snake: *mut ShapeOpSnake, call: &Call) -> (bool, Vec<f64>) {
    let (mut room, mut ints) = (vec![0.0; ROOM], vec![0; ROOM]);
    let (mut count, mut other) = (0, 0);
    let (out, to) = (room.as_mut_ptr(), ints.as_mut_ptr());
    let user = ptr::null_mut();
    let nb = |numbers: &[f64], unit: usize| (numbers.len() / unit) as c_int;
    let made = |handle: *mut ShapeOpSnake| {
        shapeop_snakeDelete(handle);
        !handle.is_null()
    };
    // SAFETY: arrays of the stated lengths, structs with their sizes; no capacity is above what there is room for.
    let is_done = unsafe {
        match call {
            // A handle that is made and deleted has the message of the deletion.
            Call::Create(points, closed, first) => {
                made(shapeop_snakeCreate(points.as_ptr(), nb(points, 3), *closed, *first));
                return (last_error(ptr::null_mut()).is_empty(), room);
            }
            Call::Arcs(radii, torsions, point) => {
                let (arcs, turns, at) = (radii.as_ptr(), torsions.as_ptr(), point.as_ptr());
                let (nb_arcs, nb_turns) = (nb(radii, 1), nb(torsions, 1));
                let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
                made(shapeop_snakeCreateFromArcs(arcs, arcs, nb_arcs, turns, nb_turns, at, x.as_ptr(), y.as_ptr()));
                return (last_error(ptr::null_mut()).is_empty(), room);
            }
            Call::Text(text) => {
                let text = CString::new(text.replace('\0', " ")).unwrap();
                made(shapeop_snakeCreateFromText(text.as_ptr()));
                return (last_error(ptr::null_mut()).is_empty(), room);
            }
            Call::Fit(points, closed, arcs, nearness) => {
                let mut options: shapeop_snake_fit_options = std::mem::zeroed();
                options.struct_size = size_of_val(&options) as c_uint;
                shapeop_snakeDefaultFitOptions(&mut options);
                (options.nearness, options.max_iterations, options.is_congruent) = (*nearness, 5, arcs & 1);
                let mut report: shapeop_snake_fit_report = std::mem::zeroed();
                report.struct_size = size_of_val(&report) as c_uint;
                made(shapeop_snakeFit(points.as_ptr(), nb(points, 3), *closed, *arcs, &options, &mut report));
                room[..2].copy_from_slice(&[report.deviation, report.residual]);
                return (last_error(ptr::null_mut()).is_empty(), room);
            }
            Call::Curve(kind, surface, start, tangent, curvatures, length) => {
                let mut report: shapeop_snake_curve_report = std::mem::zeroed();
                report.struct_size = size_of_val(&report) as c_uint;
                let (of, nb_of, start, tangent) = (surface.as_ptr(), nb(surface, 1), start.as_ptr(), tangent.as_ptr());
                let (bends, nb_bends, null) = (curvatures.as_ptr(), nb(curvatures, 1), ptr::null());
                let (capacity, count) = (1000, &mut count);
                let code = shapeop_snakeCurve(
                    *kind,
                    of,
                    nb_of,
                    start,
                    tangent,
                    bends,
                    nb_bends,
                    *length,
                    null,
                    out,
                    capacity,
                    count,
                    &mut report,
                );
                room[4000..4003].copy_from_slice(&[report.length, report.curvature, report.normal_curvature]);
                code == SO_SUCCESS
            }
            Call::MeshCurve(start, tangent, curvature, length) => {
                let square = [-1.0, -1.0, 0.0, 1.0, -1.0, 0.3, 1.0, 1.0, 0.0, -1.0, 1.0, 0.3];
                let (points, faces) = (square.as_ptr(), [0, 1, 2, 3].as_ptr());
                let (start, tangent, null) = (start.as_ptr(), tangent.as_ptr(), ptr::null());
                let (count, report) = (&mut count, ptr::null_mut());
                let code = shapeop_snakeMeshCurve(
                    points, 4, faces, 4, &4, 1, start, tangent, curvature, 1, *length, null, out, 1000, count, report,
                );
                code == SO_SUCCESS
            }
            Call::Control(by, numbers) => {
                let points = moved(snake, *by, numbers);
                shapeop_snakeSetControl(snake, points.as_ptr(), nb(&points, 3)) == SO_SUCCESS
            }
            Call::Project(by, numbers, exact) => {
                let points = moved(snake, *by, numbers);
                let settings = Settings { step: 1.0, deviation: -1.0, weights: [1.0; 4], flags: [0; 4], mu: 0.5 };
                let mut options = options(&settings, 1);
                (options.is_exact, options.projection_iterations) = (*exact, 20);
                let mut report: shapeop_snake_projection = std::mem::zeroed();
                report.struct_size = size_of_val(&report) as c_uint;
                let code = shapeop_snakeProject(snake, points.as_ptr(), nb(&points, 3), &options, &mut report);
                room[..2].copy_from_slice(&[report.residual, report.moved]);
                code == SO_SUCCESS
            }
            Call::Surface(kind, numbers) => {
                let count = [6, 4, 7, 8].get(*kind as usize).map_or(numbers.len(), |count| numbers.len().min(*count));
                // Radii are the last numbers.
                let numbers = [
                    &numbers[..numbers.len().min(3)],
                    &numbers[numbers.len() - (count.saturating_sub(3)).min(numbers.len())..],
                ]
                .concat();
                shapeop_snakeSetSurface(snake, *kind, numbers.as_ptr(), nb(&numbers, 1)) == SO_SUCCESS
            }
            Call::Mesh(points, last) => {
                let indices = [0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, *last];
                shapeop_snakeSetMesh(snake, points.as_ptr(), 9, indices.as_ptr(), 16, &4, 1) == SO_SUCCESS
            }
            Call::NoSurface => shapeop_snakeClearSurface(snake) == SO_SUCCESS,
            Call::Direction(kind, along) => {
                let along = along.as_ref().map_or(ptr::null(), |along| along.as_ptr());
                shapeop_snakeSetDirection(snake, *kind, along) == SO_SUCCESS
            }
            Call::Speeds(speeds) => shapeop_snakeSetSpeeds(snake, speeds.as_ptr(), nb(speeds, 1)) == SO_SUCCESS,
            Call::Fixed(points) => shapeop_snakeSetFixed(snake, points.as_ptr(), points.len() as c_int) == SO_SUCCESS,
            Call::Wish(is_plane, point, vector, weight) => {
                let wish = if *is_plane { shapeop_snakeWishPlane } else { shapeop_snakeWishVelocity };
                wish(snake, *point, vector.as_ptr(), *weight) == SO_SUCCESS
            }
            Call::NoWishes => shapeop_snakeClearWishes(snake) == SO_SUCCESS,
            Call::Rail(which, point, line, speed, leader) => {
                // From where the snake is, as there it begins.
                let mut at = vec![0.0; 3 * 16];
                if *which == 2 {
                    shapeop_snakeContacts(snake, at.as_mut_ptr(), 16, &mut count);
                } else {
                    shapeop_snakeControl(snake, at.as_mut_ptr(), 16, &mut count);
                }
                let first = 3 * (*point).clamp(0, 15) as usize;
                let points: Vec<f64> = at[first..first + 3].iter().chain(line).copied().collect();
                let (line, count) = (points.as_ptr(), nb(&points, 3));
                let code = match which {
                    0 => shapeop_snakeDriveRail(snake, *point, line, count, 0, *speed),
                    1 => shapeop_snakeFollowRail(snake, *point, line, count, 0, *leader),
                    _ => shapeop_snakeGlideRail(snake, *point, line, count, 0),
                };
                code >= 0
            }
            Call::NoRails => shapeop_snakeClearRails(snake) == SO_SUCCESS,
            Call::Evolve(settings, steps) => {
                let mut report: shapeop_snake_evolution = std::mem::zeroed();
                report.struct_size = size_of_val(&report) as c_uint;
                let code = shapeop_snakeEvolve(snake, &options(settings, *steps), None, user, &mut report);
                let numbers = [report.time, report.deviation, report.residual, report.stop_distance];
                room[..4].copy_from_slice(&numbers);
                room[4..6].copy_from_slice(&[report.height_residual, report.incongruence]);
                code == SO_SUCCESS
            }
            Call::Velocity(settings) => {
                shapeop_snakeVelocity(snake, &options(settings, 1), out, 100, &mut count, out.add(3000)) == SO_SUCCESS
            }
            Call::Cycle(step, steps, reversed) => {
                let mut options: shapeop_snake_cycle_options = std::mem::zeroed();
                options.struct_size = size_of_val(&options) as c_uint;
                shapeop_snakeDefaultCycleOptions(&mut options);
                (options.step, options.max_steps, options.is_reversed) = (*step, *steps, *reversed);
                let mut report: shapeop_snake_cycle = std::mem::zeroed();
                report.struct_size = size_of_val(&report) as c_uint;
                let code = shapeop_snakeCycle(snake, &options, None, user, &mut report);
                room[..4].copy_from_slice(&[report.closing, report.residual, report.first_range, report.last_range]);
                code == SO_SUCCESS
            }
            Call::Take(frame) => shapeop_snakeTakeFrame(snake, *frame) == SO_SUCCESS,
            Call::Told(which, i, j) => told(snake, *which, [*i, *j], out, to) == SO_SUCCESS,
            Call::Mesher(which, frame, size, n, along) => {
                let (more, along) = (&mut other, along.as_ptr());
                let (size, count, frame) = (0.2 * *size, &mut count, *frame);
                let code = match which {
                    0 => shapeop_snakeSweepMesh(snake, *n, frame & 1, out, 1000, count, to, 1000, more),
                    1 => shapeop_snakePipe(snake, frame, size, 2, *n, out, 1000, count, to, 1000, more),
                    kind => {
                        let kind = *kind as c_int - 2;
                        shapeop_snakeLamellae(snake, frame, kind, along, size, *n, out, 1000, count, to, 1000, more)
                    }
                };
                code == SO_SUCCESS
            }
            Call::Copies(copies, phase, shift, offset) => {
                let offset = offset.as_ptr();
                shapeop_snakeCopies(snake, *copies, *phase, *shift, offset, out, 1000, &mut count) == SO_SUCCESS
            }
            Call::Covering(distance, n) => {
                let mut options: shapeop_snake_covering_options = std::mem::zeroed();
                options.struct_size = size_of_val(&options) as c_uint;
                shapeop_snakeDefaultCoveringOptions(&mut options);
                (options.distance, options.per_arc, options.comes_back) = (*distance, *n % 9, (*n % 2) as c_int);
                let mut report: shapeop_snake_covering = std::mem::zeroed();
                report.struct_size = size_of_val(&report) as c_uint;
                let code = shapeop_snakeCovering(snake, &options, &mut report);
                room[..3].copy_from_slice(&[report.area, report.coverage, report.largest_deviation]);
                code == SO_SUCCESS
            }
            Call::Kinds(tolerance) => {
                let of = shapeop_snakeKindOf(snake, *tolerance, to, 1000, &mut other);
                shapeop_snakeKinds(snake, *tolerance, out, 1000, &mut count) == SO_SUCCESS && of == SO_SUCCESS
            }
            Call::Texts(which, frame, tolerance) => {
                let text = match which {
                    0 => shapeop_snakeText(snake),
                    1 => shapeop_snakeArcsText(snake, *frame, *tolerance),
                    2 => shapeop_snakeArcsCsv(snake, *frame, *tolerance),
                    3 => shapeop_snakeKindsCsv(snake, *frame, *tolerance),
                    _ => shapeop_snakeArcsDxf(snake, *frame, *tolerance),
                };
                let said = text_of(text);
                if said.contains("NaN") || said.contains("inf") || said.contains("null") {
                    room[0] = f64::NAN;
                }
                !text.is_null()
            }
            Call::Again => {
                let text = CString::new(text_of(shapeop_snakeText(snake))).unwrap();
                made(shapeop_snakeCreateFromText(text.as_ptr()));
                return (last_error(ptr::null_mut()).is_empty(), room);
            }
        }
    };
    (is_done, room)
}

/// # Safety
/// `out` and `to` have room for [`ROOM`] values.
unsafe fn told(snake: *mut ShapeOpSnake, which: u32, [i, j]: [c_int; 2], out: *mut f64, to: *mut c_int) -> shapeop_err {
    let mut number = 0;
    let count = &raw mut number;
    let phases = [0.0, 0.1 * f64::from(i), f64::from(j)];
    // SAFETY: the caller vouches for the room; no capacity is above it.
    unsafe {
        match which {
            0 => shapeop_snakeControl(snake, out, 500, count),
            1 => shapeop_snakeContacts(snake, out, 500, count),
            2 => shapeop_snakeShapes(snake, out, out.add(1000), 500, count),
            3 => shapeop_snakeTorsions(snake, out, 500, count),
            4 => shapeop_snakeArcs(snake, i - 1, out, 300, count),
            5 => shapeop_snakeSample(snake, i - 1, j % 50, out, 500, count),
            6 => shapeop_snakeFreedoms(snake, i % 3, to, to.add(1), if j == 3 { ptr::null_mut() } else { to.add(2) }),
            7 => shapeop_snakeFrames(snake, out, 500, count),
            8 => shapeop_snakeFrameRows(snake, out, 500, count),
            9 => shapeop_snakeCongruence(snake, i, j, out, out.add(1)),
            10 => shapeop_snakeCycleAngles(snake, out, 500, count),
            11 => shapeop_snakeContactPath(snake, i, out, 500, count),
            _ if i == 0 => shapeop_snakeDeterminant(snake, out),
            _ => {
                shapeop_snakeAtPhases(snake, phases.as_ptr(), 3, out, 500, if j == 3 { ptr::null_mut() } else { count })
            }
        }
    }
}

fn run(sequence: &[(usize, Call)], done: &mut Done) -> Result<(), TestCaseError> {
    let snake = six_arcs();
    check(!snake.is_null(), &last_error(ptr::null_mut()))?;
    let stale = shapeop_snakeCopy(snake);
    shapeop_snakeDelete(stale);
    let solver = shapeop_create();
    let mut handles = vec![snake; 12];
    handles.extend([stale, solver.cast(), ptr::null_mut(), ptr::without_provenance_mut(0x7fff_1234)]);
    carry_out(&handles, sequence, make, picture, |picture| !picture.0.contains("null"), done)?;
    shapeop_snakeDelete(snake);
    shapeop_delete(solver);
    Ok(())
}

#[test]
fn no_sequence_of_calls_on_snakes_crashes() {
    let done = run_sequences(SEQUENCES, 31, call(), run);
    // A call that is always refused tests nothing; a text at random is no snake.
    assert!(done.len() == 29 && done.iter().all(|(kind, count)| *count > 0 || kind == "Text"), "{done:?}");
}
