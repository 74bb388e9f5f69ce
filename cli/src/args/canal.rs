//! What can be asked of super-canal surfaces.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use glam::DVec3;
use shapeop::geometry::canal::smoothing::Options;

use super::links::{ChainArgs, parse_four, parse_list, parse_vector};
use super::{MeshFormat, PictureFormat};

#[derive(Debug, Args)]
#[command(arg_required_else_help = true)]
#[command(after_help = "\
Examples:
  shapeop canal strip examples/canal/arc.csv --start 3.5,0 --lengths 1.5      a circular strip along a guide
  shapeop canal circles examples/canal/circles.csv                          a roof over circles in the plane
  shapeop canal revolution examples/canal/profile.csv --columns 24
  shapeop canal transform out/profile.revolution.surface.json --inversion 4,1,0,2 --scale 3
  shapeop canal panels out/profile.revolution.surface.json --thickness 0.02  what a workshop cuts

Every command but check writes a mesh, the surface (NAME.COMMAND.surface.json, with which transform, refine, check and panels \
go on), a picture and a report. All faces are planar and have their corners on a circle.
Curve files: CSV (x,y or x,y,z a line; a header and comments after # may be), JSON ([[x, y, z], ...] or \
{\"points\": [...], \"closed\": true}), OBJ (an l element, or vertices in order). A curve whose last point repeats the first is closed.
Source: Mesnil, Douthe, Baverel, Leger 2018. docs/canal.md explains the surfaces.")]
pub struct CanalArgs {
    #[command(subcommand)]
    pub command: CanalCommand,
}

#[derive(Debug, Subcommand)]
pub enum CanalCommand {
    /// A surface of revolution: a planar profile turned about an axis in its plane
    #[command(after_help = "\
Examples:
  shapeop canal revolution examples/canal/profile.csv --columns 24
  shapeop canal revolution examples/canal/profile.csv --axis 1,0,0 --through 0,0,-2 --angle 180

Column 0 is the profile; each row runs along a parallel. The profile must be in a plane through the axis and on one side of it.")]
    Revolution(RevolutionArgs),
    /// A moulding surface: a planar profile swept along a planar rail, their planes orthogonal
    #[command(after_help = "\
Examples:
  shapeop canal moulding examples/canal/rail.csv examples/canal/section.csv

The profile starts in the rail's first point. Column 0 is the rail, row 0 the profile; both families of lines are planar.")]
    Moulding(SweepArgs),
    /// A Monge surface: a planar profile swept along any rail without twist
    #[command(after_help = "\
Examples:
  shapeop canal monge examples/canal/helix.csv examples/canal/arch_on_helix.csv

As moulding, for rails in space. Beyond the evolute of the rail quads cross themselves: the report counts them.")]
    Monge(SweepArgs),
    /// An inverted surface of revolution over a planar or spherical curve from P1 to P4 and two points P2, P3 on a circle with its ends
    #[command(after_help = "\
Examples:
  shapeop canal m-revolution examples/canal/bean.obj --p2 -0.6,-0.8 --p3 0.6,-0.8
  shapeop canal m-revolution examples/canal/dome.csv --p2 -0.6,-0.8 --p3 0.6,-0.8 --sphere 0,0,-0.75,1.25

A roof whose arches are arcs of circles, each in a plane orthogonal to the curve's; with --sphere, over a curve on that sphere, which \
they leave at right angles. What --omega, --ratio, --center and --pole choose is the base, which further transformations start from; \
the surface itself is always the same.")]
    MRevolution(MRevolutionArgs),
    /// An inverted moulding or Monge surface through a planar curve and a rail that leaves its plane
    #[command(after_help = "\
Examples:
  shapeop canal m-moulding examples/canal/bean.obj examples/canal/arch.csv --center 0,-3
  shapeop canal m-moulding examples/canal/bean.obj examples/canal/arch.csv --p3 0.6,-0.8

Rail and curve start in the same point. With --p3, on a circle with the curve's ends and the rail's end, the far corner comes near it.")]
    MMoulding(MMouldingArgs),
    /// A circular strip along a guide curve, from lengths of its crossing edges, radii, or lengths along its border
    #[command(after_help = "\
Examples:
  shapeop canal strip examples/canal/arc.csv --start 3.5,0 --lengths 1.5
  shapeop canal strip examples/canal/arc.csv --start 3.5,0 --border-length 6 --rise 60
  shapeop canal strip examples/canal/arc.csv --start 3.5,0 --border-edges 0.6
  shapeop canal strip examples/canal/arc.csv --start 3.5,0 --lengths 1.5 --smooth
  shapeop canal strip examples/canal/arc.csv --start 3.5,0 --lengths 1.5 --smooth --cone 0,0,1 --cone-angle 60

One of --lengths, --radii, --border-edges and --border-length is needed. Lengths can miss what is attainable: the refusal says which are; --project \
takes the nearest, --fit-start turns the first edge to where lengths can go on.
The strip carries arcs across: --rise is the angle at which they leave it, 90: half circles. --smooth names its files \
NAME.strip.smooth.*, beside those of the strip as it was.")]
    Strip(StripArgs),
    /// The strip of circles that someone drew, and the roof over it
    #[command(after_help = "\
Examples:
  shapeop canal circles examples/canal/circles.csv
  shapeop canal circles circles.json --rise 45 --refine 6 24

Files: CSV of x,y,r or x,y,z,r or x,y,z,r,nx,ny,nz a line, or JSON [{\"center\": [x, y, z], \"radius\": r, \"normal\": [0, 0, 1]}, ...]. \
Each circle meets the next in two points, or nearly: how far the strip is from the circles is told.")]
    Circles(CirclesArgs),
    /// A closed strip along a closed guide: the last circle closes it
    #[command(after_help = "\
Examples:
  shapeop canal facade examples/canal/ring.json --start 2.4,0 --lengths 0.9

Lengths are those of the crossing edges of all points but the last, whose edge the closing circle gives. The first one moves where \
the circles beside the closing one are not on one sphere. Where frames do not close around the guide, the seam is a crease.")]
    Facade(FacadeArgs),
    /// The canal surface along one curve that touches another
    #[command(after_help = "\
Examples:
  shapeop canal fit examples/canal/edge_a.csv examples/canal/edge_b.csv --phi 30
  shapeop canal fit examples/canal/edge_a.csv examples/canal/edge_b.csv --phi 30 --section whole --columns 24

The first curve becomes a line of curvature, the second is touched by the spheres. --phi is the one free number: the angle of the \
surface's normal about the first curve, from the direction nearest to z.")]
    Fit(FitArgs),
    /// A C-canal surface: a planar cross-section swept along a guide, as wide as lengths or a second curve say
    #[command(after_help = "\
Examples:
  shapeop canal sections examples/canal/path.csv examples/canal/cross.csv --lengths 2
  shapeop canal sections examples/canal/path.csv examples/canal/cross.csv --curve examples/canal/side.csv

The section is convex, planar, and starts in the guide's first point; all sections of the result are planar. Lengths are the distances \
of the far ends of sections from the guide. A length that is not attainable is refused with the interval that is; --project takes the \
nearest.")]
    Sections(SectionsArgs),
    /// Apply inversions, Combescure transformations and similarities to a surface or a circular mesh
    #[command(after_help = "\
Examples:
  shapeop canal transform out/profile.revolution.surface.json --inversion 4,1,0,2 --combescure factors.json
  shapeop canal transform net.obj --chain chain.json --scale 2 --translate 0,0,1

Links are applied in the order in which they stand. A chain file is an array of {\"inversion\": {\"center\": [x, y, z], \"ratio\": k}}, \
{\"combescure\": {\"column\": [...], \"row\": [...]}}, {\"translation\": [x, y, z]}, {\"scaling\": s}, {\"rotation\": [x, y, z, w]}; \
a file of --combescure is {\"column\": [...], \"row\": [...]}, one factor for each edge of column 0 and of row 0.
A mesh must be of circular quads in rows and columns; each of its components is transformed and written alone.")]
    Transform(TransformArgs),
    /// Cut the faces of a surface finer: its points stay, new ones are on the smooth surface
    #[command(after_help = "\
Examples:
  shapeop canal refine out/arc.strip.surface.json --refine 8 8")]
    Refine(RefineArgs),
    /// Measure a surface or a mesh of quads: planarity, concyclicity, folds; the worst faces by name
    #[command(after_help = "\
Examples:
  shapeop canal check out/arc.strip.surface.json
  shapeop canal check out/arc.strip.surface.json --properties
  shapeop canal check net.obj --json")]
    Check(CanalCheckArgs),
    /// What a workshop cuts: flat panels as SVG sheets in true scale, mitre angles, beams, the offset mesh
    #[command(after_help = "\
Examples:
  shapeop canal panels out/arc.strip.surface.json --refine 2 4 --thickness 0.02 --beam-height 0.15
  shapeop canal panels net.obj --axes least-gaps --unit cm

One sheet for each row of panels: the outline is cut (red), dashed is the lower side where there is a thickness, numbers at edges are \
mitre angles in degrees (above 0: longer below). Panel R-C is row R, column C, from 0.")]
    Panels(PanelsArgs),
}

/// What to write and how.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub struct CanalOutputArgs {
    /// Folder to write into; it is made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Format of the mesh
    #[arg(long, value_name = "FORMAT", value_enum, default_value = "obj")]
    pub format: MeshFormat,
    /// Format of the picture
    #[arg(long, value_name = "FORMAT", value_enum, default_value = "png")]
    pub picture: PictureFormat,
    /// Cut each face in N by M along the lines of curvature of the smooth surface [default: 4 12 for strips, else 1 1]
    #[arg(long, num_args = 2, value_names = ["N", "M"])]
    pub refine: Option<Vec<usize>>,
    /// Print the report (JSON) instead of the summary
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct RevolutionArgs {
    /// The profile, a curve file
    pub profile: PathBuf,
    /// Direction of the axis
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,1", value_parser = parse_vector, allow_hyphen_values = true)]
    pub axis: DVec3,
    /// A point of the axis
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,0", value_parser = parse_vector, allow_hyphen_values = true)]
    pub through: DVec3,
    /// Angle in degrees, up to 360
    #[arg(long, value_name = "DEGREES", default_value_t = 360.0, allow_negative_numbers = true)]
    pub angle: f64,
    /// Points along each parallel
    #[arg(long, value_name = "N", default_value_t = 24)]
    pub columns: usize,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

#[derive(Debug, Args)]
pub struct SweepArgs {
    /// The rail, a curve file
    pub rail: PathBuf,
    /// The profile, a planar curve file that starts in the rail's first point
    pub profile: PathBuf,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

/// Which center of inversion maps four corners to an isosceles trapezoid.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Center of inversion")]
#[group(multiple = false)]
pub struct CenterArgs {
    /// The point of the circle of centers at this angle: 0 is the middle inside, 180 that outside [default: outside]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    pub omega: Option<f64>,
    /// The center outside for which the trapezoid's parallel sides have this ratio
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub ratio: Option<f64>,
    /// This point
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub center: Option<DVec3>,
}

#[derive(Debug, Args)]
pub struct MRevolutionArgs {
    /// The curve from P1 to P4, a curve file: planar, or on the sphere
    pub curve: PathBuf,
    /// P2, where the arch over P1 ends
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub p2: DVec3,
    /// P3, where the arch over P4 ends
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub p3: DVec3,
    /// A direction to whose side the arches rise
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,1", value_parser = parse_vector, allow_hyphen_values = true)]
    #[arg(conflicts_with = "sphere")]
    pub up: DVec3,
    /// Points along each arch
    #[arg(long, value_name = "N", default_value_t = 13)]
    pub columns: usize,
    #[command(flatten)]
    pub sphere: SphereArgs,
    #[command(flatten)]
    pub center: CenterArgs,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

/// The sphere of a curve that is not planar.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Sphere")]
pub struct SphereArgs {
    /// Center and radius of the sphere that the curve, P2 and P3 are on
    #[arg(long, value_name = "X,Y,Z,R", value_parser = parse_four, allow_hyphen_values = true)]
    pub sphere: Option<(DVec3, f64)>,
    /// The point of the sphere that flattens it to a plane, off the curve [default: one far from all points]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true, requires = "sphere")]
    pub pole: Option<DVec3>,
    /// Let arches rise into the sphere, not out of it
    #[arg(long, requires = "sphere")]
    pub inside: bool,
}

#[derive(Debug, Args)]
pub struct MMouldingArgs {
    /// The planar curve, a curve file
    pub curve: PathBuf,
    /// The rail, a curve file that starts in the curve's first point
    pub rail: PathBuf,
    /// The far corner, on a circle with the curve's ends and the rail's end
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true, required_unless_present = "center")]
    pub p3: Option<DVec3>,
    #[command(flatten)]
    pub center: CenterArgs,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

/// Numbers in an option: written there, or the file that they are in.
#[derive(Clone, Debug)]
pub enum Numbers {
    List(Vec<f64>),
    File(PathBuf),
}

/// How a strip becomes a surface.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Arcs")]
pub struct ArcArgs {
    /// The angle at which arcs across leave the strip, in degrees: 0 stays in the first face, 90 makes half circles
    #[arg(long, value_name = "DEGREES", default_value_t = 90.0, allow_negative_numbers = true)]
    pub rise: f64,
    /// A direction to whose side the arcs rise
    #[arg(long, value_name = "X,Y,Z", default_value = "0,0,1", value_parser = parse_vector, allow_hyphen_values = true)]
    pub up: DVec3,
}

#[derive(Debug, Args)]
pub struct StripArgs {
    /// The guide, a curve file
    pub guide: PathBuf,
    /// The other end of the first crossing edge; with --radii a point on the ray to it
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub start: DVec3,
    #[command(flatten)]
    pub measure: MeasureArgs,
    /// Take that many points of the smooth curve through those of the file, evenly along it [default: those of the file]
    #[arg(long, value_name = "N")]
    pub points: Option<usize>,
    /// Refuse quads that cross themselves
    #[arg(long)]
    pub strict: bool,
    /// Replace lengths that are not attainable by the nearest that are
    #[arg(long)]
    pub project: bool,
    /// Turn the first crossing edge to where the lengths can go on
    #[arg(long)]
    pub fit_start: bool,
    #[command(flatten)]
    pub smoothing: SmoothingArgs,
    #[command(flatten)]
    pub arcs: ArcArgs,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

/// Whether and how a strip is smoothed.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Smoothing")]
pub struct SmoothingArgs {
    /// Move the points along the guide, change the lengths and turn the normal for smoother arcs
    #[arg(long)]
    pub smooth: bool,
    /// Iterations at most
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub iterations: usize,
    /// The most that two spacings of points change against each other: 1 keeps them
    #[arg(long, value_name = "RATIO", default_value_t = Options::default().spacing_ratio, allow_negative_numbers = true)]
    pub spacing_ratio: f64,
    /// The most that a length changes, as a part of it
    #[arg(long, value_name = "PART", default_value_t = Options::default().length_change, allow_negative_numbers = true)]
    pub length_change: f64,
    /// Keep the normal at the first point at a constant angle to this axis
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true, requires = "smooth")]
    pub cone: Option<DVec3>,
    /// That angle in degrees, 0 to 180 [default: the normal's at the start]
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, requires = "cone")]
    pub cone_angle: Option<f64>,
}

/// What is prescribed of a strip.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Strip")]
#[group(required = true, multiple = false)]
pub struct MeasureArgs {
    /// Lengths of the crossing edges: one for all, two for the first and the last, or one for each point; or a file of them
    #[arg(long, value_name = "L,...|FILE", value_parser = parse_numbers, allow_hyphen_values = true)]
    pub lengths: Option<Numbers>,
    /// Radii of the circles: one for all, or one for each quad; or a file of them
    #[arg(long, value_name = "R,...|FILE", value_parser = parse_numbers, allow_hyphen_values = true)]
    pub radii: Option<Numbers>,
    /// Lengths of the border's edges: one for all, or one for each quad; or a file of them
    #[arg(long, value_name = "E,...|FILE", value_parser = parse_numbers, allow_hyphen_values = true)]
    pub border_edges: Option<Numbers>,
    /// Length of the border as a whole, spread like the guide's
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub border_length: Option<f64>,
}

#[derive(Debug, Args)]
pub struct CirclesArgs {
    /// The file of circles (CSV or JSON)
    pub circles: PathBuf,
    /// A point near which the first crossing edge starts
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub start: Option<DVec3>,
    /// A point near which the last crossing edge starts
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub end: Option<DVec3>,
    #[command(flatten)]
    pub arcs: ArcArgs,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

#[derive(Debug, Args)]
pub struct FacadeArgs {
    /// The closed guide, a curve file
    pub guide: PathBuf,
    /// The other end of the first crossing edge
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub start: DVec3,
    #[command(flatten)]
    pub measure: MeasureArgs,
    #[command(flatten)]
    pub arcs: ArcArgs,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum SectionKind {
    /// From the first curve to the second
    ToCurve,
    /// The same around the far side of the circles
    LongWay,
    /// Whole circles
    Whole,
}

#[derive(Debug, Args)]
pub struct FitArgs {
    /// The first curve, which becomes a line of curvature
    pub guide: PathBuf,
    /// The second curve
    pub curve: PathBuf,
    /// Angle of the surface's normal about the first curve, in degrees, from the direction nearest to z
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_negative_numbers = true)]
    pub phi: f64,
    /// Circles, evenly along the first curve [default: as many as it has points]
    #[arg(long, value_name = "N")]
    pub circles: Option<usize>,
    /// Points on each circle
    #[arg(long, value_name = "N", default_value_t = 13)]
    pub columns: usize,
    /// Which part of the circles
    #[arg(long, value_name = "PART", value_enum, default_value = "to-curve")]
    pub section: SectionKind,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

#[derive(Debug, Args)]
pub struct SectionsArgs {
    /// The guide, a curve file
    pub guide: PathBuf,
    /// The cross-section, a planar curve file that starts in the guide's first point
    pub section: PathBuf,
    /// Distances across: one for all, two for the first and the last, or one for each point; or a file of them
    #[arg(long, value_name = "L,...|FILE", value_parser = parse_numbers, allow_hyphen_values = true, required_unless_present = "curve")]
    pub lengths: Option<Numbers>,
    /// The second curve, which the far ends are to meet, a curve file
    #[arg(long, value_name = "FILE", conflicts_with = "lengths")]
    pub curve: Option<PathBuf>,
    /// Replace lengths that are not attainable by the nearest that are
    #[arg(long)]
    pub project: bool,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

#[derive(Debug, Args)]
pub struct TransformArgs {
    /// The surface (.json) or a circular mesh (.obj, .off, .ply)
    pub input: PathBuf,
    #[command(flatten)]
    pub chain: ChainArgs,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

#[derive(Debug, Args)]
pub struct RefineArgs {
    /// The surface (.json) or a circular mesh (.obj, .off, .ply)
    pub input: PathBuf,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

#[derive(Debug, Args)]
pub struct CanalCheckArgs {
    /// The surface (.json) or a mesh of quads (.obj, .off, .ply)
    pub input: PathBuf,
    /// How many of the worst faces to name
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub worst: usize,
    /// Tell properties of a surface too: planar curves, isothermic, stress lines (some seconds for large nets)
    #[arg(long)]
    pub properties: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AxesKind {
    /// The normals of the smooth surface
    Normals,
    /// The axes along which beams of one height differ least in depth (a search)
    LeastGaps,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Unit {
    Mm,
    Cm,
    M,
}

#[derive(Debug, Args)]
pub struct PanelsArgs {
    /// The surface (.json) or a circular mesh (.obj, .off, .ply)
    pub input: PathBuf,
    /// Thickness of panels, in model units; 0: none
    #[arg(long, value_name = "LENGTH", default_value_t = 0.0, allow_negative_numbers = true)]
    pub thickness: f64,
    /// Height of beams along their node axes, in model units [default: a twentieth of the mean edge]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub beam_height: Option<f64>,
    /// Node axes
    #[arg(long, value_name = "AXES", value_enum, default_value = "normals")]
    pub axes: AxesKind,
    /// Let axes point to the other side: panels thicken and beams reach away from where they point
    #[arg(long)]
    pub flip: bool,
    /// What a model unit is
    #[arg(long, value_name = "UNIT", value_enum, default_value = "m")]
    pub unit: Unit,
    #[command(flatten)]
    pub output: CanalOutputArgs,
}

fn parse_numbers(text: &str) -> Result<Numbers, String> {
    let is_number = |part: &str| part.trim().parse::<f64>().is_ok();
    if text.split(',').any(is_number) { parse_list(text).map(Numbers::List) } else { Ok(Numbers::File(text.into())) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_a_list_or_a_file() {
        assert!(matches!(parse_numbers("1, 2.5").unwrap(), Numbers::List(list) if list == [1.0, 2.5]));
        assert!(matches!(parse_numbers("lengths.csv").unwrap(), Numbers::File(_)));
        assert!(parse_numbers("1,x").unwrap_err().contains("found \"x\""));
        assert!(parse_vector("1").is_err() && parse_vector("1,nan").is_err());
    }
}
