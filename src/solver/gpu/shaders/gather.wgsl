// The sum of the results that belong to each point. A slice of 64 points has its entries by structure: entry `n` of all 64
// behind each other, up to the longest list among them.

struct Lists {
    // The points of this run.
    first: u32,
    count: u32,
}

@group(0) @binding(0) var<uniform> lists: Lists;
@group(0) @binding(1) var<storage, read> starts: array<u32>;
@group(0) @binding(2) var<storage, read> entries: array<u32>;
@group(0) @binding(3) var<storage, read> results: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> sums: array<vec4f>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let slice = group.y * groups.x + group.x;
    let i = slice * 64u + lane;
    if i >= lists.count {
        return;
    }
    var sum = sums[lists.first + i];
    for (var entry = starts[slice] + lane; entry < starts[slice + 1u]; entry += 64u) {
        let place = entries[entry];
        if place == 0xffffffffu {
            break;
        }
        sum += results[place];
    }
    sums[lists.first + i] = sum;
}
