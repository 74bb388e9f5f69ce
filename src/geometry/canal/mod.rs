//! Super-canal surfaces: circular nets from two or three curves (Mesnil, Douthe, Baverel, Léger 2018, "Morphogenesis of surfaces
//! with planar lines of curvature and application to architectural design").

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
pub mod smoothing;
mod smoothing_net;
pub mod spherical_guide;
pub mod strip;
pub mod strip_of_circles;
pub mod surface;
pub mod two_curves;
