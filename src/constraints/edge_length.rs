//! EdgeLength: an edge whose length stays within a range.
//!
//! Set: edges `e = x₁ − x₀` with `min ≤ ‖e‖ ≤ max`. Row: `e`. Projection: `clamp(‖e‖, min, max) e/‖e‖`; nearest. An
//! edge of no length is given the direction that it had at creation, or +x if it had none. Scalars: `length_min`,
//! `length_max` in model units with `0 ≤ min ≤ max`, by default both the length at creation. Unlike EdgeStrain, whose
//! energy is that of a strain, the energy is that of lengths: edges weigh the same whatever their length. Violation:
//! the distance of the length from the range in model units. Nothing can degenerate. Source: elementary; Deng et al.
//! 2015, section 3.3.3, lists it.

use glam::DVec3;

use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalar, Scalars, Stencil, TypeInfo, check_range};
use crate::error::Result;
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;

/// One EdgeLength constraint.
#[derive(Clone, Debug)]
pub struct EdgeLength {
    /// The unit vector along the edge at creation.
    rest_direction: DVec3,
}

impl Constraint for EdgeLength {
    const INFO: TypeInfo = TypeInfo {
        name: "EdgeLength",
        help: "keeps the length of an edge within a range",
        least_indices: 2,
        greatest_indices: Some(2),
        index_names: &["start", "end"],
        scalars: Scalars::Named(&[
            Scalar { name: "length_min", default: None },
            Scalar { name: "length_max", default: None },
        ]),
        rows: Rows::Linear(1),
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(include_str!("../solver/gpu/shaders/edge_length.wgsl"), RowUnit::Length);

    fn kernel_numbers(&self, scalars: &[f64], size: f64, numbers: &mut Vec<f64>) {
        numbers.extend([scalars[0] / size, scalars[1] / size]);
        numbers.extend(self.rest_direction.to_array());
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        let [start, end] = x.array();
        scalars.extend([start.distance(end); 2]);
        Self { rest_direction: (end - start).try_normalize().unwrap_or(DVec3::X) }
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        check_range("length", scalars[0], scalars[1])
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        coefficients.copy_from_slice(&[-1.0, 1.0]);
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let [start, end] = x.array();
        let edge = end - start;
        let length = edge.length();
        let allowed = length.clamp(scalars[0], scalars[1]);
        targets[0] =
            if length == allowed { edge } else { edge.try_normalize().unwrap_or(self.rest_direction) * allowed };
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let edge = x[1] - x[0];
        let squared = edge.dot(edge);
        let length = squared.sqrt();
        let factor = length.max(four.scalar(0)).min(four.scalar(1)) / length;
        targets[0] = edge * factor;
        // Not edges without a length, nor numbers too small to keep all digits, nor infinite ones.
        let [least, greatest] = [f64::MIN_POSITIVE, f64::MAX].map(|value| four.splat(value));
        squared.above(least) & greatest.above(squared.max(factor))
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        let [start, end] = x.array();
        let length = start.distance(end);
        (length - length.clamp(scalars[0], scalars[1])).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_is_cut_or_stretched_along_itself() {
        let points = [DVec3::ONE, DVec3::ONE + 5.0 * DVec3::Y];
        let stencil = Stencil::absolute(&points, &[0, 1]);
        let (mut scalars, mut targets) = (Vec::new(), [DVec3::ZERO]);
        let edge = EdgeLength::at_rest(stencil, &mut scalars);
        assert_eq!(scalars, [5.0, 5.0]);
        for (range, length) in [([1.0, 3.0], 3.0), ([6.0, 7.0], 6.0), ([4.0, 6.0], 5.0), ([0.0, 0.0], 0.0)] {
            edge.project(&range, stencil, &mut targets);
            assert_eq!(targets[0], length * DVec3::Y);
            assert_eq!(edge.violation(&range, stencil), (5.0 - length).abs());
        }
    }

    #[test]
    fn an_edge_that_lost_its_length_takes_the_direction_it_had() {
        let (rest, now) = ([DVec3::ZERO, -2.0 * DVec3::Z], [DVec3::ONE; 2]);
        let (mut scalars, mut targets) = (Vec::new(), [DVec3::ZERO]);
        let edge = EdgeLength::at_rest(Stencil::absolute(&rest, &[0, 1]), &mut scalars);
        edge.project(&scalars, Stencil::absolute(&now, &[0, 1]), &mut targets);
        assert_eq!(targets[0], -2.0 * DVec3::Z);
    }

    #[test]
    fn a_range_that_ends_before_it_begins_is_refused() {
        assert_eq!(EdgeLength::check_scalars(&[2.0, 1.0]).unwrap_err().place(), "length");
        assert!(EdgeLength::check_scalars(&[-1.0, 1.0]).is_err());
    }
}
