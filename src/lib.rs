//! Constraint-based geometry.
pub mod constraints;
pub mod error;
pub mod linalg;
