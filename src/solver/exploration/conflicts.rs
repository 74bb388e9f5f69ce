//! Caps of multipliers, and which constraints contradict each other.

use super::splitting::Splitting;
use crate::constraints::ConstraintSet;

/// The cap of a multiplier over the forces of the objective: those at `p⁰`, and that which moves a point of mean stiffness by the mean
/// extent of a constraint.
const CAP: f64 = 100.0;

/// The cap of every hard constraint's multiplier. `force` moves a point of mean stiffness by the mean extent of a constraint.
pub(super) fn caps(splitting: &Splitting, constraints: &ConstraintSet, force: f64) -> Vec<f64> {
    let mut gradient = vec![glam::DVec3::ZERO; splitting.points.len()];
    splitting.quadratic.gradient(&splitting.points, &mut gradient);
    let largest = gradient.iter().map(|g| g.length()).fold(force, f64::max);
    let weight = |id| constraints.get(id).map_or(1.0, |view| view.weight);
    splitting.hard.items.iter().map(|item| CAP * largest * weight(item.id)).collect()
}
