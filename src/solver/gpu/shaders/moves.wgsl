// The largest squared move of each workgroup's points.

@group(0) @binding(4) var<storage, read_write> moves: array<f32>;

var<workgroup> largest: array<f32, 64>;

// To be called by all threads of a workgroup, by those without a point with 0.
fn tell_move(change: vec3f, group: u32, lane: u32) {
    largest[lane] = dot(change, change);
    for (var half = 32u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if lane < half {
            largest[lane] = max(largest[lane], largest[lane + half]);
        }
    }
    if lane == 0u && group < arrayLength(&moves) {
        moves[group] = largest[0];
    }
}
