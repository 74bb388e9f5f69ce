//! Least squares with few unknowns, by Householder reflections of rows on the stack.

/// Takes the columns of `rows` to upper triangular form, and the right-hand sides, which are the last entries, along. Returns how
/// many columns from the first on are independent: of each more than `independent` of its length is left beside those before it.
///
/// The leading block of what is left of the rows is the triangle of the leading columns alone: see [`solve`].
pub fn triangularise<const N: usize>(rows: &mut [[f64; N]], independent: f64) -> usize {
    let right = N - 1;
    let mut squares = [0.0; N];
    for row in rows.iter() {
        (0..right).for_each(|k| squares[k] += row[k] * row[k]);
    }
    for k in 0..right {
        let length = rows.iter().skip(k).map(|row| row[k] * row[k]).sum::<f64>().sqrt();
        // As good as false for what is not a number, too.
        if !(length > independent * squares[k].sqrt()) {
            return k;
        }
        // The reflection along v = x + sign(x_k) |x| e_k takes x to −sign(x_k) |x| e_k; ½ v·v = |x| (|x| + |x_k|).
        let head = rows[k][k] + length.copysign(rows[k][k]);
        let half_square = length * head.abs();
        let mut dots = [0.0; N];
        for l in k + 1..N {
            dots[l] = head * rows[k][l];
        }
        for row in rows.iter().skip(k + 1) {
            (k + 1..N).for_each(|l| dots[l] += row[k] * row[l]);
        }
        for l in k + 1..N {
            dots[l] /= half_square;
            rows[k][l] -= head * dots[l];
        }
        for row in rows.iter_mut().skip(k + 1) {
            (k + 1..N).for_each(|l| row[l] -= row[k] * dots[l]);
        }
        rows[k][k] -= head;
    }
    right
}

/// The least squares solution in the first `count` unknowns alone, the others and the last entry being 0, of rows that
/// [`triangularise`] found as many independent columns of.
pub fn solve<const N: usize>(rows: &[[f64; N]], count: usize) -> [f64; N] {
    let mut solution = [0.0; N];
    for k in (0..count).rev() {
        let known: f64 = (k + 1..count).map(|l| rows[k][l] * solution[l]).sum();
        solution[k] = (rows[k][N - 1] - known) / rows[k][k];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<[f64; 4]> {
        let entry = |i: usize, k: usize| (1.3 * i as f64 + 2.1 * k as f64 + 0.7 * (i * k) as f64).sin();
        (0..9).map(|i| [entry(i, 0), entry(i, 1), 1e4 * entry(i, 2), entry(i, 3)]).collect()
    }

    #[test]
    fn residuals_are_orthogonal_to_all_columns_taken() {
        let given = rows();
        let mut rows = given.clone();
        assert_eq!(triangularise(&mut rows, 1e-9), 3);
        for count in 1..=3 {
            let x = solve(&rows, count);
            assert!(x[count..].iter().all(|x| *x == 0.0));
            let residual = |row: &[f64; 4]| row[3] - (0..3).map(|k| row[k] * x[k]).sum::<f64>();
            for k in 0..count {
                let scale = given.iter().map(|row| row[k].abs()).sum::<f64>();
                let dot: f64 = given.iter().map(|row| residual(row) * row[k]).sum();
                assert!(dot.abs() < 1e-13 * scale, "{count} {k} {dot}");
            }
        }
    }

    #[test]
    fn dependent_and_missing_columns_are_counted() {
        let mut dependent = rows();
        dependent.iter_mut().for_each(|row| row[2] = row[0] - 3.0 * row[1]);
        assert_eq!(triangularise(&mut dependent, 1e-9), 2);
        assert_eq!(triangularise(&mut rows()[..2], 1e-9), 2);
        assert_eq!(triangularise::<4>(&mut [], 1e-9), 0);
        assert_eq!(triangularise(&mut [[0.0; 4]; 5], 1e-9), 0);
        assert_eq!(triangularise(&mut [[f64::NAN; 4]; 5], 1e-9), 0);
    }
}
