//! What can be asked of ruled free forms.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Subcommand, ValueEnum};
use glam::DVec3;
use shapeop::geometry::ruled::boundaries::BoundaryOptions;
use shapeop::geometry::ruled::optimise::Options;
use shapeop::geometry::ruled::planar_boundaries::PlanarOptions;
use shapeop::geometry::ruled::start::StartOptions;

use super::canal::Unit;
use super::links::{parse_four, parse_vector};
use super::{MeshFormat, PictureFormat};

#[derive(Debug, Args)]
#[command(arg_required_else_help = true, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(after_help = "\
Examples:
  shapeop ruled examples/ruled/roof.obj                                     strips across at right angles to the rulings
  shapeop ruled examples/ruled/roof.obj --boundaries equidistant --width 0.6     strips of about one width
  shapeop ruled examples/ruled/roof.obj --boundaries geodesic --levels 8 --zebra     edges that a bent batten follows
  shapeop ruled examples/ruled/roof.obj --normal 1,0,0 --levels 8            edges in parallel planes, exactly
  shapeop ruled examples/ruled/roof.obj --planes 1,0,0,-1.5 --planes 1,0,0,0 --planes 1,0.2,0,1.5
  shapeop ruled examples/ruled/catenoid.obj --family 1 --boundaries conoidal --levels 5 --planks 0.03     stacked planks
  shapeop ruled examples/ruled/saddle.obj --curves examples/ruled/saddle_edges.obj --single     one strip between two curves
  shapeop ruled examples/ruled/tube.obj --levels 16                          a tube: strips all around
  shapeop ruled field examples/ruled/roof.obj                               only the directions that rulings can follow
  shapeop ruled check out/roof.ruled.strips.json examples/ruled/roof.obj     how good are given strips?

A surface that is curved like a saddle everywhere can be made of strips of straight lines that join smoothly, if the lines \
follow its asymptotic curves: there are two families of these, --family chooses. The command finds their directions, the \
boundaries of strips across them, the strips, and the strips that are nearest to the mesh; it writes these as control nets \
(NAME.ruled.strips.json), as NURBS for CAD (NAME.ruled.surfaces.obj), as a mesh cut along the edge of yours, their rulings \
(OBJ and CSV), a report, and pictures of each step.
Lengths are in model units. A file called field, check or planks is ./field and so on.
Source: Flöry, Nagai, Isvoranu, Pottmann, Wallner 2012. docs/ruled.md explains it.")]
pub struct RuledArgs {
    #[command(subcommand)]
    pub command: Option<RuledCommand>,
    /// The reference surface: a mesh of negative curvature (.obj, .off or .ply)
    #[arg(required = true)]
    pub mesh: Option<PathBuf>,
    #[command(flatten)]
    pub field: FieldArgs,
    #[command(flatten)]
    pub boundaries: BoundaryArgs,
    #[command(flatten)]
    pub strips: StripArgs,
    #[command(flatten)]
    pub optimise: OptimiseArgs,
    #[command(flatten)]
    pub output: RuledOutputArgs,
}

#[derive(Debug, Subcommand)]
pub enum RuledCommand {
    /// Only the directions that rulings can follow: both families at each point, a picture of their curves
    #[command(after_help = "\
Examples:
  shapeop ruled field examples/ruled/roof.obj
  shapeop ruled field examples/ruled/helicoid.obj --family 1

Writes NAME.field.csv (a line per point: both directions, principal curvatures, status), a picture and a report. Family 0 has \
negative torsion (a left-handed screw), family 1 positive; that does not depend on how faces are oriented.")]
    Field(FieldCommandArgs),
    /// Judge strips against a mesh: deviation both ways, gaps, kinks, widths, coverage
    #[command(after_help = "\
Examples:
  shapeop ruled check out/roof.ruled.strips.json examples/ruled/roof.obj
  shapeop ruled check out/roof.ruled.strips.json examples/ruled/roof.obj --json")]
    Check(RuledCheckArgs),
    /// Cut conoidal strips into planks: sheets with dimensions, the boards as solids
    #[command(after_help = "\
Examples:
  shapeop ruled planks out/catenoid.ruled.strips.json --planks 0.03 --depth 0.01
  shapeop ruled planks out/catenoid.ruled.strips.json --planks 0.05 --within examples/ruled/catenoid.obj --unit cm

The rulings of a conoidal strip are parallel to a plane, so it can be stacked from planks of one thickness: one SVG sheet per strip \
in true scale. Strips whose rulings are not parallel to a plane are named: make them with --conoidal.")]
    Planks(PlanksArgs),
}

/// Which directions rulings follow.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Field")]
pub struct FieldArgs {
    /// The family of asymptotic curves that rulings follow: 0 (negative torsion) or 1 (positive)
    #[arg(long, value_name = "0|1", default_value_t = 0)]
    pub family: usize,
    /// A direction that the field points along on the whole: it says which boundary is the first [default: x]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub hint: Option<DVec3>,
    /// Go on where directions cannot be given signs: around a flat point, or a hole with an odd turn (needs equidistant boundaries)
    #[arg(long)]
    pub allow_cut: bool,
    /// The part of the points that may have no directions, since the mesh is flat or bulges there
    #[arg(long, value_name = "PART", default_value_t = 0.05, allow_negative_numbers = true)]
    pub max_mask: f64,
    /// Count a point as flat where the Gaussian curvature is above minus this times the square of the greatest curvature
    #[arg(long, value_name = "PART", default_value_t = 1e-6, allow_negative_numbers = true)]
    pub flatness: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BoundaryKind {
    /// At right angles to the rulings
    Orthogonal,
    /// At constant distances: strips of one width
    Equidistant,
    /// Shortest paths on the surface: bent from flat, straight battens
    Geodesic,
    /// In planes: --planes, or --normal with --levels, --width or --values
    Planar,
    /// The rulings of each strip parallel to a plane: by optimisation, or --axes
    Conoidal,
    /// Drawn by hand: --curves
    Drawn,
}

/// Where strips meet.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Boundaries")]
pub struct BoundaryArgs {
    /// What boundaries are like [default: orthogonal, or what --planes, --normal, --axes, --curves ask for]
    #[arg(long, value_name = "KIND", value_enum)]
    pub boundaries: Option<BoundaryKind>,
    /// So many boundaries on the surface, evenly spread [default: 12]
    #[arg(long, value_name = "N", group = "which")]
    pub levels: Option<usize>,
    /// Boundaries about this far from each other
    #[arg(long, value_name = "LENGTH", group = "which", allow_negative_numbers = true)]
    pub width: Option<f64>,
    /// Boundaries at these values of the level function, 0 at its least; with --normal, of normal·x
    #[arg(long, value_name = "F,...", group = "which", value_delimiter = ',', allow_negative_numbers = true)]
    pub values: Option<Vec<f64>>,
    /// A boundary in the plane A x + B y + C z = D; once for each, in order
    #[arg(long, alias = "plane", value_name = "A,B,C,D", value_parser = parse_four, allow_hyphen_values = true)]
    pub planes: Vec<(DVec3, f64)>,
    /// Boundaries in parallel planes with this normal
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true, conflicts_with = "planes")]
    pub normal: Option<DVec3>,
    /// Boundaries drawn by hand: curve files, or OBJ files of several polylines
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["planes", "normal", "which"])]
    pub curves: Vec<PathBuf>,
    /// A conoidal boundary by hand: where the field is orthogonal to this axis; once for each, in order
    #[arg(long, alias = "axis", value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["planes", "normal", "curves", "which"])]
    pub axes: Vec<DVec3>,
    /// One strip between two drawn curves, its rulings not led by a field: for any surface
    #[arg(long, requires = "curves")]
    pub single: bool,
    /// Weights, as NAME=W: of boundaries orthogonal, direction, equidistant, geodesic, conoidal, laplace; of the optimisation \
    /// proximity, beyond, gap, coverage, thin-plate, proximal [default: by kind; 1, 0.01, 1, 1, 1e-6, 1e-4]
    #[arg(long, value_name = "NAME=W,...", value_delimiter = ',')]
    pub weights: Vec<Weight>,
    /// Iterations of the level function at most
    #[arg(long, value_name = "N", default_value_t = 30)]
    pub level_iterations: usize,
    /// Leave out curves shorter than so many strip widths
    #[arg(long, value_name = "WIDTHS", default_value_t = BoundaryOptions::default().least_length, allow_negative_numbers = true)]
    pub least_length: f64,
    /// Plane sections should cross the rulings at no smaller angle; those that do are told
    #[arg(long, value_name = "DEGREES", default_value_t = PlanarOptions::default().least_angle_rad.to_degrees(), allow_negative_numbers = true)]
    pub least_angle: f64,
    /// Refuse plane sections that cross the rulings at a smaller angle than --least-angle
    #[arg(long)]
    pub refuse_oblique: bool,
    /// Use a spherical image that is folded (conoidal)
    #[arg(long)]
    pub allow_folds: bool,
    /// Let boundaries end at the rim of the mesh, and add none beyond it: strips then leave parts uncovered
    #[arg(long)]
    pub no_overshoot: bool,
}

/// How strips are made.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Strips")]
pub struct StripArgs {
    /// Control points of each boundary, at least 4
    #[arg(long, value_name = "N", default_value_t = StartOptions::default().control_count)]
    pub control_points: usize,
    /// Neighbours share their boundary: nothing gapes, and strips have fewer ways to go
    #[arg(long)]
    pub shared: bool,
    /// Rulings of each strip parallel to a plane, exactly [default with --boundaries conoidal or --planks]
    #[arg(long)]
    pub conoidal: bool,
    /// Rulings as they come, also of conoidal boundaries
    #[arg(long, conflicts_with_all = ["conoidal", "planks"])]
    pub no_conoidal: bool,
    /// Boundaries stay in their planes, exactly [default with --planes and --normal]
    #[arg(long)]
    pub planar: bool,
    /// Boundaries that start in planes may leave them
    #[arg(long, conflicts_with = "planar")]
    pub no_planar: bool,
    /// The ends of boundaries stay where they start [default with --single]
    #[arg(long)]
    pub fixed_ends: bool,
    /// The ends of boundaries may move
    #[arg(long, conflicts_with = "fixed_ends")]
    pub free_ends: bool,
    /// The first and the last ruling of each strip keep their directions
    #[arg(long)]
    pub fixed_end_rulings: bool,
}

/// How strips are optimised.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Optimisation")]
pub struct OptimiseArgs {
    /// Iterations at most; 0: the strips as they start
    #[arg(long, value_name = "N", default_value_t = Options::default().max_iterations)]
    pub iterations: usize,
    /// Stop where control points move by less than this part of the mesh's diagonal, or the sum falls by less than this part of it
    #[arg(long, value_name = "PART", default_value_t = Options::default().tolerance, allow_negative_numbers = true)]
    pub tolerance: f64,
    /// Keep strips within this distance of the mesh, where they can be
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub largest_deviation: Option<f64>,
    /// Keep rulings at least this long, where they can be
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub least_width: Option<f64>,
    /// Samples of each strip: so many along for each control point, and across
    #[arg(long, num_args = 2, value_names = ["ALONG", "ACROSS"])]
    pub samples: Option<Vec<usize>>,
}

/// What to write and how.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub struct RuledOutputArgs {
    #[command(flatten)]
    pub place: PlaceArgs,
    /// Do not cut the mesh of strips and their rulings along the edge of the mesh given
    #[arg(long)]
    pub no_trim: bool,
    /// Rulings of each strip in the files and the picture
    #[arg(long, value_name = "N", default_value_t = 25)]
    pub rulings: usize,
    /// Cut conoidal strips into planks of this thickness: one SVG sheet per strip
    #[arg(long, value_name = "THICKNESS", allow_negative_numbers = true)]
    pub planks: Option<f64>,
    /// How far planks reach beyond the rulings on both sides
    #[arg(long, value_name = "LENGTH", default_value_t = 0.0, allow_negative_numbers = true, requires = "planks")]
    pub depth: f64,
    /// What a model unit is, for sheets
    #[arg(long, value_name = "UNIT", value_enum, default_value = "m")]
    pub unit: Unit,
    /// A picture of reflected stripes, which break at kinks
    #[arg(long)]
    pub zebra: bool,
    /// Write strips as a problem for `shapeop solve` (NAME.ruled.problem.json): rulings that stay straight, near the mesh
    #[arg(long)]
    pub problem: bool,
    /// Rulings of that problem are straight to the last digits: for `shapeop explore`
    #[arg(long, requires = "problem")]
    pub hard_rulings: bool,
}

/// Where files go.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub struct PlaceArgs {
    /// Folder to write into; it is made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Format of meshes
    #[arg(long, value_name = "FORMAT", value_enum, default_value = "obj")]
    pub format: MeshFormat,
    /// Format of the pictures
    #[arg(long, value_name = "FORMAT", value_enum, default_value = "png")]
    pub picture: PictureFormat,
    /// Print the report (JSON) instead of the summary
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct FieldCommandArgs {
    /// The mesh file (.obj, .off or .ply)
    pub mesh: PathBuf,
    #[command(flatten)]
    pub field: FieldArgs,
    #[command(flatten)]
    pub place: PlaceArgs,
}

#[derive(Debug, Args)]
pub struct RuledCheckArgs {
    /// The strips (NAME.ruled.strips.json)
    pub strips: PathBuf,
    /// The mesh that they are to be near to (.obj, .off or .ply)
    pub mesh: PathBuf,
    /// Call a strip too wide where its width is above this multiple of the radius of curvature
    #[arg(long, value_name = "RATIO", default_value_t = 0.5, allow_negative_numbers = true)]
    pub feature_ratio: f64,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct PlanksArgs {
    /// The strips (NAME.ruled.strips.json)
    pub strips: PathBuf,
    /// Thickness of the planks
    #[arg(long, alias = "thickness", value_name = "THICKNESS", allow_negative_numbers = true)]
    pub planks: f64,
    /// How far planks reach beyond the rulings on both sides
    #[arg(long, value_name = "LENGTH", default_value_t = 0.0, allow_negative_numbers = true)]
    pub depth: f64,
    /// Cut only those spans of strips that are beside this mesh (.obj, .off or .ply)
    #[arg(long, value_name = "MESH")]
    pub within: Option<PathBuf>,
    /// What a model unit is
    #[arg(long, value_name = "UNIT", value_enum, default_value = "m")]
    pub unit: Unit,
    #[command(flatten)]
    pub place: PlaceArgs,
}

/// What a weight is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WeightName {
    Orthogonal,
    Direction,
    Equidistant,
    Geodesic,
    Conoidal,
    Laplace,
    Proximity,
    Beyond,
    Gap,
    Coverage,
    ThinPlate,
    Proximal,
}

/// The names of weights: first those of boundaries, then those of the optimisation.
pub const WEIGHT_NAMES: [(&str, WeightName); 12] = [
    ("orthogonal", WeightName::Orthogonal),
    ("direction", WeightName::Direction),
    ("equidistant", WeightName::Equidistant),
    ("geodesic", WeightName::Geodesic),
    ("conoidal", WeightName::Conoidal),
    ("laplace", WeightName::Laplace),
    ("proximity", WeightName::Proximity),
    ("beyond", WeightName::Beyond),
    ("gap", WeightName::Gap),
    ("coverage", WeightName::Coverage),
    ("thin-plate", WeightName::ThinPlate),
    ("proximal", WeightName::Proximal),
];

impl WeightName {
    /// Whether it is a weight of the level function.
    pub fn is_of_boundaries(self) -> bool {
        WEIGHT_NAMES[..6].iter().any(|(_, name)| *name == self)
    }
}

/// A weight that was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight {
    pub name: WeightName,
    pub value: f64,
}

impl FromStr for Weight {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').ok_or_else(|| format!("expected NAME=NUMBER, found \"{text}\""))?;
        let known = WEIGHT_NAMES.iter().find(|(known, _)| *known == name.trim());
        let Some((_, name)) = known else {
            let names: Vec<&str> = WEIGHT_NAMES.iter().map(|(name, _)| *name).collect();
            return Err(format!("expected one of {}, found \"{name}\"", names.join(", ")));
        };
        let value = value.trim().parse::<f64>().ok().filter(|value| *value >= 0.0 && value.is_finite());
        value
            .map(|value| Self { name: *name, value })
            .ok_or_else(|| format!("expected a number of at least 0 in \"{text}\""))
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::super::{Cli, Command};
    use super::*;

    fn parsed(line: &str) -> RuledArgs {
        match Cli::try_parse_from(line.split(' ')).unwrap().command {
            Command::Ruled(args) => *args,
            _ => panic!("another command"),
        }
    }

    #[test]
    fn a_mesh_or_a_command() {
        let args =
            parsed("shapeop ruled roof.obj --boundaries geodesic --weights gap=2,geodesic=0.5 --weights proximal=1e-3");
        assert_eq!((args.mesh, args.boundaries.boundaries), (Some("roof.obj".into()), Some(BoundaryKind::Geodesic)));
        let weight = |name, value| Weight { name, value };
        let expected =
            [weight(WeightName::Gap, 2.0), weight(WeightName::Geodesic, 0.5), weight(WeightName::Proximal, 1e-3)];
        assert_eq!(args.boundaries.weights, expected);
        assert!(matches!(parsed("shapeop ruled check a.json b.obj").command, Some(RuledCommand::Check(_))));
        let args = parsed("shapeop ruled a.obj --planes 1,0,0,-0.5 --planes -1,0,0,2 --quiet");
        assert_eq!(args.boundaries.planes, [(DVec3::X, -0.5), (DVec3::NEG_X, 2.0)]);
        for wrong in
            ["ruled", "ruled a.obj check b.json c.obj", "ruled a.obj --levels 3 --width 2", "ruled a.obj --depth 1"]
        {
            assert!(Cli::try_parse_from(format!("shapeop {wrong}").split(' ')).is_err(), "{wrong}");
        }
    }

    #[test]
    fn weights_have_names() {
        assert!("gap".parse::<Weight>().unwrap_err().contains("NAME=NUMBER"));
        assert!("gaps=1".parse::<Weight>().unwrap_err().contains("thin-plate"));
        assert!("gap=-1".parse::<Weight>().unwrap_err().contains("at least 0"));
        assert!(WeightName::Laplace.is_of_boundaries() && !WeightName::Proximity.is_of_boundaries());
    }
}
