//! Iterations allocate nothing.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ops::ControlFlow;

use glam::DVec3;
use shapeop::constraints::types;
use shapeop::problem::{Acceleration, Faces, Force, Reference};
use shapeop::solver::{LinearSolver, SolveOptions, Solver};

struct Counting;

thread_local! {
    /// Of this thread alone: the test harness allocates on others when it likes.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

fn allocation_count() -> usize {
    ALLOCATIONS.get()
}

// SAFETY: every call is passed on to the system's allocator unchanged; counting touches no memory of the caller.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller keeps the contract of `alloc`, which is the same here.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`, which is the same here.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

#[test]
fn between_the_second_and_the_last_iteration_nothing_is_allocated() {
    let n = 12_u32;
    let bump = |i: u32| (f64::from(i * 7919 % 101) / 101.0 - 0.5) * 0.2;
    let points: Vec<DVec3> = (0..n * n)
        .map(|i| DVec3::new(f64::from(i % n) + bump(i), f64::from(i / n) + bump(i + 3), bump(i + 5)))
        .collect();
    let accelerations = [Acceleration::None, Acceleration::Anderson, Acceleration::QuasiNewton];
    let cases = [false, true].into_iter().flat_map(|d| accelerations.map(|a| (d, a))).flat_map(|(d, a)| {
        [LinearSolver::Direct, LinearSolver::ConjugateGradients].map(|linear_solver| (d, a, linear_solver))
    });
    for (is_dynamic, acceleration, linear_solver) in cases {
        let mut solver = Solver::new();
        solver.set_linear_solver(linear_solver);
        solver.set_thread_count(1);
        solver.set_acceleration(acceleration, 6).unwrap();
        solver.set_points(&points).unwrap();
        let all: Vec<[f64; 3]> = points.iter().map(DVec3::to_array).collect();
        let triangles = (0..all.len() as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
        solver.add_reference(&Reference::Polyline { points: all.clone(), closed: false }).unwrap();
        solver.add_reference(&Reference::Mesh { points: all, triangles }).unwrap();
        for info in types() {
            // Every type at its least number of indices, and as long as it may be.
            let longest = info.greatest_indices.unwrap_or(20);
            for corner in (0..n * (n - 2)).step_by(5) {
                let corners = [corner, corner + 1, corner + n + 1, corner + n];
                let short: Vec<u32> = corners.into_iter().cycle().take(info.least_indices).collect();
                solver.add_constraint(info.name, &short, 1.0).unwrap();
            }
            let long: Vec<u32> = (0..longest as u32).collect();
            solver.add_constraint(info.name, &long, 1.0).unwrap();
        }
        if acceleration == Acceleration::None {
            // Every point is held, or nothing would resist some of the forces.
            for point in 0..n * n {
                solver.add_constraint("Closeness", &[point], 1.0).unwrap();
            }
            let faces = |i| [i, i + 1, i + n + 1, i + n];
            let faces: Faces = (0..n * (n - 2)).map(faces).collect();
            solver.add_force(Force::Pressure { pressure: 1e-3, faces: faces.clone() }).unwrap();
            solver.add_force(Force::Normal { magnitude: 1e-3, faces }).unwrap();
        }
        match is_dynamic {
            true => solver.init_dynamic(1.0, 1.0, 0.1).unwrap(),
            false => solver.init().unwrap(),
        }
        let mut counts = Vec::with_capacity(100);
        let options = SolveOptions { max_iterations: 20, tolerance: 0.0, time_budget_seconds: 0.0 };
        solver
            .solve_until(&options, &mut |_| {
                counts.push(allocation_count());
                ControlFlow::Continue(())
            })
            .unwrap();
        assert_eq!(counts.len(), 20);
        let case = format!("dynamic: {is_dynamic}, {acceleration:?}, {linear_solver:?}");
        assert_eq!(counts[19] - counts[1], 0, "allocations in 18 iterations, {case}");
        let before = allocation_count();
        solver.solve(20).unwrap();
        assert_eq!(allocation_count() - before, 0, "allocations in a second solve");
    }
}
