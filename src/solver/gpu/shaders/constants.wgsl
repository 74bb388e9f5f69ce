// What is linear in the moves `u` of the points since the last upload: sums = C − Q u comes in; its energy is `−½ u·(C + sums)`,
// less what it was at the upload.

struct Count {
    count: u32,
}

@group(0) @binding(0) var<uniform> points: Count;
@group(0) @binding(1) var<storage, read> constants: array<vec4f>;
@group(0) @binding(2) var<storage, read> shift: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> sums: array<vec4f>;

fn work(i: u32, group: u32, lane: u32) {
    if i < points.count {
        let sum = sums[i].xyz;
        sums[i] = vec4f(sum, -0.5 * dot(shift[i].xyz, constants[i].xyz + sum));
    }
}
