//! All constraints of one type in flat arrays.

use std::any::Any;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::deformation::{Deformation, gradient_four};
use super::lists::Lists;
use super::{Constraint, Four, Kernel, ReferenceShape, RowUnit, Rows, Scalars, Stencil, TypeInfo};
use crate::linalg::lanes::{self, F4, Mask, V4};
use crate::linalg::simd::{Isa, LaneKernel, dispatch_lanes};

/// All constraints of one type. A *slot* is a constraint's place in the batch; removing constraints moves the later ones
/// down, so slots change where ids do not.
pub(crate) trait Batch: Any + Send + Sync {
    /// What is known of the type.
    fn info(&self) -> &'static TypeInfo;

    /// The number of slots.
    fn len(&self) -> usize;

    /// Appends a constraint on the points `indices`, at rest where `points` are now, with the reference of types that have one.
    fn push(&mut self, points: &[DVec3], indices: &[u32], reference: Option<&Arc<ReferenceShape>>);

    /// Drops the slots where `keep` is false. `keep` has one entry per slot.
    fn retain(&mut self, keep: &[bool]);

    /// The point indices of a slot.
    fn indices(&self, slot: usize) -> &[u32];

    /// Gives every constraint points of its own: its indices become consecutive numbers from `first` on, slot after slot.
    /// Returns the number after the last.
    fn renumber(&mut self, first: u32) -> u32;

    /// The scalars in force of a slot.
    fn scalars(&self, slot: usize) -> &[f64];

    /// Replaces the scalars of a slot, which were checked, and the reference that they name. Returns true if the rows or the
    /// measure changed with them.
    fn set_scalars(&mut self, slot: usize, scalars: &[f64], reference: Option<&Arc<ReferenceShape>>) -> bool;

    /// The factor on the user's weight.
    fn measure(&self, slot: usize) -> f64;

    /// The row coefficients of a slot, row by row. Empty unless its rows are [`Rows::Linear`].
    fn rows(&self, slot: usize) -> &[f64];

    /// The position of the first target of a slot in the batch's targets; for `slot == len()`, their number.
    fn target_offset(&self, slot: usize) -> usize;

    /// Writes the projections of `slots` into `targets`, which starts at the first slot's first target.
    fn project(&self, slots: Range<usize>, points: &[DVec3], targets: &mut [DVec3]);

    /// `Σ stiffness[i] ‖A x − p‖²` over the constraints of `slots`, `p` being `targets` as `project` wrote them and
    /// `stiffness[0]` belonging to the first slot.
    fn squared_residual(&self, slots: Range<usize>, points: &[DVec3], targets: &[DVec3], stiffness: &[f64]) -> f64;

    /// Subtracts from the targets of each centred constraint of `slots` their mean; nothing for other types. Then they are
    /// their own image under `Aᵀ`.
    fn centre_targets(&self, slots: Range<usize>, targets: &mut [DVec3]);

    /// The violation of a slot, in the type's unit.
    fn violation(&self, slot: usize, points: &[DVec3]) -> f64;

    /// True if the rest state of a slot is degenerate.
    fn is_degenerate(&self, slot: usize) -> bool;

    /// How graphics cards project the type.
    #[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "asked by cards alone"))]
    fn kernel(&self) -> Kernel;

    /// Appends the numbers that the kernel reads of a slot: the coefficients of the rows, in the row unit of coordinates
    /// divided by `size`, then the type's own.
    #[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "asked by cards alone"))]
    fn kernel_numbers(&self, slot: usize, size: f64, numbers: &mut Vec<f64>);

    /// A place in the model that the kernel reads after the numbers.
    #[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "asked by cards alone"))]
    fn kernel_place(&self, slot: usize) -> Option<DVec3>;

    /// Bytes of what projecting all constraints reads besides the points: indices, scalars and rest states.
    fn byte_count(&self) -> usize;

    /// A copy of the whole batch.
    fn clone_box(&self) -> Box<dyn Batch>;
}

/// The batch of the type `T`.
#[derive(Clone, Debug)]
pub(super) struct TypedBatch<T> {
    rest: Vec<T>,
    indices: Lists<u32>,
    scalars: Lists<f64>,
    /// `row_count * k` per slot, row by row; nothing unless the rows are [`Rows::Linear`].
    coefficients: Vec<f64>,
}

impl<T: Constraint> TypedBatch<T> {
    pub(super) fn new_box() -> Box<dyn Batch> {
        Box::new(Self { rest: Vec::new(), indices: Lists::new(), scalars: Lists::new(), coefficients: Vec::new() })
    }

    fn stencil<'a>(&'a self, slot: usize, points: &'a [DVec3]) -> Stencil<'a> {
        T::INFO.rows.stencil(points, self.indices.get(slot))
    }

    /// The part of `coefficients` that belongs to `slot`.
    fn coefficient_range(&self, slot: usize) -> Range<usize> {
        // Both are linear in the number of points, so that those of all slots before are those of all their points.
        T::INFO.rows.stored_count(self.indices.start(slot))..T::INFO.rows.stored_count(self.indices.start(slot + 1))
    }

    fn computed_rows(&self, slot: usize) -> Vec<f64> {
        let mut coefficients = vec![0.0; self.coefficient_range(slot).len()];
        if !coefficients.is_empty() {
            self.rest[slot].rows(self.scalars.get(slot), &mut coefficients);
        }
        coefficients
    }
}

impl<T: Constraint> Batch for TypedBatch<T> {
    fn info(&self) -> &'static TypeInfo {
        &T::INFO
    }

    fn len(&self) -> usize {
        self.rest.len()
    }

    fn push(&mut self, points: &[DVec3], indices: &[u32], reference: Option<&Arc<ReferenceShape>>) {
        let stencil = T::INFO.rows.stencil(points, indices);
        let mut constraint = self.scalars.push_with(|scalars| T::at_rest(stencil, scalars));
        reference.into_iter().for_each(|shape| constraint.refer_to(shape));
        self.rest.push(constraint);
        self.indices.push_with(|all| all.extend_from_slice(indices));
        self.coefficients.extend(self.computed_rows(self.rest.len() - 1));
    }

    fn retain(&mut self, keep: &[bool]) {
        let kept = (0..self.len()).filter(|&slot| keep[slot]);
        self.coefficients = kept.flat_map(|slot| self.coefficients[self.coefficient_range(slot)].to_vec()).collect();
        let mut flags = keep.iter();
        self.rest.retain(|_| flags.next().copied().unwrap_or(true));
        self.indices.retain(keep);
        self.scalars.retain(keep);
    }

    fn indices(&self, slot: usize) -> &[u32] {
        self.indices.get(slot)
    }

    fn renumber(&mut self, first: u32) -> u32 {
        // No list of indices is ever replaced, so there are no gaps.
        (first..).zip(self.indices.values_mut()).for_each(|(number, index)| *index = number);
        first + self.indices.values().len() as u32
    }

    fn scalars(&self, slot: usize) -> &[f64] {
        self.scalars.get(slot)
    }

    fn set_scalars(&mut self, slot: usize, scalars: &[f64], reference: Option<&Arc<ReferenceShape>>) -> bool {
        let measure = self.measure(slot);
        self.scalars.replace(slot, scalars);
        self.rest[slot].scalars_changed(scalars);
        reference.into_iter().for_each(|shape| self.rest[slot].refer_to(shape));
        let (rows, range) = (self.computed_rows(slot), self.coefficient_range(slot));
        let changed = self.coefficients[range.clone()] != rows || self.measure(slot) != measure;
        self.coefficients[range].copy_from_slice(&rows);
        changed
    }

    fn measure(&self, slot: usize) -> f64 {
        self.rest[slot].measure(self.scalars.get(slot))
    }

    fn rows(&self, slot: usize) -> &[f64] {
        &self.coefficients[self.coefficient_range(slot)]
    }

    fn target_offset(&self, slot: usize) -> usize {
        match T::INFO.rows {
            Rows::Linear(row_count) => row_count * slot,
            rows => rows.count(self.indices.start(slot)),
        }
    }

    fn project(&self, slots: Range<usize>, points: &[DVec3], targets: &mut [DVec3]) {
        dispatch_lanes(Project { batch: self, slots, points, targets });
    }

    fn squared_residual(&self, slots: Range<usize>, points: &[DVec3], targets: &[DVec3], stiffness: &[f64]) -> f64 {
        dispatch_lanes(SquaredResidual { batch: self, slots, points, targets, stiffness })
    }

    fn centre_targets(&self, slots: Range<usize>, targets: &mut [DVec3]) {
        if T::INFO.rows != Rows::Centred || T::TARGETS_ARE_CENTRED {
            return;
        }
        let mut rest = targets;
        for slot in slots {
            let (own, later) = rest.split_at_mut(self.indices.get(slot).len());
            let mean = own.iter().sum::<DVec3>() / own.len() as f64;
            own.iter_mut().for_each(|target| *target -= mean);
            rest = later;
        }
    }

    fn violation(&self, slot: usize, points: &[DVec3]) -> f64 {
        self.rest[slot].violation(self.scalars.get(slot), self.stencil(slot, points))
    }

    fn is_degenerate(&self, slot: usize) -> bool {
        self.rest[slot].is_degenerate(self.scalars.get(slot))
    }

    fn kernel(&self) -> Kernel {
        T::KERNEL
    }

    fn kernel_numbers(&self, slot: usize, size: f64, numbers: &mut Vec<f64>) {
        let unit = if matches!(T::KERNEL, Kernel::Wgsl(_, RowUnit::Ratio)) { size } else { 1.0 };
        numbers.extend(self.rows(slot).iter().map(|a| a * unit));
        self.rest[slot].kernel_numbers(self.scalars.get(slot), size, numbers);
    }

    fn kernel_place(&self, slot: usize) -> Option<DVec3> {
        self.rest[slot].kernel_place(self.scalars.get(slot))
    }

    fn byte_count(&self) -> usize {
        let lists = size_of_val(self.indices.values()) + size_of_val(self.scalars.values());
        lists + size_of_val(&*self.rest)
    }

    fn clone_box(&self) -> Box<dyn Batch> {
        Box::new(self.clone())
    }
}

/// The projection of some slots, four at a time where the type can.
struct Project<'a, T> {
    batch: &'a TypedBatch<T>,
    slots: Range<usize>,
    points: &'a [DVec3],
    targets: &'a mut [DVec3],
}

impl<T: Constraint> LaneKernel for Project<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Isa>(self, simd: S) {
        let Self { batch, slots, points, targets } = self;
        let first = batch.target_offset(slots.start);
        let mut slot = slots.start;
        while slot < slots.end {
            let k = batch.indices.get(slot).len();
            let targets = &mut targets[batch.target_offset(slot) - first..];
            let mut is_done = None;
            if slot + 4 <= slots.end && T::takes_four(k) {
                is_done = batch.project_four(simd, slot, k, points, targets);
            }
            let count = if is_done.is_some() { 4 } else { 1 };
            batch.project_rest(slot..slot + count, is_done, points, targets);
            slot += count;
        }
    }
}

/// [`Batch::squared_residual`], four at a time.
struct SquaredResidual<'a, T> {
    batch: &'a TypedBatch<T>,
    slots: Range<usize>,
    points: &'a [DVec3],
    targets: &'a [DVec3],
    stiffness: &'a [f64],
}

impl<T: Constraint> LaneKernel for SquaredResidual<'_, T> {
    type Output = f64;

    #[inline(always)]
    fn run<S: Isa>(self, simd: S) -> f64 {
        let Self { batch, slots, points, targets, stiffness } = self;
        let first = batch.target_offset(slots.start);
        let (mut sums, mut rest) = (F4::splat(simd, 0.0), 0.0);
        let mut slot = slots.start;
        while slot < slots.end {
            let (targets, stiffness) =
                (&targets[batch.target_offset(slot) - first..], &stiffness[slot - slots.start..]);
            let k = batch.indices.get(slot).len();
            if slot + 4 <= slots.end
                && let Some(squared) = batch.squared_residual_of_four(simd, slot, k, points, targets)
            {
                let [a, b, c, d, ..] = *stiffness else { break };
                sums = squared.mul_add(F4::new(simd, [a, b, c, d]), sums);
                slot += 4;
            } else {
                rest += stiffness[0] * batch.squared_residual_of(slot, points, targets);
                slot += 1;
            }
        }
        sums.to_array().iter().sum::<f64>() + rest
    }
}

/// Four constraints and their points.
type FourAt<'a, T, S, const K: usize> = (Four<'a, T, S>, [V4<S>; K]);

/// How two batches are projected together: slots, points, and the targets of each.
pub(crate) type ProjectPair = fn([&dyn Batch; 2], Range<usize>, &[DVec3], [&mut [DVec3]; 2]);

/// Two types that can be projected together.
pub(super) struct Pair {
    /// True if two batches are of these types, on the same points and shapes.
    pub(super) is_of: fn(&dyn Batch, &dyn Batch) -> bool,
    pub(super) project: ProjectPair,
}

/// Two types that share a decomposition; `K` is `N + 1`, the number of points.
pub(super) const fn pair<const N: usize, const K: usize, A: Deformation<N>, B: Deformation<N>>() -> Pair {
    Pair {
        is_of: |a, b| {
            let Some((a, b)) = both::<A, B>(a, b) else { return false };
            let has_shapes_of_other = || a.rest.iter().zip(&b.rest).all(|(a, b)| a.rest_shape() == b.rest_shape());
            // Neither list of indices has gaps: indices are never replaced.
            !a.rest.is_empty() && a.indices.values() == b.indices.values() && has_shapes_of_other()
        },
        project: |[a, b], slots, points, targets| {
            if let Some((a, b)) = both::<A, B>(a, b) {
                dispatch_lanes(ProjectPairOf::<N, K, A, B> { a, b, slots, points, targets });
            }
        },
    }
}

fn both<'a, A: Constraint, B: Constraint>(
    a: &'a dyn Batch,
    b: &'a dyn Batch,
) -> Option<(&'a TypedBatch<A>, &'a TypedBatch<B>)> {
    Some(((a as &dyn Any).downcast_ref()?, (b as &dyn Any).downcast_ref()?))
}

/// The projection of some slots of two batches on the same points and shapes.
struct ProjectPairOf<'a, const N: usize, const K: usize, A, B> {
    a: &'a TypedBatch<A>,
    b: &'a TypedBatch<B>,
    slots: Range<usize>,
    points: &'a [DVec3],
    targets: [&'a mut [DVec3]; 2],
}

impl<const N: usize, const K: usize, A: Deformation<N>, B: Deformation<N>> LaneKernel
    for ProjectPairOf<'_, N, K, A, B>
{
    type Output = ();

    #[inline(always)]
    fn run<S: Isa>(self, simd: S) {
        let Self { a, b, slots, points, targets: [a_targets, b_targets] } = self;
        let mut slot = slots.start;
        while slot < slots.end {
            let start = N * (slot - slots.start);
            let (a_targets, b_targets) = (&mut a_targets[start..], &mut b_targets[start..]);
            let (mut count, mut are_done) = (1, [None; 2]);
            if slot + 4 <= slots.end
                && let Some((a_four, x)) = a.four::<K, S>(simd, slot, points)
                && let Some((b_four, _)) = b.four::<K, S>(simd, slot, points)
            {
                let gradient = gradient_four(&a_four, &x);
                let svd = lanes::svd(simd, gradient);
                let mut own = [V4::zero(simd); N];
                let is_a_done = A::project_decomposed(a_four, gradient, &svd, &mut own);
                write_four(&own, a_targets);
                let is_b_done = B::project_decomposed(b_four, gradient, &svd, &mut own);
                write_four(&own, b_targets);
                (count, are_done) = (4, [Some(is_a_done), Some(is_b_done)]);
            }
            a.project_rest(slot..slot + count, are_done[0], points, a_targets);
            b.project_rest(slot..slot + count, are_done[1], points, b_targets);
            slot += count;
        }
    }
}

/// Writes the targets of four constraints, one after the other.
#[inline(always)]
fn write_four<S: Isa>(four_targets: &[V4<S>], targets: &mut [DVec3]) {
    let rows = four_targets.len();
    let targets = &mut targets[..4 * rows];
    for (row, four) in four_targets.iter().enumerate() {
        for (i, target) in four.to_array().into_iter().enumerate() {
            targets[i * rows + row] = target;
        }
    }
}

/// True if constraints of `T` can have `k` points.
const fn has_points<T: Constraint>(k: usize) -> bool {
    let most = match T::INFO.greatest_indices {
        Some(most) => most,
        None => usize::MAX,
    };
    T::INFO.least_indices <= k && k <= most
}

/// Calls `$method::<K, S>` with the number of points as a constant, so that they stay in registers; `None` beyond 8.
macro_rules! by_point_count {
    ($k:expr, $self:ident.$method:ident($($argument:expr),*)) => {
        by_point_count!(@ $k, $self.$method, ($($argument),*), 1, 2, 3, 4, 5, 6, 7, 8)
    };
    (@ $k:expr, $self:ident.$method:ident, $arguments:tt, $($count:literal),*) => {
        match $k {
            $($count if const { has_points::<T>($count) } => by_point_count!(@ $self.$method, $arguments, $count),)*
            _ => None,
        }
    };
    (@ $self:ident.$method:ident, ($($argument:expr),*), $count:literal) => {
        $self.$method::<$count, S>($($argument),*)
    };
}

impl<T: Constraint> TypedBatch<T> {
    /// Projects the constraints of four slots, if they are of `k` points each, into the beginning of `targets`; returns which of
    /// them are done.
    #[inline(always)]
    fn project_four<S: Isa>(
        &self,
        simd: S,
        slot: usize,
        k: usize,
        points: &[DVec3],
        targets: &mut [DVec3],
    ) -> Option<Mask<S>> {
        by_point_count!(k, self.project_four_of(simd, slot, points, targets))
    }

    #[inline(always)]
    fn project_four_of<const K: usize, S: Isa>(
        &self,
        simd: S,
        slot: usize,
        points: &[DVec3],
        targets: &mut [DVec3],
    ) -> Option<Mask<S>> {
        let (four, x) = self.four::<K, S>(simd, slot, points)?;
        let rows = T::INFO.rows.count(K);
        // A type has at most as many rows as points.
        let mut four_targets = [V4::zero(simd); K];
        let is_done = T::project_four(four, &x, &mut four_targets[..rows]);
        write_four(&four_targets[..rows], targets);
        Some(is_done)
    }

    /// `‖A x − p‖²` of the constraints of four slots, if they are of `k` points each; `targets` begin with theirs.
    #[inline(always)]
    fn squared_residual_of_four<S: Isa>(
        &self,
        simd: S,
        slot: usize,
        k: usize,
        points: &[DVec3],
        targets: &[DVec3],
    ) -> Option<F4<S>> {
        by_point_count!(k, self.squared_residual_of_four_of(simd, slot, points, targets))
    }

    #[inline(always)]
    fn squared_residual_of_four_of<const K: usize, S: Isa>(
        &self,
        simd: S,
        slot: usize,
        points: &[DVec3],
        targets: &[DVec3],
    ) -> Option<F4<S>> {
        let (_, x) = self.four::<K, S>(simd, slot, points)?;
        let mut squared = F4::splat(simd, 0.0);
        match T::INFO.rows {
            Rows::Centred => {
                let targets = &targets[..4 * K];
                for (j, x) in x.into_iter().enumerate() {
                    let target = V4::gather_every(simd, K, &targets[j..]);
                    squared = (x - target).dot(x - target) + squared;
                }
            }
            Rows::Pairs => {
                let targets = &targets[..4 * (K / 2)];
                for (row, pair) in x.chunks_exact(2).enumerate() {
                    let residual = pair[1] - pair[0] - V4::gather_every(simd, K / 2, &targets[row..]);
                    squared = residual.dot(residual) + squared;
                }
            }
            Rows::Linear(rows) => {
                let targets = &targets[..4 * rows];
                let coefficients = &self.coefficients[self.coefficient_range(slot).start..][..4 * rows * K];
                for row in 0..rows {
                    let mut image = V4::zero(simd);
                    for (j, x) in x.into_iter().enumerate() {
                        let (at, step) = (row * K + j, rows * K);
                        let [a, b, c, d] = [at, at + step, at + 2 * step, at + 3 * step];
                        let four = [coefficients[a], coefficients[b], coefficients[c], coefficients[d]];
                        image = x.mul_add(F4::new(simd, four), image);
                    }
                    let residual = image - V4::gather_every(simd, rows, &targets[row..]);
                    squared = residual.dot(residual) + squared;
                }
            }
        }
        Some(squared)
    }

    /// `‖A x − p‖²` of one constraint; `targets` begin with its own.
    fn squared_residual_of(&self, slot: usize, points: &[DVec3], targets: &[DVec3]) -> f64 {
        let x = self.stencil(slot, points);
        match T::INFO.rows {
            Rows::Centred => x.iter().zip(targets).map(|(point, &target)| (point - target).length_squared()).sum(),
            Rows::Pairs => {
                let edges = (0..x.len() / 2).map(|row| x.at(2 * row + 1) - x.at(2 * row));
                edges.zip(targets).map(|(edge, &target)| (edge - target).length_squared()).sum()
            }
            Rows::Linear(_) => {
                let rows = self.rows(slot).chunks_exact(x.len());
                let image = |row: &[f64]| row.iter().zip(x.iter()).map(|(&a, point)| a * point).sum::<DVec3>();
                rows.zip(targets).map(|(row, &target)| (image(row) - target).length_squared()).sum()
            }
        }
    }

    /// The constraints of four slots and their points, if they are of `K` points each.
    #[inline(always)]
    fn four<'a, const K: usize, S: Isa>(
        &'a self,
        simd: S,
        slot: usize,
        points: &[DVec3],
    ) -> Option<FourAt<'a, T, S, K>> {
        let indices = self.indices.four_of(K, slot)?;
        let scalars = match T::INFO.scalars {
            // So that no access needs a check.
            Scalars::Named(names) => self.scalars.four_of(names.len(), slot)?,
            _ => {
                let scalars = |i| self.scalars.get(slot + i);
                [scalars(0), scalars(1), scalars(2), scalars(3)]
            }
        };
        let [a, b, c, d] = &self.rest[slot..slot + 4] else { return None };
        let four = Four::new(simd, [a, b, c, d], scalars);
        // All indices are checked before the first point is read: the numbers then go straight into vector registers.
        let mut at = [[points.first()?; 4]; K];
        for (j, at) in at.iter_mut().enumerate() {
            for (at, indices) in at.iter_mut().zip(indices) {
                *at = &points[indices[j] as usize];
            }
        }
        let mut x = [V4::zero(simd); K];
        for (x, at) in x.iter_mut().zip(at) {
            *x = V4::gather(simd, at);
        }
        if T::INFO.rows == Rows::Centred {
            // Summed relative to the first point: far from the origin the mean keeps the digits that differences have.
            let first = x[0];
            let sum = x[1..].iter().fold(V4::zero(simd), |sum, &x| sum + (x - first));
            let mean = first + sum * F4::splat(simd, 1.0 / K as f64);
            x.iter_mut().for_each(|x| *x = *x - mean);
        }
        Some((four, x))
    }

    /// Projects the plain way what is not done of `slots`, whose first target is the first of `targets`.
    #[inline(always)]
    fn project_rest<S: Isa>(
        &self,
        slots: Range<usize>,
        is_done: Option<Mask<S>>,
        points: &[DVec3],
        targets: &mut [DVec3],
    ) {
        if is_done.is_some_and(Mask::all) {
            return;
        }
        let first = self.target_offset(slots.start);
        for i in slots.clone().filter(|i| !is_done.is_some_and(|is_done| is_done.has(i - slots.start))) {
            let (start, end) = (self.target_offset(i) - first, self.target_offset(i + 1) - first);
            self.rest[i].project(self.scalars.get(i), self.stencil(i, points), &mut targets[start..end]);
        }
    }
}
