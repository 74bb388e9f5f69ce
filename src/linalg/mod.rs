//! Linear algebra: the sparse system of the global step, and closed forms in two and three dimensions.

pub mod cholesky;
pub mod lanes;
mod nested_dissection;
mod panels;
pub mod simd;
pub mod small;
