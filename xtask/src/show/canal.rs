//! `cargo xtask show canal`: what the program `cli/benches/canal` measures and draws.

use anyhow::Result;

use super::Figures;
use super::program::Program;
use crate::shell;

pub fn show(figures: &mut Figures) -> Result<()> {
    let program = Program::build("canal")?;
    let images = shell::root().join("docs/images/canal");
    program.show(figures, &["truths"])?;
    program.show(figures, &["speed"])?;
    program.show(figures, &["lengths"])?;
    program.show(figures, &["figures", &images.to_string_lossy()])?;
    program.show(figures, &["families", &images.to_string_lossy()])
}
