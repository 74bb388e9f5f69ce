//! Fig. 12 of Deng et al. 2015: the distance from the solution over time, as `benches/peers/ipopt.py` tells it of IPOPT.
//!
//! Seconds go from the mesh, its boundary and the rows of its fairness in memory, as those of the peer do: constraints,
//! handles, the symbolic and numeric factorisation and all sweeps are in them; what this program does to keep the points
//! is not. Both programs solve the experiment on [`WARM_UP`] × [`WARM_UP`] points first, as what is done once a process
//! (code is loaded, instruction sets are looked for) is no part of a solve. One thread.

use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use glam::DVec3;
use serde_json::{Value, json};
use shapeop::mesh::patterns::translation_surface;
use shapeop::problem::Objective;
use shapeop::solver::{Report, SolveOptions};

use crate::session::{Session, largest_diagonal_distance};

/// The diagonal distance allowed, over the mean edge.
const BOUND: f64 = 0.01;

/// Points along a side of the surface that is solved first.
const WARM_UP: usize = 5;

/// Iteration, seconds and points.
type Seen = (u32, f64, Vec<DVec3>);

/// The course of the solve of `n` × `n` points; `reference` holds the solution that distances are measured to.
pub fn course(n: usize, reference: &Path) -> Result<Value> {
    let solution = points_of(reference)?;
    solve(WARM_UP)?;
    let (session, report, seen) = solve(n)?;
    let distance =
        |points: &[DVec3]| points.iter().zip(&solution).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt();
    let at_start = distance(&session.start.points);
    let iteration = |(iteration, seconds, points): &Seen| json!({"iteration": iteration, "seconds": seconds, "delta": distance(points) / at_start});
    let excess = largest_diagonal_distance(&session.mesh()) - BOUND * session.edge;
    Ok(json!({
        "n": n,
        "outcome": report.outcome.text(),
        "sweeps": report.iterations,
        "newton_steps": newton_steps(&session)?,
        "objective": session.terms().sum(),
        "violation": excess.max(0.0) / session.edge,
        "delta": distance(session.solver.points()) / at_start,
        "iterations": seen.iter().map(iteration).collect::<Vec<_>>(),
    }))
}

fn solve(n: usize) -> Result<(Session, Report, Vec<Seen>)> {
    let mut session = Session::new(&translation_surface(n)?, &Objective::default())?;
    let faces = session.start.faces.clone();
    let started = Instant::now();
    session.solver.set_thread_count(1);
    session.add("DiagonalDistance", &faces, &[BOUND * session.edge], 1.0, true)?;
    session.hold_boundary()?;
    session.pull((n * n / 2) as u32, DVec3::Z)?;
    session.solver.init()?;
    let mut own = Duration::ZERO;
    let mut seen: Vec<Seen> = Vec::new();
    let report = session.solver.solve_until(&SolveOptions::default(), &mut |now| {
        let entered = Instant::now();
        let seconds = (entered - started - own).as_secs_f64();
        seen.push((now.evaluations, seconds, now.solver.points().to_vec()));
        own += entered.elapsed();
        ControlFlow::Continue(())
    })?;
    let seconds = (started.elapsed() - own).as_secs_f64();
    seen.push((report.iterations + newton_steps(&session)?, seconds, session.solver.points().to_vec()));
    Ok((session, report, seen))
}

fn newton_steps(session: &Session) -> Result<u32> {
    Ok(session.solver.found().context("there is nothing to explore")?.newton_steps)
}

/// The points of a file that `ipopt.py --polished` wrote.
fn points_of(reference: &Path) -> Result<Vec<DVec3>> {
    let text = std::fs::read_to_string(reference).with_context(|| format!("{} cannot be read", reference.display()))?;
    let kept: Value = serde_json::from_str(&text)?;
    let points: Vec<[f64; 3]> = serde_json::from_value(kept["points"].clone())?;
    Ok(points.into_iter().map(DVec3::from_array).collect())
}
