//! Super-canal surfaces: circular nets from two or three curves (Mesnil, Douthe, Baverel, Léger 2018, "Morphogenesis of surfaces
//! with planar lines of curvature and application to architectural design").

pub mod combescure;
pub mod frame;
pub mod inversion;
pub mod normals;
