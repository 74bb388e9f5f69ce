//! Measurements of ruled free forms for `cargo xtask show ruled`, and the drawing of the paper's figures.

mod figures;
#[path = "../exploration/group.rs"]
mod group;
mod optimisation;
mod shapes;
mod speed;
mod truths;

use std::path::Path;

use anyhow::Result;

const USAGE: &str = "usage:
  ruled truths [NAME]          analytic truths, recomputed
  ruled optimisation           strips of five surfaces, optimised and judged
  ruled figures FOLDER [NAME]  figures of the paper; pictures go into FOLDER
  ruled speed                  seconds per step for a mesh of 50 000 triangles and 30 strips";

fn main() -> Result<()> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["truths", rest @ ..] => truths::print(rest.first().copied())?,
        ["optimisation"] => optimisation::groups()?.iter().for_each(|group| println!("{group}")),
        ["figures", folder, rest @ ..] => figures::draw(Path::new(folder), rest.first().copied())?,
        ["speed"] => println!("{}", speed::group()?),
        _ => println!("{USAGE}"),
    }
    Ok(())
}
