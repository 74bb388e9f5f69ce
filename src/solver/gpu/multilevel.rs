//! The multigrid cycle on the card: the twin of `linalg/multilevel.rs`, in single precision.
//!
//! Smoothing from zero is a polynomial of the matrix with two terms, and so one pass over it. The last level is solved with the
//! inverse of its Cholesky factor `L`, as `x = Wᵀ W b` with `W = L⁻¹`: rounded to single precision that is still symmetric
//! and positive, which a rounded inverse is not where the matrix is near to singular, and round-off stays along the vectors
//! that the matrix takes near to 0.

use wgpu::Buffer;

use super::card::{Card, Run};
use super::frame::Four;
use super::sliced::Sliced;
use crate::error::Result;
use crate::linalg::multilevel::{self, LevelParts, Smoother};
use crate::linalg::rows::SparseRows;

/// An approximate inverse on the card.
pub(super) struct Multilevel {
    levels: Vec<Level>,
    /// `W` and `Wᵀ` of the last level; none where it is smoothed only.
    coarsest: Option<[Sliced; 2]>,
}

struct Level {
    matrix: Sliced,
    smoother: Smoother,
    /// From the next level to this and back; none on the last.
    transfer: Option<[Sliced; 2]>,
    /// The right-hand side and the solution; none on the first level, whose vectors are the caller's.
    own: Option<[Buffer; 2]>,
    /// The residual or the smoother's change, and the solution after every other step.
    change: Buffer,
    next: Buffer,
}

impl Multilevel {
    /// Copies the levels of `cycle` to the card.
    ///
    /// # Errors
    /// Status `BackendUnavailable` if the card has no room, `BackendFailed` if it was lost.
    pub(super) fn new(card: &Card, cycle: &multilevel::Multilevel) -> Result<Self> {
        let level = |(number, parts): (usize, LevelParts<'_>)| Level::new(card, &parts, number == 0);
        let levels = cycle.levels().enumerate().map(level).collect::<Result<_>>()?;
        let last = cycle.levels().last().filter(|_| cycle.is_coarsest_solved());
        let coarsest = match last.and_then(|last| inverse_factor(last.matrix)) {
            Some(inverse) => Some([
                Sliced::new(card, "the factor of the coarsest level", &inverse)?,
                Sliced::new(card, "the factor of the coarsest level", &inverse.transposed())?,
            ]),
            None => None,
        };
        Ok(Self { levels, coarsest })
    }

    /// The matrix whose inverse this is near to.
    pub(super) fn matrix(&self) -> Option<&Sliced> {
        self.levels.first().map(|level| &level.matrix)
    }

    /// The runs that apply the approximate inverse to `b` and leave the result in `x`.
    ///
    /// # Errors
    /// Status `BackendFailed` if the card was lost.
    pub(super) fn runs(&self, card: &Card, b: &Buffer, x: &Buffer) -> Result<Vec<Run>> {
        let mut runs = Vec::new();
        add_cycle(card, &self.levels, self.coarsest.as_ref(), [b, x], &mut runs)?;
        Ok(runs)
    }
}

/// The runs of a V-cycle from the first of `levels`.
fn add_cycle(
    card: &Card,
    levels: &[Level],
    coarsest: Option<&[Sliced; 2]>,
    [b, x]: [&Buffer; 2],
    runs: &mut Vec<Run>,
) -> Result<()> {
    let Some((fine, coarser)) = levels.split_first() else { return Ok(()) };
    if let (Some([prolongation, restriction]), Some(next)) = (&fine.transfer, coarser.first())
        && let Some([next_b, next_x]) = &next.own
    {
        runs.extend(fine.smoothed_from_zero(card, b, x)?);
        runs.extend(fine.matrix.residual(card, b, x, &fine.change)?);
        runs.extend(restriction.image(card, &fine.change, next_b)?);
        add_cycle(card, coarser, coarsest, [next_b, next_x], runs)?;
        runs.extend(prolongation.add_image(card, next_x, x)?);
        runs.extend(fine.smoothed(card, b, x)?);
    } else if let Some([inverse, transposed]) = coarsest {
        runs.extend(inverse.image(card, b, &fine.next)?);
        runs.extend(transposed.image(card, &fine.next, x)?);
    } else {
        runs.extend(fine.smoothed_from_zero(card, b, x)?);
        runs.extend(fine.smoothed(card, b, x)?);
    }
    Ok(())
}

impl Level {
    fn new(card: &Card, parts: &LevelParts<'_>, is_first: bool) -> Result<Self> {
        let room =
            || card.room("a vector of the multigrid cycle", (parts.matrix.row_count() * size_of::<Four>()) as u64);
        let transfer = match parts.transfer {
            Some((prolongation, restriction)) => Some([
                Sliced::new(card, "a prolongation of the multigrid cycle", prolongation)?,
                Sliced::new(card, "a restriction of the multigrid cycle", restriction)?,
            ]),
            None => None,
        };
        Ok(Self {
            matrix: Sliced::new(card, "a matrix of the multigrid cycle", parts.matrix)?,
            smoother: parts.smoother,
            transfer,
            own: if is_first { None } else { Some([room()?, room()?]) },
            change: room()?,
            next: room()?,
        })
    }

    /// Two steps from 0. The first solution is `b / middle`, so the second is `b` and `A b` with a factor each.
    fn smoothed_from_zero(&self, card: &Card, b: &Buffer, x: &Buffer) -> Result<Vec<Run>> {
        let Smoother { middle, keep, factor } = self.smoother;
        self.matrix.combination(card, [(1.0 + keep) / middle + factor, -factor / middle], b, x)
    }

    /// Two steps from `x`.
    fn smoothed(&self, card: &Card, b: &Buffer, x: &Buffer) -> Result<Vec<Run>> {
        let Smoother { middle, keep, factor } = self.smoother;
        let mut runs = self.matrix.chebyshev(card, [0.0, 1.0 / middle], [b, x, &self.change, &self.next])?;
        runs.extend(self.matrix.chebyshev(card, [keep, factor], [b, &self.next, &self.change, x])?);
        Ok(runs)
    }
}

/// The inverse of the Cholesky factor of `matrix`, which is small; `None` if a pivot is not above 0.
fn inverse_factor(matrix: &SparseRows) -> Option<SparseRows> {
    let n = matrix.row_count();
    let mut factor = vec![vec![0.0; n]; n];
    for (i, row) in factor.iter_mut().enumerate() {
        matrix.row(i).filter(|(j, _)| *j <= i).for_each(|(j, value)| row[j] = value);
    }
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for i in 0..n {
        let (above, rest) = factor.split_at_mut(i);
        let row = &mut rest[0];
        for (j, other) in above.iter().enumerate() {
            row[j] = (row[j] - dot(&row[..j], &other[..j])) / other[j];
        }
        let pivot = row[i] - dot(&row[..i], &row[..i]);
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        row[i] = pivot.sqrt();
    }
    // Row i of W: e_i less what the factor takes of the rows above, over its diagonal.
    let mut inverse: Vec<Vec<f64>> = Vec::with_capacity(n);
    for (i, row) in factor.iter().enumerate() {
        let mut own = vec![0.0; i + 1];
        own[i] = 1.0;
        for (factor, above) in row.iter().zip(&inverse) {
            own.iter_mut().zip(above).for_each(|(own, above)| *own -= factor * above);
        }
        own.iter_mut().for_each(|own| *own /= row[i]);
        inverse.push(own);
    }
    let entries = |row: Vec<f64>| (0..).zip(row).filter(|(_, value)| *value != 0.0).collect();
    Some(SparseRows::from_rows(n, inverse.into_iter().map(entries)))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::linalg::simd::Lanes;
    use crate::linalg::symmetric::SymmetricMatrix;
    use crate::solver::gpu::sliced::tests::{Random, card};

    /// Springs between neighbours of a grid of these sizes, of a stiffness that varies by `spread`, each node of the first
    /// layer `held`.
    pub(in crate::solver::gpu) fn grid([nx, ny, nz]: [u32; 3], spread: f64, held: f64) -> SymmetricMatrix {
        let n = nx * ny * nz;
        let each = move |report: &mut dyn FnMut(u32, u32)| {
            for i in 0..n {
                let (x, y, z) = (i % nx, i / nx % ny, i / (nx * ny));
                for (stride, is_inside) in [(1, x + 1 < nx), (nx, y + 1 < ny), (nx * ny, z + 1 < nz)] {
                    if is_inside {
                        report(i, i + stride);
                    }
                }
            }
        };
        let mut matrix = SymmetricMatrix::with_pattern(n as usize, each).unwrap();
        each(&mut |a, b| {
            let stiffness = spread.powf(f64::from((a * 7 + b * 13) % 17) / 17.0);
            for (i, j, value) in [(a, a, stiffness), (b, b, stiffness), (a, b, -stiffness)] {
                assert!(matrix.add(i, j, value));
            }
        });
        (0..nx).for_each(|i| assert!(matrix.add(i, i, held)));
        matrix
    }

    /// The matrix with unit diagonal, and its cycle.
    pub(in crate::solver::gpu) fn prepared(matrix: &SymmetricMatrix) -> (SparseRows, multilevel::Multilevel) {
        let scale: Vec<f64> = (0..matrix.dimension()).map(|i| 1.0 / matrix.diagonal(i).sqrt()).collect();
        let rows = SparseRows::scaled(matrix, &scale);
        let near_null = scale.iter().map(|scale| 1.0 / scale).collect();
        (rows.clone(), multilevel::Multilevel::new(rows, near_null).unwrap())
    }

    /// The greatest difference of the card's cycle from the processor's, relative to its greatest entry, and the number of
    /// levels.
    fn difference(card: &Card, cycle: &mut multilevel::Multilevel) -> (f64, usize) {
        let (_, b, _) = cycle.parts();
        let n = b.len();
        let right = Random(n as u64).vector(n);
        b.iter_mut().zip(&right).for_each(|(b, right)| *b = [right[0], right[1], right[2], 0.0].map(f64::from));
        cycle.run(false);
        let on_card = Multilevel::new(card, cycle).unwrap();
        let b = card.buffer("b", &right).unwrap();
        let x = card.buffer("x", &vec![[f32::NAN; 4]; n]).unwrap();
        let runs = on_card.runs(card, &b, &x).unwrap();
        card.submit(&runs);
        let first: Vec<Vec<Four>> = card.read(&[(&x, n)]).unwrap();
        // Nothing of the first time may be left in the second.
        card.submit(&runs);
        let found: Vec<Vec<Four>> = card.read(&[(&x, n)]).unwrap();
        assert!(first == found, "the second time is not the first");
        let (_, _, expected) = cycle.parts();
        let size = expected.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
        let error = |(expected, found): (&Lanes, &Four)| {
            (0..3).map(|k| (expected[k] - f64::from(found[k])).abs()).fold(0.0, f64::max)
        };
        let greatest = expected.iter().zip(&found[0]).map(error).fold(0.0, f64::max);
        assert!(found[0].iter().all(|x| x[3] == 0.0));
        (greatest / size, on_card.levels.len())
    }

    #[test]
    fn a_cycle_is_the_processors() {
        let Some(card) = card(0) else { return };
        let mut levels_met = Vec::new();
        for (sizes, spread) in [
            ([1, 1, 1], 1.0),
            ([63, 1, 1], 1.0),
            ([64, 1, 1], 1.0),
            ([65, 1, 1], 1.0),
            ([73, 137, 1], 1.0),
            ([100, 100, 1], 1e3),
            ([22, 22, 22], 1.0),
            ([30, 30, 30], 1e3),
        ] {
            let (_, mut cycle) = prepared(&grid(sizes, spread, 1.0));
            let (error, levels) = difference(&card, &mut cycle);
            println!("{sizes:?}, spread {spread}: {levels} levels, {error:.1e}");
            assert!(error < 1e-5, "{sizes:?}, spread {spread}: {error:e}");
            levels_met.push(levels);
        }
        assert!([1, 3, 4].iter().all(|levels| levels_met.contains(levels)), "{levels_met:?}");
    }

    #[test]
    fn a_last_level_without_a_factor_is_smoothed_twice() {
        let Some(card) = card(0) else { return };
        // Nothing holds the grid: no factor. Unknowns that nothing connects: no second level.
        let (_, mut loose) = prepared(&grid([40, 40, 1], 1.0, 0.0));
        let (_, mut apart) = prepared(&grid([1000, 1, 1], 1.0, 1e5));
        for cycle in [&mut loose, &mut apart] {
            assert!(!cycle.is_coarsest_solved());
            let (error, levels) = difference(&card, cycle);
            println!("{levels} levels, {error:.1e}");
            assert!(error < 1e-5, "{error:e}");
        }
    }

    #[test]
    fn the_inverse_factor_is_one() {
        let (matrix, _) = prepared(&grid([7, 5, 3], 1e3, 1e-3));
        let inverse = inverse_factor(&matrix).unwrap();
        // W A Wᵀ is the identity.
        let product = inverse.times(&matrix).times(&inverse.transposed());
        for i in 0..105 {
            for (j, value) in product.row(i) {
                assert!((value - f64::from(u8::from(i == j))).abs() < 1e-9, "entry {i}, {j} is {value}");
            }
        }
        let indefinite = SparseRows::from_rows(2, [vec![(0, 1.0), (1, 2.0)], vec![(0, 2.0), (1, 1.0)]].into_iter());
        assert!(inverse_factor(&indefinite).is_none());
    }
}
