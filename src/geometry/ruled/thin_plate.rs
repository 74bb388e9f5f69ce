//! The thin plate energy of how far strips have moved.
//!
//! Of the strip itself it would be least for no strip at all, and shrink it. So it is taken of `z`, the control points less those
//! at the start. With `S_vv = 0` and `A = Σ N_i″ z_i0`, `B = Σ N_i″ z_i1`,
//!
//! ```text
//! ∫∫ S_uu² + 2 S_uv² du dv = ∫ (A² + A·B + B²) / 3 + 2 (Σ N_i′ (z_i1 − z_i0))² du,
//! ```
//!
//! whose integrand has degree 4 in `u`: Gauss's rule of four points in each span is exact. Parameters are those of the strip, knots
//! at distance 1: what wavers from knot to knot costs the same whatever the number of knots.

use std::collections::BTreeMap;

use super::layout::Layout;
use super::pull::Form;
use super::strip::GAUSS;

/// The form of the mean thin plate energy over all spans of all strips times `plate`, and of the mean of `z²` over all points times
/// `proximal`.
pub(super) fn form(layout: &Layout, plate: f64, proximal: f64) -> Form {
    let mut sums: BTreeMap<(u32, u32), f64> = BTreeMap::new();
    let span_count: usize = (0..layout.strip_count()).map(|strip| layout.basis(strip).spans()).sum();
    let mut square = |points: &[usize; 8], factors: &[f64; 8], weight: f64| {
        for (&i, a) in points.iter().zip(factors) {
            for (&j, b) in points.iter().zip(factors) {
                if j <= i {
                    *sums.entry((i as u32, j as u32)).or_insert(0.0) += weight * a * b;
                }
            }
        }
    };
    for strip in 0..layout.strip_count() {
        for span in 0..layout.basis(strip).spans() {
            for (part, share) in GAUSS {
                let local = layout.basis(strip).at(span as f64 + part);
                let weight = plate * share / span_count as f64;
                let points = std::array::from_fn(|k| layout.point(strip, k / 4, local.functions[k % 4]));
                // (A² + A·B + B²) / 3 = ((A + B)² + (A − B)² / 3) / 4.
                let sign = |k: usize| if k < 4 { -1.0 } else { 1.0 };
                let sum = std::array::from_fn(|k| local.seconds[k % 4]);
                let difference = std::array::from_fn(|k| sign(k) * local.seconds[k % 4]);
                let twist = std::array::from_fn(|k| sign(k) * local.firsts[k % 4]);
                square(&points, &sum, weight / 4.0);
                square(&points, &difference, weight / 12.0);
                square(&points, &twist, 2.0 * weight);
            }
        }
    }
    let share = proximal / layout.point_count() as f64;
    for i in 0..layout.point_count() as u32 {
        *sums.entry((i, i)).or_insert(0.0) += share;
    }
    let entries = sums.into_iter().filter(|(_, k)| *k != 0.0).map(|((i, j), k)| (i, j, k));
    Form { entries: entries.collect() }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geometry::ruled::Strip;
    use crate::geometry::ruled::layout::Joints;
    use crate::mesh::curve::CubicBasis;

    #[test]
    fn the_energy_is_the_integral() {
        for (count, is_closed) in [(4, false), (8, false), (5, true)] {
            let wild = |i: usize, phase: f64| {
                DVec3::new((i as f64 + phase).sin(), (2.3 * i as f64 * phase).cos(), phase * i as f64)
            };
            let control = [0.3, 1.7].map(|phase| (0..count).map(|i| wild(i, phase)).collect());
            let strip = Strip::new(CubicBasis::new(count, is_closed).unwrap(), control).unwrap();
            let (layout, z) = Layout::new(std::slice::from_ref(&strip), &Joints::default()).unwrap();
            let found = form(&layout, 1.0, 0.0).value(&z);
            // The midpoint rule, of second order, extrapolated.
            let midpoint = |n: usize| -> f64 {
                let term = |k: usize| {
                    let (u, v) = ((k % n) as f64 + 0.5, (k / n) as f64 + 0.5);
                    let jet = strip.at(strip.length_u() * u / n as f64, v / n as f64);
                    jet.second[0].length_squared() + 2.0 * jet.second[1].length_squared()
                };
                (0..n * n).map(term).sum::<f64>() / (n * n) as f64
            };
            let n = 50 * layout.basis(0).spans();
            let expected = (4.0 * midpoint(n) - midpoint(n / 2)) / 3.0;
            assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
            let proximal = form(&layout, 0.0, 3.0).value(&z);
            let mean = z.iter().map(|z| z.length_squared()).sum::<f64>() / z.len() as f64;
            assert!((proximal / (3.0 * mean) - 1.0).abs() < 1e-14);
        }
    }
}
