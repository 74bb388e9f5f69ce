//! `cargo xtask header`: what is made from the sources of the C ABI.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};

use crate::{declarations, shell};

/// The sources of the C ABI, in the order in which the header groups functions.
const SOURCES: [&str; 45] = [
    "errors",
    "handles",
    "solver",
    "points",
    "references",
    "constraints",
    "forces",
    "registry",
    "report",
    "explore",
    "backend",
    "problem",
    "canal/surface",
    "canal/kinks",
    "canal/grids",
    "canal/inversion",
    "canal/smoothing",
    "canal/strips",
    "canal/touching_spheres",
    "canal/two_curves",
    "canal/revolution",
    "canal/families",
    "canal/parts",
    "ruled/design",
    "ruled/levels",
    "ruled/boundaries",
    "ruled/strips",
    "ruled/conditions",
    "ruled/optimise",
    "ruled/report",
    "ruled/output",
    "ruled/planks",
    "snakes/snake",
    "snakes/fit",
    "snakes/curve",
    "snakes/surface",
    "snakes/wishes",
    "snakes/rails",
    "snakes/evolve",
    "snakes/frames",
    "snakes/cycle",
    "snakes/linkage",
    "snakes/sweep",
    "snakes/covering",
    "snakes/texts",
];

/// Writes the header and the declarations for other languages, or only compares.
pub fn run(check: bool) -> Result<()> {
    let root = shell::root();
    let source = |name: &&str| root.join("src/capi").join(name).with_extension("rs");
    let sources: Vec<PathBuf> = SOURCES.iter().map(source).collect();
    check_sources(&sources)?;
    let mut files = vec![("include/shapeop.h", header(&sources)?)];
    files.extend(declarations::files(&sources)?);
    let mut outdated = Vec::new();
    for (name, text) in files {
        let file = root.join(name);
        if !check {
            if let Some(folder) = file.parent() {
                fs::create_dir_all(folder)?;
            }
            fs::write(&file, text)?;
            continue;
        }
        let committed = fs::read_to_string(&file).with_context(|| format!("{} could not be read", file.display()))?;
        if committed != text {
            println!("{name}:");
            show_difference(&committed, &text);
            outdated.push(name);
        }
    }
    if outdated.is_empty() {
        return Ok(());
    }
    bail!("{} not what src/capi says: run `cargo xtask header` and commit the difference", outdated.join(", "))
}

/// Refuses a file with exported functions that [`SOURCES`] does not have.
fn check_sources(sources: &[PathBuf]) -> Result<()> {
    let mut folders = vec![shell::root().join("src/capi")];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() { folders.push(path) } else { files.push(path) }
        }
    }
    for file in files {
        if fs::read_to_string(&file)?.contains("#[unsafe(no_mangle)]") && !sources.contains(&file) {
            bail!("{} exports functions, and is not in the list of sources in xtask/src/header.rs", file.display());
        }
    }
    Ok(())
}

fn header(sources: &[PathBuf]) -> Result<String> {
    let config = cbindgen::Config::from_file(shell::root().join("cbindgen.toml")).map_err(anyhow::Error::msg)?;
    let mut builder = cbindgen::Builder::new().with_config(config);
    for source in sources {
        builder = builder.with_src(source);
    }
    let mut text = Vec::new();
    builder.generate().context("src/capi could not be read as C functions")?.write(&mut text);
    Ok(String::from_utf8(text)?)
}

fn show_difference(committed: &str, text: &str) {
    let (old, new): (Vec<_>, Vec<_>) = (committed.lines().collect(), text.lines().collect());
    for line in old.iter().filter(|line| !new.contains(line)) {
        println!("-{line}");
    }
    for line in new.iter().filter(|line| !old.contains(line)) {
        println!("+{line}");
    }
}
