//! `cargo xtask bench`: the six problems side by side with compas-shapeop, and the page that tells of it.

mod machine;
pub mod measure;
mod page;
mod peer;
mod plot;

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;

use crate::shell;
use measure::{Measurements, Plan};

/// What to measure.
#[derive(Args, Clone, Debug)]
pub struct Options {
    /// One size, few repetitions, no page: shows only that everything runs.
    #[arg(long)]
    quick: bool,
    /// Numbers of vertices.
    #[arg(long, value_delimiter = ',')]
    sizes: Vec<u32>,
    /// Names of problems.
    #[arg(long, value_delimiter = ',')]
    problems: Vec<String>,
    /// Interleaved repetitions of each measurement, whose medians count.
    #[arg(long)]
    repetitions: Option<usize>,
    /// The Cargo profile to build with; the times of others than `release` mean nothing.
    #[arg(long, default_value = "release")]
    profile: String,
}

/// Everything that the page and `cargo xtask show speed` need.
const SIZES: [u32; 5] = [1_000, 10_000, 50_000, 100_000, 1_000_000];

/// Interleaved repetitions, unless others are asked for.
const REPETITIONS: usize = 5;

/// Measures, prints, and writes `docs/benchmarks.md` and its plot, unless only some of it is asked for.
pub fn run(options: &Options) -> Result<()> {
    let is_all = options.sizes.is_empty() && options.problems.is_empty() && !options.quick;
    let measurements = measure(options)?;
    if is_all {
        let docs = shell::root().join("docs");
        fs::write(docs.join("benchmarks.md"), page::page(&measurements))?;
        fs::write(docs.join("images/scaling.svg"), plot::scaling(&measurements)?)?;
        println!("docs/benchmarks.md and docs/images/scaling.svg were written");
    } else {
        println!("\n{}", page::page(&measurements));
    }
    Ok(())
}

/// Measures all that the page tells.
pub fn measure_all(repetitions: Option<usize>) -> Result<Measurements> {
    let (sizes, problems, profile) = (Vec::new(), Vec::new(), "release".to_owned());
    measure(&Options { quick: false, sizes, problems, repetitions, profile })
}

/// What the last call measured, if it measured all.
pub fn last() -> Result<Measurements> {
    let file = record();
    let text = fs::read_to_string(&file).with_context(|| format!("{} is not there: measure first", file.display()))?;
    Ok(serde_json::from_str(&text)?)
}

fn record() -> PathBuf {
    folder().join("measurements.json")
}

/// Where models, the peer and the measurements go.
fn folder() -> PathBuf {
    shell::root().join("target/bench")
}

fn measure(options: &Options) -> Result<Measurements> {
    fs::create_dir_all(folder())?;
    let is_ci = std::env::var("CI").as_deref() == Ok("true");
    let peer = peer::set_up(&folder().join("peer"));
    if let (true, Err(reason)) = (is_ci, &peer) {
        anyhow::bail!("CI leaves nothing out, but compas-shapeop is missing: {reason:#}");
    }
    let sizes = match (options.quick, options.sizes.is_empty()) {
        (true, true) => vec![400],
        (false, true) => SIZES.to_vec(),
        _ => options.sizes.clone(),
    };
    let plan = Plan {
        sizes,
        problems: options.problems.clone(),
        repetitions: options.repetitions.unwrap_or(if options.quick { 1 } else { REPETITIONS }).max(1),
        is_quick: options.quick,
        profile: options.profile.clone(),
    };
    let measurements = measure::all(&plan, &peer, &folder())?;
    if options.sizes.is_empty() && options.problems.is_empty() && !options.quick {
        fs::write(record(), serde_json::to_string_pretty(&measurements)?)?;
    }
    Ok(measurements)
}
