//! Milliseconds per iteration of the card against the processor with all cores, and seconds to a tolerance.

use std::ops::ControlFlow;
use std::time::Instant;

use shapeop::problem::Acceleration;
use shapeop::solver::{Backend, BackendOptions, Outcome as Ending, SolveOptions, backend_info};

use crate::group::Group;
use crate::models::Model;
use crate::{Outcome, copy, is_card, model, traffic};

/// Iterations before the clock starts: kernels are compiled, caches and threads warm.
const WARM: u32 = 3;

/// Vertices times iterations that are timed, so that large models take no longer than small ones do; and the bounds of
/// their number.
const WORK: u32 = 5_000_000;
const ITERATIONS: [u32; 2] = [10, 200];

/// The tolerance of the time to one, the iterations at most, and the seconds after which a solve is given up.
const TOLERANCE: f64 = 1e-6;
const MOST_ITERATIONS: u32 = 5_000;
const PATIENCE: f64 = 60.0;

/// How many times as fast as the processor a card is to iterate, on which problems, from how many vertices on.
const FASTER: f64 = 5.0;
const FASTER_NAMES: [&str; 2] = ["squares", "tets"];
const FASTER_FROM: usize = 900_000;

/// What one backend needs.
struct Times {
    init_seconds: f64,
    iteration_ms: f64,
    /// Of a call: points to the card and back.
    transfer_ms: f64,
    /// In which the card worked, per iteration.
    card_ms: f64,
    linear_iterations: f64,
    to_tolerance: Option<(f64, u32)>,
}

/// Prints the groups, one for each problem and size, and one for each problem with the size from which the card is faster.
pub fn print(names: &[&str], sizes: &[u32]) -> Outcome<()> {
    let bandwidth = match backend_info(&BackendOptions::default()) {
        Ok(info) if is_card(&info) => copy::bandwidth(&info.adapter)?,
        other => {
            let what = if other.is_ok() { "software adapter only" } else { "no adapter" };
            println!("{}", Group::new("speed", &format!("no card: {what}; not measured")));
            return Ok(());
        }
    };
    let mut group = Group::new("speed: what bounds it", "A kernel that copies 256 MiB, reading and writing counted.");
    group.plain("GB/s of the card's memory", bandwidth / 1e9);
    println!("{group}");
    for name in names {
        let mut ratios = Vec::new();
        for size in sizes {
            let (group, point) = compared(name, *size, bandwidth)?;
            println!("{group}");
            ratios.push(point);
        }
        println!("{}", crossover(name, &ratios));
    }
    Ok(())
}

/// The figures of a problem of a size; its vertices and how many times faster the card iterates.
fn compared(name: &str, size: u32, bandwidth: f64) -> Outcome<(Group, [f64; 2])> {
    let model = model(name, size)?;
    let vertices = model.points.len();
    let claim = "Plain iterations without transfers; the processor with all cores, on its default linear solver.";
    let mut group = Group::new(&format!("{name}, {vertices} vertices"), claim);
    let (cpu, gpu) = (measure(&model, Backend::Cpu)?, measure(&model, Backend::Gpu)?);
    let traffic = traffic::of(&model)?;
    let bytes = traffic.local + gpu.linear_iterations * traffic.linear_iteration;
    let ratio = cpu.iteration_ms / gpu.iteration_ms;
    group.plain("processor: ms per iteration", cpu.iteration_ms);
    group.plain("card: ms per iteration", gpu.iteration_ms);
    if FASTER_NAMES.contains(&name) && vertices >= FASTER_FROM {
        group.at_least("card: times faster per iteration", ratio, FASTER);
    } else {
        group.plain("card: times faster per iteration", ratio);
    }
    group.plain("card: ms per iteration in which it worked", gpu.card_ms);
    group.plain("card: ms of transfers, once per call", gpu.transfer_ms);
    group.plain("card: linear iterations per iteration", gpu.linear_iterations);
    group.plain("card: MB per iteration, at least", bytes / 1e6);
    group.plain("card: share of its memory's bandwidth", bytes / (1e-3 * gpu.iteration_ms) / bandwidth);
    for (who, times) in [("processor", &cpu), ("card", &gpu)] {
        group.plain(&format!("{who}: seconds to initialise"), times.init_seconds);
        // A solve that was given up has no time: the table shows a gap.
        if let Some((seconds, iterations)) = times.to_tolerance {
            group.plain(&format!("{who}: seconds from there to {TOLERANCE:e}"), seconds);
            group.plain(&format!("{who}: iterations to {TOLERANCE:e}"), f64::from(iterations));
        }
    }
    Ok((group, [vertices as f64, ratio]))
}

fn measure(model: &Model, backend: Backend) -> Outcome<Times> {
    let mut solver = model.solver()?;
    solver.set_backend(backend)?;
    solver.set_acceleration(Acceleration::None, 0)?;
    let started = Instant::now();
    model.init(&mut solver)?;
    let init_seconds = started.elapsed().as_secs_f64();
    solver.solve(WARM)?;
    let count = (WORK / model.points.len() as u32).clamp(ITERATIONS[0], ITERATIONS[1]);
    let options = SolveOptions { max_iterations: count, tolerance: 0.0, time_budget_seconds: 0.0 };
    let report = solver.solve_until(&options, &mut |_| ControlFlow::Continue(()))?;
    if backend == Backend::Gpu && report.gpu_iterations != count {
        return Err(format!(
            "the card made {} of {count} iterations: {}",
            report.gpu_iterations, report.backend_reason
        )
        .into());
    }
    let started = Instant::now();
    solver.solve(count)?;
    let seconds = started.elapsed().as_secs_f64() - report.transfer_seconds;
    let per_iteration = |seconds: f64| 1e3 * seconds / f64::from(count);
    Ok(Times {
        init_seconds,
        iteration_ms: per_iteration(seconds),
        transfer_ms: 1e3 * report.transfer_seconds,
        card_ms: per_iteration(report.gpu_seconds),
        linear_iterations: f64::from(report.linear_iterations) / f64::from(count),
        to_tolerance: to_tolerance(model, backend)?,
    })
}

/// Seconds and iterations from the start to the tolerance, as callers solve by default; none if it was given up.
fn to_tolerance(model: &Model, backend: Backend) -> Outcome<Option<(f64, u32)>> {
    let mut solver = model.solver()?;
    solver.set_backend(backend)?;
    model.init(&mut solver)?;
    let options = SolveOptions { max_iterations: MOST_ITERATIONS, tolerance: TOLERANCE, time_budget_seconds: PATIENCE };
    let started = Instant::now();
    let report = solver.solve_until(&options, &mut |_| ControlFlow::Continue(()))?;
    let seconds = started.elapsed().as_secs_f64();
    Ok((report.outcome == Ending::Converged).then_some((seconds, report.iterations)))
}

/// The size from which the card is faster: between two sizes as a straight line of logarithms has it.
fn crossover(name: &str, points: &[[f64; 2]]) -> Group {
    let mut group = Group::new(&format!("{name}: from which size on the card is faster"), "");
    match points {
        [[first, ratio], ..] if *ratio >= 1.0 => {
            group.claim = format!("At every size measured, {first} vertices the smallest.");
        }
        _ => {
            let crossed = points.windows(2).find(|pair| pair[0][1] < 1.0 && pair[1][1] >= 1.0);
            match crossed {
                Some(&[[a, slower], [b, faster]]) => {
                    let part = -slower.ln() / (faster.ln() - slower.ln());
                    group.plain("vertices", (a.ln() + part * (b.ln() - a.ln())).exp().round());
                }
                _ => group.claim = "At no size measured.".to_owned(),
            }
        }
    }
    group
}
