//! Sparse matrices on the card, and their products with three columns at once.
//!
//! Rows lie in *slices*, one for each workgroup of 64 threads. Where a matrix has fewer rows than a card has threads, some threads
//! share each row. Within a slice entries are column by column, as long as its longest row, so that neighbouring threads read
//! neighbouring memory. A matrix whose arrays would exceed a binding is cut into *pages* of whole slices, one run each.
//!
//! A vector is a buffer of four numbers per entry, the fourth not used unless it is said what for. Every row is a sum of its
//! own, in one order: pages change no bit.
//!
//! A matrix that takes equal numbers near to 0 loses that to rounding, the more so the smaller the eigenvalue: rounded row
//! sums make a large model stiffer or softer as a whole, or indefinite. Such a matrix is kept as *springs*: row sums, and
//! entries that multiply differences, `(A x)ᵢ = (Σⱼ aᵢⱼ) xᵢ + Σⱼ aᵢⱼ (xⱼ − xᵢ)`. What single precision loses then is as small
//! as the energy `xᵀ A x` is.

use bytemuck::{Pod, Zeroable};
use wgpu::Buffer;

use super::card::{Access, Card, GROUP, Run, THREADS};
use super::internal;
use crate::error::Result;
use crate::linalg::rows::SparseRows;

/// The text that all products begin with.
const SLICED: &str = include_str!("shaders/sliced.wgsl");

/// How threads that share a row add up.
const JOINED: &str = include_str!("shaders/joined.wgsl");

/// The same where each row has a thread of its own.
const ALONE: &str = "fn joined(local: u32, part: Sum) -> Sum { return part; }\n";

/// What the terms of a product are.
const PLAIN: &str = include_str!("shaders/plain.wgsl");
const SPRINGS: &str = concat!("fn taken(v: vec4f) -> vec3f { return v.xyz; }\n", include_str!("shaders/springs.wgsl"));
const SCALED_SPRINGS: &str =
    concat!("fn taken(v: vec4f) -> vec3f { return v.w * v.xyz; }\n", include_str!("shaders/springs.wgsl"));

const TWO: &str = include_str!("shaders/two.wgsl");

/// What entries and sums are, of one product and of two.
const ONE_SUM: &str = "alias Value = f32;\nalias Sum = vec3f;\n";
const TWO_SUMS: &str = "alias Value = vec2f;\nalias Sum = mat2x3f;\n";

/// Threads that fill a large card: with fewer rows than this, threads share rows.
const FULL_CARD: usize = 1 << 17;

/// Columns of slices in a page, at most: places of entries are numbers of 32 bits.
const MOST_COLUMNS: u64 = (u32::MAX / GROUP) as u64;

/// A thread that shares a row has so many entries of it at least, on average; else adding up costs more than it saves.
const LEAST_SHARE: usize = 4;

/// Threads that share a row, at most.
const MOST_LANES: usize = 16;

/// A sparse matrix on the card, or two.
pub(super) struct Sliced {
    has_two: bool,
    pages: Vec<Page>,
    row_count: usize,
    /// Threads that share a row: a power of two.
    lanes: usize,
}

/// Slices that one binding holds.
struct Page {
    /// The first row, and the row after the last.
    first: usize,
    end: usize,
    /// Where each slice begins, and where the last one ends, in columns of 64 entries.
    starts: Buffer,
    columns: Buffer,
    values: Buffer,
    /// Of springs.
    row_sums: Option<Buffer>,
}

/// See `struct Page` in `sliced.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Numbers {
    first: u32,
    end: u32,
    keep: f32,
    factor: f32,
}

/// What the product is, and what is done with a row of it.
pub(super) struct Finish {
    pub(super) name: &'static str,
    pub(super) of: Of,
    pub(super) text: &'static str,
    /// What it binds, from 6 on for springs and else from 5 on.
    pub(super) accesses: &'static [Access],
}

/// Which product.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    /// A plain matrix and `x`.
    Plain,
    /// Springs and `x`.
    Springs,
    /// Springs and `x`, each entry times its fourth number.
    ScaledSprings,
    /// Two matrices and `x`.
    Two,
}

/// How a matrix is kept.
#[derive(Clone, Copy)]
enum Kind<'a> {
    Plain,
    Springs,
    /// With this one, which has no entry where the first has none.
    With(&'a SparseRows),
}

const RESIDUAL: Finish = Finish {
    name: "residual",
    of: Of::Plain,
    text: include_str!("shaders/residual.wgsl"),
    accesses: &[Access::Read, Access::Write],
};

const IMAGE: Finish =
    Finish { name: "image", of: Of::Plain, text: include_str!("shaders/image.wgsl"), accesses: &[Access::Write] };

const SPRINGS_RESIDUAL: Finish = Finish {
    name: "springs' residual",
    of: Of::Springs,
    text: include_str!("shaders/springs_residual.wgsl"),
    accesses: &[Access::Read, Access::Write],
};

const SMOOTHED_FROM_ZERO: Finish = Finish {
    name: "smoothed from zero",
    of: Of::ScaledSprings,
    text: include_str!("shaders/smoothed_from_zero.wgsl"),
    accesses: &[Access::Write],
};

const CHEBYSHEV: Finish = Finish {
    name: "chebyshev",
    of: Of::Springs,
    text: include_str!("shaders/chebyshev.wgsl"),
    accesses: &[Access::Read, Access::Write, Access::Write],
};

const CORRECTED: Finish = Finish {
    name: "corrected",
    of: Of::Two,
    text: include_str!("shaders/corrected.wgsl"),
    accesses: &[Access::Write, Access::Write],
};

impl Sliced {
    /// Copies `matrix` to the card; `name` is what errors call it.
    ///
    /// # Errors
    /// Status `BackendUnavailable` if the card has no room, `BackendFailed` if it was lost.
    pub(super) fn new(card: &Card, name: &str, matrix: &SparseRows) -> Result<Self> {
        Self::of_kind(card, name, matrix, Kind::Plain)
    }

    /// The same as springs: for a square matrix that takes equal numbers near to 0.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn springs(card: &Card, name: &str, matrix: &SparseRows) -> Result<Self> {
        Self::of_kind(card, name, matrix, Kind::Springs)
    }

    /// A prolongation `P` from the next level, and `A P`: two matrices whose products are made at once.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn prolongation(card: &Card, name: &str, matrix: &SparseRows, image: &SparseRows) -> Result<Self> {
        Self::of_kind(card, name, image, Kind::With(matrix))
    }

    fn of_kind(card: &Card, name: &str, matrix: &SparseRows, kind: Kind<'_>) -> Result<Self> {
        let row_count = matrix.row_count();
        let mut row = Vec::new();
        let mut length = |i: usize| {
            read_row(matrix, kind, i, &mut row);
            row.len()
        };
        let lengths: Vec<usize> = (0..row_count).map(&mut length).collect();
        let lanes = lanes(row_count, lengths.iter().sum());
        let width = |slice: &[usize]| slice.iter().max().map_or(0, |longest| longest.div_ceil(lanes));
        let slice_rows = GROUP as usize / lanes;
        let widths: Vec<usize> = lengths.chunks(slice_rows).map(width).collect();
        // Columns of a slice that one binding holds.
        let has_two = matches!(kind, Kind::With(_));
        let entry_bytes = if has_two { size_of::<[f32; 2]>() } else { size_of::<f32>() };
        let most = (card.binding_bytes() / u64::from(GROUP) / entry_bytes as u64).min(MOST_COLUMNS) as usize;
        let mut pages = Vec::new();
        let mut first = 0;
        while first < widths.len() {
            let mut used = 0;
            let fits = |width: &&usize| {
                used += **width;
                used <= most
            };
            // A slice that is too long by itself is left to the card to refuse.
            let count = widths[first..].iter().take_while(fits).count().max(1);
            let rows = [first * slice_rows, ((first + count) * slice_rows).min(row_count)];
            pages.push(Page::new(card, name, matrix, rows, &widths[first..first + count], lanes, kind)?);
            first += count;
        }
        Ok(Self { has_two, pages, row_count, lanes })
    }

    /// The number of rows.
    pub(super) fn row_count(&self) -> usize {
        self.row_count
    }

    /// The number of slices, in all pages together.
    pub(super) fn slice_count(&self) -> usize {
        self.row_count.div_ceil(GROUP as usize / self.lanes)
    }

    /// `y = b − A x`, of a plain matrix.
    ///
    /// # Errors
    /// Status `BackendFailed`, as of all products.
    pub(super) fn residual(&self, card: &Card, b: &Buffer, x: &Buffer, y: &Buffer) -> Result<Vec<Run>> {
        self.runs(card, &RESIDUAL, [0.0; 2], x, &[b, y])
    }

    /// `y = A x`, of a plain matrix; the fourth numbers of `y` stay.
    pub(super) fn image(&self, card: &Card, x: &Buffer, y: &Buffer) -> Result<Vec<Run>> {
        self.runs(card, &IMAGE, [0.0; 2], x, &[y])
    }

    /// `y = b − A x`, of springs; the fourth numbers of `y` become those of `b`.
    pub(super) fn springs_residual(&self, card: &Card, b: &Buffer, x: &Buffer, y: &Buffer) -> Result<Vec<Run>> {
        self.runs(card, &SPRINGS_RESIDUAL, [0.0; 2], x, &[b, y])
    }

    /// Two steps of Chebyshev's iteration from 0, of springs: `y = keep D b + factor D A D b`. `D` is the inverse of the
    /// diagonal, and in the fourth numbers of `b`.
    pub(super) fn smoothed_from_zero(
        &self,
        card: &Card,
        factors: [f64; 2],
        b: &Buffer,
        y: &Buffer,
    ) -> Result<Vec<Run>> {
        self.runs(card, &SMOOTHED_FROM_ZERO, factors, b, &[y])
    }

    /// One step of Chebyshev's iteration, of springs: `change = keep change + factor D (b − A x)` and `next = x + change`.
    /// What `change` was does not matter where `keep` is 0. `D` is the inverse of the diagonal, and in the fourth numbers of
    /// `b`.
    pub(super) fn chebyshev(
        &self,
        card: &Card,
        factors: [f64; 2],
        [b, x, change, next]: [&Buffer; 4],
    ) -> Result<Vec<Run>> {
        self.runs(card, &CHEBYSHEV, factors, x, &[b, change, next])
    }

    /// Where [`Self::prolongation`] takes the next level's solution `e`, and the first step of Chebyshev's iteration from
    /// there: with `change` being `b − A y`, `y = y + P e`, then `change = factor D (change − A P e)` and `y = y + change`. `D`
    /// is the inverse of the diagonal, and in the fourth numbers of `change`.
    pub(super) fn corrected(&self, card: &Card, factor: f64, [e, change, y]: [&Buffer; 3]) -> Result<Vec<Run>> {
        self.runs(card, &CORRECTED, [0.0, factor], e, &[change, y])
    }

    /// A run for each page: `finish` with the factors `[keep, factor]` and what it binds.
    pub(super) fn runs(
        &self,
        card: &Card,
        finish: &Finish,
        [keep, factor]: [f64; 2],
        x: &Buffer,
        bound: &[&Buffer],
    ) -> Result<Vec<Run>> {
        let name = format!("sliced {} {}", finish.name, self.lanes);
        let lanes = format!("const LANES = {}u;\n", self.lanes);
        let joined = if self.lanes == 1 { ALONE } else { JOINED };
        let (sums, terms, own_count) = match finish.of {
            Of::Plain => (ONE_SUM, PLAIN, 4),
            Of::Springs => (ONE_SUM, SPRINGS, 5),
            Of::ScaledSprings => (ONE_SUM, SCALED_SPRINGS, 5),
            Of::Two => (TWO_SUMS, TWO, 4),
        };
        let mut accesses = vec![Access::Uniform];
        accesses.resize(1 + own_count, Access::Read);
        accesses.extend(finish.accesses);
        let kernel = card.kernel(&name, &[&lanes, sums, joined, SLICED, terms, finish.text, THREADS], &accesses)?;
        let run = |page: &Page| {
            let (keep, factor) = (keep as f32, factor as f32);
            let numbers = card.uniform(&Numbers { first: page.first as u32, end: page.end as u32, keep, factor });
            let mut buffers = vec![&numbers, &page.starts, &page.columns, &page.values, x];
            buffers.extend(&page.row_sums);
            if buffers.len() != 1 + own_count || self.has_two != (finish.of == Of::Two) {
                return Err(internal("a product is not meant for this kind of matrix"));
            }
            buffers.extend(bound);
            Ok(card.run_of(&kernel, &buffers, (page.end - page.first) * self.lanes))
        };
        self.pages.iter().map(run).collect()
    }
}

impl Page {
    /// The rows from `first` to `end`, in slices of these widths.
    fn new(
        card: &Card,
        name: &str,
        matrix: &SparseRows,
        [first, end]: [usize; 2],
        widths: &[usize],
        lanes: usize,
        kind: Kind<'_>,
    ) -> Result<Self> {
        let group = GROUP as usize;
        let slice_rows = group / lanes;
        let mut starts = vec![0_u32];
        starts.extend(widths.iter().scan(0, |sum, width| {
            *sum += *width as u32;
            Some(*sum)
        }));
        let count = widths.iter().sum::<usize>() * group;
        let (mut columns, mut values) = (vec![0_u32; count], vec![[0.0_f32; 2]; count]);
        let mut row = Vec::new();
        for i in first..end {
            let (slice, r) = ((i - first) / slice_rows, (i - first) % slice_rows);
            let place =
                |entry: usize| (starts[slice] as usize + entry / lanes) * group + entry % lanes * slice_rows + r;
            read_row(matrix, kind, i, &mut row);
            for (entry, (column, value)) in row.iter().enumerate() {
                (columns[place(entry)], values[place(entry)]) = (*column, *value);
            }
            // Padding reads what the row reads anyway.
            let padding = row.first().map_or(0, |(column, _)| *column);
            (row.len()..widths[slice] * lanes).for_each(|entry| columns[place(entry)] = padding);
        }
        let (starts, columns) = (card.buffer(name, &starts)?, card.buffer(name, &columns)?);
        let values = match kind {
            Kind::With(_) => card.buffer(name, &values)?,
            _ => card.buffer(name, &values.iter().map(|[value, _]| *value).collect::<Vec<_>>())?,
        };
        let row_sum = |i: usize| matrix.row(i).map(|(_, value)| value).sum::<f64>() as f32;
        let row_sums = match kind {
            Kind::Springs => Some(card.buffer(name, &(first..end).map(row_sum).collect::<Vec<_>>())?),
            _ => None,
        };
        Ok(Self { first, end, starts, columns, values, row_sums })
    }
}

/// Puts the columns and values of row `i` that are kept into `row`.
fn read_row(matrix: &SparseRows, kind: Kind<'_>, i: usize, row: &mut Vec<(u32, [f32; 2])>) {
    row.clear();
    let own = matrix.row(i).map(|(column, value)| (column as u32, value as f32));
    match kind {
        Kind::Plain => row.extend(own.map(|(column, value)| (column, [value, 0.0]))),
        // The diagonal multiplies no difference.
        Kind::Springs => {
            row.extend(own.filter(|(column, _)| *column as usize != i).map(|(column, value)| (column, [value, 0.0])));
        }
        Kind::With(first) => {
            // Columns ascend in both.
            let mut others = first.row(i).peekable();
            row.extend(own.map(|(column, value)| {
                let other = others.next_if(|(other, _)| *other == column as usize);
                (column, [other.map_or(0.0, |(_, value)| value as f32), value])
            }));
        }
    }
}

/// Threads that share each of `row_count` rows with `entry_count` entries in all. It depends on the matrix alone.
fn lanes(row_count: usize, entry_count: usize) -> usize {
    let mut lanes = 1;
    while 2 * lanes <= MOST_LANES
        && row_count * 2 * lanes <= FULL_CARD
        && entry_count >= 2 * lanes * LEAST_SHARE * row_count
    {
        lanes *= 2;
    }
    lanes
}

#[cfg(test)]
mod tests;
