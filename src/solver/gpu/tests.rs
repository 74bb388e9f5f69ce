//! What tests of the card have in common.

use std::sync::Arc;

use super::card::Card;
use super::frame::Four;
use crate::solver::backend::BackendOptions;

/// The card with bindings of at most so many bytes (0: what it allows), if there is one; else says what is left out.
pub(in crate::solver) fn card(binding_bytes: u64) -> Option<Arc<Card>> {
    match Card::shared(&BackendOptions { binding_bytes, ..Default::default() }) {
        Ok(card) => Some(card),
        Err(error) => {
            eprintln!("LEFT OUT: {error}");
            None
        }
    }
}

/// Numbers in −1 to 1, the same for the same seed.
pub(in crate::solver) struct Random(pub(in crate::solver) u64);

impl Random {
    pub(in crate::solver) fn bits(&mut self) -> u64 {
        // The constants of Knuth's generator, of which the high bits are good.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    pub(in crate::solver) fn number(&mut self) -> f64 {
        self.bits() as f64 / (1_u64 << 30) as f64 - 1.0
    }

    pub(in crate::solver) fn vector(&mut self, count: usize) -> Vec<Four> {
        (0..count).map(|_| std::array::from_fn(|_| self.number() as f32)).collect()
    }
}
