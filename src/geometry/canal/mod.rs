//! Super-canal surfaces: circular nets from two or three curves (Mesnil, Douthe, Baverel, Léger 2018, "Morphogenesis of surfaces
//! with planar lines of curvature and application to architectural design").

pub mod circle_strip;
pub mod circles;
pub mod combescure;
pub mod fit;
pub mod frame;
pub mod inversion;
pub mod normals;
pub mod two_curves;
