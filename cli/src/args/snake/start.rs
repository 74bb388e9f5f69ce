//! Where a snake starts.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum};
use glam::DVec3;
use shapeop::geometry::snakes::fit::Options;

use crate::args::links::{parse_four, parse_list, parse_vector};

/// Where the snake of an evolution starts: one of four.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Start")]
#[group(id = "start", required = true, multiple = false, args = ["from", "curve", "section", "snake"])]
pub struct StartArgs {
    /// A curve of constant curvature from this point, with --toward, --curvature and --length: X,Y is the highest point of the mesh \
    /// there, X,Y,Z the nearest one
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true, requires_all = ["toward", "curvature", "length", "arcs"])]
    pub from: Option<Spot>,
    /// The direction in which it begins
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true, requires = "from")]
    pub toward: Option<DVec3>,
    /// Its curvature, at least that of the surface along it
    #[arg(long, value_name = "K", allow_negative_numbers = true, requires = "from")]
    pub curvature: Option<f64>,
    /// Its length
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true, requires = "from")]
    pub length: Option<f64>,
    /// Which way it turns, seen from the side that normals point to
    #[arg(long, value_name = "SIDE", value_enum, default_value = "left")]
    pub turn: Turn,
    /// A curve file (.csv, .json or .obj), open or closed
    #[arg(long, value_name = "FILE", requires = "arcs")]
    pub curve: Option<PathBuf>,
    /// The section of the mesh with the plane A x + B y + C z = D; of several pieces the longest
    #[arg(long, value_name = "A,B,C,D", value_parser = parse_four, allow_hyphen_values = true, requires = "arcs")]
    pub section: Option<(DVec3, f64)>,
    /// A snake (JSON), as fit and evolve write it
    #[arg(long, value_name = "FILE", conflicts_with = "arcs")]
    pub snake: Option<PathBuf>,
    /// The number of arcs
    #[arg(long, value_name = "N")]
    pub arcs: Option<usize>,
    #[command(flatten)]
    pub fit: FitOptionArgs,
}

/// How arcs are fitted to a curve.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Start")]
pub struct FitOptionArgs {
    /// Each arc as curved as the curve is there [default: all of one radius]
    #[arg(long)]
    pub free_radii: bool,
    /// How much nearness to the curve counts beside the arcs' shapes at first
    #[arg(long, value_name = "W", default_value_t = Options::default().nearness, allow_negative_numbers = true)]
    pub nearness: f64,
}

/// Where curves on a mesh start.
#[derive(Args, Clone, Debug)]
pub struct CurveStartArgs {
    /// The start: X,Y is the highest point of the mesh there, X,Y,Z the nearest one
    #[arg(long, value_name = "X,Y[,Z]", allow_hyphen_values = true)]
    pub from: Spot,
    /// The direction there
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub toward: DVec3,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Turn {
    Left,
    Right,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Turns {
    Left,
    Right,
    /// One curve of either kind for each curvature
    Both,
}

/// Where on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spot {
    /// The highest point over x and y.
    Over(f64, f64),
    /// The nearest point.
    Near(DVec3),
}

impl FromStr for Spot {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match parse_list(text)?[..] {
            [x, y] => Ok(Self::Over(x, y)),
            [x, y, z] => Ok(Self::Near(DVec3::new(x, y, z))),
            ref values => Err(format!("expected x,y or x,y,z, found {} numbers", values.len())),
        }
    }
}

/// A point of a snake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Point {
    Start,
    End,
    Number(u32),
}

impl FromStr for Point {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "start" => Ok(Self::Start),
            "end" => Ok(Self::End),
            number => {
                let number = number.parse::<u32>().ok().map(Self::Number);
                number.ok_or_else(|| format!("expected \"start\", \"end\" or a number from 0, found \"{text}\""))
            }
        }
    }
}

/// A curve file, and the point of the snake that it has to do with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RailAt {
    pub file: PathBuf,
    pub point: Option<Point>,
}

impl FromStr for RailAt {
    type Err = String;

    /// What follows the last `@` is the point, where it is one: names of files may have that sign too.
    fn from_str(text: &str) -> Result<Self, String> {
        let split = text.rsplit_once('@').and_then(|(file, point)| Some((file, point.parse::<Point>().ok()?)));
        Ok(match split {
            Some((file, point)) => Self { file: file.into(), point: Some(point) },
            None => Self { file: text.into(), point: None },
        })
    }
}
