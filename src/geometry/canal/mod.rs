//! Super-canal surfaces: circular nets from two or three curves (Mesnil, Douthe, Baverel, Léger 2018, "Morphogenesis of surfaces
//! with planar lines of curvature and application to architectural design").
//!
//! A *canal surface* is an envelope of spheres, and its lines of curvature across are circles. *Super-canal surfaces* are its images
//! under Möbius transformations (M) and Combescure transformations (C), which both keep circular nets circular: quads are planar,
//! offsets are at constant distance, and nodes are free of torsion.
//!
//! # Notation
//!
//! A net has rows and columns ([`Grid`](crate::mesh::Grid)). Direction 1 goes from row to row, along the guide curve, which is
//! column 0; direction 2 from column to column, along sections: row `i` is circle `i` of a canal surface. A frame is `t1`, `t2`,
//! `n = t1 × t2`. The guide's points are `P_k`, those on the other side of a strip `Q_k`, lengths across `L_k`.
//!
//! # Where things are
//!
//! - What a surface is: [`surface`] (a base and its chain), [`net`] and [`patch`] (points, frames, Dupin cyclides, refinement),
//!   [`frame`], [`chain`], [`inversion`], [`combescure`], [`families`], [`file`](mod@file).
//! - From curves to a base: [`fit`] (two curves, of which [`normals`], [`two_curves`], [`circle_strip`] and [`circles`] are the
//!   steps), [`strip`] and [`strip_of_circles`], [`smoothing`], [`closing`], [`bases`].
//! - From a wish to a chain: [`m_revolution`] with [`revolution_centers`], [`spherical_guide`], [`m_moulding`], [`c_canal`].
//! - What it is good for: [`quality`], [`properties`], [`folds`], [`membrane`], [`parallel`]; [`node_axes`] and [`panels`] for
//!   building it.

mod base;
pub mod bases;
pub mod c_canal;
pub mod chain;
pub mod circle_strip;
pub mod circles;
pub mod closing;
pub mod combescure;
#[cfg(test)]
mod cyclide;
pub mod families;
pub mod file;
pub mod fit;
pub mod folds;
pub mod frame;
pub mod inversion;
pub mod m_moulding;
pub mod m_revolution;
pub mod membrane;
pub mod net;
pub mod node_axes;
pub mod normals;
pub mod panels;
pub mod parallel;
pub mod patch;
mod polyline;
pub mod properties;
mod quad;
pub mod quality;
pub mod revolution_centers;
mod section_circle;
pub mod smoothing;
mod smoothing_net;
pub mod spherical_guide;
pub mod strip;
pub mod strip_of_circles;
pub mod surface;
pub mod two_curves;
