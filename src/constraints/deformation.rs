//! The deformation gradient of a triangle or tetrahedron, shared by the types that act on it.
//!
//! With the rest edges `R = [r₁ … r_N]` (a triangle's in a frame of its own plane, so that `R` is square) and the current
//! edges `E = [x₁−x₀ … x_N−x₀]`, the gradient is `F = E R⁻¹`: `N` columns in space. Each column is a row of coefficients on
//! the points: `(R⁻¹)_{ij}` on point `i`, and minus their sum on point 0.

use glam::DVec3;

use super::{Constraint, Four, Stencil};
use crate::linalg::lanes::{self, F4, Mask, Svd4, V4};
use crate::linalg::simd::Isa;
use crate::linalg::small::{Svd, svd};

/// A height below this multiple of the longest edge leaves the rest shape flat within round-off: the difference of two
/// f64 coordinates keeps no digit of it.
const FLAT: f64 = 1e-12;

/// The rest shape of a triangle (`N = 2`) or tetrahedron (`N = 3`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestShape<const N: usize> {
    /// `R⁻¹` by rows: row `i` belongs to point `i + 1`. Zero for a degenerate shape, which therefore has zero rows.
    inverse: [[f64; N]; N],
    /// Area or volume in model units; 0 for a degenerate shape.
    measure: f64,
}

impl<const N: usize> RestShape<N> {
    const DEGENERATE: Self = Self { inverse: [[0.0; N]; N], measure: 0.0 };

    /// Area (`N = 2`) or volume (`N = 3`) at rest; 0 for a degenerate shape.
    pub fn measure(&self) -> f64 {
        self.measure
    }

    /// True if the rest shape is flat within round-off.
    pub fn is_degenerate(&self) -> bool {
        self.measure <= 0.0
    }

    /// Writes the `N` rows of coefficients on the `N + 1` points.
    pub fn rows(&self, coefficients: &mut [f64]) {
        for (j, row) in coefficients.chunks_exact_mut(N + 1).enumerate() {
            for i in 0..N {
                row[i + 1] = self.inverse[i][j];
                row[0] -= self.inverse[i][j];
            }
        }
    }

    /// The columns of `F`.
    pub fn gradient(&self, x: Stencil<'_>) -> [DVec3; N] {
        let apex = x.at(0);
        let edges: [DVec3; N] = std::array::from_fn(|i| x.at(i + 1) - apex);
        std::array::from_fn(|j| (0..N).map(|i| self.inverse[i][j] * edges[i]).sum())
    }

    /// The decomposition of `F`.
    pub fn decompose(&self, x: Stencil<'_>) -> Svd<N> {
        svd(self.gradient(x))
    }
}

/// A type that acts on the singular values of a deformation gradient alone. Two of them on the same shapes share the
/// decomposition, which is most of the work.
pub trait Deformation<const N: usize>: Constraint {
    /// The rest shape.
    fn rest_shape(&self) -> &RestShape<N>;

    /// [`Constraint::project_four`] from the gradients and their decompositions.
    fn project_decomposed<S: Isa>(
        four: Four<'_, Self, S>,
        gradient: [V4<S>; N],
        svd: &Svd4<N, S>,
        targets: &mut [V4<S>],
    ) -> Mask<S>;
}

/// [`Constraint::project_four`] of these types.
#[inline(always)]
pub fn project_four<const N: usize, T: Deformation<N>, S: Isa>(
    four: Four<'_, T, S>,
    x: &[V4<S>],
    targets: &mut [V4<S>],
) -> Mask<S> {
    let gradient = gradient_four(&four, x);
    let svd = lanes::svd(four.simd, gradient);
    T::project_decomposed(four, gradient, &svd, targets)
}

/// [`RestShape::gradient`] of four constraints at once.
#[inline(always)]
pub fn gradient_four<const N: usize, T: Deformation<N>, S: Isa>(four: &Four<'_, T, S>, x: &[V4<S>]) -> [V4<S>; N] {
    let mut gradient = [V4::zero(four.simd); N];
    for (j, column) in gradient.iter_mut().enumerate() {
        for i in 0..N {
            let coefficient = four.rest(|constraint| constraint.rest_shape().inverse[i][j]);
            *column = (x[i + 1] - x[0]).mul_add(coefficient, *column);
        }
    }
    gradient
}

/// [`move_product_into`] for four constraints at once.
#[inline(always)]
pub fn move_product_into_four<const N: usize, S: Isa>(s: [F4<S>; N], [min, max]: [F4<S>; 2]) -> [F4<S>; N] {
    let [zero, one] = [0.0, 1.0].map(|value| F4::splat(min.simd(), value));
    let mut d = [zero; N];
    let mut moved = s;
    for _ in 0..LINEARISED_STEPS {
        let product = moved.iter().fold(one, |product, &s| product * s);
        let f = product - product.max(min).min(max);
        let g: [F4<S>; N] =
            std::array::from_fn(|i| (0..N).filter(|&j| j != i).fold(one, |product, j| product * moved[j]));
        let along = (0..N).fold(zero, |sum, i| g[i].mul_add(d[i], sum));
        let squared = g.iter().fold(zero, |sum, &g| g.mul_add(g, sum));
        let factor = squared.where_above(zero, (along - f) / squared, zero);
        for i in 0..N {
            d[i] = factor * g[i];
            moved[i] = s[i] + d[i];
        }
    }
    moved
}

impl RestShape<2> {
    /// The rest shape of a triangle.
    pub fn of_triangle(x: Stencil<'_>) -> Self {
        let [apex, second, third] = x.array();
        let (e, f) = (second - apex, third - apex);
        let longest = e.length().max(f.length()).max((f - e).length());
        let Some(along) = e.try_normalize() else { return Self::DEGENERATE };
        // In the frame (along, across) the edges are (l, 0) and (u, h).
        let (l, u) = (e.length(), f.dot(along));
        let h = (f - u * along).length();
        if !(l > FLAT * longest && h > FLAT * longest) {
            return Self::DEGENERATE;
        }
        Self { inverse: [[1.0 / l, -u / (l * h)], [0.0, 1.0 / h]], measure: 0.5 * l * h }
    }
}

impl RestShape<3> {
    /// The rest shape of a tetrahedron.
    pub fn of_tetrahedron(x: Stencil<'_>) -> Self {
        let [apex, second, third, fourth] = x.array();
        let [e, f, g] = [second - apex, third - apex, fourth - apex];
        let longest = [e, f, g, f - e, g - f, e - g].into_iter().map(DVec3::length).fold(0.0, f64::max);
        // Relative edges keep tiny and huge shapes clear of underflow and overflow.
        let [e, f, g] = [e / longest, f / longest, g / longest];
        let determinant = e.dot(f.cross(g));
        if !(determinant.abs() > FLAT) {
            return Self::DEGENERATE;
        }
        let scale = 1.0 / (determinant * longest);
        let inverse = [f.cross(g), g.cross(e), e.cross(f)].map(|row| (row * scale).to_array());
        Self { inverse, measure: determinant.abs() / 6.0 * longest.powi(3) }
    }
}

/// Puts a decomposition with other singular values together again: the columns of `U diag(s) Vᵀ`.
pub fn recompose<const N: usize>(svd: &Svd<N>, s: [f64; N], columns: &mut [DVec3]) {
    for (j, column) in columns.iter_mut().enumerate() {
        *column = (0..N).map(|i| s[i] * svd.v[i][j] * svd.u[i]).sum();
    }
}

/// −1 if a tetrahedron is turned inside out (`det U · det V < 0`), else 1.
pub fn orientation(svd: &Svd<3>) -> f64 {
    let [a, b, c] = svd.v.map(DVec3::from_array);
    let (u, v) = (svd.u[0].cross(svd.u[1]).dot(svd.u[2]), a.cross(b).dot(c));
    if u * v < 0.0 { -1.0 } else { 1.0 }
}

/// The largest distance of a singular value from `[min, max]`, the smallest one counted negative for an inside-out shape.
pub fn strain_violation<const N: usize>(s: [f64; N], [min, max]: [f64; 2]) -> f64 {
    s.iter().map(|value| (value - value.clamp(min, max)).abs()).fold(0.0, f64::max)
}

/// Steps of the linearisation that parity prescribes for areas and volumes.
const LINEARISED_STEPS: usize = 4;

/// Moves singular values so that their product comes within `[min, max]`, by linearised steps from `s`:
/// `d ← −((f − g·d)/(g·g)) g` with `S = s + d`, `f = ∏S − clamp(∏S)` and `g = ∇∏S`. Returns the values reached.
pub fn move_product_into<const N: usize>(s: [f64; N], [min, max]: [f64; 2]) -> [f64; N] {
    let mut d = [0.0; N];
    let mut moved = s;
    for _ in 0..LINEARISED_STEPS {
        let product: f64 = moved.iter().product();
        let f = product - product.clamp(min, max);
        let g: [f64; N] = std::array::from_fn(|i| (0..N).filter(|&j| j != i).map(|j| moved[j]).product());
        let (along, squared): (f64, f64) = ((0..N).map(|i| g[i] * d[i]).sum(), g.iter().map(|g| g * g).sum());
        // A shape with two vanishing singular values has no direction to grow in: it stays.
        let factor = if squared > 0.0 { -(f - along) / squared } else { 0.0 };
        if !factor.is_finite() {
            return moved;
        }
        for i in 0..N {
            d[i] = factor * g[i];
            moved[i] = s[i] + d[i];
        }
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_rest_the_gradient_is_the_identity() {
        for scale in [1e-9, 1.0, 1e9] {
            let points = [[1.0, 2.0, 3.0], [2.0, 2.5, 3.0], [1.5, 4.0, 2.0], [1.0, 2.0, 5.0]];
            let points = points.map(|point| scale * DVec3::from(point));
            let tetrahedron = Stencil::absolute(&points, &[0, 1, 2, 3]);
            let rest = RestShape::of_tetrahedron(tetrahedron);
            for (column, axis) in rest.gradient(tetrahedron).into_iter().zip([DVec3::X, DVec3::Y, DVec3::Z]) {
                assert!((column - axis).length() < 1e-14);
            }
            // Edges (1, ½, 0), (½, 2, −1), (0, 0, 2): determinant 2 (2 − ¼) = 3.5.
            assert!((rest.measure() / (3.5 / 6.0 * scale.powi(3)) - 1.0).abs() < 1e-14);
            let triangle = Stencil::absolute(&points, &[0, 1, 2]);
            let rest = RestShape::of_triangle(triangle);
            let svd = rest.decompose(triangle);
            assert!(svd.s.iter().all(|s| (s - 1.0).abs() < 1e-14));
            // ½ ‖(1, ½, 0) × (½, 2, −1)‖ = ½ ‖(−½, 1, 1.75)‖.
            assert!((rest.measure() / (0.5 * (0.25_f64 + 1.0 + 3.0625).sqrt() * scale * scale) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn flat_rest_shapes_have_zero_rows() {
        let points = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X, DVec3::Y, DVec3::ZERO];
        for indices in [[0, 1, 2], [0, 4, 3], [0, 0, 0]] {
            assert!(RestShape::of_triangle(Stencil::absolute(&points, &indices)).is_degenerate(), "{indices:?}");
        }
        let rest = RestShape::of_tetrahedron(Stencil::absolute(&points, &[0, 1, 2, 3]));
        assert!(rest.is_degenerate());
        let mut coefficients = [0.0; 12];
        rest.rows(&mut coefficients);
        assert_eq!(coefficients, [0.0; 12]);
        let coincident = RestShape::of_tetrahedron(Stencil::absolute(&points, &[0, 0, 4, 4]));
        assert!(coincident.is_degenerate());
    }

    #[test]
    fn four_linearised_steps_nearly_reach_the_product() {
        let moved = move_product_into([1.5, 1.2], [1.0, 1.0]);
        // The products after the four steps: 1.0846, 1.0007, 0.99991, 0.999993.
        assert!((moved[0] * moved[1] - 1.0).abs() < 1e-5, "{moved:?}");
        assert_eq!(move_product_into([1.1, 0.95], [1.0, 1.1]), [1.1, 0.95]);
        assert_eq!(move_product_into([0.0, 0.0, 0.0], [1.0, 1.0]), [0.0; 3]);
    }
}
