//! The linear system of the global step, `N x = Aᵀp + external` with `N = Σ s AᵀA + inertia`, and the way from targets to
//! right-hand sides. `s` is a constraint's stiffness: its weight times its measure.
//!
//! Short centred constraints enter `N` as the dense block `s (I − 11ᵀ/k)`. Long ones would fill it, so they get one more
//! unknown each, their mean `m`: minimising `½ s Σ ‖x_i − m − p_i‖²` over `x` and `m` has the same minimiser in `x`, and
//! costs `k + 1` entries.
//!
//! `N` can be singular without inertia. Three remedies keep the change of the points least:
//! - a point with a zero row keeps its place;
//! - a component that nothing holds against translation has its first point held while solving, and is then moved back
//!   to where its mean was. As the right-hand side has no component along a free translation, this is exact;
//! - where that is not enough (rows that leave more than translations free, such as a lone Bending), no point is held, and
//!   every row gains a small part of its diagonal as a pull towards the current position: a proximal step, with the same
//!   fixed points. A held point would decide along which free motion the others move.

use std::time::Instant;

use glam::DVec3;

use super::parallel::for_parts;
use crate::constraints::{ConstraintSet, Rows};
use crate::error::{Error, Result, Status};
use crate::linalg::cholesky::{Analysis, Factor, SymmetricMatrix};

/// Centred constraints of more points than this get an unknown of their own. Up to here the block has fewer entries
/// than the fill that a further unknown would cause when it is eliminated.
const LONGEST_DENSE_STENCIL: usize = 12;

/// Indices (and so targets, roughly) that one chunk of the local step covers: some 10 µs of work, so that splitting costs
/// little, and some ten chunks per thread of the smallest problem that runs in parallel.
const CHUNK_INDICES: usize = 512;

/// Points whose right-hand sides one chunk gathers.
const CHUNK_POINTS: usize = 1024;

/// Targets above which the local step runs in parallel: with the fastest types, two threads break even at half as many.
const PARALLEL_TARGETS: usize = 2048;

/// Entries of `Aᵀ` above which right-hand sides are gathered in parallel. Far less work per entry than a projection.
const PARALLEL_ENTRIES: usize = 1 << 16;

/// The pull of a proximal step, relative to the diagonal of `N`. Round-off along free motions is amplified by its
/// inverse: 1e-16 becomes 1e-10 of the model's size per iteration.
const PROXIMAL: f64 = 1e-6;

/// Row coefficients that add up to less than this multiple of their absolute sum leave translations free.
const TRANSLATION_FREE: f64 = 1e-9;

/// A total force on a free component below this multiple of the sum of its forces' lengths is round-off.
const BALANCED: f64 = 1e-10;

/// Proximal steps after which a force that `N` does not resist is told from one that it resists weakly.
const RESISTANCE_STEPS: usize = 20;

/// Part of a force that may be left after [`RESISTANCE_STEPS`]: what `N` resists with `PROXIMAL` times its diagonal
/// shrinks by half in each step.
const UNRESISTED: f64 = 1e-4;

/// Consecutive constraints of one batch, and the part of all targets that they fill.
struct Chunk {
    batch: usize,
    first_slot: usize,
    end_slot: usize,
}

/// Points that constraints hold together and that nothing holds against translation.
struct FreeComponent {
    /// Ascending; the first is held while solving.
    points: Vec<u32>,
    /// What holds it: as much as its own diagonal entry; 0 where a proximal step takes care of translations too.
    held_stiffness: f64,
}

/// The system of the global step, with the memory that an iteration needs.
pub(super) struct System {
    point_count: usize,
    matrix: SymmetricMatrix,
    analysis: Analysis,
    factor: Factor,
    /// Weight times measure, by batch and slot.
    stiffness: Vec<Vec<f64>>,
    chunks: Vec<Chunk>,
    /// Where the targets of each chunk begin, and the number of all.
    chunk_bounds: Vec<usize>,
    chunk_energies: Vec<f64>,
    targets: Vec<DVec3>,
    gather: Gather,
    /// One entry per chunk of points, of no meaning.
    gather_results: Vec<f64>,
    /// New points, then the unknown means.
    solution: Vec<DVec3>,
    unconstrained: Vec<u32>,
    free_components: Vec<FreeComponent>,
    /// The pull of the proximal step on each point; empty where none is needed.
    proximal: Vec<f64>,
    pub(super) analysis_seconds: f64,
    pub(super) factorisation_seconds: f64,
}

/// `Aᵀ` by rows: the right-hand side of each point as a sum over targets, in a fixed order.
struct Gather {
    starts: Vec<usize>,
    entries: Vec<(u32, f64)>,
    bounds: Vec<usize>,
}

impl System {
    /// Assembles and factorises the system of `constraints` over `point_count` points. The analysis of `previous` is
    /// taken over if its pattern covers the new one. `inertia` (mass over the squared time step) is 0 in static mode.
    pub(super) fn new(
        constraints: &ConstraintSet,
        point_count: usize,
        inertia: f64,
        previous: Option<Self>,
    ) -> Result<Self> {
        let stiffness: Vec<Vec<f64>> = constraints
            .batches()
            .map(|(batch, weights)| weights.iter().enumerate().map(|(slot, w)| w * batch.measure(slot)).collect())
            .collect();
        let unknown_count = point_count + long_constraint_count(constraints);
        let started = Instant::now();
        let known = previous.filter(|known| known.matrix.dimension() == unknown_count);
        let (mut matrix, known_analysis) = match known {
            Some(known) => (known.matrix, Some((known.analysis, known.factor))),
            None => (new_pattern(constraints, point_count, unknown_count)?, None),
        };
        let (analysis, factor) = match (fill(&mut matrix, constraints, &stiffness, point_count), known_analysis) {
            (true, Some(known)) => known,
            (covered, _) => {
                if !covered {
                    matrix = new_pattern(constraints, point_count, unknown_count)?;
                    fill(&mut matrix, constraints, &stiffness, point_count);
                }
                let analysis = Analysis::new(&matrix)?;
                let factor = Factor::new(&analysis)?;
                (analysis, factor)
            }
        };
        let analysis_seconds = started.elapsed().as_secs_f64();

        let unconstrained: Vec<u32> =
            (0..point_count).filter(|&i| matrix.diagonal(i) == 0.0).map(|i| i as u32).collect();
        let gather = Gather::new(constraints, &stiffness, point_count);
        let mut system = Self {
            point_count,
            matrix,
            analysis,
            factor,
            chunks: Vec::new(),
            chunk_bounds: vec![0],
            chunk_energies: Vec::new(),
            targets: Vec::new(),
            gather_results: vec![0.0; gather.bounds.len() - 1],
            gather,
            solution: vec![DVec3::ZERO; unknown_count],
            unconstrained,
            free_components: Vec::new(),
            proximal: Vec::new(),
            stiffness,
            analysis_seconds,
            factorisation_seconds: 0.0,
        };
        system.cut_into_chunks(constraints);
        let started = Instant::now();
        system.make_definite(constraints, inertia)?;
        system.factorisation_seconds = started.elapsed().as_secs_f64();
        Ok(system)
    }

    /// True if a local step is long enough to gain from more than one thread.
    pub(super) fn is_local_step_long(&self) -> bool {
        self.targets.len() >= PARALLEL_TARGETS
    }

    /// True if gathering right-hand sides is long enough to gain from more than one thread.
    pub(super) fn is_global_step_long(&self) -> bool {
        self.gather.entries.len() >= PARALLEL_ENTRIES
    }

    /// Projects `points` onto every constraint, on the current rayon pool if `is_parallel`. Returns `½ Σ s ‖A x − p‖²` if
    /// `wants_energy`, else 0.
    pub(super) fn local_step(
        &mut self,
        constraints: &ConstraintSet,
        points: &[DVec3],
        wants_energy: bool,
        is_parallel: bool,
    ) -> f64 {
        let (chunks, stiffness) = (&self.chunks, &self.stiffness);
        let work = |i: usize, targets: &mut [DVec3], energy: &mut f64| {
            let Chunk { batch: index, first_slot, end_slot } = chunks[i];
            let (batch, slots) = (constraints.batch(index), first_slot..end_slot);
            batch.project(slots.clone(), points, targets);
            if wants_energy {
                *energy = batch.squared_residual(slots.clone(), points, targets, &stiffness[index][slots.clone()]);
            }
            batch.centre_targets(slots, targets);
        };
        for_parts(&self.chunk_bounds, &mut self.targets, &mut self.chunk_energies, is_parallel, &work);
        if wants_energy { 0.5 * self.chunk_energies.iter().sum::<f64>() } else { 0.0 }
    }

    /// Solves for new points from the last projections, the `external` terms of the right-hand side (empty: none) and
    /// the current `points`, which the remedies for singular systems refer to. The result has one entry per point.
    pub(super) fn global_step(&mut self, points: &[DVec3], external: &[DVec3], is_parallel: bool) -> &[DVec3] {
        let n = self.point_count;
        let (gather, targets, proximal) = (&self.gather, &self.targets, &self.proximal);
        let work = |chunk: usize, sums: &mut [DVec3], _: &mut f64| {
            for (point, sum) in (gather.bounds[chunk]..).zip(sums) {
                *sum = external.get(point).copied().unwrap_or_default();
                for &(target, coefficient) in &gather.entries[gather.starts[point]..gather.starts[point + 1]] {
                    *sum += coefficient * targets[target as usize];
                }
                if let Some(pull) = proximal.get(point) {
                    *sum += *pull * points[point];
                }
            }
        };
        for_parts(&gather.bounds, &mut self.solution[..n], &mut self.gather_results, is_parallel, &work);
        self.solution[n..].fill(DVec3::ZERO);
        self.solve_in_place(points);
        &self.solution[..n]
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
            self.solution[..n].copy_from_slice(&left);
            self.solution[n..].fill(DVec3::ZERO);
            self.solve_in_place(&rest);
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

    /// Solves with the right-hand sides in `solution` and undoes what holding the free components changed.
    fn solve_in_place(&mut self, points: &[DVec3]) {
        for component in self.free_components.iter().filter(|component| component.held_stiffness > 0.0) {
            let held = component.points[0] as usize;
            self.solution[held] += component.held_stiffness * points[held];
        }
        for &point in &self.unconstrained {
            self.solution[point as usize] = points[point as usize];
        }
        self.factor.solve(&self.analysis, &mut self.solution);
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
    fn make_definite(&mut self, constraints: &ConstraintSet, inertia: f64) -> Result<()> {
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
            return self.factor.factorise(&self.analysis, &self.matrix);
        }
        for &point in &self.unconstrained {
            *self.matrix.diagonal_mut(point as usize) = 1.0;
        }
        self.free_components = free_components(constraints, &self.stiffness, &self.unconstrained, self.point_count);
        for component in &mut self.free_components {
            let diagonal = self.matrix.diagonal_mut(component.points[0] as usize);
            component.held_stiffness = *diagonal;
            *diagonal *= 2.0;
        }
        self.factor.factorise(&self.analysis, &self.matrix)?;
        if !self.factor.is_singular() {
            return Ok(());
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
        self.factor.factorise(&self.analysis, &self.matrix)
    }

    fn cut_into_chunks(&mut self, constraints: &ConstraintSet) {
        let mut target_count = 0;
        for (index, (batch, _)) in constraints.batches().enumerate() {
            let (mut first_slot, mut index_count) = (0, 0);
            for slot in 0..batch.len() {
                index_count += batch.indices(slot).len();
                if index_count >= CHUNK_INDICES || slot + 1 == batch.len() {
                    target_count += batch.target_offset(slot + 1) - batch.target_offset(first_slot);
                    self.chunks.push(Chunk { batch: index, first_slot, end_slot: slot + 1 });
                    self.chunk_bounds.push(target_count);
                    (first_slot, index_count) = (slot + 1, 0);
                }
            }
        }
        self.chunk_energies = vec![0.0; self.chunks.len()];
        self.targets = vec![DVec3::ZERO; target_count];
    }
}

impl Gather {
    fn new(constraints: &ConstraintSet, stiffness: &[Vec<f64>], point_count: usize) -> Self {
        let mut starts = vec![0_usize; point_count + 1];
        each_target(constraints, stiffness, |point, _, _| starts[point as usize + 1] += 1);
        for i in 0..point_count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0_u32, 0.0); starts[point_count]];
        each_target(constraints, stiffness, |point, target, coefficient| {
            let place = &mut next[point as usize];
            entries[*place] = (target, coefficient);
            *place += 1;
        });
        let mut bounds: Vec<usize> = (0..point_count).step_by(CHUNK_POINTS).collect();
        bounds.push(point_count);
        Self { starts, entries, bounds }
    }
}

/// Calls `visit(point, target, coefficient)` for every nonzero entry of `Aᵀ`, stiffness included.
fn each_target(constraints: &ConstraintSet, stiffness: &[Vec<f64>], mut visit: impl FnMut(u32, u32, f64)) {
    let mut base = 0;
    for ((batch, _), stiffness) in constraints.batches().zip(stiffness) {
        for (slot, &s) in stiffness.iter().enumerate() {
            let (indices, first) = (batch.indices(slot), base + batch.target_offset(slot));
            match batch.info().rows {
                Rows::Centred if s > 0.0 => {
                    indices.iter().enumerate().for_each(|(i, &point)| visit(point, (first + i) as u32, s));
                }
                Rows::Linear(_) if s > 0.0 => {
                    for (r, row) in batch.rows(slot).chunks_exact(indices.len()).enumerate() {
                        for (&point, &a) in indices.iter().zip(row).filter(|(_, a)| **a != 0.0) {
                            visit(point, (first + r) as u32, s * a);
                        }
                    }
                }
                _ => {}
            }
        }
        base += batch.target_offset(batch.len());
    }
}

/// Calls `visit(i, j, value)` for every contribution of the constraints to the lower triangle of `N`. Constraints of
/// weight 0 contribute zeros, so that they are in the pattern when their weight is raised.
fn each_entry(
    constraints: &ConstraintSet,
    stiffness: Option<&[Vec<f64>]>,
    point_count: usize,
    mut visit: impl FnMut(u32, u32, f64),
) {
    let mut mean = point_count as u32;
    for (index, (batch, _)) in constraints.batches().enumerate() {
        for slot in 0..batch.len() {
            let s = stiffness.map_or(0.0, |stiffness| stiffness[index][slot]);
            let (indices, rows) = (batch.indices(slot), batch.rows(slot));
            let k = indices.len();
            match batch.info().rows {
                Rows::Centred if k > LONGEST_DENSE_STENCIL => {
                    for &i in indices {
                        visit(i, i, s);
                        visit(mean, i, -s);
                    }
                    visit(mean, mean, s * k as f64);
                    mean += 1;
                }
                kind => {
                    let value = |a: usize, b: usize| match kind {
                        Rows::Centred => s * (f64::from(u8::from(a == b)) - 1.0 / k as f64),
                        Rows::Linear(_) => s * rows.chunks_exact(k).map(|row| row[a] * row[b]).sum::<f64>(),
                    };
                    for a in 0..k {
                        visit(indices[a], indices[a], value(a, a));
                        for b in 0..a {
                            // A repeated index meets itself in both triangles.
                            let times = if indices[a] == indices[b] { 2.0 } else { 1.0 };
                            visit(indices[a], indices[b], times * value(a, b));
                        }
                    }
                }
            }
        }
    }
}

fn long_constraint_count(constraints: &ConstraintSet) -> usize {
    let centred = constraints.batches().filter(|(batch, _)| batch.info().rows == Rows::Centred);
    centred.map(|(batch, _)| (0..batch.len()).filter(|&i| batch.indices(i).len() > LONGEST_DENSE_STENCIL).count()).sum()
}

fn new_pattern(constraints: &ConstraintSet, point_count: usize, unknown_count: usize) -> Result<SymmetricMatrix> {
    SymmetricMatrix::with_pattern(unknown_count, |report| {
        each_entry(constraints, None, point_count, |i, j, _| report(i, j));
    })
}

/// Assembles the constraints' part of `N`. False if the pattern does not cover it.
fn fill(matrix: &mut SymmetricMatrix, constraints: &ConstraintSet, stiffness: &[Vec<f64>], point_count: usize) -> bool {
    matrix.clear();
    let mut is_covered = true;
    each_entry(constraints, Some(stiffness), point_count, |i, j, value| is_covered &= matrix.add(i, j, value));
    is_covered
}

/// The components that rows with coefficients leave free to translate, without the points that have no row at all.
fn free_components(
    constraints: &ConstraintSet,
    stiffness: &[Vec<f64>],
    unconstrained: &[u32],
    point_count: usize,
) -> Vec<FreeComponent> {
    let mut parents: Vec<u32> = (0..point_count as u32).collect();
    let mut is_held = vec![false; point_count];
    fn root(parents: &mut [u32], mut i: u32) -> u32 {
        while parents[i as usize] != i {
            parents[i as usize] = parents[parents[i as usize] as usize];
            i = parents[i as usize];
        }
        i
    }
    let mut join = |points: &mut dyn Iterator<Item = u32>| {
        if let Some(first) = points.next() {
            for point in points {
                let (a, b) = (root(&mut parents, first), root(&mut parents, point));
                parents[a.max(b) as usize] = a.min(b);
            }
        }
    };
    for ((batch, _), stiffness) in constraints.batches().zip(stiffness) {
        for (slot, _) in stiffness.iter().enumerate().filter(|(_, s)| **s > 0.0) {
            let indices = batch.indices(slot);
            if batch.info().rows == Rows::Centred {
                join(&mut indices.iter().copied());
            }
            for row in batch.rows(slot).chunks_exact(indices.len()) {
                let touched = || indices.iter().zip(row).filter(|(_, a)| **a != 0.0).map(|(&i, _)| i);
                join(&mut touched());
                let (sum, size) = (row.iter().sum::<f64>(), row.iter().map(|a| a.abs()).sum::<f64>());
                if sum.abs() > TRANSLATION_FREE * size {
                    touched().for_each(|point| is_held[point as usize] = true);
                }
            }
        }
    }
    let mut component_of = vec![usize::MAX; point_count];
    let mut components: Vec<(FreeComponent, bool)> = Vec::new();
    let mut skip = unconstrained.iter().peekable();
    for point in 0..point_count as u32 {
        if skip.next_if_eq(&&point).is_some() {
            continue;
        }
        let slot = &mut component_of[root(&mut parents, point) as usize];
        if *slot == usize::MAX {
            *slot = components.len();
            components.push((FreeComponent { points: Vec::new(), held_stiffness: 0.0 }, false));
        }
        let (component, is_component_held) = &mut components[*slot];
        component.points.push(point);
        *is_component_held |= is_held[point as usize];
    }
    components.into_iter().filter(|(_, is_held)| !is_held).map(|(component, _)| component).collect()
}
