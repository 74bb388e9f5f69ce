// The rows `A x` of hard constraints at the points.

@group(0) @binding(1) var<storage, read> base: array<vec4f>;
@group(0) @binding(2) var<storage, read> shift: array<vec4f>;
@group(0) @binding(3) var<storage, read> indices: array<u32>;
@group(0) @binding(4) var<storage, read> numbers: array<f32>;

fn at(i: u32, j: u32) -> vec3f {
    let index = indices[j * batch.count + i];
    let first = indices[i];
    return (base[index].xyz - base[first].xyz) + (shift[index].xyz - shift[first].xyz);
}

fn mean(i: u32) -> vec3f {
    var sum = vec3f(0.0);
    for (var j = 1u; j < batch.points; j++) {
        sum += at(i, j);
    }
    return sum / f32(batch.points);
}

fn coefficient(i: u32, r: u32, j: u32) -> f32 {
    return numbers[(r * batch.points + j) * batch.count + i];
}

// Entry of the pseudo-inverse: point `j`, row `r`.
fn inverse(i: u32, j: u32, r: u32) -> f32 {
    return numbers[(batch.rows * batch.points + j * batch.rows + r) * batch.count + i];
}

// Row `r` of a constraint with coefficients.
fn dense_row(i: u32, r: u32) -> vec3f {
    let first = indices[i];
    var sum = vec3f(0.0);
    var total = coefficient(i, r, 0u);
    for (var j = 1u; j < batch.points; j++) {
        let a = coefficient(i, r, j);
        sum += a * at(i, j);
        total += a;
    }
    return sum + total * (base[first].xyz + shift[first].xyz);
}
