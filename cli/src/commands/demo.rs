//! `demo`: the main job on a real mesh that the program carries.

use std::path::Path;

use anyhow::Result;
use shapeop::mesh::file::{Format, decode};
use shapeop::problem::recipes::RecipeOptions;

use super::recipe::{Job, Recipe, carry_out};
use crate::Ending;
use crate::args::DemoArgs;
use crate::output::say;

/// See `examples/meshes/SOURCES.md` for where it comes from.
const MESH: &[u8] = include_bytes!("../../../examples/meshes/costa_mesh_free2.obj");
const NAME: &str = "costa_mesh_free2.obj";

/// The Costa surface lets its faces become planar near the design.
const CLOSENESS: f64 = 1e-4;

pub fn run(args: &DemoArgs, is_quiet: bool) -> Result<Ending> {
    let source = decode(MESH, Format::Obj, NAME)?;
    let options = RecipeOptions { closeness: CLOSENESS, ..RecipeOptions::default() };
    let format = args.output.format.map_or(Format::Obj, Into::into);
    let job = Job { recipe: Recipe::Planarize, mesh: &source.mesh, input: Path::new(NAME), options, format };
    if !is_quiet && !args.output.json {
        say(&format!(
            "A quad mesh of the Costa surface (WWmore/DOS, MIT licence; examples/meshes/SOURCES.md) is planarised:\n\
             a Plane of weight 1 per face, a Closeness of weight {CLOSENESS} per point.\n"
        ))?;
    }
    carry_out(&job, &job.problem()?, &args.iterate, &args.output, is_quiet)
}
