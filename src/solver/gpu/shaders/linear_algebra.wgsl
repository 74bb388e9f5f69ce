// Decompositions of 3×3 matrices, twins of linalg/small.rs, and what the projections of centred types share.
//
// Square roots and quotients of cards err by a few units in the last place, so that after some rotations vectors are no
// longer of unit length: they are normalised at the end.

// Sweeps after which Jacobi iterations stop whatever is left. Convergence is quadratic: in single precision four or
// five suffice.
const SWEEPS = 7u;

// The square of the cosine between columns, and off-diagonal entries relative to the diagonal ones beside them,
// squared, that count as 0: round-off.
const ORTHOGONAL_SQUARED = 1e-15;

// Lengths on the card, squared, at and below which points coincide: their own squares would leave the range of single
// precision.
const COINCIDENT_SQUARED = 1e-30;

// Point count from which on the mean is summed twice, for then the round-off of the first sum shows.
const MANY_POINTS = 16u;

const IDENTITY = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);

// Cosine, sine and tangent of the Jacobi rotation that annuls the off-diagonal entry of [[a, b], [b, d]].
fn jacobi_rotation(a: f32, b: f32, d: f32) -> vec3f {
    // The smaller root of t² + 2τt − 1 = 0 with τ = (d − a)/2b, times 2b above and below: b may be 0.
    let difference = d - a;
    let bottom = abs(difference) + sqrt(difference * difference + 4.0 * b * b);
    var tangent = 0.0;
    if bottom > 0.0 {
        tangent = select(-2.0, 2.0, difference >= 0.0) * b / bottom;
    }
    let cosine = inverseSqrt(tangent * tangent + 1.0);
    return vec3f(cosine, tangent * cosine, tangent);
}

// Turns two vectors in their plane by the cosine and sine of `turn`.
fn turn_pair(turn: vec3f, p: ptr<function, vec3f>, q: ptr<function, vec3f>) {
    let old = *p;
    *p = turn.x * old - turn.y * *q;
    *q = turn.y * old + turn.x * *q;
}

// Puts the longer of two columns first, and what goes with them likewise, by a quarter turn: a rotation stays one.
fn longer_first(
    p: ptr<function, vec3f>,
    q: ptr<function, vec3f>,
    vp: ptr<function, vec3f>,
    vq: ptr<function, vec3f>,
) {
    if dot(*p, *p) < dot(*q, *q) {
        let a = *p;
        let va = *vp;
        *p = *q;
        *q = -a;
        *vp = *vq;
        *vq = -va;
    }
}

// A unit vector orthogonal to the unit vector `direction`.
fn any_orthogonal(direction: vec3f) -> vec3f {
    let axis = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(direction.x) > 0.6);
    return normalize(axis - dot(axis, direction) * direction);
}

// A unit vector along what `a` does not share with the unit vector `direction`; any such vector if nothing is left.
fn unit_beside(a: vec3f, direction: vec3f) -> vec3f {
    let own = a - dot(a, direction) * direction;
    let squared = dot(own, own);
    // What is left of a vector that is nearly along `direction` is round-off, and points anywhere.
    if squared > COINCIDENT_SQUARED && squared > 0.25 * dot(a, a) {
        let unit = own * inverseSqrt(squared);
        return normalize(unit - dot(unit, direction) * direction);
    }
    return any_orthogonal(direction);
}

struct Eigen {
    // In ascending order.
    values: vec3f,
    // Orthonormal and right-handed, in columns.
    vectors: mat3x3f,
}

// Of a symmetric matrix with the off-diagonal entries `off` = (yz, xz, xy), by cyclic Jacobi rotations.
fn symmetric_eigen(diagonal: vec3f, off: vec3f) -> Eigen {
    let most = max(abs(diagonal), abs(off));
    let scale = max(most.x, max(most.y, most.z));
    if !(scale > COINCIDENT_SQUARED) {
        return Eigen(vec3f(0.0), IDENTITY);
    }
    var d = diagonal / scale;
    var o = off / scale;
    var x = IDENTITY[0];
    var y = IDENTITY[1];
    var z = IDENTITY[2];
    for (var sweep = 0u; sweep < SWEEPS; sweep++) {
        let beside = ORTHOGONAL_SQUARED * abs(vec3f(d.y * d.z, d.x * d.z, d.x * d.y));
        if all(o * o <= beside) {
            break;
        }
        var turn = jacobi_rotation(d.x, o.z, d.y);
        d += turn.z * o.z * vec3f(-1.0, 1.0, 0.0);
        o = vec3f(turn.y * o.y + turn.x * o.x, turn.x * o.y - turn.y * o.x, 0.0);
        turn_pair(turn, &x, &y);

        turn = jacobi_rotation(d.x, o.y, d.z);
        d += turn.z * o.y * vec3f(-1.0, 0.0, 1.0);
        o = vec3f(turn.y * o.z + turn.x * o.x, 0.0, turn.x * o.z - turn.y * o.x);
        turn_pair(turn, &x, &z);

        turn = jacobi_rotation(d.y, o.x, d.z);
        d += turn.z * o.x * vec3f(0.0, -1.0, 1.0);
        o = vec3f(0.0, turn.y * o.z + turn.x * o.y, turn.x * o.z - turn.y * o.y);
        turn_pair(turn, &y, &z);
    }
    // Only the last two are needed: the first is their cross product.
    if d.x > d.y {
        d = d.yxz;
        y = x;
    }
    if d.y > d.z {
        d = d.xzy;
        let old = y;
        y = z;
        z = old;
    }
    if d.x > d.y {
        d = d.yxz;
        y = cross(y, z);
    }
    z = normalize(z);
    y = unit_beside(y, z);
    return Eigen(d * scale, mat3x3f(cross(y, z), y, z));
}

// A matrix `M` as `scale A Vᵀ`: the columns of `A` are orthogonal, of descending length, the longest about 1; `V` is a
// rotation.
struct Orthogonalised {
    a: mat3x3f,
    v: mat3x3f,
    scale: f32,
}

// One-sided Jacobi rotations (Hestenes). All columns are accurate to single precision of the longest.
fn orthogonalised(m: mat3x3f) -> Orthogonalised {
    let most = max(max(abs(m[0]), abs(m[1])), abs(m[2]));
    let scale = max(most.x, max(most.y, most.z));
    if !(scale * scale > COINCIDENT_SQUARED) {
        return Orthogonalised(mat3x3f(), IDENTITY, 0.0);
    }
    var a0 = m[0] / scale;
    var a1 = m[1] / scale;
    var a2 = m[2] / scale;
    var v0 = IDENTITY[0];
    var v1 = IDENTITY[1];
    var v2 = IDENTITY[2];
    for (var sweep = 0u; sweep < SWEEPS; sweep++) {
        let squared = vec3f(dot(a0, a0), dot(a1, a1), dot(a2, a2));
        let off = vec3f(dot(a1, a2), dot(a0, a2), dot(a0, a1));
        if all(off * off <= ORTHOGONAL_SQUARED * squared.yxx * squared.zzy) {
            break;
        }
        var turn = jacobi_rotation(squared.x, off.z, squared.y);
        turn_pair(turn, &a0, &a1);
        turn_pair(turn, &v0, &v1);

        turn = jacobi_rotation(dot(a0, a0), dot(a0, a2), squared.z);
        turn_pair(turn, &a0, &a2);
        turn_pair(turn, &v0, &v2);

        turn = jacobi_rotation(dot(a1, a1), dot(a1, a2), dot(a2, a2));
        turn_pair(turn, &a1, &a2);
        turn_pair(turn, &v1, &v2);
    }
    longer_first(&a0, &a1, &v0, &v1);
    longer_first(&a1, &a2, &v1, &v2);
    longer_first(&a0, &a1, &v0, &v1);
    v0 = normalize(v0);
    v1 = unit_beside(v1, v0);
    return Orthogonalised(mat3x3f(a0, a1, a2), mat3x3f(v0, v1, cross(v0, v1)), scale);
}

// The rotation `U Vᵀ` that maximises the trace `tr(Rᵀ M)`, and that maximum.
struct Rotation {
    u: mat3x3f,
    v: mat3x3f,
    trace: f32,
}

// Both `U` and `V` are rotations, whatever the rank of `m` and the sign of its determinant. Where the determinant is
// below 0, the least singular value counts negative: it is the one along the third column of `U`.
fn nearest_rotation(m: mat3x3f) -> Rotation {
    let found = orthogonalised(m);
    let a = found.a;
    if found.scale == 0.0 {
        return Rotation(IDENTITY, IDENTITY, 0.0);
    }
    let x = normalize(a[0]);
    let y = unit_beside(a[1], x);
    let z = cross(x, y);
    let trace = dot(a[0], x) + dot(a[1], y) + dot(a[2], z);
    return Rotation(mat3x3f(x, y, z), found.v, found.scale * trace);
}

// The mean of the constraint's points, from its point 0, to single precision however many they are.
fn centre(i: u32) -> vec3f {
    let first = mean(i);
    if batch.points < MANY_POINTS {
        return first;
    }
    var sum = vec3f(0.0);
    for (var j = 0u; j < batch.points; j++) {
        sum += at(i, j) - first;
    }
    return first + sum / f32(batch.points);
}

struct Scatter {
    diagonal: vec3f,
    // (yz, xz, xy)
    off: vec3f,
}

// `Σ y yᵀ` over the points about `mean`, `y` being their coordinates along the columns of `frame`.
fn scatter(i: u32, mean: vec3f, frame: mat3x3f) -> Scatter {
    var sum = Scatter(vec3f(0.0), vec3f(0.0));
    for (var j = 0u; j < batch.points; j++) {
        let y = (at(i, j) - mean) * frame;
        sum.diagonal += y * y;
        sum.off += y.yxx * y.zzy;
    }
    return sum;
}

// Where the points lie: their mean, the square root of the sum of their squared distances from it (0 where they
// coincide), the axes of least, middle and greatest scatter, and the means of the squared coordinates along them, over
// the size squared.
struct Principal {
    mean: vec3f,
    size: f32,
    axes: mat3x3f,
    spread: vec3f,
}

// A scatter in single precision says nothing of extents below some 3e-4 of the greatest. Along the axes that it has,
// coordinates are accurate to single precision of the greatest extent, and their scatter says what is left to turn.
fn principal(i: u32) -> Principal {
    let mean = centre(i);
    let first = scatter(i, mean, IDENTITY);
    let squared = first.diagonal.x + first.diagonal.y + first.diagonal.z;
    if !(squared > COINCIDENT_SQUARED) {
        return Principal(mean, 0.0, IDENTITY, vec3f(0.0));
    }
    let frame = symmetric_eigen(first.diagonal, first.off).vectors;
    let second = scatter(i, mean, frame);
    let turned = symmetric_eigen(second.diagonal, second.off);
    let axes = frame * turned.vectors;
    let z = normalize(axes[2]);
    let y = unit_beside(axes[1], z);
    let spread = turned.values / (squared * f32(batch.points));
    return Principal(mean, sqrt(squared), mat3x3f(cross(y, z), y, z), spread);
}

// Four points about their mean are half the sums of three vectors with signs: + + +, + − −, − + −, − − +. The scatter
// of the points is that of the vectors.
fn four_points(i: u32) -> mat3x3f {
    let x = at(i, 1u);
    let y = at(i, 2u);
    let z = at(i, 3u);
    return mat3x3f(0.5 * (x - y - z), 0.5 * (y - x - z), 0.5 * (z - x - y));
}

// As `put_centred` for four points, whose residuals are half the sums of three vectors.
fn put_four(i: u32, r: mat3x3f) {
    put_centred(i, 0u, 0.5 * (r[0] + r[1] + r[2]), vec3f(0.0));
    put_centred(i, 1u, 0.5 * (r[0] - r[1] - r[2]), vec3f(0.0));
    put_centred(i, 2u, 0.5 * (r[1] - r[0] - r[2]), vec3f(0.0));
    put_centred(i, 3u, 0.5 * (r[2] - r[0] - r[1]), vec3f(0.0));
}

// The outer product `a bᵀ`.
fn outer(a: vec3f, b: vec3f) -> mat3x3f {
    return mat3x3f(a * b.x, a * b.y, a * b.z);
}
