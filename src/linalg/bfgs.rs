//! Least values of smooth functions of up to some hundred unknowns, by BFGS with a dense inverse Hessian.
//!
//! Not every point need be feasible: the function is `+∞` where it is not, and the line search turns back from there. It
//! brackets steps that meet the conditions of Armijo and (weak) Wolfe,
//!
//! ```text
//! f(x + t d) ≤ f(x) + c₁ t g·d     and     g(x + t d)·d ≥ c₂ g·d,     c₁ = 1e-4, c₂ = 0.9,
//! ```
//!
//! by halving between a step that is too long (infinite, or no Armijo decrease) and one that is too short (Wolfe fails), doubling
//! while none is known to be too long. Beside a barrier the second condition may hold nowhere: then the longest step with Armijo
//! decrease is taken. Sources: Nocedal & Wright 2006, algorithms 6.1 and 3.5; the bracketing is that of Lewis & Overton 2013.
//! Everything runs in a fixed order on one thread: the same input gives the same bits.

use std::ops::ControlFlow;

/// Armijo: the part of the first-order decrease that a step must reach.
const ARMIJO: f64 = 1e-4;

/// Wolfe: the part of the slope that may be left at the end of a step.
const WOLFE: f64 = 0.9;

/// Trials of one line search: 2⁻⁶⁰ of a step no longer changes a point.
const TRIALS: usize = 60;

/// After so many trials with Armijo decrease but not Wolfe's condition a step is long enough.
const PATIENCE: usize = 20;

/// The step of central differences in units of a variable's scale: near the cube root of round-off, where the errors of
/// truncation and of subtraction balance.
pub const DIFFERENCE: f64 = 1e-6;

/// What is minimised.
pub trait Objective {
    /// The value at `x`; `+∞` where `x` is not feasible. What is not a number counts as `+∞`.
    fn value(&mut self, x: &[f64]) -> f64;

    /// Writes the gradient at `x`, where the value is `value`; by [`central_differences`] unless overridden.
    fn gradient(&mut self, x: &[f64], value: f64, gradient: &mut [f64]) {
        central_differences(&mut |x| self.value(x), x, value, &vec![1.0; x.len()], gradient);
    }
}

impl<F: FnMut(&[f64]) -> f64> Objective for F {
    fn value(&mut self, x: &[f64]) -> f64 {
        self(x)
    }
}

/// When to stop. A tolerance of 0 never stops a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Stop where the largest entry of the gradient is at most this,
    pub gradient: f64,
    /// plus this times the value.
    pub relative_gradient: f64,
    /// Stop where the value fell by less than this part of itself
    pub relative_decrease: f64,
    /// in so many iterations.
    pub decrease_iterations: usize,
    /// Stop after so many iterations.
    pub max_iterations: usize,
    /// The length of the first step, along the gradient, in the unit of the variables.
    pub first_step: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            gradient: 0.0,
            relative_gradient: 1e-6,
            relative_decrease: 1e-4,
            decrease_iterations: 5,
            max_iterations: 200,
            first_step: 0.1,
        }
    }
}

/// Why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The gradient is as small as asked for.
    Gradient,
    /// The value hardly falls any more.
    Decrease,
    /// All iterations were used.
    Iterations,
    /// No step along the search direction lowers the value: the gradient is as good as its differences allow, or the point is
    /// at the border of what is feasible.
    LineSearch,
    /// The caller asked for it.
    Cancelled,
    /// The start is not feasible.
    Infeasible,
}

/// Where a run is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Iterations done.
    pub iteration: usize,
    /// The value.
    pub value: f64,
    /// The largest entry of the gradient.
    pub gradient: f64,
}

/// What a run found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The best point, always feasible if the start is.
    pub x: Vec<f64>,
    /// The value at the start and after every iteration, falling.
    pub history: Vec<f64>,
    /// The largest entry of the gradient there.
    pub gradient: f64,
    /// How often the function was evaluated, gradients apart.
    pub evaluation_count: usize,
    /// Why it stopped.
    pub stop: Stop,
}

/// Minimises from `start`. `progress` is called before every iteration and can end the run, which then has its best so far.
pub fn minimise(
    objective: &mut dyn Objective,
    start: &[f64],
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Found {
    let n = start.len();
    let mut state = State { x: start.to_vec(), value: 0.0, gradient: vec![0.0; n] };
    state.value = feasible_value(objective, &state.x);
    let mut found =
        Found { x: Vec::new(), history: vec![state.value], gradient: 0.0, evaluation_count: 1, stop: Stop::Infeasible };
    if state.value < f64::INFINITY {
        objective.gradient(&state.x, state.value, &mut state.gradient);
        found.stop = run(objective, &mut state, &mut found, options, progress);
        found.gradient = largest(&state.gradient);
    }
    found.x = state.x;
    found
}

struct State {
    x: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
}

fn run(
    objective: &mut dyn Objective,
    state: &mut State,
    found: &mut Found,
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Stop {
    let n = state.x.len();
    let mut hessian = InverseHessian::new(n);
    for iteration in 0.. {
        let gradient = largest(&state.gradient);
        if progress(&Progress { iteration, value: state.value, gradient }).is_break() {
            return Stop::Cancelled;
        }
        if gradient <= options.gradient + options.relative_gradient * state.value.abs() {
            return Stop::Gradient;
        }
        if iteration >= options.decrease_iterations && options.decrease_iterations > 0 {
            let before = found.history[iteration - options.decrease_iterations];
            if before - state.value < options.relative_decrease * before.abs() {
                return Stop::Decrease;
            }
        }
        if iteration == options.max_iterations {
            return Stop::Iterations;
        }
        let mut next = None;
        // A direction that leads nowhere may be the Hessian's fault: once more along the gradient.
        for _ in 0..2 {
            let direction = hessian.direction(&state.gradient);
            let first =
                if hessian.is_fresh { options.first_step / norm(&direction).max(f64::MIN_POSITIVE) } else { 1.0 };
            next = line_search(objective, state, &direction, first, &mut found.evaluation_count);
            if next.is_some() || hessian.is_fresh {
                break;
            }
            hessian = InverseHessian::new(n);
        }
        let Some(next) = next else { return Stop::LineSearch };
        hessian.update(state, &next);
        *state = next;
        found.history.push(state.value);
    }
    Stop::Iterations
}

/// A step along `direction` as the module's documentation says; `None` where none lowers the value.
fn line_search(
    objective: &mut dyn Objective,
    from: &State,
    direction: &[f64],
    first: f64,
    evaluation_count: &mut usize,
) -> Option<State> {
    let slope = dot(&from.gradient, direction);
    if !(slope < 0.0) {
        return None;
    }
    let (mut short, mut long, mut step) = (0.0, f64::INFINITY, first);
    let mut best: Option<State> = None;
    let mut decreased = 0;
    for _ in 0..TRIALS {
        let x: Vec<f64> = from.x.iter().zip(direction).map(|(x, d)| x + step * d).collect();
        if x == from.x {
            break;
        }
        let value = feasible_value(objective, &x);
        *evaluation_count += 1;
        // Beyond round-off: a step that changes nothing is no decrease.
        if value <= from.value + ARMIJO * step * slope && value < from.value {
            let mut gradient = vec![0.0; x.len()];
            objective.gradient(&x, value, &mut gradient);
            let is_long_enough = dot(&gradient, direction) >= WOLFE * slope;
            best = Some(State { x, value, gradient });
            decreased += 1;
            if is_long_enough || decreased == PATIENCE {
                break;
            }
            short = step;
        } else {
            long = step;
            // Half of what is left would not be worth its gradient.
            if best.is_some() && long - short < 0.1 * short {
                break;
            }
        }
        step = if long < f64::INFINITY { 0.5 * (short + long) } else { 2.0 * step };
    }
    best
}

/// The inverse of the Hessian, as a dense symmetric matrix.
struct InverseHessian {
    n: usize,
    entries: Vec<f64>,
    /// Whether it has met no step yet and is the identity.
    is_fresh: bool,
}

impl InverseHessian {
    fn new(n: usize) -> Self {
        let mut entries = vec![0.0; n * n];
        (0..n).for_each(|i| entries[i * n + i] = 1.0);
        Self { n, entries, is_fresh: true }
    }

    fn times(&self, v: &[f64]) -> Vec<f64> {
        self.entries.chunks_exact(self.n.max(1)).map(|row| dot(row, v)).collect()
    }

    fn direction(&self, gradient: &[f64]) -> Vec<f64> {
        self.times(gradient).into_iter().map(|entry| -entry).collect()
    }

    /// `H ← (I − ρ s yᵀ) H (I − ρ y sᵀ) + ρ s sᵀ`, with `ρ = 1 / s·y`; before the first time `H` is scaled to `s·y / y·y`, the
    /// size of the true one along `y`. Where Wolfe's condition was not met `s·y` may not be positive: then `H` stays.
    fn update(&mut self, from: &State, to: &State) {
        let difference = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>();
        let (s, y) = (difference(&to.x, &from.x), difference(&to.gradient, &from.gradient));
        let (sy, yy) = (dot(&s, &y), dot(&y, &y));
        if !(sy > 1e-12 * norm(&s) * yy.sqrt()) {
            return;
        }
        if self.is_fresh {
            self.entries.iter_mut().for_each(|entry| *entry *= sy / yy);
            self.is_fresh = false;
        }
        let hy = self.times(&y);
        let factor = (1.0 + dot(&y, &hy) / sy) / sy;
        for i in 0..self.n {
            for j in 0..self.n {
                self.entries[i * self.n + j] += factor * s[i] * s[j] - (hy[i] * s[j] + s[i] * hy[j]) / sy;
            }
        }
    }
}

/// The gradient by central differences of [`DIFFERENCE`] times each variable's scale; one-sided where one side is not
/// feasible, 0 where neither is.
pub fn central_differences(
    function: &mut dyn FnMut(&[f64]) -> f64,
    x: &[f64],
    value: f64,
    scales: &[f64],
    gradient: &mut [f64],
) {
    let mut at = x.to_vec();
    for i in 0..x.len() {
        let h = DIFFERENCE * scales[i];
        let mut side = |offset: f64| {
            at[i] = x[i] + offset;
            // The step that was made, after rounding.
            (function(&at), at[i] - x[i])
        };
        let sides = [side(-h), side(h)];
        at[i] = x[i];
        gradient[i] = difference_quotient(sides, value);
    }
}

/// The derivative from the values at two offsets, of which the first is below 0, and that in between.
pub fn difference_quotient([(below, back), (above, ahead)]: [(f64, f64); 2], value: f64) -> f64 {
    match (below.is_finite(), above.is_finite()) {
        (true, true) => (above - below) / (ahead - back),
        (true, false) => (below - value) / back,
        (false, true) => (above - value) / ahead,
        (false, false) => 0.0,
    }
}

fn feasible_value(objective: &mut dyn Objective, x: &[f64]) -> f64 {
    let value = objective.value(x);
    if value.is_nan() { f64::INFINITY } else { value }
}

fn largest(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |largest, entry| largest.max(entry.abs()))
}

fn norm(v: &[f64]) -> f64 {
    dot(v, v).sqrt()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXACT: Options = Options {
        gradient: 1e-8,
        relative_gradient: 0.0,
        relative_decrease: 0.0,
        decrease_iterations: 0,
        max_iterations: 500,
        first_step: 0.1,
    };

    fn on(_: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    fn falls(found: &Found) -> bool {
        found.history.windows(2).all(|pair| pair[1] < pair[0])
    }

    #[test]
    fn the_valley_of_rosenbrock_is_followed_to_its_end() {
        let mut rosenbrock =
            |x: &[f64]| x.windows(2).map(|p| 100.0 * (p[1] - p[0] * p[0]).powi(2) + (1.0 - p[0]).powi(2)).sum::<f64>();
        for n in [2, 20] {
            let start: Vec<f64> = (0..n).map(|i| if i % 2 == 0 { -1.2 } else { 1.0 }).collect();
            let found = minimise(&mut rosenbrock, &start, &EXACT, &mut on);
            assert!(falls(&found));
            // Another minimum exists near (−1, 1, …, 1) from n = 4 on; from this start it is not the one that is found.
            assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-6), "{:?} {:?}", found.stop, found.x);
            assert!(found.history.len() < 50 + 10 * n, "{}", found.history.len());
        }
    }

    /// A quadratic of 60 unknowns with its exact gradient, conditioned like 1e4.
    struct Quadratic {
        evaluations: usize,
    }

    impl Quadratic {
        const N: usize = 60;

        fn curvature(i: usize) -> f64 {
            10.0_f64.powf(4.0 * i as f64 / (Self::N - 1) as f64)
        }

        /// The minimum's coordinates, turned by a reflection so that the axes are not those of the variables.
        fn turned(x: &[f64]) -> Vec<f64> {
            let sum = x.iter().sum::<f64>() * 2.0 / x.len() as f64;
            x.iter().map(|x| x - sum).collect()
        }
    }

    impl Objective for Quadratic {
        fn value(&mut self, x: &[f64]) -> f64 {
            self.evaluations += 1;
            let y = Self::turned(x);
            3.0 + (0..Self::N).map(|i| 0.5 * Self::curvature(i) * (y[i] - 1.0).powi(2)).sum::<f64>()
        }

        fn gradient(&mut self, x: &[f64], _: f64, gradient: &mut [f64]) {
            let y = Self::turned(x);
            let inner: Vec<f64> = (0..Self::N).map(|i| Self::curvature(i) * (y[i] - 1.0)).collect();
            gradient.copy_from_slice(&Self::turned(&inner));
        }
    }

    #[test]
    fn a_quadratic_is_minimised_and_each_stop_is_named() {
        let start = vec![0.0; Quadratic::N];
        let solve = |options: &Options, progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>| {
            minimise(&mut Quadratic { evaluations: 0 }, &start, options, progress)
        };
        let found = solve(&Options { gradient: 1e-6, ..EXACT }, &mut on);
        assert_eq!(found.stop, Stop::Gradient);
        assert!(falls(&found) && found.gradient <= 1e-6);
        let minimum = Quadratic::turned(&vec![1.0; Quadratic::N]);
        assert!(found.x.iter().zip(&minimum).all(|(x, m)| (x - m).abs() < 1e-6));
        assert_eq!(solve(&Options { max_iterations: 7, ..EXACT }, &mut on).history.len(), 8);
        assert_eq!(solve(&Options { max_iterations: 7, ..EXACT }, &mut on).stop, Stop::Iterations);
        // The default stops when five iterations bring less than 1e-4 of the value: near 3, which is not 0.
        let found = solve(&Options { relative_gradient: 0.0, max_iterations: 500, ..Options::default() }, &mut on);
        assert_eq!(found.stop, Stop::Decrease);
        let h = &found.history;
        assert!(h[h.len() - 6] - h[h.len() - 1] < 1e-4 * h[h.len() - 6] && h[h.len() - 7] - h[h.len() - 2] >= 3e-4);
        // To the last bit: no step lowers the value any more.
        assert_eq!(solve(&Options { gradient: 0.0, ..EXACT }, &mut on).stop, Stop::LineSearch);
        let mut count = 0;
        let cancelled = solve(&EXACT, &mut |progress| {
            count += 1;
            if progress.iteration == 4 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        assert_eq!((cancelled.stop, cancelled.history.len(), count), (Stop::Cancelled, 5, 5));
        assert!(falls(&cancelled) && cancelled.history[4] < cancelled.history[0]);
        assert_eq!(solve(&EXACT, &mut on), solve(&EXACT, &mut on));
    }

    #[test]
    fn steps_turn_back_from_an_infeasible_half_space() {
        // x − ln x is least at 1; from x = 0.02 the first steps lead beyond 0, where it is infinite.
        let mut infeasible_count = 0;
        let mut barrier = |x: &[f64]| {
            if x[0] <= 0.0 {
                infeasible_count += 1;
                return f64::INFINITY;
            }
            x[0] - x[0].ln() + 50.0 * (x[1] - 3.0 - x[0]).powi(2)
        };
        let found = minimise(&mut barrier, &[5.0, -4.0], &Options { first_step: 20.0, ..EXACT }, &mut on);
        assert!(found.x[0] > 0.0 && falls(&found), "{found:?}");
        assert!((found.x[0] - 1.0).abs() < 1e-6 && (found.x[1] - 4.0).abs() < 1e-6, "{found:?}");
        assert!(infeasible_count > 0);
        // The least value is beyond the border: the run ends at it, inside.
        let mut cut = |x: &[f64]| if x[0] > 1.0 { f64::NAN } else { (x[0] - 2.0).powi(2) };
        let found = minimise(&mut cut, &[0.0], &EXACT, &mut on);
        assert!(falls(&found) && found.x[0] <= 1.0 && found.x[0] > 0.9, "{found:?}");
        assert!(matches!(found.stop, Stop::LineSearch | Stop::Gradient));
        let found = minimise(&mut cut, &[1.5], &EXACT, &mut on);
        assert_eq!((found.stop, found.x[0]), (Stop::Infeasible, 1.5));
    }

    #[test]
    fn differences_are_one_sided_beside_a_border() {
        let mut gradient = [0.0; 3];
        let mut function =
            |x: &[f64]| if x[0] > 1.0 || x[1] < 0.0 { f64::INFINITY } else { x[0] * x[0] - 3.0 * x[1] + x[2].powi(3) };
        let value = function(&[1.0, 0.0, 2.0]);
        central_differences(&mut function, &[1.0, 0.0, 2.0], value, &[1.0, 1.0, 2.0], &mut gradient);
        for (found, expected) in gradient.iter().zip([2.0, -3.0, 12.0]) {
            assert!((found - expected).abs() < 1e-5, "{gradient:?}");
        }
        central_differences(&mut |_| f64::INFINITY, &[0.0], 0.0, &[1.0], &mut gradient[..1]);
        assert_eq!(gradient[0], 0.0);
    }
}
