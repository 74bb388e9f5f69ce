//! Sweeps on the graphics card: many plain ones in a row, and then one of the processor, in double precision, which says how
//! far they came. Once they gain little the processor accelerates, and goes on to the finish.

use super::engine::Engine;
use crate::error::Error;
use crate::solver::{ProgressFn, Report, Solver};

#[cfg(feature = "gpu")]
pub(super) use with_card::CardState;
#[cfg(not(feature = "gpu"))]
pub(super) use without_card::CardState;

/// Sweeps of the card between two of the processor.
#[cfg(feature = "gpu")]
const AHEAD: u32 = 24;

/// How the sweeps that the card makes ahead ended.
pub(super) enum Ahead {
    /// So many were made.
    Swept(u32),
    /// The caller's progress function said to stop after so many.
    #[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "only a card sweeps ahead"))]
    Cancelled(u32),
    /// The card failed after so many.
    #[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "only a card sweeps ahead"))]
    Failed(u32, Error),
    /// The card cannot have the model.
    #[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "only a card sweeps ahead"))]
    Refused(Error),
}

#[cfg(not(feature = "gpu"))]
mod without_card {
    use super::{Ahead, Engine, ProgressFn, Report, Solver};

    /// What an exploration has on the card: nothing.
    #[derive(Default)]
    pub(in super::super) struct CardState {
        _nothing: (),
    }

    impl CardState {
        pub(in super::super) fn refusal(&self) -> Option<&str> {
            None
        }
    }

    impl Engine {
        pub(in super::super) fn sweep_ahead(
            &mut self,
            _solver: &mut Solver,
            _most: u32,
            _residual: f64,
            _report: &mut Report,
            _progress: &mut ProgressFn<'_>,
        ) -> Ahead {
            Ahead::Swept(0)
        }
    }
}

#[cfg(feature = "gpu")]
mod with_card {
    use std::ops::ControlFlow;

    use glam::DVec3;

    use super::super::local::Local;
    use super::super::splitting::{RELAXATION, Splitting};
    use super::{AHEAD, Ahead, Engine, ProgressFn, Report, Solver};
    use crate::constraints::{ConstraintSet, Kernel};
    use crate::error::{Result, Status};
    use crate::solver::gpu::{Card, Engine as CardEngine, HardParts, Now, Parts, constant_matrix};
    use crate::solver::{Backend, BackendOptions, Progress};

    /// What an exploration has on the card.
    #[derive(Default)]
    pub(in super::super) struct CardState {
        on_card: Option<OnCard>,
        /// Why the processor sweeps although the card was asked for.
        refusal: Option<String>,
    }

    impl CardState {
        pub(in super::super) fn refusal(&self) -> Option<&str> {
            self.refusal.as_deref()
        }
    }

    struct OnCard {
        engine: Box<CardEngine>,
        /// The penalty that its matrix has.
        penalty: f64,
        soft: ConstraintSet,
        soft_stiffness: Vec<Vec<f64>>,
    }

    /// The stiffness of `local`, times `factor`, by batch and slot.
    fn by_batch(set: &ConstraintSet, local: &Local, factor: f64) -> Vec<Vec<f64>> {
        let mut rest = local.stiffness.as_slice();
        let of_batch = |count: usize| {
            let (own, later) = rest.split_at(count);
            rest = later;
            own.iter().map(|s| factor * s).collect()
        };
        set.batches().map(|(batch, _)| batch.len()).map(of_batch).collect()
    }

    /// Why a card cannot sweep, if there is a hard constraint that it does not project.
    fn without_kernel(constraints: &ConstraintSet) -> Option<String> {
        let hard = constraints.part(true);
        let batch = hard.batches().find(|(batch, _)| batch.len() > 0 && batch.kernel() == Kernel::None)?.0;
        Some(format!("cards do not project \"{}\", which is hard here", batch.info().name))
    }

    impl OnCard {
        fn new(options: &BackendOptions, constraints: &ConstraintSet, splitting: &Splitting) -> Result<Self> {
            let (soft, hard) = (constraints.part(false), constraints.part(true));
            let soft_stiffness = by_batch(&soft, &splitting.soft, 1.0);
            let hard_stiffness = by_batch(&hard, &splitting.hard, splitting.penalty);
            let scales: Vec<f64> = splitting.hard.items.iter().map(|item| item.scale).collect();
            let matrices = |number: usize| splitting.hard.matrices(&splitting.hard.items[number]);
            let parts = Parts {
                constraints: &soft,
                stiffness: &soft_stiffness,
                matrix: splitting.matrix(),
                linear: constant_matrix(&soft, &soft_stiffness, splitting.points.len(), &|visit| {
                    splitting.quadratic.each_entry(visit);
                })?,
                free: Vec::new(),
                has_moving_forces: false,
                hard: Some(HardParts {
                    set: &hard,
                    own: splitting.hard.own_set(),
                    matrices: &matrices,
                    stiffness: &hard_stiffness,
                    scales: &scales,
                    relaxation: RELAXATION,
                }),
            };
            let card = Card::shared(options)?;
            let make = || CardEngine::new(card, &parts, &splitting.points);
            let engine = Box::new(Card::within(options.memory_bytes, make)?);
            Ok(Self { engine, penalty: splitting.penalty, soft, soft_stiffness })
        }
    }

    impl Engine {
        /// Sweeps on the card where the solver's backend is the card, `most` at most, before the processor makes one; the
        /// one before left `residual`.
        pub(in super::super) fn sweep_ahead(
            &mut self,
            solver: &mut Solver,
            most: u32,
            residual: f64,
            report: &mut Report,
            progress: &mut ProgressFn<'_>,
        ) -> Ahead {
            let wanted = AHEAD.min(most);
            // Anderson acceleration saves the processor more sweeps than a card could be faster at: it is not tried unasked.
            if solver.backend() != Backend::Gpu || wanted == 0 || self.card.refusal.is_some() {
                return Ahead::Swept(0);
            }
            self.card.refusal = without_kernel(&solver.constraints);
            if self.card.refusal.is_some() {
                return Ahead::Swept(0);
            }
            let mut made = 0;
            match self.sweep_on_card(solver, (wanted, &mut made), residual, report, progress) {
                Ok(true) => Ahead::Swept(made),
                Ok(false) => Ahead::Cancelled(made),
                Err(error) => {
                    self.card.on_card = None;
                    if error.status() == Status::BackendFailed {
                        Ahead::Failed(made, error)
                    } else {
                        Ahead::Refused(error)
                    }
                }
            }
        }

        /// False if the progress function said to stop. `made` counts the sweeps whose points were read back.
        fn sweep_on_card(
            &mut self,
            solver: &mut Solver,
            (wanted, made): (u32, &mut u32),
            residual: f64,
            report: &mut Report,
            progress: &mut ProgressFn<'_>,
        ) -> Result<bool> {
            let penalty = self.splitting.penalty;
            let mut on_card = match self.card.on_card.take().filter(|on_card| on_card.penalty == penalty) {
                Some(on_card) => on_card,
                None => OnCard::new(&solver.backend_options, &solver.constraints, &self.splitting)?,
            };
            let OnCard { engine, soft, soft_stiffness, .. } = &mut on_card;
            let (seconds, transfer) = (engine.gpu_seconds, engine.transfer_seconds);
            let quadratic = &self.splitting.quadratic;
            let constants = |x: &[DVec3]| {
                let mut gradient = vec![DVec3::ZERO; x.len()];
                quadratic.gradient(x, &mut gradient);
                (gradient.into_iter().map(|g| -g).collect(), 0.0)
            };
            let now = Now { constraints: soft, stiffness: soft_stiffness, constants: &constants };
            engine.begin(now, &self.splitting.points);
            let reaches: Vec<f64> = self.splitting.caps.iter().map(|cap| cap / penalty).collect();
            engine.begin_rows(&self.splitting.rows, &reaches);
            let mut goes_on = true;
            while *made < wanted && goes_on {
                let found = engine.iterate(wanted - *made, now, None, 0.0)?;
                *made += found.iterations;
                solver.points.copy_from_slice(&engine.current);
                let sweeps = report.iterations + *made;
                report.read_back_iteration = sweeps;
                let now = Progress {
                    iteration: sweeps,
                    evaluations: sweeps,
                    energy: residual,
                    largest_move: found.largest_move / self.size,
                    solver,
                };
                goes_on = progress(&now) == ControlFlow::Continue(());
            }
            let rows = engine.rows()?;
            report.gpu_seconds += engine.gpu_seconds - seconds;
            report.transfer_seconds += engine.transfer_seconds - transfer;
            self.splitting.points.copy_from_slice(&engine.current);
            self.splitting.rows.copy_from_slice(&rows);
            self.splitting.forget();
            self.card.on_card = Some(on_card);
            Ok(goes_on)
        }
    }
}

#[cfg(feature = "gpu")]
#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use glam::DVec3;

    use super::Ahead;
    use crate::problem::Objective;
    use crate::solver::gpu::tests::card;
    use crate::solver::{Backend, Report, Solver};

    /// Names of types, and how many points a constraint of each has.
    type Types<'a> = &'a [(&'a str, u32)];

    /// A grid of 6 by 6 points with constraints of these types, hard and soft.
    fn solver(hard: Types<'_>, soft: Types<'_>) -> Solver {
        let points: Vec<DVec3> = (0..36_u32)
            .map(|i| {
                let (x, y) = (f64::from(i % 6), f64::from(i / 6));
                DVec3::new(x, y, 0.3 * (1.7 * x + 0.9 * y).sin() + 0.1 * f64::from(i * 7 % 5)) + DVec3::splat(50.0)
            })
            .collect();
        let mut solver = Solver::new();
        solver.set_points(&points).unwrap();
        for (types, is_hard) in [(hard, true), (soft, false)] {
            for (type_name, k) in types {
                for corner in (0..29).filter(|i| i % 6 < 5).step_by(2) {
                    let ids: Vec<u32> =
                        [corner, corner + 1, corner + 7, corner + 6].into_iter().take(*k as usize).collect();
                    let id = solver.add_constraint(type_name, &ids, 0.7).unwrap();
                    solver.set_hard(&[id], is_hard).unwrap();
                }
            }
        }
        solver.set_objective(&Objective::default(), Default::default()).unwrap();
        solver.set_backend(Backend::Gpu).unwrap();
        solver.init().unwrap();
        let lifted = solver.points()[14] + DVec3::Z;
        solver.set_handle(14, lifted).unwrap();
        solver
    }

    #[test]
    fn sweeps_on_the_card_are_those_of_the_processor() {
        if card(0).is_none() {
            return;
        }
        let cases: [(Types<'_>, Types<'_>); 6] = [
            (&[("Plane", 4)], &[]),
            (&[("Plane", 4)], &[("EdgeStrain", 2), ("Closeness", 1)]),
            (&[("EdgeStrain", 2)], &[]),
            (&[("Closeness", 1)], &[("Plane", 4)]),
            (&[("Circle", 4), ("Laplacian", 4)], &[]),
            (&[("EqualLengths", 4), ("Bending", 4)], &[("Rectangle", 4)]),
        ];
        for (hard, soft) in cases {
            let mut solver = solver(hard, soft);
            let mut explorer = std::mem::take(&mut solver.explorer);
            let mut engine = explorer.prepare(&mut solver).unwrap();
            // Neither begins at rest.
            engine.splitting.plain_sweep();
            let (points, rows) = (engine.splitting.points.clone(), engine.splitting.rows.clone());
            (0..4).for_each(|_| engine.splitting.plain_sweep());
            let expected = [engine.splitting.points.clone(), engine.splitting.rows.clone()];
            engine.splitting.points.copy_from_slice(&points);
            engine.splitting.rows.copy_from_slice(&rows);
            let mut report = Report::empty();
            let mut progress = |_: &crate::solver::Progress<'_>| ControlFlow::Continue(());
            let Ahead::Swept(4) = engine.sweep_ahead(&mut solver, 4, 0.0, &mut report, &mut progress) else {
                panic!("{hard:?}: {report:?}");
            };
            for (found, expected) in [&engine.splitting.points, &engine.splitting.rows].into_iter().zip(&expected) {
                let apart = found.iter().zip(expected).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
                println!("{hard:?} {soft:?}: {apart:.1e}");
                // Of a model of size 7, after sweeps that circles of four points make more of than others.
                assert!(apart < 1e-4, "{hard:?} {soft:?}: {apart}");
            }
        }
    }
}
