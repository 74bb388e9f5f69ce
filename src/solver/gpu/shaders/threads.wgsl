// One thread for each of many things: `fn work(i: u32, group: u32, lane: u32)` of the text before is called for thing `i`, which is thread
// `lane` of workgroup `group`. There are more threads than things.

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    // One dimension of a run has a limit.
    let index = group.y * groups.x + group.x;
    work(index * 64u + lane, index, lane);
}
