//! What exploration promises, measured, and the figures of Deng et al. 2015 drawn. `cargo xtask show exploration` runs it. Each
//! call prints lines of JSON.

mod costa;
mod drag;
mod figure12;
mod figures;
mod group;
mod sensitivities;
mod session;

use std::path::Path;

use anyhow::Result;

const USAGE: &str = "usage:
  exploration figure12 N REFERENCE.json      the course of a solve of Fig. 12's problem, one thread; see figure12.rs
  exploration costa                          exact planarity on the Costa surface
  exploration drag                           20 449 points, one handle dragged in frames of 25 ms
  exploration sensitivities                  derivatives by weights against differences
  exploration figures FOLDER [NAME]          figures 1, 2, 5, 8, 9, 10 and 11; pictures go into FOLDER";

fn main() -> Result<()> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["figure12", n, reference] => println!("{}", figure12::course(n.parse()?, Path::new(reference))?),
        ["sensitivities"] => println!("{}", sensitivities::group()?),
        ["costa"] => println!("{}", costa::group()?),
        ["drag"] => {
            for held in [drag::Held::Diagonals, drag::Held::Planes] {
                println!("{}", drag::group(held)?);
            }
        }
        ["figures", folder, rest @ ..] => figures::draw(Path::new(folder), rest.first().copied())?,
        _ => println!("{USAGE}"),
    }
    Ok(())
}
