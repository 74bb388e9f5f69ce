//! One file per command.

pub mod canal;
pub mod check;
pub mod demo;
pub mod explore;
pub mod recipe;
pub mod ruled;
pub mod snake;
pub mod solve;
pub mod types;
