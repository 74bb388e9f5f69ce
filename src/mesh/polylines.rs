//! The polylines of a quad mesh: edges that go on straight through points of valence four.

use super::{Mesh, Topology};
use crate::error::Result;

/// The polylines that the edges of `mesh` form, each edge in exactly one. At an inner point of valence four the next
/// edge is the one that shares no face with the last; at a boundary point of valence three a boundary edge goes on
/// along the boundary. Elsewhere polylines end. A closed one repeats its first point at its end.
///
/// # Errors
/// As [`Mesh::check`].
pub fn polylines(mesh: &Mesh) -> Result<Vec<Vec<u32>>> {
    let topology = Topology::new(mesh)?;
    let edges = topology.edges();
    let mut at_point = vec![Vec::new(); mesh.points.len()];
    for (edge, points) in edges.iter().enumerate() {
        points.iter().for_each(|&point| at_point[point as usize].push(edge));
    }
    let is_on_boundary = topology.boundary_points();
    let share_face =
        |a: usize, b: usize| topology.faces_at(a).any(|face| topology.faces_at(b).any(|other| other == face));
    // The edge that goes on from `edge` through `point`.
    let next = |edge: usize, point: u32| {
        let around = &at_point[point as usize];
        let mut others = around.iter().copied().filter(|&other| other != edge);
        match (is_on_boundary[point as usize], around.len()) {
            (false, 4) => others.find(|&other| !share_face(edge, other)),
            (true, 3) if topology.is_boundary(edge) => others.find(|&other| topology.is_boundary(other)),
            _ => None,
        }
    };
    let other_end = |edge: usize, point: u32| edges[edge][usize::from(edges[edge][0] == point)];
    let mut is_used = vec![false; edges.len()];
    let mut lines = Vec::new();
    for first in 0..edges.len() {
        if is_used[first] {
            continue;
        }
        is_used[first] = true;
        // Forwards from the first edge's second point, then backwards from its first.
        let mut line = edges[first].to_vec();
        for _ in 0..2 {
            let (mut edge, mut point) = (first, line[line.len() - 1]);
            while let Some(found) = next(edge, point).filter(|&found| !is_used[found]) {
                is_used[found] = true;
                (edge, point) = (found, other_end(found, point));
                line.push(point);
            }
            line.reverse();
        }
        lines.push(line);
    }
    Ok(lines)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::mesh::patterns::{rhombille, translation_surface};

    #[test]
    fn a_grid_has_its_rows_and_columns() {
        let n = 5;
        let mut lines = polylines(&translation_surface(n).unwrap()).unwrap();
        let n = n as u32;
        for line in &mut lines {
            if line[0] > line[line.len() - 1] {
                line.reverse();
            }
        }
        lines.sort();
        let rows = (0..n).map(|j| (0..n).map(|i| j * n + i).collect::<Vec<_>>());
        let columns = (0..n).map(|i| (0..n).map(|j| j * n + i).collect::<Vec<_>>());
        let mut expected: Vec<Vec<u32>> = rows.chain(columns).collect();
        expected.sort();
        assert_eq!(lines, expected);
    }

    #[test]
    fn a_ring_is_closed_and_valences_three_and_six_end_lines() {
        // A tube of four quads around, two along: three closed rings, four lines along.
        let points = (0..12).map(|i| {
            let angle = f64::from(i % 4) * std::f64::consts::FRAC_PI_2;
            DVec3::new(angle.cos(), angle.sin(), f64::from(i / 4))
        });
        let faces = (0..8_u32).map(|i| {
            let (ring, j) = (i / 4 * 4, i % 4);
            let k = (j + 1) % 4;
            vec![ring + j, ring + k, ring + 4 + k, ring + 4 + j]
        });
        let mesh = Mesh { points: points.collect(), faces: faces.collect() };
        let lines = polylines(&mesh).unwrap();
        let closed: Vec<&Vec<u32>> = lines.iter().filter(|line| line[0] == line[line.len() - 1]).collect();
        assert_eq!((lines.len(), closed.len()), (7, 3));
        assert!(closed.iter().all(|line| line.len() == 5));
        let stars = rhombille(4, 4, 1.0, 0.0).unwrap();
        let count: usize = polylines(&stars).unwrap().iter().map(|line| line.len() - 1).sum();
        assert_eq!(count, Topology::new(&stars).unwrap().edges().len());
    }
}
