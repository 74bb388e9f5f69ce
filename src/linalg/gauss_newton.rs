//! Least sums of squares of smooth functions of many unknowns, by the damped Gauss–Newton method with sparse derivatives.
//!
//! `F(x) = Σ r_k(x)²` has the gradient `g = 2 Jᵀ r`. Where the residuals `r` are small, or nearly linear, `2 JᵀJ` is its second
//! derivative, and the step `d` of
//!
//! ```text
//! (JᵀJ + λ diag JᵀJ) d = −Jᵀ r
//! ```
//!
//! leads near the minimum. `λ` (Levenberg 1944; with the diagonal, so that units of unknowns do not matter, Marquardt 1963) begins
//! at [`Options::damping`], grows where no part of a step lowers `F`, and falls after a full step. The direction always leads
//! downhill; of it the longest part `1, ½, ¼, …` is taken that meets Armijo's condition `F(x + t d) ≤ F(x) + 1e-4 t g·d`. The
//! ordering and the pattern of the normal equations are found once, as long as the residuals depend on the same unknowns. Source:
//! Nocedal & Wright 2006, sections 10.3 and 3.1. The same input gives the same bits.

use std::ops::ControlFlow;

use super::least_squares::{LeastSquares, Solver};
use crate::error::{Error, Result, Status};

/// Armijo: the part of the first-order decrease that a step must reach.
const ARMIJO: f64 = 1e-4;

/// What the damping grows by where a step fails, and falls by after a full step.
const RAISE: f64 = 100.0;

/// The first damping where there was none: the step is then a thousandth of a percent shorter.
const FIRST_DAMPING: f64 = 1e-5;

/// A damping beyond this leaves no step.
const MOST_DAMPING: f64 = 1e12;

/// What is minimised.
pub trait Residuals {
    /// How many unknowns there are.
    fn unknown_count(&self) -> usize;

    /// `F(x)`, the sum of the squared residuals; `+∞` where `x` is not feasible. What is not a number counts as `+∞`.
    fn value(&mut self, x: &[f64]) -> f64;

    /// Adds for each residual the equation `Σ ∂r/∂x_i d_i = −r` of the steps `d` that would make it 0 to first order. `x` is
    /// feasible. The unknowns of the equations should be the same at every `x`, in the same order.
    fn linearise(&mut self, x: &[f64], equations: &mut LeastSquares);
}

/// When to stop. A tolerance of 0 never stops a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Stop where the largest entry of the gradient is at most this,
    pub gradient: f64,
    /// or after a step whose largest entry is at most this,
    pub step: f64,
    /// or that lowered the value by less than this part of it,
    pub relative_decrease: f64,
    /// or where the value is at most this,
    pub value: f64,
    /// or after so many iterations.
    pub max_iterations: usize,
    /// `λ` at the start, and the least it falls to; 0 or more.
    pub damping: f64,
    /// How often a step is halved.
    pub max_halvings: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            gradient: 0.0,
            step: 0.0,
            relative_decrease: 1e-10,
            value: 0.0,
            max_iterations: 30,
            damping: 0.0,
            max_halvings: 20,
        }
    }
}

/// Why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The gradient is as small as asked for.
    Gradient,
    /// The last step was as small as asked for.
    Step,
    /// The value hardly falls any more.
    Decrease,
    /// The value is as small as asked for.
    Value,
    /// All iterations were used.
    Iterations,
    /// No step lowers the value, however damped: the minimum is met up to round-off, or derivatives are wrong.
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
    /// `F`.
    pub value: f64,
    /// The largest entry of its gradient.
    pub gradient: f64,
    /// The largest entry of the last step; 0 at the start.
    pub step: f64,
}

/// What a run found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The best point.
    pub x: Vec<f64>,
    /// The start, and where every iteration led to; the values fall.
    pub history: Vec<Progress>,
    /// Why it stopped.
    pub stop: Stop,
}

/// Minimises from `start`. `progress` is called before every iteration and can end the run, which then has its best so far.
///
/// # Errors
/// Not as many entries of `start` as unknowns, one that is not finite, or a negative damping (the place is `start`, `start[i]` or
/// `options.damping`); derivatives that are not finite; too many unknowns for memory.
pub fn minimise(
    residuals: &mut dyn Residuals,
    start: &[f64],
    options: &Options,
    progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> Result<Found> {
    check(residuals.unknown_count(), start, options)?;
    let mut run = Run {
        x: start.to_vec(),
        value: feasible_value(residuals, start),
        damping: options.damping,
        solver: Solver::default(),
    };
    let mut history = Vec::new();
    let stop =
        if run.value < f64::INFINITY { run.run(residuals, options, &mut history, progress)? } else { Stop::Infeasible };
    Ok(Found { x: run.x, history, stop })
}

fn check(unknown_count: usize, start: &[f64], options: &Options) -> Result<()> {
    if start.len() != unknown_count {
        let reason = format!("expected one value for each of {unknown_count} unknowns, found {}", start.len());
        return Err(Error::new(Status::InvalidArgumentLength, reason).at("start"));
    }
    if let Some(i) = start.iter().position(|x| !x.is_finite()) {
        let reason = format!("expected a finite number, found {}", start[i]);
        return Err(Error::new(Status::InvalidValue, reason).at(format!("start[{i}]")));
    }
    if !(options.damping >= 0.0 && options.damping < MOST_DAMPING) {
        let reason = format!("expected a number from 0 to below {MOST_DAMPING:e}, found {}", options.damping);
        return Err(Error::new(Status::InvalidValue, reason).at("options.damping"));
    }
    Ok(())
}

struct Run {
    x: Vec<f64>,
    value: f64,
    damping: f64,
    solver: Solver,
}

impl Run {
    fn run(
        &mut self,
        residuals: &mut dyn Residuals,
        options: &Options,
        history: &mut Vec<Progress>,
        progress: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
    ) -> Result<Stop> {
        let mut equations = LeastSquares::new(self.x.len());
        let (mut step, mut before) = (0.0, f64::INFINITY);
        for iteration in 0.. {
            equations.clear();
            residuals.linearise(&self.x, &mut equations);
            let gradient: Vec<f64> = equations.transposed_right().into_iter().map(|sum| -2.0 * sum).collect();
            let now = Progress { iteration, value: self.value, gradient: largest(&gradient), step };
            history.push(now);
            if progress(&now).is_break() {
                return Ok(Stop::Cancelled);
            }
            if now.gradient <= options.gradient {
                return Ok(Stop::Gradient);
            }
            if self.value <= options.value {
                return Ok(Stop::Value);
            }
            if iteration > 0 && step <= options.step {
                return Ok(Stop::Step);
            }
            if before - self.value < options.relative_decrease * before && before < f64::INFINITY {
                return Ok(Stop::Decrease);
            }
            if iteration == options.max_iterations {
                return Ok(Stop::Iterations);
            }
            before = self.value;
            match self.step(residuals, &equations, &gradient, options)? {
                Some(length) => step = length,
                None => return Ok(Stop::LineSearch),
            }
        }
        Ok(Stop::Iterations)
    }

    /// Takes a step, and says how long its largest entry is; none where `F` does not fall.
    fn step(
        &mut self,
        residuals: &mut dyn Residuals,
        equations: &LeastSquares,
        gradient: &[f64],
        options: &Options,
    ) -> Result<Option<f64>> {
        loop {
            let direction = match self.solver.solve(equations, self.damping) {
                Ok(direction) => Some(direction),
                // Some unknowns depend on others: with more damping they do not.
                Err(error) if error.status() == Status::NoSolution => None,
                Err(error) => return Err(error),
            };
            let mut promise = f64::INFINITY;
            if let Some(direction) = direction {
                promise = -dot(gradient, &direction);
                if let Some((x, value, factor)) = self.search(residuals, &direction, gradient, options.max_halvings) {
                    (self.x, self.value) = (x, value);
                    if factor == 1.0 {
                        self.damping = (self.damping / RAISE).max(options.damping);
                    }
                    return Ok(Some(factor * largest(&direction)));
                }
            }
            self.damping = (RAISE * self.damping).max(FIRST_DAMPING);
            // What is left to gain is round-off of the value, or all was tried.
            if promise < f64::EPSILON * self.value || self.damping > MOST_DAMPING {
                self.damping = options.damping;
                return Ok(None);
            }
        }
    }

    fn search(
        &self,
        residuals: &mut dyn Residuals,
        direction: &[f64],
        gradient: &[f64],
        max_halvings: usize,
    ) -> Option<(Vec<f64>, f64, f64)> {
        let slope = dot(gradient, direction);
        if !(slope < 0.0) {
            return None;
        }
        let mut factor = 1.0;
        for _ in 0..=max_halvings {
            let x: Vec<f64> = self.x.iter().zip(direction).map(|(x, d)| x + factor * d).collect();
            if x == self.x {
                return None;
            }
            let value = feasible_value(residuals, &x);
            if value <= self.value + ARMIJO * factor * slope && value < self.value {
                return Some((x, value, factor));
            }
            factor *= 0.5;
        }
        None
    }
}

fn feasible_value(residuals: &mut dyn Residuals, x: &[f64]) -> f64 {
    let value = residuals.value(x);
    if value.is_nan() { f64::INFINITY } else { value }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn largest(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |largest, entry| largest.max(entry.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(_: &Progress) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    const EXACT: Options = Options {
        gradient: 0.0,
        step: 0.0,
        relative_decrease: 0.0,
        value: 1e-24,
        max_iterations: 200,
        damping: 0.0,
        max_halvings: 20,
    };

    /// The value at each start of an iteration falls, by as much as Armijo's condition says at least of a step of that size.
    fn falls(found: &Found) -> bool {
        found.history.windows(2).all(|pair| pair[1].value < pair[0].value)
    }

    /// `10 (x_{i+1} − x_i²)` and `1 − x_i`.
    struct Rosenbrock(usize);

    impl Residuals for Rosenbrock {
        fn unknown_count(&self) -> usize {
            self.0
        }

        fn value(&mut self, x: &[f64]) -> f64 {
            x.windows(2).map(|p| 100.0 * (p[1] - p[0] * p[0]).powi(2) + (1.0 - p[0]).powi(2)).sum()
        }

        fn linearise(&mut self, x: &[f64], equations: &mut LeastSquares) {
            for (i, p) in (0..).zip(x.windows(2)) {
                equations.add(&[(i, -20.0 * p[0]), (i + 1, 10.0)], -10.0 * (p[1] - p[0] * p[0]));
                equations.add(&[(i, -1.0)], p[0] - 1.0);
            }
        }
    }

    #[test]
    fn the_valley_of_rosenbrock_is_followed_to_its_end() {
        for n in [2, 50] {
            let start: Vec<f64> = (0..n).map(|i| if i % 2 == 0 { -1.2 } else { 1.0 }).collect();
            let found = minimise(&mut Rosenbrock(n), &start, &EXACT, &mut on).unwrap();
            assert!(matches!(found.stop, Stop::Value | Stop::Gradient), "{:?}", found.history.last());
            assert!(found.x.iter().all(|x| (x - 1.0).abs() < 1e-10) && falls(&found));
            assert_eq!(found.history[0].value, Rosenbrock(n).value(&start));
        }
    }

    /// `a exp(b t) − y` at `t = 0, ¼, …, 2`.
    struct Exponential(Vec<f64>);

    impl Residuals for Exponential {
        fn unknown_count(&self) -> usize {
            2
        }

        fn value(&mut self, x: &[f64]) -> f64 {
            (0..self.0.len()).map(|k| (x[0] * (x[1] * 0.25 * k as f64).exp() - self.0[k]).powi(2)).sum()
        }

        fn linearise(&mut self, x: &[f64], equations: &mut LeastSquares) {
            for (k, y) in self.0.iter().enumerate() {
                let t = 0.25 * k as f64;
                let e = (x[1] * t).exp();
                equations.add(&[(0, e), (1, x[0] * t * e)], y - x[0] * e);
            }
        }
    }

    #[test]
    fn a_nonlinear_fit_ends_where_the_gradient_vanishes() {
        let truth = |t: f64| 2.0 * (-0.7 * t).exp();
        let exact: Vec<f64> = (0..9).map(|k| truth(0.25 * k as f64)).collect();
        let found = minimise(&mut Exponential(exact.clone()), &[1.0, 0.5], &EXACT, &mut on).unwrap();
        assert!((found.x[0] - 2.0).abs() < 1e-10 && (found.x[1] + 0.7).abs() < 1e-10, "{found:?}");
        assert!(falls(&found));
        // With errors that no exponential has, alternating by ±0.1: the gradient by central differences vanishes.
        let noisy: Vec<f64> = exact.iter().enumerate().map(|(k, y)| y + if k % 2 == 0 { 0.1 } else { -0.1 }).collect();
        let options = Options { gradient: 1e-8, value: 0.0, ..EXACT };
        let found = minimise(&mut Exponential(noisy.clone()), &[1.0, 0.5], &options, &mut on).unwrap();
        assert_eq!(found.stop, Stop::Gradient);
        for i in 0..2 {
            let at = |h: f64| {
                let mut x = found.x.clone();
                x[i] += h;
                Exponential(noisy.clone()).value(&x)
            };
            assert!(((at(1e-6) - at(-1e-6)) / 2e-6).abs() < 1e-7);
        }
        let decrease = Options { relative_decrease: 1e-6, ..EXACT };
        let found = minimise(&mut Exponential(noisy), &[1.0, 0.5], &decrease, &mut on).unwrap();
        assert_eq!(found.stop, Stop::Decrease);
        let [.., a, b] = &found.history[..] else { panic!() };
        assert!(a.value - b.value < 1e-6 * a.value && b.step > 0.0);
    }

    /// Two unknowns that only their sum is known of, and only where it is above 0.
    struct Sum;

    impl Residuals for Sum {
        fn unknown_count(&self) -> usize {
            2
        }

        fn value(&mut self, x: &[f64]) -> f64 {
            if x[0] + x[1] > 0.0 { (x[0] + x[1]).ln().powi(2) } else { f64::NAN }
        }

        fn linearise(&mut self, x: &[f64], equations: &mut LeastSquares) {
            let sum = x[0] + x[1];
            equations.add(&[(0, 1.0 / sum), (1, 1.0 / sum)], -sum.ln());
        }
    }

    #[test]
    fn what_is_not_determined_is_damped_and_what_is_not_feasible_is_avoided() {
        // The full step from 8 by the logarithm's slope leads to 8 − 8 ln 8, below 0.
        let found = minimise(&mut Sum, &[5.0, 3.0], &EXACT, &mut on).unwrap();
        assert!((found.x[0] + found.x[1] - 1.0).abs() < 1e-10 && falls(&found), "{found:?}");
        assert_eq!(minimise(&mut Sum, &[-1.0, 0.0], &EXACT, &mut on).unwrap().stop, Stop::Infeasible);
        let mut count = 0;
        let cancelled = minimise(&mut Sum, &[5.0, 3.0], &EXACT, &mut |progress| {
            count += 1;
            if progress.iteration == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let cancelled = cancelled.unwrap();
        assert_eq!((cancelled.stop, cancelled.history.len(), count), (Stop::Cancelled, 3, 3));
        assert!(cancelled.history[2].value < cancelled.history[0].value);
        let place = |start: &[f64], damping| {
            let error = minimise(&mut Sum, start, &Options { damping, ..EXACT }, &mut on).unwrap_err();
            error.place().to_owned()
        };
        assert_eq!(place(&[1.0], 0.0), "start");
        assert_eq!(place(&[1.0, f64::NAN], 0.0), "start[1]");
        assert_eq!(place(&[1.0, 1.0], -1.0), "options.damping");
    }
}
