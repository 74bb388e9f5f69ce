// Moves the own points of hard constraints to `x + A⁺ (A x − s)`, where their rows are `2 A x − s`; keeps `A x − s`.

@group(0) @binding(5) var<storage, read> held: array<vec4f>;
@group(0) @binding(6) var<storage, read> own_first: array<u32>;
@group(0) @binding(7) var<storage, read_write> gap: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> own_shift: array<vec4f>;

fn work(i: u32, group: u32, lane: u32) {
    if i >= batch.count {
        return;
    }
    let first = own_first[i];
    if batch.is_dense == 0u {
        let middle = mean(i);
        for (var j = 0u; j < batch.points; j++) {
            let change = (at(i, j) - middle) - held[row_place(i, j)].xyz;
            gap[row_place(i, j)] = vec4f(change, 0.0);
            own_shift[first + j] = vec4f(shift[indices[j * batch.count + i]].xyz + change, 0.0);
        }
        return;
    }
    for (var r = 0u; r < batch.rows; r++) {
        gap[row_place(i, r)] = vec4f(dense_row(i, r) - held[row_place(i, r)].xyz, 0.0);
    }
    for (var j = 0u; j < batch.points; j++) {
        var change = vec3f(0.0);
        for (var r = 0u; r < batch.rows; r++) {
            change += inverse(i, j, r) * gap[row_place(i, r)].xyz;
        }
        own_shift[first + j] = vec4f(shift[indices[j * batch.count + i]].xyz + change, 0.0);
    }
}
