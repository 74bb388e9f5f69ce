//! What can be asked for: commands, options, and the help that teaches them.

pub mod canal;
pub mod links;
pub mod ruled;
pub mod snake;

use std::path::PathBuf;

use clap::builder::styling::{AnsiColor, Styles};
use clap::{Args, Parser, Subcommand, ValueEnum};
use shapeop::mesh::Format;
use shapeop::problem::Acceleration;
use shapeop::problem::recipes::{Anchors, Fairness, RecipeOptions};
use shapeop::solver::Backend;

const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Yellow.on_default().bold())
    .usage(AnsiColor::Yellow.on_default().bold())
    .literal(AnsiColor::Cyan.on_default())
    .placeholder(AnsiColor::Green.on_default());

/// Makes freeform meshes buildable: planar, circular or regular faces, equal edges, smooth surfaces.
#[derive(Debug, Parser)]
#[command(name = "shapeop", version, styles = STYLES, arg_required_else_help = true, propagate_version = true)]
#[command(after_help = "\
Examples:
  shapeop demo                                   what it does, on a mesh that it carries
  shapeop check roof.obj                         how planar is it? the worst faces by name
  shapeop planarize roof.obj                     planar faces, near the design
  shapeop planarize roof.obj --closeness 0.001   more planar, less near
  shapeop rationalize roof.obj                   planar to the last digits, and fair
  shapeop solve problem.json                     any set of constraints
  shapeop explore problem.json --handles moves.json   a drag, hard constraints met all the way
  shapeop canal                                  surfaces of planar circular quads from curves
  shapeop ruled roof.obj                         strips of straight lines for a surface curved like a saddle
  shapeop snake                                  surfaces of many copies of a few circular arcs
  shapeop types                                  the constraints there are

Files: OBJ, OFF and PLY with polygons of any size. The order of points and faces stays as it is.
Exit code: 0 done, 1 refused, 2 wrong options, 3 hard constraints contradict each other (a shape that meets the others is written), \
130 stopped with Ctrl-C (what was reached is written).")]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
    /// Print nothing but errors
    #[arg(short, long, global = true, help_heading = "Output")]
    pub quiet: bool,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Planarise a freeform mesh that the program carries, and write mesh, report and pictures
    Demo(DemoArgs),
    /// Solve a problem file: points, constraints, forces, settings
    #[command(after_help = "\
Examples:
  shapeop solve examples/circularize.json
  shapeop solve cloth.json --steps 200           dynamic: 200 time steps, a picture of some frames

Constraints that are \"hard\" are met exactly; if they contradict each other, a small set of them is named, and the exit \
code is 3.
The form of the file is docs/problem.schema.json. Faces (or edges) in it are what the pictures show.")]
    Solve(SolveArgs),
    /// Make every face planar
    #[command(after_help = "\
Examples:
  shapeop planarize roof.obj
  shapeop planarize roof.obj --closeness 0.001 --anchors boundary
  shapeop planarize roof.obj --fairness 0.1 --format ply --picture svg -o results

Builds: Plane for each face of more than 3 corners, Closeness for each point.
The smaller --closeness, the more planar and the farther from the design. A mesh whose faces follow the lines of \
curvature needs little; a hypar ruled both ways cannot become planar and stay what it is.")]
    Planarize(RecipeArgs),
    /// Give every face a circumscribed circle (which makes it planar too)
    #[command(after_help = "\
Examples:
  shapeop circularize roof.obj --closeness 0.01

Builds: Circle for each face of more than 3 corners, Closeness for each point. Circular meshes have \
offsets at a constant distance from their corners, which layers and torsion-free beams ask for.")]
    Circularize(RecipeArgs),
    /// Smooth the mesh and its boundary curves
    #[command(after_help = "\
Examples:
  shapeop smooth roof.obj --weight 10 --anchors corners

Builds: Laplacian for each point: against all neighbours inside, along the boundary on it; Closeness for each point.")]
    Smooth(RecipeArgs),
    /// Draw every face towards a regular polygon
    #[command(after_help = "\
Examples:
  shapeop regularize cells.obj --closeness 0.01

Builds: Similarity with the regular polygon for each face, Closeness for each point.")]
    Regularize(RecipeArgs),
    /// Draw every edge towards one length
    #[command(after_help = "\
Examples:
  shapeop equalize net.obj --closeness 0.001
  shapeop equalize net.obj --length 1.2 --anchors boundary

Builds: EdgeStrain for each edge with the length edited, Closeness for each point.")]
    Equalize(EqualizeArgs),
    /// Make every face planar to the last digits (or bound the diagonals of quads), near the design and with fair moves
    #[command(after_help = "\
Examples:
  shapeop rationalize roof.obj
  shapeop rationalize roof.obj --diagonals 1 --anchors corners
  shapeop rationalize roof.obj --closeness 0.05 --fairness 5      smoother moves, farther from the design

Builds: a hard Plane for each face of more than 3 corners; with --diagonals a hard DiagonalDistance for each quad. Of all \
meshes that meet this, the one is found that is nearest to the design and whose moves are fair; what counts is the ratio \
of --fairness to --closeness. Anchors are handles: they give in only where planar faces leave no other way.
A flat face can be cut from a sheet; diagonals within 1 % of an edge let a pane be bent in cold.")]
    #[command(mut_arg("weight", |arg| arg.help("Priority of faces, where not all can be planar")))]
    #[command(mut_arg("closeness", |arg| arg.help("Weight that draws every point to where it was, above 0")))]
    #[command(mut_arg("fairness", |arg| arg.help("Weight of fair moves at every point; 0: ten times the closeness")))]
    Rationalize(RationalizeArgs),
    /// Give every face a circumscribed circle to the last digits, near the design and with fair moves
    #[command(after_help = "\
Examples:
  shapeop circumscribe out/edge_a.fit.obj --anchors boundary      a circular mesh stays what it is
  shapeop circumscribe roof.obj --closeness 0.05 --fairness 5     smoother moves, farther from the design

Builds: a hard Circle for each face of more than 3 corners. Of all meshes that meet this, the one is found that is nearest to \
the design and whose moves are fair. Anchors are handles. It is where exploring goes on from a circular mesh, such as \
those that `shapeop canal` makes. Far from any circular mesh it takes many iterations; the report says what is left.")]
    #[command(mut_arg("weight", |arg| arg.help("Priority of faces, where not all can have a circle")))]
    #[command(mut_arg("closeness", |arg| arg.help("Weight that draws every point to where it was, above 0")))]
    #[command(mut_arg("fairness", |arg| arg.help("Weight of fair moves at every point; 0: ten times the closeness")))]
    Circumscribe(RecipeArgs),
    /// Replay a drag: handles move frame by frame, hard constraints stay met; write every frame
    #[command(after_help = "\
Examples:
  shapeop explore examples/explore.json --handles examples/explore_moves.json
  shapeop explore roof.json --handles drag.json --budget-ms 16        as at 60 frames a second
  shapeop explore roof.json --handles drag.json --picture svg -o results

The problem is one for solve, with \"hard\": true at constraints, \"handles\" and an \"objective\". The moves:

  {\"version\": 1, \"frames\": [
    {\"handles\": [{\"point\": 84, \"target\": [0, 0, 5]}]},      a point becomes a handle, or its target moves
    {\"handles\": [{\"point\": 84, \"target\": [0, 0, 6]}], \"releases\": [12]},      and handle 12 is let go
    {}]}                                            nothing changes: the solver goes on

Writes a mesh per frame, the mesh of the end (solved without a limit of time), a picture of some frames, a plot of the \
distance from the final shape over time, and a report. Prints what doubling each weight would do, or which hard \
constraints contradict each other (exit code 3).")]
    Explore(ExploreArgs),
    /// Measure a mesh: planarity, edges, angles; a histogram, the worst faces by name
    #[command(after_help = "\
Examples:
  shapeop check roof.obj
  shapeop check roof.obj --limit 0.5 --worst 20
  shapeop check roof.obj --json > roof.json

Planarity of a quad is the distance between its diagonals over their mean length; of any other face, the distance \
of the farthest corner from the best-fit plane over the face's mean edge. Faces and points count from 0.")]
    Check(CheckArgs),
    /// Super-canal surfaces: planar circular quads from curves; panels and beams for the workshop
    Canal(canal::CanalArgs),
    /// Ruled free forms: strips of straight lines for a surface curved like a saddle; planks for the workshop
    Ruled(Box<ruled::RuledArgs>),
    /// Circular arc snakes: surfaces swept by chains of arcs that keep their shapes; linkages that flex
    Snake(snake::SnakeArgs),
    /// List the constraint types, or explain one
    #[command(after_help = "\
Examples:
  shapeop types
  shapeop types EdgeStrain
  shapeop types --json")]
    Types(TypesArgs),
}

#[derive(Debug, Args)]
pub struct DemoArgs {
    #[command(flatten)]
    pub iterate: IterateArgs,
    #[command(flatten)]
    pub output: OutputArgs,
}

#[derive(Debug, Args)]
pub struct SolveArgs {
    /// The problem file (JSON)
    pub problem: PathBuf,
    /// Time steps of a dynamic problem [default: what the file says]
    #[arg(long, value_name = "N")]
    pub steps: Option<u32>,
    #[command(flatten)]
    pub iterate: IterateArgs,
    #[command(flatten)]
    pub output: OutputArgs,
}

#[derive(Debug, Args)]
pub struct RecipeArgs {
    /// The mesh file (.obj, .off or .ply)
    pub mesh: PathBuf,
    #[command(flatten)]
    pub goal: GoalArgs,
    #[command(flatten)]
    pub iterate: IterateArgs,
    #[command(flatten)]
    pub output: OutputArgs,
}

#[derive(Debug, Args)]
pub struct EqualizeArgs {
    /// The length that all edges shall have, in model units [default: their mean]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true, help_heading = "Goal")]
    pub length: Option<f64>,
    #[command(flatten)]
    pub recipe: RecipeArgs,
}

#[derive(Debug, Args)]
pub struct RationalizeArgs {
    /// Let the diagonals of quads be so far apart, in percent of the mean edge, instead of planar [default: planar]
    #[arg(long, value_name = "PERCENT", value_parser = parse_limit, allow_negative_numbers = true, help_heading = "Goal")]
    pub diagonals: Option<f64>,
    #[command(flatten)]
    pub recipe: RecipeArgs,
}

#[derive(Debug, Args)]
pub struct ExploreArgs {
    /// The problem file (JSON)
    pub problem: PathBuf,
    /// The file of the moves (JSON), frame by frame
    #[arg(long, value_name = "MOVES")]
    pub handles: PathBuf,
    /// Milliseconds for each frame; 0: as long as it takes
    #[arg(long, value_name = "MS", default_value_t = 0.0, value_parser = parse_budget, allow_negative_numbers = true)]
    pub budget_ms: f64,
    /// Sweeps at most for each frame [default: max_iterations of the problem]
    #[arg(long, value_name = "N")]
    pub iterations: Option<u32>,
    /// Threads; 0: as many as the machine has. The result does not depend on it, unless time runs out
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    #[command(flatten)]
    pub output: OutputArgs,
}

/// What a recipe takes.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Goal")]
pub struct GoalArgs {
    /// Weight of the goal
    #[arg(long, value_name = "W", allow_negative_numbers = true, default_value_t = 1.0)]
    pub weight: f64,
    /// Weight that draws every point to where it was; 0: none
    #[arg(long, value_name = "W", allow_negative_numbers = true, default_value_t = 0.05)]
    pub closeness: f64,
    /// Weight of fairness at every point; 0: none
    #[arg(long, value_name = "W", allow_negative_numbers = true, default_value_t = 0.0)]
    pub fairness: f64,
    /// What fairness asks for
    #[arg(long, value_name = "KIND", value_enum, default_value = "keep-detail")]
    pub fairness_kind: FairnessKind,
    /// Points that keep their place: "corners", "boundary", indices from 0 and ranges, separated by commas
    #[arg(long, value_name = "LIST", default_value = "", value_parser = parse_anchors, hide_default_value = true)]
    pub anchors: Anchors,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum FairnessKind {
    /// Neighbours move alike: folds and details stay
    KeepDetail,
    /// The mesh is smooth: details go
    Smooth,
}

impl GoalArgs {
    pub fn options(&self) -> RecipeOptions {
        RecipeOptions {
            weight: self.weight,
            closeness: self.closeness,
            fairness: self.fairness,
            fairness_kind: match self.fairness_kind {
                FairnessKind::KeepDetail => Fairness::KeepDetail,
                FairnessKind::Smooth => Fairness::Smooth,
            },
            anchors: self.anchors.clone(),
        }
    }
}

/// When to stop.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Iteration")]
pub struct IterateArgs {
    /// Iterations at most (dynamic: within each time step) [default: what the problem says; 2000 for a mesh]
    #[arg(long, value_name = "N")]
    pub iterations: Option<u32>,
    /// Stop when no point moves farther in an iteration, relative to the bounding-box diagonal [default: what the problem
    /// says; 1e-6 for a mesh]
    #[arg(long, value_name = "RATIO", allow_negative_numbers = true)]
    pub tolerance: Option<f64>,
    /// Stop after so many seconds (dynamic: all time steps together); 0: no limit [default: what the problem says]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub seconds: Option<f64>,
    /// How iterations are accelerated [default: what the problem says; automatic, which is quasi-newton, for a mesh]
    #[arg(long, value_name = "METHOD", value_enum)]
    pub acceleration: Option<AccelerationKind>,
    /// Threads; 0: as many as the machine has. The result does not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
    /// What iterates. The report says what did, and why
    #[arg(long, value_name = "BACKEND", value_enum, default_value = "cpu")]
    pub backend: BackendKind,
}

#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum BackendKind {
    /// The processor
    #[default]
    Cpu,
    /// The graphics card; refused where there is none, and by a program that was built without the feature "gpu"
    Gpu,
    /// The card where it is there and faster, else the processor
    Automatic,
}

impl From<BackendKind> for Backend {
    fn from(kind: BackendKind) -> Self {
        match kind {
            BackendKind::Cpu => Self::Cpu,
            BackendKind::Gpu => Self::Gpu,
            BackendKind::Automatic => Self::Automatic,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum AccelerationKind {
    /// Plain iterations
    None,
    /// Safeguarded Anderson acceleration
    Anderson,
    /// L-BFGS with a line search
    QuasiNewton,
}

impl From<AccelerationKind> for Acceleration {
    fn from(kind: AccelerationKind) -> Self {
        match kind {
            AccelerationKind::None => Self::None,
            AccelerationKind::Anderson => Self::Anderson,
            AccelerationKind::QuasiNewton => Self::QuasiNewton,
        }
    }
}

/// What to write and how.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub struct OutputArgs {
    /// Folder to write into; it is made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Format of the mesh [default: that of the mesh read, else obj]
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub format: Option<MeshFormat>,
    /// Format of the pictures
    #[arg(long, value_name = "FORMAT", value_enum, default_value = "png")]
    pub picture: PictureFormat,
    /// The planarity that is still good enough, in percent: marked in the picture, counted in the report. 0.3 % of a
    /// diagonal is 3 mm in a metre
    #[arg(long, value_name = "PERCENT", default_value_t = 0.3, value_parser = parse_limit, allow_negative_numbers = true)]
    pub limit: f64,
    /// What the picture shows
    #[arg(long, alias = "color", value_name = "WHAT", value_enum, default_value = "auto")]
    pub colour: Colour,
    /// Print the report (JSON) instead of the table
    #[arg(long)]
    pub json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum MeshFormat {
    Obj,
    Off,
    /// Binary PLY
    Ply,
    /// PLY as text
    PlyText,
}

impl From<MeshFormat> for Format {
    fn from(format: MeshFormat) -> Self {
        match format {
            MeshFormat::Obj => Self::Obj,
            MeshFormat::Off => Self::Off,
            MeshFormat::Ply => Self::Ply,
            MeshFormat::PlyText => Self::PlyText,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PictureFormat {
    Png,
    Svg,
    /// No pictures
    None,
}

impl PictureFormat {
    pub fn extension(self) -> Option<&'static str> {
        match self {
            Self::Png => Some("png"),
            Self::Svg => Some("svg"),
            Self::None => None,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Colour {
    /// What the command is about
    Auto,
    /// Planarity of faces, 0 to 1 %
    Planarity,
    /// Distance of corners from a circle over the mean edge, 0 to 1 %
    Circularity,
    /// Distance of corners from a regular polygon over the mean edge, 0 to 10 %
    Regularity,
    /// Strain of the EdgeStrain constraints: blue tension, red compression
    Strain,
    /// Deviation of edges from their mean length: blue longer, red shorter
    Lengths,
    /// How far the corners moved over the mean edge
    Displacement,
    /// No colours
    None,
}

#[derive(Debug, Args)]
pub struct CheckArgs {
    /// The mesh file (.obj, .off or .ply)
    pub mesh: PathBuf,
    /// The planarity that is still good enough, in percent
    #[arg(long, value_name = "PERCENT", default_value_t = 0.3, value_parser = parse_limit, allow_negative_numbers = true)]
    pub limit: f64,
    /// How many of the worst faces to name
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub worst: usize,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct TypesArgs {
    /// Explain this type only
    pub name: Option<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

fn parse_limit(text: &str) -> Result<f64, String> {
    let limit = text.parse::<f64>().ok().filter(|limit| *limit > 0.0 && limit.is_finite());
    limit.ok_or_else(|| "expected a number above 0".to_owned())
}

fn parse_budget(text: &str) -> Result<f64, String> {
    let budget = text.parse::<f64>().ok().filter(|budget| *budget >= 0.0 && budget.is_finite());
    budget.ok_or_else(|| "expected a number of at least 0".to_owned())
}

/// Reads "corners,boundary,3,10-12".
fn parse_anchors(text: &str) -> Result<Anchors, String> {
    let mut anchors = Anchors::default();
    for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let range = part.split_once('-').unwrap_or((part, part));
        match (part, range.0.trim().parse::<u32>(), range.1.trim().parse::<u32>()) {
            ("corners", ..) => anchors.corners = true,
            ("boundary", ..) => anchors.boundary = true,
            (_, Ok(first), Ok(last)) if first <= last && last - first < MAX_RANGE => {
                anchors.points.extend(first..=last);
            }
            _ => {
                return Err(format!(
                    "expected \"corners\", \"boundary\", an index or a range such as 3-7, found \"{part}\""
                ));
            }
        }
    }
    Ok(anchors)
}

/// The longest range of anchors: beyond it a slip of the keyboard is likelier than a mesh.
const MAX_RANGE: u32 = 100_000_000;

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_commands_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn anchors_are_words_indices_and_ranges() {
        let anchors = parse_anchors("corners, 3,10-12").unwrap();
        assert_eq!(anchors, Anchors { points: vec![3, 10, 11, 12], boundary: false, corners: true });
        assert!(parse_anchors("boundary").unwrap().boundary);
        assert_eq!(parse_anchors("").unwrap(), Anchors::default());
        for text in ["corner", "1-", "-1", "5-3", "0-4294967295", "1.5"] {
            let refusal = parse_anchors(text).unwrap_err();
            assert!(refusal.ends_with(&format!("found \"{text}\"")), "{refusal}");
        }
    }
}
