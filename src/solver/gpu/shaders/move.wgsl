// Moves the points by the solution.

struct Count {
    count: u32,
}

@group(0) @binding(0) var<uniform> points: Count;
@group(0) @binding(1) var<storage, read> solution: array<vec4f>;
@group(0) @binding(2) var<storage, read> scale: array<f32>;
@group(0) @binding(3) var<storage, read_write> shift: array<vec4f>;

fn work(i: u32, group: u32, lane: u32) {
    var change = vec3f(0.0);
    if i < points.count {
        change = scale[i] * solution[i].xyz;
        shift[i] = vec4f(shift[i].xyz + change, 0.0);
    }
    tell_move(change, group, lane);
}
