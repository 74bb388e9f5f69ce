//! The quadratic part of the objective: `½ Σ d_i ‖p_i − r_i‖² + ½ w_f ‖L (p − p⁰)‖² − f · p`.

use glam::DVec3;

use crate::problem::{FairnessRows, Objective};

/// `d`, `r`, `L`, `p⁰` and the forces `f`.
pub(super) struct Quadratic {
    /// `w_h` at handles, `w_c` elsewhere.
    diagonal: Vec<f64>,
    /// Targets of handles, `p⁰` elsewhere.
    targets: Vec<DVec3>,
    is_handle: Vec<bool>,
    weights: Objective,
    rows: FairnessRows,
    initial: Vec<DVec3>,
    forces: Vec<DVec3>,
}

/// The terms of the objective, each with its weight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ObjectiveTerms {
    /// `½ w_h Σ ‖p_i − t_i‖²` over the handles.
    pub handles: f64,
    /// `½ w_c Σ ‖p_i − p⁰_i‖²` over the other points.
    pub closeness: f64,
    /// `½ w_f ‖L (p − p⁰)‖²`.
    pub fairness: f64,
    /// Soft constraints, `½ Σ w m ‖A p − P(p)‖²`.
    pub soft: f64,
}

impl Quadratic {
    pub(super) fn new(
        weights: &Objective,
        rows: &FairnessRows,
        initial: &[DVec3],
        handles: impl Iterator<Item = (u32, DVec3)>,
    ) -> Self {
        let mut quadratic = Self {
            diagonal: vec![weights.closeness_weight; initial.len()],
            targets: initial.to_vec(),
            is_handle: vec![false; initial.len()],
            weights: weights.clone(),
            rows: if weights.fairness_weight > 0.0 { rows.clone() } else { FairnessRows::default() },
            initial: initial.to_vec(),
            forces: vec![DVec3::ZERO; initial.len()],
        };
        for (point, target) in handles {
            let i = point as usize;
            quadratic.diagonal[i] = weights.handle_weight;
            quadratic.is_handle[i] = true;
            quadratic.targets[i] = target;
        }
        quadratic
    }

    /// `p⁰`.
    pub(super) fn initial(&self) -> &[DVec3] {
        &self.initial
    }

    /// Moves the target of a handle; the matrix stays.
    pub(super) fn set_target(&mut self, point: u32, target: DVec3) {
        self.targets[point as usize] = target;
    }

    /// Sets the forces; returns the largest change of one.
    pub(super) fn set_forces(&mut self, forces: &[DVec3]) -> f64 {
        let change = self.forces.iter().zip(forces).map(|(old, new)| old.distance(*new)).fold(0.0, f64::max);
        self.forces.copy_from_slice(forces);
        change
    }

    /// Calls `visit(i, j, value)` for every contribution to the lower triangle of the matrix.
    pub(super) fn each_entry(&self, visit: &mut dyn FnMut(u32, u32, f64)) {
        (0..).zip(&self.diagonal).for_each(|(i, &d)| visit(i, i, d));
        let weight = self.weights.fairness_weight;
        for row in self.rows.iter() {
            for (place, &(i, a)) in row.iter().enumerate() {
                visit(i, i, weight * a * a);
                for &(j, b) in &row[..place] {
                    // A repeated point meets itself in both triangles.
                    visit(i, j, if i == j { 2.0 } else { 1.0 } * weight * a * b);
                }
            }
        }
    }

    /// The right-hand side: minus the gradient at the origin.
    pub(super) fn right_hand_side(&self, sums: &mut [DVec3]) {
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum = self.diagonal[i] * self.targets[i] + self.forces[i];
        }
        self.add_fairness(&self.initial, sums);
    }

    /// The gradient at `points`.
    pub(super) fn gradient(&self, points: &[DVec3], sums: &mut [DVec3]) {
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum = self.diagonal[i] * (points[i] - self.targets[i]) - self.forces[i];
        }
        let displacements: Vec<DVec3> = points.iter().zip(&self.initial).map(|(p, start)| *p - *start).collect();
        self.add_fairness(&displacements, sums);
    }

    /// The matrix times `vectors`.
    pub(super) fn apply(&self, vectors: &[DVec3], sums: &mut [DVec3]) {
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum = self.diagonal[i] * vectors[i];
        }
        self.add_fairness(vectors, sums);
    }

    /// Adds `w_f Lᵀ L` times `vectors`.
    fn add_fairness(&self, vectors: &[DVec3], sums: &mut [DVec3]) {
        for row in self.rows.iter() {
            let image: DVec3 = row.iter().map(|&(i, a)| a * vectors[i as usize]).sum();
            let scaled = self.weights.fairness_weight * image;
            row.iter().for_each(|&(i, a)| sums[i as usize] += a * scaled);
        }
    }

    /// The gradients of the terms `handles`, `closeness` and `fairness` at `points`.
    pub(super) fn gradients_of_terms(&self, points: &[DVec3]) -> [Vec<DVec3>; 3] {
        let part = |of_handles: bool| {
            let all = points.iter().zip(&self.targets).zip(&self.diagonal).zip(&self.is_handle);
            let one = |(((p, t), d), is_handle): (((&DVec3, &DVec3), &f64), &bool)| {
                if *is_handle == of_handles { *d * (*p - *t) } else { DVec3::ZERO }
            };
            all.map(one).collect()
        };
        let displacements: Vec<DVec3> = points.iter().zip(&self.initial).map(|(p, start)| *p - *start).collect();
        let mut fairness = vec![DVec3::ZERO; points.len()];
        self.add_fairness(&displacements, &mut fairness);
        [part(true), part(false), fairness]
    }

    /// The terms at `points`, soft constraints left at 0.
    pub(super) fn terms(&self, points: &[DVec3]) -> ObjectiveTerms {
        let part = |of_handles: bool| {
            let all = points.iter().zip(&self.targets).zip(&self.diagonal).zip(&self.is_handle);
            let one = all.filter(|(_, is_handle)| **is_handle == of_handles);
            0.5 * one.map(|(((p, t), d), _)| d * p.distance_squared(*t)).sum::<f64>()
        };
        let image = |row: &[(u32, f64)]| -> DVec3 {
            row.iter().map(|&(i, a)| a * (points[i as usize] - self.initial[i as usize])).sum()
        };
        let squares: f64 = self.rows.iter().map(|row| image(row).length_squared()).sum();
        ObjectiveTerms {
            handles: part(true),
            closeness: part(false),
            fairness: 0.5 * self.weights.fairness_weight * squares,
            soft: 0.0,
        }
    }

    /// `f · p`.
    pub(super) fn work(&self, points: &[DVec3]) -> f64 {
        self.forces.iter().zip(points).map(|(force, p)| force.dot(*p)).sum()
    }

    /// The sum of the matrix's diagonal over points that are no handles, and their number.
    pub(super) fn free_trace(&self) -> (f64, usize) {
        let mut trace = 0.0;
        let mut count = 0;
        for (d, _) in self.diagonal.iter().zip(&self.is_handle).filter(|(_, is_handle)| !**is_handle) {
            trace += d;
            count += 1;
        }
        let weight = self.weights.fairness_weight;
        for row in self.rows.iter() {
            trace += row.iter().filter(|(i, _)| !self.is_handle[*i as usize]).map(|(_, a)| weight * a * a).sum::<f64>();
        }
        (trace, count)
    }
}
