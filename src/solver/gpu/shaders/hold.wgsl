// What the penalty pulls each point of hard constraints with: `μ Aᵀ (s − A x)`.

@group(0) @binding(5) var<storage, read> stiffness: array<f32>;
@group(0) @binding(6) var<storage, read> held: array<vec4f>;
// `s − A x`, for this kernel alone.
@group(0) @binding(7) var<storage, read_write> gap: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> pulls: array<vec4f>;

fn work(i: u32, group: u32, lane: u32) {
    if i >= batch.count {
        return;
    }
    let s = stiffness[i];
    if batch.is_dense == 0u {
        let middle = mean(i);
        for (var j = 0u; j < batch.points; j++) {
            let residual = held[row_place(i, j)].xyz - (at(i, j) - middle);
            pulls[batch.first_pull + j * batch.count + i] = vec4f(s * residual, 0.0);
        }
        return;
    }
    for (var r = 0u; r < batch.rows; r++) {
        gap[row_place(i, r)] = vec4f(held[row_place(i, r)].xyz - dense_row(i, r), 0.0);
    }
    for (var j = 0u; j < batch.points; j++) {
        var sum = vec3f(0.0);
        for (var r = 0u; r < batch.rows; r++) {
            sum += coefficient(i, r, j) * gap[row_place(i, r)].xyz;
        }
        pulls[batch.first_pull + j * batch.count + i] = vec4f(s * sum, 0.0);
    }
}
