//! Caps of multipliers, and which constraints contradict each other.
//!
//! Every hard constraint is elastic: violating it by a length `d` costs `ρ d`, so its multiplier never exceeds `ρ`.
//! Where the cap is above the multiplier of the solution, the elastic solution is the hard one. A multiplier that stays
//! at its cap while its constraint is violated gets a cap ten times as high, three times; after that the constraint
//! takes part in a contradiction.
//!
//! As the cost is of the length and not of its square, few constraints are violated and the others are met. Caps that
//! fall where the violation is large make them fewer still (reweighting); then every one of them is made hard again in
//! turn, the least violated first, and stays hard if the others can still be met without the rest (a deletion filter,
//! Chinneck 2008, "Feasibility and infeasibility in optimization", chapter 2). Sets are not convex: what is found is
//! *a* small set, around the points in hand.

use glam::DVec3;

use super::splitting::Splitting;
use super::{Engine, distances};
use crate::constraints::{ConstraintId, ConstraintSet};

/// The first cap over the larger of the objective's gradient at `p⁰` and the force that moves a point of mean stiffness
/// by the mean extent of a constraint, for a priority of 1.
const CAP: f64 = 10.0;

/// By how much a cap is raised, and how often.
const RAISE: f64 = 10.0;
pub(super) const RAISES: u32 = 3;

/// Sweeps in which a multiplier at its cap must have left it.
pub(super) const PATIENCE: u32 = 25;

/// A constraint counts as violated from this part of the mean extent on.
const VIOLATED: f64 = 1e-4;

/// Rounds of reweighting, sweeps in each, and the violation, over the mean extent, at which a cap is halved.
const ROUNDS: u32 = 5;
const ROUND_SWEEPS: u32 = 40;
const HALVED_AT: f64 = 1e-2;

/// Sweeps in which the constraints must be met again once one was made hard.
const TRIAL_SWEEPS: u32 = 120;

/// The cap of every hard constraint's multiplier. `force` moves a point of mean stiffness by the mean extent of a
/// constraint.
pub(super) fn caps(splitting: &Splitting, constraints: &ConstraintSet, force: f64) -> Vec<f64> {
    let mut gradient = vec![DVec3::ZERO; splitting.points.len()];
    splitting.quadratic.gradient(splitting.quadratic.initial(), &mut gradient);
    let largest = gradient.iter().map(|g| g.length()).fold(force, f64::max);
    let priority = |id| constraints.get(id).map_or(1.0, |view| view.weight);
    splitting.hard.items.iter().map(|item| CAP * largest * priority(item.id)).collect()
}

impl Engine {
    /// Raises the caps of the multipliers that are at theirs. False if they were raised often enough.
    pub(super) fn raise_caps(&mut self) -> bool {
        if self.raises >= RAISES {
            return false;
        }
        self.raises += 1;
        let distances = distances(&mut self.splitting.hard, &self.splitting.points);
        let bound = self.tolerance * self.size;
        for (cap, distance) in self.splitting.caps.iter_mut().zip(distances) {
            if distance > bound {
                *cap *= RAISE;
            }
        }
        self.splitting.forget();
        true
    }

    /// A small set of hard constraints without which the others can be met; the points are then those that meet them.
    pub(super) fn find_conflicts(&mut self) -> Vec<ConstraintId> {
        let base = self.splitting.caps.clone();
        let violated = VIOLATED * self.extent;
        // Fewer, by caps that fall where the violation is large.
        for _ in 0..ROUNDS {
            let distances = distances(&mut self.splitting.hard, &self.splitting.points);
            for ((cap, base), distance) in self.splitting.caps.iter_mut().zip(&base).zip(distances) {
                *cap = base / (1.0 + distance / (HALVED_AT * self.extent));
            }
            self.splitting.forget();
            self.sweeps(ROUND_SWEEPS);
        }
        let found = distances(&mut self.splitting.hard, &self.splitting.points);
        let mut given_up: Vec<usize> = (0..found.len()).filter(|&i| found[i] > violated).collect();
        given_up.sort_by(|&a, &b| found[a].total_cmp(&found[b]));
        // The others must be met without them.
        self.splitting.caps.copy_from_slice(&base);
        loop {
            given_up.iter().for_each(|&i| self.splitting.caps[i] = 0.0);
            let missed = self.missed(&given_up);
            if missed.is_empty() {
                break;
            }
            given_up.extend(missed);
            if given_up.len() >= found.len() {
                break;
            }
        }
        // Each in turn, the least violated first.
        for i in given_up.clone() {
            let kept = (self.splitting.points.clone(), self.splitting.rows.clone());
            self.splitting.caps[i] = base[i];
            let rest: Vec<usize> = given_up.iter().copied().filter(|&other| other != i).collect();
            if self.missed(&rest).is_empty() {
                given_up = rest;
            } else {
                self.splitting.caps[i] = 0.0;
                (self.splitting.points, self.splitting.rows) = kept;
                self.splitting.forget();
            }
        }
        let mut ids: Vec<ConstraintId> = given_up.iter().map(|&i| self.splitting.hard.items[i].id).collect();
        ids.sort_unstable();
        ids
    }

    /// The constraints, apart from those given up, that some sweeps do not meet.
    fn missed(&mut self, given_up: &[usize]) -> Vec<usize> {
        let bound = VIOLATED * self.extent;
        let mut missed = Vec::new();
        for _ in 0..TRIAL_SWEEPS / ROUND_SWEEPS {
            self.splitting.forget();
            self.sweeps(ROUND_SWEEPS);
            let distances = distances(&mut self.splitting.hard, &self.splitting.points);
            missed = (0..distances.len()).filter(|i| distances[*i] > bound && !given_up.contains(i)).collect();
            if missed.is_empty() {
                break;
            }
        }
        missed
    }

    fn sweeps(&mut self, count: u32) {
        for _ in 0..count {
            self.sweep();
        }
    }
}
