// A row of `A x` is the sum of its entries times those of `x`.

fn own_of(row: u32) -> vec3f {
    return vec3f(0.0);
}

fn term(value: f32, other: vec4f, own: vec3f) -> vec3f {
    return value * other.xyz;
}

fn whole(sum: vec3f, row: u32, own: vec3f) -> vec3f {
    return sum;
}
