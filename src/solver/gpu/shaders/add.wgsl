// sums ← sums + pulls.

struct Count {
    count: u32,
}

@group(0) @binding(0) var<uniform> points: Count;
@group(0) @binding(1) var<storage, read> pulls: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> sums: array<vec4f>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let i = (group.y * groups.x + group.x) * 64u + lane;
    if i < points.count {
        sums[i] += vec4f(pulls[i].xyz, 0.0);
    }
}
