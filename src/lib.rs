//! Constraint-based geometry.
pub mod constraints;
pub mod error;
pub mod linalg;
pub mod problem;
pub mod solver;
