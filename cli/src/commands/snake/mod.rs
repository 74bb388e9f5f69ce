//! `snake`: circular arc snakes that move over a mesh, along rails or as linkages, and what a workshop makes of them.

mod check;
mod coverings;
mod curve;
mod evolve;
mod figures;
mod fit;
mod going;
mod linkage;
mod made;
mod names;
mod pictures;
mod rails;
mod report;
mod start;
mod sweep;

use anyhow::Result;

use crate::Ending;
use crate::args::snake::SnakeCommand;

pub fn run(command: &SnakeCommand, is_quiet: bool) -> Result<Ending> {
    match command {
        SnakeCommand::Evolve(args) => evolve::run(args, is_quiet),
        SnakeCommand::Sweep(args) => sweep::run(args, is_quiet),
        SnakeCommand::Linkage(args) => linkage::run(args, is_quiet),
        SnakeCommand::Fit(args) => fit::run(args, is_quiet),
        SnakeCommand::Curve(args) => curve::run(args, is_quiet),
        SnakeCommand::Check(args) => check::run(args, is_quiet),
    }
}
