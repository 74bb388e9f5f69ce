//! Hard constraints on the card: the sweeps of the splitting method, see `exploration/splitting.rs`, whose names these are.
//!
//! Every hard constraint has points of its own, on which its kernel works, and rows `s` that its row images are held to. Before
//! the global step `hold` pulls the points towards the rows; after it `place` moves the own points, their type's kernel
//! projects them, and `advance` takes the step of the rows.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::card::{Access, Card, Run, THREADS};
use super::frame::{Four, Frame, four, vector};
use super::gather;
use super::local_step::{Bucket, LocalStep, POINTS, PointBuffers, Wants, buckets, pages, row_unit};
use crate::constraints::{Batch, ConstraintSet, Kernel};
use crate::error::Result;

/// The hard constraints of a model.
pub(in crate::solver) struct HardParts<'a> {
    /// With the indices of the model's points.
    pub(in crate::solver) set: &'a ConstraintSet,
    /// With points of their own: consecutive numbers, batch after batch and slot after slot.
    pub(in crate::solver) own: &'a ConstraintSet,
    /// `A`, and `A⁺` with a row per point, of a constraint by its number in that order; `None` where the rows are centred.
    pub(in crate::solver) matrices: &'a dyn Fn(usize) -> Option<(&'a [f64], &'a [f64])>,
    /// The penalty times the squared scale, by batch and slot.
    pub(in crate::solver) stiffness: &'a [Vec<f64>],
    /// What rows times it are lengths, by number.
    pub(in crate::solver) scales: &'a [f64],
    pub(in crate::solver) relaxation: f64,
}

/// See `struct Hard` in `hard.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Numbers {
    count: u32,
    points: u32,
    rows: u32,
    is_dense: u32,
    first_row: u32,
    first_pull: u32,
    is_fixed: u32,
    relaxation: f32,
}

/// The same constraints in all steps.
struct Group {
    rows: Bucket,
    /// By constraint: its number, where its rows begin among all, and the unit of its rows in lengths of the card.
    numbers: Vec<u32>,
    first_rows: Vec<usize>,
    unit: f64,
    /// `A` of the middle of the frame, by constraint and row.
    offsets: Vec<DVec3>,
    reach: wgpu::Buffer,
}

/// The state of all hard constraints.
pub(super) struct HardStep {
    groups: Vec<Group>,
    /// `s`, on pages.
    held: Vec<(wgpu::Buffer, usize)>,
    own: PointBuffers,
    /// The model's points behind the own ones.
    own_indices: Vec<u32>,
    scales: Vec<f64>,
    row_count: usize,
}

/// What the steps of one group are made of.
struct Making<'a, 'b> {
    card: &'a Card,
    parts: &'a HardParts<'b>,
    points: &'a PointBuffers,
    own: &'a PointBuffers,
    /// Pages of rows: `s`, `A x − s`, `e`; and of pulls.
    held: &'a [(wgpu::Buffer, usize)],
    gaps: &'a [(wgpu::Buffer, usize)],
    residuals: &'a [(wgpu::Buffer, usize)],
    pulls: &'a [(wgpu::Buffer, usize)],
    own_count: usize,
}

const HARD: &str = include_str!("shaders/hard.wgsl");
const ROWS: &str = include_str!("shaders/rows.wgsl");

impl HardStep {
    /// The state, and the runs before and after the global step. `sums` are what pulls are added to.
    pub(super) fn new(
        card: &Card,
        parts: &HardParts<'_>,
        frame: &Frame,
        points: (&PointBuffers, usize),
        sums: &wgpu::Buffer,
    ) -> Result<(Self, [Vec<Run>; 2])> {
        let (points, point_count) = points;
        let all = |_: Kernel| true;
        let ones: Vec<Vec<f64>> = parts.set.batches().map(|(batch, _)| vec![1.0; batch.len()]).collect();
        let cut = |wants| buckets(parts.set, &ones, all, wants, card.binding_bytes());
        let ((row_buckets, row_counts), (pull_buckets, pull_counts)) = (cut(Wants::Rows), cut(Wants::Pulls));
        let own_indices: Vec<u32> = parts
            .set
            .batches()
            .flat_map(|(batch, _)| (0..batch.len()).flat_map(move |slot| batch.indices(slot).to_vec()))
            .collect();
        let own = PointBuffers::new(card, own_indices.len())?;
        let rows_of = |name| pages(card, name, &row_counts);
        let (held, gaps, residuals) = (rows_of("the rows")?, rows_of("the gaps")?, rows_of("the residuals")?);
        let pulls = pages(card, "the pulls of hard constraints", &pull_counts)?;
        let (numbers, first_rows, row_count) = numbering(parts.set);
        let making = Making {
            card,
            parts,
            points,
            own: &own,
            held: &held,
            gaps: &gaps,
            residuals: &residuals,
            pulls: &pulls,
            own_count: own_indices.len(),
        };
        let (mut groups, mut holding, mut placing, mut projecting, mut advancing) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (rows, pull) in row_buckets.into_iter().zip(&pull_buckets) {
            let batch = parts.set.batch(rows.batch);
            let of = |list: &[Vec<usize>]| -> Vec<usize> {
                rows.slots.iter().map(|slot| list[rows.batch][*slot as usize]).collect()
            };
            let own_numbers: Vec<u32> = of(&numbers).into_iter().map(|number| number as u32).collect();
            let unit = row_unit(batch.kernel(), frame.size);
            let offsets = offsets(batch, &rows, frame.middle);
            let group = Group {
                numbers: own_numbers,
                first_rows: of(&first_rows),
                unit,
                offsets,
                reach: card.room("the reach of hard constraints", (rows.slots.len() * size_of::<f32>()) as u64)?,
                rows,
            };
            making.runs(&group, pull, frame, [&mut holding, &mut placing, &mut projecting, &mut advancing])?;
            groups.push(group);
        }
        let gathering = LocalStep { buckets: pull_buckets, pages: pulls, runs: Vec::new() };
        holding.extend(gather::runs(card, parts.set, &gathering, point_count, sums)?);
        placing.extend(projecting);
        placing.extend(advancing);
        let scales = parts.scales.to_vec();
        Ok((Self { groups, held, own, own_indices, scales, row_count }, [holding, placing]))
    }

    /// Brings the own points to where the model's points were uploaded.
    pub(super) fn upload_base(&self, card: &Card, base: &[Four]) {
        let own: Vec<Four> = self.own_indices.iter().map(|index| base[*index as usize]).collect();
        card.write(&self.own.base, &own);
    }

    /// Begins with the rows `s`, in the order of batches and slots, and how far each constraint's multiplier reaches: its cap over
    /// the penalty, by number.
    pub(super) fn upload(&self, card: &Card, frame: &Frame, rows: &[DVec3], reaches: &[f64]) {
        let mut pages: Vec<Vec<Four>> = self.held.iter().map(|(_, count)| vec![[0.0; 4]; *count]).collect();
        for group in &self.groups {
            let (bucket, factor) = (&group.rows, group.unit / frame.size);
            let count = bucket.slots.len();
            for (i, &first) in group.first_rows.iter().enumerate() {
                for r in 0..bucket.results {
                    let row = factor * (rows[first + r] - group.offsets[i * bucket.results + r]);
                    pages[bucket.page][bucket.first + r * count + i] = four(row);
                }
            }
            // Lengths of rows on the card are `factor` times those in the type's unit.
            let reach = |number: &u32| (reaches[*number as usize] * factor / self.scales[*number as usize]) as f32;
            card.write(&group.reach, &group.numbers.iter().map(reach).collect::<Vec<f32>>());
        }
        for ((buffer, _), page) in self.held.iter().zip(&pages) {
            card.write(buffer, page);
        }
    }

    /// The rows `s` as they are.
    ///
    /// # Errors
    /// Status `BackendFailed`.
    pub(super) fn read(&self, card: &Card, frame: &Frame) -> Result<Vec<DVec3>> {
        let buffers: Vec<_> = self.held.iter().map(|(buffer, count)| (buffer, *count)).collect();
        let pages: Vec<Vec<Four>> = card.read(&buffers)?;
        let mut rows = vec![DVec3::ZERO; self.row_count];
        for group in &self.groups {
            let (bucket, factor) = (&group.rows, frame.size / group.unit);
            let count = bucket.slots.len();
            for (i, &first) in group.first_rows.iter().enumerate() {
                for r in 0..bucket.results {
                    let held = vector(pages[bucket.page][bucket.first + r * count + i]);
                    rows[first + r] = factor * held + group.offsets[i * bucket.results + r];
                }
            }
        }
        Ok(rows)
    }
}

/// The number of each constraint and where its rows begin, by batch and slot; and the number of rows.
fn numbering(set: &ConstraintSet) -> (Vec<Vec<usize>>, Vec<Vec<usize>>, usize) {
    let (mut numbers, mut first_rows) = (Vec::new(), Vec::new());
    let (mut number, mut row) = (0, 0);
    for (batch, _) in set.batches() {
        let count = batch.len();
        numbers.push((number..number + count).collect());
        first_rows.push((0..count).map(|slot| row + batch.target_offset(slot)).collect());
        number += count;
        row += batch.target_offset(count);
    }
    (numbers, first_rows, row)
}

/// `A` of a point that all points are at, by constraint and row.
fn offsets(batch: &dyn Batch, bucket: &Bucket, point: DVec3) -> Vec<DVec3> {
    let of_slot = |slot: &u32| -> Vec<DVec3> {
        let rows = batch.rows(*slot as usize);
        if rows.is_empty() {
            return vec![DVec3::ZERO; bucket.results];
        }
        rows.chunks_exact(bucket.points).map(|row| row.iter().sum::<f64>() * point).collect()
    };
    bucket.slots.iter().flat_map(of_slot).collect()
}

impl Making<'_, '_> {
    /// Appends the runs of one group to those that hold, place, project and advance.
    fn runs(&self, group: &Group, pull: &Bucket, frame: &Frame, runs: [&mut Vec<Run>; 4]) -> Result<()> {
        let Self { card, parts, points, own, .. } = *self;
        let [holding, placing, projecting, advancing] = runs;
        let bucket = &group.rows;
        let (batch, own_batch) = (parts.set.batch(bucket.batch), parts.own.batch(bucket.batch));
        let count = bucket.slots.len();
        let by_structure = |width: usize, value: &dyn Fn(usize, usize) -> f64| -> Vec<f32> {
            (0..width * count).map(|place| value(place % count, place / count) as f32).collect()
        };
        let is_dense = (parts.matrices)(group.numbers[0] as usize).is_some();
        let size = bucket.points * bucket.results;
        let numbers = by_structure(if is_dense { 2 * size } else { 0 }, &|i, n| {
            let Some((a, inverse)) = (parts.matrices)(group.numbers[i] as usize) else { return 0.0 };
            if n < size { group.unit * a[n] } else { inverse[n - size] / group.unit }
        });
        let mut indices = vec![0_u32; count * bucket.points];
        for (i, &slot) in bucket.slots.iter().enumerate() {
            batch.indices(slot as usize).iter().enumerate().for_each(|(j, point)| indices[j * count + i] = *point);
        }
        let squared_unit = group.unit * group.unit;
        let stiffness = by_structure(1, &|i, _| parts.stiffness[bucket.batch][bucket.slots[i] as usize] / squared_unit);
        let own_first: Vec<u32> = bucket.slots.iter().map(|slot| own_batch.indices(*slot as usize)[0]).collect();
        let is_fixed = batch.kernel() == Kernel::Constant;
        let uniform = card.uniform(&Numbers {
            count: count as u32,
            points: bucket.points as u32,
            rows: bucket.results as u32,
            is_dense: u32::from(is_dense),
            first_row: bucket.first as u32,
            first_pull: pull.first as u32,
            is_fixed: u32::from(is_fixed),
            relaxation: parts.relaxation as f32,
        });
        let numbers = card.buffer("the rows of hard constraints", &numbers)?;
        let indices = card.buffer("the indices of hard constraints", &indices)?;
        let stiffness = card.buffer("the penalties of hard constraints", &stiffness)?;
        let own_first = card.buffer("the own points of hard constraints", &own_first)?;
        let page = bucket.page;
        let (held, gap, residual) = (&self.held[page].0, &self.gaps[page].0, &self.residuals[page].0);
        let pulls = &self.pulls[pull.page].0;

        let (uniform_access, read, write) = (Access::Uniform, Access::Read, Access::Write);
        let accesses = [uniform_access, read, read, read, read, read, read, write, write];
        let kernel =
            card.kernel("hold", &[HARD, POINTS, ROWS, include_str!("shaders/hold.wgsl"), THREADS], &accesses)?;
        let buffers = [&uniform, &points.base, &points.shift, &indices, &numbers, &stiffness, held, gap, pulls];
        holding.push(card.run_of(&kernel, &buffers, count));

        let kernel =
            card.kernel("place", &[HARD, POINTS, ROWS, include_str!("shaders/place.wgsl"), THREADS], &accesses)?;
        let buffers = [&uniform, &points.base, &points.shift, &indices, &numbers, held, &own_first, gap, &own.shift];
        placing.push(card.run_of(&kernel, &buffers, count));

        if is_fixed {
            self.write_fixed(group, own_batch, frame);
        } else {
            let ones = vec![1.0; own_batch.len()];
            projecting.push(bucket.run(card, own_batch, &ones, frame, own, residual, Wants::Rows)?);
        }
        let kernel = card.kernel(
            "advance",
            &[HARD, include_str!("shaders/advance.wgsl"), THREADS],
            &[uniform_access, read, read, read, write],
        )?;
        advancing.push(card.run_of(&kernel, &[&uniform, residual, gap, &group.reach, held], count));
        Ok(())
    }

    /// Writes the targets of a type whose targets do not depend on the points.
    fn write_fixed(&self, group: &Group, batch: &dyn Batch, frame: &Frame) {
        let bucket = &group.rows;
        let count = bucket.slots.len();
        let anywhere = vec![DVec3::ZERO; self.own_count];
        let mut targets = vec![DVec3::ZERO; bucket.results];
        let mut fixed: Vec<Four> = vec![[0.0; 4]; count * bucket.results];
        for (i, &slot) in bucket.slots.iter().enumerate() {
            batch.project(slot as usize..slot as usize + 1, &anywhere, &mut targets);
            for (r, target) in targets.iter().enumerate() {
                let offset = group.offsets[i * bucket.results + r];
                fixed[r * count + i] = four(group.unit / frame.size * (*target - offset));
            }
        }
        self.card.write_from(&self.residuals[bucket.page].0, bucket.first * size_of::<Four>(), &fixed);
    }
}
