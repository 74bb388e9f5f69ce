//! The C functions of circular arc snakes: what they answer, and what they refuse without a change.

mod abi;

use std::f64::consts::{FRAC_PI_3, PI, TAU};
use std::ffi::{CString, c_int, c_uint, c_void};
use std::ptr;

use abi::{Abi, last_error, text};
use shapeop::capi::shapeop_err::*;
use shapeop::capi::*;

/// A snake's handle; deleted when dropped.
struct Snake(*mut ShapeOpSnake);

impl Drop for Snake {
    fn drop(&mut self) {
        shapeop_snakeDelete(self.0);
    }
}

fn message() -> String {
    last_error(ptr::null_mut())
}

/// Whether the last call was refused for an argument.
fn names(place: &str) -> bool {
    let message = message();
    let found = message.split(':').next() == Some(place);
    assert!(found, "expected {place}, found {message}");
    found
}

/// The call was refused with this code, for this argument.
fn refused(code: shapeop_err, expected: shapeop_err, place: &str) {
    assert_eq!(code, expected, "{}", message());
    assert!(names(place));
}

/// No handle came back, and the argument is named.
fn none(made: *mut ShapeOpSnake, place: &str) {
    assert!(made.is_null(), "{place}");
    assert!(names(place));
}

fn zeroed<T>(set_size: impl FnOnce(&mut T)) -> T {
    // SAFETY: structs of numbers and of enums that have a 0.
    let mut value: T = unsafe { std::mem::zeroed() };
    set_size(&mut value);
    value
}

/// A struct that states its size.
macro_rules! sized {
    ($type:ty) => {
        zeroed::<$type>(|value| value.struct_size = size_of::<$type>() as c_uint)
    };
}

/// The default options of a kind.
macro_rules! defaults {
    ($type:ty, $function:ident) => {{
        let mut options = sized!($type);
        // SAFETY: it states its size.
        assert_eq!(unsafe { $function(&mut options) }, SO_SUCCESS);
        options
    }};
}

/// What a function with a capacity writes, `unit` values for each of its results; one place too few and nothing is
/// written.
fn all<T: Clone + PartialEq + std::fmt::Debug>(
    empty: T,
    unit: usize,
    call: impl Fn(*mut T, c_int, *mut c_int) -> shapeop_err,
) -> Vec<T> {
    let mut count = -7;
    assert_eq!(call(ptr::null_mut(), 0, &mut count), SO_SUCCESS, "{}", message());
    let mut room = vec![empty.clone(); unit * count as usize];
    if count > 0 {
        assert_eq!(call(room.as_mut_ptr(), count - 1, &mut count), SO_SUCCESS, "{}", message());
        assert!(room.iter().all(|value| *value == empty) && room.len() == unit * count as usize);
    }
    assert_eq!(call(room.as_mut_ptr(), count, &mut count), SO_SUCCESS, "{}", message());
    // What else can go wrong with an output.
    assert_eq!(call(room.as_mut_ptr(), -1, &mut count), SO_INVALID_ARGUMENT_LENGTH);
    assert!(message().contains("capacity"), "{}", message());
    assert_eq!(call(room.as_mut_ptr(), 0, ptr::null_mut()), SO_NULL_POINTER);
    assert!(message().contains("count"), "{}", message());
    room
}

fn points(numbers: &[f64]) -> Vec<[f64; 3]> {
    numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    length(minus(a, b))
}

/// A mesh of points and quads, as a function hands it out.
type Mesh = (Vec<[f64; 3]>, Vec<c_int>);

fn mesh(call: impl Fn(*mut f64, c_int, *mut c_int, *mut c_int, c_int, *mut c_int) -> shapeop_err) -> Mesh {
    let (mut count, mut quad_count) = (0, 0);
    let (nothing, none) = (ptr::null_mut(), ptr::null_mut());
    assert_eq!(call(nothing, 0, &mut count, none, 0, &mut quad_count), SO_SUCCESS, "{}", message());
    let (mut at, mut quads) = (vec![0.0; 3 * count as usize], vec![-1; 4 * quad_count as usize]);
    let (to, into) = (at.as_mut_ptr(), quads.as_mut_ptr());
    assert_eq!(call(to, count, &mut count, into, quad_count - 1, &mut quad_count), SO_SUCCESS, "{}", message());
    assert!(quads.iter().all(|i| *i == -1));
    assert_eq!(call(to, count, &mut count, into, quad_count, &mut quad_count), SO_SUCCESS, "{}", message());
    assert!(quads.iter().all(|i| (0..count).contains(i)));
    assert_eq!(call(to, -1, &mut count, into, 0, &mut quad_count), SO_INVALID_ARGUMENT_LENGTH);
    assert_eq!(call(to, 0, &mut count, into, -1, &mut quad_count), SO_INVALID_ARGUMENT_LENGTH);
    assert_eq!(call(to, 0, &mut count, into, 0, ptr::null_mut()), SO_NULL_POINTER);
    (points(&at), quads)
}

const ORIGIN: [f64; 3] = [0.0; 3];
const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];
const NAN: [f64; 3] = [0.0, f64::NAN, 0.0];

/// From the origin along x, bending towards y.
fn from_arcs(radii: &[f64], lengths: &[f64], torsions: &[f64]) -> *mut ShapeOpSnake {
    let (nb, nb_torsions) = (radii.len() as c_int, torsions.len() as c_int);
    let (radii, lengths, torsions) = (radii.as_ptr(), lengths.as_ptr(), torsions.as_ptr());
    let (point, tangent, normal) = (ORIGIN.as_ptr(), X.as_ptr(), Y.as_ptr());
    // SAFETY: live arrays of the stated lengths.
    unsafe { shapeop_snakeCreateFromArcs(radii, lengths, nb, torsions, nb_torsions, point, tangent, normal) }
}

fn made(radii: &[f64], lengths: &[f64], torsions: &[f64]) -> Snake {
    let snake = Snake(from_arcs(radii, lengths, torsions));
    assert!(!snake.0.is_null(), "{}", message());
    snake
}

/// Three arcs that are not flat.
fn twisted() -> Snake {
    made(&[1.0, 2.0, 1.5], &[1.2, 1.5, 1.0], &[0.7, -0.4])
}

/// Five arcs of a circle of radius 2 about (0, 2, 0), in the plane z = 0.
fn flat() -> Snake {
    made(&[2.0; 5], &[0.5; 5], &[0.0; 4])
}

/// The linkage that is known to move around.
fn six_arcs() -> Snake {
    made(&[1.0; 6], &[FRAC_PI_3; 6], &[1.0, -0.7, 0.9, -0.8, 0.6])
}

fn create(control: &[[f64; 3]], is_closed: c_int, first_tangent: f64) -> *mut ShapeOpSnake {
    let flat = control.concat();
    // SAFETY: a live array of the stated length.
    unsafe { shapeop_snakeCreate(flat.as_ptr(), control.len() as c_int, is_closed, first_tangent) }
}

/// The corners of a regular polygon around the unit circle about (0, 0, z).
fn ring(count: usize, z: f64) -> Vec<[f64; 3]> {
    let radius = 1.0 / (PI / count as f64).cos();
    let at = |i: usize| TAU * i as f64 / count as f64;
    (0..count).map(|i| [radius * at(i).cos(), radius * at(i).sin(), z]).collect()
}

fn control(snake: &Snake) -> Vec<[f64; 3]> {
    // SAFETY: `all` gives room for the stated capacity.
    points(&all(0.0, 3, |out, room, count| unsafe { shapeop_snakeControl(snake.0, out, room, count) }))
}

fn contacts(snake: &Snake) -> Vec<[f64; 3]> {
    // SAFETY: `all` gives room for the stated capacity.
    points(&all(0.0, 3, |out, room, count| unsafe { shapeop_snakeContacts(snake.0, out, room, count) }))
}

/// The control points of all frames.
fn frames(snake: &Snake) -> Vec<Vec<[f64; 3]>> {
    // SAFETY: `all` gives room for the stated capacity.
    let all = all(0.0, 3, |out, room, count| unsafe { shapeop_snakeFrames(snake.0, out, room, count) });
    let count = control(snake).len();
    points(&all).chunks_exact(count).map(<[_]>::to_vec).collect()
}

fn report(snake: &Snake) -> shapeop_snake_report {
    let mut report = sized!(shapeop_snake_report);
    // SAFETY: it states its size.
    assert_eq!(unsafe { shapeop_snakeReport(snake.0, &mut report) }, SO_SUCCESS, "{}", message());
    report
}

fn set_surface(snake: &Snake, kind: shapeop_snake_surface, numbers: &[f64]) {
    let count = numbers.len() as c_int;
    // SAFETY: a live array of the stated length.
    let code = unsafe { shapeop_snakeSetSurface(snake.0, kind as c_int, numbers.as_ptr(), count) };
    assert_eq!(code, SO_SUCCESS, "{}", message());
}

fn options() -> shapeop_snake_options {
    defaults!(shapeop_snake_options, shapeop_snakeDefaultOptions)
}

fn evolve(snake: &Snake, options: &shapeop_snake_options) -> shapeop_snake_evolution {
    let mut found = sized!(shapeop_snake_evolution);
    // SAFETY: structs that state their sizes.
    let code = unsafe { shapeop_snakeEvolve(snake.0, options, None, ptr::null_mut(), &mut found) };
    assert_eq!(code, SO_SUCCESS, "{}", message());
    assert_eq!(shapeop_snakeFrameCount(snake.0), found.frame_count as c_int);
    found
}

fn sideways(snake: &Snake) {
    let kind = shapeop_snake_direction::SO_SNAKE_DIRECTION_SIDEWAYS as c_int;
    // SAFETY: null for what does not count.
    assert_eq!(unsafe { shapeop_snakeSetDirection(snake.0, kind, ptr::null()) }, SO_SUCCESS);
}

/// How far a point is from a circle, by its 11 numbers.
fn off_circle(arc: &[f64], point: [f64; 3]) -> f64 {
    let (from, axis) = (minus(point, [arc[0], arc[1], arc[2]]), [arc[4], arc[5], arc[6]]);
    (length(from) - arc[3]).abs().max(dot(from, axis).abs())
}

#[test]
fn a_snake_is_what_its_arcs_say() {
    let (radii, lengths, torsions) = ([1.0, 2.0, 1.5], [1.2, 1.5, 1.0], [0.7, -0.4]);
    let built = made(&radii, &lengths, &torsions);
    // From its control points it is the same again.
    let again = Snake(create(&control(&built), 0, 0.0));
    for snake in [&built, &again] {
        let (mut found_radii, mut found_lengths, mut count) = ([0.0; 3], [0.0; 3], 0);
        let (to, into) = (found_radii.as_mut_ptr(), found_lengths.as_mut_ptr());
        // SAFETY: room for three each; `all` gives room for the stated capacity.
        let found_torsions = unsafe {
            assert_eq!(shapeop_snakeShapes(snake.0, to, into, 2, &mut count), SO_SUCCESS);
            assert_eq!((count, found_radii), (3, [0.0; 3]));
            assert_eq!(shapeop_snakeShapes(snake.0, to, into, 3, &mut count), SO_SUCCESS);
            refused(shapeop_snakeShapes(snake.0, to, into, -3, &mut count), SO_INVALID_ARGUMENT_LENGTH, "capacity");
            all(0.0, 1, |out, room, count| shapeop_snakeTorsions(snake.0, out, room, count))
        };
        let off = |found: &[f64], expected: &[f64]| {
            assert_eq!(found.len(), expected.len());
            found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        assert!(off(&found_radii, &radii) < 1e-12 && off(&found_lengths, &lengths) < 1e-12);
        assert!(off(&found_torsions, &torsions) < 1e-12);
        let report = report(snake);
        assert_eq!((report.arc_count, report.control_count, report.is_closed), (3, 5, 0));
        assert!((report.length - 3.7).abs() < 1e-12 && report.residual < 1e-14 && report.deviation == 0.0);
        // Arcs, contact points and samples tell of the same curve.
        // SAFETY: `all` gives room for the stated capacity.
        let (arcs, samples) = unsafe {
            let now = SHAPEOP_SNAKE_NOW;
            let arcs = all(0.0, 11, |out, room, count| shapeop_snakeArcs(snake.0, now, out, room, count));
            (arcs, all(0.0, 3, |out, room, count| shapeop_snakeSample(snake.0, now, 4, out, room, count)))
        };
        let (samples, contacts) = (points(&samples), contacts(snake));
        assert_eq!((arcs.len(), samples.len(), contacts.len()), (33, 13, 4));
        for (j, arc) in arcs.chunks_exact(11).enumerate() {
            assert!((arc[3] - radii[j]).abs() < 1e-12 && (arc[3] * arc[10] - lengths[j]).abs() < 1e-12);
            assert!(distance([arc[7], arc[8], arc[9]], contacts[j]) < 1e-12);
            assert!(samples[4 * j..=4 * j + 4].iter().all(|p| off_circle(arc, *p) < 1e-12));
            assert!(distance(samples[4 * j + 4], contacts[j + 1]) < 1e-12);
        }
    }
    let point = [1.0, 2.0, 3.0];
    // SAFETY: live arrays; null for what is to be refused.
    unsafe {
        let built = |point: *const f64, tangent: *const f64, normal: *const f64| {
            let (radii, lengths, torsions) = (radii.as_ptr(), lengths.as_ptr(), torsions.as_ptr());
            shapeop_snakeCreateFromArcs(radii, lengths, 3, torsions, 2, point, tangent, normal)
        };
        let moved = Snake(built(point.as_ptr(), Y.as_ptr(), Z.as_ptr()));
        assert_eq!(control(&moved)[0], point);
        none(built(ptr::null(), X.as_ptr(), Y.as_ptr()), "point");
        none(built(NAN.as_ptr(), X.as_ptr(), Y.as_ptr()), "point");
        none(built(point.as_ptr(), ORIGIN.as_ptr(), Y.as_ptr()), "tangent");
        none(built(point.as_ptr(), X.as_ptr(), X.as_ptr()), "normal");
        let nothing = ptr::null();
        let at = point.as_ptr();
        none(shapeop_snakeCreateFromArcs(nothing, lengths.as_ptr(), 3, nothing, 0, at, at, at), "radii");
        none(shapeop_snakeCreateFromArcs(radii.as_ptr(), nothing, 3, nothing, 0, at, at, at), "lengths");
        none(shapeop_snakeCreateFromArcs(radii.as_ptr(), nothing, -1, nothing, 0, at, at, at), "nb_arcs");
    }
    none(from_arcs(&[], &[], &[]), "nb_arcs");
    none(from_arcs(&[1.0, -1.0], &[1.0; 2], &[0.0]), "radii[1]");
    none(from_arcs(&[1.0, 1.0], &[1.0, 3.2], &[0.0]), "radii[1]");
    none(from_arcs(&[1.0, 1.0], &[1.0; 2], &[]), "torsions");
    none(from_arcs(&[1.0, 1.0], &[1.0; 2], &[f64::INFINITY]), "torsions[0]");
}

#[test]
fn closed_snakes_and_what_is_no_snake() {
    let seven = Snake(create(&ring(7, 1.0), 1, 0.0));
    assert_eq!((control(&seven).len(), contacts(&seven).len(), report(&seven).is_closed), (7, 7, 1));
    assert!(contacts(&seven).iter().all(|p| (p[0].hypot(p[1]) - 1.0).abs() < 1e-12 && p[2] == 1.0));
    assert!((report(&seven).length - TAU).abs() < 1e-12);
    // Of an even number the first tangent says which.
    none(create(&ring(8, 0.0), 1, 0.0), "first_tangent");
    let eight = Snake(create(&ring(8, 0.0), 1, (PI / 8.0).tan()));
    assert!((report(&eight).length - TAU).abs() < 1e-12);
    none(create(&ring(8, 0.0), 1, f64::NAN), "first_tangent");
    none(create(&ring(8, 0.0), 1, -0.1), "first_tangent");
    none(create(&ring(7, 0.0), 2, 0.0), "is_closed");
    none(create(&ring(2, 0.0), 0, 0.0), "control");
    none(create(&[ORIGIN, NAN, X], 0, 0.0), "control[1]");
    none(create(&[ORIGIN, X, [2.0, 0.0, 0.0]], 0, 0.0), "control[1]");
    assert_eq!(shapeop_lastErrorCode(ptr::null_mut()), SO_DEGENERATE);
    // SAFETY: null is to be refused.
    unsafe {
        none(shapeop_snakeCreate(ptr::null(), 3, 0, 0.0), "control");
        none(shapeop_snakeCreate(ORIGIN.as_ptr(), -1, 0, 0.0), "nb_control");
    }
}

#[test]
fn handles_are_told_apart() {
    let snake = twisted();
    let copy = Snake(shapeop_snakeCopy(snake.0));
    let before = control(&snake);
    let moved: Vec<f64> = before.iter().flat_map(|p| [p[0], p[1], p[2] + 1.0]).collect();
    // SAFETY: a live array of the stated length, and less of it; null is to be refused.
    unsafe {
        assert_eq!(shapeop_snakeSetControl(snake.0, moved.as_ptr(), 5), SO_SUCCESS, "{}", message());
        refused(shapeop_snakeSetControl(snake.0, moved.as_ptr(), 4), SO_INVALID_ARGUMENT_LENGTH, "control");
        refused(shapeop_snakeSetControl(snake.0, ptr::null(), 5), SO_NULL_POINTER, "control");
        let mut nan = moved.clone();
        nan[7] = f64::NAN;
        refused(shapeop_snakeSetControl(snake.0, nan.as_ptr(), 5), SO_INVALID_VALUE, "control[2]");
    }
    assert_eq!(control(&snake).concat(), moved);
    assert_eq!(control(&copy), before);
    let solver = Abi::new();
    let mut count = 0;
    let stale = shapeop_snakeCopy(snake.0);
    shapeop_snakeDelete(stale);
    shapeop_snakeDelete(ptr::null_mut());
    shapeop_snakeDelete(solver.0.cast());
    for handle in [ptr::null_mut(), stale, solver.0.cast(), ptr::without_provenance_mut(0x7fff_1234)] {
        // SAFETY: one int.
        unsafe {
            refused(shapeop_snakeControl(handle, ptr::null_mut(), 0, &mut count), SO_INVALID_HANDLE, "snake");
        }
        assert!(shapeop_snakeCopy(handle).is_null() && names("snake"));
        assert_eq!(shapeop_snakeRailCount(handle), -1);
        assert!(shapeop_snakeText(handle).is_null());
    }
    assert_eq!(solver.message(), "");
    assert_eq!(shapeop_pointCount(snake.0.cast()), -1, "a snake is no solver");
    assert!(text(shapeop_errorText(SO_NOT_INITIALISED as c_int)).contains("first"));
    let mut report = sized!(shapeop_snake_report);
    report.struct_size = 3;
    // SAFETY: the size is refused.
    unsafe {
        refused(shapeop_snakeReport(snake.0, &mut report), SO_INVALID_VALUE, "report->struct_size");
        refused(shapeop_snakeReport(snake.0, ptr::null_mut()), SO_NULL_POINTER, "report");
    }
}

#[test]
fn freedoms_in_space_and_on_a_surface() {
    let snake = twisted();
    let (mut free, mut conditions, mut rank) = (0, 0, 0);
    // SAFETY: ints, or null.
    unsafe {
        let code = shapeop_snakeFreedoms(snake.0, 0, &mut free, &mut conditions, &mut rank);
        assert_eq!((code, free, conditions, rank), (SO_SUCCESS, 8, 7, 7));
        let null = ptr::null_mut();
        refused(shapeop_snakeFreedoms(snake.0, 1, &mut free, null, null), SO_NOT_INITIALISED, "surface");
        refused(shapeop_snakeFreedoms(snake.0, 2, &mut free, null, null), SO_INVALID_VALUE, "on_surface");
        set_surface(&snake, shapeop_snake_surface::SO_SNAKE_SURFACE_SPHERE, &[0.3, 0.1, 0.2, 1.0]);
        assert_eq!(shapeop_snakeFreedoms(snake.0, 1, &mut free, null, null), SO_SUCCESS);
        assert_eq!(free, 3);
    }
}

#[test]
fn surfaces_are_named_or_meshes() {
    let snake = flat();
    let kinds = [
        (shapeop_snake_surface::SO_SNAKE_SURFACE_PLANE, vec![0.0, 0.0, 0.25, 0.0, 0.0, 2.0], 0.25),
        (shapeop_snake_surface::SO_SNAKE_SURFACE_SPHERE, vec![0.0, 2.0, 0.0, 2.5], 0.5),
        (shapeop_snake_surface::SO_SNAKE_SURFACE_CYLINDER, vec![0.0, 2.0, 9.0, 0.0, 0.0, 1.0, 1.9], 0.1),
        (shapeop_snake_surface::SO_SNAKE_SURFACE_TORUS, vec![0.0, 2.0, 0.0, 0.0, 0.0, -1.0, 2.0, 0.3], 0.3),
    ];
    for (kind, numbers, expected) in kinds {
        set_surface(&snake, kind, &numbers);
        let found = report(&snake).deviation;
        assert!((found - expected).abs() < 1e-12, "{kind:?}: {found}");
        let count = numbers.len() as c_int;
        let bad: Vec<f64> = numbers.iter().map(|_| f64::NAN).collect();
        // SAFETY: live arrays of the stated lengths.
        unsafe {
            let set = |numbers: *const f64, count| shapeop_snakeSetSurface(snake.0, kind as c_int, numbers, count);
            refused(set(numbers.as_ptr(), count - 1), SO_INVALID_ARGUMENT_LENGTH, "nb_numbers");
            refused(set(bad.as_ptr(), count), SO_INVALID_VALUE, "numbers[0]");
            refused(set(ptr::null(), count), SO_NULL_POINTER, "numbers");
        }
    }
    // SAFETY: live arrays of the stated lengths.
    unsafe {
        refused(shapeop_snakeSetSurface(snake.0, 4, ORIGIN.as_ptr(), 3), SO_INVALID_VALUE, "kind");
        let (square, quad) = ([-9.0, -9.0, 0.5, 9.0, -9.0, 0.5, 9.0, 9.0, 0.5, -9.0, 9.0, 0.5], [0, 1, 2, 3]);
        let mesh = |indices: &[c_int; 4], count| {
            shapeop_snakeSetMesh(snake.0, square.as_ptr(), 4, indices.as_ptr(), 4, &count, 1)
        };
        assert_eq!(mesh(&quad, 4), SO_SUCCESS, "{}", message());
        assert!((report(&snake).deviation - 0.5).abs() < 1e-12);
        refused(mesh(&[0, 1, 2, 4], 4), SO_INDEX_OUT_OF_RANGE, "faces[0][3]");
        assert_eq!(mesh(&quad, 3), SO_INVALID_ARGUMENT_LENGTH);
        assert!((report(&snake).deviation - 0.5).abs() < 1e-12);
    }
    assert_eq!(shapeop_snakeClearSurface(snake.0), SO_SUCCESS);
    assert_eq!(report(&snake).deviation, 0.0);
}

#[test]
fn a_snake_in_a_plane_moves_rigidly_in_it() {
    let snake = flat();
    set_surface(&snake, shapeop_snake_surface::SO_SNAKE_SURFACE_PLANE, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    sideways(&snake);
    let mut residual = -1.0;
    let (null, off) = (ptr::null(), &raw mut residual);
    // SAFETY: `all` gives room for the stated capacity; one double.
    let velocities =
        points(&all(0.0, 3, |out, room, count| unsafe { shapeop_snakeVelocity(snake.0, null, out, room, count, off) }));
    assert!((0.0..1e-12).contains(&residual) && velocities.iter().all(|v| v[2].abs() < 1e-9 && length(*v) > 0.1));
    let own = shapeop_snake_options { max_steps: 6, step: 0.02, ..options() };
    let found = evolve(&snake, &own);
    assert_eq!((found.stop, found.stop_rail, found.frame_count), (shapeop_snake_stop::SO_SNAKE_STOP_STEPS, -1, 7));
    assert!((found.time - 0.12).abs() < 1e-12 && found.residual < 1e-12 && found.deviation < 1e-12);
    let at = frames(&snake);
    assert_eq!((at.len(), &at[0]), (7, &control(&snake)));
    assert!(at.iter().flatten().all(|p| p[2].abs() < 1e-12) && distance(at[6][0], at[0][0]) > 0.05);
    // SAFETY: `all` gives room for the stated capacity; doubles, or null.
    unsafe {
        let rows = all(0.0, 6, |out, room, count| shapeop_snakeFrameRows(snake.0, out, room, count));
        assert!(rows.chunks_exact(6).enumerate().all(|(k, row)| (row[0] - 0.02 * k as f64).abs() < 1e-12));
        let (mut rms, mut apart) = (1.0, 1.0);
        assert_eq!(shapeop_snakeCongruence(snake.0, 0, 6, &mut rms, &mut apart), SO_SUCCESS);
        assert!(rms < 1e-12 && apart < 1e-12, "{rms} {apart}");
        let nothing = ptr::null_mut();
        assert_eq!(shapeop_snakeCongruence(snake.0, 2, 2, nothing, nothing), SO_SUCCESS);
        refused(shapeop_snakeCongruence(snake.0, 0, 7, &mut rms, nothing), SO_INDEX_OUT_OF_RANGE, "b");
        refused(shapeop_snakeCongruence(snake.0, -1, 0, &mut rms, nothing), SO_INDEX_OUT_OF_RANGE, "a");
        // A rigid motion keeps samples where they are on the snake.
        let sample = all(0.0, 3, |out, room, count| shapeop_snakeSample(snake.0, 6, 3, out, room, count));
        let center = [at[6][0], at[6][1]].map(|p| [p[0], p[1]]);
        assert!(sample.len() == 48 && center[0] != center[1]);
        let mut count = 0;
        let (room, none) = (ptr::null_mut(), 0);
        refused(shapeop_snakeSample(snake.0, 7, 3, room, none, &mut count), SO_INDEX_OUT_OF_RANGE, "frame");
        refused(shapeop_snakeSample(snake.0, 6, 0, room, none, &mut count), SO_INVALID_VALUE, "per_arc");
        refused(shapeop_snakeArcs(snake.0, -2, room, none, &mut count), SO_INDEX_OUT_OF_RANGE, "frame");
    }
    // From the last position it goes on.
    refused(shapeop_snakeTakeFrame(snake.0, 7), SO_INDEX_OUT_OF_RANGE, "frame");
    assert_eq!(shapeop_snakeTakeFrame(snake.0, 6), SO_SUCCESS);
    assert_eq!(control(&snake), at[6]);
    assert_eq!(shapeop_snakeFrameCount(snake.0), -1);
    assert_eq!(shapeop_lastErrorCode(ptr::null_mut()), SO_NOT_INITIALISED);
    // From the equator of a torus it does not stay on it.
    let snake = flat();
    let torus = [0.0, 2.0, 0.0, 0.0, 0.0, 1.0, 1.6, 0.4];
    set_surface(&snake, shapeop_snake_surface::SO_SNAKE_SURFACE_TORUS, &torus);
    sideways(&snake);
    let found = evolve(&snake, &shapeop_snake_options { max_steps: 1000, max_deviation: 0.002, ..own });
    assert_eq!(found.stop, shapeop_snake_stop::SO_SNAKE_STOP_DEVIATION);
    assert!(found.stop_distance > 0.002 && found.deviation <= 0.002 && found.frame_count > 1, "{found:?}");
}

/// Notes steps, and stops at one of them.
struct Watch {
    snake: *mut ShapeOpSnake,
    steps: Vec<c_uint>,
    times: Vec<f64>,
    angles: Vec<f64>,
    stop_at: c_uint,
    was_busy: bool,
}

unsafe extern "C" fn watch(progress: *const shapeop_snake_progress, user: *mut c_void) -> c_int {
    // SAFETY: the test passes these.
    let (now, watch) = unsafe { (&*progress, &mut *user.cast::<Watch>()) };
    watch.steps.push(now.step);
    watch.times.push(now.time);
    watch.angles.push(now.first_angle);
    watch.was_busy = shapeop_snakeTakeFrame(watch.snake, 0) == SO_BUSY && (0.0..=1.0).contains(&now.fraction);
    c_int::from(now.step >= watch.stop_at)
}

fn watching(snake: &Snake, stop_at: c_uint) -> Watch {
    Watch { snake: snake.0, steps: vec![], times: vec![], angles: vec![], stop_at, was_busy: false }
}

#[test]
fn a_run_is_watched_and_cancelled() {
    let snake = twisted();
    let (along, up) = (shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int, Z);
    let (mut watching, mut found) = (watching(&snake, 3), sized!(shapeop_snake_evolution));
    // SAFETY: live vectors and structs; the callback gets what it expects.
    unsafe {
        assert_eq!(shapeop_snakeSetDirection(snake.0, along, up.as_ptr()), SO_SUCCESS);
        let user = (&raw mut watching).cast();
        assert_eq!(shapeop_snakeEvolve(snake.0, ptr::null(), Some(watch), user, &mut found), SO_SUCCESS);
    }
    assert_eq!((found.stop, found.frame_count), (shapeop_snake_stop::SO_SNAKE_STOP_CANCELLED, 4));
    assert!(watching.was_busy && watching.steps == [0, 1, 2, 3] && watching.times[3] == found.time);
    assert_eq!(message(), "");
}

#[test]
fn bad_options_are_named() {
    let snake = twisted();
    type Change = fn(&mut shapeop_snake_options);
    let changes: [(&str, Change); 16] = [
        ("options->step", |options| options.step = 0.0),
        ("options->step", |options| options.step = f64::NAN),
        ("options->least_step", |options| options.least_step = 2.0),
        ("options->max_deviation", |options| options.max_deviation = f64::NAN),
        ("options->tangential", |options| options.tangential = -1.0),
        ("options->offset", |options| options.offset = f64::INFINITY),
        ("options->rotation", |options| options.rotation = f64::NAN),
        ("options->orthogonal", |options| options.orthogonal = -0.1),
        ("options->alpha", |options| options.alpha = 0.0),
        ("options->mu", |options| options.mu = 0.0),
        ("options->surface_weight", |options| options.surface_weight = -1.0),
        ("options->is_second_order", |options| options.is_second_order = 2),
        ("options->keeps_torsions", |options| options.keeps_torsions = -1),
        ("options->stops_at_cycle", |options| options.stops_at_cycle = 7),
        ("options->is_exact", |options| options.is_exact = 3),
        ("options->struct_size", |options| options.struct_size = 11),
    ];
    let (mut out, mut count) = ([0.0; 15], 0);
    for (place, change) in changes {
        let mut own = options();
        change(&mut own);
        let null = ptr::null_mut();
        // SAFETY: a live struct; room for five points.
        unsafe {
            refused(shapeop_snakeEvolve(snake.0, &own, None, null, ptr::null_mut()), SO_INVALID_VALUE, place);
            let (to, count) = (out.as_mut_ptr(), &raw mut count);
            refused(shapeop_snakeVelocity(snake.0, &own, to, 5, count, ptr::null_mut()), SO_INVALID_VALUE, place);
        }
    }
    assert_eq!((out, count), ([0.0; 15], 0));
    // Sideways needs a surface; a closed snake of five arcs is rigid.
    sideways(&snake);
    // SAFETY: null for what is left out.
    unsafe {
        let (null, none) = (ptr::null(), ptr::null_mut());
        refused(shapeop_snakeEvolve(snake.0, null, None, none, ptr::null_mut()), SO_INVALID_VALUE, "direction");
        let rigid = Snake(create(&ring(5, 0.0), 1, 0.0));
        let code = shapeop_snakeEvolve(rigid.0, null, None, none, ptr::null_mut());
        refused(code, SO_INVALID_ARGUMENT_LENGTH, "snake");
        let code = shapeop_snakeDefaultOptions(ptr::null_mut());
        refused(code, SO_NULL_POINTER, "options");
    }
}

#[test]
fn wishes_move_the_points_that_they_are_for() {
    let snake = twisted();
    // SAFETY: live vectors and arrays, or null that is to be refused.
    unsafe {
        assert_eq!(shapeop_snakeSetFixed(snake.0, [0].as_ptr(), 1), SO_SUCCESS, "{}", message());
        assert_eq!(shapeop_snakeWishVelocity(snake.0, 4, Z.as_ptr(), 1.0), SO_SUCCESS, "{}", message());
        let velocities = || {
            let null = ptr::null();
            points(&all(0.0, 3, |out, room, count| {
                shapeop_snakeVelocity(snake.0, null, out, room, count, ptr::null_mut())
            }))
        };
        let found = velocities();
        assert!(length(found[0]) < 1e-9 && distance(found[4], Z) < 1e-6, "{found:?}");
        // In a plane, and of the wish what is left in it.
        assert_eq!(shapeop_snakeWishPlane(snake.0, 4, [0.0, 5.0, 5.0].as_ptr(), 1e6), SO_SUCCESS);
        let found = velocities();
        assert!((found[4][1] + found[4][2]).abs() < 1e-3 && (found[4][2] - 0.5).abs() < 0.2, "{:?}", found[4]);
        assert_eq!(shapeop_snakeClearWishes(snake.0), SO_SUCCESS);
        assert!(velocities().iter().all(|v| length(*v) < 1e-9));
        let (along, speeds) = (shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int, [2.0, 2.0, 2.0, 2.0, 2.0]);
        assert_eq!(shapeop_snakeSetFixed(snake.0, ptr::null(), 0), SO_SUCCESS);
        assert_eq!(shapeop_snakeSetDirection(snake.0, along, Y.as_ptr()), SO_SUCCESS);
        assert_eq!(shapeop_snakeSetSpeeds(snake.0, speeds.as_ptr(), 5), SO_SUCCESS);
        assert!(velocities().iter().all(|v| distance(*v, [0.0, 2.0, 0.0]) < 1e-6), "{:?}", velocities());

        refused(shapeop_snakeSetFixed(snake.0, [0, 5].as_ptr(), 2), SO_INDEX_OUT_OF_RANGE, "points[1]");
        refused(shapeop_snakeSetFixed(snake.0, [1, 1].as_ptr(), 2), SO_INVALID_VALUE, "points[1]");
        refused(shapeop_snakeSetFixed(snake.0, [-1].as_ptr(), 1), SO_INDEX_OUT_OF_RANGE, "points[0]");
        refused(shapeop_snakeSetFixed(snake.0, ptr::null(), 1), SO_NULL_POINTER, "points");
        refused(shapeop_snakeWishVelocity(snake.0, 5, Z.as_ptr(), 1.0), SO_INDEX_OUT_OF_RANGE, "point");
        refused(shapeop_snakeWishVelocity(snake.0, -1, Z.as_ptr(), 1.0), SO_INDEX_OUT_OF_RANGE, "point");
        refused(shapeop_snakeWishVelocity(snake.0, 0, NAN.as_ptr(), 1.0), SO_INVALID_VALUE, "velocity");
        refused(shapeop_snakeWishVelocity(snake.0, 0, ptr::null(), 1.0), SO_NULL_POINTER, "velocity");
        refused(shapeop_snakeWishVelocity(snake.0, 0, Z.as_ptr(), -1.0), SO_INVALID_VALUE, "weight");
        refused(shapeop_snakeWishPlane(snake.0, 0, ORIGIN.as_ptr(), 1.0), SO_INVALID_VALUE, "normal");
        refused(shapeop_snakeWishPlane(snake.0, 0, Z.as_ptr(), f64::NAN), SO_INVALID_VALUE, "weight");
        refused(shapeop_snakeSetDirection(snake.0, 3, Z.as_ptr()), SO_INVALID_VALUE, "kind");
        refused(shapeop_snakeSetDirection(snake.0, along, ptr::null()), SO_NULL_POINTER, "along");
        refused(shapeop_snakeSetDirection(snake.0, along, ORIGIN.as_ptr()), SO_INVALID_VALUE, "along");
        refused(shapeop_snakeSetSpeeds(snake.0, speeds.as_ptr(), 2), SO_INVALID_ARGUMENT_LENGTH, "nb_speeds");
        refused(shapeop_snakeSetSpeeds(snake.0, NAN.as_ptr().add(1), 1), SO_INVALID_VALUE, "speeds[0]");
    }
    // What was refused changed nothing.
    let found = evolve(&snake, &shapeop_snake_options { max_steps: 1, ..options() });
    assert!(distance(frames(&snake)[1][0], [0.0, 2.0 * found.time, 0.0]) < 1e-6);
}

#[test]
fn projections_keep_distances_and_are_near() {
    let snake = twisted();
    let before = control(&snake);
    let noise = |i: usize, k: usize| 0.02 * ((7 * i + 3 * k) as f64).sin();
    let target: Vec<f64> = before.iter().enumerate().flat_map(|(i, p)| [0, 1, 2].map(|k| p[k] + noise(i, k))).collect();
    let own = shapeop_snake_options { is_exact: 1, ..options() };
    let mut told = sized!(shapeop_snake_projection);
    // SAFETY: live arrays and structs.
    unsafe {
        assert_eq!(shapeop_snakeProject(snake.0, target.as_ptr(), 5, &own, &mut told), SO_SUCCESS, "{}", message());
        assert!(told.residual < 1e-12 && told.is_nearest == 1 && told.moved > 1e-3 && told.moved < 0.05, "{told:?}");
        assert!(report(&snake).residual < 1e-12);
        let off = |at: &[[f64; 3]]| at.iter().zip(points(&target)).map(|(a, b)| distance(*a, b).powi(2)).sum::<f64>();
        let nearest = off(&control(&snake));
        assert!(nearest < off(&before));
        // The paper's is near it, and no nearer.
        let other = twisted();
        let null = ptr::null();
        assert_eq!(shapeop_snakeProject(other.0, target.as_ptr(), 5, null, ptr::null_mut()), SO_SUCCESS);
        assert!(off(&control(&other)) >= nearest * (1.0 - 1e-9) && off(&control(&other)) < 1.01 * nearest);
        let after = control(&snake);
        refused(
            shapeop_snakeProject(snake.0, target.as_ptr(), 4, &own, &mut told),
            SO_INVALID_ARGUMENT_LENGTH,
            "nb_target",
        );
        refused(shapeop_snakeProject(snake.0, ptr::null(), 5, &own, &mut told), SO_NULL_POINTER, "target");
        let mut nan = target.clone();
        nan[4] = f64::NAN;
        refused(shapeop_snakeProject(snake.0, nan.as_ptr(), 5, &own, &mut told), SO_INVALID_VALUE, "target[1]");
        let bad = shapeop_snake_options { mu: -1.0, ..own };
        refused(shapeop_snakeProject(snake.0, target.as_ptr(), 5, &bad, &mut told), SO_INVALID_VALUE, "options->mu");
        assert_eq!(control(&snake), after);
    }
}

fn rail(
    call: unsafe extern "C" fn(*mut ShapeOpSnake, c_int, *const f64, c_int, c_int, f64) -> c_int,
    snake: &Snake,
    point: c_int,
    line: &[[f64; 3]],
    speed: f64,
) -> c_int {
    let flat = line.concat();
    // SAFETY: a live array of the stated length.
    unsafe { call(snake.0, point, flat.as_ptr(), line.len() as c_int, 0, speed) }
}

/// Intervals of rails.
const ON_RAIL: c_int = 240;

/// Points of the circle about the z axis through a point, from an angle before it to one after.
fn around([x, y, z]: [f64; 3], angles: [f64; 2]) -> Vec<[f64; 3]> {
    let at = |k: i32| {
        let angle = angles[0] + (angles[1] - angles[0]) * f64::from(k) / f64::from(ON_RAIL);
        let (sine, cosine) = angle.sin_cos();
        [cosine * x - sine * y, sine * x + cosine * y, z]
    };
    (0..=ON_RAIL).map(at).collect()
}

#[test]
fn rails_lead_a_snake() {
    let snake = made(&[1.0, 2.0, 1.5], &[1.2, 1.5, 1.0], &[0.7, -0.4]);
    let moved: Vec<f64> = control(&snake).iter().flat_map(|p| [p[0] + 4.0, p[1], p[2]]).collect();
    // SAFETY: a live array of the stated length.
    unsafe { assert_eq!(shapeop_snakeSetControl(snake.0, moved.as_ptr(), 5), SO_SUCCESS) };
    let (at, middle) = (control(&snake), contacts(&snake)[1]);
    // Both ends and a contact point turn about the z axis: so does the snake, rigidly.
    let [first, last, inner] = [at[0], at[4], middle].map(|point| around(point, [-0.25, 0.75]));
    assert_eq!(rail(shapeop_snakeDriveRail, &snake, 0, &first, at[0][0]), 0, "{}", message());
    let (flat_last, flat_inner) = (last.concat(), inner.concat());
    // SAFETY: live arrays of the stated lengths.
    unsafe {
        assert_eq!(shapeop_snakeFollowRail(snake.0, 4, flat_last.as_ptr(), ON_RAIL + 1, 0, 0), 1, "{}", message());
        assert_eq!(shapeop_snakeGlideRail(snake.0, 1, flat_inner.as_ptr(), ON_RAIL + 1, 0), 2, "{}", message());
    }
    assert_eq!(shapeop_snakeRailCount(snake.0), 3);
    let own = shapeop_snake_options { keeps_torsions: 1, step: 0.05, max_steps: 100, ..options() };
    let found = evolve(&snake, &own);
    assert_eq!((found.stop, found.stop_rail), (shapeop_snake_stop::SO_SNAKE_STOP_RAIL_END, 0), "{found:?}");
    let last_frame = found.frame_count as c_int - 1;
    let (mut rms, mut apart) = (1.0, 1.0);
    // SAFETY: doubles.
    unsafe { assert_eq!(shapeop_snakeCongruence(snake.0, 0, last_frame, &mut rms, &mut apart), SO_SUCCESS) };
    assert!(rms < 1e-6 && last_frame > 5, "{rms} {found:?}");
    let frames = frames(&snake);
    let (end, from) = (frames[last_frame as usize][0], at[0]);
    let angle = (from[0] * end[1] - from[1] * end[0]).atan2(from[0] * end[0] + from[1] * end[1]);
    assert!(angle > 0.7 && frames.iter().all(|frame| (frame[0][0].hypot(frame[0][1]) - 4.0).abs() < 1e-6), "{angle}");

    let line = [at[0], [at[0][0], at[0][1] + 1.0, at[0][2]]];
    let drive = |point, line: &[[f64; 3]], speed, place: &str| {
        assert_eq!(rail(shapeop_snakeDriveRail, &snake, point, line, speed), -1);
        assert!(names(place));
    };
    drive(0, &line, 1.0, "point");
    drive(9, &line, 1.0, "point");
    drive(-1, &line, 1.0, "point");
    drive(1, &line, 1.0, "points");
    drive(1, &line, f64::NAN, "speed");
    drive(1, &line[..1], 1.0, "points");
    drive(1, &[at[1], NAN], 1.0, "points[1]");
    let at_vertex = [at[1], at[2]].concat();
    // SAFETY: live arrays of the stated lengths, or null.
    unsafe {
        assert_eq!(shapeop_snakeFollowRail(snake.0, 1, at_vertex.as_ptr(), 2, 0, 1), -1);
        assert!(names("leader"));
        assert_eq!(shapeop_snakeFollowRail(snake.0, 1, at_vertex.as_ptr(), 2, 0, -1), -1);
        assert!(names("leader"));
        assert_eq!(shapeop_snakeGlideRail(snake.0, 4, at_vertex.as_ptr(), 2, 0), -1);
        assert!(names("contact"));
        assert_eq!(shapeop_snakeGlideRail(snake.0, 0, ptr::null(), 2, 0), -1);
        assert!(names("points"));
        assert_eq!(shapeop_snakeGlideRail(snake.0, 0, at_vertex.as_ptr(), 2, 3), -1);
        assert!(names("is_closed"));
        let along = [at[0], at[1]].concat();
        assert_eq!(shapeop_snakeGlideRail(snake.0, 0, along.as_ptr(), 2, 0), -1);
        assert!(names("points") && shapeop_lastErrorCode(ptr::null_mut()) == SO_DEGENERATE);
    }
    assert_eq!(shapeop_snakeRailCount(snake.0), 3);
    assert_eq!(shapeop_snakeClearRails(snake.0), SO_SUCCESS);
    assert_eq!(shapeop_snakeRailCount(snake.0), 0);
}

#[test]
fn curves_of_constant_curvature_on_a_sphere_are_circles_and_snakes_fit_them() {
    let (kind, sphere) = (shapeop_snake_surface::SO_SNAKE_SURFACE_SPHERE as c_int, [0.0, 0.0, 0.0, 2.0]);
    let (start, tangent) = ([2.0, 0.0, 0.0], [0.0, 1.0, 1.0]);
    let curve = |curvatures: &[f64], length: f64, options: *const shapeop_snake_curve_options, room: &mut [f64]| {
        let (nb, capacity, mut count) = (curvatures.len() as c_int, room.len() as c_int / 3, -1);
        let mut told = sized!(shapeop_snake_curve_report);
        // SAFETY: live arrays of the stated lengths, live structs.
        let code = unsafe {
            let (start, tangent) = (start.as_ptr(), tangent.as_ptr());
            let (at, to) = (curvatures.as_ptr(), room.as_mut_ptr());
            let (count, told, sphere) = (&raw mut count, &raw mut told, sphere.as_ptr());
            shapeop_snakeCurve(kind, sphere, 4, start, tangent, at, nb, length, options, to, capacity, count, told)
        };
        (code, count, told)
    };
    let mut room = vec![0.0; 3 * 202];
    let null = ptr::null();
    let (code, count, told) = curve(&[0.8], 3.0, null, &mut room);
    assert_eq!((code, count), (SO_SUCCESS, 201), "{}", message());
    let at = points(&room[..603]);
    assert!(told.end == shapeop_snake_curve_end::SO_SNAKE_CURVE_LENGTH && (told.length - 3.0).abs() < 1e-12);
    assert!(at.iter().all(|p| (length(*p) - 2.0).abs() < 1e-9));
    let chord = 2.0 / 0.8 * (0.5 * 3.0 * 0.8_f64).sin();
    assert!((distance(at[0], at[200]) - chord).abs() < 1e-6);
    // One arc is all there is of it.
    let mut fitted = sized!(shapeop_snake_fit_report);
    // SAFETY: live arrays of the stated lengths, live structs.
    let fit = |points: *const f64, nb, closed, arcs, options, report| unsafe {
        shapeop_snakeFit(points, nb, closed, arcs, options, report)
    };
    let snake = Snake(fit(room.as_ptr(), 201, 0, 2, null.cast(), &raw mut fitted));
    assert!(!snake.0.is_null() && fitted.deviation < 1e-6 && fitted.residual < 1e-12, "{} {fitted:?}", message());
    assert!((report(&snake).length - 3.0).abs() < 1e-5);
    // The other side is the mirror image; where the sphere bends more there is none.
    let mut own = defaults!(shapeop_snake_curve_options, shapeop_snakeDefaultCurveOptions);
    own.turns_right = 1;
    let mut right = vec![0.0; 603];
    assert_eq!(curve(&[0.8], 3.0, &own, &mut right).1, 201);
    let mirrored = points(&right);
    assert!(mirrored.iter().zip(&at).all(|(a, b)| (a[0] - b[0]).abs() < 1e-6));
    assert!(distance(mirrored[200], at[200]) > 0.5);
    let untouched = room.clone();
    let (code, count, _) = curve(&[0.4], 3.0, null, &mut room);
    assert_eq!((code, count), (SO_NO_SOLUTION, -1));
    assert!(names("curvatures") && room == untouched);
    // Along the way it ends there, and says how much each bends.
    let (code, _, told) = curve(&[0.9, 0.1], 3.0, null, &mut room);
    assert_eq!(code, SO_SUCCESS);
    assert_eq!(told.end, shapeop_snake_curve_end::SO_SNAKE_CURVE_BENDS_MORE);
    assert!(told.curvature < 0.5 && (told.normal_curvature.abs() - 0.5).abs() < 1e-6 && told.length < 2.0, "{told:?}");
    for (curvatures, length, place) in [
        (&[][..], 1.0, "nb_curvatures"),
        (&[1.0, -1.0], 1.0, "curvatures[1]"),
        (&[f64::NAN], 1.0, "curvatures[0]"),
        (&[1.0], 0.0, "length"),
        (&[1.0], f64::INFINITY, "length"),
    ] {
        assert_ne!(curve(curvatures, length, null, &mut room).0, SO_SUCCESS);
        assert!(names(place));
    }
    own.steps = 0;
    assert_eq!(curve(&[1.0], 1.0, &own, &mut room).0, SO_INVALID_VALUE);
    assert!(names("options->steps"));
    (own.steps, own.method) = (20, 2);
    assert_eq!(curve(&[1.0], 1.0, &own, &mut room).0, SO_INVALID_VALUE);
    assert!(names("options->method"));
    none(fit(room.as_ptr(), 2, 0, 2, null.cast(), ptr::null_mut()), "points");
    none(fit(room.as_ptr(), 9, 0, 0, null.cast(), ptr::null_mut()), "nb_arcs");
    none(fit(room.as_ptr(), 9, 2, 1, null.cast(), ptr::null_mut()), "is_closed");
    none(fit(null.cast(), 9, 0, 1, null.cast(), ptr::null_mut()), "points");
    let mut own = defaults!(shapeop_snake_fit_options, shapeop_snakeDefaultFitOptions);
    own.nearness = 0.0;
    none(fit(room.as_ptr(), 9, 0, 1, &raw const own, ptr::null_mut()), "options->nearness");
    (own.nearness, own.curvature) = (0.005, f64::NAN);
    none(fit(room.as_ptr(), 9, 0, 1, &raw const own, ptr::null_mut()), "options->curvature");
}

#[test]
fn curves_on_a_mesh_end_at_its_boundary() {
    // A plane as a mesh of quads.
    let at = |k: c_int| f64::from(k) / 5.0 - 1.0;
    let grid: Vec<f64> = (0..121).flat_map(|k| [at(k % 11), at(k / 11), 0.0]).collect();
    let quads: Vec<c_int> = (0..110).filter(|k| (k + 1) % 11 != 0).flat_map(|k| [k, k + 1, k + 12, k + 11]).collect();
    let trace = |start: [f64; 3], tangent: [f64; 3], curvature: f64, room: &mut [f64]| {
        let (mut told, mut count) = (sized!(shapeop_snake_curve_report), 0);
        let capacity = room.len() as c_int / 3;
        // SAFETY: live arrays of the stated lengths, live structs.
        let code = unsafe {
            let (start, tangent, null, to) = (start.as_ptr(), tangent.as_ptr(), ptr::null(), room.as_mut_ptr());
            let nb = quads.len() as c_int;
            let (points, faces, corners) = (grid.as_ptr(), quads.as_ptr(), &4);
            let (at, count, told) = (&curvature, &raw mut count, &raw mut told);
            shapeop_snakeMeshCurve(
                points, 121, faces, nb, corners, 1, start, tangent, at, 1, 2.0, null, to, capacity, count, told,
            )
        };
        (code, count, told)
    };
    let mut room = vec![0.0; 3 * 202];
    let (code, count, told) = trace([0.1, -0.3, 0.0], [1.0, 0.2, 0.0], 2.0, &mut room);
    assert_eq!((code, count, told.end), (SO_SUCCESS, 201, shapeop_snake_curve_end::SO_SNAKE_CURVE_LENGTH));
    let found = points(&room);
    let chord = 2.0 * 0.5 * (2.0_f64).sin();
    assert!((distance(found[0], found[200]) - chord).abs() < 1e-6 && found.iter().all(|p| p[2].abs() < 1e-12));
    let (code, count, told) = trace([0.1, 0.0, 0.0], X, 0.0, &mut room);
    assert_eq!((code, told.end), (SO_SUCCESS, shapeop_snake_curve_end::SO_SNAKE_CURVE_BOUNDARY));
    assert!((told.length - 0.9).abs() < 1e-9 && count == 92, "{told:?} {count}");
    assert_eq!(trace([0.1, 0.0, 9.0], X, 0.0, &mut room).0, SO_OUT_OF_DOMAIN);
    assert!(names("start"));
    assert_eq!(trace([0.1, 0.0, 0.0], Z, 0.0, &mut room).0, SO_INVALID_VALUE);
    assert!(names("tangent"));
    assert_eq!(trace(NAN, X, 0.0, &mut room).0, SO_INVALID_VALUE);
    assert!(names("start"));
}

#[test]
fn what_snakes_are_made_of() {
    let snake = flat();
    // SAFETY: ranges of live outputs, as `mesh` and `all` give them.
    unsafe {
        let handle = snake.0;
        let (at, quads) = mesh(|points, room, count, quads, quad_room, quad_count| {
            shapeop_snakePipe(handle, SHAPEOP_SNAKE_NOW, 0.5, 4, 12, points, room, count, quads, quad_room, quad_count)
        });
        assert_eq!((at.len(), quads.len()), (21 * 12, 4 * 20 * 12));
        // A piece of a torus about (0, 2, 0).
        assert!(at.iter().all(|p| ((p[0].hypot(p[1] - 2.0) - 2.0).hypot(p[2]) - 0.5).abs() < 1e-12));
        let lamellae = |kind: shapeop_snake_lamella, along: *const f64, depth| {
            mesh(|points, room, count, quads, quad_room, quad_count| {
                let now = SHAPEOP_SNAKE_NOW;
                let kind = kind as c_int;
                shapeop_snakeLamellae(
                    handle, now, kind, along, depth, 4, points, room, count, quads, quad_room, quad_count,
                )
            })
        };
        let (at, quads) = lamellae(shapeop_snake_lamella::SO_SNAKE_LAMELLA_FLAT, ptr::null(), 0.5);
        assert_eq!((at.len(), quads.len()), (5 * 2 * 5, 4 * 5 * 4));
        let radius = |p: &[f64; 3]| p[0].hypot(p[1] - 2.0);
        assert!(at.iter().all(|p| (radius(p) - 2.0).abs().min((radius(p) - 2.5).abs()) < 1e-12 && p[2] == 0.0));
        let (at, quads) = lamellae(shapeop_snake_lamella::SO_SNAKE_LAMELLA_ALONG, Z.as_ptr(), 0.5);
        assert_eq!((at.len(), quads.len()), (2 * 21, 4 * 20));
        assert!(at[21..].iter().all(|p| (radius(p) - 2.0).abs() < 1e-12 && (p[2] - 0.5).abs() < 1e-12));
        let (to, into, mut count, mut quad_count) = (ptr::null_mut(), ptr::null_mut(), -1, -1);
        let mut bad = |kind, along: *const f64, depth, per_arc, code, place: &str| {
            let counts = (&raw mut count, &raw mut quad_count);
            let now = SHAPEOP_SNAKE_NOW;
            let found =
                shapeop_snakeLamellae(handle, now, kind, along, depth, per_arc, to, 0, counts.0, into, 0, counts.1);
            refused(found, code, place);
        };
        bad(1, ptr::null(), 0.5, 4, SO_NOT_INITIALISED, "surface");
        bad(2, ptr::null(), 0.5, 4, SO_NULL_POINTER, "along");
        bad(2, ORIGIN.as_ptr(), 0.5, 4, SO_INVALID_VALUE, "along");
        bad(3, ptr::null(), 0.5, 4, SO_INVALID_VALUE, "kind");
        bad(0, ptr::null(), -2.0, 4, SO_INVALID_VALUE, "depth");
        bad(0, ptr::null(), 0.5, 0, SO_INVALID_VALUE, "per_arc");
        let mut pipe = |frame, radius, around, code, place: &str| {
            let found =
                shapeop_snakePipe(handle, frame, radius, 4, around, to, 0, &mut count, into, 0, &mut quad_count);
            refused(found, code, place);
        };
        pipe(SHAPEOP_SNAKE_NOW, 2.0, 12, SO_INVALID_VALUE, "radius");
        pipe(SHAPEOP_SNAKE_NOW, f64::NAN, 12, SO_INVALID_VALUE, "radius");
        pipe(SHAPEOP_SNAKE_NOW, 0.1, 2, SO_INVALID_VALUE, "around");
        pipe(-7, 0.1, 12, SO_INDEX_OUT_OF_RANGE, "frame");
        assert_eq!((count, quad_count), (-1, -1));
        // Kinds.
        let mixed = made(&[1.0, 2.0, 1.0 + 1e-7], &[1.0, 1.0, 1.0], &[0.1, 0.2]);
        let kinds = all(0.0, 3, |out, room, count| shapeop_snakeKinds(mixed.0, 1e-6, out, room, count));
        assert!(kinds.len() == 6 && kinds[2..] == [2.0, 2.0, 1.0, 1.0], "{kinds:?}");
        let of = all(-1, 1, |out, room, count| shapeop_snakeKindOf(mixed.0, 1e-6, out, room, count));
        assert_eq!(of, [0, 1, 0]);
        let mut kinds = 0;
        refused(shapeop_snakeKinds(mixed.0, -1.0, to, 0, &mut kinds), SO_INVALID_VALUE, "tolerance");
        refused(shapeop_snakeKindOf(mixed.0, f64::NAN, into, 0, &mut kinds), SO_INVALID_VALUE, "tolerance");
        refused(
            shapeop_snakeSweepMesh(handle, 4, 0, to, 0, &mut count, into, 0, &mut quad_count),
            SO_NOT_INITIALISED,
            "snake",
        );
    }
}

#[test]
fn a_circle_that_moves_along_its_axis_sweeps_a_cylinder() {
    let snake = Snake(create(&ring(7, 0.0), 1, 0.0));
    set_surface(&snake, shapeop_snake_surface::SO_SNAKE_SURFACE_CYLINDER, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
    let along = shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int;
    // SAFETY: a live vector.
    unsafe { assert_eq!(shapeop_snakeSetDirection(snake.0, along, Z.as_ptr()), SO_SUCCESS) };
    let own = shapeop_snake_options { max_steps: 4, step: 0.25, ..options() };
    assert_eq!(evolve(&snake, &own).frame_count, 5);
    let handle = snake.0;
    // SAFETY: live outputs, as `mesh` gives them.
    let (at, quads) = mesh(|points, room, count, quads, quad_room, quad_count| unsafe {
        shapeop_snakeSweepMesh(handle, 3, 0, points, room, count, quads, quad_room, quad_count)
    });
    assert_eq!((at.len(), quads.len()), (5 * 21, 4 * 4 * 21));
    assert!(at.iter().all(|p| (p[0].hypot(p[1]) - 1.0).abs() < 1e-9));
    assert!(at.iter().enumerate().all(|(k, p)| (p[2] - 0.25 * (k / 21) as f64).abs() < 1e-9));
    // The last frame's arcs are where they moved to.
    // SAFETY: `all` gives room for the stated capacity.
    let arcs = all(0.0, 11, |out, room, count| unsafe { shapeop_snakeArcs(handle, 4, out, room, count) });
    assert!(arcs.chunks_exact(11).all(|arc| (arc[2] - 1.0).abs() < 1e-9 && (arc[3] - 1.0).abs() < 1e-12));
    let (mut count, mut quad_count, null, none) = (0, 0, ptr::null_mut(), ptr::null_mut());
    // SAFETY: null with no capacity.
    unsafe {
        let mut sweep = |per_arc, back| {
            shapeop_snakeSweepMesh(handle, per_arc, back, null, 0, &mut count, none, 0, &mut quad_count)
        };
        refused(sweep(0, 0), SO_INVALID_VALUE, "per_arc");
        refused(sweep(3, 2), SO_INVALID_VALUE, "comes_back");
        assert_eq!(sweep(3, 1), SO_SUCCESS);
    }
    assert_eq!((count, quad_count), (5 * 21, 5 * 21));
}

#[test]
fn a_covering_is_judged() {
    // An arc that moves up sweeps a wall; the mesh is one twice as high, beside it.
    let snake = flat();
    let along = shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int;
    let mut told = sized!(shapeop_snake_covering);
    let mut own = defaults!(shapeop_snake_covering_options, shapeop_snakeDefaultCoveringOptions);
    let handle = snake.0;
    // SAFETY: live arrays of the stated lengths, live structs.
    unsafe {
        refused(shapeop_snakeCovering(handle, &own, &mut told), SO_NOT_INITIALISED, "snake");
        assert!(shapeop_snakeCoveringText(handle, &own).is_null());
        assert_eq!(shapeop_snakeSetDirection(handle, along, Z.as_ptr()), SO_SUCCESS);
        evolve(&snake, &shapeop_snake_options { max_steps: 4, step: 0.25, ..options() });
        assert_eq!(shapeop_snakeCovering(handle, ptr::null(), &mut told), SO_SUCCESS, "{}", message());
        assert_eq!((told.position_count, told.arc_count, told.kind_count, told.is_compared), (5, 25, 1, 0));
        assert!((told.length - 12.5).abs() < 1e-9 && (told.area - 2.5).abs() < 1e-2 && told.residual < 1e-12);
        // The wall of the arcs' cylinder, out by 0.01, twice as high.
        let at = |k: c_int| 1.25 * f64::from(k % 41) / 40.0;
        let wall: Vec<f64> =
            (0..41 * 2).flat_map(|k| [2.01 * at(k).sin(), 2.0 - 2.01 * at(k).cos(), 2.0 * f64::from(k / 41)]).collect();
        let quads: Vec<c_int> = (0..40).flat_map(|k| [k, k + 1, k + 42, k + 41]).collect();
        assert_eq!(shapeop_snakeSetMesh(handle, wall.as_ptr(), 82, quads.as_ptr(), 160, &4, 1), SO_SUCCESS);
        (own.distance, own.per_arc) = (0.05, 20);
        assert_eq!(shapeop_snakeCovering(handle, &own, &mut told), SO_SUCCESS, "{}", message());
        assert_eq!((told.is_compared, told.distance), (1, 0.05));
        assert!(
            (told.largest_deviation - 0.01).abs() < 1e-3 && told.rms_deviation <= told.largest_deviation,
            "{told:?}"
        );
        assert!((told.coverage - 0.52).abs() < 0.03 && (told.reference_area - 5.025).abs() < 0.01, "{told:?}");
        assert!(text(shapeop_snakeCoveringText(handle, &own)).contains("\"coverage\""));
        type Change = fn(&mut shapeop_snake_covering_options);
        let changes: [(&str, Change); 5] = [
            ("options->distance", |options| options.distance = -1.0),
            ("options->distance", |options| options.distance = f64::NAN),
            ("options->tolerance", |options| options.tolerance = -1.0),
            ("options->per_arc", |options| options.per_arc = 0),
            ("options->comes_back", |options| options.comes_back = 2),
        ];
        for (place, change) in changes {
            let mut own = own;
            change(&mut own);
            refused(shapeop_snakeCovering(handle, &own, &mut told), SO_INVALID_VALUE, place);
        }
        refused(shapeop_snakeCovering(handle, &own, ptr::null_mut()), SO_NULL_POINTER, "report");
    }
}

#[test]
fn a_linkage_moves_around() {
    let snake = six_arcs();
    assert_eq!(shapeop_snakeLinkageFreedoms(snake.0), 1);
    let mut determinant = 0.0;
    let mut own = defaults!(shapeop_snake_cycle_options, shapeop_snakeDefaultCycleOptions);
    let mut found = sized!(shapeop_snake_cycle);
    let (null, none) = (ptr::null_mut(), ptr::null_mut());
    // SAFETY: live outputs and structs; `all` gives room for the stated capacity.
    unsafe {
        assert_eq!(shapeop_snakeDeterminant(snake.0, &mut determinant), SO_SUCCESS);
        assert!(determinant.abs() > 1e-3, "{determinant}");
        refused(shapeop_snakeDeterminant(snake.0, null), SO_NULL_POINTER, "determinant");
        let mut count = 0;
        refused(shapeop_snakeCycleAngles(snake.0, null, 0, &mut count), SO_NOT_INITIALISED, "snake");
        assert_eq!(shapeop_snakeCycle(snake.0, &own, None, none, &mut found), SO_SUCCESS, "{}", message());
        assert_eq!((found.end, found.free), (shapeop_snake_cycle_end::SO_SNAKE_CYCLE_CLOSED, 1));
        assert!((0.0..1e-8).contains(&found.closing) && found.residual < 1e-11, "{found:?}");
        assert!((found.first_range - 1.1605).abs() < 2e-3 && (found.last_range - 1.8245).abs() < 2e-3, "{found:?}");
        assert_eq!((found.first_turns, found.last_turns), (0, 0));
        assert_eq!(shapeop_snakeFrameCount(snake.0), found.frame_count as c_int);
        let angles = all(0.0, 2, |out, room, count| shapeop_snakeCycleAngles(snake.0, out, room, count));
        assert_eq!(angles.len(), 2 * found.frame_count as usize);
        let range = |k: usize| {
            let of = || angles.iter().skip(k).step_by(2).copied();
            of().fold(f64::NEG_INFINITY, f64::max) - of().fold(f64::INFINITY, f64::min)
        };
        assert!((range(0) - found.first_range).abs() < 1e-3 && (range(1) - found.last_range).abs() < 1e-3);
        let frames = frames(&snake);
        assert!(frames.iter().all(|frame| distance(frame[0], frames[0][0]) + distance(frame[7], frames[0][7]) == 0.0));
        // A contact point of the first arc goes around its hinge.
        let path = |contact| {
            points(&all(0.0, 3, |out, room, count| shapeop_snakeContactPath(snake.0, contact, out, room, count)))
        };
        let hinge = frames[0][1];
        let apart: Vec<f64> = path(1).iter().map(|p| distance(*p, hinge)).collect();
        assert!(apart.iter().all(|d| (d - apart[0]).abs() < 1e-10) && path(0).iter().all(|p| length(*p) < 1e-12));
        refused(shapeop_snakeContactPath(snake.0, 7, null, 0, &mut count), SO_INDEX_OUT_OF_RANGE, "contact");
        // Phases: whole ones are the start; copies are phases with an offset.
        let phases = [0.0, 1.0, 0.3];
        let at = points(&all(0.0, 3, |out, room, count| {
            shapeop_snakeAtPhases(snake.0, phases.as_ptr(), 3, out, room, count)
        }));
        assert_eq!(at.len(), 24);
        assert!((0..8).all(|i| distance(at[i], frames[0][i]) < 1e-12 && distance(at[i + 8], frames[0][i]) < 1e-9));
        let copies = points(&all(0.0, 3, |out, room, count| {
            shapeop_snakeCopies(snake.0, 2, 0.1, 0.2, Z.as_ptr(), out, room, count)
        }));
        let lifted = (0..8).map(|i| distance(minus(copies[i + 8], Z), at[i + 16])).fold(0.0, f64::max);
        assert!(copies.len() == 16 && lifted < 1e-9, "{lifted}");
        let bad = [f64::NAN];
        refused(shapeop_snakeAtPhases(snake.0, bad.as_ptr(), 1, null, 0, &mut count), SO_INVALID_VALUE, "phases[0]");
        let copies = |copies, phase, shift, offset: *const f64| {
            let mut count = 0;
            shapeop_snakeCopies(snake.0, copies, phase, shift, offset, null, 0, &mut count)
        };
        refused(copies(-1, 0.0, 0.0, Z.as_ptr()), SO_INVALID_ARGUMENT_LENGTH, "nb_copies");
        refused(copies(i32::MAX, 0.0, 0.0, Z.as_ptr()), SO_INVALID_ARGUMENT_LENGTH, "nb_copies");
        refused(copies(1, f64::NAN, 0.0, Z.as_ptr()), SO_INVALID_VALUE, "phase");
        refused(copies(1, 0.0, f64::INFINITY, Z.as_ptr()), SO_INVALID_VALUE, "shift");
        refused(copies(1, 0.0, 0.0, NAN.as_ptr()), SO_INVALID_VALUE, "offset");
        refused(copies(1, 0.0, 0.0, ptr::null()), SO_NULL_POINTER, "offset");
        // An evolution has no angles, a cycle no times.
        refused(shapeop_snakeFrameRows(snake.0, null, 0, &mut count), SO_NOT_INITIALISED, "snake");
        // Watched, and stopped.
        let mut watching = watching(&snake, 5);
        let user = (&raw mut watching).cast();
        assert_eq!(shapeop_snakeCycle(snake.0, ptr::null(), Some(watch), user, &mut found), SO_SUCCESS);
        assert_eq!((found.end, found.closing), (shapeop_snake_cycle_end::SO_SNAKE_CYCLE_CANCELLED, -1.0));
        assert!(watching.was_busy && watching.angles.last().is_some_and(|angle| angle.abs() > 0.01));
        own.step = 0.3;
        refused(shapeop_snakeCycle(snake.0, &own, None, none, &mut found), SO_INVALID_VALUE, "options->step");
        (own.step, own.max_steps) = (0.02, 0);
        refused(shapeop_snakeCycle(snake.0, &own, None, none, &mut found), SO_INVALID_VALUE, "options->max_steps");
        (own.max_steps, own.is_reversed) = (9, 2);
        refused(shapeop_snakeCycle(snake.0, &own, None, none, &mut found), SO_INVALID_VALUE, "options->is_reversed");
        // Seven arcs move in two ways; two are no linkage; a closed one neither.
        let seven = made(&[1.0; 7], &[FRAC_PI_3; 7], &[1.0, -0.7, 0.9, -0.8, 0.6, 0.4]);
        assert_eq!(shapeop_snakeLinkageFreedoms(seven.0), 2);
        refused(shapeop_snakeCycle(seven.0, ptr::null(), None, none, &mut found), SO_INVALID_VALUE, "snake");
        refused(shapeop_snakeDeterminant(seven.0, &mut determinant), SO_INVALID_VALUE, "snake");
        let two = made(&[1.0; 2], &[1.0; 2], &[0.3]);
        assert_eq!(shapeop_snakeLinkageFreedoms(two.0), -1);
        assert!(names("snake"));
        let singular = made(&[1.0; 6], &[0.5 * PI; 6], &[1.2; 5]);
        assert_eq!(shapeop_snakeDeterminant(singular.0, &mut determinant), SO_SUCCESS);
        assert!(determinant.abs() < 1e-9);
        refused(shapeop_snakeCycle(singular.0, ptr::null(), None, none, &mut found), SO_DEGENERATE, "snake");
    }
}

#[test]
fn snakes_and_their_arcs_as_texts() {
    let snake = Snake(create(&ring(8, 0.0), 1, (PI / 8.0).tan()));
    let json = CString::new(text(shapeop_snakeText(snake.0))).unwrap();
    // SAFETY: live texts, or null.
    unsafe {
        let again = Snake(shapeop_snakeCreateFromText(json.as_ptr()));
        assert!(!again.0.is_null(), "{}", message());
        assert_eq!((control(&again), report(&again).is_closed), (control(&snake), 1));
        none(shapeop_snakeCreateFromText(ptr::null()), "json");
        assert!(shapeop_snakeCreateFromText(c"{}".as_ptr()).is_null());
        assert_eq!(shapeop_lastErrorCode(ptr::null_mut()), SO_INVALID_INPUT);
        none(shapeop_snakeCreateFromText(c"{\"version\": 2}".as_ptr()), "version");
    }
    let (now, everything) = (SHAPEOP_SNAKE_NOW, SHAPEOP_SNAKE_ALL);
    let lines = |table: *const std::ffi::c_char| text(table).lines().count();
    assert_eq!(lines(shapeop_snakeArcsCsv(snake.0, now, 1e-6)), 9);
    assert_eq!(
        text(shapeop_snakeKindsCsv(snake.0, now, 1e-6)).lines().nth(1).unwrap().split(',').next_back(),
        Some("8")
    );
    assert!(text(shapeop_snakeArcsText(snake.0, now, 1e-6)).contains("angle_rad"));
    assert_eq!(text(shapeop_snakeArcsDxf(snake.0, now, 1e-6)).lines().filter(|line| line.trim() == "ARC").count(), 8);
    assert!(shapeop_snakeArcsText(snake.0, everything, 1e-6).is_null());
    assert_eq!(shapeop_lastErrorCode(ptr::null_mut()), SO_NOT_INITIALISED);
    assert!(shapeop_snakeArcsCsv(snake.0, now, -1.0).is_null() && names("tolerance"));
    assert!(shapeop_snakeArcsCsv(snake.0, 3, 1e-6).is_null());
    let along = shapeop_snake_direction::SO_SNAKE_DIRECTION_ALONG as c_int;
    // SAFETY: a live vector.
    unsafe { assert_eq!(shapeop_snakeSetDirection(snake.0, along, Z.as_ptr()), SO_SUCCESS) };
    evolve(&snake, &shapeop_snake_options { max_steps: 2, ..options() });
    assert_eq!(lines(shapeop_snakeArcsCsv(snake.0, everything, 1e-6)), 1 + 3 * 8);
    assert_eq!(
        text(shapeop_snakeKindsCsv(snake.0, everything, 1e-6)).lines().nth(1).unwrap().split(',').next_back(),
        Some("24")
    );
    assert_eq!(lines(shapeop_snakeArcsCsv(snake.0, 2, 1e-6)), 9);
}

#[test]
fn a_closed_snake_is_fitted_to_a_closed_polyline() {
    let circle: Vec<f64> = around([1.5, 0.0, 0.3], [0.0, TAU])[..ON_RAIL as usize].concat();
    let mut found = sized!(shapeop_snake_fit_report);
    // SAFETY: a live array of the stated length, a live struct.
    let snake = Snake(unsafe { shapeop_snakeFit(circle.as_ptr(), ON_RAIL, 1, 8, ptr::null(), &mut found) });
    assert!(!snake.0.is_null(), "{}", message());
    let told = report(&snake);
    assert_eq!((told.is_closed, told.arc_count, control(&snake).len()), (1, 8, 8));
    assert!(found.deviation < 1e-9 && found.residual < 1e-12 && (told.length - 3.0 * PI).abs() < 1e-9, "{found:?}");
}
