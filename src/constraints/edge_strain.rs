//! EdgeStrain: an edge whose length stays within a range of its rest length.
//!
//! Set: edges `e = x₁ − x₀` with `rmin ≤ ‖e‖/L ≤ rmax`. Row: `e/L`. Projection: `clamp(‖e‖/L, rmin, rmax) e/‖e‖`; nearest.
//! An edge of no length has no direction: it is given +x. Measure: the rest length `L₀` at creation (`L` where `L₀ = 0`),
//! whatever `L` is edited to. Scalars: `L` in model units (default `L₀`), `range_min` and `range_max` as ratios (1, 1).
//! Violation: the distance of `‖e‖` from `[rmin L, rmax L]` in model units. Degenerate where `L₀ = 0` and no length was
//! edited in: its row is then zero. Sources: Bouaziz et al. 2014, section 5.1; Deuss et al. 2015, Table 1.

use glam::DVec3;

use super::{
    Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalar, Scalars, Stencil, TypeInfo, check_positive,
    check_range,
};
use crate::error::Result;
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;

/// One EdgeStrain constraint.
#[derive(Clone, Debug)]
pub struct EdgeStrain {
    /// `L₀`, the length at creation.
    rest_length: f64,
}

impl Constraint for EdgeStrain {
    const INFO: TypeInfo = TypeInfo {
        name: "EdgeStrain",
        help: "keeps the length of an edge within a range of its rest length",
        least_indices: 2,
        greatest_indices: Some(2),
        index_names: &["start", "end"],
        scalars: Scalars::Named(&[
            Scalar { name: "length", default: None },
            Scalar { name: "range_min", default: Some(1.0) },
            Scalar { name: "range_max", default: Some(1.0) },
        ]),
        rows: Rows::Linear(1),
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 1,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(include_str!("../solver/gpu/shaders/edge_strain.wgsl"), RowUnit::Ratio);

    fn kernel_numbers(&self, scalars: &[f64], _size: f64, numbers: &mut Vec<f64>) {
        numbers.extend_from_slice(&scalars[1..]);
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        let [start, end] = x.array();
        let rest_length = start.distance(end);
        scalars.extend([rest_length, 1.0, 1.0]);
        Self { rest_length }
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        check_positive("length", scalars[0])?;
        check_range("range", scalars[1], scalars[2])
    }

    fn measure(&self, scalars: &[f64]) -> f64 {
        if self.rest_length > 0.0 { self.rest_length } else { scalars[0] }
    }

    fn rows(&self, scalars: &[f64], coefficients: &mut [f64]) {
        if scalars[0] > 0.0 {
            coefficients.copy_from_slice(&[-1.0 / scalars[0], 1.0 / scalars[0]]);
        }
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let [length, range_min, range_max] = scalars else { return };
        let [start, end] = x.array();
        let edge = end - start;
        targets[0] = if *length > 0.0 {
            edge.try_normalize().unwrap_or(DVec3::X) * (edge.length() / length).clamp(*range_min, *range_max)
        } else {
            DVec3::ZERO
        };
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let [length, range_min, range_max] = [0, 1, 2].map(|i| four.scalar(i));
        let edge = x[1] - x[0];
        let squared = edge.dot(edge);
        let current = squared.sqrt();
        let scale = length * current;
        let factor = current.max(range_min * length).min(range_max * length) / scale;
        targets[0] = edge * factor;
        // Not edges without a length, nor numbers too small to keep all digits, nor infinite ones.
        let [least, greatest] = [f64::MIN_POSITIVE, f64::MAX].map(|value| four.splat(value));
        squared.min(scale).above(least) & greatest.above(squared.max(scale).max(factor))
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        let [start, end] = x.array();
        let (length, strain) = (scalars[0], start.distance(end) / scalars[0]);
        if length > 0.0 { length * (strain - strain.clamp(scalars[1], scalars[2])).abs() } else { 0.0 }
    }

    fn is_degenerate(&self, scalars: &[f64]) -> bool {
        scalars[0] <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_cut_to_its_range_along_itself() {
        let (rest, pulled) = ([DVec3::ZERO, 2.0 * DVec3::X], [DVec3::ONE, DVec3::ONE + 5.0 * DVec3::Y]);
        let mut scalars = Vec::new();
        let edge = EdgeStrain::at_rest(Stencil::absolute(&rest, &[0, 1]), &mut scalars);
        assert_eq!((scalars.as_slice(), edge.measure(&scalars)), ([2.0, 1.0, 1.0].as_slice(), 2.0));
        // At most 1.5 × 2 long: the target is 1.5 in units of the length, and 5 − 3 = 2 is too much.
        let (scalars, mut targets, mut row) = ([2.0, 0.5, 1.5], [DVec3::ZERO], [0.0; 2]);
        edge.project(&scalars, Stencil::absolute(&pulled, &[0, 1]), &mut targets);
        edge.rows(&scalars, &mut row);
        assert_eq!((targets[0], row), (1.5 * DVec3::Y, [-0.5, 0.5]));
        assert_eq!(edge.violation(&scalars, Stencil::absolute(&pulled, &[0, 1])), 2.0);
    }

    #[test]
    fn an_edge_of_no_length_waits_for_one_to_be_edited_in() {
        let points = [DVec3::ONE; 2];
        let mut scalars = Vec::new();
        let edge = EdgeStrain::at_rest(Stencil::absolute(&points, &[0, 1]), &mut scalars);
        let mut row = [0.0; 2];
        edge.rows(&scalars, &mut row);
        assert!(edge.is_degenerate(&scalars) && row == [0.0; 2] && edge.measure(&scalars) == 0.0);
        let edited = [4.0, 1.0, 1.0];
        edge.rows(&edited, &mut row);
        assert!(!edge.is_degenerate(&edited) && row == [-0.25, 0.25] && edge.measure(&edited) == 4.0);
    }
}
