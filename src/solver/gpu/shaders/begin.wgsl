// Before the first step: x = 0, and no progress.

@group(0) @binding(0) var<storage, read_write> x: array<vec4f>;
@group(0) @binding(1) var<storage, read_write> progress: array<vec4f, 2>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let i = (group.y * groups.x + group.x) * 64u + local;
    if i < arrayLength(&x) {
        x[i] = vec4f(0.0);
    }
    if i == 0u {
        progress[0] = vec4f(0.0);
        progress[1] = vec4f(0.0);
    }
}
