//! `ruled`: strips of straight lines for a negatively curved mesh, what they are worth, and planks.

mod asked;
mod boundaries;
mod check;
mod field;
mod made;
mod measures;
mod mesh;
mod pictures;
mod places;
mod planks;
mod report;
mod single;
mod strips;

use anyhow::Result;

pub use measures::counted;

use crate::Ending;
use crate::args::ruled::{RuledArgs, RuledCommand};

pub fn run(args: &RuledArgs, is_quiet: bool) -> Result<Ending> {
    match &args.command {
        Some(RuledCommand::Field(args)) => field::run(args, is_quiet),
        Some(RuledCommand::Check(args)) => check::run(args, is_quiet),
        Some(RuledCommand::Planks(args)) => planks::run(args, is_quiet),
        None => strips::run(args, is_quiet),
    }
}
