//! Constraint-based geometry.
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

pub mod constraints;
pub mod error;
pub mod linalg;
pub mod problem;
pub mod solver;
