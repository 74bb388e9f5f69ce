// A step: p = z + keep p, q = Az + keep q, x += step p, r -= step q, with a step for each coordinate. x is in the caller's
// unknowns, which are `scale` times ours.

struct State {
    step: vec4f,
    keep: vec4f,
    product: vec4f,
}

@group(0) @binding(0) var<storage, read> state: State;
@group(0) @binding(1) var<storage, read> scales: array<vec2f>;
@group(0) @binding(2) var<storage, read> z: array<vec4f>;
@group(0) @binding(3) var<storage, read> image_of_z: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> p: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> q: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> x: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> r: array<vec4f>;

// a + factor b. What b is does not matter where the factor is 0.
fn plus(a: vec3f, factor: vec3f, b: vec3f) -> vec3f {
    return select(a + factor * b, a, factor == vec3f(0.0));
}

fn work(i: u32, group: u32, lane: u32) {
    if i >= arrayLength(&x) {
        return;
    }
    let step = state.step.xyz;
    let keep = state.keep.xyz;
    let own_p = plus(z[i].xyz, keep, p[i].xyz);
    let own_q = plus(image_of_z[i].xyz, keep, q[i].xyz);
    let own_r = r[i];
    p[i] = vec4f(own_p, 0.0);
    q[i] = vec4f(own_q, 0.0);
    x[i] = vec4f(plus(x[i].xyz, step, scales[i].x * own_p), 0.0);
    r[i] = vec4f(plus(own_r.xyz, -step, own_q), own_r.w);
}
