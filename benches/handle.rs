//! A designer drags one vertex: how many solves a second follow the mouse.

use std::error::Error;
use std::time::Instant;

use serde_json::{Value, json};

use crate::models;

/// Iterations per move of the handle.
const ITERATIONS: u32 = 5;

/// The weight of the handle's closeness, against 1 of the planes.
const WEIGHT: f64 = 10.0;

/// Planar quads of about `vertex_count` vertices, one closeness more at the middle vertex. Each of `solve_count` times: moves
/// its target a little further on a circle, solves, and copies the points out as a host does.
pub fn time(vertex_count: u32, solve_count: u32, thread_count: usize) -> Result<Value, Box<dyn Error>> {
    let model = models::model("planar_quads", vertex_count).ok_or("no planar quads")?;
    let mut solver = model.solver()?;
    solver.set_thread_count(thread_count);
    let side = (model.points.len() as f64).sqrt() as usize;
    let middle = side / 2 * side + side / 2;
    let handle = solver.add_constraint("Closeness", &[middle as u32], WEIGHT)?;
    model.init(&mut solver)?;
    solver.solve(3)?;
    // Planes have one target per corner, closeness one.
    let auxiliary_count: usize = model.groups.iter().map(|group| group.indices.len()).sum::<usize>() + 1;
    let rest = model.points[middle];
    let mut host_points = vec![0.0; 3 * model.points.len()];
    let mut seconds = Vec::new();
    for i in 0..solve_count {
        let (sin, cos) = (0.1 * f64::from(i)).sin_cos();
        let target = rest + glam::DVec3::new(0.02 * cos, 0.02 * sin, 0.05 * sin);
        let started = Instant::now();
        solver.edit_constraint("Closeness", handle, &target.to_array())?;
        solver.solve(ITERATIONS)?;
        for (to, point) in host_points.chunks_exact_mut(3).zip(solver.points()) {
            to.copy_from_slice(&point.to_array());
        }
        seconds.push(started.elapsed().as_secs_f64());
        std::hint::black_box(&host_points);
    }
    seconds.sort_by(f64::total_cmp);
    Ok(json!({
        "vertices": model.points.len(),
        "auxiliary": auxiliary_count,
        "threads": thread_count,
        "solves_per_second": 1.0 / seconds[seconds.len() / 2],
    }))
}
