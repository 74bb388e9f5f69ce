//! The three problems that a program in every language solves: `tests/languages/README.md` states them.
//!
//! `cargo run --example three_problems -- examples/meshes/botanic-garden-bubble-0.obj FOLDER`

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use glam::{DVec3, dvec3};
use shapeop::error::Result;
use shapeop::mesh::{Mesh, file};
use shapeop::problem::Force;
use shapeop::solver::Solver;

/// Points along a side of the cloth.
const SIDE: u32 = 20;

fn main() -> std::result::Result<(), Box<dyn Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [mesh, folder] = arguments.as_slice() else {
        return Err("usage: three_problems MESH.obj FOLDER".into());
    };
    write(&folder.join("quad.txt"), &quad()?)?;
    write(&folder.join("planarise.txt"), &planarise(&file::read(mesh)?)?)?;
    write(&folder.join("cloth.txt"), &cloth()?)?;
    Ok(())
}

fn quad() -> Result<Vec<DVec3>> {
    let mut solver = Solver::new();
    solver.set_points(&[dvec3(0.0, 0.0, 0.3), dvec3(1.2, 0.0, 0.0), dvec3(1.0, 1.0, 0.4), dvec3(0.0, 1.1, -0.1)])?;
    solver.add_constraint("Plane", &[0, 1, 2, 3], 1.0)?;
    let rigid = solver.add_constraint("Rigid", &[0, 1, 2, 3], 2.0)?;
    solver.edit_constraint("Rigid", rigid, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0])?;
    let held = solver.add_constraint("Closeness", &[0], 0.5)?;
    solver.edit_constraint("Closeness", held, &[0.0, 0.0, 0.2])?;
    solver.init()?;
    solver.solve(25)?;
    Ok(solver.points().to_vec())
}

fn planarise(mesh: &Mesh) -> Result<Vec<DVec3>> {
    let mut solver = Solver::new();
    solver.set_points(&mesh.points)?;
    for face in &mesh.faces {
        solver.add_constraint("Plane", face, 1.0)?;
    }
    for point in 0..mesh.points.len() {
        solver.add_constraint("Closeness", &[point as u32], 0.05)?;
    }
    solver.init()?;
    solver.solve(100)?;
    Ok(solver.points().to_vec())
}

fn cloth() -> Result<Vec<DVec3>> {
    let mut solver = Solver::new();
    let place = |point: u32| dvec3(f64::from(point % SIDE), f64::from(point / SIDE), 0.0);
    solver.set_points(&(0..SIDE * SIDE).map(place).collect::<Vec<_>>())?;
    for point in 0..SIDE * SIDE {
        let right = (point % SIDE + 1 < SIDE).then_some(point + 1);
        let above = (point / SIDE + 1 < SIDE).then_some(point + SIDE);
        for other in right.into_iter().chain(above) {
            let edge = solver.add_constraint("EdgeStrain", &[point, other], 10.0)?;
            solver.edit_constraint("EdgeStrain", edge, &[1.0, 0.9, 1.1])?;
        }
    }
    solver.add_constraint("Closeness", &[0], 1000.0)?;
    solver.add_constraint("Closeness", &[19], 1000.0)?;
    let corner = solver.add_constraint("Closeness", &[399], 1000.0)?;
    solver.add_force(Force::Gravity(dvec3(0.0, 0.0, -1.0)))?;
    let wind = solver.add_force(Force::Vertex { force: dvec3(0.5, 0.0, 2.0), point: 380 })?;
    solver.init_dynamic(1.0, 0.95, 0.1)?;
    for step in 1..=60 {
        if step == 11 {
            solver.edit_constraint("Closeness", corner, &[14.0, 14.0, 5.0])?;
        }
        if step == 31 {
            solver.edit_vertex_force(wind, dvec3(0.0, 0.5, -1.0), 380)?;
        }
        solver.solve(5)?;
    }
    Ok(solver.points().to_vec())
}

fn write(path: &Path, points: &[DVec3]) -> std::io::Result<()> {
    let mut text = String::new();
    for point in points {
        // Rust prints the shortest decimal that reads back as the same number. A string cannot fail.
        let _ = writeln!(text, "{} {} {}", point.x, point.y, point.z);
    }
    fs::write(path, text)
}
