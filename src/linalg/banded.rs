//! Linear equations with a banded matrix, by elimination with row exchanges.

/// The factors of a square matrix whose entries are near its diagonal.
///
/// Gaussian elimination with partial pivoting (Golub & Van Loan, "Matrix Computations", section 4.3.3): exchanges widen the upper
/// band by the lower one. For `n` rows and bands of `b` entries it takes about `4 n b²` operations.
#[derive(Clone, Debug)]
pub struct BandedLu {
    dimension: usize,
    /// The number of diagonals below the main one.
    below: usize,
    /// The number of entries stored of each row: of row `i` the columns from `i − below` on.
    width: usize,
    /// Row by row: what is right of the diagonal is `U`, and the multipliers of `L` are where they made zeros.
    entries: Vec<f64>,
    /// Which row each one was exchanged with.
    exchanges: Vec<u32>,
}

impl BandedLu {
    /// Factorises the matrix of `dimension` rows with these entries `(row, column, value)`; repeated ones are added. `None` if a
    /// pivot vanishes or is not finite: the matrix is singular.
    pub fn new(dimension: usize, entries: &[(u32, u32, f64)]) -> Option<Self> {
        let reach = |of: fn(u32, u32) -> u32| entries.iter().map(|&(i, j, _)| of(i, j) as usize).max().unwrap_or(0);
        let (below, above) = (reach(|i, j| i.saturating_sub(j)), reach(|i, j| j.saturating_sub(i)));
        let width = 2 * below + above + 1;
        let mut stored = vec![0.0; dimension * width];
        for &(i, j, value) in entries {
            stored[i as usize * width + j as usize + below - i as usize] += value;
        }
        let mut lu = Self { dimension, below, width, entries: stored, exchanges: Vec::with_capacity(dimension) };
        lu.factorise().then_some(lu)
    }

    /// Where the entry `(i, j)` is stored.
    fn place(&self, i: usize, j: usize) -> usize {
        i * self.width + j + self.below - i
    }

    fn last_row(&self, k: usize) -> usize {
        (k + self.below).min(self.dimension - 1)
    }

    fn last_column(&self, k: usize) -> usize {
        (k + self.width - 1 - self.below).min(self.dimension - 1)
    }

    fn factorise(&mut self) -> bool {
        for k in 0..self.dimension {
            let (last_row, last_column) = (self.last_row(k), self.last_column(k));
            let size = |lu: &Self, i: usize| lu.entries[lu.place(i, k)].abs();
            let pivot = (k..=last_row).fold(k, |best, i| if size(self, i) > size(self, best) { i } else { best });
            if !(size(self, pivot) > 0.0 && size(self, pivot).is_finite()) {
                return false;
            }
            self.exchanges.push(pivot as u32);
            if pivot != k {
                (k..=last_column).for_each(|j| {
                    let (a, b) = (self.place(k, j), self.place(pivot, j));
                    self.entries.swap(a, b);
                });
            }
            let count = last_column - k;
            let start = self.place(k, k);
            for i in k + 1..=last_row {
                let at = self.place(i, k);
                let factor = self.entries[at] / self.entries[start];
                self.entries[at] = factor;
                if factor != 0.0 {
                    let (before, rest) = self.entries.split_at_mut(at);
                    let pivots = &before[start + 1..=start + count];
                    rest[1..=count].iter_mut().zip(pivots).for_each(|(entry, pivot)| *entry -= factor * pivot);
                }
            }
        }
        true
    }

    /// Replaces the right-hand side by the solution. It has an entry for each row.
    pub fn solve(&self, right: &mut [f64]) {
        for k in 0..self.dimension {
            right.swap(k, self.exchanges[k] as usize);
            let (known, rest) = right[..=self.last_row(k)].split_at_mut(k + 1);
            if let Some(last) = rest.len().checked_sub(1) {
                // One row on and one column back.
                let column = &self.entries[self.place(k + 1, k)..=self.place(k + 1 + last, k)];
                let factors = column.iter().step_by((self.width - 1).max(1));
                rest.iter_mut().zip(factors).for_each(|(entry, factor)| *entry -= factor * known[k]);
            }
        }
        for k in (0..self.dimension).rev() {
            let row = self.place(k, k);
            let after = &right[k + 1..=self.last_column(k)];
            let known: f64 = self.entries[row + 1..].iter().zip(after).map(|(entry, x)| entry * x).sum();
            right[k] = (right[k] - known) / self.entries[row];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dense::Svd;

    fn entry(i: usize, j: usize) -> f64 {
        ((7 * i + 13 * j + i * j) as f64 + 0.3).sin()
    }

    #[test]
    fn banded_solutions_are_those_of_dense_matrices() {
        for (n, below, above) in [(1, 0, 0), (7, 0, 2), (9, 2, 0), (30, 3, 2), (40, 1, 6), (12, 11, 11)] {
            // Zeros on the diagonal, so that rows must be exchanged, wherever a band is left.
            let is_in = |i: usize, j: usize| j <= i + above && i <= j + below && (i != j || below * above == 0);
            let all = || (0..n * n).map(|k| (k / n, k % n)).filter(|&(i, j)| is_in(i, j));
            let entries: Vec<_> = all().map(|(i, j)| (i as u32, j as u32, entry(i, j))).collect();
            let mut columns = vec![vec![0.0; n]; n];
            all().for_each(|(i, j)| columns[j][i] = entry(i, j));
            let right: Vec<f64> = (0..n).map(|i| (i as f64 + 0.5).cos()).collect();
            let mut found = right.clone();
            BandedLu::new(n, &entries).unwrap().solve(&mut found);
            let expected = Svd::new(n, &columns).unwrap().least_norm(&right, 0.0);
            let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
            assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9 * scale), "{n} {below} {above}");
        }
    }

    #[test]
    fn singular_matrices_have_no_factors() {
        assert!(BandedLu::new(2, &[(0, 0, 1.0), (0, 1, 1.0), (1, 0, 2.0), (1, 1, 2.0)]).is_none());
        assert!(BandedLu::new(2, &[(0, 0, f64::NAN), (1, 1, 1.0)]).is_none());
    }
}
