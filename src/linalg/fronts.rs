//! Numeric factorisation by the multifrontal method, straight into panels.
//!
//! Each supernode has a *front*: the lower triangle of its columns and of the rows below them, dense. Into it go the
//! entries of the matrix and the *updates* of the supernode's children. Eliminating its columns makes its panels, and what
//! they subtract from the rows below is its own update, which its parent takes. Source: Liu 1992, "The multifrontal method
//! for sparse matrix solution: theory and practice".
//!
//! The columns of a front and its rows below are each padded with zeros to a multiple of four, so that the kernels know
//! no remainders. Above the diagonal there is rubbish.

use std::collections::TryReserveError;

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::panels::{Part, WIDTH, with_width};
use super::simd::{Kernel, Lanes, add_scaled, dispatch};

/// Columns of a front that are eliminated before the columns behind them hear of it.
const BLOCK: usize = 64;

/// Products with so many terms in all are left to [`Multiply`].
const LARGE_PRODUCT: usize = 1 << 18;

/// Products of more terms are cut in two, whatever the number of threads, so that the bits do not depend on it.
const LARGEST_PRODUCT: usize = 1 << 22;

/// What stands for the root of a vanishing pivot: so much that the rest stays finite.
const REPLACED_ROOT: f64 = 1e20;

/// Ends a list of updates.
const NONE: u32 = u32::MAX;

/// `target[i, j] -= Σ_k left[i, k] left[j, k]` wherever `i ≥ j`.
pub struct Product<'a> {
    /// Column by column, `target_stride` apart.
    pub target: &'a mut [f64],
    /// At least `rows`.
    pub target_stride: usize,
    /// The rows of both.
    pub rows: usize,
    /// The columns of the target, at most `rows`.
    pub columns: usize,
    /// Column by column, `left_stride` apart.
    pub left: &'a [f64],
    /// At least `rows`.
    pub left_stride: usize,
    /// The columns of `left`.
    pub inner: usize,
}

/// Computes a product that is large.
pub type Multiply = fn(Product<'_>);

/// The lower triangle of a matrix, its unknowns numbered as the panels number them.
pub struct Lower<'a> {
    /// Where the entries of each column begin, and their number.
    pub starts: &'a [u32],
    /// The row of each entry and where its value is.
    pub entries: &'a [[u32; 2]],
    /// The values.
    pub values: &'a [f64],
    /// Factors on rows and columns.
    pub scale: &'a [f64],
}

/// What is known after a factorisation.
pub struct Outcome {
    /// A pivot vanished; the factor is of no use.
    pub is_singular: bool,
    /// The scaled matrix is finite.
    pub is_finite: bool,
}

/// What a supernode adds to the rows below its columns, most of it negative.
struct Update<'a> {
    /// Its rows, counted from the part's first unknown.
    rows: &'a [u32],
    /// Its further rows, counted from the top's first unknown.
    top_rows: &'a [u32],
    /// Its lower triangle, column by column.
    values: Vec<f64>,
    /// The next update for the same supernode.
    next: u32,
}

/// The shape of a front.
#[derive(Clone, Copy)]
struct Front {
    /// The columns of the supernode.
    width: usize,
    /// The rows below.
    below: usize,
    /// `width` padded: where the rows below begin.
    columns: usize,
    /// `columns` and `below` padded.
    stride: usize,
}

/// A part's share of the work.
struct Job<'a> {
    lower: &'a Lower<'a>,
    part: &'a Part,
    /// The number of the part's first unknown.
    start: usize,
    /// The number of the top's first unknown.
    top_start: usize,
    /// What the parts subtract from the top, if this is the top.
    updates: Vec<Update<'a>>,
    /// Memory for the panels.
    values: Vec<f64>,
    least_pivot: f64,
    multiply: Multiply,
    is_parallel: bool,
}

struct Done<'a> {
    values: Vec<f64>,
    /// For the top.
    updates: Vec<Update<'a>>,
    outcome: Outcome,
}

/// Fills the panels of `parts`, the last of which is the top, with the factor of `lower`; the other parts in parallel on the
/// current rayon pool if `is_parallel`. A pivot at or below `least_pivot` is taken for 0.
///
/// # Errors
/// Memory does not suffice.
pub fn factorise(
    parts: &mut [Part],
    lower: &Lower<'_>,
    least_pivot: f64,
    multiply: Multiply,
    is_parallel: bool,
) -> Result<Outcome, TryReserveError> {
    let mut memory: Vec<Vec<f64>> = parts.iter_mut().map(|part| std::mem::take(&mut part.values)).collect();
    let (values, outcome) = {
        let (parts, top) = (&*parts, parts.len() - 1);
        let sums = parts.iter().scan(0, |sum, part| Some(std::mem::replace(sum, *sum + part.length)));
        let starts: Vec<usize> = sums.collect();
        let job = |i: usize, values: Vec<f64>| {
            let (part, start, top_start) = (&parts[i], starts[i], starts[top]);
            Job { lower, part, start, top_start, updates: Vec::new(), values, least_pivot, multiply, is_parallel }
        };
        let mut last = job(top, memory.pop().unwrap_or_default());
        let run = |(i, values)| dispatch(job(i, values));
        let below: Result<Vec<Done<'_>>, TryReserveError> = if is_parallel {
            memory.into_par_iter().enumerate().map(run).collect()
        } else {
            memory.into_iter().enumerate().map(run).collect()
        };
        let mut done = below?;
        last.updates = done.iter_mut().flat_map(|done| std::mem::take(&mut done.updates)).collect();
        done.push(dispatch(last)?);
        let is_singular = done.iter().any(|done| done.outcome.is_singular);
        let is_finite = done.iter().all(|done| done.outcome.is_finite);
        let values: Vec<Vec<f64>> = done.into_iter().map(|done| done.values).collect();
        (values, Outcome { is_singular, is_finite })
    };
    parts.iter_mut().zip(values).for_each(|(part, values)| part.values = values);
    Ok(outcome)
}

fn padded(count: usize) -> usize {
    count.next_multiple_of(4)
}

/// Makes `values` so many zeros.
fn zero(values: &mut Vec<f64>, count: usize) -> Result<(), TryReserveError> {
    values.clear();
    values.try_reserve_exact(count)?;
    values.resize(count, 0.0);
    Ok(())
}

impl<'a> Kernel for Job<'a> {
    type Output = Result<Done<'a>, TryReserveError>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let Self { lower, part, start, top_start, mut updates, mut values, least_pivot, .. } = self;
        let multiply = (self.multiply, self.is_parallel);
        let mut outcome = Outcome { is_singular: false, is_finite: true };
        values.clear();
        // What the padding of the last panel takes too, before it is cut off.
        values.try_reserve_exact(part.value_count + 3 * WIDTH)?;
        let mut supernode_of = vec![0_u32; part.length];
        for (s, supernode) in (0..).zip(&part.supernodes) {
            supernode_of[supernode.first as usize..(supernode.first + supernode.width) as usize].fill(s);
        }
        // The list of updates of each supernode begins here.
        let mut first_update = vec![NONE; part.supernodes.len()];
        let mut for_top = Vec::new();
        for (i, update) in (0..).zip(&mut updates) {
            if let Some(&row) = update.rows.first() {
                update.next = std::mem::replace(&mut first_update[supernode_of[row as usize] as usize], i);
            }
        }
        // Where an unknown of the part or, behind them, of the top lies in the front.
        let mut place = vec![0_u32; lower.scale.len() - top_start + if start < top_start { part.length } else { 0 }];
        // The columns of the front and what they subtract from the rows below.
        let (mut own, mut update) = (Vec::new(), Vec::new());
        let mut places: Vec<u32> = Vec::new();
        for (s, supernode) in part.supernodes.iter().enumerate() {
            let [rows_start, rows_top, rows_end] =
                [supernode.rows_start, supernode.rows_top, supernode.rows_end].map(|i| i as usize);
            let (rows, top_rows) = (&part.rows[rows_start..rows_top], &part.rows[rows_top..rows_end]);
            let (first, width, below) = (supernode.first as usize, supernode.width as usize, rows_end - rows_start);
            let (columns, update_stride) = (padded(width), padded(below));
            let stride = columns + update_stride;
            let front = Front { width, below, columns, stride };
            (0..).zip(&mut place[first..first + width]).for_each(|(i, place)| *place = i);
            for (i, &row) in (columns as u32..).zip(rows) {
                place[row as usize] = i;
            }
            for (i, &row) in ((columns + rows.len()) as u32..).zip(top_rows) {
                place[part.length + row as usize] = i;
            }
            zero(&mut own, columns * stride)?;
            zero(&mut update, update_stride * update_stride)?;
            for (column, front) in (start + first..start + first + width).zip(own.chunks_exact_mut(stride)) {
                let entries = lower.starts[column] as usize..lower.starts[column + 1] as usize;
                for &[row, source] in &lower.entries[entries] {
                    let row = row as usize;
                    let unknown = if row < start + part.length { row - start } else { part.length + row - top_start };
                    let value = lower.values[source as usize] * lower.scale[column] * lower.scale[row];
                    outcome.is_finite &= value.is_finite();
                    front[place[unknown] as usize] = value;
                }
            }
            let mut next = first_update[s];
            while next != NONE {
                let child = &mut updates[next as usize];
                places.clear();
                places.extend(child.rows.iter().map(|&row| place[row as usize]));
                places.extend(child.top_rows.iter().map(|&row| place[part.length + row as usize]));
                add_update(&child.values, &places, &mut own, columns, stride, &mut update);
                child.values = Vec::new();
                next = child.next;
            }
            for block in (0..width).step_by(BLOCK) {
                let block_end = (block + BLOCK).min(width);
                for first in (block..block_end).step_by(WIDTH) {
                    let end = (first + WIDTH).min(width);
                    let count = end - first;
                    outcome.is_singular |=
                        with_width!(count, eliminate, &mut own, front, first, least_pivot, &mut values);
                    if end < block_end {
                        spread::<FMA>(&mut own, stride, first, end, padded(block_end), multiply);
                    }
                }
                if block_end < width {
                    spread::<FMA>(&mut own, stride, block, block_end, columns, multiply);
                }
            }
            if below == 0 {
                continue;
            }
            let product = Product {
                target: &mut update,
                target_stride: update_stride,
                rows: update_stride,
                columns: update_stride,
                left: &own[columns..],
                left_stride: stride,
                inner: width,
            };
            subtract_product::<FMA>(product, multiply);
            let mut triangle = Vec::new();
            triangle.try_reserve_exact(below * (below + 1) / 2)?;
            for (j, column) in update.chunks_exact(update_stride).take(below).enumerate() {
                triangle.extend_from_slice(&column[j..below]);
            }
            let mut update = Update { rows, top_rows, values: triangle, next: NONE };
            if let Some(&row) = rows.first() {
                update.next =
                    std::mem::replace(&mut first_update[supernode_of[row as usize] as usize], updates.len() as u32);
                updates.push(update);
            } else {
                (update.rows, update.top_rows) = (top_rows, &[]);
                for_top.push(update);
            }
        }
        Ok(Done { values, updates: for_top, outcome })
    }
}

/// Adds the update of a child to the front of its parent: the columns `own`, `stride` apart, and the parent's `update`.
#[inline(always)]
fn add_update(child: &[f64], places: &[u32], own: &mut [f64], columns: usize, stride: usize, update: &mut [f64]) {
    let mut rest = child;
    for (j, &to) in places.iter().enumerate() {
        let (column, later) = rest.split_at(places.len() - j);
        rest = later;
        let (to, entries) = (to as usize, places[j..].iter().zip(column));
        if to < columns {
            let target = &mut own[to * stride..(to + 1) * stride];
            entries.for_each(|(&place, value)| target[place as usize] += value);
        } else {
            let length = stride - columns;
            let target = &mut update[(to - columns) * length..(to - columns + 1) * length];
            entries.for_each(|(&place, value)| target[place as usize - columns] += value);
        }
    }
}

/// Eliminates `W` columns of a front from `first` on, those before them being done: appends their panel to `values` and leaves
/// their rows below the diagonal block in the front. True if a pivot vanished.
#[inline(always)]
fn eliminate<const W: usize, const FMA: bool>(
    own: &mut [f64],
    front: Front,
    first: usize,
    least_pivot: f64,
    values: &mut Vec<f64>,
) -> bool {
    let stride = front.stride;
    let own = &mut own[first * stride..(first + W) * stride];
    let mut root = [[0.0; W]; W];
    let mut inverse = [[0.0; W]; W];
    let mut is_singular = false;
    for j in 0..W {
        for i in j..W {
            let sum: f64 = (0..j).map(|k| root[i][k] * root[j][k]).sum();
            root[i][j] = own[j * stride + first + i] - sum;
        }
        // What is not a number is not above it either.
        let is_above = root[j][j] > least_pivot;
        is_singular |= !is_above;
        root[j][j] = if is_above { root[j][j].sqrt() } else { REPLACED_ROOT };
        inverse[j][j] = 1.0 / root[j][j];
        for i in j + 1..W {
            root[i][j] *= inverse[j][j];
        }
    }
    for j in 0..W {
        for i in j + 1..W {
            let sum: f64 = (j..i).map(|k| root[i][k] * inverse[k][j]).sum();
            inverse[i][j] = -sum * inverse[i][i];
        }
    }
    values.extend_from_slice(inverse.as_flattened());
    // The later columns of the supernode, and the rows below.
    let end = first + W;
    for (begin, rows) in [(end, front.width - end), (front.columns, front.below)] {
        let start = values.len();
        values.resize(start + padded(rows) * W, 0.0);
        solve_rows::<W, FMA>(own, stride, begin, &inverse, &mut values[start..]);
        values.truncate(start + rows * W);
    }
    is_singular
}

/// Multiplies `W` columns of a front from the row `begin` on by the inverse of their diagonal block, and writes them to `panel`
/// row by row too.
#[inline(always)]
fn solve_rows<const W: usize, const FMA: bool>(
    own: &mut [f64],
    stride: usize,
    begin: usize,
    inverse: &[[f64; W]; W],
    panel: &mut [f64],
) {
    for (rows, begin) in panel.chunks_exact_mut(4 * W).zip((begin..).step_by(4)) {
        let mut x = [[0.0; 4]; W];
        for (c, x) in x.iter_mut().enumerate() {
            x.copy_from_slice(&own[c * stride + begin..c * stride + begin + 4]);
        }
        let mut solved = [[0.0; 4]; W];
        for c in 0..W {
            for j in 0..=c {
                solved[c] = add_scaled::<FMA>(solved[c], inverse[c][j], x[j]);
            }
            own[c * stride + begin..c * stride + begin + 4].copy_from_slice(&solved[c]);
        }
        for (lane, row) in rows.chunks_exact_mut(W).enumerate() {
            for c in 0..W {
                row[c] = solved[c][lane];
            }
        }
    }
}

/// Subtracts from the columns `end..columns` of a front what its columns `first..end` contribute.
#[inline(always)]
fn spread<const FMA: bool>(
    own: &mut [f64],
    stride: usize,
    first: usize,
    end: usize,
    columns: usize,
    multiply: (Multiply, bool),
) {
    let (left, target) = own.split_at_mut(end * stride);
    let product = Product {
        target: &mut target[end..],
        target_stride: stride,
        rows: stride - end,
        columns: columns - end,
        left: &left[first * stride + end..],
        left_stride: stride,
        inner: end - first,
    };
    subtract_product::<FMA>(product, multiply);
}

/// Leaves a product to `multiply`, cut into parts for the current rayon pool if `is_parallel`.
fn subtract_large_product(product: Product<'_>, multiply: Multiply, is_parallel: bool) {
    let Product { target, target_stride, rows, columns, left, left_stride, inner } = product;
    if rows * columns * inner <= LARGEST_PRODUCT || columns < 2 {
        return multiply(Product { target, target_stride, rows, columns, left, left_stride, inner });
    }
    let middle = columns / 2;
    let (first, second) = target.split_at_mut(middle * target_stride);
    let first = Product { target: first, target_stride, rows, columns: middle, left, left_stride, inner };
    let (target, left) = (&mut second[middle..], &left[middle..]);
    let (rows, columns) = (rows - middle, columns - middle);
    let second = Product { target, target_stride, rows, columns, left, left_stride, inner };
    let work = |product| subtract_large_product(product, multiply, is_parallel);
    if is_parallel {
        rayon::join(|| work(first), || work(second));
    } else {
        work(first);
        work(second);
    }
}

/// A product whose rows and columns are multiples of four.
#[inline(always)]
fn subtract_product<const FMA: bool>(product: Product<'_>, (multiply, is_parallel): (Multiply, bool)) {
    if product.rows * product.columns * product.inner >= LARGE_PRODUCT {
        return subtract_large_product(product, multiply, is_parallel);
    }
    let Product { target, target_stride, rows, columns, left, left_stride, inner } = product;
    for j in (0..columns).step_by(4) {
        let mut i = j;
        while i + 8 <= rows {
            subtract_tile::<2, FMA>(target, target_stride, i, j, left, left_stride, inner);
            i += 8;
        }
        if i < rows {
            subtract_tile::<1, FMA>(target, target_stride, i, j, left, left_stride, inner);
        }
    }
}

/// The rows `i..i + 4 R` and columns `j..j + 4` of a product.
#[inline(always)]
fn subtract_tile<const R: usize, const FMA: bool>(
    target: &mut [f64],
    target_stride: usize,
    i: usize,
    j: usize,
    left: &[f64],
    left_stride: usize,
    inner: usize,
) {
    let mut sums = [[[0.0; 4]; R]; 4];
    for column in left.chunks(left_stride).take(inner) {
        let (rows, factors) = (&column[i..i + 4 * R], &column[j..j + 4]);
        let rows: [Lanes; R] = std::array::from_fn(|r| std::array::from_fn(|lane| rows[4 * r + lane]));
        for c in 0..4 {
            for r in 0..R {
                sums[c][r] = add_scaled::<FMA>(sums[c][r], factors[c], rows[r]);
            }
        }
    }
    for (c, sums) in sums.iter().enumerate() {
        let start = (j + c) * target_stride + i;
        for (target, sum) in target[start..start + 4 * R].iter_mut().zip(sums.as_flattened()) {
            *target -= sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of no order.
    fn numbers(count: usize) -> Vec<f64> {
        (0..count).map(|i| ((i * i + 7 * i) % 113) as f64 / 113.0 - 0.5).collect()
    }

    /// The product as it is defined.
    fn defined(product: Product<'_>) {
        let Product { target, target_stride, rows, columns, left, left_stride, inner } = product;
        for j in 0..columns {
            for i in j..rows {
                let terms = (0..inner).map(|k| left[k * left_stride + i] * left[k * left_stride + j]);
                target[j * target_stride + i] -= terms.sum::<f64>();
            }
        }
    }

    #[test]
    fn small_products_and_large_ones_in_parts_are_what_is_defined() {
        for (rows, columns, inner) in [(4, 4, 1), (12, 8, 5), (28, 28, 8), (36, 4, 11), (400, 320, 64)] {
            let (left, stride) = (numbers((rows + 3) * inner), rows + 3);
            let mut expected = numbers(stride * columns);
            let mut portable = expected.clone();
            let mut wide = expected.clone();
            let mut cut = expected.clone();
            let of = |target| Product {
                target,
                target_stride: stride,
                rows,
                columns,
                left: &left,
                left_stride: stride,
                inner,
            };
            defined(of(&mut expected));
            subtract_product::<false>(of(&mut portable), (defined, false));
            subtract_product::<true>(of(&mut wide), (defined, false));
            subtract_large_product(of(&mut cut), defined, true);
            for j in 0..columns {
                for place in (j..rows).map(|i| j * stride + i) {
                    for found in [&portable, &wide, &cut] {
                        assert!((found[place] - expected[place]).abs() < 1e-12, "{rows} × {columns} × {inner}");
                    }
                }
            }
        }
    }
}
