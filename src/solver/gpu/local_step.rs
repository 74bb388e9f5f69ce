//! The local step on the card: one kernel per type, whose threads project one constraint each.
//!
//! Constraints of one type with as many points and numbers form a *bucket*, one run of the type's kernel; a bucket whose
//! arrays would exceed a binding is cut. What buckets make lies in *pages*, buffers that a binding can hold.

use std::collections::BTreeMap;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::card::{Access, Card, Run, THREADS};
use super::frame::{Four, Frame, vector};
use crate::constraints::{Batch, ConstraintSet, Kernel, RowUnit, Rows};
use crate::error::Result;

/// The text that all projections begin with.
const CONSTRAINT: &str = include_str!("shaders/constraint.wgsl");

/// Where the points of constraints are.
pub(super) const POINTS: &str = include_str!("shaders/points.wgsl");

/// The decompositions that they share.
const LINEAR_ALGEBRA: &str = include_str!("shaders/linear_algebra.wgsl");

/// What kernels bind, in the order of `constraint.wgsl`.
const ACCESSES: [Access; 7] =
    [Access::Uniform, Access::Read, Access::Read, Access::Read, Access::Read, Access::Read, Access::Write];

/// What a bucket writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wants {
    /// The pull `s Aᵀ e` on each point, in `w` a share of the energy.
    Pulls,
    /// The residual `e` of each row, in `w` its energy.
    Rows,
}

/// Where points are at the last upload, and how far they have gone since.
pub(super) struct PointBuffers {
    pub(super) base: wgpu::Buffer,
    pub(super) shift: wgpu::Buffer,
}

/// Constraints that one run projects.
pub(super) struct Bucket {
    /// The type.
    pub(super) batch: usize,
    pub(super) slots: Vec<u32>,
    /// Points of each, and results of each: one per point, or one per row.
    pub(super) points: usize,
    pub(super) results: usize,
    pub(super) page: usize,
    /// The first result in its page. Result `n` of constraint `i` is at `first + n * slots.len() + i`.
    pub(super) first: usize,
}

/// See `struct Batch` in `constraint.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Numbers {
    count: u32,
    points: u32,
    rows: u32,
    coefficients: u32,
    first: u32,
    wants_rows: u32,
}

/// The projections of all constraints that have kernels.
pub(super) struct LocalStep {
    pub(super) buckets: Vec<Bucket>,
    /// What they write, and how many results.
    pub(super) pages: Vec<(wgpu::Buffer, usize)>,
    pub(super) runs: Vec<Run>,
}

impl PointBuffers {
    pub(super) fn new(card: &Card, count: usize) -> Result<Self> {
        let bytes = (count * size_of::<Four>()) as u64;
        Ok(Self { base: card.room("the points", bytes)?, shift: card.room("the points' moves", bytes)? })
    }

    pub(super) fn upload(&self, card: &Card, frame: &Frame, points: &[DVec3]) -> Vec<Four> {
        let (base, shift): (Vec<Four>, Vec<Four>) = points.iter().map(|point| frame.split(*point).into()).unzip();
        card.write(&self.base, &base);
        card.write(&self.shift, &shift);
        base
    }
}

/// The row unit of a type on the card, in model units.
pub(super) fn row_unit(kernel: Kernel, size: f64) -> f64 {
    match kernel {
        Kernel::Wgsl(_, RowUnit::Ratio) => size,
        _ => 1.0,
    }
}

/// The buckets of all types whose kernel is `wanted`, without constraints of stiffness 0, and the results of each page.
pub(super) fn buckets(
    constraints: &ConstraintSet,
    stiffness: &[Vec<f64>],
    wanted: impl Fn(Kernel) -> bool,
    wants: Wants,
    binding_bytes: u64,
) -> (Vec<Bucket>, Vec<usize>) {
    let most_results = (binding_bytes / size_of::<Four>() as u64).max(1) as usize;
    let (mut buckets, mut pages): (Vec<Bucket>, Vec<usize>) = (Vec::new(), Vec::new());
    for (index, (batch, _)) in constraints.batches().enumerate() {
        if !wanted(batch.kernel()) {
            continue;
        }
        let mut alike: BTreeMap<(usize, usize), Vec<u32>> = BTreeMap::new();
        for slot in (0..batch.len()).filter(|&slot| stiffness[index][slot] > 0.0) {
            let key = (batch.indices(slot).len(), batch.scalars(slot).len());
            alike.entry(key).or_default().push(slot as u32);
        }
        for ((points, _), slots) in alike {
            let results = if wants == Wants::Pulls { points } else { batch.info().rows.count(points) };
            let first_slot = slots.first().map_or(0, |slot| *slot as usize);
            let mut numbers = Vec::new();
            batch.kernel_numbers(first_slot, 1.0, &mut numbers);
            numbers.extend(batch.kernel_place(first_slot).iter().flat_map(|_| [0.0; 6]));
            // Results are four numbers, all else is one. The same cut whatever is wanted.
            let rows = batch.info().rows.count(points);
            let widest = points.max(rows).max(numbers.len().div_ceil(4)).max(1);
            for part in slots.chunks((most_results / widest).max(1)) {
                let count = part.len() * results;
                if pages.last().is_none_or(|used| used + count > most_results) {
                    pages.push(0);
                }
                let page = pages.len() - 1;
                let first = pages[page];
                buckets.push(Bucket { batch: index, slots: part.to_vec(), points, results, page, first });
                pages[page] += count;
            }
        }
    }
    (buckets, pages)
}

/// Room for so many results on each page.
pub(super) fn pages(card: &Card, name: &str, counts: &[usize]) -> Result<Vec<(wgpu::Buffer, usize)>> {
    counts.iter().map(|&count| Ok((card.room(name, (count * size_of::<Four>()) as u64)?, count))).collect()
}

impl LocalStep {
    /// `stiffness` is by batch and slot, `points` are what the constraints' indices refer to.
    pub(super) fn new(
        card: &Card,
        constraints: &ConstraintSet,
        stiffness: &[Vec<f64>],
        frame: &Frame,
        points: &PointBuffers,
        wants: Wants,
    ) -> Result<Self> {
        let has_kernel = |kernel| matches!(kernel, Kernel::Wgsl(..));
        let (buckets, counts) = buckets(constraints, stiffness, has_kernel, wants, card.binding_bytes());
        let pages = pages(card, "the projections", &counts)?;
        let run = |bucket: &Bucket| {
            let batch = constraints.batch(bucket.batch);
            bucket.run(card, batch, &stiffness[bucket.batch], frame, points, &pages[bucket.page].0, wants)
        };
        let runs = buckets.iter().map(run).collect::<Result<_>>()?;
        Ok(Self { buckets, pages, runs })
    }
}

impl Bucket {
    #[allow(clippy::too_many_arguments, reason = "each is another thing")]
    pub(super) fn run(
        &self,
        card: &Card,
        batch: &dyn Batch,
        stiffness: &[f64],
        frame: &Frame,
        points: &PointBuffers,
        page: &wgpu::Buffer,
        wants: Wants,
    ) -> Result<Run> {
        let (Kernel::Wgsl(text, _), name) = (batch.kernel(), batch.info().name) else {
            return Err(super::internal("a type without a kernel is in a bucket"));
        };
        let kernel = card.kernel(name, &[CONSTRAINT, POINTS, LINEAR_ALGEBRA, text, THREADS], &ACCESSES)?;
        let count = self.slots.len();
        let mut indices = vec![0_u32; count * self.points];
        let mut own = Vec::new();
        let mut numbers = Vec::new();
        for (i, &slot) in self.slots.iter().enumerate() {
            batch.indices(slot as usize).iter().enumerate().for_each(|(j, point)| indices[j * count + i] = *point);
            own.clear();
            batch.kernel_numbers(slot as usize, frame.size, &mut own);
            if let Some(place) = batch.kernel_place(slot as usize) {
                own.extend(frame.split(place).iter().flat_map(|part| &part[..3]).map(|number| f64::from(*number)));
            }
            numbers.resize(own.len() * count, 0.0);
            own.iter().enumerate().for_each(|(n, number)| numbers[n * count + i] = single(*number));
        }
        let unit = row_unit(batch.kernel(), frame.size);
        let of_slot = |slot: &u32| (stiffness[*slot as usize] / (unit * unit)) as f32;
        let stiffness: Vec<f32> = self.slots.iter().map(of_slot).collect();
        let rows = batch.info().rows.count(self.points);
        let is_linear = matches!(batch.info().rows, Rows::Linear(_));
        let uniform = card.uniform(&Numbers {
            count: count as u32,
            points: self.points as u32,
            rows: rows as u32,
            coefficients: if is_linear { (rows * self.points) as u32 } else { 0 },
            first: self.first as u32,
            wants_rows: u32::from(wants == Wants::Rows),
        });
        let indices = card.buffer("the indices of constraints", &indices)?;
        let numbers = card.buffer("the numbers of constraints", &numbers)?;
        let stiffness = card.buffer("the weights of constraints", &stiffness)?;
        let buffers = [&uniform, &points.base, &points.shift, &indices, &numbers, &stiffness, page];
        Ok(card.run_of(&kernel, &buffers, count))
    }
}

/// The nearest finite number of single precision: bounds that mean none can be as large as they like.
fn single(number: f64) -> f32 {
    number.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32
}

/// What is nearest to `A x` of every constraint, as the card finds it; the means of centred ones taken off. By type, slot and row.
/// Types without a kernel have none.
pub(in crate::solver) fn projections(
    card: &Card,
    constraints: &ConstraintSet,
    points: &[DVec3],
) -> Result<Vec<Option<Vec<DVec3>>>> {
    let frame = Frame::of(points);
    let buffers = PointBuffers::new(card, points.len())?;
    buffers.upload(card, &frame, points);
    let stiffness: Vec<Vec<f64>> = constraints.batches().map(|(batch, _)| vec![1.0; batch.len()]).collect();
    let step = LocalStep::new(card, constraints, &stiffness, &frame, &buffers, Wants::Rows)?;
    card.submit(&step.runs);
    let pages: Vec<_> = step.pages.iter().map(|(buffer, count)| (buffer, *count)).collect();
    let results: Vec<Vec<Four>> = card.read(&pages)?;
    let room = |(batch, _): (&dyn Batch, &[f64])| {
        matches!(batch.kernel(), Kernel::Wgsl(..)).then(|| vec![DVec3::ZERO; batch.target_offset(batch.len())])
    };
    let mut found: Vec<_> = constraints.batches().map(room).collect();
    for bucket in &step.buckets {
        let batch = constraints.batch(bucket.batch);
        let Some(targets) = &mut found[bucket.batch] else { continue };
        let factor = frame.size / row_unit(batch.kernel(), frame.size);
        for (i, &slot) in bucket.slots.iter().enumerate() {
            let first = batch.target_offset(slot as usize);
            let images = images(batch, slot as usize, points);
            for (n, image) in images.into_iter().enumerate() {
                let residual = results[bucket.page][bucket.first + n * bucket.slots.len() + i];
                targets[first + n] = image + factor * vector(residual);
            }
        }
    }
    Ok(found)
}

/// `A x` of one constraint.
pub(super) fn images(batch: &dyn Batch, slot: usize, points: &[DVec3]) -> Vec<DVec3> {
    let at = |index: &u32| points[*index as usize];
    let indices = batch.indices(slot);
    let first = at(&indices[0]);
    match batch.info().rows {
        Rows::Centred => {
            let mean = indices.iter().map(|index| at(index) - first).sum::<DVec3>() / indices.len() as f64;
            indices.iter().map(|index| at(index) - first - mean).collect()
        }
        Rows::Linear(_) => {
            let row = |row: &[f64]| row.iter().zip(indices).map(|(a, index)| *a * at(index)).sum();
            batch.rows(slot).chunks_exact(indices.len()).map(row).collect()
        }
        Rows::Pairs => indices.chunks_exact(2).map(|pair| at(&pair[1]) - at(&pair[0])).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraints::types;
    use crate::solver::Solver;
    use crate::solver::gpu::tests::card;

    /// More than a workgroup of constraints of one type, off rest, with weights of their own; `None` if it takes a shape.
    fn model(type_name: &str, points_each: usize) -> Option<(Solver, Vec<f64>)> {
        const COUNT: usize = 70;
        // Points as irregular as they come, without two alike.
        let place = |n: usize, phase: f64| {
            let at = |step: f64| (n as f64 * step + phase).sin();
            DVec3::new(at(1.7), at(2.9), at(4.3)) + 0.3 * DVec3::new(at(11.1), at(7.7), at(5.9))
        };
        let points = |phase: f64| (0..COUNT * points_each).map(|n| 5.0 * place(n, phase)).collect::<Vec<_>>();
        let mut solver = Solver::new();
        solver.set_points(&points(0.0)).unwrap();
        for i in 0..COUNT {
            let indices: Vec<u32> = (i * points_each..(i + 1) * points_each).map(|n| n as u32).collect();
            solver.add_constraint(type_name, &indices, 1.0).ok()?;
        }
        solver.set_points(&points(0.4)).unwrap();
        Some((solver, (0..COUNT).map(|i| 1.0 + i as f64 / 10.0).collect()))
    }

    /// Residuals, in the unit of rows on the card, below which round-off is as large.
    const LEAST_RESIDUAL: f64 = 5e-2;

    /// True for the types whose residuals can have a mean.
    fn has_mean(type_name: &str) -> bool {
        ["Circle", "Sphere"].contains(&type_name)
    }

    /// `s Aᵀ e` on each point, of constraint `slot` with residuals `e` in the card's unit.
    fn pulls(batch: &dyn Batch, slot: usize, s: f64, unit: f64, residuals: &[DVec3]) -> Vec<DVec3> {
        let k = batch.indices(slot).len();
        let s = s / (unit * unit);
        match batch.info().rows {
            Rows::Centred => {
                let mean = residuals.iter().sum::<DVec3>() / k as f64;
                residuals.iter().map(|residual| s * (*residual - mean)).collect()
            }
            Rows::Linear(_) => {
                let rows = || batch.rows(slot).chunks_exact(k).zip(residuals);
                (0..k).map(|j| s * rows().map(|(row, e)| unit * row[j] * *e).sum::<DVec3>()).collect()
            }
            Rows::Pairs => residuals.iter().flat_map(|residual| [-s * *residual, s * *residual]).collect(),
        }
    }

    fn results(solver: &Solver, card: &Card, stiffness: &[Vec<f64>], wants: Wants) -> (LocalStep, Vec<Vec<Four>>) {
        let frame = Frame::of(&solver.points);
        let buffers = PointBuffers::new(card, solver.points.len()).unwrap();
        buffers.upload(card, &frame, &solver.points);
        let step = LocalStep::new(card, &solver.constraints, stiffness, &frame, &buffers, wants).unwrap();
        card.submit(&step.runs);
        let pages: Vec<_> = step.pages.iter().map(|(buffer, count)| (buffer, *count)).collect();
        let results = card.read(&pages).unwrap();
        (step, results)
    }

    /// Compares what kernels add to points with the residuals that they tell, whichever way they write them.
    #[test]
    fn pulls_and_energies_are_those_of_the_residuals() {
        let Some(card) = card(0) else { return };
        let mut compared = 0;
        for info in types() {
            for k in [info.least_indices, info.greatest_indices.unwrap_or(6)] {
                let Some((solver, stiffness)) = model(info.name, k) else { continue };
                let of_batch = |(batch, _): (&dyn Batch, &[f64])| stiffness[..batch.len()].to_vec();
                let stiffness: Vec<Vec<f64>> = solver.constraints.batches().map(of_batch).collect();
                let (step, of_rows) = results(&solver, &card, &stiffness, Wants::Rows);
                let (_, of_points) = results(&solver, &card, &stiffness, Wants::Pulls);
                let size = Frame::of(&solver.points).size;
                for bucket in &step.buckets {
                    let batch = solver.constraints.batch(bucket.batch);
                    let unit = row_unit(batch.kernel(), size);
                    for (i, &slot) in bucket.slots.iter().enumerate() {
                        let own = |page: &[Four], count: usize| -> Vec<Four> {
                            (0..count).map(|n| page[bucket.first + n * bucket.slots.len() + i]).collect()
                        };
                        let (rows, found) = (own(&of_rows[0], bucket.results), own(&of_points[0], k));
                        let residuals: Vec<DVec3> = rows.iter().map(|row| vector(*row)).collect();
                        let s = stiffness[bucket.batch][slot as usize];
                        let expected = pulls(batch, slot as usize, s, unit, &residuals);
                        // Where nothing pulls, round-off of coordinates does.
                        let least = s / (unit * unit) * LEAST_RESIDUAL;
                        let most = expected.iter().map(|pull| pull.length()).fold(least, f64::max);
                        for (expected, found) in expected.iter().zip(&found) {
                            let off = expected.distance(vector(*found));
                            assert!(off <= 1e-5 * most, "{} {slot}: {expected} {found:?}", info.name);
                        }
                        let energy = |all: &[Four]| all.iter().map(|four| f64::from(four[3])).sum::<f64>();
                        let expected: f64 =
                            residuals.iter().map(|e| 0.5 * s / (unit * unit) * e.length_squared()).sum();
                        let most = expected.max(0.5 * least * LEAST_RESIDUAL);
                        for found in [energy(&rows), energy(&found)] {
                            let off = found - expected;
                            // Residuals are told without their mean, and energies with it.
                            let is_near = off <= 1e-5 * most;
                            let is_above = off >= -1e-5 * most;
                            assert!(is_above && (is_near || has_mean(info.name)), "{}: {expected} {found}", info.name);
                        }
                        compared += usize::from(expected > 0.0);
                    }
                }
            }
        }
        assert!(compared > 1000, "only {compared} had residuals");
    }
}
