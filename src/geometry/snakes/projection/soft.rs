//! The first phase: squared errors and the squared way together.

use std::ops::ControlFlow;

use glam::DVec3;

use super::{Options, Residuals};
use crate::error::Result;
use crate::geometry::snakes::functionals::Row;
use crate::geometry::snakes::velocity::entries;
use crate::linalg::gauss_newton::{self, Options as Stopping};
use crate::linalg::least_squares::LeastSquares;

/// Stop where the gradient is at most this, in units of the snake's size.
const GRADIENT: f64 = 1e-12;

/// Where the sum of squares is least, and the iterations it took. Points that are given stay.
pub(super) fn minimise(residuals: &Residuals<'_>, start: &[DVec3], options: &Options) -> Result<(Vec<DVec3>, usize)> {
    let mut soft = Soft { residuals, options };
    // Unknowns are ways from the start in units of the size, so that far from the origin no digit of a small way is lost.
    let unknowns = vec![0.0; 3 * start.len()];
    let stopping = Stopping {
        gradient: GRADIENT,
        max_iterations: options.max_iterations,
        relative_decrease: 1e-12,
        ..Stopping::default()
    };
    let found = gauss_newton::minimise(&mut soft, &unknowns, &stopping, &mut |_| ControlFlow::Continue(()))?;
    Ok((soft.points(&found.x), found.history.len().saturating_sub(1)))
}

struct Soft<'a> {
    residuals: &'a Residuals<'a>,
    options: &'a Options,
}

impl Soft<'_> {
    fn points(&self, x: &[f64]) -> Vec<DVec3> {
        let size = self.residuals.size;
        let moved = |(i, way): (usize, &[f64])| {
            let from = self.residuals.target[i];
            if self.residuals.is_fixed[i] { from } else { from + size * DVec3::from_slice(way) }
        };
        x.chunks_exact(3).enumerate().map(moved).collect()
    }

    /// Calls `take` with the coefficients and the residual of every term; those of heights need the foot.
    fn each(&self, x: &[f64], mut take: impl FnMut(Row, f64)) {
        let points = self.points(x);
        let size = self.residuals.size;
        for distance in &self.residuals.distances {
            let [i, j] = distance.points;
            let apart = points[i as usize] - points[j as usize];
            let length = apart.length();
            let direction = apart.try_normalize().unwrap_or(DVec3::X);
            let row = Row { terms: vec![(i, direction), (j, -direction)], right: 0.0, weight: 1.0 };
            take(row, (length - distance.length) / size);
        }
        for row in self.residuals.conditions {
            let norm = row.terms.iter().map(|(_, a)| a.length_squared()).sum::<f64>().sqrt();
            let scale = if norm > 0.0 { 1.0 / norm } else { 1.0 };
            let terms = row.terms.iter().map(|&(i, a)| (i, scale * a)).collect();
            take(Row { terms, right: 0.0, weight: 1.0 }, scale * row.residual(&points) / size);
        }
        let Some(surface) = self.residuals.surface.as_ref().filter(|_| self.options.surface_weight > 0.0) else {
            return;
        };
        let weight = self.options.surface_weight.sqrt();
        for (i, wanted) in surface.heights.iter().enumerate() {
            let foot = surface.reference.nearest(points[i]);
            let off = foot.normal.dot(points[i] - foot.point) - wanted;
            let row = Row { terms: vec![(i as u32, weight * foot.normal)], right: 0.0, weight: 1.0 };
            take(row, weight * off / size);
        }
    }
}

impl gauss_newton::Residuals for Soft<'_> {
    fn unknown_count(&self) -> usize {
        3 * self.residuals.is_fixed.len()
    }

    fn value(&mut self, x: &[f64]) -> f64 {
        let mut sum: f64 = self.options.mu * x.iter().map(|x| x * x).sum::<f64>();
        self.each(x, |_, residual| sum += residual * residual);
        sum
    }

    fn linearise(&mut self, x: &[f64], equations: &mut LeastSquares) {
        let root = self.options.mu.sqrt();
        (0_u32..).zip(x).for_each(|(i, x)| equations.add(&[(i, root)], -root * x));
        self.each(x, |row, residual| {
            let mut coefficients = entries(&row);
            coefficients.iter_mut().filter(|(i, _)| self.residuals.is_fixed[*i as usize / 3]).for_each(|e| e.1 = 0.0);
            equations.add(&coefficients, -residual);
        });
    }
}
