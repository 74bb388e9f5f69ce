//! Whole iterations on the card.
//!
//! The card keeps the points as `x₀ + u`, both in single precision, and solves `N Δu = s Aᵀ(P(A x) − A x) + …` for the change in
//! each iteration: what is small is then computed with all the digits that single precision has. `N` is never factorised:
//! conjugate gradients with a multigrid cycle make so many steps as were seen to suffice, without asking the processor. Many
//! iterations are submitted at once; points and energy are read back behind them.

use std::sync::Arc;
use std::time::Instant;

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::card::{Access, Card, GROUP, GROUP_SUM, MOVES, Run, THREADS};
use super::conjugate_gradients::ConjugateGradients;
use super::constants;
use super::frame::{Four, Frame, four, vector};
use super::gather::{self, vector_bytes};
use super::hard_step::{HardParts, HardStep};
use super::history::{History, Iterate};
use super::local_step::{LocalStep, PointBuffers, Wants};
use super::sliced::Sliced;
use crate::constraints::{ConstraintSet, Kernel};
use crate::error::{Error, Result, Status};
use crate::linalg::multilevel::Multilevel;
use crate::linalg::rows::SparseRows;
use crate::linalg::symmetric::SymmetricMatrix;
use crate::solver::acceleration::Chooser;
use crate::solver::history::Combination;

/// Iterations between *turns*, and so between read-backs at most. Where the time of an iteration asks for it, points are read back
/// between turns as well; but whatever later iterations depend on changes at turns alone, so that no clock decides about bits.
const TURN: u32 = 25;

/// Seconds between read-backs, about: half of what is promised, as the time of an iteration is an estimate.
const SECONDS: f64 = 0.25;

/// What is left of the error of a linear solve, in the norm of the matrix. The energy that is missed is the square of it.
const LINEAR_TOLERANCE: f64 = 1e-4;

/// Steps of conjugate gradients in a linear solve: at the start, at least, and at most.
const FIRST_STEPS: u32 = 12;
const LEAST_STEPS: u32 = 2;
const MOST_STEPS: u32 = 80;

/// Moves since the last upload beyond which points are uploaded anew, in units of the card.
const FAR: f64 = 1.0 / 16.0;

/// Accelerated iterations in a row that end as plain ones, after which acceleration has found what it can.
const MOST_PLAIN: u32 = 3;

/// What a system is made of, for the card.
pub(in crate::solver) struct Parts<'a> {
    pub(in crate::solver) constraints: &'a ConstraintSet,
    /// Weight times measure, by batch and slot.
    pub(in crate::solver) stiffness: &'a [Vec<f64>],
    /// `N` with inertia, or with the remedies for singular systems.
    pub(in crate::solver) matrix: &'a SymmetricMatrix,
    /// `Q`, see `constants.rs`.
    pub(in crate::solver) linear: SparseRows,
    /// The components that nothing holds against translation.
    pub(in crate::solver) free: Vec<Vec<u32>>,
    /// Forces that follow the points: the processor computes them in each iteration.
    pub(in crate::solver) has_moving_forces: bool,
    pub(in crate::solver) hard: Option<HardParts<'a>>,
}

/// The state of a model on the card.
pub(in crate::solver) struct Engine {
    card: Arc<Card>,
    frame: Frame,
    points: PointBuffers,
    /// `C` of the terms that are linear in the points.
    constants: wgpu::Buffer,
    /// What types without a kernel pull at each point with; none if there are none.
    host_pulls: Option<wgpu::Buffer>,
    /// From points to the right-hand side.
    projecting: Vec<Run>,
    gradients: ConjugateGradients,
    /// From the solution to points, and to the rows of hard constraints.
    moving: Vec<Run>,
    hard: Option<HardStep>,
    energies: wgpu::Buffer,
    moves: wgpu::Buffer,
    point_count: usize,
    group_count: usize,
    /// Steps of conjugate gradients in each linear solve.
    steps: u32,
    seconds_per_iteration: f64,
    /// Seconds between read-backs, about.
    pub(in crate::solver) seconds_per_read_back: f64,
    base: Vec<Four>,
    /// The points of the last upload or read-back.
    pub(in crate::solver) current: Vec<DVec3>,
    /// The energy of the linear terms at the last upload.
    constant_energy: f64,
    /// The components that nothing holds against translation, and the means that they keep.
    free: Vec<Vec<u32>>,
    means: Vec<DVec3>,
    /// Iterations since [`Self::begin`].
    made: u32,
    /// True once the right-hand side belongs to the points.
    is_projected: bool,
    /// What accelerated iterations remember; none before the first.
    history: Option<History>,
    /// The energy at the points where it is known, that of the linear terms at the last upload left out.
    energy: Option<f64>,
    /// Iterations in a row that found no step better than the plain one.
    plain_in_a_row: u32,
    sums: wgpu::Buffer,
    scale: wgpu::Buffer,
    /// Names of types that the processor projects.
    pub(in crate::solver) host_types: Vec<&'static str>,
    /// Steps of conjugate gradients so far.
    pub(in crate::solver) linear_iterations: u64,
    pub(in crate::solver) gpu_seconds: f64,
    pub(in crate::solver) transfer_seconds: f64,
}

/// What is known after a read-back.
#[derive(Clone, Copy, Debug)]
pub(in crate::solver) struct ReadBack {
    /// Iterations since the one before, and evaluations.
    pub(in crate::solver) iterations: u32,
    pub(in crate::solver) evaluations: u32,
    /// True at a turn, and where accelerated iterations have come to their end: then the processor may go on.
    pub(in crate::solver) is_turn: bool,
    /// True where acceleration finds nothing any more: energies differ by less than single precision tells.
    pub(in crate::solver) is_stuck: bool,
    /// In single precision but for the sum.
    pub(in crate::solver) energy: f64,
    /// The largest move of a point in the last iteration, in model units.
    pub(in crate::solver) largest_move: f64,
}

/// What is known of points: their energy, that of the linear terms at the last upload left out, and the largest move to them.
#[derive(Clone, Copy)]
struct Trial {
    energy: f64,
    largest_move: f64,
}

/// See the shaders.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Counts([u32; 2]);

impl Engine {
    /// Brings a model to the card. `points` are where it is.
    pub(in crate::solver) fn new(card: Arc<Card>, parts: &Parts<'_>, points: &[DVec3]) -> Result<Self> {
        let (n, unknowns) = (points.len(), parts.matrix.dimension());
        let Parts { constraints, stiffness, matrix, .. } = parts;
        let frame = Frame::of(points);
        let buffers = PointBuffers::new(&card, n)?;
        let room = |name: &str, count: usize| card.room(name, vector_bytes(count));
        let (constants, sums) = (room("the constant terms", n)?, room("the right-hand side", n)?);
        let local = LocalStep::new(&card, constraints, stiffness, &frame, &buffers, Wants::Pulls)?;

        let scale: Vec<f64> = (0..unknowns).map(|i| 1.0 / matrix.diagonal(i).sqrt()).collect();
        let near_null = scale.iter().map(|scale| 1.0 / scale).collect();
        let hierarchy = Multilevel::new(SparseRows::scaled(matrix, &scale), near_null)?;
        let gradients = ConjugateGradients::new(&card, &hierarchy)?;
        let scale: Vec<f32> = scale.iter().map(|scale| *scale as f32).collect();
        let scale = card.buffer("the scale of unknowns", &scale)?;

        let group_count = unknowns.div_ceil(GROUP as usize);
        let group_bytes = (group_count * size_of::<f32>()) as u64;
        let (energies, moves) = (card.room("the energies", group_bytes)?, card.room("the moves", group_bytes)?);
        let counts = |a: usize, b: usize| card.uniform(&Counts([a as u32, b as u32]));

        let mut projecting = local.runs;
        let linear = Sliced::new(&card, "the constant terms", &parts.linear)?;
        projecting.extend(linear.residual(&card, &constants, &buffers.shift, &sums)?);
        let (uniform, read, write) = (Access::Uniform, Access::Read, Access::Write);
        let kernel = card.kernel(
            "constants",
            &[include_str!("shaders/constants.wgsl"), THREADS],
            &[uniform, read, read, write],
        )?;
        projecting.push(card.run_of(&kernel, &[&counts(n, 0), &constants, &buffers.shift, &sums], n));
        let is_of_host = |(index, (batch, _)): &(usize, (&dyn crate::constraints::Batch, &[f64]))| {
            batch.kernel() == Kernel::None && stiffness[*index].iter().any(|s| *s > 0.0)
        };
        let host_types: Vec<_> =
            constraints.batches().enumerate().filter(is_of_host).map(|(_, (batch, _))| batch.info().name).collect();
        let needs_host = parts.has_moving_forces || !host_types.is_empty();
        let host_pulls = if needs_host { Some(room("what the processor pulls with", n)?) } else { None };
        if let Some(pulls) = &host_pulls {
            let kernel = card.kernel("add", &[include_str!("shaders/add.wgsl"), THREADS], &[uniform, read, write])?;
            projecting.push(card.run_of(&kernel, &[&counts(n, 0), pulls, &sums], n));
        }
        // The pages of results, and what else is theirs, live in the runs.
        projecting.extend(gather::runs(&card, constraints, &LocalStep { runs: Vec::new(), ..local }, n, &sums)?);
        let (hard, [holding, advancing]) = match &parts.hard {
            Some(hard) => {
                let (hard, runs) = HardStep::new(&card, hard, &frame, (&buffers, n), &sums)?;
                (Some(hard), runs)
            }
            None => (None, [Vec::new(), Vec::new()]),
        };
        projecting.extend(holding);
        let accesses = [uniform, read, read, write, write];
        let kernel = card.kernel(
            "right_hand_side",
            &[GROUP_SUM, include_str!("shaders/right_hand_side.wgsl"), THREADS],
            &accesses,
        )?;
        let buffers_of_run = [&counts(unknowns, n), &sums, &scale, &gradients.right, &energies];
        projecting.push(card.run_of(&kernel, &buffers_of_run, unknowns));
        let kernel = card.kernel("move", &[MOVES, include_str!("shaders/move.wgsl"), THREADS], &accesses)?;
        let buffers_of_run = [&counts(n, 0), &gradients.solution, &scale, &buffers.shift, &moves];
        let mut moving = vec![card.run_of(&kernel, &buffers_of_run, n)];
        moving.extend(advancing);
        Ok(Self {
            frame,
            points: buffers,
            constants,
            host_pulls,
            projecting,
            gradients,
            moving,
            hard,
            energies,
            moves,
            point_count: n,
            group_count,
            steps: FIRST_STEPS,
            seconds_per_iteration: 0.0,
            seconds_per_read_back: SECONDS,
            base: Vec::new(),
            current: Vec::new(),
            constant_energy: 0.0,
            free: parts.free.clone(),
            means: Vec::new(),
            made: 0,
            is_projected: false,
            history: None,
            energy: None,
            plain_in_a_row: 0,
            sums,
            scale,
            host_types,
            linear_iterations: 0,
            gpu_seconds: 0.0,
            transfer_seconds: 0.0,
            card,
        })
    }
}

/// What the solver knows at the time of an iteration.
#[derive(Clone, Copy)]
pub(in crate::solver) struct Now<'a> {
    pub(in crate::solver) constraints: &'a ConstraintSet,
    /// Weight times measure, by batch and slot.
    pub(in crate::solver) stiffness: &'a [Vec<f64>],
    /// `C` at points, without the constraints, and the energy there.
    pub(in crate::solver) constants: &'a ConstantsAt<'a>,
}

/// Pulls and energy at points.
pub(in crate::solver) type ConstantsAt<'a> = dyn Fn(&[DVec3]) -> (Vec<DVec3>, f64) + 'a;

impl Engine {
    /// Begins at `points`: uploads them unless the card has them, and the terms that are linear in them.
    pub(in crate::solver) fn begin(&mut self, now: Now<'_>, points: &[DVec3]) {
        let started = Instant::now();
        if self.current != points {
            self.current.clear();
            self.current.extend_from_slice(points);
            self.upload_points();
        }
        self.made = 0;
        self.means = self.free.iter().map(|points| mean(points, &self.current)).collect();
        self.upload_constants(now);
        self.transfer_seconds += started.elapsed().as_secs_f64();
    }

    /// True once it is known how many steps of conjugate gradients suffice.
    pub(in crate::solver) fn is_warm(&self) -> bool {
        self.seconds_per_iteration > 0.0
    }

    /// True if the processor has a share in each iteration.
    pub(in crate::solver) fn has_host(&self) -> bool {
        self.host_pulls.is_some()
    }

    /// Iterations that one call of [`Self::iterate`] should make: to the next turn, unless that is too late.
    fn suggested_count(&self) -> u32 {
        if self.has_host() || self.made == 0 {
            return 1;
        }
        let in_time = if self.is_warm() { (self.seconds_per_read_back / self.seconds_per_iteration) as u32 } else { 1 };
        in_time.clamp(1, TURN - self.made % TURN)
    }

    /// Has the following iterations accelerated, with so many pairs remembered; they begin with nothing to remember.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(in crate::solver) fn remember(&mut self, capacity: usize) -> Result<()> {
        if self.history.as_ref().is_none_or(|history| history.capacity() != capacity) {
            let iterate = Iterate {
                shift: &self.points.shift,
                sums: &self.sums,
                solution: &self.gradients.solution,
                scale: &self.scale,
                moves: &self.moves,
            };
            self.history = Some(History::new(&self.card, capacity, self.point_count, iterate)?);
        }
        self.forget();
        Ok(())
    }

    fn forget(&mut self) {
        self.history.iter_mut().for_each(History::forget);
        self.plain_in_a_row = 0;
    }

    /// Some iterations, `most` at most; accelerated where there is a `chooser`, and then none after one whose largest move is
    /// below `near`. [`Self::current`] then has the points.
    ///
    /// # Errors
    /// Status `BackendFailed`; [`Self::current`] is as it was.
    pub(in crate::solver) fn iterate(
        &mut self,
        most: u32,
        now: Now<'_>,
        chooser: Option<&mut Chooser>,
        near: f64,
    ) -> Result<ReadBack> {
        if self.has_host() {
            let started = Instant::now();
            // Forces that follow the points have other constants.
            self.upload_constants(now);
            self.transfer_seconds += started.elapsed().as_secs_f64();
        }
        let started = Instant::now();
        let count = self.suggested_count().min(most);
        if !self.is_projected {
            self.project(now);
        }
        let (iterations, evaluations, has_ended) = match chooser {
            Some(chooser) => self.accelerated_iterations(count, chooser, near)?,
            None => {
                self.plain_iterations(count);
                (count, count, false)
            }
        };
        self.card.wait()?;
        let seconds = started.elapsed().as_secs_f64();
        self.gpu_seconds += seconds;
        self.seconds_per_iteration = seconds / f64::from(iterations.max(1));
        self.made += iterations;
        let is_turn = self.made == 1 || self.made.is_multiple_of(TURN);
        let started = Instant::now();
        let (energy, largest_move) = self.read_back(is_turn)?;
        if is_turn && self.base.iter().zip(&self.current).any(|(base, point)| self.has_gone_far(*base, *point)) {
            self.upload_points();
            self.upload_constants(now);
            self.forget();
        }
        self.transfer_seconds += started.elapsed().as_secs_f64();
        let is_stuck = self.plain_in_a_row >= MOST_PLAIN;
        Ok(ReadBack { iterations, evaluations, energy, largest_move, is_turn: is_turn || has_ended, is_stuck })
    }

    /// Solves for the change of the points.
    fn solve(&mut self) {
        self.gradients.submit(&self.card, self.steps);
        self.linear_iterations += u64::from(self.steps);
    }

    fn plain_iterations(&mut self, count: u32) {
        for _ in 0..count {
            self.solve();
            self.card.submit(&self.moving);
            if !self.has_host() {
                self.card.submit(&self.projecting);
            }
        }
        self.is_projected = !self.has_host();
        self.energy = None;
    }

    /// Returns the numbers of iterations and of evaluations, and true if the last iteration is one to end at, be it the last of
    /// `count` or not: how many were asked for is a matter of the clock.
    fn accelerated_iterations(&mut self, count: u32, chooser: &mut Chooser, near: f64) -> Result<(u32, u32, bool)> {
        let mut energy = match self.energy {
            Some(energy) => energy,
            None => self.read_trial()?.energy,
        };
        let (mut iterations, mut evaluations, mut has_ended) = (0, 0, false);
        while iterations < count && !has_ended {
            let (found, tried) = self.accelerated_iteration(energy, chooser)?;
            energy = found.energy;
            evaluations += tried;
            iterations += 1;
            has_ended = found.largest_move < near || self.plain_in_a_row >= MOST_PLAIN;
        }
        self.energy = Some(energy);
        Ok((iterations, evaluations, has_ended))
    }

    /// One iteration from points of `energy`; returns the number of evaluations, too.
    fn accelerated_iteration(&mut self, energy: f64, chooser: &mut Chooser) -> Result<(Trial, u32)> {
        let Some(mut history) = self.history.take() else { return Err(super::internal("there is no history")) };
        self.solve();
        history.push(&self.card);
        let read: Vec<Vec<f32>> = self.card.read(&[history.shares(), (&self.gradients.progress, 8)])?;
        history.take(&read[0]);
        self.steps = steps_for(self.steps, &read[1]);
        let mut evaluations = 0;
        let mut accepted = None;
        if chooser.choose(&mut history.products, energy) {
            history.direct(&self.card, &chooser.combination);
            while let Some(length) = chooser.next_length() {
                evaluations += 1;
                let found = self.try_length(&history, length)?;
                if chooser.accepts(found.energy) {
                    accepted = Some(found);
                    break;
                }
            }
        }
        self.plain_in_a_row = if accepted.is_some() { 0 } else { self.plain_in_a_row + 1 };
        let found = match accepted {
            Some(found) => found,
            None => {
                evaluations += 1;
                history.direct(&self.card, &Combination { plain: 1.0, ..Combination::default() });
                self.try_length(&history, 1.0)?
            }
        };
        self.history = Some(history);
        Ok((found, evaluations))
    }

    /// Moves the points so far along the direction from the last iterate.
    fn try_length(&self, history: &History, length: f64) -> Result<Trial> {
        history.set_length(&self.card, length);
        self.card.submit([&history.trial].into_iter().chain(&self.projecting));
        self.read_trial()
    }

    /// What is known at the points that were projected last.
    fn read_trial(&self) -> Result<Trial> {
        let read: Vec<Vec<f32>> = self.card.read(&[(&self.energies, self.group_count), self.moves_to_read()])?;
        Ok(self.trial(&read[0], &read[1]))
    }

    fn moves_to_read(&self) -> (&wgpu::Buffer, usize) {
        (&self.moves, self.point_count.div_ceil(GROUP as usize))
    }

    fn trial(&self, energies: &[f32], moves: &[f32]) -> Trial {
        let size = self.frame.size;
        let energy: f64 = energies.iter().map(|energy| f64::from(*energy)).sum();
        let largest = f64::from(moves.iter().copied().fold(0.0, f32::max)).sqrt();
        Trial { energy: size * size * energy, largest_move: size * largest }
    }

    /// From points to the right-hand side; where the processor has a share, from [`Self::current`].
    fn project(&mut self, now: Now<'_>) {
        if let Some(buffer) = &self.host_pulls {
            let mut pulls = vec![DVec3::ZERO; self.current.len()];
            let of_host = |kernel| kernel == Kernel::None;
            constants::add_pulls(now.constraints, now.stiffness, &self.current, of_host, &mut pulls);
            let own: Vec<Four> = pulls.iter().map(|pull| four(*pull / self.frame.size)).collect();
            self.card.write(buffer, &own);
        }
        self.card.submit(&self.projecting);
        self.is_projected = true;
    }

    fn upload_points(&mut self) {
        self.base = self.points.upload(&self.card, &self.frame, &self.current);
        if let Some(hard) = &self.hard {
            hard.upload_base(&self.card, &self.base);
        }
    }

    /// Begins with these rows of the hard constraints, see [`HardStep::upload`]; after [`Self::begin`].
    pub(in crate::solver) fn begin_rows(&mut self, rows: &[DVec3], reaches: &[f64]) {
        if let Some(hard) = &self.hard {
            hard.upload(&self.card, &self.frame, rows, reaches);
        }
    }

    /// The rows of the hard constraints after the last iteration.
    ///
    /// # Errors
    /// Status `BackendFailed`.
    pub(in crate::solver) fn rows(&self) -> Result<Vec<DVec3>> {
        self.hard.as_ref().map_or(Ok(Vec::new()), |hard| hard.read(&self.card, &self.frame))
    }

    fn has_gone_far(&self, base: Four, point: DVec3) -> bool {
        let own = (point - self.frame.middle) / self.frame.size;
        (own - vector(base)).abs().max_element() > FAR
    }

    /// Uploads `C`, which is about the points of the last upload.
    fn upload_constants(&mut self, now: Now<'_>) {
        let origin: Vec<DVec3> = self.base.iter().map(|base| self.frame.joined(*base, [0.0; 4])).collect();
        let (mut pulls, mut energy) = (now.constants)(&origin);
        let is_constant = |kernel| kernel == Kernel::Constant;
        energy += constants::add_pulls(now.constraints, now.stiffness, &origin, is_constant, &mut pulls);
        let own: Vec<Four> = pulls.iter().map(|pull| four(*pull / self.frame.size)).collect();
        self.card.write(&self.constants, &own);
        self.constant_energy = energy;
        (self.is_projected, self.energy) = (false, None);
    }

    /// Takes over the points; returns their energy and the largest move.
    fn read_back(&mut self, is_turn: bool) -> Result<(f64, f64)> {
        let buffers = [
            (&self.points.shift, 4 * self.point_count),
            (&self.energies, self.group_count),
            self.moves_to_read(),
            (&self.gradients.progress, 8),
        ];
        let read: Vec<Vec<f32>> = self.card.read(&buffers)?;
        let [shift, energies, moves, progress] = &read[..] else {
            return Err(super::internal("a buffer was not read"));
        };
        let shift: &[Four] = bytemuck::cast_slice(shift);
        let moved = shift.iter().zip(&self.base).map(|(shift, base)| self.frame.joined(*base, *shift));
        let mut new: Vec<DVec3> = moved.collect();
        let found = self.trial(energies, moves);
        if !new.iter().all(|point| point.is_finite()) || !found.energy.is_finite() {
            let reason = "the numbers of this model leave the range of single precision";
            return Err(Error::new(Status::BackendFailed, reason));
        }
        // What nothing holds against translation drifts with the point that is held while solving.
        for (points, wanted) in self.free.iter().zip(&self.means) {
            let drift = *wanted - mean(points, &new);
            points.iter().for_each(|point| new[*point as usize] += drift);
        }
        self.current = new;
        if is_turn {
            self.steps = steps_for(self.steps, progress);
        }
        Ok((self.constant_energy + found.energy, found.largest_move))
    }
}

fn mean(points: &[u32], all: &[DVec3]) -> DVec3 {
    let first = all[points[0] as usize];
    first + points.iter().map(|point| all[*point as usize] - first).sum::<DVec3>() / points.len() as f64
}

/// How many steps of conjugate gradients the next solves need, after one of `steps`; see [`ConjugateGradients::progress`].
fn steps_for(steps: u32, progress: &[f32]) -> u32 {
    let left = (0..3).filter(|&lane| progress[lane] > 0.0).map(|lane| f64::from(progress[4 + lane] / progress[lane]));
    let left = left.fold(0.0, f64::max);
    if !(left > 0.0) {
        return steps;
    }
    // Each step takes its part of the error.
    let made = f64::from(progress[7]).max(1.0);
    let per_step = left.sqrt().ln() / made;
    let wanted = if per_step < 0.0 { (LINEAR_TOLERANCE.ln() / per_step).ceil() } else { f64::from(MOST_STEPS) };
    (wanted as u32).clamp(LEAST_STEPS, MOST_STEPS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_steps_are_made_as_the_tolerance_takes() {
        // Ten steps that leave a hundredth of the error: twenty leave a ten-thousandth.
        let progress = |left: f32| [1.0, 2.0, 0.0, 1.0, left, 2.0 * left, 5.0, 10.0];
        assert_eq!(steps_for(10, &progress(1e-4)), 20);
        assert_eq!(steps_for(10, &progress(1e-40)), LEAST_STEPS);
        assert_eq!(steps_for(10, &progress(2.0)), MOST_STEPS);
        assert_eq!(steps_for(10, &[0.0; 8]), 10);
    }
}
