//! TriangleStrain: a triangle whose stretches stay within a range.
//!
//! Set: deformation gradients `F` (3×2, see `deformation`) with singular values in `[rmin, rmax]`. Rows: the two columns of
//! `F`. Projection: `U diag(clamp(s)) Vᵀ` of `F = U diag(s) Vᵀ`; nearest in the Frobenius norm. Measure: the rest area.
//! Scalars: `range_min`, `range_max`, stretches without unit (1, 1). Violation: the largest distance of a singular value
//! from the range, without unit. Degenerate where the triangle at creation is flat: its rows are then zero.
//! Sources: Bouaziz et al. 2014, section 5.1; Deuss et al. 2015, Table 1.

use glam::DVec3;

use super::deformation::{self, Deformation, RestShape, recompose, strain_violation};
use super::{Constraint, Four, Kernel, Projection, RANGE, RowUnit, Rows, Scalars, Stencil, TypeInfo, check_range};
use crate::error::Result;
use crate::linalg::lanes::{Mask, Svd4, V4};
use crate::linalg::simd::Isa;

/// One TriangleStrain constraint: its rest shape.
#[derive(Clone, Debug)]
pub struct TriangleStrain(RestShape<2>);

impl Constraint for TriangleStrain {
    const INFO: TypeInfo = TypeInfo {
        name: "TriangleStrain",
        help: "keeps the stretches of a triangle, against its rest shape, within a range",
        least_indices: 3,
        greatest_indices: Some(3),
        index_names: &["first", "second", "third"],
        scalars: Scalars::Named(&RANGE),
        rows: Rows::Linear(2),
        projection: Projection::Nearest,
        violation_unit: "stretch",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(
            include_str!("../solver/gpu/shaders/strain.wgsl"),
            include_str!("../solver/gpu/shaders/triangle_strain.wgsl")
        ),
        RowUnit::Ratio,
    );

    fn kernel_numbers(&self, scalars: &[f64], _size: f64, numbers: &mut Vec<f64>) {
        numbers.extend_from_slice(scalars);
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.extend([1.0, 1.0]);
        Self(RestShape::of_triangle(x))
    }

    fn check_scalars(scalars: &[f64]) -> Result<()> {
        check_range("range", scalars[0], scalars[1])
    }

    fn measure(&self, _scalars: &[f64]) -> f64 {
        self.0.measure()
    }

    fn rows(&self, _scalars: &[f64], coefficients: &mut [f64]) {
        self.0.rows(coefficients);
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let svd = self.0.decompose(x);
        recompose(&svd, svd.s.map(|s| s.clamp(scalars[0], scalars[1])), targets);
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        deformation::project_four(four, x, targets)
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        if self.0.is_degenerate() { 0.0 } else { strain_violation(self.0.decompose(x).s, [scalars[0], scalars[1]]) }
    }

    fn is_degenerate(&self, _scalars: &[f64]) -> bool {
        self.0.is_degenerate()
    }
}

impl Deformation<2> for TriangleStrain {
    fn rest_shape(&self) -> &RestShape<2> {
        &self.0
    }

    #[inline(always)]
    fn project_decomposed<S: Isa>(
        four: Four<'_, Self, S>,
        _gradient: [V4<S>; 2],
        svd: &Svd4<2, S>,
        targets: &mut [V4<S>],
    ) -> Mask<S> {
        let (min, max) = (four.scalar(0), four.scalar(1));
        svd.recompose(svd.s.map(|s| s.max(min).min(max)), targets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_pulled_along_x_is_cut_to_the_range() {
        // Pulled to twice its width F = diag(2, 1); within [1, 1.5] the nearest is diag(1.5, 1).
        let rest = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let all = &[0, 1, 2];
        let mut scalars = Vec::new();
        let triangle = TriangleStrain::at_rest(Stencil::absolute(&rest, all), &mut scalars);
        assert_eq!((scalars.as_slice(), triangle.measure(&scalars)), ([1.0, 1.0].as_slice(), 0.5));
        let pulled = [DVec3::ZERO, 2.0 * DVec3::X, DVec3::Y];
        let mut targets = [DVec3::ZERO; 2];
        triangle.project(&[1.0, 1.5], Stencil::absolute(&pulled, all), &mut targets);
        assert!((targets[0] - 1.5 * DVec3::X).length() < 1e-15 && (targets[1] - DVec3::Y).length() < 1e-15);
        assert!((triangle.violation(&[1.0, 1.5], Stencil::absolute(&pulled, all)) - 0.5).abs() < 1e-15);
    }
}
