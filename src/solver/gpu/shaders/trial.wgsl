// Moves the points from the last iterate along the direction.

struct Trial {
    count: u32,
    length: f32,
}

@group(0) @binding(0) var<uniform> trial: Trial;
@group(0) @binding(1) var<storage, read> last: array<vec4f>;
@group(0) @binding(2) var<storage, read> direction: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> shift: array<vec4f>;

fn work(i: u32, group: u32, lane: u32) {
    var change = vec3f(0.0);
    if i < trial.count {
        change = trial.length * direction[i].xyz;
        shift[i] = vec4f(last[i].xyz + change, 0.0);
    }
    tell_move(change, group, lane);
}
