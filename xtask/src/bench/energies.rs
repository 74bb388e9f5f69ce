//! The energy over the evaluations of plain and accelerated solves, and the part of `docs/acceleration.md` that shows it.

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

use super::machine;
use super::measure::{Plan, Runner, median};

/// The problems, the six first.
const PROBLEMS: [&str; 7] = ["planar_quads", "cloth", "squares", "shell", "tets", "circles", "quad_circles"];

/// Vertices of each.
pub const SIZE: u32 = 10_000;

/// What is compared, as `benches/energies.rs` calls it: plain iterations, and both methods with their default memory.
pub const METHODS: [&str; 3] = ["plain", "anderson", "quasi-newton"];

/// Iterations after which a run ends, a plain and an accelerated one. The latter tell `E*`: on squares they go on for long.
const ITERATIONS: [u32; 2] = [2000, 10_000];
const QUICK_ITERATIONS: [u32; 2] = [1000, 100];

/// Repetitions of each run; energies are the same in all, of seconds the median counts.
const REPETITIONS: usize = 5;

/// Runs of more seconds are not repeated.
const LONG_RUN: f64 = 2.0;

/// The relative errors of the energy that the tables tell about.
pub const ERRORS: [f64; 3] = [1e-3, 1e-6, 1e-9];

/// The problem whose time to [`PEER_ERROR`] is measured with compas-shapeop too.
const PROBLEM_OF_PEER: &str = "planar_quads";
const PEER_ERROR: f64 = 1e-6;

/// Everything that was measured.
#[derive(Debug, Serialize, Deserialize)]
pub struct Energies {
    /// One line.
    pub machine: String,
    /// The day in UTC.
    pub date: String,
    /// Problem by problem.
    pub problems: Vec<Problem>,
}

/// The runs of one problem.
#[derive(Debug, Serialize, Deserialize)]
pub struct Problem {
    /// Its name.
    pub name: String,
    /// Its vertices.
    pub vertices: u64,
    /// One per method.
    pub curves: Vec<Curve>,
    /// compas-shapeop's, where it was measured.
    pub peer: Option<Peer>,
}

/// What one method did.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Curve {
    /// As `benches/energies.rs` calls it.
    #[serde(default)]
    pub method: String,
    /// Milliseconds to initialise.
    pub init_ms: f64,
    /// The energy after each iteration.
    pub energies: Vec<f64>,
    /// Evaluations so far.
    pub evaluations: Vec<u32>,
    /// Seconds so far, those to initialise excluded.
    pub seconds: Vec<f64>,
    /// The first iteration, from 0, whose largest move is below the default tolerance.
    pub default_stop: Option<usize>,
}

/// compas-shapeop over as many iterations as plain ones need to [`PEER_ERROR`].
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Peer {
    /// Those iterations.
    pub iterations: u32,
    /// Milliseconds to initialise and make them.
    pub total_ms: f64,
}

impl Energies {
    /// The runs of a problem.
    pub fn problem(&self, name: &str) -> Option<&Problem> {
        self.problems.iter().find(|problem| problem.name == name)
    }
}

impl Problem {
    /// `E*`, the lowest energy seen in any run.
    fn lowest(&self) -> f64 {
        self.curves.iter().flat_map(|curve| &curve.energies).copied().fold(f64::INFINITY, f64::min)
    }

    /// What a method did.
    pub fn curve(&self, method: &str) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.method == method)
    }

    /// `(E − E*)/|E*|` after each iteration of a curve.
    pub fn errors(&self, curve: &Curve) -> Vec<f64> {
        let lowest = self.lowest();
        curve.energies.iter().map(|energy| (energy - lowest) / lowest.abs()).collect()
    }

    /// Evaluations and seconds until a curve is within a relative error.
    pub fn reached(&self, curve: &Curve, error: f64) -> Option<(u32, f64)> {
        let lowest = self.lowest();
        curve.until(lowest + error * lowest.abs())
    }

    /// Evaluations and seconds until a curve is as low as plain iterations end, where these do not get as near to `E*` as the
    /// tables ask: beyond that it would be a matter of rounding.
    pub fn reached_plain_end(&self, curve: &Curve) -> Option<(u32, f64)> {
        let plain = self.curve(METHODS[0]).filter(|plain| self.reached(plain, ERRORS[2]).is_none())?;
        curve.until(*plain.energies.last()?)
    }

    /// Milliseconds of a method to [`PEER_ERROR`], those to initialise included.
    pub fn total_ms(&self, curve: &Curve) -> Option<f64> {
        Some(curve.init_ms + 1e3 * self.reached(curve, PEER_ERROR)?.1)
    }

    /// How many times sooner than compas-shapeop that is.
    pub fn times_sooner(&self, curve: &Curve) -> Option<f64> {
        Some(self.peer.as_ref()?.total_ms / self.total_ms(curve)?)
    }
}

/// A method in words.
pub fn name(method: &str) -> String {
    method.replace("anderson", "Anderson").replace("newton", "Newton").replace(':', " ")
}

impl Curve {
    fn is_long(&self) -> bool {
        self.seconds.last().is_some_and(|seconds| *seconds > LONG_RUN)
    }

    fn until(&self, energy: f64) -> Option<(u32, f64)> {
        let i = self.energies.iter().position(|found| *found <= energy)?;
        Some((self.evaluations[i], self.seconds[i]))
    }
}

/// Measures the problems of `plan` with `methods`.
pub fn measure(runner: &Runner, plan: &Plan, methods: &[String]) -> Result<Energies> {
    let problems = PROBLEMS.into_iter().filter(|problem| plan.has(problem));
    let problems = problems.map(|problem| measure_one(runner, plan, problem, methods)).collect::<Result<_>>()?;
    Ok(Energies { machine: machine::describe(), date: machine::date(), problems })
}

fn measure_one(runner: &Runner, plan: &Plan, problem: &str, methods: &[String]) -> Result<Problem> {
    let (size, iterations, repetitions) =
        if plan.is_quick { (plan.sizes[0], QUICK_ITERATIONS, 1) } else { (SIZE, ITERATIONS, REPETITIONS) };
    let size = size.to_string();
    let mut found = Problem { name: problem.into(), vertices: 0, curves: Vec::new(), peer: None };
    let (mut runs, mut peers) = (vec![Vec::new(); methods.len()], Vec::new());
    for _ in 0..repetitions {
        for (method, runs) in methods.iter().zip(&mut runs) {
            if runs.iter().any(Curve::is_long) {
                continue;
            }
            let iterations = iterations[usize::from(method != METHODS[0])].to_string();
            let value = runner.ours(&["energies", problem, &size, method, &iterations, "2"])?;
            found.vertices = value["vertices"].as_u64().unwrap_or(0);
            let curve: Curve = serde_json::from_value(value)?;
            runs.push(Curve { method: method.clone(), ..curve });
        }
        found.curves = runs.iter().map(|runs| together(runs)).collect::<Result<_>>()?;
        if problem == PROBLEM_OF_PEER {
            peers.extend(peer(runner, &found, &size)?);
        }
    }
    found.peer = peers.first().map(|&(iterations, _)| Peer {
        iterations,
        total_ms: median(peers.iter().map(|(_, total_ms)| *total_ms).collect()),
    });
    let reached = found.curves.iter().map(|curve| {
        let evaluations = found.reached(curve, PEER_ERROR).map_or("–".into(), |(count, _)| count.to_string());
        format!("{} {evaluations}", name(&curve.method))
    });
    println!(
        "{problem:14} {:>8}: evaluations to {PEER_ERROR:e}: {}",
        found.vertices,
        reached.collect::<Vec<_>>().join(", ")
    );
    Ok(found)
}

/// Repetitions of one run as one curve.
fn together(runs: &[Curve]) -> Result<Curve> {
    let first = runs.first().context("nothing was measured")?;
    ensure!(runs.iter().all(|run| run.energies == first.energies), "repetitions of one run differ");
    let seconds = |i: usize| median(runs.iter().map(|run| run.seconds[i]).collect());
    Ok(Curve {
        init_ms: median(runs.iter().map(|run| run.init_ms).collect()),
        seconds: (0..first.seconds.len()).map(seconds).collect(),
        ..first.clone()
    })
}

/// Iterations and milliseconds of the peer, if it is there, to as many iterations as plain ones need: its iterates are the
/// same.
fn peer(runner: &Runner, found: &Problem, size: &str) -> Result<Option<(u32, f64)>> {
    let reached = found.curve(METHODS[0]).and_then(|plain| found.reached(plain, PEER_ERROR));
    let (Some((iterations, _)), Ok(python)) = (reached, &runner.peer) else { return Ok(None) };
    let model = runner.write_model(&found.name, size)?;
    let value = runner.peers(python, &model, iterations, None)?;
    let number = |name: &str| value[name].as_f64().with_context(|| format!("no {name} in {value}"));
    // It makes a few iterations more.
    let solve_ms = number("solve_ms")? * f64::from(iterations) / number("iterations")?;
    Ok(Some((iterations, number("init_ms")? + solve_ms)))
}
