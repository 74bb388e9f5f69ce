//! Linear algebra: the sparse system of the global step, and closed forms in two and three dimensions.

pub mod cholesky;
mod panels;
mod simd;
pub mod small;
