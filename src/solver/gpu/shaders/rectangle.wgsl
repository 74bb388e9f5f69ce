// Rectangle: onto the best-fit plane, then onto the rectangle whose sides fit best. See constraints/rectangle.rs.

// The unit vector at half the angle of `a`, between −90° and 90°; along x for 0.
fn half_angle(a: vec2f) -> vec2f {
    let size = length(a);
    if !(size > 0.0) {
        return vec2f(1.0, 0.0);
    }
    // From whichever of its parts is the larger.
    let unit = a / size;
    let large = sqrt(0.5 + 0.5 * abs(unit.x));
    let small = 0.5 * unit.y / large;
    if unit.x >= 0.0 {
        return normalize(vec2f(large, small));
    }
    return normalize(select(vec2f(-small, -large), vec2f(small, large), unit.y >= 0.0));
}

fn perp(a: vec2f) -> vec2f {
    return vec2f(-a.y, a.x);
}

fn project(i: u32) {
    let vectors = four_points(i);
    let found = orthogonalised(vectors);
    if found.scale == 0.0 {
        put_four(i, mat3x3f());
        return;
    }
    let least = found.v[2];
    let u = normalize(found.a[0]);
    let v = unit_beside(found.a[1], u);
    // In the plane, over the size. If the three vectors are a, b and c, the sides are x₁ − x₀ = −b − c, x₂ − x₁ = b −
    // a, x₃ − x₂ = c − b and x₀ − x₃ = a + b, and their middles ½ a, −½ c, −½ a and ½ c.
    let a = vec2f(dot(vectors[0], u), dot(vectors[0], v)) / found.scale;
    let b = vec2f(dot(vectors[1], u), dot(vectors[1], v)) / found.scale;
    let c = vec2f(dot(vectors[2], u), dot(vectors[2], v)) / found.scale;
    let sides = array<vec2f, 4>(b + c, b - c, perp(b - a), perp(b + a));
    var double = vec2f(0.0);
    for (var s = 0u; s < 4u; s++) {
        let side = sides[s];
        double += vec2f(side.x * side.x - side.y * side.y, 2.0 * side.x * side.y);
    }
    let n = perp(half_angle(double));
    let m = perp(n);
    // Corners are ± the middle of a side of normal n along n, ± that of a side of normal m along m.
    let change_a = dot(a, n) * n - a;
    let change_c = dot(c, m) * m - c;
    var residual = outer(-(vectors * least), least);
    residual[0] += found.scale * (change_a.x * u + change_a.y * v);
    residual[1] = -vectors[1];
    residual[2] += found.scale * (change_c.x * u + change_c.y * v);
    put_four(i, residual);
}
