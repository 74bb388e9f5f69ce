//! Super-canal surfaces: circular nets from two or three curves (Mesnil, Douthe, Baverel, Léger 2018, "Morphogenesis of surfaces
//! with planar lines of curvature and application to architectural design").

mod base;
pub mod bases;
pub mod combescure;
pub mod frame;
pub mod inversion;
pub mod m_moulding;
pub mod m_revolution;
mod polyline;
pub mod revolution_centers;
pub mod spherical_guide;
