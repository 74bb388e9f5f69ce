//! Sparse linear least squares by the normal equations.

use glam::DVec3;

use super::cholesky::{Analysis, Factor};
use super::symmetric::SymmetricMatrix;
use crate::error::{Error, Result, Status};

/// Added to the diagonal of the normal equations, relative to each entry, so that unknowns that no equation determines stay where
/// they are: below the round-off of what is determined.
const DAMPING: f64 = 1e-12;

/// Systems of so many unknowns are worth the threads of the pool; the bits are the same.
const LEAST_PARALLEL: usize = 2000;

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

    /// Takes all equations away, to add others for as many unknowns.
    pub fn clear(&mut self) {
        self.starts.truncate(1);
        self.entries.clear();
        self.right.clear();
    }

    /// The sum of the squared right-hand sides.
    pub fn squared_right(&self) -> f64 {
        self.right.iter().map(|r| r * r).sum()
    }

    /// `Aᵀ b`: for each unknown the sum of its coefficients times the right-hand sides.
    pub fn transposed_right(&self) -> Vec<f64> {
        let mut sums = vec![0.0; self.unknown_count];
        for k in 0..self.right.len() {
            self.equation(k).iter().for_each(|&(i, a)| sums[i as usize] += a * self.right[k]);
        }
        sums
    }

    /// The unknowns whose sum of squared residuals is least.
    ///
    /// # Errors
    /// An unknown out of range, a number that is not finite, too many unknowns for memory, or equations that leave the unknowns
    /// undetermined beyond round-off.
    pub fn solve(&self) -> Result<Vec<f64>> {
        Solver::default().solve(self, 0.0)
    }

    fn check(&self) -> Result<()> {
        if let Some(&(unknown, _)) = self.entries.iter().find(|(unknown, _)| *unknown as usize >= self.unknown_count) {
            let reason = format!("{unknown} is out of range for {} unknowns", self.unknown_count);
            return Err(Error::new(Status::IndexOutOfRange, reason));
        }
        let finite =
            self.entries.iter().all(|(_, value)| value.is_finite()) && self.right.iter().all(|r| r.is_finite());
        if finite { Ok(()) } else { Err(Error::new(Status::InvalidValue, "expected finite coefficients")) }
    }

    /// `Σ coefficient · unknown − right-hand side` of each equation.
    pub fn residuals(&self, unknowns: &[f64]) -> Vec<f64> {
        let left = |k: usize| self.equation(k).iter().map(|&(i, a)| a * unknowns[i as usize]).sum::<f64>();
        (0..self.right.len()).map(|k| left(k) - self.right[k]).collect()
    }
}

/// Solves systems one after the other. Where the unknowns of each equation are those of the system before, in the same order, its
/// ordering and the pattern of its factor serve again.
#[derive(Debug, Default)]
pub struct Solver {
    prepared: Option<Prepared>,
}

#[derive(Debug)]
struct Prepared {
    unknown_count: usize,
    starts: Vec<usize>,
    unknowns: Vec<u32>,
    /// Where in the matrix the products go, equation by equation, as [`Prepared::assemble`] makes them.
    places: Vec<u32>,
    matrix: SymmetricMatrix,
    factor: Factor,
}

impl Solver {
    /// The `x` of least `Σ residual² + damping · Σ d x²`, with `d` the sum of the squared coefficients of each unknown: with damping
    /// 0 the solution of the system, with more a shorter one.
    ///
    /// # Errors
    /// As [`LeastSquares::solve`].
    pub fn solve(&mut self, system: &LeastSquares, damping: f64) -> Result<Vec<f64>> {
        system.check()?;
        if system.unknown_count == 0 {
            return Ok(Vec::new());
        }
        if !self.prepared.as_ref().is_some_and(|prepared| prepared.serves(system)) {
            self.prepared = None;
        }
        let prepared = match self.prepared.take() {
            Some(prepared) => prepared,
            None => Prepared::new(system)?,
        };
        self.prepared.insert(prepared).solve(system, damping)
    }
}

impl Prepared {
    fn new(system: &LeastSquares) -> Result<Self> {
        let equations = || (0..system.right.len()).map(|k| system.equation(k));
        let matrix = SymmetricMatrix::with_pattern(system.unknown_count, |visit| {
            for equation in equations() {
                for (a, &(i, _)) in equation.iter().enumerate() {
                    equation[a..].iter().for_each(|&(j, _)| visit(i, j));
                }
            }
        })?;
        let pairs = equations().flat_map(|equation| equation.iter().flat_map(|&(i, _)| lower(equation, i)));
        let places =
            pairs.map(|(i, j, _)| matrix.pattern().place(i, j).map_or(u32::MAX, |place| place as u32)).collect();
        let analysis = Analysis::new(matrix.pattern(), &[])?;
        let factor = Factor::new(&analysis, matrix.pattern())?;
        Ok(Self {
            unknown_count: system.unknown_count,
            starts: system.starts.clone(),
            unknowns: system.entries.iter().map(|&(i, _)| i).collect(),
            places,
            matrix,
            factor,
        })
    }

    fn serves(&self, system: &LeastSquares) -> bool {
        self.unknown_count == system.unknown_count
            && self.starts == system.starts
            && self.unknowns.iter().copied().eq(system.entries.iter().map(|&(i, _)| i))
    }

    /// The normal equations' matrix. Each pair of a row and a column is one entry of the lower triangle, for both.
    fn assemble(&mut self, system: &LeastSquares, damping: f64) {
        let (_, values) = self.matrix.split();
        values.fill(0.0);
        let mut places = self.places.iter();
        for k in 0..system.right.len() {
            let equation = system.equation(k);
            for &(i, a) in equation {
                for ((_, _, b), &place) in lower(equation, i).zip(&mut places) {
                    values[place as usize] += a * b;
                }
            }
        }
        for i in 0..self.unknown_count {
            let diagonal = self.matrix.diagonal_mut(i);
            *diagonal += (DAMPING + damping) * if *diagonal > 0.0 { *diagonal } else { 1.0 };
        }
    }

    fn solve(&mut self, system: &LeastSquares, damping: f64) -> Result<Vec<f64>> {
        self.assemble(system, damping);
        let is_parallel = self.unknown_count >= LEAST_PARALLEL;
        self.factor.factorise(&self.matrix, is_parallel)?;
        if self.factor.is_singular() {
            return Err(Error::new(Status::NoSolution, "the equations leave unknowns undetermined"));
        }
        let mut right: Vec<DVec3> = system.transposed_right().into_iter().map(|sum| sum * DVec3::X).collect();
        self.factor.solve(&mut right, is_parallel);
        Ok(right.into_iter().map(|x| x.x).collect())
    }
}

/// What the row `i` of an equation's products has in the lower triangle: `(row, column, coefficient)`.
fn lower(equation: &[(u32, f64)], i: u32) -> impl Iterator<Item = (u32, u32, f64)> + '_ {
    equation.iter().filter(move |&&(j, _)| j <= i).map(move |&(j, b)| (i, j, b))
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

    #[test]
    fn a_solver_is_the_same_the_second_time_and_for_another_pattern() {
        let line = |values: [f64; 3]| {
            let mut system = LeastSquares::new(2);
            values.iter().enumerate().for_each(|(t, &y)| system.add(&[(0, 1.0), (1, t as f64)], y));
            system
        };
        let mut solver = Solver::default();
        for values in [[1.0, 3.0, 4.0], [2.0, -1.0, 0.5]] {
            assert_eq!(solver.solve(&line(values), 0.0).unwrap(), line(values).solve().unwrap());
        }
        let mut other = LeastSquares::new(2);
        other.add(&[(1, 2.0)], 6.0);
        other.add(&[(0, 1.0)], 1.0);
        assert!((solver.solve(&other, 0.0).unwrap()[1] - 3.0).abs() < 1e-10);
        // Damping 1 doubles each diagonal entry, here all of the matrix.
        assert!((solver.solve(&other, 1.0).unwrap()[1] - 1.5).abs() < 1e-10);
        assert_eq!((other.squared_right(), other.transposed_right()), (37.0, vec![1.0, 12.0]));
        other.clear();
        assert_eq!(solver.solve(&other, 0.0).unwrap(), [0.0, 0.0]);
    }
}
