//! Sparse matrices by rows, and their products with three columns at once.
//!
//! All rows are kept, of a symmetric matrix both triangles: 12 bytes for each of twice as many entries as its lower triangle
//! has. For that, every row of a product is a sum of its own, in the order of its entries, so rows can be shared among threads
//! without changing a bit.

use rayon::prelude::*;

use super::simd::{Kernel, Lanes, dispatch, mul_add};
use super::symmetric::SymmetricMatrix;

/// Rows that one thread works on at a time: some 30 µs of work.
pub const CHUNK: usize = 1024;

/// Calls `work(first, part)` for every chunk of `vector`, which begins at entry `first`; on the current rayon pool if
/// `is_parallel`.
pub fn each_chunk(vector: &mut [Lanes], is_parallel: bool, work: impl Fn(usize, &mut [Lanes]) + Sync) {
    if is_parallel && vector.len() > CHUNK {
        vector.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, part)| work(chunk * CHUNK, part));
    } else {
        vector.chunks_mut(CHUNK).enumerate().for_each(|(chunk, part)| work(chunk * CHUNK, part));
    }
}

/// Fills `results` with `of_chunk(chunk)`; on the current rayon pool if `is_parallel`.
pub fn fill<T: Send>(results: &mut [T], is_parallel: bool, of_chunk: impl Fn(usize) -> T + Sync) {
    if is_parallel && results.len() > 1 {
        results.par_iter_mut().enumerate().for_each(|(chunk, result)| *result = of_chunk(chunk));
    } else {
        results.iter_mut().enumerate().for_each(|(chunk, result)| *result = of_chunk(chunk));
    }
}

/// A sparse matrix by rows.
#[derive(Clone)]
pub struct SparseRows {
    column_count: usize,
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl SparseRows {
    /// `S A S`, with the diagonal matrix `S` of the entries `scale`, one per row.
    pub fn scaled(matrix: &SymmetricMatrix, scale: &[f64]) -> Self {
        let n = matrix.dimension();
        let mut starts = vec![0_usize; n + 1];
        matrix.visit(|i, j, _| {
            starts[i as usize + 1] += 1;
            starts[j as usize + 1] += usize::from(i != j);
        });
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let (mut columns, mut values) = (vec![0_u32; starts[n]], vec![0.0; starts[n]]);
        // Columns ascend within a row, as `visit` goes through the lower triangle column by column.
        matrix.visit(|i, j, value| {
            let value = value * scale[i as usize] * scale[j as usize];
            let mut put = |row: u32, column: u32| {
                let place = &mut next[row as usize];
                (columns[*place], values[*place]) = (column, value);
                *place += 1;
            };
            put(i, j);
            if i != j {
                put(j, i);
            }
        });
        Self { column_count: n, starts, columns, values }
    }

    /// The matrix with these rows, each a list of columns and values.
    pub fn from_rows(column_count: usize, rows: impl Iterator<Item = Vec<(u32, f64)>>) -> Self {
        let mut made = Self { column_count, starts: vec![0], columns: Vec::new(), values: Vec::new() };
        for row in rows {
            made.columns.extend(row.iter().map(|(column, _)| *column));
            made.values.extend(row.iter().map(|(_, value)| *value));
            made.starts.push(made.columns.len());
        }
        made
    }

    /// The number of rows.
    pub fn row_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The columns and values of row `i`.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let entries = self.starts[i]..self.starts[i + 1];
        self.columns[entries.clone()].iter().map(|&column| column as usize).zip(self.values[entries].iter().copied())
    }

    /// Replaces the value in row `i` and column `j` by `new(i, j, value)`.
    pub fn map(&mut self, new: impl Fn(usize, usize, f64) -> f64) {
        for i in 0..self.row_count() {
            for k in self.starts[i]..self.starts[i + 1] {
                self.values[k] = new(i, self.columns[k] as usize, self.values[k]);
            }
        }
    }

    /// The transpose.
    pub fn transposed(&self) -> Self {
        let mut starts = vec![0_usize; self.column_count + 1];
        self.columns.iter().for_each(|&column| starts[column as usize + 1] += 1);
        for i in 0..self.column_count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let (mut columns, mut values) = (vec![0; self.columns.len()], vec![0.0; self.columns.len()]);
        for i in 0..self.row_count() {
            for (j, value) in self.row(i) {
                (columns[next[j]], values[next[j]]) = (i as u32, value);
                next[j] += 1;
            }
        }
        Self { column_count: self.row_count(), starts, columns, values }
    }

    /// `A B`, `A` being this matrix.
    pub fn times(&self, b: &Self) -> Self {
        let (mut sums, mut is_met, mut met) = (vec![0.0; b.column_count], vec![false; b.column_count], Vec::new());
        let rows = (0..self.row_count()).map(|i| {
            for (k, a) in self.row(i) {
                for (j, value) in b.row(k) {
                    if !is_met[j] {
                        is_met[j] = true;
                        met.push(j);
                    }
                    sums[j] += a * value;
                }
            }
            met.sort_unstable();
            let take = |j| {
                is_met[j] = false;
                (j as u32, std::mem::take(&mut sums[j]))
            };
            met.drain(..).map(take).collect()
        });
        Self::from_rows(b.column_count, rows)
    }

    /// `y ← keep y + factor (b − A x)`; an empty `b` is 0. What `y` was does not matter where `keep` is 0. On the current
    /// rayon pool if `is_parallel`, with the same bits either way.
    pub fn apply(&self, keep: f64, factor: f64, b: &[Lanes], x: &[Lanes], y: &mut [Lanes], is_parallel: bool) {
        each_chunk(y, is_parallel, |first, y| dispatch(Apply { matrix: self, first, keep, factor, b, x, y }));
    }
}

/// [`SparseRows::apply`] to the rows from `first`.
struct Apply<'a> {
    matrix: &'a SparseRows,
    first: usize,
    keep: f64,
    factor: f64,
    b: &'a [Lanes],
    x: &'a [Lanes],
    y: &'a mut [Lanes],
}

impl Kernel for Apply<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let Self { matrix, first, keep, factor, b, x, y } = self;
        for (i, y) in (first..).zip(y) {
            let entries = matrix.starts[i]..matrix.starts[i + 1];
            // Summed from 0 and not from b, so that b − A x of a solution keeps the accuracy of the sum.
            let mut sum = [0.0; 4];
            for (&column, &value) in matrix.columns[entries.clone()].iter().zip(&matrix.values[entries]) {
                let x = &x[column as usize];
                for lane in 0..4 {
                    sum[lane] = mul_add::<FMA>(value, x[lane], sum[lane]);
                }
            }
            for lane in 0..4 {
                let right = if b.is_empty() { 0.0 } else { b[i][lane] };
                let kept = if keep == 0.0 { 0.0 } else { keep * y[lane] };
                y[lane] = mul_add::<FMA>(factor, right - sum[lane], kept);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dense(matrix: &SparseRows) -> Vec<Vec<f64>> {
        let mut dense = vec![vec![0.0; matrix.column_count]; matrix.row_count()];
        for i in 0..matrix.row_count() {
            matrix.row(i).for_each(|(j, value)| dense[i][j] += value);
        }
        dense
    }

    /// A matrix with some entries missing, an empty row and an empty column among them.
    fn example(rows: usize, columns: usize) -> SparseRows {
        let row = |i: usize| {
            let is_there = |j: &usize| !(i * 7 + j * 3).is_multiple_of(4) && i != 2 && *j != 1;
            (0..columns).filter(is_there).map(|j| (j as u32, (i as f64 - 1.5) * 0.5 + j as f64)).collect()
        };
        SparseRows::from_rows(columns, (0..rows).map(row))
    }

    #[test]
    fn products_and_transposes_are_those_of_the_dense_matrices() {
        let (a, b) = (example(5, 7), example(7, 4));
        let (da, db, dt, dp) = (dense(&a), dense(&b), dense(&a.transposed()), dense(&a.times(&b)));
        for i in 0..5 {
            assert!((0..7).all(|j| dt[j][i] == da[i][j]));
            for j in 0..4 {
                let expected: f64 = (0..7).map(|k| da[i][k] * db[k][j]).sum();
                assert!((dp[i][j] - expected).abs() < 1e-12);
            }
        }
        let x: Vec<Lanes> = (0..7).map(|i| [f64::from(i), 1.0, -f64::from(i * i), 0.0]).collect();
        let right: Vec<Lanes> = (0..5).map(|i| [1.0, f64::from(i), 2.0, 0.0]).collect();
        let mut y = vec![[f64::NAN; 4]; 5];
        a.apply(0.0, 1.0, &right, &x, &mut y, false);
        a.apply(0.5, -2.0, &[], &x, &mut y, true);
        for i in 0..5 {
            for lane in 0..3 {
                let image: f64 = (0..7).map(|k| da[i][k] * x[k][lane]).sum();
                assert!((y[i][lane] - (0.5 * (right[i][lane] - image) + 2.0 * image)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn symmetric_matrices_get_both_triangles_and_their_scale() {
        let mut matrix = SymmetricMatrix::with_pattern(3, |report| report(2, 0)).unwrap();
        assert!(matrix.add(0, 0, 4.0) && matrix.add(1, 1, 9.0) && matrix.add(2, 2, 16.0) && matrix.add(0, 2, -2.0));
        let rows = SparseRows::scaled(&matrix, &[0.5, 1.0, 0.25]);
        assert_eq!(dense(&rows), [[1.0, 0.0, -0.25], [0.0, 9.0, 0.0], [-0.25, 0.0, 1.0]]);
    }
}
