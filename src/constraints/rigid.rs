//! Rigid: points congruent to the nearest of some template shapes.
//!
//! Set: every template, moved and turned, in any cyclic or mirrored order of its vertices. Rows: centred. Projection: the best
//! of all candidates, see `shape_fit`; nearest. Where two candidates tie, the first is taken. Scalars: `3 k m` coordinates of `m`
//! templates of `k` points, `x₀ y₀ z₀ x₁ …`, in model units; by default one, the points at creation. Violation: the largest
//! distance of a point from its projection, in model units. Degenerate where all templates are single points: it then
//! draws its points together. Source: Bouaziz et al. 2012, section 3.2.

use glam::DVec3;

use super::shape_fit::{self, Scale};
use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;

/// One Rigid constraint. Its templates are its scalars; it keeps what is known of them.
#[derive(Clone, Debug)]
pub struct Rigid {
    point_count: usize,
    /// The circumradius, if the template is one regular polygon; else 0.
    polygon_radius: f64,
}

impl Constraint for Rigid {
    const INFO: TypeInfo = TypeInfo {
        name: "Rigid",
        help: "keeps points congruent to the nearest of some shapes, by default the one at creation",
        least_indices: 1,
        greatest_indices: None,
        index_names: &["point"],
        scalars: Scalars::Shapes,
        rows: Rows::Centred,
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: Some("Similarity"),
    };

    const KERNEL: Kernel = Kernel::Wgsl(
        concat!(
            include_str!("../solver/gpu/shaders/polygon.wgsl"),
            include_str!("../solver/gpu/shaders/shape_fit.wgsl"),
            include_str!("../solver/gpu/shaders/rigid.wgsl")
        ),
        RowUnit::Length,
    );

    fn kernel_numbers(&self, scalars: &[f64], size: f64, numbers: &mut Vec<f64>) {
        let known = (self.point_count, self.polygon_radius);
        shape_fit::kernel_numbers(scalars, known, Scale::Fixed, size, numbers);
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
        let is_accurate = shape_fit::project_regular_four(four.simd, x, Some(radius), targets);
        is_accurate & radius.above(four.splat(0.0))
    }

    fn project(&self, scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        shape_fit::project(scalars, x, Scale::Fixed, |j, target| targets[j] = target);
    }

    fn violation(&self, scalars: &[f64], x: Stencil<'_>) -> f64 {
        shape_fit::violation(scalars, x, Scale::Fixed)
    }

    fn is_degenerate(&self, scalars: &[f64]) -> bool {
        shape_fit::is_degenerate(scalars, self.point_count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretched_edge_returns_to_its_length() {
        let rest = [DVec3::ZERO, 2.0 * DVec3::X];
        let mut scalars = Vec::new();
        let rigid = Rigid::at_rest(Stencil::centred(&rest, &[0, 1]), &mut scalars);
        let pulled = [DVec3::ZERO, 5.0 * DVec3::Z];
        let stencil = Stencil::centred(&pulled, &[0, 1]);
        let mut targets = [DVec3::ZERO; 2];
        rigid.project(&scalars, stencil, &mut targets);
        assert!((targets[0] + DVec3::Z).length() < 1e-15 && (targets[1] - DVec3::Z).length() < 1e-15);
        assert!((rigid.violation(&scalars, stencil) - 1.5).abs() < 1e-15);
    }

    #[test]
    fn the_nearer_of_two_templates_is_taken() {
        let points = [[0.0, 0.0, 0.0], [2.1, 0.0, 0.0], [0.0, 1.9, 0.0]].map(DVec3::from);
        let small = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let large = small.map(|coordinate| 2.0 * coordinate);
        let stencil = Stencil::centred(&points, &[0, 1, 2]);
        let rigid = Rigid::at_rest(stencil, &mut Vec::new());
        let both = [small, large].concat();
        assert!(rigid.violation(&both, stencil) < 0.2);
        assert_eq!(rigid.violation(&both, stencil), rigid.violation(&large, stencil));
    }
}
