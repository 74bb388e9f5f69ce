// EdgeStrain: the row is (end − start)/length; its target is as long as the range allows. See constraints/edge_strain.rs.
// Numbers: range_min, range_max.

// Shorter edges have no direction: their squares leave single precision.
const SHORTEST_EDGE: f32 = 1e-18;

fn project(i: u32) {
    var residuals = array<vec3f, 4>();
    let strain = row(i, 0u);
    let current = length(strain);
    let wanted = clamp(current, number(i, 0u), number(i, 1u));
    if current > SHORTEST_EDGE {
        residuals[0] = (wanted - current) * normalize(strain);
    } else if coefficient(i, 0u, 1u) != 0.0 {
        residuals[0] = vec3f(wanted, 0.0, 0.0);
    }
    put_linear(i, residuals);
}
