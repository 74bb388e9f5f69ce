// OnLine: onto a given line. See constraints/on_line.rs.

fn project(i: u32) {
    var residuals = array<vec3f, 4>();
    let x = from_place(i);
    residuals[0] = dot(x, axis(i)) * axis(i) - x;
    put_linear(i, residuals);
}
