//! Parallelogram: four points, in order, that are the corners of a parallelogram.
//!
//! Set: all `x` with `x₀ − x₁ + x₂ − x₃ = 0`. Rows: centred. Projection: onto the best-fit plane, then, in that plane, onto this
//! linear set: `x_i ∓ ¼ (x₀ − x₁ + x₂ − x₃)`. The best-fit plane is not always that of the nearest parallelogram, so the
//! projection is feasible, not nearest, and plain iterations can raise the energy slightly. Parity prescribes it. Violation:
//! the largest distance of a point from its projection, in model units. Nothing can degenerate. Source: Bouaziz et al. 2012,
//! section 3.

use glam::DVec3;

use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::lanes::{self, Mask, V4};
use crate::linalg::simd::Isa;
use crate::linalg::small::{least_eigenvector, scatter};

/// One Parallelogram constraint; it has no rest state.
#[derive(Clone, Debug)]
pub struct Parallelogram;

fn nearest_in_plane(x: Stencil<'_>) -> [DVec3; 4] {
    let normal = least_eigenvector(scatter(x.iter()));
    let corners: [DVec3; 4] = x.array().map(|point: DVec3| point - point.dot(normal) * normal);
    let gap = 0.25 * (corners[0] - corners[1] + corners[2] - corners[3]);
    [corners[0] - gap, corners[1] + gap, corners[2] - gap, corners[3] + gap]
}

impl Constraint for Parallelogram {
    const INFO: TypeInfo = TypeInfo {
        name: "Parallelogram",
        help: "keeps four points the corners of a parallelogram",
        least_indices: 4,
        greatest_indices: Some(4),
        index_names: &["first", "second", "third", "fourth"],
        scalars: Scalars::None,
        rows: Rows::Centred,
        projection: Projection::Feasible,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(include_str!("../solver/gpu/shaders/parallelogram.wgsl"), RowUnit::Length);

    fn at_rest(_x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        targets.copy_from_slice(&nearest_in_plane(x));
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let is_accurate = lanes::flatten(four.simd, x, targets);
        let gap = (targets[0] - targets[1] + targets[2] - targets[3]) * four.splat(0.25);
        for (i, target) in targets.iter_mut().enumerate() {
            *target = if i % 2 == 0 { *target - gap } else { *target + gap };
        }
        is_accurate
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        x.iter().zip(nearest_in_plane(x)).map(|(point, corner)| point.distance(corner)).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_displaced_corner_shares_its_displacement_with_all() {
        // A square with one corner moved by (1, 0) in its plane: each corner takes a quarter.
        let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [5.0, 4.0, 0.0], [0.0, 4.0, 0.0]].map(DVec3::from);
        let stencil = Stencil::centred(&points, &[0, 1, 2, 3]);
        let mut targets = [DVec3::ZERO; 4];
        Parallelogram.project(&[], stencil, &mut targets);
        for (i, target) in targets.into_iter().enumerate() {
            let moved = if i % 2 == 0 { -0.25 } else { 0.25 };
            assert!((target - stencil.at(i) - moved * DVec3::X).length() < 1e-15);
        }
        assert!((Parallelogram.violation(&[], stencil) - 0.25).abs() < 1e-15);
    }
}
