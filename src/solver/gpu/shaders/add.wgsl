// sums ← sums + pulls.

struct Count {
    count: u32,
}

@group(0) @binding(0) var<uniform> points: Count;
@group(0) @binding(1) var<storage, read> pulls: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> sums: array<vec4f>;

fn work(i: u32, group: u32, lane: u32) {
    if i < points.count {
        sums[i] += vec4f(pulls[i].xyz, 0.0);
    }
}
