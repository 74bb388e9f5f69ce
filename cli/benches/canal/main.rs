//! Measurements of super-canal surfaces for `cargo xtask show canal`, and the drawing of the paper's figures.

mod families;
mod figures;
#[path = "../exploration/group.rs"]
mod group;
mod lengths;
mod shapes;
mod speed;
mod truths;

use std::path::Path;

use anyhow::Result;

const USAGE: &str = "usage:
  canal truths                 analytic truths and independent checks, recomputed
  canal speed                  times, one core
  canal lengths                C-canal surfaces: lengths attained, lengths that are not attainable
  canal figures FOLDER [NAME]  figures of the paper; pictures go into FOLDER
  canal families FOLDER        one mesh of each named family; a picture goes into FOLDER";

fn main() -> Result<()> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["speed"] => speed::groups()?.iter().for_each(|group| println!("{group}")),
        ["truths"] => truths::groups()?.iter().for_each(|group| println!("{group}")),
        ["figures", folder, rest @ ..] => figures::draw(Path::new(folder), rest.first().copied())?,
        ["lengths"] => lengths::groups()?.iter().for_each(|group| println!("{group}")),
        ["families", folder] => families::groups(Path::new(folder))?.iter().for_each(|group| println!("{group}")),
        _ => println!("{USAGE}"),
    }
    Ok(())
}
