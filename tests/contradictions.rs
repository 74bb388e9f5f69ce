//! Contradictions of hard constraints: planted ones are named exactly, and where all can be met none is reported. Each
//! problem prints one line.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::ControlFlow;

use glam::{DQuat, DVec3};
use shapeop::constraints::ConstraintId;
use shapeop::mesh::patterns::{height_field, translation_surface, tri_hex};
use shapeop::mesh::{Mesh, Topology, file};
use shapeop::problem::{FairnessRows, Force, Objective};
use shapeop::solver::{Outcome, SolveOptions, Solver};

/// Sweeps before the search for a contradiction, at most.
const RECOGNISED: u32 = 300;

/// How far points may come from the middle of the model, in its sizes.
const BOUND: f64 = 3.0;

/// A problem, and the constraints without which all others can be met.
struct Case {
    name: &'static str,
    solver: Solver,
    planted: Vec<ConstraintId>,
}

/// What solving it came to.
struct Solved {
    outcome: Outcome,
    conflicts: Vec<ConstraintId>,
    sweeps: u32,
    search_sweeps: u32,
    /// The largest distance of a point from the middle at any sweep, in model sizes.
    farthest: f64,
    calls: u32,
}

fn case(name: &'static str, points: &[DVec3], edges: &[[u32; 2]]) -> Case {
    let mut solver = Solver::new();
    solver.set_points(points).unwrap();
    let rows = FairnessRows::laplacian(points.len(), edges);
    solver.set_objective(&Objective::default(), rows).unwrap();
    Case { name, solver, planted: Vec::new() }
}

fn case_of(name: &'static str, mesh: &Mesh) -> Case {
    case(name, &mesh.points, &edges(mesh))
}

impl Case {
    /// A hard constraint; no scalars: those at rest.
    fn hard(&mut self, type_name: &str, indices: &[u32], priority: f64, scalars: &[f64]) -> ConstraintId {
        let id = self.solver.add_constraint(type_name, indices, priority).unwrap();
        if !scalars.is_empty() {
            self.solver.edit_constraint(type_name, id, scalars).unwrap();
        }
        self.solver.set_hard(&[id], true).unwrap();
        id
    }

    fn plant(&mut self, type_name: &str, indices: &[u32], priority: f64, scalars: &[f64]) {
        let id = self.hard(type_name, indices, priority, scalars);
        self.planted.push(id);
    }

    fn length(&mut self, edge: [u32; 2], length: f64, priority: f64) -> ConstraintId {
        self.hard("EdgeLength", &edge, priority, &[length, length])
    }

    /// Edges of length 1.
    fn sides(&mut self, edges: &[[u32; 2]], priority: f64) {
        for edge in edges {
            self.length(*edge, 1.0, priority);
        }
    }

    /// All edges within `play` of their lengths.
    fn lengths(&mut self, edges: &[[u32; 2]], play: f64, priority: f64) {
        for [a, b] in edges {
            let length = self.at(*a).distance(self.at(*b));
            self.hard("EdgeLength", &[*a, *b], priority, &[(1.0 - play) * length, (1.0 + play) * length]);
        }
    }

    fn on_faces(&mut self, mesh: &Mesh, type_name: &str, scalars: &[f64]) {
        for face in &mesh.faces {
            self.hard(type_name, face, 1.0, scalars);
        }
    }

    /// Edges that are to be half as long again, at a lower priority than the others.
    fn longer(&mut self, edges: &[[u32; 2]], priority: f64) {
        for [a, b] in edges {
            let length = self.at(*a).distance(self.at(*b));
            self.plant("EdgeLength", &[*a, *b], priority, &[1.5 * length, 1.6 * length]);
        }
    }

    fn hold(&mut self, points: &[u32]) {
        points.iter().for_each(|&point| self.drag(point, DVec3::ZERO));
    }

    fn drag(&mut self, point: u32, by: DVec3) {
        let to = self.at(point) + by;
        self.solver.set_handle(point, to).unwrap();
    }

    fn at(&self, point: u32) -> DVec3 {
        self.solver.points()[point as usize]
    }

    /// Solves in calls with these options until one does not end for want of sweeps or time.
    fn solve(&mut self, options: &SolveOptions) -> Solved {
        let (middle, size) = extent(self.solver.points());
        let mut solved = Solved {
            outcome: Outcome::IterationLimit,
            conflicts: Vec::new(),
            sweeps: 0,
            search_sweeps: 0,
            farthest: 0.0,
            calls: 0,
        };
        let farthest = |points: &[DVec3]| points.iter().map(|p| p.distance(middle) / size).fold(0.0, f64::max);
        while solved.sweeps < 3000 && solved.calls < 100_000 {
            let mut seen = 0.0_f64;
            let report = self.solver.solve_until(options, &mut |now| {
                seen = seen.max(farthest(now.solver.points()));
                ControlFlow::Continue(())
            });
            let report = report.unwrap();
            let found = self.solver.found().unwrap();
            assert!(found.sweeps <= options.max_iterations && found.search_sweeps <= found.sweeps, "{}", self.name);
            assert!(report.outcome != Outcome::Converged || found.is_solution, "{}: {found:?}", self.name);
            solved.calls += 1;
            solved.outcome = report.outcome;
            solved.conflicts.clone_from(&found.conflicts);
            solved.sweeps += found.sweeps;
            solved.search_sweeps += found.search_sweeps;
            solved.farthest = solved.farthest.max(seen).max(farthest(self.solver.points()));
            if !matches!(report.outcome, Outcome::IterationLimit | Outcome::TimeBudget) {
                break;
            }
        }
        solved
    }

    /// The largest violation of a hard constraint that is not planted, lengths over the mean extent.
    fn violation(&self) -> f64 {
        let hard = |id: &ConstraintId| self.solver.constraint(*id).is_some_and(|view| view.is_hard);
        let ids: Vec<ConstraintId> = (0..self.solver.constraint_count()).filter(hard).collect();
        let extents = ids.iter().map(|id| {
            let view = self.solver.constraint(*id).unwrap();
            let first = self.at(view.indices[0]);
            view.indices.iter().map(|i| self.at(*i).distance(first)).fold(0.0, f64::max)
        });
        let (sum, count) = extents.filter(|e| *e > 0.0).fold((0.0, 0.0), |(sum, n), e| (sum + e, n + 1.0));
        let mean = if count > 0.0 { sum / count } else { 1.0 };
        let violations = self.solver.violations();
        ids.iter().filter(|id| !self.planted.contains(id)).map(|id| violations[*id]).fold(0.0, f64::max) / mean
    }
}

/// The middle of the bounding box and its diagonal.
fn extent(points: &[DVec3]) -> (DVec3, f64) {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    (0.5 * (low + high), low.distance(high))
}

fn edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    Topology::new(mesh).unwrap().edges().to_vec()
}

/// A flat grid of `n × n` points 1 apart, a little wavy so that it knows where to fold.
fn grid(n: usize) -> Mesh {
    let last = (n - 1) as f64;
    height_field(n, n, [0.0, last], [0.0, last], |x, y| 0.1 * (x + 0.5 * y).sin()).unwrap()
}

/// The corners of a regular polygon of `n` sides of length 1.
fn polygon(n: u32) -> Vec<DVec3> {
    let radius = 0.5 / (PI / f64::from(n)).sin();
    let corner = |k: u32| DQuat::from_rotation_z(TAU * f64::from(k) / f64::from(n)) * (radius * DVec3::X);
    (0..n).map(corner).collect()
}

fn ring(n: u32) -> Vec<[u32; 2]> {
    (0..n).map(|i| [i, (i + 1) % n]).collect()
}

/// A grid whose edges keep their lengths within 3 %, with some that are to be half as long again.
fn grid_with_longer_edges(name: &'static str, n: usize, which: &[usize]) -> Case {
    let mesh = grid(n);
    let all = edges(&mesh);
    let mut case = case_of(name, &mesh);
    case.lengths(&all, 0.03, 2.0);
    case.longer(&which.iter().map(|i| all[*i]).collect::<Vec<_>>(), 1.0);
    case
}

fn infeasible() -> Vec<Case> {
    let mut cases = vec![
        grid_with_longer_edges("grid of 9, 1 edge", 9, &[40]),
        grid_with_longer_edges("grid of 9, 4 edges", 9, &[5, 47, 88, 130]),
        grid_with_longer_edges("grid of 11, 8 edges", 11, &[3, 30, 61, 92, 120, 151, 180, 210]),
        grid_with_longer_edges("grid of 15, 2 edges", 15, &[100, 311]),
    ];
    let mut dragged = grid_with_longer_edges("grid of 5 with a handle", 5, &[17]);
    dragged.drag(12, 2.0 * DVec3::Z);
    cases.push(dragged);
    // Shorter sides that weigh more: the long one is longer than both together.
    let mut triangle = case("triangle of 1, 1 and 3", &polygon(3), &ring(3));
    triangle.sides(&ring(3)[..2], 2.0);
    triangle.plant("EdgeLength", &[2, 0], 1.0, &[3.0, 3.0]);
    cases.push(triangle);
    // A square of side 1 in a level plane is not in an upright one.
    let square = polygon(4);
    let mut upright = case("regular, level and upright", &square, &ring(4));
    upright.hard("RegularPolygon", &[0, 1, 2, 3], 2.0, &[]);
    upright.hard("Orientation", &[0, 1, 2, 3], 2.0, &[0.0, 0.0, 1.0]);
    upright.sides(&ring(4), 2.0);
    upright.plant("Orientation", &[0, 1, 2, 3], 1.0, &[1.0, 0.0, 0.0]);
    cases.push(upright);
    // A line one above the plane, and parallel to it.
    let mesh = grid(3);
    let mut parallel = case_of("on a plane and a line beside it", &mesh);
    parallel.lengths(&edges(&mesh), 0.1, 2.0);
    parallel.hard("OnPlane", &[4], 2.0, &[0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    parallel.plant("OnLine", &[4], 1.0, &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    cases.push(parallel);
    let mut equal = case("equal lengths of 1 and 2", &polygon(4), &ring(4));
    equal.length([0, 1], 1.0, 2.0);
    equal.length([2, 3], 2.0, 2.0);
    equal.plant("EqualLengths", &[0, 1, 2, 3], 1.0, &[]);
    cases.push(equal);
    // Three sides of 1: every angle is 60°.
    let mut angle = case("angle of a triangle of lengths", &polygon(3), &ring(3));
    angle.sides(&ring(3), 2.0);
    angle.plant("BoundedAngle", &[0, 1, 2], 1.0, &[FRAC_PI_2, 0.75 * PI]);
    cases.push(angle);
    // Seven sides of 1 do not reach round one of 9.
    let mut closed = case("a ring that cannot close", &polygon(8), &ring(8));
    closed.sides(&ring(8)[..7], 2.0);
    closed.plant("EdgeLength", &[7, 0], 1.0, &[9.0, 9.0]);
    cases.push(closed);
    // The one that was there first gives way to a heavier one.
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from);
    let mut heavier = case("a heavier edge wins", &square, &ring(4));
    heavier.plant("EdgeLength", &[0, 1], 1.0, &[1.0, 1.0]);
    heavier.sides(&ring(4)[1..], 1.0);
    heavier.length([0, 1], 1.5, 3.0);
    cases.push(heavier);
    // A single heavy edge given up would do: the other three reach just as far as the planted one is long.
    let mut lighter = case("a lighter edge loses", &square, &ring(4));
    lighter.sides(&ring(4), 2.0);
    lighter.plant("EdgeLength", &[0, 1], 1.0, &[3.0, 3.0]);
    cases.push(lighter);
    cases.iter_mut().for_each(|case| case.solver.init().unwrap());
    cases
}

fn feasible() -> Vec<Case> {
    let mut cases = Vec::new();
    // Fig. 12 of Deng et al. 2015.
    let mesh = translation_surface(11).unwrap();
    let all = edges(&mesh);
    let mean = all.iter().map(|[a, b]| mesh.points[*a as usize].distance(mesh.points[*b as usize])).sum::<f64>()
        / all.len() as f64;
    let mut surface = case_of("surface of Fig. 12", &mesh);
    surface.on_faces(&mesh, "DiagonalDistance", &[0.01 * mean]);
    let on_boundary = Topology::new(&mesh).unwrap().boundary_points();
    let boundary: Vec<u32> = (0..).zip(on_boundary).filter(|(_, is_on)| *is_on).map(|(i, _)| i).collect();
    surface.hold(&boundary);
    surface.drag(60, mean * DVec3::Z);
    cases.push(surface);
    let mut twice = case_of("every plane twice", &mesh);
    twice.on_faces(&mesh, "Plane", &[]);
    twice.on_faces(&mesh, "Plane", &[]);
    twice.hold(&[0, 10, 110, 120]);
    twice.drag(60, 2.0 * DVec3::Z);
    cases.push(twice);
    let mesh = file::read("examples/meshes/hypar.obj").unwrap();
    let mut hypar = case_of("hypar with planes", &mesh);
    hypar.on_faces(&mesh, "Plane", &[]);
    cases.push(hypar);
    let mesh = tri_hex(4, 4, 1.0).unwrap();
    let mut hexagons = case_of("regular hexagons and triangles", &mesh);
    hexagons.on_faces(&mesh, "Plane", &[]);
    hexagons.on_faces(&mesh, "RegularPolygon", &[]);
    hexagons.drag(0, DVec3::new(-1.0, -0.5, 1.5));
    cases.push(hexagons);
    // Equal lengths follow from lengths, and right angles of a parallelogram from those of a rectangle.
    let mesh = grid(4);
    let mut dependent = case_of("constraints that follow from others", &mesh);
    let all = edges(&mesh);
    for [a, b] in &all {
        dependent.length([*a, *b], 1.0, 1.0);
    }
    dependent.hard("EqualLengths", &all.concat(), 1.0, &[]);
    dependent.drag(0, DVec3::new(0.5, 0.5, 1.0));
    cases.push(dependent);
    let mesh = grid(7);
    let mut tight = case_of("lengths within 0.1 %", &mesh);
    tight.lengths(&edges(&mesh), 0.001, 1.0);
    tight.hold(&[0, 6]);
    tight.drag(45, DVec3::new(0.0, -2.0, 2.0));
    cases.push(tight);
    let chain: Vec<DVec3> = (0..12).map(|i| DVec3::new(f64::from(i), 0.0, 0.0)).collect();
    let links: Vec<[u32; 2]> = (0..11).map(|i| [i, i + 1]).collect();
    let mut far = case("a handle far away", &chain, &links);
    far.lengths(&links, 0.0, 1.0);
    far.hold(&[0]);
    far.drag(11, DVec3::new(-20.0, 100.0, 30.0));
    cases.push(far);
    let mesh = grid(6);
    let mut folded = case_of("a corner drawn to the other side", &mesh);
    folded.lengths(&edges(&mesh), 0.03, 1.0);
    folded.hold(&[35]);
    folded.drag(0, DVec3::new(4.5, 4.5, 1.0));
    cases.push(folded);
    let mesh = grid(5);
    let mut bent = case_of("angles and lengths", &mesh);
    bent.lengths(&edges(&mesh), 0.05, 1.0);
    for face in &mesh.faces {
        for k in 0..4 {
            let [apex, next, last] = [face[k], face[(k + 1) % 4], face[(k + 3) % 4]];
            bent.hard("BoundedAngle", &[apex, next, last], 1.0, &[75f64.to_radians(), 105f64.to_radians()]);
        }
    }
    bent.hold(&[0]);
    bent.drag(24, DVec3::new(-0.5, -0.5, 1.5));
    cases.push(bent);
    // Rigid panels hinged in a row, turned by a half.
    let mesh = height_field(6, 2, [0.0, 5.0], [0.0, 1.0], |_, _| 0.0).unwrap();
    let mut hinged = case_of("rigid panels on hinges", &mesh);
    hinged.on_faces(&mesh, "Rigid", &[]);
    hinged.hold(&[0, 6]);
    let turned = DQuat::from_rotation_y(-PI) * hinged.at(5) - hinged.at(5);
    hinged.drag(5, 0.8 * turned + DVec3::Z);
    cases.push(hinged);
    cases.iter_mut().for_each(|case| case.solver.init().unwrap());
    cases
}

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
        // Degenerate shapes are left before the last digits.
        assert!(solved.farthest <= BOUND && case.violation() <= 1e-3, "{what}: {:e}", case.violation());
    }
}
