//! The multigrid cycle on the card: the twin of `linalg/multilevel.rs`, in single precision.
//!
//! The processor's levels have unknowns in which the diagonal is 1. Here they are divided by what the matrix takes near to 0,
//! so that this becomes equal numbers, and the matrix springs (`sliced.rs`). The smoother then divides by the diagonal, whose
//! inverse is the fourth number of every right-hand side.
//!
//! Smoothing from zero is a polynomial of the matrix with two terms, and so one pass over it. The first step of smoothing after
//! the next level's correction `P e` asks for `b − A (x + P e)`, of which `b − A x` is known and `A P` a matrix of few entries,
//! made beforehand. The last level is solved with the
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
    scales: Vec<[f32; 2]>,
}

struct Level {
    matrix: Sliced,
    smoother: Smoother,
    /// From the next level to this, with the matrix's image of it, and back; none on the last.
    transfer: Option<[Sliced; 2]>,
    /// The right-hand side and the solution; none on the first level, whose vectors are the caller's.
    own: Option<[Buffer; 2]>,
    /// The residual or the smoother's change, and the solution before the last step.
    change: Buffer,
    next: Buffer,
}

impl Multilevel {
    /// Copies the levels of `cycle` to the card.
    ///
    /// # Errors
    /// Status `BackendUnavailable` if the card has no room, `BackendFailed` if it was lost.
    pub(super) fn new(card: &Card, cycle: &multilevel::Multilevel) -> Result<Self> {
        let parts: Vec<LevelParts<'_>> = cycle.levels().collect();
        let units: Vec<Vec<f64>> = parts.iter().map(|parts| unit(parts.near_null)).collect();
        let mut levels = Vec::with_capacity(parts.len());
        for (i, (parts, unit)) in parts.iter().zip(&units).enumerate() {
            let next_unit = units.get(i + 1).map(|unit| &unit[..]);
            levels.push(Level::new(card, parts, unit, next_unit, i == 0)?);
        }
        let coarsest = match (parts.last(), units.last()) {
            (Some(last), Some(unit)) if cycle.is_coarsest_solved() => inverse_factor(last.matrix, unit),
            _ => None,
        };
        let coarsest = match coarsest {
            Some(inverse) => Some([
                Sliced::new(card, "the factor of the coarsest level", &inverse)?,
                Sliced::new(card, "the factor of the coarsest level", &inverse.transposed())?,
            ]),
            None => None,
        };
        let scales = match (parts.first(), units.first()) {
            (Some(first), Some(unit)) => scales(first.matrix, unit),
            _ => Vec::new(),
        };
        Ok(Self { levels, coarsest, scales })
    }

    /// The matrix whose inverse this is near to, as springs.
    pub(super) fn matrix(&self) -> Option<&Sliced> {
        self.levels.first().map(|level| &level.matrix)
    }

    /// For each unknown of the first level, what its unit is in the processor's unknowns, and the inverse of the diagonal.
    pub(super) fn scales(&self) -> &[[f32; 2]] {
        &self.scales
    }

    /// The runs that apply the approximate inverse to `b` and leave the result in `x`. The fourth numbers of `b` are the second
    /// of [`Self::scales`].
    ///
    /// # Errors
    /// Status `BackendFailed` if the card was lost.
    pub(super) fn runs(&self, card: &Card, b: &Buffer, x: &Buffer) -> Result<Vec<Run>> {
        let mut runs = Vec::new();
        add_cycle(card, &self.levels, self.coarsest.as_ref(), [b, x], &mut runs)?;
        Ok(runs)
    }
}

/// What an unknown of the card is in the processor's: `near_null`, the greatest being 1, so that numbers stay in range.
fn unit(near_null: &[f64]) -> Vec<f64> {
    let greatest = near_null.iter().copied().fold(0.0, f64::max);
    near_null.iter().map(|value| value / greatest).collect()
}

/// See [`Multilevel::scales`].
fn scales(matrix: &SparseRows, unit: &[f64]) -> Vec<[f32; 2]> {
    let diagonal = |i: usize| matrix.row(i).find(|(j, _)| *j == i).map_or(1.0, |(_, value)| value);
    let of = |(i, unit): (usize, &f64)| [*unit as f32, (1.0 / (diagonal(i) * unit * unit)) as f32];
    unit.iter().enumerate().map(of).collect()
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
        runs.extend(fine.smoothed_from_zero(card, b, &fine.next)?);
        runs.extend(fine.matrix.springs_residual(card, b, &fine.next, &fine.change)?);
        runs.extend(restriction.image(card, &fine.change, next_b)?);
        add_cycle(card, coarser, coarsest, [next_b, next_x], runs)?;
        let factor = 1.0 / fine.smoother.middle;
        runs.extend(prolongation.corrected(card, factor, [next_x, &fine.change, &fine.next])?);
        runs.extend(fine.second_step(card, b, x)?);
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
    /// `unit` is what an unknown is in the processor's, `next_unit` the same on the next level.
    fn new(
        card: &Card,
        parts: &LevelParts<'_>,
        unit: &[f64],
        next_unit: Option<&[f64]>,
        is_first: bool,
    ) -> Result<Self> {
        let mut matrix = parts.matrix.clone();
        matrix.map(|i, j, value| unit[i] * unit[j] * value);
        let transfer = match (parts.transfer, next_unit) {
            (Some((prolongation, _)), Some(next_unit)) => {
                let mut prolongation = prolongation.clone();
                prolongation.map(|i, j, value| next_unit[j] / unit[i] * value);
                let image = matrix.times(&prolongation);
                Some([
                    Sliced::prolongation(card, "a prolongation of the multigrid cycle", &prolongation, &image)?,
                    Sliced::new(card, "a restriction of the multigrid cycle", &prolongation.transposed())?,
                ])
            }
            _ => None,
        };
        let zero = || card.room("a vector of the multigrid cycle", (unit.len() * size_of::<Four>()) as u64);
        let own = if is_first {
            None
        } else {
            // Restricting leaves the fourth numbers as they are.
            let right: Vec<Four> = scales(parts.matrix, unit).iter().map(|scale| [0.0, 0.0, 0.0, scale[1]]).collect();
            Some([card.buffer("a vector of the multigrid cycle", &right)?, zero()?])
        };
        Ok(Self {
            matrix: Sliced::springs(card, "a matrix of the multigrid cycle", &matrix)?,
            smoother: parts.smoother,
            transfer,
            own,
            change: zero()?,
            next: zero()?,
        })
    }

    /// Two steps from 0. With the diagonal's inverse `D` the first solution is `D b / middle`, so the second is `D b` and
    /// `D A D b` with a factor each.
    fn smoothed_from_zero(&self, card: &Card, b: &Buffer, x: &Buffer) -> Result<Vec<Run>> {
        let Smoother { middle, keep, factor } = self.smoother;
        self.matrix.smoothed_from_zero(card, [(1.0 + keep) / middle + factor, -factor / middle], b, x)
    }

    /// Two steps from `x`.
    fn smoothed(&self, card: &Card, b: &Buffer, x: &Buffer) -> Result<Vec<Run>> {
        let middle = self.smoother.middle;
        let mut runs = self.matrix.chebyshev(card, [0.0, 1.0 / middle], [b, x, &self.change, &self.next])?;
        runs.extend(self.second_step(card, b, x)?);
        Ok(runs)
    }

    /// The second of two steps, to `x` from what the first one made.
    fn second_step(&self, card: &Card, b: &Buffer, x: &Buffer) -> Result<Vec<Run>> {
        let Smoother { keep, factor, .. } = self.smoother;
        self.matrix.chebyshev(card, [keep, factor], [b, &self.next, &self.change, x])
    }
}

/// The inverse of the Cholesky factor of `matrix`, which is small, in unknowns of these units; `None` if a pivot is not
/// above 0.
fn inverse_factor(matrix: &SparseRows, unit: &[f64]) -> Option<SparseRows> {
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
    let entries = |row: Vec<f64>| {
        let scaled = (0..).zip(row).zip(unit).map(|((j, value), unit)| (j, value / unit));
        scaled.filter(|(_, value)| *value != 0.0).collect()
    };
    Some(SparseRows::from_rows(n, inverse.into_iter().map(entries)))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::linalg::simd::Lanes;
    use crate::linalg::symmetric::SymmetricMatrix;
    use crate::solver::gpu::tests::{Random, card};

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
        let mut right = Random(n as u64).vector(n);
        b.iter_mut().zip(&right).for_each(|(b, right)| *b = [right[0], right[1], right[2], 0.0].map(f64::from));
        cycle.run(false);
        let on_card = Multilevel::new(card, cycle).unwrap();
        for (right, [unit, inverse_diagonal]) in right.iter_mut().zip(on_card.scales()) {
            *right = [unit * right[0], unit * right[1], unit * right[2], *inverse_diagonal];
        }
        let b = card.buffer("b", &right).unwrap();
        let x = card.buffer("x", &vec![[f32::NAN, f32::NAN, f32::NAN, 0.0]; n]).unwrap();
        let runs = on_card.runs(card, &b, &x).unwrap();
        card.submit(&runs);
        let first: Vec<Vec<Four>> = card.read(&[(&x, n)]).unwrap();
        // Nothing of the first time may be left in the second.
        card.submit(&runs);
        let found: Vec<Vec<Four>> = card.read(&[(&x, n)]).unwrap();
        assert!(first == found, "the second time is not the first");
        let (_, _, expected) = cycle.parts();
        let size = expected.iter().flatten().fold(0.0_f64, |most, value| most.max(value.abs()));
        let found = found[0].iter().zip(on_card.scales()).map(|(x, [unit, _])| x.map(|x| x * unit));
        let error = |(expected, found): (&Lanes, Four)| {
            (0..3).map(|k| (expected[k] - f64::from(found[k])).abs()).fold(0.0, f64::max)
        };
        let greatest = expected.iter().zip(found).map(error).fold(0.0, f64::max);
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
        let inverse = inverse_factor(&matrix, &[1.0; 105]).unwrap();
        // W A Wᵀ is the identity.
        let product = inverse.times(&matrix).times(&inverse.transposed());
        for i in 0..105 {
            for (j, value) in product.row(i) {
                assert!((value - f64::from(u8::from(i == j))).abs() < 1e-9, "entry {i}, {j} is {value}");
            }
        }
        let indefinite = SparseRows::from_rows(2, [vec![(0, 1.0), (1, 2.0)], vec![(0, 2.0), (1, 1.0)]].into_iter());
        assert!(inverse_factor(&indefinite, &[1.0; 2]).is_none());
    }
}
