// The points of constraints. Coordinates are the model's, less the middle of its bounding box, over `size`. A point is the sum of
// two numbers of single precision: where it was at the last upload, and how far it has gone since. Flat arrays are by structure: entry
// `n` of constraint `i` is at `n * count + i`.
//
// Before this text: the uniform `batch` with `count` and `points`, the constraints and the points of each.

@group(0) @binding(1) var<storage, read> base: array<vec4f>;
@group(0) @binding(2) var<storage, read> shift: array<vec4f>;
@group(0) @binding(3) var<storage, read> indices: array<u32>;
@group(0) @binding(4) var<storage, read> numbers: array<f32>;

// Point `j` of the constraint.
fn place(i: u32, j: u32) -> vec3f {
    let index = indices[j * batch.count + i];
    return base[index].xyz + shift[index].xyz;
}

// Point `j` of the constraint, from its point 0: as accurate as the distance is small.
fn at(i: u32, j: u32) -> vec3f {
    let index = indices[j * batch.count + i];
    let first = indices[i];
    return (base[index].xyz - base[first].xyz) + (shift[index].xyz - shift[first].xyz);
}

// The mean of the constraint's points, from its point 0.
fn mean(i: u32) -> vec3f {
    var sum = vec3f(0.0);
    for (var j = 1u; j < batch.points; j++) {
        sum += at(i, j);
    }
    return sum / f32(batch.points);
}

// The coefficient of point `j` in row `r`, in the type's row unit.
fn coefficient(i: u32, r: u32, j: u32) -> f32 {
    return numbers[(r * batch.points + j) * batch.count + i];
}
