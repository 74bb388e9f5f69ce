//! Preconditioned conjugate gradients for three right-hand sides at once, where a factor of the matrix would not fit.
//!
//! Each coordinate has steps of its own; a pass over the matrix serves all three. The preconditioner is a multigrid cycle
//! (`multilevel.rs`), so the number of iterations hardly grows with the model. The start is the caller's: in a
//! local/global iteration the current points, which are near the solution. From there every step lowers
//! `½ xᵀAx − bᵀx`, so even a solve that is cut short never raises the energy.
//!
//! Sums over vectors are made of sums over chunks, in order: the bits do not depend on the number of threads.
//!
//! Source: Golub & Van Loan, "Matrix Computations", section 11.5.

use glam::DVec3;

use super::multilevel::Multilevel;
use super::rows::{CHUNK, SparseRows, each_chunk, fill};
use super::simd::{Lanes, lanes, vector};
use super::symmetric::SymmetricMatrix;
use crate::error::{Error, Result, Status};

/// A coordinate is solved when no entry of the preconditioned residual `M⁻¹(b − A x)` is above this part of the extent of
/// the start (the longest side of its bounding box) or, if that is more, of the first such residual. With a multigrid cycle as
/// `M⁻¹` that residual is the error itself within a small factor, whatever the weights are, which the residual is not. A
/// hundredth of the 1e-10 that iterates with a factor agree to: the factor, and the errors of many iterations, have room.
const TOLERANCE: f64 = 1e-12;

/// Iterations at most. A solve that has used them keeps what it reached.
const MAX_ITERATIONS: u32 = 1000;

/// The squared distance beyond which a random vector counts as not found again by solving for its image. Each kernel vector
/// takes a squared length of 1/3 of it on average, and the chance that less than this is left of all three coordinates is 1e-9.
const LOST: f64 = 1e-6;

/// What a pass over vectors sums in one chunk: a product and a maximum for each coordinate.
#[derive(Clone, Copy, Default)]
struct Sums {
    product: Lanes,
    greatest: Lanes,
}

/// A symmetric positive definite matrix that is solved by conjugate gradients, with the memory that this needs.
pub struct ConjugateGradients {
    /// Of the matrix with unit diagonal.
    preconditioner: Multilevel,
    /// `1/√` of the matrix's diagonal.
    scale: Vec<f64>,
    /// The sums of the matrix's rows.
    row_sums: Vec<f64>,
    x: Vec<Lanes>,
    direction: Vec<Lanes>,
    image: Vec<Lanes>,
    sums: Vec<Sums>,
    tolerance: f64,
    /// [`MAX_ITERATIONS`] but in tests.
    iteration_limit: u32,
    iteration_count: u64,
    cut_short_count: u64,
}

impl std::fmt::Debug for ConjugateGradients {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ConjugateGradients").field("dimension", &self.scale.len()).finish_non_exhaustive()
    }
}

impl ConjugateGradients {
    /// Prepares for solving with `matrix`, which is positive semidefinite with a diagonal above 0.
    ///
    /// # Errors
    /// Status `InvalidValue` if the matrix is not finite, `TooLarge` if memory does not suffice.
    pub fn new(matrix: &SymmetricMatrix) -> Result<Self> {
        let n = matrix.dimension();
        let scale: Vec<f64> = (0..n).map(|i| 1.0 / matrix.diagonal(i).sqrt()).collect();
        let mut row_sums = vec![0.0; n];
        let mut is_finite = true;
        matrix.visit(|i, j, value| {
            is_finite &= (value * scale[i as usize] * scale[j as usize]).is_finite();
            row_sums[i as usize] += value;
            if i != j {
                row_sums[j as usize] += value;
            }
        });
        if !is_finite || !row_sums.iter().chain(&scale).all(|value| value.is_finite()) {
            return Err(Error::new(Status::InvalidValue, "the weights are too far apart for the system to be finite"));
        }
        // Equal points are what the rows of most constraints map to 0.
        let near_null = scale.iter().map(|scale| 1.0 / scale).collect();
        let preconditioner = Multilevel::new(SparseRows::scaled(matrix, &scale), near_null)?;
        let zeros = || vec![[0.0; 4]; n];
        let sums = vec![Sums::default(); n.div_ceil(CHUNK)];
        let (x, direction, image) = (zeros(), zeros(), zeros());
        Ok(Self {
            preconditioner,
            scale,
            row_sums,
            x,
            direction,
            image,
            sums,
            tolerance: TOLERANCE,
            iteration_limit: MAX_ITERATIONS,
            iteration_count: 0,
            cut_short_count: 0,
        })
    }

    /// Asks for `factor` times the error that solutions may have otherwise, about 1e-12 of the extent of the start.
    pub fn tighten(&mut self, factor: f64) {
        self.tolerance = TOLERANCE * factor;
    }

    /// Solves for x, y and z, on the current rayon pool if `is_parallel`: `right_hand_sides` (the matrix's dimension)
    /// becomes the solution, the same bits either way. `start` is where to begin; unknowns beyond its length, which must
    /// not depend on each other, begin at what their own rows say. Where the numbers overflow the solution is not
    /// finite. Allocates nothing.
    pub fn solve(&mut self, right_hand_sides: &mut [Lanes], start: &[DVec3], is_parallel: bool) {
        // Where a model lies must change neither the tolerance nor the round-off: solve about the middle of the start.
        let low = start.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = start.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (origin, extent) =
            if start.is_empty() { (DVec3::ZERO, 0.0) } else { (low + 0.5 * (high - low), (high - low).max_element()) };
        let (matrix, b, _) = self.preconditioner.parts();
        for (i, (x, b)) in self.x.iter_mut().zip(b.iter_mut()).enumerate() {
            *x = start.get(i).map_or([0.0; 4], |start| lanes((*start - origin) / self.scale[i]));
            *b = lanes(self.scale[i] * (vector(right_hand_sides[i]) - self.row_sums[i] * origin));
        }
        // From right-hand side to residual, in place.
        matrix.apply(0.0, 1.0, &[], &self.x, &mut self.image, is_parallel);
        if start.len() < self.x.len() {
            for i in start.len()..self.x.len() {
                self.x[i] = std::array::from_fn(|lane| b[i][lane] + self.image[i][lane]);
            }
            matrix.apply(0.0, 1.0, &[], &self.x, &mut self.image, is_parallel);
        }
        add(b, [1.0; 4], &self.image, is_parallel);
        // In units of the largest residual no product of two numbers overflows, or vanishes, that need not.
        let unit = b.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
        let mut is_finite = b.iter().flatten().all(|value| value.is_finite());
        if is_finite && unit > 0.0 {
            b.iter_mut().flatten().for_each(|value| *value /= unit);
            let outcome = self.iterate(extent, unit, is_parallel);
            is_finite = outcome.is_some();
            let (iterations, is_cut_short) = outcome.unwrap_or_default();
            self.iteration_count += u64::from(iterations);
            self.cut_short_count += u64::from(is_cut_short);
        }
        for ((solution, x), scale) in right_hand_sides.iter_mut().zip(&self.x).zip(&self.scale) {
            // Whoever asked looks at what is not finite, and refuses it.
            *solution = if is_finite { lanes(origin + *scale * vector(*x)) } else { [f64::NAN; 4] };
        }
    }

    /// True if the matrix takes some vector near to 0: more precisely, if solving for the image of a vector of random
    /// numbers from 0 does not find that vector again. What is in the kernel cannot be found, nor can what is so near to it
    /// that the iteration cannot tell. Costs one solve.
    pub fn is_singular(&mut self, is_parallel: bool) -> bool {
        let random = |i: usize, lane: usize| {
            // The finaliser of SplitMix64: uniform in −1 to 1.
            let mut bits = (4 * i + lane) as u64;
            bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for (i, x) in self.x.iter_mut().enumerate() {
            *x = [random(i + 1, 0), random(i + 1, 1), random(i + 1, 2), 0.0];
        }
        let (matrix, b, _) = self.preconditioner.parts();
        matrix.apply(0.0, -1.0, &[], &self.x, b, is_parallel);
        self.x.fill([0.0; 4]);
        if self.iterate(0.0, 1.0, is_parallel).is_none() {
            return true;
        }
        let lost = |lane: usize| -> f64 {
            self.x.iter().enumerate().map(|(i, x)| (x[lane] - random(i + 1, lane)).powi(2)).sum()
        };
        (0..3).any(|lane| !(lost(lane) <= LOST))
    }

    /// Iterations of all solves so far.
    pub fn iteration_count(&self) -> u64 {
        self.iteration_count
    }

    /// Solves so far that used up their iterations short of the tolerance.
    pub fn cut_short_count(&self) -> u64 {
        self.cut_short_count
    }

    /// From a start in `x` and its residual in the preconditioner's right-hand side, which counts in `unit`, to the solution
    /// in `x`. Returns the number of iterations and whether they were too few, `None` if numbers overflowed.
    fn iterate(&mut self, extent: f64, unit: f64, is_parallel: bool) -> Option<(u32, bool)> {
        self.preconditioner.run(is_parallel);
        let mut now = self.preconditioned(is_parallel)?;
        let first = now.greatest.iter().copied().fold(0.0, f64::max);
        let tolerance = self.tolerance * (extent / unit).max(first);
        // A product that is not above 0 is 0 or round-off: nothing is left to gain, or nothing can be told any more.
        let mut is_active: [bool; 4] =
            std::array::from_fn(|lane| lane < 3 && now.greatest[lane] > tolerance && now.product[lane] > 0.0);
        let mut keep = [0.0; 4];
        let mut iteration = 0;
        while iteration < self.iteration_limit && is_active.contains(&true) {
            iteration += 1;
            let (matrix, _, preconditioned) = self.preconditioner.parts();
            follow(&mut self.direction, keep, preconditioned, is_parallel);
            matrix.apply(0.0, 1.0, &[], &self.direction, &mut self.image, is_parallel);
            // The image is that of minus the matrix.
            let bends = sum(&mut self.sums, is_parallel, &self.direction, &self.image, |_| 0.0)?.product;
            let step: Lanes = std::array::from_fn(|lane| {
                is_active[lane] &= bends[lane] < 0.0;
                if is_active[lane] { -now.product[lane] / bends[lane] } else { 0.0 }
            });
            let (_, residual, _) = self.preconditioner.parts();
            add(&mut self.x, step.map(|step| step * unit), &self.direction, is_parallel);
            add(residual, step, &self.image, is_parallel);
            self.preconditioner.run(is_parallel);
            let next = self.preconditioned(is_parallel)?;
            for lane in 0..3 {
                is_active[lane] &= next.greatest[lane] > tolerance && next.product[lane] > 0.0;
                keep[lane] = if is_active[lane] { next.product[lane] / now.product[lane] } else { 0.0 };
            }
            now = next;
        }
        Some((iteration, is_active.contains(&true)))
    }

    /// The product of the residual with the preconditioned residual, and the greatest entry of the latter as a change of
    /// the unknowns.
    fn preconditioned(&mut self, is_parallel: bool) -> Option<Sums> {
        let (_, residual, preconditioned) = self.preconditioner.parts();
        let scale = &self.scale;
        sum(&mut self.sums, is_parallel, residual, preconditioned, |i| scale[i])
    }
}

/// `x ← x + factor y`, with a factor for each coordinate.
fn add(x: &mut [Lanes], factor: Lanes, y: &[Lanes], is_parallel: bool) {
    each_chunk(x, is_parallel, |first, x| {
        for (x, y) in x.iter_mut().zip(&y[first..]) {
            *x = std::array::from_fn(|lane| x[lane] + factor[lane] * y[lane]);
        }
    });
}

/// `x ← factor x + y`, with a factor for each coordinate. What `x` was does not matter where the factor is 0.
fn follow(x: &mut [Lanes], factor: Lanes, y: &[Lanes], is_parallel: bool) {
    each_chunk(x, is_parallel, |first, x| {
        for (x, y) in x.iter_mut().zip(&y[first..]) {
            let kept = |lane: usize| if factor[lane] == 0.0 { 0.0 } else { factor[lane] * x[lane] };
            *x = std::array::from_fn(|lane| kept(lane) + y[lane]);
        }
    });
}

/// The sum of `x y`, and the greatest `|weight(i) y|`, by coordinates; `None` if that is not finite. `sums` has room for one entry per chunk.
fn sum(
    sums: &mut [Sums],
    is_parallel: bool,
    x: &[Lanes],
    y: &[Lanes],
    weight: impl Fn(usize) -> f64 + Sync,
) -> Option<Sums> {
    let of_chunk = |chunk: usize| {
        let (first, end) = (chunk * CHUNK, ((chunk + 1) * CHUNK).min(x.len()));
        let mut sums = Sums::default();
        for (i, (x, y)) in (first..end).zip(x[first..end].iter().zip(&y[first..end])) {
            let weight = weight(i);
            for lane in 0..4 {
                sums.product[lane] += x[lane] * y[lane];
                sums.greatest[lane] = sums.greatest[lane].max((weight * y[lane]).abs());
            }
        }
        sums
    };
    fill(sums, is_parallel, of_chunk);
    let total = sums.iter().fold(Sums::default(), |total, part| Sums {
        product: std::array::from_fn(|lane| total.product[lane] + part.product[lane]),
        greatest: std::array::from_fn(|lane| total.greatest[lane].max(part.greatest[lane])),
    });
    total.product.iter().chain(&total.greatest).all(|value| value.is_finite()).then_some(total)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::cholesky::{Analysis, Factor};

    /// Springs between the nodes of an `n × n × n` grid, of a stiffness that varies by `spread`, `held` at every node of
    /// the first layer.
    fn block(n: u32, spread: f64, held: f64) -> SymmetricMatrix {
        let each = move |report: &mut dyn FnMut(u32, u32)| {
            for i in 0..n * n * n {
                for (stride, is_inside) in [(1, i % n + 1 < n), (n, i / n % n + 1 < n), (n * n, i / (n * n) + 1 < n)] {
                    if is_inside {
                        report(i, i + stride);
                    }
                }
            }
        };
        let mut matrix = SymmetricMatrix::with_pattern((n * n * n) as usize, each).unwrap();
        each(&mut |a, b| {
            let stiffness = spread.powf(f64::from((a * 7 + b * 13) % 17) / 17.0);
            for (i, j, value) in [(a, a, stiffness), (b, b, stiffness), (a, b, -stiffness)] {
                assert!(matrix.add(i, j, value));
            }
        });
        (0..n * n).for_each(|i| assert!(matrix.add(i, i, held)));
        matrix
    }

    fn vectors(count: usize, shift: usize) -> Vec<DVec3> {
        (shift..count + shift).map(|i| DVec3::new((i % 7) as f64, (i % 11) as f64 - 5.0, (i % 3) as f64)).collect()
    }

    fn solve(gradients: &mut ConjugateGradients, x: &mut [DVec3], start: &[DVec3], is_parallel: bool) {
        let mut rows: Vec<Lanes> = x.iter().map(|x| lanes(*x)).collect();
        gradients.solve(&mut rows, start, is_parallel);
        x.iter_mut().zip(rows).for_each(|(x, row)| *x = vector(row));
    }

    /// Solutions of the factor and of conjugate gradients, and how many iterations those took.
    fn both(matrix: &SymmetricMatrix, right: &[DVec3], start: &[DVec3]) -> (Vec<DVec3>, Vec<DVec3>, u64) {
        let analysis = Analysis::new(matrix.pattern(), &[]).unwrap();
        let mut factor = Factor::new(&analysis, matrix.pattern()).unwrap();
        factor.factorise(matrix, false).unwrap();
        let (mut direct, mut iterative) = (right.to_vec(), right.to_vec());
        factor.solve(&mut direct, false);
        let mut gradients = ConjugateGradients::new(matrix).unwrap();
        solve(&mut gradients, &mut iterative, start, false);
        (direct, iterative, gradients.iteration_count())
    }

    fn largest(difference: impl Iterator<Item = DVec3>) -> f64 {
        difference.map(|difference| difference.abs().max_element()).fold(0.0, f64::max)
    }

    #[test]
    fn solutions_are_those_of_a_factor_in_a_number_of_iterations_that_hardly_grows() {
        for spread in [1.0, 1e3] {
            let mut counts = Vec::new();
            for n in [4, 10, 20] {
                let matrix = block(n, spread, 1.0);
                let count = (n * n * n) as usize;
                let (direct, iterative, iterations) = both(&matrix, &vectors(count, 0), &vectors(count, 3));
                let error = largest(direct.iter().zip(&iterative).map(|(a, b)| *a - *b));
                let size = largest(direct.iter().copied());
                assert!(error < 1e-11 * size, "n = {n}, spread {spread}: {error:e} of {size:e}");
                counts.push(iterations);
            }
            println!("spread {spread}: {counts:?} iterations");
            assert!(counts.iter().all(|count| *count <= 40), "{counts:?} iterations at a spread of {spread}");
        }
    }

    #[test]
    fn the_place_of_the_model_and_the_size_of_its_numbers_change_no_digit_that_counts() {
        let matrix = block(9, 10.0, 1.0);
        let start = vectors(729, 3);
        let solve = |scale: f64, place: DVec3| {
            let moved: Vec<DVec3> = start.iter().map(|x| place + scale * *x).collect();
            let mut rhs = vec![DVec3::ZERO; 729];
            // The image of the moved solution of a fixed right-hand side.
            let (solution, ..) = both(&matrix, &vectors(729, 0), &start);
            let expected: Vec<DVec3> = solution.iter().map(|x| place + scale * *x).collect();
            matrix.multiply(&expected, &mut rhs);
            let (_, found, iterations) = both(&matrix, &rhs, &moved);
            (largest(found.iter().zip(&expected).map(|(a, b)| *a - *b)) / scale, iterations)
        };
        for (scale, place, tolerance) in [
            (1.0, DVec3::ZERO, 1e-9),
            (1e9, DVec3::ZERO, 1e-9),
            (1e-9, DVec3::ZERO, 1e-9),
            (1e-200, DVec3::ZERO, 1e-9),
            (1e200, DVec3::ZERO, 1e-9),
            (1.0, DVec3::splat(1e6), 1e-6),
        ] {
            let (error, iterations) = solve(scale, place);
            assert!(error < tolerance && iterations < 40, "scale {scale}, place {place}: {error:e}, {iterations}");
        }
    }

    #[test]
    fn a_solution_is_recognised_and_kept() {
        let matrix = block(10, 1.0, 1.0);
        let solution = vectors(1000, 5);
        let mut rhs = vec![DVec3::ZERO; 1000];
        matrix.multiply(&solution, &mut rhs);
        let (_, found, iterations) = both(&matrix, &rhs, &solution);
        assert_eq!(iterations, 0);
        assert!(largest(found.iter().zip(&solution).map(|(a, b)| *a - *b)) < 1e-14);
        // Nothing at all to solve for, and overflow.
        let mut gradients = ConjugateGradients::new(&matrix).unwrap();
        let mut zero = vec![DVec3::ZERO; 1000];
        solve(&mut gradients, &mut zero, &[DVec3::ZERO; 1000], false);
        assert!(zero.iter().all(|x| *x == DVec3::ZERO));
        let mut huge = vec![DVec3::splat(1e308); 1000];
        solve(&mut gradients, &mut huge, &vec![DVec3::splat(-1e308); 1000], false);
        assert!(huge.iter().all(|x| !x.is_finite()));
        let mut again = rhs.clone();
        solve(&mut gradients, &mut again, &solution, false);
        assert_eq!(again, found, "an overflow left its traces");
    }

    #[test]
    fn a_solve_that_is_cut_short_is_counted_and_leaves_less_energy() {
        let matrix = block(10, 10.0, 0.1);
        let (rhs, start) = (vectors(1000, 0), vectors(1000, 3));
        let energy = |x: &[DVec3]| {
            let mut image = vec![DVec3::ZERO; 1000];
            matrix.multiply(x, &mut image);
            x.iter().zip(&image).zip(&rhs).map(|((x, image), b)| x.dot(0.5 * *image - *b)).sum::<f64>()
        };
        let mut gradients = ConjugateGradients::new(&matrix).unwrap();
        let mut before = energy(&start);
        for limit in [1, 3, MAX_ITERATIONS] {
            gradients.iteration_limit = limit;
            let mut x = rhs.clone();
            solve(&mut gradients, &mut x, &start, false);
            assert!(energy(&x) < before, "no lower after {limit} iterations");
            before = energy(&x);
        }
        assert_eq!(gradients.cut_short_count(), 2);
    }

    #[test]
    fn the_bits_are_the_same_on_any_number_of_threads() {
        let matrix = block(16, 10.0, 0.1);
        let start = vectors(4096, 3);
        let run = |thread_count: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(thread_count).build().unwrap();
            let mut gradients = ConjugateGradients::new(&matrix).unwrap();
            let mut x = vectors(4096, 0);
            pool.install(|| solve(&mut gradients, &mut x, &start, thread_count > 1));
            (x, gradients.iteration_count())
        };
        let one = run(1);
        for thread_count in [2, 7] {
            assert!(run(thread_count) == one, "{thread_count} threads");
        }
    }

    #[test]
    fn kernels_of_any_size_are_found() {
        for n in [2, 4, 9, 17] {
            for spread in [1.0, 1e3] {
                for (held, is_singular) in [(0.0, true), (1e-3, false)] {
                    let mut gradients = ConjugateGradients::new(&block(n, spread, held)).unwrap();
                    assert_eq!(gradients.is_singular(false), is_singular, "n = {n}, spread {spread}, held by {held}");
                }
            }
        }
    }
}
