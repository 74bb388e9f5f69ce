//! Measurements of ruled free forms for `cargo xtask show ruled`.

#[path = "../exploration/group.rs"]
mod group;
mod optimisation;
mod shapes;
mod speed;

use anyhow::Result;

const USAGE: &str = "usage:
  ruled optimisation  strips of five surfaces, optimised and judged
  ruled speed         seconds per step for a mesh of 50 000 triangles and 30 strips";

fn main() -> Result<()> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["optimisation"] => optimisation::groups()?.iter().for_each(|group| println!("{group}")),
        ["speed"] => println!("{}", speed::group()?),
        _ => println!("{USAGE}"),
    }
    Ok(())
}
