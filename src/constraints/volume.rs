//! Volume: a tetrahedron whose volume stays within a range of its rest volume.
//!
//! Set: deformation gradients `F` (3×3, see `deformation`) with `det F ∈ [rmin, rmax]`, the ratio of the volumes. Rows: the
//! three columns of `F`. Projection: the singular values move along the gradient of their product by four linearised
//! steps (`deformation::move_product_into`), then the smallest changes its sign if `det U · det V < 0`; parity prescribes
//! both. Approximate, so plain iterations can raise the energy slightly. Measure: the rest volume. Scalars: `range_min`,
//! `range_max`, ratios of volumes (1, 1). Violation: the distance of the ratio, negative for a tetrahedron that is inside
//! out, from the range; without unit. One shrunk to a line or point stays one. Degenerate where the tetrahedron at
//! creation is flat: its rows are then zero. Sources: Bouaziz et al. 2014, section 5.2; Deuss et al. 2015, Table 1.

use glam::DVec3;

use super::deformation::{
    self, Deformation, RestShape, move_product_into, move_product_into_four, orientation, recompose, strain_violation,
};
use super::{Constraint, Four, Kernel, Projection, RANGE, RowUnit, Rows, Scalars, Stencil, TypeInfo, check_range};
use crate::error::Result;
use crate::linalg::lanes::{Mask, Svd4, V4};
use crate::linalg::simd::Isa;

/// One Volume constraint: its rest shape.
#[derive(Clone, Debug)]
pub struct Volume(RestShape<3>);

impl Constraint for Volume {
    const INFO: TypeInfo = TypeInfo {
        name: "Volume",
        help: "keeps the volume of a tetrahedron within a range of its rest volume",
        least_indices: 4,
        greatest_indices: Some(4),
        index_names: &["first", "second", "third", "fourth"],
        scalars: Scalars::Named(&RANGE),
        rows: Rows::Linear(3),
        projection: Projection::Approximate,
        violation_unit: "ratio of volumes",
        energy_scale_power: 3,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(include_str!("../solver/gpu/shaders/strain.wgsl"), include_str!("../solver/gpu/shaders/volume.wgsl")),
        RowUnit::Ratio,
    );

    fn kernel_numbers(&self, scalars: &[f64], _size: f64, numbers: &mut Vec<f64>) {
        numbers.extend_from_slice(scalars);
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.extend([1.0, 1.0]);
        Self(RestShape::of_tetrahedron(x))
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
        let mut s = move_product_into(svd.s, [scalars[0], scalars[1]]);
        s[2] *= orientation(&svd);
        recompose(&svd, s, targets);
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
        let svd = self.0.decompose(x);
        strain_violation([orientation(&svd) * svd.s.iter().product::<f64>()], [scalars[0], scalars[1]])
    }

    fn is_degenerate(&self, _scalars: &[f64]) -> bool {
        self.0.is_degenerate()
    }
}

impl Deformation<3> for Volume {
    fn rest_shape(&self) -> &RestShape<3> {
        &self.0
    }

    #[inline(always)]
    fn project_decomposed<S: Isa>(
        four: Four<'_, Self, S>,
        gradient: [V4<S>; 3],
        svd: &Svd4<3, S>,
        targets: &mut [V4<S>],
    ) -> Mask<S> {
        let s = move_product_into_four(svd.s, [four.scalar(0), four.scalar(1)]);
        svd.recompose(svd.turn_inside_out(gradient, s), targets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_grown_evenly_shrinks_evenly() {
        // Grown by 1.1 each way, the volume is 1.331 times as large; by symmetry the values stay equal and four steps
        // bring them to 1.2^(1/3) within 1e-6.
        let rest = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let all = &[0, 1, 2, 3];
        let tetrahedron = Volume::at_rest(Stencil::absolute(&rest, all), &mut Vec::new());
        let grown = rest.map(|point| 1.1 * point);
        assert!((tetrahedron.violation(&[1.0, 1.2], Stencil::absolute(&grown, all)) - 0.131).abs() < 1e-14);
        let mut targets = [DVec3::ZERO; 3];
        tetrahedron.project(&[1.0, 1.2], Stencil::absolute(&grown, all), &mut targets);
        for (target, axis) in targets.into_iter().zip([DVec3::X, DVec3::Y, DVec3::Z]) {
            assert!((target - 1.2_f64.cbrt() * axis).length() < 1e-6);
        }
    }
}
