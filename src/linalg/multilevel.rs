//! An approximate inverse of a symmetric positive definite matrix from ever coarser versions of it: one V-cycle of algebraic
//! multigrid by smoothed aggregation.
//!
//! Every level has a unit diagonal. A level is smoothed by a Chebyshev polynomial of its matrix, which needs products
//! alone and so gives the same bits on any number of threads; what is smooth is left to the next level, whose unknowns stand
//! for some ten to thirty neighbours each. The coarsest level has a Cholesky factor. Smoothing before and after being the
//! same polynomial, the whole is symmetric and positive definite, as conjugate gradients ask.
//!
//! Source: Vaněk, Mandel, Brezina 1996, "Algebraic multigrid by smoothed aggregation for second and fourth order elliptic
//! problems"; Adams, Brezina, Hu, Tuminaro 2003, "Parallel multigrid smoothing: polynomial versus Gauss–Seidel". We keep
//! constants alone, which three coordinates share, and bound spectra by Gershgorin's circles instead of estimating them.

use glam::DVec3;

use super::cholesky::{Analysis, Factor};
use super::rows::{SparseRows, each_chunk};
use super::simd::{Lanes, lanes, vector};
use super::symmetric::SymmetricMatrix;
use crate::error::Result;

/// Up to so many unknowns a level gets a factor: solving with it then costs far less than one product on the first.
const COARSEST: usize = 500;

/// Levels at most; each has a fraction of the unknowns of the one before.
const MOST_LEVELS: usize = 12;

/// A level that keeps more than this part of the unknowns is not worth its work, and is not made.
const LEAST_COARSENING: f64 = 0.8;

/// Unknowns are neighbours where the matrix of unit diagonal has an entry below minus this. Halved on each level, as
/// Vaněk et al. propose.
const STRONG: f64 = 0.08;

/// A row whose other entries add up to less than this is as good as solved by smoothing, and has no coarse unknown.
const DOMINATED: f64 = 0.5;

/// A smoother damps errors between the greatest eigenvalue and this part of it; below, coarser levels do.
const SMOOTHED_PART: f64 = 0.2;

/// The matrix of a level with unit diagonal, the way to the next, and the memory that a cycle needs.
struct Level {
    matrix: SparseRows,
    /// What the matrix takes near to 0; above 0 everywhere.
    near_null: Vec<f64>,
    /// An upper bound of its eigenvalues.
    greatest: f64,
    /// From the next level to this and back; none on the last.
    transfer: Option<(SparseRows, SparseRows)>,
    /// The right-hand side, the solution, and the smoother's change of it.
    b: Vec<Lanes>,
    x: Vec<Lanes>,
    change: Vec<Lanes>,
}

/// Two steps of Chebyshev's iteration. The first changes the solution by the residual over `middle`, the second by `keep` of
/// that change and `factor` times the residual.
#[derive(Clone, Copy)]
pub(crate) struct Smoother {
    pub(crate) middle: f64,
    pub(crate) keep: f64,
    pub(crate) factor: f64,
}

/// What a level is made of, for a twin on another machine.
#[cfg(feature = "gpu")]
pub(crate) struct LevelParts<'a> {
    pub(crate) matrix: &'a SparseRows,
    pub(crate) near_null: &'a [f64],
    pub(crate) smoother: Smoother,
    /// From the next level to this and back; none on the last.
    pub(crate) transfer: Option<&'a (SparseRows, SparseRows)>,
}

/// An approximate inverse.
pub struct Multilevel {
    levels: Vec<Level>,
    /// Of the last level's matrix, with room for its right-hand sides; none where that is large or singular.
    coarsest: Option<(Factor, Vec<DVec3>)>,
}

impl Multilevel {
    /// Prepares for `matrix`, which is square, symmetric, positive semidefinite, finite and of unit diagonal, and takes all
    /// its values near to 0 at `near_null`, which is above 0 everywhere.
    ///
    /// # Errors
    /// Status `TooLarge` if memory does not suffice.
    pub fn new(matrix: SparseRows, near_null: Vec<f64>) -> Result<Self> {
        let mut levels = vec![Level::new(matrix, near_null)];
        let mut strong = STRONG;
        while levels.len() < MOST_LEVELS {
            let Some(last) = levels.last_mut().filter(|last| last.matrix.row_count() > COARSEST) else { break };
            let Some((coarse, coarse_null)) = last.coarsen(strong) else { break };
            levels.push(Level::new(coarse, coarse_null));
            strong *= 0.5;
        }
        let coarsest = match levels.last() {
            Some(last) if last.matrix.row_count() <= COARSEST => factor(&last.matrix)?,
            _ => None,
        };
        Ok(Self { levels, coarsest })
    }

    /// The matrix, the right-hand side, and what [`Self::run`] made of it.
    pub fn parts(&mut self) -> (&SparseRows, &mut [Lanes], &mut [Lanes]) {
        let Level { matrix, b, x, .. } = &mut self.levels[0];
        (matrix, b, x)
    }

    /// The levels, the finest first.
    #[cfg(feature = "gpu")]
    pub(crate) fn levels(&self) -> impl Iterator<Item = LevelParts<'_>> {
        self.levels.iter().map(|level| LevelParts {
            matrix: &level.matrix,
            near_null: &level.near_null,
            smoother: Smoother::new(level.greatest),
            transfer: level.transfer.as_ref(),
        })
    }

    /// True if the last level is solved; else it is smoothed.
    #[cfg(feature = "gpu")]
    pub(crate) fn is_coarsest_solved(&self) -> bool {
        self.coarsest.is_some()
    }

    /// Applies the approximate inverse to the right-hand side. Allocates nothing.
    pub fn run(&mut self, is_parallel: bool) {
        cycle(&mut self.levels, self.coarsest.as_mut(), is_parallel);
    }
}

impl Smoother {
    /// For eigenvalues up to `greatest`.
    fn new(greatest: f64) -> Self {
        let least = SMOOTHED_PART * greatest;
        let (middle, half) = (0.5 * (greatest + least), 0.5 * (greatest - least));
        let ratio = half / middle;
        let next_ratio = 1.0 / (2.0 / ratio - ratio);
        Self { middle, keep: ratio * next_ratio, factor: 2.0 * next_ratio / half }
    }
}

impl Level {
    fn new(matrix: SparseRows, near_null: Vec<f64>) -> Self {
        let n = matrix.row_count();
        let row_sum = |i| matrix.row(i).map(|(_, value)| value.abs()).sum::<f64>();
        let greatest = (0..n).map(row_sum).fold(1.0, f64::max);
        let zeros = || vec![[0.0; 4]; n];
        Self { greatest, matrix, near_null, transfer: None, b: zeros(), x: zeros(), change: zeros() }
    }

    /// The next level's matrix and near null vector, `None` where there is none worth having; sets [`Self::transfer`].
    fn coarsen(&mut self, strong: f64) -> Option<(SparseRows, Vec<f64>)> {
        let (n, near_null) = (self.matrix.row_count(), &self.near_null);
        let (aggregate_of, count) = aggregates(&self.matrix, strong);
        if count == 0 || count as f64 > LEAST_COARSENING * n as f64 {
            return None;
        }
        let members = || aggregate_of.iter().enumerate().filter_map(|(i, a)| a.map(|a| (i, a as usize)));
        let mut norms = vec![0.0_f64; count];
        members().for_each(|(i, a)| norms[a] += near_null[i] * near_null[i]);
        norms.iter_mut().for_each(|norm| *norm = norm.sqrt());
        let tentative = |i: usize| match aggregate_of[i] {
            Some(a) => vec![(a, near_null[i] / norms[a as usize])],
            None => Vec::new(),
        };
        let tentative = SparseRows::from_rows(count, (0..n).map(tentative));
        // One step of damped Jacobi smooths the steps between aggregates.
        let damping = 4.0 / (3.0 * self.greatest);
        let mut smoother = self.matrix.clone();
        smoother.map(|i, j, value| if i == j { 1.0 - damping * value } else { -damping * value });
        let mut prolongation = smoother.times(&tentative);
        drop(smoother);
        let image = self.matrix.times(&prolongation);
        let mut coarse = prolongation.transposed().times(&image);
        drop(image);
        let diagonal = |i| coarse.row(i).find(|(j, _)| *j == i).map_or(0.0, |(_, value)| value);
        let scale: Vec<f64> = (0..count).map(|i| 1.0 / diagonal(i).sqrt()).collect();
        if !scale.iter().all(|scale| scale.is_finite()) {
            return None;
        }
        coarse.map(|i, j, value| scale[i] * scale[j] * value);
        prolongation.map(|_, j, value| scale[j] * value);
        let coarse_null = norms.iter().zip(&scale).map(|(norm, scale)| norm / scale).collect();
        let restriction = prolongation.transposed();
        self.transfer = Some((prolongation, restriction));
        Some((coarse, coarse_null))
    }

    /// Two steps of Chebyshev's iteration from `x`, or from 0.
    fn smooth(&mut self, is_from_zero: bool, is_parallel: bool) {
        let Self { matrix, greatest, b, x, change, .. } = self;
        let Smoother { middle, keep, factor } = Smoother::new(*greatest);
        if is_from_zero {
            let start = |b: &Lanes| b.map(|b| b / middle);
            each_chunk(change, is_parallel, |first, part| {
                part.iter_mut().zip(&b[first..]).for_each(|(d, b)| *d = start(b));
            });
            x.copy_from_slice(change);
        } else {
            matrix.apply(0.0, 1.0 / middle, b, x, change, is_parallel);
            add(x, change, is_parallel);
        }
        matrix.apply(keep, factor, b, x, change, is_parallel);
        add(x, change, is_parallel);
    }

    /// Solves on the last level.
    fn solve(&mut self, coarsest: Option<&mut (Factor, Vec<DVec3>)>, is_parallel: bool) {
        let Some((factor, room)) = coarsest else {
            self.smooth(true, is_parallel);
            self.smooth(false, is_parallel);
            return;
        };
        for (room, b) in room.iter_mut().zip(&self.b) {
            *room = vector(*b);
        }
        factor.solve(room, false);
        for (x, room) in self.x.iter_mut().zip(room) {
            *x = lanes(*room);
        }
    }
}

fn add(x: &mut [Lanes], change: &[Lanes], is_parallel: bool) {
    each_chunk(x, is_parallel, |first, x| {
        for (x, change) in x.iter_mut().zip(&change[first..]) {
            *x = std::array::from_fn(|lane| x[lane] + change[lane]);
        }
    });
}

/// One V-cycle from the first of `levels`.
fn cycle(levels: &mut [Level], coarsest: Option<&mut (Factor, Vec<DVec3>)>, is_parallel: bool) {
    let Some((fine, coarser)) = levels.split_first_mut() else { return };
    if coarser.is_empty() {
        fine.solve(coarsest, is_parallel);
        return;
    }
    fine.smooth(true, is_parallel);
    if let (Some((_, restriction)), Some(next)) = (&fine.transfer, coarser.first_mut()) {
        fine.matrix.apply(0.0, 1.0, &fine.b, &fine.x, &mut fine.change, is_parallel);
        restriction.apply(0.0, -1.0, &[], &fine.change, &mut next.b, is_parallel);
    }
    cycle(coarser, coarsest, is_parallel);
    if let (Some((prolongation, _)), Some(next)) = (&fine.transfer, coarser.first()) {
        prolongation.apply(1.0, -1.0, &[], &next.x, &mut fine.x, is_parallel);
    }
    fine.smooth(false, is_parallel);
}

/// The factor of the coarsest matrix with room for right-hand sides; `None` if it is singular.
fn factor(matrix: &SparseRows) -> Result<Option<(Factor, Vec<DVec3>)>> {
    let n = matrix.row_count();
    let each = |visit: &mut dyn FnMut(u32, u32, f64)| {
        for i in 0..n {
            matrix.row(i).filter(|(j, _)| *j <= i).for_each(|(j, value)| visit(i as u32, j as u32, value));
        }
    };
    let mut symmetric = SymmetricMatrix::with_pattern(n, |report| each(&mut |i, j, _| report(i, j)))?;
    let mut is_whole = true;
    each(&mut |i, j, value| is_whole &= symmetric.add(i, j, value));
    let analysis = Analysis::new(symmetric.pattern(), &[])?;
    let mut factor = Factor::new(&analysis, symmetric.pattern())?;
    // A matrix that is not finite is none to solve with either.
    let is_good = is_whole && factor.factorise(&symmetric, false).is_ok() && !factor.is_singular();
    Ok(is_good.then(|| (factor, vec![DVec3::ZERO; n])))
}

/// The aggregate of each row, `None` for rows that need none, and the number of aggregates. Rows join greedily, in order.
fn aggregates(matrix: &SparseRows, strong: f64) -> (Vec<Option<u32>>, usize) {
    let n = matrix.row_count();
    let neighbours = |i: usize| matrix.row(i).filter(move |(j, value)| *j != i && *value < -strong);
    let mut is_dominated = vec![false; n];
    for (i, is_dominated) in is_dominated.iter_mut().enumerate() {
        *is_dominated = matrix.row(i).filter(|(j, _)| *j != i).map(|(_, value)| value.abs()).sum::<f64>() < DOMINATED;
    }
    let mut aggregate_of: Vec<Option<u32>> = vec![None; n];
    let mut count = 0_u32;
    // Whole neighbourhoods that are still free.
    for i in (0..n).filter(|&i| !is_dominated[i]) {
        let is_free = |j: usize| aggregate_of[j].is_none();
        if is_free(i) && neighbours(i).next().is_some() && neighbours(i).all(|(j, _)| is_free(j)) {
            aggregate_of[i] = Some(count);
            neighbours(i).filter(|(j, _)| !is_dominated[*j]).for_each(|(j, _)| aggregate_of[j] = Some(count));
            count += 1;
        }
    }
    // What is left joins the neighbourhood that it depends on most.
    let before = aggregate_of.clone();
    for i in (0..n).filter(|&i| !is_dominated[i] && before[i].is_none()) {
        let near = matrix.row(i).filter(|(j, _)| *j != i).filter_map(|(j, value)| before[j].map(|a| (a, value.abs())));
        let nearest = near.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        aggregate_of[i] = nearest.map(|(a, _)| a);
    }
    for i in (0..n).filter(|&i| !is_dominated[i]) {
        if aggregate_of[i].is_none() {
            aggregate_of[i] = Some(count);
            for (j, _) in neighbours(i).filter(|(j, _)| !is_dominated[*j]) {
                aggregate_of[j].get_or_insert(count);
            }
            count += 1;
        }
    }
    (aggregate_of, count as usize)
}
