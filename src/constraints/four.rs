//! Four constraints of one type at once, as fast twins see them.

use crate::linalg::lanes::F4;
use crate::linalg::simd::Isa;

/// What [`super::Constraint::project_four`] sees of four constraints besides their points.
#[derive(Clone, Copy, Debug)]
pub struct Four<'a, T, S> {
    /// The instruction set.
    pub simd: S,
    constraints: [&'a T; 4],
    scalars: [&'a [f64]; 4],
}

impl<'a, T, S: Isa> Four<'a, T, S> {
    /// Four rest states with the scalars in force of each.
    #[inline(always)]
    pub fn new(simd: S, constraints: [&'a T; 4], scalars: [&'a [f64]; 4]) -> Self {
        Self { simd, constraints, scalars }
    }

    /// The same number for all.
    #[inline(always)]
    pub fn splat(&self, value: f64) -> F4<S> {
        F4::splat(self.simd, value)
    }

    /// Scalar `i` of each.
    #[inline(always)]
    pub fn scalar(&self, i: usize) -> F4<S> {
        F4::new(self.simd, self.scalars.map(|scalars| scalars[i]))
    }

    /// The rest states.
    #[inline(always)]
    pub fn rests(&self) -> [&'a T; 4] {
        self.constraints
    }

    /// A number of each rest state.
    #[inline(always)]
    pub fn rest(&self, number: impl Fn(&T) -> f64) -> F4<S> {
        F4::new(self.simd, self.constraints.map(number))
    }
}
