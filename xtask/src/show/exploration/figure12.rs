//! Fig. 12's protocol: this library and IPOPT on one problem, to one solution, in one run.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};
use serde::Deserialize;
use serde_json::Value;

use super::{Program, plot};
use crate::bench::measure::median;
use crate::show::Figures;
use crate::{bindings, shell};

/// Points along a side.
const SIDES: [u32; 2] = [21, 61];

/// Distances from the solution, over that of the start; at two of them, at least so many times sooner than IPOPT.
pub const DISTANCES: [f64; 6] = [0.5, 0.2, 0.1, 0.01, 1e-3, 1e-6];
const SOONER: [(f64, f64); 2] = [(0.1, 100.0), (1e-6, 10.0)];

/// Interleaved runs of both; medians of the seconds count.
const REPETITIONS: usize = 3;

/// Runs of this library beside each of the peer: they take milliseconds, and one that is disturbed shows.
const OWN_RUNS: usize = 5;

/// A run as both programs tell it.
#[derive(Deserialize)]
pub struct Course {
    pub iterations: Vec<Iteration>,
    objective: f64,
    /// Beyond the bound, in mean edges.
    violation: f64,
    delta: f64,
}

/// Where a run was.
#[derive(Deserialize)]
pub struct Iteration {
    iteration: u32,
    pub seconds: f64,
    pub delta: f64,
}

impl Course {
    /// The first iteration nearer than `distance`.
    fn reached(&self, distance: f64) -> Option<&Iteration> {
        self.iterations.iter().find(|iteration| iteration.delta < distance)
    }
}

/// Runs of one solver on one problem.
pub struct Runs(pub Vec<Course>);

impl Runs {
    /// Iterations and the median of the seconds to `distance`.
    fn reached(&self, distance: f64) -> Option<(u32, f64)> {
        let all: Option<Vec<&Iteration>> = self.0.iter().map(|course| course.reached(distance)).collect();
        let all = all?;
        Some((all.first()?.iteration, median(all.iter().map(|iteration| iteration.seconds).collect())))
    }
}

pub fn show(figures: &mut Figures, program: &Program, images: &Path) -> Result<()> {
    let Some(python) = bindings::peers()? else {
        figures.group("Fig. 12: against IPOPT");
        figures.not_measured("CPython 3.11 or later is missing", "compared");
        return Ok(());
    };
    let mut all = Vec::new();
    for n in SIDES {
        let reference = shell::root().join(format!("tests/exploration/fig12_{n}.json"));
        let known: Value = serde_json::from_str(&fs::read_to_string(&reference)?)?;
        let known = known["objective"].as_f64().context("the reference has no objective")?;
        let (mut own, mut peer) = (Runs(Vec::new()), Runs(Vec::new()));
        for _ in 0..REPETITIONS {
            for _ in 0..OWN_RUNS {
                let text = program.run(&["figure12", &n.to_string(), &reference.to_string_lossy()])?;
                own.0.push(serde_json::from_str(&text)?);
            }
            peer.0.push(ipopt(&python, n, &reference)?);
        }
        figures.group(&format!("Fig. 12: {n} × {n} points, one thread each, set-up and symbolic work included"));
        let runs = OWN_RUNS * REPETITIONS;
        figures.says(&format!(
            "iterations / seconds (medians of {runs} and {REPETITIONS}): this library, IPOPT (MUMPS, casadi)"
        ));
        for distance in DISTANCES {
            let words = |runs: &Runs| {
                runs.reached(distance).map_or("–".into(), |(count, seconds)| format!("{count} / {seconds:.4}"))
            };
            figures.plain(&format!("to δ < {distance:e}"), &format!("{}, {}", words(&own), words(&peer)));
        }
        for (distance, times) in SOONER {
            let name = format!("n = {n}: times sooner at δ < {distance:e}");
            match (own.reached(distance), peer.reached(distance)) {
                (Some((_, own)), Some((_, peer))) => figures.at_least(&name, peer / own, times),
                _ => figures.not_measured(&name, &format!("at least {times}")),
            }
        }
        let ends = || own.0.iter().chain(&peer.0);
        let largest = |of: &dyn Fn(&Course) -> f64| ends().map(of).fold(0.0, f64::max);
        let off = largest(&|course| (course.objective - known).abs() / known);
        figures.at_most(&format!("n = {n}: objectives, both ends, relative to p*'s"), off, 1e-8);
        figures.at_most(&format!("n = {n}: δ, both ends"), largest(&|course| course.delta), 1e-6);
        let beyond = largest(&|course| course.violation);
        figures.at_most(&format!("n = {n}: violation, both ends / mean edge"), beyond, 1e-9);
        all.push((n, own, peer));
    }
    fs::create_dir_all(images)?;
    let file = images.join("figure12.svg");
    fs::write(&file, plot::distances(&all)?)?;
    figures.says(&file.display().to_string());
    Ok(())
}

fn ipopt(python: &Path, n: u32, reference: &Path) -> Result<Course> {
    let out = shell::root().join("target/peers").join(format!("ipopt_{n}.json"));
    let mut command = Command::new(python);
    command.arg(shell::root().join("benches/peers/ipopt.py")).arg(n.to_string()).arg(&out);
    shell::output(command.arg("--reference").arg(reference).env("PYTHONDONTWRITEBYTECODE", "1"))?;
    Ok(serde_json::from_str(&fs::read_to_string(out)?)?)
}
