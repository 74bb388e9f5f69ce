// What every projection starts from. One thread projects one constraint; the type's file has `fn project(i: u32)`, which
// calls `put` once for each row of constraint `i`.

struct Batch {
    // Constraints, points of each, rows of each; numbers of each that are coefficients of its rows, and come first.
    count: u32,
    points: u32,
    rows: u32,
    coefficients: u32,
    // Where the results of the batch begin.
    first: u32,
    // 0: the pull on each point, `s Aᵀ e`, is wanted; else the residual `e` of each row.
    wants_rows: u32,
}

@group(0) @binding(0) var<uniform> batch: Batch;
@group(0) @binding(5) var<storage, read> stiffness: array<f32>;
@group(0) @binding(6) var<storage, read_write> results: array<vec4f>;

// Number `n` of what the type's `kernel_numbers` gave.
fn number(i: u32, n: u32) -> f32 {
    return numbers[(batch.coefficients + n) * batch.count + i];
}

// Row `r` of `A x`, for rows that take equal points to 0.
fn row(i: u32, r: u32) -> vec3f {
    var sum = vec3f(0.0);
    for (var j = 1u; j < batch.points; j++) {
        sum += coefficient(i, r, j) * at(i, j);
    }
    return sum;
}

fn write(i: u32, n: u32, value: vec4f) {
    results[batch.first + n * batch.count + i] = value;
}

// For centred types, once for each point: its target is `residual` from where it is. `mean` is the mean of all residuals
// where that can be other than 0.
fn put_centred(i: u32, j: u32, residual: vec3f, mean: vec3f) {
    let s = stiffness[i];
    let energy = 0.5 * s * dot(residual, residual);
    let factor = select(s, 1.0, batch.wants_rows != 0u);
    write(i, j, vec4f(factor * (residual - mean), energy));
}

// For linear types, once: the residuals of all rows.
fn put_linear(i: u32, residuals: array<vec3f, 4>) {
    var all = residuals;
    let s = stiffness[i];
    if batch.wants_rows != 0u {
        for (var r = 0u; r < batch.rows; r++) {
            write(i, r, vec4f(all[r], 0.5 * s * dot(all[r], all[r])));
        }
        return;
    }
    var energy = 0.0;
    for (var r = 0u; r < batch.rows; r++) {
        energy += 0.5 * s * dot(all[r], all[r]);
    }
    for (var j = 0u; j < batch.points; j++) {
        var sum = vec3f(0.0);
        for (var r = 0u; r < batch.rows; r++) {
            sum += coefficient(i, r, j) * all[r];
        }
        write(i, j, vec4f(s * sum, select(0.0, energy, j == 0u)));
    }
}

// For types whose rows are pairs, once for each row `x_{2r+1} − x_{2r}`.
fn put_pair(i: u32, r: u32, residual: vec3f) {
    let s = stiffness[i];
    let energy = 0.5 * s * dot(residual, residual);
    if batch.wants_rows != 0u {
        write(i, r, vec4f(residual, energy));
    } else {
        write(i, 2u * r, vec4f(-s * residual, energy));
        write(i, 2u * r + 1u, vec4f(s * residual, 0.0));
    }
}

fn work(i: u32, group: u32, lane: u32) {
    if i < batch.count {
        project(i);
    }
}
