//! What turns plain iterations into accelerated ones: it proposes points to try in place of the plain step, and judges
//! them by their energy. It sees flat vectors, inner products and energies, and knows no constraints.
//!
//! In each iteration the solver makes the plain step and keeps it in hand, asks for a [`Accelerator::propose`]d
//! direction, and evaluates the [`Accelerator::place_trial`]s along it until [`Accelerator::accepts`] one. If there is no
//! direction, or no trial is accepted, it takes the plain step. So an accelerated step never raises the energy, and a plain
//! one does what it does without acceleration.

use glam::DVec3;

use super::anderson::Anderson;
use super::history::{Combination, History, Products};
use super::quasi_newton::{LineSearch, QuasiNewton};
use super::report::Rejections;
use crate::error::{Error, Result, Status};
use crate::problem::{Acceleration, MOST_MEMORY};

/// Iterates remembered by default: see docs/acceleration.md for the figures behind both.
const ANDERSON_MEMORY: u32 = 8;
const QUASI_NEWTON_MEMORY: u32 = 5;

/// Points from which vectors are worked on in parallel. With 2500 points two threads gain nothing, with 5000 a tenth of
/// what acceleration adds to an iteration, with 10 000 (and 20 iterates remembered) half of it.
const PARALLEL_POINTS: usize = 4096;

/// Refuses a memory beyond what is allowed.
pub(super) fn check_memory(memory: u32) -> Result<()> {
    if memory <= MOST_MEMORY {
        return Ok(());
    }
    let reason = format!("expected 1 to {MOST_MEMORY}, or 0 for the default, found {memory}");
    Err(Error::new(Status::InvalidValue, reason).at("memory"))
}

/// The method and its memory of the solve at hand.
#[derive(Debug)]
enum Method {
    Anderson(Anderson),
    QuasiNewton(QuasiNewton),
}

/// What decides about directions and trials, from inner products and energies alone.
#[derive(Debug)]
pub(super) struct Chooser {
    method: Method,
    pub(super) combination: Combination,
    search: LineSearch,
    /// True while the last direction tried was given up. The next one then gets a single trial: where plain steps do not
    /// lead to a minimum of the energy (projections that are not the nearest), all lengths fail near the end.
    is_discouraged: bool,
    pub(super) rejections: Rejections,
}

impl Chooser {
    /// For `acceleration`; `None` if that is none. `Automatic` must have been decided on.
    pub(super) fn new(acceleration: Acceleration) -> Option<Self> {
        let method = match acceleration {
            Acceleration::Automatic | Acceleration::None => return None,
            Acceleration::Anderson => Method::Anderson(Anderson::default()),
            Acceleration::QuasiNewton => Method::QuasiNewton(QuasiNewton::default()),
        };
        Some(Self {
            method,
            combination: Combination::default(),
            search: LineSearch::new(0.0, 0.0),
            is_discouraged: false,
            rejections: Rejections::default(),
        })
    }

    /// True if this is what `acceleration` needs.
    pub(super) fn serves(&self, acceleration: Acceleration) -> bool {
        match self.method {
            Method::Anderson(_) => acceleration == Acceleration::Anderson,
            Method::QuasiNewton(_) => acceleration == Acceleration::QuasiNewton,
        }
    }

    /// Forgets rejections; returns how many pairs to remember. `memory` 0 is the method's default.
    pub(super) fn reset(&mut self, memory: u32) -> usize {
        let default = match self.method {
            Method::Anderson(_) => ANDERSON_MEMORY,
            Method::QuasiNewton(_) => QUASI_NEWTON_MEMORY,
        };
        let capacity = if memory == 0 { default } else { memory } as usize;
        self.combination.reset(capacity);
        match &mut self.method {
            Method::Anderson(anderson) => anderson.reset(capacity),
            Method::QuasiNewton(quasi_newton) => quasi_newton.reset(capacity),
        }
        (self.is_discouraged, self.rejections) = (false, Rejections::default());
        capacity
    }

    /// Chooses the direction from the newest iterate, of `energy`. True if there is one to try: none in the first iteration,
    /// which is the plain step.
    pub(super) fn choose(&mut self, products: &mut Products, energy: f64) -> bool {
        match &mut self.method {
            Method::Anderson(anderson) => {
                let left_out = anderson.combine(products, &mut self.combination);
                self.rejections.ill_conditioned += u32::from(left_out > 0);
            }
            Method::QuasiNewton(quasi_newton) => {
                if products.len() > 0 && !QuasiNewton::is_newest_curved(products) {
                    products.forget_newest();
                    self.rejections.ill_conditioned += 1;
                }
                if products.len() > 0 {
                    quasi_newton.combine(products, &mut self.combination);
                }
            }
        }
        if products.len() == 0 {
            return false;
        }
        let slope = -products.plain_along(&self.combination);
        // False for NaN too.
        if !(slope < 0.0 && slope.is_finite()) {
            self.rejections.not_descent += 1;
            products.forget_pairs();
            return false;
        }
        self.search = match self.method {
            Method::Anderson(_) => LineSearch::one_length(energy, slope),
            Method::QuasiNewton(_) if self.is_discouraged => LineSearch::one_length(energy, slope),
            Method::QuasiNewton(_) => LineSearch::new(energy, slope),
        };
        true
    }

    /// How far along the direction the next trial is; `None` if there is none left.
    pub(super) fn next_length(&mut self) -> Option<f64> {
        let length = self.search.next();
        if length.is_none() {
            self.rejections.line_search += 1;
            self.is_discouraged = true;
        }
        length
    }

    /// True if `energy`, found at the last trial, is low enough for it to be accepted.
    pub(super) fn accepts(&mut self, energy: f64) -> bool {
        if self.search.accepts(energy) {
            self.is_discouraged = false;
            return true;
        }
        let count = if energy.is_finite() { &mut self.rejections.energy_rose } else { &mut self.rejections.not_finite };
        *count += 1;
        false
    }
}

/// The state of one accelerated solve. Its memory is kept for the next one, its contents are not: whatever happened in
/// between (points set, constraints edited, a new time step) changed what the old iterates say.
#[derive(Debug)]
pub(super) struct Accelerator {
    chooser: Chooser,
    history: History,
    /// The points that the iteration began at, and the direction from them.
    start: Vec<DVec3>,
    direction: Vec<DVec3>,
}

impl Accelerator {
    /// For `acceleration`; `None` if that is none. `Automatic` must have been decided on.
    pub(super) fn new(acceleration: Acceleration) -> Option<Self> {
        let chooser = Chooser::new(acceleration)?;
        Some(Self { chooser, history: History::default(), start: Vec::new(), direction: Vec::new() })
    }

    /// True if this is what `acceleration` needs.
    pub(super) fn serves(&self, acceleration: Acceleration) -> bool {
        self.chooser.serves(acceleration)
    }

    /// Forgets all iterates and rejections. `memory` 0 is the method's default. Allocates only what is not there yet.
    pub(super) fn reset(&mut self, memory: u32, point_count: usize) {
        let capacity = self.chooser.reset(memory);
        self.history.reset(capacity, point_count);
        for vector in [&mut self.start, &mut self.direction] {
            vector.clear();
            vector.resize(point_count, DVec3::ZERO);
        }
    }

    /// What was tried in vain.
    pub(super) fn rejections(&self) -> Rejections {
        self.chooser.rejections
    }

    /// True if the vectors are long enough to gain from more than one thread.
    pub(super) fn is_long(&self) -> bool {
        self.start.len() >= PARALLEL_POINTS
    }

    /// Learns the iterate `points` of `energy`, its plain step to `plain`, and `image = N (plain − points)`. True if there is
    /// a direction to try: none in the first iteration, which is the plain step.
    pub(super) fn propose(
        &mut self,
        points: &[DVec3],
        energy: f64,
        plain: &[DVec3],
        image: &[DVec3],
        is_parallel: bool,
    ) -> bool {
        self.start.copy_from_slice(points);
        self.history.push(points, plain, Some(image), is_parallel);
        let has_direction = self.chooser.choose(self.history.products_mut(), energy);
        if has_direction {
            self.history.combine(&self.chooser.combination, &mut self.direction, is_parallel);
        }
        has_direction
    }

    /// Moves `points` to the next trial along the direction. False if there is none left; `points` are then as they were.
    pub(super) fn place_trial(&mut self, points: &mut [DVec3]) -> bool {
        let Some(length) = self.chooser.next_length() else {
            points.copy_from_slice(&self.start);
            return false;
        };
        for ((point, start), direction) in points.iter_mut().zip(&self.start).zip(&self.direction) {
            *point = *start + length * *direction;
        }
        true
    }

    /// True if `energy`, found at the last trial, is low enough for it to be accepted.
    pub(super) fn accepts(&mut self, energy: f64) -> bool {
        self.chooser.accepts(energy)
    }

    /// The largest move of a point since the iteration began.
    pub(super) fn largest_move(&self, points: &[DVec3]) -> f64 {
        points.iter().zip(&self.start).map(|(x, start)| x.distance_squared(*start)).fold(0.0, f64::max).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `E(x) = ½ Σ c_i n_i (x_i − 1)²` in the metric `N = diag(n)`: the plain step is `G(x) = x − c (x − 1)`.
    struct Quadratic {
        metric: Vec<f64>,
        curvatures: Vec<f64>,
    }

    impl Quadratic {
        /// With so many different curvatures.
        fn new(curvatures: &[f64]) -> Self {
            let n = 60;
            let metric = (0..n).map(|i| 1.0 + (i % 7) as f64).collect();
            Self { metric, curvatures: (0..n).map(|i| curvatures[i % curvatures.len()]).collect() }
        }

        fn start(&self) -> Vec<DVec3> {
            (0..self.metric.len()).map(|i| DVec3::new(2.0 + (i % 5) as f64, -1.0, (i % 3) as f64)).collect()
        }

        fn energy(&self, x: &[DVec3]) -> f64 {
            let terms = x.iter().zip(&self.metric).zip(&self.curvatures);
            0.5 * terms.map(|((x, n), c)| c * n * (*x - DVec3::ONE).length_squared()).sum::<f64>()
        }

        /// `G(x)` and `N (G(x) − x)`.
        fn plain(&self, x: &[DVec3]) -> [Vec<DVec3>; 2] {
            let step = |(x, c): (&DVec3, &f64)| *c * (DVec3::ONE - *x);
            let steps: Vec<DVec3> = x.iter().zip(&self.curvatures).map(step).collect();
            let image = steps.iter().zip(&self.metric).map(|(step, n)| *n * *step).collect();
            [x.iter().zip(&steps).map(|(x, step)| *x + *step).collect(), image]
        }

        /// Evaluations until the energy is below `1e-20` of that at the start.
        fn evaluations(&self, acceleration: Acceleration, memory: u32) -> u32 {
            let mut x = self.start();
            let first = self.energy(&x);
            let mut accelerator = Accelerator::new(acceleration);
            accelerator.iter_mut().for_each(|accelerator| accelerator.reset(memory, x.len()));
            let mut evaluations = 0;
            'iterations: while self.energy(&x) > 1e-20 * first {
                assert!(evaluations < 10_000);
                let energy = self.energy(&x);
                let [plain, image] = self.plain(&x);
                if let Some(accelerator) = &mut accelerator {
                    let has_direction = accelerator.propose(&x, energy, &plain, &image, false);
                    while has_direction && accelerator.place_trial(&mut x) {
                        evaluations += 1;
                        if accelerator.accepts(self.energy(&x)) {
                            continue 'iterations;
                        }
                    }
                }
                x = plain;
                evaluations += 1;
            }
            evaluations
        }
    }

    #[test]
    fn with_one_curvature_the_second_step_is_exact() {
        // The first step is plain. Its pair tells the one curvature there is.
        let quadratic = Quadratic::new(&[0.05]);
        assert_eq!(quadratic.evaluations(Acceleration::Anderson, 4), 2);
        assert_eq!(quadratic.evaluations(Acceleration::QuasiNewton, 4), 2);
        // (1 − 0.05)^(2 k) ≤ 1e-20: k = 449.
        assert_eq!(quadratic.evaluations(Acceleration::None, 0), 449);
    }

    #[test]
    fn with_k_curvatures_anderson_needs_k_steps_more_than_one() {
        // A polynomial of degree k in N⁻¹H with value 1 at 0 vanishes at k curvatures; k pairs are there after k + 1 plain
        // steps, of which the last is part of the accelerated one. On the way the residual falls, but the energy may rise,
        // and that evaluation is lost. Quasi-Newton steps are not exact line searches, so
        // there is no such number, but it is far from the plain one.
        for curvatures in [&[0.02, 0.5][..], &[0.02, 0.3, 1.0], &[0.03, 0.1, 0.4, 0.8]] {
            let quadratic = Quadratic::new(curvatures);
            let k = curvatures.len() as u32;
            let found = quadratic.evaluations(Acceleration::Anderson, 8);
            assert!((k + 1..=k + 2).contains(&found), "{curvatures:?}: {found} evaluations");
            let found = quadratic.evaluations(Acceleration::QuasiNewton, 8);
            let plain = quadratic.evaluations(Acceleration::None, 0);
            println!("{curvatures:?}: quasi-Newton {found}, plain {plain}");
            assert!(10 * found <= plain, "{curvatures:?}: {found} evaluations, plain {plain}");
        }
    }

    /// After one plain step on a quadratic of these curvatures: at its end, with the energy there.
    fn after_one_step(acceleration: Acceleration, curvatures: &[f64]) -> (Accelerator, Quadratic, Vec<DVec3>) {
        let quadratic = Quadratic::new(curvatures);
        let x = quadratic.start();
        let mut accelerator = Accelerator::new(acceleration).unwrap();
        accelerator.reset(5, x.len());
        let [plain, image] = quadratic.plain(&x);
        assert!(!accelerator.propose(&x, quadratic.energy(&x), &plain, &image, false), "the first step is plain");
        (accelerator, quadratic, plain)
    }

    #[test]
    fn rejections_are_counted_by_cause_and_leave_the_points_alone() {
        let propose = |(accelerator, quadratic, x): &mut (Accelerator, Quadratic, Vec<DVec3>)| {
            let [plain, image] = quadratic.plain(x);
            accelerator.propose(x, quadratic.energy(x), &plain, &image, false)
        };
        // Whatever is tried, the energy is told to have risen, or to be none.
        for (acceleration, trials) in [(Acceleration::Anderson, 1), (Acceleration::QuasiNewton, 3)] {
            for told in [f64::MAX, f64::NAN, f64::INFINITY] {
                let mut state = after_one_step(acceleration, &[0.1, 0.3]);
                assert!(propose(&mut state));
                let (accelerator, _, x) = &mut state;
                let before = x.clone();
                while accelerator.place_trial(x) {
                    assert!(*x != before && !accelerator.accepts(told));
                }
                assert!(*x == before);
                let (energy_rose, not_finite) = if told.is_finite() { (trials, 0) } else { (0, trials) };
                let expected = Rejections { energy_rose, not_finite, line_search: 1, ..Rejections::default() };
                assert_eq!(accelerator.rejections(), expected, "{acceleration:?}");
            }
        }
        // Along a move where the energy bends down (a curvature below 0) nothing can be learned.
        let mut state = after_one_step(Acceleration::QuasiNewton, &[-0.2]);
        assert!(!propose(&mut state));
        assert_eq!(state.0.rejections(), Rejections { ill_conditioned: 1, ..Rejections::default() });
        // Two moves that changed the plain step alike: one of them is left out.
        let mut state = after_one_step(Acceleration::Anderson, &[0.1]);
        assert!(propose(&mut state));
        state.2 = state.1.plain(&state.2)[0].clone();
        assert!(propose(&mut state));
        assert_eq!(state.0.rejections(), Rejections { ill_conditioned: 1, ..Rejections::default() });
        // An energy that is highest where Anderson sees the fixed point: the way there goes up.
        let mut state = after_one_step(Acceleration::Anderson, &[-0.2]);
        assert!(!propose(&mut state));
        assert_eq!(state.0.rejections(), Rejections { not_descent: 1, ..Rejections::default() });
    }

    #[test]
    fn numbers_that_are_not_finite_lead_to_plain_steps() {
        for acceleration in [Acceleration::Anderson, Acceleration::QuasiNewton] {
            for bad in [f64::NAN, f64::INFINITY, 1e300] {
                let (mut accelerator, quadratic, x) = after_one_step(acceleration, &[0.1, 0.4]);
                let [mut plain, mut image] = quadratic.plain(&x);
                (plain[3].y, image[3].y) = (bad, bad);
                assert!(!accelerator.propose(&x, 1.0, &plain, &image, false), "{acceleration:?}, {bad}");
            }
        }
    }
}
