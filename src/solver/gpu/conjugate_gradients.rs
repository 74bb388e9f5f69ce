//! Conjugate gradients on the card, preconditioned by the multigrid cycle: the twin of `linalg/conjugate_gradients.rs`, in single
//! precision and without reading anything back.
//!
//! Each coordinate has steps of its own. A step asks for two products, `r·z` and `z·Az`, and finds the curvature along its
//! direction from those and the last step's: one pass over the matrix makes `Az` and both products, one workgroup adds
//! up, one pass moves all vectors. Sums are trees of one shape: the bits are the same every time.
//!
//! Source: Chronopoulos, Gear 1989, "s-step iterative methods for symmetric linear systems", section 2. Where cancellation
//! leaves few digits of the curvature we begin anew from the preconditioned residual.

use wgpu::Buffer;

use super::card::{Access, Card, GROUP, Run, THREADS};
use super::frame::Four;
use super::internal;
use super::multilevel::Multilevel;
use super::sliced::{Finish, Of, Sliced};
use crate::error::Result;
use crate::linalg::multilevel;

/// Sums over a workgroup.
const PAIR_SUM: &str = include_str!("shaders/pair_sum.wgsl");

/// Sums over pairs.
const PAIRS: &str = include_str!("shaders/pairs.wgsl");

/// Threads of the workgroups that add up pairs: as many as every card has.
const WIDTH: usize = 256;

/// Pairs that one workgroup adds up at most; more are summed in parts first.
const MOST_PAIRS: usize = 8 * WIDTH;

/// Pairs that each thread adds up where they are summed in parts.
const PART_SHARE: usize = 4;

/// Workgroups that sum parts, at most: what they make is little work for one.
const MOST_PARTS: usize = 4 * WIDTH;

const PRODUCTS: Finish = Finish {
    name: "products",
    of: Of::Springs,
    text: concat!(
        "const WIDTH = 64u;\n",
        include_str!("shaders/pair_sum.wgsl"),
        include_str!("shaders/gradients_products.wgsl")
    ),
    accesses: &[Access::Read, Access::Write, Access::Write],
};

/// The solver of `A x = b` for three right-hand sides, `A` being of unit diagonal.
///
/// Its own unknowns are those of the cycle's first level on the card; `right` and `solution` are in the caller's.
///
/// Submitting `start` and then `step` any number of times solves from 0 with so many iterations. Each lowers `½ xᵀAx − bᵀx`;
/// those after the solution is found change nothing. A coordinate whose products are not above 0 or not finite stays
/// where it is. Products must neither vanish nor overflow in single precision: right-hand sides from 1e-12 to 1e12 are safe.
pub(super) struct ConjugateGradients {
    /// `b`, four numbers for each unknown, the last not used. Steps make the residual of it.
    pub(super) right: Buffer,
    /// `x`.
    pub(super) solution: Buffer,
    /// `r·z`, the residual with the preconditioned one, by coordinates: before the first step, and before the last. It is the
    /// square of the error in the norm of `A`, within a small factor. In `w` 1 if there was a step, and how many steps were
    /// made from the first product to the second.
    pub(super) progress: Buffer,
    pub(super) start: Vec<Run>,
    pub(super) step: Vec<Run>,
}

impl ConjugateGradients {
    /// Copies what `cycle` is made of to the card; its first level's matrix is `A`.
    ///
    /// # Errors
    /// Status `BackendUnavailable` if the card has no room, `BackendFailed` if it was lost.
    pub(super) fn new(card: &Card, cycle: &multilevel::Multilevel) -> Result<Self> {
        let cycle = Multilevel::new(card, cycle)?;
        let matrix = cycle.matrix().ok_or_else(|| internal("a multigrid cycle has no level"))?;
        let n = matrix.row_count();
        let vector = || card.room("a vector of conjugate gradients", (n.max(1) * size_of::<Four>()) as u64);
        let [right, solution, z, image, p, q] = [vector()?, vector()?, vector()?, vector()?, vector()?, vector()?];
        let progress = card.room("the progress of conjugate gradients", 2 * size_of::<Four>() as u64)?;
        let state = card.room("the state of conjugate gradients", 3 * size_of::<Four>() as u64)?;

        let scales = card.buffer("the scales of conjugate gradients", cycle.scales())?;

        let (read, write) = (Access::Read, Access::Write);
        let text = include_str!("shaders/gradients_begin.wgsl");
        let begin = card.kernel("gradients begin", &[text, THREADS], &[read, write, write, write])?;
        let start = vec![card.run_of(&begin, &[&scales, &right, &solution, &progress], n)];

        let sums = Sums::new(card, matrix)?;
        let mut step = cycle.runs(card, &right, &z)?;
        step.extend(matrix.runs(card, &PRODUCTS, [0.0; 2], &z, &[&right, &image, &sums.pairs])?);
        step.extend(sums.runs(card, [&state, &progress])?);
        let text = include_str!("shaders/gradients_follow.wgsl");
        let follow =
            card.kernel("gradients follow", &[text, THREADS], &[read, read, read, read, write, write, write, write])?;
        step.push(card.run_of(&follow, &[&state, &scales, &z, &image, &p, &q, &solution, &right], n));
        Ok(Self { right, solution, progress, start, step })
    }

    /// Solves from 0 with so many steps.
    pub(super) fn submit(&self, card: &Card, steps: u32) {
        card.submit(self.start.iter().chain((0..steps).flat_map(|_| &self.step)));
    }
}

/// The products of every slice, and how they are added up.
struct Sums {
    pairs: Buffer,
    pair_count: usize,
    /// The sums of parts, and how many; none where there is little to add up.
    parts: Option<(Buffer, usize)>,
}

impl Sums {
    fn new(card: &Card, matrix: &Sliced) -> Result<Self> {
        let pair_count = matrix.slice_count();
        let room =
            |count: usize| card.room("the products of conjugate gradients", (2 * count * size_of::<Four>()) as u64);
        let part_count = pair_count.div_ceil(PART_SHARE * WIDTH).min(MOST_PARTS);
        let parts = if pair_count > MOST_PAIRS { Some((room(part_count)?, part_count)) } else { None };
        Ok(Self { pairs: room(pair_count)?, pair_count, parts })
    }

    /// The runs that add up and find the next step.
    fn runs(&self, card: &Card, [state, progress]: [&Buffer; 2]) -> Result<Vec<Run>> {
        let width = format!("const WIDTH = {WIDTH}u;\n");
        let mut runs = Vec::new();
        let (mut last, mut last_count) = (&self.pairs, self.pair_count);
        if let Some((parts, count)) = &self.parts {
            let texts = [&width, PAIR_SUM, PAIRS, include_str!("shaders/part_sums.wgsl")];
            let kernel = card.kernel("part sums", &texts, &[Access::Uniform, Access::Read, Access::Write])?;
            runs.push(card.run_of(
                &kernel,
                &[&card.uniform(&(last_count as u32)), last, parts],
                count * GROUP as usize,
            ));
            (last, last_count) = (parts, *count);
        }
        let texts = [&width, PAIR_SUM, PAIRS, include_str!("shaders/gradients_steps.wgsl")];
        let kernel =
            card.kernel("gradients steps", &texts, &[Access::Uniform, Access::Read, Access::Write, Access::Write])?;
        // One workgroup.
        runs.push(card.run_of(&kernel, &[&card.uniform(&(last_count as u32)), last, state, progress], 1));
        Ok(runs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::conjugate_gradients;
    use crate::linalg::rows::SparseRows;
    use crate::linalg::simd::Lanes;
    use crate::linalg::symmetric::SymmetricMatrix;
    use crate::solver::gpu::multilevel::tests::{grid, prepared};
    use crate::solver::gpu::tests::{Random, card};
    use glam::DVec3;

    type Three = [f64; 3];

    /// `Σ x y` by coordinates.
    fn dot(x: &[Lanes], y: &[Lanes]) -> Three {
        let sum = |k: usize| x.iter().zip(y).map(|(x, y)| x[k] * y[k]).sum();
        [sum(0), sum(1), sum(2)]
    }

    /// The error of `x` in the norm of `A`, relative to that of 0, by coordinates; 0 where the solution is 0 and found.
    fn errors(matrix: &SparseRows, x: &[Lanes], solution: &[Lanes]) -> Three {
        let norm = |x: &[Lanes]| {
            let mut image = vec![[0.0; 4]; x.len()];
            matrix.apply(0.0, -1.0, &[], x, &mut image, false);
            dot(x, &image).map(f64::sqrt)
        };
        let difference: Vec<Lanes> =
            x.iter().zip(solution).map(|(x, y)| std::array::from_fn(|k| x[k] - y[k])).collect();
        let (error, size) = (norm(&difference), norm(solution));
        std::array::from_fn(|k| if error[k] == 0.0 { 0.0 } else { error[k] / size[k] })
    }

    fn lanes_of(values: &[Four]) -> Vec<Lanes> {
        values.iter().map(|v| [v[0], v[1], v[2], 0.0].map(f64::from)).collect()
    }

    /// Textbook conjugate gradients in double precision, which `look` sees `r·z` and `x` of: before each iteration and after
    /// it.
    fn reference(
        cycle: &mut multilevel::Multilevel,
        right: &[Lanes],
        count: usize,
        mut look: impl FnMut(Three, &SparseRows, &[Lanes]),
    ) {
        let n = right.len();
        let (mut x, mut p, mut q) = (vec![[0.0; 4]; n], vec![[0.0; 4]; n], vec![[0.0; 4]; n]);
        let mut last = [0.0; 3];
        cycle.parts().1.copy_from_slice(right);
        for _ in 0..count {
            cycle.run(false);
            let (matrix, r, z) = cycle.parts();
            let now = dot(r, z);
            for (p, z) in p.iter_mut().zip(z.iter()) {
                (0..3).for_each(|k| p[k] = z[k] + if last[k] > 0.0 { now[k] / last[k] * p[k] } else { 0.0 });
            }
            matrix.apply(0.0, -1.0, &[], &p, &mut q, false);
            let bend = dot(&p, &q);
            for k in (0..3).filter(|k| bend[*k] > 0.0) {
                x.iter_mut().zip(&p).for_each(|(x, p)| x[k] += now[k] / bend[k] * p[k]);
                r.iter_mut().zip(&q).for_each(|(r, q)| r[k] -= now[k] / bend[k] * q[k]);
            }
            last = now;
            look(now, matrix, &x);
        }
    }

    fn submit(card: &Card, gradients: &ConjugateGradients, right: &[Four], steps: u32) {
        card.write(&gradients.right, right);
        gradients.submit(card, steps);
    }

    fn solution(card: &Card, gradients: &ConjugateGradients, n: usize) -> Vec<Four> {
        card.read(&[(&gradients.solution, n)]).unwrap().remove(0)
    }

    fn progress(card: &Card, gradients: &ConjugateGradients) -> [Four; 2] {
        let found: Vec<Vec<Four>> = card.read(&[(&gradients.progress, 2)]).unwrap();
        [found[0][0], found[0][1]]
    }

    /// A random right-hand side, a smooth one, and none.
    fn right_hand_sides(n: usize) -> Vec<Four> {
        let mut random = Random(n as u64);
        (0..n).map(|i| [random.number() as f32, 1.0 + (i as f32 / n as f32), 0.0, f32::NAN]).collect()
    }

    /// The solution by the processor's conjugate gradients, for the matrix with unit diagonal.
    fn exact(matrix: &SymmetricMatrix, right: &[Four]) -> Vec<Lanes> {
        let n = right.len();
        let root: Vec<f64> = (0..n).map(|i| matrix.diagonal(i).sqrt()).collect();
        let scaled = |x: Lanes, scale: f64| x.map(|x| x * scale);
        let mut x: Vec<Lanes> = lanes_of(right).into_iter().zip(&root).map(|(x, root)| scaled(x, *root)).collect();
        let mut gradients = conjugate_gradients::ConjugateGradients::new(matrix).unwrap();
        gradients.solve(&mut x, &vec![DVec3::ZERO; n], false);
        x.into_iter().zip(&root).map(|(x, root)| scaled(x, *root)).collect()
    }

    /// Iterations at most, of both.
    const MOST: usize = 30;

    /// The greatest error after each of `MOST` iterations, on the card and on the processor.
    fn errors_of_both(card: &Card, symmetric: &SymmetricMatrix) -> [Vec<f64>; 2] {
        let (matrix, mut cycle) = prepared(symmetric);
        let n = matrix.row_count();
        let right = right_hand_sides(n);
        let exact = exact(symmetric, &right);
        let worst = |x: &[Lanes]| errors(&matrix, x, &exact).into_iter().fold(0.0, f64::max);
        let mut expected = Vec::new();
        reference(&mut cycle, &lanes_of(&right), MOST, |_, _, x| expected.push(worst(x)));
        let gradients = ConjugateGradients::new(card, &cycle).unwrap();
        submit(card, &gradients, &right, 0);
        let mut found = Vec::new();
        for _ in 0..MOST {
            card.submit(&gradients.step);
            let x = solution(card, &gradients, n);
            assert!(x.iter().all(|x| x[2] == 0.0), "the solution of no right-hand side");
            found.push(worst(&lanes_of(&x)));
        }
        println!("{n} unknowns, {} runs in each iteration", gradients.step.len());
        [found, expected]
    }

    /// How many iterations it takes to come below `wanted`.
    fn count(errors: &[f64], wanted: f64) -> usize {
        1 + errors.iter().position(|error| *error < wanted).unwrap_or(errors.len())
    }

    #[test]
    fn solutions_are_the_processors_after_as_many_iterations() {
        let Some(card) = card(0) else { return };
        let wanted = 1e-4;
        for (sizes, spread) in [
            ([1, 1, 1], 1.0),
            ([63, 1, 1], 1.0),
            ([64, 1, 1], 1.0),
            ([65, 1, 1], 1.0),
            ([73, 137, 1], 1.0),
            ([120, 120, 1], 10.0),
            ([20, 20, 20], 1e3),
        ] {
            let [found, expected] = errors_of_both(&card, &grid(sizes, spread, 1.0));
            let [own, other] = [&found, &expected].map(|errors| count(errors, wanted));
            let least = found.iter().copied().fold(f64::INFINITY, f64::min);
            println!(
                "{sizes:?}, spread {spread}: {own} iterations, {other} on the processor; {least:.1e} at the least"
            );
            assert!(own <= other, "{found:?} instead of {expected:?}");
            // Iterations beyond the solution do no harm.
            assert!(found[MOST - 1] < (1.1 * least).max(wanted), "{least:e}, and at the end {:e}", found[MOST - 1]);
        }
    }

    #[test]
    fn a_large_stiff_model_that_is_hardly_held_is_solved_too() {
        let Some(card) = card(0) else { return };
        // The stiffest spring is 10⁵ times as stiff as what holds, at 30 nodes of 27 000: the least eigenvalue is some 10⁻⁸
        // of the greatest, beyond single precision. Its root is what bounds the error: 6e-8 · 10⁴, times the few
        // roundings that every number has gone through. Rounded entries instead of springs end at an error of 2.
        let [found, expected] = errors_of_both(&card, &grid([30, 30, 30], 1e3, 0.01));
        let [own, other] = [&found, &expected].map(|errors| count(errors, 4e-3));
        println!("{own} iterations, {other} on the processor; {:.1e} after {MOST}", found[MOST - 1]);
        assert!(own <= other, "{found:?} instead of {expected:?}");
        assert!(found[MOST - 1] < 4e-3);
    }

    /// Springs as in [`grid`], and a stiffness of 1 against bending along both axes.
    fn plate(n: u32) -> SymmetricMatrix {
        let lines = move |visit: &mut dyn FnMut([u32; 3])| {
            for i in 0..n * n {
                for (stride, place) in [(1, i % n), (n, i / n)] {
                    if place > 0 && place + 1 < n {
                        visit([i - stride, i, i + stride]);
                    }
                }
            }
        };
        let pairs = [(0, 1), (1, 2), (0, 2)];
        let each = |report: &mut dyn FnMut(u32, u32)| {
            lines(&mut |line| pairs.iter().for_each(|(a, b)| report(line[*a], line[*b])));
            (1..n * n).for_each(|i| report(i, i - 1));
            (n..n * n).for_each(|i| report(i, i - n));
        };
        let mut plate = SymmetricMatrix::with_pattern((n * n) as usize, each).unwrap();
        grid([n, n, 1], 1.0, 1.0).visit(|i, j, value| assert!(plate.add(i, j, value)));
        // The square of a − 2 b + c.
        lines(&mut |[a, b, c]| {
            for (i, j, value) in [(a, a, 1.0), (b, b, 4.0), (c, c, 1.0), (a, b, -2.0), (b, c, -2.0), (a, c, 1.0)] {
                assert!(plate.add(i, j, value));
            }
        });
        plate
    }

    #[test]
    fn plates_are_solved_in_as_many_iterations_as_on_the_processor() {
        let Some(card) = card(0) else { return };
        let [found, expected] = errors_of_both(&card, &plate(100));
        let [own, other] = [&found, &expected].map(|errors| count(errors, 1e-4));
        println!("{own} iterations, {other} on the processor");
        assert!(own <= other && other < MOST, "{found:?} instead of {expected:?}");
        assert!(found[MOST - 1] < 1e-4);
    }

    #[test]
    fn iterates_and_progress_are_the_processors_where_sums_are_made_in_parts() {
        let Some(card) = card(0) else { return };
        let (matrix, mut cycle) = prepared(&grid([400, 350, 1], 10.0, 1.0));
        let n = matrix.row_count();
        let right = right_hand_sides(n);
        let mut products = Vec::new();
        let mut expected = Vec::new();
        reference(&mut cycle, &lanes_of(&right), 5, |product, _, x| {
            products.push(product);
            if products.len() == 4 {
                expected = x.to_vec();
            }
        });
        let gradients = ConjugateGradients::new(&card, &cycle).unwrap();
        submit(&card, &gradients, &right, 4);
        // Errors of single precision grow with the size of smooth solutions; those of the norm count.
        let found = lanes_of(&solution(&card, &gradients, n));
        let error = errors(&matrix, &found, &expected);
        assert!(error.iter().all(|error| *error < 1e-4), "{error:?}");
        let is_near = |found: Four, expected: Three, steps: f32| {
            let is_near = |k: usize| (f64::from(found[k]) - expected[k]).abs() <= 1e-4 * expected[k];
            assert!((0..3).all(is_near) && found[3] == steps, "{found:?} instead of {expected:?} after {steps} steps");
        };
        let [first, last] = progress(&card, &gradients);
        is_near(first, products[0], 1.0);
        is_near(last, products[3], 3.0);
        card.submit(&gradients.step);
        is_near(progress(&card, &gradients)[1], products[4], 4.0);
    }

    #[test]
    fn every_solve_and_any_pages_give_the_same_bits() {
        let solve = |binding_bytes: u64| {
            let card = card(binding_bytes)?;
            let (matrix, cycle) = prepared(&grid([17, 19, 21], 10.0, 1.0));
            let n = matrix.row_count();
            let gradients = ConjugateGradients::new(&card, &cycle).unwrap();
            let right = right_hand_sides(n);
            submit(&card, &gradients, &right, 6);
            let first = solution(&card, &gradients, n);
            // Another solve in between leaves nothing.
            let other: Vec<Four> = right.iter().map(|b| [f32::INFINITY, b[0], f32::NAN, 0.0]).collect();
            submit(&card, &gradients, &other, 3);
            submit(&card, &gradients, &right, 6);
            assert!(solution(&card, &gradients, n) == first, "another solve left its traces");
            Some((first, gradients.step.len()))
        };
        let (Some((whole, runs)), Some((cut, more_runs))) = (solve(0), solve(110_000)) else { return };
        assert!(more_runs > runs, "no pages");
        assert!(whole == cut, "pages change bits");
    }

    #[test]
    fn large_and_small_right_hand_sides_change_no_digit() {
        let Some(card) = card(0) else { return };
        let (matrix, cycle) = prepared(&grid([100, 100, 1], 10.0, 1.0));
        let n = matrix.row_count();
        let gradients = ConjugateGradients::new(&card, &cycle).unwrap();
        let right = right_hand_sides(n);
        submit(&card, &gradients, &right, 8);
        let expected = solution(&card, &gradients, n);
        // Powers of two, some 1e-12 and 1e12, change no bit but the exponents.
        for scale in [2.0_f32.powi(-40), 2.0_f32.powi(40)] {
            let scaled: Vec<Four> = right.iter().map(|b| b.map(|b| b * scale)).collect();
            submit(&card, &gradients, &scaled, 8);
            for (found, expected) in solution(&card, &gradients, n).iter().zip(&expected) {
                assert_eq!(*found, expected.map(|x| x * scale), "scaled by {scale}");
            }
        }
    }

    #[test]
    fn a_coordinate_that_cannot_be_solved_stays_at_0_and_spoils_no_other() {
        let Some(card) = card(0) else { return };
        let (matrix, cycle) = prepared(&grid([40, 40, 1], 10.0, 1.0));
        let n = matrix.row_count();
        let gradients = ConjugateGradients::new(&card, &cycle).unwrap();
        let right = right_hand_sides(n);
        submit(&card, &gradients, &right, 8);
        let expected = solution(&card, &gradients, n);
        for bad in [f32::NAN, f32::INFINITY, 1e30, -1e38] {
            let mut right = right.clone();
            right.iter_mut().for_each(|b| b[2] = bad);
            submit(&card, &gradients, &right, 8);
            for (found, expected) in solution(&card, &gradients, n).iter().zip(&expected) {
                assert_eq!(found, expected, "beside a right-hand side of {bad}");
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_ends_in_no_number_that_is_not_finite() {
        let Some(card) = card(0) else { return };
        // Entries of −2 beside a diagonal of 1.
        let n = 1000_u32;
        let row = |i: u32| [(i.max(1) - 1, -2.0), (i, 1.0), (i + 1, -2.0)].into_iter();
        let row = |i: u32| row(i).filter(move |(j, value)| (*j != i || *value > 0.0) && *j < n).collect();
        let matrix = SparseRows::from_rows(n as usize, (0..n).map(row));
        let cycle = multilevel::Multilevel::new(matrix, vec![1.0; n as usize]).unwrap();
        let gradients = ConjugateGradients::new(&card, &cycle).unwrap();
        submit(&card, &gradients, &right_hand_sides(n as usize), 20);
        let found = solution(&card, &gradients, n as usize);
        assert!(found.iter().flatten().all(|x| x.is_finite()));
    }
}
