// Plane: onto the best-fit plane through the mean. See constraints/plane.rs.

fn project(i: u32) {
    if batch.points == 4u {
        let vectors = four_points(i);
        let least = orthogonalised(vectors).v[2];
        put_four(i, outer(-(vectors * least), least));
        return;
    }
    let found = principal(i);
    let normal = found.axes[0];
    for (var j = 0u; j < batch.points; j++) {
        put_centred(i, j, -dot(at(i, j) - found.mean, normal) * normal, vec3f(0.0));
    }
}
