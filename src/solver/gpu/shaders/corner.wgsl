// Two edges from a point, their angle and their turns, for the types that bound it: by cosines and sines alone, as cards need not
// compute angles to more than a few digits. See constraints/angle.rs.

// Edges whose angle has no larger sine are along one line: a few units in the last place, which span no plane.
const CORNER_COLLINEAR: f32 = 5e-7;

// Shorter edges have no direction: their squares leave single precision. They are round-off of the coordinates, which go to 1.
const CORNER_SHORTEST: f32 = 1e-18;

struct Corner {
    // The edges' lengths and unit vectors.
    lengths: vec2f,
    e: vec3f,
    f: vec3f,
    // Unit vectors in their plane: beside `e` towards `f`, and beside `f` towards `e`. 0 where the edges span no plane.
    to_f: vec3f,
    to_e: vec3f,
    // Cosine and sine of their angle.
    cosine: f32,
    sine: f32,
    has_lengths: bool,
    has_plane: bool,
}

// A correction: by how much the angle is too large, or too small where `sign` is −1; 0 where it is neither.
struct Correction {
    sign: f32,
    cosine: f32,
    sine: f32,
}

fn corner_of(i: u32) -> Corner {
    var corner: Corner;
    let first = at(i, 1u);
    let second = at(i, 2u);
    corner.lengths = vec2f(length(first), length(second));
    corner.has_lengths = min(corner.lengths.x, corner.lengths.y) > CORNER_SHORTEST;
    if !corner.has_lengths {
        return corner;
    }
    corner.e = normalize(first);
    corner.f = normalize(second);
    corner.cosine = clamp(dot(corner.e, corner.f), -1.0, 1.0);
    // Twice, as the first difference of near-collinear edges is not quite beside `e`.
    let rough = corner.f - corner.cosine * corner.e;
    let beside = rough - dot(rough, corner.e) * corner.e;
    corner.sine = min(length(beside), 1.0);
    corner.has_plane = corner.sine > CORNER_COLLINEAR;
    if corner.has_plane {
        corner_span(&corner, cross(corner.e, normalize(beside)));
    }
    return corner;
}

// Lets the edges span the plane with the unit `normal`, `f` on the left of `e` when seen against it.
fn corner_span(corner: ptr<function, Corner>, normal: vec3f) {
    (*corner).to_f = normalize(cross(normal, (*corner).e));
    (*corner).to_e = normalize(cross((*corner).f, normal));
}

// What the corner's angle lacks to be within the range whose ends have the cosines and sines `low` and `high`.
fn corner_correction(corner: Corner, low: vec2f, high: vec2f) -> Correction {
    // The sine of the difference of two angles within 0..π has the sign of the difference, but where that is
    // all of π.
    let large = Correction(1.0, dot(vec2f(corner.cosine, corner.sine), high), corner.sine * high.x - corner.cosine * high.y);
    if large.sine > 0.0 || (large.sine == 0.0 && large.cosine < 0.0 && corner.cosine < 0.0) {
        return large;
    }
    let small = Correction(-1.0, dot(vec2f(corner.cosine, corner.sine), low), low.y * corner.cosine - low.x * corner.sine);
    if small.sine > 0.0 || (small.sine == 0.0 && small.cosine < 0.0 && corner.cosine > 0.0) {
        return small;
    }
    return Correction(0.0, 1.0, 0.0);
}

// The cosine and sine of twice `θ = ½ atan2(b sin 2η, a + b cos 2η)`, which shares a correction below a right angle between edges
// whose squared lengths are `a` and `b`.
fn corner_doubled_share(a: f32, b: f32, eta: vec2f) -> vec2f {
    let share = vec2f(a + b * (1.0 - 2.0 * eta.y * eta.y), b * (2.0 * eta.y * eta.x));
    let most = max(abs(share.x), share.y);
    // Equal edges at a right angle: either may turn.
    if most < CORNER_SHORTEST {
        return vec2f(1.0, 0.0);
    }
    return normalize(share / most);
}

// The cosine and sine of half the angle within 0..π that has these.
fn corner_halved(doubled: vec2f) -> vec2f {
    let larger = sqrt(0.5 + 0.5 * abs(doubled.x));
    let smaller = 0.5 * doubled.y / larger;
    return select(vec2f(smaller, larger), vec2f(larger, smaller), doubled.x >= 0.0);
}

// The cosine and sine of the difference of two angles.
fn corner_difference(whole: vec2f, part: vec2f) -> vec2f {
    return vec2f(dot(whole, part), whole.y * part.x - whole.x * part.y);
}

// Squared lengths relative to the longer one.
fn corner_squares(corner: Corner) -> vec2f {
    let relative = corner.lengths / max(corner.lengths.x, corner.lengths.y);
    return relative * relative;
}
