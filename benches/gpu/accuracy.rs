//! Whether the card reaches what the processor reaches, on any adapter.

use std::ops::ControlFlow;

use shapeop::problem::Acceleration;
use shapeop::solver::{Backend, Outcome as Ending, Report, SolveOptions, Solver};

use crate::group::Group;
use crate::models::Model;
use crate::{Outcome, model};

/// Plain iterations after which energies are compared.
const ITERATIONS: u32 = 50;

/// How near the energies are to be, relative to the processor's: single precision keeps 6e-8 of each coordinate, and the
/// energy is a difference of them.
const ENERGY: f64 = 1e-5;

/// The tolerance asked for: under what single precision can see of a move, so that the processor must finish.
const TOLERANCE: f64 = 1e-8;

/// Iterations at most until the tolerance.
const MOST_ITERATIONS: u32 = 20_000;

/// The figures of the problem `name`.
pub fn group(name: &str, size: u32) -> Outcome<Group> {
    let model = model(name, size)?;
    let claim = format!(
        "{ITERATIONS} plain iterations on both; then accelerated from the start until no point moves farther than {TOLERANCE:e}."
    );
    let title = format!("{name}, {} vertices: the card against the processor", model.points.len());
    let mut group = Group::new(&title, &claim);
    let [cpu, gpu] = [Backend::Cpu, Backend::Gpu].map(|backend| plain(&model, backend));
    let ((cpu, _), (gpu, report)) = (cpu?, gpu?);
    group.between("iterations on the card", f64::from(report.gpu_iterations), [f64::from(ITERATIONS); 2]);
    group.plain("energy, processor", cpu);
    group.at_most("energy, card: relative difference", (gpu - cpu).abs() / cpu.abs(), ENERGY);

    let [cpu, gpu] = [Backend::Cpu, Backend::Gpu].map(|backend| to_tolerance(&model, backend));
    let ((cpu, of_cpu), (gpu, of_gpu)) = (cpu?, gpu?);
    group.plain("iterations to the tolerance, processor", f64::from(of_cpu.iterations));
    group.plain("iterations to the tolerance, card and finish", f64::from(of_gpu.iterations));
    group.at_least("of them on the card", f64::from(of_gpu.gpu_iterations), 1.0);
    group.between("converged", f64::from(u8::from(of_gpu.outcome == Ending::Converged)), [1.0; 2]);
    group.at_most("largest move in the last iteration", of_gpu.largest_move, TOLERANCE);
    group.plain("energy at the end: relative difference", (gpu - cpu) / cpu.abs());
    Ok(group)
}

fn plain(model: &Model, backend: Backend) -> Outcome<(f64, Report)> {
    let options = SolveOptions { max_iterations: ITERATIONS, tolerance: 0.0, time_budget_seconds: 0.0 };
    solve(model, backend, Acceleration::None, &options)
}

fn to_tolerance(model: &Model, backend: Backend) -> Outcome<(f64, Report)> {
    let options = SolveOptions { max_iterations: MOST_ITERATIONS, tolerance: TOLERANCE, time_budget_seconds: 0.0 };
    solve(model, backend, Acceleration::Automatic, &options)
}

/// The energy at the points reached, which the processor computes in double precision either way.
fn solve(
    model: &Model,
    backend: Backend,
    acceleration: Acceleration,
    options: &SolveOptions,
) -> Outcome<(f64, Report)> {
    let mut solver: Solver = model.solver()?;
    solver.set_backend(backend)?;
    solver.set_acceleration(acceleration, 0)?;
    model.init(&mut solver)?;
    let report = solver.solve_until(options, &mut |_| ControlFlow::Continue(()))?;
    Ok((solver.energy(), report))
}
