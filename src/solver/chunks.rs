//! The local step cut into chunks: consecutive constraints of one type, or of two that are projected together.

use std::ops::Range;

use glam::DVec3;

use crate::constraints::{Batch, ConstraintSet, ProjectPair};

/// Indices (and so targets, roughly) that one chunk of the local step covers: some 10 µs of work, so that splitting costs
/// little, and some ten chunks per thread of the smallest problem that runs in parallel.
const CHUNK_INDICES: usize = 512;

/// The same slots of one or two batches. Their targets lie behind each other, those of the first batch first.
pub(super) struct Chunk {
    batch: usize,
    partner: Option<(usize, ProjectPair)>,
    slots: Range<usize>,
}

impl Chunk {
    /// The batches by index, with the slots.
    pub(super) fn batches(&self) -> impl Iterator<Item = (usize, Range<usize>)> + use<> {
        let slots = self.slots.clone();
        std::iter::once(self.batch).chain(self.partner.map(|(index, _)| index)).map(move |index| (index, slots.clone()))
    }

    /// The number of targets of `batch`, which is one of the chunk's.
    pub(super) fn target_count(&self, batch: &dyn Batch) -> usize {
        batch.target_offset(self.slots.end) - batch.target_offset(self.slots.start)
    }

    /// Writes the projections of `points`.
    pub(super) fn project(&self, constraints: &ConstraintSet, points: &[DVec3], targets: &mut [DVec3]) {
        let batch = constraints.batch(self.batch);
        match self.partner {
            None => batch.project(self.slots.clone(), points, targets),
            Some((partner, project)) => {
                let targets = targets.split_at_mut(self.target_count(batch)).into();
                project([batch, constraints.batch(partner)], self.slots.clone(), points, targets);
            }
        }
    }
}

/// All chunks, where the targets of each begin, and the number of targets.
pub(super) fn cut_into_chunks(constraints: &ConstraintSet) -> (Vec<Chunk>, Vec<usize>) {
    let pairs: Vec<([usize; 2], ProjectPair)> = constraints.pairs().collect();
    let (mut chunks, mut bounds) = (Vec::new(), vec![0]);
    let mut target_count = 0;
    for (index, (batch, _)) in constraints.batches().enumerate() {
        if pairs.iter().any(|([_, second], _)| *second == index) {
            continue;
        }
        let partner = pairs.iter().find(|([first, _], _)| *first == index).map(|([_, second], by)| (*second, *by));
        let (mut first_slot, mut index_count) = (0, 0);
        for slot in 0..batch.len() {
            index_count += batch.indices(slot).len();
            if index_count >= CHUNK_INDICES || slot + 1 == batch.len() {
                let chunk = Chunk { batch: index, partner, slots: first_slot..slot + 1 };
                let count = |(index, _)| chunk.target_count(constraints.batch(index));
                target_count += chunk.batches().map(count).sum::<usize>();
                chunks.push(chunk);
                bounds.push(target_count);
                (first_slot, index_count) = (slot + 1, 0);
            }
        }
    }
    (chunks, bounds)
}
