// From the sums of points to the right-hand side of the matrix of unit diagonal, and the energy of each workgroup's points.

struct Count {
    // Unknowns, and points: the unknowns beyond have a right-hand side of 0.
    unknowns: u32,
    points: u32,
}

@group(0) @binding(0) var<uniform> count: Count;
@group(0) @binding(1) var<storage, read> sums: array<vec4f>;
@group(0) @binding(2) var<storage, read> scale: array<f32>;
@group(0) @binding(3) var<storage, read_write> right: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> energies: array<f32>;

fn work(i: u32, group: u32, lane: u32) {
    var sum = vec4f(0.0);
    if i < count.points {
        sum = sums[i];
    }
    if i < count.unknowns {
        right[i] = vec4f(scale[i] * sum.xyz, 0.0);
    }
    let total = group_sum(sum, lane);
    if lane == 0u && group < arrayLength(&energies) {
        energies[group] = total.w;
    }
}
