//! `cargo xtask show gpu`: what the feature brings and costs, and what the program `benches/gpu` measures.

use std::fs;
use std::time::Instant;

use anyhow::{Context, Result};
use serde_json::Value;

use super::Figures;
use super::program::Program;
use crate::{dist, setup, shell};

/// Types with a kernel.
const KERNELS: usize = 23;

/// How crates are called that only the feature may bring.
const CRATES_OF_CARDS: [&str; 2] = ["wgpu", "naga"];

pub fn show(figures: &mut Figures) -> Result<()> {
    setup::install_tools()?;
    dependencies(figures)?;
    size_and_build_time(figures)?;
    let program = Program::build_with("gpu", "shapeop/gpu")?;
    let adapter: Value = serde_json::from_str(&program.run(&["adapter"])?)?;
    figures.group("the adapter");
    for (name, value) in adapter.as_object().context("the adapter is no object")? {
        let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        figures.says(&format!("{name}: {text}"));
    }
    if adapter["missing"].is_string() {
        figures.says("not measured: accuracy and speed, as there is no adapter");
        return Ok(());
    }
    kernels(figures)?;
    program.show(figures, &["accuracy"])?;
    if adapter["is_card"] == true {
        return program.show(figures, &["speed"]);
    }
    figures.group("speed");
    figures.says("not measured: there is no card, only the software adapter; run this where there is one");
    Ok(())
}

/// The crates of the library on this platform.
fn crates(features: &str) -> Result<Vec<String>> {
    let mut tree = shell::cargo();
    tree.args(["tree", "--locked", "--package", "shapeop", "--edges", "normal", "--prefix", "none"]);
    let text = shell::output(tree.args(["--features", features]))?;
    let lines = text.lines().map(|line| line.split_once(" (").map_or(line, |(name, _)| name).to_owned());
    let mut crates: Vec<String> = lines.collect();
    crates.sort();
    crates.dedup();
    Ok(crates)
}

fn dependencies(figures: &mut Figures) -> Result<()> {
    figures.group("the crates inside the library on this platform");
    let (without, with) = (crates("")?, crates("gpu")?);
    figures.plain("without the feature", &without.len().to_string());
    figures.plain("with it", &with.len().to_string());
    for start in CRATES_OF_CARDS {
        let count = |crates: &[String]| crates.iter().filter(|name| name.starts_with(start)).count();
        figures.exactly(&format!("{start}* without the feature"), count(&without), 0);
        figures.at_least(&format!("{start}* with it"), count(&with) as f64, 1.0);
    }
    Ok(())
}

/// Builds the library for release, without symbols, from nothing.
fn size_and_build_time(figures: &mut Figures) -> Result<()> {
    figures.group("the library for release, stripped, built from nothing");
    for (features, words) in [("", "without the feature"), ("gpu", "with it")] {
        let folder = shell::root().join("target/show/gpu-build");
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        let mut build = shell::cargo();
        build.args(["build", "--quiet", "--release", "--package", "shapeop", "--lib", "--features", features]);
        build.args(["--config", "profile.release.strip=true", "--target-dir"]).arg(&folder);
        let started = Instant::now();
        shell::run(&mut build)?;
        let seconds = started.elapsed().as_secs_f64();
        let bytes = fs::metadata(folder.join("release").join(dist::LIBRARY))?.len();
        fs::remove_dir_all(&folder)?;
        figures.plain(&format!("MB, {words}"), &format!("{:.2}", bytes as f64 / 1e6));
        figures.plain(&format!("seconds to build, {words}"), &format!("{seconds:.0}"));
    }
    Ok(())
}

/// What the tests of kernels tell, which refuse any answer that is neither near the processor's nor as good.
fn kernels(figures: &mut Figures) -> Result<()> {
    figures.group("random and degenerate constraints on the card and on the processor: differences, in diameters");
    let text = shell::output(&mut super::test_command(&["--features", "shapeop/gpu", "--test", "gpu"]))?;
    let mut lines: Vec<&str> = text.lines().filter_map(|line| line.split("kernel ").nth(1)).collect();
    lines.sort_unstable();
    lines.iter().for_each(|line| figures.says(line));
    let mut names: Vec<&str> = lines.iter().filter_map(|line| line.split(':').next()).collect();
    names.dedup();
    figures.exactly("types with kernels whose tests pass", names.len(), KERNELS);
    Ok(())
}
