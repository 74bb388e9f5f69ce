// Pairs of vectors that many threads add up.

@group(0) @binding(0) var<uniform> pair_count: u32;
@group(0) @binding(1) var<storage, read> pairs: array<vec4f>;

// The sum of the pairs `stride` apart, from `begin` on.
fn sum_of(begin: u32, stride: u32) -> Pair {
    var sum = Pair(vec3f(0.0), vec3f(0.0));
    for (var at = begin; at < pair_count; at += stride) {
        sum.first += pairs[2u * at].xyz;
        sum.second += pairs[2u * at + 1u].xyz;
    }
    return sum;
}
