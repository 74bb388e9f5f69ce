//! `cargo xtask show ruled`: what the program `cli/benches/ruled` measures and draws.

use anyhow::Result;

use super::Figures;
use super::program::Program;
use crate::shell;

pub fn show(figures: &mut Figures) -> Result<()> {
    let program = Program::build("ruled")?;
    let images = shell::root().join("docs/images/ruled");
    program.show(figures, &["truths"])?;
    program.show(figures, &["optimisation"])?;
    program.show(figures, &["figures", &images.to_string_lossy()])?;
    program.show(figures, &["speed"])
}
