//! Writes the problem files of this folder: `cargo run --example write_problems [FOLDER]`.
//!
//! `circularize.json` and `regularize.json` are recipes on meshes of `examples/meshes`. `hanging_cloth.json` is a cloth
//! under gravity, held at three points; before the first time step these are pulled far apart at once, and let back later
//! (after Deuss et al. 2015, figure 4). Look at them with `shapeop solve examples/hanging_cloth.json`.
//!
//! `explore.json` is a roof of planar quads held at its corners, `explore_moves.json` a drag of its middle:
//! `shapeop explore examples/explore.json --handles examples/explore_moves.json`.

use std::error::Error;
use std::path::Path;

use glam::DVec3;
use shapeop::mesh::patterns::translation_surface;
use shapeop::mesh::{Mesh, Topology, file};
use shapeop::problem::recipes::{self, RecipeOptions};
use shapeop::problem::{Edit, ForceKind, ForceSignature, Handle, Mode, Objective, Problem, Settings, Signature};

/// Squares along a side of the cloth.
pub(crate) const SQUARES: u32 = 14;

/// Side of a square, in metres.
pub(crate) const SPACING: f64 = 0.1;

/// How many times farther from the middle of the cloth the anchors are pulled.
const PULL: f64 = 4.0;

/// The time step before which the anchors are let back.
const RELEASE: u32 = 41;

/// Points along a side of the roof.
const ROOF: u32 = 13;

/// Frames of the drag that move the middle; one more lets a corner go.
const MOVES: u32 = 11;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/examples").to_owned());
    for (name, problem) in problems()? {
        let path = Path::new(&folder).join(name);
        file::write_whole(&path, problem.to_json().as_bytes())?;
        println!("{}", path.display());
    }
    file::write_whole(&Path::new(&folder).join("explore_moves.json"), explore_moves()?.as_bytes())?;
    Ok(())
}

/// The problems by name.
pub(crate) fn problems() -> Result<[(&'static str, Problem); 4], shapeop::error::Error> {
    let mesh = |name: &str| file::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/meshes").join(name));
    let options = RecipeOptions { closeness: 0.01, ..RecipeOptions::default() };
    Ok([
        ("circularize.json", recipes::circularize(&mesh("tubemesh.obj")?, &options)?),
        ("regularize.json", recipes::regularize(&mesh("hex_mesh_welded.obj")?, &options)?),
        ("hanging_cloth.json", hanging_cloth(PULL)?),
        ("explore.json", explore()?),
    ])
}

/// A roof of quads that are planar and stay so, each drawn a little towards a square, held at the corners.
fn explore() -> Result<Problem, shapeop::error::Error> {
    let mesh = translation_surface(ROOF as usize)?;
    let on_each = |type_name: &str, weight: f64, hard: bool| -> Vec<Signature> {
        let one = |face: &Vec<u32>| Signature {
            type_name: type_name.to_owned(),
            indices: face.clone(),
            weight,
            scalars: None,
            hard,
        };
        mesh.faces.iter().map(one).collect()
    };
    let corners = [0, ROOF - 1, ROOF * (ROOF - 1), ROOF * ROOF - 1];
    Ok(Problem {
        points: mesh.points.iter().map(DVec3::to_array).collect(),
        constraints: [on_each("Plane", 1.0, true), on_each("RegularPolygon", 0.02, false)].concat(),
        objective: Some(Objective { tolerance: 1e-9, ..Objective::default() }),
        handles: corners.map(|point| Handle { point, target: mesh.points[point as usize].to_array() }).to_vec(),
        faces: mesh.faces,
        ..Problem::default()
    })
}

/// The middle is drawn up and aside; at last a corner is let go.
pub(crate) fn explore_moves() -> Result<String, shapeop::error::Error> {
    let middle = ROOF * ROOF / 2;
    let home = translation_surface(ROOF as usize)?.points[middle as usize];
    let mut frames: Vec<String> = (1..=MOVES)
        .map(|frame| {
            let share = f64::from(frame) / f64::from(MOVES);
            let [x, y, z] = (home + share * DVec3::new(0.5, 0.25, 1.25)).to_array();
            format!("    {{\"handles\": [{{\"point\": {middle}, \"target\": [{x:.4}, {y:.4}, {z:.4}]}}]}}")
        })
        .collect();
    frames.push("    {\"releases\": [0]}".to_owned());
    Ok(format!("{{\n  \"version\": 1,\n  \"frames\": [\n{}\n  ]\n}}\n", frames.join(",\n")))
}

/// A square cloth of triangles: EdgeStrain on its edges, Bending over the inner ones, a Closeness for each anchor.
/// Units: metre, kilogram, second.
pub(crate) fn hanging_cloth(pull: f64) -> Result<Problem, shapeop::error::Error> {
    let row = SQUARES + 1;
    let points = (0..row * row).map(|i| SPACING * DVec3::new(f64::from(i % row), f64::from(i / row), 0.0));
    let mesh = Mesh { points: points.collect(), faces: (0..SQUARES * SQUARES).flat_map(triangles).collect() };
    let topology = Topology::new(&mesh)?;
    let constraint = |type_name: &str, indices: Vec<u32>, weight: f64| Signature {
        type_name: type_name.to_owned(),
        indices,
        weight,
        scalars: None,
        hard: false,
    };
    let mut constraints = Vec::new();
    for (i, &[a, b]) in topology.edges().iter().enumerate() {
        // The force in newton at which an edge would be twice as long.
        constraints.push(constraint("EdgeStrain", vec![a, b], 300.0));
        let opposite = |face: u32| mesh.faces[face as usize].iter().copied().find(|&point| point != a && point != b);
        if let [c, d] = topology.faces_at(i).filter_map(opposite).collect::<Vec<u32>>()[..] {
            constraints.push(constraint("Bending", vec![a, b, c, d], 0.01));
        }
    }
    let middle = 0.5 * SPACING * f64::from(SQUARES) * DVec3::new(1.0, 1.0, 0.0);
    let mut edits = Vec::new();
    for anchor in [0, SQUARES, SQUARES * row + SQUARES / 2] {
        let number = constraints.len() as u32;
        constraints.push(constraint("Closeness", vec![anchor], 1e5));
        let home = mesh.points[anchor as usize];
        let edit =
            |before_step: u32, at: DVec3| Edit { before_step, constraint: number, scalars: at.to_array().to_vec() };
        edits.extend([edit(1, middle + pull * (home - middle)), edit(RELEASE, home)]);
    }
    edits.sort_by_key(|edit| edit.before_step);
    Ok(Problem {
        mode: Mode::Dynamic,
        masses: 0.01,
        damping: 0.95,
        timestep: 0.04,
        points: mesh.points.iter().map(DVec3::to_array).collect(),
        constraints,
        forces: vec![ForceSignature {
            kind: ForceKind::Gravity,
            force: Some([0.0, 0.0, -9.81]),
            id: None,
            magnitude: None,
            faces: Vec::new(),
        }],
        edits,
        settings: Settings { max_iterations: 20, tolerance: 1e-7, steps: 200, ..Settings::default() },
        faces: mesh.faces,
        ..Problem::default()
    })
}

/// The two triangles of a square, their diagonals alternating as on a chessboard.
fn triangles(square: u32) -> [Vec<u32>; 2] {
    let (x, y) = (square % SQUARES, square / SQUARES);
    let row = SQUARES + 1;
    let at = |dx: u32, dy: u32| (y + dy) * row + x + dx;
    let [a, b, c, d] = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
    if (x + y) % 2 == 0 { [vec![a, b, c], vec![a, c, d]] } else { [vec![a, b, d], vec![b, c, d]] }
}
