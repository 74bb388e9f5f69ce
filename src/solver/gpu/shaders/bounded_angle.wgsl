// BoundedAngle: the rows are two edges, which turn in their plane to an angle within a range; see constraints/bounded_angle.rs.
// Numbers: cosine and sine of the least angle, of the greatest; the unit normal at creation, or 0.

const PI: f32 = 3.14159265;

// Corrections of 75° and of 85° in rad: up to the one the nearest element is taken, from the other on edges keep their lengths.
const NEAREST: f32 = 1.30899694;
const KEEPING: f32 = 1.48352986;

// Their cosines and the sine of the second.
const NEAREST_COSINE: f32 = 0.25881905;
const KEEPING_COSINE: f32 = 0.08715574;
const KEEPING_SINE: f32 = 0.99619470;

// The angle within 0..π that has this cosine and this sine, both of them accurate. Cards' own need not be.
fn angle_with(turn: vec2f) -> f32 {
    // A right angle less eight times an arc of at most π/16, whose tangent is below 0.2: the series is done after five terms.
    var tangent = turn.x / (1.0 + turn.y);
    tangent /= 1.0 + sqrt(1.0 + tangent * tangent);
    tangent /= 1.0 + sqrt(1.0 + tangent * tangent);
    let q = tangent * tangent;
    let arc = tangent * (1.0 - q * (1.0 / 3.0 - q * (1.0 / 5.0 - q * (1.0 / 7.0 - q / 9.0))));
    return 0.5 * PI - 8.0 * arc;
}

// The cosine and sine of an angle within 0..π, by the series of its complement.
fn turn_by(angle_rad: f32) -> vec2f {
    let y = 0.5 * PI - angle_rad;
    let q = y * y;
    let sine = 1.0 - q / 110.0 * (1.0 - q / 156.0);
    let sine_y = y * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0 * sine))));
    let cosine = 1.0 - q / 90.0 * (1.0 - q / 132.0 * (1.0 - q / 182.0));
    let cosine_y = 1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0 * cosine)));
    return vec2f(sine_y, cosine_y);
}

// From an edge of length 1 to what it is after a turn towards `across`, `factor` times as long.
fn turned(edge: vec3f, across: vec3f, turn: vec2f, factor: f32) -> vec3f {
    return (factor * turn.x - 1.0) * edge + factor * turn.y * across;
}

// A normal for edges along one line: as near as possible to that at creation.
fn normal_beside(rest: vec3f, direction: vec3f) -> vec3f {
    let beside = rest - dot(rest, direction) * direction;
    if length(beside) > CORNER_COLLINEAR {
        return normalize(beside);
    }
    // The axis least along the line is far from it.
    let least = min(min(abs(direction.x), abs(direction.y)), abs(direction.z));
    let axis = select(select(vec3f(0.0, 0.0, 1.0), vec3f(0.0, 1.0, 0.0), abs(direction.y) == least),
        vec3f(1.0, 0.0, 0.0), abs(direction.x) == least);
    return normalize(cross(direction, axis));
}

fn project(i: u32) {
    var residuals = array<vec3f, 4>();
    var corner = corner_of(i);
    if !corner.has_lengths {
        put_linear(i, residuals);
        return;
    }
    if !corner.has_plane {
        // As if they were exactly along one line, so that the angle is the same in any plane through it.
        corner.cosine = select(1.0, -1.0, corner.cosine < 0.0);
        corner.sine = 0.0;
        corner.f = corner.cosine * corner.e;
        corner_span(&corner, normal_beside(vec3f(number(i, 4u), number(i, 5u), number(i, 6u)), corner.e));
    }
    let correction = corner_correction(corner, vec2f(number(i, 0u), number(i, 1u)), vec2f(number(i, 2u), number(i, 3u)));
    if correction.sign != 0.0 {
        let squares = corner_squares(corner);
        let eta = vec2f(correction.cosine, correction.sine);
        // The nearest element is of no interest, and not continuous, where nothing is left of it.
        let nearest_eta = select(eta, vec2f(KEEPING_COSINE, KEEPING_SINE), eta.x < KEEPING_COSINE);
        var first = corner_halved(corner_doubled_share(squares.x, squares.y, nearest_eta));
        var second = corner_difference(nearest_eta, first);
        var factors = vec2f(first.x, second.x);
        if eta.x < NEAREST_COSINE {
            let whole = angle_with(eta);
            let part = clamp((whole - NEAREST) / (KEEPING - NEAREST), 0.0, 1.0);
            let kept = part * part * (3.0 - 2.0 * part);
            let nearest = angle_with(first);
            let keeping = whole * (squares.y / (squares.x + squares.y));
            let turn = clamp(nearest + kept * (keeping - nearest), 0.0, whole);
            first = turn_by(turn);
            second = turn_by(whole - turn);
            factors += kept * (1.0 - factors);
        }
        let signs = vec2f(1.0, correction.sign);
        residuals[0] = corner.lengths.x * turned(corner.e, corner.to_f, first * signs, factors.x);
        residuals[1] = corner.lengths.y * turned(corner.f, corner.to_e, second * signs, factors.y);
    }
    put_linear(i, residuals);
}
