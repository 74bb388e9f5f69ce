// Singular values of deformation gradients, for the types that act on them. See constraints/deformation.rs.

// Sweeps of rotations at most: three or four do for almost all matrices.
const STRAIN_SWEEPS: u32 = 10u;

// Columns are orthogonal where their inner product is below this multiple of the longer one's square: what is left turns the
// answer by as much, a few units in the last place.
const STRAIN_ORTHOGONAL: f32 = 4e-7;

// Below this multiple of the greatest singular value not even the round-off of the columns is left of one.
const STRAIN_VANISHING: f32 = 1e-8;

// A vector whose part beside another is a smaller part of it has lost too many digits there.
const STRAIN_BESIDE: f32 = 0.01;

// Matrices without a larger entry are zero: their inverse would be infinite.
const STRAIN_ZERO: f32 = 1e-30;

// `A = Σ s_i u_i v_iᵀ`; `u` and `v` are right-handed frames, so that the least singular value has the sign of the determinant.
struct Singular3 {
    s: vec3f,
    u: mat3x3f,
    v: mat3x3f,
}

// The same of two columns; `v` is a rotation.
struct Singular2 {
    s: vec2f,
    u0: vec3f,
    u1: vec3f,
    v0: vec2f,
    v1: vec2f,
}

// Turns two columns in their plane, and what goes with them, so that they are orthogonal. False if they are already.
fn strain_turn(p: ptr<function, vec3f>, q: ptr<function, vec3f>, vp: ptr<function, vec3f>, vq: ptr<function, vec3f>) -> bool {
    let alpha = dot(*p, *p);
    let beta = dot(*q, *q);
    let gamma = dot(*p, *q);
    let most = max(alpha, beta);
    if abs(gamma) <= STRAIN_ORTHOGONAL * most || most < STRAIN_ZERO {
        return false;
    }
    let turn = jacobi_rotation(alpha / most, gamma / most, beta / most);
    turn_pair(turn, p, q);
    turn_pair(turn, vp, vq);
    return true;
}

// The part of the unit axis least along the unit vector `u` that is orthogonal to it, normalised.
fn strain_any_beside(u: vec3f) -> vec3f {
    let a = abs(u);
    var axis = vec3f(1.0, 0.0, 0.0);
    if a.y <= a.x {
        axis = vec3f(0.0, 1.0, 0.0);
    }
    if a.z <= min(a.x, a.y) {
        axis = vec3f(0.0, 0.0, 1.0);
    }
    return normalize(axis - dot(axis, u) * u);
}

// `b` without its part along the unit vector `u`, normalised; any vector beside `u` where `b` vanishes against 1.
fn strain_beside(b: vec3f, u: vec3f) -> vec3f {
    let own = b - dot(b, u) * u;
    let squared = dot(own, own);
    if squared > max(STRAIN_VANISHING * STRAIN_VANISHING, STRAIN_BESIDE * STRAIN_BESIDE * dot(b, b)) {
        return own * inverseSqrt(squared);
    }
    return strain_any_beside(u);
}

fn strain_largest(a: vec3f) -> f32 {
    let b = abs(a);
    return max(max(b.x, b.y), b.z);
}

// By one-sided Jacobi rotations, which keep the digits of small singular values that AᵀA would lose. What the rotations lost is
// made up for at the end: `v` is orthonormalised, the columns are turned by it once more, and `u` is made from them.
fn singular_3(a: mat3x3f) -> Singular3 {
    var found: Singular3;
    found.v = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    let scale = max(max(strain_largest(a[0]), strain_largest(a[1])), strain_largest(a[2]));
    if scale < STRAIN_ZERO {
        found.u = mat3x3f(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0);
        return found;
    }
    let per_scale = 1.0 / scale;
    let scaled = mat3x3f(a[0] * per_scale, a[1] * per_scale, a[2] * per_scale);
    var p = scaled[0];
    var q = scaled[1];
    var r = scaled[2];
    var vp = found.v[0];
    var vq = found.v[1];
    var vr = found.v[2];
    for (var sweep = 0u; sweep < STRAIN_SWEEPS; sweep++) {
        let first = strain_turn(&p, &q, &vp, &vq);
        let second = strain_turn(&p, &r, &vp, &vr);
        let third = strain_turn(&q, &r, &vq, &vr);
        if !(first || second || third) {
            break;
        }
    }
    longer_first(&p, &q, &vp, &vq);
    longer_first(&p, &r, &vp, &vr);
    longer_first(&q, &r, &vq, &vr);
    let v0 = normalize(vp);
    let v1 = normalize(vq - dot(vq, v0) * v0);
    found.v = mat3x3f(v0, v1, cross(v0, v1));
    let turned = scaled * found.v;
    let u0 = normalize(turned[0]);
    let u1 = strain_beside(turned[1], u0);
    found.u = mat3x3f(u0, u1, cross(u0, u1));
    found.s = scale * vec3f(dot(u0, turned[0]), abs(dot(u1, turned[1])), dot(found.u[2], turned[2]));
    return found;
}

fn singular_2(a0: vec3f, a1: vec3f) -> Singular2 {
    var found: Singular2;
    found.v0 = vec2f(1.0, 0.0);
    found.v1 = vec2f(0.0, 1.0);
    let scale = max(strain_largest(a0), strain_largest(a1));
    if scale < STRAIN_ZERO {
        found.u0 = vec3f(0.0, 0.0, 1.0);
        found.u1 = vec3f(0.0, 1.0, 0.0);
        return found;
    }
    let scaled = mat2x3f(a0 / scale, a1 / scale);
    var p = scaled[0];
    var q = scaled[1];
    var vp = vec3f(1.0, 0.0, 0.0);
    var vq = vec3f(0.0, 1.0, 0.0);
    // The first turn is all but exact; the second takes off its round-off.
    if strain_turn(&p, &q, &vp, &vq) {
        strain_turn(&p, &q, &vp, &vq);
    }
    longer_first(&p, &q, &vp, &vq);
    found.v0 = normalize(vp.xy);
    found.v1 = vec2f(-found.v0.y, found.v0.x);
    let b0 = scaled * found.v0;
    let b1 = scaled * found.v1;
    found.u0 = normalize(b0);
    found.u1 = strain_beside(b1, found.u0);
    let s1 = dot(found.u1, b1);
    // Two columns in space have no sign.
    found.u1 = select(-found.u1, found.u1, s1 >= 0.0);
    found.s = scale * vec2f(dot(found.u0, b0), abs(s1));
    return found;
}

// The residual where singular values change by `by`.
fn strain_change_2(svd: Singular2, by: vec2f) -> mat2x3f {
    let first = by.x * svd.u0;
    let second = by.y * svd.u1;
    return mat2x3f(first * svd.v0.x + second * svd.v1.x, first * svd.v0.y + second * svd.v1.y);
}

fn strain_change_3(svd: Singular3, by: vec3f) -> mat3x3f {
    return mat3x3f(by.x * svd.u[0], by.y * svd.u[1], by.z * svd.u[2]) * transpose(svd.v);
}

// The rows of a triangle; point 0 has what is left of 0.
struct Rows2 {
    of_first: vec2f,
    of_second: vec2f,
}

fn rows_2(i: u32) -> Rows2 {
    return Rows2(
        vec2f(coefficient(i, 0u, 1u), coefficient(i, 1u, 1u)),
        vec2f(coefficient(i, 0u, 2u), coefficient(i, 1u, 2u)),
    );
}

// The deformation gradient of a triangle: one column for each row.
fn gradient_2(i: u32, rows: Rows2) -> mat2x3f {
    let e = at(i, 1u);
    let f = at(i, 2u);
    return mat2x3f(
        rows.of_first.x * e + rows.of_second.x * f,
        rows.of_first.y * e + rows.of_second.y * f,
    );
}

// `put_linear` for triangles.
fn put_gradient_2(i: u32, rows: Rows2, residual: mat2x3f) {
    let s = stiffness[i];
    let weighted = s * residual;
    let energies = 0.5 * vec2f(dot(weighted[0], residual[0]), dot(weighted[1], residual[1]));
    if batch.wants_rows != 0u {
        write(i, 0u, vec4f(residual[0], energies.x));
        write(i, 1u, vec4f(residual[1], energies.y));
        return;
    }
    let first = weighted * rows.of_first;
    let second = weighted * rows.of_second;
    write(i, 0u, vec4f(-first - second, energies.x + energies.y));
    write(i, 1u, vec4f(first, 0.0));
    write(i, 2u, vec4f(second, 0.0));
}

// The rows of a tetrahedron: column `j` belongs to point `j + 1`; point 0 has what is left of 0.
fn rows_3(i: u32) -> mat3x3f {
    return mat3x3f(
        coefficient(i, 0u, 1u), coefficient(i, 1u, 1u), coefficient(i, 2u, 1u),
        coefficient(i, 0u, 2u), coefficient(i, 1u, 2u), coefficient(i, 2u, 2u),
        coefficient(i, 0u, 3u), coefficient(i, 1u, 3u), coefficient(i, 2u, 3u),
    );
}

// The deformation gradient of a tetrahedron: one column for each row.
fn gradient_3(i: u32, rows: mat3x3f) -> mat3x3f {
    return mat3x3f(at(i, 1u), at(i, 2u), at(i, 3u)) * transpose(rows);
}

// `put_linear` for tetrahedra.
fn put_gradient_3(i: u32, rows: mat3x3f, residual: mat3x3f) {
    let s = stiffness[i];
    let weighted = s * residual;
    let energies =
        0.5 * vec3f(dot(weighted[0], residual[0]), dot(weighted[1], residual[1]), dot(weighted[2], residual[2]));
    if batch.wants_rows != 0u {
        write(i, 0u, vec4f(residual[0], energies.x));
        write(i, 1u, vec4f(residual[1], energies.y));
        write(i, 2u, vec4f(residual[2], energies.z));
        return;
    }
    let pulls = weighted * rows;
    write(i, 0u, vec4f(-pulls[0] - pulls[1] - pulls[2], energies.x + energies.y + energies.z));
    write(i, 1u, vec4f(pulls[0], 0.0));
    write(i, 2u, vec4f(pulls[1], 0.0));
    write(i, 3u, vec4f(pulls[2], 0.0));
}

// Steps of the linearisation, as many as the processor makes.
const PRODUCT_STEPS: u32 = 4u;

// Singular values beyond this many times those at rest are not gone for: their squares would leave single precision. A shape
// shrunk to a millionth is sent to about 1e11 times its rest shape by the first step.
const PRODUCT_LARGEST: f32 = 1e15;

// Where two singular values are below this multiple of the greatest, the shape is a line within round-off.
const PRODUCT_VANISHING: f32 = 1e-6;

// Products of relative values that are to be larger than this are not gone for either.
const PRODUCT_BOUND: f32 = 1e30;

// Moves singular values so that their product comes within `low..high`, by linearised steps from `s`; see `move_product_into`.
// Everything is relative to the greatest of the values that a step begins at, whatever the power of it.
fn move_product_3(s: vec3f, low: f32, high: f32) -> vec3f {
    var d = vec3f(0.0);
    var moved = s;
    for (var step = 0u; step < PRODUCT_STEPS; step++) {
        let scale = strain_largest(moved);
        if scale < STRAIN_ZERO {
            break;
        }
        let m = moved / scale;
        let product = m.x * m.y * m.z;
        let least = product_bound(low, scale, 3u);
        let excess = product - clamp(product, least, product_bound(high, scale, 3u));
        let g = vec3f(m.y * m.z, m.x * m.z, m.x * m.y);
        let squared = dot(g, g);
        // A shape with two vanishing singular values has no direction to grow in: it stays.
        let vanishing = select(STRAIN_ZERO, PRODUCT_VANISHING * PRODUCT_VANISHING, step == 0u);
        if squared < vanishing || least >= PRODUCT_BOUND {
            break;
        }
        let next = (dot(g, d) - scale * excess) / squared * g;
        if strain_largest(next) > PRODUCT_LARGEST {
            break;
        }
        d = next;
        moved = s + d;
    }
    return moved;
}

// The same of two.
fn move_product_2(s: vec2f, low: f32, high: f32) -> vec2f {
    var d = vec2f(0.0);
    var moved = s;
    for (var step = 0u; step < PRODUCT_STEPS; step++) {
        let scale = max(abs(moved.x), abs(moved.y));
        if scale < STRAIN_ZERO {
            break;
        }
        let m = moved / scale;
        let product = m.x * m.y;
        let least = product_bound(low, scale, 2u);
        let excess = product - clamp(product, least, product_bound(high, scale, 2u));
        let g = m.yx;
        if least >= PRODUCT_BOUND {
            break;
        }
        let next = (dot(g, d) - scale * excess) / dot(g, g) * g;
        if max(abs(next.x), abs(next.y)) > PRODUCT_LARGEST {
            break;
        }
        d = next;
        moved = s + d;
    }
    return moved;
}

// `bound/scale^power`, at most `PRODUCT_BOUND`.
fn product_bound(bound: f32, scale: f32, power: u32) -> f32 {
    var b = bound;
    for (var n = 0u; n < power; n++) {
        b = b / max(scale, b / PRODUCT_BOUND);
    }
    return b;
}
