//! Programs of `cli/benches` and `benches` that measure and draw, and tell groups of figures as lines of JSON.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};
use serde_json::Value;

use super::Figures;
use crate::bench::measure;
use crate::shell;

/// A program that measures.
pub struct Program(PathBuf);

impl Program {
    /// The program of this name, built in release.
    pub fn build(name: &str) -> Result<Self> {
        Self::build_with(name, "")
    }

    /// The same with features of the library.
    pub fn build_with(name: &str, features: &str) -> Result<Self> {
        Ok(Self(measure::build(name, "release", features)?))
    }

    /// What it prints.
    pub fn run(&self, words: &[&str]) -> Result<String> {
        shell::output(Command::new(&self.0).args(words).current_dir(shell::root()))
    }

    /// Prints the groups of figures that it tells.
    pub fn show(&self, figures: &mut Figures, words: &[&str]) -> Result<()> {
        for line in self.run(words)?.lines() {
            let group: Value = serde_json::from_str(line)?;
            let text = |name: &str| group[name].as_str().unwrap_or_default();
            figures.group(text("title"));
            figures.says(text("claim"));
            group["measures"].as_array().context("no measures")?.iter().try_for_each(|each| figures.measure(each))?;
            if let Some(picture) = group["picture"].as_str() {
                figures.exactly("picture", usize::from(Path::new(picture).is_file()), 1);
            }
        }
        Ok(())
    }
}
