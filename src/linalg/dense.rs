//! Singular value decompositions of dense matrices of any size, by faer, on one thread: null spaces and solutions of least norm.

use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::svd::{ComputeSvdVectors, svd, svd_scratch};
use faer::{Mat, Par};

/// Singular values below this multiple of the largest one count as zero, for matrices whose entries are good to round-off.
pub const ROUND_OFF: f64 = 1e-12;

/// A singular value decomposition `A = U diag(s) Vᵀ`.
#[derive(Debug)]
pub struct Svd {
    u: Mat<f64>,
    s: Vec<f64>,
    v: Mat<f64>,
}

impl Svd {
    /// Decomposes the matrix of `rows` rows with the given columns, each of that length; `None` if it cannot be decomposed
    /// (it is not finite).
    pub fn new(rows: usize, columns: &[Vec<f64>]) -> Option<Self> {
        let a = Mat::from_fn(rows, columns.len(), |i, j| columns[j][i]);
        let size = rows.min(columns.len());
        let (mut u, mut v, mut s) =
            (Mat::zeros(rows, size), Mat::zeros(columns.len(), columns.len()), Diag::zeros(size));
        let (thin, full) = (ComputeSvdVectors::Thin, ComputeSvdVectors::Full);
        let scratch = svd_scratch::<f64>(rows, columns.len(), thin, full, Par::Seq, Default::default());
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        let vectors = (Some(u.as_mut()), Some(v.as_mut()));
        svd(a.as_ref(), s.as_mut(), vectors.0, vectors.1, Par::Seq, stack, Default::default()).ok()?;
        let s: Vec<f64> = (0..size).map(|k| s[k]).collect();
        s.iter().all(|value| value.is_finite()).then_some(Self { u, s, v })
    }

    /// The singular values, descending; as many as the shorter side has entries.
    pub fn singular_values(&self) -> &[f64] {
        &self.s
    }

    /// The number of singular values above `tolerance` times the largest.
    pub fn rank(&self, tolerance: f64) -> usize {
        let largest = self.s.first().copied().unwrap_or(0.0);
        self.s.iter().take_while(|&&value| value > tolerance * largest).count()
    }

    /// An orthonormal basis of the vectors that the matrix maps to zero, up to `tolerance` times its largest singular value.
    pub fn null_space(&self, tolerance: f64) -> Vec<Vec<f64>> {
        let vector = |k: usize| (0..self.v.nrows()).map(|i| self.v[(i, k)]).collect();
        (self.rank(tolerance)..self.v.ncols()).map(vector).collect()
    }

    /// The unit vector that the matrix makes least of: the last right singular vector, which the sign is not determined of.
    pub fn least_vector(&self) -> Vec<f64> {
        let last = self.v.ncols().saturating_sub(1);
        (0..self.v.nrows()).map(|i| self.v[(i, last)]).collect()
    }

    /// Of all `x` for which `‖A x − b‖` is least, the shortest.
    pub fn least_norm(&self, b: &[f64], tolerance: f64) -> Vec<f64> {
        let mut x = vec![0.0; self.v.nrows()];
        for k in 0..self.rank(tolerance) {
            let coordinate = (0..b.len()).map(|i| self.u[(i, k)] * b[i]).sum::<f64>() / self.s[k];
            x.iter_mut().enumerate().for_each(|(i, x)| *x += coordinate * self.v[(i, k)]);
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn null_space_and_least_norm_are_those_of_a_matrix_of_known_rank() {
        // Columns a, b, a + b, a − 2b of three rows: rank 2.
        let (a, b) = ([1.0, 2.0, -1.0], [0.5, 0.0, 3.0]);
        let column = |s: f64, t: f64| (0..3).map(|i| s * a[i] + t * b[i]).collect::<Vec<f64>>();
        let columns = [column(1.0, 0.0), column(0.0, 1.0), column(1.0, 1.0), column(1.0, -2.0)];
        let svd = Svd::new(3, &columns).unwrap();
        assert_eq!((svd.rank(ROUND_OFF), svd.singular_values().len()), (2, 3));
        let times = |x: &[f64]| (0..3).map(|i| (0..4).map(|j| columns[j][i] * x[j]).sum()).collect::<Vec<f64>>();
        let basis = svd.null_space(ROUND_OFF);
        assert_eq!(basis.len(), 2);
        for vector in &basis {
            assert!(times(vector).iter().all(|value| value.abs() < 1e-14));
        }
        let x = svd.least_norm(&column(2.0, 3.0), ROUND_OFF);
        assert!(times(&x).iter().zip(column(2.0, 3.0)).all(|(found, wanted)| (found - wanted).abs() < 1e-13));
        for vector in &basis {
            assert!(vector.iter().zip(&x).map(|(v, x)| v * x).sum::<f64>().abs() < 1e-13);
        }
        assert!(times(&svd.least_vector()).iter().all(|value| value.abs() < 1e-14));
        assert!((svd.least_vector().iter().map(|v| v * v).sum::<f64>() - 1.0).abs() < 1e-14);
        assert!(Svd::new(1, &[vec![f64::NAN]]).is_none());
    }
}
