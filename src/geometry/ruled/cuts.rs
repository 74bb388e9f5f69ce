//! Cuts that open a surface with holes into a disk.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::level_terms::Jumps;
use crate::error::{Error, Result, Status};
use crate::mesh::{Mesh, TriangleMesh};

/// Shortest paths along edges, each from a loop of the boundary to one that is connected already, without common points.
pub(super) fn cuts(mesh: &TriangleMesh) -> Result<Vec<Vec<u32>>> {
    let refusal = |reason: &str| Err(Error::new(Status::Infeasible, reason).at("mesh"));
    let loops = mesh.boundary();
    let euler = mesh.points().len() as i64 + mesh.triangles().len() as i64 - mesh.edges().len() as i64;
    if mesh.components().1 != 1 || euler != 2 - loops.len() as i64 {
        return refusal("expected a surface of one part without handles");
    }
    let mut loop_of = vec![usize::MAX; mesh.points().len()];
    loops.iter().enumerate().for_each(|(l, points)| points.iter().for_each(|&i| loop_of[i as usize] = l));
    let mut is_taken = vec![false; mesh.points().len()];
    let mut is_connected = vec![false; loops.len()];
    is_connected.iter_mut().take(1).for_each(|first| *first = true);
    let mut paths = Vec::new();
    for from in 1..loops.len() {
        let is_goal = |i: u32| loop_of[i as usize] != usize::MAX && is_connected[loop_of[i as usize]];
        let Some(path) = shortest(mesh, &loops[from], &is_taken, &loop_of, &is_goal) else {
            return refusal("expected loops of the boundary that paths without common points connect");
        };
        path.iter().for_each(|&i| is_taken[i as usize] = true);
        is_connected[from] = true;
        paths.push(path);
    }
    Ok(paths)
}

/// The shortest path from some points to a goal through the inside, without points that are taken (Dijkstra 1959).
fn shortest(
    mesh: &TriangleMesh,
    from: &[u32],
    is_taken: &[bool],
    loop_of: &[usize],
    is_goal: &dyn Fn(u32) -> bool,
) -> Option<Vec<u32>> {
    let mut best = vec![f64::INFINITY; mesh.points().len()];
    let mut before = vec![u32::MAX; mesh.points().len()];
    // Distances are 0 or above: as integers their bits are in the same order.
    let mut open = BinaryHeap::new();
    for &i in from.iter().filter(|&&i| !is_taken[i as usize]) {
        best[i as usize] = 0.0;
        open.push(Reverse((0_u64, i)));
    }
    while let Some(Reverse((bits, i))) = open.pop() {
        let distance = f64::from_bits(bits);
        if distance > best[i as usize] {
            continue;
        }
        if is_goal(i) {
            let mut path = vec![i];
            while before[path[path.len() - 1] as usize] != u32::MAX {
                path.push(before[path[path.len() - 1] as usize]);
            }
            path.reverse();
            return Some(path);
        }
        for j in mesh.neighbours(i as usize) {
            let is_open = !is_taken[j as usize] && (loop_of[j as usize] == usize::MAX || is_goal(j));
            let next = distance + mesh.points()[i as usize].distance(mesh.points()[j as usize]);
            if is_open && next < best[j as usize] {
                best[j as usize] = next;
                before[j as usize] = i;
                open.push(Reverse((next.to_bits(), j)));
            }
        }
    }
    None
}

/// The corners of the triangles to the left of each path, at its points.
///
/// Around an inner point of a path, counterclockwise, they are from the next point to the one before; at its first point, which is on
/// the boundary, from the next point to the end of the fan, and at its last from the beginning of the fan to the one before.
pub(super) fn corners(mesh: &TriangleMesh, paths: &[Vec<u32>]) -> Vec<(u32, u32, f64)> {
    let mut corners = Vec::new();
    for (cut, path) in paths.iter().enumerate() {
        for (k, &i) in path.iter().enumerate() {
            let fan = mesh.fan(i as usize);
            let corner = |t: u32| mesh.triangles()[t as usize].iter().position(|&j| j == i).unwrap_or(0);
            // The point that a triangle of the fan begins at, seen from `i`.
            let first = |t: u32| mesh.triangles()[t as usize][(corner(t) + 1) % 3];
            let place = |j: u32| fan.iter().position(|&t| first(t) == j);
            let start = path.get(k + 1).map_or(Some(0), |&next| place(next)).unwrap_or(0);
            let end = k.checked_sub(1).and_then(|k| place(path[k]));
            let is_inner = k > 0 && k + 1 < path.len();
            // The point before the last may be where the fan ends, after all triangles.
            let end = if k == 0 { fan.len() } else { end.unwrap_or(fan.len()) };
            let span = if is_inner && end <= start { end + fan.len() - start } else { end.saturating_sub(start) };
            for t in (0..span).map(|step| fan[(start + step) % fan.len()]) {
                corners.push((3 * t + corner(t) as u32, cut as u32, 1.0));
            }
        }
    }
    corners.sort_unstable_by_key(|&(corner, cut, _)| (corner, cut));
    corners
}

/// The mesh cut open: points of cuts are there once for each side, triangles as they were.
pub(super) struct Split {
    pub mesh: TriangleMesh,
    /// For each point that was added the one that it is a copy of, and the cut that it is to the left of.
    pub copies: Vec<(u32, u32)>,
    pub point_count: usize,
}

impl Split {
    pub fn new(mesh: &TriangleMesh, jumps: &Jumps) -> Result<Self> {
        let mut faces: Vec<Vec<u32>> = mesh.triangles().iter().map(|triangle| triangle.to_vec()).collect();
        let mut points = mesh.points().to_vec();
        let (mut copies, mut copy_of) = (Vec::new(), BTreeMap::new());
        for &(corner, cut, _) in &jumps.corners {
            let (t, k) = (corner as usize / 3, corner as usize % 3);
            let i = mesh.triangles()[t][k];
            faces[t][k] = *copy_of.entry(i).or_insert_with(|| {
                points.push(mesh.points()[i as usize]);
                copies.push((i, cut));
                points.len() as u32 - 1
            });
        }
        let mesh_error = |error: Error| Error::new(Status::Infeasible, error.to_string()).at("mesh");
        let split = TriangleMesh::new(&Mesh { points, faces }).map_err(mesh_error)?;
        Ok(Self { mesh: split, copies, point_count: mesh.points().len() })
    }

    /// The values of a function at its points.
    pub fn values(&self, values: &[f64], jumps: &[f64]) -> Vec<f64> {
        let copied = self.copies.iter().map(|&(i, cut)| values[i as usize] + jumps[cut as usize]);
        values.iter().copied().chain(copied).collect()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::DVec3;

    use super::*;
    use crate::mesh::Grid;
    use crate::mesh::patterns::height_field;

    fn euler(mesh: &TriangleMesh) -> i64 {
        mesh.points().len() as i64 + mesh.triangles().len() as i64 - mesh.edges().len() as i64
    }

    #[test]
    fn a_plate_with_holes_is_opened_into_a_disk() {
        let mut plate = height_field(13, 10, [0.0, 12.0], [0.0, 9.0], |_, _| 0.0).unwrap();
        for hole in [[3.0, 3.0], [7.0, 6.0], [9.0, 2.0]] {
            plate.faces.retain(|face| {
                let low = plate.points[face[0] as usize];
                !(low.x == hole[0] && low.y == hole[1])
            });
        }
        let mesh = TriangleMesh::new(&plate).unwrap();
        assert_eq!((mesh.boundary().len(), euler(&mesh)), (4, -2));
        let paths = cuts(&mesh).unwrap();
        assert_eq!(paths.len(), 3);
        let mut used: Vec<u32> = paths.concat();
        used.sort_unstable();
        used.dedup();
        assert_eq!(used.len(), paths.iter().map(Vec::len).sum::<usize>());
        let jumps = Jumps { corners: corners(&mesh, &paths), values: vec![None; 3] };
        let split = Split::new(&mesh, &jumps).unwrap();
        assert_eq!((split.mesh.boundary().len(), euler(&split.mesh), split.mesh.components().1), (1, 1, 1));
        assert_eq!(split.copies.len(), used.len());
        // Copies are to the left: the middles of their triangles are.
        for &(corner, cut, _) in &jumps.corners {
            let (t, path) = (corner as usize / 3, &paths[cut as usize]);
            let point = mesh.triangles()[t][corner as usize % 3];
            let k = path.iter().position(|&i| i == point).unwrap().min(path.len() - 2);
            let [a, b] = [path[k], path[k + 1]].map(|i| mesh.points()[i as usize]);
            let middle = mesh.corners(t).iter().sum::<DVec3>() / 3.0;
            // Of a straight stretch; corners turn.
            let is_straight =
                path.len() == 2 || (k > 0 && (mesh.points()[path[k - 1] as usize] + b - 2.0 * a).length() < 1e-12);
            assert!(!is_straight || (b - a).cross(middle - a).z > -1e-12);
        }
        // A function that jumps has values on both sides.
        let values = split.values(&vec![1.0; mesh.points().len()], &[2.0, 3.0, 4.0]);
        assert!(
            split.copies.iter().zip(&values[mesh.points().len()..]).all(|(&(_, cut), v)| *v == 3.0 + f64::from(cut))
        );
    }

    #[test]
    fn surfaces_with_handles_are_refused() {
        let torus = |k: usize| {
            let (u, v) = (TAU * (k % 12) as f64 / 12.0, TAU * (k / 12) as f64 / 12.0);
            DVec3::new((3.0 + u.cos()) * v.cos(), (3.0 + u.cos()) * v.sin(), u.sin())
        };
        let torus = Grid::new((0..144).map(torus).collect(), 12, 12, [true, true]).unwrap().mesh();
        let error = cuts(&TriangleMesh::new(&torus).unwrap()).unwrap_err();
        assert_eq!((error.status(), error.place()), (Status::Infeasible, "mesh"));
    }
}
