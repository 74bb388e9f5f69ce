//! EqualLengths: edges, given by their ends one after the other, that have one length in common.
//!
//! Set: edges `e_i = x_{2i+1} − x_{2i}` with `‖e_i‖ = L` for some `L`. Rows: the edges. Projection: for a given `L` the
//! nearest is `L e_i/‖e_i‖`, at a cost of `Σ (‖e_i‖ − L)²`, which is least where `L` is the mean of the lengths;
//! nearest. An edge of no length has no direction: it is given +x. Edges may share points. Violation: the largest
//! deviation of a length from the mean, in model units. Nothing can degenerate: all lengths may be 0. Source:
//! elementary.

use glam::DVec3;

use super::{Constraint, Four, Kernel, Projection, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::lanes::{Mask, V4};
use crate::linalg::simd::Isa;

/// One EqualLengths constraint; it has no rest state.
#[derive(Clone, Debug)]
pub struct EqualLengths;

fn edges(x: Stencil<'_>) -> impl Iterator<Item = DVec3> {
    (0..x.len() / 2).map(move |i| x.at(2 * i + 1) - x.at(2 * i))
}

fn mean_length(x: Stencil<'_>) -> f64 {
    edges(x).map(DVec3::length).sum::<f64>() / (x.len() / 2) as f64
}

impl Constraint for EqualLengths {
    const INFO: TypeInfo = TypeInfo {
        name: "EqualLengths",
        help: "keeps edges, given by pairs of points, as long as each other",
        least_indices: 4,
        greatest_indices: None,
        index_names: &["edge start", "edge end"],
        scalars: Scalars::None,
        rows: Rows::Pairs,
        projection: Projection::Nearest,
        violation_unit: "model units",
        energy_scale_power: 2,
        edited_as: None,
    };

    const KERNEL: Kernel = Kernel::Wgsl(include_str!("../solver/gpu/shaders/equal_lengths.wgsl"), RowUnit::Length);

    fn at_rest(_x: Stencil<'_>, _scalars: &mut Vec<f64>) -> Self {
        Self
    }

    fn project(&self, _scalars: &[f64], x: Stencil<'_>, targets: &mut [DVec3]) {
        let mean = mean_length(x);
        for (target, edge) in targets.iter_mut().zip(edges(x)) {
            *target = mean * edge.try_normalize().unwrap_or(DVec3::X);
        }
    }

    fn takes_four(_k: usize) -> bool {
        true
    }

    #[inline(always)]
    fn project_four<S: Isa>(four: Four<'_, Self, S>, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
        let (mut least, mut sum) = (four.splat(f64::MAX), four.splat(0.0));
        for (target, pair) in targets.iter_mut().zip(x.chunks_exact(2)) {
            *target = pair[1] - pair[0];
            let squared = target.dot(*target);
            (least, sum) = (least.min(squared), sum + squared.sqrt());
        }
        let mean = sum * four.splat(1.0 / targets.len() as f64);
        for target in targets.iter_mut() {
            *target = *target * (mean / target.dot(*target).sqrt());
        }
        // Not edges without a length, nor numbers too small to keep all digits, nor infinite ones.
        least.above(four.splat(f64::MIN_POSITIVE)) & four.splat(f64::MAX).above(sum)
    }

    fn violation(&self, _scalars: &[f64], x: Stencil<'_>) -> f64 {
        let mean = mean_length(x);
        edges(x).map(|edge| (edge.length() - mean).abs()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_take_the_mean_of_their_lengths() {
        // Lengths 1, 2 and 6: all become 3, the last one is off by 3.
        let points = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::ONE + 2.0 * DVec3::Y, DVec3::Z, 7.0 * DVec3::Z];
        let stencil = Stencil::absolute(&points, &[0, 1, 2, 3, 4, 5]);
        let mut targets = [DVec3::ZERO; 3];
        EqualLengths.project(&[], stencil, &mut targets);
        assert_eq!(targets, [3.0 * DVec3::X, 3.0 * DVec3::Y, 3.0 * DVec3::Z]);
        assert_eq!(EqualLengths.violation(&[], stencil), 3.0);
    }

    #[test]
    fn half_an_edge_is_refused() {
        let error = EqualLengths::INFO.check_index_count(5).unwrap_err();
        assert!(error.to_string().contains("an even number of at least 4"), "{error}");
        assert!(EqualLengths::INFO.check_index_count(2).is_err() && EqualLengths::INFO.check_index_count(6).is_ok());
    }
}
