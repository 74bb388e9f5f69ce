//! The floor of an iteration: the bytes that it must stream at least, and the rate at which this machine reads.

use std::hint::black_box;
use std::sync::Barrier;
use std::time::Instant;

use serde_json::{Value, json};
use shapeop::linalg::simd::{Kernel, Lanes, dispatch};
use shapeop::solver::Solver;

/// Bytes that one round of reading takes at least, so that starting it does not count.
const BYTES_PER_ROUND: usize = 128 << 20;

/// Rounds of reading; their median counts.
const ROUNDS: usize = 9;

/// What an iteration of `solver` streams, in bytes; the factor counts twice.
pub fn bytes(solver: &Solver) -> Option<Value> {
    let bytes = solver.iteration_bytes()?;
    Some(json!({
        "factor": bytes.factor,
        "right_hand_sides": bytes.right_hand_sides,
        "points": bytes.points,
        "projections": bytes.projections,
        "constraint_data": bytes.constraints,
    }))
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
