//! `canal transform` and `canal refine`: a surface, or the components of a circular mesh, through a chain.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use glam::DQuat;
use serde::Deserialize;
use shapeop::geometry::canal::chain::Transform;
use shapeop::geometry::canal::file::LinkForm;
use shapeop::geometry::canal::frame::Frame;
use shapeop::geometry::canal::inversion::Inversion;
use shapeop::geometry::canal::net::Net;
use shapeop::geometry::canal::surface::{BaseKind, SuperCanal};
use shapeop::mesh::file::read_source;
use shapeop::mesh::{Grid, Mesh};

use super::made::{Made, write};
use super::strips::tangent;
use crate::Ending;
use crate::args::canal::{CanalOutputArgs, RefineArgs, TransformArgs};
use crate::args::links::Link;
use crate::curve_file::{extension, from_json, text_of};

/// What a file holds: one surface, or the components of a mesh.
pub struct Components {
    /// Each with the path that names its files.
    pub surfaces: Vec<(PathBuf, SuperCanal)>,
}

impl Components {
    /// Reads a surface (`.json`), or a mesh of circular quads in rows and columns.
    pub fn read(path: &Path) -> Result<Self> {
        if extension(path) == "json" {
            let surface =
                SuperCanal::from_json(&text_of(path)?).map_err(|error| anyhow!("{}: {error}", path.display()))?;
            return Ok(Self { surfaces: vec![(path.to_owned(), surface)] });
        }
        let grids = grids(path)?;
        let count = grids.len();
        let surface = |(i, grid): (usize, Grid)| {
            let of = if count > 1 { format!(", component {} of {count}", i + 1) } else { String::new() };
            let name = if count > 1 { numbered(path, i + 1) } else { path.to_owned() };
            let made = frame_of(&grid).and_then(|frame| Ok(Net::new(grid, frame)?));
            let net = made.map_err(|error| anyhow!("{}{of}: {error}", path.display()))?;
            Ok((name, SuperCanal::new(net, BaseKind::Circular)))
        };
        Ok(Self { surfaces: grids.into_iter().enumerate().map(surface).collect::<Result<_>>()? })
    }
}

/// The grids of a mesh file; a refusal names the line of a face.
pub fn grids(path: &Path) -> Result<Vec<Grid>> {
    let source = read_source(path)?;
    let line = |face: usize| source.face_lines.get(face).map_or(String::new(), |line| format!(", line {line}"));
    let face_of = |place: &str| place.strip_prefix("faces[").and_then(|rest| rest.split(']').next()?.parse().ok());
    let grids = Grid::of_mesh(&source.mesh).map_err(|error| {
        let at = face_of(error.place()).map_or(String::new(), line);
        anyhow!("{}{at}: {error}", path.display())
    })?;
    if grids.is_empty() {
        bail!("{}: faces: expected at least one quad, found none", path.display());
    }
    Ok(grids.into_iter().map(|(grid, _)| grid).collect())
}

fn numbered(path: &Path, number: usize) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-{number}.{extension}"))
}

/// A frame whose tangents follow column 0 and row 0 smoothly. Any frame makes a cyclidic net of a circular grid; this one makes a
/// fair one.
fn frame_of(grid: &Grid) -> Result<Frame> {
    let t1 = tangent(&grid.column(0), grid.wraps()[0])?;
    let t2 = tangent(grid.row(0), grid.wraps()[1])?;
    Frame::of_tangent_one(t1, t1.cross(t2)).context("the first edges of column 0 and row 0 are parallel")
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Factors {
    column: Vec<f64>,
    row: Vec<f64>,
}

/// The transformations of links, each with a name for errors.
fn transforms(links: &[Link]) -> Result<Vec<(String, Transform)>> {
    let mut chain = Vec::new();
    for link in links {
        match link {
            Link::Chain(path) => {
                let name = path.display().to_string();
                let forms: Vec<LinkForm> = from_json(&text_of(path)?, &name)?;
                for (k, form) in forms.iter().enumerate() {
                    let place = format!("{name}: [{k}]");
                    let transform = Transform::try_from(form).map_err(|error| anyhow!("{place}: {error}"))?;
                    chain.push((place, transform));
                }
            }
            Link::Combescure(path) => {
                let name = path.display().to_string();
                let Factors { column, row } = from_json(&text_of(path)?, &name)?;
                chain.push((name, Transform::Combescure { column, row }));
            }
            Link::Inversion(center, ratio) => {
                let inversion = Inversion::new(*center, *ratio).map_err(|error| anyhow!("--inversion: {error}"))?;
                chain.push(("--inversion".to_owned(), Transform::Inversion(inversion)));
            }
            Link::Translate(step) => chain.push(("--translate".to_owned(), Transform::Translation(*step))),
            Link::Scale(factor) => chain.push(("--scale".to_owned(), Transform::Scaling(*factor))),
            Link::Rotate(axis, degrees) => {
                let axis = axis.try_normalize().context("--rotate: expected an axis other than zero")?;
                let turn = DQuat::from_axis_angle(axis, degrees.to_radians());
                chain.push(("--rotate".to_owned(), Transform::Rotation(turn)));
            }
        }
    }
    Ok(chain)
}

pub fn run(args: &TransformArgs, is_quiet: bool) -> Result<Ending> {
    if args.chain.links.is_empty() {
        bail!("expected at least one of --chain, --inversion, --combescure, --translate, --scale and --rotate");
    }
    let chain = transforms(&args.chain.links)?;
    let Components { mut surfaces } = Components::read(&args.input)?;
    for (name, surface) in &mut surfaces {
        for (link, transform) in &chain {
            surface.push(transform.clone()).map_err(|error| anyhow!("{link}: {error} ({})", name.display()))?;
        }
    }
    write_all("transform", surfaces, &args.output, [1, 1], is_quiet)
}

pub fn refine(args: &RefineArgs, is_quiet: bool) -> Result<Ending> {
    write_all("refine", Components::read(&args.input)?.surfaces, &args.output, [2, 2], is_quiet)
}

fn write_all(
    command: &str,
    surfaces: Vec<(PathBuf, SuperCanal)>,
    args: &CanalOutputArgs,
    refine: [usize; 2],
    is_quiet: bool,
) -> Result<Ending> {
    for (name, surface) in surfaces {
        let links = surface.chain().len();
        let restored = surface.restored()?;
        let base = surface.base().grid();
        let apart = base.points().iter().zip(restored.grid().points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let extent = Mesh { points: base.points().to_vec(), faces: Vec::new() }.diagonal();
        let mut made = Made::new(surface);
        made.refine = refine;
        made.find("links_of_the_chain", links);
        // Through the inverse chain back to the base: what round-off the chain has cost.
        made.find("restored_within", if extent > 0.0 { apart / extent } else { apart });
        write(command, &name, made, args, is_quiet)?;
    }
    Ok(Ending::Done)
}
