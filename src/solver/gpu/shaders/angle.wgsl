// Angle: the rows are two edges, which turn in their plane to an angle within a range and become their feet on their new
// directions. See constraints/angle.rs. Numbers: cosine and sine of the least angle, of the greatest.

// From an edge to its foot on the direction at the angle with this cosine and sine from it, towards `across`.
fn foot(edge: vec3f, across: vec3f, turn: vec2f) -> vec3f {
    return turn.y * (turn.x * across - turn.y * edge);
}

fn project(i: u32) {
    var residuals = array<vec3f, 4>();
    let corner = corner_of(i);
    let low = vec2f(number(i, 0u), number(i, 1u));
    let high = vec2f(number(i, 2u), number(i, 3u));
    let correction = corner_correction(corner, low, high);
    if corner.has_plane && correction.sign != 0.0 {
        let eta = vec2f(correction.cosine, correction.sine);
        let squares = corner_squares(corner);
        // From a right angle on the second edge makes the whole turn.
        var theta = vec2f(1.0, 0.0);
        if eta.x > 0.0 {
            theta = corner_halved(corner_doubled_share(squares.x, squares.y, eta));
        }
        let rest = corner_difference(eta, theta);
        let signs = vec2f(1.0, correction.sign);
        residuals[0] = corner.lengths.x * foot(corner.e, corner.to_f, theta * signs);
        residuals[1] = corner.lengths.y * foot(corner.f, corner.to_e, rest * signs);
    }
    put_linear(i, residuals);
}
