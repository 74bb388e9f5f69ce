//! L-BFGS with the prefactored system matrix as initial Hessian, and its line search.
//!
//! In the metric `N` the energy's gradient is `g = −f`, minus the plain step, and its change over the move `s_i` is
//! `y_i = −d_i`. So the initial Hessian `N` becomes the identity, no linear solve is needed beyond the one that gave `f`,
//! and the two loops of L-BFGS run over inner products alone. Only products of a move with a change of the same age or
//! newer occur. The initial inverse Hessian is scaled by `γ = ⟨s, y⟩ / ⟨y, y⟩` of the newest pair: `N` bounds the energy's
//! curvature from above, so plain steps are too short, and `γ` (1 or more there) says by how much. Sources: Nocedal and
//! Wright 2006, algorithm 7.4 and equation 7.20; Liu, Bouaziz and Kavan 2017, "Quasi-Newton methods for real-time
//! simulation of hyperelastic materials", who take `N` unscaled: 44 evaluations instead of 34 on the planar quads of
//! docs/acceleration.md.

use super::history::{Combination, Products};

/// A pair whose curvature `⟨s, y⟩` is at most this part of `⟨y, y⟩` is forgotten: the energy bends down along it, or so
/// little that the direction would be made of round-off. Where projections are onto convex sets the ratio is at least 1.
const LEAST_CURVATURE: f64 = 1e-10;

/// A step must lower the energy by this part of what the slope at its beginning promises. As Nocedal and Wright advise:
/// next to nothing, so that good steps are never refused.
const LEAST_DECREASE: f64 = 1e-4;

/// Step lengths tried in one direction. The first is right nearly always; after three the direction is not worth more.
const MOST_TRIALS: u32 = 3;

/// Bounds on each step length relative to the one before, within which the parabola through what is known decides.
const SHORTER: [f64; 2] = [0.1, 0.5];

/// An expected change of the energy below this part of it drowns in the round-off of the energy's sum, so trying other
/// step lengths would tell nothing.
const ENERGY_NOISE: f64 = 1e-14;

/// The memory of the two loops.
#[derive(Debug, Default)]
pub(super) struct QuasiNewton {
    alpha: Vec<f64>,
    beta: Vec<f64>,
}

impl QuasiNewton {
    /// Room for `capacity` pairs.
    pub(super) fn reset(&mut self, capacity: usize) {
        for coefficients in [&mut self.alpha, &mut self.beta] {
            coefficients.resize(capacity, 0.0);
        }
    }

    /// True if the newest pair has the curvature of a minimum along it.
    pub(super) fn is_newest_curved(products: &Products) -> bool {
        -products.move_change(0, 0) > LEAST_CURVATURE * products.change_change(0, 0)
    }

    /// Writes the direction to try. There is at least one pair, and all of them are curved.
    pub(super) fn combine(&mut self, products: &Products, combination: &mut Combination) {
        let m = products.len();
        let (alpha, beta) = (&mut self.alpha, &mut self.beta);
        let sy = |i: usize, j: usize| -products.move_change(i, j);
        let yy = |i: usize, j: usize| products.change_change(i, j);
        // ⟨s_i, g⟩ and ⟨y_i, g⟩.
        let (sg, yg) = (|i: usize| -products.move_plain(i), |i: usize| products.change_plain(i));
        for i in 0..m {
            let newer: f64 = (0..i).map(|j| alpha[j] * sy(i, j)).sum();
            alpha[i] = (sg(i) - newer) / sy(i, i);
        }
        let gamma = sy(0, 0) / yy(0, 0);
        for i in (0..m).rev() {
            let first_loop = yg(i) - (0..m).map(|j| alpha[j] * yy(i, j)).sum::<f64>();
            let older: f64 = (i + 1..m).map(|j| (alpha[j] - beta[j]) * sy(j, i)).sum();
            beta[i] = (gamma * first_loop + older) / sy(i, i);
        }
        // −γ (g − Σ α y) − Σ (α − β) s.
        combination.reset(m);
        combination.plain = gamma;
        for i in 0..m {
            (combination.moves[i], combination.changes[i]) = (beta[i] - alpha[i], -gamma * alpha[i]);
        }
    }
}

/// Backtracking along one direction of descent.
#[derive(Debug)]
pub(super) struct LineSearch {
    energy: f64,
    slope: f64,
    least_decrease: f64,
    length: f64,
    trials_left: u32,
}

impl LineSearch {
    /// From a point of `energy` along a direction with the derivative `slope`, below 0.
    pub(super) fn new(energy: f64, slope: f64) -> Self {
        let trials_left = if -slope > ENERGY_NOISE * energy.abs() { MOST_TRIALS } else { 1 };
        Self { energy, slope, least_decrease: LEAST_DECREASE, length: 1.0, trials_left }
    }

    /// The full length only, which must not raise the energy.
    pub(super) fn one_length(energy: f64, slope: f64) -> Self {
        Self { trials_left: 1, least_decrease: 0.0, ..Self::new(energy, slope) }
    }

    /// The length to try; `None` when it is time to give up.
    pub(super) fn next(&mut self) -> Option<f64> {
        self.trials_left = self.trials_left.checked_sub(1)?;
        Some(self.length)
    }

    /// True if `found`, the energy at the last length, is low enough. If not, decides on a shorter length.
    pub(super) fn accepts(&mut self, found: f64) -> bool {
        let LineSearch { energy, slope, least_decrease, length, .. } = *self;
        if found <= energy + least_decrease * length * slope && found <= energy {
            return true;
        }
        // The lowest point of the parabola with this value and slope at 0 and `found` at `length`.
        let lowest = -slope * length * length / (2.0 * (found - energy - slope * length));
        let [least, most] = SHORTER;
        self.length = if lowest.is_finite() { lowest.clamp(least * length, most * length) } else { least * length };
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_search_on_a_parabola_finds_its_lowest_point() {
        // E(t) = 3 − 2 t + 4 t²: the full length raises the energy, and the next one is exact, t = 1/4.
        let energy = |t: f64| 3.0 - 2.0 * t + 4.0 * t * t;
        let mut search = LineSearch::new(3.0, -2.0);
        let first = search.next().unwrap();
        assert!(first == 1.0 && !search.accepts(energy(first)));
        let second = search.next().unwrap();
        assert!((second - 0.25).abs() < 1e-15 && search.accepts(energy(second)));
    }

    #[test]
    fn a_line_search_gives_up_on_an_energy_that_only_rises() {
        for found in [4.0, f64::INFINITY, f64::NAN] {
            let mut search = LineSearch::new(3.0, -2.0);
            let mut lengths = Vec::new();
            while let Some(length) = search.next() {
                lengths.push(length);
                assert!(!search.accepts(found));
            }
            assert_eq!(lengths.len(), MOST_TRIALS as usize);
            assert!(lengths.windows(2).all(|pair| 0.0 < pair[1] && pair[1] <= 0.5 * pair[0]), "{lengths:?}");
        }
    }

    #[test]
    fn where_the_energy_cannot_tell_one_length_is_tried() {
        let mut search = LineSearch::new(3.0, -1e-15);
        assert!(search.next().is_some() && !search.accepts(3.0 + 1e-15));
        assert!(search.next().is_none());
    }
}
