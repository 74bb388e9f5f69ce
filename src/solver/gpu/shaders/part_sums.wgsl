// Sums of many pairs, one for each workgroup.

@group(0) @binding(2) var<storage, read_write> sums: array<vec4f>;

@compute @workgroup_size(WIDTH)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let sum = pair_sum(local, sum_of(group.x * WIDTH + local, groups.x * WIDTH));
    if local == 0u {
        sums[2u * group.x] = vec4f(sum.first, 0.0);
        sums[2u * group.x + 1u] = vec4f(sum.second, 0.0);
    }
}
