//! The nearest positive semidefinite matrix to a small symmetric one.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::{Mat, MatRef, Par};

/// The memory of the decomposition of one size; made once for many matrices.
pub struct PositivePart {
    size: usize,
    scratch: MemBuffer,
    values: faer::diag::Diag<f64>,
    vectors: Mat<f64>,
}

impl std::fmt::Debug for PositivePart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PositivePart").field("size", &self.size).finish_non_exhaustive()
    }
}

impl PositivePart {
    /// For matrices of `size` rows.
    pub fn new(size: usize) -> Self {
        let scratch = self_adjoint_evd_scratch::<f64>(size, ComputeEigenvectors::Yes, Par::Seq, Default::default());
        Self {
            size,
            scratch: MemBuffer::new(scratch),
            values: faer::diag::Diag::zeros(size),
            vectors: Mat::zeros(size, size),
        }
    }

    /// The rows of the matrices.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Replaces `matrix`, symmetric, row by row, by the matrix with the same eigenvectors whose negative eigenvalues
    /// are 0: the nearest positive semidefinite one (Higham 1988, "Computing a nearest symmetric positive semidefinite
    /// matrix"). One that cannot be decomposed (it is not finite) stays as it is.
    pub fn replace(&mut self, matrix: &mut [f64]) {
        let n = self.size;
        let view = MatRef::from_row_major_slice(matrix, n, n);
        let stack = MemStack::new(&mut self.scratch);
        let (values, vectors) = (self.values.as_mut(), self.vectors.as_mut());
        if self_adjoint_evd(view, values, Some(vectors), Par::Seq, stack, Default::default()).is_err() {
            return;
        }
        for k in 0..n {
            let value = self.values[k];
            // True for NaN too; eigenvalues ascend.
            if !(value < 0.0) {
                break;
            }
            let vector = self.vectors.col(k);
            for i in 0..n {
                let factor = value * vector[i];
                for j in 0..n {
                    matrix[i * n + j] -= factor * vector[j];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_eigenvalues_become_zero_and_the_others_stay() {
        // 3 and -1 along the diagonals of the first plane, 2 and -5 along the other axes.
        let mut matrix = [1.0, 2.0, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, -5.0];
        PositivePart::new(4).replace(&mut matrix);
        let expected = [1.5, 1.5, 0.0, 0.0, 1.5, 1.5, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert!(matrix.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{matrix:?}");
    }
}
