//! A large mesh, one handle dragged in frames of a given time: frames per second, sweeps, violations on the way and at rest.

use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::{Context, Result};
use glam::DVec3;
use shapeop::mesh::patterns::translation_surface;
use shapeop::problem::Objective;
use shapeop::solver::{SolveOptions, Solver};

use crate::group::Group;
use crate::session::{Session, largest_plane_distance};

/// Points along a side: 20 449 points, and 4 · 142² = 80 656 auxiliary variables, each a vector, of the hard constraints.
const SIDE: usize = 143;

/// Positions of the handle, and the time that each frame may solve.
const FRAMES: u32 = 200;
const BUDGET_SECONDS: f64 = 0.025;

/// The length of the path in mean edges: a helix that rises by `RISE` and winds about the handle's place once.
const RISE: f64 = 3.0;
const RADIUS: f64 = 0.5;

/// Seconds that the shape has after the drag.
const REST_SECONDS: f64 = 1.0;

/// The frame that a host has: move the handle, solve, copy the points out.
fn frame(solver: &mut Solver, handle: u32, target: DVec3, host_points: &mut [f64]) -> Result<u32> {
    solver.set_handle(handle, target)?;
    let options = SolveOptions { time_budget_seconds: BUDGET_SECONDS, ..SolveOptions::default() };
    let report = solver.solve_until(&options, &mut |_| ControlFlow::Continue(()))?;
    for (to, point) in host_points.chunks_exact_mut(3).zip(solver.points()) {
        to.copy_from_slice(&point.to_array());
    }
    Ok(report.iterations)
}

pub fn group() -> Result<Group> {
    let mesh = translation_surface(SIDE)?;
    let mut session = Session::new(&mesh, &Objective::default())?;
    session.solver.set_thread_count(2);
    let polygons = session.polygons();
    session.add("DiagonalDistance", &polygons, &[0.01 * session.edge], 1.0, true)?;
    let handle = (SIDE * SIDE / 2) as u32;
    session.pull(handle, DVec3::ZERO)?;
    session.solver.init()?;
    let place = mesh.points[handle as usize];
    let mut host_points = vec![0.0; 3 * mesh.points.len()];
    // The first call factorises.
    frame(&mut session.solver, handle, place, &mut host_points)?;

    let (mut seconds, mut sweeps, mut worst) = (Vec::new(), Vec::new(), 0.0_f64);
    for i in 1..=FRAMES {
        let share = f64::from(i) / f64::from(FRAMES);
        let (sin, cos) = (std::f64::consts::TAU * share).sin_cos();
        let target = place + session.edge * DVec3::new(RADIUS * (cos - 1.0), RADIUS * sin, RISE * share);
        let started = Instant::now();
        sweeps.push(frame(&mut session.solver, handle, target, &mut host_points)?);
        seconds.push(started.elapsed().as_secs_f64());
        worst = worst.max((crate::session::largest_diagonal_distance(&session.mesh()) - 0.01 * session.edge));
    }
    let total: f64 = seconds.iter().sum();
    seconds.sort_by(f64::total_cmp);
    sweeps.sort_unstable();
    // At rest the host goes on calling, as its time allows.
    let resting = Instant::now();
    let mut at_rest = worst;
    let mut calls = 0;
    while resting.elapsed().as_secs_f64() < REST_SECONDS {
        let left = REST_SECONDS - resting.elapsed().as_secs_f64();
        let options = SolveOptions { time_budget_seconds: left.max(1e-3), ..SolveOptions::default() };
        session.solver.solve_until(&options, &mut |_| ControlFlow::Continue(()))?;
        at_rest = (crate::session::largest_diagonal_distance(&session.mesh()) - 0.01 * session.edge);
        calls += 1;
        if session.solver.found().is_some_and(|found| found.is_solution) {
            break;
        }
    }
    let rested = resting.elapsed().as_secs_f64();
    let found = session.solver.found().context("there is nothing to explore")?;
    let title = "20 449 points, 80 656 auxiliary variables, one handle dragged, two threads";
    let claim = "Hard planarity of all quads; a frame is set handle, solve with a budget of 25 ms, get points.";
    let mut group = Group::new(title, claim);
    group.at_least("frames per second over the whole drag", f64::from(FRAMES) / total, 30.0);
    group.plain("ms of the slowest frame", 1e3 * seconds[seconds.len() - 1]);
    group.at_least("sweeps per frame, median", f64::from(sweeps[sweeps.len() / 2]), 4.0);
    group.plain("sweeps per frame, fewest", f64::from(sweeps[0]));
    group.at_most("worst distance from a plane during the drag / mean edge", worst / session.edge, 1e-2);
    group.at_most("the same one second after it rests", at_rest / session.edge, 1e-6);
    group.plain("seconds to rest", rested);
    group.plain("Newton steps of the last call", f64::from(found.newton_steps));
    group.plain("calls", calls as f64);
    group.plain("handle off its target at rest / mean edge", session.largest_pull());
    Ok(group)
}
