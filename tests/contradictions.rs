//! Contradictions of hard constraints: planted ones are named exactly, and where all can be met none is reported. Each
//! problem prints one line.

mod planted;

use glam::DVec3;
use planted::{Case, case, case_of, edges, feasible, grid, grid_with_longer_edges, infeasible, polygon, ring};
use shapeop::problem::Force;
use shapeop::solver::{Outcome, SolveOptions};

/// Sweeps before the search for a contradiction, at most.
const RECOGNISED: u32 = 300;

/// How far points may come from the middle of the model, in its sizes.
const BOUND: f64 = 4.0;

/// In one call, unless it takes more sweeps.
fn whole() -> SolveOptions {
    SolveOptions::default()
}

#[test]
fn planted_contradictions_are_named_exactly() {
    let mut wrong = Vec::new();
    println!();
    for (mut case, mut twin) in infeasible().into_iter().zip(infeasible()) {
        let solved = case.solve(&whole());
        // The same in calls of one sweep, which end when it is named: the twin goes the same way.
        let named_after = twin.solve(&SolveOptions { max_iterations: 1, ..whole() });
        let recognised = named_after.sweeps - named_after.search_sweeps;
        let named = case.planted.iter().filter(|id| solved.conflicts.contains(id)).count();
        let is_exact = solved.outcome == Outcome::Infeasible && solved.conflicts == case.planted;
        println!(
            "infeasible {}: named {named} of {}{}, {recognised} sweeps, largest coordinate {:.2} sizes; named after {} \
             with the search, others met to {:.0e} after {}",
            case.name,
            case.planted.len(),
            if is_exact { " exactly" } else { "" },
            solved.farthest,
            named_after.sweeps,
            case.violation(),
            solved.sweeps,
        );
        let is_bounded = solved.farthest <= BOUND && named_after.farthest <= BOUND;
        let is_same = named_after.conflicts == solved.conflicts && named_after.sweeps <= solved.sweeps;
        if !(is_exact && is_same && recognised <= RECOGNISED && is_bounded && case.violation() <= 1e-9) {
            wrong.push(format!("{}: {:?} {:?} not {:?}", case.name, solved.outcome, solved.conflicts, case.planted));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn where_all_can_be_met_no_contradiction_is_reported() {
    let mut wrong = Vec::new();
    println!();
    for mut case in feasible() {
        let solved = case.solve(&whole());
        let violation = case.violation();
        let is_right = solved.outcome == Outcome::Converged && solved.conflicts.is_empty();
        println!(
            "feasible {}: {}, largest violation {violation:.1e}; {} sweeps, {} of them in the search, {}",
            case.name,
            if solved.conflicts.is_empty() { "no conflict" } else { "CONFLICT" },
            solved.sweeps,
            solved.search_sweeps,
            solved.outcome.text(),
        );
        if !(is_right && violation <= 1e-9) {
            wrong.push(format!("{}: {:?} {:?}, {violation:e}", case.name, solved.outcome, solved.conflicts));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn calls_of_seven_sweeps_name_the_same() {
    for mut case in infeasible().into_iter().chain(feasible()) {
        let solved = case.solve(&SolveOptions { max_iterations: 7, ..whole() });
        println!("{} in {} calls of 7 sweeps: {}", case.name, solved.calls, solved.outcome.text());
        let expected = if case.planted.is_empty() { Outcome::Converged } else { Outcome::Infeasible };
        assert_eq!((solved.outcome, &solved.conflicts), (expected, &case.planted), "{}", case.name);
    }
}

#[test]
fn a_few_milliseconds_at_a_time_name_the_same() {
    for mut case in infeasible() {
        let solved = case.solve(&SolveOptions { time_budget_seconds: 2e-4, ..whole() });
        println!(
            "{} in {} calls of 0.2 ms: {} after {} sweeps",
            case.name,
            solved.calls,
            solved.outcome.text(),
            solved.sweeps
        );
        assert_eq!((solved.outcome, &solved.conflicts), (Outcome::Infeasible, &case.planted), "{}", case.name);
    }
}

#[test]
fn plain_iterations_find_it_too() {
    let mut case = grid_with_longer_edges("plain", 5, &[17]);
    case.solver.init().unwrap();
    (0..60).for_each(|_| case.solver.solve(10).unwrap());
    assert_eq!(case.solver.found().unwrap().conflicts, case.planted);
}

#[test]
fn an_unchanged_contradiction_is_told_again_at_once_and_a_change_ends_it() {
    let mut case = grid_with_longer_edges("again", 5, &[17]);
    case.solver.init().unwrap();
    let first = case.solve(&whole());
    assert_eq!((first.outcome, &first.conflicts), (Outcome::Infeasible, &case.planted));
    let (points, found) = (case.solver.points().to_vec(), case.solver.found().unwrap().clone());
    let again = case.solve(&whole());
    assert_eq!((again.outcome, &again.conflicts, again.sweeps), (Outcome::Infeasible, &case.planted, 0));
    assert!(case.solver.points() == points);
    let told = case.solver.found().unwrap();
    assert_eq!((told.largest_violation, told.worst, told.capped), (found.largest_violation, found.worst, found.capped));
    let planted = case.planted[0];
    let target = case.at(12);
    case.solver.set_handle(12, target).unwrap();
    assert_eq!(case.solve(&whole()).outcome, Outcome::Infeasible);
    // What was asked for again is no change.
    case.solver.set_handle(12, target).unwrap();
    assert_eq!(case.solve(&whole()).sweeps, 0);
    // A target, points, or a force that is another: the same is found anew.
    case.solver.set_handle(12, target + 0.1 * DVec3::Z).unwrap();
    let moved = case.solve(&whole());
    assert!(moved.sweeps > 0 && moved.outcome == Outcome::Infeasible && moved.conflicts == case.planted);
    case.solver.set_points(&points).unwrap();
    let put_back = case.solve(&whole());
    assert!(put_back.sweeps > 0 && put_back.outcome == Outcome::Infeasible && put_back.conflicts == case.planted);
    case.solver.add_force(Force::Vertex { force: 0.01 * DVec3::Z, point: 3 }).unwrap();
    let drawn = case.solve(&whole());
    assert!(drawn.sweeps > 0 && drawn.outcome == Outcome::Infeasible && drawn.conflicts == case.planted);
    // Another length, no longer hard, or gone: there is no contradiction any more.
    case.solver.edit_constraint("EdgeLength", planted, &[0.5, 2.0]).unwrap();
    let wide = case.solve(&whole());
    assert!(wide.outcome == Outcome::Converged && wide.conflicts.is_empty(), "{:?}", wide.outcome);
    case.solver.edit_constraint("EdgeLength", planted, &[1.5, 1.6]).unwrap();
    assert_eq!(case.solve(&whole()).conflicts, [planted]);
    case.solver.set_hard(&[planted], false).unwrap();
    let soft = case.solve(&whole());
    assert!(soft.outcome == Outcome::Converged && soft.conflicts.is_empty() && soft.farthest < BOUND);
    case.solver.set_hard(&[planted], true).unwrap();
    assert_eq!(case.solve(&whole()).conflicts, [planted]);
    case.solver.remove_constraint(planted).unwrap();
    assert_eq!(case.solve(&whole()).outcome, Outcome::Converged);
}

#[test]
fn heavy_ones_that_contradict_each_other_throw_no_point_far_away() {
    let mesh = grid(5);
    let all = edges(&mesh);
    let mut case = case_of("heavy", &mesh);
    case.lengths(&all[..20], 0.03, 1e-3);
    case.lengths(&all[20..], 0.03, 1e3);
    case.longer(&[all[25]], 500.0);
    case.solver.init().unwrap();
    let solved = case.solve(&whole());
    println!("heavy: {} sweeps, largest coordinate {} sizes", solved.sweeps, solved.farthest);
    assert_eq!((solved.outcome, &solved.conflicts), (Outcome::Infeasible, &case.planted));
    assert!(solved.farthest < BOUND, "{}", solved.farthest);
}

#[test]
fn the_lightest_set_is_named_whatever_the_priorities() {
    // Two lengths of an edge: the one of lower priority, from nearly equal priorities to very different ones.
    for ratio in [1.01, 2.0, 30.0, 1e4] {
        for lighter in [0, 1] {
            let mut case = case("ratio", &[DVec3::ZERO, DVec3::X], &[[0, 1]]);
            for (k, length) in [1.0, 3.0].into_iter().enumerate() {
                let id = case.length([0, 1], length, if k == lighter { 1.0 } else { ratio });
                if k == lighter {
                    case.planted.push(id);
                }
            }
            case.solver.init().unwrap();
            let solved = case.solve(&whole());
            assert_eq!((solved.outcome, &solved.conflicts), (Outcome::Infeasible, &case.planted), "{ratio}, {lighter}");
        }
    }
}

/// Numbers that are the same everywhere.
struct Random(u64);

impl Random {
    /// One of `0..n`.
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }

    fn one_of(&mut self, values: [f64; 3]) -> f64 {
        values[self.below(3)]
    }
}

#[test]
fn contradictions_planted_at_random_are_named_exactly() {
    let mut random = Random(12345);
    for trial in 0..40 {
        let (n, count) = (4 + random.below(6), 1 + random.below(5));
        let (play, ratio) = (random.one_of([0.005, 0.03, 0.1]), random.one_of([1.1, 2.0, 10.0]));
        let scale = random.one_of([1e-3, 1.0, 1e3]);
        let mut mesh = grid(n);
        mesh.points.iter_mut().for_each(|point| *point *= scale);
        let all = edges(&mesh);
        let mut which: Vec<usize> = (0..count).map(|_| random.below(all.len())).collect();
        which.sort_unstable();
        which.dedup();
        let mut case = case_of("random", &mesh);
        case.lengths(&all, play, ratio);
        case.longer(&which.iter().map(|i| all[*i]).collect::<Vec<_>>(), 1.0);
        for _ in 0..random.below(3) {
            let by = [0.1 * random.below(10) as f64, 0.0, 0.2 * random.below(10) as f64];
            case.drag(random.below(n * n) as u32, scale * DVec3::from(by));
        }
        case.solver.init().unwrap();
        let solved = case.solve(&whole());
        let what = format!("problem {trial}: {n} points a side, play {play}, priorities 1 and {ratio}, scale {scale}");
        assert_eq!((solved.outcome, &solved.conflicts), (Outcome::Infeasible, &case.planted), "{what}");
        assert!(solved.farthest <= BOUND && case.violation() <= 1e-9, "{what}: {}", solved.farthest);
    }
}

/// A ring of sides of 1 with more constraints, all of which the regular polygon meets, and a handle somewhere else.
fn mixed(random: &mut Random) -> Case {
    let n = 3 + random.below(5) as u32;
    let all: Vec<u32> = (0..n).collect();
    let mut case = case("mixed", &polygon(n), &ring(n));
    for edge in ring(n) {
        if random.below(4) > 0 {
            case.length(edge, 1.0, random.one_of([2.0, 3.0, 5.0]));
        }
    }
    let others: [(&str, &[u32], &[f64]); 4] = [
        ("Plane", &all, &[]),
        ("Orientation", &all, &[0.0, 0.0, 1.0]),
        ("RegularPolygon", &all, &[]),
        ("EqualLengths", &ring(n).concat(), &[]),
    ];
    for (type_name, indices, scalars) in others {
        if random.below(2) == 0 {
            case.hard(type_name, indices, random.one_of([2.0, 3.0, 5.0]), scalars);
        }
    }
    let at = case.at(1);
    case.hard("OnPlane", &[1], 2.0, &[at.x, at.y, at.z, 0.0, 0.0, 1.0]);
    case.hard("OnLine", &[1], 2.0, &[at.x, at.y, at.z, 1.0, 0.0, 0.0]);
    case.drag(random.below(n as usize) as u32, DVec3::new(0.3 * random.below(9) as f64, 0.2, 0.1));
    case
}

#[test]
fn among_mixed_types_the_planted_one_is_named_and_without_it_none() {
    let mut random = Random(777);
    for trial in 0..80 {
        let mut twin = mixed(&mut Random(random.0));
        let mut case = mixed(&mut random);
        twin.solver.init().unwrap();
        let solved = twin.solve(&whole());
        assert!(solved.conflicts.is_empty(), "problem {trial}: {:?}", solved.conflicts);
        let at = case.at(0);
        match random.below(3) {
            0 => {
                case.length([0, 1], 1.0, 2.0);
                case.plant("EdgeLength", &[0, 1], 1.0, &[1.7, 1.7]);
            }
            1 => case.plant("OnPlane", &[1], 1.0, &[0.0, 0.0, 0.8, 0.0, 0.0, 1.0]),
            _ => {
                case.hard("OnPlane", &[0], 2.0, &[at.x, at.y, at.z, 1.0, 0.0, 0.0]);
                case.plant("OnLine", &[0], 1.0, &[at.x + 0.7, at.y, at.z, 0.0, 1.0, 0.0]);
            }
        }
        case.solver.init().unwrap();
        let solved = case.solve(&whole());
        let what = format!("problem {trial}, {} sweeps", solved.sweeps);
        assert_eq!((solved.outcome, &solved.conflicts), (Outcome::Infeasible, &case.planted), "{what}");
        // Handles pull from up to two sizes away, a hundred times as hard as the penalty holds at first; degenerate shapes
        // are left before the last digits.
        assert!(
            solved.farthest <= 3.0 * BOUND && case.violation() <= 1e-3,
            "{what}: {:e}, {}",
            case.violation(),
            solved.farthest
        );
    }
}
