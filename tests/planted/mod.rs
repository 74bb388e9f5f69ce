//! Problems with contradictions planted in them, and problems in which all hard constraints can be met.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::ControlFlow;

use glam::{DQuat, DVec3};
use shapeop::constraints::ConstraintId;
use shapeop::mesh::patterns::{height_field, translation_surface, tri_hex};
use shapeop::mesh::{Mesh, Topology, file};
use shapeop::problem::{FairnessRows, Objective};
use shapeop::solver::{Outcome, SolveOptions, Solver};

/// A problem, and the constraints without which all others can be met.
pub struct Case {
    pub name: &'static str,
    pub solver: Solver,
    pub planted: Vec<ConstraintId>,
}

/// What solving it came to.
pub struct Solved {
    pub outcome: Outcome,
    pub conflicts: Vec<ConstraintId>,
    pub sweeps: u32,
    pub search_sweeps: u32,
    /// The largest distance of a point from the middle at any sweep, in model sizes.
    pub farthest: f64,
    pub calls: u32,
}

pub fn case(name: &'static str, points: &[DVec3], edges: &[[u32; 2]]) -> Case {
    let mut solver = Solver::new();
    solver.set_points(points).unwrap();
    let rows = FairnessRows::laplacian(points.len(), edges);
    solver.set_objective(&Objective::default(), rows).unwrap();
    Case { name, solver, planted: Vec::new() }
}

pub fn case_of(name: &'static str, mesh: &Mesh) -> Case {
    case(name, &mesh.points, &edges(mesh))
}

impl Case {
    /// A hard constraint; no scalars: those at rest.
    pub fn hard(&mut self, type_name: &str, indices: &[u32], priority: f64, scalars: &[f64]) -> ConstraintId {
        let id = self.solver.add_constraint(type_name, indices, priority).unwrap();
        if !scalars.is_empty() {
            self.solver.edit_constraint(type_name, id, scalars).unwrap();
        }
        self.solver.set_hard(&[id], true).unwrap();
        id
    }

    pub fn plant(&mut self, type_name: &str, indices: &[u32], priority: f64, scalars: &[f64]) {
        let id = self.hard(type_name, indices, priority, scalars);
        self.planted.push(id);
    }

    pub fn length(&mut self, edge: [u32; 2], length: f64, priority: f64) -> ConstraintId {
        self.hard("EdgeLength", &edge, priority, &[length, length])
    }

    /// Edges of length 1.
    pub fn sides(&mut self, edges: &[[u32; 2]], priority: f64) {
        for edge in edges {
            self.length(*edge, 1.0, priority);
        }
    }

    /// All edges within `play` of their lengths.
    pub fn lengths(&mut self, edges: &[[u32; 2]], play: f64, priority: f64) {
        for [a, b] in edges {
            let length = self.at(*a).distance(self.at(*b));
            self.hard("EdgeLength", &[*a, *b], priority, &[(1.0 - play) * length, (1.0 + play) * length]);
        }
    }

    pub fn on_faces(&mut self, mesh: &Mesh, type_name: &str, scalars: &[f64]) {
        for face in &mesh.faces {
            self.hard(type_name, face, 1.0, scalars);
        }
    }

    /// Edges that are to be half as long again, at a lower priority than the others.
    pub fn longer(&mut self, edges: &[[u32; 2]], priority: f64) {
        for [a, b] in edges {
            let length = self.at(*a).distance(self.at(*b));
            self.plant("EdgeLength", &[*a, *b], priority, &[1.5 * length, 1.6 * length]);
        }
    }

    pub fn hold(&mut self, points: &[u32]) {
        points.iter().for_each(|&point| self.drag(point, DVec3::ZERO));
    }

    pub fn drag(&mut self, point: u32, by: DVec3) {
        let to = self.at(point) + by;
        self.solver.set_handle(point, to).unwrap();
    }

    pub fn at(&self, point: u32) -> DVec3 {
        self.solver.points()[point as usize]
    }

    /// Solves in calls with these options until one does not end for want of sweeps or time.
    pub fn solve(&mut self, options: &SolveOptions) -> Solved {
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
    pub fn violation(&self) -> f64 {
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
pub fn extent(points: &[DVec3]) -> (DVec3, f64) {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    (0.5 * (low + high), low.distance(high))
}

pub fn edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    Topology::new(mesh).unwrap().edges().to_vec()
}

/// A flat grid of `n × n` points 1 apart, a little wavy so that it knows where to fold.
pub fn grid(n: usize) -> Mesh {
    let last = (n - 1) as f64;
    height_field(n, n, [0.0, last], [0.0, last], |x, y| 0.1 * (x + 0.5 * y).sin()).unwrap()
}

/// The corners of a regular polygon of `n` sides of length 1.
pub fn polygon(n: u32) -> Vec<DVec3> {
    let radius = 0.5 / (PI / f64::from(n)).sin();
    let corner = |k: u32| DQuat::from_rotation_z(TAU * f64::from(k) / f64::from(n)) * (radius * DVec3::X);
    (0..n).map(corner).collect()
}

pub fn ring(n: u32) -> Vec<[u32; 2]> {
    (0..n).map(|i| [i, (i + 1) % n]).collect()
}

/// A grid whose edges keep their lengths within 3 %, with some that are to be half as long again.
pub fn grid_with_longer_edges(name: &'static str, n: usize, which: &[usize]) -> Case {
    let mesh = grid(n);
    let all = edges(&mesh);
    let mut case = case_of(name, &mesh);
    case.lengths(&all, 0.03, 2.0);
    case.longer(&which.iter().map(|i| all[*i]).collect::<Vec<_>>(), 1.0);
    case
}

pub fn infeasible() -> Vec<Case> {
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

pub fn feasible() -> Vec<Case> {
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
