// The products of one pair `s`, `d` with the newest iterate: `s·Nf`, `d·Nf`, `s·Nd'` and `d·Nd'`.

struct Products {
    count: u32,
    first_share: u32,
}

@group(0) @binding(0) var<uniform> products: Products;
@group(0) @binding(1) var<storage, read> last: array<vec4f>;
@group(0) @binding(2) var<storage, read> pair: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> shares: array<vec4f>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let n = products.count;
    var sum = vec4f(0.0);
    for (var i = group.x * 64u + lane; i < n; i += groups.x * 64u) {
        let s = pair[i].xyz;
        let d = pair[n + i].xyz;
        let image = last[2u * n + i].xyz;
        let change = last[3u * n + i].xyz;
        sum += vec4f(dot(s, image), dot(d, image), dot(s, change), dot(d, change));
    }
    let total = group_sum(sum, lane);
    if lane == 0u {
        shares[products.first_share + group.x] = total;
    }
}
