//! The drawing of the command line, for the programs of this repository that draw meshes too.

pub mod animation;
pub mod camera;
pub mod colours;
pub mod picture;
pub mod raster;
pub mod scene;
