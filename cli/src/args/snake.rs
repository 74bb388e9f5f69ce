//! What can be asked of circular arc snakes.

mod output;
mod start;

use std::path::PathBuf;

use clap::{ArgAction, Args, Subcommand};
use glam::DVec3;
use shapeop::geometry::snakes::cycle;
use shapeop::geometry::snakes::evolution::{Options, Weights};

pub use output::{PositionArgs, SnakeOutputArgs};
pub use start::{CurveStartArgs, FitOptionArgs, Point, RailAt, Spot, StartArgs, Turn, Turns};

use super::links::{parse_list, parse_vector};
use super::ruled::PlaceArgs;

#[derive(Debug, Args)]
#[command(arg_required_else_help = true)]
#[command(after_help = "\
Examples:
  shapeop snake evolve examples/snakes/roof.obj --from 3,-1.5 --toward 0.3,1 --curvature 0.35 --length 3.6 --arcs 6
  shapeop snake evolve examples/snakes/tower.obj --curve examples/snakes/wave.json --arcs 16 --along 0,0,1     up a tower
  shapeop snake sweep examples/snakes/rail_a.csv examples/snakes/rail_b.csv --curve examples/snakes/rung.csv --arcs 6 --snap
  shapeop snake linkage examples/snakes/six_arcs.json --copies 8               an array of arcs that flex together
  shapeop snake curve examples/snakes/roof.obj --from 3,-1.5 --toward 0.3,1 --curvature 0.2,0.35,0.5 --length 3.5
  shapeop snake fit examples/snakes/arch.csv --arcs 5                          arcs along a curve
  shapeop snake check out/arch.fit.snake.json                                  what is a snake like?

A snake is a smooth chain of circular arcs. It moves while every arc keeps its radius and its length; only the planes of \
arcs turn against each other. The surface that it sweeps is made of many copies of a few arcs.
Lengths are in model units, angles in degrees. docs/snakes.md explains it. Source: Bartoň, Shi, Kilian, Wallner, Pottmann 2013.")]
pub struct SnakeArgs {
    #[command(subcommand)]
    pub command: SnakeCommand,
}

#[derive(Debug, Subcommand)]
pub enum SnakeCommand {
    /// Move a snake over a mesh: the surface that it sweeps, and its arcs
    #[command(after_help = "\
Examples:
  shapeop snake evolve examples/snakes/roof.obj --from 3,-1.5 --toward 0.3,1 --curvature 0.35 --length 3.6 --arcs 6
  shapeop snake evolve examples/snakes/roof.obj --curve examples/snakes/arch.csv --arcs 8 --right --pipes 0.05 --lamellae 0.1
  shapeop snake evolve examples/snakes/roof.obj --curve examples/snakes/arch.csv --arcs 8 --fix start --speed 0,-1 --max-deviation 0.2
  shapeop snake evolve examples/snakes/roof.obj --from 3,-1.5 --toward 0.3,1 --curvature 0.33 --length 3.6 --arcs 6 --offset-surface 0.2 --rotation-weight 0.01
  shapeop snake evolve examples/snakes/roof.obj --curve examples/snakes/arch.csv --arcs 6 --right --glide examples/snakes/ridge.csv --snap
  shapeop snake evolve examples/snakes/roof.obj --section 1,0.2,0,2 --arcs 8 --free-radii --along -1,0,0 --second-order --max-deviation 0.4
  shapeop snake evolve examples/snakes/tower.obj --curve examples/snakes/wave.json --arcs 16 --along 0,0,1 --strip --animation

The snake starts along a curve of one curvature (--from ...), a curve file, a plane section of the mesh, or is a file. Sideways \
means within the surface, at right angles to the snake; left is seen from the side that the faces' normals point to.
It goes on until --steps are taken, the arcs would be farther from the mesh than --max-deviation, a rail ends, it is back at its \
start, or cannot move: the report says which, and everything so far is written.
Weights are of squares: raise --rotation-weight to keep torsions, --offset-weight to keep speeds more than the surface.")]
    Evolve(Box<EvolveArgs>),
    /// Move a snake along rails, without a surface: the ends run on two of them, and it glides on the others
    #[command(after_help = "\
Examples:
  shapeop snake sweep examples/snakes/rail_a.csv examples/snakes/rail_b.csv --curve examples/snakes/rung.csv --arcs 6 --snap
  shapeop snake sweep examples/snakes/rail_a.csv examples/snakes/rail_b.csv examples/snakes/rail_c.csv --curve examples/snakes/rung.csv --arcs 6 --snap
  shapeop snake sweep examples/snakes/rail_a.csv examples/snakes/rail_b.csv --curve examples/snakes/rung.csv --arcs 6 --snap --drive-both

The start of the snake runs along the first rail. Its end follows on the second so that both keep their distance; --drive-both \
drives it too, so that both rails end together. On further rails the snake glides, wherever it meets them.
With up to three rails it moves rigidly where it can, and all its positions are congruent: a kinematic surface. --flexible lets \
arcs turn. Rails are curve files (the forms of docs/canal.md), taken as smooth curves through their points; two points are a line.")]
    Sweep(Box<SweepArgs>),
    /// The motion of arcs whose ends are on hinges: one freedom for six arcs, around until it closes
    #[command(after_help = "\
Examples:
  shapeop snake linkage examples/snakes/six_arcs.json
  shapeop snake linkage examples/snakes/six_arcs.json --copies 8 --shift 0.125 --offset 0,0.4,0 --animation
  shapeop snake linkage --radius 1 --angle 68.75 --torsions 114.6,-57.3,85.9,-57.3,114.6 --strip

The file: {\"version\": 1, \"arcs\": [{\"radius\": 1, \"length\": 1.0472}, ...], \"torsions_rad\": [1, -0.7, 0.9, -0.8, 0.6]}, or \
control points as fit writes them. The first and the last arc turn about the edges where they are held; the others go with them. \
Positions of the copies are --shift parts of the whole motion apart.")]
    Linkage(Box<LinkageArgs>),
    /// Arcs along a curve: a snake file for evolve, sweep, linkage and check
    #[command(after_help = "\
Examples:
  shapeop snake fit examples/snakes/arch.csv --arcs 5
  shapeop snake fit examples/snakes/arch.csv --arcs 5 --free-radii
  shapeop snake fit examples/snakes/ring.json --arcs 10

Arcs are of one length; of one radius too, unless --free-radii. Those of a closed snake differ a little, so that it closes. \
More arcs come nearer to the curve.")]
    Fit(FitArgs),
    /// Curves of constant curvature on a mesh, a fan of them for several curvatures
    #[command(after_help = "\
Examples:
  shapeop snake curve examples/snakes/roof.obj --from 3,-1.5 --toward 0.3,1 --curvature 0.35 --length 3.6
  shapeop snake curve examples/snakes/roof.obj --from 3,-1.5 --toward 0.3,1 --curvature 0.2,0.35,0.5 --length 3.5 --turn both

From a point and in a direction there is one curve to the left and one to the right for each curvature above that of the surface \
in that direction, and none below.")]
    Curve(CurveArgs),
    /// Measure a snake: radii, lengths, torsions, freedoms, how exact it is, how near to a mesh
    #[command(after_help = "\
Examples:
  shapeop snake check out/arch.fit.snake.json
  shapeop snake check out/arch.fit.snake.json --mesh examples/snakes/roof.obj
  shapeop snake check examples/snakes/six_arcs.json --json")]
    Check(SnakeCheckArgs),
}

#[derive(Debug, Args)]
pub struct EvolveArgs {
    /// The mesh that the snake moves over (.obj, .off or .ply)
    pub mesh: PathBuf,
    /// Move on the offset of the mesh instead: points moved so far along their normals
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true)]
    pub offset_surface: Option<f64>,
    #[command(flatten)]
    pub start: StartArgs,
    #[command(flatten)]
    pub direction: DirectionArgs,
    #[command(flatten)]
    pub motion: MotionArgs,
    #[command(flatten)]
    pub rails: RailArgs,
    #[command(flatten)]
    pub weights: WeightArgs,
    #[command(flatten)]
    pub output: SnakeOutputArgs,
}

/// Which way a snake moves over a mesh.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Motion")]
pub struct DirectionArgs {
    /// Sideways to the left [default, unless --drive says where to go]
    #[arg(long, group = "way")]
    pub left: bool,
    /// Sideways to the right
    #[arg(long, group = "way")]
    pub right: bool,
    /// All points in one direction
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true, group = "way")]
    pub along: Option<DVec3>,
    /// A point that stays, so that the snake turns about it: start, end or the number of a control point; again for more
    #[arg(long, value_name = "POINT", action = ArgAction::Append)]
    pub fix: Vec<Point>,
}

/// How far and how a snake moves.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Motion")]
pub struct MotionArgs {
    /// The speed of the points, in model units a time; two numbers: at the start and at the end, and between them in between
    #[arg(long, value_name = "S[,S]", value_parser = parse_speeds, allow_hyphen_values = true, default_value = "1")]
    pub speed: Speeds,
    /// Steps at most
    #[arg(long, value_name = "N", default_value_t = Options::default().max_steps)]
    pub steps: usize,
    /// The time of a step; it is halved where it leads too far [default: a fortieth of the snake's length at the greatest speed]
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub step: Option<f64>,
    /// Steps follow accelerations too: longer ones do
    #[arg(long)]
    pub second_order: bool,
    /// What accelerations along the surface count against those across it
    #[arg(long, value_name = "W", default_value_t = Options::default().alpha, allow_negative_numbers = true, requires = "second_order")]
    pub alpha: f64,
    /// Stop before an arc is farther from the mesh than this [default: 1 % of the mesh's diagonal]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub max_deviation: Option<f64>,
    /// Go on where the snake is back at its start
    #[arg(long)]
    pub no_cycle: bool,
}

/// The speed at the start, and at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds(pub [f64; 2]);

fn parse_speeds(text: &str) -> Result<Speeds, String> {
    match parse_list(text)?[..] {
        [both] => Ok(Speeds([both; 2])),
        [start, end] => Ok(Speeds([start, end])),
        ref found => Err(format!("expected one number or two, found {}", found.len())),
    }
}

/// Curves that guide a snake on a mesh.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Rails")]
pub struct RailArgs {
    /// A curve that a control point runs along at --speed; @POINT says which (start, end, a number) [default: the nearer end]
    #[arg(long, value_name = "FILE[@POINT]", action = ArgAction::Append)]
    pub drive: Vec<RailAt>,
    /// A curve that a control point follows on, so that its distance from the point driven first stays
    #[arg(long, value_name = "FILE[@POINT]", action = ArgAction::Append, requires = "drive")]
    pub follow: Vec<RailAt>,
    /// A curve that the snake glides on; @POINT is the number of the contact where they meet first [default: the nearest]
    #[arg(long, value_name = "FILE[@POINT]", action = ArgAction::Append)]
    pub glide: Vec<RailAt>,
    /// Move rails that start beside the snake onto it
    #[arg(long)]
    pub snap: bool,
}

/// What counts how much.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Weights")]
pub struct WeightArgs {
    /// Speeds asked for
    #[arg(long, value_name = "W", default_value_t = Weights::default().offset, allow_negative_numbers = true)]
    pub offset_weight: f64,
    /// Torsions that stay
    #[arg(long, value_name = "W", default_value_t = Weights::default().rotation, allow_negative_numbers = true)]
    pub rotation_weight: f64,
    /// Velocities at right angles to the planes of arcs
    #[arg(long, value_name = "W", default_value_t = Weights::default().orthogonal, allow_negative_numbers = true)]
    pub orthogonal_weight: f64,
    /// Velocities within the surface
    #[arg(long, value_name = "W", default_value_t = Weights::default().tangential, allow_negative_numbers = true)]
    pub tangential_weight: f64,
    /// Torsions stay exactly, so that the snake moves rigidly, as far as rails let it
    #[arg(long)]
    pub keep_torsions: bool,
}

#[derive(Debug, Args)]
pub struct SweepArgs {
    /// Curve files: the rails of the start and of the end, then those that the snake glides on
    #[arg(value_name = "RAIL", num_args = 2.., required = true)]
    pub rails: Vec<PathBuf>,
    /// The snake (JSON), as fit writes it
    #[arg(long, value_name = "FILE", help_heading = "Start", conflicts_with_all = ["curve", "arcs"])]
    pub snake: Option<PathBuf>,
    /// A curve to fit the snake to
    #[arg(long, value_name = "FILE", help_heading = "Start", requires = "arcs", required_unless_present = "snake")]
    pub curve: Option<PathBuf>,
    /// The number of arcs
    #[arg(long, value_name = "N", help_heading = "Start", requires = "curve")]
    pub arcs: Option<usize>,
    #[command(flatten)]
    pub fit: FitOptionArgs,
    /// Move rails that start beside the snake onto it
    #[arg(long, help_heading = "Start")]
    pub snap: bool,
    /// The end runs along its rail by itself, so that both rails end together
    #[arg(long, help_heading = "Motion")]
    pub drive_both: bool,
    /// Arcs may turn against each other, by as little as they can [default with more than three rails]
    #[arg(long, help_heading = "Motion")]
    pub flexible: bool,
    /// A direction that points between are to move in, at --speed
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true, help_heading = "Motion")]
    pub along: Option<DVec3>,
    #[command(flatten)]
    pub motion: MotionArgs,
    /// How much torsions that stay count
    #[arg(long, value_name = "W", default_value_t = 10.0, allow_negative_numbers = true, help_heading = "Weights")]
    pub rotation_weight: f64,
    /// How much speeds in the direction of --along count
    #[arg(long, value_name = "W", default_value_t = Weights::default().offset, allow_negative_numbers = true, help_heading = "Weights")]
    pub offset_weight: f64,
    #[command(flatten)]
    pub output: SnakeOutputArgs,
}

#[derive(Debug, Args)]
pub struct LinkageArgs {
    /// The arcs and torsions, or a snake (JSON)
    #[arg(required_unless_present = "radius", conflicts_with_all = ["radius", "angle", "torsions"])]
    pub arcs: Option<PathBuf>,
    /// The radius of all arcs
    #[arg(long, value_name = "R", allow_negative_numbers = true, help_heading = "Arcs", requires_all = ["angle", "torsions"])]
    pub radius: Option<f64>,
    /// The angle that each arc turns by, below 180
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, help_heading = "Arcs", requires = "radius")]
    pub angle: Option<f64>,
    /// The torsions between arcs, one fewer than arcs
    #[arg(
        long,
        value_name = "DEGREES,...",
        value_delimiter = ',',
        allow_hyphen_values = true,
        help_heading = "Arcs",
        requires = "radius"
    )]
    pub torsions: Vec<f64>,
    /// The angle that the driving arc turns by in a step, at most 11.4
    #[arg(long, value_name = "DEGREES", default_value_t = 1.0, allow_negative_numbers = true, help_heading = "Motion")]
    pub step: f64,
    /// Steps at most
    #[arg(long, value_name = "N", default_value_t = cycle::Options::default().max_steps, help_heading = "Motion")]
    pub steps: usize,
    /// Begin the other way around
    #[arg(long, help_heading = "Motion")]
    pub reverse: bool,
    /// Copies side by side that move together
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = "Array")]
    pub copies: usize,
    /// Where the first copy is in the motion: 0 at the start, 1 at the start again
    #[arg(long, value_name = "PART", default_value_t = 0.0, allow_negative_numbers = true, help_heading = "Array")]
    pub phase: f64,
    /// How much further each copy is than the one before [default: the whole motion divided by the copies]
    #[arg(long, value_name = "PART", allow_negative_numbers = true, help_heading = "Array")]
    pub shift: Option<f64>,
    /// From each copy to the next [default: a fifth of the size, across the hinge that the first arc is on]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true, help_heading = "Array")]
    pub offset: Option<DVec3>,
    #[command(flatten)]
    pub output: SnakeOutputArgs,
}

#[derive(Debug, Args)]
pub struct FitArgs {
    /// The curve (.csv, .json or .obj): open or closed
    pub curve: PathBuf,
    /// The number of arcs
    #[arg(long, value_name = "N")]
    pub arcs: usize,
    #[command(flatten)]
    pub fit: FitOptionArgs,
    #[command(flatten)]
    pub place: PlaceArgs,
}

#[derive(Debug, Args)]
pub struct CurveArgs {
    /// The mesh (.obj, .off or .ply)
    pub mesh: PathBuf,
    #[command(flatten)]
    pub start: CurveStartArgs,
    /// The curvatures, at least those of the surface along the curve; one curve for each
    #[arg(long, value_name = "K,...", value_delimiter = ',', required = true, allow_negative_numbers = true)]
    pub curvature: Vec<f64>,
    /// The length of each curve
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub length: f64,
    /// Which way it turns
    #[arg(long, value_name = "SIDE", value_enum, default_value = "left")]
    pub turn: Turns,
    /// Points of each curve after the first
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub points: usize,
    #[command(flatten)]
    pub place: PlaceArgs,
}

#[derive(Debug, Args)]
pub struct SnakeCheckArgs {
    /// The snake (JSON)
    pub snake: PathBuf,
    /// A mesh that it is to be near to (.obj, .off or .ply)
    #[arg(long, value_name = "MESH")]
    pub mesh: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::super::{Cli, Command};
    use super::*;

    fn parsed(line: &str) -> SnakeCommand {
        match Cli::try_parse_from(line.split(' ')).unwrap().command {
            Command::Snake(args) => args.command,
            _ => panic!("another command"),
        }
    }

    #[test]
    fn evolutions_have_one_start_and_one_way() {
        let line = "shapeop snake evolve a.obj --from -1,0 --toward 0,-1 --curvature 0.5 --length 3 --arcs 6 --speed -1,2 --fix end --fix 3";
        let SnakeCommand::Evolve(args) = parsed(line) else { panic!("another command") };
        assert_eq!((args.motion.speed, args.direction.fix), (Speeds([-1.0, 2.0]), vec![Point::End, Point::Number(3)]));
        assert_eq!((args.start.turn, args.start.from), (Turn::Left, Some(Spot::Over(-1.0, 0.0))));
        for wrong in [
            "evolve a.obj",
            "evolve a.obj --arcs 3",
            "evolve a.obj --from 0,0 --toward 1,0 --curvature 1 --length 2",
            "evolve a.obj --from 0,0 --curvature 1 --length 2 --arcs 3",
            "evolve a.obj --curve c.csv",
            "evolve a.obj --curve c.csv --snake s.json --arcs 3",
            "evolve a.obj --snake s.json --arcs 3",
            "evolve a.obj --snake s.json --left --right",
            "evolve a.obj --snake s.json --follow r.csv",
            "evolve a.obj --snake s.json --speed 1,2,3",
            "evolve a.obj --snake s.json --fix middle",
            "sweep a.csv --arcs 3",
            "sweep a.csv b.csv",
            "sweep a.csv b.csv --arcs 3",
            "sweep a.csv b.csv --snake s.json --arcs 3",
            "linkage",
            "linkage a.json --radius 1",
            "linkage --radius 1 --angle 60",
            "fit a.csv",
            "curve a.obj --from 0,0 --toward 1,0 --length 1",
        ] {
            assert!(Cli::try_parse_from(format!("shapeop snake {wrong}").split(' ')).is_err(), "{wrong}");
        }
    }

    #[test]
    fn rails_say_where_they_start() {
        let line = "shapeop snake evolve a.obj --snake s.json --drive r@x.csv@start --follow q.csv@4 --glide a@b.csv";
        let SnakeCommand::Evolve(args) = parsed(line) else { panic!("another command") };
        let rail = |file: &str, point| RailAt { file: file.into(), point };
        assert_eq!(args.rails.drive, [rail("r@x.csv", Some(Point::Start))]);
        assert_eq!(args.rails.follow, [rail("q.csv", Some(Point::Number(4)))]);
        assert_eq!(args.rails.glide, [rail("a@b.csv", None)]);
    }
}
