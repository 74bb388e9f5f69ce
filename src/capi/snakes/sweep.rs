//! What moving snakes are for: surfaces that they sweep, pipes, lamellae, arcs to be made.

use std::ffi::c_int;

use super::super::{code, shapeop_err};
use super::guard;
use super::io::{self, Outputs, Told, tell_grids};
use super::snake::ShapeOpSnake;
use crate::geometry::snakes::covering;
use crate::geometry::snakes::draft::Stand;
use crate::geometry::snakes::sweep::arc_kinds;

/// Writes the surface that the positions found last sweep as a mesh of quads: a row of points for each position,
/// `per_arc` intervals in each arc, as `shapeop_snakeSample` has them. With `comes_back` 1 the last position is followed by
/// the first. Points are written if there is room for `capacity` of them, and their number to `count`; quads, four points
/// each, if there is room for `quad_capacity` of them, and their number to `quad_count`.
///
/// # Safety
/// `points` is null or writable for `3 * capacity` doubles, `quads` for `4 * quad_capacity` ints, `count` and
/// `quad_count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeSweepMesh(
    snake: *mut ShapeOpSnake,
    per_arc: c_int,
    comes_back: c_int,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    quads: *mut c_int,
    quad_capacity: c_int,
    quad_count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let swept = draft.swept(io::per_arc(per_arc)?, io::truth("comes_back", comes_back)?);
        let grid = swept.map_err(|error| io::placed(error, &[("frames", "snake"), ("points", "per_arc")]))?;
        // SAFETY: the caller vouches for the outputs.
        unsafe { tell_grids(&[grid], &Told { points, capacity, count, quads, quad_capacity, quad_count }) }
    }))
}

/// Writes the pipe of a radius around the snake at a frame, or as it is (`SHAPEOP_SNAKE_NOW`), as a mesh of quads that
/// face outward: `around` points, 3 or more, in each section, `per_arc` intervals in each arc. Outputs are as those of
/// `shapeop_snakeSweepMesh`.
///
/// # Safety
/// As `shapeop_snakeSweepMesh`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakePipe(
    snake: *mut ShapeOpSnake,
    frame: c_int,
    radius: f64,
    per_arc: c_int,
    around: c_int,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    quads: *mut c_int,
    quad_capacity: c_int,
    quad_count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let around = io::count("around", around, 3, io::MOST_INTERVALS)?;
        let grid = covering::pipe(&draft.at(io::frame(frame)?)?, radius, io::per_arc(per_arc)?, around)?;
        // SAFETY: the caller vouches for the outputs.
        unsafe { tell_grids(&[grid], &Told { points, capacity, count, quads, quad_capacity, quad_count }) }
    }))
}

/// How lamellae stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum shapeop_snake_lamella {
    /// In the planes of the arcs: a sector of a ring for each, which share no points.
    SO_SNAKE_LAMELLA_FLAT = 0,
    /// Along the normals of the snake's surface: one band.
    SO_SNAKE_LAMELLA_NORMAL = 1,
    /// Along one vector: one band.
    SO_SNAKE_LAMELLA_ALONG = 2,
}

/// Writes the lamellae of a depth along the snake at a frame, or as it is (`SHAPEOP_SNAKE_NOW`), as a mesh of quads,
/// `per_arc` intervals in each arc. How they stand says `kind`, a `shapeop_snake_lamella`; `along` is a vector of any
/// length above 0, or null for the others. Flat ones are `depth` farther from the centres of the arcs, or nearer if it is
/// negative. Outputs are as those of `shapeop_snakeSweepMesh`.
///
/// # Safety
/// `along` is null or readable for 3 doubles; else as `shapeop_snakeSweepMesh`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeLamellae(
    snake: *mut ShapeOpSnake,
    frame: c_int,
    kind: c_int,
    along: *const f64,
    depth: f64,
    per_arc: c_int,
    points: *mut f64,
    capacity: c_int,
    count: *mut c_int,
    quads: *mut c_int,
    quad_capacity: c_int,
    quad_count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let stand = match io::count("kind", kind, 0, 2)? {
            0 => Stand::Flat,
            1 => Stand::Normal,
            // SAFETY: the caller vouches for 3 doubles.
            _ => Stand::Along(unsafe { io::vector("along", along)? }),
        };
        let found = draft.lamellae(io::frame(frame)?, depth, io::per_arc(per_arc)?, stand);
        let grids = found.map_err(|error| match error.place() {
            "direction" => error.with_place("along"),
            _ => error,
        })?;
        // SAFETY: the caller vouches for the outputs.
        unsafe { tell_grids(&grids, &Told { points, capacity, count, quads, quad_capacity, quad_count }) }
    }))
}

/// Writes the kinds of arcs that one position of the snake is made of, 3 numbers each, if there is room for `capacity` of
/// them, and their number to `count`: the radius, the length, how many there are. Arcs are of one kind if radii and
/// lengths are both within `tolerance` of the first's, relative to its. All positions have the same arcs.
///
/// # Safety
/// `kinds` is null or writable for `3 * capacity` doubles, `count` for one int.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeKinds(
    snake: *mut ShapeOpSnake,
    tolerance: f64,
    kinds: *mut f64,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let found = arc_kinds(draft.snake().shapes(), tolerance)?;
        let all: Vec<f64> =
            found.iter().flat_map(|kind| [kind.shape.radius, kind.shape.length, kind.count as f64]).collect();
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("kinds", kinds, capacity, count, all, 3)? };
        outputs.write()
    }))
}

/// Writes of which kind each arc is, as `shapeop_snakeKinds` numbers them, if there is room for `capacity` arcs, and
/// their number to `count`.
///
/// # Safety
/// `kind_of` is null or writable for `capacity` ints, `count` for one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn shapeop_snakeKindOf(
    snake: *mut ShapeOpSnake,
    tolerance: f64,
    kind_of: *mut c_int,
    capacity: c_int,
    count: *mut c_int,
) -> shapeop_err {
    code(guard(snake, |draft| {
        let shapes = draft.snake().shapes();
        let mut of = vec![0; shapes.len()];
        for (k, kind) in arc_kinds(shapes, tolerance)?.iter().enumerate() {
            kind.arcs.iter().for_each(|&arc| of[arc] = k);
        }
        let mut outputs = Outputs::default();
        // SAFETY: the caller vouches for both.
        unsafe { outputs.sized("kind_of", kind_of, capacity, count, io::ints(of)?, 1)? };
        outputs.write()
    }))
}
