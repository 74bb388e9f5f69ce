//! The command line of `shapeop`. It reads files, calls the library, and writes files: nothing that a Rust program
//! could not do.

mod args;
mod cells;
mod commands;
mod curve_file;
mod drag;
mod exploration;
mod moves;
mod output;
mod plot;
mod progress;
mod quality;
mod report;
mod run;
mod shown;
mod table;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};
use shapeop_cli::{animation, colours, picture, raster};

/// How a command ended that did not fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    Done,
    /// Ctrl-C; what was reached is written.
    Interrupted,
    /// Hard constraints contradict each other; what meets the others is written.
    Infeasible,
    /// The graphics card was lost or refused work; what was reached is written.
    BackendFailed,
}

/// The exit code where hard constraints contradict each other.
const INFEASIBLE: u8 = 3;

/// The exit code of a program that was stopped with Ctrl-C: 128 and the number of SIGINT.
const INTERRUPTED: u8 = 130;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let is_quiet = cli.quiet;
    let ending = match cli.command {
        Command::Demo(args) => commands::demo::run(&args, is_quiet),
        Command::Solve(args) => commands::solve::run(&args, is_quiet),
        Command::Planarize(args) => commands::recipe::run(commands::recipe::Recipe::Planarize, &args, is_quiet),
        Command::Circularize(args) => commands::recipe::run(commands::recipe::Recipe::Circularize, &args, is_quiet),
        Command::Smooth(args) => commands::recipe::run(commands::recipe::Recipe::Smooth, &args, is_quiet),
        Command::Regularize(args) => commands::recipe::run(commands::recipe::Recipe::Regularize, &args, is_quiet),
        Command::Equalize(args) => {
            let recipe = commands::recipe::Recipe::Equalize { length: args.length };
            commands::recipe::run(recipe, &args.recipe, is_quiet)
        }
        Command::Rationalize(args) => {
            let recipe = commands::recipe::Recipe::Rationalize { diagonals: args.diagonals };
            commands::recipe::run(recipe, &args.recipe, is_quiet)
        }
        Command::Circumscribe(args) => commands::recipe::run(commands::recipe::Recipe::Circumscribe, &args, is_quiet),
        Command::Explore(args) => commands::explore::run(&args, is_quiet),
        Command::Check(args) => commands::check::run(&args, is_quiet),
        Command::Canal(args) => commands::canal::run(&args.command, is_quiet),
        Command::Ruled(args) => commands::ruled::run(&args, is_quiet),
        Command::Snake(args) => commands::snake::run(&args.command, is_quiet),
        Command::Types(args) => commands::types::run(&args, is_quiet),
    };
    match ending {
        Ok(Ending::Done) => ExitCode::SUCCESS,
        Ok(Ending::Interrupted) => ExitCode::from(INTERRUPTED),
        Ok(Ending::Infeasible) => ExitCode::from(INFEASIBLE),
        Ok(Ending::BackendFailed) => {
            let text = "the graphics card failed; what was reached is written, and the report says what happened";
            let _ = writeln!(std::io::stderr(), "error: {text}");
            ExitCode::FAILURE
        }
        Err(error) => {
            // A closed standard error leaves the exit code to tell.
            let _ = writeln!(std::io::stderr(), "error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
