//! The measurements: each in a process of its own, the libraries by turns, medians over the repetitions.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::machine;
use crate::shell;

/// The problems, and whether compas-shapeop has all of their types.
const PROBLEMS: [(&str, bool); 7] = [
    ("planar_quads", true),
    ("cloth", true),
    ("squares", true),
    ("quad_circles", true),
    ("shell", false),
    ("tets", false),
    ("circles", false),
];

/// The only problem of a million vertices.
const LARGEST_PROBLEM: &str = "planar_quads";

/// Vertices above which only that problem is measured.
const LARGEST_OF_ALL: u32 = 100_000;

/// Vertices above which the peer is left out: it needs minutes, and says nothing new.
const LARGEST_OF_PEER: u32 = 100_000;

/// Vertices from which repetitions are halved.
const FEWER_REPETITIONS: u32 = 100_000;

/// Free memory that the largest cases are tried with.
const LEAST_GIB: f64 = 8.0;

/// What to measure.
#[derive(Debug)]
pub struct Plan {
    /// Numbers of vertices.
    pub sizes: Vec<u32>,
    /// Names; empty: all.
    pub problems: Vec<String>,
    /// Interleaved repetitions.
    pub repetitions: usize,
    /// Few iterations, and anything that cannot run is an error.
    pub is_quick: bool,
    /// The Cargo profile.
    pub profile: String,
}

impl Plan {
    /// True if `problem` is to be measured.
    pub fn has(&self, problem: &str) -> bool {
        self.problems.is_empty() || self.problems.iter().any(|name| name == problem)
    }
}

/// Everything that was measured.
#[derive(Debug, Serialize, Deserialize)]
pub struct Measurements {
    /// One line.
    pub machine: String,
    /// The day in UTC.
    pub date: String,
    /// The Cargo profile.
    pub profile: String,
    /// Repetitions of the smaller cases.
    pub repetitions: usize,
    /// Why there is no peer.
    pub peer_missing: Option<String>,
    /// Problems and sizes.
    pub cases: Vec<Case>,
    /// Moving one handle.
    pub handle: Option<Handle>,
}

/// One problem of one size.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Case {
    /// Its name.
    pub problem: String,
    /// The size asked for; the model has about as many vertices.
    pub size: u32,
    /// Its vertices.
    pub vertices: u64,
    /// Iterations of a run, after three that do not count.
    pub iterations: u32,
    /// Repetitions of every run.
    pub repetitions: usize,
    /// This library on one thread.
    pub one_thread: Option<Timing>,
    /// This library on two threads.
    pub two_threads: Option<Timing>,
    /// compas-shapeop.
    pub peer: Option<Timing>,
    /// The largest distance between the points of both libraries after the same iterations, relative to the model's size.
    pub difference: Option<f64>,
    /// What an iteration streams.
    pub bytes: Option<Bytes>,
    /// Bytes per second that one and two threads read from an array as large as the factor.
    pub bandwidth: Option<[f64; 2]>,
    /// Why something is missing.
    pub notes: Vec<String>,
}

/// Medians over the repetitions.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Timing {
    /// Initialisation.
    pub init_ms: f64,
    /// One iteration.
    pub iteration_ms: f64,
    /// The fastest and the slowest repetition.
    pub iteration_range_ms: [f64; 2],
    /// The peak resident memory of the process.
    pub peak_mib: Option<f64>,
}

/// Bytes of an iteration, each array once.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Bytes {
    /// The factor; it is read twice.
    pub factor: f64,
    /// Right-hand sides.
    pub right_hand_sides: f64,
    /// Points.
    pub points: f64,
    /// Projections.
    pub projections: f64,
    /// Indices, coefficients, rest states, scalars and weights.
    pub constraint_data: f64,
}

/// Moving one handle.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Handle {
    /// Vertices.
    pub vertices: u64,
    /// Auxiliary variables: one per projected point.
    pub auxiliary: u64,
    /// The median over solves and repetitions.
    pub solves_per_second: f64,
}

impl Bytes {
    /// The bytes of an iteration: the factor twice, the rest once.
    pub fn total(&self) -> f64 {
        2.0 * self.factor + self.right_hand_sides + self.points + self.projections + self.constraint_data
    }
}

impl Case {
    /// The floor of an iteration in ms on one thread (0) or two (1).
    pub fn floor_ms(&self, threads: usize) -> Option<f64> {
        Some(1e3 * self.bytes.as_ref()?.total() / self.bandwidth?[threads])
    }

    /// This library on one thread (0) or two (1).
    pub fn ours(&self, threads: usize) -> Option<&Timing> {
        [&self.one_thread, &self.two_threads][threads].as_ref()
    }

    /// The time per iteration as a multiple of the floor.
    pub fn floor_multiple(&self, threads: usize) -> Option<f64> {
        Some(self.ours(threads)?.iteration_ms / self.floor_ms(threads)?)
    }

    /// The peer's time per iteration over this library's.
    pub fn ratio(&self, threads: usize) -> Option<f64> {
        Some(self.peer.as_ref()?.iteration_ms / self.ours(threads)?.iteration_ms)
    }

    /// The peer's initialisation over this library's.
    pub fn init_ratio(&self, threads: usize) -> Option<f64> {
        Some(self.peer.as_ref()?.init_ms / self.ours(threads)?.init_ms)
    }

    /// One thread's time per iteration over that of two.
    pub fn speedup(&self) -> Option<f64> {
        Some(self.one_thread.as_ref()?.iteration_ms / self.two_threads.as_ref()?.iteration_ms)
    }
}

impl Measurements {
    /// The case of a problem and a size.
    pub fn case(&self, problem: &str, size: u32) -> Option<&Case> {
        self.cases.iter().find(|case| case.problem == problem && case.size == size)
    }

    /// The exponent with which the time per iteration of planar quads grows, by least squares over all sizes, and these.
    pub fn exponent(&self, threads: usize) -> Option<(f64, u32, u32)> {
        let cases = || self.cases.iter().filter(|case| case.problem == LARGEST_PROBLEM);
        let points: Vec<[f64; 2]> = cases()
            .filter_map(|case| Some([(case.vertices as f64).ln(), case.ours(threads)?.iteration_ms.ln()]))
            .collect();
        if points.len() < 2 {
            return None;
        }
        let mean = |i: usize| points.iter().map(|point| point[i]).sum::<f64>() / points.len() as f64;
        let (x, y) = (mean(0), mean(1));
        let covariance: f64 = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum();
        let variance: f64 = points.iter().map(|point| (point[0] - x).powi(2)).sum();
        let sizes = || cases().filter(|case| case.ours(threads).is_some()).map(|case| case.size);
        Some((covariance / variance, sizes().min()?, sizes().max()?))
    }
}

/// Measures all but the energies.
pub fn all(runner: &Runner, plan: &Plan) -> Result<Measurements> {
    let mut cases = Vec::new();
    for (problem, peer_has_it) in PROBLEMS.into_iter().filter(|(problem, _)| plan.has(problem)) {
        for &size in &plan.sizes {
            if size > LARGEST_OF_ALL && problem != LARGEST_PROBLEM {
                continue;
            }
            let case = runner.case(problem, size, peer_has_it, plan)?;
            println!("{}", line(&case));
            cases.push(case);
        }
    }
    let handle = runner.handle(plan)?;
    println!("one handle moved: {:.0} solves of 5 iterations per second", handle.solves_per_second);
    Ok(Measurements {
        machine: machine::describe(),
        date: machine::date(),
        profile: plan.profile.clone(),
        repetitions: plan.repetitions,
        peer_missing: runner.peer.as_ref().err().map(|reason| format!("{reason:#}")),
        cases,
        handle: Some(handle),
    })
}

fn line(case: &Case) -> String {
    let ms =
        |timing: &Option<Timing>| timing.as_ref().map_or("–".into(), |timing| format!("{:.3}", timing.iteration_ms));
    let notes = if case.notes.is_empty() { String::new() } else { format!("  ({})", case.notes.join("; ")) };
    format!(
        "{:14} {:>8}: {:>9} ms on one thread, {:>9} on two, {:>9} compas-shapeop{notes}",
        case.problem,
        case.vertices,
        ms(&case.one_thread),
        ms(&case.two_threads),
        ms(&case.peer),
    )
}

/// Builds a benchmark with these features; returns the program.
pub fn build(bench: &str, profile: &str, features: &str) -> Result<PathBuf> {
    // With the workspace's selection of packages, so that what was built for other commands is used.
    let mut cargo = shell::cargo();
    cargo.args([
        "build",
        "--quiet",
        "--workspace",
        "--bench",
        bench,
        "--message-format",
        "json",
        "--features",
        features,
    ]);
    let messages = shell::output(cargo.args(["--profile", profile]))?;
    let mut programs = messages.lines().filter_map(|line| {
        let message: Value = serde_json::from_str(line).ok()?;
        let is_it = message["reason"] == "compiler-artifact" && message["target"]["name"] == bench;
        Some(PathBuf::from(message["executable"].as_str().filter(|_| is_it)?))
    });
    programs.next_back().context("Cargo did not say where the benchmark is")
}

/// Runs the programs that measure.
pub struct Runner {
    program: PathBuf,
    /// The Python of the peer, or why there is none.
    pub peer: Result<PathBuf>,
    folder: PathBuf,
}

/// What one process printed of itself.
type Runs = Vec<[f64; 3]>;

impl Runner {
    /// Builds this library's program.
    pub fn new(profile: &str, peer: Result<PathBuf>, folder: PathBuf) -> Result<Self> {
        Ok(Self { program: build("problems", profile, "")?, peer, folder })
    }

    fn case(&self, problem: &str, size: u32, peer_has_it: bool, plan: &Plan) -> Result<Case> {
        let iterations = match size {
            _ if plan.is_quick => 5,
            ..5_000 => 1000,
            5_000..20_000 => 50,
            20_000..80_000 => 20,
            _ => 10,
        };
        let repetitions = if size >= FEWER_REPETITIONS { plan.repetitions.div_ceil(2) } else { plan.repetitions };
        let mut case = Case { problem: problem.into(), size, iterations, repetitions, ..Case::default() };
        if size >= FEWER_REPETITIONS && machine::available_gib().is_some_and(|gib| gib < LEAST_GIB) {
            case.notes.push(format!("left out: less than {LEAST_GIB} GiB of memory are free"));
            return Ok(case);
        }
        let size_word = size.to_string();
        let found = self.ours(&["bytes", problem, &size_word]).and_then(|value| Ok(serde_json::from_value(value)?));
        case.bytes = self.note(&mut case, plan, "the bytes of the floor", found)?;
        let peer = self.peer.as_ref().ok().filter(|_| peer_has_it && size <= LARGEST_OF_PEER);
        let peer = match peer {
            Some(python) => Some((python, self.write_model(problem, &size_word)?)),
            None => None,
        };
        let (points, peer_points) = (self.folder.join("points.bin"), self.folder.join("peer_points.bin"));
        let (mut runs, mut peer_runs, mut bandwidths) = ([Runs::new(), Runs::new()], Runs::new(), Vec::new());
        'repetitions: for _ in 0..repetitions {
            for (threads, runs) in ["1", "2"].iter().zip(&mut runs) {
                let words = [problem, &size_word, &iterations.to_string(), threads, &points.to_string_lossy()];
                let Some(value) = self.note(&mut case, plan, &format!("{threads} threads"), self.ours(&words))? else {
                    // Once is enough to know it.
                    break 'repetitions;
                };
                case.vertices = value["vertices"].as_u64().unwrap_or(0);
                runs.push(times(&value)?);
            }
            if let Some((python, model)) = &peer {
                let found = self.peers(python, model, iterations, Some(&peer_points));
                if let Some(value) = self.note(&mut case, plan, "compas-shapeop", found)? {
                    peer_runs.push(times(&value)?);
                    case.difference = Some(difference(&points, &peer_points)?);
                }
            }
            if let Some(bytes) = &case.bytes {
                let factor = format!("{:.0}", bytes.factor);
                let mut both = [0.0; 2];
                for (threads, bandwidth) in ["1", "2"].iter().zip(&mut both) {
                    let value = self.ours(&["bandwidth", &factor, threads])?;
                    *bandwidth = value["bytes_per_second"].as_f64().context("no bandwidth")?;
                }
                bandwidths.push(both);
            }
        }
        [case.one_thread, case.two_threads] = runs.map(|runs| timing(&runs));
        case.peer = timing(&peer_runs);
        if !bandwidths.is_empty() {
            case.bandwidth = Some([0, 1].map(|i| median(bandwidths.iter().map(|both| both[i]).collect())));
        }
        Ok(case)
    }

    fn handle(&self, plan: &Plan) -> Result<Handle> {
        let (vertices, solves) = if plan.is_quick { ("400", "5") } else { ("20000", "100") };
        let mut handles = Vec::new();
        for _ in 0..plan.repetitions {
            let handle: Handle = serde_json::from_value(self.ours(&["handle", vertices, solves, "2"])?)?;
            handles.push(handle);
        }
        let solves_per_second = median(handles.iter().map(|handle| handle.solves_per_second).collect());
        let first = handles.into_iter().next().context("nothing was measured")?;
        Ok(Handle { solves_per_second, ..first })
    }

    /// What this library's program prints.
    pub fn ours(&self, words: &[&str]) -> Result<Value> {
        parse(&shell::output(Command::new(&self.program).args(words))?)
    }

    /// Writes a model for the peer.
    pub fn write_model(&self, problem: &str, size: &str) -> Result<PathBuf> {
        let model = self.folder.join("model.bin");
        self.ours(&["write", problem, size, &model.to_string_lossy()])?;
        Ok(model)
    }

    /// What the peer's program prints; it writes its points to a file, if one is named.
    pub fn peers(&self, python: &Path, model: &Path, iterations: u32, points: Option<&Path>) -> Result<Value> {
        let mut command = Command::new(python);
        command.arg(shell::root().join("benches/peer.py")).arg(model).arg(iterations.to_string()).args(points);
        parse(&shell::output(&mut command)?)
    }

    /// The value, or a note of why there is none; quick runs fail instead.
    fn note<T>(&self, case: &mut Case, plan: &Plan, what: &str, found: Result<T>) -> Result<Option<T>> {
        match found {
            Ok(value) => Ok(Some(value)),
            Err(error) if plan.is_quick => Err(error),
            Err(error) => {
                let reason = format!("{error:#}");
                let lines: Vec<&str> = reason.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
                // What the program said itself is last; its path before that is nobody's business.
                let reason = lines.last().and_then(|line| line.rsplit("` failed: ").next()).unwrap_or_default();
                case.notes.push(format!("{what}: {reason}"));
                Ok(None)
            }
        }
    }
}

fn parse(text: &str) -> Result<Value> {
    serde_json::from_str(text.trim()).with_context(|| format!("expected a line of JSON, found {text:?}"))
}

/// Initialisation, iteration, peak memory.
fn times(value: &Value) -> Result<[f64; 3]> {
    let number = |name: &str| value[name].as_f64().with_context(|| format!("no {name} in {value}"));
    Ok([number("init_ms")?, number("iteration_ms")?, value["peak_mib"].as_f64().unwrap_or(f64::NAN)])
}

fn timing(runs: &[[f64; 3]]) -> Option<Timing> {
    let column = |i: usize| runs.iter().map(move |run| run[i]);
    let peak = column(2).fold(f64::NAN, f64::max);
    (!runs.is_empty()).then(|| Timing {
        init_ms: median(column(0).collect()),
        iteration_ms: median(column(1).collect()),
        iteration_range_ms: [column(1).fold(f64::INFINITY, f64::min), column(1).fold(0.0, f64::max)],
        peak_mib: peak.is_finite().then_some(peak),
    })
}

/// The middle, or the mean of both that are nearest to it.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}

/// The largest distance between two files of points, relative to the diagonal of the first's bounding box.
fn difference(ours: &Path, peers: &Path) -> Result<f64> {
    let read = |file: &Path| -> Result<Vec<[f64; 3]>> {
        let bytes = fs::read(file)?;
        let number = |bytes: &[u8]| f64::from_le_bytes(std::array::from_fn(|i| bytes[i]));
        let point = |bytes: &[u8]| std::array::from_fn(|i| number(&bytes[8 * i..]));
        Ok(bytes.chunks_exact(24).map(point).collect())
    };
    let (ours, peers) = (read(ours)?, read(peers)?);
    anyhow::ensure!(ours.len() == peers.len(), "the libraries wrote {} and {} points", ours.len(), peers.len());
    let bound = |i: usize, worse: fn(f64, f64) -> f64| ours.iter().map(|point| point[i]).fold(f64::NAN, worse);
    let length = |vector: [f64; 3]| vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    let diagonal = length([0, 1, 2].map(|i| bound(i, f64::max) - bound(i, f64::min)));
    let distance = |(a, b): (&[f64; 3], &[f64; 3])| length([0, 1, 2].map(|i| a[i] - b[i]));
    Ok(ours.iter().zip(&peers).map(distance).fold(0.0, f64::max) / diagonal)
}
