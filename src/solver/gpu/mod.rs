//! Iterations on the graphics card.

mod card;
mod conjugate_gradients;
mod constants;
mod engine;
mod frame;
mod gather;
mod hard_step;
mod history;
mod local_step;
mod multilevel;
mod sliced;
#[cfg(test)]
pub(in crate::solver) mod tests;

pub(in crate::solver) use card::Card;
pub(in crate::solver) use constants::matrix as constant_matrix;
pub(in crate::solver) use engine::{Engine, Now, Parts, ReadBack};
pub(in crate::solver) use hard_step::HardParts;
pub(in crate::solver) use local_step::projections;

use crate::error::{Error, Status};

pub(in crate::solver) fn internal(what: &str) -> Error {
    Error::new(Status::Internal, what)
}
