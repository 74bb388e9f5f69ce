//! A sparse symmetric matrix, assembled entry by entry: the system of the global step.

use glam::DVec3;

use super::nested_dissection::Graph;
use crate::error::{Error, Result, Status};

/// Where the lower triangle of a symmetric matrix has entries, in compressed columns.
#[derive(Clone, Debug)]
pub struct Pattern {
    dimension: usize,
    pub(super) column_starts: Vec<u32>,
    /// Ascending within a column; the diagonal entry first.
    pub(super) rows: Vec<u32>,
}

/// The lower triangle of a symmetric matrix, assembled again and again into the same pattern.
#[derive(Clone, Debug)]
pub struct SymmetricMatrix {
    pattern: Pattern,
    pub(super) values: Vec<f64>,
}

impl Pattern {
    /// The number of rows.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// An entry wherever `visit` reports one. `visit` calls its argument with `(i, j)` for every
    /// entry of either triangle, repeated ones included; the diagonal is always there. It is called twice and must
    /// report the same entries.
    ///
    /// # Errors
    /// Status `TooLarge` where 32-bit indices do not suffice.
    fn new(dimension: usize, visit: impl Fn(&mut dyn FnMut(u32, u32))) -> Result<Self> {
        // Columns of the entries below the diagonal, row by row; repeated ones are in there as often as they come.
        let mut row_starts = vec![0_usize; dimension + 1];
        visit(&mut |i, j| row_starts[i.max(j) as usize + 1] += usize::from(i != j));
        for i in 0..dimension {
            row_starts[i + 1] += row_starts[i];
        }
        let total = row_starts[dimension] + dimension;
        if u32::try_from(total).is_err() {
            return Err(Error::new(Status::TooLarge, format!("{total} matrix entries exceed 32-bit indices")));
        }
        let mut columns = vec![0_u32; row_starts[dimension]];
        let mut next = row_starts.clone();
        visit(&mut |i, j| {
            if i != j {
                let place = &mut next[i.max(j) as usize];
                columns[*place] = i.min(j);
                *place += 1;
            }
        });
        // Row after row they come into their columns in order, and repeated ones behind each other.
        let mut starts = vec![0_usize; dimension + 1];
        columns.iter().for_each(|&column| starts[column as usize + 1] += 1);
        for j in 0..dimension {
            starts[j + 1] += starts[j] + 1;
        }
        let mut rows = vec![0_u32; total];
        next.copy_from_slice(&starts);
        for j in 0..dimension {
            rows[next[j]] = j as u32;
            next[j] += 1;
            for &column in &columns[row_starts[j]..row_starts[j + 1]] {
                let place = &mut next[column as usize];
                if rows[*place - 1] != j as u32 {
                    rows[*place] = j as u32;
                    *place += 1;
                }
            }
        }
        // Close the gaps that repeated entries leave.
        let mut column_starts = Vec::with_capacity(dimension + 1);
        column_starts.push(0);
        let mut length = 0;
        for (&start, &end) in starts.iter().zip(&next[..dimension]) {
            rows.copy_within(start..end, length);
            length += end - start;
            column_starts.push(length as u32);
        }
        rows.truncate(length);
        rows.shrink_to_fit();
        Ok(Self { dimension, column_starts, rows })
    }

    /// Who is whose neighbour.
    pub(super) fn graph(&self) -> Graph {
        let mut starts = vec![0_u32; self.dimension + 1];
        let off_diagonal = |visit: &mut dyn FnMut(u32, u32)| {
            for column in 0..self.dimension {
                let (start, end) = (self.column_starts[column] as usize, self.column_starts[column + 1] as usize);
                self.rows[start..end].iter().filter(|&&row| row as usize != column).for_each(|&row| {
                    visit(row, column as u32);
                    visit(column as u32, row);
                });
            }
        };
        off_diagonal(&mut |i, _| starts[i as usize + 1] += 1);
        for i in 0..self.dimension {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut neighbours = vec![0; starts[self.dimension] as usize];
        off_diagonal(&mut |i, j| {
            let place = &mut next[i as usize];
            neighbours[*place as usize] = j;
            *place += 1;
        });
        Graph { starts, neighbours }
    }

    /// Calls `visit(i, j, k)` for every entry, column by column, rows ascending; `k` is the place of its value.
    pub(super) fn visit(&self, mut visit: impl FnMut(u32, u32, usize)) {
        for j in 0..self.dimension {
            for k in self.column_starts[j] as usize..self.column_starts[j + 1] as usize {
                visit(self.rows[k], j as u32, k);
            }
        }
    }

    /// Adds `value` to entry `(i, j)`, and so to `(j, i)`, of the matrix with these `values`. False if there is no such entry.
    #[must_use]
    pub fn add(&self, values: &mut [f64], i: u32, j: u32, value: f64) -> bool {
        let place = self.place(i, j);
        if let Some(k) = place {
            values[k] += value;
        }
        place.is_some()
    }

    /// Where the values have entry `(i, j)`, which is also `(j, i)`.
    pub fn place(&self, i: u32, j: u32) -> Option<usize> {
        let (row, column) = (i.max(j), i.min(j) as usize);
        let (start, end) = (self.column_starts[column] as usize, self.column_starts[column + 1] as usize);
        self.rows[start..end].binary_search(&row).ok().map(|k| start + k)
    }

    /// The diagonal entry `i` of the matrix with these `values`.
    pub fn diagonal(&self, values: &[f64], i: usize) -> f64 {
        values[self.column_starts[i] as usize]
    }
}

impl SymmetricMatrix {
    /// The zero matrix with an entry wherever `visit` reports one. `visit` calls its argument with `(i, j)` for every
    /// entry of either triangle, repeated ones included; the diagonal is always there. It is called twice and must
    /// report the same entries.
    ///
    /// # Errors
    /// Status `TooLarge` where 32-bit indices do not suffice.
    pub fn with_pattern(dimension: usize, visit: impl Fn(&mut dyn FnMut(u32, u32))) -> Result<Self> {
        let pattern = Pattern::new(dimension, visit)?;
        Ok(Self { values: vec![0.0; pattern.rows.len()], pattern })
    }

    /// Where it has entries.
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// Its entries, for assembling them while the pattern is analysed.
    pub fn split(&mut self) -> (&Pattern, &mut [f64]) {
        (&self.pattern, &mut self.values)
    }

    /// The number of rows.
    pub fn dimension(&self) -> usize {
        self.pattern.dimension
    }

    /// Adds `value` to entry `(i, j)` and so to `(j, i)`. False if the pattern has no such entry.
    #[must_use]
    pub fn add(&mut self, i: u32, j: u32, value: f64) -> bool {
        self.pattern.add(&mut self.values, i, j, value)
    }

    /// The diagonal entry `i`.
    pub fn diagonal(&self, i: usize) -> f64 {
        self.pattern.diagonal(&self.values, i)
    }

    /// A mutable reference to the diagonal entry `i`.
    pub fn diagonal_mut(&mut self, i: usize) -> &mut f64 {
        &mut self.values[self.pattern.column_starts[i] as usize]
    }

    /// Calls `visit(i, j, value)` for every entry of the lower triangle, column by column, rows ascending.
    pub fn visit(&self, mut visit: impl FnMut(u32, u32, f64)) {
        self.pattern.visit(|i, j, k| visit(i, j, self.values[k]));
    }

    /// `y = A x` for three columns at once. Both slices have [`Self::dimension`] entries.
    pub fn multiply(&self, x: &[DVec3], y: &mut [DVec3]) {
        y.fill(DVec3::ZERO);
        for j in 0..self.pattern.dimension {
            for k in self.pattern.column_starts[j] as usize..self.pattern.column_starts[j + 1] as usize {
                let (i, value) = (self.pattern.rows[k] as usize, self.values[k]);
                y[i] += value * x[j];
                if i != j {
                    y[j] += value * x[i];
                }
            }
        }
    }
}
