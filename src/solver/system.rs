//! The linear system of the global step, `N x = Aᵀp + external` with `N = Σ s AᵀA + inertia`, and the way from targets to
//! right-hand sides. `s` is a constraint's stiffness: its weight times its measure.
//!
//! `N` can be singular without inertia. Three remedies keep the change of the points least:
//! - a point with a zero row keeps its place;
//! - a component that nothing holds against translation has its first point held while solving, and is then moved back
//!   to where its mean was. As the right-hand side has no component along a free translation, this is exact;
//! - where that is not enough (rows that leave more than translations free, such as a lone Bending), no point is held, and
//!   every row gains a small part of its diagonal as a pull towards the current position: a proximal step, with the same
//!   fixed points. A held point would decide along which free motion the others move.
//!
//! The remedies are the same for a factor and for conjugate gradients, and so are the iterates. Whether the third is needed a
//! vanishing pivot says, or a trial solve.

use std::time::Instant;

use glam::DVec3;

use super::assembly::{Gather, even_bounds, fill, long_constraint_count, new_pattern};
use super::chunks::{Chunk, cut_into_chunks};
use super::free_components::{FreeComponent, free_components};
use super::linear_solver::{LARGEST_FACTOR_BYTES, LinearSolver, LinearSystem, Order};
use super::parallel::{both, for_parts};
use super::report::IterationBytes;
use crate::constraints::ConstraintSet;
use crate::error::{Error, Result, Status};
use crate::linalg::simd::{Lanes, lanes, vector};
use crate::linalg::symmetric::SymmetricMatrix;

/// Targets above which the local step runs in parallel: with the fastest types, two threads break even at half as many.
const PARALLEL_TARGETS: usize = 2048;

/// Entries of `Aᵀ` above which right-hand sides are gathered, and solutions read, in parallel: some 5 µs of work.
const PARALLEL_ENTRIES: usize = 1 << 13;

/// The pull of a proximal step, relative to the diagonal of `N`. Round-off along free motions is amplified by its
/// inverse: 1e-16 becomes 1e-10 of the model's size per iteration.
const PROXIMAL: f64 = 1e-6;

/// A total force on a free component below this multiple of the sum of its forces' lengths is round-off.
const BALANCED: f64 = 1e-10;

/// Proximal steps after which a force that `N` does not resist is told from one that it resists weakly.
const RESISTANCE_STEPS: usize = 20;

/// Part of a force that may be left after [`RESISTANCE_STEPS`]: what `N` resists with `PROXIMAL` times its diagonal
/// shrinks by half in each step.
const UNRESISTED: f64 = 1e-4;

/// What was made since a solver was created.
#[derive(Clone, Copy, Default)]
pub(super) struct SystemCounts {
    pub(super) orderings: u32,
    pub(super) factorisations: u32,
}

/// The system of the global step, with the memory that an iteration needs.
pub(super) struct System {
    point_count: usize,
    matrix: SymmetricMatrix,
    pub(super) linear: LinearSystem,
    /// Weight times measure, by batch and slot.
    stiffness: Vec<Vec<f64>>,
    chunks: Vec<Chunk>,
    /// Where the targets of each chunk begin, and the number of all.
    chunk_bounds: Vec<usize>,
    chunk_energies: Vec<f64>,
    targets: Vec<DVec3>,
    gather: Gather,
    /// Where the chunks of points begin, and the number of points.
    point_bounds: Vec<usize>,
    /// The unknown of each row of the linear solver, and where the chunks of rows begin.
    unknowns: Vec<u32>,
    row_bounds: Vec<usize>,
    /// The largest squared move in each chunk of points.
    chunk_moves: Vec<f64>,
    /// New points.
    solution: Vec<DVec3>,
    unconstrained: Vec<u32>,
    free_components: Vec<FreeComponent>,
    /// The pull of the proximal step on each point; empty where none is needed.
    proximal: Vec<f64>,
    /// What [`Self::solution_and_image`] works on, one entry per unknown once it was called.
    change: Vec<DVec3>,
    image: Vec<DVec3>,
    pub(super) analysis_seconds: f64,
    pub(super) factorisation_seconds: f64,
}

impl System {
    /// Assembles and factorises the system of `constraints` over `points`. The analysis of `previous` is taken over if its
    /// pattern covers the new one and `wish` is the same. `inertia` (mass over the squared time step) is 0 in static mode.
    pub(super) fn new(
        constraints: &ConstraintSet,
        points: &[DVec3],
        inertia: f64,
        wish: LinearSolver,
        previous: Option<Self>,
        counts: &mut SystemCounts,
        is_parallel: bool,
    ) -> Result<Self> {
        let point_count = points.len();
        let stiffness: Vec<Vec<f64>> = constraints
            .batches()
            .map(|(batch, weights)| weights.iter().enumerate().map(|(slot, w)| w * batch.measure(slot)).collect())
            .collect();
        // One without meaning where there is none, so that there is always a matrix.
        let unknown_count = (point_count + long_constraint_count(constraints)).max(1);
        let started = Instant::now();
        let mut known = previous.filter(|known| known.matrix.dimension() == unknown_count);
        let is_filled =
            known.as_mut().is_some_and(|known| fill(known.matrix.split(), constraints, &stiffness, point_count));
        let (mut matrix, known_linear) = match known.filter(|_| is_filled) {
            Some(known) => (known.matrix, Some(known.linear).filter(|linear| linear.wish == wish)),
            None => (new_pattern(constraints, point_count, unknown_count)?, None),
        };
        // Conjugate gradients that were asked for need no ordering.
        let is_ordered = known_linear.is_none() && wish != LinearSolver::ConjugateGradients;
        counts.orderings = counts.orderings.saturating_add(u32::from(is_ordered));
        let (pattern, values) = matrix.split();
        let analyse =
            || known_linear.map_or_else(|| LinearSystem::new(pattern, points, wish, LARGEST_FACTOR_BYTES), Ok);
        let assemble = || {
            if !is_filled {
                fill((pattern, &mut *values), constraints, &stiffness, point_count);
            }
            let is_bare = |&i: &u32| pattern.diagonal(values, i as usize) == 0.0;
            let unconstrained: Vec<u32> = (0..point_count as u32).filter(is_bare).collect();
            // Inertia holds every point.
            let is_static = inertia == 0.0;
            let free = is_static.then(|| free_components(constraints, &stiffness, &unconstrained, point_count));
            (unconstrained, free.unwrap_or_default())
        };
        let gather = || {
            let (chunks, bounds) = cut_into_chunks(constraints);
            let targets = vec![DVec3::ZERO; bounds[chunks.len()]];
            (Gather::new(constraints, &stiffness, &chunks, &bounds, point_count), chunks, bounds, targets)
        };
        let (linear, ((unconstrained, free_components), (gather, chunks, chunk_bounds, targets))) =
            both(is_parallel, analyse, || both(is_parallel, assemble, gather));
        let linear = linear?;
        let analysis_seconds = started.elapsed().as_secs_f64();

        let point_bounds = even_bounds(point_count);
        let mut system = Self {
            point_count,
            matrix,
            linear,
            chunk_energies: vec![0.0; chunks.len()],
            chunk_moves: vec![0.0; point_bounds.len() - 1],
            point_bounds,
            solution: vec![DVec3::ZERO; point_count],
            targets,
            chunks,
            chunk_bounds,
            gather,
            unknowns: Vec::new(),
            row_bounds: even_bounds(unknown_count),
            unconstrained,
            free_components,
            proximal: Vec::new(),
            stiffness,
            change: Vec::new(),
            image: Vec::new(),
            analysis_seconds,
            factorisation_seconds: 0.0,
        };
        let started = Instant::now();
        system.make_definite(inertia, counts, is_parallel)?;
        system.factorisation_seconds = started.elapsed().as_secs_f64();
        let mut unknowns = vec![0; unknown_count];
        (0..).zip(system.linear.order().place).for_each(|(unknown, &place)| unknowns[place as usize] = unknown);
        system.unknowns = unknowns;
        Ok(system)
    }

    /// The matrix, the stiffness of all constraints by batch and slot, and the components that nothing holds against
    /// translation.
    #[cfg(feature = "gpu")]
    pub(super) fn parts(&self) -> (&SymmetricMatrix, &[Vec<f64>], Vec<Vec<u32>>) {
        let held = self.free_components.iter().filter(|component| component.held_stiffness > 0.0);
        (&self.matrix, &self.stiffness, held.map(|component| component.points.clone()).collect())
    }

    /// True if a pull towards the current points is what makes the matrix definite.
    #[cfg(feature = "gpu")]
    pub(super) fn is_proximal(&self) -> bool {
        !self.proximal.is_empty()
    }

    /// Weight times measure, by batch and slot.
    #[cfg(feature = "gpu")]
    pub(super) fn stiffness(&self) -> &[Vec<f64>] {
        &self.stiffness
    }

    /// What an iteration goes through; `None` without a factor.
    pub(super) fn iteration_bytes(&self, constraints: &ConstraintSet) -> Option<IterationBytes> {
        Some(IterationBytes {
            factor: self.linear.factor_byte_count()?,
            right_hand_sides: size_of_val(self.linear.rows()),
            points: size_of_val(&*self.solution),
            projections: size_of_val(&*self.targets),
            constraints: constraints.batches().map(|(batch, _)| batch.byte_count()).sum::<usize>()
                + self.gather.byte_count(),
        })
    }

    /// True if some part of an iteration is long enough to gain from more than one thread.
    pub(super) fn is_long(&self) -> bool {
        self.is_local_step_long() || self.is_global_step_long()
    }

    fn is_local_step_long(&self) -> bool {
        self.targets.len() >= PARALLEL_TARGETS
    }

    fn is_global_step_long(&self) -> bool {
        self.gather.len() >= PARALLEL_ENTRIES
    }

    /// Projects `points` onto every constraint, on the current rayon pool if `is_parallel` and there is enough to do. Returns
    /// `½ Σ s ‖A x − p‖²` if `wants_energy`, else 0.
    pub(super) fn local_step(
        &mut self,
        constraints: &ConstraintSet,
        points: &[DVec3],
        wants_energy: bool,
        is_parallel: bool,
    ) -> f64 {
        let is_parallel = is_parallel && self.is_local_step_long();
        let (chunks, stiffness) = (&self.chunks, &self.stiffness);
        let work = |i: usize, targets: &mut [DVec3], energy: &mut f64| {
            let chunk = &chunks[i];
            chunk.project(constraints, points, targets);
            *energy = 0.0;
            let mut rest = targets;
            for (index, slots) in chunk.batches() {
                let batch = constraints.batch(index);
                let (own, later) = rest.split_at_mut(chunk.target_count(batch));
                if wants_energy {
                    *energy += batch.squared_residual(slots.clone(), points, own, &stiffness[index][slots.clone()]);
                }
                batch.centre_targets(slots, own);
                rest = later;
            }
        };
        for_parts(&self.chunk_bounds, &mut self.targets, &mut self.chunk_energies, is_parallel, &work);
        if wants_energy { 0.5 * self.chunk_energies.iter().sum::<f64>() } else { 0.0 }
    }

    /// Solves for new points from the last projections, the `external` terms of the right-hand side (empty: none) and
    /// the current `points`, which the remedies for singular systems refer to; [`Self::swap_solution`] then has them.
    pub(super) fn global_step(&mut self, points: &[DVec3], external: &[DVec3], is_parallel: bool) {
        let is_parallel = is_parallel && self.is_global_step_long();
        let (gather, targets, pulls, bounds) = (&self.gather, &self.targets, &self.proximal, &self.point_bounds);
        let sum = |chunk: usize, sums: &mut [DVec3], (): &mut ()| {
            gather.sum(bounds[chunk], targets, sums);
            for (point, sum) in (bounds[chunk]..).zip(sums) {
                *sum += external.get(point).copied().unwrap_or_default();
                if let Some(pull) = pulls.get(point) {
                    *sum += *pull * points[point];
                }
            }
        };
        // Nothing is allocated for results of no size.
        for_parts(bounds, &mut self.solution, &mut vec![(); bounds.len() - 1], is_parallel, &sum);
        let (bounds, unknowns, sums) = (&self.row_bounds, &self.unknowns, &self.solution);
        let (rows, scale) = self.linear.rows_mut_and_scale();
        let sort = |chunk: usize, rows: &mut [Lanes], (): &mut ()| {
            for (row, &unknown) in rows.iter_mut().zip(&unknowns[bounds[chunk]..]) {
                // The targets of the unknown means add up to nothing.
                *row = sums.get(unknown as usize).map_or([0.0; 4], |sum| lanes(scale[unknown as usize] * *sum));
            }
        };
        for_parts(bounds, rows, &mut vec![(); bounds.len() - 1], is_parallel, &sort);
        self.solve(points, is_parallel);
    }

    /// Exchanges `points` with the new ones of the last global step.
    pub(super) fn swap_solution(&mut self, points: &mut Vec<DVec3>) {
        std::mem::swap(points, &mut self.solution);
    }

    /// Moves `points` to the new ones of the last global step; returns the largest move.
    pub(super) fn take_solution(&mut self, points: &mut [DVec3], is_parallel: bool) -> f64 {
        let is_parallel = is_parallel && self.is_global_step_long();
        let (bounds, solution) = (&self.point_bounds, &self.solution);
        let work = |chunk: usize, points: &mut [DVec3], largest: &mut f64| {
            *largest = 0.0;
            for (point, new) in points.iter_mut().zip(&solution[bounds[chunk]..]) {
                *largest = largest.max(point.distance_squared(*new));
                *point = *new;
            }
        };
        for_parts(bounds, points, &mut self.chunk_moves, is_parallel, &work);
        self.chunk_moves.iter().copied().fold(0.0, f64::max).sqrt()
    }

    /// The new points of the last global step from `points`, and `N` times the change to them: minus the gradient of the
    /// energy at `points` (with nearest projections).
    pub(super) fn solution_and_image(&mut self, points: &[DVec3]) -> (&[DVec3], &[DVec3]) {
        let n = self.point_count;
        self.change.clear();
        self.change.extend(self.solution.iter().zip(points).map(|(new, point)| *new - *point));
        self.change.resize(self.matrix.dimension(), DVec3::ZERO);
        self.image.resize(self.matrix.dimension(), DVec3::ZERO);
        if self.matrix.dimension() > n {
            // The unknown means follow the points: their rows of the product vanish. They do not meet each other.
            self.matrix.multiply(&self.change, &mut self.image);
            for i in n..self.matrix.dimension() {
                self.change[i] = -self.image[i] / self.matrix.diagonal(i);
            }
        }
        self.matrix.multiply(&self.change, &mut self.image);
        for component in self.free_components.iter().filter(|component| component.held_stiffness > 0.0) {
            let held = component.points[0] as usize;
            self.image[held] -= component.held_stiffness * self.change[held];
        }
        (&self.solution, &self.image[..n])
    }

    /// `½ Σ s ‖A x − P(x)‖²` at any points, without touching the iteration's memory.
    pub(super) fn constraint_energy(constraints: &ConstraintSet, points: &[DVec3]) -> f64 {
        let mut energy = 0.0;
        let mut targets = Vec::new();
        for (batch, weights) in constraints.batches() {
            for (slot, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
                targets.clear();
                targets.resize(batch.target_offset(slot + 1) - batch.target_offset(slot), DVec3::ZERO);
                batch.project(slot..slot + 1, points, &mut targets);
                let stiffness = [weight * batch.measure(slot)];
                energy += 0.5 * batch.squared_residual(slot..slot + 1, points, &targets, &stiffness);
            }
        }
        energy
    }

    /// Refuses `forces` (one per point) with a component along a motion that no constraint resists.
    pub(super) fn check_resistance(&mut self, forces: &[DVec3]) -> Result<()> {
        let refuse = |what: String| Err(Error::new(Status::Unbounded, what));
        if let Some(point) = self.unconstrained.iter().find(|&&point| forces[point as usize] != DVec3::ZERO) {
            return refuse(format!("a force acts on point {point}, which no constraint holds"));
        }
        for component in &self.free_components {
            let on = |point: &u32| forces[*point as usize];
            let (sum, most): (DVec3, f64) =
                (component.points.iter().map(on).sum(), component.points.iter().map(|point| on(point).length()).sum());
            if sum.length() > BALANCED * most {
                let (first, count) = (component.points[0], component.points.len());
                return refuse(format!(
                    "the forces on the component of point {first} ({count} points) add up to {sum}, and no constraint \
                     holds it in place"
                ));
            }
        }
        if self.proximal.is_empty() {
            return Ok(());
        }
        // Each proximal step from rest leaves what N did not resist: r ← (ε D)(N + ε D)⁻¹ r.
        let n = self.point_count;
        let rest = vec![DVec3::ZERO; n];
        let mut left = forces.to_vec();
        for _ in 0..RESISTANCE_STEPS {
            self.linear.rows_mut_and_scale().0.fill([0.0; 4]);
            for (point, left) in left.iter().enumerate() {
                let (row, scale) = self.linear.row_mut(point);
                *row = lanes(scale * *left);
            }
            self.solve(&rest, false);
            for ((left, x), pull) in left.iter_mut().zip(&self.solution).zip(&self.proximal) {
                *left = *x * *pull;
            }
        }
        let largest = forces.iter().map(|force| force.length()).fold(0.0, f64::max);
        match left.iter().position(|left| left.length() > UNRESISTED * largest) {
            Some(point) => refuse(format!("a force acts along a motion of point {point} that no constraint resists")),
            None => Ok(()),
        }
    }

    /// Solves with the right-hand sides in the rows, reads the solution and undoes what holding the free components changed.
    fn solve(&mut self, points: &[DVec3], is_parallel: bool) {
        for component in self.free_components.iter().filter(|component| component.held_stiffness > 0.0) {
            let held = component.points[0] as usize;
            let (row, scale) = self.linear.row_mut(held);
            *row = lanes(vector(*row) + scale * component.held_stiffness * points[held]);
        }
        for &point in &self.unconstrained {
            let (row, scale) = self.linear.row_mut(point as usize);
            *row = lanes(scale * points[point as usize]);
        }
        self.linear.solve(points, is_parallel);
        let (Order { place, scale }, rows, bounds) = (self.linear.order(), self.linear.rows(), &self.point_bounds);
        let work = |chunk: usize, solution: &mut [DVec3], (): &mut ()| {
            let first = bounds[chunk];
            for ((new, &place), scale) in solution.iter_mut().zip(&place[first..]).zip(&scale[first..]) {
                *new = *scale * vector(rows[place as usize]);
            }
        };
        for_parts(bounds, &mut self.solution, &mut vec![(); bounds.len() - 1], is_parallel, &work);
        for &point in &self.unconstrained {
            // The scale, or conjugate gradients, may round.
            self.solution[point as usize] = points[point as usize];
        }
        for component in self.free_components.iter().filter(|component| component.held_stiffness > 0.0) {
            let (solution, count) = (&mut self.solution, component.points.len() as f64);
            let change = |&point: &u32| points[point as usize] - solution[point as usize];
            let shift = component.points.iter().map(change).sum::<DVec3>() / count;
            for &point in &component.points {
                solution[point as usize] += shift;
            }
        }
    }

    /// Adds the inertia, or the remedies for a singular matrix, and factorises.
    fn make_definite(&mut self, inertia: f64, counts: &mut SystemCounts, is_parallel: bool) -> Result<()> {
        for i in self.point_count..self.matrix.dimension() {
            if self.matrix.diagonal(i) == 0.0 {
                *self.matrix.diagonal_mut(i) = 1.0;
            }
        }
        if inertia > 0.0 {
            self.unconstrained.clear();
            for i in 0..self.point_count {
                *self.matrix.diagonal_mut(i) += inertia;
            }
            return self.factorise(counts, is_parallel);
        }
        for &point in &self.unconstrained {
            *self.matrix.diagonal_mut(point as usize) = 1.0;
        }
        for component in &mut self.free_components {
            let diagonal = self.matrix.diagonal_mut(component.points[0] as usize);
            component.held_stiffness = *diagonal;
            *diagonal *= 2.0;
        }
        let factorised = self.factorise(counts, is_parallel);
        if !self.linear.is_singular() {
            return factorised;
        }
        for component in &mut self.free_components {
            let diagonal = self.matrix.diagonal_mut(component.points[0] as usize);
            // As it was: held points have twice their diagonal.
            *diagonal *= 0.5;
            component.held_stiffness = 0.0;
        }
        self.proximal = (0..self.point_count).map(|i| PROXIMAL * self.matrix.diagonal(i)).collect();
        for &point in &self.unconstrained {
            self.proximal[point as usize] = 0.0;
        }
        for (i, pull) in self.proximal.iter().enumerate() {
            *self.matrix.diagonal_mut(i) += pull;
        }
        self.factorise(counts, is_parallel)?;
        self.linear.expect_proximal_step();
        Ok(())
    }

    fn factorise(&mut self, counts: &mut SystemCounts, is_parallel: bool) -> Result<()> {
        let is_factor = self.linear.used() == LinearSolver::Direct;
        counts.factorisations = counts.factorisations.saturating_add(u32::from(is_factor));
        self.linear.prepare(&self.matrix, is_parallel)
    }
}
