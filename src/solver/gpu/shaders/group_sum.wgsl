// Sums over the 64 threads of a workgroup; the same order every time.

var<workgroup> parts: array<vec4f, 64>;

// The sum, for thread 0. To be called by all threads.
fn group_sum(own: vec4f, lane: u32) -> vec4f {
    parts[lane] = own;
    for (var half = 32u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if lane < half {
            parts[lane] += parts[lane + half];
        }
    }
    return parts[0];
}
