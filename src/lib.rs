//! Constraint-based geometry: points and constraints go in, a shape that meets them as well as possible comes out.
//!
//! # The mathematics
//!
//! Unknowns are the positions `x` of `n` points. A constraint `c` of weight `w` looks at `A_c x`, a few linear combinations of
//! its points (edges, deviations from a mean, a deformation gradient), and knows the set `C_c` of values that it accepts. With
//! `P_c` the projection onto that set and `m_c` a measure that makes the type independent of the mesh's density (a rest length,
//! area or volume; 1 for most), the solver lowers
//!
//! ```text
//! E(x) = ½ Σ_c w m_c ‖A_c x − P_c(A_c x)‖²  −  f·x            static: an equilibrium under forces f
//! E(x) = ½ Σ_c w m_c ‖A_c x − P_c(A_c x)‖²  +  ½ (x−y)ᵀM(x−y)  dynamic: one implicit Euler step, y the inertial position
//! ```
//!
//! by turns: the *local step* computes all `p_c = P_c(A_c x)`, the *global step* solves `(Σ w m AᵀA + M) x = Σ w m Aᵀp + …`
//! with one matrix, factorised once. Sources: Deuss et al. 2015, "ShapeOp"; Bouaziz et al. 2012, "Shape-Up", and 2014,
//! "Projective Dynamics".
//!
//! # The flow
//!
//! ```text
//! Grasshopper · Python · C# · C/C++ · Java        Rust programs      command line
//!         │ arrays, names, handles                     │                 │ files
//!         ▼                                            │                 ▼
//!    capi ─ null/length/finite checks,                 │            cli (bin) ─ progress, pictures, reports
//!         │ panic guard, status codes                  │                 │
//!         ▼                                            ▼                 ▼
//!    problem ─ points + constraint signatures (type, indices, weight, scalars) + forces + settings; pure data
//!         │                                  ▲
//!         ▼                                  │ recipes: "planarise these faces"
//!    constraints ─ per type: projection ·    │
//!         │        rows · scalars · violation│
//!         ▼                               geometry ─ canal · ruled · snakes
//!    linalg ─ AᵀA, ordering, factor, solve   ▲
//!         │                               mesh ─ files, topology, measures, grids, curves
//!         ▼
//!    solver ─ local step ⇄ global step; static, dynamic
//!         ▼
//!    points + report (iterations, energy, violations, outcome, timings)
//! ```
//!
//! # An example
//!
//! A warped quad that should become planar while its corners stay near where they are:
//!
//! ```
//! use glam::DVec3;
//! use shapeop::solver::{SolveOptions, Solver};
//! use std::ops::ControlFlow;
//!
//! let corners = [[0.0, 0.0, 0.1], [1.0, 0.0, -0.1], [1.0, 1.0, 0.1], [0.0, 1.0, -0.1]].map(DVec3::from);
//! let mut solver = Solver::new();
//! solver.set_points(&corners)?;
//! let plane = solver.add_constraint("Plane", &[0, 1, 2, 3], 1.0)?;
//! for corner in 0..4 {
//!     solver.add_constraint("Closeness", &[corner], 0.01)?;
//! }
//! solver.init()?;
//! let report = solver.solve_until(&SolveOptions::default(), &mut |_| ControlFlow::Continue(()))?;
//! assert!(solver.violations()[plane] < 0.001 && report.energy_after < report.energy_before);
//! # Ok::<(), shapeop::error::Error>(())
//! ```
#![warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]
#![deny(unsafe_code)]

#[allow(unsafe_code, reason = "the C boundary; nowhere else")]
pub mod capi;
pub mod constraints;
pub mod error;
pub mod geometry;
pub mod linalg;
pub mod mesh;
pub mod problem;
pub mod solver;

/// The pages with code in them, so that their code is compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../docs/acceleration.md")]
struct Acceleration;

#[cfg(doctest)]
#[doc = include_str!("../docs/adding-a-constraint.md")]
struct AddingAConstraint;

#[cfg(doctest)]
#[doc = include_str!("../docs/canal.md")]
struct SuperCanalSurfaces;

#[cfg(doctest)]
#[doc = include_str!("../docs/ruled.md")]
struct RuledFreeForms;

#[cfg(doctest)]
#[doc = include_str!("../docs/snakes.md")]
struct CircularArcSnakes;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
