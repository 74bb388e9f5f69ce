// The step of the rows, from what their projection is away, `e = P(w) − w` with `w = 2 A x − s`:
// `s ← s + α (A x − s + min(1, reach/‖e‖) e)`.

// `e`, or `P` where that is fixed.
@group(0) @binding(1) var<storage, read> results: array<vec4f>;
@group(0) @binding(2) var<storage, read> gap: array<vec4f>;
@group(0) @binding(3) var<storage, read> reach: array<f32>;
@group(0) @binding(4) var<storage, read_write> held: array<vec4f>;

fn residual(i: u32, r: u32) -> vec3f {
    let place = row_place(i, r);
    let found = results[place].xyz;
    return select(found, found - held[place].xyz - 2.0 * gap[place].xyz, batch.is_fixed != 0u);
}

fn work(i: u32, group: u32, lane: u32) {
    if i >= batch.count {
        return;
    }
    var squared = 0.0;
    for (var r = 0u; r < batch.rows; r++) {
        let e = residual(i, r);
        squared += dot(e, e);
    }
    let distance = sqrt(squared);
    var part = 1.0;
    if distance > reach[i] {
        part = reach[i] / distance;
    }
    for (var r = 0u; r < batch.rows; r++) {
        let place = row_place(i, r);
        let step = gap[place].xyz + part * residual(i, r);
        held[place] = vec4f(held[place].xyz + batch.relaxation * step, 0.0);
    }
}
