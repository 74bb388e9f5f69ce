//! How a solution answers a change of weights.
//!
//! A solution solves `∇F(p; w) + Aᵀ λ = 0`, `A p ∈ C`. Differentiated by the logarithm of a weight class, whose part of
//! the gradient is `g`, both conditions are linear in the changes of points and multipliers, with the matrix of the
//! finish:
//!
//! ```text
//! ∇²L dp + Aᵀ dλ = −g,      the linearised constraints stay as they are
//! ```
//!
//! so a class costs one solve with the factor of the finish, and another per update of the multipliers.

use glam::DVec3;

use super::derivatives::add_transposed;
use super::distances;
use super::finish::STIFFER;
use super::{Engine, Found};
use crate::error::{Error, Result, Status};
use crate::solver::Solver;

/// A group of weights that are changed together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightClass {
    /// `w_h`.
    Handles,
    /// `w_c`.
    Closeness,
    /// `w_f`.
    Fairness,
    /// The weights of all soft constraints of the type of this name.
    Soft(&'static str),
}

/// How far the solution and each term of the objective move per change of each weight class.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivities {
    /// The classes.
    pub classes: Vec<WeightClass>,
    /// By class: `dp/d ln w` of every point, in model units: doubling the weight moves a point by about 0.69 times
    /// that.
    pub points: Vec<Vec<DVec3>>,
    /// By class: `dE_j/d ln w` of every class's squares `E_j = w_j Σ ‖·‖²`, in the order of the classes; the `w_j` in
    /// front is held.
    pub squares: Vec<Vec<f64>>,
    /// The `E_j` themselves: twice the terms of the objective.
    pub values: Vec<f64>,
}

impl WeightClass {
    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Handles => "handles",
            Self::Closeness => "closeness",
            Self::Fairness => "fairness",
            Self::Soft(type_name) => type_name,
        }
    }
}

impl Solver {
    /// The weight classes of the model: handles, closeness, fairness, and one per type of soft constraints.
    pub fn weight_classes(&self) -> Vec<WeightClass> {
        let soft = self.constraints.soft_types().map(|info| WeightClass::Soft(info.name));
        [WeightClass::Handles, WeightClass::Closeness, WeightClass::Fairness].into_iter().chain(soft).collect()
    }

    /// How the solution in hand answers a change of each weight class.
    ///
    /// # Errors
    /// Status `NotInitialised` where the last solve did not end in a solution: solve until it converges, first.
    pub fn sensitivities(&mut self) -> Result<Sensitivities> {
        let is_solution = self.explorer.is_current() && self.found().is_some_and(|found: &Found| found.is_solution);
        let points = &self.points;
        let engine = self.explorer.engine.take_if(|engine| is_solution && engine.splitting.points == *points);
        let mut engine = engine.ok_or_else(|| {
            let reason = "sensitivities are those of a solution: solve until it is converged, first";
            Error::new(Status::NotInitialised, reason)
        })?;
        let result = engine
            .sensitivities(self.weight_classes(), |id| self.constraints.get(id).map_or("", |view| view.info.name));
        self.explorer.engine = Some(engine);
        result
    }
}

impl Engine {
    fn sensitivities(
        &mut self,
        classes: Vec<WeightClass>,
        type_of: impl Fn(usize) -> &'static str,
    ) -> Result<Sensitivities> {
        let points = self.splitting.points.clone();
        let types: Vec<&'static str> = self.splitting.soft.items.iter().map(|item| type_of(item.id)).collect();
        let mut gradients: Vec<Vec<DVec3>> = self.splitting.quadratic.gradients_of_terms(&points).into();
        let soft = &mut self.splitting.soft;
        let soft_distances = distances(soft, &points);
        for class in &classes[3..] {
            let mut gradient = vec![DVec3::ZERO; points.len()];
            for (i, item) in soft.items.iter().enumerate().filter(|(i, _)| WeightClass::Soft(types[*i]) == *class) {
                let mut rows = vec![DVec3::ZERO; item.row_count];
                soft.rows_of(item, &points, &mut rows);
                rows.iter_mut().zip(&soft.targets[item.rows()]).for_each(|(row, target)| *row -= *target);
                add_transposed(soft, item, soft.stiffness[i], &rows, &mut gradient);
            }
            gradients.push(gradient);
        }
        let terms = self.splitting.quadratic.terms(&points);
        let mut values = vec![2.0 * terms.handles, 2.0 * terms.closeness, 2.0 * terms.fairness];
        let soft = &self.splitting.soft;
        for class in &classes[3..] {
            let of_class = (0..types.len()).filter(|i| WeightClass::Soft(types[*i]) == *class);
            values.push(of_class.map(|i| soft.stiffness[i] * (soft_distances[i] / soft.items[i].scale).powi(2)).sum());
        }
        let u = self.finish_multipliers(STIFFER[0]);
        let mut kept = std::mem::take(&mut self.kept);
        let steps = self.finish_of(STIFFER[0]).answers(&points, &u, &gradients, &mut kept);
        self.kept = kept;
        let steps = steps?;
        let along = |gradient: &Vec<DVec3>, step: &Vec<DVec3>| {
            2.0 * gradient.iter().zip(step).map(|(g, d)| g.dot(*d)).sum::<f64>()
        };
        let squares = steps.iter().map(|step| gradients.iter().map(|g| along(g, step)).collect()).collect();
        Ok(Sensitivities { classes, points: steps, squares, values })
    }
}
