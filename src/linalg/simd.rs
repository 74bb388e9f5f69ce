//! Runs a kernel with the widest vector instructions that this machine has, chosen when the program runs.
//!
//! A kernel is plain code over `[f64; 4]`, which the compiler turns into vector instructions where it may use them. With
//! AVX2 and FMA a product and a sum round once, without them twice, so the last bits of results differ between
//! instruction sets. On one machine they are always the same.

use glam::DVec3;

/// A computation that is compiled for more than one instruction set.
pub trait Kernel {
    /// What it computes.
    type Output;

    /// Computes it. Must be `#[inline(always)]`, like everything it calls, to be compiled for the instruction set at hand.
    /// `FMA` says whether [`mul_add`] is one instruction.
    fn run<const FMA: bool>(self) -> Self::Output;
}

/// Runs `kernel` with the widest instruction set.
pub fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(v3) = pulp::x86::V3::try_new() {
        struct Wide<K>(K);
        impl<K: Kernel> pulp::WithSimd for Wide<K> {
            type Output = K::Output;

            #[inline(always)]
            fn with_simd<S: pulp::Simd>(self, _simd: S) -> K::Output {
                self.0.run::<true>()
            }
        }
        return pulp::Simd::vectorize(v3, Wide(kernel));
    }
    // NEON has fused products; without an instruction for them they would be calls of a slow function.
    kernel.run::<{ cfg!(target_arch = "aarch64") }>()
}

/// Three coordinates and a zero, or one number of four constraints.
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
