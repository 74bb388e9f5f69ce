// Bending: the row is the cotangent stencil of two rest triangles; its norm stays within a range of that at rest. See
// constraints/bending.rs. Numbers: range_min, range_max, the norm at rest, the norm up to which the pair is flat.

// Relative round-off of a sum of four products, with room to spare: what is shorter has no direction.
const BENDING_ROUND_OFF: f32 = 1e-6;

fn project(i: u32) {
    var bend = vec3f(0.0);
    var terms = 0.0;
    for (var j = 1u; j < 4u; j++) {
        let term = coefficient(i, 0u, j) * at(i, j);
        bend += term;
        terms += length(term);
    }
    let norm = length(bend);
    let rest = number(i, 2u);
    var residuals = array<vec3f, 4>();
    if rest == 0.0 {
        residuals[0] = -bend;
    } else if norm > max(number(i, 3u), BENDING_ROUND_OFF * terms) {
        let ratio = norm / rest;
        residuals[0] = bend * ((clamp(ratio, number(i, 0u), number(i, 1u)) - ratio) / ratio);
    }
    put_linear(i, residuals);
}
