//! Ruled free forms: a negatively curved surface as strips of straight lines (Flöry, Nagai, Isvoranu, Pottmann, Wallner 2012,
//! "Ruled free forms").
//!
//! Strips of straight lines join smoothly where their rulings follow the *asymptotic curves* of the surface: the curves whose
//! osculating planes are tangent to it. Through each point of a negatively curved surface run two.
//!
//! # Notation
//!
//! The reference surface is a triangle mesh `Ψ` ([`TriangleMesh`](crate::mesh::TriangleMesh)), perhaps of a surface known as a
//! formula ([`ReferenceSurface`](crate::mesh::ReferenceSurface)). At each point `v` a unit vector `a(v)` is tangent to the asymptotic
//! curve of the family chosen: a [`Field`]. Strip boundaries are level sets of a function `f` on `Ψ`, across the asymptotic curves;
//! `∇f` points the way that `a` does. A strip has control points `b_i0` on its first boundary, `b_i1` on its second, and is the
//! B-spline surface `S(u, v) = (1 − v) Σ N_i(u) b_i0 + v Σ N_i(u) b_i1` of degree 3 along its boundaries and 1 along its rulings.
//! Strips [start] between boundaries with rulings along asymptotic curves, and are [optimised](optimise) under [conditions]; a
//! [single] strip between two curves is the least that there is.

pub mod asymptotic;
mod axis;
pub mod boundaries;
#[cfg(test)]
mod boundaries_tests;
mod boundary;
mod bounds;
pub mod conditions;
mod coverage;
mod cuts;
pub mod design;
pub mod export;
mod field;
pub mod file;
pub mod great_circles;
mod layout;
pub mod level_function;
#[cfg(test)]
mod level_function_tests;
mod level_terms;
mod matching;
pub mod optimise;
pub mod orientation;
pub mod periods;
pub mod planar_boundaries;
pub mod planks;
mod pull;
pub mod report;
mod rim;
mod ruling_ends;
pub mod rulings_problem;
pub mod single;
pub mod spherical_image;
pub mod start;
mod stitching;
mod strip;
mod system;
pub mod tangent_section;
pub mod terms;
mod thin_plate;
pub mod tracing;
pub mod trim;
pub mod zebra;

pub use axis::Axis;
pub use boundary::Boundary;
pub use bounds::Bounds;
pub use field::Field;
pub use layout::Joints;
pub use strip::Strip;
