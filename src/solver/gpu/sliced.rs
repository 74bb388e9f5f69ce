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

use super::card::{Access, Card, GROUP, Run};
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
        let kernel = card.kernel(&name, &[&lanes, sums, joined, SLICED, terms, finish.text], &accesses)?;
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
pub(super) mod tests {
    use super::*;
    use crate::solver::backend::BackendOptions;
    use crate::solver::gpu::frame::Four;

    /// The card with bindings of at most so many bytes (0: what it allows), if there is one; else says what is left out.
    pub(in crate::solver::gpu) fn card(binding_bytes: u64) -> Option<std::sync::Arc<Card>> {
        match Card::shared(&BackendOptions { binding_bytes, ..Default::default() }) {
            Ok(card) => Some(card),
            Err(error) => {
                eprintln!("LEFT OUT: {error}");
                None
            }
        }
    }

    /// Numbers in −1 to 1, the same for the same seed.
    pub(in crate::solver::gpu) struct Random(pub(in crate::solver::gpu) u64);

    impl Random {
        pub(in crate::solver::gpu) fn bits(&mut self) -> u64 {
            // The constants of Knuth's generator, of which the high bits are good.
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            self.0 >> 33
        }

        pub(in crate::solver::gpu) fn number(&mut self) -> f64 {
            self.bits() as f64 / (1_u64 << 30) as f64 - 1.0
        }

        pub(in crate::solver::gpu) fn vector(&mut self, count: usize) -> Vec<Four> {
            (0..count).map(|_| std::array::from_fn(|_| self.number() as f32)).collect()
        }
    }

    /// A matrix whose rows have up to `most` entries; some have none.
    fn matrix(random: &mut Random, rows: usize, columns: usize, most: u64) -> SparseRows {
        let mut row = || {
            let count = random.bits() % (most + 1);
            let mut found: Vec<u32> = (0..count).map(|_| (random.bits() % columns as u64) as u32).collect();
            found.sort_unstable();
            found.dedup();
            found.into_iter().map(|column| (column, random.number())).collect::<Vec<_>>()
        };
        let rows: Vec<_> = (0..rows).map(|_| row()).collect();
        SparseRows::from_rows(columns, rows.into_iter())
    }

    /// What `combine(i, lane, (A x)ᵢ)` is with `A x` in double precision, against what the card found.
    fn check(matrix: &SparseRows, x: &[Four], found: &[Four], combine: impl Fn(usize, usize, f64) -> f64, what: &str) {
        assert_eq!(found.len(), matrix.row_count());
        for (i, found) in found.iter().enumerate() {
            for (lane, found) in found[..3].iter().enumerate() {
                let (mut sum, mut size) = (0.0, 1.0);
                for (j, value) in matrix.row(i) {
                    sum += value * f64::from(x[j][lane]);
                    size += value.abs();
                }
                let expected = combine(i, lane, sum);
                // Each of up to some hundred terms, of numbers below 1, rounds twice, and so do a few operations beside.
                let error = (f64::from(*found) - expected).abs();
                assert!(error < 1e-6 * size, "{what}: row {i} lane {lane}: {found} instead of {expected}");
            }
        }
    }

    fn room(card: &Card, rows: usize) -> Buffer {
        card.buffer("a vector", &vec![[f32::NAN; 4]; rows]).unwrap()
    }

    /// Row counts about a slice, and some of many slices; rows of up to so many entries.
    fn sizes() -> impl Iterator<Item = (usize, u64)> {
        [1, 63, 64, 65, 1000, 10_001].into_iter().flat_map(|rows| [0, 3, 20, 70, 200].map(|most| (rows, most)))
    }

    #[test]
    fn products_are_those_in_double_precision_at_any_size_and_length_of_rows() {
        let Some(card) = card(0) else { return };
        let mut lanes_met = Vec::new();
        for (rows, most) in sizes() {
            let mut random = Random(rows as u64 + most);
            let matrix = matrix(&mut random, rows, rows, most);
            let sliced = Sliced::new(&card, "a matrix", &matrix).unwrap();
            lanes_met.push(sliced.lanes);
            let [x, b] = std::array::from_fn(|_| random.vector(rows));
            let [on_x, on_b, image] = [&x, &b, &b].map(|values| card.buffer("a vector", values).unwrap());
            let residual = room(&card, rows);
            let all = [sliced.residual(&card, &on_b, &on_x, &residual), sliced.image(&card, &on_x, &image)];
            all.into_iter().for_each(|runs| card.submit(&runs.unwrap()));
            let found: Vec<Vec<Four>> = card.read(&[(&residual, rows), (&image, rows)]).unwrap();
            let of_b = |i: usize, lane: usize| f64::from(b[i][lane]);
            let what = |what: &str| format!("{what}, {rows} rows of up to {most}");
            check(&matrix, &x, &found[0], |i, lane, sum| of_b(i, lane) - sum, &what("b − A x"));
            check(&matrix, &x, &found[1], |_, _, sum| sum, &what("A x"));
            assert!(found[0].iter().all(|y| y[3] == 0.0));
            assert!(found[1].iter().zip(&b).all(|(y, b)| y[3] == b[3]));
        }
        lanes_met.sort_unstable();
        lanes_met.dedup();
        assert_eq!(lanes_met, [1, 2, 4, 8, 16]);
    }

    #[test]
    fn products_of_springs_are_those_in_double_precision() {
        let Some(card) = card(0) else { return };
        for (rows, most) in sizes() {
            let mut random = Random(rows as u64 + most);
            let matrix = matrix(&mut random, rows, rows, most);
            let sliced = Sliced::springs(&card, "a matrix", &matrix).unwrap();
            let [x, b, change] = std::array::from_fn(|_| random.vector(rows));
            let [on_x, on_b, on_change] = [&x, &b, &change].map(|values| card.buffer("a vector", values).unwrap());
            let [residual, zero, first, next, unused] = std::array::from_fn(|_| room(&card, rows));
            let all = [
                sliced.springs_residual(&card, &on_b, &on_x, &residual),
                sliced.smoothed_from_zero(&card, [0.5, -0.25], &on_b, &zero),
                // What nothing is kept of may be anything.
                sliced.chebyshev(&card, [0.0, 0.75], [&on_b, &on_x, &first, &next]),
                sliced.chebyshev(&card, [0.5, 0.75], [&on_b, &on_x, &on_change, &unused]),
            ];
            all.into_iter().for_each(|runs| card.submit(&runs.unwrap()));
            let buffers = [&residual, &zero, &first, &next, &on_change];
            let found: Vec<Vec<Four>> = card.read(&buffers.map(|buffer| (buffer, rows))).unwrap();
            let of = |values: &[Four], i: usize, k: usize| f64::from(values[i][k]);
            let pull = |i, k, sum| of(&b, i, 3) * (of(&b, i, k) - sum);
            let what = |what: &str| format!("{what}, {rows} rows of up to {most}");
            check(&matrix, &x, &found[0], |i, k, sum| of(&b, i, k) - sum, &what("b − A x"));
            let scaled: Vec<Four> = b.iter().map(|b| b.map(|number| number * b[3])).collect();
            let from_zero = |i, k, sum: f64| 0.5 * of(&scaled, i, k) - 0.25 * of(&b, i, 3) * sum;
            check(&matrix, &scaled, &found[1], from_zero, &what("from zero"));
            check(&matrix, &x, &found[2], |i, k, sum| 0.75 * pull(i, k, sum), &what("the first change"));
            check(&matrix, &x, &found[3], |i, k, sum| of(&x, i, k) + 0.75 * pull(i, k, sum), &what("the next x"));
            let later = |i, k, sum| 0.5 * of(&change, i, k) + 0.75 * pull(i, k, sum);
            check(&matrix, &x, &found[4], later, &what("a later change"));
            assert!(found[0].iter().zip(&b).all(|(y, b)| y[3] == b[3]));
            assert!(found[1..].iter().flatten().all(|y| y[3] == 0.0));
        }
    }

    #[test]
    fn two_products_are_those_in_double_precision() {
        let Some(card) = card(0) else { return };
        for (rows, most) in sizes() {
            let mut random = Random(rows as u64 + most);
            let columns = rows.div_ceil(3);
            let image = matrix(&mut random, rows, columns, most);
            // Some entries of the image, with other values.
            let kept = |i: usize| image.row(i).filter(move |(j, _)| (i + j).is_multiple_of(3));
            let row = |i: usize| kept(i).map(|(j, value)| (j as u32, 0.5 - value)).collect();
            let prolongation = SparseRows::from_rows(columns, (0..rows).map(row));
            let sliced = Sliced::prolongation(&card, "two matrices", &prolongation, &image).unwrap();
            let e = random.vector(columns);
            let [residual, y] = std::array::from_fn(|_| random.vector(rows));
            let [on_e, change, on_y] = [&e, &residual, &y].map(|values| card.buffer("a vector", values).unwrap());
            card.submit(&sliced.corrected(&card, 0.75, [&on_e, &change, &on_y]).unwrap());
            let found: Vec<Vec<Four>> = card.read(&[(&change, rows), (&on_y, rows)]).unwrap();
            let of = |values: &[Four], i: usize, k: usize| f64::from(values[i][k]);
            let expected = |i, k, sum| 0.75 * of(&residual, i, 3) * (of(&residual, i, k) - sum);
            let what = |what: &str| format!("{what}, {rows} rows of up to {most}");
            check(&image, &e, &found[0], expected, &what("the change"));
            let moved = |i, k, sum| of(&y, i, k) + sum + of(&found[0], i, k);
            check(&prolongation, &e, &found[1], moved, &what("the next y"));
        }
    }

    #[test]
    fn springs_take_equal_numbers_to_what_the_row_sums_say() {
        let Some(card) = card(0) else { return };
        // Six neighbours of a sixth each, on a ring; rounded sixths add up to more than 1.
        let n = 500_u32;
        let row = |i: u32| {
            let sixth = |step: u32| ((i + n + step - 3) % n, if step == 3 { 1.0 + 1e-9 } else { -1.0 / 6.0 });
            (0..7).map(sixth).collect()
        };
        let matrix = SparseRows::from_rows(n as usize, (0..n).map(row));
        let sliced = Sliced::springs(&card, "a matrix", &matrix).unwrap();
        let (b, x) = (vec![[0.0_f32; 4]; n as usize], vec![[7.0, -0.3, 1e6, 0.0]; n as usize]);
        let [b, x] = [&b, &x].map(|values| card.buffer("a vector", values).unwrap());
        let y = room(&card, n as usize);
        card.submit(&sliced.springs_residual(&card, &b, &x, &y).unwrap());
        let found: Vec<Vec<Four>> = card.read(&[(&y, n as usize)]).unwrap();
        for y in &found[0] {
            for (y, x) in y.iter().zip([7.0, -0.3, 1e6]) {
                assert!((f64::from(*y) + 1e-9 * x).abs() < 1e-15 * f64::abs(x), "{y} of {x}");
            }
        }
    }

    #[test]
    fn products_of_the_other_kind_are_refused() {
        let Some(card) = card(0) else { return };
        let matrix = SparseRows::from_rows(1, [vec![(0, 1.0)]].into_iter());
        let x = room(&card, 1);
        let plain = Sliced::new(&card, "a matrix", &matrix).unwrap();
        assert!(plain.springs_residual(&card, &x, &x, &x).is_err());
        let springs = Sliced::springs(&card, "a matrix", &matrix).unwrap();
        assert!(springs.image(&card, &x, &x).is_err());
        assert!(plain.corrected(&card, 1.0, [&x, &x, &x]).is_err());
        let two = Sliced::prolongation(&card, "two matrices", &matrix, &matrix).unwrap();
        assert!(two.image(&card, &x, &x).is_err());
    }

    #[test]
    fn matrices_need_not_be_square() {
        let Some(card) = card(0) else { return };
        for (rows, columns, most) in [(70, 900, 60), (900, 70, 5), (3, 5000, 2000)] {
            let mut random = Random(5);
            let matrix = matrix(&mut random, rows, columns, most);
            let sliced = Sliced::new(&card, "a matrix", &matrix).unwrap();
            let x = random.vector(columns);
            let (on_x, y) = (card.buffer("a vector", &x).unwrap(), room(&card, rows));
            card.submit(&sliced.image(&card, &on_x, &y).unwrap());
            check(&matrix, &x, &card.read(&[(&y, rows)]).unwrap()[0], |_, _, sum| sum, "A x");
        }
    }

    #[test]
    fn pages_change_no_bit() {
        let found = |binding_bytes: u64, most: u64| {
            let card = card(binding_bytes)?;
            let mut random = Random(7);
            let matrix = matrix(&mut random, 3001, 3001, most);
            let plain = Sliced::new(&card, "a matrix", &matrix).unwrap();
            let springs = Sliced::springs(&card, "a matrix", &matrix).unwrap();
            let [x, y, z] = std::array::from_fn(|_| card.buffer("a vector", &random.vector(3001)).unwrap());
            card.submit(&plain.image(&card, &x, &y).unwrap());
            card.submit(&springs.springs_residual(&card, &x, &y, &z).unwrap());
            let bits = |y: &Four| y.map(f32::to_bits);
            let found: Vec<Vec<Four>> = card.read(&[(&y, 3001), (&z, 3001)]).unwrap();
            Some((found.iter().flatten().map(bits).collect::<Vec<_>>(), plain.pages.len(), springs.pages.len()))
        };
        for most in [20, 200] {
            let Some((whole, plain, springs)) = found(0, most) else { return };
            assert_eq!([plain, springs], [1, 1]);
            // Room for the vectors.
            let Some((cut, plain, springs)) = found(50_000, most) else { return };
            assert!(plain > 3 && springs > 3, "{plain} and {springs} pages");
            assert!(cut == whole, "{plain} pages change bits, with up to {most} entries in a row");
        }
    }

    #[test]
    fn what_is_too_large_for_a_binding_is_refused() {
        let Some(card) = card(4096) else { return };
        // One slice, of 4 rows that 16 threads share each, takes 32 kB.
        let matrix = SparseRows::from_rows(2000, (0..4).map(|_| (0..2000).map(|j| (j, 1.0)).collect()));
        let error = Sliced::new(&card, "the matrix", &matrix).err().unwrap();
        assert_eq!(error.status(), crate::error::Status::BackendUnavailable);
        assert!(error.to_string().contains("the matrix takes"), "{error}");
    }
}
