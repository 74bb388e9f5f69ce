//! `cargo xtask show AREA`: what the library promises, measured, each figure beside its target.

mod bindings;
mod canal;
mod engine;
mod exploration;
mod gpu;
mod program;
mod ruled;
mod snakes;
mod speed;

use std::process::Command;

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use serde_json::Value;

use crate::shell;

/// What can be shown.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Area {
    /// Demo, parity, recipes on real meshes, a million vertices, random calls of the C functions.
    Engine,
    /// Times beside compas-shapeop and the floor, threads, scaling, acceleration, a moving handle.
    Speed,
    /// The Python package, Grasshopper components and files, all languages, the paper's examples.
    Bindings,
    /// Super-canal surfaces: ground truths, speed, attainable lengths, the paper's figures with pictures, named families.
    Canal,
    /// Hard constraints: projections, exact planarity, IPOPT, the paper's figures, a large drag, contradictions, weights.
    Exploration,
    /// The graphics card: what the feature brings and costs, energies against those of the processor, times on a card.
    Gpu,
    /// Ruled free forms: ground truths, strips of five surfaces, the paper's figures with pictures, seconds per step for a large mesh.
    Ruled,
    /// Circular arc snakes: ground truths, the linkage that comes back, milliseconds per step, the paper's figures with pictures.
    Snakes,
}

/// Measures and prints; fails if a figure is short of its target.
pub fn run(area: Area, reuse: bool, repetitions: Option<usize>) -> Result<()> {
    let mut figures = Figures::default();
    match area {
        Area::Engine => engine::show(&mut figures)?,
        Area::Speed => speed::show(&mut figures, reuse, repetitions)?,
        Area::Exploration => exploration::show(&mut figures)?,
        Area::Canal => canal::show(&mut figures)?,
        Area::Bindings => bindings::show(&mut figures)?,
        Area::Gpu => gpu::show(&mut figures)?,
        Area::Ruled => ruled::show(&mut figures)?,
        Area::Snakes => snakes::show(&mut figures)?,
    }
    println!();
    if figures.short.is_empty() {
        println!("{} figures, none short", figures.count);
        return Ok(());
    }
    bail!("{} of {} figures short: {}", figures.short.len(), figures.count, figures.short.join(", "))
}

/// The figures printed so far.
#[derive(Default)]
pub struct Figures {
    count: usize,
    short: Vec<String>,
}

impl Figures {
    /// Begins a group of figures.
    pub fn group(&mut self, title: &str) {
        println!("\n{title}");
    }

    /// What a program said, without a figure.
    pub fn says(&self, text: &str) {
        text.lines().for_each(|line| println!("  {line}"));
    }

    /// A figure that must not exceed its target.
    pub fn at_most(&mut self, name: &str, value: f64, target: f64) {
        self.line(name, &number(value), &format!("at most {}", number(target)), value <= target);
    }

    /// A figure that must reach its target.
    pub fn at_least(&mut self, name: &str, value: f64, target: f64) {
        self.line(name, &number(value), &format!("at least {}", number(target)), value >= target);
    }

    /// A figure that could not be measured: short of its target, whatever that is.
    pub fn not_measured(&mut self, name: &str, target: &str) {
        self.line(name, "not measured", target, false);
    }

    /// A figure that must be exactly its target.
    pub fn exactly(&mut self, name: &str, value: usize, target: usize) {
        self.line(name, &value.to_string(), &target.to_string(), value == target);
    }

    /// A measure as programs tell it: `what`, its `unit` if it has one, its `value`, and its bounds `least` and `most`.
    pub fn measure(&mut self, measure: &Value) -> Result<()> {
        let text = |name: &str| measure[name].as_str().unwrap_or_default();
        let name = format!("{} in {}", text("what"), text("unit"));
        let name = name.trim_end_matches(" in ");
        let value = measure["value"].as_f64().with_context(|| format!("expected a number as value of {name}"))?;
        match (measure["least"].as_f64(), measure["most"].as_f64()) {
            (None, None) => self.plain(name, &number(value)),
            (Some(least), Some(most)) if least == most => {
                self.line(name, &number(value), &number(least), value == least);
            }
            (least, most) => {
                least.into_iter().for_each(|least| self.at_least(name, value, least));
                most.into_iter().for_each(|most| self.at_most(name, value, most));
            }
        }
        Ok(())
    }

    /// A figure without a target.
    pub fn plain(&mut self, name: &str, value: &str) {
        println!("  {name:<58} {value:>12}");
    }

    fn line(&mut self, name: &str, value: &str, target: &str, is_ok: bool) {
        self.count += 1;
        let verdict = if is_ok { "ok" } else { "short" };
        println!("  {name:<58} {value:>12}  {target:<18} {verdict}");
        if !is_ok {
            self.short.push(name.to_owned());
        }
    }
}

/// A number in four digits, plainly or in powers of ten; a whole one as such.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if size < 1e5 && value.fract() == 0.0 => format!("{value}"),
        1e-3..1e5 => format!("{value:.4}"),
        _ => format!("{value:.1e}"),
    }
}

/// Tests of the library in release, with what they print.
fn test_command(which: &[&str]) -> Command {
    let mut command = shell::cargo();
    // With the workspace's selection of packages, as programs that measure are built.
    command.args(["test", "--quiet", "--release", "--workspace"]).args(which).args(["--", "--nocapture"]);
    command
}
