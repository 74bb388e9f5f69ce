//! Exploration: hard constraints met exactly, the objective as small as that allows. Violations, gradients and objectives are
//! computed here, from coordinates alone.

use std::ops::ControlFlow;

use glam::DVec3;
use serde_json::Value;
use shapeop::constraints::{ConstraintId, NewConstraints};
use shapeop::mesh::patterns::translation_surface;
use shapeop::mesh::{Mesh, Topology};
use shapeop::problem::{FairnessRows, Objective};
use shapeop::solver::{Outcome, Report, SolveOptions, Solver, WeightClass};

fn solve(solver: &mut Solver) -> Report {
    solver.solve_until(&SolveOptions::default(), &mut |_| ControlFlow::Continue(())).unwrap()
}

fn edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    Topology::new(mesh).unwrap().edges().to_vec()
}

fn mean_edge(mesh: &Mesh) -> f64 {
    let edges = edges(mesh);
    let length = |[a, b]: &[u32; 2]| mesh.points[*a as usize].distance(mesh.points[*b as usize]);
    edges.iter().map(length).sum::<f64>() / edges.len() as f64
}

/// A constraint of this type on every face; returns their ids.
fn on_faces(solver: &mut Solver, mesh: &Mesh, type_name: &str, scalars: &[f64], is_hard: bool) -> Vec<ConstraintId> {
    let counts: Vec<usize> = mesh.faces.iter().map(Vec::len).collect();
    let new = NewConstraints {
        type_name,
        indices: &mesh.faces.concat(),
        counts: &counts,
        weights: &[1.0],
        scalars,
        scalar_counts: if scalars.is_empty() { &[] } else { &[1] },
    };
    let first = solver.add_constraints(new).unwrap();
    let ids: Vec<ConstraintId> = (first..first + counts.len()).collect();
    solver.set_hard(&ids, is_hard).unwrap();
    ids
}

fn solver_of(mesh: &Mesh, objective: &Objective) -> Solver {
    let mut solver = Solver::new();
    solver.set_points(&mesh.points).unwrap();
    let rows = FairnessRows::laplacian(mesh.points.len(), &edges(mesh));
    solver.set_objective(objective, rows).unwrap();
    solver
}

/// Fig. 12 of Deng et al. 2015: diagonals within 1 % of the mean edge, the boundary held, the centre lifted by an edge.
fn figure_12(n: usize) -> (Solver, Mesh) {
    let mesh = translation_surface(n).unwrap();
    let edge = mean_edge(&mesh);
    let mut solver = solver_of(&mesh, &Objective::default());
    on_faces(&mut solver, &mesh, "DiagonalDistance", &[0.01 * edge], true);
    let on_boundary = Topology::new(&mesh).unwrap().boundary_points();
    for (point, _) in (0..).zip(on_boundary).filter(|(_, is_on)| *is_on) {
        solver.set_handle(point, mesh.points[point as usize]).unwrap();
    }
    let centre = n * n / 2;
    solver.set_handle(centre as u32, mesh.points[centre] + edge * DVec3::Z).unwrap();
    solver.init().unwrap();
    (solver, mesh)
}

/// The distance of the diagonals' lines.
fn diagonal_distance(points: &[DVec3], face: &[u32]) -> f64 {
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| points[face[i] as usize]);
    let normal = (c - a).cross(d - b).normalize();
    normal.dot(b - a).abs()
}

/// `½ w_h Σ + ½ w_c Σ + ½ w_f Σ` with the default weights.
fn objective_of(points: &[DVec3], initial: &Mesh, handles: &[(u32, DVec3)]) -> f64 {
    let weights = Objective::default();
    let mut neighbours = vec![Vec::new(); points.len()];
    for [a, b] in edges(initial) {
        neighbours[a as usize].push(b as usize);
        neighbours[b as usize].push(a as usize);
    }
    let moved: Vec<DVec3> = points.iter().zip(&initial.points).map(|(p, start)| *p - *start).collect();
    let mut sum = 0.0;
    for (i, around) in neighbours.iter().enumerate() {
        let mean = around.iter().map(|&j| moved[j]).sum::<DVec3>() / around.len() as f64;
        sum += 0.5 * weights.fairness_weight * (moved[i] - mean).length_squared();
        sum += match handles.iter().find(|(point, _)| *point as usize == i) {
            Some((_, target)) => 0.5 * weights.handle_weight * points[i].distance_squared(*target),
            None => 0.5 * weights.closeness_weight * moved[i].length_squared(),
        };
    }
    sum
}

#[test]
fn bounded_diagonals_lead_to_the_solution_that_an_interior_point_method_and_newton_found() {
    let text = std::fs::read_to_string("tests/exploration/fig12_21.json").unwrap();
    let known: Value = serde_json::from_str(&text).unwrap();
    let numbers: Vec<f64> = known["points"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|point| {
            point
                .as_array()
                .map_or_else(|| vec![point.as_f64().unwrap()], |xyz| xyz.iter().map(|x| x.as_f64().unwrap()).collect())
        })
        .collect();
    let expected: Vec<DVec3> = numbers.chunks(3).map(DVec3::from_slice).collect();
    let (mut solver, mesh) = figure_12(21);
    let report = solve(&mut solver);
    assert_eq!(report.outcome, Outcome::Converged);
    let distance = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt();
    let away = distance(solver.points(), &expected) / distance(&mesh.points, &expected);
    assert!(away < 1e-6, "{away:e}");
    let edge = mean_edge(&mesh);
    let largest = mesh.faces.iter().map(|face| diagonal_distance(solver.points(), face)).fold(0.0, f64::max);
    assert!(largest <= 0.01 * edge + 1e-9 * edge, "{:e}", largest / edge - 0.01);
    let handles: Vec<(u32, DVec3)> = solver.handles().collect();
    let value = objective_of(solver.points(), &mesh, &handles);
    let known = known["objective"].as_f64().unwrap();
    assert!((value - known).abs() <= 1e-8 * known, "{value:.12} is not {known:.12}");
    assert!((report.energy_after - value).abs() <= 1e-12 * value);
    let found = solver.found().unwrap();
    assert!(found.is_solution && found.conflicts.is_empty());
}

#[test]
fn with_closeness_alone_a_hard_plane_is_the_best_fit_plane() {
    // Corners alternately h above and below z = 0: the nearest planar quad is the square itself.
    let points = [[0.0, 0.0, 0.1], [1.0, 0.0, -0.1], [1.0, 1.0, 0.1], [0.0, 1.0, -0.1]].map(DVec3::from).to_vec();
    let mesh = Mesh { points, faces: vec![vec![0, 1, 2, 3]] };
    let mut solver = solver_of(&mesh, &Objective { fairness_weight: 0.0, ..Objective::default() });
    on_faces(&mut solver, &mesh, "Plane", &[], true);
    solver.init().unwrap();
    assert_eq!(solve(&mut solver).outcome, Outcome::Converged);
    for (found, start) in solver.points().iter().zip(&mesh.points) {
        assert!((*found - DVec3::new(start.x, start.y, 0.0)).length() < 1e-11, "{found}");
    }
}

#[test]
fn sweeps_at_a_solution_stay_there_however_many_they_are() {
    // So few rows that sweeps come to rest to the last bit, where nothing changes any more.
    let points = [[0.0, 0.0, 0.1], [1.0, 0.0, -0.1], [1.0, 1.0, 0.1], [0.0, 1.0, -0.1]].map(DVec3::from).to_vec();
    let mesh = Mesh { points, faces: vec![vec![0, 1, 2, 3]] };
    let mut solver = solver_of(&mesh, &Objective { fairness_weight: 0.0, ..Objective::default() });
    on_faces(&mut solver, &mesh, "Plane", &[], true);
    solver.init().unwrap();
    solver.solve(2000).unwrap();
    assert!(solver.points().iter().all(|point| point.z.abs() < 1e-12), "{:?}", solver.points());
    // An edge that a moved handle takes along: 3 (t - 1)² + t² is least at t = 3/4.
    let mut solver = Solver::new();
    solver.set_points(&[DVec3::ZERO, DVec3::X]).unwrap();
    let edge = solver.add_constraint("EdgeLength", &[0, 1], 1.0).unwrap();
    solver.edit_constraint("EdgeLength", edge, &[1.0, 1.0]).unwrap();
    solver.set_hard(&[edge], true).unwrap();
    let objective =
        Objective { handle_weight: 3.0, closeness_weight: 1.0, fairness_weight: 0.0, ..Objective::default() };
    solver.set_objective(&objective, FairnessRows::default()).unwrap();
    solver.set_handle(1, DVec3::X).unwrap();
    solver.init().unwrap();
    solver.solve(2000).unwrap();
    solver.set_handle(1, 2.0 * DVec3::X).unwrap();
    solver.solve(2000).unwrap();
    assert!(solver.points()[0].distance(0.75 * DVec3::X) < 1e-9, "{}", solver.points()[0]);
}

#[test]
fn two_lengths_of_one_edge_contradict_each_other_even_where_there_is_nothing_else() {
    let mut solver = Solver::new();
    solver.set_points(&[DVec3::ZERO, DVec3::X]).unwrap();
    let ids = [(1.0, 2.0), (3.0, 1.0)].map(|(length, priority)| {
        let id = solver.add_constraint("EdgeLength", &[0, 1], priority).unwrap();
        solver.edit_constraint("EdgeLength", id, &[length, length]).unwrap();
        id
    });
    solver.set_hard(&ids, true).unwrap();
    solver.init().unwrap();
    assert_eq!(solve(&mut solver).outcome, Outcome::Infeasible);
    let conflicts = &solver.found().unwrap().conflicts;
    assert!(conflicts.len() == 1 && ids.contains(&conflicts[0]), "{conflicts:?}");
}

#[test]
fn one_of_two_lengths_of_an_edge_is_named_and_the_others_are_met() {
    let mesh = translation_surface(9).unwrap();
    let edge = mean_edge(&mesh);
    for (planted_priority, other_priority) in [(1.0, 2.0), (0.5, 1.0)] {
        let mut solver = solver_of(&mesh, &Objective::default());
        let mut ids = Vec::new();
        for [a, b] in edges(&mesh) {
            let id = solver.add_constraint("EdgeLength", &[a, b], other_priority).unwrap();
            let length = mesh.points[a as usize].distance(mesh.points[b as usize]);
            solver.edit_constraint("EdgeLength", id, &[0.97 * length, 1.03 * length]).unwrap();
            ids.push(id);
        }
        let [a, b] = edges(&mesh)[40];
        let planted = solver.add_constraint("EdgeLength", &[a, b], planted_priority).unwrap();
        solver.edit_constraint("EdgeLength", planted, &[1.5 * edge, 1.6 * edge]).unwrap();
        ids.push(planted);
        solver.set_hard(&ids, true).unwrap();
        solver.init().unwrap();
        let report = solve(&mut solver);
        assert_eq!(report.outcome, Outcome::Infeasible, "after {} sweeps", report.iterations);
        assert!(report.iterations <= 300);
        assert_eq!(solver.found().unwrap().conflicts, [planted]);
        let violations = solver.violations();
        let worst = ids.iter().filter(|id| **id != planted).map(|id| violations[*id]).fold(0.0, f64::max);
        assert!(worst < 1e-3 * edge, "{worst}");
        assert!(solver.points().iter().all(|point| point.length() < 100.0));
    }
}

#[test]
fn sensitivities_are_the_differences_of_solutions() {
    let mesh = translation_surface(7).unwrap();
    let solution = |[handle, closeness, fairness, soft]: [f64; 4]| {
        let objective = Objective {
            // Heavy handles hardly answer to their weight.
            handle_weight: 5.0 * handle,
            closeness_weight: 0.1 * closeness,
            fairness_weight: fairness,
            tolerance: 1e-14,
            ..Objective::default()
        };
        let mut solver = solver_of(&mesh, &objective);
        on_faces(&mut solver, &mesh, "Plane", &[], true);
        let ids = on_faces(&mut solver, &mesh, "RegularPolygon", &[], false);
        ids.iter().for_each(|id| solver.set_weight(*id, 0.3 * soft).unwrap());
        for corner in [0, 6, 42, 48] {
            solver.set_handle(corner, mesh.points[corner as usize]).unwrap();
        }
        solver.set_handle(24, mesh.points[24] + DVec3::new(0.1, 0.0, 0.5)).unwrap();
        solver.init().unwrap();
        let report = solve(&mut solver);
        assert!(solver.found().unwrap().is_solution, "{report:?}");
        solver
    };
    let mut solver = solution([1.0; 4]);
    let found = solver.sensitivities().unwrap();
    let soft = WeightClass::Soft("RegularPolygon");
    assert_eq!(found.classes, [WeightClass::Handles, WeightClass::Closeness, WeightClass::Fairness, soft]);
    for (class, moved) in found.points.iter().enumerate() {
        // Near-dependent planes leave some 1e-9 undecided in each solution, so steps are long, and errors of second order cancel.
        let at = |step: f64| {
            let mut factors = [1.0; 4];
            factors[class] = step.exp();
            solution(factors).points().to_vec()
        };
        let step = 0.04;
        let [plus, minus, plus_2, minus_2] = [step, -step, 2.0 * step, -2.0 * step].map(at);
        let slope = |i: usize| (8.0 * (plus[i] - minus[i]) - (plus_2[i] - minus_2[i])) / (12.0 * step);
        let size = moved.iter().map(|d| d.length_squared()).sum::<f64>().sqrt();
        let error = (0..moved.len()).map(|i| slope(i).distance_squared(moved[i])).sum::<f64>().sqrt() / size;
        println!("sensitivity {}: {error:.1e} from differences", found.classes[class].name());
        assert!(error < 1e-5, "{:?}: {error:e}", found.classes[class]);
    }
}

#[test]
fn a_drag_goes_on_from_where_it_is_and_constraints_change_in_between() {
    let mesh = translation_surface(11).unwrap();
    let edge = mean_edge(&mesh);
    let mut solver = solver_of(&mesh, &Objective::default());
    let planes = on_faces(&mut solver, &mesh, "Plane", &[], true);
    for corner in [0, 10, 110, 120] {
        solver.set_handle(corner, mesh.points[corner as usize]).unwrap();
    }
    solver.init().unwrap();
    for step in 1..=5 {
        solver.set_handle(60, mesh.points[60] + 0.2 * f64::from(step) * edge * DVec3::Z).unwrap();
        assert!(solve(&mut solver).outcome == Outcome::Converged, "step {step}");
        let worst = planes.iter().map(|id| solver.violations()[*id]).fold(0.0, f64::max);
        assert!(worst < 1e-9 * edge, "step {step}: {worst:e}");
    }
    let there = solver.points().to_vec();
    // The same again: nothing moves.
    solve(&mut solver);
    let moved = solver.points().iter().zip(&there).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(moved < 1e-8 * edge, "{moved:e}");
    // Soft planes are a compromise, hard ones again are not.
    solver.set_hard(&planes, false).unwrap();
    solve(&mut solver);
    let soft = planes.iter().map(|id| solver.violations()[*id]).fold(0.0, f64::max);
    assert!(soft > 1e-5 * edge, "{soft:e}");
    solver.set_hard(&planes, true).unwrap();
    assert_eq!(solve(&mut solver).outcome, Outcome::Converged);
    let back = solver.points().iter().zip(&there).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(back < 1e-6 * edge, "{back:e}");
    // Without the handle and the planes everything is where it was.
    planes.iter().for_each(|id| solver.remove_constraint(*id).unwrap());
    solver.release_handle(60).unwrap();
    solve(&mut solver);
    let away = solver.points().iter().zip(&mesh.points).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(away < 1e-9 * edge, "{away:e}");
}

#[test]
fn what_cannot_be_is_refused_by_name_and_changes_nothing() {
    let mesh = translation_surface(3).unwrap();
    let mut solver = solver_of(&mesh, &Objective::default());
    let ids = on_faces(&mut solver, &mesh, "Plane", &[], true);
    let refusal = |result: shapeop::error::Result<()>| result.unwrap_err().to_string();
    let told = refusal(solver.set_handle(9, DVec3::ZERO));
    assert_eq!(told, "handle: 9 is out of range for 9 points");
    assert!(refusal(solver.set_handle(0, DVec3::new(0.0, f64::NAN, 0.0))).contains("target"));
    assert_eq!(refusal(solver.release_handle(4)), "handle: point 4 is no handle");
    assert_eq!(refusal(solver.set_hard(&[ids[0], 77], true)), "ids[1]: 77 is none of the 4 ids given out");
    for (objective, part) in [
        (Objective { handle_weight: 0.0, ..Objective::default() }, "handle_weight: expected a number above 0"),
        (Objective { closeness_weight: -1.0, ..Objective::default() }, "closeness_weight: expected"),
        (Objective { fairness_weight: f64::NAN, ..Objective::default() }, "fairness_weight"),
        (Objective { tolerance: 1e-16, ..Objective::default() }, "tolerance: expected at least 1e-14"),
    ] {
        let told = refusal(solver.set_objective(&objective, FairnessRows::default()));
        assert!(told.contains(part), "{told}");
    }
    let rows = FairnessRows::laplacian(20, &[[1, 19]]);
    assert!(refusal(solver.set_objective(&Objective::default(), rows)).contains("19 is out of range for 9 points"));
    assert!(solver.sensitivities().unwrap_err().to_string().contains("solve"));
    solver.init().unwrap();
    assert_eq!(solve(&mut solver).outcome, Outcome::Converged);
    assert!(solver.init_dynamic(1.0, 1.0, 1.0).is_err());
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let mesh = translation_surface(70).unwrap();
    let run = |thread_count| {
        let mut solver = solver_of(&mesh, &Objective::default());
        solver.set_thread_count(thread_count);
        on_faces(&mut solver, &mesh, "Plane", &[], true);
        on_faces(&mut solver, &mesh, "RegularPolygon", &[], false);
        solver.set_handle(2450, mesh.points[2450] + DVec3::Z).unwrap();
        solver.init().unwrap();
        solver.solve(12).unwrap();
        solver.points().to_vec()
    };
    let one = run(1);
    for thread_count in [2, 3] {
        assert!(run(thread_count) == one, "{thread_count} threads");
    }
}

#[test]
fn newton_steps_are_reported_and_can_be_cancelled() {
    let (mut solver, _) = figure_12(11);
    let mut seen: Vec<[u32; 2]> = Vec::new();
    let report = solver.solve_until(&SolveOptions::default(), &mut |now| {
        seen.push([now.iteration, now.evaluations]);
        ControlFlow::Continue(())
    });
    assert_eq!(report.unwrap().outcome, Outcome::Converged);
    assert!(seen.iter().any(|[iteration, evaluations]| evaluations > iteration), "no Newton step was seen");
    assert!(seen.windows(2).all(|pair| pair[0][1] < pair[1][1]), "evaluations do not grow: {seen:?}");
    let (mut solver, _) = figure_12(11);
    let report = solver.solve_until(&SolveOptions::default(), &mut |now| {
        if now.evaluations > now.iteration { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!(report.unwrap().outcome, Outcome::Cancelled);
    assert!(!solver.found().unwrap().is_solution);
}
