//! The Cholesky factor of a sparse symmetric positive definite matrix: ordering, factor, solve.
//!
//! The matrix is scaled to a unit diagonal before it is factorised, so a pivot can be
//! judged by its own size whatever the weights are.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::matmul::{
    matmul,
    triangular::{self, BlockStructure},
};
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::factorize_symbolic_cholesky;
use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
};
use faer::sparse::linalg::{SupernodalThreshold, SymbolicSupernodalParams};
use faer::{Accum, MatMut, MatRef, Par, Side};
use glam::DVec3;

use super::fronts::{Lower, Product};
use super::nested_dissection::{self, Graph};
use super::panels::{Panels, Supernodes};
use super::simd::{Lanes, lanes, vector};
use super::symmetric::{Pattern, SymmetricMatrix};
use crate::error::{Error, Result, Status};

/// A pivot of the unit-diagonal matrix of `dimension` rows at or below this is round-off: the row depends on the ones before
/// it. Vanishing pivots of grids were found at an eighth of a unit in the last place of 1 per row.
fn singular_pivot(dimension: usize) -> f64 {
    (f64::EPSILON * dimension as f64).max(1e-13)
}

/// Adjacent supernodes of so many columns together are merged if at most this part of the merged block is zeros: wider
/// panels for a few more values.
const RELAX: [(usize, f64); 4] = [(4, 0.3), (16, 0.15), (48, 0.05), (usize::MAX, 0.02)];

/// Supernodal whatever the ratio of operations to entries is; that of a diagonal matrix is 0.
const ALWAYS_SUPERNODAL: SupernodalThreshold = SupernodalThreshold(-1.0);

/// Rows from which on nested dissection is tried beside minimum degree.
const LEAST_DISSECTED: usize = 20_000;

/// Values of the factor per row from which on it is tried. On sheets of quads (51 per row at 50 000 rows, 70 at a million) minimum
/// degree is better by a fifth; on blocks of tetrahedra (700 at 50 000, 980 at 100 000) dissection is, by 9 and 36 %; on triangulated
/// sheets with bending (149) by 10 %.
const LEAST_FILL: usize = 128;

/// A fill-reducing ordering and the pattern of the factor. It serves every matrix with the same pattern.
pub struct Analysis {
    symbolic: SymbolicCholesky<u32>,
}

impl std::fmt::Debug for Analysis {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Analysis").field("factor_value_count", &self.factor_value_count()).finish_non_exhaustive()
    }
}

impl Analysis {
    /// Analyses `pattern`, which has at least one row. `positions` says where each unknown lies: large systems are
    /// then ordered by nested dissection too, and the ordering with the smaller factor is kept. If there are more unknowns than
    /// positions, they are means of many points, which no cut separates, and minimum degree it is.
    ///
    /// # Errors
    /// Status `TooLarge` if memory does not suffice.
    pub fn new(pattern: &Pattern, positions: &[DVec3]) -> Result<Self> {
        let by_degree = Self::ordered(pattern, SymmetricOrdering::Amd)?;
        let is_worth_trying = pattern.dimension() >= LEAST_DISSECTED
            && by_degree.factor_value_count() >= LEAST_FILL * pattern.dimension()
            && positions.len() == pattern.dimension();
        if !is_worth_trying {
            return Ok(by_degree);
        }
        let graph = pattern.graph();
        let order = nested_dissection::order(&graph, positions, &mut |unknowns| order_leaf(&graph, unknowns));
        let mut inverse = vec![0_u32; order.len()];
        (0..).zip(&order).for_each(|(k, &unknown)| inverse[unknown as usize] = k);
        let permutation = PermRef::new_checked(&order, &inverse, pattern.dimension());
        let dissected = Self::ordered(pattern, SymmetricOrdering::Custom(permutation))?;
        Ok(if dissected.factor_value_count() < by_degree.factor_value_count() { dissected } else { by_degree })
    }

    fn ordered(pattern: &Pattern, ordering: SymmetricOrdering<'_, u32>) -> Result<Self> {
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: ALWAYS_SUPERNODAL,
            supernodal_params: SymbolicSupernodalParams { relax: Some(&RELAX) },
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(columns(pattern), Side::Lower, ordering, parameters);
        Ok(Self { symbolic: symbolic.map_err(|error| too_large("the analysis", &error))? })
    }

    /// The number of stored values of the factor.
    pub fn factor_value_count(&self) -> usize {
        self.symbolic.len_val()
    }
}

/// The Cholesky factor of a matrix, with the memory that solving needs.
pub struct Factor {
    panels: Panels,
    /// Where unknown `i` of the matrix lies among the panels' unknowns.
    place: Vec<u32>,
    /// `1/√` of the matrix's diagonal.
    scale: Vec<f64>,
    /// The entries of the matrix's lower triangle as [`Lower`] has them.
    starts: Vec<u32>,
    entries: Vec<[u32; 2]>,
    is_singular: bool,
}

impl std::fmt::Debug for Factor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Factor").field("is_singular", &self.is_singular).finish_non_exhaustive()
    }
}

impl Factor {
    /// Lays out the panels for factors of matrices with this pattern, which `analysis` is of.
    ///
    /// # Errors
    /// Status `Internal` if the analysis is not supernodal, which it always is.
    pub fn new(analysis: &Analysis, pattern: &Pattern) -> Result<Self> {
        let symbolic = supernodal(analysis)?;
        // The number of columns ends the list of where supernodes begin.
        let mut begins = symbolic.supernode_begin().to_vec();
        begins.push(symbolic.ncols() as u32);
        let panels = Panels::new(&Supernodes { begins: &begins, rows: &|s| symbolic.supernode(s).pattern() });
        let position = panels.position();
        let place: Vec<u32> = match analysis.symbolic.perm() {
            Some(permutation) => permutation.arrays().1.iter().map(|&i| position[i as usize]).collect(),
            None => position.to_vec(),
        };
        let mut starts = vec![0_u32; pattern.dimension() + 1];
        let ends =
            |i: u32, j: u32| (place[i as usize].min(place[j as usize]), place[i as usize].max(place[j as usize]));
        pattern.visit(|i, j, _| starts[ends(i, j).0 as usize + 1] += 1);
        for i in 0..pattern.dimension() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![[0; 2]; pattern.rows.len()];
        pattern.visit(|i, j, k| {
            let (column, row) = ends(i, j);
            let place = &mut next[column as usize];
            entries[*place as usize] = [row, k as u32];
            *place += 1;
        });
        Ok(Self { panels, scale: vec![1.0; place.len()], place, starts, entries, is_singular: false })
    }

    /// Factorises `matrix`, whose diagonal is above 0; in parallel on the current rayon pool if `is_parallel`, with the same
    /// bits. Where a row depends on others within round-off, [`Self::is_singular`] says so and the factor is of no use.
    ///
    /// # Errors
    /// Status `InvalidValue` if the matrix is not finite; `TooLarge` if memory does not suffice.
    pub fn factorise(&mut self, matrix: &SymmetricMatrix, is_parallel: bool) -> Result<()> {
        let mut scale = vec![0.0; matrix.dimension()];
        for (i, &place) in self.place.iter().enumerate() {
            self.scale[i] = 1.0 / matrix.diagonal(i).sqrt();
            scale[place as usize] = self.scale[i];
        }
        let lower = Lower { starts: &self.starts, entries: &self.entries, values: &matrix.values, scale: &scale };
        let outcome = self.panels.factorise(&lower, singular_pivot(matrix.dimension()), multiply, is_parallel);
        let outcome = outcome.map_err(|error| too_large("the factor", &error))?;
        self.is_singular = outcome.is_finite && outcome.is_singular;
        if !outcome.is_finite {
            return Err(Error::new(Status::InvalidValue, "the weights are too far apart for the system to be finite"));
        }
        Ok(())
    }

    /// True if a row of the last matrix depended on others within round-off.
    pub fn is_singular(&self) -> bool {
        self.is_singular
    }

    /// Bytes of the factor as it is stored.
    pub fn byte_count(&self) -> usize {
        self.panels.byte_count()
    }

    /// Where each unknown of the matrix lies in [`Self::rows`].
    pub fn place(&self) -> &[u32] {
        &self.place
    }

    /// What the right-hand side of each unknown is to be multiplied by before, and its solution after [`Self::solve_rows`].
    pub fn scale(&self) -> &[f64] {
        &self.scale
    }

    /// Right-hand sides before, solutions after [`Self::solve_rows`]: scaled, and in the order of the factor.
    pub fn rows(&self) -> &[Lanes] {
        self.panels.unknowns()
    }

    /// The rows, to be written, and the scale.
    pub fn rows_mut_and_scale(&mut self) -> (&mut [Lanes], &[f64]) {
        (self.panels.unknowns_mut(), &self.scale)
    }

    /// Solves for x, y and z in one pass, on the current rayon pool if `is_parallel`, the same bits either way. Allocates
    /// nothing.
    pub fn solve_rows(&mut self, is_parallel: bool) {
        self.panels.solve(is_parallel);
    }

    /// As [`Self::solve_rows`], in the matrix's own order and scale: `right_hand_sides` (its dimension) becomes the solution.
    pub fn solve(&mut self, right_hand_sides: &mut [DVec3], is_parallel: bool) {
        let x = self.panels.unknowns_mut();
        for ((rhs, scale), &place) in right_hand_sides.iter().zip(&self.scale).zip(&self.place) {
            x[place as usize] = lanes(*rhs * *scale);
        }
        self.panels.solve(is_parallel);
        let x = self.panels.unknowns_mut();
        for ((solution, scale), &place) in right_hand_sides.iter_mut().zip(&self.scale).zip(&self.place) {
            *solution = *scale * vector(x[place as usize]);
        }
    }
}

/// Orders the unknowns of a leaf by minimum degree among themselves; they stay as they are where that fails.
fn order_leaf(graph: &Graph, unknowns: &mut [u32]) {
    unknowns.sort_unstable();
    let (mut starts, mut rows) = (vec![0_u32], Vec::new());
    for unknown in &*unknowns {
        let neighbours =
            &graph.neighbours[graph.starts[*unknown as usize] as usize..graph.starts[*unknown as usize + 1] as usize];
        rows.extend(neighbours.iter().filter_map(|n| unknowns.binary_search(n).ok()).map(|place| place as u32));
        starts.push(rows.len() as u32);
    }
    let n = unknowns.len();
    let (mut order, mut inverse) = (vec![0_u32; n], vec![0_u32; n]);
    let Ok(mut scratch) = MemBuffer::try_new(amd::order_maybe_unsorted_scratch::<u32>(n, rows.len())) else { return };
    let pattern = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &starts, None, &rows);
    let stack = MemStack::new(&mut scratch);
    if amd::order_maybe_unsorted(&mut order, &mut inverse, pattern, Default::default(), stack).is_ok() {
        let old = unknowns.to_vec();
        unknowns.iter_mut().zip(order).for_each(|(place, k)| *place = old[k as usize]);
    }
}

fn supernodal(analysis: &Analysis) -> Result<&SymbolicSupernodalCholesky<u32>> {
    match analysis.symbolic.raw() {
        SymbolicCholeskyRaw::Supernodal(symbolic) => Ok(symbolic),
        SymbolicCholeskyRaw::Simplicial(_) => Err(Error::new(Status::Internal, "the analysis is not supernodal")),
    }
}

fn columns(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, u32> {
    let n = pattern.dimension();
    SymbolicSparseColMatRef::new_checked(n, n, &pattern.column_starts, None, &pattern.rows)
}

/// The products of a factorisation that are large enough for all the care that faer takes.
fn multiply(product: Product<'_>) {
    let Product { target, target_stride, rows, columns, left, left_stride, inner } = product;
    let target = MatMut::from_column_major_slice_with_stride_mut(target, rows, columns, target_stride);
    let left = MatRef::from_column_major_slice_with_stride(left, rows, inner, left_stride);
    let (triangle, below) = target.split_at_row_mut(columns);
    let (top, bottom) = left.split_at_row(columns);
    let full = BlockStructure::Rectangular;
    triangular::matmul(
        triangle,
        BlockStructure::TriangularLower,
        Accum::Add,
        top,
        full,
        top.transpose(),
        full,
        -1.0,
        Par::Seq,
    );
    matmul(below, Accum::Add, bottom, top.transpose(), -1.0, Par::Seq);
}

fn too_large(what: &str, error: &dyn std::fmt::Debug) -> Error {
    Error::new(Status::TooLarge, format!("{what} needs more memory than there is ({error:?})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of springs with one end held has a solution that can be written down: under a unit load at the free end,
    /// node `i` moves by the number of springs before it.
    #[test]
    fn a_chain_of_springs_stretches_linearly() {
        let n = 50_u32;
        let visit = |report: &mut dyn FnMut(u32, u32)| (1..n).for_each(|i| report(i, i - 1));
        let mut matrix = SymmetricMatrix::with_pattern(n as usize, visit).unwrap();
        *matrix.diagonal_mut(0) += 1.0;
        for i in 1..n {
            for (a, b, value) in [(i, i, 1.0), (i - 1, i - 1, 1.0), (i, i - 1, -1.0)] {
                assert!(matrix.add(a, b, value));
            }
        }
        assert!(!matrix.add(0, 5, 1.0));
        let analysis = Analysis::new(matrix.pattern(), &[]).unwrap();
        let mut factor = Factor::new(&analysis, matrix.pattern()).unwrap();
        factor.factorise(&matrix, false).unwrap();
        assert!(!factor.is_singular());
        let mut x = vec![DVec3::ZERO; n as usize];
        x[n as usize - 1] = DVec3::new(1.0, -2.0, 1e-6);
        let load = x.clone();
        factor.solve(&mut x, false);
        for (i, x) in x.iter().enumerate() {
            let expected = load[n as usize - 1] * (i + 1) as f64;
            assert!((*x - expected).length() < 1e-11, "{x} != {expected}");
        }
        let mut back = vec![DVec3::ZERO; n as usize];
        matrix.multiply(&x, &mut back);
        assert!(back.iter().zip(&load).all(|(a, b)| (*a - *b).length() < 1e-11));
    }

    /// The Laplacian of an `n × n` grid, which does not resist translations, with `held` added at the first node.
    fn grid(n: u32, stiffness: f64, held: f64) -> SymmetricMatrix {
        let edges = move |report: &mut dyn FnMut(u32, u32)| {
            for i in 0..n * n {
                if i % n + 1 < n {
                    report(i, i + 1);
                }
                if i / n + 1 < n {
                    report(i, i + n);
                }
            }
        };
        let mut matrix = SymmetricMatrix::with_pattern((n * n) as usize, edges).unwrap();
        edges(&mut |a, b| {
            for (i, j, value) in [(a, a, stiffness), (b, b, stiffness), (a, b, -stiffness)] {
                assert!(matrix.add(i, j, value));
            }
        });
        *matrix.diagonal_mut(0) += held;
        matrix
    }

    #[test]
    fn singular_matrices_of_any_size_are_recognised() {
        for n in [2, 5, 20, 80, 200] {
            for stiffness in [1e-8, 1.0, 3e8] {
                for (held, is_singular) in [(0.0, true), (1e-3 * stiffness, false)] {
                    let matrix = grid(n, stiffness, held);
                    let analysis = Analysis::new(matrix.pattern(), &[]).unwrap();
                    let mut factor = Factor::new(&analysis, matrix.pattern()).unwrap();
                    factor.factorise(&matrix, false).unwrap();
                    assert_eq!(factor.is_singular(), is_singular, "{n} × {n}, stiffness {stiffness}, held by {held}");
                }
            }
        }
    }

    /// A block of `n³` points, each tied to its neighbours in a cube of 27.
    fn block(n: u32) -> (SymmetricMatrix, Vec<DVec3>) {
        let at = move |i: u32| [i % n, i / n % n, i / n / n];
        let pairs = move |report: &mut dyn FnMut(u32, u32)| {
            for i in 0..n * n * n {
                let near = |axis: usize| at(i)[axis]..=(at(i)[axis] + 1).min(n - 1);
                for (x, y, z) in near(0).flat_map(|x| near(1).flat_map(move |y| near(2).map(move |z| (x, y, z)))) {
                    report(i, (z * n + y) * n + x);
                }
            }
        };
        let mut matrix = SymmetricMatrix::with_pattern((n * n * n) as usize, pairs).unwrap();
        pairs(&mut |i, j| assert!(i == j || matrix.add(i, j, -1.0)));
        for i in 0..n * n * n {
            *matrix.diagonal_mut(i as usize) += 30.0;
        }
        (matrix, (0..n * n * n).map(|i| at(i).map(f64::from).into()).collect())
    }

    #[test]
    fn dissecting_a_block_makes_a_smaller_factor_that_solves_as_well() {
        let (matrix, positions) = block(28);
        let by_degree = Analysis::new(matrix.pattern(), &[]).unwrap();
        let dissected = Analysis::new(matrix.pattern(), &positions).unwrap();
        assert!(dissected.factor_value_count() < by_degree.factor_value_count(), "{dissected:?}, {by_degree:?}");
        let mut factor = Factor::new(&dissected, matrix.pattern()).unwrap();
        factor.factorise(&matrix, false).unwrap();
        let mut x = positions.clone();
        factor.solve(&mut x, false);
        let mut image = positions.clone();
        matrix.multiply(&x, &mut image);
        assert!(image.iter().zip(&positions).all(|(a, b)| a.distance(*b) < 1e-12));
        // Its fronts are large enough to be shared by threads.
        for thread_count in [1, 2, 5] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(thread_count).build().unwrap();
            pool.install(|| factor.factorise(&matrix, true)).unwrap();
            let mut other = positions.clone();
            factor.solve(&mut other, false);
            assert!(other == x, "other bits on {thread_count} threads");
        }
    }

    #[test]
    fn large_products_are_what_is_defined() {
        let (rows, columns, inner, stride) = (12, 8, 5, 13);
        let numbers = |count: usize| (0..count).map(|i| (i * i % 31) as f64).collect::<Vec<f64>>();
        let (left, before) = (numbers(stride * inner), numbers(stride * columns));
        let mut target = before.clone();
        multiply(Product {
            target: &mut target,
            target_stride: stride,
            rows,
            columns,
            left: &left,
            left_stride: stride,
            inner,
        });
        for (i, j) in (0..columns).flat_map(|j| (j..rows).map(move |i| (i, j))) {
            let sum: f64 = (0..inner).map(|k| left[k * stride + i] * left[k * stride + j]).sum();
            assert_eq!(target[j * stride + i], before[j * stride + i] - sum);
        }
    }

    #[test]
    fn solutions_leave_no_residual_and_are_the_same_bits_on_any_number_of_threads() {
        // The largest is cut into parts.
        for n in [3, 30, 120] {
            let matrix = grid(n, 1.0, 1.0);
            let analysis = Analysis::new(matrix.pattern(), &[]).unwrap();
            let mut factor = Factor::new(&analysis, matrix.pattern()).unwrap();
            factor.factorise(&matrix, false).unwrap();
            let count = (n * n) as usize;
            let right: Vec<DVec3> =
                (0..count).map(|i| DVec3::new((i % 7) as f64 - 3.0, (i % 11) as f64 - 5.0, (i % 3) as f64)).collect();
            let mut x = right.clone();
            factor.solve(&mut x, false);
            let mut image = vec![DVec3::ZERO; count];
            matrix.multiply(&x, &mut image);
            let largest = x.iter().map(|x| x.length()).fold(0.0, f64::max);
            let residual = image.iter().zip(&right).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(residual < 1e-13 * largest, "{n} × {n}: residual {residual:e} at a solution of {largest:e}");
            for thread_count in [1, 2, 7] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(thread_count).build().unwrap();
                pool.install(|| factor.factorise(&matrix, true)).unwrap();
                let mut other = right.clone();
                pool.install(|| factor.solve(&mut other, true));
                assert!(other == x, "{n} × {n}: other bits on {thread_count} threads");
            }
        }
    }
}
