//! Points on reference shapes, from the problem to the answer.

use std::ops::ControlFlow;

use glam::DVec3;
use shapeop::problem::{Problem, Reference};
use shapeop::solver::{SolveOptions, Solver};

#[test]
fn points_slide_along_a_polyline_to_where_the_others_pull_them() {
    // A point on the x axis, drawn to (3, 4, 0): it ends at (3, 0, 0) if the line counts for much, whatever it started at.
    let text = r#"{
        "version": 1,
        "points": [[-5, 1, 0]],
        "references": [{"mesh": {"points": [[0, 0, 9], [1, 0, 9], [0, 1, 9]], "triangles": [[0, 1, 2]]}},
                       {"polyline": {"points": [[-10, 0, 0], [10, 0, 0]]}}],
        "constraints": [{"type": "OnCurve", "indices": [0], "weight": 1e6, "scalars": [1]},
                        {"type": "Closeness", "indices": [0], "scalars": [3, 4, 0]}],
        "settings": {"tolerance": 1e-13, "max_iterations": 100000}
    }"#;
    let problem = Problem::from_json(text).unwrap();
    let mut solver = Solver::from_problem(&problem).unwrap();
    let options = SolveOptions::from(&problem.settings);
    solver.solve_until(&options, &mut |_| ControlFlow::Continue(())).unwrap();
    // In the direction of y the weights 10⁶ and 1 leave 4/(10⁶ + 1).
    let expected = DVec3::new(3.0, 4.0 / (1e6 + 1.0), 0.0);
    assert!(solver.points()[0].distance(expected) < 1e-6, "{}", solver.points()[0]);
    assert!((solver.violations()[0] - expected.y).abs() < 1e-9);
}

#[test]
fn a_net_is_drawn_onto_a_mesh_and_an_edit_draws_it_onto_another() {
    // Two squares at the heights 1 and 5, as two triangles each.
    let square = |z: f64| Reference::Mesh {
        points: vec![[0.0, 0.0, z], [2.0, 0.0, z], [2.0, 2.0, z], [0.0, 2.0, z]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    let mut solver = Solver::new();
    let (low, high) = (solver.add_reference(&square(1.0)).unwrap(), solver.add_reference(&square(5.0)).unwrap());
    assert_eq!((low, high, solver.reference_count()), (0, 1, 2));
    let start: Vec<DVec3> =
        (0..9).map(|i| DVec3::new(f64::from(i % 3), f64::from(i / 3), 0.1 * f64::from(i))).collect();
    solver.set_points(&start).unwrap();
    for i in 0..9 {
        solver.add_constraint("OnMesh", &[i], 1.0).unwrap();
    }
    solver.init().unwrap();
    for (id, z) in [(low, 1.0), (high, 5.0)] {
        for constraint in 0..9 {
            solver.edit_constraint("OnMesh", constraint, &[id as f64]).unwrap();
        }
        solver.solve(1).unwrap();
        for (point, start) in solver.points().iter().zip(&start) {
            assert!(point.distance(start.with_z(z)) < 1e-14, "{point}");
        }
    }
    assert!(solver.violations().iter().all(|violation| *violation < 1e-14));
}
