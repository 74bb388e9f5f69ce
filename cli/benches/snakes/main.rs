//! Measurements of circular arc snakes for `cargo xtask show snakes`, and the drawing of the paper's figures.

mod figures;
#[path = "../exploration/group.rs"]
mod group;
mod own;
mod shapes;
mod speed;
mod truths;

use std::path::Path;

use anyhow::Result;

const USAGE: &str = "usage:
  snakes truths [NAME]          analytic truths, recomputed
  snakes figures FOLDER [NAME]  figures of the paper; pictures go into FOLDER
  snakes speed                  milliseconds per step";

fn main() -> Result<()> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["truths", rest @ ..] => truths::print(rest.first().copied())?,
        ["figures", folder, rest @ ..] => figures::draw(Path::new(folder), rest.first().copied())?,
        ["speed"] => speed::groups()?.iter().for_each(|group| println!("{group}")),
        _ => println!("{USAGE}"),
    }
    Ok(())
}
