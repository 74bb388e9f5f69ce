//! Four numbers at a time, one of each of four constraints.
//!
//! Instructions are inlined only into code that is compiled for their instruction set, so every function between them and
//! [`super::simd::dispatch_lanes`] is `#[inline(always)]`. A closure cannot be marked so: one that computes more than a little
//! should be a loop or a function, or each of its instructions becomes a call.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

use glam::DVec3;
use pulp::{f64x4, m64x4};

use super::simd::Isa;

/// Four numbers, and the instruction set that computes with them.
#[derive(Clone, Copy, Debug)]
pub struct F4<S> {
    value: f64x4,
    simd: S,
}

macro_rules! lane_wise {
    ($($Trait:ident::$method:ident by $instruction:ident),*) => {
        $(impl<S: Isa> $Trait for F4<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { value: self.simd.$instruction(self.value, other.value), simd: self.simd }
            }
        })*
    };
}
lane_wise!(Add::add by add_f64s, Sub::sub by sub_f64s, Mul::mul by mul_f64s, Div::div by div_f64s);

impl<S: Isa> Neg for F4<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: self.simd.neg_f64s(self.value), ..self }
    }
}

impl<S: Isa> F4<S> {
    /// One number per lane.
    #[inline(always)]
    pub fn new(simd: S, [a, b, c, d]: [f64; 4]) -> Self {
        Self { value: f64x4(a, b, c, d), simd }
    }

    /// The same number four times.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self { value: simd.splat_f64s(value), simd }
    }

    /// The number of each lane.
    #[inline(always)]
    pub fn to_array(self) -> [f64; 4] {
        let f64x4(a, b, c, d) = self.value;
        [a, b, c, d]
    }

    /// The instruction set.
    #[inline(always)]
    pub fn simd(self) -> S {
        self.simd
    }

    /// `self b + c`.
    #[inline(always)]
    pub fn mul_add(self, b: Self, c: Self) -> Self {
        Self { value: self.simd.product_and_sum(self.value, b.value, c.value), ..self }
    }

    /// The roots.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self { value: self.simd.sqrt_f64s(self.value), ..self }
    }

    /// The absolute values.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self { value: self.simd.abs_f64s(self.value), ..self }
    }

    /// The greater of each two; of no use with NaN.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self { value: self.simd.max_f64s(self.value, other.value), ..self }
    }

    /// The lesser of each two; of no use with NaN.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Self { value: self.simd.min_f64s(self.value, other.value), ..self }
    }

    /// The lanes where `self > bound`; not those where either is NaN.
    #[inline(always)]
    pub fn above(self, bound: Self) -> Mask<S> {
        Mask { value: self.simd.greater_than_f64s(self.value, bound.value), simd: self.simd }
    }

    /// `yes` where `self > bound`, else `no`.
    #[inline(always)]
    pub fn where_above(self, bound: Self, yes: Self, no: Self) -> Self {
        Self { value: self.simd.select_f64s(self.above(bound).value, yes.value, no.value), ..self }
    }
}

/// Some of four lanes.
#[derive(Clone, Copy, Debug)]
pub struct Mask<S> {
    value: m64x4,
    simd: S,
}

impl<S: Isa> BitAnd for Mask<S> {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self { value: self.simd.and_m64s(self.value, other.value), ..self }
    }
}

impl<S: Isa> BitOr for Mask<S> {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self { value: self.simd.or_m64s(self.value, other.value), ..self }
    }
}

impl<S: Isa> Mask<S> {
    /// No lane.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        F4::splat(simd, 0.0).above(F4::splat(simd, 0.0))
    }

    /// True if lane `i` is in.
    #[inline(always)]
    pub fn has(self, i: usize) -> bool {
        self.simd.bits(self.value) >> i & 1 == 1
    }

    /// True if every lane is in.
    #[inline(always)]
    pub fn all(self) -> bool {
        self.simd.bits(self.value) == 0b1111
    }

    /// True if any lane is in.
    #[inline(always)]
    pub fn any(self) -> bool {
        self.simd.bits(self.value) != 0
    }
}

/// Four vectors.
#[derive(Clone, Copy, Debug)]
pub struct V4<S> {
    /// Their x coordinates.
    pub x: F4<S>,
    /// Their y coordinates.
    pub y: F4<S>,
    /// Their z coordinates.
    pub z: F4<S>,
}

impl<S: Isa> Add for V4<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<S: Isa> Sub for V4<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<S: Isa> Mul<F4<S>> for V4<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: F4<S>) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<S: Isa> V4<S> {
    /// Four zero vectors.
    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        let zero = F4::splat(simd, 0.0);
        Self { x: zero, y: zero, z: zero }
    }

    /// One vector per lane.
    #[inline(always)]
    pub fn gather(simd: S, vectors: [&DVec3; 4]) -> Self {
        let [a, b, c, d] = vectors;
        Self {
            x: F4::new(simd, [a.x, b.x, c.x, d.x]),
            y: F4::new(simd, [a.y, b.y, c.y, d.y]),
            z: F4::new(simd, [a.z, b.z, c.z, d.z]),
        }
    }

    /// The first of `vectors` and the next three at distances of `step`.
    #[inline(always)]
    pub fn gather_every(simd: S, step: usize, vectors: &[DVec3]) -> Self {
        let vectors = &vectors[..3 * step + 1];
        Self::gather(simd, [&vectors[0], &vectors[step], &vectors[2 * step], &vectors[3 * step]])
    }

    /// The vector of each lane.
    #[inline(always)]
    pub fn to_array(self) -> [DVec3; 4] {
        let (x, y, z) = (self.x.to_array(), self.y.to_array(), self.z.to_array());
        let vector = |i: usize| DVec3::new(x[i], y[i], z[i]);
        [vector(0), vector(1), vector(2), vector(3)]
    }

    /// The instruction set.
    #[inline(always)]
    pub fn simd(self) -> S {
        self.x.simd
    }

    /// `self factor + c`.
    #[inline(always)]
    pub fn mul_add(self, factor: F4<S>, c: Self) -> Self {
        Self { x: self.x.mul_add(factor, c.x), y: self.y.mul_add(factor, c.y), z: self.z.mul_add(factor, c.z) }
    }

    /// The inner products.
    #[inline(always)]
    pub fn dot(self, other: Self) -> F4<S> {
        self.x.mul_add(other.x, self.y.mul_add(other.y, self.z * other.z))
    }

    /// The cross products.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        let minor = |a: F4<S>, b: F4<S>, c: F4<S>, d: F4<S>| a.mul_add(b, -(c * d));
        Self {
            x: minor(self.y, other.z, self.z, other.y),
            y: minor(self.z, other.x, self.x, other.z),
            z: minor(self.x, other.y, self.y, other.x),
        }
    }

    /// `yes` where `size > bound`, else `no`.
    #[inline(always)]
    pub fn where_above(size: F4<S>, bound: F4<S>, yes: Self, no: Self) -> Self {
        Self {
            x: size.where_above(bound, yes.x, no.x),
            y: size.where_above(bound, yes.y, no.y),
            z: size.where_above(bound, yes.z, no.z),
        }
    }
}

/// Two unit vectors orthogonal to the unit vector `normal` and to each other.
///
/// Source: Duff et al. 2017, "Building an orthonormal basis, revisited".
#[inline(always)]
pub fn orthogonal_pair<S: Isa>(normal: V4<S>) -> (V4<S>, V4<S>) {
    let [zero, one] = [0.0, 1.0].map(|value| F4::splat(normal.simd(), value));
    let sign = normal.z.where_above(zero, one, -one);
    let a = -(one / (sign + normal.z));
    let b = normal.x * normal.y * a;
    let first = V4 { x: sign * (normal.x * normal.x * a) + one, y: sign * b, z: -(sign * normal.x) };
    let second = V4 { x: b, y: (normal.y * normal.y).mul_add(a, sign), z: -normal.y };
    (first, second)
}

/// The scatter `Σ x xᵀ` of four sets of vectors: its diagonal and its entries `yz`, `zx`, `xy`.
#[inline(always)]
pub fn scatter<S: Isa>(simd: S, x: &[V4<S>]) -> (V4<S>, V4<S>) {
    let (mut diagonal, mut off) = (V4::zero(simd), V4::zero(simd));
    for p in x {
        diagonal.x = p.x.mul_add(p.x, diagonal.x);
        diagonal.y = p.y.mul_add(p.y, diagonal.y);
        diagonal.z = p.z.mul_add(p.z, diagonal.z);
        off.x = p.y.mul_add(p.z, off.x);
        off.y = p.z.mul_add(p.x, off.y);
        off.z = p.x.mul_add(p.y, off.z);
    }
    (diagonal, off)
}

/// Steps of Halley's method to the least eigenvalue: from 0 they rise towards it without passing it, and where it is at most
/// [`LARGEST_LEAST`] of the middle one each step about cubes the distance.
const HALLEY_STEPS: usize = 3;

/// The least eigenvalue as a part of the middle one up to which its eigenvector is trusted to the closed form.
const LARGEST_LEAST: f64 = 0.2;

/// The sum of products of two eigenvalues, as a part of the trace squared, from which the closed form is trusted. It is at most
/// three times the middle one as a part of the trace; what the closed form loses against Jacobi rotations is about the square of
/// that part's inverse, in units of round-off.
const LEAST_PRODUCTS: f64 = 0.01;

/// Eigenvectors of the least eigenvalues of four scatters, the squares of their lengths, and for which the closed form is accurate:
/// not for near-collinear points, nor for points that are about as far from every plane.
///
/// The least eigenvalue `λ` is the least root of the characteristic polynomial; the eigenvector is the longest cross product of two
/// rows of `A − λ I`.
#[inline(always)]
pub fn least_eigenvector<S: Isa>(diagonal: V4<S>, off: V4<S>) -> (V4<S>, F4<S>, Mask<S>) {
    let number = |value| F4::splat(diagonal.simd(), value);
    let [zero, one, two, three] = [0.0, 1.0, 2.0, 3.0].map(number);
    // A unit trace keeps cubes of tiny and huge coordinates in range. Where it is 0, NaN follows, and no bound below holds.
    let scale = one / (diagonal.x + diagonal.y + diagonal.z);
    let (d, o) = (diagonal * scale, off * scale);
    // λ³ − λ² + b λ − c.
    let minor_x = d.y.mul_add(d.z, -(o.x * o.x));
    let minor_y = d.z.mul_add(d.x, -(o.y * o.y));
    let minor_z = d.x.mul_add(d.y, -(o.z * o.z));
    let b = minor_x + minor_y + minor_z;
    let c = d.x.mul_add(minor_x, o.z.mul_add(o.x * o.y - o.z * d.z, o.y * (o.z * o.x - o.y * d.y)));
    let mut least = zero;
    for _ in 0..HALLEY_STEPS {
        let value = (least - one).mul_add(least, b).mul_add(least, -c);
        let slope = three.mul_add(least, -two).mul_add(least, b);
        let half_curvature = three.mul_add(least, -one);
        least = least - value * slope / slope.mul_add(slope, -(value * half_curvature));
    }
    let shifted = V4 { x: d.x - least, y: d.y - least, z: d.z - least };
    let rows =
        [V4 { x: shifted.x, y: o.z, z: o.y }, V4 { x: o.z, y: shifted.y, z: o.x }, V4 { x: o.y, y: o.x, z: shifted.z }];
    let mut best = rows[0].cross(rows[1]);
    let mut squared = best.dot(best);
    for (a, b) in [(1, 2), (2, 0)] {
        let other = rows[a].cross(rows[b]);
        let other_squared = other.dot(other);
        best = V4::where_above(other_squared, squared, other, best);
        squared = squared.max(other_squared);
    }
    // The other two eigenvalues have the sum 1 − λ and the product b − λ (1 − λ): the middle one is about their quotient.
    let least_by_sum = least * (one - least);
    let is_small = (number(LARGEST_LEAST) * (b - least_by_sum)).above(least_by_sum);
    (best, squared, b.above(number(LEAST_PRODUCTS)) & is_small & squared.above(zero))
}

/// Projects four sets of points `x` about their means onto the planes through the means that are nearest to them; returns where
/// that is accurate.
#[inline(always)]
pub fn flatten<S: Isa>(simd: S, x: &[V4<S>], targets: &mut [V4<S>]) -> Mask<S> {
    let (diagonal, off) = scatter(simd, x);
    let (normal, squared, is_accurate) = least_eigenvector(diagonal, off);
    let factor = F4::splat(simd, -1.0) / squared;
    for (target, &point) in targets.iter_mut().zip(x) {
        *target = normal.mul_add(point.dot(normal) * factor, point);
    }
    is_accurate
}

/// Sweeps of Jacobi rotations at most: from the fourth on hardly any lane needs one.
const MAX_SWEEPS: usize = 8;

/// Two columns count as orthogonal when the square of their inner product is below this multiple of the product of their squared
/// norms: a few units in the last place of the cosine.
const ORTHOGONAL: f64 = 16.0 * f64::EPSILON * f64::EPSILON;

/// Singular value decompositions `A = Σ_i a_i v_iᵀ` of four matrices with `N` columns.
#[derive(Clone, Copy, Debug)]
pub struct Svd4<const N: usize, S> {
    /// `a_i = s_i u_i`: orthogonal, in no order.
    pub a: [V4<S>; N],
    /// Their lengths, the singular values.
    pub s: [F4<S>; N],
    /// `v[i][j]` is entry `j` of `v_i`: orthonormal.
    pub v: [[F4<S>; N]; N],
}

/// Decomposes four matrices by one-sided Jacobi rotations, as [`super::small::svd`] does one.
#[inline(always)]
pub fn svd<const N: usize, S: Isa>(simd: S, columns: [V4<S>; N]) -> Svd4<N, S> {
    let mut a = columns;
    let number = |value| F4::splat(simd, value);
    let [zero, one, four] = [0.0, 1.0, 4.0].map(number);
    let mut v = [[zero; N]; N];
    for i in 0..N {
        v[i][i] = one;
    }
    for _ in 0..MAX_SWEEPS {
        let mut is_left = Mask::none(simd);
        for p in 0..N {
            for q in p + 1..N {
                let (alpha, beta, gamma) = (a[p].dot(a[p]), a[q].dot(a[q]), a[p].dot(a[q]));
                let squared = gamma * gamma;
                is_left = is_left | squared.above(number(ORTHOGONAL) * alpha * beta);
                // The smaller root of t² + 2τt − 1 = 0 with τ = (β − α)/(2γ), written so that γ may vanish.
                let difference = beta - alpha;
                let sum = difference.abs() + difference.mul_add(difference, four * squared).sqrt();
                let signed = difference.where_above(number(-f64::MIN_POSITIVE), gamma + gamma, -(gamma + gamma));
                // The cosine and the sine of the angle whose tangent is t = signed/sum.
                let squared = sum.mul_add(sum, signed * signed);
                let scale = one / squared.sqrt();
                let c = squared.where_above(zero, sum * scale, one);
                let s = squared.where_above(zero, signed * scale, zero);
                (a[p], a[q]) = (
                    V4 {
                        x: c.mul_add(a[p].x, -(s * a[q].x)),
                        y: c.mul_add(a[p].y, -(s * a[q].y)),
                        z: c.mul_add(a[p].z, -(s * a[q].z)),
                    },
                    V4 {
                        x: s.mul_add(a[p].x, c * a[q].x),
                        y: s.mul_add(a[p].y, c * a[q].y),
                        z: s.mul_add(a[p].z, c * a[q].z),
                    },
                );
                for j in 0..N {
                    (v[p][j], v[q][j]) = (c.mul_add(v[p][j], -(s * v[q][j])), s.mul_add(v[p][j], c * v[q][j]));
                }
            }
        }
        if !is_left.any() {
            break;
        }
    }
    let mut s = [zero; N];
    for (s, column) in s.iter_mut().zip(a) {
        *s = column.dot(column).sqrt();
    }
    Svd4 { a, s, v }
}

/// How small the least singular value may be against the greatest for its column to say a direction to many digits.
const LEAST_VALUE: f64 = 1e-4;

impl<const N: usize, S: Isa> Svd4<N, S> {
    /// The columns of `Σ_i (s'_i/s_i) a_i v_iᵀ`, and in which lanes none of the singular values is too small to be divided by.
    #[inline(always)]
    pub fn recompose(&self, s: [F4<S>; N], columns: &mut [V4<S>]) -> Mask<S> {
        let number = |value| F4::splat(self.s[0].simd, value);
        let mut scaled = self.a;
        for i in 0..N {
            scaled[i] = scaled[i] * (s[i] / self.s[i]);
        }
        for (j, column) in columns.iter_mut().enumerate() {
            *column = V4::zero(self.s[0].simd);
            for i in 0..N {
                *column = scaled[i].mul_add(self.v[i][j], *column);
            }
        }
        let greatest = self.s.iter().fold(number(0.0), |most, &s| most.max(s));
        let least = self.s.iter().fold(greatest, |least, &s| least.min(s));
        least.above(number(LEAST_VALUE) * greatest) & number(f64::MAX).above(greatest)
    }
}

impl<S: Isa> Svd4<3, S> {
    /// `s` with the sign of the value changed whose singular value is the least, where the determinant of `columns` is below 0.
    #[inline(always)]
    pub fn turn_inside_out(&self, columns: [V4<S>; 3], mut s: [F4<S>; 3]) -> [F4<S>; 3] {
        let number = |value| F4::splat(self.s[0].simd, value);
        let determinant = columns[0].cross(columns[1]).dot(columns[2]);
        let least = self.s[0].min(self.s[1]).min(self.s[2]);
        let [zero, is_done] = [0.0, f64::MIN_POSITIVE].map(number);
        let mut sign_left = number(1.0);
        for i in 0..3 {
            // The first that is not above the least is the least.
            let flips = self.s[i].where_above(least, zero, sign_left);
            sign_left = flips.where_above(is_done, zero, sign_left);
            let flipped = flips.where_above(is_done, -s[i], s[i]);
            s[i] = determinant.where_above(-is_done, s[i], flipped);
        }
        s
    }
}
