//! Which linear solver the global step uses: a factor, or conjugate gradients where the factor would not fit.
//!
//! The choice needs the ordering and the pattern of the factor, not its numbers, and both take memory in proportion to the
//! matrix's pattern. It depends on the problem alone, never on the machine.

use glam::DVec3;

use crate::error::{Error, Result, Status};
use crate::linalg::cholesky::{Analysis, Factor};
use crate::linalg::conjugate_gradients::ConjugateGradients;
use crate::linalg::simd::Lanes;
use crate::linalg::symmetric::{Pattern, SymmetricMatrix};

/// A value of the factor while it is computed: itself, and at most as much again for the fronts, which blocks of tetrahedra come
/// near.
const BYTES_PER_VALUE: u64 = 16;

/// The most bytes that `Automatic` spends on a factor: a third of the 6 GB that a large model may take, as the model, the
/// fronts of the factorisation and the host have their shares. A factor that fits is the faster per iteration, by a factor of
/// two on blocks of tetrahedra; conjugate gradients are ready sooner. `docs/mathematics.md` has figures.
pub(super) const LARGEST_FACTOR_BYTES: u64 = 2_000_000_000;

/// What conjugate gradients with a proximal step ask for, relative to what they do else. Along the motions that the step alone
/// holds the multigrid cycle underestimates the error, and the errors of all iterations add up.
const PROXIMAL_TOLERANCE: f64 = 1e-3;

/// How the linear system of the global step is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(i32)]
pub enum LinearSolver {
    /// `Direct` if the predicted factor takes at most 2 GB while it is computed, else `ConjugateGradients`.
    #[default]
    Automatic = 0,
    /// A Cholesky factor, computed once and used in every iteration.
    Direct = 1,
    /// Conjugate gradients from the current points, preconditioned by multigrid: little memory, no factor, and solutions to
    /// some 1e-12 of the model's size.
    ConjugateGradients = 2,
}

/// A linear solver for matrices of one pattern. It works on *rows* in an order and a scale of its own: see
/// [`LinearSystem::order`].
pub(super) struct LinearSystem {
    pub(super) wish: LinearSolver,
    kind: Kind,
    /// Why it is the one that it is.
    reason: String,
    /// Iterations, and solves cut short, before those that count.
    counts_before: [u64; 2],
}

enum Kind {
    Direct(Box<Factor>),
    Iterative {
        /// `None` before the first matrix.
        gradients: Option<Box<ConjugateGradients>>,
        rows: Vec<Lanes>,
        /// The matrix's own order and scale.
        place: Vec<u32>,
        scale: Vec<f64>,
    },
}

/// Where an unknown of the matrix lies among the rows, and what its right-hand side is to be multiplied by, and its solution
/// once more.
#[derive(Clone, Copy)]
pub(super) struct Order<'a> {
    pub(super) place: &'a [u32],
    pub(super) scale: &'a [f64],
}

impl LinearSystem {
    /// Chooses for `pattern`, whose first unknowns lie at `positions`. `largest_bytes` is
    /// [`LARGEST_FACTOR_BYTES`] but in tests.
    pub(super) fn new(pattern: &Pattern, positions: &[DVec3], wish: LinearSolver, largest_bytes: u64) -> Result<Self> {
        let made = |kind, reason| Ok(Self { wish, kind, reason, counts_before: [0; 2] });
        let iterative = || {
            let n = pattern.dimension();
            let (rows, place, scale) = (vec![[0.0; 4]; n], (0..n as u32).collect(), vec![1.0; n]);
            Kind::Iterative { gradients: None, rows, place, scale }
        };
        if wish == LinearSolver::ConjugateGradients {
            return made(iterative(), "as asked for".to_owned());
        }
        let analysis = match Analysis::new(pattern, positions) {
            Ok(analysis) => analysis,
            // The pattern of the factor alone is beyond 32-bit indices or the memory.
            Err(error) if error.status() == Status::TooLarge && wish == LinearSolver::Automatic => {
                return made(iterative(), format!("a factor is out of reach: {error}"));
            }
            Err(error) => return Err(error),
        };
        let bytes = BYTES_PER_VALUE.saturating_mul(analysis.factor_value_count() as u64);
        let megabytes = |bytes: u64| format!("{:.1} MB", bytes as f64 / 1e6);
        if wish == LinearSolver::Automatic && bytes > largest_bytes {
            let (found, bound) = (megabytes(bytes), megabytes(largest_bytes));
            return made(iterative(), format!("computing the factor would take {found}, above {bound}"));
        }
        let reason = match wish {
            LinearSolver::Direct => "as asked for".to_owned(),
            _ => format!("computing the factor takes {}, at most {}", megabytes(bytes), megabytes(largest_bytes)),
        };
        made(Kind::Direct(Box::new(Factor::new(&analysis, pattern)?)), reason)
    }

    /// Prepares for solving with `matrix`, whose diagonal is above 0; on the current rayon pool if `is_parallel`.
    pub(super) fn prepare(&mut self, matrix: &SymmetricMatrix, is_parallel: bool) -> Result<()> {
        match &mut self.kind {
            Kind::Direct(factor) => factor.factorise(matrix, is_parallel),
            Kind::Iterative { gradients, .. } => {
                // The last one's memory is free before the next one takes its own.
                *gradients = None;
                *gradients = Some(Box::new(ConjugateGradients::new(matrix)?));
                self.counts_before = [0; 2];
                Ok(())
            }
        }
    }

    /// Says that the matrix of the last [`Self::prepare`] has the pull of a proximal step.
    pub(super) fn expect_proximal_step(&mut self) {
        if let Kind::Iterative { gradients: Some(gradients), .. } = &mut self.kind {
            gradients.tighten(PROXIMAL_TOLERANCE);
        }
    }

    /// True if the matrix of the last [`Self::prepare`] is singular within round-off, or within what conjugate gradients
    /// can resolve.
    pub(super) fn is_singular(&mut self) -> bool {
        match &mut self.kind {
            Kind::Direct(factor) => factor.is_singular(),
            Kind::Iterative { gradients, .. } => {
                gradients.as_mut().is_some_and(|gradients| gradients.is_singular(false))
            }
        }
    }

    /// The order and scale of the rows; the scale changes with [`Self::prepare`].
    pub(super) fn order(&self) -> Order<'_> {
        match &self.kind {
            Kind::Direct(factor) => Order { place: factor.place(), scale: factor.scale() },
            Kind::Iterative { place, scale, .. } => Order { place, scale },
        }
    }

    /// Right-hand sides before, solutions after [`Self::solve`], both scaled.
    pub(super) fn rows(&self) -> &[Lanes] {
        match &self.kind {
            Kind::Direct(factor) => factor.rows(),
            Kind::Iterative { rows, .. } => rows,
        }
    }

    /// The rows, to be written, and the scale.
    pub(super) fn rows_mut_and_scale(&mut self) -> (&mut [Lanes], &[f64]) {
        match &mut self.kind {
            Kind::Direct(factor) => factor.rows_mut_and_scale(),
            Kind::Iterative { rows, scale, .. } => (rows, scale),
        }
    }

    /// The row of one unknown, to be given its right-hand side.
    pub(super) fn row_mut(&mut self, unknown: usize) -> (&mut Lanes, f64) {
        let place = self.order().place[unknown] as usize;
        let (rows, scale) = self.rows_mut_and_scale();
        (&mut rows[place], scale[unknown])
    }

    /// Solves in the rows. Conjugate gradients begin at `start`, which may be shorter than the matrix.
    pub(super) fn solve(&mut self, start: &[DVec3], is_parallel: bool) {
        match &mut self.kind {
            Kind::Direct(factor) => factor.solve_rows(is_parallel),
            Kind::Iterative { gradients: Some(gradients), rows, .. } => gradients.solve(rows, start, is_parallel),
            Kind::Iterative { gradients: None, .. } => {}
        }
    }

    /// `Direct` or `ConjugateGradients`.
    pub(super) fn used(&self) -> LinearSolver {
        match &self.kind {
            Kind::Direct(_) => LinearSolver::Direct,
            Kind::Iterative { .. } => LinearSolver::ConjugateGradients,
        }
    }

    /// Bytes of the factor as it is stored; `None` without one.
    pub(super) fn factor_byte_count(&self) -> Option<usize> {
        match &self.kind {
            Kind::Direct(factor) => Some(factor.byte_count()),
            Kind::Iterative { .. } => None,
        }
    }

    /// Why that one, in words, and how many solves since [`Self::restart_count`] were cut short.
    pub(super) fn reason(&self) -> String {
        match self.counts_of_all()[1] - self.counts_before[1] {
            0 => self.reason.clone(),
            1 => format!("{}; a solve used up its iterations short of the tolerance", self.reason),
            count => format!("{}; {count} solves used up their iterations short of the tolerance", self.reason),
        }
    }

    /// Iterations of conjugate gradients since [`Self::restart_count`]; 0 with a factor.
    pub(super) fn iteration_count(&self) -> u64 {
        self.counts_of_all()[0] - self.counts_before[0]
    }

    /// Counts iterations and solves that were cut short from 0 again.
    pub(super) fn restart_count(&mut self) {
        self.counts_before = self.counts_of_all();
    }

    fn counts_of_all(&self) -> [u64; 2] {
        match &self.kind {
            Kind::Iterative { gradients: Some(gradients), .. } => {
                [gradients.iteration_count(), gradients.cut_short_count()]
            }
            _ => [0; 2],
        }
    }
}

impl LinearSolver {
    /// The solver of this number.
    ///
    /// # Errors
    /// There is none.
    pub fn from_number(number: i32) -> Result<Self> {
        let all = [Self::Automatic, Self::Direct, Self::ConjugateGradients];
        all.into_iter().find(|solver| *solver as i32 == number).ok_or_else(|| {
            let reason = format!("expected 0 (automatic), 1 (direct) or 2 (conjugate gradients), found {number}");
            Error::new(Status::InvalidValue, reason)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::simd::{lanes, vector};

    #[test]
    fn automatic_takes_a_factor_up_to_the_bound_and_conjugate_gradients_beyond() {
        let chain = |report: &mut dyn FnMut(u32, u32)| (1..100).for_each(|i| report(i, i - 1));
        let mut matrix = SymmetricMatrix::with_pattern(100, chain).unwrap();
        (0..100).for_each(|i| *matrix.diagonal_mut(i) = 1.0);
        let bytes = 16 * Analysis::new(matrix.pattern(), &[]).unwrap().factor_value_count() as u64;
        for (wish, bound, expected, word) in [
            (LinearSolver::Automatic, LARGEST_FACTOR_BYTES, LinearSolver::Direct, "at most 2000.0 MB"),
            (LinearSolver::Automatic, bytes, LinearSolver::Direct, "at most"),
            (LinearSolver::Automatic, bytes - 1, LinearSolver::ConjugateGradients, "above"),
            (LinearSolver::Direct, 0, LinearSolver::Direct, "as asked for"),
            (LinearSolver::ConjugateGradients, u64::MAX, LinearSolver::ConjugateGradients, "as asked for"),
        ] {
            let mut system = LinearSystem::new(matrix.pattern(), &[], wish, bound).unwrap();
            assert_eq!(system.used(), expected);
            assert!(system.reason().contains(word), "{}", system.reason());
            system.prepare(&matrix, false).unwrap();
            assert!(!system.is_singular());
            for unknown in 0..100 {
                let (row, scale) = system.row_mut(unknown);
                *row = lanes(scale * DVec3::ONE);
            }
            system.solve(&[DVec3::ZERO; 100], false);
            for unknown in 0..100 {
                let (row, scale) = system.row_mut(unknown);
                assert!((scale * vector(*row) - DVec3::ONE).length() < 1e-14);
            }
        }
    }
}
