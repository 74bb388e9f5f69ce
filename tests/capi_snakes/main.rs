//! The C functions of circular arc snakes: what they answer, and what they refuse without a change.

#[path = "../abi/mod.rs"]
mod abi;
mod coverings;
mod curves;
mod linkages;
mod motions;
mod shapes;

use std::f64::consts::{FRAC_PI_3, PI, TAU};
use std::ffi::{c_int, c_uint, c_void};
use std::ptr;

use abi::last_error;
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
pub(crate) use sized;

/// The default options of a kind.
macro_rules! defaults {
    ($type:ty, $function:ident) => {{
        let mut options = sized!($type);
        // SAFETY: it states its size.
        assert_eq!(unsafe { $function(&mut options) }, SO_SUCCESS);
        options
    }};
}
pub(crate) use defaults;

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
