// OnPlane: onto a given plane. See constraints/on_plane.rs.

fn project(i: u32) {
    var residuals = array<vec3f, 4>();
    residuals[0] = -dot(from_place(i), axis(i)) * axis(i);
    put_linear(i, residuals);
}
