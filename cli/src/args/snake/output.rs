//! What is written of a snake that moved.

use clap::Args;

use crate::args::ruled::PlaceArgs;

/// What to write and how.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub struct SnakeOutputArgs {
    #[command(flatten)]
    pub place: PlaceArgs,
    #[command(flatten)]
    pub positions: PositionArgs,
}

/// What is written of the positions.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub struct PositionArgs {
    /// Write only every so many positions of arcs, frames, pipes and lamellae; the last always
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub every: usize,
    /// Intervals of each arc in meshes and polylines
    #[arg(long, value_name = "N", default_value_t = 8)]
    pub per_arc: usize,
    /// Arcs count as one kind where radii and lengths differ by no more than this part
    #[arg(long, value_name = "PART", default_value_t = 1e-6, allow_negative_numbers = true)]
    pub same: f64,
    /// A spot of the mesh counts as covered where the swept surface is this near [default: 1 % of the mesh's diagonal]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub within: Option<f64>,
    /// Write each position as a polyline (NAME.frame-NNN.obj)
    #[arg(long)]
    pub frames: bool,
    /// Write pipes of this radius along the positions: tubular covering
    #[arg(long, value_name = "RADIUS", allow_negative_numbers = true)]
    pub pipes: Option<f64>,
    /// Write lamellae of this depth along the positions: laminar covering. They stand on the mesh; without one each is in its arc's plane
    #[arg(long, value_name = "DEPTH", allow_negative_numbers = true)]
    pub lamellae: Option<f64>,
    /// Lamellae in the planes of arcs, cut from flat sheets
    #[arg(long, requires = "lamellae")]
    pub flat: bool,
    /// A picture of six positions side by side
    #[arg(long)]
    pub strip: bool,
    /// An animated picture (GIF) of the motion
    #[arg(long)]
    pub animation: bool,
}
