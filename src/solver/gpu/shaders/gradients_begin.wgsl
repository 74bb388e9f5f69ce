// Before the first step: x = 0, r from the caller's right-hand side, and no progress.

@group(0) @binding(0) var<storage, read> scales: array<vec2f>;
@group(0) @binding(1) var<storage, read_write> r: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> x: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> progress: array<vec4f, 2>;

fn work(i: u32, group: u32, lane: u32) {
    if i < arrayLength(&x) {
        let scale = scales[i];
        x[i] = vec4f(0.0);
        // The fourth number is the inverse of the diagonal, which smoothing asks for.
        r[i] = vec4f(scale.x * r[i].xyz, scale.y);
    }
    if i == 0u {
        progress[0] = vec4f(0.0);
        progress[1] = vec4f(0.0);
    }
}
