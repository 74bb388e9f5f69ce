//! `cargo xtask`: set-up and checks. No product code.

mod bench;
mod bindings;
mod declarations;
mod dist;
mod docs;
mod header;
mod languages;
mod licences;
mod setup;
mod shell;
mod show;
mod suites;
mod test;

use std::path::PathBuf;

use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(name = "cargo xtask", about = "Set-up and checks of the shapeop repository")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Time the six problems beside compas-shapeop; write docs/benchmarks.md. CI=true: fail if compas-shapeop is missing.
    Bench(bench::Options),
    /// Build the library and lay out an installation for C and C++ hosts, CMake and pkg-config.
    Dist {
        /// The folder to fill: lib/, include/, share/, and compat/ for hosts of libShapeOp.
        folder: PathBuf,
        /// The Cargo profile to build with.
        #[arg(long, default_value = "release")]
        profile: String,
        /// Build the library with the feature `gpu`: solving on the graphics card.
        #[arg(long)]
        gpu: bool,
    },
    /// Write what is made from src/capi: include/shapeop.h, and the declarations for Python and C#.
    Header {
        /// Write nothing; fail with the difference if the committed files are others.
        #[arg(long)]
        check: bool,
    },
    /// Write what is made from the code and from Cargo.lock: docs/constraints.md, docs/problem.schema.json, and the
    /// licences of the crates inside the library.
    Docs,
    /// Measure what the library promises; print each figure beside its target; fail if one is short.
    Show {
        /// What to show.
        area: show::Area,
        /// Show speed from what the last `cargo xtask bench` measured, instead of measuring again.
        #[arg(long)]
        reuse: bool,
        /// Interleaved repetitions of each measurement of speed.
        #[arg(long)]
        repetitions: Option<usize>,
    },
    /// Set up what the tests need, then run all of them. CI=true: fail if anything is missing.
    Test,
}

fn main() -> anyhow::Result<()> {
    match Arguments::parse().command {
        Command::Bench(options) => bench::run(&options),
        Command::Dist { folder, profile, gpu } => dist::run(&folder, &profile, gpu),
        Command::Header { check } => header::run(check),
        Command::Docs => docs::run(),
        Command::Show { area, reuse, repetitions } => show::run(area, reuse, repetitions),
        Command::Test => test::run(),
    }
}
