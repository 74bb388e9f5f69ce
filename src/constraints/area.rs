//! Area: a triangle whose area stays within a range of its rest area.
//!
//! Set: deformation gradients `F` (3×2, see `deformation`) with `s₀ s₁ ∈ [rmin, rmax]`, the ratio of the areas. Rows: the two
//! columns of `F`. Projection: the singular values move along the gradient of their product by four linearised steps
//! (`deformation::move_product_into`), as parity prescribes: not quite the nearest, not quite in the set, so the type is
//! approximate and plain iterations can raise the energy slightly. Measure: the rest area. Scalars: `range_min`,
//! `range_max`, ratios of areas (1, 1). Violation: the distance of the ratio from the range, without unit. A triangle
//! shrunk to a point stays one. Degenerate where the triangle at creation is flat: its rows are then zero.
//! Sources: Bouaziz et al. 2014, section 5.2; Deuss et al. 2015, Table 1.

use glam::DVec3;

use super::deformation::{
    self, Deformation, RestShape, move_product_into, move_product_into_four, recompose, strain_violation,
};
use super::{Constraint, Four, Kernel, Projection, RANGE, RowUnit, Rows, Scalars, Stencil, TypeInfo, check_range};
use crate::error::Result;
use crate::linalg::lanes::{Mask, Svd4, V4};
use crate::linalg::simd::Isa;

/// One Area constraint: its rest shape.
#[derive(Clone, Debug)]
pub struct Area(RestShape<2>);

impl Constraint for Area {
    const INFO: TypeInfo = TypeInfo {
        name: "Area",
        help: "keeps the area of a triangle within a range of its rest area",
        least_indices: 3,
        greatest_indices: Some(3),
        index_names: &["first", "second", "third"],
        scalars: Scalars::Named(&RANGE),
        rows: Rows::Linear(2),
        projection: Projection::Approximate,
        violation_unit: "ratio of areas",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(include_str!("../solver/gpu/shaders/strain.wgsl"), include_str!("../solver/gpu/shaders/area.wgsl")),
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
        recompose(&svd, move_product_into(svd.s, [scalars[0], scalars[1]]), targets);
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        deformation::project_four(four, x, targets)
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        if self.0.is_degenerate() {
            return 0.0;
        }
        strain_violation([self.0.decompose(x).s.iter().product()], [scalars[0], scalars[1]])
    }

    fn is_degenerate(&self, _scalars: &[f64]) -> bool {
        self.0.is_degenerate()
    }
}

impl Deformation<2> for Area {
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
        let s = move_product_into_four(svd.s, [four.scalar(0), four.scalar(1)]);
        svd.recompose(s, targets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_grown_evenly_shrinks_evenly() {
        // Grown by 1.3 both ways, the area is 1.69 times as large; by symmetry both values become the same, and four
        // steps bring 1.3 to √1.2 within 1e-6.
        let rest = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let all = &[0, 1, 2];
        let triangle = Area::at_rest(Stencil::absolute(&rest, all), &mut Vec::new());
        let grown = rest.map(|point| 1.3 * point);
        assert!((triangle.violation(&[0.9, 1.2], Stencil::absolute(&grown, all)) - 0.49).abs() < 1e-15);
        let mut targets = [DVec3::ZERO; 2];
        triangle.project(&[0.9, 1.2], Stencil::absolute(&grown, all), &mut targets);
        let side = 1.2_f64.sqrt();
        assert!((targets[0] - side * DVec3::X).length() < 1e-6 && (targets[1] - side * DVec3::Y).length() < 1e-6);
    }
}
