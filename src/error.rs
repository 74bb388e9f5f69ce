//! Why a call was refused.
//!
//! A refused call returns an [`Error`] and changes nothing. What a solver *found* (converged, unbounded, …) is no error:
//! it is an `Outcome` in the solver's report.

use std::fmt;

/// The kind of refusal, with the number that crosses the C boundary as `shapeop_err`.
///
/// The numbers are frozen: 0 to 3 are those of libShapeOp 0.1.0, new ones are appended from 16 up and never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// The constraint type does not exist, or cannot be edited.
    InvalidConstraintType = 1,
    /// A count (of indices, scalars, points) does not fit.
    InvalidArgumentLength = 2,
    /// The id is no live constraint of that type.
    UnmatchingConstraintId = 3,
    /// A number is outside its domain, or not finite.
    InvalidValue = 16,
    /// An index is out of range.
    IndexOutOfRange = 17,
    /// The id is no live force of that kind.
    UnmatchingForceId = 18,
    /// What is asked for was not prepared yet: a solver was not initialised, or nothing was found that could be told.
    NotInitialised = 19,
    /// A force acts along a motion that no constraint resists.
    Unbounded = 20,
    /// Another call is using the object.
    Busy = 21,
    /// The handle is null, stale or foreign.
    InvalidHandle = 22,
    /// A required pointer is null.
    NullPointer = 23,
    /// A file or text could not be read as what it claims to be.
    InvalidInput = 24,
    /// The system is too large for this machine's memory or for 32-bit indices.
    TooLarge = 25,
    /// An error inside the library: please report it.
    Internal = 26,
    /// The mesh is no grid of quads.
    NotGrid = 27,
    /// Points that must be on one plane are not.
    NotPlanar = 28,
    /// Points that must be on one circle are not.
    NotCircular = 29,
    /// The input is in a special position where no answer is defined: points coincide or are on a line, an image is at
    /// infinity.
    Degenerate = 30,
    /// Two shapes that must meet do not.
    NoIntersection = 31,
    /// No solution exists for this input.
    NoSolution = 32,
    /// Equations do not determine an answer: edges of a quad that are to meet are parallel, or derivatives lose rank.
    Singular = 33,
    /// A ring does not close.
    NotClosed = 34,
    /// The mesh is no oriented surface: an edge has more than two faces, or faces disagree about what is up.
    NotManifold = 35,
    /// The surface is not negatively curved where it must be: it has no asymptotic directions there.
    CurvatureSign = 36,
    /// No consistent choice of directions exists over the whole surface.
    NotOrientable = 37,
    /// Side conditions contradict each other.
    Infeasible = 38,
    /// What is asked for lies outside the surface, or outside the values of a function.
    OutOfDomain = 39,
    /// There is no graphics card to solve on, or not enough of it.
    BackendUnavailable = 40,
    /// The graphics card was lost or refused work.
    BackendFailed = 41,
}

impl Status {
    /// Every status, in the order of its number.
    pub const ALL: &[Self] = &[
        Self::InvalidConstraintType,
        Self::InvalidArgumentLength,
        Self::UnmatchingConstraintId,
        Self::InvalidValue,
        Self::IndexOutOfRange,
        Self::UnmatchingForceId,
        Self::NotInitialised,
        Self::Unbounded,
        Self::Busy,
        Self::InvalidHandle,
        Self::NullPointer,
        Self::InvalidInput,
        Self::TooLarge,
        Self::Internal,
        Self::NotGrid,
        Self::NotPlanar,
        Self::NotCircular,
        Self::Degenerate,
        Self::NoIntersection,
        Self::NoSolution,
        Self::Singular,
        Self::NotClosed,
        Self::NotManifold,
        Self::CurvatureSign,
        Self::NotOrientable,
        Self::Infeasible,
        Self::OutOfDomain,
        Self::BackendUnavailable,
        Self::BackendFailed,
    ];

    /// One line for people, without the details that only an [`Error`] knows.
    pub fn text(self) -> &'static str {
        match self {
            Self::InvalidConstraintType => "the constraint type does not exist or cannot be edited",
            Self::InvalidArgumentLength => "a count does not fit",
            Self::UnmatchingConstraintId => "the id is no constraint of that type",
            Self::InvalidValue => "a number is outside its domain or not finite",
            Self::IndexOutOfRange => "an index is out of range",
            Self::UnmatchingForceId => "the id is no force of that kind",
            Self::NotInitialised => "something must come first: a solver is not initialised, or nothing was found yet",
            Self::Unbounded => "a force acts along a motion that no constraint resists",
            Self::Busy => "another call is using the object",
            Self::InvalidHandle => "the handle is null, was deleted, or never was one of such an object",
            Self::NullPointer => "a required pointer is null",
            Self::InvalidInput => "the input could not be read",
            Self::TooLarge => "the problem is too large for this machine",
            Self::Internal => "an error inside the library",
            Self::NotGrid => "the mesh is no grid of quads",
            Self::NotPlanar => "the points are not on one plane",
            Self::NotCircular => "the points are not on one circle",
            Self::Degenerate => "the input is in a special position where no answer is defined",
            Self::NoIntersection => "two shapes that must meet do not",
            Self::NoSolution => "no solution exists",
            Self::Singular => "equations do not determine an answer, as where edges that must meet are parallel",
            Self::NotClosed => "the ring does not close",
            Self::NotManifold => "the mesh is no oriented surface",
            Self::CurvatureSign => "the surface is not negatively curved",
            Self::NotOrientable => "no consistent choice of directions exists",
            Self::Infeasible => "side conditions contradict each other",
            Self::OutOfDomain => "what is asked for lies outside",
            Self::BackendUnavailable => "there is no graphics card to solve on, or not enough of it",
            Self::BackendFailed => "the graphics card was lost or refused work",
        }
    }
}

/// Why a call was refused: which argument, what was expected, what was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    status: Status,
    place: String,
    reason: String,
}

/// The result of a call that can be refused.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// A refusal without a place; add one with [`Error::at`].
    pub fn new(status: Status, reason: impl Into<String>) -> Self {
        Self { status, place: String::new(), reason: reason.into() }
    }

    /// Puts `place` before the place already there: `indices[2]`, then `constraints[17]`, reads
    /// `constraints[17].indices[2]`. A place in words is followed by a colon: `constraint 17 ("Plane"): indices[2]`.
    #[must_use]
    pub fn at(mut self, place: impl fmt::Display) -> Self {
        self.place = match self.place.as_str() {
            "" => place.to_string(),
            inner => {
                let place = place.to_string();
                let joint = if inner.starts_with('[') {
                    ""
                } else if place.contains(' ') {
                    ": "
                } else {
                    "."
                };
                format!("{place}{joint}{inner}")
            }
        };
        self
    }

    /// Puts `place` in the place of the one already there, for callers whose argument has another name.
    #[must_use]
    pub fn with_place(mut self, place: impl fmt::Display) -> Self {
        self.place = place.to_string();
        self
    }

    /// The kind of refusal.
    pub fn status(&self) -> Status {
        self.status
    }

    /// The argument or the place in a file that erred, such as `constraints[17].indices[2]`; empty if there is none.
    pub fn place(&self) -> &str {
        &self.place
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.place.is_empty() { f.write_str(&self.reason) } else { write!(f, "{}: {}", self.place, self.reason) }
    }
}

impl std::error::Error for Error {}

/// Refuses a number that is not finite.
pub(crate) fn finite(name: &str, value: f64) -> Result<f64> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::new(Status::InvalidValue, format!("expected a finite number, found {value}")).at(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_grows_from_the_inside_out() {
        let error = Error::new(Status::IndexOutOfRange, "5000 is out of range for 4096 points");
        let error = error.at("[2]").at("indices").at("constraints[17]");
        assert_eq!(error.to_string(), "constraints[17].indices[2]: 5000 is out of range for 4096 points");
    }
}
