// Line: onto the best-fit line through the mean. See constraints/line.rs.

fn project(i: u32) {
    let found = principal(i);
    let direction = found.axes[2];
    for (var j = 0u; j < batch.points; j++) {
        let x = at(i, j) - found.mean;
        put_centred(i, j, dot(x, direction) * direction - x, vec3f(0.0));
    }
}
