//! Published systems of architectural geometry on top of meshes and the solver.

pub mod canal;
pub mod circle;
#[cfg(test)]
mod random;
pub mod ruled;
pub mod snakes;
