//! Meshes and lines of a snake's positions: the surface swept, pipes, lamellae.

use std::fmt::Write;

use anyhow::Result;
use glam::DVec3;
use shapeop::geometry::snakes::Snake;
use shapeop::geometry::snakes::covering::{flat_lamellae, lamella, pipe};
use shapeop::mesh::reference::ReferenceMesh;
use shapeop::mesh::{Grid, Mesh, ReferenceSurface as _};

use super::names::Names;

/// Points around a pipe.
pub const AROUND: usize = 12;

fn names() -> Names {
    Names::new(&[("radius", "--pipes"), ("depth", "--lamellae"), ("per_arc", "--per-arc"), ("points", "--per-arc")])
}

/// One mesh of several grids.
pub fn joined(grids: &[Grid]) -> Mesh {
    let mut joined = Mesh { points: Vec::new(), faces: Vec::new() };
    for grid in grids {
        let first = joined.points.len() as u32;
        let mesh = grid.mesh();
        joined.points.extend(mesh.points);
        joined
            .faces
            .extend(mesh.faces.into_iter().map(|face| face.into_iter().map(|i| first + i).collect::<Vec<u32>>()));
    }
    joined
}

/// Pipes along positions.
pub fn pipes(snakes: &[Snake], radius: f64, per_arc: usize) -> Result<Vec<Grid>> {
    snakes.iter().map(|snake| pipe(snake, radius, per_arc, AROUND).map_err(|error| names().of(error))).collect()
}

/// Lamellae along positions: across a surface, or in the planes of the arcs.
pub fn lamellae(
    snakes: &[Snake],
    depth: f64,
    per_arc: usize,
    surface: Option<&ReferenceMesh<'_>>,
) -> Result<Vec<Grid>> {
    let mut grids = Vec::new();
    for snake in snakes {
        match surface {
            Some(surface) => {
                let normal = |point: DVec3| surface.nearest(point).normal;
                grids.push(lamella(snake, depth, per_arc, &normal).map_err(|error| names().of(error))?);
            }
            None => grids.extend(flat_lamellae(snake, depth, per_arc).map_err(|error| names().of(error))?),
        }
    }
    Ok(grids)
}

/// Polylines as OBJ; closed ones end where they begin.
pub fn polylines_obj(lines: &[Vec<DVec3>], are_closed: bool) -> String {
    let mut text = String::new();
    let mut next = 1;
    for line in lines {
        for p in line {
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        text.push('l');
        for k in 0..line.len() {
            let _ = write!(text, " {}", next + k);
        }
        if are_closed {
            let _ = write!(text, " {next}");
        }
        text.push('\n');
        next += line.len();
    }
    text
}
