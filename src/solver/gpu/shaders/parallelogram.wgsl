// Parallelogram: onto the best-fit plane, then onto the nearest parallelogram in it. See constraints/parallelogram.rs.

fn project(i: u32) {
    let vectors = four_points(i);
    let least = orthogonalised(vectors).v[2];
    var residual = outer(-(vectors * least), least);
    // Twice the gap `¼ (x₀ − x₁ + x₂ − x₃)`: all of it goes.
    residual[1] = -vectors[1];
    put_four(i, residual);
}
