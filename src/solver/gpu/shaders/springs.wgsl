// A row of `A x` is its sum times `x` of its own, and every other entry times how far that `x` is from its own.
//
// Before this text: `fn taken`, what of an entry of `x` is meant.

// The sums of the page's rows.
@group(0) @binding(5) var<storage, read> row_sums: array<f32>;

fn own_of(row: u32) -> vec3f {
    return taken(x[row]);
}

fn term(value: f32, other: vec4f, own: vec3f) -> vec3f {
    return value * (taken(other) - own);
}

fn whole(sum: vec3f, row: u32, own: vec3f) -> vec3f {
    return sum + row_sums[min(row, page.end - 1u) - page.first] * own;
}
