//! Solving with a supernodal Cholesky factor for three coordinates at once, on one thread or several.
//!
//! The factor's columns are cut into *panels* of up to [`WIDTH`] within each supernode. A panel keeps the inverse of its
//! diagonal block and its rows below, row by row, so that a solve streams through it once forwards and once backwards; the
//! unknowns are rows of x, y, z and a zero, one vector register each.
//!
//! The elimination tree is cut into *parts*: subtrees that touch each other only through the *top*, the supernodes above
//! them. Parts are solved on their own, in parallel if the caller wants; what they subtract from the top goes to a
//! buffer each, and the buffers are added in order. The cut depends on the factor alone, so the bits do not depend on the
//! number of threads. Unknowns are numbered part by part, the top last.

use std::collections::TryReserveError;

use super::fronts::{self, Lower, Multiply, Outcome};
use super::simd::{Kernel, Lanes, add_scaled, dispatch};

/// Columns of a panel at most: as many accumulators as leave registers for the rest.
pub(super) const WIDTH: usize = 8;

/// Values of the factor above which it is cut into parts. The cut costs one thread some 5 % there, and two gain a third.
const LEAST_VALUES: usize = 30_000;

/// A part holds at most this share of all values, so that some threads can share the work evenly.
const LARGEST_SHARE: usize = 12;

/// The number of parts: more than the threads of most machines, few enough for one buffer each.
const PARTS: usize = 8;

/// The pattern of a supernodal factor, in elimination order.
pub struct Supernodes<'a> {
    /// Where the columns of each supernode begin, and their number.
    pub begins: &'a [u32],
    /// Row indices below the diagonal block of a supernode, ascending.
    pub rows: &'a dyn Fn(usize) -> &'a [u32],
}

/// One supernode as it lies in its part.
pub(super) struct Supernode {
    /// Its first unknown, counted from the part's first.
    pub(super) first: u32,
    pub(super) width: u32,
    /// Its rows below lie in [`Part::rows`]: those within the part, then those in the top.
    pub(super) rows_start: u32,
    pub(super) rows_top: u32,
    pub(super) rows_end: u32,
}

/// Supernodes that are solved one after the other.
#[derive(Default)]
pub(super) struct Part {
    /// The number of its unknowns.
    pub(super) length: usize,
    pub(super) supernodes: Vec<Supernode>,
    /// Counted from the part's first unknown, or from the top's first.
    pub(super) rows: Vec<u32>,
    pub(super) value_count: usize,
    pub(super) values: Vec<f64>,
}

/// The factor in panels, with the memory that solving needs.
pub struct Panels {
    /// Where each unknown in elimination order lies.
    position: Vec<u32>,
    /// The top is the last.
    parts: Vec<Part>,
    /// The unknowns.
    x: Vec<Lanes>,
    /// What each part but the top subtracts from the top.
    buffers: Vec<Vec<Lanes>>,
}

impl Panels {
    /// Cuts the pattern into parts. Values come with [`Self::factorise`].
    pub fn new(supernodes: &Supernodes<'_>) -> Self {
        let count = supernodes.begins.len() - 1;
        let dimension = supernodes.begins[count] as usize;
        let (part_of, top) = cut(supernodes);
        let mut parts: Vec<Part> = (0..=top).map(|_| Part::default()).collect();
        let mut local = vec![0_u32; dimension];
        for s in 0..count {
            let part = &mut parts[part_of[s]];
            for column in supernodes.begins[s]..supernodes.begins[s + 1] {
                local[column as usize] = part.length as u32;
                part.length += 1;
            }
        }
        let mut position = vec![0; dimension];
        let mut starts = vec![0_usize];
        starts.extend(parts.iter().scan(0, |sum, part| {
            *sum += part.length;
            Some(*sum)
        }));
        let mut part_of_column = vec![0_usize; dimension];
        for s in 0..count {
            for column in supernodes.begins[s] as usize..supernodes.begins[s + 1] as usize {
                position[column] = (starts[part_of[s]] as u32) + local[column];
                part_of_column[column] = part_of[s];
            }
        }
        for s in 0..count {
            let (begin, end) = (supernodes.begins[s], supernodes.begins[s + 1]);
            let part = &mut parts[part_of[s]];
            let rows = (supernodes.rows)(s);
            // Rows belong to ancestors, which come in the same order here; those in the top are the last.
            let inside = rows.iter().take_while(|&&row| part_of_column[row as usize] == part_of[s]).count();
            let rows_start = part.rows.len();
            part.rows.extend(rows.iter().map(|&row| local[row as usize]));
            part.supernodes.push(Supernode {
                first: local[begin as usize],
                width: end - begin,
                rows_start: rows_start as u32,
                rows_top: (rows_start + inside) as u32,
                rows_end: part.rows.len() as u32,
            });
            part.value_count += value_count((end - begin) as usize, rows.len());
        }
        let buffers = vec![vec![[0.0; 4]; parts[top].length]; top];
        Self { position, parts, x: vec![[0.0; 4]; dimension], buffers }
    }

    /// Bytes of the factor as it is stored: values, row indices, and where they lie.
    pub fn byte_count(&self) -> usize {
        let of_part =
            |part: &Part| size_of_val(&*part.values) + size_of_val(&*part.rows) + size_of_val(&*part.supernodes);
        self.parts.iter().map(of_part).sum()
    }

    /// Where unknown `i` of the elimination order lies in [`Self::unknowns_mut`].
    pub fn position(&self) -> &[u32] {
        &self.position
    }

    /// Right-hand sides before, the solution after [`Self::solve`].
    pub fn unknowns(&self) -> &[Lanes] {
        &self.x
    }

    /// The unknowns, to be written.
    pub fn unknowns_mut(&mut self) -> &mut [Lanes] {
        &mut self.x
    }

    /// Factorises `lower`; see [`fronts::factorise`].
    pub fn factorise(
        &mut self,
        lower: &Lower<'_>,
        least_pivot: f64,
        multiply: Multiply,
        is_parallel: bool,
    ) -> Result<Outcome, TryReserveError> {
        fronts::factorise(&mut self.parts, lower, least_pivot, multiply, is_parallel)
    }

    /// Solves in place; the parts on the current rayon pool if `is_parallel`. Allocates nothing.
    pub fn solve(&mut self, is_parallel: bool) {
        let Some((top, parts)) = self.parts.split_last() else { return };
        let (below, x_top) = self.x.split_at_mut(self.position.len() - top.length);
        each_part(parts, below, &mut self.buffers, is_parallel, &|part, x, buffer| {
            buffer.fill([0.0; 4]);
            dispatch(Forward { part, x, top: buffer });
        });
        for buffer in &self.buffers {
            for (x, change) in x_top.iter_mut().zip(buffer) {
                *x = std::array::from_fn(|i| x[i] + change[i]);
            }
        }
        dispatch(Forward { part: top, x: x_top, top: &mut [] });
        dispatch(Backward { part: top, x: x_top, top: &[] });
        let x_top = &*x_top;
        each_part(parts, below, &mut self.buffers, is_parallel, &|part, x, _| {
            dispatch(Backward { part, x, top: x_top });
        });
    }
}

/// The values that a supernode of `width` columns and `below` rows takes in panels.
fn value_count(width: usize, below: usize) -> usize {
    let panel = |first: usize| {
        let end = (first + WIDTH).min(width);
        (end - first) * (end - first + width - end + below)
    };
    (0..width).step_by(WIDTH).map(panel).sum()
}

/// The part of every supernode, subtrees of about equal work and the top, and the number of the top, which is the last.
fn cut(supernodes: &Supernodes<'_>) -> (Vec<usize>, usize) {
    let count = supernodes.begins.len() - 1;
    let mut supernode_of = vec![0_u32; supernodes.begins[count] as usize];
    for s in 0..count {
        supernode_of[supernodes.begins[s] as usize..supernodes.begins[s + 1] as usize].fill(s as u32);
    }
    let parent: Vec<Option<usize>> =
        (0..count).map(|s| (supernodes.rows)(s).first().map(|&row| supernode_of[row as usize] as usize)).collect();
    // Work below and at each supernode; parents come after their children.
    let mut work: Vec<usize> = (0..count)
        .map(|s| value_count((supernodes.begins[s + 1] - supernodes.begins[s]) as usize, (supernodes.rows)(s).len()))
        .collect();
    let total: usize = work.iter().sum();
    if total < LEAST_VALUES {
        return (vec![0; count], 0);
    }
    for s in 0..count {
        if let Some(parent) = parent[s] {
            work[parent] += work[s];
        }
    }
    // A supernode is in the top if its subtree is too large for a part; the roots below the top are the subtrees.
    let is_top = |s: usize| work[s] * LARGEST_SHARE > total;
    let mut roots: Vec<usize> = (0..count).filter(|&s| !is_top(s) && parent[s].is_none_or(is_top)).collect();
    roots.sort_by_key(|&root| (std::cmp::Reverse(work[root]), root));
    let mut loads = [0_usize; PARTS];
    let mut part_of = vec![PARTS; count];
    for root in roots {
        let part = (0..PARTS).min_by_key(|&part| (loads[part], part)).unwrap_or(0);
        loads[part] += work[root];
        part_of[root] = part;
    }
    for s in (0..count).rev() {
        if part_of[s] == PARTS && !is_top(s) {
            part_of[s] = parent[s].map_or(PARTS, |parent| part_of[parent]);
        }
    }
    (part_of, PARTS)
}

/// Calls `work` with every part, its unknowns and its buffer.
fn each_part(
    parts: &[Part],
    x: &mut [Lanes],
    buffers: &mut [Vec<Lanes>],
    is_parallel: bool,
    work: &(impl Fn(&Part, &mut [Lanes], &mut [Lanes]) + Sync),
) {
    match (parts, &mut *buffers) {
        ([part], [buffer]) => work(part, x, buffer),
        ([], _) | (_, []) => {}
        _ => {
            let middle = parts.len() / 2;
            let (left, right) = parts.split_at(middle);
            let (x_left, x_right) = x.split_at_mut(left.iter().map(|part| part.length).sum());
            let (buffers_left, buffers_right) = buffers.split_at_mut(middle);
            let mut first = || each_part(left, x_left, buffers_left, is_parallel, work);
            let mut second = || each_part(right, x_right, buffers_right, is_parallel, work);
            if is_parallel {
                rayon::join(first, second);
            } else {
                first();
                second();
            }
        }
    }
}

/// `x ← L⁻¹ x` for one part. `top` receives what is added to the top's unknowns.
struct Forward<'a> {
    part: &'a Part,
    x: &'a mut [Lanes],
    top: &'a mut [Lanes],
}

/// `x ← L⁻ᵀ x` for one part, the top's unknowns being solved.
struct Backward<'a> {
    part: &'a Part,
    x: &'a mut [Lanes],
    top: &'a [Lanes],
}

/// Calls `$panel::<W, FMA>` with the width as a constant.
macro_rules! with_width {
    ($width:expr, $call:ident, $($argument:expr),*) => {
        match $width {
            1 => $call::<1, FMA>($($argument),*),
            2 => $call::<2, FMA>($($argument),*),
            3 => $call::<3, FMA>($($argument),*),
            4 => $call::<4, FMA>($($argument),*),
            5 => $call::<5, FMA>($($argument),*),
            6 => $call::<6, FMA>($($argument),*),
            7 => $call::<7, FMA>($($argument),*),
            _ => $call::<8, FMA>($($argument),*),
        }
    };
}

pub(super) use with_width;

impl Kernel for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let mut values = self.part.values.as_slice();
        for supernode in &self.part.supernodes {
            let [start, top, end] = [supernode.rows_start, supernode.rows_top, supernode.rows_end].map(|i| i as usize);
            let (rows, top_rows) = (&self.part.rows[start..top], &self.part.rows[top..end]);
            let (mut first, last) = (supernode.first as usize, (supernode.first + supernode.width) as usize);
            while first < last {
                let width = (last - first).min(WIDTH);
                let length = width * (last - first + end - start);
                let (panel, rest) = values.split_at(length);
                with_width!(width, forward_panel, panel, first, last, rows, top_rows, self.x, self.top);
                values = rest;
                first += width;
            }
        }
    }
}

#[inline(always)]
fn forward_panel<const W: usize, const FMA: bool>(
    panel: &[f64],
    first: usize,
    last: usize,
    rows: &[u32],
    top_rows: &[u32],
    x: &mut [Lanes],
    top: &mut [Lanes],
) {
    let (inverse, panel) = panel.split_at(W * W);
    let (own, below) = x[first..last].split_at_mut(W);
    let mut t = [[0.0; 4]; W];
    for (i, (sum, row)) in t.iter_mut().zip(inverse.chunks_exact(W)).enumerate() {
        for j in 0..=i {
            *sum = add_scaled::<FMA>(*sum, row[j], own[j]);
        }
    }
    own.copy_from_slice(&t);
    for sum in &mut t {
        *sum = sum.map(|value| -value);
    }
    let mut panel = panel.chunks_exact(W);
    for (x, row) in below.iter_mut().zip(&mut panel) {
        *x = subtract::<W, FMA>(*x, row, &t);
    }
    for (&i, row) in rows.iter().zip(&mut panel) {
        x[i as usize] = subtract::<W, FMA>(x[i as usize], row, &t);
    }
    for (&i, row) in top_rows.iter().zip(&mut panel) {
        top[i as usize] = subtract::<W, FMA>(top[i as usize], row, &t);
    }
}

/// `x + Σ row_j t_j`.
#[inline(always)]
fn subtract<const W: usize, const FMA: bool>(x: Lanes, row: &[f64], t: &[Lanes; W]) -> Lanes {
    (0..W).fold(x, |x, j| add_scaled::<FMA>(x, row[j], t[j]))
}

impl Kernel for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        let mut values = self.part.values.as_slice();
        for supernode in self.part.supernodes.iter().rev() {
            let [start, top, end] = [supernode.rows_start, supernode.rows_top, supernode.rows_end].map(|i| i as usize);
            let (rows, top_rows) = (&self.part.rows[start..top], &self.part.rows[top..end]);
            let (begin, last) = (supernode.first as usize, (supernode.first + supernode.width) as usize);
            let mut first = begin + (last - begin - 1) / WIDTH * WIDTH;
            loop {
                let width = (last - first).min(WIDTH);
                let length = width * (last - first + end - start);
                let (rest, panel) = values.split_at(values.len() - length);
                with_width!(width, backward_panel, panel, first, last, rows, top_rows, self.x, self.top);
                values = rest;
                if first == begin {
                    break;
                }
                first -= WIDTH;
            }
        }
    }
}

#[inline(always)]
fn backward_panel<const W: usize, const FMA: bool>(
    panel: &[f64],
    first: usize,
    last: usize,
    rows: &[u32],
    top_rows: &[u32],
    x: &mut [Lanes],
    top: &[Lanes],
) {
    let (inverse, panel) = panel.split_at(W * W);
    let mut sums = [[0.0; 4]; W];
    // From the last row to the first: the factor is then read in one direction from its end to its beginning, which the
    // memory foresees.
    let mut panel = panel.chunks_exact(W).rev();
    let mut add = |row: &[f64], x: Lanes| {
        for (sum, &value) in sums.iter_mut().zip(row) {
            *sum = add_scaled::<FMA>(*sum, value, x);
        }
    };
    for (&i, row) in top_rows.iter().rev().zip(&mut panel) {
        add(row, top[i as usize]);
    }
    for (&i, row) in rows.iter().rev().zip(&mut panel) {
        add(row, x[i as usize]);
    }
    for (x, row) in x[first + W..last].iter().rev().zip(&mut panel) {
        add(row, *x);
    }
    let own = &mut x[first..first + W];
    let mut t = [[0.0; 4]; W];
    for (i, row) in inverse.chunks_exact(W).enumerate() {
        let rest: Lanes = std::array::from_fn(|lane| own[i][lane] - sums[i][lane]);
        for j in 0..=i {
            t[j] = add_scaled::<FMA>(t[j], row[j], rest);
        }
    }
    own.copy_from_slice(&t);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three supernodes of 3, 11 and 6 columns; the first two are leaves, the last is their parent.
    const BEGINS: [u32; 4] = [0, 3, 14, 20];
    const ROWS: [&[u32]; 3] = [&[14, 16, 19], &[15, 16, 17, 18], &[]];

    /// A dense factor with this pattern.
    fn factor() -> Vec<Vec<f64>> {
        let mut dense = vec![vec![0.0; 20]; 20];
        for s in 0..3 {
            let (begin, end) = (BEGINS[s] as usize, BEGINS[s + 1] as usize);
            let rows = || (begin..end).chain(ROWS[s].iter().map(|&row| row as usize));
            for column in begin..end {
                for row in rows().filter(|&row| row >= column) {
                    dense[row][column] =
                        if row == column { 2.0 } else { ((7 * row + 13 * column) % 11) as f64 / 11.0 - 0.5 };
                }
            }
        }
        dense
    }

    fn panels() -> (Panels, Vec<Vec<f64>>) {
        let dense = factor();
        let mut panels = Panels::new(&Supernodes { begins: &BEGINS, rows: &|s| ROWS[s] });
        // Everything is in one part, in the order of elimination. Rows and columns are scaled by two.
        let (mut starts, mut entries, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..20 {
            for i in j..20 {
                let value = (0..20).map(|k| dense[i][k] * dense[j][k]).sum::<f64>() / 4.0;
                if value != 0.0 {
                    entries.push([i as u32, values.len() as u32]);
                    values.push(value);
                }
            }
            starts.push(entries.len() as u32);
        }
        let scale = [2.0; 20];
        let lower = Lower { starts: &starts, entries: &entries, values: &values, scale: &scale };
        let outcome = panels.factorise(&lower, 1e-13, |_| unreachable!("no product is large"), false).unwrap();
        assert!(outcome.is_finite && !outcome.is_singular);
        (panels, dense)
    }

    #[test]
    fn panels_solve_what_the_dense_factor_multiplies() {
        // b = L Lᵀ x for a known x; the portable kernel and the one for this machine must find x again.
        let (mut panels, dense) = panels();
        let x: Vec<Lanes> = (0..20).map(|i| [f64::from(i) - 7.0, 1.0 / (1.0 + f64::from(i)), -2.0, 0.0]).collect();
        let weighted = |coefficients: &dyn Fn(usize) -> f64, x: &[Lanes]| -> Lanes {
            (0..20).fold([0.0; 4], |sum, i| add_scaled::<false>(sum, coefficients(i), x[i]))
        };
        let half: Vec<Lanes> = (0..20).map(|i| weighted(&|k| dense[k][i], &x)).collect();
        let b: Vec<Lanes> = (0..20).map(|i| weighted(&|k| dense[i][k], &half)).collect();
        for is_portable in [false, true] {
            for (i, b) in b.iter().enumerate() {
                let place = panels.position()[i] as usize;
                panels.unknowns_mut()[place] = *b;
            }
            if is_portable {
                let part = &panels.parts[0];
                Forward { part, x: &mut panels.x, top: &mut [] }.run::<false>();
                Backward { part, x: &mut panels.x, top: &[] }.run::<false>();
            } else {
                panels.solve(false);
            }
            for (i, expected) in x.iter().enumerate() {
                let found = panels.x[panels.position[i] as usize];
                for lane in 0..4 {
                    assert!((found[lane] - expected[lane]).abs() < 1e-11, "unknown {i}: {found:?} is not {expected:?}");
                }
            }
        }
    }

    #[test]
    fn panels_hold_inverse_blocks_above_the_rows_below() {
        // The second supernode: panels of eight and three columns.
        let (panels, dense) = panels();
        let values = &panels.parts[0].values[3 * (3 + 3)..];
        let (first, second) = values.split_at(8 * (8 + 3 + 4));
        for (block, columns, below) in [(first, 3..11, [11, 12, 13].as_slice()), (second, 11..14, &[])] {
            let width = columns.len();
            let at = |i: usize, j: usize| dense[columns.start + i][columns.start + j];
            for i in 0..width {
                for j in 0..width {
                    let product: f64 = (0..width).map(|k| at(i, k) * block[width * k + j]).sum();
                    assert!((product - f64::from(u8::from(i == j))).abs() < 1e-13);
                }
            }
            let rows = below.iter().chain(&[15, 16, 17, 18]);
            for (row, values) in rows.zip(block[width * width..].chunks_exact(width)) {
                let expected = &dense[*row][columns.clone()];
                assert!(expected.iter().zip(values).all(|(a, b)| (a - b).abs() < 1e-13), "row {row}");
            }
        }
    }
}
