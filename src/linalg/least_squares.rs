//! Sparse linear least squares by the normal equations.

use glam::DVec3;

use super::cholesky::{Analysis, Factor};
use super::symmetric::SymmetricMatrix;
use crate::error::{Error, Result, Status};

/// Added to the diagonal of the normal equations, relative to each entry, so that unknowns that no equation determines stay where
/// they are: below the round-off of what is determined.
const DAMPING: f64 = 1e-12;

/// Equations `Σ coefficient · unknown = right-hand side`, to be met as well as possible.
#[derive(Clone, Debug, Default)]
pub struct LeastSquares {
    unknown_count: usize,
    starts: Vec<usize>,
    entries: Vec<(u32, f64)>,
    right: Vec<f64>,
}

impl LeastSquares {
    /// No equations yet.
    pub fn new(unknown_count: usize) -> Self {
        Self { unknown_count, starts: vec![0], ..Self::default() }
    }

    /// Adds an equation. Unknowns may repeat; one that does not exist makes [`LeastSquares::solve`] refuse.
    pub fn add(&mut self, entries: &[(u32, f64)], right: f64) {
        self.entries.extend_from_slice(entries);
        self.starts.push(self.entries.len());
        self.right.push(right);
    }

    fn equation(&self, k: usize) -> &[(u32, f64)] {
        &self.entries[self.starts[k]..self.starts[k + 1]]
    }

    /// The unknowns whose sum of squared residuals is least.
    ///
    /// # Errors
    /// An unknown out of range, a number that is not finite, too many unknowns for memory, or equations that leave the unknowns
    /// undetermined beyond round-off.
    pub fn solve(&self) -> Result<Vec<f64>> {
        if let Some(&(unknown, _)) = self.entries.iter().find(|(unknown, _)| *unknown as usize >= self.unknown_count) {
            let reason = format!("{unknown} is out of range for {} unknowns", self.unknown_count);
            return Err(Error::new(Status::IndexOutOfRange, reason));
        }
        let finite =
            self.entries.iter().all(|(_, value)| value.is_finite()) && self.right.iter().all(|r| r.is_finite());
        if !finite {
            return Err(Error::new(Status::InvalidValue, "expected finite coefficients"));
        }
        if self.unknown_count == 0 {
            return Ok(Vec::new());
        }
        let mut matrix = SymmetricMatrix::with_pattern(self.unknown_count, |visit| {
            for k in 0..self.right.len() {
                let equation = self.equation(k);
                for (a, &(i, _)) in equation.iter().enumerate() {
                    equation[a..].iter().for_each(|&(j, _)| visit(i, j));
                }
            }
        })?;
        let mut right = vec![DVec3::ZERO; self.unknown_count];
        for k in 0..self.right.len() {
            let equation = self.equation(k);
            for &(i, a) in equation {
                right[i as usize].x += a * self.right[k];
                // `add` stands for both triangles, so the pair (i, j) is taken once.
                for &(j, b) in equation.iter().filter(|&&(j, _)| j <= i) {
                    let added = matrix.add(i, j, a * b);
                    debug_assert!(added, "the pattern has every pair of an equation");
                }
            }
        }
        for i in 0..self.unknown_count {
            let diagonal = matrix.diagonal_mut(i);
            *diagonal += DAMPING * if *diagonal > 0.0 { *diagonal } else { 1.0 };
        }
        let analysis = Analysis::new(matrix.pattern(), &[])?;
        let mut factor = Factor::new(&analysis, matrix.pattern())?;
        factor.factorise(&matrix, false)?;
        if factor.is_singular() {
            return Err(Error::new(Status::NoSolution, "the equations leave unknowns undetermined"));
        }
        factor.solve(&mut right, false);
        Ok(right.into_iter().map(|x| x.x).collect())
    }

    /// `Σ coefficient · unknown − right-hand side` of each equation.
    pub fn residuals(&self, unknowns: &[f64]) -> Vec<f64> {
        let left = |k: usize| self.equation(k).iter().map(|&(i, a)| a * unknowns[i as usize]).sum::<f64>();
        (0..self.right.len()).map(|k| left(k) - self.right[k]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_fitted_as_its_formula_says() {
        // y = a + b t through (0, 1), (1, 3), (2, 4), (3, 4): means 1.5 and 3, b = Σ(t−t̄)(y−ȳ)/Σ(t−t̄)² = 5/5, a = 3 − 1.5.
        let mut system = LeastSquares::new(2);
        for (t, y) in [(0.0, 1.0), (1.0, 3.0), (2.0, 4.0), (3.0, 4.0)] {
            system.add(&[(0, 1.0), (1, t)], y);
        }
        let found = system.solve().unwrap();
        assert!((found[0] - 1.5).abs() < 1e-10 && (found[1] - 1.0).abs() < 1e-10, "{found:?}");
        let residuals = system.residuals(&found);
        assert!(residuals.iter().sum::<f64>().abs() < 1e-10);
        assert!((residuals.iter().map(|r| r * r).sum::<f64>() - 1.0).abs() < 1e-10);
    }

    #[test]
    fn an_unknown_may_repeat_in_an_equation_and_others_may_be_unused() {
        let mut system = LeastSquares::new(3);
        system.add(&[(2, 1.0), (2, 3.0)], 8.0);
        system.add(&[(0, 2.0)], 1.0);
        let found = system.solve().unwrap();
        assert!((found[2] - 2.0).abs() < 1e-9 && (found[0] - 0.5).abs() < 1e-9 && found[1] == 0.0, "{found:?}");
        system.add(&[(3, 1.0)], 0.0);
        assert_eq!(system.solve().unwrap_err().status(), Status::IndexOutOfRange);
        let mut bad = LeastSquares::new(1);
        bad.add(&[(0, f64::NAN)], 0.0);
        assert_eq!(bad.solve().unwrap_err().status(), Status::InvalidValue);
        assert_eq!(LeastSquares::new(0).solve().unwrap(), Vec::<f64>::new());
    }
}
