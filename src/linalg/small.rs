//! Dense decompositions in three dimensions.
//!
//! Cyclic Jacobi throughout: a handful of sweeps, no square roots of differences, and small eigenvalues and singular
//! values keep their relative accuracy, which closed forms by the characteristic polynomial lose (Golub & Van Loan,
//! "Matrix Computations", sections 8.5 and 8.6.3).

use glam::{DMat3, DVec3};

/// Sweeps after which Jacobi iterations stop whatever is left. Convergence is quadratic: in practice five or six suffice.
const MAX_SWEEPS: usize = 30;

/// Two columns count as orthogonal when their inner product is below this multiple of their norms' product: a few units
/// in the last place of an f64.
const ORTHOGONAL: f64 = 4.0 * f64::EPSILON;

/// `Σ x xᵀ`.
pub fn scatter(points: impl Iterator<Item = DVec3>) -> DMat3 {
    points.map(|x| DMat3::from_cols(x * x.x, x * x.y, x * x.z)).fold(DMat3::ZERO, |sum, outer| sum + outer)
}

/// The cosine and sine of the Jacobi rotation that annuls the off-diagonal entry of `[[a, b], [b, d]]`.
fn jacobi_rotation(a: f64, b: f64, d: f64) -> (f64, f64) {
    if b == 0.0 {
        return (1.0, 0.0);
    }
    // The smaller root of t² + 2τt − 1 = 0, written without cancellation.
    // Where τ² overflows, t is 0 as it should be.
    let tau = (d - a) / (2.0 * b);
    let t = tau.signum() / (tau.abs() + (tau * tau + 1.0).sqrt());
    let cosine = 1.0 / (t * t + 1.0).sqrt();
    (cosine, t * cosine)
}

/// Eigenvalues in ascending order, and unit eigenvectors that form a right-handed frame, of the symmetric matrix `a`.
pub fn symmetric_eigen(a: DMat3) -> ([f64; 3], [DVec3; 3]) {
    let mut a = a.to_cols_array_2d();
    let scale = a.iter().flatten().fold(0.0_f64, |most, entry| most.max(entry.abs()));
    let mut vectors = [DVec3::X, DVec3::Y, DVec3::Z];
    if scale > 0.0 {
        for entry in a.iter_mut().flatten() {
            *entry /= scale;
        }
        for _ in 0..MAX_SWEEPS {
            let off = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
            if off <= f64::MIN_POSITIVE {
                break;
            }
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                // Once it is below the round-off of both diagonal entries, an entry is annulled by decree.
                if a[p][q].abs() <= f64::EPSILON * 0.01 * a[p][p].abs().min(a[q][q].abs()) {
                    a[p][q] = 0.0;
                    a[q][p] = 0.0;
                    continue;
                }
                let (c, s) = jacobi_rotation(a[p][p], a[p][q], a[q][q]);
                let t_times_off = if c == 0.0 { 0.0 } else { s / c * a[p][q] };
                a[p][p] -= t_times_off;
                a[q][q] += t_times_off;
                a[p][q] = 0.0;
                a[q][p] = 0.0;
                let r = 3 - p - q;
                let (x, y) = (a[r][p], a[r][q]);
                a[r][p] = c * x - s * y;
                a[r][q] = s * x + c * y;
                a[p][r] = a[r][p];
                a[q][r] = a[r][q];
                let (v, w) = (vectors[p], vectors[q]);
                vectors[p] = c * v - s * w;
                vectors[q] = s * v + c * w;
            }
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| a[i][i].total_cmp(&a[j][j]));
    let [first, second, third] = order.map(|i| vectors[i].normalize());
    let third = if first.cross(second).dot(third) < 0.0 { -third } else { third };
    (order.map(|i| a[i][i] * scale), [first, second, third])
}

/// A unit eigenvector of the least eigenvalue of the symmetric matrix `a`.
pub fn least_eigenvector(a: DMat3) -> DVec3 {
    symmetric_eigen(a).1[0]
}

/// A singular value decomposition `A = Σ_i s[i] u[i] v[i]ᵀ` of a matrix with `N` columns, `N` being 1 to 3.
#[derive(Clone, Copy, Debug)]
pub struct Svd<const N: usize> {
    /// Orthonormal, also where singular values vanish.
    pub u: [DVec3; N],
    /// In descending order, none below 0.
    pub s: [f64; N],
    /// Orthonormal.
    pub v: [[f64; N]; N],
}

/// Decomposes the matrix with the given columns by one-sided Jacobi rotations (Hestenes).
pub fn svd<const N: usize>(columns: [DVec3; N]) -> Svd<N> {
    let scale = columns.iter().fold(0.0_f64, |most, column| most.max(column.abs().max_element()));
    let mut a = columns.map(|column| if scale > 0.0 { column / scale } else { column });
    // v[i] is the i-th column of V.
    let mut v: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    for _ in 0..MAX_SWEEPS {
        let mut is_orthogonal = true;
        for p in 0..N {
            for q in p + 1..N {
                let (alpha, beta, gamma) = (a[p].length_squared(), a[q].length_squared(), a[p].dot(a[q]));
                if gamma.abs() <= ORTHOGONAL * (alpha * beta).sqrt() {
                    continue;
                }
                is_orthogonal = false;
                let (c, s) = jacobi_rotation(alpha, gamma, beta);
                (a[p], a[q]) = (c * a[p] - s * a[q], s * a[p] + c * a[q]);
                for i in 0..N {
                    (v[p][i], v[q][i]) = (c * v[p][i] - s * v[q][i], s * v[p][i] + c * v[q][i]);
                }
            }
        }
        if is_orthogonal {
            break;
        }
    }
    let mut order: [usize; N] = std::array::from_fn(|i| i);
    order.sort_by(|&i, &j| a[j].length_squared().total_cmp(&a[i].length_squared()));
    let mut u = [DVec3::ZERO; N];
    for (i, &column) in order.iter().enumerate() {
        u[i] = unit_beside(a[column], &u[..i]);
    }
    Svd { u, s: order.map(|i| a[i].length() * scale), v: order.map(|i| v[i]) }
}

/// `a` normalised after taking out what it shares with the orthonormal `others`; any such vector if nothing is left.
fn unit_beside(a: DVec3, others: &[DVec3]) -> DVec3 {
    let without = |a: DVec3| others.iter().fold(a, |a, &other| a - a.dot(other) * other);
    let own = without(a);
    // A column that is round-off of the larger ones says nothing of a direction.
    if own.length() > f64::EPSILON && own.length() > 0.5 * a.length() {
        return own.normalize();
    }
    let axis = [DVec3::X, DVec3::Y, DVec3::Z];
    let best = axis.into_iter().max_by(|&a, &b| without(a).length_squared().total_cmp(&without(b).length_squared()));
    without(best.unwrap_or(DVec3::X)).normalize()
}

/// The proper rotation `R` that maximises `tr(Rᵀ M)`: the one nearest to `M`. With `M = Σ y xᵀ` it turns the points `x`
/// as near as possible to the points `y`. The second result is that maximum.
///
/// Source: Umeyama 1991, "Least-squares estimation of transformation parameters between two point patterns".
pub fn nearest_rotation(m: DMat3) -> (DMat3, f64) {
    let svd = svd([m.x_axis, m.y_axis, m.z_axis]);
    let v = svd.v.map(DVec3::from_array);
    let sign = (svd.u[0].cross(svd.u[1]).dot(svd.u[2]) * v[0].cross(v[1]).dot(v[2])).signum();
    let outer = |u: DVec3, v: DVec3| DMat3::from_cols(u * v.x, u * v.y, u * v.z);
    let rotation = outer(svd.u[0], v[0]) + outer(svd.u[1], v[1]) + outer(sign * svd.u[2], v[2]);
    (rotation, svd.s[0] + svd.s[1] + sign * svd.s[2])
}

/// A unit vector orthogonal to the unit vector `direction`.
pub fn any_orthogonal(direction: DVec3) -> DVec3 {
    direction.any_orthonormal_vector()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn vector() -> impl Strategy<Value = DVec3> {
        prop::array::uniform3(-10.0..10.0_f64).prop_map(DVec3::from_array)
    }

    proptest! {
        #[test]
        fn eigenvectors_reproduce_the_matrix(a in vector(), b in vector(), c in vector(), scale in -9..9_i32) {
            let matrix = scatter([a, b, c].into_iter()) * 10_f64.powi(scale);
            let (values, vectors) = symmetric_eigen(matrix);
            prop_assert!(values[0] <= values[1] && values[1] <= values[2]);
            for (value, vector) in values.into_iter().zip(vectors) {
                let error = (matrix * vector - value * vector).length();
                prop_assert!(error <= 1e-14 * values[2], "residual {error}");
            }
            let frame = DMat3::from_cols(vectors[0], vectors[1], vectors[2]);
            prop_assert!((frame.determinant() - 1.0).abs() < 1e-14);
        }

        #[test]
        fn singular_vectors_reproduce_the_matrix(a in vector(), b in vector(), c in vector(), rank in 0..4_usize) {
            let columns = match rank { 0 => [DVec3::ZERO; 3], 1 => [a, 2.0 * a, -a], 2 => [a, b, a + b], _ => [a, b, c] };
            let svd = svd(columns);
            for j in 0..3 {
                let column: DVec3 = (0..3).map(|i| svd.s[i] * svd.v[i][j] * svd.u[i]).sum();
                prop_assert!((column - columns[j]).length() <= 1e-14 * (1.0 + svd.s[0]));
            }
            let frame = DMat3::from_cols(svd.u[0], svd.u[1], svd.u[2]);
            prop_assert!((frame.transpose() * frame - DMat3::IDENTITY).abs().to_cols_array().iter().all(|e| *e < 1e-14));
        }

        #[test]
        fn no_rotation_fits_better_than_the_nearest(m in prop::array::uniform3(vector()), q in prop::array::uniform4(-1.0..1.0_f64)) {
            let m = DMat3::from_cols(m[0], m[1], m[2]);
            let (rotation, trace) = nearest_rotation(m);
            prop_assert!((rotation.determinant() - 1.0).abs() < 1e-13);
            let trace_of = |r: DMat3| (r.transpose() * m).to_cols_array_2d().iter().enumerate().map(|(i, c)| c[i]).sum::<f64>();
            prop_assert!((trace_of(rotation) - trace).abs() < 1e-12 * (1.0 + trace.abs()));
            let quaternion = glam::DQuat::from_array(q);
            prop_assume!(quaternion.length() > 0.1);
            let other = DMat3::from_quat(quaternion.normalize());
            prop_assert!(trace_of(other) <= trace + 1e-12 * (1.0 + trace.abs()));
        }
    }
}
