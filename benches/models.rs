//! The six problems that speed is measured on: `n × n` grids on a wavy sheet, or a block of tetrahedra.

use glam::DVec3;
use shapeop::constraints::NewConstraints;
use shapeop::problem::Force;
use shapeop::solver::Solver;

/// Constraints of one type, as many as there are.
#[derive(Debug)]
pub struct Group {
    /// The type.
    pub type_name: &'static str,
    /// Point indices behind each other.
    pub indices: Vec<u32>,
    /// Indices of each constraint.
    pub counts: Vec<usize>,
    /// One weight for all.
    pub weight: f64,
    /// One set for all, or one per constraint.
    pub scalars: Vec<f64>,
    /// Scalars of each set; empty: the defaults.
    pub scalar_counts: Vec<usize>,
}

/// A problem as data.
#[derive(Debug)]
pub struct Model {
    /// Where the points are when the constraints are added.
    pub points: Vec<DVec3>,
    /// The constraints, in the order of their ids.
    pub groups: Vec<Group>,
    /// The same force on all points, as an acceleration.
    pub gravity: DVec3,
    /// Mass, damping and time step; none for a static problem.
    pub dynamics: Option<[f64; 3]>,
}

/// Their names.
pub const NAMES: [&str; 7] = ["planar_quads", "cloth", "squares", "shell", "tets", "circles", "quad_circles"];

/// A number in `[-½, ½)` that `i` alone decides: the same model on every run and in every language.
fn noise(i: u32) -> f64 {
    f64::from(i.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24) - 0.5
}

/// A wavy grid of `n × n` vertices over the unit square, with noise of a tenth of its spacing.
fn sheet(n: u32) -> Vec<DVec3> {
    let spacing = 1.0 / f64::from(n);
    let vertex = |i: u32| {
        let (x, y) = (f64::from(i % n) * spacing, f64::from(i / n) * spacing);
        let bump = 0.2 * spacing * DVec3::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2));
        DVec3::new(x, y, 0.15 * (3.0 * x).sin() * (2.0 * y).cos()) + bump
    };
    (0..n * n).map(vertex).collect()
}

fn quads(n: u32) -> Vec<u32> {
    let corners = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| row * n + column));
    corners.flat_map(|corner| [corner, corner + 1, corner + n + 1, corner + n]).collect()
}

/// Edges along rows, along columns and, if asked for, along one diagonal of each quad.
fn edges(n: u32, with_diagonals: bool) -> Vec<u32> {
    let mut edges = Vec::new();
    for i in 0..n * n {
        let (column, row) = (i % n, i / n);
        if column + 1 < n {
            edges.extend([i, i + 1]);
        }
        if row + 1 < n {
            edges.extend([i, i + n]);
        }
        if with_diagonals && column + 1 < n && row + 1 < n {
            edges.extend([i, i + n + 1]);
        }
    }
    edges
}

/// The two triangles at each inner edge of the triangulated grid: the edge's ends, then the two opposite vertices.
fn hinges(n: u32) -> Vec<u32> {
    let mut hinges = Vec::new();
    for row in 0..n {
        for column in 0..n {
            let i = row * n + column;
            if column + 1 < n && row + 1 < n {
                hinges.extend([i, i + n + 1, i + 1, i + n]);
            }
            if column + 1 < n && row > 0 && row + 1 < n {
                hinges.extend([i, i + 1, i - n, i + n + 1]);
            }
            if row + 1 < n && column > 0 && column + 1 < n {
                hinges.extend([i, i + n, i - 1, i + n + 1]);
            }
        }
    }
    hinges
}

fn group(type_name: &'static str, arity: usize, indices: Vec<u32>, weight: f64) -> Group {
    let counts = vec![arity; indices.len() / arity];
    Group { type_name, indices, counts, weight, scalars: Vec::new(), scalar_counts: Vec::new() }
}

fn with_scalars(group: Group, scalars: &[f64]) -> Group {
    Group { scalars: scalars.to_vec(), scalar_counts: vec![scalars.len()], ..group }
}

/// The model `name` with about `vertex_count` vertices.
pub fn model(name: &str, vertex_count: u32) -> Option<Model> {
    let n = f64::from(vertex_count).sqrt().round().max(3.0) as u32;
    let points = sheet(n);
    let corners = vec![0, n - 1, n * (n - 1), n * n - 1];
    let none = DVec3::ZERO;
    let still = |groups| Model { points: points.clone(), groups, gravity: none, dynamics: None };
    Some(match name {
        "planar_quads" => {
            still(vec![group("Plane", 4, quads(n), 1.0), group("Closeness", 1, (0..n * n).collect(), 0.05)])
        }
        "squares" => {
            let unit = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
            still(vec![
                with_scalars(group("Similarity", 4, quads(n), 1.0), &unit),
                group("Closeness", 1, corners, 10.0),
            ])
        }
        // Quads of size 1: libShapeOp takes small ones for straight, by an absolute bound, and only planarises them.
        "quad_circles" => Model {
            points: points.iter().map(|point| *point * f64::from(n)).collect(),
            ..still(vec![group("Circle", 4, quads(n), 1.0), group("Closeness", 1, (0..n * n).collect(), 0.05)])
        },
        "circles" => {
            let mut lines: Vec<u32> = (0..n * n).collect();
            lines.extend((0..n).flat_map(|column| (0..n).map(move |row| row * n + column)));
            still(vec![
                group("Circle", 4, quads(n), 1.0),
                group("Circle", n as usize, lines, 1.0),
                group("Closeness", 1, (0..n * n).collect(), 0.05),
            ])
        }
        "cloth" => Model {
            groups: vec![
                group("EdgeStrain", 2, edges(n, true), 1.0),
                group("Bending", 4, hinges(n), 0.01),
                group("Closeness", 1, corners[..3].to_vec(), 100.0),
            ],
            gravity: DVec3::new(0.0, 0.0, -1.0),
            dynamics: Some([1.0, 0.99, 0.02]),
            points,
        },
        "shell" => {
            let angles = quads(n)
                .chunks_exact(4)
                .flat_map(|quad| {
                    (0..4).flat_map(|i| [quad[i], quad[(i + 1) % 4], quad[(i + 3) % 4]]).collect::<Vec<_>>()
                })
                .collect();
            let inner = (1..n - 1).flat_map(|row| (1..n - 1).map(move |column| row * n + column));
            let stencils = inner.flat_map(|i| [i, i - 1, i + 1, i - n, i + n]).collect();
            let range = [80_f64.to_radians(), 110_f64.to_radians()];
            Model {
                groups: vec![
                    group("EdgeStrain", 2, edges(n, false), 1.0),
                    group("Plane", 4, quads(n), 1.0),
                    with_scalars(group("Angle", 3, angles, 0.1), &range),
                    group("LaplacianDisplacement", 5, stencils, 0.1),
                    group("Closeness", 1, corners, 100.0),
                ],
                gravity: DVec3::new(0.0, 0.0, 0.1),
                dynamics: Some([1.0, 0.99, 0.02]),
                points,
            }
        }
        "tets" => {
            let n = f64::from(vertex_count).cbrt().round().max(2.0) as u32;
            let at = |x: u32, y: u32, z: u32| (z * n + y) * n + x;
            let mut tetrahedra = Vec::new();
            for z in 0..n - 1 {
                for y in 0..n - 1 {
                    for x in 0..n - 1 {
                        let c = |i: u32| at(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
                        // The six tetrahedra around the diagonal from corner 0 to corner 7.
                        for [a, b] in [[1, 3], [3, 2], [2, 6], [6, 4], [4, 5], [5, 1]] {
                            tetrahedra.extend([c(0), c(a), c(b), c(7)]);
                        }
                    }
                }
            }
            let spacing = 1.0 / f64::from(n);
            let points: Vec<DVec3> = (0..n * n * n)
                .map(|i| {
                    let bump = 0.2 * DVec3::new(noise(3 * i), noise(3 * i + 1), noise(3 * i + 2));
                    (DVec3::new(f64::from(i % n), f64::from(i / n % n), f64::from(i / n / n)) + bump) * spacing
                })
                .collect();
            let faces: Vec<u32> = (0..n * n * n).filter(|i| i % n == 0 || i % n == n - 1).collect();
            let targets = faces.iter().flat_map(|&i| {
                let pull = if i % n == 0 { -0.15 } else { 0.15 };
                (points[i as usize] + DVec3::X * pull).to_array()
            });
            let anchors = Group {
                scalars: targets.collect(),
                scalar_counts: vec![3; faces.len()],
                ..group("Closeness", 1, faces, 1.0)
            };
            let range = [0.95, 1.05];
            // Weights that keep the balance of a block of unit spacing: tetrahedra by 1/spacing.
            let groups = vec![
                with_scalars(group("TetrahedronStrain", 4, tetrahedra.clone(), 1.0 / spacing), &range),
                with_scalars(group("Volume", 4, tetrahedra, 1.0 / spacing), &range),
                anchors,
            ];
            Model { points, groups, gravity: none, dynamics: None }
        }
        _ => return None,
    })
}

impl Model {
    /// A solver with the model's points, constraints and forces, not yet initialised.
    ///
    /// # Errors
    /// As [`Solver::add_constraints`].
    pub fn solver(&self) -> Result<Solver, shapeop::error::Error> {
        let mut solver = Solver::new();
        solver.set_points(&self.points)?;
        for group in &self.groups {
            solver.add_constraints(NewConstraints {
                type_name: group.type_name,
                indices: &group.indices,
                counts: &group.counts,
                weights: &[group.weight],
                scalars: &group.scalars,
                scalar_counts: &group.scalar_counts,
            })?;
        }
        if self.gravity != DVec3::ZERO {
            solver.add_force(Force::Gravity(self.gravity))?;
        }
        Ok(solver)
    }

    /// Initialises in the model's mode.
    ///
    /// # Errors
    /// As the solver's own.
    pub fn init(&self, solver: &mut Solver) -> Result<(), shapeop::error::Error> {
        match self.dynamics {
            Some([mass, damping, timestep]) => solver.init_dynamic(mass, damping, timestep),
            None => solver.init(),
        }
    }
}
