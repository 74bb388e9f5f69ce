//! `cargo xtask bench`: the six problems side by side with compas-shapeop, plain and accelerated, and the pages that tell of
//! it.

pub mod energies;
mod machine;
pub mod measure;
mod page;
mod peer;
pub mod plot;

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::shell;
use energies::Energies;
use measure::{Measurements, Plan, Runner};

/// What to measure.
#[derive(Args, Clone, Debug, Default)]
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
    /// Only the energy over evaluations, plain and accelerated.
    #[arg(long)]
    energies: bool,
    /// Methods to show the energy for, as `plain` or `anderson:12`, the number being the memory; printed only.
    #[arg(long, value_delimiter = ',', requires = "energies")]
    methods: Vec<String>,
    /// The Cargo profile to build with; the times of others than `release` mean nothing.
    #[arg(long, default_value = "release")]
    profile: String,
}

/// Everything that the page and `cargo xtask show speed` need.
const SIZES: [u32; 5] = [1_000, 10_000, 50_000, 100_000, 1_000_000];

/// Interleaved repetitions, unless others are asked for.
const REPETITIONS: usize = 5;

/// Measures, prints, and writes `docs/benchmarks.md`, the table in `docs/acceleration.md` and the plots of both, unless only
/// some of it is asked for.
pub fn run(options: &Options) -> Result<()> {
    let bench = Bench::new(options)?;
    let docs = shell::root().join("docs");
    if !options.energies {
        let measurements = bench.measure()?;
        if bench.is_all {
            fs::write(docs.join("benchmarks.md"), page::page(&measurements))?;
            fs::write(docs.join("images/scaling.svg"), plot::scaling(&measurements)?)?;
            println!("docs/benchmarks.md and docs/images/scaling.svg were written");
        } else {
            println!("\n{}", page::page(&measurements));
        }
    }
    if options.energies || bench.plan.is_quick || bench.plan.sizes.contains(&energies::SIZE) {
        let energies = bench.energies()?;
        // Drawn in any case: quick runs show that it works.
        let (part, drawing) = (page::energies(&energies), plot::energies(&energies)?);
        if bench.is_all {
            let file = docs.join("acceleration.md");
            fs::write(&file, page::replaced(&fs::read_to_string(&file)?, &part)?)?;
            fs::write(docs.join("images/energy.svg"), drawing)?;
            println!("the table in docs/acceleration.md and docs/images/energy.svg were written");
        } else {
            println!("\n{part}");
        }
    }
    Ok(())
}

/// Measures all that the pages tell.
pub fn measure_all(repetitions: Option<usize>) -> Result<(Measurements, Energies)> {
    let bench = Bench::new(&Options { repetitions, profile: "release".into(), ..Options::default() })?;
    Ok((bench.measure()?, bench.energies()?))
}

/// What the last calls measured that measured all.
pub fn last() -> Result<(Measurements, Energies)> {
    Ok((read(MEASUREMENTS)?, read(ENERGIES)?))
}

/// The files of the last measurements.
const MEASUREMENTS: &str = "measurements.json";
const ENERGIES: &str = "energies.json";

fn read<T: DeserializeOwned>(name: &str) -> Result<T> {
    let file = folder().join(name);
    let text = fs::read_to_string(&file).with_context(|| format!("{} is not there: measure first", file.display()))?;
    Ok(serde_json::from_str(&text)?)
}

/// Where models, the peer and the measurements go.
fn folder() -> PathBuf {
    shell::root().join("target/bench")
}

/// What to measure, and with what.
struct Bench {
    plan: Plan,
    methods: Vec<String>,
    runner: Runner,
    /// True if nothing was left out.
    is_all: bool,
}

impl Bench {
    fn new(options: &Options) -> Result<Self> {
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
        let methods = match options.methods.as_slice() {
            [] => energies::METHODS.map(String::from).to_vec(),
            methods => methods.to_vec(),
        };
        let is_part = [&options.problems, &options.methods].iter().any(|names| !names.is_empty());
        let is_all = !(options.quick || is_part) && options.sizes.is_empty();
        Ok(Self { plan, methods, runner: Runner::new(&options.profile, peer, folder())?, is_all })
    }

    fn measure(&self) -> Result<Measurements> {
        let measurements = measure::all(&self.runner, &self.plan)?;
        self.record(MEASUREMENTS, &measurements)?;
        Ok(measurements)
    }

    fn energies(&self) -> Result<Energies> {
        let energies = energies::measure(&self.runner, &self.plan, &self.methods)?;
        self.record(ENERGIES, &energies)?;
        Ok(energies)
    }

    /// Keeps what was measured, if that is all.
    fn record(&self, name: &str, measured: &impl Serialize) -> Result<()> {
        if self.is_all {
            fs::write(folder().join(name), serde_json::to_string_pretty(measured)?)?;
        }
        Ok(())
    }
}
