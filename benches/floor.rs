//! The floor of an iteration: the bytes that it must stream at least, and the rate at which this machine reads.

use std::hint::black_box;
use std::mem::{size_of, size_of_val};
use std::sync::Barrier;
use std::time::Instant;

use serde_json::{Value, json};
use shapeop::constraints::{self, ConstraintView, Rows};
use shapeop::linalg::cholesky::{Analysis, SymmetricMatrix};
use shapeop::linalg::simd::{Kernel, Lanes, dispatch};
use shapeop::solver::Solver;

/// Bytes of a point, of a target and of a row of right-hand sides: three doubles.
const ROW: usize = 3 * size_of::<f64>();

/// Centred constraints of more points than this have one more unknown instead of a dense block, as in the solver.
const LONGEST_DENSE_STENCIL: usize = 12;

/// Bytes that one round of reading takes at least, so that starting it does not count.
const BYTES_PER_ROUND: usize = 128 << 20;

/// Rounds of reading; their median counts.
const ROUNDS: usize = 9;

/// What an iteration of `solver` streams, in bytes: every array once, and the factor twice. Only the factor's values are
/// counted, and those are an estimate: the analysis of the same matrix, made again here, says how many there are.
pub fn bytes(solver: &Solver) -> Result<Value, shapeop::error::Error> {
    let point_count = solver.points().len();
    let views: Vec<ConstraintView<'_>> =
        (0..solver.constraint_count()).filter_map(|id| solver.constraint(id)).collect();
    let long_count = views.iter().filter(|view| is_long(view)).count();
    let unknown_count = point_count + long_count;
    let matrix = SymmetricMatrix::with_pattern(unknown_count, |report| {
        let mut mean = point_count as u32;
        for view in &views {
            if is_long(view) {
                view.indices.iter().for_each(|&i| report(mean, i));
                mean += 1;
                continue;
            }
            for (a, &i) in view.indices.iter().enumerate() {
                view.indices[..a].iter().for_each(|&j| report(i, j));
            }
        }
    })?;
    let factor_values = Analysis::new(matrix.pattern(), solver.points())?.factor_value_count();
    let (mut targets, mut constraint_bytes) = (0, 0);
    for view in &views {
        let k = view.indices.len();
        let (rows, coefficients) = match view.info.rows {
            Rows::Centred => (k, 0),
            Rows::Linear(rows) => (rows, rows * k),
        };
        targets += rows;
        let doubles = 1 + view.scalars.len() + coefficients;
        constraint_bytes += size_of_val(view.indices) + size_of::<f64>() * doubles + rest_bytes(view.info.name);
    }
    Ok(json!({
        "factor": size_of::<f64>() * factor_values,
        "factor_is_estimate": true,
        "right_hand_sides": ROW * unknown_count,
        "points": ROW * point_count,
        "projections": ROW * targets,
        "constraint_data": constraint_bytes,
    }))
}

fn is_long(view: &ConstraintView<'_>) -> bool {
    view.info.rows == Rows::Centred && view.indices.len() > LONGEST_DENSE_STENCIL
}

/// Bytes of the rest state of one constraint, of the types that the problems use.
fn rest_bytes(type_name: &str) -> usize {
    match type_name {
        "Angle" => size_of::<constraints::angle::Angle>(),
        "Bending" => size_of::<constraints::bending::Bending>(),
        "Circle" => size_of::<constraints::circle::Circle>(),
        "Closeness" => size_of::<constraints::closeness::Closeness>(),
        "EdgeStrain" => size_of::<constraints::edge_strain::EdgeStrain>(),
        "LaplacianDisplacement" => size_of::<constraints::laplacian_displacement::LaplacianDisplacement>(),
        "Plane" => size_of::<constraints::plane::Plane>(),
        "Similarity" => size_of::<constraints::similarity::Similarity>(),
        "TetrahedronStrain" => size_of::<constraints::tetrahedron_strain::TetrahedronStrain>(),
        "Volume" => size_of::<constraints::volume::Volume>(),
        _ => 0,
    }
}

/// The sum of all values, with sums enough to wait for memory and not for additions.
struct Sum<'a>(&'a [Lanes]);

impl Kernel for Sum<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> f64 {
        let mut sums = [[0.0; 4]; 8];
        for rows in self.0.chunks_exact(sums.len()) {
            for (sum, row) in sums.iter_mut().zip(rows) {
                *sum = std::array::from_fn(|i| sum[i] + row[i]);
            }
        }
        sums.iter().flatten().sum()
    }
}

/// Bytes per second that `thread_count` threads read together from an array of `byte_count` bytes, each its own share,
/// again and again. What fits a cache is read from there, as a factor of that size is.
pub fn bandwidth(byte_count: usize, thread_count: usize) -> f64 {
    let share = (byte_count / size_of::<Lanes>()).div_ceil(thread_count).next_multiple_of(8).max(8);
    let round_bytes = share * thread_count * size_of::<Lanes>();
    let passes = BYTES_PER_ROUND.div_ceil(round_bytes);
    let barrier = Barrier::new(thread_count);
    let read = |thread: usize| {
        // Written by the thread that reads it, so that it lies near that thread.
        let rows: Vec<Lanes> = (0..share).map(|i| [(i + thread) as f64; 4]).collect();
        let round = || {
            barrier.wait();
            let started = Instant::now();
            for _ in 0..passes {
                black_box(dispatch(Sum(black_box(&rows))));
            }
            started.elapsed().as_secs_f64()
        };
        (0..ROUNDS).map(|_| round()).collect::<Vec<_>>()
    };
    let seconds: Vec<Vec<f64>> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..thread_count).map(|thread| scope.spawn(move || read(thread))).collect();
        threads.into_iter().filter_map(|thread| thread.join().ok()).collect()
    });
    // The slowest thread of each round.
    let mut rounds: Vec<f64> =
        (0..ROUNDS).map(|round| seconds.iter().map(|own| own[round]).fold(0.0, f64::max)).collect();
    rounds.sort_by(f64::total_cmp);
    (passes * round_bytes) as f64 / rounds[ROUNDS / 2]
}
