//! Quadratic functions under linear side conditions, for unknowns that only their neighbours in some order depend on.
//!
//! The minimum of `½ xᵀHx − gᵀx` under `C x = c` is where, with a multiplier `λ` for each condition,
//!
//! ```text
//! | H  Cᵀ | | x |   | g |
//! | C  0  | | λ | = | c |
//! ```
//!
//! `H` is scaled to the mean 1 of its diagonal and each condition to a row of length 1. Unknowns that nothing determines make the
//! matrix singular, and so do conditions that follow from others; both are cured alike. We factorise it with `ε` added to the
//! diagonal of `H` and `−δ` in place of the zero block, and correct the solution by what it leaves of the right-hand sides of the
//! matrix without them: for consistent conditions this converges to the shortest of all solutions up to round-off (proximal
//! points; Rockafellar 1976). Conditions that contradict each other are then met as well as possible: they count as squares of a
//! large weight, and [`Found::residual`] says what is left.

use super::banded::BandedLu;
use crate::error::{Error, Result, Status};

/// The first `ε`, and the greatest: unknowns that depend on each other more than it cures are not determined.
const REGULARISATION: [f64; 2] = [1e-10, 1e-6];

/// `δ`.
const RELAXATION: f64 = 1e-12;

/// `δ` where conditions contradict each other: their weight is `1 / δ`, above which round-off takes over.
const CONTRADICTING_RELAXATION: f64 = 1e-8;

/// Corrections at most.
const MOST_CORRECTIONS: usize = 6;

/// What a solution may leave of the gradient, relative to its parts.
const STATIONARY: f64 = 1e-8;

/// Conditions are met where they leave this of the size of the solution.
const MET: f64 = 1e-10;

/// A quadratic function and its side conditions.
#[derive(Clone, Debug, Default)]
pub struct SaddlePoint {
    unknown_count: usize,
    /// Entries of `H`, both of each symmetric pair.
    second: Vec<(u32, u32, f64)>,
    first: Vec<f64>,
    conditions: Vec<Vec<(u32, f64)>>,
    rights: Vec<f64>,
}

/// Where the function is least.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The unknowns.
    pub x: Vec<f64>,
    /// The multipliers `λ` of the conditions as they were given.
    pub multipliers: Vec<f64>,
    /// By how much a condition is off at most; a condition counts with coefficients of length 1.
    pub residual: f64,
    /// The `ε` that it took.
    pub regularisation: f64,
}

impl SaddlePoint {
    /// The function 0 of so many unknowns, without conditions.
    pub fn new(unknown_count: usize) -> Self {
        Self { unknown_count, first: vec![0.0; unknown_count], ..Self::default() }
    }

    /// Adds `½ weight (Σ coefficient · unknown − right)²`.
    pub fn add_square(&mut self, entries: &[(u32, f64)], right: f64, weight: f64) {
        for &(i, a) in entries {
            self.second.extend(entries.iter().map(|&(j, b)| (i, j, weight * a * b)));
            self.first[i as usize] += weight * a * right;
        }
    }

    /// Adds `½ value x_i x_j`, and as much for `x_j x_i` if `i` is not `j`.
    pub fn add_second(&mut self, i: u32, j: u32, value: f64) {
        self.second.push((i, j, value));
        if i != j {
            self.second.push((j, i, value));
        }
    }

    /// Adds `−value x_i`.
    pub fn add_first(&mut self, i: u32, value: f64) {
        self.first[i as usize] += value;
    }

    /// Adds the condition `Σ coefficient · unknown = right`.
    pub fn condition(&mut self, entries: &[(u32, f64)], right: f64) {
        self.conditions.push(entries.to_vec());
        self.rights.push(right);
    }

    /// Finds the minimum. `positions[i]` says where in the order unknown `i` is.
    ///
    /// # Errors
    /// Status `InvalidValue`: numbers that are not finite. Status `Singular`: the function has no minimum, or one that round-off
    /// does not determine.
    pub fn solve(&self, positions: &[u32]) -> Result<Found> {
        let scaled = Scaled::new(self, positions)?;
        let mut regularisation = REGULARISATION[0];
        loop {
            if let Some(found) = scaled.solve(regularisation) {
                return Ok(found);
            }
            regularisation *= 100.0;
            if regularisation > 1.01 * REGULARISATION[1] {
                let reason = "the unknowns are not determined: more terms or conditions are needed";
                return Err(Error::new(Status::Singular, reason));
            }
        }
    }

    /// Finds the minimum of the function with `Σ (Σ coefficient · unknown − right)² / 2 relaxation` of all conditions added in
    /// their place. `relaxation` is above 0.
    ///
    /// # Errors
    /// As [`SaddlePoint::solve`].
    pub fn solve_relaxed(&self, positions: &[u32], relaxation: f64) -> Result<Found> {
        let scaled = Scaled { is_relaxed: true, ..Scaled::new(self, positions)? };
        scaled.solve_with(0.0, relaxation / scaled.unit, false).ok_or_else(|| {
            Error::new(Status::Singular, "the unknowns are not determined: more terms or conditions are needed")
        })
    }
}

/// The system scaled and in order.
struct Scaled<'a> {
    of: &'a SaddlePoint,
    /// What the function is divided by.
    unit: f64,
    /// What each condition is multiplied by.
    scales: Vec<f64>,
    /// Where unknowns and multipliers are in order.
    places: Vec<u32>,
    entries: Vec<(u32, u32, f64)>,
    right: Vec<f64>,
    is_relaxed: bool,
}

impl<'a> Scaled<'a> {
    fn new(of: &'a SaddlePoint, positions: &[u32]) -> Result<Self> {
        let n = of.unknown_count;
        let coefficients = of.conditions.iter().flatten().map(|entry| entry.1);
        let all = of.second.iter().map(|entry| entry.2).chain(coefficients);
        if !all.chain(of.first.iter().copied()).chain(of.rights.iter().copied()).all(f64::is_finite) {
            return Err(Error::new(Status::InvalidValue, "expected finite coefficients"));
        }
        let trace: f64 = of.second.iter().filter(|(i, j, _)| i == j).map(|entry| entry.2).sum();
        let mean = trace / n.max(1) as f64;
        let unit = if mean > f64::MIN_POSITIVE { mean } else { 1.0 };
        let norm = |entries: &Vec<(u32, f64)>| entries.iter().map(|(_, a)| a * a).sum::<f64>().sqrt();
        let scales: Vec<f64> = of.conditions.iter().map(norm).map(|n| if n > 0.0 { 1.0 / n } else { 1.0 }).collect();
        // A multiplier comes after the last unknown of its condition.
        let key = |k: usize| of.conditions[k].iter().map(|&(i, _)| positions[i as usize]).max().unwrap_or(0);
        let mut order: Vec<(u32, usize)> = (0..n).map(|i| (positions[i], i)).collect();
        order.extend((0..of.conditions.len()).map(|k| (key(k), n + k)));
        order.sort_unstable();
        let mut places = vec![0; order.len()];
        (0..).zip(&order).for_each(|(place, &(_, which))| places[which] = place);
        let at = |i: usize| places[i];
        let mut entries: Vec<(u32, u32, f64)> =
            of.second.iter().map(|&(i, j, value)| (at(i as usize), at(j as usize), value / unit)).collect();
        for (k, condition) in of.conditions.iter().enumerate() {
            for &(i, a) in condition {
                let (row, column) = (at(n + k), at(i as usize));
                entries.extend([(row, column, scales[k] * a), (column, row, scales[k] * a)]);
            }
        }
        let mut right = vec![0.0; places.len()];
        of.first.iter().enumerate().for_each(|(i, g)| right[at(i) as usize] = g / unit);
        of.rights.iter().enumerate().for_each(|(k, c)| right[at(n + k) as usize] = scales[k] * c);
        Ok(Self { of, unit, scales, places, entries, right, is_relaxed: false })
    }

    fn solve(&self, regularisation: f64) -> Option<Found> {
        let found = self.solve_with(regularisation, RELAXATION, true)?;
        let size = largest(&found.x).max(self.largest_right());
        if found.residual <= MET * size || size == 0.0 {
            return Some(found);
        }
        self.solve_with(regularisation, CONTRADICTING_RELAXATION, false)
    }

    fn largest_right(&self) -> f64 {
        self.of.rights.iter().zip(&self.scales).fold(0.0, |most, (c, scale)| most.max((c * scale).abs()))
    }

    /// Solves with this `ε` and `δ`, and corrects for both, or for `ε` only.
    fn solve_with(&self, regularisation: f64, relaxation: f64, is_exact: bool) -> Option<Found> {
        let n = self.of.unknown_count;
        let mut entries = self.entries.clone();
        // A condition was scaled by s, so that a relaxation of the one given is s² times as large.
        let relaxed = |k: usize| if self.is_relaxed { relaxation * self.scales[k].powi(2) } else { relaxation };
        let kept = if is_exact { 0 } else { self.of.conditions.len() };
        entries.extend((0..kept).map(|k| (self.places[n + k], self.places[n + k], -relaxed(k))));
        let system = entries.len();
        entries.extend((0..n).map(|i| (self.places[i], self.places[i], regularisation)));
        entries.extend((kept..self.of.conditions.len()).map(|k| (self.places[n + k], self.places[n + k], -relaxed(k))));
        let factors = BandedLu::new(self.places.len(), &entries)?;
        entries.truncate(system);
        let mut solution = vec![0.0; self.places.len()];
        let mut left = self.right.clone();
        for _ in 0..=MOST_CORRECTIONS {
            let mut correction = left.clone();
            factors.solve(&mut correction);
            let next: Vec<f64> = solution.iter().zip(&correction).map(|(x, d)| x + d).collect();
            let remaining = remainder(&entries, &self.right, &next);
            if !(largest(&remaining) < largest(&left)) {
                break;
            }
            let has_converged = largest(&remaining) > 0.5 * largest(&left);
            (solution, left) = (next, remaining);
            if has_converged {
                break;
            }
        }
        let of = |i: usize, from: &[f64]| from[self.places[i] as usize];
        let x: Vec<f64> = (0..n).map(|i| of(i, &solution)).collect();
        let multipliers: Vec<f64> =
            (0..self.scales.len()).map(|k| self.unit * self.scales[k] * of(n + k, &solution)).collect();
        let gradient = (0..n).map(|i| of(i, &left).abs()).fold(0.0, f64::max);
        let scale = largest(&self.right).max(largest(&x));
        let is_finite = x.iter().chain(&multipliers).all(|value| value.is_finite());
        // Contradicting conditions have multipliers without bounds, whose round-off is in the gradient: that is looked at later.
        let is_met = self.residual(&x) <= MET * scale;
        let is_stationary = gradient <= STATIONARY * scale || (is_exact && !is_met);
        (is_finite && is_stationary).then(|| Found { residual: self.residual(&x), x, multipliers, regularisation })
    }

    fn residual(&self, x: &[f64]) -> f64 {
        let off = |k: usize| {
            let left: f64 = self.of.conditions[k].iter().map(|&(i, a)| a * x[i as usize]).sum();
            (self.scales[k] * (left - self.of.rights[k])).abs()
        };
        (0..self.scales.len()).map(off).fold(0.0, f64::max)
    }
}

fn remainder(entries: &[(u32, u32, f64)], right: &[f64], x: &[f64]) -> Vec<f64> {
    let mut left = right.to_vec();
    entries.iter().for_each(|&(i, j, value)| left[i as usize] -= value * x[j as usize]);
    left
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dense::{ROUND_OFF, Svd};

    /// Rows of three neighbouring unknowns each, with coefficients that follow no rule.
    fn row(k: usize, start: usize) -> Vec<(u32, f64)> {
        (start..start + 3).map(|i| (i as u32, ((5 * k + 11 * i + k * i) as f64 + 0.3).sin())).collect()
    }

    fn order(n: usize) -> Vec<u32> {
        (0..n as u32).collect()
    }

    /// The oracle: a particular solution of the conditions, and least squares in their null space.
    fn dense(n: usize, squares: &[(Vec<(u32, f64)>, f64)], conditions: &[(Vec<(u32, f64)>, f64)]) -> Vec<f64> {
        let columns = |rows: &[(Vec<(u32, f64)>, f64)]| {
            let mut columns = vec![vec![0.0; rows.len()]; n];
            rows.iter().enumerate().for_each(|(k, (r, _))| r.iter().for_each(|&(i, a)| columns[i as usize][k] += a));
            columns
        };
        let rights = |rows: &[(Vec<(u32, f64)>, f64)]| rows.iter().map(|(_, right)| *right).collect::<Vec<f64>>();
        let conditioned = Svd::new(conditions.len(), &columns(conditions)).unwrap();
        let particular = conditioned.least_norm(&rights(conditions), ROUND_OFF);
        let basis = conditioned.null_space(ROUND_OFF);
        let apply = |x: &[f64], row: &[(u32, f64)]| row.iter().map(|&(i, a)| a * x[i as usize]).sum::<f64>();
        let reduced: Vec<Vec<f64>> =
            basis.iter().map(|vector| squares.iter().map(|(r, _)| apply(vector, r)).collect()).collect();
        let right: Vec<f64> = squares.iter().map(|(r, b)| b - apply(&particular, r)).collect();
        let y = Svd::new(squares.len(), &reduced).unwrap().least_norm(&right, ROUND_OFF);
        let mut x = particular;
        basis.iter().zip(&y).for_each(|(vector, y)| x.iter_mut().zip(vector).for_each(|(x, v)| *x += y * v));
        x
    }

    fn case(n: usize, square_count: usize, condition_count: usize, repeats: bool) {
        let squares: Vec<_> = (0..square_count).map(|k| (row(k, k % (n - 2)), (k as f64).cos())).collect();
        let mut conditions: Vec<_> =
            (0..condition_count).map(|k| (row(k + 100, 2 * k), (k as f64 + 0.1).sin())).collect();
        if repeats {
            let (again, right) = conditions[1].clone();
            conditions.push((again.iter().map(|&(i, a)| (i, 3.0 * a)).collect(), 3.0 * right));
        }
        let mut saddle = SaddlePoint::new(n);
        squares.iter().for_each(|(r, right)| saddle.add_square(r, *right, 1.0));
        conditions.iter().for_each(|(r, right)| saddle.condition(r, *right));
        let found = saddle.solve(&order(n)).unwrap();
        assert!(found.residual < 1e-12, "{}", found.residual);
        let expected = dense(n, &squares, &conditions);
        let apart = found.x.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9 * (1.0 + largest(&expected)), "{n} {square_count} {condition_count}: {apart}");
        // The gradient is a combination of the conditions' rows, with the multipliers that were found.
        for i in 0..n as u32 {
            let apply = |row: &[(u32, f64)]| row.iter().map(|&(j, a)| a * found.x[j as usize]).sum::<f64>();
            let of = |row: &[(u32, f64)]| row.iter().filter(|entry| entry.0 == i).map(|entry| entry.1).sum::<f64>();
            let gradient: f64 = squares.iter().map(|(r, right)| of(r) * (apply(r) - right)).sum();
            let pull: f64 = conditions.iter().zip(&found.multipliers).map(|((r, _), l)| l * of(r)).sum();
            assert!((gradient + pull).abs() < 1e-9 * (1.0 + largest(&found.multipliers)), "{gradient} {pull}");
        }
    }

    #[test]
    fn solutions_are_those_of_the_dense_null_space() {
        case(12, 20, 4, false);
        case(30, 40, 9, false);
        case(30, 40, 9, true);
    }

    #[test]
    fn what_nothing_determines_stays_small() {
        // x_0 + x_1 = 2 and nothing else: the shortest solution.
        let mut saddle = SaddlePoint::new(3);
        saddle.condition(&[(0, 1.0), (1, 1.0)], 2.0);
        let found = saddle.solve(&order(3)).unwrap();
        assert!((found.x[0] - 1.0).abs() < 1e-9 && (found.x[1] - 1.0).abs() < 1e-9 && found.x[2].abs() < 1e-9);
        // One square of two unknowns leaves their difference open.
        let mut saddle = SaddlePoint::new(2);
        saddle.add_square(&[(0, 1.0), (1, 1.0)], 2.0, 5.0);
        let found = saddle.solve(&order(2)).unwrap();
        assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-6), "{found:?}");
    }

    #[test]
    fn contradictions_are_shared_out() {
        // x_0 is to be 0 and 1: both conditions are off by a half; the other unknown is free to follow its square.
        let mut saddle = SaddlePoint::new(2);
        saddle.condition(&[(0, 1.0)], 0.0);
        saddle.condition(&[(0, 1.0)], 1.0);
        saddle.add_square(&[(1, 1.0)], 3.0, 1.0);
        let found = saddle.solve(&order(2)).unwrap();
        assert!((found.residual - 0.5).abs() < 1e-6 && (found.x[0] - 0.5).abs() < 1e-6, "{found:?}");
        assert!((found.x[1] - 3.0).abs() < 1e-6);
        let relaxed = saddle.solve_relaxed(&order(2), 1.0).unwrap();
        assert!((relaxed.x[0] - 0.5).abs() < 1e-12 && (relaxed.x[1] - 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        let mut saddle = SaddlePoint::new(1);
        saddle.add_square(&[(0, f64::NAN)], 0.0, 1.0);
        assert_eq!(saddle.solve(&order(1)).unwrap_err().status(), Status::InvalidValue);
    }
}
