// The rows `A x` of hard constraints at the points.

// Entry of the pseudo-inverse: point `j`, row `r`.
fn inverse(i: u32, j: u32, r: u32) -> f32 {
    return numbers[(batch.rows * batch.points + j * batch.rows + r) * batch.count + i];
}

// Row `r` of a constraint with coefficients.
fn dense_row(i: u32, r: u32) -> vec3f {
    var sum = vec3f(0.0);
    var total = coefficient(i, r, 0u);
    for (var j = 1u; j < batch.points; j++) {
        let a = coefficient(i, r, j);
        sum += a * at(i, j);
        total += a;
    }
    return sum + total * place(i, 0u);
}
