// direction ← keep direction + a u + b v, of two vectors behind each other.

struct Factors {
    count: u32,
    // Where `u` and `v` begin in `vectors`.
    first: u32,
    second: u32,
    keep: f32,
    a: f32,
    b: f32,
}

@group(0) @binding(0) var<uniform> factors: Factors;
@group(0) @binding(1) var<storage, read> vectors: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> direction: array<vec4f>;

fn work(i: u32, group: u32, lane: u32) {
    if i < factors.count {
        let fresh = factors.a * vectors[factors.first + i] + factors.b * vectors[factors.second + i];
        // What was there before may be anything where it is not kept.
        direction[i] = select(fresh, factors.keep * direction[i] + fresh, factors.keep != 0.0);
    }
}
