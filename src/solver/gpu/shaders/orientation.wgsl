// Orientation: onto the plane of a given normal through the mean. See constraints/orientation.rs.
// Numbers: the unit normal.

fn project(i: u32) {
    let mean = centre(i);
    let normal = vec3f(number(i, 0u), number(i, 1u), number(i, 2u));
    for (var j = 0u; j < batch.points; j++) {
        put_centred(i, j, -dot(at(i, j) - mean, normal) * normal, vec3f(0.0));
    }
}
