// The regular polygon nearest to points in order, in closed form: see constraints/regular_polygon.rs.

const QUARTER_TURN = 1.57079632679;

// `‖p × q‖` up to which, relative to `p² + q²`, the points span no plane: its direction is round-off.
const COLLINEAR = 1e-6;

// Lengths below which a normal at rest says nothing once what it shares with the points' line is taken off.
const ALONG = 1e-3;

// The cosine and sine of `j` of `k` parts of a turn. Those of the language promise few digits. By Taylor's series,
// within 45° of one of the axes.
fn corner_turn(j: u32, k: u32) -> vec2f {
    let quarter = (8u * j + k) / (2u * k);
    let x = f32(i32(4u * j) - i32(quarter * k)) / f32(k) * QUARTER_TURN;
    let s = x * x;
    let cosine = 1.0 - s / 2.0 * (1.0 - s / 12.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0)));
    let sine = x * (1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0))));
    switch quarter & 3u {
        case 0u: { return vec2f(cosine, sine); }
        case 1u: { return vec2f(-sine, cosine); }
        case 2u: { return vec2f(-cosine, -sine); }
        default: { return vec2f(sine, -cosine); }
    }
}

// The axes of the nearest regular polygon: corner `j` is in the direction `cos a + sin b`, and `‖a‖ = ‖b‖` is `k` times
// the radius.
struct Polygon {
    // Of the points; left out where there are four, of which the three vectors are kept.
    mean: vec3f,
    vectors: mat3x3f,
    a: vec3f,
    b: vec3f,
    normal: vec3f,
}

// `a` less what is along the unit vector `direction`.
fn beside(a: vec3f, direction: vec3f) -> vec3f {
    return a - dot(a, direction) * direction;
}

// Of moments `p` and `q` that span no plane, the one of the normal nearest to `rest_normal` is taken.
fn polygon_along(p: vec3f, q: vec3f, rest_normal: vec3f) -> Polygon {
    let squared = dot(p, p) + dot(q, q);
    if !(squared > COINCIDENT_SQUARED) {
        return Polygon(vec3f(0.0), mat3x3f(), vec3f(0.0), vec3f(0.0), vec3f(0.0, 0.0, 1.0));
    }
    let along = normalize(select(q, p, dot(p, p) > dot(q, q)));
    let per_size = inverseSqrt(squared);
    // The product of vectors that are nearly on a line has round-off along it.
    let product = beside(cross(p * per_size, q * per_size), along);
    let rest = beside(rest_normal, along);
    var normal = any_orthogonal(along);
    if length(product) > COLLINEAR {
        normal = normalize(beside(normalize(product), along));
    } else if length(rest) > ALONG {
        normal = normalize(rest);
    }
    // The polygon must be regular whatever the round-off of the normal.
    let a = beside(p + cross(q, normal), normal);
    return Polygon(vec3f(0.0), mat3x3f(), a, cross(normal, a), normal);
}

fn nearest_polygon(i: u32, rest_normal: vec3f) -> Polygon {
    if batch.points == 4u {
        // The diagonals.
        let vectors = four_points(i);
        var square = polygon_along(vectors[0] + vectors[2], vectors[0] - vectors[2], rest_normal);
        square.vectors = vectors;
        return square;
    }
    let mean = centre(i);
    var p = vec3f(0.0);
    var q = vec3f(0.0);
    for (var j = 0u; j < batch.points; j++) {
        let turn = corner_turn(j, batch.points);
        let x = at(i, j) - mean;
        p += turn.x * x;
        q += turn.y * x;
    }
    var polygon = polygon_along(p, q, rest_normal);
    polygon.mean = mean;
    return polygon;
}

// Puts the residuals of the corners `factor (cos a + sin b)`.
fn put_polygon(i: u32, polygon: Polygon, factor: f32) {
    let a = factor * polygon.a;
    let b = factor * polygon.b;
    if batch.points == 4u {
        let vectors = polygon.vectors;
        put_four(i, mat3x3f(a + b - vectors[0], -vectors[1], a - b - vectors[2]));
        return;
    }
    for (var j = 0u; j < batch.points; j++) {
        let turn = corner_turn(j, batch.points);
        put_centred(i, j, turn.x * a + turn.y * b - (at(i, j) - polygon.mean), vec3f(0.0));
    }
}
