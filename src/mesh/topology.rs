//! Who is next to whom: edges, boundaries and neighbours of a mesh.
//!
//! Half-edge `h` runs from a corner of a face to the next corner of that face; the half-edges of face `f` follow each
//! other. Nothing is assumed of the mesh: an edge may have any number of faces, and faces may disagree about their
//! orientation. What is not manifold is named, not refused.

use std::collections::HashMap;

use super::Mesh;
use crate::error::Result;

/// The edges of a mesh and what lies around them.
#[derive(Clone, Debug)]
pub struct Topology {
    point_count: usize,
    /// Pairs of points, the lower first, in the order in which the faces meet them.
    edges: Vec<[u32; 2]>,
    /// The half-edges of each edge.
    edge_half_edges: Vec<Vec<u32>>,
    half_edges: Vec<HalfEdge>,
    /// The half-edges that leave each point.
    outgoing: Vec<Vec<u32>>,
}

#[derive(Clone, Copy, Debug)]
struct HalfEdge {
    start: u32,
    end: u32,
    /// The start of the half-edge before it in its face.
    before: u32,
    face: u32,
}

/// Boundary edges that follow each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoundaryChain {
    /// The points along it; the first is not repeated at the end.
    pub points: Vec<u32>,
    /// True if an edge leads from the last point to the first. Always so on a manifold mesh.
    pub is_closed: bool,
}

/// The points that share an edge with a point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Neighbours {
    /// Around the point in the orientation of the faces if `is_ordered`, at a boundary from its one end to the other;
    /// else in the order of the faces.
    pub points: Vec<u32>,
    /// True if the faces around the point form one fan, open or closed, of one orientation.
    pub is_ordered: bool,
}

impl Topology {
    /// Finds the edges of `mesh`.
    ///
    /// # Errors
    /// As [`Mesh::check`].
    pub fn new(mesh: &Mesh) -> Result<Self> {
        mesh.check()?;
        let mut topology = Self {
            point_count: mesh.points.len(),
            edges: Vec::new(),
            edge_half_edges: Vec::new(),
            half_edges: Vec::with_capacity(mesh.faces.iter().map(Vec::len).sum()),
            outgoing: vec![Vec::new(); mesh.points.len()],
        };
        let mut numbers = HashMap::new();
        for (face, corners) in (0..).zip(&mesh.faces) {
            for (j, &start) in corners.iter().enumerate() {
                let end = corners[(j + 1) % corners.len()];
                let before = corners[(j + corners.len() - 1) % corners.len()];
                // A corner repeated at once is no edge.
                if start == end {
                    continue;
                }
                let pair = [start.min(end), start.max(end)];
                let edge = *numbers.entry(pair).or_insert_with(|| {
                    topology.edges.push(pair);
                    topology.edge_half_edges.push(Vec::with_capacity(2));
                    topology.edges.len() - 1
                });
                let number = topology.half_edges.len() as u32;
                topology.half_edges.push(HalfEdge { start, end, before, face });
                topology.edge_half_edges[edge].push(number);
                topology.outgoing[start as usize].push(number);
            }
        }
        Ok(topology)
    }

    /// The edges as pairs of points, the lower first, each once, in the order in which the faces meet them.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// The faces at an edge, by its place in [`Topology::edges`].
    pub fn faces_at(&self, edge: usize) -> impl Iterator<Item = u32> + '_ {
        self.edge_half_edges[edge].iter().map(|&half_edge| self.half_edges[half_edge as usize].face)
    }

    /// True if exactly one face has this edge.
    pub fn is_boundary(&self, edge: usize) -> bool {
        self.edge_half_edges[edge].len() == 1
    }

    /// The edges with more than two faces.
    pub fn non_manifold_edges(&self) -> Vec<[u32; 2]> {
        self.edges_where(|half_edges| half_edges.len() > 2)
    }

    /// The edges whose two faces run along it the same way: one of them is the wrong way round.
    pub fn misoriented_edges(&self) -> Vec<[u32; 2]> {
        self.edges_where(|half_edges| match half_edges {
            [a, b] => self.half_edges[*a as usize].start == self.half_edges[*b as usize].start,
            _ => false,
        })
    }

    fn edges_where(&self, is_wanted: impl Fn(&[u32]) -> bool) -> Vec<[u32; 2]> {
        let edges = self.edges.iter().zip(&self.edge_half_edges);
        edges.filter(|(_, half_edges)| is_wanted(half_edges)).map(|(edge, _)| *edge).collect()
    }

    /// Whether each point is on a boundary edge.
    pub fn boundary_points(&self) -> Vec<bool> {
        let mut is_on_boundary = vec![false; self.point_count];
        for (edge, points) in self.edges.iter().enumerate() {
            if self.is_boundary(edge) {
                points.iter().for_each(|&point| is_on_boundary[point as usize] = true);
            }
        }
        is_on_boundary
    }

    /// The boundary as chains, each run through as its faces run along it.
    pub fn boundary(&self) -> Vec<BoundaryChain> {
        let mut is_left: Vec<bool> = (0..self.edges.len()).map(|edge| self.is_boundary(edge)).collect();
        let mut at_point: HashMap<u32, Vec<u32>> = HashMap::new();
        for edge in (0..self.edges.len()).filter(|&edge| is_left[edge]) {
            for point in self.edges[edge] {
                at_point.entry(point).or_default().push(edge as u32);
            }
        }
        let half_edge_of = |edge: u32| self.half_edges[self.edge_half_edges[edge as usize][0] as usize];
        let mut chains = Vec::new();
        for edge in 0..self.edges.len() as u32 {
            if !is_left[edge as usize] {
                continue;
            }
            is_left[edge as usize] = false;
            let first = half_edge_of(edge);
            let mut points = vec![first.start];
            let mut now = first.end;
            while now != first.start {
                points.push(now);
                // Where two loops touch, go on along the orientation rather than against it.
                let candidates = at_point[&now].iter().filter(|&&edge| is_left[edge as usize]);
                let Some(&next) = candidates.max_by_key(|&&edge| half_edge_of(edge).start == now) else { break };
                is_left[next as usize] = false;
                let half_edge = half_edge_of(next);
                now = if half_edge.start == now { half_edge.end } else { half_edge.start };
            }
            chains.push(BoundaryChain { points, is_closed: now == first.start });
        }
        chains
    }

    /// The points that share an edge with `point`; none if it is out of range.
    pub fn neighbours(&self, point: u32) -> Neighbours {
        let Some(outgoing) = self.outgoing.get(point as usize) else {
            return Neighbours { points: Vec::new(), is_ordered: true };
        };
        // Each face around the point leads from its next corner to the one before.
        let mut next = HashMap::with_capacity(outgoing.len());
        let mut has_predecessor = HashMap::with_capacity(outgoing.len());
        for half_edge in outgoing.iter().map(|&number| self.half_edges[number as usize]) {
            next.insert(half_edge.end, half_edge.before);
            has_predecessor.insert(half_edge.before, ());
        }
        let starts = outgoing.iter().map(|&number| self.half_edges[number as usize].end);
        let first = starts.clone().find(|start| !has_predecessor.contains_key(start)).or_else(|| starts.clone().next());
        let mut points = Vec::with_capacity(outgoing.len() + 1);
        let mut now = first;
        while let Some(at) = now {
            points.push(at);
            now = next.remove(&at).filter(|&following| Some(following) != first);
        }
        // Two faces that share a start leave `next` with fewer entries than faces.
        let is_ordered = next.is_empty() && has_predecessor.len() == outgoing.len() && {
            let distinct = points.iter().collect::<std::collections::HashSet<_>>().len();
            distinct == points.len() && self.neighbour_count(outgoing) == distinct
        };
        if !is_ordered {
            points.clear();
            let mut is_new = std::collections::HashSet::new();
            for half_edge in outgoing.iter().map(|&number| self.half_edges[number as usize]) {
                points.extend([half_edge.end, half_edge.before].into_iter().filter(|&point| is_new.insert(point)));
            }
        }
        Neighbours { points, is_ordered }
    }

    fn neighbour_count(&self, outgoing: &[u32]) -> usize {
        let half_edges = outgoing.iter().map(|&number| self.half_edges[number as usize]);
        half_edges
            .flat_map(|half_edge| [half_edge.end, half_edge.before])
            .collect::<std::collections::HashSet<_>>()
            .len()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn mesh(point_count: usize, faces: &[&[u32]]) -> Mesh {
        Mesh { points: vec![DVec3::ZERO; point_count], faces: faces.iter().map(|face| face.to_vec()).collect() }
    }

    /// Two by two quads: points 0 to 8, row by row.
    fn grid() -> Topology {
        Topology::new(&mesh(9, &[&[0, 1, 4, 3], &[1, 2, 5, 4], &[3, 4, 7, 6], &[4, 5, 8, 7]])).unwrap()
    }

    #[test]
    fn a_grid_has_its_edges_once() {
        // Euler: V − E + F = 1 for a disk: 9 − 12 + 4.
        let grid = grid();
        assert_eq!(grid.edges().len(), 12);
        assert_eq!((0..12).filter(|&edge| grid.is_boundary(edge)).count(), 8);
        let shared = grid.edges().iter().position(|edge| *edge == [1, 4]).unwrap();
        assert_eq!(grid.faces_at(shared).collect::<Vec<_>>(), [0, 1]);
        assert!(grid.non_manifold_edges().is_empty() && grid.misoriented_edges().is_empty());
    }

    #[test]
    fn the_boundary_of_a_grid_is_one_loop_in_the_faces_orientation() {
        let chain = BoundaryChain { points: vec![0, 1, 2, 5, 8, 7, 6, 3], is_closed: true };
        assert_eq!(grid().boundary(), [chain]);
        assert_eq!(grid().boundary_points().iter().filter(|is_on| **is_on).count(), 8);
    }

    #[test]
    fn neighbours_go_around_a_point() {
        // Inside: counterclockwise from the first face's next corner. On the edge: from one boundary edge to the other.
        let inside = grid().neighbours(4);
        assert!(inside.is_ordered);
        let from_1 = inside.points.iter().position(|point| *point == 1).unwrap();
        let turned: Vec<u32> = (0..4).map(|i| inside.points[(from_1 + i) % 4]).collect();
        assert_eq!(turned, [1, 5, 7, 3]);
        assert_eq!(grid().neighbours(1), Neighbours { points: vec![2, 4, 0], is_ordered: true });
        assert_eq!(grid().neighbours(0), Neighbours { points: vec![1, 3], is_ordered: true });
        assert!(grid().neighbours(99).points.is_empty());
    }

    #[test]
    fn what_is_not_manifold_is_named() {
        let fins = Topology::new(&mesh(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]])).unwrap();
        assert_eq!(fins.non_manifold_edges(), [[0, 1]]);
        let flipped = Topology::new(&mesh(4, &[&[0, 1, 2], &[0, 1, 3]])).unwrap();
        assert_eq!(flipped.misoriented_edges(), [[0, 1]]);
        assert!(!flipped.neighbours(0).is_ordered);
        let mut points = flipped.neighbours(0).points;
        points.sort_unstable();
        assert_eq!(points, [1, 2, 3]);
        assert!(flipped.boundary()[0].is_closed);
    }

    #[test]
    fn two_fans_at_one_point_make_two_loops_and_no_order() {
        let bow_tie = Topology::new(&mesh(5, &[&[0, 1, 2], &[2, 3, 4]])).unwrap();
        let boundary = bow_tie.boundary();
        assert_eq!(boundary.iter().map(|chain| chain.points.len()).sum::<usize>(), 6);
        assert!(boundary.iter().all(|chain| chain.is_closed));
        let tip = bow_tie.neighbours(2);
        assert!(!tip.is_ordered);
        assert_eq!(tip.points.len(), 4);
    }

    #[test]
    fn a_closed_surface_has_no_boundary() {
        let faces: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
        let tetrahedron = Topology::new(&mesh(4, &faces)).unwrap();
        assert!(tetrahedron.boundary().is_empty());
        assert!((0..4).all(|point| tetrahedron.neighbours(point).is_ordered));
    }
}
