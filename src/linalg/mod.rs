//! Linear algebra: the sparse system of the global step, and closed forms in two and three dimensions.

pub mod banded;
pub mod bfgs;
pub mod cholesky;
pub mod conjugate_gradients;
pub mod dense;
pub mod elimination;
mod fronts;
pub mod gauss_newton;
pub mod householder;
pub mod lanes;
pub mod least_squares;
pub(crate) mod multilevel;
mod nested_dissection;
mod panels;
pub mod positive_part;
pub(crate) mod rows;
pub mod saddle;
pub mod simd;
pub mod small;
pub mod symmetric;
