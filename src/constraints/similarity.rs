//! Similarity: points similar to the nearest of some template shapes.
//!
//! Set: every template, moved, turned and scaled, in any cyclic or mirrored order of its vertices. Rows: centred. Projection:
//! the best of all candidates, see `shape_fit`; nearest. Where two candidates tie, the first is taken. Scalars: `3 k m`
//! coordinates of `m` templates of `k` points, `x₀ y₀ z₀ x₁ …`, in any unit; by default one, the points at creation. Violation:
//! the largest distance of a point from its projection, in model units. Degenerate where all templates are single points:
//! it then draws its points together. Source: Bouaziz et al. 2012, section 3.2.

use glam::DVec3;

use super::shape_fit::{self, Scale};
use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;

/// One Similarity constraint. Its templates are its scalars; it keeps what is known of them.
#[derive(Clone, Debug)]
pub struct Similarity {
    point_count: usize,
    /// The circumradius, if the template is one regular polygon; else 0.
    polygon_radius: f64,
}

impl Constraint for Similarity {
    const INFO: TypeInfo = TypeInfo {
        name: "Similarity",
        help: "keeps points similar to the nearest of some shapes, by default the one at creation",
        least_indices: 1,
        greatest_indices: None,
        index_names: &["point"],
        scalars: Scalars::Shapes,
        rows: Rows::Centred,
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: Some("Rigid"),
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(
            include_str!("../solver/gpu/shaders/polygon.wgsl"),
            include_str!("../solver/gpu/shaders/shape_fit.wgsl"),
            include_str!("../solver/gpu/shaders/similarity.wgsl")
        ),
        RowUnit::Length,
    );

    fn kernel_numbers(&self, scalars: &[f64], size: f64, numbers: &mut Vec<f64>) {
        let known = (self.point_count, self.polygon_radius);
        shape_fit::kernel_numbers(scalars, known, Scale::Free, size, numbers);
    }

    fn at_rest(x: Stencil<'_>, scalars: &mut Vec<f64>) -> Self {
        scalars.extend(x.iter().flat_map(|point| point.to_array()));
        let mut new = Self { point_count: x.len(), polygon_radius: 0.0 };
        new.scalars_changed(&scalars[scalars.len() - 3 * x.len()..]);
        new
    }

    fn scalars_changed(&mut self, scalars: &[f64]) {
        self.polygon_radius = shape_fit::polygon_radius(scalars, self.point_count);
    }

    fn takes_four(k: usize) -> bool {
        k >= 3
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let radius = four.rest(|shape| shape.polygon_radius);
        let is_accurate = shape_fit::project_regular_four(four.simd, x, None, targets);
        is_accurate & radius.above(four.splat(0.0))
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        shape_fit::project(scalars, x, Scale::Free, |j, target| targets[j] = target);
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        shape_fit::violation(scalars, x, Scale::Free)
    }

    fn is_degenerate(&self, scalars: &[f64]) -> bool {
        shape_fit::is_degenerate(scalars, self.point_count)
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;

    const SQUARE: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];

    #[test]
    fn a_rectangle_becomes_the_square_of_its_mean_side() {
        // Σ x·q over the corners of ±a/2, ±b/2 against ±½, ±½ is a + b, and Σ‖q‖² = 2: the scale is (a + b)/2.
        let points = [[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from);
        let stencil = Stencil::centred(&points, &[0, 1, 2, 3]);
        let mut targets = [DVec3::ZERO; 4];
        let similarity = Similarity::at_rest(stencil, &mut Vec::new());
        similarity.project(&SQUARE, stencil, &mut targets);
        for (target, expected) in targets.into_iter().zip([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) {
            assert!((target - DVec3::new(expected[0], expected[1], 0.0)).length() < 1e-14);
        }
        // The corner at (1.5, 0.5) moves to (1, 1).
        assert!((similarity.violation(&SQUARE, stencil) - 0.5_f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn a_shape_matches_itself_in_every_order_however_it_lies() {
        let shape =
            [[0.0, 0.0, 0.1], [2.0, 0.0, 0.0], [3.0, 1.5, 0.3], [1.0, 2.0, 0.0], [-0.5, 1.0, 0.0]].map(DVec3::from);
        let mut scalars = Vec::new();
        let similarity = Similarity::at_rest(Stencil::centred(&shape, &[0, 1, 2, 3, 4]), &mut scalars);
        let turn = DQuat::from_scaled_axis(DVec3::new(1.0, -2.0, 0.5));
        let moved = shape.map(|point| 7.0 * (turn * point) + 100.0);
        for order in [[0, 1, 2, 3, 4], [2, 3, 4, 0, 1], [4, 3, 2, 1, 0], [1, 0, 4, 3, 2]] {
            assert!(similarity.violation(&scalars, Stencil::centred(&moved, &order)) < 1e-12, "{order:?}");
        }
        let wrong = [0, 2, 1, 3, 4];
        assert!(similarity.violation(&scalars, Stencil::centred(&moved, &wrong)) > 1.0);
    }
}
