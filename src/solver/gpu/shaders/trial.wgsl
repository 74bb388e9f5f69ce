// Moves the points from the last iterate along the direction; the largest squared move of each workgroup's points.

struct Trial {
    count: u32,
    length: f32,
}

@group(0) @binding(0) var<uniform> trial: Trial;
@group(0) @binding(1) var<storage, read> last: array<vec4f>;
@group(0) @binding(2) var<storage, read> direction: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> shift: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> moves: array<f32>;

var<workgroup> largest: array<f32, 64>;

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = group.y * groups.x + group.x;
    let i = index * 64u + lane;
    var squared = 0.0;
    if i < trial.count {
        let change = trial.length * direction[i].xyz;
        shift[i] = vec4f(last[i].xyz + change, 0.0);
        squared = dot(change, change);
    }
    largest[lane] = squared;
    for (var half = 32u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if lane < half {
            largest[lane] = max(largest[lane], largest[lane + half]);
        }
    }
    if lane == 0u && index < arrayLength(&moves) {
        moves[index] = largest[0];
    }
}
