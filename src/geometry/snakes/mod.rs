//! Circular arc snakes: smooth chains of circular arcs that move while each arc keeps its shape (Bartoň, Shi, Kilian, Wallner,
//! Pottmann 2013, "Circular arc snakes and kinematic surface generation").
//!
//! # Notation
//!
//! A [`Snake`] of `N` arcs has *control points* `p_i`: arc `j` touches the two edges at its control point, its *vertex*, at the
//! distance `d_j = r_j tan(θ_j / 2)`, where `r_j` is its radius, `L_j` its length and `θ_j = L_j / r_j` the angle that it turns by. A
//! closed snake has `N` control points, the vertices in order. An open one has `N + 2`: its ends `p_0` and `p_{N+1}` are where it
//! begins and ends, and arc `j` has the vertex `p_{j+1}`; arcs are counted from 0. Arcs meet in *contact points*: contact `j` is where
//! arc `j` begins, and an open snake has one more where the last arc ends. There the osculating plane turns by the *torsion* angle
//! about the common tangent, which is an edge.
//!
//! Each arc moves rigidly where the distances of control points that are one or two apart stay: these are the snake's
//! [distances](Snake::distances), `2N + 1` of them, or `2N` if it is closed. The positions that keep them are the *shape space*, of
//! dimension `N + 5`, or `N` if the snake is closed with at least 6 arcs; an open one that has to stay on a surface keeps 3 freedoms.

mod arc;
pub mod arc_list;
mod congruence;
pub mod covering;
pub mod curvature_curve;
mod curve_step;
pub mod cycle;
mod drive;
pub mod evolution;
mod face_patch;
mod feet;
pub mod file;
pub mod fit;
pub mod freedoms;
pub mod functionals;
mod linkage;
pub mod mesh_curve;
mod motion;
pub mod projection;
pub mod rails;
pub mod report;
mod samples;
mod snake;
pub mod sweep;
#[cfg(test)]
mod tests;
pub mod velocity;

pub use arc::Arc;
pub use congruence::{Congruence, congruence};
pub use linkage::Linkage;
pub use snake::{ArcShape, Distance, Pose, Snake};
