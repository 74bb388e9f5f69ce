//! The benchmark problems: each call measures one thing in a process of its own and prints a line of JSON.

use std::error::Error;
use std::time::Instant;

use serde_json::{Value, json};

mod energies;
mod floor;
mod handle;
mod linear;
mod model_file;
mod models;

const USAGE: &str = "usage:
  problems NAME VERTICES [ITERATIONS [THREADS [POINTS_FILE]]]   initialisation and one iteration
  problems linear NAME VERTICES automatic|direct|conjugate-gradients [ITERATIONS [THREADS]]
  problems energies NAME VERTICES plain|anderson|quasi-newton[:MEMORY] [ITERATIONS [THREADS]]   energy over iterations
  problems write NAME VERTICES FILE                             the model as a file
  problems bytes NAME VERTICES                                  what an iteration streams at least
  problems bandwidth BYTES THREADS                              reading an array of that size
  problems handle [VERTICES [SOLVES [THREADS]]]                 dragging one vertex";

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let line = match words.as_slice() {
        ["write", name, vertex_count, file] => {
            let model = model(name, vertex_count)?;
            model_file::write(&model, file)?;
            json!({"vertices": model.points.len()})
        }
        ["bytes", name, vertex_count] => {
            let model = model(name, vertex_count)?;
            let mut solver = model.solver()?;
            model.init(&mut solver)?;
            floor::bytes(&solver).ok_or("there is no factor")?
        }
        ["bandwidth", bytes, threads] => {
            let threads = threads.parse()?;
            json!({"threads": threads, "bytes_per_second": floor::bandwidth(bytes.parse()?, threads)})
        }
        ["linear", name, vertex_count, choice, rest @ ..] => {
            let number = |i: usize, default: u32| rest.get(i).map_or(Ok(default), |text| text.parse());
            linear::time(&model(name, vertex_count)?, choice, number(0, 10)?, number(1, 0)? as usize)?
        }
        ["energies", name, vertex_count, method, rest @ ..] => {
            let number = |i: usize, default: u32| rest.get(i).map_or(Ok(default), |text| text.parse());
            energies::curve(&model(name, vertex_count)?, method, number(0, 2000)?, number(1, 0)? as usize)?
        }
        ["handle", rest @ ..] => {
            let number = |i: usize, default: u32| rest.get(i).map_or(Ok(default), |text| text.parse());
            handle::time(number(0, 20_000)?, number(1, 100)?, number(2, 0)? as usize)?
        }
        [name, vertex_count, rest @ ..] => time(name, vertex_count, rest)?,
        _ => {
            println!("{USAGE}\nNAME one of {}", models::NAMES.join(", "));
            return Ok(());
        }
    };
    println!("{line}");
    Ok(())
}

fn model(name: &str, vertex_count: &str) -> Result<models::Model, Box<dyn Error>> {
    Ok(models::model(name, vertex_count.parse()?).ok_or("no problem of that name")?)
}

fn time(name: &str, vertex_count: &str, rest: &[&str]) -> Result<Value, Box<dyn Error>> {
    let iterations: u32 = rest.first().map_or(Ok(20), |text| text.parse())?;
    let threads: usize = rest.get(1).map_or(Ok(0), |text| text.parse())?;
    let model = model(name, vertex_count)?;
    let mut solver = model.solver()?;
    solver.set_thread_count(threads);
    let started = Instant::now();
    model.init(&mut solver)?;
    let init_seconds = started.elapsed().as_secs_f64();
    // Threads start and caches warm in the first iterations.
    solver.solve(3)?;
    let iterations = iterations.div_ceil(5);
    let mut steps = Vec::new();
    for _ in 0..5 {
        let started = Instant::now();
        solver.solve(iterations)?;
        steps.push(started.elapsed().as_secs_f64() / f64::from(iterations));
    }
    steps.sort_by(f64::total_cmp);
    if let Some(file) = rest.get(2) {
        model_file::write_points(solver.points(), file)?;
    }
    Ok(json!({
        "problem": name,
        "vertices": solver.points().len(),
        "threads": threads,
        "init_ms": 1e3 * init_seconds,
        "iteration_ms": 1e3 * steps[steps.len() / 2],
        "peak_mib": peak_memory_mib(),
    }))
}

/// The peak resident memory of this process, where the system tells.
fn peak_memory_mib() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}
