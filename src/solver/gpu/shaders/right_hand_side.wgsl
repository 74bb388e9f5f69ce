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

var<workgroup> shares: array<f32, 64>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = group.y * groups.x + group.x;
    let i = index * 64u + lane;
    var sum = vec4f(0.0);
    if i < count.points {
        sum = sums[i];
    }
    if i < count.unknowns {
        right[i] = vec4f(scale[i] * sum.xyz, 0.0);
    }
    shares[lane] = sum.w;
    for (var half = 32u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if lane < half {
            shares[lane] += shares[lane + half];
        }
    }
    if lane == 0u && index < arrayLength(&energies) {
        energies[index] = shares[0];
    }
}
