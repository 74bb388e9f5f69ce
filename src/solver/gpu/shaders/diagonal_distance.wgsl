// DiagonalDistance: a quad goes between two parallel planes at most so far apart, one for each diagonal. See
// constraints/diagonal_distance.rs, whose words these are. Numbers: distance_max.

// Sines of the angle between the diagonals up to which they count as parallel: in single precision they have no common normal.
const PARALLEL: f32 = 1e-6;

// Steps of Newton's method at most.
const NEWTON_STEPS: u32 = 24u;

// How far `‖n‖²` may be from 1: some units in the last place.
const UNIT: f32 = 1e-6;

// How far below 1 `‖n‖²` ends in the hard case only.
const HARD: f32 = 1e-5;

// Smaller relative parts of `g` are 0: quotients of them would leave single precision.
const LEAST_PART: f32 = 1e-18;

// Smaller quads are a point: their squares leave single precision. They are round-off of the coordinates, which go to 1.
const SMALLEST: f32 = 1e-18;

// From one point to another, accurate where they are near to each other but not to point 0 too.
fn diagonal(i: u32, from_point: u32, to_point: u32) -> vec3f {
    let start = indices[from_point * batch.count + i];
    let end = indices[to_point * batch.count + i];
    return (base[end].xyz - base[start].xyz) + (shift[end].xyz - shift[start].xyz);
}

// The unit vector that minimises `‖X n − b‖`, of diagonals `u` and `v` whose middles are `w` apart.
fn common_normal(u: vec3f, v: vec3f, w: vec3f, epsilon: f32) -> vec3f {
    let svd = singular_3(mat3x3f(0.70710678 * u, 0.70710678 * v, w));
    let s = abs(svd.s) / svd.s.x;
    // The last is the least.
    let d = vec3f((s.x - s.z) * (s.x + s.z), (s.y - s.z) * (s.y + s.z), 0.0);
    var g = (epsilon / svd.s.x) * ((w / svd.s.x) * svd.u);
    g = select(g, vec3f(0.0), abs(g) < vec3f(LEAST_PART));
    let has_part = g != vec3f(0.0);
    let starts = abs(g) - d;
    var t = max(max(starts.x, starts.y), max(starts.z, 0.0));
    var n = vec3f(0.0);
    var squared = 0.0;
    for (var step = 0u; step < NEWTON_STEPS; step++) {
        // Parts of g that are 0 have no part in n, whatever d.
        let per = 1.0 / select(vec3f(1.0), d + t, has_part);
        n = g * per;
        squared = dot(n, n);
        // Only ever upwards: below 1 the root is passed, by round-off or as it is 0.
        if squared <= 1.0 + UNIT {
            break;
        }
        t += squared * (sqrt(squared) - 1.0) / dot(n * n, per);
    }
    if squared < 1.0 - HARD {
        let part = sqrt(n.z * n.z + 1.0 - squared);
        n.z = select(-part, part, dot(cross(u, v), svd.u[2]) >= 0.0);
    }
    return normalize(svd.u * n);
}

// The normal of the planes; 0 where the diagonals are near enough.
fn normal_of(u: vec3f, v: vec3f, w: vec3f, epsilon: f32) -> vec3f {
    let normal = cross(u, v);
    let squares = vec2f(dot(u, u), dot(v, v));
    let sine = length(normal);
    // Where one diagonal has no length both are 0.
    if sine <= PARALLEL * sqrt(squares.x * squares.y) {
        return vec3f(0.0);
    }
    // What of w lies along the longer diagonal has no part in the distance, but much in the round-off.
    let along = normalize(select(u, v, squares.y > squares.x));
    let rough = w - dot(w, along) * along;
    let beside = rough - dot(rough, along) * along;
    if abs(dot(beside, normal)) <= epsilon * sine {
        return vec3f(0.0);
    }
    return common_normal(u, v, w, epsilon);
}

fn project(i: u32) {
    let whole_u = diagonal(i, 0u, 2u);
    let whole_v = diagonal(i, 1u, 3u);
    let whole_w = 0.5 * (diagonal(i, 0u, 1u) + diagonal(i, 2u, 3u));
    let size = max(strain_largest(whole_w), max(strain_largest(whole_u), strain_largest(whole_v)));
    let epsilon = number(i, 0u);
    var n = vec3f(0.0);
    if size > SMALLEST && epsilon < 2.0 * size {
        n = normal_of(whole_u / size, whole_v / size, whole_w / size, epsilon / size);
    }
    // Relative to the middle the points are −w/2 ∓ u/2 and w/2 ∓ v/2.
    let w = 0.5 * dot(whole_w, n);
    let u = 0.5 * dot(whole_u, n);
    let v = 0.5 * dot(whole_v, n);
    put_centred(i, 0u, (w + u - 0.5 * epsilon) * n, vec3f(0.0));
    put_centred(i, 1u, (v - w + 0.5 * epsilon) * n, vec3f(0.0));
    put_centred(i, 2u, (w - u - 0.5 * epsilon) * n, vec3f(0.0));
    put_centred(i, 3u, (0.5 * epsilon - w - v) * n, vec3f(0.0));
}
