//! Times one of the benchmark problems in a process of its own, and prints a line of JSON.
//!
//! `problems NAME VERTICES [ITERATIONS [THREADS]]`

use std::error::Error;
use std::time::Instant;

mod models;

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let [name, vertex_count, rest @ ..] = arguments.as_slice() else {
        println!("usage: problems NAME VERTICES [ITERATIONS [THREADS]], NAME one of {}", models::NAMES.join(", "));
        return Ok(());
    };
    let iterations: u32 = rest.first().map_or(Ok(20), |text| text.parse())?;
    let model = models::model(name, vertex_count.parse()?).ok_or("no problem of that name")?;
    let mut solver = model.solver()?;
    if let Some(threads) = rest.get(1) {
        solver.set_thread_count(threads.parse()?);
    }
    let started = Instant::now();
    model.init(&mut solver)?;
    let init_seconds = started.elapsed().as_secs_f64();
    // Threads start and caches warm in the first iterations.
    solver.solve(3)?;
    let started = Instant::now();
    let mut steps = Vec::new();
    for _ in 0..5 {
        let started = Instant::now();
        solver.solve(iterations.div_ceil(5))?;
        steps.push(started.elapsed().as_secs_f64() / f64::from(iterations.div_ceil(5)));
    }
    let _ = started;
    steps.sort_by(f64::total_cmp);
    println!(
        "{{\"problem\": \"{name}\", \"vertices\": {}, \"init_ms\": {:.3}, \"iteration_ms\": {:.4}}}",
        solver.points().len(),
        1e3 * init_seconds,
        1e3 * steps[steps.len() / 2]
    );
    Ok(())
}
