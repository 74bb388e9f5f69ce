//! `cargo xtask show snakes`: what the program `cli/benches/snakes` measures and draws.

use anyhow::Result;

use super::Figures;
use super::program::Program;
use crate::shell;

pub fn show(figures: &mut Figures) -> Result<()> {
    let program = Program::build("snakes")?;
    let images = shell::root().join("docs/images/snakes");
    program.show(figures, &["truths"])?;
    program.show(figures, &["figures", &images.to_string_lossy()])?;
    program.show(figures, &["speed"])
}
