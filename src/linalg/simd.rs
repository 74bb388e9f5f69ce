//! Runs a kernel with the widest vector instructions that this machine has, chosen when the program runs.
//!
//! With AVX2 and FMA a product and a sum round once, without them twice, so the last bits of results differ between
//! instruction sets. On one machine they are always the same.

use glam::DVec3;
/// What every machine has: loops over four numbers.
pub use pulp::Scalar256b as Portable;
use pulp::{f64x4, m64x4};

/// Instructions for four numbers at a time. A value is the proof that this machine has them, and takes no memory.
pub trait Isa: pulp::Simd<f64s = f64x4, m64s = m64x4> {
    /// Whether a product and a sum are one instruction, rounded once.
    const FUSES: bool;

    /// `a b + c`, the fastest way.
    fn product_and_sum(self, a: f64x4, b: f64x4, c: f64x4) -> f64x4;

    /// Bit `i` says whether lane `i` is set.
    fn bits(self, mask: m64x4) -> i32;
}

// AVX2 and FMA.
#[cfg(target_arch = "x86_64")]
impl Isa for pulp::x86::V3 {
    const FUSES: bool = true;

    #[inline(always)]
    fn product_and_sum(self, a: f64x4, b: f64x4, c: f64x4) -> f64x4 {
        self.mul_add_f64x4(a, b, c)
    }

    #[inline(always)]
    fn bits(self, mask: m64x4) -> i32 {
        self.avx._mm256_movemask_pd(pulp::cast(mask))
    }
}

impl Isa for Portable {
    // NEON has fused products; without an instruction for them they would be calls of a slow function.
    const FUSES: bool = cfg!(target_arch = "aarch64");

    #[inline(always)]
    fn product_and_sum(self, a: f64x4, b: f64x4, c: f64x4) -> f64x4 {
        let lane = mul_add::<{ Self::FUSES }>;
        f64x4(lane(a.0, b.0, c.0), lane(a.1, b.1, c.1), lane(a.2, b.2, c.2), lane(a.3, b.3, c.3))
    }

    #[inline(always)]
    fn bits(self, m64x4(a, b, c, d): m64x4) -> i32 {
        let bit = |lane: pulp::m64, i: i32| i32::from(lane.is_set()) << i;
        bit(a, 0) | bit(b, 1) | bit(c, 2) | bit(d, 3)
    }
}

/// A computation over [`super::lanes`] that is compiled for more than one instruction set.
pub trait LaneKernel {
    /// What it computes.
    type Output;

    /// Computes it. Must be `#[inline(always)]`, like everything it calls, to be compiled for the instruction set at hand.
    fn run<S: Isa>(self, simd: S) -> Self::Output;
}

/// Runs `kernel` with the widest instruction set.
pub fn dispatch_lanes<K: LaneKernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(v3) = pulp::x86::V3::try_new() {
        struct Wide<K>(pulp::x86::V3, K);
        impl<K: LaneKernel> pulp::NullaryFnOnce for Wide<K> {
            type Output = K::Output;

            #[inline(always)]
            fn call(self) -> K::Output {
                self.1.run(self.0)
            }
        }
        return v3.vectorize(Wide(v3, kernel));
    }
    kernel.run(Portable)
}

/// A computation over plain arrays that is compiled for more than one instruction set. The compiler turns its loops into vector
/// instructions where it can.
pub trait Kernel {
    /// What it computes.
    type Output;

    /// Computes it. Must be `#[inline(always)]`, like everything it calls, to be compiled for the instruction set at hand.
    /// `FMA` says whether [`mul_add`] is one instruction.
    fn run<const FMA: bool>(self) -> Self::Output;
}

/// Runs `kernel` with the widest instruction set.
pub fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    struct Plain<K>(K);
    impl<K: Kernel> LaneKernel for Plain<K> {
        type Output = K::Output;

        #[inline(always)]
        fn run<S: Isa>(self, _simd: S) -> K::Output {
            if S::FUSES { self.0.run::<true>() } else { self.0.run::<false>() }
        }
    }
    dispatch_lanes(Plain(kernel))
}

/// Three coordinates and a zero.
pub type Lanes = [f64; 4];

/// The coordinates of a vector, and a zero.
#[inline(always)]
pub fn lanes(vector: DVec3) -> Lanes {
    [vector.x, vector.y, vector.z, 0.0]
}

/// The vector of three coordinates.
#[inline(always)]
pub fn vector(lanes: Lanes) -> DVec3 {
    DVec3::new(lanes[0], lanes[1], lanes[2])
}

/// `a b + c`, rounded once if `FMA`.
#[inline(always)]
pub fn mul_add<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

/// `c + a x` by lanes.
#[inline(always)]
pub fn add_scaled<const FMA: bool>(c: Lanes, a: f64, x: Lanes) -> Lanes {
    std::array::from_fn(|i| mul_add::<FMA>(a, x[i], c[i]))
}
