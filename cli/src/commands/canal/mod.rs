//! `canal`: super-canal surfaces from curves, their transformations, and what a workshop cuts of them.

mod bases;
mod check;
mod fit;
mod made;
mod panels;
mod sections;
mod sheets;
mod strips;
mod transform;

use anyhow::Result;

pub use made::in_json;

use crate::Ending;
use crate::args::canal::CanalCommand;

pub fn run(command: &CanalCommand, is_quiet: bool) -> Result<Ending> {
    match command {
        CanalCommand::Revolution(args) => bases::revolution(args, is_quiet),
        CanalCommand::Moulding(args) => bases::sweep("moulding", args, is_quiet),
        CanalCommand::Monge(args) => bases::sweep("monge", args, is_quiet),
        CanalCommand::MRevolution(args) => bases::m_revolution(args, is_quiet),
        CanalCommand::MMoulding(args) => bases::m_moulding(args, is_quiet),
        CanalCommand::Strip(args) => strips::strip(args, is_quiet),
        CanalCommand::Circles(args) => strips::circles(args, is_quiet),
        CanalCommand::Facade(args) => strips::facade(args, is_quiet),
        CanalCommand::Fit(args) => fit::run(args, is_quiet),
        CanalCommand::Sections(args) => sections::run(args, is_quiet),
        CanalCommand::Transform(args) => transform::run(args, is_quiet),
        CanalCommand::Refine(args) => transform::refine(args, is_quiet),
        CanalCommand::Check(args) => check::run(args, is_quiet),
        CanalCommand::Panels(args) => panels::run(args, is_quiet),
    }
}
