//! Strips that are nearest to the reference surface and to each other, under side conditions: a sequence of quadratic programs
//! (Flöry et al. 2012, section 2.2).
//!
//! In every iteration the nearest points are found anew, and the quadratic model of the terms is minimised in the unknowns that the
//! side conditions leave free. The step must, with its own nearest points, lower what is minimised by a part of what the gradient
//! promises (Armijo). Strips slide along the surface almost freely, so the model's least value can be far away, where it is no
//! model: where the step fails, the model is damped (Levenberg and Marquardt), which is quicker than halving; if that is of no use the
//! step is halved. Side conditions hold exactly in every iterate.

use std::ops::ControlFlow;

use super::Strip;
use super::bounds::{self, Bounds};
use super::conditions::{self, Condition};
use super::layout::{Joints, Layout};
use super::system::{Model, nearest_free, points_of};
use super::terms::{Aim, Evaluation, Parts, Terms, Weights};
use crate::error::{Error, Result, Status, finite};
use crate::linalg::elimination::Elimination;
use crate::mesh::grid::check_finite;
use crate::mesh::reference::ReferenceSurface;

/// Armijo: the part of the first-order decrease that a step must reach.
const ARMIJO: f64 = 1e-4;

/// How often a step is halved.
const MOST_HALVINGS: usize = 20;

/// What is added to the diagonal of the second derivatives, as a multiple of its mean: at least, at most, and the factor from one trial
/// to the next.
const LEAST_DAMPING: f64 = 1e-10;
const MOST_DAMPING: f64 = 1.0;
const DAMPING_FACTOR: f64 = 30.0;

/// A first-order decrease below this multiple of the value is round-off of its sums.
const NO_DECREASE: f64 = 1e-14;

/// A value below this, of squares in units of the reference surface's size, is round-off of coordinates.
const NOTHING: f64 = 1e-31;

/// Over so many iterations what is minimised must fall by the root of the tolerance.
const FLAT: usize = 3;

/// What is optimised.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The strips at the start.
    pub strips: &'a [Strip],
    /// Which of them are neighbours.
    pub joints: &'a Joints,
    /// What they are to be near to.
    pub reference: &'a dyn ReferenceSurface,
    /// Points of the reference surface that are to be near to some strip ([`points_to_cover`](super::terms::points_to_cover)). There
    /// may be none: then the ends of strips are to be fixed, or `weights.proximal` above 0.
    pub cover: &'a [glam::DVec3],
    /// What holds exactly.
    pub conditions: &'a [Condition],
}

impl std::fmt::Debug for Task<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let counts = (self.strips.len(), self.cover.len(), self.conditions.len());
        f.debug_struct("Task").field("counts", &counts).field("joints", self.joints).finish_non_exhaustive()
    }
}

/// How it is optimised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The weights of the terms.
    pub weights: Weights,
    /// Inequalities.
    pub bounds: Bounds,
    /// Samples of a strip: so many along its boundaries for each control point (1 or more), and along its rulings (2 or more).
    pub samples: [usize; 2],
    /// Iterations at most.
    pub max_iterations: usize,
    /// Stop where no control point moves by more than this multiple of the reference surface's diagonal in an iteration, where what is
    /// minimised falls by less than this part of itself, or by less than the root of this part in three iterations; 0 or more.
    pub tolerance: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            weights: Weights::default(),
            bounds: Bounds::default(),
            samples: [4, 5],
            max_iterations: 50,
            tolerance: 1e-6,
        }
    }
}

impl Options {
    /// # Errors
    /// A number out of its range; its place is that of the field.
    pub fn check(&self) -> Result<()> {
        self.weights.check()?;
        self.bounds.check()?;
        for (k, least) in [1, 2].into_iter().enumerate() {
            if self.samples[k] < least {
                let reason = format!("expected at least {least}, found {}", self.samples[k]);
                return Err(Error::new(Status::InvalidValue, reason).at(format!("samples[{k}]")));
            }
        }
        if finite("tolerance", self.tolerance)? < 0.0 {
            let reason = format!("expected at least 0, found {}", self.tolerance);
            return Err(Error::new(Status::InvalidValue, reason).at("tolerance"));
        }
        Ok(())
    }
}

/// Why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Steps or decreases became small.
    Converged,
    /// There are no more iterations.
    MostIterations,
    /// No step along the direction found lowers what is minimised.
    LineSearch,
    /// The caller asked for it.
    Cancelled,
}

/// An iteration, or the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// What is minimised, after it: the terms, and the excess over bounds in units of the reference surface's diagonal.
    pub value: f64,
    /// The terms.
    pub parts: Parts,
    /// By how much a bound is exceeded at most, in model units.
    pub excess: f64,
    /// The first-order decrease along the whole step; 0 of the start.
    pub promised: f64,
    /// The part of the step that was taken; 0 of the start.
    pub taken: f64,
    /// How far a control point moved at most, in model units; 0 of the start.
    pub moved: f64,
    /// The largest distance of a sample within the boundary to the reference surface, in model units.
    pub largest_deviation: f64,
    /// The largest distance of a sample of a boundary to the neighbour's, in model units; 0 where they are shared.
    pub largest_gap: f64,
}

/// Where a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Iterations done.
    pub iteration: usize,
    /// The last of them, or the start.
    pub last: Iteration,
}

/// What a run found.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimised {
    /// The strips of the last iteration, the best.
    pub strips: Vec<Strip>,
    /// The start, moved to where it meets the conditions, and each iteration; values fall.
    pub history: Vec<Iteration>,
    /// Why it stopped.
    pub stop: Stop,
    /// How many unknowns the conditions left free.
    pub free_count: usize,
}

impl Optimised {
    /// The last iteration, or the start.
    pub fn last(&self) -> &Iteration {
        // The start is always there.
        &self.history[self.history.len() - 1]
    }
}

/// Optimises strips. `progress` is called before every iteration and can end the run, which then has its best so far.
///
/// # Errors
/// Options out of range (`options.FIELD`), no strips, strips without size or joints that cannot be (`strips`, `joints.pairs[k]`),
/// points to cover that are not finite (`cover[i]`), conditions that are none (`conditions[k].FIELD`). Status `InvalidValue`: a strip
/// that nothing keeps from shrinking, since there is nothing to cover, no proximal weight, and its ends are not all fixed
/// (`strips[i]`). Status `Infeasible`: a condition contradicts those before it (`conditions[k]`).
pub fn optimise(
    task: Task<'_>,
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Optimised> {
    options.check().map_err(|error| {
        let place = format!("options.{}", error.place());
        error.with_place(place)
    })?;
    check_finite("cover", task.cover)?;
    let weights = options.weights;
    let (layout, start) = Layout::new(task.strips, task.joints)?;
    let is_covering = weights.coverage > 0.0 && !task.cover.is_empty();
    let is_free = |&strip: &usize| !conditions::fixes_all_ends(task.conditions, strip);
    if let Some(strip) = (0..task.strips.len()).find(is_free).filter(|_| !is_covering && weights.proximal == 0.0) {
        let reason = "nothing keeps the strip from shrinking: cover points, fix all its ends, or weigh `proximal`";
        return Err(Error::new(Status::InvalidValue, reason).at(format!("strips[{strip}]")));
    }
    let size = task.reference.diagonal();
    let elimination = conditions::eliminate(&layout, task.conditions, size)?;
    let aim = Aim { reference: task.reference, cover: task.cover, joints: task.joints };
    let free = nearest_free(&elimination, &start)?;
    // Ways are measured from where the conditions are met.
    let start = points_of(&elimination.expand(&free));
    let run = Run { terms: Terms::new(aim, (layout, start), weights, options.samples)?, elimination, options };
    run.run(free, progress)
}

struct Run<'a> {
    terms: Terms<'a>,
    elimination: Elimination,
    options: &'a Options,
}

/// An iterate.
struct State {
    free: Vec<f64>,
    points: Vec<glam::DVec3>,
    strips: Vec<Strip>,
    at: Evaluation,
    excess: f64,
    value: f64,
}

/// What an iteration led to.
enum Next {
    /// An iterate, the first-order decrease that was promised, and the part of the step.
    State(Box<State>, f64, f64),
    /// Nothing to gain.
    Flat,
    /// Nothing found.
    None,
}

/// A direction, and the first-order decrease along it.
struct Direction {
    step: Vec<f64>,
    promised: f64,
}

impl Run<'_> {
    fn state(&self, free: Vec<f64>) -> Option<State> {
        let points = points_of(&self.elimination.expand(&free));
        let strips = self.terms.layout.strips(&points)?;
        let at = self.terms.evaluate(&points)?;
        let excess = self.options.bounds.excess(&at, &strips);
        let value = at.parts.total() + excess / self.terms.size;
        value.is_finite().then_some(State { free, points, strips, at, excess, value })
    }

    fn direction(&self, state: &State, model: &Model) -> Result<Option<Direction>> {
        let size = self.terms.size;
        let (step, gain) = if self.options.bounds.is_any() {
            let (at, which) = ((&state.at, &state.strips[..]), (&self.terms.layout, &self.elimination));
            match bounds::step(&self.options.bounds, model, at, which, size) {
                None => return Ok(None),
                Some(bounded) => (bounded.step, (state.excess - bounded.excess) / size),
            }
        } else {
            match model.step()? {
                None => return Ok(None),
                Some(step) => (step, 0.0),
            }
        };
        let slope: f64 = model.gradient.iter().zip(&step).map(|(g, d)| g * d).sum();
        Ok(Some(Direction { step, promised: gain - slope }))
    }

    /// The iterate at a part of a direction, if it is low enough.
    fn trial(&self, from: &State, along: &Direction, part: f64) -> Option<State> {
        let free = from.free.iter().zip(&along.step).map(|(x, d)| x + part * d).collect();
        let bound = from.value - ARMIJO * part * along.promised;
        self.state(free).filter(|next| next.value <= bound && next.value < from.value)
    }

    /// The next iterate; `damping` becomes what it took.
    fn next(&self, state: &State, damping: &mut f64) -> Result<Next> {
        let model = Model::new(&self.terms, &state.at, &state.points, &self.elimination);
        let mut last = None;
        loop {
            if let Some(direction) = self.direction(state, &model.damped(*damping))? {
                if !(direction.promised > NO_DECREASE * state.value) {
                    let is_flat = direction.promised.abs() <= NO_DECREASE * state.value;
                    return Ok(if is_flat { Next::Flat } else { Next::None });
                }
                if let Some(next) = self.trial(state, &direction, 1.0) {
                    return Ok(Next::State(Box::new(next), direction.promised, 1.0));
                }
                last = Some(direction);
            }
            if *damping >= MOST_DAMPING {
                break;
            }
            *damping *= DAMPING_FACTOR;
        }
        let Some(direction) = last else { return Ok(Next::None) };
        let parts = (1..=MOST_HALVINGS).map(|k| 0.5_f64.powi(k as i32));
        let found = parts.filter_map(|part| self.trial(state, &direction, part).map(|next| (next, part))).next();
        Ok(found.map_or(Next::None, |(next, part)| Next::State(Box::new(next), direction.promised, part)))
    }

    fn run(&self, free: Vec<f64>, progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>) -> Result<Optimised> {
        let none =
            || Error::new(Status::InvalidValue, "expected strips whose squared distances are finite").at("strips");
        let mut state = self.state(free).ok_or_else(none)?;
        let mut history = vec![iteration(&state, 0.0, 0.0, 0.0)];
        let tolerance = self.options.tolerance;
        let mut damping = LEAST_DAMPING;
        let stop = loop {
            let done = history.len() - 1;
            if progress(&Progress { iteration: done, last: history[done] }).is_break() {
                break Stop::Cancelled;
            }
            if state.value <= NOTHING {
                break Stop::Converged;
            }
            if done == self.options.max_iterations {
                break Stop::MostIterations;
            }
            let (next, promised, taken) = match self.next(&state, &mut damping)? {
                Next::State(next, promised, taken) => (*next, promised, taken),
                Next::Flat => break Stop::Converged,
                Next::None => break Stop::LineSearch,
            };
            damping = (damping / DAMPING_FACTOR).max(LEAST_DAMPING);
            let moves = next.points.iter().zip(&state.points).map(|(a, b)| a.distance(*b));
            let moved = moves.fold(0.0, f64::max);
            let decrease = state.value - next.value;
            let is_small = moved <= tolerance * self.terms.size || decrease <= tolerance * state.value;
            state = next;
            history.push(iteration(&state, promised, taken, moved));
            // A step that was cut is small for that. What falls slowly for several iterations is the sliding of strips along the
            // surface: deviations then no longer change.
            let before = history.len().checked_sub(FLAT + 1).map(|k| history[k].value);
            let before = before.filter(|_| !self.options.bounds.is_any());
            let is_flat = before.is_some_and(|before| before - state.value <= tolerance.sqrt() * before);
            if (is_small && taken == 1.0) || (is_flat && tolerance > 0.0) {
                break Stop::Converged;
            }
        };
        Ok(Optimised { strips: state.strips, history, stop, free_count: self.elimination.free().len() })
    }
}

fn iteration(state: &State, promised: f64, taken: f64, moved: f64) -> Iteration {
    Iteration {
        value: state.value,
        parts: state.at.parts,
        excess: state.excess,
        promised,
        taken,
        moved,
        largest_deviation: state.at.largest_deviation,
        largest_gap: state.at.largest_gap,
    }
}

#[cfg(test)]
mod tests;
