// The newest iterate of a history: the points `x`, their plain step `f` and its image `N f`, which is the right-hand side; and
// their changes since the last one. Grid-stride: as many workgroups as there are shares of products.

struct Push {
    count: u32,
    // Where the shares of `⟨f, f⟩` begin.
    first_share: u32,
}

@group(0) @binding(0) var<uniform> push: Push;
@group(0) @binding(1) var<storage, read> shift: array<vec4f>;
@group(0) @binding(2) var<storage, read> sums: array<vec4f>;
@group(0) @binding(3) var<storage, read> solution: array<vec4f>;
@group(0) @binding(4) var<storage, read> scale: array<f32>;
// Four vectors behind each other: x, f and N f of the last iterate, and the change of N f.
@group(0) @binding(5) var<storage, read_write> last: array<vec4f>;
// Two vectors: the move and the change of f.
@group(0) @binding(6) var<storage, read_write> pair: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> shares: array<vec4f>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let n = push.count;
    var product = 0.0;
    for (var i = group.x * 64u + lane; i < n; i += groups.x * 64u) {
        let x = shift[i].xyz;
        let f = scale[i] * solution[i].xyz;
        let image = sums[i].xyz;
        pair[i] = vec4f(x - last[i].xyz, 0.0);
        pair[n + i] = vec4f(f - last[n + i].xyz, 0.0);
        last[3u * n + i] = vec4f(image - last[2u * n + i].xyz, 0.0);
        last[i] = vec4f(x, 0.0);
        last[n + i] = vec4f(f, 0.0);
        last[2u * n + i] = vec4f(image, 0.0);
        product += dot(f, image);
    }
    let total = group_sum(vec4f(product, 0.0, 0.0, 0.0), lane);
    if lane == 0u {
        shares[push.first_share + group.x] = total;
    }
}
