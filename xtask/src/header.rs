//! `cargo xtask header`.

use std::fs;

use anyhow::{Context, Result, bail};

use crate::shell;

/// The sources of the header, in the order in which it groups functions.
const SOURCES: [&str; 7] = ["errors", "handles", "solver", "points", "constraints", "forces", "registry"];
/// The last group.
const LAST_SOURCE: &str = "report";

/// Writes the header, or only compares.
pub fn run(check: bool) -> Result<()> {
    let root = shell::root();
    let config = cbindgen::Config::from_file(root.join("cbindgen.toml")).map_err(anyhow::Error::msg)?;
    let mut builder = cbindgen::Builder::new().with_config(config);
    for source in SOURCES.iter().chain([&LAST_SOURCE]) {
        builder = builder.with_src(root.join("src/capi").join(source).with_extension("rs"));
    }
    let mut text = Vec::new();
    builder.generate().context("src/capi could not be read as C functions")?.write(&mut text);
    let text = String::from_utf8(text)?;
    let file = root.join("include/shapeop.h");
    if !check {
        fs::write(&file, text)?;
        return Ok(());
    }
    let committed = fs::read_to_string(&file).with_context(|| format!("{} could not be read", file.display()))?;
    if committed == text {
        return Ok(());
    }
    let (old, new): (Vec<_>, Vec<_>) = (committed.lines().collect(), text.lines().collect());
    for line in old.iter().filter(|line| !new.contains(line)) {
        println!("-{line}");
    }
    for line in new.iter().filter(|line| !old.contains(line)) {
        println!("+{line}");
    }
    bail!("include/shapeop.h is not what src/capi says: run `cargo xtask header` and commit the difference")
}
