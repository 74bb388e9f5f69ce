//! `cargo xtask show ruled`: what the program `cli/benches/ruled` measures.

use anyhow::Result;

use super::Figures;
use super::program::Program;

pub fn show(figures: &mut Figures) -> Result<()> {
    let program = Program::build("ruled")?;
    program.show(figures, &["optimisation"])?;
    program.show(figures, &["speed"])
}
