//! Which hard constraints contradict each other: a set, as light as exchanges make it, without which the others are
//! met.
//!
//! The search is made of trials. In each, some constraints are given up (a cap of 0), and sweeps show whether the
//! others are met or whether their largest violation stops falling. The first begins at `p⁰`, multipliers begin at 0
//! and the penalty is one of the search's own, so that what is found does not depend on the way there.
//!
//! 1. *Elastic*: all are elastic with the caps of their priorities. As the cost is of the length and not of its square,
//!    few constraints are violated, light ones rather than heavy ones, and the others are met. Then caps fall where the
//!    violation is large, which makes them fewer still (reweighting). If none is violated, there is no contradiction.
//! 2. *Without*: the violated ones are given up; any that is still violated, too, until the others are met.
//! 3. *Hardening*: each of those given up is made hard again in turn, the heaviest first, then the least violated, and
//!    stays hard if all that are not given up are met (a deletion filter: Chinneck 2008, "Feasibility and infeasibility
//!    in optimization", chapter 2).
//! 4. *Exchange*: each that is left, the heaviest first, is made hard once more, and lighter ones are elastic. Where
//!    those that are violated then, after hardening of their own, weigh less together, they are given up instead. It
//!    is tried from the points in hand and then from `p⁰`.
//!
//! Sets are not convex: what is found is *a* small set, around `p⁰`. A trial goes on from sweep to sweep
//! and from call to call, so a search may be spread over as many calls as the host likes.

use glam::DVec3;

use super::conflicts::{VIOLATED, Watch};
use super::distances;
use super::engine::Engine;
use crate::constraints::ConstraintSet;
use crate::error::Result;

/// Sweeps between looks, and looks at most in a trial.
const LOOK: u32 = 10;
const MOST_LOOKS: u32 = 40;

/// Looks in vain after which a trial has failed: with a multiplier at its cap, and with none.
const VAIN: u32 = 2;
const VAIN_BELOW: u32 = 5;

/// The caps of the search over the first ones, and how far, over the mean extent, a multiplier of the lowest priority
/// at its cap moves what resists by the penalty alone: the farther, the longer multipliers take to get there.
const CAP: f64 = 100.0;
const REACH: f64 = 0.5;

/// Rounds of reweighting at most, looks in each at most, and the violation, over the mean extent, at which a cap is
/// halved.
const ROUNDS: u32 = 5;
const ROUND_LOOKS: u32 = 4;
const HALVED_AT: f64 = 1e-2;

/// How much stronger than elsewhere those are that must hold in an exchange.
const HOLDING: f64 = 10.0;

/// What is tried.
#[derive(Clone, Copy)]
enum Stage {
    Elastic,
    Without,
    Hardening(usize),
}

/// What an exchange began with.
struct Exchange {
    heavy: usize,
    given_up: Vec<usize>,
    points: Vec<DVec3>,
    /// True once it is tried from `p⁰`, where the way from the points in hand led nowhere.
    is_from_initial: bool,
}

/// A search under way.
pub(super) struct Search {
    /// The penalty to go back to.
    pub(super) penalty: f64,
    stage: Stage,
    watch: Watch,
    looks: u32,
    round: u32,
    /// Those that the last look of the stage `Elastic` found violated, and the last round.
    violated: Vec<usize>,
    of_last_round: Vec<usize>,
    given_up: Vec<usize>,
    /// Still to be made hard, the next one last.
    to_harden: Vec<usize>,
    /// Still to be exchanged, the next one last.
    to_exchange: Vec<usize>,
    exchange: Option<Exchange>,
    /// Points that meet all that is not given up.
    points: Vec<DVec3>,
}

/// How a search ends: with those that are given up, none where all can be met.
pub(super) type Verdict = Vec<usize>;

impl Search {
    /// Begins a search from `p⁰`.
    pub(super) fn begin(engine: &mut Engine, constraints: &ConstraintSet) -> Result<Self> {
        let initial = engine.splitting.quadratic.initial().to_vec();
        engine.splitting.points.copy_from_slice(&initial);
        let mut search = Self {
            penalty: engine.splitting.penalty,
            stage: Stage::Elastic,
            watch: Watch::default(),
            looks: 0,
            round: 0,
            violated: Vec::new(),
            of_last_round: Vec::new(),
            given_up: Vec::new(),
            to_harden: Vec::new(),
            to_exchange: Vec::new(),
            exchange: None,
            points: initial,
        };
        let penalty = CAP * engine.priorities.first_cap / (REACH * engine.extent);
        engine.splitting.set_penalty(penalty, constraints, false)?;
        search.enter(Stage::Elastic, engine);
        Ok(search)
    }

    /// To be called after every sweep with the number of multipliers at their caps; the verdict once there is one. The
    /// points then meet all that is not given up.
    pub(super) fn after_sweep(&mut self, capped: usize, engine: &mut Engine) -> Option<Verdict> {
        if !self.watch.is_due(LOOK) {
            return None;
        }
        self.looks += 1;
        let found = distances(&mut engine.splitting.hard, &engine.splitting.points);
        let bound = VIOLATED * engine.extent;
        let missed: Vec<usize> = (0..found.len()).filter(|i| found[*i] > bound && !self.given_up.contains(i)).collect();
        self.watch.see(missed.iter().map(|&i| found[i]).fold(0.0, f64::max));
        let enough = if capped > self.given_up.len() { VAIN } else { VAIN_BELOW };
        let is_stuck = self.watch.vain >= enough || self.looks >= MOST_LOOKS;
        match self.stage {
            Stage::Elastic => self.elastic(missed, &found, engine),
            _ if !missed.is_empty() && !is_stuck => None,
            Stage::Without => self.without(missed, &found, engine),
            Stage::Hardening(tried) => {
                if missed.is_empty() {
                    self.points.clone_from(&engine.splitting.points);
                } else {
                    self.given_up.push(tried);
                }
                self.harden_next(engine)
            }
        }
    }

    /// Begins trials of another kind, or the next of this one, with the caps that follow from what is given up.
    fn enter(&mut self, stage: Stage, engine: &mut Engine) {
        (self.stage, self.watch, self.looks, self.round) = (stage, Watch::default(), 0, 0);
        self.violated.clear();
        self.of_last_round.clear();
        engine.splitting.caps = self.base_caps(engine);
        engine.splitting.restart();
    }

    fn base_caps(&self, engine: &Engine) -> Vec<f64> {
        let priorities = &engine.priorities;
        let mut caps: Vec<f64> = priorities.relative.iter().map(|p| CAP * priorities.first_cap * p).collect();
        if matches!(self.stage, Stage::Elastic) {
            (0..caps.len()).filter(|&i| !self.may_give_way(i, engine)).for_each(|i| caps[i] *= HOLDING);
        } else {
            // Whether all that is not given up can be met has nothing to do with priorities.
            let most = caps.iter().copied().fold(0.0, f64::max);
            caps.fill(most);
        }
        self.given_up.iter().for_each(|&i| caps[i] = 0.0);
        caps
    }

    /// True if a constraint is among those that the stage `Elastic` may find violated.
    fn may_give_way(&self, i: usize, engine: &Engine) -> bool {
        let weights = &engine.priorities.weights;
        self.exchange.as_ref().is_none_or(|exchange| weights[i] < weights[exchange.heavy])
    }

    fn elastic(&mut self, violated: Vec<usize>, found: &[f64], engine: &mut Engine) -> Option<Verdict> {
        if violated.is_empty() {
            if self.exchange.take().is_none() {
                return Some(Vec::new());
            }
            self.points.clone_from(&engine.splitting.points);
            return self.exchange_next(engine);
        }
        let is_settled = violated == self.violated || self.looks >= ROUND_LOOKS;
        self.violated = violated;
        if !is_settled {
            return None;
        }
        let is_same = self.round > 1 && self.violated == self.of_last_round;
        if self.round < ROUNDS && !is_same {
            let mut caps = self.base_caps(engine);
            for (i, cap) in caps.iter_mut().enumerate().filter(|(i, _)| self.may_give_way(*i, engine)) {
                *cap /= 1.0 + found[i] / (HALVED_AT * engine.extent);
            }
            engine.splitting.caps = caps;
            engine.splitting.forget();
            (self.round, self.looks, self.watch) = (self.round + 1, 0, Watch::default());
            self.of_last_round = std::mem::take(&mut self.violated);
            return None;
        }
        if self.exchange.is_some() && self.violated.iter().any(|&i| !self.may_give_way(i, engine)) {
            return self.take_back_exchange(engine);
        }
        self.to_harden.clone_from(&self.violated);
        self.given_up.append(&mut self.violated);
        self.enter(Stage::Without, engine);
        None
    }

    fn without(&mut self, mut missed: Vec<usize>, found: &[f64], engine: &mut Engine) -> Option<Verdict> {
        if missed.is_empty() {
            self.points.clone_from(&engine.splitting.points);
            let weights = &engine.priorities.weights;
            // The heaviest last, and of the same weight the least violated.
            self.to_harden
                .sort_by(|&a, &b| weights[a].total_cmp(&weights[b]).then_with(|| found[b].total_cmp(&found[a])));
            return self.harden_next(engine);
        }
        if self.exchange.is_some() {
            return self.take_back_exchange(engine);
        }
        self.to_harden.extend_from_slice(&missed);
        self.given_up.append(&mut missed);
        if self.given_up.len() >= found.len() {
            // Not even one can be met by itself, as far as these sweeps can see: there is nothing to name.
            return Some(Vec::new());
        }
        self.enter(Stage::Without, engine);
        None
    }

    fn harden_next(&mut self, engine: &mut Engine) -> Option<Verdict> {
        let Some(next) = self.to_harden.pop() else { return self.hardened(engine) };
        self.given_up.retain(|i| *i != next);
        engine.splitting.points.clone_from(&self.points);
        self.enter(Stage::Hardening(next), engine);
        None
    }

    /// All were made hard that can be.
    fn hardened(&mut self, engine: &mut Engine) -> Option<Verdict> {
        let weights = &engine.priorities.weights;
        let Some(exchange) = self.exchange.take() else {
            self.to_exchange.clone_from(&self.given_up);
            self.to_exchange.sort_by(|&a, &b| weights[a].total_cmp(&weights[b]));
            return self.exchange_next(engine);
        };
        let sum = |set: &[usize]| set.iter().map(|&i| weights[i]).sum::<f64>();
        if sum(&self.given_up) < sum(&exchange.given_up) {
            let new: Vec<usize> = self.given_up.iter().copied().filter(|i| !exchange.given_up.contains(i)).collect();
            self.to_exchange.extend(new);
            return self.exchange_next(engine);
        }
        self.exchange = Some(exchange);
        self.take_back_exchange(engine)
    }

    fn take_back_exchange(&mut self, engine: &mut Engine) -> Option<Verdict> {
        let Some(mut exchange) = self.exchange.take() else { return self.exchange_next(engine) };
        self.to_harden.clear();
        self.given_up.clone_from(&exchange.given_up);
        if exchange.is_from_initial {
            self.points = exchange.points;
            return self.exchange_next(engine);
        }
        exchange.is_from_initial = true;
        self.given_up.retain(|i| *i != exchange.heavy);
        self.exchange = Some(exchange);
        engine.splitting.points.copy_from_slice(engine.splitting.quadratic.initial());
        self.enter(Stage::Elastic, engine);
        None
    }

    fn exchange_next(&mut self, engine: &mut Engine) -> Option<Verdict> {
        let weights = &engine.priorities.weights;
        while let Some(heavy) = self.to_exchange.pop() {
            let is_lighter = |i: &usize| weights[*i] < weights[heavy] && !self.given_up.contains(i);
            if !(0..weights.len()).any(|i| is_lighter(&i)) {
                continue;
            }
            let given_up = self.given_up.clone();
            self.exchange = Some(Exchange { heavy, given_up, points: self.points.clone(), is_from_initial: false });
            self.given_up.retain(|i| *i != heavy);
            engine.splitting.points.clone_from(&self.points);
            self.enter(Stage::Elastic, engine);
            return None;
        }
        engine.splitting.points.clone_from(&self.points);
        Some(std::mem::take(&mut self.given_up))
    }
}
