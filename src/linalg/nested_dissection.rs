//! A fill-reducing ordering by nested dissection, for large systems whose unknowns lie in space.
//!
//! The unknowns are halved at the median of the longest side of their bounding box. Those of one half that are neighbours of the
//! other separate them: they are eliminated last, so that neither half fills in the other. The halves are cut again, down to leaves,
//! which are ordered by approximate minimum degree. Source: George 1973, "Nested dissection of a regular finite element mesh"; the
//! cut by coordinates is that of Heath & Raghavan 1995, "A Cartesian parallel nested dissection algorithm".

use glam::DVec3;

/// Unknowns of a leaf at most.
const LEAF: usize = 160;

/// The neighbours of each unknown.
pub struct Graph {
    /// Where the neighbours of each begin, and their number.
    pub starts: Vec<u32>,
    /// In both directions, without the unknown itself.
    pub neighbours: Vec<u32>,
}

impl Graph {
    fn of(&self, unknown: u32) -> &[u32] {
        &self.neighbours[self.starts[unknown as usize] as usize..self.starts[unknown as usize + 1] as usize]
    }
}

/// The order of elimination: entry `k` is the unknown that is eliminated as the `k`-th. `positions` says where each lies;
/// `order_leaf` orders a leaf, given its unknowns.
pub fn order(graph: &Graph, positions: &[DVec3], order_leaf: &mut dyn FnMut(&mut [u32])) -> Vec<u32> {
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    let mut side = vec![0_u32; positions.len()];
    let mut next_side = 1;
    // Ranges of `order` that are still to be cut.
    let mut ranges = vec![(0, order.len())];
    while let Some((start, end)) = ranges.pop() {
        let unknowns = &mut order[start..end];
        if unknowns.len() <= LEAF {
            order_leaf(unknowns);
            continue;
        }
        let of = |unknown: &u32| positions[*unknown as usize];
        let low = unknowns.iter().map(of).fold(DVec3::INFINITY, DVec3::min);
        let high = unknowns.iter().map(of).fold(DVec3::NEG_INFINITY, DVec3::max);
        let extent = (high - low).to_array();
        let axis = (0..3).max_by(|&a, &b| extent[a].total_cmp(&extent[b])).unwrap_or(0);
        let middle = unknowns.len() / 2;
        // Coinciding coordinates are told apart by index, so that the halves do not depend on the order before.
        unknowns.select_nth_unstable_by(middle, |a, b| of(a)[axis].total_cmp(&of(b)[axis]).then(a.cmp(b)));
        let (left, right) = unknowns.split_at(middle);
        let (left_side, right_side) = (next_side, next_side + 1);
        next_side += 2;
        left.iter().for_each(|&unknown| side[unknown as usize] = left_side);
        right.iter().for_each(|&unknown| side[unknown as usize] = right_side);
        let touches = |unknown: u32, other: u32| graph.of(unknown).iter().any(|&n| side[n as usize] == other);
        let mut separators = [
            left.iter().copied().filter(|&unknown| touches(unknown, right_side)).collect::<Vec<_>>(),
            right.iter().copied().filter(|&unknown| touches(unknown, left_side)).collect::<Vec<_>>(),
        ];
        separators.sort_by_key(Vec::len);
        let [mut separator, _] = separators;
        separator.sort_unstable();
        // As far as a half goes, then the other, then what separates them.
        separator.iter().for_each(|&unknown| side[unknown as usize] = 0);
        let rest =
            |part: &[u32]| part.iter().copied().filter(|&unknown| side[unknown as usize] != 0).collect::<Vec<_>>();
        let (left, right) = (rest(left), rest(right));
        let (first, second) = (start + left.len(), start + left.len() + right.len());
        let new = left.iter().chain(&right).chain(&separator);
        unknowns.iter_mut().zip(new).for_each(|(place, &unknown)| *place = unknown);
        ranges.push((first, second));
        ranges.push((start, first));
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The graph of an `n × n` grid with its diagonals.
    fn grid(n: u32) -> (Graph, Vec<DVec3>) {
        let (mut starts, mut neighbours) = (vec![0], Vec::new());
        for i in 0..n * n {
            let (column, row) = (i % n, i / n);
            for r in row.saturating_sub(1)..=(row + 1).min(n - 1) {
                for c in column.saturating_sub(1)..=(column + 1).min(n - 1) {
                    if (c, r) != (column, row) {
                        neighbours.push(r * n + c);
                    }
                }
            }
            starts.push(neighbours.len() as u32);
        }
        let positions = (0..n * n).map(|i| DVec3::new(f64::from(i % n), f64::from(i / n), 0.0)).collect();
        (Graph { starts, neighbours }, positions)
    }

    #[test]
    fn every_unknown_is_eliminated_once_and_the_first_separator_separates() {
        let n = 40;
        let (graph, positions) = grid(n);
        let order = order(&graph, &positions, &mut |_| {});
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..n * n).collect::<Vec<_>>());
        // The last n unknowns are one line of the grid; without it no neighbour of the first half is in the second.
        let last = &order[(n * n - n) as usize..];
        let columns: Vec<u32> = last.iter().map(|i| i % n).collect();
        let rows: Vec<u32> = last.iter().map(|i| i / n).collect();
        assert!(columns.iter().all(|c| *c == columns[0]) || rows.iter().all(|r| *r == rows[0]), "{last:?}");
    }

    #[test]
    fn coinciding_points_are_cut_all_the_same() {
        let (graph, _) = grid(30);
        let order = order(&graph, &vec![DVec3::ONE; 900], &mut |_| {});
        assert_eq!(order.len(), 900);
    }
}
