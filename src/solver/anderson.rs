//! Anderson acceleration: the point where the plain steps of the last iterates, combined, would leave least to do.
//!
//! With the history's moves `s_i` and changes `d_i`, `G(x) − x = f` at the last iterate `x`:
//!
//! ```text
//! θ = argmin ‖f − Σ θ_i d_i‖²_N        p = f − Σ θ_i (s_i + d_i)
//! ```
//!
//! and `x + p` is tried. Measured in `N`, the residual is the energy's gradient in the norm that the global step is the
//! steepest descent of; in the plain norm the squares of docs/acceleration.md needed 115 evaluations instead of 74.
//! Sources: Walker and Ni 2011, "Anderson acceleration for fixed-point iterations"; Peng et al. 2018, "Anderson
//! acceleration for geometry optimization and physics simulation", which measures in the plain norm.

use super::history::{Combination, Products};

/// A change whose part that newer changes do not span is below the root of this, relative to its length, is left out:
/// its coefficient would be made of round-off. Products of vectors are good to some 1e-15 of their size.
const LEAST_PIVOT: f64 = 1e-12;

/// The memory of the small least-squares problem.
#[derive(Debug, Default)]
pub(super) struct Anderson {
    /// The factor `L` of the normal matrix with unit diagonal, by rows; a row of zeros where the change is left out.
    factor: Vec<f64>,
    theta: Vec<f64>,
}

impl Anderson {
    /// Room for `capacity` pairs.
    pub(super) fn reset(&mut self, capacity: usize) {
        self.factor.resize(capacity * capacity, 0.0);
        self.theta.resize(capacity, 0.0);
    }

    /// Writes the direction to try. Returns the number of pairs that were left out as the others span them.
    pub(super) fn combine(&mut self, products: &Products, combination: &mut Combination) -> usize {
        let m = products.len();
        let (l, theta) = (&mut self.factor, &mut self.theta);
        // A change of length 0, as exact fixed points have, spans nothing: it is left out.
        let scale = |i: usize| match products.change_change(i, i) {
            squared if squared > 0.0 => 1.0 / squared.sqrt(),
            _ => 0.0,
        };
        let mut left_out = 0;
        // The newest pair comes first, so that it is the older of two dependent ones that is left out.
        for i in 0..m {
            for j in 0..i {
                let known: f64 = (0..j).map(|k| l[i * m + k] * l[j * m + k]).sum();
                let pivot = l[j * m + j];
                let rest = products.change_change(i, j) * scale(i) * scale(j) - known;
                l[i * m + j] = if pivot > 0.0 { rest / pivot } else { 0.0 };
            }
            let pivot = 1.0 - (0..i).map(|k| l[i * m + k] * l[i * m + k]).sum::<f64>();
            if scale(i) > 0.0 && pivot > LEAST_PIVOT {
                l[i * m + i] = pivot.sqrt();
            } else {
                l[i * m..=i * m + i].fill(0.0);
                left_out += 1;
            }
        }
        let is_used = |l: &[f64], i: usize| l[i * m + i] > 0.0;
        for i in 0..m {
            let known: f64 = (0..i).map(|k| l[i * m + k] * theta[k]).sum();
            theta[i] = if is_used(l, i) { (products.change_plain(i) * scale(i) - known) / l[i * m + i] } else { 0.0 };
        }
        for i in (0..m).rev().filter(|&i| is_used(l, i)) {
            let known: f64 = (i + 1..m).map(|k| l[k * m + i] * theta[k]).sum();
            theta[i] = (theta[i] - known) / l[i * m + i];
        }
        combination.reset(m);
        for i in (0..m).filter(|&i| is_used(l, i)) {
            let coefficient = -theta[i] * scale(i);
            (combination.moves[i], combination.changes[i]) = (coefficient, coefficient);
        }
        left_out
    }
}
