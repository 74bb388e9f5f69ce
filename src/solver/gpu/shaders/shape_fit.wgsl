// The nearest copy of a template shape, in any cyclic or mirrored order of its vertices. See constraints/shape_fit.rs.
//
// Numbers: the circumradius of the template if it is a regular polygon, else 0; the number of templates; of each
// template its size, the root of the sum of its vertices' squared distances from their mean, and the vertices about
// their mean, over the size. Sizes are 1 where the scale is free.

// How far traces and bounds on them are trusted, relative to them. A distance below the root of this, of the points'
// size, is lost in them.
const TRACE_DIGITS = 1e-5;

// One template in one order of its vertices, turned by `U Vᵀ` and scaled by `factor` to match.
struct Candidate {
    shape: u32,
    shift: u32,
    is_mirrored: bool,
    u: mat3x3f,
    v: mat3x3f,
    factor: f32,
}

fn shape_number(shape: u32) -> u32 {
    return 2u + shape * (3u * batch.points + 1u);
}

// Vertex of template `shape` to which point `j` is matched.
fn vertex(i: u32, shape: u32, shift: u32, is_mirrored: bool, j: u32) -> vec3f {
    let index = select(shift + j, shift + batch.points - j, is_mirrored) % batch.points;
    let n = shape_number(shape) + 1u + 3u * index;
    return vec3f(number(i, n), number(i, n + 1u), number(i, n + 2u));
}

// `Σ x qᵀ` of the points along the axes `u` and the vertices along the axes `v`.
fn covariance(i: u32, mean: vec3f, u: mat3x3f, v: mat3x3f, shape: u32, shift: u32, is_mirrored: bool) -> mat3x3f {
    var sum = mat3x3f();
    for (var j = 0u; j < batch.points; j++) {
        sum += outer((at(i, j) - mean) * u, vertex(i, shape, shift, is_mirrored, j) * v);
    }
    return sum;
}

// A bound on the trace that the best rotation reaches: see `trace_bound` in shape_fit.rs.
fn trace_bound(h: mat3x3f) -> f32 {
    let most = max(max(abs(h[0]), abs(h[1])), abs(h[2]));
    let scale = max(most.x, max(most.y, most.z));
    if !(scale * scale > COINCIDENT_SQUARED) {
        // The sum of the entries is a bound too.
        return 9.0 * scale;
    }
    // Products of four tiny entries would leave the range of single precision.
    let x = h[0] / scale;
    let y = h[1] / scale;
    let z = h[2] / scale;
    let a = cross(x, y);
    let b = cross(y, z);
    let c = cross(z, x);
    let cofactors = sqrt(dot(a, a) + dot(b, b) + dot(c, c));
    let squared = dot(x, x) + dot(y, y) + dot(z, z);
    return scale * sqrt(squared + 2.0 * sqrt(3.0) * cofactors) * (1.0 + TRACE_DIGITS);
}

// Of two candidates, the nearer has the greater one: by how much the squared distance from the template is less than
// that from a point, or where the scale is free, the root of that.
fn merit(trace: f32, size: f32, is_scaled: bool) -> f32 {
    return select(size * (2.0 * trace - size), trace, is_scaled);
}

// The candidate that `rotation` turns, which was found from the covariance. Of thin shapes that does not say, in single
// precision, how far to turn about their length; along the axes found it does.
fn refined(i: u32, mean: vec3f, candidate: Candidate, rotation: Rotation, is_scaled: bool) -> Candidate {
    var found = candidate;
    let left = covariance(i, mean, rotation.u, rotation.v, found.shape, found.shift, found.is_mirrored);
    let rest = nearest_rotation(left);
    found.u = rotation.u * rest.u;
    found.v = rotation.v * rest.v;
    found.factor = select(number(i, shape_number(found.shape)), rest.trace, is_scaled);
    return found;
}

// By how much point `j` is to move.
fn residual_of(i: u32, mean: vec3f, found: Candidate, j: u32) -> vec3f {
    let q = vertex(i, found.shape, found.shift, found.is_mirrored, j);
    return found.factor * (found.u * (q * found.v)) - (at(i, j) - mean);
}

fn squared_distance(i: u32, mean: vec3f, found: Candidate) -> f32 {
    var sum = 0.0;
    for (var j = 0u; j < batch.points; j++) {
        let residual = residual_of(i, mean, found, j);
        sum += dot(residual, residual);
    }
    return sum;
}

fn best_candidate(i: u32, mean: vec3f, is_scaled: bool) -> Candidate {
    var best = Candidate(0u, 0u, false, IDENTITY, IDENTITY, 0.0);
    // Below every merit.
    var best_merit = -3.4e38;
    var best_squared = 0.0;
    let shape_count = u32(number(i, 1u));
    for (var shape = 0u; shape < shape_count; shape++) {
        let size = number(i, shape_number(shape));
        for (var order = 0u; order < 2u * batch.points; order++) {
            let is_mirrored = order >= batch.points;
            let shift = select(order, order - batch.points, is_mirrored);
            let h = covariance(i, mean, IDENTITY, IDENTITY, shape, shift, is_mirrored);
            let least = best_merit - TRACE_DIGITS * abs(best_merit);
            // Most orders are far worse than the best so far: no rotation needs to be fitted to know.
            if merit(trace_bound(h), size, is_scaled) < least {
                continue;
            }
            let rotation = nearest_rotation(h);
            let own_merit = merit(rotation.trace, size, is_scaled);
            if own_merit < least {
                continue;
            }
            // Of templates that are nearly symmetric, distances tell orders apart where traces do not.
            let unturned = Candidate(shape, shift, is_mirrored, IDENTITY, IDENTITY, 0.0);
            let own = refined(i, mean, unturned, rotation, is_scaled);
            let own_squared = squared_distance(i, mean, own);
            if own_merit > best_merit + TRACE_DIGITS * abs(best_merit) || own_squared < best_squared {
                best = own;
                best_merit = own_merit;
                best_squared = own_squared;
            }
        }
    }
    return best;
}

fn fit(i: u32, is_scaled: bool) {
    let radius = number(i, 0u);
    if radius > 0.0 {
        fit_polygon(i, radius, is_scaled);
        return;
    }
    let mean = centre(i);
    let best = best_candidate(i, mean, is_scaled);
    for (var j = 0u; j < batch.points; j++) {
        put_centred(i, j, residual_of(i, mean, best, j), vec3f(0.0));
    }
}

// All orders of a regular polygon are turns of each other, so the order of the points will do.
fn fit_polygon(i: u32, radius: f32, is_scaled: bool) {
    var polygon = nearest_polygon(i, vec3f(0.0));
    if is_scaled {
        put_polygon(i, polygon, 1.0 / f32(batch.points));
        return;
    }
    // Points of which no direction is better than another are given any.
    let is_along = dot(polygon.a, polygon.a) > COINCIDENT_SQUARED;
    polygon.a = normalize(select(any_orthogonal(polygon.normal), polygon.a, is_along));
    polygon.b = cross(polygon.normal, polygon.a);
    put_polygon(i, polygon, radius);
}
