//! TetrahedronStrain: a tetrahedron whose stretches stay within a range, right side out.
//!
//! Set: deformation gradients `F` (3×3, see `deformation`) with singular values in `[rmin, rmax]` and `det F > 0`. Rows: the
//! three columns of `F`. Projection: `U diag(clamp(s)) Vᵀ` of `F = U diag(s) Vᵀ`; the smallest value changes its sign if
//! `det U · det V < 0`. Nearest for a tetrahedron that is right side out; one that is inside out is turned back, which
//! its clamped values do not do in the shortest way, so the type calls itself feasible. Measure: the rest volume.
//! Scalars: `range_min`, `range_max`, stretches without unit (1, 1). Violation: the largest distance of a singular value
//! from the range, the smallest counted negative where the tetrahedron is inside out; without unit. Degenerate where the
//! tetrahedron at creation is flat: its rows are then zero. Sources: Bouaziz et al. 2014, section 5.1; Deuss et al. 2015,
//! Table 1.

use glam::DVec3;

use super::deformation::{self, Deformation, RestShape, orientation, recompose, strain_violation};
use super::{Constraint, Four, Kernel, Projection, RANGE, RowUnit, Rows, Scalars, Stencil, TypeInfo, check_range};
use crate::error::Result;
use crate::linalg::lanes::{Mask, Svd4, V4};
use crate::linalg::simd::Isa;

/// One TetrahedronStrain constraint: its rest shape.
#[derive(Clone, Debug)]
pub struct TetrahedronStrain(RestShape<3>);

impl Constraint for TetrahedronStrain {
    const INFO: TypeInfo = TypeInfo {
        name: "TetrahedronStrain",
        help: "keeps the stretches of a tetrahedron, against its rest shape, within a range",
        least_indices: 4,
        greatest_indices: Some(4),
        index_names: &["first", "second", "third", "fourth"],
        scalars: Scalars::Named(&RANGE),
        rows: Rows::Linear(3),
        projection: Projection::Feasible,
        violation_unit: "stretch",
        energy_scale_power: 3,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(
            include_str!("../solver/gpu/shaders/strain.wgsl"),
            include_str!("../solver/gpu/shaders/tetrahedron_strain.wgsl")
        ),
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
        let mut s = svd.s.map(|s| s.clamp(scalars[0], scalars[1]));
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
        let [a, b, c] = svd.s;
        strain_violation([a, b, c * orientation(&svd)], [scalars[0], scalars[1]])
    }

    fn is_degenerate(&self, _scalars: &[f64]) -> bool {
        self.0.is_degenerate()
    }
}

impl Deformation<3> for TetrahedronStrain {
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
        let (min, max) = (four.scalar(0), four.scalar(1));
        let s = svd.turn_inside_out(gradient, svd.s.map(|s| s.max(min).min(max)));
        svd.recompose(s, targets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_turned_inside_out_is_turned_back() {
        // Mirrored in z and stretched, F = diag(2, 1, −½): within [0.8, 1.5] the nearest values are 1.5, 1 and 0.8.
        let rest = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let all = &[0, 1, 2, 3];
        let mut scalars = Vec::new();
        let tetrahedron = TetrahedronStrain::at_rest(Stencil::absolute(&rest, all), &mut scalars);
        assert!((tetrahedron.measure(&scalars) - 1.0 / 6.0).abs() < 1e-16);
        let mirrored = [DVec3::ZERO, 2.0 * DVec3::X, DVec3::Y, -0.5 * DVec3::Z];
        let mut targets = [DVec3::ZERO; 3];
        tetrahedron.project(&[0.8, 1.5], Stencil::absolute(&mirrored, all), &mut targets);
        for (target, expected) in targets.into_iter().zip([1.5 * DVec3::X, DVec3::Y, 0.8 * DVec3::Z]) {
            assert!((target - expected).length() < 1e-15, "{target} is not {expected}");
        }
        assert!((tetrahedron.violation(&[0.8, 1.5], Stencil::absolute(&mirrored, all)) - 1.3).abs() < 1e-15);
    }
}
