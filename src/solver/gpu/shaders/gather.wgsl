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

fn work(i: u32, group: u32, lane: u32) {
    if i >= lists.count {
        return;
    }
    var sum = sums[lists.first + i];
    for (var entry = starts[group] + lane; entry < starts[group + 1u]; entry += 64u) {
        let place = entries[entry];
        if place == 0xffffffffu {
            break;
        }
        sum += results[place];
    }
    sums[lists.first + i] = sum;
}
