//! Caps of multipliers, and when it is time to search for contradictions.
//!
//! Every hard constraint is elastic: violating it by a length `d` costs `ρ d`, so its multiplier never exceeds `ρ`.
//! Where the cap is above the multiplier of the solution, the elastic solution is the hard one. Caps grow with the
//! priorities and are raised together, so that their ratios, which decide who gives way, do not depend on how often
//! they were raised.
//!
//! Sweeps of a contradiction go on for ever: multipliers grow to their caps, or sets that are not convex throw the rows
//! to and fro. What tells them is that the largest violation of the points does not fall. Where multipliers are at
//! their caps, these are raised then, in case they were too low; after some looks in vain the search
//! ([`super::search`]) decides.

use glam::DVec3;

use super::distances;
use super::engine::Engine;
use super::splitting::Splitting;
use crate::constraints::ConstraintSet;
use crate::error::Result;

/// The first cap over the larger of the objective's gradient at `p⁰` and the force that moves a point of mean stiffness
/// by the mean extent of a constraint, for the lowest priority.
const CAP: f64 = 10.0;

/// By how much caps are raised, and how often.
const RAISE: f64 = 5.0;
const RAISES: u32 = 2;

/// The penalty's growth with each raise. A set that is not convex can throw a constraint's points as far as cap over
/// penalty: that must not grow out of the model.
const STIFFER: f64 = 3.0;

/// Priorities over the lowest one are taken from this range, for the same reason. The search compares the priorities
/// themselves.
const PRIORITIES: [f64; 2] = [0.25, 4.0];

/// Sweeps between looks at the largest violation.
pub(super) const PATIENCE: u32 = 25;

/// A look is in vain if the largest violation is above this part of what it was when it last fell.
const FALLEN: f64 = 0.9;

/// Looks in vain, one behind the other, after which the search begins; where caps cannot be raised any more, the first
/// search begins at once.
const LOOKS: u32 = 4;

/// A constraint counts as violated from this part of the mean extent on.
pub(super) const VIOLATED: f64 = 1e-4;

/// What every hard constraint weighs where not all can be met.
pub(super) struct Priorities {
    /// As the user gave them.
    pub(super) weights: Vec<f64>,
    /// Over the lowest one, within [`PRIORITIES`].
    pub(super) relative: Vec<f64>,
    /// The first cap of a relative priority of 1.
    pub(super) first_cap: f64,
}

impl Priorities {
    /// `force` moves a point of mean stiffness by the mean extent of a constraint.
    pub(super) fn new(splitting: &Splitting, constraints: &ConstraintSet, force: f64) -> Self {
        let mut gradient = vec![DVec3::ZERO; splitting.points.len()];
        splitting.quadratic.gradient(splitting.quadratic.initial(), &mut gradient);
        let largest = gradient.iter().map(|g| g.length()).fold(force, f64::max);
        let weight = |id| constraints.get(id).map_or(1.0, |view| view.weight);
        let weights: Vec<f64> = splitting.hard.items.iter().map(|item| weight(item.id)).collect();
        let lowest = weights.iter().copied().filter(|weight| *weight > 0.0).fold(f64::INFINITY, f64::min);
        let [least, most] = PRIORITIES;
        let relative = weights.iter().map(|weight| (weight / lowest).clamp(least, most)).collect();
        Self { weights, relative, first_cap: CAP * largest }
    }

    /// The caps after so many raises.
    pub(super) fn caps(&self, raises: u32) -> Vec<f64> {
        let cap = self.first_cap * RAISE.powi(raises as i32);
        self.relative.iter().map(|priority| cap * priority).collect()
    }
}

/// Follows a largest violation from look to look.
pub(super) struct Watch {
    sweeps: u32,
    least: f64,
    /// Looks in vain since it last fell.
    pub(super) vain: u32,
}

impl Default for Watch {
    fn default() -> Self {
        Self { sweeps: 0, least: f64::INFINITY, vain: 0 }
    }
}

impl Watch {
    /// To be called after every sweep; true every `period` sweeps.
    pub(super) fn is_due(&mut self, period: u32) -> bool {
        self.sweeps += 1;
        self.sweeps.is_multiple_of(period)
    }

    /// To be called with the largest violation at every look.
    pub(super) fn see(&mut self, largest: f64) {
        if largest < FALLEN * self.least {
            (self.least, self.vain) = (largest, 0);
        } else {
            self.vain += 1;
        }
    }
}

/// How a contradiction comes to be suspected.
pub(super) struct Suspicion {
    watch: Watch,
    looks: u32,
}

impl Default for Suspicion {
    fn default() -> Self {
        Self { watch: Watch::default(), looks: LOOKS }
    }
}

impl Suspicion {
    /// Begins anew after a search that found nothing; the next one is twice as far.
    pub(super) fn dispelled(&self) -> Self {
        Self { looks: self.looks.saturating_mul(2), ..Self::default() }
    }
}

impl Engine {
    /// To be called after every sweep with the number of multipliers at their caps. True if it is time to search for
    /// contradictions; before that caps are raised.
    pub(super) fn suspects(&mut self, capped: usize, constraints: &ConstraintSet) -> Result<bool> {
        if !self.course.suspicion.watch.is_due(PATIENCE) {
            return Ok(false);
        }
        let all = distances(&mut self.splitting.hard, &self.splitting.points);
        let largest = all.into_iter().fold(0.0, f64::max);
        let suspicion = &mut self.course.suspicion;
        if largest <= VIOLATED * self.extent {
            // Whatever keeps the sweeps busy, it is no contradiction.
            suspicion.watch = Watch::default();
            return Ok(false);
        }
        suspicion.watch.see(largest);
        let vain = suspicion.watch.vain;
        let was_raised_in_vain = self.raises >= RAISES && suspicion.looks == LOOKS;
        if vain >= suspicion.looks || was_raised_in_vain && vain > 0 {
            return Ok(true);
        }
        if vain > 0 && capped > 0 && self.raises < RAISES {
            self.raises += 1;
            self.splitting.caps = self.priorities.caps(self.raises);
            self.splitting.set_penalty(STIFFER * self.splitting.penalty, constraints, false)?;
        }
        Ok(false)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::problem::FairnessRows;
    use crate::problem::Objective;
    use crate::solver::Solver;

    /// A grid whose edges keep their lengths within 3 %, one of which is to be half as long again.
    fn contradiction() -> Solver {
        let points: Vec<DVec3> = (0..25)
            .map(|i| (f64::from(i % 5), f64::from(i / 5)))
            .map(|(x, y)| DVec3::new(x, y, 0.1 * (x + 0.5 * y).sin()))
            .collect();
        let along = (0..25).filter(|i| i % 5 < 4).map(|i| [i, i + 1]);
        let edges: Vec<[u32; 2]> = along.chain((0..20).map(|i| [i, i + 5])).collect();
        let mut solver = Solver::new();
        solver.set_points(&points).unwrap();
        let rows = FairnessRows::laplacian(points.len(), &edges);
        solver.set_objective(&Objective::default(), rows).unwrap();
        for (k, [a, b]) in edges.iter().chain([&edges[17]]).enumerate() {
            let length = points[*a as usize].distance(points[*b as usize]);
            let factors = if k < edges.len() { [0.97, 1.03] } else { [1.5, 1.6] };
            let id = solver.add_constraint("EdgeLength", &[*a, *b], if k < edges.len() { 2.0 } else { 1.0 }).unwrap();
            solver.edit_constraint("EdgeLength", id, &factors.map(|factor| factor * length)).unwrap();
            solver.set_hard(&[id], true).unwrap();
        }
        solver.init().unwrap();
        solver
    }

    #[test]
    fn multipliers_stay_within_their_caps_and_points_near_the_model() {
        let mut solver = contradiction();
        for sweep in 0..800 {
            solver.solve(1).unwrap();
            let splitting = &solver.explorer.engine.as_ref().unwrap().splitting;
            let all = splitting.multipliers();
            for (item, cap) in splitting.hard.items.iter().zip(&splitting.caps) {
                let squares: f64 = all[item.rows()].iter().map(|u| u.length_squared()).sum();
                let multiplier = splitting.penalty * item.scale * squares.sqrt();
                assert!(multiplier <= cap * (1.0 + 1e-12), "sweep {sweep}: {multiplier:e} above {cap:e}");
            }
            assert!(solver.points.iter().all(|point| point.length() < 12.0), "sweep {sweep}");
        }
        assert_eq!(solver.found().unwrap().conflicts, [40]);
    }
}
