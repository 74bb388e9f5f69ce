//! The problem files in `examples/`: what is committed is what the program beside them writes, and the cloth comes back
//! to rest after an extreme pull.

#[allow(dead_code, reason = "its main is the example's")]
#[path = "../examples/write_problems.rs"]
mod write_problems;

use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec3;
use shapeop::mesh::measure::{Spread, displacements};
use shapeop::problem::Problem;
use shapeop::solver::{SolveOptions, Solver};

#[test]
fn the_committed_problems_are_current() {
    for (name, problem) in write_problems::problems().unwrap() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(
            text == problem.to_json(),
            "{name}: run `cargo run --example write_problems` and look at the difference"
        );
        assert!(Problem::from_json(&text).unwrap() == problem, "{name} is not read back to the last bit");
    }
}

#[test]
fn the_committed_drag_is_current() {
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/explore_moves.json")).unwrap();
    assert!(text == write_problems::explore_moves().unwrap(), "run `cargo run --example write_problems`");
}

/// Makes the steps of a dynamic problem with its edits; after each, `look` sees the points.
fn simulate(problem: &Problem, steps: u32, look: &mut dyn FnMut(u32, &[DVec3])) -> Vec<DVec3> {
    let mut solver = Solver::from_problem(problem).unwrap();
    let settings = problem.settings;
    let options = SolveOptions {
        max_iterations: settings.max_iterations,
        tolerance: settings.tolerance,
        time_budget_seconds: 0.0,
    };
    for step in 1..=steps {
        for (type_name, id, scalars) in problem.edits_before(step) {
            solver.edit_constraint(type_name, id, scalars).unwrap();
        }
        solver.solve_until(&options, &mut |_| ControlFlow::Continue(())).unwrap();
        look(step, solver.points());
    }
    solver.points().to_vec()
}

/// Anchors pulled apart at once, 4 and 1000 times as far as the cloth is wide, neither blow it up nor leave a trace: when
/// they are let back it comes to rest where a cloth does that was never pulled.
#[test]
fn a_cloth_pulled_apart_hangs_again_as_if_nothing_had_happened() {
    let size = write_problems::SPACING * f64::from(write_problems::SQUARES);
    for pull in [4.0, 1000.0] {
        let pulled = write_problems::hanging_cloth(pull).unwrap();
        let undisturbed = Problem { edits: Vec::new(), ..pulled.clone() };
        let steps = 600;
        let mut farthest = 0.0_f64;
        let after = simulate(&pulled, steps, &mut |_, points| {
            assert!(points.iter().all(|point| point.is_finite()));
            farthest = points.iter().map(|point| point.length()).fold(farthest, f64::max);
        });
        let mut last_move = f64::INFINITY;
        let mut last: Vec<DVec3> = Vec::new();
        let expected = simulate(&undisturbed, steps, &mut |_, points| {
            if !last.is_empty() {
                last_move = Spread::of(&displacements(&last, points).unwrap()).max;
            }
            last = points.to_vec();
        });
        let difference = Spread::of(&displacements(&expected, &after).unwrap());
        println!(
            "pull {pull}: at most {farthest:.1} m from the corner; at the end {:.2e} (max), {:.2e} (mean) of its size from \
             the undisturbed cloth, which still moves {:.1e} per step",
            difference.max / size,
            difference.mean / size,
            last_move / size,
        );
        assert!(farthest > 0.5 * pull * size, "the cloth was not pulled");
        assert!(farthest < 2.0 * pull * size, "the cloth blew up");
        assert!(difference.max < 1e-4 * size);
    }
}
