//! How a solution answers a change of weights.

/// A group of weights that are changed together.
#[derive(Clone, Debug, PartialEq)]
pub enum WeightClass {
    /// `w_h`.
    Handles,
    /// `w_c`.
    Closeness,
    /// `w_f`.
    Fairness,
    /// The weights of the soft constraints of one type.
    Soft(&'static str),
}

/// How far the solution and each soft term move per change of each weight class.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivities {
    /// The classes.
    pub classes: Vec<WeightClass>,
}
