// EdgeLength: the row is the edge; its length is clamped to a range. See constraints/edge_length.rs.
// Numbers: length_min, length_max, the unit vector along the edge at creation.

// Shorter edges have no direction: their squares leave single precision. They are round-off of the coordinates, which go to 1.
const SHORTEST_EDGE: f32 = 1e-18;

fn project(i: u32) {
    var residuals = array<vec3f, 4>();
    let edge = at(i, 1u);
    let current = length(edge);
    let wanted = clamp(current, number(i, 0u), number(i, 1u));
    if current > SHORTEST_EDGE {
        residuals[0] = (wanted - current) * normalize(edge);
    } else {
        residuals[0] = wanted * vec3f(number(i, 2u), number(i, 3u), number(i, 4u));
    }
    put_linear(i, residuals);
}
