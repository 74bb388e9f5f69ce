//! The solver against truths that can be derived by hand, and against a dense solver of its own.

use std::ops::ControlFlow;

use glam::DVec3;
use shapeop::error::Status;
use shapeop::problem::{Acceleration, Force};
use shapeop::solver::{Outcome, SolveOptions, Solver};

fn solver(points: &[[f64; 3]]) -> Solver {
    let mut solver = Solver::new();
    solver.set_points(&points.iter().copied().map(DVec3::from).collect::<Vec<_>>()).unwrap();
    solver
}

fn assert_near(found: DVec3, expected: [f64; 3], tolerance: f64) {
    assert!((found - DVec3::from(expected)).length() <= tolerance, "{found} is not {expected:?}");
}

/// A warped quad `z = ±h` at its corners: the best-fit plane is `z = 0`.
const WARPED: [[f64; 3]; 4] = [[0.0, 0.0, 0.1], [1.0, 0.0, -0.1], [1.0, 1.0, 0.1], [0.0, 1.0, -0.1]];

#[test]
fn a_plane_against_closeness_is_a_weighted_mean() {
    // Along z each corner minimises (z − z₀)² w + z² once the plane is z = 0, so z = z₀ w / (w + 1).
    let mut solver = solver(&WARPED);
    solver.add_constraint("Plane", &[0, 1, 2, 3], 1.0).unwrap();
    for i in 0..4 {
        solver.add_constraint("Closeness", &[i], 0.25).unwrap();
    }
    solver.init().unwrap();
    solver.solve(1).unwrap();
    for (point, corner) in solver.points().iter().zip(WARPED) {
        assert_near(*point, [corner[0], corner[1], corner[2] / 5.0], 1e-15);
    }
    // ½ [4 w (0.8 h)² + 4 (0.2 h)²] with h = 0.1.
    assert!((solver.energy() - 0.5 * 4.0 * (0.25 * 0.08 * 0.08 + 0.02 * 0.02)).abs() < 1e-15);
}

#[test]
fn a_spring_under_a_force_stretches_by_force_over_stiffness() {
    // ½ w (x − t)² − f x is least at x = t + f / w.
    let mut solver = solver(&[[1.0, 2.0, 3.0]]);
    solver.add_constraint("Closeness", &[0], 4.0).unwrap();
    solver.add_force(Force::Vertex { force: DVec3::new(2.0, 0.0, -1.0), point: 0 }).unwrap();
    // Before and after, the potential of the force counts: −f·x, then ½ w (f/w)² − f·x.
    assert_eq!(solver.energy(), -(2.0 * 1.0 - 3.0));
    solver.init().unwrap();
    assert_eq!(solver.energy(), -(2.0 * 1.0 - 3.0));
    solver.solve(1).unwrap();
    assert_near(solver.points()[0], [1.5, 2.0, 2.75], 1e-15);
    assert!((solver.energy() - (0.5 * 5.0 / 4.0 - (2.0 * 1.5 - 2.75))).abs() < 1e-15);
}

#[test]
fn a_free_fall_gains_velocity_step_by_step() {
    // Implicit Euler without constraints: v_k = k δ g, x_k = δ² g k (k + 1) / 2.
    let mut solver = solver(&[[0.0; 3]]);
    solver.add_force(Force::Gravity(DVec3::new(0.0, 0.0, -10.0))).unwrap();
    solver.init_dynamic(3.0, 1.0, 0.1).unwrap();
    for k in 1..=20 {
        solver.solve(4).unwrap();
        assert_near(solver.points()[0], [0.0, 0.0, -0.1 * f64::from(k * (k + 1)) / 2.0], 1e-12);
    }
}

#[test]
fn a_lone_plane_flattens_and_keeps_its_mean() {
    for scale in [1e-6, 1.0, 1e6] {
        let points = WARPED.map(|corner| corner.map(|c| (c + 5.0) * scale));
        let mut solver = solver(&points);
        solver.add_constraint("Plane", &[0, 1, 2, 3], 1.0).unwrap();
        solver.init().unwrap();
        solver.solve(3).unwrap();
        for (point, corner) in solver.points().iter().zip(WARPED) {
            let expected = [(corner[0] + 5.0) * scale, (corner[1] + 5.0) * scale, 5.0 * scale];
            assert_near(*point, expected, 1e-13 * scale);
        }
    }
}

#[test]
fn free_components_change_about_their_mean() {
    // Two edges in a chain, one of length 1 and one of length 2 that should be 1: only the second moves, about its middle,
    // and nothing turns or drifts. Point 4 is in no constraint.
    let mut solver = solver(&[[0.0; 3], [1.0, 0.0, 0.0], [5.0, 0.0, 0.0], [7.0, 0.0, 0.0], [9.0, 9.0, 9.0]]);
    solver.add_constraint("EdgeStrain", &[0, 1], 1.0).unwrap();
    let long = solver.add_constraint("EdgeStrain", &[2, 3], 1.0).unwrap();
    solver.edit_constraint("EdgeStrain", long, &[1.0, 1.0, 1.0]).unwrap();
    solver.init().unwrap();
    solver.solve(50).unwrap();
    let expected = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [5.5, 0.0, 0.0], [6.5, 0.0, 0.0], [9.0, 9.0, 9.0]];
    for (point, expected) in solver.points().iter().zip(expected) {
        assert_near(*point, expected, 1e-9);
    }
    assert_eq!(solver.unconstrained_count(), 1);
}

#[test]
fn rows_that_leave_more_than_translations_free_change_the_points_least() {
    // One Laplacian row a = (−1, ½, ½) on three points leaves two motions free. Of all points with a x = 0, those nearest in
    // the metric of the diagonal D = diag(1, ¼, ¼) of N are x − D⁻¹aᵀ (a x) / (a D⁻¹ aᵀ), and D⁻¹aᵀ = (−1, 2, 2), a D⁻¹ aᵀ = 3.
    let start = [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [1.0, 0.5, 0.0]];
    let mut solver = solver(&start);
    solver.add_constraint("Laplacian", &[0, 1, 2], 1.0).unwrap();
    solver.init().unwrap();
    solver.solve(20).unwrap();
    let [apex, left, right] = start.map(DVec3::from);
    let image = 0.5 * (left + right) - apex;
    for (i, factor) in [-1.0, 2.0, 2.0].into_iter().enumerate() {
        let expected = DVec3::from(start[i]) - factor / 3.0 * image;
        // A proximal step loses some 1e-10 of the model's size along the free motions, in each of 20 iterations.
        assert_near(solver.points()[i], expected.to_array(), 1e-8);
    }
    // A force along a is resisted; one that turns the neighbours about the centre is not.
    let vertical = |solver: &mut Solver, forces: [f64; 3]| -> Vec<_> {
        let force = |(point, z): (usize, f64)| Force::Vertex { force: DVec3::Z * z, point: point as u32 };
        forces.into_iter().enumerate().map(|f| solver.add_force(force(f)).unwrap()).collect()
    };
    let resisted = vertical(&mut solver, [-1.0, 0.5, 0.5]);
    solver.solve(1).unwrap();
    resisted.into_iter().for_each(|id| solver.remove_force(id).unwrap());
    vertical(&mut solver, [0.0, 1.0, -1.0]);
    let error = solver.solve(1).unwrap_err();
    assert_eq!(error.status(), Status::Unbounded);
    assert!(error.to_string().contains("point 1"), "{error}");
}

#[test]
fn forces_along_free_motions_are_refused_and_change_nothing() {
    let mut solver = solver(&[WARPED.as_slice(), &[[3.0; 3]]].concat());
    solver.add_constraint("Plane", &[0, 1, 2, 3], 1.0).unwrap();
    solver.init().unwrap();
    let up = |point| Force::Vertex { force: DVec3::Z, point };
    let before = solver.points().to_vec();
    for (forces, word) in [(vec![up(4)], "point 4"), (vec![up(1)], "component of point 0")] {
        let ids: Vec<_> = forces.into_iter().map(|force| solver.add_force(force).unwrap()).collect();
        let error = solver.solve(1).unwrap_err();
        assert_eq!(error.status(), Status::Unbounded);
        assert!(error.to_string().contains(word), "{error}");
        let report = solver.solve_until(&SolveOptions::default(), &mut |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(report.outcome, Outcome::Unbounded);
        assert!(report.message.contains(word));
        assert_eq!(solver.points(), before);
        ids.into_iter().for_each(|id| solver.remove_force(id).unwrap());
    }
    // Forces that balance do not move the component as a whole.
    solver.add_force(up(0)).unwrap();
    solver.add_force(Force::Vertex { force: -DVec3::Z, point: 2 }).unwrap();
    solver.solve(1).unwrap();
    let mean = |points: &[DVec3]| points[..4].iter().sum::<DVec3>() / 4.0;
    assert!((mean(solver.points()) - mean(&before)).length() < 1e-14);
}

/// Dense normal equations by Gauss elimination: the oracle for long centred constraints.
fn dense_step(points: &[DVec3], groups: &[Vec<u32>], closeness: f64) -> Vec<DVec3> {
    let n = points.len();
    let mut matrix = vec![vec![0.0; n]; n];
    let mut rhs: Vec<DVec3> = points.iter().map(|point| closeness * *point).collect();
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] = closeness;
    }
    for group in groups {
        let k = group.len() as f64;
        let mean = group.iter().map(|&i| points[i as usize]).sum::<DVec3>() / k;
        let scatter = shapeop::linalg::small::scatter(group.iter().map(|&i| points[i as usize] - mean));
        let normal = shapeop::linalg::small::least_eigenvector(scatter);
        for &i in group {
            let centred = points[i as usize] - mean;
            rhs[i as usize] += centred - centred.dot(normal) * normal;
            matrix[i as usize][i as usize] += 1.0;
            for &j in group {
                matrix[i as usize][j as usize] -= 1.0 / k;
            }
        }
    }
    for pivot in 0..n {
        for row in pivot + 1..n {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            for column in pivot..n {
                matrix[row][column] -= factor * matrix[pivot][column];
            }
            let step = factor * rhs[pivot];
            rhs[row] -= step;
        }
    }
    for pivot in (0..n).rev() {
        let known: DVec3 = (pivot + 1..n).map(|column| matrix[pivot][column] * rhs[column]).sum();
        rhs[pivot] = (rhs[pivot] - known) / matrix[pivot][pivot];
    }
    rhs
}

/// Points of a bumpy sheet, from a fixed generator.
fn bumpy(n: usize, seed: u64) -> Vec<DVec3> {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    (0..n * n)
        .map(|i| {
            let (x, y) = ((i % n) as f64, (i / n) as f64);
            DVec3::new(x, y, (0.3 * x).sin() * (0.2 * y).cos()) + 0.1 * DVec3::new(random(), random(), random())
        })
        .collect()
}

#[test]
fn long_constraints_through_their_mean_equal_the_dense_rows() {
    let n = 16_u32;
    let points = bumpy(n as usize, 1);
    // Every grid line (16 points: long) and some short ones, one of them with a repeated index.
    let mut groups: Vec<Vec<u32>> = (0..n).map(|row| (0..n).map(|column| row * n + column).collect()).collect();
    groups.extend((0..n).map(|column| (0..n).map(|row| row * n + column).collect::<Vec<_>>()));
    groups.extend([vec![0, 1, n + 1, n], vec![5, 6, n + 6, 5]]);
    let mut repeated: Vec<u32> = (0..14).collect();
    repeated.push(3);
    groups.push(repeated);
    let mut solver = Solver::new();
    solver.set_points(&points).unwrap();
    for group in &groups {
        solver.add_constraint("Plane", group, 1.0).unwrap();
    }
    for i in 0..n * n {
        solver.add_constraint("Closeness", &[i], 0.1).unwrap();
    }
    solver.init().unwrap();
    solver.solve(1).unwrap();
    let expected = dense_step(&points, &groups, 0.1);
    let worst = solver.points().iter().zip(&expected).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(worst < 1e-12, "differs by {worst:.1e}");
}

/// Rows by pairs: after one iteration the gradient of the quadratic energy, with the targets of the points before, vanishes. Edges
/// share points, one is there twice, and one goes from a point to itself.
#[test]
fn edges_of_a_list_are_rows_of_the_system() {
    let points = bumpy(4, 5);
    let edges: &[u32] = &[0, 1, 1, 2, 2, 0, 2, 3, 5, 5, 2, 3, 3, 4, 4, 9, 7, 8];
    let mut solver = Solver::new();
    solver.set_points(&points).unwrap();
    solver.add_constraint("EqualLengths", edges, 0.7).unwrap();
    for i in 0..points.len() as u32 {
        solver.add_constraint("Closeness", &[i], 0.1).unwrap();
    }
    solver.init().unwrap();
    solver.solve(1).unwrap();
    let pairs = || edges.chunks_exact(2).map(|pair| [pair[0] as usize, pair[1] as usize]);
    let before: Vec<DVec3> = pairs().map(|[i, j]| points[j] - points[i]).collect();
    let mean = before.iter().map(|edge| edge.length()).sum::<f64>() / before.len() as f64;
    let now = solver.points();
    let mut gradient: Vec<DVec3> = now.iter().zip(&points).map(|(x, rest)| 0.1 * (*x - *rest)).collect();
    for ([i, j], edge) in pairs().zip(before) {
        let residual = 0.7 * (now[j] - now[i] - mean * edge.try_normalize().unwrap_or(DVec3::X));
        gradient[j] += residual;
        gradient[i] -= residual;
    }
    assert!(gradient.iter().all(|gradient| gradient.length() < 1e-14), "{gradient:?}");
}

#[test]
fn a_triangle_alone_with_equal_lengths_becomes_equilateral() {
    let mut solver = solver(&[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 1.0, 1.0]]);
    solver.add_constraint("EqualLengths", &[0, 1, 1, 2, 2, 0], 1.0).unwrap();
    let mean = solver.points().iter().sum::<DVec3>() / 3.0;
    solver.init().unwrap();
    solver.solve(200).unwrap();
    let [a, b, c] = *solver.points() else { panic!() };
    let lengths = [a.distance(b), b.distance(c), c.distance(a)];
    assert!(lengths[0] > 1.0 && lengths.iter().all(|length| (length - lengths[0]).abs() < 1e-12), "{lengths:?}");
    assert!(((a + b + c) / 3.0 - mean).length() < 1e-14);
    assert!(solver.violations()[0] < 1e-12);
    let error = solver.add_constraint("EqualLengths", &[0, 1, 1, 2, 2], 1.0).unwrap_err();
    assert!(error.to_string().contains("an even number of at least 4"), "{error}");
}

fn planar_grid(n: u32) -> Solver {
    let mut solver = Solver::new();
    solver.set_points(&bumpy(n as usize, 7)).unwrap();
    for row in 0..n - 1 {
        for column in 0..n - 1 {
            let corner = row * n + column;
            solver.add_constraint("Plane", &[corner, corner + 1, corner + n + 1, corner + n], 1.0).unwrap();
        }
    }
    for i in 0..n * n {
        solver.add_constraint("Closeness", &[i], 0.05).unwrap();
    }
    solver
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let run = |thread_count| {
        let mut solver = planar_grid(80);
        solver.set_thread_count(thread_count);
        solver.init().unwrap();
        let options = SolveOptions { max_iterations: 10, ..SolveOptions::default() };
        let report = solver.solve_until(&options, &mut |_| ControlFlow::Continue(())).unwrap();
        (solver.points().to_vec(), report.energy_after.to_bits())
    };
    let one = run(1);
    for thread_count in [2, 3, 7] {
        assert!(run(thread_count) == one, "{thread_count} threads");
    }
}

#[test]
fn a_matrix_with_many_dependent_rows_is_made_definite() {
    // Hinges at nearly collinear points, with rows of very different size, leave far more free than translations.
    let height = |i: u32| DVec3::new(f64::from(i), 0.3 * f64::from(i * 7 % 5), 0.3 * f64::from(i * 3 % 4));
    let points: Vec<DVec3> = (0..20).map(height).collect();
    let mut solver = Solver::new();
    solver.set_points(&points).unwrap();
    for i in (0..16).step_by(2) {
        solver.add_constraint("Bending", &[i, i + 1, i + 2, i + 3], 1.0).unwrap();
    }
    solver.init().unwrap();
    solver.solve(5).unwrap();
    // At rest nothing moves, but for round-off, which weakly held motions amplify.
    let moved = solver.points().iter().zip(&points).map(|(found, start)| found.distance(*start)).fold(0.0, f64::max);
    assert!(moved < 1e-6, "moved by {moved:.1e}");
}

#[test]
fn stopping_rules_report_what_they_did() {
    let mut solver = planar_grid(12);
    solver.init().unwrap();
    let mut energies = Vec::new();
    let options = SolveOptions { max_iterations: 5000, tolerance: 1e-7, time_budget_seconds: 0.0 };
    let report = solver
        .solve_until(&options, &mut |progress| {
            assert_eq!(progress.solver.points().len(), 144);
            assert!((progress.solver.energy() / progress.energy - 1.0).abs() < 1e-12);
            energies.push(progress.energy);
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(report.outcome, Outcome::Converged);
    assert!(report.largest_move < 1e-7);
    assert_eq!(report.iterations as usize, energies.len());
    assert!(energies.windows(2).all(|pair| pair[1] <= pair[0] * (1.0 + 1e-12)), "the energy rose");
    assert_eq!(report.energy_after.to_bits(), energies.last().unwrap().to_bits());

    let mut cancelled = planar_grid(12);
    cancelled.set_acceleration(Acceleration::None, 0).unwrap();
    cancelled.init().unwrap();
    let stop = |at: u32| {
        move |progress: &shapeop::solver::Progress<'_>| match progress.iteration {
            i if i == at => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    };
    let report = cancelled.solve_until(&options, &mut stop(3)).unwrap();
    assert_eq!((report.outcome, report.iterations), (Outcome::Cancelled, 3));
    let mut plain = planar_grid(12);
    plain.init().unwrap();
    plain.solve(3).unwrap();
    assert_eq!(plain.points(), cancelled.points());

    let endless = SolveOptions { max_iterations: u32::MAX, tolerance: 0.0, time_budget_seconds: 0.0 };
    let report = cancelled.solve_until(&endless, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(report.outcome, Outcome::Stalled);
    let hurried = SolveOptions { time_budget_seconds: 1e-9, ..endless };
    let report = cancelled.solve_until(&hurried, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!((report.outcome, report.iterations), (Outcome::TimeBudget, 1));
}

#[test]
fn edits_take_effect_at_the_next_solve() {
    let mut solver = solver(&[[0.0; 3], [1.0, 0.0, 0.0]]);
    let held = solver.add_constraint("Closeness", &[0], 1e6).unwrap();
    let edge = solver.add_constraint("EdgeStrain", &[0, 1], 1.0).unwrap();
    solver.init().unwrap();
    solver.edit_constraint("EdgeStrain", edge, &[3.0, 1.0, 1.0]).unwrap();
    solver.solve(100).unwrap();
    assert_near(solver.points()[1], [3.0, 0.0, 0.0], 1e-9);
    solver.edit_constraint("Closeness", held, &[0.0, 5.0, 0.0]).unwrap();
    solver.solve(2000).unwrap();
    assert!((solver.points()[0].distance(solver.points()[1]) - 3.0).abs() < 1e-9);
    solver.set_weight(edge, 0.0).unwrap();
    solver.solve(1).unwrap();
    assert_eq!(solver.unconstrained_count(), 1);
    solver.remove_constraint(edge).unwrap();
    assert_eq!(solver.constraint_count(), 2);
    assert_eq!(solver.violations()[edge], 0.0);
    assert!(solver.constraint(edge).is_none());
    assert_eq!(solver.remove_constraint(edge).unwrap_err().status(), Status::UnmatchingConstraintId);
    assert_eq!(solver.add_constraint("EdgeStrain", &[0, 1], 1.0).unwrap(), 2);
    solver.solve(1).unwrap();
}

#[test]
fn a_removed_constraint_counts_no_more_even_before_the_next_solve() {
    let mut solver = solver(&[[0.0; 3], [1.0, 0.0, 0.0]]);
    let edge = solver.add_constraint("EdgeStrain", &[0, 1], 1.0).unwrap();
    solver.edit_constraint("EdgeStrain", edge, &[2.0, 1.0, 1.0]).unwrap();
    // ½ w L₀ (‖e‖/L − 1)² with w = L₀ = 1, ‖e‖/L = ½.
    assert!((solver.energy() - 0.125).abs() < 1e-15);
    assert_eq!(solver.unconstrained_count(), 0);
    solver.remove_constraint(edge).unwrap();
    assert_eq!(solver.energy(), 0.0);
    assert_eq!(solver.unconstrained_count(), 2);
}

#[test]
fn points_may_be_added_and_removed_while_nothing_refers_to_them() {
    let mut solver = solver(&[[0.0; 3], [1.0, 0.0, 0.0]]);
    solver.add_constraint("EdgeStrain", &[0, 1], 1.0).unwrap();
    solver.init_dynamic(1.0, 1.0, 0.5).unwrap();
    let refused = solver.set_points(&[DVec3::ZERO]).unwrap_err();
    assert_eq!(refused.status(), Status::InvalidArgumentLength);
    assert_eq!(solver.points().len(), 2);
    solver.set_points(&[DVec3::ZERO, DVec3::X, DVec3::Y]).unwrap();
    solver.add_force(Force::Vertex { force: DVec3::Y, point: 2 }).unwrap();
    solver.solve(3).unwrap();
    assert_near(solver.points()[2], [0.0, 1.25, 0.0], 1e-15);
    assert!(solver.set_points(&[DVec3::ZERO, DVec3::X]).is_err());
    let error = solver.set_points(&[DVec3::ZERO, DVec3::NAN, DVec3::X]).unwrap_err();
    assert_eq!(error.place(), "points[1]");
}

#[test]
fn what_overflows_is_refused_and_changes_nothing() {
    let mut solver = solver(&[[0.0; 3], [1e200, 0.0, 0.0], [0.0, 1e200, 0.0]]);
    solver.add_constraint("Plane", &[0, 1, 2], 1.0).unwrap();
    solver.add_constraint("Closeness", &[0], 1e300).unwrap();
    solver.add_force(Force::Gravity(DVec3::splat(1e305))).unwrap();
    solver.init_dynamic(1e10, 1e300, 1e-300).map_or_else(|_| (), |()| ());
    let before = solver.points().to_vec();
    let _ = solver.solve(5);
    assert!(solver.points().iter().all(|point| point.is_finite()));
    if solver.solve(5).is_err() {
        assert_eq!(solver.points(), before);
    }
}

#[test]
fn without_points_or_constraints_nothing_happens() {
    let mut empty = Solver::new();
    empty.init().unwrap();
    empty.solve(3).unwrap();
    empty.init_dynamic(1.0, 1.0, 1.0).unwrap();
    empty.solve(3).unwrap();
    let mut loose = solver(&[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    loose.init().unwrap();
    loose.solve(3).unwrap();
    assert_eq!((loose.points()[1], loose.unconstrained_count()), (DVec3::new(4.0, 5.0, 6.0), 2));
}

#[test]
fn a_report_that_would_not_be_finite_is_refused_and_changes_nothing() {
    // Lengths of points that are finite overflow, and so does the energy.
    let mut solver = solver(&[[0.0; 3], [1.0, 0.0, 0.0]]);
    solver.add_constraint("EdgeStrain", &[0, 1], 1.0).unwrap();
    solver.init().unwrap();
    let far = [DVec3::ZERO, DVec3::splat(1e200)];
    solver.set_points(&far).unwrap();
    let error = solver.solve_until(&SolveOptions::default(), &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert_eq!(error.status(), Status::InvalidValue);
    assert_eq!(solver.points(), far);
}

#[test]
fn a_refused_solve_leaves_the_energy_as_it_was() {
    // Refused because a force acts along a free motion, because the step overflows, and because the mass does.
    let mut solver = solver(&WARPED);
    solver.add_constraint("Plane", &[0, 1, 2, 3], 1.0).unwrap();
    let push = |z| Force::Vertex { force: DVec3::Z * z, point: 0 };
    solver.add_force(push(1.0)).unwrap();
    let back = solver.add_force(push(-1.0)).unwrap();
    solver.init().unwrap();
    solver.solve(1).unwrap();
    solver.remove_force(back).unwrap();
    let energy = solver.energy();
    assert_eq!(solver.solve(1).unwrap_err().status(), Status::Unbounded);
    assert_eq!(solver.energy(), energy);

    solver.init_dynamic(1.0, 1.0, 0.5).unwrap();
    solver.solve(1).unwrap();
    let (energy, points) = (solver.energy(), solver.points().to_vec());
    assert!(energy > 0.0);
    solver.add_force(push(1e308)).unwrap();
    solver.set_timestep(1e10).unwrap();
    assert_eq!(solver.solve(1).unwrap_err().status(), Status::InvalidValue);
    assert_eq!((solver.energy(), solver.points()), (energy, points.as_slice()));
    assert!(solver.init_dynamic(1e308, 1.0, 1e-300).is_err());
    assert_eq!((solver.energy(), solver.points()), (energy, points.as_slice()));
}
