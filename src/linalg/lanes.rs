//! Four numbers at a time, one of each of four constraints: plain arrays, which the compiler turns into vector instructions
//! where [`super::simd::dispatch`] lets it.

use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::DVec3;

use super::simd;

/// Four numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct F4(pub [f64; 4]);

macro_rules! lane_wise {
    ($($Trait:ident::$method:ident),*) => {
        $(impl $Trait for F4 {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(std::array::from_fn(|i| self.0[i].$method(other.0[i])))
            }
        })*
    };
}
lane_wise!(Add::add, Sub::sub, Mul::mul, Div::div);

impl Neg for F4 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|value| -value))
    }
}

impl F4 {
    /// The same number four times.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; 4])
    }

    /// `self b + c`, rounded once if `FMA`.
    #[inline(always)]
    pub fn mul_add<const FMA: bool>(self, b: Self, c: Self) -> Self {
        Self(std::array::from_fn(|i| simd::mul_add::<FMA>(self.0[i], b.0[i], c.0[i])))
    }

    /// The roots.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    /// The absolute values.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }

    /// The greater of each two; of no use with NaN.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }))
    }

    /// The lesser of each two; of no use with NaN.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] }))
    }

    /// `yes` where `self > bound`, else `no`.
    #[inline(always)]
    pub fn where_above(self, bound: Self, yes: Self, no: Self) -> Self {
        Self(std::array::from_fn(|i| if self.0[i] > bound.0[i] { yes.0[i] } else { no.0[i] }))
    }
}

/// Four vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct V4 {
    /// Their x coordinates.
    pub x: F4,
    /// Their y coordinates.
    pub y: F4,
    /// Their z coordinates.
    pub z: F4,
}

impl Add for V4 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl Sub for V4 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl Mul<F4> for V4 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: F4) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl V4 {
    /// Four zero vectors.
    pub const ZERO: Self = Self { x: F4([0.0; 4]), y: F4([0.0; 4]), z: F4([0.0; 4]) };

    /// One vector per lane.
    #[inline(always)]
    pub fn gather(vectors: [DVec3; 4]) -> Self {
        Self { x: F4(vectors.map(|v| v.x)), y: F4(vectors.map(|v| v.y)), z: F4(vectors.map(|v| v.z)) }
    }

    /// The vector of lane `i`.
    #[inline(always)]
    pub fn lane(self, i: usize) -> DVec3 {
        DVec3::new(self.x.0[i], self.y.0[i], self.z.0[i])
    }

    /// `self factor + c`.
    #[inline(always)]
    pub fn mul_add<const FMA: bool>(self, factor: F4, c: Self) -> Self {
        Self {
            x: self.x.mul_add::<FMA>(factor, c.x),
            y: self.y.mul_add::<FMA>(factor, c.y),
            z: self.z.mul_add::<FMA>(factor, c.z),
        }
    }

    /// The inner products.
    #[inline(always)]
    pub fn dot<const FMA: bool>(self, other: Self) -> F4 {
        self.x.mul_add::<FMA>(other.x, self.y.mul_add::<FMA>(other.y, self.z * other.z))
    }

    /// The cross products.
    #[inline(always)]
    pub fn cross<const FMA: bool>(self, other: Self) -> Self {
        let minor = |a: F4, b: F4, c: F4, d: F4| a.mul_add::<FMA>(b, -(c * d));
        Self {
            x: minor(self.y, other.z, self.z, other.y),
            y: minor(self.z, other.x, self.x, other.z),
            z: minor(self.x, other.y, self.y, other.x),
        }
    }

    /// `yes` where `size > bound`, else `no`.
    #[inline(always)]
    pub fn where_above(size: F4, bound: F4, yes: Self, no: Self) -> Self {
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
pub fn orthogonal_pair<const FMA: bool>(normal: V4) -> (V4, V4) {
    let (zero, one) = (F4::splat(0.0), F4::splat(1.0));
    let sign = normal.z.where_above(zero, one, -one);
    let a = -(one / (sign + normal.z));
    let b = normal.x * normal.y * a;
    let first = V4 { x: sign * (normal.x * normal.x * a) + one, y: sign * b, z: -(sign * normal.x) };
    let second = V4 { x: b, y: (normal.y * normal.y).mul_add::<FMA>(a, sign), z: -normal.y };
    (first, second)
}

/// The scatter `Σ x xᵀ` of four sets of vectors: its diagonal and its entries `yz`, `zx`, `xy`.
#[inline(always)]
pub fn scatter<const FMA: bool>(x: &[V4]) -> (V4, V4) {
    let (mut diagonal, mut off) = (V4::ZERO, V4::ZERO);
    for p in x {
        diagonal.x = p.x.mul_add::<FMA>(p.x, diagonal.x);
        diagonal.y = p.y.mul_add::<FMA>(p.y, diagonal.y);
        diagonal.z = p.z.mul_add::<FMA>(p.z, diagonal.z);
        off.x = p.y.mul_add::<FMA>(p.z, off.x);
        off.y = p.z.mul_add::<FMA>(p.x, off.y);
        off.z = p.x.mul_add::<FMA>(p.y, off.z);
    }
    (diagonal, off)
}

/// Newton steps to the least eigenvalue: from 0 they rise towards it without passing it, and where it is at most
/// [`LARGEST_LEAST`] of the middle one each step about squares the distance.
const NEWTON_STEPS: usize = 5;

/// The least eigenvalue as a part of the middle one up to which its eigenvector is trusted to the closed form.
const LARGEST_LEAST: f64 = 0.25;

/// The sum of products of two eigenvalues, as a part of the trace squared, from which the closed form is trusted. It is at most
/// three times the middle one as a part of the trace; what the closed form loses against Jacobi rotations is about the square of
/// that part's inverse, in units of round-off.
const LEAST_PRODUCTS: f64 = 0.01;

/// Unit eigenvectors of the least eigenvalues of four scatters, and which lanes the closed form is not accurate for: near-collinear
/// points, and points that are about as far from every plane.
///
/// The least eigenvalue `λ` is the least root of the characteristic polynomial; the eigenvector is the longest cross product of two
/// rows of `A − λ I`.
#[inline(always)]
pub fn least_eigenvector<const FMA: bool>(diagonal: V4, off: V4) -> (V4, [bool; 4]) {
    let trace = diagonal.x + diagonal.y + diagonal.z;
    // A unit trace keeps cubes of tiny and huge coordinates in range; where it is 0, anything will do.
    let scale = trace.where_above(F4::splat(0.0), F4::splat(1.0) / trace, F4::splat(0.0));
    let (d, o) = (diagonal * scale, off * scale);
    // λ³ − λ² + b λ − c.
    let minor_x = d.y.mul_add::<FMA>(d.z, -(o.x * o.x));
    let minor_y = d.z.mul_add::<FMA>(d.x, -(o.y * o.y));
    let minor_z = d.x.mul_add::<FMA>(d.y, -(o.z * o.z));
    let b = minor_x + minor_y + minor_z;
    let c = d.x.mul_add::<FMA>(minor_x, o.z.mul_add::<FMA>(o.x * o.y - o.z * d.z, o.y * (o.z * o.x - o.y * d.y)));
    let (one, two, three) = (F4::splat(1.0), F4::splat(2.0), F4::splat(3.0));
    let mut least = F4::splat(0.0);
    for _ in 0..NEWTON_STEPS {
        let value = (least - one).mul_add::<FMA>(least, b).mul_add::<FMA>(least, -c);
        let slope = three.mul_add::<FMA>(least, -two).mul_add::<FMA>(least, b);
        least = slope.where_above(F4::splat(0.0), least - value / slope, least);
    }
    let shifted = V4 { x: d.x - least, y: d.y - least, z: d.z - least };
    let rows =
        [V4 { x: shifted.x, y: o.z, z: o.y }, V4 { x: o.z, y: shifted.y, z: o.x }, V4 { x: o.y, y: o.x, z: shifted.z }];
    let mut best = rows[0].cross::<FMA>(rows[1]);
    let mut size = best.dot::<FMA>(best);
    for (a, b) in [(1, 2), (2, 0)] {
        let other = rows[a].cross::<FMA>(rows[b]);
        let other_size = other.dot::<FMA>(other);
        best = V4::where_above(other_size, size, other, best);
        size = size.max(other_size);
    }
    let normal = best * (one / size.sqrt());
    // The other two eigenvalues have the sum 1 − λ and the product b − λ (1 − λ): the middle one is about their quotient.
    let sum = one - least;
    let middle = (b - least * sum) / sum;
    let is_doubtful = std::array::from_fn(|i| {
        !(b.0[i] > LEAST_PRODUCTS && least.0[i] < LARGEST_LEAST * middle.0[i] && size.0[i] > 0.0)
    });
    (normal, is_doubtful)
}

/// Sweeps of Jacobi rotations at most: from the fourth on hardly any lane needs one.
const MAX_SWEEPS: usize = 8;

/// Two columns count as orthogonal when the square of their inner product is below this multiple of the product of their squared
/// norms: a few units in the last place of the cosine.
const ORTHOGONAL: f64 = 16.0 * f64::EPSILON * f64::EPSILON;

/// Singular value decompositions `A = Σ_i a_i v_iᵀ` of four matrices with `N` columns.
#[derive(Clone, Copy, Debug)]
pub struct Svd4<const N: usize> {
    /// `a_i = s_i u_i`: orthogonal, in no order.
    pub a: [V4; N],
    /// Their lengths, the singular values.
    pub s: [F4; N],
    /// `v[i][j]` is entry `j` of `v_i`: orthonormal.
    pub v: [[F4; N]; N],
}

/// Decomposes four matrices by one-sided Jacobi rotations, as [`super::small::svd`] does one.
#[inline(always)]
pub fn svd<const N: usize, const FMA: bool>(columns: [V4; N]) -> Svd4<N> {
    let mut a = columns;
    let mut v: [[F4; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| F4::splat(f64::from(u8::from(i == j)))));
    let (zero, one, four) = (F4::splat(0.0), F4::splat(1.0), F4::splat(4.0));
    for _ in 0..MAX_SWEEPS {
        let mut is_orthogonal = true;
        for p in 0..N {
            for q in p + 1..N {
                let (alpha, beta, gamma) = (a[p].dot::<FMA>(a[p]), a[q].dot::<FMA>(a[q]), a[p].dot::<FMA>(a[q]));
                let squared = gamma * gamma;
                is_orthogonal &= (0..4).all(|i| squared.0[i] <= ORTHOGONAL * alpha.0[i] * beta.0[i]);
                // The smaller root of t² + 2τt − 1 = 0 with τ = (β − α)/(2γ), written so that γ may vanish.
                let difference = beta - alpha;
                let sum = difference.abs() + difference.mul_add::<FMA>(difference, four * squared).sqrt();
                let signed = difference.where_above(-F4::splat(f64::MIN_POSITIVE), gamma + gamma, -(gamma + gamma));
                let t = sum.where_above(zero, signed / sum, zero);
                let c = one / t.mul_add::<FMA>(t, one).sqrt();
                let s = t * c;
                (a[p], a[q]) = (
                    V4 {
                        x: c.mul_add::<FMA>(a[p].x, -(s * a[q].x)),
                        y: c.mul_add::<FMA>(a[p].y, -(s * a[q].y)),
                        z: c.mul_add::<FMA>(a[p].z, -(s * a[q].z)),
                    },
                    V4 {
                        x: s.mul_add::<FMA>(a[p].x, c * a[q].x),
                        y: s.mul_add::<FMA>(a[p].y, c * a[q].y),
                        z: s.mul_add::<FMA>(a[p].z, c * a[q].z),
                    },
                );
                for j in 0..N {
                    (v[p][j], v[q][j]) =
                        (c.mul_add::<FMA>(v[p][j], -(s * v[q][j])), s.mul_add::<FMA>(v[p][j], c * v[q][j]));
                }
            }
        }
        if is_orthogonal {
            break;
        }
    }
    Svd4 { a, s: a.map(|column| column.dot::<FMA>(column).sqrt()), v }
}

/// How small the least singular value may be against the greatest for its column to say a direction to many digits.
const LEAST_VALUE: f64 = 1e-4;

impl<const N: usize> Svd4<N> {
    /// The columns of `Σ_i (s'_i/s_i) a_i v_iᵀ`, and in which lanes a singular value is too small to be divided by.
    #[inline(always)]
    pub fn recompose<const FMA: bool>(&self, s: [F4; N], columns: &mut [V4]) -> [bool; 4] {
        let scaled: [V4; N] = std::array::from_fn(|i| self.a[i] * (s[i] / self.s[i]));
        for (j, column) in columns.iter_mut().enumerate() {
            *column = (0..N).fold(V4::ZERO, |sum, i| scaled[i].mul_add::<FMA>(self.v[i][j], sum));
        }
        let greatest = self.s.iter().fold(F4::splat(0.0), |most, &s| most.max(s));
        let least = self.s.iter().fold(greatest, |least, &s| least.min(s));
        std::array::from_fn(|i| !(least.0[i] > LEAST_VALUE * greatest.0[i] && greatest.0[i] < f64::MAX))
    }
}

impl Svd4<3> {
    /// `s` with the sign of the value changed whose singular value is the least, where the determinant of `columns` is below 0.
    #[inline(always)]
    pub fn turn_inside_out<const FMA: bool>(&self, columns: [V4; 3], s: [F4; 3]) -> [F4; 3] {
        let determinant = columns[0].cross::<FMA>(columns[1]).dot::<FMA>(columns[2]);
        let least = self.s[0].min(self.s[1]).min(self.s[2]);
        let is_done = F4::splat(f64::MIN_POSITIVE);
        let mut sign_left = F4::splat(1.0);
        std::array::from_fn(|i| {
            // The first that is not above the least is the least.
            let flips = self.s[i].where_above(least, F4::splat(0.0), sign_left);
            sign_left = flips.where_above(is_done, F4::splat(0.0), sign_left);
            let flipped = flips.where_above(is_done, -s[i], s[i]);
            determinant.where_above(-is_done, s[i], flipped)
        })
    }
}
